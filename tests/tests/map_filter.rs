//! Energy maps with a filter: the same flux, less noise, no light where there is none, the truth as photons grow, the same bits in every run.

use std::sync::Arc;

use diacaustic::{EnergyMap, LayerValues, Renderer, RendererOptions};
use diacaustic_scene::Scene;
use diacaustic_tests::{emit, gpu, scene};

/// A glass ball over a floor, under two lamps.
fn ball_on_a_floor(settings: &str) -> Scene {
    scene(&format!(
        "camera = {{ position = [0.3, 0.45, 0.5], look_at = [0.1, 0.02, 0], vertical_fov = 30 }}
         render = {{ width = 96, height = 96, samples = 4, max_bounces = 0, seed = 3 {settings} }}
         materials.glass = {{ type = \"dielectric\", ior = 1.5 }}
         materials.floor = {{ type = \"diffuse\", albedo = 0.8 }}
         lights = [
             {{ type = \"sphere\", center = [-0.8, 1.2, 0.3], radius = 0.02, flux = 30, group = \"one\" }},
             {{ type = \"sphere\", center = [-0.5, 1.2, -0.3], radius = 0.02, flux = [10, 20, 30], group = \"two\" }},
         ]
         objects = [
             {{ rectangle = {{ center = [0, 0, 0], edge_u = [2, 0, 0], edge_v = [0, 0, -2] }}, material = \"floor\" }},
             {{ sphere = {{ center = [0, 0.1, 0], radius = 0.1 }}, material = \"glass\" }},
         ]"
    ))
}

/// The floor's map.
fn map(scene: &Scene, photons: u64) -> EnergyMap {
    emit(scene, photons).energy_map(0).unwrap().unwrap()
}

/// Flux by the irradiance of a map's texels over that by its sums.
fn kept(map: &EnergyMap) -> f64 {
    let shown: f64 = map.areas.iter().enumerate().map(|(texel, area)| map.irradiance(texel).y * area).sum();
    shown / (0..map.sums.len()).map(|texel| map.flux(texel).y).sum::<f64>()
}

#[test]
fn a_filtered_map_holds_the_flux_of_its_photons() {
    for settings in ["", ", footprints = true"] {
        let even = map(&ball_on_a_floor(&format!(", map_filter = true, map_size = 200 {settings}")), 30_000);
        assert!((kept(&even) - 1.0).abs() < 1e-5, "{settings}: {} on one tile", kept(&even));
        let tiled = map(&ball_on_a_floor(&format!(", map_filter = true {settings}")), 30_000);
        assert!(tiled.tiles.tiles.len() > 100);
        assert!((kept(&tiled) - 1.0).abs() < 0.01, "{settings}: {} on tiles of all sizes", kept(&tiled));
    }
}

/// Relative squared deviation of a map from another, over the bright part of that.
fn error(map: &EnergyMap, truth: &EnergyMap) -> f64 {
    let truths: Vec<f64> = (0..truth.sums.len()).map(|texel| truth.irradiance(texel).y).collect();
    let lit: Vec<usize> = (0..truths.len()).filter(|&texel| truths[texel] > 0.25).collect();
    assert!(lit.len() > 100, "{} texels are lit", lit.len());
    let square = |&texel: &usize| (map.irradiance(texel).y - truths[texel]).powi(2) / truths[texel].powi(2);
    lit.iter().map(square).sum::<f64>() / lit.len() as f64
}

#[test]
fn a_filtered_map_goes_to_the_truth() {
    let [rough, filtered] =
        ["false", "true"].map(|on| ball_on_a_floor(&format!(", map_size = 400, map_filter = {on}")));
    let truth = map(&rough, 1_000_000);
    let errors = |photons| [&rough, &filtered].map(|scene| error(&map(scene, photons), &truth));
    let (few, more) = (errors(10_000), errors(160_000));
    println!("10,000 photons: {few:?}, 160,000: {more:?}");
    assert!(more[1] < 0.2 * few[1], "16 times the photons: from {few:?} to {more:?}");
    // The focus is small against these texels: what is sharp stays so.
    assert!(few[1] < 0.8 * few[0] && more[1] < 1.2 * more[0], "filtered and not: {few:?} and {more:?}");
}

/// A box that light from straight above reaches through glass of index 1: its top is lit, its other sides are dark.
fn box_from_above(settings: &str) -> Scene {
    scene(&format!(
        "camera = {{ position = [0.9, 1.2, 1.4], look_at = [0, 0.3, 0], vertical_fov = 40 }}
         render = {{ width = 128, height = 128, seed = 4, guiding = false, map_filter = true {settings} }}
         materials.nothing = {{ type = \"dielectric\", ior = 1.0 }}
         materials.plaster = {{ type = \"diffuse\", albedo = 0.5 }}
         lights = [{{ type = \"directional\", direction = [0, -1, 0], irradiance = 3 }}]
         objects = [
             {{ box = {{ min = [-0.5, 0, -0.5], max = [0.5, 0.5, 0.5] }}, material = \"plaster\" }},
             {{ box = {{ min = [-1.1, 0.8, -1.1], max = [1.1, 0.9, 1.1] }}, material = \"nothing\" }},
         ]"
    ))
}

#[test]
fn noise_goes_and_no_light_leaves_its_chart() {
    for settings in ["", ", map_size = 128"] {
        let mut rough = box_from_above(settings);
        rough.settings.map_filter = false;
        let rough = map(&rough, 30_000);
        let renderer = emit(&box_from_above(settings), 30_000);
        let (map, layout) = (renderer.energy_map(0).unwrap().unwrap(), renderer.map_layout(0).unwrap().unwrap());
        assert_eq!(layout.chart_count, 6);
        let (mut lit, mut rough_lit, mut dark) = (Vec::new(), Vec::new(), Vec::new());
        for (triangle, corners) in layout.corners.iter().enumerate() {
            let [a, b, c] = corners.map(|place| place.as_dvec2());
            for (u, v) in (0..20).flat_map(|i| (0..20 - i).map(move |j| (f64::from(i) / 19.5, f64::from(j) / 19.5))) {
                let place = a + (b - a) * u + (c - a) * v;
                let irradiance = map.irradiance_at(0, place).y;
                if layout.charts[triangle] == chart_of_top(layout) {
                    lit.push(irradiance);
                    rough_lit.push(rough.irradiance_at(0, place).y);
                } else if rough.irradiance_at(0, place).y == 0.0 {
                    // Not where a texel wider than the gap between charts is shared by two.
                    dark.push(irradiance);
                }
            }
        }
        assert!(dark.len() > 1000, "{settings}: {} dark places", dark.len());
        assert!(dark.iter().all(|&irradiance| irradiance == 0.0), "{settings}: light on a side of the box");
        let noise = |lit: &[f64]| lit.iter().map(|irradiance| (irradiance - 3.0).powi(2)).sum::<f64>();
        assert!(noise(&lit) < 0.7 * noise(&rough_lit), "{settings}: {} after {}", noise(&lit), noise(&rough_lit));
        let mean = lit.iter().sum::<f64>() / lit.len() as f64;
        let off = lit.iter().filter(|&irradiance| (irradiance - 3.0).abs() > 0.3).count();
        println!("{settings}: {mean} W/m² on the top, {off} of {} places are not even", lit.len());
        assert!((mean - 3.0).abs() < 0.1, "{settings}: {mean} W/m² on the top");
        assert!(lit.len() > 300 && off < lit.len() / 12, "{settings}: {off} of {} places are not even", lit.len());
    }
}

/// The chart of a box's upper side, by the box's vertices.
fn chart_of_top(layout: &diacaustic::MapLayout) -> u32 {
    let scene = box_from_above("");
    let object = &scene.objects[0];
    let is_top = |triangle: &usize| object.mesh.corners(*triangle).iter().all(|corner| corner.y > 0.49);
    layout.charts[(0..object.mesh.triangles.len()).find(is_top).expect("a box has a top")]
}

#[test]
fn filtered_maps_are_the_same_in_pieces_and_after_a_break() {
    let scene = ball_on_a_floor(", map_filter = true");
    let whole = map(&scene, 40_000);
    let mut pieces = emit(&scene, 0);
    pieces.emit_photons(15_000..40_000).unwrap();
    let state = pieces.save_state().unwrap();
    let mut resumed = Renderer::new(&gpu().device, &gpu().queue, &RendererOptions::default()).unwrap();
    resumed.set_scene(&scene).unwrap();
    resumed.restore_state(&state).unwrap();
    resumed.emit_photons(0..15_000).unwrap();
    assert_eq!(resumed.energy_map(0).unwrap().unwrap(), whole);

    let mut rough = scene.clone();
    rough.settings.map_filter = false;
    let mut other = emit(&rough, 0);
    let refused = other.restore_state(&state).unwrap_err().to_string();
    assert!(refused.contains("map_filter"), "{refused}");
    let rough = map(&rough, 40_000);
    assert_eq!(rough.sums, whole.sums, "a filter changes no sum");
    assert!(rough.smoothed.is_none() && rough != whole);
}

#[test]
fn filtered_light_groups_sum_to_the_caustic() {
    let scene = ball_on_a_floor(", map_filter = true");
    let mut scene = Scene { output: scene.output.clone(), ..scene };
    scene.output.layers = diacaustic_scene::Layer::ALL.to_vec();
    let mut renderer = emit(&scene, 20_000);
    renderer.add_samples(4).unwrap();
    let layers = renderer.layers().unwrap();
    let values = |name: &str| {
        let layer = layers.iter().find(|layer| layer.name == name).unwrap_or_else(|| panic!("no layer {name}"));
        let green = layer.channels.iter().find(|channel| channel.name.ends_with('G')).expect("a green channel");
        let LayerValues::Float(pixels) = &green.values else { panic!("radiance is no number") };
        pixels.clone()
    };
    let names: Vec<Arc<str>> = layers.iter().map(|layer| layer.name.as_str().into()).collect();
    let caustic = values("caustic");
    let groups: Vec<_> = names.iter().filter(|name| name.starts_with("caustic_")).map(|name| values(name)).collect();
    assert_eq!(groups.len(), 2, "{names:?}");
    let brightest = caustic.iter().copied().fold(0.0, f32::max);
    for (pixel, whole) in caustic.iter().enumerate() {
        let sum: f32 = groups.iter().map(|group| group[pixel]).sum();
        assert!((sum - whole).abs() < 1e-4 * brightest, "pixel {pixel}: {sum} of {whole}");
    }
}
