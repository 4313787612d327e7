//! glTF's JSON, with its buffers in data URIs; posed by its first animation if it has one.
#![no_main]

use std::path::Path;

use diacaustic_scene::{GltfOptions, parse_gltf};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let path = Path::new("/nowhere/fuzz.gltf");
    let _ = parse_gltf(bytes, path, &GltfOptions::default());
    let _ = parse_gltf(bytes, path, &GltfOptions { time: Some(0.5), ..GltfOptions::default() });
});
