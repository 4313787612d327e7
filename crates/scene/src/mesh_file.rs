//! Meshes from files that hold nothing else.

use std::{fs, path::Path};

use crate::{Error, Mesh, Warning};

/// A mesh from a PLY or STL file.
#[derive(Clone, Debug, PartialEq)]
pub struct MeshFile {
    /// The mesh, metres; without material slots.
    pub mesh: Mesh,
    /// What is odd about the file.
    pub warnings: Vec<Warning>,
}

/// The most triangles of a file, as of glTF files.
pub(crate) const MOST_TRIANGLES: usize = 1 << 27;

pub(crate) fn read_bytes(path: &Path) -> Result<Vec<u8>, Error> {
    fs::read(path).map_err(|cause| Error::Read { path: path.to_owned(), cause })
}

/// An error that says what is wrong with a file.
pub(crate) fn fault(path: &Path, problem: impl Into<String>) -> Error {
    Error::Mesh { path: path.to_owned(), problem: problem.into() }
}
