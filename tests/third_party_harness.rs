//! Tests the harness for cases of public test suites. A case of every form becomes a scene, passes if it is right, and fails if an error is
//! planted in it.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use crate::third_party::judge;
use crate::third_party_pipeline::raster_operations::{alpha_test, blending};
use crate::third_party_pipeline::texture_units::cube_face;
use crate::third_party_pixel_shader::pixel_shader;
use crate::third_party_stages::stages;
use serde_json::{Value, json};

type Problem = fn(&Value, &str) -> Option<String>;

/// Checks that a case passes with the right expectation and fails with the planted one.
fn told_apart(problem: Problem, inputs: Value, right: Value, planted: Value) {
    told_apart_by(problem, "expected", inputs, right, planted);
}

/// Like [`told_apart`], for an expectation in another field.
fn told_apart_by(problem: Problem, field: &str, inputs: Value, right: Value, planted: Value) {
    let case = |id: &str, expected: Value| {
        let mut case =
            json!({ "id": id, "profile": "nv20", "inputs": inputs.clone(), "tolerance": 2, "tolerance_st": 0.001 });
        case[field] = expected;
        case
    };
    let cases = [case("suite.right", right), case("suite.planted", planted)];
    let outcome = judge(&cases, "", problem);
    assert_eq!(outcome.applicable, 2);
    assert_eq!(outcome.wrong.len(), 1, "{:#?}", outcome.wrong);
    let planted = &outcome.wrong[0];
    assert!(planted.starts_with("suite.planted: ") && !planted.contains("cannot be put"), "{planted}");
}

#[test]
fn a_framebuffer_holds_a_colour_before_the_draw() {
    let inputs = |name: &str| {
        let mut inputs = json!({ "func": "NEVER", "ref": 0, "fragment": [0, 255, 0, 128] });
        inputs[name] = json!([10, 20, 30, 40]);
        inputs
    };
    for name in ["framebuffer", "clear", "clear_color", "dst", "dest"] {
        told_apart(alpha_test, inputs(name), json!([10, 20, 30, 40]), json!([0, 255, 0, 128]));
    }
    let mut floats = json!({ "func": "NEVER", "ref": 0, "fragment": [0, 255, 0, 128] });
    floats["framebuffer_f"] = json!([1, 0.2, 0.4, null]);
    told_apart(alpha_test, floats, json!([255, 51, 102, 255]), json!([255, 51, 102, 0]));
    // The name of an input as the expectation means its value.
    told_apart(alpha_test, inputs("framebuffer"), json!("framebuffer"), json!("fragment"));
}

#[test]
fn a_destination_without_alpha_is_opaque() {
    for has_alpha in [true, false] {
        let inputs = json!({
            "op": "ADD", "src_factor": "DST_ALPHA", "dst_factor": "ZERO", "target_has_alpha": has_alpha,
            "src": [200, 100, 50, 60], "dst": [255, 0, 0, null],
        });
        told_apart(blending, inputs, json!([200, 100, 50, null]), json!([0, 0, 0, null]));
    }
    let stages_of = |dest: Value| {
        json!({
            "diffuse": [200, 100, 50, 60], "textures": {}, "stages": [{ "color": { "op": "SELECTARG1", "arg1": "DIFFUSE" } }],
            "blend": { "src": "DSTALPHA", "dst": "ZERO", "dest": dest },
        })
    };
    told_apart(stages, stages_of(json!([255, 0, 0, null])), json!([200, 100, 50, null]), json!([0, 0, 0, null]));
    told_apart(stages, stages_of(json!([255, 0, 0, 0])), json!([0, 0, 0, null]), json!([200, 100, 50, null]));
}

#[test]
fn a_set_of_tied_faces_takes_any_of_them_and_no_other() {
    let faces = json!({
        "+X": [255, 0, 0], "-X": [0, 255, 255], "+Y": [255, 0, 255], "-Y": [255, 255, 0], "+Z": [0, 0, 255], "-Z": [0, 255, 0],
    });
    let inputs = json!({ "direction": [1.0, 1.0, 0.5], "face_colors": faces });
    for (right, planted) in [
        (json!(["+X", "+Y"]), json!(["-X", "+Z"])),
        (json!("+X|+Y"), json!("-X|+Z")),
        (json!("+Y or +X"), json!("-Y or -Z")),
    ] {
        told_apart_by(cube_face, "expected_face", inputs.clone(), right, planted);
    }
    // With several tied faces the colour of each is acceptable.
    told_apart(
        cube_face,
        {
            let mut with_set = inputs.clone();
            with_set["face_pattern"] = json!("one colour a face");
            with_set
        },
        json!([[255, 0, 0, null], [255, 0, 255, null]]),
        json!([[0, 255, 255, null], [0, 0, 255, null]]),
    );
}

#[test]
fn places_on_tied_faces_go_with_their_face() {
    // (1, 1, 0) is the middle of the far edge on both faces.
    let judged = |face: Value, place: Value| {
        let case = json!({
            "id": "suite.case", "profile": "nv10", "inputs": { "direction": [1.0, 1.0, 0.0] },
            "expected_face": face, "expected_st": place, "tolerance_st": 0.01,
        });
        judge(&[case], "", cube_face).wrong
    };
    let of_x = judged(json!("+X"), json!([0.5, 0.0]));
    assert_eq!(of_x, Vec::<String>::new(), "one face of a tie is the order of a reference");
    let places = json!({ "+X": [0.5, 0.0], "+Y": [1.0, 0.5] });
    assert_eq!(judged(json!(["+X", "+Y"]), places), Vec::<String>::new());
    assert_eq!(judged(json!(["+X", "+Y"]), json!([[0.5, 0.0], [1.0, 0.5]])), Vec::<String>::new());
    for planted in [json!({ "+X": [0.2, 0.0], "+Y": [1.0, 0.2] }), json!([[0.5, 0.4], [0.4, 0.5]])] {
        let wrong = judged(json!(["+X", "+Y"]), planted);
        assert!(wrong.len() == 1 && wrong[0].contains("within 0.01"), "{wrong:?}");
    }
    let wrong = judged(json!(["-X", "+Z"]), json!([0.5, 0.0]));
    assert!(wrong.len() == 1 && wrong[0].contains("not -X or +Z"), "{wrong:?}");
}

#[test]
fn a_bumped_texture_is_moved_by_its_matrix() {
    let inputs = |matrix: Value, luminance: Value| {
        let mut inputs = json!({
            "version": "1.1", "uv": [0.25, 0.5], "tex0": "same as texbem_test tex0", "tex1": "same as texbem_test tex1",
            "program": [
                { "op": "tex", "dst": "t0", "src": [] }, { "op": "texbem", "dst": "t1", "src": ["t0"] },
                { "op": "mov", "dst": "r0", "src": ["t1"] },
            ],
        });
        inputs["bumpenvmat"] = matrix;
        if let Value::Object(fields) = luminance {
            inputs.as_object_mut().unwrap().extend(fields);
            inputs["program"][1]["op"] = json!("texbeml");
        }
        inputs
    };
    let plain = pixel_shader;
    // In Wine's map, V is -1/2 and U is 0 at a quarter from the left. With 1/2 in the matrix the second coordinate moves by a quarter.
    told_apart(
        plain,
        inputs(json!([0.5, 0.0, 0.0, 0.5]), Value::Null),
        json!([64, 64, 0, null]),
        json!([64, 128, 0, null]),
    );
    told_apart(
        plain,
        inputs(json!([0.0, 0.0, 0.0, 0.0]), Value::Null),
        json!([64, 128, 0, null]),
        json!([64, 64, 0, null]),
    );
    // The luminance of a texel of Wine's map is its red, which is 0, so only the offset remains.
    told_apart(
        plain,
        inputs(json!([0.0, 0.0, 0.0, 0.0]), json!({ "lscale": 1.0, "loffset": 0.5 })),
        json!([32, 64, 0, null]),
        json!([64, 128, 0, null]),
    );
    // The same displacement as a texel and as numbers, with the matrix of the unit itself.
    for displacement in [json!({ "tex0": { "V8U8": [0, -64] } }), json!({ "du_dv_0": [0, -64] })] {
        let mut own = inputs(Value::Null, Value::Null);
        let fields = own.as_object_mut().unwrap();
        fields.remove("tex0");
        fields.extend(displacement.as_object().unwrap().clone());
        fields.insert("bumpenvmat1".to_owned(), json!([0.5, 0.0, 0.0, 0.5]));
        told_apart(plain, own, json!([64, 64, 0, null]), json!([64, 128, 0, null]));
    }
}

#[test]
fn a_killed_pixel_shows_the_clear_colour() {
    let inputs = |s: f64| {
        json!({
            "version": "1.1", "t0": [s, 0.0, 0.0], "v0": [1, 1, 1, 1], "clear": [10, 20, 30, null],
            "program": [{ "op": "texkill", "dst": "t0", "src": [] }, { "op": "mov", "dst": "r0", "src": ["v0"] }],
        })
    };
    told_apart(pixel_shader, inputs(-1.0), json!([10, 20, 30, 255]), json!([255, 255, 255, 255]));
    told_apart(pixel_shader, inputs(1.0), json!([255, 255, 255, 255]), json!("clear"));
}

/// A case that cannot become a scene fails by name, and the cases after it still run.
#[test]
fn a_case_that_cannot_be_read_fails_alone() {
    let good = json!({
        "id": "suite.good", "profile": "nv10", "tolerance": 0, "expected": [1, 2, 3, 4],
        "inputs": { "func": "ALWAYS", "ref": 0, "fragment": [1, 2, 3, 4], "framebuffer": [0, 0, 0, 0] },
    });
    let spoiled = |change: &dyn Fn(&mut Value)| {
        let mut case = good.clone();
        case["id"] = json!("suite.spoiled");
        change(&mut case);
        case
    };
    let cases = [
        spoiled(&|case| case["inputs"]["func"] = json!("SOMETIMES")),
        spoiled(&|case| case["inputs"]["fragment"] = json!("green")),
        spoiled(&|case| case["inputs"] = Value::Null),
        spoiled(&|case| case["expected"] = Value::Null),
        spoiled(&|case| case["expected"] = json!([])),
        spoiled(&|case| case["tolerance"] = Value::Null),
        spoiled(&|case| case["profile"] = json!("none")),
        spoiled(&|case| case["id"] = Value::Null),
        good.clone(),
    ];
    let outcome = judge(&cases, "", alpha_test);
    assert_eq!(outcome.wrong.len(), cases.len() - 1, "{:#?}", outcome.wrong);
    for wrong in &outcome.wrong[..6] {
        assert!(wrong.starts_with("suite.spoiled: cannot be put as a scene: "), "{wrong}");
    }
}
