//! TEX-9 to TEX-11 on rows: the level of detail of each pixel, and the entries on its levels.
#![allow(clippy::float_arithmetic, reason = "estimates: no result depends on how they are rounded")]

use super::kernels::LANES;
use super::kernels::PerLane;
use super::planes::Plane;
use super::quads::{Known, Quads, floor, parted};
use super::quotient::{IOTA_REAL, Line, Positions, nearest, position, whole};
use super::setup::{BatchSetup, PixelBatch, Planes, Setup};
use super::short::Short;
use super::table::{Placed, Table};
use super::{Reason, Sampler};
use crate::state::Filter;
use crate::texture::coordinates::SampleCoordinates;
use crate::texture::lod;
use crate::texture::planned::PlannedUnit;

/// Fetches of a block from a texture with levels.
#[derive(Clone, Debug)]
pub(super) struct MipFetches {
    /// Table entries on the nearer level, and on the next one.
    pub(super) entries: [PerLane<i32>; 2],
    /// u and v on those levels, of which only the fraction of a texel is used.
    pub(super) coordinates: [[PerLane<i32>; 2]; 2],
    /// Weight of the next level, 0..=255.
    pub(super) weights: PerLane<u16>,
    /// Levels of detail of the quads.
    pub(super) known: Known<i32>,
}

impl Default for MipFetches {
    fn default() -> Self {
        MipFetches {
            entries: [[0; LANES]; 2],
            coordinates: [[[0; LANES]; 2]; 2],
            weights: [0; LANES],
            known: Known::default(),
        }
    }
}

/// Scratch space for placing lanes on levels.
#[derive(Clone, Debug)]
pub(super) struct Placing {
    /// u and v on level 0 in 1/256 texel, with fractions, if something is taken off them.
    at: [PerLane<f64>; 2],
    /// Their floors.
    floors: [PerLane<i32>; 2],
    lods: PerLane<i32>,
    levels: [PerLane<i32>; 2],
    /// Sign bits of lanes whose floors are not proved on some level.
    close: PerLane<i32>,
}

impl Default for Placing {
    fn default() -> Self {
        Placing {
            at: [[0.0; LANES]; 2],
            floors: [[0; LANES]; 2],
            lods: [0; LANES],
            levels: [[0; LANES]; 2],
            close: [0; LANES],
        }
    }
}

impl Setup<'_> {
    /// Returns whether the coordinates on all levels that a sampler reads are those of level 0, shifted.
    pub(super) fn shift_with(&self, sampler: &Sampler, planes: &[Plane; 2]) -> bool {
        let unit = &self.context.draw.units[sampler.index];
        let shifts = unit.levels.last().map_or([0; 2], |smallest| unit.plane_shifts(smallest));
        planes[0].shifts_by(shifts[0]) && planes[1].shifts_by(shifts[1])
    }

    /// Computes all fetches of a batch for a unit with levels. `floors` are the coordinates on level 0, if they are known and
    /// [shifted](Self::shift_with).
    #[inline(always)]
    #[allow(clippy::too_many_arguments, reason = "what the caller has computed")]
    pub(super) fn levels<const FMA: bool, const ROW: bool>(
        &self,
        batch: PixelBatch<'_>,
        (sampler, planes): (&Sampler, &Planes),
        floors: Option<[&[i32]; 2]>,
        local: &BatchSetup,
        short: &Short,
        (quads, placing): (&mut Quads, &mut Placing),
        reads: &mut MipFetches,
    ) {
        let Some(table) = &sampler.table else { return };
        let unit = &self.context.draw.units[sampler.index];
        let Some(base) = self.base_level::<FMA, ROW>(sampler, planes, local) else {
            for n in 0..batch.count {
                self.defined_reads(batch, n, sampler, table, reads);
            }
            return;
        };
        let lanes = batch.at.x.len();
        let spread = self.of_quads::<FMA, ROW, i32>(batch, (unit, &base), &local.e, quads, &mut reads.known);
        let Placing { at, floors: [u, v], lods, levels, close } = placing;
        spread.hand_out(quads, &reads.known.each, batch.count, &mut lods[..lanes]);
        let ranges = choose(unit, lanes, lods, levels, &mut reads.weights[batch.lanes()]);
        let shifts = |level: i32| unit.plane_shifts(&unit.levels[level as usize]);
        let (u, v, close) = (&mut u[..lanes], &mut v[..lanes], &mut close[..lanes]);
        if floors.is_none() {
            let settled = [0, 1].map(|axis| {
                let (gap, shared) = base.gaps[axis];
                // In steps of level 0, because a coordinate that is whole on a smaller level is whole there.
                let floors =
                    (ranges[0][0]..=ranges[1][1]).map(|level| shifts(level)[axis]).filter(|shift| *shift > shared);
                parted(gap, base.off + floors.max().map_or(0.0, |shift| base.floors * f64::from(1 << shift)))
            });
            let lines = [base.along, base.down, base.denominator];
            match base.losses {
                Some(losses) => {
                    let [at_u, at_v] = at;
                    short.dominance.divide::<FMA, ROW>(batch.at, lines, losses, 0.0, [&mut *at_u, &mut *at_v]);
                    settle(&at_u[..lanes], &at_v[..lanes], settled, u, v, close);
                }
                None => quotients::<FMA, ROW>(batch.at, lines, settled, u, v, close),
            }
        }
        let any_close = floors.is_none() && close.iter().fold(0, |all, close| all | close) < 0;
        let [u, v] = floors.unwrap_or([u, v]);
        let filters = [Taken::by(unit.state.mag_filter), Taken::by(unit.state.min_filter)];
        for (which, [low, high]) in ranges.into_iter().enumerate() {
            let ([to_u, to_v], entries) = (&mut reads.coordinates[which], &mut reads.entries[which]);
            let (to_u, to_v) = (&mut to_u[batch.lanes()], &mut to_v[batch.lanes()]);
            let entries = &mut entries[batch.lanes()];
            for level in low..=high {
                let (placed, shifts) = (table.placed(level as usize, base.face as u32), shifts(level));
                if level == low {
                    places::<true>(&placed, filters, shifts, (&lods[..lanes], &[]), level, u, v, to_u, to_v, entries);
                } else {
                    let of = (&lods[..lanes], &levels[which][..lanes]);
                    places::<false>(&placed, filters, shifts, of, level, u, v, to_u, to_v, entries);
                }
            }
        }
        let count = if any_close { batch.count } else { 0 };
        for n in (0..count).filter(|n| placing.close[*n] < 0) {
            let Some(planes) = base.planes else {
                self.defined_reads(batch, n, sampler, table, reads);
                continue;
            };
            for which in 0..2 {
                let level = placing.levels[which][n];
                let on_axis = |axis: usize| {
                    let shift = shifts(level)[axis];
                    self.corrected(batch, n, &planes[axis].g.map(|g| g >> shift), placing.floors[axis][n] >> shift)
                };
                let placed = table.placed(level as usize, base.face as u32);
                reads.place(which, batch.lane + n, &placed, filters, placing.lods[n], [on_axis(0), on_axis(1)]);
            }
        }
    }

    /// Returns the floor by INT-4 and INT-4t of a coordinate whose estimate is less than one off.
    fn corrected(&self, batch: PixelBatch<'_>, n: usize, g: &[i64; 3], value: i32) -> i32 {
        let sample = self.sample(batch, n.min(batch.count - 1));
        if sample.triangle.loses_on_planes() {
            return sample.coordinate(g).value as i32;
        }
        let top = (0..3).fold(0_i64, |top, k| top.wrapping_add(g[k].wrapping_mul(sample.e[k])));
        let (floor, exact) = floor(top, sample.d, i64::from(value));
        floor as i32 - i32::from(sample.lowers_tie(exact, || sample.shortfall(g)))
    }

    /// Computes the fetches of a lane by the definition.
    #[inline(never)]
    pub(super) fn defined_reads(
        &self,
        batch: PixelBatch<'_>,
        n: usize,
        sampler: &Sampler,
        table: &Table,
        reads: &mut MipFetches,
    ) {
        let unit = &self.context.draw.units[sampler.index];
        self.count_defined(Reason::Levels, 1);
        let (sample, lane) = (self.sample(batch, n), batch.lane + n);
        let Some(place) = self.context.sample_coordinates(unit, &sample, batch.pixel(n)) else { return };
        let lod = lod::biased(unit, lod::log2_ratio(place.quad()));
        let (level, next, weight) = lod::levels(unit, lod.max(0));
        let filters = [Taken::by(unit.state.mag_filter), Taken::by(unit.state.min_filter)];
        for (which, level) in [level as usize, next as usize].into_iter().enumerate() {
            let at = place.on(&unit.levels[level]).map(|c| c.value as i32);
            reads.place(which, lane, &table.placed(level, place.face() as u32), filters, lod, at);
        }
        reads.weights[lane] = weight as u16;
    }
}

impl MipFetches {
    /// Places a lane on a level, the nearer or the next one, at the coordinates that it has there.
    fn place(&mut self, which: usize, lane: usize, placed: &Placed, filters: [Taken; 2], lod: i32, [u, v]: [i32; 2]) {
        let ([to_u, to_v], entries) = (&mut self.coordinates[which], &mut self.entries[which]);
        let (to_u, to_v, entries) = (&mut to_u[lane..=lane], &mut to_v[lane..=lane], &mut entries[lane..=lane]);
        places::<true>(placed, filters, [0; 2], (&[lod], &[]), 0, &[u], &[v], to_u, to_v, entries);
    }
}

/// Computes the floors of two quotients on level 0. Sets the sign bits of lanes where one is so close to an integer that its floor is not
/// proved, on that level or on smaller ones.
#[inline(always)]
fn quotients<const FMA: bool, const ROW: bool>(
    at: Positions<'_>,
    [along, down, denominator]: [Line; 3],
    settled: [(f64, f64); 2],
    u: &mut [i32],
    v: &mut [i32],
    close: &mut [i32],
) {
    let lanes = u.len();
    let last = f64::from(at.last);
    let (v, close, xs, ys) = (&mut v[..lanes], &mut close[..lanes], &at.x[..lanes], &at.y[..lanes]);
    let iota = &IOTA_REAL[..lanes];
    for n in 0..lanes {
        let (x, y) = position::<ROW>(n, last, xs, ys, iota);
        let r = 1.0 / denominator.at::<FMA, ROW>(x, y);
        let (p, q) = (along.at::<FMA, ROW>(x, y) * r, down.at::<FMA, ROW>(x, y) * r);
        let ((p, close_p), (q, close_q)) = (floor_and_proof(p, settled[0]), floor_and_proof(q, settled[1]));
        (u[n], v[n], close[n]) = (p, q, close_p | close_q);
    }
}

/// Computes what [`quotients`] does from the quotients.
#[inline(always)]
fn settle(at_u: &[f64], at_v: &[f64], settled: [(f64, f64); 2], u: &mut [i32], v: &mut [i32], close: &mut [i32]) {
    let lanes = u.len();
    let (at_u, at_v, v, close) = (&at_u[..lanes], &at_v[..lanes], &mut v[..lanes], &mut close[..lanes]);
    for n in 0..lanes {
        let ((p, close_p), (q, close_q)) = (floor_and_proof(at_u[n], settled[0]), floor_and_proof(at_v[n], settled[1]));
        (u[n], v[n], close[n]) = (p, q, close_p | close_q);
    }
}

/// Returns the floor of a number to which `up` is added, and a number whose sign bit is set if it is closer to an integer than `off`.
#[inline(always)]
fn floor_and_proof(at: f64, (up, off): (f64, f64)) -> (i32, i32) {
    let at = at + up;
    let close = ((at - whole(at)).abs() - off).to_bits() >> 32;
    (nearest(at - 0.5), close as i32)
}

/// TEX-9: computes the levels and the weight of each lane. `lods` become biased. Returns the least and the largest first level, and the
/// least and the largest second level.
#[inline(always)]
fn choose(
    unit: &PlannedUnit,
    lanes: usize,
    lods: &mut PerLane<i32>,
    [levels, nexts]: &mut [PerLane<i32>; 2],
    weights: &mut [u16],
) -> [[i32; 2]; 2] {
    let selection = lod::Selection::from_unit(unit);
    let (lods, weights) = (&mut lods[..lanes], &mut weights[..lanes]);
    let (levels, nexts) = (&mut levels[..lanes], &mut nexts[..lanes]);
    let mut ends = [i32::MAX, i32::MIN];
    for n in 0..lanes {
        let lod = selection.biased(lods[n]);
        let (level, next, weight) = selection.levels(lod.max(0));
        (lods[n], levels[n], nexts[n], weights[n]) = (lod, level, next, weight as u16);
        ends = [ends[0].min(lod), ends[1].max(lod)];
    }
    // The levels never decrease with the level of detail.
    let [(low, next_low, _), (high, next_high, _)] = ends.map(|lod| selection.levels(lod.max(0)));
    [[low, high], [next_low, next_high]]
}

/// How a filter changes a coordinate: what it subtracts, and the mask of the bits that it keeps.
#[derive(Clone, Copy)]
struct Taken {
    less: i32,
    kept: i32,
}

impl Taken {
    fn by(filter: Filter) -> Taken {
        match filter {
            Filter::Linear => Taken { less: 128, kept: -1 },
            // Without a fraction, so that nothing is mixed.
            Filter::Nearest => Taken { less: 0, kept: !255 },
        }
    }
}

/// Computes the entry of each lane on a level, for the magnification or the minification filter: that of the texel, or of the upper left
/// texel of the footprint; and the coordinates for the weights. Without `ALL`, lanes of other levels keep what they have.
#[inline(always)]
#[allow(clippy::too_many_arguments, reason = "each result apart, so that the compiler sees that none overlaps another")]
fn places<const ALL: bool>(
    placed: &Placed,
    [mag, min]: [Taken; 2],
    [shift_u, shift_v]: [u32; 2],
    (lods, levels): (&[i32], &[i32]),
    level: i32,
    u: &[i32],
    v: &[i32],
    to_u: &mut [i32],
    to_v: &mut [i32],
    entries: &mut [i32],
) {
    let Placed { axes: [columns, rows], first, pitch } = *placed;
    let lanes = lods.len();
    let (u, v, levels) = (&u[..lanes], &v[..lanes], &levels[..if ALL { 0 } else { lanes }]);
    let (to_u, to_v, entries) = (&mut to_u[..lanes], &mut to_v[..lanes], &mut entries[..lanes]);
    let periodic = columns.period.is_some() || rows.period.is_some();
    // By bits, because compilers turn a choice into masked loads and stores, which are slow.
    let put = |to: &mut i32, from: i32, n: usize| {
        *to = if ALL { from } else { *to ^ ((*to ^ from) & -i32::from(levels[n] == level)) };
    };
    for n in 0..lanes {
        let less = if lods[n] <= 0 { mag.less } else { min.less };
        let kept = if lods[n] <= 0 { mag.kept } else { min.kept };
        let u = ((u[n] >> shift_u).wrapping_sub(less) & kept).max(columns.low).min(columns.high);
        let v = ((v[n] >> shift_v).wrapping_sub(less) & kept).max(rows.low).min(rows.high);
        let entry = rows.entry(v).wrapping_mul(pitch).wrapping_add(columns.entry(u)).wrapping_add(first);
        put(&mut to_u[n], u, n);
        put(&mut to_v[n], v, n);
        put(&mut entries[n], entry, n);
    }
    if periodic {
        for n in 0..lanes {
            if ALL || levels[n] == level {
                columns.reduce(&mut to_u[n..=n]);
                rows.reduce(&mut to_v[n..=n]);
                entries[n] = rows.entry(to_v[n]) * pitch + columns.entry(to_u[n]) + first;
            }
        }
    }
}
