//! Extreme random scenes. The numbers of a wider or broad random scene are replaced by those of the lattice, and copied from field to field, so
//! that they meet at limits and where roundings tie.

use super::super::Choices;
use super::broad::{BROAD, broadened};
use super::{FIRST, Tape, WIDER, attempt, legal, widened};
use crate::lattice::{self, any, beside, pick, within};
use ninebit::raster::binary::Binary;
use ninebit::raster::depth::word;
use ninebit::state::*;
use ninebit::vertex::fog::passed;
use proptest::prelude::*;

/// Numbers of tape words for a change of a draw, and for all changes.
const CHANGE: usize = 96;
const EXTREME: usize = 64 + 4 * CHANGES.len() * CHANGE;

/// Returns valid scenes of numbers at limits.
pub fn scene() -> BoxedStrategy<Scene> {
    Tape(FIRST + WIDER + BROAD + EXTREME).prop_map(|tape| extreme(&tape)).prop_filter("RAS-0", legal).boxed()
}

/// Builds the scene of a tape.
fn extreme(tape: &[u32]) -> Scene {
    let (first, rest) = tape.split_at((FIRST + WIDER + BROAD).min(tape.len()));
    let mut tape = Choices { tape: rest };
    let mut c = tape.part(64);
    let mut scene = if c.once_in(8) { broadened(first) } else { widened(&first[..FIRST + WIDER]) };
    for target in &mut scene.targets {
        let next = &mut || c.word();
        if next() % 2 == 1 {
            target.clear_color = bytes(next);
        }
    }
    for index in 0..scene.draws.len().min(4) {
        for change in CHANGES {
            let mut c = tape.part(CHANGE);
            if c.once_in(3) {
                attempt(&mut scene, |scene| change(&mut c, scene, index));
            }
        }
    }
    scene
}

type Change = fn(&mut Choices<'_>, &mut Scene, usize);

/// The changes to a draw, in order.
const CHANGES: [Change; 11] = [places, depths, ranges, ws, coordinates, fog, colors, tests, units, stages, copies];

fn bytes(next: &mut impl FnMut() -> u32) -> [u8; 4] {
    std::array::from_fn(|_| lattice::byte(next))
}

/// A few numbers, of which each vertex takes one or its neighbour, so that many are equal or nearly so.
struct Few([f32; 5]);

impl Few {
    fn new<N: FnMut() -> u32>(next: &mut N, of: impl Fn(&mut N) -> f32) -> Few {
        Few(std::array::from_fn(|_| of(next)))
    }

    /// Returns a function that yields the next number of a vertex.
    fn each(self, seed: u32) -> impl FnMut() -> f32 {
        let mut random = ninebit::random::Random::seeded(seed.into());
        move || {
            let next = &mut || random.bits() as u32;
            let number = pick(next, &self.0);
            beside(next, number)
        }
    }
}

/// Moves vertices to corners and centres of pixels, to ties of 1/16 pixel, or beside these; or clip positions to the planes of the volume.
fn places(c: &mut Choices<'_>, scene: &mut Scene, index: usize) {
    let target = &scene.targets[scene.draws[index].target];
    let sides = [target.width, target.height];
    let draw = &mut scene.draws[index];
    let next = &mut || c.word();
    if matches!(draw.positions, Positions::Window) {
        for (axis, side) in sides.into_iter().enumerate() {
            let mut number = Few::new(next, |next| {
                let steps = lattice::whole(next, (-64, 32 * i64::from(side) + 64));
                steps as f32 / pick(next, &[16.0, 32.0, 2.0, 1.0])
            })
            .each(next());
            let one_of = 1 + next() as usize % 3;
            draw.vertices.update(|n, vertex| {
                if n % one_of == 0 {
                    vertex.position[axis] = number().clamp(-1024.0, 1024.0);
                }
            });
        }
        return;
    }
    let mut factor = Few::new(next, |next| pick(next, &[1.0, -1.0, 0.0, 0.5, 1.5])).each(next());
    let (axis, one_of) = (next() as usize % 3, 1 + next() as usize % 3);
    draw.vertices.update(|n, vertex| {
        if n % one_of == 0 {
            vertex.position[axis] = vertex.position[3] * factor();
        }
    });
    if let Positions::Clip(port) = &mut draw.positions {
        (port.near, port.far) = (pick(next, &[0.0, 1.0, 0.5]), pick(next, &[1.0, 0.0, 0.5]));
        (port.near, port.far) = (beside(next, port.near), beside(next, port.far));
    }
}

/// Gives vertices depths of any magnitude, or beside steps of the buffer.
fn depths(c: &mut Choices<'_>, scene: &mut Scene, index: usize) {
    let Scene { targets, draws, .. } = scene;
    let draw = &mut draws[index];
    let (Some(test), Some(buffer)) = (&mut draw.depth_test, targets[draw.target].depth) else { return };
    if !matches!(draw.positions, Positions::Window) {
        return;
    }
    let next = &mut || c.word();
    test.vertex_depths = pick(next, VertexDepths::ALL);
    let full = buffer.format.largest();
    let counts = test.vertex_depths == VertexDepths::Steps || buffer.format.is_float();
    let style = next() % 4;
    let mut number = Few::new(next, |next| {
        let step = lattice::whole(next, (0, full.into())) as f32;
        match style {
            0 | 1 if counts => step,
            2 if counts => any(next),
            0 | 1 => step / full as f32,
            _ => within(next, (-30, 24)),
        }
    })
    .each(next());
    draw.vertices.map_positions(|[x, y, _, w]| [x, y, number(), w]);
}

/// Returns the numbers of a draw: of its vertices, its depth test, its fog.
fn numbers(draw: &Draw) -> Vec<f32> {
    let mut all = vec![1.0, 0.0];
    for vertex in draw.vertices.iter().take(4) {
        all.extend(vertex.position);
        all.push(vertex.fog);
        all.extend(vertex.texture_coordinates[0]);
        if let VertexColor::Floats(numbers) = vertex.diffuse {
            all.extend(numbers);
        }
    }
    if let Some(test) = &draw.depth_test {
        all.extend([test.offset.bias, test.offset.factor, draw.vertices.at(0).position[2] + test.offset.bias]);
        all.extend(test.range.iter().flat_map(|range| [range.lowest, range.highest]));
    }
    if let Some(FogFunction { p0, p1, p2, .. }) = draw.fog.function {
        // Where linear fog begins and ends, too.
        all.extend([p0, p1, p2, (1.0 - p0) / p1, (2.0 - p0) / p1, 1.5 - p0]);
    }
    all.retain(|number| number.is_finite());
    all
}

/// Gives a draw an offset and a range of any magnitude. Limits are often depths of vertices, with the offset or without, or what is stored.
fn ranges(c: &mut Choices<'_>, scene: &mut Scene, index: usize) {
    let Scene { targets, draws, .. } = scene;
    let draw = &mut draws[index];
    if draw.vertices.is_empty() {
        return;
    }
    let vertex = draw.vertices.at(0).position;
    let (Some(test), Some(buffer)) = (&mut draw.depth_test, &mut targets[draw.target].depth) else { return };
    let next = &mut || c.word();
    let format = buffer.format;
    test.w_buffer = next() % 5 == 4;
    let z = if test.w_buffer { vertex[3] } else { vertex[2] };
    test.offset.bias = match next() % 5 {
        0 => 0.0,
        1 => lattice::whole(next, (-(1 << 24), 1 << 24)) as f32,
        2 => beside(next, -z),
        _ => any(next),
    };
    test.offset.factor = if test.w_buffer || next().is_multiple_of(2) { 0.0 } else { any(next) };
    let sum = z + test.offset.bias;
    let mut limit = || {
        let of = [sum, z, test.offset.bias, format.largest() as f32, 0.0, any(next)];
        let limit = pick(next, &of);
        beside(next, if limit.is_finite() { limit } else { f32::MAX })
    };
    let (a, b) = (limit(), limit());
    let [clamps, drops_triangles] = [next().is_multiple_of(2), next().is_multiple_of(4)];
    test.range =
        (next() % 4 > 0).then_some(DepthRange { lowest: a.min(b), highest: a.max(b), clamps, drops_triangles });
    if next().is_multiple_of(3) && sum.is_finite() {
        buffer.clear = word(format, Binary::new(sum));
    }
    test.function = pick(next, CompareFunction::ALL);
}

/// Gives vertices w at the ends of the domain, equal ones, or neighbours.
fn ws(c: &mut Choices<'_>, scene: &mut Scene, index: usize) {
    let draw = &mut scene.draws[index];
    let next = &mut || c.word();
    let range = pick(next, &[(-20, 20), (-2, 2), (-20, -18), (18, 20), (0, 0)]);
    let few = Few::new(next, |next| within(next, range).abs());
    let mut number = few.each(next());
    let mut bounded = move || number().clamp(1.0 / 1_048_576.0, 1_048_576.0);
    if matches!(draw.positions, Positions::Window) {
        draw.vertices.map_positions(|[x, y, z, _]| [x, y, z, bounded()]);
    } else {
        // The vertex stays in its direction.
        draw.vertices.map_positions(|[x, y, z, w]| {
            let to = bounded();
            [x / w * to, y / w * to, z / w * to, to].map(|n| if n.is_finite() { n } else { to })
        });
    }
}

/// Gives a set of coordinates numbers of any magnitude, some components equal to others or to their negatives.
fn coordinates(c: &mut Choices<'_>, scene: &mut Scene, index: usize) {
    let draw = &mut scene.draws[index];
    let next = &mut || c.word();
    let set = next() as usize % 4;
    let range = pick(next, &[(-3, 3), (-20, 20), (-60, 60), (-126, 126), (-149, -100), (100, 127)]);
    let mut numbers = [0; 4].map(|_| Few::new(next, |next| within(next, range)).each(next()));
    let (style, from, to) = (next() % 6, next() as usize % 4, next() as usize % 4);
    let limit = pick(next, &[16.0, 512.0, 1024.0]);
    draw.vertices.update(|_, vertex| {
        let of = &mut vertex.texture_coordinates[set];
        match style {
            0 => of[to] = numbers[to](),
            1 => of[to] = of[from],
            2 => of[to] = -of[from],
            3 => *of = [0, 1, 2, 3].map(|n| numbers[n]()),
            // Whole texels of most sizes, and their neighbours.
            4 => {
                *of = [
                    (numbers[0]().to_bits() % 4096) as f32 / 64.0,
                    (numbers[1]().to_bits() % 4096) as f32 / 64.0,
                    of[2],
                    of[3],
                ]
            }
            _ => {
                let q = numbers[3]();
                *of = [of[0] * q, of[1] * q, of[2] * q, q];
            }
        }
        if of[3] == 1.0 {
            of[..3].iter_mut().for_each(|n| *n = n.clamp(-limit, limit));
        }
    });
}

/// Gives fog parameters and coordinates of any magnitude, many of them where the factor reaches 0 or 1.
fn fog(c: &mut Choices<'_>, scene: &mut Scene, index: usize) {
    let profile = scene.profile;
    let draw = &mut scene.draws[index];
    draw.fog.enabled = true;
    let next = &mut || c.word();
    draw.fog.color = bytes(next)[..3].try_into().unwrap();
    let Some(function) = &mut draw.fog.function else {
        let mut number = Few::new(next, |next| pick(next, &[1.0, 0.0, 0.5, 0.25, 1.5, -0.5])).each(next());
        draw.vertices.update(|_, vertex| vertex.fog = number());
        return;
    };
    let any_of = |next: &mut dyn FnMut() -> u32| {
        let next = &mut || next();
        if next().is_multiple_of(3) { any(next) } else { within(next, (-12, 3)) }
    };
    function.mode = pick(next, FogMode::ALL);
    (function.p0, function.p1) = (any_of(next), any_of(next));
    function.p2 = if next().is_multiple_of(3) { any_of(next) } else { 0.0 };
    let function = *function;
    let ends = [(1.0 - function.p0) / function.p1, (2.0 - function.p0) / function.p1, 0.0];
    let mut number =
        Few::new(next, |next| if next().is_multiple_of(2) { pick(next, &ends) } else { any_of(next) }).each(next());
    draw.vertices.update(|_, vertex| {
        vertex.fog = number();
        if vertex.fog_coordinate.is_some() {
            vertex.fog_coordinate = Some(vertex.fog);
            vertex.fog = passed(&function, profile, vertex.fog);
        }
    });
}

/// Gives vertices colours at the ends of the bytes, between two of them, and beside.
fn colors(c: &mut Choices<'_>, scene: &mut Scene, index: usize) {
    let draw = &mut scene.draws[index];
    let next = &mut || c.word();
    let floats: [VertexColor; 4] = std::array::from_fn(|_| VertexColor::Floats([0; 4].map(|_| lattice::colour(next))));
    let whole: [VertexColor; 4] = std::array::from_fn(|_| VertexColor::Bytes(bytes(next)));
    let colors = if next().is_multiple_of(2) { floats } else { whole };
    let (style, second) = (next() % 3, 1 + next() as usize % 3);
    draw.vertices.update(|n, vertex| match style {
        0 => vertex.diffuse = colors[n % 4],
        1 => vertex.specular = colors[n % 4],
        _ => (vertex.diffuse, vertex.specular) = (colors[n % 4], colors[(n + second) % 4]),
    });
}

/// Gives tests, blending and constants bytes at the ends and in the middle, or those of vertices.
fn tests(c: &mut Choices<'_>, scene: &mut Scene, index: usize) {
    let Scene { targets, draws, .. } = scene;
    let draw = &mut draws[index];
    let next = &mut || c.word();
    let of_vertex = (!draw.vertices.is_empty()).then(|| draw.vertices.at(0).diffuse);
    let alpha = match of_vertex {
        Some(VertexColor::Bytes([.., alpha])) if next().is_multiple_of(2) => alpha,
        _ => lattice::byte(next),
    };
    if next().is_multiple_of(2) {
        draw.alpha_test = Some(AlphaTest { function: pick(next, CompareFunction::ALL), reference: alpha });
    }
    draw.blend_constant = if next().is_multiple_of(2) { bytes(next) } else { targets[draw.target].clear_color };
    if let Some(blend) = &mut draw.blend {
        (blend.source, blend.destination) = (pick(next, BlendFactor::ALL), pick(next, BlendFactor::ALL));
    }
    if let Some(stencil) = &mut draw.stencil_test {
        (stencil.reference, stencil.mask, stencil.write_mask) =
            (lattice::byte(next), lattice::byte(next), lattice::byte(next));
        if let Some(depth) = &mut targets[draw.target].depth {
            depth.clear_stencil = if next().is_multiple_of(2) { stencil.reference } else { lattice::byte(next) };
        }
    }
    let constants = [bytes(next), bytes(next)];
    for stage in &mut draw.combiners.stages {
        stage.constants = constants;
    }
    if next().is_multiple_of(2) {
        draw.combiners.final_combiner.constants = constants;
    }
}

/// Gives units lods at the ends of their ranges and beside whole levels, and borders of bytes at the ends.
fn units(c: &mut Choices<'_>, scene: &mut Scene, index: usize) {
    for unit in scene.draws[index].textures.iter_mut().flatten() {
        let mut c = c.part(24);
        let next = &mut || c.word();
        unit.border_color = bytes(next);
        if next().is_multiple_of(2) {
            unit.lod_bias = lattice::whole(next, (-4096, 4095)) as i32;
            unit.max_lod = lattice::whole(next, (0, 4095)) as i32;
            unit.min_lod = if next().is_multiple_of(2) {
                unit.max_lod
            } else {
                lattice::whole(next, (0, unit.max_lod.into())) as i32
            };
        }
    }
}

/// Gives stages of the texture shader matrices, luminances and eyes of any magnitude.
fn stages(c: &mut Choices<'_>, scene: &mut Scene, index: usize) {
    let next = &mut || c.word();
    let mut number = || if next().is_multiple_of(3) { any(next) } else { within(next, (-10, 10)) };
    for stage in &mut scene.draws[index].texture_shader {
        match &mut stage.operation {
            ShaderOperation::BumpEnvironment { matrix, luminance } => {
                let few = [0; 3].map(|_| number());
                *matrix = [few[0], few[1], few[2], -few[0]];
                if let Some(luminance) = luminance {
                    *luminance = [few[1], few[2]];
                }
            }
            ShaderOperation::DotReflectConstantEye { eye } => *eye = [0; 3].map(|_| number()),
            _ => {}
        }
    }
}

/// Copies numbers of a draw, or their neighbours, to other fields of it.
fn copies(c: &mut Choices<'_>, scene: &mut Scene, index: usize) {
    for _ in 0..c.size(1, 4) {
        let mut c = c.part(20);
        let next = &mut || c.word();
        let draw = &mut scene.draws[index];
        let number = pick(next, &numbers(draw));
        let number = beside(next, number) * pick(next, &[1.0, 1.0, 1.0, -1.0]);
        let (vertex, axis) = (next() as usize % 4, next() as usize % 4);
        let to = next() % 9;
        match (to, &mut draw.depth_test, &mut draw.fog.function) {
            (0, Some(test), _) => test.offset.bias = number,
            (1, Some(test), _) if !test.w_buffer => test.offset.factor = number,
            (2, Some(DepthTest { range: Some(range), .. }), _) => {
                range.lowest = number;
                range.highest = range.highest.max(number);
            }
            (3, Some(DepthTest { range: Some(range), .. }), _) => {
                range.highest = number;
                range.lowest = range.lowest.min(number);
            }
            (4, _, Some(function)) => function.p0 = number,
            (5, _, Some(function)) => function.p1 = number,
            (6, ..) => draw.vertices.update(|n, of| {
                if n % 4 == vertex {
                    of.fog = number;
                }
            }),
            (7, ..) => draw.vertices.update(|n, of| {
                if n % 4 == vertex {
                    of.position[axis] = number.clamp(-1024.0, 1024.0);
                    of.position[3] = of.position[3].clamp(1.0 / 1_048_576.0, 1_048_576.0);
                }
            }),
            _ => draw.vertices.update(|n, of| {
                if n % 4 == vertex {
                    of.texture_coordinates[vertex % 4][axis] = number;
                }
            }),
        }
        legalise_coordinates(draw);
    }
}

/// Brings coordinates on a plane back into the domain of RAS-0.
fn legalise_coordinates(draw: &mut Draw) {
    draw.vertices.update(|_, vertex| {
        for set in &mut vertex.texture_coordinates {
            if set[3] == 1.0 {
                set[..3].iter_mut().for_each(|n| *n = n.clamp(-512.0, 512.0));
            }
        }
    });
}
