// How a photon leaves its light; docs/photon-paths.md, "Emission".

import package::emitter::sphere::{cone_height, sample_sphere_cone};
import package::layout::photon_pass::photon_params;
import package::layout::records::load_light;
import package::sampling::warp::{disc, frame, PI};

/// A photon at its birth.
struct Emission {
    /// Where it starts, metres, world frame.
    origin: vec3<f32>,
    /// Unit direction of flight.
    direction: vec3<f32>,
    /// Its flux before the light's share of all photons is divided out, W.
    flux: vec3<f32>,
}

/// pdf of one disc's rays in the measure of flux (cos θ dA dω), 1/(m² sr).
fn aim_pdf(k: u32, cos_axis: f32, cone: f32) -> f32 {
    let radius = photon_params.aim_discs[k].radius;
    return 1.0 / (f32(photon_params.aim_disc_count) * PI * radius * radius * cos_axis * 2.0 * PI * cone);
}

/// A ray toward the aim discs, weighted by the one-sample balance heuristic over all of them.
fn emit_aimed(u: vec4<f32>) -> Emission {
    let light = load_light(photon_params.light);
    let scaled = u.x * f32(photon_params.aim_disc_count);
    let chosen = min(u32(scaled), photon_params.aim_disc_count - 1u);
    let aim = photon_params.aim_discs[chosen];
    let basis = frame(aim.axis);
    let xy = disc(vec2<f32>(scaled - f32(chosen), u.y));
    let q = aim.center + aim.radius * (xy.x * basis.tangent + xy.y * basis.bitangent);
    let to_light = sample_sphere_cone(light.center, light.radius, q, u.zw);
    let d = -to_light.direction;
    let origin = q + to_light.distance * to_light.direction;

    var pdf = aim_pdf(chosen, dot(aim.axis, d), cone_height(light.radius, distance(light.center, q)));
    for (var k = 0u; k < photon_params.aim_disc_count; k++) {
        let other = photon_params.aim_discs[k];
        let cos_axis = dot(other.axis, d);
        let crossing = origin + d * (dot(other.axis, other.center - origin) / cos_axis);
        if k != chosen && cos_axis > 0.0 && distance(crossing, other.center) <= other.radius {
            pdf += aim_pdf(k, cos_axis, cone_height(light.radius, distance(light.center, crossing)));
        }
    }
    return Emission(origin, d, light.radiance / pdf);
}

/// A ray from anywhere on the light in any direction, cosine-weighted.
fn emit_unaimed(u: vec4<f32>) -> Emission {
    let light = load_light(photon_params.light);
    let z = 1.0 - 2.0 * u.z;
    let ring = sqrt(max(1.0 - z * z, 0.0));
    let phi = 2.0 * PI * u.w;
    let n = vec3<f32>(ring * cos(phi), ring * sin(phi), z);
    let basis = frame(n);
    let xy = disc(u.xy);
    let height = sqrt(max(1.0 - dot(xy, xy), 0.0));
    let d = normalize(xy.x * basis.tangent + xy.y * basis.bitangent + height * n);
    return Emission(light.center + light.radius * n, d, photon_params.flux);
}

/// The photon of emission numbers `u`.
fn emit(u: vec4<f32>) -> Emission {
    if photon_params.aim_disc_count == 0u {
        return emit_unaimed(u);
    }
    return emit_aimed(u);
}
