//! From instructions to general stages: one for each instruction or pair, and one more where a stage cannot say it.

use std::ops::Range;

use super::constants::{Pool, Signed, signed, values};
use super::factor::{Factor, Need, Part, product};
use super::scratch::{Set, contains, free, hardware, live};
use super::*;
use crate::program::cascade::{End, final_combiner, one, too_many_constants, too_many_stages};
use crate::program::finding::finding;
use crate::state::{
    CombinerInput, Combiners, Component, DotMapping, GeneralStage, InputMapping, MuxSelect, Portion, Profile, Register,
    ShaderOperation, StageOrigin, TEXTURE_UNITS,
};

/// The states of a texture stage that texbem and texbeml read.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Bump {
    /// BUMPENVMAT00, 01, 10, 11.
    pub matrix: Option<[f32; 4]>,
    /// BUMPENVLSCALE, BUMPENVLOFFSET.
    pub luminance: Option<[f32; 2]>,
}

/// What of the draw the lowering depends on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Context {
    /// The chip.
    pub profile: Profile,
    /// Units whose colours can be negative.
    pub signed: [bool; TEXTURE_UNITS],
    /// Fog is enabled.
    pub fog: bool,
    /// Constants, R, G, B, A; limited to -1..1. What the shader defines itself goes before them.
    pub constants: [[f32; 4]; CONSTANTS],
    /// For texbem and texbeml, of the unit that samples.
    pub bumps: [Bump; TEXTURE_UNITS],
}

impl Context {
    /// Without fog, signed textures, constants and bump states.
    pub fn new(profile: Profile) -> Context {
        let (constants, bumps) = ([[0.0; 4]; CONSTANTS], [Bump::default(); TEXTURE_UNITS]);
        Context { profile, signed: [false; TEXTURE_UNITS], fog: false, constants, bumps }
    }
}

/// What a texture unit does for a shader.
#[derive(Clone, Debug, PartialEq)]
pub struct UnitUse {
    /// Its operation.
    pub operation: ShaderOperation,
    /// The unit that it reads.
    pub previous: usize,
    /// How a dot product takes that.
    pub mapping: DotMapping,
    /// The instruction.
    pub place: Range<usize>,
}

/// A lowered shader.
#[derive(Clone, Debug, PartialEq)]
pub struct Lowered {
    /// The program.
    pub combiners: Combiners,
    /// What each general stage came from.
    pub origins: Vec<StageOrigin>,
    /// The texture shader: `None` for units that no instruction loads.
    pub units: [Option<UnitUse>; TEXTURE_UNITS],
}

/// Lowers a shader for a draw.
///
/// # Errors
/// What breaks the rules of the language, and everything that the chip has no form for.
pub fn lower(program: &PixelShader, context: &Context) -> Result<Lowered, Vec<Diagnostic>> {
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
    lowering.finish(program, context, units)
}

const TEXTURES: [Register; 4] = [Register::Texture0, Register::Texture1, Register::Texture2, Register::Texture3];

/// What is known of the colour or the alpha of a register.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Half {
    /// Its value may be negative.
    pub(super) negative: bool,
    /// It counts as max(0, x): `_sat`, left to who reads it.
    pub(super) limit: bool,
}

/// What is known of a register.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Value {
    /// Colour, alpha.
    pub(super) halves: [Half; 2],
    /// Its alpha is its blue: a dot product on a chip without blue-to-alpha.
    pub(super) alpha_is_blue: bool,
}

/// What stages before an instruction have prepared for it.
#[derive(Clone, Debug, Default)]
struct Held {
    constants: [Option<Register>; CONSTANTS],
    factors: [Option<Register>; 2],
    taken: Vec<Register>,
}

impl Held {
    /// Forgets what was prepared for one instruction, and constants in registers that are to be used otherwise.
    fn keep(&mut self, keeps: impl Fn(Register) -> bool) {
        self.constants.iter_mut().for_each(|register| *register = register.filter(|register| keeps(*register)));
        self.factors = [None; 2];
        self.taken = self.constants.iter().flatten().copied().collect();
    }
}

/// General stages under construction.
pub(super) struct Lowering {
    profile: Profile,
    pub(super) constants: Signed,
    values: [Value; 12],
    held: Held,
    /// Constants of the stage; on nv10 of the whole program.
    pool: Pool,
    stages: Vec<GeneralStage>,
    origins: Vec<StageOrigin>,
    places: Vec<Range<usize>>,
    findings: Vec<Diagnostic>,
}

/// A portion and whether what it writes is at least 0.
type Written = (Portion, bool);

impl Lowering {
    pub(super) fn value(&self, register: Register) -> Value {
        self.values[register as usize]
    }

    /// The register that holds a constant for the instruction at hand.
    pub(super) fn held_constant(&self, register: ShaderRegister) -> Option<Register> {
        let constant = (register.bank == Bank::Constant).then_some(usize::from(register.index))?;
        self.held.constants.get(constant).copied().flatten()
    }

    /// One instruction or pair.
    fn slot(&mut self, slot: &[Arithmetic], live: Set) {
        let Some(first) = slot.first() else { return };
        let place = first.place.clone();
        self.held.keep(|register| !contains(live, register));
        // Each turn prepares one thing; there are fewer things than this.
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
                    self.push(rgb, alpha, pool, StageOrigin { rgb: rgb_origin, alpha: alpha_origin }, place);
                    self.write(slot);
                    let targets = slot.iter().map(|instruction| hardware(instruction.target.value.register));
                    self.held.keep(|register| targets.clone().all(|target| target != Some(register)));
                    return;
                }
                Err(need) => {
                    if self.prepare(need, slot, live, &place).is_none() {
                        return;
                    }
                }
            }
        }
        self.no_register(&place);
    }

    fn push(&mut self, rgb: Written, alpha: Written, pool: Pool, origin: StageOrigin, place: Range<usize>) {
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
        self.places.push(place);
    }

    /// What the instructions of a stage leave to their readers.
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

    /// The portions of an instruction or pair.
    fn stage(&self, slot: &[Arithmetic], pool: &mut Pool) -> Result<[Written; 2], Need> {
        let mut halves = [Component::Rgb, Component::Alpha].map(|component| (Portion::idle(component), true));
        // Alpha first: what it leaves of the constants' alphas, colours can take.
        for alpha in [true, false] {
            for (n, instruction) in slot.iter().enumerate() {
                if instruction.target.value.mask.has(alpha) && !(alpha && instruction.operation == Operation::Dp3) {
                    halves[usize::from(alpha)] = self.portion(instruction, n, alpha, pool)?;
                }
            }
        }
        // What nv10 keeps in blue goes to alpha before a colour takes its place.
        for instruction in slot {
            let Target { register, mask } = instruction.target.value;
            let Some(register) = hardware(register) else { continue };
            if mask == Mask::Color && self.value(register).alpha_is_blue {
                let alpha = &mut halves[1];
                if alpha.0 != Portion::idle(Component::Alpha) {
                    return Err(Need::Alpha(register));
                }
                *alpha = self.copied_alpha(register);
            }
        }
        Ok(halves)
    }

    /// max(0, x) in the place of x, if that is still to be done.
    fn limited(&self, register: Register, alpha: bool) -> Written {
        let value = self.value(register);
        if alpha && value.alpha_is_blue {
            return self.copied_alpha(register);
        }
        let component = if alpha { Component::Alpha } else { Component::Rgb };
        let mut portion = Portion::idle(component);
        if value.halves[usize::from(alpha)].limit {
            portion.inputs[0] = CombinerInput { register, component, mapping: InputMapping::UnsignedIdentity };
            portion.inputs[1] = one(alpha);
            portion.ab_output = register;
        }
        (portion, true)
    }

    /// Blue, as it is, into alpha.
    fn copied_alpha(&self, register: Register) -> Written {
        let mut portion = Portion::idle(Component::Alpha);
        portion.inputs[0] = CombinerInput {
            register,
            component: Component::Blue,
            mapping: match self.value(register).halves[1].limit {
                true => InputMapping::UnsignedIdentity,
                false => InputMapping::SignedIdentity,
            },
        };
        portion.inputs[1] = one(true);
        portion.ab_output = register;
        let half = self.value(register).halves[1];
        (portion, half.limit || !half.negative)
    }

    fn portion(&self, instruction: &Arithmetic, n: usize, alpha: bool, pool: &mut Pool) -> Result<Written, Need> {
        let Arithmetic { operation, sources, target, scale, paired, .. } = instruction;
        let component = if alpha { Component::Alpha } else { Component::Rgb };
        let output = hardware(target.value.register).ok_or(Need::Refused)?;
        let mut portion = Portion { scale: *scale, ..Portion::idle(component) };
        let unit = Factor::one(alpha);
        let mut read = |n: usize, part: Part| {
            let source = &sources.get(n).ok_or(Need::Refused)?.value;
            self.factor(source, alpha, false, part, pool)
        };
        // A colour cnd behind `+` does not compare.
        let selects = *operation == Operation::Cnd && !(*paired && target.value.mask == Mask::Color);
        let (ab, cd) = match operation {
            Operation::Mov | Operation::Mul => {
                let mixed = sources.iter().position(|source| self.is_mixed(&source.value, alpha));
                let at = mixed.unwrap_or(0);
                let other = if *operation == Operation::Mul { read(1 - at.min(1), Part::Whole)? } else { unit };
                match mixed {
                    // Its positive and its negative part, a product each.
                    Some(_) => {
                        let [positive, negative] = [read(at, Part::Positive)?, read(at, Part::Negative)?];
                        (product(other, positive)?, Some(product(other, negative)?))
                    }
                    None => (product(read(0, Part::Whole)?, other)?, None),
                }
            }
            Operation::Add => (product(read(0, Part::Whole)?, unit)?, Some(product(read(1, Part::Whole)?, unit)?)),
            Operation::Sub => {
                (product(read(0, Part::Whole)?, unit)?, Some(product(read(1, Part::Whole)?.minus(), unit)?))
            }
            Operation::Mad => {
                let ab = product(read(0, Part::Whole)?, read(1, Part::Whole)?)?;
                (ab, Some(product(read(2, Part::Whole)?, unit)?))
            }
            Operation::Lrp => {
                let [first, second] = [read(1, Part::Whole)?, read(2, Part::Whole)?];
                let weight = self.weight(instruction, n, alpha, pool)?;
                (product(weight, first)?, Some(product(weight.complement(), second)?))
            }
            Operation::Dp3 => (product(read(0, Part::Whole)?, read(1, Part::Whole)?)?, None),
            Operation::Cnd if selects => {
                if self.value(Register::Spare0).alpha_is_blue {
                    return Err(Need::Alpha(Register::Spare0));
                }
                // The mux takes CD where the condition holds (CMB-10).
                (product(read(2, Part::Whole)?, unit)?, Some(product(read(1, Part::Whole)?, unit)?))
            }
            Operation::Cnd => (product(read(1, Part::Whole)?, unit)?, None),
        };
        let ([a, b], mut positive) = ab;
        (portion.inputs[0], portion.inputs[1]) = (a, b);
        if let Some(([c, d], more)) = cd {
            (portion.inputs[2], portion.inputs[3]) = (c, d);
            positive &= more;
            portion.mux = selects;
            portion.sum_output = output;
        } else {
            portion.ab_output = output;
        }
        if *operation == Operation::Dp3 {
            portion.ab_dot_product = true;
            portion.ab_blue_to_alpha = target.value.mask == Mask::All && self.profile == Profile::Nv2a;
        }
        Ok((portion, positive))
    }

    /// The first source of lrp, which both it and its complement must read.
    fn weight(&self, instruction: &Arithmetic, n: usize, alpha: bool, pool: &mut Pool) -> Result<Factor, Need> {
        if let Some(register) = self.held.factors.get(n).copied().flatten() {
            // As it was computed: each channel its own.
            let component = if alpha { Component::Alpha } else { Component::Rgb };
            return Ok(Factor::unsigned(register, component, InputMapping::UnsignedIdentity));
        }
        let source = &instruction.sources.first().ok_or(Need::Refused)?.value;
        if source.negate || matches!(source.modifier, Modifier::Bias | Modifier::SignedScale) {
            return Err(Need::Factor(n));
        }
        self.factor(source, alpha, true, Part::Whole, pool)
    }

    /// A stage before the instruction. `None` once the reason has been recorded that nothing helps.
    fn prepare(&mut self, need: Need, slot: &[Arithmetic], live: Set, place: &Range<usize>) -> Option<()> {
        let idle = |component| (Portion::idle(component), true);
        let mut pool = if self.profile == Profile::Nv10 { self.pool } else { Pool::default() };
        let ([rgb, alpha], what) = match need {
            Need::Limit(register) => (
                [self.limited(register, false), self.limited(register, true)],
                format!("{} limited to 0..1", self.name(register)),
            ),
            Need::Alpha(register) => {
                ([idle(Component::Rgb), self.copied_alpha(register)], format!("the alpha of {}", self.name(register)))
            }
            Need::Constant(index) => {
                let register = self.scratch(live, place)?;
                let constant = self.constants.get(usize::from(index)).copied().unwrap_or_default();
                let halves = [false, true].map(|alpha| self.loaded(constant, alpha, register, &mut pool));
                if let Some(slot) = self.held.constants.get_mut(usize::from(index)) {
                    *slot = Some(register);
                }
                let [Some(rgb), Some(alpha)] = halves else {
                    self.findings.push(too_many_constants(self.profile, place.clone()));
                    return None;
                };
                ([rgb, alpha], format!("c{index}"))
            }
            Need::Factor(n) => {
                let register = self.scratch(live, place)?;
                let instruction = slot.get(n)?;
                let source = instruction.sources.first()?;
                let copy = Arithmetic {
                    operation: Operation::Mov,
                    scale: Scale::One,
                    saturate: false,
                    target: instruction.target.clone(),
                    sources: vec![source.clone()],
                    paired: false,
                    place: place.clone(),
                };
                let mut halves = [idle(Component::Rgb), idle(Component::Alpha)];
                for alpha in [true, false] {
                    if instruction.target.value.mask.has(alpha) {
                        match self.portion(&copy, n, alpha, &mut pool) {
                            Ok((mut portion, positive)) => {
                                for output in [&mut portion.ab_output, &mut portion.sum_output] {
                                    *output = if *output == Register::Zero { *output } else { register };
                                }
                                halves[usize::from(alpha)] = (portion, positive);
                            }
                            Err(need) => return self.prepare(need, slot, live, place),
                        }
                    }
                }
                if let Some(slot) = self.held.factors.get_mut(n) {
                    *slot = Some(register);
                }
                (halves, "the first source".to_owned())
            }
            Need::Refused => {
                let message = "this instruction has no form in the register combiners";
                let help = "write it with other modifiers, or in two instructions";
                self.findings.push(finding("NB0379", place.clone(), message, "no form", help).rule("CMB-12"));
                return None;
            }
        };
        if self.profile == Profile::Nv10 {
            self.pool = pool;
        }
        let instruction = self.described(slot);
        let origin = format!("pixel shader: {what}{instruction}");
        self.push(rgb, alpha, pool, StageOrigin { rgb: origin.clone(), alpha: origin }, place.clone());
        Some(())
    }

    fn described(&self, slot: &[Arithmetic]) -> String {
        slot.first().map_or(String::new(), |first| format!(", for {}", print::instruction(first)))
    }

    /// A constant of both signs, as the difference of two.
    fn loaded(&self, constant: [i16; 4], alpha: bool, register: Register, pool: &mut Pool) -> Option<Written> {
        let component = if alpha { Component::Alpha } else { Component::Rgb };
        let [r, g, b, a] = constant;
        let mut portion = Portion::idle(component);
        let mut input = |sign: i16, mapping| {
            let byte = |c: i16| (sign * c).clamp(0, 255) as u8;
            let found = if alpha { pool.alpha(byte(a)) } else { pool.color([r, g, b].map(byte)) };
            found.map(|(register, component)| CombinerInput { register, component, mapping })
        };
        portion.inputs[0] = input(1, InputMapping::SignedIdentity)?;
        portion.inputs[1] = one(alpha);
        portion.inputs[2] = input(-1, InputMapping::SignedNegate)?;
        portion.inputs[3] = one(alpha);
        portion.sum_output = register;
        Some((portion, false))
    }

    fn scratch(&mut self, live: Set, place: &Range<usize>) -> Option<Register> {
        let mut found = free(live, &self.held.taken, self.profile);
        if found.is_none() {
            // Constants can be brought again.
            self.held.keep(|_| false);
            found = free(live, &self.held.taken, self.profile);
        }
        match found {
            Some(register) => self.held.taken.push(register),
            None => self.no_register(place),
        }
        found
    }

    fn no_register(&mut self, place: &Range<usize>) {
        let message = "this instruction needs a register more than are free";
        let help = "write it in two instructions, or read fewer texture registers after it";
        self.findings.push(finding("NB0379", place.clone(), message, "for a value in between", help).rule("CMB-12"));
    }

    fn name(&self, register: Register) -> String {
        let texture = TEXTURES.iter().position(|texture| *texture == register);
        match (register, texture) {
            (_, Some(unit)) => format!("t{unit}"),
            (Register::Spare0, _) => "r0".to_owned(),
            _ => "r1".to_owned(),
        }
    }

    fn finish(
        mut self,
        program: &PixelShader,
        context: &Context,
        units: [Option<UnitUse>; TEXTURE_UNITS],
    ) -> Result<Lowered, Vec<Diagnostic>> {
        self.secondary_alpha(program);
        let (needed, most) = (self.stages.len(), self.profile.general_stages());
        if let Some(place) = self.places.get(most) {
            let error = too_many_stages(self.profile, needed, place.clone(), "pixel shader");
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
        let end = End { specular: false, fog: context.fog };
        let final_combiner = final_combiner(end, self.value(Register::Spare0).alpha_is_blue, constants);
        let combiners = Combiners { stages: self.stages, mux_select: MuxSelect::Msb, final_combiner };
        Ok(Lowered { combiners, origins: self.origins, units })
    }

    /// CMB-13: nv10 does not define the alpha of v1.
    fn secondary_alpha(&mut self, program: &PixelShader) {
        if self.profile == Profile::Nv2a {
            return;
        }
        let v1 = ShaderRegister { bank: Bank::Color, index: 1 };
        for instruction in &program.arithmetic {
            for At { value: source, place } in &instruction.sources {
                if source.register == v1 && instruction.reads(source).alpha {
                    let message = "the alpha of v1 is not defined on Nv10";
                    let help = "profile Nv2a defines it: write `profile: Nv2a`, or write `.rgb` alone here";
                    let error = finding("NB0309", place.clone(), message, "read for alpha", help);
                    self.findings.push(error.rule("CMB-13"));
                }
            }
        }
    }
}
