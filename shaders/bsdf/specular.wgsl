// Casters: mirrors and smooth dielectrics; docs/photon-paths.md, "Flight" 6 to 9.

import package::bsdf::fresnel::refraction;
import package::layout::scene::MATERIAL_MIRROR;

/// A ray that leaves a caster.
struct SpecularEvent {
    /// Unit direction of flight.
    direction: vec3<f32>,
    /// Whether the ray crossed the surface.
    transmitted: bool,
    /// The normal about which it turned, on the side it came from.
    normal: vec3<f32>,
}

/// Turns direction `d` at one normal. `eta` is the index of the incident side over that of the other.
fn turn(kind: u32, d: vec3<f32>, n: vec3<f32>, eta: f32, u: f32) -> SpecularEvent {
    let cos_i = -dot(d, n);
    let interface_ = refraction(cos_i, eta);
    if kind == MATERIAL_MIRROR || u < interface_.reflectance {
        return SpecularEvent(normalize(d + 2.0 * cos_i * n), false, n);
    }
    return SpecularEvent(normalize(eta * d + (eta * cos_i - interface_.cos_t) * n), true, n);
}

/// Turns direction `d` at the shading normal, or at the geometric one where the first would send it to the wrong side.
fn scatter_specular(kind: u32, d: vec3<f32>, n_g: vec3<f32>, n_s: vec3<f32>, eta: f32, u: f32) -> SpecularEvent {
    var event: SpecularEvent;
    var n = n_s;
    // A loop rather than two calls: the second turn is rare, and calls are inlined.
    for (var attempt = 0u; attempt < 2u; attempt++) {
        event = turn(kind, d, n, eta, u);
        let side = dot(event.direction, n_g);
        if select(side > 0.0, side < 0.0, event.transmitted) {
            break;
        }
        n = n_g;
    }
    return event;
}

/// The factor by which interpolated normals change a photon's flux (Veach 1997, §5.3.2).
fn adjoint_factor(d: vec3<f32>, n_g: vec3<f32>, event: SpecularEvent) -> f32 {
    let wi_s = abs(dot(d, event.normal));
    let wo_g = abs(dot(event.direction, n_g));
    let wi_g = abs(dot(d, n_g));
    let wo_s = abs(dot(event.direction, event.normal));
    return (wi_s * wo_g) / (wi_g * wo_s);
}
