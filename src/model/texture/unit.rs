//! Sampling of one texture unit: coordinates, level, address, fetch, filter, register.

use super::address::address;
use super::anisotropy::{self, MAX_TAPS};
use super::coordinates::{SampleCoordinates, real_coordinate};
use super::cube::Face;
use super::fetch::{Slice, Texel, lanes};
use super::filter::{bilinear, lerp, linear, nearest};
use super::lod::{self, Choice};
use super::planned::{Image, PlannedUnit};
use super::report::{Report, UNITS, filtered};
use super::{color_key, shadow};
use crate::number::Lane;
use crate::raster::interpolate::COORDINATE_LIMIT;
use crate::state::{Filter, Level, TextureKind};
use crate::trace::{Decision, Observer, Rule, Work};

/// The filter and levels that were chosen by the lod, or the only possible ones.
struct LevelChoice<L: Lane> {
    choice: Choice,
    /// Weight of the second level.
    weight: L::Weight,
}

/// Samples a unit. Returns its register, and whether its colour key drops the fragment.
#[inline]
pub(crate) fn sample<L: Lane, O: Observer>(
    unit: &PlannedUnit,
    image: &Image<'_, L>,
    place: &impl SampleCoordinates,
    observer: &mut O,
) -> ([L; 4], bool) {
    let wants_ideal = O::ON || O::MEASURES || L::DECIDES;
    let mut face = Face::PositiveX;
    if unit.takes_direction() {
        face = if L::DECIDES { place.real(None).face } else { place.face() };
        observer.decided(Decision::Face, face as i64, || place.real(None).face as i64);
    }
    let number = match unit.kind {
        TextureKind::ThreeDimensional => layer::<L, O>(unit, place, observer),
        TextureKind::Cube => Some(face as usize),
        TextureKind::TwoDimensional | TextureKind::Rectangle => Some(0),
    };
    let LevelChoice { choice, weight } = choose::<L, O>(unit, place, observer);
    let real = if wants_ideal { place.real(Some(face)).st } else { [0.0; 2] };
    if O::MEASURES {
        let texels = |of: &dyn Fn(&Level) -> [i64; 2]| {
            let texel = |level: usize| {
                let [u, v] = of(&unit.levels[level]);
                match choice.filter {
                    Filter::Nearest => nearest(u) << 32 ^ nearest(v),
                    Filter::Linear => linear(u).0 << 32 ^ linear(v).0,
                }
            };
            texel(choice.level) ^ choice.next.map_or(0, |(next, _)| texel(next).rotate_left(16))
        };
        let ideal = |level: &Level| real_on(unit, level, real).map(floored);
        let fixed = |level: &Level| if L::DECIDES { ideal(level) } else { place.on(level) };
        observer.decided(Decision::Texel, texels(&fixed), || texels(&ideal));
    }
    let one = |level: usize, prefix: &str, observer: &mut O| {
        let report = Report { unit, prefix };
        let slice = Slice { unit, level: &unit.levels[level], image: number };
        let (coordinates, wanted) = coordinates::<L, O>(&slice, place, real, &report, observer);
        if unit.state.anisotropy > 1 {
            return taps(&slice, image, place, (coordinates, wanted), observer);
        }
        fetched(&slice, image, place, (coordinates, wanted), choice.filter, &report, observer)
    };
    let first = one(choice.level, "", observer);
    let (value, from) = match choice.next {
        None if unit.state.shadow.is_some() => (first, "compared."),
        None if unit.state.anisotropy > 1 => (first, "taps."),
        None => (first, filtered(choice.filter)),
        Some((next, _)) => {
            let second = one(next, "next.", observer);
            (trilinear(unit, [first, second], weight, choice, observer), "levels.")
        }
    };
    let Some(key) = &unit.state.color_key else { return (load(unit, value, from, observer), false) };
    let (value, dropped) = color_key::apply(unit, key, value, observer);
    (load(unit, value, "keyed.", observer), dropped)
}

/// TEX-9 to TEX-11: chooses filter and levels.
#[inline(always)]
fn choose<L: Lane, O: Observer>(
    unit: &PlannedUnit,
    place: &impl SampleCoordinates,
    observer: &mut O,
) -> LevelChoice<L> {
    let whole = |choice| LevelChoice { choice, weight: L::weight(0, || 0.0) };
    if !unit.needs_lod() {
        return whole(Choice { filter: unit.state.mag_filter, level: 0, next: None });
    }
    let quad = place.quad();
    let log2_ratio = lod::log2_ratio(quad);
    let definition = lod::biased(unit, log2_ratio);
    let real = || lod::real_biased(unit, lod::real_log2_ratio(place.real_quad(), unit.scale(&unit.levels[0])));
    let lod = if L::DECIDES { floored(real()) as i32 } else { definition };
    let choice = lod::choose(unit, lod);
    let report = Report { unit, prefix: "" };
    if O::ON {
        place.describe_quad(&report, observer);
        report.lod(quad, log2_ratio, definition, real(), &choice, observer);
    }
    observer.decided(Decision::Level, choice.code(), || lod::choose(unit, floored(real()) as i32).code());
    let Some((_, fixed)) = choice.next else { return whole(choice) };
    #[allow(clippy::float_arithmetic, reason = "the ideal's weight, never the definition's")]
    let weight = L::weight(fixed, || (real() - f64::from(lod - fixed)).clamp(0.0, 256.0));
    let weight = observer.observe_weight::<L>(Rule::Tex9, weight);
    if O::ON {
        report.lod_weight::<L, O>(lod, weight, observer);
    }
    LevelChoice { choice, weight }
}

/// VOL-1: returns the layer of a volume, or `None` if it is in the border beyond the layers.
#[inline(always)]
pub fn layer<L: Lane, O: Observer>(
    unit: &PlannedUnit,
    place: &impl SampleCoordinates,
    observer: &mut O,
) -> Option<usize> {
    let fixed = place.layer(unit.layers);
    let of = |w: i64| address(unit.state.address_r, nearest(w), unit.layers, false).map(|layer| layer as usize);
    let real = || of(floored(real_coordinate(place.real_r(), unit.layers)));
    let layer = if L::DECIDES { real() } else { of(fixed) };
    if O::ON {
        let report = Report { unit, prefix: "" };
        place.describe_layer(&report, unit.layers, fixed, observer);
        report.layer(fixed, layer, observer);
    }
    let code = |layer: Option<usize>| layer.map_or(-1, |layer| layer as i64);
    observer.decided(Decision::Layer, code(layer), || code(real()));
    layer
}

/// Beginnings of the names of steps by which coordinates are computed, after those of the unit.
const COORDINATE_STEPS: &[&str] = &[
    "coordinate",
    "face",
    "u",
    "v",
    "offset",
    "m",
    "vector",
    "product",
    "dot",
    "eye",
    "toward",
    "square",
    "scale",
    "reflection",
    "previous",
];

/// Returns u and v on a level in 1/256 texel, and those of the ideal if something uses them.
#[inline(always)]
fn coordinates<L: Lane, O: Observer>(
    slice: &Slice<'_>,
    place: &impl SampleCoordinates,
    real: [f64; 2],
    report: &Report<'_>,
    observer: &mut O,
) -> ([i64; 2], [f64; 2]) {
    let fixed = place.on(slice.level);
    let wanted = if O::ON || O::MEASURES || L::DECIDES { real_on(slice.unit, slice.level, real) } else { [0.0; 2] };
    if O::ON && report.wanted(COORDINATE_STEPS, observer) {
        place.describe(report, slice.level, fixed, wanted, observer);
    }
    (if L::DECIDES { wanted.map(floored) } else { fixed }, wanted)
}

/// TEX-17: filters each tap of a footprint on level 0 and returns their weighted sum.
#[cold]
fn taps<L: Lane, O: Observer>(
    slice: &Slice<'_>,
    image: &Image<'_, L>,
    place: &impl SampleCoordinates,
    (coordinates, wanted): ([i64; 2], [f64; 2]),
    observer: &mut O,
) -> [L; 4] {
    const PREFIXES: [&str; MAX_TAPS] = ["tap0.", "tap1.", "tap2.", "tap3.", "tap4.", "tap5.", "tap6.", "tap7."];
    let unit = slice.unit;
    let limit = unit.state.anisotropy;
    let quad = place.quad();
    let fixed = anisotropy::taps(quad, limit);
    let real = || anisotropy::real_taps(place.real_quad(), unit.scale(slice.level), limit);
    let ideal = if O::ON || O::MEASURES || L::DECIDES { Some(real()) } else { None };
    let count = if L::DECIDES { ideal.map_or(1, |ideal| ideal.count) } else { fixed.count };
    observer.decided(Decision::Level, count as i64, || real().count as i64);
    // If the ideal has another number of taps, it follows those of the definition.
    let ideal = ideal.filter(|ideal| ideal.count == count);
    if O::ON {
        place.describe_quad(&Report { unit, prefix: "" }, observer);
    }
    let filter = unit.state.mag_filter;
    let mut sum = [L::ZERO; 4];
    let mut mixed = Vec::new();
    for tap in 0..count {
        let report = Report { unit, prefix: PREFIXES[tap] };
        #[allow(clippy::float_arithmetic, reason = "the ideal's taps")]
        let wanted: [f64; 2] = std::array::from_fn(|n| {
            wanted[n] + ideal.map_or(fixed.offsets[tap][n] as f64, |ideal| ideal.offsets[tap][n])
        });
        let at: [i64; 2] =
            if L::DECIDES { wanted.map(floored) } else { [0, 1].map(|n| coordinates[n] + fixed.offsets[tap][n]) };
        let weight =
            L::weight(fixed.weights[tap], || ideal.map_or(f64::from(fixed.weights[tap]), |ideal| ideal.weights[tap]));
        let weight = observer.observe_weight::<L>(Rule::Tex17, weight);
        if O::ON {
            report.tap((quad, limit, tap), (coordinates, at, wanted), L::observe_weight(weight), observer);
        }
        let value = fetched(slice, image, place, (at, wanted), filter, &report, observer);
        sum = std::array::from_fn(|lane| sum[lane] + value[lane].times(weight));
        if O::ON {
            mixed.push((value, weight));
        }
    }
    observer.count(Work::Lerps, 4 * (count as u64 - 1));
    let live = unit.live_lanes();
    std::array::from_fn(|lane| {
        if O::MEASURES && live >> lane & 1 == 0 {
            return L::ZERO;
        }
        let value = observed_step(unit, lane, sum[lane].round8(), observer);
        if O::ON && live >> lane & 1 != 0 {
            Report { unit, prefix: "" }.taps(lane, filter, &mixed, value, observer);
        }
        value
    })
}

/// Returns what a unit reads at u and v on one level of one face or layer.
#[inline(always)]
fn fetched<L: Lane, O: Observer>(
    slice: &Slice<'_>,
    image: &Image<'_, L>,
    place: &impl SampleCoordinates,
    ([u, v], wanted): ([i64; 2], [f64; 2]),
    filter: Filter,
    report: &Report<'_>,
    observer: &mut O,
) -> [L; 4] {
    let unit = slice.unit;
    match filter {
        Filter::Nearest => {
            let (x, y) = (nearest(u), nearest(v));
            if O::ON {
                report.nearest([u, v], [x, y], observer);
            }
            let texel = slice.texel(image.words, x, y);
            if let Some(shadow) = unit.state.shadow {
                if O::ON {
                    report.fetched(slice, image.words, &texel, [("", x), ("", y)], "", observer);
                }
                observer.count(Work::Texels, 1);
                return shadow::compare(unit, shadow, &texel, place, observer);
            }
            let channels = lanes::<L, O>(unit, image, &texel, observer);
            if O::ON {
                report.texel(slice, image.words, (&texel, &channels), [("", x), ("", y)], "", observer);
            }
            channels
        }
        Filter::Linear => {
            let rule = place.rule();
            let ([x, y], weights) = footprint_weights::<L, O>(report, [u, v], wanted, rule, observer);
            let texels = slice.footprint(image.words, x, y);
            let mut expand = |texel: &Texel| lanes::<L, O>(unit, image, texel, observer);
            let [t0, t1, t2, t3] = &texels;
            let channels = [expand(t0), expand(t1), expand(t2), expand(t3)];
            if O::ON && report.wanted(&["texel"], observer) {
                for (n, (dx, dy)) in [("0", "0"), ("1", "0"), ("0", "1"), ("1", "1")].into_iter().enumerate() {
                    let index = [(dx, x + (n & 1) as i64), (dy, y + (n >> 1) as i64)];
                    let suffix = format!("{dx}{dy}");
                    report.texel(slice, image.words, (&texels[n], &channels[n]), index, &suffix, observer);
                }
            }
            mix(report, channels, weights, observer)
        }
    }
}

/// TEX-6: returns the upper left texel of the footprint, and the weights of its right and lower texels, for u and v in
/// 1/256 texel. `ideal` holds u and v as real numbers, and `rule` is the rule that yields them.
#[inline(always)]
pub fn footprint_weights<L: Lane, O: Observer>(
    report: &Report<'_>,
    [u, v]: [i64; 2],
    ideal: [f64; 2],
    rule: Rule,
    observer: &mut O,
) -> ([i64; 2], [L::Weight; 2]) {
    let ((x, wu), (y, wv)) = (linear(u), linear(v));
    let fraction = |axis: usize, texel: i64| {
        #[allow(clippy::float_arithmetic, reason = "the ideal's weight, never the definition's")]
        let fraction = ideal[axis] - 128.0 - (texel * 256) as f64;
        fraction
    };
    let weights = [L::weight(wu, || fraction(0, x)), L::weight(wv, || fraction(1, y))]
        .map(|weight| observer.observe_weight::<L>(rule, weight));
    if O::ON && report.wanted(&["x", "y", "weight"], observer) {
        report.linear::<L, O>([u, v], [x, y], weights, observer);
    }
    ([x, y], weights)
}

/// TEX-6: filters the 2x2 footprint, whose texels are in rows.
#[inline(always)]
pub fn mix<L: Lane, O: Observer>(
    report: &Report<'_>,
    texels: [[L; 4]; 4],
    weights: [L::Weight; 2],
    observer: &mut O,
) -> [L; 4] {
    let unit = report.unit;
    // Computing all four channels is cheaper than checking which are read.
    observer.count(Work::Lerps, 12);
    let live = unit.live_lanes();
    // `map` would copy all texels for each lane.
    let of = |lane: usize| [texels[0][lane], texels[1][lane], texels[2][lane], texels[3][lane]];
    let out: [L; 4] = std::array::from_fn(|lane| {
        if O::MEASURES && live >> lane & 1 == 0 {
            return L::ZERO;
        }
        bilinear(of(lane), weights[0], weights[1], |v| observed_step(unit, lane, v, observer))
    });
    if O::ON {
        for lane in (0..4).filter(|c| live >> c & 1 != 0) {
            if report.wanted(&[report.lane(lane), "row"], observer) {
                report.filter(lane, of(lane), weights, out[lane], observer);
            }
        }
    }
    out
}

/// TEX-9: interpolates between two filtered levels.
#[inline(always)]
fn trilinear<L: Lane, O: Observer>(
    unit: &PlannedUnit,
    [first, second]: [[L; 4]; 2],
    weight: L::Weight,
    choice: Choice,
    observer: &mut O,
) -> [L; 4] {
    observer.count(Work::Lerps, 4);
    let live = unit.live_lanes();
    let out = std::array::from_fn(|lane| {
        if O::MEASURES && live >> lane & 1 == 0 {
            return L::ZERO;
        }
        observed_step(unit, lane, lerp(first[lane], second[lane], weight), observer)
    });
    if O::ON {
        let report = Report { unit, prefix: "" };
        for lane in (0..4).filter(|c| live >> c & 1 != 0) {
            report.trilinear(lane, choice.filter, [first[lane], second[lane]], weight, out[lane], observer);
        }
    }
    out
}

/// Observes the result of a linear step. Signed and wide lanes are not observed, because their unit differs until they
/// become registers (TEX-18).
#[inline(always)]
fn observed_step<L: Lane, O: Observer>(unit: &PlannedUnit, lane: usize, value: L, observer: &mut O) -> L {
    if O::MEASURES && !unit.is_wide() && !unit.state.signed[lane] { observer.observe(Rule::Tex6, value) } else { value }
}

/// Converts what was sampled to the unit's register: signed channels are doubled (TEX-18), halves become bytes (TEX-1).
/// In traces, `from` is the prefix of the sampled channels' names.
#[inline(always)]
pub fn load<L: Lane, O: Observer>(unit: &PlannedUnit, value: [L; 4], from: &str, observer: &mut O) -> [L; 4] {
    let report = Report { unit, prefix: "" };
    if unit.is_wide() {
        return load_halves(value, from, &report, observer);
    }
    let mut register = value;
    let reported = O::ON && observer.wants(&["texture", UNITS[unit.index], "."]);
    for channel in 0..4 {
        if unit.state.signed[channel] {
            register[channel] = observer.observe(Rule::Tex18, value[channel].signed_texel());
        }
        if reported && unit.live >> channel & 1 != 0 {
            report.register(from, channel, value[channel], register[channel], observer);
        }
    }
    register
}

/// TEX-1 for formats that are filtered at 16 bits: returns the bytes of the halves. The high byte of a signed half is
/// doubled (TEX-18).
fn load_halves<L: Lane, O: Observer>(halves: [L; 4], from: &str, report: &Report<'_>, observer: &mut O) -> [L; 4] {
    let unit = report.unit;
    let mut register = [L::ONE; 4];
    // Channel, lane, and whether the channel is the high byte.
    for (channel, lane, high) in [(0, 0, false), (1, 1, true), (2, 1, false), (3, 0, true)] {
        if unit.live >> channel & 1 != 0 {
            let signed = unit.signed_lane(lane);
            let byte = byte_of_half(halves[lane], high, signed);
            let rule = if high && signed { Rule::Tex18 } else { Rule::Tex1 };
            register[channel] = observer.observe(rule, byte);
            if O::ON {
                report.byte_of_half(from, (channel, lane, high), halves[lane], register[channel], observer);
            }
        }
    }
    register
}

/// Returns one byte of a 16-bit half as a register.
fn byte_of_half<L: Lane>(half: L, high: bool, signed: bool) -> L {
    let (fixed, ideal) = half.observe();
    let real = ideal.unwrap_or(0.0);
    #[allow(clippy::float_arithmetic, reason = "the ideal's half, in a lane that has no integer of its own")]
    let whole = if L::DECIDES { floored(real * if signed { 32768.0 } else { 65535.0 } / 255.0 + 0.5) } else { fixed };
    let byte = match (high, signed) {
        (true, true) => 2 * (whole >> 8),
        (true, false) => whole >> 8 & 255,
        (false, _) => whole & 255,
    } as i32;
    // The ideal has no low bytes.
    L::value(byte, || if high { real } else { f64::from(byte) })
}

/// Returns the ideal's u and v on a level.
fn real_on(unit: &PlannedUnit, level: &Level, st: [f64; 2]) -> [f64; 2] {
    let [width, height] = unit.scale(level);
    [real_coordinate(st[0], width), real_coordinate(st[1], height)]
}

/// Floors a number of the ideal for a decision.
#[allow(clippy::float_arithmetic, reason = "the ideal's texel")]
pub(super) fn floored(coordinate: f64) -> i64 {
    let limit = COORDINATE_LIMIT as f64;
    if coordinate.is_nan() { 0 } else { coordinate.floor().clamp(-limit, limit) as i64 }
}
