//! Depths: polygon offset, range and stored word; and w buffers.

use super::raster::{LARGE, fit, geometry, is_covered, triangle};
use super::{Column, Conditions, Kind, Reach, Unit, float, named, sized};
use ninebit::raster::binary::Binary;
use ninebit::raster::depth::{DepthPlane, ranged, slope, word};
use ninebit::raster::setup::Triangle;
use ninebit::state::{self, CompareFunction, DepthFormat, DepthTest, Profile, VertexDepths};

pub(super) fn floats(inputs: &[i64]) -> [f32; 3] {
    std::array::from_fn(|n| float(inputs[n]))
}

/// Returns a depth test in steps of the buffer.
pub(super) fn test() -> DepthTest {
    DepthTest { vertex_depths: VertexDepths::Steps, ..DepthTest::new(CompareFunction::Always, true) }
}

/// Returns some triangle.
fn any() -> Option<Triangle> {
    Triangle::new(LARGE, true, Profile::Nv2a)
}

/// Returns whether the chip has the depth format of that number.
fn has(format: i64, profile: Profile) -> bool {
    profile == Profile::Nv2a || !named::<DepthFormat>(format).is_float()
}

/// Returns the powers of two in the range of a format: the first, and their number.
fn powers(format: i64) -> (i64, i64) {
    match named::<DepthFormat>(format) {
        DepthFormat::Z16 => (2, 14),
        DepthFormat::Z24S8 => (8, 16),
        DepthFormat::Z16F => (-6, 15),
        DepthFormat::Z24S8F => (-20, 40),
    }
}

/// The stored word of a depth.
pub(super) struct DepthWord;

impl Unit for DepthWord {
    known_as!(
        "depth-word", &["DEP-3"],
        "the word that stands for a depth of mantissa 2^exponent steps, in a format", Geometry;
        takes [
            Column::choice::<DepthFormat>("cfg.format"),
            Column::signed("in.mantissa", 32, -(1 << 31), (1 << 31) - 1),
            Column::signed("in.exponent", 9, -180, 110),
        ];
        gives [Column::result("out.word", Kind::Hex(24))]
    );

    fn regressions(&self) -> Vec<Vec<i64>> {
        // 1.5, 2^-7, 600, the largest depth of each format, and its neighbours.
        let numbers = [
            [3, -1],
            [1, -7],
            [1, -6],
            [600, 0],
            [8191, -4],
            [1, 9],
            [0xffff, 0],
            [0x1_ffff, -1],
            [0x1_0000, 0],
            [0xff_ffff, 0],
            [0x100_0000, 0],
            [0x1_ffff, 103],
            [1, 127 - 17],
            [1, -126],
            [1, -127],
            [-1, 0],
        ];
        (0..4).flat_map(|format| numbers.map(|[mantissa, exponent]| vec![format, mantissa, exponent])).collect()
    }

    fn fit(&self, inputs: &mut [i64]) {
        // Usually a depth within the format's range.
        if inputs[2] & 7 != 0 {
            inputs[1] = inputs[1].max(-inputs[1] / 2);
            let bits = 64 - i64::from(inputs[1].leading_zeros());
            let (first, count) = powers(inputs[0]);
            inputs[2] = first + 1 - bits + inputs[2].rem_euclid(count);
        }
    }

    fn accepts(&self, inputs: &[i64], profile: Profile) -> bool {
        has(inputs[0], profile)
    }

    fn evaluate(&self, inputs: &[i64], _: &Conditions, results: &mut [i64]) {
        results[0] = word(named(inputs[0]), Binary { mantissa: inputs[1], exponent: inputs[2] }).into();
    }
}

pub(super) struct DepthRange;

impl Unit for DepthRange {
    known_as!(
        "depth-range", &["DEP-3", "DEP-4"],
        "whether a triangle of three depths is drawn, whether a pixel of it is kept, and its word, by a range of depths; floats, in steps", Geometry;
        takes [
            Column::choice::<DepthFormat>("cfg.format"),
            ["cfg.clamps", "cfg.drops_triangles"].map(Column::flag),
            ["in.lowest", "in.highest", "in.z0", "in.z1", "in.z2", "in.depth"].map(|name| Column::float(name, true, 26)),
        ];
        gives [Column::results(["mid.drawn", "out.kept"], Kind::Unsigned(1)), Column::result("out.word", Kind::Hex(24))]
    );

    fn regressions(&self) -> Vec<Vec<i64>> {
        // The handbook's examples, and every order of a depth and two limits.
        let bits = |n: f32| i64::from(n.to_bits());
        let depths = [99.5, 100.0, 100.25, 200.0, 200.5].map(bits);
        let rows = [[201.0, 202.0, 250.0], [1.0, 2.0, 99.0], [99.0, 100.0, 99.0], [200.0, 201.0, 300.0]]
            .into_iter()
            .flat_map(|z| depths.map(|depth| [&[bits(100.0), bits(200.0)][..], &z.map(bits), &[depth]].concat()));
        rows.flat_map(|row| [[0, 0], [0, 1], [1, 0], [1, 1]].map(|cfg| [&[1][..], &cfg, &row].concat())).collect()
    }

    fn fit(&self, inputs: &mut [i64]) {
        let format = inputs[0];
        for input in &mut inputs[3..] {
            if *input & 7 != 0 {
                *input = sized(*input, powers(format)) & 0x7fff_ffff;
            }
        }
        if float(inputs[3]) > float(inputs[4]) {
            inputs.swap(3, 4);
        }
        // At a limit.
        match inputs[8] & 15 {
            0 => inputs[8] = inputs[3],
            1 => inputs[8] = inputs[4],
            2 => inputs[5] = inputs[3],
            3 => inputs[6] = inputs[4],
            _ => {}
        }
    }

    fn accepts(&self, inputs: &[i64], profile: Profile) -> bool {
        has(inputs[0], profile) && float(inputs[3]) <= float(inputs[4])
    }

    fn evaluate(&self, inputs: &[i64], _: &Conditions, results: &mut [i64]) {
        let format = named(inputs[0]);
        let [clamps, drops_triangles] = [inputs[1] != 0, inputs[2] != 0];
        let range = state::DepthRange { lowest: float(inputs[3]), highest: float(inputs[4]), clamps, drops_triangles };
        let test = DepthTest { range: Some(range), ..test() };
        let plane = any().and_then(|any| DepthPlane::new(&test, format, &any, (floats(&inputs[5..8]), None)));
        let kept = plane.and_then(|_| ranged(Some(&range), Binary::new(float(inputs[8]))));
        let word = kept.map_or(0, |depth| word(format, depth));
        results.copy_from_slice(&[plane.is_some().into(), kept.is_some().into(), word.into()]);
    }
}

/// A pixel's depth, with bias and slope.
pub(super) struct PixelDepth;

impl Unit for PixelDepth {
    known_as!(
        "pixel-depth", &["DEP-1", "DEP-3", "DEP-5"],
        "the depth word of a covered pixel, from three vertex depths in steps (floats), a bias and the factor of the steepest slope", Geometry;
        takes [
            geometry(),
            Column::choice::<DepthFormat>("cfg.format"),
            ["in.z0", "in.z1", "in.z2"].map(|name| Column::float(name, false, 24)),
            Column::float("in.bias", true, 16),
            Column::float("in.factor", true, 8),
        ];
        gives [
            Column::result("mid.slope", Kind::Unsigned(60)),
            Column::result("mid.exponent", Kind::Signed(10)),
            Column::result("out.word", Kind::Hex(24)),
        ]
    );

    fn fit(&self, inputs: &mut [i64]) {
        fit(inputs);
        // Depths within the formats' ranges, and usually offsets that leave them there.
        let (factor, (first, count)) = (inputs[13], powers(inputs[8]));
        for z in &mut inputs[9..12] {
            *z = sized(*z, (first + count / 2, count / 2)) & 0x7fff_ffff;
        }
        if factor & 3 != 0 {
            inputs[12] = if factor & 4 != 0 { 0 } else { sized(inputs[12], (first, count)) };
            inputs[13] = if factor & 0x30 == 0 { 0 } else { sized(factor, (-3, 6)) };
        }
    }

    fn accepts(&self, inputs: &[i64], profile: Profile) -> bool {
        has(inputs[8], profile) && is_covered(inputs, profile)
    }

    fn evaluate(&self, inputs: &[i64], conditions: &Conditions, results: &mut [i64]) {
        let Some(triangle) = triangle(inputs, None, conditions.profile) else { return results.fill(0) };
        let (format, z) = (named(inputs[8]), floats(&inputs[9..12]));
        let offset = state::PolygonOffset { bias: float(inputs[12]), factor: float(inputs[13]) };
        let plane = DepthPlane::new(&DepthTest { offset, ..test() }, format, &triangle, (z, None));
        let slope = slope(&triangle, z);
        let depth = plane.unwrap_or_default().at(triangle.edges(inputs[6], inputs[7]));
        results.copy_from_slice(&[slope.mantissa, slope.exponent, word(format, depth).into()]);
    }
}

/// The least w (RAS-0) as the bits of a float.
pub(super) const LEAST_W: i64 = 107 << 23;

/// A pixel of a w buffer.
pub(super) struct WBuffer;

impl Unit for WBuffer {
    known_as!(
        "w-buffer", &["DEP-3", "DEP-6"],
        "the word of a w buffer where three edge functions have these values, from w of the vertices and a bias (floats)", Geometry;
        takes [
            Column::choice::<DepthFormat>("cfg.format"),
            ["in.e0", "in.e1", "in.e2"].map(|name| Column::unsigned(name, 30, (1 << 30) - 1)),
            ["in.w0", "in.w1", "in.w2"].map(|name| Column::float(name, false, 25)),
            Column::float("in.bias", true, 16),
        ];
        gives [Column::result("out.word", Kind::Hex(24))]
    );

    fn regressions(&self) -> Vec<Vec<i64>> {
        // Pixels of captured buffers: TriH and LargeZ.
        let steep = [325.0_f32, 325.0, 58.0];
        let large = [16_777_046.0_f32, 16_777_047.0, 16_777_047.0];
        let captured = [
            ([408_448, 51_072, 51_200], steep),
            ([229_504, 153_216, 128_000], steep),
            ([24_448, 51_072, 435_200], steep),
            ([1_556_480, 24_637_440, 52_449_280], large),
            ([13_025_280, 24_637_440, 40_980_480], large),
        ];
        let rows = captured.into_iter().map(|(e, w)| [&[1][..], &e, &w.map(|w| i64::from(w.to_bits())), &[0]].concat());
        rows.collect()
    }

    fn fit(&self, inputs: &mut [i64]) {
        let shift = inputs[7] & 15;
        for edge in &mut inputs[1..4] {
            *edge >>= shift;
        }
        // Depths near each other, and rarely a bias.
        let (first, count) = powers(inputs[0]);
        let nearest = first + (inputs[7] >> 4) % (count - 4);
        for w in &mut inputs[4..7] {
            *w = sized(*w, (nearest.max(-20), 5));
        }
        if inputs[7] & 0x30 != 0 {
            inputs[7] = 0;
        }
    }

    fn accepts(&self, inputs: &[i64], profile: Profile) -> bool {
        has(inputs[0], profile) && inputs[1..4].iter().any(|e| *e > 0) && inputs[4..7].iter().all(|w| *w >= LEAST_W)
    }

    fn evaluate(&self, inputs: &[i64], _: &Conditions, results: &mut [i64]) {
        let (format, w) = (named(inputs[0]), floats(&inputs[4..7]));
        let offset = state::PolygonOffset { bias: float(inputs[7]), factor: 0.0 };
        let test = DepthTest { w_buffer: true, offset, ..test() };
        let plane = any().and_then(|any| DepthPlane::new(&test, format, &any, ([0.0; 3], Some(w))));
        results[0] = word(format, plane.unwrap_or_default().at([1, 2, 3].map(|n| inputs[n]))).into();
    }
}
