//! Planes hold what traces say.

#![allow(clippy::unwrap_used, missing_docs, unreachable_pub, reason = "a test binary")]

use std::collections::BTreeMap;

use crate::repository::at;
use crate::scene_files;

use ninebit::engine::{Plane, PlaneOptions, plane_names, planes, trace};
use ninebit::limits::Limits;
use ninebit::plan::Plan;
use ninebit::state::Rectangle;
use ninebit::trace::Step;
use ninebit_report::planes::{PlanesError, plane_arrays};
use ninebit_scene as scene;

fn options(rectangle: Option<Rectangle>) -> PlaneOptions {
    PlaneOptions { rectangle, ideal: true, threads: 1, ..PlaneOptions::default() }
}

/// Returns the last step of each name among the stored fragments of a pixel, but those of draws that change nothing.
fn traced(plan: &Plan, pixel: (u32, u32)) -> BTreeMap<String, Step> {
    let trace = trace(plan, 0, pixel, None).expect("inside");
    let changes = |draw: usize| plan.draws()[draw].folded.invisible.is_none();
    let stored = trace.draws.into_iter().filter(|fragment| fragment.stored && changes(fragment.draw));
    stored.flat_map(|fragment| fragment.steps).map(|step| (step.name.clone(), step)).collect()
}

fn complaint(name: &str, plane: &Plane, step: &Step) -> Option<String> {
    let (value, unit, ideal) = (plane.values[0], plane.unit(0), plane.ideals[0]);
    let same = match step.ideal {
        Some(expected) => ideal == expected || ideal.is_nan() && expected.is_nan(),
        None => ideal.is_nan(),
    };
    (value != step.value || unit != Some(step.unit()) || !same)
        .then(|| format!("{name}: {value} {unit:?} {ideal}, the trace says {step:?}"))
}

/// Every name that the trace of a pixel has, of all scenes: all at once, and each alone, when most steps are not described.
#[test]
fn planes_hold_what_traces_say() {
    let mut names_seen = 0;
    for path in scene_files::below(&at("vectors/scenes")) {
        let plan = scene::load(&path, &Limits::default()).unwrap().plan;
        let target = &plan.targets()[0];
        let (x, y) = (target.width * 5 / 9, target.height * 4 / 7);
        let steps = traced(&plan, (x, y));
        let names: Vec<String> = steps.keys().cloned().collect();
        names_seen += names.len();
        let options = options(Some(Rectangle { x, y, width: 1, height: 1 }));
        let found = planes(&plan, &names, &options).expect("inside");
        let check = |plane: &Plane, name: &String| {
            let complaint = complaint(name, plane, &steps[name]);
            assert_eq!(complaint, None, "{} at {x},{y}", path.display());
        };
        let integers = planes(&plan, &names, &PlaneOptions { ideal: false, ..options }).expect("inside");
        for (plane, whole) in integers.iter().zip(&found) {
            let same = (&plane.values, &plane.units, &plane.unit_of) == (&whole.values, &whole.units, &whole.unit_of);
            assert!(same && plane.ideals.is_empty(), "{}", path.display());
        }
        found.iter().zip(&names).for_each(|(plane, name)| check(plane, name));
        let triangles: usize = plan.draws().iter().map(|draw| draw.assembly.triangles.len()).sum();
        let reads_targets = plan.draws().iter().any(|draw| plan.reads_target(draw));
        if triangles < 500 && !reads_targets {
            for name in &names {
                let alone = planes(&plan, std::slice::from_ref(name), &options).expect("inside");
                check(&alone[0], name);
            }
        }
    }
    assert!(names_seen > 5000, "{names_seen}");
}

#[test]
fn planes_do_not_depend_on_threads_or_rectangles() {
    let plan = scene::load(&at("vectors/scenes/buffers/mirror.ron"), &Limits::default()).unwrap().plan;
    let names = ["fragment.draw", "fragment.stored", "stored.word"].map(str::to_owned);
    let whole = planes(&plan, &names, &options(None)).expect("inside");
    let threads = planes(&plan, &names, &PlaneOptions { threads: 3, ..options(None) }).expect("inside");
    assert_eq!(format!("{whole:?}"), format!("{threads:?}"));
    let (width, part) = (plan.targets()[0].width as usize, Rectangle { x: 37, y: 21, width: 50, height: 40 });
    let inside = planes(&plan, &names, &options(Some(part))).expect("inside");
    for (whole, part) in whole.iter().zip(&inside) {
        for row in 0..40 {
            let from = (21 + row) * width + 37;
            assert_eq!(whole.values[from..from + 50], part.values[row * 50..][..50]);
        }
    }
}

#[test]
fn names_stand_for_channels_and_wrong_ones_are_refused() {
    let plan = scene::load(&at("vectors/scenes/dot3/lit-stone.ron"), &Limits::default()).unwrap().plan;
    let options = options(Some(Rectangle { x: 8, y: 8, width: 4, height: 2 }));
    let arrays =
        |names: &[&str]| plane_arrays(&plan, &names.iter().map(|n| (*n).to_owned()).collect::<Vec<_>>(), &options);
    let found = arrays(&["stage0.rgb.AB", "texture0.rgb", "texture0.rgba", "unit0.weight_u"]).unwrap();
    let channels: Vec<usize> = found.arrays.iter().map(|array| array.planes.len()).collect();
    assert_eq!(channels, [3, 3, 4, 1]);
    assert_eq!(found.arrays[1].steps, ["texture0.r", "texture0.g", "texture0.b"]);
    assert!(found.arrays.iter().all(|array| array.is_whole() && array.is_narrow()));
    let error = arrays(&["unit0.weight_v", "unit0.wight_u"]).unwrap_err();
    assert_eq!(
        error,
        PlanesError::Unknown { name: "unit0.wight_u".to_owned(), meant: Some("unit0.weight_u".to_owned()) }
    );
    assert!(plane_names(&plan, &options).unwrap().contains_key("fragment.draw"));
    let outside = PlaneOptions { rectangle: Some(Rectangle { x: 639, y: 0, width: 2, height: 1 }), ..options };
    assert!(matches!(plane_arrays(&plan, &[], &outside), Err(PlanesError::Place(_))));
}
