//! Lightmaps against known answers.

use std::f64::consts::PI;

use diacaustic::{BakeOptions, Lightmap, Renderer};
use diacaustic_scene::Scene;
use diacaustic_tests::{emit, photons_of, scene};
use glam::DVec3;

/// A floor of 2 m × 2 m around the origin that reflects nothing, with texels of 0.25 m, in a light and with further objects.
fn black_floor(light: &str, object: &str) -> Scene {
    scene(&format!(
        "camera = {{ position = [0, 3, 3], look_at = [0, 0, 0], vertical_fov = 40 }}
         render = {{ width = 8, height = 8, photons = 200_000, map_size = 9, guiding = false }}
         {light}
         materials.floor = {{ type = \"diffuse\", albedo = 0 }}
         materials.glass = {{ type = \"dielectric\", ior = 1.5 }}
         materials.water = {{ type = \"dielectric\", ior = 1.33 }}
         [[objects]]
         name = \"floor\"
         rectangle = {{ center = [0, 0, 0], edge_u = [2, 0, 0], edge_v = [0, 0, -2] }}
         material = \"floor\"
         {object}"
    ))
}

fn lightmap(renderer: &mut Renderer, object: usize, samples: u32) -> Lightmap {
    renderer.bake(object, &BakeOptions { samples }).unwrap().expect("it is a receiver")
}

/// The mean of a function over the floor of [`black_floor`] by a texel's weight.
fn texel_mean(column: usize, row: usize, f: impl Fn(DVec3) -> f64) -> f64 {
    const STEPS: usize = 64;
    let offset = |step: usize| (step as f64 + 0.5) / STEPS as f64 * 2.0 - 1.0;
    let (mut sum, mut weights) = (0.0, 0.0);
    for (s, t) in (0..STEPS * STEPS).map(|step| (offset(step % STEPS), offset(step / STEPS))) {
        let (x, y) = (column as f64 + s, row as f64 + t);
        if (0.0..=8.0).contains(&x) && (0.0..=8.0).contains(&y) {
            let weight = (1.0 - s.abs()) * (1.0 - t.abs());
            // Rows go along edge_v, toward −z.
            sum += weight * f(DVec3::new(0.25 * x - 1.0, 0.0, 1.0 - 0.25 * y));
            weights += weight;
        }
    }
    sum / weights
}

#[test]
fn a_floor_under_a_point_has_the_cosine_over_the_squared_distance() {
    let lamp = DVec3::new(0.3, 0.8, -0.4);
    let scene = black_floor("lights = [{ type = \"point\", position = [0.3, 0.8, -0.4], flux = [10, 20, 0] }]", "");
    let map = lightmap(&mut emit(&scene, 0), 0, 1024);
    assert_eq!((map.width, map.height, map.layers), (9, 9, 2));
    for texel in 0..81 {
        let irradiance = texel_mean(texel % 9, texel / 9, |point| {
            let to_lamp = lamp - point;
            10.0 / (4.0 * PI) * to_lamp.y / to_lamp.length().powi(3)
        });
        let [red, green, blue] = map.direct[texel].map(f64::from);
        assert!((red / irradiance - 1.0).abs() < 0.01, "texel {texel}: {red} W/m², expected {irradiance}");
        assert!((green / red - 2.0).abs() < 1e-4 && blue == 0.0);
        // The lamp does not shine on the back.
        assert_eq!(map.direct[81 + texel], [0.0; 3]);
        assert_eq!((map.caustic[texel], map.indirect[texel]), ([0.0; 3], [0.0; 3]));
    }
}

#[test]
fn even_light_from_everywhere_gives_pi_times_its_radiance() {
    let map = lightmap(&mut emit(&black_floor("background = [1, 0.5, 0]", ""), 0), 0, 16);
    for texel in 0..162 {
        let [red, green, blue] = map.irradiance(texel).map(f64::from);
        assert!((red / PI - 1.0).abs() < 1e-5 && (green / red - 0.5).abs() < 1e-5 && blue == 0.0, "{red}");
        assert_eq!(map.irradiance(texel), map.indirect[texel]);
    }
}

#[test]
fn caustics_hold_the_flux_that_photons_left() {
    let scene = black_floor(
        "lights = [{ type = \"sphere\", center = [0, 2, 0], radius = 0.1, flux = 10 }]",
        "[[objects]]
         sphere = { center = [0, 0.5, 0], radius = 0.3 }
         material = \"glass\"",
    );
    let mut renderer = emit(&scene, photons_of(&scene));
    let map = lightmap(&mut renderer, 0, 4);
    let energy_map = renderer.energy_map(0).unwrap().unwrap();
    let area = |texel: usize| energy_map.areas[texel];
    let flux: f64 = (0..162).map(|texel| f64::from(map.caustic[texel][1]) * area(texel)).sum();
    let ledgers = renderer.statistics().unwrap().ledgers;
    let units: i64 = ledgers.iter().map(|ledger| ledger.deposited[1]).sum();
    let deposited = units as f64 / (energy_map.units_per_watt * energy_map.photons as f64);
    assert!(deposited > 0.05, "{deposited} W");
    assert!((flux / deposited - 1.0).abs() < 1e-5, "{flux} W in the lightmap, {deposited} W deposited");
    for texel in 0..162 {
        let sum = (0..3)
            .map(|k| [map.direct[texel], map.caustic[texel], map.indirect[texel]].map(|part| part[k]).iter().sum());
        assert_eq!(map.irradiance(texel).to_vec(), sum.collect::<Vec<f32>>());
    }
}

/// Reflectance of a smooth surface of index `n` for light from everywhere outside it.
fn diffuse_reflectance(n: f64) -> f64 {
    const STEPS: usize = 10_000;
    let at = |cos_i: f64| {
        let cos_t = (1.0 - (1.0 - cos_i * cos_i) / (n * n)).sqrt();
        let (s, p) = ((cos_i - n * cos_t) / (cos_i + n * cos_t), (n * cos_i - cos_t) / (n * cos_i + cos_t));
        0.5 * (s * s + p * p)
    };
    (0..STEPS).map(|step| (step as f64 + 0.5) / STEPS as f64).map(|u| at(u.sqrt())).sum::<f64>() / STEPS as f64
}

#[test]
fn light_reaches_the_ground_of_a_pool_as_fresnel_says() {
    let scene = black_floor(
        "background = 1",
        "[[objects]]
         box = { min = [-2000, -1, -2000], max = [2000, 0.05, 2000] }
         material = \"water\"",
    );
    let map = lightmap(&mut emit(&scene, 0), 0, 256);
    let expected = PI * (1.0 - diffuse_reflectance(1.33));
    // At the border, light from below comes past the floor and is reflected back to it by the water's surface.
    let inner: Vec<usize> =
        (0..81).filter(|texel| (1..8).contains(&(texel % 9)) && (1..8).contains(&(texel / 9))).collect();
    let mean = inner.iter().map(|texel| f64::from(map.irradiance(*texel)[0])).sum::<f64>() / inner.len() as f64;
    assert!((mean / expected - 1.0).abs() < 0.01, "{mean} W/m², expected {expected}");
    assert!((diffuse_reflectance(1.33) - 0.066).abs() < 0.001);
}

#[test]
fn walls_and_floor_of_a_room_that_loses_half_its_light_shine_evenly() {
    // In a closed room of albedo ρ whose walls shine M/π, each point gets M/(1 − ρ) in all, after endless bounces.
    let room = self::scene(
        "camera = { position = [0.2, 0.1, 0.3], look_at = [0, 0, 0], vertical_fov = 40 }
         render = { width = 8, height = 8, photons = 0, map_size = 17, max_bounces = 40 }
         materials.wall = { type = \"diffuse\", albedo = 0.5, emission = 0.318_309_886 }
         objects = [{ sphere = { center = [0, 0, 0], radius = 1 }, material = \"wall\" }]",
    );
    let mut inside_out = room.clone();
    let mut mesh = (*room.objects[0].mesh).clone();
    for triangle in &mut mesh.triangles {
        triangle.swap(1, 2);
    }
    mesh.normals.clear();
    inside_out.objects[0].mesh = std::sync::Arc::new(mesh);
    let map = lightmap(&mut emit(&inside_out, 0), 0, 256);
    let held: Vec<usize> = (0..map.places.len()).filter(|texel| map.places[*texel].is_some()).collect();
    let mean =
        |part: &dyn Fn(usize) -> f32| held.iter().map(|texel| f64::from(part(*texel))).sum::<f64>() / held.len() as f64;
    let direct = mean(&|texel| map.direct[texel][0]);
    let all = mean(&|texel| map.irradiance(texel)[0]);
    assert!((direct - 1.0).abs() < 0.02, "{direct} W/m² from the walls' own light");
    assert!((all - 2.0).abs() < 0.03, "{all} W/m² in all");
}
