//! Irradiance under each kind of light against closed forms, as points sample the lights and as light leaves them.

mod shapes;

use std::f64::consts::{FRAC_PI_2, PI};
use std::sync::Arc;

use diacaustic_reference::camera::{Estimate, irradiance_at, radiance};
use diacaustic_reference::geometry::{Sphere, World};
use diacaustic_reference::light_tracing::{Region, irradiance_on};
use diacaustic_scene::{LightKind, Mesh, RadianceMap, Scene};
use glam::{DVec3, Vec3};

use shapes::{diffuse, floor, named, scene};

/// A floor at y = 0 under one light.
fn lit_floor(kind: LightKind) -> Scene {
    scene(vec![(floor(3.0), diffuse(0.5), Vec3::ZERO)], vec![named(kind)])
}

fn assert_is(estimate: &Estimate, expected: f64, name: &str) {
    let Estimate { mean, variance } = estimate;
    // Points are lifted off the floor by 1e-6 of the scene.
    let tolerance = 4.5 * variance.x.sqrt() + 2e-5 * expected;
    assert!((mean.x - expected).abs() <= tolerance, "{name}: {} for {expected} ± {tolerance}", mean.x);
    assert!(tolerance < 0.02 * expected.max(1e-3), "{name}: ± {tolerance} is too loose");
}

/// Both ways to the irradiance at the origin from above. What leaves the light is counted on 2 cm.
fn assert_irradiance(scene: &Scene, expected: f64) {
    let world = World::new(scene);
    let at_point = irradiance_at(&world, DVec3::ZERO, DVec3::Y, 100_000, 3);
    assert_is(&at_point.direct, expected, "at the point");
    assert_eq!(at_point.via_casters.mean, DVec3::ZERO);
    let (edge_u, edge_v) = (0.02 * DVec3::X, -0.02 * DVec3::Z);
    let region = Region { center: DVec3::ZERO, edge_u, edge_v, columns: 1, rows: 1 };
    let around = Sphere { center: DVec3::ZERO, radius: 0.015 };
    let traced = irradiance_on(&world, &region, Some(&around), 2_000_000, 3);
    assert_is(&traced.direct[0], expected, "from the light");
    assert_eq!(traced.via_casters[0].mean, DVec3::ZERO);
}

/// From a point to a parallel rectangle with a corner over it, in units of its height.
fn corner_form_factor(a: f64, b: f64) -> f64 {
    let term = |a: f64, b: f64| a / (1.0 + a * a).sqrt() * (b / (1.0 + a * a).sqrt()).atan();
    (term(a, b) + term(b, a)) / (2.0 * PI)
}

#[test]
fn rectangle() {
    let (edge_u, edge_v) = (1.5 * Vec3::X, 0.7 * Vec3::Z);
    let center = Vec3::new(0.75, 1.2, 0.35);
    let shining_down = LightKind::Rectangle { center, edge_u, edge_v, flux: Vec3::splat(10.0) };
    assert_irradiance(&lit_floor(shining_down), 10.0 / 1.05 * corner_form_factor(1.5 / 1.2, 0.7 / 1.2));
    let shining_up = LightKind::Rectangle { center, edge_u, edge_v: -edge_v, flux: Vec3::splat(10.0) };
    let scene = lit_floor(shining_up);
    let dark = irradiance_at(&World::new(&scene), DVec3::ZERO, DVec3::Y, 1000, 3);
    assert_eq!((dark.direct.mean, dark.via_casters.mean), (DVec3::ZERO, DVec3::ZERO));
}

#[test]
fn shining_object_is_a_rectangle() {
    let lamp = Mesh::rectangle(Vec3::new(0.75, 1.2, 0.35), 1.5 * Vec3::X, 0.7 * Vec3::Z);
    let parts = vec![(floor(3.0), diffuse(0.5), Vec3::ZERO), (lamp, diffuse(0.0), Vec3::ZERO)];
    let mut scene = scene(parts, Vec::new());
    scene.materials[1].emission = Vec3::splat(2.0);
    assert_irradiance(&scene, 2.0 * PI * corner_form_factor(1.5 / 1.2, 0.7 / 1.2));
}

#[test]
fn disk_on_its_axis() {
    let disk = LightKind::Disk { center: 1.2 * Vec3::Y, normal: -3.0 * Vec3::Y, radius: 0.8, flux: Vec3::splat(10.0) };
    assert_irradiance(&lit_floor(disk), 10.0 / (PI * 0.64) * 0.64 / (0.64 + 1.44));
}

#[test]
fn sphere() {
    let (center, flux) = (Vec3::new(0.4, 2.0, 0.3), Vec3::splat(12.0));
    let distance_squared: f64 = 0.16 + 4.0 + 0.09;
    let expected = 12.0 * 2.0 / (4.0 * PI * distance_squared.powf(1.5));
    assert_irradiance(&lit_floor(LightKind::Sphere { center, radius: 0.5, flux }), expected);
}

#[test]
fn point() {
    let (position, flux) = (Vec3::new(0.4, 2.0, 0.3), Vec3::splat(12.0));
    let distance_squared: f64 = 0.16 + 4.0 + 0.09;
    let expected = 12.0 * 2.0 / (4.0 * PI * distance_squared.powf(1.5));
    assert_irradiance(&lit_floor(LightKind::Point { position, flux }), expected);
}

fn spot(degrees_off_axis: f32) -> LightKind {
    let (sin, cos) = degrees_off_axis.to_radians().sin_cos();
    let direction = 2.0 * Vec3::new(sin, -cos, 0.0);
    let (position, flux) = (2.0 * Vec3::Y, Vec3::splat(12.0));
    LightKind::Spot { position, direction, inner_angle: 20.0, outer_angle: 40.0, flux }
}

#[test]
fn spot_is_full_within_its_inner_angle_and_falls_to_the_outer() {
    let cos = |degrees: f64| degrees.to_radians().cos();
    let full = 12.0 / (2.0 * PI * (1.0 - 0.5 * (cos(20.0) + cos(40.0)))) / 4.0;
    assert_irradiance(&lit_floor(spot(15.0)), full);
    let t = (cos(30.0) - cos(40.0)) / (cos(20.0) - cos(40.0));
    assert_irradiance(&lit_floor(spot(30.0)), full * (3.0 * t * t - 2.0 * t * t * t));
    let scene = lit_floor(spot(41.0));
    assert_eq!(irradiance_at(&World::new(&scene), DVec3::ZERO, DVec3::Y, 1000, 3).direct.mean, DVec3::ZERO);
}

#[test]
fn all_of_a_spots_flux_is_in_its_cone() {
    let scene = lit_floor(spot(0.0));
    let (edge_u, edge_v) = (4.0 * DVec3::X, -4.0 * DVec3::Z);
    let region = Region { center: DVec3::ZERO, edge_u, edge_v, columns: 1, rows: 1 };
    let traced = irradiance_on(&World::new(&scene), &region, None, 400_000, 5);
    assert_is(&traced.direct[0], 12.0 / 16.0, "mean over the floor");
}

fn distant(degrees: f32, angular_radius: f32) -> LightKind {
    let (sin, cos) = degrees.to_radians().sin_cos();
    LightKind::Distant { direction: 5.0 * Vec3::new(sin, -cos, 0.0), angular_radius, irradiance: Vec3::splat(3.0) }
}

#[test]
fn parallel_light_and_discs_in_the_sky() {
    for angular_radius in [0.0, 0.27, 20.0, 35.0] {
        assert_irradiance(&lit_floor(distant(50.0, angular_radius)), 3.0 * 50f64.to_radians().cos());
    }
}

#[test]
fn sun_is_seen_by_rays_that_escape() {
    let mut scene = lit_floor(distant(0.0, 20.0));
    scene.camera.position = Vec3::Y;
    scene.camera.look_at = 2.0 * Vec3::Y;
    scene.camera.up = Vec3::Z;
    scene.camera.vertical_fov = 80.0;
    let world = World::new(&scene);
    let sine = f64::from(20f32.to_radians()).sin();
    let seen = |x: u32| radiance(&world, x, 16, 100, 0, 1).mean;
    assert!(seen(16).abs_diff_eq(DVec3::splat(3.0 / (PI * sine * sine)), 1e-5));
    // The middle of the picture is column 16, and its rim lies at tan 40°.
    let rim = 16.0 + 16.0 * 20f64.to_radians().tan() / 40f64.to_radians().tan();
    assert!(seen(rim as u32 - 1).x > 0.0 && seen(rim as u32 + 1) == DVec3::ZERO);
}

fn environment(rotate: f32, texels: impl Fn(u32, u32) -> f32) -> LightKind {
    let (width, height) = (16, 8);
    let texels = (0..width * height).map(|i| Vec3::splat(texels(i % width, i / width))).collect();
    LightKind::Environment { map: Arc::new(RadianceMap { width, height, texels }), rotate, scale: Vec3::splat(2.0) }
}

#[test]
fn even_environment() {
    assert_irradiance(&lit_floor(environment(0.0, |_, _| 0.5)), PI);
}

#[test]
fn environment_that_is_half_white() {
    // The white half is that of −x, columns 0 to 7, and the point is on a wall that faces it or not.
    let half = |rotate| lit_floor(environment(rotate, |column, _| if column < 8 { 0.5 } else { 0.0 }));
    let on_wall = |rotate: f32, normal: DVec3| {
        let scene = half(rotate);
        let world = World::new(&scene);
        // High over the floor, which hides next to nothing.
        irradiance_at(&world, 1e4 * DVec3::Y, normal, 200_000, 3).direct
    };
    // The bilinear seams are even about the planes between the halves.
    assert_is(&on_wall(0.0, DVec3::Z), FRAC_PI_2, "along the seam");
    assert_is(&on_wall(0.0, DVec3::Y), FRAC_PI_2, "upward");
    let (toward, away) = (on_wall(0.0, -DVec3::X).mean.x, on_wall(0.0, DVec3::X).mean.x);
    assert!((toward + away - PI).abs() < 0.02 && away < 0.05 * PI, "{toward}, {away}");
    // A quarter turn brings the white half from −x to +z.
    let turned = on_wall(90.0, DVec3::Z).mean.x;
    assert!((turned / toward - 1.0).abs() < 0.01, "{turned}, {toward}");
}

#[test]
fn environment_shows_behind_everything() {
    let white_above = environment(0.0, |_, row| if row < 4 { 0.5 } else { 0.0 });
    let mut scene = lit_floor(white_above);
    scene.background = Vec3::splat(0.25);
    scene.camera.position = Vec3::Y;
    scene.camera.look_at = Vec3::new(0.0, 2.0, -0.5);
    let seen = radiance(&World::new(&scene), 16, 16, 100, 0, 1).mean;
    assert!(seen.abs_diff_eq(DVec3::splat(1.25), 1e-6), "{seen}");
}

#[test]
fn lights_block_light_on_both_sides() {
    let down = LightKind::Distant { direction: -Vec3::Y, angular_radius: 0.0, irradiance: Vec3::ONE };
    for edge_v in [Vec3::Z, -Vec3::Z] {
        let plate = LightKind::Rectangle { center: Vec3::Y, edge_u: Vec3::X, edge_v, flux: Vec3::ZERO };
        let lights = vec![named(down.clone()), named(plate)];
        let scene = scene(vec![(floor(3.0), diffuse(0.5), Vec3::ZERO)], lights);
        let world = World::new(&scene);
        let under = |x: f64| irradiance_at(&world, x * DVec3::X, DVec3::Y, 100, 3).direct.mean.x;
        assert_eq!((under(0.49), under(0.51)), (0.0, 1.0));
        let (edge_u, edge_v) = (2.0 * DVec3::X, -0.9 * DVec3::Z);
        let region = Region { center: DVec3::ZERO, edge_u, edge_v, columns: 4, rows: 1 };
        let above = Sphere { center: DVec3::ZERO, radius: 1.2 };
        let direct = irradiance_on(&world, &region, Some(&above), 1_000_000, 3).direct;
        assert!(direct[1].mean.x == 0.0 && direct[2].mean.x == 0.0);
        assert_is(&direct[0], 1.0, "beside the plate");
    }
}
