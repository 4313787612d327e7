//! What it costs to lay a mesh out on its energy map, in triangles a second: a scanned surface of 10⁴, 10⁵ and 10⁶ triangles on 1024 texels
//! along the longer side. For 10⁷, and for memory, run the example `charting` of `diacaustic-surface` with the number of triangles.
//!
//! ```text
//! cargo bench -p diacaustic-benches --bench charting
//! ```

#[path = "../../crates/surface/tests/shapes/mod.rs"]
mod shapes;

use std::time::Duration;

use criterion::{BenchmarkId, Criterion, SamplingMode, Throughput, criterion_group, criterion_main};
use diacaustic_surface::MapLayout;

const MAP_SIZE: u32 = 1024;

fn charting(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("charting");
    group.sampling_mode(SamplingMode::Flat);
    for bands in [50, 158, 500] {
        let object = shapes::object(shapes::scanned(bands, 0.5));
        let triangles = object.mesh.triangles.len();
        group.throughput(Throughput::Elements(triangles as u64));
        group.bench_function(BenchmarkId::from_parameter(triangles), |bencher| {
            bencher.iter(|| MapLayout::new(&object, MAP_SIZE));
        });
    }
}

fn brief() -> Criterion {
    Criterion::default().sample_size(10).warm_up_time(Duration::from_secs(1)).measurement_time(Duration::from_secs(5))
}

criterion_group! { name = benches; config = brief(); targets = charting }
criterion_main!(benches);
