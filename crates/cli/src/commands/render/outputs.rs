//! What is written where, checked before anything is rendered.

use std::{
    collections::HashSet,
    ffi::OsString,
    path::{Path, PathBuf, absolute},
};

use diacaustic_output::{EnergyMapFolder, Format, check_writable};

use super::RenderArguments;
use crate::Error;

/// The files of a run.
#[derive(Debug)]
pub(crate) struct Outputs {
    /// Pictures; at least one.
    pub pictures: Vec<PathBuf>,
    pub statistics: Option<PathBuf>,
    pub energy_maps: Option<EnergyMapFolder>,
}

impl Outputs {
    /// The files that the arguments, else the scene, else the scene file's name choose; of a frame, with its number in them.
    ///
    /// Creates the energy maps' folder if it is missing.
    ///
    /// # Errors
    /// If a picture's ending stands for no format, a file is named twice, or one cannot be written.
    pub fn choose(arguments: &RenderArguments, of_scene: &[PathBuf], frame: Option<u32>) -> Result<Self, Error> {
        let pictures = match (arguments.outputs.as_slice(), of_scene) {
            ([], []) => vec![default_picture(&arguments.session.scene.scene)],
            ([], files) => files.to_vec(),
            (files, _) => files.to_vec(),
        };
        let pictures: Vec<_> = pictures.into_iter().map(|path| numbered(path, frame)).collect();
        let statistics = arguments.stats.clone().map(|path| numbered(path, frame));
        let mut named = HashSet::from([comparable(&arguments.session.scene.scene)]);
        for path in &pictures {
            Format::of(path)?;
        }
        for path in pictures.iter().chain(&statistics).chain(&arguments.checkpoint) {
            if !named.insert(comparable(path)) {
                return Err(Error::NamedTwice(path.clone()));
            }
            check_writable(path)?;
        }
        let energy_maps = arguments.energy_maps.as_deref().map(EnergyMapFolder::open).transpose()?;
        Ok(Self { pictures, statistics, energy_maps })
    }
}

/// A name with the frame's number before its ending.
fn numbered(path: PathBuf, frame: Option<u32>) -> PathBuf {
    let Some(frame) = frame else { return path };
    let ending = path.extension().unwrap_or_default().to_owned();
    let mut number = OsString::from(format!("{frame:04}."));
    number.push(ending);
    path.with_extension(number)
}

fn default_picture(scene: &Path) -> PathBuf {
    let mut name = scene.file_stem().unwrap_or("picture".as_ref()).to_owned();
    let is_gltf_text = scene.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("gltf"));
    name.push(if is_gltf_text { ".render.png" } else { ".png" });
    PathBuf::from(name)
}

/// The same for two ways to write the path of one file that exists.
fn comparable(path: &Path) -> PathBuf {
    path.canonicalize().or_else(|_| absolute(path)).unwrap_or_else(|_| path.to_owned())
}

#[cfg(test)]
mod tests {
    use super::{super::arguments::tests::parse, *};

    fn choose(folder: &Path, flags: &[&str], of_scene: &[&str]) -> Result<Outputs, Error> {
        let scene = folder.join("a scene.toml").into_os_string();
        let in_folder = |flag: &&str| match flag.starts_with('-') {
            true => flag.into(),
            false => folder.join(flag).into_os_string(),
        };
        let line = [scene].into_iter().chain(flags.iter().map(in_folder));
        let of_scene: Vec<_> = of_scene.iter().map(|file| folder.join(file)).collect();
        Outputs::choose(&parse(line).unwrap(), &of_scene, None)
    }

    #[test]
    fn arguments_come_before_the_scene_and_its_name() {
        let folder = tempfile::tempdir().unwrap();
        let pictures = |flags: &[&str], of_scene: &[&str]| choose(folder.path(), flags, of_scene).unwrap().pictures;
        assert_eq!(pictures(&[], &[]), [Path::new("a scene.png")]);
        assert_eq!(pictures(&[], &["b.exr"]), [folder.path().join("b.exr")]);
        assert_eq!(
            pictures(&["--output", "c.png", "--output", "d.exr"], &["b.exr"]),
            ["c.png", "d.exr"].map(|name| folder.path().join(name))
        );
    }

    #[test]
    fn what_cannot_be_written_is_refused_before_rendering() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("a scene.toml"), "").unwrap();
        std::fs::write(folder.path().join("file"), "").unwrap();
        for (flags, status) in [
            (&["--output", "a.jpg"][..], 2),
            (&["--output", "missing/a.png"], 1),
            (&["--stats", "missing/a.json"], 1),
            (&["--energy-maps", "file"], 1),
            (&["--output", "a.png", "--output", "a.png"], 2),
            (&["--output", "a.png", "--stats", "a.png"], 2),
            (&["--stats", "a scene.toml"], 2),
            (&["--checkpoint", "a scene.toml"], 2),
            (&["--checkpoint", "missing/a.state"], 1),
        ] {
            let error = choose(folder.path(), flags, &[]).unwrap_err();
            assert_eq!(error.exit_status(), status, "{flags:?}: {error}");
        }
        assert_eq!(choose(folder.path(), &[], &["a.bmp"]).unwrap_err().exit_status(), 2);
    }

    #[test]
    fn frames_have_their_number_before_the_ending() {
        let numbers = [("a/b.png", Some(7)), ("b.c.exr", Some(12345)), ("b.png", None)];
        let names = numbers.map(|(path, frame)| numbered(path.into(), frame));
        assert_eq!(names, ["a/b.0007.png", "b.c.12345.exr", "b.png"].map(PathBuf::from));
    }

    #[test]
    fn the_maps_folder_is_created() {
        let folder = tempfile::tempdir().unwrap();
        let outputs = choose(folder.path(), &["--energy-maps", "x/maps", "--stats", "s.json"], &[]).unwrap();
        assert!(folder.path().join("x/maps").is_dir() && outputs.energy_maps.is_some());
        assert_eq!(outputs.statistics, Some(folder.path().join("s.json")));
    }
}
