// Bind groups 1 and 2 of the passes that follow paths from where light is seen toward the lights.

/// One dispatch of such a pass: one sample of every pixel.
struct PathParams {
    /// Centre of the lens, metres, world frame.
    position: vec3<f32>,
    /// Index of the sample, where the film does not count them.
    sample_index: u32,
    /// Unit direction of view.
    forward: vec3<f32>,
    /// Seed of the pass.
    seed: u32,
    /// Radiance beyond every object, W/(m² sr).
    background: vec3<f32>,
    /// The most casters that a path meets before it is cut off.
    max_depth: u32,
    /// Ambient radiance of the Phong model, W/(m² sr).
    ambient: vec3<f32>,
    /// Lights on the device.
    light_count: u32,
    /// The media that the camera stands in, as keys.
    media: vec4<u32>,
    /// Spheres among the lights, which come first.
    sphere_count: u32,
    /// The first light that is infinitely far; those after it are too.
    first_sky_light: u32,
    /// The diffuse surfaces that a path meets after its first one.
    max_bounces: u32,
    /// Factor on everything seen: 1/n² in a medium of index n.
    exposure: f32,
}

/// What paths accumulate in.
struct Film {
    /// Rays traced, low and high word.
    rays_low: atomic<u32>,
    rays_high: atomic<u32>,
    /// Invocations that an adapter's loop limit cut short: any makes the result worthless.
    unfinished: atomic<u32>,
    /// Unused.
    padding: u32,
    /// For each pixel, row by row from the top left: the sum of its samples' radiance, W/(m² sr), and their number.
    pixels: array<vec4<f32>>,
}

/// What a path saw of the energy maps.
struct Sighting {
    /// The layer that it met first, two for each object, or NONE.
    layer: u32,
    /// Where on the map's plane it met it.
    x: f32,
    /// The same along y.
    y: f32,
    /// The layer that it met last, after diffuse surfaces, or NONE.
    bounced_layer: u32,
    /// Where on the map's plane it met that.
    bounced_x: f32,
    /// The same along y.
    bounced_y: f32,
    /// Radiance in the picture for an irradiance of 1 W/m² at the first place, 1/sr, mean of the channels.
    weight: f32,
    /// Radiance that the path gathered, W/(m² sr), mean of the channels.
    radiance: f32,
    /// Radiance that came to the first place by the path's next direction, W/(m² sr), but for what next-event estimation and the maps bring
    /// there. Directions are drawn in proportion to the cosine, so that its mean times π is irradiance.
    bounced: vec3<f32>,
    /// One over the distance to what was met there, 1/m; 0 for nothing, negative if the path did not go on from its first place.
    inverse_distance: f32,
}

/// Sums over a pixel's samples of what they met first, and their deviations.
struct DataLayers {
    /// Share of light that the surface sends on.
    albedo: vec3<f32>,
    /// Samples that met a surface.
    surfaces: f32,
    /// Unit shading normal, world frame, on the side of the camera.
    normal: vec3<f32>,
    /// Number, from 1, of the object that the pixel's first sample met; 0 without one.
    object: u32,
    /// Place, metres, world frame.
    position: vec3<f32>,
    /// Number, from 1, of the material that the pixel's first sample met; 0 without one.
    material: u32,
    /// Squared deviations of the samples' radiance from their mean, (W/(m² sr))².
    squares: vec3<f32>,
    /// Distance from the lens along the view, metres.
    depth: f32,
}

/// The layers of light, in the order of their sums: docs/layers.md.
const LAYER_EMISSION: u32 = 0u;
const LAYER_DIRECT: u32 = 1u;
const LAYER_CAUSTIC: u32 = 2u;
const LAYER_INDIRECT: u32 = 3u;
/// Layers of light.
const LIGHT_LAYERS: u32 = 4u;

@group(1) @binding(0) var<uniform> path_params: PathParams;
/// Irradiance of each texel, W/m², in the order of the maps' tiles, row by row; the last component is its variance. With several light groups, of each
/// texel first all light's, then each group's.
@group(2) @binding(0) var irradiance: texture_2d<f32>;
@group(2) @binding(1) var<storage, read_write> film: Film;
/// Where paths note what they see, an entry for each pixel.
@group(2) @binding(2) var<storage, read_write> sightings: array<Sighting>;
/// For each pixel the sums of its layers of light, W/(m² sr); the last component is unused.
@group(2) @binding(3) var<storage, read_write> light_layers: array<vec4<f32>>;
/// An entry for each pixel.
@group(2) @binding(4) var<storage, read_write> data_layers: array<DataLayers>;
/// For each pixel the sums of each light group's light, then of each one's caustic, then of light without group, W/(m² sr); the last component is unused.
@group(2) @binding(5) var<storage, read_write> group_layers: array<vec4<f32>>;
/// The irradiance cache. First for each layer of a map, two for each object, its grid: index of its first node, nodes along x and along y, 0
/// without a grid, and nodes for each unit of the plane. Then the nodes: irradiance by bounced light, W/m², and 1 where it is known.
@group(2) @binding(6) var<storage, read> irradiance_cache: array<vec4<f32>>;
