//! INT-5: fog functions, evaluated at each pixel in integers.
//!
//! The coordinate d enters with 24 significant bits, p0 and p1 as the single-precision numbers that they are. Linear fog is computed
//! without error up to the floor to 4096ths; the exponentials have one more step, a power of two floored to 32 fraction bits.

use super::attribute::Attribute;
use super::interpolate::Sample;
use super::setup::Triangle;
use crate::number::convert::{shift, split};
use crate::state::{FogFunction, FogMode};

/// Fraction bits of powers of two.
pub const POWER_BITS: u32 = 32;

/// Exponents of powers are limited to this: fog has no use for larger ones.
pub const LARGEST_POWER: i32 = 16;

/// Fraction bits of an exponent x of a power.
const EXPONENT_BITS: i32 = 120;

/// What a triangle's vertices give for fog.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FogPlane {
    /// Factors, clamped to 0..1: floor(4096 P_k f_k) (INT-5n).
    Factor([i64; 3]),
    /// Coordinates for a function of each pixel.
    Coordinate(FogFunction, Attribute),
    /// A coordinate or a parameter is not finite: the factor in 4096ths that stands for it.
    Infinite(i64),
}

/// A fog factor, and what it was made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FogFactor {
    /// In 4096ths, 0..=4096.
    pub value: i64,
    /// The coordinate m 2^e as (m, e); (0, 0) where factors are interpolated.
    pub coordinate: (i64, i32),
    /// The power of two in 2^-32; none in linear modes.
    pub power: Option<i64>,
}

impl FogPlane {
    /// Sets up the fog of a triangle from what its vertices have: factors, or coordinates of the function.
    pub fn new(triangle: &Triangle, function: Option<FogFunction>, vertices: [f32; 3]) -> FogPlane {
        match function {
            None => FogPlane::Factor(triangle.factor(vertices.map(|f| f.clamp(0.0, 1.0)))),
            Some(f) if vertices.iter().chain([&f.p0, &f.p1]).all(|n| n.is_finite()) => {
                FogPlane::Coordinate(f, triangle.attribute(vertices))
            }
            Some(f) => FogPlane::Infinite(match f.mode {
                FogMode::Linear | FogMode::LinearAbs | FogMode::Exp => 4096,
                FogMode::Exp2 | FogMode::ExpAbs | FogMode::Exp2Abs => 0,
            }),
        }
    }

    /// The factor at a sample.
    #[inline]
    pub fn at(&self, sample: &Sample<'_>) -> FogFactor {
        match self {
            FogPlane::Factor(g) => FogFactor { value: sample.factor(g), coordinate: (0, 0), power: None },
            FogPlane::Coordinate(function, attribute) => evaluate(function, sample.attribute(attribute).truncated_24()),
            FogPlane::Infinite(value) => FogFactor { value: *value, coordinate: (0, 0), power: None },
        }
    }
}

/// INT-5 at the coordinate m 2^e given as (m, e), |m| < 2^24; p0 and p1 are finite.
pub fn evaluate(function: &FogFunction, coordinate: (i64, i32)) -> FogFactor {
    let (factor, power) = factor(function, coordinate);
    FogFactor { value: factor >> (POWER_BITS - 12), coordinate, power }
}

/// The same factor floored to 2^-32, 0..=2^32, and the power of two in it.
pub fn factor(function: &FogFunction, coordinate: (i64, i32)) -> (i64, Option<i64>) {
    let (p0, p1) = (split(function.p0), split(function.p1));
    // d p1, exactly: 48 bits.
    let product = (coordinate.0 * p1.0, coordinate.1 + p1.1);
    let power = match function.mode {
        FogMode::Linear | FogMode::LinearAbs => None,
        FogMode::Exp | FogMode::ExpAbs => Some(exponent(i128::from(product.0), product.1 + 4)),
        FogMode::Exp2 | FogMode::Exp2Abs => {
            let magnitude = i128::from(product.0);
            Some(exponent(-magnitude * magnitude, 2 * product.1 + 5))
        }
    };
    let power = power.map(power_of_two);
    let sum = match power {
        None => Fixed::sum(p0, product).plus(-(1 << POWER_BITS)),
        Some(power) => Fixed::sum(p0, (0, 0)).plus(power - (3 << (POWER_BITS - 1))),
    };
    let factor = match function.mode {
        FogMode::Linear | FogMode::Exp | FogMode::Exp2 => sum.floor,
        FogMode::LinearAbs | FogMode::ExpAbs | FogMode::Exp2Abs => sum.magnitude(),
    };
    (factor.clamp(0, 1 << POWER_BITS) as i64, power.map(|power| power as i64))
}

/// A number floored to 2^-32, and whether something was cut off: the number lies above by less than 2^-32. Far outside 0..1 it is
/// limited and the rest is not kept.
#[derive(Clone, Copy)]
struct Fixed {
    floor: i128,
    rest: bool,
}

impl Fixed {
    /// The sum of two numbers m 2^e of at most 48 bits.
    fn sum(a: (i64, i32), b: (i64, i32)) -> Fixed {
        // A zero must not decide where the other one is cut.
        let ((high, high_at), (low, low_at)) = if b.0 == 0 || (a.0 != 0 && a.1 >= b.1) { (a, b) } else { (b, a) };
        // If the exponents are further apart than this, the lower number is less than 2^-28 of the higher one: they cannot cancel, and
        // where the cut at 2^(high_at - 76) is not below 2^-32 the sum is beyond 2^43.
        let gap = (high_at - low_at).clamp(0, 76);
        let (low, cut) = floor(i128::from(low), low_at - (high_at - gap));
        let (sum, at) = ((i128::from(high) << gap) + low, high_at - gap + POWER_BITS as i32);
        if at <= 0 {
            let (floor, rest) = floor(sum, at);
            return Fixed { floor, rest: rest || cut };
        }
        // Beyond 2^60 only the sign counts.
        let limit = 1_i128 << 92;
        let fits = at < 92 && sum.unsigned_abs() < 1 << (92 - at);
        Fixed { floor: if fits { sum << at } else { limit * sum.signum() }, rest: cut }
    }

    /// Adds a multiple of 2^-32.
    fn plus(self, n: i128) -> Fixed {
        Fixed { floor: self.floor + n, rest: self.rest }
    }

    /// The magnitude, floored to 2^-32.
    fn magnitude(self) -> i128 {
        if self.floor < 0 { -self.floor - i128::from(self.rest) } else { self.floor }
    }
}

/// floor(n 2^exponent), and whether something was cut off. The result fits.
fn floor(n: i128, exponent: i32) -> (i128, bool) {
    let floored = shift(n, exponent);
    (floored, exponent < 0 && shift(floored, -exponent.max(-126)) != n)
}

/// m 2^e in 2^-120, floored; limited to -64..=16.
fn exponent(m: i128, e: i32) -> i128 {
    let top = 128 - m.unsigned_abs().leading_zeros() as i32 + e;
    let (lowest, highest) = (-64_i128 << EXPONENT_BITS, i128::from(LARGEST_POWER) << EXPONENT_BITS);
    if m != 0 && top > 6 {
        return if m < 0 { lowest } else { highest };
    }
    shift(m, e + EXPONENT_BITS).clamp(lowest, highest)
}

/// floor(2^(32 + x)) of x in 2^-120, -64 <= x <= 16.
///
/// The fraction's power is a series in 128-bit fixed point of which every operation rounds down, so the result is never above the
/// true power, and less than 2^-118 of it below (the floor of x included). It is the true floor unless the true power lies within
/// that distance above a multiple of 2^-32. It is such a multiple only where x is a whole number: there the series gives 1 exactly.
/// Other powers are irrational; they come that close only by chance, which is 2^-86 for each of the some 2^54 products of d and p1.
pub fn power_of_two(x: i128) -> i128 {
    let whole = (x >> EXPONENT_BITS) as i32;
    let fraction = (x & ((1 << EXPONENT_BITS) - 1)) as u128;
    if whole < -(POWER_BITS as i32) {
        return 0;
    }
    let fraction = fraction << (127 - EXPONENT_BITS);
    let mut series = 0;
    let mut n = SERIES.len();
    while n > 0 {
        n -= 1;
        series = SERIES[n] + multiply(series, fraction);
    }
    (series >> (127 - POWER_BITS as i32 - whole)) as i128
}

/// The natural logarithm of 2, 127 fraction bits, floored.
const LN_2: u128 = 0x58b9_0bfb_e8e7_bcd5_e4f1_d9cc_01f9_7b57;

/// ln(2)^n / n!, 127 fraction bits, each less than 3 below the true value. The first that is left out is below 2^-129.
const SERIES: [u128; 31] = {
    let mut series = [1 << 127; 31];
    let mut n = 1;
    while n < series.len() {
        series[n] = multiply(series[n - 1], LN_2) / n as u128;
        n += 1;
    }
    series
};

/// The floor of a product of numbers with 127 fraction bits. The product is below 2.
const fn multiply(a: u128, b: u128) -> u128 {
    const LOW: u128 = u64::MAX as u128;
    let (a1, a0, b1, b0) = (a >> 64, a & LOW, b >> 64, b & LOW);
    let middle = a1 * b0 + ((a0 * b0) >> 64);
    let cross = a0 * b1 + (middle & LOW);
    let high = a1 * b1 + (middle >> 64) + (cross >> 64);
    // One bit more from the lower half.
    high << 1 | (cross >> 63 & 1)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::float_arithmetic, reason = "real-number text of the functions")]
    use super::*;
    use crate::number::convert::factor_byte;
    use crate::state::{Named, Profile};
    use proptest::prelude::*;

    /// Numbers of 192 fraction bits, 32 bits a place, lowest first.
    type Wide = Vec<u32>;
    const PLACES: usize = 6;

    fn product(a: &Wide, b: &Wide) -> Wide {
        let mut out = vec![0_u32; a.len() + b.len()];
        for (i, x) in a.iter().enumerate() {
            let mut carry = 0_u64;
            for (j, y) in b.iter().enumerate() {
                let sum = u64::from(out[i + j]) + u64::from(*x) * u64::from(*y) + carry;
                (out[i + j], carry) = (sum as u32, sum >> 32);
            }
            out[i + b.len()] = carry as u32;
        }
        out
    }

    /// floor(sqrt(a)), a below 4, found bit by bit.
    fn root(a: &Wide) -> Wide {
        let mut square = vec![0; PLACES];
        square.extend(a);
        let mut root = vec![0; PLACES + 1];
        for bit in (0..=32 * PLACES).rev() {
            let mut tried: Wide = root.clone();
            tried[bit / 32] |= 1 << (bit % 32);
            let tried_square = product(&tried, &tried);
            if tried_square[..square.len()].iter().rev().le(square.iter().rev()) {
                root = tried;
            }
        }
        root
    }

    /// 2^(2^-k) for k = 1..=120.
    fn roots() -> Vec<Wide> {
        let mut two = vec![0; PLACES + 1];
        two[PLACES] = 2;
        let mut roots = vec![root(&two)];
        while roots.len() < 120 {
            roots.push(root(&roots[roots.len() - 1]));
        }
        roots
    }

    /// floor(2^(32 + x)), x in 2^-120, as a product of roots of 2.
    fn by_roots(roots: &[Wide], x: i128) -> i128 {
        let mut power = vec![0; PLACES + 1];
        power[PLACES] = 1;
        for (k, root) in roots.iter().enumerate() {
            if x >> (119 - k) & 1 == 1 {
                power = product(&power, root)[PLACES..2 * PLACES + 1].to_vec();
            }
        }
        let whole = (x >> 120) as i32;
        let top = power[2..].iter().rev().fold(0_u128, |n, place| n.wrapping_shl(32) | u128::from(*place));
        // `top` keeps the 128 highest fraction bits and loses the 1 before them.
        let keep = 32 + whole;
        if keep < 0 { 0 } else { (1 << keep) + if keep == 0 { 0 } else { (top >> (128 - keep)) as i128 } }
    }

    #[test]
    fn powers_are_those_of_the_roots_of_two() {
        let roots = roots();
        let mut random = crate::random::Random::seeded(1);
        let mut next = || u128::from(random.bits()) << 64 | u128::from(random.bits());
        for n in 0..4000 {
            let x = (next() as i128 >> 1) % (80 << 120) - (64 << 120);
            // Fewer bits, as d and p1 of few bits give.
            let x = if n % 2 == 0 { x } else { x >> (n % 118) << (n % 118) };
            assert_eq!(power_of_two(x), by_roots(&roots, x), "{x:#x}");
        }
        for whole in -33..=16_i128 {
            for near in [-3, -2, -1, 0, 1, 2, 3, 1 << 60, -(1 << 60)] {
                let x = ((whole << 120) + near).min(16 << 120);
                assert_eq!(power_of_two(x), by_roots(&roots, x), "{whole} {near}");
            }
        }
    }

    #[test]
    fn powers_as_listed() {
        // floor(2^(32 + x)) to 40 digits by another program.
        for ((n, k), expected) in [
            ((-1_i128, 1), 3037000499),
            ((1_i128, 1), 6074000999),
            ((-5_i128, 2), 1805811301),
            ((-12345_i128, 12), 531717233),
            ((-16777215_i128, 20), 65536),
            ((-1_i128, 100), 4294967295),
            ((1_i128, 100), 4294967296),
            ((-281474976710655_i128, 46), 268435456),
            ((24691358027469_i128, 41), 10304427973681),
            ((-33_i128, 0), 0),
            ((-32_i128, 0), 1),
            ((-129_i128, 2), 0),
            ((15_i128, 0), 140737488355328),
        ] {
            assert_eq!(power_of_two(n << (120 - k)), expected, "{n} / 2^{k}");
        }
    }

    fn function(mode: FogMode, p0: f32, p1: f32) -> FogFunction {
        FogFunction { mode, p0, p1 }
    }

    /// In 4096ths.
    fn real(f: &FogFunction, d: f64) -> f64 {
        let (p0, p1) = (f64::from(f.p0), f64::from(f.p1));
        let signed = match f.mode {
            FogMode::Linear | FogMode::LinearAbs => p0 + d * p1 - 1.0,
            FogMode::Exp | FogMode::ExpAbs => p0 + (16.0 * d * p1).clamp(-64.0, 16.0).exp2() - 1.5,
            FogMode::Exp2 | FogMode::Exp2Abs => p0 + (-32.0 * d * d * p1 * p1).exp2() - 1.5,
        };
        let abs = matches!(f.mode, FogMode::LinearAbs | FogMode::ExpAbs | FogMode::Exp2Abs);
        4096.0 * if abs { signed.abs() } else { signed }.clamp(0.0, 1.0)
    }

    /// Floats of moderate size, with few or many bits.
    fn moderate() -> impl Strategy<Value = f32> {
        (any::<u32>(), -30_i32..8, 0_u32..23).prop_map(|(bits, exponent, zeros)| {
            f32::from_bits(bits & 0x807f_ffff & !((1 << zeros) - 1) | ((exponent + 127) as u32) << 23)
        })
    }

    fn finite() -> impl Strategy<Value = f32> {
        any::<u32>().prop_map(f32::from_bits).prop_filter("finite", |f| f.is_finite())
    }

    fn mode() -> impl Strategy<Value = FogMode> {
        (0..FogMode::ALL.len()).prop_map(|n| FogMode::ALL[n])
    }

    proptest! {
        #[test]
        fn linear_fog_is_exact(p0 in moderate(), p1 in moderate(), d in moderate()) {
            // All in 2^-110: 2^-53 times 2^-53 is the last bit of a product, 2^16 its first.
            let at = |(m, e): (i64, i32)| i128::from(m) << (e + 106);
            let (a, b) = (split(d), split(p1));
            let sum = at(split(p0)) + at((a.0 * b.0, a.1 + b.1)) - (1 << 106);
            let floor = |n: i128| (n >> 94).clamp(0, 4096) as i64;
            prop_assert_eq!(evaluate(&function(FogMode::Linear, p0, p1), split(d)).value, floor(sum));
            prop_assert_eq!(evaluate(&function(FogMode::LinearAbs, p0, p1), split(d)).value, floor(sum.abs()));
        }

        #[test]
        fn factors_are_the_real_ones_floored(mode in mode(), p0 in -3.0_f32..3.0, p1 in moderate(), d in moderate()) {
            let f = function(mode, p0, p1);
            let value = evaluate(&f, split(d)).value as f64;
            let real = real(&f, f64::from(d));
            prop_assert!(value <= real + 1e-6 && real < value + 1.0 + 1e-5, "{value} {real}");
        }

        #[test]
        fn factors_of_anything_are_factors(mode in mode(), p0 in finite(), p1 in finite(), d in finite()) {
            let f = function(mode, p0, p1);
            let value = evaluate(&f, split(d)).value;
            prop_assert!((0..=4096).contains(&value));
            let (real, size) = (real(&f, f64::from(d)), (f64::from(d) * f64::from(p1)).abs().max(f64::from(p0).abs()));
            // Where float64 knows.
            if size < 1e6 || matches!(mode, FogMode::Linear) && (f64::from(d) * f64::from(p1) + f64::from(p0)).abs() > 1e-9 * size {
                prop_assert!((value as f64 - real).abs() <= 1.001, "{value} {real}");
            }
        }
    }

    #[test]
    fn large_terms_cancel_exactly() {
        let (p0, p1) = (2.0_f32.powi(100), -2.0_f32.powi(60));
        assert_eq!(evaluate(&function(FogMode::Linear, p0, p1), split(2.0_f32.powi(40))).value, 0);
        assert_eq!(evaluate(&function(FogMode::LinearAbs, p0, p1), split(2.0_f32.powi(40))).value, 4096);
        // Coordinates times parameters of which 24 bits each count.
        let d = (1 << 22) as f32 + 0.5;
        assert_eq!(
            evaluate(&function(FogMode::Linear, -(2.0_f32.powi(44)) - 2.0_f32.powi(21), 2.0_f32.powi(22)), split(d))
                .value,
            0
        );
        let product = (8_388_609.0_f32, 8_388_607.0_f32);
        // (2^23 + 1)(2^23 - 1) = 2^46 - 1
        assert_eq!(evaluate(&function(FogMode::Linear, -(2.0_f32.powi(46)), product.0), split(product.1)).value, 0);
        assert_eq!(evaluate(&function(FogMode::LinearAbs, 2.0_f32.powi(46), -product.0), split(product.1)).value, 0);
        assert_eq!(
            evaluate(&function(FogMode::Linear, 2.0_f32.powi(46), -product.0 / 2.0), split(product.1)).value,
            4096
        );
    }

    #[test]
    fn magnitudes_see_what_was_cut_off() {
        // -1 + 2^-140 is a hair above -1: its magnitude is a hair below 1. -1 - 2^-140 is limited to 1.
        let tiny = f32::from_bits(1 << 9);
        assert_eq!(evaluate(&function(FogMode::LinearAbs, tiny, 0.0), (0, 0)).value, 4095);
        assert_eq!(evaluate(&function(FogMode::LinearAbs, -tiny, 0.0), (0, 0)).value, 4096);
        assert_eq!(evaluate(&function(FogMode::LinearAbs, tiny, -tiny), split(1.0)).value, 4096);
        assert_eq!(evaluate(&function(FogMode::Linear, 2.0, -tiny), split(tiny)).value, 4095);
        assert_eq!(evaluate(&function(FogMode::Linear, 2.0, tiny), split(tiny)).value, 4096);
        // 2^x of a hair below 0 is below 1.
        assert_eq!(evaluate(&function(FogMode::Exp, 1.5, -tiny), split(tiny)).value, 4095);
        assert_eq!(evaluate(&function(FogMode::Exp, 1.5, -tiny), (0, 0)).value, 4096);
    }

    #[test]
    fn what_is_not_finite_is_near_or_far() {
        let triangle =
            Triangle::new([[0.0, 0.0, 0.0, 1.0], [90.0, 0.0, 0.0, 1.0], [0.0, 90.0, 0.0, 1.0]], true, Profile::Nv2a)
                .expect("area");
        let sample = Sample::new(&triangle, triangle.edges(5, 5));
        for mode in FogMode::ALL {
            let expected = if matches!(mode, FogMode::Linear | FogMode::LinearAbs | FogMode::Exp) { 4096 } else { 0 };
            let far = FogPlane::new(&triangle, Some(function(*mode, 1.5, -0.1)), [0.0, f32::INFINITY, 1.0]);
            assert_eq!(far.at(&sample).value, expected);
            let steep = FogPlane::new(&triangle, Some(function(*mode, f32::NAN, -0.1)), [0.0, 2.0, 1.0]);
            assert_eq!(steep.at(&sample).value, expected);
            let plain = FogPlane::new(&triangle, Some(function(*mode, 1.5, -0.1)), [0.0, 2.0, 1.0]);
            assert!(matches!(plain, FogPlane::Coordinate(..)));
        }
    }

    #[test]
    fn distances_of_a_screen() {
        // A row of a linear ramp from 0 to 100, start 0, end 100: byte by byte from 255 to 0, never rising.
        let f = function(FogMode::Linear, 2.0, -0.01);
        let mut last = 255;
        for d in 0..=100_u16 {
            let byte = factor_byte(evaluate(&f, split(f32::from(d))).value);
            assert!(byte <= last);
            last = byte;
        }
        assert_eq!(last, 0);
    }
}
