//! `diacaustic experiment`: a sweep over a scene, as tables of pictures on one page.

use std::{ops::ControlFlow, path::PathBuf, time::Instant};

use diacaustic::{Renderer, scene::Override};
use diacaustic_experiment::Experiment;

use crate::{
    DeviceArguments, Error,
    interruption::Interruption,
    progress::{Progress, Seconds},
    scene_arguments::parse_override,
};

/// What `experiment` takes.
#[derive(Clone, Debug, PartialEq, clap::Args)]
pub struct ExperimentArguments {
    /// The experiment file (.toml)
    pub experiment: PathBuf,

    /// The folder for the page, the contact sheet, the CSV and the pictures; created where it is missing
    ///
    /// Without this option, a folder with the experiment file's name in the current one.
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,

    /// A value in place of every picture's own, such as render.samples=4; repeatable
    #[arg(long = "set", value_name = "KEY=VALUE", value_parser = parse_override)]
    pub overrides: Vec<Override>,

    /// The device.
    #[command(flatten)]
    pub device: DeviceArguments,

    /// Print nothing but errors
    #[arg(short, long)]
    pub quiet: bool,
}

/// Renders the experiment and writes its page. Blocks until all is done; says on the standard error what happens.
///
/// # Errors
/// If the experiment or a scene of it cannot be read or rendered, there is no device, a file cannot be written, or a signal ends the program,
/// which then writes the page with the pictures that there are.
pub fn run(arguments: &ExperimentArguments) -> Result<(), Error> {
    let start = Instant::now();
    let progress = Progress::new(arguments.quiet);
    let mut experiment = Experiment::read(&arguments.experiment)?;
    experiment.overrides.extend(arguments.overrides.iter().cloned());
    let folder = arguments
        .output
        .clone()
        .unwrap_or_else(|| PathBuf::from(arguments.experiment.file_stem().unwrap_or("experiment".as_ref())));
    let gpu = progress.spin("device", || arguments.device.open())?;
    let options = arguments.device.renderer_options();
    let mut renderer = progress.spin("kernels", || Renderer::new(&gpu.device, &gpu.queue, &options))?;
    let interruption = Interruption::watch().map_err(Error::Signals)?;
    let mut ended = None;
    let rendered = experiment.render(&mut renderer, |at| {
        if let Some(signal) = interruption.signal() {
            ended = Some(Error::ExperimentInterrupted { signal, done: at.done, total: at.total });
            return ControlFlow::Break(());
        }
        progress.say(format_args!("picture {} of {}: {}", at.done + 1, at.total, at.name));
        ControlFlow::Continue(())
    })?;
    gpu.check()?;
    rendered.write(&experiment, &folder)?;
    progress.say(format_args!("wrote {} in {}", folder.join("index.html").display(), Seconds(start.elapsed())));
    ended.map_or(Ok(()), Err)
}
