//! Experiments: sweeps over a scene's keys, rendered into tables of pictures with measured figures, findings judged by stated rules, and
//! one page that shows it all. `docs/experiments.md` describes the file.
//!
//! [`Experiment::read`] reads and checks an experiment file, [`Experiment::render`] renders it with an application's [`Renderer`], and
//! [`Rendered::write`] writes the page, a contact sheet, a CSV and the pictures.
//!
//! [`Renderer`]: diacaustic::Renderer

mod closed_forms;
mod contact_sheet;
mod csv;
mod error;
mod figures;
mod file;
mod findings;
mod measured_refraction;
mod page;
mod plan;
mod plot;
mod rendered;
mod study_plots;

pub use error::Error;
pub use figures::{Figure, Figures};
pub use file::{
    Axis, Check, ClosedForm, Expectation, Experiment, Finding, Line, Measure, Model, Plot, Reason, Reference, Sets,
    Side, Step, Table,
};
pub use findings::{Judgement, Verdict};
pub use measured_refraction::MeasuredRefraction;
pub use rendered::{CellResult, Progress, Rendered};
