//! TEX-10, TEX-11 on rows: the level of detail of quads.
#![allow(
    clippy::float_arithmetic,
    reason = "whole numbers that doubles hold, and logarithms far enough from whole ones"
)]

use super::quads::{AtQuads, Measure};
use crate::texture::lod::{self, Quad};
use crate::texture::planned::PlannedUnit;

/// If coordinates of a quad are further apart, in 1/65536 texel, whole numbers take its level of detail.
const FARTHEST: f64 = (1 << 26) as f64;

/// Distance of a mantissa from a power of two below which a logarithm takes whole numbers. Seven squarings multiply rounding errors by 128.
const LOG_MARGIN: f64 = 1.0 / (1_u64 << 40) as f64;

impl Measure for i32 {
    #[inline(always)]
    fn measure(_: &PlannedUnit, at: &AtQuads, out: &mut [i32], open: &mut [u64]) {
        log_ratios(at, out, open);
    }

    fn of_quad(_: &PlannedUnit, quad: Option<Quad>) -> i32 {
        lod::log2_ratio(quad)
    }
}

/// Computes the levels of detail of quads from their coordinates. Sets the sign bits of those that take whole numbers.
#[inline(always)]
fn log_ratios(at: &AtQuads, lods: &mut [i32], open: &mut [u64]) {
    let lanes = lods.len();
    let [[u, v], [right_u, right_v], [lower_u, lower_v]] = at;
    let (u, v, right_u, right_v) = (&u[..lanes], &v[..lanes], &right_u[..lanes], &right_v[..lanes]);
    let (lower_u, lower_v, open) = (&lower_u[..lanes], &lower_v[..lanes], &mut open[..lanes]);
    for n in 0..lanes {
        let (a, b, c, d) = (right_u[n] - u[n], right_v[n] - v[n], lower_u[n] - u[n], lower_v[n] - v[n]);
        let far = |d: f64| (FARTHEST - d.abs()).to_bits();
        let mut special = far(a) | far(b) | far(c) | far(d);
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
        special |= (mantissa - (1.0 + LOG_MARGIN)).to_bits() | (2.0 - LOG_MARGIN - mantissa).to_bits();
        lods[n] = if largest > 0.0 { log - 128 * 32 } else { lod::LEAST };
        open[n] |= special;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::rows::lanes::{LANES, PerLane};
    use crate::random::Random;

    /// Steps of all lengths, powers of two and their neighbours among them.
    #[test]
    fn logarithms_are_those_of_the_definition() {
        let mut random = Random::seeded(11);
        let mut found = 0;
        for _ in 0..400 {
            let mut at = AtQuads::default();
            let mut quads = [[[0_i64; 2]; 3]; LANES];
            for (n, quad) in quads.iter_mut().enumerate() {
                let bits = 1 + random.bits() % 27;
                let step = |bits: u64| (1_i64 << bits) - 1 + (n % 3) as i64;
                for (pixel, at) in quad.iter_mut().enumerate() {
                    let origin = 3 << 30;
                    let mut along = || if n % 4 == 0 { step(bits) } else { (random.bits() % (1 << bits)) as i64 };
                    *at = if pixel == 0 { [origin; 2] } else { [origin + along(), origin - along()] };
                    if n % 5 == 0 {
                        at[1] = origin;
                    }
                }
                for pixel in 0..3 {
                    for axis in 0..2 {
                        at[pixel][axis][n] = quad[pixel][axis] as f64;
                    }
                }
            }
            let (mut lods, mut open) = (PerLane::from_value(0), PerLane::from_value(0));
            log_ratios(&at, &mut lods, &mut open);
            for (n, quad) in quads.iter().enumerate().filter(|(n, _)| open[*n] >> 63 == 0) {
                assert_eq!(lods[n], lod::log2_ratio(Some(*quad)), "{quad:?}");
                found += 1;
            }
        }
        assert!(found > 100_000, "{found}");
    }
}
