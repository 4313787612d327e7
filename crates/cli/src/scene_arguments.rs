//! What every command that takes a scene takes with it.

use std::path::{Path, PathBuf};

use diacaustic::scene::{
    Error as SceneError, GltfOptions, LoadedScene, Override, ReadOptions, SceneOptions, StudioOptions, load_gltf_scene,
    load_scene_with,
};

use crate::{Error, numbers::parse_seed};

/// A scene and how it is read.
#[derive(Clone, Debug, PartialEq, clap::Args)]
pub struct SceneArguments {
    /// The scene: a scene file (.toml) or a glTF file (.gltf, .glb)
    pub scene: PathBuf,

    /// A value in place of the scene file's, such as render.samples=64; repeatable
    ///
    /// KEY is a path with dots between its parts, VALUE is TOML: camera.position='[0, 1, 2]', materials.glass.ior=1.9,
    /// objects.teapot.material='"gold"'. In arrays, a part is a number from 0 or the name of an element: lights.0.flux=10.
    #[arg(long = "set", value_name = "KEY=VALUE", value_parser = parse_override)]
    pub overrides: Vec<Override>,

    /// Seed of every random number, in place of the scene's
    #[arg(long, value_name = "N", value_parser = parse_seed, allow_negative_numbers = true)]
    pub seed: Option<u32>,

    /// Lay a matt floor under a glTF file's scene, which catches its caustics
    #[arg(long)]
    pub floor: bool,

    /// Pose a glTF file's scene as its animation has it at this time
    #[arg(long, value_name = "SECONDS", allow_negative_numbers = true)]
    pub time: Option<f32>,

    /// The animation of a glTF file, by name or by number from 0; without it the first, if a time is given
    #[arg(long, value_name = "NAME")]
    pub animation: Option<String>,

    /// The material variant of a glTF file, by name
    #[arg(long, value_name = "NAME")]
    pub variant: Option<String>,

    /// Read files that a glTF or OBJ file names outside its own folder
    #[arg(long)]
    pub allow_outside: bool,
}

pub(crate) fn parse_override(text: &str) -> Result<Override, String> {
    Override::parse(text).map_err(|error| match error {
        // The argument is named before the message.
        SceneError::Override { problem, .. } => problem,
        other => other.to_string(),
    })
}

impl SceneArguments {
    /// Reads the scene.
    ///
    /// # Errors
    /// If it cannot be read, or is glTF and an argument is for scene files, or the other way round.
    pub fn load(&self) -> Result<LoadedScene, Error> {
        self.load_frame(None)
    }

    /// Reads the scene as [`Self::load`] does, also without a camera.
    ///
    /// # Errors
    /// As [`Self::load`].
    pub fn load_for_baking(&self) -> Result<LoadedScene, Error> {
        self.load_with(None, true)
    }

    /// Reads the scene as it is at a frame of its animation, or without any.
    ///
    /// # Errors
    /// As [`SceneArguments::load`], and if it has no animation.
    pub fn load_frame(&self, frame: Option<u32>) -> Result<LoadedScene, Error> {
        self.load_with(frame, false)
    }

    fn load_with(&self, frame: Option<u32>, may_lack_camera: bool) -> Result<LoadedScene, Error> {
        if has_ending(&self.scene, &["obj", "ply", "stl"]) {
            return Err(Error::MeshAsScene(self.scene.clone()));
        }
        let read = ReadOptions { allow_outside: self.allow_outside };
        if self.is_gltf() {
            if frame.is_some() {
                return Err(Error::FramesOfGltf(self.scene.clone()));
            }
            if let Some(first) = self.overrides.first() {
                return Err(Error::OverrideOfGltf { scene: self.scene.clone(), path: first.path() });
            }
            let Self { time, animation, variant, .. } = self.clone();
            let options = StudioOptions { floor: self.floor, file: GltfOptions { read, time, animation, variant } };
            let mut loaded = load_gltf_scene(&self.scene, &options)?;
            let settings = &mut loaded.scene.settings;
            settings.seed = self.seed.unwrap_or(settings.seed);
            return Ok(loaded);
        }
        if self.floor {
            return Err(Error::FloorOfSceneFile(self.scene.clone()));
        }
        let gltf_options = [
            ("time", self.time.is_some()),
            ("animation", self.animation.is_some()),
            ("variant", self.variant.is_some()),
        ];
        if let Some((option, _)) = gltf_options.iter().find(|(_, is_given)| *is_given) {
            return Err(Error::GltfOption { path: self.scene.clone(), option });
        }
        let mut overrides = self.overrides.clone();
        // Each frame may have a seed of its own that begins with it.
        overrides.extend(self.seed.map(|seed| Override::parse(&format!("render.seed={seed}"))).transpose()?);
        Ok(load_scene_with(&self.scene, &SceneOptions { overrides, frame, read, may_lack_camera })?)
    }

    /// Whether the scene is a glTF file by its name.
    pub fn is_gltf(&self) -> bool {
        has_ending(&self.scene, &["gltf", "glb"])
    }
}

/// Whether a file's name has one of some endings, in any case.
fn has_ending(path: &Path, endings: &[&str]) -> bool {
    path.extension().is_some_and(|ending| endings.iter().any(|known| ending.eq_ignore_ascii_case(known)))
}
