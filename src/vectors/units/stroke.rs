//! Lines, points, edges of triangles, and patterns.

use std::sync::Arc;

use super::raster::TRIANGLES;
use super::{Column, Conditions, Kind, Reach, Unit, float, named, put, sized};
use ninebit::raster::depth::{self, word};
use ninebit::raster::interpolate::Sample;
use ninebit::raster::modes::outer_edges;
use ninebit::raster::setup::Triangle;
use ninebit::raster::stroke::{sprite_coordinate, stipples};
use ninebit::raster::triangles::Triangles;
use ninebit::state::{
    DepthFormat, LineRasterization, Lines, Named, PointRasterization, PolygonStipple, Profile, ProvokingVertex,
};
use ninebit::vertex::point::PointParameters;

/// Largest position, 1/16 pixel.
const FARTHEST: i64 = 640 * 16;

/// Returns the columns of positions in 1/16 pixel.
fn positions<const N: usize>(names: [&str; N]) -> [Column; N] {
    names.map(|name| Column::signed(name, 17, 0, FARTHEST))
}

fn pixel() -> [Column; 2] {
    ["in.column", "in.row"].map(|name| Column::unsigned(name, 10, 640))
}

/// Returns the columns of a line's ends.
fn ends() -> [Column; 4] {
    positions(["in.x0", "in.y0", "in.x1", "in.y1"])
}

/// Returns the line of a row.
fn line(ends: &[i64], lines: Lines) -> Triangle {
    Triangle::line([[ends[0], ends[1]], [ends[2], ends[3]]], lines)
}

/// Moves a pixel near the box of some positions.
fn near(positions: &[i64], reach: i64, pixel: &mut [i64]) {
    for (axis, pixel) in pixel.iter_mut().enumerate() {
        let along = positions.iter().skip(axis).step_by(2);
        let (least, most) = (along.clone().min().unwrap_or(&0) / 16 - reach, along.max().unwrap_or(&0) / 16 + reach);
        *pixel = (least + *pixel % (most - least + 1)).clamp(0, 640);
    }
}

/// Makes many lines short, with ends on whole and half pixels, so that ties occur, and moves the pixel near the line.
fn fit_line(ends: &mut [i64], reach: i64, pixel: &mut [i64]) {
    let mixed = ends.iter().fold(0, |sum, n| (sum * 31 + n) & 0xffff);
    if mixed % 3 != 0 {
        let (step, count) = if mixed % 3 == 1 { (16, 24) } else { (8, 90) };
        ends.iter_mut().for_each(|end| *end = *end / step % count * step);
    }
    // Every other pixel lies near the line itself.
    if mixed & 1 == 0 {
        let (part, across) = (pixel[0] % 65, pixel[1] % (2 * reach + 1) - reach);
        let along = [0, 1].map(|axis| (ends[axis] + (ends[axis + 2] - ends[axis]) * part / 64) / 16);
        let is_x_major = (ends[2] - ends[0]).abs() >= (ends[3] - ends[1]).abs();
        for axis in 0..2 {
            pixel[axis] = (along[axis] + if is_x_major == (axis == 1) { across } else { 0 }).clamp(0, 640);
        }
    } else {
        near(ends, reach, pixel);
    }
}

/// How lines without smooth edges become pixels.
const SHARP: &[&str] = LineRasterization::NAMES.split_at(2).0;

/// Coverage of a pixel by a line.
pub(super) struct LineCoverage;

impl Unit for LineCoverage {
    known_as!(
        "line-coverage", &["LIN-1", "LIN-2"],
        "whether a line of a width in 1/8 pixel between snapped positions (1/16 pixel) covers a pixel; how far it is from its ends, and the second end's weight of colours", Geometry;
        takes [[Column::names("cfg.rasterization", SHARP)], ends(), [Column::unsigned("in.width", 9, 511)], pixel()];
        gives [
            Column::results(["mid.e1", "mid.e2"], Kind::Signed(36)),
            Column::result("out.covered", Kind::Unsigned(1)),
            Column::result("out.weight", Kind::Unsigned(9)),
        ]
    );

    fn regressions(&self) -> Vec<Vec<i64>> {
        let captured = [
            [0, 2560, 6368, 3520, 6208, 128, 170, 396],
            [0, 2560, 6368, 3520, 6208, 256, 215, 371],
            [0, 2560, 6368, 3520, 6208, 256, 215, 372],
        ];
        // Samples on sides, ends and corners of lines in eight directions.
        let turned = |[x, y]: [i64; 2]| [[x, y], [-y, x], [-x, -y], [y, -x]].map(|[x, y]| [160, 160, 160 + x, 160 + y]);
        let lines = [[96, 0], [64, 64], [96, 32]].map(turned).concat();
        let pixels = |ends: [i64; 4]| {
            (0..9).flat_map(move |row| {
                let pixel = move |column: i64| (6 + column, 6 + row);
                (0..9).map(pixel).flat_map(move |(column, row)| {
                    [0, 1].map(|kind| vec![kind, ends[0] + 8, ends[1] + 8, ends[2] + 8, ends[3] + 8, 32, column, row])
                })
            })
        };
        captured.map(Vec::from).into_iter().chain(lines.into_iter().flat_map(pixels)).collect()
    }

    fn fit(&self, inputs: &mut [i64]) {
        // Mostly narrow ones.
        if inputs[5] % 4 != 0 {
            inputs[5] %= 80;
        }
        let (ends, rest) = inputs[1..].split_at_mut(4);
        let reach = (rest[0] + 15) / 16;
        fit_line(ends, reach, &mut rest[1..]);
    }

    fn evaluate(&self, inputs: &[i64], _: &Conditions, results: &mut [i64]) {
        let lines = Lines { width: inputs[5] as u16, rasterization: named(inputs[0]) };
        let line = line(&inputs[1..5], lines);
        let edges = line.edges(inputs[6], inputs[7]);
        let covered = line.contains(inputs[6], inputs[7]);
        let weight = if covered { Sample::new(&line, edges).color_weights()[1] } else { 0 };
        put(results, [edges[1], edges[2], covered.into(), weight]);
    }
}

/// The depth of a pixel of a line.
pub(super) struct LineDepth;

impl Unit for LineDepth {
    known_as!(
        "line-depth", &["LIN-3"],
        "the word of 24 bits that a pixel of a line eight pixels wide has, from depths of its ends in steps (floats)", Geometry;
        takes [ends(), pixel(), ["in.z0", "in.z1"].map(|name| Column::float(name, false, 24))];
        gives [Column::results(["mid.e1", "mid.e2"], Kind::Signed(36)), Column::result("out.word", Kind::Hex(24))]
    );

    fn regressions(&self) -> Vec<Vec<i64>> {
        let z = |z: f32| i64::from(z.to_bits());
        let row = |n: i64| vec![16, 16, 528, 144, 2 + 3 * n, 2 + n, z(0.0), z(16_777_215.0)];
        (0..8).map(row).collect()
    }

    fn fit(&self, inputs: &mut [i64]) {
        let (ends, rest) = inputs.split_at_mut(4);
        fit_line(ends, 3, &mut rest[..2]);
        rest[2..].iter_mut().for_each(|z| *z = sized(*z & 0x7fff_ffff, (8, 16)));
    }

    fn accepts(&self, inputs: &[i64], _: Profile) -> bool {
        line(inputs, Lines { width: 64, ..Lines::default() }).contains(inputs[4], inputs[5])
    }

    fn evaluate(&self, inputs: &[i64], _: &Conditions, results: &mut [i64]) {
        let line = line(inputs, Lines { width: 64, ..Lines::default() });
        let edges = line.edges(inputs[4], inputs[5]);
        let [first, second] = [inputs[6], inputs[7]].map(float);
        let depth = depth::interpolate(edges, [first, first, second]);
        put(results, [edges[1], edges[2], word(DepthFormat::Z24S8, depth).into()]);
    }
}

/// Coverage of a pixel by a point.
pub(super) struct PointCoverage;

impl Unit for PointCoverage {
    known_as!(
        "point-coverage", &["PNT-1"],
        "whether a point of a size in 1/8 pixel at a snapped position (1/16 pixel) covers a pixel", Geometry;
        takes [
            [Column::choice::<PointRasterization>("cfg.rasterization")],
            positions(["in.x", "in.y"]),
            [Column::unsigned("in.size", 9, 511)],
            pixel(),
        ];
        gives [Column::result("out.covered", Kind::Unsigned(1))]
    );

    fn regressions(&self) -> Vec<Vec<i64>> {
        let sizes = [24, 32, 8, 4, 0, 1, 511, 512 - 256];
        let places = [(6464, 6472), (6471, 6465)];
        let row = |(x, y): (i64, i64), size: i64, column: i64| vec![0, x, y, size, 402 + column, 404];
        let of = |size: i64| places.into_iter().flat_map(move |at| (-1..5).map(move |column| row(at, size, column)));
        // Thin ones on corners, edges and insides of pixels.
        let corners = [(6464, 6464), (6464, 6470), (6470, 6464), (6470, 6470)];
        let thin = |(x, y): (i64, i64)| (0..9).map(move |n| vec![1, x, y, 8, 403 + n % 3, 403 + n / 3]);
        sizes.into_iter().flat_map(of).chain(corners.into_iter().flat_map(thin)).collect()
    }

    fn fit(&self, inputs: &mut [i64]) {
        if inputs[3] % 4 != 0 {
            inputs[3] %= 80;
        }
        let (point, pixel) = inputs.split_at_mut(4);
        // Usually near an edge.
        let reach = if point[0] == 0 { point[3] / 16 + 1 } else { 0 };
        for axis in 0..2 {
            let centre = point[1 + axis] / 16;
            let beside = [centre - reach, centre + reach, centre][(pixel[axis] % 3) as usize];
            pixel[axis] = (beside + pixel[axis] / 3 % 3 - 1).clamp(0, 640);
        }
    }

    fn evaluate(&self, inputs: &[i64], _: &Conditions, results: &mut [i64]) {
        let rasterization = named::<PointRasterization>(inputs[0]);
        let point = Triangle::point([inputs[1], inputs[2]], inputs[3] as u16, rasterization);
        results[0] = point.contains(inputs[4], inputs[5]).into();
    }
}

/// The size of a point by its distance.
pub(super) struct PointSize;

impl Unit for PointSize {
    known_as!(
        "point-size", &["PNT-3"],
        "the size of a point in 1/8 pixel by its distance from the viewer, A, B, C, bias, range and smallest size (floats)", Geometry;
        takes [
            [Column::float("in.distance", false, 8)],
            ["in.a", "in.b", "in.c"].map(|name| Column::float(name, false, 4)),
            [Column::float("in.bias", true, 1), Column::float("in.range", false, 7), Column::float("in.smallest", false, 7)],
        ];
        gives [Column::result("out.size", Kind::Unsigned(9))]
    );

    fn fit(&self, inputs: &mut [i64]) {
        // Sizes that the register holds.
        for (n, powers) in [(-4, 10), (-4, 6), (-6, 6), (-8, 6), (-4, 3), (-2, 7), (-3, 5)].into_iter().enumerate() {
            inputs[n] = sized(inputs[n], powers);
        }
    }

    fn evaluate(&self, inputs: &[i64], _: &Conditions, results: &mut [i64]) {
        let [distance, a, b, c, bias, range, smallest] = [0, 1, 2, 3, 4, 5, 6].map(|n| float(inputs[n]));
        let parameters = PointParameters { attenuation: [a, b, c], bias, range, smallest };
        results[0] = parameters.size(distance).into();
    }
}

/// Returns how far a pixel of a point of some size can be.
fn farthest(size: i64) -> i64 {
    if size == 0 { 8 } else { size }
}

/// A texture coordinate of a sprite.
pub(super) struct SpriteCoordinate;

impl Unit for SpriteCoordinate {
    known_as!(
        "sprite-coordinate", &["PNT-2"],
        "u of a pixel of a sprite in 1/256 texel, from its distance from the point (1/16 pixel) and the point's size (1/8 pixel)", Geometry;
        on &[Profile::Nv2a];
        takes [
            [Column::signed("in.distance", 10, -511, 511), Column::unsigned("in.size", 9, 511)],
            [Column::listed("in.side", Kind::Unsigned(13), &[1, 2, 32, 64, 256, 4096])],
        ];
        gives [Column::result("out.u", Kind::Signed(22))]
    );

    fn accepts(&self, inputs: &[i64], _: Profile) -> bool {
        inputs[0].abs() <= farthest(inputs[1])
    }

    fn fit(&self, inputs: &mut [i64]) {
        inputs[0] %= farthest(inputs[1]) + 1;
    }

    fn evaluate(&self, inputs: &[i64], _: &Conditions, results: &mut [i64]) {
        results[0] = sprite_coordinate(inputs[0], inputs[1], inputs[2], 8);
    }
}

/// An edge of a triangle that is drawn as a line.
pub(super) struct PolygonEdge;

/// Returns the triangles of a row's primitive.
fn triangles(inputs: &[i64]) -> Triangles {
    let indices: Arc<[u32]> = (0..inputs[1] as u32).collect();
    Triangles::split(&indices, named(inputs[0]), ProvokingVertex::Last)
}

impl Unit for PolygonEdge {
    known_as!(
        "polygon-edge", &["POL-1"],
        "the ends of an edge of a triangle of a primitive, and whether lines and points (at its first end) are drawn of it; edge k lies opposite vertex k", Geometry;
        takes [
            [Column::names("cfg.topology", TRIANGLES)],
            ["in.vertices", "in.triangle"].map(|name| Column::unsigned(name, 6, 63)),
            [Column::unsigned("in.edge", 2, 2)],
        ];
        gives [Column::results(["out.from", "out.to"], Kind::Unsigned(6)), Column::result("out.drawn", Kind::Unsigned(1))]
    );

    fn accepts(&self, inputs: &[i64], _: Profile) -> bool {
        inputs[2] < triangles(inputs).len() as i64
    }

    fn fit(&self, inputs: &mut [i64]) {
        inputs[2] %= (triangles(inputs).len() as i64).max(1);
    }

    fn evaluate(&self, inputs: &[i64], _: &Conditions, results: &mut [i64]) {
        let (all, number, edge) = (triangles(inputs), inputs[2] as usize, inputs[3] as usize);
        let vertices = all.vertices(number);
        let drawn = outer_edges(named(inputs[0]), number, all.len())[edge];
        put(results, [vertices[(edge + 1) % 3], vertices[(edge + 2) % 3], drawn.into()]);
    }
}

/// A pixel of a pattern.
pub(super) struct Stipple;

impl Unit for Stipple {
    known_as!(
        "polygon-stipple", &["STP-1"],
        "whether a filled triangle draws a pixel; word n of its pattern is the given word rotated left by n bits", Geometry;
        takes [[Column::word("in.word", 32)], ["in.column", "in.row"].map(|name| Column::unsigned(name, 12, 4095))];
        gives [Column::result("mid.word", Kind::Hex(32)), Column::result("out.drawn", Kind::Unsigned(1))]
    );

    fn regressions(&self) -> Vec<Vec<i64>> {
        let row = |n: i64| [vec![0x8000_0000, n, 0], vec![0x0000_0080, n, 31], vec![0x00ff_3301, 32 + n, 31 - n]];
        (0..32).flat_map(row).collect()
    }

    fn evaluate(&self, inputs: &[i64], _: &Conditions, results: &mut [i64]) {
        let words = std::array::from_fn(|n| (inputs[0] as u32).rotate_left(n as u32));
        let word = words[31 - (inputs[2] & 31) as usize];
        put(results, [i64::from(word), stipples(&PolygonStipple(words), inputs[1], inputs[2]).into()]);
    }
}
