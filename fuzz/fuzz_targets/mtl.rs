//! MTL text, through an OBJ file whose faces use the materials a and b.
#![no_main]

use std::{fs, sync::LazyLock};

use diacaustic_scene::{MeshOptions, load_obj};
use libfuzzer_sys::fuzz_target;
use tempfile::TempDir;

const OBJ: &str = "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl a\nf 1/1 2/1 3/1\nusemtl b\nf 3/1 2/1 1/1\n";

static FOLDER: LazyLock<TempDir> = LazyLock::new(|| {
    let folder = tempfile::tempdir().expect("a folder for the files");
    fs::write(folder.path().join("m.obj"), OBJ).expect("the OBJ file is written");
    folder
});

fuzz_target!(|bytes: &[u8]| {
    fs::write(FOLDER.path().join("m.mtl"), bytes).expect("the library is written");
    let file = load_obj(&FOLDER.path().join("m.obj"), &MeshOptions::default()).expect("the OBJ file is good");
    assert_eq!(file.materials.len(), 2);
});
