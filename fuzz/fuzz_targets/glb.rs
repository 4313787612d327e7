//! GLB files as scenes of their own. The input is JSON, a zero byte, and the bytes of the first buffer: a container is put around them, so
//! that lengths are right. What begins as GLB is taken as it is, at rest and posed by its first animation. A scene that is read is valid.
#![no_main]

use std::{fs, sync::LazyLock};

use diacaustic_scene::{GltfOptions, StudioOptions, load_gltf_scene};
use libfuzzer_sys::fuzz_target;
use tempfile::TempDir;

static FOLDER: LazyLock<TempDir> = LazyLock::new(|| tempfile::tempdir().expect("a folder for the file"));

fuzz_target!(|bytes: &[u8]| {
    let path = FOLDER.path().join("fuzz.glb");
    let file = if bytes.starts_with(b"glTF") { bytes.to_vec() } else { container(bytes) };
    fs::write(&path, file).expect("the file is written");
    for time in [None, Some(0.5)] {
        let options = StudioOptions { floor: true, file: GltfOptions { time, ..GltfOptions::default() } };
        let Ok(loaded) = load_gltf_scene(&path, &options) else { continue };
        loaded.scene.validate().expect("a scene that is read is valid");
        for object in &loaded.scene.objects {
            let tangents = object.corner_tangents(&loaded.scene.materials);
            assert!(tangents.as_flattened().iter().all(|tangent| tangent.is_finite()), "tangents are finite");
        }
    }
});

fn container(bytes: &[u8]) -> Vec<u8> {
    let end = bytes.iter().position(|byte| *byte == 0).unwrap_or(bytes.len());
    let (json, rest) = bytes.split_at(end);
    let rest = rest.get(1..).unwrap_or_default();
    let word = |number: usize| (number as u32).to_le_bytes();
    let length = word(12 + 8 + json.len() + 8 + rest.len());
    [b"glTF", &word(2)[..], &length, &word(json.len()), b"JSON", json, &word(rest.len()), b"BIN\0", rest].concat()
}
