//! TEX-9 to TEX-11 on rows: the level of detail of each pixel, and the entries on its levels.
#![allow(clippy::float_arithmetic, reason = "estimates: no result depends on how they are rounded")]

use super::kernels::LANES;
use super::kernels::PerLane;
use super::quads::{AtQuads, Known, Measure, Quads, floor, parted};
use super::quotient::{IOTA_REAL, Line, Positions, any_negative, nearest, position, whole};
use super::setup::{BatchSetup, PixelBatch, Planes, Setup};
use super::short::Short;
use super::table::{Placed, Table};
use super::{Reason, Sampler};
use crate::state::Filter;
use crate::texture::coordinates::SampleCoordinates;
use crate::texture::lod::{self, Quad};
use crate::texture::planned::PlannedUnit;

/// Fetches of a block from a texture with levels.
#[derive(Clone, Debug)]
pub(super) struct MipFetches {
    /// Table entries on the nearer level, and on the next one.
    pub(super) entries: [PerLane<i32>; 2],
    /// u and v on those levels, of which only the fraction of a texel is used.
    pub(super) coordinates: [[PerLane<i32>; 2]; 2],
    /// Weight of the next level, 0..=255.
    pub(super) weights: PerLane<i32>,
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
    /// u and v on level 0 in 1/256 texel, with fractions.
    at: [PerLane<f64>; 2],
    lods: PerLane<i32>,
    levels: [PerLane<i32>; 2],
    /// Entries and coordinates on one level.
    read: [PerLane<i32>; 3],
    /// Doubles as bits, negative if a coordinate is not proved on some level.
    close: [PerLane<u64>; 2],
    /// Whether the definition computes the lane.
    open: PerLane<bool>,
}

impl Default for Placing {
    fn default() -> Self {
        Placing {
            at: [[0.0; LANES]; 2],
            lods: [0; LANES],
            levels: [[0; LANES]; 2],
            read: [[0; LANES]; 3],
            close: [[0; LANES]; 2],
            open: [false; LANES],
        }
    }
}

/// If coordinates of a quad are further apart, in 1/65536 texel, the definition computes its level of detail.
const FARTHEST: f64 = (1 << 26) as f64;

/// Distance of a mantissa from a power of two below which nothing is proved. Seven squarings multiply rounding errors by 128.
const LOG_MARGIN: f64 = 1.0 / (1_u64 << 40) as f64;

impl Setup<'_> {
    /// Computes all fetches of a batch for a unit with levels.
    #[inline(always)]
    pub(super) fn levels<const FMA: bool, const ROW: bool>(
        &self,
        batch: PixelBatch<'_>,
        (sampler, planes): (&Sampler, &Planes),
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
        spread.hand_out(quads, &reads.known.each, batch.count, &mut placing.lods[..lanes]);
        let (at, denominator) = (batch.at, base.denominator);
        let [at_u, at_v] = &mut placing.at;
        let (lines, (u, v)) = ([base.along, base.down, denominator], (&mut at_u[..lanes], &mut at_v[..lanes]));
        match base.losses {
            Some(losses) => short.dominance.divide::<FMA, ROW>(at, lines, losses, [u, v]),
            None => quotients::<FMA, ROW>(at, lines, u, v),
        }
        placing.open[..lanes].fill(false);
        let ranges = choose(unit, lanes, &mut placing.lods, &mut placing.levels, &mut reads.weights[batch.lanes()]);
        let mut opens = false;
        let read_levels = ranges[0][0]..=ranges[1][1];
        let shifts = |level: i32| unit.plane_shifts(&unit.levels[level as usize]);
        let mut raised = [0.0; 2];
        for axis in 0..2 {
            let (gap, shared) = base.gaps[axis];
            // In steps of level 0, because a coordinate that is whole on a smaller level is whole there.
            let floors = read_levels.clone().map(|level| shifts(level)[axis]).filter(|shift| *shift > shared);
            let off = base.off + floors.max().map_or(0.0, |shift| base.floors * f64::from(1 << shift));
            let (up, off) = parted(gap, off);
            raised[axis] = up;
            mark_unproved(&placing.at[axis][..lanes], up, off, &mut placing.close[axis][..lanes]);
        }
        let some = any_negative(&placing.close[0][..lanes]) | any_negative(&placing.close[1][..lanes]);
        let close_lanes = if some { batch.count } else { 0 };
        for level in read_levels {
            let shifts = shifts(level);
            let Placing { at, lods, levels, read, close, open } = &mut *placing;
            for axis in 0..2 {
                let scale = f64::from_bits(u64::from(1023 - shifts[axis]) << 52);
                on_level(&at[axis][..lanes], scale, raised[axis], &mut read[axis]);
            }
            for n in (0..close_lanes).filter(|n| (close[0][*n] | close[1][*n]) >> 63 != 0) {
                if levels[0][n] != level && levels[1][n] != level {
                    continue;
                }
                let Some(planes) = base.planes else {
                    (open[n], opens) = (true, true);
                    continue;
                };
                for axis in 0..2 {
                    let g = planes[axis].g.map(|g| g >> shifts[axis]);
                    read[axis][n] = self.corrected(batch, n, &g, read[axis][n]);
                }
            }
            let [u, v, entries] = read;
            let (u, v, entries) = (&mut u[..lanes], &mut v[..lanes], &mut entries[..lanes]);
            let placed = table.placed(level as usize, base.face as u32);
            let filters = [Taken::by(unit.state.mag_filter), Taken::by(unit.state.min_filter)];
            places(&placed, filters, &lods[..lanes], u, v, entries);
            for (which, [low, high]) in ranges.into_iter().enumerate() {
                if level < low || level > high {
                    continue;
                }
                let [to_u, to_v] = &mut reads.coordinates[which];
                let to = [&mut reads.entries[which], to_u, to_v];
                for (to, from) in to.into_iter().zip([&*entries, &*u, &*v]) {
                    let to = &mut to[batch.lanes()];
                    match level == low {
                        true => to.copy_from_slice(from),
                        false => put(level, &levels[which][..lanes], from, to),
                    }
                }
            }
        }
        let count = if opens { batch.count } else { 0 };
        for n in (0..count).filter(|n| placing.open[*n]) {
            self.defined_reads(batch, n, sampler, table, reads);
        }
    }

    /// Returns the floor by INT-4 and INT-4t of a coordinate whose estimate is less than one off.
    fn corrected(&self, batch: PixelBatch<'_>, n: usize, g: &[i64; 3], value: i32) -> i32 {
        let sample = self.sample(batch, n.min(batch.count - 1));
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
        let filter = if lod <= 0 { unit.state.mag_filter } else { unit.state.min_filter };
        for (k, level) in [level as usize, next as usize].into_iter().enumerate() {
            let at = place.on(&unit.levels[level]).map(|c| c.value as i32);
            let ([u, v], mut entries) = (at, [0]);
            let (mut u, mut v) = ([u], [v]);
            let placed = table.placed(level, place.face() as u32);
            places(&placed, [Taken::by(filter); 2], &[lod], &mut u, &mut v, &mut entries);
            reads.entries[k][lane] = entries[0];
            (reads.coordinates[k][0][lane], reads.coordinates[k][1][lane]) = (u[0], v[0]);
        }
        reads.weights[lane] = weight;
    }
}

impl Measure for i32 {
    fn behind(_: &PlannedUnit) -> i32 {
        lod::LEAST
    }

    #[inline(always)]
    fn measure<const WIDE: bool>(_: &PlannedUnit, at: &AtQuads, _: usize, out: &mut [i32], unknown: &mut [u64]) {
        log_ratios(at, out.len(), out, unknown);
    }

    fn defined(_: &PlannedUnit, quad: Option<Quad>) -> i32 {
        lod::log2_ratio(quad)
    }
}

/// TEX-11, TEX-10: computes the levels of detail of quads. Sets the sign bits of those that are not known.
#[inline(always)]
fn log_ratios(at: &AtQuads, lanes: usize, lods: &mut [i32], unknown: &mut [u64]) {
    let [[u, v], [right_u, right_v], [lower_u, lower_v]] = at;
    let (lods, unknown) = (&mut lods[..lanes], &mut unknown[..lanes]);
    for n in 0..lanes {
        let (a, b, c, d) = (right_u[n] - u[n], right_v[n] - v[n], lower_u[n] - u[n], lower_v[n] - v[n]);
        let far = |d: f64| (FARTHEST - d.abs()).to_bits();
        let mut open = far(a) | far(b) | far(c) | far(d);
        // Integers below 2^53, so they are exact.
        let (right, lower) = (a * a + b * b, c * c + d * d);
        let largest = if right > lower { right } else { lower };
        let bits = largest.to_bits();
        // The exponent of its 128th power is the logarithm. A mantissa hardly above 1 is moved away from it, which leaves the exponent 0.
        let mut power = f64::from_bits(bits & ((1 << 52) - 1) | 1.0_f64.to_bits());
        for _ in 0..7 {
            power *= power;
        }
        let power = if power > 1.0 + 2.0 * LOG_MARGIN { power } else { 1.0 + 2.0 * LOG_MARGIN };
        let log = 128 * ((bits >> 52) as i32 - 1023) + (power.to_bits() >> 52) as i32 - 1023;
        let mantissa = f64::from_bits(power.to_bits() & ((1 << 52) - 1) | 1.0_f64.to_bits());
        open |= (mantissa - (1.0 + LOG_MARGIN)).to_bits() | (2.0 - LOG_MARGIN - mantissa).to_bits();
        lods[n] = if largest > 0.0 { log - 128 * 32 } else { lod::LEAST };
        unknown[n] |= open;
    }
}

/// Computes two quotients with their fractions.
#[inline(always)]
pub(super) fn quotients<const FMA: bool, const ROW: bool>(
    at: Positions<'_>,
    [along, down, denominator]: [Line; 3],
    u: &mut [f64],
    v: &mut [f64],
) {
    let lanes = u.len();
    let last = f64::from(at.last);
    let (v, xs, ys, iota) = (&mut v[..lanes], &at.x[..lanes], &at.y[..lanes], &IOTA_REAL[..lanes]);
    for n in 0..lanes {
        let (x, y) = position::<ROW>(n, last, xs, ys, iota);
        let r = 1.0 / denominator.at::<FMA, ROW>(x, y);
        (u[n], v[n]) = (along.at::<FMA, ROW>(x, y) * r, down.at::<FMA, ROW>(x, y) * r);
    }
}

/// Sets the sign bits of lanes whose coordinate on level 0 is so close to an integer that its floor is not proved, on that level or on
/// smaller ones.
#[inline(always)]
fn mark_unproved(at: &[f64], up: f64, off: f64, close: &mut [u64]) {
    let close = &mut close[..at.len()];
    for n in 0..at.len() {
        let t = at[n] + up;
        close[n] = ((t - whole(t)).abs() - off).to_bits();
    }
}

/// Computes the floors of coordinates on a level.
#[inline(always)]
fn on_level(at: &[f64], scale: f64, up: f64, out: &mut PerLane<i32>) {
    let out = &mut out[..at.len()];
    let up = up * scale - 0.5;
    for n in 0..at.len() {
        out[n] = nearest(at[n] * scale + up);
    }
}

/// TEX-9: computes the levels and the weight of each lane. `lods` become biased. Returns the least and the largest first level, and the
/// least and the largest second level.
#[inline(always)]
fn choose(
    unit: &PlannedUnit,
    lanes: usize,
    lods: &mut PerLane<i32>,
    [levels, nexts]: &mut [PerLane<i32>; 2],
    weights: &mut [i32],
) -> [[i32; 2]; 2] {
    let selection = lod::Selection::from_unit(unit);
    let (lods, weights) = (&mut lods[..lanes], &mut weights[..lanes]);
    let (levels, nexts) = (&mut levels[..lanes], &mut nexts[..lanes]);
    let mut ends = [i32::MAX, i32::MIN];
    for n in 0..lanes {
        let lod = selection.biased(lods[n]);
        (levels[n], nexts[n], weights[n]) = selection.levels(lod.max(0));
        lods[n] = lod;
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
/// texel of the footprint. Coordinates become those for the weights.
#[inline(always)]
fn places(placed: &Placed, [mag, min]: [Taken; 2], lods: &[i32], u: &mut [i32], v: &mut [i32], entries: &mut [i32]) {
    let Placed { axes: [columns, rows], first, pitch } = *placed;
    let lanes = lods.len();
    let (u, v, entries) = (&mut u[..lanes], &mut v[..lanes], &mut entries[..lanes]);
    let periodic = columns.period.is_some() || rows.period.is_some();
    for n in 0..lanes {
        let less = if lods[n] <= 0 { mag.less } else { min.less };
        let kept = if lods[n] <= 0 { mag.kept } else { min.kept };
        u[n] = (u[n].wrapping_sub(less) & kept).max(columns.low).min(columns.high);
        v[n] = (v[n].wrapping_sub(less) & kept).max(rows.low).min(rows.high);
        entries[n] = rows.entry(v[n]).wrapping_mul(pitch).wrapping_add(columns.entry(u[n])).wrapping_add(first);
    }
    if periodic {
        columns.reduce(u);
        rows.reduce(v);
        for n in 0..lanes {
            entries[n] = rows.entry(v[n]) * pitch + columns.entry(u[n]) + first;
        }
    }
}

/// Copies entries and coordinates of a level to the lanes that read it. By bits, because compilers turn a choice into masked loads and
/// stores, which are slow.
#[inline(always)]
fn put(level: i32, levels: &[i32], from: &[i32], to: &mut [i32]) {
    let (from, to) = (&from[..levels.len()], &mut to[..levels.len()]);
    for n in 0..levels.len() {
        to[n] ^= (to[n] ^ from[n]) & -i32::from(levels[n] == level);
    }
}
