//! A scene on a device: what every command that sends photons begins with.

mod chunks;
mod warnings;

use std::time::{Duration, Instant};

use diacaustic::{
    Refinement, Renderer, RendererOptions, SceneReport, Stage,
    scene::{LoadedScene, Scene, Warning},
};
use diacaustic_headless::{Gpu, OpenOptions};

use self::{
    chunks::{first_photons, in_chunks, photon_deadline, rounded_photons},
    warnings::about_photons,
};
use crate::{
    Error,
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
    /// What was said about the scene.
    warnings: Vec<Warning>,
}

impl Session {
    /// Opens the device and sets the scene on it. `times` go on from what is measured so far.
    ///
    /// # Errors
    /// If there is no device, or the scene cannot be rendered on it.
    pub fn open(progress: Progress, loaded: LoadedScene, mut times: Times) -> Result<Self, Error> {
        let LoadedScene { scene, warnings } = loaded;
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
        Ok(Self { progress, scene, gpu, renderer, built, time_limit_reached: false, error: None, times, warnings })
    }

    /// Emits the scene's photons for maps that no picture is rendered of, and says why if no caustic came of them.
    pub fn emit_photons(&mut self, deadline: Option<Instant>) -> Result<(), Error> {
        let photons = self.scene.settings.photons.unwrap_or(PHOTONS_WITHOUT_CAMERA);
        if self.built.photon_turns > 0 && photons > 0 {
            let turns = self.built.photon_turns;
            let total = rounded_photons(photons, turns);
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
            self.times.photons = counter.finish(done);
        }
        self.warn_about_photons()
    }

    /// Renders until the scene's numbers of photons and samples, or its target error, are reached, or time is up; says why if no caustic came
    /// of the photons.
    pub fn refine(&mut self, deadline: Option<Instant>) -> Result<(), Error> {
        let photon_deadline = deadline.map(|deadline| photon_deadline(Instant::now(), deadline));
        let mut meter = self.progress.measure("photons");
        let mut stage = Stage::Photons;
        let mut refinement = self.renderer.refinement()?;
        while refinement.stage != Stage::Done {
            if stage == Stage::Photons && refinement.stage == Stage::Samples {
                self.times.photons = meter.finish(&photons_so_far(&refinement));
                self.warn_about_photons()?;
                meter = self.progress.measure("samples");
            }
            stage = refinement.stage;
            let start = Instant::now();
            refinement = self.renderer.refine()?;
            self.gpu.check()?;
            let next_end = Instant::now() + start.elapsed();
            let is_over = |deadline: Option<Instant>| deadline.is_some_and(|deadline| next_end > deadline);
            if refinement.stage == Stage::Photons && refinement.photons > 0 && is_over(photon_deadline) {
                refinement = self.renderer.finish_photons()?;
                self.time_limit_reached = true;
            } else if refinement.stage == Stage::Samples && refinement.samples > 0.0 && is_over(deadline) {
                self.time_limit_reached = true;
                break;
            }
            meter.set(&match stage {
                Stage::Photons => photons_so_far(&refinement),
                Stage::Samples | Stage::Done => samples_so_far(&refinement),
            });
        }
        self.times.samples = meter.finish(&samples_so_far(&refinement));
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

fn photons_so_far(refinement: &Refinement) -> String {
    Metric(refinement.photons as f64).to_string().trim_end().to_owned()
}

fn samples_so_far(refinement: &Refinement) -> String {
    let error = refinement.error.map_or(String::new(), |error| format!(", estimated error {:.1} %", 100.0 * error));
    format!("{:.1} a pixel{error}", refinement.samples)
}
