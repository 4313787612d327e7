// Spherical emitters.

import package::layout::records::load_sphere;
import package::sampling::warp::{cone, cone_height, PI};

/// A direction toward a sphere.
struct TowardLight {
    /// Unit direction.
    direction: vec3<f32>,
    /// Distance to the sphere's surface, metres.
    distance: f32,
    /// Solid angle of the sphere, sr: 1 / pdf_solid_angle. 0 from inside.
    solid_angle: f32,
}

/// A direction from `point` evenly within the cone that the sphere fills.
fn sample_sphere_cone(center: vec3<f32>, radius: f32, point: vec3<f32>, u: vec2<f32>) -> TowardLight {
    let to_center = center - point;
    let distance = length(to_center);
    if distance <= radius {
        return TowardLight(vec3<f32>(0.0, 1.0, 0.0), 0.0, 0.0);
    }
    let height = cone_height(radius / distance);
    let toward = cone(to_center / distance, height, u);
    let offset = distance * toward.sin_theta;
    let half_chord = sqrt(max(radius * radius - offset * offset, 0.0));
    return TowardLight(toward.direction, distance * toward.cos_theta - half_chord, 2.0 * PI * height);
}

/// A sphere met by a ray.
struct SphereHit {
    /// Index of the light.
    light: u32,
    /// Distance along the ray, metres.
    t: f32,
}

/// The nearest of the first lights, which are spheres, whose outside the ray meets before `t_max`; `t` is `t_max` if there is none.
fn nearest_sphere(sphere_count: u32, origin: vec3<f32>, direction: vec3<f32>, t_max: f32) -> SphereHit {
    var hit = SphereHit(0u, t_max);
    for (var i = 0u; i < sphere_count; i++) {
        let sphere = load_sphere(i);
        let from_center = origin - sphere.xyz;
        let along = dot(from_center, direction);
        // The vector from the centre to the ray's nearest point keeps its digits where |from_center|² − R² loses them.
        let nearest = from_center - along * direction;
        let quarter_chord2 = sphere.w * sphere.w - dot(nearest, nearest);
        if along < 0.0 && quarter_chord2 > 0.0 {
            let t = -along - sqrt(quarter_chord2);
            if t > 0.0 && t < hit.t {
                hit = SphereHit(i, t);
            }
        }
    }
    return hit;
}
