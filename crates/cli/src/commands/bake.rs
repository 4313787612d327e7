//! `diacaustic bake`: light out of the scene, as lightmaps and as glTF.

mod arguments;
mod colors;
mod geometry;
mod sizes;

use std::{
    path::{Path, PathBuf},
    time::Instant,
};

use diacaustic::{BakeOptions, Lightmap, scene::LoadedScene};
use diacaustic_output::{GltfScene, LightmapTexels, ObjectFolder, write_glb};

pub use self::arguments::BakeArguments;
use self::{
    colors::Colors,
    geometry::{BakedObject, Geometry},
    sizes::state_sizes,
};
use crate::{
    Error,
    commands::render::display,
    progress::{Progress, Seconds},
    session::{Opening, Session},
};

/// The file of the whole scene within the folder.
const SCENE_FILE: &str = "scene.glb";

/// Makes the lightmaps of the scene that the arguments name and writes them, and the scene with them. Blocks until all is done; says on
/// the standard error what happens.
///
/// # Errors
/// If the scene cannot be read or rendered, there is no device, a file cannot be written, or a signal ends the program, which then writes
/// nothing.
pub fn run(arguments: &BakeArguments) -> Result<(), Error> {
    let start = Instant::now();
    let progress = Progress::new(arguments.session.quiet);
    let opening = Opening::begin(&arguments.session.device);
    let loaded = load(arguments, progress)?;
    let path = arguments.output.clone().unwrap_or_else(|| default_folder(arguments));
    let mut folder = ObjectFolder::open(&path)?;
    let mut session = Session::open(&arguments.session, opening, loaded, start.elapsed())?;
    session.emit_photons(None)?;
    let objects = bake_objects(&mut session, arguments)?;
    let files = write_lightmaps(&session, &objects, &mut folder, &path, arguments.png)?;
    let scene_path = folder.path_of(SCENE_FILE);
    write_glb(&scene_path, &baked_scene(&session, &objects, &files))?;
    progress.say(format_args!(
        "wrote {} lightmap{} and {SCENE_FILE} into {} in {}",
        objects.len(),
        if objects.len() == 1 { "" } else { "s" },
        path.display(),
        Seconds(start.elapsed())
    ));
    Ok(())
}

fn default_folder(arguments: &BakeArguments) -> PathBuf {
    let mut name = arguments.session.scene.scene.file_stem().unwrap_or("scene".as_ref()).to_owned();
    name.push(".baked");
    PathBuf::from(name)
}

/// The scene, as it is baked: no camera is looked through, so that photons are not guided to what one shows, and no picture's layers kept.
fn load(arguments: &BakeArguments, progress: Progress) -> Result<LoadedScene, Error> {
    let mut loaded = arguments.session.scene.load_for_baking()?;
    for warning in &loaded.warnings {
        progress.warn(warning);
    }
    let scene = &mut loaded.scene;
    if !scene.output.layers.is_empty() {
        progress.warn("output.layers is for pictures; a lightmap's layers are its direct light, its caustic and its indirect light, of all light groups");
        scene.output.layers.clear();
    }
    let settings = &mut scene.settings;
    settings.photons = arguments.photons.or(settings.photons);
    settings.guiding = false;
    // Nothing is rendered; the smallest picture takes no memory.
    (settings.width, settings.height) = (1, 1);
    state_sizes(scene, arguments);
    Ok(loaded)
}

/// The lightmap of each receiver.
fn bake_objects(session: &mut Session, arguments: &BakeArguments) -> Result<Vec<(usize, Lightmap)>, Error> {
    let count = session.built.maps.len() as u64;
    let mut counter = session.progress.count("lightmaps", 0, count);
    let mut baked = Vec::new();
    let options = BakeOptions { samples: arguments.samples };
    for object in 0..session.scene.objects.len() {
        // Half of the lightmaps are of no use, so that nothing is written then.
        if let Some(signal) = session.interruption.signal() {
            return Err(Error::BakeInterrupted { signal });
        }
        if let Some(lightmap) = session.renderer.bake(object, &options)? {
            baked.push((object, lightmap));
            counter.set(baked.len() as u64);
        }
        session.gpu.check()?;
    }
    counter.finish(baked.len() as u64);
    Ok(baked)
}

/// Writes the lightmaps; returns the name of each one's file.
fn write_lightmaps(
    session: &Session,
    objects: &[(usize, Lightmap)],
    folder: &mut ObjectFolder,
    path: &Path,
    png: bool,
) -> Result<Vec<String>, Error> {
    let mut names = Vec::new();
    for (object, lightmap) in objects {
        let stem = folder.stem(&session.scene.objects[*object].name);
        let all: Vec<_> = (0..lightmap.direct.len()).map(|texel| lightmap.irradiance(texel)).collect();
        let texels = LightmapTexels {
            width: lightmap.width,
            height: lightmap.height,
            all: &all,
            parts: &[("direct", &lightmap.direct), ("caustic", &lightmap.caustic), ("indirect", &lightmap.indirect)],
        };
        let name = format!("{stem}.exr");
        texels.write_exr(&folder.path_of(&name))?;
        if png {
            texels.write_pngs(path, &stem, &display(&session.scene.output))?;
        }
        names.push(name);
    }
    Ok(names)
}

/// The scene with its lightmaps on its receivers.
fn baked_scene(session: &Session, objects: &[(usize, Lightmap)], files: &[String]) -> GltfScene {
    let scene = &session.scene;
    let colors = Colors::new(scene, display(&scene.output));
    let mut geometry = Geometry::new(scene);
    let mut baked = objects.iter().zip(files).peekable();
    for index in 0..scene.objects.len() {
        let lightmap = baked.next_if(|((object, _), _)| *object == index).and_then(|((_, lightmap), file)| {
            let layout = session.renderer.map_layout(index).ok().flatten()?;
            Some(BakedObject { lightmap, layout, file })
        });
        geometry.add(index, lightmap, &colors);
    }
    geometry.scene
}
