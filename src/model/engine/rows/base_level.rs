//! TEX-11 on rows: level 0 of a sampler around a batch, from which coordinates at quads and levels of detail follow.
#![allow(clippy::float_arithmetic, reason = "estimates: no result depends on how they are rounded")]

use super::Sampler;
use super::direction::{CubeDirection, constant, reaches_limit};
use super::planes::Plane;
use super::quotient::{Line, SLACK, larger};
use super::setup::{BatchSetup, PixelBatch, Planes, Setup};
use super::short::Losses;
use crate::raster::interpolate::COORDINATE_LIMIT;
use crate::texture::coordinates::Coordinates;
use crate::texture::cube::{Face, Signed};

/// Bound of coordinates in 1/256 texel, so that their multiples are exact in double precision.
const MAX_COORDINATE: f64 = (1_u64 << 36) as f64;

/// Largest error of an estimated coordinate that is accepted, in its own steps.
const COARSEST: f64 = 0.125;

/// Half a step of the coordinates of quads.
const HALF_STEP: f64 = 0.5;

/// Coordinates of level 0 around a batch, as two quotients.
pub(super) struct BaseLevel<'p> {
    pub(super) along: Line,
    pub(super) down: Line,
    pub(super) denominator: Line,
    /// The least denominator of a quad's pixel, and how many columns and rows lie between a quad and the first pixel at most.
    pub(super) lowest: f64,
    pub(super) reach: [f64; 2],
    /// What was added to u and v because they are [constant](super::planes::up), 1/65536 texel.
    pub(super) up: [f64; 2],
    /// Upper bound of the error of an estimate, 1/256 texel.
    pub(super) off: f64,
    /// Upper bound of the change of a smaller level's coordinates by the floors of its numerators (INT-4).
    pub(super) floors: f64,
    pub(super) face: Face,
    /// Whether all of the batch lies behind the viewer, where no level of detail is known.
    pub(super) behind: bool,
    /// Whether the denominator is D.
    pub(super) by_d: bool,
    /// Planes whose exact remainders decide what estimates do not prove.
    pub(super) planes: Option<&'p [Plane; 2]>,
    /// Losses of the three functions where weights fall short (TEX-15, INT-4t).
    pub(super) losses: Option<[Losses; 3]>,
    /// For planes: the numbers of which all values of u and of v are multiples, and the powers of two that divide the G_k.
    pub(super) gaps: [(f64, u32); 2],
    /// How fast the coordinates change, if that is set up.
    pub(super) slopes: Option<Slopes>,
}

impl Default for BaseLevel<'_> {
    fn default() -> Self {
        BaseLevel {
            along: Line::default(),
            down: Line::default(),
            denominator: Line::default(),
            lowest: 0.0,
            reach: [0.0; 2],
            up: [0.0; 2],
            off: 0.0,
            floors: 0.0,
            face: Face::PositiveX,
            behind: false,
            by_d: false,
            planes: None,
            losses: None,
            gaps: [(0.0, 0); 2],
            slopes: None,
        }
    }
}

impl BaseLevel<'_> {
    /// Returns whether anything is proved, with coordinates in such a `range` and the least D. Without branches, so that compilers set up several
    /// batches at once.
    #[inline(always)]
    pub(super) fn proves(&self, range: f64, least: f64) -> bool {
        // NaN proves nothing either.
        (least > 0.0)
            & (self.lowest > 0.0)
            & (range < MAX_COORDINATE)
            & (self.off < COARSEST / 256.0)
            & (self.floors < COARSEST)
    }
}

/// Returns the least value of a function at the pixels of quads, none of which lies further to the left of the first pixel, or more than one row above
/// it.
#[inline(always)]
pub(super) fn least_around(line: Line, left: f64, [columns, rows]: [f64; 2]) -> f64 {
    line.c - falls(line.x, left, columns) - falls(line.y, 1.0, rows)
}

/// Returns how far a function falls at most, so many steps back and ahead.
#[inline(always)]
fn falls(slope: f64, back: f64, ahead: f64) -> f64 {
    if slope > 0.0 { slope * back } else { -slope * ahead }
}

/// Returns what is added to a coordinate on planes for what is added to [others](super::planes::up), 1/65536 texel.
#[inline(always)]
pub(super) fn up_of_quads(up: f64) -> f64 {
    // Also between two steps of the coordinates of quads.
    if up > 0.0 { 256.0 * up + HALF_STEP } else { 0.0 }
}

/// Returns upper bounds for coordinates on planes around a batch, which are divided by D: of their magnitudes, with those of all terms, and of their
/// changes by the floors of numerators (INT-4). Takes the least D and its terms, the terms of u and v, bounds of their magnitudes at the vertices, and
/// the least P_k.
#[inline(always)]
pub(super) fn bounds_on_planes((lowest, of_d): (f64, f64), terms: [f64; 2], reach: [f64; 2], least: f64) -> (f64, f64) {
    let widest = 1.0 / lowest;
    let ratio = of_d * widest;
    // Outside of the triangle, numbers can be larger than at the vertices.
    let most = [terms[0] * widest + 2.0 * reach[0] * ratio, terms[1] * widest + 2.0 * reach[1] * ratio];
    // The magnitudes of weights add up to `ratio` at most.
    (larger(most[0], most[1]) * (1.0 + ratio), 1.25 * ratio / least)
}

/// How fast u and v change from pixel to pixel. The difference of two quotients of linear functions is a linear function of one
/// coordinate, divided by both denominators. A level of detail is proved unless the floors of the coordinates could change it.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Slopes {
    /// The changes of the denominator to the right and below. It is 1 at the first pixel.
    pub(super) denominator: [f32; 2],
    /// Numerators of the differences of u and v to the pixel on the right, at row 0, and to the one below, at column 0; 1/65536 texel.
    pub(super) right: [f32; 2],
    pub(super) below: [f32; 2],
    /// What a row adds to the former, and a column takes off the latter.
    pub(super) cross: [f32; 2],
    /// Bounds of the error in 256ths of a level: of any quad, and of a quad whose pixels are 1/65536 texel apart.
    pub(super) margins: [f32; 2],
}

impl Setup<'_> {
    /// Returns the coordinates of level 0 around a batch, or `None` if nothing would be proved.
    #[inline(always)]
    pub(super) fn base_level<'p, const FMA: bool>(
        &self,
        batch: PixelBatch<'_>,
        (sampler, planes): (&Sampler, &'p Planes),
        local: &BatchSetup,
    ) -> Option<BaseLevel<'p>> {
        // Pixels of a quad lie at most one pixel outside of the batch.
        let (columns, rows) = (local.columns + 1.0, local.rows + 1.0);
        // No pixel lies further to the left of a row's first pixel, or above that of a box.
        let left = if batch.is_row() { 1.0 } else { columns };
        let least = |line: Line| least_around(line, left, [columns, rows]);
        let (lowest, reach) = (least(local.denominator), [columns, rows]);
        // Quotients by another line than D.
        let divided = |[along, down]: [Line; 2], denominator: Line, off: f64, face: Face| BaseLevel {
            along,
            down,
            denominator,
            lowest: least(denominator),
            reach,
            off,
            face,
            ..BaseLevel::default()
        };
        let (base, range) = match planes {
            Planes::Plane(planes) if !self.stays_near(&batch, planes, local) => return None,
            Planes::Plane(planes) => {
                let [u, v] = [&planes[0].real, &planes[1].real];
                let of_d = self.denominator.real.terms(&local.real, columns, rows);
                let terms = [u.terms(&local.real, columns, rows), v.terms(&local.real, columns, rows)];
                let p = &self.context.triangle.p;
                let losses = self.context.triangle.loses_on_planes().then(|| self.losses_on_planes(planes));
                let up = if losses.is_none() { sampler.up.map(up_of_quads) } else { [0.0; 2] };
                let least = p[0].min(p[1]).min(p[2]) as f64;
                let reaches = [u.reach, v.reach];
                let (range, floors) = bounds_on_planes((lowest, of_d), terms, reaches, least);
                let line = |n: usize| planes[n].real.line(&local.real).plus(local.denominator.times(up[n] / 256.0));
                let base = BaseLevel {
                    along: line(0),
                    down: line(1),
                    denominator: local.denominator,
                    lowest,
                    reach,
                    up,
                    off: range * SLACK,
                    floors,
                    by_d: true,
                    planes: Some(planes),
                    losses,
                    gaps: [planes[0].gap(&self.context.triangle), planes[1].gap(&self.context.triangle)],
                    ..BaseLevel::default()
                };
                (base, range)
            }
            Planes::Ratio(_, reach) if reach.is_finite() && reaches_limit(*reach, sampler.sides) => return None,
            Planes::Ratio(planes, reach) => {
                let direction = CubeDirection::around(planes, &local.real, columns, rows);
                // Where q changes its sign, it has one in most batches.
                let sign = if reach.is_infinite() && direction.lines[2].c < 0.0 { -1.0 } else { 1.0 };
                let [s, t, q] = direction.lines.map(|line| line.times(sign));
                let sides = sampler.sides.map(|side| 256.0 * f64::from(side));
                let most = if sides[0] > sides[1] { sides[0] } else { sides[1] };
                let (off, range) = direction.off(1.0 / least(q), most);
                if reach.is_infinite() && range >= COORDINATE_LIMIT as f64 {
                    return None;
                }
                let lines = [s.times(sides[0]), t.times(sides[1])];
                // The signs of all three were changed if q was negative.
                let behind = match self.context.coordinates_of(sampler.unit) {
                    Some(Coordinates::Ratio(g)) if reach.is_finite() => g[2][0] < 0,
                    _ => sign < 0.0,
                };
                let losses = (!self.context.triangle.exact_reciprocal)
                    .then(|| self.losses_by_q(planes, sides).map(|of| of.map(|loss| loss * sign)));
                (BaseLevel { behind, losses, ..divided(lines, q, off, Face::PositiveX) }, range)
            }
            Planes::Direction(planes, face) => {
                let direction = CubeDirection::around(planes, &local.real, columns, rows);
                let face = match face {
                    Some(face) => *face,
                    None => direction.look::<FMA>(0.0)?,
                };
                let [s, t, major] = face.components();
                let m = direction.component(major);
                // The first pixel of a quad could meet another face.
                let (odd_column, odd_row) = ((batch.first.0 & 1) as f64, (batch.first.1 & 1) as f64);
                let meets =
                    |line: Line| line.c - falls(line.x, odd_column, local.columns) - falls(line.y, odd_row, 0.0);
                if !(if batch.is_row() { direction.stays(face, meets) } else { direction.stays(face, least) }) {
                    return None;
                }
                let size = 128.0 * f64::from(sampler.sides[0]);
                let (off, range) = direction.off(1.0 / least(m), size);
                let line = |of: Signed| match constant(planes, of, major, sampler.sides[0]) {
                    Some(floor) => m.times(floor + (128.0 + HALF_STEP) / 256.0),
                    None => direction.component(of).plus(m).times(size),
                };
                let lines = [line(s), line(t)];
                (divided(lines, m, off, face), range)
            }
            Planes::Other | Planes::Shared => return None,
        };
        base.proves(range, lowest).then_some(base)
    }
}

/// Returns what is added to estimates whose error is less than `off`, and the distance from an integer below which they prove nothing. If
/// all values are multiples of a sufficiently wide `gap`, the addition separates integers from the values below them, and everything is
/// proved.
#[inline(always)]
pub(super) fn parted(gap: f64, off: f64) -> (f64, f64) {
    if gap >= 4.0 * off { (off, -1.0) } else { (0.0, off) }
}
