//! Steps of texels: taps, comparisons, words and their bytes.

use super::super::compressed;
use super::*;

impl Report<'_> {
    /// TEX-17: reports one tap. The prefix names it.
    pub(in crate::texture) fn tap<O: Observer>(
        &self,
        (quad, limit, tap): (Option<Quad>, u32, usize),
        (coordinates, at, ideal): ([i64; 2], [i64; 2], [f64; 2]),
        (weight, ideal_weight): (i64, Option<f64>),
        observer: &mut O,
    ) {
        let of_unit = |name: &str| format!("unit{}.{name}", self.unit.index);
        let footprint = || {
            let mut inputs = vec![plain("limit", limit), plain("tap", tap as i64)];
            for (pixel, at) in quad.iter().flatten().enumerate() {
                for (n, letter) in ["u", "v"].into_iter().enumerate() {
                    let name = of_unit(&format!("quad{pixel}.{letter}"));
                    inputs.push(Operand { name, value: at[n], per_one: QUAD_PART, exponent: 0 });
                }
            }
            inputs
        };
        for (n, letter) in ["u", "v"].into_iter().enumerate() {
            let mut inputs = vec![part(of_unit(letter), coordinates[n])];
            inputs.extend(footprint());
            let step = self.step("TEX-17", letter, at[n]).per(256);
            observer.step(step.by(["tap_u", "tap_v"][n], inputs).ideal(ideal[n]));
        }
        let step = self.step("TEX-17", "weight", weight).per(256);
        observer.step(step.by("tap_weight", footprint()).ideal(ideal_weight));
    }

    /// TEX-17: reports the weighted sum of the taps.
    pub(in crate::texture) fn taps<L: Lane, O: Observer>(
        &self,
        lane: usize,
        filter: Filter,
        taps: &[([L; 4], L::Weight)],
        value: L,
        observer: &mut O,
    ) {
        let suffix = self.lane(lane);
        let mut inputs = Vec::new();
        for (n, (texel, weight)) in taps.iter().enumerate() {
            let name = self.name(&format!("tap{n}.{}{suffix}", filtered(filter)));
            inputs.push(self.lane_operand(name, texel[lane]));
            inputs.push(part(self.name(&format!("tap{n}.weight")), L::observe_weight(*weight).0));
        }
        let step = self.lane_step("TEX-17", self.name(&format!("taps.{suffix}")), value);
        observer.step(step.by("weighted_sum", inputs));
    }

    /// SHD-1: reports the comparison of a reference, which is a word of a depth format, with the stored depth.
    pub(in crate::texture) fn shadow<L: Lane, O: Observer>(
        &self,
        shadow: ShadowComparison,
        (format, reference): (DepthFormat, u32),
        (stored, passes): (u32, bool),
        result: L,
        observer: &mut O,
    ) {
        let block = self.block();
        let [depth, named] = ["texel.depth", "reference"].map(|name| self.name(name));
        if shadow.reference == ShadowReference::Zero {
            observer.step(Step::plain(&block, "SHD-1", named.clone(), reference));
        }
        let note = format!("words of {}", format.name());
        let inputs = vec![plain(named, reference), plain(depth, stored)];
        let operation = compare_operation(shadow.function);
        let step = self.step("SHD-1", "passes", passes);
        observer.step(step.by(operation, inputs).note(note));
        for n in (0..4).filter(|n| self.unit.live >> n & 1 != 0) {
            let inputs = vec![plain(self.name("passes"), passes)];
            let name = self.name(&format!("compared.{}", channel_name(n)));
            observer.step(self.lane_step("SHD-1", name, result).by("all_or_nothing", inputs));
        }
    }

    /// Reports a texel as it was fetched: its address and its raw words. Returns the word that channels are made of.
    pub(in crate::texture) fn fetched<O: Observer>(
        &self,
        slice: &Slice<'_>,
        words: &[u32],
        texel: &Texel,
        index: [(&str, i64); 2],
        suffix: &str,
        observer: &mut O,
    ) -> u32 {
        let block = self.block();
        let texel_name = |what: &str| self.name(&["texel", suffix, ".", what].concat());
        let mut place = Vec::new();
        if let Some(at) = texel.at {
            let (sizes, modes) = ([slice.level.width, slice.level.height], self.unit.modes());
            for (n, axis) in ["x", "y"].into_iter().enumerate() {
                let inputs =
                    vec![plain(self.name(&format!("{axis}{}", index[n].0)), index[n].1), plain("size", sizes[n])];
                let step = address_step(&block, texel_name(axis), modes[n], self.unit.border, inputs, at[n]);
                observer.step(step);
                place.push(plain(texel_name(axis), at[n]));
            }
            if self.unit.kind == TextureKind::ThreeDimensional {
                let layer = slice.image.map_or(0, |layer| layer as i64);
                place.push(plain(format!("unit{}.layer", self.unit.index), layer));
            }
        }
        let lies = texel.at.map(|at| TexelAddress {
            texture: self.unit.state.texture,
            face: slice.image.unwrap_or(0),
            level: self.unit.levels.iter().position(|level| level.offset == slice.level.offset).unwrap_or(0),
            at,
        });
        let word = self.word(words, texel, (place, lies), &texel_name, observer);
        if self.unit.format.depth().is_some() {
            let inputs = vec![plain(texel_name("word"), word)];
            let depth = Step::plain(&block, "SHD-1", texel_name("depth"), depth_of(word));
            observer.step(depth.by("depth_of_word", inputs));
        }
        word
    }

    /// Reports a texel: its address, its raw words and its lanes.
    pub(in crate::texture) fn texel<L: Lane, O: Observer>(
        &self,
        slice: &Slice<'_>,
        words: &[u32],
        (texel, lanes): (&Texel, &[L; 4]),
        index: [(&str, i64); 2],
        suffix: &str,
        observer: &mut O,
    ) {
        let texel_name = |what: &str| self.name(&["texel", suffix, ".", what].concat());
        let word = self.fetched(slice, words, texel, index, suffix, observer);
        for lane in (0..4).filter(|lane| self.unit.live_lanes() >> lane & 1 != 0) {
            let signed = self.unit.signed_lane(lane);
            let rule = if signed { "TEX-18" } else { "TEX-1" };
            let letter = self.lane(lane);
            let mut inputs = vec![plain(texel_name("word"), word)];
            let operation = if self.unit.is_wide() {
                match (lane == 1, signed) {
                    (false, false) if fetch::has_no_high_half(self.unit.format, texel) => {
                        inputs.clear();
                        "constant_65535"
                    }
                    (false, false) => "high_half",
                    (false, true) => "high_half_signed",
                    (true, false) => "low_half",
                    (true, true) => "low_half_signed",
                }
            } else {
                inputs.push(plain(fetch::expanded_as(self.unit, texel), 0));
                inputs.push(plain(letter, lane as i64));
                if signed { "expand_texel_signed" } else { "expand_texel" }
            };
            let step = self.lane_step(rule, texel_name(letter), lanes[lane]);
            observer.step(step.by(operation, inputs));
        }
    }

    /// Reports and returns the word that the lanes are taken from: the raw word, the palette's, the decoded one, or the
    /// border colour.
    fn word<O: Observer>(
        &self,
        words: &[u32],
        texel: &Texel,
        (place, lies): (Vec<Operand>, Option<TexelAddress>),
        name: &impl Fn(&str) -> String,
        observer: &mut O,
    ) -> u32 {
        let block = self.block();
        let mut tell = |rule: &'static str, what: &str, word: u32, operation: &'static str, inputs: Vec<Operand>| {
            let note = Some(format!("{word:#010x}"));
            let lies = lies.filter(|_| operation == "fetch");
            let step = Step::plain(&block, rule, name(what), word).by(operation, inputs).note(note);
            observer.step(step.at(lies));
            word
        };
        let Some([x, y]) = texel.at else { return tell("TEX-7", "word", texel.word, "border_color", place) };
        match self.unit.format {
            TextureFormat::P8 => {
                let entry = fetch::palette_entry(self.unit, texel.word);
                tell("TEX-1", "index", texel.word, "fetch", place);
                tell("TEX-1", "word", entry, "palette", vec![plain(name("index"), texel.word)])
            }
            TextureFormat::Dxt1 | TextureFormat::Dxt3 | TextureFormat::Dxt5 => {
                let raw = fetch::block(self.unit, words, texel);
                let mut inputs = Vec::new();
                for (n, word) in raw.iter().enumerate() {
                    tell("", &format!("block{n}"), *word, "fetch", place.clone());
                    inputs.push(plain(name(&format!("block{n}")), *word));
                }
                // Blocks are within one layer.
                inputs.extend(place.into_iter().take(2));
                let decoded = compressed::decode(self.unit.format, self.unit.dithered, raw, x as u32, y as u32);
                let [r, g, b, a] = decoded.bytes.map(u32::from);
                let (rule, operation) = match (self.unit.format, self.unit.dithered) {
                    (TextureFormat::Dxt1, true) => ("TEX-3", "decode_dxt1_dithered"),
                    (TextureFormat::Dxt1, false) => ("TEX-4", "decode_dxt1"),
                    (TextureFormat::Dxt3, _) => ("TEX-2", "decode_dxt3"),
                    _ => ("TEX-2", "decode_dxt5"),
                };
                tell(rule, "word", a << 24 | r << 16 | g << 8 | b, operation, inputs)
            }
            _ => tell("TEX-1", "word", texel.word, "fetch", place),
        }
    }
}
