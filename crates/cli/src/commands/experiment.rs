//! `diacaustic experiment`: a sweep over a scene, as tables of pictures on one page.

use std::{path::PathBuf, time::Instant};

use diacaustic::{Renderer, RendererOptions, scene::Override};
use diacaustic_experiment::Experiment;
use diacaustic_headless::OpenOptions;

use crate::{
    Error,
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

    /// Print nothing but errors
    #[arg(short, long)]
    pub quiet: bool,
}

/// Renders the experiment and writes its page. Blocks until all is done; says on the standard error what happens.
///
/// # Errors
/// If the experiment or a scene of it cannot be read or rendered, there is no device, or a file cannot be written.
pub fn run(arguments: &ExperimentArguments) -> Result<(), Error> {
    let start = Instant::now();
    let progress = Progress::new(arguments.quiet);
    let mut experiment = Experiment::read(&arguments.experiment)?;
    experiment.overrides.extend(arguments.overrides.iter().cloned());
    let folder = arguments
        .output
        .clone()
        .unwrap_or_else(|| PathBuf::from(arguments.experiment.file_stem().unwrap_or("experiment".as_ref())));
    let gpu = progress.spin("device", || diacaustic_headless::open(&OpenOptions::default()))?;
    let mut renderer =
        progress.spin("kernels", || Renderer::new(&gpu.device, &gpu.queue, &RendererOptions::default()))?;
    let rendered = experiment.render(&mut renderer, |at| {
        progress.say(format_args!("picture {} of {}: {}", at.done + 1, at.total, at.name));
    })?;
    gpu.check()?;
    rendered.write(&experiment, &folder)?;
    progress.say(format_args!("wrote {} in {}", folder.join("index.html").display(), Seconds(start.elapsed())));
    Ok(())
}
