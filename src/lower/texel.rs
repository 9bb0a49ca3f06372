//! Computes what a texture unit yields from fetched words and weights (TEX-1, TEX-6, TEX-7, TEX-9, TEX-18).

use ninebit::number::Register as _;
use ninebit::state::*;
use ninebit::texture::filter::{bilinear, lerp};
use ninebit::texture::format;
use ninebit::texture::planned::PlannedUnit;

use crate::code::Code;
use crate::input::{Input, Weight};
use crate::number::{Number, Word};

/// Computes the colour of a unit that samples its texture.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sampler<'u> {
    pub(crate) unit: &'u PlannedUnit,
    /// The border colour, if a texel can be it.
    pub(crate) border: Option<[u8; 4]>,
}

impl<'u> Sampler<'u> {
    pub(crate) fn new(unit: &'u PlannedUnit) -> Sampler<'u> {
        let outside = unit.modes().contains(&AddressMode::ClampToBorder) && !unit.border;
        let border = (outside && unit.kind != TextureKind::Cube).then_some(unit.state.border_color);
        Sampler { unit, border }
    }

    /// Returns whether four texels are mixed.
    fn is_linear(&self) -> bool {
        [self.unit.state.mag_filter, self.unit.state.min_filter].contains(&Filter::Linear)
    }

    /// Returns whether two levels are mixed.
    fn has_next(&self) -> bool {
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

    /// Returns the value of the register that the unit loads.
    pub(crate) fn register<'a>(
        &self,
        border: [Number<'a>; 4],
        mut input: impl FnMut(Input) -> Number<'a>,
        code: &'a Code,
    ) -> [Number<'a>; 4] {
        let n = self.unit.index;
        let mut weight = |of: Weight| input(Input::Weight(n, of));
        let weights = Weight::ALL.map(&mut weight);
        let mut level = |first: usize, [u, v]: [Number<'a>; 2]| {
            let mut lanes = |at: usize| {
                let (word, outside) = (input(Input::Texel(n, first + at)), input(Input::Outside(n)));
                self.lanes(Word(word), (first + at, outside), border, code)
            };
            if !self.is_linear() {
                return lanes(0);
            }
            let texels = [0, 1, 2, 3].map(&mut lanes);
            code.by("TEX-6");
            [0, 1, 2, 3].map(|lane: usize| {
                let all = texels.map(|texel| texel[lane]);
                // A mixture of equal values is that value; this happens in channels that a format does not store.
                let equal = all.iter().all(|texel| texel.operand() == all[0].operand());
                if equal { all[0] } else { bilinear(all, u, v, |step| step.between(&all)) }
            })
        };
        let mut lanes = level(0, [weights[0], weights[1]]);
        if self.has_next() {
            let next = level(4, [weights[2], weights[3]]);
            code.by("TEX-9");
            lanes = [0, 1, 2, 3].map(|lane: usize| {
                let equal = lanes[lane].operand() == next[lane].operand();
                if equal {
                    next[lane]
                } else {
                    lerp(lanes[lane], next[lane], weights[4]).between(&[lanes[lane], next[lane]])
                }
            });
        }
        let register = if self.unit.is_wide() { self.bytes(lanes, code) } else { self.doubled(lanes, code) };
        for (channel, name) in ["r", "g", "b", "a"].into_iter().enumerate() {
            code.name(register[channel].operand(), || format!("texture{n}_{name}"));
        }
        register
    }

    /// Returns the lanes of a texel: its channels, or its halves.
    fn lanes<'a>(
        &self,
        word: Word<'a>,
        (at, outside): (usize, Number<'a>),
        border: [Number<'a>; 4],
        code: &'a Code,
    ) -> [Number<'a>; 4] {
        code.by("TEX-1");
        let half = |high: Number<'a>, low: Number<'a>| high.multiplied(Number::Constant(256)) + low;
        let (inside, border): ([Number<'a>; 4], [Number<'a>; 4]) = if self.unit.is_wide() {
            let low = (word & Word::from(0xffff)).number();
            let high = match self.unit.format {
                TextureFormat::Y16 => Number::Constant(0xffff),
                _ => (word >> 16).number(),
            };
            let [r, g, b, a] = border;
            ([high, low, Number::ZERO, Number::ZERO], [half(a, r), half(g, b), Number::ZERO, Number::ZERO])
        } else {
            (format::channels(self.words(), word).map(Word::number), border)
        };
        let bits = if self.unit.is_wide() { 16 } else { 8 };
        [0, 1, 2, 3].map(|lane: usize| {
            let is_signed = self.unit.signed_lane(lane);
            let read = |value: Number<'a>| if is_signed { value.signed(bits) } else { value };
            let value = read(inside[lane]);
            if self.border.is_none() {
                return value;
            }
            code.by("TEX-7");
            let is_outside = outside.low_bits(1 << at).compared(CompareFunction::NotEqual, Number::ZERO);
            read(border[lane]).selected(is_outside, code, value)
        })
    }

    /// Doubles signed channels.
    fn doubled<'a>(&self, lanes: [Number<'a>; 4], code: &'a Code) -> [Number<'a>; 4] {
        code.by("TEX-18");
        let two = Number::Constant(2);
        [0, 1, 2, 3].map(|n: usize| if self.unit.state.signed[n] { lanes[n].multiplied(two) } else { lanes[n] })
    }

    /// Returns the bytes of two halves. The high byte of a signed half is doubled.
    fn bytes<'a>(&self, [high, low, ..]: [Number<'a>; 4], code: &'a Code) -> [Number<'a>; 4] {
        code.by("TEX-1");
        let upper = |half: Number<'a>, lane: usize| {
            let byte = half.floor_divided(256);
            if self.unit.signed_lane(lane) {
                code.by("TEX-18");
                byte.multiplied(Number::Constant(2))
            } else {
                byte
            }
        };
        [high.low_bits(255), upper(low, 1), low.low_bits(255), upper(high, 0)]
    }
}
