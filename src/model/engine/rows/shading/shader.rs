//! TSH-1 to TSH-10 on rows: the texture shader of a draw, compiled stage by stage. `stages.rs` runs it.
#![allow(clippy::float_arithmetic, reason = "tables of which no result depends on how they are rounded")]

use super::dot::Remap;
use crate::engine::rows::interpolate::numbers::Purpose;
use crate::engine::rows::sampling::sampler::Sampler;
use crate::plan::PlannedDraw;
use crate::raster::binary::Binary;
use crate::state::{DependentScale, ShaderOperation, ShaderStage, TEXTURE_UNITS};
use crate::texture::shader;
use crate::texture::stage::{PlannedShader, PlannedShaderStage};

/// Where a number of a stage is found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Number {
    /// It is not read.
    Unread,
    /// Among the draw's constant numbers: it is the same at all vertices.
    Same(usize),
    /// Among the numbers that vary.
    Varying(usize),
}

/// A stage of a texture shader, compiled to rows.
#[derive(Clone, Debug)]
pub(crate) struct Stage {
    pub(crate) state: ShaderStage,
    pub(crate) runs: bool,
    pub(crate) dots: bool,
    /// Index among the draw's samplers.
    pub(crate) sampler: Option<usize>,
    /// The numbers s, t, r and q.
    pub(crate) numbers: [Number; 4],
    /// Index of the remapped colour in its dot product.
    pub(crate) vector: usize,
    /// Channels whose register holds twice the byte.
    pub(crate) doubled: [bool; 4],
    /// The eye vector of a reflection.
    pub(crate) eye: Option<[Number; 3]>,
    /// TSH-8: [`luminance_factor`] for the low nine bits of the earlier unit's red register.
    pub(crate) luminance: Vec<f32>,
    /// TSH-6: u and v of each byte, 1/65536 texel.
    pub(crate) dependent: [Vec<f64>; 2],
}

/// A texture shader compiled to rows.
#[derive(Clone, Debug)]
pub(crate) struct Shader {
    pub(crate) stages: Vec<Stage>,
    /// Stage, component and use of each number that varies.
    pub(crate) varying: Vec<(usize, usize, Purpose)>,
    /// Numbers that are the same at all vertices.
    pub(crate) same: Vec<f32>,
    /// For each remapped colour: the earlier unit, the channels whose registers hold twice the byte, and the mapping.
    pub(crate) vectors: Vec<(usize, [bool; 4], Remap)>,
}

/// Largest distance by which rows move coordinates from which levels of detail follow, 1/256 texel: sums are exact far beyond it.
const FARTHEST_MOVE: f64 = (1_u32 << 30) as f64;

/// Returns whether a stage samples at coordinates that an earlier stage determines.
pub(crate) fn is_dependent(operation: &ShaderOperation) -> bool {
    use ShaderOperation as O;
    match operation {
        O::None | O::PassThrough | O::CullFragment { .. } | O::DotProduct => false,
        O::Sample | O::Sample2D | O::SampleCube => false,
        O::BumpEnvironment { .. }
        | O::DependentAlphaRed
        | O::DependentGreenBlue
        | O::DotProduct2D
        | O::DotProduct3D
        | O::DotProductCube
        | O::DotReflectDiffuse
        | O::DotReflectSpecular
        | O::DotReflectConstantEye { .. } => true,
    }
}

impl Shader {
    /// Compiles the shader of a draw whose units rows can sample. Returns `None` if coordinates are moved too far.
    pub(crate) fn new(draw: &PlannedDraw, samplers: &[Sampler], scale: DependentScale) -> Option<Shader> {
        let planned = draw.shader.as_ref()?;
        let mut shader = Shader { stages: Vec::new(), varying: Vec::new(), same: Vec::new(), vectors: Vec::new() };
        for index in 0..TEXTURE_UNITS {
            let stage = shader.stage(draw, planned, index, samplers, scale)?;
            shader.stages.push(stage);
        }
        Some(shader)
    }

    fn stage(
        &mut self,
        draw: &PlannedDraw,
        shader: &PlannedShader,
        index: usize,
        samplers: &[Sampler],
        scale: DependentScale,
    ) -> Option<Stage> {
        let planned = &shader.stages[index];
        let state = planned.state;
        let sampler = samplers.iter().position(|sampler| sampler.unit == index);
        let mut stage = Stage {
            state,
            runs: planned.runs(),
            dots: planned.dots,
            sampler,
            numbers: [Number::Unread; 4],
            vector: 0,
            doubled: shader.doubled(index, &draw.units),
            eye: None,
            luminance: Vec::new(),
            dependent: [Vec::new(), Vec::new()],
        };
        if !stage.runs {
            return Some(stage);
        }
        let reflects = shader.stages.iter().any(|stage| {
            stage.runs() && stage.live != 0 && matches!(stage.state.operation, ShaderOperation::DotReflectSpecular)
        });
        if stage.dots {
            let components = if reflects { 4 } else { 3 };
            for n in 0..components {
                stage.numbers[n] = self.number(draw, index, &state, n, Purpose::Float);
            }
            stage.vector = self.vector(&state);
        }
        match state.operation {
            ShaderOperation::DotReflectSpecular => {
                stage.eye = Some([self.stages[1].numbers[3], self.stages[2].numbers[3], stage.numbers[3]]);
            }
            ShaderOperation::DotReflectConstantEye { eye } => {
                stage.eye = Some(eye.map(|component| self.constant(component)))
            }
            ShaderOperation::PassThrough => {
                for n in (0..4).filter(|n| planned.live >> n & 1 != 0) {
                    stage.numbers[n] = self.number(draw, index, &state, n, Purpose::Byte);
                }
            }
            ShaderOperation::CullFragment { .. } => {
                for n in 0..4 {
                    stage.numbers[n] = self.number(draw, index, &state, n, Purpose::Sign);
                }
            }
            ShaderOperation::BumpEnvironment { matrix, luminance } => {
                let [m0, m1, m2, m3] = matrix.map(|entry| f64::from(entry.abs()));
                let sides = samplers[sampler?].sides;
                let [width, height] = sides.map(|side| 256.0 * f64::from(side));
                let most = [(m0 + m3) * width, (m1 + m2) * height];
                // NaN is refused too.
                if samplers[sampler?].mixes && !(most[0] < FARTHEST_MOVE && most[1] < FARTHEST_MOVE) {
                    return None;
                }
                if let Some(state) = luminance {
                    let factors: Vec<f32> = (0..=255).map(|red| luminance_factor(red, state)).collect();
                    let doubled = self.stages[planned.state.previous].doubled[0];
                    let red = |register: usize| if doubled { register / 2 } else { register % 256 };
                    stage.luminance = (0..512).map(|register| factors[red(register)]).collect();
                }
            }
            ShaderOperation::DependentAlphaRed | ShaderOperation::DependentGreenBlue => {
                let sampler = &samplers[sampler?];
                stage.dependent = sampler.sides.map(|side| {
                    (0..=255).map(|byte| shader::dependent(byte, i64::from(side) << 8, scale) as f64).collect()
                });
            }
            _ => {}
        }
        Some(stage)
    }

    /// Adds a component of a stage's coordinate set to the numbers of the shader.
    fn number(
        &mut self,
        draw: &PlannedDraw,
        index: usize,
        state: &ShaderStage,
        component: usize,
        purpose: Purpose,
    ) -> Number {
        if let Some(value) = draw.assembly.vertices.same_coordinate(state.coordinate_set, component) {
            return self.constant(purpose.take(value.into()));
        }
        self.varying.push((index, component, purpose));
        Number::Varying(self.varying.len() - 1)
    }

    fn constant(&mut self, value: f32) -> Number {
        self.same.push(value);
        Number::Same(self.same.len() - 1)
    }

    /// Adds the remapped colour that a stage reads. Returns its index.
    fn vector(&mut self, state: &ShaderStage) -> usize {
        let ShaderStage { previous, mapping, .. } = *state;
        let remap = Remap::new(mapping);
        if let Some(known) = self.vectors.iter().position(|vector| (vector.0, vector.2) == (previous, remap)) {
            return known;
        }
        self.vectors.push((previous, self.stages[previous].doubled, remap));
        self.vectors.len() - 1
    }
}

/// Returns what the channels of a stage's register that are read begin with: their constants if the stage does not compute them (TEX-16, TSH-4), and
/// otherwise what lanes without a pixel may hold, which for a signed texel is not 255.
pub(crate) fn initial(stage: &PlannedShaderStage) -> [Option<i16>; 4] {
    let is_dot = stage.runs() && stage.state.operation == ShaderOperation::DotProduct;
    let alpha = if is_dot || stage.unit.is_some() { 0 } else { 255 };
    [0, 1, 2, 3].map(|n: usize| (stage.live >> n & 1 != 0).then_some(if n == 3 { alpha } else { 0 }))
}

/// TSH-8: returns a factor F > 0 such that floor(c F) is the 4096ths of every byte c with this red, up to 4096. No product below 4096 is
/// closer than 1/509 to an integer, so it needs no more than single precision.
///
/// The definition is floor(c X) with some X. Neighbours among the fractions with denominators up to 255 enclose X, and F is their mediant:
/// its denominator, which is at most 509, is above 255, so that c F is not whole.
fn luminance_factor(red: u8, state: [f32; 2]) -> f32 {
    let floor = |c: i64| shader::luminance(c, red.into(), state.map(Binary::new));
    let first = floor(1);
    let (mut below, mut above) = ((first, 1), (first + 1, 1));
    loop {
        let (top, bottom) = (below.0 + above.0, below.1 + above.1);
        if bottom > 255 {
            return top as f32 / bottom as f32;
        }
        // X is not below the fraction.
        let between = if floor(bottom) >= top { &mut below } else { &mut above };
        *between = (top, bottom);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::rows::lanes::{BLOCK, Lanes};
    use crate::engine::rows::shading::dot;

    /// All reds and channels, with scales of any size and both signs, some of which make products whole.
    #[test]
    fn luminances_are_those_of_the_definition() {
        let mut random = crate::random::Random::seeded(8);
        let round = [0.0, 1.0, 0.5, 2.0, 4.0, -1.0, 255.0, 1.1, 0.05, 1.0 / 4096.0, 15.9375, 1e-30, f32::MAX, f32::MIN];
        for n in 0..round.len() * round.len() + 200 {
            let any = |bits: u64| match bits % 3 {
                0 => (bits >> 32) as f32 / (1_u64 << 30) as f32 - 2.0,
                1 => (bits >> 40) as f32 / 65536.0 * if bits & 4 == 0 { 1.0 } else { -1.0 },
                _ => Some(f32::from_bits((bits >> 32) as u32)).filter(|f| f.is_finite()).unwrap_or(1.0),
            };
            let state = match round.get(n / round.len()) {
                Some(scale) => [*scale, round[n % round.len()]],
                None => [any(random.bits()), any(random.bits())],
            };
            for red in 0..=255 {
                let factors = [luminance_factor(red, state); BLOCK];
                let mut channel = std::array::from_fn(|c| c as u8 as i16);
                let wanted = channel.map(|c| {
                    shader::luminance_byte(shader::luminance(i64::from(c), red.into(), state.map(Binary::new))) as i16
                });
                let mut fused = channel;
                dot::luminance::<true>(Lanes::default(), &factors, &mut fused);
                dot::luminance::<false>(Lanes::default(), &factors, &mut channel);
                assert_eq!((fused, channel), (wanted, wanted), "{state:?} {red}");
            }
        }
        let mut negative = [-254; BLOCK];
        dot::luminance::<true>(Lanes::default(), &[4096.0; BLOCK], &mut negative);
        assert_eq!(negative, [0; BLOCK]);
    }
}
