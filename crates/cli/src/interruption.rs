//! Signals that ask the program to end.

use std::{
    io,
    sync::{
        Arc,
        atomic::{AtomicI32, Ordering},
    },
    thread,
    time::{Duration, Instant},
};

use signal_hook::{
    consts::{SIGINT, SIGTERM},
    iterator::Signals,
    low_level,
};

/// What comes so soon after the first signal is the same request: `timeout`, for one, sends its signal to the program and then to its group.
const SAME_REQUEST: Duration = Duration::from_millis(200);

/// Whether Ctrl-C was pressed, or the program was asked to end in another way. The first such request lets the render stop and write what there
/// is; the second ends the program at once.
#[derive(Clone, Debug)]
pub(crate) struct Interruption {
    signal: Arc<AtomicI32>,
}

impl Interruption {
    /// Watches for signals from now on, on a thread of its own.
    pub fn watch() -> io::Result<Self> {
        let mut signals = Signals::new([SIGINT, SIGTERM])?;
        let watched = Self { signal: Arc::new(AtomicI32::new(0)) };
        let signal = Arc::clone(&watched.signal);
        let watch = move || {
            let mut first = None;
            for number in signals.forever() {
                if first.get_or_insert_with(Instant::now).elapsed() > SAME_REQUEST {
                    low_level::exit(128 + number);
                }
                signal.store(number, Ordering::SeqCst);
            }
        };
        thread::Builder::new().name("signals".to_owned()).spawn(watch)?;
        Ok(watched)
    }

    /// The number of the signal that came, if one did.
    pub fn signal(&self) -> Option<u8> {
        match self.signal.load(Ordering::SeqCst) {
            0 => None,
            number => Some(number as u8),
        }
    }
}
