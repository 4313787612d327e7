//! What camera paths see of the energy maps: where, how well, and by which light.

use diacaustic_scene::{LightGroups, RenderSettings};
use diacaustic_shaders::{CameraParams, PathParams, Sighting, TILE_SIZE};

use crate::{
    Error,
    camera_pass::{CameraPass, Outputs, Samples},
    features::Features,
    gpu::{Gpu, Purpose},
    irradiance_cache::IrradianceCache,
    layers::LayerSums,
    map_sums::EnergyMaps,
    random::combine,
};

pub(crate) const SIGHTINGS: Purpose =
    Purpose { what: "what the camera sees of the energy maps", remedy: "set guiding = false and map_size" };
/// Paths along each side of the picture, multiples of [`TILE_SIZE`]: at least, at most.
const SIDES: std::ops::RangeInclusive<u32> = 128..=512;
/// Pixels along each axis for each of them.
const PIXELS_PER_SIGHTING: u32 = 4;

/// What camera paths see of the energy maps.
#[derive(Debug, Default)]
pub(crate) struct Sightings {
    pub list: Vec<Sighting>,
    /// Pixels for each.
    pub pixels: f64,
}

/// Paths spread evenly over the picture that note what they see.
pub(crate) struct SightingPaths<'p> {
    pipeline: wgpu::ComputePipeline,
    scene_group: &'p wgpu::BindGroup,
    outputs_group: wgpu::BindGroup,
    sightings: wgpu::Buffer,
    camera: CameraParams,
    paths: PathParams,
    /// Pixels of the picture for each path.
    pixels: f64,
}

impl<'p> SightingPaths<'p> {
    /// Paths that see by the light in some maps and go on over so many diffuse surfaces; `stream` is that of their seeds.
    pub fn new(
        gpu: &Gpu,
        (pass, features): (&mut CameraPass, Features),
        samples: &Samples,
        scene_group: &'p wgpu::BindGroup,
        settings: &RenderSettings,
        (maps, max_bounces, stream): (&EnergyMaps, u32, u32),
    ) -> Result<Self, Error> {
        let [width, height] = [settings.width, settings.height].map(|pixels| {
            let side = pixels.div_ceil(PIXELS_PER_SIGHTING).next_multiple_of(TILE_SIZE);
            side.clamp(*SIDES.start(), *SIDES.end())
        });
        let count = u64::from(width * height);
        let film = samples.blank_film(gpu, count)?;
        let sightings = gpu.zeroed(SIGHTINGS, count * size_of::<Sighting>() as u64)?;
        let no_layers = LayerSums::new(gpu, &[], &LightGroups::default(), count)?;
        let no_cache = IrradianceCache::none(gpu)?;
        let outputs_group = pass.outputs_group(
            gpu,
            &Outputs { maps, film: &film, layers: &no_layers, sightings: &sightings, cache: &no_cache.buffer },
            &samples.no_halves(gpu)?,
        );
        Ok(Self {
            pipeline: pass.pipelines.get(gpu, features.with_sightings()),
            scene_group,
            outputs_group,
            sightings,
            camera: CameraParams { width, height, ..samples.camera },
            paths: PathParams { max_bounces, seed: combine(settings.seed, stream), ..samples.paths },
            pixels: f64::from(settings.width) * f64::from(settings.height) / count as f64,
        })
    }

    /// A further path at each place. Blocks.
    pub fn follow(&self, gpu: &Gpu, samples: &Samples) -> Result<Sightings, Error> {
        let CameraParams { width, height, .. } = self.camera;
        let size = [width, height].map(|side| side / TILE_SIZE);
        let params = samples.write_params(gpu, &self.camera, &self.paths);
        gpu.dispatch(&self.pipeline, &[self.scene_group, params, &self.outputs_group], size);
        Ok(Sightings { list: gpu.read(&self.sightings, 0..u64::from(width * height))?, pixels: self.pixels })
    }
}
