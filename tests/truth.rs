//! Tests the ground truth of pictures, and the measurement of their errors.

use crate::repository::at;
use std::path::{Path, PathBuf};

use ninebit::limits::Limits;
use ninebit_lab::accuracy::{Accuracy, accuracy_text, accuracy_value, measure};
use ninebit_scene::truth::{Pixel, evaluate};
use ninebit_scene::{self as scene, LoadedScene};

fn parse(text: &str) -> LoadedScene {
    scene::parse(text, Path::new("test.ron"), &Limits::default()).unwrap_or_else(|error| panic!("{error}"))
}

/// Returns a scene of 64 x 64 pixels with the given truth and draw, seen from above. The square spans -1 to 1.
fn square(truth: &str, mesh: &str, draw: &str) -> String {
    format!(
        "(version: 1, profile: Nv2a, targets: [(width: 64, height: 64)], truth: ({truth}), draws: [(vertices: Matrix(matrix: \
         Orthographic(left: -1, right: 1, bottom: -1, top: 1, near: -2, far: 2), {mesh}), {draw})])"
    )
}

const GRID: &str = "mesh: Grid(columns: 1, rows: 1)";

fn pixels(loaded: &LoadedScene) -> Vec<Option<Pixel>> {
    evaluate(&loaded.plan, loaded.truth.as_ref().unwrap(), 0).pixels
}

fn accuracy(loaded: &LoadedScene) -> Accuracy {
    measure(&loaded.scene, &loaded.plan, loaded.truth.as_ref().unwrap()).unwrap()
}

/// Returns the position of a pixel's centre on the square.
fn place(at: usize) -> [f64; 2] {
    let along = |index: usize| (index as f64 + 0.5) / 32.0 - 1.0;
    [along(at % 64), -along(at / 64)]
}

#[test]
fn a_hemisphere_is_lit_as_it_is() {
    let truth = "lights: [(direction: (0, 0.6, 0.8))], normal: Hemisphere(zero_outside: true)";
    for (at, pixel) in pixels(&parse(&square(truth, GRID, ""))).into_iter().enumerate() {
        let [x, y] = place(at);
        let height = 1.0 - x * x - y * y;
        let wanted = if height > 0.0 { (0.6 * y + 0.8 * height.sqrt()).max(0.0) } else { 0.0 };
        let color = pixel.unwrap().color;
        assert!(color.iter().all(|c| (c - wanted).abs() < 1e-6), "{at}: {color:?} for {wanted}");
    }
}

#[test]
fn points_are_interpolated_in_perspective() {
    // A floor seen at an angle and lit by a lamp. The point of a pixel is where its line of sight meets the floor.
    let text = "(version: 1, profile: Nv10, targets: [(width: 64, height: 48)], truth: (lights: [(position: (0.3, 0.2, 0.5))]), \
        draws: [(vertices: Matrix(matrix: Product(Frustum(left: -0.5, right: 0.5, bottom: -0.4, top: 0.4, near: 1, far: 20), \
        LookAt(eye: (0, -3, 1), center: (0, 0, 0), up: (0, 0, 1))), mesh: Grid(columns: 3, rows: 2, size: (4, 4))))])";
    let loaded = parse(text);
    let pixels = pixels(&loaded);
    assert!(pixels.iter().flatten().count() > 500);
    // Up and back axes of the viewer; the right axis is x.
    let length = 10.0_f64.sqrt();
    let (up, back) = ([0.0, 1.0 / length, 3.0 / length], [0.0, -3.0 / length, 1.0 / length]);
    for (at, pixel) in pixels.iter().enumerate() {
        let Some(pixel) = pixel else { continue };
        let (x, y) = (((at % 64) as f64 + 0.5) / 64.0 - 0.5, 0.4 - 0.8 * ((at / 64) as f64 + 0.5) / 48.0);
        let sight = [x, y * up[1] - back[1], y * up[2] - back[2]];
        let far = -1.0 / sight[2];
        let point = [far * sight[0], -3.0 + far * sight[1], 0.0];
        let light = [0.3 - point[0], 0.2 - point[1], 0.5];
        let wanted = 0.5 / light.iter().map(|c| c * c).sum::<f64>().sqrt();
        assert!((pixel.color[0] - wanted).abs() < 1e-4, "{at}: {} for {wanted}", pixel.color[0]);
    }
}

#[test]
fn what_is_hidden_has_no_say() {
    // A triangle in front of a square, drawn first. Where it hides the square, the truth has its normals.
    let text = "(version: 1, profile: Nv10, targets: [(width: 8, height: 8, depth: Z16)], truth: (lights: [(direction: (0, 0, 1))], \
        normal: Radial()), draws: [\
        (vertices: Matrix(matrix: Orthographic(left: -1, right: 1, bottom: -1, top: 1, near: -4, far: 4), mesh: Triangles(vertices: \
        [(position: (-1, -1, 2)), (position: (1, -1, 2)), (position: (-1, 1, 2))])), depth_test: ()),\
        (vertices: Matrix(matrix: Orthographic(left: -1, right: 1, bottom: -1, top: 1, near: -4, far: 4), mesh: Grid(columns: 1, rows: 1)), \
        depth_test: ()), ])";
    let pixels = pixels(&parse(text));
    // Lower left is the triangle at z = 2. Upper right is the square at z = 0, whose radial normals lie in its plane.
    assert!(pixels[7 * 8].unwrap().normal[2] > 0.7);
    assert_eq!(pixels[7].unwrap().normal[2], 0.0);
}

#[test]
fn other_equations() {
    let value = |equation: &str, s: f64, t: f64| {
        let loaded = parse(&square(&format!("equation: {equation}"), GRID, ""));
        let at = (t * 64.0) as usize * 64 + (s * 64.0) as usize;
        pixels(&loaded)[at].unwrap().color[0]
    };
    let centre = |c: f64| ((c * 64.0).floor() + 0.5) / 64.0;
    let (s, t) = (centre(0.9), centre(0.2));
    assert!((value("Difference", 0.9, 0.2) - (s - t)).abs() < 1e-6);
    assert_eq!(value("Difference", 0.2, 0.9), 0.0);
    assert_eq!(value("SignedProduct", 0.9, 0.2), 0.0);
    assert!((value("SignedProduct", 0.9, 0.8) - (2.0 * s - 1.0) * (2.0 * centre(0.8) - 1.0)).abs() < 1e-6);
    let mesh = "mesh: Grid(columns: 1, rows: 1), diffuse: (255, 0, 0), t1: (0.5, 0.25, 9)";
    let loaded = parse(&square("equation: DotProduct(PrimaryColor, T1)", mesh, ""));
    // (1, -1, -1) . (0.5, 0.25, 9), limited to 0.
    assert_eq!(pixels(&loaded)[99].unwrap().color, [0.0; 3]);
}

#[test]
fn errors_are_split_and_add_up() {
    let folder = at("vectors/scenes/dot3");
    let text = std::fs::read_to_string(folder.join("hemisphere.ron")).unwrap();
    assert!(text.contains("profile"), "the scene is there");
    let program = "textures: [(texture: \"ball\", address: ClampToEdge)], program: Combiners(constants: (Vector((0.48, 0.6, 0.64))), \
        stages: [(rgb: (a: ExpandNormal(Texture0), b: ExpandNormal(ConstantColor0), ab: Spare0, ab_dot_product: true))], final_combiner: (d: Spare0))";
    let truth = "lights: [(direction: (0.48, 0.6, 0.64))], normal: Hemisphere(), shading_normal: (register: Texture0)";
    let text = square(truth, GRID, program)
        .replace("targets:", "textures: { \"ball\": (source: File(\"hemisphere-normal.png\")) }, targets:");
    let loaded = scene::parse(&text, &folder.join("test.ron"), &Limits::default()).unwrap();
    let accuracy = accuracy(&loaded);
    assert_eq!((accuracy.pixels, accuracy.without), (64 * 64, 0));
    let mean: f64 = accuracy.causes.iter().map(|cause| cause.errors.bias()).sum();
    assert!((mean - accuracy.errors.bias()).abs() < 1e-3, "{mean} {}", accuracy.errors.bias());
    // Normals in bytes 128 + 127 n are a fraction of a degree off. At the outline, where the filter mixes in the flat surface, the error is
    // much larger.
    let normals = accuracy.normals.unwrap();
    assert!(normals.degrees.mean() > 0.05 && normals.degrees.mean() < 1.0, "{:?}", normals.degrees);
    assert!(accuracy.errors.mean() > 0.5 && accuracy.errors.mean() < 2.0, "{:?}", accuracy.errors);
    assert!(accuracy.banding.levels > 60 && accuracy.banding.truth_levels > 60, "{:?}", accuracy.banding);
    for cost in [&accuracy.cost.asked, &accuracy.cost.pruned] {
        assert_eq!((cost.passes, cost.fragments, cost.texels), (1, 1.0, 4.0));
    }
    assert!(accuracy_text(&accuracy).contains("quantised normals"));
    assert_eq!(accuracy_value(&accuracy)["pixels"], 4096);
}

/// A square of one colour whose truth has the same colour has no error.
#[test]
fn nothing_is_off_where_nothing_is_rounded() {
    let truth = "hemisphere: (sky: (51, 102, 255), ground: (51, 102, 255))";
    let loaded = parse(&square(truth, "mesh: Grid(columns: 1, rows: 1), diffuse: (51, 102, 255)", ""));
    let accuracy = accuracy(&loaded);
    assert!(accuracy.errors.max() < 1e-9, "{:?}", accuracy.errors);
    assert!(accuracy.causes.iter().all(|cause| cause.errors.max() < 1e-4), "{:?}", accuracy.causes);
}

#[test]
fn nothing_drawn_is_nothing_measured() {
    let loaded = parse(&square("lights: [(direction: (0, 0, 1))]", GRID, "cull: Front"));
    assert!(measure(&loaded.scene, &loaded.plan, loaded.truth.as_ref().unwrap()).is_none());
}

/// Writes a scene and its family to a temporary folder. Returns the folder and the path of the scene.
fn with_family(scene: &str, family: &str) -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("outside.family.ron"), family).unwrap();
    let path = folder.path().join("scene.ron");
    std::fs::write(&path, scene).unwrap();
    (folder, path)
}

#[test]
fn a_family_is_as_if_it_stood_in_the_scene() {
    let family = "(names: (vectors: { \"sun\": (0, 0.6, 0.8), \"other\": (1, 1) }, meshes: { \"square\": Grid(columns: 1, rows: 1) }), \
        targets: [(width: 64, height: 64)], truth: (lights: [(direction: \"sun\")], normal: Hemisphere()))";
    let scene = "(version: 1, profile: Nv2a, family: \"outside.family.ron\", truth: (normal: Mesh), draws: [(vertices: Matrix(matrix: \
        Orthographic(left: -1, right: 1, bottom: -1, top: 1, near: -2, far: 2), mesh: \"square\", diffuse: LightVector(direction: \"sun\")))])";
    let (_folder, path) = with_family(scene, family);
    let loaded = scene::load(&path, &Limits::default()).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(loaded.render_warnings(false), "");
    let whole = parse(&square(
        "lights: [(direction: (0, 0.6, 0.8))]",
        "mesh: Grid(columns: 1, rows: 1), diffuse: LightVector(direction: (0, 0.6, 0.8))",
        "",
    ));
    assert_eq!((&loaded.scene, &loaded.truth), (&whole.scene, &whole.truth));
    assert!(loaded.draw_spans[0].vertex(0).end <= loaded.source.text.len());
}

#[test]
fn a_family_does_not_leave_the_folder() {
    let (_folder, path) =
        with_family("(version: 1, profile: Nv2a, family: \"../outside.family.ron\", draws: [])", "()");
    let error = scene::load(&path, &Limits::default()).unwrap_err();
    assert_eq!(error.diagnostics[0].code, "NB0501");
}
