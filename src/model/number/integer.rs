//! Whole numbers without an overflow: the text of rules over [`Integer`] runs in machine numbers, and can be read where rules are printed.

use crate::state::CompareFunction;
use std::ops::{Add, BitAnd, BitOr, BitXor, Mul, Not, Sub};

/// Truth of a comparison: `bool`, or a symbolic value where rules are printed.
pub trait Choice:
    Copy + BitAnd<Output = Self> + BitOr<Output = Self> + BitXor<Output = Self> + Not<Output = Self>
{
}

impl Choice for bool {}

/// A whole number of at most 63 bits and a sign. There are no branches: a choice takes one of two numbers that both exist.
pub trait Integer: Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> {
    /// Truth of a comparison.
    type Choice: Choice;

    /// Returns a constant.
    fn new(value: i64) -> Self;
    /// Returns the number of significant bits of the magnitude.
    fn bits(self) -> Self;
    /// Returns the number times 2^`by`, for 0 to 63. What does not fit is not used.
    fn up(self, by: Self) -> Self;
    /// Returns the floor of the number over 2^`by`, for 0 to 63.
    fn down(self, by: Self) -> Self;
    /// Returns the bits of the number in two's complement that `mask` has.
    fn masked(self, mask: i64) -> Self;
    /// Returns the remainder of a division by a positive number, which is not negative. A number that is not constant must be a power of two.
    fn modulo(self, by: Self) -> Self;
    /// Returns the floor of a quotient. This number must not be negative, and `by` is positive.
    fn quotient(self, by: Self) -> Self;
    /// Compares two numbers, of which this is on the left.
    fn compared(self, function: CompareFunction, other: Self) -> Self::Choice;
    /// Returns this number where `choice` holds, otherwise the other.
    fn or(self, choice: Self::Choice, other: Self) -> Self;
    /// Returns entry `self` of a table.
    fn entry(self, table: &'static [u8]) -> Self;
    /// Returns the floor of the root of a number of at most 60 bits that is not negative.
    fn root(self) -> Self;

    /// Returns the floor of the number times 2^`by`, for -63 to 63; less or more is as these.
    #[inline(always)]
    fn shifted(self, by: Self) -> Self {
        shift(self, by)
    }
    /// Returns mantissa and exponent of the finite binary32 number that has these bits: 24 bits, or 0.
    #[inline(always)]
    fn split(self) -> (Self, Self) {
        split_bits(self)
    }
    /// Returns the bits of the binary32 number nearest to this number, of at most 61 bits, times 2^`exponent`. Zero is positive, and too large numbers
    /// are infinite.
    #[inline(always)]
    fn rounded(self, exponent: Self) -> Self {
        round_bits(self, exponent)
    }
    /// Returns the number, which is known to be within these bounds.
    #[inline(always)]
    fn within(self, _low: i64, _high: i64) -> Self {
        self
    }
    /// Returns the smaller of two numbers.
    #[inline(always)]
    fn least(self, other: Self) -> Self {
        self.or(self.is_below(other), other)
    }
    /// Returns the larger of two numbers.
    #[inline(always)]
    fn greatest(self, other: Self) -> Self {
        other.or(self.is_below(other), self)
    }
    /// Limits the number.
    #[inline(always)]
    fn limited(self, low: i64, high: i64) -> Self {
        self.least(Self::new(high)).greatest(Self::new(low))
    }
    /// Returns whether this number is less than the other.
    #[inline(always)]
    fn is_below(self, other: Self) -> Self::Choice {
        self.compared(CompareFunction::Less, other)
    }
    /// Returns whether this number is negative.
    #[inline(always)]
    fn is_negative(self) -> Self::Choice {
        self.is_below(Self::new(0))
    }
    /// Returns whether this number is 0.
    #[inline(always)]
    fn is_zero(self) -> Self::Choice {
        self.compared(CompareFunction::Equal, Self::new(0))
    }
    /// Returns the negative where `choice` holds, otherwise the number itself.
    #[inline(always)]
    fn negated(self, choice: Self::Choice) -> Self {
        (Self::new(0) - self).or(choice, self)
    }
    /// Returns the magnitude.
    #[inline(always)]
    fn magnitude(self) -> Self {
        self.greatest(Self::new(0) - self)
    }
}

/// Returns the floor of the root of a number of at most 60 bits that is not negative: five steps of Newton's method, each of which squares half of the
/// error, from a power of two that is at most twice the root.
pub fn newton_root<I: Integer>(n: I) -> I {
    let one = I::new(1);
    let mut root = one.up((n.bits() + one).down(one)).within(1, 1 << 30);
    for _ in 0..5 {
        root = (root + n.quotient(root)).down(one).greatest(one).within(1, 1 << 30);
    }
    // It is never below the floor, and at most 1 above.
    root - one.or(n.is_below(root * root), I::new(0))
}

/// Returns floor(n 2^`by`), for -63 to 63; less or more is as these.
#[inline(always)]
pub fn shift<I: Integer>(n: I, by: I) -> I {
    let up = by.limited(-63, 63);
    n.down((I::new(0) - up).greatest(I::new(0))).or(up.is_negative(), n.up(up.greatest(I::new(0))))
}

/// Number of the bit above the highest of 0: below that of all other numbers.
pub(crate) const LEAST_TOP: i64 = -4096;

/// Returns mantissa and exponent of the finite binary32 number that has these bits: 24 bits, or 0.
#[inline(always)]
pub fn split_bits<I: Integer>(bits: I) -> (I, I) {
    let (field, fraction) = (bits.down(I::new(23)).masked(255), bits.masked((1 << 23) - 1));
    // A subnormal number has the exponent of the least normal one.
    let mantissa = fraction + I::new(0).or(field.is_zero(), I::new(1 << 23));
    let exponent = field.greatest(I::new(1)) - I::new(150);
    let up = I::new(24) - mantissa.bits();
    let exponent = I::new(LEAST_TOP).or(mantissa.is_zero(), exponent - up);
    let mantissa = mantissa.up(up).within(0, (1 << 24) - 1);
    (mantissa.negated(!bits.down(I::new(31)).is_zero()), exponent)
}

/// Returns the bits of the binary32 number nearest to n 2^`exponent`, with ties to even. Zero is positive, and too large numbers are infinite.
pub fn round_bits<I: Integer>(n: I, exponent: I) -> I {
    let (zero, one, bits) = (I::new(0), I::new(1), 24);
    let mantissa = n.magnitude();
    // The last bit of the smallest numbers is 2^-149.
    let last = (exponent + mantissa.bits() - I::new(bits)).greatest(I::new(-149));
    let dropped = last - exponent;
    let (down, up) = (dropped.limited(0, 62), (zero - dropped).limited(0, bits - 1));
    // Half of the last bit rounds up what is above it, and it itself if that makes the last bit 0.
    let half = one.up(down).down(one);
    let odd = mantissa.down(down).masked(1);
    let significant = (mantissa + (half - one + odd).greatest(zero)).down(down).up(up).within(0, 1 << bits);
    // The leading bit, which is not stored, counts as one step of the exponent, as a carry into the next bit does.
    let field = last.least(I::new(200)) + I::new(150);
    let pattern = (field.up(I::new(bits - 1)) + significant - I::new(1 << (bits - 1))).limited(0, 0x7f80_0000);
    zero.or(n.is_zero(), pattern + I::new(1 << 31).or(n.is_negative(), zero))
}

/// Converts numbers, each a mantissa and an exponent, to block floating point. The number of the largest magnitude
/// keeps exactly `keep` bits (at most 62), and the others are floored to the same exponent. Returns the mantissas and
/// that exponent.
#[inline(always)]
pub(crate) fn align<I: Integer, const N: usize>(values: [(I, I); N], keep: i64) -> ([I; N], I) {
    let least = I::new(LEAST_TOP);
    let mut top = least;
    for (n, exponent) in values {
        top = top.greatest(least.or(n.is_zero(), n.bits() + exponent));
    }
    let top = top.or(least.is_below(top), I::new(0));
    let aligned = values.map(|(n, exponent)| {
        // A number other than 0 that is shifted up stays within `keep` bits.
        n.shifted(exponent + I::new(keep) - top)
    });
    (aligned, top - I::new(keep))
}

/// Implements the operations of machine numbers.
macro_rules! machine {
    ($($type:ident)+) => { $(
        impl Integer for $type {
            type Choice = bool;
            #[inline(always)]
            fn new(value: i64) -> $type {
                value as $type
            }
            #[inline(always)]
            fn bits(self) -> $type {
                ($type::BITS - self.unsigned_abs().leading_zeros()) as $type
            }
            #[inline(always)]
            fn up(self, by: $type) -> $type {
                self << by
            }
            #[inline(always)]
            fn down(self, by: $type) -> $type {
                self >> by
            }
            #[inline(always)]
            fn masked(self, mask: i64) -> $type {
                self & mask as $type
            }
            #[inline(always)]
            fn modulo(self, by: $type) -> $type {
                if by & (by - 1) == 0 { self & (by - 1) } else { self.rem_euclid(by) }
            }
            #[inline(always)]
            fn quotient(self, by: $type) -> $type {
                self / by
            }
            #[inline(always)]
            fn compared(self, function: CompareFunction, other: $type) -> bool {
                function.passes(self, other)
            }
            #[inline(always)]
            fn or(self, choice: bool, other: $type) -> $type {
                if choice { self } else { other }
            }
            #[inline(always)]
            fn entry(self, table: &'static [u8]) -> $type {
                table[self as usize].into()
            }
            #[inline(always)]
            fn root(self) -> $type {
                self.isqrt()
            }
            #[inline(always)]
            fn within(self, low: i64, high: i64) -> $type {
                debug_assert!((low..=high).contains(&(self as i64)), "{self} is not within {low} and {high}");
                self
            }
            #[inline(always)]
            fn least(self, other: $type) -> $type {
                self.min(other)
            }
            #[inline(always)]
            fn greatest(self, other: $type) -> $type {
                self.max(other)
            }
            #[inline(always)]
            fn magnitude(self) -> $type {
                self.abs()
            }
        }
    )+ };
}

machine!(i32 i64);

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;

    #[test]
    fn roots_are_floors() {
        let mut random = Random::seeded(1);
        let near = |n: i64| [n * n - 1, n * n, n * n + 1, n * (n + 2)];
        let squares = (0..1 << 16).chain((1 << 30) - 1000..1 << 30).flat_map(near).filter(|n| *n >= 0);
        let any = std::iter::repeat_with(|| random.bits() as i64 >> (4 + random.below(60)) & i64::MAX >> 3);
        for n in squares.chain(any.take(400_000)) {
            assert_eq!(newton_root(n), n.isqrt(), "{n}");
        }
    }
}
