//! Generates height fields of weathered rock and of plain noise, in integers.
//!
//! The picture has three ingredients: blocks and chips (cells around scattered points, each of them a plane of its own height and tilt),
//! rounded edges, and weathering (fractal value noise, which also bends the edges of the cells). All of them are periodic, so the image tiles
//! without a seam.

use super::hash::hash;
use super::*;

/// The number 1 in the 16.16 fixed-point numbers used here.
const ONE: i64 = 1 << 16;

/// Generates a tileable height field of rock: `side` x `side` grey pixels, R = G = B = height, A = 255. The lowest point is 0, the highest 255.
///
/// The same `side` and `seed` give the same bytes on every machine. `side` is clamped to [`SIDES`].
pub fn rocks(side: u32, seed: u64) -> Rgba {
    let side = side.clamp(*SIDES.start(), *SIDES.end());
    // Four samples for each pixel smooth the steps where one block stands above another.
    let point = |column: u32, row: u32| {
        let along = |index: u32| i64::from(index) * ONE / i64::from(2 * side);
        rock(along(column), along(row), seed)
    };
    let mut heights = Vec::with_capacity((side * side) as usize);
    for y in 0..side {
        for x in 0..side {
            let four = [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(i, j)| point(2 * x + i, 2 * y + j));
            heights.push(four.iter().sum::<i64>());
        }
    }
    picture(side, heights)
}

/// Converts heights into bytes that use the whole range 0 to 255.
fn picture(side: u32, heights: Vec<i64>) -> Rgba {
    let lowest = heights.iter().copied().min().unwrap_or(0);
    let span = (heights.iter().copied().max().unwrap_or(0) - lowest).max(1);
    let pixels = heights
        .iter()
        .map(|height| {
            let byte = ((height - lowest) * 255 / span) as u8;
            [byte, byte, byte, 255]
        })
        .collect();
    Rgba { width: side, height: side, pixels }
}

/// Generates a tileable height field of value noise, summed over `octaves`. The first octave has `cells` x `cells` cells; each further one is twice
/// as fine and half as strong. Pixels and heights are as those of [`rocks`].
///
/// `side` is clamped to [`SIDES`], `cells` to 1..=256, `octaves` to 1..=8.
pub fn noise_field(side: u32, cells: u32, octaves: u32, seed: u64) -> Rgba {
    let side = side.clamp(*SIDES.start(), *SIDES.end());
    let (cells, octaves) = (i64::from(cells.clamp(1, 256)), octaves.clamp(1, 8));
    let along = |index: u32| i64::from(index) * ONE / i64::from(side);
    let points = (0..side).flat_map(|y| (0..side).map(move |x| (x, y)));
    picture(side, points.map(|(x, y)| fractal(along(x), along(y), cells, octaves, seed)).collect())
}

/// Returns the height at a point of the unit square; height and coordinates are 16.16.
fn rock(u: i64, v: i64, seed: u64) -> i64 {
    // Blocks and chips are sampled at displaced points: weathered edges are not straight.
    let bend = |salt: u64| fractal(u, v, 6, 4, seed ^ salt) - ONE / 2;
    let (bent_u, bent_v) = (u + bend(0xb1) / 9, v + bend(0xb2) / 9);

    let blocks = facets(bent_u, bent_v, 5, seed ^ 0xf1);
    let chips = facets(bent_u, bent_v, 13, seed ^ 0xf2);
    let swell = fractal(u, v, 3, 3, seed ^ 0x51);
    let grain = fractal(u, v, 24, 3, seed ^ 0x91);
    let weather = ridged(bent_u, bent_v, 6, 5, seed ^ 0xa1);
    // Blocks and chips are worn down to a common level where they meet, so that no edge is a step.
    let block = round(blocks.edge, ONE * 7 / 20) * (ONE + blocks.height) / ONE;
    let chip = round(chips.edge, ONE / 5) * (ONE + chips.height) / ONE;
    swell * 40 / 100 + block * 40 / 100 + chip * 8 / 100 + weather * 34 / 100 + grain * 26 / 100
}

/// Returns the height of a worn block at a distance from its edge: 0 at the edge, where it is steep, rising to 1 at `width` and level from there on.
fn round(edge: i64, width: i64) -> i64 {
    let below = (width - edge).max(0) * ONE / width;
    ONE - below * below / ONE
}

/// The facet at a point.
struct Facet {
    /// Height of the facet's plane at the point, 16.16, about 0..1.
    height: i64,
    /// Distance to the edge, in cells: the difference of the distances to the two nearest centres.
    edge: i64,
}

/// Finds the facet at a point. There is one centre in each of `cells` x `cells` cells of the unit square.
fn facets(u: i64, v: i64, cells: i64, seed: u64) -> Facet {
    let (x, y) = (u * cells, v * cells);
    let (cell_x, cell_y) = (x.div_euclid(ONE), y.div_euclid(ONE));
    let (mut nearest, mut second) = (i64::MAX, i64::MAX);
    let mut height = 0;
    for j in cell_y - 2..=cell_y + 2 {
        for i in cell_x - 2..=cell_x + 2 {
            let random = hash(i.rem_euclid(cells), j.rem_euclid(cells), seed);
            let field = |shift: u32| ((random >> shift) & 0xffff) as i64;
            let (dx, dy) = (x - (i * ONE + field(0)), y - (j * ONE + field(16)));
            let distance = dx * dx + dy * dy;
            if distance < nearest {
                second = nearest;
                nearest = distance;
                // Level 0..1, tilt -1..1 along x and y.
                let tilt = hash(i.rem_euclid(cells), j.rem_euclid(cells), !seed);
                let (tilt_x, tilt_y) = (2 * (random >> 48) as i64 - ONE, 2 * (tilt & 0xffff) as i64 - ONE);
                height = field(32) + (dx * tilt_x + dy * tilt_y) / ONE;
            } else if distance < second {
                second = distance;
            }
        }
    }
    Facet { height, edge: root(second) - root(nearest) }
}

/// Returns ridges: folded value noise, sharpest at its highest points.
fn ridged(u: i64, v: i64, cells: i64, octaves: u32, seed: u64) -> i64 {
    summed(octaves, seed, |octave, seed| {
        let fold = ONE - (2 * noise(u, v, cells << octave, seed) - ONE).abs();
        fold * fold / ONE
    })
}

/// Returns value noise summed over octaves, each twice as fine and half as strong as the one before; 0..1.
fn fractal(u: i64, v: i64, cells: i64, octaves: u32, seed: u64) -> i64 {
    summed(octaves, seed, |octave, seed| noise(u, v, cells << octave, seed))
}

/// Returns the weighted mean of octaves, each with a seed of its own and half the weight of the one before.
fn summed(octaves: u32, seed: u64, of: impl Fn(u32, u64) -> i64) -> i64 {
    let (mut sum, mut weight, mut total) = (0, ONE, 0);
    for octave in 0..octaves {
        sum += of(octave, seed.wrapping_add(u64::from(octave))) * weight / ONE;
        total += weight;
        weight /= 2;
    }
    sum * ONE / total
}

/// Returns value noise on a lattice of `cells` x `cells`, periodic in the unit square; 0..1.
fn noise(u: i64, v: i64, cells: i64, seed: u64) -> i64 {
    let (x, y) = (u * cells, v * cells);
    let (i, j) = (x.div_euclid(ONE), y.div_euclid(ONE));
    let (s, t) = (smooth(x.rem_euclid(ONE)), smooth(y.rem_euclid(ONE)));
    let corner =
        |di: i64, dj: i64| (hash((i + di).rem_euclid(cells), (j + dj).rem_euclid(cells), seed) & 0xffff) as i64;
    let mix = |a: i64, b: i64, w: i64| a + (b - a) * w / ONE;
    mix(mix(corner(0, 0), corner(1, 0), s), mix(corner(0, 1), corner(1, 1), s), t)
}

/// Returns 3t^2 - 2t^3.
fn smooth(t: i64) -> i64 {
    t * t / ONE * (3 * ONE - 2 * t) / ONE
}

/// Returns the integer square root of a number that is not negative.
fn root(value: i64) -> i64 {
    value.isqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_same_seed_gives_the_same_rock_and_another_another() {
        assert_eq!(rocks(32, 1), rocks(32, 1));
        assert_ne!(rocks(32, 1), rocks(32, 2));
    }

    #[test]
    fn the_whole_range_is_used() {
        let field = rocks(64, 256);
        assert_eq!(field.pixels.iter().map(|p| p[0]).min(), Some(0));
        assert_eq!(field.pixels.iter().map(|p| p[0]).max(), Some(255));
        assert!(field.pixels.iter().all(|p| p[0] == p[1] && p[1] == p[2] && p[3] == 255));
    }

    #[test]
    fn noise_uses_the_whole_range_and_tiles() {
        let field = noise_field(32, 4, 3, 5);
        assert_eq!(field.pixels.iter().map(|p| p[0]).min(), Some(0));
        assert_eq!(field.pixels.iter().map(|p| p[0]).max(), Some(255));
        // Neighbours across the seam differ no more than others.
        let step = |a: usize, b: usize| i16::from(field.pixels[a][0]).abs_diff(i16::from(field.pixels[b][0]));
        let seam = (0..32).map(|y| step(32 * y + 31, 32 * y)).max();
        let inside = (0..32).flat_map(|y| (0..31).map(move |x| 32 * y + x)).map(|at| step(at, at + 1)).max();
        assert!(seam <= inside, "{seam:?} {inside:?}");
        assert_ne!(field, noise_field(32, 4, 3, 6));
    }

    #[test]
    fn it_tiles() {
        for (u, v) in [(0, 0), (1234, 65_000), (40_000, 1)] {
            for cells in [5, 8] {
                assert_eq!(noise(u, v, cells, 7), noise(u + ONE, v - ONE, cells, 7));
                let (here, there) = (facets(u, v, cells, 7), facets(u - ONE, v + ONE, cells, 7));
                assert_eq!((here.height, here.edge), (there.height, there.edge));
            }
        }
    }

    #[test]
    fn sides_are_brought_into_range() {
        assert_eq!(rocks(1, 0).width, 16);
    }
}
