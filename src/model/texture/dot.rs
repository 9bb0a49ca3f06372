//! TSH-1 to TSH-5, TSH-7: the dot unit. It computes in single precision, because the chip does, and is the only place
//! of the fixed path with floats.
//!
//! Products and quotients are those of IEEE single precision, each rounded separately; nothing is fused. Sums are aligned ones of WGT-1.
//! Every machine therefore computes the same bits, except those of a NaN, which counts as 0 wherever it is used.
#![allow(clippy::float_arithmetic, reason = "the chip's dot unit is a float unit (TSH-4); its ideal stands beside it")]

use crate::number::Integer;
use crate::raster::weights::cut_sum;
use crate::state::DotMapping;
use std::ops::{Add, Mul, Neg};

/// A number of the dot unit: `f32` for the definition, `f64` for the ideal.
pub trait Number: Copy + Mul<Output = Self> + Neg<Output = Self> {
    /// The number 0.
    const ZERO: Self;
    /// The number 2.
    const TWO: Self;

    /// TSH-4: returns the sum of products.
    fn sum(products: [Self; 3]) -> Self;

    /// TSH-5: returns the sum of two products.
    #[inline(always)]
    fn sum_of_two(a: Self, b: Self) -> Self {
        Self::sum([a, b, Self::ZERO])
    }
}

impl Number for f32 {
    const ZERO: f32 = 0.0;
    const TWO: f32 = 2.0;

    /// The sum has 24 bits: it is a binary32 number or beyond them all, which is infinite. A zero becomes positive. Products that are infinite or no
    /// numbers are added as doubles.
    #[inline(always)]
    fn sum(products: [f32; 3]) -> f32 {
        cut_sum(products.map(f64::from)) as f32 + 0.0
    }
}

impl Number for f64 {
    const ZERO: f64 = 0.0;
    const TWO: f64 = 2.0;

    #[inline(always)]
    fn sum([x, y, z]: [f64; 3]) -> f64 {
        (x + y) + z
    }
}

/// A vector of three numbers, such as coordinates or a remapped colour.
pub type Vector<N> = [N; 3];

/// Reads a number of `bits` bits as two's complement.
#[inline(always)]
pub fn signed<I: Integer>(n: I, bits: u32) -> I {
    n - I::new(0).or(n.is_below(I::new(1 << (bits - 1))), I::new(1 << bits))
}

/// TSH-1, TSH-2 and TSH-3: returns three fractions, each a numerator and a denominator, of the bytes R, G, B, A of a colour. Numerators have at most
/// 16 bits and a sign, denominators as many, or are powers of two up to 2^29.
#[inline(always)]
pub fn fractions<I: Integer>(mapping: DotMapping, [r, g, b, a]: [I; 4]) -> [(I, I); 3] {
    let over = |whole: i64, numerators: [I; 3]| numerators.map(|numerator| (numerator, I::new(whole)));
    let halves = [(a, r), (g, b)].map(|(high, low)| high.up(I::new(8)) + low);
    match mapping {
        DotMapping::ZeroToOne => over(255, [r, g, b]),
        DotMapping::MinusOneToOneD3d => over(127, [r, g, b].map(|v| v - I::new(128))),
        DotMapping::MinusOneToOneGl => over(255, [r, g, b].map(|v| signed(v, 8).up(I::new(1)) + I::new(1))),
        DotMapping::MinusOneToOne => over(127, [r, g, b].map(|v| signed(v, 8))),
        DotMapping::Hilo1 => {
            let whole = I::new(65535);
            [(halves[0], whole), (halves[1], whole), (I::new(1), I::new(1))]
        }
        DotMapping::HiloHemisphere => {
            let [x, y] = halves.map(|half| signed(half, 16));
            [(x, I::new(1 << 15)), (y, I::new(1 << 15)), third_of_unit(x, y)]
        }
    }
}

/// TSH-3: number of pieces of the root of a mantissa in [1/4, 1/2), and of one in [1/2, 1).
const PIECES: usize = 32;

/// TSH-3: the straight pieces of the root, 32 to an octave: the root at a piece's start with 18 fraction bits, and its rise
/// with 16, both cut. The last is the root of 1.
const ROOT: [(u32, u32); 2 * PIECES + 1] = {
    let mut pieces = [(1 << 18, 0); 2 * PIECES + 1];
    let mut at = 0;
    while at < 2 * PIECES {
        // A piece of the lower octave is 1/128 wide, of the upper 1/64; roots have 30 fraction bits first.
        let (start, up) = if at < PIECES { (at as u64 + 32, 53) } else { (at as u64, 54) };
        let (root, next) = ((start << up).isqrt(), ((start + 1) << up).isqrt());
        pieces[at] = ((root >> 12) as u32, ((next - root) >> 14) as u32);
        at += 1;
    }
    pieces
};

/// TSH-3: the bytes of the straight pieces of the root, the lowest first: three of the starts, two of the rises.
pub static ROOT_BYTES: [[u8; ROOT.len()]; 5] = {
    let mut bytes = [[0; ROOT.len()]; 5];
    let mut at = 0;
    while at < ROOT.len() {
        let (start, rise) = ROOT[at];
        let [a, b, c, _] = start.to_le_bytes();
        let [d, e, ..] = rise.to_le_bytes();
        (bytes[0][at], bytes[1][at], bytes[2][at], bytes[3][at], bytes[4][at]) = (a, b, c, d, e);
        at += 1;
    }
    bytes
};

/// TSH-3: returns the third component of the unit vector with x = high/32768 and y = low/32768, a fraction of at most 16
/// bits over a power of two. It is at most 1.3 * 2^-14 below the root of what is left, and never above.
#[inline(always)]
fn third_of_unit<I: Integer>(high: I, low: I) -> (I, I) {
    let (zero, one) = (I::new(0), I::new(1));
    let left = (I::new(1 << 30) - high * high - low * low).within(-(1 << 30), 1 << 30);
    let positive = left.greatest(one);
    // A mantissa in [1/4, 1), or 1, of 30 bits; the root is that of `left` times 2^halvings.
    let halvings = (I::new(30) - positive.bits()).greatest(zero).down(one);
    let mantissa = positive.up(halvings.up(one)).within(1 << 28, 1 << 30);
    let is_lower = mantissa.is_below(I::new(1 << 29));
    let of_piece = mantissa.down(I::new(13).or(is_lower, I::new(14)));
    let piece = (of_piece.down(I::new(10)) - I::new(PIECES as i64).or(is_lower, zero)).within(0, 2 * PIECES as i64);
    let byte = |n: usize| piece.entry(&ROOT_BYTES[n]).up(I::new([0, 8, 16, 0, 8][n]));
    let (start, rise) = (byte(0) + byte(1) + byte(2), byte(3) + byte(4));
    let root = (start.up(I::new(8)) + rise * of_piece.masked(1023)).down(I::new(11));
    let is_nothing = left.is_below(one);
    (zero.or(is_nothing, root), one.or(is_nothing, one.up(halvings + I::new(15))))
}

/// TSH-1 to TSH-3 in single precision, with each fraction rounded once.
#[inline(always)]
pub fn remap(mapping: DotMapping, bytes: [u8; 4]) -> Vector<f32> {
    fractions(mapping, bytes.map(i32::from)).map(|(numerator, denominator)| numerator as f32 / denominator as f32)
}

/// TSH-4: returns the three products of a dot product.
#[inline(always)]
pub fn products<N: Number>(a: Vector<N>, b: Vector<N>) -> Vector<N> {
    [a[0] * b[0], a[1] * b[1], a[2] * b[2]]
}

/// TSH-4: returns the dot product.
#[inline(always)]
pub fn dot<N: Number>(a: Vector<N>, b: Vector<N>) -> N {
    N::sum(products(a, b))
}

/// TSH-7: returns the displacement of a coordinate, which is two matrix entries times blue and green. Each operation is
/// rounded.
#[inline(always)]
pub fn moved<N: Number + Add<Output = N>>(entries: [N; 2], blue_green: [N; 2]) -> N {
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

/// TSH-5: returns the scale of a reflection, by n . e.
#[inline(always)]
pub fn scale<N: Number>(toward: N) -> N {
    N::TWO * toward
}

/// TSH-5: returns a component of a reflection, by those of the normal and the eye vector.
#[inline(always)]
pub fn reflected<N: Number>([scale, square]: [N; 2], [normal, eye]: [N; 2]) -> N {
    N::sum_of_two(scale * normal, -(square * eye))
}

/// TSH-5: reflects the eye vector about a normal, of which `square` counts as the squared length.
#[inline(always)]
pub fn reflect_about<N: Number>(normal: Vector<N>, square: N, eye: Vector<N>) -> Reflection<N> {
    let toward = dot(normal, eye);
    let scale = scale(toward);
    let component = |n: usize| reflected([scale, square], [normal[n], eye[n]]);
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
                assert_eq!(fractions(*mapping, bytes.map(i32::from))[0], want, "{mapping:?} {byte}");
                for (value, fraction) in
                    remap(*mapping, bytes).into_iter().zip(fractions(*mapping, bytes.map(i32::from)))
                {
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
            let unsigned = fractions(DotMapping::Hilo1, bytes.map(i32::from));
            assert_eq!(unsigned, [(i32::from(half), 65535), (0x1234, 65535), (1, 1)]);
            let signed = fractions(DotMapping::HiloHemisphere, bytes.map(i32::from));
            assert_eq!(signed[..2], [(i32::from(half as i16), 32768), (0x1234, 32768)]);
            for mapping in [DotMapping::Hilo1, DotMapping::HiloHemisphere] {
                assert!(is_nearest(remap(mapping, bytes)[0], fractions(mapping, bytes.map(i32::from))[0]));
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

        /// Each product is correctly rounded: double precision holds it exactly. The sum is that of whole steps, which are cut.
        #[test]
        fn no_operation_is_fused(a in prop::array::uniform3(-2.0..2.0_f32), b in prop::array::uniform3(-2.0..2.0_f32)) {
            let by_double = |x: f32, y: f32, of: fn(f64, f64) -> f64| of(f64::from(x), f64::from(y)) as f32;
            let products: [f32; 3] = std::array::from_fn(|n| by_double(a[n], b[n], |x, y| x * y));
            let largest = products.iter().fold(0.0_f32, |most, product| most.max(product.abs()));
            let step = f64::from(largest).log2().floor().exp2() / f64::from(1 << 23);
            let steps: i64 = products.iter().map(|product| (f64::from(*product) / step) as i64).sum();
            // Three terms of 24 bits may have 26.
            let over = (64 - steps.unsigned_abs().leading_zeros()).saturating_sub(24);
            let sum = (steps.signum() * (steps.abs() >> over << over)) as f64 * step;
            prop_assert_eq!(f64::from(dot(a, b)), sum);
            let [x, y, _] = products;
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
