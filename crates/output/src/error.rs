//! What can go wrong with a file.

use std::path::PathBuf;

/// Why a file is not written. Each message names the file; the system's or the encoder's reason is the source.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The ending of a picture's name stands for no known format.
    #[error("{}: the ending of a picture's file name chooses its format: it must be .exr or .png", .0.display())]
    UnknownEnding(PathBuf),
    /// The folder of a file does not exist.
    #[error("{}: there is no folder {}; create it or name another", path.display(), folder.display())]
    NoFolder {
        /// The file.
        path: PathBuf,
        /// Its folder.
        folder: PathBuf,
    },
    /// A folder stands where the file should be.
    #[error("{}: this is a folder; name a file", .0.display())]
    IsFolder(PathBuf),
    /// A folder cannot be made.
    #[error("{}: the folder cannot be created", path.display())]
    Create {
        /// The folder.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// A file cannot be written.
    #[error("{}: the file cannot be written", path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// What the system or the encoder says.
        source: Box<dyn std::error::Error + Send + Sync>,
    },
    /// A picture's pixels are not as many as its size says.
    #[error("{}: {width} × {height} pixels were announced and {found} were given", path.display())]
    Shape {
        /// The file.
        path: PathBuf,
        /// Pixels along x.
        width: u32,
        /// Pixels along y.
        height: u32,
        /// Pixels given.
        found: usize,
    },
}
