//! TEX-6 on rows: footprints and their filter.

use super::table::Column;
use crate::engine::rows::lanes::{BLOCK, Lanes};
use crate::number::Swar2;
use crate::texture::filter::{bilinear, lerp};

/// The upper and the lower left texel, and the upper and the lower right one.
pub(crate) type Footprint = [u32; 4];

/// TEX-6 of four channels, compiled for an instruction set: columns of texels, the entries that are read, u and v, scratch space, and the channels.
pub(crate) type Filter =
    fn(Lanes, &[Column], &[u32; BLOCK], [&[i32; BLOCK]; 2], &mut [Footprint; BLOCK], [&mut [i16; BLOCK]; 4]);

/// Number of texels or footprints that are fetched at a time. The speed of a loop over one or two depends on its place in memory.
pub(crate) const GROUP: usize = 4;

/// Returns the left and the right columns of all footprints. Both slices have the same length, so that one bounds check serves both.
fn sides(columns: &[Column]) -> Option<(&[Column], &[Column])> {
    let count = columns.len().checked_sub(1)?;
    Some((&columns[..count], &columns[1..]))
}

/// Fetches footprints.
#[inline(never)]
pub(crate) fn fetch_footprints(
    lanes: Lanes,
    columns: &[Column],
    entries: &[u32; BLOCK],
    found: &mut [Footprint; BLOCK],
) {
    let (entries, found) = (&entries[..lanes.count()], &mut found[..lanes.count()]);
    let Some((left, right)) = sides(columns) else { return };
    let (entries, found) = (entries.as_chunks::<GROUP>().0, found.as_chunks_mut::<GROUP>().0);
    for (entries, found) in entries.iter().zip(found) {
        for n in 0..GROUP {
            let at = entries[n] as usize;
            let ([a, c], [b, d]) = (left[at], right[at]);
            found[n] = [a, c, b, d];
        }
    }
}

/// TEX-6 of four channels by the vectors that the compiler finds.
#[inline(always)]
pub(crate) fn filter<const FMA: bool>(
    lanes: Lanes,
    columns: &[Column],
    entries: &[u32; BLOCK],
    [u, v]: [&[i32; BLOCK]; 2],
    footprints: &mut [Footprint; BLOCK],
    [red, green, blue, alpha]: [&mut [i16; BLOCK]; 4],
) {
    fetch_footprints(lanes, columns, entries, footprints);
    two_at_a_time(lanes, footprints, u, v, red, green, blue, alpha);
}

/// TEX-6 of four channels, two at a time.
#[inline(always)]
#[allow(clippy::too_many_arguments, reason = "each result apart, so that the compiler sees that none overlaps another")]
fn two_at_a_time(
    lanes: Lanes,
    footprints: &[Footprint; BLOCK],
    u: &[i32; BLOCK],
    v: &[i32; BLOCK],
    red: &mut [i16; BLOCK],
    green: &mut [i16; BLOCK],
    blue: &mut [i16; BLOCK],
    alpha: &mut [i16; BLOCK],
) {
    for n in 0..lanes.count() {
        let [a, c, b, d] = footprints[n];
        let (along, down) = (weight(u[n]), weight(v[n]));
        let even = bilinear([first(a), first(b), first(c), first(d)], along, down, |v| v);
        let odd = bilinear([first(a >> 8), first(b >> 8), first(c >> 8), first(d >> 8)], along, down, |v| v);
        (red[n], blue[n]) = ((even.0 & 255) as i16, (even.0 >> 16) as i16);
        (green[n], alpha[n]) = ((odd.0 & 255) as i16, (odd.0 >> 16) as i16);
    }
}

/// TEX-6 of a single channel: both rows together along u, then along v.
#[inline(always)]
pub(crate) fn filter_one(lanes: Lanes, texels: &[u32; BLOCK], [u, v]: [&[i32; BLOCK]; 2], out: &mut [i16; BLOCK]) {
    for n in 0..lanes.count() {
        let rows = lerp(first(texels[n]), first(texels[n] >> 8), weight(u[n]));
        out[n] = lerp(Swar2(rows.0 & 255), Swar2(rows.0 >> 16), weight(v[n])).0 as i16;
    }
}

/// TEX-6 of a 16-bit half that begins at bit `SHIFT`. `kept` masks the weights.
#[inline(always)]
pub(crate) fn filter_half<const SHIFT: u32>(
    lanes: Lanes,
    footprints: &[Footprint; BLOCK],
    [u, v]: [&[i32; BLOCK]; 2],
    kept: i32,
    out: &mut [i32; BLOCK],
) {
    let half = |texel: u32| (texel >> SHIFT & 0xffff) as i32;
    for n in 0..lanes.count() {
        let [a, c, b, d] = footprints[n];
        let (along, down) = (weight(u[n]) as i32 & kept, weight(v[n]) as i32 & kept);
        out[n] = bilinear([half(a), half(b), half(c), half(d)], along, down, |v| v);
    }
}

/// Returns R and B of a texel, or G and A if it is shifted by 8; also the left and right texels of a single-channel footprint.
#[inline(always)]
fn first(texel: u32) -> Swar2 {
    Swar2(texel & 0x00ff_00ff)
}

/// Returns the weight of the next entry.
#[inline(always)]
pub(crate) fn weight(coordinate: i32) -> u32 {
    (coordinate & 255) as u32
}

/// The filter of four channels in 16-bit lanes. A step is a + (b - a) w / 256, rounded, and there is an instruction that multiplies and
/// rounds 16-bit numbers, which compilers do not find. Its loop also fetches the texels: some pixels wait for memory while others are computed.
#[cfg(target_arch = "x86_64")]
pub(crate) mod x86 {
    use super::{Column, Footprint, sides};
    use crate::engine::rows::lanes::{BLOCK, Lanes};
    use multiversion::target;
    use std::arch::x86_64::*;

    /// Number of footprints that are filtered at a time.
    const STEP: usize = 16;

    /// Defines a [filter](super::Filter).
    macro_rules! filter {
        ($name:ident, $target:literal, $steps:ident) => {
            #[target($target)]
            pub(crate) fn $name(
                lanes: Lanes,
                columns: &[Column],
                entries: &[u32; BLOCK],
                [u, v]: [&[i32; BLOCK]; 2],
                _: &mut [Footprint; BLOCK],
                [red, green, blue, alpha]: [&mut [i16; BLOCK]; 4],
            ) {
                let (red, green) = (red.as_chunks_mut::<STEP>().0, green.as_chunks_mut::<STEP>().0);
                let (blue, alpha) = (blue.as_chunks_mut::<STEP>().0, alpha.as_chunks_mut::<STEP>().0);
                let Some(columns) = sides(columns) else { return };
                let entries = entries.as_chunks::<STEP>().0;
                let (u, v) = (u.as_chunks::<STEP>().0, v.as_chunks::<STEP>().0);
                for n in 0..lanes.count() / STEP {
                    let outs = [&mut red[n], &mut green[n], &mut blue[n], &mut alpha[n]];
                    $steps(columns, &entries[n], &u[n], &v[n], outs);
                }
            }
        };
    }
    filter!(filter_256, "x86_64+avx+avx2+sse3+sse4.1+sse4.2+ssse3", step_256);
    filter!(filter_512, "x86_64+avx+avx2+avx512bw+avx512f+avx512vl+f16c+fma+sse3+sse4.1+sse4.2+ssse3", step_512);

    /// Filters in two halves, of which each texel of the corners fills a vector.
    #[target_feature(enable = "avx2")]
    #[inline]
    fn step_256(
        columns: (&[Column], &[Column]),
        entries: &[u32; STEP],
        u: &[i32; STEP],
        v: &[i32; STEP],
        [red, green, blue, alpha]: [&mut [i16; STEP]; 4],
    ) {
        let (bytes, words) = (_mm256_set1_epi32(0x00ff_00ff), _mm256_set1_epi32(0xffff));
        let twice = _mm256_broadcastsi128_si256(twice());
        let step = |a, b, weight| _mm256_add_epi16(a, _mm256_mulhrs_epi16(_mm256_sub_epi16(b, a), weight));
        // R and B, and G and A.
        let (mut even, mut odd) = ([_mm256_setzero_si256(); 2], [_mm256_setzero_si256(); 2]);
        for half in 0..2 {
            // Four vectors of the texels at the same corner.
            // The first four pixels fill the lower half.
            let two = |n: usize| {
                let n = 8 * half + n;
                _mm256_set_m128i(fetch(columns, entries[n + 4]), fetch(columns, entries[n]))
            };
            let pairs = [0, 1, 2, 3].map(two);
            let left = [0, 2].map(|n| _mm256_unpacklo_epi32(pairs[n], pairs[n + 1]));
            let right = [0, 2].map(|n| _mm256_unpackhi_epi32(pairs[n], pairs[n + 1]));
            let (a, c) = (_mm256_unpacklo_epi64(left[0], left[1]), _mm256_unpackhi_epi64(left[0], left[1]));
            let (b, d) = (_mm256_unpacklo_epi64(right[0], right[1]), _mm256_unpackhi_epi64(right[0], right[1]));
            // In 32,768ths.
            let weights = |of: &[i32; STEP]| {
                let two = |n: usize| pair(of.as_chunks::<2>().0[4 * half + n].map(|n| n as u32));
                let [a, b, c, d] = [0, 1, 2, 3].map(two);
                _mm256_srli_epi16::<1>(_mm256_shuffle_epi8(_mm256_setr_epi64x(a, b, c, d), twice))
            };
            let (along, down) = (weights(u), weights(v));
            let filtered = |[a, b, c, d]: [__m256i; 4]| step(step(a, b, along), step(c, d, along), down);
            even[half] = filtered([a, b, c, d].map(|texels| _mm256_and_si256(texels, bytes)));
            odd[half] = filtered([a, b, c, d].map(|texels| _mm256_srli_epi16::<8>(texels)));
        }
        // Packing leaves fours in the order 0 2 1 3.
        let pack = |[one, other]: [__m256i; 2]| _mm256_permute4x64_epi64::<0xd8>(_mm256_packus_epi32(one, other));
        let low = |of: [__m256i; 2]| pack(of.map(|of| _mm256_and_si256(of, words)));
        let high = |of: [__m256i; 2]| pack(of.map(|of| _mm256_srli_epi32::<16>(of)));
        for (channel, out) in [low(even), low(odd), high(even), high(odd)].into_iter().zip([red, green, blue, alpha]) {
            store(channel, out);
        }
    }

    /// Filters in vectors that hold a texel of each corner.
    #[target_feature(enable = "avx512f,avx512bw")]
    #[inline]
    fn step_512(
        columns: (&[Column], &[Column]),
        entries: &[u32; STEP],
        u: &[i32; STEP],
        v: &[i32; STEP],
        [red, green, blue, alpha]: [&mut [i16; STEP]; 4],
    ) {
        // Where the low and the high words of the pixels are.
        const WORDS: [i64; 8] = {
            let (mut words, mut n) = ([0; 8], 0);
            while n < 32 {
                let at = 2 * (n % 16) + n / 16;
                words[n / 4] |= (at as i64) << (16 * (n % 4));
                n += 1;
            }
            words
        };
        let (bytes, words) = (_mm512_set1_epi32(0x00ff_00ff), load_512(WORDS));
        let twice = _mm512_broadcast_i32x4(twice());
        let step = |a, b, weight| _mm512_add_epi16(a, _mm512_mulhrs_epi16(_mm512_sub_epi16(b, a), weight));
        // Four vectors of the texels at the same corner. Each quarter holds one of four pixels side by side.
        let four = |n: usize| {
            let [low, high] =
                [n, n + 8].map(|n| _mm256_set_m128i(fetch(columns, entries[n + 4]), fetch(columns, entries[n])));
            _mm512_inserti64x4::<1>(_mm512_castsi256_si512(low), high)
        };
        let fours = [0, 1, 2, 3].map(four);
        let left = [0, 2].map(|n| _mm512_unpacklo_epi32(fours[n], fours[n + 1]));
        let right = [0, 2].map(|n| _mm512_unpackhi_epi32(fours[n], fours[n + 1]));
        let (a, c) = (_mm512_unpacklo_epi64(left[0], left[1]), _mm512_unpackhi_epi64(left[0], left[1]));
        let (b, d) = (_mm512_unpacklo_epi64(right[0], right[1]), _mm512_unpackhi_epi64(right[0], right[1]));
        // In 32,768ths.
        let weights = |of: &[i32; STEP]| {
            let two = |n: usize| pair(of.as_chunks::<2>().0[n].map(|n| n as u32));
            _mm512_srli_epi16::<1>(_mm512_shuffle_epi8(load_512([0, 1, 2, 3, 4, 5, 6, 7].map(two)), twice))
        };
        let (along, down) = (weights(u), weights(v));
        let filtered = |[a, b, c, d]: [__m512i; 4]| {
            _mm512_permutexvar_epi16(words, step(step(a, b, along), step(c, d, along), down))
        };
        let even = filtered([a, b, c, d].map(|texels| _mm512_and_si512(texels, bytes)));
        let odd = filtered([a, b, c, d].map(|texels| _mm512_srli_epi16::<8>(texels)));
        for (channels, low, high) in [(even, red, blue), (odd, green, alpha)] {
            store(_mm512_castsi512_si256(channels), low);
            store(_mm512_extracti64x4_epi64::<1>(channels), high);
        }
    }

    /// Returns the footprint at an entry.
    #[target_feature(enable = "sse2")]
    #[inline]
    fn fetch((left, right): (&[Column], &[Column]), entry: u32) -> __m128i {
        let at = entry as usize;
        _mm_set_epi64x(pair(right[at]), pair(left[at]))
    }

    /// Joins two words, the first of which becomes the lower.
    fn pair([low, high]: [u32; 2]) -> i64 {
        i64::from(low) | i64::from(high) << 32
    }

    // Vectors are loaded and stored element by element, which compilers turn into one instruction: to do it by pointers would be unsafe.

    /// Returns, for each pair of weights, where the low bytes of four numbers are, twice each, as high bytes.
    #[target_feature(enable = "sse2")]
    #[inline]
    fn twice() -> __m128i {
        _mm_setr_epi8(-1, 0, -1, 0, -1, 4, -1, 4, -1, 8, -1, 8, -1, 12, -1, 12)
    }

    #[target_feature(enable = "avx512f")]
    #[inline]
    fn load_512([a, b, c, d, e, f, g, h]: [i64; 8]) -> __m512i {
        _mm512_setr_epi64(a, b, c, d, e, f, g, h)
    }

    #[target_feature(enable = "avx2")]
    #[inline]
    fn store(numbers: __m256i, out: &mut [i16; STEP]) {
        macro_rules! each {
            ($($n:literal)*) => {
                $(out[$n] = _mm256_extract_epi16::<$n>(numbers) as i16;)*
            };
        }
        each!(0 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::Isa;
    use crate::state::Named;

    /// Filters of all kinds against the rule: every weight, with corners of which many are 0 or 255.
    #[test]
    fn footprints_by_the_rule() {
        let mut random = crate::random::Random::seeded(0x5851_f42d_4c95_7f2d);
        for round in 0..2048_i32 {
            let mut texel = || {
                let bits = random.bits();
                let extreme = (bits >> 32) as u32 & 0x0101_0101;
                let chosen = (bits >> 40) as u32 & 0x0101_0101;
                (bits as u32 & !(extreme * 255)) | ((extreme & chosen) * 255)
            };
            let footprints = std::array::from_fn::<_, BLOCK, _>(|_| [texel(), texel(), texel(), texel()]);
            let columns: Vec<Column> = footprints.iter().flat_map(|[a, c, b, d]| [[*a, *c], [*b, *d]]).collect();
            let entries = std::array::from_fn(|n| 2 * n as u32);
            let u = std::array::from_fn(|n| n as i32 + 256 * (round - 1000));
            let v = std::array::from_fn(|n| (n as i32 + round) ^ 0x55);
            let out = Isa::ALL.iter().filter_map(|isa| isa.kernels()).map(|kernels| {
                let (mut scratch, mut out) = ([[0; 4]; BLOCK], [[0; BLOCK]; 4]);
                (kernels.filter)(Lanes::default(), &columns, &entries, [&u, &v], &mut scratch, out.each_mut());
                (kernels.isa, out)
            });
            let out: Vec<_> = out.collect();
            for n in 0..BLOCK {
                let [a, c, b, d] = footprints[n];
                for channel in 0..4 {
                    let byte = |texel: u32| i32::from(texel.to_le_bytes()[channel]);
                    let wanted = bilinear([a, b, c, d].map(byte), u[n] & 255, v[n] & 255, |v| v) as i16;
                    for (isa, channels) in &out {
                        assert_eq!(channels[channel][n], wanted, "{isa:?} {n} {channel}");
                    }
                }
            }
        }
    }
}
