//! Writes draws: the state around their vertices, textures and programs.

use super::node::{Fields, Node};
use super::texture::{Palettes, Textures};
use super::unit;
use crate::clear::Clear;
use ninebit::raster::binary::Binary;
use ninebit::raster::depth;
use ninebit::state::*;

/// The parts of a draw that several draws may share: as they are, or by name.
pub(super) struct Parts {
    pub(super) vertices: Node,
    pub(super) program: Option<Node>,
    pub(super) blend: Option<Node>,
}

/// Returns the blend function of a draw.
pub(super) fn blend(draw: &Draw) -> Option<Node> {
    let blend = draw.blend?;
    let mut fields = Fields::new("");
    fields.word("equation", blend.equation, BlendEquation::Add);
    fields.word("source", blend.source, BlendFactor::One);
    fields.word("destination", blend.destination, BlendFactor::Zero);
    Some(fields.into())
}

/// Returns the clear that a draw is, if a scene can say it.
pub(super) fn clear(draw: &Draw, target: &Target) -> Option<Fields> {
    let Clear { area, color, color_mask, depth, stencil } = Clear::from_draw(draw)?;
    let float = target.depth.is_some_and(|buffer| buffer.format.is_float());
    let word = |depth: f32| {
        let format = target.depth?.format;
        let word = depth::word(format, Binary::new(depth));
        (depth::of_word(format, word).map(f32::to_bits) == Some(depth.to_bits())).then_some(word)
    };
    let is_stated = |(unit, depth): (VertexDepths, f32)| match unit {
        VertexDepths::Fractions => (0.0..=if float { f32::MAX } else { 1.0 }).contains(&depth),
        VertexDepths::Steps => word(depth).is_some(),
    };
    if within(&area, target) != area || !depth.is_none_or(is_stated) {
        return None;
    }
    let mut fields = Fields::new("");
    if let Some(color) = color {
        fields.put("color", Node::color(color));
        mask(&mut fields, color_mask);
    }
    match depth {
        Some((VertexDepths::Fractions, depth)) => fields.put("depth", Node::number(depth)),
        Some((VertexDepths::Steps, depth)) => fields.put("depth_word", Node::word(format!("0x{:x}", word(depth)?))),
        None => {}
    }
    if let Some(stencil) = stencil {
        fields.put("stencil", Node::whole(stencil));
    }
    if area != (Rectangle { x: 0, y: 0, width: target.width, height: target.height }) {
        fields.put("rectangle", rectangle(&area));
    }
    Some(fields)
}

/// Writes all fields of a draw behind its name and target.
pub(super) fn state(
    fields: &mut Fields,
    (draw, target, scene): (&Draw, &Target, &Scene),
    parts: Parts,
    tables: (&Textures, &Palettes),
) -> Result<(), String> {
    fields.put("vertices", parts.vertices);
    indices(fields, draw);
    primitives(fields, draw);
    if let Some(area) = &draw.scissor {
        fields.put("scissor", rectangle(&within(area, target)));
    }
    if let Some(clip) = &draw.window_clip {
        let mut of = Fields::new("");
        of.put("rectangles", Node::list(clip.rectangles.iter().map(|area| visible(area, target))));
        of.flag("exclusive", clip.exclusive, false);
        fields.put("window_clip", of);
    }
    if draw.fog != Fog::default() {
        fields.put("fog", fog(&draw.fog, scene.profile)?);
    }
    unit::units(fields, draw, scene, tables)?;
    fields.flag("convert_yuv", draw.convert_yuv, false);
    if let Some(program) = parts.program {
        fields.put("program", program);
    }
    if let Some(test) = draw.alpha_test {
        let mut of = Fields::new("");
        of.put("function", Node::word(test.function.name()));
        of.whole("reference", test.reference, 0);
        fields.put("alpha_test", of);
    }
    if let Some(test) = draw.stencil_test {
        fields.put("stencil_test", stencil_test(&test));
    }
    if let Some(test) = draw.depth_test {
        fields.put("depth_test", depth_test(&test)?);
    }
    if let Some(blend) = parts.blend {
        fields.put("blend", blend);
    }
    fields.color("blend_constant", draw.blend_constant, [0; 4]);
    mask(fields, draw.color_mask);
    Ok(())
}

/// Writes the indices, unless they name every vertex once, in order. Those that make no whole primitive are left out.
fn indices(fields: &mut Fields, draw: &Draw) {
    let indices = &draw.indices[..whole(draw.topology, draw.indices.len())];
    if !(indices.len() == draw.vertices.len() && indices.iter().zip(0..).all(|(index, n)| *index == n)) {
        fields.put("indices", Node::filled(indices.iter().map(|index| Node::whole(*index))));
    }
}

/// Returns how many of `count` indices make whole primitives.
fn whole(topology: Topology, count: usize) -> usize {
    let (least, step) = match topology {
        Topology::Triangles => (0, 3),
        Topology::Quads => (0, 4),
        Topology::QuadStrip => (4, 2),
        Topology::TriangleStrip | Topology::TriangleFan | Topology::Polygon => (3, 1),
        Topology::Points => (0, 1),
        Topology::Lines => (0, 2),
        Topology::LineStrip | Topology::LineLoop => (2, 1),
    };
    if count < least { 0 } else { count - count % step }
}

/// Writes how vertices become pixels.
fn primitives(fields: &mut Fields, draw: &Draw) {
    let default = Draw::default();
    fields.word("topology", draw.topology, default.topology);
    fields.word("shade_model", draw.shade_model, default.shade_model);
    fields.word("provoking_vertex", draw.provoking_vertex, default.provoking_vertex);
    fields.flag("perspective", draw.perspective, default.perspective);
    fields.word("cull", draw.cull, default.cull);
    fields.word("front_face", draw.front_face, default.front_face);
    fields.word("front_polygon_mode", draw.polygon_modes.front, default.polygon_modes.front);
    fields.word("back_polygon_mode", draw.polygon_modes.back, default.polygon_modes.back);
    if let Some(flags) = &draw.edge_flags {
        let hidden = (0_i64..).zip(flags.iter()).filter(|(_, flag)| !**flag).map(|(vertex, _)| Node::whole(vertex));
        fields.put("hidden_edges", Node::filled(hidden));
    }
    if let Some(PolygonStipple(words)) = &draw.polygon_stipple {
        fields.put("polygon_stipple", Node::filled(words.iter().map(|word| Node::word(format!("0x{word:08x}")))));
    }
    fields.flag("smooth_polygons", draw.smooth_polygons, default.smooth_polygons);
    fields.whole("line_width", draw.lines.width, default.lines.width.into());
    fields.word("line_rasterization", draw.lines.rasterization, default.lines.rasterization);
    fields.whole("point_size", draw.point_size, default.point_size.into());
    fields.word("point_rasterization", draw.point_rasterization, default.point_rasterization);
    fields.flag("point_sprite", draw.point_sprite, default.point_sprite);
}

/// Returns a fog function as a reader makes it of what is written here. Nothing that is drawn differs.
pub(super) fn written_function(function: &FogFunction, profile: Profile) -> FogFunction {
    let per_vertex = function.per_vertex || profile == Profile::Nv10;
    // Linear fog of each pixel has no third parameter.
    let p2 = if function.mode.is_linear() && !per_vertex { 0.0 } else { function.p2 };
    FogFunction { per_vertex, p2, ..*function }
}

fn fog(fog: &Fog, profile: Profile) -> Result<Fields, String> {
    let mut fields = Fields::new("");
    fields.flag("enabled", fog.enabled, true);
    let [r, g, b] = fog.color;
    fields.color("color", [r, g, b, 255], [0, 0, 0, 255]);
    let Some(function) = &fog.function else { return Ok(fields) };
    if profile == Profile::Nv10 && function.mode.is_linear() && !function.per_vertex {
        return Err("its linear fog is evaluated at each pixel, which a scene has on Nv2a alone".to_owned());
    }
    if profile == Profile::Nv10 && function.mode == FogMode::LinearAbs {
        return Err("its fog has the mode LinearAbs, which a scene has on Nv2a alone".to_owned());
    }
    let FogFunction { mode, p0, p1, p2, per_vertex } = written_function(function, profile);
    if ![p0, p1, p2].iter().all(|parameter| parameter.is_finite()) {
        return Err(format!("a parameter of its fog is not finite: {p0}, {p1}, {p2}"));
    }
    fields.put("mode", Node::word(mode.name()));
    let all = [p0, p1, p2];
    fields.put("parameters", Node::numbers(if p2.to_bits() == 0 { &all[..2] } else { &all }));
    if per_vertex && profile == Profile::Nv2a {
        fields.put("evaluation", Node::word("PerVertex"));
    }
    Ok(fields)
}

fn depth_test(test: &DepthTest) -> Result<Fields, String> {
    let default = DepthTest::new(CompareFunction::Less, true);
    let mut fields = Fields::new("");
    fields.word("function", test.function, default.function);
    fields.flag("write", test.write, default.write);
    fields.word("vertex_depths", test.vertex_depths, default.vertex_depths);
    fields.flag("w_buffer", test.w_buffer, default.w_buffer);
    if let Some(DepthRange { lowest, highest, clamps, drops_triangles }) = test.range {
        if !(lowest.is_finite() && highest.is_finite() && lowest <= highest) {
            return Err(format!("its depth range is {lowest} to {highest}"));
        }
        let mut range = Fields::new("");
        range.put("lowest", Node::number(lowest));
        range.put("highest", Node::number(highest));
        range.flag("clamp", clamps, false);
        range.flag("drop_triangles", drops_triangles, false);
        fields.put("range", range);
    }
    let PolygonOffset { bias, factor } = test.offset;
    if !(bias.is_finite() && factor.is_finite()) {
        return Err(format!("its polygon offset has bias {bias} and factor {factor}"));
    }
    let mut offset = Fields::new("");
    offset.number("bias", bias, 0.0);
    offset.number("factor", factor, 0.0);
    fields.put_some("offset", offset);
    Ok(fields)
}

fn stencil_test(test: &StencilTest) -> Fields {
    let mut fields = Fields::new("");
    fields.word("function", test.function, CompareFunction::Always);
    fields.whole("reference", test.reference, 0);
    fields.whole("mask", test.mask, 255);
    fields.whole("write_mask", test.write_mask, 255);
    fields.word("fail", test.fail, StencilOperation::Keep);
    fields.word("depth_fail", test.depth_fail, StencilOperation::Keep);
    fields.word("pass", test.pass, StencilOperation::Keep);
    fields
}

fn mask(fields: &mut Fields, mask: [bool; 4]) {
    if mask != [true; 4] {
        fields.put("color_mask", Node::flags(&mask));
    }
}

pub(super) fn rectangle(area: &Rectangle) -> Fields {
    let mut fields = Fields::new("");
    fields.whole("x", area.x, 0);
    fields.whole("y", area.y, 0);
    fields.put("width", Node::whole(area.width));
    fields.put("height", Node::whole(area.height));
    fields
}

/// Returns the part of a rectangle that lies in a target.
pub(super) fn within(area: &Rectangle, target: &Target) -> Rectangle {
    Rectangle { x: 0, y: 0, width: target.width, height: target.height }.intersection(*area)
}

/// Returns the part of a window clip's rectangle that lies in the target. In place of nothing it is a pixel outside.
fn visible(area: &Rectangle, target: &Target) -> Node {
    let inside = within(area, target);
    let outside = Rectangle { x: target.width, y: 0, width: 1, height: 1 };
    rectangle(if inside.width == 0 || inside.height == 0 { &outside } else { &inside }).into()
}
