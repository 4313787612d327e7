//! The caustic of a glass ball under every kind of light, against brute-force tracing from the light: irradiance in bins of the
//! floor, within the noise.

use diacaustic::EnergyMap;
use diacaustic_reference::{
    geometry::{Sphere, World},
    light_tracing::{Region, irradiance_on},
};
use diacaustic_scene::{LightKind, RadianceMap, Scene};
use diacaustic_tests::{emit, scene};
use glam::{DVec3, Vec3};

const PHOTONS: u64 = 1 << 19;
const REFERENCE_PHOTONS: u32 = 400_000;
/// Texels along a side of the floor of 2 m, and bins along a side of its middle metre.
const MAP_SIZE: u32 = 513;
const BINS: usize = 8;
/// The renderer's own noise in a bin, relative to it and to the brightest bin.
const RENDERER_ERROR: [f64; 2] = [0.015, 0.002];

fn ball_under(light: &str, emission: f32) -> Scene {
    scene(&format!(
        "camera = {{ position = [0, 2.2, 3.2], look_at = [0, 0.2, 0], vertical_fov = 40 }}
         render = {{ map_size = {MAP_SIZE}, max_depth = 64 }}
         materials.glass = {{ type = \"dielectric\", ior = 1.5, tint = [1, 0.8, 0.6] }}
         materials.floor = {{ type = \"diffuse\", albedo = 0.8 }}
         materials.glow = {{ type = \"diffuse\", albedo = 0, emission = {emission} }}
         lights = [{light}]
         objects = [
             {{ rectangle = {{ center = [0, 0, 0], edge_u = [2, 0, 0], edge_v = [0, 0, -2] }}, material = \"floor\" }},
             {{ sphere = {{ center = [0, 0.4, 0], radius = 0.25, subdivisions = 5 }}, material = \"glass\" }},
             {{ box = {{ min = [0.4, 1.2, -0.1], max = [0.6, 1.3, 0.3] }}, material = \"glow\", rotate = [10, 20, 0] }},
         ]"
    ))
}

/// Mean irradiance in the bins of the floor's middle metre, W/m², rows along −z.
fn bins(map: &EnergyMap) -> Vec<DVec3> {
    // Two points a texel each way.
    let fine = (MAP_SIZE - 1) as usize / BINS;
    let last = f64::from(MAP_SIZE - 1);
    let bilinear = |x: f64, y: f64| {
        let (i, j) = (x as usize, y as usize);
        let (f, g) = (x.fract(), y.fract());
        let e = |i: usize, j: usize| map.irradiance(j * MAP_SIZE as usize + i);
        (1.0 - g) * ((1.0 - f) * e(i, j) + f * e(i + 1, j)) + g * ((1.0 - f) * e(i, j + 1) + f * e(i + 1, j + 1))
    };
    let place =
        |bin: usize, k: usize| last * (0.25 + 0.5 * (bin as f64 + (k as f64 + 0.5) / fine as f64) / BINS as f64);
    let mean = |row: usize, column: usize| {
        let all = (0..fine).flat_map(|k| (0..fine).map(move |l| (k, l)));
        let sum: DVec3 = all.map(|(k, l)| bilinear(place(column, k), place(row, l))).sum();
        sum / (fine * fine) as f64
    };
    (0..BINS * BINS).map(|bin| mean(bin / BINS, bin % BINS)).collect()
}

fn assert_caustic(scene: &Scene) {
    let map = emit(scene, PHOTONS).energy_map(0).unwrap().expect("the floor is a receiver");
    let found = bins(&map);
    let region = Region { center: DVec3::ZERO, edge_u: DVec3::X, edge_v: -DVec3::Z, columns: BINS, rows: BINS };
    let around = Sphere { center: DVec3::new(0.0, 0.4, 0.0), radius: 0.26 };
    let world = World::new(scene);
    let expected = irradiance_on(&world, &region, Some(&around), REFERENCE_PHOTONS, 3).via_casters;
    let brightest = expected.iter().map(|bin| bin.mean.y).fold(0.0, f64::max);
    assert!(brightest > 0.0, "there is no caustic to compare");
    let mut worst = (0.0, String::new());
    for (bin, (found, expected)) in found.iter().zip(&expected).enumerate() {
        for channel in 0..3 {
            let allowed = 4.5 * expected.variance[channel].sqrt()
                + RENDERER_ERROR[0] * expected.mean[channel]
                + RENDERER_ERROR[1] * brightest;
            let ratio = (found[channel] - expected.mean[channel]).abs() / allowed;
            if ratio > worst.0 {
                worst = (ratio, format!("bin {bin}, channel {channel}: {found} W/m², reference {expected:?}"));
            }
        }
    }
    assert!(worst.0 <= 1.0, "{}", worst.1);
    // The whole caustic, where the noise of the bins averages out.
    let (sum, known): (DVec3, DVec3) = (found.iter().sum(), expected.iter().map(|bin| bin.mean).sum());
    let deviation = expected.iter().map(|bin| bin.variance).sum::<DVec3>().map(f64::sqrt);
    let allowed = 4.5 * deviation + 3e-3 * known;
    assert!((sum - known).abs().cmple(allowed).all(), "all bins: {sum}, reference {known} ± {deviation}");
}

#[test]
fn sphere() {
    assert_caustic(&ball_under("{ type = \"sphere\", center = [0.8, 2, 0.3], radius = 0.1, flux = 35 }", 0.0));
}

#[test]
fn rectangle() {
    let light =
        "{ type = \"rectangle\", center = [0.8, 2, 0.3], edge_u = [0.3, 0, 0], edge_v = [0, 0, 0.2], flux = 35 }";
    assert_caustic(&ball_under(light, 0.0));
}

#[test]
fn disk() {
    let light = "{ type = \"disk\", center = [0.8, 2, 0.3], normal = [-0.3, -1, 0], radius = 0.2, flux = 35 }";
    assert_caustic(&ball_under(light, 0.0));
}

#[test]
fn point() {
    assert_caustic(&ball_under("{ type = \"point\", position = [0.8, 2, 0.3], flux = 35 }", 0.0));
}

#[test]
fn spot() {
    let light = "{ type = \"spot\", position = [0.8, 2, 0.3], look_at = [0.1, 0.4, 0.1], inner_angle = 3, outer_angle = 9, flux = 5 }";
    assert_caustic(&ball_under(light, 0.0));
}

#[test]
fn parallel_light() {
    assert_caustic(&ball_under("{ type = \"directional\", direction = [-0.3, -1, -0.1], irradiance = 5 }", 0.0));
}

#[test]
fn sun() {
    assert_caustic(&ball_under(
        "{ type = \"sun\", direction = [-0.3, -1, -0.1], angular_radius = 5, irradiance = 5 }",
        0.0,
    ));
}

#[test]
fn emissive_object() {
    assert_caustic(&ball_under("", 20.0));
}

#[test]
fn environment() {
    let mut scene = ball_under("{ type = \"point\", position = [0, 5, 0], flux = 1 }", 0.0);
    // A bright window in a dim sky.
    let texel = |k: u32| {
        let (column, row) = (k % 32, k / 32);
        if (10..13).contains(&column) && (3..5).contains(&row) { Vec3::new(40.0, 30.0, 20.0) } else { Vec3::splat(0.2) }
    };
    let map = RadianceMap { width: 32, height: 16, texels: (0..512).map(texel).collect() };
    scene.lights[0].kind = LightKind::Environment { map: map.into(), rotate: 25.0, scale: Vec3::ONE };
    assert_caustic(&scene);
}
