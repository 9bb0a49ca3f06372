//! The lanes of a block: one number for each of up to 384 pixels, and the arithmetic that loops over them use.
#![allow(clippy::float_arithmetic, reason = "floors and roundings to whole numbers, which are exact")]

use crate::raster::doubles::lost_by_sum;
use crate::raster::interpolate::COORDINATE_LIMIT;
use std::ops::{Deref, DerefMut};

/// Number of pixels of a block.
pub(crate) const BLOCK: usize = 384;

/// Number of lanes of a step. Loops run over whole steps, so that lanes past their end may be written.
pub(crate) const STEP: usize = 16;

/// Number of lanes of a row: a block, and room for steps past its end. A multiple of a cache line.
pub(crate) const LANES: usize = BLOCK + 2 * STEP;

/// The lanes of a block that are computed, in whole parts: many blocks of small draws are not full.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Lanes(usize);

/// Number of lanes of a part. Parts fill a block, and hold whole vectors of all types.
const PART: usize = 64;
const _: () = assert!(BLOCK.is_multiple_of(PART) && PART.is_multiple_of(STEP));

impl Lanes {
    /// Returns the parts that hold the first lanes.
    #[inline(always)]
    pub(crate) fn first(count: usize) -> Lanes {
        Lanes(count.div_ceil(PART))
    }

    /// Returns the number of lanes.
    #[inline(always)]
    pub(crate) fn count(self) -> usize {
        self.0.min(BLOCK / PART) * PART
    }
}

impl Default for Lanes {
    fn default() -> Self {
        Lanes::first(BLOCK)
    }
}

/// One number for each pixel of a block. Aligned, so that no vector crosses a cache line.
#[derive(Clone, Debug)]
#[repr(align(64))]
pub(crate) struct PerLane<T>(pub(super) [T; LANES]);

impl<T: Copy> PerLane<T> {
    pub(crate) fn from_value(value: T) -> PerLane<T> {
        PerLane([value; LANES])
    }

    /// Returns the lanes of the block.
    #[inline(always)]
    pub(crate) fn block(&self) -> &[T; BLOCK] {
        self.0.first_chunk().unwrap_or_else(|| unreachable!("a row is longer than a block"))
    }

    /// Returns the lanes of the block, mutable.
    #[inline(always)]
    pub(crate) fn block_mut(&mut self) -> &mut [T; BLOCK] {
        self.0.first_chunk_mut().unwrap_or_else(|| unreachable!("a row is longer than a block"))
    }
}

impl<T: Copy + Default> Default for PerLane<T> {
    fn default() -> Self {
        PerLane::from_value(T::default())
    }
}

impl<T> Deref for PerLane<T> {
    type Target = [T];

    #[inline(always)]
    fn deref(&self) -> &[T] {
        &self.0
    }
}

impl<T> DerefMut for PerLane<T> {
    #[inline(always)]
    fn deref_mut(&mut self) -> &mut [T] {
        &mut self.0
    }
}

/// Returns the rows of channels. Those that nobody reads are the spare rows, which are the first.
#[inline(always)]
pub(crate) fn channels(wanted: [Option<u16>; 4], rows: &mut [PerLane<i16>]) -> Option<[&mut [i16; BLOCK]; 4]> {
    let slot = |n: usize| wanted[n].map_or(n, usize::from);
    let [red, green, blue, alpha] = rows.get_disjoint_mut([slot(0), slot(1), slot(2), slot(3)]).ok()?;
    Some([red.block_mut(), green.block_mut(), blue.block_mut(), alpha.block_mut()])
}

/// Runs a loop with a comparison that is constant in it, because compilers leave a choice of eight inside a loop.
macro_rules! for_each_function {
    ($function:expr, |$name:ident| $loop:expr) => {
        for_each_function!(@ $function, $name, $loop, Never Less Equal LessOrEqual Greater NotEqual GreaterOrEqual Always)
    };
    (@ $function:expr, $name:ident, $loop:expr, $($case:ident)*) => {
        match $function {
            $($crate::state::CompareFunction::$case => {
                let $name = $crate::state::CompareFunction::$case;
                $loop
            })*
        }
    };
}
pub(crate) use for_each_function;

/// Lanes of a block whose pixels lie side by side on the surface. Small, because blocks of small triangles have many of them.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Run {
    /// Index of the first pixel in the band.
    at: u32,
    /// The first lane, and 2^16 times the number of pixels.
    lanes: u32,
}

impl Run {
    #[inline(always)]
    pub(crate) fn new(lane: usize, at: u32, count: usize) -> Run {
        Run { at, lanes: lane as u32 | (count as u32) << 16 }
    }

    /// Returns the first lane.
    #[inline(always)]
    pub(crate) fn lane(self) -> usize {
        (self.lanes & 0xffff) as usize
    }

    /// Returns the index of the first pixel in the band.
    #[inline(always)]
    pub(crate) fn at(self) -> usize {
        self.at as usize
    }

    /// Returns the number of pixels.
    #[inline(always)]
    pub(crate) fn count(self) -> usize {
        (self.lanes >> 16) as usize
    }

    /// Returns the lanes.
    #[inline(always)]
    pub(crate) fn lanes(self) -> std::ops::Range<usize> {
        self.lane()..self.lane() + self.count()
    }
}

/// 1.5 2^52: adding it to a small number leaves the nearest integer in the low bits.
const MAGIC: f64 = 6_755_399_441_055_744.0;

/// 1.5 2^23: [`MAGIC`] in single precision.
const MAGIC_32: f32 = 12_582_912.0;

/// Returns the larger number. Not `max`, which treats NaN in its own way and takes longer.
#[inline(always)]
pub(crate) fn larger<T: Copy + PartialOrd>(a: T, b: T) -> T {
    if a > b { a } else { b }
}

/// Returns the smaller number.
#[inline(always)]
pub(crate) fn smaller<T: Copy + PartialOrd>(a: T, b: T) -> T {
    if a < b { a } else { b }
}

/// Converts a whole number below 2^31.
#[inline(always)]
pub(crate) fn nearest(q: f64) -> i32 {
    (q + MAGIC).to_bits() as i32
}

/// Rounds to the nearest integer in single precision.
#[inline(always)]
pub(crate) fn nearest_32(q: f32) -> i32 {
    ((q + MAGIC_32).to_bits() as i32).wrapping_sub(MAGIC_32.to_bits() as i32)
}

/// Returns the floor of a number, limited to whole numbers from `low` to `high`.
#[inline(always)]
pub(crate) fn floor_within(t: f64, low: f64, high: f64) -> i32 {
    nearest(smaller(larger(t, low), high).floor())
}

/// RAS-0: returns the floor of a coordinate in 1/256 texel within its limits.
#[inline(always)]
pub(crate) fn limited(at: f64) -> i32 {
    const LIMIT: f64 = COORDINATE_LIMIT as f64;
    floor_within(at, -LIMIT, LIMIT)
}

/// Returns the floor of the exact sum of two numbers of which one may be much smaller.
#[inline(always)]
pub(crate) fn floor_of_sum(a: f64, b: f64) -> f64 {
    let sum = a + b;
    let lost = lost_by_sum(a, b);
    let floor = sum.floor();
    // The exact sum lies below a whole one.
    if (floor == sum) & (lost < 0.0) { floor - 1.0 } else { floor }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every number of pixels, by no more than a part too many.
    #[test]
    fn parts_hold_the_lanes_in_use() {
        for used in 0..=BLOCK {
            let computed = Lanes::first(used).count();
            assert!((used..used + PART).contains(&computed) && computed <= BLOCK, "{used}: {computed}");
        }
    }

    #[test]
    fn sums_are_floored_exactly() {
        let tiny = f64::from_bits(1 << 40);
        for whole in [-3.0, 0.0, 7.0] {
            let found = [-tiny, 0.0, tiny].map(|by| [floor_of_sum(whole, by), floor_of_sum(by, whole)]);
            assert_eq!(found, [[whole - 1.0; 2], [whole; 2], [whole; 2]]);
            assert_eq!(floor_of_sum(whole + 0.5, -tiny), whole);
        }
    }
}
