//! What the benchmarks share: scenes, rays and how long they measure.

use std::time::Duration;

use criterion::Criterion;
use diacaustic::{glam::Vec3, scene::Scene};
use diacaustic_reference::random::{hash, unit};
use diacaustic_tests::scene;

/// A glass teapot on a plaster floor of 4 m × 2 m, in a picture of 64 × 64 pixels. The map of the floor's upper side has
/// `map_size` × `map_size` / 2 texels and that of its lower side as many: the largest, of 2048² together, is within 128 MiB.
pub fn teapot(map_size: u32) -> Scene {
    teapots(&[[0.0, 0.0, 0.0]], map_size)
}

/// Two glass teapots side by side on the floor of [`teapot`]: 97,206 triangles.
pub fn two_teapots(map_size: u32) -> Scene {
    teapots(&[[-0.55, 0.0, 0.0], [0.55, 0.0, 0.2]], map_size)
}

/// The floor's index among the objects of a scene of this crate: the last.
pub fn floor(scene: &Scene) -> usize {
    scene.objects.len() - 1
}

/// Short measurements: ten samples each, so that every benchmark together takes minutes.
pub fn brief() -> Criterion {
    Criterion::default()
        .sample_size(10)
        .warm_up_time(Duration::from_millis(200))
        .measurement_time(Duration::from_millis(1500))
        .without_plots()
}

/// A direction even over the sphere, the same for a number in every run.
pub fn even_direction(number: u32) -> Vec3 {
    let (u, v) = (unit(hash(2 * number)) as f32, unit(hash(2 * number + 1)) as f32);
    let (height, angle) = (2.0 * u - 1.0, std::f32::consts::TAU * v);
    let radius = (1.0 - height * height).sqrt();
    Vec3::new(radius * angle.cos(), height, radius * angle.sin())
}

fn teapots(places: &[[f32; 3]], map_size: u32) -> Scene {
    let teapots: String = places
        .iter()
        .map(|place| {
            format!("{{ mesh = \"assets/meshes/teapot.obj\", material = \"glass\", translate = {place:?} }},\n")
        })
        .collect();
    scene(&format!(
        "camera = {{ position = [0, 1.4, 2.2], look_at = [0, 0.2, 0], vertical_fov = 40 }}
         render = {{ width = 64, height = 64, map_size = {map_size} }}
         materials.glass = {{ type = \"dielectric\", ior = 1.5 }}
         materials.floor = {{ type = \"diffuse\", albedo = 0.8 }}
         lights = [{{ type = \"sphere\", center = [1.0, 2.5, 0.6], radius = 0.05, flux = 35 }}]
         objects = [
             {teapots}
             {{ rectangle = {{ center = [0, 0, 0], edge_u = [4, 0, 0], edge_v = [0, 0, -2] }}, material = \"floor\" }},
         ]"
    ))
}
