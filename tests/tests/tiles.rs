//! Maps whose size the scene leaves open: as fine as the camera sees them, whole in energy, the same in every run, and within their budget.

use diacaustic::{EnergyMap, MapTile, Renderer, RendererOptions, SceneReport, glam::DVec2};
use diacaustic_scene::{RenderSettings, Scene};
use diacaustic_tests::{gpu, mean, samples_of, scene};

/// A renderer with a scene set, and what that has built.
fn set(scene: &Scene) -> (Renderer, SceneReport) {
    let mut renderer = Renderer::new(&gpu().device, &gpu().queue, &RendererOptions::default()).unwrap();
    let report = renderer.set_scene(scene).unwrap_or_else(|error| panic!("{error}"));
    (renderer, report)
}

/// A glass ball of 20 cm on a floor, seen from less than a metre.
fn ball_on_a_floor(side: f32, settings: &str) -> Scene {
    scene(&format!(
        "camera = {{ position = [0.3, 0.45, 0.5], look_at = [0.1, 0.02, 0], vertical_fov = 30 }}
         render = {{ width = 96, height = 96, samples = 8, max_bounces = 0, seed = 3 {settings} }}
         output = {{ layers = [\"caustic\"] }}
         materials.glass = {{ type = \"dielectric\", ior = 1.5 }}
         materials.floor = {{ type = \"diffuse\", albedo = 0.8 }}
         lights = [{{ type = \"sphere\", center = [-0.8, 1.2, 0.3], radius = 0.02, flux = 30 }}]
         objects = [
             {{ rectangle = {{ center = [0, 0, 0], edge_u = [{side}, 0, 0], edge_v = [0, 0, -{side}] }}, material = \"floor\" }},
             {{ sphere = {{ center = [0, 0.1, 0], radius = 0.1 }}, material = \"glass\" }},
         ]"
    ))
}

/// The sum of the caustic over squares of 8 × 8 pixels.
fn caustic_blocks(scene: &Scene, photons: u64) -> (Vec<f64>, SceneReport) {
    let (mut renderer, report) = set(scene);
    renderer.emit_photons(0..photons).unwrap();
    renderer.add_samples(samples_of(scene)).unwrap();
    let width = scene.settings.width as usize;
    let layers = renderer.layers().unwrap();
    let caustic = layers[0].channels.iter().find(|channel| channel.name.ends_with('G')).expect("a green channel");
    let diacaustic::LayerValues::Float(pixels) = &caustic.values else { panic!("radiance is no number") };
    let mut blocks = vec![0.0; (width / 8).pow(2)];
    for (pixel, value) in pixels.iter().enumerate() {
        blocks[pixel / width / 8 * (width / 8) + pixel % width / 8] += f64::from(*value);
    }
    (blocks, report)
}

#[test]
fn a_caustic_on_a_floor_of_100_metres_is_that_on_one_of_2() {
    let photons = 300_000;
    let (small, _) = caustic_blocks(&ball_on_a_floor(2.0, ""), photons);
    let (large, report) = caustic_blocks(&ball_on_a_floor(100.0, ""), photons);
    let floor = &report.maps[0];
    assert!(floor.finest_texel_width < 0.001 && floor.texel_width < 0.008, "{floor:?}");
    assert!(floor.texel_width == floor.wanted_texel_width, "{floor:?}");
    assert!(report.map_bytes < 64 << 20, "{} bytes", report.map_bytes);
    let brightest = small.iter().copied().fold(0.0, f64::max);
    // Bright blocks have tens of thousands of photons; the rest is judged against a tenth of the brightest.
    for (block, (small, large)) in small.iter().zip(&large).enumerate() {
        let difference = (small - large).abs() / (small + 0.1 * brightest);
        assert!(difference < 0.08, "block {block}: {large} on the large floor, {small} on the small one");
    }
    assert!(brightest > 20.0 * mean(small.iter().copied()), "there is no focus, so nothing is tested");

    // The same floor in even texels, as many along a side as a map may have, has none so fine.
    let (coarse, _) = caustic_blocks(&ball_on_a_floor(100.0, ", map_size = 2048"), photons);
    let differs = small.iter().zip(&coarse).any(|(a, b)| (a - b).abs() / (a + 0.1 * brightest) > 0.3);
    assert!(differs, "the comparison cannot fail");
}

/// A floor that even light reaches through glass of index 1, with a camera close to one of its corners; 3 W/m² fall on it.
fn evenly_lit_floor(settings: &str) -> Scene {
    scene(&format!(
        "camera = {{ position = [-0.9, 0.35, 1.3], look_at = [-0.7, 0, 0.8], vertical_fov = 40 }}
         render = {{ width = 128, height = 128, seed = 4, guiding = false {settings} }}
         materials.nothing = {{ type = \"dielectric\", ior = 1.0 }}
         materials.floor = {{ type = \"diffuse\", albedo = 0.5 }}
         lights = [{{ type = \"directional\", direction = [0, -1, 0], irradiance = 3 }}]
         objects = [
             {{ rectangle = {{ center = [0, 0, 0], edge_u = [2, 0, 0], edge_v = [0, 0, -2] }}, material = \"floor\" }},
             {{ box = {{ min = [-1.1, 0.5, -1.1], max = [1.1, 0.6, 1.1] }}, material = \"nothing\" }},
         ]"
    ))
}

/// Whether a texel of a tile stands on its border, inside the map.
fn is_on_inner_border(map: &EnergyMap, tile: &MapTile, [x, y]: [u32; 2]) -> bool {
    let place = map.tiles.origin(tile) + map.tiles.cell_size(tile) * DVec2::new(x.into(), y.into());
    let is_outer = place.min_element() <= 0.0 || (map.tiles.extent - place).min_element() <= 0.0;
    !is_outer && (x == 0 || y == 0 || x == tile.cells[0] || y == tile.cells[1])
}

/// Deviations of texels' irradiance from 3 W/m².
#[derive(Clone, Copy, Debug, Default)]
struct Evenness {
    /// Flux by the irradiance shown, and area.
    flux: f64,
    area: f64,
    /// Squares of deviations, in units of what random photons on a whole texel would have.
    squares: f64,
    texels: f64,
}

impl Evenness {
    fn add(&mut self, irradiance: f64, whole: f64, photon: f64) {
        let (flux, expected) = (irradiance * whole, 3.0 * whole);
        self.flux += flux;
        self.area += whole;
        self.squares += (flux - expected).powi(2) / (expected * photon);
        self.texels += 1.0;
    }

    fn irradiance(&self) -> f64 {
        self.flux / self.area
    }

    fn deviation(&self) -> f64 {
        self.squares / self.texels
    }
}

/// The evenness of texels on the borders between tiles, and of those inside tiles by the width of their cells, the finest first.
fn evenness(map: &EnergyMap, photon: f64) -> (Evenness, Vec<Evenness>) {
    let (mut border, mut inside) = (Evenness::default(), std::collections::BTreeMap::<u64, Evenness>::new());
    let square_metres = map.areas.iter().sum::<f64>() / f64::from(map.layers) / map.tiles.extent.element_product();
    for tile in map.tiles.tiles.iter().filter(|tile| tile.square.layer == 0) {
        let texels = (0..=tile.cells[1]).flat_map(|y| (0..=tile.cells[0]).map(move |x| [x, y]));
        let whole = map.tiles.cell_size(tile).element_product() * square_metres;
        for (texel, place) in (tile.first_texel as usize..).zip(texels) {
            let is_on_border = is_on_inner_border(map, tile, place);
            let of = if is_on_border { &mut border } else { inside.entry(whole.to_bits()).or_default() };
            of.add(map.irradiance(texel).y, whole, photon);
        }
    }
    (border, inside.into_values().collect())
}

/// Asserts that a map shows the same on both sides of each border between tiles.
fn assert_no_jumps(map: &EnergyMap) {
    let mut places = 0;
    for tile in map.tiles.tiles.iter().filter(|tile| tile.square.layer == 0) {
        let (low, size) = (map.tiles.origin(tile), map.tiles.square_size(tile.square.level));
        for part in [0.03, 0.21, 0.5, 0.86] {
            for (place, across) in [(DVec2::new(0.0, part), DVec2::X), (DVec2::new(part, 0.0), DVec2::Y)] {
                let place = low + size * place;
                if place.min_element() > 0.0 {
                    let [before, after] = [-1e-7, 1e-7].map(|step| map.irradiance_at(0, place + step * across).y);
                    assert!((before - after).abs() < 1e-4, "{place}: {before} and {after} W/m²");
                    places += 1;
                }
            }
        }
    }
    assert!(places > 300, "{places} places");
}

#[test]
fn even_light_is_even_over_tiles_of_every_size() {
    const PHOTONS: u64 = 1 << 20;
    for footprints in ["", ", footprints = true"] {
        let scene = evenly_lit_floor(&format!(", map_filter = false {footprints}"));
        let (mut renderer, _) = set(&scene);
        renderer.emit_photons(0..PHOTONS).unwrap();
        let map = renderer.energy_map(0).unwrap().unwrap();
        let levels: std::collections::BTreeSet<_> = map.tiles.tiles.iter().map(|tile| tile.square.level).collect();
        assert!(levels.len() >= 3, "tiles of the levels {levels:?} alone");

        let statistics = renderer.statistics().unwrap();
        let ledger = statistics.ledgers[0];
        assert_eq!(ledger.residue(), [0; 3]);
        for channel in 0..3 {
            let held: i64 = map.sums.iter().map(|sum| sum[channel]).sum();
            assert_eq!(held, ledger.deposited[channel], "{footprints}");
        }
        let photon = ledger.watts(ledger.emitted, PHOTONS).y / PHOTONS as f64;
        let (border, widths) = evenness(&map, photon);
        assert!((border.irradiance() / 3.0 - 1.0).abs() < 0.004, "{footprints}: {border:?}");
        let mut inside = Evenness::default();
        for of in &widths {
            // On texels of every width photons are more even than random ones.
            assert!(of.deviation() < 0.8, "{footprints}: {of:?}");
            inside.flux += of.flux;
            inside.area += of.area;
            inside.squares += of.squares;
            inside.texels += of.texels;
        }
        assert!(widths.len() >= 3, "{widths:?}");
        assert!((inside.irradiance() / 3.0 - 1.0).abs() < 0.002, "{footprints}: {inside:?}");
        assert!(inside.deviation() < 0.25, "{footprints}: {} inside", inside.deviation());
        assert!(border.deviation() < 1.1 * inside.deviation(), "{footprints}: {border:?}, {inside:?}");
        assert_no_jumps(&map);
    }
}

/// The floor's map after photons in some pieces.
fn map(scene: &Scene, pieces: &[std::ops::Range<u64>]) -> EnergyMap {
    let (mut renderer, _) = set(scene);
    pieces.iter().for_each(|piece| renderer.emit_photons(piece.clone()).unwrap());
    renderer.energy_map(0).unwrap().unwrap()
}

#[test]
fn open_maps_are_the_same_in_every_run_in_pieces_and_merged() {
    for guiding in [true, false] {
        let mut scene = ball_on_a_floor(5.0, "");
        // Merged maps are not filtered.
        scene.settings = RenderSettings { guiding, map_filter: false, ..scene.settings };
        let whole = map(&scene, std::slice::from_ref(&(0..60_000)));
        assert!(whole.tiles.tiles.len() > 100, "{} tiles", whole.tiles.tiles.len());
        assert_eq!(map(&scene, &[20_000..60_000, 0..20_000]), whole, "guiding = {guiding}: in pieces");
        let mut merged = map(&scene, std::slice::from_ref(&(0..25_000)));
        assert!(merged.merge(&map(&scene, std::slice::from_ref(&(25_000..60_000)))));
        assert_eq!(merged, whole, "guiding = {guiding}: merged");
        scene.settings.map_budget = Some(1);
        assert!(!merged.merge(&map(&scene, std::slice::from_ref(&(0..10)))), "maps of different tiles merged");
    }
}

#[test]
fn a_small_budget_keeps_the_energy_and_is_reported() {
    let photons = |budget| {
        let mut scene = ball_on_a_floor(5.0, ", guiding = false");
        scene.settings = RenderSettings { width: 512, height: 512, map_budget: budget, ..scene.settings };
        let (mut renderer, report) = set(&scene);
        renderer.emit_photons(0..50_000).unwrap();
        let map = renderer.energy_map(0).unwrap().unwrap();
        let ledger = renderer.statistics().unwrap().ledgers[0];
        assert_eq!(map.sums.iter().map(|sum| sum[1]).sum::<i64>(), ledger.deposited[1]);
        assert_eq!(map.sums.len() as u64, report.maps[0].texels);
        assert!((map.areas.iter().sum::<f64>() - 50.0).abs() < 1e-6, "each side has 25 m²");
        (report, ledger.deposited)
    };
    let (full, deposited) = photons(None);
    let (small, in_small) = photons(Some(1));
    assert_eq!(in_small, deposited, "without a guide, a budget changes no photon");
    assert_eq!((full.map_budget, small.map_budget), (256 << 20, 1 << 20));
    assert!(small.map_bytes <= 1 << 20 && full.map_bytes > 4 << 20, "{} and {} bytes", small.map_bytes, full.map_bytes);
    let (full, small) = (&full.maps[0], &small.maps[0]);
    assert_eq!(full.texel_width, full.wanted_texel_width);
    assert_eq!(small.wanted_texel_width, full.wanted_texel_width);
    assert!(small.texel_width > 1.5 * small.wanted_texel_width, "{small:?}");
}

#[test]
fn a_stated_size_is_even_or_refused() {
    let scene = ball_on_a_floor(2.0, ", map_size = 100");
    let (renderer, report) = set(&scene);
    let map = renderer.energy_map(0).unwrap().unwrap();
    assert_eq!((map.width, map.height, map.sums.len()), (100, 100, 20_000));
    assert_eq!(map.tiles.tiles.iter().map(|tile| tile.cells).collect::<Vec<_>>(), [[99, 99]; 2]);
    let floor = &report.maps[0];
    assert!(
        (floor.texel_width - 2.0 / 99.0).abs() < 1e-6 && floor.texel_width == floor.finest_texel_width,
        "{floor:?}"
    );

    let mut large = scene.clone();
    large.settings.map_size = Some(8192);
    let mut renderer = renderer;
    let available = gpu().device.limits().max_storage_buffer_binding_size;
    match renderer.set_scene(&large) {
        Err(error) => {
            let text = error.to_string();
            assert!(text.contains("3221225472") && text.contains("lower map_size"), "{text}");
        }
        Ok(_) => assert!(available > 1 << 30, "{available} bytes can be bound, and 3 GiB were taken"),
    }
    assert_eq!(renderer.energy_map(0).unwrap().unwrap().width, 100, "the scene set before stays");
}

#[test]
fn sums_larger_than_a_binding_are_whole() {
    let mut scene = ball_on_a_floor(2.0, ", guiding = false");
    scene.settings.map_size = Some(2000);
    let (mut renderer, report) = set(&scene);
    assert!(report.map_bytes > 128 << 20, "{} bytes fit into a binding of WebGPU's default limits", report.map_bytes);
    renderer.emit_photons(0..20_000).unwrap();
    let map = renderer.energy_map(0).unwrap().unwrap();
    let deposited = renderer.statistics().unwrap().ledgers[0].deposited;
    assert_eq!(map.sums.iter().map(|sum| sum[1]).sum::<i64>(), deposited[1]);
    assert!(deposited[1] > 0, "nothing was deposited");
}

#[test]
fn a_resampled_map_shows_the_irradiance() {
    let scene = evenly_lit_floor("");
    let (mut renderer, _) = set(&scene);
    renderer.emit_photons(0..1 << 19).unwrap();
    let map = renderer.energy_map(0).unwrap().unwrap();
    let texels = map.resampled();
    let side = map.width as usize * map.height as usize;
    assert_eq!(texels.len(), side * map.layers as usize);
    let front = mean(texels[..side].iter().map(|texel| texel.y));
    assert!((front / 3.0 - 1.0).abs() < 0.01, "{front} W/m²");
    assert!(texels[side..].iter().all(|texel| texel.y == 0.0), "light on the back");
}
