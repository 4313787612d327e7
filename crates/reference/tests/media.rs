//! Light in nested and absorbing media, and the camera in one.

mod shapes;

use diacaustic_reference::camera::{irradiance_at, radiance};
use diacaustic_reference::fresnel::reflectance;
use diacaustic_reference::geometry::{Sphere, World};
use diacaustic_reference::light_tracing::{Region, irradiance_on};
use diacaustic_scene::{Dispersion, LightKind, MaterialKind, Scene};
use glam::{DVec3, Vec3};

use shapes::{absorbing_glass, block, diffuse, floor, glass, light, named, scene};

fn ranked(ior: f32, absorption: f32, priority: i32) -> MaterialKind {
    let (tint, absorption) = (Vec3::ONE, Vec3::splat(absorption));
    MaterialKind::Dielectric { ior, dispersion: Dispersion::None, tint, absorption, roughness: 0.0, priority }
}

/// A slab from z = 1 to 1.5 and another from 1.1 to 1.3 within it, of one index, seen from straight in front in even
/// light.
fn slab_in_slab(inner_priority: i32) -> (f64, f64) {
    let pane = |from: f32, to: f32| block(Vec3::new(-4.0, -4.0, from), Vec3::new(4.0, 4.0, to));
    let parts = vec![
        (pane(1.0, 1.5), ranked(1.5, 1.0, 0), Vec3::ZERO),
        (pane(1.1, 1.3), ranked(1.5, 3.0, inner_priority), Vec3::ZERO),
    ];
    let mut scene = Scene { background: Vec3::ONE, ..scene(parts, Vec::new()) };
    scene.camera.position = Vec3::new(0.0, 0.0, 500.0);
    scene.camera.vertical_fov = 0.1;
    let seen = radiance(&World::new(&scene), 16, 16, 100_000, 0, 5);
    (seen.mean.x, seen.variance.x.sqrt())
}

#[test]
fn absorption_is_that_of_the_highest_rank() {
    // Among equals the material listed first, the outer, is higher.
    for (priority, depth) in [(1, 0.3 + 3.0 * 0.2), (0, 0.5), (-1, 0.5f64)] {
        let (f, kept) = (0.04f64, (-depth).exp());
        let transmitted = (1.0 - f).powi(2) * kept / (1.0 - f * f * kept * kept);
        let expected = transmitted + f * (1.0 + transmitted * kept);
        let (seen, deviation) = slab_in_slab(priority);
        assert!((seen - expected).abs() < 4.0 * deviation, "priority {priority}: {seen} for {expected} ± {deviation}");
    }
}

#[test]
fn parallel_light_under_flat_water() {
    for (degrees, sigma) in [(0.0f64, 0.0), (30.0, 0.0), (60.0, 0.7f32)] {
        let (sin, cos) = degrees.to_radians().sin_cos();
        let sun = LightKind::Distant {
            direction: DVec3::new(sin, -cos, 0.0).as_vec3(),
            angular_radius: 0.0,
            irradiance: Vec3::splat(5.0),
        };
        let parts = vec![
            (floor(3.0), diffuse(0.5), Vec3::NEG_Y),
            (block(Vec3::new(-9.0, -2.0, -9.0), Vec3::new(9.0, 0.0, 9.0)), absorbing_glass(1.33, sigma), Vec3::ZERO),
        ];
        let scene = scene(parts, vec![named(sun)]);
        let world = World::new(&scene);
        let ior = f64::from(1.33f32);
        let (edge_u, edge_v) = (0.4 * DVec3::X, -0.4 * DVec3::Z);
        let region = Region { center: DVec3::NEG_Y, edge_u, edge_v, columns: 2, rows: 1 };
        // On the line that light takes to the middle of the region.
        let entry = -DVec3::X * sin / (ior * ior - sin * sin).sqrt();
        let over = Sphere { center: entry, radius: 0.45 };
        let cos_t = (1.0 - (sin / ior).powi(2)).sqrt();
        let expected = 5.0 * cos * (1.0 - reflectance(cos, 1.0 / ior)) * (-f64::from(sigma) / cos_t).exp();
        let lighting = irradiance_on(&world, &region, Some(&over), 1_000_000, 11);
        for bin in 0..2 {
            let estimate = lighting.via_casters[bin];
            assert_eq!(lighting.direct[bin].mean, DVec3::ZERO);
            assert!(estimate.deviations(DVec3::splat(expected)).abs().max_element() < 4.0, "{degrees}°: {estimate:?}");
            assert!(estimate.variance.x.sqrt() < 0.01 * expected);
        }
    }
}

#[test]
fn lamp_under_water_is_lifted() {
    let lamp = LightKind::Disk { center: -1.33 * Vec3::Y, normal: Vec3::Y, radius: 0.1, flux: Vec3::ONE };
    let radiance_of_lamp = f64::from(lamp.strength().x);
    let water = block(Vec3::new(-9.0, -2.0, -9.0), Vec3::new(9.0, 0.0, 9.0));
    let mut scene = scene(vec![(water, glass(1.33), Vec3::ZERO)], vec![named(lamp)]);
    scene.camera.position = Vec3::Y;
    scene.camera.look_at = -Vec3::Y;
    scene.camera.up = Vec3::Z;
    // The lamp seems to be 1 m + 1.33 m/1.33 away, so its rim lies halfway from the middle of the picture to its edge.
    scene.camera.vertical_fov = 2.0 * 0.1f32.atan().to_degrees();
    let world = World::new(&scene);
    let expected = radiance_of_lamp * (1.0 - (0.33f64 / 2.33).powi(2)) / (1.33 * 1.33);
    for (x, is_lit) in [(17, true), (22, true), (25, false), (30, false)] {
        let seen = radiance(&world, x, 16, 20_000, 0, 1);
        let expected = if is_lit { expected } else { 0.0 };
        let tolerance = 4.5 * seen.variance.x.sqrt() + 1e-4 * expected;
        assert!((seen.mean.x - expected).abs() <= tolerance, "column {x}: {} for {expected}", seen.mean.x);
    }
}

#[test]
fn camera_in_water_sees_the_lamps_radiance_over_the_square_of_the_index() {
    let lamp = light(Vec3::new(0.0, -1.0, 0.0), 0.3, 7.0);
    let radiance_of_lamp = lamp.kind.strength().as_dvec3();
    let water = block(Vec3::new(-9.0, -2.0, -9.0), Vec3::new(9.0, 0.0, 9.0));
    let mut scene = scene(vec![(water, absorbing_glass(1.33, 0.5), Vec3::ZERO)], vec![lamp]);
    scene.camera.position = Vec3::new(0.0, -1.0, 2.3);
    scene.camera.look_at = Vec3::new(0.0, -1.0, 0.0);
    scene.camera.vertical_fov = 0.01;
    let seen = radiance(&World::new(&scene), 16, 16, 100, 0, 1).mean;
    let expected = radiance_of_lamp * (-1.0f64).exp() / (1.33 * 1.33);
    assert!((seen / expected - DVec3::ONE).abs().max_element() < 1e-5, "{seen} for {expected}");
}

#[test]
fn light_in_water_fades_on_its_way_to_the_floor() {
    let point = LightKind::Point { position: Vec3::new(0.3, -0.5, 0.0), flux: Vec3::splat(4.0) };
    let parts = vec![
        (floor(1.0), diffuse(0.5), -1.5 * Vec3::Y),
        (block(Vec3::new(-9.0, -2.0, -9.0), Vec3::new(9.0, 0.0, 9.0)), absorbing_glass(1.33, 0.8), Vec3::ZERO),
    ];
    let scene = scene(parts, vec![named(point)]);
    let world = World::new(&scene);
    let distance = (1.0f64 + 0.09).sqrt();
    let expected = 4.0 / (4.0 * std::f64::consts::PI * distance.powi(3)) * (-0.8 * distance).exp();
    let at = irradiance_at(&world, -1.5 * DVec3::Y, DVec3::Y, 100, 1).direct.mean.x;
    assert!((at / expected - 1.0).abs() < 1e-4, "{at} for {expected}");
    let (edge_u, edge_v) = (0.02 * DVec3::X, -0.02 * DVec3::Z);
    let region = Region { center: -1.5 * DVec3::Y, edge_u, edge_v, columns: 1, rows: 1 };
    let around = Sphere { center: -1.5 * DVec3::Y, radius: 0.015 };
    let traced = irradiance_on(&world, &region, Some(&around), 200_000, 3).direct[0];
    assert!(traced.deviations(DVec3::splat(expected)).abs().max_element() < 4.5, "{traced:?} for {expected}");
}
