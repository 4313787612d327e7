//! What the user sees while the command works: bars on a terminal, plain lines elsewhere, nothing when quiet. All of it goes to
//! the standard error; nobody is left to hear of a closed pipe, so that failing to write is ignored.

use std::{
    fmt,
    io::{self, IsTerminal as _, Write as _},
    time::{Duration, Instant},
};

use indicatif::{ProgressBar, ProgressState, ProgressStyle};

/// Time between two lines about the same work where there are no bars.
const BETWEEN_LINES: Duration = Duration::from_secs(10);
/// Time between two steps of a spinner.
const SPINNER_STEP: Duration = Duration::from_millis(100);

/// How progress is shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Progress {
    Bars,
    Lines,
    Quiet,
}

impl Progress {
    pub fn new(quiet: bool) -> Self {
        match (quiet, io::stderr().is_terminal()) {
            (true, _) => Self::Quiet,
            (false, true) => Self::Bars,
            (false, false) => Self::Lines,
        }
    }

    /// Says something, unless quiet.
    pub fn say(self, line: impl fmt::Display) {
        if self != Self::Quiet {
            let _ = writeln!(io::stderr(), "{line}");
        }
    }

    /// Says that something is odd, unless quiet.
    pub fn warn(self, warning: impl fmt::Display) {
        self.say(format_args!("diacaustic: warning: {warning}"));
    }

    /// Does work that cannot tell how far it is.
    pub fn spin<T>(self, name: &'static str, work: impl FnOnce() -> T) -> T {
        let spinner = (self == Self::Bars).then(|| {
            let spinner = ProgressBar::new_spinner();
            spinner.set_style(style("{prefix:8} {spinner} {elapsed}"));
            spinner.set_prefix(name);
            spinner.enable_steady_tick(SPINNER_STEP);
            spinner
        });
        let result = work();
        if let Some(spinner) = spinner {
            spinner.finish_and_clear();
        }
        result
    }

    /// Begins work whose end is not known.
    pub fn measure(self, name: &'static str) -> Meter {
        let spinner = (self == Self::Bars).then(|| {
            let spinner = ProgressBar::new_spinner();
            spinner.set_style(style("{prefix:8} {spinner} {msg}"));
            spinner.set_prefix(name);
            spinner.enable_steady_tick(SPINNER_STEP);
            spinner
        });
        let now = Instant::now();
        Meter { progress: self, name, start: now, last_line: now, spinner }
    }

    /// Begins to count work of known length, of which some is done.
    pub fn count(self, name: &'static str, done: u64, total: u64) -> Counter {
        let bar = (self == Self::Bars).then(|| {
            let bar = ProgressBar::new(total);
            bar.set_style(style("{prefix:8} [{bar:32}] {percent:>3} %  {rate}/s  {left}"));
            bar.set_prefix(name);
            bar.set_position(done);
            bar.reset_eta();
            bar
        });
        let now = Instant::now();
        Counter { progress: self, name, before: done, total, start: now, last_line: now, bar }
    }
}

fn style(template: &str) -> ProgressStyle {
    let rate = |state: &ProgressState, out: &mut dyn fmt::Write| {
        let _ = write!(out, "{}", Metric(state.per_sec()));
    };
    let left = |state: &ProgressState, out: &mut dyn fmt::Write| {
        // Before the first step, nothing is known about the rest.
        if state.pos() > 0 {
            let _ = write!(out, "{} left", Seconds(state.eta()));
        }
    };
    ProgressStyle::with_template(template)
        .expect("the template is well formed")
        .with_key("rate", rate)
        .with_key("left", left)
        .progress_chars("=> ")
}

/// Counts work as it is done.
#[derive(Debug)]
pub(crate) struct Counter {
    progress: Progress,
    name: &'static str,
    /// What was done before the count began.
    before: u64,
    total: u64,
    start: Instant,
    last_line: Instant,
    bar: Option<ProgressBar>,
}

impl Counter {
    /// Says how much is done.
    pub fn set(&mut self, done: u64) {
        if let Some(bar) = &self.bar {
            bar.set_position(done);
        } else if self.last_line.elapsed() >= BETWEEN_LINES && done < self.total {
            self.last_line = Instant::now();
            self.progress.say(self.line(done));
        }
    }

    /// Ends the count; returns the time since it began.
    pub fn finish(self, done: u64) -> Duration {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
        let took = self.start.elapsed();
        let of_total = if done < self.total { format!(" of {}", self.total) } else { String::new() };
        let rate = Metric(rate(done - self.before, took));
        self.progress.say(format_args!("{}: {done}{of_total} in {} ({rate}/s)", self.name, Seconds(took)));
        took
    }

    fn line(&self, done: u64) -> String {
        let took = self.start.elapsed();
        let now = done - self.before;
        let left = took.mul_f64((self.total - done) as f64 / now.max(1) as f64);
        let (percent, rate) = (100 * done / self.total.max(1), Metric(rate(now, took)));
        format!("{}: {percent} % ({done} of {}), {rate}/s, {} left", self.name, self.total, Seconds(left))
    }
}

/// Tells how far work is whose end is not known.
#[derive(Debug)]
pub(crate) struct Meter {
    progress: Progress,
    name: &'static str,
    start: Instant,
    last_line: Instant,
    spinner: Option<ProgressBar>,
}

impl Meter {
    /// Says how far it is.
    pub fn set(&mut self, state: &str) {
        if let Some(spinner) = &self.spinner {
            spinner.set_message(state.to_owned());
        } else if self.last_line.elapsed() >= BETWEEN_LINES {
            self.last_line = Instant::now();
            self.progress.say(format_args!("{}: {state}, {} so far", self.name, Seconds(self.start.elapsed())));
        }
    }

    /// Ends the work; returns the time since it began.
    pub fn finish(self, state: &str) -> Duration {
        if let Some(spinner) = &self.spinner {
            spinner.finish_and_clear();
        }
        let took = self.start.elapsed();
        self.progress.say(format_args!("{}: {state} in {}", self.name, Seconds(took)));
        took
    }
}

/// How many a second; 0 if no time passed.
pub(crate) fn rate(count: u64, time: Duration) -> f64 {
    if time.is_zero() { 0.0 } else { count as f64 / time.as_secs_f64() }
}

/// A time, such as `0.42 s` or `83 s`.
pub(crate) struct Seconds(pub Duration);

impl fmt::Display for Seconds {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let seconds = self.0.as_secs_f64();
        let digits = if seconds < 1.0 { 2 } else { usize::from(seconds < 10.0) };
        write!(f, "{seconds:.digits$} s")
    }
}

/// A number with a metric prefix, such as `1.25 M`.
pub(crate) struct Metric(pub f64);

impl fmt::Display for Metric {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0 {
            value if value >= 1e9 => write!(f, "{:.2} G", value * 1e-9),
            value if value >= 1e6 => write!(f, "{:.2} M", value * 1e-6),
            value if value >= 1e3 => write!(f, "{:.2} k", value * 1e-3),
            value => write!(f, "{value:.2} "),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        assert_eq!(Metric(1_250_000.0).to_string(), "1.25 M");
        assert_eq!([0.5, 12_345.0, 2e9].map(|value| Metric(value).to_string()), ["0.50 ", "12.35 k", "2.00 G"]);
        let seconds = [0.4242, 4.24, 83.2].map(|value| Seconds(Duration::from_secs_f64(value)).to_string());
        assert_eq!(seconds, ["0.42 s", "4.2 s", "83 s"]);
        assert_eq!(rate(3, Duration::ZERO), 0.0);
    }

    #[test]
    fn lines_say_how_much_is_left() {
        let start = Instant::now() - Duration::from_secs(30);
        let counter = Counter {
            progress: Progress::Lines,
            name: "photons",
            before: 40,
            total: 400,
            start,
            last_line: start,
            bar: None,
        };
        assert_eq!(counter.line(100), "photons: 25 % (100 of 400), 2.00 /s, 150 s left");
        assert!(counter.line(40).starts_with("photons: 10 %"));
        assert!(counter.finish(400) >= Duration::from_secs(30));
    }

    #[test]
    fn templates_are_well_formed() {
        let mut counter = Progress::Bars.count("photons", 2, 10);
        counter.set(5);
        counter.finish(10);
        let mut meter = Progress::Bars.measure("samples");
        meter.set("4.0 a pixel");
        meter.finish("5.0 a pixel");
        assert_eq!(Progress::Bars.spin("bvh", || 3), 3);
    }
}
