//! TEX-5, TEX-7 to TEX-9 on rows: addresses of table entries, and fetches of texels.

use super::filter::{Filter, Footprint, GROUP, fetch_footprints, filter_half, filter_one};
use super::levels::{MipFetches, Placing};
use super::pairs::Pair;
use super::place::Place;
use super::quads::Quads;
use super::sampler::Sampler;
use super::table::{Axis, Column, Table, Texels};
use super::taps;
use crate::engine::rows::geometry::weights::Pixels;
use crate::engine::rows::lanes::{BLOCK, Lanes, PerLane, channels, for_each_function};
use crate::number::Lane;
use crate::state::{CompareFunction, MipFilter};
use crate::texture::filter::lerp;
use crate::texture::lod;
use crate::texture::planned::PlannedUnit;

/// Scratch space of a fetch.
#[derive(Clone, Debug, Default)]
pub(crate) struct Workspace {
    entries: PerLane<u32>,
    texels: PerLane<u32>,
    footprints: PerLane<Footprint>,
    /// Channels of the second level.
    next: [PerLane<i16>; 4],
    /// 16-bit halves: that of A and R, and that of G and B.
    halves: [PerLane<i32>; 2],
    pub(crate) placing: Box<Placing>,
    /// The lanes that are fetched.
    pub(crate) lanes: Lanes,
}

/// What reads a texture: the filter of the instruction set, the unit, its sampler and the rows of its channels.
#[derive(Clone, Copy)]
pub(crate) struct Reader<'a> {
    pub(crate) filter: Filter,
    pub(crate) unit: &'a PlannedUnit,
    pub(crate) sampler: &'a Sampler,
    pub(crate) wanted: [Option<u16>; 4],
}

/// [`sample`], compiled for an instruction set.
pub(crate) type SampleUnit =
    fn(Reader<'_>, &Pixels, &mut Place, &mut Quads, &mut Workspace, &mut [bool], &mut [PerLane<i16>]);

/// Samples a unit for a block: its levels, its taps, or one texel or footprint of each pixel. Drops lanes by its colour key.
#[inline(always)]
pub(crate) fn sample<const FMA: bool>(
    reader: Reader<'_>,
    pixels: &Pixels,
    place: &mut Place,
    quads: &mut Quads,
    work: &mut Workspace,
    alive: &mut [bool],
    rows: &mut [PerLane<i16>],
) {
    let Reader { unit, sampler, wanted, .. } = reader;
    let Some(table) = &sampler.table else { return };
    if sampler.mixes {
        reader.choose_levels(table, pixels, place, quads, work);
        reader.sample_levels(table, &place.reads, work, rows);
    } else if sampler.pairs > 0 {
        let Placing { footprints, .. } = &mut *work.placing;
        quads.measure((unit, sampler), pixels, place, footprints);
        taps::spread(quads, footprints, &mut place.pairs);
        reader.sample_taps(table, place, work, rows);
    } else {
        let images = sampler.has_images().then_some(&place.images);
        locate(table, &mut place.at, images, work);
        if reader.texels(table, &place.at, &place.references, work, rows) {
            load(work.lanes, sampler.signed, wanted, rows);
        }
    }
    drop_keyed(sampler, &place.reads, work, alive);
}

impl Reader<'_> {
    /// TEX-9 to TEX-11: finds the level of detail of each lane, and what is read for it.
    #[inline(always)]
    fn choose_levels(self, table: &Table, pixels: &Pixels, place: &mut Place, quads: &mut Quads, work: &mut Workspace) {
        let Reader { unit, sampler, .. } = self;
        let (placing, count) = (&mut *work.placing, work.lanes.count());
        quads.measure((unit, sampler), pixels, place, &mut placing.of_quads);
        let (of_quads, lods) = (&placing.of_quads, &mut placing.lods);
        lods[..count].fill(lod::LEAST);
        quads.each_lane(|lane, quad| lods[lane] = of_quads[quad]);
        let Place { reads, fine, images, .. } = place;
        reads.compute_fetches((unit, table), count, fine, sampler.has_images().then_some(images), placing);
    }

    /// Samples a unit at the [located](locate) entries and writes its channels to the `wanted` rows, without subtracting the 128 of signed ones.
    /// `references` are the depths to compare with. Returns whether 128 still has to be subtracted.
    #[inline(always)]
    fn texels(
        self,
        table: &Table,
        [u, v]: &[PerLane<i32>; 2],
        references: &PerLane<u32>,
        work: &mut Workspace,
        rows: &mut [PerLane<i16>],
    ) -> bool {
        let at = [u.block(), v.block()];
        let Workspace { lanes, entries, texels: found, footprints, halves, .. } = work;
        let (lanes, entries) = (*lanes, entries.block());
        if let Texels::Halves(texels) = &table.texels {
            filter_halves(lanes, texels, self.sampler.filters, (entries, at), footprints, halves);
            self.split_halves(lanes, halves, rows);
            return false;
        }
        let (found, footprints) = (found.block_mut(), footprints.block_mut());
        let Some(of) = channels(self.wanted, rows) else { return false };
        match &table.texels {
            Texels::Halves(_) => {}
            Texels::Single(texels) => {
                fetch(lanes, texels, entries, found);
                let [red, green, blue, alpha] = of;
                unpack(lanes, found, red, green, blue, alpha);
            }
            Texels::Depths(texels, function) => {
                fetch(lanes, texels, entries, found);
                let mut passed = [true; BLOCK];
                compare(*function, references, found, &mut passed[..lanes.count()]);
                for (out, _) in of.into_iter().zip(self.wanted).filter(|(_, row)| row.is_some()) {
                    for n in 0..lanes.count() {
                        out[n] = if passed[n] { 255 } else { 0 };
                    }
                }
                return false;
            }
            Texels::One(channel, texels) => {
                fetch(lanes, texels, entries, found);
                filter_one(lanes, found, at, of[*channel]);
            }
            Texels::Footprints(texels) => {
                (self.filter)(lanes, texels, entries, at, footprints, of);
            }
        }
        true
    }

    /// TEX-17: samples all taps of the pixels, and adds them with their weights.
    #[inline(always)]
    fn sample_taps(self, table: &Table, place: &Place, work: &mut Workspace, rows: &mut [PerLane<i16>]) {
        let Reader { sampler, wanted, .. } = self;
        // Not closures: compilers do not inline them, and they lack the caller's instruction set.
        let taps = place.pairs.iter().flat_map(|pair| [(pair, 1), (pair, -1)]);
        if let Texels::Halves(texels) = &table.texels {
            let mut sums = [PerLane::from_value(0_i32), PerLane::from_value(0)];
            for (pair, side) in taps {
                let [u, v] = tap(table, &place.at, (pair, side), work);
                let Workspace { lanes, entries, footprints, halves, .. } = &mut *work;
                let at = (entries.block(), [u.block(), v.block()]);
                filter_halves(*lanes, texels, sampler.filters, at, footprints, halves);
                let weights = pair.weights.block();
                for (sums, half) in sums.iter_mut().zip(halves) {
                    for n in 0..lanes.count() {
                        sums[n] += half[n] * i32::from(weights[n]);
                    }
                }
            }
            sums.iter_mut().flat_map(|sums| sums.iter_mut()).for_each(|sum| *sum = (*sum + 128) >> 8);
            return self.split_halves(work.lanes, &sums, rows);
        }
        let mut sums = [[0_u16; BLOCK]; 4];
        for (pair, side) in taps {
            let at = tap(table, &place.at, (pair, side), work);
            self.texels(table, &at, &place.references, work, rows);
            let weights = pair.weights.block();
            for (sums, wanted) in sums.iter_mut().zip(wanted) {
                let Some(wanted) = wanted else { continue };
                let channel = rows[usize::from(wanted)].block();
                for n in 0..work.lanes.count() {
                    sums[n] += channel[n] as u16 * weights[n];
                }
            }
        }
        for (sums, wanted) in sums.iter().zip(wanted) {
            let Some(wanted) = wanted else { continue };
            let out = rows[usize::from(wanted)].block_mut();
            for n in 0..work.lanes.count() {
                out[n] = ((sums[n] + 128) >> 8) as i16;
            }
        }
        load(work.lanes, sampler.signed, wanted, rows);
    }

    /// TEX-9: samples one level, or mixes two.
    #[inline(always)]
    fn sample_levels(self, table: &Table, reads: &MipFetches, work: &mut Workspace, rows: &mut [PerLane<i16>]) {
        let (both, weights) = (self.unit.state.mip_filter == MipFilter::Linear, reads.weights.block());
        let Workspace { lanes, footprints, next, halves, .. } = work;
        let lanes = *lanes;
        if let Texels::Halves(texels) = &table.texels {
            filter_halves(lanes, texels, true, reads.of_level(0), footprints, halves);
            if both {
                let nearer = halves.clone();
                filter_halves(lanes, texels, true, reads.of_level(1), footprints, halves);
                for (half, nearer) in halves.iter_mut().zip(&nearer) {
                    for n in 0..lanes.count() {
                        half[n] = lerp(nearer[n], half[n], i32::from(weights[n]));
                    }
                }
            }
            return self.split_halves(lanes, halves, rows);
        }
        let Texels::Footprints(texels) = &table.texels else { return };
        let footprints = footprints.block_mut();
        let Some([red, green, blue, alpha]) = channels(self.wanted, rows) else { return };
        let (entries, at) = reads.of_level(0);
        (self.filter)(lanes, texels, entries, at, footprints, [red, green, blue, alpha]);
        if both {
            let (entries, at) = reads.of_level(1);
            (self.filter)(lanes, texels, entries, at, footprints, next.each_mut().map(PerLane::block_mut));
            for ((channel, next), wanted) in [red, green, blue, alpha].into_iter().zip(next).zip(self.wanted) {
                if wanted.is_some() {
                    mix(lanes, channel, next.block(), weights);
                }
            }
        }
        load(lanes, self.sampler.signed, self.wanted, rows);
    }

    /// TEX-1, TEX-18: splits 16-bit halves into bytes: A and R, G and B.
    #[inline(always)]
    fn split_halves(self, lanes: Lanes, halves: &[PerLane<i32>; 2], rows: &mut [PerLane<i16>]) {
        for (half, [high, low]) in halves.iter().map(PerLane::block).zip([[3, 0], [1, 2]]) {
            if let Some(slot) = self.wanted[low] {
                let out = rows[usize::from(slot)].block_mut();
                for n in 0..lanes.count() {
                    out[n] = (half[n] & 255) as i16;
                }
            }
            if let Some(slot) = self.wanted[high] {
                let out = rows[usize::from(slot)].block_mut();
                for n in 0..lanes.count() {
                    let byte = (half[n] >> 8) as i16;
                    out[n] = if self.sampler.signed[high] { 2 * (byte - 128) } else { byte };
                }
            }
        }
    }
}

/// SHD-1: compares references with depths.
#[inline(always)]
fn compare(function: CompareFunction, references: &[u32], depths: &[u32], passed: &mut [bool]) {
    for_each_function!(function, |function| for n in 0..passed.len() {
        passed[n] = function.passes(references[n], depths[n]);
    });
}

/// Computes the table entries at `u`, `v` on `faces`. Coordinates are in 1/256 texel, less half a texel if the unit filters. They are
/// limited to the axes.
#[inline(always)]
fn locate(table: &Table, [u, v]: &mut [PerLane<i32>; 2], faces: Option<&PerLane<u32>>, work: &mut Workspace) {
    let (u, v) = (u.block_mut(), v.block_mut());
    let (lanes, entries) = (work.lanes, work.entries.block_mut());
    let [columns, rows] = &table.axes;
    columns.reduce(&mut u[..lanes.count()]);
    rows.reduce(&mut v[..lanes.count()]);
    match faces.map(PerLane::block) {
        Some(faces) => address::<true>((table, lanes), u, v, |n| faces[n] * table.face, entries),
        None if table.axes.iter().all(Axis::repeats) => address::<false>((table, lanes), u, v, |_| 0, entries),
        None => address::<true>((table, lanes), u, v, |_| 0, entries),
    }
}

/// Locates a tap of all pixels, on one side of their centres. Returns its coordinates.
#[inline(always)]
fn tap(table: &Table, at: &[PerLane<i32>; 2], (pair, side): (&Pair, i32), work: &mut Workspace) -> [PerLane<i32>; 2] {
    let mut at = at.clone();
    for (at, offsets) in at.iter_mut().zip(&pair.offsets) {
        let (at, offsets) = (at.block_mut(), offsets.block());
        for n in 0..work.lanes.count() {
            at[n] += side * offsets[n];
        }
    }
    locate(table, &mut at, None, work);
    at
}

/// KEY-1: drops lanes whose single texel, on the only level that is read, equals the sampler's key in the compared bits.
#[inline(always)]
fn drop_keyed(sampler: &Sampler, reads: &MipFetches, work: &Workspace, alive: &mut [bool]) {
    let (Some((key, mask)), Some(table)) = (sampler.key, &sampler.table) else { return };
    let differs = |texel: u32| texel & mask != key;
    // Separate loops, because compilers do not take the choice out of one.
    if let (true, Texels::Footprints(columns) | Texels::Halves(columns)) = (sampler.mixes, &table.texels) {
        for (alive, entry) in alive.iter_mut().zip(&reads.entries[0][..work.lanes.count()]) {
            *alive &= differs(columns[*entry as usize][0]);
        }
    } else {
        for (alive, texel) in alive.iter_mut().zip(work.texels.block()) {
            *alive &= differs(*texel);
        }
    }
}

/// TEX-9: mixes two levels of a channel.
#[inline(always)]
fn mix(lanes: Lanes, channel: &mut [i16; BLOCK], next: &[i16; BLOCK], weights: &[u16; BLOCK]) {
    for n in 0..lanes.count() {
        channel[n] = lerp(channel[n] as u16, next[n] as u16, weights[n]) as i16;
    }
}

/// TEX-18: subtracts the 128 that the table adds to signed channels, and doubles them.
#[inline(always)]
fn load(lanes: Lanes, signed: [bool; 4], wanted: [Option<u16>; 4], rows: &mut [PerLane<i16>]) {
    for (signed, wanted) in signed.into_iter().zip(wanted) {
        if let (true, Some(wanted)) = (signed, wanted) {
            let out = rows[usize::from(wanted)].block_mut();
            for n in 0..lanes.count() {
                out[n] = (i32::from(out[n]) - 128).signed_texel() as i16;
            }
        }
    }
}

/// Computes entries. `LIMITS` says whether an axis has limits.
#[inline(always)]
fn address<const LIMITS: bool>(
    (table, lanes): (&Table, Lanes),
    u: &mut [i32; BLOCK],
    v: &mut [i32; BLOCK],
    face: impl Fn(usize) -> u32,
    entries: &mut [u32; BLOCK],
) {
    let ([columns, rows], pitch) = (table.axes, table.pitch);
    for n in 0..lanes.count() {
        if LIMITS {
            // Not `clamp`, because a function that can panic keeps the loop from being vectorised.
            u[n] = u[n].max(columns.low).min(columns.high);
            v[n] = v[n].max(rows.low).min(rows.high);
        }
        entries[n] = (rows.entry(v[n]) * pitch + columns.entry(u[n])) as u32 + face(n);
    }
}

/// Not inlined. A loop of its own keeps its addresses in registers, and texels need no wide vectors.
#[inline(never)]
fn fetch(lanes: Lanes, texels: &[u32], entries: &[u32; BLOCK], found: &mut [u32; BLOCK]) {
    let (entries, found) = (&entries[..lanes.count()], &mut found[..lanes.count()]);
    for (entries, found) in entries.as_chunks::<GROUP>().0.iter().zip(found.as_chunks_mut::<GROUP>().0) {
        for n in 0..GROUP {
            found[n] = texels[entries[n] as usize];
        }
    }
}

/// Filters both 16-bit halves of the footprints at entries, the one of A and R first.
#[inline(always)]
fn filter_halves(
    lanes: Lanes,
    texels: &[Column],
    linear: bool,
    (entries, at): (&[u32; BLOCK], [&[i32; BLOCK]; 2]),
    footprints: &mut PerLane<Footprint>,
    [first, second]: &mut [PerLane<i32>; 2],
) {
    fetch_footprints(lanes, texels, entries, footprints.block_mut());
    let kept = if linear { -1 } else { 0 };
    filter_half::<16>(lanes, footprints.block(), at, kept, first.block_mut());
    filter_half::<0>(lanes, footprints.block(), at, kept, second.block_mut());
}

/// Writes the channels of texels.
#[inline(always)]
fn unpack(
    lanes: Lanes,
    texels: &[u32; BLOCK],
    red: &mut [i16; BLOCK],
    green: &mut [i16; BLOCK],
    blue: &mut [i16; BLOCK],
    alpha: &mut [i16; BLOCK],
) {
    for n in 0..lanes.count() {
        red[n] = (texels[n] & 255) as i16;
        green[n] = (texels[n] >> 8 & 255) as i16;
        blue[n] = (texels[n] >> 16 & 255) as i16;
        alpha[n] = (texels[n] >> 24) as i16;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::texture::filter::{linear, nearest};

    /// A step of signed texels is a step of the same with 128 added, less 128.
    #[test]
    fn signed_channels_filter_as_unsigned_ones() {
        for n in 0..1 << 24 {
            let (w, a, b) = (n & 255, (n >> 8 & 255) - 128, (n >> 16) - 128);
            assert_eq!(lerp(a, b, w), lerp(a + 128, b + 128, w) - 128);
        }
    }

    /// An entry and its weight are TEX-5's and TEX-6's.
    #[test]
    fn entries_by_the_rules() {
        let axis = Axis { low: i32::MIN, high: i32::MAX, first: 0, mask: 63, count: 64, period: None };
        for u in -40_000..40_000_i32 {
            let (texel, weight) = linear(i64::from(u));
            let (at, w) = (axis.entry(u - 128), super::super::filter::weight(u - 128));
            assert_eq!((i64::from(at), w as i32), (texel & 63, weight));
            assert_eq!(i64::from(axis.entry(u)), nearest(i64::from(u)) & 63);
        }
    }
}
