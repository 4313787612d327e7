//! The renderer: scene in, picture and energy maps out.

mod refining;
mod states;

use std::{ops::Range, time::Instant};

use diacaustic_scene::Scene;
use diacaustic_shaders::{QueryHit, Sighting};
use diacaustic_surface::MapLayout;
use glam::Vec3;

use crate::{
    BakeOptions, Emission, EnergyMap, Error, Film, Guide, LayerImage, LightReport, Lightmap, LoopLimit, PilotReport,
    RenderParams, SceneReport, Statistics,
    bake::{BakePass, BakeScene, bake},
    camera_pass::{CameraPass, Samples},
    display_pass::DisplayPass,
    error_pass::ErrorPass,
    features::Features,
    gpu::Gpu,
    host_scene::HostScene,
    irradiance_cache::IrradianceCache,
    lights::{Lights, emissive_materials, kinds_of_light},
    map_placement::{map_sizes, place_maps, texel_budget},
    map_sums::{EnergyMaps, ResolvePass, Resolving, SumsFormat},
    photon_pass::{Flights, PhotonPass, PhotonScene, Photons},
    probe_pass::ProbePass,
    ray_query::{QueryPass, Ray, RayBatch, RayHit},
    refine::Course,
    scene_buffers::{self, SceneBuffers},
    sightings::{SightingPaths, Sightings},
    spectra_records::greatest_weight,
    tile_choice::choose_tiles,
};

/// What is set once for a renderer.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct RendererOptions {
    /// Bytes that the sums of all energy maps whose size the scene leaves open may take; if none, what the scene says, else
    /// [`DEFAULT_MAP_BUDGET`].
    pub map_budget: Option<u64>,
    /// Bytes that buffers and textures of a scene may take together, without what copies take for a moment; what the device gives if none. Maps
    /// whose size the scene leaves open have sums of a quarter of it at most. While one scene replaces another, both are on the device.
    pub memory: Option<u64>,
}

/// Bytes that the sums of energy maps may take, if nobody says: 256 MiB.
pub const DEFAULT_MAP_BUDGET: u64 = 256 << 20;

/// The streams of the seeds of paths that see where the maps matter, and of those that fill the irradiance cache.
const SIGHTINGS_SEED_STREAM: u32 = 4;
const CACHE_SEED_STREAM: u32 = 7;

/// Dispatches that one call submits before it waits for them.
pub(crate) const MOST_IN_FLIGHT: u32 = 256;

/// Renders scenes on an application's device.
///
/// Work is submitted to the device's queue and goes on after a call returns, except where a method says that it blocks. A
/// renderer is `Send` and `Sync`; the methods that change it need it whole. After an error it is as it was before the call, except that work
/// which was submitted stays submitted.
#[derive(Debug)]
pub struct Renderer {
    gpu: Gpu,
    options: RendererOptions,
    loop_limit: LoopLimit,
    scene_layout: wgpu::BindGroupLayout,
    photon_pass: PhotonPass,
    resolve_pass: ResolvePass,
    camera_pass: CameraPass,
    probe_pass: ProbePass,
    error_pass: ErrorPass,
    bake_pass: BakePass,
    display_pass: DisplayPass,
    query_pass: QueryPass,
    scene: Option<OnDevice>,
    /// Whether the device runs nothing of what it is given.
    is_dry: bool,
}

/// A scene on the device, and how far it is rendered.
#[derive(Debug)]
struct OnDevice {
    scene: Scene,
    /// Object and triangle of each triangle on the device.
    origins: Vec<(u32, u32)>,
    features: Features,
    buffers: SceneBuffers,
    maps: EnergyMaps,
    cache: IrradianceCache,
    /// What camera paths saw of the maps before there were photons.
    sightings: Vec<Sighting>,
    photons: Photons,
    samples: Samples,
    course: Course,
    photon_count: u64,
    sample_count: u32,
    /// Samples over all pixels.
    sample_sum: u64,
    /// Whether photons came since the sums last became irradiance.
    unresolved: bool,
}

impl OnDevice {
    /// Turns the sums of the photons so far into irradiance, if that is not done.
    fn resolve(&mut self, gpu: &Gpu, pass: &ResolvePass) {
        if self.unresolved {
            self.run(gpu, pass);
            self.unresolved = false;
        }
    }

    /// Turns the sums of the photons so far into irradiance.
    fn run(&self, gpu: &Gpu, pass: &ResolvePass) {
        let settings = &self.scene.settings;
        let of = Resolving {
            scene: &self.buffers.bind_group,
            units_per_watt: self.photons.units_per_watt,
            // In the profile `paper` photons do not share the light's flux.
            photons: if settings.paper.is_some() { 1 } else { self.photon_count },
            footprints: settings.footprints,
        };
        pass.run(gpu, &self.maps, of);
    }

    /// Samples of a pixel, on average.
    fn mean_samples(&self) -> f64 {
        self.sample_sum as f64 / self.pixels() as f64
    }

    /// Pixels of the picture.
    fn pixels(&self) -> u64 {
        u64::from(self.scene.settings.width) * u64::from(self.scene.settings.height)
    }
}

impl Renderer {
    /// The limits that the application's device must have. More `max_storage_buffer_binding_size` and `max_buffer_size` allow
    /// larger scenes and maps.
    pub fn required_limits() -> wgpu::Limits {
        wgpu::Limits { max_storage_buffers_per_shader_stage: 8, ..wgpu::Limits::default() }
    }

    /// Compiles the kernels that every scene needs and tests how the adapter treats long loops. Blocks: up to seconds where the driver has not
    /// cached the kernels. Takes some kilobytes on the device.
    ///
    /// # Errors
    /// If the device's limits are too low, the adapter ends loops too early, or the device fails.
    pub fn new(device: &wgpu::Device, queue: &wgpu::Queue, options: &RendererOptions) -> Result<Self, Error> {
        let gpu = Gpu { device: device.clone(), queue: queue.clone(), limit: None };
        check_limits(&device.limits())?;
        gpu.guarded(|| Ok(Self::on(&gpu, options, LoopLimit::measure(&gpu)?)))
    }

    fn on(gpu: &Gpu, options: &RendererOptions, loop_limit: LoopLimit) -> Self {
        let scene_layout = gpu.layout("scene", wgpu::ShaderStages::COMPUTE, &scene_buffers::BINDINGS);
        Self {
            photon_pass: PhotonPass::new(gpu, &scene_layout),
            resolve_pass: ResolvePass::new(gpu, &scene_layout),
            camera_pass: CameraPass::new(gpu, &scene_layout),
            probe_pass: ProbePass::new(gpu, &scene_layout),
            error_pass: ErrorPass::new(gpu),
            bake_pass: BakePass::new(gpu, &scene_layout),
            display_pass: DisplayPass::new(gpu),
            query_pass: QueryPass::new(gpu, &scene_layout),
            gpu: gpu.clone(),
            options: options.clone(),
            loop_limit,
            scene_layout,
            scene: None,
            is_dry: false,
        }
    }

    /// What [`Renderer::set_scene`] would report, found without a device, on one whose buffers may be of 2 GiB. There is no pilot, whose findings
    /// choose the texels of maps whose size the scene leaves open: [`SceneReport::device_bytes`] counts all that they may take, and
    /// [`SceneReport::maps`] what they would have if the camera did not see them. Blocks while it builds the scene on the host.
    ///
    /// # Errors
    /// As [`Renderer::set_scene`].
    pub fn dry_run(scene: &Scene, options: &RendererOptions) -> Result<SceneReport, Error> {
        let largest = u64::from(u32::MAX / 2);
        let required_limits = wgpu::Limits {
            max_storage_buffer_binding_size: largest,
            max_buffer_size: largest,
            ..Self::required_limits()
        };
        let (device, queue) = wgpu::Device::noop(&wgpu::DeviceDescriptor { required_limits, ..Default::default() });
        let gpu = Gpu { device, queue, limit: None };
        Self { is_dry: true, ..Self::on(&gpu, options, LoopLimit::NONE) }.set_scene(scene)
    }

    /// Prepares a scene: builds its hierarchy and maps on the host, and uploads them. Photons and samples start from 0.
    ///
    /// Compiles the kernels for what the scene makes use of, if no scene before it did the same; finds by throw-away photons where others are to
    /// be sent, unless the scene says `guiding = false`. Blocks: seconds on a software adapter that has not cached the kernels. Takes
    /// [`SceneReport::device_bytes`] on the device; those of the scene set before are given back when this one is there.
    ///
    /// # Errors
    /// If the scene is not valid, or too large for the device; the scene set before then stays.
    pub fn set_scene(&mut self, scene: &Scene) -> Result<SceneReport, Error> {
        scene.validate()?;
        let most = scene_buffers::most_triangles(&self.gpu);
        let (host, compiled) = rayon::join(|| HostScene::build(scene, most), || self.compile(scene));
        let host = host?;
        compiled?;
        let report = SceneReport {
            triangles: host.triangles,
            bvh_nodes: host.bvh.nodes.len(),
            bvh_time: host.bvh_time,
            maps_time: host.maps_time,
            map_budget: self.map_budget(scene),
            lights: light_reports(scene, &host.lights),
            ..SceneReport::default()
        };
        let (on_device, report) = self.gpu.clone().guarded(|| self.upload(scene, host, report))?;
        self.scene = Some(on_device);
        Ok(report)
    }

    /// Compiles the kernels for what a scene makes use of.
    fn compile(&mut self, scene: &Scene) -> Result<(), Error> {
        let features = Features::of(scene);
        let of_photons: Vec<_> =
            kinds_of_light(scene).into_iter().map(|kind| features.for_photons_of(kind, &scene.settings)).collect();
        // Nearly every scene has sightings; what is missing is compiled when it is asked for.
        let of_paths = [features, features.with_sightings()];
        let Self { gpu, photon_pass, camera_pass, .. } = self;
        let (photons, paths) = rayon::join(
            || photon_pass.pipelines.prepare(gpu, &of_photons),
            || camera_pass.pipelines.prepare(gpu, &of_paths),
        );
        photons.and(paths)
    }

    /// Bytes that the sums of maps whose size the scene leaves open may take.
    fn map_budget(&self, scene: &Scene) -> u64 {
        let of_scene = scene.settings.map_budget.map(|mebibytes| u64::from(mebibytes) << 20);
        let quarter = self.options.memory.map_or(u64::MAX, |memory| memory / 4);
        self.options.map_budget.or(of_scene).unwrap_or(DEFAULT_MAP_BUDGET).min(quarter)
    }

    /// Sends a scene to the device, flies the pilots if photons are guided or a map's size is open, and then places the maps.
    fn upload(
        &mut self,
        scene: &Scene,
        host: HostScene,
        mut report: SceneReport,
    ) -> Result<(OnDevice, SceneReport), Error> {
        let gpu = &self.gpu.limited_to(self.options.memory);
        let mut buffers = SceneBuffers::new(gpu, &self.scene_layout, scene, &host)?;
        let photons_of = PhotonScene {
            settings: &scene.settings,
            lights: &host.lights,
            features: host.features,
            greatest_weight: greatest_weight(scene),
            casters: &host.casters,
            around: host.around,
        };
        let groups = host.lights.groups.names.len();
        let format = SumsFormat::new(scene, groups);
        let mut photons = Photons::new(gpu, &mut self.photon_pass, &photons_of, self.loop_limit)?;
        let mut samples = Samples::new(gpu, &mut self.camera_pass, scene, &host.lights, host.features)?;
        let (mut sightings, mut flights) = (Sightings::default(), Flights::default());
        let is_open = host.maps.iter().flatten().any(|plan| !plan.is_stated);
        let needs_sightings = scene.settings.guiding || is_open || scene.settings.photons.is_none();
        if !self.is_dry && photons.can_emit() && needs_sightings {
            let start = Instant::now();
            let group = &buffers.bind_group;
            let empty = EnergyMaps::new(gpu, &mut self.resolve_pass, Vec::new(), SumsFormat::NONE, host.features)?;
            let pass = (&mut self.camera_pass, host.features);
            let seen_by = (&empty, scene.settings.max_bounces.min(1), SIGHTINGS_SEED_STREAM);
            let paths = SightingPaths::new(gpu, pass, &samples, group, &scene.settings, seen_by)?;
            sightings = paths.follow(gpu, &samples)?;
            flights = photons.fly_pilots(gpu, &self.photon_pass, group, &empty, &host.maps, &sightings.list)?;
            report.pilot = Some(PilotReport { time: start.elapsed(), ..flights.report });
        }
        let cache = IrradianceCache::new(gpu, scene, &host.maps, host.features)?;
        let start = Instant::now();
        let budget = texel_budget(&host.maps, report.map_budget, &gpu.device.limits(), format);
        let choice = choose_tiles(&host.maps, &sightings.list, sightings.pixels, flights.landings(), budget);
        report.maps = map_sizes(&host.maps, &choice);
        // What open maps may take beyond this, where no pilot has said how much they do.
        let open =
            host.maps.iter().zip(&choice.tiles).filter(|(plan, _)| plan.as_ref().is_some_and(|plan| !plan.is_stated));
        let taken: u64 = open.filter_map(|(_, tiles)| tiles.as_ref()).map(|tiles| tiles.texel_count()).sum();
        let reserve = if self.is_dry && is_open { budget.saturating_sub(taken) * format.bytes_on_device() } else { 0 };
        let placements = place_maps(host.maps, choice, format, &gpu.device.limits())?;
        report.maps_time += start.elapsed();
        let maps = EnergyMaps::new(gpu, &mut self.resolve_pass, placements, format, host.features)?;
        buffers.place_maps(gpu, &self.scene_layout, &maps)?;
        photons.fill(gpu, &self.photon_pass, &maps, groups)?;
        samples.show(gpu, &self.camera_pass, &maps, &cache)?;
        report.map_bytes = maps.sums_bytes();
        report.device_bytes = buffers.bytes + maps.bytes + cache.buffer.size() + reserve + samples.bytes();
        report.photon_turns = photons.turns;
        let on_device = OnDevice {
            course: Course::new(&scene.settings, photons.supply()),
            photons,
            samples,
            scene: scene.clone(),
            origins: host.bvh.triangles.iter().map(|t| (t.object, t.triangle)).collect(),
            features: host.features,
            buffers,
            maps,
            cache,
            sightings: sightings.list,
            photon_count: 0,
            sample_count: 0,
            sample_sum: 0,
            unresolved: true,
        };
        Ok((on_device, report))
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

    /// Fills the irradiance cache by the light in the maps, if there are twice the photons by which that was done last. Blocks if it does.
    fn fill_cache(&mut self) -> Result<(), Error> {
        let on_device = self.scene.as_mut().ok_or(Error::NoScene)?;
        let OnDevice { scene, features, buffers, maps, cache, samples, course, photon_count, .. } = on_device;
        if !cache.has_grids() || course.cache_photons().is_some_and(|before| *photon_count < 2 * before.max(1)) {
            return Ok(());
        }
        let (gpu, pass) = (&self.gpu, (&mut self.camera_pass, *features));
        let seen_by = (&*maps, scene.settings.max_bounces, CACHE_SEED_STREAM);
        let error = gpu.guarded(|| {
            let paths = SightingPaths::new(gpu, pass, samples, &buffers.bind_group, &scene.settings, seen_by)?;
            cache.fill(gpu, || Ok(paths.follow(gpu, samples)?.list))
        })?;
        course.note_cache(*photon_count, error);
        Ok(())
    }

    /// Submits `count` further samples of every pixel, lit by the photons emitted so far. Blocks after each 256 of them until they are
    /// done, for submitted work takes memory; and before the first, where the scene asks for an irradiance cache, until that is filled.
    ///
    /// # Errors
    /// If no scene is set or the device fails.
    pub fn add_samples(&mut self, count: u32) -> Result<(), Error> {
        let on_device = self.scene.as_mut().ok_or(Error::NoScene)?;
        on_device.resolve(&self.gpu, &self.resolve_pass);
        if on_device.scene.settings.irradiance_cache == Some(true) {
            self.fill_cache()?;
        }
        self.take_samples(count)
    }

    /// Submits samples of every pixel by the maps and the cache as they are.
    fn take_samples(&mut self, count: u32) -> Result<(), Error> {
        let on_device = self.scene.as_mut().ok_or(Error::NoScene)?;
        for number in 1..=count {
            on_device.samples.add(&self.gpu, &on_device.buffers.bind_group);
            on_device.sample_count += 1;
            if number.is_multiple_of(MOST_IN_FLIGHT) {
                self.gpu.wait()?;
            }
        }
        on_device.sample_sum += u64::from(count) * on_device.pixels();
        Ok(())
    }

    /// Submits the drawing of the picture so far over the whole of a texture, which may be of any renderable colour format. Compiles a shader
    /// for each format that it meets first; does not wait for the device.
    ///
    /// # Errors
    /// If no scene is set.
    pub fn render_to_texture(&mut self, view: &wgpu::TextureView, params: &RenderParams) -> Result<(), Error> {
        let on_device = self.scene.as_ref().ok_or(Error::NoScene)?;
        let size = [on_device.scene.settings.width, on_device.scene.settings.height];
        self.display_pass.draw(&self.gpu, &on_device.samples.film, size, view, params);
        Ok(())
    }

    /// Reads the picture so far. Blocks until all submitted work is done. Takes 16 bytes a pixel on the device for a moment.
    ///
    /// # Errors
    /// If no scene is set, the device fails, or it cut invocations short.
    pub fn film(&self) -> Result<Film, Error> {
        let on_device = self.scene.as_ref().ok_or(Error::NoScene)?;
        on_device.samples.read(&self.gpu, on_device.sample_count)
    }

    /// Reads, through a copy on the device of each of their sums, the layers that the scene's `output.layers` asks for, in the order of [`Layer::ALL`](diacaustic_scene::Layer::ALL). Blocks until
    /// all submitted work is done.
    ///
    /// # Errors
    /// If no scene is set, the device fails, or it cut invocations short.
    pub fn layers(&self) -> Result<Vec<LayerImage>, Error> {
        let on_device = self.scene.as_ref().ok_or(Error::NoScene)?;
        on_device.samples.read_layers(&self.gpu, &on_device.scene)
    }

    /// Reads an object's energy map; none if the object is no receiver. Blocks until all submitted work is done. Takes as much as the map on
    /// the device for a moment.
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
        if on_device.unresolved && on_device.maps.is_filtered() {
            on_device.run(&self.gpu, &self.resolve_pass);
        }
        on_device.maps.read(&self.gpu, object, units, on_device.photon_count)
    }

    /// Makes an object's lightmap: what light meets its surface, by the photons emitted so far and by paths that begin at each texel. It is of
    /// all light groups together; none if the object is no receiver. No samples of the picture are needed.
    ///
    /// Compiles the kernel, if no scene before made use of the same. Blocks until the map is done: on a software adapter some microseconds for
    /// each texel and sample.
    ///
    /// # Errors
    /// If no scene is set, the scene has no such object, the device fails, or it cut invocations short.
    pub fn bake(&mut self, object: usize, options: &BakeOptions) -> Result<Option<Lightmap>, Error> {
        let Some(energy_map) = self.energy_map(object)? else { return Ok(None) };
        let on_device = self.scene.as_mut().ok_or(Error::NoScene)?;
        on_device.resolve(&self.gpu, &self.resolve_pass);
        let Some(placement) = &on_device.maps.placements[object] else { return Ok(None) };
        let of = BakeScene {
            scene: &on_device.scene,
            origins: &on_device.origins,
            features: on_device.features,
            maps: &on_device.maps,
            group: &on_device.buffers.bind_group,
            paths: on_device.samples.paths,
        };
        let (gpu, pass) = (&self.gpu, &mut self.bake_pass);
        gpu.guarded(|| bake(gpu, pass, &of, (object, &placement.layout), &energy_map, *options)).map(Some)
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
            mean_samples: on_device.mean_samples(),
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

    /// Uploads rays to be traced, once or often, by [`Renderer::trace_rays`]. Does not wait for the device. A batch takes 48 bytes a ray on it
    /// until it is dropped.
    ///
    /// # Errors
    /// If the rays do not fit into a buffer.
    pub fn upload_rays(&self, rays: &[Ray], any_hit: bool) -> Result<RayBatch, Error> {
        self.gpu.guarded(|| self.query_pass.upload(&self.gpu, rays, any_hit))
    }

    /// Submits the tracing of uploaded rays. Does not wait for the device.
    ///
    /// # Errors
    /// If no scene is set.
    pub fn trace_rays(&self, batch: &RayBatch) -> Result<(), Error> {
        let on_device = self.scene.as_ref().ok_or(Error::NoScene)?;
        self.query_pass.run(&self.gpu, &on_device.buffers.bind_group, batch);
        Ok(())
    }

    /// Forgets all photons and samples; the scene stays. Does not wait for the device.
    ///
    /// # Errors
    /// If no scene is set.
    pub fn restart(&mut self) -> Result<(), Error> {
        let on_device = self.scene.as_mut().ok_or(Error::NoScene)?;
        for (_, buffer) in on_device.accumulated() {
            self.gpu.clear(buffer);
        }
        on_device.cache.forget(&self.gpu);
        on_device.course = Course::new(&on_device.scene.settings, on_device.photons.supply());
        on_device.photon_count = 0;
        on_device.sample_count = 0;
        on_device.sample_sum = 0;
        on_device.unresolved = true;
        Ok(())
    }

    /// Forgets all samples; the scene and its photons stay. Does not wait for the device.
    ///
    /// # Errors
    /// If no scene is set.
    pub fn restart_samples(&mut self) -> Result<(), Error> {
        let on_device = self.scene.as_mut().ok_or(Error::NoScene)?;
        for (_, buffer) in on_device.samples.accumulated() {
            self.gpu.clear(buffer);
        }
        on_device.course.forget_samples();
        on_device.sample_count = 0;
        on_device.sample_sum = 0;
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
