// Spots.

import package::layout::scene::Light;

/// Share of a spot's full intensity in a direction of flight.
fn spot_falloff(light: Light, direction: vec3<f32>) -> f32 {
    let t = clamp((dot(direction, light.axis) - light.cos_outer) / (light.cos_inner - light.cos_outer), 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
}
