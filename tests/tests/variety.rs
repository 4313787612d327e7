//! One small picture for each light and each material, against a stored mean and variance, so that a change of any of them is seen.
//!
//! `cargo test --release --workspace --test variety -- --ignored` stores what the renderer makes now in `tests/pictures`. What is right
//! is for the tests with known answers to say; look at the pictures' means before they are committed.

use std::path::{Path, PathBuf};

use diacaustic_scene::Scene;
use diacaustic_tests::{read_exr, render, repository, scene};
use exr::prelude::{
    AnyChannel, AnyChannels, Encoding, FlatSamples, Image, Layer, LayerAttributes, SmallVec, WritableImage as _,
};

const SIZE: u32 = 24;
/// Pictures from which mean and variance are taken.
const STORED_SEEDS: u32 = 24;
/// The seed of the picture that is compared: none of those stored.
const SEED: u32 = 1000;

const LAMP: &str = "{ type = \"sphere\", center = [0.8, 2, 0.3], radius = 0.15, flux = 35 }";
const GLASS: &str = "{ type = \"dielectric\", ior = 1.5 }";

/// Name, light and material of the ball over the floor.
const CASES: [(&str, &str, &str); 16] = [
    ("sphere", LAMP, GLASS),
    (
        "rectangle",
        "{ type = \"rectangle\", center = [0.5, 2, 0.3], edge_u = [0.6, 0, 0], edge_v = [0, 0, 0.4], flux = 35 }",
        GLASS,
    ),
    ("disk", "{ type = \"disk\", center = [0.5, 2, 0.3], normal = [0, -1, 0], radius = 0.3, flux = 35 }", GLASS),
    ("point", "{ type = \"point\", position = [0.8, 2, 0.3], flux = 35 }", GLASS),
    (
        "spot",
        "{ type = \"spot\", position = [0.8, 2, 0.3], look_at = [0, 0.3, 0], inner_angle = 10, outer_angle = 25, flux = 8 }",
        GLASS,
    ),
    ("directional", "{ type = \"directional\", direction = [-0.3, -1, -0.1], irradiance = 3 }", GLASS),
    ("sun", "{ type = \"sun\", direction = [-0.3, -1, -0.1], angular_radius = 3, irradiance = 3 }", GLASS),
    ("environment", "{ type = \"environment\", image = \"assets/environments/sky.hdr\", scale = 0.5 }", GLASS),
    ("emissive-object", "", "{ type = \"diffuse\", albedo = 0.5, emission = [2, 1, 0.5] }"),
    ("rough-glass", LAMP, "{ type = \"dielectric\", ior = 1.5, roughness = 0.4, absorption = [3, 1, 0] }"),
    ("thin-walled", LAMP, "{ type = \"thin_walled\", tint = [0.9, 0.7, 0.5] }"),
    ("mirror", LAMP, "{ type = \"mirror\", reflectance = [0.9, 0.8, 0.7] }"),
    ("gold", LAMP, "{ type = \"conductor\", metal = \"gold\", roughness = 0.25 }"),
    ("coated", LAMP, "{ type = \"coated\", albedo = [0.7, 0.1, 0.1] }"),
    (
        "metallic-roughness",
        LAMP,
        "{ type = \"metallic_roughness\", base_color = [0.9, 0.5, 0.2], metallic = 0.5, roughness = 0.4 }",
    ),
    ("phong", LAMP, "{ type = \"phong\", ambient = 1, diffuse = [0.2, 0.4, 0.6], specular = 0.3, shininess = 30 }"),
];

fn ball_over_a_floor(light: &str, material: &str) -> Scene {
    scene(&format!(
        "background = [0.02, 0.03, 0.05]
         ambient = 0.05
         camera = {{ position = [0.3, 1.3, 2.2], look_at = [0, 0.2, 0], vertical_fov = 35 }}
         render = {{ width = {SIZE}, height = {SIZE}, samples = 32, photons = 32_768, map_size = 65 }}
         materials.ball = {material}
         materials.floor = {{ type = \"diffuse\", albedo = [0.8, 0.75, 0.7] }}
         lights = [{light}]
         objects = [
             {{ rectangle = {{ center = [0, 0, 0], edge_u = [2.5, 0, 0], edge_v = [0, 0, -2.5] }}, material = \"floor\" }},
             {{ sphere = {{ center = [0, 0.35, 0], radius = 0.3, subdivisions = 4 }}, material = \"ball\" }},
         ]"
    ))
}

fn values(scene: &Scene, seed: u32) -> Vec<f64> {
    let mut scene = scene.clone();
    scene.settings.seed = seed;
    render(&scene).radiance.as_flattened().iter().map(|&value| f64::from(value)).collect()
}

/// Mean and variance of a picture's values over the stored seeds.
fn moments(scene: &Scene) -> [Vec<f64>; 2] {
    let pictures: Vec<Vec<f64>> = (0..STORED_SEEDS).map(|seed| values(scene, seed)).collect();
    let count = f64::from(STORED_SEEDS);
    let at = |index: usize| pictures.iter().map(move |picture| picture[index]);
    let means: Vec<f64> = (0..pictures[0].len()).map(|index| at(index).sum::<f64>() / count).collect();
    let variance = |(index, mean): (usize, &f64)| at(index).map(|v| (v - mean).powi(2)).sum::<f64>() / (count - 1.0);
    let variances = means.iter().enumerate().map(variance).collect();
    [means, variances]
}

fn file(name: &str) -> PathBuf {
    Path::new(repository()).join(format!("tests/pictures/{name}.exr"))
}

const CHANNELS: [[&str; 3]; 2] = [["R", "G", "B"], ["variance.R", "variance.G", "variance.B"]];

fn store(name: &str, moments: &[Vec<f64>; 2]) {
    let mut channels = SmallVec::<[AnyChannel<FlatSamples>; 4]>::new();
    for (values, names) in moments.iter().zip(CHANNELS) {
        for (channel, name) in names.into_iter().enumerate() {
            let samples = values.iter().skip(channel).step_by(3).map(|&value| value as f32).collect();
            channels.push(AnyChannel::new(name, FlatSamples::F32(samples)));
        }
    }
    let size = (SIZE as usize, SIZE as usize);
    let layer = Layer::new(size, LayerAttributes::default(), Encoding::SMALL_LOSSLESS, AnyChannels::sort(channels));
    std::fs::create_dir_all(file(name).parent().expect("a folder")).expect("the folder of stored pictures");
    Image::from_layer(layer).write().to_file(file(name)).unwrap_or_else(|error| panic!("{name}: {error}"));
}

fn stored(name: &str) -> [Vec<f64>; 2] {
    let layers = read_exr(&file(name));
    CHANNELS.map(|names| {
        let channels = names.map(|name| &layers.channels[name]);
        (0..channels[0].len()).flat_map(|pixel| channels.map(|channel| f64::from(channel[pixel]))).collect()
    })
}

/// How a picture stands to a stored one: mean square of the values' deviations in standard deviations, the share of values that are
/// far off, and the ratio of the sums.
fn deviation(picture: &[f64], [means, variances]: &[Vec<f64>; 2]) -> (f64, f64, f64) {
    assert_eq!(picture.len(), means.len());
    let sum = means.iter().sum::<f64>();
    // Variances of few seeds can be far too small where light comes by chance: never less than a share of the picture's mean.
    let least = (0.01 * sum / means.len() as f64).powi(2);
    let squares = picture.iter().zip(means).zip(variances);
    let squares: Vec<f64> = squares
        .map(|((value, mean), variance)| {
            (value - mean).powi(2) / (variance * (1.0 + 1.0 / f64::from(STORED_SEEDS)) + least)
        })
        .collect();
    let count = squares.len() as f64;
    // Values far off are cut, so that single bright dots do not decide.
    let mean_square = squares.iter().map(|square| square.min(25.0)).sum::<f64>() / count;
    let far = squares.iter().filter(|square| **square > 25.0).count() as f64 / count;
    (mean_square, far, picture.iter().sum::<f64>() / sum)
}

fn is_alike((mean_square, far, ratio): (f64, f64, f64)) -> bool {
    mean_square < 1.2 && far < 0.01 && (ratio - 1.0).abs() < 0.04
}

#[test]
fn pictures_are_as_stored() {
    let mut wrong = Vec::new();
    for (name, light, material) in CASES {
        let found = deviation(&values(&ball_over_a_floor(light, material), SEED), &stored(name));
        println!("{name}: {found:?}");
        if !is_alike(found) {
            wrong.push(format!("{name}: mean square {:.3}, far off {:.4}, ratio {:.4}", found.0, found.1, found.2));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn another_material_is_noticed() {
    let darker = LAMP.replace("flux = 35", "flux = 31.5");
    for (light, material) in [(LAMP, "{ type = \"dielectric\", ior = 1.45 }"), (darker.as_str(), GLASS)] {
        let found = deviation(&values(&ball_over_a_floor(light, material), SEED), &stored("sphere"));
        assert!(!is_alike(found), "{light} {material}: {found:?} passes for the stored picture");
    }
}

#[test]
#[ignore = "stores new pictures"]
fn store_pictures() {
    for (name, light, material) in CASES {
        store(name, &moments(&ball_over_a_floor(light, material)));
    }
}
