//! Numbers of the interpolator: a mantissa of at most 63 bits and a power of two. Nothing is rounded but where a method says so.

use crate::number::{Integer, LEAST_TOP, align};
use crate::state::CompareFunction;

/// The number `mantissa` * 2^`exponent`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Binary<I = i64> {
    /// Signed mantissa of at most 63 bits.
    pub mantissa: I,
    /// Power of two that scales the mantissa.
    pub exponent: I,
}

impl Binary {
    /// The number 1, normal.
    pub const ONE: Binary = Binary { mantissa: 1 << 23, exponent: -23 };

    /// Converts a finite number exactly. It is [normal](Binary::first_bits).
    #[inline(always)]
    pub fn new(n: f32) -> Binary {
        Binary::from_bits(n.to_bits().into())
    }

    /// Converts a finite double exactly; subnormal ones are 0.
    pub(crate) fn from_double(n: f64) -> Binary {
        let bits = n.to_bits();
        let exponent = (bits >> 52 & 0x7ff) as i64;
        if exponent == 0 {
            return Binary::default();
        }
        let mantissa = (bits & ((1 << 52) - 1) | 1 << 52) as i64;
        Binary { mantissa: if bits >> 63 == 1 { -mantissa } else { mantissa }, exponent: exponent - 1075 }
    }

    /// Returns the nearest single-precision number, with ties to even. Too large values become infinite, and zero is positive. The mantissa must
    /// have at most 53 bits, and the exponent must be that of a double.
    pub fn nearest_f32(self) -> f32 {
        if self.mantissa == 0 {
            return 0.0;
        }
        let double = (self.mantissa as f64).to_bits();
        f64::from_bits(double.wrapping_add_signed(self.exponent << 52)) as f32
    }
}

impl<I: Integer> Binary<I> {
    /// Converts a finite binary32 number, of which bits are given, exactly. It is [normal](Self::first_bits).
    #[inline(always)]
    pub fn from_bits(bits: I) -> Binary<I> {
        let (mantissa, exponent) = bits.split();
        Binary { mantissa, exponent }
    }

    /// Returns a whole number.
    #[inline(always)]
    pub fn whole(n: I) -> Binary<I> {
        Binary { mantissa: n, exponent: I::new(0) }
    }

    /// Returns this number where `choice` holds, otherwise the other.
    #[inline(always)]
    pub fn or(self, choice: I::Choice, other: Binary<I>) -> Binary<I> {
        Binary {
            mantissa: self.mantissa.or(choice, other.mantissa),
            exponent: self.exponent.or(choice, other.exponent),
        }
    }

    /// Returns the number of the bit above the highest, or the least for 0.
    #[inline(always)]
    pub fn top(self) -> I {
        (self.mantissa.bits() + self.exponent).or(!self.mantissa.is_zero(), I::new(LEAST_TOP))
    }

    /// Returns the number toward zero to its first `kept` significant bits. A mantissa of 24 bits is normal; that of 0 has an exponent below that of all
    /// other numbers, and so have products with it.
    #[inline(always)]
    pub fn first_bits(self, kept: u32) -> Binary<I> {
        let bits = I::new(LEAST_TOP).or(self.mantissa.is_zero(), self.mantissa.bits());
        // LEAST_TOP is a multiple of 64.
        let high = self.mantissa.magnitude().up((I::new(63) - bits).masked(63)).within(0, i64::MAX);
        let mantissa = high.down(I::new((63 - kept).into())).within(0, (1 << kept) - 1);
        let exponent = self.exponent + bits - I::new(kept.into());
        Binary { mantissa: mantissa.negated(self.mantissa.is_negative()), exponent }
    }

    /// Returns the number in steps of 2^`unit`, toward zero. It must fit.
    #[inline(always)]
    pub(crate) fn steps(self, unit: I) -> I {
        // A zero may have any exponent.
        let up = (self.exponent - unit).limited(-63, 63);
        let above = self.mantissa.up(up.greatest(I::new(0)));
        toward_zero(self.mantissa, (I::new(0) - up).greatest(I::new(0))).or(up.is_negative(), above)
    }

    /// Returns the negative of the number.
    #[inline(always)]
    pub fn negated(self) -> Binary<I> {
        Binary { mantissa: I::new(0) - self.mantissa, ..self }
    }

    /// Returns the product, which must fit.
    #[inline(always)]
    pub(crate) fn times(self, other: Binary<I>) -> Binary<I> {
        Binary { mantissa: self.mantissa * other.mantissa, exponent: self.exponent + other.exponent }
    }

    /// Returns the number times a power of two.
    #[inline(always)]
    pub(crate) fn scaled(self, power: I) -> Binary<I> {
        Binary { exponent: self.exponent + power, ..self }
    }

    /// Returns whether the magnitude is that of another number or larger.
    pub fn is_no_smaller(self, other: Binary<I>) -> I::Choice {
        // Both with the highest bit at the same place.
        let high = |n: I| n.magnitude().up((I::new(62) - n.bits()).greatest(I::new(0)));
        let (top, other_top) = (self.top(), other.top());
        let is_as_large = high(self.mantissa).compared(CompareFunction::GreaterOrEqual, high(other.mantissa));
        other_top.is_below(top) | (top.compared(CompareFunction::Equal, other_top) & is_as_large)
    }

    /// Returns both numbers in the same steps, the larger with `bits` bits, and such a step as an exponent. Also returns whether a bit is lost of the
    /// smaller one, which is floored.
    fn beside(self, other: Binary<I>, bits: i64) -> ([I; 2], I, [I::Choice; 2]) {
        let ([a, b], exponent) = align([(self.mantissa, self.exponent), (other.mantissa, other.exponent)], bits);
        let lost = |n: Binary<I>, aligned: I| {
            let dropped = (exponent - n.exponent).limited(0, 63);
            aligned.up(dropped).compared(CompareFunction::NotEqual, n.mantissa) & I::new(0).is_below(dropped)
        };
        ([a, b], exponent, [lost(self, a), lost(other, b)])
    }

    /// Returns the sum. Where the larger number's first `bits` bits, at most 62, do not hold it, it is the odd one of its two neighbours: shorter
    /// numbers are less or greater than that as they are than the sum, and cutting yields the same.
    pub fn plus(self, other: Binary<I>, bits: i64) -> Binary<I> {
        let ([a, b], exponent, [first, second]) = self.beside(other, bits);
        let sum = a + b;
        let odd = (I::new(1) - sum.modulo(I::new(2))).or(first | second, I::new(0));
        Binary { mantissa: sum + odd, exponent }
    }

    /// Returns whether it is less than another.
    pub fn is_below(self, other: Binary<I>) -> I::Choice {
        let ([a, b], _, [_, lost]) = self.beside(other, 62);
        // Floors are equal only where at most one of the numbers loses bits.
        a.is_below(b) | (a.compared(CompareFunction::Equal, b) & lost)
    }

    /// Returns floor(`scale` * self * 2^`power`), limited to `limit` in magnitude, which is at most 2^24. The product of mantissa and scale must fit
    /// into 38 bits.
    #[inline(always)]
    pub fn floored(self, scale: I, power: I, limit: I) -> I {
        // Any number but 0 reaches the limit with so many bits more.
        let far = (self.mantissa * scale).up(I::new(24)).within(-1 << 62, 1 << 62);
        let floor = far.down((I::new(24) - power - self.exponent).limited(0, 63));
        floor.least(limit).greatest(I::new(0) - limit)
    }

    /// Like [`floored`](Self::floored), for a product of up to 62 bits and limits of up to 2^61.
    #[inline(always)]
    pub fn far_floored(self, scale: I, power: I, limit: I) -> I {
        let (zero, product, exponent) = (I::new(0), self.mantissa * scale, self.exponent + power);
        // After a shift by all free bits the product is beyond the limit.
        let room = (I::new(62) - product.bits()).greatest(zero);
        let above = product.up(exponent.least(room).greatest(zero));
        let below = product.down((zero - exponent).limited(0, 63));
        let floor = above.or(zero.is_below(exponent), below);
        floor.least(limit).greatest(zero - limit)
    }

    /// Returns floor(`scale` * (self + `other`) * 2^`power`), exactly, limited to `limit` in magnitude, which is at most 2^61. The products of mantissas
    /// and scale must fit into 48 bits.
    pub fn floored_sum(self, other: Binary<I>, scale: I, power: I, limit: I) -> I {
        let scaled = |n: Binary<I>| (n.mantissa * scale, n.exponent);
        // Bits are lost only where the numbers cannot cancel. Then the sum is beyond the limit, or they are below a step.
        let ([a, b], exponent) = align([scaled(self), scaled(other)], 62);
        Binary { mantissa: a + b, exponent }.far_floored(I::new(1), power, limit)
    }

    /// Returns the ratio to another number, toward zero to 36 bits or some more, or 0 if it is not positive. A positive number divided by 0 yields
    /// more than every depth.
    pub fn positive_ratio(self, by: Binary<I>) -> Binary<I> {
        let (n, d) = (self.mantissa.magnitude(), by.mantissa.magnitude());
        let up = (I::new(62) - n.bits()).greatest(I::new(0));
        let ratio =
            Binary { mantissa: n.up(up).quotient(d.greatest(I::new(1))), exponent: self.exponent - up - by.exponent };
        let nothing = Binary::whole(I::new(0));
        let infinite = Binary { mantissa: I::new(1), exponent: I::new(1000) };
        let is_negative = self.mantissa.is_negative();
        let is_nothing = n.is_zero() | (is_negative ^ by.mantissa.is_negative());
        let of_zero = nothing.or(is_negative | n.is_zero(), infinite);
        of_zero.or(d.is_zero(), nothing.or(is_nothing, ratio))
    }
}

/// Returns n without its last bits, toward zero.
#[inline(always)]
fn toward_zero<I: Integer>(n: I, dropped: I) -> I {
    n.magnitude().down(dropped.least(I::new(63))).negated(n.is_negative())
}
