//! The order of a pixel, apart from what its values are.
//!
//! The rules say in which order a pixel's registers are mapped, multiplied, added, rounded, written and blended. That order is one text:
//! [`combiner::general`](crate::combiner::general) (CMB-1, CMB-6 to CMB-11), [`combiner::final_combiner`](crate::combiner::final_combiner)
//! (FIN-1 to FIN-4) and [`rop::blend`](crate::rop::blend) (ROP-2 to ROP-5). It is written in the operations of [`Algebra`], and whoever wants
//! to know something about the order runs it with values of its own:
//!
//! | reader | its values | what it learns |
//! |---|---|---|
//! | [`Direct`](crate::combiner::direct::Direct) | numbers of a lane | the pixel: scalar engine, traces, the ideal, vectors |
//! | `engine::rows::graph::Graph` | nodes with ranges | what the fast engine computes |
//! | [`Trail`] | nodes and what is known of them | what is read (liveness), what is the same in every pixel (folding) |
//!
//! Policies are answered here too: the text asks for them where an alternative is another order; where it is another number, the reader does.

mod trail;

pub use trail::{Trail, Value};

use crate::state::{Bias, InputMapping, MuxSelect, Policies, Scale};
use crate::trace::Rule;

/// A place of the text: one bit for each value of a general stage, of the final combiner, or of the blend.
///
/// Readers that leave values out, or that ask which of them are needed, tell values apart by it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Site(pub u64);

impl Site {
    /// Input A, B, C or D of a portion after its mapping.
    pub const fn factor(n: usize, channel: usize) -> Site {
        Site(1 << (4 * n + channel))
    }

    /// AB or CD of a portion at full width.
    pub const fn product(n: usize, channel: usize) -> Site {
        Site(1 << (16 + 4 * n + channel))
    }

    /// The third output of a portion at full width.
    pub const fn third(channel: usize) -> Site {
        Site(1 << (24 + channel))
    }

    /// AB, CD or the third output of a portion as a register.
    pub const fn output(n: usize, channel: usize) -> Site {
        Site(1 << (28 + 4 * n + channel))
    }

    /// What output `n` writes to a channel of its destination.
    pub const fn write(n: usize, channel: usize) -> Site {
        Site(1 << (40 + 4 * n + channel))
    }

    /// What blue of output `n` writes to the alpha of its destination (CMB-11).
    pub const fn blue_to_alpha(n: usize) -> Site {
        Site(1 << (52 + n))
    }

    /// The site of the same step, `channel` channels further on.
    #[inline(always)]
    pub const fn channel(self, channel: usize) -> Site {
        Site(self.0 << channel)
    }

    /// The places of so many channels, this being the first.
    #[inline(always)]
    pub const fn channels(self, count: usize) -> u64 {
        self.0 * ((1 << count) - 1)
    }

    /// Whether a stage writes the value to a register.
    pub const fn writes(self) -> bool {
        self.0 >> 40 & 0x3fff != 0
    }

    /// All places of a portion with these channels: R, G, B (7) or A (8).
    pub const fn of_channels(channels: u8) -> u64 {
        let own = channels as u64 * 0x1_1111_1111_1111;
        if channels & 7 == 0 { own } else { own | 3 << 52 }
    }

    /// A channel of SPARE0 + SECONDARY (FIN-3).
    pub const fn color_sum(channel: usize) -> Site {
        Site(1 << channel)
    }

    /// A channel of E times F, and E and F (FIN-4).
    pub const fn final_product(channel: usize) -> Site {
        Site(1 << (4 + channel))
    }

    /// A channel of the fragment (FIN-2, FIN-4).
    pub const fn fragment(channel: usize) -> Site {
        Site(1 << (8 + channel))
    }

    /// A channel of A B + (1 - A) C, and A, B and C (FIN-2).
    pub const fn lerp(channel: usize) -> Site {
        Site(1 << (12 + channel))
    }
}

/// The operations in which the order of a pixel is written.
///
/// Registers, factors and sums are as in [`number`](crate::number): steps of 1/255, and of 1/65025 for sums. A sum remembers the rule that made
/// it, which is the rule that its rounding counts as.
pub trait Algebra {
    /// A 9-bit register, or a byte of the raster operations.
    type Register: Copy;
    /// A register after its mapping.
    type Factor: Copy;
    /// A sum of full-width products.
    type Sum: Copy;
    /// What a mux takes.
    type Choice: Copy;

    /// The policies in force.
    fn policies(&self) -> &Policies;
    /// The value of a factor at a place of the text. A reader that does not need it may leave it out.
    #[inline(always)]
    fn factor(&mut self, _site: Site, value: impl FnOnce(&mut Self) -> Self::Factor) -> Self::Factor {
        value(self)
    }
    /// The value of a sum at a place of the text.
    #[inline(always)]
    fn sum(&mut self, _site: Site, value: impl FnOnce(&mut Self) -> Self::Sum) -> Self::Sum {
        value(self)
    }
    /// The value of a register at a place of the text.
    #[inline(always)]
    fn register(&mut self, _site: Site, value: impl FnOnce(&mut Self) -> Self::Register) -> Self::Register {
        value(self)
    }

    /// [`factor`](Self::factor)s of some channels, the first at this place: registers through a mapping.
    #[inline(always)]
    fn factors<const N: usize>(
        &mut self,
        first: Site,
        mapping: InputMapping,
        x: [Self::Register; N],
    ) -> [Self::Factor; N] {
        std::array::from_fn(|c| self.factor(first.channel(c), |a| a.map(mapping, x[c])))
    }
    /// [`sum`](Self::sum)s of some channels, the first at this place.
    #[inline(always)]
    fn sums<const N: usize>(
        &mut self,
        first: Site,
        mut value: impl FnMut(&mut Self, usize) -> Self::Sum,
    ) -> [Self::Sum; N] {
        std::array::from_fn(|c| self.sum(first.channel(c), |a| value(a, c)))
    }
    /// [`register`](Self::register)s of some channels, the first at this place.
    #[inline(always)]
    fn registers<const N: usize>(
        &mut self,
        first: Site,
        mut value: impl FnMut(&mut Self, usize) -> Self::Register,
    ) -> [Self::Register; N] {
        std::array::from_fn(|c| self.register(first.channel(c), |a| value(a, c)))
    }

    /// A byte of the state (NUM-5).
    fn byte(&mut self, value: u8) -> Self::Register;
    /// CMB-2 to CMB-5, with their policies.
    fn map(&mut self, mapping: InputMapping, x: Self::Register) -> Self::Factor;
    /// A register as a factor, as it is.
    fn plain(&mut self, x: Self::Register) -> Self::Factor;
    /// A full-width product of the rule.
    fn product(&mut self, rule: Rule, a: Self::Factor, b: Self::Factor) -> Self::Sum;
    /// A full-width sum of the rule.
    fn add(&mut self, rule: Rule, a: Self::Sum, b: Self::Sum) -> Self::Sum;
    /// A full-width difference of the rule.
    fn subtract(&mut self, rule: Rule, a: Self::Sum, b: Self::Sum) -> Self::Sum;
    /// A register at the width of a sum of the rule.
    fn widened(&mut self, rule: Rule, x: Self::Register) -> Self::Sum;
    /// CMB-10, with its policy: what SPARE0's alpha selects.
    fn choice(&mut self, select: MuxSelect, spare0_alpha: Self::Register) -> Self::Choice;
    /// CMB-10: one of two sums.
    fn select(&mut self, takes_cd: Self::Choice, cd: Self::Sum, ab: Self::Sum) -> Self::Sum;
    /// NUM-2.
    fn rounded(&mut self, sum: Self::Sum) -> Self::Register;
    /// CMB-9=after: biased and scaled at full width, then rounded.
    fn rounded_after(&mut self, bias: Bias, scale: Scale, sum: Self::Sum) -> Self::Register;
    /// CMB-9: biased and scaled after the rounding.
    fn scaled(&mut self, bias: Bias, scale: Scale, x: Self::Register) -> Self::Register;
    /// NUM-3, with its policy.
    fn saturated(&mut self, x: Self::Register) -> Self::Register;
    /// What a destination receives: the value as it is.
    #[inline(always)]
    fn written(&mut self, x: Self::Register) -> Self::Register {
        x
    }
    /// max(0, x).
    fn max0(&mut self, x: Self::Register) -> Self::Register;
    /// 255 - x.
    fn complement(&mut self, x: Self::Register) -> Self::Register;
    /// a + b.
    fn plus(&mut self, a: Self::Register, b: Self::Register) -> Self::Register;
    /// a - b.
    fn minus(&mut self, a: Self::Register, b: Self::Register) -> Self::Register;
    /// The smaller.
    fn least(&mut self, a: Self::Register, b: Self::Register) -> Self::Register;
    /// The larger.
    fn greatest(&mut self, a: Self::Register, b: Self::Register) -> Self::Register;
    /// Limited to 0..=255.
    fn clamped(&mut self, x: Self::Register) -> Self::Register;
    /// ROP-5: without so many low bits, more than none.
    fn truncated(&mut self, bits: u32, x: Self::Register) -> Self::Register;
    /// ROP-3: a byte read as two's complement.
    fn signed_byte(&mut self, x: Self::Register) -> Self::Register;
    /// The rule has yielded this value, other than by rounding a sum of it.
    #[inline(always)]
    fn yielded(&mut self, _rule: Rule, x: Self::Register) -> Self::Register {
        x
    }
}
