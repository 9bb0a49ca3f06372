//! Runs the stages of a texture shader, one after the other, each for a whole block.
//!
//! The inputs of a stage are interpolated batch by batch: numbers, which are rounded to single precision, and coordinates that a bump stage moves, which
//! keep their fraction. Lanes that are not proved are left open, and the definition runs their stages in the end.
#![allow(clippy::float_arithmetic, reason = "estimates: no result depends on how they are rounded")]

use super::dependent::{BlockQuads, DefinedTriangle};
use super::dot::{self, Floats};
use super::fetch::Workspace;
use super::kernels::{Lanes, PerLane};
use super::moved::{Moved, MovedPlanes, place, place_finely};
use super::planes::{FOUR, FourPlanes, RealPlane, fraction_bits, inverse};
use super::quotient::{Line, Reciprocals, floor_of_factor};
use super::ratios::BoxNumber;
use super::setup::{BatchSetup, PixelBatch, Run};
use super::shader::{Number, Purpose, Shader, byte_of};
use super::short::Dominance;
use super::triangle::Varying;
use super::{BLOCK, CompiledDraw, Job};
use crate::combiner::registers::Registers;
use crate::engine::context::TriangleContext;
use crate::engine::walk::Band;
use crate::number::convert::factor;
use crate::raster::interpolate::{COORDINATE_LIMIT, Sample};
use crate::state::{ShaderOperation, TEXTURE_UNITS};
use crate::trace::Silent;
use std::ops::Range;

/// Four numbers across a triangle.
#[derive(Clone, Copy, Debug, Default)]
struct Numbers {
    /// Their quotients by D.
    planes: FourPlanes,
    /// Their values at the vertices.
    values: [[f32; FOUR]; 3],
    /// Upper bounds of the change of the quotients where the definition [floors](crate::raster::attribute) small numbers.
    floors: [f64; FOUR],
    /// Whether doubles hold the quotients exactly.
    is_exact: [bool; FOUR],
}

/// The set-up of a triangle for a texture shader.
#[derive(Clone, Debug, Default)]
struct Attributes {
    /// Number of the triangle in the draw.
    triangle: Option<usize>,
    denominator: RealPlane,
    /// Reciprocal of a lower bound of D.
    widest: f64,
    numbers: Vec<Numbers>,
    moved: Vec<MovedPlanes>,
}

impl Attributes {
    /// Sets up a triangle.
    #[inline(always)]
    fn set(&mut self, context: &TriangleContext<'_>, shader: &Shader) {
        let triangle = &context.triangle;
        let inverse = inverse(triangle);
        let p = [triangle.p[0] as f64, triangle.p[1] as f64, triangle.p[2] as f64];
        let least = triangle.p[0].min(triangle.p[1]).min(triangle.p[2]) as f64;
        self.triangle = Some(context.number);
        self.denominator = RealPlane::new(triangle, &inverse, p, 0.0);
        self.widest = 1.0 / (least * triangle.doubled_area as f64);
        // Of all numbers first: vectors of what has just been stored one by one would have to wait.
        for (Numbers { values, .. }, varying) in self.numbers.iter_mut().zip(shader.varying.chunks(FOUR)) {
            for (n, (stage, component, _)) in varying.iter().enumerate() {
                let set = shader.stages[*stage].state.coordinate_set;
                [values[0][n], values[1][n], values[2][n]] = context.vertices().coordinate(set, *component);
            }
        }
        for Numbers { planes, values, floors, is_exact } in &mut self.numbers {
            planes.set(triangle, &inverse, values);
            let most = 1.0 / least;
            for n in 0..FOUR {
                floors[n] = planes.lost[n] * most;
            }
            for n in 0..FOUR {
                is_exact[n] = fraction_bits(triangle, &planes.g(n)).is_some();
            }
        }
        self.moved.clear();
        for bump in &shader.moved {
            let set = context.coordinate_set(shader.stages[bump.stage].state.coordinate_set);
            self.moved.push(MovedPlanes::new(triangle, &inverse, bump, set));
        }
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
    numbers: Vec<PerLane<f32>>,
    /// Numbers that are the same everywhere.
    same: Vec<PerLane<f32>>,
    moved: Vec<Moved>,
    attributes: Attributes,
    reciprocals: Box<Reciprocals>,
    /// Not 0 for lanes that are left open: the definition computes them.
    open: PerLane<i32>,
    /// Whether there may be such lanes.
    has_open: bool,
    /// First lane and number of each triangle of the block.
    triangles: Vec<(usize, usize)>,
    /// The quads of the block, if stages need them.
    pub(super) quads: Box<BlockQuads>,
    vectors: Vec<[PerLane<f32>; 3]>,
    is_remapped: Vec<bool>,
    dot: Box<DotUnit>,
}

impl Workshop {
    /// Leaves lanes to the definition.
    pub(super) fn leave_open(&mut self, lanes: Range<usize>) {
        self.open[lanes].fill(1);
        self.has_open = true;
    }

    /// Makes room for the shader of a draw.
    pub(super) fn begin(&mut self, shader: &Shader) {
        self.numbers.resize(shader.varying.len(), PerLane::default());
        self.same.clear();
        self.same.extend(shader.same.iter().map(|value| PerLane::from_value(*value)));
        self.moved.resize(shader.moved.len(), Moved::default());
        self.attributes.triangle = None;
        self.attributes.numbers.resize(shader.varying.len().div_ceil(FOUR), Numbers::default());
        self.open.fill(0);
        self.has_open = false;
        self.triangles.clear();
        self.quads.clear();
        self.vectors.resize(shader.vectors.len(), Default::default());
        self.is_remapped.resize(shader.vectors.len(), false);
        for stage in &shader.stages {
            if let ShaderOperation::DotReflectConstantEye { eye } = stage.state.operation {
                self.dot.eye = eye.map(|component| [component; BLOCK]);
            }
        }
    }
}

impl Workshop {
    /// Interpolates the inputs of a texture shader, all of them numbers, for box `n` of those that are set up together. `reciprocals` has those of
    /// the box.
    #[inline(always)]
    pub(super) fn attributes_together<const FMA: bool>(
        &mut self,
        triangle: usize,
        (boxes, n): (&[BoxNumber], usize),
        batch: PixelBatch<'_>,
        reciprocals: &Reciprocals,
        shader: &Shader,
    ) {
        self.triangles.push((batch.lane, triangle));
        let open = &mut self.open[batch.lanes()];
        for ((out, number), (_, _, purpose)) in self.numbers.iter_mut().zip(boxes).zip(&shader.varying) {
            let out = &mut out[batch.lanes()];
            match number.same(n) {
                Some(value) => out.fill(constant(*purpose, value)),
                None => self.has_open |= number_of::<FMA, false>(*purpose, reciprocals, number.of(n), out, open),
            }
        }
    }

    /// Interpolates the inputs of a texture shader for a batch. If coordinates are moved, sets the dominance of the batch.
    #[inline(always)]
    pub(super) fn attributes<const FMA: bool, const ROW: bool>(
        &mut self,
        context: &TriangleContext<'_>,
        batch: PixelBatch<'_>,
        shader: &Shader,
        dominance: &mut Dominance,
    ) {
        let Workshop { numbers, moved, attributes, reciprocals, open, has_open, triangles, .. } = self;
        let triangle = &context.triangle;
        if attributes.triangle != Some(context.number) {
            attributes.set(context, shader);
        }
        let begins = triangles.is_empty();
        triangles.push((batch.lane, context.number));
        let open = &mut open[batch.lanes()];
        let local = BatchSetup::new::<FMA, ROW>(triangle, batch, &attributes.denominator, attributes.widest);
        if !attributes.numbers.is_empty() {
            reciprocals.set::<FMA, ROW>(batch.at, local.denominator);
        }
        let four = numbers.chunks_mut(FOUR).zip(shader.varying.chunks(FOUR));
        for (Numbers { planes, values, floors, is_exact }, (numbers, varying)) in attributes.numbers.iter().zip(four) {
            let (lines, terms) = planes.around(&local.real, local.columns, local.rows);
            for (n, (out, (_, _, purpose))) in numbers.iter_mut().zip(varying).enumerate() {
                let out = &mut out[batch.lanes()];
                let value = values[0][n];
                if value == values[1][n] && value == values[2][n] {
                    out.fill(constant(*purpose, value));
                    continue;
                }
                let margin = local.margin_by::<ROW>(planes.reach[n], terms[n]);
                // Hardly beyond the triangle no number has more bits.
                let is_exact = is_exact[n] && (!batch.reaches_beyond() || local.ratio < 2.0);
                let off = if is_exact { 0.0 } else { margin + floors[n] * local.ratio };
                *has_open |= number_of::<FMA, ROW>(*purpose, reciprocals, (lines[n], off), out, open);
            }
        }
        if !attributes.moved.is_empty() {
            dominance.set::<FMA, ROW>(triangle, batch, &local);
        }
        for ((planes, moved), bump) in attributes.moved.iter().zip(moved).zip(&shader.moved) {
            if begins {
                moved.begin();
            }
            if !planes.interpolate::<FMA, ROW>(batch, bump, &local, dominance, moved) {
                open.fill(1);
                *has_open = true;
            }
        }
    }
}

/// Returns a number that is the same everywhere.
#[inline(always)]
fn constant(purpose: Purpose, value: f32) -> f32 {
    if purpose == Purpose::Byte { byte_of(f64::from(value)) } else { value + 0.0 }
}

/// Computes quotients of a line, whose error is less than the number beside it, for a purpose. Returns whether lanes are left open.
#[inline(always)]
fn number_of<const FMA: bool, const ROW: bool>(
    purpose: Purpose,
    reciprocals: &Reciprocals,
    (line, off): (Line, f64),
    out: &mut [f32],
    open: &mut [i32],
) -> bool {
    match purpose {
        Purpose::Float | Purpose::Sign => rounded::<FMA, ROW, false>(reciprocals, line, off, out, open),
        Purpose::Byte => rounded::<FMA, ROW, true>(reciprocals, line, off, out, open),
    }
}

/// Computes quotients, rounded to single precision, or as `BYTE`s (TSH-9). Lanes that are not proved are left open, and so are zeros in
/// single precision. Returns whether there are any.
#[inline(always)]
fn rounded<const FMA: bool, const ROW: bool, const BYTE: bool>(
    reciprocals: &Reciprocals,
    line: Line,
    off: f64,
    out: &mut [f32],
    open: &mut [i32],
) -> bool {
    let lanes = out.len();
    let ([xs, ys, rs], open) = (reciprocals.lanes(lanes), &mut open[..lanes]);
    let estimate = |n: usize| {
        let value = line.at::<FMA, ROW>(xs[n], ys[n]) * rs[n];
        if BYTE {
            let (low, high) = ((value - off) * 4096.0, (value + off) * 4096.0);
            let (low, high) = (factor(floor_of_factor::<FMA>(low)), factor(floor_of_factor::<FMA>(high)));
            // NaN is left open too.
            (low as f32, (low != high) | value.is_nan() | off.is_nan())
        } else {
            let (low, high) = ((value - off) as f32, (value + off) as f32);
            (low, (low != high) | (low == 0.0))
        }
    };
    let mut any = false;
    for n in 0..lanes {
        let (number, is_open) = estimate(n);
        out[n] = number;
        any |= is_open;
    }
    // Few batches have such lanes.
    for n in 0..if any { lanes } else { 0 } {
        open[n] |= i32::from(estimate(n).1);
    }
    any
}

/// Runs the stages of a block's pixels, which write their registers to rows. Returns the number of pixels that the definition computed.
#[inline(always)]
pub(super) fn run<const FMA: bool>(
    job: &Job<'_>,
    runs: &[Run],
    varying: &mut Varying,
    workshop: &mut Workshop,
    (work, rows): (&mut Workspace, &mut [PerLane<i16>]),
    band: &Band<'_>,
) -> u64 {
    let Some(shader) = &job.compiled.shader else { return 0 };
    workshop.is_remapped.fill(false);
    let lanes = work.lanes;
    let mut dotted = [false; TEXTURE_UNITS];
    for (index, stage) in shader.stages.iter().enumerate().filter(|(_, stage)| stage.runs) {
        if stage.dots {
            dot_product((job.compiled, lanes), shader, index, &mut dotted, workshop, rows);
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
                        for k in 0..lanes.count() {
                            // A byte, also in lanes without a pixel, which may hold any number.
                            out[k] = (number[k] as i32 & 255) as i16;
                        }
                    }
                }
            }
            ShaderOperation::CullFragment { drops_not_negative } => {
                for n in 0..4 {
                    let Some(number) = number(&workshop.numbers, &workshop.same, stage.numbers[n]) else { continue };
                    for (alive, number) in varying.alive.iter_mut().zip(number) {
                        *alive &= (*number < 0.0) == drops_not_negative[n];
                    }
                }
            }
            ShaderOperation::Sample => {
                let Some(at) = stage.sampler else { continue };
                (job.sample)(job, at, varying, work, rows);
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
                            dot::moved(lanes, matrix, blue, green, along, down);
                            let shift = shader.moved[stage.moved].shift;
                            let (of, open) = ((sampler, lanes), &mut workshop.open);
                            workshop.has_open |= place::<FMA>(of, (moved, shift), [along, down], numbers, open);
                            if sampler.mixes {
                                let quads = &mut workshop.quads;
                                if place_finely::<FMA>(of, moved, [along, down], &mut quads.fine, &mut quads.close) {
                                    quads.settle(job, &job.draw.units[sampler.index], [along, down]);
                                }
                                quads.take_lanes();
                            }
                        }
                    }
                    ShaderOperation::DependentAlphaRed | ShaderOperation::DependentGreenBlue => {
                        let channels = if operation == ShaderOperation::DependentAlphaRed { [3, 0] } else { [1, 2] };
                        let doubled = shader.stages[stage.state.previous].doubled;
                        for n in 0..2 {
                            let Some(slot) = earlier[channels[n]] else { continue };
                            let Some(table) = stage.dependent[n].first_chunk::<256>() else { continue };
                            let (from, down) = (rows[usize::from(slot)].block(), u32::from(doubled[channels[n]]));
                            let (bias, fine) = (sampler.bias(), workshop.quads.fine[n].block_mut());
                            let out = numbers[n].block_mut();
                            for k in 0..lanes.count() {
                                let at = table[usize::from((from[k] >> down) as u8)];
                                (out[k], fine[k]) = ((at >> 8) - bias, f64::from(at));
                            }
                        }
                        if sampler.mixes {
                            workshop.quads.take_lanes();
                        }
                    }
                    ShaderOperation::DotProduct2D => {
                        for n in 0..2 {
                            dot_product((job.compiled, lanes), shader, index + n - 1, &mut dotted, workshop, rows);
                            let limit = COORDINATE_LIMIT as i32;
                            let (floats, side) = (&workshop.dot.dots[index + n - 1], sampler.sides[n]);
                            dot::coordinate(lanes, floats, side, limit, sampler.bias(), numbers[n].block_mut());
                            if sampler.mixes {
                                workshop.quads.set_floats::<FMA>((n, lanes), floats, side, workshop.open.block_mut());
                            }
                        }
                        if sampler.mixes {
                            workshop.quads.take_lanes();
                        }
                    }
                    _ => {
                        for n in 1..4 {
                            dot_product((job.compiled, lanes), shader, n, &mut dotted, workshop, rows);
                        }
                        let Some((vector, scratch, quads)) = workshop.vector((shader, lanes), &operation) else {
                            continue;
                        };
                        let ([u, v], faces) = (numbers.each_mut().map(PerLane::block_mut), faces.block_mut());
                        dot::on_faces::<FMA>(lanes, vector, (sampler.sides[0], sampler.bias()), scratch, u, v, faces);
                        if sampler.mixes {
                            quads.set_directions(vector, sampler.sides[0]);
                        }
                    }
                }
                if let (true, Some(reads)) = (sampler.mixes, varying.reads.get_mut(at)) {
                    let (open, [u, v]) = (workshop.open.block_mut(), &varying.coordinates[at]);
                    let of = (&job.draw.units[sampler.index], &**table, lanes);
                    let faces = sampler.has_images().then_some(&varying.faces[at]);
                    workshop.quads.fetches::<FMA>(of, u, v, faces, open, reads);
                    workshop.has_open |= open.iter().fold(0, |all, open| all | open) != 0;
                }
                (job.sample)(job, at, varying, work, rows);
                if let (Some(factors), Some(red)) = (stage.luminance.first_chunk::<512>(), earlier[0]) {
                    let [products, ..] = &mut workshop.dot.scratch;
                    let red = rows[usize::from(red)].block();
                    for n in 0..lanes.count() {
                        products[n] = factors[usize::from(red[n] as u16 % 512)];
                    }
                    for slot in wanted[..3].iter().flatten() {
                        dot::luminance::<FMA>(lanes, products, rows[usize::from(*slot)].block_mut());
                    }
                }
            }
        }
    }
    // Most blocks have no open lanes.
    let mut count = 0;
    if std::mem::take(&mut workshop.has_open) {
        count = define(job, runs, &mut varying.alive, workshop, rows, band);
        workshop.open.fill(0);
    }
    workshop.triangles.clear();
    workshop.quads.clear();
    count
}

/// Returns a number of the block's pixels.
#[inline(always)]
fn number<'w>(varying: &'w [PerLane<f32>], same: &'w [PerLane<f32>], number: Number) -> Option<&'w Floats> {
    match number {
        Number::Unread => None,
        Number::Same(n) => Some(same[n].block()),
        Number::Varying(n) => Some(varying[n].block()),
    }
}

impl Workshop {
    /// Returns the vector of a look-up in a cube map, scratch space, and the quads of the block.
    #[inline(always)]
    fn vector(
        &mut self,
        (shader, lanes): (&Shader, Lanes),
        operation: &ShaderOperation,
    ) -> Option<([&Floats; 3], &mut [Floats; 3], &mut BlockQuads)> {
        let Workshop { numbers, same, dot, quads, .. } = self;
        let DotUnit { dots: [_, first, second, third], reflected, eye, scratch } = &mut **dot;
        let dots = [&*first, &*second, &*third];
        let eye = match operation {
            ShaderOperation::DotReflectSpecular => {
                let component = |n: usize| number(numbers, same, shader.stages[n].numbers[3]);
                [component(1)?, component(2)?, component(3)?]
            }
            ShaderOperation::DotReflectConstantEye { .. } => eye.each_ref(),
            _ => return Some((dots, scratch, quads)),
        };
        dot::reflect(lanes, dots, eye, reflected);
        Some((reflected.each_ref(), scratch, quads))
    }
}

/// TSH-4: computes the dot product of a stage, unless it is known already.
#[inline(always)]
fn dot_product(
    (compiled, lanes): (&CompiledDraw, Lanes),
    shader: &Shader,
    index: usize,
    dotted: &mut [bool; TEXTURE_UNITS],
    work: &mut Workshop,
    rows: &[PerLane<i16>],
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
        remap.run(lanes, registers, *doubled, work.vectors[stage.vector].each_mut().map(PerLane::block_mut));
    }
    let Workshop { numbers, same, vectors, dot, .. } = work;
    if let [Some(s), Some(t), Some(r)] = [0, 1, 2].map(|n| number(numbers, same, stage.numbers[n])) {
        dot::products(lanes, [s, t, r], vectors[stage.vector].each_ref().map(PerLane::block), &mut dot.dots[index]);
    }
}

/// Computes the open lanes by the definition. Returns their number.
#[inline(never)]
fn define(
    job: &Job<'_>,
    runs: &[Run],
    alive: &mut [bool],
    work: &mut Workshop,
    rows: &mut [PerLane<i16>],
    band: &Band<'_>,
) -> u64 {
    let mut count = 0;
    let mut triangle = DefinedTriangle::default();
    for run in runs {
        for n in (0..run.count()).filter(|n| work.open[run.lane() + n] != 0) {
            let lane = run.lane() + n;
            let at = work.triangles.partition_point(|(first, _)| *first <= lane);
            let Some((_, number)) = at.checked_sub(1).map(|at| work.triangles[at]) else { continue };
            let Some(context) = triangle.set_up(job, number) else { continue };
            let index = run.at() + n;
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
    count
}
