//! All figures as comma-separated values (RFC 4180).

use crate::{Experiment, Figure, Rendered};

/// A line for each cell, after one of the columns' names. Figures that were not measured are empty.
pub(crate) fn csv(experiment: &Experiment, rendered: &Rendered) -> String {
    let names = ["table", "row", "column", "model", "photons"].into_iter().chain(Figure::ALL.map(Figure::key));
    let mut text = names.collect::<Vec<_>>().join(",") + "\r\n";
    for cell in &rendered.cells {
        let table = &experiment.tables[cell.table];
        let labels = [
            table.id.as_str(),
            &table.row_steps()[cell.row].label,
            &table.columns.steps[cell.column].label,
            &experiment.models[cell.model].name,
        ];
        let mut fields: Vec<String> = labels.map(field).into();
        fields.push(cell.photons.to_string());
        fields.extend(Figure::ALL.map(|figure| cell.figures.get(figure).map_or(String::new(), |v| format!("{v:.6e}"))));
        text += &fields.join(",");
        text += "\r\n";
    }
    text
}

/// A field, in quotes where it needs them.
fn field(text: &str) -> String {
    if text.contains(['"', ',', '\r', '\n']) { format!("\"{}\"", text.replace('"', "\"\"")) } else { text.to_owned() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fields_with_commas_and_quotes_are_quoted() {
        assert_eq!([field("a b"), field("a,b"), field("\"a\"")], ["a b", "\"a,b\"", "\"\"\"a\"\"\""]);
    }
}
