// Tangents of normal maps; docs/materials.md, "Textures".

import package::layout::scene::{TANGENT_BITS, TANGENT_LEFT, TANGENT_PRESENT, TANGENT_SCALE};

/// A coordinate, of those that stand in a word.
fn coordinate(word: u32, place: u32) -> f32 {
    let steps = extractBits(word, TANGENT_BITS * place, TANGENT_BITS);
    return (f32(steps) - f32(TANGENT_SCALE)) / f32(TANGENT_SCALE);
}

/// The unit vector of octahedral coordinates (Meyer et al. 2010).
fn from_octahedron(at: vec2<f32>) -> vec3<f32> {
    let z = 1.0 - abs(at.x) - abs(at.y);
    let fold = max(-z, 0.0);
    return normalize(vec3<f32>(at - select(vec2<f32>(-fold), vec2<f32>(fold), at >= vec2<f32>(0.0)), z));
}

/// The shading normal that a normal map's value `c` makes, on the front, at barycentric weights of a triangle's second and third corner; `n`
/// where the picture has no direction there.
fn mapped_normal(tangents: vec2<u32>, barycentric: vec2<f32>, strength: f32, c: vec3<f32>, n: vec3<f32>) -> vec3<f32> {
    let x = tangents.x;
    let y = tangents.y;
    let t_0 = (1.0 - barycentric.x - barycentric.y) * from_octahedron(vec2<f32>(coordinate(x, 0u), coordinate(x, 1u)))
        + barycentric.x * from_octahedron(vec2<f32>(coordinate(x, 2u), coordinate(y, 0u)))
        + barycentric.y * from_octahedron(vec2<f32>(coordinate(y, 1u), coordinate(y, 2u)));
    let across = t_0 - n * dot(n, t_0);
    let size = length(across);
    if (x & TANGENT_PRESENT) == 0u || size == 0.0 {
        return n;
    }
    let t = across / size;
    let right = cross(n, t);
    let b = select(right, -right, (x & TANGENT_LEFT) != 0u);
    let m = (2.0 * c - 1.0) * vec3<f32>(strength, strength, 1.0);
    return normalize(m.x * t + m.y * b + m.z * n);
}
