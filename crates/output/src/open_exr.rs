//! Pictures as OpenEXR.

use std::path::Path;

use exr::prelude::{
    AnyChannel, AnyChannels, Compression, Encoding, FlatSamples, Image, Layer, LayerAttributes, LineOrder, Text,
    WritableImage as _,
};

use crate::{Error, Picture, replace::replace};

/// The comment in a picture's file.
const RADIANCE: &str = "radiance, W/(m^2 sr)";

/// Writes radiance, W/(m² sr), as OpenEXR: 32-bit float channels R, G, B, linear Rec. 709, compressed without loss (ZIP).
///
/// # Errors
/// If the pixels are not as many as the size says, or the file cannot be written.
pub fn write_exr(path: &Path, picture: &Picture<'_>) -> Result<(), Error> {
    write_layers(path, RADIANCE, &[("", *picture)])
}

/// A channel beside R, G and B.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Channel<'c> {
    /// Its name with that of its layer, such as `direct.R`.
    pub name: &'c str,
    /// Its values, row by row from the top left.
    pub values: Values<'c>,
}

/// The values of a channel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Values<'v> {
    /// Numbers, written as 32-bit floats.
    Float(&'v [f32]),
    /// Whole numbers, written as 32-bit unsigned integers.
    Uint(&'v [u32]),
}

/// Writes radiance as [`write_exr`] does, and further channels of the same size into the same part of the file.
///
/// # Errors
/// If the pixels or a channel's values are not as many as the size says, or the file cannot be written.
pub fn write_exr_with_channels(path: &Path, picture: &Picture<'_>, further: &[Channel<'_>]) -> Result<(), Error> {
    picture.check_shape(path)?;
    let mut list = Vec::from(channels("", picture.pixels));
    for channel in further {
        let samples = match channel.values {
            Values::Float(values) => FlatSamples::F32(values.to_vec()),
            Values::Uint(values) => FlatSamples::U32(values.to_vec()),
        };
        picture.check_count(path, samples.len())?;
        list.push(AnyChannel { quantize_linearly: false, ..AnyChannel::new(channel.name, samples) });
    }
    write_channels(path, RADIANCE, (picture.width as usize, picture.height as usize), list)
}

/// Writes pictures of one size, each with a prefix to the names of its channels: none, or one that ends in a dot.
pub(crate) fn write_layers(path: &Path, quantity: &str, layers: &[(&str, Picture<'_>)]) -> Result<(), Error> {
    let mut list = Vec::new();
    let mut size = (0, 0);
    for (prefix, picture) in layers {
        picture.check_shape(path)?;
        size = (picture.width as usize, picture.height as usize);
        list.extend(channels(prefix, picture.pixels));
    }
    write_channels(path, quantity, size, list)
}

/// Writes channels of one size, in the alphabetical order that the format asks for.
fn write_channels(
    path: &Path,
    quantity: &str,
    size: (usize, usize),
    list: Vec<AnyChannel<FlatSamples>>,
) -> Result<(), Error> {
    let attributes = LayerAttributes {
        comments: Text::new_or_none(quantity),
        software_name: Text::new_or_none(concat!("diacaustic ", env!("CARGO_PKG_VERSION"))),
        ..LayerAttributes::default()
    };
    let encoding = Encoding {
        compression: Compression::ZIP16,
        blocks: exr::image::Blocks::ScanLines,
        line_order: LineOrder::Increasing,
    };
    let image = Image::from_layer(Layer::new(size, attributes, encoding, AnyChannels::sort(list.into())));
    replace(path, |file| image.write().to_buffered(file))
}

fn channels(prefix: &str, pixels: &[[f32; 3]]) -> [AnyChannel<FlatSamples>; 3] {
    let mut index = 0;
    ["R", "G", "B"].map(|name| {
        let samples = pixels.iter().map(|pixel| pixel[index]).collect();
        index += 1;
        AnyChannel {
            quantize_linearly: false,
            ..AnyChannel::new(format!("{prefix}{name}").as_str(), FlatSamples::F32(samples))
        }
    })
}

#[cfg(test)]
mod tests {
    use exr::prelude::{ReadChannels as _, ReadLayers as _};

    use super::*;

    #[test]
    fn the_file_holds_the_floats() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("picture.exr");
        let pixels: Vec<[f32; 3]> = (0..40 * 30u8 as usize)
            .map(|i| [i as f32, -1e-30 * i as f32, if i == 7 { f32::INFINITY } else { 1e30 }])
            .collect();
        write_exr(&path, &Picture { width: 40, height: 30, pixels: &pixels }).unwrap();
        let read = exr::prelude::read()
            .no_deep_data()
            .largest_resolution_level()
            .rgb_channels(
                |size, _| vec![[0.0; 3]; size.area()],
                |all: &mut Vec<[f32; 3]>, at, (r, g, b): (f32, f32, f32)| all[at.y() * 40 + at.x()] = [r, g, b],
            )
            .first_valid_layer()
            .all_attributes()
            .from_file(&path)
            .unwrap();
        assert_eq!(read.layer_data.channel_data.pixels, pixels);
        assert_eq!(read.layer_data.attributes.comments, Text::new_or_none("radiance, W/(m^2 sr)"));
    }

    #[test]
    fn further_channels_stand_beside_the_picture() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("picture.exr");
        let picture = Picture { width: 2, height: 1, pixels: &[[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]] };
        let ids = Channel { name: "object_id", values: Values::Uint(&[7, u32::MAX]) };
        let depth = Channel { name: "depth.Z", values: Values::Float(&[0.5, 1e10]) };
        write_exr_with_channels(&path, &picture, &[ids, depth]).unwrap();
        let read = exr::prelude::read_first_flat_layer_from_file(&path).unwrap();
        let list = &read.layer_data.channel_data.list;
        let names: Vec<_> = list.iter().map(|channel| channel.name.to_string()).collect();
        assert_eq!(names, ["B", "G", "R", "depth.Z", "object_id"]);
        assert_eq!(list[3].sample_data, FlatSamples::F32(vec![0.5, 1e10]));
        assert_eq!(list[4].sample_data, FlatSamples::U32(vec![7, u32::MAX]));
        let short = Channel { name: "short", values: Values::Uint(&[1]) };
        assert!(matches!(write_exr_with_channels(&path, &picture, &[short]), Err(Error::Shape { found: 1, .. })));
    }

    #[test]
    fn a_folder_in_the_place_of_the_file_is_named() {
        let folder = tempfile::tempdir().unwrap();
        let picture = Picture { width: 1, height: 1, pixels: &[[1.0; 3]] };
        let message = write_exr(folder.path(), &picture).unwrap_err().to_string();
        assert!(message.starts_with(&folder.path().display().to_string()), "{message}");
    }
}
