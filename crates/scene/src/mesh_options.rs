//! How meshes are read from OBJ, PLY and STL files.

use crate::ReadOptions;

/// How a mesh is read from an OBJ, PLY or STL file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeshOptions {
    /// What may be read.
    pub read: ReadOptions,
    /// Faces without normals that meet at less than this angle, degrees, look smooth where they meet; 0 leaves all facets flat.
    pub crease_angle: f32,
}

impl MeshOptions {
    /// The crease angle where none is stated, degrees.
    pub const CREASE_ANGLE: f32 = 30.0;
}

impl Default for MeshOptions {
    fn default() -> Self {
        ReadOptions::default().into()
    }
}

impl From<ReadOptions> for MeshOptions {
    fn from(read: ReadOptions) -> Self {
        Self { read, crease_angle: Self::CREASE_ANGLE }
    }
}
