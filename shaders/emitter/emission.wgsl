// How a photon leaves its light; docs/photon-paths.md, "Emission".

import package::emitter::sky::{evaluate_environment, sample_environment};
import package::emitter::sphere::sample_sphere_cone;
import package::emitter::spot::spot_falloff;
import package::emitter::surface::sample_surface;
import package::geometry::surface::off_surface;
import package::layout::features::photon_light_kind;
import package::layout::photon_pass::{photon_params, AimTarget};
import package::layout::records::load_light;
import package::layout::scene::{Light, LIGHT_DISTANT, LIGHT_ENVIRONMENT, LIGHT_POINT, LIGHT_SPHERE, LIGHT_SPOT, LIGHT_SURFACE};
import package::sampling::warp::{cone, cone_height, disc, frame, PI};

/// A photon at its birth.
struct Emission {
    /// Where it starts, metres, world frame.
    origin: vec3<f32>,
    /// Unit direction of flight.
    direction: vec3<f32>,
    /// Its flux before the light's share of all photons is divided out, W.
    flux: vec3<f32>,
    /// Inverse density of the direction of a photon that leaves a fixed point of the light, sr; of its place across a fixed direction, m², for light
    /// from infinitely far.
    spread: f32,
}

/// The target that a number in [0, 1) chooses.
struct TargetChoice {
    /// Its index.
    index: u32,
    /// The number, stretched to [0, 1) again.
    rest: f32,
}

fn choose_target(u: f32) -> TargetChoice {
    let scaled = u * f32(photon_params.target_count);
    let index = min(u32(scaled), photon_params.target_count - 1u);
    return TargetChoice(index, scaled - f32(index));
}

/// pdf of one disc's rays in the measure of flux (cos θ dA dω), 1/(m² sr).
fn aim_pdf(k: u32, cos_axis: f32, cone: f32) -> f32 {
    let radius = photon_params.targets[k].radius;
    return 1.0 / (f32(photon_params.target_count) * PI * radius * radius * cos_axis * 2.0 * PI * cone);
}

/// A ray from a sphere toward the aim discs, weighted by the one-sample balance heuristic over all of them.
fn emit_aimed(light: Light, u: vec4<f32>) -> Emission {
    let choice = choose_target(u.x);
    let aim = photon_params.targets[choice.index];
    let basis = frame(aim.axis);
    let xy = disc(vec2<f32>(choice.rest, u.y));
    let q = aim.center + aim.radius * (xy.x * basis.tangent + xy.y * basis.bitangent);
    let to_light = sample_sphere_cone(light.position, light.extent, q, u.zw);
    let d = -to_light.direction;
    let origin = q + to_light.distance * to_light.direction;

    var pdf = aim_pdf(choice.index, dot(aim.axis, d), cone_height(light.extent / distance(light.position, q)));
    for (var k = 0u; k < photon_params.target_count; k++) {
        let other = photon_params.targets[k];
        let cos_axis = dot(other.axis, d);
        let crossing = origin + d * (dot(other.axis, other.center - origin) / cos_axis);
        if k != choice.index && cos_axis > 0.0 && distance(crossing, other.center) <= other.radius {
            pdf += aim_pdf(k, cos_axis, cone_height(light.extent / distance(light.position, crossing)));
        }
    }
    let reach = distance(origin, q);
    let spread = PI * aim.radius * aim.radius * f32(photon_params.target_count) * dot(aim.axis, d) / (reach * reach);
    return Emission(origin, d, light.strength / pdf, spread);
}

/// A ray from anywhere on a sphere in any direction, cosine-weighted.
fn emit_unaimed(light: Light, u: vec4<f32>) -> Emission {
    let z = 1.0 - 2.0 * u.z;
    let ring = sqrt(max(1.0 - z * z, 0.0));
    let phi = 2.0 * PI * u.w;
    let n = vec3<f32>(ring * cos(phi), ring * sin(phi), z);
    let basis = frame(n);
    let xy = disc(u.xy);
    let height = sqrt(max(1.0 - dot(xy, xy), 0.0));
    let d = normalize(xy.x * basis.tangent + xy.y * basis.bitangent + height * n);
    let area = 4.0 * PI * light.extent * light.extent;
    return Emission(light.position + light.extent * n, d, light.strength * (PI * area), PI);
}

/// 1 − cos of the cone that a target fills from a point; 2, every direction, from within it.
fn target_height(aim: AimTarget, point: vec3<f32>) -> f32 {
    let distance = distance(aim.center, point);
    return select(cone_height(min(aim.radius / distance, 1.0)), 2.0, distance <= aim.radius);
}

/// Unit direction from a point to a target's centre; any from the centre itself.
fn toward_target(aim: AimTarget, point: vec3<f32>) -> vec3<f32> {
    let between = aim.center - point;
    let distance = length(between);
    return select(vec3<f32>(0.0, 0.0, 1.0), between / max(distance, 1e-30), distance > 0.0);
}

/// A direction from a point toward the casters' bounding spheres.
struct TowardTargets {
    /// Unit direction.
    direction: vec3<f32>,
    /// Its density over all spheres, 1/sr.
    pdf: f32,
}

fn sample_targets(point: vec3<f32>, u: vec2<f32>) -> TowardTargets {
    let choice = choose_target(u.x);
    let aim = photon_params.targets[choice.index];
    let height = target_height(aim, point);
    let d = cone(toward_target(aim, point), height, vec2<f32>(choice.rest, u.y)).direction;
    var sum = 1.0 / height;
    for (var k = 0u; k < photon_params.target_count; k++) {
        let other = photon_params.targets[k];
        let other_height = target_height(other, point);
        // |d − axis|²/2 is 1 − cos of the angle between them, without cancellation.
        let chord = d - toward_target(other, point);
        if k != choice.index && 0.5 * dot(chord, chord) <= other_height {
            sum += 1.0 / other_height;
        }
    }
    return TowardTargets(d, sum / (2.0 * PI * f32(photon_params.target_count)));
}

/// A ray from a point, a spot or a surface.
fn emit_toward(light: Light, u: vec4<f32>) -> Emission {
    var origin = light.position;
    var normal = vec3<f32>(0.0);
    var strength = light.strength;
    if photon_light_kind == LIGHT_SURFACE {
        let place = sample_surface(light, u.zw);
        normal = place.normal;
        strength = place.radiance;
        origin = off_surface(place.triangle, place.position, normal);
    }
    let toward = sample_targets(origin, u.xy);
    var shape = max(dot(normal, toward.direction), 0.0) * light.extent;
    if photon_light_kind == LIGHT_POINT {
        shape = 1.0;
    }
    if photon_light_kind == LIGHT_SPOT {
        shape = spot_falloff(light, toward.direction);
    }
    return Emission(origin, toward.direction, strength * (shape / toward.pdf), 1.0 / toward.pdf);
}

/// A ray from infinitely far across the casters' bounding spheres.
fn emit_across(light: Light, u: vec4<f32>) -> Emission {
    var d = cone(-light.position, light.extent, u.zw).direction;
    // Irradiance on a surface that faces the light.
    var irradiance = light.strength * select(1.0, 2.0 * PI * light.extent, light.extent > 0.0);
    if photon_light_kind == LIGHT_ENVIRONMENT {
        let place = sample_environment(light, u.zw);
        d = -place.direction;
        irradiance = select(vec3<f32>(0.0), evaluate_environment(light, place.direction).radiance / place.pdf, place.pdf > 0.0);
    }
    let choice = choose_target(u.x);
    let aim = photon_params.targets[choice.index];
    let basis = frame(d);
    let xy = disc(vec2<f32>(choice.rest, u.y));
    let q = aim.center + aim.radius * (xy.x * basis.tangent + xy.y * basis.bitangent);
    var sum = 1.0 / (aim.radius * aim.radius);
    for (var k = 0u; k < photon_params.target_count; k++) {
        let other = photon_params.targets[k];
        let to_center = other.center - q;
        if k != choice.index && length(to_center - dot(to_center, d) * d) <= other.radius {
            sum += 1.0 / (other.radius * other.radius);
        }
    }
    // Back to a plane that touches the scene's bounding sphere.
    let back = dot(q - photon_params.scene_center, d) + photon_params.scene_radius;
    let spread = PI * f32(photon_params.target_count) / sum;
    return Emission(q - back * d, d, irradiance * spread, spread);
}

/// The photon of emission numbers `u`.
fn emit(u: vec4<f32>) -> Emission {
    let light = load_light(photon_params.light);
    if photon_light_kind == LIGHT_SPHERE {
        if photon_params.target_count == 0u {
            return emit_unaimed(light, u);
        }
        return emit_aimed(light, u);
    }
    if photon_light_kind == LIGHT_DISTANT || photon_light_kind == LIGHT_ENVIRONMENT {
        return emit_across(light, u);
    }
    return emit_toward(light, u);
}
