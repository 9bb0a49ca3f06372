//! Quotients of linear functions for many pixels at once: estimated in floating point, proved by their distance from the next whole
//! number, settled by exact remainders where that does not suffice. `docs/exactness.md` has the argument.
#![allow(clippy::float_arithmetic, reason = "estimates: no result depends on how they are rounded")]

use super::kernels::LANES;

/// 1.5 2^52: added to a small number, it leaves the nearest whole number in the low bits.
const MAGIC: f64 = 6_755_399_441_055_744.0;

/// 1.5 2^23: the same in single precision.
const MAGIC_32: f32 = 12_582_912.0;

/// 32 roundings of double precision: what an estimate can be off by, relative to the largest term that was added.
pub(super) const SLACK: f64 = 1.0 / (1_u64 << 48) as f64;

/// 16 roundings of single precision.
pub(super) const SLACK_32: f64 = 1.0 / (1_u64 << 20) as f64;

/// An estimate must be closer to the truth than this, or the definition is asked.
pub(super) const COARSEST: f64 = 0.125;

/// Lane numbers.
pub(super) static IOTA: [i32; LANES] = {
    let mut all = [0; LANES];
    let mut n = 0;
    while n < LANES {
        all[n] = n as i32;
        n += 1;
    }
    all
};

/// Where the pixels of a piece lie, relative to its first: columns and, unless all are on one row, rows.
#[derive(Clone, Copy)]
pub(super) struct Positions<'a> {
    /// Columns.
    pub(super) x: &'a [i32],
    /// Rows; not looked at on a single row.
    pub(super) y: &'a [i32],
    /// The largest column; lanes past the end repeat it.
    pub(super) last: i32,
}

/// c + x X + y Y.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Line {
    pub(super) c: f64,
    pub(super) x: f64,
    pub(super) y: f64,
}

/// Only estimates use this, so no result depends on whether it is fused.
#[inline(always)]
pub(super) fn multiply_add<const FMA: bool>(a: f64, b: f64, c: f64) -> f64 {
    if FMA { a.mul_add(b, c) } else { a * b + c }
}

impl Line {
    /// Minus so many times another.
    #[inline(always)]
    pub(super) fn less(self, times: f64, other: Line) -> Line {
        Line { c: self.c - times * other.c, x: self.x - times * other.x, y: self.y - times * other.y }
    }

    #[inline(always)]
    pub(super) fn at<const FMA: bool, const ROW: bool>(self, x: f64, y: f64) -> f64 {
        let value = multiply_add::<FMA>(self.x, x, self.c);
        if ROW { value } else { multiply_add::<FMA>(self.y, y, value) }
    }
}

/// The nearest whole number, and as its sign bit whether it is further away than the limit.
#[inline(always)]
pub(super) fn nearest(q: f64, limit: f64) -> (i32, u64) {
    let t = q + MAGIC;
    (t.to_bits() as i32, (limit - (q - (t - MAGIC)).abs()).to_bits())
}

/// The same in single precision.
#[inline(always)]
fn nearest_32(q: f32, limit: f32) -> (i32, u32) {
    let t = q + MAGIC_32;
    (t.to_bits().wrapping_sub(MAGIC_32.to_bits()) as i32, (limit - (q - (t - MAGIC_32)).abs()).to_bits())
}

/// Two quotients whose floors are wanted; half the denominator has been subtracted, so that the nearest whole number is the floor. Says
/// of which of them some lane is too close to call.
#[inline(always)]
pub(super) fn estimate_two<const FMA: bool, const ROW: bool>(
    at: Positions<'_>,
    denominator: Line,
    numerators: [Line; 2],
    margins: [f64; 2],
    first: &mut [i32],
    second: &mut [i32],
) -> [bool; 2] {
    let limits = margins.map(|margin| 0.5 - margin);
    let mut close = [0_u64; 2];
    for (((first, second), x), y) in first.iter_mut().zip(second).zip(at.x).zip(at.y) {
        let (x, y) = (f64::from((*x).min(at.last)), f64::from(*y));
        let r = 1.0 / denominator.at::<FMA, ROW>(x, y);
        let one = nearest(numerators[0].at::<FMA, ROW>(x, y) * r, limits[0]);
        let other = nearest(numerators[1].at::<FMA, ROW>(x, y) * r, limits[1]);
        (*first, *second) = (one.0, other.0);
        close[0] |= one.1;
        close[1] |= other.1;
    }
    close.map(|bits| bits >> 63 == 1)
}

/// [`estimate_two`] in single precision, for quotients up to 256: twice the lanes, a wider margin.
#[inline(always)]
pub(super) fn estimate_weights<const FMA: bool>(
    at: Positions<'_>,
    denominator: Line,
    numerators: [Line; 2],
    margin: f64,
    first: &mut [i32],
    second: &mut [i32],
) -> bool {
    let at_x = |line: (f32, f32), x: f32| if FMA { line.1.mul_add(x, line.0) } else { line.1 * x + line.0 };
    let denominator = (denominator.c as f32, denominator.x as f32);
    let numerators = numerators.map(|line| (line.c as f32, line.x as f32));
    let limit = (0.5 - margin) as f32;
    let mut close = 0_u32;
    for ((first, second), x) in first.iter_mut().zip(second).zip(at.x) {
        let x = (*x).min(at.last) as f32;
        let r = 1.0 / at_x(denominator, x);
        let one = nearest_32(at_x(numerators[0], x) * r, limit);
        let other = nearest_32(at_x(numerators[1], x) * r, limit);
        (*first, *second) = (one.0, other.0);
        close |= one.1 | other.1;
    }
    close >> 31 == 1
}

/// An integer linear function, modulo 2^64.
#[derive(Clone, Copy, Debug)]
pub(super) struct Exact {
    pub(super) c: i64,
    pub(super) x: i64,
    pub(super) y: i64,
}

impl Exact {
    /// Minus so many times another.
    pub(super) fn less(self, times: i64, other: Exact) -> Exact {
        let less = |a: i64, b: i64| a.wrapping_sub(b.wrapping_mul(times));
        Exact { c: less(self.c, other.c), x: less(self.x, other.x), y: less(self.y, other.y) }
    }

    /// Divided by a power of two that divides it, modulo 2^32.
    fn low(self, shift: u32) -> [i32; 3] {
        [self.c, self.x, self.y].map(|n| (n >> shift) as i32)
    }
}

/// Makes floors of estimates that are off by one at most, and says where nothing remains.
///
/// The remainder lies within 1.25 denominators of 0, so it is known although numerators are known modulo 2^64 only. `small` says by how
/// many bits both functions can be divided, if denominators are below 2^30 then: 32 bits suffice.
#[inline(always)]
pub(super) fn settle<const ROW: bool>(
    at: Positions<'_>,
    numerator: Exact,
    denominator: Exact,
    small: Option<u32>,
    values: &mut [i32],
    whole: &mut [i32],
) {
    if let Some(shift) = small {
        let ([n, n_x, n_y], [d, d_x, d_y]) = (numerator.low(shift), denominator.low(shift));
        for (((value, whole), x), y) in values.iter_mut().zip(whole).zip(at.x).zip(at.y) {
            let x = (*x).min(at.last);
            let (mut n, mut d) = (n.wrapping_add(n_x.wrapping_mul(x)), d.wrapping_add(d_x.wrapping_mul(x)));
            if !ROW {
                (n, d) = (n.wrapping_add(n_y.wrapping_mul(*y)), d.wrapping_add(d_y.wrapping_mul(*y)));
            }
            let rest = n.wrapping_sub(value.wrapping_mul(d));
            *value += i32::from(rest >= d) - i32::from(rest < 0);
            *whole = i32::from((rest == 0) | (rest == d) | (rest == d.wrapping_neg()));
        }
    } else {
        for (((value, whole), x), y) in values.iter_mut().zip(whole).zip(at.x).zip(at.y) {
            let (x, y) = (i64::from((*x).min(at.last)), i64::from(*y));
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
}

/// INT-3 on floors of 256 b0 and 256 b2 and what [`settle`] said of them.
///
/// A tied weight is a multiple of 1/256 above 0, so the class of each weight is told by its ceiling in 256ths: the next power of two.
#[inline(always)]
pub(super) fn break_ties(w0: &mut [i32], w2: &mut [i32], whole0: &[i32], whole2: &[i32]) {
    for (((w0, w2), whole0), whole2) in w0.iter_mut().zip(w2).zip(whole0).zip(whole2) {
        let (a, c) = (*w0, *w2);
        // All bits below the power of two. Where something is tied, the second weight is 256 less two floors, rounded up.
        let class = |ceiling: i32| {
            let m = ceiling - 1;
            let m = m | m >> 1;
            let m = m | m >> 2;
            m | m >> 4
        };
        let (p0, p1, p2) = (class(a + 1 - *whole0), class(256 - a - c), class(c + 1 - *whole2));
        let all = (p0 == p1) & (p1 == p2);
        let first = (p0 >= p1) & (p0 > p2);
        let third = ((p2 > p1) & (p2 >= p0)) | all;
        *w0 = a - i32::from((*whole0 != 0) & (a > 0) & !first);
        *w2 = c - i32::from((*whole2 != 0) & (c > 0) & !third);
    }
}
