//! The layers of the picture: what the camera pass keeps beside it, and how the application reads them. `docs/layers.md` says what they hold.

use diacaustic_scene::{BACKGROUND_GROUP, Layer, LightGroups, Scene};
use diacaustic_shaders::{DataLayers, light_layer};

use crate::{
    Error,
    gpu::{Gpu, Purpose},
    variance::SampleSums,
};

const LIGHT_LAYERS: Purpose =
    Purpose { what: "the picture's layers of light", remedy: "lower width or height, or write fewer layers" };
const DATA_LAYERS: Purpose =
    Purpose { what: "the picture's layers of data", remedy: "lower width or height, or write fewer layers" };

const GROUP_LAYERS: Purpose = Purpose {
    what: "the layers of light groups",
    remedy: "lower width or height, use fewer groups, or write layers without \"light_groups\"",
};

/// The depth of a pixel that shows no surface, metres.
pub const FARTHEST_DEPTH: f32 = 1e10;

/// A layer of the picture, read from the device.
#[derive(Clone, Debug, PartialEq)]
pub struct LayerImage {
    /// Its name, as [`Layer::name`] has it.
    pub name: String,
    /// Its channels.
    pub channels: Vec<LayerChannel>,
}

/// A channel of a layer.
#[derive(Clone, Debug, PartialEq)]
pub struct LayerChannel {
    /// Its name within the layer, such as `R` or `X`; empty for the only channel of a layer of whole numbers.
    pub name: &'static str,
    /// A value for each pixel, row by row from the top left.
    pub values: LayerValues,
}

/// The values of a channel.
#[derive(Clone, Debug, PartialEq)]
pub enum LayerValues {
    /// Numbers.
    Float(Vec<f32>),
    /// Whole numbers.
    Uint(Vec<u32>),
}

/// Whether layers are made of sums of light.
pub(crate) fn has_light_layers(layers: &[Layer]) -> bool {
    layers.iter().any(|&layer| light_sum(layer).is_some())
}

/// Whether layers are made of what samples met first, or of how much they vary.
pub(crate) fn has_data_layers(layers: &[Layer]) -> bool {
    layers.iter().any(|&layer| !matches!(layer, Layer::LightGroups | Layer::Samples) && light_sum(layer).is_none())
}

/// Whether it is told how much pixels vary.
pub(crate) fn has_variance(layers: &[Layer]) -> bool {
    layers.contains(&Layer::Variance)
}

/// The light groups that a scene's layers keep apart; a single one where they keep none.
pub(crate) fn kept_groups(scene: &Scene) -> LightGroups {
    let groups = scene.light_groups();
    let are_kept = scene.output.layers.contains(&Layer::LightGroups) && groups.names.len() > 1;
    if are_kept { groups } else { LightGroups::single(scene) }
}

/// How many groups are kept apart.
pub(crate) fn kept_group_count(groups: &LightGroups) -> usize {
    if groups.names.len() > 1 { groups.names.len() } else { 0 }
}

/// A layer's place among the sums of light.
fn light_sum(layer: Layer) -> Option<u32> {
    match layer {
        Layer::Emission => Some(light_layer::EMISSION),
        Layer::Direct => Some(light_layer::DIRECT),
        Layer::Caustic => Some(light_layer::CAUSTIC),
        Layer::Indirect => Some(light_layer::INDIRECT),
        _ => None,
    }
}

/// The sums of layers on the device; an entry without use where no layer needs them.
#[derive(Debug)]
pub(crate) struct LayerSums {
    pub light: wgpu::Buffer,
    pub data: wgpu::Buffer,
    pub groups: wgpu::Buffer,
    /// The groups that are kept apart, by name.
    group_names: Vec<String>,
}

impl LayerSums {
    /// Sums for the layers of a picture.
    pub fn new(gpu: &Gpu, layers: &[Layer], kept: &LightGroups, pixels: u64) -> Result<Self, Error> {
        let count = |wanted: bool| if wanted { pixels } else { 1 };
        let light = count(has_light_layers(layers)) * u64::from(light_layer::COUNT) * 16;
        let data = count(has_data_layers(layers)) * size_of::<DataLayers>() as u64;
        let group_names = kept.names[..kept_group_count(kept)].to_vec();
        let groups = count(!group_names.is_empty()) * group_sums(group_names.len()) * 16;
        Ok(Self {
            light: gpu.zeroed(LIGHT_LAYERS, light)?,
            data: gpu.zeroed(DATA_LAYERS, data)?,
            groups: gpu.zeroed(GROUP_LAYERS, groups)?,
            group_names,
        })
    }

    /// Reads the layers that a scene asks for, in the order of [`Layer::ALL`]. Blocks.
    pub fn read(&self, gpu: &Gpu, scene: &Scene, samples: &SampleSums) -> Result<Vec<LayerImage>, Error> {
        let wanted = &scene.output.layers;
        let pixels = samples.all.len() as u64;
        let counts = samples.counts().collect();
        let mut sums = ReadSums { light: Vec::new(), data: Vec::new(), groups: Vec::new(), counts, samples };
        if has_light_layers(wanted) {
            sums.light = gpu.read(&self.light, 0..pixels * u64::from(light_layer::COUNT))?;
        }
        if !self.group_names.is_empty() {
            sums.groups = gpu.read(&self.groups, 0..pixels * group_sums(self.group_names.len()))?;
        }
        if has_data_layers(wanted) {
            sums.data = gpu.read(&self.data, 0..pixels)?;
        }
        let mut images = Vec::new();
        for layer in Layer::ALL.into_iter().filter(|layer| wanted.contains(layer)) {
            match layer {
                Layer::LightGroups => images.extend(self.group_images(&sums)),
                layer => images.push(LayerImage { name: layer.name().into(), channels: sums.channels(layer, scene) }),
            }
        }
        Ok(images)
    }

    /// The light and the caustic of each group, and the light without group.
    fn group_images(&self, sums: &ReadSums<'_>) -> Vec<LayerImage> {
        let names = |kind: &'static str| self.group_names.iter().map(move |name| format!("{kind}_{name}"));
        let names = names("light").chain(names("caustic")).chain([format!("light_{BACKGROUND_GROUP}")]);
        let stride = group_sums(self.group_names.len()) as usize;
        let count = if self.group_names.is_empty() { 0 } else { stride };
        let image = |(place, name)| LayerImage { name, channels: sums.means(&sums.groups, place, stride) };
        names.enumerate().take(count).map(image).collect()
    }
}

/// The sums of layers, read from the device.
struct ReadSums<'s> {
    light: Vec<[f32; 4]>,
    data: Vec<DataLayers>,
    groups: Vec<[f32; 4]>,
    /// Samples of each pixel.
    counts: Vec<u32>,
    samples: &'s SampleSums,
}

impl ReadSums<'_> {
    fn channels(&self, layer: Layer, scene: &Scene) -> Vec<LayerChannel> {
        let (objects, materials) = (scene.objects.len(), scene.materials.len());
        match layer {
            // These are images of their own.
            Layer::LightGroups => Vec::new(),
            Layer::Emission | Layer::Direct | Layer::Caustic | Layer::Indirect => {
                self.means(&self.light, light_sum(layer).unwrap_or(0) as usize, light_layer::COUNT as usize)
            }
            Layer::Albedo => {
                let means = self.data.iter().zip(&self.counts).map(|(sums, &count)| divided(sums.albedo, count as f32));
                vectors(["R", "G", "B"], means)
            }
            Layer::Normal => {
                let means = self.data.iter().zip(&self.counts).map(|(sums, &count)| divided(sums.normal, count as f32));
                vectors(["X", "Y", "Z"], means)
            }
            Layer::Position => {
                vectors(["X", "Y", "Z"], self.data.iter().map(|sums| divided(sums.position, sums.surfaces)))
            }
            Layer::Depth => vec![channel("Z", LayerValues::Float(self.data.iter().map(depth).collect()))],
            Layer::ObjectId => self.ids(|sums| sums.object, objects),
            Layer::MaterialId => self.ids(|sums| sums.material, materials),
            Layer::Samples => vec![channel("", LayerValues::Uint(self.counts.clone()))],
            Layer::Variance => {
                let squares: Vec<_> = self.data.iter().map(|sums| sums.squares).collect();
                vectors(["R", "G", "B"], self.samples.variances(&squares).into_iter())
            }
        }
    }

    /// The means of every `stride`-th of some sums of light, from `first` on.
    fn means(&self, sums: &[[f32; 4]], first: usize, stride: usize) -> Vec<LayerChannel> {
        let own = sums.iter().skip(first).step_by(stride).zip(&self.counts);
        vectors(["R", "G", "B"], own.map(|(&[r, g, b, _], &count)| divided([r, g, b], count as f32)))
    }

    /// Numbers from 1 of the scene's `count` objects or materials; 0 for those beyond, which are the surfaces of lights.
    fn ids(&self, id: impl Fn(&DataLayers) -> u32, count: usize) -> Vec<LayerChannel> {
        let of_scene = |id: u32| if id as usize <= count { id } else { 0 };
        vec![channel("", LayerValues::Uint(self.data.iter().map(|sums| of_scene(id(sums))).collect()))]
    }
}

/// Sums of each pixel for this many light groups: the light and the caustic of each, and light without group.
fn group_sums(groups: usize) -> u64 {
    2 * groups as u64 + 1
}

/// The mean distance along the view, over the samples that met a surface.
fn depth(sums: &DataLayers) -> f32 {
    if sums.surfaces > 0.0 { sums.depth / sums.surfaces } else { FARTHEST_DEPTH }
}

fn divided(sum: [f32; 3], count: f32) -> [f32; 3] {
    sum.map(|channel| channel / count.max(1.0))
}

fn channel(name: &'static str, values: LayerValues) -> LayerChannel {
    LayerChannel { name, values }
}

fn vectors(names: [&'static str; 3], pixels: impl Iterator<Item = [f32; 3]> + Clone) -> Vec<LayerChannel> {
    let component = |index: usize| LayerValues::Float(pixels.clone().map(|pixel| pixel[index]).collect());
    names.into_iter().enumerate().map(|(index, name)| channel(name, component(index))).collect()
}
