//! `[animation]` in scene files.

use std::path::Path;

use diacaustic_scene::{LightKind, Override, Scene, SceneOptions, parse_scene_with};
use glam::{Vec3, vec3};

const SCENE: &str = r#"
    camera = { position = [0, 2, 3], look_at = [0, 0, 0], vertical_fov = 40 }
    render = { width = 64, height = 64, seed = 7 }
    materials.glass = { type = "dielectric", ior = 1.5 }
    materials.floor = { type = "diffuse", albedo = 0.5 }
    lights = [{ name = "lamp", type = "point", position = [0, 2, 0], flux = 35 }]
    objects = [
        { name = "ball", sphere = { center = [0, 0.3, 0], radius = 0.3, subdivisions = 1 }, material = "glass" },
        { name = "floor", rectangle = { center = [0, 0, 0], edge_u = [4, 0, 0], edge_v = [0, 0, -4] }, material = "floor" },
    ]

    [animation]
    seed = "per_frame"

    [[animation.tracks]]
    key = "camera.position"
    frames = [1, 49]
    degrees = [0, 360]
    orbit = { start = [0, 2, 3], center = [0, 1, 0] }

    [[animation.tracks]]
    key = "lights.lamp.flux"
    frames = [1, 11, 21]
    values = [10, 20, 0]

    [[animation.tracks]]
    key = "objects.ball.rotate"
    frames = [1, 11]
    values = [[0, 0, 0], [0, 90, 0]]
    interpolation = "smooth"

    [[animation.tracks]]
    key = "objects.ball.material"
    frames = [1, 30]
    values = ["glass", "floor"]
    interpolation = "step"

    [[animation.tracks]]
    key = "render.samples"
    frames = [1, 11]
    values = [10, 20]
"#;

fn read(text: &str, frame: Option<u32>) -> Result<Scene, String> {
    let options = SceneOptions { frame, ..SceneOptions::default() };
    parse_scene_with(text, Path::new("."), "a.toml", &options).map(|l| l.scene).map_err(|error| error.to_string())
}

fn at(frame: u32) -> Scene {
    read(SCENE, Some(frame)).unwrap()
}

#[test]
fn values_follow_their_keyframes() {
    let position = |frame| at(frame).camera.position;
    for (frame, expected) in
        [(1, [0.0, 2.0, 3.0]), (13, [3.0, 2.0, 0.0]), (25, [0.0, 2.0, -3.0]), (49, [0.0, 2.0, 3.0])]
    {
        assert!(position(frame).distance(Vec3::from(expected)) < 1e-5, "frame {frame}: {}", position(frame));
    }
    let flux = |frame| match at(frame).lights[0].kind {
        LightKind::Point { flux, .. } => flux.x,
        _ => unreachable!(),
    };
    assert_eq!([0, 1, 6, 11, 16, 21, 99].map(flux), [10.0, 10.0, 15.0, 20.0, 10.0, 0.0, 0.0]);
    assert_eq!([1, 29, 30].map(|frame| at(frame).objects[0].materials[0]), [0, 0, 1]);
    assert_eq!([1, 2, 11].map(|frame| at(frame).settings.samples), [10, 11, 20].map(Some));
    assert_eq!([1, 2, 40].map(|frame| at(frame).settings.seed), [8, 9, 47]);
    let turned = at(11).objects[0].world_from_object.transform_vector3(Vec3::X);
    assert!(turned.distance(vec3(0.0, 0.0, -1.0)) < 1e-6, "{turned}");
}

#[test]
fn without_a_frame_the_rest_of_the_file_counts() {
    let still = read(SCENE, None).unwrap();
    let (before, _) = SCENE.split_once("[animation]").unwrap();
    assert_eq!(still, read(before, None).unwrap());
    assert!(read(before, Some(1)).unwrap_err().contains("has no [animation]"));
}

#[test]
fn overrides_change_tracks() {
    let overrides = vec![Override::parse("animation.tracks.4.values=[30, 40]").unwrap()];
    let options = SceneOptions { overrides, frame: Some(1), ..SceneOptions::default() };
    let scene = parse_scene_with(SCENE, Path::new("."), "a.toml", &options).unwrap().scene;
    assert_eq!(scene.settings.samples, Some(30));
}

#[test]
fn wrong_tracks_are_named_with_or_without_a_frame() {
    let cases: [(&str, &str, &[&str]); 9] = [
        ("seed = \"per_frame\"", "seed = \"odd\"", &["[animation]: seed", "\"odd\"", "fixed, per_frame"]),
        (
            "frames = [1, 49]",
            "frames = [49, 1]",
            &["[[animation.tracks]] #1", "frames must hold frame numbers that rise"],
        ),
        ("degrees = [0, 360]", "degrees = [0]", &["degrees has 1 values, and there are 2 frames"]),
        ("orbit = { start", "orbit = { begin", &["#1: orbit", "unknown key \"begin\""]),
        ("values = [10, 20, 0]", "values = [10, 20, [1, 2, 3]]", &["#2", "interpolation = \"step\""]),
        ("values = [10, 20, 0]", "values = [10, 20, { a = 1 }]", &["#2", "values[2] must be a number"]),
        ("interpolation = \"smooth\"", "interpolation = \"cubic\"", &["#3", "\"cubic\"", "step, linear, smooth"]),
        ("key = \"render.samples\"", "key = \"render samples\"", &["#5", "key is no path"]),
        ("interpolation = \"step\"", "interpolation = \"linear\"", &["#4", "interpolation = \"step\""]),
    ];
    for (right, wrong, texts) in cases {
        assert!(SCENE.contains(right), "{right:?}");
        for frame in [None, Some(3)] {
            let error = read(&SCENE.replace(right, wrong), frame).expect_err(wrong);
            for part in texts {
                assert!(error.contains(part), "{wrong:?}: {part:?} is missing in: {error}");
            }
        }
    }
    let error = read(&SCENE.replace("render.samples", "render.sample"), Some(1)).unwrap_err();
    assert!(error.contains("the override render.sample=10") && error.contains("did you mean \"samples\"?"), "{error}");
}
