//! `diacaustic experiment` from its file to its page.

use std::{fs, path::Path, process::Command};

const SCENE: &str = r#"
camera = { position = [0, 1.4, 2.2], look_at = [0, 0.2, 0], vertical_fov = 40 }
render = { width = 16, height = 12, samples = 1, photons = 40_000, max_bounces = 0, map_size = 64 }
materials.floor = { type = "diffuse", albedo = 0.5 }
materials.glass = { type = "dielectric", ior = 1.5 }
lights = [{ type = "sphere", center = [0.3, 1.2, 0.2], radius = 0.05, flux = 5 }]
objects = [
    { name = "floor", rectangle = { center = [0, 0, 0], edge_u = [2, 0, 0], edge_v = [0, 0, -2] }, material = "floor" },
    { name = "ball", sphere = { center = [0, 0.4, 0], radius = 0.3, subdivisions = 3 }, material = "glass" },
]
"#;

const EXPERIMENT: &str = r#"
title = "Flux & caustic"
scene = "scene.toml"
measure = { object = "floor", threshold = 0.01 }
closed_forms = ["refraction"]
[[tables]]
id = "flux"
title = "Flux"
columns = { label = "flux", key = "lights.0.flux", values = [5, 10] }
reference = { set = { "render.photons" = 60_000 } }
[[findings]]
text = "Twice the flux is twice as bright"
table = "flux"
checks = [{ figure = "energy", expects = "rises", margin = 0.9 }]
[[findings]]
text = "Flux does not matter"
table = "flux"
checks = [{ figure = "mean", expects = "stays" }]
why = [{ when = { scene = false }, text = "It does <of course>." }]
[[plots]]
id = "energy"
title = "Energy"
table = "flux"
figure = "energy"
"#;

fn run(folder: &Path, arguments: &[&str]) -> std::process::Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_diacaustic"));
    command.current_dir(folder).args(arguments).output().unwrap()
}

#[test]
fn an_experiment_becomes_a_page() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("scene.toml"), SCENE).unwrap();
    fs::write(folder.path().join("flux.toml"), EXPERIMENT).unwrap();
    let output = run(folder.path(), &["experiment", "flux.toml", "--set", "render.width=20"]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));

    let made = folder.path().join("flux");
    let csv = fs::read_to_string(made.join("figures.csv")).unwrap();
    let lines: Vec<Vec<&str>> = csv.lines().map(|line| line.split(',').collect()).collect();
    assert_eq!(lines.len(), 3, "{csv}");
    let column = |name: &str| lines[0].iter().position(|field| *field == name).unwrap();
    let value = |row: usize, name: &str| lines[row][column(name)].parse::<f64>().unwrap();
    assert!((value(2, "energy") / value(1, "energy") - 2.0).abs() < 1e-4, "{csv}");
    assert!((value(2, "peak") / value(1, "peak") - 2.0).abs() < 1e-4 && value(1, "error") > 0.0, "{csv}");

    let page = fs::read_to_string(made.join("index.html")).unwrap();
    assert!(page.contains("Flux &amp; caustic") && page.contains("It does &lt;of course&gt;."), "{page}");
    // Each verdict stands in the overview and at its finding.
    assert_eq!((page.matches(">holds<").count(), page.matches(">does not hold<").count()), (2, 2));
    for name in ["pictures/flux-1-1-scene.png", "pictures/flux-1-2-scene.png"] {
        assert!(page.contains(name));
        let picture = image::open(made.join(name)).unwrap();
        assert_eq!((picture.width(), picture.height()), (20, 12));
    }
    assert!(image::open(made.join("contact-sheet.png")).unwrap().width() > 300);
    for name in ["plots/energy.svg", "plots/equation-3.svg"] {
        assert!(fs::read_to_string(made.join(name)).unwrap().starts_with("<svg"), "{name}");
    }
}

#[test]
fn what_is_wrong_is_named_and_has_status_2() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("scene.toml"), SCENE).unwrap();
    fs::write(folder.path().join("bad.toml"), EXPERIMENT.replace("lights.0.flux", "lights.0.fux")).unwrap();
    let output = run(folder.path(), &["experiment", "bad.toml", "--quiet"]);
    let message = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{message}");
    assert!(message.contains("the scene of flux, 5, scene") && message.contains("fux"), "{message}");
    let missing = run(folder.path(), &["experiment", "missing.toml"]);
    assert_eq!(missing.status.code(), Some(2));
}
