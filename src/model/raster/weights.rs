//! WGT-1: the weights of a triangle's vertices at a pixel, and the numbers that are interpolated by them.
//!
//! ```text
//! e_k = cut_24(E_k), with unequal w cut_24(e_k r_k)     r_k = cut_24(w_1 R(w_k)), R as below
//! S   = sum of e_k, each cut at the 29th bit of the largest
//! R   = 1/S by two steps of Newton's method from seven bits, cut to 29
//! b_k = cut_24(e_k R);  the dominant one is 1 less the other two, rounded up to 24 bits
//! f   = f_1 + b_0 (f_0 - f_1) + b_2 (f_2 - f_1), each term cut at the 24th bit of the largest
//! ```
//!
//! The text is generic over [`Number`]. [`Binary`] is the definition, in integers; `f64` holds every number exactly, so
//! that loops over it are the fast engine's (`doubles`).

use super::binary::Binary;
use crate::number::{Choice, Integer, LEAST_TOP};

/// A number of the interpolator. Products of two are exact, and nothing is rounded but where a method says so.
pub trait Number: Copy {
    /// The binary exponent of a positive number; less than any of these for all other numbers.
    type Exponent: Copy;
    /// Truth of a comparison.
    type Choice: Choice;

    /// The number 1.
    fn one() -> Self;
    /// Converts an edge function, of at most 39 bits.
    fn from_edge(edge: i64) -> Self;
    /// Converts a finite number.
    fn from_f32(number: f32) -> Self;
    /// Returns the number toward zero to its first 24 significant bits.
    fn cut(self) -> Self;
    /// Returns the product of numbers with 24 and `BITS` bits, 24 or 29, toward zero to its first 24 significant bits.
    fn product<const BITS: u32>(self, other: Self) -> Self;
    /// Returns the sum of a number and two products, each toward zero to a multiple of the 24th bit of the largest magnitude.
    fn linear(number: Self, factors: [[Self; 2]; 2]) -> Self;
    /// Returns the sum of edge numbers for a [`reciprocal`](Self::reciprocal), each toward zero to a multiple of the 29th bit of the largest magnitude.
    /// Outside of a triangle it may come to 0; then it is the last of these bits. `COVERED` says that no edge number is negative.
    fn sum_of_edges<const COVERED: bool>(edges: [Self; 3]) -> Self;
    /// Returns the sum of products, each toward zero to a multiple of the 29th bit of the largest magnitude.
    fn sum_of_products(factors: [[Self; 2]; 3]) -> Self;
    /// Returns the reciprocal of a number of at most 31 bits by Newton's method, exactly 1 / self for a power of two. The sign is kept. `COVERED` says that
    /// the number is positive.
    fn reciprocal<const COVERED: bool>(self) -> Self;
    /// Returns 1 - a - b, its magnitude rounded up to 24 significant bits. `COVERED` says that the weights are not negative; then a rest below 0 may be any
    /// number.
    fn rest<const COVERED: bool>(a: Self, b: Self) -> Self;
    /// Returns the exponent. `COVERED` says that the number is not negative.
    fn exponent<const COVERED: bool>(self) -> Self::Exponent;
    /// Returns whether the first exponent is larger than the second.
    fn is_above(a: Self::Exponent, b: Self::Exponent) -> Self::Choice;
    /// Returns `self` where `condition` holds, otherwise `other`.
    fn or(self, condition: Self::Choice, other: Self) -> Self;
}

/// The weights of a pixel and the numbers on the way to them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Weights<N> {
    /// Edge numbers e_k.
    pub edges: [N; 3],
    /// Their sum S.
    pub sum: N,
    /// The reciprocal R of the sum.
    pub reciprocal: N,
    /// e_k R, cut.
    pub shares: [N; 3],
    /// Index of the dominant weight, which is the rest of the others.
    pub dominant: usize,
    /// The weights b_k.
    pub b: [N; 3],
}

impl<N: Number> Weights<N>
where
    N::Choice: Into<bool>,
{
    /// Returns the weights where the edge functions are `e`. `ratios` are the [`ratios`] of the vertices if their w differ.
    #[inline(always)]
    pub fn new(e: [N; 3], ratios: Option<[N; 3]>) -> Weights<N> {
        let edges = edge_numbers(e, ratios);
        let sum = N::sum_of_edges::<false>(edges);
        let reciprocal = sum.reciprocal::<false>();
        let shares = shares(edges, reciprocal);
        let [first, third] = dominance::<N, false>(shares).map(Into::into);
        let dominant = if first { 0 } else { 1 + usize::from(third) };
        let mut b = shares;
        b[dominant] = N::rest::<false>(shares[(dominant + 1) % 3], shares[(dominant + 2) % 3]);
        Weights { edges, sum, reciprocal, shares, dominant, b }
    }
}

/// WGT-1: returns the ratios r_k of positive w of the vertices: w_1 times the reciprocal of w_k, cut to 24 bits. r_1 is 1.
#[inline(always)]
pub fn ratios<N: Number>(w: [N; 3]) -> [N; 3] {
    let ratio = |k: usize| w[1].product::<29>(w[k].reciprocal::<true>());
    [ratio(0), N::one(), ratio(2)]
}

/// WGT-1: returns the edge numbers e_k.
#[inline(always)]
pub fn edge_numbers<N: Number>(e: [N; 3], ratios: Option<[N; 3]>) -> [N; 3] {
    let e = [e[0].cut(), e[1].cut(), e[2].cut()];
    match ratios {
        Some(r) => [e[0].product::<24>(r[0]), e[1], e[2].product::<24>(r[2])],
        None => e,
    }
}

/// WGT-1: returns e_k R, cut to 24 bits.
#[inline(always)]
pub fn shares<N: Number>(edges: [N; 3], reciprocal: N) -> [N; 3] {
    edges.map(|edge| edge.product::<29>(reciprocal))
}

/// WGT-1: returns the same of edge functions.
#[inline(always)]
pub fn shares_at<N: Number, const COVERED: bool>(e: [N; 3], ratios: Option<[N; 3]>) -> [N; 3] {
    let edges = edge_numbers(e, ratios);
    shares(edges, N::sum_of_edges::<COVERED>(edges).reciprocal::<COVERED>())
}

/// WGT-1: returns whether the first and whether the third weight dominates. The second does if neither does. Among weights of the same exponent
/// the first precedes the second, the second the third and the third the first; of three, the third dominates.
#[inline(always)]
pub fn dominance<N: Number, const COVERED: bool>(b: [N; 3]) -> [N::Choice; 2] {
    let [x, y, z] = [b[0].exponent::<COVERED>(), b[1].exponent::<COVERED>(), b[2].exponent::<COVERED>()];
    let (first_to_second, first_to_third) = (!N::is_above(y, x), N::is_above(x, z));
    [first_to_second & first_to_third, !first_to_third & (first_to_second | N::is_above(z, y))]
}

/// WGT-1: returns b_0 and b_2, the weights that linear functions take, of shares. `COVERED` says that no share is negative.
#[inline(always)]
pub fn outer_weights<N: Number, const COVERED: bool>(shares: [N; 3]) -> [N; 2] {
    outer_weights_by::<N, COVERED>(shares, N::rest::<COVERED>)
}

/// Returns b_0 and b_2 of shares, of which the dominant one is what `rest` makes of the others. If the second dominates, nobody asks for it.
#[inline(always)]
pub fn outer_weights_by<N: Number, const COVERED: bool>(b: [N; 3], rest: impl FnOnce(N, N) -> N) -> [N; 2] {
    let [first, third] = dominance::<N, COVERED>(b);
    let rest = rest(b[1], b[2].or(first, b[0]));
    [rest.or(first, b[0]), rest.or(third, b[2])]
}

/// TSH-4: returns the sum of three numbers of 24 bits, each toward zero to a multiple of the 24th bit of the largest magnitude, to its first 24 bits.
#[inline(always)]
pub fn cut_sum<N: Number>([x, y, z]: [N; 3]) -> N {
    N::linear(x, [y, z].map(|term| [N::one(), term])).cut()
}

/// TEX-15: returns the quotient of a number by another, whose reciprocal is given: the first is cut to 24 bits, and so is the product.
#[inline(always)]
pub fn quotient<N: Number>(number: N, reciprocal: N) -> N {
    number.cut().product::<29>(reciprocal)
}

/// A number of the vertices, as [`Linear::at`] takes it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Linear<N> {
    /// f_1.
    pub second: N,
    /// f_0 - f_1.
    pub first: N,
    /// f_2 - f_1.
    pub third: N,
}

impl<N> Linear<N> {
    /// Returns the number with the values `f` at the vertices, in any form of binary32.
    #[inline(always)]
    pub fn from_values<F: Copy>(f: [F; 3], difference: impl Fn(F, F) -> F, number: impl Fn(F) -> N) -> Linear<N> {
        let (first, third) = (difference(f[0], f[1]), difference(f[2], f[1]));
        Linear { second: number(f[1]), first: number(first), third: number(third) }
    }
}

impl<N: Number> Linear<N> {
    /// Returns the number with the finite values `f` at the vertices.
    #[inline(always)]
    pub fn new(f: [f32; 3]) -> Linear<N> {
        Linear::from_values(f, difference, N::from_f32)
    }

    /// WGT-1: returns the number where b_0 and b_2 are these: at most 26 bits.
    #[inline(always)]
    pub fn at(&self, [b0, b2]: [N; 2]) -> N {
        N::linear(self.second, [[b0, self.first], [b2, self.third]])
    }
}

impl Linear<Binary> {
    /// WGT-1: returns the terms b_0 (f_0 - f_1), f_1 and b_2 (f_2 - f_1).
    pub fn terms(&self, [b0, b2]: [Binary; 2]) -> [Binary; 3] {
        [b0.times(self.first), self.second, b2.times(self.third)]
    }
}

/// WGT-1: returns a - b in binary32, to nearest. A difference below 2^-126 is 0, and one that is too large the largest number.
#[allow(clippy::float_arithmetic, reason = "WGT-1 names binary32 for differences")]
#[inline(always)]
pub fn difference(a: f32, b: f32) -> f32 {
    let difference = (a - b).clamp(f32::MIN, f32::MAX);
    if difference.abs() < f32::MIN_POSITIVE { 0.0 } else { difference }
}

/// WGT-1: returns the [`difference`]s f_0 - f_1 and f_2 - f_1.
#[inline(always)]
pub fn differences(f: [f32; 3]) -> [f32; 2] {
    [difference(f[0], f[1]), difference(f[2], f[1])]
}

/// Returns a number of at most 61 bits that is not negative, rounded up to 24 bits. Its mantissa may be 2^24.
#[inline(always)]
fn rounded_up<I: Integer>(n: Binary<I>) -> Binary<I> {
    let (zero, dropped) = (I::new(0), I::new(61 - 24));
    let up = I::new(61) - n.mantissa.bits();
    let high = n.mantissa.up(up).within(0, (1 << 61) - 1);
    let mantissa = (zero - (zero - high).down(dropped)).within(0, 1 << 24);
    Binary { mantissa, exponent: I::new(LEAST_TOP).or(n.mantissa.is_zero(), n.exponent + dropped - up) }
}

/// The reciprocal of the middle of all mantissas with the same seven bits of fraction, in units of 2^-7, to nearest.
pub const FIRST_RECIPROCALS: [u8; 128] = {
    let mut table = [0; 128];
    let mut index = 0;
    while index < 128 {
        let middle = 2 * index as u32 + 257;
        table[index] = (((1 << 16) + middle) / (2 * middle)) as u8;
        index += 1;
    }
    table
};

/// A term of a sum.
#[derive(Clone, Copy)]
struct Term<I: Integer> {
    magnitude: I,
    is_negative: I::Choice,
    exponent: I,
    /// Bits of the magnitude. Those of 0 are too many; its exponent makes up for that.
    length: I,
    /// A shift that leaves nothing.
    away: i64,
}

impl<I: Integer> Term<I> {
    /// Returns a normal number.
    #[inline(always)]
    fn new(number: Binary<I>) -> Term<I> {
        Term {
            magnitude: number.mantissa.magnitude().within(0, (1 << 24) - 1),
            is_negative: number.mantissa.is_negative(),
            exponent: number.exponent,
            length: I::new(24),
            away: 31,
        }
    }

    /// Returns the term times 2^`up`, by its magnitude.
    #[inline(always)]
    fn raised(self, up: i64) -> Term<I> {
        Term { magnitude: self.magnitude * I::new(1 << up), length: self.length + I::new(up), ..self }
    }

    /// Returns the product of normal numbers, of which the second has `BITS` bits.
    #[inline(always)]
    fn product<const BITS: u32>([a, b]: [Binary<I>; 2]) -> Term<I> {
        let magnitude = (a.mantissa.magnitude() * b.mantissa.magnitude()).within(0, (1 << (24 + BITS)) - 1);
        let least = I::new((23 + BITS).into());
        Term {
            magnitude,
            is_negative: a.mantissa.is_negative() ^ b.mantissa.is_negative(),
            exponent: a.exponent + b.exponent,
            length: least + magnitude.down(least),
            away: 63,
        }
    }

    /// Returns the term in steps of 2^`unit`, toward zero.
    #[inline(always)]
    fn steps(self, unit: I, most: i64) -> I {
        let down = (unit - self.exponent).least(I::new(self.away));
        self.magnitude.down(down).within(0, most).negated(self.is_negative)
    }
}

/// Returns the sum of terms of `BITS` bits or more, each toward zero to a multiple of the `BITS`th bit of the largest.
#[inline(always)]
fn aligned_sum<const BITS: u32, I: Integer>([a, b, c]: [Term<I>; 3]) -> Binary<I> {
    let unit = |term: Term<I>| term.exponent + (term.length - I::new(BITS.into()));
    let unit = unit(a).greatest(unit(b)).greatest(unit(c));
    let steps = |term: Term<I>| term.steps(unit, (1 << BITS) - 1);
    Binary { mantissa: steps(a) + steps(b) + steps(c), exponent: unit }
}

/// WGT-1: numbers are [normal](Binary::first_bits) but for edge functions, sums and reciprocals.
impl<I: Integer> Number for Binary<I> {
    type Exponent = I;
    type Choice = I::Choice;

    #[inline(always)]
    fn one() -> Binary<I> {
        Binary { mantissa: I::new(Binary::ONE.mantissa), exponent: I::new(Binary::ONE.exponent) }
    }

    #[inline(always)]
    fn from_edge(edge: i64) -> Binary<I> {
        Binary::whole(I::new(edge))
    }

    #[inline(always)]
    fn from_f32(number: f32) -> Binary<I> {
        let Binary { mantissa, exponent } = Binary::new(number);
        Binary { mantissa: I::new(mantissa), exponent: I::new(exponent) }
    }

    #[inline(always)]
    fn cut(self) -> Binary<I> {
        self.first_bits(24)
    }

    #[inline(always)]
    fn product<const BITS: u32>(self, other: Binary<I>) -> Binary<I> {
        let term = Term::product::<BITS>([self, other]);
        let down = term.length - I::new(24);
        let mantissa = term.magnitude.down(down).within(0, (1 << 24) - 1).negated(term.is_negative);
        Binary { mantissa, exponent: term.exponent + down }
    }

    #[inline(always)]
    fn linear(number: Binary<I>, factors: [[Binary<I>; 2]; 2]) -> Binary<I> {
        let [first, third] = factors.map(Term::product::<24>);
        aligned_sum::<24, I>([first, Term::new(number), third])
    }

    #[inline(always)]
    fn sum_of_edges<const COVERED: bool>(edges: [Binary<I>; 3]) -> Binary<I> {
        let sum = aligned_sum::<29, I>(edges.map(|edge| Term::new(edge).raised(5)));
        let mantissa = if COVERED { sum.mantissa } else { I::new(1).or(sum.mantissa.is_zero(), sum.mantissa) };
        Binary { mantissa, exponent: sum.exponent - I::new(5) }
    }

    #[inline(always)]
    fn sum_of_products(factors: [[Binary<I>; 2]; 3]) -> Binary<I> {
        aligned_sum::<29, I>(factors.map(Term::product::<24>))
    }

    #[inline(always)]
    fn reciprocal<const COVERED: bool>(self) -> Binary<I> {
        let sum = if COVERED { self.mantissa } else { self.mantissa.magnitude() };
        let length = sum.bits() - I::new(1);
        // The sum in [1, 2), in units of 2^-30.
        let m = sum.up(I::new(30) - length).within(1 << 30, (1 << 31) - 1);
        let first = m.down(I::new(23)).masked(127).entry(&FIRST_RECIPROCALS);
        let second = ((I::new(1 << 22) - first * m.down(I::new(16))) * first + I::new(1 << 12)).down(I::new(13));
        let second = second.within(1 << 14, 1 << 15);
        let factor = (I::new(1 << 46) - second * m).down(I::new(15)).within(0, 1 << 31);
        let third = (second * factor).down(I::new(16)).within(0, 1 << 29);
        // It has 29 bits, but 28 where it is hardly below 1/2, and 30 where it is 1.
        let short = I::new(1).or(third.is_below(I::new(1 << 28)), I::new(0));
        let mantissa = third.up(short).within(1 << 28, 1 << 29);
        let mantissa = if COVERED { mantissa } else { mantissa.negated(self.mantissa.is_negative()) };
        Binary { mantissa, exponent: I::new(0) - self.exponent - length - I::new(29) - short }
    }

    /// Bits are lost only where the rest is no number of 24 bits, which its last bit says.
    ///
    /// Covered: both weights are at most 1, and what they lose below the 60th fraction bit does not matter, because the rest is at least 1/8, and where
    /// both lose some it is 1 to 24 bits.
    #[inline(always)]
    fn rest<const COVERED: bool>(a: Binary<I>, b: Binary<I>) -> Binary<I> {
        if COVERED {
            let fixed = |n: Binary<I>| n.mantissa.up(I::new(37)).down((I::new(-23) - n.exponent).least(I::new(63)));
            let rest = (I::new(1 << 60) - fixed(a) - fixed(b)).greatest(I::new(0)).within(0, 1 << 60);
            return rounded_up(Binary { mantissa: rest, exponent: I::new(-60) });
        }
        let Binary { mantissa: rest, exponent } = Binary::whole(I::new(1)).plus(a.negated().plus(b.negated(), 60), 60);
        let Binary { mantissa, exponent } = rounded_up(Binary { mantissa: rest.magnitude(), exponent });
        Binary { mantissa: mantissa.negated(rest.is_negative()), exponent }
    }

    #[inline(always)]
    fn exponent<const COVERED: bool>(self) -> I {
        if COVERED { self.exponent } else { I::new(LEAST_TOP).or(self.mantissa.is_negative(), self.exponent) }
    }

    #[inline(always)]
    fn is_above(a: I, b: I) -> I::Choice {
        b.is_below(a)
    }

    #[inline(always)]
    fn or(self, condition: I::Choice, other: Binary<I>) -> Binary<I> {
        Binary::or(self, condition, other)
    }
}
