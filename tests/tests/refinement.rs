//! Renders that choose their photons and samples themselves.

use diacaustic::{Film, Refinement, Renderer, Stage};
use diacaustic_scene::Scene;
use diacaustic_tests::{renderer, scene};

/// A glass ball over a floor, in a small picture.
fn ball(target_error: f32) -> Scene {
    scene(&format!(
        r#"
        camera = {{ position = [0, 1.5, 2.2], look_at = [0, 0.2, 0], vertical_fov = 40 }}
        render = {{ width = 100, height = 76, max_bounces = 2, target_error = {target_error} }}
        [materials]
        glass = {{ type = "dielectric", ior = 1.5 }}
        floor = {{ type = "diffuse", albedo = 0.8 }}
        [[lights]]
        type = "sphere"
        center = [0.5, 2.5, 0.3]
        radius = 0.2
        flux = 35
        [[objects]]
        sphere = {{ center = [0, 0.4, 0], radius = 0.3, subdivisions = 4 }}
        material = "glass"
        [[objects]]
        rectangle = {{ center = [0, 0, 0], edge_u = [4, 0, 0], edge_v = [0, 0, -4] }}
        material = "floor"
        "#
    ))
}

/// Refines to the end; the steps by the way.
fn refine(renderer: &mut Renderer) -> Vec<Refinement> {
    let mut steps = Vec::new();
    loop {
        let step = renderer.refine().unwrap();
        steps.push(step);
        assert!(steps.len() < 2000, "no end: {step:?}");
        if step.stage == Stage::Done {
            return steps;
        }
    }
}

/// The root of the mean squared relative error against a picture that is far more exact, as docs/refinement.md defines it.
fn error(film: &Film, exact: &Film) -> f64 {
    let count = film.radiance.len() as f64;
    let brightness = |pixel: &[f32; 3]| pixel.iter().map(|&channel| f64::from(channel)).sum::<f64>() / 3.0;
    let mean = exact.radiance.iter().map(brightness).sum::<f64>() / count;
    let relative = |(found, exact): (&[f32; 3], &[f32; 3])| {
        let squares = found.iter().zip(exact).map(|(found, exact)| f64::from(found - exact).powi(2)).sum::<f64>();
        let exact = exact.iter().map(|&channel| f64::from(channel).powi(2)).sum::<f64>();
        (squares / (exact + 0.03 * mean * mean)).min(1.0)
    };
    (film.radiance.iter().zip(&exact.radiance).map(relative).sum::<f64>() / count).sqrt()
}

#[test]
fn the_target_is_reached_and_the_estimate_is_honest() {
    let mut exact = ball(1.0);
    (exact.settings.photons, exact.settings.samples) = (Some(4_000_000), Some(512));
    let mut long = renderer(&exact);
    refine(&mut long);
    let exact = long.film().unwrap();
    let mut before = f64::INFINITY;
    for target in [0.2, 0.07] {
        let mut renderer = renderer(&ball(target));
        let end = *refine(&mut renderer).last().unwrap();
        let (found, estimated) = (error(&renderer.film().unwrap(), &exact), end.error.unwrap());
        println!("target {target}: found {found:.4}, estimated {estimated:.4}, {end:?}");
        assert!(found <= f64::from(target), "{found} with a target of {target}");
        assert!((0.5..2.0).contains(&(estimated / found)), "estimated {estimated}, found {found}");
        assert!(found < 0.8 * before, "{found} after {before}");
        before = found;
    }
}

#[test]
fn the_course_is_the_same_in_every_run() {
    let scene = ball(0.15);
    let render = || {
        let mut renderer = renderer(&scene);
        let steps = refine(&mut renderer);
        (steps, renderer.film().unwrap(), renderer.energy_map(1).unwrap())
    };
    let first = render();
    assert!(first == render());
    // Some pixels need more samples than others, and photons stop before samples begin.
    let (steps, film, _) = &first;
    assert!(steps.last().unwrap().samples > f64::from(film.samples));
    let stages: Vec<_> = steps.iter().map(|step| step.stage).collect();
    assert!(stages.is_sorted_by_key(|&stage| stage == Stage::Samples || stage == Stage::Done), "{stages:?}");
    // A second render by the same renderer begins anew.
    let mut again = renderer(&scene);
    refine(&mut again);
    again.restart().unwrap();
    assert_eq!(refine(&mut again), *steps);
}

#[test]
fn stated_numbers_are_kept_and_photons_can_be_ended() {
    let mut stated = ball(0.001);
    (stated.settings.photons, stated.settings.samples) = (Some(100_000), Some(3));
    let mut renderer = renderer(&stated);
    refine(&mut renderer);
    let counted = renderer.statistics().unwrap();
    assert_eq!((counted.photons, counted.samples, counted.mean_samples), (100_000, 3, 3.0));

    let mut open = diacaustic_tests::renderer(&ball(0.3));
    let step = open.finish_photons().unwrap();
    assert_eq!((step.stage, step.photons), (Stage::Samples, 0));
    refine(&mut open);
    assert_eq!(open.statistics().unwrap().photons, 0);
}

/// The caustic that a glass teapot above the camera throws, in a picture whose pixels are wider than its lines; no other light falls there. In a scene
/// with a picture on a surface each sample reads one place.
fn lines(samples: u32, more: &str) -> Film {
    let mut renderer = renderer(&scene(&format!(
        r#"
        camera = {{ position = [0.2, 0.5, 0.3], look_at = [0.15, 0, 0], vertical_fov = 30 }}
        render = {{ width = 32, height = 32, max_bounces = 0, photons = 300000, samples = {samples} }}
        [materials]
        glass = {{ type = "dielectric", ior = 1.5 }}
        floor = {{ type = "diffuse", albedo = 0.8 }}
        [[lights]]
        type = "point"
        position = [0, 3, 0]
        flux = 35
        [[objects]]
        mesh = "assets/meshes/teapot.obj"
        material = "glass"
        translate = [0.1, 0.9, 0]
        [[objects]]
        rectangle = {{ center = [0, 0, 0], edge_u = [4, 0, 0], edge_v = [0, 0, -4] }}
        material = "floor"
        {more}
        "#
    )));
    refine(&mut renderer);
    renderer.film().unwrap()
}

#[test]
fn first_samples_see_a_pixels_whole_part_of_the_caustic() {
    let picture = r#"
        [materials.tiles]
        type = "diffuse"
        albedo = { image = "assets/textures/tiles.png" }
        [[objects]]
        box = { min = [1.7, 0.5, 1.7], max = [1.8, 0.6, 1.8] }
        material = "tiles""#;
    let of = |samples, more| error(&lines(samples, more), &lines(256, more));
    let (wide, narrow) = (of(2, ""), of(2, picture));
    println!("error {wide:.4} with two samples, {narrow:.4} where each reads one place");
    assert!(wide < 0.7 * narrow, "{wide}, {narrow} where each sample reads one place");
    // With 64 samples what the first ones saw matters no more.
    assert!(of(64, "") < 0.5 * wide);
}
