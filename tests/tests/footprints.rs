//! Photons with footprints: as much light as without, less noise, and the same bits in every run.

use diacaustic::EnergyMap;
use diacaustic_scene::Scene;
use diacaustic_tests::{emit, mean, renderer, scene};

fn teapot(footprints: bool, seed: u32) -> Scene {
    scene(&format!(
        "camera = {{ position = [0, 2.2, 3.2], look_at = [0, 0.2, 0], vertical_fov = 40 }}
         render = {{ width = 64, height = 64, map_size = 801, seed = {seed}, footprints = {footprints} }}
         materials.glass = {{ type = \"dielectric\", ior = 1.5, absorption = [0.5, 0, 1] }}
         materials.floor = {{ type = \"diffuse\", albedo = 0.8 }}
         lights = [{{ type = \"sphere\", center = [1.0, 2.5, 0.6], radius = 0.05, flux = 35 }}]
         objects = [
             {{ mesh = \"assets/meshes/teapot.obj\", material = \"glass\", translate = [0, 0.2, 0] }},
             {{ rectangle = {{ center = [0, 0, 0], edge_u = [4, 0, 0], edge_v = [0, 0, -4] }}, material = \"floor\" }},
         ]"
    ))
}

fn map(footprints: bool, seed: u32, photons: u64) -> EnergyMap {
    emit(&teapot(footprints, seed), photons).energy_map(1).unwrap().unwrap()
}

#[test]
fn the_ledger_closes_and_no_flux_moves_elsewhere() {
    let photons = 100_000;
    let renderer = emit(&teapot(true, 1), photons);
    let ledger = renderer.statistics().unwrap().ledgers[0];
    assert_eq!(ledger.residue(), [0; 3]);
    let spread = renderer.energy_map(1).unwrap().unwrap();
    let held: i64 = spread.sums.iter().map(|sum| sum[1]).sum();
    assert_eq!(held, ledger.deposited[1]);
    // The same photons fall with and without footprints; only the texels differ.
    let plain = map(false, 1, photons);
    let plain_held: i64 = plain.sums.iter().map(|sum| sum[1]).sum();
    assert!((plain_held as f64 / held as f64 - 1.0).abs() < 1e-3, "{plain_held} units without, {held} with footprints");
    assert_ne!(plain.sums, spread.sums);
    // Their centre moves by less than a texel.
    let centre = |map: &EnergyMap| {
        let column = |texel: usize| f64::from(texel as u32 % map.width);
        let moments = map.sums.iter().enumerate().map(|(texel, sum)| sum[1] as f64 * column(texel));
        moments.sum::<f64>() / held as f64
    };
    let (before, after) = (centre(&plain), centre(&spread));
    assert!((before - after).abs() < 0.5, "the centre moves from {before} to {after}");
}

#[test]
fn footprints_lower_the_error() {
    let irradiance = |map: &EnergyMap| (0..map.areas.len()).map(|texel| map.irradiance(texel).y).collect::<Vec<f64>>();
    let truth = irradiance(&map(false, 99, 8_000_000));
    let middle = mean(truth.iter().copied());
    let error = |footprints| {
        let found = irradiance(&map(footprints, 1, 1 << 16));
        mean(truth.iter().zip(&found).map(|(truth, found)| (found - truth).powi(2) / (truth + middle).powi(2)))
    };
    let (spread, plain) = (error(true), error(false));
    assert!(2.0 * spread < plain, "error {spread} with footprints, {plain} without");
}

#[test]
fn pieces_equal_the_whole() {
    let whole = map(true, 3, 100_000);
    let mut pieces = renderer(&teapot(true, 3));
    for piece in [60_001..100_000, 0..7, 7..60_001] {
        pieces.emit_photons(piece).unwrap();
    }
    assert_eq!(pieces.energy_map(1).unwrap().unwrap(), whole);
}
