//! Compares the fast engine with the definition. Both yield the same words and depths in every scene of the repository and in random
//! scenes, with every instruction set, number of threads and policy.
//!
//! A normal run draws the first 2,000 scenes of three random sequences, a plain, a wider and an extreme one, and 100 of a fourth, broad one.
//! `NINEBIT_ENGINE_SCENES` sets this number; a twentieth of it are broad scenes.
//! `NINEBIT_ENGINE_SHARD=k/n` draws every n-th scene, beginning with scene k (from 0). `NINEBIT_ENGINE_MATRIX` is the number of first
//! scenes that are drawn with every instruction set, with 1, 2, 3 and 8 threads, and with bands of several sizes. `NINEBIT_ENGINE_SEED`
//! selects another sequence.
use crate::repository::at;
use crate::scene_files;
use crate::settings::number;
use ninebit_test_support::changed_scene::change;
use ninebit_test_support::frames::difference;
use ninebit_test_support::random_scene;

use ninebit::engine::{Engine, Isa, RenderOptions, Renderer, cleared, render, trace};
use ninebit::frame::Frames;
use ninebit::limits::Limits;
use ninebit::plan::{Plan, PlanOptions};
use ninebit::random::Random;
use ninebit::state::{Named, POLICIES, Policies, Scene};
use ninebit_scene as scene;
use proptest::strategy::{Strategy, ValueTree};
use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};
use sha2::{Digest, Sha256};
use std::path::Path;

/// Renders with the definition and with the fast engine in several ways, each twice. Returns the frames of the definition, or the first
/// difference.
fn compare(plan: &Plan, ways: &[RenderOptions]) -> Result<Frames, String> {
    let scalar = render(plan, &RenderOptions { engine: Engine::Scalar, ..RenderOptions::default() });
    for options in ways {
        let renderer = Renderer::new(plan, options);
        let (mut frames, _) = renderer.render();
        let first = difference(&frames, &scalar, "scalar");
        renderer.clear(&mut frames);
        renderer.redraw(&mut frames);
        if let Some(difference) = first.or_else(|| difference(&frames, &scalar, "scalar")) {
            return Err(format!("{options:?}: {difference}"));
        }
    }
    Ok(scalar)
}

/// Returns options for the fast engine with an instruction set and a number of threads.
fn fast(isa: Isa, threads: usize) -> RenderOptions {
    RenderOptions { threads, isa: Some(isa), ..RenderOptions::default() }
}

#[test]
fn engines_agree_on_every_scene_of_the_repository() {
    let mut complaints = Vec::new();
    for path in scene_files::below(&at("vectors/scenes")) {
        let loaded = scene::load(&path, &Limits::default()).unwrap();
        if let Err(difference) = compare(&loaded.plan, &[fast(Isa::best(), 1), fast(Isa::Baseline, 3)]) {
            complaints.push(format!("{}: {difference}", path.display()));
        }
    }
    assert!(complaints.is_empty(), "{}", complaints.join("\n"));
}

/// Returns the instruction sets that the machine has.
fn available() -> Vec<Isa> {
    Isa::ALL.iter().copied().filter(|isa| isa.is_available()).collect()
}

/// Returns all combinations of instruction sets, threads and rows of a band.
fn every_way() -> Vec<RenderOptions> {
    let mut ways = Vec::new();
    for isa in available() {
        for threads in [1, 2, 3, 8] {
            for band in [None, Some(2), Some(6), Some(16), Some(4096)] {
                ways.push(RenderOptions { band, ..fast(isa, threads) });
            }
        }
    }
    ways
}

/// Returns a scene of a sequence in a form that can be shrunk.
pub(crate) fn tree<S: Strategy<Value = Scene>>(sequence: &S, seed: u32, number: u32) -> S::Tree {
    let mut bytes = [0; 32];
    bytes[..4].copy_from_slice(&seed.to_le_bytes());
    bytes[4..8].copy_from_slice(&number.to_le_bytes());
    let rng = TestRng::from_seed(RngAlgorithm::ChaCha, &bytes);
    let mut runner = TestRunner::new_with_rng(Config { failure_persistence: None, ..Config::default() }, rng);
    sequence.new_tree(&mut runner).unwrap()
}

/// Returns policies for a scene of the sequence: random values for all rules, or for a single rule.
fn policies(seed: u32, number: u32) -> Policies {
    let bytes = Sha256::digest([seed.to_le_bytes(), number.to_le_bytes()].concat());
    let alone = (number % 2 == 1).then_some(usize::from(bytes[31]) % POLICIES.len());
    let mut policies = Policies::DEFAULT;
    for (n, policy) in POLICIES.iter().enumerate().filter(|(n, _)| alone.is_none_or(|alone| alone == *n)) {
        policies.choose(policy.rule, usize::from(bytes[n]) % policy.values.len());
    }
    policies
}

/// Returns the first 64 bits of the SHA-256 of a frame's words and depths, for the digest of the run.
fn digest(frames: &Frames) -> u64 {
    let mut hash = Sha256::new();
    for surface in &frames.surfaces {
        let bytes: Vec<u8> = surface.words.iter().chain(&surface.depth).flat_map(|word| word.to_le_bytes()).collect();
        hash.update(bytes);
    }
    u64::from_be_bytes(hash.finalize()[..8].try_into().unwrap())
}

/// Draws the scenes of a sequence with both engines, under the default policies and under others; only one of `one_of` scenes of a usual
/// sequence. The digest is a sum, so the sums of all shards add up to the digest of an undivided run.
fn agree(sequence: &impl Strategy<Value = Scene>, matrix: u32, one_of: u32) {
    let (scenes, seed) =
        (number("NINEBIT_ENGINE_SCENES", 2_000_u32).div_ceil(one_of), number("NINEBIT_ENGINE_SEED", 5));
    let shard = std::env::var("NINEBIT_ENGINE_SHARD").unwrap_or_else(|_| "0/1".to_owned());
    let (first, step) = shard.split_once('/').expect("NINEBIT_ENGINE_SHARD is k/n");
    let (first, step) = (first.parse::<u32>().unwrap(), step.parse::<usize>().unwrap());
    let every_way = every_way();
    let best = [fast(Isa::best(), 1)];
    let available = available();
    let check = |number: u32, scene: &Scene| {
        // Under other policies a scene is drawn by another instruction set, too.
        let other = [fast(available[number as usize / 2 % available.len()], 1)];
        let [ways, others] = if number < matrix { [&every_way[..]; 2] } else { [&best[..], &other] };
        let policies = policies(seed, number);
        // A panic counts as a difference, so that its scene is shrunk as well.
        let compared = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| {
            let plan = |prune| Plan::compile(scene, &PlanOptions { prune, ..PlanOptions::default() }).unwrap();
            if number < matrix {
                compare(&plan(false), &best)?;
            }
            let plan = plan(true);
            compare(&plan.clone().under(policies), others).map_err(|why| format!("{policies:?}: {why}"))?;
            compare(&plan, ways)
        }));
        compared.unwrap_or_else(|panic| {
            let text = panic.downcast_ref::<String>().cloned();
            Err(text.unwrap_or_else(|| "a panic".to_owned()))
        })
    };
    let (mut count, mut sum) = (0_u32, 0_u64);
    for number in (first..scenes).step_by(step) {
        let mut tree = tree(sequence, seed, number);
        match check(number, &tree.current()) {
            Ok(frames) => (count, sum) = (count + 1, sum.wrapping_add(digest(&frames))),
            Err(reason) => {
                simplify(&mut tree, |scene| check(number, scene).is_err());
                let simplest = tree.current();
                let told = check(number, &simplest).err();
                panic!("scene {number}: {reason}\nat its simplest: {told:?} {simplest:#?}");
            }
        }
    }
    println!("{count} scenes, digest {sum:016x}");
}

/// Draws a scene in RON with both engines.
fn agree_on(text: &str, what: &str) {
    let loaded = scene::parse(text, Path::new("scene.ron"), &Limits::default())
        .unwrap_or_else(|error| panic!("{what}: {error}"));
    if let Err(difference) = compare(&loaded.plan, &[fast(Isa::best(), 1), fast(Isa::Baseline, 1)]) {
        panic!("{what}: {difference}");
    }
}

/// Frames that do not belong to a plan are replaced by its own.
#[test]
fn foreign_frames_are_replaced() {
    let plan = scene::load(&at("vectors/scenes/clipping/corridor.ron"), &Limits::default()).unwrap().plan;
    let renderer = Renderer::new(&plan, &RenderOptions::default());
    let (own, _) = renderer.render();
    let mut short = own.clone();
    short.surfaces[0].words.pop();
    for mut frames in [short, Frames { surfaces: Vec::new() }] {
        renderer.redraw(&mut frames);
        assert!(frames == own);
    }
}

/// Threads clear what one does, with depths and with initial contents, and draw the same picture again.
#[test]
fn cleared_frames_are_as_before_the_first_draw() {
    for (name, has_contents) in [("sampling/shadow-map", false), ("buffers/bytes", false), ("clipping/corridor", true)]
    {
        let path = at("vectors/scenes").join(name).with_extension("ron");
        let mut scene = scene::load(&path, &Limits::default()).unwrap().scene;
        if has_contents {
            let target = &mut scene.targets[0];
            target.contents = Some((0..target.width * target.height).collect());
        }
        let plan = Plan::compile(&scene, &PlanOptions::default()).unwrap();
        for threads in 1..=3 {
            let renderer = Renderer::new(&plan, &RenderOptions { threads, ..RenderOptions::default() });
            let (drawn, _) = renderer.render();
            let mut frames = drawn.clone();
            renderer.clear(&mut frames);
            assert!(frames == cleared(&plan), "{name}, {threads} threads");
            renderer.redraw(&mut frames);
            assert!(frames == drawn, "{name}, {threads} threads");
        }
    }
}

#[test]
fn traces_of_what_is_not_there_are_refused() {
    let plan = scene::load(&at("vectors/scenes/clipping/corridor.ron"), &Limits::default()).unwrap().plan;
    for (target, pixel, draw) in [(7, (0, 0), None), (0, (100_000, 0), None), (0, (0, 0), Some(7))] {
        assert!(trace(&plan, target, pixel, draw).is_err(), "{target} {pixel:?} {draw:?}");
    }
}

#[test]
fn engines_agree_on_random_scenes() {
    agree(&random_scene::scene(), number("NINEBIT_ENGINE_MATRIX", 12), 1);
}

/// Scenes whose draws share resources, with extreme numbers, programs of every language, and vertices behind the viewer.
#[test]
fn engines_agree_on_wider_random_scenes() {
    agree(&random_scene::wide::scene(), number("NINEBIT_ENGINE_MATRIX", 12), 1);
}

/// Scenes of long rows, large textures, and meshes of small triangles. They take longer, so there are fewer.
#[test]
fn engines_agree_on_broad_random_scenes() {
    agree(&random_scene::wide::broad::scene(), number("NINEBIT_ENGINE_MATRIX", 12) / 4, 20);
}

/// Scenes whose numbers lie at limits, where roundings tie, or are copied from field to field.
#[test]
fn engines_agree_on_extreme_random_scenes() {
    agree(&random_scene::wide::extreme::scene(), number("NINEBIT_ENGINE_MATRIX", 12) / 2, 2);
}

/// Depth and offset need more bits than the definition keeps, and a limit of the range is what their sum rounds to.
#[test]
fn engines_agree_on_sums_of_depths_at_a_limit() {
    for (format, z, limit, bias) in [
        ("Z24S8", "1e-12", "16777215", "16777215"),
        ("Z24S8F", "1e-10", "1073741824", "1073741824"),
        ("Z16", "-1e-30", "4096", "4096"),
        ("Z16F", "1e-45", "65536", "65536"),
    ] {
        for (lowest, highest) in [("0", limit), (limit, "1e38")] {
            for clamps in [false, true] {
                let vertices =
                    [(0, 0), (16, 0), (0, 16)].map(|(x, y)| format!("(position: ({x}, {y}, {z}))")).join(", ");
                let text = format!(
                    "(version: 1, profile: Nv2a, targets: [(width: 16, height: 16, depth: {format}, clear: (depth: 0))],
                      draws: [(vertices: Window([{vertices}]), depth_test: (function: GreaterOrEqual, vertex_depths: Steps,
                        range: (lowest: {lowest}, highest: {highest}, clamp: {clamps}), offset: (bias: {bias})))])"
                );
                agree_on(&text, &format!("{format} {z} + {bias} in {lowest} to {highest}, clamps {clamps}"));
            }
        }
    }
}

/// Two rows of a sliver's quads lie further apart than a block is wide, so that blocks of quads have no pixel.
#[test]
fn engines_agree_on_slivers() {
    for test in ["", "alpha_test: (function: Greater, reference: 0),"] {
        for y in [1.0625, 1.125] {
            let text = format!(
                "(version: 1, profile: Nv2a, targets: [(width: 640, height: 4, depth: Z16)],
                  textures: {{ \"t\": (source: Checker(width: 64, height: 64, cell: 4, colors: ((255, 0, 9), (3, 200, 90, 0))), levels: All) }},
                  draws: [(depth_test: (function: LessOrEqual, vertex_depths: Steps), {test}
                    textures: [(texture: \"t\", min_filter: Linear, mag_filter: Linear, mip_filter: Linear)],
                    program: Combiners(stages: [(rgb: (a: Texture0, b: Texture0, ab: Spare0))], final_combiner: (d: Spare0, g: Texture0)),
                    vertices: Window([(position: (0, 0.3125, 9), t0: (0, 0)), (position: (600, 1.6875, 9), t0: (9, 0)), (position: (300, {y}, 9), t0: (0, 7)),
                      (position: (0, 2, 8)), (position: (640, 2, 8), t0: (9, 0)), (position: (0, 4, 8), t0: (0, 9))]))])"
            );
            agree_on(&text, &format!("{y} {test}"));
        }
    }
}

/// Scenes of the repository, changed at random: every other one once, or each as often as `NINEBIT_ENGINE_CHANGES` says.
#[test]
fn engines_agree_on_changed_scenes() {
    let (changes, seed) = (number("NINEBIT_ENGINE_CHANGES", 1_u64), number("NINEBIT_ENGINE_SEED", 5_u64));
    let (available, mut drawn, mut refused, mut complaints) = (available(), 0, 0, Vec::new());
    for path in scene_files::below(&at("vectors/scenes")).into_iter().step_by(if changes == 1 { 2 } else { 1 }) {
        let original = scene::load(&path, &Limits::default()).unwrap().scene;
        for number in 0..changes {
            let mut scene = original.clone();
            change(&mut scene, &mut Random::new(seed + number, &path.file_name().unwrap().to_string_lossy()));
            let Ok(plan) = Plan::compile(&scene, &PlanOptions::default()) else {
                refused += 1;
                continue;
            };
            drawn += 1;
            let other = fast(available[number as usize % available.len()], 2);
            if let Err(difference) = compare(&plan, &[fast(Isa::best(), 1), other]) {
                complaints.push(format!("{} with seed {}: {difference}", path.display(), seed + number));
            }
        }
    }
    println!("{drawn} changed scenes, {refused} refused");
    assert!(complaints.is_empty(), "{}", complaints.join("\n"));
    assert!(refused < drawn);
}

/// Shrinks a value as long as it still fails.
pub(crate) fn simplify<T: ValueTree>(tree: &mut T, fails: impl Fn(&T::Value) -> bool) {
    for _ in 0..20_000 {
        if !tree.simplify() {
            return;
        }
        while !fails(&tree.current()) {
            if !tree.complicate() {
                return;
            }
        }
    }
}

/// Two units of a draw, and a second draw, sample one texture with different state. Nothing that the engine caches for one state may be
/// used for another.
#[test]
fn engines_agree_on_textures_that_states_share() {
    let states = [
        "min_filter: Nearest, mag_filter: Nearest",
        "min_filter: Linear, mag_filter: Linear",
        "min_filter: Linear, mag_filter: Nearest",
        "min_filter: Linear, mag_filter: Nearest, mip_filter: Nearest",
        "min_filter: Nearest, mag_filter: Linear, mip_filter: Linear",
        "mip_filter: Linear, lod_bias: 1.5",
        "mip_filter: Nearest, max_lod: 2",
        "mip_filter: Linear, min_lod: 3.5",
        "address: ClampToEdge",
        "address: ClampToBorder, border_color: (200, 3, 90, 17)",
        "address: ClampToBorder, border_color: (3, 200, 17, 90), mip_filter: Linear",
        "address_s: Mirror, mip_filter: Linear",
        "signed: (true, false, true, false)",
        "signed: (false, true, false, true), mip_filter: Linear",
    ];
    let image = |face: u32| {
        let word = |x: u32, y: u32| format!("{:08x}", (face << 16 | y << 8 | x).wrapping_mul(0x9e37_79b9));
        let row = |y: u32| format!("\"{}\"", (0..32).map(|x| word(x, y)).collect::<Vec<_>>().join(" "));
        format!("Texels(width: 32, height: 32, rows: [{}])", (0..32).map(row).collect::<Vec<_>>().join(", "))
    };
    let faces = ["positive_x", "negative_x", "positive_y", "negative_y", "positive_z", "negative_z"];
    let faces = (0..6).map(|n| format!("{}: {}", faces[n], image(n as u32))).collect::<Vec<_>>().join(", ");
    let faces = format!("Faces({faces})");
    let flat = (image(7), "(0, 0)", "(24, 0)", "(0, 24)");
    let cube = (faces, "(1, -1, -1)", "(1, -1, 1)", "(-0.2, 1, 0.4)");
    for (format, (source, a, b, c)) in
        ["A8R8G8B8", "R16B16"].into_iter().flat_map(|format| [(format, &flat), (format, &cube)])
    {
        let texture = format!(r#""a": (source: {source}, format: {format}, levels: All)"#);
        for (n, first) in states.iter().enumerate() {
            for second in &states {
                let third = states[(n + 5) % states.len()];
                let vertex = |x, y, w, at| format!("(position: ({x}, {y}, 0, {w}), t0: {at}, t1: {at})");
                let vertices = [vertex(0, 96, 1, a), vertex(96, 96, 1, b), vertex(0, 0, 2, c)].join(", ");
                let draw = |units: String, program: &str| {
                    format!("(vertices: Window([{vertices}]), textures: [{units}], program: Combiners({program}))")
                };
                let unit = |state: &str| format!(r#"(texture: "a", {state})"#);
                let both = draw(
                    format!("{}, {}", unit(first), unit(second)),
                    "stages: [(rgb: (a: SignedIdentity(Texture0), b: UnsignedInvert(Zero), c: Texture1, d: UnsignedInvert(Zero),
                     sum: Spare0))], final_combiner: (d: Spare0, g: (Texture1, Alpha))",
                );
                let one = draw(unit(third), "stages: [()], final_combiner: (d: Texture0)");
                let text = format!(
                    "(version: 1, profile: Nv2a, targets: [(name: \"a\", width: 96, height: 96), (name: \"b\", width: 96, height: 96)], textures: {{ {texture} }},
                      draws: [{both}, {}])",
                    one.replacen('(', "(target: \"b\", ", 1)
                );
                agree_on(&text, &format!("{format} | {first} | {second} | {third}"));
            }
        }
    }
}

/// A volume with few layers follows one with many. Lanes without a pixel must not access layers that only the earlier volume has.
#[test]
fn engines_agree_on_a_smaller_volume_after_a_larger_one() {
    let layers = |count: usize| {
        let layer = |n: usize| format!("Solid(width: 4, height: 4, color: ({}, {}, 90))", 15 * n, 255 - 10 * n);
        format!("(source: Layers([{}]))", (0..count).map(layer).collect::<Vec<_>>().join(", "))
    };
    let draw = |texture: &str, [x, y]: [u32; 2], [width, height]: [u32; 2], r: f32| {
        let corner = |x, y, s, t, r| format!("(position: ({x}, {y}), t0: ({s}, {t}, {r}, 1))");
        let (right, below) = (x + width, y + height);
        let corners = [
            corner(x, y, 0, 0, r),
            corner(right, y, 1, 0, r),
            corner(right, below, 1, 1, 0.9 * r),
            corner(x, below, 0, 1, r),
        ];
        format!(
            "(vertices: Window([{}]), topology: Quads, textures: [(texture: \"{texture}\", min_filter: Nearest, address: ClampToEdge, \
             address_r: ClampToEdge)], program: Combiners(stages: [()], final_combiner: (d: Texture0)))",
            corners.join(", ")
        )
    };
    for width in [1, 2, 3, 5, 8, 17, 40, 200] {
        for height in [1, 2, 3, 5, 8, 33] {
            let text = format!(
                "(version: 1, profile: Nv2a, targets: [(name: \"frame\", width: 512, height: 64)], \
                 textures: {{ \"large\": {}, \"small\": {} }}, draws: [{}, {}])",
                layers(16),
                layers(2),
                draw("large", [0, 0], [512, 64], 0.97),
                draw("small", [7, 3], [width, height], 0.6)
            );
            agree_on(&text, &format!("{width} x {height}"));
        }
    }
}

/// Stages of a texture shader sample at the same coordinates, and some of their colours are not read.
#[test]
fn engines_agree_on_stages_with_equal_coordinates() {
    let bump = "(operation: BumpEnvironment(matrix: (0.5, 0, 0.7, 0)), coordinates: 0, previous: 0)";
    for stages in [
        format!("Sample, (operation: Sample, coordinates: 0), {bump}, (operation: Sample, coordinates: 0)"),
        format!("Sample, Sample, {bump}, (operation: Sample, coordinates: 0)"),
    ] {
        for [a, b] in
            [["Texture0", "Texture3"], ["Texture1", "Texture3"], ["Texture2", "Texture3"], ["Texture3", "Zero"]]
        {
            let vertex = |x, y, at| format!("(position: ({x}, {y}), t0: {at}, t1: {at})");
            let vertices = [vertex(0, 0, "(0, 0, 0, 2)"), vertex(32, 0, "(9, 0, 0, 2)"), vertex(0, 32, "(0, 9, 0, 2)")];
            let text = format!(
                "(version: 1, profile: Nv2a, targets: [(width: 32, height: 32)],
                  textures: {{ \"a\": (source: Checker(width: 8, height: 8, colors: ((10, 200, 90), (70, 30, 120)))) }},
                  draws: [(vertices: Window([{}]), textures: [{}], texture_shader: [{stages}],
                    program: Combiners(stages: [(rgb: (a: {a}, b: UnsignedInvert(Zero), c: {b}, d: UnsignedInvert(Zero), sum: Spare0))],
                      final_combiner: (d: Spare0)))])",
                vertices.join(", "),
                [r#"(texture: "a")"#; 4].join(", "),
            );
            agree_on(&text, &format!("{stages} | {a} + {b}"));
        }
    }
}

/// A colour key changes channels that are constants of the format. The scene draws the image, so that its texels are not known before.
#[test]
fn engines_agree_on_colour_keys_of_drawn_images() {
    let corners = "(position: (0, 0), t0: (0, 0)), (position: (64, 0), t0: (64, 0)), (position: (64, 64), t0: (64, 64)), (position: (0, 64), t0: (0, 64))";
    for (format, key) in [("A8", "(255, 255, 255, 0)"), ("L8", "(255, 255, 255, 255)"), ("L8", "(0, 0, 0, 255)")] {
        for mode in ["Alpha", "Color", "Texel"] {
            let text = format!(
                r#"(version: 1, profile: Nv2a,
                  targets: [(name: "picture", width: 64, height: 64, format: B8), (name: "frame", width: 64, height: 64)],
                  textures: {{ "picture": (kind: Rectangle, format: {format}, source: Target("picture")) }},
                  draws: [
                    (target: "picture", vertices: Window([(position: (3, 5), diffuse: (255, 255, 255)), (position: (60, 9), diffuse: (255, 255, 255)),
                       (position: (30, 61), diffuse: (255, 255, 255))]), program: Combiners(stages: [()], final_combiner: (d: PrimaryColor))),
                    (target: "frame", vertices: Window([{corners}]), topology: Quads,
                      textures: [(texture: "picture", min_filter: Nearest, mag_filter: Nearest, color_key: (color: {key}, mode: {mode}))],
                      program: Combiners(stages: [()], final_combiner: (d: Texture0, g: (Texture0, Alpha)))),
                  ])"#
            );
            agree_on(&text, &format!("{format} {key} {mode}"));
        }
    }
}

/// q is 0 along an edge, because the numbers of both vertices vanish beside that of the third. One pixel lies on the edge, alone or in a row.
#[test]
fn engines_agree_on_quotients_by_zero() {
    let pairs = [
        ("1, -0.25, 1, -1", "1e20, -2.5e19, 1e19, -1e20"),
        ("1, -0.25, 1, -1", "3e19, 1e20, -1e20, -1e20"),
        ("0, 0, 0, 0", "1, -0.25, 0.5, 1"),
    ];
    for ((small, large), right) in pairs.iter().flat_map(|pair| [4, 9, 90].map(|right| (pair, right))) {
        let corner = |at: &str, numbers: &str| format!("(position: ({at}), t0: ({numbers}), t1: ({numbers}))");
        let corners = [corner("4, 3", small), corner("-4, 43", small), corner(&format!("{right}, 43"), large)];
        let text = format!(
            r#"(version: 1, profile: Nv2a, targets: [(name: "frame", width: 96, height: 64), (name: "lamp", width: 16, height: 16, depth: Z16)],
              textures: {{ "a": (source: Checker(width: 16, height: 16, colors: ((10, 200, 90), (70, 30, 120)))),
                "depths": (kind: Rectangle, source: Depth("lamp")) }},
              draws: [(vertices: Window([{}]), textures: [
                  (texture: "a", min_filter: Nearest, mag_filter: Nearest, address_t: ClampToBorder, border_color: (0, 0, 135, 0)),
                  (texture: "depths", address: ClampToEdge, min_filter: Nearest, mag_filter: Nearest, shadow: (function: LessOrEqual))],
                program: Combiners(stages: [()], final_combiner: (d: Texture0, g: (Texture1, Alpha))))])"#,
            corners.join(", ")
        );
        agree_on(&text, &format!("{right} {large}"));
    }
}

/// One pixel, for which decoding a texture would not pay. The other lanes hold what a pixel may hold, so that nothing overflows in them.
#[test]
fn engines_agree_on_signed_texels_beside_lanes_without_a_pixel() {
    // The last vertex makes the colour vary, but its triangle covers no pixel.
    let vertex = |at, blue| format!("(position: {at}, diffuse: (255, 255, {blue}), specular: (255, 255, 255))");
    let vertices = [("(-1, 1)", 255), ("(-1, 2)", 255), ("(9, 4)", 255), ("(9, 4)", 128)];
    let vertices = vertices.map(|(at, blue)| vertex(at, blue)).join(", ");
    for constant in 120..136 {
        let text = format!(
            r#"(version: 1, profile: Nv2a, targets: [(width: 4, height: 4)],
              textures: {{ "a": (source: Checker(width: 64, height: 64, colors: ((10, 200, 90), (70, 30, 120)))) }},
              draws: [(vertices: Window([{vertices}]), topology: TriangleStrip,
                textures: ["a", (texture: "a", signed: (false, false, false, true)), "a", "a"],
                texture_shader: [Sample, Sample, Sample, (operation: BumpEnvironment(matrix: (0, 0, 0, 0)), previous: 0)],
                program: Combiners(
                  stages: [(constants: ((0, 0, 0), (0, 0, {constant})), alpha: (a: (PrimaryColor, Alpha), b: (ConstantColor1, Blue),
                    c: (PrimaryColor, Alpha), d: HalfBiasNormal(Texture1, Alpha), sum: Texture3))],
                  final_combiner: (a: PrimaryColor, b: Invert(Texture3, Alpha), c: Spare0PlusSecondary))
              )])"#
        );
        agree_on(&text, &constant.to_string());
    }
}
