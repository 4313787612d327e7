//! Plots of figures over a table.

use crate::{
    Experiment, Line, Plot, Rendered, Table,
    file::Step,
    plan::LineOfCells,
    plot::{Chart, Curve},
};

impl Rendered {
    /// Every plot of the experiment, by its name, as SVG.
    pub fn plots(&self, experiment: &Experiment) -> Vec<(String, String)> {
        let closed =
            experiment.closed_forms.iter().map(|form| (form.id().to_owned(), form.chart(&self.refractions).svg()));
        let drawn = experiment.plots.iter().map(|plot| (plot.id.clone(), self.chart(experiment, plot).svg()));
        closed.chain(drawn).collect()
    }

    pub(crate) fn chart(&self, experiment: &Experiment, plot: &Plot) -> Chart {
        let Some(table) = experiment.table(&plot.table) else { return Chart::default() };
        let of_table = &experiment.tables[table];
        let (lines, steps, x_label) = lines(of_table, plot.lines);
        let models: Vec<_> =
            experiment.models.iter().enumerate().filter(|(_, model)| of_table.has_model(model)).collect();
        let mut curves = Vec::new();
        for (color, line) in lines.iter().enumerate() {
            for (number, (model, of_model)) in models.iter().enumerate() {
                let value = |&(row, column): &(usize, usize), figure| {
                    self.cell(table, row, column, *model).and_then(|cell| cell.figures.get(figure)).unwrap_or(f64::NAN)
                };
                let place = |at: usize| match plot.over {
                    Some(figure) => value(&line.places[at], figure),
                    None => place_of(&steps, at),
                };
                let points =
                    (0..line.places.len()).map(|at| [place(at), value(&line.places[at], plot.figure)]).collect();
                let model_name = if models.len() > 1 { of_model.name.as_str() } else { "" };
                let parts: Vec<_> =
                    [line.name.as_str(), model_name].into_iter().filter(|part| !part.is_empty()).collect();
                let (name, dashed) = (parts.join(", "), number > 0);
                curves.push(Curve { name, points, color, dashed, marked: true, ..Curve::default() });
            }
        }
        let is_named = plot.over.is_none() && steps.iter().any(|step| step.x.is_none());
        let ticks = steps.iter().enumerate().filter(|_| is_named);
        Chart {
            title: plot.title.clone(),
            x_label: plot.over.map_or(x_label, |figure| figure.name().to_owned()),
            y_label: plot.figure.name().to_owned(),
            curves,
            logarithmic: plot.logarithmic,
            x_ticks: ticks.map(|(at, step)| (place_of(&steps, at), step.label.clone())).collect(),
        }
    }
}

/// The lines of a plot, the steps along each, and what goes along them.
fn lines(table: &Table, which: Line) -> (Vec<LineOfCells>, Vec<Step>, String) {
    let rows = table.row_steps();
    match which {
        Line::Row => {
            let lines = (0..rows.len()).map(|row| table.along_row(row)).collect();
            (lines, table.columns.steps.clone(), table.columns.label.clone())
        }
        Line::Column => {
            let lines = (0..table.columns.steps.len()).map(|column| table.along_column(column)).collect();
            (lines, rows, table.rows.as_ref().map(|axis| axis.label.clone()).unwrap_or_default())
        }
    }
}

/// Where a step stands on the axis: at its number, or where some step has none, one after the other from 1.
fn place_of(steps: &[Step], at: usize) -> f64 {
    let in_order = (at + 1) as f64;
    if steps.iter().all(|step| step.x.is_some()) { steps[at].x.unwrap_or(in_order) } else { in_order }
}
