//! glTF files posed by their animations.

mod gltf_file;

use std::{fs, path::Path};

use diacaustic_scene::{GltfFile, GltfOptions, LightKind, MaterialKind, load_scene, parse_gltf};
use glam::{Quat, Vec3};
use gltf_file::{Builder, TETRAHEDRON};
use serde_json::{Value, json};

const QUARTER: f32 = std::f32::consts::FRAC_PI_2;

/// Adds an animation of one channel of node 0.
fn add_animation(builder: &mut Builder, name: &str, path: &str, interpolation: &str, times: &[f32], values: &[f32]) {
    let kind = match path {
        "rotation" => "VEC4",
        "weights" => "SCALAR",
        _ => "VEC3",
    };
    let (input, output) = (builder.floats("SCALAR", times), builder.floats(kind, values));
    let animation = json!({
        "name": name, "channels": [{ "sampler": 0, "target": { "node": 0, "path": path } }],
        "samplers": [{ "input": input, "output": output, "interpolation": interpolation }]
    });
    let animations = &mut builder.json["animations"];
    match animations {
        Value::Array(list) => list.push(animation),
        _ => *animations = json!([animation]),
    }
}

fn read(builder: &Builder, time: Option<f32>, animation: Option<&str>) -> Result<GltfFile, String> {
    let options = GltfOptions { time, animation: animation.map(str::to_owned), ..GltfOptions::default() };
    parse_gltf(&builder.glb(), Path::new("a.glb"), &options).map_err(|error| error.to_string())
}

/// Where the mesh's point (1, 0, 0) is at a time.
fn place(builder: &Builder, time: f32) -> Vec3 {
    read(builder, Some(time), None).unwrap().objects[0].world_from_object.transform_point3(Vec3::X)
}

#[test]
fn key_frames_are_interpolated_as_they_say() {
    let moves = [0.0, 0.0, 0.0, 4.0, 0.0, 0.0];
    let mut line = Builder::tetrahedron();
    add_animation(&mut line, "go", "translation", "LINEAR", &[1.0, 3.0], &moves);
    let x = |builder: &Builder, time| place(builder, time).x - 1.0;
    assert_eq!([-5.0, 1.0, 1.5, 3.0, 100.0].map(|time| x(&line, time)), [0.0, 0.0, 1.0, 4.0, 4.0]);
    let mut step = Builder::tetrahedron();
    add_animation(&mut step, "go", "translation", "STEP", &[1.0, 3.0], &moves);
    assert_eq!([0.0, 1.0, 2.9, 3.0, 4.0].map(|time| x(&step, time)), [0.0, 0.0, 0.0, 4.0, 4.0]);
    // x = t³ has the tangents 0 at 0 and 12 at 2, and Hermite's polynomial is exact for it.
    let mut spline = Builder::tetrahedron();
    let cube = [0.0; 9].into_iter().chain([12.0, 0.0, 0.0, 8.0, 0.0, 0.0, 0.0, 0.0, 0.0]).collect::<Vec<f32>>();
    add_animation(&mut spline, "go", "translation", "CUBICSPLINE", &[0.0, 2.0], &cube);
    for time in [0.0f32, 0.5, 1.0, 1.7, 2.0] {
        assert!((x(&spline, time) - time.powi(3)).abs() < 1e-5, "{time}: {}", x(&spline, time));
    }
    let mut scaled = Builder::tetrahedron();
    add_animation(&mut scaled, "grow", "scale", "LINEAR", &[0.0, 1.0], &[1.0, 1.0, 1.0, 3.0, 1.0, 1.0]);
    assert_eq!(place(&scaled, 0.5), 2.0 * Vec3::X);
}

#[test]
fn rotations_take_the_short_way_round() {
    let half_turn = Quat::from_rotation_z(2.0 * QUARTER * 0.9);
    let values = [Quat::IDENTITY.to_array(), (-half_turn).to_array()].concat();
    let mut builder = Builder::tetrahedron();
    add_animation(&mut builder, "turn", "rotation", "LINEAR", &[0.0, 2.0], &values);
    let found = place(&builder, 1.0);
    assert!(found.abs_diff_eq(Quat::from_rotation_z(0.9 * QUARTER) * Vec3::X, 1e-5), "{found}");
}

#[test]
fn animations_have_names_and_numbers() {
    let mut builder = Builder::tetrahedron();
    add_animation(&mut builder, "still", "translation", "LINEAR", &[0.0], &[0.0, 0.0, 0.0]);
    add_animation(&mut builder, "up", "translation", "LINEAR", &[0.0], &[0.0, 5.0, 0.0]);
    let height = |time, animation| {
        read(&builder, time, animation).map(|file| file.objects[0].world_from_object.transform_point3(Vec3::ZERO).y)
    };
    assert_eq!((height(None, None), height(Some(0.0), None)), (Ok(0.0), Ok(0.0)));
    assert_eq!((height(None, Some("up")), height(Some(9.0), Some("1"))), (Ok(5.0), Ok(5.0)));
    let error = height(None, Some("down")).unwrap_err();
    assert_eq!(error, "a.glb: the animation \"down\" was asked for, and the file has \"still\", \"up\"");
    assert!(height(Some(f32::NAN), None).unwrap_err().contains("the time NaN was asked for"));
    let error = read(&Builder::tetrahedron(), Some(1.0), None).unwrap_err();
    assert_eq!(error, "a.glb: an animation was asked for, and the file has none");
}

#[test]
fn weights_and_joints_follow_an_animation() {
    let mut builder = Builder::tetrahedron();
    let moved = builder.floats("VEC3", &[0.0, 0.0, 2.0].repeat(TETRAHEDRON.len() / 3));
    builder.json["meshes"][0]["primitives"][0]["targets"] = json!([{ "POSITION": moved }, { "POSITION": moved }]);
    add_animation(&mut builder, "swell", "weights", "LINEAR", &[0.0, 1.0], &[0.0, 0.0, 1.0, 0.5]);
    let height = |time| read(&builder, time, None).unwrap().objects[0].mesh.positions[0].z;
    assert_eq!((height(None), height(Some(0.5)), height(Some(1.0))), (0.0, 1.5, 3.0));

    let mut builder = Builder::tetrahedron();
    let count = TETRAHEDRON.len() / 3;
    let joints = builder.view(&[0u8; 4].repeat(count), None);
    let joints =
        builder.accessor(json!({ "bufferView": joints, "componentType": 5121, "count": count, "type": "VEC4" }));
    let weights = builder.floats("VEC4", &[1.0, 0.0, 0.0, 0.0].repeat(count));
    builder.json["meshes"][0]["primitives"][0]["attributes"]["JOINTS_0"] = json!(joints);
    builder.json["meshes"][0]["primitives"][0]["attributes"]["WEIGHTS_0"] = json!(weights);
    builder.json["skins"] = json!([{ "joints": [0] }]);
    builder.json["nodes"] = json!([{}, { "mesh": 0, "skin": 0 }]);
    add_animation(&mut builder, "rise", "translation", "LINEAR", &[0.0, 1.0], &[0.0, 0.0, 0.0, 0.0, 6.0, 0.0]);
    let file = read(&builder, Some(0.5), None).unwrap();
    assert_eq!(file.objects[0].mesh.positions[0], Vec3::new(0.0, 3.0, 0.0));
}

/// A change of a file's JSON.
type Change = fn(&mut Value);

#[test]
fn faults_of_animations_are_named() {
    let fault = |change: Change| {
        let mut builder = Builder::tetrahedron();
        add_animation(&mut builder, "a", "translation", "LINEAR", &[0.0, 1.0], &[0.0; 6]);
        change(&mut builder.json);
        read(&builder, Some(0.5), None).unwrap_err()
    };
    let cases: [(Change, &str); 10] = [
        (|json| json["animations"][0]["channels"][0]["sampler"] = json!(3), "names samplers[3]"),
        (|json| json["animations"][0]["channels"][0]["target"]["node"] = json!(3), "names nodes[3]"),
        (|json| json["animations"][0]["channels"][0]["target"]["path"] = json!("color"), "has an unknown path"),
        (|json| json["animations"][0]["channels"][0]["target"]["path"] = json!("rotation"), "is of type Vec3, but"),
        (
            |json| json["animations"][0]["samplers"][0]["interpolation"] = json!("SMOOTH"),
            "has an unknown interpolation",
        ),
        (|json| json["animations"][0]["samplers"][0]["interpolation"] = json!("CUBICSPLINE"), "has 2 values for 2"),
        (|json| json["animations"][0]["samplers"][0]["input"] = json!(99), "names accessors[99]"),
        (|json| json["accessors"][2]["count"] = json!(0), "do not rise, or none"),
        (|json| json["accessors"][2]["count"] = json!(1u64 << 40), "brings the animation to more than 16777216"),
        (
            |json| json["nodes"][0]["matrix"] = json!([1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]),
            "has a matrix and is animated",
        ),
    ];
    for (change, text) in cases {
        let message = fault(change);
        assert!(message.contains(text), "{message} must say {text}");
    }
    let mut builder = Builder::tetrahedron();
    add_animation(&mut builder, "a", "translation", "LINEAR", &[0.0, 1.0], &[0.0, 0.0, 0.0, f32::NAN, 0.0, 0.0]);
    assert!(read(&builder, Some(0.5), None).unwrap_err().contains("not finite at 0.5 s"));
    add_animation(&mut builder, "b", "translation", "LINEAR", &[1.0, 0.0], &[0.0; 6]);
    assert!(read(&builder, None, Some("b")).unwrap_err().contains("do not rise"));
}

/// Adds a channel to the first animation, or makes it, that sets what a pointer names.
fn add_pointer(builder: &mut Builder, pointer: &str, kind: &str, times: &[f32], values: &[f32]) {
    if builder.json["animations"].is_null() {
        builder.json["animations"] = json!([{ "channels": [], "samplers": [] }]);
    }
    let (input, output) = (builder.floats("SCALAR", times), builder.floats(kind, values));
    let animation = &mut builder.json["animations"][0];
    let sampler = animation["samplers"].as_array().unwrap().len();
    let target = json!({ "path": "pointer", "extensions": { "KHR_animation_pointer": { "pointer": pointer } } });
    animation["channels"].as_array_mut().unwrap().push(json!({ "sampler": sampler, "target": target }));
    animation["samplers"].as_array_mut().unwrap().push(json!({ "input": input, "output": output }));
    builder.json["extensionsUsed"] = json!(["KHR_animation_pointer"]);
    builder.json["extensionsRequired"] = json!(["KHR_animation_pointer"]);
}

#[test]
fn pointers_set_nodes_materials_lights_and_cameras() {
    let mut builder = Builder::tetrahedron();
    let light = json!({ "type": "point", "intensity": 683 });
    builder.json["extensions"] = json!({ "KHR_lights_punctual": { "lights": [light] } });
    builder.json["cameras"] = json!([{ "type": "perspective", "perspective": { "yfov": 1, "znear": 1 } }]);
    builder.json["nodes"] =
        json!([{ "mesh": 0 }, { "extensions": { "KHR_lights_punctual": { "light": 0 } } }, { "camera": 0 }]);
    builder.json["materials"] = json!([{}]);
    builder.json["meshes"][0]["primitives"][0]["material"] = json!(0);
    let times = [0.0, 2.0];
    add_animation(&mut builder, "all", "scale", "LINEAR", &times, &[1.0, 1.0, 1.0, 3.0, 3.0, 3.0]);
    let half_turn = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 0.0];
    add_pointer(&mut builder, "/nodes/0/rotation", "VEC4", &times, &half_turn);
    let color = "/materials/0/pbrMetallicRoughness/baseColorFactor";
    // A spline may swing beyond what is allowed; a line that does stands for it.
    add_pointer(&mut builder, color, "VEC4", &times, &[0.0, 0.5, 0.0, 1.0, 1.0, 0.5, 4.0, 1.0]);
    add_pointer(&mut builder, "/materials/0/extensions/KHR_materials_ior/ior", "SCALAR", &times, &[1.5, 2.5]);
    add_pointer(&mut builder, "/extensions/KHR_lights_punctual/lights/0/intensity", "SCALAR", &times, &[683.0, 2049.0]);
    add_pointer(&mut builder, "/cameras/0/perspective/yfov", "SCALAR", &times, &[1.0, 2.0]);
    let file = read(&builder, Some(1.0), None).unwrap();
    assert_eq!(file.warnings, []);
    let found = file.objects[0].world_from_object.transform_point3(Vec3::X);
    assert!(found.abs_diff_eq(Vec3::new(0.0, 2.0, 0.0), 1e-6), "{found}");
    let MaterialKind::MetallicRoughness { base_color, reflectance, .. } = file.materials[0].kind else {
        panic!("{:?}", file.materials[0].kind)
    };
    assert_eq!(base_color, Vec3::new(0.5, 0.5, 1.0));
    assert!((reflectance.x - (1.0f32 / 3.0).powi(2)).abs() < 1e-6, "{reflectance}");
    let LightKind::Point { flux, .. } = file.lights[0].kind else { panic!("{:?}", file.lights[0].kind) };
    assert!((flux.x - 8.0 * std::f32::consts::PI).abs() < 1e-4, "{flux}");
    assert!((file.cameras[0].camera.vertical_fov - 1.5f32.to_degrees()).abs() < 1e-4);
    // At rest nothing moves, and nothing is said.
    let rest = read(&builder, None, None).unwrap();
    assert_eq!((rest.objects[0].world_from_object.transform_point3(Vec3::X), rest.warnings), (Vec3::X, vec![]));
}

#[test]
fn pointers_that_lead_nowhere_are_named() {
    let mut builder = Builder::tetrahedron();
    builder.json["nodes"][0]["matrix"] = json!([1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]);
    let nowhere = ["/nodes/0/children", "/nodes/9/translation", "/nodes/0/scale", "/materials/0/alphaCutoff"];
    for pointer in nowhere {
        let kind = if pointer.ends_with("Cutoff") { "SCALAR" } else { "VEC3" };
        add_pointer(&mut builder, pointer, kind, &[0.0], if kind == "SCALAR" { &[1.0] } else { &[1.0; 3] });
    }
    let file = read(&builder, Some(0.0), None).unwrap();
    let said: String = file.warnings.iter().map(|warning| format!("{warning}\n")).collect();
    for (number, pointer) in nowhere.into_iter().enumerate() {
        assert!(
            said.contains(&format!("a.glb: animations[0].channels[{number}]: animates {pointer:?}, which")),
            "{said}"
        );
    }
    let mut builder = Builder::tetrahedron();
    add_pointer(&mut builder, "/nodes/0/scale", "SCALAR", &[0.0], &[1.0]);
    let error = read(&builder, Some(0.0), None).unwrap_err();
    assert!(error.contains("is of type Scalar, but animations[0].channels[0] needs Vec3"), "{error}");
}

#[test]
fn a_scene_file_names_time_animation_and_variant() {
    let folder = tempfile::tempdir().unwrap();
    let mut builder = Builder::tetrahedron();
    add_animation(&mut builder, "go", "translation", "LINEAR", &[0.0, 2.0], &[0.0, 0.0, 0.0, 4.0, 0.0, 0.0]);
    builder.json["materials"] = json!([{ "name": "plain" }, { "name": "red" }]);
    builder.json["extensions"] = json!({ "KHR_materials_variants": { "variants": [{ "name": "festive" }] } });
    let mappings = json!({ "mappings": [{ "material": 1, "variants": [0] }] });
    builder.json["meshes"][0]["primitives"][0]["extensions"] = json!({ "KHR_materials_variants": mappings });
    fs::write(folder.path().join("m.glb"), builder.glb()).unwrap();
    let load = |object: &str| {
        let path = folder.path().join("scene.toml");
        let text = format!(
            "camera = {{ position = [0, 2, 5], look_at = [0, 0, 0], vertical_fov = 40 }}
             materials.m = {{ type = \"mirror\", reflectance = 1 }}
             [[lights]]\ntype = \"point\"\nposition = [0, 5, 0]\nflux = 100
             [[objects]]\n{object}"
        );
        fs::write(&path, text).unwrap();
        load_scene(&path).map(|loaded| loaded.scene).map_err(|error| error.to_string())
    };
    let scene =
        load("mesh = \"m.glb\"\ntime = 0.5\nvariant = \"festive\"\n[[objects]]\nmesh = \"m.glb\"\nanimation = \"0\"")
            .unwrap();
    let x = |object: usize| scene.objects[object].world_from_object.translation.x;
    assert_eq!((x(0), x(1)), (1.0, 0.0));
    let name = |object: usize| scene.materials[scene.objects[object].materials[0]].name.as_str();
    assert_eq!((name(0), name(1)), ("red", "default"));
    let error = load("mesh = \"m.glb\"\nvariant = \"plain\"").unwrap_err();
    assert!(error.contains("the material variant \"plain\" was asked for, and the file has \"festive\""), "{error}");
    let error = load("sphere = { center = [0, 0, 0], radius = 1 }\nmaterial = \"m\"\ntime = 1").unwrap_err();
    assert!(error.contains("time goes with a glTF file alone"), "{error}");
}
