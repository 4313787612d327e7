//! A ball of glass around water around ice, seen from outside and from within, against rays that are followed through exact spheres.

use std::sync::Arc;

use diacaustic_scene::{LightKind, Mesh, RadianceMap, Scene};
use diacaustic_tests::{render, scene};
use glam::{DVec3, Vec3};

/// Outer radii of glass, water and ice, metres, and their indices.
const SHELLS: [(f64, f64); 3] = [(1.0, 1.5), (0.9, 1.333), (0.5, 1.31)];
/// How far the water reaches into the glass, whose wall it meets without a gap.
const OVERLAP: f32 = 0.03;
/// Surfaces after which a ray's rest is taken for the surroundings' mean.
const DEEPEST: u32 = 9;

/// Radiance of the surroundings from a direction.
fn surroundings(direction: DVec3) -> f64 {
    1.0 + 0.6 * direction.y + 0.3 * direction.x
}

/// The index at a distance from the centre.
fn index_at(radius: f64) -> f64 {
    SHELLS.iter().rev().find(|(outer, _)| radius < *outer).map_or(1.0, |(_, index)| *index)
}

/// The distance to the next sphere along a ray, and its radius.
fn next_sphere(origin: DVec3, direction: DVec3) -> Option<(f64, f64)> {
    let along = origin.dot(direction);
    let hits = SHELLS.iter().flat_map(|&(radius, _)| {
        let square = along * along - origin.length_squared() + radius * radius;
        let root = square.max(0.0).sqrt();
        [-along - root, -along + root].map(|t| (if square > 0.0 { t } else { f64::NAN }, radius))
    });
    hits.filter(|(t, _)| *t > 1e-9).min_by(|a, b| a.0.total_cmp(&b.0))
}

/// Radiance against a ray, divided by the square of the index where it starts: both ways at every sphere.
fn radiance(origin: DVec3, direction: DVec3, depth: u32, share: f64) -> f64 {
    if depth == DEEPEST || share < 1e-5 {
        return 1.0;
    }
    let Some((t, radius)) = next_sphere(origin, direction) else { return surroundings(direction) };
    let point = origin + t * direction;
    let outward = point / radius;
    let entering = direction.dot(outward) < 0.0;
    let side = if entering { 1e-7 } else { -1e-7 };
    let eta = index_at(radius + side) / index_at(radius - side);
    let n = if entering { outward } else { -outward };
    let cos_i = -direction.dot(n);
    let sin2_t = eta * eta * (1.0 - cos_i * cos_i);
    let reflect = |share| radiance(point, direction + 2.0 * cos_i * n, depth + 1, share);
    if sin2_t >= 1.0 {
        return reflect(share);
    }
    let cos_t = (1.0 - sin2_t).sqrt();
    let s = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
    let p = (cos_i - eta * cos_t) / (cos_i + eta * cos_t);
    let f = 0.5 * (s * s + p * p);
    let refracted = (eta * direction + (eta * cos_i - cos_t) * n).normalize();
    f * reflect(share * f) + (1.0 - f) * radiance(point, refracted, depth + 1, share * (1.0 - f))
}

/// Glass as a shell of two surfaces, water that overlaps it, and ice within the water.
fn nested(camera: &str) -> Scene {
    let mut scene = scene(&format!(
        "camera = {{ {camera} }}
         render = {{ width = 16, height = 16, samples = 1024, photons = 0, max_depth = 200 }}
         materials.glass = {{ type = \"dielectric\", ior = 1.5, priority = 2 }}
         materials.ice = {{ type = \"dielectric\", ior = 1.31, priority = 1 }}
         materials.water = {{ type = \"dielectric\", ior = 1.333 }}
         lights = [{{ type = \"point\", position = [0, 5, 0], flux = 1 }}]
         objects = [
             {{ sphere = {{ center = [0, 0, 0], radius = 1, subdivisions = 8 }}, material = \"glass\" }},
             {{ sphere = {{ center = [0, 0, 0], radius = {}, subdivisions = 8 }}, material = \"water\" }},
             {{ sphere = {{ center = [0, 0, 0], radius = 0.5, subdivisions = 8 }}, material = \"ice\" }},
         ]",
        SHELLS[1].0 as f32 + OVERLAP
    ));
    scene.objects[0].mesh = Arc::new(shell());
    let (width, height) = (128, 64);
    let texel = |index: u32| {
        let u = (f64::from(index % width) + 0.5) / f64::from(width);
        let v = (f64::from(index / width) + 0.5) / f64::from(height);
        let (turn, polar) = (std::f64::consts::TAU * (u - 0.5), std::f64::consts::PI * v);
        let direction = DVec3::new(polar.sin() * turn.sin(), polar.cos(), -polar.sin() * turn.cos());
        Vec3::splat(surroundings(direction) as f32)
    };
    let map = RadianceMap { width, height, texels: (0..width * height).map(texel).collect() };
    scene.lights[0].kind = LightKind::Environment { map: map.into(), rotate: 0.0, scale: Vec3::ONE };
    scene
}

/// The glass between its two spheres.
fn shell() -> Mesh {
    let mut mesh = Mesh::sphere(Vec3::ZERO, SHELLS[0].0 as f32, 8);
    let inner = Mesh::sphere(Vec3::ZERO, SHELLS[1].0 as f32, 8);
    let first = mesh.positions.len() as u32;
    mesh.positions.extend(inner.positions);
    mesh.normals.extend(inner.normals.iter().map(|normal| -*normal));
    mesh.triangles.extend(inner.triangles.iter().map(|[a, b, c]| [first + a, first + c, first + b]));
    mesh.uvs.clear();
    mesh
}

/// Compares each pixel with the mean of exact rays through it.
fn assert_exact(scene: &Scene) {
    let film = render(scene);
    let camera = &scene.camera;
    let (size, steps) = (scene.settings.width, 6u32);
    let forward = (camera.look_at - camera.position).as_dvec3().normalize();
    let right = forward.cross(camera.up.as_dvec3()).normalize();
    let up = right.cross(forward);
    let half = f64::from(0.5 * camera.vertical_fov).to_radians().tan();
    let ray = |x: f64, y: f64| (forward + half * ((2.0 * x - 1.0) * right + (1.0 - 2.0 * y) * up)).normalize();
    let mut squares = 0.0;
    let mut worst: f64 = 0.0;
    for (index, pixel) in film.radiance.iter().enumerate() {
        let (column, row) = (index as u32 % size, index as u32 / size);
        let place =
            |cell: u32, step: u32| (f64::from(cell) + (f64::from(step) + 0.5) / f64::from(steps)) / f64::from(size);
        let rays = (0..steps * steps).map(|k| ray(place(column, k % steps), place(row, k / steps)));
        let expected = rays.map(|direction| radiance(camera.position.as_dvec3(), direction, 0, 1.0)).sum::<f64>()
            / f64::from(steps * steps);
        let difference = f64::from(pixel[1]) / expected - 1.0;
        squares += difference * difference;
        worst = worst.max(difference.abs());
    }
    let rms = (squares / film.radiance.len() as f64).sqrt();
    assert!(rms < 0.015 && worst < 0.06, "pixels are off by {rms} (rms), at most {worst}");
}

#[test]
fn seen_from_outside() {
    assert_exact(&nested("position = [0.4, 1.2, 3.6], look_at = [0, 0, 0], vertical_fov = 26"));
}

#[test]
fn seen_from_within_the_ice() {
    assert_exact(&nested("position = [0.05, 0.1, 0.2], look_at = [0.3, 0.2, -1], vertical_fov = 80"));
}

#[test]
fn seen_from_within_the_water() {
    assert_exact(&nested("position = [0.1, 0.62, 0.25], look_at = [0.2, 0.1, -1], vertical_fov = 60"));
}
