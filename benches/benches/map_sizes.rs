//! A floor's energy map of 64² to 2048² texels, on both its sides together, and 2¹⁴ and 2¹⁷ photons: how long photons take, and
//! how long their sums take to become irradiance.
//!
//! `map_sizes/photons/COUNT/SIZE`: `Renderer::emit_photons(0..COUNT)` and the wait for it, in photons a second. Each pass emits the same
//! photons again, which adds to the sums and changes no path.
//!
//! `map_sizes/resolve/SIZE`: the first sample after new photons, of 64 × 64 pixels, in texels a second: the sums become irradiance, then
//! the picture is sampled once. The smallest maps show what the sample alone takes.
//!
//! ```text
//! cargo bench --workspace --bench map_sizes
//! cargo bench --workspace --bench map_sizes -- map_sizes/photons/131072
//! ```

use std::time::{Duration, Instant};

use criterion::{BenchmarkId, Criterion, SamplingMode, Throughput, criterion_group, criterion_main};
use diacaustic::Renderer;
use diacaustic_benches::{brief, floor, teapot};
use diacaustic_tests::renderer;

const MAP_SIZES: [u32; 4] = [64, 256, 1024, 2048];
const PHOTON_COUNTS: [u64; 2] = [1 << 14, 1 << 17];

/// A renderer whose kernels the driver has compiled, which it does when they first run.
fn warm(map_size: u32) -> Renderer {
    let mut renderer = renderer(&teapot(map_size));
    renderer.emit_photons(0..1).unwrap();
    renderer.add_samples(1).unwrap();
    renderer.wait().unwrap();
    renderer
}

fn photons(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("map_sizes");
    group.sampling_mode(SamplingMode::Flat);
    for map_size in MAP_SIZES {
        let mut renderer = warm(map_size);
        for count in PHOTON_COUNTS {
            group.throughput(Throughput::Elements(count));
            group.bench_function(BenchmarkId::new(format!("photons/{count}"), map_size), |bencher| {
                bencher.iter(|| {
                    renderer.emit_photons(0..count).unwrap();
                    renderer.wait().unwrap();
                });
            });
        }
    }
}

/// The time of one sample right after one more photon.
fn time_resolve(renderer: &mut Renderer) -> Duration {
    renderer.emit_photons(0..1).unwrap();
    renderer.wait().unwrap();
    let start = Instant::now();
    renderer.add_samples(1).unwrap();
    renderer.wait().unwrap();
    start.elapsed()
}

fn resolve(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("map_sizes");
    group.sampling_mode(SamplingMode::Flat);
    for map_size in MAP_SIZES {
        let mut renderer = warm(map_size);
        let texels = renderer.map_layout(floor(&teapot(map_size))).unwrap().unwrap().texel_count();
        group.throughput(Throughput::Elements(texels));
        group.bench_function(BenchmarkId::new("resolve", map_size), |bencher| {
            bencher.iter_custom(|passes| (0..passes).map(|_| time_resolve(&mut renderer)).sum());
        });
    }
}

criterion_group! { name = map_sizes; config = brief(); targets = photons, resolve }
criterion_main!(map_sizes);
