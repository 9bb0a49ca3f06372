//! Lowers texture stages to general stages.

use super::*;
use crate::cascade::{Alpha, Argument, Cascade, Destination, End, Source};
use crate::finding::finding;
use ninebit::diagnostic::Diagnostic;
use ninebit::state::{Named, Profile, ShaderOperation, StageOrigin, TEXTURE_UNITS};
use ninebit::vertex::texgen::StageTransform;

/// State of the draw that the lowering depends on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Context {
    /// The chip that runs the program.
    pub profile: Profile,
    /// Whether each unit has a texture.
    pub bound: [bool; TEXTURE_UNITS],
    /// Whether the colour of each texture unit can be negative.
    pub signed: [bool; TEXTURE_UNITS],
    /// Whether fog is enabled.
    pub fog: bool,
}

/// What a program changes in a texture unit.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct UnitChange {
    /// The coordinate set that the unit reads; `None` if it is not changed.
    pub coordinate_set: Option<usize>,
    /// Generation of the unit's coordinates on the vertex side.
    pub generation: Option<Spanned<Generation>>,
    /// How the draw's texture matrix of the stage's number applies to the coordinates, if the stage says so.
    pub transform: Option<Spanned<StageTransform>>,
    /// The unit's texture shader operation, which reads the unit before, with the place of the stage operation that asks for it.
    pub operation: Option<Spanned<ShaderOperation>>,
}

/// Result of lowering texture stages, with the changes of the texture units.
pub type LoweredProgram = crate::cascade::LoweredProgram<[UnitChange; TEXTURE_UNITS]>;

/// Lowers the stages for a draw.
///
/// # Errors
/// Findings about everything that the chip cannot do, or that this version does not support.
pub fn lower(program: &TextureStages, context: &Context) -> Result<LoweredProgram, Vec<Diagnostic>> {
    let active = program.stages.iter().take_while(|stage| stage.color.operation.value != Operation::Disable).count();
    let transforms = program.stages.iter().any(|stage| !stage.transform_flags.span.is_empty());
    let mut walk = Walk { program, context, active, transforms, findings: Vec::new(), units: Default::default() };
    let mut cascade = Cascade::new(context.profile, context.signed);
    for (index, stage) in program.stages.iter().take(active).enumerate() {
        walk.coordinates(index, stage);
        if stage.color.operation.value.is_bump() {
            walk.bump(index, stage);
            continue;
        }
        let rgb = walk.half(index, &stage.color, false);
        let alpha = if stage.color.operation.value == Operation::DotProduct3 {
            Alpha::DotProduct
        } else {
            Alpha::Equation(walk.half(index, &stage.alpha, true))
        };
        let destination = match stage.result {
            ResultArgument::Current => Destination::Current,
            ResultArgument::Temp => Destination::Temporary,
        };
        let span = written([&stage.color.operation.span, &stage.span]);
        cascade.stage(span, &rgb, alpha, destination, origin(index, stage));
    }
    let end = End { specular: program.specular_enable, fog: context.fog };
    cascade.finish("cascade", end, walk.findings, walk.units)
}

/// Returns the first of some places that is written; empty if none is.
fn written<const N: usize>(places: [&Span; N]) -> Span {
    places.into_iter().find(|span| !span.is_empty()).cloned().unwrap_or(0..0)
}

/// State while the stages are lowered.
struct Walk<'p> {
    program: &'p TextureStages,
    context: &'p Context,
    /// Number of stages before the first disabled one.
    active: usize,
    /// Whether some stage says how texture matrices apply. As in the API, the others then have a setting as well: the default.
    transforms: bool,
    findings: Vec<Diagnostic>,
    units: [UnitChange; TEXTURE_UNITS],
}

impl Walk<'_> {
    /// Returns the equation of the colour or the alpha of a stage.
    fn half(&mut self, index: usize, half: &Half, alpha: bool) -> crate::cascade::Equation {
        let operation = half.operation.value;
        let stage = &self.program.stages[index];
        let span = written([&half.operation.span, &stage.color.operation.span, &stage.span]);
        if alpha && operation.is_color_only() {
            let message = format!("AlphaOp cannot be {}", operation.name());
            let help = "alpha has SelectArg1 to AddSmooth, the Blend operations, PreModulate, MultiplyAdd and Lerp";
            self.findings.push(finding("NB0353", span.clone(), message, "a colour operation", help));
        }
        let reads = operation.reads();
        let arguments = std::array::from_fn(|n| {
            if reads[n] { self.argument(index, &half.arguments[n], alpha, &span) } else { Argument::ZERO }
        });
        let texture = match operation {
            Operation::BlendTextureAlpha | Operation::BlendTextureAlphaPM => self.texture(index, span),
            Operation::PreModulate if index + 1 < self.active => self.texture(index + 1, span),
            _ => Argument::ONE,
        };
        operation.equation(arguments, texture, Argument::new(Source::Constant(self.program.texture_factor)))
    }

    fn argument(&mut self, index: usize, at: &Spanned<StageArgument>, alpha: bool, operation: &Span) -> Argument {
        let span = written([&at.span, operation]);
        let StageArgument { source, complement, alpha_replicate } = at.value;
        let mut argument = match source {
            ArgumentSource::Diffuse => Argument::new(Source::Primary),
            ArgumentSource::Current => Argument::new(Source::Current),
            ArgumentSource::Texture => self.texture(index, span.clone()),
            ArgumentSource::TextureFactor => Argument::new(Source::Constant(self.program.texture_factor)),
            ArgumentSource::Specular => Argument::new(Source::Secondary),
            ArgumentSource::Temp => Argument::new(Source::Temporary),
            ArgumentSource::Constant => Argument::new(Source::Constant(self.program.stages[index].constant)),
        };
        if source == ArgumentSource::Specular && (alpha || alpha_replicate) && self.context.profile == Profile::Nv10 {
            let help = "profile Nv2a defines it: write `profile: Nv2a`, or read the alpha of Diffuse";
            let error = finding("NB0309", span, "the alpha of Specular is not defined on Nv10", "undefined", help);
            self.findings.push(error.rule("CMB-13"));
        }
        if alpha_replicate {
            argument = argument.alpha();
        }
        if complement { argument.inverted() } else { argument }
    }

    /// Returns the colour of a unit's texture, which is opaque white if it has none.
    fn texture(&mut self, unit: usize, span: Span) -> Argument {
        let units = self.context.profile.texture_units();
        if unit >= units {
            let chip = self.context.profile.name();
            let message = format!("stage {unit} reads texture {unit}; {chip} has textures 0 to {}", units - 1);
            let help = match self.context.profile {
                Profile::Nv10 => "profile Nv2a has 4: write `profile: Nv2a`, or draw in two passes with `blend`",
                Profile::Nv2a => "draw in two passes with `blend`",
            };
            let error = finding("NB0319", span, message, "a texture unit that the chip lacks", help);
            self.findings.push(error.rule("CMB-12"));
            return Argument::ONE;
        }
        if self.context.bound[unit] { Argument::new(Source::Texture(unit)) } else { Argument::ONE }
    }

    /// Processes TEXCOORDINDEX and TEXTURETRANSFORMFLAGS.
    fn coordinates(&mut self, index: usize, stage: &TextureStage) {
        if let Some(at) = &stage.coordinate_index {
            let made = at.value.generation.checked_sub(1).map(|index| Generation::ALL.get(index as usize));
            if let Some(made) = made {
                match (made, self.units.get_mut(index)) {
                    (Some(made), Some(unit)) => unit.generation = Some(Spanned { value: *made, span: at.span.clone() }),
                    (Some(_), None) => {}
                    (None, _) => {
                        let message = format!("there is no source of coordinates {:#x}", at.value.generation << 16);
                        let help = "write 0x10000 (D3DTSS_TCI_CAMERASPACENORMAL) to 0x40000 (D3DTSS_TCI_SPHEREMAP)";
                        self.findings.push(finding("NB0206", at.span.clone(), message, "out of range", help));
                    }
                }
            } else if at.value.set >= 4 {
                let message = format!("a set of texture coordinates cannot be {}", at.value.set);
                self.findings.push(finding("NB0206", at.span.clone(), message, "out of range", "write 0 to 3"));
            } else if let Some(unit) = self.units.get_mut(index) {
                unit.coordinate_set = Some(at.value.set as usize);
            }
        }
        let Spanned { value: flags, span } = &stage.transform_flags;
        let (count, projected) = (flags & !PROJECTED, flags & PROJECTED != 0);
        if count > 4 {
            let message = format!("there are no transform flags {flags:#x}");
            let help = "write 0 (D3DTTFF_DISABLE) to 4 (D3DTTFF_COUNT4), with 256 (D3DTTFF_PROJECTED) or without";
            self.findings.push(finding("NB0206", span.clone(), message, "out of range", help));
        } else if let Some(unit) = self.units.get_mut(index)
            && self.transforms
        {
            let value = StageTransform { count: count as usize, projected };
            unit.transform = Some(Spanned { value, span: span.clone() });
        }
    }

    /// Processes BUMPENVMAP: the next unit samples with coordinates that this unit's texture moves.
    fn bump(&mut self, index: usize, stage: &TextureStage) {
        let operation = &stage.color.operation;
        if self.context.profile == Profile::Nv10 {
            let message = format!("Nv10 has no {}", operation.value.name());
            let help = "it needs the texture shader, which a texture unit of Nv10 does not have: write `profile: Nv2a`";
            let error = finding("NB0340", operation.span.clone(), message, "not on this chip", help);
            self.findings.push(error.rule("TSH-10"));
            return;
        }
        self.texture(index, operation.span.clone());
        let next = index + 1;
        let both = self.context.bound.get(index..=next).is_some_and(|bound| bound == [true; 2]);
        if !both || next >= self.active {
            return;
        }
        // u' = u + M00 du + M10 dv, v' = v + M01 du + M11 dv; the registers have the order M00, M01, M11, M10.
        let [m00, m01, m10, m11] = stage.bump_matrix;
        let luminance = (operation.value == Operation::BumpEnvMapLuminance).then_some(stage.bump_luminance);
        let span = stage.color.operation.span.clone();
        let operation = ShaderOperation::BumpEnvironment { matrix: [m00, m01, m11, m10], luminance };
        self.units[next].operation = Some(Spanned { value: operation, span });
    }
}

/// Describes a stage for reports.
fn origin(index: usize, stage: &TextureStage) -> StageOrigin {
    let to = match stage.result {
        ResultArgument::Current => "",
        ResultArgument::Temp => " to Temp",
    };
    let rgb = format!("texture stage {index}: ColorOp {}{to}", half_text(&stage.color));
    let alpha = if stage.color.operation.value == Operation::DotProduct3 {
        format!("texture stage {index}: alpha of ColorOp DotProduct3{to}")
    } else {
        format!("texture stage {index}: AlphaOp {}{to}", half_text(&stage.alpha))
    };
    StageOrigin { rgb, alpha }
}

fn half_text(half: &Half) -> String {
    let operation = half.operation.value;
    let read = half.arguments.iter().zip(operation.reads()).filter(|(_, reads)| *reads);
    let arguments: Vec<String> = read.map(|(argument, _)| argument_text(&argument.value)).collect();
    match arguments.is_empty() {
        true => operation.name().to_owned(),
        false => format!("{}({})", operation.name(), arguments.join(", ")),
    }
}

fn argument_text(argument: &StageArgument) -> String {
    let complement = if argument.complement { " | Complement" } else { "" };
    let replicate = if argument.alpha_replicate { " | AlphaReplicate" } else { "" };
    format!("{}{complement}{replicate}", argument.source.name())
}
