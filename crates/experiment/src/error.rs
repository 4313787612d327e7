//! What can go wrong.

use std::{io, path::PathBuf};

/// Why an experiment did not come about. Each message names the file and the part of it at fault.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The experiment file cannot be read.
    #[error("{}: the file cannot be read: {cause}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// What the system says.
        cause: io::Error,
    },
    /// The experiment file is not TOML, or has keys or values that mean nothing.
    #[error("{}:{line}:{column}: {problem}", path.display())]
    Syntax {
        /// The file.
        path: PathBuf,
        /// The line, from 1.
        line: usize,
        /// The column in characters, from 1.
        column: usize,
        /// What is wrong.
        problem: String,
    },
    /// A part of the experiment makes no sense.
    #[error("{}: {part}: {problem}", path.display())]
    Invalid {
        /// The file.
        path: PathBuf,
        /// The table, finding or plot.
        part: String,
        /// What is wrong, and what would be right.
        problem: String,
    },
    /// The scene of a cell cannot be read.
    #[error("the scene of {cell}: {cause}")]
    Scene {
        /// The table, row, column and model.
        cell: String,
        /// Why.
        cause: Box<diacaustic::scene::Error>,
    },
    /// The scene of a cell cannot be rendered.
    #[error("the scene of {cell}: {cause}")]
    Render {
        /// The table, row, column and model.
        cell: String,
        /// Why.
        cause: Box<diacaustic::Error>,
    },
    /// A folder cannot be made.
    #[error("{}: the folder cannot be made: {cause}", path.display())]
    Folder {
        /// The folder.
        path: PathBuf,
        /// What the system says.
        cause: io::Error,
    },
    /// A file cannot be written.
    #[error(transparent)]
    Output(#[from] diacaustic_output::Error),
}

impl Error {
    /// The exit status that tells what is at fault: 2, the experiment or a scene; 1, the device or a file.
    pub fn exit_status(&self) -> u8 {
        use diacaustic::Error as Cause;
        match self {
            Self::Read { .. } | Self::Syntax { .. } | Self::Invalid { .. } | Self::Scene { .. } => 2,
            Self::Render { cause, .. } => match **cause {
                Cause::Scene(_) | Cause::Surface(_) | Cause::TooManyPhotons { .. } => 2,
                _ => 1,
            },
            Self::Folder { .. } | Self::Output(_) => 1,
        }
    }
}
