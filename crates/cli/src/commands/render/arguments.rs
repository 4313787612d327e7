//! The arguments of `render`.

use std::{ops::RangeInclusive, path::PathBuf, time::Duration};

use crate::{
    numbers::{parse_frames, parse_photons, parse_samples, parse_seconds, parse_target_error},
    session::SessionArguments,
};

/// What `render` takes.
#[derive(Clone, Debug, PartialEq, clap::Args)]
pub struct RenderArguments {
    /// The scene and the device.
    #[command(flatten)]
    pub session: SessionArguments,

    /// A picture to write; repeatable. The ending chooses the format: .exr (32-bit float radiance) or .png
    ///
    /// Without this option, the files that the scene names are written; if it names none, a PNG with the scene file's name in the
    /// current folder (NAME.render.png for a .gltf file, whose own pictures may lie there).
    #[arg(short, long = "output", value_name = "FILE")]
    pub outputs: Vec<PathBuf>,

    /// Write statistics: a JSON of times, rays, photons and where the light went
    #[arg(long, value_name = "FILE")]
    pub stats: Option<PathBuf>,

    /// Write every object's energy map as an EXR, irradiance in W/m²; the folder is created where it is missing
    #[arg(long, value_name = "DIR")]
    pub energy_maps: Option<PathBuf>,

    /// Photons in all, such as 1_000_000, in place of the scene's number
    ///
    /// Rounded up to a multiple of the sum of the lights' photon shares, so that each sends its share exactly.
    #[arg(long, value_name = "N", value_parser = parse_photons, allow_negative_numbers = true)]
    pub photons: Option<u64>,

    /// Samples of each pixel, in place of the scene's number
    #[arg(long, value_name = "N", value_parser = parse_samples, allow_negative_numbers = true)]
    pub samples: Option<u32>,

    /// Error at which photons and samples are enough where their numbers are left open, such as 0.05 for 5 %
    ///
    /// In place of the scene's. The root of the mean squared error of pixels' radiance, relative to it.
    #[arg(long, value_name = "ERROR", value_parser = parse_target_error, allow_negative_numbers = true)]
    pub target_error: Option<f32>,

    /// Render frames A to B, both included, of the scene's animation into numbered files: NAME.0001.png
    ///
    /// Every file that is written has the frame's number before its ending. A frame is the same whether it is rendered alone or with others;
    /// --time-limit is that of each.
    #[arg(long, value_name = "A..B", value_parser = parse_frames, conflicts_with_all = ["checkpoint", "resume"])]
    pub frames: Option<RangeInclusive<u32>>,

    /// Keep in this file how far the render is, to go on from with --resume after a crash or another interruption
    #[arg(long, value_name = "FILE")]
    pub checkpoint: Option<PathBuf>,

    /// Time between two checkpoints, such as 30s, 5min or 1h; there is one at the end as well
    #[arg(long, value_name = "TIME", value_parser = humantime::parse_duration, default_value = "30s", requires = "checkpoint")]
    pub every: Duration,

    /// Go on from a checkpoint of the same scene, seed, version and GPU, to the same picture as a render that never stopped
    ///
    /// More samples than before may be asked for. --checkpoint may name the same file.
    #[arg(long, value_name = "FILE")]
    pub resume: Option<PathBuf>,

    /// Stop adding photons and samples after this time and write what there is
    ///
    /// Counted from the start of the program. Photons take at most half of what is left when they begin. There is always one batch
    /// of photons and one sample, however short the time.
    #[arg(long, value_name = "SECONDS", value_parser = parse_seconds, allow_negative_numbers = true)]
    pub time_limit: Option<Duration>,
}

#[cfg(test)]
pub(super) mod tests {
    use std::ffi::OsString;

    use clap::{Args as _, FromArgMatches as _};

    use super::*;
    use crate::{device::DeviceArguments, scene_arguments::SceneArguments};

    /// The arguments of a line, without the program's name.
    pub(crate) fn parse(line: impl IntoIterator<Item = impl Into<OsString>>) -> Result<RenderArguments, clap::Error> {
        let command = RenderArguments::augment_args(clap::Command::new("render").no_binary_name(true));
        let line: Vec<OsString> = line.into_iter().map(Into::into).collect();
        RenderArguments::from_arg_matches(&command.try_get_matches_from(line)?)
    }

    #[test]
    fn all_flags_are_read() {
        let read = parse(
            "a.toml --set render.width=8 --output a.exr --output a.png --stats s.json --energy-maps maps \
             --photons 1_000_000 --samples 8 --target-error 0.02 --seed 7 --time-limit 2.5 --floor --time -1.5 --animation walk --variant red --allow-outside --quiet \
             --adapter llvm --device-memory 1GiB --checkpoint c --every 1min --resume r"
                .split_whitespace(),
        );
        let expected = RenderArguments {
            session: SessionArguments {
                scene: SceneArguments {
                    scene: "a.toml".into(),
                    overrides: vec!["render.width=8".parse().unwrap()],
                    seed: Some(7),
                    floor: true,
                    time: Some(-1.5),
                    animation: Some("walk".into()),
                    variant: Some("red".into()),
                    allow_outside: true,
                },
                device: DeviceArguments { adapter: Some("llvm".parse().unwrap()), device_memory: Some(1 << 30) },
                quiet: true,
            },
            outputs: vec!["a.exr".into(), "a.png".into()],
            stats: Some("s.json".into()),
            energy_maps: Some("maps".into()),
            photons: Some(1_000_000),
            samples: Some(8),
            target_error: Some(0.02),
            frames: None,
            checkpoint: Some("c".into()),
            every: Duration::from_secs(60),
            resume: Some("r".into()),
            time_limit: Some(Duration::from_millis(2500)),
        };
        assert_eq!(read.unwrap(), expected);
        let bare = parse(["a.toml"]).unwrap();
        assert_eq!((bare.outputs.len(), bare.photons, bare.time_limit, bare.session.quiet), (0, None, None, false));
        assert!(parse(["a.toml", "--every", "1s"]).is_err(), "without a checkpoint");
        assert_eq!(parse(["a.toml", "--frames", "3..5"]).unwrap().frames, Some(3..=5));
        assert!(parse(["a.toml", "--frames", "3..5", "--checkpoint", "c"]).is_err());
    }
}
