//! FOG-2, FOG-4, FOG-5: the fog of a pixel, computed in integers from the fog of the vertices.
//!
//! Linear fog is a line over the interpolated coordinate, which enters with 24 significant bits. p0 and p1 are used as
//! exact single-precision numbers, and nothing is lost before the floor to 4096ths. The exponential modes are tables of
//! 32 segments, indexed by the interpolated e less 3/2.

use super::binary::Binary;
use super::interpolate::Sample;
use super::weights::{Linear, Number};
use crate::number::Integer;
use crate::number::convert::factor_byte;
use crate::state::{FogFunction, FogMode};

/// Number of fraction bits of 4096ths.
pub(crate) const FACTOR_BITS: i64 = 12;

/// 3/2 in 4096ths, which is subtracted from e.
pub(crate) const CENTRE: i64 = 6144;

/// Distance from the centre at which the tables end, in 4096ths.
pub(crate) const TABLE_END: i64 = 2048;

/// Limit of e in 4096ths, which is far beyond the tables.
const FARTHEST: i64 = 1 << 40;

/// Width of a segment of the tables, in 4096ths, and its binary logarithm.
const SEGMENT: i64 = 1 << SEGMENT_BITS;
const SEGMENT_BITS: i64 = 6;

/// Table of FOG-4's exponential: floor(255 2^(-i/4) + 1/2).
pub const EXPONENTIAL: [u8; 33] = [
    255, 214, 180, 152, 128, 107, 90, 76, 64, 54, 45, 38, 32, 27, 23, 19, 16, 13, 11, 9, 8, 7, 6, 5, 4, 3, 3, 2, 2, 2,
    1, 1, 1,
];

/// Table of FOG-4's squared exponential: floor(255 2^(-i^2/128) + 1/2).
pub const SQUARED: [u8; 33] = [
    255, 254, 250, 243, 234, 223, 210, 196, 180, 164, 148, 132, 117, 102, 88, 75, 64, 53, 44, 36, 29, 23, 19, 15, 11,
    9, 7, 5, 4, 3, 2, 1, 1,
];

/// The fog of a triangle, set up from its vertices.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FogPlane<N = Binary> {
    /// Factors, limited to 0..1 (INT-5n).
    Factor(Linear<N>),
    /// d', or e of INT-5n, for a linear function (FOG-2).
    Linear(Line, Linear<N>),
    /// e, for a table (FOG-4).
    Exponential(FogMode, Linear<N>),
    /// Some value is not finite. Holds the byte of all pixels (FOG-4, FOG-5).
    NotFinite(u8),
}

/// The function p0 + p1 d' - 1, limited to 0..1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Line {
    /// The constant term p0; the function is p0 - 1 at d' = 0.
    pub p0: f32,
    /// The slope p1, which multiplies d'.
    pub p1: f32,
    /// Whether the magnitude of d' is used.
    pub absolute: bool,
}

/// The function of an interpolated fog coordinate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Curve {
    /// FOG-2.
    Line(Line),
    /// FOG-4.
    Table(FogMode),
}

impl Curve {
    /// Returns the curve of a function, or `None` if its numbers are not finite.
    pub fn new(function: &FogFunction) -> Option<Curve> {
        let mode = function.mode;
        if !mode.is_linear() {
            return Some(Curve::Table(mode));
        }
        let (p0, p1) = if function.per_vertex { (0.0, 1.0) } else { (function.p0, function.p1) };
        let line = Line { p0, p1, absolute: mode == FogMode::LinearAbs };
        (p0.is_finite() && p1.is_finite()).then_some(Curve::Line(line))
    }
}

/// A fog byte and the value that it was computed from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FogFactor {
    /// The factor as a byte: the alpha of the fog register.
    pub byte: u8,
    /// The value that the byte was computed from.
    pub from: FogStep,
}

/// The value that a fog byte was computed from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FogStep {
    /// A factor in 4096ths, 0..=4096.
    Factor(i64),
    /// The same factor, and the coordinate of 24 bits that it was computed from.
    Linear(i64, Binary),
    /// Steps of 1/4096 from the centre of the table.
    Exponential(i64),
    /// The coordinate is not a finite number.
    NotFinite,
}

/// INT-5n: limits a factor to 0..1. NaN, which clipping makes of infinite factors, counts as 0.
pub fn limited(factor: f32) -> f32 {
    if factor.is_nan() { 0.0 } else { factor.clamp(0.0, 1.0) }
}

impl<N: Number> FogPlane<N> {
    /// Sets up the fog of a triangle from the values of its vertices: factors, or the d' or e of the function.
    pub fn new(function: Option<FogFunction>, vertices: [f32; 3]) -> FogPlane<N> {
        let Some(function) = function else {
            return FogPlane::Factor(Linear::new(vertices.map(limited)));
        };
        let finite = vertices.iter().all(|n| n.is_finite());
        match Curve::new(&function) {
            Some(Curve::Line(line)) if finite => FogPlane::Linear(line, Linear::new(vertices)),
            Some(Curve::Table(mode)) if finite => FogPlane::Exponential(mode, Linear::new(vertices)),
            _ => FogPlane::NotFinite(not_finite(function.mode)),
        }
    }
}

impl FogPlane {
    /// Returns the fog at a sample that the triangle covers.
    #[inline]
    pub fn at(&self, sample: &Sample<'_>) -> FogFactor {
        match self {
            FogPlane::Factor(f) => {
                let v = factor(sample.value(f));
                FogFactor { byte: factor_byte(v), from: FogStep::Factor(v) }
            }
            FogPlane::Linear(line, d) => {
                let coordinate = sample.value(d).cut();
                let v = line.at(coordinate);
                FogFactor { byte: factor_byte(v), from: FogStep::Linear(v, coordinate) }
            }
            FogPlane::Exponential(mode, e) => {
                let q = steps(sample.value(e));
                FogFactor { byte: exponential(*mode, q), from: FogStep::Exponential(q) }
            }
            FogPlane::NotFinite(byte) => FogFactor { byte: *byte, from: FogStep::NotFinite },
        }
    }
}

/// NUM-6: returns a factor in 4096ths, 0..=4096.
#[inline]
pub fn factor<I: Integer>(f: Binary<I>) -> I {
    f.floored(I::new(1), I::new(FACTOR_BITS), I::new(1 << FACTOR_BITS)).greatest(I::new(0))
}

/// FOG-4: returns the steps of 1/4096 by which e lies above 3/2.
#[inline]
pub fn steps<I: Integer>(e: Binary<I>) -> I {
    e.far_floored(I::new(1), I::new(FACTOR_BITS), I::new(FARTHEST)) - I::new(CENTRE)
}

/// FOG-4, FOG-5: returns the byte of a triangle with a value that is not finite.
pub fn not_finite(mode: FogMode) -> u8 {
    match mode {
        FogMode::Linear | FogMode::LinearAbs | FogMode::Exp => 255,
        FogMode::Exp2 | FogMode::ExpAbs | FogMode::Exp2Abs => 0,
    }
}

/// FOG-4: returns the byte for q, the steps of 1/4096 by which e lies above 3/2. The mode must not be linear.
#[inline]
pub fn exponential(mode: FogMode, q: i64) -> u8 {
    tabled(mode, q.clamp(-FARTHEST, FARTHEST)) as u8
}

/// [`exponential`] of any whole number.
#[inline(always)]
pub fn tabled<I: Integer>(mode: FogMode, q: I) -> I {
    let table: &'static [u8] = if matches!(mode, FogMode::Exp | FogMode::ExpAbs) { &EXPONENTIAL } else { &SQUARED };
    let n = q.magnitude();
    let is_beyond = I::new(TABLE_END - 1).is_below(n);
    let n = n.least(I::new(TABLE_END - 1));
    let (i, w) = (n.down(I::new(SEGMENT_BITS)), n.masked(SEGMENT - 1));
    let (from, to) = (i.entry(table), (i + I::new(1)).entry(table));
    let sum = from * (I::new(SEGMENT) - w) + to * w + I::new(SEGMENT / 2);
    let byte = I::new(0).or(is_beyond, sum.down(I::new(SEGMENT_BITS)));
    if matches!(mode, FogMode::Exp) { byte.or(q.is_negative(), I::new(255)) } else { byte }
}

impl Line {
    /// FOG-2: returns the factor v, 0..=4096, at a coordinate of 24 bits. p0 and p1 must be finite.
    #[inline]
    pub fn at<I: Integer>(&self, coordinate: Binary<I>) -> I {
        on_line(coordinate, self.absolute, [self.p0, self.p1].map(Binary::<I>::from_f32))
    }
}

/// FOG-2: returns [`Line::at`] of a line with the parameters p0 and p1.
#[inline(always)]
pub fn on_line<I: Integer>(coordinate: Binary<I>, absolute: bool, [p0, p1]: [Binary<I>; 2]) -> I {
    let d = if absolute { coordinate.mantissa.magnitude() } else { coordinate.mantissa };
    // An exact product of 48 bits.
    let product = Binary { mantissa: d, ..coordinate }.times(p1);
    let sum = p0.floored_sum(product, I::new(1), I::new(FACTOR_BITS), I::new(FARTHEST));
    (sum - I::new(1 << FACTOR_BITS)).limited(0, 1 << FACTOR_BITS)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::float_arithmetic, reason = "real-number text of the functions")]
    use super::*;
    use crate::number::convert::split;
    use crate::raster::setup::Triangle;
    use crate::state::{Named, Profile};
    use proptest::prelude::*;

    fn line(p0: f32, p1: f32) -> Line {
        Line { p0, p1, absolute: false }
    }

    fn magnitude(p0: f32, p1: f32) -> Line {
        Line { p0, p1, absolute: true }
    }

    /// Generates floats of moderate size with few or many significant bits.
    fn moderate() -> impl Strategy<Value = f32> {
        (any::<u32>(), -30_i32..8, 0_u32..23).prop_map(|(bits, exponent, zeros)| {
            f32::from_bits(bits & 0x807f_ffff & !((1 << zeros) - 1) | ((exponent + 127) as u32) << 23)
        })
    }

    fn finite() -> impl Strategy<Value = f32> {
        any::<u32>().prop_map(f32::from_bits).prop_filter("finite", |f| f.is_finite())
    }

    proptest! {
        #[test]
        fn linear_fog_is_exact(p0 in moderate(), p1 in moderate(), d in moderate()) {
            // All numbers in units of 2^-106: the last bit of a product is at least 2^-53 times 2^-53.
            let at = |(m, e): (i64, i32)| i128::from(m) << (e + 106);
            let (a, b) = (split(d), split(p1));
            let sum = |d: i64| at(split(p0)) + at((d * b.0, a.1 + b.1)) - (1 << 106);
            let floor = |n: i128| (n >> 94).clamp(0, 4096) as i64;
            prop_assert_eq!(line(p0, p1).at(Binary::new(d)), floor(sum(a.0)));
            prop_assert_eq!(magnitude(p0, p1).at(Binary::new(d)), floor(sum(a.0.abs())));
        }

        #[test]
        fn lines_of_anything_are_factors(p0 in finite(), p1 in finite(), d in finite()) {
            let value = line(p0, p1).at(Binary::new(d));
            let (p0, product) = (f64::from(p0), f64::from(d) * f64::from(p1));
            let real = 4096.0 * (p0 + product - 1.0).clamp(0.0, 1.0);
            // Only where float64 is accurate enough.
            let size = p0.abs().max(product.abs());
            if size < 1e6 || (p0 + product).abs() > 1e-9 * size {
                prop_assert!((value as f64 - real).abs() <= 1.001, "{value} {real}");
            }
            prop_assert!((0..=4096).contains(&value));
        }
    }

    fn function(mode: FogMode) -> FogFunction {
        FogFunction { mode, p0: 1.5, p1: -0.1, p2: 0.0, per_vertex: false }
    }

    #[test]
    fn tables_are_the_real_functions() {
        for i in 0..33 {
            let x = i as f64;
            let nearest = |exponent: f64| (255.0 * exponent.exp2() + 0.5).floor();
            assert_eq!(f64::from(EXPONENTIAL[i]), nearest(-x / 4.0), "{i}");
            assert_eq!(f64::from(SQUARED[i]), nearest(-x * x / 128.0), "{i}");
        }
        for q in -5000_i64..5000 {
            let x = q as f64 / 4096.0;
            for mode in [FogMode::Exp, FogMode::ExpAbs, FogMode::Exp2, FogMode::Exp2Abs] {
                let real = match mode {
                    FogMode::Exp => (16.0 * x).min(0.0).exp2(),
                    FogMode::ExpAbs => (-16.0 * x.abs()).exp2(),
                    _ => (-32.0 * x * x).exp2(),
                };
                // A chord lies above a convex curve, and each of its ends is rounded.
                assert!((f64::from(exponential(mode, q)) - 255.0 * real).abs() < 2.0, "{mode:?} {q}");
            }
        }
    }

    #[test]
    fn ends_of_the_tables() {
        use FogMode::{Exp, Exp2, Exp2Abs, ExpAbs};
        assert_eq!([Exp, ExpAbs, Exp2, Exp2Abs].map(|mode| exponential(mode, 0)), [255; 4]);
        assert_eq!([Exp, ExpAbs, Exp2, Exp2Abs].map(|mode| exponential(mode, 64)), [255, 214, 254, 254]);
        assert_eq!([Exp, ExpAbs, Exp2, Exp2Abs].map(|mode| exponential(mode, -64)), [214, 214, 254, 254]);
        assert_eq!([Exp, ExpAbs, Exp2, Exp2Abs].map(|mode| exponential(mode, -2047)), [1; 4]);
        assert_eq!([Exp, ExpAbs, Exp2, Exp2Abs].map(|mode| exponential(mode, -2048)), [0; 4]);
        assert_eq!([Exp, ExpAbs, Exp2, Exp2Abs].map(|mode| exponential(mode, 2048)), [255, 0, 0, 0]);
        assert_eq!([Exp, ExpAbs, Exp2, Exp2Abs].map(|mode| exponential(mode, i64::MIN)), [0; 4]);
        assert_eq!([Exp, ExpAbs, Exp2, Exp2Abs].map(|mode| exponential(mode, i64::MAX)), [255, 0, 0, 0]);
    }

    #[test]
    fn large_terms_cancel_exactly() {
        let (p0, p1) = (2.0_f32.powi(100), -2.0_f32.powi(60));
        assert_eq!(line(p0, p1).at(Binary::new(2.0_f32.powi(40))), 0);
        assert_eq!(magnitude(p0, p1).at(Binary::new(-(2.0_f32.powi(40)))), 0);
        // Coordinates times parameters that both have 24 significant bits.
        let d = (1 << 22) as f32 + 0.5;
        assert_eq!(line(-(2.0_f32.powi(44)) - 2.0_f32.powi(21), 2.0_f32.powi(22)).at(Binary::new(d)), 0);
        let product = (8_388_609.0_f32, 8_388_607.0_f32);
        // (2^23 + 1)(2^23 - 1) = 2^46 - 1
        assert_eq!(line(-(2.0_f32.powi(46)), product.0).at(Binary::new(product.1)), 0);
        assert_eq!(line(2.0_f32.powi(46), -product.0 / 2.0).at(Binary::new(product.1)), 4096);
    }

    #[test]
    fn what_is_below_a_step_counts() {
        let tiny = f32::from_bits(1 << 9);
        assert_eq!(line(2.0, -tiny).at(Binary::new(tiny)), 4095);
        assert_eq!(line(2.0, tiny).at(Binary::new(tiny)), 4096);
        assert_eq!(magnitude(2.0, tiny).at(Binary::new(-tiny)), 4096);
        assert_eq!(magnitude(2.0, -tiny).at(Binary::new(-tiny)), 4095);
    }

    #[test]
    fn what_is_not_finite_is_near_or_far() {
        let triangle =
            Triangle::new([[0.0, 0.0, 0.0, 1.0], [90.0, 0.0, 0.0, 1.0], [0.0, 90.0, 0.0, 1.0]], true, Profile::Nv2a)
                .expect("area");
        let sample = Sample::new(&triangle, triangle.edges(5, 5));
        for mode in FogMode::ALL {
            let expected = if matches!(mode, FogMode::Linear | FogMode::LinearAbs | FogMode::Exp) { 255 } else { 0 };
            for beyond in [f32::INFINITY, f32::NEG_INFINITY, f32::NAN] {
                let far = FogPlane::new(Some(function(*mode)), [0.0, beyond, 1.0]);
                assert_eq!(far.at(&sample), FogFactor { byte: expected, from: FogStep::NotFinite });
            }
            let plain: FogPlane = FogPlane::new(Some(function(*mode)), [0.0, 2.0, 1.0]);
            assert!(!matches!(plain, FogPlane::NotFinite(_)));
        }
        let steep = FogFunction { p0: f32::NAN, ..function(FogMode::Linear) };
        assert_eq!(FogPlane::<Binary>::new(Some(steep), [0.0, 2.0, 1.0]), FogPlane::NotFinite(255));
    }

    /// Values of the light unit reach the ends of single precision: e may be far outside the table, also beside small
    /// ones.
    #[test]
    fn steps_of_anything() {
        let triangle =
            Triangle::new([[0.0, 0.0, 0.0, 1.0], [90.0, 0.0, 0.0, 1.0], [0.0, 90.0, 0.0, 3.0]], true, Profile::Nv2a)
                .expect("area");
        let far = [f32::MAX, -f32::MAX, 1e-38, -1e-38, 1e-45, 0.0, 1.5];
        for e in far.iter().flat_map(|a| far.iter().flat_map(|b| far.iter().map(|c| [*a, *b, *c]))) {
            let plane = FogPlane::new(Some(function(FogMode::ExpAbs)), e);
            for (i, j) in [(5, 5), (30, 20), (0, 88), (88, 0)] {
                let sample = Sample::new(&triangle, triangle.edges(i, j));
                assert!(triangle.covers(sample.e));
                let byte = plane.at(&sample).byte;
                if e[0] == e[1] && e[1] == e[2] {
                    assert_eq!(byte, if e[0] == 1.5 { 255 } else { 0 }, "{e:?}");
                }
            }
        }
    }

    #[test]
    fn distances_of_a_screen() {
        // A row of a linear ramp with start 0 and end 100 falls from 255 to 0 and never rises.
        let f = line(2.0, -0.01);
        let mut last = 255;
        for d in 0..=100_u16 {
            let byte = factor_byte(f.at(Binary::new(f32::from(d))));
            assert!(byte <= last);
            last = byte;
        }
        assert_eq!(last, 0);
    }
}
