//! The depth of a pixel (DEP-1), its offset (DEP-5), its range (DEP-4), and the word that is stored (DEP-3).
//!
//! Until it is stored a depth is a [`Binary`], which is rounded only where a rule says so.

use super::interpolate::most_dominant;
use super::setup::Triangle;
use crate::number::convert::{align, depth as fraction, split};
use crate::state::{DepthFormat, DepthRange, DepthTest, PolygonOffset, VertexDepths};

/// The number `mantissa` * 2^`exponent`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Binary {
    /// Signed mantissa of at most 63 bits.
    pub mantissa: i64,
    /// Power of two that scales the mantissa.
    pub exponent: i32,
}

impl Binary {
    /// Converts a finite number exactly.
    pub fn new(n: f32) -> Binary {
        let (mantissa, exponent) = split(n);
        Binary { mantissa, exponent }
    }

    /// Returns the sum. Where the larger number's first `bits` bits, at most 62, do not hold it, it is the odd one of its two neighbours: shorter
    /// numbers are less or greater than that as they are than the sum, and cutting yields the same.
    pub fn plus(self, other: Binary, bits: i32) -> Binary {
        let ([a, b], exponent) = align([(self.mantissa, self.exponent), (other.mantissa, other.exponent)], bits);
        let lost = [self, other].iter().any(|n| {
            let dropped = exponent.saturating_sub(n.exponent);
            n.mantissa != 0 && (n.mantissa.trailing_zeros() as i32) < dropped
        });
        Binary { mantissa: (a + b) | i64::from(lost), exponent }
    }

    /// Whether it is less than another.
    pub fn is_below(self, other: Binary) -> bool {
        let least = self.exponent.min(other.exponent);
        // A number that is shifted by 64 is larger than any mantissa.
        let up = |n: Binary| i128::from(n.mantissa) << (n.exponent - least).min(64);
        up(self) < up(other)
    }
}

/// The depths of a triangle's vertices in steps of the buffer, and the offset of its pixels.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DepthPlane {
    /// z of the vertices, finite.
    pub z: [f32; 3],
    /// w of the vertices, if the buffer holds w (DEP-6).
    pub w: Option<[f32; 3]>,
    /// Offset that is added to every depth (DEP-5).
    pub offset: Binary,
}

impl DepthPlane {
    /// Returns the plane of a triangle whose vertices have these z, and in a w buffer these w, as `test` reads them for a buffer of
    /// `format`. Returns `None` if the triangle is dropped (DEP-4).
    #[inline(always)]
    pub fn new(
        test: &DepthTest,
        format: DepthFormat,
        triangle: &Triangle,
        (z, w): ([f32; 3], Option<[f32; 3]>),
    ) -> Option<DepthPlane> {
        let z = match test.vertex_depths {
            // Integers of 24 bits are exact in binary32.
            VertexDepths::Fractions if !format.is_float() => {
                // Not by a function on arrays, which is not always inlined.
                let mut steps = [0.0; 3];
                for k in 0..3 {
                    steps[k] = fraction(z[k], format.bits()) as f32;
                }
                steps
            }
            _ => z,
        };
        if let Some(DepthRange { lowest, highest, drops_triangles: true, .. }) = test.range
            && (z.iter().all(|z| *z < lowest) || z.iter().all(|z| *z > highest))
        {
            return None;
        }
        let offset = match test.offset {
            PolygonOffset { bias: 0.0, factor: 0.0 } => Binary::default(),
            PolygonOffset { bias, .. } if test.w_buffer => Binary::new(bias),
            _ => offset(test.offset, slope(triangle, z)),
        };
        Some(DepthPlane { z, w: w.filter(|_| test.w_buffer), offset })
    }

    /// DEP-1, DEP-5, DEP-6: returns the depth where the edge functions are `e`.
    #[inline]
    pub fn at(&self, e: [i64; 3]) -> Binary {
        let depth = match self.w {
            Some(w) => interpolate_w(e, w),
            None => interpolate(e, self.z),
        };
        self.with_offset(depth)
    }

    /// DEP-5: adds the offset to a depth.
    #[inline]
    pub(crate) fn with_offset(&self, depth: Binary) -> Binary {
        if self.offset.mantissa == 0 { depth } else { depth.plus(self.offset, SUM_BITS) }
    }
}

/// DEP-4: limits a depth to the range. Returns `None` if the pixel is dropped.
#[inline]
pub fn ranged(range: Option<&DepthRange>, depth: Binary) -> Option<Binary> {
    let Some(range) = range else { return Some(depth) };
    let (lowest, highest) = (Binary::new(range.lowest), Binary::new(range.highest));
    match (depth.is_below(lowest), highest.is_below(depth)) {
        (false, false) => Some(depth),
        (true, _) => range.clamps.then_some(lowest),
        _ => range.clamps.then_some(highest),
    }
}

/// DEP-3: returns the stored word of a depth in steps.
#[inline]
pub fn word(format: DepthFormat, Binary { mantissa, exponent }: Binary) -> u32 {
    if mantissa <= 0 {
        return 0;
    }
    let bits = 64 - mantissa.leading_zeros() as i32;
    if !format.is_float() {
        let full = format.largest();
        return if bits + exponent > 31 {
            full
        } else if exponent >= 0 {
            ((mantissa << exponent) as u32).min(full)
        } else {
            ((mantissa >> (-exponent).min(63)) as u32).min(full)
        };
    }
    // The pattern of binary32, truncated to the bits of the format.
    let (kept, bias) = match format {
        DepthFormat::Z16F => (12, 7),
        _ => (16, 127),
    };
    let power = bits - 1 + exponent;
    let up = kept - (bits - 1);
    let fraction = (if up >= 0 { mantissa << up } else { mantissa >> -up }) & ((1 << kept) - 1);
    match power + bias {
        ..=0 => 0,
        beyond if beyond > if format == DepthFormat::Z16F { 15 } else { 254 } => format.largest(),
        field => (field as u32) << kept | fraction as u32,
    }
}

/// Bits of the larger of a depth and its offset that their sum keeps: so many that nothing is lost where they cancel.
const SUM_BITS: i32 = 62;

/// Bits of the larger part of an offset. The sum of both parts has one more.
const OFFSET_BITS: i32 = 60;

/// DEP-5: returns the offset of a triangle from bias, factor and slope.
#[cold]
pub fn offset(PolygonOffset { bias, factor }: PolygonOffset, slope: Binary) -> Binary {
    let (of_factor, exponent) = split(factor);
    let product = i128::from(slope.mantissa) * i128::from(of_factor);
    let dropped = (128 - product.unsigned_abs().leading_zeros()).saturating_sub(OFFSET_BITS as u32);
    let odd = i64::from(product >> dropped << dropped != product);
    let scaled =
        Binary { mantissa: (product >> dropped) as i64 | odd, exponent: slope.exponent + exponent + dropped as i32 };
    Binary::new(bias).plus(scaled, OFFSET_BITS)
}

/// Returns the larger magnitude of dz/dx and dz/dy, truncated at the 29th bit from the top of the largest z.
#[cold]
pub fn slope(triangle: &Triangle, z: [f32; 3]) -> Binary {
    const KEPT: i32 = 62;
    let (aligned, exponent) = align(z.map(split), KEPT);
    let along = |edges: [i64; 3]| -> i128 {
        let sum: i128 = (0..3).map(|k| i128::from(edges[k]) * i128::from(aligned[k])).sum();
        sum.abs()
    };
    // The largest z has its leading bit at KEPT - 1 of `aligned`, and 28 bits below it count.
    let dropped = KEPT - 29;
    let steepest = along(triangle.a).max(along(triangle.b));
    let mantissa = steepest / (i128::from(triangle.doubled_area) << dropped);
    Binary { mantissa: mantissa as i64, exponent: exponent + dropped }
}

/// Significant bits of the largest edge number, and of the largest term of a depth (DEP-1).
const DEPTH_BITS: i32 = 29;

/// DEP-1: sum, reciprocal and weights of edge numbers that are truncated to 24 bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct DepthWeights {
    edges: [i64; 3],
    /// The sum S.
    pub sum: i64,
    /// The reciprocal R as a mantissa of 29 bits, and the s of its scale 2^-s.
    pub reciprocal: (i64, i32),
}

impl DepthWeights {
    /// Computes the weights of edge functions.
    #[inline]
    pub(crate) fn from_edges(e: [i64; 3]) -> DepthWeights {
        DepthWeights::from_cut_edges(e.map(|e| significant(e, 24)))
    }

    fn from_cut_edges(edges: [i64; 3]) -> DepthWeights {
        let top = edges.iter().map(|e| 64 - e.unsigned_abs().leading_zeros() as i32).max().unwrap_or(0);
        let dropped = (top - DEPTH_BITS).max(0);
        // Outside the triangle, where nothing is stored, edge numbers may be negative.
        let sum = edges.iter().map(|e| e.signum() * (e.abs() >> dropped)).sum::<i64>().max(1);
        let (mantissa, exponent) = reciprocal(sum);
        DepthWeights { edges, sum: sum << dropped, reciprocal: (mantissa, exponent + dropped) }
    }

    /// Returns the weight b_k as a mantissa of at most 24 bits and an exponent.
    #[inline]
    pub(crate) fn weight(&self, k: usize) -> (i64, i32) {
        let (mantissa, dropped) = first_24(i128::from(self.edges[k]) * i128::from(self.reciprocal.0));
        (mantissa, dropped - self.reciprocal.1)
    }
}

/// DEP-1: returns z_d + sum of b_k (z_k - z_d) with each term truncated. The interpolation is linear on the screen.
#[inline]
pub fn interpolate(e: [i64; 3], z: [f32; 3]) -> Binary {
    let (reference, weights) = (largest_edge(e), DepthWeights::from_edges(e));
    let terms: [(i64, i32); 3] = std::array::from_fn(|k| {
        if k == reference {
            return split(z[k]);
        }
        let ((mantissa, exponent), (by, power)) = (weights.weight(k), split(difference(z[k], z[reference])));
        (mantissa * by, exponent + power)
    });
    sum_of_terms(terms)
}

/// DEP-6: returns w_1 + b_0 (w_0 - w_1) + b_2 (w_2 - w_1) with perspective weights, each term truncated as in DEP-1.
fn interpolate_w(e: [i64; 3], w: [f32; 3]) -> Binary {
    let edges = std::array::from_fn(|k| {
        let (ratio, power) = w_ratio(w[1], w[k]);
        let (edge, of_edge) = first_24(i128::from(e[k]));
        let (product, more) = first_24(i128::from(edge) * i128::from(ratio));
        (product, power + of_edge + more)
    });
    let (edges, _) = align(edges, 61);
    let cut = DepthWeights::from_cut_edges(edges);
    let mut weights = [0, 1, 2].map(|k| cut.weight(k));
    // INT-3: the dominant weight is 1 less the others.
    let size = |(mantissa, exponent): (i64, i32)| {
        if mantissa > 0 { 64 - mantissa.leading_zeros() as i32 + exponent } else { i32::MIN }
    };
    let dominant = match most_dominant(weights.map(size)) {
        [true, _] => 0,
        [_, true] => 2,
        _ => 1,
    };
    let ([whole, one, other], exponent) = align([(1, 0), weights[(dominant + 1) % 3], weights[(dominant + 2) % 3]], 61);
    let (rest, dropped) = first_24(i128::from(whole) - i128::from(one) - i128::from(other));
    weights[dominant] = (rest, dropped + exponent);
    let term = |k: usize| {
        let (by, power) = split(difference(w[k], w[1]));
        (weights[k].0 * by, weights[k].1 + power)
    };
    sum_of_terms([term(0), split(w[1]), term(2)])
}

/// DEP-6: returns w_1/w_k of two positive w as a mantissa of 24 bits and an exponent.
pub(crate) fn w_ratio(first: f32, w: f32) -> (i64, i32) {
    let ((first, power_of_first), (mantissa, power)) = (split(first), split(w));
    let (ratio, dropped) = first_24((i128::from(first) << 62) / i128::from(mantissa.max(1)));
    (ratio, power_of_first - power - 62 + dropped)
}

/// Returns the first 24 bits of a number, truncated toward zero, and the number of bits that were dropped.
fn first_24(n: i128) -> (i64, i32) {
    let dropped = (128 - n.unsigned_abs().leading_zeros() as i32 - 24).max(0);
    let magnitude = (n.unsigned_abs() >> dropped) as i64;
    (if n < 0 { -magnitude } else { magnitude }, dropped)
}

/// DEP-1: aligns terms to the largest, truncates them toward zero at its 29th bit, and adds them.
fn sum_of_terms(terms: [(i64, i32); 3]) -> Binary {
    let bits = |n: i64| 64 - n.unsigned_abs().leading_zeros() as i32;
    let Some(top) = terms.iter().filter(|term| term.0 != 0).map(|term| bits(term.0) + term.1).max() else {
        return Binary::default();
    };
    let unit = top - DEPTH_BITS;
    let cut = |(n, exponent): (i64, i32)| match exponent - unit {
        // A zero may have any exponent.
        up if up >= 0 => n << up.min(63),
        down => n.signum() * (n.abs() >> (-down).min(63)),
    };
    Binary { mantissa: terms.into_iter().map(cut).sum(), exponent: unit }
}

/// Returns the difference of two vertex depths in binary32, rounded to nearest. A difference below 2^-126 becomes zero.
#[allow(clippy::float_arithmetic, reason = "DEP-1 names binary32 for this one difference")]
#[inline(always)]
pub(crate) fn difference(a: f32, b: f32) -> f32 {
    let difference = a - b;
    if difference.is_subnormal() { 0.0 } else { difference }
}

/// DEP-1: returns the vertex whose edge number has the largest binary exponent. Among equals, vertex 1 comes first,
/// then 0, then 2.
pub fn largest_edge(e: [i64; 3]) -> usize {
    let [first, second, third] = e.map(|e| if e > 0 { 64 - e.leading_zeros() } else { 0 });
    if second >= first && second >= third {
        1
    } else if first >= third {
        0
    } else {
        2
    }
}

/// Truncates a number toward zero to its first `bits` bits.
fn significant(n: i64, bits: u32) -> i64 {
    let dropped = (64 - n.unsigned_abs().leading_zeros()).saturating_sub(bits);
    n.signum() * (n.abs() >> dropped << dropped)
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

#[cfg(test)]
#[allow(clippy::float_arithmetic, reason = "choosing depths")]
mod tests {
    use super::*;
    use crate::state::{CompareFunction, Named, Profile};
    use proptest::prelude::*;

    /// Converts a finite binary32 number to a word of the float formats by its bit pattern.
    fn by_pattern(format: DepthFormat, z: f32) -> u32 {
        let pattern = z.max(0.0).to_bits();
        match format {
            DepthFormat::Z24S8F if pattern >> 23 == 0 => 0,
            DepthFormat::Z24S8F => pattern >> 7,
            _ => match (i64::from(pattern >> 11) - 0x78000).clamp(0, 0xffff) as u32 {
                word if word >> 12 == 0 => 0,
                word => word,
            },
        }
    }

    proptest! {
        #[test]
        fn float_words_are_cut_patterns(bits in 0_u32..0x7f80_0000, down in any::<bool>()) {
            let z = f32::from_bits(bits) * if down { -1.0 } else { 1.0 };
            for format in [DepthFormat::Z24S8F, DepthFormat::Z16F] {
                prop_assert_eq!(word(format, Binary::new(z)), by_pattern(format, z), "{} {}", format.name(), z);
            }
        }

        #[test]
        fn fixed_words_are_floors(z in -1.0_f32..17_000_000.0) {
            for format in [DepthFormat::Z24S8, DepthFormat::Z16] {
                let wanted = f64::from(z).floor().clamp(0.0, f64::from(format.largest())) as u32;
                prop_assert_eq!(word(format, Binary::new(z)), wanted);
            }
        }

        #[test]
        fn ranges_hold(z in -9.0_f32..9.0, lowest in -5.0_f32..5.0, more in 0.0_f32..5.0, clamps in any::<bool>()) {
            let range = DepthRange { lowest, highest: lowest + more, clamps, drops_triangles: false };
            let inside = (range.lowest..=range.highest).contains(&z);
            let held = Binary::new(z.clamp(range.lowest, range.highest));
            prop_assert_eq!(ranged(Some(&range), Binary::new(z)), (inside || clamps).then_some(held));
        }
    }

    proptest! {
        /// Sums and comparisons are those of whole numbers with all bits, as far as shorter numbers can tell.
        #[test]
        fn sums_compare_as_exact_ones(
            a in (-(1_i64 << 31)..1 << 31, 0_i32..64),
            b in (-(1_i64 << 61)..1 << 61, 0_i32..64, 0_u32..60),
            c in (-(1_i64 << 24)..1 << 24, 0_i32..90),
            near in any::<bool>(),
        ) {
            let exact = |mantissa: i64, exponent: i32| i128::from(mantissa) << exponent.min(63);
            let (depth, offset) = (Binary { mantissa: a.0, exponent: a.1 }, Binary { mantissa: b.0 >> b.2, exponent: b.1 });
            let wanted = exact(depth.mantissa, depth.exponent) + exact(offset.mantissa, offset.exponent);
            let sum = depth.plus(offset, SUM_BITS);
            // Beside the sum, or anywhere.
            let dropped = (128 - wanted.unsigned_abs().leading_zeros()).saturating_sub(24) as i32;
            let short = if near && dropped < 64 { ((wanted >> dropped) as i64 + c.0.signum(), dropped) } else { (c.0, c.1.min(63)) };
            let limit = Binary { mantissa: short.0, exponent: short.1 };
            prop_assert_eq!(sum.is_below(limit), wanted < exact(short.0, short.1));
            prop_assert_eq!(limit.is_below(sum), exact(short.0, short.1) < wanted);
        }
    }

    /// A step that 61 bits do not hold lies beyond a limit.
    #[test]
    fn the_least_excess_is_outside() {
        let range = DepthRange { lowest: -1.0, highest: 16_777_215.0, clamps: false, drops_triangles: false };
        let kept = |z: f32, more: f32| {
            let plane = DepthPlane { offset: Binary::new(more), ..DepthPlane::default() };
            ranged(Some(&range), plane.with_offset(Binary::new(z))).is_some()
        };
        let least = f32::from_bits(1);
        assert!(kept(16_777_215.0, 0.0) && kept(16_777_215.0, -least) && kept(-1.0, least) && kept(-1.0, 0.0));
        assert!(!kept(least, 16_777_215.0) && !kept(16_777_215.0, least) && !kept(-1.0, -least));
        assert_eq!(word(DepthFormat::Z24S8, Binary::new(5.0).plus(Binary::new(-least), SUM_BITS)), 4);
        assert_eq!(word(DepthFormat::Z24S8, Binary::new(5.0).plus(Binary::new(least), SUM_BITS)), 5);
    }

    #[test]
    fn words_at_the_ends() {
        let of = |format, z: f32| word(format, Binary::new(z));
        assert_eq!([1.0, 1.5, 2.0].map(|z| of(DepthFormat::Z24S8F, z)), [0x7f0000, 0x7f8000, 0x800000]);
        assert_eq!([1.0, 1.5, 511.9375].map(|z| of(DepthFormat::Z16F, z)), [0x7000, 0x7800, 0xffff]);
        assert_eq!([0.0, -3.0, 1e-3, 600.0].map(|z| of(DepthFormat::Z16F, z)), [0, 0, 0, 0xffff]);
        assert_eq!([f32::MAX, f32::MIN_POSITIVE, 1e-40].map(|z| of(DepthFormat::Z24S8F, z)), [0xfe_ffff, 0x01_0000, 0]);
        assert_eq!([65_535.9, 65_536.0, 1e30, -0.5].map(|z| of(DepthFormat::Z16, z)), [0xffff, 0xffff, 0xffff, 0]);
    }

    fn plane(bias: f32, factor: f32, p: [[f32; 4]; 3]) -> (DepthPlane, Triangle) {
        let triangle = Triangle::new(p, true, Profile::Nv2a).expect("area");
        let test = DepthTest {
            vertex_depths: VertexDepths::Steps,
            offset: PolygonOffset { bias, factor },
            ..DepthTest::new(CompareFunction::Less, true)
        };
        (DepthPlane::new(&test, DepthFormat::Z24S8, &triangle, (p.map(|p| p[2]), None)).expect("no range"), triangle)
    }

    #[test]
    fn steps_beyond_the_buffer_are_interpolated_as_they_are() {
        let p = [
            [53.1875, -34.3125, 16_809_768.0, 1.0],
            [1808.6875, 453.0, 16_572_698.0, 1.0],
            [-1168.6875, 453.0, 16_572_698.0, 1.0],
        ];
        let (plane, triangle) = plane(0.0, 0.0, p);
        let depth = plane.at(triangle.edges(452, 242));
        assert_eq!(word(DepthFormat::Z24S8, depth), 16_675_103);
    }

    /// The slope is about 486.4845 and is cut to 486.4375 below a z of 2^24. Times 16 it is 7783.
    #[test]
    fn slopes_are_cut_at_the_29th_bit() {
        // dz/dy is about 486.4845: 237070 over 487.3125 rows.
        let p = [
            [53.1875, -34.3125, 16_809_768.0, 1.0],
            [1808.6875, 453.0, 16_572_698.0, 1.0],
            [-1168.6875, 453.0, 16_572_698.0, 1.0],
        ];
        let (with, triangle) = plane(0.0, 16.0, p);
        let slope = slope(&triangle, with.z);
        assert_eq!((slope.mantissa, slope.exponent), (486 * 16 + 7, -4));
        assert_eq!(with.offset.mantissa as f64 * 2.0_f64.powi(with.offset.exponent), 7783.0);
        let (biased, _) = plane(-0.5, 16.0, p);
        assert_eq!(biased.offset.mantissa as f64 * 2.0_f64.powi(biased.offset.exponent), 7782.5);
    }

    /// Words of captured buffers, from TriH and LargeZ.
    #[test]
    fn w_is_interpolated_in_perspective() {
        let word_at = |e, w| word(DepthFormat::Z24S8, interpolate_w(e, w));
        let steep = [325.0, 325.0, 58.0];
        assert_eq!(word_at([408_448, 51_072, 51_200], steep), 222);
        assert_eq!(word_at([229_504, 153_216, 128_000], steep), 150);
        assert_eq!(word_at([24_448, 51_072, 435_200], steep), 66);
        let large = [16_777_046.0, 16_777_047.0, 16_777_047.0];
        assert_eq!(word_at([1_556_480, 24_637_440, 52_449_280], large), 16_777_047);
        assert_eq!(word_at([13_025_280, 24_637_440, 40_980_480], large), 16_777_046);
        // Equal w are exact.
        assert_eq!(
            interpolate_w([5, 70_000, 3], [10.0; 3]).mantissa as f64
                * 2.0_f64.powi(interpolate_w([5, 70_000, 3], [10.0; 3]).exponent),
            10.0
        );
    }

    #[test]
    fn a_flat_triangle_beyond_a_limit_is_dropped_whole() {
        let p = [[0.0, 0.0, 5.0, 1.0], [8.0, 0.0, 6.0, 1.0], [0.0, 8.0, 7.0, 1.0]];
        let triangle = Triangle::new(p, true, Profile::Nv2a).expect("area");
        let at = |lowest, highest, drops_triangles| {
            let range = Some(DepthRange { lowest, highest, clamps: true, drops_triangles });
            let test =
                DepthTest { vertex_depths: VertexDepths::Steps, range, ..DepthTest::new(CompareFunction::Less, true) };
            DepthPlane::new(&test, DepthFormat::Z16, &triangle, ([5.0, 6.0, 7.0], None)).is_some()
        };
        assert!(at(7.0, 9.0, true) && at(0.0, 5.0, true) && at(8.0, 9.0, false));
        assert!(!at(8.0, 9.0, true) && !at(0.0, 4.0, true));
    }
}
