// Next-event estimation: a light, and a point or direction of it.

import package::emitter::sky::{evaluate_environment, light_probability, sample_environment};
import package::emitter::sphere::sample_sphere_cone;
import package::emitter::spot::spot_falloff;
import package::emitter::surface::sample_surface;
import package::layout::features::{has_distant_lights, has_environment, has_point_lights, has_surface_lights};
import package::layout::records::{load_cumulative_probability, load_light};
import package::layout::scene::{
    Light, LIGHT_DISTANT, LIGHT_ENVIRONMENT, LIGHT_POINT, LIGHT_SPHERE, LIGHT_SPOT, LIGHT_SURFACE,
};
import package::sampling::warp::{cone, PI};

/// Stands for infinity.
const FAR: f32 = 3.0e38;

/// A light as a point may see it.
struct Illumination {
    /// Unit direction toward the light.
    direction: vec3<f32>,
    /// How far it is, metres.
    distance: f32,
    /// Radiance or irradiance over the density of the draw, W/m²: times BSDF and cosine, the radiance sent on.
    arriving: vec3<f32>,
    /// Density of the draw, the light's choice included, 1/sr; 0 for a single direction.
    pdf: f32,
}

/// The light whose share of the cumulative probabilities holds `u`.
fn choose_light(light_count: u32, u: f32) -> u32 {
    var low = 0u;
    var high = light_count - 1u;
    while low < high {
        let middle = (low + high) >> 1u;
        let beyond = u >= load_cumulative_probability(middle);
        low = select(low, middle + 1u, beyond);
        high = select(middle, high, beyond);
    }
    return low;
}

/// A draw from an area or a disc of directions.
fn drawn(direction: vec3<f32>, distance: f32, radiance: vec3<f32>, pdf: f32) -> Illumination {
    return Illumination(direction, distance, select(vec3<f32>(0.0), radiance / pdf, pdf > 0.0), pdf);
}

fn illuminate_from_surface(light: Light, probability: f32, point: vec3<f32>, u: vec2<f32>) -> Illumination {
    let place = sample_surface(light, u);
    let to_light = place.position - point;
    let distance = length(to_light);
    let direction = to_light / max(distance, 1e-30);
    let cos_light = -dot(direction, place.normal);
    let pdf = select(0.0, probability * distance * distance / (light.extent * cos_light), cos_light > 0.0);
    return drawn(direction, distance, place.radiance, pdf);
}

/// Draws a point or direction of a light by `u`, seen from `point`.
fn illuminate(index: u32, point: vec3<f32>, u: vec2<f32>) -> Illumination {
    let light = load_light(index);
    let probability = light_probability(index);
    if light.kind == LIGHT_SPHERE {
        let toward = sample_sphere_cone(light.position, light.extent, point, u);
        let pdf = select(0.0, probability / toward.solid_angle, toward.solid_angle > 0.0);
        return drawn(toward.direction, toward.distance, light.strength, pdf);
    }
    if has_point_lights && (light.kind == LIGHT_POINT || light.kind == LIGHT_SPOT) {
        let to_light = light.position - point;
        let distance = length(to_light);
        let direction = to_light / max(distance, 1e-30);
        let falloff = select(1.0, spot_falloff(light, -direction), light.kind == LIGHT_SPOT);
        return Illumination(direction, distance, light.strength * (falloff / (probability * distance * distance)), 0.0);
    }
    if has_distant_lights && light.kind == LIGHT_DISTANT {
        let toward = cone(light.position, light.extent, u);
        let solid_angle = 2.0 * PI * light.extent;
        let is_disc = light.extent > 0.0;
        return Illumination(
            toward.direction, FAR, light.strength * (select(1.0, solid_angle, is_disc) / probability),
            select(0.0, probability / solid_angle, is_disc),
        );
    }
    if has_surface_lights && light.kind == LIGHT_SURFACE {
        return illuminate_from_surface(light, probability, point, u);
    }
    if has_environment && light.kind == LIGHT_ENVIRONMENT {
        let place = sample_environment(light, u);
        let radiance = evaluate_environment(light, place.direction).radiance;
        return drawn(place.direction, FAR, radiance, probability * place.pdf);
    }
    return Illumination(vec3<f32>(0.0, 1.0, 0.0), 0.0, vec3<f32>(0.0), 0.0);
}
