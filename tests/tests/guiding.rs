//! Guided photons: as much light as without, less noise where the picture shows it, and the same bits in every run.

use std::f64::consts::PI;

use diacaustic::{EnergyMap, Renderer, glam::DVec3};
use diacaustic_scene::Scene;
use diacaustic_tests::{emit, mean, renderer, scene};

const LAMP: &str = "{ type = \"sphere\", center = [1.0, 2.5, 0.6], radius = 0.05, flux = 35 }";

fn over_a_floor(mesh: &str, light: &str) -> Scene {
    scene(&format!(
        "camera = {{ position = [0, 6, 0.1], look_at = [0, 0, 0], vertical_fov = 40 }}
         render = {{ width = 64, height = 64, map_size = 129, seed = 5 }}
         materials.glass = {{ type = \"dielectric\", ior = 1.5, absorption = [0.5, 0, 1] }}
         materials.floor = {{ type = \"diffuse\", albedo = 0.8 }}
         lights = [{light}]
         objects = [
             {{ mesh = \"assets/meshes/{mesh}.obj\", material = \"glass\", translate = [0, 0.2, 0] }},
             {{ rectangle = {{ center = [0, 0, 0], edge_u = [4, 0, 0], edge_v = [0, 0, -4] }}, material = \"floor\" }},
         ]"
    ))
}

/// The floor's map after some photons of the scene with another seed.
fn map(renderer: &mut Renderer, scene: &Scene, guiding: bool, seed: u32, photons: u64) -> EnergyMap {
    let mut scene = scene.clone();
    scene.settings.guiding = guiding;
    scene.settings.seed = seed;
    renderer.set_scene(&scene).unwrap();
    renderer.emit_photons(0..photons).unwrap();
    assert!(renderer.statistics().unwrap().ledgers.iter().all(|ledger| ledger.residue() == [0; 3]), "an open ledger");
    renderer.energy_map(1).unwrap().unwrap()
}

/// Flux in a map, W.
fn total(map: &EnergyMap) -> DVec3 {
    (0..map.sums.len()).map(|texel| map.flux(texel)).sum()
}

/// Mean of some numbers and the variance of their mean.
fn mean_and_variance(values: &[f64]) -> (f64, f64) {
    let middle = mean(values.iter().copied());
    let squares = mean(values.iter().map(|value| (value - middle).powi(2)));
    (middle, squares / (values.len() - 1) as f64)
}

/// Asserts that the flux in the floor's map is the same with and without a guide, over some seeds.
fn assert_same_flux(renderer: &mut Renderer, scene: &Scene, photons: u64, light: &str) {
    const SEEDS: u32 = 8;
    let mut fluxes = |guiding| -> Vec<f64> {
        (0..SEEDS).map(|seed| total(&map(renderer, scene, guiding, seed, photons)).element_sum()).collect()
    };
    let (guided, guided_variance) = mean_and_variance(&fluxes(true));
    let (plain, plain_variance) = mean_and_variance(&fluxes(false));
    let z = (guided - plain) / (guided_variance + plain_variance).sqrt();
    assert!(plain > 0.0, "{light}: no flux");
    assert!((guided / plain - 1.0).abs() < 0.01, "{light}: {guided} W with guide, {plain} W without");
    // With 7 degrees of freedom each, about 1 in 10,000 runs of a right implementation passes 6.
    assert!(z.abs() < 6.0, "{light}: {guided} W with guide, {plain} W without: {z} standard deviations apart");
}

#[test]
fn every_kind_of_light_brings_the_same_flux() {
    let mut renderer = renderer(&over_a_floor("ball", LAMP));
    for light in [
        LAMP,
        "{ type = \"sphere\", center = [0, 1.05, 0], radius = 0.2, flux = 35 }",
        "{ type = \"point\", position = [1, 2.5, 0.6], flux = 35 }",
        "{ type = \"spot\", position = [1, 2.5, 0.6], look_at = [0.1, 0.3, 0], inner_angle = 3, outer_angle = 9, flux = 5 }",
        "{ type = \"directional\", direction = [-0.4, -1, -0.2], irradiance = 3 }",
        "{ type = \"sun\", direction = [-0.4, -1, -0.2], angular_radius = 2, irradiance = 3 }",
        "{ type = \"rectangle\", center = [0.5, 2, 0.3], edge_u = [0.6, 0, 0], edge_v = [0, 0, 0.4], flux = 35 }",
        "{ type = \"disk\", center = [0.5, 2, 0.3], normal = [0, -1, 0], radius = 0.3, flux = 35 }",
        "{ type = \"environment\", image = \"assets/environments/sky.hdr\", scale = 0.5 }",
    ] {
        assert_same_flux(&mut renderer, &over_a_floor("ball", light), 1 << 15, light);
    }
}

/// Two glass balls, one before the other, over a varnished table, in whose bounding sphere near lights stand: most rays from any light
/// could have been sent by several of its targets.
fn crowded(light: &str) -> Scene {
    scene(&format!(
        "camera = {{ position = [0, 6, 0.1], look_at = [0, 0, 0], vertical_fov = 40 }}
         render = {{ width = 64, height = 64, map_size = 129, seed = 5 }}
         materials.glass = {{ type = \"dielectric\", ior = 1.5 }}
         materials.table = {{ type = \"coated\", albedo = 0.5 }}
         lights = [{light}]
         objects = [
             {{ sphere = {{ center = [0, 0.301, 0], radius = 0.3 }}, material = \"glass\" }},
             {{ rectangle = {{ center = [0, 0, 0], edge_u = [4, 0, 0], edge_v = [0, 0, -4] }}, material = \"table\" }},
             {{ sphere = {{ center = [0.15, 0.8, 0.1], radius = 0.15 }}, material = \"glass\" }},
         ]"
    ))
}

const NEAR_LAMP: &str = "{ type = \"sphere\", center = [0.8, 1.2, 0.4], radius = 0.05, flux = 35 }";

#[test]
fn targets_that_overlap_bring_the_same_flux() {
    let mut renderer = renderer(&crowded(LAMP));
    for light in [
        "{ type = \"sphere\", center = [1.5, 4.5, 0.6], radius = 0.05, flux = 35 }",
        NEAR_LAMP,
        "{ type = \"point\", position = [0.5, 2.5, 0.3], flux = 35 }",
        "{ type = \"directional\", direction = [-0.2, -1, -0.1], irradiance = 3 }",
        "{ type = \"rectangle\", center = [0.3, 2, 0.2], edge_u = [0.6, 0, 0], edge_v = [0, 0, 0.4], flux = 35 }",
        "{ type = \"environment\", image = \"assets/environments/sky.hdr\", scale = 0.5 }",
    ] {
        assert_same_flux(&mut renderer, &crowded(light), 1 << 16, light);
    }
}

#[test]
fn a_guide_lowers_the_variance_where_targets_overlap() {
    let sunlight = "{ type = \"directional\", direction = [-0.2, -1, -0.1], irradiance = 3 }";
    for (light, least_gain) in [(NEAR_LAMP, 1.2), (sunlight, 1.2)] {
        let scene = crowded(light);
        let mut renderer = renderer(&scene);
        let guided = relative_variance(&mut renderer, &scene, true, 0.5);
        let plain = relative_variance(&mut renderer, &scene, false, 0.5);
        assert!(least_gain * guided < plain, "{light}: variance {guided} with guide, {plain} without");
    }
}

/// Light that a coated plane reflects onto a wall, and what its base takes, which the camera pass brings.
#[test]
fn all_photons_that_meet_a_coat_go_on_with_what_it_reflects() {
    let scene = scene(
        "camera = { position = [-2, 1.5, 3], look_at = [0.5, 0.5, 0], vertical_fov = 50 }
         render = { width = 64, height = 64, map_size = 65, guiding = false }
         materials.coat = { type = \"coated\", albedo = 0.5, ior = 1.5 }
         materials.wall = { type = \"diffuse\", albedo = 0.8 }
         lights = [{ type = \"directional\", direction = [1, -1, 0], irradiance = 1 }]
         objects = [
             { rectangle = { center = [0, 0, 0], edge_u = [1, 0, 0], edge_v = [0, 0, -1] }, material = \"coat\" },
             { rectangle = { center = [0.6, 1, 0], edge_u = [0, 3, 0], edge_v = [0, 0, 3] }, material = \"wall\" },
         ]",
    );
    const PHOTONS: u64 = 1 << 14;
    let renderer = emit(&scene, PHOTONS);
    // Fresnel's equations at 45°, onto 1 m² at that angle.
    let (cos_i, cos_t) = (0.5f64.sqrt(), (1.0 - 0.5 / 2.25f64).sqrt());
    let r_s = (cos_i - 1.5 * cos_t) / (cos_i + 1.5 * cos_t);
    let r_p = (1.5 * cos_i - cos_t) / (1.5 * cos_i + cos_t);
    let reflected = 0.5 * (r_s * r_s + r_p * r_p);
    let statistics = renderer.statistics().unwrap();
    let ledger = statistics.ledgers[0];
    assert_eq!(ledger.residue(), [0; 3]);
    let on_wall = total(&renderer.energy_map(1).unwrap().unwrap()).y;
    // Choosing gloss by chance would leave 5 % of the photons, and a deviation of 4 % of this flux.
    let expected = reflected * cos_i;
    assert!((on_wall / expected - 1.0).abs() < 0.01, "{on_wall} W on the wall, not {expected}");
    let met = statistics.deposits as f64 / PHOTONS as f64;
    // Of the bounding sphere's cross-section, π/2 m², the plane shows cos 45° m².
    assert!((met / (cos_i / (PI / 2.0)) - 1.0).abs() < 0.01, "{met} of the photons reach the wall");
    let kept = ledger.watts(ledger.deposited, PHOTONS).y / (ledger.watts(ledger.emitted, PHOTONS).y * met);
    assert!((kept / reflected - 1.0).abs() < 1e-3, "photons keep {kept}, not {reflected}");
}

/// Mean over texels of the variance over seeds, relative to the square of what the camera sees there: the map's irradiance and `direct`.
fn relative_variance(renderer: &mut Renderer, scene: &Scene, guiding: bool, direct: f64) -> f64 {
    let maps: Vec<EnergyMap> = (0..8).map(|seed| map(renderer, scene, guiding, seed, 1 << 16)).collect();
    let texels = maps[0].sums.len();
    mean((0..texels).map(|texel| {
        let values: Vec<f64> = maps.iter().map(|map| map.irradiance(texel).y).collect();
        let (middle, variance) = mean_and_variance(&values);
        variance / (middle + direct).powi(2)
    }))
}

#[test]
fn a_guide_lowers_the_variance() {
    // A crystal's facets spread light so far that few photons are lost without a guide.
    for (mesh, least_gain) in [("teapot", 1.8), ("crystal", 1.1)] {
        let scene = over_a_floor(mesh, LAMP);
        let mut renderer = renderer(&scene);
        let guided = relative_variance(&mut renderer, &scene, true, 0.5);
        let plain = relative_variance(&mut renderer, &scene, false, 0.5);
        assert!(least_gain * guided < plain, "{mesh}: variance {guided} with guide, {plain} without");
    }
}

#[test]
fn guides_and_maps_are_the_same_in_every_run_and_in_pieces() {
    let scene = over_a_floor("teapot", LAMP);
    let whole = emit(&scene, 100_000);
    let mut pieces = renderer(&scene);
    assert_eq!(whole.guide(0).unwrap(), pieces.guide(0).unwrap());
    pieces.emit_photons(33_333..100_000).unwrap();
    pieces.emit_photons(0..33_333).unwrap();
    assert_eq!(whole.energy_map(1).unwrap(), pieces.energy_map(1).unwrap());

    let mut other = scene.clone();
    other.settings.seed += 1;
    assert_ne!(whole.guide(0).unwrap(), renderer(&other).guide(0).unwrap(), "the comparison cannot fail");
    other.settings.guiding = false;
    assert_eq!(renderer(&other).guide(0).unwrap(), None);
}

#[test]
fn the_pilot_leaves_no_trace() {
    let scene = over_a_floor("teapot", LAMP);
    let renderer = renderer(&scene);
    let statistics = renderer.statistics().unwrap();
    assert_eq!((statistics.photons, statistics.photon_rays, statistics.camera_rays), (0, 0, 0));
    assert!(statistics.ledgers.iter().all(|ledger| ledger.emitted == [0; 3]));
    assert!(renderer.energy_map(1).unwrap().unwrap().sums.iter().all(|sum| *sum == [0; 3]));
    assert!(renderer.film().unwrap().radiance.iter().all(|pixel| *pixel == [0.0; 3]));
}

/// The share of photons that reach a receiver through a caster.
fn deposit_share(scene: &Scene) -> f64 {
    let statistics = emit(scene, 1 << 17).statistics().unwrap();
    statistics.deposits as f64 / statistics.photons as f64
}

#[test]
fn most_photons_reach_a_receiver() {
    // A light at the side of its caster, so that most of the disc it aims at is empty, and walls that take what is reflected.
    let mut scene = scene(
        "camera = { position = [0, 1, 1.9], look_at = [0, 0.4, 0], vertical_fov = 60 }
         render = { width = 64, height = 64, map_size = 65 }
         materials.glass = { type = \"dielectric\", ior = 1.5 }
         materials.wall = { type = \"diffuse\", albedo = 0.8 }
         lights = [{ type = \"point\", position = [0, 1.8, 0], flux = 35 }]
         objects = [
             { mesh = \"assets/meshes/teapot.obj\", material = \"glass\", translate = [0, 0.2, 0] },
             { box = { min = [-2, 0, -2], max = [2, 2, 2] }, material = \"wall\" },
         ]",
    );
    let guided = deposit_share(&scene);
    assert!(guided >= 0.9, "only {guided} of the photons");
    scene.settings.guiding = false;
    let plain = deposit_share(&scene);
    assert!(plain < 0.7, "{plain} without a guide: the scene shows nothing");
}

/// Two balls on two floors, of which the camera sees the first.
fn two_floors() -> Scene {
    scene(
        "camera = { position = [-3, 1.5, 2], look_at = [-3, 0, 0], vertical_fov = 40 }
         render = { width = 64, height = 64, map_size = 65 }
         materials.glass = { type = \"dielectric\", ior = 1.5 }
         materials.floor = { type = \"diffuse\", albedo = 0.8 }
         lights = [{ type = \"point\", position = [0, 3, 0], flux = 35 }]
         objects = [
             { rectangle = { center = [-3, 0, 0], edge_u = [2, 0, 0], edge_v = [0, 0, -2] }, material = \"floor\" },
             { rectangle = { center = [3, 0, 0], edge_u = [2, 0, 0], edge_v = [0, 0, -2] }, material = \"floor\" },
             { sphere = { center = [-3, 0.5, 0], radius = 0.3 }, material = \"glass\" },
             { sphere = { center = [3, 0.5, 0], radius = 0.3 }, material = \"glass\" },
         ]",
    )
}

#[test]
fn a_receiver_that_the_camera_does_not_see_gets_few_photons_and_all_its_light() {
    let scene = two_floors();
    let mut renderer = renderer(&scene);
    let guide = renderer.guide(0).unwrap().unwrap();
    // The second target's columns are the second half.
    let unseen = 1.0 - guide.aim.column_bounds[guide.aim.columns / 2];
    assert!(unseen > 0.02 && unseen < 0.2, "{unseen} of the photons fly to the unseen ball");
    assert_same_flux(&mut renderer, &scene, 1 << 16, "the floor that is not seen");
}

#[test]
fn every_emission_number_keeps_a_probability() {
    let sky = "{ type = \"environment\", image = \"assets/environments/sky.hdr\", scale = 0.5 }";
    // What the pilot missed flies with a density of 1/64 at least, of 1/16 in each of two tables, but for the rounding of the bounds.
    for (scene, bound) in [
        (over_a_floor("teapot", LAMP), 1.0 / 64.0),
        (over_a_floor("ball", sky), 1.0 / 256.0),
        (two_floors(), 1.0 / 64.0),
        (crowded(NEAR_LAMP), 1.0 / 64.0),
    ] {
        let renderer = renderer(&scene);
        let least = renderer.guide(0).unwrap().unwrap().least_density();
        assert!(least > 0.97 * bound, "a density of {least}");
    }
}
