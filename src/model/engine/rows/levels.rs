//! TEX-9 to TEX-11 on rows: the lod of each pixel, and where it is read on which levels.
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

/// What the lanes of a block read of a texture whose levels count.
#[derive(Clone, Debug)]
pub(super) struct MipFetches {
    /// Entries of the table: of the nearer level, and of the next one.
    pub(super) entries: [PerLane<i32>; 2],
    /// u and v on that level; only the fraction of a texel is used.
    pub(super) coordinates: [[PerLane<i32>; 2]; 2],
    /// Weight of the next level, 0..=255.
    pub(super) weights: PerLane<i32>,
    /// Lods of quads.
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

/// What lanes are placed on levels in.
#[derive(Clone, Debug)]
pub(super) struct Placing {
    /// u and v of the lanes on level 0, 1/256 texel, with their fractions.
    at: [PerLane<f64>; 2],
    lods: PerLane<i32>,
    levels: [PerLane<i32>; 2],
    /// What is read of one level.
    read: [PerLane<i32>; 3],
    /// Negative, as the bits of doubles: a coordinate of the lane is not proved on some level.
    close: [PerLane<u64>; 2],
    /// The lane is the definition's.
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

/// Coordinates of a quad that are further apart than this have their lod from the definition, 1/65536 texel.
const FARTHEST: f64 = (1 << 26) as f64;

/// Mantissas closer to a power of two than this are too close to call: seven squarings multiply roundings by 128.
const LOG_MARGIN: f64 = 1.0 / (1_u64 << 40) as f64;

impl Setup<'_> {
    /// Everything that a unit whose levels count reads in a batch.
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
            // In steps of level 0: what is whole on a smaller level is whole there.
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

    /// The floor that an estimate less than one off stands for, by INT-4 and INT-4t.
    fn corrected(&self, batch: PixelBatch<'_>, n: usize, g: &[i64; 3], value: i32) -> i32 {
        let sample = self.sample(batch, n.min(batch.count - 1));
        let top = (0..3).fold(0_i64, |top, k| top.wrapping_add(g[k].wrapping_mul(sample.e[k])));
        let (floor, exact) = floor(top, sample.d, i64::from(value));
        floor as i32 - i32::from(sample.lowers_tie(exact, || sample.shortfall(g)))
    }

    /// What a lane reads, by the definition.
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
        self.tell(Reason::Levels, 1);
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

/// TEX-11, TEX-10 of the three pixels of quads, and as sign bits which are not known.
#[inline(always)]
fn log_ratios(at: &AtQuads, lanes: usize, lods: &mut [i32], unknown: &mut [u64]) {
    let [[u, v], [right_u, right_v], [lower_u, lower_v]] = at;
    let (lods, unknown) = (&mut lods[..lanes], &mut unknown[..lanes]);
    for n in 0..lanes {
        let (a, b, c, d) = (right_u[n] - u[n], right_v[n] - v[n], lower_u[n] - u[n], lower_v[n] - v[n]);
        let far = |d: f64| (FARTHEST - d.abs()).to_bits();
        let mut open = far(a) | far(b) | far(c) | far(d);
        // Whole numbers below 2^53.
        let (right, lower) = (a * a + b * b, c * c + d * d);
        let largest = if right > lower { right } else { lower };
        let bits = largest.to_bits();
        // Its 128th power, whose exponent is the logarithm. What is hardly above 1 is moved away from it; the exponent is 0 all the same.
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

/// Two quotients with their fractions.
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

/// As sign bits: which coordinates of level 0 are so close to a whole number that their floors are not proved, on it or on smaller levels.
#[inline(always)]
fn mark_unproved(at: &[f64], up: f64, off: f64, close: &mut [u64]) {
    let close = &mut close[..at.len()];
    for n in 0..at.len() {
        let t = at[n] + up;
        close[n] = ((t - whole(t)).abs() - off).to_bits();
    }
}

/// Floors of coordinates on a level.
#[inline(always)]
fn on_level(at: &[f64], scale: f64, up: f64, out: &mut PerLane<i32>) {
    let out = &mut out[..at.len()];
    let up = up * scale - 0.5;
    for n in 0..at.len() {
        out[n] = nearest(at[n] * scale + up);
    }
}

/// TEX-9: levels and weight of each lane; `lods` become biased. The least and the largest level that is read, and likewise of those that are
/// mixed in.
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
    // Levels never fall where lods rise.
    let [(low, next_low, _), (high, next_high, _)] = ends.map(|lod| selection.levels(lod.max(0)));
    [[low, high], [next_low, next_high]]
}

/// What a filter takes of a coordinate: what is subtracted, and the bits that are kept.
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

/// Where coordinates lie on a level, by the filter for magnification or for minification: the entry of the texel, or of the upper left one of
/// the footprint. Coordinates become what the weights come from.
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

/// What is read of a level, for the lanes that read it. By bits: compilers make masked loads and stores of a choice, which are slow.
#[inline(always)]
fn put(level: i32, levels: &[i32], from: &[i32], to: &mut [i32]) {
    let (from, to) = (&from[..levels.len()], &mut to[..levels.len()]);
    for n in 0..levels.len() {
        to[n] ^= (to[n] ^ from[n]) & -i32::from(levels[n] == level);
    }
}
