//! Examples of fog and of the section "Vertex side".

use crate::handbook::example;
use crate::interpolation::{at, of_the_section};
use ninebit::number::convert::factor_byte;
use ninebit::number::light;
use ninebit::raster::fog::{EXPONENTIAL, FogPlane, FogStep, SQUARED};
use ninebit::state::{FogFunction, FogMode, Profile};
use ninebit::vertex::fog::{LightFog, passed};
use ninebit::vertex::texgen::{CoordinateSet, Generator, StageTransform};
use ninebit::vertex::{EyeVertex, ModelView, ObjectVertex, Rows, Viewer};

#[test]
fn examples_of_fog() {
    let triangle = of_the_section();
    let sample = at(&triangle, 10, 2);
    let word = |f: f32| light::word(f.to_bits());
    let fog1 = example(
        "FOG-1",
        "0x3FB51EB5 becomes 0x3FB52000; in 0x3FBFFFFC bits 10 to 17 are ones, so it becomes 0x3FBFFC00.",
    );
    fog1.gives("the first", light::word(0x3FB5_1EB5), 0x3FB5_2000).gives(
        "the second",
        light::word(0x3FBF_FFFC),
        0x3FBF_FC00,
    );
    fog1.gives("the ones", 0x3FBF_FFFC >> 10 & 255, 255);

    let fog2 = example(
        "FOG-2",
        "d = (0, 4, 2) at the vertices, c0 = 2, c1 = -1/4, pixel (10, 2): d' = 4 * 11.75/96 = 0.48958, 4096 f = 3594.67, v = \
         3594, the byte is (3594 - 14) >> 4 = 223 (real: 223.79).",
    );
    let d = 4.0 * 11.75 / 96.0_f64;
    let function = |mode, p0| FogFunction { mode, p0, p1: -0.25, p2: 0.0, per_vertex: false };
    let found = |mode, p0, d: [f32; 3]| {
        let function = function(mode, p0);
        let vertices = d.map(|d| passed(&function, Profile::Nv2a, d));
        FogPlane::new(&triangle, Some(function), vertices).at(&sample)
    };
    let linear = found(FogMode::Linear, 2.0, [0.0, 4.0, 2.0]);
    let FogStep::Linear(v, _) = linear.from else { panic!("linear") };
    fog2.shows("d'", d, 5, "0.48958").shows("4096 f", 4096.0 * (1.0 - d / 4.0), 2, "3594.67");
    fog2.gives("v", v, 3594).gives("the byte", linear.byte, 223);
    fog2.shows("the real number", 255.0 * (1.0 - d / 4.0), 2, "223.79");

    let fog3 = example(
        "FOG-3",
        "c0 = 3/2, c1 = 0xBB13BB3C, d = 56: c1 becomes 0xBB13BC00, q1 = 0xBE014400, e = 0x3FAFD400 = 11253/8192. d = 3: q1 = \
         0xBBDD9800, e = 12232/8192.",
    );
    let slope =
        FogFunction { mode: FogMode::Exp, p0: 1.5, p1: f32::from_bits(0xBB13_BB3C), p2: 0.0, per_vertex: false };
    let (far, near) = (LightFog::new(&slope, 56.0), LightFog::new(&slope, 3.0));
    fog3.gives("c1", far.parameters[1], 0xBB13_BC00).gives("q1", far.products[0], 0xBE01_4400);
    fog3.gives("e", far.sum, 0x3FAF_D400).gives("its value", f32::from_bits(far.sum), 11253.0 / 8192.0);
    fog3.gives("q1 of 3", near.products[0], 0xBBDD_9800);
    fog3.gives("e of 3", f32::from_bits(near.sum), 12232.0 / 8192.0);
    fog3.gives("what is passed", passed(&slope, Profile::Nv2a, 56.0).to_bits(), far.sum);

    let fog4 = example(
        "FOG-4",
        "d = (0, 4, 2) at the vertices, c0 = 3/2, c1 = -1/4, pixel (10, 2): e = 1.37760, 4096 (e - 3/2) = -501.33, q = -502, i = \
         7, w = 54. Exp: (76 * 10 + 64 * 54 + 32) >> 6 = 66 (real: 65.62). Exp2: (196 * 10 + 180 * 54 + 32) >> 6 = 183 (real: \
         182.91).",
    );
    let (exp, exp2) = (found(FogMode::Exp, 1.5, [0.0, 4.0, 2.0]), found(FogMode::Exp2, 1.5, [0.0, 4.0, 2.0]));
    let FogStep::Exponential(q) = exp.from else { panic!("exponential") };
    fog4.shows("e", 1.5 - d / 4.0, 5, "1.37760").shows("4096 (e - 3/2)", -1024.0 * d, 2, "-501.33");
    fog4.gives("q", q.value, -502).gives("i and w", (502 >> 6, 502 & 63), (7, 54));
    fog4.gives("entries", (EXPONENTIAL[7], EXPONENTIAL[8], SQUARED[7], SQUARED[8]), (76, 64, 196, 180));
    fog4.gives("Exp", exp.byte, 66).gives("Exp2", exp2.byte, 183);
    fog4.shows("real Exp", 255.0 * (-4.0 * d).exp2(), 2, "65.62");
    fog4.shows("real Exp2", 255.0 * (-2.0 * d * d).exp2(), 2, "182.91");

    let fog5 = example("FOG-5", "with d = infinity at a vertex Linear and Exp give 255, Exp2, ExpAbs and Exp2Abs 0.");
    let beyond = |mode| found(mode, 1.5, [0.0, f32::INFINITY, 2.0]).byte;
    fog5.gives("Linear and Exp", [FogMode::Linear, FogMode::Exp].map(beyond), [255; 2]);
    fog5.gives("the others", [FogMode::Exp2, FogMode::ExpAbs, FogMode::Exp2Abs].map(beyond), [0; 3]);

    let int5n = example(
        "INT-5n",
        "factors (0, 1, 0.5), pixel (10, 2): 4096 (10.5 + 1.25)/96 = 501.33, v = 501, the byte is (501 - 1) >> 4 = 31 \
         (real: 31.21). c0 = 3/2 and c1 = -1/4 at d = 0.7: e = 0x3FA99800, which nv10 passes as 0x3FA99C00.",
    );
    let v = sample.factor(&triangle.factor([0.0, 1.0, 0.5]));
    int5n.shows("4096 f", 4096.0 * 11.75 / 96.0, 2, "501.33").gives("v", v, 501);
    int5n.gives("the byte", factor_byte(v), 31).shows("the real number", 255.0 * 11.75 / 96.0, 2, "31.21");
    let e = FogFunction { per_vertex: true, ..function(FogMode::Linear, 1.5) };
    int5n.gives("c1", word(e.p1), e.p1.to_bits());
    int5n.gives("e", LightFog::new(&e, 0.7).sum, 0x3FA9_9800);
    int5n.gives("what nv10 passes", passed(&e, Profile::Nv10, 0.7).to_bits(), 0x3FA9_9C00);
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
