//! Computes the examples of the sections "Interpolation" and "Depth".

use crate::handbook::{beside_rows, read};
use ninebit::engine::{RenderOptions, render};
use ninebit::limits::Limits;
use ninebit::plan::{Plan, PlanOptions};
use ninebit::raster::depth::{self, DepthPlane};
use ninebit::raster::interpolate::Sample;
use ninebit::raster::setup::Triangle;
use ninebit::state::{CompareFunction, DepthFormat, DepthTest, PolygonOffset, Profile, VertexDepths};
use ninebit_oracle::real::Number;
use ninebit_oracle::weights;
use ninebit_scene as scene;
use std::path::Path;

/// Returns the triangle (0, 0), (side, 0), (0, side) in pixels, with the given w.
fn right_triangle(side: f32, w: [f32; 3], profile: Profile) -> Triangle {
    let corners = [[0.0, 0.0, 0.0, w[0]], [side, 0.0, 0.0, w[1]], [0.0, side, 0.0, w[2]]];
    Triangle::new(corners, true, profile).unwrap()
}

/// Returns the triangle that the section uses, with sides of 96 pixels and w = 1.
pub fn of_the_section() -> Triangle {
    right_triangle(96.0, [1.0; 3], Profile::Nv2a)
}

pub fn at(triangle: &Triangle, i: i64, j: i64) -> Sample<'_> {
    Sample::new(triangle, triangle.edges(i, j))
}

#[test]
fn examples_of_interpolation() {
    let text = "The examples of this section use one triangle: (0, 0), (96, 0), (0, 96) in pixels, w = 1.";
    assert!(read("docs/rules/arithmetic.md").contains(text), "the handbook uses another triangle");
    let triangle = of_the_section();
    assert_eq!(triangle.doubled_area, 1536 * 1536);

    let wgt1 = beside_rows("WGT-1");
    // Returns a number in units of 2^e.
    let over = |n: Number, e: i32| n.real() / 2_f64.powi(e);
    let edges = [2_064_384, 258_048, 36_864];
    wgt1.gives("E", triangle.edges(10, 1).map(i128::from), edges);
    let numbers = weights::edge_numbers(edges, None);
    let r = weights::reciprocal(weights::sum(numbers, 29));
    wgt1.gives("S", over(weights::sum(numbers, 29), 0), 2_359_296.0).gives("R", over(r, -50), 477_218_587.0);
    wgt1.gives("d", weights::dominant(weights::shares(numbers, r)), 0);
    let b = weights::weights(edges, None).unwrap();
    wgt1.gives("b_0", over(b[0], -24), 14_680_065.0).gives("b_1", over(b[1], -27), 14_680_063.0);
    wgt1.gives("b_2", over(b[2], -30), 16_777_215.0).gives("colours", weights::colour_weights(b), [224, 29, 3]);
    let at_64 = |s: [f32; 3]| weights::linear(s, b).times(Number::of(64.0 * 256.0)).real();
    wgt1.gives("s = (0, 0, 1)", at_64([0.0, 0.0, 1.0]), 256.0 - 2_f64.powi(-16));
    wgt1.gives("s = (0, 1, 0)", at_64([0.0, 1.0, 0.0]), 1792.0 + 2_f64.powi(-9));
    let deep = weights::weights([768; 3], Some([1.0, 1.0, 2.0].map(Number::of))).unwrap();
    let [b0, b1, b2] = deep;
    let deep = [over(b0, -24), over(b1, -23), over(b2, -24)];
    wgt1.gives("in perspective", deep, [6_710_887.0, 3_355_443.0, 3_355_443.0]);
    let quad = weights::weights([4_063_232, 131_072, 0], None).unwrap();
    let term = f64::from(0.9_f32 - 1.1_f32) * quad[0].real();
    wgt1.gives("b_0 of the quad", over(quad[0], -5), 31.0).shows("the term", term, 11, "-0.19375004619");
    wgt1.shows("the term that is cut", (term * 2_f64.powi(23)).trunc() / 2_f64.powi(23), 11, "-0.19375002384");
    let real = 256.0 * (f64::from(0.9_f32) * 31.0 + f64::from(1.1_f32)) / 32.0;
    wgt1.shows("the real number", real, 7, "231.9999943");

    let int2 = beside_rows("INT-2");
    int2.gives("the second weight", 256 - 76 - 51, 129).gives("the products", [255 * 76, 128 * 51], [19_380, 6528]);
    int2.shows("the real number", 0.3 * 255.0 + 0.2 * 128.0, 1, "102.1");

    let int4 = beside_rows("INT-4");
    int4.shows("the real number", 16_384.0 * 2.5 / 96.0, 2, "426.67").gives("the part", 426 & 255, 170);

    let int6 = beside_rows("INT-6");
    let p = |w: f32, profile| at(&right_triangle(96.0, [w, 1.0, 1.0], profile), 10, 1).weights().b;
    let (small, large) = (1.0 + 2_f32.powi(-20), 1.0 + 2_f32.powi(-15));
    int6.gives("1 + 2^-20 counts as 1 on Nv10", p(small, Profile::Nv10), p(1.0, Profile::Nv10));
    int6.gives("1 + 2^-20 differs from 1 on Nv2a", p(small, Profile::Nv2a) != p(1.0, Profile::Nv2a), true);
    int6.gives("1 + 2^-15 as itself on Nv10", p(large, Profile::Nv10), p(large, Profile::Nv2a));
    int6.gives("1 + 2^-15 differs from 1", p(large, Profile::Nv10) != p(1.0, Profile::Nv10), true);
}

#[test]
fn examples_of_depth() {
    let triangle = of_the_section();
    let dep1 = beside_rows("DEP-1");
    let (z, e) = ([11_184_809, 11_184_809, 16_777_214], [10_598_400, 10_291_200, 18_432_000]);
    dep1.gives("S", e.iter().sum::<i64>(), 39_321_600).gives(
        "R",
        ((1_u128 << 58) - 3 * 39_321_600) / (16 * 39_321_600),
        458_129_844,
    );
    dep1.gives("d", depth::largest_edge(e), 2);
    let real = z.iter().zip(e).map(|(z, e)| z * e).sum::<i64>() * 100 / 39_321_600;
    dep1.gives("100 times the real number, floored", real, 1_380_624_884);
    let row1 = at(&triangle, 10, 1);
    dep1.gives("64 E2", 64 * row1.e[2], triangle.doubled_area);

    let dep2 = beside_rows("DEP-2");
    let text =
        "(version: 1, profile: Nv10, targets: [(width: 1, height: 1, depth: Z16, clear: (depth: 0.5))], draws: [])";
    let cleared = scene::parse(text, Path::new("test.ron"), &Limits::default()).unwrap_or_else(|e| panic!("{e}"));
    let plan = Plan::compile(&cleared.scene, &PlanOptions::default()).unwrap();
    dep2.gives("the stored depth", render(&plan, &RenderOptions::default()).surfaces[0].depth.clone(), vec![32_767]);
}

#[test]
fn examples_of_depth_words_ranges_and_offsets() {
    beside_rows("DEP-3").gives("1.5", 1.5_f32.to_bits(), 0x3fc0_0000);

    let dep5 = beside_rows("DEP-5");
    let p = [[200.0, 0.0, 16_716_070.0, 1.0], [500.0, 487.3125, 16_479_000.0, 1.0], [0.0, 487.3125, 16_479_000.0, 1.0]];
    let triangle = Triangle::new(p, true, Profile::Nv2a).unwrap();
    let z = p.map(|p| p[2]);
    let real = f64::from(z[0] - z[1]) / 487.3125;
    dep5.shows("the real slope", real, 4, "486.4845").shows("16 times that", 16.0 * real, 2, "7783.75");
    dep5.gives("32nds", 15_567.0 / 32.0, 486.46875).gives("the rows", 0x00fe_7091 - 0x00fe_522a, 7783);
    let steps = DepthTest { vertex_depths: VertexDepths::Steps, ..DepthTest::new(CompareFunction::Less, true) };
    let test = DepthTest { offset: PolygonOffset { bias: 0.0, factor: 16.0 }, ..steps };
    let plane = DepthPlane::new(&test, DepthFormat::Z24S8, &triangle, (z, None)).unwrap();
    dep5.gives("the offset", depth::word(DepthFormat::Z24S8, plane.offset), 7783);
}
