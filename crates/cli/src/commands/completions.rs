//! `diacaustic completions` and `diacaustic man`: what shells and manuals know of the command.

use std::path::PathBuf;

use crate::{Command, Error, print};

/// What `completions` takes.
#[derive(Clone, Debug, PartialEq, clap::Args)]
pub struct CompletionsArguments {
    /// The shell
    #[arg(value_enum)]
    pub shell: clap_complete::Shell,
}

/// Prints the completions of a shell on the standard output.
///
/// # Errors
/// If they cannot be written.
pub fn run(arguments: &CompletionsArguments) -> Result<(), Error> {
    let mut script = Vec::new();
    clap_complete::generate(arguments.shell, &mut Command::interface(), "diacaustic", &mut script);
    print(&script)
}

/// What `man` takes.
#[derive(Clone, Debug, PartialEq, clap::Args)]
pub struct ManArguments {
    /// The folder of the pages, such as /usr/local/share/man/man1; created where it is missing
    pub folder: PathBuf,
}

/// Writes the manual's pages, one for the program and one for each command.
///
/// # Errors
/// If they cannot be written.
pub fn write_manual(arguments: &ManArguments) -> Result<(), Error> {
    let folder = &arguments.folder;
    let write = || {
        std::fs::create_dir_all(folder)?;
        clap_mangen::generate_to(Command::interface(), folder)
    };
    write().map_err(|cause| Error::Manual { folder: folder.clone(), cause })
}
