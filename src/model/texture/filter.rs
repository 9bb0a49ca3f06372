//! TEX-5, TEX-6: texel indices and weights of coordinates in 1/256 texel, and bilinear filtering.

use crate::number::{Blend, Integer};

/// TEX-6: returns one step of linear interpolation with the weight `w` of `b`.
#[inline(always)]
pub fn lerp<L: Blend>(a: L, b: L, w: L::Weight) -> L {
    (a.times(L::WHOLE - w) + b.times(w)).round8()
}

/// TEX-6: interpolates along u in both rows, then along v, with eight bits in between. `t` is the 2x2 footprint, row by
/// row. `observe` is called with the result of each step and returns the value to continue with.
#[inline(always)]
pub fn bilinear<L: Blend>(t: [L; 4], u: L::Weight, v: L::Weight, mut observe: impl FnMut(L) -> L) -> L {
    let rows = [observe(lerp(t[0], t[1], u)), observe(lerp(t[2], t[3], u))];
    observe(lerp(rows[0], rows[1], v))
}

/// TEX-5: returns the index of the texel at a coordinate in 1/256 texel.
#[inline]
pub fn nearest<I: Integer>(u: I) -> I {
    u.down(I::new(8))
}

/// TEX-6: returns the index of the lower of two texels, and the weight of the upper one, 0..=255.
#[inline]
pub fn linear(u: i64) -> (i64, i32) {
    let (texel, weight) = split(u);
    (texel, weight as i32)
}

/// [`linear`] of any whole number.
#[inline(always)]
pub fn split<I: Integer>(u: I) -> (I, I) {
    let f = u - I::new(128);
    (f.down(I::new(8)), f.modulo(I::new(256)))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Tests every weight with every pair of bytes, in both lanes that filter.
    #[test]
    fn one_step_by_its_formula() {
        for w in 0..=255_i32 {
            for a in 0..=255_i32 {
                for b in 0..=255_i32 {
                    let want = (a * (256 - w) + b * w + 128) >> 8;
                    assert_eq!(lerp(a, b, w), want);
                    assert_eq!(i32::from(lerp(a as u16, b as u16, w as u16)), want);
                }
            }
        }
    }

    #[test]
    fn signed_steps_shift_arithmetically() {
        assert_eq!(lerp(-128, 127, 0), -128);
        assert_eq!(lerp(-1, 0, 128), 0);
        assert_eq!(lerp(-2, -1, 128), -1);
        assert_eq!(lerp(-3, -1, 128), -2);
    }

    #[test]
    fn coordinates() {
        assert_eq!((nearest(255), nearest(256), nearest(-1)), (0, 1, -1));
        assert_eq!((linear(128), linear(127), linear(384)), ((0, 0), (-1, 255), (1, 0)));
    }
}
