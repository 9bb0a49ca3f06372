//! Smooth edges: samples of a pixel, and colours where its centre is not covered.

use super::raster::{fit, geometry, triangle};
use super::{Column, Conditions, Kind, Reach, Unit, put};
use ninebit::raster::smooth;

/// Samples of a pixel that a smooth triangle covers.
pub(super) struct SmoothCoverage;

impl Unit for SmoothCoverage {
    known_as!(
        "smooth-coverage", &["SMO-1"],
        "how many of a pixel's eight samples a smooth triangle of snapped positions (1/16 pixel) covers, and what becomes of an alpha", Geometry;
        takes [geometry(), [Column::byte("in.alpha")]];
        gives [Column::result("out.samples", Kind::Unsigned(4)), Column::result("out.alpha", Kind::Unsigned(8))]
    );

    fn regressions(&self) -> Vec<Vec<i64>> {
        // A corner at parts of a pixel: samples and ties of all three kinds of edges.
        let row = |n: i64| {
            let (x, y) = (160 + 5 * n % 16, 160 + n / 2);
            [vec![x, y, x + 320, y, x, y + 320, 10, 10, 255], vec![x, y, x - 160, y, x, y - 160, 10, 10, 254 - 5 * n]]
        };
        (0..32).flat_map(row).collect()
    }

    fn fit(&self, inputs: &mut [i64]) {
        fit(inputs);
    }

    fn evaluate(&self, inputs: &[i64], conditions: &Conditions, results: &mut [i64]) {
        let Some(triangle) = triangle(inputs, None, conditions.profile) else { return results.fill(0) };
        let samples = triangle.smooth().covered_samples(inputs[6], inputs[7]);
        put(results, [samples, smooth::covered_alpha(inputs[8], samples)]);
    }
}

/// A colour channel where smooth edges do not cover the centre.
pub(super) struct SmoothColor;

impl Unit for SmoothColor {
    known_as!(
        "smooth-color", &["SMO-2"],
        "one colour channel outside of a triangle from three vertices' bytes and the weights of vertices 0 and 2 in 256ths";
        takes [
            ["in.c0", "in.c1", "in.c2"].map(Column::byte),
            ["in.weight0", "in.weight2"].map(|name| Column::signed(name, 14, -8192, 8191)),
        ];
        gives [Column::result("out.color", Kind::Unsigned(8))]
    );

    fn fit(&self, inputs: &mut [i64]) {
        // Mostly near a triangle, where channels are not limited.
        if inputs[0] % 4 != 0 {
            inputs[3..].iter_mut().for_each(|weight| *weight /= 32);
        }
    }

    fn evaluate(&self, inputs: &[i64], _: &Conditions, results: &mut [i64]) {
        let colors = [0, 1, 2].map(|n| inputs[n] as u8);
        results[0] = smooth::color(colors, [inputs[3], inputs[4]]).into();
    }
}
