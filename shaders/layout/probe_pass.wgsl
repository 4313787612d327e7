// Bind group 1 of the pass that looks at what the maps hold.

import package::layout::path_pass::Sighting;

/// One dispatch of the pass.
struct ProbeParams {
    /// Places to look at.
    count: u32,
    /// Entries of irradiance of each texel, of which the first is of all light.
    entries: u32,
    /// Unused.
    padding_0: u32,
    /// Unused.
    padding_1: u32,
}

@group(1) @binding(0) var<uniform> probe_params: ProbeParams;
/// Irradiance of each texel, W/m²: path_pass.wgsl.
@group(1) @binding(1) var probed_irradiance: texture_2d<f32>;
/// Where camera paths met the maps.
@group(1) @binding(2) var<storage, read> sighted: array<Sighting>;
/// The irradiance there, W/m², over about a pixel; the last component is unused.
@group(1) @binding(3) var<storage, read_write> map_sightings: array<vec4<f32>>;
