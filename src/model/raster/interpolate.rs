//! What the weights of [WGT-1](super::weights) make of the vertices' numbers at a sample: INT-2, INT-4, TEX-12 and TEX-15.

use super::binary::Binary;
use super::setup::Triangle;
use super::smooth;
use super::weights::{Linear, Number, Weights, quotient};
use crate::number::{Blend, Integer};
use std::cell::OnceCell;

/// INT-2: interpolates a colour channel of the vertices with weights W0 and W2. The second vertex gets the remainder.
#[inline(always)]
pub fn color<L: Blend>(c: [L; 3], w0: L::Weight, w2: L::Weight) -> L {
    (c[0].times(w0) + c[1].times(L::WHOLE - w0 - w2) + c[2].times(w2)).round8()
}

/// A sample point of a triangle. Its weights are computed when they are first used.
#[derive(Clone, Debug)]
pub struct Sample<'a> {
    /// The triangle that contains the sample.
    pub triangle: &'a Triangle,
    /// The edge functions E_k.
    pub e: [i64; 3],
    /// The ideal's weights of the vertices, if they differ from those of this triangle, whose vertices are snapped.
    pub ideal: Option<[f64; 3]>,
    weights: OnceCell<Weights<Binary>>,
}

/// Largest magnitude of a texel coordinate, in 1/256 texel (RAS-0, TEX-15).
pub const COORDINATE_LIMIT: i64 = super::TEXEL_LIMIT << 8;

impl<'a> Sample<'a> {
    /// Returns the sample whose edge functions are `e`.
    #[inline]
    pub fn new(triangle: &'a Triangle, e: [i64; 3]) -> Self {
        Sample { triangle, e, ideal: None, weights: OnceCell::new() }
    }

    /// WGT-1: returns the weights of the vertices, perspective-corrected where the triangle is.
    #[inline]
    pub fn weights(&self) -> &Weights<Binary> {
        self.weights.get_or_init(|| Weights::new(self.e.map(Binary::from_edge), self.triangle.ratios))
    }

    /// WGT-1: returns the value of a number of the vertices.
    #[inline]
    pub fn value(&self, f: &Linear<Binary>) -> Binary {
        let [b0, _, b2] = self.weights().b;
        f.at([b0, b2])
    }

    /// INT-2, SMO-2: returns W0 and W2, each 0..=256 unless the sample [is outside](Self::is_outside). W1 is the remainder.
    #[inline]
    pub fn color_weights(&self) -> [i64; 2] {
        let [first, _, third] = self.weights().b;
        [first, third].map(if self.is_outside() { smooth::color_weight } else { color_weight })
    }

    /// Returns whether the sample lies outside, where smooth edges may reach.
    #[inline]
    pub fn is_outside(&self) -> bool {
        self.triangle.is_outside(self.e)
    }

    /// Returns whether the sample lies behind the viewer. No sample inside of the triangle does.
    pub fn is_behind(&self) -> bool {
        self.triangle.is_behind(self.weights().sum.mantissa)
    }
}

/// INT-2: returns the floor of 256 b, 0..=256, of a weight b of a covered sample, which is at most 1: its exponent is at most -23.
#[inline(always)]
pub fn color_weight<I: Integer>(b: Binary<I>) -> I {
    b.mantissa.down((I::new(-8) - b.exponent).least(I::new(31)))
}

/// INT-4: returns a coordinate of an image of `size` texels in 1/256 texel.
#[inline]
pub fn coordinate<I: Integer>(value: Binary<I>, size: I) -> I {
    value.floored(size, I::new(8), I::new(COORDINATE_LIMIT))
}

/// TEX-15: returns s/q, or s where q is 0.
#[inline]
pub fn divided<I: Integer>(s: Binary<I>, q: Binary<I>) -> Binary<I> {
    quotient(s, Binary::one().or(q.mantissa.is_zero(), q).reciprocal::<false>())
}

/// TEX-15: returns s/q of an image of `size` texels in 1/256 texel. A division by 0 is infinite; 0/0 is 0.
#[inline]
pub fn ratio<I: Integer>(s: Binary<I>, q: Binary<I>, size: I) -> I {
    ratio_coordinate(divided(s, q), q, size)
}

/// TEX-15: returns the coordinate of the quotient of a number [divided] by q.
#[inline]
pub fn ratio_coordinate<I: Integer>(quotient: Binary<I>, q: Binary<I>, size: I) -> I {
    let (zero, limit, n) = (I::new(0), I::new(COORDINATE_LIMIT), quotient.mantissa);
    let infinite = zero.or(n.is_zero(), limit.negated(n.is_negative()));
    infinite.or(q.mantissa.is_zero(), coordinate(quotient, size))
}

/// TEX-12: returns floor(2^`bits` n (1 + s/m) / 2) of a face of n texels, for a minor direction s and the major direction m. It is 0 where m is not
/// positive, as for the zero vector (TEX-13).
#[inline]
pub fn face_coordinate<I: Integer>(s: Binary<I>, m: Binary<I>, size: I, bits: i64) -> I {
    across_face(divided(s, m), m, size, bits)
}

/// TEX-12: returns the coordinate on a face of the quotient of a minor direction [divided] by the major direction m.
#[inline]
pub fn across_face<I: Integer>(q: Binary<I>, m: Binary<I>, size: I, bits: i64) -> I {
    let (zero, power) = (I::new(0), I::new(bits - 1));
    let coordinate = size.up(power) + q.far_floored(size, power, I::new(FARTHEST));
    coordinate.or(zero.is_below(m.mantissa), zero)
}

/// Limit of coordinates in 1/65536 texel: they reach it only outside of the triangle.
pub const FARTHEST: i64 = 1 << 61;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::state::Profile;

    fn right_triangle(size: f32, w: [f32; 3]) -> Triangle {
        let p = [[0.0, 0.0, 0.0, w[0]], [size, 0.0, 0.0, w[1]], [0.0, size, 0.0, w[2]]];
        Triangle::new(p, true, Profile::Nv2a).expect("area")
    }

    #[test]
    fn weights_of_colors_are_parts_of_256() {
        for w in [[1.0; 3], [1.0, 3.0, 0.3], [7.0, 2.0, 2.0]] {
            let t = right_triangle(96.0, w);
            for j in 0..96 {
                for i in 0..95 - j {
                    let [w0, w2] = Sample::new(&t, t.edges(i, j)).color_weights();
                    assert!(w0 >= 0 && w2 >= 0 && w0 + w2 <= 256, "{w:?} {i} {j}");
                }
            }
        }
    }

    /// Where the area is a power of two, so that the reciprocal is exact, weights that are whole 256ths are those.
    #[test]
    fn exact_weights_stay() {
        let t = right_triangle(64.0, [10.0; 3]);
        for j in 0..64 {
            for i in 0..63 - j {
                let e = t.edges(i, j);
                let exact = [0, 2].map(|k| (e[k] << 8) / t.doubled_area);
                assert_eq!(Sample::new(&t, e).color_weights(), exact);
            }
        }
    }

    #[test]
    fn constant_numbers_stay_constant() {
        let p = [[1.0, 2.0, 0.0, 1.3], [90.0, 7.0, 0.0, 2.9], [13.0, 71.0, 0.0, 0.7]];
        let t = Triangle::new(p, true, Profile::Nv2a).expect("area");
        for value in [0.1, -3.3e38, 1e-45, 7.0, 0.0] {
            let f = Linear::new([value; 3]);
            for (i, j) in [(20, 20), (40, 9), (300, 900), (4095, -4096)] {
                assert_eq!(Sample::new(&t, t.edges(i, j)).value(&f).nearest_f32(), value);
            }
        }
    }

    #[test]
    fn ratios_at_the_ends() {
        let n = Binary::new;
        assert_eq!(
            [ratio(n(3.0), n(0.0), 4), ratio(n(-3.0), n(0.0), 4), ratio(n(0.0), n(0.0), 4)],
            [COORDINATE_LIMIT, -COORDINATE_LIMIT, 0]
        );
        assert_eq!([ratio(n(-1.0), n(3.0), 1), ratio(n(1.0), n(-3.0), 1), ratio(n(1.0), n(3.0), 1)], [-86, -86, 85]);
        assert_eq!([ratio(n(1e30), n(1e-30), 1), ratio(n(-1e-30), n(1e30), 1)], [COORDINATE_LIMIT, -1]);
        assert_eq!([face_coordinate(n(1.0), n(0.0), 4, 8), face_coordinate(n(-1e-30), n(1.0), 4, 8)], [0, 511]);
    }
}
