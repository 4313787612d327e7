//! A scene on a device: what every command that sends photons begins with.

mod chunks;
mod warnings;

use std::{
    ops::ControlFlow,
    time::{Duration, Instant},
};

use diacaustic::{
    RenderState, Renderer, SceneReport,
    scene::{LoadedScene, Scene, Warning},
};
use diacaustic_headless::Gpu;

use self::{
    chunks::{first_photons, in_chunks, photon_deadline, rounded_photons},
    warnings::about_photons,
};
use crate::{
    Error,
    device::DeviceArguments,
    interruption::Interruption,
    progress::{Metric, Progress, Seconds},
    scene_arguments::SceneArguments,
};

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
    pub times: Times,
    /// Photons emitted, over every light.
    pub photons: u64,
    /// Samples of each pixel.
    pub samples: u32,
    pub interruption: Interruption,
    attendants: Vec<Box<dyn Attendant>>,
    /// What was said about the scene.
    warnings: Vec<Warning>,
}

/// What is done now and then while photons and samples come in.
pub(crate) trait Attendant {
    /// Is called after each chunk of work, some tens of milliseconds or one sample long.
    fn attend(&mut self, session: &mut Session) -> Result<(), Error>;
}

impl Session {
    /// Opens the device and sets the scene on it, which took `load` to read.
    ///
    /// # Errors
    /// If there is no device, or the scene cannot be rendered on it.
    pub fn open(arguments: &SessionArguments, loaded: LoadedScene, load: Duration) -> Result<Self, Error> {
        let progress = Progress::new(arguments.quiet);
        let LoadedScene { scene, warnings } = loaded;
        let mut times = Times { load, ..Times::default() };
        let interruption = Interruption::watch().map_err(Error::Signals)?;
        let start = Instant::now();
        let gpu = progress.spin("device", || arguments.device.open())?;
        times.device = start.elapsed();
        let start = Instant::now();
        let options = arguments.device.renderer_options();
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
        Ok(Self {
            progress,
            scene,
            gpu,
            renderer,
            built,
            time_limit_reached: false,
            times,
            photons: 0,
            samples: 0,
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
        (self.photons, self.samples, self.time_limit_reached) = (0, 0, false);
        self.attendants.clear();
        Ok(())
    }

    /// Lets something attend to the work from now on.
    pub fn engage(&mut self, attendant: impl Attendant + 'static) {
        self.attendants.push(Box::new(attendant));
    }

    /// The photons that the scene asks for, over every light.
    pub fn wanted_photons(&self) -> u64 {
        match self.built.photon_turns {
            0 => 0,
            turns => rounded_photons(self.scene.settings.photons, turns),
        }
    }

    /// Goes on from a saved state.
    ///
    /// # Errors
    /// If it is of another render, or the device fails.
    pub fn restore(&mut self, state: &RenderState) -> Result<(), Error> {
        self.renderer.restore_state(state)?;
        self.photons = state.photons();
        self.samples = state.samples();
        Ok(())
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

    /// Emits the rest of the scene's photons, and says why if no caustic came of them.
    ///
    /// # Errors
    /// If the device fails, or an attendant does.
    pub fn emit_photons(&mut self, deadline: Option<Instant>) -> Result<(), Error> {
        let total = self.wanted_photons();
        if self.photons < total {
            let deadline = deadline.map(|deadline| photon_deadline(Instant::now(), deadline));
            let mut counter = self.progress.count("photons", self.photons, total);
            in_chunks(self.photons..total, first_photons(self.built.photon_turns), deadline, |numbers| {
                let end = numbers.end;
                self.renderer.emit_photons(numbers)?;
                self.photons = end;
                counter.set(end);
                self.after_chunk()
            })?;
            self.time_limit_reached |= self.photons < total && self.interruption.signal().is_none();
            self.times.photons = counter.finish(self.photons);
        }
        let counted = self.renderer.statistics()?;
        for warning in about_photons(&self.scene, &self.warnings, &self.built, &counted) {
            self.progress.warn(warning);
        }
        Ok(())
    }

    /// Adds the rest of the scene's samples; one at least, if there is none yet.
    ///
    /// # Errors
    /// If the device fails, or an attendant does.
    pub fn add_samples(&mut self, deadline: Option<Instant>) -> Result<(), Error> {
        let total = self.scene.settings.samples;
        if self.samples == total || self.samples > 0 && self.interruption.signal().is_some() {
            return Ok(());
        }
        let mut counter = self.progress.count("samples", self.samples.into(), total.into());
        in_chunks(self.samples.into()..total.into(), 1, deadline, |numbers| {
            self.renderer.add_samples((numbers.end - numbers.start) as u32)?;
            self.samples = numbers.end as u32;
            counter.set(numbers.end);
            self.after_chunk()
        })?;
        self.time_limit_reached |= self.samples < total && self.interruption.signal().is_none();
        self.times.samples = counter.finish(self.samples.into());
        Ok(())
    }
}
