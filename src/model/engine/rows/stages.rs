//! Runs the stages of a texture shader, one after the other, each for a whole block.
//!
//! The inputs of a stage are interpolated batch by batch: numbers, which are rounded to single precision, and coordinates that a bump stage moves, which
//! keep their fraction. Lanes that are not proved are left open, and the definition runs their stages in the end.
#![allow(clippy::float_arithmetic, reason = "estimates: no result depends on how they are rounded")]

use super::depth::floor;
use super::dot::{self, Floats};
use super::fetch::{self, Workspace};
use super::kernels::{LANES, Lanes256, PerLane, STEP};
use super::planes::{RealPlane, inverse};
use super::quotient::{Line, Reciprocals, floor_of_factor, multiply_add, nearest, whole};
use super::setup::{BatchSetup, PixelBatch, Run};
use super::shader::{Bump, Number, Purpose, Shader, byte_of};
use super::short::{Dominance, Losses, losses};
use super::triangle::Varying;
use super::{BLOCK, CompiledDraw, Job, Sampler};
use crate::combiner::registers::Registers;
use crate::engine::pixel::TriangleContext;
use crate::engine::walk::Band;
use crate::number::convert::factor;
use crate::raster::interpolate::{COORDINATE_LIMIT, Sample};
use crate::state::{MipFilter, ShaderOperation, TEXTURE_UNITS};
use crate::trace::Silent;

/// A number across a triangle.
#[derive(Clone, Copy, Debug)]
enum Function {
    /// It is the same at the three vertices.
    Same(f32),
    /// A quotient by D, and an upper bound of its change where the definition [floors](crate::raster::attribute) small numbers. There is no
    /// bound if doubles hold the quotients exactly.
    Plane(RealPlane, Option<f64>),
}

/// The coordinates of a stage that moves them.
#[derive(Clone, Copy, Debug)]
struct MovedPlanes {
    /// u and v, 1/256 texel.
    planes: [RealPlane; 2],
    /// Their losses where weights fall short.
    losses: [Losses; 2],
    /// Whether they stay within their limits, however the stage moves them.
    within_limits: bool,
    /// Whether doubles hold all of them exactly, with at most [`EXACT_BITS`] bits of a fraction.
    exact: bool,
}

/// Largest number of fraction bits of coordinates that are moved without an error.
const EXACT_BITS: i32 = 26;

/// The set-up of a triangle for a texture shader.
#[derive(Clone, Debug, Default)]
struct Attributes {
    /// Number of the triangle in the draw.
    triangle: Option<usize>,
    denominator: RealPlane,
    /// Reciprocal of a lower bound of D.
    widest: f64,
    numbers: Vec<Function>,
    moved: Vec<MovedPlanes>,
    /// Upper bound of the change of u and v where the definition floors the numerators of the vertices.
    floors: f64,
}

impl Attributes {
    /// Sets up a triangle.
    fn set(&mut self, context: &TriangleContext<'_>, shader: &Shader) {
        let triangle = &context.triangle;
        let inverse = inverse(triangle);
        let p = [triangle.p[0] as f64, triangle.p[1] as f64, triangle.p[2] as f64];
        let least = triangle.p[0].min(triangle.p[1]).min(triangle.p[2]) as f64;
        // Exact, because 28 bits are multiplied by 24.
        let times_p = |values: [f64; 3]| [values[0] * p[0], values[1] * p[1], values[2] * p[2]];
        self.triangle = Some(context.number);
        self.denominator = RealPlane::new(triangle, &inverse, p, 0.0);
        self.widest = 1.0 / (least * triangle.doubled_area as f64);
        self.floors = 1.25 / least;
        self.numbers.clear();
        for (stage, component, purpose) in &shader.varying {
            let set = context.coordinate_set(shader.stages[*stage].state.coordinate_set);
            let [a, b, c] = [set[0][*component], set[1][*component], set[2][*component]];
            self.numbers.push(if a == b && b == c {
                Function::Same(if *purpose == Purpose::Byte { byte_of(f64::from(a)) } else { a + 0.0 })
            } else {
                let g = times_p([f64::from(a), f64::from(b), f64::from(c)]);
                let largest = g[0].abs().max(g[1].abs()).max(g[2].abs());
                let plane = RealPlane::new(triangle, &inverse, g, 0.0);
                Function::Plane(plane, plane.fraction_bits(triangle).is_none().then_some(largest * KEPT / least))
            });
        }
        self.moved.clear();
        for Bump { stage, sides, most } in &shader.moved {
            let set = context.coordinate_set(shader.stages[*stage].state.coordinate_set);
            let plane = |axis: usize| {
                let side = f64::from(256 * sides[axis]);
                let of = |k: usize| f64::from(set[k][axis]) * side;
                RealPlane::new(triangle, &inverse, times_p([of(0), of(1), of(2)]), 1.0)
            };
            let planes = [plane(0), plane(1)];
            let losses = |plane: &RealPlane| losses(triangle, &inverse, plane.g());
            let few = |plane: &RealPlane| plane.fraction_bits(triangle).is_some_and(|bits| bits <= EXACT_BITS);
            self.moved.push(MovedPlanes {
                planes,
                losses: [losses(&planes[0]), losses(&planes[1])],
                within_limits: (0..2).all(|axis| planes[axis].reach + most[axis] < FARTHEST),
                exact: few(&planes[0]) && few(&planes[1]),
            });
        }
    }
}

/// Coordinates that a stage moves. Aligned, because vectors are stored and soon loaded again.
#[derive(Clone, Debug)]
#[repr(C, align(64))]
struct Moved {
    /// Estimates less a half, 1/256 texel.
    u: [f64; LANES],
    v: [f64; LANES],
    /// Half a step less the largest error in each step of lanes. A moved coordinate that is no further from the middle of a step has a proved
    /// floor.
    room: [f64; LANES / STEP],
}

impl Default for Moved {
    fn default() -> Self {
        Moved { u: [0.0; LANES], v: [0.0; LANES], room: [0.0; LANES / STEP] }
    }
}

/// Registers of the dot unit.
#[derive(Clone, Debug)]
#[repr(C, align(64))]
struct DotUnit {
    /// Dot product of each stage.
    dots: [Floats; TEXTURE_UNITS],
    reflected: [Floats; 3],
    /// The eye vector, if it is constant.
    eye: [Floats; 3],
    /// Scratch space of a stage.
    scratch: [Floats; 3],
}

impl Default for DotUnit {
    fn default() -> Self {
        let zeros = [[0.0; BLOCK]; 3];
        DotUnit { dots: [[0.0; BLOCK]; TEXTURE_UNITS], reflected: zeros, eye: zeros, scratch: zeros }
    }
}

/// Buffers of a texture shader.
#[derive(Clone, Debug, Default)]
pub(super) struct Workshop {
    /// Numbers that vary.
    numbers: Vec<[f32; LANES]>,
    /// Numbers that are the same everywhere.
    same: Vec<Floats>,
    moved: Vec<Moved>,
    attributes: Attributes,
    reciprocals: Box<Reciprocals>,
    dominance: Box<Dominance>,
    /// Not 0 for lanes that are left open: the definition computes them.
    open: Vec<i32>,
    /// First lane and number of each triangle of the block.
    triangles: Vec<(usize, usize)>,
    vectors: Vec<[Floats; 3]>,
    is_remapped: Vec<bool>,
    dot: Box<DotUnit>,
}

impl Workshop {
    /// Makes room for the shader of a draw.
    pub(super) fn begin(&mut self, shader: &Shader) {
        self.numbers.resize(shader.varying.len(), [0.0; LANES]);
        self.same.clear();
        self.same.extend(shader.same.iter().map(|value| [*value; BLOCK]));
        self.moved.resize(shader.moved.len(), Moved::default());
        self.attributes.triangle = None;
        self.open.clear();
        self.open.resize(LANES, 0);
        self.triangles.clear();
        self.vectors.resize(shader.vectors.len(), [[0.0; BLOCK]; 3]);
        self.is_remapped.resize(shader.vectors.len(), false);
        for stage in &shader.stages {
            if let ShaderOperation::DotReflectConstantEye { eye } = stage.state.operation {
                self.dot.eye = eye.map(|component| [component; BLOCK]);
            }
        }
    }
}

/// Largest error of an estimated coordinate that is accepted.
const COARSEST: f64 = 0.125;

/// An upper bound of the last bit that the definition keeps, relative to the largest of a triangle's three numbers.
const KEPT: f64 = 1.0 / (1_u64 << 60) as f64;

/// Bound of the rounding error of a coordinate within its limits, when it is moved.
const SUM: f64 = 1.0 / (1 << 28) as f64;

/// Half the last bit of an exact coordinate. It is added so that no coordinate that is whole lies on the border of two floors.
const HALF_BIT: f64 = 1.0 / (1_u64 << (EXACT_BITS + 1)) as f64;

/// Coordinates below this have no limit, 1/256 texel.
const FARTHEST: f64 = (COORDINATE_LIMIT - 16) as f64;

impl Workshop {
    /// Interpolates the inputs of a texture shader for a batch.
    #[inline(always)]
    pub(super) fn attributes<const FMA: bool, const ROW: bool>(
        &mut self,
        context: &TriangleContext<'_>,
        batch: PixelBatch<'_>,
        shader: &Shader,
    ) {
        let Workshop { numbers, moved, attributes, reciprocals, dominance, open, triangles, .. } = self;
        let triangle = &context.triangle;
        if attributes.triangle != Some(context.number) {
            attributes.set(context, shader);
        }
        triangles.push((batch.lane, context.number));
        let open = &mut open[batch.lanes()];
        open.fill(0);
        let e = triangle.edges(batch.first.0, batch.first.1);
        let real = [e[0] as f64, e[1] as f64, e[2] as f64];
        let denominator = attributes.denominator.line(&real);
        let terms = |columns, rows| attributes.denominator.terms(&real, columns, rows);
        let local = BatchSetup::new::<FMA, ROW>(batch, (e, real, denominator), attributes.widest, terms);
        let margin =
            |plane: &RealPlane| local.margin::<ROW>(plane.reach, |columns, rows| plane.terms(&real, columns, rows));
        if !attributes.numbers.is_empty() {
            reciprocals.set::<FMA, ROW>(batch.at, denominator);
        }
        for ((number, out), (_, _, purpose)) in attributes.numbers.iter().zip(numbers).zip(&shader.varying) {
            let out = &mut out[batch.lanes()];
            match number {
                Function::Same(value) => out.fill(*value),
                Function::Plane(plane, floors) => {
                    let (line, off) = (plane.line(&real), floors.map_or(0.0, |floors| margin(plane) + floors));
                    match purpose {
                        Purpose::Float | Purpose::Sign => {
                            rounded::<FMA, ROW, false>(reciprocals, line, off, out, open);
                        }
                        Purpose::Byte => rounded::<FMA, ROW, true>(reciprocals, line, off, out, open),
                    }
                }
            }
        }
        if !attributes.moved.is_empty() {
            dominance.set::<FMA, ROW>(triangle, batch, &local);
        }
        for (of, moved) in attributes.moved.iter().zip(moved) {
            let MovedPlanes { planes, losses, within_limits, exact } = of;
            let lines = [planes[0].line(&real), planes[1].line(&real), denominator];
            let offs = [margin(&planes[0]), margin(&planes[1])];
            let off = if offs[0] > offs[1] { offs[0] } else { offs[1] } + attributes.floors + SUM;
            // NaN proves nothing either.
            let proves = *exact | (off < COARSEST) & (offs[0] < COARSEST) & (offs[1] < COARSEST);
            if !(proves & *within_limits) {
                open.fill(1);
            }
            if batch.lane == 0 {
                moved.room.fill(0.5);
            }
            let (off, plus) = if *exact { (HALF_BIT / 2.0, HALF_BIT - 0.5) } else { (off, -0.5) };
            let room = 0.5 - if proves { off } else { 0.0 };
            for least in &mut moved.room[batch.lane / STEP..batch.lanes().end.div_ceil(STEP)] {
                *least = if room < *least { room } else { *least };
            }
            let at = [&mut moved.u[batch.lane..], &mut moved.v[batch.lane..]];
            dominance.divide::<FMA, ROW>(batch.at, lines, [losses[0], losses[1], [0.0; 2]], plus, at);
        }
    }
}

/// Computes quotients, rounded to single precision, or as `BYTE`s (TSH-9). Lanes that are not proved are left open, and so are zeros in
/// single precision.
#[inline(always)]
fn rounded<const FMA: bool, const ROW: bool, const BYTE: bool>(
    reciprocals: &Reciprocals,
    line: Line,
    off: f64,
    out: &mut [f32],
    open: &mut [i32],
) {
    let lanes = out.len();
    let ([xs, ys, rs], open) = (reciprocals.lanes(lanes), &mut open[..lanes]);
    for n in 0..lanes {
        let value = line.at::<FMA, ROW>(xs[n], ys[n]) * rs[n];
        if BYTE {
            let (low, high) = ((value - off) * 4096.0, (value + off) * 4096.0);
            let (low, high) = (factor(floor_of_factor(low)), factor(floor_of_factor(high)));
            out[n] = low as f32;
            // NaN is left open too.
            open[n] |= i32::from((low != high) | value.is_nan() | off.is_nan());
        } else {
            let (low, high) = ((value - off) as f32, (value + off) as f32);
            out[n] = low;
            open[n] |= i32::from((low != high) | (low == 0.0));
        }
    }
}

/// Runs the stages of a block's pixels, which write their registers to rows. Returns the number of pixels that the definition computed.
#[inline(always)]
pub(super) fn run<const FMA: bool>(
    job: Job<'_>,
    runs: &[Run],
    varying: &mut Varying,
    workshop: &mut Workshop,
    (work, rows): (&mut Workspace, &mut [Lanes256]),
    band: &Band<'_>,
) -> u64 {
    let Some(shader) = &job.compiled.shader else { return 0 };
    workshop.is_remapped.fill(false);
    let mut dotted = [false; TEXTURE_UNITS];
    let alive = &mut varying.alive;
    if shader.kills {
        alive.fill(true);
    }
    for (index, stage) in shader.stages.iter().enumerate().filter(|(_, stage)| stage.runs) {
        if stage.dots {
            dot_product::<FMA>(job.compiled, shader, index, &mut dotted, workshop, rows);
        }
        let wanted = job.compiled.textures[index];
        match stage.state.operation {
            ShaderOperation::None | ShaderOperation::DotProduct => {}
            ShaderOperation::PassThrough => {
                for n in 0..4 {
                    if let Some(slot) = wanted[n]
                        && let Some(number) = number(&workshop.numbers, &workshop.same, stage.numbers[n])
                    {
                        let out = rows[usize::from(slot)].block_mut();
                        for k in 0..BLOCK {
                            out[k] = number[k] as i16;
                        }
                    }
                }
            }
            ShaderOperation::CullFragment { drops_not_negative } => {
                for n in 0..4 {
                    let Some(number) = number(&workshop.numbers, &workshop.same, stage.numbers[n]) else { continue };
                    for (alive, number) in alive.iter_mut().zip(number) {
                        *alive &= (*number < 0.0) == drops_not_negative[n];
                    }
                }
            }
            ShaderOperation::Sample => {
                let Some(at) = stage.sampler else { continue };
                let sampler = &job.compiled.samplers[at];
                let Some(table) = &sampler.table else { continue };
                if let (true, Some(reads)) = (sampler.mixes, varying.reads.get(at)) {
                    let both = job.draw.units[sampler.index].state.mip_filter == MipFilter::Linear;
                    fetch::sample_levels(job.vectors, table, reads, both, sampler.signed, wanted, work, rows);
                } else {
                    let faces = sampler.has_images().then_some(&varying.faces[at]);
                    fetch::locate(table, &mut varying.coordinates[at], faces, work);
                    let (at, references) = (&varying.coordinates[at], &varying.references[at]);
                    fetch::sample(job.vectors, table, at, references, sampler.signed, wanted, work, rows);
                }
            }
            operation => {
                let Some(at) = stage.sampler else { continue };
                let sampler = &job.compiled.samplers[at];
                let Some(table) = &sampler.table else { continue };
                let (numbers, faces) = (&mut varying.coordinates[at], &mut varying.faces[at]);
                let earlier = job.compiled.textures[stage.state.previous];
                match operation {
                    ShaderOperation::BumpEnvironment { matrix, .. } => {
                        let doubled = shader.stages[stage.state.previous].doubled;
                        let moved = &workshop.moved[stage.moved];
                        let [_, green, blue, _] = earlier.map(|slot| slot.map(|slot| rows[usize::from(slot)].block()));
                        if let (Some(blue), Some(green)) = (blue, green) {
                            let (blue, green) = ((blue, doubled[2]), (green, doubled[1]));
                            let [along, down, _] = &mut workshop.dot.scratch;
                            dot::moved(matrix, blue, green, along, down);
                            place::<FMA>(sampler, moved, [along, down], numbers, &mut workshop.open);
                        }
                    }
                    ShaderOperation::DependentAlphaRed | ShaderOperation::DependentGreenBlue => {
                        let channels = if operation == ShaderOperation::DependentAlphaRed { [3, 0] } else { [1, 2] };
                        let doubled = shader.stages[stage.state.previous].doubled;
                        for n in 0..2 {
                            let Some(slot) = earlier[channels[n]] else { continue };
                            let Some(table) = stage.dependent[n].first_chunk::<256>() else { continue };
                            let (from, down) = (rows[usize::from(slot)].block(), u32::from(doubled[channels[n]]));
                            for (out, from) in numbers[n].iter_mut().zip(from) {
                                *out = table[usize::from((*from >> down) as u8)];
                            }
                        }
                    }
                    ShaderOperation::DotProduct2D => {
                        for n in 0..2 {
                            dot_product::<FMA>(job.compiled, shader, index + n - 1, &mut dotted, workshop, rows);
                            let Some(out) = numbers[n].first_chunk_mut() else { continue };
                            let limit = COORDINATE_LIMIT as i32;
                            dot::coordinate(
                                &workshop.dot.dots[index + n - 1],
                                sampler.sides[n],
                                limit,
                                sampler.bias(),
                                out,
                            );
                        }
                    }
                    _ => {
                        for n in 1..4 {
                            dot_product::<FMA>(job.compiled, shader, n, &mut dotted, workshop, rows);
                        }
                        let Some((vector, scratch)) = workshop.vector(shader, &operation) else { continue };
                        let [u, v] = numbers;
                        if let (Some(u), Some(v), Some(faces)) =
                            (u.first_chunk_mut(), v.first_chunk_mut(), faces.first_chunk_mut())
                        {
                            dot::on_faces::<FMA>(vector, sampler.sides[0], sampler.bias(), scratch, u, v, faces);
                        }
                    }
                }
                let faces = sampler.has_images().then_some(&varying.faces[at]);
                fetch::locate(table, &mut varying.coordinates[at], faces, work);
                let (at, references) = (&varying.coordinates[at], &varying.references[at]);
                fetch::sample(job.vectors, table, at, references, sampler.signed, wanted, work, rows);
                if let (Some(factors), Some(red)) = (stage.luminance.first_chunk::<512>(), earlier[0]) {
                    let [products, ..] = &mut workshop.dot.scratch;
                    for (product, red) in products.iter_mut().zip(rows[usize::from(red)].block()) {
                        *product = factors[usize::from(*red as u16 % 512)];
                    }
                    for slot in wanted[..3].iter().flatten() {
                        dot::luminance::<FMA>(products, rows[usize::from(*slot)].block_mut());
                    }
                }
            }
        }
    }
    define(job, runs, varying.alive.as_mut_slice(), workshop, rows, band)
}

/// Returns a number of the block's pixels.
#[inline(always)]
fn number<'w>(varying: &'w [[f32; LANES]], same: &'w [Floats], number: Number) -> Option<&'w Floats> {
    match number {
        Number::Unread => None,
        Number::Same(n) => Some(&same[n]),
        Number::Varying(n) => varying[n].first_chunk(),
    }
}

impl Workshop {
    /// Returns the vector of a look-up in a cube map, and scratch space.
    #[inline(always)]
    fn vector(&mut self, shader: &Shader, operation: &ShaderOperation) -> Option<([&Floats; 3], &mut [Floats; 3])> {
        let Workshop { numbers, same, dot, .. } = self;
        let DotUnit { dots: [_, first, second, third], reflected, eye, scratch } = &mut **dot;
        let dots = [&*first, &*second, &*third];
        let eye = match operation {
            ShaderOperation::DotReflectSpecular => {
                let component = |n: usize| number(numbers, same, shader.stages[n].numbers[3]);
                [component(1)?, component(2)?, component(3)?]
            }
            ShaderOperation::DotReflectConstantEye { .. } => eye.each_ref(),
            _ => return Some((dots, scratch)),
        };
        dot::reflect(dots, eye, reflected);
        Some((reflected.each_ref(), scratch))
    }
}

/// TSH-4: computes the dot product of a stage, unless it is known already.
#[inline(always)]
fn dot_product<const FMA: bool>(
    compiled: &CompiledDraw,
    shader: &Shader,
    index: usize,
    dotted: &mut [bool; TEXTURE_UNITS],
    work: &mut Workshop,
    rows: &[Lanes256],
) {
    let stage = &shader.stages[index];
    if std::mem::replace(&mut dotted[index], true) {
        return;
    }
    let (previous, doubled, remap) = &shader.vectors[stage.vector];
    if !std::mem::replace(&mut work.is_remapped[stage.vector], true) {
        let [r, g, b, a] = &compiled.textures[*previous];
        let register = |slot: &Option<u16>| slot.map(|slot| rows[usize::from(slot)].block());
        let registers = [register(r), register(g), register(b), register(a)];
        remap.run::<FMA>(registers, *doubled, &mut work.vectors[stage.vector]);
    }
    let Workshop { numbers, same, vectors, dot, .. } = work;
    if let [Some(s), Some(t), Some(r)] = [0, 1, 2].map(|n| number(numbers, same, stage.numbers[n])) {
        dot::products([s, t, r], &vectors[stage.vector], &mut dot.dots[index]);
    }
}

/// TSH-7: writes the floors of coordinates, less the sampler's bias, that are moved by so many 128ths of the image. Lanes whose floors are
/// not proved are left open.
#[inline(always)]
fn place<const FMA: bool>(
    sampler: &Sampler,
    moved: &Moved,
    [along, down]: [&Floats; 2],
    [u, v]: &mut [PerLane<i32>; 2],
    open: &mut [i32],
) {
    let open = &mut open[..BLOCK];
    // A side of the image has 256 steps for each of its texels.
    let ([width, height], bias) = (sampler.sides.map(|side| 2.0 * f64::from(side)), sampler.bias());
    const PARTS: f64 = (1 << 24) as f64;
    let by = |offset: f32, side: f64, at: f64| {
        multiply_add::<FMA>(floor::<FMA>(f64::from(offset) * (side * PARTS)), 1.0 / PARTS, at)
    };
    let place = |n: usize| {
        let (at_u, at_v) = (by(along[n], width, moved.u[n]), by(down[n], height, moved.v[n]));
        let (near_u, near_v) = ((at_u - whole(at_u)).abs(), (at_v - whole(at_v)).abs());
        (at_u, at_v, if near_u > near_v { near_u } else { near_v })
    };
    for (step, room) in moved.room[..BLOCK / STEP].iter().enumerate() {
        let (lanes, mut close) = (step * STEP..(step + 1) * STEP, 0);
        for n in lanes.clone() {
            let (at_u, at_v, near) = place(n);
            close |= (room - near).to_bits();
            u[n] = nearest(at_u).wrapping_sub(bias);
            v[n] = nearest(at_v).wrapping_sub(bias);
        }
        if close >> 63 != 0 {
            for n in lanes {
                open[n] |= ((room - place(n).2).to_bits() >> 63) as i32;
            }
        }
    }
}

/// Computes the open lanes by the definition. Returns their number.
#[inline(never)]
fn define(
    job: Job<'_>,
    runs: &[Run],
    alive: &mut [bool],
    work: &mut Workshop,
    rows: &mut [Lanes256],
    band: &Band<'_>,
) -> u64 {
    let mut count = 0;
    let lanes = runs.last().map_or(0, |run| run.lane + run.count);
    // Most blocks have no open lanes.
    let any = work.open[..lanes].iter().fold(0, |all, open| all | open) != 0;
    let runs = if any { runs } else { &[] };
    let mut known: Option<(usize, TriangleContext<'_>)> = None;
    let height = job.plan.targets[job.draw.target].height;
    for run in runs {
        for n in (0..run.count).filter(|n| work.open[run.lane + n] != 0) {
            let lane = run.lane + n;
            let at = work.triangles.partition_point(|(first, _)| *first <= lane);
            let Some((_, number)) = at.checked_sub(1).map(|at| work.triangles[at]) else { continue };
            if known.as_ref().is_none_or(|(other, _)| *other != number) {
                known = TriangleContext::new(job.plan, job.draw, number, (0, i64::from(height)))
                    .map(|context| (number, context));
            }
            let Some((_, context)) = &known else { continue };
            let index = run.at + n;
            let pixel = ((index % band.width) as i64, (band.first_row + index / band.width) as i64);
            let sample = Sample::new(&context.triangle, context.triangle.edges(pixel.0, pixel.1));
            let mut registers = Registers::<i32>::new();
            let lives = context.sample_textures(&sample, pixel, &mut registers, job.textures, &mut Silent);
            alive[lane] = lives.is_some();
            count += 1;
            if lives.is_none() {
                // Nothing reads the registers of a dropped pixel, and rows of constants must not change.
                continue;
            }
            job.compiled.put_textures(&registers, lane, rows);
        }
    }
    work.triangles.clear();
    count
}
