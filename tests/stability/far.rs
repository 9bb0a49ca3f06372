//! Coordinates far from the origin, drawn by `far-coordinates.ron`.

use super::chart::{line, lines};
use super::page::{Section, cells};
use super::view::{Covered, draw, plan, scene, visit};
use ninebit::plan::{Plan, PlanOptions};
use ninebit::raster::interpolate::COORDINATE_LIMIT;
use ninebit::state::Scene;
use ninebit::texture::coordinates::{Coordinates, SampleCoordinates, VertexCoordinates};
use ninebit_lab::chart::picture::{Axis, Drawing};

/// Exponent of the coordinate at which the first strip of a draw ends: strip n, from the top, ends at 2^(10 + n) texels.
const FIRST: usize = 10;

pub fn section() -> Section {
    let scene = scene("far-coordinates.ron");
    let plan_of_page = plan(&scene);
    // Largest error for each draw and strip.
    let mut worst = [[None; 11]; 3];
    visit(&plan_of_page, |covered| {
        let strip = (covered.pixel.1 as usize - 2) / 24;
        let (u, exact) = u(covered);
        if FIRST + strip > 16 {
            assert_eq!(u, COORDINATE_LIMIT, "through q beyond the limit");
        }
        let error = (u - exact).abs();
        let most = &mut worst[covered.draw][strip];
        *most = Some(most.unwrap_or(0).max(error));
    });
    let mut rows =
        vec![cells(["texels from the origin", "q = 1, equal w", "q = 1, in perspective", "through q, in perspective"])];
    let shown = |error: Option<i64>, k: usize| match error {
        None => "refused (RAS-0)".to_string(),
        Some(_) if k > 16 => "held at 65536".to_string(),
        Some(error) => error.to_string(),
    };
    for k in FIRST..=20 {
        let cells = (0..3).map(|draw| shown(worst[draw][k - FIRST], k));
        rows.push([format!("2^{k}")].into_iter().chain(cells).collect());
    }
    refused(&scene);

    let names = ["q = 1, equal w", "q = 1, in perspective", "through q, in perspective"];
    let near = 16 - FIRST;
    assert_eq!(worst[1][..=near], worst[2][..=near], "one line stands for both");
    let series = [(0, "equal w"), (1, "in perspective, through q or not")].map(|(draw, name)| {
        let points = (FIRST..=16).filter_map(|k| Some([f64::from(1_u32 << k), worst[draw][k - FIRST]? as f64]));
        line(draw, name, points.collect())
    });
    let chart = Drawing {
        title: "Coordinates lose their last bits far from the origin".to_string(),
        x: Axis::logarithmic("texels from the origin", [1024.0, 65536.0].into_iter()),
        y: Axis::linear("largest error of u, 1/256 texel", [0.0, 4.0].into_iter(), true),
        ..lines(series.into())
    };
    let frame = draw(&plan_of_page);
    let third = frame.width / 3;
    let strips = names.iter().enumerate().map(|(n, name)| frame.part(n * third, 0, third, frame.height).tile(*name));
    let strips = strips.collect();
    Section {
        name: "far",
        tables: vec![rows],
        pictures: vec![("far-coordinates.svg", vec![strips])],
        charts: vec![("far-errors.svg", chart)],
    }
}

/// Returns u of the model and the floor of the exact rational number, both in 1/256 texel.
fn u(covered: &Covered<'_>) -> (i64, i64) {
    let (sample, coordinates) = (covered.sample(), Coordinates::new(covered.coordinates(), covered.unit));
    let place = VertexCoordinates {
        unit: covered.unit,
        coordinates: &coordinates,
        at: &sample,
        pixel: covered.pixel,
        vertices: covered.vertices,
        perspective: true,
    };
    let u = place.on(&covered.unit.levels[0])[0];
    // All values are converted to whole numbers: w, s and q of the scene are multiples of 2^-23, 2^-5 and 2^-5.
    let whole = |value: f32, bits: i32| (f64::from(value) * f64::from(bits).exp2()) as i128;
    let w = covered.w().map(|w| whole(w, 23));
    let [s, q] = [0, 3].map(|n| covered.coordinates().map(|c| whole(c[n], 5)));
    let sum = |values: [i128; 3]| -> i128 {
        (0..3).map(|k| values[k] * i128::from(sample.e[k]) * w[(k + 1) % 3] * w[(k + 2) % 3]).sum()
    };
    let exact = (sum(s) * 256 * 16).div_euclid(sum(q));
    (u, exact as i64)
}

/// RAS-0: coordinates beyond 65536 texels are refused if q is 1, but not for other q.
fn refused(scene: &Scene) {
    let mut scene = scene.clone();
    scene.draws.truncate(1);
    let mut rules = |texels: f32, q: f32| -> Vec<&'static str> {
        scene.draws[0].vertices.update(|index, vertex| {
            let far = &mut vertex.texture_coordinates[0];
            if index == 0 {
                (far[0], far[3]) = (texels / 16.0, q);
            }
        });
        let planned = Plan::compile(&scene, &PlanOptions::default());
        planned.err().into_iter().flatten().filter_map(|error| error.rule).collect()
    };
    assert!(rules(65536.0, 1.0).is_empty());
    for texels in [65537, 1 << 17, 1 << 18, 1 << 19, 1 << 20] {
        assert_eq!(rules(texels as f32, 1.0), ["RAS-0"]);
        assert!(rules(texels as f32, 2.0).is_empty());
    }
}
