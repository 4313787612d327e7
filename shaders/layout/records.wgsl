// Records of the scene's textures.

import package::layout::scene::{
    corners, lights, materials, nodes, objects, triangles, BvhNode, Material, Object, SphereLight, Triangle, TriangleCorners,
    RECORDS_WIDTH_BITS,
};

/// The place of a texel, counted row by row.
fn record_texel(index: u32) -> vec2<u32> {
    return vec2<u32>(index & ((1u << RECORDS_WIDTH_BITS) - 1u), index >> RECORDS_WIDTH_BITS);
}

fn load_node(index: u32) -> BvhNode {
    let first = 5u * index;
    return BvhNode(
        textureLoad(nodes, record_texel(first), 0),
        textureLoad(nodes, record_texel(first + 1u), 0),
        textureLoad(nodes, record_texel(first + 2u), 0),
        textureLoad(nodes, record_texel(first + 3u), 0),
        textureLoad(nodes, record_texel(first + 4u), 0),
    );
}

fn load_triangle(index: u32) -> Triangle {
    let first = 3u * index;
    let texel_0 = textureLoad(triangles, record_texel(first), 0);
    let texel_1 = textureLoad(triangles, record_texel(first + 1u), 0);
    let texel_2 = textureLoad(triangles, record_texel(first + 2u), 0);
    return Triangle(
        bitcast<vec3<f32>>(texel_0.xyz), texel_0.w,
        bitcast<vec3<f32>>(texel_1.xyz), texel_1.w,
        bitcast<vec3<f32>>(texel_2.xyz), texel_2.w,
    );
}

fn load_corners(index: u32) -> TriangleCorners {
    let first = 4u * index;
    let texel_0 = bitcast<vec4<f32>>(textureLoad(corners, record_texel(first), 0));
    let texel_1 = bitcast<vec4<f32>>(textureLoad(corners, record_texel(first + 1u), 0));
    let texel_2 = bitcast<vec4<f32>>(textureLoad(corners, record_texel(first + 2u), 0));
    let texel_3 = bitcast<vec4<f32>>(textureLoad(corners, record_texel(first + 3u), 0));
    return TriangleCorners(texel_0.xyz, texel_0.w, texel_1.xyz, texel_1.w, texel_2.xyz, 0u, texel_3);
}

fn load_object(index: u32) -> Object {
    let texel = textureLoad(objects, record_texel(index), 0);
    return Object(texel.x, texel.y, texel.z, texel.w);
}

fn load_material(index: u32) -> Material {
    let first = 5u * index;
    let texel_0 = textureLoad(materials, record_texel(first), 0);
    let texel_1 = bitcast<vec4<f32>>(textureLoad(materials, record_texel(first + 1u), 0));
    let texel_2 = bitcast<vec4<f32>>(textureLoad(materials, record_texel(first + 2u), 0));
    let texel_3 = bitcast<vec4<f32>>(textureLoad(materials, record_texel(first + 3u), 0));
    let texel_4 = bitcast<vec4<f32>>(textureLoad(materials, record_texel(first + 4u), 0));
    return Material(
        bitcast<vec3<f32>>(texel_0.xyz), texel_0.w,
        texel_1.xyz, texel_1.w,
        texel_2.xyz, texel_2.w,
        texel_3.xyz, 0u,
        texel_4.xyz, 0u,
    );
}

/// The absorption coefficient alone of a material, 1/m.
fn load_absorption(index: u32) -> vec3<f32> {
    return bitcast<vec3<f32>>(textureLoad(materials, record_texel(5u * index + 2u), 0).xyz);
}

fn load_light(index: u32) -> SphereLight {
    let texel_0 = bitcast<vec4<f32>>(textureLoad(lights, record_texel(2u * index), 0));
    let texel_1 = bitcast<vec4<f32>>(textureLoad(lights, record_texel(2u * index + 1u), 0));
    return SphereLight(texel_0.xyz, texel_0.w, texel_1.xyz, texel_1.w);
}
