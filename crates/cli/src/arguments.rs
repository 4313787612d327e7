//! The arguments.

use std::{path::PathBuf, time::Duration};

const EXAMPLES: &str = "\
Examples:
  diacaustic teapot.toml
      renders with the scene's own settings and writes its files, or teapot.png
  diacaustic teapot.toml --output teapot.exr --output teapot.png --photons 8_000_000
      writes the same picture in two formats, with a finer caustic
  diacaustic teapot.toml --time-limit 60 --energy-maps maps --stats teapot.json
      stops after a minute; writes irradiance and statistics beside the picture
  diacaustic vase.glb --floor
      renders a glTF file through its own camera and by its own lights, if it has any, on a floor

Exit status: 0 when everything is written, 2 when the arguments or the scene are wrong, 1 when the device or a file fails.
WGPU_BACKEND and WGPU_ADAPTER_NAME choose the GPU.";

/// Renders glass and the caustics that it casts.
///
/// Reads a scene, traces photons from its lights through glass and mirrors into energy maps, renders the picture on the GPU and
/// writes it.
#[derive(Clone, Debug, PartialEq, clap::Parser)]
#[command(name = "diacaustic", version, after_help = EXAMPLES, max_term_width = 110)]
pub struct Arguments {
    /// The scene: a scene file (.toml) or a glTF file (.gltf, .glb)
    pub scene: PathBuf,

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
    #[arg(long, value_name = "N", value_parser = parse_photons)]
    pub photons: Option<u64>,

    /// Samples of each pixel, in place of the scene's number
    #[arg(long, value_name = "N", value_parser = parse_samples)]
    pub samples: Option<u32>,

    /// Seed of every random number, in place of the scene's
    #[arg(long, value_name = "N", value_parser = parse_seed)]
    pub seed: Option<u32>,

    /// Stop adding photons and samples after this time and write what there is
    ///
    /// Counted from the start of the program. Photons take at most half of what is left when they begin. There is always one batch
    /// of photons and one sample, however short the time.
    #[arg(long, value_name = "SECONDS", value_parser = parse_seconds)]
    pub time_limit: Option<Duration>,

    /// Lay a matt floor under a glTF file's scene, which catches its caustics
    #[arg(long)]
    pub floor: bool,

    /// Pose a glTF file's scene as its animation has it at this time
    #[arg(long, value_name = "SECONDS", allow_negative_numbers = true)]
    pub time: Option<f32>,

    /// The animation of a glTF file, by name or by number from 0; without it the first, if a time is given
    #[arg(long, value_name = "NAME")]
    pub animation: Option<String>,

    /// The material variant of a glTF file, by name
    #[arg(long, value_name = "NAME")]
    pub variant: Option<String>,

    /// Read files that a glTF or OBJ file names outside its own folder
    #[arg(long)]
    pub allow_outside: bool,

    /// Print nothing but errors
    #[arg(short, long)]
    pub quiet: bool,
}

fn parse_photons(text: &str) -> Result<u64, String> {
    parse_whole(text, 0).map(u64::from)
}

fn parse_samples(text: &str) -> Result<u32, String> {
    parse_whole(text, 1)
}

fn parse_seed(text: &str) -> Result<u32, String> {
    parse_whole(text, 0)
}

/// A whole number in decimal digits, between which underscores may stand.
fn parse_whole(text: &str, least: u32) -> Result<u32, String> {
    let expected = || format!("expected a whole number from {least} to {}, such as 1000 or 1_000", u32::MAX);
    let digits_at_ends =
        [text.chars().next(), text.chars().last()].iter().all(|c| c.is_some_and(|c| c.is_ascii_digit()));
    let value: u32 = text.replace('_', "").parse().map_err(|_| expected())?;
    if digits_at_ends && value >= least { Ok(value) } else { Err(expected()) }
}

fn parse_seconds(text: &str) -> Result<Duration, String> {
    let expected = || "expected a number of seconds greater than 0, such as 60 or 2.5".to_owned();
    let seconds: f64 = text.parse().map_err(|_| expected())?;
    let duration = Duration::try_from_secs_f64(seconds).map_err(|_| expected())?;
    if duration.is_zero() { Err(expected()) } else { Ok(duration) }
}

#[cfg(test)]
mod tests {
    use clap::{CommandFactory as _, Parser as _};

    use super::*;

    fn parse(line: &str) -> Result<Arguments, clap::Error> {
        Arguments::try_parse_from(std::iter::once("diacaustic").chain(line.split_whitespace()))
    }

    #[test]
    fn the_command_is_consistent() {
        Arguments::command().debug_assert();
    }

    #[test]
    fn all_flags_are_read() {
        let read = parse(
            "a.toml --output a.exr --output a.png --stats s.json --energy-maps maps --photons 1_000_000 --samples 8 \
             --seed 7 --time-limit 2.5 --floor --time -1.5 --animation walk --variant red --allow-outside --quiet",
        );
        let expected = Arguments {
            scene: "a.toml".into(),
            outputs: vec!["a.exr".into(), "a.png".into()],
            stats: Some("s.json".into()),
            energy_maps: Some("maps".into()),
            photons: Some(1_000_000),
            samples: Some(8),
            seed: Some(7),
            time_limit: Some(Duration::from_millis(2500)),
            floor: true,
            time: Some(-1.5),
            animation: Some("walk".into()),
            variant: Some("red".into()),
            allow_outside: true,
            quiet: true,
        };
        assert_eq!(read.unwrap(), expected);
        let bare = parse("a.toml").unwrap();
        assert_eq!((bare.outputs.len(), bare.photons, bare.time_limit, bare.quiet), (0, None, None, false));
    }

    #[test]
    fn numbers_are_checked() {
        for bad in ["1e6", "-1", "+1", "_1", "1_", "", "1.5", "4294967296", "ten", "1 000"] {
            assert!(parse_photons(bad).is_err(), "{bad:?}");
        }
        assert_eq!((parse_photons("0"), parse_photons("4_294_967_295")), (Ok(0), Ok(u64::from(u32::MAX))));
        assert!(parse_samples("0").unwrap_err().contains("from 1 to"));
        for bad in ["0", "-1", "nan", "inf", "1e300", "1s", ""] {
            assert!(parse_seconds(bad).is_err(), "{bad:?}");
        }
    }

    #[test]
    fn bad_flags_have_exit_status_2_and_help_has_0() {
        for bad in ["", "a.toml b.toml", "a.toml --photon 3", "a.toml --samples x"] {
            assert_eq!(parse(bad).unwrap_err().exit_code(), 2, "{bad:?}");
        }
        let help = parse("--help").unwrap_err();
        assert_eq!((help.exit_code(), help.use_stderr()), (0, false));
        assert!(help.render().to_string().contains("diacaustic teapot.toml --time-limit 60"));
    }
}
