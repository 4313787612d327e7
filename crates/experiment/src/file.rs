//! The experiment file.

use std::{
    collections::BTreeMap,
    fs, io,
    path::{Path, PathBuf},
};

use diacaustic::scene::Override;
use serde::Deserialize;

use crate::{Error, Figure};

/// Values in place of a scene's: by their dotted keys, as `--set` takes them.
pub type Sets = toml::Table;

/// An experiment, as its file describes it.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Experiment {
    /// The page's title.
    pub title: String,
    /// What it is about; paragraphs with empty lines between.
    #[serde(default)]
    pub about: String,
    /// The scene, relative to the experiment file's folder.
    pub scene: PathBuf,
    /// Values of every cell.
    #[serde(default)]
    pub set: Sets,
    /// What is measured.
    pub measure: Measure,
    /// The models that each table is rendered in; the scene as it is if none.
    #[serde(default)]
    pub models: Vec<Model>,
    /// The tables of pictures.
    pub tables: Vec<Table>,
    /// The findings that are judged.
    #[serde(default)]
    pub findings: Vec<Finding>,
    /// Plots of figures over a table's columns.
    #[serde(default)]
    pub plots: Vec<Plot>,
    /// Plots of the 2016 paper's equations.
    #[serde(default)]
    pub closed_forms: Vec<ClosedForm>,
    /// Values of every cell that come after all others.
    #[serde(skip)]
    pub overrides: Vec<Override>,
    /// The file itself.
    #[serde(skip)]
    pub path: PathBuf,
}

/// Whose energy map is measured, and what of it counts as caustic.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Measure {
    /// The object's name.
    pub object: String,
    /// Its side.
    #[serde(default)]
    pub side: Side,
    /// Irradiance, W/m² (in the profile `paper`, energy over the map's size), from which on a neighbourhood belongs to the caustic.
    pub threshold: f64,
}

/// A side of a surface.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum Side {
    /// That which the triangles' winding makes the front.
    #[default]
    Front,
    /// The other.
    Back,
}

/// A way to render every cell.
#[derive(Clone, Debug, Default, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Model {
    /// Its name, by which tables and reasons refer to it.
    pub name: String,
    /// What it is.
    #[serde(default)]
    pub about: String,
    /// What irradiance is counted in.
    #[serde(default = "watts_per_square_metre")]
    pub unit: String,
    /// Its values.
    #[serde(default)]
    pub set: Sets,
    /// Its threshold in place of the experiment's.
    pub threshold: Option<f64>,
}

fn watts_per_square_metre() -> String {
    "W/m²".to_owned()
}

/// A table of pictures.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Table {
    /// Its name in findings, plots and files.
    pub id: String,
    /// Its heading.
    pub title: String,
    /// What it shows.
    #[serde(default)]
    pub about: String,
    /// A scene in place of the experiment's.
    pub scene: Option<PathBuf>,
    /// The models that it is rendered in; all if none are named.
    pub models: Option<Vec<String>>,
    /// What is measured, in place of the experiment's.
    pub measure: Option<Measure>,
    /// Values of all its cells.
    #[serde(default)]
    pub set: Sets,
    /// The same, of one model.
    #[serde(default)]
    pub for_model: BTreeMap<String, Sets>,
    /// The rows; a single one if none.
    pub rows: Option<Axis>,
    /// The columns.
    pub columns: Axis,
    /// A long run with which the cells' pictures are compared.
    pub reference: Option<Reference>,
}

/// A long run.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Reference {
    /// Its values, on top of the cell's.
    pub set: Sets,
}

/// The rows or columns of a table: `key` with `values`, or `steps`.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Axis {
    /// What goes along it.
    pub label: String,
    /// The scene's key that is swept.
    pub key: Option<String>,
    /// Its values.
    #[serde(default)]
    pub values: Vec<toml::Value>,
    /// Its places.
    #[serde(default)]
    pub steps: Vec<Step>,
}

/// A row or column.
#[derive(Clone, Debug, Default, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Step {
    /// Its heading.
    pub label: String,
    /// Its place on a plot's axis.
    pub x: Option<f64>,
    /// A scene in place of the table's.
    pub scene: Option<PathBuf>,
    /// Its values.
    #[serde(default)]
    pub set: Sets,
    /// The same, of one model.
    #[serde(default)]
    pub for_model: BTreeMap<String, Sets>,
}

/// A statement about a table, and how it is checked.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Finding {
    /// The statement.
    pub text: String,
    /// The table that it is about.
    pub table: String,
    /// It holds if all of these do.
    pub checks: Vec<Check>,
    /// Why it came out as it did.
    #[serde(default)]
    pub why: Vec<Reason>,
}

/// One figure along a row or a column.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Check {
    /// The figure.
    pub figure: Figure,
    /// The row along which it is looked at; the only one if none.
    pub row: Option<String>,
    /// The column along which it is looked at, in place of a row.
    pub column: Option<String>,
    /// The steps that are looked at, by their labels; all if none are named.
    #[serde(default)]
    pub among: Vec<String>,
    /// What it must do.
    pub expects: Expectation,
    /// Where it must be `greatest` or `least`.
    pub at: Option<String>,
    /// Relative change that counts as one.
    #[serde(default = "five_per_cent")]
    pub margin: f64,
}

fn five_per_cent() -> f64 {
    0.05
}

/// What a figure must do along a row or column.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum Expectation {
    /// The last is greater than the first by more than the margin, and no step falls by more than that.
    Rises,
    /// The last is less than the first by more than the margin, and no step rises by more than that.
    Falls,
    /// It does not rise.
    DoesNotRise,
    /// The greatest is at most the margin above the least.
    Stays,
    /// The one at `at` is greater than every other by more than the margin.
    Greatest,
    /// The one at `at` is less than every other by more than the margin.
    Least,
}

/// A reason for one outcome.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Reason {
    /// For each model, whether the finding holds there; models that are not named may have either.
    pub when: BTreeMap<String, bool>,
    /// The reason.
    pub text: String,
}

/// A plot of one figure of a table over its columns, a line for each row and model.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Plot {
    /// Its name as a file.
    pub id: String,
    /// Its heading.
    pub title: String,
    /// The table.
    pub table: String,
    /// The figure.
    pub figure: Figure,
    /// A figure in place of the columns' places: each cell is a point at both.
    pub over: Option<Figure>,
    /// Whether a line goes along a `row`, or along a `column` of the table.
    #[serde(default)]
    pub lines: Line,
    /// Whether the axes are logarithmic: x, then y.
    #[serde(default)]
    pub logarithmic: [bool; 2],
}

/// What a plot's lines go along.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum Line {
    /// A line for each row.
    #[default]
    Row,
    /// A line for each column.
    Column,
}

/// A plot of one of the 2016 paper's equations beside what is exact.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum ClosedForm {
    /// Equation 1: the density of directions over angle.
    Directions,
    /// Equation 2: a texel's weight over the place of a ray, beside the bilinear one.
    Weights,
    /// Equation 3: the angle of refraction over that of incidence, beside Snell's.
    Refraction,
}

impl Experiment {
    /// Reads an experiment file and checks that its parts fit together. The scenes are read when they are rendered.
    ///
    /// # Errors
    /// If the file cannot be read or makes no sense.
    pub fn read(path: &Path) -> Result<Self, Error> {
        let not_text = |_| io::Error::new(io::ErrorKind::InvalidData, "it is no UTF-8 text, as experiment files are");
        let text = fs::read(path).and_then(|bytes| String::from_utf8(bytes).map_err(not_text));
        let text = text.map_err(|cause| Error::Read { path: path.to_owned(), cause })?;
        Self::parse(&text, path)
    }

    /// Reads an experiment from text; paths in it are relative to the folder of `path`, by which messages call it.
    ///
    /// # Errors
    /// If the text makes no sense.
    pub fn parse(text: &str, path: &Path) -> Result<Self, Error> {
        let mut experiment: Self = toml::from_str(text).map_err(|error| syntax_error(text, path, &error))?;
        experiment.path = path.to_owned();
        if experiment.models.is_empty() {
            let unit = watts_per_square_metre();
            experiment.models.push(Model { name: "scene".to_owned(), unit, ..Model::default() });
        }
        for axis in experiment.tables.iter_mut().flat_map(|table| table.rows.iter_mut().chain([&mut table.columns])) {
            axis.spell_out();
        }
        experiment.check()?;
        Ok(experiment)
    }

    /// The folder that paths are relative to.
    pub fn folder(&self) -> &Path {
        self.path.parent().unwrap_or(Path::new(""))
    }

    /// A table by its name.
    pub fn table(&self, id: &str) -> Option<usize> {
        self.tables.iter().position(|table| table.id == id)
    }
}

impl Axis {
    /// Turns a key with values into steps.
    fn spell_out(&mut self) {
        let Some(key) = &self.key else { return };
        for value in &self.values {
            let label = value.as_str().map_or_else(|| value.to_string(), str::to_owned);
            let x = value.as_float().or_else(|| value.as_integer().map(|integer| integer as f64));
            let set = Sets::from_iter([(key.clone(), value.clone())]);
            self.steps.push(Step { label, x, set, ..Step::default() });
        }
    }
}

fn syntax_error(text: &str, path: &Path, error: &toml::de::Error) -> Error {
    let before = text.get(..error.span().map_or(0, |span| span.start)).unwrap_or(text);
    let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
    Error::Syntax {
        path: path.to_owned(),
        line: before.matches('\n').count() + 1,
        column: before[line_start..].chars().count() + 1,
        problem: error.message().to_owned(),
    }
}
