//! INT-1 to INT-4t for small triangles of plain draws. The functions of several boxes are set up at a time, in floating point only, and all quotients
//! by D of a pixel share one reciprocal. What is not on planes goes by kernels of its own, which would make those of planes slower (`ratios.rs`).
//! `docs/exactness.md` has the argument.
#![allow(clippy::float_arithmetic, reason = "estimates: no result depends on how they are rounded")]

use super::CompiledDraw;
use super::box_depths::BoxDepths;
use super::box_levels::BoxLevels;
use super::boxes::BoxCoverage;
use super::color::{colors, narrow_weights};
use super::compiled::{Sampler, Third};
use super::fog::BoxFog;
use super::kernels::PerLane;
use super::levels::Fetches;
use super::quotient::{QuotientEstimate, Reciprocals, SLACK, break_ties, proof, whole};
use super::ratios::{BoxNumber, Ratios, References, Weights};
use super::setup::PixelBatch;
use super::shapes::{Corners, Each, Edges, GROUP, Lines, SIDE, Shapes, sum};
use super::short::lower_flat;
use super::triangle::Varying;
use crate::engine::context::TriangleContext;
use crate::engine::walk::Window;
use crate::number::convert::factor;
use crate::raster::fog::limited;
use crate::state::{PlaneLoss, TEXTURE_UNITS, Vertices};
use crate::texture::coordinates::wrapped_axis;
use crate::texture::planned::PlannedUnit;

/// Boxes of small triangles that are set up at a time.
#[derive(Debug, Default)]
pub(crate) struct Boxes {
    /// Corners of triangles.
    pub(super) corners: Corners,
    /// Rows and columns of each, and the index of the triangle among the contexts, in the order in which they are drawn.
    pub(super) all: Each<(Window, usize)>,
    pub(super) count: usize,
    /// Their pixels.
    coverages: Each<BoxCoverage>,
    /// Index of the current box.
    pub(super) current: usize,
    shapes: Shapes,
    /// Set up if they are the draw's.
    pub(super) depths: BoxDepths,
    /// Set up if anything is divided.
    edges: Edges,
    /// u and v of the samplers.
    coordinates: [[Estimates; 2]; TEXTURE_UNITS],
    /// The same for those samplers whose coordinates are divided by q.
    ratios: [Ratios; TEXTURE_UNITS],
    projects: [bool; TEXTURE_UNITS],
    /// Whether there are any of them, depths to compare with, fog, or numbers.
    pub(super) has_ratios: bool,
    short: Weights,
    /// Level 0 of the samplers that have levels.
    levels: [BoxLevels; TEXTURE_UNITS],
    /// Whether there are any of them.
    pub(super) has_levels: bool,
    /// Depths that samplers compare with.
    references: [References; TEXTURE_UNITS],
    /// Weights 0 and 2.
    weights: [Estimates; 2],
    /// Fog, if it is read: as a function, or factors of the vertices in 4096ths.
    fog: BoxFog,
    factors: Estimates,
    /// Numbers that the texture shader reads.
    numbers: Vec<BoxNumber>,
    /// Whether all estimates can prove something.
    proves: Each<bool>,
    /// Whether quotients that are whole may be told from others, and are lowered then.
    ties: Each<bool>,
}

impl Boxes {
    /// Adds a box, for which there is room.
    #[inline(always)]
    pub(super) fn add(&mut self, window: Window, context: usize) {
        self.all[self.count] = (window, context);
        self.count += 1;
    }

    /// Returns the pixels of the current box.
    #[inline(always)]
    pub(super) fn coverage(&self) -> &BoxCoverage {
        &self.coverages[self.current]
    }

    #[inline(always)]
    pub(super) fn coverage_mut(&mut self) -> &mut BoxCoverage {
        &mut self.coverages[self.current]
    }

    /// Finds the pixels of the boxes, on a surface with rows of so many pixels.
    #[inline(always)]
    pub(super) fn cover(&mut self, width: u32) {
        let all = &self.all[..self.count];
        self.shapes.place(&self.corners, all);
        let spans = self.shapes.spans(all);
        for (n, ((window, _), coverage)) in all.iter().zip(&mut self.coverages).enumerate() {
            coverage.cover(&spans, n, *window, width);
        }
    }

    /// Finds the pixels of the boxes, and sets up their depths and, for a plain draw, all other functions. `width` is as in
    /// [`cover`](Self::cover). Contexts need not be [placed](TriangleContext::place).
    #[inline(always)]
    pub(super) fn set_up<const FMA: bool>(
        &mut self,
        contexts: &[TriangleContext<'_>],
        compiled: &CompiledDraw,
        width: u32,
    ) {
        self.cover(width);
        let (all, context, vertices) = (&self.all[..self.count], &contexts[0], self.vertices());
        if compiled.depths_together {
            let z = context.draw.assembly.vertices.gather_positions(2, &vertices);
            self.depths.set_up(&z, context.draw.depth_format, &self.shapes);
        }
        (self.proves, self.ties, self.has_ratios, self.has_levels) = ([true; GROUP], [false; GROUP], false, false);
        if !compiled.plain {
            return;
        }
        let varies = all.iter().any(|(_, triangle)| compiled.varies(&contexts[*triangle]));
        if varies || compiled.divides() {
            self.shapes.weigh::<FMA>(&self.corners, all, (context.draw.perspective, context.plan.profile));
            self.set_up_functions::<FMA>(&vertices, (context, compiled), varies);
        }
    }

    /// Returns the vertices of all boxes. Those past the last one repeat the first.
    #[inline(always)]
    fn vertices(&self) -> Each<[u32; 3]> {
        let mut vertices = [self.corners.vertices[self.all[0].1]; GROUP];
        for (vertices, (_, triangle)) in vertices.iter_mut().zip(&self.all[..self.count]) {
            *vertices = self.corners.vertices[*triangle];
        }
        vertices
    }

    /// Sets up coordinates, and weights if they vary.
    #[inline(always)]
    fn set_up_functions<const FMA: bool>(
        &mut self,
        vertices: &Each<[u32; 3]>,
        (context, compiled): (&TriangleContext<'_>, &CompiledDraw),
        varies: bool,
    ) {
        self.edges.set::<FMA>(&self.shapes);
        let (shapes, edges) = (&self.shapes, &self.edges);
        let may_lose = context.plan.policies.plane_loss == PlaneLoss::Finite;
        let mut proves = [-1; GROUP];
        self.projects = [false; TEXTURE_UNITS];
        for (n, sampler) in own(compiled) {
            let unit = &context.draw.units[sampler.index];
            let (of, set) = (&context.draw.assembly.vertices, unit.stage.coordinate_set);
            let q = of.gather(set, 3, vertices);
            let mut is_plane = [true; GROUP];
            for n in 0..GROUP {
                is_plane[n] = [q[0][n], q[1][n], q[2][n]] == [1.0; 3];
            }
            // Most draws divide all coordinates of a unit by q or none.
            self.projects[n] = !is_plane[0];
            if self.projects[n] && !sampler.mixes {
                continue;
            }
            for n in 0..GROUP {
                // Ties on levels are lowered one by one.
                let loses = (may_lose & (shapes.exact[n] == 0)) | (sampler.mixes & (edges.tied[n] > 0.0));
                proves[n] &= -i32::from(is_plane[n] & !loses);
            }
            self.has_levels |= sampler.mixes;
            if sampler.mixes {
                continue;
            }
            let [s, t] = repeated(unit, of, vertices);
            let (bias, [width, height], [up, down]) = (sampler.bias(), sampler.sides, sampler.up);
            let [u, v] = &mut self.coordinates[n];
            for (estimates, at, side, up) in [(u, s, width, up), (v, t, height, down)] {
                let (side, mut g) = (f64::from(256 * side), [[0.0; GROUP]; 3]);
                for k in 0..3 {
                    for n in 0..GROUP {
                        g[k][n] = (f64::from(at[k][n]) * side + up) * edges.p[k][n];
                    }
                }
                *estimates = Estimates::new::<FMA>(edges, &g, bias, &mut proves);
            }
        }
        if varies {
            for (k, estimates) in [0, 2].into_iter().zip(&mut self.weights) {
                *estimates = Estimates::of_weight(edges, k, &mut proves);
            }
        }
        for n in 0..GROUP {
            (self.proves[n], self.ties[n]) = (proves[n] != 0, edges.tied[n] > 0.0);
        }
        let any = self.proves[..self.count].contains(&true);
        self.has_levels &= any;
        self.has_ratios = any && (compiled.reads_ratios() || self.projects.contains(&true));
    }

    /// Sets up coordinates that are divided by q, depths to compare with, fog, and numbers of a texture shader, if there are [any](Self::has_ratios).
    #[inline(always)]
    pub(super) fn set_up_ratios<const FMA: bool>(&mut self, context: &TriangleContext<'_>, compiled: &CompiledDraw) {
        let (of, vertices) = (&context.draw.assembly.vertices, &self.vertices());
        let (shapes, edges) = (&self.shapes, &self.edges);
        let mut proves = [-1; GROUP];
        if self.projects.contains(&true) {
            self.short.set_up::<FMA>(edges);
        }
        for (index, sampler) in compiled.samplers.iter().enumerate() {
            let projects = self.projects[sampler.shares.unwrap_or(index)];
            if !projects && sampler.third.is_none() {
                continue;
            }
            let unit = &context.draw.units[sampler.index];
            let [s, t] = repeated(unit, of, vertices);
            let [r, q] = [2, 3].map(|component| of.gather(unit.stage.coordinate_set, component, vertices));
            for n in 0..GROUP {
                let divides = [q[0][n], q[1][n], q[2][n]] != [1.0; 3];
                proves[n] &= -i32::from(divides == projects);
            }
            if let Some(Third::Reference(format)) = sampler.third {
                self.references[index].set_up::<FMA>(edges, (&r, projects.then_some(&q)), format, &mut proves);
            }
            if projects && sampler.shares.is_none() {
                self.ratios[index].set_up::<FMA>((edges, shapes), [&s, &t, &q], sampler.sides, &mut proves);
            }
        }
        if compiled.fog.is_some() {
            let values = of.gather_fog(vertices);
            match &context.draw.fog.function {
                Some(function) => self.fog.set_up::<FMA>(edges, &values, function, &mut proves),
                None => {
                    let mut g = [[0.0; GROUP]; 3];
                    for k in 0..3 {
                        for n in 0..GROUP {
                            g[k][n] = 4096.0 * f64::from(limited(values[k][n])) * edges.p[k][n];
                        }
                    }
                    self.factors = Estimates::new::<FMA>(edges, &g, 0, &mut proves);
                }
            }
        }
        for n in 0..GROUP {
            self.proves[n] &= proves[n] != 0;
        }
        let Some(shader) = compiled.of_numbers() else { return };
        self.numbers.resize(shader.varying.len(), BoxNumber::default());
        for (number, (stage, component, _)) in self.numbers.iter_mut().zip(&shader.varying) {
            let values = of.gather(shader.stages[*stage].state.coordinate_set, *component, vertices);
            number.set_up::<FMA>((edges, shapes), &values);
        }
    }

    /// Sets up level 0 of samplers with levels, if there are [any](Self::has_levels).
    #[inline(always)]
    pub(super) fn set_up_levels<const FMA: bool>(&mut self, context: &TriangleContext<'_>, compiled: &CompiledDraw) {
        let (vertices, mut proves, mut extents) = (&self.vertices(), [-1; GROUP], [[1.0; GROUP]; 2]);
        for (n, ((rows, columns), _)) in self.all[..self.count].iter().enumerate() {
            (extents[0][n], extents[1][n]) = ((columns.1 - columns.0) as f64, (rows.1 - rows.0) as f64);
        }
        for (index, sampler) in own(compiled).filter(|(_, sampler)| sampler.mixes) {
            let unit = &context.draw.units[sampler.index];
            let at = repeated(unit, &context.draw.assembly.vertices, vertices);
            let shifts = unit.largest_shifts();
            self.levels[index].set_up::<FMA>((&self.edges, &extents), &at, (sampler, shifts), &mut proves);
        }
        for n in 0..GROUP {
            self.proves[n] &= proves[n] != 0;
        }
    }

    /// Returns the numbers that the texture shader reads, if it reads [nothing else](CompiledDraw::of_numbers).
    pub(super) fn numbers(&self) -> &[BoxNumber] {
        &self.numbers
    }

    /// Returns whether there is anything besides coordinates on planes without levels, and weights.
    pub(super) fn has_more(&self) -> bool {
        self.has_ratios || self.has_levels
    }

    /// Returns whether ties of the current box are lowered.
    #[inline(always)]
    pub(super) fn is_tied(&self) -> bool {
        self.ties[self.current]
    }

    /// Interpolates all attributes of the pixels of the current box, of which there is at least one, for a plain draw. `TIES` says whether it
    /// [is tied](Self::is_tied). Returns `false` if something is not proved; then nothing counts.
    #[inline(always)]
    pub(super) fn interpolate<const FMA: bool, const TIES: bool>(
        &self,
        context: &TriangleContext<'_>,
        compiled: &CompiledDraw,
        batch: PixelBatch<'_>,
        varying: &mut Varying,
        rows: &mut [PerLane<i16>],
    ) -> bool {
        let n = self.current;
        if !self.proves[n] {
            return false;
        }
        let weighted = compiled.varies(context);
        let Varying { coordinates, weights, whole, narrow, reciprocals, .. } = &mut *varying;
        if weighted || compiled.divides() {
            reciprocals.set::<FMA, false>(batch.at, self.edges.denominator.of(n));
        }
        let (at, mut open) = (|| batch.lanes(), false);
        for (index, sampler) in own(compiled) {
            if self.projects[index] || sampler.mixes {
                continue;
            }
            for (axis, (estimates, out)) in self.coordinates[index].iter().zip(&mut coordinates[index]).enumerate() {
                let (estimate, out) = (estimates.of(n), &mut out[at()]);
                open |= if TIES {
                    self.lowered::<FMA>(context, (sampler, axis), batch, (estimate, reciprocals), out, &mut whole[0])
                } else {
                    reciprocals.floors::<FMA, false, _>(estimate, out, |value| value)
                };
            }
        }
        if weighted && TIES {
            open |= self.lowered_weights::<FMA>(batch, reciprocals, weights, whole);
            narrow_weights(batch, weights, narrow);
        } else if weighted {
            for (estimates, out) in self.weights.iter().zip(narrow) {
                let estimate = QuotientEstimate { base: 0, shift: WEIGHT_SHIFT, least: 0, ..estimates.of(n) };
                open |= reciprocals.floors::<FMA, false, _>(estimate, &mut out[at()], |weight| weight as u16);
            }
        }
        if open {
            return false;
        }
        colors(context, compiled, batch, &varying.narrow, rows);
        true
    }

    /// INT-4t: writes a coordinate along an axis on a triangle with a single w. Returns whether it is not proved.
    #[inline(always)]
    fn lowered<const FMA: bool>(
        &self,
        context: &TriangleContext<'_>,
        (sampler, axis): (&Sampler, usize),
        batch: PixelBatch<'_>,
        (estimate, reciprocals): (QuotientEstimate, &Reciprocals),
        out: &mut [i32],
        whole: &mut PerLane<i32>,
    ) -> bool {
        let (n, whole) = (self.current, &mut whole[batch.lanes()]);
        let (close, any) = reciprocals.floors_and_whole::<FMA>(estimate, self.edges.tied[n], out, whole);
        if any {
            let (of, vertices) = (&context.draw.assembly.vertices, self.corners.vertices[self.all[n].1]);
            let [[first], [middle], [third]] =
                repeated(&context.draw.units[sampler.index], of, &[vertices])[axis].map(|of| of.map(f64::from));
            lower_flat::<FMA>(self.edges.lines(n), batch.at, [first - middle, third - middle], whole, out);
        }
        close
    }

    /// INT-3: writes the weights 0 and 2 on a triangle with a single w. Returns whether they are not proved.
    #[inline(always)]
    fn lowered_weights<const FMA: bool>(
        &self,
        batch: PixelBatch<'_>,
        reciprocals: &Reciprocals,
        [w0, w2]: &mut [PerLane<i32>; 2],
        [whole0, whole2]: &mut [PerLane<i32>; 2],
    ) -> bool {
        let (n, at) = (self.current, || batch.lanes());
        let (w0, w2, whole0, whole2) = (&mut w0[at()], &mut w2[at()], &mut whole0[at()], &mut whole2[at()]);
        let gap = self.edges.tied[n];
        let (close, any) = reciprocals.floors_and_whole::<FMA>(self.weights[0].of(n), gap, w0, whole0);
        let (other, any_other) = reciprocals.floors_and_whole::<FMA>(self.weights[1].of(n), gap, w2, whole2);
        if any | any_other {
            break_ties(w0, w2, whole0, whole2);
        }
        close | other
    }

    /// Computes coordinates that are divided by q, depths to compare with, and fog of the pixels of the current box, whose other attributes are
    /// proved. Returns `false` if something is not.
    #[inline(always)]
    pub(super) fn interpolate_ratios<const FMA: bool>(
        &self,
        (context, compiled): (&TriangleContext<'_>, &CompiledDraw),
        batch: PixelBatch<'_>,
        Varying { coordinates, references, short, whole: [values, spare], reciprocals, .. }: &mut Varying,
        rows: &mut [PerLane<i16>],
    ) -> bool {
        let (n, lanes) = (self.current, || batch.lanes());
        let of = (&self.edges, &self.shapes);
        if self.projects.contains(&true) && self.short.classify::<FMA>(of, n, batch.at, &mut short.dominance) {
            return false;
        }
        let mut open = false;
        for (index, sampler) in compiled.samplers.iter().enumerate() {
            if let Some(Third::Reference(format)) = sampler.third {
                open |= self.references[index].words::<FMA>(n, batch.at, format, &mut references[index][lanes()]);
            }
            if self.projects[index] {
                let [u, v] = &mut coordinates[index];
                let out = [&mut u[lanes()], &mut v[lanes()]];
                open |= self.ratios[index].floors::<FMA>(n, batch.at, sampler.bias(), short, out);
            }
        }
        if let Some(slot) = compiled.fog {
            let out = &mut rows[usize::from(slot)][lanes()];
            if context.draw.fog.function.is_some() {
                open |= self.fog.factors::<FMA>(n, reciprocals.lanes(out.len()), out, values, spare);
            } else {
                let to = |value: i32| factor(value.clamp(0, 4096)) as i16;
                open |= reciprocals.floors::<FMA, false, _>(self.factors.of(n), out, to);
            }
        }
        !open
    }

    /// Computes the fetches of samplers with levels for the pixels of the current box, whose other attributes are proved. Returns `false` if something
    /// is not.
    #[inline(always)]
    pub(super) fn interpolate_levels(
        &self,
        (context, compiled): (&TriangleContext<'_>, &CompiledDraw),
        fetches: Fetches,
        batch: PixelBatch<'_>,
        Varying { reads, quads, placing, short, reciprocals, .. }: &mut Varying,
    ) -> bool {
        quads.begin_box(batch);
        for (index, sampler) in own(compiled).filter(|(_, sampler)| sampler.mixes) {
            let base = self.levels[index].of(self.current, self.edges.denominator.of(self.current), sampler);
            let of = (&context.draw.units[sampler.index], sampler, &base);
            let work = (&mut **short, &mut **quads, &mut **placing);
            if !fetches(batch, of, None, (reciprocals, None), work, &mut reads[index]) {
                return false;
            }
        }
        true
    }
}

/// Returns s and t of a unit at vertices of triangles, repeated as CYL-1 says.
#[inline(always)]
fn repeated<const N: usize>(unit: &PlannedUnit, of: &Vertices, vertices: &[[u32; 3]; N]) -> [[[f32; N]; 3]; 2] {
    let set = unit.stage.coordinate_set;
    let mut both = [of.gather(set, 0, vertices), of.gather(set, 1, vertices)];
    if unit.state.cylindrical_wrap != [false; 2] {
        for (axis, values) in both.iter_mut().enumerate() {
            for n in 0..N {
                [values[0][n], values[1][n], values[2][n]] =
                    wrapped_axis(unit, axis, [values[0][n], values[1][n], values[2][n]]);
            }
        }
    }
    both
}

/// Returns the samplers that have coordinates of their own, with their indices.
#[inline(always)]
fn own(compiled: &CompiledDraw) -> impl Iterator<Item = (usize, &Sampler)> {
    compiled.samplers.iter().enumerate().filter(|(_, sampler)| sampler.shares.is_none() && !sampler.depends)
}

/// Number of bits below a weight's 256th that estimates keep.
const WEIGHT_SHIFT: u32 = 21;

/// The [`QuotientEstimate`]s of a quotient in each box.
#[derive(Debug, Default)]
struct Estimates {
    line: Lines,
    base: Each<i32>,
    shift: Each<u32>,
    limit: Each<i32>,
}

impl Estimates {
    /// Sets up a quotient in all boxes. `g` has the numerators at the vertices, before they are floored. Clears `proves` where the estimate can
    /// prove nothing.
    #[inline(always)]
    fn new<const FMA: bool>(edges: &Edges, g: &[Each<f64>; 3], bias: i32, proves: &mut Each<i32>) -> Estimates {
        let mut all = Estimates::default();
        let (lines, bounds) = edges.function::<FMA>(g);
        // Not one struct for each quotient, because compilers do not vectorise such a loop.
        for n in 0..GROUP {
            let at = |of: &[Each<f64>; 3]| [of[0][n], of[1][n], of[2][n]];
            let (g, inverse, line, terms) = (at(g), at(&edges.inverse), lines.of(n), bounds[n]);
            let size = [g[0].abs(), g[1].abs(), g[2].abs()];
            let is_whole = |k: usize| whole(g[k] * inverse[k]) == g[k] * inverse[k];
            let gap = if is_whole(0) & is_whole(1) & is_whole(2) { edges.gap[n] + edges.tied[n] } else { 0.0 };
            // Adds half a denominator, half a texel, and the rounding error of this number.
            let most = sum::<FMA>(&size, &inverse) + 260.0;
            let margin = (terms * edges.widest[n] + 2.0 * most * edges.ratio[n]) * SLACK + edges.floors[n];
            let (extent, reciprocals) = ((SIDE as f64, SIDE as f64), (edges.reciprocal[n], edges.widest[n]));
            let denominator = edges.denominator.of(n);
            let (one, is) =
                QuotientEstimate::with_proof::<false>(line, denominator, extent, reciprocals, (margin, gap), bias);
            (all.line.c[n], all.line.x[n], all.line.y[n]) = (one.line.c, one.line.x, one.line.y);
            (all.base[n], all.shift[n], all.limit[n]) = (one.base, one.shift, one.limit);
            proves[n] &= -i32::from(is);
        }
        all
    }

    /// Sets up 256 b_k, which lies between 0 and 256 at all pixels of a triangle.
    #[inline(always)]
    fn of_weight(edges: &Edges, k: usize, proves: &mut Each<i32>) -> Estimates {
        let (scale, mut all) =
            (f64::from(1 << WEIGHT_SHIFT), Estimates { shift: [WEIGHT_SHIFT; GROUP], ..Estimates::default() });
        for n in 0..GROUP {
            let times = 256.0 * edges.p[k][n];
            let margin = (times * edges.terms[k][n] * edges.widest[n] + 2.0 * 516.0 * edges.ratio[n]) * SLACK;
            let (down, limit, is) = proof(margin + edges.floors[n], edges.gap[n] + edges.tied[n], scale);
            let (denominator, line) = (edges.denominator.of(n), edges.line(k, n));
            let line = line.times(times * scale).less(down, denominator);
            (all.line.c[n], all.line.x[n], all.line.y[n]) = (line.c, line.x, line.y);
            all.limit[n] = limit;
            proves[n] &= -i32::from(is);
        }
        all
    }

    #[inline(always)]
    fn of(&self, n: usize) -> QuotientEstimate {
        let (base, shift, limit) = (self.base[n], self.shift[n], self.limit[n]);
        QuotientEstimate { line: self.line.of(n), base, shift, limit, least: i32::MIN }
    }
}
