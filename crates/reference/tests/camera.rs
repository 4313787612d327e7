//! The brute-force path tracer against known answers, and against the photons.

mod shapes;

use std::f64::consts::{FRAC_1_PI, PI};

use diacaustic_reference::camera::{irradiance_at, radiance};
use diacaustic_reference::geometry::{Sphere, World};
use diacaustic_reference::photons::{AimDisc, Emission, PhotonJob, trace};
use diacaustic_scene::{MaterialKind, Mesh, Scene};
use glam::{DVec3, Vec3};

use shapes::{absorbing_glass, ball, block, diffuse, flat, floor, glass, light, scene};

fn in_uniform_light(parts: Vec<(Mesh, MaterialKind, Vec3)>) -> Scene {
    Scene { background: Vec3::ONE, ..scene(parts, Vec::new()) }
}

#[test]
fn furnace_shows_no_glass() {
    let smooth = vec![(ball(1.0, 3), glass(1.5), Vec3::ZERO)];
    let nested = vec![
        (flat(ball(1.0, 3)), glass(1.5), Vec3::ZERO),
        (flat(ball(0.5, 2)), glass(1.8), Vec3::new(0.1, 0.1, 0.0)),
        (block(Vec3::splat(-0.4), Vec3::splat(0.4)), glass(1.3), Vec3::new(1.2, -0.3, 0.0)),
    ];
    for parts in [smooth, nested] {
        let scene = in_uniform_light(parts);
        let world = World::new(&scene);
        for (x, y) in [(16, 16), (12, 14), (9, 16), (20, 19), (0, 0)] {
            let estimate = radiance(&world, x, y, 2000, 0, 7);
            assert!(estimate.mean.abs_diff_eq(DVec3::ONE, 1e-9), "pixel ({x}, {y}): {}", estimate.mean);
        }
    }
}

#[test]
fn white_floor_in_the_furnace_takes_a_bounce() {
    let scene = in_uniform_light(vec![(floor(2.0), diffuse(1.0), Vec3::ZERO)]);
    let world = World::new(&scene);
    let seen = |max_bounces| radiance(&world, 16, 16, 1000, max_bounces, 7).mean;
    assert_eq!(seen(0), DVec3::ZERO);
    assert!(seen(1).abs_diff_eq(DVec3::ONE, 1e-12));
}

#[test]
fn irradiance_of_a_sphere_in_plain_sight() {
    let lights = vec![light(Vec3::new(0.4, 2.0, 0.3), 0.5, 12.0)];
    let scene = scene(vec![(floor(3.0), diffuse(0.5), Vec3::ZERO)], lights);
    let world = World::new(&scene);
    let irradiance = irradiance_at(&world, DVec3::ZERO, DVec3::Y, 20_000, 3);
    let distance_squared: f64 = 0.16 + 4.0 + 0.09;
    let expected = 12.0 * (2.0 / distance_squared.sqrt()) / (4.0 * PI * distance_squared);
    // The scene's numbers are single precision.
    assert!((irradiance.direct.mean.x / expected - 1.0).abs() < 1e-3);
    assert!(irradiance.direct.deviations(DVec3::splat(expected)).abs().max_element() < 4.0);
    assert_eq!(irradiance.via_casters.mean, DVec3::ZERO);
}

#[test]
fn casters_block_next_event_estimation_and_hand_the_light_on() {
    let plate = block(Vec3::new(-4.0, 1.0, -4.0), Vec3::new(4.0, 1.1, 4.0));
    let lights = || vec![light(Vec3::new(0.0, 2.0, 0.0), 0.8, 12.0)];
    let parts = |ior| vec![(floor(1.0), diffuse(0.5), Vec3::ZERO), (plate.clone(), glass(ior), Vec3::ZERO)];
    let nothing_there = scene(parts(1.0), lights());
    let world = World::new(&nothing_there);
    let irradiance = irradiance_at(&world, DVec3::ZERO, DVec3::Y, 200_000, 3);
    assert_eq!(irradiance.direct.mean, DVec3::ZERO);
    let expected = DVec3::splat(12.0 / (4.0 * PI * 4.0));
    assert!(irradiance.via_casters.deviations(expected).abs().max_element() < 4.0, "{irradiance:?}");
    let of_glass = scene(parts(1.5), lights());
    let glazed = irradiance_at(&World::new(&of_glass), DVec3::ZERO, DVec3::Y, 200_000, 3).via_casters;
    assert!(glazed.deviations(expected).min_element() > 4.0, "glass reflects some: {glazed:?}");
}

#[test]
fn pixel_shows_irradiance_by_way_of_the_albedo() {
    let parts = vec![
        (floor(2.0), diffuse(0.6), Vec3::ZERO),
        (block(Vec3::new(-4.0, 1.9, -4.0), Vec3::new(4.0, 2.0, 4.0)), glass(1.5), Vec3::ZERO),
    ];
    let lights = vec![light(Vec3::new(0.0, 3.0, 0.0), 0.8, 12.0), light(Vec3::new(0.3, 1.0, 0.2), 0.1, 1.0)];
    let scene = scene(parts, lights);
    let world = World::new(&scene);
    let seen = radiance(&world, 16, 16, 200_000, 0, 5);
    let irradiance = irradiance_at(&world, DVec3::ZERO, DVec3::Y, 200_000, 3);
    let expected = 0.6 * FRAC_1_PI * (irradiance.direct.mean + irradiance.via_casters.mean);
    // The light that the pane throws back down is in both; the pixel is small, but no point.
    assert!((seen.mean / expected - DVec3::ONE).abs().max_element() < 0.02, "{} for {expected}", seen.mean);
}

#[test]
fn radiance_out_of_glass_takes_eta_squared() {
    let around = block(Vec3::splat(-1.0), Vec3::splat(1.0));
    let lamp = light(Vec3::ZERO, 0.5, 7.0);
    let radiance_inside = lamp.kind.strength().as_dvec3();
    let mut scene = scene(vec![(around, glass(1.5), Vec3::ZERO)], vec![lamp]);
    scene.camera.position = Vec3::new(0.0, 0.0, 500.0);
    scene.camera.vertical_fov = 0.01;
    let seen = radiance(&World::new(&scene), 16, 16, 50_000, 0, 5);
    assert!(seen.deviations(0.96 / 2.25 * radiance_inside).abs().max_element() < 4.0, "{seen:?}");
}

#[test]
fn light_through_absorbing_glass() {
    let pane = block(Vec3::new(-4.0, -4.0, 1.0), Vec3::new(4.0, 4.0, 1.5));
    let parts = vec![(pane, absorbing_glass(1.5, 1.0), Vec3::ZERO)];
    let mut scene = in_uniform_light(parts);
    scene.camera.position = Vec3::new(0.0, 0.0, 500.0);
    scene.camera.vertical_fov = 0.1;
    let seen = radiance(&World::new(&scene), 16, 16, 100_000, 0, 5);
    let (f, kept) = (0.04f64, (-0.5f64).exp());
    let transmitted = (1.0 - f).powi(2) * kept / (1.0 - f * f * kept * kept);
    let reflected = f * (1.0 + transmitted * kept);
    assert!(seen.deviations(DVec3::splat(transmitted + reflected)).abs().max_element() < 4.0, "{seen:?}");
}

/// The mean irradiance of a floor of half width 0.3 m from a big light through `lens` alone: by photons, and by paths
/// to a grid of points with the standard deviation of their mean. W/m².
fn under_a_lens(lens: Mesh) -> (f64, f64, f64) {
    let parts = vec![(floor(0.3), diffuse(0.5), Vec3::ZERO), (lens, glass(1.4), Vec3::new(0.0, 0.6, 0.0))];
    let scene = scene(parts, vec![light(Vec3::new(0.3, 2.2, 0.2), 0.4, 10.0)]);
    let world = World::new(&scene);
    let caster = Sphere { center: DVec3::new(0.0, 0.6, 0.0), radius: 0.4 };
    let discs =
        [AimDisc::around(&world.light_sphere(0).expect("a sphere"), &caster).expect("the lens is far from the light")];
    let photons = 1 << 19;
    let emission = Emission::Aimed(&discs);
    let job =
        PhotonJob { world: &world, maps: &[None, None], light: 0, emission, guide: None, seed: 1, photons: 0..photons };
    let by_photons = trace(&job).ledger.deposited.x / (f64::from(photons) * 0.36);

    let points = 16;
    let (mut mean, mut variance) = (0.0, 0.0);
    for (i, j) in (0..points).flat_map(|i| (0..points).map(move |j| (i, j))) {
        let at = |k: i32| 0.6 * ((f64::from(k) + 0.5) / f64::from(points) - 0.5);
        let estimate = irradiance_at(&world, DVec3::new(at(i), 0.0, at(j)), DVec3::Y, 4000, 2).via_casters;
        mean += estimate.mean.x / f64::from(points * points);
        variance += estimate.variance.x / f64::from(points * points).powi(2);
    }
    (by_photons, mean, variance.sqrt())
}

#[test]
fn photons_and_paths_agree_under_a_lens() {
    let smooth = ball(0.4, 5);
    let faceted = flat(ball(0.4, 3));
    for lens in [smooth, faceted] {
        let (by_photons, by_paths, deviation) = under_a_lens(lens);
        assert!(deviation < 0.005 * by_paths);
        let tolerance = 3.0 * deviation + 0.002 * by_paths;
        assert!(
            (by_photons - by_paths).abs() < tolerance,
            "{by_photons} by photons, {by_paths} ± {deviation} by paths"
        );
    }
}
