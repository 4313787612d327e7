//! The irradiance cache: as much light as paths bring that bounce, with less noise, and the same bits in every run.

use diacaustic::{Film, Renderer, Stage};
use diacaustic_scene::Scene;
use diacaustic_tests::{mean, renderer, scene};

/// A white room without a ceiling's lamp: every wall shines and reflects, so that each place sees the same light.
fn furnace() -> Scene {
    let wall = |name: &str, center: [f32; 3], u: [f32; 3], v: [f32; 3]| {
        format!(
            "[[objects]]\nname = \"{name}\"\nrectangle = {{ center = {center:?}, edge_u = {u:?}, edge_v = {v:?} }}\nmaterial = \"wall\"\n"
        )
    };
    let (x, y, z) = ([2.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 2.0]);
    let walls = [
        wall("floor", [0.0, -1.0, 0.0], z, x),
        wall("ceiling", [0.0, 1.0, 0.0], x, z),
        wall("left", [-1.0, 0.0, 0.0], y, z),
        wall("right", [1.0, 0.0, 0.0], z, y),
        wall("back", [0.0, 0.0, -1.0], x, y),
        wall("front", [0.0, 0.0, 1.0], y, x),
    ];
    scene(&format!(
        r#"
        camera = {{ position = [0.6, 0.3, 0.7], look_at = [-0.4, -0.3, -0.5], vertical_fov = 70 }}
        render = {{ width = 64, height = 64, samples = 4, photons = 0, max_bounces = 30, irradiance_cache = true }}
        materials.wall = {{ type = "diffuse", albedo = 0.5, emission = 1 }}
        {}
        "#,
        walls.concat()
    ))
}

/// A ball of glass that touches a floor before a wall, under a lamp and a pale sky.
fn corner(irradiance_cache: bool, seed: u32) -> Scene {
    scene(&format!(
        r#"
        background = 0.2
        camera = {{ position = [0, 1.2, 2.2], look_at = [0, 0.3, 0], vertical_fov = 45 }}
        render = {{ width = 64, height = 64, samples = 16, seed = {seed}, irradiance_cache = {irradiance_cache} }}
        [materials]
        glass = {{ type = "dielectric", ior = 1.5 }}
        floor = {{ type = "diffuse", albedo = 0.7 }}
        wall = {{ type = "diffuse", albedo = [0.7, 0.3, 0.1] }}
        [[lights]]
        type = "sphere"
        center = [0.6, 2.5, 0.8]
        radius = 0.1
        flux = 60
        [[objects]]
        sphere = {{ center = [0.2, 0.3, 0.2], radius = 0.3, subdivisions = 4 }}
        material = "glass"
        [[objects]]
        rectangle = {{ center = [0, 0, 0], edge_u = [4, 0, 0], edge_v = [0, 0, -4] }}
        material = "floor"
        [[objects]]
        rectangle = {{ center = [0, 1, -0.6], edge_u = [4, 0, 0], edge_v = [0, 2, 0] }}
        material = "wall"
        "#
    ))
}

fn picture(scene: &Scene, photons: u64, samples: u32) -> (Renderer, Film) {
    let mut renderer = renderer(scene);
    renderer.emit_photons(0..photons).unwrap();
    renderer.add_samples(samples).unwrap();
    let film = renderer.film().unwrap();
    (renderer, film)
}

/// Mean radiance of the channels of each square of 16 × 16 pixels.
fn blocks(film: &Film) -> Vec<f64> {
    let (columns, rows) = (film.width / 16, film.height / 16);
    let block = |number: u32| {
        let pixels = (0..256).map(|k| {
            let (x, y) = (16 * (number % columns) + k % 16, 16 * (number / columns) + k / 16);
            film.radiance[(y * film.width + x) as usize].iter().map(|&channel| f64::from(channel)).sum::<f64>() / 3.0
        });
        mean(pixels)
    };
    (0..columns * rows).map(block).collect()
}

#[test]
fn a_white_room_shines_evenly() {
    // Light of 1 W/(m² sr) from each wall, of which half is sent on again and again.
    let (_, film) = picture(&furnace(), 0, 16);
    let found = mean(blocks(&film).into_iter());
    assert!((found - 2.0).abs() < 0.01, "{found}");
}

#[test]
fn noise_is_less() {
    // What half the pixels of two pictures differ by at most.
    let difference = |irradiance_cache: bool| {
        let [one, other] = [5, 6].map(|seed| picture(&corner(irradiance_cache, seed), 100_000, 4).1);
        let pairs = one.radiance.iter().zip(&other.radiance);
        let mut differences: Vec<f32> = pairs.map(|(a, b)| (a[1] - b[1]).abs()).collect();
        differences.sort_by(f32::total_cmp);
        differences[differences.len() / 2]
    };
    let (with, without) = (difference(true), difference(false));
    println!("{with} with the cache, {without} without");
    assert!(3.0 * with < without, "{with} with the cache, {without} without");
}

#[test]
fn light_is_that_of_paths_that_bounce() {
    let (_, exact) = picture(&corner(false, 1), 400_000, 300);
    let (_, cached) = picture(&corner(true, 2), 400_000, 64);
    let (found, wanted) = (blocks(&cached), blocks(&exact));
    let all = mean(found.iter().copied()) / mean(wanted.iter().copied());
    let worst = found.iter().zip(&wanted).map(|(a, b)| (a / b - 1.0).abs()).fold(0.0, f64::max);
    println!("{all} of the light, worst block off by {worst}");
    assert!((all - 1.0).abs() < 0.005, "{all} of the light");
    assert!(worst < 0.04, "a block is off by {worst}");
}

#[test]
fn a_cache_is_the_same_in_every_run_and_part_of_the_state() {
    let scene = corner(true, 3);
    let (first, film) = picture(&scene, 50_000, 3);
    let (_, again) = picture(&scene, 50_000, 3);
    assert!(film == again);
    let state = first.save_state().unwrap();
    let mut resumed = renderer(&scene);
    resumed.restore_state(&state).unwrap();
    resumed.add_samples(2).unwrap();
    assert!(resumed.film().unwrap() == picture(&scene, 50_000, 5).1);
    // A render that begins anew forgets it.
    resumed.restart().unwrap();
    resumed.emit_photons(0..50_000).unwrap();
    resumed.add_samples(3).unwrap();
    assert!(resumed.film().unwrap() == film);
}

#[test]
fn renders_that_choose_their_samples_have_one() {
    let rays = |irradiance_cache: Option<bool>| {
        let mut scene = corner(true, 4);
        (scene.settings.samples, scene.settings.photons) = (None, Some(20_000));
        (scene.settings.irradiance_cache, scene.settings.target_error) = (irradiance_cache, 1.0);
        let mut renderer = renderer(&scene);
        while renderer.refine().unwrap().stage != Stage::Done {}
        renderer.statistics().unwrap().camera_rays
    };
    let (chosen, without) = (rays(None), rays(Some(false)));
    assert_eq!(chosen, rays(Some(true)));
    assert!(5 * chosen < 4 * without, "{chosen} rays with the cache, {without} without");
}
