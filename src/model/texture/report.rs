//! The reports of a texture unit to an observer. Nothing here computes a value that is used.

mod texel;

use super::color_key;
use super::fetch::{self, Slice, Texel};
use super::filter::{lerp, nearest};
use super::lod::{Choice, Quad};
use super::planned::PlannedUnit;
use crate::combiner::registers::channel_name;
use crate::number::Lane;
use crate::raster::interpolate::Sample;
use crate::raster::report as raster;
use crate::rop::blend::compare_operation;
use crate::state::*;
use crate::trace::{Observer, Operand, Step, TexelAddress, part, plain, report};

/// Units of a quad's coordinates in one texel.
const QUAD_PART: i64 = 65536;

/// Names of the components of a coordinate set.
pub(super) const COORDINATES: [&str; 4] = ["s", "t", "r", "q"];

/// The reports of one unit, with names for its steps.
#[derive(Clone, Copy, Debug)]
pub struct Report<'a> {
    /// The unit that is reported.
    pub unit: &'a PlannedUnit,
    /// Prefix of the names of steps, such as `"next."` on the second of two levels.
    pub prefix: &'a str,
}

/// The numbers of units, as names have them. Names are made of parts, which takes a third of the time of formatting: planes have one for every value of every
/// pixel.
pub(super) const UNITS: [&str; 4] = ["0", "1", "2", "3"];

/// Returns the name of a unit's block of the chip.
pub(crate) fn block(index: usize) -> String {
    ["texture unit ", UNITS[index]].concat()
}

impl Report<'_> {
    /// Returns the name of this unit's block.
    pub(crate) fn block(&self) -> String {
        block(self.unit.index)
    }

    /// Returns the name of a value of this unit.
    pub(crate) fn name(&self, suffix: &str) -> String {
        ["unit", UNITS[self.unit.index], ".", self.prefix, suffix].concat()
    }

    /// Returns whether a step of this unit is wanted whose name begins with one of these.
    pub(super) fn wanted<O: Observer>(&self, suffixes: &[&str], observer: &O) -> bool {
        let any = |suffix: &str| observer.wants(&["unit", UNITS[self.unit.index], ".", self.prefix, suffix]);
        any("") && suffixes.iter().any(|suffix| any(suffix))
    }

    /// Returns a step of this unit.
    pub(crate) fn step(&self, rule: &'static str, suffix: &str, value: impl Into<i64>) -> Step {
        Step::plain(&self.block(), rule, self.name(suffix), value)
    }

    /// Reports edge functions and weights of a pixel of the quad. Their names begin with `prefix`.
    pub(crate) fn weights<O: Observer>(&self, prefix: &str, at: &Sample<'_>, pixel: (i64, i64), observer: &mut O) {
        let (block, triangle) = (self.block(), at.triangle);
        raster::edges(&block, ("TEX-11", prefix), triangle, pixel, observer);
        raster::weights(&block, prefix, (at.e, triangle.ratios), at.weights(), None, observer);
    }

    /// Reports a component of the coordinate set, whose values at the vertices are given, and returns it as an operand.
    pub(crate) fn component<O: Observer>(
        &self,
        n: usize,
        prefix: &str,
        values: [f32; 3],
        at: &Sample<'_>,
        observer: &mut O,
    ) -> Operand {
        component(self.unit.index, n, (prefix, values), at, observer)
    }

    /// Reports a coordinate on a level.
    pub(crate) fn coordinate<O: Observer>(
        &self,
        rule: &'static str,
        letter: &str,
        value: i64,
        ideal: f64,
        (operation, inputs): (&'static str, Vec<Operand>),
        observer: &mut O,
    ) {
        observer.step(self.step(rule, letter, value).per(256).by(operation, inputs).ideal(ideal));
    }

    /// Reports a coordinate of a pixel of the quad.
    pub(crate) fn quad_coordinate<O: Observer>(
        &self,
        (pixel, letter): (usize, &str),
        value: i64,
        (operation, inputs): (&'static str, Vec<Operand>),
        observer: &mut O,
    ) {
        let name = self.name(&format!("quad{pixel}.{letter}"));
        observer.step(Step::plain(&self.block(), "TEX-11", name, value).per(QUAD_PART).by(operation, inputs));
    }

    /// TEX-9 to TEX-11: reports the lod, and the filter and levels that it chooses.
    pub(super) fn lod<O: Observer>(
        &self,
        quad: Option<Quad>,
        log2_ratio: i32,
        lod: i32,
        ideal: f64,
        choice: &Choice,
        observer: &mut O,
    ) {
        let state = &self.unit.state;
        let mut ratio = self.step("TEX-10", "log2_ratio", log2_ratio).per(256);
        ratio = match quad {
            Some(quad) => {
                let coordinate = |pixel: usize, n: usize| Operand {
                    name: self.name(&format!("quad{pixel}.{}", ["u", "v"][n])),
                    value: quad[pixel][n],
                    per_one: QUAD_PART,
                    exponent: 0,
                };
                ratio.by("log2_ratio", (0..6).map(|n| coordinate(n / 2, n % 2)).collect())
            }
            None => ratio.note("some of the quad lies behind the viewer".to_string()),
        };
        observer.step(ratio);
        let inputs = vec![
            part(self.name("log2_ratio"), log2_ratio),
            part("lod_bias", state.lod_bias),
            part("min_lod", state.min_lod),
            part("max_lod", state.max_lod),
        ];
        let note = if lod <= 0 { "magnified" } else { "minified" };
        observer.step(
            self.step("TEX-9", "lod", lod)
                .per(256)
                .by("biased_lod", inputs)
                .ideal(ideal)
                .note(format!("{note}: {} filter", crate::state::Named::name(choice.filter))),
        );
        let operation = match state.mip_filter {
            _ if lod <= 0 => "level_0",
            MipFilter::None => "level_0",
            MipFilter::Nearest => "nearest_level",
            MipFilter::Linear => "lower_level",
        };
        let inputs = || vec![part(self.name("lod"), lod), plain("levels", self.unit.levels.len() as i64)];
        let level = self.step("TEX-9", "level", choice.level as i64);
        observer.step(level.by(operation, inputs()));
        if let Some((next, _)) = choice.next {
            let step = self.step("TEX-9", "next_level", next as i64);
            observer.step(step.by("upper_level", inputs()));
        }
    }

    /// TEX-9: reports the weight of the second level.
    pub(super) fn lod_weight<L: Lane, O: Observer>(&self, lod: i32, weight: L::Weight, observer: &mut O) {
        let (weight, ideal) = L::observe_weight(weight);
        let inputs = vec![part(self.name("lod"), lod)];
        observer.step(self.step("TEX-9", "weight_lod", weight).per(256).by("lod_weight", inputs).ideal(ideal));
    }

    pub(super) fn nearest<O: Observer>(&self, coordinate: [i64; 2], texel: [i64; 2], observer: &mut O) {
        for (n, (letter, axis)) in [("u", "x"), ("v", "y")].into_iter().enumerate() {
            observer.step(
                self.step("TEX-5", axis, texel[n]).by("nearest_texel", vec![part(self.name(letter), coordinate[n])]),
            );
        }
    }

    pub(super) fn linear<L: Lane, O: Observer>(
        &self,
        coordinate: [i64; 2],
        texel: [i64; 2],
        weights: [L::Weight; 2],
        observer: &mut O,
    ) {
        for (n, (letter, axis)) in [("u", "x"), ("v", "y")].into_iter().enumerate() {
            let inputs = || vec![part(self.name(letter), coordinate[n])];
            if self.wanted(&[axis], observer) {
                for step in 0..2 {
                    let name = self.name(&format!("{axis}{step}"));
                    let operation = if step == 0 { "linear_texel" } else { "linear_texel_next" };
                    observer.step(Step::plain(&self.block(), "TEX-6", name, texel[n] + step).by(operation, inputs()));
                }
            }
            let suffix = ["weight_u", "weight_v"][n];
            if self.wanted(&[suffix], observer) {
                let (weight, ideal) = L::observe_weight(weights[n]);
                let step = self.step("TEX-6", suffix, weight).per(256);
                observer.step(step.by("linear_weight", inputs()).ideal(ideal));
            }
        }
    }

    /// VOL-1: reports the layer that the coordinate `w` lies in.
    pub(super) fn layer<O: Observer>(&self, w: i64, layer: Option<usize>, observer: &mut O) {
        let index = nearest(w);
        let block = self.block();
        let step = self.step("TEX-5", "z", index);
        observer.step(step.by("nearest_texel", vec![part(self.name("w"), w)]));
        if let Some(layer) = layer {
            let inputs = vec![plain(self.name("z"), index), plain("size", self.unit.layers)];
            let name = self.name("layer");
            observer.step(address_step(&block, name, self.unit.state.address_r, false, inputs, layer as i64));
        }
    }

    pub(super) fn filter<L: Lane, O: Observer>(
        &self,
        lane: usize,
        texels: [L; 4],
        weights: [L::Weight; 2],
        value: L,
        observer: &mut O,
    ) {
        let suffix = self.lane(lane);
        let rows = [lerp(texels[0], texels[1], weights[0]), lerp(texels[2], texels[3], weights[0])];
        let weight = |n: usize| part(self.name(["weight_u", "weight_v"][n]), L::observe_weight(weights[n]).0);
        let texel = |n: usize| self.lane_operand(self.name(&format!("texel{}{}.{suffix}", n & 1, n >> 1)), texels[n]);
        let row_name = |row: usize| self.name(&format!("row{row}.{suffix}"));
        for (row, mixed) in rows.into_iter().enumerate() {
            let inputs = vec![texel(2 * row), texel(2 * row + 1), weight(0)];
            observer.step(self.lane_step("TEX-6", row_name(row), mixed).by("mix", inputs));
        }
        let row = |n: usize| self.lane_operand(row_name(n), rows[n]);
        let inputs = vec![row(0), row(1), weight(1)];
        observer.step(self.lane_step("TEX-6", self.name(suffix), value).by("mix", inputs));
    }

    pub(super) fn trilinear<L: Lane, O: Observer>(
        &self,
        lane: usize,
        filter: Filter,
        levels: [L; 2],
        weight: L::Weight,
        value: L,
        observer: &mut O,
    ) {
        let suffix = self.lane(lane);
        let level = |n: usize| {
            let prefix = ["", "next."][n];
            self.lane_operand(self.name(&format!("{prefix}{}{suffix}", filtered(filter))), levels[n])
        };
        let weight = part(self.name("weight_lod"), L::observe_weight(weight).0);
        let inputs = vec![level(0), level(1), weight];
        observer.step(self.lane_step("TEX-9", self.name(&format!("levels.{suffix}")), value).by("mix", inputs));
    }

    /// KEY-1: reports the comparison of the first `compared` channels of a texel with the key, and the texel that
    /// results.
    pub(super) fn color_key<L: Lane, O: Observer>(
        &self,
        key: &ColorKey,
        (compared, matched): (usize, bool),
        (texel, keyed): (&[L; 4], &[L; 4]),
        observer: &mut O,
    ) {
        let texel = |n: usize| self.lane_operand(self.name(&format!("texel.{}", channel_name(n))), texel[n]);
        let wanted = color_key::as_lanes(self.unit, key);
        let mut inputs: Vec<Operand> = (0..compared).map(texel).collect();
        for (n, value) in wanted.into_iter().enumerate().take(compared) {
            inputs.push(
                observer.tell(self.step("KEY-1", &format!("key.{}", channel_name(n)), value).per(self.per_one())),
            );
        }
        let drops = matched && key.mode == ColorKeyMode::Texel;
        let note = drops.then(|| "the fragment is dropped".to_string());
        let matches = observer.tell(self.step("KEY-1", "key.matched", matched).by("equals_key", inputs).note(note));
        let cleared = color_key::cleared(key.mode);
        for n in (0..4).filter(|n| self.unit.live >> n & 1 != 0) {
            let mut inputs = vec![texel(n)];
            let operation = if cleared[n] { "zero_if" } else { "write" };
            inputs.extend(cleared[n].then(|| matches.clone()));
            let (value, ideal) = keyed[n].observe();
            let step = self.step("KEY-1", &format!("keyed.{}", channel_name(n)), value).per(self.per_one());
            observer.step(step.by(operation, inputs).ideal(ideal));
        }
    }

    /// Reports a channel of the register, from the lane whose name begins with `from`.
    pub(super) fn register<L: Lane, O: Observer>(
        &self,
        from: &str,
        channel: usize,
        value: L,
        register: L,
        observer: &mut O,
    ) {
        let suffix = channel_name(channel);
        let (rule, operation) = if self.unit.state.signed[channel] { ("TEX-18", "double") } else { ("NUM-1", "write") };
        let inputs = vec![self.lane_operand(self.name(&[from, suffix].concat()), value)];
        let name = ["texture", UNITS[self.unit.index], ".", suffix].concat();
        observer.step(report::register_step(&self.block(), rule, name, register).by(operation, inputs));
    }

    /// Reports a channel of the register that is a byte of a half.
    pub(super) fn byte_of_half<L: Lane, O: Observer>(
        &self,
        from: &str,
        (channel, lane, high): (usize, usize, bool),
        half: L,
        register: L,
        observer: &mut O,
    ) {
        let (rule, operation) = match (high, self.unit.signed_lane(lane)) {
            (true, true) => ("TEX-18", "high_byte_doubled"),
            (true, false) => ("TEX-1", "high_byte"),
            (false, _) => ("TEX-1", "low_byte"),
        };
        let inputs = vec![self.lane_operand(self.name(&format!("{from}{}", self.lane(lane))), half)];
        let name = format!("texture{}.{}", self.unit.index, channel_name(channel));
        observer.step(report::register_step(&self.block(), rule, name, register).by(operation, inputs));
    }

    /// Returns the name of a lane.
    pub(super) fn lane(&self, lane: usize) -> &'static str {
        match self.unit.format {
            TextureFormat::R16B16 | TextureFormat::Y16 => ["hi", "lo", "", ""][lane],
            _ => channel_name(lane),
        }
    }

    fn per_one(&self) -> i64 {
        if self.unit.is_wide() { 65535 } else { 255 }
    }

    fn lane_operand<L: Lane>(&self, name: String, value: L) -> Operand {
        Operand { per_one: self.per_one(), ..report::register(name, value) }
    }

    fn lane_step<L: Lane>(&self, rule: &'static str, name: String, value: L) -> Step {
        // The ideal is in 255ths, whatever the unit of the lane.
        let mut step = report::register_step(&self.block(), rule, name, value);
        step.per_one = self.per_one();
        step
    }
}

/// Returns the prefix of the name of a level's result.
pub(super) fn filtered(filter: Filter) -> &'static str {
    match filter {
        Filter::Nearest => "texel.",
        Filter::Linear => "",
    }
}

/// TEX-7: returns the step from an index to a texel inside the image. `inputs` are the index and the size of the image.
pub fn address_step(
    block: &str,
    name: impl Into<String>,
    mode: AddressMode,
    border_texels: bool,
    inputs: Vec<Operand>,
    texel: i64,
) -> Step {
    let operation = address_operation(mode, border_texels);
    let moved = inputs.first().is_some_and(|index| index.value != texel);
    let note = moved.then(|| format!("{operation} from outside"));
    Step::plain(block, "TEX-7", name, texel).by(operation, inputs).note(note)
}

fn address_operation(mode: AddressMode, border_texels: bool) -> &'static str {
    match mode {
        AddressMode::Wrap => "wrap",
        AddressMode::Mirror => "mirror",
        AddressMode::ClampToEdge => "clamp_to_edge",
        AddressMode::ClampToBorder if border_texels => "clamp_to_border_texels",
        AddressMode::ClampToBorder => "clamp_to_border",
        AddressMode::Clamp => "clamp",
    }
}

/// Reports a component of a unit's coordinate set, whose values at the vertices are given, and returns it as an operand. The weights have names that
/// begin with `prefix`.
pub(super) fn component<O: Observer>(
    index: usize,
    n: usize,
    (prefix, values): (&str, [f32; 3]),
    at: &Sample<'_>,
    observer: &mut O,
) -> Operand {
    let (block, name) = (block(index), format!("unit{index}.coordinate.{}", COORDINATES[n]));
    let place = raster::Place { block: &block, rule: "INT-4", name: &name, prefix };
    raster::linear(place, values, at.weights().b, observer)
}
