// Bind group 2 of the pass that turns the fixed-point sums into irradiance.

/// One dispatch of the resolve pass.
struct ResolveParams {
    /// Watts in a unit of the sums, divided by the photons emitted.
    watts_per_unit: f32,
    /// Texels, or welds, that the dispatch resolves.
    count: u32,
    /// Workgroups along x.
    groups_x: u32,
    /// Light groups whose maps there are.
    light_groups: u32,
    /// Texels from a light group's maps to the next one's.
    group_texels: u32,
    /// Sums of a texel: of three channels, and a fourth of squares where they are kept.
    sums: u32,
    /// 1 for a dispatch over welds, which comes first.
    of_welds: u32,
    /// Unused.
    padding: u32,
}

@group(2) @binding(0) var<uniform> resolve_params: ResolveParams;
/// Signed 64-bit sums of flux, for each light group, texel and channel: low words.
@group(2) @binding(1) var<storage, read> energy_low_words: array<u32>;
/// Their high words.
@group(2) @binding(2) var<storage, read> energy_high_words: array<u32>;
