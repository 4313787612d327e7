// Light from infinitely far: discs in the sky and the environment.

import package::layout::features::{has_distant_lights, has_environment};
import package::layout::records::{load_cumulative_probability, load_environment, load_light};
import package::layout::scene::{Light, LIGHT_ENVIRONMENT};
import package::sampling::warp::PI;

/// Probability of a light's choice in next-event estimation.
fn light_probability(index: u32) -> f32 {
    let before = select(0.0, load_cumulative_probability(max(index, 1u) - 1u), index > 0u);
    return load_cumulative_probability(index) - before;
}

/// A row or column drawn from cumulative probabilities.
struct Draw {
    /// Its index.
    index: u32,
    /// Its probability.
    probability: f32,
    /// The number that drew it, stretched to [0, 1) again.
    rest: f32,
}

/// Draws one of `count` entries of the environment's record from `first` on, whose component `component` holds cumulative probabilities.
fn draw_entry(first: u32, count: u32, component: u32, u: f32) -> Draw {
    var low = 0u;
    var high = count - 1u;
    while low < high {
        let middle = (low + high) >> 1u;
        let beyond = u >= load_environment(first + middle)[component];
        low = select(low, middle + 1u, beyond);
        high = select(middle, high, beyond);
    }
    let before = select(0.0, load_environment(first + max(low, 1u) - 1u)[component], low > 0u);
    let probability = load_environment(first + low)[component] - before;
    return Draw(low, probability, clamp((u - before) / max(probability, 1e-20), 0.0, 0.99999994));
}

/// A direction drawn from the environment.
struct EnvironmentSample {
    /// Unit direction toward the environment.
    direction: vec3<f32>,
    /// Its density, 1/sr.
    pdf: f32,
}

/// A direction toward the environment, in proportion to the radiance of its texels.
fn sample_environment(light: Light, u: vec2<f32>) -> EnvironmentSample {
    let row = draw_entry(0u, light.count, 0u, u.y);
    let column = draw_entry(light.count + row.index * light.first, light.first, 3u, u.x);
    let size = vec2<f32>(f32(light.first), f32(light.count));
    let theta = PI * (f32(row.index) + row.rest) / size.y;
    let phi = 2.0 * PI * ((f32(column.index) + column.rest) / size.x - 0.5);
    let sin_theta = sin(theta);
    // At the picture's turn: +x is at phi = π/2, −z at 0.
    let local = vec3<f32>(sin_theta * sin(phi), cos(theta), -sin_theta * cos(phi));
    let direction = vec3<f32>(
        light.axis.x * local.x + light.axis.y * local.z, local.y, light.axis.x * local.z - light.axis.y * local.x,
    );
    let density = row.probability * column.probability * size.x * size.y;
    return EnvironmentSample(direction, density / max(2.0 * PI * PI * sin_theta, 1e-12));
}

/// What the environment sends from a direction.
struct EnvironmentValue {
    /// Radiance, W/(m² sr).
    radiance: vec3<f32>,
    /// Density with which `sample_environment` draws the direction, 1/sr.
    pdf: f32,
}

fn environment_texel(light: Light, column: u32, row: u32) -> vec4<f32> {
    return load_environment(light.count + row * light.first + column);
}

/// The environment in a direction: bilinear radiance, and the density of the texel that the direction is in.
fn evaluate_environment(light: Light, direction: vec3<f32>) -> EnvironmentValue {
    let local = vec3<f32>(
        light.axis.x * direction.x - light.axis.y * direction.z, direction.y, light.axis.x * direction.z + light.axis.y * direction.x,
    );
    let size = vec2<f32>(f32(light.first), f32(light.count));
    let u = 0.5 + atan2(local.x, -local.z) / (2.0 * PI);
    let v = acos(clamp(local.y, -1.0, 1.0)) / PI;
    let column = min(u32(u * size.x), light.first - 1u);
    let row = min(u32(v * size.y), light.count - 1u);
    let in_row = environment_texel(light, column, row).w
        - select(0.0, environment_texel(light, max(column, 1u) - 1u, row).w, column > 0u);
    let of_row = load_environment(row).x - select(0.0, load_environment(max(row, 1u) - 1u).x, row > 0u);
    let sin_theta = length(local.xz);
    let pdf = in_row * of_row * size.x * size.y / max(2.0 * PI * PI * sin_theta, 1e-12);

    let x = u * size.x - 0.5;
    let y = clamp(v * size.y - 0.5, 0.0, size.y - 1.0);
    let left = (u32(floor(x) + size.x)) % light.first;
    let right = (left + 1u) % light.first;
    let top = u32(y);
    let bottom = min(top + 1u, light.count - 1u);
    let f = x - floor(x);
    let g = y - f32(top);
    let upper = mix(environment_texel(light, left, top), environment_texel(light, right, top), f);
    let lower = mix(environment_texel(light, left, bottom), environment_texel(light, right, bottom), f);
    return EnvironmentValue(light.strength * mix(upper, lower, g).xyz, pdf);
}

/// What reaches an eye from a light that is infinitely far, weighted as `sky_radiance` says; W/(m² sr).
fn sky_light_radiance(index: u32, direction: vec3<f32>, lobe_pdf: f32) -> vec3<f32> {
    let light = load_light(index);
    let probability = light_probability(index);
    // 1 − cos of the angle to the disc's middle, without cancellation.
    let chord = direction - light.position;
    let is_disc = light.kind != LIGHT_ENVIRONMENT && light.extent > 0.0 && 0.5 * dot(chord, chord) <= light.extent;
    var value = EnvironmentValue(select(vec3<f32>(0.0), light.strength, is_disc), 1.0 / (2.0 * PI * max(light.extent, 1e-30)));
    if has_environment && light.kind == LIGHT_ENVIRONMENT {
        value = evaluate_environment(light, direction);
    }
    let weight = select(1.0, lobe_pdf / (lobe_pdf + probability * value.pdf), lobe_pdf > 0.0);
    return weight * value.radiance;
}

/// What reaches an eye from beyond every object, but for the constant background; W/(m² sr). `lobe_pdf` is the density with which the
/// direction was drawn where next-event estimation could have drawn it too (balance heuristic), else 0.
fn sky_radiance(first_light: u32, light_count: u32, direction: vec3<f32>, lobe_pdf: f32) -> vec3<f32> {
    var radiance = vec3<f32>(0.0);
    if !has_distant_lights {
        return radiance;
    }
    for (var i = first_light; i < light_count; i++) {
        radiance += sky_light_radiance(i, direction, lobe_pdf);
    }
    return radiance;
}
