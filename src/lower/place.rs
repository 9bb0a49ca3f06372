//! Where a unit samples its texture, and what it reads there.

use ninebit::number::{Blend as _, Integer, Register as _};
use ninebit::raster::binary::Binary;
use ninebit::raster::depth;
use ninebit::raster::interpolate::FARTHEST;
use ninebit::raster::stroke::Figure;
use ninebit::state::*;
use ninebit::texture::address::{shows_border_color, texel_index};
use ninebit::texture::anisotropy::{MAX_PAIRS, Pairs, pairs};
use ninebit::texture::cube::{Face, major_axis};
use ninebit::texture::filter;
use ninebit::texture::lod::{self, Selection};
use ninebit::texture::planned::PlannedUnit;
use ninebit::texture::shader;

use crate::binary::{Called, counted};
use crate::code::{Code, Operand, Operation};
use crate::helper::Helper;
use crate::input::{Input, Weight};
use crate::number::{Number, Word};
use crate::texel::{Sampler, Texels};
use crate::triangle::{Field, name_of};
use crate::truth::Truth;
use crate::whole::{Interpolator, Sample, Whole};

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

/// The coordinates at which a unit samples.
#[derive(Clone, Copy)]
pub(crate) enum Place<'a> {
    /// Its own.
    Own(Projection),
    /// Its own s and t, displaced by 128ths of the image, patterns of binary32 (TSH-7).
    Moved([Number<'a>; 2]),
    /// Two bytes (TSH-6).
    Bytes([Number<'a>; 2], DependentScale),
    /// Two results of the dot unit, patterns of binary32 (TSH-4).
    Floats([Number<'a>; 2]),
    /// A direction that the dot unit computed (TSH-4, TSH-5).
    Vector([Called<'a>; 3]),
}

/// A unit at a pixel.
#[derive(Clone, Copy)]
pub(crate) struct Unit<'a, 's, 'w> {
    pub(crate) interpolator: Interpolator<'a>,
    pub(crate) unit: &'s PlannedUnit,
    pub(crate) sample: &'w Sample<'a>,
    pub(crate) place: Place<'a>,
    /// Whether the figure is a point that gives the unit coordinates.
    pub(crate) is_point: Truth<'a>,
    /// The first pixel of the quad.
    pub(crate) quad: [Number<'a>; 2],
    /// Returns the coordinates at another sample.
    pub(crate) elsewhere: &'w dyn Fn(&Sample<'a>) -> Place<'a>,
}

/// A direction on a face: sc, tc, |ma|.
type OnFace<'a> = [Called<'a>; 3];

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
    /// Returns a unit that samples where `elsewhere` says.
    pub(crate) fn new(
        whole: &'w Whole<'a, 's>,
        unit: &'s PlannedUnit,
        sample: &'w Sample<'a>,
        quad: [Number<'a>; 2],
        elsewhere: &'w dyn Fn(&Sample<'a>) -> Place<'a>,
    ) -> Unit<'a, 's, 'w> {
        Unit::at(whole, unit, (sample, elsewhere(sample)), quad, elsewhere)
    }

    /// Returns a unit whose place at a sample is known.
    pub(crate) fn at(
        whole: &'w Whole<'a, 's>,
        unit: &'s PlannedUnit,
        (sample, place): (&'w Sample<'a>, Place<'a>),
        quad: [Number<'a>; 2],
        elsewhere: &'w dyn Fn(&Sample<'a>) -> Place<'a>,
    ) -> Unit<'a, 's, 'w> {
        let is_point = is_point(whole, unit);
        Unit { interpolator: whole.interpolator, unit, sample, place, is_point, quad, elsewhere }
    }

    /// Returns the value of the register that the unit loads, and whether the fragment is dropped.
    pub(crate) fn register(&self) -> ([Number<'a>; 4], Truth<'a>) {
        let (code, sampler) = (self.interpolator.code, Sampler::new(self.unit));
        let facing = self.direction(self.place, self.sample).map(|direction| self.facing(direction));
        let (image, beyond) = self.image(facing);
        if self.unit.state.anisotropy > 1 {
            return (sampler.loaded(self.taps(&sampler, (image, beyond)), code), Truth::Known(false));
        }
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
        sampler.register(self.border(), &read, code)
    }

    fn border(&self) -> [Number<'a>; 4] {
        self.unit.state.border_color.map(|byte| Number::Constant(byte.into()))
    }

    /// TEX-17: filters each tap of a footprint on level 0, and returns the lanes of their weighted sum.
    fn taps(&self, sampler: &Sampler<'_>, image: (Number<'a>, Truth<'a>)) -> [Number<'a>; 4] {
        let (code, limit) = (self.interpolator.code, self.unit.state.anisotropy);
        let (quad, behind) = self.coordinates_of_quad();
        code.by("TEX-17");
        let pairs = pairs_of_quad(quad, behind, Number::Constant(limit.into()));
        let sides = self.unit.scale(&self.unit.levels[0]);
        let at = self.coordinates(sides.map(|side| Number::Constant(side.into())), None);
        let is_linear = Truth::Known(sampler.is_linear());
        let mut sum = [Number::ZERO; 4];
        for (offset, weight) in pairs.into_iter().take(limit as usize / 2) {
            for tap in [[at[0] + offset[0], at[1] + offset[1]], [at[0] - offset[0], at[1] - offset[1]]] {
                let footprint = self.footprint_at(Number::ZERO, is_linear, image, tap);
                let read = Read { levels: vec![footprint], weight: Number::ZERO };
                let lanes = sampler.filtered(0, self.border(), &read, code);
                code.by("TEX-17");
                sum = [0, 1, 2, 3].map(|lane: usize| sum[lane] + lanes[lane].times(weight));
            }
        }
        sum.map(|lane| lane.round8().within(-(1 << 15), (1 << 16) - 1))
    }

    fn component(&self, sample: &Sample<'a>, n: usize) -> Called<'a> {
        let of = self.interpolator.linear(|part| Field::Coordinate(self.unit.index, n, part));
        of.at(sample.b)
    }

    /// Returns the direction into a cube map.
    pub(crate) fn direction(&self, place: Place<'a>, sample: &Sample<'a>) -> Option<[Called<'a>; 3]> {
        match place {
            Place::Own(Projection::Direction) => Some([0, 1, 2].map(|n| self.component(sample, n))),
            Place::Vector(vector) => Some(vector),
            _ => None,
        }
    }

    /// TEX-12: returns the face that a direction meets.
    pub(crate) fn facing(&self, direction: [Called<'a>; 3]) -> Facing<'a> {
        let code = self.interpolator.code;
        code.by("TEX-12");
        let [x, y, z] = direction.map(|n| n.parts(code, (-(1 << 26), 1 << 26)));
        let [is_x, is_y] = major_axis([x.is_no_smaller(y), x.is_no_smaller(z), y.is_no_smaller(z)]);
        let major = x.mantissa.or(is_x, y.mantissa.or(is_y, z.mantissa));
        Facing { is_x, is_y, negative: major.is_negative() }
    }

    /// TEX-12: returns sc, tc and |ma| of a direction on a face.
    fn on_face(&self, direction: [Called<'a>; 3], facing: Facing<'a>) -> OnFace<'a> {
        let Facing { is_x, is_y, negative } = facing;
        let code = self.interpolator.code;
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
        if let Some(facing) = facing {
            return (facing.number() * words, Truth::Known(false));
        }
        if self.unit.kind != TextureKind::ThreeDimensional {
            return (Number::ZERO, Truth::Known(false));
        }
        self.layer(Number::Constant(self.unit.layers.into()), words)
    }

    /// VOL-1: returns the layer of a volume times `by`, and whether it is in the border beyond.
    pub(crate) fn layer(&self, layers: Number<'a>, by: Number<'a>) -> (Number<'a>, Truth<'a>) {
        let r = self.component(self.sample, 2);
        let w = match self.place {
            Place::Own(Projection::Ratio) => self.ratio(r, self.component(self.sample, 3), layers),
            Place::Own(_) => self.floored(r, layers),
            _ => Number::ZERO,
        };
        self.interpolator.code.by("VOL-1");
        self.addressed(self.unit.state.address_r, filter::nearest(w), layers, false, by)
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
        let code = self.interpolator.code;
        let of = [value.operand(code), size.operand(), Operand::Constant(8), Operand::Constant(1 << 24)];
        counted(code, Helper::Floor, &of)
    }

    fn ratio(&self, s: Called<'a>, q: Called<'a>, size: Number<'a>) -> Number<'a> {
        let code = self.interpolator.code;
        counted(code, Helper::Ratio, &[s.operand(code), q.operand(code), size.operand()])
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
        if let (Some(facing), Some(direction)) = (facing, self.direction(place, sample)) {
            let [s, t, m] = self.on_face(direction, facing).map(|n| n.operand(code));
            let of = |n: Operand, size: Number<'a>| counted(code, Helper::Face, &[n, m, size.operand()]);
            return named([of(s, sides[0]), of(t, sides[1])]);
        }
        let at = |n: usize| self.component(sample, n);
        let own = |n: usize| match place {
            Place::Own(Projection::Ratio) => self.ratio(at(n), self.component(sample, 3), sides[n]),
            Place::Moved(offsets) => self.moved(at(n), offsets[n], sides[n].operand(), (8, 1 << 24)),
            Place::Bytes(bytes, scale) => {
                code.by("TSH-6");
                shader::dependent(bytes[n], sides[n], scale)
            }
            Place::Floats(floats) => counted(code, Helper::Float, &[floats[n].operand(), sides[n].operand()]),
            Place::Own(_) | Place::Vector(_) => self.floored(at(n), sides[n]),
        };
        let pixel = [Input::X, Input::Y].map(|input| self.interpolator.input(input));
        let sides = sides.map(Number::operand);
        named([0, 1].map(|n: usize| self.of_figure((n, pixel[n]), (sides[n], 8), || own(n))))
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
    fn moved(&self, value: Called<'a>, offset: Number<'a>, side: Operand, (power, limit): (i64, i64)) -> Number<'a> {
        let code = self.interpolator.code;
        let of = [value.operand(code), offset.operand(), side, Operand::Constant(power), Operand::Constant(limit)];
        counted(code, Helper::Moved, &of)
    }

    /// TEX-9 to TEX-11: chooses filter and levels.
    fn levels(&self, sampler: &Sampler<'_>) -> Levels<'a> {
        let (unit, code) = (self.unit, self.interpolator.code);
        let known = Truth::Known(sampler.is_linear());
        if !unit.needs_lod() {
            let is_linear = Truth::Known(unit.state.mag_filter == Filter::Linear);
            return Levels { first: Number::ZERO, next: Number::ZERO, weight: Number::ZERO, is_linear };
        }
        let (quad, behind) = self.coordinates_of_quad();
        let log = log2_ratio(code, quad, behind);
        let state = &unit.state;
        let of = |n: i32| Number::Constant(n.into());
        let limits = [state.lod_bias, state.min_lod, state.max_lod].map(of);
        let selection = Selection::new(state.mip_filter, of(unit.levels.len() as i32 - 1), limits);
        let (first, next, weight, magnifies) = self.chosen(selection, log);
        let is_linear = match (unit.state.mag_filter, unit.state.min_filter) {
            (Filter::Linear, Filter::Nearest) => magnifies,
            (Filter::Nearest, Filter::Linear) => !magnifies,
            _ => known,
        };
        Levels { first, next, weight, is_linear }
    }

    /// TEX-9: returns both levels, the weight of the second, and whether the image is magnified.
    pub(crate) fn chosen(
        &self,
        selection: Selection<Number<'a>>,
        log: Number<'a>,
    ) -> (Number<'a>, Number<'a>, Number<'a>, Truth<'a>) {
        let code = self.interpolator.code;
        code.by("TEX-9");
        let lod = selection.biased(log);
        code.name(lod.operand(), || name_of(self.unit.index, "lod"));
        let magnifies = !Number::ZERO.is_below(lod);
        // A lod that magnifies reads level 0 alone.
        let (first, next, weight) = selection.levels(Integer::greatest(lod, Number::ZERO));
        // Where both levels are one, the weight does not count.
        (first, next, Number::ZERO.or(magnifies, weight), magnifies)
    }

    /// TEX-11: returns u and v of the quad's pixels in 1/65536 texel of level 0, and whether one of them lies behind the viewer.
    fn coordinates_of_quad(&self) -> ([[Number<'a>; 2]; 3], Truth<'a>) {
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
        let sides = sides.map(Number::operand);
        let is_positive = |n: Called<'a>| Number::ZERO.is_below(n.parts(code, crate::code::MANTISSA).mantissa);
        code.by("TEX-11");
        let mut behind = !is_positive(sample.sum);
        if let (Some(facing), Some(direction)) = (facing, self.direction(place, sample)) {
            let [s, t, m] = self.on_face(direction, facing);
            behind = behind | !is_positive(m);
            let at = [s, t].map(|n| n.operand(code));
            let of = |n: usize| counted(code, Helper::FarFace, &[at[n], m.operand(code), sides[n]]);
            return ([0, 1].map(of), behind);
        }
        let q = (matches!(place, Place::Own(Projection::Ratio))).then(|| self.component(sample, 3));
        if let Some(q) = q {
            behind = behind | (!is_positive(q) & !self.is_point);
        }
        let at = |n: usize| self.component(sample, n);
        let own = |n: usize| match (place, q) {
            (_, Some(q)) => counted(code, Helper::FarRatio, &[at(n).operand(code), q.operand(code), sides[n]]),
            (Place::Moved(offsets), _) => self.moved(at(n), offsets[n], sides[n], (16, FARTHEST)),
            (Place::Bytes(bytes, scale), _) => {
                code.by("TSH-6");
                shader::dependent(bytes[n], Number::new(code, sides[n]).up(Number::Constant(8)), scale)
            }
            (Place::Floats(floats), _) => counted(code, Helper::FarFloat, &[floats[n].operand(), sides[n]]),
            (Place::Own(_) | Place::Vector(_), _) => {
                let limit = Operand::Constant(FARTHEST);
                counted(code, Helper::FarFloor, &[at(n).operand(code), sides[n], Operand::Constant(16), limit])
            }
        };
        ([0, 1].map(|n: usize| self.of_figure((n, pixel[n]), (sides[n], 16), || own(n))), behind)
    }

    /// Returns the number that a level has, of those of all levels.
    fn by_level(&self, level: Number<'a>, of: impl Fn(usize) -> i64) -> Number<'a> {
        let (first, last) = (of(0), self.unit.levels.len() - 1);
        let halves = |n: usize| (first >> n).max(1);
        if (0..=last).all(|n| of(n) == halves(n)) {
            return side(Number::Constant(first), level);
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
        image: (Number<'a>, Truth<'a>),
        facing: Option<Facing<'a>>,
    ) -> Footprint<'a> {
        let unit = self.unit;
        let level = level.within(0, unit.levels.len() as i64 - 1);
        let width = self.by_level(level, |n| unit.levels[n].width.into());
        let height = self.by_level(level, |n| unit.levels[n].height.into());
        let sides = if unit.kind == TextureKind::Rectangle { [Number::Constant(1); 2] } else { [width, height] };
        self.footprint_at(level, is_linear, image, self.coordinates(sides, facing))
    }

    /// Returns what is read on a level at u and v.
    fn footprint_at(
        &self,
        level: Number<'a>,
        is_linear: Truth<'a>,
        (image, beyond): (Number<'a>, Truth<'a>),
        [u, v]: [Number<'a>; 2],
    ) -> Footprint<'a> {
        let (unit, code) = (self.unit, self.interpolator.code);
        let (offsets, _) = unit.texel_layout();
        let width = self.by_level(level, |n| unit.levels[n].width.into());
        let height = self.by_level(level, |n| unit.levels[n].height.into());
        let first = image + self.by_level(level, |n| offsets[n] as i64);
        let [mode_s, mode_t] = unit.modes();
        let ([(x0, left), (x1, right)], weight_u) = self.along(mode_s, u, width, is_linear);
        let ([(y0, upper), (y1, lower)], weight_v) = self.along(mode_t, v, height, is_linear);
        for (value, name) in [(weight_u, "weight_u"), (weight_v, "weight_v")] {
            code.name(value.operand(), || name_of(unit.index, name));
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

    /// TEX-6, TEX-8: returns the two indices along an axis, each with whether it is the border colour, and the weight of the second.
    pub(crate) fn along(
        &self,
        mode: AddressMode,
        at: Number<'a>,
        size: Number<'a>,
        is_linear: Truth<'a>,
    ) -> ([(Number<'a>, Truth<'a>); 2], Number<'a>) {
        let (code, one) = (self.interpolator.code, Number::Constant(1));
        code.by("TEX-6");
        // A single texel is that of a footprint half a texel further, with weights 0.
        let half = Number::ZERO.or(is_linear, Number::Constant(128));
        let (texel, weight) = filter::split(at + half);
        let weight = weight.or(is_linear, Number::ZERO);
        code.by("TEX-8");
        let both = [texel, texel + one].map(|index| self.addressed(mode, index, size, self.unit.border, one));
        (both, weight)
    }

    /// SHD-1: returns r, or r/q.
    pub(crate) fn third(&self, projection: Projection) -> Binary<Number<'a>> {
        let code = self.interpolator.code;
        let parts = |n: usize| self.component(self.sample, n).parts(code, (-(1 << 26), 1 << 26));
        let (r, q) = (parts(2), (projection == Projection::Ratio).then(|| parts(3)));
        code.by("SHD-1");
        q.map_or(r, |q| r.positive_ratio(q))
    }

    /// SHD-1: returns whether the reference passes the comparison with a texel.
    fn compared(&self, shadow: ShadowComparison, word: Number<'a>) -> Truth<'a> {
        let reference = match (shadow.reference, self.place) {
            (ShadowReference::R, Place::Own(projection)) => self.third(projection),
            _ => Binary::whole(Number::ZERO),
        };
        let format = self.unit.format.depth().unwrap_or(DepthFormat::Z16);
        let reference = depth::stored(format, reference);
        let stored = (Word(word) & Word::from(0x00ff_ffff)).number();
        Integer::compared(reference, shadow.function, stored)
    }
}

/// Returns whether the figures of a draw are points that give a unit coordinates.
fn is_point<'a>(whole: &Whole<'a, '_>, unit: &PlannedUnit) -> Truth<'a> {
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

/// Returns the side of a level of an image whose first level has this side.
pub(crate) fn side<'a>(first: Number<'a>, level: Number<'a>) -> Number<'a> {
    Integer::greatest(first.down(level), Number::Constant(1))
}
