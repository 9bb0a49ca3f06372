//! How fast all rows of a unit are digested, on one core: the bar is 100 million product sums a second.
#![allow(missing_docs, reason = "a benchmark")]

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use ninebit::state::Profile;
use ninebit::vectors::sweep::Sweep;
use ninebit::vectors::units;

fn digests(c: &mut Criterion) {
    let mut group = c.benchmark_group("sweep");
    for (name, rows) in [("sum", 1 << 24), ("scale-bias", 1 << 20), ("vertex-color", 1 << 20), ("linear-step", 1 << 20)]
    {
        let Some(sweep) = units::by_name(name).and_then(|unit| Sweep::new(unit, Profile::Nv2a)) else { continue };
        let start = sweep.size / 3;
        group.throughput(Throughput::Elements(rows)).sample_size(10);
        group.bench_function(BenchmarkId::from_parameter(name), |b| b.iter(|| sweep.digest(start..start + rows)));
    }
    group.finish();
}

criterion_group!(benches, digests);
criterion_main!(benches);
