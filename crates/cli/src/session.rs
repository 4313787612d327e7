//! A scene on a device: what every command that sends photons begins with.

mod chunks;
mod opening;
mod warnings;

use std::{
    ops::ControlFlow,
    time::{Duration, Instant},
};

use diacaustic::{
    Refinement, RenderState, Renderer, SceneReport, Stage,
    scene::{LoadedScene, Scene, Warning},
};
use diacaustic_headless::Gpu;

pub(crate) use self::opening::Opening;
use self::{
    chunks::{first_photons, in_chunks, photon_deadline, rounded_photons},
    opening::Opened,
    warnings::about_photons,
};
use crate::{
    Error,
    device::DeviceArguments,
    interruption::Interruption,
    progress::{Metric, Progress, Seconds},
    scene_arguments::SceneArguments,
};

/// Photons where the scene leaves their number open and no picture tells how many are enough.
const PHOTONS_WITHOUT_CAMERA: u64 = 1_000_000;

/// What every command that sends photons takes.
#[derive(Clone, Debug, PartialEq, clap::Args)]
pub struct SessionArguments {
    /// The scene.
    #[command(flatten)]
    pub scene: SceneArguments,

    /// The device.
    #[command(flatten)]
    pub device: DeviceArguments,

    /// Print nothing but errors
    #[arg(short, long)]
    pub quiet: bool,
}

/// Wall-clock time of each stage but those that the renderer measures.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Times {
    pub load: Duration,
    pub device: Duration,
    pub kernels: Duration,
    /// The hierarchy, the maps and the upload together.
    pub scene: Duration,
    pub photons: Duration,
    pub samples: Duration,
    pub write: Duration,
    pub total: Duration,
}

/// A scene on a device.
pub(crate) struct Session {
    pub progress: Progress,
    pub scene: Scene,
    pub gpu: Gpu,
    pub renderer: Renderer,
    pub built: SceneReport,
    pub time_limit_reached: bool,
    /// The picture's estimated error, relative to its radiance.
    pub error: Option<f64>,
    pub times: Times,
    pub interruption: Interruption,
    attendants: Vec<Box<dyn Attendant>>,
    /// What was said about the scene.
    warnings: Vec<Warning>,
}

/// What is done now and then while photons and samples come in.
pub(crate) trait Attendant {
    /// Is called after each chunk of work, about a second long at most in a usual scene.
    fn attend(&mut self, session: &mut Session) -> Result<(), Error>;
}

impl Session {
    /// Sets a scene, which took `load` to read, on a device that was opened meanwhile.
    ///
    /// # Errors
    /// If there is no device, or the scene cannot be rendered on it.
    pub fn open(
        arguments: &SessionArguments,
        opening: Opening,
        loaded: LoadedScene,
        load: Duration,
    ) -> Result<Self, Error> {
        let progress = Progress::new(arguments.quiet);
        let LoadedScene { scene, warnings } = loaded;
        let interruption = Interruption::watch().map_err(Error::Signals)?;
        let Opened { gpu, mut renderer, device, kernels } = progress.spin("device", || opening.finish())?;
        let mut times = Times { load, device, kernels, ..Times::default() };
        let opened = Seconds(device + kernels);
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
        Ok(Self {
            progress,
            scene,
            gpu,
            renderer,
            built,
            time_limit_reached: false,
            error: None,
            times,
            interruption,
            attendants: Vec::new(),
            warnings,
        })
    }

    /// Sets another scene on the same device, and forgets what attends.
    ///
    /// # Errors
    /// If it cannot be rendered.
    pub fn set_scene(&mut self, loaded: LoadedScene, load: Duration) -> Result<(), Error> {
        let start = Instant::now();
        self.built = self.progress.spin("bvh", || self.renderer.set_scene(&loaded.scene))?;
        self.times = Times { load, scene: start.elapsed(), ..Times::default() };
        self.gpu.check()?;
        (self.scene, self.warnings) = (loaded.scene, loaded.warnings);
        (self.time_limit_reached, self.error) = (false, None);
        self.attendants.clear();
        Ok(())
    }

    /// Lets something attend to the work from now on.
    pub fn engage(&mut self, attendant: impl Attendant + 'static) {
        self.attendants.push(Box::new(attendant));
    }

    /// Goes on from a saved state.
    ///
    /// # Errors
    /// If it is of another render, or the device fails.
    pub fn restore(&mut self, state: &RenderState) -> Result<(), Error> {
        Ok(self.renderer.restore_state(state)?)
    }

    /// Looks after everything that goes on beside a chunk of work, and whether to go on.
    fn after_chunk(&mut self) -> Result<ControlFlow<()>, Error> {
        self.renderer.wait()?;
        self.gpu.check()?;
        let mut attendants = std::mem::take(&mut self.attendants);
        let attended = attendants.iter_mut().try_for_each(|attendant| attendant.attend(self));
        self.attendants = attendants;
        attended?;
        Ok(if self.interruption.signal().is_some() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) })
    }

    /// Emits the scene's photons for maps that no picture is rendered of, and says why if no caustic came of them.
    ///
    /// # Errors
    /// If the device fails, or an attendant does.
    pub fn emit_photons(&mut self, deadline: Option<Instant>) -> Result<(), Error> {
        let photons = self.scene.settings.photons.unwrap_or(PHOTONS_WITHOUT_CAMERA);
        if self.built.photon_turns > 0 && photons > 0 {
            let turns = self.built.photon_turns;
            let total = rounded_photons(photons, turns);
            let deadline = deadline.map(|deadline| photon_deadline(Instant::now(), deadline));
            let mut counter = self.progress.count("photons", 0, total);
            let mut done = 0;
            in_chunks(0..total, first_photons(turns), deadline, |numbers| {
                done = numbers.end;
                self.renderer.emit_photons(numbers)?;
                counter.set(done);
                self.after_chunk()
            })?;
            self.time_limit_reached |= done < total && self.interruption.signal().is_none();
            self.times.photons = counter.finish(done);
        }
        self.warn_about_photons()
    }

    /// Renders on until the scene's numbers of photons and samples, or its target error, are reached, time is up or a signal comes; says why if no
    /// caustic came of the photons. There is one sample at least.
    ///
    /// # Errors
    /// If the device fails, or an attendant does.
    pub fn refine(&mut self, deadline: Option<Instant>) -> Result<(), Error> {
        let photon_deadline = deadline.map(|deadline| photon_deadline(Instant::now(), deadline));
        let mut refinement = self.renderer.refinement()?;
        let mut stage = refinement.stage;
        if stage != Stage::Photons {
            self.warn_about_photons()?;
        }
        let mut meter = self.progress.measure(name(stage));
        while refinement.stage != Stage::Done {
            if stage == Stage::Photons && refinement.stage == Stage::Samples {
                self.times.photons = meter.finish(&so_far(stage, &refinement));
                self.warn_about_photons()?;
                meter = self.progress.measure(name(Stage::Samples));
            }
            stage = refinement.stage;
            let start = Instant::now();
            refinement = self.renderer.refine()?;
            let is_interrupted = self.after_chunk()?.is_break();
            let next_end = Instant::now() + start.elapsed();
            let is_over = |deadline: Option<Instant>| deadline.is_some_and(|deadline| next_end > deadline);
            meter.set(&so_far(stage, &refinement));
            match refinement.stage {
                Stage::Photons if is_interrupted || refinement.photons > 0 && is_over(photon_deadline) => {
                    refinement = self.renderer.finish_photons()?;
                    self.time_limit_reached |= !is_interrupted;
                }
                Stage::Samples if refinement.samples > 0.0 && (is_interrupted || is_over(deadline)) => {
                    self.time_limit_reached |= !is_interrupted;
                    break;
                }
                _ => {}
            }
        }
        self.times.samples = meter.finish(&so_far(Stage::Samples, &refinement));
        self.error = refinement.error;
        Ok(())
    }

    /// Says why, if no caustic came of the photons.
    fn warn_about_photons(&self) -> Result<(), Error> {
        let counted = self.renderer.statistics()?;
        for warning in about_photons(&self.scene, &self.warnings, &self.built, &counted) {
            self.progress.warn(warning);
        }
        Ok(())
    }
}

fn name(stage: Stage) -> &'static str {
    if stage == Stage::Photons { "photons" } else { "samples" }
}

fn so_far(stage: Stage, refinement: &Refinement) -> String {
    if stage == Stage::Photons {
        return Metric(refinement.photons as f64).to_string().trim_end().to_owned();
    }
    let error = refinement.error.map_or(String::new(), |error| format!(", estimated error {:.1} %", 100.0 * error));
    format!("{:.1} a pixel{error}", refinement.samples)
}
