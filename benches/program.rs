//! What reading a pixel program costs: a two-stage program as text and as register words.
#![allow(missing_docs, reason = "a benchmark")]

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use ninebit::program::registers::{decode, encode};
use ninebit::program::text::{parse, print};
use ninebit::state::Profile;

const TEXT: &str = include_str!("../vectors/scenes/programs/lit.rc");

fn program(c: &mut Criterion) {
    let mut group = c.benchmark_group("program");
    group.bench_function("read and check text", |b| b.iter(|| parse(black_box(TEXT), Profile::Nv10)));
    let Ok(program) = parse(TEXT, Profile::Nv10) else { return };
    group.bench_function("print text", |b| b.iter(|| print(black_box(&program.combiners))));
    let words = encode(&program.combiners, Profile::Nv10);
    group.bench_function("decode words", |b| b.iter(|| decode(black_box(&words))));
    group.bench_function("encode words", |b| b.iter(|| encode(black_box(&program.combiners), Profile::Nv10)));
    group.finish();
}

criterion_group!(benches, program);
criterion_main!(benches);
