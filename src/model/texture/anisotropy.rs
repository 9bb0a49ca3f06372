//! TEX-17: anisotropic filtering takes several taps along the longer axis of a footprint.

use super::lod::Quad;

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
    let Some([origin, right, lower]) = quad else { return Taps::ONE };
    // Larger steps are limited to this.
    let most = 1 << 40;
    let along = |to: [i64; 2]| [0, 1].map(|n| to[n].saturating_sub(origin[n]).clamp(-most, most));
    let (x, y) = (along(right), along(lower));
    let near = |axis: [i64; 2]| axis.iter().all(|n| n.unsigned_abs() < MAX_NARROW_STEP);
    if near(x) && near(y) {
        taps_of_near(x, y, limit)
    } else {
        taps_of_far(x.map(i128::from), y.map(i128::from), limit)
    }
}

/// Steps below this need no more than 64 bits.
const MAX_NARROW_STEP: u64 = 1 << 26;

/// Defines the computation of taps from a footprint's two steps, in integers of a given width.
macro_rules! taps_in {
    ($name:ident, $signed:ty, $unsigned:ty) => {
        fn $name(x: [$signed; 2], y: [$signed; 2], limit: u32) -> Taps<i64, i32> {
            let squared = |[u, v]: [$signed; 2]| (u * u + v * v).unsigned_abs();
            let lengths = [x, y].map(|axis| squared(axis).isqrt());
            let (axis, long, short) =
                if lengths[0] >= lengths[1] { (x, lengths[0], lengths[1]) } else { (y, lengths[1], lengths[0]) };
            let width = short.max(long.div_ceil(limit.into())).max(<$unsigned>::from(TEXEL));
            if long <= width {
                return Taps::ONE;
            }
            // Half the distance between two taps is `step` / (2 `long`) of the axis.
            let pairs = long.div_ceil(2 * width) as usize;
            let step = if pairs == 1 { long - width } else { width };
            // Rounded to nearest. The limit keeps the weight of the outermost two from being negative.
            let inner = ((512 * width / long).div_ceil(2) as i32).min(128 / (pairs as i32 - 1).max(1));
            let mut taps = Taps { count: 2 * pairs, weights: [0; MAX_TAPS], ..Taps::ONE };
            for pair in 0..pairs {
                let reach = ((2 * pair as $signed + 1) * step as $signed, 2 * long as $signed);
                let offset = axis.map(|n| (n * reach.0 / reach.1 / 256) as i64);
                let weight = if pair + 1 == pairs { 128 - (pairs as i32 - 1) * inner } else { inner };
                for (side, tap) in [(1, 2 * pair), (-1, 2 * pair + 1)] {
                    (taps.offsets[tap], taps.weights[tap]) = (offset.map(|n| side * n), weight);
                }
            }
            taps
        }
    };
}
taps_in!(taps_of_near, i64, u64);
taps_in!(taps_of_far, i128, u128);

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
        fn both_widths_agree(x in proptest::array::uniform2(-67_108_863..67_108_864_i64), y in proptest::array::uniform2(-67_108_863..67_108_864_i64), small in 0..26, limit in 1..=3_u32) {
            let (x, y) = (x.map(|n| n >> small), y.map(|n| n >> (small / 2)));
            prop_assert_eq!(taps_of_near(x, y, 1 << limit), taps_of_far(x.map(i128::from), y.map(i128::from), 1 << limit));
        }

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
