//! Lowers units in the modes Combine and Combine4.

use super::lower::Own;
use super::*;
use crate::cascade::{Alpha, Argument, Cascade, Destination, Equation, Source};
use ninebit::state::{Named, StageOrigin};

impl Function {
    /// Returns whether it is a dot product.
    pub fn is_dot(self) -> bool {
        matches!(self, Function::Dot3RgbArb | Function::Dot3RgbaArb | Function::Dot3RgbExt | Function::Dot3RgbaExt)
    }

    fn is_unscaled(self) -> bool {
        matches!(self, Function::Dot3RgbExt | Function::Dot3RgbaExt)
    }

    fn writes_alpha(self) -> bool {
        matches!(self, Function::Dot3RgbaArb | Function::Dot3RgbaExt)
    }

    /// Returns which of the arguments 0 to 3 it reads in a mode.
    pub fn reads(self, mode: Mode) -> [bool; 4] {
        match self {
            _ if mode == Mode::Combine4 => [true; 4],
            Function::Replace => [true, false, false, false],
            Function::Interpolate => [true, true, true, false],
            _ => [true, true, false, false],
        }
    }
}

/// Adds the stages of a unit to the cascade.
pub(super) fn unit(
    cascade: &mut Cascade,
    index: usize,
    unit: &Unit,
    textures: &[Option<BaseFormat>; TEXTURE_UNITS],
    findings: &mut Vec<Diagnostic>,
) {
    let function = unit.rgb.function.value;
    let halves: &[(&Half, bool)] = match function.writes_alpha() {
        true => &[(&unit.rgb, false)],
        false => &[(&unit.rgb, false), (&unit.alpha, true)],
    };
    for (half, alpha) in halves {
        legal(unit, half, *alpha, findings);
    }
    let crossbar = halves.iter().flat_map(|(half, _)| read(unit.mode, half)).filter_map(other);
    if unit.mode == Mode::Combine && crossbar.into_iter().any(|other| textures[other].is_none()) {
        // ARB_texture_env_crossbar: a unit that reads a disabled texture is itself disabled.
        return;
    }
    let walk = Arguments { index, unit, textures };
    let rgb_scale = if function.is_unscaled() { Scale::One } else { unit.rgb.scale };
    // The EXT functions leave ALPHA_SCALE to a separate alpha.
    let alpha_scale = if function == Function::Dot3RgbaExt { Scale::One } else { unit.alpha.scale };
    let origin = StageOrigin { rgb: origin(index, unit, false), alpha: origin(index, unit, true) };
    let mut rgb = Combination::from_mode(unit.mode, function, walk.all(&unit.rgb, false), rgb_scale);
    let mut alpha = if function.writes_alpha() {
        Combination { first: Equation::copy(Argument::ZERO), then: None }
    } else {
        Combination::from_mode(unit.mode, unit.alpha.function.value, walk.all(&unit.alpha, true), alpha_scale)
    };
    let separate = function.writes_alpha() && rgb_scale != alpha_scale;
    if separate {
        // The dot product goes to all channels unscaled; a second stage scales each half.
        rgb.first = rgb.first.scaled(Scale::One);
        (rgb.then, alpha.then) = (Some(rgb_scale), Some(alpha_scale));
    }
    let first = if function.writes_alpha() { Alpha::DotProduct } else { Alpha::Equation(alpha.first) };
    cascade.stage(unit.span.clone(), &rgb.first, first, Destination::Current, origin.clone());
    if rgb.then.is_some() || alpha.then.is_some() {
        let current = Argument::new(Source::Current);
        let [rgb, alpha] =
            [rgb.then, alpha.then].map(|scale| Equation::copy(current).scaled(scale.unwrap_or(Scale::One)));
        let text = |text: String| format!("{text}, scale");
        let origin = StageOrigin { rgb: text(origin.rgb), alpha: text(origin.alpha) };
        cascade.stage(unit.span.clone(), &rgb, Alpha::Equation(alpha), Destination::Current, origin);
    }
}

/// A function in terms of the combiners: an equation, and perhaps a scale that needs a stage of its own.
struct Combination {
    first: Equation,
    then: Option<Scale>,
}

impl Combination {
    fn from_mode(mode: Mode, function: Function, [a0, a1, a2, a3]: [Argument; 4], scale: Scale) -> Combination {
        let one = |first| Combination { first, then: None };
        if mode == Mode::Combine4 {
            let sum = Equation::products([a0, a1], [a2, a3]);
            return match (function, scale) {
                // A bias cannot be combined with scale 4, so scale 2 is applied twice.
                (Function::AddSigned, Scale::Four) => {
                    Combination { first: sum.biased().scaled(Scale::Two), then: Some(Scale::Two) }
                }
                (Function::AddSigned, scale) => one(sum.biased().scaled(scale)),
                (_, scale) => one(sum.scaled(scale)),
            };
        }
        one(match function {
            Function::Replace => Equation::copy(a0).scaled(scale),
            Function::Modulate => Equation::product(a0, a1).scaled(scale),
            Function::Add => Equation::sum(a0, a1).scaled(scale),
            Function::AddSigned => Equation::signed_sum(a0, a1, scale),
            Function::Interpolate => Equation::lerp(a2, a0, a1).scaled(scale),
            Function::Subtract => Equation::difference(a0, a1).scaled(scale),
            _ => Equation::dot(a0, a1).scaled(scale),
        })
    }
}

/// Checks that a half has a function and arguments that its mode allows.
fn legal(unit: &Unit, half: &Half, alpha: bool, findings: &mut Vec<Diagnostic>) {
    let (mode, function) = (unit.mode, half.function.value);
    let fits = mode != Mode::Combine4 || matches!(function, Function::Add | Function::AddSigned);
    if !fits && half.function.span.is_empty() {
        let what = if alpha { "combine_alpha" } else { "combine_rgb" };
        let message = format!("a unit in mode Combine4 says its `{what}`");
        let help =
            format!("write `{what}: Add` or `AddSigned`; what the API starts with, Modulate, is none of Combine4's");
        findings.push(finding("NB0353", unit.span.clone(), message, "this one does not", help));
        return;
    }
    let mut wrong = |message: String, help: &str| {
        findings.push(finding("NB0353", half.function.span.clone(), message, "not here", help));
    };
    if alpha && function.is_dot() {
        wrong(
            format!("the alpha of a unit cannot be {}", function.name()),
            "write `combine_rgb: Dot3RgbaArb` for a dot product in all four channels",
        );
    } else if !fits {
        wrong(format!("Combine4 has no {}", function.name()), "write Add or AddSigned, or `mode: Combine`");
    }
    let reads = function.reads(mode);
    for n in (0..4).filter(|n| reads[*n]) {
        let (source, operand) = (&half.sources[n], &half.operands[n]);
        let color = matches!(operand.value, Operand::SourceColor | Operand::OneMinusSourceColor);
        if alpha && color {
            let message = format!("the alpha of a unit has no {}", operand.value.name());
            let help = "write SourceAlpha or OneMinusSourceAlpha";
            findings.push(finding("NB0353", operand.span.clone(), message, "not here", help));
        }
        if mode == Mode::Combine && source.value == EnvironmentSource::Zero {
            let help = "write `mode: Combine4`, or another source";
            findings.push(finding("NB0353", source.span.clone(), "Combine has no source Zero", "not here", help));
        }
    }
}

/// Returns the sources that a half reads.
fn read(mode: Mode, half: &Half) -> Vec<EnvironmentSource> {
    let reads = half.function.value.reads(mode);
    half.sources.iter().zip(reads).filter(|(_, reads)| *reads).map(|(source, _)| source.value).collect()
}

/// Returns the unit that a source names by number, if it does.
fn other(source: EnvironmentSource) -> Option<usize> {
    let unit = (source as usize).checked_sub(EnvironmentSource::Texture0 as usize);
    unit.filter(|unit| *unit < TEXTURE_UNITS)
}

/// Makes the arguments of a unit's equations.
struct Arguments<'u> {
    index: usize,
    unit: &'u Unit,
    textures: &'u [Option<BaseFormat>; TEXTURE_UNITS],
}

impl Arguments<'_> {
    fn all(&self, half: &Half, alpha: bool) -> [Argument; 4] {
        let reads = half.function.value.reads(self.unit.mode);
        std::array::from_fn(|n| {
            if reads[n] { self.argument(half.sources[n].value, half.operands[n].value, alpha) } else { Argument::ZERO }
        })
    }

    fn argument(&self, source: EnvironmentSource, operand: Operand, in_alpha: bool) -> Argument {
        let wants_alpha = in_alpha || matches!(operand, Operand::SourceAlpha | Operand::OneMinusSourceAlpha);
        let plain = |source| {
            let argument = Argument::new(source);
            if wants_alpha && !in_alpha { argument.alpha() } else { argument }
        };
        let argument = match source {
            EnvironmentSource::Constant => plain(Source::Constant(self.unit.color)),
            EnvironmentSource::PrimaryColor => plain(Source::Primary),
            EnvironmentSource::Previous => plain(Source::Current),
            EnvironmentSource::Zero => Argument::ZERO,
            texture => {
                let index = other(texture).unwrap_or(self.index);
                match self.textures[index] {
                    Some(format) if wants_alpha => Own { index, format }.alpha(in_alpha),
                    Some(format) => Own { index, format }.color(),
                    // NV_texture_env_combine4: a disabled texture is 1.
                    None => Argument::ONE,
                }
            }
        };
        match operand {
            Operand::SourceColor | Operand::SourceAlpha => argument,
            Operand::OneMinusSourceColor | Operand::OneMinusSourceAlpha => argument.inverted(),
        }
    }
}

/// Describes a half of a unit for reports.
fn origin(index: usize, unit: &Unit, alpha: bool) -> String {
    let dot = alpha && unit.rgb.function.value.writes_alpha();
    let half = if alpha && !dot { &unit.alpha } else { &unit.rgb };
    let function = half.function.value;
    let reads = function.reads(unit.mode);
    let arguments: Vec<String> = (0..4)
        .filter(|n| reads[*n])
        .map(|n| format!("{} of {}", half.operands[n].value.name(), half.sources[n].value.name()))
        .collect();
    let what = if alpha && !dot { "alpha" } else { "RGB" };
    let scale = match half.scale {
        Scale::Two if !function.is_unscaled() => ", scale 2",
        Scale::Four if !function.is_unscaled() => ", scale 4",
        _ => "",
    };
    format!("texture unit {index}: {} {what} {}({}){scale}", unit.mode.name(), function.name(), arguments.join(", "))
}
