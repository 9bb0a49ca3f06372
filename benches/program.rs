//! Measures how long it takes to read a pixel program: a program of two stages as text, as register words, as Direct3D texture stages and
//! as an OpenGL texture environment, and a pixel shader of eight instructions. Also measures reading and planning a scene of a thousand
//! draws.
#![allow(missing_docs, reason = "a benchmark")]

use std::hint::black_box;
use std::path::Path;

use criterion::{Criterion, criterion_group, criterion_main};
use ninebit::limits::Limits;
use ninebit::plan::{Plan, PlanOptions};
use ninebit::state::Profile;
use ninebit_program::pixel_shader;
use ninebit_program::registers::{decode, encode};
use ninebit_program::text::{parse, print};
use ninebit_program::texture_environment::{self, BaseFormat, TextureEnvironment, Unit};
use ninebit_program::texture_stages;
use ninebit_scene as scene;

const STAGES: &str = include_str!("../vectors/scenes/programs/dot3.txt");
const TEXT: &str = include_str!("../vectors/scenes/programs/lit.rc");

const SHADER: &str = "ps.1.1
tex t0 // normals
tex t1
tex t2
dp3_sat r0, t0_bx2, v0_bx2
dp3_sat r1, t0_bx2, v1_bx2
mul r1.rgb, r1, r1
+ mul r1.a, r1, r1.b
mad_x2_sat r0, r0, t1, c0
lrp r0.rgb, t2.a, r0, t2
mul r1, r1, r1
mad r0, r1, 1-c1, r0
";

fn program(c: &mut Criterion) {
    let mut group = c.benchmark_group("program");
    group.bench_function("read and check text", |b| b.iter(|| parse(black_box(TEXT), Profile::Nv10)));
    let Ok(program) = parse(TEXT, Profile::Nv10) else { return };
    group.bench_function("print text", |b| b.iter(|| print(black_box(&program.combiners))));
    let words = encode(&program.combiners, Profile::Nv10);
    group.bench_function("decode words", |b| b.iter(|| decode(black_box(&words))));
    group.bench_function("encode words", |b| b.iter(|| encode(black_box(&program.combiners), Profile::Nv10)));
    let stages = texture_stages::parse(STAGES).map(|pasted| pasted.program).unwrap_or_default();
    let context = texture_stages::Context { profile: Profile::Nv10, bound: [true; 4], signed: [false; 4], fog: true };
    group.bench_function("read texture stages", |b| b.iter(|| texture_stages::parse(black_box(STAGES))));
    group.bench_function("lower texture stages", |b| b.iter(|| texture_stages::lower(black_box(&stages), &context)));
    let environment = TextureEnvironment { units: vec![Unit::initial(); 2], color_sum: true };
    let textures = [Some(BaseFormat::Rgba), Some(BaseFormat::Rgba), None, None];
    let context = texture_environment::Context { profile: Profile::Nv10, textures, signed: [false; 4], fog: true };
    group.bench_function("lower texture environment", |b| {
        b.iter(|| texture_environment::lower(black_box(&environment), &context));
    });
    let context = pixel_shader::Context::new(Profile::Nv2a);
    group.bench_function("read and lower a pixel shader", |b| {
        b.iter(|| {
            pixel_shader::parse(black_box(SHADER)).and_then(|parsed| pixel_shader::lower(&parsed.program, &context))
        });
    });
    group.finish();
}

/// Returns the text of a scene of a thousand draws. Each draw has textures, blending and a program in one of three languages.
fn thousand_draws() -> String {
    let draw = |n: usize| {
        let (x, y) = (n % 32 * 16, n / 32 * 8);
        let program = match n % 3 {
            0 => {
                "TextureStages(stages: [(color_op: Modulate, color_arg1: Texture, color_arg2: Diffuse), \
                  (color_op: AddSigned, color_arg1: Texture, color_arg2: Current)])"
            }
            1 => "TextureEnvironment(units: [(mode: Combine, combine_rgb: Interpolate), (mode: Add)])",
            _ => "Combiners(stages: [(rgb: (a: Texture0, b: PrimaryColor, c: Texture1, d: Spare0, sum: Spare0))])",
        };
        format!(
            "(vertices: Window([(position: ({x}, {y}), t0: (0, 0)), (position: ({r}, {y}), t0: (1, 0)), (position: ({r}, {b}), \
             t0: (1, 1)), (position: ({x}, {b}), t0: (0, 1))]), topology: Quads, textures: [\"a\", (texture: \"b\", coordinates: 0)], \
             program: {program}, blend: (source: SourceAlpha, destination: OneMinusSourceAlpha))",
            r = x + 16,
            b = y + 8
        )
    };
    let draws: Vec<String> = (0..1000).map(draw).collect();
    let texture = "(source: Checker(width: 16, height: 16))";
    format!(
        "(version: 1, profile: Nv2a, textures: {{ \"a\": {texture}, \"b\": {texture} }}, draws: [{}])",
        draws.join(", ")
    )
}

fn large_scene(c: &mut Criterion) {
    let text = thousand_draws();
    let read = || scene::parse(black_box(&text), Path::new("scene.ron"), &Limits::default());
    let Ok(loaded) = read() else { return };
    let mut group = c.benchmark_group("a thousand draws");
    group.bench_function("read and plan", |b| b.iter(read));
    group.bench_function("plan", |b| b.iter(|| Plan::compile(black_box(&loaded.scene), &PlanOptions::default())));
    group.finish();
}

criterion_group!(benches, program, large_scene);
criterion_main!(benches);
