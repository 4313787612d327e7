//! Surfaces that lose nothing cannot be seen in light that is even from everywhere.

mod shapes;

use diacaustic_reference::camera::radiance;
use diacaustic_reference::geometry::World;
use diacaustic_scene::{Dispersion, MaterialKind, Mesh, PLASTIC_REFLECTANCE, Scene};
use glam::{DVec3, Vec3};

use shapes::{ball, block, flat, floor, glass, named, scene};

const PIXELS: [(u32, u32); 5] = [(16, 16), (12, 14), (9, 16), (20, 19), (0, 0)];

fn in_uniform_light(parts: Vec<(Mesh, MaterialKind, Vec3)>) -> Scene {
    Scene { background: Vec3::ONE, ..scene(parts, Vec::new()) }
}

fn ranked(ior: f32, priority: i32) -> MaterialKind {
    let (tint, absorption) = (Vec3::ONE, Vec3::ZERO);
    MaterialKind::Dielectric { ior, dispersion: Dispersion::None, tint, absorption, roughness: 0.0, priority }
}

fn assert_invisible(scene: &Scene) {
    let world = World::new(scene);
    for (x, y) in PIXELS {
        let estimate = radiance(&world, x, y, 2000, 0, 7);
        assert!(estimate.mean.abs_diff_eq(DVec3::ONE, 1e-9), "pixel ({x}, {y}): {}", estimate.mean);
    }
}

/// Shells that overlap, one material twice, and one that fills a part of another.
fn overlapping() -> Vec<(Mesh, MaterialKind, Vec3)> {
    vec![
        (flat(ball(0.8, 3)), ranked(1.33, 0), Vec3::ZERO),
        (flat(ball(0.5, 2)), ranked(1.7, 5), Vec3::new(0.5, 0.1, 0.2)),
        (block(Vec3::splat(-0.3), Vec3::splat(0.35)), ranked(1.5, 2), Vec3::new(-0.4, 0.2, 0.3)),
        (flat(ball(0.4, 2)), ranked(1.0, 9), Vec3::new(0.1, -0.3, 0.1)),
    ]
}

#[test]
fn overlapping_glass_of_several_priorities() {
    let mut parts = overlapping();
    assert_invisible(&in_uniform_light(parts.clone()));
    parts.push((flat(ball(0.45, 2)), ranked(1.33, 0), Vec3::new(-0.6, -0.3, 0.0)));
    let mut scene = in_uniform_light(parts);
    // The last ball is of the first's material.
    scene.objects[4].materials = vec![0];
    assert_invisible(&scene);
}

#[test]
fn camera_inside_glass() {
    let mut scene = in_uniform_light(vec![(ball(1.0, 5), glass(1.5), Vec3::ZERO)]);
    scene.camera.position = Vec3::ZERO;
    scene.camera.look_at = Vec3::new(0.3, 0.2, 1.0);
    assert_invisible(&scene);
    // A bubble of air around the camera, in the glass.
    scene.materials.push(scene.materials[0].clone());
    scene.materials[1].kind = ranked(1.0, 1);
    let mut bubble = scene.objects[0].clone();
    bubble.mesh = std::sync::Arc::new(ball(0.3, 5));
    bubble.materials = vec![1];
    scene.objects.push(bubble);
    assert_invisible(&scene);
}

#[test]
fn camera_inside_overlapping_glass() {
    let mut scene = in_uniform_light(overlapping());
    scene.camera.position = Vec3::new(0.3, 0.0, 0.2);
    scene.camera.look_at = Vec3::new(-1.0, 0.2, 1.0);
    let world = World::new(&scene);
    for (x, y) in PIXELS {
        let estimate = radiance(&world, x, y, 2000, 0, 7).mean.x;
        // Total reflection holds some of it in edges for good.
        assert!((estimate - 1.0).abs() < 0.01, "pixel ({x}, {y}): {estimate}");
    }
}

#[test]
fn thin_walls() {
    let wall = || MaterialKind::ThinWalled { ior: 1.5, tint: Vec3::ONE, roughness: 0.0 };
    let pane = Mesh::rectangle(Vec3::ZERO, 2.0 * Vec3::X, 2.0 * Vec3::Y);
    let parts = vec![
        (ball(0.5, 3), wall(), Vec3::new(0.3, 0.0, 0.0)),
        (pane, wall(), Vec3::ZERO),
        (flat(ball(0.6, 2)), glass(1.5), Vec3::new(0.0, 0.4, 0.0)),
    ];
    assert_invisible(&in_uniform_light(parts));
}

/// What a floor of a material shows in even light of radiance 1, with its deviation: from the constant background, and
/// from an environment of the same radiance. Seen at 45°.
fn shown(kind: MaterialKind) -> [(f64, f64); 2] {
    let mut scene = in_uniform_light(vec![(floor(2.0), kind, Vec3::ZERO)]);
    scene.camera.position = Vec3::new(0.0, 4.0, 4.0);
    let see = |scene: &Scene| {
        let seen = radiance(&World::new(scene), 16, 16, 400_000, 4, 7);
        (seen.mean.x, seen.variance.x.sqrt())
    };
    let by_background = see(&scene);
    let map = diacaustic_scene::RadianceMap { width: 4, height: 2, texels: vec![Vec3::ONE; 8] };
    scene.background = Vec3::ZERO;
    scene.lights.push(named(diacaustic_scene::LightKind::Environment {
        map: std::sync::Arc::new(map),
        rotate: 0.0,
        scale: Vec3::ONE,
    }));
    [by_background, see(&scene)]
}

#[test]
fn white_bases_give_back_all_that_enters() {
    for roughness in [0.0, 0.03, 0.1] {
        let coated = MaterialKind::Coated { albedo: Vec3::ONE, ior: 1.5, roughness };
        let plastic = MaterialKind::MetallicRoughness {
            base_color: Vec3::ONE,
            reflectance: PLASTIC_REFLECTANCE,
            metallic: 0.0,
            roughness,
        };
        let metal = MaterialKind::MetallicRoughness {
            base_color: Vec3::ONE,
            reflectance: PLASTIC_REFLECTANCE,
            metallic: 1.0,
            roughness,
        };
        for kind in [coated, plastic, metal] {
            for (seen, deviation) in shown(kind.clone()) {
                assert!((seen - 1.0).abs() < 4.0 * deviation + 2e-3, "{kind:?}: {seen} ± {deviation}");
                assert!(deviation < 3e-3, "{kind:?}: ± {deviation}");
            }
        }
    }
}

#[test]
fn rough_gloss_of_receivers_loses_little() {
    for roughness in [0.3, 0.6, 1.0] {
        let coated = MaterialKind::Coated { albedo: Vec3::ONE, ior: 1.5, roughness };
        let plastic = MaterialKind::MetallicRoughness {
            base_color: Vec3::ONE,
            reflectance: PLASTIC_REFLECTANCE,
            metallic: 0.0,
            roughness,
        };
        for (kind, least) in [(coated, 0.9), (plastic, 0.9)] {
            let [(by_lobes, a), (by_sampling, b)] = shown(kind.clone());
            assert!((least..1.005).contains(&by_lobes), "{kind:?}: {by_lobes}");
            let tolerance = 4.0 * (a * a + b * b).sqrt();
            assert!((by_lobes - by_sampling).abs() < tolerance, "{kind:?}: {by_lobes} and {by_sampling} ± {tolerance}");
        }
    }
}
