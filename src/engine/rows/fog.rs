//! NUM-6 and INT-5 on rows.
#![allow(clippy::float_arithmetic, reason = "estimates: no result depends on how they are rounded")]

use super::Reason;
use super::kernels::LANES;
use super::planes::{Plane, inverse};
use super::quotient::{IOTA_REAL, Line, Positions, estimate_two, nearest, position, settle};
use super::triangle::{Bounds, Piece, Setup};
use crate::engine::pixel::TriangleContext;
use crate::number::convert::factor_byte;
use crate::raster::fog::FogPlane;
use crate::raster::interpolate::Sample;
use crate::state::{FogFunction, FogMode};

/// What a triangle's pixels have in the fog register's alpha.
#[derive(Clone, Copy, Debug)]
pub(super) enum Fog {
    /// The same everywhere.
    Same(i16),
    /// Factors in 4096ths, over D.
    Factor(Plane),
    /// A function of a coordinate.
    Function(Curve),
}

/// A fog function of a coordinate over D.
#[derive(Clone, Copy, Debug)]
pub(super) struct Curve {
    coordinate: Plane,
    /// What makes it the argument: d p1 of linear functions, the exponent 16 d p1, or the root of 1/32 of the exponent.
    scale: f64,
    mode: FogMode,
    /// p0 and the constant of the function.
    start: f64,
}

/// How far arguments are off, relative to themselves: a coordinate keeps 24 bits, toward zero, and the exponent of Exp2 is a square.
const TRUNCATED: f64 = 1.0 / (1 << 22) as f64;

/// What an estimate of an argument may be off by besides.
const COARSEST: f64 = 1.0 / 1024.0;

/// More than [`power_of_two`] is off by, and what the rule floors away, relative to a power.
const POWER: f64 = 1.0 / (1 << 26) as f64;

/// More than what is floored away of a power, and roundings of double precision.
const FLOORED: f64 = 1.0 / (1_u64 << 31) as f64;

impl Fog {
    pub(super) fn new(context: &TriangleContext<'_>) -> Option<Fog> {
        let triangle = &context.triangle;
        let plane = |g: [i64; 3]| Plane::new(triangle, &inverse(triangle), g);
        match context.fog.as_ref()? {
            FogPlane::Factor(g) => Some(Fog::Factor(plane(*g))),
            FogPlane::Infinite(value) => Some(Fog::Same(i16::from(factor_byte(*value)))),
            FogPlane::Coordinate(function, attribute) => {
                let [a, b, c] = context.vertices().fog();
                if a == b && b == c {
                    // Any sample that the triangle covers.
                    let inside = Sample::new(triangle, [1; 3]);
                    let value = FogPlane::Coordinate(*function, *attribute).at(&inside).value;
                    return Some(Fog::Same(i16::from(factor_byte(value))));
                }
                let (g, exponent) = attribute.numbers();
                Some(Fog::Function(Curve::new(function, plane(g), exponent)))
            }
        }
    }
}

impl Curve {
    fn new(function: &FogFunction, coordinate: Plane, exponent: i32) -> Curve {
        let (times, offset) = match function.mode {
            FogMode::Linear | FogMode::LinearAbs => (1.0, -1.0),
            FogMode::Exp | FogMode::ExpAbs => (16.0, -1.5),
            FogMode::Exp2 | FogMode::Exp2Abs => (1.0, -1.5),
        };
        // A power of two of a single-precision number and less: far from the ends of double precision.
        let unit = f64::from_bits(((exponent + 1023).max(0) as u64) << 52);
        Curve {
            coordinate,
            scale: f64::from(function.p1) * times * unit,
            mode: function.mode,
            start: f64::from(function.p0) + offset,
        }
    }
}

impl Setup<'_> {
    /// The fog factor of the pixels of a piece. `values` and `spare` are places to work in.
    #[inline(always)]
    #[allow(clippy::too_many_arguments, reason = "what the caller has computed, and each result apart")]
    pub(super) fn fog_factors<const FMA: bool, const ROW: bool>(
        &self,
        piece: Piece<'_>,
        e: &[i64; 3],
        (real, denominator): (&[f64; 3], Line),
        bounds: &Bounds,
        values: &mut [i32; LANES],
        spare: &mut [i32; LANES],
        row: &mut [i16; LANES],
    ) {
        let Some(fog) = &self.fog else { return };
        let out = &mut row[piece.lanes()];
        let (values, spare) = (&mut values[..out.len()], &mut spare[..out.len()]);
        match &**fog {
            Fog::Same(factor) => out.fill(*factor),
            Fog::Factor(plane) => {
                let planes = [*plane, *plane];
                let Some(scaled) = self.scaled::<ROW>(&planes, 0, (real, denominator), bounds) else {
                    return self.defined_factors(piece, |_| true, out);
                };
                if estimate_two::<FMA, ROW>(piece.at, denominator, &scaled, values, spare)[0] {
                    let bottom = self.denominator.exact(e);
                    settle::<ROW>(piece.at, plane.exact(e), bottom, plane.small(self.bits), values, spare);
                }
                for (out, value) in out.iter_mut().zip(values) {
                    *out = i16::from(factor_byte(i64::from((*value).clamp(0, 4096))));
                }
            }
            Fog::Function(curve) => {
                let line = curve.coordinate.line(real).times(curve.scale);
                let off = self.margin::<ROW>(&curve.coordinate, real, bounds) * curve.scale.abs();
                // Also refuses what is no number.
                let proves = off < COARSEST;
                if !proves {
                    return self.defined_factors(piece, |_| true, out);
                }
                let lines = (line, denominator);
                let absolute = matches!(curve.mode, FogMode::LinearAbs | FogMode::ExpAbs | FogMode::Exp2Abs);
                let (at, ends) = (piece.at, (curve.start, off, absolute));
                let close = match curve.mode {
                    FogMode::Linear | FogMode::LinearAbs => factors::<0, FMA, ROW>(at, lines, ends, values, spare),
                    FogMode::Exp | FogMode::ExpAbs => factors::<1, FMA, ROW>(at, lines, ends, values, spare),
                    FogMode::Exp2 | FogMode::Exp2Abs => factors::<2, FMA, ROW>(at, lines, ends, values, spare),
                };
                for (out, value) in out.iter_mut().zip(&*values) {
                    *out = *value as i16;
                }
                if close {
                    self.defined_factors(piece, |n| values[n] != spare[n], out);
                }
            }
        }
    }

    /// Some of the factors by the definition.
    #[inline(never)]
    fn defined_factors(&self, piece: Piece<'_>, wanted: impl Fn(usize) -> bool, out: &mut [i16]) {
        let Some(fog) = &self.context.fog else { return };
        for n in (0..piece.count).filter(|n| wanted(*n)) {
            self.tell(Reason::Fog, 1);
            out[n] = i16::from(factor_byte(fog.at(&self.sample(piece, n)).value));
        }
    }
}

/// INT-5 as bytes of the least and of the largest factor that a lane can have. Says whether some differ.
///
/// `FUNCTION`: 0 linear, 1 exponential, 2 exponential of a square. `lines` make up the argument, which is off by `off` and what its 24 bits
/// lose.
#[inline(always)]
fn factors<const FUNCTION: u32, const FMA: bool, const ROW: bool>(
    at: Positions<'_>,
    lines: (Line, Line),
    (start, off, absolute): (f64, f64, bool),
    least: &mut [i32],
    most: &mut [i32],
) -> bool {
    let mut close = 0;
    let lanes = least.len();
    let last = f64::from(at.last);
    let (most, xs, ys, iota) = (&mut most[..lanes], &at.x[..lanes], &at.y[..lanes], &IOTA_REAL[..lanes]);
    let rounding = FLOORED * (2.0 + start.abs());
    for n in 0..lanes {
        let (x, y) = position::<ROW>(n, last, xs, ys, iota);
        let argument = lines.0.at::<FMA, ROW>(x, y) / lines.1.at::<FMA, ROW>(x, y);
        let (factor, error) = if FUNCTION == 0 {
            (start + argument, argument.abs() * TRUNCATED + off)
        } else {
            let (exponent, off, relative) = if FUNCTION == 1 {
                (argument, off, TRUNCATED)
            } else {
                // Arguments beyond 2 have exponents beyond the limit.
                (argument * argument * -32.0, 256.0 * off, 2.0 * TRUNCATED)
            };
            let exponent = if exponent > -64.0 { exponent } else { -64.0 };
            let exponent = if exponent < 16.0 { exponent } else { 16.0 };
            let power = power_of_two(exponent);
            (start + power, power * (exponent.abs() * relative + off + POWER))
        };
        let factor = if absolute { factor.abs() } else { factor };
        let error = error + rounding;
        let (low, high) = (limited((factor - error) * 4096.0), limited((factor + error) * 4096.0));
        let (low, high) = (factor_byte(i64::from(low)), factor_byte(i64::from(high)));
        (least[n], most[n]) = (i32::from(low), i32::from(high));
        close |= low ^ high;
    }
    close != 0
}

/// The floor of what is limited to 0..=4096. One less where it is a whole number, perhaps.
#[inline(always)]
fn limited(v: f64) -> i32 {
    let v = if v > 0.0 { v } else { 0.0 };
    nearest(if v < 4096.0 { v } else { 4096.0 } - 0.5)
}

/// 2^x of -64..=16, off by less than 2^-27 of itself.
#[inline(always)]
fn power_of_two(x: f64) -> f64 {
    /// ln(2)^n / n!.
    const SERIES: [f64; 8] = {
        let mut series = [1.0; 8];
        let mut n = 1;
        while n < 8 {
            series[n] = series[n - 1] * std::f64::consts::LN_2 / n as f64;
            n += 1;
        }
        series
    };
    let whole = super::quotient::whole(x);
    let f = x - whole;
    let [a, b, c, d, e, g, h, i] = SERIES;
    let series = a + f * (b + f * (c + f * (d + f * (e + f * (g + f * (h + f * i))))));
    // Exponents of doubles, added up: the low bits of what `nearest` is made of.
    f64::from_bits(series.to_bits().wrapping_add((nearest(x) as i64 as u64) << 52))
}
