//! ROP-1, ROP-5, ROP-6, STN-1 and DEP-2 on rows: reading, packing and writing surface words, and the tests.

use super::interpolate::depths::OUTSIDE;
use super::lanes::{BLOCK, Lanes, PerLane, Run, channels, for_each_function};
use super::shading::compiled::CompiledDraw;
use crate::plan::PlannedDraw;
use crate::rop::{stencil, surface};
use crate::state::{
    CompareFunction, StencilOperation, StencilTest, SurfaceFormat, depth_of, depth_stencil, stencil_of,
};

/// Unpacks the channels that blending reads from the surface's words.
#[inline(always)]
pub(crate) fn read(
    (draw, compiled): (&PlannedDraw, &CompiledDraw),
    lanes: Lanes,
    words: &[u32; BLOCK],
    rows: &mut [PerLane<i16>],
) {
    let Some([red, green, blue, alpha]) = channels(compiled.destination, rows) else { return };
    match draw.surface {
        SurfaceFormat::A8R8G8B8 => read_as(SurfaceFormat::A8R8G8B8, lanes, words, red, green, blue, alpha),
        SurfaceFormat::R5G6B5 => read_as(SurfaceFormat::R5G6B5, lanes, words, red, green, blue, alpha),
        other => read_as(other, lanes, words, red, green, blue, alpha),
    }
}

/// Not with all channels in an array, of which compilers would not know that they do not overlap.
#[inline(always)]
fn read_as(
    format: SurfaceFormat,
    lanes: Lanes,
    words: &[u32; BLOCK],
    red: &mut Row,
    green: &mut Row,
    blue: &mut Row,
    alpha: &mut Row,
) {
    for n in 0..lanes.count() {
        let [r, g, b, a] = surface::read(format, words[n]);
        (red[n], green[n], blue[n], alpha[n]) = (r.into(), g.into(), b.into(), a.into());
    }
}

/// A row of a block.
type Row = [i16; BLOCK];

/// Packs the stored rows into words.
#[inline(always)]
pub(crate) fn pack(
    (draw, compiled): (&PlannedDraw, &CompiledDraw),
    lanes: Lanes,
    rows: &[PerLane<i16>],
    words: &mut [u32; BLOCK],
) {
    let row = |channel: usize| rows[usize::from(compiled.stored[channel])].block();
    let of = [row(0), row(1), row(2), row(3)];
    match draw.surface {
        SurfaceFormat::A8R8G8B8 => pack_halves(SurfaceFormat::A8R8G8B8, lanes, of, words),
        SurfaceFormat::X8R8G8B8O => pack_halves(SurfaceFormat::X8R8G8B8O, lanes, of, words),
        SurfaceFormat::R5G6B5 => pack_as(SurfaceFormat::R5G6B5, lanes, of, words),
        other => pack_as(other, lanes, of, words),
    }
}

#[inline(always)]
fn pack_as(format: SurfaceFormat, lanes: Lanes, [r, g, b, a]: [&Row; 4], words: &mut [u32; BLOCK]) {
    for n in 0..lanes.count() {
        words[n] = surface::pack(format, [r[n] as u8, g[n] as u8, b[n] as u8, a[n] as u8]);
    }
}

/// Packs words of four bytes, of which G and B make the lower half: in 16 bits, halves take fewer instructions than words.
#[inline(always)]
fn pack_halves(format: SurfaceFormat, lanes: Lanes, [r, g, b, a]: [&Row; 4], words: &mut [u32; BLOCK]) {
    for n in 0..lanes.count() {
        let low = surface::pack(format, [0, g[n] as u8, b[n] as u8, 0]) as u16;
        let high = (surface::pack(format, [r[n] as u8, 0, 0, a[n] as u8]) >> 16) as u16;
        words[n] = u32::from(low) | (u32::from(high) << 16);
    }
}

/// Number of pixels that are copied at once if a run is shorter and the slices have room.
const SHORT_RUN: usize = 16;

/// Reads the words of some runs from the surface or its depth buffer. What is read past the end of a short run is overwritten by the next.
#[inline(always)]
pub(crate) fn read_runs(words: &[u32], runs: &[Run], out: &mut [u32; BLOCK]) {
    for run in runs {
        let (from, to) = (&words[run.at()..], &mut out[run.lane()..]);
        let done = run.count() <= SHORT_RUN && read_short(from, to);
        if !done {
            to[..run.count()].copy_from_slice(&from[..run.count()]);
        }
    }
}

/// Copies the words of a short run and those after it. Returns `false` if there are not so many.
#[inline(always)]
fn read_short(from: &[u32], to: &mut [u32]) -> bool {
    let (Some(from), Some(to)) = (from.first_chunk::<SHORT_RUN>(), to.first_chunk_mut()) else { return false };
    *to = *from;
    true
}

/// Writes the words of some runs to the surface or its depth buffer.
#[inline(always)]
pub(crate) fn write_runs(from: &[u32; BLOCK], runs: &[Run], words: &mut [u32]) {
    for run in runs {
        let (lane, at, count) = (run.lane(), run.at(), run.count());
        write_run::<false>(&from[lane..][..count], &from[lane..][..count], &mut words[at..][..count]);
    }
}

/// ROP-6: does the same, but keeps the bits of the mask that are not set, and the words of dropped fragments.
#[inline(always)]
pub(crate) fn merge_runs(
    (mask, lanes): (u32, Lanes),
    alive: &[bool; BLOCK],
    from: &mut [u32; BLOCK],
    kept: &mut [u32; BLOCK],
    runs: &[Run],
    words: &mut [u32],
) {
    for n in 0..lanes.count() {
        let mask = if alive[n] { mask } else { 0 };
        (from[n], kept[n]) = (from[n] & mask, !mask);
    }
    for run in runs {
        let (lane, at, count) = (run.lane(), run.at(), run.count());
        write_run::<true>(&from[lane..][..count], &kept[lane..][..count], &mut words[at..][..count]);
    }
}

/// Writes a run to the surface or its depth buffer; if it merges, it adds the bits that are kept. Most runs are short. Two copies of their ends,
/// which may overlap, need neither a call nor a branch for each pixel.
#[inline(always)]
fn write_run<const MERGES: bool>(from: &[u32], kept: &[u32], to: &mut [u32]) {
    match from.len() {
        1 => write_ends::<MERGES, 1>(from, kept, to),
        2..4 => write_ends::<MERGES, 2>(from, kept, to),
        4..8 => write_ends::<MERGES, 4>(from, kept, to),
        8..=SHORT_RUN => write_ends::<MERGES, 8>(from, kept, to),
        _ if MERGES => {
            for ((to, from), kept) in to.iter_mut().zip(from).zip(kept) {
                *to = (*to & kept) | from;
            }
        }
        _ => to.copy_from_slice(from),
    }
}

/// Writes the first and the last `COUNT` words.
#[inline(always)]
fn write_ends<const MERGES: bool, const COUNT: usize>(from: &[u32], kept: &[u32], to: &mut [u32]) {
    for start in [0, from.len() - COUNT] {
        let (from, kept, to) = (&from[start..][..COUNT], &kept[start..][..COUNT], &mut to[start..][..COUNT]);
        for n in 0..COUNT {
            to[n] = if MERGES { (to[n] & kept[n]) | from[n] } else { from[n] };
        }
    }
}

/// Returns the 64-bit words that have bits of the given pixels.
#[inline(always)]
fn words(at: usize, count: usize) -> std::ops::Range<usize> {
    at / 64..(at + count - 1) / 64 + 1
}

/// Returns the bits of a 64-bit word that belong to the given pixels, at least one of which lies in the word.
#[inline(always)]
fn bits(word: usize, at: usize, count: usize) -> u64 {
    let (first, last) = (word * 64, word * 64 + 63);
    let low = if at > first { u64::MAX << (at - first) } else { u64::MAX };
    let end = at + count - 1;
    if end < last { low & (u64::MAX >> (last - end)) } else { low }
}

/// Flips the bits of the pixels of some runs.
#[inline(always)]
pub(crate) fn mark(taken: &mut [u64], runs: &[Run]) {
    for run in runs {
        let (at, count) = (run.at(), run.count());
        for word in words(at, count) {
            taken[word] ^= bits(word, at, count);
        }
    }
}

/// Returns whether a bit of the given pixels is set.
#[inline(always)]
pub(crate) fn is_marked(taken: &[u64], at: usize, count: usize) -> bool {
    words(at, count).any(|word| taken[word] & bits(word, at, count) != 0)
}

/// Returns whether all lanes are true. It has no branches, because they usually are.
#[inline(always)]
pub(crate) fn all(alive: &[bool]) -> bool {
    alive.iter().fold(true, |all, alive| all & alive)
}

/// Compares rows, and drops fragments that fail.
#[inline(always)]
pub(crate) fn test<T: Copy + PartialOrd>(
    function: CompareFunction,
    incoming: impl Fn(usize) -> T,
    stored: impl Fn(usize) -> T,
    alive: &mut [bool],
) {
    for_each_function!(function, |function| for n in 0..alive.len() {
        alive[n] &= function.passes(incoming(n), stored(n));
    });
}

/// STN-1 and DEP-2: drops fragments and updates the words of depth and stencil. Returns whether any word may have changed.
#[inline(always)]
pub(crate) fn test_depth_stencil(
    draw: &PlannedDraw,
    incoming: &[u32; BLOCK],
    memory: &mut [u32; BLOCK],
    alive: &mut [bool; BLOCK],
) -> bool {
    let writes_depth = draw.depth_test.is_some_and(|test| test.write);
    drop_outside(draw, incoming, alive);
    let Some(state) = &draw.stencil_test else {
        test_depth(draw, incoming, memory, alive);
        return writes_depth;
    };
    test_stencil(state, draw, incoming, memory, alive) || writes_depth
}

/// DEP-2 without a stencil test: drops fragments, and stores the depths of those that are left.
#[inline(always)]
pub(crate) fn test_early(draw: &PlannedDraw, incoming: &[u32], memory: &mut [u32], alive: &mut [bool]) {
    drop_outside(draw, incoming, alive);
    test_depth(draw, incoming, memory, alive);
}

/// DEP-4: drops fragments outside the depth range.
#[inline(always)]
fn drop_outside(draw: &PlannedDraw, incoming: &[u32], alive: &mut [bool]) {
    if draw.depth_test.is_some_and(|test| test.drops_by_range()) {
        for (alive, incoming) in alive.iter_mut().zip(incoming) {
            *alive &= *incoming != OUTSIDE;
        }
    }
}

/// DEP-2: drops fragments, and stores the depths of those that are left.
#[inline(always)]
fn test_depth(draw: &PlannedDraw, incoming: &[u32], memory: &mut [u32], alive: &mut [bool]) {
    // Not a reference to the test, because compilers would not know that nothing is stored there.
    let Some((function, writes)) = draw.depth_test.as_ref().map(|test| (test.function, test.write)) else { return };
    let (incoming, memory) = (&incoming[..alive.len()], &mut memory[..alive.len()]);
    for_each_function!(function, |function| for n in 0..alive.len() {
        let old = memory[n];
        let passes = alive[n] & function.passes(incoming[n], depth_of(old));
        // Not a choice of words, because compilers turn that into stores of chosen lanes, which are slow on some processors.
        let kept = if passes & writes { depth_stencil(0, u8::MAX) } else { u32::MAX };
        memory[n] = (old & kept) | (incoming[n] & !kept);
        alive[n] = passes;
    });
}

/// STN-1, around the depth test. Returns whether a stencil may have changed.
#[inline(always)]
fn test_stencil(
    state: &StencilTest,
    draw: &PlannedDraw,
    incoming: &[u32; BLOCK],
    memory: &mut [u32; BLOCK],
    alive: &mut [bool; BLOCK],
) -> bool {
    let tested = *alive;
    let reference = state.reference & state.mask;
    test(state.function, |_| reference, |n| stencil_of(memory[n]) & state.mask, alive);
    let passed = *alive;
    test_depth(draw, incoming, memory, alive);
    if !stencil::writes(state) {
        return false;
    }
    let stencils = memory.map(stencil_of);
    let mut written = stencils;
    for (operation, outcome) in
        [(state.fail, (false, false)), (state.depth_fail, (true, false)), (state.pass, (true, true))]
    {
        let new = operate(state, operation, &stencils);
        for n in 0..BLOCK {
            written[n] = if tested[n] && (passed[n], alive[n]) == outcome { new[n] } else { written[n] };
        }
    }
    for (word, stencil) in memory.iter_mut().zip(written) {
        *word = depth_stencil(depth_of(*word), stencil);
    }
    true
}

/// Applies a stencil operation, with a loop for each operation.
#[inline(always)]
fn operate(test: &StencilTest, operation: StencilOperation, stencils: &[u8; BLOCK]) -> [u8; BLOCK] {
    use StencilOperation::*;
    macro_rules! each {
        ($($name:ident)*) => {
            match operation {
                $($name => stencils.map(|stored| stencil::written(test, $name, stored)),)*
            }
        };
    }
    each!(Keep Zero Replace IncrementSaturate DecrementSaturate Invert Increment Decrement)
}

#[cfg(test)]
mod tests {
    use super::super::lattice;
    use super::*;
    use crate::random::Random;
    use crate::state::Named;

    /// Words of all formats, of bytes at the ends of what fields keep.
    #[test]
    fn words_are_packed_and_read_by_the_rule() {
        let mut random = Random::seeded(3);
        let mut byte = || i16::from(lattice::byte(&mut || random.bits() as u32));
        for _ in 0..64 {
            let [r, g, b, a]: [Row; 4] = std::array::from_fn(|_| std::array::from_fn(|_| byte()));
            for format in SurfaceFormat::ALL.iter().copied() {
                let (lanes, of, mut words) = (Lanes::default(), [&r, &g, &b, &a], [0; BLOCK]);
                match format {
                    SurfaceFormat::A8R8G8B8 | SurfaceFormat::X8R8G8B8O => pack_halves(format, lanes, of, &mut words),
                    _ => pack_as(format, lanes, of, &mut words),
                }
                for n in 0..BLOCK {
                    let bytes = of.map(|row| row[n] as u8);
                    assert_eq!(words[n], surface::pack(format, bytes), "{format:?} {bytes:?}");
                }
                let mut channels = [[0; BLOCK]; 4];
                let [r, g, b, a] = &mut channels;
                read_as(format, lanes, &words, r, g, b, a);
                for n in 0..BLOCK {
                    let read = surface::read(format, words[n]).map(i16::from);
                    assert_eq!(channels.each_ref().map(|row| row[n]), read, "{format:?} {:#x}", words[n]);
                }
            }
        }
    }

    /// Runs of all lengths: those of a few words are copied by their ends.
    #[test]
    fn runs_touch_their_words_alone() {
        let mut random = Random::seeded(4);
        for count in 1..=40_usize {
            for mask in [u32::MAX, 0, 0x00ff_ffff, 0x8000_0001, 0xff00_0000] {
                let next = &mut || random.bits() as u32;
                let (lane, at) = (next() as usize % (BLOCK - count), next() as usize % 60);
                let mut from = std::array::from_fn::<_, BLOCK, _>(|_| next());
                let before: Vec<u32> = (0..128).map(|_| next()).collect();
                let alive = std::array::from_fn(|_| next() % 4 != 0);
                let runs = [Run::new(lane, at as u32, count)];
                let mut wanted = before.clone();
                wanted[at..at + count].copy_from_slice(&from[lane..lane + count]);
                let mut words = before.clone();
                write_runs(&from, &runs, &mut words);
                assert_eq!(words, wanted, "{count}");
                for n in 0..count {
                    let written = if alive[lane + n] { mask } else { 0 };
                    wanted[at + n] = before[at + n] & !written | from[lane + n] & written;
                }
                let mut words = before.clone();
                merge_runs((mask, Lanes::default()), &alive, &mut from, &mut [0; BLOCK], &runs, &mut words);
                assert_eq!(words, wanted, "{count} {mask:#x}");
            }
        }
    }
}
