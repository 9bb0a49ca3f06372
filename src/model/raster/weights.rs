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
    /// Outside of a triangle it may come to 0; then it is the last of these bits.
    fn sum_of_edges(edges: [Self; 3]) -> Self;
    /// Returns the sum of products, each toward zero to a multiple of the 29th bit of the largest magnitude.
    fn sum_of_products(factors: [[Self; 2]; 3]) -> Self;
    /// Returns the reciprocal of a number of at most 31 bits by Newton's method, exactly 1 / self for a power of two. The sign is kept.
    fn reciprocal(self) -> Self;
    /// Returns 1 - a - b, its magnitude rounded up to 24 significant bits.
    fn rest(a: Self, b: Self) -> Self;
    /// The same of weights that are not negative, as those of covered pixels.
    #[inline(always)]
    fn rest_of_weights(a: Self, b: Self) -> Self {
        Self::rest(a, b)
    }
    /// Returns the exponent.
    fn exponent(self) -> Self::Exponent;
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

impl<N: Number<Choice = bool>> Weights<N> {
    /// Returns the weights where the edge functions are `e`. `ratios` are the [`ratios`] of the vertices if their w differ.
    #[inline(always)]
    pub fn new(e: [N; 3], ratios: Option<[N; 3]>) -> Weights<N> {
        let edges = edge_numbers(e, ratios);
        let sum = N::sum_of_edges(edges);
        let reciprocal = sum.reciprocal();
        let shares = shares(edges, reciprocal);
        let dominance = dominance(shares);
        let dominant = if dominance[0] { 0 } else { 1 + usize::from(dominance[1]) };
        Weights { edges, sum, reciprocal, shares, dominant, b: completed::<N, false>(shares) }
    }
}

/// WGT-1: returns the ratios r_k of positive w of the vertices: w_1 times the reciprocal of w_k, cut to 24 bits. r_1 is 1.
#[inline(always)]
pub fn ratios<N: Number>(w: [N; 3]) -> [N; 3] {
    let ratio = |k: usize| w[1].product::<29>(w[k].reciprocal());
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

/// WGT-1: returns whether the first and whether the third weight dominates. The second does if neither does. Among weights of the same exponent
/// the first precedes the second, the second the third and the third the first; of three, the third dominates.
#[inline(always)]
pub fn dominance<N: Number>(b: [N; 3]) -> [N::Choice; 2] {
    let [x, y, z] = [b[0].exponent(), b[1].exponent(), b[2].exponent()];
    let first = !N::is_above(y, x) & N::is_above(x, z);
    [first, !(first | (!N::is_above(z, y) & N::is_above(y, x)))]
}

/// WGT-1: returns the weights of shares: the dominant one is the rest of the others. `COVERED` says that no share is negative.
#[inline(always)]
pub fn completed<N: Number, const COVERED: bool>(b: [N; 3]) -> [N; 3] {
    completed_by(b, |one, other| if COVERED { N::rest_of_weights(one, other) } else { N::rest(one, other) })
}

/// Returns the weights of shares, of which the dominant one is what `rest` makes of the others.
#[inline(always)]
pub fn completed_by<N: Number>(b: [N; 3], rest: impl FnOnce(N, N) -> N) -> [N; 3] {
    let [first, third] = dominance(b);
    // The two that do not dominate: 1 and 2, 0 and 2, or 0 and 1.
    let rest = rest(b[1].or(first | third, b[2]), b[2].or(first, b[0]));
    [rest.or(first, b[0]), b[1].or(first | third, rest), rest.or(third, b[2])]
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

    /// WGT-1: returns the number where the weights are `b`: at most 26 bits.
    #[inline(always)]
    pub fn at(&self, b: [N; 3]) -> N {
        N::linear(self.second, [[b[0], self.first], [b[2], self.third]])
    }
}

impl Linear<Binary> {
    /// WGT-1: returns the terms b_0 (f_0 - f_1), f_1 and b_2 (f_2 - f_1).
    pub fn terms(&self, b: [Binary; 3]) -> [Binary; 3] {
        [b[0].times(self.first), self.second, b[2].times(self.third)]
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
        let unit = term.exponent + (term.length - I::new(24));
        Binary { mantissa: term.steps(unit, (1 << 24) - 1), exponent: unit }
    }

    #[inline(always)]
    fn linear(number: Binary<I>, factors: [[Binary<I>; 2]; 2]) -> Binary<I> {
        let [first, third] = factors.map(Term::product::<24>);
        aligned_sum::<24, I>([first, Term::new(number), third])
    }

    #[inline(always)]
    fn sum_of_edges(edges: [Binary<I>; 3]) -> Binary<I> {
        let sum = aligned_sum::<29, I>(edges.map(|edge| Term::new(edge).raised(5)));
        let mantissa = I::new(1).or(sum.mantissa.is_zero(), sum.mantissa);
        Binary { mantissa, exponent: sum.exponent - I::new(5) }
    }

    #[inline(always)]
    fn sum_of_products(factors: [[Binary<I>; 2]; 3]) -> Binary<I> {
        aligned_sum::<29, I>(factors.map(Term::product::<24>))
    }

    #[inline(always)]
    fn reciprocal(self) -> Binary<I> {
        let sum = self.mantissa.magnitude();
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
        let mantissa = third.up(short).within(1 << 28, 1 << 29).negated(self.mantissa.is_negative());
        Binary { mantissa, exponent: I::new(0) - self.exponent - length - I::new(29) - short }
    }

    #[inline(always)]
    fn rest(a: Binary<I>, b: Binary<I>) -> Binary<I> {
        // Bits are lost only where the rest is no number of 24 bits, which its last bit says.
        let Binary { mantissa: rest, exponent } = Binary::whole(I::new(1)).plus(a.negated().plus(b.negated(), 60), 60);
        let Binary { mantissa, exponent } = rounded_up(Binary { mantissa: rest.magnitude(), exponent });
        Binary { mantissa: mantissa.negated(rest.is_negative()), exponent }
    }

    /// Both weights are below 1. What they lose below the 60th fraction bit does not matter: the rest is at least 1/8, and where both lose some it is 1 to
    /// 24 bits.
    #[inline(always)]
    fn rest_of_weights(a: Binary<I>, b: Binary<I>) -> Binary<I> {
        let fixed = |n: Binary<I>| n.mantissa.up(I::new(36)).down((I::new(-24) - n.exponent).least(I::new(63)));
        let rest = (I::new(1 << 60) - fixed(a) - fixed(b)).within(1, 1 << 60);
        rounded_up(Binary { mantissa: rest, exponent: I::new(-60) })
    }

    #[inline(always)]
    fn exponent(self) -> I {
        I::new(LEAST_TOP).or(self.mantissa.is_negative(), self.exponent)
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

#[cfg(test)]
#[allow(clippy::float_arithmetic, reason = "choosing numbers")]
mod tests {
    use super::*;
    use crate::random::Random;

    fn double(n: Binary) -> f64 {
        n.mantissa as f64 * 2_f64.powi(n.exponent as i32)
    }

    /// Returns numbers of up to `bits` bits at which roundings change: powers of two, their neighbours, ties, runs of ones, and random ones.
    fn boundary(random: &mut Random, bits: u32) -> i64 {
        let top = random.bits() % u64::from(bits) + 1;
        let low = random.bits() % top;
        let one = |n: u64| 1_i64 << n;
        let n = match random.bits() % 8 {
            0 => one(top - 1),
            1 => one(top - 1) - 1,
            2 => one(top - 1) + 1,
            3 => one(top - 1) + one(low) - 1,
            4 => one(top - 1) - one(low),
            5 => one(top - 1) + one(low),
            6 => (random.bits() >> (64 - top)) as i64 & !(one(low) - 1),
            _ => (random.bits() >> (64 - top)) as i64,
        };
        n.clamp(0, one(u64::from(bits)) - 1)
    }

    fn w(random: &mut Random) -> f32 {
        let mantissa = boundary(random, 23) as u32;
        f32::from_bits((127 - 20 + (random.bits() % 40) as u32) << 23 | mantissa)
    }

    fn value(random: &mut Random) -> f32 {
        let exponent = match random.bits() % 4 {
            0 => random.bits() % 255,
            1 => 100 + random.bits() % 50,
            2 => 126 + random.bits() % 3,
            _ => return if random.bits().is_multiple_of(2) { 0.0 } else { -0.0 },
        };
        f32::from_bits(((random.bits() % 2) as u32) << 31 | (exponent as u32) << 23 | boundary(random, 23) as u32)
    }

    /// Compares doubles with the definition, inside and outside of triangles.
    #[test]
    fn doubles_are_the_definition() {
        let mut random = Random::seeded(65);
        for step in 0..1_500_000 {
            let mut e: [i64; 3] = std::array::from_fn(|_| boundary(&mut random, 37));
            if step % 7 == 0 {
                e[1] = e[0];
            }
            if step % 3 == 0 {
                let k = (random.bits() % 3) as usize;
                e[k] = -e[k];
            }
            if e.iter().sum::<i64>() <= 0 {
                continue;
            }
            let corners = [w(&mut random), w(&mut random), w(&mut random)];
            let ratios = super::ratios(corners.map(Binary::new));
            assert_eq!(ratios.map(double), super::ratios(corners.map(f64::from)), "{corners:?}");
            let ratios = (step % 4 > 0).then_some(ratios);
            let exact = Weights::<Binary>::new(e.map(Binary::from_edge), ratios);
            let found = Weights::<f64>::new(e.map(f64::from_edge), ratios.map(|r| r.map(double)));
            let context = || format!("{e:?} {corners:?} {exact:?} {found:?}");
            assert_eq!(exact.edges.map(double), found.edges, "{}", context());
            assert_eq!(double(exact.sum), found.sum, "{}", context());
            assert_eq!(double(exact.reciprocal), found.reciprocal, "{}", context());
            assert_eq!(exact.shares.map(double), found.shares, "{}", context());
            assert_eq!(exact.b.map(double), found.b, "{}", context());
            assert_eq!(exact.dominant, found.dominant);
            let f = [value(&mut random), value(&mut random), value(&mut random)];
            let [exact, found] = [double(Linear::<Binary>::new(f).at(exact.b)), Linear::<f64>::new(f).at(found.b)];
            assert_eq!(exact, found, "{f:?} {}", context());
        }
    }

    /// Rests of weights that are not negative, many of them hardly beside a number of 24 bits.
    #[test]
    fn rests_of_weights_are_rests() {
        let mut random = Random::seeded(29);
        for step in 0..1_000_000 {
            let mut weight = || {
                let (mantissa, down) = (boundary(&mut random, 24), random.bits() % 60);
                let down = down as i32 + 1;
                Binary { mantissa, exponent: (-down - bits_of(mantissa)).into() }.cut()
            };
            let (a, mut b) = (weight(), weight());
            if step % 2 == 0 {
                // So that the sum hardly differs from a multiple of 2^-25.
                let beyond = (1_i64 << 24) - (step & 3);
                let unit = a.exponent;
                b = Binary { mantissa: beyond, exponent: unit - 24 }.cut();
            }
            if double(a) + double(b) > 0.7 {
                continue;
            }
            let rest = |a: Binary, b: Binary| double(Binary::rest(a, b));
            assert_eq!(f64::rest_of_weights(double(a), double(b)), rest(a, b), "{a:?} {b:?}");
            assert_eq!(f64::rest_of_weights(double(b), double(a)), rest(a, b), "{a:?} {b:?}");
            assert_eq!(double(Binary::rest_of_weights(a, b)), rest(a, b), "{a:?} {b:?}");
        }
    }

    fn bits_of(n: i64) -> i32 {
        64 - n.leading_zeros() as i32
    }

    /// Sums of all lengths: two steps of Newton's method stay below 1 / S, and they lack less than 4.5 units of the 29th bit.
    #[test]
    fn reciprocals_are_low() {
        let mut random = Random::seeded(3);
        for _ in 0..200_000 {
            let sum = boundary(&mut random, 31).clamp(1, 3 << 29);
            let Binary { mantissa, exponent } = Binary { mantissa: sum, exponent: 0 }.reciprocal();
            let (sum, mantissa) = (sum as u128, mantissa as u128);
            if sum.is_power_of_two() {
                assert_eq!(mantissa * sum, 1 << -exponent);
                continue;
            }
            assert!(mantissa * sum < 1 << -exponent && (2 * mantissa + 9) * sum > 2 << -exponent, "{sum}");
        }
    }

    /// Sums of captured triangles, whose reciprocals their depths decide: three are one below the floor.
    #[test]
    fn captured_reciprocals() {
        let r = |sum: i64| Binary { mantissa: sum, exponent: 0 }.reciprocal().mantissa;
        assert_eq!(
            [460_800, 798_720, 39_321_600, 765_952].map(r),
            [305_419_896, 352_407_572, 458_129_844, 367_483_831]
        );
        assert_eq!([371_433_472, 371_433_476].map(r), [387_997_310, 387_997_305]);
    }

    #[test]
    fn a_number_worked_by_hand() {
        // A captured pixel: s of .89999998, 1.10000002, 1.10000002 where b_0 is 124/128 is .90625, texel 232 of 256. The exact value lies below.
        let b = [(124, -7), (0, 0), (0, 0)].map(|(mantissa, exponent)| Binary { mantissa, exponent });
        let s = Linear::<Binary>::new([0.9, 1.1, 1.1]).at(b);
        assert_eq!(double(s), 0.90625);
        let b = [(0, 0), (0, 0), (4, -7)].map(|(mantissa, exponent)| Binary { mantissa, exponent });
        assert!(double(Linear::<Binary>::new([0.9, 0.9, 1.1]).at(b)) < 0.90625);
    }

    #[test]
    fn equal_weights_go_round() {
        let of = |n: [i64; 3]| dominance::<Binary>(n.map(|n| Binary::from_edge(n).cut()));
        assert_eq!(
            [of([5, 5, 2]), of([2, 5, 5]), of([5, 2, 5]), of([4, 4, 4])],
            [[true, false], [false, false], [false, true], [false, true]]
        );
    }
}
