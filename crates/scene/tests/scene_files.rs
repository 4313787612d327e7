//! Scenes read from TOML, with their meshes and warnings.

use std::{fs, path::Path, sync::Arc};

use diacaustic_scene::{
    Chart, Dispersion, Layer, LightKind, LoadedScene, MaterialKind, PixelFilter, RenderSettings, ToneCurve, Warning,
    load_scene, parse_scene,
};
use glam::Vec3;

const CAMERA: &str = "[camera]\nposition = [0, 2, 3]\nlook_at = [0, 0, 0]\nvertical_fov = 40\n";
const LAMP: &str = "[[lights]]\ntype = \"sphere\"\ncenter = [1, 2.5, 0.6]\nradius = 0.05\nflux = 35\n";
const MATERIALS: &str = "[materials]\nglass = { type = \"dielectric\", ior = 1.5 }\n\
                         floor = { type = \"diffuse\", albedo = 0.8 }\n";
const BALL: &str = "[[objects]]\nsphere = { center = [0, 0.4, 0], radius = 0.3 }\nmaterial = \"glass\"\n";
const FLOOR: &str = "[[objects]]\nname = \"floor\"\nmaterial = \"floor\"\n\
                     rectangle = { center = [0, 0, 0], edge_u = [4, 0, 0], edge_v = [0, 0, -4] }\n";

const TRIANGLE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

fn parse(parts: &[&str]) -> LoadedScene {
    parse_scene(&parts.concat(), Path::new("base"), "x.toml").unwrap()
}

fn warnings(parts: &[&str]) -> Vec<String> {
    parse(parts).warnings.iter().map(Warning::to_string).collect()
}

/// Loads a scene file beside other files.
fn load(scene: &str, files: &[(&str, &str)]) -> Result<LoadedScene, String> {
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in files {
        fs::write(folder.path().join(name), text).unwrap();
    }
    let path = folder.path().join("x.toml");
    fs::write(&path, scene).unwrap();
    let prefix = format!("{}/", folder.path().display());
    load_scene(&path).map_err(|error| error.to_string().replace(&prefix, ""))
}

#[test]
fn every_key_is_read() {
    let text = r#"
        background = [0.1, 0.2, 0.3]
        ambient = 0.5
        camera = { position = [1, 2, 3], look_at = [1, 2, 0], up = [1, 0, 0], vertical_fov = 30, aperture_radius = 0.1, focus_distance = 2 }
        render = { width = 3, height = 4, samples = 5, photons = 6, target_error = 0.25, seed = 7, max_depth = 8, max_bounces = 0, guiding = false, footprints = true, hue_filter = false, map_filter = true, irradiance_cache = false, map_size = 9, map_budget = 64, filter = "blackman-harris", wavelength = 550 }
        output = { files = ["a.png", "/b/c.EXR"], exposure = -1, tone = "plain", layers = ["depth", "caustic"] }
        lights = [{ type = "sphere", name = "sun", center = [5, 6, 7], radius = 2, flux = [1, 2, 3] }]
        objects = [{ name = "crate", box = { min = [0, 0, 0], max = [1, 2, 3] }, material = "m", translate = [10, 0, 0], rotate = [90, 0, 90], scale = [1, 2, 1], map_size = 16 }]
        [materials.m]
        type = "phong"
        ambient = 0.1
        diffuse = [0.2, 0.3, 0.4]
        specular = 0.5
        shininess = 6
    "#;
    let scene = parse(&[text]).scene;
    assert_eq!((scene.background, scene.ambient), (Vec3::new(0.1, 0.2, 0.3), Vec3::splat(0.5)));
    let camera = &scene.camera;
    assert_eq!((camera.up, camera.vertical_fov), (Vec3::X, 30.0));
    assert_eq!((camera.aperture_radius, camera.focus_distance), (0.1, 2.0));
    let settings = RenderSettings {
        width: 3,
        height: 4,
        samples: Some(5),
        photons: Some(6),
        target_error: 0.25,
        seed: 7,
        max_depth: 8,
        max_bounces: 0,
        guiding: false,
        footprints: true,
        hue_filter: false,
        map_filter: true,
        irradiance_cache: Some(false),
        map_size: Some(9),
        map_budget: Some(64),
        filter: PixelFilter::BlackmanHarris,
        wavelength: Some(550.0),
        paper: None,
    };
    assert_eq!(scene.settings, settings);
    assert_eq!(scene.output.files, [Path::new("base/a.png"), Path::new("/b/c.EXR")]);
    assert_eq!((scene.output.exposure, scene.output.tone), (-1.0, ToneCurve::Plain));
    assert_eq!(scene.output.layers, [Layer::Depth, Layer::Caustic]);
    let sun = LightKind::Sphere { center: Vec3::new(5.0, 6.0, 7.0), radius: 2.0, flux: Vec3::new(1.0, 2.0, 3.0) };
    assert_eq!((scene.lights[0].name.as_str(), &scene.lights[0].kind), ("sun", &sun));
    let phong = MaterialKind::Phong {
        ambient: Vec3::splat(0.1),
        diffuse: Vec3::new(0.2, 0.3, 0.4),
        specular: Vec3::splat(0.5),
        shininess: 6.0,
    };
    assert_eq!((scene.materials[0].name.as_str(), &scene.materials[0].kind), ("m", &phong));
    let object = &scene.objects[0];
    assert_eq!((object.name.as_str(), object.map_size), ("crate", Some(16)));
    assert!(matches!(object.mesh.chart, Chart::Natural(_)));
    // (0, 1, 0): scaled to (0, 2, 0), about x to (0, 0, 2), about z unmoved, translated.
    assert!(object.world_from_object.transform_point3(Vec3::Y).abs_diff_eq(Vec3::new(10.0, 0.0, 2.0), 1e-6));
    // (1, 0, 0): about x unmoved, about z to (0, 1, 0), translated.
    assert!(object.world_from_object.transform_point3(Vec3::X).abs_diff_eq(Vec3::new(10.0, 1.0, 0.0), 1e-6));
}

#[test]
fn omitted_keys_have_defaults() {
    let LoadedScene { scene, warnings } = parse(&[CAMERA, MATERIALS, LAMP, BALL, BALL, FLOOR]);
    assert_eq!(warnings, []);
    assert_eq!(scene.settings, RenderSettings::default());
    assert_eq!((scene.camera.up, scene.camera.focus_distance), (Vec3::Y, 13f32.sqrt()));
    assert_eq!(scene.lights[0].name, "light 1");
    assert_eq!(scene.objects.iter().map(|o| o.name.as_str()).collect::<Vec<_>>(), ["sphere", "sphere 2", "floor"]);
    let glass = MaterialKind::Dielectric {
        ior: 1.5,
        dispersion: Dispersion::None,
        tint: Vec3::ONE,
        absorption: Vec3::ZERO,
        roughness: 0.0,
        priority: 0,
    };
    assert_eq!(scene.materials[scene.objects[0].material_of(0)].kind, glass);
    assert_eq!(scene.objects[0].mesh.triangles.len(), 16128);
}

#[test]
fn reasons_against_caustics_are_told() {
    assert_eq!(
        warnings(&[CAMERA, MATERIALS, LAMP, FLOOR]),
        ["no caustic can form: no object has glass, a mirror, metal or a clear coat, which could focus light"]
    );
    assert_eq!(
        warnings(&[CAMERA, MATERIALS, LAMP, BALL]),
        [
            "no caustic can form: every object is of glass, a mirror or of metal; add one with a diffuse share to catch light"
        ]
    );
    assert!(warnings(&[CAMERA, MATERIALS, BALL, FLOOR])[0].contains("the picture will be black"));
    assert!(warnings(&[CAMERA, MATERIALS, &LAMP.replace("35", "0"), BALL, FLOOR])[0].contains("will be black"));
    let lit = warnings(&["background = 1\n", CAMERA, MATERIALS, BALL, FLOOR]);
    assert_eq!(
        lit,
        [
            "no caustic can form: no light and no surface emits anything; only the background and the ambient light will show"
        ]
    );
}

#[test]
fn surfaces_that_emit_are_lights() {
    let glowing = MATERIALS.replace("albedo = 0.8", "albedo = 0.8, emission = [0, 1, 0]");
    assert_eq!(warnings(&[CAMERA, &glowing, BALL, FLOOR]), [""; 0]);
    let unused = format!("{MATERIALS}lava = {{ type = \"diffuse\", albedo = 0, emission = 9 }}\n");
    assert!(warnings(&[CAMERA, &unused, BALL, FLOOR])[0].contains("will be black"));
}

#[test]
fn gloss_over_a_diffuse_base_both_casts_and_receives() {
    let varnish = "[materials]\nvarnish = { type = \"coated\", albedo = 0.5 }\n";
    let table = FLOOR.replace("\"floor\"", "\"varnish\"");
    assert_eq!(warnings(&[CAMERA, varnish, LAMP, &table]), [""; 0]);
    let matt = varnish.replace("0.5", "0.5, roughness = 0.3");
    assert_eq!(parse(&[CAMERA, &matt, LAMP, &table]).warnings, [Warning::NoCaster]);
    let gold = "[materials]\nvarnish = { type = \"metallic_roughness\" }\n";
    assert_eq!(parse(&[CAMERA, gold, LAMP, &table]).warnings, [Warning::NoReceiver]);
}

#[test]
fn lights_and_cameras_may_be_in_glass_but_not_in_lights() {
    let inside = LAMP.replace("[1, 2.5, 0.6]", "[0.1, 0.45, 0]");
    assert_eq!(warnings(&[CAMERA, MATERIALS, &inside, BALL, FLOOR]), [""; 0]);
    let around_camera = BALL.replace("0.3", "9");
    assert_eq!(warnings(&[CAMERA, MATERIALS, LAMP, &around_camera, FLOOR]), [""; 0]);
    let huge = LAMP.replace("0.05", "9");
    let found = parse(&[CAMERA, MATERIALS, &huge, BALL, FLOOR]).warnings;
    assert_eq!(found, [Warning::CameraInsideLight { light: "light 1".to_owned() }]);
}

#[test]
fn open_and_inverted_dielectrics_are_told() {
    let pane = FLOOR.replace("material = \"floor\"", "material = \"glass\"").replace("\"floor\"", "\"pane\"");
    let found = parse(&[CAMERA, MATERIALS, LAMP, &pane, FLOOR]).warnings;
    assert_eq!(found, [Warning::OpenDielectric { object: "pane".to_owned(), open_edges: 4 }]);
    let tetrahedron = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 4 2\nf 1 3 4\nf 2 4 3\n";
    let object = "[[objects]]\nmesh = \"t.obj\"\nmaterial = \"glass\"\n";
    let scene = [CAMERA, MATERIALS, LAMP, object, FLOOR].concat();
    let found = load(&scene, &[("t.obj", tetrahedron)]).unwrap().warnings;
    assert_eq!(found, [Warning::InsideOutDielectric { object: "t".to_owned() }]);
}

#[test]
fn objects_share_a_mesh_file_and_its_materials() {
    let obj = format!("mtllib t.mtl\n{TRIANGLE}usemtl red\nf 1 2 3\nusemtl blue\nf 1 2 3\n");
    let mtl = "newmtl red\nKd 1 0 0\nmap_Kd red.png\nnewmtl blue\nKd 0 0 1\n";
    let objects = "[[objects]]\nmesh = \"t.obj\"\n[[objects]]\nmesh = \"t.obj\"\nmaterial_slots = { blue = \"glass\" }\n\
                   [[objects]]\nmesh = \"t.obj\"\nmaterial = \"floor\"\nmaterial_slots = { red = \"glass\" }\n";
    let scene = [CAMERA, MATERIALS, LAMP, objects].concat();
    let LoadedScene { scene, warnings } = load(&scene, &[("t.obj", &obj), ("t.mtl", mtl)]).unwrap();
    assert!(Arc::ptr_eq(&scene.objects[0].mesh, &scene.objects[1].mesh));
    assert_eq!(scene.objects.iter().map(|o| o.name.as_str()).collect::<Vec<_>>(), ["t", "t 2", "t 3"]);
    let names = |object: usize| scene.objects[object].materials.iter().map(|m| scene.materials[*m].name.as_str());
    assert_eq!(names(0).collect::<Vec<_>>(), ["red", "blue"]);
    assert_eq!(names(1).collect::<Vec<_>>(), ["red", "glass"]);
    assert_eq!(names(2).collect::<Vec<_>>(), ["glass", "floor"]);
    assert_eq!(scene.materials.len(), 4);
    let is_told = |warning: &&Warning| matches!(warning, Warning::UnreadPicture { material, .. } if material == "red");
    assert_eq!(warnings.iter().filter(is_told).count(), 1);
}

#[test]
fn a_missing_material_library_matters_only_if_needed() {
    let obj = format!("mtllib t.mtl\n{TRIANGLE}usemtl red\nf 1 2 3\n");
    let bare = [CAMERA, MATERIALS, LAMP, BALL, "[[objects]]\nmesh = \"t.obj\"\n"].concat();
    assert_eq!(
        load(&bare, &[("t.obj", &obj)]).unwrap_err(),
        "x.toml:16:1: [[objects]] #2: no material for the mesh's slot \"red\" (t.mtl: the file cannot be read: No such \
         file or directory (os error 2)); name one of [materials] with the key \"material\" or with \"material_slots\""
    );
    let loaded = load(&(bare.clone() + "material = \"floor\"\n"), &[("t.obj", &obj)]).unwrap();
    assert!(matches!(loaded.warnings[..], [Warning::MaterialLibrary { .. }]), "{:?}", loaded.warnings);
    let wrong_slot = bare.clone() + "material_slots = { rod = \"floor\" }\n";
    assert_eq!(
        load(&wrong_slot, &[("t.obj", &obj)]).unwrap_err(),
        "x.toml:18:18: [[objects]] #2: material_slots: there is no material slot \"rod\"; did you mean \"red\"? Known \
         slots of the mesh: red"
    );
    let no_name = obj.replace("usemtl red\n", "usemtl red\nf 1 2 3\nusemtl blue\n").replacen("usemtl red\n", "", 1);
    assert!(load(&bare, &[("t.obj", &no_name)]).unwrap_err().contains("slot faces before the first usemtl"));
}

#[test]
fn mesh_faults_name_both_files() {
    let scene = [CAMERA, MATERIALS, LAMP, FLOOR, "[[objects]]\nmesh = \"t.obj\"\nmaterial = \"glass\"\n"].concat();
    let error = |obj: &str| load(&scene, &[("t.obj", obj)]).unwrap_err();
    assert_eq!(
        error("v 0 0 0\nf 1 2 3\n"),
        "x.toml:18:8: [[objects]] #2: mesh: t.obj:2: face index 2 for the vertex (v), of which there are 1 so far"
    );
    assert_eq!(error("v 0 0 0\nf 1 1 1\n"), "x.toml:18:1: object \"t\": mesh has 1 triangles, all of zero area");
    assert_eq!(
        error("v 3e38 0 0\nv 0 0 0\nv 0 1 0\nf 1 2 3\n"),
        "x.toml:18:1: object \"t\": mesh has the position [3e38, 0.0, 0.0]; each number must be finite and at most 1e9 in \
         size"
    );
}

#[test]
fn a_missing_scene_file_is_named() {
    let error = load_scene(Path::new("/nowhere/x.toml")).unwrap_err();
    assert_eq!(error.to_string(), "/nowhere/x.toml: the file cannot be read: No such file or directory (os error 2)");
}
