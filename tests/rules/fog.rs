//! Computes the examples of fog and of the section "Vertex side".

use crate::handbook::{beside_rows, example};
use crate::interpolation::{at, of_the_section};
use ninebit::number::convert::factor_byte;
use ninebit::raster::fog::{EXPONENTIAL, FogPlane, FogStep, SQUARED};
use ninebit::state::{FogFunction, FogMode, Profile};
use ninebit::vertex::fog::passed;
use ninebit::vertex::texgen::{CoordinateSet, Generator, StageTransform};
use ninebit::vertex::{EyeVertex, ModelView, ObjectVertex, Rows, Viewer};

#[test]
fn examples_of_fog() {
    let triangle = of_the_section();
    let sample = at(&triangle, 10, 2);
    beside_rows("FOG-1").gives("the ones", 0x3FBF_FFFC >> 10 & 255, 255);

    let fog2 = beside_rows("FOG-2");
    let d = 4.0 * 11.75 / 96.0_f64;
    let found = |mode, p0, d: [f32; 3]| {
        let function = FogFunction { mode, p0, p1: -0.25, p2: 0.0, per_vertex: false };
        let vertices = d.map(|d| passed(&function, Profile::Nv2a, d));
        FogPlane::new(Some(function), vertices).at(&sample)
    };
    let linear = found(FogMode::Linear, 2.0, [0.0, 4.0, 2.0]);
    let FogStep::Linear(v, _) = linear.from else { panic!("linear") };
    fog2.shows("d'", d, 5, "0.48958").shows("4096 f", 4096.0 * (1.0 - d / 4.0), 2, "3594.67");
    fog2.gives("v", v, 3594).gives("the byte", linear.byte, 223);
    fog2.shows("the real number", 255.0 * (1.0 - d / 4.0), 2, "223.79");

    beside_rows("FOG-3").gives("the value of e", f32::from_bits(0x3FAF_D400), 11253.0 / 8192.0);

    let fog4 = beside_rows("FOG-4");
    let exp = found(FogMode::Exp, 1.5, [0.0, 4.0, 2.0]);
    let FogStep::Exponential(q) = exp.from else { panic!("exponential") };
    fog4.shows("e", 1.5 - d / 4.0, 5, "1.37760").shows("4096 (e - 3/2)", -1024.0 * d, 2, "-501.33");
    fog4.gives("q", q, -502).gives("i and w", (502 >> 6, 502 & 63), (7, 54));
    fog4.gives("entries", (EXPONENTIAL[7], EXPONENTIAL[8], SQUARED[7], SQUARED[8]), (76, 64, 196, 180));
    fog4.shows("real Exp", 255.0 * (-4.0 * d).exp2(), 2, "65.62");
    fog4.shows("real Exp2", 255.0 * (-2.0 * d * d).exp2(), 2, "182.91");

    let fog5 = beside_rows("FOG-5");
    let beyond = |mode| found(mode, 1.5, [0.0, f32::INFINITY, 2.0]).byte;
    fog5.gives("Linear and Exp", [FogMode::Linear, FogMode::Exp].map(beyond), [255; 2]);
    fog5.gives("the others", [FogMode::Exp2, FogMode::ExpAbs, FogMode::Exp2Abs].map(beyond), [0; 3]);

    let int5n = beside_rows("INT-5n");
    let v = ninebit::raster::fog::factor(sample.value(&ninebit::raster::weights::Linear::new([0.0, 1.0, 0.5])));
    int5n.shows("4096 f", 4096.0 * 11.75 / 96.0, 2, "501.33").gives("v", v, 501);
    int5n.gives("the byte", factor_byte(v), 31).shows("the real number", 255.0 * 11.75 / 96.0, 2, "31.21");
}

#[test]
fn examples_of_the_vertex_side() {
    let tsh11 = example(
        "TSH-11",
        "p' = (0, 3, -4, 1): without a normal r = (0, 0.6, -0.8); with n = (0, 0, 1) r = (0, 0.6, 0.8), m = 3.795, the sphere \
         map is (0.5, 0.658). M with rows (2, 0, 0, 1) and (1, 0, 0, 1) for s and q takes (3, 4, 5, 6) to s' = 12 and q' = 9, \
         on nv10 q' = 18. With an infinite viewer r = (0, 0, 1). With COUNT3 and PROJECTED that M takes (3, 4), then (3, 4, 1, 0), \
         to (6, 4, 1, 1).",
    );
    const IDENTITY: Rows = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]];
    let view = ModelView::new(&IDENTITY);
    let object =
        |normal| ObjectVertex { position: [0.0, 3.0, -4.0, 1.0], normal, fog_coordinate: 0.0, dimensions: [2; 4] };
    let (bare, facing) = (object([0.0; 3]), object([0.0, 0.0, 1.0]));
    let tenths = |r: [f32; 3]| r.map(|c| (10.0 * c).round());
    tsh11.gives(
        "r without a normal",
        tenths(EyeVertex::new(&bare, &view, Viewer::Local).reflection()),
        [0.0, 6.0, -8.0],
    );
    let vertex = EyeVertex::new(&facing, &view, Viewer::Local);
    tsh11.gives("r", tenths(vertex.reflection()), [0.0, 6.0, 8.0]);
    tsh11.shows("m", 2.0 * (0.36_f64 + 1.8 * 1.8).sqrt(), 3, "3.795");
    let given = [[3.0, 4.0, 5.0, 6.0]; 4];
    let sphere = CoordinateSet { generators: [Some(Generator::SphereMap); 4], ..CoordinateSet::given(0) };
    let [s, t, ..] = sphere.at(&vertex, &given, Profile::Nv2a);
    tsh11.gives("s of the sphere map", s, 0.5).shows("t of the sphere map", f64::from(t), 3, "0.658");
    let rows = [[2.0, 0.0, 0.0, 1.0], IDENTITY[1], IDENTITY[2], [1.0, 0.0, 0.0, 1.0]];
    let moved = CoordinateSet { matrix: Some(rows), ..CoordinateSet::given(0) };
    tsh11.gives("M t", moved.at(&vertex, &given, Profile::Nv2a), [12.0, 4.0, 5.0, 9.0]);
    tsh11.gives("M t on nv10", moved.at(&vertex, &given, Profile::Nv10), [12.0, 4.0, 5.0, 18.0]);
    let far = EyeVertex::new(&facing, &view, Viewer::FAR);
    tsh11.gives("r from far away", tenths(far.reflection()), [0.0, 0.0, 10.0]);
    let transform = Some(StageTransform { count: 3, projected: true });
    let projected = CoordinateSet { transform, ..moved };
    tsh11.gives("COUNT3, PROJECTED", projected.at(&vertex, &given, Profile::Nv2a), [6.0, 4.0, 1.0, 1.0]);
}
