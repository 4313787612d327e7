// Binding 1 of group 1 and bind group 3 of the bake pass; the others are in path_pass.wgsl.

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
    /// Texels of the lightmap along x.
    width: u32,
    /// Texels of the lightmap along y.
    height: u32,
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
    /// Unused.
    padding: u32,
    /// The media in front of it, as keys.
    media: vec4<u32>,
}

@group(1) @binding(1) var<uniform> bake_params: BakeParams;
/// The texels that the dispatch samples.
@group(3) @binding(0) var<storage, read> bake_texels: array<BakeTexel>;
/// For each cell between four texels, row by row, and then once more: where the triangles that cross it begin; from there on, these
/// triangles' indices.
@group(3) @binding(1) var<storage, read> cells: array<u32>;
