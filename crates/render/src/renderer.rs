//! The renderer: scene in, picture and energy maps out.

use std::{ops::Range, time::Instant};

use diacaustic_scene::Scene;
use diacaustic_shaders::QueryHit;
use diacaustic_surface::MapLayout;
use glam::Vec3;

use crate::{
    Emission, EnergyMap, Error, Film, Guide, LayerImage, LightReport, LoopLimit, MapSize, PilotReport, RenderParams,
    SceneReport, Statistics,
    camera_pass::{CameraPass, Samples},
    display_pass::DisplayPass,
    energy_map::{EnergyMaps, ResolvePass},
    gpu::Gpu,
    host_scene::HostScene,
    lights::{Lights, emissive_materials},
    photon_pass::{PhotonPass, PhotonScene, Photons},
    ray_query::{QueryPass, Ray, RayBatch, RayHit},
    scene_buffers::{self, SceneBuffers},
    spectra_records::greatest_weight,
};

/// What is set once for a renderer.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct RendererOptions {
    /// Bytes that the sums of all energy maps whose size the scene leaves open may take; what the device can bind if none.
    pub map_budget: Option<u64>,
}

/// Dispatches that one call submits before it waits for them.
pub(crate) const MOST_IN_FLIGHT: u32 = 256;

/// Renders scenes on an application's device.
///
/// Work is submitted to the device's queue and goes on after a call returns, except where a method says that it blocks. A
/// renderer may move between threads; its methods that change it need it whole.
#[derive(Debug)]
pub struct Renderer {
    gpu: Gpu,
    options: RendererOptions,
    loop_limit: LoopLimit,
    scene_layout: wgpu::BindGroupLayout,
    photon_pass: PhotonPass,
    resolve_pass: ResolvePass,
    camera_pass: CameraPass,
    display_pass: DisplayPass,
    query_pass: QueryPass,
    scene: Option<OnDevice>,
}

/// A scene on the device, and how far it is rendered.
#[derive(Debug)]
struct OnDevice {
    scene: Scene,
    /// Object and triangle of each triangle on the device.
    origins: Vec<(u32, u32)>,
    buffers: SceneBuffers,
    maps: EnergyMaps,
    photons: Photons,
    samples: Samples,
    photon_count: u64,
    sample_count: u32,
    /// Whether photons came since the sums last became irradiance.
    unresolved: bool,
}

impl Renderer {
    /// The limits that the application's device must have. More `max_storage_buffer_binding_size` and `max_buffer_size` allow
    /// larger scenes and maps.
    pub fn required_limits() -> wgpu::Limits {
        wgpu::Limits { max_storage_buffers_per_shader_stage: 8, ..wgpu::Limits::default() }
    }

    /// Compiles the kernels that every scene needs and tests how the adapter treats long loops. Blocks.
    ///
    /// # Errors
    /// If the device's limits are too low, the adapter ends loops too early, or the device fails.
    pub fn new(device: &wgpu::Device, queue: &wgpu::Queue, options: &RendererOptions) -> Result<Self, Error> {
        let gpu = Gpu { device: device.clone(), queue: queue.clone() };
        check_limits(&device.limits())?;
        gpu.guarded(|| {
            let loop_limit = LoopLimit::measure(&gpu)?;
            let scene_layout = gpu.layout("scene", wgpu::ShaderStages::COMPUTE, &scene_buffers::BINDINGS);
            Ok(Self {
                photon_pass: PhotonPass::new(&gpu, &scene_layout),
                resolve_pass: ResolvePass::new(&gpu),
                camera_pass: CameraPass::new(&gpu, &scene_layout),
                display_pass: DisplayPass::new(&gpu),
                query_pass: QueryPass::new(&gpu, &scene_layout),
                gpu: gpu.clone(),
                options: options.clone(),
                loop_limit,
                scene_layout,
                scene: None,
            })
        })
    }

    /// Prepares a scene: builds its hierarchy and maps on the host, and uploads them. Photons and samples start from 0.
    ///
    /// Compiles the kernels for what the scene makes use of, if no scene before it did the same; finds by throw-away photons where others are to
    /// be sent, unless the scene says `guiding = false`. Blocks: seconds on a software adapter that has not cached the kernels.
    ///
    /// # Errors
    /// If the scene is not valid, or too large for the device; the scene set before then stays.
    pub fn set_scene(&mut self, scene: &Scene) -> Result<SceneReport, Error> {
        scene.validate()?;
        let limits = self.gpu.device.limits();
        let bindable = limits.max_storage_buffer_binding_size.min(limits.max_buffer_size);
        let host = HostScene::build(scene, self.options.map_budget.unwrap_or(u64::MAX).min(bindable))?;
        let (triangles, bvh_nodes) = (host.triangles, host.bvh.nodes.len());
        let (bvh_time, maps_time) = (host.bvh_time, host.maps_time);
        let lights = light_reports(scene, &host.lights);
        let (on_device, pilot) = self.gpu.clone().guarded(|| self.upload(scene, host))?;
        let report = SceneReport {
            triangles,
            bvh_nodes,
            bvh_time,
            maps_time,
            pilot,
            device_bytes: on_device.buffers.bytes + on_device.maps.bytes + on_device.samples.bytes(),
            maps: map_sizes(&on_device.maps),
            photon_turns: on_device.photons.turns,
            lights,
        };
        self.scene = Some(on_device);
        Ok(report)
    }

    /// Sends a scene to the device, and flies the pilots if photons are guided.
    fn upload(&mut self, scene: &Scene, host: HostScene) -> Result<(OnDevice, Option<PilotReport>), Error> {
        let gpu = &self.gpu;
        let buffers = SceneBuffers::new(gpu, &self.scene_layout, scene, &host)?;
        let photons_of = PhotonScene {
            settings: &scene.settings,
            lights: &host.lights,
            features: host.features,
            greatest_weight: greatest_weight(scene),
            casters: &host.casters,
            around: host.around,
        };
        let maps = EnergyMaps::new(gpu, &self.resolve_pass, host.placements, host.lights.groups.names.len())?;
        let mut photons = Photons::new(gpu, &mut self.photon_pass, &photons_of, &maps, self.loop_limit)?;
        let samples = Samples::new(gpu, &mut self.camera_pass, scene, &host.lights, host.features, &maps)?;
        let mut pilot = None;
        if scene.settings.guiding && photons.can_emit() {
            let start = Instant::now();
            let group = &buffers.bind_group;
            let sightings =
                samples.sightings(gpu, &mut self.camera_pass, host.features, group, &scene.settings, &maps)?;
            let report = photons.learn(gpu, &self.photon_pass, group, &maps, &sightings)?;
            pilot = Some(PilotReport { time: start.elapsed(), ..report });
        }
        let on_device = OnDevice {
            photons,
            samples,
            scene: scene.clone(),
            origins: host.bvh.triangles.iter().map(|t| (t.object, t.triangle)).collect(),
            buffers,
            maps,
            photon_count: 0,
            sample_count: 0,
            unresolved: true,
        };
        Ok((on_device, pilot))
    }

    /// Submits photons of the given numbers; the same number is the same photon in every run. A scene whose lights cannot
    /// reach a caster has none, and the call does nothing.
    ///
    /// The maps' irradiance is right for numbers 0 to N, in any order and any pieces, each once. Blocks after each 256 blocks of at most
    /// 262,144 photons until they are done, for submitted work takes memory.
    ///
    /// # Errors
    /// If no scene is set, a number is beyond the sequences or the device fails.
    pub fn emit_photons(&mut self, numbers: Range<u64>) -> Result<(), Error> {
        let on_device = self.scene.as_mut().ok_or(Error::NoScene)?;
        if numbers.is_empty() || !on_device.photons.can_emit() {
            return Ok(());
        }
        let count = numbers.end - numbers.start;
        on_device.photons.emit(&self.gpu, &on_device.buffers.bind_group, numbers)?;
        on_device.photon_count += count;
        on_device.unresolved = true;
        Ok(())
    }

    /// Submits `count` further samples of every pixel, lit by the photons emitted so far. Blocks after each 256 of them until they are
    /// done, for submitted work takes memory.
    ///
    /// # Errors
    /// If no scene is set or the device fails.
    pub fn add_samples(&mut self, count: u32) -> Result<(), Error> {
        let on_device = self.scene.as_mut().ok_or(Error::NoScene)?;
        if on_device.unresolved {
            let units = on_device.photons.units_per_watt;
            // In the profile `paper` photons do not share the light's flux.
            let sharing = if on_device.scene.settings.paper.is_some() { 1 } else { on_device.photon_count };
            self.resolve_pass.run(&self.gpu, &on_device.maps, units, sharing);
            on_device.unresolved = false;
        }
        for number in 1..=count {
            let group = &on_device.buffers.bind_group;
            on_device.samples.add(&self.gpu, group, on_device.sample_count);
            on_device.sample_count += 1;
            if number.is_multiple_of(MOST_IN_FLIGHT) {
                self.gpu.wait()?;
            }
        }
        Ok(())
    }

    /// Submits the drawing of the picture so far over the whole of a texture, which may be of any renderable colour format.
    ///
    /// # Errors
    /// If no scene is set.
    pub fn render_to_texture(&mut self, view: &wgpu::TextureView, params: &RenderParams) -> Result<(), Error> {
        let on_device = self.scene.as_ref().ok_or(Error::NoScene)?;
        let size = [on_device.scene.settings.width, on_device.scene.settings.height];
        self.display_pass.draw(&self.gpu, &on_device.samples.film, size, view, params);
        Ok(())
    }

    /// Reads the picture so far. Blocks until all submitted work is done.
    ///
    /// # Errors
    /// If no scene is set, the device fails, or it cut invocations short.
    pub fn film(&self) -> Result<Film, Error> {
        let on_device = self.scene.as_ref().ok_or(Error::NoScene)?;
        on_device.samples.read(&self.gpu, on_device.sample_count)
    }

    /// Reads the layers that the scene's `output.layers` asks for, in the order of [`Layer::ALL`](diacaustic_scene::Layer::ALL). Blocks until
    /// all submitted work is done.
    ///
    /// # Errors
    /// If no scene is set, the device fails, or it cut invocations short.
    pub fn layers(&self) -> Result<Vec<LayerImage>, Error> {
        let on_device = self.scene.as_ref().ok_or(Error::NoScene)?;
        on_device.samples.read_layers(&self.gpu, &on_device.scene)
    }

    /// Reads an object's energy map; none if the object is no receiver. Blocks until all submitted work is done.
    ///
    /// # Errors
    /// If no scene is set, the scene has no such object, or the device fails.
    pub fn energy_map(&self, object: usize) -> Result<Option<EnergyMap>, Error> {
        let on_device = self.scene.as_ref().ok_or(Error::NoScene)?;
        let count = on_device.scene.objects.len();
        if object >= count {
            return Err(Error::NoSuchObject { index: object, count });
        }
        let units = on_device.photons.units_per_watt;
        on_device.maps.read(&self.gpu, object, units, on_device.photon_count)
    }

    /// Reads what the device has counted. Blocks until all submitted work is done.
    ///
    /// # Errors
    /// If no scene is set, the device fails, or it cut invocations short.
    pub fn statistics(&self) -> Result<Statistics, Error> {
        let on_device = self.scene.as_ref().ok_or(Error::NoScene)?;
        let counts = on_device.photons.counts(&self.gpu)?;
        Ok(Statistics {
            photons: on_device.photon_count,
            deposits: counts.deposits,
            photon_rays: counts.rays,
            samples: on_device.sample_count,
            camera_rays: on_device.samples.rays(&self.gpu)?,
            ledgers: counts.ledgers,
        })
    }

    /// The nearest triangle along each ray, or with `any_hit` any; none where there is none. Blocks.
    ///
    /// # Errors
    /// If no scene is set, the rays do not fit into a buffer (65,535 × 64 at most), or the device fails.
    pub fn intersect(&self, rays: &[Ray], any_hit: bool) -> Result<Vec<Option<RayHit>>, Error> {
        let batch = self.upload_rays(rays, any_hit)?;
        self.trace_rays(&batch)?;
        let origins = &self.scene.as_ref().ok_or(Error::NoScene)?.origins;
        let hit = |found: QueryHit| {
            let (object, triangle) = *origins.get(found.triangle as usize)?;
            Some(RayHit { object: object as usize, triangle: triangle as usize, t: found.t })
        };
        Ok(batch.read(&self.gpu)?.into_iter().map(hit).collect())
    }

    /// Uploads rays to be traced, once or often, by [`Renderer::trace_rays`].
    ///
    /// # Errors
    /// If the rays do not fit into a buffer.
    pub fn upload_rays(&self, rays: &[Ray], any_hit: bool) -> Result<RayBatch, Error> {
        self.gpu.guarded(|| self.query_pass.upload(&self.gpu, rays, any_hit))
    }

    /// Submits the tracing of uploaded rays.
    ///
    /// # Errors
    /// If no scene is set.
    pub fn trace_rays(&self, batch: &RayBatch) -> Result<(), Error> {
        let on_device = self.scene.as_ref().ok_or(Error::NoScene)?;
        self.query_pass.run(&self.gpu, &on_device.buffers.bind_group, batch);
        Ok(())
    }

    /// Forgets all photons and samples; the scene stays.
    ///
    /// # Errors
    /// If no scene is set.
    pub fn restart(&mut self) -> Result<(), Error> {
        let on_device = self.scene.as_mut().ok_or(Error::NoScene)?;
        for buffer in [&on_device.maps.sums, &on_device.photons.ledger].into_iter().chain(on_device.samples.buffers()) {
            self.gpu.clear(buffer);
        }
        on_device.photon_count = 0;
        on_device.sample_count = 0;
        on_device.unresolved = true;
        Ok(())
    }

    /// Blocks until all submitted work is done.
    ///
    /// # Errors
    /// If the device fails.
    pub fn wait(&self) -> Result<(), Error> {
        self.gpu.wait()
    }

    /// How long loops may be on this device, as found by the self-test.
    pub fn loop_limit(&self) -> LoopLimit {
        self.loop_limit
    }

    /// How a light emits its photons, by its place in [`SceneReport::lights`]; none if it is dark, there is no caster, or no such light.
    ///
    /// # Errors
    /// If no scene is set.
    pub fn emission(&self, light: usize) -> Result<Option<&Emission>, Error> {
        Ok(self.scene.as_ref().ok_or(Error::NoScene)?.photons.emission(light))
    }

    /// How a light's emission numbers are moved to where photons matter, by its place in [`SceneReport::lights`]; none if it emits no photons,
    /// the scene says `guiding = false`, or there is no such light.
    ///
    /// # Errors
    /// If no scene is set.
    pub fn guide(&self, light: usize) -> Result<Option<&Guide>, Error> {
        Ok(self.scene.as_ref().ok_or(Error::NoScene)?.photons.guide(light))
    }

    /// The layout of an object's energy map; none if it has none, or there is no such object.
    ///
    /// # Errors
    /// If no scene is set.
    pub fn map_layout(&self, object: usize) -> Result<Option<&MapLayout>, Error> {
        let maps = &self.scene.as_ref().ok_or(Error::NoScene)?.maps;
        Ok(maps.placements.get(object).and_then(Option::as_ref).map(|map| &map.layout))
    }
}

/// What is known of every light of the scene, dark ones too, and of every emissive material.
fn light_reports(scene: &Scene, lights: &Lights) -> Vec<LightReport> {
    let names = scene.lights.iter().map(|light| light.name.clone());
    let names = names.chain(emissive_materials(scene).into_iter().map(|(_, name)| name));
    let flux = |number: usize| lights.emitters.iter().find(|e| e.number == number).map_or(Vec3::ZERO, |e| e.flux);
    names.enumerate().map(|(number, name)| LightReport { name, flux: flux(number).to_array() }).collect()
}

fn map_sizes(maps: &EnergyMaps) -> Vec<MapSize> {
    let placed = maps.placements.iter().enumerate();
    placed
        .filter_map(|(object, map)| {
            let layout = &map.as_ref()?.layout;
            Some(MapSize { object, width: layout.width, height: layout.height, layers: layout.layers })
        })
        .collect()
}

fn check_limits(found: &wgpu::Limits) -> Result<(), Error> {
    let needed = Renderer::required_limits();
    let checks = [
        (
            "max_storage_buffers_per_shader_stage",
            found.max_storage_buffers_per_shader_stage.into(),
            needed.max_storage_buffers_per_shader_stage.into(),
        ),
        (
            "max_compute_invocations_per_workgroup",
            found.max_compute_invocations_per_workgroup.into(),
            u64::from(diacaustic_shaders::WORKGROUP_SIZE),
        ),
        (
            "max_storage_buffer_binding_size",
            found.max_storage_buffer_binding_size,
            needed.max_storage_buffer_binding_size,
        ),
    ];
    for (limit, found, needed) in checks {
        if found < needed {
            return Err(Error::DeviceTooSmall { limit, found, needed });
        }
    }
    Ok(())
}
