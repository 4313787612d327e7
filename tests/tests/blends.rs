//! Surfaces of two materials, and rough sheets of glass, against known answers.

use std::f64::consts::PI;

use diacaustic::Film;
use diacaustic_reference::{
    camera::radiance,
    geometry::World,
    photons::{AimDisc, Emission, PhotonJob, trace},
};
use diacaustic_scene::{Scene, Texture, TextureFilter, Wrap};
use diacaustic_tests::{emit, pattern, render, scene};
use glam::DVec3;

fn mean(film: &Film, columns: std::ops::Range<usize>) -> DVec3 {
    let (width, height) = (film.width as usize, film.height as usize);
    let pixel = |x: usize, y: usize| DVec3::from(film.radiance[y * width + x].map(f64::from));
    let sum: DVec3 = (0..height).flat_map(|y| columns.clone().map(move |x| pixel(x, y))).sum();
    sum / (height * columns.len()) as f64
}

/// What a plate of a material among others shows of even light of radiance 1, seen `degrees` off its normal.
fn plate(materials: &str, degrees: f64) -> DVec3 {
    let (sin, cos) = degrees.to_radians().sin_cos();
    let film = render(&scene(&format!(
        "background = 1
         camera = {{ position = [{}, {}, 0], look_at = [0, 0, 0], up = [0, 0, 1], vertical_fov = 0.02 }}
         render = {{ width = 64, height = 64, samples = 64, photons = 0 }}
         {materials}
         objects = [
             {{ rectangle = {{ center = [0, 0, 0], edge_u = [8, 0, 0], edge_v = [0, 0, -8] }}, material = \"plate\" }},
         ]",
        5.0 * sin,
        5.0 * cos
    )));
    mean(&film, 0..64)
}

#[test]
fn a_blend_shows_the_mean_of_its_parts() {
    let paint = "materials.paint = { type = \"diffuse\", albedo = [0.8, 0.4, 0.2] }";
    for share in [0.0, 0.25, 1.0] {
        let mirror = format!(
            "{paint}\nmaterials.plate = {{ type = \"mirror\", reflectance = [0.9, 0.5, 0.1], rest = \"paint\", share = {share} }}"
        );
        let expected = share * DVec3::new(0.9, 0.5, 0.1) + (1.0 - share) * DVec3::new(0.8, 0.4, 0.2);
        let found = plate(&mirror, 40.0);
        assert!((found - expected).abs().max_element() < 3e-3, "share {share}: {found}, known {expected}");
    }
    // Both parts are white and lose nothing.
    let white = "materials.paint = { type = \"diffuse\", albedo = 1 }
                 materials.plate = { type = \"thin_walled\", rest = \"paint\", share = 0.5 }";
    let found = plate(white, 60.0);
    assert!((found - 1.0).abs().max_element() < 2e-3, "{found}");
}

#[test]
fn a_picture_says_where_the_parts_are() {
    let mut scene = scene(
        "background = 1
         camera = { position = [0, 5, 0], look_at = [0, 0, 0], up = [0, 0, -1], vertical_fov = 10 }
         render = { width = 32, height = 32, samples = 16, photons = 0 }
         materials.paint = { type = \"diffuse\", albedo = 0.25 }
         materials.plate = { type = \"mirror\", reflectance = 0.75, rest = \"paint\", share = 1 }
         objects = [
             { rectangle = { center = [0, 0, 0], edge_u = [2, 0, 0], edge_v = [0, 0, -2] }, material = \"plate\" },
         ]",
    );
    let picture = pattern(2, 1, |column, _| [0.0, column as f32, 0.0, 0.0]);
    let blend = scene.materials.iter_mut().find_map(|material| material.blend.as_mut()).expect("a blend");
    let filter = TextureFilter::Nearest;
    blend.texture = Some(Texture { channel: 1, filter, wrap: [Wrap::Clamp; 2], ..picture });
    let film = render(&scene);
    let (left, right) = (mean(&film, 0..14).y, mean(&film, 18..32).y);
    assert!((left - 0.25).abs() < 2e-3 && (right - 0.75).abs() < 2e-3, "{left}, {right}");
}

/// A floor under a ball of glass of which `share` is, the rest being paint.
fn painted_ball(share: f32) -> Scene {
    scene(&format!(
        "background = 0.1
         camera = {{ position = [0, 2.2, 3.2], look_at = [0, 0.25, 0], vertical_fov = 24 }}
         render = {{ width = 12, height = 12, samples = 2048, photons = 1_000_000, map_size = 65, seed = 3, guiding = false }}
         materials.glass = {{ type = \"dielectric\", ior = 1.5, absorption = [0.5, 0, 1], share = {share}, rest = \"paint\" }}
         materials.paint = {{ type = \"metallic_roughness\", base_color = [0.9, 0.5, 0.2], metallic = 0.3, roughness = 0.4 }}
         materials.floor = {{ type = \"diffuse\", albedo = 0.8 }}
         lights = [{{ type = \"sphere\", center = [0.8, 2.5, 0.5], radius = 0.1, flux = 35 }}]
         objects = [
             {{ sphere = {{ center = [0, 0.5, 0], radius = 0.4, subdivisions = 4 }}, material = \"glass\" }},
             {{ rectangle = {{ center = [0, 0, 0], edge_u = [3, 0, 0], edge_v = [0, 0, -3] }}, material = \"floor\" }},
         ]"
    ))
}

#[test]
fn photons_divide_as_in_the_reference() {
    let scene = painted_ball(0.6);
    let photons = 1 << 17;
    let ledger = emit(&scene, photons).statistics().unwrap().ledgers[0];
    let watts = |account| ledger.watts(account, photons).y;
    let found = [ledger.deposited, ledger.direct, ledger.absorbed, ledger.escaped].map(watts);
    let world = World::new(&scene);
    let sphere = world.light_sphere(0).expect("a sphere");
    let axis = (DVec3::new(0.0, 0.5, 0.0) - sphere.center).normalize();
    let discs = [AimDisc { center: DVec3::new(0.0, 0.5, 0.0), axis, radius: 0.4 + sphere.radius }];
    let job = PhotonJob {
        world: &world,
        maps: &[None, None],
        light: 0,
        emission: Emission::Aimed(&discs),
        guide: None,
        seed: 3,
        photons: 0..1 << 17,
    };
    let ledger = trace(&job).ledger;
    let expected =
        [ledger.deposited, ledger.direct, ledger.absorbed, ledger.escaped].map(|sum| sum.y / f64::from(1 << 17));
    // What is direct, absorbed and so on depends on the aim, but not what casters send on.
    let (share, wanted) = (found[0], expected[0]);
    assert!((share / wanted - 1.0).abs() < 0.02, "deposited {share} W, reference {wanted} W; {found:?} {expected:?}");
    let whole = emit(&painted_ball(1.0), photons).statistics().unwrap().ledgers[0];
    assert!(share < 0.9 * whole.watts(whole.deposited, photons).y, "the comparison cannot fail");
}

#[test]
fn pictures_of_a_blend_are_those_of_the_reference() {
    let scene = painted_ball(0.6);
    let film = render(&scene);
    let world = World::new(&scene);
    let mut worst = 0.0f64;
    let (mut sum, mut expected_sum) = (0.0, 0.0);
    for (x, y) in (1..12).step_by(4).flat_map(|x| (1..12).step_by(4).map(move |y| (x, y))) {
        let estimate = radiance(&world, x, y, 4_000, scene.settings.max_bounces, 5);
        let found = f64::from(film.radiance[(y * 12 + x) as usize][1]);
        let noise = estimate.variance.y.sqrt() + 0.02 * estimate.mean.y;
        worst = worst.max((found - estimate.mean.y).abs() / noise);
        sum += found;
        expected_sum += estimate.mean.y;
    }
    assert!(worst < 6.0, "a pixel is {worst} deviations off");
    assert!((sum / expected_sum - 1.0).abs() < 0.03, "{sum}, reference {expected_sum}");
}

#[test]
fn a_rough_sheet_spreads_what_passes_and_loses_what_is_documented() {
    // Reflected and passed, by microfacets of one distribution, as much is lost as of a metal that reflects all: docs/materials.md.
    for (roughness, loss) in [(0.0, 0.0), (0.1, 0.0001), (0.3, 0.0093), (0.5, 0.0842), (0.8, 0.445)] {
        let found = plate(&format!("materials.plate = {{ type = \"thin_walled\", roughness = {roughness} }}"), 0.0).y;
        assert!((1.0 - found - loss).abs() < 2e-3, "roughness {roughness}: loss {}, documented {loss}", 1.0 - found);
    }
}

/// What a rough sheet shows of a lamp behind it, found by its surface as a light or by chance.
fn seen_through(roughness: f32, lamp: &str, lights: &str) -> f64 {
    let film = render(&scene(&format!(
        "camera = {{ position = [0, 2, 0.5], look_at = [0, 0, 0], vertical_fov = 20 }}
         render = {{ width = 48, height = 48, samples = 64, photons = 0 }}
         materials.sheet = {{ type = \"thin_walled\", tint = 0.8, roughness = {roughness} }}
         materials.glow = {{ type = \"diffuse\", albedo = 0, emission = 10 }}
         {lights}
         objects = [
             {{ rectangle = {{ center = [0, 0, 0], edge_u = [8, 0, 0], edge_v = [0, 0, -8] }}, material = \"sheet\" }},
             {lamp}
         ]"
    )));
    mean(&film, 0..48).y
}

#[test]
fn light_and_lobe_sampling_agree_behind_a_rough_sheet() {
    let mesh = "{ sphere = { center = [0, -2, 0], radius = 0.5, subdivisions = 6 }, material = \"glow\" }";
    let flux = 10.0 * 4.0 * PI * PI * 0.25;
    let light = format!("lights = [{{ type = \"sphere\", center = [0, -2, 0], radius = 0.5, flux = {flux} }}]");
    for roughness in [0.1, 0.3, 0.6] {
        let (by_mesh, by_light) = (seen_through(roughness, mesh, ""), seen_through(roughness, "", &light));
        assert!((by_mesh / by_light - 1.0).abs() < 0.01, "roughness {roughness}: mesh {by_mesh}, sphere {by_light}");
    }
}

#[test]
fn rough_sheets_are_those_of_the_reference() {
    for roughness in [0.2, 0.5] {
        let scene = scene(&format!(
            "background = 0.2
             camera = {{ position = [0, 1.5, 2.5], look_at = [0, 0.4, 0], vertical_fov = 20 }}
             render = {{ width = 4, height = 4, samples = 4096, photons = 500_000, map_size = 33 }}
             materials.sheet = {{ type = \"thin_walled\", tint = [0.9, 0.6, 0.3], roughness = {roughness} }}
             materials.floor = {{ type = \"diffuse\", albedo = 0.8 }}
             lights = [{{ type = \"point\", position = [0.3, 2.5, -0.4], flux = 35 }}]
             objects = [
                 {{ rectangle = {{ center = [0, 0.8, 0], edge_u = [1, 0, 0], edge_v = [0, 0.3, -1] }}, material = \"sheet\" }},
                 {{ rectangle = {{ center = [0, 0, 0], edge_u = [3, 0, 0], edge_v = [0, 0, -3] }}, material = \"floor\" }},
             ]"
        ));
        let film = render(&scene);
        let world = World::new(&scene);
        for pixel in 0..4 {
            let estimate = radiance(&world, pixel, 3 - pixel, 8_000, scene.settings.max_bounces, 5);
            let found = f64::from(film.radiance[(4 * (3 - pixel) + pixel) as usize][1]);
            let noise = estimate.variance.y.sqrt() + 0.015 * estimate.mean.y;
            let (expected, off) = (estimate.mean.y, (found - estimate.mean.y).abs() / noise);
            assert!(off < 5.0, "roughness {roughness}, pixel {pixel}: {found}, reference {expected}");
        }
    }
}
