//! Whether findings hold, by the figures and the rules that the file states.

use crate::{Check, Expectation, Experiment, Finding, Rendered};

/// What became of one check in one model.
#[derive(Clone, Debug, PartialEq)]
pub struct Judgement {
    /// Whether it holds.
    pub holds: bool,
    /// Whether all that it looks at was measured.
    pub is_measured: bool,
    /// The row or column, the figure and its values, with what was expected of them.
    pub evidence: String,
}

/// What became of a finding in one model.
#[derive(Clone, Debug, PartialEq)]
pub struct Verdict {
    /// Index of the model.
    pub model: usize,
    /// Of each check.
    pub judgements: Vec<Judgement>,
}

impl Verdict {
    /// Whether all that the checks look at was measured: not where the experiment ended before.
    pub fn is_measured(&self) -> bool {
        self.judgements.iter().all(|judgement| judgement.is_measured)
    }

    /// Whether all checks hold.
    pub fn holds(&self) -> bool {
        self.judgements.iter().all(|judgement| judgement.holds)
    }
}

impl Rendered {
    /// Judges a finding in each model that its table is rendered in.
    pub fn judge(&self, experiment: &Experiment, finding: &Finding) -> Vec<Verdict> {
        let Some(table) = experiment.table(&finding.table) else { return Vec::new() };
        let models = experiment.models.iter().enumerate();
        models
            .filter(|(_, model)| experiment.tables[table].has_model(model))
            .map(|(model, _)| Verdict {
                model,
                judgements: finding
                    .checks
                    .iter()
                    .map(|check| self.judge_check(experiment, table, model, check))
                    .collect(),
            })
            .collect()
    }

    fn judge_check(&self, experiment: &Experiment, table: usize, model: usize, check: &Check) -> Judgement {
        let Some(line) = check.line(&experiment.tables[table]) else {
            let evidence = "the table has no such row or column".to_owned();
            return Judgement { holds: false, is_measured: false, evidence };
        };
        let value = |&(row, column): &(usize, usize)| {
            let cell = self.cell(table, row, column, model);
            cell.and_then(|cell| cell.figures.get(check.figure)).unwrap_or(f64::NAN)
        };
        let values: Vec<f64> = line.places.iter().map(value).collect();
        let at = check.at.as_ref().and_then(|at| line.labels.iter().position(|label| label == at));
        let holds = holds(check.expects, check.margin, &values, at);
        let shown: Vec<_> = values.iter().map(|&value| three_digits(value)).collect();
        let place = if line.name.is_empty() { String::new() } else { format!("{}: ", line.name) };
        let expected = match (check.expects, &check.at) {
            (Expectation::Rises, _) => "to rise".to_owned(),
            (Expectation::Falls, _) => "to fall".to_owned(),
            (Expectation::DoesNotRise, _) => "not to rise".to_owned(),
            (Expectation::Stays, _) => "to stay".to_owned(),
            (Expectation::Greatest, at) => format!("to be greatest at {}", at.as_deref().unwrap_or_default()),
            (Expectation::Least, at) => format!("to be least at {}", at.as_deref().unwrap_or_default()),
        };
        let is_labelled = check.at.is_some() || !check.among.is_empty();
        let separator = if check.at.is_some() { " · " } else { " → " };
        let labelled: Vec<_> = match is_labelled {
            true => line.labels.iter().zip(&shown).map(|(label, value)| format!("{label}: {value}")).collect(),
            false => shown,
        };
        let unit = check.figure.suffix(&experiment.models[model].unit);
        Judgement {
            holds,
            is_measured: values.iter().all(|value| value.is_finite()),
            evidence: format!("{place}{} {}{unit}; expected {expected}", check.figure, labelled.join(separator)),
        }
    }
}

/// Whether values do what is expected; `at` is the place of the greatest or least. Values that were not measured do nothing.
fn holds(expects: Expectation, margin: f64, values: &[f64], at: Option<usize>) -> bool {
    let (Some(&first), Some(&last)) = (values.first(), values.last()) else { return false };
    if values.iter().any(|value| !value.is_finite()) {
        return false;
    }
    let steps = || values.iter().zip(&values[1..]);
    let rises = last > first * (1.0 + margin) && steps().all(|(before, after)| *after >= before * (1.0 - margin));
    let others = || values.iter().enumerate().filter(|(index, _)| Some(*index) != at).map(|(_, value)| *value);
    let chosen = at.map_or(f64::NAN, |at| values[at]);
    match expects {
        Expectation::Rises => rises,
        Expectation::DoesNotRise => !rises,
        Expectation::Falls => {
            last < first * (1.0 - margin) && steps().all(|(before, after)| *after <= before * (1.0 + margin))
        }
        Expectation::Stays => {
            let (least, most) = values.iter().fold((f64::INFINITY, 0.0), |(l, m), &v| (f64::min(l, v), f64::max(m, v)));
            most <= least * (1.0 + margin)
        }
        Expectation::Greatest => others().all(|other| chosen > other * (1.0 + margin)),
        Expectation::Least => others().all(|other| chosen < other * (1.0 - margin)),
    }
}

impl Finding {
    /// The reason that the file gives for an outcome: whether it holds in each model, by name.
    pub(crate) fn reason(&self, outcome: &[(&str, bool)]) -> Option<&str> {
        let fits = |model: &String, holds: &bool| outcome.iter().any(|(name, found)| name == model && found == holds);
        let reason = self.why.iter().find(|reason| reason.when.iter().all(|(model, holds)| fits(model, holds)));
        reason.map(|reason| reason.text.as_str())
    }
}

/// A number to three digits.
pub(crate) fn three_digits(value: f64) -> String {
    if !value.is_finite() {
        return "–".to_owned();
    }
    if value == 0.0 {
        return "0".to_owned();
    }
    let digits = 2 - value.abs().log10().floor() as i32;
    match digits {
        ..=0 => format!("{value:.0}"),
        1..=5 => format!("{value:.*}", digits as usize),
        _ => format!("{value:.2e}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rules_mean_what_they_say() {
        use Expectation::{DoesNotRise, Falls, Greatest, Least, Rises, Stays};
        let judge = |expects, values: &[f64], at| holds(expects, 0.05, values, at);
        assert!(judge(Rises, &[1.0, 0.98, 1.2], None) && !judge(Rises, &[1.0, 0.9, 1.2], None));
        assert!(!judge(Rises, &[1.0, 1.04], None) && judge(DoesNotRise, &[1.0, 1.04], None));
        assert!(judge(Falls, &[2.0, 1.0], None) && !judge(Falls, &[2.0, 2.2, 1.0], None));
        assert!(judge(Stays, &[1.0, 1.04, 1.02], None) && !judge(Stays, &[1.0, 1.1], None));
        assert!(judge(Greatest, &[1.0, 3.0, 2.0], Some(1)) && !judge(Greatest, &[1.0, 3.0, 2.9], Some(1)));
        assert!(judge(Least, &[1.0, 3.0], Some(0)) && !judge(Least, &[1.0, 3.0], Some(1)));
        for expects in [Rises, DoesNotRise, Falls, Stays] {
            assert!(!judge(expects, &[1.0, f64::NAN], None) && !judge(expects, &[], None), "{expects:?}");
        }
    }

    #[test]
    fn numbers_have_three_digits() {
        let shown = [0.0, 12345.0, 12.345, 0.012345, 1.2345e-7, f64::NAN].map(three_digits);
        assert_eq!(shown, ["0", "12345", "12.3", "0.0123", "1.23e-7", "–"]);
    }
}
