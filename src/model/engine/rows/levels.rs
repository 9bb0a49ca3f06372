//! TEX-9 to TEX-11 on rows: the level of detail of each pixel, and the entries on its levels.
#![allow(clippy::float_arithmetic, reason = "estimates: no result depends on how they are rounded")]

use super::base_level::{BaseLevel, parted};
use super::direction::CubeDirection;
use super::kernels::PerLane;
use super::planes::Plane;
use super::quads::{Exact, Known, Quads, Spread, floor, of_box};
use super::quotient::{Line, Reciprocals, nearest, whole};
use super::setup::{BatchSetup, Covered, PixelBatch, Planes, Run, Setup};
use super::short::Short;
use super::table::{Placed, Table};
use super::{Reason, Sampler};
use crate::state::Filter;
use crate::texture::coordinates::SampleCoordinates;
use crate::texture::lod;
use crate::texture::planned::PlannedUnit;
use std::ops::Range;

/// Fetches of a block from a texture with levels.
#[derive(Clone, Debug, Default)]
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

/// Scratch space for placing lanes on levels.
#[derive(Clone, Debug, Default)]
pub(super) struct Placing {
    /// u and v on level 0 in 1/256 texel, with fractions, if something is taken off them.
    at: [PerLane<f64>; 2],
    /// Their floors.
    floors: [PerLane<i32>; 2],
    lods: PerLane<i32>,
    levels: [PerLane<i32>; 2],
    /// Sign bits of lanes whose floors are not proved on some level.
    close: PerLane<i32>,
    whole: PerLane<i32>,
}

impl Setup<'_> {
    /// Returns whether the coordinates on all levels that a sampler reads are those of level 0, shifted.
    pub(super) fn shift_with(&self, sampler: &Sampler, planes: &[Plane; 2]) -> bool {
        let shifts = self.unit(sampler).largest_shifts();
        planes[0].shifts_by(shifts[0]) && planes[1].shifts_by(shifts[1])
    }

    /// Returns the unit of a sampler.
    fn unit(&self, sampler: &Sampler) -> &PlannedUnit {
        &self.context.draw.units[sampler.index]
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
    pub(super) fn defined_reads(&self, batch: PixelBatch<'_>, n: usize, sampler: &Sampler, reads: &mut MipFetches) {
        let Some(table) = &sampler.table else { return };
        let unit = self.unit(sampler);
        self.count_defined(Reason::Levels, 1);
        let (sample, lane) = (self.sample(batch, n), batch.lane + n);
        let Some(place) = self.context.sample_coordinates(unit, &sample, batch.pixel(n)) else { return };
        let lod = lod::biased(unit, lod::log2_ratio(place.quad()));
        let (level, next, weight) = lod::levels(unit, lod.max(0));
        let filters = Taken::of_unit(unit);
        for (which, level) in [level as usize, next as usize].into_iter().enumerate() {
            let at = place.on(&unit.levels[level]).map(|c| c.value as i32);
            reads.place(which, lane, &table.placed(level, place.face() as u32), filters, lod, at);
        }
        reads.weights[lane] = weight as u16;
    }
}

/// Coordinates on level 0, if they are known and those of the levels are [theirs, shifted](Setup::shift_with).
pub(super) type Floors<'a> = Option<[&'a [i32]; 2]>;

/// [`levels`], compiled for an instruction set.
pub(super) type FindLevels = fn(
    &Setup<'_>,
    Fetches,
    PixelBatch<'_>,
    (&Sampler, &Planes),
    (&BatchSetup, &Reciprocals, Floors<'_>),
    (&mut Short, &mut Quads, &mut Placing),
    &mut MipFetches,
);

/// Computes all fetches of a batch for a unit with levels. A batch that meets several faces of a cube map is divided into parts that meet one,
/// row by row.
#[inline(always)]
pub(super) fn levels<const FMA: bool>(
    setup: &Setup<'_>,
    fetches: Fetches,
    batch: PixelBatch<'_>,
    (sampler, planes): (&Sampler, &Planes),
    (local, reciprocals, floors): (&BatchSetup, &Reciprocals, Floors<'_>),
    (short, quads, placing): (&mut Short, &mut Quads, &mut Placing),
    reads: &mut MipFetches,
) {
    let unit = setup.unit(sampler);
    if let Some(base) = setup.base_level::<FMA>(batch, (sampler, planes), local) {
        let exact = Some(Exact { setup, batch: &batch, e: &local.e });
        fetches(batch, (unit, sampler, &base), exact, (reciprocals, floors), (short, quads, placing), reads);
        return;
    }
    let Planes::Direction(directions, _) = planes else {
        for n in 0..batch.count {
            setup.defined_reads(batch, n, sampler, reads);
        }
        return;
    };
    let (is_row, row) = (batch.is_row(), [Run::new(0, 0, batch.count)]);
    for run in if is_row { &row } else { batch.runs } {
        let ((i, j), count, lane) = (batch.pixel(run.lane()), run.count(), batch.lane + run.lane());
        // A box does not say which of them are covered.
        let covered = Covered(0, if batch.reaches_beyond() { 0 } else { count });
        let row = if is_row { batch } else { PixelBatch { covered, ..PixelBatch::row((i, j), count, lane) } };
        let mut done = 0;
        while done < count {
            let mut part = row.part(done, count - done);
            let proved = loop {
                let own = (!is_row || part.count < batch.count).then(|| setup.local::<FMA, true>(part, true));
                let local = own.as_ref().unwrap_or(local);
                if let Some(base) = setup.base_level::<FMA>(part, (sampler, planes), local) {
                    let exact = Some(Exact { setup, batch: &part, e: &local.e });
                    let (of, work) = ((unit, sampler, &base), (&mut *short, &mut *quads, &mut *placing));
                    fetches(part, of, exact, (reciprocals, floors), work, reads);
                    break true;
                }
                let (last, odd_row) = (part.at.last.into(), (j & 1) as f64);
                let stretch = CubeDirection::new(directions, local).stretch::<FMA>(last, odd_row);
                if stretch == part.count {
                    // The pixels of the first quad, of which another one can meet another face.
                    let odd = part.first.0 & 1;
                    part = row.part(done, part.count.min(2 - odd as usize));
                    break false;
                }
                part = row.part(done, stretch);
            };
            for n in 0..if proved { 0 } else { part.count } {
                setup.defined_reads(part, n, sampler, reads);
            }
            done += part.count;
        }
    }
    if !is_row {
        quads.begin_box(batch);
    }
}

/// [`fetches`], compiled for an instruction set.
pub(super) type Fetches = fn(
    PixelBatch<'_>,
    (&PlannedUnit, &Sampler, &BaseLevel<'_>),
    Option<Exact<'_>>,
    (&Reciprocals, Floors<'_>),
    (&mut Short, &mut Quads, &mut Placing),
    &mut MipFetches,
) -> bool;

/// Computes all fetches of a batch from the coordinates of level 0. Returns `false` if something is not proved and nothing decides it; then nothing
/// counts.
#[inline(always)]
pub(super) fn fetches<const FMA: bool>(
    batch: PixelBatch<'_>,
    (unit, sampler, base): (&PlannedUnit, &Sampler, &BaseLevel<'_>),
    exact: Option<Exact<'_>>,
    (reciprocals, floors): (&Reciprocals, Floors<'_>),
    (short, quads, placing): (&mut Short, &mut Quads, &mut Placing),
    reads: &mut MipFetches,
) -> bool {
    let Some(table) = &sampler.table else { return exact.is_some() };
    let lanes = batch.at.x.len();
    let spread = match exact {
        Some(Exact { setup, e, .. }) => setup.of_quads::<FMA, i32>(batch, (unit, base), e, quads, &mut reads.known),
        None if of_box::<FMA, i32>((unit, base), None, quads, &mut reads.known) => Spread::Rows,
        None => return false,
    };
    let Placing { at, floors: [u, v], lods, levels, close, whole } = placing;
    spread.hand_out(quads, &reads.known.each, batch.count, lods);
    let ranges = choose(unit, lods, levels, &mut reads.weights[batch.lanes()]);
    let shifts = |level: i32| unit.plane_shifts(&unit.levels[level as usize]);
    let (u, v, close) = (&mut u[..lanes], &mut v[..lanes], &mut close[..lanes]);
    // What decides coordinates on planes.
    let on_planes = exact.zip(base.planes);
    if floors.is_none() {
        // The smallest level has the largest shifts.
        let (last, mut settled) = (shifts(ranges[1][1]), [(0.0, 0.0); 2]);
        for axis in 0..2 {
            let (gap, shared) = base.gaps[axis];
            let gap = match on_planes {
                Some((Exact { setup, .. }, planes)) if gap > 0.0 && setup.may_lower(&batch, &planes[axis]) => 0.0,
                _ => gap,
            };
            // In steps of level 0, because a coordinate that is whole on a smaller level is whole there.
            let floors = if last[axis] > shared { base.floors * f64::from(1 << last[axis]) } else { 0.0 };
            settled[axis] = parted(gap, base.off + floors);
        }
        let lines = [base.along, base.down, base.denominator];
        match base.losses {
            Some(losses) => {
                let [at_u, at_v] = at;
                let out: [&mut [f64]; 2] = [&mut *at_u, &mut *at_v];
                short.dominance.divide_batch::<FMA>(batch, lines, losses, 0.0, out);
                settle(&at_u[..lanes], &at_v[..lanes], settled, u, v, close);
            }
            None => {
                if !base.by_d {
                    short.set_reciprocals::<FMA>(batch, base.denominator);
                }
                let reciprocals = if base.by_d { reciprocals } else { &short.reciprocals };
                quotients::<FMA>(reciprocals.lanes(lanes), [base.along, base.down], settled, u, v, close);
            }
        }
    }
    let mut any_close = floors.is_none() && close.iter().fold(0, |all, close| all | close) < 0;
    if let Some((Exact { setup, e, .. }, planes)) = on_planes
        && any_close
        && base.losses.is_none()
        && setup.shift_with(sampler, planes)
    {
        setup.correct_coordinates::<false>(batch, 0, planes, [true; 2], e, u, v, whole);
        any_close = false;
    }
    let [u, v] = floors.unwrap_or([u, v]);
    reads.place_all((unit, table, base.face as u32), batch.lanes(), ranges, lods, levels, u, v);
    if !any_close {
        return true;
    }
    let Some(Exact { setup, .. }) = exact else { return false };
    let filters = Taken::of_unit(unit);
    for n in (0..batch.count).filter(|n| placing.close[*n] < 0) {
        let Some(planes) = base.planes else {
            setup.defined_reads(batch, n, sampler, reads);
            continue;
        };
        for which in 0..2 {
            let level = placing.levels[which][n];
            let on_axis = |axis: usize| {
                let shift = shifts(level)[axis];
                setup.corrected(batch, n, &planes[axis].g.map(|g| g >> shift), placing.floors[axis][n] >> shift)
            };
            let placed = table.placed(level as usize, base.face as u32);
            reads.place(which, batch.lane + n, &placed, filters, placing.lods[n], [on_axis(0), on_axis(1)]);
        }
    }
    true
}

impl MipFetches {
    /// Places lanes on the levels that [`choose`] found. `u` and `v` are the coordinates on level 0.
    #[inline(always)]
    #[allow(clippy::too_many_arguments, reason = "what the caller has computed, each apart")]
    pub(super) fn place_all(
        &mut self,
        (unit, table, face): (&PlannedUnit, &Table, u32),
        lanes: Range<usize>,
        ranges: [[i32; 2]; 2],
        lods: &PerLane<i32>,
        levels: &[PerLane<i32>; 2],
        u: &[i32],
        v: &[i32],
    ) {
        let (filters, lods) = (Taken::of_unit(unit), &lods[..lanes.len()]);
        // By reference: both ends read as one would have to wait until they are stored.
        for (which, [low, high]) in ranges.iter().enumerate() {
            let ([to_u, to_v], entries) = (&mut self.coordinates[which], &mut self.entries[which]);
            let (to_u, to_v) = (&mut to_u[lanes.clone()], &mut to_v[lanes.clone()]);
            let entries = &mut entries[lanes.clone()];
            if low == high {
                let low = *low as usize;
                let shifts = unit.plane_shifts(&unit.levels[low]);
                places(&table.placed(low, face), filters, shifts, lods, u, v, to_u, to_v, entries);
            } else {
                let of = (lods, &levels[which][..lanes.len()]);
                scattered((unit, table, face), filters, of, u, v, to_u, to_v, entries);
            }
        }
    }

    /// Places a lane on a level, the nearer or the next one, at the coordinates that it has there.
    fn place(&mut self, which: usize, lane: usize, placed: &Placed, filters: [Taken; 2], lod: i32, [u, v]: [i32; 2]) {
        let ([to_u, to_v], entries) = (&mut self.coordinates[which], &mut self.entries[which]);
        let (to_u, to_v, entries) = (&mut to_u[lane..=lane], &mut to_v[lane..=lane], &mut entries[lane..=lane]);
        places(placed, filters, [0; 2], &[lod], &[u], &[v], to_u, to_v, entries);
    }
}

/// Computes the floors of two quotients on level 0. Sets the sign bits of lanes where one is so close to an integer that its floor is not
/// proved, on that level or on smaller ones.
#[inline(always)]
fn quotients<const FMA: bool>(
    [xs, ys, rs]: [&[f64]; 3],
    [along, down]: [Line; 2],
    settled: [(f64, f64); 2],
    u: &mut [i32],
    v: &mut [i32],
    close: &mut [i32],
) {
    let lanes = u.len();
    let (v, close, xs, ys, rs) = (&mut v[..lanes], &mut close[..lanes], &xs[..lanes], &ys[..lanes], &rs[..lanes]);
    for n in 0..lanes {
        let p = along.at::<FMA, false>(xs[n], ys[n]) * rs[n];
        (u[n], close[n]) = floor_and_proof(p, settled[0]);
    }
    for n in 0..lanes {
        let q = down.at::<FMA, false>(xs[n], ys[n]) * rs[n];
        let (floor, of_lane) = floor_and_proof(q, settled[1]);
        (v[n], close[n]) = (floor, close[n] | of_lane);
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
pub(super) fn choose(
    unit: &PlannedUnit,
    lods: &mut PerLane<i32>,
    [levels, nexts]: &mut [PerLane<i32>; 2],
    weights: &mut [u16],
) -> [[i32; 2]; 2] {
    let selection = lod::Selection::from_unit(unit);
    let lanes = weights.len();
    let lods = &mut lods[..lanes];
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
#[derive(Clone, Copy, PartialEq, Eq)]
struct Taken {
    less: i32,
    kept: i32,
}

impl Taken {
    /// Returns what the magnification and the minification filter of a unit change.
    fn of_unit(unit: &PlannedUnit) -> [Taken; 2] {
        [Taken::by(unit.state.mag_filter), Taken::by(unit.state.min_filter)]
    }

    fn by(filter: Filter) -> Taken {
        match filter {
            Filter::Linear => Taken { less: 128, kept: -1 },
            // Without a fraction, so that nothing is mixed.
            Filter::Nearest => Taken { less: 0, kept: !255 },
        }
    }
}

/// Number of levels of the largest side, rounded up to a power of two.
const MAX_LEVELS: usize = 16;

/// Computes the entry of each lane on its own level. The axes of a level are those of level 0,
/// [shifted](super::table::Axis::shifted), because only textures whose sides are powers of two have several levels.
#[inline(always)]
#[allow(clippy::too_many_arguments, reason = "each result apart, so that the compiler sees that none overlaps another")]
fn scattered(
    (unit, table, face): (&PlannedUnit, &Table, u32),
    filters: [Taken; 2],
    (lods, levels): (&[i32], &[i32]),
    u: &[i32],
    v: &[i32],
    to_u: &mut [i32],
    to_v: &mut [i32],
    entries: &mut [i32],
) {
    let mut firsts = [0; MAX_LEVELS];
    for (n, first) in firsts.iter_mut().take(unit.levels.len()).enumerate() {
        *first = table.placed(n, face).first;
    }
    let most = unit.largest_shifts().map(|shift| shift as i32);
    let (width, height) = (unit.levels[0].width as i32, unit.levels[0].height as i32);
    let ([columns, rows], pitch) = (table.axes, table.pitch);
    let lanes = lods.len();
    let (u, v, levels) = (&u[..lanes], &v[..lanes], &levels[..lanes]);
    let (to_u, to_v, entries) = (&mut to_u[..lanes], &mut to_v[..lanes], &mut entries[..lanes]);
    // A loop of its own, because compilers do not make vectors of look-ups.
    for n in 0..lanes {
        entries[n] = firsts[levels[n] as usize % MAX_LEVELS];
    }
    for n in 0..lanes {
        let shifts = [levels[n].min(most[0]), levels[n].min(most[1])];
        let axes = [columns.shifted(width, shifts[0]), rows.shifted(height, shifts[1])];
        let placed = Placed { axes, first: entries[n], pitch };
        (to_u[n], to_v[n], entries[n]) =
            entry(&placed, filters, shifts.map(|shift| shift as u32), lods[n], [u[n], v[n]]);
    }
}

/// Returns the coordinates for the weights of a lane on a level, and the entry: that of the texel, or of the upper left texel of the
/// footprint. Coordinates are not reduced to the period yet.
#[inline(always)]
fn entry(
    placed: &Placed,
    [mag, min]: [Taken; 2],
    [shift_u, shift_v]: [u32; 2],
    lod: i32,
    [u, v]: [i32; 2],
) -> (i32, i32, i32) {
    let [columns, rows] = &placed.axes;
    let Taken { less, kept } = if lod <= 0 { mag } else { min };
    let (u, v) = ((u >> shift_u).wrapping_sub(less) & kept, (v >> shift_v).wrapping_sub(less) & kept);
    let (u, v) = (u.max(columns.low).min(columns.high), v.max(rows.low).min(rows.high));
    (u, v, rows.entry(v).wrapping_mul(placed.pitch).wrapping_add(columns.entry(u)).wrapping_add(placed.first))
}

/// Computes the entry of each lane on a level, for the magnification or the minification filter: that of the texel, or of the upper left
/// texel of the footprint; and the coordinates for the weights.
#[inline(always)]
#[allow(clippy::too_many_arguments, reason = "each result apart, so that the compiler sees that none overlaps another")]
fn places(
    placed: &Placed,
    filters: [Taken; 2],
    shifts: [u32; 2],
    lods: &[i32],
    u: &[i32],
    v: &[i32],
    to_u: &mut [i32],
    to_v: &mut [i32],
    entries: &mut [i32],
) {
    let Placed { axes: [columns, rows], first, pitch } = *placed;
    let lanes = lods.len();
    let (u, v) = (&u[..lanes], &v[..lanes]);
    let (to_u, to_v, entries) = (&mut to_u[..lanes], &mut to_v[..lanes], &mut entries[..lanes]);
    for n in 0..lanes {
        (to_u[n], to_v[n], entries[n]) = entry(placed, filters, shifts, lods[n], [u[n], v[n]]);
    }
    if columns.period.is_some() || rows.period.is_some() {
        columns.reduce(to_u);
        rows.reduce(to_v);
        for n in 0..lanes {
            entries[n] = rows.entry(to_v[n]) * pitch + columns.entry(to_u[n]) + first;
        }
    }
}
