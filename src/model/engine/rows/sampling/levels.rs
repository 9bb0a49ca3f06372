//! TEX-9 on rows: the levels of each pixel, and the table entries on them.
#![allow(clippy::float_arithmetic, reason = "whole numbers that doubles hold, times powers of two")]

use super::pairs::PairsOfQuad;
use super::table::{LevelPosition, Table};
use crate::engine::rows::lanes::{BLOCK, PerLane, limited};
use crate::state::{Filter, MipFilter};
use crate::texture::lod;
use crate::texture::planned::PlannedUnit;

/// Fetches of a block from a texture with levels.
#[derive(Clone, Debug, Default)]
pub(crate) struct MipFetches {
    /// Table entries on the nearer level, and on the next one.
    pub(crate) entries: [PerLane<u32>; 2],
    /// u and v on those levels, of which only the fraction of a texel is used.
    pub(crate) coordinates: [[PerLane<i32>; 2]; 2],
    /// Weight of the next level, 0..=255.
    pub(crate) weights: PerLane<u16>,
}

/// Scratch space for placing lanes on levels.
#[derive(Clone, Debug, Default)]
pub(crate) struct Placing {
    /// Levels of detail of the quads, and of the lanes.
    pub(crate) of_quads: Vec<i32>,
    pub(crate) lods: PerLane<i32>,
    /// The taps of the quads.
    pub(crate) footprints: Vec<PairsOfQuad>,
    levels: [PerLane<i32>; 2],
}

impl MipFetches {
    /// Returns the entries of one of two levels, and the coordinates for its weights.
    #[inline(always)]
    pub(crate) fn of_level(&self, which: usize) -> (&[u32; BLOCK], [&[i32; BLOCK]; 2]) {
        let [u, v] = &self.coordinates[which];
        (self.entries[which].block(), [u.block(), v.block()])
    }

    /// Computes the fetches of the first lanes from their levels of detail, which become biased, and from their coordinates on level 0 in 1/65536
    /// texel. `images` are faces.
    #[inline(always)]
    pub(crate) fn compute_fetches(
        &mut self,
        (unit, table): (&PlannedUnit, &Table),
        count: usize,
        fine: &[PerLane<f64>; 2],
        images: Option<&PerLane<u32>>,
        placing: &mut Placing,
    ) {
        let Placing { lods, levels, .. } = placing;
        let ranges = choose(unit, lods, levels, &mut self.weights[..count]);
        let (filters, most) = (FilterBits::of_unit(unit), unit.largest_shifts());
        // The second level is read only where two are mixed.
        let count_of_levels = if unit.state.mip_filter == MipFilter::Linear { 2 } else { 1 };
        for (which, [low, high]) in ranges.into_iter().enumerate().take(count_of_levels) {
            let ([u, v], entries) = (&mut self.coordinates[which], &mut self.entries[which]);
            let (u, v, entries) = (&mut u[..count], &mut v[..count], &mut entries[..count]);
            let (lods, levels) = (&lods[..count], &levels[which][..count]);
            on_levels(&fine[0][..count], levels, most[0], u);
            on_levels(&fine[1][..count], levels, most[1], v);
            if low == high {
                places(&table.levels[low as usize], filters, lods, u, v, entries);
            } else {
                scattered((unit, table), filters, (lods, levels), u, v, entries);
            }
            if let Some(images) = images {
                for (entry, image) in entries.iter_mut().zip(&**images) {
                    *entry += image * table.face;
                }
            }
        }
    }
}

/// Computes the coordinates of lanes on their levels, 1/256 texel. Sides are halved up to `most` times.
#[inline(always)]
fn on_levels(fine: &[f64], levels: &[i32], most: u32, out: &mut [i32]) {
    let (fine, levels, most) = (&fine[..out.len()], &levels[..out.len()], most as i32);
    for n in 0..out.len() {
        let down = 8 + levels[n].min(most);
        out[n] = limited(fine[n] * f64::from_bits(((1023 - down) as u64) << 52));
    }
}

/// TEX-9: computes the levels and the weight of each lane. `lods` become biased. Returns the least and the largest first level, and the
/// least and the largest second level.
#[inline(always)]
fn choose(
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
struct FilterBits {
    less: i32,
    kept: i32,
}

impl FilterBits {
    /// Returns what the magnification and the minification filter of a unit change.
    fn of_unit(unit: &PlannedUnit) -> [FilterBits; 2] {
        [FilterBits::by(unit.state.mag_filter), FilterBits::by(unit.state.min_filter)]
    }

    fn by(filter: Filter) -> FilterBits {
        match filter {
            Filter::Linear => FilterBits { less: 128, kept: -1 },
            // Without a fraction, so that nothing is mixed.
            Filter::Nearest => FilterBits { less: 0, kept: !255 },
        }
    }
}

/// Number of levels of the largest side, rounded up to a power of two.
const MAX_LEVELS: usize = 16;

/// Computes the entry of each lane on its own level. The axes of a level are those of level 0,
/// [shifted](super::table::Axis::shifted), because only textures whose sides are powers of two have several levels.
#[inline(always)]
fn scattered(
    (unit, table): (&PlannedUnit, &Table),
    filters: [FilterBits; 2],
    (lods, levels): (&[i32], &[i32]),
    u: &mut [i32],
    v: &mut [i32],
    entries: &mut [u32],
) {
    let mut firsts = [0; MAX_LEVELS];
    for (n, first) in firsts.iter_mut().take(unit.levels.len()).enumerate() {
        *first = table.levels[n].first;
    }
    let most = unit.largest_shifts().map(|shift| shift as i32);
    let (width, height) = (unit.levels[0].width as i32, unit.levels[0].height as i32);
    let ([columns, rows], pitch) = (table.axes, table.pitch);
    let lanes = lods.len();
    let (u, v, levels, entries) = (&mut u[..lanes], &mut v[..lanes], &levels[..lanes], &mut entries[..lanes]);
    // A loop of its own, because compilers do not make vectors of look-ups.
    for n in 0..lanes {
        entries[n] = firsts[levels[n] as usize % MAX_LEVELS] as u32;
    }
    for n in 0..lanes {
        let axes = [columns.shifted(width, levels[n].min(most[0])), rows.shifted(height, levels[n].min(most[1]))];
        let placed = LevelPosition { axes, first: entries[n] as i32, pitch };
        (u[n], v[n], entries[n]) = entry(&placed, filters, lods[n], [u[n], v[n]]);
    }
}

/// Returns the coordinates for the weights of a lane on a level, and the entry: that of the texel, or of the upper left texel of the
/// footprint. Coordinates are not reduced to the period yet.
#[inline(always)]
fn entry(placed: &LevelPosition, [mag, min]: [FilterBits; 2], lod: i32, [u, v]: [i32; 2]) -> (i32, i32, u32) {
    let [columns, rows] = &placed.axes;
    let FilterBits { less, kept } = if lod <= 0 { mag } else { min };
    let (u, v) = ((u - less) & kept, (v - less) & kept);
    let (u, v) = (u.max(columns.low).min(columns.high), v.max(rows.low).min(rows.high));
    let entry = rows.entry(v).wrapping_mul(placed.pitch).wrapping_add(columns.entry(u)).wrapping_add(placed.first);
    (u, v, entry as u32)
}

/// Computes the entry of each lane on a level, for the magnification or the minification filter: that of the texel, or of the upper left
/// texel of the footprint. Coordinates become those for the weights.
#[inline(always)]
fn places(
    placed: &LevelPosition,
    filters: [FilterBits; 2],
    lods: &[i32],
    u: &mut [i32],
    v: &mut [i32],
    entries: &mut [u32],
) {
    let LevelPosition { axes: [columns, rows], first, pitch } = *placed;
    let lanes = lods.len();
    let (u, v, entries) = (&mut u[..lanes], &mut v[..lanes], &mut entries[..lanes]);
    for n in 0..lanes {
        (u[n], v[n], entries[n]) = entry(placed, filters, lods[n], [u[n], v[n]]);
    }
    if columns.period.is_some() || rows.period.is_some() {
        columns.reduce(u);
        rows.reduce(v);
        for n in 0..lanes {
            entries[n] = (rows.entry(v[n]) * pitch + columns.entry(u[n]) + first) as u32;
        }
    }
}
