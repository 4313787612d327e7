// Ray differentials (Igehy 1999) of the part of the emission that a photon stands for.

import package::geometry::surface::SurfacePoint;
import package::geometry::traverse::Hit;
import package::layout::records::load_corners;
import package::layout::scene::{Triangle, TriangleCorners, TRIANGLE_SMOOTH};

/// How a ray changes along two directions of the emission.
struct Differential {
    origin_1: vec3<f32>,
    origin_2: vec3<f32>,
    direction_1: vec3<f32>,
    direction_2: vec3<f32>,
}

/// How a ray's point on the plane of a hit changes.
fn transfer(origin: vec3<f32>, direction: vec3<f32>, d: vec3<f32>, t: f32, n_g: vec3<f32>) -> vec3<f32> {
    let across = origin + t * direction;
    return across - d * (dot(across, n_g) / dot(d, n_g));
}

/// How the barycentric coordinates of a point of a triangle change when it moves.
fn barycentric_change(triangle: Triangle, dp: vec3<f32>) -> vec2<f32> {
    let a = dot(triangle.edge_1, triangle.edge_1);
    let b = dot(triangle.edge_1, triangle.edge_2);
    let c = dot(triangle.edge_2, triangle.edge_2);
    let p = dot(dp, triangle.edge_1);
    let q = dot(dp, triangle.edge_2);
    return vec2<f32>(c * p - b * q, a * q - b * p) / max(a * c - b * b, 1e-30);
}

/// How a point of a triangle moves on the plane of its object's map.
fn plane_change(triangle: Triangle, corners: TriangleCorners, dp: vec3<f32>) -> vec2<f32> {
    let change = barycentric_change(triangle, dp);
    let along_1 = corners.texel_01.zw - corners.texel_01.xy;
    let along_2 = vec2<f32>(corners.texel_x_2, corners.texel_y_2) - corners.texel_01.xy;
    return change.x * along_1 + change.y * along_2;
}

/// How the shading normal changes when the point moves along a triangle.
fn normal_change(hit: Hit, triangle: Triangle, point: SurfacePoint, n: vec3<f32>, dp: vec3<f32>) -> vec3<f32> {
    if (triangle.flags & TRIANGLE_SMOOTH) == 0u || all(n == point.n_g) {
        return vec3<f32>(0.0);
    }
    let b = hit.barycentric;
    let c = load_corners(hit.triangle);
    let sum = (1.0 - b.x - b.y) * c.normal_0 + b.x * c.normal_1 + b.y * c.normal_2;
    let change = barycentric_change(triangle, dp);
    let moved = change.x * (c.normal_1 - c.normal_0) + change.y * (c.normal_2 - c.normal_0);
    let relative = select(-moved, moved, point.front) / length(sum);
    return relative - n * dot(n, relative);
}

/// How the direction after an event at normal n changes with the one before and the normal: reflected, or refracted with the ratio `eta` of
/// the indices before and after.
fn turn_change(d: vec3<f32>, dd: vec3<f32>, n: vec3<f32>, dn: vec3<f32>, after: vec3<f32>, eta: f32, transmitted: bool) -> vec3<f32> {
    let cosine = dot(d, n);
    let change = dot(dd, n) + dot(d, dn);
    if !transmitted {
        return dd - 2.0 * (cosine * dn + change * n);
    }
    let cos_after = dot(after, n);
    // after = eta d + mu n
    let mu = cos_after - eta * cosine;
    let dmu = (eta * eta * cosine / cos_after - eta) * change;
    return eta * dd + mu * dn + dmu * n;
}
