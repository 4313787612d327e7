//! Metals, rough glass, coats and glTF's model against known answers.

use std::{f64::consts::PI, sync::Arc};

use diacaustic::{EnergyMap, Film};
use diacaustic_reference::{camera::radiance, geometry::World};
use diacaustic_scene::{Material, MaterialKind, Mesh, Object, Scene, metal};
use diacaustic_tests::{emit, render, scene};
use glam::{Affine3A, DVec3, Vec3};

fn mean(film: &Film) -> DVec3 {
    let sum: DVec3 = film.radiance.iter().map(|pixel| DVec3::from(pixel.map(f64::from))).sum();
    sum / film.radiance.len() as f64
}

/// What a large plate of a material reflects of uniform radiance 1, seen `degrees` off its normal.
fn plate(material: &str, degrees: f64) -> DVec3 {
    let (sin, cos) = degrees.to_radians().sin_cos();
    mean(&render(&scene(&format!(
        "background = 1
         camera = {{ position = [{}, {}, 0], look_at = [0, 0, 0], up = [0, 0, 1], vertical_fov = 0.02 }}
         render = {{ width = 64, height = 64, samples = 64, photons = 0 }}
         materials.plate = {material}
         objects = [
             {{ rectangle = {{ center = [0, 0, 0], edge_u = [8, 0, 0], edge_v = [0, 0, -8] }}, material = \"plate\" }},
         ]",
        5.0 * sin,
        5.0 * cos
    ))))
}

#[test]
fn metals_reflect_as_measured() {
    for name in ["gold", "silver", "copper", "aluminium", "chromium"] {
        let metal = metal(name).expect("a metal of that name");
        let (n, k) = (metal.eta.as_dvec3(), metal.k.as_dvec3());
        let expected = ((n - 1.0) * (n - 1.0) + k * k) / ((n + 1.0) * (n + 1.0) + k * k);
        let found = plate(&format!("{{ type = \"conductor\", metal = \"{name}\" }}"), 0.0);
        assert!((found - expected).abs().max_element() < 1e-4, "{name}: {found}, known {expected}");
    }
}

#[test]
fn conductor_without_absorption_is_a_dielectric_surface() {
    // k = 0 is Fresnel's dielectric: the table of physics for n = 1.5.
    for (degrees, expected) in [(0.0, 0.0400), (45.0, 0.0502), (75.0, 0.2531), (85.0, 0.6128)] {
        let found = plate("{ type = \"conductor\", eta = 1.5, k = 0 }", degrees).y;
        assert!((found - expected).abs() < 1e-4, "{degrees}°: {found}, known {expected}");
    }
}

#[test]
fn white_bases_lose_nothing() {
    // A coat sends back what it does not let out; a white base under it, lit from everywhere, looks 1. So does glTF's white
    // plastic when smooth.
    for degrees in [0.0, 50.0, 80.0] {
        for material in [
            "{ type = \"coated\", albedo = 1, ior = 1.5 }",
            "{ type = \"metallic_roughness\", base_color = 1, metallic = 0, roughness = 0 }",
            "{ type = \"metallic_roughness\", base_color = 1, metallic = 1, roughness = 0 }",
            "{ type = \"diffuse\", albedo = 1 }",
        ] {
            let found = plate(material, degrees).y;
            assert!((found - 1.0).abs() < 2e-3, "{material} at {degrees}°: {found}");
        }
    }
}

#[test]
fn coated_base_against_its_closed_form() {
    // Albedo of a coated base seen from direction wo: F(wo) + (1 − F(wo))(1 − F_ex) ρ/(n²(1 − ρ F_in)), F_ex = 0.0918 and
    // F_in = 1 − (1 − F_ex)/n² for n = 1.5.
    let (rho, external): (f64, f64) = (0.5, 0.0918);
    let internal = 1.0 - (1.0 - external) / 2.25;
    let base = (1.0 - external) * rho / (2.25 * (1.0 - rho * internal));
    for (degrees, f) in [(0.0, 0.04), (60.0, 0.0892)] {
        let found = plate("{ type = \"coated\", albedo = 0.5, ior = 1.5 }", degrees).y;
        let expected = f + (1.0 - f) * base;
        assert!((found - expected).abs() < 1.5e-3, "{degrees}°: {found}, known {expected}");
    }
}

#[test]
fn metallic_roughness_between_its_ends() {
    // Schlick at normal incidence: f₀ = 0.04(1 − m) + m b; the base has (1 − m) b of the rest.
    let found =
        plate("{ type = \"metallic_roughness\", base_color = [0.8, 0.4, 0.2], metallic = 0.5, roughness = 0 }", 0.0);
    let b = DVec3::new(0.8, 0.4, 0.2);
    let f0 = 0.02 + 0.5 * b;
    let expected = f0 + (1.0 - f0) * 0.5 * b;
    assert!((found - expected).abs().max_element() < 2e-3, "{found}, known {expected}");
}

#[test]
fn light_and_lobe_sampling_agree_on_rough_metal() {
    // The same lamp as a sphere that next-event estimation and the lobe both find, seen in plates of growing roughness, and as an
    // emissive mesh: what the plate shows must not depend on how the lamp is found.
    let seen = |roughness: f32, lamp: &str, lights: &str| {
        mean(&render(&scene(&format!(
            "camera = {{ position = [0, 2, 2], look_at = [0, 0, 0], vertical_fov = 10 }}
             render = {{ width = 64, height = 64, samples = 64, photons = 0 }}
             materials.plate = {{ type = \"conductor\", metal = \"silver\", roughness = {roughness} }}
             materials.glow = {{ type = \"diffuse\", albedo = 0, emission = 10 }}
             {lights}
             objects = [
                 {{ rectangle = {{ center = [0, 0, 0], edge_u = [8, 0, 0], edge_v = [0, 0, -8] }}, material = \"plate\" }},
                 {lamp}
             ]"
        ))))
        .y
    };
    let mesh = "{ sphere = { center = [0, 2, -2], radius = 0.5, subdivisions = 6 }, material = \"glow\" }";
    let flux = 10.0 * 4.0 * PI * PI * 0.25;
    let light = format!("lights = [{{ type = \"sphere\", center = [0, 2, -2], radius = 0.5, flux = {flux} }}]");
    for roughness in [0.1, 0.3, 0.6] {
        let (by_mesh, by_light) = (seen(roughness, mesh, ""), seen(roughness, "", &light));
        assert!((by_mesh / by_light - 1.0).abs() < 0.01, "roughness {roughness}: mesh {by_mesh}, sphere {by_light}");
    }
}

/// A tube of radius 1 m around the y axis, from y = 0 to `height`, with the circle's normals; its inside is a back side.
fn tube(height: f32, steps: u32) -> Mesh {
    let corner = |k: u32| {
        let angle = std::f32::consts::TAU * k as f32 / steps as f32;
        Vec3::new(angle.cos(), 0.0, angle.sin())
    };
    let ring = |y: f32| (0..steps).map(move |k| corner(k) + y * Vec3::Y);
    Mesh {
        positions: ring(0.0).chain(ring(height)).collect(),
        normals: (0..2 * steps).map(|k| corner(k % steps)).collect(),
        triangles: (0..steps)
            .flat_map(|k| {
                let (a, b) = (k, (k + 1) % steps);
                [[a, a + steps, b + steps], [a, b + steps, b]]
            })
            .collect(),
        ..Mesh::default()
    }
}

/// A floor of 2.2 m with a map of `size` texels under a silver tube, in parallel light along +x that falls by 0.3 m a metre.
fn nephroid(size: u32) -> EnergyMap {
    let mut scene: Scene = scene(&format!(
        "camera = {{ position = [0, 3, 0], look_at = [0, 0, 0], up = [0, 0, -1], vertical_fov = 40 }}
         render = {{ map_size = {size} }}
         materials.floor = {{ type = \"diffuse\", albedo = 0.8 }}
         lights = [{{ type = \"directional\", direction = [1, -0.3, 0], irradiance = 1 }}]
         objects = [
             {{ rectangle = {{ center = [0, 0, 0], edge_u = [2.2, 0, 0], edge_v = [0, 0, -2.2] }}, material = \"floor\" }},
         ]"
    ));
    let silver = metal("silver").expect("a metal of that name");
    let kind = MaterialKind::Conductor { eta: silver.eta, k: silver.k, roughness: 0.0 };
    scene.materials.push(Material::new("silver", kind));
    scene.objects.push(Object {
        name: "tube".to_owned(),
        mesh: Arc::new(tube(0.3, 4096)),
        world_from_object: Affine3A::IDENTITY,
        materials: vec![scene.materials.len() - 1],
        map_size: None,
    });
    emit(&scene, 1 << 21).energy_map(0).unwrap().expect("the floor is a receiver")
}

#[test]
fn reflecting_ring_draws_the_nephroid() {
    // x = (3 cos t − cos 3t)/4, z = (3 sin t − sin 3t)/4 for light that flies toward +x; the cusp is at x = 1/2.
    let size = 221;
    let map = nephroid(size);
    let texel = 2.2 / f64::from(size - 1);
    // Columns run along +x, rows along −z.
    let at = |column: u32, row: u32| map.irradiance((row * size + column) as usize).y;
    let place = |column: u32| f64::from(column) * texel - 1.1;
    let middle = size / 2;
    let brightest = |row: u32, from: f64, to: f64| {
        let columns = (0..size).filter(|&column| (from..to).contains(&place(column)));
        columns.max_by(|&a, &b| at(a, row).total_cmp(&at(b, row))).map(place).expect("columns")
    };
    let cusp = brightest(middle, 0.2, 0.8);
    // Texels spread the cusp to its bright side: the two that share the maximum differ by less than their noise.
    assert!((cusp - 0.5).abs() <= texel * 2.01, "the cusp is at {cusp} m, known 0.5 m");
    for t in [0.35f64, 0.5] {
        let x = (3.0 * t.cos() - (3.0 * t).cos()) / 4.0;
        let z = (3.0 * t.sin() - (3.0 * t).sin()) / 4.0;
        let row = (f64::from(middle) - z / texel).round() as u32;
        let found = brightest(row, x - 0.15, x + 0.15);
        assert!((found - x).abs() < 2.0 * texel, "at z = {z}: the curve is at x = {found}, known {x}");
    }
    // Before the curve it is dark but for light that met the tube twice.
    assert!(at(middle, middle) < 0.1 * at((1.6 / texel).round() as u32, middle));
}

#[test]
fn rough_metal_loses_what_is_documented() {
    // A metal that reflects all but loses light between microfacets, along the normal: the table of docs/materials.md.
    for (roughness, loss) in [(0.1, 0.0001), (0.3, 0.0093), (0.5, 0.0842), (0.8, 0.445)] {
        let found =
            plate(&format!("{{ type = \"conductor\", eta = 0.001, k = 1000, roughness = {roughness} }}"), 0.0).y;
        assert!((1.0 - found - loss).abs() < 2e-3, "roughness {roughness}: loss {}, documented {loss}", 1.0 - found);
    }
}

#[test]
fn rough_glass_in_a_furnace_loses_what_the_reference_says() {
    // What several microfacets would send on is lost; how much, the double-precision tracer tells, which docs/materials.md's table is from.
    for roughness in [0.2, 0.5] {
        let scene = scene(&format!(
            "background = 1
             camera = {{ position = [0, 0, 3], look_at = [0, 0, 0], vertical_fov = 6 }}
             render = {{ width = 8, height = 8, samples = 2048, photons = 0, max_depth = 200 }}
             materials.glass = {{ type = \"dielectric\", ior = 1.5, roughness = {roughness} }}
             objects = [{{ sphere = {{ center = [0, 0, 0], radius = 1, subdivisions = 7 }}, material = \"glass\" }}]"
        ));
        let found = mean(&render(&scene)).y;
        let world = World::new(&scene);
        let estimates = (0..8).map(|pixel| radiance(&world, pixel, 7 - pixel, 20_000, 0, 3));
        let (sum, variance) = estimates
            .fold((0.0, 0.0), |(sum, variance), estimate| (sum + estimate.mean.y, variance + estimate.variance.y));
        let (expected, noise) = (sum / 8.0, variance.sqrt() / 8.0);
        assert!(
            (found - expected).abs() < 5.0 * noise + 2e-3,
            "roughness {roughness}: {found}, reference {expected} ± {noise}"
        );
        assert!(
            expected < 0.9985 && noise < 1e-3,
            "nothing is lost, or the comparison cannot fail: {expected} ± {noise}"
        );
    }
}

#[test]
fn wide_gloss_shows_all_of_a_lamp_without_a_bounce() {
    // Nothing but the lamp is there to see, so more bounces add nothing; a path that ends at the plate must not leave it half its light.
    let seen = |max_bounces: u32, material: &str| {
        mean(&render(&scene(&format!(
            "camera = {{ position = [0, 2, 2], look_at = [0, 0, 0], vertical_fov = 10 }}
             render = {{ width = 32, height = 32, samples = 256, photons = 0, max_bounces = {max_bounces} }}
             materials.plate = {material}
             lights = [{{ type = \"sphere\", center = [0, 2, -2], radius = 0.5, flux = 100 }}]
             objects = [
                 {{ rectangle = {{ center = [0, 0, 0], edge_u = [8, 0, 0], edge_v = [0, 0, -8] }}, material = \"plate\" }},
             ]"
        ))))
        .y
    };
    for material in [
        "{ type = \"metallic_roughness\", base_color = 0.8, metallic = 0.9, roughness = 0.35 }",
        "{ type = \"coated\", albedo = 0.2, roughness = 0.5 }",
    ] {
        let (none, some) = (seen(0, material), seen(3, material));
        assert!((none / some - 1.0).abs() < 0.01, "{material}: {none} without bounces, {some} with");
    }
}
