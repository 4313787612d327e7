//! What of a glTF file is wanted.

use crate::ReadOptions;

/// What of a glTF file is read, and what it may name.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct GltfOptions {
    /// What may be read.
    pub read: ReadOptions,
    /// The time, in seconds, at which an animation poses the scene; without it and `animation` the scene is at rest.
    pub time: Option<f32>,
    /// The animation by its name, or by its number from 0; without it the first.
    pub animation: Option<String>,
    /// The material variant (KHR_materials_variants) by its name; without it, surfaces have the materials that they name themselves.
    pub variant: Option<String>,
}

impl From<ReadOptions> for GltfOptions {
    fn from(read: ReadOptions) -> Self {
        Self { read, ..Self::default() }
    }
}
