//! The layers of the picture: what the camera pass keeps beside it, and how the application reads them. `docs/layers.md` says what they hold.

use diacaustic_scene::{Layer, Scene};
use diacaustic_shaders::{DataLayers, light_layer};

use crate::{
    Error,
    gpu::{Gpu, Purpose},
};

const LIGHT_LAYERS: Purpose =
    Purpose { what: "the picture's layers of light", remedy: "lower width or height, or write fewer layers" };
const DATA_LAYERS: Purpose =
    Purpose { what: "the picture's layers of data", remedy: "lower width or height, or write fewer layers" };

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
    layers.iter().any(|&layer| light_sum(layer).is_none() && layer != Layer::Samples)
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
}

impl LayerSums {
    /// Sums for the layers of a picture.
    pub fn new(gpu: &Gpu, layers: &[Layer], pixels: u64) -> Result<Self, Error> {
        let count = |wanted: bool| if wanted { pixels } else { 1 };
        let light = count(has_light_layers(layers)) * u64::from(light_layer::COUNT) * 16;
        let data = count(has_data_layers(layers)) * size_of::<DataLayers>() as u64;
        Ok(Self { light: gpu.zeroed(LIGHT_LAYERS, light)?, data: gpu.zeroed(DATA_LAYERS, data)? })
    }

    /// Reads the layers that a scene asks for, in the order of [`Layer::ALL`]; `counts` are the samples of each pixel. Blocks.
    pub fn read(&self, gpu: &Gpu, scene: &Scene, counts: Vec<u32>) -> Result<Vec<LayerImage>, Error> {
        let wanted = &scene.output.layers;
        let pixels = counts.len() as u64;
        let mut sums = ReadSums { light: Vec::new(), data: Vec::new(), counts };
        if has_light_layers(wanted) {
            sums.light = gpu.read(&self.light, 0..pixels * u64::from(light_layer::COUNT))?;
        }
        if has_data_layers(wanted) {
            sums.data = gpu.read(&self.data, 0..pixels)?;
        }
        let in_order = Layer::ALL.into_iter().filter(|layer| wanted.contains(layer));
        Ok(in_order
            .map(|layer| LayerImage { name: layer.name().into(), channels: sums.channels(layer, scene) })
            .collect())
    }
}

/// The sums of layers, read from the device.
struct ReadSums {
    light: Vec<[f32; 4]>,
    data: Vec<DataLayers>,
    /// Samples of each pixel.
    counts: Vec<u32>,
}

impl ReadSums {
    fn channels(&self, layer: Layer, scene: &Scene) -> Vec<LayerChannel> {
        let (objects, materials) = (scene.objects.len(), scene.materials.len());
        match layer {
            Layer::Emission | Layer::Direct | Layer::Caustic | Layer::Indirect => {
                let sums = self.light.iter().skip(light_sum(layer).unwrap_or(0) as usize);
                let sums = sums.step_by(light_layer::COUNT as usize);
                let means = sums.zip(&self.counts).map(|(&[r, g, b, _], &count)| divided([r, g, b], count as f32));
                vectors(["R", "G", "B"], means)
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
                let variances = self.data.iter().zip(&self.counts).map(|(sums, &count)| variance_of_mean(sums, count));
                vectors(["R", "G", "B"], variances)
            }
        }
    }

    /// Numbers from 1 of the scene's `count` objects or materials; 0 for those beyond, which are the surfaces of lights.
    fn ids(&self, id: impl Fn(&DataLayers) -> u32, count: usize) -> Vec<LayerChannel> {
        let of_scene = |id: u32| if id as usize <= count { id } else { 0 };
        vec![channel("", LayerValues::Uint(self.data.iter().map(|sums| of_scene(id(sums))).collect()))]
    }
}

/// The mean distance along the view, over the samples that met a surface.
fn depth(sums: &DataLayers) -> f32 {
    if sums.surfaces > 0.0 { sums.depth / sums.surfaces } else { FARTHEST_DEPTH }
}

/// The variance of a mean of independent samples; 0 where it cannot be known, of a single one.
fn variance_of_mean(sums: &DataLayers, count: u32) -> [f32; 3] {
    divided(sums.squares, count as f32 * (count as f32 - 1.0))
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
