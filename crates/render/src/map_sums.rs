//! Energy maps on the device: the sums that photons fill, and the irradiance that follows from them.

use diacaustic_shaders::{RECORDS_WIDTH_BITS, RESOLVE, ResolveParams, WORKGROUP_SIZE};

use crate::{
    EnergyMap, Error,
    gpu::{Binding, Gpu, Purpose, texture_bytes},
    map_placement::MapPlacement,
};

/// Bytes of a texel's three 64-bit sums.
pub(crate) const TEXEL_BYTES: u64 = 24;
/// Bytes of a texel in each of the two buffers: of low and of high words.
const WORDS_BYTES: u64 = 12;
/// Texels in whose multiples the maps of light groups begin: where a device can bind a part of a buffer.
const GROUP_ALIGNMENT: u64 = 64;

const SUMS: Purpose = Purpose { what: "half the sums of the energy maps", remedy: "lower map_size" };
const GROUP_SUMS: Purpose = Purpose {
    what: "half the sums of the energy maps of all light groups",
    remedy: "lower map_size, or keep fewer light groups apart",
};
const AREAS: Purpose = Purpose { what: "the texels' areas", remedy: "lower map_size" };
const IRRADIANCE: Purpose = Purpose { what: "the texels' irradiance", remedy: "lower map_size" };

/// The most texels of all maps of a light group that a device can hold, where each of `groups` has maps of its own.
pub(crate) fn most_texels(limits: &wgpu::Limits, groups: usize) -> u64 {
    let groups = groups as u64;
    let bindable = limits.max_storage_buffer_binding_size.min(limits.max_buffer_size);
    let of_sums = (bindable / (groups * WORDS_BYTES)).saturating_sub(GROUP_ALIGNMENT);
    let of_irradiance = (u64::from(limits.max_texture_dimension_2d) << RECORDS_WIDTH_BITS) / irradiance_entries(groups);
    of_sums.min(bindable / size_of::<f32>() as u64).min(of_irradiance)
}

/// Entries of irradiance of a texel: with several groups, all light's stands beside theirs.
fn irradiance_entries(groups: u64) -> u64 {
    if groups > 1 { 1 + groups } else { 1 }
}

/// Bytes that a texel takes on the device: its sums, its area and its irradiance.
pub(crate) fn bytes_of_texel(groups: usize) -> u64 {
    let groups = groups as u64;
    groups * TEXEL_BYTES + size_of::<f32>() as u64 + 16 * irradiance_entries(groups)
}

/// The maps of all objects on the device.
#[derive(Debug)]
pub(crate) struct EnergyMaps {
    pub placements: Vec<Option<MapPlacement>>,
    sums: Sums,
    pub irradiance: wgpu::TextureView,
    pub bytes: u64,
    texel_count: u64,
    /// Light groups that have maps of their own.
    groups: u64,
    params: wgpu::Buffer,
    bind_group: wgpu::BindGroup,
}

/// The words of the sums, three for each texel.
#[derive(Debug)]
struct Sums {
    low: wgpu::Buffer,
    high: wgpu::Buffer,
}

/// The pipeline from sums to irradiance.
#[derive(Debug)]
pub(crate) struct ResolvePass {
    layout: wgpu::BindGroupLayout,
    pipeline: wgpu::ComputePipeline,
}

impl ResolvePass {
    pub fn new(gpu: &Gpu) -> Self {
        let bindings = [Binding::Uniform, Binding::Read, Binding::Read, Binding::Read, Binding::WriteTexels];
        let layout = gpu.layout("resolve", wgpu::ShaderStages::COMPUTE, &bindings);
        let pipeline = gpu.compute_pipeline(RESOLVE, &[&layout]);
        Self { layout, pipeline }
    }

    /// Turns the sums of `photons` photons into irradiance.
    pub fn run(&self, gpu: &Gpu, maps: &EnergyMaps, units_per_watt: f32, photons: u64) {
        let groups = maps.texel_count.div_ceil(u64::from(WORKGROUP_SIZE)) as u32;
        let groups_x = groups.clamp(1, 65_535);
        let params = ResolveParams {
            watts_per_unit: (1.0 / (f64::from(units_per_watt) * photons.max(1) as f64)) as f32,
            texel_count: maps.texel_count as u32,
            groups_x,
            light_groups: maps.groups as u32,
            group_texels: maps.group_texels() as u32,
            ..Default::default()
        };
        gpu.queue.write_buffer(&maps.params, 0, bytemuck::bytes_of(&params));
        gpu.dispatch(&self.pipeline, &[&maps.bind_group], [groups_x, groups.div_ceil(groups_x)]);
    }
}

impl EnergyMaps {
    /// Maps for each of `groups` light groups, one after the other.
    pub fn new(
        gpu: &Gpu,
        pass: &ResolvePass,
        placements: Vec<Option<MapPlacement>>,
        groups: usize,
    ) -> Result<Self, Error> {
        let groups = groups as u64;
        let purpose = if groups > 1 { GROUP_SUMS } else { SUMS };
        let texel_count: u64 = placements.iter().flatten().map(|map| map.tiles.texel_count()).sum();
        let words_bytes = groups * texel_count.next_multiple_of(GROUP_ALIGNMENT) * WORDS_BYTES;
        let areas: Vec<f32> = placements.iter().flatten().flat_map(MapPlacement::divisors).collect();
        let sums = Sums { low: gpu.zeroed(purpose, words_bytes)?, high: gpu.zeroed(purpose, words_bytes)? };
        let areas = gpu.filled(AREAS, &areas)?;
        let usage = wgpu::TextureUsages::STORAGE_BINDING | wgpu::TextureUsages::TEXTURE_BINDING;
        let entries = irradiance_entries(groups) * texel_count;
        let texture = gpu.texels(IRRADIANCE, wgpu::TextureFormat::Rgba32Float, usage, entries)?;
        let irradiance = texture.create_view(&wgpu::TextureViewDescriptor::default());
        let params = gpu.uniform::<ResolveParams>("resolve");
        let buffers = [&params, &sums.low, &sums.high, &areas];
        let mut resources: Vec<_> = buffers.map(|buffer| buffer.as_entire_binding()).into();
        resources.push(wgpu::BindingResource::TextureView(&irradiance));
        let bind_group = gpu.bind_resources(&pass.layout, resources);
        let bytes = sums.low.size() + sums.high.size() + areas.size() + texture_bytes(&texture);
        Ok(Self { placements, sums, irradiance, bytes, texel_count, groups, params, bind_group })
    }

    /// Texels from a light group's maps to the next one's.
    fn group_texels(&self) -> u64 {
        self.texel_count.next_multiple_of(GROUP_ALIGNMENT)
    }

    /// Entries of irradiance of a texel, of which the first is of all light.
    pub fn irradiance_entries(&self) -> u64 {
        irradiance_entries(self.groups)
    }

    /// Bytes of the sums of all light groups.
    pub fn sums_bytes(&self) -> u64 {
        self.groups * self.texel_count * TEXEL_BYTES
    }

    /// Low and high words of the sums of a light group.
    pub fn sums_of(&self, group: usize) -> [wgpu::BindingResource<'_>; 2] {
        let bytes = self.group_texels() * WORDS_BYTES;
        let part =
            |buffer| wgpu::BufferBinding { buffer, offset: group as u64 * bytes, size: std::num::NonZero::new(bytes) };
        [&self.sums.low, &self.sums.high].map(|buffer| wgpu::BindingResource::Buffer(part(buffer)))
    }

    /// What photons accumulate in, by name.
    pub fn accumulated(&self) -> [(&'static str, &wgpu::Buffer); 2] {
        [("low words of energy maps", &self.sums.low), ("high words of energy maps", &self.sums.high)]
    }

    /// Reads one object's map. Blocks.
    pub fn read(
        &self,
        gpu: &Gpu,
        object: usize,
        units_per_watt: f32,
        photons: u64,
    ) -> Result<Option<EnergyMap>, Error> {
        let Some(placement) = &self.placements[object] else { return Ok(None) };
        let count = placement.tiles.texel_count();
        let mut sums = vec![[0i64; 3]; count as usize];
        for group in 0..self.groups {
            let first = 3 * (group * self.group_texels() + placement.first_texel);
            let words = first..first + 3 * count;
            let low: Vec<u32> = gpu.read(&self.sums.low, words.clone())?;
            let high: Vec<u32> = gpu.read(&self.sums.high, words)?;
            for (sum, (low, high)) in sums.as_flattened_mut().iter_mut().zip(low.into_iter().zip(high)) {
                *sum = sum.wrapping_add((u64::from(high) << 32 | u64::from(low)).cast_signed());
            }
        }
        Ok(Some(EnergyMap {
            width: placement.layout.width,
            height: placement.layout.height,
            layers: placement.layout.layers,
            tiles: placement.tiles.clone(),
            sums,
            areas: placement.areas.clone(),
            units_per_watt: f64::from(units_per_watt),
            photons,
            paper_size: placement.paper_size,
        }))
    }
}
