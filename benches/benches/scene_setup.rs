//! What a scene costs before its first photon: two teapots on a floor (97,206 triangles).
//!
//! `bvh`: the hierarchy on every core, in triangles a second. `texel_areas/SIZE`: the areas of one side of the floor, which has
//! SIZE × SIZE / 2 texels, in texels a second. `set_scene`: everything, until the device has it, in triangles a second.
//!
//! ```text
//! cargo bench --workspace --bench scene_setup
//! ```

use criterion::{BenchmarkId, Criterion, SamplingMode, Throughput, criterion_group, criterion_main};
use diacaustic_benches::{brief, floor, two_teapots};
use diacaustic_surface::{Bvh, MapLayout, MapTiles, texel_areas, world_triangles};
use diacaustic_tests::renderer;

const MAP_SIZE: u32 = 1024;

fn scene_setup(criterion: &mut Criterion) {
    let scene = two_teapots(MAP_SIZE);
    let triangles = world_triangles(&scene);
    let mut group = criterion.benchmark_group("scene_setup");
    group.sampling_mode(SamplingMode::Flat);

    group.throughput(Throughput::Elements(triangles.len() as u64));
    group.bench_function("bvh", |bencher| bencher.iter(|| Bvh::build(&triangles).unwrap()));

    let floor = floor(&scene);
    let layout = MapLayout::new(&scene.objects[floor], MAP_SIZE);
    let floor_triangles: Vec<_> = triangles.iter().filter(|t| t.object as usize == floor).copied().collect();
    group.throughput(Throughput::Elements(u64::from(layout.width) * u64::from(layout.height)));
    group.bench_function(BenchmarkId::new("texel_areas", MAP_SIZE), |bencher| {
        bencher.iter(|| texel_areas(&layout, &MapTiles::dense(&layout), &floor_triangles));
    });

    let mut renderer = renderer(&scene);
    group.throughput(Throughput::Elements(triangles.len() as u64));
    group.bench_function("set_scene", |bencher| {
        bencher.iter(|| {
            renderer.set_scene(&scene).unwrap();
            renderer.wait().unwrap();
        });
    });
}

criterion_group! { name = benches; config = brief(); targets = scene_setup }
criterion_main!(benches);
