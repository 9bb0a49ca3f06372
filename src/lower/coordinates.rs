//! The coordinates at which a unit samples.

use ninebit::number::{Integer, Register as _};
use ninebit::raster::binary::Binary;
use ninebit::raster::interpolate::FARTHEST;
use ninebit::raster::stroke::Figure;
use ninebit::state::*;
use ninebit::texture::anisotropy::{MAX_PAIRS, Pairs, pairs};
use ninebit::texture::cube::{Face, major_axis};
use ninebit::texture::other_kind::{ZERO_VECTOR, end_of_face, on_face, on_plane};
use ninebit::texture::planned::PlannedUnit;
use ninebit::texture::{lod, shader};

use crate::binary::{Interpolant, call, counted};
use crate::code::{COORDINATE, Code, Operand, Operation};
use crate::helper::Helper;
use crate::input::Input;
use crate::number::Number;
use crate::place::{Place, Projection, Unit};
use crate::triangle::{Field, name_of};
use crate::truth::Truth;
use crate::whole::{Sample, Whole};

/// A face of a cube map.
#[derive(Clone, Copy)]
pub(crate) struct Facing<'a> {
    pub(crate) is_x: Truth<'a>,
    pub(crate) is_y: Truth<'a>,
    pub(crate) negative: Truth<'a>,
}

impl<'a> Facing<'a> {
    /// Returns the number of the face.
    pub(crate) fn number(self) -> Number<'a> {
        let axis = Number::ZERO.or(self.is_x, Number::Constant(2).or(self.is_y, Number::Constant(4)));
        axis + self.negative.number()
    }
}

/// A direction on a face: sc, tc, |ma|.
pub(crate) type OnFace<'a> = [Interpolant<'a>; 3];

impl<'a> Unit<'a, '_, '_> {
    pub(crate) fn component(&self, sample: &Sample<'a>, n: usize) -> Interpolant<'a> {
        self.interpolator.coordinate(self.unit.index, n, sample)
    }

    /// Returns the direction that a unit samples in.
    pub(crate) fn direction(&self, place: Place<'a>, sample: &Sample<'a>) -> Option<[Interpolant<'a>; 3]> {
        match place {
            Place::Own(Projection::Direction) => Some([0, 1, 2].map(|n| self.component(sample, n))),
            Place::Vector(vector) => Some(vector),
            _ => None,
        }
    }

    /// TEX-12: returns the face that a direction meets.
    pub(crate) fn facing(&self, direction: [Interpolant<'a>; 3]) -> Facing<'a> {
        let code = self.interpolator.code;
        code.by("TEX-12");
        let [x, y, z] = direction.map(|n| n.parts(code, COORDINATE));
        let [is_x, is_y] = major_axis([x.is_no_smaller(y), x.is_no_smaller(z), y.is_no_smaller(z)]);
        let major = x.mantissa.or(is_x, y.mantissa.or(is_y, z.mantissa));
        Facing { is_x, is_y, negative: major.is_negative() }
    }

    /// TEX-12: returns sc, tc and |ma| of a direction on a face.
    pub(crate) fn on_face(&self, direction: [Interpolant<'a>; 3], facing: Facing<'a>) -> OnFace<'a> {
        let Facing { is_x, is_y, negative } = facing;
        let code = self.interpolator.code;
        code.by("TEX-12");
        let parts = direction.map(|n| n.parts(code, COORDINATE));
        [0, 1, 2].map(|n: usize| {
            // Both faces of an axis take the same axes.
            let of = |axis: usize| {
                let [positive, other] = [0, 1].map(|side| Face::ALL[2 * axis + side].components()[n]);
                let sign = if positive.negative == other.negative {
                    Truth::Known(positive.negative)
                } else {
                    negative ^ Truth::Known(positive.negative)
                };
                (parts[positive.axis], sign.number())
            };
            let ((x, of_x), (y, of_y), (z, of_z)) = (of(0), of(1), of(2));
            let number = x.or(is_x, y.or(is_y, z));
            let sign = of_x.or(is_x, of_y.or(is_y, of_z));
            number_of(code, number.negated().or(!sign.is_zero(), number))
        })
    }

    /// Returns sc, tc and |ma| where a unit samples in a direction.
    fn face_of(&self, facing: Option<Facing<'a>>) -> Option<OnFace<'a>> {
        match (self.place, facing) {
            (Place::OnFace(face), _) => Some(face),
            (_, Some(facing)) => Some(self.on_face(self.direction(self.place, self.sample)?, facing)),
            _ => None,
        }
    }

    /// TEX-12, TEX-20: returns u and v of sc, tc and |ma| in 2^-`power` texel.
    fn of_face(&self, [s, t, m]: OnFace<'a>, sides: [Number<'a>; 2], power: i64) -> [Number<'a>; 2] {
        let (code, is_plane) = (self.interpolator.code, self.unit.kind != TextureKind::Cube);
        let helper = if power == 8 { Helper::Face } else { Helper::FarFace };
        let (at, m) = ([s, self.turned(t, is_plane)], m.operand(code));
        [0, 1].map(|n: usize| {
            let side = sides[n];
            let size = if is_plane { side + side } else { side };
            let at = counted(code, helper, &[divided(code, at[n], m), m, size.operand()]);
            code.by("TEX-20");
            if is_plane { on_plane(at, side, power) } else { at }
        })
    }

    pub(crate) fn floored(&self, value: Interpolant<'a>, size: Number<'a>) -> Number<'a> {
        let code = self.interpolator.code;
        let of = [value.operand(code), size.operand(), Operand::Constant(8), Operand::Constant(1 << 24)];
        counted(code, Helper::Floor, &of)
    }

    pub(crate) fn ratio(&self, s: Interpolant<'a>, q: Interpolant<'a>, size: Number<'a>) -> Number<'a> {
        let code = self.interpolator.code;
        let q = q.operand(code);
        counted(code, Helper::Ratio, &[divided(code, s, q), q, size.operand()])
    }

    /// Returns u and v on a level in 1/256 texel.
    pub(crate) fn coordinates(&self, sides: [Number<'a>; 2], facing: Option<Facing<'a>>) -> [Number<'a>; 2] {
        let code = self.interpolator.code;
        let named = |uv: [Number<'a>; 2]| {
            let n = self.unit.index;
            [0, 1].map(|axis: usize| {
                code.name(uv[axis].operand(), || name_of(n, ["u", "v"][axis]));
                uv[axis]
            })
        };
        let (place, sample) = (self.place, self.sample);
        if let Some(face) = self.face_of(facing) {
            let uv = self.of_face(face, sides, 8);
            if self.unit.kind == TextureKind::Cube {
                return named(uv);
            }
            let is_zero = !is_positive(code, face[2]);
            return named([0, 1].map(|n: usize| Number::Constant(ZERO_VECTOR[n]).or(is_zero, uv[n])));
        }
        let is_on_face = self.unit.is_on_face();
        let at = |n: usize| self.turned(self.component(sample, n), is_on_face && n == 1);
        let own = |n: usize| match place {
            Place::Own(Projection::Ratio) => self.ratio(at(n), self.component(sample, 3), sides[n]),
            Place::Moved(offsets) => self.moved(at(n), offsets[n], sides[n].operand(), (8, 1 << 24)),
            Place::Bytes(bytes, scale) => {
                code.by("TSH-6");
                shader::dependent(bytes[n], sides[n], scale)
            }
            Place::Floats(floats) => counted(code, Helper::Float, &[floats[n].operand(), sides[n].operand()]),
            Place::Ends(dots) => self.end(n, dots[n], sides[n], 8),
            Place::Own(_) | Place::Vector(_) | Place::OnFace(_) => self.floored(at(n), sides[n]),
        };
        if is_on_face {
            let uv = [0, 1].map(own);
            code.by("TEX-20");
            return named(uv.map(|u| on_face(u, sides[0], 8)));
        }
        let pixel = [Input::X, Input::Y].map(|input| self.interpolator.input(input));
        let sides = sides.map(Number::operand);
        named([0, 1].map(|n: usize| self.of_figure((n, pixel[n]), (sides[n], 8), || own(n))))
    }

    /// Returns a number, or its negative.
    fn turned(&self, number: Interpolant<'a>, is_turned: bool) -> Interpolant<'a> {
        if !is_turned {
            return number;
        }
        let code = self.interpolator.code;
        number_of(code, number.parts(code, COORDINATE).negated())
    }

    /// TEX-20: returns the end of a face that a dot product, a pattern of binary32, chooses along an axis, in 2^-`power` texel.
    fn end(&self, axis: usize, dot: Number<'a>, side: Number<'a>, power: i64) -> Number<'a> {
        self.interpolator.code.by("TEX-20");
        end_of_face(axis, dot, side, power)
    }

    /// Returns a coordinate in a point at a column or a row, or what else a figure has, in 2^-`power` texel.
    fn of_figure(
        &self,
        (axis, pixel): (usize, Number<'a>),
        (side, power): (Operand, i64),
        other: impl FnOnce() -> Number<'a>,
    ) -> Number<'a> {
        match self.is_point {
            Truth::Known(false) => other(),
            // Only points are drawn, or some other figures too.
            Truth::Known(true) => self.of_point(axis, pixel, side, power),
            is_point => self.of_point(axis, pixel, side, power).or(is_point, other()),
        }
    }

    /// PNT-2: returns a coordinate in a point at a column or a row, in 2^-`power` texel.
    fn of_point(&self, axis: usize, pixel: Number<'a>, side: Operand, power: i64) -> Number<'a> {
        let (code, field) = (self.interpolator.code, |field| self.interpolator.input(Input::Triangle(field)));
        code.by("PNT-2");
        let distance = pixel * Number::Constant(16) + Number::Constant(8) - field(Field::Sprite(axis));
        let size = Number::greatest(field(Field::SpriteSize), Number::ZERO);
        let of = [distance.operand(), size.operand(), side, Operand::Constant(power)];
        counted(code, Helper::Sprite, &of)
    }

    /// TSH-7: returns a coordinate that is displaced, in 2^-`power` texel.
    fn moved(
        &self,
        value: Interpolant<'a>,
        offset: Number<'a>,
        side: Operand,
        (power, limit): (i64, i64),
    ) -> Number<'a> {
        let code = self.interpolator.code;
        let of = [value.operand(code), offset.operand(), side, Operand::Constant(power), Operand::Constant(limit)];
        counted(code, Helper::Moved, &of)
    }

    /// TEX-11: returns u and v of the quad's pixels in 1/65536 texel of level 0, and whether one of them lies behind the viewer.
    pub(crate) fn coordinates_of_quad(&self) -> ([[Number<'a>; 2]; 3], Truth<'a>) {
        let one = Number::Constant(1);
        let [x, y] = self.quad;
        let sides = self.unit.scale(&self.unit.levels[0]).map(|side| Number::Constant(side.into()));
        let pixels = [[x, y], [x + one, y], [x, y + one]];
        let samples = pixels.map(|[x, y]| self.interpolator.sample_at(x, y));
        let places = samples.each_ref().map(|sample| (self.elsewhere)(sample));
        let facing = self.direction(places[0], &samples[0]).map(|direction| self.facing(direction));
        let mut behind = Truth::Known(false);
        let quad = [0, 1, 2].map(|n: usize| {
            let at = Unit { sample: &samples[n], place: places[n], ..*self };
            let (uv, is_behind) = at.far_coordinates(pixels[n], sides, facing);
            behind = behind | is_behind;
            uv
        });
        (quad, behind)
    }

    /// TEX-11: returns u and v of a quad's pixel in 1/65536 texel of level 0, and whether it lies behind the viewer.
    pub(crate) fn far_coordinates(
        &self,
        pixel: [Number<'a>; 2],
        sides: [Number<'a>; 2],
        facing: Option<Facing<'a>>,
    ) -> ([Number<'a>; 2], Truth<'a>) {
        let (code, sample, place) = (self.interpolator.code, self.sample, self.place);
        let (lengths, sides) = (sides, sides.map(Number::operand));
        code.by("TEX-11");
        let mut behind = !is_positive(code, sample.sum);
        if let Some(face) = self.face_of(facing) {
            behind = behind | !is_positive(code, face[2]);
            return (self.of_face(face, lengths, 16), behind);
        }
        let q = (matches!(place, Place::Own(Projection::Ratio))).then(|| self.component(sample, 3));
        if let Some(q) = q {
            behind = behind | (!is_positive(code, q) & !self.is_point);
        }
        let is_on_face = self.unit.is_on_face();
        let at = |n: usize| self.turned(self.component(sample, n), is_on_face && n == 1);
        let own = |n: usize| match (place, q) {
            (_, Some(q)) => far_floored(code, divided(code, at(n), q.operand(code)), sides[n]),
            (Place::Moved(offsets), _) => self.moved(at(n), offsets[n], sides[n], (16, FARTHEST)),
            (Place::Bytes(bytes, scale), _) => {
                code.by("TSH-6");
                shader::dependent(bytes[n], Number::new(code, sides[n]).up(Number::Constant(8)), scale)
            }
            (Place::Floats(floats), _) => counted(code, Helper::FarFloat, &[floats[n].operand(), sides[n]]),
            (Place::Ends(dots), _) => self.end(n, dots[n], lengths[n], 16),
            (Place::Own(_) | Place::Vector(_) | Place::OnFace(_), _) => {
                far_floored(code, at(n).operand(code), sides[n])
            }
        };
        if is_on_face {
            let uv = [0, 1].map(own);
            code.by("TEX-20");
            return (uv.map(|u| on_face(u, lengths[0], 16)), behind);
        }
        ([0, 1].map(|n: usize| self.of_figure((n, pixel[n]), (sides[n], 16), || own(n))), behind)
    }
}

/// Returns a number of these parts.
fn number_of<'a>(code: &'a Code, Binary { mantissa, exponent }: Binary<Number<'a>>) -> Interpolant<'a> {
    Interpolant::from_line(code, code.make(Operation::Binary(mantissa.operand(), exponent.operand())))
}

/// Returns whether a number is positive.
fn is_positive<'a>(code: &'a Code, number: Interpolant<'a>) -> Truth<'a> {
    Number::ZERO.is_below(number.parts(code, crate::code::MANTISSA).mantissa)
}

/// TEX-15: returns the quotient of a number by another.
fn divided(code: &Code, s: Interpolant<'_>, q: Operand) -> Operand {
    call(code, Helper::Quotient, &[s.operand(code), q])
}

/// TEX-11: returns a coordinate in 1/65536 texel.
fn far_floored<'a>(code: &'a Code, number: Operand, side: Operand) -> Number<'a> {
    counted(code, Helper::FarFloor, &[number, side, Operand::Constant(16), Operand::Constant(FARTHEST)])
}

/// TEX-10, TEX-11: returns the lod of a quad, of which a pixel may lie behind the viewer.
pub(crate) fn log2_ratio<'a>(code: &'a Code, quad: [[Number<'a>; 2]; 3], behind: Truth<'a>) -> Number<'a> {
    let of: Vec<Operand> = quad.as_flattened().iter().map(|n| n.operand()).collect();
    Number::Constant(lod::LEAST.into()).or(behind, counted(code, Helper::Level, &of))
}

/// TEX-17: returns the pairs of taps of a quad: offset and weight.
pub(crate) fn pairs_of_quad<'a>(
    quad: [[Number<'a>; 2]; 3],
    behind: Truth<'a>,
    limit: Number<'a>,
) -> [([Number<'a>; 2], Number<'a>); MAX_PAIRS] {
    let Pairs { offsets, weights, .. } = pairs(quad, limit);
    [0, 1, 2, 3].map(|pair: usize| {
        let weight = Number::Constant(if pair == 0 { 128 } else { 0 }).or(behind, weights[pair]).within(0, 128);
        (offsets[pair].map(|offset| Number::ZERO.or(behind, offset).within(-(1 << 22), 1 << 22)), weight)
    })
}

/// Returns whether the figures of a draw are points that give a unit coordinates.
pub(crate) fn is_point<'a>(whole: &Whole<'a, '_>, unit: &PlannedUnit) -> Truth<'a> {
    let draw = whole.planned;
    if !(draw.point_sprite && unit.index == SPRITE_UNIT) {
        return Truth::Known(false);
    }
    let triangles = &draw.assembly.triangles;
    let is_point = |n: usize| triangles.figure(n) == Figure::Point;
    match ((0..triangles.len()).any(is_point), (0..triangles.len()).all(is_point)) {
        (false, _) => Truth::Known(false),
        (true, true) => Truth::Known(true),
        (true, false) => !whole.input(Input::Triangle(Field::SpriteSize)).is_negative(),
    }
}
