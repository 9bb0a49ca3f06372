//! TEX-10, TEX-11 on rows: the level of detail of quads, from how fast coordinates change or from the coordinates.
#![allow(clippy::float_arithmetic, reason = "estimates: no result depends on how they are rounded")]

use super::base_level::{BaseLevel, Slopes};
use super::quads::{AtQuads, Measure};
use super::quotient::{Line, nearest_32, whole_32};
use crate::texture::lod::{self, Quad};
use crate::texture::planned::PlannedUnit;

/// If coordinates of a quad are further apart, in 1/65536 texel, the definition computes its level of detail.
const FARTHEST: f64 = (1 << 26) as f64;

/// Distance of a mantissa from a power of two below which nothing is proved. Seven squarings multiply rounding errors by 128.
const LOG_MARGIN: f64 = 1.0 / (1_u64 << 40) as f64;

/// Levels of detail per factor e: 256 / ln 2.
const STEPS_PER_E: f64 = 369.33;

/// Upper bound of the error of [`log2_in_steps`].
const LOG_ERROR: f64 = 1.0 / 2048.0;

/// Upper bound of the relative error of the inverse root that bits give.
const ROOT_ERROR: f64 = 0.04;

impl Measure for i32 {
    fn behind(_: &PlannedUnit) -> i32 {
        lod::LEAST
    }

    #[inline(always)]
    fn estimate<const FMA: bool>(
        (unit, base): (&PlannedUnit, &BaseLevel<'_>),
        origins: [&[f32]; 2],
        lods: &mut [i32],
        close: &mut [i32],
    ) -> bool {
        let (slopes, proves) = match base.slopes {
            Some(slopes) => (slopes, true),
            None => Slopes::with_proof(base),
        };
        if proves {
            slopes.lods::<FMA>(lod::Selection::from_unit(unit).least_read(), origins, lods, close);
        }
        proves
    }

    #[inline(always)]
    fn measure<const WIDE: bool>(_: &PlannedUnit, at: &AtQuads, _: usize, out: &mut [i32], unknown: &mut [u64]) {
        log_ratios(at, out.len(), out, unknown);
    }

    fn defined(_: &PlannedUnit, quad: Option<Quad>) -> i32 {
        lod::log2_ratio(quad)
    }
}

impl Slopes {
    /// Sets up the quads of a batch, and returns whether anything would be proved. Without branches, so that compilers set up several batches at once.
    #[inline(always)]
    pub(super) fn with_proof(base: &BaseLevel<'_>) -> (Slopes, bool) {
        let unit = 1.0 / base.denominator.c;
        let (d, lowest, [columns, rows]) = (base.denominator.times(unit), base.lowest * unit, base.reach);
        let (mut right, mut below, mut cross) = ([0.0; 2], [0.0; 2], [0.0; 2]);
        // Sums of the magnitudes of all numerators, and of the terms whose differences they are.
        let (mut size, mut terms) = (0.0, 0.0);
        for (n, line) in [base.along, base.down].into_iter().enumerate() {
            let Line { c, x, y } = line.times(256.0 * unit);
            let all = [x - c * d.x, y - c * d.y, x * d.y - y * d.x];
            size += all[0].abs() + all[1].abs() + all[2].abs() * (columns + rows);
            terms += (x.abs() + y.abs()) * (1.0 + (columns + rows) * (d.x.abs() + d.y.abs()));
            terms += c.abs() * (d.x.abs() + d.y.abs());
            (right[n], below[n], cross[n]) = (all[0] as f32, all[1] as f32, all[2] as f32);
        }
        let widest = 1.0 / (lowest * lowest);
        let ratio = (1.0 + d.x.abs() * columns + d.y.abs() * rows) / lowest;
        // Estimates of both coordinates, rounding in single precision, and in double precision.
        let off = 512.0 * base.off + (size / (1 << 21) as f64 + terms / (1_u64 << 48) as f64) * widest;
        let proves = (lowest > 0.0) & (ratio < 64.0) & (off < 4.0) & (size * widest < FARTHEST / 4.0);
        // A floor moves each difference by less than 1, and the larger distance by less than the root of 2.
        let of_floors = STEPS_PER_E * (1.0 + ROOT_ERROR) * std::f64::consts::SQRT_2 * (1.0 + off);
        let of_any = LOG_ERROR + STEPS_PER_E * ratio / (1 << 20) as f64;
        let (denominator, margins) = ([d.x as f32, d.y as f32], [of_any as f32, of_floors as f32]);
        (Slopes { denominator, right, below, cross, margins }, proves)
    }

    /// Computes the levels of detail of quads. Sets the sign bits of those that are not proved, and clears those of the others. Below `least_read`
    /// they need not be exact.
    #[inline(always)]
    fn lods<const FMA: bool>(&self, least_read: i32, [xs, ys]: [&[f32]; 2], lods: &mut [i32], close: &mut [i32]) {
        // The floor of a logarithm that is larger by the error is at most one more, and another one covers the roundings of this sum.
        let least_read = (least_read - 2) as f32;
        let lanes = lods.len();
        let (xs, ys, close) = (&xs[..lanes], &ys[..lanes], &mut close[..lanes]);
        let Slopes { denominator: [dx, dy], right, below, cross, margins: [of_any, of_floors] } = *self;
        for n in 0..lanes {
            let (x, y) = (xs[n], ys[n]);
            let here = fused::<FMA>(dy, y, fused::<FMA>(dx, x, 1.0));
            let (on_right, lower) = (here + dx, here + dy);
            let square = |[u, v]: [f32; 2], by: f32| (u * u + v * v) * (by * by);
            let right = square([0, 1].map(|k| fused::<FMA>(cross[k], y, right[k])), lower);
            let below = square([0, 1].map(|k| fused::<FMA>(-cross[k], x, below[k])), on_right);
            let (largest, all) = (if right > below { right } else { below }, here * on_right * lower);
            let bits = (largest / (all * all)).to_bits() as i32;
            let mantissa = f32::from_bits((bits & ((1 << 23) - 1)) as u32 | 1.0_f32.to_bits());
            let inverse_root = f32::from_bits((0x5f37_59df - (bits >> 1)) as u32);
            let log = log2_in_steps::<FMA>(mantissa) - 0.5;
            let from_middle = (log - whole_32(log)).abs();
            lods[n] = 128 * ((bits >> 23) - 127 - 32) + nearest_32(log);
            let error = of_any + of_floors * inverse_root;
            close[n] = ((0.5 - error - from_middle).to_bits() & (least_read - error - lods[n] as f32).to_bits()) as i32;
        }
    }
}

/// Multiplies and adds in single precision.
#[inline(always)]
fn fused<const FMA: bool>(a: f32, b: f32, c: f32) -> f32 {
    if FMA { a.mul_add(b, c) } else { a * b + c }
}

/// Returns 128 times the binary logarithm of a number from 1 to 2.
#[inline(always)]
fn log2_in_steps<const FMA: bool>(n: f32) -> f32 {
    // The polynomial of degree 6 with the least error around 1.5.
    const TERMS: [f32; 7] = [-3.288_459_3, 5.622_908, -9.008_222, 18.139_91, -41.043_494, 123.113_12, 74.875_27];
    let z = n - 1.5;
    let mut sum = TERMS[0];
    for term in &TERMS[1..] {
        sum = fused::<FMA>(sum, z, *term);
    }
    sum
}

/// Computes the levels of detail of quads from their coordinates. Sets the sign bits of those that are not known.
#[inline(always)]
fn log_ratios(at: &AtQuads, lanes: usize, lods: &mut [i32], unknown: &mut [u64]) {
    let [[u, v], [right_u, right_v], [lower_u, lower_v]] = at;
    let (lods, unknown) = (&mut lods[..lanes], &mut unknown[..lanes]);
    for n in 0..lanes {
        let (a, b, c, d) = (right_u[n] - u[n], right_v[n] - v[n], lower_u[n] - u[n], lower_v[n] - v[n]);
        let far = |d: f64| (FARTHEST - d.abs()).to_bits();
        let mut open = far(a) | far(b) | far(c) | far(d);
        // Integers below 2^53, so they are exact.
        let (right, lower) = (a * a + b * b, c * c + d * d);
        let largest = if right > lower { right } else { lower };
        let bits = largest.to_bits();
        // The exponent of its 128th power is the logarithm. A mantissa hardly above 1 is moved away from it, which leaves the exponent 0.
        let mut power = f64::from_bits(bits & ((1 << 52) - 1) | 1.0_f64.to_bits());
        for _ in 0..7 {
            power *= power;
        }
        let power = if power > 1.0 + 2.0 * LOG_MARGIN { power } else { 1.0 + 2.0 * LOG_MARGIN };
        let log = 128 * ((bits >> 52) as i32 - 1023) + (power.to_bits() >> 52) as i32 - 1023;
        let mantissa = f64::from_bits(power.to_bits() & ((1 << 52) - 1) | 1.0_f64.to_bits());
        open |= (mantissa - (1.0 + LOG_MARGIN)).to_bits() | (2.0 - LOG_MARGIN - mantissa).to_bits();
        lods[n] = if largest > 0.0 { log - 128 * 32 } else { lod::LEAST };
        unknown[n] |= open;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The bounds of the errors of logarithms and of inverse roots, over all mantissas.
    #[test]
    fn errors_are_bounded() {
        for bits in (1.0_f32.to_bits()..2.0_f32.to_bits()).step_by(if cfg!(debug_assertions) { 37 } else { 1 }) {
            let n = f32::from_bits(bits);
            let log = 128.0 * f64::from(n).log2();
            for found in [log2_in_steps::<true>(n), log2_in_steps::<false>(n)] {
                assert!((f64::from(found) - log).abs() < LOG_ERROR, "{n}: {found} {log}");
            }
            for n in [n, 2.0 * n] {
                let root = f64::from(f32::from_bits(0x5f37_59df - (n.to_bits() >> 1)));
                assert!((1.0 / f64::from(n).sqrt() / root - 1.0).abs() < ROOT_ERROR, "{n}: {root}");
            }
        }
    }
}
