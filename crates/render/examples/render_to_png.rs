//! Renders a scene file to a PNG.
//!
//!     cargo run --release -p diacaustic --example render_to_png -- assets/scenes/ball.toml ball.png

use std::{env, error::Error, path::Path};

use diacaustic::{Renderer, RendererOptions, Stage, scene::load_scene};
use diacaustic_headless::{OpenOptions, open};
use diacaustic_output::{Display, Picture, Tone, write_png};

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = env::args().collect();
    let [_, scene_file, picture_file] = &arguments[..] else { return Err("give a scene file and a PNG".into()) };
    let loaded = load_scene(Path::new(scene_file))?;
    for warning in &loaded.warnings {
        eprintln!("warning: {warning}");
    }
    let scene = loaded.scene;

    let gpu = open(&OpenOptions::default())?;
    let mut renderer = Renderer::new(&gpu.device, &gpu.queue, &RendererOptions::default())?;
    renderer.set_scene(&scene)?;
    while renderer.refine()?.stage != Stage::Done {}

    let film = renderer.film()?;
    let picture = Picture { width: film.width, height: film.height, pixels: &film.radiance };
    let display = Display { exposure: scene.output.exposure, tone: Tone::Filmic };
    write_png(Path::new(picture_file), &picture, &display)?;
    Ok(())
}
