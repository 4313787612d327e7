//! What diacaustic writes: pictures, energy maps and lightmaps as OpenEXR and PNG, scenes with their light as glTF, statistics as JSON.
//!
//! Every file is written beside its place and then moved there, so that a write that fails leaves what was there before. A
//! symbolic link stays and its target is replaced; a device or a pipe is written directly.
//!
//! ```
//! use diacaustic_output::{Display, Picture, Tone, write_picture};
//!
//! let folder = tempfile::tempdir()?;
//! let pixels = [[0.0, 0.5, 1.0], [4.0, 2.0, 0.0]];
//! let picture = Picture { width: 2, height: 1, pixels: &pixels };
//! let display = Display { exposure: -1.0, tone: Tone::Filmic };
//! write_picture(&folder.path().join("tiny.exr"), &picture, &display)?;
//! write_picture(&folder.path().join("tiny.png"), &picture, &display)?;
//! assert!(write_picture(&folder.path().join("tiny.gif"), &picture, &display).is_err());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod energy_maps;
mod error;
mod false_color;
mod gltf;
mod lightmaps;
mod object_folder;
mod open_exr;
mod picture;
mod png;
mod replace;
mod statistics;
mod tone;

pub use energy_maps::{EnergyMapFolder, Irradiance};
pub use error::Error;
pub use gltf::{GltfMaterial, GltfMesh, GltfPart, GltfScene, GltfSurface, LightmapNote, ShownPicture, write_glb};
pub use lightmaps::LightmapTexels;
pub use object_folder::ObjectFolder;
pub use open_exr::{Channel, Values, write_exr, write_exr_with_channels};
pub use picture::{Format, Picture, write_picture};
pub use png::{Display, write_png, write_rgb8};
pub use replace::{check_writable, is_device_or_pipe, replace, write_text};
pub use statistics::{
    Adapter, CameraRays, LightLedger, Map, Photons, SceneSize, Seconds, Statistics, write_statistics,
};
pub use tone::Tone;
