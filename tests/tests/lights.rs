//! Every light: the irradiance that it gives a bare floor, and how bright it looks, against closed forms.

use std::f64::consts::PI;

use diacaustic::Film;
use diacaustic_scene::{LightKind, RadianceMap, Scene};
use diacaustic_tests::{render, scene};
use glam::{DVec3, Vec3};

/// A white floor seen from straight above, so small in the picture's middle that it is one point to the light.
fn lit_floor(light: &str) -> Scene {
    scene(&format!(
        "camera = {{ position = [0, 1, 0], look_at = [0, 0, 0], up = [0, 0, -1], vertical_fov = 0.1 }}
         render = {{ width = 16, height = 16, samples = 64, photons = 0, max_bounces = 0 }}
         materials.floor = {{ type = \"diffuse\", albedo = 1 }}
         lights = [{light}]
         objects = [
             {{ rectangle = {{ center = [0, 0, 0], edge_u = [4, 0, 0], edge_v = [0, 0, -4] }}, material = \"floor\" }},
         ]"
    ))
}

/// Irradiance on the floor around the origin, W/m² per channel.
fn irradiance(scene: &Scene) -> DVec3 {
    PI * mean(&render(scene))
}

fn mean(film: &Film) -> DVec3 {
    let sum: DVec3 = film.radiance.iter().map(|pixel| DVec3::from(pixel.map(f64::from))).sum();
    sum / film.radiance.len() as f64
}

fn assert_irradiance(light: &str, expected: f64) {
    let found = irradiance(&lit_floor(light));
    let expected = expected * DVec3::new(1.0, 0.5, 0.25);
    assert!(((found - expected) / expected).abs().max_element() < 5e-3, "{light}: {found} W/m², known {expected} W/m²");
}

#[test]
fn sphere() {
    // The cosine law for a sphere that is wholly above the horizon: E = πL (R/d)² cos θ.
    let distance2 = 0.5f64.powi(2) + 2.0f64.powi(2);
    let expected = 10.0 / (4.0 * PI * distance2) * 2.0 / distance2.sqrt();
    assert_irradiance("{ type = \"sphere\", center = [0.5, 2, 0], radius = 0.4, flux = [10, 5, 2.5] }", expected);
}

#[test]
fn point() {
    let expected = 10.0 / (4.0 * PI * 5.0) * 2.0 / 5.0f64.sqrt();
    assert_irradiance("{ type = \"point\", position = [1, 2, 0], flux = [10, 5, 2.5] }", expected);
}

#[test]
fn spot_within_and_at_its_edge() {
    // Full intensity is Φ/(2π(1 − (cos 20° + cos 40°)/2)); at 30° the smooth step has fallen to 3t² − 2t³.
    let cos = |degrees: f64| degrees.to_radians().cos();
    let full = 10.0 / (2.0 * PI * (1.0 - 0.5 * (cos(20.0) + cos(40.0))));
    let spot = |x: f64| {
        format!(
            "{{ type = \"spot\", position = [0, 2, 0], look_at = [{x}, 0, 0], inner_angle = 20, outer_angle = 40,
               flux = [10, 5, 2.5] }}"
        )
    };
    assert_irradiance(&spot(0.0), full / 4.0);
    assert_irradiance(&spot(2.0 * 19f64.to_radians().tan()), full / 4.0);
    let t = (cos(30.0) - cos(40.0)) / (cos(20.0) - cos(40.0));
    assert_irradiance(&spot(2.0 * 30f64.to_radians().tan()), full / 4.0 * t * t * (3.0 - 2.0 * t));
    assert_eq!(irradiance(&lit_floor(&spot(2.0 * 41f64.to_radians().tan()))), DVec3::ZERO);
}

#[test]
fn rectangle_above_its_corner() {
    // A parallel rectangle of sides a and b with a corner above the point, at height h (Howell, configuration B-3):
    // F = (1/2π)(A/√(1+A²) atan(B/√(1+A²)) + B/√(1+B²) atan(A/√(1+B²))), A = a/h, B = b/h.
    let (a, b): (f64, f64) = (1.0 / 1.5, 2.0 / 1.5);
    let part = |x: f64, y: f64| x / (1.0 + x * x).sqrt() * (y / (1.0 + x * x).sqrt()).atan();
    let form = (part(a, b) + part(b, a)) / (2.0 * PI);
    let radiance = 10.0 / (PI * 2.0);
    assert_irradiance(
        "{ type = \"rectangle\", center = [0.5, 1.5, 1], edge_u = [1, 0, 0], edge_v = [0, 0, 2], flux = [10, 5, 2.5] }",
        PI * radiance * form,
    );
}

#[test]
fn disk_on_its_axis() {
    // E = πL R²/(R² + h²).
    let radiance = 10.0 / (PI * PI * 0.49);
    assert_irradiance(
        "{ type = \"disk\", center = [0, 1.2, 0], normal = [0, -3, 0], radius = 0.7, flux = [10, 5, 2.5] }",
        PI * radiance * 0.49 / (0.49 + 1.44),
    );
}

#[test]
fn surfaces_shine_from_their_front_alone() {
    let away = "{ type = \"disk\", center = [0, 1.2, 0], normal = [0, 1, 0], radius = 0.7, flux = 10 }";
    assert_eq!(irradiance(&lit_floor(away)), DVec3::ZERO);
}

#[test]
fn emissive_mesh_equals_the_lamp_of_its_shape() {
    // A ball of facets over the floor, far enough that it is a sphere of its area; its flux is πLA.
    let scene = scene(
        "camera = { position = [0, 1, 0], look_at = [0, 0, 0], up = [0, 0, -1], vertical_fov = 0.1 }
         render = { width = 16, height = 16, samples = 1024, photons = 0, max_bounces = 0 }
         materials.floor = { type = \"diffuse\", albedo = 1 }
         materials.glow = { type = \"diffuse\", albedo = 0, emission = [8, 4, 2] }
         objects = [
             { rectangle = { center = [0, 0, 0], edge_u = [4, 0, 0], edge_v = [0, 0, -4] }, material = \"floor\" },
             { sphere = { center = [0.5, 2, 0], radius = 0.4, subdivisions = 5 }, material = \"glow\" },
         ]",
    );
    let distance2 = 0.25 + 4.0f64;
    let expected = PI * 8.0 * (0.16 / distance2) * 2.0 / distance2.sqrt();
    let found = irradiance(&scene);
    let ratio = found / (expected * DVec3::new(1.0, 0.5, 0.25));
    // The facets' silhouette is a little smaller than the sphere's: their area by 0.2 %.
    assert!((ratio - 1.0).abs().max_element() < 5e-3, "{ratio}");
}

#[test]
fn parallel_light() {
    let cosine = 0.8;
    assert_irradiance(
        "{ type = \"directional\", direction = [0.6, -0.8, 0], irradiance = [10, 5, 2.5] }",
        10.0 * cosine,
    );
}

#[test]
fn sun() {
    // A disc in the sky gives a surface that faces it its irradiance, and any other, wholly above the horizon, the cosine of it.
    assert_irradiance(
        "{ type = \"sun\", direction = [0.6, -0.8, 0], angular_radius = 15, irradiance = [10, 5, 2.5] }",
        8.0,
    );
}

/// The lit floor under an environment whose texel in column `i` and row `j` has the radiance `texel(i, j)`.
fn under_environment(size: [u32; 2], rotate: f32, texel: impl Fn(u32, u32) -> f32) -> Scene {
    let texels = (0..size[0] * size[1]).map(|k| texel(k % size[0], k / size[0]) * Vec3::new(1.0, 0.5, 0.25)).collect();
    let mut scene = lit_floor("{ type = \"point\", position = [0, 1, 0], flux = 1 }");
    let map = RadianceMap { width: size[0], height: size[1], texels };
    scene.lights[0].kind = LightKind::Environment { map: map.into(), rotate, scale: Vec3::splat(2.0) };
    scene.settings.samples = Some(256);
    scene
}

#[test]
fn even_environment() {
    let found = irradiance(&under_environment([8, 4], 30.0, |_, _| 3.0));
    let expected = PI * 6.0 * DVec3::new(1.0, 0.5, 0.25);
    assert!((found / expected - 1.0).abs().max_element() < 2e-3, "{found}, known {expected}");
}

#[test]
fn environment_is_found_where_it_is() {
    // A bright band of rows at 45° above the horizon: E = ∫L cos θ dω over the band, bilinear ramps on both sides included.
    let rows = 64;
    let band = |j: u32| if (14..18).contains(&j) { 50.0 } else { 0.0 };
    let found = irradiance(&under_environment([128, rows], 0.0, |_, j| band(j)));
    let radiance = |theta: f64| {
        let y = (theta / PI * f64::from(rows) - 0.5).clamp(0.0, f64::from(rows - 1));
        let (row, f) = (y.floor() as u32, y.fract());
        2.0 * ((1.0 - f) * f64::from(band(row)) + f * f64::from(band((row + 1).min(rows - 1))))
    };
    let steps = 20_000;
    let expected: f64 = (0..steps)
        .map(|k| {
            let theta = (f64::from(k) + 0.5) / f64::from(steps) * 0.5 * PI;
            2.0 * PI * radiance(theta) * theta.cos() * theta.sin() * 0.5 * PI / f64::from(steps)
        })
        .sum();
    assert!((found.x / expected - 1.0).abs() < 5e-3, "{found}, known {expected}");
}

/// What a camera at the origin sees in a direction of an environment with one bright texel, turned by `rotate`.
fn seen(direction: [f32; 3], rotate: f32, bright: [u32; 2]) -> f64 {
    let mut scene = under_environment([16, 8], rotate, |i, j| if [i, j] == bright { 1.0 } else { 0.0 });
    scene.camera.position = Vec3::new(0.0, 5.0, 0.0);
    scene.camera.look_at = scene.camera.position + Vec3::from(direction);
    scene.camera.up = Vec3::Y;
    mean(&render(&scene)).x
}

#[test]
fn environment_stands_and_turns_as_it_should() {
    // Column 8 of 16 begins at −z and goes on to +x; the centre of row 3 of 8 is 11.25° above the horizon.
    let (elevation, azimuth) = (11.25f32.to_radians(), 11.25f32.to_radians());
    let toward = |azimuth: f32| [elevation.cos() * azimuth.sin(), elevation.sin(), -elevation.cos() * azimuth.cos()];
    assert!((seen(toward(azimuth), 0.0, [8, 3]) - 2.0).abs() < 1e-2);
    assert_eq!(seen(toward(azimuth + 1.0), 0.0, [8, 3]), 0.0);
    // Turned by 90° about +y, what was toward −z is toward −x.
    assert!((seen(toward(azimuth - 90f32.to_radians()), 90.0, [8, 3]) - 2.0).abs() < 1e-2);
}

#[test]
fn camera_sees_lights_as_bright_as_they_are() {
    let seen = |light: &str, look_at: &str| {
        let text = format!(
            "camera = {{ position = [0, 1, 0], look_at = {look_at}, up = [0, 0, -1], vertical_fov = 0.01 }}
             render = {{ width = 8, height = 8, samples = 4, photons = 0 }}
             materials.floor = {{ type = \"diffuse\", albedo = 1 }}
             lights = [{light}]
             objects = [
                 {{ rectangle = {{ center = [0, 0, 0], edge_u = [4, 0, 0], edge_v = [0, 0, -4] }}, material = \"floor\" }},
             ]"
        );
        mean(&render(&scene(&text))).x
    };
    let close = |found: f64, expected: f64| assert!((found / expected - 1.0).abs() < 1e-4, "{found}, known {expected}");
    let rectangle = |v: i32| {
        format!("{{ type = \"rectangle\", center = [0.1, 3, 0], edge_u = [2, 0, 0], edge_v = [0, 0, {v}], flux = 10 }}")
    };
    close(seen(&rectangle(1), "[0.1, 3, 0.1]"), 10.0 / (PI * 2.0));
    assert_eq!(seen(&rectangle(-1), "[0.1, 3, 0.1]"), 0.0);
    let disk = "{ type = \"disk\", center = [0, 3, 0], normal = [0, -1, 0], radius = 0.5, flux = 10 }";
    close(seen(disk, "[0.49, 3, 0]"), 10.0 / (PI * PI * 0.25));
    assert_eq!(seen(disk, "[0.51, 3, 0]"), 0.0);
    let sun = "{ type = \"sun\", direction = [0, -1, 0], angular_radius = 2, irradiance = 10 }";
    close(seen(sun, "[0, 2, 0]"), 10.0 / (PI * 2f64.to_radians().sin().powi(2)));
    assert_eq!(seen(sun, "[0.04, 2, 0]"), 0.0);
}

#[test]
fn many_lights_give_the_sum_of_each() {
    // A strong and weak lamps of each kind: what all of them give is the sum of what each gives.
    let lights = [
        "{ type = \"sphere\", center = [0.5, 2, 0], radius = 0.4, flux = 500 }",
        "{ type = \"point\", position = [1, 2, 0], flux = 3 }",
        "{ type = \"disk\", center = [0, 1.2, 0.9], normal = [0, -1, 0], radius = 0.2, flux = 4 }",
        "{ type = \"sphere\", center = [-0.5, 1, 0.5], radius = 0.01, flux = 1 }",
        "{ type = \"sun\", direction = [0.6, -0.8, 0], angular_radius = 1, irradiance = 2 }",
    ];
    let each: f64 = lights.iter().map(|light| irradiance(&lit_floor(light)).y).sum();
    let mut all = lit_floor(&lights.join(", "));
    all.settings.samples = Some(4096);
    let found = irradiance(&all).y;
    assert!((found / each - 1.0).abs() < 3e-3, "{found}, sum {each}");
}

#[test]
fn photon_shares_change_noise_and_not_brightness() {
    // Two lamps over a glass ball: whatever their shares, each casts the same caustic.
    let map = |shares: [u32; 2]| {
        let scene = scene(&format!(
            "camera = {{ position = [0, 2.2, 3.2], look_at = [0, 0.2, 0], vertical_fov = 40 }}
             render = {{ map_size = 33 }}
             materials.glass = {{ type = \"dielectric\", ior = 1.5 }}
             materials.floor = {{ type = \"diffuse\", albedo = 0.8 }}
             lights = [
                 {{ type = \"point\", position = [1, 2.5, 0.6], flux = [35, 0, 0], photon_share = {} }},
                 {{ type = \"sphere\", center = [-0.8, 2, 0], radius = 0.1, flux = [0, 1, 0], photon_share = {} }},
             ]
             objects = [
                 {{ rectangle = {{ center = [0, 0, 0], edge_u = [2, 0, 0], edge_v = [0, 0, -2] }}, material = \"floor\" }},
                 {{ sphere = {{ center = [0, 0.4, 0], radius = 0.25, subdivisions = 5 }}, material = \"glass\" }},
             ]",
            shares[0], shares[1]
        ));
        let renderer = diacaustic_tests::emit(&scene, 600_000);
        let ledgers = renderer.statistics().unwrap().ledgers;
        assert!(ledgers.iter().all(|ledger| ledger.residue() == [0; 3] && ledger.deposited != [0; 3]));
        renderer.energy_map(0).unwrap().expect("the floor is a receiver")
    };
    let (even, uneven) = (map([1, 1]), map([1, 5]));
    let flux = |map: &diacaustic::EnergyMap| (0..map.sums.len()).map(|texel| map.flux(texel)).sum::<DVec3>();
    let ratio = flux(&uneven) / flux(&even);
    assert!((ratio.x - 1.0).abs() < 2e-3 && (ratio.y - 1.0).abs() < 2e-3, "{ratio}");
    assert_ne!(even.sums, uneven.sums);
}
