//! The arguments of the process: a command, or what `render` takes.

use std::{ffi::OsString, path::Path};

use clap::{Args as _, FromArgMatches as _, Subcommand as _, error::ErrorKind};

use crate::commands::{
    bake::BakeArguments,
    completions::{CompletionsArguments, ManArguments},
    experiment::ExperimentArguments,
    inspect::InspectArguments,
    render::RenderArguments,
};

const EXAMPLES: &str = "\
Examples:
  diacaustic teapot.toml
      renders with the scene's own settings and writes its files, or teapot.png; render may stand before the scene
  diacaustic teapot.toml --output teapot.exr --output teapot.png --photons 8_000_000
      writes the same picture in two formats, with a finer caustic
  diacaustic teapot.toml --set materials.glass.ior=1.9 --set camera.position='[0, 1, 2]'
      changes the scene without changing its file
  diacaustic teapot.toml --time-limit 60 --energy-maps maps --stats teapot.json
      stops after a minute; writes irradiance and statistics beside the picture
  diacaustic turntable.toml --frames 1..48 --output frames/turntable.png
      renders an animation as frames/turntable.0001.png to frames/turntable.0048.png
  diacaustic teapot.toml --checkpoint teapot.state --every 5min
      keeps how far it is; after a crash, the same with --resume teapot.state goes on to the same picture
  diacaustic vase.glb --floor
      renders a glTF file through its own camera and by its own lights, if it has any, on a floor
  diacaustic bake teapot.toml --size 1024
      writes lightmaps and the scene with them as teapot.baked/scene.glb
  diacaustic inspect teapot.toml
      tells what the scene holds and what it needs on the GPU, and which GPUs there are
  source <(diacaustic completions bash)
      completes the command line in this shell
  diacaustic experiment assets/experiments/paper.toml
      renders the tables of an experiment file and writes paper/index.html

Exit status: 0 when everything is written, 2 when the arguments or the scene are wrong, 1 when the device or a file fails, 130 after Ctrl-C,
which writes what there is; a second one ends the program at once.";

const BAKE_EXAMPLES: &str = "\
Examples:
  diacaustic bake teapot.toml --size 1024
      writes floor.exr and the other lightmaps, and scene.glb, into teapot.baked
  diacaustic bake house.glb --texels-per-metre 50 --png --output lightmaps
      writes lightmaps of one resolution everywhere, as pictures too";

const INSPECT_EXAMPLES: &str = "\
Examples:
  diacaustic inspect teapot.toml
      tells what the scene holds, what it takes on a GPU, and which GPUs there are
  diacaustic inspect teapot.toml --set render.map_size=2048 --device-memory 512MiB
      fails if that does not fit";

const EXPERIMENT_EXAMPLES: &str = "\
Examples:
  diacaustic experiment assets/experiments/paper.toml
      writes paper/index.html
  diacaustic experiment assets/experiments/paper.toml --set render.samples=4 --output quick
      writes a quick look at it to quick/index.html";

const COMPLETIONS_EXAMPLES: &str = "\
Examples:
  source <(diacaustic completions bash)
      completes the command line in this shell; in ~/.bashrc, in every one
  diacaustic completions fish > ~/.config/fish/completions/diacaustic.fish
      the same for fish";

const MAN_EXAMPLES: &str = "\
Examples:
  diacaustic man ~/.local/share/man/man1
      writes the pages; man diacaustic and man diacaustic-bake then show them";

/// Renders glass and the caustics that it casts.
///
/// Reads a scene, traces photons from its lights through glass and mirrors into energy maps, renders the picture on the GPU and
/// writes it.
#[derive(Clone, Debug, PartialEq, clap::Parser)]
#[command(name = "diacaustic", version, after_help = EXAMPLES, max_term_width = 110)]
#[command(args_conflicts_with_subcommands = true, subcommand_negates_reqs = true)]
pub enum Command {
    /// Render a scene and write its picture, energy maps and statistics; this is what happens without a command
    #[command(after_help = EXAMPLES)]
    Render(RenderArguments),
    /// Write the light on every receiver as a lightmap, and the scene with its light as glTF
    #[command(after_help = BAKE_EXAMPLES)]
    Bake(BakeArguments),
    /// Tell what a scene holds, without rendering it
    #[command(after_help = INSPECT_EXAMPLES)]
    Inspect(InspectArguments),
    /// Sweep over a scene: tables of pictures with figures, findings judged, all on one page
    #[command(after_help = EXPERIMENT_EXAMPLES)]
    Experiment(ExperimentArguments),
    /// Print what a shell needs to complete the command line
    #[command(after_help = COMPLETIONS_EXAMPLES)]
    Completions(CompletionsArguments),
    /// Write the manual's pages
    #[command(after_help = MAN_EXAMPLES)]
    Man(ManArguments),
}

impl Command {
    /// The program's interface: its commands, and the arguments of `render`, which need none.
    pub fn interface() -> clap::Command {
        // The commands come last, for the text about them tells what the program is.
        let render = RenderArguments::augment_args(clap::Command::new("diacaustic"));
        Self::augment_subcommands(render).subcommand_required(false).arg_required_else_help(false)
    }

    /// Reads the arguments of a process, the program's name first.
    ///
    /// # Errors
    /// If they are wrong, or ask for help or the version.
    pub fn parse(arguments: impl IntoIterator<Item = impl Into<OsString> + Clone>) -> Result<Self, clap::Error> {
        let arguments: Vec<OsString> = arguments.into_iter().map(Into::into).collect();
        let matches = Self::interface().try_get_matches_from(&arguments).map_err(|error| {
            // A command with a slip of the pen looks like a scene that another follows.
            if error.kind() == ErrorKind::ArgumentConflict && !is_scene(arguments.get(1)) {
                let commands = Self::augment_subcommands(clap::Command::new("diacaustic"));
                return commands.try_get_matches_from(&arguments).err().unwrap_or(error);
            }
            error
        })?;
        match matches.subcommand_name() {
            Some(_) => Self::from_arg_matches(&matches),
            None => RenderArguments::from_arg_matches(&matches).map(Self::Render),
        }
    }
}

/// Whether an argument may be a scene: a flag before one, a file, or a name with an ending.
fn is_scene(argument: Option<&OsString>) -> bool {
    argument.map(Path::new).is_none_or(|path| {
        path.as_os_str().as_encoded_bytes().starts_with(b"-") || path.extension().is_some() || path.exists()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(line: &str) -> Result<Command, clap::Error> {
        Command::parse(std::iter::once("diacaustic").chain(line.split_whitespace()))
    }

    #[test]
    fn the_interface_is_consistent() {
        Command::interface().debug_assert();
    }

    #[test]
    fn rendering_needs_no_command() {
        let flags = "a.toml --samples 3 --quiet";
        let bare = parse(flags).unwrap();
        assert_eq!(bare, parse(&format!("render {flags}")).unwrap());
        assert!(matches!(bare, Command::Render(arguments) if arguments.samples == Some(3)));
        assert!(matches!(parse("inspect a.toml"), Ok(Command::Inspect(_))));
    }

    #[test]
    fn a_misspelt_command_is_named() {
        let message = parse("inspekt a.toml").unwrap_err().render().to_string();
        assert!(message.contains("unrecognized subcommand 'inspekt'") && message.contains("'inspect'"), "{message}");
        let message = parse("a.toml b.toml").unwrap_err().render().to_string();
        assert!(!message.contains("unrecognized"), "{message}");
    }

    #[test]
    fn bad_flags_have_exit_status_2_and_help_has_0() {
        for bad in [
            "",
            "render",
            "inspect",
            "bake",
            "bake a.toml --size 9 --texels-per-metre 3",
            "a.toml b.toml",
            "a.toml --photon 3",
            "a.toml --samples x",
            "--quiet",
        ] {
            assert_eq!(parse(bad).unwrap_err().exit_code(), 2, "{bad:?}");
        }
        let help = parse("--help").unwrap_err();
        assert_eq!((help.exit_code(), help.use_stderr()), (0, false));
        assert!(help.render().to_string().contains("diacaustic teapot.toml --time-limit 60"));
    }

    #[test]
    fn every_command_has_examples() {
        for command in Command::interface().get_subcommands_mut() {
            let (name, help) = (command.get_name().to_owned(), command.render_long_help().to_string());
            let examples = help.split("Examples:").nth(1).unwrap_or_default();
            assert!(examples.contains("  diacaustic ") || examples.contains("(diacaustic "), "{name}: {help}");
        }
    }
}
