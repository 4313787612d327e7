//! PLY files, binary and as text.
#![no_main]

use std::path::Path;

use diacaustic_scene::{MeshOptions, parse_ply};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    if let Ok(file) = parse_ply(bytes, Path::new("fuzz.ply"), &MeshOptions::default()) {
        let vertices = file.mesh.positions.len();
        assert!(file.mesh.triangles.as_flattened().iter().all(|vertex| (*vertex as usize) < vertices));
    }
});
