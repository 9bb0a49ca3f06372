//! Computes what a texture unit yields from fetched words and weights (TEX-1, TEX-6, TEX-7, TEX-9, TEX-18).

use ninebit::number::{Integer, Register as _};
use ninebit::state::*;
use ninebit::texture::filter::{bilinear, lerp};
use ninebit::texture::planned::PlannedUnit;
use ninebit::texture::{color_key, format};

use crate::code::Code;
use crate::input::{Input, Weight};
use crate::number::{Number, Pair, Word};
use crate::truth::Truth;

/// Where the texels of a unit, and the weights of its filter, come from.
pub(crate) trait Texels<'a> {
    /// Returns the word of a texel. 0 to 3 are the footprint in a level, row by row, 4 to 7 that in the next level.
    fn word(&self, at: usize) -> Number<'a>;
    /// Returns whether a texel is the border colour.
    fn outside(&self, at: usize, code: &'a Code) -> Truth<'a>;
    /// Returns a weight of the filter.
    fn weight(&self, of: Weight) -> Number<'a>;
}

/// Texels that the caller has fetched.
pub(crate) struct CallerTexels<F>(pub(crate) usize, pub(crate) F);

impl<'a, F: Fn(Input) -> Number<'a>> Texels<'a> for CallerTexels<F> {
    fn word(&self, at: usize) -> Number<'a> {
        self.1(Input::Texel(self.0, at))
    }
    fn outside(&self, at: usize, code: &'a Code) -> Truth<'a> {
        let bit = self.1(Input::Outside(self.0)).low_bits(1 << at);
        Truth::Of(code, Number::compared(bit, CompareFunction::NotEqual, Number::ZERO))
    }
    fn weight(&self, of: Weight) -> Number<'a> {
        self.1(Input::Weight(self.0, of))
    }
}

/// Computes the colour of a unit that samples its texture.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sampler<'u> {
    pub(crate) unit: &'u PlannedUnit,
    /// The border colour, if a texel can be it.
    pub(crate) border: Option<[u8; 4]>,
}

impl<'u> Sampler<'u> {
    pub(crate) fn new(unit: &'u PlannedUnit) -> Sampler<'u> {
        let mut modes = unit.modes().to_vec();
        if unit.kind == TextureKind::ThreeDimensional {
            modes.push(unit.state.address_r);
        }
        let outside = modes.contains(&AddressMode::ClampToBorder) && !unit.border;
        let border = (outside && unit.kind != TextureKind::Cube).then_some(unit.state.border_color);
        Sampler { unit, border }
    }

    /// Returns whether four texels are mixed.
    pub(crate) fn is_linear(&self) -> bool {
        [self.unit.state.mag_filter, self.unit.state.min_filter].contains(&Filter::Linear)
    }

    /// Returns whether two levels are mixed.
    pub(crate) fn has_next(&self) -> bool {
        self.unit.levels.len() > 1 && self.unit.state.mip_filter == MipFilter::Linear
    }

    /// Returns the format of the fetched words. Whoever fetches them has looked up palettes and decoded blocks.
    pub(crate) fn words(&self) -> TextureFormat {
        match self.unit.format {
            TextureFormat::P8 | TextureFormat::Dxt1 | TextureFormat::Dxt3 | TextureFormat::Dxt5 => {
                TextureFormat::A8R8G8B8
            }
            format => format,
        }
    }

    /// Returns the value of the register that the unit loads, and whether a colour key drops the fragment.
    pub(crate) fn register<'a>(
        &self,
        border: [Number<'a>; 4],
        texels: &impl Texels<'a>,
        code: &'a Code,
    ) -> ([Number<'a>; 4], Truth<'a>) {
        let mut lanes = self.filtered(0, border, texels, code);
        if self.has_next() {
            let next = self.filtered(4, border, texels, code);
            code.by("TEX-9");
            lanes = [0, 1, 2, 3].map(|lane: usize| {
                let equal = lanes[lane].operand() == next[lane].operand();
                if equal {
                    next[lane]
                } else {
                    lerp(lanes[lane], next[lane], texels.weight(Weight::Level)).between(&[lanes[lane], next[lane]])
                }
            });
        }
        let (lanes, dropped) = self.keyed(lanes, code);
        (self.loaded(lanes, code), dropped)
    }

    /// Returns which byte of a word each channel is, or `None` for one that is 255, if the filter may treat the bytes of four texels two at a time.
    fn plain_bytes(&self) -> Option<[Option<u32>; 4]> {
        use TextureFormat::*;
        let is_plain = self.border.is_none() && (0..4).all(|lane| !self.unit.signed_lane(lane));
        let has_bytes = matches!(self.words(), A8R8G8B8 | X8R8G8B8 | A8B8G8R8 | B8G8R8A8 | R8G8B8A8);
        let numbers = || format::channels(self.words(), 0x0302_0100_u32);
        (is_plain && has_bytes).then(|| numbers().map(|byte| (byte < 4).then_some(byte)))
    }

    /// Returns the lanes of a level, whose first texel has the number `first`.
    pub(crate) fn filtered<'a>(
        &self,
        first: usize,
        border: [Number<'a>; 4],
        texels: &impl Texels<'a>,
        code: &'a Code,
    ) -> [Number<'a>; 4] {
        let lanes = |at: usize| {
            self.lanes(Word(texels.word(first + at)), |code| texels.outside(first + at, code), border, code)
        };
        if !self.is_linear() {
            return lanes(0);
        }
        let of = if first == 0 { [Weight::U, Weight::V] } else { [Weight::NextU, Weight::NextV] };
        let [u, v] = of.map(|weight| texels.weight(weight));
        if let Some(bytes) = self.plain_bytes() {
            let words = [0, 1, 2, 3].map(|at| Word(texels.word(first + at)));
            code.by("TEX-6");
            let pairs = [0, 8].map(|down| bilinear(words.map(|word| Pair::new(word >> down)), u, v, |step| step).0);
            let byte = |at: u32| (pairs[at as usize % 2] >> (at / 2 * 16) & Word::from(255)).number();
            return bytes.map(|at| at.map_or(Number::ONE, byte));
        }
        let texels = [0, 1, 2, 3].map(lanes);
        code.by("TEX-6");
        [0, 1, 2, 3].map(|lane: usize| {
            let all = texels.map(|texel| texel[lane]);
            // A mixture of equal values is that value; this happens in channels that a format does not store.
            let equal = all.iter().all(|texel| texel.operand() == all[0].operand());
            if equal { all[0] } else { bilinear(all, u, v, |step| step.between(&all)) }
        })
    }

    /// Returns the register that lanes become.
    pub(crate) fn loaded<'a>(&self, lanes: [Number<'a>; 4], code: &'a Code) -> [Number<'a>; 4] {
        let n = self.unit.index;
        let register = if self.unit.is_wide() {
            self.bytes(lanes, [0, 1].map(|lane| Truth::Known(self.unit.signed_lane(lane))), code)
        } else {
            self.doubled(lanes, self.unit.state.signed.map(Truth::Known), code)
        };
        for (channel, name) in ["r", "g", "b", "a"].into_iter().enumerate() {
            code.name(register[channel].operand(), || format!("texture{n}_{name}"));
        }
        register
    }

    /// Applies the colour key, if the unit has one (KEY-1). Returns whether it drops the fragment.
    fn keyed<'a>(&self, lanes: [Number<'a>; 4], code: &'a Code) -> ([Number<'a>; 4], Truth<'a>) {
        let Some(key) = &self.unit.state.color_key else { return (lanes, Truth::Known(false)) };
        let wanted = color_key::as_lanes(self.unit, key).map(|lane| Number::Constant(lane.into()));
        self.keyed_by(key.mode, wanted, lanes, code)
    }

    /// KEY-1: applies a key whose colour has these lanes.
    pub(crate) fn keyed_by<'a>(
        &self,
        mode: ColorKeyMode,
        wanted: [Number<'a>; 4],
        lanes: [Number<'a>; 4],
        code: &'a Code,
    ) -> ([Number<'a>; 4], Truth<'a>) {
        code.by("KEY-1");
        let equal = |n: usize| Integer::compared(lanes[n], CompareFunction::Equal, wanted[n]);
        let matched = (0..color_key::compared(self.unit)).map(equal).fold(Truth::Known(true), |all, one| all & one);
        let cleared = color_key::cleared(mode);
        let lanes = [0, 1, 2, 3].map(|n: usize| if cleared[n] { Number::ZERO.or(matched, lanes[n]) } else { lanes[n] });
        (lanes, if mode == ColorKeyMode::Texel { matched } else { Truth::Known(false) })
    }

    /// Returns the lanes of a texel: its channels, or its halves.
    fn lanes<'a>(
        &self,
        word: Word<'a>,
        outside: impl Fn(&'a Code) -> Truth<'a>,
        border: [Number<'a>; 4],
        code: &'a Code,
    ) -> [Number<'a>; 4] {
        let (inside, border) = (self.inside(word, code), self.beyond(border));
        [0, 1, 2, 3].map(|lane: usize| {
            let read = |value: Number<'a>| self.read(value, Truth::Known(self.unit.signed_lane(lane)));
            let value = read(inside[lane]);
            if self.border.is_none() {
                return value;
            }
            code.by("TEX-7");
            read(border[lane]).or(outside(code), value)
        })
    }

    /// TEX-1: returns the lanes of a word, which are not yet signed.
    pub(crate) fn inside<'a>(&self, word: Word<'a>, code: &'a Code) -> [Number<'a>; 4] {
        code.by("TEX-1");
        if !self.unit.is_wide() {
            return format::channels(self.words(), word).map(Word::number);
        }
        let low = (word & Word::from(0xffff)).number();
        let high = match self.unit.format {
            TextureFormat::Y16 => Number::Constant(0xffff),
            _ => (word >> 16).number(),
        };
        [high, low, Number::ZERO, Number::ZERO]
    }

    /// Returns the lanes of the border colour, which are not yet signed.
    pub(crate) fn beyond<'a>(&self, border: [Number<'a>; 4]) -> [Number<'a>; 4] {
        let half = |high: Number<'a>, low: Number<'a>| high.multiplied(Number::Constant(256)) + low;
        let [r, g, b, a] = border;
        if self.unit.is_wide() { [half(a, r), half(g, b), Number::ZERO, Number::ZERO] } else { border }
    }

    /// Returns a lane, which may be two's complement.
    pub(crate) fn read<'a>(&self, lane: Number<'a>, is_signed: Truth<'a>) -> Number<'a> {
        let bits = if self.unit.is_wide() { 16 } else { 8 };
        lane.signed(bits).or(is_signed, lane)
    }

    /// Doubles signed channels.
    pub(crate) fn doubled<'a>(
        &self,
        lanes: [Number<'a>; 4],
        signed: [Truth<'a>; 4],
        code: &'a Code,
    ) -> [Number<'a>; 4] {
        code.by("TEX-18");
        [0, 1, 2, 3].map(|n: usize| lanes[n].multiplied(Number::Constant(2)).or(signed[n], lanes[n]))
    }

    /// Returns the bytes of two halves. The high byte of a signed half is doubled.
    pub(crate) fn bytes<'a>(
        &self,
        [high, low, ..]: [Number<'a>; 4],
        signed: [Truth<'a>; 2],
        code: &'a Code,
    ) -> [Number<'a>; 4] {
        let upper = |half: Number<'a>, lane: usize| {
            code.by("TEX-1");
            let byte = half.floor_divided(256);
            code.by("TEX-18");
            byte.multiplied(Number::Constant(2)).or(signed[lane], byte)
        };
        [high.low_bits(255), upper(low, 1), low.low_bits(255), upper(high, 0)]
    }
}
