// Records of the geometry textures.

import package::layout::scene::{corners, nodes, triangles, BvhNode, Triangle, TriangleCorners, GEOMETRY_WIDTH_BITS};

/// The place of a texel, counted row by row.
fn geometry_texel(index: u32) -> vec2<u32> {
    return vec2<u32>(index & ((1u << GEOMETRY_WIDTH_BITS) - 1u), index >> GEOMETRY_WIDTH_BITS);
}

fn load_node(index: u32) -> BvhNode {
    let first = 5u * index;
    return BvhNode(
        textureLoad(nodes, geometry_texel(first), 0),
        textureLoad(nodes, geometry_texel(first + 1u), 0),
        textureLoad(nodes, geometry_texel(first + 2u), 0),
        textureLoad(nodes, geometry_texel(first + 3u), 0),
        textureLoad(nodes, geometry_texel(first + 4u), 0),
    );
}

fn load_triangle(index: u32) -> Triangle {
    let first = 3u * index;
    let texel_0 = textureLoad(triangles, geometry_texel(first), 0);
    let texel_1 = textureLoad(triangles, geometry_texel(first + 1u), 0);
    let texel_2 = textureLoad(triangles, geometry_texel(first + 2u), 0);
    return Triangle(
        bitcast<vec3<f32>>(texel_0.xyz), texel_0.w,
        bitcast<vec3<f32>>(texel_1.xyz), texel_1.w,
        bitcast<vec3<f32>>(texel_2.xyz), texel_2.w,
    );
}

fn load_corners(index: u32) -> TriangleCorners {
    let first = 4u * index;
    let texel_0 = bitcast<vec4<f32>>(textureLoad(corners, geometry_texel(first), 0));
    let texel_1 = bitcast<vec4<f32>>(textureLoad(corners, geometry_texel(first + 1u), 0));
    let texel_2 = bitcast<vec4<f32>>(textureLoad(corners, geometry_texel(first + 2u), 0));
    let texel_3 = bitcast<vec4<f32>>(textureLoad(corners, geometry_texel(first + 3u), 0));
    return TriangleCorners(texel_0.xyz, texel_0.w, texel_1.xyz, texel_1.w, texel_2.xyz, 0u, texel_3);
}
