//! The memory that a large file takes on its way to a scene.
#![allow(unsafe_code, reason = "an allocator that counts")]

use std::{
    alloc::{GlobalAlloc, Layout, System},
    fs,
    path::Path,
    sync::atomic::{AtomicUsize, Ordering},
};

use diacaustic_scene::{MaterialKind, StudioOptions, load_gltf_scene};
use serde_json::json;

/// Counts the bytes that are allocated.
struct Counter;

static NOW: AtomicUsize = AtomicUsize::new(0);
static MOST: AtomicUsize = AtomicUsize::new(0);

fn grow(bytes: usize) {
    MOST.fetch_max(NOW.fetch_add(bytes, Ordering::Relaxed) + bytes, Ordering::Relaxed);
}

// SAFETY: every call is handed to the system's allocator as it is.
unsafe impl GlobalAlloc for Counter {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        grow(layout.size());
        // SAFETY: the caller keeps the contract of `alloc`.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        NOW.fetch_sub(layout.size(), Ordering::Relaxed);
        // SAFETY: the caller keeps the contract of `dealloc`.
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counter = Counter;

/// A GLB file of a closed torus of `side` × `side` × 2 triangles with normals.
fn torus(side: usize, material: serde_json::Value) -> Vec<u8> {
    let angle = |k: usize| (k as f32 / side as f32 * std::f32::consts::TAU).sin_cos();
    let (mut positions, mut normals, mut indices) = (Vec::new(), Vec::new(), Vec::<u32>::new());
    for (i, j) in (0..side).flat_map(|i| (0..side).map(move |j| (i, j))) {
        let ((sin_u, cos_u), (sin_v, cos_v)) = (angle(i), angle(j));
        let normal = [cos_u * cos_v, sin_v, sin_u * cos_v];
        positions.extend([cos_u + 0.3 * normal[0], 0.3 * normal[1], sin_u + 0.3 * normal[2]]);
        normals.extend(normal);
        let at = |i: usize, j: usize| (i % side * side + j % side) as u32;
        let [a, b, c, d] = [at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)];
        indices.extend([a, b, c, a, c, d]);
    }
    let floats = |numbers: Vec<f32>| numbers.into_iter().flat_map(f32::to_le_bytes);
    let count = side * side;
    let mut bytes: Vec<u8> = floats(positions).chain(floats(normals)).collect();
    bytes.extend(indices.into_iter().flat_map(u32::to_le_bytes));
    let view = |offset: usize, length: usize| json!({ "buffer": 0, "byteOffset": offset, "byteLength": length });
    let json = json!({
        "asset": { "version": "2.0" }, "buffers": [{ "byteLength": bytes.len() }],
        "bufferViews": [view(0, 12 * count), view(12 * count, 12 * count), view(24 * count, 24 * count)],
        "accessors": [
            { "bufferView": 0, "componentType": 5126, "count": count, "type": "VEC3" },
            { "bufferView": 1, "componentType": 5126, "count": count, "type": "VEC3" },
            { "bufferView": 2, "componentType": 5125, "count": 6 * count, "type": "SCALAR" }
        ],
        "materials": [material],
        "meshes": [{ "primitives": [
            { "attributes": { "POSITION": 0, "NORMAL": 1 }, "indices": 2, "material": 0 }
        ] }],
        "nodes": [{ "mesh": 0 }]
    });
    let mut json = json.to_string().into_bytes();
    json.resize(json.len().next_multiple_of(4), b' ');
    let word = |number: usize| (number as u32).to_le_bytes();
    let length = word(12 + 8 + json.len() + 8 + bytes.len());
    [b"glTF", &word(2)[..], &length, &word(json.len()), b"JSON", &json, &word(bytes.len()), b"BIN\0", &bytes].concat()
}

/// The most bytes that were allocated while a file became a scene, over the file's size.
fn peak(path: &Path) -> (f64, MaterialKind) {
    let size = fs::metadata(path).unwrap().len() as f64;
    let before = NOW.load(Ordering::Relaxed);
    MOST.store(before, Ordering::Relaxed);
    let loaded = load_gltf_scene(path, &StudioOptions::default()).unwrap();
    ((MOST.load(Ordering::Relaxed) - before) as f64 / size, loaded.scene.materials[0].kind.clone())
}

/// `TORUS=3163 cargo test --release -p diacaustic-scene --test memory` takes ten million triangles on each side of the measure.
#[test]
fn a_file_takes_less_than_three_times_its_size() {
    let side = std::env::var("TORUS").map_or(700, |side| side.parse().expect("TORUS is a whole number"));
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("torus.glb");
    fs::write(&path, torus(side, json!({}))).unwrap();
    let (plain, _) = peak(&path);
    let glass = json!({ "pbrMetallicRoughness": { "metallicFactor": 0 }, "extensions": {
        "KHR_materials_transmission": { "transmissionFactor": 1 }, "KHR_materials_volume": { "thicknessFactor": 1 }
    } });
    fs::write(&path, torus(side, glass)).unwrap();
    let (volume, kind) = peak(&path);
    assert!(matches!(kind, MaterialKind::Dielectric { .. }), "{kind:?}");
    println!("{} triangles: {plain:.2} and, of glass, {volume:.2} times the file's size", 2 * side * side);
    assert!(plain < 3.0 && volume < 3.0, "{plain:.2} and, of glass, {volume:.2} times the file's size");
    assert!(plain > 1.5, "the count cannot be right: file and mesh are in memory together");
}
