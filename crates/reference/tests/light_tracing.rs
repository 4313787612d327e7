//! Light followed from its source against paths from the eye, and photons against both.

mod shapes;
mod under_a_ball;

use diacaustic_reference::camera::Estimate;
use diacaustic_reference::geometry::{Sphere, World};
use diacaustic_reference::light_tracing::{Lighting, irradiance_on};
use diacaustic_reference::photons::{Emission, MapLayout, PhotonJob, trace};
use diacaustic_scene::{Light, LightKind, MaterialKind, Mesh, Scene};
use glam::{DVec2, DVec3, Vec3};

use shapes::{ball, block, diffuse, flat, floor, frosted, glass, light, named, scene};
use under_a_ball::{BALL, RADIUS, around_the_ball, fine_ball, floor_region, under_a_ball, via_casters_on_bin};

fn point(flux: f32) -> Light {
    named(LightKind::Point { position: Vec3::new(0.3, 2.2, 0.2), flux: Vec3::splat(flux) })
}

fn assert_agree(traced: &Estimate, found: &Estimate, systematic: f64, name: &str) {
    let deviation = (traced.variance.x + found.variance.x).sqrt();
    assert!(deviation < 0.05 * found.mean.x, "{name}: ± {deviation} of {} is too loose", found.mean.x);
    let difference = (traced.mean.x - found.mean.x).abs();
    let allowed = 4.5 * deviation + systematic * found.mean.x;
    assert!(
        difference < allowed,
        "{name}: {} from the light, {} from the eye ± {allowed}",
        traced.mean.x,
        found.mean.x
    );
}

/// Both ways to the light on the floor that came by the ball, bin by bin.
fn assert_both_ways(scene: &Scene, bins: usize, samples: u32, name: &str) {
    let world = World::new(scene);
    let region = floor_region(bins);
    let traced = irradiance_on(&world, &region, Some(&around_the_ball()), 500_000, 3).via_casters;
    for (bin, traced) in traced.iter().enumerate() {
        let found = via_casters_on_bin(&world, &region, bin, samples);
        assert_agree(traced, &found, 0.005, &format!("{name}, bin {bin}"));
    }
}

#[test]
fn sphere_light_through_a_glass_ball() {
    let lamp = || light(Vec3::new(0.3, 2.2, 0.2), 0.4, 10.0);
    assert_both_ways(&under_a_ball(fine_ball(), glass(1.4), lamp()), 2, 2500, "smooth");
    assert_both_ways(&under_a_ball(flat(ball(RADIUS as f32, 3)), glass(1.4), lamp()), 2, 2500, "facets");
}

#[test]
fn rectangle_and_disk_through_a_glass_ball() {
    let (center, flux) = (Vec3::new(0.3, 2.2, 0.2), Vec3::splat(10.0));
    let rectangle = LightKind::Rectangle { center, edge_u: 0.8 * Vec3::X, edge_v: 0.6 * Vec3::Z, flux };
    assert_both_ways(&under_a_ball(fine_ball(), glass(1.4), named(rectangle)), 2, 4000, "rectangle");
    let disk = LightKind::Disk { center, normal: Vec3::new(-0.1, -1.0, 0.0), radius: 0.5, flux };
    assert_both_ways(&under_a_ball(fine_ball(), glass(1.4), named(disk)), 2, 4000, "disk");
}

#[test]
fn shining_object_through_a_glass_ball() {
    let lamp = Mesh::rectangle(Vec3::new(0.3, 2.2, 0.2), 0.8 * Vec3::X, 0.6 * Vec3::Z);
    let mut scene = under_a_ball(fine_ball(), glass(1.4), point(0.0));
    let mut object = scene.objects[0].clone();
    object.mesh = std::sync::Arc::new(lamp);
    object.materials = vec![2];
    scene.objects.push(object);
    scene.materials.push(scene.materials[0].clone());
    scene.materials[2].emission = Vec3::splat(4.0);
    assert_both_ways(&scene, 2, 4000, "object");
}

#[test]
fn sky_through_a_glass_ball() {
    let map = diacaustic_scene::RadianceMap { width: 4, height: 2, texels: vec![Vec3::ONE; 8] };
    let (map, scale) = (std::sync::Arc::new(map), Vec3::ONE);
    let everywhere = LightKind::Environment { map, rotate: 0.0, scale };
    assert_both_ways(&under_a_ball(fine_ball(), glass(1.4), named(everywhere)), 2, 500, "environment");
    let direction = Vec3::new(0.1, -1.0, 0.2);
    let sun = LightKind::Distant { direction, angular_radius: 25.0, irradiance: Vec3::ONE };
    assert_both_ways(&under_a_ball(fine_ball(), glass(1.4), named(sun)), 2, 1500, "disc in the sky");
}

#[test]
fn point_light_by_way_of_rough_balls() {
    let metal = MaterialKind::Conductor { eta: Vec3::splat(0.2), k: Vec3::splat(3.0), roughness: 0.5 };
    let varnish = MaterialKind::Coated { albedo: Vec3::ONE, ior: 1.5, roughness: 0.25 };
    assert_both_ways(&under_a_ball(flat(ball(RADIUS as f32, 3)), frosted(1.4, 0.6), point(10.0)), 2, 2500, "frosted");
    // Reflection to the floor comes from the side.
    let side = |kind| {
        let position = Vec3::new(2.0, 0.5, 0.4);
        under_a_ball(flat(ball(RADIUS as f32, 3)), kind, named(LightKind::Point { position, flux: Vec3::splat(10.0) }))
    };
    assert_both_ways(&side(metal), 1, 5000, "metal");
    assert_both_ways(&side(varnish), 1, 20_000, "varnish");
}

#[test]
fn result_does_not_depend_on_the_number_of_threads() {
    let scene = under_a_ball(fine_ball(), frosted(1.4, 0.4), point(10.0));
    let world = World::new(&scene);
    let traced = || irradiance_on(&world, &floor_region(3), Some(&around_the_ball()), 50_000, 3);
    let alone = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a pool of one thread");
    assert_eq!(alone.install(traced), traced());
}

#[test]
fn restricted_emission_leaves_nothing_out() {
    let scene = under_a_ball(fine_ball(), glass(1.4), point(10.0));
    let world = World::new(&scene);
    let traced = |through: Option<&Sphere>, photons| irradiance_on(&world, &floor_region(1), through, photons, 3);
    let Lighting { via_casters: all, .. } = traced(None, 2_000_000);
    let Lighting { via_casters: aimed, .. } = traced(Some(&around_the_ball()), 200_000);
    assert_agree(&aimed[0], &all[0], 0.0, "aimed");
}

/// Holds the ball, and something of what is beside it.
const WIDE: Sphere = Sphere { center: DVec3::new(0.1, 0.6, 0.0), radius: 0.6 };

/// Mean irradiance that photons of a scene's only light bring to the floor by casters, toward two spheres that overlap.
fn by_photons(world: &World) -> f64 {
    // The first lies within the second.
    let casters = [around_the_ball(), WIDE];
    let photons = 1 << 18;
    let at = DVec2::new;
    let corners = vec![[at(0.0, 0.0), at(0.0, 1.0), at(1.0, 1.0)], [at(0.0, 0.0), at(1.0, 1.0), at(1.0, 0.0)]];
    let mut maps = vec![None; world.scene().objects.len()];
    maps[0] = Some(MapLayout { width: 2, height: 2, layers: 1, corners });
    let emission = Emission::Toward(&casters);
    let result =
        trace(&PhotonJob { world, maps: &maps, light: 0, emission, guide: None, seed: 1, photons: 0..photons });
    let error = (result.ledger.accounted() - result.ledger.emitted).abs().max_element() / result.ledger.emitted.x;
    assert!(error < 1e-11, "the ledger misses {error}");
    result.maps[0].iter().sum::<DVec3>().x / (f64::from(photons) * 0.36)
}

#[test]
fn photons_bring_what_light_tracing_finds() {
    let (position, flux) = (Vec3::new(0.3, 2.2, 0.2), Vec3::splat(10.0));
    let direction = Vec3::new(-0.1, -1.0, 0.0);
    let sky = |angular_radius| LightKind::Distant { direction, angular_radius, irradiance: Vec3::ONE };
    let lights = [
        LightKind::Point { position, flux },
        LightKind::Spot { position, direction, inner_angle: 5.0, outer_angle: 20.0, flux },
        sky(0.0),
        sky(30.0),
    ];
    let metal = MaterialKind::Conductor { eta: Vec3::splat(0.2), k: Vec3::splat(3.0), roughness: 0.2 };
    let extra = |kind| (block(Vec3::new(-0.3, 0.05, 0.1), Vec3::new(0.3, 0.15, 0.3)), kind, Vec3::ZERO);
    for (kind, other) in [
        (glass(1.4), MaterialKind::Coated { albedo: Vec3::ONE, ior: 1.5, roughness: 0.1 }),
        (frosted(1.4, 0.4), metal),
        (glass(1.3), MaterialKind::ThinWalled { ior: 1.5, tint: Vec3::splat(0.7), roughness: 0.0 }),
    ] {
        for light in &lights {
            let ball = (fine_ball(), kind.clone(), BALL.as_vec3());
            // A ball within the ball, which ranks lower: it is not there.
            let inner = (shapes::ball(0.2, 3), glass(1.9), BALL.as_vec3());
            let parts = vec![(floor(0.3), diffuse(0.5), Vec3::ZERO), ball, extra(other.clone()), inner];
            let scene = scene(parts, vec![named(light.clone())]);
            let world = World::new(&scene);
            let traced = irradiance_on(&world, &floor_region(1), Some(&WIDE), 300_000, 3);
            let (expected, deviation) = (traced.via_casters[0].mean.x, traced.via_casters[0].variance.x.sqrt());
            let found = by_photons(&world);
            let tolerance = 4.5 * deviation + 0.003 * expected;
            assert!(tolerance < 0.05 * expected, "{light:?}: {expected} ± {tolerance} is too loose");
            assert!((found - expected).abs() < tolerance, "{light:?}: {found} by photons, {expected} ± {tolerance}");
        }
    }
}
