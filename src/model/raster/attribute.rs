//! Numbers of the vertices that are interpolated as numbers rather than as texel positions: some texture coordinates,
//! and the fog coordinate.
//!
//! With E the edge functions and P the perspective weights, the value is sum P x E / sum P E (INT-1, INT-4). An
//! [`Attribute`] holds P x of the three vertices, a `Quotient` the ratio at a sample. Rounding the ratio to a float
//! or to steps uses the exact remainder.

use super::depth::Binary;
use super::interpolate::{Floored, Sample};
use super::setup::Triangle;
use crate::number::convert::{align, shift, split};

/// Bits of the largest g. Edge functions stay below 2^38 at every pixel within RAS-0, so sums stay below 2^102.
const ATTRIBUTE_BITS: i32 = 62;

/// Number of significant bits of a single-precision number.
const SIGNIFICANT: i32 = 24;

/// Exponent of the last bit of a subnormal single-precision number.
const SMALLEST_EXPONENT: i32 = -149;

/// The numerator of a linear function over a triangle. At a sample it is 2^exponent sum g_k E_k.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Attribute {
    g: [i64; 3],
    exponent: i32,
}

/// The number numerator / denominator * 2^exponent, with a positive denominator.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Quotient {
    numerator: i128,
    denominator: i64,
    exponent: i32,
}

impl Attribute {
    /// Returns g and the exponent, for observers.
    pub(crate) fn numbers(&self) -> ([i64; 3], i32) {
        (self.g, self.exponent)
    }
}

impl Triangle {
    /// Returns the attribute with P_k x_k of three finite numbers. The products are exact, unless they differ so much
    /// that the smaller ones fall below 2^-62 of the largest; those are floored there (INT-4).
    pub(crate) fn attribute(&self, x: [f32; 3]) -> Attribute {
        let products: [(i64, i32); 3] = std::array::from_fn(|k| {
            let (mantissa, exponent) = split(x[k]);
            (mantissa * self.p[k], exponent)
        });
        let (g, exponent) = align(products, ATTRIBUTE_BITS);
        Attribute { g, exponent }
    }
}

impl Sample<'_> {
    /// Returns the value of `attribute` at the sample. It is 0 if D is not positive, which happens only outside the
    /// triangle, beyond its horizon.
    pub(crate) fn attribute(&self, attribute: &Attribute) -> Quotient {
        if self.d <= 0 {
            return Quotient { numerator: 0, denominator: 1, exponent: 0 };
        }
        Quotient { numerator: self.sum(&attribute.g), denominator: self.d, exponent: attribute.exponent }
    }

    /// Returns floor(2^bits * value), lowering ties as INT-4t says. The triangle must cover the sample.
    pub(crate) fn steps(&self, attribute: &Attribute, bits: i32) -> Floored {
        let (value, exact) = self.attribute(attribute).floor_steps(bits);
        let lowered = i64::from(self.lowers_tie(exact, || self.shortfall(&attribute.g)));
        Floored { value: value - lowered, lowered }
    }
}

impl Quotient {
    /// Returns the value as a binary number of at least 40 bits, truncated toward zero, or 0 if it is not positive.
    pub(crate) fn binary(&self) -> Binary {
        positive_ratio(self.numerator, i128::from(self.denominator), self.exponent)
    }

    /// Returns the ratio of this value to another of the same sample, converted like [`binary`](Self::binary). A
    /// division by 0 yields more than every depth.
    pub(crate) fn binary_ratio(&self, by: &Quotient) -> Binary {
        positive_ratio(self.numerator, by.numerator, self.exponent - by.exponent)
    }

    /// TSH-4: returns the nearest single-precision number, with ties to even. Too large values become infinite, and
    /// zero is positive.
    pub(crate) fn rounded_f32(&self) -> f32 {
        let sign = u32::from(self.numerator < 0) << 31;
        let Some((quotient, exponent, exact)) = self.digits() else { return 0.0 };
        let top = bits(quotient) + exponent;
        if top > 128 {
            return f32::from_bits(sign | f32::INFINITY.to_bits());
        }
        // Exponent of the last bit that is kept. At least 40 bits are dropped.
        let last = (top - SIGNIFICANT).max(SMALLEST_EXPONENT);
        let drop = last - exponent;
        if drop > bits(quotient) {
            // Less than half of the smallest number.
            return f32::from_bits(sign);
        }
        let kept = quotient.checked_shr(drop as u32).unwrap_or(0);
        let rest = quotient - kept.checked_shl(drop as u32).unwrap_or(0);
        let half = 1_u128 << (drop - 1);
        let up = rest > half || (rest == half && (!exact || kept & 1 == 1));
        // The hidden bit of a normal number adds one to the exponent field, as does a carry out of the mantissa.
        let field = ((last - SMALLEST_EXPONENT) as u32) << 23;
        f32::from_bits(sign | (field + kept as u32 + u32::from(up)))
    }

    /// FOG-2: returns the first 24 significant bits, truncated toward zero, as (m, e) for m 2^e with 2^23 <= |m| <
    /// 2^24. Zero is (0, 0).
    pub(crate) fn truncated_24(&self) -> (i64, i32) {
        let Some((quotient, exponent, _)) = self.digits() else { return (0, 0) };
        let drop = bits(quotient) - SIGNIFICANT;
        let mantissa = (quotient >> drop) as i64;
        (if self.numerator < 0 { -mantissa } else { mantissa }, exponent + drop)
    }

    /// Returns floor(value * 2^bits), limited to 64 bits, and whether it is exact and one less would also fit.
    fn floor_steps(&self, bits: i32) -> (i64, bool) {
        let (mut numerator, mut exponent) = (self.numerator, self.exponent + bits);
        if numerator == 0 {
            return (0, true);
        }
        if exponent > 0 {
            // A number that does not fit into 127 bits is more than 2^64 times the denominator.
            if exponent > 126 || numerator.unsigned_abs() >= 1 << (126 - exponent) {
                return (if numerator < 0 { i64::MIN } else { i64::MAX }, false);
            }
            (numerator, exponent) = (numerator << exponent, 0);
        }
        let denominator = i128::from(self.denominator);
        let (whole, rest) = (numerator.div_euclid(denominator), numerator.rem_euclid(denominator));
        let floor = shift(whole, exponent);
        let limited = floor.clamp(i128::from(i64::MIN), i128::from(i64::MAX));
        let exact = rest == 0 && exponent > -127 && floor << -exponent == whole && limited == floor;
        (limited as i64, exact && limited > i128::from(i64::MIN))
    }

    /// Returns floor(value * scale), limited to 64 bits.
    pub(crate) fn floor_times(&self, scale: i64) -> i64 {
        let saturated = if (self.numerator < 0) == (scale < 0) { i64::MAX } else { i64::MIN };
        if self.numerator == 0 || scale == 0 {
            return 0;
        }
        let (mut numerator, mut exponent) = (self.numerator, self.exponent);
        if exponent > 0 {
            // A number that does not fit into 127 bits is more than 2^65 times the denominator.
            if exponent > 126 || numerator.unsigned_abs() >= 1 << (126 - exponent) {
                return saturated;
            }
            (numerator, exponent) = (numerator << exponent, 0);
        }
        let (scale, denominator) = (i128::from(scale), i128::from(self.denominator));
        let (whole, rest) = (numerator.div_euclid(denominator), numerator.rem_euclid(denominator));
        // floor(numerator * scale / denominator) as high * 2^63 + low, because it may need more than 128 bits.
        let low = (whole & i128::from(i64::MAX)) * scale + (rest * scale).div_euclid(denominator);
        let high = (whole >> 63).saturating_mul(scale);
        let floor = if exponent <= -63 {
            shift(high + (low >> 63), exponent + 63)
        } else {
            match high.checked_mul(1 << 63).and_then(|high| high.checked_add(low)) {
                Some(sum) => sum >> -exponent,
                None => return saturated,
            }
        };
        floor.clamp(i128::from(i64::MIN), i128::from(i64::MAX)) as i64
    }

    /// Returns at least 64 bits of the magnitude, truncated, their exponent, and whether they are exact. Returns `None`
    /// for zero.
    fn digits(&self) -> Option<(u128, i32, bool)> {
        let magnitude = self.numerator.unsigned_abs();
        if magnitude == 0 {
            return None;
        }
        let up = magnitude.leading_zeros();
        let (numerator, denominator) = (magnitude << up, u128::from(self.denominator.unsigned_abs()));
        Some((numerator / denominator, self.exponent - up as i32, numerator % denominator == 0))
    }
}

/// Returns n / d * 2^exponent, truncated to 40 bits or some more, or 0 if it is not positive. A positive n divided by 0
/// yields more than every depth.
fn positive_ratio(n: i128, d: i128, exponent: i32) -> Binary {
    const KEPT: i32 = 40;
    if n == 0 || d == 0 || (n < 0) != (d < 0) {
        return if n > 0 && d == 0 { Binary { mantissa: 1, exponent: 1000 } } else { Binary::default() };
    }
    let (n, d) = (n.unsigned_abs(), d.unsigned_abs());
    let (mut quotient, mut rest) = (n / d, n % d);
    let more = KEPT - bits(n) + bits(d);
    for _ in 0..more {
        rest <<= 1;
        let bit = u128::from(rest >= d);
        rest -= bit * d;
        quotient = quotient << 1 | bit;
    }
    Binary { mantissa: (quotient >> (-more).max(0)) as i64, exponent: exponent - more }
}

fn bits(n: u128) -> i32 {
    128 - n.leading_zeros() as i32
}

#[cfg(test)]
mod tests {
    #![allow(clippy::float_arithmetic, reason = "what floats do is what is tested")]
    use super::*;
    use crate::state::Profile;
    use proptest::prelude::*;

    fn quotient(numerator: i128, denominator: i64, exponent: i32) -> Quotient {
        Quotient { numerator, denominator, exponent }
    }

    /// Generates finite floats of all sizes.
    fn finite() -> impl Strategy<Value = f32> {
        any::<u32>().prop_map(f32::from_bits).prop_filter("finite", |f| f.is_finite())
    }

    /// Compares `magnitude`, a mantissa and an exponent, with numerator / denominator * 2^exponent. All numbers must
    /// fit into 127 bits.
    fn compare(magnitude: (u128, i32), numerator: u128, denominator: u128, exponent: i32) -> std::cmp::Ordering {
        let (left, right) = (magnitude.0 * denominator, numerator);
        let difference = magnitude.1 - exponent;
        if difference >= 0 { (left << difference).cmp(&right) } else { left.cmp(&(right << -difference)) }
    }

    proptest! {
        #[test]
        fn whole_numbers_round_as_the_processor_does(n in any::<i64>(), down in 0_u32..64) {
            let n = n >> down;
            prop_assert_eq!(quotient(i128::from(n), 1, 0).rounded_f32().to_bits(), (n as f32).to_bits());
        }

        #[test]
        fn quotients_of_doubles_round_as_the_processor_does(n in -(1_i64 << 24)..1 << 24, d in 1_i64..1 << 24) {
            // Quotients of two 24-bit numbers: a double has more than twice as many bits, so rounding twice is rounding once.
            let expected = (n as f32) / (d as f32);
            prop_assert_eq!(quotient(i128::from(n), d, 0).rounded_f32(), expected);
            let small = quotient(i128::from(n), d, -147).rounded_f32();
            prop_assert_eq!(small, ((n as f64) / (d as f64) * 2_f64.powi(-147)) as f32);
            let large = quotient(i128::from(n), d, 110).rounded_f32();
            prop_assert_eq!(large, ((n as f64) / (d as f64) * 2_f64.powi(110)) as f32);
        }

        #[test]
        fn ratios_are_cut(n in 1_i64..1 << 60, d in 1_i64..1 << 60, e in -90..90, less in 0..50_u32) {
            let (n, d) = (n >> less, (d >> (50 - less)).max(1_i64));
            let of = |numerator: i64| quotient(i128::from(numerator), 5, e);
            let Binary { mantissa, exponent } = of(n).binary_ratio(&of(d));
            prop_assume!(n > 0);
            // mantissa d <= n 2^-exponent < (mantissa + 1) d
            let (low, high) = (i128::from(mantissa) * i128::from(d), (i128::from(mantissa) + 1) * i128::from(d));
            prop_assert!(mantissa >= 1 << 38 && (-104..=24).contains(&exponent));
            // What a positive exponent drops is below the last bit that was kept.
            let n = if exponent > 0 { (i128::from(n) / i128::from(d)) >> exponent } else { i128::from(n) << -exponent };
            let cut = if exponent > 0 { n == i128::from(mantissa) } else { low <= n && n < high };
            prop_assert!(cut);
            prop_assert_eq!(of(-n as i64 | -1).binary_ratio(&of(d)), Binary::default());
        }

        #[test]
        fn floats_come_back(f in finite(), n in 1_i64..1 << 34) {
            let (mantissa, exponent) = split(f);
            let q = quotient(i128::from(mantissa) * i128::from(n), n, exponent);
            prop_assert_eq!(q.rounded_f32(), f);
            let (m, e) = q.truncated_24();
            prop_assert_eq!(shift(i128::from(m), e - exponent), i128::from(mantissa));
        }

        #[test]
        fn truncation_keeps_24_bits_below(n in 1_u128..1 << 70, d in 1_i64..1 << 30, e in -60..60) {
            let (m, at) = quotient(n as i128, d, e).truncated_24();
            prop_assert!((1 << 23..1 << 24).contains(&m));
            prop_assert!(compare((m as u128, at), n, d as u128, e).is_le());
            prop_assert!(compare((m as u128 + 1, at), n, d as u128, e).is_gt());
            prop_assert_eq!(quotient(-(n as i128), d, e).truncated_24(), (-m, at));
        }

        #[test]
        fn floors(n in -(1_i64 << 60)..1 << 60, d in 1_i64..1 << 62, e in -70_i32..6, scale in -(1_i64 << 30)..1 << 30) {
            let top = i128::from(n) * i128::from(scale);
            let expected = if e >= 0 {
                (top << e).div_euclid(i128::from(d))
            } else {
                top.div_euclid(i128::from(d)) >> -e
            };
            let limited = expected.clamp(i128::from(i64::MIN), i128::from(i64::MAX)) as i64;
            prop_assert_eq!(quotient(i128::from(n), d, e).floor_times(scale), limited);
        }

        #[test]
        fn floors_of_steps(n in -(1_i128 << 101)..1 << 101, d in 1_i64..1 << 62, e in -300..200, bits in 0..20) {
            let q = quotient(n, d, e);
            let (floor, exact) = q.floor_steps(bits);
            prop_assert_eq!(floor, q.floor_times(1 << bits));
            if exact {
                prop_assert_eq!(quotient(-n, d, e).floor_steps(bits), (-floor, true));
            } else if floor.unsigned_abs() < 1 << 62 {
                prop_assert_eq!(quotient(-n, d, e).floor_steps(bits), (-floor - 1, false));
            }
        }

        #[test]
        fn floors_of_large_numerators(n in -(1_i128 << 101)..1 << 101, d in 1_i64..1 << 62, scale in 1_i64..1 << 62, e in -300..200) {
            // Halving the numerator's scale and doubling the numerator changes nothing; halving the value halves the
            // floor.
            let value = quotient(n, d, e).floor_times(scale);
            let other = quotient(n * 2, d, e - 1).floor_times(scale);
            prop_assert_eq!(value, other);
            let finer = quotient(n, d, e - 1).floor_times(scale);
            if value.unsigned_abs() < 1 << 62 {
                prop_assert!(finer == value >> 1, "{} {}", value, finer);
            }
        }

        #[test]
        fn values_lie_between_those_of_the_vertices(
            x in proptest::array::uniform3(-1e6_f32..1e6), w in proptest::array::uniform3(0.01_f32..100.0),
        ) {
            let p = [[1.0, 2.0, 0.0, w[0]], [90.0, 7.0, 0.0, w[1]], [13.0, 71.0, 0.0, w[2]]];
            let t = Triangle::new(p, true, Profile::Nv2a).expect("area");
            let g = t.attribute(x);
            for (i, j) in [(20, 20), (40, 9), (14, 60), (60, 15)] {
                let e = t.edges(i, j);
                prop_assume!(t.covers(e));
                let s = Sample::new(&t, e);
                let value = f64::from(s.attribute(&g).rounded_f32());
                let terms: [f64; 3] = std::array::from_fn(|k| s.n[k] as f64 / s.d as f64 * f64::from(x[k]));
                let exact = terms[0] + terms[1] + terms[2];
                let size = x.iter().map(|x| f64::from(x.abs())).fold(0.0, f64::max);
                prop_assert!((value - exact).abs() <= exact.abs() * 6e-8 + size * 1e-14, "{value} {exact}");
            }
        }
    }

    #[test]
    fn ratios_of_nothing() {
        let of = |n: i128, d: i128| quotient(n, 1, 0).binary_ratio(&quotient(d, 1, 0));
        assert_eq!([of(0, 0), of(-1, 0), of(0, 3), of(-4, 2)], [Binary::default(); 4]);
        assert_eq!(crate::raster::depth::word(crate::state::DepthFormat::Z24S8, of(1, 0)), 0xff_ffff);
        assert_eq!(crate::raster::depth::word(crate::state::DepthFormat::Z24S8, of(-6, -2)), 3);
    }

    #[test]
    fn extremes() {
        assert_eq!(quotient(1, 2, -149).rounded_f32().to_bits(), 0);
        assert_eq!(quotient(3, 2, -149).rounded_f32().to_bits(), 2);
        assert_eq!(quotient((1 << 90) + 1, 2, -239).rounded_f32().to_bits(), 1);
        assert_eq!(quotient(1, 1, -400).rounded_f32().to_bits(), 0);
        assert_eq!(quotient(-1, 1, 400).rounded_f32(), f32::NEG_INFINITY);
        assert_eq!(quotient((1 << 24) - 1, 1, 104).rounded_f32(), f32::MAX);
        assert_eq!(quotient((1 << 25) - 1, 1, 103).rounded_f32(), f32::INFINITY);
        assert_eq!(quotient(0, 5, 900).rounded_f32().to_bits(), 0);
        assert_eq!(quotient(0, 5, 900).truncated_24(), (0, 0));
        assert_eq!(quotient(1, 3, 120).floor_times(1), i64::MAX);
        assert_eq!(quotient(-1, 3, 900).floor_times(1), i64::MIN);
        assert_eq!(quotient(-1, 3, -900).floor_times(i64::MAX), -1);
        assert_eq!(quotient(1, 3, -900).floor_times(i64::MAX), 0);
        assert_eq!(quotient(-7, 2, 0).floor_times(1), -4);
    }

    #[test]
    fn equal_vertices_give_their_value_everywhere() {
        let p = [[1.0, 2.0, 0.0, 1.3], [90.0, 7.0, 0.0, 2.9], [13.0, 71.0, 0.0, 0.7]];
        let t = Triangle::new(p, true, Profile::Nv2a).expect("area");
        for x in [0.1, -3.3e38, 1e-45, 7.0, -0.0] {
            let g = t.attribute([x; 3]);
            for (i, j) in [(20, 20), (40, 9), (300, 900), (4095, -4096)] {
                let s = Sample::new(&t, t.edges(i, j));
                let expected = if s.d > 0 { x } else { 0.0 };
                assert_eq!(s.attribute(&g).rounded_f32(), expected, "{i} {j}");
            }
        }
    }
}
