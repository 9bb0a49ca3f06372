//! What all interpolators share: a triangle, a batch of its pixels, and quotients of plane functions by D.
#![allow(clippy::float_arithmetic, reason = "estimates: no result depends on how they are rounded")]

use super::compiled::{Reason, Reasons};
use super::kernels::{PerLane, STEP};
use super::planes::Plane;
use super::quotient::{Line, Positions, QuotientEstimate, SLACK, break_ties, correct, estimate_two};
use crate::engine::pixel::TriangleContext;
use crate::raster::interpolate::Sample;
use crate::raster::setup::Triangle;
use crate::state::Named;
use crate::texture::cube::Face;
use std::cell::Cell;

/// A unit's linear functions.
#[derive(Debug)]
pub(super) enum Planes {
    /// u and v over D.
    Plane([Plane; 2]),
    /// A direction, and the face that all of the triangle looks at, if that is one.
    Direction([Plane; 3], Option<Face>),
    /// s, t and q, which is positive, and more than the magnitudes of s/q and t/q.
    Ratio([Plane; 3], f64),
    /// Anything else: the definition, pixel by pixel.
    Other,
    /// None: an earlier sampler's coordinates are used, or those that a stage of the texture shader makes.
    Shared,
}

/// Some pixels of a triangle that become lanes of a block.
#[derive(Clone, Copy)]
pub(super) struct PixelBatch<'a> {
    /// Column and row of its first pixel.
    pub(super) first: (i64, i64),
    /// Where the others lie; whole steps of lanes.
    pub(super) at: Positions<'a>,
    /// How many there are.
    pub(super) count: usize,
    /// The lane of the first.
    pub(super) lane: usize,
    /// Columns and rows that none of them is further away from it.
    pub(super) extent: (i32, i32),
    /// Of a box: row, first column and number of the pixels of each of its rows.
    pub(super) runs: &'a [(i64, i64, usize)],
}

impl PixelBatch<'_> {
    /// Column and row of one of its pixels.
    pub(super) fn pixel(&self, n: usize) -> (i64, i64) {
        (self.first.0 + i64::from(self.at.x[n]), self.first.1 + i64::from(self.at.y[n]))
    }

    /// One of its pixels as a sample of the triangle.
    pub(super) fn sample<'t>(&self, n: usize, triangle: &'t Triangle) -> Sample<'t> {
        let (i, j) = self.pixel(n);
        Sample::new(triangle, triangle.edges(i, j))
    }

    /// The lanes that whole steps take.
    pub(super) fn lanes(&self) -> std::ops::Range<usize> {
        self.lane..self.lane + self.at.x.len()
    }
}

/// Some lanes of a block that lie side by side on the surface.
#[derive(Clone, Copy, Debug)]
pub(super) struct Run {
    /// First lane.
    pub(super) lane: usize,
    /// Index of the first pixel in the band.
    pub(super) at: usize,
    pub(super) count: usize,
}

/// Rounded up to whole steps.
pub(super) fn whole_steps(count: usize) -> usize {
    count.next_multiple_of(STEP)
}

/// A triangle with what quotients by D need.
pub(super) struct Setup<'a> {
    pub(super) context: &'a TriangleContext<'a>,
    pub(super) denominator: Plane,
    /// The reciprocal of a D that none is smaller than.
    widest: f64,
    /// Pixels that the definition computed something of.
    defined: [Cell<u64>; Reason::ALL.len()],
}

impl<'a> Setup<'a> {
    /// `inverse`: that of the triangle.
    #[inline(always)]
    pub(super) fn new(context: &'a TriangleContext<'a>, inverse: &[f64; 3]) -> Setup<'a> {
        let triangle = &context.triangle;
        let p = triangle.p;
        let least = p[0].min(p[1]).min(p[2]) as f64 * triangle.doubled_area as f64;
        Setup {
            widest: 1.0 / least,
            denominator: Plane::new(triangle, inverse, p),
            defined: [const { Cell::new(0) }; Reason::ALL.len()],
            context,
        }
    }

    /// Adds what the definition computed.
    pub(super) fn count(&self, reasons: &mut Reasons) {
        for (all, own) in reasons.iter_mut().zip(&self.defined) {
            *all += own.get();
        }
    }

    /// The definition computes something of some pixels.
    pub(super) fn tell(&self, reason: Reason, pixels: usize) {
        let count = &self.defined[reason as usize];
        count.set(count.get() + pixels as u64);
    }

    /// One of the batch's pixels as a sample of the triangle.
    pub(super) fn sample(&self, batch: PixelBatch<'_>, n: usize) -> Sample<'_> {
        batch.sample(n, &self.context.triangle)
    }

    /// What is known of a batch of the triangle.
    #[inline(always)]
    pub(super) fn local<const FMA: bool, const ROW: bool>(&self, batch: PixelBatch<'_>, divides: bool) -> BatchSetup {
        let e = self.context.triangle.edges(batch.first.0, batch.first.1);
        let real = [e[0] as f64, e[1] as f64, e[2] as f64];
        let denominator = self.denominator.line(&real);
        if !divides {
            return BatchSetup { e, real, denominator, columns: f64::from(batch.at.last), ..BatchSetup::default() };
        }
        let terms = |columns, rows| self.denominator.terms(&real, columns, rows);
        BatchSetup::new::<FMA, ROW>(batch, (e, real, denominator), self.widest, terms)
    }

    /// How far the estimate of a plane's quotient can be off.
    #[inline(always)]
    pub(super) fn margin<const ROW: bool>(&self, plane: &Plane, local: &BatchSetup) -> f64 {
        local.margin::<ROW>(plane.reach, |columns, rows| plane.terms(&local.real, columns, rows))
    }

    /// Two quotients to be estimated, less a bias. `None`: some estimate would prove nothing.
    #[inline(always)]
    pub(super) fn estimates<const ROW: bool>(
        &self,
        planes: &[Plane; 2],
        bias: i32,
        local: &BatchSetup,
    ) -> Option<[QuotientEstimate; 2]> {
        // Not a closure: one that is called twice is not inlined.
        Some([self.estimate_of::<ROW>(&planes[0], bias, local)?, self.estimate_of::<ROW>(&planes[1], bias, local)?])
    }

    #[inline(always)]
    fn estimate_of<const ROW: bool>(&self, plane: &Plane, bias: i32, local: &BatchSetup) -> Option<QuotientEstimate> {
        let margin = self.margin::<ROW>(plane, local);
        let (extent, reciprocals) = ((local.columns, local.rows), (local.reciprocal, local.widest));
        QuotientEstimate::new::<ROW>(plane.line(&local.real), local.denominator, extent, reciprocals, margin, bias)
    }

    /// INT-4, INT-4t, less a bias.
    #[inline(always)]
    #[allow(clippy::too_many_arguments, reason = "what the caller has computed, and each result apart")]
    pub(super) fn on_planes<const FMA: bool, const ROW: bool>(
        &self,
        batch: PixelBatch<'_>,
        planes: &[Plane; 2],
        bias: i32,
        local: &BatchSetup,
        u: &mut [i32],
        v: &mut [i32],
        whole: &mut PerLane<i32>,
    ) {
        if let Some(estimates) = self.estimates::<ROW>(planes, bias, local) {
            let close = estimate_two::<FMA, ROW>(batch.at, local.denominator, &estimates, u, v);
            if close[0] | close[1] {
                self.correct_coordinates::<ROW>(batch, bias, planes, close, &local.e, u, v, whole);
            }
        } else {
            self.tell(Reason::Coordinates, batch.count);
            for k in 0..batch.count {
                let sample = self.sample(batch, k);
                (u[k], v[k]) =
                    (defined_coordinate(&sample, &planes[0], bias), defined_coordinate(&sample, &planes[1], bias));
            }
        }
    }

    /// INT-4, INT-4t of estimates of which some lane is not proved.
    #[inline(always)]
    #[allow(
        clippy::too_many_arguments,
        reason = "each result apart, so that the compiler sees that none overlaps another"
    )]
    pub(super) fn correct_coordinates<const ROW: bool>(
        &self,
        batch: PixelBatch<'_>,
        bias: i32,
        planes: &[Plane; 2],
        close: [bool; 2],
        e: &[i64; 3],
        u: &mut [i32],
        v: &mut [i32],
        whole: &mut PerLane<i32>,
    ) {
        for (n, values) in [(0, u), (1, v)] {
            if !close[n] {
                continue;
            }
            let plane = &planes[n];
            let bottom = self.denominator.exact(e);
            let top = plane.exact(e).less(i64::from(bias), bottom);
            let whole = &mut whole[..values.len()];
            correct::<ROW>(batch.at, top, bottom, values, whole);
            if plane.lowers(&self.context.triangle) {
                for k in (0..batch.count).filter(|k| whole[*k] != 0) {
                    values[k] -= i32::from(self.sample(batch, k).shortfall(&plane.g) > 0);
                }
            }
        }
    }

    /// INT-2, INT-3 likewise.
    #[inline(always)]
    pub(super) fn correct_weights<const ROW: bool>(
        &self,
        batch: PixelBatch<'_>,
        planes: &[Plane; 2],
        e: &[i64; 3],
        w0: &mut [i32],
        w2: &mut [i32],
        whole: &mut [PerLane<i32>; 2],
    ) {
        let [whole0, whole2] = whole;
        let (whole0, whole2) = (&mut whole0[..w0.len()], &mut whole2[..w2.len()]);
        let bottom = self.denominator.exact(e);
        correct::<ROW>(batch.at, planes[0].exact(e), bottom, w0, whole0);
        correct::<ROW>(batch.at, planes[1].exact(e), bottom, w2, whole2);
        if !self.context.triangle.exact_reciprocal {
            break_ties(w0, w2, whole0, whole2);
        }
    }
}

/// INT-4 of a plane, less a bias.
fn defined_coordinate(sample: &Sample<'_>, plane: &Plane, bias: i32) -> i32 {
    sample.coordinate(&plane.g).value as i32 - bias
}

/// A batch's edge functions and denominators.
#[derive(Default)]
pub(super) struct BatchSetup {
    /// Edge functions at its first pixel.
    pub(super) e: [i64; 3],
    /// The same in double precision.
    pub(super) real: [f64; 3],
    pub(super) denominator: Line,
    /// No term that goes into a denominator is larger than this many of the smallest.
    pub(super) ratio: f64,
    /// The reciprocal of the first pixel's denominator.
    pub(super) reciprocal: f64,
    /// Of the smallest.
    pub(super) widest: f64,
    /// How far its pixels lie from the first.
    pub(super) columns: f64,
    pub(super) rows: f64,
}

impl BatchSetup {
    /// `widest`: the reciprocal of a D that none is smaller than. `terms`: the sum of the magnitudes that go into a D so many columns and rows around.
    #[inline(always)]
    pub(super) fn new<const FMA: bool, const ROW: bool>(
        batch: PixelBatch<'_>,
        (e, real, denominator): ([i64; 3], [f64; 3], Line),
        widest: f64,
        terms: impl FnOnce(f64, f64) -> f64,
    ) -> BatchSetup {
        let reciprocal = 1.0 / denominator.c;
        if ROW {
            let columns = f64::from(batch.at.last);
            let end = denominator.at::<FMA, true>(columns, 0.0);
            let (low, high) = if denominator.c < end { (denominator.c, end) } else { (end, denominator.c) };
            let widest = 1.0 / low;
            return BatchSetup { e, real, denominator, ratio: high * widest, reciprocal, widest, columns, rows: 0.0 };
        }
        let (columns, rows) = (f64::from(batch.extent.0), f64::from(batch.extent.1));
        // No sample lies outside of the triangle, but the box does.
        let here = 1.0 / denominator.least(columns, rows);
        let widest = if here > 0.0 && here < widest { here } else { widest };
        BatchSetup { e, real, denominator, ratio: terms(columns, rows) * widest, reciprocal, widest, columns, rows }
    }

    /// How far the estimate of a quotient can be off, of which `reach` is the largest magnitude and what is taken off, and `terms` the sum of the
    /// magnitudes that go into its numerator.
    #[inline(always)]
    pub(super) fn margin<const ROW: bool>(&self, reach: f64, terms: impl FnOnce(f64, f64) -> f64) -> f64 {
        // What is taken off is at most `reach` denominators.
        if ROW {
            // So is every other term: no term of the denominator is negative.
            return 2.0 * reach * self.ratio * SLACK;
        }
        (terms(self.columns, self.rows) * self.widest + 2.0 * reach * self.ratio) * SLACK
    }
}
