//! `diacaustic render`: from the scene to a picture.

mod arguments;
mod chart_borders;
mod checkpoint;
mod outputs;
mod pictures;
mod refresh;
mod report;

use std::{
    fmt,
    path::{Path, PathBuf},
    time::{Duration, Instant},
};

use diacaustic::scene::{LoadedScene, OutputSettings, Scene, ToneCurve, Warning};
use diacaustic_output::{Display, EnergyMapFolder, Irradiance, Picture, Tone, write_statistics};

pub use self::arguments::RenderArguments;
use self::{
    chart_borders::chart_borders,
    checkpoint::{Checkpoints, resume},
    outputs::Outputs,
    pictures::{NO_LAYERS, can_hold_layers, write_pictures},
    refresh::Refresh,
    report::Report,
};
use crate::{
    Error,
    progress::{Progress, Seconds},
    session::{Opening, Session},
};

/// Renders the scene that the arguments name, or frames of it, and writes the files that they ask for. Blocks until all is done; says on the
/// standard error what happens.
///
/// # Errors
/// If the scene cannot be read or rendered, there is no device, or a file cannot be written. What can be checked before
/// rendering is.
pub fn run(arguments: &RenderArguments) -> Result<(), Error> {
    let mut session = None;
    match arguments.frames.clone() {
        None => render(arguments, None, &mut session),
        Some(frames) => frames.into_iter().try_for_each(|frame| render(arguments, Some(frame), &mut session)),
    }
}

/// Renders one picture, on the device of the one before.
fn render(arguments: &RenderArguments, frame: Option<u32>, kept: &mut Option<Session>) -> Result<(), Error> {
    let start = Instant::now();
    let progress = Progress::new(arguments.session.quiet);
    let scene_arguments = &arguments.session.scene;
    let opening = kept.is_none().then(|| Opening::begin(&arguments.session.device));
    let mut loaded = scene_arguments.load_frame(frame)?;
    override_settings(&mut loaded.scene, arguments);
    let mut outputs = Outputs::choose(arguments, &loaded.scene.output.files, frame)?;
    warn(progress, arguments, &mut loaded, &outputs);
    let load = start.elapsed();

    let session = match kept {
        Some(session) => {
            session.set_scene(loaded, load)?;
            session
        }
        None => {
            let opening = opening.unwrap_or_else(|| Opening::begin(&arguments.session.device));
            kept.insert(Session::open(&arguments.session, opening, loaded, load)?)
        }
    };
    let checkpoints = arguments.checkpoint.as_deref();
    let checkpoints = checkpoints.map(|path| Checkpoints::new(path, arguments.every, &scene_arguments.scene));
    if let Some(path) = &arguments.resume {
        resume(session, path)?;
    }
    session.engage(Refresh::new(&outputs.pictures));
    checkpoints.iter().for_each(|checkpoints| session.engage(checkpoints.clone()));
    let deadline = arguments.time_limit.and_then(|limit| start.checked_add(limit));
    session.refine(deadline)?;

    let write_start = Instant::now();
    let maps = write(session, &mut outputs, frame)?;
    if let Some(checkpoints) = &checkpoints {
        checkpoints.write(session)?;
    }
    session.times.write = write_start.elapsed();
    session.times.total = start.elapsed();
    if let Some(path) = &outputs.statistics {
        write_report(session, path, &scene_arguments.scene)?;
    }
    progress.say(Written { outputs: &outputs, maps, time: start.elapsed() });
    match session.interruption.signal() {
        Some(signal) => Err(Error::Interrupted { signal }),
        None => Ok(()),
    }
}

fn override_settings(scene: &mut Scene, arguments: &RenderArguments) {
    let settings = &mut scene.settings;
    settings.photons = arguments.photons.or(settings.photons);
    settings.samples = arguments.samples.or(settings.samples);
    settings.target_error = arguments.target_error.unwrap_or(settings.target_error);
}

/// Says what is odd about the scene; layers that no file takes are left out.
fn warn(progress: Progress, arguments: &RenderArguments, loaded: &mut LoadedScene, outputs: &Outputs) {
    for warning in &loaded.warnings {
        progress.warn(warning);
    }
    if !loaded.scene.output.layers.is_empty() && !can_hold_layers(&outputs.pictures) {
        progress.warn(NO_LAYERS);
        loaded.scene.output.layers.clear();
    }
    if arguments.session.scene.is_gltf() && loaded.warnings.contains(&Warning::NoReceiver) {
        progress.warn("--floor adds a floor, which shows caustics");
    }
}

/// Writes pictures and energy maps; returns how many maps.
fn write(session: &Session, outputs: &mut Outputs, frame: Option<u32>) -> Result<usize, Error> {
    write_pictures_of(session, &outputs.pictures)?;
    match &mut outputs.energy_maps {
        Some(folder) => write_energy_maps(session, folder, frame),
        None => Ok(0),
    }
}

/// Writes the picture so far.
fn write_pictures_of(session: &Session, files: &[PathBuf]) -> Result<(), Error> {
    let film = session.renderer.film()?;
    let picture = Picture { width: film.width, height: film.height, pixels: &film.radiance };
    write_pictures(files, &picture, &session.renderer.layers()?, &display(&session.scene.output))
}

fn write_energy_maps(session: &Session, folder: &mut EnergyMapFolder, frame: Option<u32>) -> Result<usize, Error> {
    let mut count = 0;
    for (index, object) in session.scene.objects.iter().enumerate() {
        let Some(map) = session.renderer.energy_map(index)? else { continue };
        let texels: Vec<_> = map.resampled().into_iter().map(|texel| texel.as_vec3().to_array()).collect();
        let borders = session.renderer.map_layout(index)?.map_or_else(Vec::new, chart_borders);
        let irradiance = Irradiance { width: map.width, height: map.height, texels: &texels, chart_borders: &borders };
        let name = object.name.clone() + &frame.map(|frame| format!(".{frame:04}")).unwrap_or_default();
        folder.write(&name, &irradiance)?;
        count += 1;
    }
    Ok(count)
}

fn write_report(session: &Session, path: &Path, scene_file: &Path) -> Result<(), Error> {
    let report = Report {
        scene_file: scene_file.display().to_string(),
        scene: &session.scene,
        adapter: &session.gpu.adapter_info,
        built: &session.built,
        counted: &session.renderer.statistics()?,
        times: session.times,
        time_limit_reached: session.time_limit_reached,
        interrupted: session.interruption.signal().is_some(),
        error: session.error,
    };
    Ok(write_statistics(path, &report.statistics())?)
}

/// How the scene's pictures are exposed.
pub(crate) fn display(output: &OutputSettings) -> Display {
    let tone = match output.tone {
        ToneCurve::Plain => Tone::Plain,
        ToneCurve::Filmic => Tone::Filmic,
    };
    Display { exposure: output.exposure, tone }
}

/// The last line: what was written and in what time.
struct Written<'w> {
    outputs: &'w Outputs,
    maps: usize,
    time: Duration,
}

impl fmt::Display for Written<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let files = self.outputs.pictures.iter().chain(&self.outputs.statistics);
        let mut names: Vec<_> = files.map(|path| path.display().to_string()).collect();
        if self.outputs.energy_maps.is_some() {
            names.push(format!("{} energy map{}", self.maps, if self.maps == 1 { "" } else { "s" }));
        }
        write!(f, "wrote {} in {}", names.join(", "), Seconds(self.time))
    }
}
