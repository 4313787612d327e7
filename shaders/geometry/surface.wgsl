// The surface at a hit.

import package::layout::records::load_corners;
import package::geometry::traverse::Hit;
import package::layout::scene::{Triangle, TRIANGLE_SMOOTH};

/// A point on a surface, seen along a ray.
struct SurfacePoint {
    /// Position, metres, world frame.
    position: vec3<f32>,
    /// Unit geometric normal, turned to the side that the ray comes from.
    n_g: vec3<f32>,
    /// Unit shading normal, on the same side.
    n_s: vec3<f32>,
    /// Unit normal as interpolated or mapped, turned with n_g, even where it faces away from the ray.
    n_smooth: vec3<f32>,
    /// Whether the ray came from the front.
    front: bool,
    /// How far a ray's origin is moved off the surface, metres.
    offset: f32,
}

/// Relative rounding error of a position that a barycentric interpolation gives, with room to spare.
const OFFSET_PER_METRE: f32 = 1.9073486e-6;

fn largest(v: vec3<f32>) -> f32 {
    return max(abs(v.x), max(abs(v.y), abs(v.z)));
}

/// How far a ray's origin is moved off a triangle, metres.
fn offset_length(triangle: Triangle) -> f32 {
    return OFFSET_PER_METRE * max(largest(triangle.corner), max(largest(triangle.edge_1), largest(triangle.edge_2)));
}

/// A point of a triangle, moved off it along unit vector `n`.
fn off_surface(triangle: Triangle, position: vec3<f32>, n: vec3<f32>) -> vec3<f32> {
    return position + offset_length(triangle) * n;
}

/// The normal interpolated between a triangle's corners, turned like the geometric one; that where the corners have none.
fn interpolated_normal(hit: Hit, triangle: Triangle, point: SurfacePoint) -> vec3<f32> {
    if (triangle.flags & TRIANGLE_SMOOTH) == 0u {
        return point.n_g;
    }
    let b = hit.barycentric;
    let c = load_corners(hit.triangle);
    let n = normalize((1.0 - b.x - b.y) * c.normal_0 + b.x * c.normal_1 + b.y * c.normal_2);
    return select(-n, n, point.front);
}

/// The surface at a hit, seen along `direction`, before pictures change its normal.
fn surface_point(hit: Hit, triangle: Triangle, direction: vec3<f32>) -> SurfacePoint {
    let b = hit.barycentric;
    let position = triangle.corner + b.x * triangle.edge_1 + b.y * triangle.edge_2;
    let outward = normalize(cross(triangle.edge_1, triangle.edge_2));
    let front = dot(direction, outward) < 0.0;
    let n_g = select(-outward, outward, front);
    var point = SurfacePoint(position, n_g, n_g, n_g, front, offset_length(triangle));
    point.n_smooth = interpolated_normal(hit, triangle, point);
    if dot(direction, point.n_smooth) < 0.0 {
        point.n_s = point.n_smooth;
    }
    return point;
}

/// The origin of a ray that leaves the surface along `direction`, off the surface on that side.
fn leave(point: SurfacePoint, direction: vec3<f32>) -> vec3<f32> {
    let side = select(-point.offset, point.offset, dot(direction, point.n_g) > 0.0);
    return point.position + side * point.n_g;
}
