//! The common parts of all interpolators: a triangle, a batch of its pixels, and quotients of planes by D.
#![allow(clippy::float_arithmetic, reason = "estimates: no result depends on how they are rounded")]

use super::compiled::{Reason, Reasons, Sampler};
use super::kernels::{LANES, PerLane, STEP};
use super::planes::{Plane, RealPlane};
use super::quotient::{IOTA, Line, Positions, QuotientEstimate, Reciprocals, SLACK, break_ties, correct, larger};
use super::short::Parts;
use crate::engine::context::TriangleContext;
use crate::raster::interpolate::{QUOTIENT_LIMIT, Sample, shortfall};
use crate::raster::setup::Triangle;
use crate::state::Named;
use crate::texture::cube::Face;
use std::cell::Cell;

/// Linear functions of a unit's coordinates.
#[derive(Debug)]
pub(super) enum Planes {
    /// u and v, divided by D.
    Plane([Plane; 2]),
    /// A direction, and the face that all of the triangle meets, if there is one.
    Direction([Plane; 3], Option<Face>),
    /// s, t and a positive q, and an upper bound of the magnitudes of s/q and t/q.
    Ratio([Plane; 3], f64),
    /// Other coordinates, which the definition computes pixel by pixel.
    Other,
    /// None, because the unit uses the coordinates of an earlier sampler or those of a texture shader stage.
    Shared,
}

/// Pixels of a triangle that become neighbouring lanes of a block.
#[derive(Clone, Copy)]
pub(super) struct PixelBatch<'a> {
    /// Column and row of the first pixel.
    pub(super) first: (i64, i64),
    /// Positions of the pixels, in whole steps of lanes.
    pub(super) at: Positions<'a>,
    /// Number of pixels.
    pub(super) count: usize,
    /// Lane of the first pixel.
    pub(super) lane: usize,
    /// Largest distance of a pixel from the first, in columns and in rows.
    pub(super) extent: (i32, i32),
    /// For a box: its rows, whose lanes count from its first.
    pub(super) runs: &'a [Run],
    /// The pixels that the triangle covers; of a box, only their number. In a row that completes quads, there are others before and after them.
    pub(super) covered: Covered,
    /// For a box: columns and rows of covered pixels, which stand in for those that are not.
    pub(super) inside: [&'a [i16]; 2],
}

/// First and number of pixels of a batch that the triangle covers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Covered(pub(super) usize, pub(super) usize);

static ZEROS: [i16; LANES] = [0; LANES];

impl PixelBatch<'_> {
    /// Returns covered pixels that lie side by side, from `first` on.
    #[inline(always)]
    pub(super) fn row(first: (i64, i64), count: usize, lane: usize) -> PixelBatch<'static> {
        let (lanes, last) = (whole_steps(count), count as i32 - 1);
        let at = Positions { x: &IOTA[..lanes], y: &ZEROS[..lanes], last };
        let covered = Covered(0, count);
        PixelBatch { first, at, count, lane, extent: (last, 0), runs: &[], covered, inside: [&[]; 2] }
    }

    /// Returns whether its pixels lie side by side.
    #[inline(always)]
    pub(super) fn is_row(&self) -> bool {
        self.runs.is_empty()
    }

    /// Returns whether it has pixels that the triangle does not cover.
    #[inline(always)]
    pub(super) fn reaches_beyond(&self) -> bool {
        self.covered.1 != self.count
    }

    /// Returns `count` pixels of a row from one on.
    #[inline(always)]
    pub(super) fn part(&self, from: usize, count: usize) -> PixelBatch<'static> {
        let part = PixelBatch::row((self.first.0 + from as i64, self.first.1), count, self.lane + from);
        let Covered(first, covered) = self.covered;
        let (first, end) = (first.max(from), (first + covered).min(from + count));
        PixelBatch { covered: if first < end { Covered(first - from, end - first) } else { Covered(0, 0) }, ..part }
    }

    /// Returns the covered pixels of a row, or a box with covered pixels only.
    #[inline(always)]
    pub(super) fn inside<const ROW: bool>(&self) -> Self {
        let Covered(first, count) = self.covered;
        if !self.reaches_beyond() {
            return *self;
        }
        if ROW {
            return PixelBatch::row((self.first.0 + first as i64, self.first.1), count, self.lane + first);
        }
        let [x, y] = self.inside;
        PixelBatch { at: Positions { x, y, ..self.at }, covered: Covered(0, self.count), ..*self }
    }

    /// Returns column and row of a pixel.
    pub(super) fn pixel(&self, n: usize) -> (i64, i64) {
        (self.first.0 + i64::from(self.at.x[n]), self.first.1 + i64::from(self.at.y[n]))
    }

    /// Returns a pixel as a sample of the triangle.
    pub(super) fn sample<'t>(&self, n: usize, triangle: &'t Triangle) -> Sample<'t> {
        let (i, j) = self.pixel(n);
        Sample::new(triangle, triangle.edges(i, j))
    }

    /// Returns the lanes of the batch's whole steps.
    pub(super) fn lanes(&self) -> std::ops::Range<usize> {
        self.lane..self.lane + self.at.x.len()
    }
}

/// Lanes of a block, or of a box, whose pixels lie side by side on the surface. Small, because boxes have many of them.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Run {
    /// Index of the first pixel in the band, modulo 2^32 while it counts from a pixel of the box.
    at: u32,
    /// The first lane, and 2^16 times the number of pixels.
    lanes: u32,
}

impl Run {
    #[inline(always)]
    pub(super) fn new(lane: usize, at: u32, count: usize) -> Run {
        Run { at, lanes: lane as u32 | (count as u32) << 16 }
    }

    /// Returns the run so many lanes and pixels further.
    #[inline(always)]
    pub(super) fn further(self, lanes: usize, pixels: u32) -> Run {
        Run { at: self.at.wrapping_add(pixels), lanes: self.lanes.wrapping_add(lanes as u32) }
    }

    /// Returns so many pixels of the run from one on.
    #[inline(always)]
    pub(super) fn part(self, first: usize, count: usize) -> Run {
        Run::new(self.lane() + first, self.at.wrapping_add(first as u32), count)
    }

    /// Returns the first lane.
    #[inline(always)]
    pub(super) fn lane(self) -> usize {
        (self.lanes & 0xffff) as usize
    }

    /// Returns the index of the first pixel in the band.
    #[inline(always)]
    pub(super) fn at(self) -> usize {
        self.at as usize
    }

    /// Returns the number of pixels.
    #[inline(always)]
    pub(super) fn count(self) -> usize {
        (self.lanes >> 16) as usize
    }
}

/// Rounds up to whole steps.
pub(super) fn whole_steps(count: usize) -> usize {
    count.next_multiple_of(STEP)
}

/// A triangle, set up for quotients by D.
pub(super) struct Setup<'a> {
    pub(super) context: &'a TriangleContext<'a>,
    pub(super) denominator: Plane,
    /// Reciprocal of a lower bound of D.
    widest: f64,
    /// Number of pixels, by reason, of which the definition computed something.
    defined: [Cell<u64>; Reason::ALL.len()],
}

impl<'a> Setup<'a> {
    /// Sets up a triangle. `inverse` has its [inverses](super::planes::inverse).
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

    /// Adds the numbers of pixels to those of the draw.
    pub(super) fn count(&self, reasons: &mut Reasons) {
        for (all, own) in reasons.iter_mut().zip(&self.defined) {
            *all += own.get();
        }
    }

    /// Counts pixels of which the definition computes something.
    pub(super) fn count_defined(&self, reason: Reason, pixels: usize) {
        let count = &self.defined[reason as usize];
        count.set(count.get() + pixels as u64);
    }

    /// Returns a pixel of the batch as a sample of the triangle.
    pub(super) fn sample(&self, batch: PixelBatch<'_>, n: usize) -> Sample<'_> {
        batch.sample(n, &self.context.triangle)
    }

    /// Returns whether D is positive, and rounding errors do not change that, all around a box.
    pub(super) fn is_positive_around(&self, batch: &PixelBatch<'_>) -> bool {
        let BatchSetup { real, denominator, columns, rows, .. } = self.local::<false, false>(*batch, false);
        denominator.least(columns, rows) > self.denominator.real.terms(&real, columns, rows) * SLACK
    }

    /// Returns whether D is positive at all pixels of a row.
    pub(super) fn is_positive(&self, row: &PixelBatch<'_>) -> bool {
        let d = self.denominator.exact(&self.context.triangle.edges(row.first.0, row.first.1));
        d.c > 0 && d.at(i64::from(row.at.last), 0) > 0
    }

    /// Returns whether no coordinate of a batch is limited, as some are beyond the triangle.
    #[inline(always)]
    pub(super) fn stays_near(&self, batch: &PixelBatch<'_>, planes: &[Plane; 2], local: &BatchSetup) -> bool {
        let reach = larger(planes[0].real.reach, planes[1].real.reach);
        !batch.reaches_beyond() || reach * local.ratio < QUOTIENT_LIMIT as f64
    }

    /// Sets up a batch.
    #[inline(always)]
    pub(super) fn local<const FMA: bool, const ROW: bool>(&self, batch: PixelBatch<'_>, divides: bool) -> BatchSetup {
        let (triangle, denominator) = (&self.context.triangle, &self.denominator.real);
        if divides {
            BatchSetup::new::<FMA, ROW>(triangle, batch, denominator, self.widest)
        } else {
            BatchSetup::undivided(triangle, batch.first, batch.extent, denominator)
        }
    }

    /// Sets up two quotients, to which `up` is added, less a bias. Returns `None` if one of them would prove nothing.
    #[inline(always)]
    pub(super) fn estimates<const ROW: bool>(
        &self,
        planes: &[Plane; 2],
        (bias, up): (i32, [f64; 2]),
        local: &BatchSetup,
    ) -> Option<[QuotientEstimate; 2]> {
        // Not a closure, because one that is called twice is not inlined.
        Some([
            self.estimate_of::<ROW>(&planes[0], (bias, up[0]), local)?,
            self.estimate_of::<ROW>(&planes[1], (bias, up[1]), local)?,
        ])
    }

    /// Does the same for one quotient.
    #[inline(always)]
    pub(super) fn estimate_of<const ROW: bool>(
        &self,
        plane: &Plane,
        (bias, up): (i32, f64),
        local: &BatchSetup,
    ) -> Option<QuotientEstimate> {
        let margin = local.margin::<ROW>(&plane.real);
        let (extent, reciprocals) = ((local.columns, local.rows), (local.reciprocal, local.widest));
        let numerator = plane.real.line(&local.real).plus(local.denominator.times(up));
        QuotientEstimate::new::<ROW>(numerator, local.denominator, extent, reciprocals, margin, bias)
    }

    /// INT-4, INT-4t: computes the coordinates of a sampler, less its bias.
    #[inline(always)]
    #[allow(clippy::too_many_arguments, reason = "what the caller has computed, and each result apart")]
    pub(super) fn on_planes<const FMA: bool, const ROW: bool>(
        &self,
        batch: PixelBatch<'_>,
        (sampler, planes): (&Sampler, &[Plane; 2]),
        (local, reciprocals): (&BatchSetup, &Reciprocals),
        u: &mut [i32],
        v: &mut [i32],
        whole: &mut PerLane<i32>,
    ) {
        let bias = sampler.bias();
        let estimates = self.estimates::<ROW>(planes, (bias, sampler.up), local);
        if let Some(estimates) = estimates.filter(|_| self.stays_near(&batch, planes, local)) {
            let close = reciprocals.estimate::<FMA, ROW>(estimates, u, v);
            if close[0] | close[1] {
                self.correct_coordinates::<ROW>(batch, bias, planes, close, &local.e, u, v, whole);
            }
        } else {
            self.count_defined(Reason::Coordinates, batch.count);
            for k in 0..batch.count {
                let sample = self.sample(batch, k);
                (u[k], v[k]) =
                    (defined_coordinate(&sample, &planes[0], bias), defined_coordinate(&sample, &planes[1], bias));
            }
        }
    }

    /// INT-4, INT-4t: corrects estimates of which some are not proved.
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
            if close[n] {
                self.correct_coordinate::<ROW>(batch, bias, &planes[n], e, values, whole);
            }
        }
    }

    /// Does the same for one of the coordinates.
    #[inline(always)]
    pub(super) fn correct_coordinate<const ROW: bool>(
        &self,
        batch: PixelBatch<'_>,
        bias: i32,
        plane: &Plane,
        e: &[i64; 3],
        values: &mut [i32],
        whole: &mut PerLane<i32>,
    ) {
        let whole = &mut whole[..values.len()];
        self.correct::<ROW>(batch, bias, plane, e, values, whole);
        self.lower_ties::<ROW>(batch, plane, whole, values);
    }

    /// Corrects quotients less a bias, and marks those that are whole.
    #[inline(always)]
    pub(super) fn correct<const ROW: bool>(
        &self,
        batch: PixelBatch<'_>,
        bias: i32,
        plane: &Plane,
        e: &[i64; 3],
        values: &mut [i32],
        whole: &mut [i32],
    ) {
        let bottom = self.denominator.exact(e);
        correct::<ROW>(batch.at, plane.exact(e).less(i64::from(bias), bottom), bottom, values, whole);
    }

    /// Returns whether INT-4t can lower ties of a batch. Beyond the triangle, weights may be negative.
    #[inline(always)]
    pub(super) fn may_lower(&self, batch: &PixelBatch<'_>, plane: &Plane) -> bool {
        let triangle = &self.context.triangle;
        !triangle.exact_reciprocal && (batch.reaches_beyond() || plane.lowers(triangle))
    }

    /// INT-4t: lowers those of the coordinates that are whole. A row is divided into parts in which the same weights fall short: there, what
    /// a numerator loses is a linear function.
    #[inline(never)]
    pub(super) fn lower_ties<const ROW: bool>(
        &self,
        batch: PixelBatch<'_>,
        plane: &Plane,
        whole: &[i32],
        values: &mut [i32],
    ) {
        let triangle = &self.context.triangle;
        if !self.may_lower(&batch, plane) {
            return;
        }
        let mut parts = Parts::default();
        if ROW && !batch.reaches_beyond() {
            parts.set_row::<false>(triangle, batch.first, batch.at.last, &self.denominator.real);
        }
        let mut parts = parts.ranges(batch.count).peekable();
        if parts.peek().is_none() {
            for k in (0..batch.count).filter(|k| whole[*k] != 0) {
                self.count_defined(Reason::Coordinates, 1);
                values[k] -= i32::from(self.sample(batch, k).shortfall(&plane.g) > 0);
            }
        }
        for (part, short) in parts {
            let lost = |e: &[i64; 3]| shortfall(triangle, e, &plane.g, short);
            let (here, slope) = (lost(&triangle.edges(batch.first.0, batch.first.1)), lost(&triangle.a));
            // The first lane that loses something, and the first after those.
            let (first, end) = (part.start as i128, part.end as i128);
            let (from, to) = match slope {
                0 => (first, if here > 0 { end } else { first }),
                1.. => ((-here).div_euclid(slope) + 1, end),
                _ => (first, (here - slope - 1).div_euclid(-slope)),
            };
            let lanes = from.clamp(first, end) as usize..to.clamp(first, end) as usize;
            for (value, whole) in values[lanes.clone()].iter_mut().zip(&whole[lanes]) {
                *value -= whole;
            }
        }
    }

    /// INT-2, INT-3: corrects weights of which some are not proved.
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
        self.correct::<ROW>(batch, 0, &planes[0], e, w0, whole0);
        self.correct::<ROW>(batch, 0, &planes[1], e, w2, whole2);
        if !self.context.triangle.exact_reciprocal {
            break_ties(w0, w2, whole0, whole2);
        }
    }
}

/// INT-4 of a plane, less a bias, by the definition.
fn defined_coordinate(sample: &Sample<'_>, plane: &Plane, bias: i32) -> i32 {
    sample.coordinate(&plane.g).value as i32 - bias
}

/// Edge functions and denominators of a batch.
#[derive(Default)]
pub(super) struct BatchSetup {
    /// Edge functions at the first pixel.
    pub(super) e: [i64; 3],
    /// Edge functions in double precision.
    pub(super) real: [f64; 3],
    pub(super) denominator: Line,
    /// Upper bound of the quotient of any term of a denominator by the least denominator.
    pub(super) ratio: f64,
    /// Reciprocal of the first pixel's denominator.
    pub(super) reciprocal: f64,
    /// Reciprocal of the least denominator.
    pub(super) widest: f64,
    /// Largest distance of a pixel from the first, in columns and in rows.
    pub(super) columns: f64,
    pub(super) rows: f64,
}

impl BatchSetup {
    /// Sets up pixels of which nothing is divided by D: the first, and the largest distance from it.
    #[inline(always)]
    pub(super) fn undivided(
        triangle: &Triangle,
        first: (i64, i64),
        extent: (i32, i32),
        denominator: &RealPlane,
    ) -> BatchSetup {
        let e = triangle.edges(first.0, first.1);
        let real = [e[0] as f64, e[1] as f64, e[2] as f64];
        let (columns, rows) = (f64::from(extent.0), f64::from(extent.1));
        BatchSetup { e, real, denominator: denominator.line(&real), columns, rows, ..BatchSetup::default() }
    }

    /// Returns the edge functions at the last pixel of a row.
    #[inline(always)]
    fn at_end(&self, triangle: &Triangle) -> [f64; 3] {
        let mut e = self.real;
        for k in 0..3 {
            e[k] += triangle.a[k] as f64 * self.columns;
        }
        e
    }

    /// Sets up a batch. `widest` is the reciprocal of a lower bound of the denominator D.
    #[inline(always)]
    pub(super) fn new<const FMA: bool, const ROW: bool>(
        triangle: &Triangle,
        batch: PixelBatch<'_>,
        denominator: &RealPlane,
        widest: f64,
    ) -> BatchSetup {
        let undivided = BatchSetup::undivided(triangle, batch.first, batch.extent, denominator);
        let BatchSetup { real, denominator: line, columns, rows, .. } = undivided;
        // Upper bounds of the terms of D and of 1 / D.
        let (largest, widest) = if ROW {
            let end = line.at::<FMA, true>(columns, 0.0);
            let (low, high) = if line.c < end { (line.c, end) } else { (end, line.c) };
            // Only within the triangle no term is negative. Sums of magnitudes are largest at the ends of a row.
            let largest = if batch.reaches_beyond() {
                let last = undivided.at_end(triangle);
                larger(denominator.terms(&real, 0.0, 0.0), denominator.terms(&last, 0.0, 0.0))
            } else {
                high
            };
            (largest, 1.0 / low)
        } else {
            // The box may reach beyond the triangle, but no sample does, unless quads are completed.
            let here = 1.0 / line.least(columns, rows);
            let widest = if batch.reaches_beyond() || here > 0.0 && here < widest { here } else { widest };
            (denominator.terms(&real, columns, rows), widest)
        };
        BatchSetup { ratio: largest * widest, reciprocal: 1.0 / line.c, widest, ..undivided }
    }

    /// Returns the largest error of the estimate of a function's quotient by D.
    #[inline(always)]
    pub(super) fn margin<const ROW: bool>(&self, function: &RealPlane) -> f64 {
        self.margin_by::<ROW>(function.reach, function.terms(&self.real, self.columns, self.rows))
    }

    /// Returns the largest error of the estimate of a quotient. `reach` bounds its magnitude, with what is subtracted; `terms` bounds those of
    /// its numerator, which a row does not need.
    #[inline(always)]
    pub(super) fn margin_by<const ROW: bool>(&self, reach: f64, terms: f64) -> f64 {
        // What is subtracted is at most `reach` denominators. Along a row all other terms are, too: `ratio` bounds those of the denominator.
        let numerator = if ROW { 0.0 } else { terms * self.widest };
        (numerator + 2.0 * reach * self.ratio) * SLACK
    }
}
