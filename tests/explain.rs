//! Tests explanations of plans: their predictions are what a run counts, and what they call invisible changes no pixel.
#![allow(clippy::float_arithmetic, clippy::unwrap_used, missing_docs, unreachable_pub, reason = "a test binary")]

use crate::repository::at;
use ninebit_test_support::random_scene;

use ninebit::engine::{RenderOptions, count, render};
use ninebit::limits::Limits;
use ninebit::plan::{Invisible, Plan, PlanOptions};
use ninebit::state::*;
use ninebit::trace::Work;
use ninebit_report::explain::explain;
use ninebit_scene as scene;
use proptest::strategy::{Strategy, ValueTree};
use proptest::test_runner::TestRunner;
use std::path::Path;

/// Checks that prediction and run agree. Returns the number of predicted fragments, and of draws whose tests drop fragments.
fn check(what: &str, scene: &Scene, plan: &Plan) -> (u64, u64) {
    let counted = count(plan);
    let (mut fragments, mut tested) = (0, 0);
    for (draw, counts) in explain(scene, plan).iter().zip(&counted) {
        let cost = &draw.cost;
        assert_eq!(cost.fragments, counts.fragments, "{what}: fragments of {}", draw.name);
        let at_most = |work: Work| cost.kills || cost.lod_decides && matches!(work, Work::Texels | Work::Lerps);
        let agree = |most: &[u64]| {
            Work::ALL
                .iter()
                .zip(most)
                .zip(&counts.work)
                .all(|((work, most), counted)| if at_most(*work) { counted <= most } else { counted == most })
        };
        assert!(agree(&cost.with(counts.stored)), "{what}: {} {cost:?} {:?}", draw.name, counts.work);
        if cost.tested {
            assert!(counts.stored <= cost.fragments);
            tested += 1;
        } else {
            assert_eq!(counts.stored, cost.fragments);
            assert!(agree(&cost.total()), "{what}: {}", draw.name);
        }
        fragments += cost.fragments;
    }
    (fragments, tested)
}

#[test]
fn predictions_are_counted_on_every_scene_of_the_repository() {
    let mut scenes = 0;
    for entry in std::fs::read_dir(at("vectors/scenes/dot3")).unwrap() {
        let path = entry.unwrap().path();
        let name = path.to_string_lossy().into_owned();
        if name.ends_with(".ron") && !name.ends_with(".expect.ron") {
            let loaded = scene::load(&path, &Limits::default()).unwrap();
            let (fragments, _) = check(&name, &loaded.scene, &loaded.plan);
            assert!(fragments > 10_000, "{name}");
            scenes += 1;
        }
    }
    assert!(scenes >= 6);
}

#[test]
fn predictions_are_counted_on_random_scenes() {
    let mut runner = TestRunner::deterministic();
    let (mut fragments, mut tested) = (0, 0);
    for n in 0..400 {
        let scene = random_scene::scene().new_tree(&mut runner).unwrap().current();
        for prune in [true, false] {
            let mut plan = Plan::compile(&scene, &PlanOptions { prune, ..PlanOptions::default() }).unwrap();
            for (k, policy) in POLICIES.iter().enumerate() {
                plan.policies.choose(policy.rule, (n / (k + 1)) % policy.values.len());
            }
            let (f, t) = check(&format!("{scene:?}"), &scene, &plan);
            (fragments, tested) = (fragments + f, tested + t);
        }
    }
    assert!(fragments > 100_000 && tested > 50, "{fragments} {tested}");
}

/// Returns a scene with a quad of 4 x 4 pixels, whose draw has the given fields.
fn quad(fields: &str) -> Scene {
    let text = format!(
        "(version: 1, profile: Nv2a, targets: [(name: \"frame\", width: 4, height: 4, clear: (color: (9, 8, 7, 6)))], draws: [\
         (vertices: Window([(position: (0, 0)), (position: (4, 0)), (position: (4, 4)), (position: (0, 4))]), \
         topology: Quads, {fields})])"
    );
    scene::parse(&text, Path::new("quad.ron"), &Limits::default()).unwrap_or_else(|error| panic!("{error}")).scene
}

const BLACK: &str = "program: Combiners(stages: [()], final_combiner: (d: (Zero), g: (Zero, Blue))),";

#[test]
fn draws_that_nothing_can_see_are_left_out() {
    let blend = |equation: &str, source: &str, destination: &str| {
        format!("blend: (equation: {equation}, source: {source}, destination: {destination}),")
    };
    for (fields, expected) in [
        (format!("{BLACK} {}", blend("Add", "One", "One")), Some(Invisible::AddsZero)),
        (format!("{BLACK} {}", blend("ReverseSubtract", "SourceAlpha", "One")), Some(Invisible::AddsZero)),
        (format!("{BLACK} {}", blend("Max", "One", "One")), Some(Invisible::AddsZero)),
        (format!("{BLACK} {}", blend("Add", "One", "SourceAlpha")), None),
        (blend("Add", "Zero", "One"), Some(Invisible::KeepsDestination)),
        (blend("Add", "One", "One"), None),
        ("color_mask: (false, false, false, false),".to_string(), Some(Invisible::NothingWritten)),
        (String::new(), None),
    ] {
        let scene = quad(&fields);
        let plan = Plan::compile(&scene, &PlanOptions::default()).unwrap();
        assert_eq!(plan.draws()[0].folded.invisible, expected, "{fields}");
        let whole = Plan::compile(&scene, &PlanOptions { prune: false, ..PlanOptions::default() }).unwrap();
        let [one, other] = [&plan, &whole].map(|plan| render(plan, &RenderOptions::default()));
        assert_eq!(one, other, "{fields}");
        let explanation = &explain(&scene, &plan)[0];
        if expected.is_some() {
            assert_eq!((explanation.cost.fragments, explanation.equations.len()), (0, 0));
            assert!(explanation.dropped[0].starts_with("the whole draw: "));
        } else {
            assert!(explanation.cost.fragments == 16 && !explanation.equations.is_empty());
        }
    }
}

/// The scene reader refuses an empty scissor rectangle and a draw without triangles, but the state can have both.
#[test]
fn empty_draws_are_left_out() {
    let invisible = |scene: &Scene| Plan::compile(scene, &PlanOptions::default()).unwrap().draws()[0].folded.invisible;
    let mut scene = quad("");
    scene.draws[0].scissor = Some(Rectangle { x: 4, y: 0, width: 4, height: 4 });
    assert_eq!(invisible(&scene), Some(Invisible::NoPixels));
    scene.draws[0].indices = [].into();
    assert_eq!(invisible(&scene), Some(Invisible::NoTriangles));
}

#[test]
fn a_blend_that_replaces_reads_nothing() {
    let scene = quad("blend: (equation: Add, source: One, destination: Zero),");
    let plan = Plan::compile(&scene, &PlanOptions::default()).unwrap();
    assert!(plan.draws()[0].blend.is_none());
    let counted = &count(&plan)[0];
    assert_eq!((counted.work[Work::BytesRead as usize], counted.work[Work::BytesWritten as usize]), (0, 64));
    assert!(explain(&scene, &plan)[0].dropped.iter().any(|line| line.contains("destination is not read")));
}

#[test]
fn equations_are_in_the_extensions_terms() {
    let scene = quad(
        "program: Combiners(stages: [\
         (rgb: (a: ExpandNormal(Texture0), b: ExpandNormal(PrimaryColor), ab: Spare0, ab_dot_product: true, scale: Four), \
          alpha: (a: (Texture0, Alpha), b: (PrimaryColor, Alpha), ab: Spare0)), \
         (rgb: (a: (Spare0), b: (ConstantColor0), c: UnsignedInvert(SecondaryColor), d: (Spare0, Alpha), sum: Spare1, \
         bias: NegativeHalf))], \
         final_combiner: (a: (PrimaryColor, Alpha), b: (Spare1), c: (Zero), d: (SecondaryColor), g: (Spare1, Blue)))",
    );
    let plan = Plan::compile(&scene, &PlanOptions::default()).unwrap();
    let explanation = &explain(&scene, &plan)[0];
    let text = explanation.equations.join("\n");
    for line in [
        "stage 0: spare0.rgb = 4 * (expand(tex0) . expand(col0))",
        "stage 0: spare0.a = unsigned(tex0.a) * unsigned(col0.a)",
        "stage 1: spare1.rgb = unsigned(spare0) * unsigned(const0) + unsigned_invert(col1) * unsigned(spare0.a) - 1/2",
        "fragment.rgb = col0.a * spare1 + col1",
        "fragment.a = spare1.b",
        "store rgba to `frame`, A8R8G8B8",
    ] {
        assert!(text.contains(line), "`{line}` is not in\n{text}");
    }
}

#[test]
fn fog_is_a_function_of_what_it_says() {
    for (fog, expected) in [
        ("", vec!["fog.a = smooth(vertices): factors"]),
        ("mode: Linear, start: 0, end: 4", vec!["fog.rgb = (7, 8, 9)/255", "fog.a = 2 + -0.25 d - 1, limited"]),
        ("mode: LinearAbs, parameters: (1, 0.5)", vec!["fog.a = 1 + 0.5 |d| - 1, limited"]),
        (
            "mode: Exp, parameters: (1.5, -0.5)",
            vec!["fog.a = 2^(16 (e - 3/2)), 1 from e = 3/2 on, 0 below e = 1, e = 1.5 + -0.5 d at the vertices"],
        ),
        ("mode: ExpAbs, parameters: (1.5, -0.5)", vec!["fog.a = 2^(-16 |e - 3/2|), 0 from a distance of 1/2 on"]),
        (
            "mode: Exp2Abs, parameters: (1.5, -0.5, 0.25)",
            vec![
                "fog.a = 2^(-32 (e - 3/2)^2), 0 from a distance of 1/2 on, e = 1.5 + -0.5 d + 0.25 d^2 at the vertices",
            ],
        ),
        (
            "mode: Linear, start: 0, end: 4, evaluation: PerVertex",
            vec!["fog.a = e - 1, limited to 0..1, e = 2 + -0.25 d at the vertices"],
        ),
    ] {
        let scene = quad(&format!("fog: (color: (7, 8, 9), {fog}),"));
        let plan = Plan::compile(&scene, &PlanOptions::default()).unwrap();
        let text = explain(&scene, &plan)[0].equations.join("\n");
        assert!(expected.iter().all(|line| text.contains(line)), "{expected:?} is not in\n{text}");
    }
}

/// Three dot products of five operations each, and a reflection of twenty.
#[test]
fn the_dot_unit_is_counted() {
    let text = "(version: 1, profile: Nv2a, targets: [(name: \"frame\", width: 4, height: 4)], textures: { \
         \"n\": (source: Solid(width: 1, height: 1, color: (128, 128, 255))), \"sky\": (source: Faces(\
         positive_x: Solid(width: 1, height: 1, color: (1, 1, 1)), negative_x: Solid(width: 1, height: 1, color: (1, 1, 1)), \
         positive_y: Solid(width: 1, height: 1, color: (1, 1, 1)), negative_y: Solid(width: 1, height: 1, color: (1, 1, 1)), \
         positive_z: Solid(width: 1, height: 1, color: (1, 1, 1)), negative_z: Solid(width: 1, height: 1, color: (1, 1, 1)))) }, \
         draws: [(vertices: Window([(position: (0, 0)), (position: (4, 0)), (position: (4, 4)), (position: (0, 4))]), topology: Quads, \
         textures: [\"n\", Unbound, Unbound, \"sky\"], texture_shader: [Sample, (operation: DotProduct, previous: 0), \
         (operation: DotProduct, previous: 0), (operation: DotReflectConstantEye(eye: (0, 0, 1)), previous: 0)], \
         program: Combiners(stages: [()], final_combiner: (d: Texture3)))])";
    let loaded = scene::parse(text, Path::new("sky.ron"), &Limits::default()).unwrap_or_else(|error| panic!("{error}"));
    check("sky", &loaded.scene, &loaded.plan);
    assert_eq!(count(&loaded.plan)[0].work[Work::Dots as usize], 16 * (3 * 5 + 20));
}
