//! OBJ text, without libraries.
#![no_main]

use std::path::Path;

use diacaustic_scene::{MeshOptions, parse_obj};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    if let Ok(file) = parse_obj(bytes, Path::new("/nowhere/fuzz.obj"), &MeshOptions::default()) {
        let vertices = file.mesh.positions.len();
        assert!(file.mesh.triangles.as_flattened().iter().all(|vertex| (*vertex as usize) < vertices));
        assert!([0, vertices].contains(&file.mesh.normals.len()) && [0, vertices].contains(&file.mesh.uvs.len()));
        assert!(file.mesh.normals.iter().all(|normal| (normal.length() - 1.0).abs() < 1e-3));
    }
});
