//! Renders glass meshes and their caustics with WGSL compute shaders, on the application's own `wgpu` device.
//!
//! Photons leave the lights and fill *energy maps* on the surfaces they reach through glass and mirrors; the camera pass reads
//! them beside direct light. The same scene, seed and adapter give the same bits.
//!
//! # A picture
//!
//! ```
//! use std::path::Path;
//! use diacaustic::{Renderer, RendererOptions, scene::parse_scene};
//!
//! let text = r#"
//!     camera = { position = [0, 1.5, 2.5], look_at = [0, 0.3, 0], vertical_fov = 40 }
//!     render = { width = 64, height = 64 }
//!     materials.glass = { type = "dielectric", ior = 1.5 }
//!     materials.plaster = { type = "diffuse", albedo = 0.8 }
//!     lights = [{ type = "sphere", center = [0.5, 2.5, 0.3], radius = 0.05, flux = 35 }]
//!     objects = [
//!         { sphere = { center = [0, 0.4, 0], radius = 0.3 }, material = "glass" },
//!         { name = "floor", rectangle = { center = [0, 0, 0], edge_u = [4, 0, 0], edge_v = [0, 0, -4] }, material = "plaster" },
//!     ]
//! "#;
//! let scene = parse_scene(text, Path::new("."), "ball.toml")?.scene;
//!
//! // An application has a device; this one opens one without a window.
//! let gpu = diacaustic_headless::open(&diacaustic_headless::OpenOptions::default())?;
//! let mut renderer = Renderer::new(&gpu.device, &gpu.queue, &RendererOptions::default())?;
//!
//! renderer.set_scene(&scene)?;
//! renderer.emit_photons(0..100_000)?;
//! renderer.add_samples(4)?;
//!
//! let film = renderer.film()?; // waits for the device
//! let brightest = film.radiance.iter().map(|pixel| pixel[1]).fold(0.0, f32::max);
//! println!("the brightest pixel has {brightest} W/(m² sr)");
//! let floor = renderer.energy_map(1)?.expect("a diffuse surface has a map");
//! let flux: f64 = (0..floor.sums.len()).map(|texel| floor.flux(texel).y).sum();
//! println!("the caustic brings {flux:.2} W of green light to the floor");
//! # assert!(brightest > 0.1 && flux > 0.1 && flux < 35.0);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # A program of its own
//!
//! An application that has no device yet, and no way to write pictures, takes three crates: `diacaustic`, `diacaustic-headless` for the device and
//! `diacaustic-output` for the file.
//!
//! ```toml
//! [dependencies]      # folders of the repository, wherever it lies
//! diacaustic = { path = "diacaustic/crates/render" }
//! diacaustic-headless = { path = "diacaustic/crates/headless" }
//! diacaustic-output = { path = "diacaustic/crates/output" }
//! ```
//!
//! This is all of it. It chooses photons and samples by itself and writes `ball.png`; run it with `cargo run --release`, for the scene is prepared on the host. `wgpu` and
//! `glam` are re-exported for those who bring their own device.
//!
//! ```no_run
//! use std::path::Path;
//!
//! use diacaustic::{Renderer, RendererOptions, Stage, scene::parse_scene};
//! use diacaustic_headless::{OpenOptions, open};
//! use diacaustic_output::{Display, Picture, Tone, write_png};
//!
//! const SCENE: &str = r#"
//!     camera = { position = [0, 1.5, 2.5], look_at = [0, 0.3, 0], vertical_fov = 40 }
//!     render = { width = 320, height = 240, target_error = 0.2 }
//!     output = { exposure = 1.5 } # stops
//!     materials.glass = { type = "dielectric", ior = 1.5 }
//!     materials.plaster = { type = "diffuse", albedo = 0.8 }
//!     lights = [{ type = "sphere", center = [0.5, 2.5, 0.3], radius = 0.05, flux = 35 }]
//!     objects = [
//!         { sphere = { center = [0, 0.4, 0], radius = 0.3 }, material = "glass" },
//!         { rectangle = { center = [0, 0, 0], edge_u = [4, 0, 0], edge_v = [0, 0, -4] }, material = "plaster" },
//!     ]
//! "#;
//!
//! fn main() -> Result<(), Box<dyn std::error::Error>> {
//!     let scene = parse_scene(SCENE, Path::new("."), "ball.toml")?.scene; // load_scene reads a file
//!     let gpu = open(&OpenOptions::default())?;
//!     let mut renderer = Renderer::new(&gpu.device, &gpu.queue, &RendererOptions::default())?;
//!     renderer.set_scene(&scene)?;
//!     while renderer.refine()?.stage != Stage::Done {} // each step ends with a better film
//!
//!     let film = renderer.film()?;
//!     let picture = Picture { width: film.width, height: film.height, pixels: &film.radiance };
//!     let display = Display { exposure: scene.output.exposure, tone: Tone::Filmic };
//!     write_png(Path::new("ball.png"), &picture, &display)?;
//!     Ok(())
//! }
//! ```
//!
//! # The calls, in their order
//!
//! 1. [`Renderer::new`] on a device that has [`Renderer::required_limits`]. Once for each device: it compiles kernels.
//! 2. [`Renderer::set_scene`] with a [`scene::Scene`], read by [`scene::load_scene`] or built in code. Again after every change of it.
//! 3. [`Renderer::emit_photons`] with a range of numbers that follows the one before: more photons make the caustics cleaner, not brighter.
//! 4. [`Renderer::add_samples`]: more samples make the rest of the picture cleaner. They read the maps of all photons so far, so let
//!    photons come first; [`Renderer::restart_samples`] starts the picture anew after more of them.
//!
//!    Or, in place of these two, [`Renderer::refine`] again and again: it chooses photons and samples until the picture is as exact as the scene's
//!    `target_error`, or takes the numbers that the scene states.
//! 5. [`Renderer::render_to_texture`] shows the picture on a texture of the application's at any time; [`Renderer::film`], [`Renderer::layers`],
//!    [`Renderer::energy_map`] and [`Renderer::statistics`] read it back.
//!
//! [`Renderer::save_state`] and [`Renderer::restore_state`] go on later, in another process too, to the same bits.
//!
//! The repository's examples show more: `render_to_png`, `build_scene_in_code` and `energy_map_readback` in this crate, and `shared_device`, a window
//! with sliders.
//!
//! # Blocking, threads, memory, errors
//!
//! * **Blocking.** Calls that submit work return at once and leave the device to it; those that wait for the device, or are busy on the
//!   host, say so. A renderer opens no device and starts no thread of its own; building a scene uses rayon's.
//!   [Below](#each-call) is what each does.
//! * **Threads.** A [`Renderer`] is `Send` and `Sync`: it may move to another thread, and several may read from it. What changes it takes `&mut self`.
//!   Its work goes to the queue that it was given, in order with the application's own.
//! * **GPU memory.** A scene takes what [`SceneReport::device_bytes`] says, and each call that reads back as much again for a moment as it reads.
//!   [`Renderer::dry_run`] finds it without a device, [`RendererOptions::memory`] limits it. Dropping the renderer, or setting another scene,
//!   frees it.
//! * **Errors.** Every call that can fail returns an [`Error`] whose message names what is wrong and what would be right, and leaves the renderer as it
//!   was. Nothing panics on what an application gives it, and nothing is printed. Errors that wgpu reports outside of the calls go to
//!   the application's own handler.
//!
//! # Each call
//!
//! *Waits* is until when a call does not return; work that was submitted before counts, for a queue has one order. *Takes* is memory on the device beyond
//! what the scene has. "All work" is everything that was submitted to the queue.
//!
//! | [`Renderer`]'s | needs | waits | takes |
//! |---|---|---|---|
//! | [`new`](Renderer::new) | – | while kernels compile and the self-test runs: up to seconds | some kB |
//! | [`set_scene`](Renderer::set_scene) | `&mut` | for the host's preparation, kernels and the pilot: up to seconds | [`SceneReport::device_bytes`] |
//! | [`dry_run`](Renderer::dry_run) | – | for the host's preparation | nothing |
//! | [`emit_photons`](Renderer::emit_photons) | `&mut` | not, but after each 256 of its dispatches (of 262,144 photons at most) | nothing |
//! | [`add_samples`](Renderer::add_samples) | `&mut` | not, but after each 256 samples, and while an irradiance cache fills that the scene asks for | some MB while it fills |
//! | [`refine`](Renderer::refine) | `&mut` | until its step is done: a second or two of a usual scene on two cores | some MB, for the call |
//! | [`finish_photons`](Renderer::finish_photons), [`restart`](Renderer::restart), [`restart_samples`](Renderer::restart_samples) | `&mut` | not | nothing |
//! | [`render_to_texture`](Renderer::render_to_texture) | `&mut` | not, but for a shader when a format is new | nothing |
//! | [`film`](Renderer::film) | `&` | for all work | 16 bytes a pixel, for the call |
//! | [`layers`](Renderer::layers) | `&` | for all work | a copy of the layers' sums, for the call |
//! | [`energy_map`](Renderer::energy_map) | `&` | for all work | 12 bytes a texel, for the call |
//! | [`statistics`](Renderer::statistics) | `&` | for all work | some kB, for the call |
//! | [`bake`](Renderer::bake) | `&mut` | until the lightmap is done: microseconds for each texel and sample on a software adapter | about 100 bytes a texel, of at most 524,288 at once, for the call |
//! | [`save_state`](Renderer::save_state) | `&` | for all work | a copy of the largest of the buffers that it saves, for the call |
//! | [`restore_state`](Renderer::restore_state) | `&mut` | for all work | a copy of what it restores, for the call |
//! | [`intersect`](Renderer::intersect) | `&` | for all work | 64 bytes a ray, for the call |
//! | [`upload_rays`](Renderer::upload_rays), [`trace_rays`](Renderer::trace_rays) | `&` | not | 48 bytes a ray, until the batch is dropped |
//! | [`wait`](Renderer::wait) | `&` | for all work | nothing |
//! | [`refinement`](Renderer::refinement), [`emission`](Renderer::emission), [`guide`](Renderer::guide), [`map_layout`](Renderer::map_layout), [`loop_limit`](Renderer::loop_limit) | `&` | not | nothing |
//!
//! Everything of [`scene`] and [`RenderState::read`] works on the host alone: reading a scene blocks for its files. No call is asynchronous: to keep a
//! window alive, call [`Renderer::refine`] between frames, or move the renderer to a thread of its own.

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
mod error_pass;
mod features;
mod film;
mod fingerprint;
mod gpu;
mod guide;
mod host_scene;
mod irradiance_cache;
mod layers;
mod lights;
mod map_placement;
mod map_plan;
mod map_records;
mod map_sums;
mod map_texels;
mod material_records;
mod paper;
mod photon_pass;
mod pilot;
mod probe_pass;
mod random;
mod ray_query;
mod refine;
mod render_state;
mod renderer;
mod scene_buffers;
mod self_test;
mod sightings;
mod spectra_records;
mod statistics;
mod tangent_records;
mod texture_records;
mod tile_choice;
mod variance;
mod vertex_color_records;

pub use aim::Emission;
pub use bake::{BakeOptions, Lightmap, SurfacePlace, base_reflectance};
pub use display_pass::RenderParams;
pub use energy_map::EnergyMap;
pub use error::Error;
pub use film::Film;
pub use guide::{Guide, GuideTable};
pub use layers::{FARTHEST_DEPTH, LayerChannel, LayerImage, LayerValues};
pub use ray_query::{Ray, RayBatch, RayHit};
pub use refine::{Refinement, Stage};
pub use render_state::RenderState;
pub use renderer::{DEFAULT_MAP_BUDGET, Renderer, RendererOptions};
pub use self_test::LoopLimit;
pub use statistics::{Ledger, LightReport, MapSize, PilotReport, SceneReport, Statistics};
