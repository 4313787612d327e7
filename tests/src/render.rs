//! Renders for tests, all on one device.

use std::{path::Path, sync::OnceLock};

use diacaustic::{Film, Renderer, RendererOptions};
use diacaustic_headless::{Gpu, OpenOptions, open};
use diacaustic_scene::{Scene, parse_scene};

/// The device that all tests of a process share.
///
/// # Panics
/// If there is no adapter: a failure that says what to install, never a silent skip.
pub fn gpu() -> &'static Gpu {
    static GPU: OnceLock<Gpu> = OnceLock::new();
    GPU.get_or_init(|| {
        open(&OpenOptions::default()).unwrap_or_else(|error| panic!("the tests need an adapter: {error}"))
    })
}

/// A renderer with a scene set.
///
/// # Panics
/// If the scene cannot be set.
pub fn renderer(scene: &Scene) -> Renderer {
    let gpu = gpu();
    let mut renderer =
        Renderer::new(&gpu.device, &gpu.queue, &RendererOptions::default()).unwrap_or_else(|error| panic!("{error}"));
    renderer.set_scene(scene).unwrap_or_else(|error| panic!("{error}"));
    renderer
}

/// A renderer that has emitted photons 0 to `photons`.
///
/// # Panics
/// If the scene cannot be rendered.
pub fn emit(scene: &Scene, photons: u64) -> Renderer {
    let mut renderer = renderer(scene);
    renderer.emit_photons(0..photons).unwrap_or_else(|error| panic!("{error}"));
    renderer
}

/// The photons that a scene states, or a million.
pub fn photons_of(scene: &Scene) -> u64 {
    scene.settings.photons.unwrap_or(1_000_000)
}

/// The samples that a scene states, or sixteen.
pub fn samples_of(scene: &Scene) -> u32 {
    scene.settings.samples.unwrap_or(16)
}

/// A picture of the scene with its own numbers of photons and samples.
///
/// # Panics
/// If the scene cannot be rendered.
pub fn render(scene: &Scene) -> Film {
    let mut renderer = emit(scene, photons_of(scene));
    renderer.add_samples(samples_of(scene)).unwrap_or_else(|error| panic!("{error}"));
    renderer.film().unwrap_or_else(|error| panic!("{error}"))
}

/// A scene from the text of a scene file, whose paths are relative to the repository.
///
/// # Panics
/// If the text is no scene.
pub fn scene(text: &str) -> Scene {
    let loaded = parse_scene(text, Path::new(crate::repository()), "the test's scene");
    loaded.unwrap_or_else(|error| panic!("{error}")).scene
}
