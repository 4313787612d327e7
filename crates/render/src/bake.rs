//! Lightmaps: samples of every texel.

mod lightmap;
mod reflectance;
mod table;

pub use lightmap::{Lightmap, SurfacePlace};
pub use reflectance::base_reflectance;

use std::f32::consts::PI;

use diacaustic_scene::{Layer, Scene};
use diacaustic_shaders::{BAKE, BakeParams, PathParams, Sighting, WORKGROUP_SIZE, light_layer};
use diacaustic_surface::MapLayout;

use self::{lightmap::spread_outwards, table::Table};
use crate::{
    EnergyMap, Error,
    camera_pass::{Outputs as PathOutputs, PATH_OUTPUTS},
    features::{Features, Pipelines},
    gpu::{Binding, Gpu, Purpose},
    irradiance_cache::IrradianceCache,
    layers::{LayerSums, kept_groups},
    map_sums::EnergyMaps,
    random::combine,
    renderer::MOST_IN_FLIGHT,
};

/// The bindings of `shaders/layout/path_pass.wgsl` and `bake_pass.wgsl`.
const PARAMS: [Binding; 2] = [Binding::Uniform; 2];
const TABLES: [Binding; 2] = [Binding::Read; 2];
const FILM: Purpose = Purpose { what: "the lightmap's texels", remedy: "lower map_size" };
const SIGHTINGS: Purpose = Purpose { what: "what paths see of the energy maps", remedy: "lower map_size" };
const TEXELS: Purpose = Purpose { what: "the list of a lightmap's texels", remedy: "lower map_size" };
const CELLS: Purpose = Purpose { what: "where triangles lie on a lightmap", remedy: "lower map_size" };
/// The stream of this pass's seeds.
const SEED_STREAM: u32 = 5;
/// Texels that are sampled at once.
const MOST_TEXELS: usize = 1 << 19;

/// How a lightmap is made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BakeOptions {
    /// Paths that begin at each texel, for light from lights and from other surfaces. The caustic needs none.
    pub samples: u32,
}

impl Default for BakeOptions {
    fn default() -> Self {
        Self { samples: 64 }
    }
}

/// The pipeline of the bake pass.
#[derive(Debug)]
pub(crate) struct BakePass {
    params_layout: wgpu::BindGroupLayout,
    outputs_layout: wgpu::BindGroupLayout,
    tables_layout: wgpu::BindGroupLayout,
    pipelines: Pipelines,
}

impl BakePass {
    pub fn new(gpu: &Gpu, scene_layout: &wgpu::BindGroupLayout) -> Self {
        let layout = |label, bindings: &[Binding]| gpu.layout(label, wgpu::ShaderStages::COMPUTE, bindings);
        let params_layout = layout("bake params", &PARAMS);
        let outputs_layout = layout("bake outputs", &PATH_OUTPUTS);
        let tables_layout = layout("bake tables", &TABLES);
        let layouts = [scene_layout, &params_layout, &outputs_layout, &tables_layout];
        let pipelines = Pipelines::new(BAKE, &layouts);
        Self { params_layout, outputs_layout, tables_layout, pipelines }
    }
}

/// A scene on the device, as lightmaps are made of it.
pub(crate) struct BakeScene<'s> {
    pub scene: &'s Scene,
    /// Object and triangle of each triangle on the device.
    pub origins: &'s [(u32, u32)],
    pub features: Features,
    pub maps: &'s EnergyMaps,
    pub group: &'s wgpu::BindGroup,
    /// Those of the camera's paths.
    pub paths: PathParams,
}

/// Makes the lightmap of an object whose energy map has a layout and has been read. Blocks.
pub(crate) fn bake(
    gpu: &Gpu,
    pass: &mut BakePass,
    of: &BakeScene<'_>,
    (object, layout): (usize, &MapLayout),
    energy_map: &EnergyMap,
    options: BakeOptions,
) -> Result<Lightmap, Error> {
    let table = Table::new(of.scene, object, layout, of.origins);
    let sums = sample(gpu, pass, of, (object, layout), &table, options)?;
    let mut lightmap = Lightmap::new(layout, table.places);
    let texels_in_layer = layout.width as usize * layout.height as usize;
    let mut is_sampled = vec![false; lightmap.direct.len()];
    for (texel, sums) in table.texels.iter().zip(sums).filter(|(_, sums)| sums.weight > 0.0) {
        let index = texel.side as usize * texels_in_layer + (texel.row * layout.width + texel.column) as usize;
        is_sampled[index] = true;
        lightmap.direct[index] = sums.direct.map(|sum| sum / sums.weight);
        lightmap.indirect[index] = sums.indirect.map(|sum| sum / sums.weight);
    }
    lightmap.caustic = energy_map.resampled().into_iter().map(|texel| texel.as_vec3().to_array()).collect();
    let holds_surface: Vec<bool> = lightmap.places.iter().map(Option::is_some).collect();
    let holds_surface = holds_surface.repeat(layout.layers as usize);
    let Lightmap { direct, caustic, indirect, .. } = &mut lightmap;
    for (texels, holds) in [(direct, &is_sampled), (indirect, &is_sampled), (caustic, &holds_surface)] {
        for (layer, holds) in texels.chunks_mut(texels_in_layer).zip(holds.chunks(texels_in_layer)) {
            spread_outwards(layer, layout.width as usize, holds);
        }
    }
    Ok(lightmap)
}

/// What a texel's samples sum to, weighted.
struct TexelSums {
    direct: [f32; 3],
    indirect: [f32; 3],
    weight: f32,
}

/// Samples every texel of a table. Blocks.
fn sample(
    gpu: &Gpu,
    pass: &mut BakePass,
    of: &BakeScene<'_>,
    (object, layout): (usize, &MapLayout),
    table: &Table,
    options: BakeOptions,
) -> Result<Vec<TexelSums>, Error> {
    let cells = gpu.filled(CELLS, &table.cells)?;
    let paths = PathParams {
        position: [0.0; 3],
        forward: [0.0; 3],
        media: [0; 4],
        exposure: PI,
        seed: combine(of.scene.settings.seed, combine(SEED_STREAM, object as u32)),
        ..of.paths
    };
    let pipeline = pass.pipelines.get(gpu, of.features.for_baking());
    let mut sums = Vec::with_capacity(table.texels.len());
    for (number, texels) in table.texels.chunks(MOST_TEXELS).enumerate() {
        let groups = (texels.len() as u32).div_ceil(WORKGROUP_SIZE);
        let groups_x = groups.min(65_535);
        let batch = BakeParams {
            object: object as u32,
            first_texel: (number * MOST_TEXELS) as u32,
            texel_count: texels.len() as u32,
            groups_x,
            width: layout.width,
            height: layout.height,
            texel_density: table.texel_density,
        };
        let tables = gpu.bind(&pass.tables_layout, &[&gpu.filled(TEXELS, texels)?, &cells]);
        let outputs = Outputs::new(gpu, pass, of, texels.len() as u64)?;
        let (path_buffer, batch_buffer) = (gpu.uniform::<PathParams>("bake paths"), gpu.uniform::<BakeParams>("bake"));
        gpu.queue.write_buffer(&batch_buffer, 0, bytemuck::bytes_of(&batch));
        let params = gpu.bind(&pass.params_layout, &[&path_buffer, &batch_buffer]);
        for sample_index in 0..options.samples {
            let params_of_sample = PathParams { sample_index, ..paths };
            gpu.queue.write_buffer(&path_buffer, 0, bytemuck::bytes_of(&params_of_sample));
            let bind_groups = [of.group, &params, &outputs.group, &tables];
            gpu.dispatch(&pipeline, &bind_groups, [groups_x, groups.div_ceil(groups_x)]);
            if (sample_index + 1).is_multiple_of(MOST_IN_FLIGHT) {
                gpu.wait()?;
            }
        }
        sums.extend(outputs.read(gpu, texels.len() as u64)?);
    }
    Ok(sums)
}

/// What the samples of some texels accumulate in.
struct Outputs {
    film: wgpu::Buffer,
    layers: LayerSums,
    group: wgpu::BindGroup,
}

impl Outputs {
    fn new(gpu: &Gpu, pass: &BakePass, of: &BakeScene<'_>, texels: u64) -> Result<Self, Error> {
        let film = gpu.zeroed(FILM, 16 * (1 + texels))?;
        let layers = LayerSums::new(gpu, &[Layer::Direct], &kept_groups(of.scene), texels)?;
        let sightings = &gpu.zeroed(SIGHTINGS, size_of::<Sighting>() as u64)?;
        let cache = &IrradianceCache::none(gpu)?.buffer;
        let outputs = PathOutputs { maps: of.maps, film: &film, layers: &layers, sightings, cache };
        let group = gpu.bind_resources(&pass.outputs_layout, outputs.resources());
        Ok(Self { film, layers, group })
    }

    /// Reads the sums of some texels. Blocks.
    fn read(&self, gpu: &Gpu, texels: u64) -> Result<Vec<TexelSums>, Error> {
        let words: Vec<u32> = gpu.read(&self.film, 0..4)?;
        if words[2] > 0 {
            return Err(Error::CutShort { invocations: words[2] });
        }
        let totals: Vec<[f32; 4]> = gpu.read(&self.film, 1..1 + texels)?;
        let layers: Vec<[f32; 4]> = gpu.read(&self.layers.light, 0..texels * u64::from(light_layer::COUNT))?;
        let rgb = |[r, g, b, _]: [f32; 4]| [r, g, b];
        let (of_texel, _) = layers.as_chunks::<{ light_layer::COUNT as usize }>();
        let sums = |(total, layers): (&[f32; 4], &[[f32; 4]; light_layer::COUNT as usize])| TexelSums {
            direct: rgb(layers[light_layer::DIRECT as usize]),
            indirect: rgb(layers[light_layer::INDIRECT as usize]),
            weight: total[3],
        };
        Ok(totals.iter().zip(of_texel).map(sums).collect())
    }
}
