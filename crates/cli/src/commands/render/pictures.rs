//! Pictures and their layers, as files.

use std::path::PathBuf;

use diacaustic::{LayerImage, LayerValues};
use diacaustic_output::{Channel, Display, Format, Picture, Values, write_exr_with_channels, write_png};

use crate::Error;

/// The warning about layers that no file takes.
pub(crate) const NO_LAYERS: &str =
    "no layers are written: output.layers asks for them, but no picture's name ends in .exr";

/// Whether some picture's format has layers.
pub(crate) fn can_hold_layers(paths: &[PathBuf]) -> bool {
    paths.iter().any(|path| matches!(Format::of(path), Ok(Format::Exr)))
}

/// Writes a picture in the formats that the files' endings stand for; OpenEXR holds its layers as well.
pub(crate) fn write_pictures(
    paths: &[PathBuf],
    picture: &Picture<'_>,
    layers: &[LayerImage],
    display: &Display,
) -> Result<(), Error> {
    let names = channel_names(layers);
    let values = layers.iter().flat_map(|layer| &layer.channels).map(|channel| match &channel.values {
        LayerValues::Float(values) => Values::Float(values),
        LayerValues::Uint(values) => Values::Uint(values),
    });
    let channels: Vec<_> = names.iter().zip(values).map(|(name, values)| Channel { name, values }).collect();
    for path in paths {
        match Format::of(path)? {
            Format::Exr => write_exr_with_channels(path, picture, &channels)?,
            Format::Png => write_png(path, picture, display)?,
        }
    }
    Ok(())
}

/// The names of all channels in OpenEXR: the layer's and the channel's, with a dot between.
fn channel_names(layers: &[LayerImage]) -> Vec<String> {
    let of_layer = |layer: &LayerImage| -> Vec<String> {
        let name =
            |channel: &str| if channel.is_empty() { layer.name.clone() } else { format!("{}.{channel}", layer.name) };
        layer.channels.iter().map(|channel| name(channel.name)).collect()
    };
    layers.iter().flat_map(of_layer).collect()
}
