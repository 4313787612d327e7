//! Experiment files: what they mean, and what is wrong with bad ones.

use std::path::Path;

use diacaustic_experiment::{Experiment, Figure};

const GOOD: &str = r#"title = "Spheres"
scene = "a.toml"
measure = { object = "floor", threshold = 0.5 }
[[models]]
name = "paper"
set = { "render.profile" = "paper" }
[[models]]
name = "physical"
[[tables]]
id = "index"
title = "Index"
columns = { label = "index", key = "materials.glass.ior", values = [1.3, 1.9] }
[tables.rows]
label = "shape"
steps = [{ label = "ball", set = { "objects.0.mesh" = "ball.obj" } }, { label = "cube" }]
[[findings]]
text = "it rises"
table = "index"
checks = [{ figure = "mean", row = "ball", expects = "rises" }, { figure = "area", column = "1.9", expects = "least", at = "cube" }]
why = [{ when = { paper = true }, text = "because" }]
[[plots]]
id = "mean"
title = "Mean"
table = "index"
figure = "mean"
"#;

fn parse(text: &str) -> Result<Experiment, String> {
    Experiment::parse(text, Path::new("folder/x.toml")).map_err(|error| error.to_string())
}

#[test]
fn keys_with_values_become_steps() {
    let experiment = parse(GOOD).unwrap();
    let steps = &experiment.tables[0].columns.steps;
    assert_eq!((steps.len(), steps[1].label.as_str(), steps[1].x), (2, "1.9", Some(1.9)));
    assert_eq!(steps[1].set["materials.glass.ior"].as_float(), Some(1.9));
    assert_eq!(experiment.findings[0].checks[0].figure, Figure::Mean);
    assert_eq!(experiment.findings[0].checks[0].margin, 0.05);
}

#[test]
fn the_papers_own_files_are_read() {
    for name in ["paper.toml", "map-size.toml"] {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/experiments").join(name);
        Experiment::read(&path).unwrap_or_else(|error| panic!("{error}"));
    }
}

#[test]
fn bad_files_are_refused_by_name() {
    let cases = [
        ("title = \"Spheres\"", "titel = \"Spheres\"", "folder/x.toml:1:1: unknown field `titel`"),
        ("threshold = 0.5", "threshold = \"a\"", "folder/x.toml:3:"),
        ("figure = \"mean\"\n", "figure = \"brightness\"\n", "unknown variant `brightness`"),
        (
            "table = \"index\"\nchecks",
            "table = \"indx\"\nchecks",
            "finding \"it rises\": there is no table \"indx\"; the tables are index",
        ),
        ("row = \"ball\"", "row = \"bal\"", "a check needs either a row of the table (\"ball\", \"cube\") or a column"),
        ("row = \"ball\"", "row = \"ball\", column = \"1.9\"", "a check needs either a row"),
        ("at = \"cube\"", "at = \"cone\"", "at is \"cone\"; it must be one of ball, cube"),
        (", at = \"cube\"", "", "\"greatest\" and \"least\" need `at`"),
        (
            "when = { paper = true }",
            "when = { papr = true }",
            "there is no model \"papr\"; the models are paper, physical",
        ),
        ("id = \"mean\"", "id = \"index\"", "plot \"index\": id is used twice"),
        ("id = \"mean\"", "id = \"../mean\"", "id must be of letters"),
        ("key = \"materials.glass.ior\", ", "", "columns has values, but no key"),
        ("values = [1.3, 1.9]", "values = []", "columns is empty"),
    ];
    for (line, changed, expected) in cases {
        assert!(GOOD.contains(line), "{line}");
        let error = parse(&GOOD.replacen(line, changed, 1)).expect_err(expected);
        assert!(error.contains(expected), "expected {expected:?}, found {error:?}");
    }
}
