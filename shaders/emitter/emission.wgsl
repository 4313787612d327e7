// How a photon leaves its light; docs/photon-paths.md, "Emission".

import package::emitter::guide::{aim_density, GuidedNumbers};
import package::emitter::sky::{evaluate_environment, sample_environment};
import package::emitter::sphere::sample_sphere_cone;
import package::emitter::spot::spot_falloff;
import package::emitter::surface::sample_surface;
import package::geometry::surface::off_surface;
import package::layout::features::{has_guide, photon_light_kind};
import package::layout::photon_pass::{photon_params, AimTarget};
import package::layout::records::load_light;
import package::layout::scene::{Light, LIGHT_DISTANT, LIGHT_ENVIRONMENT, LIGHT_POINT, LIGHT_SPHERE, LIGHT_SPOT, LIGHT_SURFACE};
import package::sampling::warp::{cone, cone_height, cone_inverse, disc, disc_inverse, frame, PI};

/// A photon at its birth.
struct Emission {
    /// Where it starts, metres, world frame.
    origin: vec3<f32>,
    /// Unit direction of flight.
    direction: vec3<f32>,
    /// Its flux without a guide, and before the light's share of all photons is divided out, W.
    flux: vec3<f32>,
    /// Density of the ray under the guide of where the light aims, over that without one.
    density: f32,
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

/// Densities of a ray, summed over the targets that could have sent it.
struct RayDensity {
    /// Without a guide.
    plain: f32,
    /// With it.
    guided: f32,
}

/// Adds what target `k` contributes, `pdf` for one target alone, where its own numbers would be `u`.
fn add_target(sum: RayDensity, k: u32, pdf: f32, u: vec2<f32>) -> RayDensity {
    var density = 1.0;
    if has_guide {
        density = aim_density(vec2<f32>((f32(k) + u.x) / f32(photon_params.target_count), u.y));
    }
    return RayDensity(sum.plain + pdf, sum.guided + pdf * density);
}

/// Whether a target of a sphere is no disc, but every direction.
fn is_everywhere(aim: AimTarget) -> bool {
    return aim.radius <= 0.0;
}

/// pdf of one disc's rays in the measure of flux (cos θ dA dω), 1/(m² sr).
fn disc_pdf(aim: AimTarget, cos_axis: f32, cone: f32) -> f32 {
    return 1.0 / (PI * aim.radius * aim.radius * cos_axis * 2.0 * PI * cone);
}

/// The same of a ray from anywhere on a sphere in any direction.
fn everywhere_pdf(light: Light) -> f32 {
    return 1.0 / (4.0 * PI * PI * light.extent * light.extent);
}

/// Adds the density of a sphere's ray from `origin` along `d` by target `k`, if it could have sent it.
fn add_aim(sum: RayDensity, light: Light, k: u32, origin: vec3<f32>, d: vec3<f32>) -> RayDensity {
    let aim = photon_params.targets[k];
    if is_everywhere(aim) {
        return add_target(sum, k, everywhere_pdf(light), cone_inverse(UP, 2.0, d));
    }
    let cos_axis = dot(aim.axis, d);
    let crossing = origin + d * (dot(aim.axis, aim.center - origin) / cos_axis);
    let from_center = (crossing - aim.center) / aim.radius;
    if cos_axis <= 0.0 || dot(from_center, from_center) > 1.0 {
        return sum;
    }
    let basis = frame(aim.axis);
    let u = disc_inverse(vec2<f32>(dot(from_center, basis.tangent), dot(from_center, basis.bitangent)));
    return add_target(sum, k, disc_pdf(aim, cos_axis, cone_height(light.extent / distance(light.position, crossing))), u);
}

/// The axis of a sphere's directions where it sends photons everywhere.
const UP: vec3<f32> = vec3<f32>(0.0, 0.0, 1.0);

/// A ray from a sphere toward its targets, weighted by the one-sample balance heuristic over all of them.
fn emit_aimed(light: Light, u: vec4<f32>, density: f32) -> Emission {
    let choice = choose_target(u.x);
    let aim = photon_params.targets[choice.index];
    let own = vec2<f32>(choice.rest, u.y);
    var origin: vec3<f32>;
    var d: vec3<f32>;
    var pdf: f32;
    var spread: f32;
    if is_everywhere(aim) {
        d = cone(UP, 2.0, own).direction;
        let basis = frame(d);
        let xy = disc(u.zw);
        let height = sqrt(max(1.0 - dot(xy, xy), 0.0));
        origin = light.position + light.extent * (xy.x * basis.tangent + xy.y * basis.bitangent + height * d);
        pdf = everywhere_pdf(light);
        spread = 4.0 * PI;
    } else {
        let basis = frame(aim.axis);
        let xy = disc(own);
        let q = aim.center + aim.radius * (xy.x * basis.tangent + xy.y * basis.bitangent);
        let to_light = sample_sphere_cone(light.position, light.extent, q, u.zw);
        d = -to_light.direction;
        origin = q + to_light.distance * to_light.direction;
        pdf = disc_pdf(aim, dot(aim.axis, d), cone_height(light.extent / distance(light.position, q)));
        let reach = distance(origin, q);
        spread = PI * aim.radius * aim.radius * dot(aim.axis, d) / (reach * reach);
    }
    var sum = RayDensity(pdf, pdf * density);
    for (var k = 0u; k < photon_params.target_count; k++) {
        if k != choice.index {
            sum = add_aim(sum, light, k, origin, d);
        }
    }
    let count = f32(photon_params.target_count);
    return Emission(origin, d, light.strength * (count / sum.plain), sum.guided / sum.plain, spread * (count * pdf / sum.plain));
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
    /// Its density over all spheres without a guide, 1/sr.
    pdf: f32,
    /// That with a guide over it.
    density: f32,
}

/// `density` is that of the guide where it has moved `u` to.
fn sample_targets(point: vec3<f32>, u: vec2<f32>, density: f32) -> TowardTargets {
    let choice = choose_target(u.x);
    let aim = photon_params.targets[choice.index];
    let height = target_height(aim, point);
    let d = cone(toward_target(aim, point), height, vec2<f32>(choice.rest, u.y)).direction;
    var sum = RayDensity(1.0 / height, density / height);
    for (var k = 0u; k < photon_params.target_count; k++) {
        let other = photon_params.targets[k];
        let other_height = target_height(other, point);
        let numbers = cone_inverse(toward_target(other, point), other_height, d);
        if k != choice.index && numbers.x <= 1.0 {
            sum = add_target(sum, k, 1.0 / other_height, numbers);
        }
    }
    return TowardTargets(d, sum.plain / (2.0 * PI * f32(photon_params.target_count)), sum.guided / sum.plain);
}

/// A ray from a point, a spot or a surface.
fn emit_toward(light: Light, u: vec4<f32>, density: f32) -> Emission {
    var origin = light.position;
    var normal = vec3<f32>(0.0);
    var strength = light.strength;
    if photon_light_kind == LIGHT_SURFACE {
        let place = sample_surface(light, u.zw);
        normal = place.normal;
        strength = place.radiance;
        origin = off_surface(place.triangle, place.position, normal);
    }
    let toward = sample_targets(origin, u.xy, density);
    var shape = max(dot(normal, toward.direction), 0.0) * light.extent;
    if photon_light_kind == LIGHT_POINT {
        shape = 1.0;
    }
    if photon_light_kind == LIGHT_SPOT {
        shape = spot_falloff(light, toward.direction);
    }
    return Emission(origin, toward.direction, strength * (shape / toward.pdf), toward.density, 1.0 / toward.pdf);
}

/// A ray from infinitely far across the casters' bounding spheres.
fn emit_across(light: Light, u: vec4<f32>, density: f32) -> Emission {
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
    let pdf = 1.0 / (aim.radius * aim.radius);
    var sum = RayDensity(pdf, pdf * density);
    for (var k = 0u; k < photon_params.target_count; k++) {
        let other = photon_params.targets[k];
        let from_center = (q - other.center) / other.radius;
        let across = vec2<f32>(dot(from_center, basis.tangent), dot(from_center, basis.bitangent));
        if k != choice.index && dot(across, across) <= 1.0 {
            sum = add_target(sum, k, 1.0 / (other.radius * other.radius), disc_inverse(across));
        }
    }
    // Back to a plane that touches the scene's bounding sphere.
    let back = dot(q - photon_params.scene_center, d) + photon_params.scene_radius;
    let spread = PI * f32(photon_params.target_count) / sum.plain;
    return Emission(q - back * d, d, irradiance * spread, sum.guided / sum.plain, spread);
}

/// The photon of guided emission numbers.
fn emit(guided: GuidedNumbers) -> Emission {
    let light = load_light(photon_params.light);
    if photon_light_kind == LIGHT_SPHERE {
        return emit_aimed(light, guided.numbers, guided.aim_density);
    }
    if photon_light_kind == LIGHT_DISTANT || photon_light_kind == LIGHT_ENVIRONMENT {
        return emit_across(light, guided.numbers, guided.aim_density);
    }
    return emit_toward(light, guided.numbers, guided.aim_density);
}
