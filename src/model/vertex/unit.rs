//! VTX-5: vectors and matrices in the arithmetic of the transform unit. Numbers are patterns of binary32
//! ([`transform`](crate::number::transform)).

use super::Rows;
use crate::number::transform::{limited_reciprocal, product, reciprocal_root, sum};

/// Returns the patterns of numbers.
pub fn words<const N: usize>(v: [f32; N]) -> [u32; N] {
    v.map(f32::to_bits)
}

/// Returns a . b of three or four components: the products, each cut, in one sum.
pub fn dot<const N: usize>(a: [u32; N], b: [u32; N]) -> u32 {
    sum::<N>(std::array::from_fn(|k| product(a[k], b[k])))
}

/// Returns M p.
pub fn transform(matrix: &Rows, p: [u32; 4]) -> [u32; 4] {
    matrix.map(|row| dot(words(row), p))
}

/// Returns the window position of a vertex: x, y and z by the reciprocal of w, plus an offset; w stays as it is.
pub fn window([x, y, z, w]: [u32; 4], offset: [f32; 3]) -> [f32; 4] {
    let reciprocal = limited_reciprocal(w);
    let [ox, oy, oz] = words(offset);
    let at = |value, offset| f32::from_bits(sum([product(value, reciprocal), offset]));
    [at(x, ox), at(y, oy), at(z, oz), f32::from_bits(w)]
}

/// Returns the direction of a vector, and its length: both by the root of its square. A zero vector has the direction zero.
pub fn direction(v: [u32; 3]) -> ([u32; 3], u32) {
    let square = dot(v, v);
    let root = reciprocal_root(square);
    (v.map(|c| product(c, root)), product(square, root))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::float_arithmetic, reason = "compares with floats")]

    use super::*;

    #[test]
    fn directions_and_windows() {
        let (direction, length) = direction(words([3.0, 0.0, -4.0]));
        assert_eq!(direction.map(f32::from_bits), [0.59999996, 0.0, -0.79999995]);
        assert_eq!(f32::from_bits(length), 4.9999995);
        assert_eq!(super::direction([0; 3]), ([0; 3], 0));
        // 1/3 is cut, so the quotient 1 is not reached.
        assert_eq!(window(words([3.0, 6.0, 0.0, 3.0]), [0.0, 0.5, 0.0]), [0.99999994, 2.4999998, 0.0, 3.0]);
        let rows = [[1.0, 0.0, 0.0, 2.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 7.0], [0.0, 0.0, 1.0, 7.0]];
        assert_eq!(transform(&rows, words([1.0, 2.0, 3.0, 1.0])), words([3.0, 2.0, 10.0, 10.0]));
    }
}
