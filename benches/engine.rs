//! Measures the scalar engine on whole frames of 640x480: DOT3 of a bilinear normal map with the interpolated light vector, the comparison
//! with the ideal, the cost of state, and planning.
#![allow(missing_docs, clippy::float_arithmetic, clippy::unwrap_used, reason = "a benchmark")]

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use ninebit::engine::{RenderOptions, render};
use ninebit::plan::{Plan, PlanOptions};
use ninebit::state::*;
use ninebit_report::compare::{ALL_CHANNELS, CompareOptions, Mode, compare};
use std::hint::black_box;

const WIDTH: u32 = 640;
const HEIGHT: u32 = 480;

/// Returns a texture of pseudo-random bytes. The speed does not depend on their values, as long as they vary from texel to texel.
fn normal_map() -> Texture {
    let words: Vec<u32> = (0..256 * 256_u32)
        .map(|n| {
            let (x, y) = (n & 255, n >> 8);
            let wave = |a: u32, b: u32| 96 + ((a * 7 + b * 3) & 63);
            0xff00_0000 | wave(x, y) << 16 | wave(y, x) << 8 | (230 + (x ^ y) % 20)
        })
        .collect();
    let texels = Texels { width: 256, height: 256, levels: 1, layers: 1, border: false, words: words.into() };
    let (kind, image) = (TextureKind::TwoDimensional, TextureImage::Texels(texels));
    Texture { name: "normals".to_string(), kind, format: TextureFormat::A8R8G8B8, image }
}

fn input(register: Register, mapping: InputMapping) -> CombinerInput {
    CombinerInput { register, component: Component::Rgb, mapping }
}

/// Returns combiners that compute spare0 = expand(texture0) . expand(primary) and show it unchanged.
fn dot3() -> Combiners {
    let mut rgb = Portion::idle(Component::Rgb);
    rgb.inputs[0] = input(Register::Texture0, InputMapping::ExpandNormal);
    rgb.inputs[1] = input(Register::PrimaryColor, InputMapping::ExpandNormal);
    (rgb.ab_output, rgb.ab_dot_product) = (Register::Spare0, true);
    let stage = GeneralStage { rgb, ..GeneralStage::default() };
    let mut final_combiner = FinalCombiner::showing(FinalRegister::Spare0);
    final_combiner.g = FinalInput { invert: true, ..FinalInput::zero(Component::Alpha) };
    Combiners { stages: vec![stage], final_combiner, ..Combiners::default() }
}

fn scene(perspective: bool) -> Scene {
    let corner = |x: f32, y: f32, diffuse: [u8; 4]| {
        let w = if perspective && y == 0.0 { 2.0 } else { 1.0 };
        let mut vertex = Vertex {
            position: [x * WIDTH as f32, y * HEIGHT as f32, 0.0, w],
            diffuse: VertexColor::Bytes(diffuse),
            ..Vertex::default()
        };
        vertex.texture_coordinates[0] = [2.0 * x, 1.5 * y, 0.0, 1.0];
        vertex
    };
    let vertices = vec![
        corner(0.0, 1.0, [200, 180, 210, 255]),
        corner(1.0, 1.0, [50, 170, 200, 255]),
        corner(1.0, 0.0, [60, 90, 220, 255]),
        corner(0.0, 0.0, [210, 70, 190, 255]),
    ];
    let unit = TextureUnit::new(0);
    let draw = Draw {
        vertices: vertices.into(),
        indices: [0, 1, 2, 3].into(),
        topology: Topology::Quads,
        textures: [Some(unit), None, None, None],
        texture_shader: [0, 1, 2, 3].map(|n| ShaderStage::conventional(n, n == 0)),
        combiners: dot3(),
        ..Draw::default()
    };
    let target = Target { clear_color: [0, 0, 0, 255], ..Target::new(WIDTH, HEIGHT, SurfaceFormat::A8R8G8B8) };
    Scene {
        profile: Profile::Nv10,
        targets: vec![target],
        textures: vec![normal_map()],
        palettes: vec![],
        draws: vec![draw],
    }
}

fn engine(c: &mut Criterion) {
    let mut group = c.benchmark_group("dot3_frame");
    group.throughput(Throughput::Elements(u64::from(WIDTH * HEIGHT))).sample_size(20);
    for (name, perspective) in [("perspective", true), ("flat", false)] {
        let plan = Plan::compile(&scene(perspective), &PlanOptions::default()).unwrap();
        for threads in [1, 2] {
            group.bench_function(format!("{name}/{threads}_thread"), |b| {
                b.iter(|| render(black_box(&plan), &RenderOptions { threads, ..RenderOptions::default() }));
            });
        }
    }
    group.finish();
}

/// Compares the same frame with its ideal. The time is of interest as a multiple of `dot3_frame/perspective/1_thread`.
fn comparison(c: &mut Criterion) {
    let mut group = c.benchmark_group("compare");
    group.throughput(Throughput::Elements(u64::from(WIDTH * HEIGHT))).sample_size(10);
    let plan = Plan::compile(&scene(true), &PlanOptions::default()).unwrap();
    for mode in Mode::ALL {
        let options = CompareOptions { mode: *mode, target: 0, threads: 1, channels: ALL_CHANNELS };
        group.bench_function(mode.name(), |b| b.iter(|| compare(black_box(&plan), &options)));
    }
    group.finish();
}

/// Returns combiners that show a register unchanged, without arithmetic in the general stage.
fn shown(register: FinalRegister) -> Combiners {
    let mut combiners = dot3();
    combiners.stages[0].rgb = Portion::idle(Component::Rgb);
    combiners.final_combiner.inputs[3].register = register;
    combiners
}

/// Measures the cost of state: the same frame with one or more pieces of state added.
fn state(c: &mut Criterion) {
    let mut group = c.benchmark_group("state");
    group.throughput(Throughput::Elements(u64::from(WIDTH * HEIGHT))).sample_size(10);
    let mut bench = |name: &str, change: &dyn Fn(&mut Scene)| {
        let mut scene = scene(true);
        change(&mut scene);
        let plan = Plan::compile(&scene, &PlanOptions::default()).unwrap();
        group.bench_function(name, |b| b.iter(|| render(black_box(&plan), &RenderOptions::default())));
    };
    bench("one_color", &|s| {
        s.draws[0].combiners = shown(FinalRegister::PrimaryColor);
        s.draws[0].vertices.update(|_, v| v.diffuse = VertexColor::Bytes([1, 2, 3, 4]));
    });
    bench("smooth", &|s| s.draws[0].combiners = shown(FinalRegister::PrimaryColor));
    bench("nearest", &|s| {
        s.draws[0].combiners = shown(FinalRegister::Texture0);
        let unit = s.draws[0].textures[0].as_mut().unwrap();
        (unit.min_filter, unit.mag_filter) = (Filter::Nearest, Filter::Nearest);
    });
    bench("bilinear", &|s| s.draws[0].combiners = shown(FinalRegister::Texture0));
    bench("bilinear_dot3", &|_| {});
    bench("bilinear_dot3_blend_add", &|s| {
        let (source, destination) = (BlendFactor::One, BlendFactor::One);
        s.draws[0].blend = Some(Blend { equation: BlendEquation::Add, source, destination });
    });
    bench("bilinear_dot3_blend_replaced", &|s| {
        let (source, destination) = (BlendFactor::One, BlendFactor::Zero);
        s.draws[0].blend = Some(Blend { equation: BlendEquation::Add, source, destination });
    });
    bench("bilinear_dot3_depth", &|s| {
        s.targets[0].depth = Some(DepthBuffer { format: DepthFormat::Z24S8, clear: 0xff_ffff, clear_stencil: 0 });
        s.draws[0].depth_test = Some(DepthTest::new(CompareFunction::LessOrEqual, true));
    });
    bench("nothing_written", &|s| s.draws[0].color_mask = [false; 4]);
    group.finish();
}

fn planning(c: &mut Criterion) {
    let mut scene = scene(true);
    scene.draws = vec![scene.draws[0].clone(); 16];
    c.bench_function("plan/16_draws", |b| b.iter(|| Plan::compile(black_box(&scene), &PlanOptions::default())));
}

criterion_group!(benches, engine, state, comparison, planning);
criterion_main!(benches);
