//! INT-1 to INT-4 and fog: the definition of interpolation, in integers.
//!
//! With E the edge functions, P the perspective weights, N_k = P_k E_k and D their sum, every result is a floor of a
//! quotient by D, and exact remainders decide ties. The rule for colours, [`color`], is generic over the lane.

use super::setup::Triangle;
use crate::number::Blend;
use std::cmp::Reverse;

/// INT-2: interpolates a colour channel of the vertices with weights W0 and W2. The second vertex gets the remainder.
#[inline(always)]
pub fn color<L: Blend>(c: [L; 3], w0: L::Weight, w2: L::Weight) -> L {
    (c[0].times(w0) + c[1].times(L::WHOLE - w0 - w2) + c[2].times(w2)).round8()
}

/// A sample point of a triangle.
#[derive(Clone, Copy, Debug)]
pub struct Sample<'a> {
    /// The triangle that contains the sample.
    pub triangle: &'a Triangle,
    /// The edge functions E_k.
    pub e: [i64; 3],
    /// N_k = P_k E_k.
    pub n: [i64; 3],
    /// D = N_0 + N_1 + N_2.
    pub d: i64,
    /// The ideal's weights of the vertices, if they differ from those of this triangle, whose vertices are snapped.
    pub ideal: Option<[f64; 3]>,
}

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

/// Largest magnitude of a texel coordinate, in 1/256 texel (RAS-0, TEX-15).
pub const COORDINATE_LIMIT: i64 = super::TEXEL_LIMIT << 8;

impl<'a> Sample<'a> {
    /// Returns the sample whose edge functions are `e`.
    #[inline]
    pub fn new(triangle: &'a Triangle, e: [i64; 3]) -> Self {
        let n: [i64; 3] = std::array::from_fn(|k| triangle.p[k] * e[k]);
        Sample { triangle, e, n, d: n[0] + n[1] + n[2], ideal: None }
    }

    /// INT-3: returns the index of the dominant weight, which has the largest binary exponent. A power of two counts as
    /// just below itself.
    pub fn dominant(&self) -> usize {
        dominant(self.n, self.d)
    }

    /// INT-2, INT-3: returns W0 and W2, each 0..=256. W1 is the remainder.
    #[inline]
    pub fn weights(&self) -> [Floored; 2] {
        [self.weight(0), self.weight(2)]
    }

    #[inline(always)]
    fn weight(&self, k: usize) -> Floored {
        let (value, rest) = quotient(i128::from(self.n[k]) << 8, self.d);
        let lowered = rest == 0 && value > 0 && !self.triangle.exact_reciprocal && self.dominant() != k;
        Floored { value: value - i64::from(lowered), lowered: lowered.into() }
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::state::Profile;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn quotients_are_floors(d in 1_i64..1 << 62, q in -(1_i64 << 25)..1 << 25, r in 0.0..1.0_f64, small in 0_u32..62) {
            let d = (d >> small).max(1);
            #[allow(clippy::float_arithmetic, reason = "choosing a remainder")]
            let remainder = ((d as f64 * r) as i64).min(d - 1);
            for remainder in [remainder, 0, d - 1] {
                let n = i128::from(q) * i128::from(d) + i128::from(remainder);
                prop_assert_eq!(quotient(n, d), (q, remainder));
            }
        }
    }

    fn right_triangle(size: f32, w: f32) -> Triangle {
        let p = [[0.0, 0.0, 0.0, w], [size, 0.0, 0.0, w], [0.0, size, 0.0, w]];
        Triangle::new(p, true, Profile::Nv2a).expect("area")
    }

    #[test]
    fn weights_add_to_256_and_ties_go_down() {
        let t = right_triangle(96.0, 1.0);
        assert!(!t.exact_reciprocal);
        let mut lowered = 0;
        for j in 0..96 {
            for i in 0..95 - j {
                let s = Sample::new(&t, t.edges(i, j));
                let [w0, w2] = s.weights();
                assert!(w0.value >= 0 && w2.value >= 0 && w0.value + w2.value <= 256);
                lowered += w0.lowered + w2.lowered;
            }
        }
        assert!(lowered > 0);
    }

    #[test]
    fn power_of_two_areas_lower_nothing() {
        for w in [1.0, 2.0, 10.0, 0.7] {
            let t = right_triangle(64.0, w);
            assert!(t.exact_reciprocal, "{w}");
            for j in 0..64 {
                for i in 0..63 - j {
                    assert!(Sample::new(&t, t.edges(i, j)).weights().iter().all(|w| w.lowered == 0), "{w}");
                }
            }
        }
    }

    #[test]
    fn unequal_w_lowers_ties_of_any_area() {
        let p = [[0.0, 0.0, 0.0, 4.0], [64.0, 0.0, 0.0, 2.0], [0.0, 64.0, 0.0, 2.0]];
        assert!(!Triangle::new(p, true, Profile::Nv2a).expect("area").exact_reciprocal);
        assert!(Triangle::new(p, false, Profile::Nv2a).expect("area").exact_reciprocal);
    }

    proptest! {
        /// Compares the class of a weight with its statement: the smallest c with n 2^(c + 1) > d.
        #[test]
        fn classes_by_their_statement(d in 1_i64..1 << 62, small in 0_u32..62, parts in (0.0..1.0_f64, 0.0..1.0_f64), whole in 0..4) {
            let d = (d >> small).max(4);
            #[allow(clippy::float_arithmetic, reason = "choosing weights")]
            let first = match whole {
                0 => ((d as f64 * parts.0) as i64).min(d),
                1 => d >> 1,
                2 => d >> 2,
                _ => d,
            };
            #[allow(clippy::float_arithmetic, reason = "choosing weights")]
            let second = (((d - first) as f64 * parts.1) as i64).clamp(0, d - first);
            let n = [first, second, d - first - second];
            let class = n.map(|n| {
                if n == 0 { 999 } else { (0..).find(|c| i128::from(n) << (c + 1) > i128::from(d)).unwrap_or(999) }
            });
            let got = dominant(n, d);
            prop_assert_eq!(class[got], class.into_iter().min().unwrap_or(0), "{:?} {}", n, d);
        }
    }

    #[test]
    fn dominance_order() {
        assert_eq!(dominant([5, 5, 2], 12), 0);
        assert_eq!(dominant([2, 5, 5], 12), 1);
        assert_eq!(dominant([5, 2, 5], 12), 2);
        assert_eq!(dominant([4, 4, 4], 12), 2);
        // An exact power of two counts as just below itself: 1/2 is in the class of 3/8.
        assert_eq!(dominant([4, 3, 1], 8), 0);
        assert_eq!(dominant([1, 3, 4], 8), 1);
        assert_eq!(dominant([0, 0, 8], 8), 2);
    }

    proptest! {
        /// Compares the finite loss with its statement: weights 0 and 2 count 2^24 - 1 times in place of 2^24 times where they fall short, and
        /// weight 1 has the remainder. Half of the coordinates lie close to a whole number.
        #[test]
        fn finite_losses_by_their_statement(
            corners in prop::array::uniform3((-300.0..900.0_f32, -300.0..900.0_f32, 0.05..20.0_f32)),
            s in prop::array::uniform3(-300.0..300.0_f32), tiny in -(1 << 20)..1_i64 << 20, whole: bool,
            at in (0.0..1.0_f32, 0.0..1.0_f32),
        ) {
            let p = corners.map(|(x, y, w)| if whole { [x.floor(), y.floor(), 0.0, 1.0] } else { [x, y, 0.0, w] });
            let Some(mut t) = Triangle::new(p, true, Profile::Nv2a) else { return Ok(()) };
            t.lose(crate::state::PlaneLoss::Finite);
            #[allow(clippy::float_arithmetic, reason = "choosing a pixel between the vertices")]
            let between = |n: usize| {
                let middle = p[0][n] + (p[1][n] - p[0][n]) * at.0;
                (middle + (p[2][n] - middle) * at.1) as i64
            };
            let (e, mut g) = (t.edges(between(0), between(1)), t.coordinate(if whole { s.map(f32::floor) } else { s }, 64));
            prop_assume!(t.covers(e));
            let sample = Sample::new(&t, e);
            if whole {
                let above = sample.sum(&g).rem_euclid(sample.d.into()) as i64 / t.doubled_area;
                g = g.map(|g| g - above + tiny);
            }
            let u = sample.coordinate(&g);
            let falls = [0, 2].map(|k| i128::from(!t.exact_reciprocal && sample.dominant() != k));
            let of = |n: [i64; 3]| falls[0] * i128::from(n[0]) + falls[1] * i128::from(n[2]);
            let products = [0, 2].map(|k: usize| i128::from(g[k]) * i128::from(e[k]));
            let lost = falls[0] * products[0] + falls[1] * products[1];
            // 2^24 P_1 (N' - u D), where N' is the numerator of weights that fall short.
            let above = |u: i64| {
                let rest = sample.sum(&g) - i128::from(u) * i128::from(sample.d);
                ((rest << 24) - lost) * i128::from(t.p[1]) + i128::from(g[1]) * of(sample.n)
            };
            prop_assert!(above(u.value) >= 0 && above(u.value + 1) < 0, "{:?}", u);
            prop_assert_eq!(u.value + u.lowered, sample.sum(&g).div_euclid(sample.d.into()) as i64);
        }
    }

    #[test]
    fn constant_texel_coordinates_stay_constant() {
        let p = [[1.0, 2.0, 0.0, 1.3], [90.0, 7.0, 0.0, 2.9], [13.0, 71.0, 0.0, 0.7]];
        let t = Triangle::new(p, true, Profile::Nv2a).expect("area");
        let g = t.coordinate([0.75; 3], 64);
        for j in 0..80 {
            for i in 0..100 {
                let e = t.edges(i, j);
                if t.covers(e) {
                    assert_eq!(Sample::new(&t, e).coordinate(&g), Floored { value: 48 * 256, lowered: 0 });
                }
            }
        }
    }
}
