//! Scene files. A scene that is read is valid.
#![no_main]

use std::path::Path;

use diacaustic_scene::parse_scene;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    if let Ok(loaded) = parse_scene(text, Path::new("/nowhere"), "fuzz.toml") {
        loaded.scene.validate().expect("a scene that is read is valid");
    }
});
