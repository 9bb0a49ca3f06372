//! The coordinate r on rows: the layer of a volume (VOL-1), or the reference of a depth texture (SHD-1).
#![allow(clippy::float_arithmetic, reason = "estimates: no result depends on how they are rounded")]

use super::compiled::{CompiledDraw, Reason, Sampler, Third};
use super::depth::UNKNOWN;
use super::depth_words::word;
use super::direction::{FindCoordinates, positive};
use super::kernels::PerLane;
use super::planes::{FourPlanes, Plane};
use super::quotient::{IOTA_REAL, Line, Positions, Reciprocals, SLACK, floor, nearest, position};
use super::setup::{BatchSetup, PixelBatch, Planes, Setup};
use super::short::Short;
use super::table;
use crate::engine::context::TriangleContext;
use crate::raster::depth;
use crate::raster::interpolate::Sample;
use crate::state::DepthFormat;
use crate::texture::coordinates::{SampleCoordinates, layer_planes};
use crate::texture::planned::PlannedUnit;

/// Returns the use of r in a sampler that is complete otherwise.
pub(super) fn purpose(unit: &PlannedUnit, sampler: &Sampler) -> Option<Third> {
    if let Some(axis) = table::layers(unit) {
        let sides = [unit.layers; 2];
        let (third, up) = (Some(Third::Counts), [0.0; 2]);
        let counts = Sampler { sides, filters: false, table: None, third, up, ..sampler.clone() };
        return Some(Third::Layer(Box::new(counts), axis));
    }
    let format = unit.format.depth().unwrap_or(DepthFormat::Z16);
    table::compares_r(unit).map(|_| Third::Reference(format))
}

/// The linear functions of a sampler's r.
#[derive(Debug)]
pub(super) enum ThirdPlanes {
    /// It does not use r.
    None,
    /// The layer of a volume, with r as both coordinates.
    Layer(Planes),
    /// The reference of a depth texture (SHD-1).
    Reference(Reference),
}

/// The references of a depth texture across a triangle.
#[derive(Debug)]
pub(super) enum Reference {
    /// The same word everywhere.
    Same(u32),
    /// r divided by D.
    Plane(FourPlanes),
    /// r divided by q, which are the first two functions.
    Ratio(FourPlanes),
}

/// Sets the functions of r of a draw's samplers; none if no sampler uses r.
#[inline(always)]
pub(super) fn set_thirds(
    context: &TriangleContext<'_>,
    compiled: &CompiledDraw,
    inverse: &[f64; 3],
    thirds: &mut Vec<ThirdPlanes>,
) {
    thirds.clear();
    if compiled.estimates {
        for sampler in &compiled.samplers {
            thirds.push(third(context, sampler, inverse));
        }
    }
}

#[inline(always)]
fn third(context: &TriangleContext<'_>, sampler: &Sampler, inverse: &[f64; 3]) -> ThirdPlanes {
    let triangle = &context.triangle;
    let unit = &context.draw.units[sampler.index];
    let (vertices, set) = (context.vertices(), unit.stage.coordinate_set);
    let (r, q) = (vertices.coordinate(set, 2), vertices.coordinate(set, 3));
    match (&sampler.third, context.coordinates_of(sampler.unit)) {
        (Some(Third::Layer(..)), Some(coordinates)) => {
            ThirdPlanes::Layer(match layer_planes(triangle, coordinates, [r, q], unit.layers) {
                (r, None) => Planes::Plane([Plane::new(triangle, inverse, r); 2]),
                (r, Some(q)) => {
                    let (g, reach) = positive([r, r, q]);
                    Planes::Ratio(Plane::three(triangle, inverse, &g), reach)
                }
            })
        }
        (Some(Third::Reference(format)), Some(_)) => {
            let same = |values: [f32; 3]| values[0] == values[1] && values[1] == values[2];
            let mut planes = FourPlanes::default();
            let [a, b, c] = [0, 1, 2].map(|k| [r[k], q[k], 0.0, 0.0]);
            planes.set(triangle, inverse, &[a, b, c]);
            ThirdPlanes::Reference(if same(r) && same(q) {
                // Equal to that at its first vertex.
                let sample = Sample::new(triangle, [triangle.doubled_area, 0, 0]);
                Reference::Same(defined(context, unit, *format, &sample, (0, 0)))
            } else if q == [1.0; 3] {
                Reference::Plane(planes)
            } else {
                Reference::Ratio(planes)
            })
        }
        _ => ThirdPlanes::None,
    }
}

/// SHD-1: returns the word of the reference by the definition.
fn defined(
    context: &TriangleContext<'_>,
    unit: &PlannedUnit,
    format: DepthFormat,
    sample: &Sample<'_>,
    pixel: (i64, i64),
) -> u32 {
    context.sample_coordinates(unit, sample, pixel).map_or(0, |place| depth::word(format, place.reference()))
}

/// Returns the least of a triangle's numbers.
fn least(g: [f64; 3]) -> f64 {
    g[0].min(g[1]).min(g[2])
}

impl Setup<'_> {
    /// Computes layers and references of a batch.
    #[inline(always)]
    pub(super) fn thirds<const FMA: bool, const ROW: bool>(
        &self,
        coordinates: FindCoordinates,
        batch: PixelBatch<'_>,
        (compiled, planes): (&CompiledDraw, &[ThirdPlanes]),
        (local, reciprocals): (&BatchSetup, &Reciprocals),
        ([faces, references], layers): ([&mut [PerLane<u32>]; 2], &mut [PerLane<i32>; 2]),
        (short, whole): (&mut Short, &mut PerLane<i32>),
    ) {
        let all = compiled.samplers.iter().zip(planes).zip(faces).zip(references);
        for (((sampler, planes), faces), references) in all {
            match (&sampler.third, planes) {
                (Some(Third::Layer(counts, axis)), ThirdPlanes::Layer(planes)) => {
                    let work = (&mut *short, &mut *whole);
                    let local = (local, reciprocals);
                    coordinates(self, batch, (counts, planes), local, (&mut *layers, &mut *faces), work);
                    let (layers, faces) = (&mut layers[0][batch.lanes()], &mut faces[batch.lanes()]);
                    axis.reduce(layers);
                    for (face, layer) in faces.iter_mut().zip(layers) {
                        *face = axis.entry((*layer).max(axis.low).min(axis.high)) as u32;
                    }
                }
                (Some(Third::Reference(format)), ThirdPlanes::Reference(reference)) => {
                    let out = &mut references[batch.lanes()];
                    if self.references::<FMA, ROW>(&batch, *format, reference, local, out) {
                        self.defined_references(batch, sampler, *format, out);
                    }
                }
                _ => {}
            }
        }
    }

    /// SHD-1: computes the words of references. Returns whether some are unknown.
    #[inline(always)]
    fn references<const FMA: bool, const ROW: bool>(
        &self,
        batch: &PixelBatch<'_>,
        format: DepthFormat,
        reference: &Reference,
        local: &BatchSetup,
        out: &mut [u32],
    ) -> bool {
        let (at, beyond) = (batch.at, batch.reaches_beyond());
        let (lines, errors) = match reference {
            Reference::Same(word) => {
                out.fill(*word);
                return false;
            }
            Reference::Plane(planes) => {
                let ([line, ..], terms) = planes.around(&local.real, local.columns, local.rows);
                let lost = planes.lost[0] / least(self.context.triangle.p.map(|p| p as f64));
                // Beyond the triangle, the magnitudes of weights add up to more than 1.
                let lost = if beyond { lost * local.ratio } else { lost };
                let off = local.margin_by::<ROW>(planes.reach[0], terms[0]) + lost;
                ((line, local.denominator), [off, 0.0, 0.0])
            }
            Reference::Ratio(planes) => {
                let ([r, q, ..], terms) = planes.around(&local.real, local.columns, local.rows);
                let mut area = self.context.triangle.doubled_area as f64;
                if beyond {
                    // There, edge functions may be negative.
                    let size = |e: [f64; 3]| e[0].abs() + e[1].abs() + e[2].abs();
                    let triangle = &self.context.triangle;
                    let [along, down] = [triangle.a, triangle.b].map(|slopes| size(slopes.map(|slope| slope as f64)));
                    area = size(local.real) + along * local.columns + down * local.rows;
                }
                // The error of a line, and twice that for the quotient; and what is lost at the vertices.
                let error = |n: usize| 8.0 * SLACK * terms[n] + planes.lost[n] * area;
                let (of_r, of_q) = (error(0) + error(1), error(1));
                // One error for all, unless q is close to 0 somewhere.
                let least = q.c.abs() - (q.x * local.columns).abs() - (q.y * local.rows).abs() - 4.0 * of_q;
                let off = (of_r + of_q * (terms[0] / least)) / least;
                ((r, q), if least > 0.0 && off < SMALL_ERROR { [off, 0.0, 0.0] } else { [0.0, of_r, of_q] })
            }
        };
        // NaN proves nothing either.
        let proves = errors[1] > 0.0 || errors[0] < f64::from(format.largest());
        if !proves {
            out.fill(UNKNOWN);
            return true;
        }
        match (format.is_float(), errors[1] > 0.0) {
            (false, false) => words::<FMA, ROW, false, false>(at, lines, errors, format, out),
            (false, true) => words::<FMA, ROW, false, true>(at, lines, errors, format, out),
            (true, false) => words::<FMA, ROW, true, false>(at, lines, errors, format, out),
            (true, true) => words::<FMA, ROW, true, true>(at, lines, errors, format, out),
        }
    }

    /// Computes the unknown references by the definition.
    #[inline(never)]
    fn defined_references(&self, batch: PixelBatch<'_>, sampler: &Sampler, format: DepthFormat, out: &mut [u32]) {
        let unit = &self.context.draw.units[sampler.index];
        let unknown = out[..batch.count].iter_mut().enumerate().filter(|(_, word)| **word == UNKNOWN);
        for (n, word) in unknown {
            self.count_defined(Reason::References, 1);
            *word = defined(self.context, unit, format, &self.sample(batch, n), batch.pixel(n));
        }
    }
}

/// DEP-3 in a fixed-point format.
#[inline(always)]
fn floored(full: f64, depth: f64) -> u32 {
    let depth = if depth > 0.0 { depth } else { 0.0 };
    nearest(floor::<false>(if depth < full { depth } else { full })) as u32
}

/// An error of references that leaves few of them open.
pub(super) const SMALL_ERROR: f64 = 1.0 / 64.0;

/// DEP-3 of quotients x = r/q, whose error is less than `off` or, in an `EACH` of its own, than (`of_r` + `of_q` |x|) / |q| unless that of q
/// is more than a quarter of it. Returns whether some are unknown. `FLOAT` says that the format has floats.
#[inline(always)]
pub(super) fn words<const FMA: bool, const ROW: bool, const FLOAT: bool, const EACH: bool>(
    at: Positions<'_>,
    lines: (Line, Line),
    [off, of_r, of_q]: [f64; 3],
    format: DepthFormat,
    out: &mut [u32],
) -> bool {
    let full = f64::from(format.largest());
    let lanes = out.len();
    let last = f64::from(at.last);
    let (xs, ys, iota) = (&at.x[..lanes], &at.y[..lanes], &IOTA_REAL[..lanes]);
    let mut open = 0;
    for n in 0..lanes {
        let (x, y) = position::<ROW>(n, last, xs, ys, iota);
        let q = lines.1.at::<FMA, ROW>(x, y);
        let value = lines.0.at::<FMA, ROW>(x, y) / q;
        let off = if EACH { (of_r + of_q * value.abs()) / q.abs() } else { off };
        let (low, high) = (value - off, value + off);
        let (low, high) =
            if FLOAT { (word(format, low), word(format, high)) } else { (floored(full, low), floored(full, high)) };
        // NaN proves nothing either.
        let high = if !EACH || (q.abs() > 4.0 * of_q) & (off >= 0.0) { high } else { UNKNOWN };
        open |= low ^ high;
        out[n] = if low == high { low } else { UNKNOWN };
    }
    open != 0
}
