//! What reading a pixel program costs: a two-stage program as text and as register words, as Direct3D texture stages and as the OpenGL texture
//! environment.
#![allow(missing_docs, reason = "a benchmark")]

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use ninebit::program::registers::{decode, encode};
use ninebit::program::text::{parse, print};
use ninebit::program::texture_environment::{self, BaseFormat, TextureEnvironment, Unit};
use ninebit::program::texture_stages;
use ninebit::state::Profile;

const STAGES: &str = include_str!("../vectors/scenes/programs/dot3.txt");
const TEXT: &str = include_str!("../vectors/scenes/programs/lit.rc");

fn program(c: &mut Criterion) {
    let mut group = c.benchmark_group("program");
    group.bench_function("read and check text", |b| b.iter(|| parse(black_box(TEXT), Profile::Nv10)));
    let Ok(program) = parse(TEXT, Profile::Nv10) else { return };
    group.bench_function("print text", |b| b.iter(|| print(black_box(&program.combiners))));
    let words = encode(&program.combiners, Profile::Nv10);
    group.bench_function("decode words", |b| b.iter(|| decode(black_box(&words))));
    group.bench_function("encode words", |b| b.iter(|| encode(black_box(&program.combiners), Profile::Nv10)));
    let stages = texture_stages::parse(STAGES).unwrap_or_default();
    let context = texture_stages::Context { profile: Profile::Nv10, bound: [true; 4], signed: [false; 4], fog: true };
    group.bench_function("read texture stages", |b| b.iter(|| texture_stages::parse(black_box(STAGES))));
    group.bench_function("lower texture stages", |b| b.iter(|| texture_stages::lower(black_box(&stages), &context)));
    let environment = TextureEnvironment { units: vec![Unit::initial(); 2], color_sum: true };
    let textures = [Some(BaseFormat::Rgba), Some(BaseFormat::Rgba), None, None];
    let context = texture_environment::Context { profile: Profile::Nv10, textures, signed: [false; 4], fog: true };
    group.bench_function("lower texture environment", |b| {
        b.iter(|| texture_environment::lower(black_box(&environment), &context));
    });
    group.finish();
}

criterion_group!(benches, program);
criterion_main!(benches);
