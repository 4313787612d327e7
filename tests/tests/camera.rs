//! The whole picture against brute-force path tracing in double precision, which knows nothing of maps, photons or the
//! partition of light: pixel by pixel, within both methods' noise.

use diacaustic_reference::{camera::radiance, geometry::World};
use diacaustic_tests::{render, scene};

/// Samples of the brute-force estimate of a pixel.
const SAMPLES: u32 = 40_000;
/// What the renderer's own noise and its texels' width may add, relative to the pixel and to the picture's mean.
const RENDERER_ERROR: [f64; 2] = [0.03, 0.01];

#[test]
fn picture_equals_path_tracing() {
    let scene = scene(
        "camera = { position = [0.4, 1.6, 2.4], look_at = [0, 0.3, 0], vertical_fov = 38 }
         render = { width = 24, height = 24, samples = 1024, photons = 2_097_152, map_size = 513, max_depth = 64 }
         background = [0.1, 0.2, 0.3]
         materials.glass = { type = \"dielectric\", ior = 1.5, tint = [1, 0.9, 1], absorption = [0.2, 0, 1] }
         materials.mirror = { type = \"mirror\", reflectance = 0.8 }
         materials.floor = { type = \"diffuse\", albedo = [0.8, 0.6, 0.4] }
         lights = [
             { type = \"sphere\", center = [1.2, 2.2, 0.4], radius = 0.4, flux = [40, 30, 20] },
             { type = \"sphere\", center = [-1.5, 1.2, 0.8], radius = 0.3, flux = 10 },
         ]
         objects = [
             { rectangle = { center = [0, 0, 0], edge_u = [4, 0, 0], edge_v = [0, 0, -4] }, material = \"floor\" },
             { box = { min = [-0.25, 0.2, -0.25], max = [0.25, 0.6, 0.25] }, material = \"glass\", rotate = [0, 30, 0] },
             { box = { min = [-1.4, 0.01, -0.6], max = [-1.3, 0.7, 0.6] }, material = \"mirror\" },
         ]",
    );
    let film = render(&scene);
    let mean = film.radiance.iter().map(|p| f64::from(p[1])).sum::<f64>() / film.radiance.len() as f64;
    let world = World::new(&scene);
    let mut worst = (0.0, String::new());
    // A grid of pixels that no symmetry of the picture repeats.
    for (x, y) in (0..24u32).step_by(3).flat_map(|x| (1..24u32).step_by(3).map(move |y| (x, y))) {
        let estimate = radiance(&world, x, y, SAMPLES, 0, 5);
        let pixel = film.radiance[(y * film.width + x) as usize];
        for (channel, &found) in pixel.iter().enumerate() {
            let (found, expected) = (f64::from(found), estimate.mean[channel]);
            let allowed =
                4.5 * estimate.variance[channel].sqrt() + RENDERER_ERROR[0] * expected + RENDERER_ERROR[1] * mean;
            let ratio = (found - expected).abs() / allowed;
            if ratio > worst.0 {
                worst = (ratio, format!("pixel ({x}, {y}), channel {channel}: {found}, path tracing {estimate:?}"));
            }
        }
    }
    assert!(worst.0 <= 1.0, "{}", worst.1);
    assert!(worst.0 > 0.05, "the comparison is too loose to fail");
}
