//! Renders glass meshes and their caustics with WGSL compute shaders, on the application's own `wgpu` device.
//!
//! Photons leave the lights and fill *energy maps* on the surfaces they reach through glass and mirrors; the camera pass reads
//! them beside direct light. The same scene, seed and adapter give the same bits.
//!
//! ```no_run
//! # fn example(device: wgpu::Device, queue: wgpu::Queue, scene: diacaustic::scene::Scene) -> Result<(), diacaustic::Error> {
//! use diacaustic::{Renderer, RendererOptions};
//!
//! let mut renderer = Renderer::new(&device, &queue, &RendererOptions::default())?;
//! renderer.set_scene(&scene)?;
//! renderer.emit_photons(0..1_000_000)?;
//! renderer.add_samples(16)?;
//! let film = renderer.film()?; // blocks
//! println!("the first pixel's radiance: {:?} W/(m² sr)", film.radiance[0]);
//! # Ok(())
//! # }
//! ```

pub use diacaustic_scene as scene;
pub use diacaustic_shaders::AimTarget;
pub use diacaustic_surface::{MapLayout, MapSquare, MapTile, MapTiles};
pub use {glam, wgpu};

mod aim;
mod bake;
mod camera_pass;
mod display_pass;
mod energy_map;
mod environment;
mod error;
mod features;
mod film;
mod gpu;
mod guide;
mod host_scene;
mod layers;
mod lights;
mod map_placement;
mod map_plan;
mod map_records;
mod map_sums;
mod material_records;
mod paper;
mod photon_pass;
mod pilot;
mod random;
mod ray_query;
mod renderer;
mod scene_buffers;
mod self_test;
mod spectra_records;
mod statistics;
mod texture_records;
mod tile_choice;

pub use aim::Emission;
pub use bake::{BakeOptions, Lightmap, SurfacePlace, base_reflectance};
pub use display_pass::RenderParams;
pub use energy_map::EnergyMap;
pub use error::Error;
pub use film::Film;
pub use guide::{Guide, GuideTable};
pub use layers::{FARTHEST_DEPTH, LayerChannel, LayerImage, LayerValues};
pub use ray_query::{Ray, RayBatch, RayHit};
pub use renderer::{DEFAULT_MAP_BUDGET, Renderer, RendererOptions};
pub use self_test::LoopLimit;
pub use statistics::{Ledger, LightReport, MapSize, PilotReport, SceneReport, Statistics};
