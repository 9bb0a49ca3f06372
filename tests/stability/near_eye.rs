//! Vertices with w close to zero, drawn by `near-eye.ron`.

use super::page::{Section, cells};
use super::view::{draw, plan, scene};
use ninebit::plan::{Plan, PlanOptions};
use ninebit::random::Random;
use ninebit::raster::ideal;
use ninebit::raster::interpolate::{Sample, coordinate};
use ninebit::raster::project::ClipPlane;
use ninebit::raster::setup::Triangle;
use ninebit::raster::weights::Linear;
use ninebit::state::{Profile, Scene};

/// Width of the texture to which the coordinates refer, in texels.
const SIDE: u32 = 64;

/// Largest errors of the samples of a triangle.
#[derive(Clone, Copy, Default)]
struct Errors {
    /// Error of a weight in 256ths, with respect to the floor of the exact one.
    weight: f64,
    /// Error of u in 1/256 texel, with respect to the floor of the exact one.
    u: f64,
}

pub fn section() -> Section {
    let scene = scene("near-eye.ron");
    floor_below_the_eye_is_cut_off(&scene);
    let near = |k: i32| [(-f64::from(k)).exp2(), 1.1, 1.3];
    let both = |k: i32| [(-f64::from(k)).exp2(), 1.1, 1.3 * f64::from(k).exp2()];
    let mut rows = vec![cells([
        "w of the three vertices",
        "inside: weights, 1/256",
        "u, 1/256 texel",
        "on the edge: weights, 1/256",
        "u, 1/256 texel",
    ])];
    let row = |label: String, w: [f64; 3]| {
        let ([inside, _], [_, edge]) = (slanted(w), errors(EDGE, w));
        let numbers = [inside.weight, inside.u, edge.weight, edge.u].map(|error| format!("{error:.4}"));
        [vec![label], numbers.to_vec()].concat()
    };
    for k in [0, 8, 12, 16, 20] {
        rows.push(row(format!("2^-{k}, 1.1, 1.3"), near(k)));
    }
    for k in [4, 8, 12, 16, 20] {
        rows.push(row(format!("2^-{k}, 1.1, 1.3 x 2^{k}"), both(k)));
    }
    let frame = draw(&plan(&scene));
    let side = frame.width / 7;
    let triangle = |n: usize, name: String| frame.part(n * side, 0, side, frame.height).tile(name);
    let mut triangles: Vec<_> = [0, 1, 5].map(|n| triangle(n, format!("w = 2^-{}", 4 * n))).into();
    triangles.push(triangle(6, "behind the eye".to_string()));
    Section { name: "near-eye", tables: vec![rows], pictures: vec![("near-eye.svg", vec![triangles])], charts: vec![] }
}

/// RAS-6: a triangle that is cut at w = 2^-20 reaches far outside the window there, so the guard band cuts it as well.
fn floor_below_the_eye_is_cut_off(scene: &Scene) {
    let mut scene = scene.clone();
    scene.draws[1].vertices.update(|index, vertex| {
        if index == 0 {
            vertex.position = [0.0, -1.0, 0.0, -1.0];
        }
    });
    let plan = Plan::compile(&scene, &PlanOptions::default()).unwrap();
    let planes: Vec<ClipPlane> = ClipPlane::in_set(plan.draws()[1].assembly.clipping.planes).collect();
    assert!(planes.first() == Some(&ClipPlane::W) && planes.contains(&ClipPlane::Bottom), "{planes:?}");
}

/// A triangle whose upper edge, opposite to its first vertex, passes exactly through the centres of a row of pixels that it covers.
const EDGE: [[f32; 2]; 3] = [[60.3, 121.7], [4.2, 8.5], [119.6, 8.5]];

/// Returns the largest errors of a hundred triangles with slanted edges, as [`errors`] does.
fn slanted(w: [f64; 3]) -> [Errors; 2] {
    let mut random = Random::seeded(1);
    let mut next = || random.below(2048) as f32 / 16.0;
    let mut worst = [Errors::default(); 2];
    for _ in 0..100 {
        let corners = std::array::from_fn(|_| [next(), next()]);
        for (most, error) in worst.iter_mut().zip(errors(corners, w)) {
            (most.weight, most.u) = (most.weight.max(error.weight), most.u.max(error.u));
        }
    }
    worst
}

/// Returns the largest errors inside a triangle, and on the edge opposite to its first vertex.
fn errors(corners: [[f32; 2]; 3], w: [f64; 3]) -> [Errors; 2] {
    let w = w.map(|w| w as f32);
    let positions = std::array::from_fn(|k| [corners[k][0], corners[k][1], 0.0, w[k]]);
    let mut worst = [Errors::default(); 2];
    let Some(triangle) = Triangle::new(positions, true, Profile::Nv2a) else { return worst };
    let s = [0.5, 0.0, 1.0];
    let f = Linear::new(s);
    for j in triangle.rows.0..triangle.rows.1 {
        let (low, high) = triangle.span(j, (0, 128));
        for i in low..high {
            let e = triangle.edges(i, j);
            let sample = Sample::new(&triangle, e);
            let exact = ideal::barycentrics(&triangle, e, w, true);
            let most = &mut worst[usize::from(e[0] == 0)];
            for (n, floored) in [0, 2].into_iter().zip(sample.color_weights()) {
                most.weight = most.weight.max(beyond(floored, 256.0 * exact[n]));
            }
            let u = 256.0 * f64::from(SIDE) * ideal::mix(exact, s.map(f64::from));
            most.u = most.u.max(beyond(coordinate(sample.value(&f), SIDE.into()), u));
        }
    }
    worst
}

/// Returns how far an integer is from being the floor of a real number: 0 if the real number lies within the step above it.
fn beyond(floored: i64, exact: f64) -> f64 {
    const ROUNDING: f64 = 1e-9;
    let error = floored as f64 - exact;
    if error > ROUNDING { error } else { (-error - 1.0 - ROUNDING).max(0.0) }
}
