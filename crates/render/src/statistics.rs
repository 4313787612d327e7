//! What a render did and what it weighs.

use std::time::Duration;

/// What became of one light's photons, in units of fixed-point sums. The terms are differences of the same integers, so that
/// emitted = deposited + direct + absorbed + escaped + cut off + shading normals + dispersion exactly.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Ledger {
    /// Flux that left the light toward the casters' bounds.
    pub emitted: [i64; 3],
    /// Flux in energy maps.
    pub deposited: [i64; 3],
    /// Flux that met a receiver before any caster: the camera pass owns it.
    pub direct: [i64; 3],
    /// Flux lost to tints, media, mirrors and lights.
    pub absorbed: [i64; 3],
    /// Flux that left the scene.
    pub escaped: [i64; 3],
    /// Flux of paths that met more surfaces than allowed.
    pub cut_off: [i64; 3],
    /// Flux taken (negative: given) by interpolated normals.
    pub shading_normals: [i64; 3],
    /// Flux taken (negative: given) by the colours of single wavelengths; its mean is 0.
    pub dispersion: [i64; 3],
    /// Units in a watt, times the photons emitted over every light.
    pub units_per_watt: f64,
}

/// The size of one object's energy map.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct MapSize {
    /// Index of the object.
    pub object: usize,
    /// Texels along x of its layout; of a map whose size the scene leaves open those of the resampled map.
    pub width: u32,
    /// The same along y.
    pub height: u32,
    /// Layers.
    pub layers: u32,
    /// Tiles of all layers.
    pub tiles: u64,
    /// Texels of all tiles.
    pub texels: u64,
    /// Width of its texels where the camera sees it, on average over pixels, metres; over all of it where it is not seen.
    pub texel_width: f64,
    /// What that would be without a budget. Greater `texel_width` says what was given up here.
    pub wanted_texel_width: f64,
    /// Width of its finest texels, metres.
    pub finest_texel_width: f64,
}

/// Something that shines.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct LightReport {
    /// Its name; "material" and the material's name for an emissive material.
    pub name: String,
    /// Radiant flux, W per channel; of light from infinitely far, what enters a sphere around the scene.
    pub flux: [f32; 3],
}

/// What the pilots did that found where photons matter.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct PilotReport {
    /// Photons that flew and were thrown away, over every light.
    pub photons: u64,
    /// The share of photons that would reach a receiver through a caster without a guide, 0 to 1.
    pub unguided_share: f64,
    /// Time that it all took, the camera's paths among it.
    pub time: Duration,
}

/// What setting a scene built.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct SceneReport {
    /// Triangles with an area.
    pub triangles: usize,
    /// Nodes of the bounding volume hierarchy.
    pub bvh_nodes: usize,
    /// Time to build the hierarchy.
    pub bvh_time: Duration,
    /// Time to lay out the maps, choose their tiles and integrate their texels' areas.
    pub maps_time: Duration,
    /// The pilots; none if photons are not guided and every map has a stated size, or no light reaches a caster.
    pub pilot: Option<PilotReport>,
    /// Bytes that the sums of all maps take on the device, those of each light group apart.
    pub map_bytes: u64,
    /// Bytes that the sums of maps whose size the scene leaves open may take.
    pub map_budget: u64,
    /// Bytes of the scene, the maps and the film on the device.
    pub device_bytes: u64,
    /// The maps.
    pub maps: Vec<MapSize>,
    /// Photons after which every light has had its turns once: the sum of the lights' shares; 0 if none sends photons, for all are dark
    /// or there is no caster.
    pub photon_turns: u64,
    /// The lights of the scene, then the materials with emission that objects show.
    pub lights: Vec<LightReport>,
}

/// What the device has counted since the scene was set.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Statistics {
    /// Photons emitted, over every light.
    pub photons: u64,
    /// Photons that reached a receiver through a caster.
    pub deposits: u64,
    /// Rays of the photon pass.
    pub photon_rays: u64,
    /// Samples in each pixel, at least.
    pub samples: u32,
    /// Samples in a pixel, on average.
    pub mean_samples: f64,
    /// Rays of the camera pass, shadow rays among them.
    pub camera_rays: u64,
    /// A ledger for each of [`SceneReport::lights`].
    pub ledgers: Vec<Ledger>,
}
