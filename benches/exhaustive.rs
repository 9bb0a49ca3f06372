//! Measures how fast the rows of an exhaustive sweep are digested on one core. The target is 100 million product sums a second.
#![allow(missing_docs, reason = "a benchmark")]

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use ninebit::state::Profile;
use ninebit_vectors::exhaustive::Exhaustive;
use ninebit_vectors::tree::Tree;
use ninebit_vectors::units;

fn digests(c: &mut Criterion) {
    let mut group = c.benchmark_group("sweep");
    let mut bench = |name: &str, sweep: &Exhaustive, rows: u64| {
        let start = sweep.size() / 3;
        group.throughput(Throughput::Elements(rows)).sample_size(10);
        group.bench_function(BenchmarkId::from_parameter(name), |b| b.iter(|| sweep.digest(start..start + rows)));
    };
    for (name, rows) in [("sum", 1 << 24), ("scale-bias", 1 << 20), ("vertex-color", 1 << 20), ("linear-step", 1 << 20)]
    {
        let Some(sweep) = units::by_name(name).and_then(|unit| Exhaustive::new(unit, Profile::Nv2a)) else { continue };
        bench(name, &sweep, rows);
    }
    // These units evaluate sixteen rows at a time.
    for name in ["blend/add", "final-combiner/own", "texture-combine/combine4-add", "general-stage/product"] {
        let path = format!("{}/../vectors/digests/{name}.json", env!("CARGO_MANIFEST_DIR"));
        let Ok((_, sweep)) = Tree::read(path.as_ref()) else { continue };
        bench(name, &sweep, 1 << 20);
    }
    group.finish();
}

criterion_group!(benches, digests);
criterion_main!(benches);
