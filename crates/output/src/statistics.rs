//! Statistics as JSON. The fields are described, with an example, in `docs/statistics.md`.

use std::path::Path;

use serde::Serialize;

use crate::{Error, replace::replace};

/// What a render did: the content of a statistics file.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Statistics {
    /// The version of diacaustic.
    pub version: String,
    /// The scene file, as it was named.
    pub scene: String,
    /// The seed of every random number.
    pub seed: u32,
    /// Whether the time limit left photons or samples out.
    pub time_limit_reached: bool,
    /// Whether a signal, such as that of Ctrl-C, left photons or samples out.
    pub interrupted: bool,
    /// The adapter.
    pub adapter: Adapter,
    /// What the scene weighs.
    pub size: SceneSize,
    /// Wall-clock time of each stage.
    pub seconds: Seconds,
    /// The photon pass.
    pub photons: Photons,
    /// The camera pass.
    pub camera: CameraRays,
    /// The energy maps.
    pub maps: Vec<Map>,
    /// The lights, in the scene's order.
    pub lights: Vec<LightLedger>,
}

/// The adapter that rendered.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Adapter {
    /// Its name.
    pub name: String,
    /// The driver's name and version.
    pub driver: String,
    /// The interface that reached it: `vulkan`, `metal` or `dx12`.
    pub backend: String,
}

/// What the scene weighs.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct SceneSize {
    /// Width of the picture, pixels.
    pub width: u32,
    /// Height of the picture, pixels.
    pub height: u32,
    /// Triangles with an area.
    pub triangles: u64,
    /// Nodes of the bounding volume hierarchy.
    pub bvh_nodes: u64,
    /// Bytes of the scene, the maps and the film on the device.
    pub device_bytes: u64,
    /// Bytes of the sums of all energy maps.
    pub map_bytes: u64,
    /// Bytes that the sums of maps whose size the scene leaves open may take.
    pub map_budget: u64,
    /// Whether the maps are filtered.
    pub map_filter: bool,
}

/// Wall-clock time of each stage, seconds.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Seconds {
    /// Reading the scene file and its meshes.
    pub load: f64,
    /// Opening the device.
    pub device: f64,
    /// Compiling the kernels and testing the adapter.
    pub kernels: f64,
    /// Building the hierarchy.
    pub bvh: f64,
    /// Laying out the maps and integrating their texels' areas.
    pub maps: f64,
    /// Sending the scene to the device.
    pub upload: f64,
    /// Finding where photons matter.
    pub pilot: f64,
    /// The photon pass.
    pub photons: f64,
    /// The camera pass.
    pub samples: f64,
    /// Reading back and writing pictures and maps.
    pub write: f64,
    /// Everything, from the start of the program to the last picture or map written.
    pub total: f64,
}

/// The photon pass.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Photons {
    /// Photons emitted, over every light.
    pub emitted: u64,
    /// Photons that reached a receiver through a caster.
    pub deposits: u64,
    /// The share of photons that did.
    pub deposit_share: f64,
    /// The share that would have without a guide, as far as the pilot says; none without a pilot.
    pub unguided_deposit_share: Option<f64>,
    /// Photons of the pilot, which are thrown away; 0 without.
    pub pilot: u64,
    /// Rays.
    pub rays: u64,
    /// Photons a second.
    pub photons_per_second: f64,
    /// Rays a second.
    pub rays_per_second: f64,
}

/// The camera pass.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct CameraRays {
    /// Samples in each pixel, at least.
    pub samples: u32,
    /// Samples in a pixel, on average.
    pub mean_samples: f64,
    /// The root of the mean squared error of pixels' radiance, relative to it, as estimated; none where samples are stated.
    pub estimated_error: Option<f64>,
    /// Rays, shadow rays among them.
    pub rays: u64,
    /// Samples a second, over every pixel.
    pub samples_per_second: f64,
    /// Rays a second.
    pub rays_per_second: f64,
}

/// One object's energy map.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Map {
    /// The object's name.
    pub object: String,
    /// Texels along x.
    pub width: u32,
    /// Texels along y.
    pub height: u32,
    /// 1, or 2 if both sides of the surface are held.
    pub layers: u32,
    /// Tiles.
    pub tiles: u64,
    /// Texels of all tiles.
    pub texels: u64,
    /// Mean width of its texels where the camera sees it, metres.
    pub texel_width: f64,
    /// What that would be without a budget.
    pub wanted_texel_width: f64,
    /// Width of its finest texels, metres.
    pub finest_texel_width: f64,
}

/// What became of one light's photons: W for each channel [r, g, b].
///
/// `emitted` is the sum of the accounts after it, but for the rounding of this file's numbers; `residue` says so in the integers
/// that were counted.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct LightLedger {
    /// The light's name.
    pub name: String,
    /// Its radiant flux.
    pub flux: [f64; 3],
    /// The part of it that photons carried: what was aimed at casters.
    pub emitted: [f64; 3],
    /// What fell into energy maps.
    pub deposited: [f64; 3],
    /// What met a receiver before any caster, which is the camera pass's.
    pub direct: [f64; 3],
    /// What tints, media, mirrors and lights took.
    pub absorbed: [f64; 3],
    /// What left the scene.
    pub escaped: [f64; 3],
    /// What met more surfaces than allowed.
    pub cut_off: [f64; 3],
    /// What interpolated normals took (negative: gave).
    pub shading_normals: [f64; 3],
    /// Taken (negative: given) by the colours of single wavelengths; its mean is 0.
    pub dispersion: [f64; 3],
    /// Emitted minus all other accounts, units of the fixed-point sums: 0.
    pub residue: [i64; 3],
}

/// Writes statistics as indented JSON.
///
/// # Errors
/// If the file cannot be written.
pub fn write_statistics(path: &Path, statistics: &Statistics) -> Result<(), Error> {
    let mut text = serde_json::to_string_pretty(statistics)
        .map_err(|source| Error::Write { path: path.to_owned(), source: source.into() })?;
    text.push('\n');
    replace(path, |file| std::io::Write::write_all(file, text.as_bytes()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_fields_have_their_names() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("statistics.json");
        let statistics = Statistics {
            version: "0.1.0".into(),
            maps: vec![Map {
                object: "floor".into(),
                width: 8,
                height: 4,
                layers: 1,
                texel_width: 0.5,
                ..Map::default()
            }],
            lights: vec![LightLedger { name: "lamp".into(), residue: [0, -1, 0], ..Default::default() }],
            ..Default::default()
        };
        write_statistics(&path, &statistics).unwrap();
        let read: serde_json::Value = serde_json::from_str(&std::fs::read_to_string(&path).unwrap()).unwrap();
        assert_eq!(read["version"], "0.1.0");
        assert_eq!(read["maps"][0]["object"], "floor");
        assert_eq!(read["maps"][0]["texel_width"], 0.5);
        assert_eq!(read["lights"][0]["residue"][1], -1);
        for key in ["scene", "seed", "time_limit_reached", "adapter", "size", "seconds", "photons", "camera"] {
            assert!(!read[key].is_null(), "{key}");
        }
    }
}
