//! Checks of lines, points and depth tests.

use super::Check;
use crate::legality;
use crate::state::*;

impl Check<'_> {
    /// Checks that sprites have coordinates on a picture.
    fn sprites(&mut self, draw: &Draw) {
        self.only_nv2a("NB0325", "PNT-2", draw.point_sprite, "a point sprite");
        let (unit, stage) = (draw.textures[SPRITE_UNIT], draw.texture_shader[SPRITE_UNIT].operation);
        let texture = unit.and_then(|unit| self.scene.textures.get(unit.texture));
        let is_plain = texture.is_none_or(|texture| {
            let flat = matches!(texture.kind, TextureKind::TwoDimensional | TextureKind::Rectangle);
            flat && texture.format.depth().is_none() && unit.is_none_or(|unit| unit.cylindrical_wrap == [false; 2])
        });
        if draw.point_sprite && (!is_plain || !matches!(stage, ShaderOperation::None | ShaderOperation::Sample)) {
            let message =
                format!("unit {SPRITE_UNIT} has a sprite's coordinates, and it is not known what it makes of them");
            let help =
                "let it sample a texture of two dimensions, without cylindrical wrap; or take `point_sprite: false`";
            self.refuse("NB0402", "PNT-2", message, help);
        }
        if draw.point_sprite && draw.point_rasterization == PointRasterization::Thin {
            let message = "it is not known which coordinates a sprite of one pixel has";
            let help = "take `point_rasterization: Rectangular`, or `point_sprite: false`";
            self.refuse("NB0402", "PNT-2", message, help);
        }
    }

    /// Checks widths of lines, sizes of points, and sprites.
    pub(super) fn strokes(&mut self, draw: &Draw) {
        let largest = draw.point_sizes.iter().flat_map(|sizes| sizes.iter()).max();
        for (rule, size, what) in [
            ("LIN-1", draw.lines.width, "width of lines"),
            ("PNT-1", draw.point_size.max(largest.copied().unwrap_or(0)), "size of points"),
        ] {
            if size > LARGEST_SIZE {
                let message = format!("the {what} is {size} eighths of a pixel");
                self.refuse("NB0206", rule, message, format!("the register has nine bits: take 0 to {LARGEST_SIZE}"));
            }
        }
        if let Some(sizes) = draw.point_sizes.as_ref().filter(|sizes| sizes.len() != draw.vertices.len()) {
            let message = format!("{} sizes of points for {} vertices", sizes.len(), draw.vertices.len());
            self.refuse("NB0211", "PNT-3", message, "give one for each vertex");
        }
        if let Some(flags) = draw.edge_flags.as_ref().filter(|flags| flags.len() != draw.vertices.len()) {
            let message = format!("{} edge flags for {} vertices", flags.len(), draw.vertices.len());
            self.refuse("NB0211", "POL-1", message, "give one for each vertex");
        }
        self.sprites(draw);
    }

    /// Checks a depth test.
    pub(super) fn depth_test(&mut self, draw: &Draw, test: &DepthTest) {
        self.accept(legality::draw::vertex_depths(test, &draw.positions, None));
        let PolygonOffset { bias, factor } = test.offset;
        if !bias.is_finite() || !factor.is_finite() {
            self.refuse(
                "NB0207",
                "DEP-5",
                format!("the polygon offset has bias {bias} and factor {factor}"),
                "take finite numbers",
            );
        }
        if test.w_buffer && factor != 0.0 {
            let message = "it is not known how a polygon offset's factor counts in a w buffer";
            self.refuse("NB0402", "DEP-6", message, "take a bias alone, or a z buffer");
        }
        if let Some(DepthRange { lowest, highest, .. }) = test.range
            && !(lowest.is_finite() && highest.is_finite() && lowest <= highest)
        {
            let message = format!("the depth range is {lowest} to {highest}");
            self.refuse("NB0206", "DEP-4", message, "take two finite numbers, the lower one first");
        }
    }
}
