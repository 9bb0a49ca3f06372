//! Where a unit samples its texture, and what it reads there.

use ninebit::number::{Blend as _, Integer, Register as _};
use ninebit::raster::binary::Binary;
use ninebit::raster::depth;
use ninebit::state::*;
use ninebit::texture::address::{shows_border_color, texel_index};
use ninebit::texture::filter;
use ninebit::texture::lod::Selection;
use ninebit::texture::planned::PlannedUnit;

use crate::binary::Interpolant;
use crate::code::{COORDINATE, Code, Operation};
use crate::coordinates::{Facing, OnFace, is_point, log2_ratio, pairs_of_quad};
use crate::input::Weight;
use crate::number::{Number, Word};
use crate::texel::{Sampler, Texels};
use crate::triangle::name_of;
use crate::truth::Truth;
use crate::whole::{Interpolator, Sample, Whole};

/// The components of coordinates that a unit divides.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Projection {
    /// s and t.
    Plane,
    /// s/q and t/q.
    Ratio,
    /// A direction.
    Direction,
}

impl Projection {
    /// Returns the projection of a unit, which all triangles of a draw can take.
    pub(crate) fn new(whole: &Whole<'_, '_>, unit: &PlannedUnit) -> Projection {
        if unit.takes_direction() {
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
    /// Two of them whose signs choose ends of a face (TEX-20).
    Ends([Number<'a>; 2]),
    /// A direction that the dot unit computed (TSH-4, TSH-5).
    Vector([Interpolant<'a>; 3]),
    /// A direction whose face is known.
    OnFace(OnFace<'a>),
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

    /// Returns the first word of the image, and whether it is in the border beyond the layers of a volume.
    fn image(&self, facing: Option<Facing<'a>>) -> (Number<'a>, Truth<'a>) {
        let (_, words) = self.unit.texel_layout();
        let words = Number::Constant(words as i64);
        if let Some(facing) = facing.filter(|_| self.unit.kind == TextureKind::Cube) {
            return (facing.number() * words, Truth::Known(false));
        }
        if self.unit.kind != TextureKind::ThreeDimensional {
            return (Number::ZERO, Truth::Known(false));
        }
        self.layer(Number::Constant(self.unit.layers.into()), words)
    }

    /// VOL-1: returns the layer of a volume times `by`, and whether it is in the border beyond.
    fn layer(&self, layers: Number<'a>, by: Number<'a>) -> (Number<'a>, Truth<'a>) {
        self.layer_at(self.across_layers(layers), layers, by)
    }

    /// Returns the coordinate across the layers of a volume in 1/256 layer.
    pub(crate) fn across_layers(&self, layers: Number<'a>) -> Number<'a> {
        let r = self.component(self.sample, 2);
        match self.place {
            Place::Own(Projection::Ratio) => self.ratio(r, self.component(self.sample, 3), layers),
            Place::Own(_) => self.floored(r, layers),
            _ => Number::ZERO,
        }
    }

    /// VOL-1: returns the layer at a coordinate times `by`, and whether it is in the border beyond.
    pub(crate) fn layer_at(&self, w: Number<'a>, layers: Number<'a>, by: Number<'a>) -> (Number<'a>, Truth<'a>) {
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
        let parts = |n: usize| self.component(self.sample, n).parts(code, COORDINATE);
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

/// Returns the side of a level of an image whose first level has this side.
pub(crate) fn side<'a>(first: Number<'a>, level: Number<'a>) -> Number<'a> {
    Integer::greatest(first.down(level), Number::Constant(1))
}
