//! A scene on a device: what every command that sends photons begins with.

mod chunks;
mod warnings;

use std::time::{Duration, Instant};

use diacaustic::{
    Renderer, RendererOptions, SceneReport,
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
        Ok(Self { progress, scene, gpu, renderer, built, time_limit_reached: false, times, warnings })
    }

    /// Emits the scene's photons, and says why if no caustic came of them.
    pub fn emit_photons(&mut self, deadline: Option<Instant>) -> Result<(), Error> {
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
            self.times.photons = counter.finish(done);
        }
        let counted = self.renderer.statistics()?;
        for warning in about_photons(&self.scene, &self.warnings, &self.built, &counted) {
            self.progress.warn(warning);
        }
        Ok(())
    }

    /// Adds the scene's samples.
    pub fn add_samples(&mut self, deadline: Option<Instant>) -> Result<(), Error> {
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
        self.times.samples = counter.finish(done);
        Ok(())
    }
}
