//! TEX-17: anisotropic filtering takes several taps along the longer axis of a footprint.

use super::lod::Quad;
use crate::number::Integer;

/// Largest number of taps of a footprint.
pub const MAX_TAPS: usize = 8;

/// One texel of level 0 in the coordinates of a [`Quad`].
pub(crate) const TEXEL: u32 = 65536;

/// The taps of a footprint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Taps<Offset, Weight> {
    /// Number of taps, 1 to [`MAX_TAPS`].
    pub count: usize,
    /// Offsets of the taps from the pixel's coordinates: u and v in 1/256 texel.
    pub offsets: [[Offset; 2]; MAX_TAPS],
    /// Weights of the taps, which add up to 256.
    pub weights: [Weight; MAX_TAPS],
}

impl Taps<i64, i32> {
    /// A single tap at the pixel's own coordinates.
    const ONE: Self = Taps { count: 1, offsets: [[0; 2]; MAX_TAPS], weights: [256, 0, 0, 0, 0, 0, 0, 0] };
}

/// Returns the taps of a quad's footprint, whose longer side counts as at most `limit` times the shorter one. Without a
/// quad, because one of its pixels lies behind the viewer, there is one tap.
pub fn taps(quad: Option<Quad>, limit: u32) -> Taps<i64, i32> {
    let Pairs { count: count @ 1.., offsets, weights } = quad.map_or(Pairs::SINGLE, |quad| pairs(quad, limit.into()))
    else {
        return Taps::ONE;
    };
    let mut taps = Taps { count: 2 * count as usize, weights: [0; MAX_TAPS], ..Taps::ONE };
    for tap in 0..taps.count {
        let side = if tap % 2 == 0 { 1 } else { -1 };
        taps.offsets[tap] = offsets[tap / 2].map(|offset| side * offset);
        taps.weights[tap] = weights[tap / 2] as i32;
    }
    taps
}

/// Largest number of pairs of taps.
pub const MAX_PAIRS: usize = MAX_TAPS / 2;

/// Pairs of taps, one on either side of a pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pairs<I> {
    /// Number of pairs; 0 for a single tap.
    pub count: I,
    /// The distance of each pair from the pixel: u and v in 1/256 texel; 0 for a single tap and for pairs that do not exist.
    pub offsets: [[I; 2]; MAX_PAIRS],
    /// The weight of each of its two taps, in 256ths: 0 for pairs that do not exist, 128 for a single tap, which both are then.
    pub weights: [I; MAX_PAIRS],
}

impl Pairs<i64> {
    /// A single tap.
    pub(crate) const SINGLE: Self = Pairs { count: 0, offsets: [[0; 2]; MAX_PAIRS], weights: [128, 0, 0, 0] };
}

/// Longer steps between pixels count as this: 2^13 texels.
const LONGEST_STEP: i64 = 1 << 29;

/// TEX-17: returns the pairs of taps of a quad. `limit` is 2 or more.
pub fn pairs<I: Integer>([origin, right, lower]: [[I; 2]; 3], limit: I) -> Pairs<I> {
    let (zero, one) = (I::new(0), I::new(1));
    let along = |to: [I; 2]| [0, 1].map(|n: usize| (to[n] - origin[n]).limited(-LONGEST_STEP, LONGEST_STEP));
    let (x, y) = (along(right), along(lower));
    let [of_x, of_y] = [x, y].map(|[u, v]| (u * u + v * v).root());
    let is_y = of_x.is_below(of_y);
    let axis = [0, 1].map(|n: usize| y[n].or(is_y, x[n]));
    let (long, short) = (of_y.or(is_y, of_x).greatest(one), of_x.or(is_y, of_y));
    let over = |n: I, by: I| (n + by - one).quotient(by);
    let width = short.greatest(over(long, limit)).greatest(I::new(TEXEL.into()));
    let is_single = !width.is_below(long);
    let count = over(long, width.up(one)).least(limit.down(one)).greatest(one);
    // Half the distance between two taps is `step` / (2 `long`) of the axis.
    let step = (long - width).or(count.is_below(I::new(2)), width).greatest(zero);
    // Rounded to nearest. The limit keeps the weight of the outermost two from being negative.
    let others = count - one;
    let inner = (width.up(I::new(9)).quotient(long) + one).down(one).least(I::new(128).quotient(others.greatest(one)));
    let outer = I::new(128) - others * inner;
    let of_pair = |pair: usize| {
        let (number, reach) = (I::new(pair as i64), I::new(2 * pair as i64 + 1) * step);
        let offset = axis.map(|n| {
            let offset = (n.magnitude() * reach).quotient(long.up(I::new(9)));
            zero.or(is_single | others.is_below(number), offset.negated(n.is_negative()))
        });
        let weight = inner.or(number.is_below(others), outer.or(!others.is_below(number), zero));
        (offset, I::new(if pair == 0 { 128 } else { 0 }).or(is_single, weight))
    };
    let all: [([I; 2], I); MAX_PAIRS] = [0, 1, 2, 3].map(of_pair);
    Pairs { count: zero.or(is_single, count), offsets: all.map(|pair| pair.0), weights: all.map(|pair| pair.1) }
}

/// Returns the taps of the ideal from s and t at the quad and the texture's sides in texels.
#[allow(clippy::float_arithmetic, reason = "the ideal's footprint")]
pub(crate) fn real_taps(quad: Option<[[f64; 2]; 3]>, sides: [u32; 2], limit: u32) -> Taps<f64, f64> {
    let mut taps = Taps { count: 1, offsets: [[0.0; 2]; MAX_TAPS], weights: [0.0; MAX_TAPS] };
    taps.weights[0] = 256.0;
    let Some([origin, right, lower]) = quad else { return taps };
    let along = |to: [f64; 2]| [0, 1].map(|n| (to[n] - origin[n]) * f64::from(sides[n]));
    let length = |[u, v]: [f64; 2]| (u * u + v * v).sqrt();
    let (x, y) = (along(right), along(lower));
    let (axis, long, short) =
        if length(x) >= length(y) { (x, length(x), length(y)) } else { (y, length(y), length(x)) };
    let width = short.max(long / f64::from(limit)).max(1.0);
    if long.is_nan() || long <= width {
        return taps;
    }
    let pairs = ((long / (2.0 * width)).ceil() as usize).clamp(1, MAX_TAPS / 2);
    let step = if pairs == 1 { long - width } else { width };
    let inner = 256.0 * width / long;
    taps.count = 2 * pairs;
    for pair in 0..pairs {
        let offset = axis.map(|n| 256.0 * n * (2 * pair + 1) as f64 * step / (2.0 * long));
        let weight = if pair + 1 == pairs { 128.0 - (pairs - 1) as f64 * inner } else { inner };
        for (side, tap) in [(1.0, 2 * pair), (-1.0, 2 * pair + 1)] {
            (taps.offsets[tap], taps.weights[tap]) = (offset.map(|n| side * n), weight);
        }
    }
    taps
}

#[cfg(test)]
#[allow(clippy::float_arithmetic, reason = "choosing footprints, and comparing real ones")]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn quad(x: [i64; 2], y: [i64; 2]) -> Option<Quad> {
        Some([[900, -70], [900 + x[0], x[1] - 70], [900 + y[0], y[1] - 70]])
    }

    #[test]
    fn two_taps_by_hand() {
        // 1.226 texels along one axis and 0.2 along the other yield 0.113 to both sides.
        let texels = |n: f64| (n * 65536.0) as i64;
        let near = taps(quad([texels(0.2), 0], [0, texels(1.226)]), 2);
        assert_eq!((near.count, near.offsets[0], near.offsets[1]), (2, [0, 28], [0, -28]));
        assert_eq!(near.weights[..2], [128, 128]);
        let far = taps(quad([0, 0], [0, texels(885.0)]), 2);
        assert_eq!((far.count, far.offsets[0]), (2, [0, (221.25 * 256.0) as i64]));
        assert_eq!(taps(quad([texels(0.9), 0], [0, 7]), 8).count, 1);
        assert_eq!(taps(None, 8).count, 1);
    }

    proptest! {
        #[test]
        fn weights_make_a_whole(
            x in proptest::array::uniform2(-(1_i64 << 62)..1 << 62), y in proptest::array::uniform2(-(1_i64 << 62)..1 << 62),
            small in 0..60, limit in 1..=3_u32,
        ) {
            let quad = quad(x.map(|n| n >> small), y.map(|n| n >> small));
            let taps = taps(quad, 1 << limit);
            prop_assert!(taps.count <= 1 << limit);
            prop_assert_eq!(taps.weights.iter().sum::<i32>(), 256);
            prop_assert!(taps.weights.iter().all(|weight| *weight >= 0));
        }

        /// The real taps are close wherever their number is the same.
        #[test]
        fn real_taps_are_near(x in proptest::array::uniform2(-900..900_i64), y in proptest::array::uniform2(-900..900_i64), limit in 1..=3_u32) {
            let fixed = taps(quad(x.map(|n| n << 13), y.map(|n| n << 13)), 1 << limit);
            let st = |p: [i64; 2]| p.map(|n| n as f64 / 8.0 / 64.0);
            let real = real_taps(Some([[0.0; 2], st(x), st(y)]), [64; 2], 1 << limit);
            if fixed.count == real.count {
                for n in 0..fixed.count {
                    for axis in 0..2 {
                        prop_assert!((fixed.offsets[n][axis] as f64 - real.offsets[n][axis]).abs() < 1.01);
                    }
                    prop_assert!((f64::from(fixed.weights[n]) - real.weights[n]).abs() < 4.01);
                }
            }
        }
    }
}
