//! What the kernels take for what a scene asks of them: a glass teapot on a floor, 512 texels along.
//!
//! `kernels/photons/KIND`: 2¹⁵ photons, in photons a second: `plain` (no guide), `guided`, `footprints` (guided), `paper` (the profile, whose rays are not
//! aimed). `photon_counts/COUNT`: guided photons, in one call. `kernels/samples/KIND`: a sample of every one of 128 × 128 pixels, in samples a second:
//! `direct` without bounces, `bounces` with 8, `paper`.
//!
//! ```text
//! cargo bench --workspace --bench kernels
//! ```

use criterion::{BenchmarkId, Criterion, SamplingMode, Throughput, criterion_group, criterion_main};
use diacaustic::{
    Renderer,
    glam::Vec3,
    scene::{PaperMapSize, PaperProfile, PaperRefraction, PaperSampling, Scene},
};
use diacaustic_benches::{brief, teapot};
use diacaustic_tests::renderer;

const MAP_SIZE: u32 = 512;
const PHOTONS: u64 = 1 << 15;
const PICTURE_SIZE: u32 = 128;

/// What makes other settings of a scene.
type Change = fn(&mut Scene);

/// The scene with other settings.
fn with(change: impl FnOnce(&mut Scene)) -> Renderer {
    let mut scene = teapot(MAP_SIZE);
    scene.settings.width = PICTURE_SIZE;
    scene.settings.height = PICTURE_SIZE;
    change(&mut scene);
    let mut renderer = renderer(&scene);
    // The driver compiles a kernel when it first runs.
    renderer.emit_photons(0..1).unwrap();
    renderer.add_samples(1).unwrap();
    renderer.wait().unwrap();
    renderer
}

fn as_in_the_paper(scene: &mut Scene) {
    scene.settings.guiding = false;
    scene.settings.max_bounces = 0;
    scene.settings.map_size = None;
    scene.settings.photons = Some(PHOTONS);
    scene.settings.paper = Some(PaperProfile {
        energy: Vec3::splat(35.0),
        refraction: PaperRefraction::Printed,
        sampling: PaperSampling::Random,
        pole: Vec3::Z,
        map_size: PaperMapSize::Texels(MAP_SIZE),
        transparency: 0.9,
    });
}

fn emit(renderer: &mut Renderer, count: u64) {
    renderer.emit_photons(0..count).unwrap();
    renderer.wait().unwrap();
}

fn photons(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("kernels");
    group.sampling_mode(SamplingMode::Flat);
    group.throughput(Throughput::Elements(PHOTONS));
    let photon_kinds: [(&str, Change); 4] = [
        ("plain", |scene| scene.settings.guiding = false),
        ("guided", |_| {}),
        ("footprints", |scene| scene.settings.footprints = true),
        ("paper", as_in_the_paper),
    ];
    for (name, change) in photon_kinds {
        let mut renderer = with(change);
        group
            .bench_function(BenchmarkId::new("photons", name), |bencher| bencher.iter(|| emit(&mut renderer, PHOTONS)));
    }
}

fn photon_counts(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("photon_counts");
    group.sampling_mode(SamplingMode::Flat);
    let mut guided = with(|_| {});
    for count in [1 << 10, 1 << 13, 1 << 16] {
        group.throughput(Throughput::Elements(count));
        group.bench_function(BenchmarkId::from_parameter(count), |bencher| {
            bencher.iter(|| emit(&mut guided, count));
        });
    }
}

fn samples(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("kernels");
    group.sampling_mode(SamplingMode::Flat);
    group.throughput(Throughput::Elements(u64::from(PICTURE_SIZE * PICTURE_SIZE)));
    let sample_kinds: [(&str, Change); 3] =
        [("direct", |scene| scene.settings.max_bounces = 0), ("bounces", |_| {}), ("paper", as_in_the_paper)];
    for (name, change) in sample_kinds {
        let mut renderer = with(change);
        group.bench_function(BenchmarkId::new("samples", name), |bencher| {
            bencher.iter(|| {
                renderer.add_samples(1).unwrap();
                renderer.wait().unwrap();
            });
        });
    }
}

criterion_group! { name = benches; config = brief(); targets = photons, samples, photon_counts }
criterion_main!(benches);
