//! Rays a second against two teapots on a floor (97,206 triangles): the traversal alone, without shading.
//!
//! `primary`: camera rays of a picture of 1024 × 1024 pixels, in the order in which `shaders/camera.wgsl` takes them.
//! `incoherent`: from where those met a surface, in directions even over the sphere. `shadow`: from there to the lamp, any hit. Each
//! pass is one dispatch of `Renderer::trace_rays` over rays that lie on the device, and the wait for it.
//!
//! ```text
//! cargo bench --workspace --bench traversal
//! ```

use criterion::{Criterion, SamplingMode, Throughput, criterion_group, criterion_main};
use diacaustic::{
    Ray, Renderer,
    glam::{UVec2, Vec2, Vec3},
    scene::{Camera, LightKind, Scene},
};
use diacaustic_benches::{brief, even_direction, two_teapots};
use diacaustic_tests::renderer;

const PICTURE_SIZE: u32 = 1024;
/// Pixels along a tile, which a workgroup takes.
const TILE_SIZE: u32 = 8;

/// The pixel that `pixel_of` of `shaders/camera.wgsl` gives invocation `number`, workgroups row by row.
fn pixel(number: u32) -> UVec2 {
    let (tile, local) = (number / 64, number % 64);
    let tiles = PICTURE_SIZE / TILE_SIZE;
    let even_bits = |bits: u32| bits & 1 | bits >> 1 & 2 | bits >> 2 & 4;
    TILE_SIZE * UVec2::new(tile % tiles, tile / tiles) + UVec2::new(even_bits(local), even_bits(local >> 1))
}

fn camera_ray(camera: &Camera, pixel: UVec2) -> Ray {
    let [right, up, forward] = camera.axes();
    let half = (0.5 * camera.vertical_fov.to_radians()).tan();
    let at = half * (2.0 * (pixel.as_vec2() + 0.5) / PICTURE_SIZE as f32 - Vec2::ONE);
    Ray { origin: camera.position, direction: (forward + at.x * right - at.y * up).normalize(), t_max: 1e30 }
}

fn primary(scene: &Scene) -> Vec<Ray> {
    (0..PICTURE_SIZE * PICTURE_SIZE).map(|number| camera_ray(&scene.camera, pixel(number))).collect()
}

/// Where rays met surfaces, a little before them.
fn met(renderer: &Renderer, rays: &[Ray]) -> Vec<Vec3> {
    let hits = renderer.intersect(rays, false).unwrap();
    rays.iter().zip(hits).filter_map(|(ray, hit)| Some(ray.origin + 0.999 * hit?.t * ray.direction)).collect()
}

fn incoherent(points: &[Vec3]) -> Vec<Ray> {
    let ray = |(number, origin): (usize, &Vec3)| Ray {
        origin: *origin,
        direction: even_direction(number as u32),
        t_max: 1e30,
    };
    points.iter().enumerate().map(ray).collect()
}

fn shadow(scene: &Scene, points: &[Vec3]) -> Vec<Ray> {
    let LightKind::Sphere { center, .. } = scene.lights[0].kind else { panic!("the first light is a sphere") };
    let ray = |origin: &Vec3| {
        let toward = center - *origin;
        Ray { origin: *origin, direction: toward.normalize(), t_max: toward.length() }
    };
    points.iter().map(ray).collect()
}

fn traversal(criterion: &mut Criterion) {
    let scene = two_teapots(64);
    let renderer = renderer(&scene);
    let primary = primary(&scene);
    let points = met(&renderer, &primary);
    let kinds = [
        ("primary", &primary, false),
        ("incoherent", &incoherent(&points), false),
        ("shadow", &shadow(&scene, &points), true),
    ];
    let mut group = criterion.benchmark_group("traversal");
    group.sampling_mode(SamplingMode::Flat);
    for (name, rays, any_hit) in kinds {
        let batch = renderer.upload_rays(rays, any_hit).unwrap();
        group.throughput(Throughput::Elements(rays.len() as u64));
        group.bench_function(name, |bencher| {
            bencher.iter(|| {
                renderer.trace_rays(&batch).unwrap();
                renderer.wait().unwrap();
            });
        });
    }
}

criterion_group! { name = benches; config = brief(); targets = traversal }
criterion_main!(benches);
