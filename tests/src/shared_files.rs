//! Files that tests read: the repository's own, and references beside it.

use std::{
    collections::BTreeMap,
    path::{Path, PathBuf},
};

/// The repository's root.
pub fn repository() -> &'static str {
    concat!(env!("CARGO_MANIFEST_DIR"), "/..")
}

/// A file of the folder `shared` beside the repository, which not every machine has; says that a test skips without it.
pub fn shared_file(test: &str, name: &str) -> Option<PathBuf> {
    let path = Path::new(repository()).join("../shared").join(name);
    if path.exists() {
        return Some(path);
    }
    println!("{test} skips: it compares with {}, which is not on this machine", path.display());
    None
}

/// A picture's channels by name, each row by row from the top left.
#[derive(Clone, Debug)]
pub struct Layers {
    /// Pixels along x.
    pub width: usize,
    /// Pixels along y.
    pub height: usize,
    /// The channels.
    pub channels: BTreeMap<String, Vec<f32>>,
}

/// Reads a flat EXR.
///
/// # Panics
/// If the file is none.
pub fn read_exr(path: &Path) -> Layers {
    use exr::prelude::{ReadChannels as _, ReadLayers as _};
    let reader = exr::prelude::read().no_deep_data().largest_resolution_level().all_channels().first_valid_layer();
    let image = reader.all_attributes().from_file(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let size = image.layer_data.size;
    let channels = image.layer_data.channel_data.list.iter();
    Layers {
        width: size.width(),
        height: size.height(),
        channels: channels.map(|c| (c.name.to_string(), c.sample_data.values_as_f32().collect())).collect(),
    }
}
