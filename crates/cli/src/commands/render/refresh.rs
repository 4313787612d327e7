//! Pictures while waiting: the files are refreshed as the render goes on.

use std::{
    path::PathBuf,
    time::{Duration, Instant},
};

use diacaustic_output::is_device_or_pipe;

use super::write_pictures_of;
use crate::{
    Error,
    session::{Attendant, Session},
};

/// Time until the first picture; each further one comes after twice the time of the one before.
const FIRST: Duration = Duration::from_millis(500);
/// The longest time between two pictures, unless they are dear.
const LONGEST: Duration = Duration::from_secs(60);
/// A picture may take this share of the time, as one in so many.
const DEAREST: u32 = 20;

/// Writes the picture now and then: while photons fly, one of a single sample.
#[derive(Clone, Debug)]
pub(super) struct Refresh {
    pictures: Vec<PathBuf>,
    last: Instant,
    wait: Duration,
}

impl Refresh {
    /// Refreshes those of the files that can be written more than once.
    pub fn new(pictures: &[PathBuf]) -> Self {
        let pictures = pictures.iter().filter(|path| !is_device_or_pipe(path)).cloned().collect();
        Self { pictures, last: Instant::now(), wait: FIRST }
    }

    fn write(&self, session: &mut Session) -> Result<(), Error> {
        if session.renderer.refinement()?.samples > 0.0 {
            return write_pictures_of(session, &self.pictures);
        }
        session.renderer.add_samples(1)?;
        let written = write_pictures_of(session, &self.pictures);
        session.renderer.restart_samples()?;
        written
    }
}

impl Attendant for Refresh {
    fn attend(&mut self, session: &mut Session) -> Result<(), Error> {
        if self.last.elapsed() < self.wait || self.pictures.is_empty() {
            return Ok(());
        }
        let start = Instant::now();
        match self.write(session) {
            // The last picture will tell whether the file can be written.
            Err(Error::Output(error)) => session.progress.warn(error),
            other => other?,
        }
        self.last = Instant::now();
        self.wait = (2 * self.wait).min(LONGEST).max(DEAREST * start.elapsed());
        Ok(())
    }
}
