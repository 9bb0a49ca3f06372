//! The order of a pixel's operations, independent of what its values are.
//!
//! The rules define the order in which a pixel's registers are mapped, multiplied, added, rounded, written and blended.
//! That order is written once: in [`combiner::general`](crate::combiner::general) (CMB-1, CMB-6 to CMB-11),
//! [`combiner::final_combiner`](crate::combiner::final_combiner) (FIN-1 to FIN-4) and [`rop::blend`](crate::rop::blend)
//! (ROP-2 to ROP-5). It is written in the operations of [`Algebra`]. A reader runs it with its own kind of values, to
//! learn something about the order:
//!
//! | reader | its values | its result |
//! |---|---|---|
//! | [`Direct`](crate::combiner::direct::Direct) | numbers of a lane | the pixel: scalar engine, traces, the ideal, vectors |
//! | `engine::rows::shading::graph::Graph` | nodes with ranges | what the fast engine computes |
//! | `Trail` | nodes and what is known about them | what is read (liveness), and what is the same in every pixel
//! (folding) |
//!
//! The text checks policies where an alternative changes the order. Where an alternative changes a number, the reader
//! checks.

mod trail;

pub(crate) use trail::{Trail, Value};

use crate::state::{Bias, InputMapping, MuxSelect, Policies, Scale};
use crate::trace::Rule;

/// The place of a value in the text: one bit for each value of a general stage, of the final combiner, or of blending.
///
/// Readers identify values by their sites, in order to leave values out or to find which are needed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Site(pub u64);

impl Site {
    /// Returns the site of input A, B, C or D of a portion after its mapping.
    pub(crate) const fn factor(n: usize, channel: usize) -> Site {
        Site(1 << (4 * n + channel))
    }

    /// Returns the site of AB or CD of a portion at full width.
    pub const fn product(n: usize, channel: usize) -> Site {
        Site(1 << (16 + 4 * n + channel))
    }

    /// Returns the site of a portion's third output at full width.
    pub(crate) const fn third_output(channel: usize) -> Site {
        Site(1 << (24 + channel))
    }

    /// Returns the site of AB, CD or the third output of a portion as a register.
    pub(crate) const fn output(n: usize, channel: usize) -> Site {
        Site(1 << (28 + 4 * n + channel))
    }

    /// Returns the site of what output `n` writes to a channel of its destination.
    pub const fn write(n: usize, channel: usize) -> Site {
        Site(1 << (40 + 4 * n + channel))
    }

    /// Returns the site of what the blue of output `n` writes to the alpha of its destination (CMB-11).
    pub const fn blue_to_alpha(n: usize) -> Site {
        Site(1 << (52 + n))
    }

    /// Returns the site of the same step `channel` channels later.
    #[inline(always)]
    pub(crate) const fn channel(self, channel: usize) -> Site {
        Site(self.0 << channel)
    }

    /// Returns the set of the sites of `count` channels, starting with this one.
    #[inline(always)]
    pub(crate) const fn channels(self, count: usize) -> u64 {
        self.0 * ((1 << count) - 1)
    }

    /// Returns whether a stage writes the value to a register.
    pub(crate) const fn writes(self) -> bool {
        self.0 >> 40 & 0x3fff != 0
    }

    /// Returns the set of all sites of a portion with the given channels: R, G, B (7) or A (8).
    pub(crate) const fn of_channels(channels: u8) -> u64 {
        let own = channels as u64 * 0x1_1111_1111_1111;
        if channels & 7 == 0 { own } else { own | 3 << 52 }
    }

    /// Returns the site of a channel of SPARE0 + SECONDARY (FIN-3).
    pub(crate) const fn color_sum(channel: usize) -> Site {
        Site(1 << channel)
    }

    /// Returns the site of a channel of E times F, and of E and F (FIN-4).
    pub(crate) const fn final_product(channel: usize) -> Site {
        Site(1 << (4 + channel))
    }

    /// Returns the site of a channel of the fragment (FIN-2, FIN-4).
    pub(crate) const fn fragment(channel: usize) -> Site {
        Site(1 << (8 + channel))
    }

    /// Returns the site of a channel of A B + (1 - A) C, and of A, B and C (FIN-2).
    pub(crate) const fn lerp(channel: usize) -> Site {
        Site(1 << (12 + channel))
    }
}

/// The operations in which the order of a pixel is written.
///
/// Registers, factors and sums are those of [`number`](crate::number): steps of 1/255, or of 1/65025 for sums. A sum
/// remembers the rule that made it, to which its rounding is attributed.
pub trait Algebra {
    /// A 9-bit register, or a byte of the raster operations.
    type Register: Copy;
    /// A register after its mapping.
    type Factor: Copy;
    /// A sum of full-width products.
    type Sum: Copy;
    /// The decision of a mux.
    type Choice: Copy;

    /// Returns the policies in force.
    fn policies(&self) -> &Policies;
    /// Evaluates a factor at a site. A reader that does not need the value may leave it out.
    #[inline(always)]
    fn factor(&mut self, _site: Site, value: impl FnOnce(&mut Self) -> Self::Factor) -> Self::Factor {
        value(self)
    }
    /// Evaluates a sum at a site.
    #[inline(always)]
    fn sum(&mut self, _site: Site, value: impl FnOnce(&mut Self) -> Self::Sum) -> Self::Sum {
        value(self)
    }
    /// Evaluates a register at a site.
    #[inline(always)]
    fn register(&mut self, _site: Site, value: impl FnOnce(&mut Self) -> Self::Register) -> Self::Register {
        value(self)
    }

    /// Evaluates the [`factor`](Self::factor)s of `N` channels, which map registers. `first` is the site of the first
    /// channel.
    #[inline(always)]
    fn factors<const N: usize>(
        &mut self,
        first: Site,
        mapping: InputMapping,
        x: [Self::Register; N],
    ) -> [Self::Factor; N] {
        std::array::from_fn(|c| self.factor(first.channel(c), |a| a.map(mapping, x[c])))
    }
    /// Evaluates the [`sum`](Self::sum)s of `N` channels. `first` is the site of the first channel.
    #[inline(always)]
    fn sums<const N: usize>(
        &mut self,
        first: Site,
        mut value: impl FnMut(&mut Self, usize) -> Self::Sum,
    ) -> [Self::Sum; N] {
        std::array::from_fn(|c| self.sum(first.channel(c), |a| value(a, c)))
    }
    /// Evaluates the [`register`](Self::register)s of `N` channels. `first` is the site of the first channel.
    #[inline(always)]
    fn registers<const N: usize>(
        &mut self,
        first: Site,
        mut value: impl FnMut(&mut Self, usize) -> Self::Register,
    ) -> [Self::Register; N] {
        std::array::from_fn(|c| self.register(first.channel(c), |a| value(a, c)))
    }

    /// Converts a byte of the state (NUM-5).
    fn byte(&mut self, value: u8) -> Self::Register;
    /// Applies an input mapping with its policies (CMB-2 to CMB-5).
    fn map(&mut self, mapping: InputMapping, x: Self::Register) -> Self::Factor;
    /// Uses a register as a factor, without a mapping.
    fn plain(&mut self, x: Self::Register) -> Self::Factor;
    /// Returns a full-width product of the rule.
    fn product(&mut self, rule: Rule, a: Self::Factor, b: Self::Factor) -> Self::Sum;
    /// Returns a full-width sum of the rule.
    fn add(&mut self, rule: Rule, a: Self::Sum, b: Self::Sum) -> Self::Sum;
    /// Returns a full-width difference of the rule.
    fn subtract(&mut self, rule: Rule, a: Self::Sum, b: Self::Sum) -> Self::Sum;
    /// Widens a register to a sum of the rule.
    fn widened(&mut self, rule: Rule, x: Self::Register) -> Self::Sum;
    /// CMB-10, with its policy: decides the mux by SPARE0's alpha.
    fn choice(&mut self, select: MuxSelect, spare0_alpha: Self::Register) -> Self::Choice;
    /// CMB-10: selects one of two sums.
    fn select(&mut self, takes_cd: Self::Choice, cd: Self::Sum, ab: Self::Sum) -> Self::Sum;
    /// NUM-2: rounds a sum.
    fn rounded(&mut self, sum: Self::Sum) -> Self::Register;
    /// CMB-9=after: applies bias and scale at full width, then rounds.
    fn rounded_after(&mut self, bias: Bias, scale: Scale, sum: Self::Sum) -> Self::Register;
    /// CMB-9: applies bias and scale after rounding.
    fn scaled(&mut self, bias: Bias, scale: Scale, x: Self::Register) -> Self::Register;
    /// NUM-3, with its policy: saturates a register.
    fn saturated(&mut self, x: Self::Register) -> Self::Register;
    /// Returns what a destination receives, which is the value itself.
    #[inline(always)]
    fn written(&mut self, x: Self::Register) -> Self::Register {
        x
    }
    /// Returns max(0, x).
    fn max0(&mut self, x: Self::Register) -> Self::Register;
    /// Returns 255 - x.
    fn complement(&mut self, x: Self::Register) -> Self::Register;
    /// Returns a + b.
    fn plus(&mut self, a: Self::Register, b: Self::Register) -> Self::Register;
    /// Returns a - b.
    fn minus(&mut self, a: Self::Register, b: Self::Register) -> Self::Register;
    /// Returns the smaller of two values.
    fn least(&mut self, a: Self::Register, b: Self::Register) -> Self::Register;
    /// Returns the larger of two values.
    fn greatest(&mut self, a: Self::Register, b: Self::Register) -> Self::Register;
    /// Limits a value to 0..=255.
    fn clamped(&mut self, x: Self::Register) -> Self::Register;
    /// ROP-5: clears the low `bits` bits, of which there is at least one.
    fn truncated(&mut self, bits: u32, x: Self::Register) -> Self::Register;
    /// ROP-3: reads a byte as two's complement.
    fn signed_byte(&mut self, x: Self::Register) -> Self::Register;
    /// Records that the rule has yielded this value by something other than rounding a sum of it.
    #[inline(always)]
    fn yielded(&mut self, _rule: Rule, x: Self::Register) -> Self::Register {
        x
    }
}
