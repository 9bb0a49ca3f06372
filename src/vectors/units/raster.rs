//! Triangles: the pixels that they cover, and the values that they interpolate.

use super::{Column, Conditions, Kind, Reach, Unit, float, put};
use ninebit::raster::binary::Binary;
use ninebit::raster::depth;
use ninebit::raster::interpolate::{self, Sample};
use ninebit::raster::setup::Triangle;
use ninebit::raster::weights::{Linear, differences};
use ninebit::state::{DepthFormat, Named, Profile, Topology, TriangleVertices, Vertex, Vertices};

const POSITIONS: [&str; 6] = ["in.x0", "in.y0", "in.x1", "in.y1", "in.x2", "in.y2"];
const EDGES: [&str; 3] = ["mid.e0", "mid.e1", "mid.e2"];

/// How vertices make triangles.
pub(super) const TRIANGLES: &[&str] = Topology::NAMES.split_at(6).0;

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

/// Coverage of a pixel by a triangle with vertices behind the eye.
pub(super) struct EyeCoverage;

impl Unit for EyeCoverage {
    known_as!(
        "eye-coverage", &["RAS-8"],
        "whether a triangle covers a pixel where some of its vertices lie behind the eye: bit k of `in.behind` is vertex k", Geometry;
        takes [geometry(), [Column::unsigned("in.behind", 3, 7)]];
        gives [Column::results(EDGES, Kind::Signed(36)), Column::result("out.covered", Kind::Unsigned(1))]
    );

    fn regressions(&self) -> Vec<Vec<i64>> {
        // Both windings, each set of vertices, a pixel on each side of an edge and of the vertex opposite, and one on an edge.
        let pixels = [[6, 6], [9, 9], [2, 9], [9, 2], [2, 2], [4, 6], [8, 4], [4, 2], [2, 4]];
        let row = |[i, j]: [i64; 2], behind: i64| {
            [vec![72, 72, 136, 72, 72, 136, i, j, behind], vec![72, 72, 72, 136, 136, 72, i, j, behind]]
        };
        (0..8).flat_map(|behind| pixels.into_iter().flat_map(move |pixel| row(pixel, behind))).collect()
    }

    fn fit(&self, inputs: &mut [i64]) {
        let pixel = [inputs[6], inputs[7]];
        fit(inputs);
        // Most of these triangles reach out of their boxes.
        if inputs[8] != 0 {
            inputs[6..8].copy_from_slice(&pixel);
        }
    }

    fn evaluate(&self, inputs: &[i64], conditions: &Conditions, results: &mut [i64]) {
        let w = [0, 1, 2].map(|k| if inputs[8] >> k & 1 == 1 { -1.0_f32 } else { 1.0 });
        let w = w.map(|w| i64::from(w.to_bits()));
        let Some(triangle) = triangle(inputs, Some(&w), conditions.profile) else { return results.fill(0) };
        let edges = triangle.edges(inputs[6], inputs[7]);
        results[..3].copy_from_slice(&edges);
        results[3] = triangle.covers(edges).into();
    }
}

/// The weights of the vertices.
pub(super) struct VertexWeights;

impl Unit for VertexWeights {
    known_as!(
        "weights", &["WGT-1", "INT-2", "INT-6"],
        "the weights of a triangle's vertices at a covered pixel, in perspective if their w differ: edge functions, edge numbers e (floats), the reciprocal of their sum as a mantissa and a power of two, the weights b (floats), and those of the colours of vertices 0 and 2 in 256ths", Geometry;
        takes [geometry(), W.map(w)];
        gives [
            Column::results(EDGES, Kind::Signed(36)),
            Column::results(["mid.edge0", "mid.edge1", "mid.edge2"], Kind::Hex(32)),
            Column::result("mid.reciprocal", Kind::Unsigned(29)),
            Column::result("mid.reciprocal_power", Kind::Signed(8)),
            Column::result("mid.dominant", Kind::Unsigned(2)),
            Column::results(["out.b0", "out.b1", "out.b2"], Kind::Hex(32)),
            Column::results(["out.weight0", "out.weight2"], Kind::Unsigned(9)),
        ]
    );

    fn regressions(&self) -> Vec<Vec<i64>> {
        // Exact weights of which several could dominate: eighths 1 3 4, 3 1 4 and 3 4 1, and sixteenths 5 6 5. Then halves and quarters of
        // a power-of-two area, whose reciprocal is exact.
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
        // Edge functions of more than 24 bits, of which all cuts lose something.
        let large = [
            [0, 0, 10240, 3, 5, 10239, 100, 300],
            [0, 0, 10240, 3, 5, 10239, 1, 1],
            [7, 0, 3, 10240, 10233, 1, 200, 3],
        ];
        let large = large
            .into_iter()
            .flat_map(|row| [[one; 3], [one, three, other], [other, two, three]].map(|w| [&row[..], &w].concat()));
        let tied = positions.into_iter().map(|row| [&row[..], &[5, 13, one, one, one]].concat());
        tied.chain(exact).chain([unequal]).chain(large).collect()
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
        let bits = |n: Binary| i64::from(n.nearest_f32().to_bits());
        let edges = sample.e.into_iter().chain(weights.edges.map(bits));
        let Binary { mantissa, exponent } = weights.reciprocal.first_bits(29);
        let reciprocal = [mantissa, exponent, weights.dominant as i64];
        put(results, edges.chain(reciprocal).chain(weights.b.map(bits)).chain(sample.color_weights()));
    }
}

/// A number of the vertices by their weights.
pub(super) struct LinearNumber;

impl Unit for LinearNumber {
    known_as!(
        "linear", &["WGT-1"],
        "a number f of three vertices by the weights of vertices 0 and 2 (all floats): the differences (floats), and f as a mantissa and a power of two", Geometry;
        takes [
            ["in.b0", "in.b2"].map(|name| Column::float(name, false, 6)),
            ["in.f0", "in.f1", "in.f2"].map(|name| Column::float(name, true, 5)),
        ];
        gives [
            Column::results(["mid.difference0", "mid.difference2"], Kind::Hex(32)),
            Column::result("out.mantissa", Kind::Signed(27)),
            Column::result("out.power", Kind::Signed(10)),
        ]
    );

    fn regressions(&self) -> Vec<Vec<i64>> {
        // The captured pixels of TextureWrapMode, then terms that vanish, cancel, or differ by the last bit that counts.
        let bits = |row: [f32; 5]| row.map(|n| i64::from(n.to_bits())).to_vec();
        let tiny = 2.0_f32.powi(-23);
        let rows = [
            [0.96875, 0.0, 0.9, 1.1, 1.1],
            [0.0, 0.03125, 0.9, 0.9, 1.1],
            [0.5, 0.25, 1.0, 1.0, 1.0],
            [0.5, 0.25, 0.0, 0.0, 0.0],
            [1.0, 0.0, 3.0, -1.0, 7.0],
            [0.5, 0.5, tiny, 1.0, tiny],
            [0.25, 0.5, 1e30, 1.0, -1e30],
            [0.25, 0.5, f32::MAX, f32::MIN, 0.0],
            [0.25, 0.5, 1e-38, 1.5e-38, 1e-45],
        ];
        rows.into_iter().map(bits).collect()
    }

    fn accepts(&self, inputs: &[i64], _: Profile) -> bool {
        // Weights are at least 2^-78, or 0, and at most 1.
        inputs[..2].iter().all(|b| *b == 0 || ((127 - 78) << 23..=127 << 23).contains(b))
    }

    fn fit(&self, inputs: &mut [i64]) {
        for b in &mut inputs[..2] {
            let power = 127 - 1 - (*b >> 23) % 12;
            *b = power << 23 | *b & 0x7f_ffff;
        }
    }

    fn evaluate(&self, inputs: &[i64], _: &Conditions, results: &mut [i64]) {
        let [first, third] = [0, 1].map(|n| Binary::new(float(inputs[n])));
        let f = [2, 3, 4].map(|n| float(inputs[n]));
        let Binary { mantissa, exponent } = Linear::<Binary>::new(f).at([first, third]);
        let zeros = mantissa.trailing_zeros().min(63);
        put(results, differences(f).map(f32::to_bits));
        // An odd mantissa, which does not depend on how a number is held.
        (results[2], results[3]) =
            if mantissa == 0 { (0, 0) } else { (mantissa >> zeros, exponent + i64::from(zeros)) };
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
        // Last bits of reciprocals show. The first row is a captured pixel, whose depth is 6340116.
        let low = [
            [8040, 856, 8168, 856, 8168, 6840, 506, 195, 24, 8, 8, 16_698_606],
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

/// Returns a column of w as bits: powers of two, numbers that nv10 cuts and does not cut, and others.
fn w(name: &str) -> Column {
    let near_one = [0x3f80_0008, 0x3f80_0100].map(f32::from_bits);
    let others = [1.0, 2.0, 4.0, 0.5, 1.5, 3.0, 1.25, 7.0, 1.1, 2.7, 0.3, 100.0];
    let bits: Vec<i64> = others.into_iter().chain(near_one).map(|w| w.to_bits().into()).collect();
    Column::listed(name, Kind::Hex(32), &bits)
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
        "texture-coordinate", &["WGT-1", "INT-4", "INT-6"],
        "u of a covered pixel in 1/256 texel from a float coordinate at each vertex, q being 1", Geometry;
        takes [
            geometry(),
            W.map(w),
            ["in.s0", "in.s1", "in.s2"].map(|name| Column::float(name, true, 5)),
            Column::listed("in.size", Kind::Unsigned(13), &[1, 2, 16, 64, 256, 512, 4096]),
        ];
        gives [
            Column::results(["mid.b0", "mid.b1", "mid.b2", "mid.s"], Kind::Hex(32)),
            Column::result("out.u", Kind::Signed(26)),
        ]
    );

    fn regressions(&self) -> Vec<Vec<i64>> {
        // The handbook's triangle: u close to a whole number from both sides.
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
        let Some(triangle) = triangle(inputs, Some(&inputs[8..11]), conditions.profile) else { return results.fill(0) };
        let sample = Sample::new(&triangle, triangle.edges(inputs[6], inputs[7]));
        let s = sample.value(&Linear::new([11, 12, 13].map(|n| f32::from_bits(inputs[n] as u32))));
        let bits = |n: Binary| i64::from(n.nearest_f32().to_bits());
        let u = interpolate::coordinate(s, inputs[14]);
        put(results, sample.weights().b.map(bits).into_iter().chain([bits(s.first_bits(24)), u]));
    }
}
