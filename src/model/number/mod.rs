//! The numbers of the chip, and the traits that let one text of a rule serve every evaluation.
//!
//! A *lane* is the type that a rule computes with. The rules in [`raster`](crate::raster), [`texture`](crate::texture),
//! [`combiner`](crate::combiner) and [`rop`](crate::rop) are free functions over the traits of this module. Everything
//! that differs between evaluations (rounding, width, the value of one half) is defined by the lane and nowhere else.
//!
//! | lane | meaning | used by |
//! |---|---|---|
//! | `i32` | the definition | the scalar engine |
//! | [`Pair`] | the definition and the ideal side by side; the definition takes every decision | traces |
//! | `f64` | the ideal: the vendor's formulas in real numbers, without rounding | comparisons, the second half of
//! [`Pair`] |
//! | [`Pair`] of [`IdealTracks`] | the definition and several ideals, which attribute errors to rules | comparisons |
//! | `i16`, `u16` | the definition in 16 bits, for loops over blocks of pixels | the fast engine |
//! | [`Narrow`] | `i16` whose expanded products stay in 16 bits | the fast engine |
//! | [`Lanes16`] of `i32` | sixteen numbers of the definition side by side | sweeps of vectors |
//! | [`Swar2`] | two 8-bit channels in one word | the fast engine's filter |
//!
//! All lanes count in steps of 1/255 (NUM-1): 1.0 is 255.

/// Implements an operator of wrapper types by an expression of the wrapped values.
macro_rules! wrapped {
    ($($type:ident: $trait:ident, $method:ident, |$a:ident, $b:ident| $result:expr;)+) => { $(
        impl $trait for $type {
            type Output = $type;
            #[inline(always)]
            fn $method(self, other: $type) -> $type {
                let ($a, $b) = (self.0, other.0);
                $type($result)
            }
        }
    )+ };
}

/// Defines methods of a type of several numbers that act on each number alone, by the `map` of the type or, with
/// another operand, its `zip`.
macro_rules! componentwise {
    ($($method:ident($($other:ident: $type:ty)?) -> $result:ty = $of:expr;)+) => { $(
        #[inline(always)]
        fn $method(self $(, $other: $type)?) -> $result {
            componentwise!(@ self, $of $(, $other)?)
        }
    )+ };
    (@ $value:expr, $of:expr) => { $value.map($of) };
    (@ $value:expr, $of:expr, $other:ident) => { $value.zip($other, $of) };
}

pub(crate) mod block;
pub mod convert;
mod ideal_tracks;
mod integer;
mod lanes16;
pub mod light;
mod pair;
mod part;
mod real;
mod scalar;
pub mod transform;

pub use block::{Half, Narrow, Quarter, Swar2};
pub use ideal_tracks::{IDEAL_TRACKS, IdealTracks};
pub use integer::{Choice, Integer, newton_root, round_bits, shift, split_bits};
pub(crate) use integer::{LEAST_TOP, align};
pub use lanes16::{LANES, Lanes16};
pub use pair::Pair;
pub use part::Part;
pub use scalar::{Halves, Quarters};

use crate::state::RegisterFloor;
use std::ops::{Add, BitAnd, BitOr, Mul, Shl, Shr, Sub};

/// The bits of a stored word or of a texel: `u32`, or a symbolic value where rules are printed. Nothing wraps: bits
/// that are shifted out are never used, and products stay below 2^32.
pub trait Word:
    Copy
    + From<u32>
    + BitAnd<Output = Self>
    + BitOr<Output = Self>
    + Mul<Output = Self>
    + Shl<u32, Output = Self>
    + Shr<u32, Output = Self>
{
}

impl Word for u32 {}

/// A value that is mixed by weights in 256ths, such as an interpolated colour or a filtered texel.
pub trait Blend: Copy + Add<Output = Self> {
    /// A weight, 0 to 256.
    type Weight: Copy + Sub<Output = Self::Weight>;
    /// The weight of 1.0: 256.
    const WHOLE: Self::Weight;
    /// Returns the product with a weight, without rounding.
    fn times(self, weight: Self::Weight) -> Self;
    /// Converts from 256ths to whole steps: (x + 128) >> 8.
    fn round8(self) -> Self;
}

/// A 9-bit combiner register, or a byte of the raster operations, in steps of 1/255.
pub trait Register: Copy + Add<Output = Self> + Sub<Output = Self> {
    /// The result of a mapping: a factor of a product.
    type Factor: Factor<Register = Self>;
    /// The result of the expand mappings: a [`Factor`](Self::Factor), or a narrower lane that knows that it is even.
    type Expanded: Factor<Register = Self>;
    /// The register value 0.
    const ZERO: Self;
    /// The register value of 1.0: 255.
    const ONE: Self;
    /// One half: 128 (CMB-3, CMB-4, CMB-9); 127.5 in the ideal.
    const HALF: Self;
    /// Returns max(0, x), the first step of the unsigned mappings.
    fn max0(self) -> Self;
    /// Returns the value itself as a factor.
    fn factor(self) -> Self::Factor;
    /// Returns twice the value as a factor, exactly.
    fn twice(self) -> Self::Expanded;
    /// Returns (x + 1) >> 1, the output scale of one half.
    fn halved(self) -> Self;
    /// NUM-3: limits the value to what a register holds.
    fn saturated(self, floor: RegisterFloor) -> Self;
}

/// A factor of a combiner product: a register after its input mapping.
pub trait Factor: Copy {
    /// The type of sums of products.
    type Sum: Sum<Register = Self::Register>;
    /// The register that receives the result.
    type Register;
    /// Returns the full-width product, without rounding.
    fn product(self, other: Self) -> Self::Sum;
}

/// A sum of full-width products, in steps of 1/65025.
pub trait Sum: Copy + Add<Output = Self> {
    /// The register that receives the result.
    type Register;
    /// NUM-2: rounds to the nearest 255th, without saturation.
    fn rounded(self) -> Self::Register;
}

/// The operations that alternatives of policies, the final combiner and the raster operations need beyond [`Register`].
pub trait Lane: Blend + Register<Factor = <Self as Lane>::Mapped, Expanded = <Self as Lane>::Mapped> {
    /// The factor type, which is the same for all mappings.
    type Mapped: Factor<Sum = Self::Full, Register = Self> + Copy;
    /// The sum type, which also has subtraction.
    type Full: Sum<Register = Self> + Sub<Output = Self::Full> + Copy;
    /// One step of a register. It is 0 in the ideal, which has no steps.
    const STEP: Self;
    /// Converts a byte without change.
    fn byte(value: u8) -> Self;
    /// Returns a texel channel. The definition takes the expanded byte (or two's complement value) `value`, the ideal
    /// takes `numerator / denominator`.
    fn texel(value: i32, numerator: i32, denominator: i32) -> Self;
    /// Converts a signed texel channel s to a register: 2s in the definition (TEX-18), s / 128 in the ideal.
    fn signed_texel(self) -> Self;
    /// Returns a weight in 256ths from the definition's integer and the ideal's real number.
    fn weight(fixed: i32, ideal: impl FnOnce() -> f64) -> Self::Weight;
    /// Returns a value in 255ths from the definition's integer and the ideal's real number.
    fn value(fixed: i32, ideal: impl FnOnce() -> f64) -> Self;
    /// Multiplies a register by a real factor and limits it to 0..255 (TSH-8). The definition takes the integer `fixed`
    /// instead.
    fn multiplied(self, fixed: i32, factor: impl FnOnce() -> f64) -> Self;
    /// Returns a value that depends on three registers (TEX-19). The definition takes the integer `fixed`, the ideal the function of its numbers.
    fn mixed(values: [Self; 3], fixed: i32, real: impl Fn([f64; 3]) -> f64) -> Self;
    /// Returns the factor half way between two registers, keeping the half bit (CMB-4=127.5).
    fn halfway(a: Self, b: Self) -> Self::Mapped;
    /// Returns the negation, saturated to a register (-256 becomes 255).
    fn negated(factor: Self::Mapped) -> Self::Mapped;
    /// Widens a register to a sum by multiplying with 255.
    fn widened(self) -> Self::Full;
    /// Returns half of a sum, rounded to the nearest 255th with halves up (CMB-9=after).
    fn rounded_half(sum: Self::Full) -> Self;
    /// Limits the value to 0..255.
    fn clamped(self) -> Self;
    /// Returns the smaller of two values.
    fn least(self, other: Self) -> Self;
    /// Returns the larger of two values.
    fn greatest(self, other: Self) -> Self;
    /// Returns the integer that decides at the mux, the alpha test and stores. The ideal rounds to nearest.
    fn decision(self) -> i32;
    /// Keeps the high bits that a surface stores: v >> shift << shift (ROP-5). The ideal keeps all.
    fn truncated(self, shift: u32) -> Self;
    /// Reads a byte as two's complement (ROP-3). The definition decides whether it is negative, which it is from 128
    /// up.
    fn signed_byte(self) -> Self {
        if self.decision() >= 128 { self - Self::value(256, || 256.0) } else { self }
    }
    /// Whether the lane takes decisions by its own numbers in places where the definition has separate integers: texels
    /// and depths.
    const DECIDES: bool = false;
    /// Returns the integer by which the ideal would decide, if the lane has an ideal.
    fn ideal_decision(self) -> i32 {
        self.decision()
    }
    /// Returns the depth that the test compares, from the definition's integer or the ideal's real number of steps of
    /// the buffer's last bit.
    fn depth(fixed: i64, _ideal: impl FnOnce() -> f64) -> i64 {
        fixed
    }
    /// Returns this texel channel, read from a surface for which the lane holds `memory`. `signed` is that of TEX-18.
    fn remember(self, _memory: Self, _signed: bool) -> Self {
        self
    }
    /// Records that a rule of `part` produced this value. Returns the value and, in lanes that attribute errors, the
    /// rule's own error.
    fn attributed(self, _part: Part) -> (Self, f64) {
        (self, 0.0)
    }
    /// Like [`attributed`](Self::attributed), for a factor.
    fn attributed_factor(factor: Self::Mapped, _part: Part) -> (Self::Mapped, f64) {
        (factor, 0.0)
    }
    /// Like [`attributed`](Self::attributed), for a weight in 256ths.
    fn attributed_weight(weight: Self::Weight, _part: Part) -> (Self::Weight, f64) {
        (weight, 0.0)
    }
    /// Returns the value that later rules start from, if the lane has both an integer and an ideal: with `real` the ideal and the integer
    /// next to it, otherwise the integer as both.
    fn settled(self, _real: bool) -> Self {
        self
    }
    /// Like [`settled`](Self::settled), for a factor.
    fn settled_factor(factor: Self::Mapped, _real: bool) -> Self::Mapped {
        factor
    }
    /// Like [`settled`](Self::settled), for a weight in 256ths.
    fn settled_weight(weight: Self::Weight, _real: bool) -> Self::Weight {
        weight
    }
    /// Returns the integer and, if the lane has one, the ideal, for observers.
    fn observe(self) -> (i64, Option<f64>);
    /// Returns a factor for observers, in halves of a step.
    fn observe_factor(factor: Self::Mapped) -> (i64, Option<f64>);
    /// Returns a sum for observers, in quarters of a product step.
    fn observe_sum(sum: Self::Full) -> (i64, Option<f64>);
    /// Returns a weight for observers.
    fn observe_weight(weight: Self::Weight) -> (i64, Option<f64>);
}

/// A lane of real numbers: the second half of [`Pair`].
pub trait Ideal:
    Lane<Mapped = Self, Full = Self>
    + Blend<Weight = Self>
    + Register<Factor = Self, Expanded = Self>
    + Factor<Sum = Self, Register = Self>
    + Sum<Register = Self>
{
    /// Whether a [`Pair`] lane reads texels where this ideal, and not the definition, finds them.
    const LEADS: bool = false;
    /// Converts a real number in this lane's unit.
    fn from_real(real: f64) -> Self;
    /// Returns the ideal's real number.
    fn real(self) -> f64;
    /// Records that a rule of `part` produced this value where the definition has `fixed`. Returns the value and the
    /// error of that rule alone, if the lane knows it.
    fn absorb(self, fixed: f64, part: Part) -> (Self, f64);
    /// Returns what a texture unit reads from a surface that holds this value, where the definition reads `fixed`.
    /// `signed` is that of TEX-18.
    fn remembered(self, fixed: i32, signed: bool) -> Self;
}
