//! Checks of texture units beyond addressing and filtering: comparisons (SHD-1), anisotropy (TEX-17), cylindrical wrap
//! (CYL-1) and volumes (VOL-1).

use super::{Check, PlanError};
use crate::state::*;

impl Check<'_> {
    /// Refuses the state of a unit. `unknown` means that what the chip does is not known.
    fn refuse_unit(
        &mut self,
        unit: usize,
        rule: &'static str,
        unknown: bool,
        message: String,
        help: impl Into<String>,
    ) {
        let code = if unknown { "NB0402" } else { "NB0333" };
        self.errors.push(PlanError { draw: self.draw, unit: Some(unit), ..PlanError::new(code, rule, message, help) });
    }

    /// Checks how a unit samples a texture.
    pub(super) fn sampling(&mut self, draw: &Draw, index: usize, unit: &TextureUnit, texture: &Texture) {
        let plain = draw.texture_shader[index].operation == ShaderOperation::Sample;
        let nearest = unit.is_nearest() && unit.mip_filter == MipFilter::None;
        if texture.format.depth().is_some() || unit.shadow.is_some() {
            self.comparison(draw, index, unit, texture);
        }
        self.ends_of_face(draw, index, texture);
        let most = largest_anisotropy(self.scene.profile);
        let taps = unit.anisotropy;
        let flat = matches!(texture.kind, TextureKind::TwoDimensional | TextureKind::Rectangle);
        let one_filter = unit.mip_filter == MipFilter::None && unit.min_filter == unit.mag_filter;
        let compares = unit.shadow.is_some() || unit.color_key.is_some();
        if !taps.is_power_of_two() || taps > most {
            let message = format!("an anisotropy of {taps}");
            self.refuse_unit(
                index,
                "TEX-17",
                false,
                message,
                format!("take a power of two, at most {most} on this chip"),
            );
        } else if taps > 1 && !(flat && plain && one_filter) {
            let message = "it is not known how anisotropy goes with levels, two filters, cube maps or texture shaders";
            let help = "take `mip_filter: None`, one filter and a flat texture, or leave `anisotropy` out";
            self.refuse_unit(index, "TEX-17", true, message.to_string(), help);
        } else if taps > 1 && compares {
            let message = "it is not known how anisotropy goes with texels that are compared";
            self.refuse_unit(index, "TEX-17", true, message.to_string(), "leave `anisotropy` out");
        }
        if unit.cylindrical_wrap != [false; 2] && !(plain && texture.kind == TextureKind::TwoDimensional) {
            let message = "it is not known what a cylindrical wrap does with other textures than flat ones, and in a texture shader";
            self.refuse_unit(index, "CYL-1", true, message.to_string(), "leave `cylindrical_wrap` out");
        }
        if texture.kind == TextureKind::ThreeDimensional && !nearest {
            let message = "it is not known how a volume is filtered";
            let help = "write `min_filter: Nearest, mag_filter: Nearest`, without levels";
            self.refuse_unit(index, "VOL-1", true, message.to_string(), help);
        }
    }

    /// TEX-20: checks that a dot product for volumes reads a cube map only where that is known.
    fn ends_of_face(&mut self, draw: &Draw, index: usize, texture: &Texture) {
        let stage = draw.texture_shader[index];
        if stage.operation != ShaderOperation::DotProduct3D || texture.kind != TextureKind::Cube {
            return;
        }
        let q = (0..draw.vertices.len()).map(|vertex| draw.vertices.coordinates(vertex, stage.coordinate_set)[3]);
        if let Some(q) = q.into_iter().find(|q| *q != 0.0) {
            let message = format!("it is not known where DotProduct3D reads a cube map with q = {q}");
            let help = "take q = 0 at all vertices, a two-dimensional texture, or `DotProductCube`";
            self.refuse_unit(index, "TEX-20", true, message, help);
        }
    }

    /// SHD-1: checks that depths, and nothing else, are compared.
    fn comparison(&mut self, draw: &Draw, index: usize, unit: &TextureUnit, texture: &Texture) {
        let format = texture.format;
        let Some(shadow) = unit.shadow.filter(|_| format.depth().is_some()) else {
            let (message, help) = if unit.shadow.is_some() {
                let message = format!("texels of {} are no depths, and are not compared", format.name());
                (message, "take Z16, Z24S8, Z16F or Z24S8F, or leave `shadow` out")
            } else {
                let message = format!("depths ({}) are compared with nothing", format.name());
                (message, "write `shadow: (function: LessOrEqual)`, for example")
            };
            self.refuse_unit(index, "SHD-1", false, message, help);
            return;
        };
        let (nearest, sides) =
            (unit.is_nearest() && unit.mip_filter == MipFilter::None, [unit.address_s, unit.address_t]);
        let cases = [
            (!nearest, "under a filter", "write `min_filter: Nearest, mag_filter: Nearest`, without levels"),
            (sides.contains(&AddressMode::ClampToBorder), "beyond a border", "take another address mode"),
            (
                draw.texture_shader[index].operation != ShaderOperation::Sample,
                "where another unit sends it",
                "let the stage be `Sample`",
            ),
            (
                unit.signed != [false; 4] || unit.color_key.is_some(),
                "with signed channels or a colour key",
                "leave them out",
            ),
            (
                texture.kind == TextureKind::Cube || texture.kind == TextureKind::ThreeDimensional,
                "of cube maps and volumes",
                "take a flat texture",
            ),
        ];
        for (_, what, help) in cases.into_iter().filter(|case| case.0) {
            let message = format!("it is not known what a comparison of depths yields {what}");
            self.refuse_unit(index, "SHD-1", true, message, help);
        }
        let differs = |other: &TextureUnit| other.shadow.is_some_and(|other| other.function != shadow.function);
        if draw.textures.iter().flatten().any(differs) {
            let message = "two units compare depths by different functions".to_string();
            self.refuse_unit(index, "SHD-1", false, message, "the chip has one function for all units: write the same");
        }
    }
}
