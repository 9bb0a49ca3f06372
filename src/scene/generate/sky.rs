//! Computes how much of the sky a surface sees, and the light that follows from it.
//!
//! The light that a distant sky and ground send over the half sphere around a normal depends only on the angle between the normal and the sky's
//! axis. Truths compute it, and cube maps hold it for every normal.
#![allow(clippy::float_arithmetic, reason = "input data and references: f64, + - * / and roots in a fixed order")]

use crate::vector::{Vector, dot, unit_or_zero};
use ninebit::state::named;

named! {
    /// The share of the sky that a surface sees, by the angle q between its normal and the sky's axis.
    pub enum Integral {
        /// 1 - sin q / 2 on the upper half of directions, sin q / 2 on the lower.
        Exact,
        /// 1/2 + cos q / 2.
        Simplified,
    }
}

/// Light from all around: a sky and a ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HemisphereLight {
    /// Direction toward the middle of the sky, in the space of the normals, of any length.
    pub axis: [f64; 3],
    /// R, G and B of the sky; 1 is full.
    pub sky: [f64; 3],
    /// R, G and B of the ground; 1 is full.
    pub ground: [f64; 3],
    /// How the share of the sky is computed.
    pub integral: Integral,
}

impl HemisphereLight {
    /// Returns R, G and B of the light that falls on a surface with this unit normal.
    pub(crate) fn at(&self, normal: [f64; 3]) -> [f64; 3] {
        let sky = self.share(normal);
        [0, 1, 2].map(|n| sky * self.sky[n] + (1.0 - sky) * self.ground[n])
    }

    /// Returns the share of the sky that the surface sees, 0 to 1.
    fn share(&self, normal: Vector) -> f64 {
        let cosine = dot(normal, unit_or_zero(self.axis)).clamp(-1.0, 1.0);
        match self.integral {
            Integral::Simplified => 0.5 + 0.5 * cosine,
            Integral::Exact => {
                let half_sine = 0.5 * (1.0 - cosine * cosine).sqrt();
                if cosine >= 0.0 { 1.0 - half_sine } else { half_sine }
            }
        }
    }
}

/// Converts a colour's bytes into numbers from 0 to 1.
pub fn color(bytes: [u8; 3]) -> [f64; 3] {
    bytes.map(|byte| f64::from(byte) / 255.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_two_integrals_agree_at_the_poles_and_the_equator() {
        let of = |integral, normal| {
            let axis = [0.0, 0.0, 2.0];
            HemisphereLight { axis, sky: [1.0, 0.0, 0.5], ground: [0.0, 1.0, 0.5], integral }.at(normal)
        };
        for integral in [Integral::Exact, Integral::Simplified] {
            assert_eq!(of(integral, [0.0, 0.0, 1.0]), [1.0, 0.0, 0.5]);
            assert_eq!(of(integral, [0.0, 0.0, -1.0]), [0.0, 1.0, 0.5]);
            assert_eq!(of(integral, [1.0, 0.0, 0.0]), [0.5, 0.5, 0.5]);
        }
        // In between they differ: 0.75 and 0.933 at 30 degrees.
        let tilted = [0.5, 0.0, 0.75_f64.sqrt()];
        assert!((of(Integral::Exact, tilted)[0] - 0.75).abs() < 1e-12);
        assert!((of(Integral::Simplified, tilted)[0] - 0.933_012_701_892_219).abs() < 1e-12);
    }
}
