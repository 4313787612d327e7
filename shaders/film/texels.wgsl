// Places in an object's energy map; docs/photon-paths.md, "Deposit".

import package::layout::records::{load_corners, load_map_layer, load_map_square, load_map_tile};
import package::layout::scene::{MAP_TILE_LEVEL_BIAS, MAP_TILE_LEVEL_SHIFT, MAP_TILE_ROWS_SHIFT};
import package::geometry::traverse::Hit;

/// The four texels around a point of a surface and their bilinear weights.
struct Footprint {
    /// Indices of texels (i, j), (i+1, j), (i, j+1), (i+1, j+1).
    texels: vec4<u32>,
    /// Weights that sum to 1.
    weights: vec4<f32>,
}

/// A place on a tile of a map.
struct TilePlace {
    /// Index of the tile's first texel, row by row.
    first_texel: u32,
    /// Cells along x and y.
    cells: vec2<u32>,
    /// The place in cells from the first texel, within the tile.
    at: vec2<f32>,
    /// Cells for each unit of the map's plane.
    scale: vec2<f32>,
}

/// Where a point of a surface lies on the plane of its object's map.
fn map_place(hit: Hit) -> vec2<f32> {
    let c = load_corners(hit.triangle);
    let b = hit.barycentric;
    return (1.0 - b.x - b.y) * c.texel_01.xy + b.x * c.texel_01.zw + b.y * vec2<f32>(c.texel_x_2, c.texel_y_2);
}

/// The layer of an object's map that takes what comes from a side.
fn map_layer(object: u32, front: bool) -> u32 {
    return 2u * object + select(1u, 0u, front);
}

/// The tile under a place of a layer's plane.
fn tile_at(layer_index: u32, place: vec2<f32>) -> TilePlace {
    let layer = load_map_layer(layer_index);
    let columns = layer.squares & 0xffffu;
    let last = vec2<f32>(f32(columns) - 1.0, f32(layer.squares >> 16u) - 1.0);
    let squares = vec2<f32>(layer.scale_x, layer.scale_y);
    let at = place * squares;
    let corner = clamp(floor(at), vec2<f32>(0.0), last);
    let square = load_map_square(layer.first_square + u32(corner.y) * columns + u32(corner.x));
    let side = f32(square.side);
    let part = clamp(floor((at - corner) * side), vec2<f32>(0.0), vec2<f32>(side - 1.0));
    let tile = load_map_tile(square.first_part + u32(part.y) * square.side + u32(part.x));
    let columns_mask = (1u << MAP_TILE_ROWS_SHIFT) - 1u;
    let cells = vec2<u32>(tile.cells & columns_mask, (tile.cells >> MAP_TILE_ROWS_SHIFT) & columns_mask);
    // 2 to the power of its level, made of its bits to be exact: 127 is the bias of an f32's exponent.
    let tiles = bitcast<f32>(((tile.cells >> MAP_TILE_LEVEL_SHIFT) + 127u - MAP_TILE_LEVEL_BIAS) << 23u);
    let scale = tiles * vec2<f32>(cells);
    let within = clamp((at - vec2<f32>(tile.origin_x, tile.origin_y)) * scale, vec2<f32>(0.0), vec2<f32>(cells));
    return TilePlace(tile.first_texel, cells, within, squares * scale);
}

/// The texels around a place on a tile.
fn texels_around(place: TilePlace) -> Footprint {
    let cell = min(floor(place.at), vec2<f32>(place.cells) - 1.0);
    let f = place.at - cell;
    let columns = place.cells.x + 1u;
    let first = place.first_texel + u32(cell.y) * columns + u32(cell.x);
    return Footprint(
        vec4<u32>(first, first + 1u, first + columns, first + columns + 1u),
        vec4<f32>((1.0 - f.x) * (1.0 - f.y), f.x * (1.0 - f.y), (1.0 - f.x) * f.y, f.x * f.y),
    );
}
