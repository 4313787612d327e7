//! Public glTF files, as another reader finds them: `gltf_reference/reference.py` made the numbers.

use std::path::Path;

use diacaustic_scene::{GltfObject, GltfOptions, load_gltf};
use glam::{Vec2, Vec3};
use serde_json::Value;

const FOLDER: &str = "/work/shared/assets";
const REFERENCE: &str = include_str!("gltf_reference/reference.json");

/// How far numbers may differ, against the size of the object.
const TOLERANCE: f32 = 2e-5;

#[test]
fn objects_are_those_that_another_reader_finds() {
    if !Path::new(FOLDER).is_dir() {
        println!("skipped: {FOLDER} has the files of this test and is not there");
        return;
    }
    let reference: Value = serde_json::from_str(REFERENCE).unwrap();
    for (name, expected) in reference.as_object().unwrap() {
        let expected = expected.as_object().unwrap();
        let file = load_gltf(&Path::new(FOLDER).join(name), &GltfOptions::default()).unwrap();
        assert_eq!(file.objects.len(), expected.len(), "{name}");
        for object in &file.objects {
            let material = &file.materials[object.materials[0]].name;
            compare(object, material, nearest(object, expected), name);
        }
    }
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
