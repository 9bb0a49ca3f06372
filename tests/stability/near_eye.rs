//! w close to zero: `near-eye.ron`.

use super::chart::{Axis, BLUE, Line, RED, chart, ticks};
use super::page::{Section, cells};
use super::view::{draw, plan, scene};
use ninebit::raster::ideal;
use ninebit::raster::interpolate::Sample;
use ninebit::raster::setup::Triangle;
use ninebit::state::Profile;

/// Texels of the texture that the coordinates count in.
const SIDE: u32 = 64;

/// Largest errors over a triangle.
#[derive(Clone, Copy, Default)]
struct Errors {
    /// Of 256 times a weight, against the floor of the exact one.
    weight: i64,
    /// Of u, 1/256 texel, against the floor.
    inside: f64,
    /// The same on the edge that the near vertex does not touch.
    edge: f64,
}

pub fn section() -> Section {
    let near = |k: i32| errors([(-f64::from(k)).exp2(), 1.1, 1.3]);
    let both = |k: i32| errors([(-f64::from(k)).exp2(), 1.1, 1.3 * f64::from(k).exp2()]);
    let mut rows = vec![cells([
        "w of the three vertices",
        "weights, 1/256",
        "u inside, 1/256 texel",
        "u on the edge opposite the near vertex",
    ])];
    let row = |label: String, e: Errors| {
        vec![label, e.weight.to_string(), format!("{:.2}", e.inside), format!("{:.2}", e.edge)]
    };
    for k in [0, 8, 12, 16, 20] {
        rows.push(row(format!("2^-{k}, 1.1, 1.3"), near(k)));
    }
    for k in [4, 8, 12, 16, 20] {
        rows.push(row(format!("2^-{k}, 1.1, 1.3 x 2^{k}"), both(k)));
    }
    let over = |errors: &dyn Fn(i32) -> Errors| (0..=20).map(|k| [f64::from(k), log(errors(k).edge)]).collect::<Vec<_>>();
    let lines = [
        Line { label: "2^-k, 1.1, 1.3", color: BLUE, points: over(&near) },
        Line { label: "2^-k, 1.1, 1.3 x 2^k", color: RED, points: over(&both) },
    ];
    let x = Axis { label: "k", range: [0.0, 20.0], ticks: ticks(0, 20, 4, |k| k.to_string()) };
    let y = Axis {
        label: "u on the edge, 1/256 texel",
        range: [-16.0, 16.0],
        ticks: ticks(-16, 16, 4, |k| if k < 0 { format!("2^{k}") } else { (1_i64 << k).to_string() }),
    };
    Section {
        name: "near-eye",
        tables: vec![rows],
        pictures: vec![("near-eye.png", draw(&plan(&scene("near-eye.ron"))))],
        charts: vec![("near-eye.svg", chart(&x, &y, &lines, false))],
    }
}

fn log(error: f64) -> f64 {
    error.log2().clamp(-16.0, 16.0)
}

/// Over a triangle whose upper edge, opposite its first vertex, runs exactly through the centres of a row of pixels that belong to it.
fn errors(w: [f64; 3]) -> Errors {
    // The edge is a top edge: the near vertex lies below it.
    let corners = [[60.3, 121.7], [4.2, 8.5], [119.6, 8.5]];
    let w = w.map(|w| w as f32);
    let positions = std::array::from_fn(|k| [corners[k][0], corners[k][1], 0.0, w[k]]);
    let triangle = Triangle::new(positions, true, Profile::Nv2a).unwrap();
    let s = [0.5, 0.0, 1.0];
    let g = triangle.coordinate(s, SIDE);
    let mut worst = Errors::default();
    for j in triangle.rows.0..triangle.rows.1 {
        let (low, high) = triangle.span(j, (0, 128));
        for i in low..high {
            let e = triangle.edges(i, j);
            let sample = Sample::new(&triangle, e);
            let exact = ideal::barycentrics(&triangle, e, w, true);
            for (n, settled) in [0, 2].into_iter().zip(sample.weights()) {
                // Float64 does not see ties: half a step away from a whole number either floor is right.
                let error = settled.value as f64 - 256.0 * exact[n];
                worst.weight = worst.weight.max(beyond(error).ceil() as i64);
            }
            let u = sample.coordinate(&g).value as f64;
            let error = beyond(u - 256.0 * f64::from(SIDE) * ideal::mix(exact, s.map(f64::from)));
            let most = if e[0] == 0 { &mut worst.edge } else { &mut worst.inside };
            *most = most.max(error);
        }
    }
    worst
}

/// How far an integer lies from a floor: 0 where the real number is within the step above it.
fn beyond(error: f64) -> f64 {
    const ROUNDING: f64 = 1e-9;
    if error > ROUNDING { error } else { (-error - 1.0 - ROUNDING).max(0.0) }
}
