//! Measures one DOT3 stage in three evaluations from the same source: traced scalar, float64, and blocks of 128 pixels in 16 bits.
//!
//! The stage computes spare0.rgb = expand(texture0) . expand(primary), which the final combiner reads through the unsigned identity. Every
//! evaluation calls the same `expand_normal`, `dot_product` and `output`.
#![allow(missing_docs, clippy::float_arithmetic, reason = "a benchmark")]

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use multiversion::multiversion;
use ninebit::combiner::general::dot_product;
use ninebit::combiner::mapping::{expand_normal, unsigned_identity};
use ninebit::combiner::output::finished;
use ninebit::number::{Factor, Narrow, Pair, Register, Sum};
use ninebit::random::Random;
use ninebit::state::{Bias, RegisterFloor, Scale};
use std::hint::black_box;

const PIXELS: usize = 128;

/// Evaluates the stage in any register type.
#[inline(always)]
fn dot3<R: Register>(texture: [R; 3], primary: [R; 3]) -> R
where
    <<R as Register>::Expanded as Factor>::Sum: Sum<Register = R>,
{
    let a = texture.map(expand_normal);
    let b = primary.map(expand_normal);
    unsigned_identity(finished(dot_product(a, b).rounded(), Bias::None, Scale::One, RegisterFloor::Full))
}

type Block = [[i16; PIXELS]; 3];

/// Evaluates a block in 16-bit lanes of the general register type.
#[multiversion(targets("x86_64+avx512f+avx512bw+avx512vl", "x86_64+avx2+fma", "aarch64+neon"))]
fn block_general(texture: &Block, primary: &Block, out: &mut [i16; PIXELS]) {
    for n in 0..PIXELS {
        let texel = [texture[0][n], texture[1][n], texture[2][n]];
        out[n] = dot3(texel, [primary[0][n], primary[1][n], primary[2][n]]);
    }
}

/// Evaluates a block in 16-bit lanes whose products of expanded values stay within 16 bits.
#[multiversion(targets("x86_64+avx512f+avx512bw+avx512vl", "x86_64+avx2+fma", "aarch64+neon"))]
fn block_narrow(texture: &Block, primary: &Block, out: &mut [i16; PIXELS]) {
    for n in 0..PIXELS {
        let texel = [texture[0][n], texture[1][n], texture[2][n]].map(Narrow);
        out[n] = dot3(texel, [primary[0][n], primary[1][n], primary[2][n]].map(Narrow)).0;
    }
}

/// Like [`block_narrow`], but limited to AVX2 on processors that have AVX-512.
#[multiversion(targets("x86_64+avx2+fma"))]
fn block_narrow_avx2(texture: &Block, primary: &Block, out: &mut [i16; PIXELS]) {
    for n in 0..PIXELS {
        let texel = [texture[0][n], texture[1][n], texture[2][n]].map(Narrow);
        out[n] = dot3(texel, [primary[0][n], primary[1][n], primary[2][n]].map(Narrow)).0;
    }
}

/// Like [`block_general`], but limited to AVX2.
#[multiversion(targets("x86_64+avx2+fma"))]
fn block_general_avx2(texture: &Block, primary: &Block, out: &mut [i16; PIXELS]) {
    for n in 0..PIXELS {
        let texel = [texture[0][n], texture[1][n], texture[2][n]];
        out[n] = dot3(texel, [primary[0][n], primary[1][n], primary[2][n]]);
    }
}

fn one_by_one<R: Register>(texture: &[[R; 3]; PIXELS], primary: &[[R; 3]; PIXELS], out: &mut [R; PIXELS])
where
    <<R as Register>::Expanded as Factor>::Sum: Sum<Register = R>,
{
    for n in 0..PIXELS {
        out[n] = dot3(texture[n], primary[n]);
    }
}

/// Returns a block of pseudo-random bytes in place of a normal map or a light vector.
fn operand(seed: u64) -> Block {
    let mut random = Random::seeded(seed);
    std::array::from_fn(|_| std::array::from_fn(|_| i16::from(random.bits() as u8)))
}

fn pixels<R: Copy>(block: &Block, lane: impl Fn(i16) -> R) -> [[R; 3]; PIXELS] {
    std::array::from_fn(|n| std::array::from_fn(|c| lane(block[c][n])))
}

fn stage(c: &mut Criterion) {
    let (texture, primary) = (operand(1), operand(2));
    let mut scalar = [0_i32; PIXELS];
    one_by_one(&pixels(&texture, i32::from), &pixels(&primary, i32::from), &mut scalar);
    let mut block = [0_i16; PIXELS];
    for run in [block_general, block_narrow, block_general_avx2, block_narrow_avx2] {
        run(&texture, &primary, &mut block);
        assert_eq!(block.map(i32::from), scalar, "every lane gives the same integers");
    }
    let mut group = c.benchmark_group("dot3_stage");
    group.throughput(Throughput::Elements(PIXELS as u64));
    let (t, p) = (pixels(&texture, i32::from), pixels(&primary, i32::from));
    group.bench_function("scalar", |b| b.iter(|| one_by_one(black_box(&t), black_box(&p), black_box(&mut scalar))));
    let paired = |v: i16| Pair { fixed: i32::from(v), ideal: f64::from(v) };
    let (t, p, mut out) = (pixels(&texture, paired), pixels(&primary, paired), [Pair::ZERO; PIXELS]);
    group.bench_function("scalar_with_ideal", |b| {
        b.iter(|| one_by_one(black_box(&t), black_box(&p), black_box(&mut out)))
    });
    let (t, p, mut out) = (pixels(&texture, f64::from), pixels(&primary, f64::from), [0.0; PIXELS]);
    group.bench_function("float64", |b| b.iter(|| one_by_one(black_box(&t), black_box(&p), black_box(&mut out))));
    type Run = fn(&Block, &Block, &mut [i16; PIXELS]);
    let runs: [(&str, Run); 4] = [
        ("block_i16", block_general),
        ("block_narrow", block_narrow),
        ("block_i16_avx2", block_general_avx2),
        ("block_narrow_avx2", block_narrow_avx2),
    ];
    for (name, run) in runs {
        group.bench_function(name, |b| {
            b.iter(|| run(black_box(&texture), black_box(&primary), black_box(&mut block)));
        });
    }
    group.finish();
}

criterion_group!(benches, stage);
criterion_main!(benches);
