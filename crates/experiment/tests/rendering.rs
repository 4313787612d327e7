//! What experiments render, on a device: rays that the kernels refract lie on the curves of the page, and an experiment that ends early has a page.

use std::{fs, ops::ControlFlow, path::Path};

use diacaustic::{Renderer, RendererOptions};
use diacaustic_experiment::Experiment;
use diacaustic_headless::{OpenOptions, open};

const SCENE: &str = r#"
    camera = { position = [0, 1, 2], look_at = [0, 0, 0], vertical_fov = 40 }
    render = { width = 8, height = 8, samples = 1, photons = 1, map_size = 8, guiding = false }
    materials.floor = { type = "diffuse", albedo = 0.5 }
    materials.glass = { type = "dielectric", ior = 1.5 }
    lights = [{ type = "point", position = [0, 1, 0], flux = 5 }]
    objects = [
        { name = "floor", rectangle = { center = [0, 0, 0], edge_u = [2, 0, 0], edge_v = [0, 0, -2] }, material = "floor" },
        { sphere = { center = [0, 0.4, 0], radius = 0.3, subdivisions = 1 }, material = "glass" },
    ]
"#;

const EXPERIMENT: &str = r#"
    title = "Refraction"
    scene = "scene.toml"
    measure = { object = "floor", threshold = 0.01 }
    closed_forms = ["refraction"]
    [[tables]]
    id = "one"
    title = "One picture"
    columns = { label = "samples", key = "render.samples", values = [1] }
    [[tables]]
    id = "two"
    title = "Two pictures"
    columns = { label = "flux", key = "lights.0.flux", values = [5, 10] }
    [[findings]]
    text = "Flux matters."
    table = "two"
    checks = [{ figure = "energy", expects = "rises" }]
"#;

/// The experiment, and a renderer for it.
fn set_up(folder: &Path) -> (Experiment, Renderer) {
    fs::write(folder.join("scene.toml"), SCENE).unwrap();
    fs::write(folder.join("refraction.toml"), EXPERIMENT).unwrap();
    let experiment = Experiment::read(&folder.join("refraction.toml")).unwrap();
    let gpu = open(&OpenOptions::default()).unwrap();
    (experiment, Renderer::new(&gpu.device, &gpu.queue, &RendererOptions::default()).unwrap())
}

#[test]
fn an_experiment_that_ends_early_judges_nothing_that_it_has_not_seen() {
    let folder = tempfile::tempdir().unwrap();
    let (experiment, mut renderer) = set_up(folder.path());
    let rendered = experiment
        .render(&mut renderer, |at| if at.done < 2 { ControlFlow::Continue(()) } else { ControlFlow::Break(()) })
        .unwrap();
    assert_eq!(rendered.cells.iter().map(|cell| (cell.table, cell.column)).collect::<Vec<_>>(), [(0, 0), (1, 0)]);
    let verdicts = rendered.judge(&experiment, &experiment.findings[0]);
    assert!(!verdicts[0].is_measured() && !verdicts[0].holds());
    rendered.write(&experiment, folder.path()).unwrap();
    let page = fs::read_to_string(folder.path().join("index.html")).unwrap();
    assert_eq!(page.matches(">not measured<").count(), 2, "in the overview and at the finding: {page}");
    assert!(!page.contains(">does not hold<"), "{page}");
}

#[test]
fn kernels_refract_as_the_curves_of_the_page_do() {
    let folder = tempfile::tempdir().unwrap();
    let (experiment, mut renderer) = set_up(folder.path());
    let rendered = experiment.render(&mut renderer, |_| ControlFlow::Continue(())).unwrap();

    assert_eq!(rendered.refractions.len(), 3);
    for measured in &rendered.refractions {
        assert_eq!((measured.printed.len(), measured.exact.len()), (8, 8));
        let n = 1.0 / measured.ior;
        let by_tangents = |theta: f64| (n * theta.tan()).atan();
        let by_sines = |theta: f64| (n * theta.sin()).asin();
        for (points, law) in [(&measured.printed, &by_tangents as &dyn Fn(f64) -> f64), (&measured.exact, &by_sines)] {
            for &[theta_i, theta_t] in points {
                let expected = law(theta_i.to_radians()).to_degrees();
                assert!(
                    (theta_t - expected).abs() < 0.2,
                    "into {} at {theta_i}°: {theta_t}°, not {expected}°",
                    measured.ior
                );
            }
        }
        let [_, by_equation_3] = measured.printed[7];
        let [_, by_snell] = measured.exact[7];
        assert!(by_equation_3 > by_snell + 20.0, "the laws part at 80°");
    }
    rendered.write(&experiment, folder.path()).unwrap();
    let plot = fs::read_to_string(folder.path().join("plots/equation-3.svg")).unwrap();
    assert_eq!(plot.matches("<circle").count(), 3 * 16 + 1, "a point for each ray, and one in the legend");
    let page = fs::read_to_string(folder.path().join("index.html")).unwrap();
    assert!(page.contains("The points are 48 rays"), "{page}");
}
