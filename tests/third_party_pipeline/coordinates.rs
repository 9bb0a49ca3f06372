//! Runs cases of texture coordinates of Direct3D texture stages: which set is used, how it is transformed, and how a bump map moves it.

use super::third_party::{Kind, bytes, differs, displacement_map, pixel, place_map, run};
use super::{number, numbers, quad, scene};
use serde_json::Value;

/// Returns a list of numbers in scene notation.
fn list(values: &[f64]) -> String {
    let texts: Vec<String> = values.iter().map(|value| format!("{value:?}")).collect();
    format!("({})", texts.join(", "))
}

/// Returns a matrix for column vectors from the rows of a Direct3D matrix, which row vectors are multiplied by.
fn transposed(rows: [[f64; 4]; 4]) -> String {
    let rows: Vec<String> = (0..4).map(|n| list(&[rows[0][n], rows[1][n], rows[2][n], rows[3][n]])).collect();
    format!("Rows({})", rows.join(", "))
}

#[test]
fn every_case_of_texture_coordinates() {
    run(&Kind { file: "texture-coordinates", name: "texcoord" }, |case, profile| {
        if case["expected_st"].is_array() {
            flags(case, profile)
        } else {
            differs(case, indexed(&case["inputs"], profile))
        }
    });
}

/// Reads s and t from two pictures, each with a ramp along one of them. Returns how they differ from the expectation.
fn flags(case: &Value, profile: &str) -> Option<String> {
    let inputs = &case["inputs"];
    let given = list(&numbers(&inputs["attribute"]));
    let count = ["Disable", "Count1", "Count2", "Count3", "Count4"][inputs["count"].as_u64().unwrap() as usize];
    let flags = if inputs["projected"] == true { format!("({count}, Projected)") } else { count.to_owned() };
    assert_eq!(inputs["matrix"], "anti-identity (output k = input 3-k)");
    let matrix =
        transposed(std::array::from_fn(|row| std::array::from_fn(|column| f64::from(u8::from(row + column == 3)))));
    let quad = quad(1.0, 1.0, [0; 4].map(|_| format!("t0: {given}")));
    let mut place = [0.0; 2];
    for (axis, (sides, name)) in
        [("width: 256, height: 1", "Horizontal"), ("width: 1, height: 256", "Vertical")].into_iter().enumerate()
    {
        let head = format!(
            "textures: {{ \"t\": (source: Ramp({sides}, from: (0, 0, 0), to: (255, 255, 255), axis: {name})) }},"
        );
        let draw = format!(
            "{quad}, textures: [(texture: \"t\", min_filter: Nearest)], texture_matrices: [{matrix}], program: TextureStages(stages: \
             [(color_op: SelectArg1, color_arg1: Texture, texture_transform_flags: {flags})])"
        );
        match pixel(&scene(profile, "name: \"frame\", width: 1, height: 1", &head, &draw), (0, 0)) {
            Ok([texel, ..]) => place[axis] = f64::from(texel) / 256.0,
            Err(problem) => return Some(problem),
        }
    }
    let expected = numbers(&case["expected_st"]);
    let tolerance = number(&case["tolerance_st"]);
    // The texture repeats, so a coordinate slightly below 1 is also slightly below 0.
    let apart = |n: usize| {
        let difference = (place[n] - expected[n]).abs();
        difference.min(1.0 - difference)
    };
    ((0..2).any(|n| apart(n) > tolerance)).then(|| format!("{place:?}, not {expected:?} within {tolerance}"))
}

/// Draws the sum of two textures of 2 x 2 texels over 640 x 480 pixels, and returns one pixel.
fn indexed(inputs: &Value, profile: &str) -> Result<[u8; 4], String> {
    let mut textures = Vec::new();
    for unit in ["0", "1"] {
        let texels: Vec<String> = inputs["textures_2x2"][unit]
            .as_array()
            .unwrap()
            .iter()
            .map(|color| {
                let [r, g, b] = [0, 1, 2].map(|n| color[n].as_u64().unwrap());
                format!("ff{r:02x}{g:02x}{b:02x}")
            })
            .collect();
        let rows = format!("\"{} {}\", \"{} {}\"", texels[0], texels[1], texels[2], texels[3]);
        textures.push(format!("\"t{unit}\": (source: Texels(width: 2, height: 2, rows: [{rows}]))"));
    }
    // Returns the coordinate sets of a corner. x and y are counted from the bottom left.
    let corner = |x: f64, y: f64| {
        let sets: Vec<String> = ["0", "1", "2"]
            .iter()
            .map(|set| {
                let (s, t) = match inputs["coords"][*set].as_str().unwrap() {
                    "(x, 1-y)" => (x, 1.0 - y),
                    "(x, y)" => (x, y),
                    "(1-x, 1-y)" => (1.0 - x, 1.0 - y),
                    "(1-x, y)" => (1.0 - x, y),
                    other => panic!("{other}"),
                };
                format!("t{set}: ({s:?}, {t:?})")
            })
            .collect();
        sets.join(", ")
    };
    let [first, second] = [0, 1].map(|n| inputs["texcoordindex"][n].as_u64().unwrap());
    let rows = &inputs["stage1_matrix_rows"];
    let (matrices, flags) = if rows.is_array() {
        let rows = std::array::from_fn(|row| std::array::from_fn(|column| number(&rows[row][column])));
        (format!("texture_matrices: [None, {}],", transposed(rows)), ", texture_transform_flags: Count2")
    } else {
        (String::new(), "")
    };
    let quad = quad(640.0, 480.0, [(0.0, 1.0), (1.0, 1.0), (1.0, 0.0), (0.0, 0.0)].map(|(x, y)| corner(x, y)));
    let [x, y] = [0, 1].map(|n| inputs["pixel"][n].as_u64().unwrap() as u32);
    let draw = format!(
        "{quad}, scissor: (x: {x}, y: {y}, width: 1, height: 1), textures: [{}], {matrices} program: TextureStages(stages: [\
         (color_op: SelectArg1, color_arg1: Texture, texture_coordinate_index: {first}), \
         (color_op: Add, color_arg1: Texture, color_arg2: Current, texture_coordinate_index: {second}{flags})])",
        // The default filter of Direct3D's samplers is the nearest one.
        ["t0", "t1"].map(|name| format!("(texture: \"{name}\", min_filter: Nearest)")).join(", ")
    );
    let head = format!("textures: {{ {} }},", textures.join(", "));
    pixel(&scene(profile, "name: \"frame\"", &head, &draw), (x, y))
}

#[test]
fn every_case_of_bump_maps() {
    run(&Kind { file: "bump-maps", name: "bump" }, |case, _| {
        let inputs = &case["inputs"];
        let text = if inputs["uv"].is_array() { moved(inputs) } else { lit(inputs) };
        differs(case, pixel(&text, (0, 0)))
    });
}

/// Returns a scene with two textures, in a bump stage and a stage that shows its texture.
fn bumped(textures: [&str; 2], units: [&str; 2], coordinates: &str, stage: &str) -> String {
    let corner = format!("t0: {coordinates}, t1: {coordinates}");
    let quad = quad(1.0, 1.0, [0; 4].map(|_| corner.clone()));
    let head = format!("textures: {{ \"t0\": ({}), \"t1\": ({}) }},", textures[0], textures[1]);
    let draw = format!(
        "{quad}, textures: [(texture: \"t0\", {}), (texture: \"t1\", {})], program: TextureStages(stages: [({stage}), \
         (color_op: SelectArg1, color_arg1: Texture)])",
        units[0], units[1]
    );
    scene("Nv2a", "name: \"frame\", width: 1, height: 1", &head, &draw)
}

/// Returns a scene in which a displacement map moves a map of positions.
fn moved(inputs: &Value) -> String {
    let plain = "min_filter: Nearest, address: ClampToEdge";
    bumped(
        [&displacement_map(), &place_map()],
        [&format!("{plain}, signed: (true, true, true, true)"), plain],
        &list(&numbers(&inputs["uv"])),
        &format!("color_op: BumpEnvMap, bump_matrix: {}", list(&numbers(&inputs["bumpenvmat"]))),
    )
}

/// Returns a scene with a texel of L6V5U5, which the chip reads as R6G5B5, whose luminance scales the next texture.
fn lit(inputs: &Value) -> String {
    let texel = inputs["texel_L6V5U5"].as_u64().unwrap();
    bumped(
        [
            &format!("format: R6G5B5, source: Texels(width: 1, height: 1, rows: [\"{texel:04x}\"])"),
            &format!("source: Solid(width: 1, height: 1, color: {})", bytes(&inputs["tex1"])),
        ],
        ["signed: (false, true, true, false)", "min_filter: Nearest"],
        "(0.5, 0.5)",
        &format!(
            "color_op: {}, bump_luminance: ({:?}, {:?})",
            super::third_party::named::<ninebit_program::texture_stages::Operation>(inputs["op"].as_str().unwrap()),
            number(&inputs["lscale"]),
            number(&inputs["loffset"])
        ),
    )
}
