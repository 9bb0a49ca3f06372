//! Numbers of the interpolator: a mantissa of at most 63 bits and a power of two. Nothing is rounded but where a method says so.

use crate::number::convert::{align, shift, split};
use std::cmp::Ordering;

/// The number `mantissa` * 2^`exponent`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Binary {
    /// Signed mantissa of at most 63 bits.
    pub mantissa: i64,
    /// Power of two that scales the mantissa.
    pub exponent: i32,
}

impl Binary {
    /// The number 1.
    pub const ONE: Binary = Binary { mantissa: 1, exponent: 0 };

    /// Converts a finite number exactly.
    #[inline(always)]
    pub fn new(n: f32) -> Binary {
        let (mantissa, exponent) = split(n);
        Binary { mantissa, exponent }
    }

    /// Converts a finite double exactly; subnormal ones are 0.
    pub(crate) fn from_double(n: f64) -> Binary {
        let bits = n.to_bits();
        let exponent = (bits >> 52 & 0x7ff) as i32;
        if exponent == 0 {
            return Binary::default();
        }
        let mantissa = (bits & ((1 << 52) - 1) | 1 << 52) as i64;
        Binary { mantissa: if bits >> 63 == 1 { -mantissa } else { mantissa }, exponent: exponent - 1075 }
    }

    /// Returns the number of the bit above the highest, or the least for 0.
    #[inline(always)]
    pub(crate) fn top(self) -> i32 {
        if self.mantissa == 0 { i32::MIN } else { bits(self.mantissa) + self.exponent }
    }

    /// Returns the number toward zero to its first `bits` significant bits.
    #[inline(always)]
    pub fn first_bits(self, kept: i32) -> Binary {
        let dropped = (bits(self.mantissa) - kept).max(0);
        Binary { mantissa: toward_zero(self.mantissa, dropped), exponent: self.exponent + dropped }
    }

    /// Returns the number in steps of 2^`unit`, toward zero. It must fit.
    #[inline(always)]
    pub(crate) fn steps(self, unit: i32) -> i64 {
        match self.exponent - unit {
            // A zero may have any exponent.
            up if up >= 0 => self.mantissa << up.min(63),
            down => toward_zero(self.mantissa, -down),
        }
    }

    /// Returns the negative of the number.
    #[inline(always)]
    pub(crate) fn negated(self) -> Binary {
        Binary { mantissa: -self.mantissa, ..self }
    }

    /// Returns the number times a power of two.
    #[inline(always)]
    pub(crate) fn scaled(self, power: i32) -> Binary {
        Binary { exponent: self.exponent + power, ..self }
    }

    /// Compares magnitudes.
    pub(crate) fn compare_magnitude(self, other: Binary) -> Ordering {
        let (a, b) = (self.mantissa.unsigned_abs(), other.mantissa.unsigned_abs());
        // Both with the highest bit at the same place.
        let high = |n: u64| if n == 0 { 0 } else { n << n.leading_zeros() };
        self.top().cmp(&other.top()).then(high(a).cmp(&high(b)))
    }

    /// Returns the sum. Where the larger number's first `bits` bits, at most 62, do not hold it, it is the odd one of its two neighbours: shorter
    /// numbers are less or greater than that as they are than the sum, and cutting yields the same.
    pub fn plus(self, other: Binary, bits: i32) -> Binary {
        let ([a, b], exponent) = align([(self.mantissa, self.exponent), (other.mantissa, other.exponent)], bits);
        let lost = [self, other].iter().any(|n| {
            let dropped = exponent.saturating_sub(n.exponent);
            n.mantissa != 0 && (n.mantissa.trailing_zeros() as i32) < dropped
        });
        Binary { mantissa: (a + b) | i64::from(lost), exponent }
    }

    /// Returns whether it is less than another.
    pub fn is_below(self, other: Binary) -> bool {
        let least = self.exponent.min(other.exponent);
        // A number that is shifted by 64 is larger than any mantissa.
        let up = |n: Binary| i128::from(n.mantissa) << (n.exponent - least).min(64);
        up(self) < up(other)
    }

    /// Returns floor(`scale` * self * 2^`power`), limited to `limit` in magnitude. The product of mantissa and scale must fit into 62 bits.
    #[inline(always)]
    pub fn floored(self, scale: u32, power: i32, limit: i64) -> i64 {
        let (product, exponent) = (self.mantissa * i64::from(scale), self.exponent + power);
        let floor = match exponent {
            ..=0 => product >> (-exponent).min(63),
            up if bits(product) + up > 62 => return product.signum() * limit,
            up => product << up,
        };
        floor.clamp(-limit, limit)
    }

    /// Returns floor(`scale` * self / `by` * 2^`power`), exactly, limited to `limit` in magnitude. The product of mantissa and scale must fit into
    /// 62 bits, and `by` must not be 0.
    #[inline(always)]
    pub fn floored_ratio(self, by: Binary, scale: u32, power: i32, limit: i64) -> i64 {
        let sign = by.mantissa.signum();
        let (n, d) = (self.mantissa * i64::from(scale) * sign, by.mantissa * sign);
        let exponent = self.exponent - by.exponent + power;
        let (above, below) = (bits(n), bits(d));
        if n == 0 {
            return 0;
        }
        // The quotient is at least 2^(above - below - 1 + exponent), and less than 2 times 2^(above - below + exponent).
        if above - below - 1 + exponent >= 62 {
            return n.signum() * limit;
        }
        let floor = if exponent < 0 {
            // A floor of 0 or -1 stays one.
            let down = (-exponent).min(above - below + 2).max(0);
            n.div_euclid(d << down)
        } else if above + exponent <= 62 {
            (n << exponent).div_euclid(d)
        } else {
            far_quotient(n, d, exponent)
        };
        floor.clamp(-limit, limit)
    }

    /// Returns floor(`scale` * (self + `other`) * 2^`power`), exactly, limited to `limit` in magnitude. The products of mantissas and scale must fit
    /// into 48 bits.
    pub fn floored_sum(self, other: Binary, scale: u32, power: i32, limit: i64) -> i64 {
        let scaled = |n: Binary| (n.mantissa * i64::from(scale), n.exponent);
        let (a, b) = (scaled(self), scaled(other));
        // A zero must not decide where the other number is truncated.
        let ((high, high_at), (low, low_at)) = if b.0 == 0 || (a.0 != 0 && a.1 >= b.1) { (a, b) } else { (b, a) };
        // If the exponents differ by more than this, the lower number is less than 2^-28 of the higher one, so they cannot
        // cancel. Where the truncation at 2^(high_at - 76) is not below a step, the sum is beyond 2^43 of them.
        let gap = (high_at - low_at).clamp(0, 76);
        let sum = (i128::from(high) << gap) + shift(i128::from(low), low_at - (high_at - gap));
        let at = high_at - gap + power;
        let floor = if at <= 0 {
            shift(sum, at)
        } else {
            // Beyond 2^60 only the sign matters.
            let fits = at < 72 && sum.unsigned_abs() < 1 << (72 - at);
            if fits { sum << at } else { sum.signum() << 72 }
        };
        floor.clamp((-limit).into(), limit.into()) as i64
    }

    /// Returns the ratio to another number, toward zero to 36 bits or some more, or 0 if it is not positive. A positive number divided by 0 yields
    /// more than every depth.
    pub(crate) fn positive_ratio(self, by: Binary) -> Binary {
        let (n, d) = (self.mantissa.unsigned_abs(), by.mantissa.unsigned_abs());
        if n == 0 || d == 0 || (self.mantissa < 0) != (by.mantissa < 0) {
            return if self.mantissa > 0 && d == 0 {
                Binary { mantissa: 1, exponent: 1000 }
            } else {
                Binary::default()
            };
        }
        let up = n.leading_zeros().saturating_sub(2);
        Binary { mantissa: ((n << up) / d) as i64, exponent: self.exponent - up as i32 - by.exponent }
    }

    /// Returns the nearest single-precision number, with ties to even. Too large values become infinite, and zero is positive. The mantissa must
    /// have at most 53 bits, and the exponent must be that of a double.
    pub fn nearest_f32(self) -> f32 {
        if self.mantissa == 0 {
            return 0.0;
        }
        let double = (self.mantissa as f64).to_bits();
        f64::from_bits(double.wrapping_add_signed(i64::from(self.exponent) << 52)) as f32
    }
}

/// Returns floor(n / d * 2^exponent) if it has more than 62 bits with the numerator, but is less than 2^63.
#[cold]
fn far_quotient(n: i64, d: i64, exponent: i32) -> i64 {
    (i128::from(n) << exponent).div_euclid(d.into()) as i64
}

/// Returns the number of significant bits.
#[inline(always)]
fn bits(n: i64) -> i32 {
    64 - n.unsigned_abs().leading_zeros() as i32
}

/// Returns n without its last bits, toward zero.
#[inline(always)]
fn toward_zero(n: i64, dropped: i32) -> i64 {
    let magnitude = (n.unsigned_abs() >> dropped.min(63)) as i64;
    if n < 0 { -magnitude } else { magnitude }
}
