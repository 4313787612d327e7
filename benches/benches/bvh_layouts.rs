//! Two layouts of the hierarchy on one core of the host: obvhs's binary one and the eight-wide compressed one that the kernels walk, over two
//! teapots on a floor (97,206 triangles). Both by obvhs alone, with the same builder and the same triangle test.
//!
//! `bvh_layouts/build/LAYOUT`: triangles a second, on every core. `bvh_layouts/RAYS/LAYOUT`: nearest hits a second, for `primary` rays of a
//! picture and `incoherent` ones from where those met a surface.
//!
//! ```text
//! cargo bench --workspace --bench bvh_layouts
//! ```

use std::{hint::black_box, time::Duration};

use criterion::{BenchmarkId, Criterion, SamplingMode, Throughput, criterion_group, criterion_main};
use diacaustic::glam::{Vec2, Vec3, Vec3A};
use diacaustic_benches::{brief, even_direction, two_teapots};
use diacaustic_surface::world_triangles;
use obvhs::{
    BvhBuildParams,
    bvh2::{Bvh2, builder::build_bvh2_from_tris},
    cwbvh::{CwBvh, builder::build_cwbvh_from_tris},
    ray::{Ray, RayHit},
    triangle::Triangle,
};

/// Rays along each side of the picture.
const SIDE: u32 = 256;

/// A hierarchy over triangles.
enum Layout {
    Binary(Bvh2),
    EightWide(CwBvh),
}

impl Layout {
    /// Distance to the nearest triangle; infinite without one. Triangles are in the order of the leaves.
    fn nearest(&self, triangles: &[Triangle], ray: Ray) -> f32 {
        let mut hit = RayHit::none();
        match self {
            Self::Binary(bvh) => bvh.ray_traverse(ray, &mut hit, |ray, at| triangles[at].intersect(ray)),
            Self::EightWide(bvh) => bvh.ray_traverse(ray, &mut hit, |ray, at| triangles[at].intersect(ray)),
        };
        hit.t
    }

    /// The triangles in the order of the leaves.
    fn ordered(&self, triangles: &[Triangle]) -> Vec<Triangle> {
        let indices = match self {
            Self::Binary(bvh) => &bvh.primitive_indices,
            Self::EightWide(bvh) => &bvh.primitive_indices,
        };
        indices.iter().map(|&index| triangles[index as usize]).collect()
    }
}

/// What builds a layout.
type Build = fn(&[Triangle]) -> Layout;

fn build_binary(triangles: &[Triangle]) -> Layout {
    Layout::Binary(build_bvh2_from_tris(triangles, BvhBuildParams::medium_build(), &mut Duration::default()))
}

fn build_eight_wide(triangles: &[Triangle]) -> Layout {
    Layout::EightWide(build_cwbvh_from_tris(triangles, BvhBuildParams::medium_build(), &mut Duration::default()))
}

fn bvh_layouts(criterion: &mut Criterion) {
    let scene = two_teapots(64);
    let convert = |t: &diacaustic_surface::WorldTriangle| {
        let [v0, v1, v2] = t.corners.map(Vec3A::from);
        Triangle { v0, v1, v2 }
    };
    let triangles: Vec<_> = world_triangles(&scene).iter().map(convert).collect();
    let camera = &scene.camera;
    let [right, up, forward] = camera.axes();
    let half = (0.5 * camera.vertical_fov.to_radians()).tan();
    let primary: Vec<Ray> = (0..SIDE * SIDE)
        .map(|number| {
            let at = half * (2.0 * Vec2::new((number % SIDE) as f32, (number / SIDE) as f32) / SIDE as f32 - Vec2::ONE);
            Ray::new_inf(camera.position.into(), (forward + at.x * right - at.y * up).normalize().into())
        })
        .collect();
    let first = build_eight_wide(&triangles);
    let in_leaves = first.ordered(&triangles);
    let met = primary.iter().map(|ray| (ray, first.nearest(&in_leaves, *ray))).filter(|(_, t)| t.is_finite());
    let incoherent: Vec<Ray> = met
        .enumerate()
        .map(|(number, (ray, t))| {
            let direction: Vec3 = even_direction(number as u32);
            Ray::new_inf(ray.origin + 0.999 * t * ray.direction, direction.into())
        })
        .collect();

    let mut group = criterion.benchmark_group("bvh_layouts");
    group.sampling_mode(SamplingMode::Flat);
    let builders: [(&str, Build); 2] = [("binary", build_binary), ("eight-wide", build_eight_wide)];
    for (name, build) in builders {
        group.throughput(Throughput::Elements(triangles.len() as u64));
        group.bench_function(BenchmarkId::new("build", name), |bencher| bencher.iter(|| build(&triangles)));
        let layout = build(&triangles);
        let in_leaves = layout.ordered(&triangles);
        for (kind, rays) in [("primary", &primary), ("incoherent", &incoherent)] {
            group.throughput(Throughput::Elements(rays.len() as u64));
            group.bench_function(BenchmarkId::new(kind, name), |bencher| {
                bencher
                    .iter(|| rays.iter().map(|ray| layout.nearest(&in_leaves, black_box(*ray)).min(1e9)).sum::<f32>());
            });
        }
    }
}

criterion_group! { name = benches; config = brief(); targets = bvh_layouts }
criterion_main!(benches);
