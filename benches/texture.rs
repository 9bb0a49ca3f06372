//! Measures the cost of a texture unit for each pixel that it samples, by filter, number of levels, kind and format, on the scalar engine
//! with one thread.
//!
//! The scene is a quad of 256 x 256 pixels. `nothing` is the same quad in one colour; its time is to be subtracted.
#![allow(clippy::float_arithmetic, clippy::unwrap_used, missing_docs, unreachable_pub, reason = "a benchmark")]

#[path = "../tests/common/build.rs"]
mod build;

use build::{draw, target, vertex};
use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use ninebit::engine::{RenderOptions, render};
use ninebit::plan::{Plan, PlanOptions};
use ninebit::state::*;
use std::hint::black_box;

const SIDE: u32 = 256;

/// Returns a texture whose words vary from texel to texel.
fn texture(kind: TextureKind, format: TextureFormat, levels: u32) -> Texture {
    let (_, face) = Level::chain(format, SIDE, SIDE, levels, false);
    let faces = if kind == TextureKind::Cube { CUBE_FACES as usize } else { 1 };
    let mask = if format.bytes() < 4 { (1 << (8 * format.bytes())) - 1 } else { u32::MAX };
    let words = (0..faces * face).map(|n| (n as u32).wrapping_mul(2_654_435_761) & mask).collect();
    let texels = Texels { width: SIDE, height: SIDE, levels, layers: 1, border: false, words };
    Texture { name: "texture".to_string(), kind, format, image: TextureImage::Texels(texels) }
}

/// Returns a scene of one quad, in which a pixel steps over `ratio` texels.
fn scene(texture: Option<Texture>, unit: TextureUnit, ratio: f32) -> Scene {
    let side = SIDE as f32;
    let scale = match &texture {
        Some(Texture { kind: TextureKind::Rectangle, .. }) => side,
        _ => 1.0,
    };
    let vertices = [(0.0, 0.0), (side, 0.0), (side, side), (0.0, side)].map(|(x, y)| {
        let mut vertex = vertex(x, y, [255; 4]);
        let [s, t] = [x, y].map(|n| (n / side * 0.9 + 0.03) * ratio * scale);
        vertex.texture_coordinates = [[s, t, 0.0, 1.0]; 4];
        if let Some(Texture { kind: TextureKind::Cube, .. }) = texture {
            vertex.texture_coordinates = [[2.0 * s - 1.0, 0.9 - 2.0 * t, 1.0, 1.0]; 4];
        }
        vertex
    });
    let mut draw = draw(Topology::Quads, vertices.to_vec());
    if texture.is_some() {
        draw.textures[0] = Some(unit);
        draw.texture_shader[0] = ShaderStage::conventional(0, true);
        draw.combiners = Combiners::showing(FinalRegister::Texture0);
    }
    Scene {
        profile: Profile::Nv2a,
        targets: vec![target(SIDE, SIDE, SurfaceFormat::A8R8G8B8, [0; 4])],
        textures: texture.into_iter().collect(),
        palettes: vec![Palette { name: "palette".to_string(), entries: (0..256).map(|n| n * 0x0101_0101).collect() }],
        draws: vec![draw],
    }
}

fn units(c: &mut Criterion) {
    let mut group = c.benchmark_group("texture_unit");
    group.throughput(Throughput::Elements(u64::from(SIDE * SIDE))).sample_size(20);
    let mut bench = |name: &str, texture: Option<Texture>, unit: TextureUnit, ratio: f32| {
        let plan = Plan::compile(&scene(texture, unit, ratio), &PlanOptions::default()).unwrap();
        group.bench_function(name, |b| b.iter(|| render(black_box(&plan), &RenderOptions::default())));
    };
    let (flat, argb) = (TextureKind::TwoDimensional, TextureFormat::A8R8G8B8);
    let nearest = TextureUnit { min_filter: Filter::Nearest, mag_filter: Filter::Nearest, ..TextureUnit::new(0) };
    let bilinear = TextureUnit::new(0);
    let trilinear = TextureUnit { mip_filter: MipFilter::Linear, ..bilinear };
    let paletted = TextureUnit { palette: Some(0), ..nearest };
    bench("nothing", None, nearest, 1.0);
    bench("nearest", Some(texture(flat, argb, 1)), nearest, 1.0);
    bench("bilinear", Some(texture(flat, argb, 1)), bilinear, 1.0);
    bench(
        "nearest_level",
        Some(texture(flat, argb, 9)),
        TextureUnit { mip_filter: MipFilter::Nearest, ..bilinear },
        3.0,
    );
    bench("trilinear", Some(texture(flat, argb, 9)), trilinear, 3.0);
    bench("rectangle_nearest", Some(texture(TextureKind::Rectangle, argb, 1)), nearest, 1.0);
    bench("cube_nearest", Some(texture(TextureKind::Cube, argb, 1)), nearest, 1.0);
    bench("cube_bilinear", Some(texture(TextureKind::Cube, argb, 1)), bilinear, 1.0);
    bench("cube_trilinear", Some(texture(TextureKind::Cube, argb, 9)), trilinear, 3.0);
    // Compressed texels are decoded at each access. The same filter on A8R8G8B8 is the limit for a cache of decoded texels.
    bench("dxt1_nearest", Some(texture(flat, TextureFormat::Dxt1, 1)), nearest, 1.0);
    bench("dxt1_bilinear", Some(texture(flat, TextureFormat::Dxt1, 1)), bilinear, 1.0);
    bench("dxt5_bilinear", Some(texture(flat, TextureFormat::Dxt5, 1)), bilinear, 1.0);
    bench("r5g6b5_bilinear", Some(texture(flat, TextureFormat::R5G6B5, 1)), bilinear, 1.0);
    bench("palette_nearest", Some(texture(flat, TextureFormat::P8, 1)), paletted, 1.0);
    bench("r16b16_bilinear", Some(texture(flat, TextureFormat::R16B16, 1)), bilinear, 1.0);
    group.finish();
}

criterion_group!(benches, units);
criterion_main!(benches);
