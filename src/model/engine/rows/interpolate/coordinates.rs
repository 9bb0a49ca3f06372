//! INT-4, TEX-12, TEX-15, VOL-1 and SHD-1 on rows: where the lanes of a triangle sample a texture.
#![allow(clippy::float_arithmetic, reason = "doubles hold every number exactly")]

use super::depths::word;
use super::{LaneWeights, quotient, ratio, reciprocal};
use crate::engine::rows::geometry::weights::CHUNK;
use crate::engine::rows::lanes::{larger, limited, nearest, smaller};
use crate::engine::rows::sampling::facing::{Facing, floors_on_face};
use crate::engine::rows::sampling::place::{FARTHEST, Place, change_kind};
use crate::engine::rows::sampling::sampler::{Sampler, Third};
use crate::raster::weights::Linear;
use crate::state::TriangleVertices;
use crate::texture::coordinates::wrapped;
use crate::texture::planned::PlannedUnit;
use std::ops::Range;

/// The coordinates of a sampler across a triangle.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Coordinates {
    /// s, t and, of a cube map, r; otherwise q.
    numbers: [Linear<f64>; 3],
    kind: Kind,
    /// r, if layers or references follow from it.
    r: Linear<f64>,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Kind {
    /// q is 1 at all vertices.
    #[default]
    Plane,
    Ratio,
    Direction,
}

impl Coordinates {
    /// Sets up a triangle. A stage that moves coordinates ignores q.
    #[inline(always)]
    pub(crate) fn new(unit: &PlannedUnit, sampler: &Sampler, vertices: TriangleVertices<'_>) -> Coordinates {
        let [a, b, c] = vertices.coordinates(unit.stage.coordinate_set);
        let component = |n: usize| [a[n], b[n], c[n]];
        let (q, r) = (component(3), component(2));
        // CYL-1 is not for coordinates that are moved.
        let [a, b, c] = if sampler.moves { [a, b, c] } else { wrapped(unit, [a, b, c]) };
        // TEX-20: t lies the other way round, also on a face, where it is y that changes its sign.
        let t = if sampler.is_other_kind() { [-a[1], -b[1], -c[1]] } else { [a[1], b[1], c[1]] };
        let (s, t) = (Linear::new([a[0], b[0], c[0]]), Linear::new(t));
        let kind = match sampler.direction {
            true => Kind::Direction,
            false if q == [1.0; 3] => Kind::Plane,
            false => Kind::Ratio,
        };
        let third = if kind == Kind::Direction { r } else { q };
        let r = if sampler.third.is_some() { Linear::new(r) } else { Linear::default() };
        Coordinates { numbers: [s, t, Linear::new(third)], kind, r }
    }

    /// Computes where lanes sample, or the coordinates that a stage of the texture shader moves.
    #[inline(always)]
    pub(crate) fn compute_places(
        &self,
        sampler: &Sampler,
        weights: LaneWeights<'_>,
        lanes: Range<usize>,
        place: &mut Place,
    ) {
        if sampler.moves {
            return self.components(weights, lanes, place);
        }
        match (self.kind, sampler.takes_quads()) {
            (Kind::Plane, false) => self.on_plane(sampler, weights, lanes.clone(), place),
            (Kind::Ratio, false) => self.divided(sampler, weights, lanes.clone(), place),
            (Kind::Direction, false) => {
                self.components(weights, lanes.clone(), place);
                on_faces(sampler, lanes.clone(), place);
            }
            (Kind::Direction, true) => {
                self.components(weights, lanes.clone(), place);
                on_faces(sampler, lanes.clone(), place);
                // Smaller levels take no more bits.
                for (at, fine) in place.at.iter().zip(&mut place.fine) {
                    let (at, fine) = (&at[lanes.clone()], &mut fine[lanes.clone()]);
                    for n in 0..at.len() {
                        fine[n] = 256.0 * f64::from(at[n]);
                    }
                }
            }
            (_, true) => {
                self.components(weights, lanes.clone(), place);
                self.finely(sampler, lanes.clone(), place);
                if sampler.pairs > 0 {
                    place.settle(lanes, sampler.bias());
                }
                return;
            }
        }
        if sampler.is_other_kind() {
            let Place { at, direction: [x, y, z], .. } = place;
            change_kind(at, sampler, lanes, |n| (x[n], y[n], z[n]) == (0.0, 0.0, 0.0));
        }
    }

    /// Computes the layers of lanes, or what depths are compared with, if the sampler has either.
    #[inline(always)]
    pub(crate) fn place_third(
        &self,
        sampler: &Sampler,
        weights: LaneWeights<'_>,
        lanes: Range<usize>,
        place: &mut Place,
    ) {
        match &sampler.third {
            Some(Third::Layer(layers, axis)) => {
                let scale = 256.0 * f64::from(*layers);
                // The lanes of another use, before the axis limits them.
                let out = &mut place.references[lanes.clone()];
                match self.kind {
                    Kind::Ratio => {
                        weights.each_ratio([&self.r], &self.numbers[2], [out], |_, ratio| limited(scale * ratio) as u32)
                    }
                    _ => weights.each(&self.r, out, |r| limited(scale * r) as u32),
                }
                let (layers, images) = (&mut place.references[lanes.clone()], &mut place.images[lanes]);
                for n in 0..images.len() {
                    let mut at = [layers[n] as i32];
                    axis.reduce(&mut at);
                    images[n] = axis.entry(at[0].max(axis.low).min(axis.high)) as u32;
                }
            }
            Some(Third::Reference(format)) => {
                let out = &mut place.references[lanes];
                match self.kind {
                    Kind::Ratio => {
                        weights.each_quotient(&self.r, &self.numbers[2], out, |r, q| word(*format, quotient(r, q)));
                    }
                    _ => weights.each(&self.r, out, |r| word(*format, r)),
                }
            }
            None => {}
        }
    }

    /// Returns s and t if floors of them are all that a sampler takes.
    #[inline(always)]
    pub(super) fn plane(&self, sampler: &Sampler) -> Option<[Linear<f64>; 2]> {
        let [s, t, _] = self.numbers;
        let is_plane = self.kind == Kind::Plane && !sampler.moves && !sampler.takes_quads() && sampler.third.is_none();
        let is_plane = is_plane && !sampler.is_other_kind();
        is_plane.then_some([s, t])
    }

    /// INT-4: floors of linear functions.
    #[inline(always)]
    fn on_plane(&self, sampler: &Sampler, weights: LaneWeights<'_>, lanes: Range<usize>, place: &mut Place) {
        let bias = sampler.early_bias();
        for axis in 0..2 {
            let scale = 256.0 * f64::from(sampler.sides[axis]);
            let out = &mut place.at[axis][lanes.clone()];
            weights.each(&self.numbers[axis], out, |f| limited(scale * f) - bias);
        }
    }

    /// TEX-15: floors of quotients of two linear functions.
    #[inline(always)]
    fn divided(&self, sampler: &Sampler, weights: LaneWeights<'_>, lanes: Range<usize>, place: &mut Place) {
        let bias = sampler.early_bias();
        let scales = sampler.sides.map(|side| 256.0 * f64::from(side));
        let [s, t, q] = &self.numbers;
        let outs = place.at.each_mut().map(|at| &mut at[lanes.clone()]);
        weights.each_ratio([s, t], q, outs, |axis, ratio| limited(scales[axis] * ratio) - bias);
    }

    /// Computes s, t and q, or a direction.
    #[inline(always)]
    fn components(&self, weights: LaneWeights<'_>, lanes: Range<usize>, place: &mut Place) {
        for (number, out) in self.numbers.iter().zip(&mut place.direction) {
            weights.each(number, &mut out[lanes.clone()], |f| f);
        }
    }

    /// Computes the coordinates of lanes in 1/65536 texel from s, t and q.
    #[inline(always)]
    fn finely(&self, sampler: &Sampler, lanes: Range<usize>, place: &mut Place) {
        let Place { fine, direction, .. } = place;
        let [s, t, q] = direction.each_ref().map(|number| &number[lanes.clone()]);
        let [u, v] = fine.each_mut().map(|out| &mut out[lanes.clone()]);
        let [along, down] = sampler.sides.map(|side| 65536.0 * f64::from(side));
        let is_plane = self.kind == Kind::Plane;
        for n in 0..lanes.len() {
            if is_plane {
                (u[n], v[n]) = ((along * s[n]).floor(), (down * t[n]).floor());
                continue;
            }
            let q = q[n] + 0.0;
            let by = reciprocal(q);
            let floor = |scale: f64, s: f64| smaller(larger((scale * ratio(s, q, by)).floor(), -FARTHEST), FARTHEST);
            (u[n], v[n]) = (floor(along, s[n]), floor(down, t[n]));
        }
    }
}

/// TEX-12: the face of each lane, and the floors of where it samples on it, from its direction.
#[inline(always)]
fn on_faces(sampler: &Sampler, lanes: Range<usize>, place: &mut Place) {
    let (bias, middle) = (sampler.early_bias(), 128.0 * f64::from(sampler.side_of_face()));
    let Place { at: [u, v], images, direction: [x, y, z], .. } = place;
    let mut chunks = [[0.0; CHUNK]; 3];
    for first in lanes.clone().step_by(CHUNK) {
        let count = CHUNK.min(lanes.end - first);
        let (u, v, images) = (&mut u[first..][..count], &mut v[first..][..count], &mut images[first..][..count]);
        let (x, y, z) = (&x[first..][..count], &y[first..][..count], &z[first..][..count]);
        let [s, t, m] = chunks.each_mut().map(|chunk| &mut chunk[..count]);
        for n in 0..count {
            let direction = [x[n], y[n], z[n]];
            let facing = Facing::new(direction);
            images[n] = nearest(facing.number()) as u32;
            [s[n], t[n], m[n]] = facing.components(direction);
        }
        for n in 0..count {
            // Both are whole. Lanes without a pixel may lie beyond the face.
            let [along, down] =
                floors_on_face([s[n], t[n], m[n]], middle).map(|at| smaller(larger(at, 0.0), 2.0 * middle));
            (u[n], v[n]) = (nearest(along) - bias, nearest(down) - bias);
        }
    }
}
