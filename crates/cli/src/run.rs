//! One run of the command, from the scene file to the files written.

use std::{
    fmt,
    path::Path,
    time::{Duration, Instant},
};

use diacaustic::{
    Renderer, RendererOptions, SceneReport,
    scene::{
        GltfOptions, LoadedScene, OutputSettings, ReadOptions, Scene, StudioOptions, ToneCurve, Warning,
        load_gltf_scene, load_scene_with,
    },
};
use diacaustic_headless::{Gpu, OpenOptions};
use diacaustic_output::{Display, EnergyMapFolder, Irradiance, Picture, Tone, write_statistics};

use crate::{
    Arguments, Error,
    chunks::{first_photons, in_chunks, photon_deadline, rounded_photons},
    outputs::Outputs,
    pictures::{NO_LAYERS, can_hold_layers, write_pictures},
    progress::{Metric, Progress, Seconds},
    report::{Report, Times},
    warnings::about_photons,
};

/// Renders the scene that the arguments name and writes the files that they ask for. Blocks until all is done; says on the
/// standard error what happens.
///
/// # Errors
/// If the scene cannot be read or rendered, there is no device, or a file cannot be written. What can be checked before
/// rendering is.
pub fn run(arguments: &Arguments) -> Result<(), Error> {
    let start = Instant::now();
    let progress = Progress::new(arguments.quiet);
    let LoadedScene { mut scene, warnings } = load(arguments)?;
    override_settings(&mut scene, arguments);
    let mut outputs = Outputs::choose(arguments, &scene.output.files)?;
    for warning in &warnings {
        progress.warn(warning);
    }
    if !scene.output.layers.is_empty() && !can_hold_layers(&outputs.pictures) {
        progress.warn(NO_LAYERS);
        scene.output.layers.clear();
    }
    if is_gltf(&arguments.scene) && warnings.contains(&Warning::NoReceiver) {
        progress.warn("--floor adds a floor, which shows caustics");
    }
    let mut times = Times { load: start.elapsed(), ..Times::default() };

    let mut session = Session::open(progress, scene, warnings, &mut times)?;
    let deadline = arguments.time_limit.and_then(|limit| start.checked_add(limit));
    session.emit_photons(deadline, &mut times)?;
    session.add_samples(deadline, &mut times)?;

    let write_start = Instant::now();
    let maps = session.write(&mut outputs)?;
    times.write = write_start.elapsed();
    times.total = start.elapsed();
    if let Some(path) = &outputs.statistics {
        session.write_statistics(path, &arguments.scene, times)?;
    }
    progress.say(Written { outputs: &outputs, maps, time: start.elapsed() });
    Ok(())
}

fn load(arguments: &Arguments) -> Result<LoadedScene, Error> {
    let read = ReadOptions { allow_outside: arguments.allow_outside };
    if is_gltf(&arguments.scene) {
        let Arguments { time, animation, variant, .. } = arguments.clone();
        let file = GltfOptions { read, time, animation, variant };
        return Ok(load_gltf_scene(&arguments.scene, &StudioOptions { floor: arguments.floor, file })?);
    }
    if arguments.floor {
        return Err(Error::FloorOfSceneFile(arguments.scene.clone()));
    }
    let gltf_options = [
        ("time", arguments.time.is_some()),
        ("animation", arguments.animation.is_some()),
        ("variant", arguments.variant.is_some()),
    ];
    if let Some((option, _)) = gltf_options.iter().find(|(_, is_given)| *is_given) {
        return Err(Error::GltfOption { path: arguments.scene.clone(), option });
    }
    Ok(load_scene_with(&arguments.scene, read)?)
}

/// Whether a file is glTF by its name.
pub(crate) fn is_gltf(path: &Path) -> bool {
    path.extension().is_some_and(|ending| ["gltf", "glb"].iter().any(|known| ending.eq_ignore_ascii_case(known)))
}

fn override_settings(scene: &mut Scene, arguments: &Arguments) {
    let settings = &mut scene.settings;
    settings.photons = arguments.photons.unwrap_or(settings.photons);
    settings.samples = arguments.samples.unwrap_or(settings.samples);
    settings.seed = arguments.seed.unwrap_or(settings.seed);
}

/// A scene on a device.
struct Session {
    progress: Progress,
    scene: Scene,
    warnings: Vec<Warning>,
    gpu: Gpu,
    renderer: Renderer,
    built: SceneReport,
    time_limit_reached: bool,
}

impl Session {
    fn open(progress: Progress, scene: Scene, warnings: Vec<Warning>, times: &mut Times) -> Result<Self, Error> {
        let start = Instant::now();
        let gpu = progress.spin("device", || diacaustic_headless::open(&OpenOptions::default()))?;
        times.device = start.elapsed();
        let start = Instant::now();
        let options = RendererOptions::default();
        let mut renderer = progress.spin("kernels", || Renderer::new(&gpu.device, &gpu.queue, &options))?;
        times.kernels = start.elapsed();
        let opened = Seconds(times.device + times.kernels);
        progress.say(format_args!(
            "device: {} ({}) in {opened}",
            gpu.adapter_info.name,
            gpu.adapter_info.backend.to_str()
        ));

        let start = Instant::now();
        let built = progress.spin("bvh", || renderer.set_scene(&scene))?;
        times.scene = start.elapsed();
        progress.say(format_args!(
            "bvh: {} triangles, {} nodes; energy maps: {}; {}B on the device; in {}",
            built.triangles,
            built.bvh_nodes,
            built.maps.len(),
            Metric(built.device_bytes as f64),
            Seconds(times.scene)
        ));
        gpu.check()?;
        Ok(Self { progress, scene, warnings, gpu, renderer, built, time_limit_reached: false })
    }

    /// Emits the photons, and says why if no caustic came of them.
    fn emit_photons(&mut self, deadline: Option<Instant>, times: &mut Times) -> Result<(), Error> {
        if self.built.photon_turns > 0 && self.scene.settings.photons > 0 {
            let turns = self.built.photon_turns;
            let total = rounded_photons(self.scene.settings.photons, turns);
            let deadline = deadline.map(|deadline| photon_deadline(Instant::now(), deadline));
            let mut counter = self.progress.count("photons", total);
            let (renderer, gpu) = (&mut self.renderer, &self.gpu);
            let done = in_chunks(total, first_photons(turns), deadline, |numbers| {
                let end = numbers.end;
                renderer.emit_photons(numbers)?;
                renderer.wait()?;
                counter.set(end);
                Ok::<_, Error>(gpu.check()?)
            })?;
            self.time_limit_reached |= done < total;
            times.photons = counter.finish(done);
        }
        let counted = self.renderer.statistics()?;
        for warning in about_photons(&self.scene, &self.warnings, &self.built, &counted) {
            self.progress.warn(warning);
        }
        Ok(())
    }

    fn add_samples(&mut self, deadline: Option<Instant>, times: &mut Times) -> Result<(), Error> {
        let total = u64::from(self.scene.settings.samples);
        let mut counter = self.progress.count("samples", total);
        let (renderer, gpu) = (&mut self.renderer, &self.gpu);
        let done = in_chunks(total, 1, deadline, |numbers| {
            renderer.add_samples((numbers.end - numbers.start) as u32)?;
            renderer.wait()?;
            counter.set(numbers.end);
            Ok::<_, Error>(gpu.check()?)
        })?;
        self.time_limit_reached |= done < total;
        times.samples = counter.finish(done);
        Ok(())
    }

    /// Writes pictures and energy maps; returns how many maps.
    fn write(&self, outputs: &mut Outputs) -> Result<usize, Error> {
        let film = self.renderer.film()?;
        let picture = Picture { width: film.width, height: film.height, pixels: &film.radiance };
        write_pictures(&outputs.pictures, &picture, &self.renderer.layers()?, &display(&self.scene.output))?;
        match &mut outputs.energy_maps {
            Some(folder) => self.write_energy_maps(folder),
            None => Ok(0),
        }
    }

    fn write_energy_maps(&self, folder: &mut EnergyMapFolder) -> Result<usize, Error> {
        let mut count = 0;
        for (index, object) in self.scene.objects.iter().enumerate() {
            let Some(map) = self.renderer.energy_map(index)? else { continue };
            let texels: Vec<_> = map.resampled().into_iter().map(|texel| texel.as_vec3().to_array()).collect();
            folder.write(&object.name, &Irradiance { width: map.width, height: map.height, texels: &texels })?;
            count += 1;
        }
        Ok(count)
    }

    fn write_statistics(&self, path: &Path, scene_file: &Path, times: Times) -> Result<(), Error> {
        let report = Report {
            scene_file: scene_file.display().to_string(),
            scene: &self.scene,
            adapter: &self.gpu.adapter_info,
            built: &self.built,
            counted: &self.renderer.statistics()?,
            times,
            time_limit_reached: self.time_limit_reached,
        };
        Ok(write_statistics(path, &report.statistics())?)
    }
}

fn display(output: &OutputSettings) -> Display {
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
