//! Every scene of `assets/scenes`: sound, and rendered to something.

use std::path::{Path, PathBuf};

use diacaustic::{Film, Renderer};
use diacaustic_scene::{MaterialKind, Scene, load_scene};
use diacaustic_tests::{emit, photons_of, renderer, repository, samples_of};

/// The scene files, sorted.
fn scene_files() -> Vec<PathBuf> {
    let folder = Path::new(repository()).join("assets/scenes");
    let entries = folder.read_dir().unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
    let mut files: Vec<_> = entries.map(|entry| entry.unwrap().path()).collect();
    files.retain(|file| file.extension().is_some_and(|ending| ending == "toml"));
    files.sort();
    assert!(!files.is_empty(), "{}: there are no scenes", folder.display());
    files
}

/// A scene without warnings, and its name.
fn load(file: &Path) -> (String, Scene) {
    let loaded = load_scene(file).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(loaded.warnings, [], "{}", file.display());
    (file.display().to_string(), loaded.scene)
}

/// The share of guided photons that reach a receiver through a caster, at least, in hundredths: docs/statistics.md, "How many photons land".
const LEAST_SHARES: [(&str, u32); 16] = [
    ("ball", 84),
    ("crystal", 35),
    ("daylight", 53),
    ("diamond", 29),
    ("lanterns", 62),
    ("metal-ring", 69),
    ("moving-light", 65),
    ("plastics", 52),
    ("prism", 70),
    ("rough-glass", 71),
    ("spotlights", 69),
    ("teapot", 64),
    ("textured", 61),
    ("turntable", 55),
    ("water-glass", 79),
    ("wine-glass", 81),
];

#[test]
fn guided_photons_reach_receivers() {
    let mut missing: Vec<_> = LEAST_SHARES.map(|(name, _)| name).to_vec();
    for file in scene_files() {
        let stem = file.file_stem().unwrap().to_string_lossy().into_owned();
        let Some((name, least)) = LEAST_SHARES.into_iter().find(|(name, _)| *name == stem) else {
            panic!("{stem}: its share is not stated")
        };
        missing.retain(|other| *other != name);
        let statistics = emit(&load(&file).1, 1 << 15).statistics().unwrap();
        let share = statistics.deposits as f64 / statistics.photons as f64;
        assert!(share > 0.01 * f64::from(least), "{name}: {share} of the photons land, less than {least} %");
    }
    assert!(missing.is_empty(), "no such scenes: {missing:?}");
}

/// The scene, small enough to render at once.
fn reduced(mut scene: Scene) -> Scene {
    scene.settings.width = 96;
    scene.settings.height = 96;
    scene.settings.samples = Some(4);
    scene.settings.photons = Some(60_000);
    scene
}

#[test]
fn the_scenes_that_later_work_relies_on_are_there() {
    let names: Vec<_> = scene_files().iter().map(|file| file.file_stem().unwrap().to_owned()).collect();
    let names_needed =
        ["teapot", "crystal", "ball", "wine-glass", "water-glass", "metal-ring", "plastics", "rough-glass"];
    for name in names_needed.into_iter().chain(["spotlights", "daylight", "lanterns", "textured", "prism", "diamond"]) {
        assert!(names.iter().any(|found| found == name), "{name}.toml is missing");
    }
}

#[test]
fn glass_is_closed_and_faces_outward() {
    for file in scene_files() {
        let (name, scene) = load(&file);
        let is_glass = |material: &usize| matches!(scene.materials[*material].kind, MaterialKind::Dielectric { .. });
        let glass: Vec<_> = scene.objects.iter().filter(|object| object.materials.iter().any(is_glass)).collect();
        let casts = |material: &usize| scene.materials[*material].is_caster();
        assert!(scene.objects.iter().any(|o| o.materials.iter().any(casts)), "{name}: nothing makes caustics");
        for object in glass {
            let (open, volume) = (object.mesh.open_edges(), object.mesh.signed_volume());
            assert_eq!(open, 0, "{name}: {:?} has open edges", object.name);
            assert!(volume > 0.0, "{name}: {:?} encloses {volume} m³", object.name);
        }
    }
}

fn assert_unrendered_is_zero(name: &str, scene: &Scene, renderer: &Renderer) {
    let film = renderer.film().unwrap();
    assert!(film.samples == 0 && film.radiance.iter().all(|pixel| *pixel == [0.0; 3]), "{name}: the film began dirty");
    let mut maps = 0;
    for object in 0..scene.objects.len() {
        let Some(map) = renderer.energy_map(object).unwrap() else { continue };
        maps += 1;
        assert!(map.photons == 0 && map.sums.iter().all(|sum| *sum == [0; 3]), "{name}: map {object} began dirty");
    }
    assert!(maps > 0, "{name}: no object has an energy map");
}

/// A colour of one wavelength may have a negative channel; without dispersion there is none.
fn assert_finite_and_lit(name: &str, film: &Film, may_be_negative: bool) {
    assert_eq!((film.width, film.height, film.samples), (96, 96, 4), "{name}");
    let channels = film.radiance.as_flattened();
    assert!(
        channels.iter().all(|value| value.is_finite() && (may_be_negative || *value >= 0.0)),
        "{name}: a pixel is undefined or negative"
    );
    let lit = film.radiance.iter().filter(|pixel| pixel[1] > 1e-3).count();
    assert!(lit * 10 > film.radiance.len(), "{name}: only {lit} pixels are lit");
}

#[test]
fn every_scene_renders_to_a_picture_with_a_caustic() {
    for file in scene_files() {
        let (name, scene) = load(&file);
        let scene = reduced(scene);
        let mut renderer = renderer(&scene);
        assert_unrendered_is_zero(&name, &scene, &renderer);
        renderer.emit_photons(0..photons_of(&scene)).unwrap();
        renderer.add_samples(samples_of(&scene)).unwrap();
        assert_finite_and_lit(&name, &renderer.film().unwrap(), scene.has_dispersion());
        let statistics = renderer.statistics().unwrap();
        assert!(statistics.deposits > 0, "{name}: no photon was deposited");
        assert!(statistics.ledgers.iter().all(|ledger| ledger.residue() == [0; 3]), "{name}: the ledger is open");
    }
}
