//! The reference scenes against converged references of other renderers, where those are on the machine.

use std::path::Path;

use diacaustic_scene::load_scene;
use diacaustic_tests::{Comparison, compare_pictures, read_exr, render, repository, shared_file};

/// Renders a reference scene twice, with and without photons, and compares floor and caustic.
fn compare_with_reference(name: &str) -> Option<[Comparison; 3]> {
    let reference = shared_file(name, &format!("reference/{name}.exr"))?;
    let scene_file = Path::new(repository()).join(format!("tests/scenes/reference-{name}.toml"));
    let mut scene = load_scene(&scene_file).unwrap_or_else(|error| panic!("{error}")).scene;
    scene.settings.samples = Some(8);
    let complete = render(&scene);
    scene.settings.photons = Some(0);
    let without_photons = render(&scene);

    let reference = read_exr(&reference);
    let layer = |name: &str| reference.channels[name].iter().map(|&v| f64::from(v)).collect::<Vec<_>>();
    let mask = |name: &str| layer(name).iter().map(|&v| v > 0.5).collect::<Vec<_>>();
    let (floor, caustic) = (mask("floor_mask"), mask("caustic_mask"));
    let outside: Vec<bool> = floor.iter().zip(&caustic).map(|(floor, caustic)| *floor && !caustic).collect();
    let green = |film: &diacaustic::Film| film.radiance.iter().map(|p| f64::from(p[1])).collect::<Vec<_>>();
    let (complete, direct) = (green(&complete), green(&without_photons));
    let from_map: Vec<f64> = complete.iter().zip(&direct).map(|(a, b)| a - b).collect();
    Some([
        compare_pictures(&complete, &layer("radiance"), &outside),
        compare_pictures(&complete, &layer("radiance"), &caustic),
        compare_pictures(&from_map, &layer("caustic"), &caustic),
    ])
}

fn assert_close(name: &str, caustic_relative_mse: f64) {
    let Some([outside, all, caustic]) = compare_with_reference(name) else { return };
    println!("{name}: outside the caustic {outside:?}, in it all light {all:?}, caustic alone {caustic:?}");
    assert!((outside.mean_ratio - 1.0).abs() < 0.002, "floor outside the caustic: {outside:?}");
    assert!((all.mean_ratio - 1.0).abs() < 0.005, "all light in the caustic: {all:?}");
    // Light from the floor through glass to the floor is in the reference's other layer, but in the maps' here.
    assert!((caustic.mean_ratio - 1.0).abs() < 0.03, "caustic energy: {caustic:?}");
    assert!(caustic.relative_mse < caustic_relative_mse, "caustic: {caustic:?}");
}

#[test]
fn teapot() {
    assert_close("teapot", 0.1);
}

#[test]
fn ball() {
    assert_close("ball", 0.05);
}
