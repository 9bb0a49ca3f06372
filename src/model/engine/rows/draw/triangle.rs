//! Everything that varies across a triangle, for the lanes that it has in a block.

use super::block::Block;
use super::job::Job;
use crate::engine::context::TriangleContext;
use crate::engine::rows::geometry::shape::Shape;
use crate::engine::rows::interpolate::coordinates::Coordinates;
use crate::engine::rows::interpolate::fog::Fog;
use crate::engine::rows::interpolate::{Weighted, colors, numbers};
use crate::engine::rows::shading::compiled::CompiledDraw;
use crate::raster::weights::Linear;
use std::ops::Range;

/// The functions of a triangle besides colours and depths. Those of another triangle are replaced.
#[derive(Debug, Default)]
pub(crate) struct Functions {
    /// Coordinates of the samplers.
    coordinates: Vec<Coordinates>,
    /// Numbers of the texture shader.
    numbers: Vec<Linear<f64>>,
    fog: Option<Fog>,
}

impl Functions {
    /// Sets up a triangle.
    #[inline(always)]
    pub(crate) fn set(&mut self, context: &TriangleContext<'_>, compiled: &CompiledDraw) {
        let (draw, vertices) = (context.draw, context.vertices());
        self.coordinates.clear();
        for sampler in &compiled.samplers {
            let unit = &draw.units[sampler.index];
            let of =
                if sampler.interpolates() { Coordinates::new(unit, sampler, vertices) } else { Default::default() };
            self.coordinates.push(of);
        }
        self.numbers.clear();
        for (stage, component, _) in compiled.shader.iter().flat_map(|shader| &shader.varying) {
            let set = compiled.shader.as_ref().map_or(0, |shader| shader.stages[*stage].state.coordinate_set);
            self.numbers.push(Linear::new(vertices.coordinate(set, *component)));
        }
        self.fog = compiled.fog.map(|_| Fog::new(draw.fog.function.as_ref(), vertices.fog()));
    }
}

/// Interpolates everything that a draw reads in some lanes.
#[inline(always)]
pub(crate) fn interpolate(
    context: &TriangleContext<'_>,
    shape: &Shape,
    job: &Job<'_>,
    block: &mut Block,
    lanes: Range<usize>,
) {
    let compiled = job.compiled;
    let (primary, secondary) = (&context.primary, &context.secondary);
    let varies = compiled.varies(primary, secondary);
    let Block { pixels, functions, places, workshop, colors: weights, rows, .. } = block;
    if varies || compiled.interpolates() {
        pixels.weigh(shape, lanes.clone(), compiled.takes_quads);
    }
    if varies {
        colors::weigh(pixels, lanes.clone(), weights);
    }
    for (slots, of) in [(&compiled.primary, primary), (&compiled.secondary, secondary)] {
        colors::color(slots, of, lanes.clone(), weights, rows);
    }
    let weights = Weighted::new(&pixels.b, lanes.clone());
    for ((sampler, coordinates), place) in compiled.samplers.iter().zip(&functions.coordinates).zip(places) {
        if sampler.interpolates() {
            coordinates.place(sampler, weights, lanes.clone(), place);
        }
    }
    if let Some(shader) = &compiled.shader {
        let all = shader.varying.iter().zip(&functions.numbers).zip(&mut workshop.numbers);
        for (((_, _, purpose), number), out) in all {
            numbers::numbers(*purpose, number, weights, &mut out[lanes.clone()]);
        }
    }
    if let (Some(slot), Some(fog)) = (compiled.fog, &functions.fog) {
        fog.factors(weights, &mut rows[usize::from(slot)][lanes]);
    }
}
