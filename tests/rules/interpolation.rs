//! Examples of the sections "Interpolation" and "Depth".

use crate::handbook::{example, read};
use ninebit::engine::{RenderOptions, render};
use ninebit::limits::Limits;
use ninebit::plan::{Plan, PlanOptions};
use ninebit::raster::depth::{self, Binary, DepthPlane};
use ninebit::raster::interpolate::{Floored, Sample, color};
use ninebit::raster::setup::Triangle;
use ninebit::state::{CompareFunction, DepthFormat, DepthRange, DepthTest, PolygonOffset, Profile, VertexDepths};
use ninebit::texture::filter;
use ninebit_scene as scene;
use std::path::Path;

/// (0, 0), (side, 0), (0, side) in pixels.
fn right_triangle(side: f32, w: [f32; 3], profile: Profile) -> Triangle {
    let corners = [[0.0, 0.0, 0.0, w[0]], [side, 0.0, 0.0, w[1]], [0.0, side, 0.0, w[2]]];
    Triangle::new(corners, true, profile).unwrap()
}

/// The triangle that the section uses.
pub fn of_the_section() -> Triangle {
    right_triangle(96.0, [1.0; 3], Profile::Nv2a)
}

pub fn at(triangle: &Triangle, i: i64, j: i64) -> Sample<'_> {
    Sample::new(triangle, triangle.edges(i, j))
}

fn floored(value: i64, lowered: bool) -> Floored {
    Floored { value, lowered: lowered.into() }
}

#[test]
fn examples_of_interpolation() {
    let text = "The examples of this section use one triangle: (0, 0), (96, 0), (0, 96) in pixels, w = 1.";
    assert!(read("docs/numerics.md").contains(text), "the handbook uses another triangle");
    let triangle = of_the_section();
    assert_eq!(triangle.doubled_area, 1536 * 1536);

    let int1 = example(
        "INT-1",
        "w = 1, 1, 2: the products are 2, 2, 1, so P = 2^27, 2^27, 2^26. Where E_0 = E_1 = E_2 the weights are 2/5, 2/5, \
         1/5.",
    );
    let deep = right_triangle(96.0, [1.0, 1.0, 2.0], Profile::Nv2a);
    int1.gives("P", deep.p, [1 << 27, 1 << 27, 1 << 26]);
    let sample = Sample::new(&deep, [1; 3]);
    int1.gives("fifths of D", sample.n.map(|n| 5 * n), [2 * sample.d, 2 * sample.d, sample.d]);

    let int2 = example(
        "INT-2",
        "b = 0.3, 0.5, 0.2: W = 76, 129, 51; colours 255, 0, 128 give (19380 + 0 + 6528 + 128) >> 8 = 101, where the real \
         number is 102.1.",
    );
    // The section's triangle has no sample with these weights; the area of a smaller one can be divided by ten.
    let tenths = right_triangle(10.0, [1.0; 3], Profile::Nv2a);
    let tenth = tenths.doubled_area / 10;
    let sample = Sample::new(&tenths, [3 * tenth, 5 * tenth, 2 * tenth]);
    let [w0, w2] = sample.weights().map(|w| w.value);
    int2.gives("W", [w0, 256 - w0 - w2, w2], [76, 129, 51]);
    int2.gives("the products", [255 * w0, 128 * w2], [19_380, 6528]);
    int2.gives("the colour", color([255, 0, 128], w0 as i32, w2 as i32), 101);
    int2.shows("the real number", 0.3 * 255.0 + 0.2 * 128.0, 1, "102.1");

    let int3 = example(
        "INT-3",
        "pixel (10, 1): 256 b0 = 224 exactly and b0 dominates, W0 = 224; 256 b2 = 4 exactly, W2 = 3; W1 = 29.",
    );
    let sample = at(&triangle, 10, 1);
    int3.gives("256 E / D", sample.n.map(|n| 256 * i128::from(n)), [224, 28, 4].map(|k| k * i128::from(sample.d)));
    int3.gives("the dominant weight", sample.dominant(), 0);
    let [w0, w2] = sample.weights();
    int3.gives("W0", w0, floored(224, false)).gives("W2", w2, floored(3, true));
    int3.gives("W1", 256 - w0.value - w2.value, 29);

    let int4 = example(
        "INT-4",
        "s = (0, 0, 1), n = 64, pixel (10, 2): 16384 * 2.5 / 96 = 426.67, u = 426, that is texel 1 and 170/256.",
    );
    let u = at(&triangle, 10, 2).coordinate(&triangle.coordinate([0.0, 0.0, 1.0], 64));
    int4.shows("the real number", 16_384.0 * 2.5 / 96.0, 2, "426.67").gives("u", u, floored(426, false));
    int4.gives("texel and part", (u.value >> 8, u.value & 255), (1, 170));

    let int4t = example(
        "INT-4t",
        "pixel (10, 1), n = 64. s = (0, 0, 1): u would be 256 exactly, S = (1/64) 16384 > 0, so u = 255 and the nearest \
         texel is 0. s = (0, 1, 0): u is 1792 exactly, S < 0, so u stays 1792. q = 2 at all vertices and s = (0, 0, 2): N_q \
         loses nothing, N_s / N_q is 1/64 less 2^-24 of itself, u = floor(256 - 2^-16) = 255.",
    );
    let sample = at(&triangle, 10, 1);
    let plane = |s| triangle.coordinate(s, 64);
    let [third, second] = [plane([0.0, 0.0, 1.0]), plane([0.0, 1.0, 0.0])];
    int4t.gives("256 D", sample.sum(&third), 256 * i128::from(sample.d));
    int4t.gives("64 b2", 64 * sample.n[2], sample.d).gives("S > 0", sample.shortfall(&third) > 0, true);
    let u = sample.coordinate(&third);
    int4t.gives("u of (0, 0, 1)", u, floored(255, true)).gives("its texel", filter::nearest(u.value), 0);
    int4t.gives("1792 D", sample.sum(&second), 1792 * i128::from(sample.d));
    int4t.gives("S < 0", sample.shortfall(&second) < 0, true);
    int4t.gives("u of (0, 1, 0)", sample.coordinate(&second), floored(1792, false));
    let [numerator, denominator, _] = triangle.direction([[0.0, 0.0, 2.0], [2.0; 3], [0.0; 3]]);
    int4t.gives("the loss of N_q", sample.shortfall(&denominator), 0);
    let parts = sample.sum(&numerator) * i128::from(triangle.p[1]);
    int4t.gives("the loss of N_s in 2^-24 / P_1", sample.shortfall(&numerator), parts);
    int4t.gives("64 N_s", 64 * sample.sum(&numerator), sample.sum(&denominator));
    int4t.gives("u of the ratio", sample.ratio(&numerator, &denominator, 64), floored(255, true));

    let int6 = example("INT-6", "on `Nv10` w = 1 + 2^-20 counts as 1, w = 1 + 2^-15 as itself.");
    let p = |w: f32, profile| right_triangle(96.0, [w, 1.0, 1.0], profile).p;
    let (small, large) = (1.0 + 2_f32.powi(-20), 1.0 + 2_f32.powi(-15));
    int6.gives("1 + 2^-20 counts as 1 on Nv10", p(small, Profile::Nv10), p(1.0, Profile::Nv10));
    int6.gives("1 + 2^-20 differs from 1 on Nv2a", p(small, Profile::Nv2a) != p(1.0, Profile::Nv2a), true);
    int6.gives("1 + 2^-15 as itself on Nv10", p(large, Profile::Nv10), p(large, Profile::Nv2a));
    int6.gives("1 + 2^-15 differs from 1", p(large, Profile::Nv10) != p(1.0, Profile::Nv10), true);
}

#[test]
fn examples_of_depth() {
    let triangle = of_the_section();
    let dep1 = example(
        "DEP-1",
        "z = (11184809, 11184809, 16777214) and E = (10598400, 10291200, 18432000): S = 39321600, R = 458129844 2^-54, d = 2, \
         and z = floor(13806249.21875) = 13806249, where the real number is 13806248.84. z = (0, 0, 960), and the triangle above: \
         pixel (10, 1) has E2/S = 1/64 and z = 14, where the real number is 15.",
    );
    let depth_of = |e, z| depth::word(DepthFormat::Z24S8, depth::interpolate(e, z));
    let (z, e) = ([11_184_809, 11_184_809, 16_777_214], [10_598_400, 10_291_200, 18_432_000]);
    dep1.gives("S", e.iter().sum::<i64>(), 39_321_600).gives(
        "R",
        ((1_u128 << 58) - 3 * 39_321_600) / (16 * 39_321_600),
        458_129_844,
    );
    dep1.gives("d", depth::largest_edge(e), 2).gives("z", depth_of(e, z.map(|z| z as f32)), 13_806_249);
    let real = z.iter().zip(e).map(|(z, e)| z * e).sum::<i64>() * 100 / 39_321_600;
    dep1.gives("100 times the real number, floored", real, 1_380_624_884);
    let row1 = at(&triangle, 10, 1);
    dep1.gives("64 E2", 64 * row1.e[2], triangle.doubled_area).gives(
        "z of (10, 1)",
        depth_of(row1.e, [0.0, 0.0, 960.0]),
        14,
    );

    let dep2 = example("DEP-2", "a clear to 0.5 stores floor(0.5 * 65535) = 32767 in Z16.");
    let text =
        "(version: 1, profile: Nv10, targets: [(width: 1, height: 1, depth: Z16, clear: (depth: 0.5))], draws: [])";
    let cleared = scene::parse(text, Path::new("test.ron"), &Limits::default()).unwrap_or_else(|e| panic!("{e}"));
    let plan = Plan::compile(&cleared.scene, &PlanOptions::default()).unwrap();
    dep2.gives("the stored depth", render(&plan, &RenderOptions::default()).surfaces[0].depth.clone(), vec![32_767]);
}

#[test]
fn examples_of_depth_words_ranges_and_offsets() {
    let dep3 = example(
        "DEP-3",
        "1.5 is 0x3fc00000 as binary32: 0x7f8000 in 24 bits, 0x7800 in 16; 2^-7 has exponent 0 there and is stored as 0, 600 as 0xffff.",
    );
    let word = |format, z: f32| depth::word(format, Binary::new(z));
    dep3.gives("1.5", 1.5_f32.to_bits(), 0x3fc0_0000).gives("24 bits", word(DepthFormat::Z24S8F, 1.5), 0x7f_8000);
    dep3.gives("16 bits", word(DepthFormat::Z16F, 1.5), 0x7800).gives("2^-7", word(DepthFormat::Z16F, 1.0 / 128.0), 0);
    dep3.gives("600", word(DepthFormat::Z16F, 600.0), 0xffff);

    let dep4 = example(
        "DEP-4",
        "range 100 to 200: 99.5 is dropped, or 100; 200 stays; z of 201, 202 and 250 drop a triangle.",
    );
    let range = |clamps| DepthRange { lowest: 100.0, highest: 200.0, clamps, drops_triangles: true };
    let ranged =
        |clamps, z: f32| depth::ranged(Some(&range(clamps)), Binary::new(z)).map(|z| depth::word(DepthFormat::Z16, z));
    dep4.gives("99.5", [ranged(false, 99.5), ranged(true, 99.5)], [None, Some(100)]).gives(
        "200",
        ranged(false, 200.0),
        Some(200),
    );
    let steps = DepthTest { vertex_depths: VertexDepths::Steps, ..DepthTest::new(CompareFunction::Less, true) };
    let test = DepthTest { range: Some(range(true)), ..steps };
    let whole = DepthPlane::new(&test, DepthFormat::Z16, &of_the_section(), ([201.0, 202.0, 250.0], [1.0; 3]));
    dep4.gives("the triangle", whole, None);

    let dep5 = example(
        "DEP-5",
        "z from 16572698 to 16809768 over 487.3125 rows: the slope 486.4845 becomes 486.4375, and factor 16 adds 7783 (real: 7783.75).",
    );
    let p = [
        [53.1875, -34.3125, 16_809_768.0, 1.0],
        [1808.6875, 453.0, 16_572_698.0, 1.0],
        [-1168.6875, 453.0, 16_572_698.0, 1.0],
    ];
    let triangle = Triangle::new(p, true, Profile::Nv2a).unwrap();
    let z = p.map(|p| p[2]);
    dep5.gives("the slope", depth::slope(&triangle, z), Binary { mantissa: 7783, exponent: -4 });
    let test = DepthTest { offset: PolygonOffset { bias: 0.0, factor: 16.0 }, ..steps };
    let plane = DepthPlane::new(&test, DepthFormat::Z24S8, &triangle, (z, [1.0; 3])).unwrap();
    dep5.gives("the offset", depth::word(DepthFormat::Z24S8, plane.offset), 7783);
}

#[test]
fn examples_of_w_buffers() {
    let rule = example("DEP-6", "w of 325, 325, 58 where the edge numbers are 408448, 51072, 51200: the word is 222.");
    let w = depth::interpolate_w([408_448, 51_072, 51_200], [325.0, 325.0, 58.0]);
    rule.gives("the word", depth::word(DepthFormat::Z16, w), 222);
}
