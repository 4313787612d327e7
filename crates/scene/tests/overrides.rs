//! Values in place of the scene file's.

use std::path::Path;

use diacaustic_scene::{LoadedScene, MaterialKind, Override, SceneOptions, parse_scene, parse_scene_with};
use glam::{Vec3, vec3};

const SCENE: &str = r#"
    camera = { position = [0, 2, 3], look_at = [0, 0, 0], vertical_fov = 40 }

    [materials]
    glass = { type = "dielectric", ior = 1.5 }
    "matt floor" = { type = "diffuse", albedo = 0.5 }

    [[lights]]
    type = "point"
    position = [0, 2, 0]
    flux = 35

    [[objects]]
    name = "ball"
    sphere = { center = [0, 0.3, 0], radius = 0.3, subdivisions = 1 }
    material = "glass"

    [[objects]]
    name = "floor"
    rectangle = { center = [0, 0, 0], edge_u = [4, 0, 0], edge_v = [0, 0, -4] }
    material = "matt floor"
"#;

fn read(overrides: &[&str]) -> Result<LoadedScene, String> {
    let overrides = overrides.iter().map(|text| Override::parse(text));
    let overrides = overrides.collect::<Result<_, _>>().map_err(|error| error.to_string())?;
    let options = SceneOptions { overrides, ..SceneOptions::default() };
    parse_scene_with(SCENE, Path::new("."), "a.toml", &options).map_err(|error| error.to_string())
}

#[test]
fn every_kind_of_place_can_be_set() {
    let scene = read(&[
        "render.samples=64",
        "camera.position = [0, 1, 2]",
        "camera.look_at.1=0.25",
        "materials.glass.ior=1.9",
        "materials.\"matt floor\".albedo=[0.1, 0.2, 0.3]",
        "lights.0.flux=10",
        "objects.ball.material=\"matt floor\"",
        "objects.1.rectangle.center=[0, -1, 0]",
        "background=0.5",
        "output={ exposure = 2 }",
    ])
    .unwrap()
    .scene;
    assert_eq!(scene.settings.samples, 64);
    assert_eq!((scene.camera.position, scene.camera.look_at), (vec3(0.0, 1.0, 2.0), vec3(0.0, 0.25, 0.0)));
    assert!(matches!(scene.materials[0].kind, MaterialKind::Dielectric { ior: 1.9, .. }));
    let albedo = vec3(0.1, 0.2, 0.3);
    assert!(matches!(scene.materials[1].kind, MaterialKind::Diffuse { albedo: found } if found == albedo));
    assert_eq!(scene.objects[0].materials, [1]);
    assert!(scene.objects[1].mesh.positions.iter().all(|position| position.y == -1.0));
    assert_eq!((scene.background, scene.output.exposure), (Vec3::splat(0.5), 2.0));
    assert_eq!(scene.lights[0].kind.strength().x, 10.0 / (4.0 * std::f32::consts::PI));
}

#[test]
fn later_overrides_see_what_earlier_ones_set() {
    let steps = ["materials.metal={ type = \"conductor\", metal = \"gold\" }", "objects.ball.material=\"metal\""];
    let scene = read(&[steps[0], steps[1], "materials.metal.roughness=0.2", "materials.metal.roughness=0.4"]).unwrap();
    let metal = &scene.scene.materials[scene.scene.objects[0].materials[0]];
    assert!(matches!(metal.kind, MaterialKind::Conductor { roughness: 0.4, .. }), "{metal:?}");
}

#[test]
fn none_changes_nothing() {
    assert_eq!(read(&[]).unwrap(), parse_scene(SCENE, Path::new("."), "a.toml").unwrap());
}

#[test]
fn wrong_paths_name_the_key_and_the_nearest_known_one() {
    let cases: [(&str, &[&str]); 12] = [
        ("rendr.samples=64", &["the override rendr.samples=64", "unknown key \"rendr\"", "did you mean \"render\"?"]),
        ("render.sample=64", &["[render]", "unknown key \"sample\"", "did you mean \"samples\"?"]),
        ("materials.glas.ior=2", &["the override materials.glas.ior:", "materials has no \"glas\"", "mean \"glass\"?"]),
        ("objects.bal.material=\"glass\"", &["objects has no \"bal\"", "mean \"ball\"?", "a number from 0 to 1"]),
        ("objects.ball.box.min=[0, 0, 0]", &["objects.ball has no \"box\"", "known keys:", "sphere"]),
        ("lights.1.flux=1", &["lights has no element 1; it has 1, from 0"]),
        ("lights.lamp.flux=1", &["lights has no \"lamp\"", "there are no names", "a number from 0 to 0"]),
        ("materials.glass.ior.red=1", &["materials.glass.ior is a value of type float", "has no \"red\" in it"]),
        ("camera.position.3=1", &["camera.position has no element 3; it has 3, from 0"]),
        (
            "materials.glass.ior=\"high\"",
            &["the override materials.glass.ior=\"high\": [materials.glass]: ior: expected a number"],
        ),
        ("render.samples=0", &["the override render.samples=0: render: samples"]),
        ("objects.ball.material=\"glas\"", &["the override objects.ball.material=\"glas\"", "mean \"glass\"?"]),
    ];
    for (text, expected) in cases {
        let error = read(&[text]).expect_err(text);
        for part in expected {
            assert!(error.contains(part), "{text}: {part:?} is missing in: {error}");
        }
    }
}

#[test]
fn what_is_no_key_and_value_is_refused() {
    for text in ["", "render.samples", "=1", "render.=1", "a b=1", "render.samples=", "a\nb=1", "a#=1", "material=gold"]
    {
        let error = Override::parse(text).expect_err(text).to_string();
        assert!(error.starts_with("the override "), "{error}");
    }
    let quoted = Override::parse("materials.\"a=b.c\".ior = 1.5").unwrap();
    assert_eq!((quoted.path().as_str(), quoted.value()), ("materials.\"a=b.c\".ior", "1.5"));
    assert_eq!(quoted.to_string().parse::<Override>().unwrap(), quoted);
}
