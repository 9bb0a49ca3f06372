//! TEX-9 to TEX-11 on rows: the lod of each pixel, and where it is read on which levels.
#![allow(clippy::float_arithmetic, reason = "estimates: no result depends on how they are rounded")]

use super::Sampler;
use super::fetch::Numbers;
use super::kernels::LANES;
use super::planes::{Plane, inverse};
use super::quotient::{Line, Positions, SLACK, Scaled, estimate_two, settle};
use super::table::Table;
use super::triangle::{Bounds, Piece, Planes, Setup};
use crate::state::Filter;
use crate::texture::lod;
use crate::texture::place::Place;
use crate::texture::unit::PlannedUnit;

/// What the lanes of a block read of a texture whose levels count.
#[derive(Clone, Debug)]
pub(super) struct Reads {
    /// Entries of the table: of the nearer level, and of the next one.
    pub(super) entries: [Numbers<u32>; 2],
    /// u and v there, of which the fraction of a texel counts.
    pub(super) coordinates: [[Numbers<i32>; 2]; 2],
    /// Weight of the next level, 0..=255.
    pub(super) weights: Numbers<i32>,
}

impl Default for Reads {
    fn default() -> Self {
        Reads { entries: [[0; LANES]; 2], coordinates: [[[0; LANES]; 2]; 2], weights: [0; LANES] }
    }
}

/// What lods are computed in.
#[derive(Clone, Debug)]
pub(super) struct Quads {
    /// Where the upper left pixels of the quads lie, from the piece's first.
    at: [Numbers<i32>; 2],
    /// u and v of the three pixels of the quad.
    coordinates: [[Numbers<i32>; 2]; 3],
    spare: Numbers<i32>,
    lods: Numbers<i32>,
    /// 1: nothing is known of the lane.
    open: Numbers<i32>,
    levels: [Numbers<i32>; 2],
}

impl Default for Quads {
    fn default() -> Self {
        let zeros = [0; LANES];
        Quads {
            at: [zeros; 2],
            coordinates: [[zeros; 2]; 3],
            spare: zeros,
            lods: zeros,
            open: zeros,
            levels: [zeros; 2],
        }
    }
}

/// Coordinates of a quad that are further apart than this have their lod from the definition, 1/65536 texel.
const FARTHEST: i32 = 1 << 26;

/// Coordinates, 1/256 texel, of which 256 times as much and what quads add to it is a number of 32 bits.
const MOST: f64 = (1 << 22) as f64;

/// Mantissas closer to 2 than this are too close to call: seven squarings multiply roundings by 128.
const CLOSE: f64 = 1.0 / (1_u64 << 40) as f64;

impl Setup<'_> {
    /// Everything that a unit whose levels count reads in a piece.
    #[inline(always)]
    #[allow(clippy::too_many_arguments, reason = "what the caller has computed, and each result apart")]
    pub(super) fn levels<const FMA: bool, const ROW: bool>(
        &self,
        piece: Piece<'_>,
        (sampler, planes): (&Sampler, &Planes),
        e: &[i64; 3],
        (real, denominator): (&[f64; 3], Line),
        bounds: &Bounds,
        quads: &mut Quads,
        reads: &mut Reads,
    ) {
        let Some(table) = &sampler.table else { return };
        let unit = &self.context.draw.units[sampler.index];
        let known = match planes {
            Planes::Plane(planes) => {
                self.quads::<FMA, ROW>(piece, planes, e, (real, denominator), bounds, quads).then_some(planes)
            }
            _ => None,
        };
        let Some(planes) = known else {
            for n in 0..piece.count {
                self.defined_reads(piece, n, sampler, table, reads);
            }
            return;
        };
        let lanes = piece.at.x.len();
        let close = lods(&quads.coordinates, lanes, &mut quads.lods, &mut quads.open);
        let [low, high] = choose(unit, lanes, &mut quads.lods, &mut quads.levels, &mut reads.weights[piece.lanes()]);
        for level in low..=high {
            let planes = self.planes_of(unit, planes, level as usize);
            let ([u, v, entries], whole) = (&mut quads.coordinates, &mut quads.spare);
            let (u, v) = (&mut u[0][..lanes], &mut v[0][..lanes]);
            self.on_planes::<FMA, ROW>(piece, &planes, 0, e, (real, denominator), bounds, u, v, whole);
            let entries = &mut entries[0][..lanes];
            for n in 0..lanes {
                let filter = if quads.lods[n] <= 0 { unit.state.mag_filter } else { unit.state.min_filter };
                let (entry, at) = table.place(level as usize, [u[n], v[n]], filter == Filter::Linear);
                (entries[n], u[n], v[n]) = (entry as i32, at[0], at[1]);
            }
            for which in 0..2 {
                put(level, &quads.levels[which][..lanes], [entries, u, v], piece.lane, which, reads);
            }
        }
        if close {
            for n in (0..piece.count).filter(|n| quads.open[*n] != 0) {
                self.defined_reads(piece, n, sampler, table, reads);
            }
        }
    }

    /// The planes of a level.
    #[inline(always)]
    fn planes_of(&self, unit: &PlannedUnit, planes: &[Plane; 2], level: usize) -> [Plane; 2] {
        let triangle = &self.context.triangle;
        let [s, t] = unit.plane_shifts(&unit.levels[level]);
        let (inverse, [u, v]) = (inverse(triangle), [planes[0].g, planes[1].g]);
        // Neither closures nor `map`: they are not always inlined, and what is not inlined lacks the caller's instruction set.
        [
            Plane::new(triangle, &inverse, [u[0] >> s, u[1] >> s, u[2] >> s]),
            Plane::new(triangle, &inverse, [v[0] >> t, v[1] >> t, v[2] >> t]),
        ]
    }

    /// TEX-11: u and v at the three pixels of each quad, 1/65536 texel of level 0. `false`: nothing would be proved.
    #[inline(always)]
    fn quads<const FMA: bool, const ROW: bool>(
        &self,
        piece: Piece<'_>,
        planes: &[Plane; 2],
        e: &[i64; 3],
        (real, denominator): (&[f64; 3], Line),
        bounds: &Bounds,
        quads: &mut Quads,
    ) -> bool {
        // Pixels of a quad lie up to one outside of the piece.
        let (columns, rows) = (bounds.columns + 1.0, bounds.rows + 1.0);
        let terms = self.denominator.terms(real, columns, rows);
        // None of them lies further to the left of a row's first pixel, or above a piece's.
        let left = if ROW { 1.0 } else { columns };
        let falls = |slope: f64, back: f64, ahead: f64| if slope > 0.0 { slope * back } else { -slope * ahead };
        let least = denominator.c - falls(denominator.x, left, columns) - falls(denominator.y, 1.0, rows);
        let widest = 1.0 / least;
        let ratio = terms * widest;
        let fits = |plane: &Plane| plane.reach < MOST;
        let proves = least > 0.0 && ratio < 65536.0 && fits(&planes[0]) && fits(&planes[1]);
        if !proves {
            return false;
        }
        // What is left may be outside of the triangle, and larger there than at the vertices.
        let margin = |plane: &Plane| {
            let left = plane.terms(real, columns, rows) * widest + 2.0 * plane.reach * ratio;
            256.0 * left * (1.0 + ratio) * SLACK
        };
        let (extent, reciprocals) = ((columns, rows), (1.0 / denominator.c, widest));
        let scaled = |plane: &Plane| {
            let line = plane.line(real).times(256.0);
            Scaled::new::<false>(line, denominator, extent, reciprocals, margin(plane), 0)
        };
        let (Some(along), Some(down)) = (scaled(&planes[0]), scaled(&planes[1])) else { return false };
        let lanes = piece.at.x.len();
        let Quads { at: [columns, rows], coordinates, spare, .. } = quads;
        let (columns, rows, whole) = (&mut columns[..lanes], &mut rows[..lanes], &mut spare[..lanes]);
        let odd = (piece.first.0 as i32, piece.first.1 as i32);
        for n in 0..lanes {
            let (x, y) = (piece.at.x[n].min(piece.at.last), piece.at.y[n]);
            (columns[n], rows[n]) = (x - ((odd.0 + x) & 1), y - ((odd.1 + y) & 1));
        }
        for (pixel, [u, v]) in coordinates.iter_mut().enumerate() {
            match pixel {
                0 => {}
                1 => columns.iter_mut().for_each(|x| *x += 1),
                _ => columns.iter_mut().zip(&mut *rows).for_each(|(x, y)| (*x, *y) = (*x - 1, *y + 1)),
            }
            let at = Positions { x: columns, y: rows, last: i32::MAX };
            let (u, v) = (&mut u[..lanes], &mut v[..lanes]);
            let close = estimate_two::<FMA, false>(at, denominator, &[along, down], u, v);
            for (plane, close, values) in [(&planes[0], close[0], u), (&planes[1], close[1], v)] {
                if close {
                    settle::<false>(at, plane.exact(e).times(256), self.denominator.exact(e), None, values, whole);
                }
            }
        }
        true
    }

    /// What a lane reads, by the definition.
    #[inline(never)]
    pub(super) fn defined_reads(
        &self,
        piece: Piece<'_>,
        n: usize,
        sampler: &Sampler,
        table: &Table,
        reads: &mut Reads,
    ) {
        let unit = &self.context.draw.units[sampler.index];
        let (sample, lane) = (self.sample(piece, n), piece.lane + n);
        let Some(place) = self.context.place(unit, &sample, piece.pixel(n)) else { return };
        let lod = lod::biased(unit, lod::log2_ratio(place.quad()));
        let (level, next, weight) = lod::levels(unit, lod.max(0));
        let filter = if lod <= 0 { unit.state.mag_filter } else { unit.state.min_filter };
        for (k, level) in [level as usize, next as usize].into_iter().enumerate() {
            let at = place.on(&unit.levels[level]).map(|c| c.value as i32);
            let (entry, [u, v]) = table.place(level, at, filter == Filter::Linear);
            reads.entries[k][lane] = entry + table.face * place.face() as u32;
            (reads.coordinates[k][0][lane], reads.coordinates[k][1][lane]) = (u, v);
        }
        reads.weights[lane] = weight;
    }
}

/// TEX-11, TEX-10 of the three pixels of quads. Says whether some lane is open.
#[inline(always)]
fn lods(at: &[[Numbers<i32>; 2]; 3], lanes: usize, lods: &mut Numbers<i32>, open: &mut Numbers<i32>) -> bool {
    let [[u, v], [right_u, right_v], [lower_u, lower_v]] = at;
    let (lods, open) = (&mut lods[..lanes], &mut open[..lanes]);
    let mut any = 0;
    for n in 0..lanes {
        let moved = [right_u[n] - u[n], right_v[n] - v[n], lower_u[n] - u[n], lower_v[n] - v[n]];
        let far = |d: i32| i32::from(d.wrapping_add(FARTHEST) as u32 >= 2 * FARTHEST as u32);
        let mut unknown = far(moved[0]) | far(moved[1]) | far(moved[2]) | far(moved[3]);
        let [a, b, c, d] = [f64::from(moved[0]), f64::from(moved[1]), f64::from(moved[2]), f64::from(moved[3])];
        // Whole numbers below 2^53.
        let (right, lower) = (a * a + b * b, c * c + d * d);
        let largest = if right > lower { right } else { lower };
        let bits = largest.to_bits();
        let mut mantissa = f64::from_bits(bits & ((1 << 52) - 1) | 1.0_f64.to_bits());
        let mut log = (bits >> 52) as i32 - 1023;
        for _ in 0..7 {
            let square = mantissa * mantissa;
            unknown |= i32::from((square - 2.0).abs() < CLOSE);
            let large = square >= 2.0;
            mantissa = if large { square * 0.5 } else { square };
            log = 2 * log + i32::from(large);
        }
        lods[n] = if largest > 0.0 { log - 128 * 32 } else { lod::LEAST };
        open[n] = unknown;
        any |= unknown;
    }
    any != 0
}

/// TEX-9: levels and weight of each lane; `lods` become biased. The least level that is read, and the largest.
#[inline(always)]
fn choose(
    unit: &PlannedUnit,
    lanes: usize,
    lods: &mut Numbers<i32>,
    [levels, nexts]: &mut [Numbers<i32>; 2],
    weights: &mut [i32],
) -> [i32; 2] {
    let (mut low, mut high) = (i32::MAX, 0);
    let (lods, levels, nexts) = (&mut lods[..lanes], &mut levels[..lanes], &mut nexts[..lanes]);
    for n in 0..lanes {
        let lod = lod::biased(unit, lods[n]);
        let (level, next, weight) = lod::levels(unit, lod.max(0));
        (lods[n], levels[n], nexts[n], weights[n]) = (lod, level, next, weight);
        low = low.min(level);
        high = high.max(next);
    }
    [low, high]
}

/// What is read of a level, by the lanes that read it.
#[inline(always)]
fn put(level: i32, levels: &[i32], [from, from_u, from_v]: [&[i32]; 3], first: usize, which: usize, reads: &mut Reads) {
    let entries = &mut reads.entries[which][first..][..levels.len()];
    let [u, v] = &mut reads.coordinates[which];
    let (u, v) = (&mut u[first..][..levels.len()], &mut v[first..][..levels.len()]);
    for n in 0..levels.len() {
        let reads = levels[n] == level;
        entries[n] = if reads { from[n] as u32 } else { entries[n] };
        u[n] = if reads { from_u[n] } else { u[n] };
        v[n] = if reads { from_v[n] } else { v[n] };
    }
}
