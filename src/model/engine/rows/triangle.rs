//! INT-1 to INT-4t and all other interpolation across a triangle, for the pixels of a batch.
#![allow(clippy::float_arithmetic, reason = "estimates: no result depends on how they are rounded")]

use super::color::{colors, narrow, narrow_weights};
use super::compiled::{CompiledDraw, Reason, Reasons, Sampler};
use super::dda::{DdaRow, break_dda_ties, widen};
use super::depth::Steps;
use super::direction::{FindCoordinates, only_face, positive};
use super::fog::Fog;
use super::kernels::PerLane;
use super::levels::{Fetches, FindLevels, MipFetches, Placing};
use super::planes::{Plane, inverse};
use super::quads::Quads;
use super::quotient::Reciprocals;
use super::setup::{PixelBatch, Planes, Setup};
use super::short::Short;
use super::taps::{FindTaps, Footprints};
use super::third::{ThirdPlanes, set_thirds};
use crate::engine::context::TriangleContext;
use crate::state::TEXTURE_UNITS;
use crate::texture::coordinates::Coordinates;
use crate::texture::planned::Image;

/// Lists of the functions of samplers and of their r.
pub(super) type Functions = (Vec<Planes>, Vec<ThirdPlanes>);

/// The functions of all attributes of a triangle.
pub(crate) struct Interpolators<'a> {
    pub(super) setup: Setup<'a>,
    /// 256 b0 and 256 b2, if a colour varies.
    pub(super) weights: Option<[Plane; 2]>,
    pub(super) samplers: Vec<Planes>,
    /// Whether [`is_general`] holds for a sampler.
    is_general: bool,
    /// Whether some coordinates [lose](loses) something.
    loses: bool,
    /// The functions of r of samplers, if any use it.
    pub(super) thirds: Vec<ThirdPlanes>,
    fog: Option<Box<Fog>>,
}

/// Results of a block's batches, in its lanes.
#[derive(Clone, Debug, Default)]
pub(crate) struct Varying {
    /// u and v of each sampler in 1/256 texel, less half a texel if it filters.
    pub(super) coordinates: [[PerLane<i32>; 2]; TEXTURE_UNITS],
    /// Faces of cube maps or layers of volumes.
    pub(super) faces: [PerLane<u32>; TEXTURE_UNITS],
    /// References of depth textures.
    pub(super) references: [PerLane<u32>; TEXTURE_UNITS],
    /// Positions among layers in 1/256 layer, twice.
    pub(super) layers: [PerLane<i32>; 2],
    /// Depths, if they are tested.
    pub(super) depth: PerLane<u32>,
    pub(super) depth_steps: Box<Steps>,
    /// Whether the texture units keep the pixel. They keep all between two blocks.
    pub(super) alive: PerLane<bool>,
    /// Fetches of samplers with levels, as many as needed.
    pub(super) reads: Vec<MipFetches>,
    pub(super) quads: Box<Quads>,
    pub(super) placing: Box<Placing>,
    /// Taps of samplers that have several, as many as needed.
    pub(super) footprints: Vec<Footprints>,
    /// The DDAs of the current row.
    pub(super) dda: DdaRow,
    /// W0 and W2 while they are corrected.
    pub(super) weights: [PerLane<i32>; 2],
    /// W0 and W2 in 16 bits.
    pub(super) narrow: [PerLane<u16>; 2],
    /// Reciprocals for a small triangle.
    pub(super) reciprocals: Reciprocals,
    pub(super) whole: [PerLane<i32>; 2],
    /// Scratch space for coordinates that are divided by q.
    pub(super) short: Box<Short>,
}

impl Varying {
    /// Returns the depths, and scratch space for them.
    pub(super) fn depths(&mut self) -> (&mut PerLane<u32>, &mut Steps) {
        (&mut self.depth, &mut self.depth_steps)
    }
}

/// Parts of the interpolators that other parts call, compiled for an instruction set.
#[derive(Clone, Copy, Debug)]
pub(crate) struct InterpolatorKernels {
    pub(super) coordinates: FindCoordinates,
    pub(super) levels: FindLevels,
    pub(super) fetches: Fetches,
    pub(super) taps: FindTaps,
}

/// Returns whether a sampler without levels needs more than quotients by D. `finite` says that planes lose the finite amount (INT-4t).
#[inline(always)]
fn is_general(sampler: &Sampler, planes: &Planes, finite: bool) -> bool {
    let is_done = matches!(planes, Planes::Plane(_)) && !finite;
    !(sampler.mixes || is_done || matches!(planes, Planes::Shared))
}

/// Returns whether coordinates lose something because weights fall short. `finite` is as in [`is_general`].
#[inline(always)]
fn loses(planes: &Planes, finite: bool) -> bool {
    matches!(planes, Planes::Plane(_)) && finite || matches!(planes, Planes::Ratio(..))
}

impl<'a> Interpolators<'a> {
    /// Sets up a triangle. The lists are scratch space that [`given_back`](Self::given_back) returns.
    pub(super) fn new(
        context: &'a TriangleContext<'a>,
        compiled: &CompiledDraw,
        (mut samplers, mut thirds): Functions,
    ) -> Interpolators<'a> {
        let triangle = &context.triangle;
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
                Some(Coordinates::Ratio(g)) => {
                    let (g, reach) = positive(*g);
                    Planes::Ratio(Plane::three(triangle, &inverse, &g), reach)
                }
                None => Planes::Other,
            });
        }
        set_thirds(context, compiled, &inverse, &mut thirds);
        let finite = triangle.loses_on_planes();
        let mut pairs = compiled.samplers.iter().zip(&samplers);
        Interpolators {
            is_general: pairs.any(|(sampler, planes)| is_general(sampler, planes, finite)),
            loses: samplers.iter().any(|planes| loses(planes, finite))
                || thirds.iter().any(|third| matches!(third, ThirdPlanes::Layer(of) if loses(of, finite))),
            setup: Setup::new(context, &inverse),
            weights: weighted.then(|| [Plane::weight(triangle, 0), Plane::weight(triangle, 2)]),
            samplers,
            thirds,
            fog: compiled.fog.and_then(|_| Fog::new(context)).map(Box::new),
        }
    }

    /// Returns the scratch space of [`new`](Self::new), and adds the numbers of pixels that the definition computed.
    pub(super) fn given_back(self, reasons: &mut Reasons) -> Functions {
        self.setup.count(reasons);
        (self.samplers, self.thirds)
    }

    /// Divides a row by dominance if that is needed, and sets up its DDAs, from its first pixel on. Batches use the DDAs only after this has been
    /// called.
    #[inline(always)]
    pub(super) fn begin_row<const FMA: bool>(
        &self,
        (i, j): (i64, i64),
        columns: i64,
        compiled: &CompiledDraw,
        varying: &mut Varying,
    ) {
        let moves = compiled.shader.as_ref().is_some_and(|shader| !shader.moved.is_empty());
        if self.loses || moves {
            let (triangle, denominator) = (&self.setup.context.triangle, &self.setup.denominator.real);
            varying.short.dominance.begin_row::<FMA>(triangle, (i, j), columns, denominator);
        }
        let DdaRow { samplers, weights, fog, complete, undivided } = &mut varying.dda;
        (*fog, *complete, *undivided) = (None, false, false);
        weights.1 = false;
        for sampler in samplers.iter_mut() {
            sampler.1 = false;
        }
        // DDAs are bounded within the triangle only.
        if self.setup.denominator.x() != 0 || compiled.completes_quads {
            return;
        }
        let triangle = &self.setup.context.triangle;
        let e = triangle.edges(i, j);
        let d = self.setup.denominator.exact(&e).c;
        *fog = self.fog.as_ref().and_then(|fog| fog.of_row(&self.setup, &e));
        *undivided = (compiled.fog.is_none() || fog.is_some()) && !compiled.estimates;
        *complete = *undivided;
        for ((sampler, planes), ([u, v], is)) in compiled.samplers.iter().zip(&self.samplers).zip(samplers) {
            if let (Planes::Plane(planes), false) = (planes, triangle.loses_on_planes()) {
                let bias = sampler.bias();
                *is = (!sampler.mixes || self.setup.shift_with(sampler, planes))
                    && u.begin(&planes[0], triangle, &e, d, columns, bias)
                    && v.begin(&planes[1], triangle, &e, d, columns, bias);
            }
            *complete &= !sampler.mixes && (*is || matches!(planes, Planes::Shared));
            *undivided &= !sampler.mixes && (*is || !matches!(planes, Planes::Plane(_)));
        }
        if let (Some(planes), ([w0, w2], is)) = (&self.weights, weights) {
            *is =
                w0.begin(&planes[0], triangle, &e, d, columns, 0) && w2.begin(&planes[1], triangle, &e, d, columns, 0);
            *complete &= *is;
            *undivided &= *is;
        }
    }

    /// Runs the DDAs of a row for one batch.
    #[inline(always)]
    pub(super) fn dda(&self, batch: PixelBatch<'_>, compiled: &CompiledDraw, varying: &mut Varying) {
        let Varying { coordinates, weights: [w0, w2], narrow: [narrow0, narrow2], whole, dda, .. } = &mut *varying;
        let (lanes, triangle) = (batch.lanes(), &self.setup.context.triangle);
        for (n, planes) in self.samplers.iter().enumerate() {
            let (([along, down], true), Planes::Plane(planes)) = (&mut dda.samplers[n], planes) else { continue };
            let [u, v] = &mut coordinates[n];
            let (u, v) = (&mut u[lanes.clone()], &mut v[lanes.clone()]);
            let found = [along.run(batch.count, u), down.run(batch.count, v)];
            if found[0] | found[1] {
                let bias = compiled.samplers[n].bias();
                self.setup.correct_dda(batch, planes, bias, found, [along, down], u, v, &mut whole[0]);
            }
        }
        if let (([first, third], true), Some(planes)) = (&mut dda.weights, &self.weights) {
            let (narrow0, narrow2) = (&mut narrow0[lanes.clone()], &mut narrow2[lanes.clone()]);
            let found = first.run(batch.count, narrow0) | third.run(batch.count, narrow2);
            if found && !first.is_exact() {
                let (w0, w2) = (&mut w0[lanes.clone()], &mut w2[lanes]);
                widen(narrow0, w0);
                widen(narrow2, w2);
                let e = triangle.edges(batch.first.0, batch.first.1);
                self.setup.correct_weights::<true>(batch, planes, &e, w0, w2, whole);
                narrow(w0, narrow0);
                narrow(w2, narrow2);
            } else if found && !triangle.exact_reciprocal {
                break_dda_ties([first, third], batch.count, narrow0, narrow2);
            }
        }
    }

    /// Interpolates all attributes of a batch. `ROW` says that its pixels lie side by side on one row.
    #[inline(always)]
    pub(super) fn interpolate<const FMA: bool, const ROW: bool>(
        &self,
        batch: PixelBatch<'_>,
        (compiled, kernels): (&CompiledDraw, &InterpolatorKernels),
        textures: &[Image<'_, i32>],
        varying: &mut Varying,
        rows: &mut [PerLane<i16>],
    ) {
        if ROW {
            self.dda(batch, compiled, varying);
            if let (Some(slot), Some(factor)) = (compiled.fog, varying.dda.fog) {
                rows[usize::from(slot)][batch.lanes()].fill(factor);
            }
        }
        if !(ROW && varying.dda.complete) {
            self.estimated::<FMA, ROW>(batch, (compiled, kernels), varying, rows);
        }
        colors(self.setup.context, compiled, batch.inside::<ROW>(), &varying.narrow, rows);
        if compiled.samples_pixels {
            self.setup.pixel_by_pixel(batch, compiled, textures, &mut varying.alive, rows);
        }
    }

    /// Returns whether something is divided by D that the DDAs of a row, if there are any, do not divide.
    #[inline(always)]
    fn divides(&self, compiled: &CompiledDraw, dda: Option<&DdaRow>) -> bool {
        let by_dda = |n: usize| dda.is_some_and(|dda| dda.samplers[n].1);
        let is_plane = |planes: &Planes| matches!(planes, Planes::Plane(_));
        self.weights.is_some() && dda.is_none_or(|dda| !dda.weights.1)
            || self.fog.is_some() && dda.is_none_or(|dda| dda.fog.is_none())
            || self.samplers.iter().enumerate().any(|(n, planes)| is_plane(planes) && !by_dda(n))
            || compiled.estimates
                && self.thirds.iter().any(|third| matches!(third, ThirdPlanes::Layer(planes) if is_plane(planes)))
    }

    /// Interpolates the attributes that are estimated.
    #[inline(always)]
    fn estimated<const FMA: bool, const ROW: bool>(
        &self,
        batch: PixelBatch<'_>,
        (compiled, kernels): (&CompiledDraw, &InterpolatorKernels),
        varying: &mut Varying,
        rows: &mut [PerLane<i16>],
    ) {
        let setup = &self.setup;
        let local = &setup.local::<FMA, ROW>(batch, !(ROW && varying.dda.undivided));
        let finite = setup.context.triangle.loses_on_planes();
        if self.loses {
            varying.short.dominance.set::<FMA, ROW>(&setup.context.triangle, batch, local);
        }
        if !ROW && compiled.samplers.iter().any(|sampler| sampler.mixes || sampler.pairs > 0) {
            varying.quads.begin_box(batch);
        }
        // Everything that is divided by D shares its reciprocals.
        if self.divides(compiled, ROW.then_some(&varying.dda)) {
            varying.reciprocals.set::<FMA, ROW>(batch.at, local.denominator);
        }
        // A loop of its own, so that values which compilers compute before it are not computed if nothing is divided by D.
        let divided = if ROW && varying.dda.undivided { 0 } else { self.samplers.len() };
        for (n, (sampler, planes)) in compiled.samplers.iter().zip(&self.samplers[..divided]).enumerate() {
            if sampler.shares.is_some() || sampler.depends {
                continue;
            }
            if sampler.mixes {
                let Varying { reads, quads, placing, short, coordinates, dda, reciprocals, .. } = &mut *varying;
                let work = (&mut **short, &mut **quads, &mut **placing);
                let Some(reads) = reads.get_mut(n) else { continue };
                let lanes = || batch.lanes();
                let floors =
                    (ROW && dda.samplers[n].1).then(|| [&coordinates[n][0][lanes()], &coordinates[n][1][lanes()]]);
                let known = (local, &*reciprocals, floors);
                (kernels.levels)(setup, kernels.fetches, batch, (sampler, planes), known, work, reads);
            } else if let (Planes::Plane(planes), false) = (planes, finite || ROW && varying.dda.samplers[n].1) {
                let Varying { coordinates, whole, reciprocals, .. } = &mut *varying;
                let lanes = batch.lanes();
                let [u, v] = &mut coordinates[n];
                let (u, v) = (&mut u[lanes.clone()], &mut v[lanes]);
                let local = (local, &*reciprocals);
                setup.on_planes::<FMA, ROW>(batch, (sampler, planes), local, u, v, &mut whole[0]);
            }
        }
        // As above: most draws do not need this loop.
        let general = if self.is_general { self.samplers.len() } else { 0 };
        for (n, (sampler, planes)) in compiled.samplers.iter().zip(&self.samplers[..general]).enumerate() {
            if is_general(sampler, planes, finite) {
                let Varying { coordinates, faces, whole, short, reciprocals, .. } = &mut *varying;
                let (out, work) = ((&mut coordinates[n], &mut faces[n]), (&mut **short, &mut whole[0]));
                (kernels.coordinates)(setup, batch, (sampler, planes), (local, reciprocals), out, work);
            }
        }
        if compiled.estimates {
            let Varying { quads, footprints, .. } = &mut *varying;
            for ((sampler, planes), taps) in compiled.samplers.iter().zip(&self.samplers).zip(footprints) {
                if sampler.pairs > 0 {
                    (kernels.taps)(setup, batch, (sampler, planes), local, quads, taps);
                }
            }
            let Varying { faces, references, layers, whole, short, reciprocals, .. } = &mut *varying;
            let (planes, local) = ((compiled, &*self.thirds), (local, &*reciprocals));
            let (out, work) = (([&mut faces[..], &mut references[..]], layers), (&mut **short, &mut whole[0]));
            setup.thirds::<FMA, ROW>(kernels.coordinates, batch, planes, local, out, work);
        }
        // What stages of a texture shader do not read is computed for covered pixels only.
        let inside;
        let (batch, local) = if batch.reaches_beyond() {
            let covered = batch.inside::<ROW>();
            if covered.count == 0 {
                return;
            }
            inside = setup.local::<FMA, ROW>(covered, true);
            varying.reciprocals.set::<FMA, ROW>(covered.at, inside.denominator);
            (covered, &inside)
        } else {
            (batch, local)
        };
        if let Some(planes) = &self.weights
            && !(ROW && varying.dda.weights.1)
        {
            let Varying { weights: [w0, w2], whole, reciprocals, .. } = &mut *varying;
            let (w0, w2) = (&mut w0[batch.lanes()], &mut w2[batch.lanes()]);
            let close = if let Some(estimates) = setup.estimates::<ROW>(planes, (0, [0.0; 2]), local) {
                let estimates = [estimates[0].not_negative(), estimates[1].not_negative()];
                let close = reciprocals.estimate::<FMA, ROW>(estimates, w0, w2);
                close[0] | close[1]
            } else {
                setup.count_defined(Reason::Weights, batch.count);
                for n in 0..batch.count {
                    let [first, third] = setup.sample(batch, n).weights();
                    (w0[n], w2[n]) = (first.value as i32, third.value as i32);
                }
                false
            };
            if close {
                setup.correct_weights::<ROW>(batch, planes, &local.e, w0, w2, whole);
            }
            narrow_weights(batch, &varying.weights, &mut varying.narrow);
        }
        if let (Some(slot), Some(fog)) = (compiled.fog, &self.fog)
            && !(ROW && varying.dda.fog.is_some())
        {
            let Varying { whole: [values, spare], reciprocals, .. } = &mut *varying;
            let row = &mut rows[usize::from(slot)];
            setup.fog_factors::<FMA, ROW>(batch, fog, (local, reciprocals), values, spare, row);
        }
    }
}
