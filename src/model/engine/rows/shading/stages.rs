//! Runs the stages of a texture shader, one after the other, each for a whole block.
#![allow(
    clippy::float_arithmetic,
    reason = "the chip's dot unit is a float unit, and doubles hold coordinates exactly"
)]

use super::compiled::CompiledDraw;
use super::dot::{self, Floats};
use super::shader::{Number, Shader};
use crate::engine::rows::geometry::weights::Pixels;
use crate::engine::rows::lanes::{Lanes, PerLane, floor_of_sum, larger, smaller};
use crate::engine::rows::sampling::fetch::{Reader, SampleUnit, Workspace};
use crate::engine::rows::sampling::filter::Filter;
use crate::engine::rows::sampling::place::{FARTHEST, Place, change_kind};
use crate::engine::rows::sampling::quads::Quads;
use crate::engine::rows::sampling::sampler::Sampler;
use crate::plan::PlannedDraw;
use crate::state::{ShaderOperation, TEXTURE_UNITS};

/// Registers of the dot unit.
#[derive(Clone, Debug, Default)]
struct DotUnit {
    /// Dot product of each stage.
    dots: [PerLane<f32>; TEXTURE_UNITS],
    reflected: [PerLane<f32>; 3],
    /// Scratch space of a stage.
    scratch: [PerLane<f32>; 3],
}

/// Buffers of a texture shader.
#[derive(Clone, Debug, Default)]
pub(crate) struct Workshop {
    /// Numbers that vary.
    pub(crate) numbers: Vec<PerLane<f32>>,
    /// Numbers that are the same everywhere.
    same: Vec<PerLane<f32>>,
    vectors: Vec<[PerLane<f32>; 3]>,
    is_remapped: Vec<bool>,
    dot: Box<DotUnit>,
}

impl Workshop {
    /// Makes room for the shader of a draw.
    pub(crate) fn begin(&mut self, shader: &Shader) {
        self.numbers.resize(shader.varying.len(), PerLane::default());
        self.same.clear();
        self.same.extend(shader.same.iter().map(|value| PerLane::from_value(*value)));
        self.vectors.resize(shader.vectors.len(), Default::default());
        self.is_remapped.resize(shader.vectors.len(), false);
    }
}

/// What the stages of a block's pixels run on.
pub(crate) struct Stages<'b> {
    pub(crate) draw: &'b PlannedDraw,
    pub(crate) compiled: &'b CompiledDraw,
    pub(crate) filter: Filter,
    pub(crate) sample: SampleUnit,
    pub(crate) pixels: &'b Pixels,
    pub(crate) places: &'b mut [Place],
    pub(crate) quads: &'b mut Quads,
    pub(crate) workshop: &'b mut Workshop,
    pub(crate) work: &'b mut Workspace,
    pub(crate) alive: &'b mut [bool],
    pub(crate) rows: &'b mut [PerLane<i16>],
}

impl Stages<'_> {
    /// Runs the stages of a block's pixels, which write their registers to rows.
    #[inline(always)]
    pub(crate) fn run<const FMA: bool>(mut self) {
        let compiled = self.compiled;
        let Some(shader) = &compiled.shader else { return };
        self.workshop.is_remapped.fill(false);
        let lanes = self.work.lanes;
        let mut dotted = [false; TEXTURE_UNITS];
        for (index, stage) in shader.stages.iter().enumerate().filter(|(_, stage)| stage.runs) {
            if stage.dots {
                self.dot_product(shader, index, &mut dotted);
            }
            match stage.state.operation {
                ShaderOperation::None | ShaderOperation::DotProduct => {}
                ShaderOperation::PassThrough => {
                    for n in 0..4 {
                        if let Some(slot) = compiled.textures[index][n]
                            && let Some(number) = self.workshop.number(stage.numbers[n])
                        {
                            let out = self.rows[usize::from(slot)].block_mut();
                            for k in 0..lanes.count() {
                                // A byte, also in lanes without a pixel, which may hold any number.
                                out[k] = (number[k] as i32 & 255) as i16;
                            }
                        }
                    }
                }
                ShaderOperation::CullFragment { drops_not_negative } => {
                    for n in 0..4 {
                        let Some(number) = self.workshop.number(stage.numbers[n]) else { continue };
                        for (alive, number) in self.alive.iter_mut().zip(number) {
                            *alive &= (*number < 0.0) == drops_not_negative[n];
                        }
                    }
                }
                operation if operation.samples_own() => {
                    let Some(at) = stage.sampler else { continue };
                    self.sample(at);
                }
                operation => {
                    let Some(at) = stage.sampler else { continue };
                    self.depend((shader, index), at, operation, &mut dotted);
                    self.sample(at);
                    let red = compiled.textures[stage.state.previous][0];
                    if let (Some(factors), Some(red)) = (stage.luminance.first_chunk::<512>(), red) {
                        let products = self.workshop.dot.scratch[0].block_mut();
                        let red = self.rows[usize::from(red)].block();
                        for n in 0..lanes.count() {
                            products[n] = factors[usize::from(red[n] as u16 % 512)];
                        }
                        for slot in compiled.textures[index][..3].iter().flatten() {
                            dot::luminance::<FMA>(lanes, products, self.rows[usize::from(*slot)].block_mut());
                        }
                    }
                }
            }
        }
    }

    /// Samples the unit of a sampler.
    #[inline(always)]
    fn sample(&mut self, at: usize) {
        let sampler = &self.compiled.samplers[at];
        let unit = &self.draw.units[sampler.index];
        let reader = Reader { filter: self.filter, unit, sampler, wanted: self.compiled.textures[sampler.unit] };
        (self.sample)(reader, self.pixels, &mut self.places[at], self.quads, self.work, self.alive, self.rows);
    }

    /// Computes where a stage samples that depends on an earlier one.
    #[inline(always)]
    fn depend(
        &mut self,
        (shader, index): (&Shader, usize),
        at: usize,
        operation: ShaderOperation,
        dotted: &mut [bool; TEXTURE_UNITS],
    ) {
        let (compiled, lanes, stage) = (self.compiled, self.work.lanes, &shader.stages[index]);
        let sampler = &compiled.samplers[at];
        let earlier = compiled.textures[stage.state.previous];
        let doubled = shader.stages[stage.state.previous].doubled;
        match operation {
            ShaderOperation::BumpEnvironment { matrix, .. } => {
                let [_, green, blue, _] = earlier.map(|slot| slot.map(|slot| self.rows[usize::from(slot)].block()));
                let (Some(blue), Some(green)) = (blue, green) else { return };
                let (blue, green) = ((blue, doubled[2]), (green, doubled[1]));
                let [along, down, _] = self.workshop.dot.scratch.each_mut().map(PerLane::block_mut);
                dot::moved(lanes, matrix, blue, green, along, down);
                self.places[at].shift(lanes, sampler, [along, down]);
            }
            ShaderOperation::DependentAlphaRed | ShaderOperation::DependentGreenBlue => {
                let channels = if operation == ShaderOperation::DependentAlphaRed { [3, 0] } else { [1, 2] };
                for n in 0..2 {
                    let Some(slot) = earlier[channels[n]] else { continue };
                    let Some(table) = stage.dependent[n].first_chunk::<256>() else { continue };
                    let (from, down) = (self.rows[usize::from(slot)].block(), u32::from(doubled[channels[n]]));
                    let fine = self.places[at].fine[n].block_mut();
                    for k in 0..lanes.count() {
                        fine[k] = table[usize::from((from[k] >> down) as u8)];
                    }
                }
            }
            ShaderOperation::DotProduct2D | ShaderOperation::DotProduct3D => {
                let first = if operation == ShaderOperation::DotProduct2D { index - 1 } else { index - 2 };
                for n in 0..2 {
                    self.dot_product(shader, first + n, dotted);
                    let floats = self.workshop.dot.dots[first + n].block();
                    if sampler.cube {
                        self.places[at].set_ends(n, lanes, floats, sampler.sides[n]);
                    } else {
                        self.places[at].set_floats(n, lanes, floats, sampler.sides[n]);
                    }
                }
            }
            _ => {
                for n in 1..4 {
                    self.dot_product(shader, n, dotted);
                }
                self.face(at, stage.eye);
                return;
            }
        }
        self.places[at].settle(0..lanes.count(), sampler.bias());
    }

    /// Computes where a sampler samples in a direction of the dot unit, reflected if there is an eye vector.
    #[inline(always)]
    fn face(&mut self, at: usize, eye: Option<[Number; 3]>) {
        let (lanes, sampler) = (self.work.lanes, &self.compiled.samplers[at]);
        let Some((mut vector, scratch)) = self.workshop.vector(lanes, eye) else { return };
        let Place { at: uv, images, fine, direction, .. } = &mut self.places[at];
        let ([u, v], faces) = (uv.each_mut().map(PerLane::block_mut), images.block_mut());
        // TEX-20: t lies the other way round where y changes its sign.
        let turned;
        if sampler.is_other_kind() {
            let mut y = PerLane::<f32>::default();
            for n in 0..lanes.count() {
                y[n] = -vector[1][n];
            }
            turned = y;
            vector[1] = turned.block();
        }
        let (side, bias) = (sampler.side_of_face(), sampler.early_bias());
        dot::on_faces(lanes, vector, (side, bias), scratch, u, v, faces);
        if sampler.is_other_kind() {
            let majors = &self.workshop.dot.scratch[2];
            change_kind(uv, sampler, 0..lanes.count(), |n| majors[n] <= 0.0);
            return;
        }
        if sampler.takes_quads() {
            for (from, to) in uv.iter().zip(fine) {
                for n in 0..lanes.count() {
                    to[n] = 256.0 * f64::from(from[n]);
                }
            }
            for (from, to) in vector.into_iter().zip(direction) {
                for n in 0..lanes.count() {
                    to[n] = f64::from(from[n]);
                }
            }
        }
    }

    /// TSH-4: computes the dot product of a stage, unless it is known already.
    #[inline(always)]
    fn dot_product(&mut self, shader: &Shader, index: usize, dotted: &mut [bool; TEXTURE_UNITS]) {
        let (stage, lanes) = (&shader.stages[index], self.work.lanes);
        if std::mem::replace(&mut dotted[index], true) {
            return;
        }
        let (previous, doubled, remap) = &shader.vectors[stage.vector];
        if !std::mem::replace(&mut self.workshop.is_remapped[stage.vector], true) {
            let [r, g, b, a] = &self.compiled.textures[*previous];
            let register = |slot: &Option<u16>| slot.map(|slot| self.rows[usize::from(slot)].block());
            let registers = [register(r), register(g), register(b), register(a)];
            let out = self.workshop.vectors[stage.vector].each_mut().map(PerLane::block_mut);
            remap.run(lanes, registers, *doubled, out);
        }
        let Workshop { numbers, same, vectors, dot, .. } = &mut *self.workshop;
        if let [Some(s), Some(t), Some(r)] = [0, 1, 2].map(|n| number(numbers, same, stage.numbers[n])) {
            dot::products(
                lanes,
                [s, t, r],
                vectors[stage.vector].each_ref().map(PerLane::block),
                dot.dots[index].block_mut(),
            );
        }
    }
}

impl Place {
    /// TSH-7: moves the coordinates s and t of the direction by so many 128ths of the image.
    #[inline(always)]
    fn shift(&mut self, lanes: Lanes, sampler: &Sampler, by: [&Floats; 2]) {
        for (axis, by) in by.into_iter().enumerate() {
            let side = f64::from(sampler.sides[axis]);
            let (from, fine) = (self.direction[axis].block(), self.fine[axis].block_mut());
            for n in 0..lanes.count() {
                // NaN counts as 0.
                let by = f64::from(if by[n].is_nan() { 0.0 } else { smaller(larger(by[n], f32::MIN), f32::MAX) });
                let floor = floor_of_sum(from[n] * (65536.0 * side), by * (512.0 * side));
                fine[n] = smaller(larger(floor, -FARTHEST), FARTHEST);
            }
        }
    }

    /// TSH-4: takes results of the dot unit as coordinates.
    #[inline(always)]
    fn set_floats(&mut self, axis: usize, lanes: Lanes, floats: &Floats, side: u32) {
        let (scale, fine) = (65536.0 * f64::from(side), self.fine[axis].block_mut());
        for n in 0..lanes.count() {
            // NaN counts as 0.
            let t = if floats[n].is_nan() { 0.0 } else { f64::from(floats[n]) * scale };
            fine[n] = smaller(larger(t.floor(), -FARTHEST), FARTHEST);
        }
    }

    /// TEX-20: takes the ends of a face that signs of results of the dot unit choose.
    #[inline(always)]
    fn set_ends(&mut self, axis: usize, lanes: Lanes, floats: &Floats, side: u32) {
        let (last, fine) = (65536.0 * f64::from(side), self.fine[axis].block_mut());
        for n in 0..lanes.count() {
            let is_last = if axis == 0 { floats[n] < 0.0 } else { floats[n] > 0.0 };
            fine[n] = if is_last { last } else { 0.0 };
        }
    }
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
    #[inline(always)]
    fn number(&self, of: Number) -> Option<&Floats> {
        number(&self.numbers, &self.same, of)
    }

    /// Returns the vector of a look-up in a cube map, reflected if there is an eye vector, and scratch space.
    #[inline(always)]
    fn vector(&mut self, lanes: Lanes, eye: Option<[Number; 3]>) -> Option<([&Floats; 3], [&mut Floats; 3])> {
        let Workshop { numbers, same, dot, .. } = self;
        let DotUnit { dots: [_, dots @ ..], reflected, scratch } = &mut **dot;
        let (dots, scratch) = (dots.each_ref().map(PerLane::block), scratch.each_mut().map(PerLane::block_mut));
        let Some([a, b, c]) = eye else { return Some((dots, scratch)) };
        let eye = [number(numbers, same, a)?, number(numbers, same, b)?, number(numbers, same, c)?];
        dot::reflect(lanes, dots, eye, reflected.each_mut().map(PerLane::block_mut));
        Some((reflected.each_ref().map(PerLane::block), scratch))
    }
}
