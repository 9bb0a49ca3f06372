//! Everything that varies across a triangle, for the lanes that it has in a block.

use super::Job;
use super::block::Block;
use crate::engine::context::TriangleContext;
use crate::engine::rows::geometry::shape::Shape;
use crate::engine::rows::interpolate::coordinates::Coordinates;
use crate::engine::rows::interpolate::estimates::Estimates;
use crate::engine::rows::interpolate::fog::factors;
use crate::engine::rows::interpolate::sprites::Sprite;
use crate::engine::rows::interpolate::{LaneWeights, colors, numbers};
use crate::engine::rows::shading::compiled::CompiledDraw;
use crate::raster::fog::FogPlane;
use crate::raster::stroke::Figure;
use crate::raster::weights::Linear;

/// The functions of a triangle besides colours and depths. Those of another triangle are replaced.
#[derive(Debug, Default)]
pub(crate) struct Functions {
    /// Coordinates of the samplers.
    coordinates: Vec<Coordinates>,
    sprite: Sprite,
    /// Numbers of the texture shader.
    numbers: Vec<Linear<f64>>,
    fog: Option<FogPlane<f64>>,
    /// Floors of colour weights and coordinates, if the triangle has no other function and all are estimated.
    estimates: Estimates,
    is_estimated: bool,
    /// Whether something besides colours and depths follows from weights.
    weighs: bool,
}

impl Functions {
    /// Sets up a triangle.
    #[inline(always)]
    pub(crate) fn set(&mut self, context: &TriangleContext<'_>, shape: &Shape, compiled: &CompiledDraw) {
        let (draw, vertices) = (context.draw, context.vertices());
        if draw.point_sprite {
            self.sprite.set(context, &compiled.samplers);
        }
        self.weighs = compiled.shader.is_some() || compiled.fog.is_some() || compiled.takes_quads;
        self.coordinates.clear();
        for sampler in &compiled.samplers {
            let unit = &draw.units[sampler.index];
            let weighs = sampler.interpolates() && !(self.sprite.applies(sampler) && sampler.third.is_none());
            let of = if weighs { Coordinates::new(unit, sampler, vertices) } else { Default::default() };
            self.coordinates.push(of);
            self.weighs |= weighs;
        }
        self.numbers.clear();
        for (stage, component, _) in compiled.shader.iter().flat_map(|shader| &shader.varying) {
            let set = compiled.shader.as_ref().map_or(0, |shader| shader.stages[*stage].state.coordinate_set);
            self.numbers.push(Linear::new(vertices.coordinate(set, *component)));
        }
        self.fog = compiled.fog.map(|_| FogPlane::new(draw.fog.function, vertices.fog()));
        let is_plain = compiled.shader.is_none()
            && self.fog.is_none()
            && !compiled.takes_quads
            && context.triangle.figure != Figure::Point;
        self.is_estimated = is_plain && self.estimates.set(shape, &compiled.samplers, &self.coordinates);
    }
}

/// Sets up the functions of a triangle.
#[inline(always)]
pub(crate) fn set_up<const FMA: bool>(context: &TriangleContext<'_>, shape: &Shape, job: &Job<'_>, block: &mut Block) {
    block.functions.set(context, shape, job.compiled);
}

/// Interpolates everything that a draw reads in the lanes of a triangle from the first one on, whose pixels are those of the runs from the first one on.
#[inline(always)]
pub(crate) fn interpolate<const FMA: bool>(
    context: &TriangleContext<'_>,
    shape: &Shape,
    job: &Job<'_>,
    block: &mut Block,
    (lane, run): (usize, usize),
) {
    let compiled = job.compiled;
    // Whole vectors, of which the next triangle overwrites what is too much.
    let lanes = lane..lane + (block.used - lane).next_multiple_of(8);
    // Pixels beside the triangle, which quads have along its edges, count.
    let around =
        compiled.takes_quads && block.runs[run..].iter().map(|run| run.count()).sum::<usize>() < block.used - lane;
    let (primary, secondary) = (&context.primary, &context.secondary);
    let varies = compiled.varies(primary, secondary);
    let Block { pixels, functions, places, workshop, colors, rows, runs, .. } = block;
    let Functions { estimates, is_estimated, weighs, coordinates, sprite, numbers, fog } = functions;
    // All lanes, or those that no estimate decides. There is one call of each function, or compilers would not inline what it calls for each lane.
    let all = match is_estimated {
        true => {
            let colors = varies.then_some(&mut *colors);
            let count = estimates.estimate(&compiled.samplers, (pixels, lanes.clone()), colors, places);
            0..count.next_multiple_of(8)
        }
        false => lanes.clone(),
    };
    let (own, weights) = match is_estimated {
        true => (&mut estimates.pixels, &mut estimates.colors),
        false => (&mut *pixels, &mut *colors),
    };
    if (varies || *weighs) && !all.is_empty() {
        match context.triangle.figure {
            Figure::Point => own.weigh_point(all.clone()),
            Figure::Triangle | Figure::Line => own.weigh::<FMA>(shape, all.clone(), around),
        }
        if varies {
            colors::weigh(own, all.clone(), weights);
        }
    }
    if *is_estimated && varies {
        estimates.scatter(|all| &all.colors, lanes.clone(), colors);
    }
    for (slots, of) in [(&compiled.primary, primary), (&compiled.secondary, secondary)] {
        colors::color(slots, of, lanes.clone(), colors, rows);
    }
    if all.is_empty() {
        return;
    }
    let b = if *is_estimated { &estimates.pixels.b } else { &pixels.b };
    let weights = LaneWeights::new(b, all.clone(), !around);
    for ((sampler, coordinates), place) in compiled.samplers.iter().zip(&*coordinates).zip(places) {
        if sampler.interpolates() {
            let own = if *is_estimated { &mut estimates.place } else { &mut *place };
            match sprite.applies(sampler) {
                true => sprite.compute_places(sampler, pixels, all.clone(), &runs[run..], own),
                false => coordinates.compute_places(sampler, weights, all.clone(), own),
            }
            coordinates.place_third(sampler, weights, all.clone(), own);
            if *is_estimated {
                estimates.scatter(|all| &all.place.at, lanes.clone(), &mut place.at);
            }
        }
    }
    if let Some(shader) = &compiled.shader {
        let all = shader.varying.iter().zip(&*numbers).zip(&mut workshop.numbers);
        for (((_, _, purpose), number), out) in all {
            numbers::numbers(*purpose, number, weights, &mut out[lanes.clone()]);
        }
    }
    if let (Some(slot), Some(fog)) = (compiled.fog, &*fog) {
        factors(fog, weights, &mut rows[usize::from(slot)][lanes]);
    }
}
