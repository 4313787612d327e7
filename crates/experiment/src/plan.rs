//! What an experiment's tables ask for: the checks of its file, and each cell's scene.

use std::{collections::BTreeMap, path::PathBuf};

use crate::{
    Error, Experiment,
    file::{Axis, Check, Expectation, Measure, Model, Reference, Sets, Step, Table},
};

/// A row or column that sets nothing.
pub(crate) fn only_step() -> Step {
    Step::default()
}

impl Table {
    /// The rows: a single one without heading if the table has none.
    pub fn row_steps(&self) -> Vec<Step> {
        self.rows.as_ref().map_or_else(|| vec![only_step()], |axis| axis.steps.clone())
    }

    /// Whether the table is rendered in a model.
    pub fn has_model(&self, model: &Model) -> bool {
        self.models.as_ref().is_none_or(|names| names.contains(&model.name))
    }
}

/// A picture to be rendered.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Cell {
    pub table: usize,
    pub row: usize,
    pub column: usize,
    pub model: usize,
    /// What messages and progress call it.
    pub name: String,
    pub job: Job,
    /// The long run with which it is compared.
    pub reference: Option<Job>,
    pub measure: Measure,
}

/// A scene with values in place of its own. Cells with equal jobs share a picture.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Job {
    pub scene: PathBuf,
    /// The values in TOML by their keys; a table stands before what is inside of it.
    pub sets: BTreeMap<String, String>,
}

impl Job {
    fn with(&self, sets: &Sets) -> Self {
        let mut job = self.clone();
        job.sets.extend(sets.iter().map(|(key, value)| (key.clone(), value.to_string())));
        job
    }
}

impl Experiment {
    /// Every cell, table by table.
    pub(crate) fn cells(&self) -> Vec<Cell> {
        let mut cells = Vec::new();
        for (index, table) in self.tables.iter().enumerate() {
            for (model, of_model) in self.models.iter().enumerate().filter(|(_, model)| table.has_model(model)) {
                for (row, row_step) in table.row_steps().iter().enumerate() {
                    for (column, step) in table.columns.steps.iter().enumerate() {
                        let mut job = self.job(table, of_model, [row_step, step]);
                        job.sets.extend(self.overrides.iter().map(|last| (last.path(), last.value().to_owned())));
                        let parts = [&table.id, &row_step.label, &step.label, &of_model.name];
                        let named: Vec<_> = parts.into_iter().filter(|part| !part.is_empty()).cloned().collect();
                        cells.push(Cell {
                            table: index,
                            row,
                            column,
                            model,
                            name: named.join(", "),
                            reference: table.reference.as_ref().map(|Reference { set }| job.with(set)),
                            job,
                            measure: self.measure_of(table, of_model),
                        });
                    }
                }
            }
        }
        cells
    }

    fn job(&self, table: &Table, model: &Model, steps: [&Step; 2]) -> Job {
        let of_steps = steps.iter().rev().find_map(|step| step.scene.as_ref());
        let scene = self.folder().join(of_steps.or(table.scene.as_ref()).unwrap_or(&self.scene));
        let mut job = Job { scene, sets: BTreeMap::new() }.with(&self.set).with(&model.set);
        let of_steps = steps.iter().map(|step| (&step.set, &step.for_model));
        for (set, for_model) in std::iter::once((&table.set, &table.for_model)).chain(of_steps) {
            job = job.with(set);
            if let Some(set) = for_model.get(&model.name) {
                job = job.with(set);
            }
        }
        job
    }

    fn measure_of(&self, table: &Table, model: &Model) -> Measure {
        match &table.measure {
            Some(measure) => measure.clone(),
            None => Measure { threshold: model.threshold.unwrap_or(self.measure.threshold), ..self.measure.clone() },
        }
    }

    /// Checks that names agree.
    pub(crate) fn check(&self) -> Result<(), Error> {
        let mut ids = Vec::new();
        for table in &self.tables {
            let part = format!("table {:?}", table.id);
            self.check_id(&part, &table.id, &mut ids)?;
            self.check_axis(&part, "columns", &table.columns)?;
            if let Some(rows) = &table.rows {
                self.check_axis(&part, "rows", rows)?;
            }
            let in_steps = table.row_steps();
            let steps = in_steps.iter().chain(&table.columns.steps).flat_map(|step| step.for_model.keys());
            for name in table.models.iter().flatten().chain(table.for_model.keys()).chain(steps) {
                self.check_model(&part, name)?;
            }
        }
        for finding in &self.findings {
            let part = format!("finding {:?}", finding.text);
            let table = self.require_table(&part, &finding.table)?;
            for check in &finding.checks {
                self.check_check(&part, table, check)?;
            }
            for name in finding.why.iter().flat_map(|reason| reason.when.keys()) {
                self.check_model(&part, name)?;
            }
        }
        for plot in &self.plots {
            let part = format!("plot {:?}", plot.id);
            self.check_id(&part, &plot.id, &mut ids)?;
            self.require_table(&part, &plot.table)?;
        }
        Ok(())
    }

    fn invalid(&self, part: &str, problem: String) -> Error {
        Error::Invalid { path: self.path.clone(), part: part.to_owned(), problem }
    }

    fn check_id<'e>(&self, part: &str, id: &'e str, ids: &mut Vec<&'e str>) -> Result<(), Error> {
        let is_plain = !id.is_empty() && id.chars().all(|c| c.is_ascii_alphanumeric() || "_-".contains(c));
        if !is_plain {
            let problem = "id must be of letters, digits, _ and -, for files are named after it".to_owned();
            return Err(self.invalid(part, problem));
        }
        if ids.contains(&id) {
            return Err(self.invalid(part, "id is used twice; tables and plots need names of their own".to_owned()));
        }
        ids.push(id);
        Ok(())
    }

    fn check_axis(&self, part: &str, which: &str, axis: &Axis) -> Result<(), Error> {
        if axis.key.is_none() && !axis.values.is_empty() {
            return Err(self.invalid(part, format!("{which} has values, but no key that they are for; add key")));
        }
        if axis.steps.is_empty() {
            return Err(self.invalid(part, format!("{which} is empty; it takes key and values, or steps")));
        }
        Ok(())
    }

    fn check_model(&self, part: &str, name: &str) -> Result<(), Error> {
        if self.models.iter().any(|model| model.name == name) {
            return Ok(());
        }
        let known: Vec<_> = self.models.iter().map(|model| model.name.as_str()).collect();
        Err(self.invalid(part, format!("there is no model {name:?}; the models are {}", known.join(", "))))
    }

    fn require_table(&self, part: &str, id: &str) -> Result<&Table, Error> {
        self.tables.iter().find(|table| table.id == id).ok_or_else(|| {
            let known: Vec<_> = self.tables.iter().map(|table| table.id.as_str()).collect();
            self.invalid(part, format!("there is no table {id:?}; the tables are {}", known.join(", ")))
        })
    }

    fn check_check(&self, part: &str, table: &Table, check: &Check) -> Result<(), Error> {
        let Some(line) = check.line(table) else {
            let labels = |steps: &[Step]| steps.iter().map(|s| format!("{:?}", s.label)).collect::<Vec<_>>().join(", ");
            let problem = format!(
                "a check needs either a row of the table ({}) or a column ({})",
                labels(&table.row_steps()),
                labels(&table.columns.steps)
            );
            return Err(self.invalid(part, problem));
        };
        if let Some(unknown) = check.among.iter().find(|label| !line.labels.contains(label)) {
            return Err(self.invalid(part, format!("among names {unknown:?}, which is no step of the row or column")));
        }
        let needs_place = matches!(check.expects, Expectation::Greatest | Expectation::Least);
        if needs_place != check.at.is_some() {
            return Err(self.invalid(part, "\"greatest\" and \"least\" need `at`, and only they".to_owned()));
        }
        match &check.at {
            Some(at) if !line.labels.contains(at) => {
                Err(self.invalid(part, format!("at is {at:?}; it must be one of {}", line.labels.join(", "))))
            }
            _ => Ok(()),
        }
    }
}

/// The cells of a row or a column, and their headings.
pub(crate) struct LineOfCells {
    /// Row and column of each cell.
    pub places: Vec<(usize, usize)>,
    pub labels: Vec<String>,
    /// The heading of the row or column itself.
    pub name: String,
}

impl LineOfCells {
    /// The cells under some headings; all if none are named.
    fn among(mut self, labels: &[String]) -> Self {
        if !labels.is_empty() {
            let kept = |label: &String| labels.contains(label);
            let cells = self.places.into_iter().zip(self.labels).filter(|(_, label)| kept(label));
            (self.places, self.labels) = cells.unzip();
        }
        self
    }
}

impl Table {
    /// The cells of a row.
    pub(crate) fn along_row(&self, row: usize) -> LineOfCells {
        LineOfCells {
            places: (0..self.columns.steps.len()).map(|column| (row, column)).collect(),
            labels: self.columns.steps.iter().map(|step| step.label.clone()).collect(),
            name: self.row_steps()[row].label.clone(),
        }
    }

    /// The cells of a column.
    pub(crate) fn along_column(&self, column: usize) -> LineOfCells {
        let rows = self.row_steps();
        LineOfCells {
            places: (0..rows.len()).map(|row| (row, column)).collect(),
            labels: rows.into_iter().map(|step| step.label).collect(),
            name: self.columns.steps[column].label.clone(),
        }
    }
}

impl Check {
    /// The cells that the check looks at; none if the table has no such row or column.
    pub(crate) fn line(&self, table: &Table) -> Option<LineOfCells> {
        let rows = table.row_steps();
        let line = match (&self.row, &self.column) {
            (None, None) if rows.len() == 1 => Some(table.along_row(0)),
            (Some(row), None) => rows.iter().position(|step| step.label == *row).map(|row| table.along_row(row)),
            (None, Some(column)) => {
                let found = table.columns.steps.iter().position(|step| step.label == *column);
                found.map(|column| table.along_column(column))
            }
            _ => None,
        };
        line.map(|line| line.among(&self.among))
    }
}
