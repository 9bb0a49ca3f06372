//! The ideal: `f64` in steps of 1/255, without rounding. Expansion is 2x - 1, one half is 127.5, and 5-bit channels are
//! v/31. `f32` follows the same text in single precision, from weights and coordinates in double precision.
#![allow(clippy::float_arithmetic, reason = "this lane is the real-number reference; it never feeds a stored byte")]

use super::{Blend, Factor, Ideal, Lane, Part, Register, Sum};
use crate::state::RegisterFloor;

/// Scale of the ideal's depths, which are kept in fractions of the buffer's last bit.
pub(super) const DEPTH_SCALE: f64 = 65536.0;

/// Implements the lane of a floating-point type.
macro_rules! real_lane {
    ($real:ident, $leads:literal) => {
        impl Blend for $real {
            type Weight = $real;
            const WHOLE: $real = 256.0;
            #[inline(always)]
            fn times(self, weight: $real) -> $real {
                self * weight
            }
            #[inline(always)]
            fn round8(self) -> $real {
                self / 256.0
            }
        }

        impl Register for $real {
            type Factor = $real;
            type Expanded = $real;
            const ZERO: $real = 0.0;
            const ONE: $real = 255.0;
            const HALF: $real = 127.5;
            #[inline(always)]
            fn max0(self) -> $real {
                self.max(0.0)
            }
            #[inline(always)]
            fn factor(self) -> $real {
                self
            }
            #[inline(always)]
            fn twice(self) -> $real {
                self * 2.0
            }
            #[inline(always)]
            fn halved(self) -> $real {
                self / 2.0
            }
            #[inline(always)]
            fn saturated(self, _floor: RegisterFloor) -> $real {
                self.clamp(-255.0, 255.0)
            }
        }

        impl Factor for $real {
            type Sum = $real;
            type Register = $real;
            #[inline(always)]
            fn product(self, other: $real) -> $real {
                self * other
            }
        }

        impl Sum for $real {
            type Register = $real;
            #[inline(always)]
            fn rounded(self) -> $real {
                self / 255.0
            }
        }

        impl Lane for $real {
            type Mapped = $real;
            type Full = $real;
            const STEP: $real = 0.0;
            #[inline(always)]
            fn byte(value: u8) -> $real {
                Self::from(value)
            }
            #[inline(always)]
            fn texel(_value: i32, numerator: i32, denominator: i32) -> $real {
                255.0 * numerator as $real / denominator as $real
            }
            #[inline(always)]
            fn signed_texel(self) -> $real {
                // `texel` has already scaled s/128.
                self
            }
            #[inline(always)]
            fn weight(_fixed: i32, ideal: impl FnOnce() -> f64) -> $real {
                ideal() as $real
            }
            #[inline(always)]
            fn value(_fixed: i32, ideal: impl FnOnce() -> f64) -> $real {
                ideal() as $real
            }
            #[inline(always)]
            fn multiplied(self, _fixed: i32, factor: impl FnOnce() -> f64) -> $real {
                (self * factor() as $real).clamp(0.0, 255.0)
            }
            #[inline(always)]
            fn mixed(values: [$real; 3], _fixed: i32, real: impl Fn([f64; 3]) -> f64) -> $real {
                real(values.map(Ideal::real)) as $real
            }
            #[inline(always)]
            fn halfway(a: $real, b: $real) -> $real {
                (a + b) / 2.0
            }
            #[inline(always)]
            fn negated(factor: $real) -> $real {
                -factor
            }
            #[inline(always)]
            fn widened(self) -> $real {
                self * 255.0
            }
            #[inline(always)]
            fn rounded_half(sum: $real) -> $real {
                sum / 510.0
            }
            #[inline(always)]
            fn clamped(self) -> $real {
                self.clamp(0.0, 255.0)
            }
            #[inline(always)]
            fn least(self, other: $real) -> $real {
                self.min(other)
            }
            #[inline(always)]
            fn greatest(self, other: $real) -> $real {
                self.max(other)
            }
            #[inline(always)]
            fn decision(self) -> i32 {
                (self + 0.5).floor() as i32
            }
            #[inline(always)]
            fn truncated(self, _shift: u32) -> $real {
                self
            }
            const DECIDES: bool = true;
            fn depth(_fixed: i64, ideal: impl FnOnce() -> f64) -> i64 {
                (ideal() * DEPTH_SCALE).floor() as i64
            }
            fn remember(self, memory: $real, signed: bool) -> $real {
                memory.remembered(if memory.decision() >= 128 { -1 } else { 0 }, signed)
            }
            fn observe(self) -> (i64, Option<f64>) {
                (i64::from(self.decision()), Some(self.into()))
            }
            fn observe_factor(factor: $real) -> (i64, Option<f64>) {
                (i64::from((factor * 2.0).decision()), Some(factor.into()))
            }
            fn observe_sum(sum: $real) -> (i64, Option<f64>) {
                (i64::from((sum * 4.0).decision()), Some(sum.into()))
            }
            fn observe_weight(weight: $real) -> (i64, Option<f64>) {
                (i64::from(weight.decision()), Some(weight.into()))
            }
        }

        impl Ideal for $real {
            const LEADS: bool = $leads;
            #[inline(always)]
            fn from_real(real: f64) -> $real {
                real as $real
            }
            #[inline(always)]
            fn real(self) -> f64 {
                self.into()
            }
            #[inline(always)]
            fn absorb(self, _fixed: f64, _part: Part) -> (Self, f64) {
                (self, 0.0)
            }
            #[inline(always)]
            fn remembered(self, fixed: i32, signed: bool) -> $real {
                match (signed, fixed < 0) {
                    (false, _) => self,
                    (true, true) => (self - 256.0) * 255.0 / 128.0,
                    (true, false) => self * 255.0 / 128.0,
                }
            }
        }
    };
}

real_lane!(f64, false);
real_lane!(f32, true);
