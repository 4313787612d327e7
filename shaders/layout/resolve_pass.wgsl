// The bindings of the pass that turns the fixed-point sums into irradiance.

/// One dispatch of the resolve pass.
struct ResolveParams {
    /// Watts in a unit of the sums, divided by the photons emitted.
    watts_per_unit: f32,
    /// Texels in all maps.
    texel_count: u32,
    /// Workgroups along x.
    groups_x: u32,
    /// Light groups whose maps there are.
    light_groups: u32,
    /// Texels from a light group's maps to the next one's.
    group_texels: u32,
    /// Unused.
    padding_0: u32,
    /// Unused.
    padding_1: u32,
    /// Unused.
    padding_2: u32,
}

@group(0) @binding(0) var<uniform> resolve_params: ResolveParams;
/// Signed 64-bit sums of flux, for each light group, texel and channel: low words.
@group(0) @binding(1) var<storage, read> energy_low_words: array<u32>;
/// Their high words.
@group(0) @binding(2) var<storage, read> energy_high_words: array<u32>;
/// Area of each texel, m².
@group(0) @binding(3) var<storage, read> texel_areas: array<f32>;
/// Irradiance of each texel, W/m², in the order of the maps' tiles, row by row; the last component is unused. With several light groups, of each
/// texel first all light's, then each group's.
@group(0) @binding(4) var resolved_irradiance: texture_storage_2d<rgba32float, write>;
