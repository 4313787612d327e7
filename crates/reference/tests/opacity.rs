//! Surfaces that rays may pass as if they were not there.

mod shapes;

use diacaustic_reference::camera::{irradiance_at, radiance};
use diacaustic_reference::geometry::{Sphere, World};
use diacaustic_reference::light_tracing::{Region, irradiance_on};
use diacaustic_reference::photons::{Emission, End, PhotonJob, PhotonPath, trace_one};
use diacaustic_scene::{Light, MaterialKind, Mesh, Scene, Texture, TextureFilter};
use glam::{DVec3, Vec3};

use shapes::{diffuse, light, parallel, picture, plate, scene, speckle};

/// A floor under a screen of 2 m at y = 1.
fn screened(kind: MaterialKind, opacity: f32, light: Light) -> Scene {
    let parts = vec![(plate(0.0, 8.0), diffuse(0.5), Vec3::ZERO), (plate(1.0, 2.0), kind, Vec3::ZERO)];
    let mut scene = scene(parts, vec![light]);
    scene.materials[1].opacity = opacity;
    scene
}

fn mirror() -> MaterialKind {
    MaterialKind::Mirror { reflectance: Vec3::ONE }
}

/// Well within the screen.
const WITHIN: Sphere = Sphere { center: DVec3::Y, radius: 0.7 };

fn photons(scene: &Scene, count: u32) -> Vec<PhotonPath> {
    let world = World::new(scene);
    let emission = Emission::Toward(&[WITHIN]);
    let job = PhotonJob { world: &world, maps: &[], light: 0, emission, guide: None, seed: 1, photons: 0..count };
    (0..count).map(|photon| trace_one(&job, photon)).collect()
}

/// Whether a number of successes out of so many is likely for their probability.
fn assert_binomial(found: usize, count: u32, probability: f64, name: &str) {
    let count = f64::from(count);
    let deviation = (count * probability * (1.0 - probability)).sqrt();
    let difference = found as f64 - count * probability;
    assert!(difference.abs() < 4.5 * deviation, "{name}: {found} of {count} for {probability}");
}

#[test]
fn photons_pass_with_the_complement_of_the_opacity() {
    let count = 20_000;
    for opacity in [0.25, 0.9] {
        let paths = photons(&screened(mirror(), opacity, parallel(-Vec3::Y)), count);
        // What passes has met no caster.
        let passed = paths.iter().filter(|path| matches!(path.end, End::Direct(_)));
        assert_binomial(passed.count(), count, 1.0 - f64::from(opacity), "mirror");
        let reflected = paths.iter().filter(|path| path.end == End::Escaped).count();
        assert_binomial(reflected, count, f64::from(opacity), "mirror");
    }
}

#[test]
fn every_triangle_decides_anew() {
    let mut scene = screened(diffuse(0.5), 0.25, parallel(-Vec3::Y));
    let mut second = scene.objects[1].clone();
    second.world_from_object.translation.y = 0.5;
    scene.objects.push(second);
    let count = 20_000;
    let ended = |height: f64| {
        let is_there = |path: &&PhotonPath| (path.vertices[0].position.y - height).abs() < 1e-6;
        photons(&scene, count).iter().filter(is_there).count()
    };
    assert_binomial(ended(1.5), count, 0.25, "upper");
    assert_binomial(ended(1.0), count, 0.75 * 0.25, "lower");
    assert_binomial(ended(0.0), count, 0.75 * 0.75, "floor");
}

#[test]
fn shadow_rays_pass_with_the_complement_of_the_opacity() {
    // From one point to parallel light all of them are the same ray.
    let scene = screened(diffuse(0.5), 0.25, parallel(-Vec3::Y));
    let world = World::new(&scene);
    let count = 20_000;
    let beside_the_diagonal = DVec3::new(0.1, 0.0, 0.2);
    let direct = irradiance_at(&world, beside_the_diagonal, DVec3::Y, count, 3).direct.mean.x;
    assert_binomial((direct / 3.0 * f64::from(count)).round() as usize, count, 0.75, "point");
    let (edge_u, edge_v) = (DVec3::X, -DVec3::Z);
    let region = Region { center: DVec3::ZERO, edge_u, edge_v, columns: 1, rows: 1 };
    let traced = irradiance_on(&world, &region, Some(&WITHIN), 200_000, 3).direct[0];
    assert!(traced.deviations(DVec3::splat(2.25)).abs().max_element() < 4.5, "{traced:?}");
    // The eye sees the floor's light through the screen, or the screen.
    let mut scene = scene.clone();
    scene.camera.position = 3.0 * Vec3::Y;
    scene.camera.up = -Vec3::Z;
    scene.materials[0].kind = diffuse(0.8);
    let seen = radiance(&World::new(&scene), 16, 16, 40_000, 0, 3);
    let expected = 3.0 / std::f64::consts::PI * (0.75 * 0.75 * 0.8 + 0.25 * 0.5);
    assert!(seen.deviations(DVec3::splat(expected)).abs().max_element() < 4.5, "{seen:?} for {expected}");
    assert!(seen.variance.x.sqrt() < 0.01 * expected);
}

#[test]
fn nothing_and_everything_are_exact() {
    let lamp = || light(Vec3::new(0.0, 2.0, 0.0), 0.3, 10.0);
    let seen = |scene: &Scene| irradiance_at(&World::new(scene), DVec3::ZERO, DVec3::Y, 1000, 3);
    let mut open = screened(mirror(), 0.0, lamp());
    let through = seen(&open);
    assert_eq!(seen(&screened(mirror(), 1.0, lamp())).direct.mean, DVec3::ZERO);
    open.objects[1].mesh = std::sync::Arc::new(Mesh { triangles: Vec::new(), ..plate(1.0, 2.0) });
    assert_eq!(through, seen(&open));
}

#[test]
fn cutoff_cuts_a_mask() {
    let holes = picture(8, 8, |column, row| [speckle(column, row); 4]);
    let mut scene = screened(mirror(), 0.5, parallel(-Vec3::Y));
    scene.materials[1].opacity_cutoff = Some(0.25);
    scene.materials[1].textures.opacity = Some(Texture { filter: TextureFilter::Nearest, ..holes });
    // Texels of 1/64ths: at 1/2 exactly the surface stands.
    let stands = |column: u32, row: u32| speckle(column, row) >= 0.5;
    let texel_at = |p: DVec3| ((4.0 * (p.x + 1.0)) as u32, (4.0 * (p.z + 1.0)) as u32);
    let world = World::new(&scene);
    let mut open = 0;
    for (column, row) in (0..8).flat_map(|column| (0..8).map(move |row| (column, row))) {
        let middle = |k: u32| (f64::from(k) + 0.5) / 4.0 - 1.0;
        let point = DVec3::new(middle(column), 0.0, middle(row));
        let direct = irradiance_at(&world, point, DVec3::Y, 10, 3).direct.mean.x;
        assert_eq!(direct, if stands(column, row) { 0.0 } else { 3.0 }, "({column}, {row})");
        open += u32::from(!stands(column, row));
    }
    assert!((10..54).contains(&open), "{open} of 64 are open");
    for path in photons(&scene, 2000) {
        let (column, row) = texel_at(path.start.origin);
        assert_eq!(matches!(path.end, End::Direct(_)), !stands(column, row));
    }
}
