//! Estimates of floors of interpolated numbers, and the lanes that they do not decide.
//!
//! ```text
//! for each lane:  v = f_1 + (n + x nx + y ny) / (d + x dx + y dy) in real numbers, of which doubles keep all but the last bits
//!     floor(v - margin) = floor(v + margin) is the floor of WGT-1's number
//!     otherwise the lane is undecided: such lanes are gathered, computed by the exact text, and scattered
//! ```
//!
//! The margin, with u = 2^-24: a weight that does not dominate is off by at most 6.2 u of itself, because its edge number is cut twice, the sum and
//! the share once, and the ratios of w are taken as they are. At most 3/4 of all do not dominate, so these move v by 5 u of the span of the
//! vertices' values; the dominant weight, which is rounded up, by u of it. Each term is cut by less than a last bit of the largest. Doubles round
//! 2^-50 of all that is added.
#![allow(clippy::float_arithmetic, reason = "estimates with a margin")]

use super::colors::{self, ColorWeights};
use super::coordinates::Coordinates;
use crate::engine::rows::geometry::shape::Shape;
use crate::engine::rows::geometry::weights::Pixels;
use crate::engine::rows::lanes::{PerLane, larger, limited, smaller};
use crate::engine::rows::sampling::place::Place;
use crate::engine::rows::sampling::sampler::Sampler;
use crate::raster::weights::Linear;
use std::ops::Range;

/// Least doubled area of a triangle that is estimated, in 1/256 pixel: that of 64 pixels. Smaller ones do not earn the set-up.
const LEAST_AREA: f64 = 64.0 * 512.0;

/// Largest margin that leaves most lanes decided.
const MAX_MARGIN: f64 = 1.0 / 16.0;

/// Columns and rows are less than this.
const EXTENT: f64 = 4096.0;

/// A number that is interpolated, besides its divisor.
#[derive(Clone, Copy, Debug, Default)]
struct Estimate {
    /// f_1.
    base: f64,
    /// The numerator at pixel (0, 0), and its changes from column to column and from row to row.
    origin: f64,
    dx: f64,
    dy: f64,
    margin: f64,
}

impl Estimate {
    /// Returns the estimate of a number times `scale`, or `None` if it would decide too few lanes.
    #[inline(always)]
    fn new(shape: &Shape, number: &Linear<f64>, scale: f64) -> Option<Estimate> {
        let Linear { second, first, third } = *number;
        let [r0, _, r2] = shape.ratios.unwrap_or([1.0; 3]);
        let (a, b) = (scale * first * r0, scale * third * r2);
        let along = |edges: &[f64; 3]| edges[0] * a + edges[2] * b;
        let size = |edges: &[f64; 3]| (edges[0] * a).abs() + (edges[2] * b).abs();
        let span = larger(larger(first.abs(), third.abs()), (first - third).abs());
        let largest = larger(larger(first.abs(), third.abs()), second.abs());
        let terms = if second == 0.0 || second.abs() >= largest { 2.0 } else { 3.0 };
        let cuts = scale * (6.0 * span + 2.0 * terms * largest) / f64::from(1 << 24);
        // The divisor is at least that of the vertex with the largest w.
        let least = shape.area() * smaller(smaller(r0, r2), 1.0);
        let rounded = size(&shape.c) + EXTENT * (size(&shape.a) + size(&shape.b));
        let margin = cuts + 16.0 * f64::EPSILON * (rounded / least + scale * largest);
        let (base, origin) = (scale * second, along(&shape.c));
        (margin < MAX_MARGIN).then(|| Estimate { base, origin, dx: along(&shape.a), dy: along(&shape.b), margin })
    }

    /// Writes what a function makes of the floor in each lane, and marks the lanes whose floor is not decided.
    #[inline(always)]
    fn each<T>(&self, [x, y, inverse]: [&[f64]; 3], is_undecided: &mut [u8], out: &mut [T], of: impl Fn(f64) -> T) {
        let (Estimate { base, origin, dx, dy, margin }, lanes) = (*self, out.len());
        let (x, y, inverse, is_undecided) = (&x[..lanes], &y[..lanes], &inverse[..lanes], &mut is_undecided[..lanes]);
        for n in 0..lanes {
            let v = base + (origin + dx * x[n] + dy * y[n]) * inverse[n];
            let low = (v - margin).floor();
            is_undecided[n] |= u8::from(low != (v + margin).floor());
            out[n] = of(low);
        }
    }
}

/// The estimates of a triangle, and the lanes that they do not decide, side by side, with what the exact text makes of these.
#[derive(Clone, Debug, Default)]
pub(crate) struct Estimates {
    /// Those of W0 and W2, and of each sampler's coordinates.
    weights: [Estimate; 2],
    coordinates: Vec<[Estimate; 2]>,
    /// The divisor at pixel (0, 0), and its changes from column to column and from row to row. It is 1 a vertex if all w are equal.
    divisor: [f64; 3],
    /// One over the divisor of each lane.
    inverse: PerLane<f64>,
    /// 1 for each lane that is not decided, otherwise 0, and the indices of these among those of the triangle.
    is_undecided: PerLane<u8>,
    lanes: Vec<u16>,
    pub(crate) pixels: Pixels,
    pub(crate) colors: ColorWeights,
    pub(crate) place: Place,
}

impl Estimates {
    /// Sets up a triangle. Returns whether all of its functions are estimated.
    #[inline(always)]
    pub(crate) fn set(&mut self, shape: &Shape, samplers: &[Sampler], coordinates: &[Coordinates]) -> bool {
        if shape.area() < LEAST_AREA {
            return false;
        }
        let ratios = shape.ratios.unwrap_or([1.0; 3]);
        let sum = |of: &[f64; 3]| of[0] * ratios[0] + of[1] + of[2] * ratios[2];
        self.divisor = [sum(&shape.c), sum(&shape.a), sum(&shape.b)];
        let weights = [Linear { first: 1.0, ..Linear::default() }, Linear { third: 1.0, ..Linear::default() }];
        let [Some(w0), Some(w2)] = weights.map(|weight| Estimate::new(shape, &weight, 256.0)) else { return false };
        self.weights = [w0, w2];
        self.coordinates.clear();
        for (sampler, coordinates) in samplers.iter().zip(coordinates).filter(|(sampler, _)| sampler.interpolates()) {
            let Some([s, t]) = coordinates.plane(sampler) else { return false };
            let of = |number, axis: usize| {
                Estimate::new(shape, &number, 256.0 / unit(sampler) * f64::from(sampler.sides[axis]))
            };
            let (Some(u), Some(v)) = (of(s, 0), of(t, 1)) else { return false };
            self.coordinates.push([u, v]);
        }
        true
    }

    /// Estimates what a triangle has in some lanes, and gathers those that are not decided. Returns how many these are.
    #[inline(always)]
    pub(crate) fn estimate(
        &mut self,
        samplers: &[Sampler],
        (pixels, lanes): (&Pixels, Range<usize>),
        colors: Option<&mut ColorWeights>,
        places: &mut [Place],
    ) -> usize {
        let (is_undecided, inverse) = (&mut self.is_undecided[..lanes.len()], &mut self.inverse[..lanes.len()]);
        is_undecided.fill(0);
        let (x, y) = (&pixels.x[lanes.clone()], &pixels.y[lanes.clone()]);
        let [divisor, dx, dy] = self.divisor;
        if dx == 0.0 && dy == 0.0 {
            inverse.fill(1.0 / divisor);
        } else {
            for n in 0..inverse.len() {
                // A quotient in single precision, and a step of Newton's: 2^-45 of it remain.
                let divisor = divisor + dx * x[n] + dy * y[n];
                let near = f64::from(1.0 / divisor as f32);
                inverse[n] = near * (2.0 - divisor * near);
            }
        }
        let at = [x, y, &*inverse];
        if let Some([w0, w2]) = colors {
            let (w0, w2) = (&mut w0[lanes.clone()], &mut w2[lanes.clone()]);
            self.weights[0].each(at, is_undecided, w0, colors::weight);
            self.weights[1].each(at, is_undecided, w2, colors::weight);
            colors::limit(w0, w2);
        }
        let own = samplers.iter().zip(places).filter(|(sampler, _)| sampler.interpolates());
        for ((sampler, place), estimates) in own.zip(&self.coordinates) {
            let (unit, bias) = (unit(sampler), sampler.bias());
            for axis in 0..2 {
                let out = &mut place.at[axis][lanes.clone()];
                estimates[axis].each(at, is_undecided, out, |floor| limited(unit * floor) - bias);
            }
        }
        self.lanes.clear();
        for (eight, of) in (0..).step_by(8).zip(is_undecided.as_chunks::<8>().0) {
            let mut marks = u64::from_le_bytes(*of);
            while marks != 0 {
                let lane = eight + marks.trailing_zeros() as usize / 8;
                (self.pixels.x[self.lanes.len()], self.pixels.y[self.lanes.len()]) = (x[lane], y[lane]);
                self.lanes.push(lane as u16);
                marks &= marks - 1;
            }
        }
        self.lanes.len()
    }

    /// Writes what was computed of undecided lanes into these, the weights of colours or coordinates.
    #[inline(always)]
    pub(crate) fn scatter<T: Copy>(
        &self,
        of: fn(&Self) -> &[PerLane<T>; 2],
        lanes: Range<usize>,
        out: &mut [PerLane<T>; 2],
    ) {
        for (from, out) in of(self).iter().zip(out) {
            let out = &mut out[lanes.clone()];
            for (lane, value) in self.lanes.iter().zip(&**from) {
                out[usize::from(*lane)] = *value;
            }
        }
    }
}

/// Returns what decides the texels of a sampler, in 1/256 texel: a step of the filter, or a texel.
fn unit(sampler: &Sampler) -> f64 {
    if sampler.filters { 1.0 } else { 256.0 }
}
