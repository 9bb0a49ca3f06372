//! INT-1 to INT-4t and everything else that varies across a triangle, for the pixels of a batch.
#![allow(clippy::float_arithmetic, reason = "estimates: no result depends on how they are rounded")]

use super::color::{colors, narrow_weights};
use super::dda::DdaRow;
use super::definition::defined_coordinate;
use super::depth::Steps;
use super::direction::{Looking, only_face, positive};
use super::fetch::PerLane;
use super::fog::Fog;
use super::kernels::{LANES, Lanes256, STEP};
use super::levels::{Placing, Reads};
use super::planes::{Plane, inverse};
use super::quads::Quads;
use super::quotient::{
    Line, Positions, QuotientEstimate, Reciprocals, SLACK, WeightEstimate, break_ties, correct, estimate_two,
    estimate_weights,
};
use super::short::Short;
use super::taps::Footprints;
use super::third::{ThirdPlanes, thirds};
use super::{CompiledDraw, Reason, Reasons};
use crate::engine::pixel::TriangleContext;
use crate::raster::interpolate::Sample;
use crate::raster::setup::Triangle;
use crate::state::{Named, TEXTURE_UNITS};
use crate::texture::cube::Face;
use crate::texture::place::Coordinates;
use crate::texture::planned::Image;
use std::cell::Cell;

/// How many reasons there are.
const REASONS: usize = Reason::ALL.len();

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

/// A triangle with what its batches need.
pub(super) struct Setup<'a> {
    pub(super) context: &'a TriangleContext<'a>,
    pub(super) denominator: Plane,
    /// 256 b0 and 256 b2, where some colour varies.
    pub(super) weights: Option<[Plane; 2]>,
    pub(super) samplers: Vec<Planes>,
    /// What samplers make of r, if some of them make anything.
    pub(super) thirds: Vec<ThirdPlanes>,
    pub(super) fog: Option<Box<Fog>>,
    /// Bits of the largest D.
    pub(super) bits: u32,
    /// The reciprocal of a D that none is smaller than.
    widest: f64,
    /// Pixels that the definition computed something of.
    pub(super) defined: [Cell<u64>; REASONS],
}

/// What the batches of a block leave in their lanes.
#[derive(Clone, Debug)]
pub(super) struct Varying {
    /// u and v of each sampler, 1/256 texel, less half a texel where it filters.
    pub(super) coordinates: [[PerLane<i32>; 2]; TEXTURE_UNITS],
    /// Faces of cube maps, layers of volumes.
    pub(super) faces: [PerLane<u32>; TEXTURE_UNITS],
    /// What depths are compared with.
    pub(super) references: [PerLane<u32>; TEXTURE_UNITS],
    /// Places among layers, 1/256 layer, twice.
    pub(super) layers: [PerLane<i32>; 2],
    /// Depth, where it is tested.
    pub(super) depth: PerLane<u32>,
    pub(super) depth_steps: Box<Steps>,
    /// The texture shader lets the pixel live.
    pub(super) alive: PerLane<bool>,
    /// What samplers read whose levels count; as many as are wanted.
    pub(super) reads: Vec<Reads>,
    pub(super) quads: Box<Quads>,
    pub(super) placing: Box<Placing>,
    /// The taps of samplers that have several; as many as are wanted.
    pub(super) footprints: Vec<Footprints>,
    /// Of the row whose batches come now.
    pub(super) dda: DdaRow,
    /// W0 and W2 while they are settled.
    pub(super) weights: [PerLane<i32>; 2],
    /// The same in 16 bits.
    pub(super) narrow: [PerLane<u16>; 2],
    /// Of a small triangle.
    pub(super) reciprocals: Reciprocals,
    pub(super) whole: [PerLane<i32>; 2],
    /// Where something is divided by q.
    pub(super) short: Box<Short>,
}

impl Default for Varying {
    fn default() -> Self {
        Varying {
            coordinates: [[[0; LANES]; 2]; TEXTURE_UNITS],
            faces: [[0; LANES]; TEXTURE_UNITS],
            references: [[0; LANES]; TEXTURE_UNITS],
            layers: [[0; LANES]; 2],
            depth: [0; LANES],
            depth_steps: Box::default(),
            alive: [true; LANES],
            reads: Vec::new(),
            quads: Box::default(),
            placing: Box::default(),
            footprints: Vec::new(),
            dda: DdaRow::default(),
            weights: [[0; LANES]; 2],
            narrow: [[0; LANES]; 2],
            reciprocals: Reciprocals::default(),
            whole: [[0; LANES]; 2],
            short: Box::default(),
        }
    }
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

/// Rounded up to whole steps.
pub(super) fn whole_steps(count: usize) -> usize {
    count.next_multiple_of(STEP)
}

impl<'a> Setup<'a> {
    /// `samplers` is a place to put things; [`given_back`](Self::given_back) returns it.
    #[inline(always)]
    pub(super) fn new(
        context: &'a TriangleContext<'a>,
        compiled: &CompiledDraw,
        mut samplers: Vec<Planes>,
    ) -> Setup<'a> {
        let triangle = &context.triangle;
        let p = triangle.p;
        let weighted = compiled.varies(context);
        let inverse = inverse(triangle);
        samplers.clear();
        for sampler in &compiled.samplers {
            let coordinates = context.coordinates_of(sampler.unit);
            samplers.push(match coordinates {
                _ if sampler.shares.is_some() || sampler.depends => Planes::Shared,
                Some(Coordinates::Plane(g)) => {
                    Planes::Plane([Plane::new(triangle, &inverse, g[0]), Plane::new(triangle, &inverse, g[1])])
                }
                Some(Coordinates::Direction(g)) => Planes::Direction(Plane::three(triangle, &inverse, g), only_face(g)),
                Some(Coordinates::Ratio(g)) => match positive(*g, sampler.sides) {
                    Some((g, reach)) => Planes::Ratio(Plane::three(triangle, &inverse, &g), reach),
                    None => Planes::Other,
                },
                None => Planes::Other,
            });
        }
        let bits = |n: i64| 64 - n.leading_zeros();
        let least = p[0].min(p[1]).min(p[2]) as f64 * triangle.doubled_area as f64;
        Setup {
            widest: 1.0 / least,
            denominator: Plane::new(triangle, &inverse, p),
            weights: weighted.then(|| [Plane::weight(triangle, 0), Plane::weight(triangle, 2)]),
            samplers,
            thirds: thirds(context, compiled, &inverse),
            defined: [const { Cell::new(0) }; REASONS],
            fog: compiled.fog.and_then(|_| Fog::new(context)).map(Box::new),
            bits: bits(triangle.doubled_area) + bits(p[0].max(p[1]).max(p[2])),
            context,
        }
    }

    /// What [`new`](Self::new) was given; adds what the definition computed.
    pub(super) fn given_back(self, reasons: &mut Reasons) -> Vec<Planes> {
        for (all, own) in reasons.iter_mut().zip(&self.defined) {
            *all += own.get();
        }
        self.samplers
    }

    /// The definition computes something of some pixels.
    pub(super) fn tell(&self, reason: Reason, pixels: usize) {
        let count = &self.defined[reason as usize];
        count.set(count.get() + pixels as u64);
    }

    /// Everything that varies, for a batch. `ROW`: its pixels are on one row, one beside the other.
    #[inline(always)]
    pub(super) fn interpolate<const FMA: bool, const ROW: bool>(
        &self,
        batch: PixelBatch<'_>,
        compiled: &CompiledDraw,
        textures: &[Image<'_, i32>],
        varying: &mut Varying,
        rows: &mut [Lanes256],
    ) {
        if ROW {
            self.dda(batch, compiled, varying);
        }
        if !(ROW && varying.dda.complete) {
            self.estimated::<FMA, ROW>(batch, compiled, varying, rows);
        }
        colors(self.context, compiled, batch, varying, rows);
        if compiled.samples_pixels {
            self.pixel_by_pixel(batch, compiled, textures, varying, rows);
        }
    }

    /// What varies and is estimated.
    #[inline(always)]
    fn estimated<const FMA: bool, const ROW: bool>(
        &self,
        batch: PixelBatch<'_>,
        compiled: &CompiledDraw,
        varying: &mut Varying,
        rows: &mut [Lanes256],
    ) {
        let e = self.context.triangle.edges(batch.first.0, batch.first.1);
        let real = [e[0] as f64, e[1] as f64, e[2] as f64];
        let denominator = self.denominator.line(&real);
        let bounds = if ROW && varying.dda.undivided {
            Bounds { columns: f64::from(batch.at.last), ..Bounds::default() }
        } else {
            self.bounds::<FMA, ROW>(batch, &real, denominator)
        };
        let by_q = |planes: &Planes| matches!(planes, Planes::Ratio(..));
        if self.samplers.iter().any(by_q)
            || self.thirds.iter().any(|third| matches!(third, ThirdPlanes::Layer(of) if by_q(of)))
        {
            varying.short.dominance.set::<FMA, ROW>(&self.context.triangle, batch, (&real, denominator), &bounds);
        }
        // In a loop of its own: what compilers compute before it is left out where nothing is divided by D.
        let divided = if ROW && varying.dda.undivided { 0 } else { self.samplers.len() };
        for (n, (sampler, planes)) in compiled.samplers.iter().zip(&self.samplers[..divided]).enumerate() {
            if sampler.mixes {
                let Varying { reads, quads, placing, short, .. } = &mut *varying;
                let work = (&mut **quads, &mut **placing);
                let Some(reads) = reads.get_mut(n) else { continue };
                let lines = (&real, denominator);
                self.levels::<FMA, ROW>(batch, (sampler, planes), &e, lines, &bounds, short, work, reads);
            } else if let (Planes::Plane(planes), false) = (planes, ROW && varying.dda.samplers[n].1) {
                let Varying { coordinates, whole, .. } = &mut *varying;
                let lanes = batch.lanes();
                let [u, v] = &mut coordinates[n];
                let (u, v) = (&mut u[lanes.clone()], &mut v[lanes]);
                let (e, lines) = (&e, (&real, denominator));
                self.on_planes::<FMA, ROW>(batch, planes, sampler.bias(), e, lines, &bounds, u, v, &mut whole[0]);
            }
        }
        for (n, (sampler, planes)) in compiled.samplers.iter().zip(&self.samplers).enumerate() {
            if sampler.mixes {
                continue;
            }
            match planes {
                Planes::Plane(_) | Planes::Shared => {}
                Planes::Direction(planes, face) => {
                    let (numbers, faces) = (&mut varying.coordinates[n], &mut varying.faces[n]);
                    let looking = Looking::new(planes, &real, &bounds);
                    let face = if ROW && face.is_none() { looking.face::<FMA>(bounds.columns) } else { *face };
                    let done = match face {
                        Some(face) => {
                            self.on_face::<FMA, ROW>(batch, sampler, planes, face, &looking, &bounds, numbers, faces)
                        }
                        None => looking.directions::<FMA, ROW>(batch, sampler, numbers, faces),
                    };
                    if !done {
                        self.defined(batch, sampler, numbers, faces);
                    }
                }
                Planes::Ratio(planes, reach) => {
                    let (numbers, faces) = (&mut varying.coordinates[n], &mut varying.faces[n]);
                    let looking = Looking::new(planes, &real, &bounds);
                    let short = &mut varying.short;
                    let done = self.projected::<FMA, ROW>(
                        batch, sampler, planes, *reach, &looking, &bounds, short, numbers, faces,
                    );
                    if !done {
                        self.defined(batch, sampler, numbers, faces);
                    }
                }
                Planes::Other => {
                    self.defined(batch, sampler, &mut varying.coordinates[n], &mut varying.faces[n]);
                }
            }
        }
        if compiled.estimates {
            let Varying { quads, footprints, .. } = &mut *varying;
            for ((sampler, planes), taps) in compiled.samplers.iter().zip(&self.samplers).zip(footprints) {
                if sampler.pairs > 0 {
                    self.taps::<FMA, ROW>(batch, (sampler, planes), &e, (&real, denominator), &bounds, quads, taps);
                }
            }
            self.thirds::<FMA, ROW>(batch, compiled, &e, (&real, denominator), &bounds, varying);
        }
        if let Some(planes) = &self.weights
            && !(ROW && varying.dda.weights.1)
        {
            let Varying { weights: [w0, w2], whole, .. } = &mut *varying;
            let (w0, w2) = (&mut w0[batch.lanes()], &mut w2[batch.lanes()]);
            let weight_estimates =
                if ROW { self.weight_estimates(planes, (&real, denominator), &bounds) } else { None };
            let close = if let Some(weight_estimates) = weight_estimates {
                estimate_weights::<FMA>(batch.at.last, denominator, &weight_estimates, w0, w2)
            } else if let Some(estimates) = self.estimates::<ROW>(planes, 0, (&real, denominator), &bounds) {
                let estimates = [estimates[0].not_negative(), estimates[1].not_negative()];
                let close = estimate_two::<FMA, ROW>(batch.at, denominator, &estimates, w0, w2);
                close[0] | close[1]
            } else {
                self.tell(Reason::Weights, batch.count);
                for n in 0..batch.count {
                    let [first, third] = self.sample(batch, n).weights();
                    (w0[n], w2[n]) = (first.value as i32, third.value as i32);
                }
                false
            };
            if close {
                self.correct_weights::<ROW>(batch, planes, &e, w0, w2, whole);
            }
            narrow_weights(batch, varying);
        }
        if let Some(slot) = compiled.fog {
            let Varying { whole: [values, spare], .. } = &mut *varying;
            let row = &mut rows[usize::from(slot)].0;
            self.fog_factors::<FMA, ROW>(batch, &e, (&real, denominator), &bounds, values, spare, row);
        }
    }

    /// The denominators of a batch, as far as is known, and how far its pixels are apart.
    #[inline(always)]
    pub(super) fn bounds<const FMA: bool, const ROW: bool>(
        &self,
        batch: PixelBatch<'_>,
        e: &[f64; 3],
        denominator: Line,
    ) -> Bounds {
        let terms = |columns, rows| self.denominator.terms(e, columns, rows);
        Bounds::new::<FMA, ROW>(batch, denominator, self.widest, terms)
    }

    /// How far the estimate of a plane's quotient can be off.
    #[inline(always)]
    pub(super) fn margin<const ROW: bool>(&self, plane: &Plane, e: &[f64; 3], bounds: &Bounds) -> f64 {
        bounds.margin::<ROW>(plane.reach, |columns, rows| plane.terms(e, columns, rows))
    }

    /// Two quotients to be estimated, less a bias. `None`: some estimate would prove nothing.
    #[inline(always)]
    pub(super) fn estimates<const ROW: bool>(
        &self,
        planes: &[Plane; 2],
        bias: i32,
        (real, denominator): (&[f64; 3], Line),
        bounds: &Bounds,
    ) -> Option<[QuotientEstimate; 2]> {
        // Not a closure: one that is called twice is not inlined.
        Some([
            self.estimate_of::<ROW>(&planes[0], bias, (real, denominator), bounds)?,
            self.estimate_of::<ROW>(&planes[1], bias, (real, denominator), bounds)?,
        ])
    }

    /// Weights on a row to be estimated, in single precision.
    #[inline(always)]
    fn weight_estimates(
        &self,
        planes: &[Plane; 2],
        (real, denominator): (&[f64; 3], Line),
        bounds: &Bounds,
    ) -> Option<[WeightEstimate; 2]> {
        let (columns, reciprocals) = (bounds.columns, (bounds.reciprocal, bounds.widest));
        Some([
            WeightEstimate::new(planes[0].line(real), denominator, columns, reciprocals, bounds.ratio)?,
            WeightEstimate::new(planes[1].line(real), denominator, columns, reciprocals, bounds.ratio)?,
        ])
    }

    #[inline(always)]
    fn estimate_of<const ROW: bool>(
        &self,
        plane: &Plane,
        bias: i32,
        (real, denominator): (&[f64; 3], Line),
        bounds: &Bounds,
    ) -> Option<QuotientEstimate> {
        let margin = self.margin::<ROW>(plane, real, bounds);
        let (extent, reciprocals) = ((bounds.columns, bounds.rows), (bounds.reciprocal, bounds.widest));
        QuotientEstimate::new::<ROW>(plane.line(real), denominator, extent, reciprocals, margin, bias)
    }

    /// INT-4, INT-4t, less a bias.
    #[inline(always)]
    #[allow(clippy::too_many_arguments, reason = "what the caller has computed, and each result apart")]
    pub(super) fn on_planes<const FMA: bool, const ROW: bool>(
        &self,
        batch: PixelBatch<'_>,
        planes: &[Plane; 2],
        bias: i32,
        e: &[i64; 3],
        (real, denominator): (&[f64; 3], Line),
        bounds: &Bounds,
        u: &mut [i32],
        v: &mut [i32],
        whole: &mut PerLane<i32>,
    ) {
        if let Some(estimates) = self.estimates::<ROW>(planes, bias, (real, denominator), bounds) {
            let close = estimate_two::<FMA, ROW>(batch.at, denominator, &estimates, u, v);
            if close[0] | close[1] {
                self.correct_coordinates::<ROW>(batch, bias, planes, close, e, u, v, whole);
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
            correct::<ROW>(batch.at, top, bottom, plane.small(self.bits), values, whole);
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
        correct::<ROW>(batch.at, planes[0].exact(e), bottom, planes[0].small(self.bits), w0, whole0);
        correct::<ROW>(batch.at, planes[1].exact(e), bottom, planes[1].small(self.bits), w2, whole2);
        if !self.context.triangle.exact_reciprocal {
            break_ties(w0, w2, whole0, whole2);
        }
    }
}

/// How the denominators of a batch vary.
#[derive(Default)]
pub(super) struct Bounds {
    /// No term that goes into one is larger than this many of the smallest.
    ratio: f64,
    /// Of the first pixel's.
    reciprocal: f64,
    /// Of the smallest.
    widest: f64,
    pub(super) columns: f64,
    pub(super) rows: f64,
}

impl Bounds {
    /// `widest`: the reciprocal of a D that none is smaller than. `terms`: the sum of the magnitudes that go into a D so many columns and rows around.
    #[inline(always)]
    pub(super) fn new<const FMA: bool, const ROW: bool>(
        batch: PixelBatch<'_>,
        denominator: Line,
        widest: f64,
        terms: impl FnOnce(f64, f64) -> f64,
    ) -> Bounds {
        let reciprocal = 1.0 / denominator.c;
        if ROW {
            let end = denominator.at::<FMA, true>(f64::from(batch.at.last), 0.0);
            let (low, high) = if denominator.c < end { (denominator.c, end) } else { (end, denominator.c) };
            let widest = 1.0 / low;
            let columns = f64::from(batch.at.last);
            return Bounds { ratio: high * widest, reciprocal, widest, columns, rows: 0.0 };
        }
        let (columns, rows) = (f64::from(batch.extent.0), f64::from(batch.extent.1));
        Bounds { ratio: terms(columns, rows) * widest, reciprocal, widest, columns, rows }
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
