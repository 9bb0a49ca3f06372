//! Reads the stages of a texture shader (TSH-1 to TSH-10).

use std::ops::{Add, Mul, Neg};

use ninebit::number::{Integer, Register as _, convert};
use ninebit::raster::binary::Binary;
use ninebit::raster::fog;
use ninebit::state::*;
use ninebit::texture::stage::PlannedShader;
use ninebit::texture::{dot, shader, single};

use crate::binary::{Interpolant, counted};
use crate::code::{COORDINATE, Code, Operand};
use crate::helper::Helper;
use crate::number::Number;
use crate::pixel::UNBOUND;
use crate::place::{Place, Projection, Unit};
use crate::truth::Truth;
use crate::whole::{Interpolator, Sample, Whole};

/// A number of the dot unit: the pattern of binary32.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Single<'a>(pub(crate) Number<'a>);

impl<'a> Single<'a> {
    pub(crate) fn called<const N: usize>(helper: Helper, of: [Number<'a>; N]) -> Single<'a> {
        Single(match of.iter().find_map(|number| number.code()) {
            Some(code) => counted(code, helper, &of.map(Number::operand)),
            None => {
                let mut constants = [0; 6];
                constants.iter_mut().zip(of).for_each(|(constant, number)| *constant = number.range().0);
                Number::Constant(helper.compute(constants))
            }
        })
    }

    /// Returns the nearest to a number.
    pub(crate) fn rounded(code: &'a Code, number: Interpolant<'a>) -> Single<'a> {
        let Binary { mantissa, exponent } = number.parts(code, COORDINATE);
        code.by("TSH-4");
        Single(mantissa.rounded(exponent))
    }

    /// Returns the nearest to a fraction of [`dot::fractions`].
    pub(crate) fn fraction((numerator, denominator): (Number<'a>, Number<'a>)) -> Single<'a> {
        let (numerator, denominator) = (numerator.within(-(1 << 16), 1 << 16), denominator.within(1, 1 << 30));
        Single::called(Helper::SingleQuotient, [numerator, denominator])
    }

    pub(crate) fn constant(value: f32) -> Single<'a> {
        Single(Number::Constant(value.to_bits().into()))
    }
}

impl<'a> Add for Single<'a> {
    type Output = Single<'a>;
    fn add(self, other: Single<'a>) -> Single<'a> {
        Single::called(Helper::SingleSum, [self.0, other.0])
    }
}

impl<'a> Neg for Single<'a> {
    type Output = Single<'a>;
    fn neg(self) -> Single<'a> {
        Single(single::negated(self.0))
    }
}

impl<'a> Mul for Single<'a> {
    type Output = Single<'a>;
    fn mul(self, other: Single<'a>) -> Single<'a> {
        Single::called(Helper::SingleProduct, [self.0, other.0])
    }
}

impl dot::Number for Single<'_> {
    const ZERO: Self = Single(Number::Constant(0));
    const TWO: Self = Single(Number::Constant(0x4000_0000));

    fn sum(products: [Self; 3]) -> Self {
        Single::called(Helper::AlignedSum, products.map(|product| product.0))
    }
}

/// The results of the stages so far.
struct State<'a> {
    registers: [[Number<'a>; 4]; TEXTURE_UNITS],
    dots: [Option<Single<'a>>; TEXTURE_UNITS],
    dropped: Truth<'a>,
}

/// The stages of a draw.
pub(crate) struct Stages<'a, 's, 'w> {
    pub(crate) whole: &'w Whole<'a, 's>,
    pub(crate) shader: &'s PlannedShader,
    /// How the bytes of a dependent read become coordinates (TSH-6).
    pub(crate) scale: DependentScale,
    /// The first pixel of the quad.
    pub(crate) quad: [Number<'a>; 2],
    /// The registers before all stages: those of stages that do not run.
    pub(crate) first: [[Number<'a>; 4]; TEXTURE_UNITS],
}

impl<'a> Stages<'a, '_, '_> {
    /// Returns the four texture registers, and whether the fragment is dropped.
    pub(crate) fn run(&self, sample: &Sample<'a>) -> ([[Number<'a>; 4]; TEXTURE_UNITS], Truth<'a>) {
        let State { registers, dropped, .. } = self.before(TEXTURE_UNITS, sample);
        (registers, dropped)
    }

    /// Runs the stages before one.
    fn before(&self, end: usize, sample: &Sample<'a>) -> State<'a> {
        let mut state = State { registers: self.first, dots: [None; TEXTURE_UNITS], dropped: Truth::Known(false) };
        for index in (0..end).filter(|index| self.shader.stages[*index].runs()) {
            self.stage(index, sample, &mut state);
        }
        state
    }

    fn stage(&self, index: usize, sample: &Sample<'a>, state: &mut State<'a>) {
        let planned = &self.shader.stages[index];
        if planned.dots {
            self.dot(index, sample, state);
        }
        let unit = planned.unit.map(|unit| &self.whole.planned.units[unit]);
        let (register, dropped) = match (planned.state.operation, unit) {
            (ShaderOperation::PassThrough, _) => (self.pass_through(index, sample), Truth::Known(false)),
            (ShaderOperation::CullFragment { drops_not_negative }, _) => {
                (UNBOUND, self.whole.drops(index, drops_not_negative.map(Truth::Known), sample))
            }
            (ShaderOperation::DotProduct, _) => ([Number::ZERO; 4], Truth::Known(false)),
            (operation, Some(unit)) if operation.samples_own() => {
                let projection = Projection::new(self.whole, unit);
                Unit::new(self.whole, unit, sample, self.quad, &|_| Place::Own(projection)).register()
            }
            (ShaderOperation::None, _) | (_, None) => (UNBOUND, Truth::Known(false)),
            (operation, Some(unit)) => {
                let place = self.place(index, sample, state);
                let at = |sample: &Sample<'a>| self.place(index, sample, &mut self.before(index, sample));
                let (register, dropped) = Unit::at(self.whole, unit, (sample, place), self.quad, &at).register();
                let register = match operation {
                    ShaderOperation::BumpEnvironment { luminance: Some(luminance), .. } => {
                        self.lit(index, register, luminance, state)
                    }
                    _ => register,
                };
                (register, dropped)
            }
        };
        state.registers[index] = register;
        state.dropped = state.dropped | dropped;
    }

    /// Returns the bytes of an earlier unit's colour.
    fn bytes(&self, unit: usize, state: &State<'a>) -> [Number<'a>; 4] {
        let doubled = self.shader.doubled(unit, &self.whole.planned.units);
        [0, 1, 2, 3].map(|n: usize| byte(state.registers[unit][n], Truth::Known(doubled[n])))
    }

    /// TSH-9: returns the coordinates, limited, as a colour.
    fn pass_through(&self, index: usize, sample: &Sample<'a>) -> [Number<'a>; 4] {
        let live = self.shader.stages[index].live;
        let of = |n: usize| if live >> n & 1 == 0 { Number::ZERO } else { self.whole.passed(index, n, sample) };
        [0, 1, 2, 3].map(of)
    }

    /// TSH-1 to TSH-4: returns the dot product of a stage.
    fn dot(&self, index: usize, sample: &Sample<'a>, state: &mut State<'a>) -> Single<'a> {
        if let Some(dot) = state.dots[index] {
            return dot;
        }
        let ShaderStage { previous, mapping, .. } = self.shader.stages[index].state;
        let dot = self.whole.dot(index, mapping, self.bytes(previous, state), sample);
        self.whole.code.name(dot.0.operand(), || format!("dot{index}"));
        state.dots[index] = Some(dot);
        dot
    }

    /// Returns the dot products of stages 1 to 3.
    fn normal(&self, sample: &Sample<'a>, state: &mut State<'a>) -> [Single<'a>; 3] {
        [1, 2, 3].map(|index| self.dot(index, sample, state))
    }

    /// Returns where a stage that depends on an earlier one samples.
    fn place(&self, index: usize, sample: &Sample<'a>, state: &mut State<'a>) -> Place<'a> {
        let ShaderStage { operation, previous, .. } = self.shader.stages[index].state;
        match operation {
            ShaderOperation::DotProduct2D => {
                Place::Floats([index - 1, index].map(|index| self.dot(index, sample, state).0))
            }
            ShaderOperation::DotProduct3D => {
                let dots = [index - 2, index - 1].map(|index| self.dot(index, sample, state).0);
                let unit = self.shader.stages[index].unit.map(|unit| &self.whole.planned.units[unit]);
                let has_faces = unit.is_some_and(|unit| unit.kind == TextureKind::Cube);
                if has_faces { Place::Ends(dots) } else { Place::Floats(dots) }
            }
            ShaderOperation::DotReflectSpecular | ShaderOperation::DotReflectConstantEye { .. } => {
                let normal = self.normal(sample, state);
                let eye = match operation {
                    ShaderOperation::DotReflectConstantEye { eye } => eye.map(Single::constant),
                    _ => [1, 2, 3].map(|index| self.whole.rounded(index, 3, sample)),
                };
                let is_unit = self.shader.stages[index].unit_normals;
                let square = if is_unit { Single::constant(1.0) } else { dot::dot(normal, normal) };
                self.vector(dot::reflect_about(normal, square, eye).vector)
            }
            ShaderOperation::DependentAlphaRed | ShaderOperation::DependentGreenBlue => {
                let channels = if operation == ShaderOperation::DependentAlphaRed { [3, 0] } else { [1, 2] };
                let bytes = self.bytes(previous, state);
                Place::Bytes(channels.map(|n: usize| bytes[n]), self.scale)
            }
            ShaderOperation::BumpEnvironment { matrix: [m0, m1, m2, m3], .. } => {
                let [_, green, blue, _] = self.bytes(previous, state);
                let entries = [[m0, m3], [m1, m2]].map(|entries| entries.map(Single::constant));
                Place::Moved(entries.map(|entries| moved(entries, [blue, green]).0))
            }
            // DotProductCube and DotReflectDiffuse.
            _ => {
                let normal = self.normal(sample, state);
                self.vector(normal)
            }
        }
    }

    /// Returns a place in a cube map.
    fn vector(&self, vector: [Single<'a>; 3]) -> Place<'a> {
        let code = self.whole.code;
        code.by("TEX-13");
        let patterns = shader::finite_vector(vector.map(|component| component.0));
        let number = |bits: Number<'a>| {
            Interpolant::from_line(code, crate::binary::call(code, Helper::Split, &[bits.operand()]))
        };
        Place::Vector(patterns.map(number))
    }

    /// TSH-8: multiplies a texel by the scaled luminance.
    fn lit(&self, index: usize, color: [Number<'a>; 4], state: [f32; 2], results: &State<'a>) -> [Number<'a>; 4] {
        let (code, planned) = (self.whole.code, &self.shader.stages[index]);
        let [red, ..] = self.bytes(planned.state.previous, results);
        let [scale, offset] = state.map(|f| Interpolant::Known(Binary::new(f)).operand(code));
        [0, 1, 2, 3].map(|n: usize| {
            if n == 3 && !planned.lights_alpha || planned.live >> n & 1 == 0 {
                return color[n];
            }
            lit(code, color[n], red, [scale, offset])
        })
    }
}

impl<'a> Interpolator<'a> {
    /// Returns a component of a stage's coordinates.
    fn component(&self, index: usize, n: usize, sample: &Sample<'a>) -> Interpolant<'a> {
        self.code.by("WGT-1");
        self.coordinate(index, n, sample)
    }

    /// Returns it in single precision.
    fn rounded(&self, index: usize, n: usize, sample: &Sample<'a>) -> Single<'a> {
        Single::rounded(self.code, self.component(index, n, sample))
    }

    fn parts(&self, index: usize, n: usize, sample: &Sample<'a>) -> Binary<Number<'a>> {
        self.component(index, n, sample).parts(self.code, COORDINATE)
    }

    /// TSH-9: returns a coordinate, limited, as a byte.
    pub(crate) fn passed(&self, index: usize, n: usize, sample: &Sample<'a>) -> Number<'a> {
        let parts = self.parts(index, n, sample);
        self.code.by("TSH-9");
        convert::factor(fog::factor(parts)).within(0, 255)
    }

    /// TSH-10: returns whether a coordinate has the sign that is dropped.
    pub(crate) fn drops(&self, index: usize, not_negative: [Truth<'a>; 4], sample: &Sample<'a>) -> Truth<'a> {
        let drops = |n: usize| {
            let parts = self.parts(index, n, sample);
            self.code.by("TSH-10");
            parts.mantissa.is_negative() ^ not_negative[n]
        };
        (0..4).map(drops).fold(Truth::Known(false), |any, one| any | one)
    }

    /// TSH-1 to TSH-4: returns the dot product of a stage's coordinates and a colour.
    fn dot(&self, index: usize, mapping: DotMapping, bytes: [Number<'a>; 4], sample: &Sample<'a>) -> Single<'a> {
        let coordinates = [0, 1, 2].map(|n| self.rounded(index, n, sample));
        self.code.by("TSH-1");
        dot::dot(coordinates, dot::fractions(mapping, bytes).map(Single::fraction))
    }
}

/// TSH-1: returns the byte of a register, which may hold it doubled.
pub(crate) fn byte<'a>(held: Number<'a>, is_doubled: Truth<'a>) -> Number<'a> {
    held.floor_divided(2).low_bits(255).or(is_doubled, held.low_bits(255))
}

/// TSH-7: returns the displacement by a row of the matrix and by blue and green.
pub(crate) fn moved<'a>(entries: [Single<'a>; 2], blue_green: [Number<'a>; 2]) -> Single<'a> {
    let one = Number::Constant(1);
    let signed = blue_green.map(|byte| Single::called(Helper::SingleQuotient, [dot::signed(byte, 8), one]));
    dot::moved(entries, signed)
}

/// TSH-8: returns a channel of a texel that is multiplied by the luminance.
pub(crate) fn lit<'a>(code: &'a Code, channel: Number<'a>, red: Number<'a>, line: [Operand; 2]) -> Number<'a> {
    let v = counted(code, Helper::Luminance, &[channel.operand(), red.operand(), line[0], line[1]]);
    code.by("TSH-8");
    shader::luminance_byte(v).within(0, 255)
}
