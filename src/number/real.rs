//! The ideal: `f64` in steps of 1/255, nothing rounded. 2x - 1, one half is 127.5, 5-bit channels are v/31.
#![allow(clippy::float_arithmetic, reason = "this lane is the real-number reference; it never feeds a stored byte")]

use super::{Blend, Factor, Ideal, Lane, Register, Sum};
use crate::state::RegisterFloor;
use crate::trace::Part;

impl Blend for f64 {
    type Weight = f64;
    const WHOLE: f64 = 256.0;
    #[inline(always)]
    fn times(self, weight: f64) -> f64 {
        self * weight
    }
    #[inline(always)]
    fn round8(self) -> f64 {
        self / 256.0
    }
}

impl Register for f64 {
    type Factor = f64;
    type Expanded = f64;
    const ZERO: f64 = 0.0;
    const ONE: f64 = 255.0;
    const HALF: f64 = 127.5;
    #[inline(always)]
    fn max0(self) -> f64 {
        self.max(0.0)
    }
    #[inline(always)]
    fn factor(self) -> f64 {
        self
    }
    #[inline(always)]
    fn twice(self) -> f64 {
        self * 2.0
    }
    #[inline(always)]
    fn halved(self) -> f64 {
        self / 2.0
    }
    #[inline(always)]
    fn saturated(self, _floor: RegisterFloor) -> f64 {
        self.clamp(-255.0, 255.0)
    }
}

impl Factor for f64 {
    type Sum = f64;
    type Register = f64;
    #[inline(always)]
    fn product(self, other: f64) -> f64 {
        self * other
    }
}

impl Sum for f64 {
    type Register = f64;
    #[inline(always)]
    fn rounded(self) -> f64 {
        self / 255.0
    }
}

impl Lane for f64 {
    type Mapped = f64;
    type Full = f64;
    const STEP: f64 = 0.0;
    #[inline(always)]
    fn byte(value: u8) -> f64 {
        f64::from(value)
    }
    #[inline(always)]
    fn texel(_value: i32, numerator: i32, denominator: i32) -> f64 {
        255.0 * f64::from(numerator) / f64::from(denominator)
    }
    #[inline(always)]
    fn signed_texel(self) -> f64 {
        // `texel` has already scaled s/128.
        self
    }
    #[inline(always)]
    fn weight(_fixed: i32, ideal: impl FnOnce() -> f64) -> f64 {
        ideal()
    }
    #[inline(always)]
    fn value(_fixed: i32, ideal: impl FnOnce() -> f64) -> f64 {
        ideal()
    }
    #[inline(always)]
    fn multiplied(self, _fixed: i32, factor: impl FnOnce() -> f64) -> f64 {
        (self * factor()).clamp(0.0, 255.0)
    }
    #[inline(always)]
    fn halfway(a: f64, b: f64) -> f64 {
        (a + b) / 2.0
    }
    #[inline(always)]
    fn negated(factor: f64) -> f64 {
        -factor
    }
    #[inline(always)]
    fn widened(self) -> f64 {
        self * 255.0
    }
    #[inline(always)]
    fn rounded_half(sum: f64) -> f64 {
        sum / 510.0
    }
    #[inline(always)]
    fn clamped(self) -> f64 {
        self.clamp(0.0, 255.0)
    }
    #[inline(always)]
    fn least(self, other: f64) -> f64 {
        self.min(other)
    }
    #[inline(always)]
    fn greatest(self, other: f64) -> f64 {
        self.max(other)
    }
    #[inline(always)]
    fn decision(self) -> i32 {
        (self + 0.5).floor() as i32
    }
    #[inline(always)]
    fn truncated(self, _shift: u32) -> f64 {
        self
    }
    const DECIDES: bool = true;
    fn depth(_fixed: i64, ideal: impl FnOnce() -> f64) -> i64 {
        (ideal() * DEPTH_SCALE).floor() as i64
    }
    fn remember(self, memory: f64, signed: bool) -> f64 {
        memory.remembered(if memory.decision() >= 128 { -1 } else { 0 }, signed)
    }
    fn observe(self) -> (i64, Option<f64>) {
        (i64::from(self.decision()), Some(self))
    }
    fn observe_factor(factor: f64) -> (i64, Option<f64>) {
        (i64::from((factor * 2.0).decision()), Some(factor))
    }
    fn observe_sum(sum: f64) -> (i64, Option<f64>) {
        (i64::from((sum * 4.0).decision()), Some(sum))
    }
    fn observe_weight(weight: f64) -> (i64, Option<f64>) {
        (i64::from(weight.decision()), Some(weight))
    }
}

/// The ideal's depths are kept in parts of the buffer's last bit.
pub(super) const DEPTH_SCALE: f64 = 65536.0;

impl Ideal for f64 {
    #[inline(always)]
    fn of(real: f64) -> f64 {
        real
    }
    #[inline(always)]
    fn real(self) -> f64 {
        self
    }
    #[inline(always)]
    fn absorb(self, _fixed: f64, _part: Part) -> (f64, f64) {
        (self, 0.0)
    }
    #[inline(always)]
    fn remembered(self, fixed: i32, signed: bool) -> f64 {
        match (signed, fixed < 0) {
            (false, _) => self,
            (true, true) => (self - 256.0) * 255.0 / 128.0,
            (true, false) => self * 255.0 / 128.0,
        }
    }
}
