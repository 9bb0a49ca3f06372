//! Generates the normal map of a hemisphere on a flat surface.
//!
//! The image is the square from -1 to 1 along x and y, and a texel's normal is taken at the texel's centre. Inside the unit circle it is (x, y,
//! sqrt(1 - x^2 - y^2)); outside it is (0, 0, 1), or the zero vector if asked for. Orientation and bytes are those of
//! [`normal_map`], with 255 in alpha.
//!
//! A hemisphere holds every direction that a surface can face, so it shows what a light does to all of them. Its normals turn
//! slowly and evenly, so it also shows every step of the bytes. Noise breaks the steps up: it is added to the exact normals of
//! the sphere before they are normalised and converted to bytes. The flat surface around the sphere stays flat.
#![allow(clippy::float_arithmetic, reason = "input data: f64, + - * / and roots in a fixed order, rounded")]

use super::hash::hash;
use super::normal_map::encode;
use super::*;

/// The strongest noise. Up to here no normal vanishes: the noise is at most 0.5 sqrt 3 < 1 long.
pub const MAXIMUM_NOISE: f64 = 0.5;

/// Options of the map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// Number of columns, and of rows.
    pub size: u32,
    /// Largest amount that is added to or subtracted from a component of the sphere's normals. Amounts are distributed evenly; 0 is no noise.
    pub noise: f64,
    /// Seed of the noise: equal seeds give equal pictures.
    pub seed: u64,
    /// Whether the map holds the zero vector (bytes of 128) outside the circle instead of a flat surface: light shows nothing there.
    pub zero_outside: bool,
}

impl Default for Options {
    fn default() -> Self {
        Options { size: 256, noise: 0.0, seed: 1, zero_outside: false }
    }
}

/// Generates the normal map.
///
/// `options.size` is clamped to [`SIDES`], `options.noise` to 0..=[`MAXIMUM_NOISE`]; NaN is no noise.
pub fn normals(options: &Options) -> Rgba {
    let size = options.size.clamp(*SIDES.start(), *SIDES.end());
    let pixels = vectors(options).into_iter().map(|normal| {
        let [r, g, b] = encode(normal);
        [r, g, b, 255]
    });
    Rgba { width: size, height: size, pixels: pixels.collect() }
}

/// Returns the normals of the same map before they become bytes, row by row from the top.
pub(crate) fn vectors(options: &Options) -> Vec<[f64; 3]> {
    let size = options.size.clamp(*SIDES.start(), *SIDES.end());
    let noise = if options.noise > 0.0 { options.noise.min(MAXIMUM_NOISE) } else { 0.0 };
    let mut vectors = Vec::with_capacity((size * size) as usize);
    for row in 0..size {
        for column in 0..size {
            vectors.push(match on_sphere(column, row, size) {
                Some(exact) => {
                    let random = hash(i64::from(column), i64::from(row), options.seed);
                    let amount = |n: usize| noise * signed_unit((random >> (16 * n)) as u16);
                    unit(std::array::from_fn(|n| exact[n] + amount(n)))
                }
                None => outside(options.zero_outside),
            });
        }
    }
    vectors
}

/// Returns the normal outside the sphere.
fn outside(zero: bool) -> [f64; 3] {
    if zero { [0.0; 3] } else { [0.0, 0.0, 1.0] }
}

/// Returns the normal, without noise, at any point of the image; s and t go from 0 to 1 across it.
pub(crate) fn normal_at([s, t]: [f64; 2], zero_outside: bool) -> [f64; 3] {
    let (x, y) = (2.0 * s - 1.0, 1.0 - 2.0 * t);
    let square = x * x + y * y;
    if square < 1.0 { [x, y, (1.0 - square).sqrt()] } else { outside(zero_outside) }
}

/// Returns the normal of the sphere at the centre of a texel; `None` if the texel lies outside the sphere.
fn on_sphere(column: u32, row: u32, size: u32) -> Option<[f64; 3]> {
    // (2i + 1 - size) / size is exactly symmetric about the middle.
    let along = |index: u32| (2.0 * f64::from(index) + 1.0 - f64::from(size)) / f64::from(size);
    let (x, y) = (along(column), -along(row));
    let square = x * x + y * y;
    (square < 1.0).then(|| [x, y, (1.0 - square).sqrt()])
}

/// Maps 65536 values to -1 to 1 in even steps.
fn signed_unit(random: u16) -> f64 {
    (2.0 * f64::from(random) - 65535.0) / 65535.0
}

/// Normalises a vector, and turns it outward where noise has turned it into the surface.
fn unit([x, y, z]: [f64; 3]) -> [f64; 3] {
    let length = (x * x + y * y + z * z).sqrt();
    [x / length, y / length, z.abs() / length]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the component that a byte stands for.
    fn decode(byte: u8) -> f64 {
        (f64::from(byte) - 128.0) / 127.0
    }

    fn decoded(map: &Rgba) -> Vec<[f64; 3]> {
        map.pixels.iter().map(|&[r, g, b, _]| [r, g, b].map(decode)).collect()
    }

    fn length([x, y, z]: [f64; 3]) -> f64 {
        (x * x + y * y + z * z).sqrt()
    }

    /// Returns the length of the largest rounding error: half a step of the bytes in each of three components.
    fn rounding() -> f64 {
        3.0_f64.sqrt() * 0.5 / 127.0
    }

    #[test]
    fn the_bytes_hold_the_exact_normals() {
        let map = normals(&Options { size: 64, ..Options::default() });
        for (index, vector) in decoded(&map).into_iter().enumerate() {
            let (column, row) = (index as u32 % 64, index as u32 / 64);
            let exact = on_sphere(column, row, 64).unwrap_or([0.0, 0.0, 1.0]);
            for n in 0..3 {
                assert!(
                    (vector[n] - exact[n]).abs() <= 0.5 / 127.0 + 1e-12,
                    "{column},{row}: {vector:?} for {exact:?}"
                );
            }
        }
        assert!(map.pixels.iter().all(|pixel| pixel[3] == 255));
    }

    #[test]
    fn every_vector_is_of_unit_length_and_points_out() {
        for noise in [0.0, 0.004, 0.1, MAXIMUM_NOISE] {
            let map = normals(&Options { size: 128, noise, seed: 3, ..Options::default() });
            for vector in decoded(&map) {
                assert!((length(vector) - 1.0).abs() <= rounding(), "{vector:?}");
                assert!(vector[2] >= 0.0, "{vector:?}");
            }
        }
    }

    #[test]
    fn the_outside_may_be_the_zero_vector() {
        let flat = normals(&Options { size: 64, ..Options::default() });
        let zero = normals(&Options { size: 64, zero_outside: true, ..Options::default() });
        for (index, (flat, zero)) in flat.pixels.iter().zip(&zero.pixels).enumerate() {
            let inside = on_sphere(index as u32 % 64, index as u32 / 64, 64).is_some();
            assert_eq!(*zero, if inside { *flat } else { [128, 128, 128, 255] });
        }
    }

    #[test]
    fn it_is_round_and_the_corners_are_flat() {
        let map = normals(&Options { size: 64, ..Options::default() });
        let at = |x: usize, y: usize| map.pixels[y * 64 + x];
        for (x, y) in [(0, 0), (63, 0), (0, 63), (63, 63)] {
            assert_eq!(at(x, y), [128, 128, 255, 255]);
        }
        // The four texels about the middle face almost straight out, turned a little toward their corner.
        assert_eq!(at(32, 31), [130, 130, 255, 255]);
        assert_eq!(at(31, 32), [126, 126, 255, 255]);
        // 63/64 to the left, and up.
        assert_eq!((at(0, 31)[0], at(32, 0)[1]), (3, 253));
        for y in 0..64 {
            for x in 0..64 {
                let ([r, g, b, _], mirrored) = (at(x, y), at(63 - x, 63 - y));
                assert_eq!([r, g].map(|n| (256 - u32::from(n)) as u8), [mirrored[0], mirrored[1]]);
                assert_eq!(b, mirrored[2]);
            }
        }
    }

    #[test]
    fn noise_moves_the_vectors_as_far_as_it_may() {
        let clean = decoded(&normals(&Options { size: 64, ..Options::default() }));
        let moved = |noise: f64| {
            let noisy = decoded(&normals(&Options { size: 64, noise, ..Options::default() }));
            let pairs = clean.iter().zip(&noisy);
            pairs.map(|(a, b)| length([a[0] - b[0], a[1] - b[1], a[2] - b[2]])).fold(0.0, f64::max)
        };
        let (weak, strong) = (moved(0.02), moved(0.1));
        // At most the diagonal of the cube of noise, lengthened by normalising, and the rounding of two maps.
        assert!(weak > 0.02 && weak < 2.0 * 0.02 * 3.0_f64.sqrt() + 2.0 * rounding(), "{weak}");
        assert!(strong > 0.1 && strong < 2.0 * 0.1 * 3.0_f64.sqrt() + 2.0 * rounding(), "{strong}");
        // The surface around stays flat.
        let strongest = normals(&Options { size: 64, noise: MAXIMUM_NOISE, ..Options::default() });
        assert!([0, 63, 64 * 63, 64 * 64 - 1].iter().all(|index| strongest.pixels[*index] == [128, 128, 255, 255]));
        // Noise goes up as often as down.
        let mean = |vectors: &[[f64; 3]]| vectors.iter().map(|v| v[0]).sum::<f64>() / vectors.len() as f64;
        let noisy = decoded(&normals(&Options { size: 64, noise: 0.1, ..Options::default() }));
        assert!((mean(&noisy) - mean(&clean)).abs() < 0.005);
    }

    #[test]
    fn the_same_options_give_the_same_bytes() {
        let noisy = Options { size: 32, noise: 0.1, ..Options::default() };
        assert_eq!(normals(&noisy), normals(&noisy));
        assert_ne!(normals(&noisy), normals(&Options { seed: 2, ..noisy }));
        assert_ne!(normals(&noisy), normals(&Options { noise: 0.0, ..noisy }));
        let clean = Options { noise: 0.0, ..noisy };
        assert_eq!(normals(&clean), normals(&Options { seed: 2, ..clean }), "no noise, no seed");
        // Some bytes, computed independently of this program: every machine has to make these.
        assert_eq!(normals(&noisy).pixels[16 * 32 + 8..][..2], [[68, 122, 240, 255], [87, 131, 248, 255]]);
    }

    #[test]
    fn options_are_brought_into_range() {
        assert_eq!(normals(&Options { size: 1, ..Options::default() }).width, 16);
        let with = |noise: f64| normals(&Options { size: 16, noise, ..Options::default() });
        assert_eq!(with(9.0), with(MAXIMUM_NOISE));
        for none in [-1.0, f64::NAN, -0.0] {
            assert_eq!(with(none), with(0.0));
        }
    }
}
