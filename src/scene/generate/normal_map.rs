//! Generates normal maps from height fields, by the triangle of three texels.
//!
//! Every texel, its right neighbour and the neighbour above it are three points of the surface. The two
//! edges from the texel span a triangle, and the normalised cross product of the edges is the texel's normal. Using two neighbours
//! instead of four keeps every crease one texel wide; the map is shifted by half a texel against its height field, down and to the left.
//!
//! Orientation: x points right, **y points up on the image**, z out of it. Red, green and blue are x, y and z; so a slope that faces the
//! top of the image is more green. With texture coordinates that grow downward, y is the direction of *decreasing* t.
//!
//! A component n in -1..1 is stored as the byte 128 + round(127 n): 0 is 128, -1 is 1, 1 is 255. The byte 0 does not occur. Alpha keeps
//! the height.
#![allow(clippy::float_arithmetic, reason = "input data: f64, + - * / and roots in a fixed order, rounded")]

use super::*;

/// The channel of an image that holds heights, where 0 is the lowest.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum HeightChannel {
    /// Red, as for a grey image.
    #[default]
    Red,
    /// Alpha, as for an image that carries its heights along; normal maps of this module do.
    Alpha,
}

/// Options for reading a height field.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// Height of the byte 255, in texels. A negative scale turns hills into pits.
    pub scale: f64,
    /// Whether the image repeats: the right neighbour of the last column is then the first column, likewise for rows. Otherwise the last column
    /// and the first row take the slope of their inner neighbours.
    pub wrap: bool,
    /// The channel that holds the heights.
    pub channel: HeightChannel,
}

impl Default for Options {
    fn default() -> Self {
        Options { scale: 8.0, wrap: true, channel: HeightChannel::Red }
    }
}

/// Generates the normal map of a height field, of the same size.
///
/// `options.scale` must be finite; its magnitude is limited to 2^20.
pub fn from_height(height: &Rgba, options: &Options) -> Rgba {
    from_height_along(height, options, &[[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])
}

/// Generates the normal map on a surface whose tangent, binormal and normal are `frame`: the normals become directions in that surface's space.
pub fn from_height_along(height: &Rgba, options: &Options, frame: &[Vector; 3]) -> Rgba {
    let texels = normals(height, options).into_iter().zip(&height.pixels);
    let along = |n: Vector| [0, 1, 2].map(|axis| n[0] * frame[0][axis] + n[1] * frame[1][axis] + n[2] * frame[2][axis]);
    let pixels = texels.map(|(normal, height)| {
        let [r, g, b] = encode(along(normal));
        [r, g, b, byte(*height, options.channel)]
    });
    Rgba { width: height.width, height: height.height, pixels: pixels.collect() }
}

/// Returns the height of a texel.
fn byte([red, _, _, alpha]: [u8; 4], channel: HeightChannel) -> u8 {
    match channel {
        HeightChannel::Red => red,
        HeightChannel::Alpha => alpha,
    }
}

/// Returns the unit normals of a height field's texels before they become bytes, row by row from the top.
///
/// `options.scale` must be finite; its magnitude is limited to 2^20.
pub(crate) fn normals(height: &Rgba, options: &Options) -> Vec<[f64; 3]> {
    let (columns, rows) = (height.width as usize, height.height as usize);
    let at = |x: usize, y: usize| byte(height.pixels[y * columns + x], options.channel);
    let scale = if options.scale.is_finite() { options.scale.clamp(-1_048_576.0, 1_048_576.0) } else { 0.0 };
    let mut normals = Vec::with_capacity(height.pixels.len());
    for y in 0..rows {
        for x in 0..columns {
            // Difference from `from` to `to`, in steps of the height's byte.
            let rise = |from: u8, to: u8| f64::from(i16::from(to) - i16::from(from));
            let right = match (x + 1 < columns, options.wrap) {
                (true, _) => rise(at(x, y), at(x + 1, y)),
                (false, true) => rise(at(x, y), at(0, y)),
                (false, false) => rise(at(x.saturating_sub(1), y), at(x, y)),
            };
            let up = match (y > 0, options.wrap) {
                (true, _) => rise(at(x, y), at(x, y - 1)),
                (false, true) => rise(at(x, y), at(x, rows - 1)),
                (false, false) => rise(at(x, (y + 1).min(rows - 1)), at(x, y)),
            };
            normals.push(normal(right * scale / 255.0, up * scale / 255.0));
        }
    }
    normals
}

/// Returns the height at a point by bilinear interpolation, 0 to 255. The point is given in texels from the centre of the first texel.
pub(super) fn height_at(height: &Rgba, options: &Options, x: f64, y: f64) -> f64 {
    let (left, top) = (x.floor(), y.floor());
    let at = |x: f64, y: f64| {
        let index = |place: f64, count: u32| {
            let (place, last) = (place as i64, i64::from(count) - 1);
            (if options.wrap { place.rem_euclid(last + 1) } else { place.clamp(0, last) }) as usize
        };
        let (column, row) = (index(x, height.width), index(y, height.height));
        f64::from(byte(height.pixels[row * height.width as usize + column], options.channel))
    };
    let mix = |a: f64, b: f64, weight: f64| a + (b - a) * weight;
    let row = |y: f64| mix(at(left, y), at(left + 1.0, y), x - left);
    mix(row(top), row(top + 1.0), y - top)
}

/// Returns the normal of the triangle with the edges (1, 0, right) and (0, 1, up): their cross product (-right, -up, 1), normalised.
fn normal(right: f64, up: f64) -> [f64; 3] {
    let length = (right * right + up * up + 1.0).sqrt();
    [-right / length, -up / length, 1.0 / length]
}

/// Returns the bytes of a vector with components in -1..1: 128 + round(127 n).
pub fn encode(vector: [f64; 3]) -> [u8; 3] {
    // The sum is positive, so truncation is a floor; the conversion saturates.
    vector.map(|n| (128.5 + 127.0 * n) as u8)
}

/// Returns the vector that bytes stand for: the inverse of [`encode`].
pub(crate) fn decode(bytes: [u8; 3]) -> [f64; 3] {
    bytes.map(|byte| (f64::from(byte) - 128.0) / 127.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn field(width: u32, rows: &[&[u8]]) -> Rgba {
        let pixels = rows.iter().flat_map(|row| row.iter().map(|h| [*h, 1, 2, 255 - *h])).collect();
        Rgba { width, height: rows.len() as u32, pixels }
    }

    #[test]
    fn a_flat_field_points_out_of_the_image() {
        let map = from_height(&field(2, &[&[9, 9], &[9, 9]]), &Options::default());
        assert_eq!(map.pixels, [[128, 128, 255, 9]; 4]);
        // A ceiling: its normal points down.
        let ceiling = [[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]];
        let map = from_height_along(&field(2, &[&[9, 9], &[9, 9]]), &Options::default(), &ceiling);
        assert_eq!(map.pixels, [[128, 1, 128, 9]; 4]);
    }

    #[test]
    fn slopes_face_where_they_should() {
        // It rises by one texel for each texel: 45 degrees, 127 / sqrt 2 = 89.8.
        let options = Options { scale: 255.0, wrap: false, ..Options::default() };
        let to_the_right = from_height(&field(3, &[&[0, 1, 2], &[0, 1, 2]]), &options);
        assert!(to_the_right.pixels.iter().all(|p| p[..3] == [38, 128, 218]), "{:?}", to_the_right.pixels);
        let upward = from_height(&field(2, &[&[2, 2], &[1, 1], &[0, 0]]), &options);
        assert!(upward.pixels.iter().all(|p| p[..3] == [128, 38, 218]), "{:?}", upward.pixels);
        let downward = from_height(&field(2, &[&[0, 0], &[1, 1], &[2, 2]]), &options);
        assert!(downward.pixels.iter().all(|p| p[..3] == [128, 218, 218]), "facing the top is more green");
        let pit = from_height(&field(2, &[&[2, 2], &[1, 1], &[0, 0]]), &Options { scale: -255.0, ..options });
        assert_eq!(pit.pixels.iter().map(|p| p[1]).collect::<Vec<_>>(), [218; 6]);
    }

    #[test]
    fn wrapping_looks_at_the_other_side() {
        let step = field(2, &[&[0, 2]]);
        let options = Options { scale: 255.0, wrap: true, ..Options::default() };
        let wrapped = from_height(&step, &options);
        assert!(wrapped.pixels[0][0] < 128 && wrapped.pixels[1][0] > 128, "{:?}", wrapped.pixels);
        let open = from_height(&step, &Options { wrap: false, ..options });
        assert_eq!(open.pixels[0][0], open.pixels[1][0]);
        let single = from_height(&field(1, &[&[7]]), &Options { wrap: false, ..options });
        assert_eq!(single.pixels, [[128, 128, 255, 7]]);
    }

    #[test]
    fn the_height_may_be_in_alpha() {
        let options = Options { channel: HeightChannel::Alpha, ..Options::default() };
        let map = from_height(&field(2, &[&[10, 10]]), &options);
        assert_eq!(map.pixels, [[128, 128, 255, 245]; 2]);
    }

    #[test]
    fn the_bytes_stay_in_range() {
        assert_eq!(encode([-1.0, 0.0, 1.0]), [1, 128, 255]);
        for scale in [f64::NAN, f64::INFINITY, 1e300, -1e300] {
            let map = from_height(&field(2, &[&[0, 255]]), &Options { scale, ..Options::default() });
            assert!(map.pixels.iter().all(|p| p[0] >= 1 && p[2] >= 128));
        }
    }
}
