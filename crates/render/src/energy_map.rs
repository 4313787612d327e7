//! Energy maps: where they lie in the device's buffers, how they become irradiance, and how the application reads them.

use std::collections::BinaryHeap;

use diacaustic_scene::{Camera, Object, RenderSettings, Scene};
use diacaustic_shaders::{RESOLVE, ResolveParams, WORKGROUP_SIZE};
use diacaustic_surface::{MapLayout, WorldTriangle, texel_areas};
use glam::{DVec3, Mat3, Vec3};

use crate::{
    Error,
    gpu::{Binding, Gpu, Purpose, texture_bytes, wide},
};

/// Bytes of a texel's three 64-bit sums.
const TEXEL_BYTES: u64 = 24;
/// Texels in whose multiples the maps of light groups begin: where a device can bind a part of a buffer.
const GROUP_ALIGNMENT: u64 = 32;
/// Texels along the longer side of a map whose size nobody chose: at least, at most.
const DEFAULT_SIZES: std::ops::RangeInclusive<f32> = 16.0..=2048.0;

const SUMS: Purpose = Purpose { what: "the energy maps", remedy: "lower map_size" };
const GROUP_SUMS: Purpose =
    Purpose { what: "the energy maps of all light groups", remedy: "lower map_size, or keep fewer light groups apart" };
const AREAS: Purpose = Purpose { what: "the texels' areas", remedy: "lower map_size" };
const IRRADIANCE: Purpose = Purpose { what: "the texels' irradiance", remedy: "lower map_size" };

/// One object's map within the buffer of all maps.
#[derive(Clone, Debug)]
pub(crate) struct MapPlacement {
    pub layout: MapLayout,
    pub first_texel: u64,
    /// Area of each texel of one layer, m².
    pub areas: Vec<f64>,
    /// What sums are divided by in place of areas, in the profile `paper`.
    pub paper_size: Option<f64>,
}

impl MapPlacement {
    /// What the sums of one layer's texels are divided by; 0 where there is no surface.
    fn divisors(&self) -> impl Iterator<Item = f32> {
        self.areas.iter().map(|&area| if area > 0.0 { self.paper_size.unwrap_or(area) as f32 } else { 0.0 })
    }
}

/// Whether an object has an energy map: some triangle of it is a receiver.
fn is_receiver(scene: &Scene, object: &Object) -> bool {
    object.materials.iter().any(|&material| scene.materials[material].is_receiver())
}

/// Lays out the maps of all receivers.
pub(crate) fn place_maps(scene: &Scene, triangles: &[WorldTriangle], budget: u64) -> Vec<Option<MapPlacement>> {
    let mut layouts: Vec<Option<MapLayout>> = scene
        .objects
        .iter()
        .map(|object| is_receiver(scene, object).then(|| MapLayout::new(object, chosen_size(scene, object))))
        .collect();
    shrink_to_budget(scene, &mut layouts, budget);
    let paper_size = scene.settings.paper.map(|profile| profile.map_size.divisor());
    let mut first_texel = 0;
    let mut chunks = triangles.chunk_by(|a, b| a.object == b.object).peekable();
    layouts
        .into_iter()
        .enumerate()
        .map(|(index, layout)| {
            let own = chunks.next_if(|chunk| chunk[0].object as usize == index).unwrap_or(&[]);
            layout.map(|layout| {
                let receivers: Vec<_> =
                    own.iter().filter(|t| scene.materials[t.material as usize].is_receiver()).copied().collect();
                let placement =
                    MapPlacement { areas: texel_areas(&layout, &receivers), first_texel, layout, paper_size };
                first_texel += placement.layout.texel_count();
                placement
            })
        })
        .collect()
}

/// Texels along the longer side of an object's map: the scene's choice, or half a pixel's footprint.
fn chosen_size(scene: &Scene, object: &Object) -> u32 {
    let of_paper = scene.settings.paper.map(|profile| profile.map_size.texels(object));
    let stated = of_paper.or(object.map_size).or(scene.settings.map_size);
    stated.unwrap_or_else(|| default_size(&scene.camera, &scene.settings, object))
}

/// The size that makes a texel half as wide as the camera's pixels are on the object, on average over directions, where it is
/// nearest to the point looked at.
fn default_size(camera: &Camera, settings: &RenderSettings, object: &Object) -> u32 {
    let (low, high) = object
        .mesh
        .positions
        .iter()
        .map(|&p| object.world_from_object.transform_point3(p))
        .fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(low, high), p| (low.min(p), high.max(p)));
    let seen = camera.look_at.clamp(low, high);
    let view = seen - camera.position;
    let pixel = 2.0 * view.length() * (0.5 * camera.vertical_fov.to_radians()).tan() / settings.height as f32;
    // A surface seen at an angle spreads a pixel over 1/cos of its area.
    let thinnest = Mat3::IDENTITY.col((high - low).min_position());
    let cosine = view.normalize_or_zero().dot(thinnest).abs().max(0.1);
    let texel = 0.5 * pixel / cosine.sqrt();
    let texels = (high - low).max_element() / texel.max(f32::MIN_POSITIVE);
    texels.clamp(*DEFAULT_SIZES.start(), *DEFAULT_SIZES.end()).ceil() as u32
}

/// Texels of a map that is small enough.
const SMALLEST_MAP: u64 = 64;

/// Halves the largest map whose size nobody chose until all fit.
fn shrink_to_budget(scene: &Scene, layouts: &mut [Option<MapLayout>], budget: u64) {
    let mut total: u64 = layouts.iter().flatten().map(MapLayout::texel_count).sum();
    let all_stated = scene.settings.map_size.is_some() || scene.settings.paper.is_some();
    let is_free = |index: usize| !all_stated && scene.objects[index].map_size.is_none();
    let sized = layouts.iter().enumerate().filter_map(|(index, layout)| Some((layout.as_ref()?.texel_count(), index)));
    let mut largest_first: BinaryHeap<_> = sized.filter(|&(_, index)| is_free(index)).collect();
    while total * TEXEL_BYTES > budget {
        let Some((texels, index)) = largest_first.pop().filter(|&(texels, _)| texels > SMALLEST_MAP) else { return };
        let Some(layout) = &mut layouts[index] else { continue };
        *layout = MapLayout::new(&scene.objects[index], layout.width.max(layout.height) / 2);
        total -= texels - layout.texel_count();
        largest_first.push((layout.texel_count(), index));
    }
}

/// The maps of all objects on the device.
#[derive(Debug)]
pub(crate) struct EnergyMaps {
    pub placements: Vec<Option<MapPlacement>>,
    pub sums: wgpu::Buffer,
    pub irradiance: wgpu::TextureView,
    pub bytes: u64,
    texel_count: u64,
    /// Light groups that have maps of their own.
    groups: u64,
    params: wgpu::Buffer,
    bind_group: wgpu::BindGroup,
}

/// The pipeline from sums to irradiance.
#[derive(Debug)]
pub(crate) struct ResolvePass {
    layout: wgpu::BindGroupLayout,
    pipeline: wgpu::ComputePipeline,
}

impl ResolvePass {
    pub fn new(gpu: &Gpu) -> Self {
        let bindings = [Binding::Uniform, Binding::Read, Binding::Read, Binding::WriteTexels];
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
        let texel_count: u64 = placements.iter().flatten().map(|map| map.layout.texel_count()).sum();
        let sums_bytes = groups * texel_count.next_multiple_of(GROUP_ALIGNMENT) * TEXEL_BYTES;
        gpu.check_size(purpose, sums_bytes)?;
        let areas: Vec<f32> = placements
            .iter()
            .flatten()
            .flat_map(|map| std::iter::repeat_n(map, map.layout.layers as usize).flat_map(MapPlacement::divisors))
            .collect();
        let sums = gpu.zeroed(purpose, sums_bytes)?;
        let areas = gpu.filled(AREAS, &areas)?;
        // With several groups, all light's irradiance stands beside theirs.
        let entries = if groups > 1 { 1 + groups } else { 1 };
        let usage = wgpu::TextureUsages::STORAGE_BINDING | wgpu::TextureUsages::TEXTURE_BINDING;
        let texture = gpu.texels(IRRADIANCE, wgpu::TextureFormat::Rgba32Float, usage, entries * texel_count)?;
        let irradiance = texture.create_view(&wgpu::TextureViewDescriptor::default());
        let params = gpu.uniform::<ResolveParams>("resolve");
        let mut resources: Vec<_> = [&params, &sums, &areas].map(|buffer| buffer.as_entire_binding()).into();
        resources.push(wgpu::BindingResource::TextureView(&irradiance));
        let bind_group = gpu.bind_resources(&pass.layout, resources);
        let bytes = sums.size() + areas.size() + texture_bytes(&texture);
        Ok(Self { placements, sums, irradiance, bytes, texel_count, groups, params, bind_group })
    }

    /// Texels from a light group's maps to the next one's.
    fn group_texels(&self) -> u64 {
        self.texel_count.next_multiple_of(GROUP_ALIGNMENT)
    }

    /// The sums of a light group.
    pub fn sums_of(&self, group: usize) -> wgpu::BindingResource<'_> {
        let bytes = self.group_texels() * TEXEL_BYTES;
        let size = std::num::NonZero::new(bytes);
        wgpu::BindingResource::Buffer(wgpu::BufferBinding { buffer: &self.sums, offset: group as u64 * bytes, size })
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
        let count = placement.layout.texel_count();
        let mut sums = vec![[0i64; 3]; count as usize];
        for group in 0..self.groups {
            let first = 3 * (group * self.group_texels() + placement.first_texel);
            let words: Vec<[u32; 2]> = gpu.read(&self.sums, first..first + 3 * count)?;
            for (sum, words) in sums.iter_mut().flatten().zip(words) {
                *sum = sum.wrapping_add(wide(words) as i64);
            }
        }
        Ok(Some(EnergyMap {
            width: placement.layout.width,
            height: placement.layout.height,
            layers: placement.layout.layers,
            sums,
            areas: placement.areas.clone(),
            units_per_watt: f64::from(units_per_watt),
            photons,
            paper_size: placement.paper_size,
        }))
    }
}

/// One object's energy map, read from the device.
#[derive(Clone, Debug, PartialEq)]
pub struct EnergyMap {
    /// Texels along x.
    pub width: u32,
    /// Texels along y.
    pub height: u32,
    /// 1, or 2: what fell on the front, then what fell on the back.
    pub layers: u32,
    /// Fixed-point sums of flux, layer by layer and row by row: integers, so that equal photons give equal sums in any order.
    pub sums: Vec<[i64; 3]>,
    /// Area of each texel of one layer, m².
    pub areas: Vec<f64>,
    /// Units of the sums in a watt.
    pub units_per_watt: f64,
    /// Photons that the sums are of, over every light.
    pub photons: u64,
    /// The size of the map by which the profile `paper` divides sums of energy, of which each photon brings the same, however many there are;
    /// none where photons share the light's flux.
    pub paper_size: Option<f64>,
}

impl EnergyMap {
    /// Flux collected by a texel, W; in the profile `paper`, energy.
    ///
    /// # Panics
    /// If `texel` is out of range.
    pub fn flux(&self, texel: usize) -> DVec3 {
        let photons = if self.paper_size.is_some() { 1 } else { self.photons.max(1) };
        DVec3::from(self.sums[texel].map(|sum| sum as f64)) / (self.units_per_watt * photons as f64)
    }

    /// Irradiance of a texel, W/m²; 0 where it holds no surface. In the profile `paper`, energy over the map's size.
    ///
    /// # Panics
    /// If `texel` is out of range.
    pub fn irradiance(&self, texel: usize) -> DVec3 {
        let area = self.areas[texel % self.areas.len()];
        if area > 0.0 { self.flux(texel) / self.paper_size.unwrap_or(area) } else { DVec3::ZERO }
    }

    /// Adds the photons of another run of the same scene and seed: the sums of photons 0 to N and N to M are those of 0 to M.
    /// Returns false, and changes nothing, if the maps differ in shape or scale.
    #[must_use]
    pub fn merge(&mut self, other: &Self) -> bool {
        let alike = (self.width, self.height, self.layers) == (other.width, other.height, other.layers)
            && self.units_per_watt == other.units_per_watt;
        if alike {
            self.photons += other.photons;
            for (sum, more) in self.sums.iter_mut().zip(&other.sums) {
                *sum = std::array::from_fn(|channel| sum[channel].wrapping_add(more[channel]));
            }
        }
        alike
    }
}
