//! What camera paths would see of the energy maps by now, without following them again.

use diacaustic_shaders::{PROBE, ProbeParams, Sighting, WORKGROUP_SIZE};
use glam::Vec3;

use crate::{
    Error,
    gpu::{Binding, Gpu, Purpose},
    map_sums::EnergyMaps,
    sightings::SIGHTINGS,
};

/// The bindings of `shaders/layout/probe_pass.wgsl`.
const BINDINGS: [Binding; 4] = [Binding::Uniform, Binding::Texels, Binding::Read, Binding::ReadWrite];
const FOUND: Purpose =
    Purpose { what: "what the maps hold where the camera sees them", remedy: "lower width or height" };

/// The pipeline that looks at maps.
#[derive(Debug)]
pub(crate) struct ProbePass {
    layout: wgpu::BindGroupLayout,
    pipeline: wgpu::ComputePipeline,
    params: wgpu::Buffer,
}

impl ProbePass {
    pub fn new(gpu: &Gpu, scene_layout: &wgpu::BindGroupLayout) -> Self {
        let layout = gpu.layout("probe", wgpu::ShaderStages::COMPUTE, &BINDINGS);
        let pipeline = gpu.compute_pipeline(PROBE, &[scene_layout, &layout]);
        Self { layout, pipeline, params: gpu.uniform::<ProbeParams>("probe") }
    }

    /// The radiance in the picture, W/(m² sr), that the maps bring to each of some paths. Blocks.
    pub fn run(
        &self,
        gpu: &Gpu,
        scene_group: &wgpu::BindGroup,
        maps: &EnergyMaps,
        sightings: &[Sighting],
    ) -> Result<Vec<Vec3>, Error> {
        let count = sightings.len() as u32;
        if count == 0 {
            return Ok(Vec::new());
        }
        let places = gpu.filled(SIGHTINGS, sightings)?;
        let found = gpu.zeroed(FOUND, 16 * u64::from(count))?;
        let params = ProbeParams { count, entries: maps.irradiance_entries() as u32, ..Default::default() };
        gpu.queue.write_buffer(&self.params, 0, bytemuck::bytes_of(&params));
        let mut resources = vec![
            self.params.as_entire_binding(),
            wgpu::BindingResource::TextureView(&maps.irradiance),
            places.as_entire_binding(),
        ];
        resources.push(found.as_entire_binding());
        let group = gpu.bind_resources(&self.layout, resources);
        gpu.dispatch(&self.pipeline, &[scene_group, &group], [count.div_ceil(WORKGROUP_SIZE), 1]);
        let irradiance: Vec<[f32; 4]> = gpu.read(&found, 0..u64::from(count))?;
        let radiance = |([r, g, b, _], sighting): ([f32; 4], &Sighting)| sighting.weight * Vec3::new(r, g, b);
        Ok(irradiance.into_iter().zip(sightings).map(radiance).collect())
    }
}
