//! The command line of diacaustic: reads a scene, renders it, writes pictures, energy maps and statistics.
//!
//! A library so that tests reach its parts; the binary `diacaustic` only calls [`main`].

mod arguments;
pub mod commands;
mod device;
mod error;
mod interruption;
mod numbers;
mod progress;
mod scene_arguments;
mod session;

use std::{
    error::Error as _,
    ffi::OsString,
    io::{self, Write as _},
    process::ExitCode,
};

pub use arguments::Command;
pub use device::DeviceArguments;
pub use error::Error;
pub use scene_arguments::SceneArguments;
pub use session::SessionArguments;

/// Runs the command with the arguments of a process, the program's name first, and reports errors on the standard error.
///
/// The exit status is 0 when everything is written, 2 when the arguments or the scene are wrong, and 1 when the device or
/// a file fails; 130 and 143 when Ctrl-C or a request to terminate ended it, after what there was is written. Blocks until then.
pub fn main(arguments: impl IntoIterator<Item = OsString>) -> ExitCode {
    let run = |command| match command {
        Command::Render(arguments) => commands::render::run(&arguments),
        Command::Bake(arguments) => commands::bake::run(&arguments),
        Command::Inspect(arguments) => commands::inspect::run(&arguments),
        Command::Completions(arguments) => commands::completions::run(&arguments),
        Command::Man(arguments) => commands::completions::write_manual(&arguments),
        Command::Experiment(arguments) => commands::experiment::run(&arguments),
    };
    let done = match Command::parse(arguments) {
        Ok(command) => run(command).map(|()| ExitCode::SUCCESS),
        Err(message) => show_usage(&message),
    };
    match done {
        Ok(status) => status,
        Err(error) => {
            show_error(&error);
            ExitCode::from(error.exit_status())
        }
    }
}

/// Shows what the argument parser has to say: help or the version, or what is wrong with the arguments. Returns the exit status.
fn show_usage(message: &clap::Error) -> Result<ExitCode, Error> {
    if message.use_stderr() {
        // Nobody is left to hear of a closed pipe, here and below.
        let _ = write!(io::stderr(), "diacaustic: {}", message.render());
    } else {
        print(message.render().to_string().as_bytes())?;
    }
    Ok(ExitCode::from(message.exit_code() as u8))
}

/// Writes text on the standard output. A closed pipe is no failure: its reader has seen enough.
pub(crate) fn print(text: &[u8]) -> Result<(), Error> {
    let mut output = io::stdout().lock();
    match output.write_all(text).and_then(|()| output.flush()) {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => Err(Error::Print(error)),
        _ => Ok(()),
    }
}

/// One line for the error and one for each that caused it.
fn show_error(error: &Error) {
    let _ = writeln!(io::stderr(), "diacaustic: error: {}", one_line(error));
    let mut cause = error.source();
    while let Some(error) = cause {
        let _ = writeln!(io::stderr(), "diacaustic: caused by: {}", one_line(error));
        cause = error.source();
    }
}

/// A message without its line breaks.
fn one_line(message: &(impl ToString + ?Sized)) -> String {
    message.to_string().split_whitespace().collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn messages_stay_on_one_line() {
        assert_eq!(one_line("a\n  b\r\n\tc "), "a b c");
    }
}
