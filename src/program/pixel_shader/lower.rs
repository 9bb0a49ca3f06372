//! Turns instructions into general stages: one for each instruction or pair, and further ones for what a stage cannot do.

use super::constants::{Pool, Signed, signed, values};
use super::scratch::{Set, contains, hardware, live};
use super::*;
use crate::cascade::{End, TEXTURES, final_combiner, too_many_stages};
use crate::finding::finding;
use ninebit::state::{
    Combiners, DotMapping, GeneralStage, MuxSelect, Portion, Profile, Register, ShaderOperation, StageOrigin,
    TEXTURE_UNITS,
};

/// The states of a texture stage that texbem and texbeml read.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Bump {
    /// BUMPENVMAT00, 01, 10, 11; `None` if they are not set.
    pub matrix: Option<[f32; 4]>,
    /// Scale and offset: BUMPENVLSCALE and BUMPENVLOFFSET; `None` if they are not set.
    pub luminance: Option<[f32; 2]>,
}

/// State of the draw that the lowering depends on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Context {
    /// The chip that runs the program.
    pub profile: Profile,
    /// Whether the colour of each texture unit can be negative.
    pub signed: [bool; TEXTURE_UNITS],
    /// Whether fog is enabled.
    pub fog: bool,
    /// Constants R, G, B, A; they are clamped to -1..1. Definitions in the shader replace them.
    pub constants: [[f32; 4]; CONSTANTS],
    /// Bump states for texbem and texbeml, by the unit that samples.
    pub bumps: [Bump; TEXTURE_UNITS],
}

impl Context {
    /// Makes a context without fog, signed textures, constants and bump states.
    pub fn new(profile: Profile) -> Context {
        let (constants, bumps) = ([[0.0; 4]; CONSTANTS], [Bump::default(); TEXTURE_UNITS]);
        Context { profile, signed: [false; TEXTURE_UNITS], fog: false, constants, bumps }
    }
}

/// What a texture unit does for a shader.
#[derive(Clone, Debug, PartialEq)]
pub struct UnitUse {
    /// Operation of the unit.
    pub operation: ShaderOperation,
    /// The earlier unit that it reads.
    pub previous: usize,
    /// How a dot product maps the colour of that unit.
    pub mapping: DotMapping,
    /// Place of the instruction in the text.
    pub span: Span,
}

/// Result of lowering a shader, with the texture shader; `None` for units that no instruction loads.
pub type LoweredProgram = crate::cascade::LoweredProgram<[Option<UnitUse>; TEXTURE_UNITS]>;

/// Lowers a shader for a draw.
///
/// # Errors
/// Findings about what breaks the rules of the language, and about what the chip cannot do.
pub fn lower(program: &PixelShader, context: &Context) -> Result<LoweredProgram, Vec<Diagnostic>> {
    let mut findings = check::check(program);
    findings.retain(|finding| finding.severity == Severity::Error);
    if !findings.is_empty() {
        return Err(findings);
    }
    let units = texture::units(program, context, &mut findings);
    let value = |signed| Value { halves: [Half { negative: signed, limit: false }; 2], alpha_is_blue: false };
    let mut lowering = Lowering {
        profile: context.profile,
        constants: values(program, &context.constants).map(|value| value.map(signed)),
        values: [value(false); 12],
        held: Held::default(),
        pool: Pool::default(),
        stages: Vec::new(),
        origins: Vec::new(),
        places: Vec::new(),
        findings,
    };
    for (unit, register) in TEXTURES.into_iter().enumerate() {
        lowering.values[register as usize] = value(context.signed[unit]);
    }
    for (slot, live) in program.slots().zip(live(program)) {
        lowering.slot(slot, live);
    }
    let (combiners, origins) = lowering.finish(program, context.fog)?;
    Ok(LoweredProgram { combiners, origins, units })
}

/// What is known about the colour or the alpha of a register.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Half {
    /// Whether its value may be negative.
    pub(super) negative: bool,
    /// Whether it stands for max(0, x), because a `_sat` was left to its readers.
    pub(super) limit: bool,
}

/// What is known about a register.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Value {
    /// Colour, and alpha.
    pub(super) halves: [Half; 2],
    /// Whether its alpha is in blue: a dot product on a chip without blue-to-alpha.
    pub(super) alpha_is_blue: bool,
}

/// What earlier stages have prepared for an instruction: registers that hold constants or factors.
#[derive(Clone, Debug, Default)]
pub(super) struct Held {
    pub(super) constants: [Option<Register>; CONSTANTS],
    pub(super) factors: [Option<Register>; 2],
    pub(super) taken: Vec<Register>,
}

impl Held {
    /// Forgets what was prepared for one instruction, and the constants in registers that are needed otherwise.
    pub(super) fn keep(&mut self, keeps: impl Fn(Register) -> bool) {
        self.constants.iter_mut().for_each(|register| *register = register.filter(|register| keeps(*register)));
        self.factors = [None; 2];
        self.taken = self.constants.iter().flatten().copied().collect();
    }
}

/// General stages under construction.
pub(super) struct Lowering {
    pub(super) profile: Profile,
    pub(super) constants: Signed,
    values: [Value; 12],
    pub(super) held: Held,
    /// Constants of the stage, or on NV10 of the whole program.
    pub(super) pool: Pool,
    stages: Vec<GeneralStage>,
    origins: Vec<StageOrigin>,
    places: Vec<Span>,
    pub(super) findings: Vec<Diagnostic>,
}

/// A portion, and whether what it writes is at least 0.
pub(super) type StagePortion = (Portion, bool);

impl Lowering {
    pub(super) fn value(&self, register: Register) -> Value {
        self.values[register as usize]
    }

    /// Returns the register that holds a constant for the current instruction.
    pub(super) fn held_constant(&self, register: ShaderRegister) -> Option<Register> {
        let constant = (register.bank == Bank::Constant).then_some(usize::from(register.index))?;
        self.held.constants.get(constant).copied().flatten()
    }

    /// Lowers one instruction or pair.
    fn slot(&mut self, slot: &[Arithmetic], live: Set) {
        let Some(first) = slot.first() else { return };
        let span = first.span.clone();
        self.held.keep(|register| !contains(live, register));
        // Each turn prepares one thing, and there are fewer than 16.
        for _ in 0..16 {
            let mut pool = if self.profile == Profile::Nv10 { self.pool } else { Pool::default() };
            match self.stage(slot, &mut pool) {
                Ok([rgb, alpha]) => {
                    self.pool = pool;
                    let part = |alpha| {
                        let mut of = slot.iter().filter(|instruction| instruction.target.value.mask.has(alpha));
                        of.next().map(|instruction| format!("pixel shader: {}", print::instruction(instruction)))
                    };
                    let none = || "pixel shader: nothing".to_owned();
                    let [rgb_origin, alpha_origin] = [false, true].map(|alpha| part(alpha).unwrap_or_else(none));
                    self.push(rgb, alpha, pool, StageOrigin { rgb: rgb_origin, alpha: alpha_origin }, span);
                    self.write(slot);
                    let targets = slot.iter().map(|instruction| hardware(instruction.target.value.register));
                    self.held.keep(|register| targets.clone().all(|target| target != Some(register)));
                    return;
                }
                Err(need) => {
                    if self.prepare(need, slot, live, &span).is_none() {
                        return;
                    }
                }
            }
        }
        self.no_register(&span);
    }

    pub(super) fn push(&mut self, rgb: StagePortion, alpha: StagePortion, pool: Pool, origin: StageOrigin, span: Span) {
        for ((portion, positive), half) in [(&rgb, 0), (&alpha, 1)] {
            for output in [portion.ab_output, portion.cd_output, portion.sum_output] {
                let value = &mut self.values[output as usize];
                value.halves[half] = Half { negative: !positive, limit: false };
                value.alpha_is_blue &= half == 0;
                if half == 0 && portion.ab_blue_to_alpha {
                    value.halves[1] = value.halves[0];
                }
            }
        }
        self.values[Register::Zero as usize] = Value::default();
        self.stages.push(GeneralStage { rgb: rgb.0, alpha: alpha.0, constants: pool.registers() });
        self.origins.push(origin);
        self.places.push(span);
    }

    /// Records what the instructions of a stage leave to the readers of their results.
    fn write(&mut self, slot: &[Arithmetic]) {
        for instruction in slot {
            let Target { register, mask } = instruction.target.value;
            let Some(register) = hardware(register) else { continue };
            let value = &mut self.values[register as usize];
            let both = instruction.operation == Operation::Dp3 && mask == Mask::All;
            value.alpha_is_blue |= both && self.profile == Profile::Nv10;
            if both {
                value.halves[1] = value.halves[0];
            }
            for (half, alpha) in value.halves.iter_mut().zip([false, true]) {
                if mask.has(alpha) && instruction.saturate {
                    *half = Half { negative: false, limit: half.negative };
                }
            }
        }
    }

    fn finish(mut self, program: &PixelShader, fog: bool) -> Result<(Combiners, Vec<StageOrigin>), Vec<Diagnostic>> {
        self.secondary_alpha(program);
        let (needed, most) = (self.stages.len(), self.profile.general_stages());
        if let Some(span) = self.places.get(most) {
            let error = too_many_stages(self.profile, needed, span.clone(), "pixel shader");
            let dot = program.arithmetic.iter().any(|instruction| instruction.operation == Operation::Dp3);
            let more = needed.saturating_sub(program.slots().count());
            let error = match more {
                0 => error,
                _ => error.note(format!(
                    "{more} of them for what one stage does not read: constants of both signs, negatives of saturated registers"
                )),
            };
            self.findings.push(match self.profile {
                Profile::Nv10 if dot => error.note(
                    "diffuse light without it: texture stage 0 is DotProduct3 of the normal map and the light direction, stage 1 Modulate",
                ),
                _ => error,
            });
        }
        if !self.findings.is_empty() {
            return Err(self.findings);
        }
        let constants = match self.profile {
            Profile::Nv10 => self.pool.registers(),
            Profile::Nv2a => self.stages.last().map_or([[0; 4]; 2], |stage| stage.constants),
        };
        if self.profile == Profile::Nv10 {
            self.stages.iter_mut().for_each(|stage| stage.constants = constants);
        }
        let alpha_is_blue = self.value(Register::Spare0).alpha_is_blue;
        let final_combiner = final_combiner(End { specular: false, fog }, alpha_is_blue, constants);
        Ok((Combiners { stages: self.stages, mux_select: MuxSelect::Msb, final_combiner }, self.origins))
    }

    /// Refuses reads of the alpha of v1, which NV10 does not define (CMB-13).
    fn secondary_alpha(&mut self, program: &PixelShader) {
        if self.profile == Profile::Nv2a {
            return;
        }
        let v1 = ShaderRegister { bank: Bank::Color, index: 1 };
        for instruction in &program.arithmetic {
            for Spanned { value: source, span } in &instruction.sources {
                if source.register == v1 && instruction.reads(source).alpha {
                    let message = "the alpha of v1 is not defined on Nv10";
                    let help = "profile Nv2a defines it: write `profile: Nv2a`, or write `.rgb` alone here";
                    let error = finding("NB0309", span.clone(), message, "read for alpha", help);
                    self.findings.push(error.rule("CMB-13"));
                }
            }
        }
    }
}
