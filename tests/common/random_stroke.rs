//! Lines, points, sprites, polygon modes and patterns of random scenes.

use super::Choices;
use ninebit::state::*;

/// Returns whether the unit of sprites samples a picture, or nothing.
fn can_be_sprite(textures: &[Texture], draw: &Draw) -> bool {
    let kind = draw.textures[SPRITE_UNIT].map(|unit| textures[unit.texture].kind);
    let is_flat = kind.is_none_or(|kind| matches!(kind, TextureKind::TwoDimensional | TextureKind::Rectangle));
    is_flat && matches!(draw.texture_shader[SPRITE_UNIT].operation, ShaderOperation::None | ShaderOperation::Sample)
}

/// Sends some vertices of filled triangles in window coordinates far away, and some behind the eye (RAS-8).
fn send_away(draw: &mut Draw) {
    let are_filled = draw.topology.has_faces() && draw.polygon_modes == PolygonModes::FILL && !draw.smooth_polygons;
    if !are_filled || !matches!(draw.positions, Positions::Window) {
        return;
    }
    let [far, behind] = [draw.blend_constant[0], draw.blend_constant[3]].map(|n| n as usize % 5 + 2);
    let perspective = draw.perspective;
    draw.vertices.update(|n, vertex| {
        let [x, y, _, w] = &mut vertex.position;
        if n % far == 1 {
            (*x, *y) = (*x * 900.0 + 17.0, *y * -77.0);
        }
        if n % behind == 0 && perspective {
            *w = -*w;
        }
    });
}

/// Makes lines or points of some draws, gives sides of faces other modes, and fills triangles by a pattern.
pub fn stroke(c: &mut Choices<'_>, (profile, textures): (Profile, &[Texture]), draw: &mut Draw) {
    let size = |c: &mut Choices<'_>| match c.below(4) {
        0 => c.pick(&[8, 0, 1, 4, 16, 24, 32, 64, 128, 511]),
        1 => c.below(512) as u16,
        _ => c.below(80) as u16,
    };
    match c.below(6) {
        1 => draw.topology = c.pick(&[Topology::Lines, Topology::LineStrip, Topology::LineLoop, Topology::Points]),
        2 => {
            draw.polygon_modes = PolygonModes { front: c.any(), back: c.any() };
            if c.once_in(3) {
                draw.edge_flags = Some((0..draw.vertices.len()).map(|_| c.once_in(2)).collect());
            }
        }
        _ => {}
    }
    // No word of the tape, so that the other choices stay the same.
    draw.convert_yuv = profile == Profile::Nv2a && draw.blend_constant[3] % 5 == 1;
    draw.smooth_polygons = draw.blend_constant[2] % 6 == 1;
    if draw.blend_constant[1] % 5 == 1 {
        send_away(draw);
    }
    draw.point_sprite = c.once_in(2) && profile == Profile::Nv2a && can_be_sprite(textures, draw);
    let is_thin = !draw.point_sprite && draw.blend_constant[1] % 2 == 1;
    draw.point_rasterization = if is_thin { PointRasterization::Thin } else { PointRasterization::Rectangular };
    (draw.lines, draw.point_size) = (Lines { width: size(c), rasterization: c.any() }, size(c));
    if c.once_in(3) {
        draw.point_sizes = Some((0..draw.vertices.len()).map(|_| size(&mut c.part(4))).collect());
    }
    if c.once_in(6) {
        let (style, row) = (c.below(4), c.word());
        draw.polygon_stipple = Some(PolygonStipple(std::array::from_fn(|n| match style {
            0 => c.word() | c.word(),
            1 => row.rotate_left(n as u32),
            2 => row,
            _ => {
                if n % 3 == 0 {
                    u32::MAX
                } else {
                    0
                }
            }
        })));
    }
}
