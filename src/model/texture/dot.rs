//! TSH-1 to TSH-5, TSH-7: the dot unit. It computes in single precision, because the chip does, and is the only place
//! of the fixed path with floats.
//!
//! It uses only + - * / of IEEE single precision, each rounded separately in the order written here; nothing is fused.
//! Every machine therefore computes the same bits, except those of a NaN, which counts as 0 wherever it is used.
#![allow(clippy::float_arithmetic, reason = "the chip's dot unit is a float unit (TSH-4); its ideal stands beside it")]

use crate::state::DotMapping;
use std::ops::{Add, Mul, Sub};

/// A number of the dot unit: `f32` for the definition, `f64` for the ideal.
pub trait Number: Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> {
    /// The number 2.
    const TWO: Self;
}

impl Number for f32 {
    const TWO: f32 = 2.0;
}

impl Number for f64 {
    const TWO: f64 = 2.0;
}

/// A vector of three numbers, such as coordinates or a remapped colour.
pub(crate) type Vector<N> = [N; 3];

/// TSH-1, TSH-2 and TSH-3: returns three fractions, each a numerator and a denominator, of the bytes R, G, B, A of a
/// colour. All have at most 24 bits.
#[inline(always)]
pub(crate) fn fractions(mapping: DotMapping, bytes: [u8; 4]) -> [(i32, i32); 3] {
    let [r, g, b, a] = bytes;
    let each = |of: fn(u8) -> i32, whole: i32| [r, g, b].map(|byte| (of(byte), whole));
    let halves = [[a, r], [g, b]].map(u16::from_be_bytes);
    match mapping {
        DotMapping::ZeroToOne => each(i32::from, 255),
        DotMapping::MinusOneToOneD3d => each(|v| i32::from(v) - 128, 127),
        DotMapping::MinusOneToOneGl => each(|v| 2 * i32::from(v as i8) + 1, 255),
        DotMapping::MinusOneToOne => each(|v| i32::from(v as i8), 127),
        DotMapping::Hilo1 => [(i32::from(halves[0]), 65535), (i32::from(halves[1]), 65535), (1, 1)],
        DotMapping::HiloHemisphere => {
            let [high, low] = halves.map(|half| i32::from(half as i16));
            [(high, 32768), (low, 32768), third_of_unit(high, low)]
        }
    }
}

/// TSH-3: number of pieces of the root of a mantissa in [1/4, 1/2), and of one in [1/2, 1).
const PIECES: u32 = 32;

/// TSH-3: the straight pieces of the root, 32 to an octave: the root at a piece's start with 18 fraction bits, and its rise
/// with 16, both cut. The last is the root of 1.
const ROOT: [(u32, u32); 2 * PIECES as usize + 1] = {
    let mut pieces = [(1 << 18, 0); 2 * PIECES as usize + 1];
    let mut at = 0;
    while at < 2 * PIECES as usize {
        // A piece of the lower octave is 1/128 wide, of the upper 1/64; roots have 30 fraction bits first.
        let (start, up) = if at < PIECES as usize { (at as u64 + 32, 53) } else { (at as u64, 54) };
        let (root, next) = ((start << up).isqrt(), ((start + 1) << up).isqrt());
        pieces[at] = ((root >> 12) as u32, ((next - root) >> 14) as u32);
        at += 1;
    }
    pieces
};

/// TSH-3: returns the third component of the unit vector with x = high/32768 and y = low/32768, a fraction of at most 16
/// bits over a power of two. It is at most 1.3 * 2^-14 below the root of what is left, and never above.
fn third_of_unit(high: i32, low: i32) -> (i32, i32) {
    let left = (1 << 30) - i64::from(high) * i64::from(high) - i64::from(low) * i64::from(low);
    if left <= 0 {
        return (0, 1);
    }
    // A mantissa in [1/4, 1), or 1, of 30 bits; the root is that of `left` times 2^halvings.
    let halvings = 29_u32.saturating_sub(left.ilog2()) / 2;
    let mantissa = (left << (2 * halvings)) as u32;
    let upper = mantissa >> 29 != 0;
    let width = if upper { 24 } else { 23 };
    let piece = (mantissa >> width) - if upper { 0 } else { PIECES };
    let (start, rise) = ROOT[piece as usize];
    let along = mantissa >> (width - 10) & 1023;
    ((((start << 8) + rise * along) >> 11) as i32, 1 << (15 + halvings))
}

/// TSH-1 to TSH-3 in single precision, with each fraction rounded once.
#[inline(always)]
pub fn remap(mapping: DotMapping, bytes: [u8; 4]) -> Vector<f32> {
    fractions(mapping, bytes).map(|(numerator, denominator)| numerator as f32 / denominator as f32)
}

/// TSH-4: returns the three products of a dot product.
#[inline(always)]
pub fn products<N: Number>(a: Vector<N>, b: Vector<N>) -> Vector<N> {
    [a[0] * b[0], a[1] * b[1], a[2] * b[2]]
}

/// TSH-4: adds three products, starting with the first two.
#[inline(always)]
pub fn sum<N: Number>([x, y, z]: Vector<N>) -> N {
    (x + y) + z
}

/// TSH-4: returns the dot product.
#[inline(always)]
pub(crate) fn dot<N: Number>(a: Vector<N>, b: Vector<N>) -> N {
    sum(products(a, b))
}

/// TSH-7: returns the displacement of a coordinate, which is two matrix entries times blue and green. Each operation is
/// rounded.
#[inline(always)]
pub(crate) fn moved<N: Number>(entries: [N; 2], blue_green: [N; 2]) -> N {
    entries[0] * blue_green[0] + entries[1] * blue_green[1]
}

/// Number of products and sums in a dot product.
pub const DOT_OPERATIONS: u64 = 5;

/// Number of products and sums in a reflection: two dot products, a scale, and two products and a difference for each
/// component.
pub const REFLECTION_OPERATIONS: u64 = 2 * DOT_OPERATIONS + 1 + 9;

/// TSH-5: a reflection with its intermediate results.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reflection<N> {
    /// n . e.
    pub toward: N,
    /// n . n.
    pub square: N,
    /// 2 (n . e).
    pub scale: N,
    /// scale n - square e. It is longer than e by the factor n . n, which does not change its direction.
    pub vector: Vector<N>,
}

/// TSH-5: reflects the eye vector about a normal of any length, without a division. Returns the zero vector for the
/// zero normal.
#[inline(always)]
pub fn reflect<N: Number>(normal: Vector<N>, eye: Vector<N>) -> Reflection<N> {
    reflect_about(normal, dot(normal, normal), eye)
}

/// TSH-5: reflects the eye vector about a normal, of which `square` counts as the squared length.
#[inline(always)]
pub(crate) fn reflect_about<N: Number>(normal: Vector<N>, square: N, eye: Vector<N>) -> Reflection<N> {
    let toward = dot(normal, eye);
    let scale = N::TWO * toward;
    let component = |n: usize| scale * normal[n] - square * eye[n];
    let vector = [component(0), component(1), component(2)];
    Reflection { toward, square, scale, vector }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::state::Named;
    use proptest::prelude::*;

    /// Returns whether `value` is the nearest f32 to a fraction, by comparing the distances of its neighbours exactly.
    fn is_nearest(value: f32, (n, d): (i32, i32)) -> bool {
        // All candidates are below 2^24 / 127 and not below 2^-24, so 60 fraction bits hold them.
        let scaled = |f: f32| (f64::from(f) * (1_u64 << 60) as f64) as i128;
        let exact = i128::from(n) << 60;
        let distance = |f: f32| (scaled(f) * i128::from(d) - exact).abs();
        let (lower, upper) = (value.next_down(), value.next_up());
        distance(value) <= distance(lower) && distance(value) <= distance(upper)
    }

    /// Compares every byte in every place of every mapping with its statement and the exact fraction.
    #[test]
    fn bytes_by_their_statement() {
        for byte in 0..=255_u8 {
            let (v, s) = (i32::from(byte), i32::from(byte as i8));
            let want = [(v, 255), (v - 128, 127), (2 * s + 1, 255), (s, 127)];
            for (mapping, want) in DotMapping::ALL.iter().zip(want) {
                let bytes = [byte, 255 - byte, byte ^ 0x55, 7];
                assert_eq!(fractions(*mapping, bytes)[0], want, "{mapping:?} {byte}");
                for (value, fraction) in remap(*mapping, bytes).into_iter().zip(fractions(*mapping, bytes)) {
                    assert!(is_nearest(value, fraction), "{mapping:?} {value} {fraction:?}");
                }
            }
        }
        let [plus, minus] = [255, 0].map(|byte| fractions(DotMapping::MinusOneToOneD3d, [byte; 4])[0]);
        assert_eq!((plus, minus), ((127, 127), (-128, 127)));
    }

    /// Tests every half: A R and G B, high byte first.
    #[test]
    fn halves_by_their_statement() {
        for half in 0..=65535_u16 {
            let [high, low] = half.to_be_bytes();
            let bytes = [low, 0x12, 0x34, high];
            let unsigned = fractions(DotMapping::Hilo1, bytes);
            assert_eq!(unsigned, [(i32::from(half), 65535), (0x1234, 65535), (1, 1)]);
            let signed = fractions(DotMapping::HiloHemisphere, bytes);
            assert_eq!(signed[..2], [(i32::from(half as i16), 32768), (0x1234, 32768)]);
            for mapping in [DotMapping::Hilo1, DotMapping::HiloHemisphere] {
                assert!(is_nearest(remap(mapping, bytes)[0], fractions(mapping, bytes)[0]));
            }
        }
    }

    #[test]
    fn third_components_complete_unit_vectors() {
        assert_eq!((third_of_unit(0, 0), third_of_unit(-32768, 0)), ((1 << 15, 1 << 15), (0, 1)));
        assert_eq!(third_of_unit(30000, 30000), (0, 1));
        // 3-4-5: x = 3/5 and y = 0 yield 4/5, as closely as 32768 allows.
        assert_eq!(third_of_unit(19660, 0), (26214, 1 << 15));
        // What is left of 1 is 65535 / 2^30, and its root 255.998 / 2^15.
        assert_eq!(third_of_unit(32767, 0), (32767, 1 << 22));
    }

    /// The pieces are the root: their ends meet within what is cut.
    #[test]
    fn pieces_of_the_root_meet() {
        for (n, pair) in ROOT.windows(2).enumerate() {
            let [(start, rise), (next, _)] = [pair[0], pair[1]];
            let gap = i64::from(next) - i64::from(start) - 4 * i64::from(rise);
            assert!((0..=5).contains(&gap), "piece {n}: {gap}");
            let of = if n < 32 { (n + 32) as f64 / 128.0 } else { n as f64 / 64.0 };
            assert_eq!(start, (of.sqrt() * f64::from(1 << 18)) as u32, "piece {n}");
        }
    }

    #[test]
    fn reflections_of_axes() {
        // About z, an eye in front is mirrored in x and y.
        assert_eq!(reflect([0.0_f32, 0.0, 2.0], [0.25, -0.5, 1.0]).vector, [-1.0, 2.0, 4.0]);
        // A normal that points at the eye returns its direction.
        assert_eq!(reflect([0.25_f32, 0.5, 1.0], [0.25, 0.5, 1.0]).vector, [0.25, 0.5, 1.0].map(|c| 1.3125 * c));
        assert_eq!(reflect([0.0_f32; 3], [1.0, 0.0, 0.0]).vector, [0.0; 3]);
    }

    proptest! {
        #[test]
        fn the_third_is_near_and_below(high in -32768..=32767_i32, low in -32768..=32767_i32) {
            let (numerator, denominator) = third_of_unit(high, low);
            let third = f64::from(numerator) / f64::from(denominator);
            let left = (32768_i64.pow(2) - i64::from(high).pow(2) - i64::from(low).pow(2)).max(0);
            let off = (left as f64).sqrt() / 32768.0 - third;
            prop_assert!((0.0..=1.3 / f64::from(1 << 14)).contains(&off), "{}", off);
        }

        /// Each operation is correctly rounded. A single operation may be checked in double precision and rounded to
        /// single.
        #[test]
        fn no_operation_is_fused(a in prop::array::uniform3(-2.0..2.0_f32), b in prop::array::uniform3(-2.0..2.0_f32)) {
            let by_double = |x: f32, y: f32, of: fn(f64, f64) -> f64| of(f64::from(x), f64::from(y)) as f32;
            let [x, y, z]: [f32; 3] = std::array::from_fn(|n| by_double(a[n], b[n], |x, y| x * y));
            let sum = by_double(by_double(x, y, |x, y| x + y), z, |x, y| x + y);
            prop_assert_eq!(dot(a, b), sum);
            prop_assert_eq!(moved([a[0], a[1]], [b[0], b[1]]), by_double(x, y, |x, y| x + y));
        }

        /// The reflection keeps the length, except for the factor n . n, and the normal bisects the angle.
        #[test]
        fn reflections_keep_lengths(n in prop::array::uniform3(-2.0..2.0_f64), e in prop::array::uniform3(-2.0..2.0_f64)) {
            let (r, square) = (reflect(n, e).vector, dot(n, n));
            prop_assert!((dot(r, r) - square * square * dot(e, e)).abs() < 1e-9);
            prop_assert!((dot(r, n) - square * dot(e, n)).abs() < 1e-9);
        }

        /// In single precision the reflection stays close to the real one.
        #[test]
        fn single_precision_is_close(n in prop::array::uniform3(-1.0..1.0_f32), e in prop::array::uniform3(-1.0..1.0_f32)) {
            prop_assume!(dot(n, n) > 0.1);
            let (fixed, real) = (reflect(n, e).vector, reflect(n.map(f64::from), e.map(f64::from)).vector);
            for (fixed, real) in fixed.into_iter().zip(real) {
                prop_assert!((f64::from(fixed) - real).abs() < 1e-5);
            }
        }
    }
}
