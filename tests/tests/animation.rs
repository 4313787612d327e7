//! Frames of an animation: what stands still does not flicker.

use std::path::Path;

use diacaustic::LayerValues;
use diacaustic_scene::{SceneOptions, parse_scene_with};
use diacaustic_tests::{emit, photons_of, samples_of};

/// A ball that turns far from the part of the floor that is looked at; the lamp is large and partly hidden, so that its light is noisy.
const SCENE: &str = r#"
    camera = { position = [0, 2, 0.01], look_at = [0, 0, 0], vertical_fov = 40 }
    render = { width = 32, height = 32, samples = 16, photons = 20_000, max_bounces = 0, guiding = false }
    output.layers = ["variance"]
    materials.glass = { type = "dielectric", ior = 1.5 }
    materials.floor = { type = "diffuse", albedo = 0.8 }
    lights = [{ type = "rectangle", center = [1, 2, 0], edge_u = [1.5, 0, 0], edge_v = [0, 0, 1.5], flux = 20 }]
    objects = [
        { name = "ball", sphere = { center = [0, 0, 0], radius = 0.2, subdivisions = 2 }, material = "glass", translate = [-1.8, 0.3, 0] },
        { rectangle = { center = [0, 0, 0], edge_u = [8, 0, 0], edge_v = [0, 0, -8] }, material = "floor", map_size = 64 },
        { rectangle = { center = [0.9, 1.2, 0], edge_u = [0.7, 0, 0], edge_v = [0, 0, -0.7] }, material = "floor", map_size = 8 },
    ]
    [[animation.tracks]]
    key = "objects.ball.rotate"
    frames = [1, 8]
    values = [[0, 0, 0], [0, 40, 10]]
"#;
const FRAMES: u32 = 8;

/// For each frame, radiance and the variance that is stated of it, in green, of the right half of the picture.
fn frames(text: &str) -> Vec<Vec<(f64, f64)>> {
    let frame = |frame| {
        let options = SceneOptions { frame: Some(frame), ..SceneOptions::default() };
        let scene = parse_scene_with(text, Path::new("."), "the test's scene", &options).unwrap().scene;
        let mut renderer = emit(&scene, photons_of(&scene));
        renderer.add_samples(samples_of(&scene)).unwrap();
        let film = renderer.film().unwrap();
        let layers = renderer.layers().unwrap();
        let LayerValues::Float(variance) = &layers[0].channels[1].values else { panic!("variance is a number") };
        let right = (0..film.radiance.len()).filter(|pixel| pixel % 32 >= 16);
        right.map(|pixel| (f64::from(film.radiance[pixel][1]), f64::from(variance[pixel]))).collect()
    };
    (1..=FRAMES).map(frame).collect()
}

/// The means over all pixels of the variance over time and of the variance stated.
fn variances(frames: &[Vec<(f64, f64)>]) -> (f64, f64) {
    let (count, pixels) = (frames.len() as f64, frames[0].len());
    let of_pixel = |pixel: usize| {
        let values = frames.iter().map(move |frame| frame[pixel].0);
        let mean = values.clone().sum::<f64>() / count;
        values.map(|value| (value - mean).powi(2)).sum::<f64>() / (count - 1.0)
    };
    let over_time = (0..pixels).map(of_pixel).sum::<f64>() / pixels as f64;
    let stated = frames.iter().flatten().map(|(_, variance)| variance).sum::<f64>() / (count * pixels as f64);
    (over_time, stated)
}

#[test]
fn a_still_floor_stays_the_same_with_a_fixed_seed() {
    let (over_time, stated) = variances(&frames(SCENE));
    // The light that the ball's surface reflects changes a little.
    assert!(over_time < 1e-4 * stated, "{over_time} over time against {stated} stated");
}

#[test]
fn seeds_of_each_frame_vary_by_the_noise_that_is_stated() {
    let text = SCENE.replace("[[animation.tracks]]", "[animation]\nseed = \"per_frame\"\n[[animation.tracks]]");
    let (over_time, stated) = variances(&frames(&text));
    let ratio = over_time / stated;
    assert!((0.3..1.2).contains(&ratio), "{over_time} over time against {stated} stated");
}
