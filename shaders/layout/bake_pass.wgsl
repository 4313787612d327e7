// Binding 1 of group 1, and group 3 of the bake pass; the others are in path_pass.wgsl.

/// Which texels of a lightmap a dispatch samples.
struct BakeParams {
    /// Index of the object.
    object: u32,
    /// Texels among the object's that hold surface before the dispatch's first.
    first_texel: u32,
    /// Texels that the dispatch samples.
    texel_count: u32,
    /// Workgroups along x.
    groups_x: u32,
    /// Texels over the area of their surface, 1/m², on average over the map.
    texel_density: f32,
}

/// A texel that holds surface.
struct BakeTexel {
    /// Its column.
    column: u32,
    /// Its row.
    row: u32,
    /// 0 on the front, 1 on the back.
    side: u32,
    /// Index of the list of media in front of it.
    media: u32,
}

@group(1) @binding(1) var<uniform> bake_params: BakeParams;
/// BakeTexel records.
@group(3) @binding(0) var bake_texels: texture_2d<u32>;
/// For each cell between four texels, row by row, and then once more: the place of its first triangle in `cell_triangles`, four a texel.
@group(3) @binding(1) var cell_starts: texture_2d<u32>;
/// Indices of the triangles that cross each cell, four a texel.
@group(3) @binding(2) var cell_triangles: texture_2d<u32>;
/// Lists of media.
@group(3) @binding(3) var bake_media: texture_2d<u32>;
