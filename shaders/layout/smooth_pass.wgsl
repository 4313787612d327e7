// Bind group 2 of the pass that smooths irradiance.

/// A tile of the maps.
struct MapTileRecord {
    /// Index of its first texel, row by row.
    first_texel: u32,
    /// Cells along x.
    columns: u32,
    /// Cells along y.
    rows: u32,
    /// Index of its MapLayer.
    layer: u32,
    /// Where its first texel stands on the map's plane.
    origin_x: f32,
    /// The same along y.
    origin_y: f32,
    /// Width of a cell on the plane.
    cell_x: f32,
    /// Its height.
    cell_y: f32,
}

/// One dispatch of the smooth pass.
struct SmoothParams {
    /// Texels, or welds, that the dispatch smooths.
    count: u32,
    /// Workgroups along x.
    groups_x: u32,
    /// 1 for a dispatch over welds, which comes first.
    of_welds: u32,
    /// Cells from a texel to those that it is compared with.
    distance: i32,
    /// Factor on the variance that the smoothed texels have if their errors do not depend on each other.
    variance_factor: f32,
    /// 1 for a dispatch that makes guides: what texels are compared by.
    makes_guide: u32,
    /// Entries of the texture before those of the guides; 0 if texels are compared by themselves.
    first_guide: u32,
    /// Unused.
    padding: u32,
}

@group(2) @binding(0) var<uniform> smooth_params: SmoothParams;
@group(2) @binding(1) var<storage, read> map_tiles: array<MapTileRecord>;
/// Irradiance of each texel before it is smoothed, and its variance. Guides follow, but for the dispatch that makes them.
@group(2) @binding(2) var rough_irradiance: texture_2d<f32>;
