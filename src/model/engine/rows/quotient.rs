//! Quotients of linear functions for many pixels at once. They are estimated in floating point, proved by their distance from the nearest
//! integer, and otherwise corrected by exact remainders. `docs/exactness.md` has the argument.
#![allow(clippy::float_arithmetic, reason = "estimates: no result depends on how they are rounded")]

use super::kernels::{LANES, PerLane};
use crate::raster::interpolate::most_dominant;

/// 1.5 2^52: adding it to a small number leaves the nearest integer in the low bits.
pub(super) const MAGIC: f64 = 6_755_399_441_055_744.0;

/// 32 rounding errors of double precision: the largest error of an estimate, relative to the largest term of its sum.
pub(super) const SLACK: f64 = 1.0 / (1_u64 << 48) as f64;

/// 1.5 2^23: [`MAGIC`] in single precision.
const MAGIC_32: f32 = 12_582_912.0;

/// Number of fraction bits of an estimate, if its integer part leaves room for them.
const FRACTION: i32 = 20;

/// Lane numbers as integers.
pub(super) static IOTA: PerLane<i16> = {
    let mut all = [0; LANES];
    let mut n = 0;
    while n < LANES {
        all[n] = n as i16;
        n += 1;
    }
    PerLane(all)
};

/// Lane numbers as floats.
pub(super) static IOTA_REAL: PerLane<f64> = {
    let mut all = [0.0; LANES];
    let mut n = 0;
    while n < LANES {
        all[n] = n as f64;
        n += 1;
    }
    PerLane(all)
};

/// Columns and rows of a batch's pixels, relative to its first.
#[derive(Clone, Copy)]
pub(super) struct Positions<'a> {
    /// Columns of the pixels.
    pub(super) x: &'a [i16],
    /// Rows; unused if all pixels are on one row.
    pub(super) y: &'a [i16],
    /// The largest column, which lanes past the end repeat.
    pub(super) last: i32,
}

/// The linear function c + x X + y Y.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Line {
    pub(super) c: f64,
    pub(super) x: f64,
    pub(super) y: f64,
}

/// Multiplies and adds. Only estimates use it, so no result depends on whether it is fused.
#[inline(always)]
pub(super) fn multiply_add<const FMA: bool>(a: f64, b: f64, c: f64) -> f64 {
    if FMA { a.mul_add(b, c) } else { a * b + c }
}

impl Line {
    /// Returns the function less `times` another.
    #[inline(always)]
    pub(super) fn less(self, times: f64, other: Line) -> Line {
        Line { c: self.c - times * other.c, x: self.x - times * other.x, y: self.y - times * other.y }
    }

    /// Returns the sum with another function.
    #[inline(always)]
    pub(super) fn plus(self, other: Line) -> Line {
        Line { c: self.c + other.c, x: self.x + other.x, y: self.y + other.y }
    }

    /// Returns the least value so many columns to both sides and so many rows below.
    #[inline(always)]
    pub(super) fn least(self, columns: f64, rows: f64) -> f64 {
        self.c - self.x.abs() * columns + if self.y < 0.0 { self.y * rows } else { 0.0 }
    }

    /// Returns the function multiplied by a number.
    #[inline(always)]
    pub(super) fn times(self, by: f64) -> Line {
        Line { c: self.c * by, x: self.x * by, y: self.y * by }
    }

    #[inline(always)]
    pub(super) fn at<const FMA: bool, const ROW: bool>(self, x: f64, y: f64) -> f64 {
        let value = multiply_add::<FMA>(self.x, x, self.c);
        if ROW { value } else { multiply_add::<FMA>(self.y, y, value) }
    }
}

/// How a quotient is estimated. The value of a lane is the quotient less `base` and less the largest error, in steps of 2^-`shift`. A lane
/// is proved if its fraction is not above `limit`.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct QuotientEstimate {
    /// The numerator. All quotients share the denominator.
    pub(super) line: Line,
    pub(super) base: i32,
    pub(super) shift: u32,
    pub(super) limit: i32,
    /// Value of a quotient of 0, if none is smaller.
    pub(super) least: i32,
}

/// Bits of the sign and the exponent of a double.
pub(super) const EXPONENT: u64 = 0xfff << 52;

/// Returns 2^n for a small n.
#[inline(always)]
pub(super) fn power(n: i32) -> f64 {
    f64::from_bits(((1023 + n) as u64) << 52)
}

impl QuotientEstimate {
    /// Sets up a quotient less `bias`. `margin` is the largest error of an estimate. `extent` has the columns and rows around the first
    /// pixel, whose denominator has the first of the `reciprocals`; the second is that of the least denominator. Returns `None` if the
    /// estimate is too coarse to prove anything.
    #[inline(always)]
    pub(super) fn new<const ROW: bool>(
        numerator: Line,
        denominator: Line,
        extent: (f64, f64),
        reciprocals: (f64, f64),
        margin: f64,
        bias: i32,
    ) -> Option<QuotientEstimate> {
        let (estimate, proves) =
            QuotientEstimate::with_proof::<ROW>(numerator, denominator, extent, reciprocals, (margin, 0.0), bias);
        proves.then_some(estimate)
    }

    /// Sets up a quotient, and returns whether it can prove anything. If quotients are multiples of `gap`, one that is close to an integer
    /// may be known to be that integer; 0 means that nothing is known. Without branches, so that compilers set up several at once.
    #[inline(always)]
    pub(super) fn with_proof<const ROW: bool>(
        numerator: Line,
        denominator: Line,
        (columns, rows): (f64, f64),
        (reciprocal, widest): (f64, f64),
        (margin, gap): (f64, f64),
        bias: i32,
    ) -> (QuotientEstimate, bool) {
        let first = numerator.c * reciprocal;
        let base = whole(first);
        let rest = numerator.less(base, denominator);
        let range = rest.c.abs() + rest.x.abs() * columns;
        let range = if ROW { range } else { range + rest.y.abs() * rows } * widest + 4.0;
        // Number of bits of the integer part.
        let bits = (range.to_bits() >> 52) as i32 - 1022;
        let shift = (30 - bits).clamp(0, FRACTION);
        let scale = power(shift);
        let (down, limit, is) = proof(margin, gap, scale);
        let line = rest.less(down * power(-shift), denominator).times(scale);
        // NaN proves nothing either.
        let proves = (range < 268_435_456.0) & (base.abs() < 1_073_741_824.0) & is;
        let shift = shift as u32;
        (QuotientEstimate { line, base: nearest(first).wrapping_sub(bias), shift, limit, least: i32::MIN }, proves)
    }

    /// Returns the floor of a lane's value. The sign bit of the second number is set if the floor is not proved.
    #[inline(always)]
    fn floor(&self, step: i32) -> (i32, i32) {
        ((step >> self.shift) + self.base, self.limit - self.fraction(step))
    }

    /// Returns the largest fraction of a whole quotient, if quotients are multiples of `gap`; it is negative if the estimate does not tell them from
    /// others. They are at most half as far above an integer as the next ones.
    #[inline(always)]
    fn largest_of_whole(&self, gap: f64) -> i32 {
        let is_parted = self.limit == 1 << self.shift;
        if is_parted { (0.5 * gap * power(self.shift as i32)) as i32 } else { -1 }
    }

    /// Returns the fraction of a lane's value.
    #[inline(always)]
    fn fraction(&self, step: i32) -> i32 {
        step & ((1 << self.shift) - 1)
    }

    /// Declares that the quotient is not negative: an estimate below 0 is then a proved 0.
    #[inline(always)]
    pub(super) fn not_negative(mut self) -> QuotientEstimate {
        self.least = self.base.wrapping_neg().wrapping_shl(self.shift);
        self
    }

    /// Returns the value of a lane.
    #[inline(always)]
    fn step<const FMA: bool, const ROW: bool>(&self, x: f64, y: f64, r: f64) -> i32 {
        ((self.line.at::<FMA, ROW>(x, y) * r + MAGIC).to_bits() as i32).max(self.least)
    }

    /// Returns the [floor](Self::floor) of a lane from the reciprocal of its denominator.
    #[inline(always)]
    fn at<const FMA: bool, const ROW: bool>(&self, x: f64, y: f64, r: f64) -> (i32, i32) {
        self.floor(self.step::<FMA, ROW>(x, y, r))
    }
}

/// Returns how many of the `scale` steps are taken off an estimate whose error is less than `margin`, the largest fraction that is proved then, and
/// whether any is. Quotients are multiples of `gap`, or 0.
#[inline(always)]
pub(super) fn proof(margin: f64, gap: f64, scale: f64) -> (f64, i32, bool) {
    // A whole number of steps above the error and half a step.
    let off = whole(margin * scale + 2.0);
    // Then exact quotients come out above their integer, and the next smaller quotients below it.
    let parted = gap * scale >= 4.0 * off;
    (if parted { -off } else { off }, nearest(if parted { scale } else { scale - 2.0 * off }), off * 8.0 < scale)
}

#[inline(always)]
pub(super) fn larger<T: Copy + PartialOrd>(a: T, b: T) -> T {
    if a > b { a } else { b }
}

/// Rounds to the nearest integer, as a float.
#[inline(always)]
pub(super) fn whole(q: f64) -> f64 {
    (q + MAGIC) - MAGIC
}

/// Returns the floor of a number of less than 51 bits. With `WIDE`, the instruction set has an instruction for it.
#[inline(always)]
pub(super) fn floor<const WIDE: bool>(n: f64) -> f64 {
    if WIDE {
        return n.floor();
    }
    let near = whole(n);
    if near > n { near - 1.0 } else { near }
}

/// Rounds toward zero.
#[inline(always)]
pub(super) fn cut<const WIDE: bool>(n: f64) -> f64 {
    if WIDE {
        return n.trunc();
    }
    let magnitude = floor::<false>(n.abs());
    if n < 0.0 { -magnitude } else { magnitude }
}

/// Rounds to the nearest integer in single precision, as a float.
#[inline(always)]
pub(super) fn whole_32(q: f32) -> f32 {
    (q + MAGIC_32) - MAGIC_32
}

/// Rounds to the nearest integer.
#[inline(always)]
pub(super) fn nearest(q: f64) -> i32 {
    (q + MAGIC).to_bits() as i32
}

/// Returns the floor of a factor in 4096ths, limited to 0..=4096; 0 for NaN.
#[inline(always)]
pub(super) fn floor_of_factor<const WIDE: bool>(v: f64) -> i32 {
    let v = if v > 0.0 { v } else { 0.0 };
    nearest(floor::<WIDE>(if v < 4096.0 { v } else { 4096.0 }))
}

/// Rounds to the nearest integer in single precision.
#[inline(always)]
pub(super) fn nearest_32(q: f32) -> i32 {
    ((q + MAGIC_32).to_bits() as i32).wrapping_sub(MAGIC_32.to_bits() as i32)
}

/// Positions of a batch and the reciprocals of its denominators.
#[derive(Clone, Debug, Default)]
pub(super) struct Reciprocals {
    x: PerLane<f64>,
    y: PerLane<f64>,
    r: PerLane<f64>,
}

impl Reciprocals {
    /// Sets the positions and reciprocals of a batch.
    #[inline(always)]
    pub(super) fn set<const FMA: bool, const ROW: bool>(&mut self, at: Positions<'_>, denominator: Line) {
        if ROW {
            let lanes = at.x.len();
            let (last, iota) = (f64::from(at.last), &IOTA_REAL[..lanes]);
            let (to_x, to_r) = (&mut self.x[..lanes], &mut self.r[..lanes]);
            for n in 0..lanes {
                to_x[n] = if iota[n] < last { iota[n] } else { last };
            }
            self.y[..lanes].fill(0.0);
            if denominator.x == 0.0 {
                to_r.fill(1.0 / denominator.c);
                return;
            }
            for n in 0..lanes {
                to_r[n] = 1.0 / denominator.at::<FMA, true>(to_x[n], 0.0);
            }
            return;
        }
        let lanes = at.x.len();
        let (xs, ys) = (&at.x[..lanes], &at.y[..lanes]);
        let (to_x, to_y, to_r) = (&mut self.x[..lanes], &mut self.y[..lanes], &mut self.r[..lanes]);
        for n in 0..lanes {
            let (x, y) = (f64::from(xs[n]), f64::from(ys[n]));
            (to_x[n], to_y[n], to_r[n]) = (x, y, 1.0 / denominator.at::<FMA, false>(x, y));
        }
    }

    /// Returns columns, rows and reciprocals of the first lanes.
    #[inline(always)]
    pub(super) fn lanes(&self, count: usize) -> [&[f64]; 3] {
        [&self.x[..count], &self.y[..count], &self.r[..count]]
    }

    /// Writes the floors of two quotients. Returns for each whether a lane is not proved.
    #[inline(always)]
    pub(super) fn estimate<const FMA: bool, const ROW: bool>(
        &self,
        [one, other]: [QuotientEstimate; 2],
        first: &mut [i32],
        second: &mut [i32],
    ) -> [bool; 2] {
        // One after the other: both at a time need more registers than AVX2 has.
        let close = self.floors::<FMA, ROW, i32>(one, first, |floor| floor);
        [close, self.floors::<FMA, ROW, i32>(other, second, |floor| floor)]
    }

    /// Writes the floors of a quotient, as another type. Returns whether a lane is not proved.
    #[inline(always)]
    pub(super) fn floors<const FMA: bool, const ROW: bool, T>(
        &self,
        quotient: QuotientEstimate,
        out: &mut [T],
        to: impl Fn(i32) -> T,
    ) -> bool {
        let (lanes, mut close) = (out.len(), 0);
        let (xs, ys, rs) = (&self.x[..lanes], &self.y[..lanes], &self.r[..lanes]);
        for n in 0..lanes {
            let (floor, of_lane) = quotient.at::<FMA, ROW>(xs[n], ys[n], rs[n]);
            out[n] = to(floor);
            close |= of_lane;
        }
        close < 0
    }

    /// Does what [`floors`](Self::floors) does, and marks the lanes whose quotients are whole, where they are multiples of `gap`, if that part is known.
    /// Returns whether there are any, too.
    #[inline(always)]
    pub(super) fn floors_and_whole<const FMA: bool>(
        &self,
        quotient: QuotientEstimate,
        gap: f64,
        out: &mut [i32],
        whole: &mut [i32],
    ) -> (bool, bool) {
        let least = quotient.largest_of_whole(gap);
        let (lanes, mut close, mut any) = (out.len(), 0, 0);
        let (xs, ys, rs, whole) = (&self.x[..lanes], &self.y[..lanes], &self.r[..lanes], &mut whole[..lanes]);
        for n in 0..lanes {
            let step = quotient.step::<FMA, false>(xs[n], ys[n], rs[n]);
            let (floor, of_lane) = quotient.floor(step);
            (out[n], whole[n]) = (floor, i32::from(quotient.fraction(step) <= least));
            (close, any) = (close | of_lane, any | whole[n]);
        }
        (close < 0, any != 0)
    }

    /// Returns the floors of a lane, or `None` if one is not proved.
    pub(super) fn prove<const ROW: bool>(&self, n: usize, numerators: &[QuotientEstimate; 2]) -> Option<[i32; 2]> {
        let floor = |numerator: &QuotientEstimate| {
            let (value, close) = numerator.at::<false, ROW>(self.x[n], self.y[n], self.r[n]);
            (close >= 0).then_some(value)
        };
        Some([floor(&numerators[0])?, floor(&numerators[1])?])
    }
}

/// Returns the position of a lane.
#[inline(always)]
pub(super) fn position<const ROW: bool>(n: usize, last: f64, xs: &[i16], ys: &[i16], iota: &[f64]) -> (f64, f64) {
    if ROW { (if iota[n] < last { iota[n] } else { last }, 0.0) } else { (f64::from(xs[n]), f64::from(ys[n])) }
}

/// An integer linear function modulo 2^64.
#[derive(Clone, Copy, Debug)]
pub(super) struct Exact {
    pub(super) c: i64,
    pub(super) x: i64,
    pub(super) y: i64,
}

impl Exact {
    /// Returns the function less `times` another.
    #[inline(always)]
    pub(super) fn less(self, times: i64, other: Exact) -> Exact {
        Exact {
            c: self.c.wrapping_sub(other.c.wrapping_mul(times)),
            x: self.x.wrapping_sub(other.x.wrapping_mul(times)),
            y: self.y.wrapping_sub(other.y.wrapping_mul(times)),
        }
    }

    /// Returns the function multiplied by a number.
    #[inline(always)]
    pub(super) fn times(self, by: i64) -> Exact {
        Exact { c: self.c.wrapping_mul(by), x: self.x.wrapping_mul(by), y: self.y.wrapping_mul(by) }
    }

    /// Returns the value so many columns and rows further.
    #[inline(always)]
    pub(super) fn at(self, x: i64, y: i64) -> i64 {
        self.c.wrapping_add(self.x.wrapping_mul(x)).wrapping_add(self.y.wrapping_mul(y))
    }
}

/// Corrects estimates that are at most one off, and marks lanes whose division is exact.
///
/// A remainder lies within 1.25 denominators of 0. So it is known although numerators are only known modulo 2^64.
#[inline(always)]
pub(super) fn correct<const ROW: bool>(
    at: Positions<'_>,
    numerator: Exact,
    denominator: Exact,
    values: &mut [i32],
    whole: &mut [i32],
) {
    for (((value, whole), x), y) in values.iter_mut().zip(whole).zip(at.x).zip(at.y) {
        let (x, y) = (i64::from(i32::from(*x).min(at.last)), i64::from(*y));
        let mut n = numerator.c.wrapping_add(numerator.x.wrapping_mul(x));
        let mut d = denominator.c.wrapping_add(denominator.x.wrapping_mul(x));
        if !ROW {
            n = n.wrapping_add(numerator.y.wrapping_mul(y));
            d = d.wrapping_add(denominator.y.wrapping_mul(y));
        }
        let rest = n.wrapping_sub(i64::from(*value).wrapping_mul(d));
        *value += i32::from(rest >= d) - i32::from(rest < 0);
        *whole = i32::from((rest == 0) | (rest == d) | (rest == d.wrapping_neg()));
    }
}

/// INT-3: lowers tied weights. It takes the floors of 256 b0 and 256 b2, and the lanes that [`correct`] found to be exact.
///
/// A tied weight is a positive multiple of 1/256. So the class of each weight follows from its ceiling in 256ths: the next power of two.
#[inline(always)]
pub(super) fn break_ties(w0: &mut [i32], w2: &mut [i32], whole0: &[i32], whole2: &[i32]) {
    for (((w0, w2), whole0), whole2) in w0.iter_mut().zip(w2).zip(whole0).zip(whole2) {
        let (a, c) = (*w0, *w2);
        // Sets all bits below the power of two. If a weight is tied, the second weight is 256 less two floors, rounded up.
        let class = |ceiling: i32| {
            let m = ceiling - 1;
            let m = m | m >> 1;
            let m = m | m >> 2;
            m | m >> 4
        };
        let (p0, p1, p2) = (class(a + 1 - *whole0), class(256 - a - c), class(c + 1 - *whole2));
        let [first, third] = most_dominant([p0, p1, p2]);
        *w0 = a - i32::from((*whole0 != 0) & (a > 0) & !first);
        *w2 = c - i32::from((*whole2 != 0) & (c > 0) & !third);
    }
}

/// Returns whether a sign bit is set. Usually none is, and a loop without an early exit finds that out faster.
#[inline(always)]
pub(super) fn any_negative(lanes: &[u64]) -> bool {
    let mut all = 0;
    for lane in lanes {
        all |= lane;
    }
    all >> 63 != 0
}
