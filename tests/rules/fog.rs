//! Examples of fog and of the section "Vertex side".

use crate::handbook::example;
use crate::interpolation::{at, of_the_section};
use ninebit::number::convert::factor_byte;
use ninebit::raster::fog::FogPlane;
use ninebit::state::{FogFunction, FogMode, Profile};
use ninebit::vertex::fog::vertex_factor;
use ninebit::vertex::texgen::{CoordinateSet, Generator, StageTransform};
use ninebit::vertex::{EyeVertex, ModelView, ObjectVertex, Rows, Viewer};

#[test]
fn examples_of_fog() {
    let triangle = of_the_section();
    let sample = at(&triangle, 10, 2);
    let int5 = example(
        "INT-5",
        "d = (0, 4, 2) at the vertices, p1 = -1/4, pixel (10, 2): d = 4 * 11.75/96 = 0.48958. Linear with p0 = 2: 4096 f = \
         3594.67, v = 3594, the byte is (3594 - 14) >> 4 = 223 (real: 223.79). With p0 = 3/2: Exp v = 1054 (1054.005), Exp2 \
         v = 2937 (2937.995).",
    );
    let d = 4.0 * 11.75 / 96.0_f64;
    let v = |mode, p0| {
        let function = FogFunction { mode, p0, p1: -0.25 };
        FogPlane::new(&triangle, Some(function), [0.0, 4.0, 2.0]).at(&sample).value
    };
    int5.shows("d", d, 5, "0.48958").shows("4096 f", 4096.0 * (1.0 - d / 4.0), 2, "3594.67");
    int5.gives("v", v(FogMode::Linear, 2.0), 3594).gives("the byte", factor_byte(3594), 223);
    int5.shows("the real number", 255.0 * (1.0 - d / 4.0), 2, "223.79");
    int5.gives("Exp", v(FogMode::Exp, 1.5), 1054).shows("4096 e", 4096.0 * (-4.0 * d).exp2(), 3, "1054.005");
    int5.gives("Exp2", v(FogMode::Exp2, 1.5), 2937).shows("4096 e2", 4096.0 * (-2.0 * d * d).exp2(), 3, "2937.995");

    let int5n = example(
        "INT-5n",
        "factors (0, 1, 0.5), pixel (10, 2): 4096 (10.5 + 1.25)/96 = 501.33, v = 501, the byte is (501 - 1) >> 4 = 31 \
         (real: 31.21). Exp with p0 = 3/2 and p1 = -1/4 at d = 0.3: 2^-1.2 = 0.43528 is cut to 7131/16384.",
    );
    let v = sample.factor(&triangle.factor([0.0, 1.0, 0.5]));
    int5n.shows("4096 f", 4096.0 * 11.75 / 96.0, 2, "501.33").gives("v", v, 501);
    int5n.gives("the byte", factor_byte(v), 31).shows("the real number", 255.0 * 11.75 / 96.0, 2, "31.21");
    let cut = vertex_factor(&FogFunction { mode: FogMode::Exp, p0: 1.5, p1: -0.25 }, 0.3);
    int5n.shows("2^-1.2", (-1.2_f64).exp2(), 5, "0.43528").gives("the factor", cut, 7131.0 / 16384.0);
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
