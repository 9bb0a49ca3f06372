//! Tests general properties of texture units: faces of cube maps, addressing, scaled coordinates, filter weights.
#![allow(clippy::float_arithmetic, clippy::unwrap_used, reason = "a test binary")]

use ninebit::raster::interpolate::{Sample, face_coordinate, ratio};
use ninebit::raster::setup::Triangle;
use ninebit::raster::weights::Linear;
use ninebit::state::{AddressMode, Named, Profile};
use ninebit::texture::address::address;
use ninebit::texture::cube::Face;
use ninebit::texture::filter::{bilinear, lerp, linear, nearest};
use proptest::prelude::*;

// ---- cube maps ----

/// Returns all directions of a lattice of 33 x 33 x 33 points.
fn lattice() -> impl Iterator<Item = [i32; 3]> {
    (0..33_i32.pow(3)).map(|n| [n % 33 - 16, n / 33 % 33 - 16, n / 1089 - 16])
}

/// Returns the face that a direction meets, with sc, tc and ma.
fn meets(d: [i32; 3]) -> (Face, [i32; 3]) {
    let face = Face::from_direction(d, d.map(i32::abs), 0);
    (face, face.components().map(|c| if c.negative { -d[c.axis] } else { d[c.axis] }))
}

/// TEX-12 as a table of matrices, whose rows yield sc, tc and ma of each face.
const TABLE: [[[i32; 3]; 3]; 6] = [
    [[0, 0, -1], [0, -1, 0], [1, 0, 0]],
    [[0, 0, 1], [0, -1, 0], [-1, 0, 0]],
    [[1, 0, 0], [0, 0, 1], [0, 1, 0]],
    [[1, 0, 0], [0, 0, -1], [0, -1, 0]],
    [[1, 0, 0], [0, -1, 0], [0, 0, 1]],
    [[-1, 0, 0], [0, -1, 0], [0, 0, -1]],
];

fn times(row: [i32; 3], d: [i32; 3]) -> i32 {
    row[0] * d[0] + row[1] * d[1] + row[2] * d[2]
}

/// TEX-12, TEX-13: a direction meets the first face of the table whose component is at least as large as all others.
#[test]
fn faces_of_the_lattice_are_those_of_the_table() {
    let mut met = [0; 6];
    for d in lattice() {
        let (face, [s, t, m]) = meets(d);
        let wanted = TABLE.iter().position(|rows| d.iter().all(|c| times(rows[2], d) >= c.abs())).unwrap();
        assert_eq!(face as usize, wanted, "{d:?}");
        assert_eq!([s, t, m], TABLE[wanted].map(|row| times(row, d)), "{d:?}");
        // u and v lie on the image.
        assert!(m >= s.abs() && m >= t.abs());
        met[wanted] += 1;
    }
    assert_eq!(met.iter().sum::<i32>(), 33 * 33 * 33);
    // X wins every tie, and Y wins ties with Z.
    assert!(met[0] > met[2] && met[2] > met[4] && met.iter().all(|n| *n > 4000), "{met:?}");
}

/// A direction and its negation meet opposite faces, at positions that are mirrored along one of the two axes.
#[test]
fn opposite_directions_meet_opposite_faces() {
    for d in lattice().filter(|d| *d != [0; 3]) {
        let (near, [s, t, m]) = meets(d);
        let (far, [fs, ft, fm]) = meets(d.map(|c| -c));
        assert_eq!(near as usize ^ 1, far as usize, "{d:?}");
        let about_s = matches!(near, Face::PositiveY | Face::NegativeY);
        let wanted = if about_s { [-s, t, m] } else { [s, -t, m] };
        assert_eq!([fs, ft, fm], wanted, "{d:?}");
    }
}

/// A quarter turn about y moves a direction to the next side face, at the same position.
#[test]
fn quarter_turns_carry_side_faces_on() {
    for [x, y, z] in lattice().filter(|[x, y, z]| x.abs() != z.abs() && y.abs() < x.abs().max(z.abs())) {
        let (face, place) = meets([x, y, z]);
        let (turned, turned_place) = meets([z, y, -x]);
        let next = match face {
            Face::PositiveX => Face::NegativeZ,
            Face::NegativeZ => Face::NegativeX,
            Face::NegativeX => Face::PositiveZ,
            _ => Face::PositiveX,
        };
        assert_eq!((turned, turned_place), (next, place), "{x} {y} {z}");
    }
}

// ---- addresses ----

/// Compares every mode, for every size from 1 to 64, with a walk along the texels one step at a time.
#[test]
fn addresses_are_those_of_a_walk() {
    for n in 1..=64_i64 {
        for direction in [1, -1] {
            let (mut wrapped, mut mirrored, mut step) = (0, 0, direction);
            // The edge texel occurs twice in a mirrored walk, so a walk to the left stays on it for the first step.
            for k in 0..=4096 {
                let i = direction * k;
                let at = |mode, border| address(mode, i, n as u32, border);
                assert_eq!(at(AddressMode::Wrap, false), Some(wrapped), "{n} {i}");
                assert_eq!(at(AddressMode::Mirror, false), Some(mirrored), "{n} {i}");
                let inside = (0..n).contains(&i);
                let edge = if direction > 0 { n - 1 } else { 0 };
                assert_eq!(at(AddressMode::ClampToEdge, false), Some(if inside { i } else { edge }));
                assert_eq!(at(AddressMode::Clamp, false), at(AddressMode::ClampToEdge, false));
                assert_eq!(at(AddressMode::ClampToBorder, false), inside.then_some(i));
                let (first, last) = (-4, n + 3);
                let with_border = if direction > 0 { i.min(last) } else { i.max(first) };
                assert_eq!(at(AddressMode::ClampToBorder, true), Some(with_border));
                // A texture border has no effect on the other modes.
                for mode in [AddressMode::Wrap, AddressMode::Mirror, AddressMode::ClampToEdge, AddressMode::Clamp] {
                    assert_eq!(at(mode, true), at(mode, false));
                }
                wrapped += direction;
                if wrapped == n {
                    wrapped = 0;
                } else if wrapped < 0 {
                    wrapped = n - 1;
                }
                if (0..n).contains(&(mirrored + step)) {
                    mirrored += step;
                } else {
                    // Stays on the edge texel for one step, then goes back.
                    step = -step;
                }
            }
        }
    }
}

/// TEX-6: returns a row of texels filtered at u.
fn filtered(row: &[i32], mode: AddressMode, u: i64) -> i32 {
    let (x, w) = linear(u);
    let texel = |x| row[address(mode, x, row.len() as u32, false).unwrap() as usize];
    lerp(texel(x), texel(x + 1), w)
}

/// A filtered mirrored texture is symmetric at every 1/256 texel. With the nearest filter the edges of texels are an exception.
#[test]
fn mirrored_coordinates_look_the_same() {
    for n in 1..=64_i64 {
        let row: Vec<i32> = (0..n).map(|k| (k * k * 37 + k * 11) as i32 & 255).collect();
        for u in 0..=256 * 3 * n {
            let at = |u| filtered(&row, AddressMode::Mirror, u);
            assert_eq!(at(u), at(-u), "{n} {u}");
            assert_eq!(at(u), at(512 * n - u), "{n} {u}");
            let nearest = |u| address(AddressMode::Mirror, nearest(u), n as u32, false);
            if u & 255 != 0 {
                assert_eq!(nearest(u), nearest(-u));
            }
        }
    }
}

/// Whole repeats of the texture do not change the result.
#[test]
fn repeats_look_the_same() {
    for n in 1..=64_i64 {
        let row: Vec<i32> = (0..n).map(|k| (k * k * 37 + k * 11) as i32 & 255).collect();
        for u in (-128..=256 * n).step_by(7) {
            for times in [-9, -1, 1, 64] {
                let at = |u, mode| filtered(&row, mode, u);
                assert_eq!(at(u, AddressMode::Wrap), at(u + times * 256 * n, AddressMode::Wrap));
                assert_eq!(at(u, AddressMode::Mirror), at(u + times * 512 * n, AddressMode::Mirror));
            }
        }
    }
}

// ---- filters ----

/// Compares every pair of weights with the formula, in both types of lane, with signed texels, and with texels that need rounding in either
/// direction.
#[test]
fn bilinear_by_its_formula_for_every_pair_of_weights() {
    let footprints = [
        [0, 255, 255, 0],
        [255, 255, 255, 255],
        [1, 2, 3, 4],
        [17, 200, 99, 254],
        [255, 0, 1, 0],
        [128, 127, 126, 129],
        [-128, 127, 127, -128],
        [-1, 0, -2, -3],
        [-128, -128, -128, -128],
    ];
    for [a, b, c, d] in footprints {
        for u in 0..=255 {
            for v in 0..=255 {
                let step = |a: i32, b: i32, w: i32| (a * (256 - w) + b * w + 128).div_euclid(256);
                let want = step(step(a, b, u), step(c, d, u), v);
                assert_eq!(bilinear([a, b, c, d], u, v, |v| v), want);
                if a >= 0 && d >= 0 {
                    let lanes = [a, b, c, d].map(|t| t as u16);
                    assert_eq!(i32::from(bilinear(lanes, u as u16, v as u16, |v| v)), want);
                }
                // The order of the axes matters to the rule, but the order of the two texels along an axis does not.
                if u > 0 {
                    assert_eq!(bilinear([b, a, d, c], 256 - u, v, |v| v), want);
                }
                let texels = [a, b, c, d];
                assert!(texels.iter().min().unwrap() <= &want && &want <= texels.iter().max().unwrap());
            }
        }
    }
}

// ---- coordinates ----

/// Returns a triangle in perspective within the guard band, and the edge functions of a point that it covers.
fn triangle() -> impl Strategy<Value = (Triangle, [i64; 3])> {
    let place = || prop_oneof![-64.0..64.0_f32, (-64..64_i8).prop_map(f32::from)];
    let w = prop_oneof![Just(1.0), Just(2.0), 0.1..50.0_f32];
    let corner = (place(), place(), w).prop_map(|(x, y, w)| [x, y, 0.0, w]);
    let pixel = (-64..64_i64, -64..64_i64);
    ([corner.clone(), corner.clone(), corner], pixel).prop_filter_map("covers the pixel", |(corners, (i, j))| {
        let triangle = Triangle::new(corners, true, Profile::Nv2a)?;
        let e = triangle.edges(i, j);
        triangle.covers(e).then_some((triangle, e))
    })
}

/// Returns numbers of few bits, so that ties occur, and arbitrary ones.
fn component() -> impl Strategy<Value = f32> {
    prop_oneof![(-64..64_i8).prop_map(|n| f32::from(n) / 16.0), -4.0..4.0_f32, Just(0.0)]
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 3000, failure_persistence: None, max_global_rejects: 1_000_000, ..ProptestConfig::default() })]

    /// Coordinates depend only on the ratios of s, t and q, and on those of the parts of a direction. A power of two in all components
    /// changes nothing.
    #[test]
    fn powers_of_two_in_all_components_change_nothing(
        (triangle, e) in triangle(),
        parts in prop::array::uniform3(prop::array::uniform3(component())),
        power in -40..40_i32,
        bits in 0..13_u32,
    ) {
        let scaled = parts.map(|x| x.map(|x| x * 2.0_f32.powi(power)));
        let sample = Sample::new(&triangle, e);
        let [a, b] = [parts, scaled].map(|parts| parts.map(|x| sample.value(&Linear::new(x))));
        for size in [1 << bits, 7 * (i64::from(bits) + 1)] {
            for n in 0..2 {
                prop_assert_eq!(ratio(a[n], a[2], size), ratio(b[n], b[2], size));
                prop_assert_eq!(face_coordinate(a[n], a[2], size, 8), face_coordinate(b[n], b[2], size, 8));
            }
        }
    }
}

/// The names of the faces are in the order of the table's rows.
#[test]
fn faces_are_named_in_order() {
    assert_eq!(Face::NAMES, ["PositiveX", "NegativeX", "PositiveY", "NegativeY", "PositiveZ", "NegativeZ"]);
}
