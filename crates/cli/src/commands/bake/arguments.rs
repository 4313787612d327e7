//! The arguments of `diacaustic bake`.

use std::path::PathBuf;

use crate::{
    SessionArguments,
    numbers::{parse_density, parse_photons, parse_samples, parse_size},
};

/// What `bake` takes.
#[derive(Clone, Debug, PartialEq, clap::Args)]
pub struct BakeArguments {
    /// The scene and how it is read.
    #[command(flatten)]
    pub session: SessionArguments,

    /// The folder to write: a lightmap for each receiver and the scene with them as scene.glb; created where it is missing
    ///
    /// Without this option, NAME.baked in the current folder.
    #[arg(short, long = "output", value_name = "DIR")]
    pub output: Option<PathBuf>,

    /// Write every lightmap as PNG too: a white matt surface in its light, exposed as the scene says
    #[arg(long)]
    pub png: bool,

    /// Texels along the longer side of every lightmap, in place of the scene's map_size (512 where it states none)
    #[arg(long, value_name = "N", value_parser = parse_size, allow_negative_numbers = true, conflicts_with = "texels_per_metre")]
    pub size: Option<u32>,

    /// Texels for each metre of surface, on average over each lightmap, in place of the scene's map_size
    #[arg(long, value_name = "N", value_parser = parse_density, allow_negative_numbers = true)]
    pub texels_per_metre: Option<f32>,

    /// Paths that begin at each texel, for light from lights and from other surfaces
    #[arg(long, value_name = "N", value_parser = parse_samples, allow_negative_numbers = true, default_value = "64")]
    pub samples: u32,

    /// Photons in all, such as 1_000_000, in place of the scene's number; rounded up as by render
    #[arg(long, value_name = "N", value_parser = parse_photons, allow_negative_numbers = true)]
    pub photons: Option<u64>,
}
