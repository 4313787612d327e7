//! The whole picture against brute-force path tracing in double precision, which knows nothing of maps, photons or the
//! partition of light: pixel by pixel, within both methods' noise.

use diacaustic_reference::{camera::radiance, geometry::World};
use diacaustic_scene::{LightKind, RadianceMap, Scene, Texture};
use diacaustic_tests::{normal_pattern, pattern, render, scene};
use glam::{DVec3, Vec3};

/// Samples of the brute-force estimate of a pixel.
const SAMPLES: u32 = 30_000;
/// What the width of texels may add, relative to the pixel and to the picture's mean.
const RENDERER_ERROR: [f64; 2] = [0.02, 0.005];

/// Renders with this many seeds tell the renderer's own noise.
const SEEDS: u32 = 8;
/// The same of one in which some pixels see rare and bright light through rough pictures.
const MANY_SEEDS: u32 = 16;

/// A pixel's mean over the seeds, and the variance of that mean.
type Pixel = (DVec3, DVec3);

fn render_with_seeds(scene: &Scene, seeds: u32) -> Vec<Pixel> {
    let mut sums = vec![(DVec3::ZERO, DVec3::ZERO); (scene.settings.width * scene.settings.height) as usize];
    for seed in 0..seeds {
        let mut scene = scene.clone();
        scene.settings.seed = seed;
        for ((sum, squares), pixel) in sums.iter_mut().zip(&render(&scene).radiance) {
            let value = DVec3::from(pixel.map(f64::from));
            *sum += value;
            *squares += value * value;
        }
    }
    let count = f64::from(seeds);
    let pixel = |(sum, squares): Pixel| {
        let mean = sum / count;
        (mean, ((squares / count - mean * mean) / (count - 1.0)).max(DVec3::ZERO))
    };
    sums.into_iter().map(pixel).collect()
}

/// Compares every third pixel of a picture of 24 × 24.
fn assert_equals_path_tracing(scene: &Scene) {
    assert_equals_path_tracing_over(scene, SEEDS);
}

/// The same with a number of seeds.
fn assert_equals_path_tracing_over(scene: &Scene, seeds: u32) {
    let picture = render_with_seeds(scene, seeds);
    let mean = picture.iter().map(|(mean, _)| mean.y).sum::<f64>() / picture.len() as f64;
    let world = World::new(scene);
    let mut worst = (0.0, String::new());
    // A grid of pixels that no symmetry of the picture repeats.
    for (x, y) in (0..24u32).step_by(3).flat_map(|x| (1..24u32).step_by(3).map(move |y| (x, y))) {
        let estimate = radiance(&world, x, y, SAMPLES, scene.settings.max_bounces, 5);
        let (found, noise) = picture[(y * scene.settings.width + x) as usize];
        for channel in 0..3 {
            let (found, expected) = (found[channel], estimate.mean[channel]);
            // Eight seeds know their noise to a quarter of it.
            let noise = 4.5 * (estimate.variance[channel] + 1.5 * noise[channel]).sqrt();
            let allowed = noise + RENDERER_ERROR[0] * expected + RENDERER_ERROR[1] * mean;
            let ratio = (found - expected).abs() / allowed;
            if ratio > worst.0 {
                worst = (ratio, format!("pixel ({x}, {y}), channel {channel}: {found}, path tracing {estimate:?}"));
            }
        }
    }
    assert!(worst.0 <= 1.0, "{}", worst.1);
    assert!(worst.0 > 0.05, "the comparison is too loose to fail");
}

/// A camera over a floor of 4 m, and what is added.
fn over_a_floor(settings: &str, floor: &str, parts: &str) -> Scene {
    scene(&format!(
        "camera = {{ position = [0.4, 1.6, 2.4], look_at = [0, 0.3, 0], vertical_fov = 38 }}
         render = {{ width = 24, height = 24, samples = 128, photons = 524_288, map_size = 513, max_depth = 64, {settings} }}
         materials.floor = {floor}
         {parts}
             {{ rectangle = {{ center = [0, 0, 0], edge_u = [4, 0, 0], edge_v = [0, 0, -4] }}, material = \"floor\" }},
         ]"
    ))
}

#[test]
fn glass_and_mirror_under_two_lamps() {
    assert_equals_path_tracing(&over_a_floor(
        "max_bounces = 0",
        "{ type = \"diffuse\", albedo = [0.8, 0.6, 0.4] }",
        "background = [0.1, 0.2, 0.3]
         materials.glass = { type = \"dielectric\", ior = 1.5, tint = [1, 0.9, 1], absorption = [0.2, 0, 1] }
         materials.mirror = { type = \"mirror\", reflectance = 0.8 }
         lights = [
             { type = \"sphere\", center = [1.2, 2.2, 0.4], radius = 0.4, flux = [40, 30, 20] },
             { type = \"sphere\", center = [-1.5, 1.2, 0.8], radius = 0.3, flux = 10 },
         ]
         objects = [
             { box = { min = [-0.25, 0.2, -0.25], max = [0.25, 0.6, 0.25] }, material = \"glass\", rotate = [0, 30, 0] },
             { box = { min = [-1.4, 0.01, -0.6], max = [-1.3, 0.7, 0.6] }, material = \"mirror\" },",
    ));
}

#[test]
fn bounced_light_in_a_corner() {
    assert_equals_path_tracing(&over_a_floor(
        "max_bounces = 6",
        "{ type = \"diffuse\", albedo = [0.8, 0.7, 0.6] }",
        "background = 0.3
         materials.glass = { type = \"dielectric\", ior = 1.5 }
         materials.red = { type = \"diffuse\", albedo = [0.9, 0.2, 0.1] }
         lights = [
             { type = \"rectangle\", center = [0.3, 2, 0], edge_u = [0.8, 0, 0], edge_v = [0, 0, 0.8], flux = 40 },
         ]
         objects = [
             { box = { min = [-0.25, 0.05, -0.25], max = [0.25, 0.4, 0.25] }, material = \"glass\", rotate = [0, 30, 0] },
             { rectangle = { center = [0, 1, -0.8], edge_u = [4, 0, 0], edge_v = [0, 2, 0] }, material = \"red\" },",
    ));
}

#[test]
fn gloss_of_every_kind() {
    assert_equals_path_tracing(&over_a_floor(
        "max_bounces = 4",
        "{ type = \"coated\", albedo = [0.6, 0.4, 0.2] }",
        "materials.frosted = { type = \"dielectric\", ior = 1.5, roughness = 0.3 }
         materials.gold = { type = \"conductor\", metal = \"gold\", roughness = 0.4 }
         materials.plastic = { type = \"coated\", albedo = [0.1, 0.5, 0.2], roughness = 0.5 }
         materials.paint = { type = \"metallic_roughness\", base_color = [0.8, 0.1, 0.1], metallic = 0.5, roughness = 0.35 }
         lights = [
             { type = \"disk\", center = [0.3, 2, 0.4], normal = [0, -1, -0.2], radius = 0.6, flux = 40 },
         ]
         objects = [
             { box = { min = [-0.2, 0.1, -0.2], max = [0.2, 0.5, 0.2] }, material = \"frosted\", rotate = [0, 30, 0] },
             { box = { min = [-0.9, 0, -0.3], max = [-0.4, 0.5, 0.2] }, material = \"gold\", rotate = [0, 20, 0] },
             { box = { min = [0.45, 0, -0.4], max = [0.9, 0.4, 0.1] }, material = \"plastic\" },
             { box = { min = [-0.4, 0, 0.5], max = [0.1, 0.15, 0.8] }, material = \"paint\", rotate = [0, -20, 0] },",
    ));
}

#[test]
fn nested_glass_under_a_sky() {
    let mut scene = over_a_floor(
        "max_bounces = 3",
        "{ type = \"diffuse\", albedo = 0.7 }",
        "background = 0.1
         materials.glass = { type = \"dielectric\", ior = 1.5, priority = 1 }
         materials.water = { type = \"dielectric\", ior = 1.33, absorption = [3, 1, 0.2] }
         materials.pane = { type = \"thin_walled\", tint = [0.7, 0.9, 0.7] }
         materials.glow = { type = \"diffuse\", albedo = 0.5, emission = [4, 3, 2] }
         lights = [
             { type = \"sun\", direction = [0.3, -1, -0.2], angular_radius = 12, irradiance = 4 },
             { type = \"point\", position = [0, 5, 0], flux = 1 },
         ]
         objects = [
             { box = { min = [-0.3, 0.03, -0.3], max = [0.3, 0.2, 0.3] }, material = \"glass\" },
             { box = { min = [-0.25, 0.15, -0.25], max = [0.25, 0.5, 0.25] }, material = \"water\" },
             { rectangle = { center = [0.6, 0.5, 0.2], edge_u = [0, 0.8, 0], edge_v = [0.2, 0, 0.8] }, material = \"pane\" },
             { box = { min = [-1, 0.1, -0.5], max = [-0.7, 0.4, 0.3] }, material = \"glow\" },",
    );
    let texel = |k: u32| Vec3::new(0.4, 0.6, 1.0) * if k / 32 < 6 { 1.0 + 0.1 * (k % 7) as f32 } else { 0.2 };
    let map = RadianceMap { width: 32, height: 16, texels: (0..512).map(texel).collect() };
    scene.lights[1].kind = LightKind::Environment { map: map.into(), rotate: 40.0, scale: Vec3::ONE };
    assert_equals_path_tracing(&scene);
}

#[test]
fn camera_under_water() {
    let mut scene = over_a_floor(
        "max_bounces = 2",
        "{ type = \"diffuse\", albedo = [0.8, 0.7, 0.5] }",
        "background = 0.2
         materials.glass = { type = \"dielectric\", ior = 1.6, priority = 1 }
         materials.water = { type = \"dielectric\", substance = \"water\", absorption = [0.4, 0.1, 0.05] }
         lights = [
             { type = \"sphere\", center = [0.3, 3, 0.2], radius = 0.6, flux = 300 },
             { type = \"sphere\", center = [-0.6, 0.5, -0.3], radius = 0.1, flux = 3 },
         ]
         objects = [
             { box = { min = [-2, -0.1, -2], max = [2, 1, 2] }, material = \"water\" },
             { box = { min = [-0.2, 0.1, -0.2], max = [0.2, 0.5, 0.2] }, material = \"glass\", rotate = [0, 30, 20] },",
    );
    scene.camera.position = Vec3::new(0.3, 0.8, 1.5);
    assert_equals_path_tracing(&scene);
}

#[test]
fn pictures_of_every_kind() {
    let mut scene = over_a_floor(
        "max_bounces = 2",
        "{ type = \"coated\", albedo = 1, roughness = 1 }",
        "background = 0.3
         materials.rippled = { type = \"dielectric\", ior = 1.5 }
         materials.worn = { type = \"metallic_roughness\", base_color = [0.9, 0.7, 0.3], metallic = 1, roughness = 1 }
         materials.screen = { type = \"diffuse\", albedo = 0.5 }
         materials.sign = { type = \"diffuse\", albedo = 0.2, emission = 12 }
         lights = [
             { type = \"disk\", center = [0.3, 2, 0.4], normal = [0, -1, -0.2], radius = 0.6, flux = 40 },
         ]
         objects = [
             { box = { min = [-0.2, 0.1, -0.2], max = [0.2, 0.5, 0.2] }, material = \"rippled\", rotate = [0, 30, 0] },
             { box = { min = [-0.9, 0, -0.3], max = [-0.4, 0.5, 0.2] }, material = \"worn\", rotate = [0, 20, 0] },
             { rectangle = { center = [0.6, 0.4, 0.3], edge_u = [0.6, 0, 0], edge_v = [0, 0.5, -0.3] }, material = \"screen\" },
             { rectangle = { center = [-0.3, 0.5, 0.6], edge_u = [0, 0, 0.3], edge_v = [0, 0.3, 0] }, material = \"sign\" },",
    );
    let tiles =
        || pattern(4, 4, |x, y| [0.3 + 0.2 * x as f32, 0.3 + 0.2 * y as f32, 0.6, 0.4 + 0.2 * ((x + y) % 4) as f32]);
    let waves = || normal_pattern(6, 6, |x, y| [0.1 * (x as f32 - 2.5), 0.3 * ((y % 3) as f32 - 1.0)]);
    let alpha = || Some(Texture { channel: 3, ..tiles() });
    for material in &mut scene.materials {
        let textures = &mut material.textures;
        match material.name.as_str() {
            "floor" => (textures.color, textures.roughness, textures.normal) = (Some(tiles()), alpha(), waves()),
            "rippled" => (textures.color, textures.normal) = (Some(tiles()), waves()),
            "worn" => (textures.roughness, textures.metallic) = (alpha(), Some(Texture { channel: 1, ..tiles() })),
            "screen" => textures.opacity = alpha(),
            _ => (textures.emission, textures.opacity) = (Some(tiles()), alpha()),
        }
    }
    assert_equals_path_tracing_over(&scene, MANY_SEEDS);
}

#[test]
fn glass_that_disperses() {
    assert_equals_path_tracing(&over_a_floor(
        "max_bounces = 1",
        "{ type = \"diffuse\", albedo = [0.8, 0.7, 0.6] }",
        "background = [0.2, 0.3, 0.4]
         materials.glass = { type = \"dielectric\", ior = 1.7, abbe = 12 }
         materials.frosted = { type = \"dielectric\", ior = 1.5, abbe = 20, roughness = 0.3, tint = [1, 0.7, 0.5] }
         lights = [
             { type = \"sphere\", center = [1.2, 2.2, 0.4], radius = 0.4, flux = [40, 30, 20] },
         ]
         objects = [
             { box = { min = [-0.25, 0.2, -0.25], max = [0.25, 0.6, 0.25] }, material = \"glass\", rotate = [0, 30, 20] },
             { box = { min = [-0.9, 0.1, -0.3], max = [-0.5, 0.4, 0.2] }, material = \"frosted\", rotate = [0, 20, 0] },",
    ));
}
