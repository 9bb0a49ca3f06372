//! Rasteriser, fog and raster operations of a draw.

use ninebit::state::{
    AlphaTest, Blend, BlendEquation, BlendFactor, CompareFunction, Cull, DepthFormat, DepthRange, DepthTest, Draw, Fog,
    FogFunction, FogMode, FrontFace, LineRasterization, Lines, Named, PointRasterization, PolygonMode, PolygonModes,
    PolygonOffset, PolygonStipple, ProvokingVertex, Rectangle, ShadeModel, StencilOperation, StencilTest, Topology,
    VertexDepths, WindowClip,
};
use ninebit_program::registers::unit::{
    CLAMPS_DEPTH, CONVERSION, FOG_MODES, PERSPECTIVE, STENCIL_OPERATIONS, STENCIL_WRITE, W_BUFFER,
};
use ninebit_program::registers::{color_of, raster};

use super::view::View;
use crate::celsius;
use crate::class::{self, Family};
use crate::gap::Gap;

/// The primitives' values, in the order of [`Topology`].
pub(crate) const TOPOLOGIES: [(Topology, u32); Topology::ALL.len()] = [
    (Topology::Triangles, 5),
    (Topology::TriangleStrip, 6),
    (Topology::TriangleFan, 7),
    (Topology::Quads, 8),
    (Topology::QuadStrip, 9),
    (Topology::Polygon, 10),
    (Topology::Points, 1),
    (Topology::Lines, 2),
    (Topology::LineStrip, 4),
    (Topology::LineLoop, 3),
];

/// The polygon modes' values.
pub(crate) const POLYGON_MODES: [(PolygonMode, u32); 3] =
    [(PolygonMode::Fill, 0x1b02), (PolygonMode::Line, 0x1b01), (PolygonMode::Point, 0x1b00)];

/// Returns the topology of a primitive.
pub(crate) fn topology(primitive: u32) -> Option<Topology> {
    TOPOLOGIES.iter().find(|(_, value)| *value == primitive).map(|(topology, _)| *topology)
}

/// Returns the value among `all` that a method has; another one is noted, and the first stands for it.
fn choose<T: Copy>(view: &mut View<'_>, method: u32, all: &[(T, u32)]) -> T {
    let word = view.get(method);
    let found = all.iter().find(|(_, value)| *value == word).map(|(choice, _)| *choice);
    found.unwrap_or_else(|| {
        view.bad(method);
        all[0].0
    })
}

fn compare(view: &mut View<'_>, method: u32) -> CompareFunction {
    choose(view, method, &with_values(CompareFunction::ALL, raster::compare_function))
}

/// Returns choices with their values.
fn with_values<T: Copy>(all: &[T], value: impl Fn(T) -> u32) -> Vec<(T, u32)> {
    all.iter().map(|choice| (*choice, value(*choice))).collect()
}

/// Fills in the state that surrounds the vertices. `depth` is the format of the depth buffer. Returns whether anything can be left of the draw.
pub(crate) fn state(view: &mut View<'_>, depth: DepthFormat, draw: &mut Draw) -> bool {
    figures(view, draw);
    let visible = faces(view, draw);
    draw.fog = fog(view);
    draw.window_clip = window_clip(view);
    operations(view, draw);
    let control = view.get(class::SET_CONTROL0);
    tests(view, depth, control, draw);
    draw.perspective = PERSPECTIVE.is_set(control);
    match CONVERSION.value_in(control) {
        0 => {}
        1 => draw.convert_yuv = true,
        other => view.note(Gap::NotModelled(format!("conversion {other} of the units' colours"))),
    }
    visible
}

/// LIN-2, PNT-1, SMO-1: returns whether the register for smoothing has its first bit set. Then lines and points are rectangles, and nothing is smooth.
fn has_rectangles(view: &mut View<'_>) -> bool {
    view.get(class::SET_ANTI_ALIASING_CONTROL) & 1 != 0
}

/// Returns whether edges are smooth.
fn smooths(view: &mut View<'_>, enable: u32) -> bool {
    view.enabled(enable) && !has_rectangles(view)
}

fn figures(view: &mut View<'_>, draw: &mut Draw) {
    let models = [(ShadeModel::Smooth, 0x1d01), (ShadeModel::Flat, 0x1d00)];
    draw.shade_model = choose(view, class::SET_SHADE_MODEL, &models);
    if draw.shade_model == ShadeModel::Flat {
        let vertices = [(ProvokingVertex::Last, 0), (ProvokingVertex::First, 1)];
        draw.provoking_vertex = choose(view, class::SET_FLAT_SHADE_OP, &vertices);
    }
    let points = draw.topology == Topology::Points;
    let mut lines = matches!(draw.topology, Topology::Lines | Topology::LineStrip | Topology::LineLoop);
    let mut corners = points;
    if draw.topology.has_faces() {
        let front = choose(view, class::SET_FRONT_POLYGON_MODE, &POLYGON_MODES);
        let back = choose(view, class::SET_BACK_POLYGON_MODE, &POLYGON_MODES);
        draw.polygon_modes = PolygonModes { front, back };
        lines |= front == PolygonMode::Line || back == PolygonMode::Line;
        corners |= front == PolygonMode::Point || back == PolygonMode::Point;
        if view.enabled(class::SET_STIPPLE_ENABLE) {
            draw.polygon_stipple =
                Some(PolygonStipple(std::array::from_fn(|row| view.get(class::SET_STIPPLE_PATTERN + 4 * row as u32))));
        }
        draw.smooth_polygons = smooths(view, class::SET_POLY_SMOOTH_ENABLE);
    }
    if lines {
        let width = (view.get(class::SET_LINE_WIDTH) & 0x1ff) as u16;
        let rectangles = has_rectangles(view);
        let rasterization = match smooths(view, class::SET_LINE_SMOOTH_ENABLE) {
            true => LineRasterization::RectangularSmooth,
            false if rectangles => LineRasterization::Rectangular,
            false => LineRasterization::Bresenham,
        };
        draw.lines = Lines { width, rasterization };
    }
    if corners {
        draw.point_size = (view.get(class::SET_POINT_SIZE) & 0x1ff) as u16;
        let smooth = view.enabled(class::SET_POINT_SMOOTH_ENABLE);
        // Sprites and thin points are Kelvin's; the bit of sprites made round points before.
        match view.family() {
            Family::Kelvin if has_rectangles(view) => draw.point_sprite = smooth,
            Family::Kelvin => {
                draw.point_rasterization = PointRasterization::Thin;
                if smooth {
                    view.note(Gap::NotModelled("sprites of one pixel".into()));
                }
            }
            Family::Celsius if smooth => view.note(Gap::NotModelled("smooth points".into())),
            Family::Celsius => {}
        }
    }
    if view.family() == Family::Celsius {
        for number in celsius::NOT_MODELLED {
            if view.state().get(number).unwrap_or(0) != 0 {
                view.note(Gap::NotModelled(Family::Celsius.label(number)));
            }
        }
    }
}

/// Reads which faces are drawn; returns whether any are.
fn faces(view: &mut View<'_>, draw: &mut Draw) -> bool {
    if !draw.topology.has_faces() {
        return true;
    }
    let two_sides = draw.polygon_modes.front != draw.polygon_modes.back;
    let culls = view.enabled(class::SET_CULL_FACE_ENABLE);
    if culls || two_sides {
        let faces = [(FrontFace::CounterClockwise, 0x901), (FrontFace::Clockwise, 0x900)];
        draw.front_face = choose(view, class::SET_FRONT_FACE, &faces);
    }
    if culls {
        let word = view.get(class::SET_CULL_FACE);
        draw.cull = match word {
            0x404 => Cull::Front,
            0x405 => Cull::Back,
            0x408 => return false,
            _ => {
                view.bad(class::SET_CULL_FACE);
                Cull::None
            }
        };
    }
    true
}

fn fog(view: &mut View<'_>) -> Fog {
    let mut fog = Fog::default();
    let [r, g, b, _] = view.get_or(class::SET_FOG_COLOR, 0).to_le_bytes();
    fog.color = [r, g, b];
    fog.enabled = view.enabled(class::SET_FOG_ENABLE);
    if fog.enabled {
        view.get(class::SET_FOG_COLOR);
        // Celsius has no absolute linear fog.
        let has = |mode: FogMode| view.family() == Family::Kelvin || mode != FogMode::LinearAbs;
        let modes: Vec<_> = FOG_MODES.into_iter().filter(|(mode, _)| has(*mode)).collect();
        let mode = choose(view, class::SET_FOG_MODE, &modes);
        let mut parameter = |n: u32| view.float(class::SET_FOG_PARAMS + 4 * n);
        let (p0, p1) = (parameter(0), parameter(1));
        let p2 = if mode.is_linear() { 0.0 } else { parameter(2) };
        let per_vertex = view.family() == Family::Celsius && mode.is_linear();
        fog.function = Some(FogFunction { mode, p0, p1, p2, per_vertex });
    }
    fog
}

fn window_clip(view: &mut View<'_>) -> Option<WindowClip> {
    let words: Vec<[Option<u32>; 2]> = (0..8)
        .map(|n| {
            [class::SET_WINDOW_CLIP_HORIZONTAL, class::SET_WINDOW_CLIP_VERTICAL].map(|first| view.word(first + 4 * n))
        })
        .collect();
    let exclusive = view.get_or(class::SET_WINDOW_CLIP_TYPE, 0) & 1 != 0;
    // A program that never sets the rectangles has the driver's, which take in everything.
    if words.iter().all(|pair| pair == &[None, None]) {
        return None;
    }
    let range = |word: u32| {
        let (least, most) = (word & 0xfff, word >> 16 & 0xfff);
        (least, (most + 1).saturating_sub(least))
    };
    let rectangles = words.into_iter().filter_map(|[horizontal, vertical]| Some((horizontal?, vertical?))).map(
        |(horizontal, vertical)| {
            let ((x, width), (y, height)) = (range(horizontal), range(vertical));
            Rectangle { x, y, width, height }
        },
    );
    let mut rectangles: Vec<Rectangle> = rectangles.collect();
    rectangles.dedup();
    let everything = Rectangle { x: 0, y: 0, width: 4096, height: 4096 };
    (!rectangles.is_empty() && (exclusive || !rectangles.contains(&everything)))
        .then_some(WindowClip { rectangles, exclusive })
}

fn operations(view: &mut View<'_>, draw: &mut Draw) {
    if view.enabled(class::SET_ALPHA_TEST_ENABLE) {
        let function = compare(view, class::SET_ALPHA_FUNC);
        draw.alpha_test = Some(AlphaTest { function, reference: view.get(class::SET_ALPHA_REF) as u8 });
    }
    if view.enabled(class::SET_BLEND_ENABLE) {
        let factors = with_values(BlendFactor::ALL, raster::blend_factor);
        let source = choose(view, class::SET_BLEND_FUNC_SFACTOR, &factors);
        let destination = choose(view, class::SET_BLEND_FUNC_DFACTOR, &factors);
        let equation =
            choose(view, class::SET_BLEND_EQUATION, &with_values(BlendEquation::ALL, raster::blend_equation));
        draw.blend = Some(Blend { equation, source, destination });
        let constant = |factor| {
            use BlendFactor::{ConstantAlpha, ConstantColor, OneMinusConstantAlpha, OneMinusConstantColor};
            matches!(factor, ConstantAlpha | ConstantColor | OneMinusConstantAlpha | OneMinusConstantColor)
        };
        if constant(source) || constant(destination) {
            draw.blend_constant = color_of(view.get(class::SET_BLEND_COLOR));
        }
    }
    let mask = view.get(class::SET_COLOR_MASK);
    draw.color_mask = raster::COLOR_MASK.map(|field| field.is_set(mask));
    if view.get_or(class::SET_LOGIC_OP_ENABLE, 0) != 0 {
        view.note(Gap::NotModelled("logic operations".into()));
    }
    if view.get_or(class::SET_DITHER_ENABLE, 0) != 0 {
        view.note(Gap::NotModelled("dithering".into()));
    }
}

fn tests(view: &mut View<'_>, depth: DepthFormat, control: u32, draw: &mut Draw) {
    if view.enabled(class::SET_DEPTH_TEST_ENABLE) {
        let function = compare(view, class::SET_DEPTH_FUNC);
        let write = view.enabled(class::SET_DEPTH_MASK);
        draw.depth_test = Some(DepthTest {
            vertex_depths: VertexDepths::Steps,
            range: depth_range(view, depth),
            offset: polygon_offset(view),
            w_buffer: W_BUFFER.is_set(control),
            ..DepthTest::new(function, write)
        });
    }
    if view.enabled(class::SET_STENCIL_TEST_ENABLE) && depth.has_stencil() {
        let function = compare(view, class::SET_STENCIL_FUNC);
        let operations = with_values(StencilOperation::ALL, |operation| STENCIL_OPERATIONS[operation as usize]);
        let mut operation = |method| choose(view, method, &operations);
        let fail = operation(class::SET_STENCIL_OP_FAIL);
        let depth_fail = operation(class::SET_STENCIL_OP_ZFAIL);
        let pass = operation(class::SET_STENCIL_OP_ZPASS);
        let mut byte = |method| view.get(method) as u8;
        let (reference, mask) = (byte(class::SET_STENCIL_FUNC_REF), byte(class::SET_STENCIL_FUNC_MASK));
        let write_mask = if STENCIL_WRITE.is_set(control) { byte(class::SET_STENCIL_MASK) } else { 0 };
        draw.stencil_test = Some(StencilTest { function, reference, mask, write_mask, fail, depth_fail, pass });
    }
}

fn depth_range(view: &mut View<'_>, depth: DepthFormat) -> Option<DepthRange> {
    let (lowest, highest) = (view.word(class::SET_CLIP_MIN)?, view.word(class::SET_CLIP_MAX)?);
    let (lowest, highest) = (f32::from_bits(lowest), f32::from_bits(highest));
    let control = view.get_or(class::SET_ZMIN_MAX_CONTROL, 1);
    let most = if depth.is_float() { f64::from(f32::MAX) } else { f64::from(depth.largest()) };
    let whole = lowest <= 0.0 && f64::from(highest) >= most;
    let (clamps, drops_triangles) = (CLAMPS_DEPTH.is_set(control), control & 1 != 0);
    if !(lowest.is_finite() && highest.is_finite() && lowest <= highest) {
        view.bad(class::SET_CLIP_MAX);
        return None;
    }
    // Depths beyond the buffer's own are limited by it in any case.
    (!(whole && clamps && !drops_triangles)).then_some(DepthRange { lowest, highest, clamps, drops_triangles })
}

fn polygon_offset(view: &mut View<'_>) -> PolygonOffset {
    if !view.enabled(class::SET_POLY_OFFSET_FILL_ENABLE) {
        return PolygonOffset::default();
    }
    let factor = view.float(class::SET_POLYGON_OFFSET_SCALE_FACTOR);
    let bias = view.float(class::SET_POLYGON_OFFSET_BIAS);
    if factor.is_finite() && bias.is_finite() {
        PolygonOffset { bias, factor }
    } else {
        view.bad(class::SET_POLYGON_OFFSET_BIAS);
        PolygonOffset::default()
    }
}
