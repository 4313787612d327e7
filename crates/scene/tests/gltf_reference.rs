//! Public glTF files, as other readers find them: `gltf_reference/reference.py` made the numbers.

use std::{collections::HashMap, path::Path};

use diacaustic_scene::{Dispersion, GltfFile, GltfObject, GltfOptions, Material, MaterialKind, load_gltf};
use glam::{Vec2, Vec3};
use serde_json::Value;

const FOLDER: &str = "/work/shared/assets";
const REFERENCE: &str = include_str!("gltf_reference/reference.json");

/// How far numbers may differ, against the size of the object.
const TOLERANCE: f32 = 2e-5;

/// Calls a test with each file and what the other readers find in it, if the files are there.
fn for_each_file(test: impl Fn(&str, GltfFile, &Value)) {
    if !Path::new(FOLDER).is_dir() {
        println!("skipped: {FOLDER} has the files of this test and is not there");
        return;
    }
    let reference: Value = serde_json::from_str(REFERENCE).unwrap();
    for (name, expected) in reference.as_object().unwrap() {
        let file = load_gltf(&Path::new(FOLDER).join(name), &GltfOptions::default()).unwrap();
        test(name, file, expected);
    }
}

#[test]
fn objects_are_those_that_another_reader_finds() {
    for_each_file(|name, file, expected| {
        let expected = expected["objects"].as_object().unwrap();
        assert_eq!(file.objects.len(), expected.len(), "{name}");
        for object in &file.objects {
            let material = &file.materials[object.materials[0]].name;
            compare(object, material, nearest(object, expected), name);
        }
    });
}

#[test]
fn materials_are_those_that_another_reader_finds() {
    for_each_file(|name, file, expected| {
        let expected = numbered(expected["materials"].as_array().unwrap());
        for material in &file.materials {
            let of_file = material.name.trim_end_matches(" (thin-walled)");
            compare_material(material, expected[of_file], &format!("{name}, {of_file}"));
        }
        assert!(file.materials.len() <= expected.len(), "{name}");
    });
}

/// The entries by their names, with numbers where names are the same.
fn numbered(entries: &[Value]) -> HashMap<String, &Value> {
    let mut counts = HashMap::<&str, u32>::new();
    let mut named = |entry| {
        let name = entry_name(entry);
        let count = counts.entry(name).or_default();
        *count += 1;
        (if *count == 1 { name.to_owned() } else { format!("{name} {count}") }, entry)
    };
    entries.iter().map(&mut named).collect()
}

fn entry_name(entry: &Value) -> &str {
    entry["name"].as_str().unwrap()
}

fn compare_material(material: &Material, expected: &Value, which: &str) {
    let at = |key: &str| number(&expected[key]);
    let near = |found: f32, key: &str| assert!((found - at(key)).abs() <= TOLERANCE, "{which}: {found} for {key}");
    let color = vector(&expected["color"]);
    let has = |picture: &str| expected["pictures"].as_array().unwrap().iter().any(|name| name == picture);
    let transmits = at("transmission") > 0.0 && (at("metallic") < 1.0 || has("metal"));
    match material.kind {
        MaterialKind::Dielectric { ior, dispersion, tint, absorption, roughness, .. } => {
            assert!(transmits && at("thickness") > 0.0, "{which}");
            near(ior, "ior");
            near(roughness, "roughness");
            let abbe = 20.0 / at("dispersion");
            assert_eq!(dispersion, if abbe.is_finite() { Dispersion::Abbe(abbe) } else { Dispersion::None }, "{which}");
            let distance = at("attenuation_distance");
            let left = (-absorption * distance).exp();
            let stated = if distance > 0.0 { vector(&expected["attenuation_color"]) } else { Vec3::ONE };
            assert!(left.abs_diff_eq(stated, 1e-5) && tint.abs_diff_eq(color, TOLERANCE), "{which}: {left}, {tint}");
        }
        MaterialKind::ThinWalled { ior, tint, roughness } => {
            assert!(transmits && tint.abs_diff_eq(color, TOLERANCE), "{which}: {tint}");
            near(ior, "ior");
            near(roughness, "roughness");
        }
        _ => assert!(!transmits, "{which}: {:?}", material.kind),
    }
    let opaque = if transmits { material.rest() } else { Some(material) };
    if let Some(Material { kind, .. }) = opaque {
        let MaterialKind::MetallicRoughness { base_color, reflectance, metallic, roughness } = *kind else {
            panic!("{which}: {kind:?}")
        };
        near(roughness, "roughness");
        let index = at("ior");
        assert!((reflectance.x - ((index - 1.0) / (index + 1.0)).powi(2)).abs() < 1e-6, "{which}: {reflectance}");
        assert!(base_color.abs_diff_eq(color, TOLERANCE), "{which}: {base_color}");
        assert!(transmits || metallic == at("metallic"), "{which}: {metallic}");
    }
    // A picture of the share of glass, or of metal where there is no other, makes a rest.
    assert_eq!(material.blend.is_some(), transmits && (has("transmission") || is_partly_metal(material)), "{which}");
    let textures = &material.textures;
    assert_eq!(textures.color.is_some(), has("color"), "{which}");
    assert_eq!(textures.roughness.is_some(), has("metal"), "{which}");
    assert_eq!(textures.normal.is_some(), has("normal"), "{which}");
    assert_eq!(textures.emission.is_some(), has("emission") && material.emission != Vec3::ZERO, "{which}");
    assert!(material.emission.abs_diff_eq(vector(&expected["emission"]), TOLERANCE), "{which}");
    compare_coverage(material, expected, which);
}

fn is_partly_metal(material: &Material) -> bool {
    material.rest().is_some_and(|rest| rest.textures.metallic.is_some())
}

fn compare_coverage(material: &Material, expected: &Value, which: &str) {
    let mode = expected["alpha_mode"].as_str().unwrap();
    let is_solid = mode == "OPAQUE" || matches!(material.kind, MaterialKind::Dielectric { .. });
    let alpha = if is_solid { 1.0 } else { number(&expected["color"][3]) };
    let cutoff = (mode == "MASK").then(|| expected["alpha_cutoff"].as_f64().unwrap_or(0.5) as f32);
    assert_eq!((material.opacity, material.opacity_cutoff), (alpha, cutoff.filter(|_| !is_solid)), "{which}");
}

/// The entry of an object's name, of which another of the file may have a number as well, that is nearest to it.
fn nearest<'r>(object: &GltfObject, expected: &'r serde_json::Map<String, Value>) -> &'r Value {
    let own = |name: &str| name == object.name || name.starts_with(&format!("{}_", object.name));
    let distance = |entry: &Value| vector(&entry["position"]).distance(mean_position(object));
    let entries = expected.iter().filter(|(name, _)| own(name)).map(|(_, entry)| entry);
    entries.min_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap()
}

fn compare(object: &GltfObject, material: &str, expected: &Value, file: &str) {
    let mesh = &object.mesh;
    let which = format!("{file}, {}", object.name);
    assert_eq!(Some(mesh.triangles.len() as u64), expected["triangles"].as_u64(), "{which}");
    assert!(material.starts_with(expected["material"].as_str().unwrap()), "{which}: {material}");
    let extent = vector(&expected["extent"]);
    let places: Vec<_> = corners(object).map(|vertex| placed(object, vertex)).collect();
    let lowest = places.iter().copied().fold(Vec3::INFINITY, Vec3::min);
    let highest = places.iter().copied().fold(Vec3::NEG_INFINITY, Vec3::max);
    let size = extent.length() + vector(&expected["position"]).length();
    assert_close(highest - lowest, extent, size, &which);
    assert_close(mean_position(object), vector(&expected["position"]), size, &which);
    let normal = corners(object).map(|vertex| mesh.normals[vertex].as_dvec3()).sum::<glam::DVec3>();
    assert_close((normal / places.len() as f64).as_vec3(), vector(&expected["normal"]), 1.0, &which);
    let Some(uv) = expected.get("uv") else { return };
    let sum = corners(object).map(|vertex| mesh.uvs[vertex].as_dvec2()).sum::<glam::DVec2>();
    let expected = Vec2::new(number(&uv[0]), number(&uv[1]));
    let found = (sum / places.len() as f64).as_vec2();
    assert!(found.distance(expected) <= TOLERANCE * (1.0 + expected.length()), "{which}: {found}, not {expected}");
}

fn corners(object: &GltfObject) -> impl Iterator<Item = usize> + '_ {
    object.mesh.triangles.iter().flatten().map(|vertex| *vertex as usize)
}

fn placed(object: &GltfObject, vertex: usize) -> Vec3 {
    object.world_from_object.transform_point3(object.mesh.positions[vertex])
}

fn mean_position(object: &GltfObject) -> Vec3 {
    let sum = corners(object).map(|vertex| placed(object, vertex).as_dvec3()).sum::<glam::DVec3>();
    (sum / (3 * object.mesh.triangles.len()) as f64).as_vec3()
}

#[track_caller]
fn assert_close(found: Vec3, expected: Vec3, size: f32, which: &str) {
    assert!(found.distance(expected) <= TOLERANCE * size, "{which}: {found}, not {expected}");
}

fn vector(value: &Value) -> Vec3 {
    Vec3::new(number(&value[0]), number(&value[1]), number(&value[2]))
}

fn number(value: &Value) -> f32 {
    value.as_f64().unwrap() as f32
}
