//! The page: everything in one HTML file, beside the pictures.

use std::fmt::Write as _;

use crate::{
    CellResult, ClosedForm, Experiment, Figure, Finding, Rendered, Table, Verdict, closed_forms::about_rays,
    findings::three_digits,
};

/// Text in HTML and SVG.
pub(crate) fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

/// The whole page.
pub(crate) fn page(experiment: &Experiment, rendered: &Rendered) -> String {
    let mut html = format!(
        "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>{title}</title>\n<style>\n{style}</style></head><body>\n\
         <h1>{title}</h1>\n",
        title = escape(&experiment.title),
        style = include_str!("page.css"),
    );
    paragraphs(&mut html, &experiment.about);
    contents(&mut html, experiment);
    if !experiment.findings.is_empty() {
        let judged: Vec<_> =
            experiment.findings.iter().map(|finding| (finding, rendered.judge(experiment, finding))).collect();
        html += "<h2 id=\"findings\">Findings</h2>\n";
        write_overview(&mut html, experiment, &judged);
        for (number, (finding, verdicts)) in judged.iter().enumerate() {
            write_finding(&mut html, experiment, number, finding, verdicts);
        }
    }
    for (index, table) in experiment.tables.iter().enumerate() {
        write_table(&mut html, experiment, rendered, index, table);
    }
    write_closed_forms(&mut html, experiment, rendered);
    write_definitions(&mut html, experiment);
    html += "<footer>Made by <code>diacaustic experiment</code>. All figures: <a href=\"figures.csv\">figures.csv</a>; all pictures together: \
             <a href=\"contact-sheet.png\">contact-sheet.png</a>.</footer>\n</body></html>\n";
    html
}

fn paragraphs(html: &mut String, text: &str) {
    for paragraph in text.split("\n\n").map(str::trim).filter(|paragraph| !paragraph.is_empty()) {
        let _ = writeln!(html, "<p>{}</p>", escape(paragraph));
    }
}

fn contents(html: &mut String, experiment: &Experiment) {
    html.push_str("<nav>");
    if !experiment.findings.is_empty() {
        html.push_str("<a href=\"#findings\">Findings</a> ");
    }
    for table in &experiment.tables {
        let _ = write!(html, "<a href=\"#{}\">{}</a> ", table.id, escape(&table.title));
    }
    if !experiment.closed_forms.is_empty() {
        html.push_str("<a href=\"#equations\">Equations</a>");
    }
    html.push_str("</nav>\n");
    for model in experiment.models.iter().filter(|model| !model.about.is_empty()) {
        let _ = writeln!(html, "<p><b>{}</b>: {}</p>", escape(&model.name), escape(&model.about));
    }
}

/// A verdict as a class of the style sheet and in words.
fn in_words(verdict: &Verdict) -> (&'static str, &'static str) {
    match (verdict.is_measured(), verdict.holds()) {
        (false, _) => ("model", "not measured"),
        (true, true) => ("holds", "holds"),
        (true, false) => ("fails", "does not hold"),
    }
}

/// All findings at a glance: a line for each, a column for each model.
fn write_overview(html: &mut String, experiment: &Experiment, judged: &[(&Finding, Vec<Verdict>)]) {
    html.push_str("<div class=\"tables\"><table class=\"overview\"><tr><th></th>");
    for model in &experiment.models {
        let _ = write!(html, "<th>{}</th>", escape(&model.name));
    }
    html.push_str("</tr>\n");
    for (number, (finding, verdicts)) in judged.iter().enumerate() {
        let _ = write!(html, "<tr><td><a href=\"#finding-{}\">{}</a></td>", number + 1, escape(&finding.text));
        for model in 0..experiment.models.len() {
            match verdicts.iter().find(|verdict| verdict.model == model).map(in_words) {
                Some((class, word)) => {
                    let _ = write!(html, "<td class=\"{class}\">{word}</td>");
                }
                None => html.push_str("<td>–</td>"),
            }
        }
        html.push_str("</tr>\n");
    }
    html.push_str("</table></div>\n");
}

fn write_finding(html: &mut String, experiment: &Experiment, number: usize, finding: &Finding, verdicts: &[Verdict]) {
    let _ = writeln!(
        html,
        "<div class=\"finding\" id=\"finding-{}\"><p>{} <a href=\"#{}\" title=\"to the table\">↓</a></p>",
        number + 1,
        escape(&finding.text),
        finding.table
    );
    let mut outcome = Vec::new();
    for verdict in verdicts {
        let model = &experiment.models[verdict.model];
        outcome.push((model.name.as_str(), verdict.holds()));
        let (class, word) = in_words(verdict);
        let _ = write!(
            html,
            "<div class=\"verdict\"><span class=\"model\">{}</span><div><span class=\"{class}\">{word}</span>",
            escape(&model.name)
        );
        for judgement in &verdict.judgements {
            let mark = if judgement.holds { "✓" } else { "✗" };
            let _ = write!(html, "<p class=\"evidence\">{mark} {}</p>", escape(&judgement.evidence));
        }
        html.push_str("</div></div>\n");
    }
    match finding.reason(&outcome).filter(|_| verdicts.iter().all(Verdict::is_measured)) {
        Some(reason) => paragraphs(html, reason),
        None if finding.why.is_empty() || !verdicts.iter().all(Verdict::is_measured) => {}
        None => html.push_str("<p>The experiment's file gives no reason for this outcome.</p>\n"),
    }
    html.push_str("</div>\n");
}

fn write_table(html: &mut String, experiment: &Experiment, rendered: &Rendered, index: usize, table: &Table) {
    let _ = writeln!(html, "<h2 id=\"{}\">{}</h2>", table.id, escape(&table.title));
    paragraphs(html, &table.about);
    let models: Vec<_> = experiment.models.iter().enumerate().filter(|(_, model)| table.has_model(model)).collect();
    for (model, of_model) in &models {
        if experiment.models.len() > 1 {
            let _ = writeln!(html, "<h3>{}</h3>", escape(&of_model.name));
        }
        html.push_str("<div class=\"tables\"><table><tr>");
        let rows = table.row_steps();
        if table.rows.is_some() {
            html.push_str("<th></th>");
        }
        for column in &table.columns.steps {
            let _ = write!(html, "<th>{}: {}</th>", escape(&table.columns.label), escape(&column.label));
        }
        html.push_str("</tr>\n");
        for (row, step) in rows.iter().enumerate() {
            html.push_str("<tr>");
            if table.rows.is_some() {
                let _ = write!(html, "<th>{}</th>", escape(&step.label));
            }
            for column in 0..table.columns.steps.len() {
                html.push_str("<td>");
                if let Some(cell) = rendered.cell(index, row, column, *model) {
                    write_cell(html, cell, &of_model.unit, shown_width(table));
                }
                html.push_str("</td>");
            }
            html.push_str("</tr>\n");
        }
        html.push_str("</table></div>\n");
    }
    html.push_str("<div class=\"plots\">");
    for plot in experiment.plots.iter().filter(|plot| plot.table == table.id) {
        let _ = writeln!(html, "<figure>{}</figure>", rendered.chart(experiment, plot).svg());
    }
    html.push_str("</div>\n");
}

/// Pixels that a picture has on the page, at most and at least, and those of a table without its row headings.
const SHOWN_WIDTH: [u32; 2] = [240, 120];
const TABLE_WIDTH: u32 = 1130;
const HEADING_WIDTH: u32 = 130;
/// The space beside a picture.
const CELL_GAP: u32 = 12;

/// Pixels of a table's pictures on the page, such that all columns are seen at once, unless they are very many.
fn shown_width(table: &Table) -> u32 {
    let [most, least] = SHOWN_WIDTH;
    let heading = if table.rows.is_some() { HEADING_WIDTH } else { 0 };
    let columns = table.columns.steps.len().max(1) as u32;
    ((TABLE_WIDTH - heading) / columns).saturating_sub(CELL_GAP).clamp(least, most)
}

fn write_cell(html: &mut String, cell: &CellResult, unit: &str, shown_width: u32) {
    let width = cell.width.min(shown_width);
    let height = u64::from(cell.height) * u64::from(width) / u64::from(cell.width.max(1));
    let _ = write!(html, "<img src=\"{}\" width=\"{width}\" height=\"{height}\" alt=\"\"><dl>", cell.picture);
    for figure in Figure::ALL {
        let Some(value) = cell.figures.get(figure) else { continue };
        let is_shown = match figure {
            // Times of single pictures say little but beside an error; colour says little of gray light.
            Figure::PhotonSeconds => cell.figures.error.is_some(),
            Figure::Seconds => false,
            Figure::Colour => value >= 0.005,
            _ => true,
        };
        if !is_shown {
            continue;
        }
        let _ = write!(html, "<dt>{figure}</dt><dd>{}{}</dd>", three_digits(value), escape(&figure.suffix(unit)));
    }
    html.push_str("</dl>");
}

fn write_closed_forms(html: &mut String, experiment: &Experiment, rendered: &Rendered) {
    if experiment.closed_forms.is_empty() {
        return;
    }
    html.push_str("<h2 id=\"equations\">The equations</h2>\n<div class=\"plots\">");
    for form in &experiment.closed_forms {
        let _ = writeln!(
            html,
            "<figure>{}<figcaption>{} {}</figcaption></figure>",
            form.chart(&rendered.refractions).svg(),
            escape(form.caption()),
            if *form == ClosedForm::Refraction { about_rays(&rendered.refractions) } else { String::new() }
        );
    }
    html.push_str("</div>\n");
}

fn write_definitions(html: &mut String, experiment: &Experiment) {
    let thresholds: Vec<_> = experiment
        .models
        .iter()
        .map(|m| format!("{} {} ({})", m.threshold.unwrap_or(experiment.measure.threshold), m.unit, m.name))
        .collect();
    let _ = writeln!(
        html,
        "<h2>What the figures are</h2>\n<p>Measured in the energy map of “{}”. The <i>caustic</i> is where the mean irradiance of 5 × 5 texels is at least {}, but for \
         tables with a threshold of their own. <i>Mean irradiance</i> and <i>caustic area</i> are of the caustic, <i>peak irradiance</i> is that of \
         the brightest texel. <i>Spottedness</i> is the coefficient of variation at the scale of a texel: what alternates from texel to texel by \
         Immerkær’s operator (1996), as the root of its mean square over the caustic’s mean. <i>Energy</i> is the sum over the whole side, watts or, in the profile \
         “paper”, energy. <i>Colour spread</i> is the difference of the brightest and the darkest channel, over the brightest, as a mean over the caustic’s light. <i>Error</i> \
         is the mean over pixels of the squared relative difference from a long run.</p>",
        escape(&experiment.measure.object),
        escape(&thresholds.join(", "))
    );
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_cannot_become_markup() {
        assert_eq!(escape("<b> & \"c\""), "&lt;b&gt; &amp; &quot;c&quot;");
    }
}
