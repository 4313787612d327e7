//! Phase 2: samples of the picture.

use diacaustic_scene::Scene;
use diacaustic_shaders::{CAMERA, CameraParams, PathParams, Sighting, TILE_SIZE};

use crate::{
    Error, Film, LayerImage,
    features::{Features, Pipelines},
    film::filter_inverse_cdf,
    fingerprint::Fingerprint,
    gpu::{Binding, Gpu, Purpose, wide},
    irradiance_cache::IrradianceCache,
    layers::{LayerSums, has_variance},
    lights::{Lights, media_keys, medium_index},
    map_sums::EnergyMaps,
    random::combine,
    sightings::SIGHTINGS,
    variance::SampleSums,
};

/// The bindings of `shaders/layout/path_pass.wgsl` and `camera_pass.wgsl`.
const PARAMS: [Binding; 3] = [Binding::Uniform, Binding::Uniform, Binding::Records];
pub(crate) const PATH_OUTPUTS: [Binding; 7] = [
    Binding::Texels,
    Binding::ReadWrite,
    Binding::ReadWrite,
    Binding::ReadWrite,
    Binding::ReadWrite,
    Binding::ReadWrite,
    Binding::Read,
];
const FILM: Purpose = Purpose { what: "the picture's pixels", remedy: "lower width or height" };
const HALVES: Purpose = Purpose {
    what: "the first samples of the picture's pixels",
    remedy: "lower width or height, or state samples and write no layer \"variance\"",
};
const TILES: Purpose = Purpose { what: "the list of tiles", remedy: "lower width or height" };
/// The stream of the camera pass's seeds.
const SEED_STREAM: u32 = 2;

/// The pipeline of the camera pass.
#[derive(Debug)]
pub(crate) struct CameraPass {
    params_layout: wgpu::BindGroupLayout,
    outputs_layout: wgpu::BindGroupLayout,
    pub pipelines: Pipelines,
}

impl CameraPass {
    pub fn new(gpu: &Gpu, scene_layout: &wgpu::BindGroupLayout) -> Self {
        let outputs: Vec<_> = PATH_OUTPUTS.into_iter().chain([Binding::ReadWrite]).collect();
        let params_layout = gpu.layout("camera params", wgpu::ShaderStages::COMPUTE, &PARAMS);
        let outputs_layout = gpu.layout("camera outputs", wgpu::ShaderStages::COMPUTE, &outputs);
        let pipelines = Pipelines::new(CAMERA, &[scene_layout, &params_layout, &outputs_layout]);
        Self { params_layout, outputs_layout, pipelines }
    }

    /// Binds what camera paths read and accumulate in.
    pub fn outputs_group(&self, gpu: &Gpu, outputs: &Outputs<'_>, halves: &wgpu::Buffer) -> wgpu::BindGroup {
        let mut resources = outputs.resources();
        resources.push(halves.as_entire_binding());
        gpu.bind_resources(&self.outputs_layout, resources)
    }
}

/// What paths read of the scene's light, and what they accumulate in.
pub(crate) struct Outputs<'o> {
    pub maps: &'o EnergyMaps,
    pub film: &'o wgpu::Buffer,
    pub layers: &'o LayerSums,
    pub sightings: &'o wgpu::Buffer,
    pub cache: &'o wgpu::Buffer,
}

impl<'o> Outputs<'o> {
    /// The resources of [`PATH_OUTPUTS`].
    pub fn resources(&self) -> Vec<wgpu::BindingResource<'o>> {
        let irradiance = wgpu::BindingResource::TextureView(&self.maps.irradiance);
        let LayerSums { light, data, groups, .. } = self.layers;
        let buffers = [self.film, self.sightings, light, data, groups, self.cache];
        [irradiance].into_iter().chain(buffers.map(|buffer| buffer.as_entire_binding())).collect()
    }
}

/// One scene's picture on the device.
#[derive(Debug)]
pub(crate) struct Samples {
    pipeline: wgpu::ComputePipeline,
    pub camera: CameraParams,
    /// The params of all paths.
    pub paths: PathParams,
    camera_params: wgpu::Buffer,
    path_params: wgpu::Buffer,
    /// Four words of counters, then the pixels.
    pub film: wgpu::Buffer,
    /// For each pixel the sum of its first samples; an entry without use where neither the error nor the variance is asked for.
    pub halves: wgpu::Buffer,
    layers: LayerSums,
    params_group: wgpu::BindGroup,
    /// None until there are maps.
    outputs_group: Option<wgpu::BindGroup>,
}

impl Samples {
    pub fn new(
        gpu: &Gpu,
        pass: &mut CameraPass,
        scene: &Scene,
        lights: &Lights,
        features: Features,
    ) -> Result<Self, Error> {
        let pixels = u64::from(scene.settings.width) * u64::from(scene.settings.height);
        let path_params = gpu.uniform::<PathParams>("camera paths");
        let camera_params = gpu.uniform::<CameraParams>("camera");
        let film = gpu.zeroed(FILM, 16 * (1 + pixels))?;
        let halves = gpu.zeroed(HALVES, if features.has_halves() { 16 * pixels } else { 0 })?;
        let layers = LayerSums::new(gpu, &scene.output.layers, &lights.groups, pixels)?;
        Ok(Self {
            pipeline: pass.pipelines.get(gpu, features),
            camera: camera_of(scene),
            paths: paths_of(scene, lights),
            params_group: params_group(gpu, pass, [&path_params, &camera_params], &[])?,
            outputs_group: None,
            path_params,
            camera_params,
            film,
            halves,
            layers,
        })
    }

    /// Lets samples read these maps and this cache from now on.
    pub fn show(
        &mut self,
        gpu: &Gpu,
        pass: &CameraPass,
        maps: &EnergyMaps,
        cache: &IrradianceCache,
    ) -> Result<(), Error> {
        let sightings = &gpu.zeroed(SIGHTINGS, size_of::<Sighting>() as u64)?;
        let outputs = Outputs { maps, film: &self.film, layers: &self.layers, sightings, cache: &cache.buffer };
        self.outputs_group = Some(pass.outputs_group(gpu, &outputs, &self.halves));
        Ok(())
    }

    /// A film for so many paths.
    pub fn blank_film(&self, gpu: &Gpu, paths: u64) -> Result<wgpu::Buffer, Error> {
        gpu.zeroed(FILM, 16 * (1 + paths))
    }

    /// In place of halves that are not kept.
    pub fn no_halves(&self, gpu: &Gpu) -> Result<wgpu::Buffer, Error> {
        gpu.zeroed(HALVES, 0)
    }

    /// What samples accumulate in, by name.
    pub fn accumulated(&self) -> [(&'static str, &wgpu::Buffer); 5] {
        let LayerSums { light, data, groups, .. } = &self.layers;
        [
            ("film", &self.film),
            ("first samples", &self.halves),
            ("layers of light", light),
            ("layers of data", data),
            ("layers of groups", groups),
        ]
    }

    /// Adds what samples depend on beside the scene: the view and how it is sampled.
    pub fn add_to(&self, fingerprint: &mut Fingerprint) {
        fingerprint.digest("the camera", &[self.camera]);
        fingerprint.digest("the camera's settings", &[self.paths]);
    }

    /// Bytes on the device.
    pub fn bytes(&self) -> u64 {
        self.accumulated().iter().map(|(_, buffer)| buffer.size()).sum()
    }

    /// Submits a further sample of every pixel.
    pub fn add(&self, gpu: &Gpu, scene_group: &wgpu::BindGroup) {
        let Some(outputs) = &self.outputs_group else { return };
        self.write_params(gpu, &self.camera, &self.paths);
        let groups = [scene_group, &self.params_group, outputs];
        gpu.dispatch(&self.pipeline, &groups, self.size().map(|pixels| pixels.div_ceil(TILE_SIZE)));
    }

    /// Submits `count` further samples of every pixel of some tiles, which are numbered row by row from the top left. Returns the pixels.
    pub fn add_to_tiles(
        &self,
        gpu: &Gpu,
        pass: &CameraPass,
        scene_group: &wgpu::BindGroup,
        tiles: &[u32],
        count: u32,
    ) -> Result<u64, Error> {
        let Some(outputs) = &self.outputs_group else { return Ok(0) };
        let [width, height] = self.size();
        let columns = width.div_ceil(TILE_SIZE);
        let places: Vec<u32> = tiles.iter().map(|tile| (tile % columns) | ((tile / columns) << 16)).collect();
        let within = |size: u32, place: u32| u64::from((size - TILE_SIZE * place).min(TILE_SIZE));
        let pixels = tiles.iter().map(|tile| within(width, tile % columns) * within(height, tile / columns)).sum();
        let camera = CameraParams { tile_count: tiles.len() as u32, ..self.camera };
        let params_group = params_group(gpu, pass, [&self.path_params, &self.camera_params], &places)?;
        self.write_params(gpu, &camera, &self.paths);
        // As wide as the kernel takes a row of the list to be.
        let size = [columns, camera.tile_count.div_ceil(columns)];
        for _ in 0..count {
            gpu.dispatch(&self.pipeline, &[scene_group, &params_group, outputs], size);
        }
        Ok(pixels)
    }

    /// Width and height of the picture, pixels.
    pub fn size(&self) -> [u32; 2] {
        [self.camera.width, self.camera.height]
    }

    /// Sets the params of the dispatches that follow, and returns their bind group.
    pub fn write_params(&self, gpu: &Gpu, camera: &CameraParams, paths: &PathParams) -> &wgpu::BindGroup {
        gpu.queue.write_buffer(&self.camera_params, 0, bytemuck::bytes_of(camera));
        gpu.queue.write_buffer(&self.path_params, 0, bytemuck::bytes_of(paths));
        &self.params_group
    }

    /// Reads the picture. Blocks.
    pub fn read(&self, gpu: &Gpu, samples: u32) -> Result<Film, Error> {
        let sums = self.sums(gpu)?;
        let (width, height) = (self.camera.width, self.camera.height);
        let mean = |[r, g, b, count]: [f32; 4]| [r, g, b].map(|sum| sum / count.max(1.0));
        Ok(Film { width, height, samples, radiance: sums.into_iter().map(mean).collect() })
    }

    /// Reads the layers of the scene's picture. Blocks.
    pub fn read_layers(&self, gpu: &Gpu, scene: &Scene) -> Result<Vec<LayerImage>, Error> {
        let sums = self.sums(gpu)?;
        let halves =
            if has_variance(&scene.output.layers) { gpu.read(&self.halves, 0..sums.len() as u64)? } else { Vec::new() };
        self.layers.read(gpu, scene, &SampleSums { width: self.camera.width as usize, all: sums, halves })
    }

    /// For each pixel the sum of its samples and their number. Blocks.
    fn sums(&self, gpu: &Gpu) -> Result<Vec<[f32; 4]>, Error> {
        self.rays(gpu)?;
        gpu.read(&self.film, 1..1 + u64::from(self.camera.width) * u64::from(self.camera.height))
    }

    /// Reads the number of rays traced. Blocks.
    pub fn rays(&self, gpu: &Gpu) -> Result<u64, Error> {
        ray_count(gpu, &self.film)
    }
}

/// Reads the number of rays traced for a film. Blocks.
fn ray_count(gpu: &Gpu, film: &wgpu::Buffer) -> Result<u64, Error> {
    let words: Vec<u32> = gpu.read(film, 0..4)?;
    if words[2] > 0 {
        return Err(Error::CutShort { invocations: words[2] });
    }
    Ok(wide([words[0], words[1]]))
}

/// The bind group of params and a list of tiles, column and row in 16 bits each.
fn params_group(
    gpu: &Gpu,
    pass: &CameraPass,
    params: [&wgpu::Buffer; 2],
    tiles: &[u32],
) -> Result<wgpu::BindGroup, Error> {
    let mut texels: Vec<[u32; 4]> =
        tiles.chunks(4).map(|four| std::array::from_fn(|k| *four.get(k).unwrap_or(&0))).collect();
    texels.resize(texels.len().max(1), [0; 4]);
    let texture = gpu.records(TILES, &texels)?;
    let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
    let mut resources: Vec<_> = params.map(|buffer| buffer.as_entire_binding()).into();
    resources.push(wgpu::BindingResource::TextureView(&view));
    Ok(gpu.bind_resources(&pass.params_layout, resources))
}

fn paths_of(scene: &Scene, lights: &Lights) -> PathParams {
    let camera = &scene.camera;
    let settings = &scene.settings;
    let [_, _, forward] = camera.axes();
    let media = media_keys(scene, camera.position);
    let index = medium_index(scene, media[0]);
    PathParams {
        position: camera.position.into(),
        sample_index: 0,
        forward: forward.into(),
        seed: combine(settings.seed, SEED_STREAM),
        background: scene.background.into(),
        max_depth: settings.max_depth,
        ambient: scene.ambient.into(),
        light_count: lights.records.len() as u32,
        media,
        sphere_count: lights.sphere_count as u32,
        first_sky_light: lights.first_sky as u32,
        max_bounces: settings.max_bounces,
        // Radiance follows the index, but not in the profile `paper`.
        exposure: if settings.paper.is_some() { 1.0 } else { 1.0 / (index * index) },
    }
}

fn camera_of(scene: &Scene) -> CameraParams {
    let camera = &scene.camera;
    let settings = &scene.settings;
    let [right, up, _] = camera.axes();
    let half_height = (0.5 * camera.vertical_fov.to_radians()).tan();
    let half_width = half_height * settings.width as f32 / settings.height as f32;
    CameraParams {
        half_right: (half_width * right).into(),
        aperture_radius: camera.aperture_radius,
        half_up: (half_height * up).into(),
        focus_distance: camera.focus_distance,
        lens_right: right.into(),
        width: settings.width,
        lens_up: up.into(),
        height: settings.height,
        tile_count: 0,
        padding_0: 0,
        padding_1: 0,
        padding_2: 0,
        filter_inverse_cdf: filter_inverse_cdf(settings.filter),
    }
}
