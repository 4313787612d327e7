// Spherical emitters.

import package::layout::records::load_light;
import package::sampling::warp::{frame, PI};

/// A direction toward a sphere.
struct TowardLight {
    /// Unit direction.
    direction: vec3<f32>,
    /// Distance to the sphere's surface, metres.
    distance: f32,
    /// Solid angle of the sphere, sr: 1 / pdf_solid_angle. 0 from inside.
    solid_angle: f32,
}

/// 1 − cos α of the cone that a sphere of radius R fills at distance D, without cancellation.
fn cone_height(radius: f32, distance: f32) -> f32 {
    let sin_alpha = radius / distance;
    let sin2 = sin_alpha * sin_alpha;
    return sin2 / (1.0 + sqrt(max(1.0 - sin2, 0.0)));
}

/// A direction from `point` evenly within the cone that the sphere fills.
fn sample_sphere_cone(center: vec3<f32>, radius: f32, point: vec3<f32>, u: vec2<f32>) -> TowardLight {
    let to_center = center - point;
    let distance = length(to_center);
    if distance <= radius {
        return TowardLight(vec3<f32>(0.0, 1.0, 0.0), 0.0, 0.0);
    }
    let axis = to_center / distance;
    let height = cone_height(radius, distance);
    let z = u.x * height;
    let cos_theta = 1.0 - z;
    let sin_theta = sqrt(z * (2.0 - z));
    let phi = 2.0 * PI * u.y;
    let basis = frame(axis);
    let direction = sin_theta * (cos(phi) * basis.tangent + sin(phi) * basis.bitangent) + cos_theta * axis;
    let offset = distance * sin_theta;
    let half_chord = sqrt(max(radius * radius - offset * offset, 0.0));
    return TowardLight(direction, distance * cos_theta - half_chord, 2.0 * PI * height);
}

/// A light met by a ray.
struct LightHit {
    /// Index of the light.
    light: u32,
    /// Distance along the ray, metres.
    t: f32,
}

/// The nearest light whose outside the ray meets before `t_max`; `t` is `t_max` if there is none.
fn nearest_light(light_count: u32, origin: vec3<f32>, direction: vec3<f32>, t_max: f32) -> LightHit {
    var hit = LightHit(0u, t_max);
    for (var i = 0u; i < light_count; i++) {
        let light = load_light(i);
        let from_center = origin - light.center;
        let along = dot(from_center, direction);
        // The vector from the centre to the ray's nearest point keeps its digits where |from_center|² − R² loses them.
        let nearest = from_center - along * direction;
        let quarter_chord2 = light.radius * light.radius - dot(nearest, nearest);
        if along < 0.0 && quarter_chord2 > 0.0 {
            let t = -along - sqrt(quarter_chord2);
            if t > 0.0 && t < hit.t {
                hit = LightHit(i, t);
            }
        }
    }
    return hit;
}
