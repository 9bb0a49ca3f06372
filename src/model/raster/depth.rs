//! The depth of a pixel (DEP-1), its offset (DEP-5), its range (DEP-4), and the word that is stored (DEP-3).
//!
//! Until it is stored a depth is a [`Binary`], which is rounded only where a rule says so. Weights are those of [WGT-1](super::weights) without
//! perspective, before the dominant one becomes the rest of the others.

use super::binary::Binary;
use super::setup::{Triangle, signed_ratios};
use super::stroke::Figure;
use super::weights::{Linear, Number, Weights, difference, outer_weights_by, shares_at};
use crate::number::Integer;
use crate::number::convert::{align, depth as fraction, split};
use crate::state::{DepthFormat, DepthRange, DepthTest, PolygonOffset, VertexDepths};

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
            // LIN-3: it is for filled triangles.
            _ if triangle.figure != Figure::Triangle => Binary::default(),
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
        if self.offset.mantissa == 0 { depth } else { moved(depth, self.offset) }
    }
}

/// DEP-5: returns the sum of a depth and an offset.
#[inline]
pub fn moved<I: Integer>(depth: Binary<I>, offset: Binary<I>) -> Binary<I> {
    depth.plus(offset, SUM_BITS)
}

/// DEP-4: limits a depth to the range. Returns `None` if the pixel is dropped.
#[inline]
pub fn ranged(range: Option<&DepthRange>, depth: Binary) -> Option<Binary> {
    let Some(range) = range else { return Some(depth) };
    let (depth, is_outside) = limited(range, depth);
    (range.clamps || !is_outside).then_some(depth)
}

/// DEP-4: limits a depth to a range, and returns whether it was outside.
#[inline]
pub fn limited<I: Integer>(range: &DepthRange, depth: Binary<I>) -> (Binary<I>, I::Choice) {
    limited_to([range.lowest, range.highest].map(Binary::<I>::from_f32), depth)
}

/// DEP-4: returns [`limited`] of a range that goes from the lowest to the highest depth.
#[inline]
pub fn limited_to<I: Integer>([lowest, highest]: [Binary<I>; 2], depth: Binary<I>) -> (Binary<I>, I::Choice) {
    let (below, above) = (depth.is_below(lowest), highest.is_below(depth));
    (lowest.or(below, highest.or(above, depth)), below | above)
}

/// DEP-3: returns the stored word of a depth in steps.
#[inline]
pub fn word(format: DepthFormat, depth: Binary) -> u32 {
    stored(format, depth) as u32
}

/// DEP-3: returns the stored word of a depth in steps as a number.
#[inline(always)]
pub fn stored<I: Integer>(format: DepthFormat, depth: Binary<I>) -> I {
    let (zero, full) = (I::new(0), i64::from(format.largest()));
    if !format.is_float() {
        return depth.far_floored(I::new(1), zero, I::new(full)).greatest(zero);
    }
    // The pattern of binary32, truncated to the bits of the format.
    let (kept, bias, most) = match format {
        DepthFormat::Z16F => (12, 7, 15),
        _ => (16, 127, 254),
    };
    let mantissa = depth.mantissa.greatest(zero);
    let last = mantissa.bits() - I::new(1);
    let up = I::new(kept) - last;
    let pattern = mantissa.down((zero - up).limited(0, 63)).or(up.is_negative(), mantissa.up(up.limited(0, 63)));
    let field = last + depth.exponent + I::new(bias);
    let word = I::new(full)
        .or(I::new(most).is_below(field), field.limited(0, most).up(I::new(kept)) + pattern.masked((1 << kept) - 1));
    word.or(zero.is_below(mantissa) & zero.is_below(field), zero)
}

/// Returns the depth in steps that is stored as a word, or `None` if none is: a float whose exponent is 0, or beyond the numbers.
pub fn of_word(format: DepthFormat, word: u32) -> Option<f32> {
    let (kept, above) = match format {
        DepthFormat::Z16 | DepthFormat::Z24S8 => return Some(word as f32),
        DepthFormat::Z16F => (12, 0x78000),
        DepthFormat::Z24S8F => (16, 0),
    };
    let is_number = word >> kept != 0 && word <= format.largest() && !(kept == 16 && word >> kept == 255);
    (is_number || word == 0).then(|| f32::from_bits(if word == 0 { 0 } else { (word + above) << (23 - kept) }))
}

/// Bits of the larger of a depth and its offset that their sum keeps: so many that nothing is lost where they cancel.
const SUM_BITS: i64 = 62;

/// Bits of the larger part of an offset. The sum of both parts has one more.
const OFFSET_BITS: i64 = 60;

/// DEP-5: returns the offset of a triangle from bias, factor and slope.
#[cold]
pub fn offset(PolygonOffset { bias, factor }: PolygonOffset, slope: Binary) -> Binary {
    let (of_factor, exponent) = split(factor);
    let product = i128::from(slope.mantissa) * i128::from(of_factor);
    let dropped = (128 - product.unsigned_abs().leading_zeros()).saturating_sub(OFFSET_BITS as u32);
    let odd = i64::from(product >> dropped << dropped != product);
    let exponent = slope.exponent + i64::from(exponent) + i64::from(dropped);
    let scaled = Binary { mantissa: (product >> dropped) as i64 | odd, exponent };
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
    Binary { mantissa: mantissa as i64, exponent: i64::from(exponent + dropped) }
}

/// DEP-1: returns the weights of the vertices, of which the [shares](Weights::shares) count. They are linear on the screen.
#[inline]
pub(crate) fn weights(e: [i64; 3]) -> Weights<Binary> {
    Weights::new(e.map(Binary::from_edge), None)
}

/// DEP-1: returns z_d + sum of b_k (z_k - z_d) with each term cut at the 29th bit of the largest.
#[inline]
pub fn interpolate(e: [i64; 3], z: [f32; 3]) -> Binary {
    let reference = largest_edge(e);
    let choice = reference_vertex(e);
    // Smooth edges reach outside of the triangle (SMO-2).
    let shares = shares_at::<_, false>(e.map(Binary::from_edge), None);
    sum_of_terms(shares, Binary::new(z[reference]), differences(z, reference), choice)
}

/// DEP-6: returns the depth of vertices with these w.
fn interpolate_w(e: [i64; 3], w: [f32; 3]) -> Binary {
    w_depth(e.map(Binary::from_edge), signed_ratios(w), Linear::new(w), cut_rest)
}

/// DEP-6: returns w_1 + b_0 (w_0 - w_1) + b_2 (w_2 - w_1) with perspective weights, each term cut as in DEP-1. The dominant weight is what `cut_rest` makes
/// of the others.
pub fn w_depth<N: Number>(e: [N; 3], ratios: [N; 3], w: Linear<N>, cut_rest: impl FnOnce(N, N) -> N) -> N {
    w_of_shares::<N, false>(shares_at::<N, false>(e, Some(ratios)), w, cut_rest)
}

/// DEP-6: returns the same of the shares of the vertices. `COVERED` says that none is negative.
#[inline(always)]
pub(crate) fn w_of_shares<N: Number, const COVERED: bool>(
    shares: [N; 3],
    w: Linear<N>,
    cut_rest: impl FnOnce(N, N) -> N,
) -> N {
    let [b0, b2] = outer_weights_by::<N, COVERED>(shares, cut_rest);
    N::sum_of_products([[b0, w.first], [N::one(), w.second], [b2, w.third]])
}

/// DEP-6: returns 1 less two weights: cut, not rounded up as in WGT-1.
pub fn cut_rest<I: Integer>(a: Binary<I>, b: Binary<I>) -> Binary<I> {
    let parts = [Binary::whole(I::new(1)), a, b].map(|n| (n.mantissa, n.exponent));
    let ([whole, one, other], exponent) = crate::number::align(parts, 61);
    Binary { mantissa: whole - one - other, exponent }.cut()
}

/// Returns the differences of numbers from that of the reference vertex.
fn differences(values: [f32; 3], reference: usize) -> [Binary; 3] {
    values.map(|value| Binary::new(difference(value, values[reference])))
}

/// DEP-1: returns the sum of the reference vertex's number and of the weighted differences from it, each cut at the 29th bit of the largest.
#[inline(always)]
pub fn sum_of_terms<N: Number>(b: [N; 3], value: N, differences: [N; 3], is_reference: [N::Choice; 3]) -> N {
    let one = N::one();
    let term = |k: usize| [one.or(is_reference[k], b[k]), value.or(is_reference[k], differences[k])];
    N::sum_of_products([term(0), term(1), term(2)])
}

/// DEP-1: returns the vertex whose edge number has the largest binary exponent. Among equals, vertex 1 comes first,
/// then 0, then 2.
pub fn largest_edge(e: [i64; 3]) -> usize {
    let [first, second, _] = reference_vertex(e);
    if second { 1 } else { usize::from(!first) * 2 }
}

/// DEP-1: returns which vertex is [that](largest_edge).
#[inline(always)]
pub fn reference_vertex<I: Integer>(e: [I; 3]) -> [I::Choice; 3] {
    let length = |k: usize| e[k].greatest(I::new(0)).bits();
    let [first, second, third] = [length(0), length(1), length(2)];
    let of_second = !(second.is_below(first) | second.is_below(third));
    let of_first = !of_second & !first.is_below(third);
    [of_first, of_second, !(of_first | of_second)]
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

    /// DEP-3: every word of 16 bits, and some of 24, that a depth is stored as.
    #[test]
    fn depths_of_words_are_stored_as_them() {
        for format in DepthFormat::ALL {
            let all = (0..=0xffff_u32).chain((0..=0xffff).map(|n| n << 8 | n >> 8));
            for word_here in all.filter(|word| *word <= format.largest()) {
                let exponent = word_here >> if *format == DepthFormat::Z16F { 12 } else { 16 };
                match of_word(*format, word_here) {
                    Some(depth) => assert_eq!(word(*format, Binary::new(depth)), word_here, "{format:?}"),
                    None => {
                        assert!(format.is_float() && (exponent == 0 || exponent == 255), "{format:?} {word_here:x}")
                    }
                }
            }
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
            a in (-(1_i64 << 31)..1 << 31, 0_i64..64),
            b in (-(1_i64 << 61)..1 << 61, 0_i64..64, 0_u32..60),
            c in (-(1_i64 << 24)..1 << 24, 0_i64..90),
            near in any::<bool>(),
        ) {
            let exact = |mantissa: i64, exponent: i64| i128::from(mantissa) << exponent.min(63);
            let (depth, offset) = (Binary { mantissa: a.0, exponent: a.1 }, Binary { mantissa: b.0 >> b.2, exponent: b.1 });
            let wanted = exact(depth.mantissa, depth.exponent) + exact(offset.mantissa, offset.exponent);
            let sum = depth.plus(offset, SUM_BITS);
            // Beside the sum, or anywhere.
            let dropped = (128 - wanted.unsigned_abs().leading_zeros()).saturating_sub(24).into();
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
        assert_eq!(with.offset.mantissa as f64 * 2.0_f64.powi(with.offset.exponent as i32), 7783.0);
        let (biased, _) = plane(-0.5, 16.0, p);
        assert_eq!(biased.offset.mantissa as f64 * 2.0_f64.powi(biased.offset.exponent as i32), 7782.5);
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
                * 2.0_f64.powi(interpolate_w([5, 70_000, 3], [10.0; 3]).exponent as i32),
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
