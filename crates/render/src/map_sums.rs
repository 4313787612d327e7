//! Energy maps on the device: the sums that photons fill, and the irradiance that follows from them.

use diacaustic_scene::Scene;
use diacaustic_shaders::{RECORDS_WIDTH_BITS, RESOLVE, ResolveParams, SMOOTH, SmoothParams, WORKGROUP_SIZE};

use crate::{
    EnergyMap, Error,
    features::{Features, Pipelines},
    gpu::{Binding, Gpu, Purpose, texture_bytes},
    map_placement::MapPlacement,
    map_texels::MapTexels,
};

/// Texels in whose multiples the maps of light groups begin: where a device can bind a part of a buffer.
const GROUP_ALIGNMENT: u64 = 64;
/// Steps of the filter after the first, two and two: a texel is compared with those that are so many cells away.
const WIDER_STEPS: [[i32; 2]; 2] = [[2, 4], [8, 16]];
/// What photons that fall on four texels each make of the variance of a mean over many texels, against that of independent texels: the squares
/// of bilinear weights sum to (2/3)² on average, their sum to 1.
const BILINEAR_VARIANCE: f32 = 2.25;

const SUMS: Purpose = Purpose { what: "half the sums of the energy maps", remedy: "lower map_size" };
const GROUP_SUMS: Purpose = Purpose {
    what: "half the sums of the energy maps of all light groups",
    remedy: "lower map_size, or keep fewer light groups apart",
};
const IRRADIANCE: Purpose = Purpose { what: "the texels' irradiance", remedy: "lower map_size" };
const FILTERED: Purpose = Purpose {
    what: "the texels' filtered irradiance",
    remedy: "lower map_size, or set map_filter = false and hue_filter = false",
};
const WELDED: Purpose = Purpose { what: "irradiance where tiles meet", remedy: "lower map_budget" };

/// What is summed for each texel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct SumsFormat {
    /// Light groups that have maps of their own.
    pub groups: u64,
    /// Whether there are sums of squares too, for the filter.
    pub has_squares: bool,
    /// Whether hues are mixed.
    pub mixes_hues: bool,
}

impl SumsFormat {
    /// That of no maps.
    pub const NONE: Self = Self { groups: 1, has_squares: false, mixes_hues: false };

    pub fn new(scene: &Scene, groups: usize) -> Self {
        let settings = &scene.settings;
        let has_hues = scene.has_dispersion() && settings.wavelength.is_none();
        Self {
            groups: groups as u64,
            has_squares: settings.map_filter,
            mixes_hues: has_hues && settings.hue_filter && !settings.map_filter,
        }
    }

    /// 64-bit sums of a texel.
    fn sums(self) -> u64 {
        if self.has_squares { 4 } else { 3 }
    }

    /// Bytes of a texel's sums.
    pub fn bytes(self) -> u64 {
        8 * self.sums()
    }

    /// Textures of irradiance.
    fn textures(self) -> u64 {
        match (self.has_squares, self.mixes_hues) {
            (true, _) => 3,
            (false, true) => 2,
            (false, false) => 1,
        }
    }

    /// Bytes of a texel in each of the two buffers: of low and of high words.
    fn words_bytes(self) -> u64 {
        4 * self.sums()
    }

    /// Entries of irradiance of a texel: with several groups, all light's stands beside theirs.
    fn entries(self) -> u64 {
        if self.groups > 1 { 1 + self.groups } else { 1 }
    }

    /// The most texels of all maps of a light group that a device can hold.
    pub fn most_texels(self, limits: &wgpu::Limits) -> u64 {
        let bindable = limits.max_storage_buffer_binding_size.min(limits.max_buffer_size);
        let of_sums = bindable / (self.groups * self.words_bytes()) / GROUP_ALIGNMENT * GROUP_ALIGNMENT;
        let entries = self.entries() * if self.has_squares { 2 } else { 1 };
        let of_textures = (u64::from(limits.max_texture_dimension_2d) << RECORDS_WIDTH_BITS) / entries;
        of_sums.min(of_textures)
    }

    /// Bytes that a texel takes on the device: its sums, its record and its irradiance, and what the filter of that needs.
    pub fn bytes_on_device(self) -> u64 {
        let irradiance = 16 * self.entries();
        self.groups * self.bytes() + 16 + irradiance * self.textures()
    }
}

/// The maps of all objects on the device.
#[derive(Debug)]
pub(crate) struct EnergyMaps {
    pub placements: Vec<Option<MapPlacement>>,
    sums: Sums,
    /// What the picture shows.
    pub irradiance: wgpu::TextureView,
    pub bytes: u64,
    texel_count: u64,
    weld_count: u64,
    format: SumsFormat,
    resolve_params: wgpu::Buffer,
    resolve_group: wgpu::BindGroup,
    /// What passes write into: irradiance, and in scenes with a filter a second texture in turn with it, in which guides follow.
    targets: Vec<Target>,
    filter: Option<Filter>,
}

/// The filter of maps.
#[derive(Debug)]
struct Filter {
    pipeline: wgpu::ComputePipeline,
    params: wgpu::Buffer,
    /// To read either target.
    read: [wgpu::BindGroup; 2],
}

/// The words of the sums, three or four for each texel.
#[derive(Debug)]
struct Sums {
    low: wgpu::Buffer,
    high: wgpu::Buffer,
}

/// A texture of irradiance.
#[derive(Debug)]
struct Target {
    texture: wgpu::Texture,
    view: wgpu::TextureView,
    /// To write into it.
    written: wgpu::BindGroup,
}

/// The pipelines from sums to irradiance.
#[derive(Debug)]
pub(crate) struct ResolvePass {
    maps_layout: wgpu::BindGroupLayout,
    sums_layout: wgpu::BindGroupLayout,
    filter_layout: wgpu::BindGroupLayout,
    resolve: wgpu::ComputePipeline,
    smooth: Pipelines,
}

/// What photons so far are divided by.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Resolving<'s> {
    /// The scene on the device.
    pub scene: &'s wgpu::BindGroup,
    pub units_per_watt: f32,
    /// Photons that share the lights' flux.
    pub photons: u64,
    /// Whether photons have footprints.
    pub footprints: bool,
}

impl ResolvePass {
    pub fn new(gpu: &Gpu, scene_layout: &wgpu::BindGroupLayout) -> Self {
        let layout = |label, bindings: &[Binding]| gpu.layout(label, wgpu::ShaderStages::COMPUTE, bindings);
        let maps_layout = layout(
            "map texels",
            &[Binding::Records, Binding::Read, Binding::Read, Binding::ReadWrite, Binding::WriteTexels],
        );
        let sums_layout = layout("resolve", &[Binding::Uniform, Binding::Read, Binding::Read]);
        let filter_layout = layout("smooth", &[Binding::Uniform, Binding::Read, Binding::Texels]);
        let resolve = gpu.compute_pipeline(RESOLVE, &[scene_layout, &maps_layout, &sums_layout]);
        let smooth = Pipelines::new(SMOOTH, &[scene_layout, &maps_layout, &filter_layout]);
        Self { maps_layout, sums_layout, filter_layout, resolve, smooth }
    }

    /// Turns the sums of photons into irradiance, and filters it in scenes that ask for it.
    pub fn run(&self, gpu: &Gpu, maps: &EnergyMaps, of: Resolving) {
        let template = ResolveParams {
            watts_per_unit: (1.0 / (f64::from(of.units_per_watt) * of.photons.max(1) as f64)) as f32,
            light_groups: maps.format.groups as u32,
            group_texels: maps.group_texels() as u32,
            sums: maps.format.sums() as u32,
            ..Default::default()
        };
        for (of_welds, count) in maps.dispatches() {
            let size = workgroups(count);
            let params = ResolveParams { count: count as u32, groups_x: size[0], of_welds, ..template };
            gpu.queue.write_buffer(&maps.resolve_params, 0, bytemuck::bytes_of(&params));
            gpu.dispatch(&self.resolve, &[of.scene, &maps.targets[0].written, &maps.resolve_group], size);
        }
        if let Some(filter) = maps.filter.as_ref().filter(|_| of.photons > 0) {
            if maps.format.mixes_hues {
                hue_steps(of.photons).iter().for_each(|distances| filter.mix_hues(gpu, maps, of.scene, *distances));
            } else {
                filter.smooth(gpu, maps, of);
            }
        }
    }
}

impl Filter {
    fn new(
        gpu: &Gpu,
        pass: &ResolvePass,
        pipeline: wgpu::ComputePipeline,
        tiles: &wgpu::Buffer,
        targets: [&Target; 2],
    ) -> Self {
        let params = gpu.uniform::<SmoothParams>("smooth");
        let read = targets.map(|target| {
            let (params, tiles) = (params.as_entire_binding(), tiles.as_entire_binding());
            gpu.bind_resources(
                &pass.filter_layout,
                vec![params, tiles, wgpu::BindingResource::TextureView(&target.view)],
            )
        });
        Self { pipeline, params, read }
    }

    /// Filters irradiance: from the first target to the second, with guides, and back, smoothed where these are alike; then wider and wider, where
    /// the smoothed texels themselves are.
    fn smooth(&self, gpu: &Gpu, maps: &EnergyMaps, of: Resolving) {
        let first_guide = maps.entries() as u32;
        let variance_factor = if of.footprints { 1.0 } else { BILINEAR_VARIANCE };
        let guide = SmoothParams { makes_guide: 1, distance: 1, first_guide, ..Default::default() };
        let guided = SmoothParams { distance: 1, first_guide, variance_factor, ..Default::default() };
        self.forth_and_back(gpu, maps, of.scene, [guide, guided]);
        for distances in WIDER_STEPS {
            let steps = distances.map(|distance| SmoothParams { distance, variance_factor: 1.0, ..Default::default() });
            self.forth_and_back(gpu, maps, of.scene, steps);
        }
    }

    /// Mixes hues over texels so far apart, twice.
    fn mix_hues(&self, gpu: &Gpu, maps: &EnergyMaps, scene: &wgpu::BindGroup, distances: [i32; 2]) {
        let params = distances.map(|distance| SmoothParams { distance, ..Default::default() });
        self.forth_and_back(gpu, maps, scene, params);
    }

    /// A pass from the first target to the second, and one back.
    fn forth_and_back(&self, gpu: &Gpu, maps: &EnergyMaps, scene: &wgpu::BindGroup, passes: [SmoothParams; 2]) {
        for (from, params) in passes.into_iter().enumerate() {
            for (of_welds, count) in maps.dispatches() {
                let size = workgroups(count);
                let params = SmoothParams { count: count as u32, groups_x: size[0], of_welds, ..params };
                gpu.queue.write_buffer(&self.params, 0, bytemuck::bytes_of(&params));
                let groups = [scene, &maps.targets[1 - from].written, &self.read[from]];
                gpu.dispatch(&self.pipeline, &groups, size);
            }
        }
    }
}

/// Distances over which hues are mixed, cells: less and less as photons grow.
fn hue_steps(photons: u64) -> &'static [[i32; 2]] {
    match photons {
        0..0x40_0000 => &[[1, 2], [4, 2]],
        0x40_0000..0x100_0000 => &[[1, 2]],
        0x100_0000..0x400_0000 => &[[1, 1]],
        _ => &[],
    }
}

/// Workgroups, along x and y, for so many invocations.
fn workgroups(count: u64) -> [u32; 2] {
    let groups = count.div_ceil(u64::from(WORKGROUP_SIZE)) as u32;
    let along_x = groups.clamp(1, 65_535);
    [along_x, groups.div_ceil(along_x)]
}

impl EnergyMaps {
    /// Maps for each light group, one after the other.
    pub fn new(
        gpu: &Gpu,
        pass: &mut ResolvePass,
        placements: Vec<Option<MapPlacement>>,
        format: SumsFormat,
        features: Features,
    ) -> Result<Self, Error> {
        let purpose = if format.groups > 1 { GROUP_SUMS } else { SUMS };
        let texel_count: u64 = placements.iter().flatten().map(|map| map.tiles.texel_count()).sum();
        let words_bytes = format.groups * texel_count.next_multiple_of(GROUP_ALIGNMENT) * format.words_bytes();
        let sums = Sums { low: gpu.zeroed(purpose, words_bytes)?, high: gpu.zeroed(purpose, words_bytes)? };
        let texels = MapTexels::new(gpu, &placements)?;
        let welded = gpu.zeroed(WELDED, texels.weld_count * format.entries() * 16)?;
        let resolve_params = gpu.uniform::<ResolveParams>("resolve");
        let resolve_group = gpu.bind(&pass.sums_layout, &[&resolve_params, &sums.low, &sums.high]);
        let target = |purpose: Purpose, copies: u64| {
            let usage = wgpu::TextureUsages::STORAGE_BINDING
                | wgpu::TextureUsages::TEXTURE_BINDING
                | wgpu::TextureUsages::COPY_SRC;
            let entries = copies * format.entries() * texel_count;
            let texture = gpu.texels(purpose, wgpu::TextureFormat::Rgba32Float, usage, entries)?;
            let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
            let written = gpu.bind_resources(
                &pass.maps_layout,
                vec![
                    wgpu::BindingResource::TextureView(&texels.records),
                    texels.welds.as_entire_binding(),
                    texels.parts.as_entire_binding(),
                    welded.as_entire_binding(),
                    wgpu::BindingResource::TextureView(&view),
                ],
            );
            Ok::<_, Error>(Target { texture, view, written })
        };
        let mut targets = vec![target(IRRADIANCE, 1)?];
        if format.textures() > 1 {
            targets.push(target(FILTERED, format.textures() - 1)?);
        }
        let filter = if let [first, second] = targets.as_slice() {
            let pipeline = pass.smooth.get(gpu, features.for_filter(format.mixes_hues));
            Some(Filter::new(gpu, pass, pipeline, &texels.tiles, [first, second]))
        } else {
            None
        };
        let textures: u64 = targets.iter().map(|target| texture_bytes(&target.texture)).sum();
        let shown = targets.first().map(|target| target.texture.create_view(&wgpu::TextureViewDescriptor::default()));
        Ok(Self {
            bytes: sums.low.size() + sums.high.size() + texels.bytes + welded.size() + textures,
            irradiance: shown.expect("there is a target"),
            placements,
            sums,
            texel_count,
            weld_count: texels.weld_count,
            format,
            resolve_params,
            resolve_group,
            targets,
            filter,
        })
    }

    /// The dispatches of a pass over all texels: whether over welds, and over how many. Those over welds come first.
    fn dispatches(&self) -> impl Iterator<Item = (u32, u64)> {
        [(1, self.weld_count), (0, self.texel_count)].into_iter().filter(|&(_, count)| count > 0)
    }

    /// Whether irradiance is more than sums over areas.
    pub fn is_filtered(&self) -> bool {
        self.filter.is_some()
    }

    /// Entries of irradiance of all texels.
    fn entries(&self) -> u64 {
        self.format.entries() * self.texel_count
    }

    /// Texels from a light group's maps to the next one's.
    fn group_texels(&self) -> u64 {
        self.texel_count.next_multiple_of(GROUP_ALIGNMENT)
    }

    /// Entries of irradiance of a texel, of which the first is of all light.
    pub fn irradiance_entries(&self) -> u64 {
        self.format.entries()
    }

    /// Bytes of the sums of all light groups.
    pub fn sums_bytes(&self) -> u64 {
        self.format.groups * self.texel_count * self.format.bytes()
    }

    /// Low and high words of the sums of a light group.
    pub fn sums_of(&self, group: usize) -> [wgpu::BindingResource<'_>; 2] {
        let bytes = self.group_texels() * self.format.words_bytes();
        let part =
            |buffer| wgpu::BufferBinding { buffer, offset: group as u64 * bytes, size: std::num::NonZero::new(bytes) };
        [&self.sums.low, &self.sums.high].map(|buffer| wgpu::BindingResource::Buffer(part(buffer)))
    }

    /// What photons accumulate in, by name.
    pub fn accumulated(&self) -> [(&'static str, &wgpu::Buffer); 2] {
        [("low words of energy maps", &self.sums.low), ("high words of energy maps", &self.sums.high)]
    }

    /// Reads one object's map, of photons that have been resolved. Blocks.
    pub fn read(
        &self,
        gpu: &Gpu,
        object: usize,
        units_per_watt: f32,
        photons: u64,
    ) -> Result<Option<EnergyMap>, Error> {
        let Some(placement) = &self.placements[object] else { return Ok(None) };
        let count = placement.tiles.texel_count();
        let mut map = EnergyMap {
            width: placement.layout.width,
            height: placement.layout.height,
            layers: placement.layout.layers,
            tiles: placement.tiles.clone(),
            sums: self.read_sums(gpu, placement.first_texel, count)?,
            areas: placement.surfaces.iter().map(|texel| texel.area).collect(),
            welds: placement.welds.clone(),
            units_per_watt: f64::from(units_per_watt),
            photons,
            paper_size: placement.paper_size,
            smoothed: None,
            unsmoothed: Vec::new(),
        };
        map.resolve();
        if self.filter.is_some() {
            let entries = self.format.entries();
            let range = entries * placement.first_texel..entries * (placement.first_texel + count);
            let texels: Vec<[f32; 4]> = gpu.read_texels(&self.targets[0].texture, range)?;
            map.smoothed = Some(texels.iter().step_by(entries as usize).map(|&[r, g, b, _]| [r, g, b]).collect());
        }
        Ok(Some(map))
    }

    /// The sums of flux of some texels, over all light groups.
    fn read_sums(&self, gpu: &Gpu, first_texel: u64, count: u64) -> Result<Vec<[i64; 3]>, Error> {
        let mut sums = vec![[0i64; 3]; count as usize];
        for group in 0..self.format.groups {
            let first = self.format.sums() * (group * self.group_texels() + first_texel);
            let words = first..first + self.format.sums() * count;
            let low: Vec<u32> = gpu.read(&self.sums.low, words.clone())?;
            let high: Vec<u32> = gpu.read(&self.sums.high, words)?;
            let stride = self.format.sums() as usize;
            for (texel, (low, high)) in sums.iter_mut().zip(low.chunks(stride).zip(high.chunks(stride))) {
                for (sum, (&low, &high)) in texel.iter_mut().zip(low.iter().zip(high)) {
                    *sum = sum.wrapping_add((u64::from(high) << 32 | u64::from(low)).cast_signed());
                }
            }
        }
        Ok(sums)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hues_are_mixed_less_and_less_as_photons_grow() {
        let reach = |photons| hue_steps(photons).as_flattened().iter().map(|distance| distance * distance).sum::<i32>();
        let reaches: Vec<i32> = (0..34).map(|bits| reach(1 << bits)).collect();
        assert!(reaches.is_sorted_by(|a, b| a >= b) && reaches[0] > 0, "{reaches:?}");
        assert_eq!(reaches[26], 0);
    }
}
