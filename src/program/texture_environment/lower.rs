//! Lowers the texture environment to general stages: units, base formats and the modes that are older than combining.

use super::*;
use crate::cascade::{Alpha, Argument, Cascade, Channel, Destination, End, Equation, LoweredProgram, Source};
use ninebit::state::{Named, Profile, StageOrigin};

/// State of the draw that the lowering depends on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Context {
    /// The chip that runs the program.
    pub profile: Profile,
    /// Base format of each unit's texture; `None` for units without one, which are disabled.
    pub textures: [Option<BaseFormat>; TEXTURE_UNITS],
    /// Whether the colour of each texture unit can be negative.
    pub signed: [bool; TEXTURE_UNITS],
    /// Whether fog is enabled.
    pub fog: bool,
}

/// Lowers the environment for a draw.
///
/// # Errors
/// Findings about everything that the chip cannot do.
pub fn lower(program: &TextureEnvironment, context: &Context) -> Result<LoweredProgram, Vec<Diagnostic>> {
    let mut findings = Vec::new();
    let mut cascade = Cascade::new(context.profile, context.signed);
    let initial = Unit::initial();
    let mut textures = context.textures;
    for (texture, unit) in textures.iter_mut().zip(&program.units) {
        if let (Some(texture), Some(format)) = (texture, unit.base_format) {
            *texture = format;
        }
    }
    if let Some(unit) = program.units.get(context.profile.texture_units()) {
        let (index, chip) = (context.profile.texture_units(), context.profile.name());
        let message = format!("{chip} has no texture unit {index}");
        let help = format!("units 0 to {} are the entries of this list", index - 1);
        let error = finding("NB0319", unit.span.clone(), message, "one too many", help);
        findings.push(error.rule("CMB-12"));
    }
    for (index, texture) in textures.iter().enumerate() {
        // A unit without a texture is disabled: the colour passes through.
        let Some(format) = *texture else { continue };
        let unit = program.units.get(index).unwrap_or(&initial);
        match unit.mode {
            Mode::Combine | Mode::Combine4 => combine::unit(&mut cascade, index, unit, &textures, &mut findings),
            mode => {
                let own = Own { index, format };
                let (rgb, alpha) = classic(mode, own, Argument::new(Source::Constant(unit.color)));
                let text = |half: &str| format!("texture unit {index}: {} of {}, {half}", mode.name(), format.name());
                let origin = StageOrigin { rgb: text("colour"), alpha: text("alpha") };
                cascade.stage(unit.span.clone(), &rgb, Alpha::Equation(alpha), Destination::Current, origin);
            }
        }
    }
    cascade.finish("environment", End { specular: program.color_sum, fog: context.fog }, findings, ())
}

/// A unit's own texture, with its base format.
#[derive(Clone, Copy, Debug)]
pub(super) struct Own {
    pub(super) index: usize,
    pub(super) format: BaseFormat,
}

impl Own {
    /// Returns its colour, which is black for an alpha texture.
    pub(super) fn color(self) -> Argument {
        match self.format {
            BaseFormat::Alpha => Argument::ZERO,
            _ => Argument::new(Source::Texture(self.index)),
        }
    }

    /// Returns its alpha, for an equation of colour or of alpha; 1 if it has none. The alpha of an intensity is in its colour channels.
    pub(super) fn alpha(self, in_alpha: bool) -> Argument {
        let texture = Argument::new(Source::Texture(self.index));
        match self.format {
            BaseFormat::Luminance | BaseFormat::Rgb => Argument::ONE,
            BaseFormat::Intensity if in_alpha => Argument { channel: Channel::Blue, ..texture },
            BaseFormat::Intensity => texture,
            BaseFormat::Alpha | BaseFormat::LuminanceAlpha | BaseFormat::Rgba => texture.alpha(),
        }
    }
}

/// Returns the equations of colour and alpha for the modes Replace, Modulate, Decal, Blend and Add. Decal changes nothing if the format is neither
/// Rgb nor Rgba, a case that the API leaves undefined.
fn classic(mode: Mode, own: Own, constant: Argument) -> (Equation, Equation) {
    let previous = Argument::new(Source::Current);
    let pass = Equation::copy(previous);
    let (texture, alpha) = (own.color(), own.alpha(true));
    let intensity = own.format == BaseFormat::Intensity;
    let has_color = own.format != BaseFormat::Alpha;
    let has_alpha = !matches!(own.format, BaseFormat::Luminance | BaseFormat::Rgb);
    let modulated = if has_alpha { Equation::product(previous, alpha) } else { pass };
    let color = |equation: Equation| if has_color { equation } else { pass };
    match mode {
        Mode::Replace => (color(Equation::copy(texture)), if has_alpha { Equation::copy(alpha) } else { pass }),
        Mode::Modulate => (color(Equation::product(previous, texture)), modulated),
        Mode::Decal => match own.format {
            BaseFormat::Rgb => (Equation::copy(texture), pass),
            BaseFormat::Rgba => (Equation::lerp(own.alpha(false), texture, previous), pass),
            _ => (pass, pass),
        },
        Mode::Blend => {
            let alpha = if intensity { Equation::lerp(alpha, constant, previous) } else { modulated };
            (color(Equation::lerp(texture, constant, previous)), alpha)
        }
        Mode::Add => {
            let alpha = if intensity { Equation::sum(previous, alpha) } else { modulated };
            (color(Equation::sum(previous, texture)), alpha)
        }
        Mode::Combine | Mode::Combine4 => (pass, pass),
    }
}
