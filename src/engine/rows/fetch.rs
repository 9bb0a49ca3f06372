//! TEX-5 to TEX-8 on rows: entries of a table, texels, the filter.

use super::BLOCK;
use super::kernels::{LANES, Row};
use super::table::{Axis, Table, Texels};
use crate::number::{Lane, Two};
use crate::texture::filter::bilinear;

/// One number for each pixel of a block.
pub(super) type Numbers<T> = [T; LANES];

/// What a fetch works in.
#[derive(Clone, Debug)]
pub(super) struct Workspace {
    entries: [u32; BLOCK],
    along: [u32; BLOCK],
    down: [u32; BLOCK],
    upper: [[u32; 2]; BLOCK],
    lower: [[u32; 2]; BLOCK],
}

impl Default for Workspace {
    fn default() -> Self {
        Workspace {
            entries: [0; BLOCK],
            along: [0; BLOCK],
            down: [0; BLOCK],
            upper: [[0; 2]; BLOCK],
            lower: [[0; 2]; BLOCK],
        }
    }
}

/// Samples a unit at `u`, `v` (1/256 texel; less half a texel where it is filtered) on `faces`, and leaves the channels in `rows`, each in
/// its own where that is wanted.
#[inline(always)]
pub(super) fn sample(
    table: &Table,
    [u, v]: &[Numbers<i32>; 2],
    faces: Option<&Numbers<u32>>,
    signed: [bool; 4],
    wanted: [Option<u16>; 4],
    work: &mut Workspace,
    rows: &mut [Row],
) {
    let Workspace { entries, along, down, upper, lower } = work;
    if table.axes[0].repeats() && table.axes[1].repeats() {
        address::<false>(&table.axes, u, v, entries, along, down);
    } else {
        address::<true>(&table.axes, u, v, entries, along, down);
    }
    if let Some(faces) = faces {
        for (entry, face) in entries.iter_mut().zip(faces) {
            *entry += *face * table.face;
        }
    }
    let kind = wanted.iter().rposition(Option::is_some).unwrap_or(0);
    // What nobody wants goes to the first rows.
    let slot = |n: usize| wanted[n].map_or(n, usize::from);
    let Ok([red, green, blue, alpha]) = rows.get_disjoint_mut([slot(0), slot(1), slot(2), slot(3)]) else { return };
    let (red, green, blue, alpha) = (red.block_mut(), green.block_mut(), blue.block_mut(), alpha.block_mut());
    match &table.texels {
        Texels::Single(texels) => {
            for n in 0..BLOCK {
                along[n] = texels[entries[n] as usize];
            }
            unpack(along, red, green, blue, alpha);
        }
        Texels::Pairs(texels) => {
            fetch(texels, table.axes[0].count as usize, entries, upper, lower);
            match kind {
                0 => filter::<1>(upper, lower, along, down, red, green, blue, alpha),
                1 | 2 => filter::<3>(upper, lower, along, down, red, green, blue, alpha),
                _ => filter::<4>(upper, lower, along, down, red, green, blue, alpha),
            }
        }
    }
    for (n, signed) in signed.into_iter().enumerate() {
        if signed {
            // TEX-18: the 128 that the table added is taken off again.
            for out in rows[slot(n)].block_mut() {
                *out = (i32::from(*out) - 128).signed_texel() as i16;
            }
        }
    }
}

/// The entry of a coordinate along an axis, and the weight of the next one.
#[inline(always)]
fn entry(axis: &Axis, coordinate: i32, limits: bool) -> (i32, u32) {
    let limited = if limits { coordinate.clamp(axis.low, axis.high) } else { coordinate };
    (((limited >> 8) - axis.first) & axis.mask, (limited & 255) as u32)
}

#[inline(always)]
fn address<const LIMITS: bool>(
    [columns, rows]: &[Axis; 2],
    u: &Numbers<i32>,
    v: &Numbers<i32>,
    entries: &mut [u32; BLOCK],
    along: &mut [u32; BLOCK],
    down: &mut [u32; BLOCK],
) {
    let (columns, rows) = (*columns, *rows);
    for n in 0..BLOCK {
        let ((x, wx), (y, wy)) = (entry(&columns, u[n], LIMITS), entry(&rows, v[n], LIMITS));
        entries[n] = (y * columns.count + x) as u32;
        along[n] = wx;
        down[n] = wy;
    }
}

/// The texels of both rows of the footprint. One length serves both, so that one comparison does.
#[inline(always)]
fn fetch(
    texels: &[[u32; 2]],
    pitch: usize,
    entries: &[u32; BLOCK],
    upper: &mut [[u32; 2]; BLOCK],
    lower: &mut [[u32; 2]; BLOCK],
) {
    let count = texels.len() - pitch;
    let (here, below) = (&texels[..count], &texels[pitch..][..count]);
    for ((entry, upper), lower) in entries.iter().zip(upper).zip(lower) {
        *upper = here[*entry as usize];
        *lower = below[*entry as usize];
    }
}

/// TEX-6 of the first `COUNT` channels, two at a time.
#[inline(always)]
#[allow(clippy::too_many_arguments, reason = "each result apart, so that the compiler sees that none overlaps another")]
fn filter<const COUNT: usize>(
    upper: &[[u32; 2]; BLOCK],
    lower: &[[u32; 2]; BLOCK],
    along: &[u32; BLOCK],
    down: &[u32; BLOCK],
    red: &mut [i16; BLOCK],
    green: &mut [i16; BLOCK],
    blue: &mut [i16; BLOCK],
    alpha: &mut [i16; BLOCK],
) {
    for n in 0..BLOCK {
        let ([a, b], [c, d]) = (upper[n], lower[n]);
        let even = bilinear([first(a), first(b), first(c), first(d)], along[n], down[n], |v| v);
        red[n] = (even.0 & 255) as i16;
        if COUNT > 1 {
            let odd = bilinear([first(a >> 8), first(b >> 8), first(c >> 8), first(d >> 8)], along[n], down[n], |v| v);
            green[n] = (odd.0 & 255) as i16;
            blue[n] = (even.0 >> 16) as i16;
            if COUNT > 3 {
                alpha[n] = (odd.0 >> 16) as i16;
            }
        }
    }
}

/// R and B of a texel; of one shifted by 8, G and A.
#[inline(always)]
fn first(texel: u32) -> Two {
    Two(texel & 0x00ff_00ff)
}

#[inline(always)]
fn unpack(
    texels: &[u32; BLOCK],
    red: &mut [i16; BLOCK],
    green: &mut [i16; BLOCK],
    blue: &mut [i16; BLOCK],
    alpha: &mut [i16; BLOCK],
) {
    for n in 0..BLOCK {
        let byte = |shift: u32| (texels[n] >> shift & 255) as i16;
        (red[n], green[n], blue[n], alpha[n]) = (byte(0), byte(8), byte(16), byte(24));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::texture::filter::{lerp, linear, nearest};

    /// A step of signed texels is a step of the same with 128 added, less 128.
    #[test]
    fn signed_channels_filter_as_unsigned_ones() {
        for w in 0..=255 {
            for a in -128..=127_i32 {
                for b in -128..=127_i32 {
                    let step = |a: i32, b: i32| lerp(a, b, w);
                    assert_eq!(step(a, b), step(a + 128, b + 128) - 128);
                }
            }
        }
    }

    /// An entry and its weight are TEX-5's and TEX-6's.
    #[test]
    fn entries_by_the_rules() {
        let axis = Axis { low: i32::MIN, high: i32::MAX, first: 0, mask: 63, count: 64 };
        for u in -40_000..40_000_i32 {
            let (texel, weight) = linear(i64::from(u));
            let (at, w) = entry(&axis, u - 128, false);
            assert_eq!((i64::from(at), w as i32), (texel & 63, weight));
            assert_eq!(i64::from(entry(&axis, u, false).0), nearest(i64::from(u)) & 63);
        }
    }
}
