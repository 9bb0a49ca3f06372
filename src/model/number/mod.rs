//! The numbers of the chip, and the traits by which one text of a rule serves every evaluation.
//!
//! A *lane* is the type a rule is evaluated in. The rules in [`raster`](crate::raster), [`texture`](crate::texture),
//! [`combiner`](crate::combiner) and [`rop`](crate::rop) are free functions over the traits of this module; what differs between
//! evaluations (rounding, width, the size of one half) sits in the lane and nowhere else.
//!
//! | lane | is | used by |
//! |---|---|---|
//! | `i32` | the definition | the scalar engine |
//! | [`Paired`] | the definition and the ideal side by side; the definition takes every decision | traces |
//! | `f64` | the ideal: the vendor's real-number text, nothing rounded | comparisons, the second half of [`Paired`] |
//! | [`Paired`] of [`IdealTracks`] | the definition and several ideals, which tell the errors of the rules apart | comparisons |
//! | `i16`, `u16` | the definition in 16 bits, for loops over blocks of pixels | the fast engine |
//! | [`Narrow`] | `i16` whose expanded products stay in 16 bits | the fast engine |
//! | [`Lanes16`] of `i32` | sixteen of the definition side by side | sweeps of vectors |
//! | [`Swar2`] | two 8-bit channels in one word | the fast engine's filter |
//!
//! All lanes count in steps of 1/255 (NUM-1): 1.0 is 255.

/// Sums of numbers that are wrapped in a structure, by an operation on what it holds.
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

/// Methods of a type of several numbers that act on each of them alone: by its `map`, or on those of two by its `zip`.
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

mod block;
pub mod convert;
mod ideal_tracks;
mod lanes16;
pub mod light;
mod paired;
mod part;
mod real;
mod scalar;

pub use block::{Halved, Narrow, Quarter, Swar2, byte_product};
pub use ideal_tracks::{IDEAL_TRACKS, IdealTracks};
pub use lanes16::{LANES, Lanes16};
pub use paired::{Paired, PairedFactor, PairedSum};
pub use part::Part;
pub use scalar::{Halves, Quarters};

use crate::state::RegisterFloor;
use std::ops::{Add, BitAnd, BitOr, Mul, Shl, Shr, Sub};

/// The bits of a stored word or of a texel: `u32`, or what stands for one where rules are printed. Nothing wraps: what is shifted out is not asked for, and
/// products stay below 2^32.
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

/// A value that is mixed by weights of 256ths: interpolated colours and filtered texels.
pub trait Blend: Copy + Add<Output = Self> {
    /// A weight, 0 to 256.
    type Weight: Copy + Sub<Output = Self::Weight>;
    /// The weight of 1.0: 256.
    const WHOLE: Self::Weight;
    /// Product with a weight; nothing is rounded.
    fn times(self, weight: Self::Weight) -> Self;
    /// Back from 256ths: (x + 128) >> 8.
    fn round8(self) -> Self;
}

/// A 9-bit combiner register, or a byte of the raster operations, in steps of 1/255.
pub trait Register: Copy + Add<Output = Self> + Sub<Output = Self> {
    /// What a mapping yields: a factor of a product.
    type Factor: Factor<Register = Self>;
    /// What the expand mappings yield: a [`Factor`](Self::Factor), or a narrower lane that knows it is even.
    type Expanded: Factor<Register = Self>;
    /// The register value 0.
    const ZERO: Self;
    /// The register value of 1.0: 255.
    const ONE: Self;
    /// One half: 128 (CMB-3, CMB-4, CMB-9); 127.5 in the ideal.
    const HALF: Self;
    /// max(0, x), as unsigned mappings begin.
    fn max0(self) -> Self;
    /// The value itself as a factor.
    fn factor(self) -> Self::Factor;
    /// Twice the value as a factor, exactly.
    fn twice(self) -> Self::Expanded;
    /// (x + 1) >> 1: the output scale one half.
    fn halved(self) -> Self;
    /// NUM-3: limited to what a register holds.
    fn saturated(self, floor: RegisterFloor) -> Self;
}

/// A factor of a combiner product: a register after its input mapping.
pub trait Factor: Copy {
    /// Holds sums of products.
    type Sum: Sum<Register = Self::Register>;
    /// The register that receives the result.
    type Register;
    /// The full-width product; nothing is rounded.
    fn product(self, other: Self) -> Self::Sum;
}

/// A sum of full-width products, in steps of 1/65025.
pub trait Sum: Copy + Add<Output = Self> {
    /// The register that receives the result.
    type Register;
    /// NUM-2: the nearest 255th, not saturated.
    fn rounded(self) -> Self::Register;
}

/// What the policies' alternatives, the final combiner and the raster operations need beyond [`Register`].
pub trait Lane: Blend + Register<Factor = <Self as Lane>::Mapped, Expanded = <Self as Lane>::Mapped> {
    /// The factor type, whatever the mapping.
    type Mapped: Factor<Sum = Self::Full, Register = Self> + Copy;
    /// The sum type, with subtraction.
    type Full: Sum<Register = Self> + Sub<Output = Self::Full> + Copy;
    /// One step of a register; 0 in the ideal, which has none.
    const STEP: Self;
    /// A byte as it is.
    fn byte(value: u8) -> Self;
    /// A texel channel: the expanded byte (or two's complement value) of the definition; `numerator / denominator` of the ideal.
    fn texel(value: i32, numerator: i32, denominator: i32) -> Self;
    /// A signed texel channel s as a register: 2s (TEX-18); s / 128 in the ideal.
    fn signed_texel(self) -> Self;
    /// A weight, from the definition's integer and the ideal's real number of 256ths.
    fn weight(fixed: i32, ideal: impl FnOnce() -> f64) -> Self::Weight;
    /// A value from the definition's integer and the ideal's real number of 255ths.
    fn value(fixed: i32, ideal: impl FnOnce() -> f64) -> Self;
    /// A register times a real factor, limited to 0..255 (TSH-8): the definition's integer is `fixed`.
    fn multiplied(self, fixed: i32, factor: impl FnOnce() -> f64) -> Self;
    /// The factor half way between two registers, the half bit kept (CMB-4=127.5).
    fn halfway(a: Self, b: Self) -> Self::Mapped;
    /// The negation, saturated to a register (-256 becomes 255).
    fn negated(factor: Self::Mapped) -> Self::Mapped;
    /// A register taken to the width of a sum, times 255.
    fn widened(self) -> Self::Full;
    /// Half of a sum, rounded to the nearest 255th, halves up (CMB-9=after).
    fn rounded_half(sum: Self::Full) -> Self;
    /// Limited to 0..255.
    fn clamped(self) -> Self;
    /// The smaller of both.
    fn least(self, other: Self) -> Self;
    /// The larger of both.
    fn greatest(self, other: Self) -> Self;
    /// The integer that takes decisions: mux, alpha test, stores. The ideal rounds to nearest.
    fn decision(self) -> i32;
    /// The high bits that a surface keeps: v >> shift << shift (ROP-5); the ideal keeps all.
    fn truncated(self, shift: u32) -> Self;
    /// A byte read as two's complement (ROP-3): 128 and more are negative. The definition says which.
    fn signed_byte(self) -> Self {
        if self.decision() >= 128 { self - Self::value(256, || 256.0) } else { self }
    }
    /// Whether the lane decides by its own numbers where the definition has integers of its own: texels, depth.
    const DECIDES: bool = false;
    /// What the ideal would decide by, where the lane has one.
    fn ideal_decision(self) -> i32 {
        self.decision()
    }
    /// A depth as it is tested, from the definition's integer and the ideal's real number of the buffer's last bits.
    fn depth(fixed: i64, _ideal: impl FnOnce() -> f64) -> i64 {
        fixed
    }
    /// This texel channel, read from a surface of which the lane holds `memory`; `signed` as in TEX-18.
    fn remember(self, _memory: Self, _signed: bool) -> Self {
        self
    }
    /// A rule of `part` has yielded this value: its own error, in lanes that tell errors apart.
    fn attributed(self, _part: Part) -> (Self, f64) {
        (self, 0.0)
    }
    /// [`attributed`](Self::attributed) for a factor.
    fn attributed_factor(factor: Self::Mapped, _part: Part) -> (Self::Mapped, f64) {
        (factor, 0.0)
    }
    /// [`attributed`](Self::attributed) for a weight, in 256ths.
    fn attributed_weight(weight: Self::Weight, _part: Part) -> (Self::Weight, f64) {
        (weight, 0.0)
    }
    /// The integer and, where the lane has one, the ideal, for observers.
    fn observe(self) -> (i64, Option<f64>);
    /// A factor for observers, in halves of a step.
    fn observe_factor(factor: Self::Mapped) -> (i64, Option<f64>);
    /// A sum for observers, in quarters of a product step.
    fn observe_sum(sum: Self::Full) -> (i64, Option<f64>);
    /// A weight for observers.
    fn observe_weight(weight: Self::Weight) -> (i64, Option<f64>);
}

/// A lane of real numbers: the second half of [`Paired`].
pub trait Ideal:
    Lane<Mapped = Self, Full = Self>
    + Blend<Weight = Self>
    + Register<Factor = Self, Expanded = Self>
    + Factor<Sum = Self, Register = Self>
    + Sum<Register = Self>
{
    /// A real number of this lane's unit.
    fn from_real(real: f64) -> Self;
    /// The ideal's real number.
    fn real(self) -> f64;
    /// A rule of `part` has yielded this where the definition has `fixed`: the error of that rule alone, if the lane knows it.
    fn absorb(self, fixed: f64, part: Part) -> (Self, f64);
    /// What a texture unit reads of a surface that holds this, the definition reading `fixed` (TEX-18 if signed).
    fn remembered(self, fixed: i32, signed: bool) -> Self;
}
