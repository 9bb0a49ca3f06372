//! Computes how much of the sky each texel of a height field sees.
//!
//! From each texel, rays go out in sixteen directions, up to 24 texels far; the steepest slope along a ray is its horizon. A flat
//! surface weights the sky by the cosine, so a horizon at angle h leaves cos^2 h of a direction's share.
#![allow(clippy::float_arithmetic, reason = "input data: f64, + - * / and roots in a fixed order, rounded")]

use super::normal_map::{Options, height_at};
use super::*;
use crate::mesh::circle;

/// Number of directions about a texel.
const RAYS: u32 = 16;

/// Length of a ray, in texels.
const MAX_RAY: u32 = 24;

/// Returns the share of the sky that each texel sees, 0 to 1, row by row from the top. `options` says how heights are read, as for a normal map.
pub(crate) fn open_sky(height: &Rgba, options: &Options) -> Vec<f64> {
    let scale = options.scale / 255.0;
    let directions: Vec<[f64; 2]> = (0..RAYS).map(|ray| circle(ray, RAYS)).collect();
    let mut open = Vec::with_capacity(height.pixels.len());
    for y in 0..height.height {
        for x in 0..height.width {
            let here = height_at(height, options, f64::from(x), f64::from(y));
            let share = |[sine, cosine]: &[f64; 2]| {
                let mut steepest = 0.0_f64;
                for step in 1..=MAX_RAY {
                    let distance = f64::from(step);
                    let (x, y) = (f64::from(x) + distance * cosine, f64::from(y) + distance * sine);
                    let rise = (height_at(height, options, x, y) - here) * scale;
                    steepest = steepest.max(rise / distance);
                }
                1.0 / (1.0 + steepest * steepest)
            };
            open.push(directions.iter().map(share).sum::<f64>() / f64::from(RAYS));
        }
    }
    open
}

/// Returns the same shares as a picture, with the byte of the share in all four channels.
pub fn picture(height: &Rgba, options: &Options) -> Rgba {
    let pixels = open_sky(height, options).into_iter().map(|open| [byte(open); 4]);
    Rgba { width: height.width, height: height.height, pixels: pixels.collect() }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn field(width: u32, heights: &[u8]) -> Rgba {
        let pixels = heights.iter().map(|h| [*h, *h, *h, 255]).collect();
        Rgba { width, height: heights.len() as u32 / width, pixels }
    }

    #[test]
    fn a_flat_field_sees_all_of_the_sky() {
        assert!(open_sky(&field(4, &[7; 16]), &Options::default()).iter().all(|open| *open == 1.0));
    }

    #[test]
    fn a_pit_sees_less_and_a_peak_all() {
        let mut heights = [100; 64];
        (heights[9], heights[45]) = (0, 200);
        let open = open_sky(&field(8, &heights), &Options::default());
        assert_eq!(open[45], 1.0);
        assert!(open[9] < 0.5, "{}", open[9]);
        // Next to the peak, which hides a part of the sky.
        assert!(open[44] < 1.0 && open[44] > open[9], "{}", open[44]);
    }

    #[test]
    fn a_slope_of_45_degrees_takes_its_share() {
        // The field rises by one texel for each texel to the right. Downhill all is open. Uphill, at an angle a from the slope, 1 / (1 + cos^2 a)
        // is open, whose mean over the half circle is 1 / sqrt 2.
        let slope: Vec<u8> = (0..16).collect();
        let options = Options { scale: 255.0, wrap: false, ..Options::default() };
        let open = open_sky(&field(16, &slope), &options);
        assert!((open[4] - (2.0 + 2.0_f64.sqrt()) / 4.0).abs() < 1e-5, "{}", open[4]);
    }
}
