//! Functions of the fast engine's present text, which is replaced.

#![allow(dead_code, unreachable_pub, reason = "the fast engine's present text, which is replaced")]

use super::binary::Binary;
use super::fog::{Curve, Line, limited, not_finite};
use super::interpolate::{COORDINATE_LIMIT, Sample};
use super::setup::Triangle;
use crate::number::convert::{align, scaled, split};
use crate::state::{FogFunction, FogMode, TextureKind};
use crate::texture::coordinates::wrapped;
use crate::texture::planned::PlannedUnit;
use std::cmp::Reverse;

/// The floor of a quotient, and the effect of weights that fall short on it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Floored {
    /// The resulting value.
    pub value: i64,
    /// The number of steps by which `value` is lower than the floor of the exact quotient. It is 0 or 1 on a tie
    /// (INT-3, INT-4t). For coordinates divided by q (TEX-15), displaced (TSH-7) or of a finite loss it may be more, or negative.
    pub lowered: i64,
}

/// INT-4t: a weight that falls short does so by 2^-24 of itself. This is that exponent.
pub const SHORT_BITS: u32 = 24;

impl Sample<'_> {
    /// INT-3: returns the index of the dominant weight, which has the largest binary exponent. A power of two counts as
    /// just below itself.
    pub fn dominant(&self) -> usize {
        dominant(self.n, self.d)
    }

    /// INT-4, INT-4t: returns floor(sum G E / D) in 1/256 texel.
    #[inline(always)]
    pub fn coordinate(&self, g: &[i64; 3]) -> Floored {
        if self.triangle.loses_on_planes() {
            return self.moved_coordinate(g, 0);
        }
        let (value, rest) = quotient(self.sum(g), self.d);
        let lowered = i64::from(self.lowers_tie(rest == 0, || self.shortfall(g)));
        Floored { value: value - lowered, lowered }
    }

    /// INT-4t, TSH-7: returns floor(sum G E / D + `offset` / 2^24) in 1/256 texel with weights that fall short, limited to
    /// [`COORDINATE_LIMIT`].
    pub(crate) fn moved_coordinate(&self, g: &[i64; 3], offset: i64) -> Floored {
        let (exact, rest) = self.moved_quotient(g, offset, SHORT_BITS);
        // The remainder is in units of 2^24 D, as is the shortfall.
        let unit = i128::from(self.triangle.p[1]);
        let short = rest * unit - self.shortfall(g);
        let floor = exact + short.div_euclid((i128::from(self.d) << SHORT_BITS) * unit);
        let limited = |value: i128| value.clamp(-i128::from(COORDINATE_LIMIT), COORDINATE_LIMIT.into()) as i64;
        Floored { value: limited(floor), lowered: limited(exact) - limited(floor) }
    }

    /// Returns floor((sum G E / D + `offset` / 2^24) 2^(24 - drop)), and the remainder of the division by D 2^drop.
    pub(crate) fn moved_quotient(&self, g: &[i64; 3], offset: i64, drop: u32) -> (i128, i128) {
        let d = i128::from(self.d);
        let numerator = (self.sum(g) << SHORT_BITS) + i128::from(offset) * d;
        let denominator = d << drop;
        (numerator.div_euclid(denominator), numerator.rem_euclid(denominator))
    }

    /// Returns a factor in 4096ths, 0..=4096.
    #[inline]
    pub fn factor(&self, g: &[i64; 3]) -> i64 {
        quotient(self.sum(g), self.d).0.clamp(0, 4096)
    }

    /// TEX-15: returns floor(256 size s/q) in 1/256 texel, limited to [`COORDINATE_LIMIT`], with s and q of weights
    /// that fall short (INT-4t). A division by 0 is infinite; 0/0 is 0.
    pub fn ratio(&self, s: &[i64; 3], q: &[i64; 3], size: u32) -> Floored {
        let (scale, limit) = (i128::from(size) << 8, i128::from(COORDINATE_LIMIT));
        let (ns, nq) = (self.sum(s), self.sum(q));
        let exact = match nq {
            0 => limit * ns.signum(),
            _ => (ns * scale * nq.signum()).div_euclid(nq.abs()),
        };
        let (loss_s, loss_q) = (self.shortfall(s), self.shortfall(q));
        // The unit of shortfalls: P_1 2^24.
        let unit = i128::from(self.triangle.p[1]) << SHORT_BITS;
        let (numerator, denominator) = (ns * unit - loss_s, nq * unit - loss_q);
        // An estimate that is close to the quotient, unless the quotient is beyond the limit.
        let near = exact.clamp(-2 * limit, 2 * limit);
        // scale * numerator - near * denominator. It overflows 127 bits only where the quotient is many times the
        // limit.
        let rest = (ns * scale - near * nq).checked_mul(unit);
        let rest = rest.and_then(|rest| rest.checked_sub(loss_s * scale - near * loss_q));
        let value = match rest {
            _ if denominator == 0 => limit * numerator.signum(),
            Some(rest) => near + (rest * denominator.signum()).div_euclid(denominator.abs()),
            None => limit * numerator.signum() * denominator.signum(),
        };
        let value = value.clamp(-limit, limit) as i64;
        Floored { value, lowered: exact.clamp(-limit, limit) as i64 - value }
    }

    /// TEX-12: returns floor(128 n (s + m)/m) in 1/256 texel of a face of n texels, for a minor direction s and the
    /// major direction m, which is not negative. The zero vector yields 0 (TEX-13). Ties are those of INT-4t.
    pub fn face_coordinate(&self, s: &[i64; 3], m: &[i64; 3], size: u32) -> Floored {
        let (ns, nm) = (self.sum(s), self.sum(m));
        if nm <= 0 {
            return Floored { value: 0, lowered: 0 };
        }
        let scale = i128::from(size) << 7;
        let numerator = (ns + nm) * scale;
        let value = numerator.div_euclid(nm);
        let lowered = self.lowers_tie(numerator.rem_euclid(nm) == 0, || {
            let (loss_s, loss_m) = (self.shortfall(s), self.shortfall(m));
            (loss_s + loss_m) * scale - value * loss_m
        });
        Floored { value: value as i64 - i64::from(lowered), lowered: lowered.into() }
    }

    /// Returns sum G_k E_k.
    #[inline]
    pub fn sum(&self, g: &[i64; 3]) -> i128 {
        (0..3).map(|k| i128::from(g[k]) * i128::from(self.e[k])).sum()
    }

    /// INT-4t: returns whether weights 0 and 2 fall short. They do unless they dominate or the reciprocal is exact.
    pub(crate) fn short(&self) -> [bool; 2] {
        if self.triangle.exact_reciprocal {
            return [false; 2];
        }
        let dominant = self.dominant();
        [dominant != 0, dominant != 2]
    }

    /// INT-4t: returns what a linear function loses because weights 0 and 2 fall short and weight 1 takes up the
    /// difference, times 2^24 P_1.
    ///
    /// With u_k = G_k / P_k the quotient loses 2^-24 b_i (u_i - u_1) for each weight i that falls short, which is 2^-24
    /// / (P_1 D) times E_i (G_i P_1 - P_i G_1).
    pub fn shortfall(&self, g: &[i64; 3]) -> i128 {
        shortfall(self.triangle, &self.e, g, self.short())
    }

    /// INT-4t: returns whether a quotient is one step lower, given whether it is exact and what its numerator loses.
    #[inline(always)]
    pub(crate) fn lowers_tie(&self, exact: bool, shortfall: impl FnOnce() -> i128) -> bool {
        exact && !self.triangle.exact_reciprocal && shortfall() > 0
    }
}

/// INT-4t: returns [`Sample::shortfall`] where the weights 0 and 2 fall short as given. It is linear in the edge functions.
pub(crate) fn shortfall(triangle: &Triangle, e: &[i64; 3], g: &[i64; 3], short: [bool; 2]) -> i128 {
    let p = &triangle.p;
    let lost = |i: usize, short: bool| {
        let difference = i128::from(g[i]) * i128::from(p[1]) - i128::from(p[i]) * i128::from(g[1]);
        if short { difference * i128::from(e[i]) } else { 0 }
    };
    lost(0, short[0]) + lost(2, short[1])
}

/// INT-3: returns the index of the dominant of three weights n_k / d. d is positive. Outside the triangle some weights
/// are not positive; those do not dominate.
fn dominant(n: [i64; 3], d: i64) -> usize {
    // Class c means that the weight is in (2^-(c+1), 2^-c].
    let class = n.map(|n| {
        if n <= 0 {
            return u32::MAX;
        }
        // Shifted by this much, n has as many bits as d.
        let shift = n.leading_zeros().saturating_sub(d.leading_zeros());
        if n << shift > d { shift.saturating_sub(1) } else { shift }
    });
    match most_dominant(class.map(Reverse)) {
        [true, _] => 0,
        [_, true] => 2,
        _ => 1,
    }
}

/// INT-3: given a number for each of three weights that is larger for larger classes, returns whether the first and
/// whether the third dominates. Among equals the first precedes the second, the second precedes the third, and the
/// third precedes the first; if all are equal, the third dominates.
#[inline(always)]
pub(crate) fn most_dominant<T: PartialOrd + Copy>([a, b, c]: [T; 3]) -> [bool; 2] {
    let all = (a == b) & (b == c);
    [(a >= b) & (a > c), ((c > b) & (c >= a)) | all]
}

/// Limit of [`quotient`]s, 1/256 texel.
pub(crate) const QUOTIENT_LIMIT: i64 = 1 << 26;

/// Returns floor(n / d) and the remainder, for 0 < d < 2^62. Quotients are limited to [`QUOTIENT_LIMIT`], which only samples outside
/// the triangle reach; the remainder is then some number that is not 0.
///
/// This avoids a 128-bit division: the top 35 bits of d estimate the quotient to within one step, and the exact
/// remainder corrects it.
#[inline(always)]
fn quotient(n: i128, d: i64) -> (i64, i64) {
    if n.unsigned_abs() / QUOTIENT_LIMIT as u128 >= u128::from(d.unsigned_abs()) {
        return (n.signum() as i64 * QUOTIENT_LIMIT, d);
    }
    let excess = (64 - d.leading_zeros()).saturating_sub(35);
    let mut value = ((n >> excess) as i64).div_euclid(d >> excess);
    let mut remainder = n - i128::from(value) * i128::from(d);
    while remainder < 0 {
        value -= 1;
        remainder += i128::from(d);
    }
    while remainder >= i128::from(d) {
        value += 1;
        remainder -= i128::from(d);
    }
    (value, remainder as i64)
}

/// Bits of the largest g. Edge functions stay below 2^38 at every pixel within RAS-0, so sums stay below 2^102.
const ATTRIBUTE_BITS: i32 = 62;

/// The numerator of a linear function over a triangle. At a sample it is 2^exponent sum g_k E_k.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Attribute {
    g: [i64; 3],
    exponent: i32,
}

impl Attribute {
    /// Returns g and the exponent, for observers.
    pub(crate) fn numbers(&self) -> ([i64; 3], i32) {
        (self.g, self.exponent)
    }
}

impl Triangle {
    /// Returns the attribute with P_k x_k of three finite numbers. The products are exact, unless they differ so much
    /// that the smaller ones fall below 2^-62 of the largest; those are floored there (INT-4).
    pub(crate) fn attribute(&self, x: [f32; 3]) -> Attribute {
        let products: [(i64, i32); 3] = std::array::from_fn(|k| {
            let (mantissa, exponent) = split(x[k]);
            (mantissa * self.p[k], exponent)
        });
        let (g, exponent) = align(products, ATTRIBUTE_BITS);
        Attribute { g, exponent }
    }
}

impl Triangle {
    /// Returns G_k of a coordinate: floor(P_k 256 size s_k), so that u = floor(sum G E / sum P E) in 1/256 texel
    /// (INT-4).
    #[inline(always)]
    pub fn coordinate(&self, s: [f32; 3], size: u32) -> [i64; 3] {
        let mut g = [0; 3];
        for k in 0..3 {
            let (m, e) = split(s[k]);
            g[k] = scaled(m * self.p[k], i64::from(size), e + 8);
        }
        g
    }

    /// Returns G_k of a factor 0..1 in 4096ths: floor(P_k 4096 f_k) (NUM-6, INT-5n).
    pub fn factor(&self, f: [f32; 3]) -> [i64; 3] {
        std::array::from_fn(|k| {
            let (m, e) = split(f[k]);
            scaled(m, self.p[k], e + 12)
        })
    }

    /// Returns the linear functions of three coordinates of which only ratios are used: nine numbers P_k x_k with one common exponent and 28 bits.
    /// They are truncated toward zero, so that opposite directions stay opposite (TEX-15).
    #[inline(always)]
    pub fn direction(&self, x: [[f32; 3]; 3]) -> [[i64; 3]; 3] {
        let mut magnitudes = [(0, 0); 9];
        for (n, magnitude) in magnitudes.iter_mut().enumerate() {
            let (m, e) = split(x[n / 3][n % 3]);
            *magnitude = (m.abs() * self.p[n % 3], e);
        }
        let (mut g, _) = align(magnitudes, super::setup::PERSPECTIVE_BITS);
        for (n, g) in g.iter_mut().enumerate() {
            *g = if x[n / 3][n % 3] < 0.0 { -*g } else { *g };
        }
        [[g[0], g[1], g[2]], [g[3], g[4], g[5]], [g[6], g[7], g[8]]]
    }
}

/// The coordinates of a unit, set up for one triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Coordinates {
    /// q is 1 at all three vertices, so that u and v of level 0 are linear functions over D (INT-4).
    Plane([[i64; 3]; 2]),
    /// Linear functions of s, t and q, for the ratios s/q and t/q (TEX-15).
    Ratio([[i64; 3]; 3]),
    /// Linear functions of the direction s, t, r into a cube map (TEX-12). q is ignored.
    Direction([[i64; 3]; 3]),
}

impl Coordinates {
    /// Sets up the coordinates of a triangle. `vertices` holds s, t, r, q of its vertices.
    #[inline(always)]
    pub fn new(triangle: &Triangle, vertices: [[f32; 4]; 3], unit: &PlannedUnit) -> Coordinates {
        let [a, b, c] = wrapped(unit, vertices);
        let component = |n: usize| [a[n], b[n], c[n]];
        if unit.kind == TextureKind::Cube {
            return Coordinates::Direction(triangle.direction([component(0), component(1), component(2)]));
        }
        if component(3) == [1.0; 3] {
            let [width, height] = unit.scale(&unit.levels[0]);
            Coordinates::Plane([triangle.coordinate(component(0), width), triangle.coordinate(component(1), height)])
        } else {
            Coordinates::Ratio(triangle.direction([component(0), component(1), component(3)]))
        }
    }
}

/// VOL-1: returns r of the vertices as a linear function over D, or r and q if the coordinates are ratios.
pub(crate) fn layer_planes(
    triangle: &Triangle,
    coordinates: &Coordinates,
    [r, q]: [[f32; 3]; 2],
    layers: u32,
) -> ([i64; 3], Option<[i64; 3]>) {
    match coordinates {
        Coordinates::Ratio(_) => {
            let [r, q, _] = triangle.direction([r, q, q]);
            (r, Some(q))
        }
        Coordinates::Plane(_) | Coordinates::Direction(_) => (triangle.coordinate(r, layers), None),
    }
}

/// The fog of a triangle, set up from its vertices.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FogPlane {
    /// Factors, limited to 0..1: floor(4096 P_k f_k) (INT-5n).
    Factor([i64; 3]),
    /// d', or e of INT-5n, for a linear function (FOG-2).
    Linear(Line, Attribute),
    /// e, for a table (FOG-4).
    Exponential(FogMode, Attribute),
    /// Some value is not finite. Holds the byte of all pixels (FOG-4, FOG-5).
    NotFinite(u8),
}

impl FogPlane {
    /// Sets up the fog of a triangle from the values of its vertices: factors, or the d' or e of the function.
    pub fn new(triangle: &Triangle, function: Option<FogFunction>, vertices: [f32; 3]) -> FogPlane {
        let Some(function) = function else {
            return FogPlane::Factor(triangle.factor(vertices.map(limited)));
        };
        let finite = vertices.iter().all(|n| n.is_finite());
        match Curve::new(&function) {
            Some(Curve::Line(line)) if finite => FogPlane::Linear(line, triangle.attribute(vertices)),
            Some(Curve::Table(mode)) if finite => FogPlane::Exponential(mode, triangle.attribute(vertices)),
            _ => FogPlane::NotFinite(not_finite(function.mode)),
        }
    }
}

/// DEP-6: returns w_1/w_k of two positive w as a mantissa of 24 bits and an exponent.
pub(crate) fn w_ratio(first: f32, w: f32) -> (i64, i32) {
    let Binary { mantissa, exponent } = super::weights::ratio(first, w);
    (mantissa, exponent)
}

/// DEP-1: returns the reciprocal of a sum of at most 31 bits as a mantissa of 29 bits, which is low by 3/16 of its last
/// bit, and the s of its scale 2^-s.
pub(crate) fn reciprocal(sum: i64) -> (i64, i32) {
    let length = 63 - sum.leading_zeros() as i32;
    if sum & (sum - 1) == 0 {
        return (1 << 28, 28 + length);
    }
    // floor(2^s / sum - 3/16).
    let numerator = (1_u64 << (29 + length + 4)) - 3 * sum as u64;
    ((numerator / (16 * sum as u64)) as i64, 29 + length)
}

/// Number of fraction bits of an [`offset`] below 1/256 texel.
pub(crate) const OFFSET_BITS: u32 = 24;

/// Limit of offsets, in 2^-24 of 1/256 texel. Larger ones are outside every image.
const OFFSET_LIMIT: i128 = 1 << 50;

/// TSH-7: returns the displacement of one coordinate by f 128ths of the image, in 2^-24 of 1/256 texel.
pub(crate) fn offset_of(f: f32, side: u32) -> i64 {
    crate::texture::shader::scaled(f, side, OFFSET_BITS as i32 + 8 - 7, OFFSET_LIMIT)
}
