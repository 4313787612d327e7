// Bind group 1 of the passes from the fixed-point sums to irradiance: the texels of the maps, and how their tiles join.

/// A texel of the maps.
struct MapTexel {
    /// Area of its surface, m². In the profile `paper`, what its sum is divided by. 0 without surface.
    area: f32,
    /// What it lies between, if it gets its irradiance from welds: 1 more than the index of a MapWeldPart that holds how many of these
    /// follow; else 0.
    link: u32,
    /// The chart that its surface belongs to, from 1; 0 without surface, NONE where it belongs to several.
    chart: u32,
    /// Index of its MapTileRecord.
    tile: u32,
}

/// A place at which texels of several tiles meet.
struct MapWeld {
    /// The texel of the coarsest tile there.
    owner: u32,
    /// Index of the first of the parts whose flux it takes.
    first_part: u32,
    /// Parts.
    part_count: u32,
    /// The area of these parts, m².
    area: f32,
}

/// A part of a weld or a texel.
struct MapWeldPart {
    /// Its index: of a texel, if it is of a weld; of a weld, if it is of a texel.
    index: u32,
    /// Its share.
    weight: f32,
}

/// A MapTexel for each texel.
@group(1) @binding(0) var map_texels: texture_2d<u32>;
@group(1) @binding(1) var<storage, read> welds: array<MapWeld>;
@group(1) @binding(2) var<storage, read> weld_parts: array<MapWeldPart>;
/// Irradiance at each weld, as at a texel.
@group(1) @binding(3) var<storage, read_write> welded: array<vec4<f32>>;
/// Irradiance of each texel, W/m², in the order of the maps' tiles, row by row; the last component is its variance, mean of the channels. With several
/// light groups, of each texel first all light's, then each group's.
@group(1) @binding(4) var texel_irradiance: texture_storage_2d<rgba32float, write>;
