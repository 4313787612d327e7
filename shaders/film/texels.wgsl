// Places in an object's energy map; docs/photon-paths.md, "Deposit".

import package::layout::records::{load_corners, load_object};
import package::geometry::traverse::Hit;

/// The four texels around a point of a surface and their bilinear weights.
struct Footprint {
    /// Indices of texels (i, j), (i+1, j), (i, j+1), (i+1, j+1).
    texels: vec4<u32>,
    /// Weights that sum to 1.
    weights: vec4<f32>,
}

fn footprint(hit: Hit, object_index: u32, front: bool) -> Footprint {
    let c = load_corners(hit.triangle);
    let object = load_object(object_index);
    let b = hit.barycentric;
    let at = (1.0 - b.x - b.y) * c.texel_01.xy + b.x * c.texel_01.zw + b.y * vec2<f32>(c.texel_x_2, c.texel_y_2);
    let last = vec2<f32>(f32(object.map_width - 2u), f32(object.map_height - 2u));
    let cell = clamp(floor(at), vec2<f32>(0.0), last);
    let f = clamp(at - cell, vec2<f32>(0.0), vec2<f32>(1.0));
    let layer = select(object.map_layers - 1u, 0u, front);
    let row = (layer * object.map_height + u32(cell.y)) * object.map_width;
    let first = object.map_first_texel + row + u32(cell.x);
    return Footprint(
        vec4<u32>(first, first + 1u, first + object.map_width, first + object.map_width + 1u),
        vec4<f32>((1.0 - f.x) * (1.0 - f.y), f.x * (1.0 - f.y), (1.0 - f.x) * f.y, f.x * f.y),
    );
}
