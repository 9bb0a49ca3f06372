//! Triangles: the pixels that they cover, and the values that they interpolate.

use super::{Column, Conditions, Kind, Reach, Unit, float, put};
use ninebit::raster::depth;
use ninebit::raster::interpolate::{self, Sample};
use ninebit::raster::setup::{Triangle, significant};
use ninebit::state::{DepthFormat, Profile, TriangleVertices, Vertex, Vertices};

const POSITIONS: [&str; 6] = ["in.x0", "in.y0", "in.x1", "in.y1", "in.x2", "in.y2"];
const EDGES: [&str; 3] = ["mid.e0", "mid.e1", "mid.e2"];

/// Corners of some triangle.
pub(super) const LARGE: [[f32; 4]; 3] = [[0.0, 0.0, 0.0, 1.0], [64.0, 0.0, 0.0, 1.0], [0.0, 64.0, 0.0, 1.0]];

/// Calls `then` with a sample of a triangle whose vertices all have these coordinates, and with the vertices.
pub(super) fn with_place<T>(
    coordinates: [f32; 4],
    then: impl FnOnce(&Sample<'_>, TriangleVertices<'_>) -> T,
) -> Option<T> {
    let triangle = Triangle::new(LARGE, true, Profile::Nv2a)?;
    let vertex = |position| Vertex { position, texture_coordinates: [coordinates; 4], ..Vertex::default() };
    let vertices: Vertices = LARGE.into_iter().map(vertex).collect();
    Some(then(&Sample::new(&triangle, triangle.edges(8, 8)), vertices.triangle([0, 1, 2])))
}

/// Largest position of the drawn triangles, 1/16 pixel.
const FARTHEST: i64 = 640 * 16;

/// Returns the columns of three positions in 1/16 pixel, and of a pixel.
pub(super) fn geometry() -> Vec<Column> {
    let mut columns = POSITIONS.map(|name| Column::signed(name, 17, 0, FARTHEST)).to_vec();
    columns.extend(["in.column", "in.row"].map(|name| Column::unsigned(name, 10, 640)));
    columns
}

/// Moves the pixel into the triangle's box. Makes a third of the triangles small, with whole pixels as corners, so that edges and ties
/// occur.
pub(super) fn fit(inputs: &mut [i64]) {
    let (positions, pixel) = inputs.split_at_mut(6);
    let mixed = positions.iter().fold(0, |sum, n| (sum * 31 + n) & 0xffff);
    if mixed % 3 == 0 {
        for position in positions.iter_mut() {
            *position = *position / 16 % 17 * 16;
        }
    } else if mixed % 3 == 1 {
        for position in positions.iter_mut() {
            *position = *position / 4 % 80 * 4;
        }
    }
    for (axis, pixel) in pixel.iter_mut().take(2).enumerate() {
        let along = [positions[axis], positions[2 + axis], positions[4 + axis]];
        let (least, most) = (along.iter().min().unwrap_or(&0) / 16, along.iter().max().unwrap_or(&0) / 16);
        *pixel = least + *pixel % (most - least + 1);
    }
}

/// Returns n / 16 as a float, which is exact for |n| below 2^24.
fn sixteenths(n: i64) -> f32 {
    let whole = n as f32;
    if n == 0 { whole } else { f32::from_bits(whole.to_bits() - (4 << 23)) }
}

/// Returns the triangle of a row. `w` are the bits of three floats, if perspective is used.
pub(super) fn triangle(inputs: &[i64], w: Option<&[i64]>, profile: Profile) -> Option<Triangle> {
    let positions = [0, 1, 2].map(|n| {
        let w = w.map_or(1.0, |w| f32::from_bits(w[n] as u32));
        [sixteenths(inputs[2 * n]), sixteenths(inputs[2 * n + 1]), 0.0, w]
    });
    Triangle::new(positions, w.is_some(), profile)
}

/// Returns whether the pixel is covered.
pub(super) fn is_covered(inputs: &[i64], profile: Profile) -> bool {
    triangle(inputs, None, profile).is_some_and(|t| t.covers(t.edges(inputs[6], inputs[7])))
}

/// Coverage of a pixel by a triangle.
pub(super) struct Coverage;

impl Unit for Coverage {
    known_as!(
        "coverage", &["RAS-2", "RAS-3"],
        "whether a triangle of snapped positions (1/16 pixel) covers a pixel; edge functions in 1/256 square pixel", Geometry;
        takes [geometry()];
        gives [Column::results(EDGES, Kind::Signed(36)), Column::result("out.covered", Kind::Unsigned(1))]
    );

    fn regressions(&self) -> Vec<Vec<i64>> {
        // A sample on an edge: top, bottom, left, right, and a corner; both windings.
        let rows: [[i64; 8]; 5] = [
            [0, 24, 64, 24, 32, 88, 1, 1],
            [0, 88, 64, 88, 32, 24, 1, 5],
            [24, 0, 24, 64, 88, 32, 1, 1],
            [88, 0, 88, 64, 24, 32, 5, 1],
            [24, 24, 88, 24, 24, 88, 1, 1],
        ];
        let turned = rows.map(|[x0, y0, x1, y1, x2, y2, i, j]| [x0, y0, x2, y2, x1, y1, i, j]);
        rows.into_iter().chain(turned).map(Vec::from).collect()
    }

    fn fit(&self, inputs: &mut [i64]) {
        fit(inputs);
    }

    fn evaluate(&self, inputs: &[i64], conditions: &Conditions, results: &mut [i64]) {
        let Some(triangle) = triangle(inputs, None, conditions.profile) else { return results.fill(0) };
        let edges = triangle.edges(inputs[6], inputs[7]);
        results[..3].copy_from_slice(&edges);
        results[3] = triangle.covers(edges).into();
    }
}

/// The weights of the vertices' colours.
pub(super) struct ColorWeights;

impl Unit for ColorWeights {
    known_as!(
        "color-weights", &["INT-1", "INT-2", "INT-3", "INT-6"],
        "the weights, in 256ths, of the colours of vertices 0 and 2 at a covered pixel; vertex 1 takes the remainder", Geometry;
        takes [geometry(), W.map(w)];
        gives [
            Column::results(EDGES, Kind::Signed(36)),
            Column::results(["mid.p0", "mid.p1", "mid.p2"], Kind::Unsigned(28)),
            Column::results(["mid.lowered0", "mid.lowered2"], Kind::Unsigned(1)),
            Column::results(["out.weight0", "out.weight2"], Kind::Unsigned(9)),
        ]
    );

    fn regressions(&self) -> Vec<Vec<i64>> {
        // Exact weights of which several could dominate: eighths 1 3 4, 3 1 4 and 3 4 1, and sixteenths 5 6 5. Then halves and quarters of
        // a power-of-two area, where no tie is lowered if all w are equal.
        let [one, two, other] = [1.0_f32, 2.0, 1.5].map(|w| i64::from(w.to_bits()));
        let positions = [
            [40, 24, 104, 216, 88, 264],
            [104, 216, 40, 24, 88, 264],
            [104, 216, 88, 264, 40, 24],
            [79, 232, 103, 216, 79, 200],
        ];
        let three = i64::from(3.0_f32.to_bits());
        let unequal = vec![8, 8, 72, 8, 8, 72, 1, 1, three, one, one];
        let exact = [one, two, other].map(|w| vec![8, 8, 72, 8, 8, 72, 1, 1, w, w, w]);
        let tied = positions.into_iter().map(|row| [&row[..], &[5, 13, one, one, one]].concat());
        tied.chain(exact).chain([unequal]).collect()
    }

    fn fit(&self, inputs: &mut [i64]) {
        fit(inputs);
    }

    fn accepts(&self, inputs: &[i64], profile: Profile) -> bool {
        is_covered(inputs, profile)
    }

    fn evaluate(&self, inputs: &[i64], conditions: &Conditions, results: &mut [i64]) {
        let Some(triangle) = triangle(inputs, Some(&inputs[8..]), conditions.profile) else { return results.fill(0) };
        let sample = Sample::new(&triangle, triangle.edges(inputs[6], inputs[7]));
        let weights = sample.weights();
        results[..3].copy_from_slice(&sample.e);
        results[3..6].copy_from_slice(&triangle.p());
        for (n, weight) in weights.into_iter().enumerate() {
            (results[6 + n], results[8 + n]) = (weight.lowered, weight.value);
        }
    }
}

/// The depth of a pixel from the depths of three vertices.
pub(super) struct DepthInterpolation;

impl Unit for DepthInterpolation {
    known_as!(
        "depth-interpolation", &["DEP-1"],
        "the depth of a covered pixel from three vertex depths in units of the buffer's last bit", Geometry;
        takes [
            geometry(),
            Column::listed("cfg.bits", Kind::Unsigned(5), &[16, 24]),
            ["in.z0", "in.z1", "in.z2"].map(|name| Column::unsigned(name, 24, (1 << 24) - 1)),
        ];
        gives [Column::results(EDGES, Kind::Signed(36)), Column::result("out.depth", Kind::Unsigned(24))]
    );

    fn regressions(&self) -> Vec<Vec<i64>> {
        // A large quad of a captured frame, with each edge number the largest in turn, and with exponents of two and of three edge numbers
        // that are equal.
        let large = [2048, 640, 8192, 640, 8192, 7040];
        let pixels = [[408, 227], [200, 41], [505, 60], [500, 430], [256, 106], [384, 173], [340, 90], [300, 219]];
        let z = [[11_184_809, 11_184_809, 16_777_214], [0, 960, 0], [16_777_215, 0, 8_388_607], [5, 70_000, 1]];
        let row = |pixel: [i64; 2], z: [i64; 3]| [&large[..], &pixel, &[24], &z].concat();
        // Reciprocals that are low by 3/16 of a step instead of half a step, and not exact.
        let low = [
            [4915, 7045, 10035, 5508, 7107, 163, 476, 348, 24, 3_597_702, 12_720_132, 15_691_790],
            [2917, 264, 8027, 1474, 5186, 8247, 328, 231, 24, 8_419_059, 4_525_543, 12_990_690],
            [8529, 9904, 5415, 596, 1156, 2443, 212, 216, 24, 15_346_555, 6_445_416, 1_166_487],
            [493, 1674, 4381, 62, 7888, 3734, 378, 115, 24, 15_863_290, 14_299_080, 3_347_501],
            [9821, 6498, 5739, 9119, 6852, 1364, 476, 200, 24, 13_699_386, 12_271_433, 3_587_143],
            [6213, 6326, 97, 5301, 9255, 2082, 137, 312, 24, 2_182_219, 8_827_351, 5_483_606],
        ];
        let captured = pixels.into_iter().flat_map(|pixel| z.map(|z| row(pixel, z)));
        captured.chain(low.map(|row| row.to_vec())).collect()
    }

    fn fit(&self, inputs: &mut [i64]) {
        fit(inputs);
        for z in 9..12 {
            inputs[z] >>= 24 - inputs[8];
        }
    }

    fn accepts(&self, inputs: &[i64], profile: Profile) -> bool {
        is_covered(inputs, profile) && inputs[9..].iter().all(|z| z >> inputs[8] == 0)
    }

    fn evaluate(&self, inputs: &[i64], conditions: &Conditions, results: &mut [i64]) {
        let Some(triangle) = triangle(inputs, None, conditions.profile) else { return results.fill(0) };
        let sample = Sample::new(&triangle, triangle.edges(inputs[6], inputs[7]));
        results[..3].copy_from_slice(&sample.e);
        let format = if inputs[8] == 16 { DepthFormat::Z16 } else { DepthFormat::Z24S8 };
        let z = [9, 10, 11].map(|n| inputs[n] as f32);
        results[3] = depth::word(format, depth::interpolate(sample.e, z)).into();
    }
}

const W: [&str; 3] = ["in.w0", "in.w1", "in.w2"];

/// Returns a column of w as bits: powers of two, which yield ties, and others.
fn w(name: &str) -> Column {
    let bits = [1.0_f32, 2.0, 4.0, 0.5, 1.5, 3.0, 1.25, 7.0, 1.1, 2.7, 0.3, 100.0].map(|w| i64::from(w.to_bits()));
    Column::listed(name, Kind::Hex(32), &bits)
}

/// Perspective weights of three vertices.
pub(super) struct PerspectiveWeights;

impl Unit for PerspectiveWeights {
    known_as!(
        "perspective-weights", &["INT-1", "INT-6"],
        "the perspective weights of three vertices, from their w (floats) with as many bits as the chip uses", Geometry;
        takes [W.map(|name| Column::float(name, false, 20))];
        gives [
            Column::results(["mid.w0", "mid.w1", "mid.w2"], Kind::Hex(32)),
            Column::results(["out.p0", "out.p1", "out.p2"], Kind::Unsigned(28)),
        ]
    );

    fn accepts(&self, inputs: &[i64], _: Profile) -> bool {
        // RAS-0 has no smaller w.
        inputs.iter().all(|w| *w >= 107 << 23)
    }

    fn fit(&self, inputs: &mut [i64]) {
        for w in inputs {
            *w = (*w).max(107 << 23);
        }
    }

    fn evaluate(&self, inputs: &[i64], conditions: &Conditions, results: &mut [i64]) {
        let w = [0, 1, 2].map(|n| float(inputs[n]));
        let Some(mut triangle) = Triangle::new(LARGE, false, conditions.profile) else { return };
        triangle.weigh(w, true, conditions.profile);
        put(results, significant(w, conditions.profile).map(f32::to_bits));
        results[3..].copy_from_slice(&triangle.p());
    }
}

/// One colour channel of a pixel.
pub(super) struct ColorInterpolation;

impl Unit for ColorInterpolation {
    known_as!(
        "color-interpolation", &["INT-2"],
        "one colour channel from three vertices' bytes and the weights of vertices 0 and 2 in 256ths";
        takes [
            ["in.c0", "in.c1", "in.c2"].map(Column::byte),
            ["in.weight0", "in.weight2"].map(|name| Column::unsigned(name, 9, 256)),
        ];
        gives [Column::result("out.color", Kind::Unsigned(8))]
    );

    fn accepts(&self, inputs: &[i64], _: Profile) -> bool {
        inputs[3] + inputs[4] <= 256
    }

    fn fit(&self, inputs: &mut [i64]) {
        inputs[4] %= 257 - inputs[3];
    }

    fn evaluate(&self, inputs: &[i64], _: &Conditions, results: &mut [i64]) {
        let c = [0, 1, 2].map(|n| inputs[n] as i32);
        results[0] = interpolate::color(c, inputs[3] as i32, inputs[4] as i32).into();
    }
}

/// A texture coordinate of a pixel.
pub(super) struct TextureCoordinate;

impl Unit for TextureCoordinate {
    known_as!(
        "texture-coordinate", &["INT-1", "INT-4", "INT-4t", "INT-6"],
        "u of a covered pixel in 1/256 texel from a float coordinate at each vertex, q being 1", Geometry;
        takes [
            geometry(),
            W.map(w),
            ["in.s0", "in.s1", "in.s2"].map(|name| Column::float(name, true, 5)),
            Column::listed("in.size", Kind::Unsigned(13), &[1, 2, 16, 64, 256, 512, 4096]),
        ];
        gives [
            Column::results(["mid.g0", "mid.g1", "mid.g2"], Kind::Signed(56)),
            Column::result("mid.lowered", Kind::Signed(3)),
            Column::result("out.u", Kind::Signed(26)),
        ]
    );

    fn regressions(&self) -> Vec<Vec<i64>> {
        // The handbook's triangle: u at a tie, hardly above one where S > 0, and hardly below one where S < 0.
        let one = 0x3f80_0000;
        let above = [0, 0x3180_0000, 0x3200_0000, 0x3280_0000].map(|tiny| [0, tiny, one]);
        let below = [0, 0xb180_0000, 0xb200_0000, 0xb280_0000].map(|tiny| [0, one, tiny]);
        let row = |s: &[i64; 3]| [&[0, 0, 1536, 0, 0, 1536, 10, 1, one, one, one][..], s, &[64]].concat();
        above.iter().chain(&below).map(row).collect()
    }

    fn fit(&self, inputs: &mut [i64]) {
        fit(inputs);
        // Coordinates of whole texels at vertices on whole pixels, which yield ties.
        if inputs[6] & 1 == 0 {
            for n in 11..14 {
                inputs[n] = i64::from(((inputs[n] & 15) as f32).to_bits());
            }
        }
    }

    fn accepts(&self, inputs: &[i64], profile: Profile) -> bool {
        is_covered(inputs, profile)
    }

    fn evaluate(&self, inputs: &[i64], conditions: &Conditions, results: &mut [i64]) {
        let triangle = triangle(inputs, Some(&inputs[8..11]), conditions.profile);
        let Some(mut triangle) = triangle else { return results.fill(0) };
        triangle.lose(conditions.policies.plane_loss);
        let sample = Sample::new(&triangle, triangle.edges(inputs[6], inputs[7]));
        let g = triangle.coordinate([11, 12, 13].map(|n| f32::from_bits(inputs[n] as u32)), inputs[14] as u32);
        let u = sample.coordinate(&g);
        results[..3].copy_from_slice(&g);
        (results[3], results[4]) = (u.lowered, u.value);
    }
}
