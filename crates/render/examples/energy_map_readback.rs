//! Reads the energy map of a floor back: where the light of a glass ball is brightest, how much there is, and what became of the rest.
//!
//!     cargo run --release -p diacaustic --example energy_map_readback

use std::{error::Error, path::Path};

use diacaustic::{Renderer, RendererOptions, scene::parse_scene};
use diacaustic_headless::{OpenOptions, open};

const SCENE: &str = r#"
    camera = { position = [0, 1.5, 2.5], look_at = [0, 0.3, 0], vertical_fov = 40 }
    render = { width = 64, height = 64, map_size = 400 }
    materials.glass = { type = "dielectric", ior = 1.5 }
    materials.plaster = { type = "diffuse", albedo = 0.8 }
    lights = [{ type = "sphere", center = [0, 3, 0], radius = 0.05, flux = 35 }]
    objects = [
        { sphere = { center = [0, 0.4, 0], radius = 0.3 }, material = "glass" },
        { name = "floor", rectangle = { center = [0, 0, 0], edge_u = [4, 0, 0], edge_v = [0, 0, -4] }, material = "plaster" },
    ]
"#;

fn main() -> Result<(), Box<dyn Error>> {
    let scene = parse_scene(SCENE, Path::new("."), "the example's scene")?.scene;
    let floor = scene.objects.iter().position(|object| object.name == "floor").ok_or("there is no floor")?;

    let gpu = open(&OpenOptions::default())?;
    let mut renderer = Renderer::new(&gpu.device, &gpu.queue, &RendererOptions::default())?;
    renderer.set_scene(&scene)?;
    renderer.emit_photons(0..1_000_000)?;

    let map = renderer.energy_map(floor)?.ok_or("the floor is no receiver")?;
    let flux: f64 = (0..map.sums.len()).map(|texel| map.flux(texel).y).sum();
    println!("flux through the glass: {flux:.3} W in {} texels", map.sums.len());
    // A grid of width × height, the front first; the texels themselves are as fine as light and camera need them.
    let grid = map.resampled();
    let brightest = (0..grid.len()).max_by(|&a, &b| grid[a].y.total_cmp(&grid[b].y)).ok_or("no texels")?;
    let (x, y) = (brightest % map.width as usize, brightest / map.width as usize);
    println!("brightest at ({x}, {y}) of {} × {}: {:.1} W/m²", map.width, map.height, grid[brightest].y);

    let statistics = renderer.statistics()?;
    let ledger = statistics.ledgers[0];
    for (name, account) in [
        ("emitted", ledger.emitted),
        ("in maps", ledger.deposited),
        ("direct", ledger.direct),
        ("escaped", ledger.escaped),
    ] {
        println!("{name:>8}: {:.3} W", ledger.watts(account, statistics.photons).y);
    }
    Ok(())
}
