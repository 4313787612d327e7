//! Light of many wavelengths: angles that are known, and white that stays white.

use std::{f64::consts::PI, sync::Arc};

use diacaustic::{EnergyMap, Film};
use diacaustic_scene::{Dispersion, Material, MaterialKind, Mesh, Object, Scene, substance};
use diacaustic_tests::{emit, render, samples_of, scene};
use glam::{Affine3A, DVec3, Vec3};

fn glass(ior: f32, dispersion: Dispersion) -> MaterialKind {
    MaterialKind::Dielectric { ior, dispersion, tint: Vec3::ONE, absorption: Vec3::ZERO, roughness: 0.0, priority: 0 }
}

/// The prism's edges: side and depth, metres.
const PRISM: [f32; 2] = [0.1, 0.5];

/// A prism of 60° whose apex is up and along z.
fn prism() -> Mesh {
    let [side, depth] = PRISM;
    let height = side * 3f32.sqrt() / 2.0;
    let section = [Vec3::new(-side / 2.0, 0.0, 0.0), Vec3::new(side / 2.0, 0.0, 0.0), Vec3::new(0.0, height, 0.0)];
    let positions = section.iter().map(|p| *p - depth * Vec3::Z).chain(section.iter().map(|p| *p + depth * Vec3::Z));
    let triangles = vec![[0, 2, 1], [3, 4, 5], [0, 1, 4], [0, 4, 3], [1, 2, 5], [1, 5, 4], [2, 0, 3], [2, 3, 5]];
    let mesh = Mesh { positions: positions.collect(), triangles, ..Mesh::default() };
    assert!(mesh.signed_volume() > 0.0 && mesh.open_edges() == 0);
    mesh
}

/// The angle, degrees, by which a prism turns light that falls on it as for a deviation of `expected` degrees at its minimum.
fn deviation(kind: MaterialKind, wavelength: Option<f32>, expected: f64) -> f64 {
    let half = 0.5 * expected.to_radians();
    // Light parallel to the base inside comes from below the left: it rises by half the deviation and leaves falling by it.
    let mut scene = scene(&format!(
        "camera = {{ position = [0, 0, 3], look_at = [0, 0, 0], vertical_fov = 40 }}
         render = {{ map_size = 2001, max_depth = 3 }}
         materials.screen = {{ type = \"diffuse\", albedo = 0.8 }}
         lights = [{{ type = \"directional\", direction = [{}, {}, 0], irradiance = 1 }}]
         objects = [
             {{ rectangle = {{ center = [10, -3, 0], edge_u = [0, 3, 0], edge_v = [0, 0, 0.2] }}, material = \"screen\" }},
         ]",
        half.cos(),
        half.sin()
    ));
    scene.settings.wavelength = wavelength;
    scene.materials.push(Material::new("glass", kind));
    scene.objects.push(Object {
        name: "prism".to_owned(),
        mesh: Arc::new(prism()),
        world_from_object: Affine3A::IDENTITY,
        materials: vec![scene.materials.len() - 1],
        map_size: None,
    });
    let map = emit(&scene, 1 << 18).energy_map(0).unwrap().expect("the screen is a receiver");
    let middle = middle_of_beam(&map);
    // The beam's middle leaves the right face at half height.
    let [side, _] = PRISM.map(f64::from);
    let from = (side / 4.0, side * 3f64.sqrt() / 4.0);
    ((from.1 - middle) / (10.0 - from.0)).atan().to_degrees() + half.to_degrees()
}

/// Where on the screen the middle of the beam falls, metres up: columns run from y = −4.5. The beam is some 9 cm wide; light through
/// the base lies elsewhere.
fn middle_of_beam(map: &EnergyMap) -> f64 {
    let place = |column: usize| column as f64 * 3.0 / f64::from(map.width - 1) - 4.5;
    let mut columns = vec![0.0; map.width as usize];
    for texel in 0..map.sums.len() {
        columns[texel % map.width as usize] += map.flux(texel).y;
    }
    let brightest = (0..columns.len()).max_by(|&a, &b| columns[a].total_cmp(&columns[b])).expect("columns");
    let lit: Vec<f64> =
        (0..columns.len()).filter(|&column| columns[column] > 0.5 * columns[brightest]).map(place).collect();
    assert!(lit.len() > 40 && lit[lit.len() - 1] - lit[0] < 0.1, "the beam is {} columns wide", lit.len());
    lit.iter().sum::<f64>() / lit.len() as f64
}

#[test]
fn prism_turns_light_by_its_minimum_deviation() {
    let found = deviation(glass(1.5168, Dispersion::None), None, 38.647);
    assert!((found - 38.647).abs() < 0.02, "deviation {found}°, known 38.647°");
}

#[test]
fn prism_of_bk7_turns_each_line_as_known() {
    let bk7 = substance("bk7").expect("a substance of that name");
    for (line, nm, expected) in [("F", 486.13, 39.138), ("d", 587.56, 38.647), ("C", 656.27, 38.429)] {
        let found = deviation(glass(bk7.ior, bk7.dispersion), Some(nm), expected);
        assert!((found - expected).abs() < 0.02, "{line}: deviation {found}°, known {expected}°");
    }
}

/// The angle from the antisolar point, degrees, at which a drop of index `n` sends most light, within some degrees of `expected`.
fn rainbow(n: f32, expected: f64) -> f64 {
    // The light flies toward −z; the screen stands before the drop, beside the light's way, 20 m from the drop of 2 cm.
    let (low, high) = ((expected - 3.0).to_radians().tan() * 20.0, (expected + 3.0).to_radians().tan() * 20.0);
    let mut scene = scene(&format!(
        "camera = {{ position = [0, 0, 60], look_at = [0, 0, 0], vertical_fov = 40 }}
         render = {{ map_size = 2001, max_depth = 8 }}
         materials.screen = {{ type = \"diffuse\", albedo = 0.8 }}
         lights = [{{ type = \"directional\", direction = [0, 0, -1], irradiance = 1 }}]
         objects = [
             {{ rectangle = {{ center = [{}, 0, 20], edge_u = [{}, 0, 0], edge_v = [0, 1, 0] }}, material = \"screen\" }},
         ]",
        0.5 * (low + high),
        high - low
    ));
    scene.materials.push(Material::new("water", glass(n, Dispersion::None)));
    scene.objects.push(Object {
        name: "drop".to_owned(),
        mesh: Arc::new(Mesh::sphere(Vec3::ZERO, 0.01, 9)),
        world_from_object: Affine3A::IDENTITY,
        materials: vec![scene.materials.len() - 1],
        map_size: None,
    });
    let map = emit(&scene, 1 << 22).energy_map(0).unwrap().expect("the screen is a receiver");
    // The screen is flat, the bow is round: the middle rows alone.
    let rows = map.height / 2 - map.height / 8..map.height / 2 + map.height / 8;
    let mut bins = vec![0.0; 120];
    for texel in 0..map.sums.len() {
        let (column, row) = (texel as u32 % map.width, texel as u32 / map.width % map.height);
        if rows.contains(&row) {
            let x = low + f64::from(column) / f64::from(map.width - 1) * (high - low);
            let y = f64::from(row) / f64::from(map.height - 1) - 0.5;
            let angle = (x.hypot(y) / 20.0).atan().to_degrees();
            let bin = (angle - expected + 3.0) / 0.05;
            if (0.0..120.0).contains(&bin) {
                bins[bin as usize] += map.flux(texel).y;
            }
        }
    }
    let brightest = (0..bins.len()).max_by(|&a, &b| bins[a].total_cmp(&bins[b])).expect("bins");
    expected - 3.0 + 0.05 * (brightest as f64 + 0.5)
}

/// The angle of the bow after `inner` reflections within the drop (1 or 2), from Descartes' condition.
fn bow(n: f64, inner: f64) -> f64 {
    let p = inner + 1.0;
    let i = ((n * n - 1.0) / (p * p - 1.0)).sqrt().acos();
    let r = (i.sin() / n).asin();
    let turned = (inner * PI + 2.0 * i - 2.0 * p * r).to_degrees();
    (turned - 180.0).abs()
}

#[test]
fn rainbows_stand_where_descartes_found_them() {
    assert!((bow(1.331, 1.0) - 42.37).abs() < 0.01 && (bow(1.3435, 1.0) - 40.58).abs() < 0.01);
    assert!((bow(1.333, 2.0) - 50.89).abs() < 0.01);
    for n in [1.331f32, 1.3435] {
        for inner in [1.0, 2.0] {
            let expected = bow(f64::from(n), inner);
            let found = rainbow(n, expected);
            assert!((found - expected).abs() < 0.1, "index {n}, {inner} reflections: {found}°, known {expected}°");
        }
    }
}

fn mean(film: &Film) -> DVec3 {
    film.radiance.iter().map(|pixel| DVec3::from(pixel.map(f64::from))).sum::<DVec3>() / film.radiance.len() as f64
}

/// A ball over a floor.
fn ball(dispersion: Dispersion, settings: &str) -> Scene {
    let mut scene = scene(&format!(
        "camera = {{ position = [0.4, 1.6, 2.4], look_at = [0, 0.3, 0], vertical_fov = 30 }}
         render = {{ width = 16, height = 16, map_size = 65, max_depth = 64, {settings} }}
         background = [0.2, 0.3, 0.4]
         materials.floor = {{ type = \"diffuse\", albedo = 0.6 }}
         materials.glass = {{ type = \"dielectric\", ior = 1.6 }}
         lights = [{{ type = \"sphere\", center = [1.2, 2.2, 0.4], radius = 0.2, flux = [40, 30, 20] }}]
         objects = [
             {{ sphere = {{ center = [0, 0.5, 0], radius = 0.3, subdivisions = 7 }}, material = \"glass\" }},
             {{ rectangle = {{ center = [0, 0, 0], edge_u = [4, 0, 0], edge_v = [0, 0, -4] }}, material = \"floor\" }},
         ]"
    ));
    let material = scene.objects[0].materials[0];
    scene.materials[material].kind = glass(1.6, dispersion);
    scene
}

/// So weak a dispersion that no path is turned by it, but each takes a wavelength.
const FORMAL: Dispersion = Dispersion::Abbe(1e7);

/// Asserts that the mean of some runs is what is expected, within their noise and one part in 5000.
fn assert_mean(runs: &[DVec3], expected: DVec3) {
    let count = runs.len() as f64;
    let average = runs.iter().sum::<DVec3>() / count;
    let spread = runs.iter().map(|run| (*run - average) * (*run - average)).sum::<DVec3>() / (count * (count - 1.0));
    let allowed = 4.5 * spread.map(f64::sqrt) + 2e-4 * expected;
    assert!((average - expected).abs().cmple(allowed).all(), "{average} ± {allowed}, in three colours {expected}");
    assert!(allowed.cmplt(0.03 * expected).all(), "the comparison is too loose to fail: {allowed} of {expected}");
}

#[test]
fn light_of_single_wavelengths_adds_up_to_the_colour() {
    let with_seed = |seed: u32, dispersion| {
        let mut scene = ball(dispersion, "samples = 64");
        scene.settings.seed = seed;
        let mut renderer = emit(&scene, 1 << 18);
        let map = renderer.energy_map(1).unwrap().unwrap();
        let flux = (0..map.sums.len()).map(|texel| map.flux(texel)).sum::<DVec3>();
        renderer.add_samples(samples_of(&scene)).unwrap();
        (flux, mean(&renderer.film().unwrap()))
    };
    let (maps, pictures): (Vec<_>, Vec<_>) = (1..9).map(|seed| with_seed(seed, FORMAL)).unzip();
    let (plain_maps, plain_pictures): (Vec<_>, Vec<_>) = (1..5).map(|seed| with_seed(seed, Dispersion::None)).unzip();
    assert_mean(&maps, plain_maps.iter().sum::<DVec3>() / 4.0);
    assert_mean(&pictures, plain_pictures.iter().sum::<DVec3>() / 4.0);
}

#[test]
fn white_stays_white_through_what_disperses() {
    let diamond = substance("diamond").expect("a substance of that name");
    let mut scene = ball(diamond.dispersion, "samples = 1024, photons = 0");
    let material = scene.objects[0].materials[0];
    scene.materials[material].kind = glass(diamond.ior, diamond.dispersion);
    scene.objects.truncate(1);
    scene.lights.clear();
    scene.background = Vec3::ONE;
    scene.camera.position = Vec3::new(0.0, 0.5, 0.8);
    scene.camera.look_at = Vec3::new(0.0, 0.5, 0.0);
    let film = render(&scene);
    let found = mean(&film);
    assert!((found - 1.0).abs().max_element() < 1e-3, "mean {found}");
    // With 1024 wavelengths a pixel no single one shows.
    let worst = film.radiance.iter().flatten().map(|value| (value - 1.0).abs()).fold(0.0, f32::max);
    assert!(worst < 0.05, "a pixel is off by {worst}");
}

#[test]
fn dispersion_splits_white_light_and_the_ledger_closes() {
    let renderer = emit(&ball(Dispersion::Abbe(20.0), ""), 1 << 20);
    let statistics = renderer.statistics().unwrap();
    let ledger = statistics.ledgers[0];
    assert_eq!(ledger.residue(), [0; 3]);
    let watts = |account| ledger.watts(account, 1 << 20);
    let change = watts(ledger.dispersion).abs().max_element() / watts(ledger.deposited).max_element();
    assert!(change > 0.0 && change < 2e-3, "the colours' account is {change} of what is deposited");
    let map = renderer.energy_map(1).unwrap().unwrap();
    let negative = (0..map.sums.len()).filter(|&texel| map.flux(texel).min_element() < 0.0).count();
    assert!(negative > 0, "no colour beyond what three lights can show");
}

/// Flux in each channel that the irradiance of a map stands for, W.
fn flux_shown(map: &EnergyMap) -> DVec3 {
    (0..map.areas.len()).map(|texel| map.irradiance(texel) * map.areas[texel]).sum()
}

#[test]
fn mixed_hues_keep_brightness_and_flux_and_have_less_noise() {
    let map = |photons, settings: &str| {
        let scene = ball(Dispersion::Abbe(30.0), settings);
        emit(&scene, photons).energy_map(1).unwrap().unwrap()
    };
    let (mixed, plain) = (map(1 << 15, ""), map(1 << 15, "hue_filter = false"));
    assert_eq!(mixed.sums, plain.sums);
    let (shown, held) = (flux_shown(&mixed), flux_shown(&plain));
    assert!(((shown - held) / held).abs().max_element() < 1e-5, "{shown} W of {held} W");
    let luminance = DVec3::new(0.2126, 0.7152, 0.0722);
    let exact = map(1 << 21, "hue_filter = false");
    let mut errors = [0.0; 2];
    for texel in 0..plain.areas.len() {
        let (shown, held) = (mixed.irradiance(texel), plain.irradiance(texel));
        let brightness = luminance.dot(held);
        assert!((luminance.dot(shown) - brightness).abs() <= 1e-4 * brightness.abs().max(1e-3), "texel {texel}");
        errors[0] += (shown - exact.irradiance(texel)).length_squared();
        errors[1] += (held - exact.irradiance(texel)).length_squared();
    }
    assert!(errors[0] < 0.6 * errors[1], "squared errors {} with mixed hues, {} without", errors[0], errors[1]);
}

#[test]
fn bounced_light_in_the_cache_has_no_colours_of_single_wavelengths() {
    // All is gray but for single wavelengths.
    let mut scene = ball(FORMAL, "samples = 1, irradiance_cache = true");
    scene.background = Vec3::ONE;
    scene.lights.clear();
    let film = render(&scene);
    let colored = |pixel: &&[f32; 3]| {
        let [low, high] = [f32::min, f32::max].map(|choose| pixel.iter().copied().reduce(choose).unwrap());
        high - low > 0.01 * high
    };
    // Pixels that show the ball see one wavelength each; the floor sees what the cache holds, and what passes it by where it is not believed.
    let share = film.radiance.iter().filter(colored).count() as f64 / film.radiance.len() as f64;
    println!("{share} of the pixels are coloured");
    assert!(share < 0.5, "{share} of the pixels are coloured");
}
