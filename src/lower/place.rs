//! Where a unit samples its texture, and what it reads there.

use ninebit::number::{Integer, Register as _};
use ninebit::raster::binary::Binary;
use ninebit::raster::depth;
use ninebit::state::*;
use ninebit::texture::address::{shows_border_color, texel_index};
use ninebit::texture::cube::{Face, major_axis};
use ninebit::texture::filter;
use ninebit::texture::lod::{self, Selection};
use ninebit::texture::planned::PlannedUnit;

use crate::binary::{Called, counted};
use crate::code::{Code, Operand, Operation};
use crate::helper::Helper;
use crate::input::Weight;
use crate::number::{Number, Word};
use crate::texel::{Sampler, Texels};
use crate::triangle::Field;
use crate::truth::Truth;
use crate::whole::{Sample, Whole};

/// The components of coordinates that a unit divides.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Projection {
    /// s and t.
    Plane,
    /// s/q and t/q.
    Ratio,
    /// A direction into a cube map.
    Direction,
}

impl Projection {
    /// Returns the projection of a unit, which all triangles of a draw can take.
    pub(crate) fn new(whole: &Whole<'_, '_>, unit: &PlannedUnit) -> Projection {
        if unit.kind == TextureKind::Cube {
            return Projection::Direction;
        }
        let (assembly, set) = (&whole.planned.assembly, unit.stage.coordinate_set);
        let is_plane = |n: usize| assembly.triangle(n).coordinates(set).iter().all(|vertex| vertex[3] == 1.0);
        if (0..assembly.triangles.len()).all(is_plane) { Projection::Plane } else { Projection::Ratio }
    }
}

/// A unit at a pixel.
pub(crate) struct Unit<'a, 's, 'w> {
    whole: &'w Whole<'a, 's>,
    unit: &'s PlannedUnit,
    projection: Projection,
    sample: &'w Sample<'a>,
    pixel: (Number<'a>, Number<'a>),
}

/// A direction on a face: sc, tc, |ma|.
type OnFace<'a> = [Called<'a>; 3];

/// A face of a cube map.
#[derive(Clone, Copy)]
struct Facing<'a> {
    is_x: Truth<'a>,
    is_y: Truth<'a>,
    negative: Truth<'a>,
}

/// One level as it is read: what the four texels are, and the weights.
struct Footprint<'a> {
    words: [Number<'a>; 4],
    outside: [Truth<'a>; 4],
    weights: [Number<'a>; 2],
}

/// All that a unit reads.
struct Read<'a> {
    levels: Vec<Footprint<'a>>,
    weight: Number<'a>,
}

impl<'a> Texels<'a> for Read<'a> {
    fn word(&self, at: usize) -> Number<'a> {
        self.levels[at / 4].words[at % 4]
    }
    fn outside(&self, at: usize, _: &'a Code) -> Truth<'a> {
        self.levels[at / 4].outside[at % 4]
    }
    fn weight(&self, of: Weight) -> Number<'a> {
        match of {
            Weight::U => self.levels[0].weights[0],
            Weight::V => self.levels[0].weights[1],
            Weight::NextU => self.levels.get(1).map_or(Number::ZERO, |level| level.weights[0]),
            Weight::NextV => self.levels.get(1).map_or(Number::ZERO, |level| level.weights[1]),
            Weight::Level => self.weight,
        }
    }
}

/// The choice of levels: the first, the second, its weight, and whether texels are mixed.
struct Levels<'a> {
    first: Number<'a>,
    next: Number<'a>,
    weight: Number<'a>,
    is_linear: Truth<'a>,
}

impl<'a, 's, 'w> Unit<'a, 's, 'w> {
    pub(crate) fn new(
        whole: &'w Whole<'a, 's>,
        unit: &'s PlannedUnit,
        sample: &'w Sample<'a>,
        pixel: (Number<'a>, Number<'a>),
    ) -> Unit<'a, 's, 'w> {
        Unit { whole, unit, projection: Projection::new(whole, unit), sample, pixel }
    }

    /// Returns the value of the register that the unit loads, and whether the fragment is dropped.
    pub(crate) fn register(&self) -> ([Number<'a>; 4], Truth<'a>) {
        let (code, sampler) = (self.whole.code, Sampler::new(self.unit));
        let facing = (self.projection == Projection::Direction).then(|| self.facing(self.direction(self.sample)));
        let (image, beyond) = self.image(facing);
        let levels = self.levels(&sampler);
        let footprint = |level: Number<'a>| self.footprint(level, levels.is_linear, (image, beyond), facing);
        let first = footprint(levels.first);
        if let Some(shadow) = self.unit.state.shadow {
            let passed = self.compared(shadow, first.words[0]);
            let value = Number::ONE.or(passed, Number::ZERO);
            return (sampler.loaded([value; 4], code), Truth::Known(false));
        }
        let mut read = Read { levels: vec![first], weight: levels.weight };
        if sampler.has_next() {
            read.levels.push(footprint(levels.next));
        }
        let border = self.unit.state.border_color.map(|byte| Number::Constant(byte.into()));
        sampler.register(border, &read, code)
    }

    fn component(&self, sample: &Sample<'a>, n: usize) -> Called<'a> {
        let of = self.whole.linear(|part| Field::Coordinate(self.unit.index, n, part));
        of.at(sample.b)
    }

    fn direction(&self, sample: &Sample<'a>) -> [Called<'a>; 3] {
        [0, 1, 2].map(|n| self.component(sample, n))
    }

    /// TEX-12: returns the face that a direction meets.
    fn facing(&self, direction: [Called<'a>; 3]) -> Facing<'a> {
        let code = self.whole.code;
        code.by("TEX-12");
        let [x, y, z] = direction.map(|n| n.parts(code, (-(1 << 26), 1 << 26)));
        let [is_x, is_y] = major_axis([x.is_no_smaller(y), x.is_no_smaller(z), y.is_no_smaller(z)]);
        let major = x.mantissa.or(is_x, y.mantissa.or(is_y, z.mantissa));
        Facing { is_x, is_y, negative: major.is_negative() }
    }

    /// TEX-12: returns sc, tc and |ma| of a direction on a face.
    fn on_face(&self, direction: [Called<'a>; 3], Facing { is_x, is_y, negative }: Facing<'a>) -> OnFace<'a> {
        let code = self.whole.code;
        code.by("TEX-12");
        let parts = direction.map(|n| n.parts(code, (-(1 << 26), 1 << 26)));
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
            let is_negated = !sign.is_zero();
            let number = number.negated().or(is_negated, number);
            Called::from_line(code, code.make(Operation::Binary(number.mantissa.operand(), number.exponent.operand())))
        })
    }

    /// Returns the first word of the image, and whether it is in the border beyond the layers of a volume.
    fn image(&self, facing: Option<Facing<'a>>) -> (Number<'a>, Truth<'a>) {
        let (_, words) = self.unit.texel_layout();
        let words = Number::Constant(words as i64);
        if let Some(Facing { is_x, is_y, negative }) = facing {
            let axis = Number::ZERO.or(is_x, Number::Constant(2).or(is_y, Number::Constant(4)));
            return ((axis + negative.number()) * words, Truth::Known(false));
        }
        if self.unit.kind != TextureKind::ThreeDimensional {
            return (Number::ZERO, Truth::Known(false));
        }
        let (r, layers) = (self.component(self.sample, 2), Number::Constant(self.unit.layers.into()));
        let w = match self.projection {
            Projection::Ratio => self.ratio(r, self.component(self.sample, 3), layers),
            _ => self.floored(r, layers),
        };
        self.whole.code.by("VOL-1");
        self.addressed(self.unit.state.address_r, filter::nearest(w), layers, false, words)
    }

    /// TEX-7, TEX-8: returns the index that an index addresses times `by`, and whether that is the border colour.
    fn addressed(
        &self,
        mode: AddressMode,
        index: Number<'a>,
        size: Number<'a>,
        border: bool,
        by: Number<'a>,
    ) -> (Number<'a>, Truth<'a>) {
        let outside = if shows_border_color(mode, border) {
            index.is_negative() | !Integer::is_below(index, size)
        } else {
            Truth::Known(false)
        };
        (texel_index(mode, index, size, border) * by, outside)
    }

    fn floored(&self, value: Called<'a>, size: Number<'a>) -> Number<'a> {
        let code = self.whole.code;
        let of = [value.operand(code), size.operand(), Operand::Constant(8), Operand::Constant(1 << 24)];
        counted(code, Helper::Floor, &of)
    }

    fn ratio(&self, s: Called<'a>, q: Called<'a>, size: Number<'a>) -> Number<'a> {
        let code = self.whole.code;
        counted(code, Helper::Ratio, &[s.operand(code), q.operand(code), size.operand()])
    }

    /// Returns u and v on a level in 1/256 texel.
    fn coordinates(&self, sides: [Number<'a>; 2], facing: Option<Facing<'a>>) -> [Number<'a>; 2] {
        let code = self.whole.code;
        let named = |uv: [Number<'a>; 2]| {
            let n = self.unit.index;
            [0, 1].map(|axis: usize| {
                code.name(uv[axis].operand(), || format!("unit{n}_{}", ["u", "v"][axis]));
                uv[axis]
            })
        };
        if let Some(facing) = facing {
            let [s, t, m] = self.on_face(self.direction(self.sample), facing).map(|n| n.operand(code));
            let of = |n: Operand, size: Number<'a>| counted(code, Helper::Face, &[n, m, size.operand()]);
            return named([of(s, sides[0]), of(t, sides[1])]);
        }
        let at = [0, 1].map(|n| self.component(self.sample, n));
        match self.projection {
            Projection::Ratio => {
                let q = self.component(self.sample, 3);
                named([0, 1].map(|n: usize| self.ratio(at[n], q, sides[n])))
            }
            _ => named([0, 1].map(|n: usize| self.floored(at[n], sides[n]))),
        }
    }

    /// TEX-9 to TEX-11: chooses filter and levels.
    fn levels(&self, sampler: &Sampler<'_>) -> Levels<'a> {
        let (unit, code) = (self.unit, self.whole.code);
        let known = Truth::Known(sampler.is_linear());
        if !unit.needs_lod() {
            let is_linear = Truth::Known(unit.state.mag_filter == Filter::Linear);
            return Levels { first: Number::ZERO, next: Number::ZERO, weight: Number::ZERO, is_linear };
        }
        let log = self.log2_ratio();
        code.by("TEX-9");
        let selection = Selection::from_unit(unit);
        let lod = selection.biased(log);
        code.name(lod.operand(), || format!("unit{}_lod", unit.index));
        let magnifies = !Number::ZERO.is_below(lod);
        // A lod that magnifies reads level 0 alone.
        let (first, next, weight) = selection.levels(Integer::greatest(lod, Number::ZERO));
        let is_linear = match (unit.state.mag_filter, unit.state.min_filter) {
            (Filter::Linear, Filter::Nearest) => magnifies,
            (Filter::Nearest, Filter::Linear) => !magnifies,
            _ => known,
        };
        // Where both levels are one, the weight does not count.
        Levels { first, next, weight: Number::ZERO.or(magnifies, weight), is_linear }
    }

    /// TEX-10, TEX-11: returns the lod of the pixel's quad.
    fn log2_ratio(&self) -> Number<'a> {
        let (code, one) = (self.whole.code, Number::Constant(1));
        let (x, y) = (self.pixel.0.masked(4094), self.pixel.1.masked(4094));
        let sides = self.unit.scale(&self.unit.levels[0]).map(|side| Operand::Constant(side.into()));
        let samples = [(x, y), (x + one, y), (x, y + one)].map(|(x, y)| self.whole.sample_at(x, y));
        let facing = (self.projection == Projection::Direction).then(|| self.facing(self.direction(&samples[0])));
        let mut behind = Truth::Known(false);
        let is_positive = |n: Called<'a>| Number::ZERO.is_below(n.parts(code, crate::code::MANTISSA).mantissa);
        let quad = samples.map(|sample| {
            code.by("TEX-11");
            behind = behind | !is_positive(sample.sum);
            let (divisor, at) = match facing {
                Some(facing) => {
                    let [s, t, m] = self.on_face(self.direction(&sample), facing);
                    (Some(m), [s, t])
                }
                None => {
                    let q = (self.projection == Projection::Ratio).then(|| self.component(&sample, 3));
                    (q, [0, 1].map(|n| self.component(&sample, n)))
                }
            };
            if let Some(divisor) = divisor {
                behind = behind | !is_positive(divisor);
            }
            [0, 1].map(|n: usize| {
                let at = at[n].operand(code);
                match divisor.map(|divisor| divisor.operand(code)) {
                    None => {
                        let limit = Operand::Constant(ninebit::raster::interpolate::FARTHEST);
                        counted(code, Helper::FarFloor, &[at, sides[n], Operand::Constant(16), limit])
                    }
                    Some(m) if facing.is_some() => counted(code, Helper::FarFace, &[at, m, sides[n]]),
                    Some(q) => counted(code, Helper::FarRatio, &[at, q, sides[n]]),
                }
            })
        });
        let [[a, b], [c, d], [e, f]] = quad.map(|at| at.map(Number::operand));
        let log = counted(code, Helper::Level, &[a, b, c, d, e, f]);
        Number::Constant(lod::LEAST.into()).or(behind, log)
    }

    /// Returns the number that a level has, of those of all levels.
    fn by_level(&self, level: Number<'a>, of: impl Fn(usize) -> i64) -> Number<'a> {
        let (first, last) = (of(0), self.unit.levels.len() - 1);
        let halves = |n: usize| (first >> n).max(1);
        if (0..=last).all(|n| of(n) == halves(n)) {
            return Integer::greatest(Number::Constant(first).down(level), Number::Constant(1));
        }
        (0..last).rev().fold(Number::Constant(of(last)), |others, n| {
            Number::Constant(of(n)).or(level.is_below(Number::Constant(n as i64 + 1)), others)
        })
    }

    /// Returns what is read on a level.
    fn footprint(
        &self,
        level: Number<'a>,
        is_linear: Truth<'a>,
        (image, beyond): (Number<'a>, Truth<'a>),
        facing: Option<Facing<'a>>,
    ) -> Footprint<'a> {
        let (unit, code) = (self.unit, self.whole.code);
        let level = level.within(0, unit.levels.len() as i64 - 1);
        let (offsets, _) = unit.texel_layout();
        let width = self.by_level(level, |n| unit.levels[n].width.into());
        let height = self.by_level(level, |n| unit.levels[n].height.into());
        let first = image + self.by_level(level, |n| offsets[n] as i64);
        let sides = if unit.kind == TextureKind::Rectangle { [Number::Constant(1); 2] } else { [width, height] };
        let [u, v] = self.coordinates(sides, facing);
        code.by("TEX-6");
        let axis = |at: Number<'a>, mode: AddressMode, size: Number<'a>| {
            // A single texel is that of a footprint half a texel further, with weights 0.
            let half = Number::ZERO.or(is_linear, Number::Constant(128));
            let (texel, weight) = filter::split(at + half);
            let weight = weight.or(is_linear, Number::ZERO);
            let one = Number::Constant(1);
            code.by("TEX-8");
            let both = [texel, texel + one].map(|index| self.addressed(mode, index, size, unit.border, one));
            (both, weight)
        };
        let [mode_s, mode_t] = unit.modes();
        let ([(x0, left), (x1, right)], weight_u) = axis(u, mode_s, width);
        let ([(y0, upper), (y1, lower)], weight_v) = axis(v, mode_t, height);
        for (value, name) in [(weight_u, "u"), (weight_v, "v")] {
            code.name(value.operand(), || format!("unit{}_weight_{name}", unit.index));
        }
        let at = |x: Number<'a>, y: Number<'a>| {
            let offset = first + unit.texel_offset(width, x, y);
            Number::new(code, code.make(Operation::Fetch(unit.index, offset.operand())))
        };
        Footprint {
            words: [at(x0, y0), at(x1, y0), at(x0, y1), at(x1, y1)],
            outside: [left | upper, right | upper, left | lower, right | lower].map(|outside| outside | beyond),
            weights: [weight_u, weight_v],
        }
    }

    /// SHD-1: returns whether the reference passes the comparison with a texel.
    fn compared(&self, shadow: ShadowComparison, word: Number<'a>) -> Truth<'a> {
        let code = self.whole.code;
        let zero = Binary::whole(Number::ZERO);
        let reference = match shadow.reference {
            ShadowReference::Zero => zero,
            ShadowReference::R => {
                let parts = |n: usize| self.component(self.sample, n).parts(code, (-(1 << 26), 1 << 26));
                code.by("SHD-1");
                if self.projection == Projection::Ratio { parts(2).positive_ratio(parts(3)) } else { parts(2) }
            }
        };
        let format = self.unit.format.depth().unwrap_or(DepthFormat::Z16);
        let reference = depth::stored(format, reference);
        let stored = (Word(word) & Word::from(0x00ff_ffff)).number();
        Integer::compared(reference, shadow.function, stored)
    }
}
