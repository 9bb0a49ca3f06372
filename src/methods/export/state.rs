//! Words of the rasteriser, of fog and of the raster operations.

use ninebit::rop;
use ninebit::state::{
    Cull, DepthFormat, DepthRange, DepthTest, Draw, Fog, FrontFace, LineRasterization, PointRasterization, PolygonMode,
    PolygonStipple, ProvokingVertex, Rectangle, Scene, ShadeModel, StencilTest, Target, Topology,
};
use ninebit_program::registers::unit::{
    CLAMPS_DEPTH, CONVERSION, FLOAT_DEPTH, FOG_MODES, PERSPECTIVE, STENCIL_OPERATIONS, STENCIL_WRITE, SURFACE_DEPTH,
    W_BUFFER,
};
use ninebit_program::registers::{color_word, raster};

use super::memory::{MemoryMap, pitch};
use super::{ExportError, Words, refuse};
use crate::class::{self, Family};
use crate::draw::raster::POLYGON_MODES;

/// Returns the code of a choice.
pub(super) fn code<T: PartialEq>(all: &[(T, u32)], choice: T) -> u32 {
    all.iter().find(|(other, _)| *other == choice).map_or(0, |(_, code)| *code)
}

/// Returns the bits of SET_CONTROL0 that say how depths are stored.
fn float_bit(target: &Target) -> u32 {
    FLOAT_DEPTH.put(target.depth.is_some_and(|depth| depth.format.is_float()).into())
}

/// Binds a target.
pub(super) fn bind(words: &mut Words, placed: &MemoryMap, index: usize, target: &Target) {
    let depth = target.depth.map_or(DepthFormat::Z24S8, |depth| depth.format);
    let layout = if placed.swizzled[index] { 2 } else { 1 };
    let sides = if placed.swizzled[index] { target.width.ilog2() << 16 | target.height.ilog2() << 24 } else { 0 };
    let zeta = match (depth.has_stencil(), words.family) {
        (true, Family::Kelvin) => 2,
        (true, Family::Celsius) => 0,
        (false, _) => 1,
    };
    words.set(
        class::SET_SURFACE_FORMAT,
        raster::surface_format(target.format) | SURFACE_DEPTH.put(zeta) | layout << 8 | sides,
    );
    let zeta_pitch = pitch(target.width, if depth.has_stencil() { 4 } else { 2 });
    words.set(class::SET_SURFACE_PITCH, pitch(target.width, target.format.bytes()) & 0xffff | zeta_pitch << 16);
    words.set(class::SET_SURFACE_COLOR_OFFSET, placed.surfaces[index]);
    words.set(class::SET_SURFACE_ZETA_OFFSET, placed.depths[index]);
}

/// Clears a target to what it holds first.
pub(super) fn clear(words: &mut Words, placed: &MemoryMap, index: usize, target: &Target) {
    bind(words, placed, index, target);
    words.set(class::SET_SURFACE_CLIP_HORIZONTAL, target.width << 16);
    words.set(class::SET_SURFACE_CLIP_VERTICAL, target.height << 16);
    words.set(class::SET_CLEAR_RECT_HORIZONTAL, (target.width - 1) << 16);
    words.set(class::SET_CLEAR_RECT_VERTICAL, (target.height - 1) << 16);
    words.set(class::SET_CONTROL0, 1 << 20 | 1 | float_bit(target));
    let mut parts = 0;
    if target.contents.is_none() {
        words.set(class::SET_COLOR_CLEAR_VALUE, rop::surface::pack(target.format, target.clear_color));
        parts |= 0xf0;
    }
    if let Some(depth) = target.depth.filter(|_| target.depth_contents.is_none()) {
        let word =
            if depth.format.has_stencil() { depth.clear << 8 | u32::from(depth.clear_stencil) } else { depth.clear };
        words.set(class::SET_ZSTENCIL_CLEAR_VALUE, word);
        parts |= if depth.format.has_stencil() { 3 } else { 1 };
    }
    if parts != 0 {
        words.send(class::CLEAR_SURFACE, parts);
    }
}

/// Binds the target of a draw, and returns the pixels that the surface clip leaves; `None` if there are none.
pub(super) fn surface(words: &mut Words, scene: &Scene, placed: &MemoryMap, draw: &Draw) -> Option<Rectangle> {
    let target = scene.targets.get(draw.target)?;
    let whole = Rectangle { x: 0, y: 0, width: target.width, height: target.height };
    let clip = [target.clip, draw.scissor].into_iter().flatten().fold(whole, Rectangle::intersection);
    if clip.width == 0 || clip.height == 0 {
        return None;
    }
    bind(words, placed, draw.target, target);
    Some(clip)
}

/// Sets the state of a draw but that of its texture units.
pub(super) fn draw(words: &mut Words, scene: &Scene, draw: &Draw) -> Result<(), ExportError> {
    let target = &scene.targets[draw.target];
    let w_buffer = draw.depth_test.is_some_and(|test| test.w_buffer);
    let writes_stencil = draw.stencil_test.is_some_and(|test| test.write_mask != 0);
    let control = STENCIL_WRITE.put(writes_stencil.into())
        | float_bit(target)
        | W_BUFFER.put(w_buffer.into())
        | PERSPECTIVE.put(draw.perspective.into())
        | CONVERSION.put(draw.convert_yuv.into());
    words.set(class::SET_CONTROL0, control);
    figures(words, draw)?;
    fog(words, &draw.fog)?;
    window_clip(words, draw)?;
    words.set(class::SET_ALPHA_TEST_ENABLE, draw.alpha_test.is_some().into());
    if let Some(test) = draw.alpha_test {
        words.set(class::SET_ALPHA_FUNC, raster::compare_function(test.function));
        words.set(class::SET_ALPHA_REF, test.reference.into());
    }
    words.set(class::SET_BLEND_ENABLE, draw.blend.is_some().into());
    if let Some(blend) = draw.blend {
        words.set(class::SET_BLEND_FUNC_SFACTOR, raster::blend_factor(blend.source));
        words.set(class::SET_BLEND_FUNC_DFACTOR, raster::blend_factor(blend.destination));
        words.set(class::SET_BLEND_EQUATION, raster::blend_equation(blend.equation));
        words.set(class::SET_BLEND_COLOR, color_word(draw.blend_constant));
    }
    let mask = (0..4).map(|n| raster::COLOR_MASK[n].put(draw.color_mask[n].into())).sum();
    words.set(class::SET_COLOR_MASK, mask);
    words.set(class::SET_DITHER_ENABLE, 0);
    if words.family == Family::Kelvin {
        words.set(class::SET_LOGIC_OP_ENABLE, 0);
    }
    words.set(class::SET_DEPTH_TEST_ENABLE, draw.depth_test.is_some().into());
    if let Some(test) = &draw.depth_test {
        depth(words, test, target.depth.map_or(DepthFormat::Z24S8, |depth| depth.format));
    }
    words.set(class::SET_STENCIL_TEST_ENABLE, draw.stencil_test.is_some().into());
    if let Some(test) = &draw.stencil_test {
        stencil(words, test);
    }
    Ok(())
}

fn figures(words: &mut Words, draw: &Draw) -> Result<(), ExportError> {
    let flat = draw.shade_model == ShadeModel::Flat;
    words.set(class::SET_SHADE_MODEL, if flat { 0x1d00 } else { 0x1d01 });
    words.set(class::SET_FLAT_SHADE_OP, (draw.provoking_vertex == ProvokingVertex::First).into());
    words.set(class::SET_FRONT_POLYGON_MODE, code(&POLYGON_MODES, draw.polygon_modes.front));
    words.set(class::SET_BACK_POLYGON_MODE, code(&POLYGON_MODES, draw.polygon_modes.back));
    words.set(class::SET_STIPPLE_ENABLE, draw.polygon_stipple.is_some().into());
    if let Some(PolygonStipple(rows)) = &draw.polygon_stipple {
        for (n, row) in (0..).zip(rows) {
            words.set(class::SET_STIPPLE_PATTERN + 4 * n, *row);
        }
    }
    let smooth_lines = draw.lines.rasterization == LineRasterization::RectangularSmooth;
    words.set(class::SET_LINE_SMOOTH_ENABLE, smooth_lines.into());
    words.set(class::SET_POLY_SMOOTH_ENABLE, draw.smooth_polygons.into());
    words.set(class::SET_LINE_WIDTH, draw.lines.width.into());
    smoothing(words, draw)?;
    words.set(class::SET_POINT_SIZE, draw.point_size.into());
    words.set(class::SET_POINT_SMOOTH_ENABLE, draw.point_sprite.into());
    words.set(class::SET_POINT_PARAMS_ENABLE, draw.point_sizes.is_some().into());
    words.set(class::SET_FRONT_FACE, if draw.front_face == FrontFace::Clockwise { 0x900 } else { 0x901 });
    words.set(class::SET_CULL_FACE_ENABLE, (draw.cull != Cull::None).into());
    words.set(class::SET_CULL_FACE, if draw.cull == Cull::Front { 0x404 } else { 0x405 });
    Ok(())
}

/// LIN-2, PNT-1, SMO-1: sets the register whose first bit makes lines and points rectangles, and nothing smooth. Celsius has no such bit: there it is
/// clear for lines and polygons, and points have their sizes.
fn smoothing(words: &mut Words, draw: &Draw) -> Result<(), ExportError> {
    let faces = draw.topology.has_faces();
    let modes = [draw.polygon_modes.front, draw.polygon_modes.back];
    let lines = matches!(draw.topology, Topology::Lines | Topology::LineStrip | Topology::LineLoop);
    let has_lines = lines || faces && modes.contains(&PolygonMode::Line);
    let has_points = draw.topology == Topology::Points || faces && modes.contains(&PolygonMode::Point);
    let squares = draw.point_rasterization == PointRasterization::Rectangular;
    if words.family == Family::Celsius && has_points && !squares {
        return refuse("thin points have no word of nv10: take `point_rasterization: Rectangular`");
    }
    let wanted = [
        has_lines.then_some(draw.lines.rasterization == LineRasterization::Rectangular),
        (has_points && words.family == Family::Kelvin).then_some(squares),
        (faces && draw.smooth_polygons).then_some(false),
    ];
    let (rectangles, others) = [true, false].map(|bit| wanted.contains(&Some(bit))).into();
    if rectangles && others {
        return refuse(
            "`Rectangular` lines and points have no word beside smooth polygons, thin points and other lines: take one kind",
        );
    }
    match words.family {
        Family::Kelvin => words.set(class::SET_ANTI_ALIASING_CONTROL, 0xffff_0000 | u32::from(!others)),
        Family::Celsius if rectangles || others => {
            words.set(class::SET_ANTI_ALIASING_CONTROL, rectangles.into());
        }
        Family::Celsius => {}
    }
    Ok(())
}

fn fog(words: &mut Words, fog: &Fog) -> Result<(), ExportError> {
    let [r, g, b] = fog.color;
    words.set(class::SET_FOG_COLOR, u32::from_le_bytes([r, g, b, 0]));
    words.set(class::SET_FOG_ENABLE, fog.enabled.into());
    if !fog.enabled {
        return Ok(());
    }
    let Some(function) = fog.function else {
        return refuse("factors of fog that the vertices give have no word: give the fog a `mode`");
    };
    // NV10 knows no other than the first for linear fog, NV2A no other than the second.
    if words.family == Family::Kelvin && function.per_vertex {
        return refuse("linear fog that is evaluated at vertices has no word: take `evaluation: PerPixel`");
    }
    words.set(class::SET_FOG_MODE, code(&FOG_MODES, function.mode));
    for (n, parameter) in (0..).zip([function.p0, function.p1, function.p2]) {
        words.number(class::SET_FOG_PARAMS + 4 * n, parameter);
    }
    Ok(())
}

fn window_clip(words: &mut Words, draw: &Draw) -> Result<(), ExportError> {
    // Everything, where there is no clip.
    let everything = [Rectangle { x: 0, y: 0, width: 4096, height: 4096 }];
    let (rectangles, exclusive) =
        draw.window_clip.as_ref().map_or((&everything[..], false), |clip| (&clip.rectangles[..], clip.exclusive));
    if rectangles.iter().any(|rectangle| rectangle.width == 0 || rectangle.height == 0) {
        return refuse("a window clip rectangle without pixels has no word: leave it out");
    }
    words.set(class::SET_WINDOW_CLIP_TYPE, exclusive.into());
    for n in 0..8 {
        let Rectangle { x, y, width, height } = rectangles[n.min(rectangles.len() - 1)];
        let range = |first: u32, count: u32| first.min(4095) | first.saturating_add(count - 1).min(4095) << 16;
        words.set(class::SET_WINDOW_CLIP_HORIZONTAL + 4 * n as u32, range(x, width));
        words.set(class::SET_WINDOW_CLIP_VERTICAL + 4 * n as u32, range(y, height));
    }
    Ok(())
}

fn depth(words: &mut Words, test: &DepthTest, format: DepthFormat) {
    words.set(class::SET_DEPTH_FUNC, raster::compare_function(test.function));
    words.set(class::SET_DEPTH_MASK, test.write.into());
    let whole = DepthRange {
        lowest: 0.0,
        highest: if format.is_float() { f32::MAX } else { (f64::from(format.largest())) as f32 },
        clamps: true,
        drops_triangles: false,
    };
    let range = test.range.unwrap_or(whole);
    words.number(class::SET_CLIP_MIN, range.lowest);
    words.number(class::SET_CLIP_MAX, range.highest);
    words.set(class::SET_ZMIN_MAX_CONTROL, CLAMPS_DEPTH.put(range.clamps.into()) | u32::from(range.drops_triangles));
    let offset = test.offset;
    words.set(class::SET_POLY_OFFSET_FILL_ENABLE, (offset.bias != 0.0 || offset.factor != 0.0).into());
    words.number(class::SET_POLYGON_OFFSET_SCALE_FACTOR, offset.factor);
    words.number(class::SET_POLYGON_OFFSET_BIAS, offset.bias);
}

fn stencil(words: &mut Words, test: &StencilTest) {
    words.set(class::SET_STENCIL_FUNC, raster::compare_function(test.function));
    words.set(class::SET_STENCIL_FUNC_REF, test.reference.into());
    words.set(class::SET_STENCIL_FUNC_MASK, test.mask.into());
    words.set(class::SET_STENCIL_MASK, test.write_mask.into());
    words.set(class::SET_STENCIL_OP_FAIL, STENCIL_OPERATIONS[test.fail as usize]);
    words.set(class::SET_STENCIL_OP_ZFAIL, STENCIL_OPERATIONS[test.depth_fail as usize]);
    words.set(class::SET_STENCIL_OP_ZPASS, STENCIL_OPERATIONS[test.pass as usize]);
}
