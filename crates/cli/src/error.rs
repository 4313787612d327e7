//! What can go wrong.

use std::path::PathBuf;

/// Why the command did not do what it was asked to.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The scene cannot be read.
    #[error(transparent)]
    Scene(#[from] diacaustic::scene::Error),
    /// The scene cannot be rendered, or the device failed.
    #[error(transparent)]
    Render(#[from] diacaustic::Error),
    /// There is no device, or it failed.
    #[error(transparent)]
    Device(#[from] diacaustic_headless::Error),
    /// A file cannot be written.
    #[error(transparent)]
    Output(#[from] diacaustic_output::Error),
    /// An experiment did not come about.
    #[error(transparent)]
    Experiment(#[from] diacaustic_experiment::Error),
    /// A floor is asked for where the scene file says what there is.
    #[error("{}: --floor goes with a glTF file; give a scene file a floor by an object of its own ([[objects]])", .0.display())]
    FloorOfSceneFile(PathBuf),
    /// What only a glTF file has is asked of a scene file.
    #[error("{}: --{option} goes with a glTF file; in a scene file, give its [[objects]] the key {option}", path.display())]
    GltfOption {
        /// The scene file.
        path: PathBuf,
        /// The option, without its dashes.
        option: &'static str,
    },
    /// A mesh is given in place of a scene.
    #[error("{}: this is a mesh, which has neither camera nor light: name it in a scene file (.toml), mesh = \"{}\"", .0.display(), .0.display())]
    MeshAsScene(PathBuf),
    /// Frames are asked for, and the scene is glTF.
    #[error("{}: --frames goes with a scene file (.toml) that has an [animation], and this is a glTF file", .0.display())]
    FramesOfGltf(PathBuf),
    /// A value of a scene file is to be changed, and the scene is glTF.
    #[error(
        "{}: --set {path} goes with a scene file (.toml), and this is a glTF file; write one that names it: mesh = \"{}\"",
        scene.display(), scene.display()
    )]
    OverrideOfGltf {
        /// The glTF file.
        scene: PathBuf,
        /// The keys of the first override.
        path: String,
    },
    /// A checkpoint is none, or of another render.
    #[error("{}: cannot go on from this checkpoint{of_scene}: {problem}", path.display())]
    Resume {
        /// The checkpoint.
        path: PathBuf,
        /// Of which scene it is, if that is known.
        of_scene: String,
        /// What is wrong.
        problem: String,
    },
    /// The program was asked to end before it was done.
    #[error("interrupted; what was rendered until then is written")]
    Interrupted {
        /// The number of the signal.
        signal: u8,
    },
    /// A bake was asked to end before it was done.
    #[error("interrupted; no lightmaps are written")]
    BakeInterrupted {
        /// The number of the signal.
        signal: u8,
    },
    /// An experiment was asked to end before it was done.
    #[error("interrupted; the page has {done} of {total} pictures")]
    ExperimentInterrupted {
        /// The number of the signal.
        signal: u8,
        /// Pictures that are there.
        done: usize,
        /// Pictures in all.
        total: usize,
    },
    /// The system does not say when the program is asked to end.
    #[error("signals cannot be watched for: {0}")]
    Signals(#[source] std::io::Error),
    /// The standard output takes nothing.
    #[error("the standard output cannot be written: {0}")]
    Print(#[source] std::io::Error),
    /// The manual cannot be written.
    #[error("{}: the manual cannot be written: {cause}", folder.display())]
    Manual {
        /// Its folder.
        folder: PathBuf,
        /// What the system says.
        cause: std::io::Error,
    },
    /// One file would be written over another.
    #[error("{}: named twice; name a file of its own for each output, and not the scene", .0.display())]
    NamedTwice(PathBuf),
}

impl Error {
    /// The exit status that tells what is at fault: 2, the arguments or the scene; 1, the device or a file; 128 and the signal's number where
    /// nothing is.
    pub fn exit_status(&self) -> u8 {
        use diacaustic::Error as Render;
        match self {
            Self::Scene(_) | Self::NamedTwice(_) | Self::FloorOfSceneFile(_) | Self::GltfOption { .. } => 2,
            Self::OverrideOfGltf { .. } | Self::FramesOfGltf(_) | Self::Resume { .. } | Self::MeshAsScene(_) => 2,
            Self::Interrupted { signal } | Self::BakeInterrupted { signal } => 128 + signal,
            Self::ExperimentInterrupted { signal, .. } => 128 + signal,
            Self::Render(Render::Scene(_) | Render::Surface(_) | Render::TooManyPhotons { .. }) => 2,
            Self::Output(diacaustic_output::Error::UnknownEnding(_)) => 2,
            Self::Experiment(error) => error.exit_status(),
            Self::Render(_)
            | Self::Device(_)
            | Self::Output(_)
            | Self::Signals(_)
            | Self::Print(_)
            | Self::Manual { .. } => 1,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_exit_status_tells_what_is_at_fault() {
        let scene = diacaustic::scene::load_scene(std::path::Path::new("missing.toml")).unwrap_err();
        assert_eq!(Error::from(scene).exit_status(), 2);
        assert_eq!(Error::from(diacaustic_output::Error::UnknownEnding("a".into())).exit_status(), 2);
        assert_eq!(Error::from(diacaustic_output::Error::IsFolder("a".into())).exit_status(), 1);
        assert_eq!(Error::from(diacaustic::Error::OutOfMemory(String::new())).exit_status(), 1);
    }
}
