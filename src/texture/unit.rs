//! One texture unit: coordinate, address, fetch, filter, register.

use super::address::address;
use super::filter::{bilinear, lerp, linear, nearest};
use super::format;
use crate::combiner::registers::channel_name;
use crate::number::Lane;
use crate::raster::interpolate::{COORDINATE_LIMIT, Sample, Settled};
use crate::raster::setup::Triangle;
use crate::state::{AddressMode, Filter, ShaderStage, TextureFormat, TextureUnit};
use crate::trace::{Decision, Observer, Operand, Rule, Step, Work, part, plain, report};

/// A texture unit with the image it samples.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlannedUnit {
    /// The unit's number.
    pub index: usize,
    /// Its state.
    pub state: TextureUnit,
    /// Its part of the texture shader.
    pub stage: ShaderStage,
    /// Columns of the image.
    pub width: u32,
    /// Rows of the image.
    pub height: u32,
    /// Format of the image.
    pub format: TextureFormat,
    /// Channels R, G, B, A (bits 1, 2, 4, 8) that anybody reads.
    pub live: u8,
}

/// A unit's coordinates, set up for one triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Coordinates {
    /// q is 1 at all three vertices: u and v are linear functions over D (INT-4).
    Plane([[i64; 3]; 2]),
    /// s/q and t/q, a ratio of linear functions (TEX-15).
    Ratio([[i64; 3]; 3]),
}

impl Coordinates {
    /// Sets up the coordinates of a triangle. `st_q` holds s, t, r, q of its three vertices.
    pub fn new(triangle: &Triangle, vertices: [[f32; 4]; 3], unit: &PlannedUnit) -> Coordinates {
        let component = |n: usize| vertices.map(|v| v[n]);
        if component(3) == [1.0; 3] {
            let g = |n: usize, size: u32| triangle.coordinate(component(n), size);
            Coordinates::Plane([g(0, unit.width), g(1, unit.height)])
        } else {
            Coordinates::Ratio(triangle.direction([component(0), component(1), component(3)]))
        }
    }

    /// u and v in 1/256 texel, floored.
    #[inline]
    pub fn at(&self, sample: &Sample<'_>, unit: &PlannedUnit) -> [Settled; 2] {
        match self {
            Coordinates::Plane(g) => [sample.coordinate(&g[0]), sample.coordinate(&g[1])],
            Coordinates::Ratio([s, t, q]) => [sample.ratio(s, q, unit.width), sample.ratio(t, q, unit.height)],
        }
    }
}

/// One texel of the footprint: where it is, `None` for the border colour, and its raw word.
type Texel = (Option<(u32, u32)>, u32);

/// The image that a unit samples, as it stands when a draw begins.
#[derive(Clone, Copy, Debug)]
pub struct Image<'a, L> {
    /// Its words.
    pub words: &'a [u32],
    /// What the lane holds of them, where the image is a surface read in its own format, and of which channels (bits R, G, B, A).
    pub memory: Option<(&'a [[L; 4]], u8)>,
}

/// Samples a unit. `ideal` gives u and v in 1/256 texel as real numbers; it is called only where somebody wants it.
#[inline]
pub fn sample<L: Lane, O: Observer>(
    unit: &PlannedUnit,
    image: &Image<'_, L>,
    coordinates: &Coordinates,
    at: &Sample<'_>,
    ideal: impl FnOnce() -> [f64; 2],
    observer: &mut O,
) -> [L; 4] {
    let settled = coordinates.at(at, unit);
    // Asked for once, by those who want it.
    let real = if O::ON || O::MEASURES || L::DECIDES { ideal() } else { [0.0; 2] };
    let [u, v] = if L::DECIDES { real.map(floored) } else { settled.map(|c| c.value) };
    if O::MEASURES {
        let texel = |[u, v]: [i64; 2]| match unit.state.mag_filter {
            Filter::Nearest => nearest(u) << 32 ^ nearest(v),
            Filter::Linear => linear(u).0 << 32 ^ linear(v).0,
        };
        observer.decided(Decision::Texel, texel([u, v]), || texel(real.map(floored)));
    }
    let report = Report { unit };
    if O::ON {
        report.coordinates(coordinates, at, settled, real, observer);
    }
    let value = match unit.state.mag_filter {
        Filter::Nearest => {
            let (x, y) = (nearest(u), nearest(v));
            if O::ON {
                report.nearest([u, v], [x, y], observer);
            }
            let texel = fetch(unit, image.words, x, y);
            let channels = lanes::<L, O>(unit, image, &texel, observer);
            if O::ON {
                report.texel(&texel, [("", x), ("", y)], "", &channels, observer);
            }
            channels
        }
        Filter::Linear => {
            let rule = if matches!(coordinates, Coordinates::Plane(_)) { Rule::Int4 } else { Rule::Tex15 };
            let ([x, y], weights) = footprint_weights::<L, O>(unit, [u, v], real, rule, observer);
            let texels = footprint(unit, image.words, x, y);
            let mut expand = |texel| lanes::<L, O>(unit, image, texel, observer);
            let [t0, t1, t2, t3] = &texels;
            let channels = [expand(t0), expand(t1), expand(t2), expand(t3)];
            if O::ON {
                for (n, (dx, dy)) in [("0", "0"), ("1", "0"), ("0", "1"), ("1", "1")].into_iter().enumerate() {
                    let index = [x + (n & 1) as i64, y + (n >> 1) as i64];
                    report.texel(
                        &texels[n],
                        [(dx, index[0]), (dy, index[1])],
                        &format!("{dx}{dy}"),
                        &channels[n],
                        observer,
                    );
                }
            }
            mix(unit, channels, weights, observer)
        }
    };
    load(unit, value, observer)
}

/// TEX-6: the footprint's upper left texel and the weights of its right and lower ones, from u and v in 1/256 texel, which `ideal` gives as real numbers; `rule`
/// is the one that they come from.
#[inline(always)]
pub fn footprint_weights<L: Lane, O: Observer>(
    unit: &PlannedUnit,
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
        .map(|weight| observer.settle_weight::<L>(rule, weight));
    if O::ON {
        (Report { unit }).linear::<L, O>([u, v], [x, y], weights, observer);
    }
    ([x, y], weights)
}

/// TEX-6: the mix of the 2x2 footprint, row by row.
#[inline(always)]
pub fn mix<L: Lane, O: Observer>(
    unit: &PlannedUnit,
    texels: [[L; 4]; 4],
    weights: [L::Weight; 2],
    observer: &mut O,
) -> [L; 4] {
    // All four channels: cheaper than asking which are read.
    observer.count(Work::Lerps, 12);
    let out: [L; 4] = std::array::from_fn(|channel| {
        if O::MEASURES && unit.live >> channel & 1 == 0 {
            return L::ZERO;
        }
        bilinear(texels.map(|texel| texel[channel]), weights[0], weights[1], |v| {
            // A signed channel counts in another unit until it becomes a register (TEX-18).
            if O::MEASURES && !unit.state.signed[channel] { observer.settle(Rule::Tex6, v) } else { v }
        })
    });
    if O::ON {
        for channel in (0..4).filter(|c| unit.live >> c & 1 != 0) {
            (Report { unit }).filter(channel, texels.map(|t| t[channel]), weights, out[channel], observer);
        }
    }
    out
}

/// What was sampled as the unit's register: signed channels are doubled (TEX-18).
#[inline(always)]
pub fn load<L: Lane, O: Observer>(unit: &PlannedUnit, value: [L; 4], observer: &mut O) -> [L; 4] {
    let mut register = value;
    for channel in 0..4 {
        if unit.state.signed[channel] {
            register[channel] = observer.settle(Rule::Tex18, value[channel].signed_texel());
        }
        if O::ON && unit.live >> channel & 1 != 0 {
            (Report { unit }).register(channel, value[channel], register[channel], observer);
        }
    }
    register
}

/// The texel at an index that may lie outside.
#[inline(always)]
fn fetch(unit: &PlannedUnit, words: &[u32], x: i64, y: i64) -> Texel {
    let x = address(unit.state.address_s, x, unit.width);
    texel(unit, words, x, address(unit.state.address_t, y, unit.height))
}

/// TEX-8: the 2x2 footprint whose upper left texel is (x, y), row by row; each index is wrapped on its own.
#[inline(always)]
fn footprint(unit: &PlannedUnit, words: &[u32], x: i64, y: i64) -> [Texel; 4] {
    let (x0, x1) = (address(unit.state.address_s, x, unit.width), address(unit.state.address_s, x + 1, unit.width));
    let (y0, y1) = (address(unit.state.address_t, y, unit.height), address(unit.state.address_t, y + 1, unit.height));
    [texel(unit, words, x0, y0), texel(unit, words, x1, y0), texel(unit, words, x0, y1), texel(unit, words, x1, y1)]
}

/// TEX-7: the texel inside, or the border colour, which is A8R8G8B8 whatever the format.
#[inline(always)]
fn texel(unit: &PlannedUnit, words: &[u32], x: Option<u32>, y: Option<u32>) -> Texel {
    if let (Some(x), Some(y)) = (x, y) {
        (Some((x, y)), words[y as usize * unit.width as usize + x as usize])
    } else {
        let [r, g, b, a] = unit.state.border_color.map(u32::from);
        (None, a << 24 | r << 16 | g << 8 | b)
    }
}

#[inline(always)]
fn lanes<L: Lane, O: Observer>(unit: &PlannedUnit, image: &Image<'_, L>, texel: &Texel, observer: &mut O) -> [L; 4] {
    let format = if texel.0.is_some() { unit.format } else { TextureFormat::A8R8G8B8 };
    let mut lanes = format::lanes::<L>(format, texel.1, &unit.state.signed);
    observer.count(Work::Texels, 1);
    let mut rule = Rule::Tex1;
    if let Some((x, y)) = texel.0 {
        observer.fetched(unit.state.texture, (x, y));
        if let Some((memory, channels)) = image.memory {
            let held = &memory[y as usize * unit.width as usize + x as usize];
            for n in (0..4).filter(|n| channels >> n & 1 != 0) {
                lanes[n] = lanes[n].remember(held[n], unit.state.signed[n]);
            }
            rule = Rule::Rop5;
        }
    }
    if O::MEASURES && (image.memory.is_some() || format::is_narrow(format)) {
        for channel in (0..4).filter(|n| !unit.state.signed[*n] && unit.live >> n & 1 != 0) {
            lanes[channel] = observer.settle(rule, lanes[channel]);
        }
    }
    lanes
}

/// The ideal's coordinate in whole 256ths of a texel, for the texel that it lies in.
#[allow(clippy::float_arithmetic, reason = "the ideal's texel")]
fn floored(coordinate: f64) -> i64 {
    let limit = COORDINATE_LIMIT as f64;
    if coordinate.is_nan() { 0 } else { coordinate.floor().clamp(-limit, limit) as i64 }
}

/// What a unit tells an observer.
struct Report<'a> {
    unit: &'a PlannedUnit,
}

impl Report<'_> {
    fn block(&self) -> String {
        format!("texture unit {}", self.unit.index)
    }

    fn name(&self, suffix: &str) -> String {
        format!("unit{}.{suffix}", self.unit.index)
    }

    fn coordinates<O: Observer>(
        &self,
        coordinates: &Coordinates,
        at: &Sample<'_>,
        settled: [Settled; 2],
        ideal: [f64; 2],
        observer: &mut O,
    ) {
        let block = self.block();
        let sizes = [self.unit.width, self.unit.height];
        for (axis, letter) in ["u", "v"].into_iter().enumerate() {
            let mut inputs: Vec<Operand> = Vec::new();
            let mut planes = |name: &str, g: &[i64; 3]| {
                for (k, g) in g.iter().enumerate() {
                    let name = self.name(&format!("{name}{k}"));
                    observer.step(Step::given(&block, "INT-4", name.clone(), *g));
                    inputs.push(plain(name, *g));
                }
            };
            let operation = match coordinates {
                Coordinates::Plane(g) => {
                    planes(&format!("G_{letter}"), &g[axis]);
                    "floor_plane"
                }
                Coordinates::Ratio(planes_stq) => {
                    planes(&format!("N_{letter}"), &planes_stq[axis]);
                    planes("N_q", &planes_stq[2]);
                    "floor_ratio"
                }
            };
            inputs.extend((0..3).map(|k| plain(format!("E{k}"), at.e[k])));
            if operation == "floor_plane" {
                inputs.push(plain("D", at.d));
            } else {
                inputs.push(plain("size", i64::from(sizes[axis])));
            }
            inputs.push(plain("lowered", i64::from(settled[axis].lowered)));
            let note = settled[axis].lowered.then(|| "exactly on a 1/256 texel: one step lower (INT-4t)".to_string());
            let rule = if operation == "floor_plane" { "INT-4" } else { "TEX-15" };
            observer.step(
                Step::given(&block, rule, self.name(letter), settled[axis].value)
                    .per(256)
                    .by(operation, inputs)
                    .ideal(Some(ideal[axis]))
                    .note(note),
            );
        }
    }

    fn nearest<O: Observer>(&self, coordinate: [i64; 2], texel: [i64; 2], observer: &mut O) {
        for (n, (letter, axis)) in [("u", "x"), ("v", "y")].into_iter().enumerate() {
            observer.step(
                Step::given(&self.block(), "TEX-5", self.name(axis), texel[n])
                    .by("nearest_texel", vec![part(self.name(letter), coordinate[n])]),
            );
        }
    }

    fn linear<L: Lane, O: Observer>(
        &self,
        coordinate: [i64; 2],
        texel: [i64; 2],
        weights: [L::Weight; 2],
        observer: &mut O,
    ) {
        for (n, (letter, axis)) in [("u", "x"), ("v", "y")].into_iter().enumerate() {
            let inputs = vec![part(self.name(letter), coordinate[n])];
            for step in 0..2 {
                let name = self.name(&format!("{axis}{step}"));
                let operation = if step == 0 { "linear_texel" } else { "linear_texel_next" };
                observer.step(Step::given(&self.block(), "TEX-6", name, texel[n] + step).by(operation, inputs.clone()));
            }
            let (weight, ideal) = L::observe_weight(weights[n]);
            observer.step(
                Step::given(&self.block(), "TEX-6", self.name(&format!("weight_{letter}")), weight)
                    .per(256)
                    .by("linear_weight", inputs)
                    .ideal(ideal),
            );
        }
    }

    fn texel<L: Lane, O: Observer>(
        &self,
        texel: &Texel,
        index: [(&str, i64); 2],
        suffix: &str,
        channels: &[L; 4],
        observer: &mut O,
    ) {
        let block = self.block();
        let sizes = [self.unit.width, self.unit.height];
        let modes = [self.unit.state.address_s, self.unit.state.address_t];
        let mut address_inputs = Vec::new();
        if let Some((x, y)) = texel.0 {
            for (n, axis) in ["x", "y"].into_iter().enumerate() {
                let name = self.name(&format!("texel{suffix}.{axis}"));
                let value = i64::from([x, y][n]);
                let inputs = vec![
                    plain(self.name(&format!("{axis}{}", index[n].0)), index[n].1),
                    plain("size", i64::from(sizes[n])),
                ];
                observer.step(address_step(&block, name.clone(), modes[n], inputs, value));
                address_inputs.push(plain(name, value));
            }
        }
        let name = self.name(&format!("texel{suffix}.word"));
        let (rule, operation) = if texel.0.is_some() { ("TEX-1", "fetch") } else { ("TEX-7", "border_color") };
        let word = i64::from(texel.1);
        let note = Some(format!("{word:#010x}"));
        observer.step(Step::given(&block, rule, name.clone(), word).by(operation, address_inputs).note(note));
        for channel in (0..4).filter(|c| self.unit.live >> c & 1 != 0) {
            let signed = self.unit.state.signed[channel];
            let format = if texel.0.is_some() { self.unit.format } else { TextureFormat::A8R8G8B8 };
            let operation = if signed { "expand_texel_signed" } else { "expand_texel" };
            let inputs = vec![
                plain(name.clone(), word),
                plain(crate::state::Named::name(format), 0),
                plain(channel_name(channel), channel as i64),
            ];
            let suffix = format!("texel{suffix}.{}", channel_name(channel));
            let rule = if signed { "TEX-18" } else { "TEX-1" };
            observer
                .step(report::register_step(&block, rule, self.name(&suffix), channels[channel]).by(operation, inputs));
        }
    }

    fn filter<L: Lane, O: Observer>(
        &self,
        channel: usize,
        texels: [L; 4],
        weights: [L::Weight; 2],
        value: L,
        observer: &mut O,
    ) {
        let (block, suffix) = (self.block(), channel_name(channel));
        let rows = [lerp(texels[0], texels[1], weights[0]), lerp(texels[2], texels[3], weights[0])];
        let weight = |n: usize| part(self.name(["weight_u", "weight_v"][n]), L::observe_weight(weights[n]).0);
        let texel = |n: usize| {
            let name = self.name(&format!("texel{}{}.{suffix}", n & 1, n >> 1));
            report::register(name, texels[n])
        };
        for (row, mixed) in rows.into_iter().enumerate() {
            let inputs = vec![texel(2 * row), texel(2 * row + 1), weight(0)];
            let name = self.name(&format!("row{row}.{suffix}"));
            observer.step(report::register_step(&block, "TEX-6", name, mixed).by("mix", inputs));
        }
        let row = |n: usize| report::register(self.name(&format!("row{n}.{suffix}")), rows[n]);
        let inputs = vec![row(0), row(1), weight(1)];
        observer.step(report::register_step(&block, "TEX-6", self.name(suffix), value).by("mix", inputs));
    }

    fn register<L: Lane, O: Observer>(&self, channel: usize, value: L, register: L, observer: &mut O) {
        let suffix = channel_name(channel);
        let source = match self.unit.state.mag_filter {
            Filter::Nearest => self.name(&format!("texel.{suffix}")),
            Filter::Linear => self.name(suffix),
        };
        let (rule, operation) = if self.unit.state.signed[channel] { ("TEX-18", "double") } else { ("NUM-1", "write") };
        let name = format!("texture{}.{suffix}", self.unit.index);
        observer.step(
            report::register_step(&self.block(), rule, name, register)
                .by(operation, vec![report::register(source, value)]),
        );
    }
}

/// TEX-7: the step from an index (the first of `inputs`; the second is the image's size) to a texel inside the image.
pub fn address_step(block: &str, name: impl Into<String>, mode: AddressMode, inputs: Vec<Operand>, texel: i64) -> Step {
    let operation = address_operation(mode);
    let moved = inputs.first().is_some_and(|index| index.value != texel);
    let note = moved.then(|| format!("{operation} from outside"));
    Step::given(block, "TEX-7", name, texel).by(operation, inputs).note(note)
}

fn address_operation(mode: AddressMode) -> &'static str {
    match mode {
        AddressMode::Wrap => "wrap",
        AddressMode::Mirror => "mirror",
        AddressMode::ClampToEdge => "clamp_to_edge",
        AddressMode::ClampToBorder => "clamp_to_border",
        AddressMode::Clamp => "clamp",
    }
}
