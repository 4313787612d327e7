//! Checkpoints: how far a render is, in a file from which another run goes on.

use std::{
    fs::File,
    io::BufReader,
    path::{Path, PathBuf},
    time::{Duration, Instant},
};

use diacaustic::RenderState;
use diacaustic_output::replace;

use crate::{
    Error,
    session::{Attendant, Session},
};

/// Writes a checkpoint now and then.
#[derive(Clone, Debug)]
pub(super) struct Checkpoints {
    path: PathBuf,
    every: Duration,
    /// The scene's file, by which messages call it.
    scene: String,
    last: Instant,
}

impl Checkpoints {
    pub fn new(path: &Path, every: Duration, scene: &Path) -> Self {
        Self { path: path.to_owned(), every, scene: scene.display().to_string(), last: Instant::now() }
    }

    /// Writes a checkpoint beside the last one, and puts it in its place.
    pub fn write(&self, session: &Session) -> Result<(), Error> {
        let mut state = session.renderer.save_state()?;
        state.note.clone_from(&self.scene);
        Ok(replace(&self.path, |file| state.write(file))?)
    }
}

impl Attendant for Checkpoints {
    fn attend(&mut self, session: &mut Session) -> Result<(), Error> {
        if self.last.elapsed() >= self.every {
            self.write(session)?;
            self.last = Instant::now();
        }
        Ok(())
    }
}

/// Reads a checkpoint.
///
/// # Errors
/// If it cannot be read, or is none.
pub(super) fn read_checkpoint(path: &Path) -> Result<RenderState, Error> {
    let refused = |problem: String| Error::Resume { path: path.to_owned(), of_scene: String::new(), problem };
    let file = File::open(path).map_err(|error| refused(format!("it cannot be read: {error}")))?;
    RenderState::read(BufReader::new(file)).map_err(|error| refused(error.to_string()))
}

/// Goes on from a checkpoint, which was read from `path`.
///
/// # Errors
/// If it is of another render, or is beyond what this one asks for.
pub(super) fn resume(session: &mut Session, path: &Path, state: &RenderState) -> Result<(), Error> {
    let refused = |problem: String| {
        let of_scene = if state.note.is_empty() { String::new() } else { format!(" of {}", state.note) };
        Error::Resume { path: path.to_owned(), of_scene, problem }
    };
    session.restore(state).map_err(|error| match error {
        Error::Render(cause) => refused(cause.to_string()),
        other => other,
    })?;
    let (photons, samples) = (state.photons(), state.samples());
    let settings = &session.scene.settings;
    // Rounded up for every light to have its turns.
    let wanted = settings.photons.map(|photons| photons.next_multiple_of(session.built.photon_turns.max(1)));
    let wanted = wanted.filter(|_| session.built.photon_turns > 0);
    let beyond = match (wanted, settings.samples) {
        (Some(wanted), _) if photons > wanted => {
            Some(format!("it holds {photons} photons, and {wanted} are asked for"))
        }
        (_, Some(wanted)) if samples > wanted => {
            Some(format!("it holds {samples} samples, and {wanted} are asked for"))
        }
        (Some(wanted), _) if samples > 0 && photons < wanted => Some(format!(
            "its samples are lit by {photons} photons, and {wanted} are asked for; give --photons {photons}"
        )),
        _ => None,
    };
    if let Some(problem) = beyond {
        return Err(refused(problem));
    }
    session.progress.say(format_args!("resumed {}: {photons} photons, {samples} samples", path.display()));
    Ok(())
}
