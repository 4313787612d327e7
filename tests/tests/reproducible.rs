//! Equal scene, seed and photons give equal bits, in whatever pieces.

use diacaustic::EnergyMap;
use diacaustic_scene::Scene;
use diacaustic_tests::{emit, renderer, scene};

fn teapot() -> Scene {
    scene(
        "camera = { position = [0, 2.2, 3.2], look_at = [0, 0.2, 0], vertical_fov = 40 }
         render = { width = 64, height = 64, samples = 4, map_size = 128, seed = 3 }
         materials.glass = { type = \"dielectric\", ior = 1.5, absorption = [1, 0.3, 0] }
         materials.floor = { type = \"diffuse\", albedo = 0.8 }
         lights = [
             { type = \"sphere\", center = [1.0, 2.5, 0.6], radius = 0.05, flux = [35, 30, 20] },
             { type = \"sphere\", center = [-1.0, 1.5, 0.6], radius = 0.1, flux = 5 },
         ]
         objects = [
             { mesh = \"assets/meshes/teapot.obj\", material = \"glass\", translate = [0, 0.2, 0] },
             { rectangle = { center = [0, 0, 0], edge_u = [4, 0, 0], edge_v = [0, 0, -4] }, material = \"floor\" },
         ]",
    )
}

fn map(scene: &Scene, pieces: &[std::ops::Range<u64>]) -> EnergyMap {
    let mut renderer = renderer(scene);
    for piece in pieces {
        renderer.emit_photons(piece.clone()).unwrap();
    }
    renderer.energy_map(1).unwrap().unwrap()
}

#[test]
fn two_runs_are_equal_to_the_byte() {
    let scene = teapot();
    let render = || {
        let mut renderer = emit(&scene, 200_000);
        renderer.add_samples(4).unwrap();
        (renderer.energy_map(1).unwrap().unwrap(), renderer.film().unwrap())
    };
    let (first_map, first_film) = render();
    let (second_map, second_film) = render();
    assert_eq!(first_map.sums, second_map.sums);
    let bits = |film: &diacaustic::Film| film.radiance.iter().flatten().map(|v| v.to_bits()).collect::<Vec<_>>();
    assert_eq!(bits(&first_film), bits(&second_film));
    assert!(first_map.sums.iter().any(|sum| sum[0] != 0), "nothing was deposited, so nothing is tested");
}

#[test]
fn pieces_in_any_order_equal_the_whole() {
    let scene = teapot();
    let whole = map(&scene, std::slice::from_ref(&(0..300_000)));
    for pieces in [vec![0..150_000, 150_000..300_000], vec![77_777..300_000, 0..1, 1..77_777]] {
        assert_eq!(map(&scene, &pieces).sums, whole.sums, "pieces {pieces:?}");
    }
    assert_ne!(map(&scene, std::slice::from_ref(&(0..299_999))).sums, whole.sums, "the comparison cannot fail");
}

#[test]
fn maps_of_two_machines_merge_into_the_whole() {
    let mut scene = teapot();
    // Merged maps are not filtered.
    scene.settings.map_filter = false;
    let whole = map(&scene, std::slice::from_ref(&(0..100_000)));
    let mut merged = map(&scene, std::slice::from_ref(&(0..40_000)));
    assert!(merged.merge(&map(&scene, std::slice::from_ref(&(40_000..100_000)))));
    assert_eq!(merged, whole);
    let mut other_scene = scene.clone();
    other_scene.settings.map_size = Some(64);
    assert!(!merged.merge(&map(&other_scene, std::slice::from_ref(&(0..10)))), "maps of different sizes merged");
}

#[test]
fn another_seed_gives_other_bits() {
    let scene = teapot();
    let mut other = scene.clone();
    other.settings.seed += 1;
    let range = std::slice::from_ref(&(0..100_000));
    assert_ne!(map(&scene, range).sums, map(&other, range).sums);
}

#[test]
fn restart_forgets_everything() {
    let scene = teapot();
    let mut renderer = emit(&scene, 100_000);
    let first = renderer.energy_map(1).unwrap().unwrap();
    renderer.add_samples(1).unwrap();
    renderer.restart().unwrap();
    assert_eq!(renderer.statistics().unwrap().photon_rays, 0);
    renderer.emit_photons(0..100_000).unwrap();
    assert_eq!(renderer.energy_map(1).unwrap().unwrap(), first);
}
