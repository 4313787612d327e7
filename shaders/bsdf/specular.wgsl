// The specular lobe of every material; docs/materials.md.

import package::bsdf::fresnel::{conductor_reflectance, refraction, schlick};
import package::bsdf::microfacet::{ggx_density, masking_weight, smith_lambda, visible_normal};
import package::layout::features::{has_conductors, has_gloss, paper_refraction, PAPER_EXACT, PAPER_PRINTED};
import package::layout::scene::{
    Material, MATERIAL_COATED, MATERIAL_CONDUCTOR, MATERIAL_DIELECTRIC, MATERIAL_KIND_BITS, MATERIAL_METALLIC_ROUGHNESS, MATERIAL_MIRROR,
    MATERIAL_THIN_WALLED,
};
import package::paper::refraction::refract_by_equation_3;

/// The indices on the two sides of an interface.
struct Interface {
    /// Index of the medium that the ray comes from.
    ior: f32,
    /// That index over the one on the other side.
    eta: f32,
}

/// The interface of a material other than a dielectric, which its media define, in a medium of index `ior`.
fn outer_interface(material: Material, ior: f32) -> Interface {
    return Interface(ior, ior / max(material.ior, 1e-6));
}

/// Whether the specular lobe transmits as well.
fn transmits(kind: u32) -> bool {
    return kind == MATERIAL_DIELECTRIC || kind == MATERIAL_THIN_WALLED;
}

/// Reflectance of the specular lobe at an angle of incidence, per channel.
fn specular_reflectance(material: Material, cos_i: f32, sides: Interface) -> vec3<f32> {
    let kind = material.kind & MATERIAL_KIND_BITS;
    if kind == MATERIAL_MIRROR {
        return material.specular;
    }
    if has_conductors && kind == MATERIAL_CONDUCTOR {
        return conductor_reflectance(cos_i, material.specular / sides.ior, material.extinction / sides.ior);
    }
    if has_gloss && kind == MATERIAL_METALLIC_ROUGHNESS {
        return schlick(cos_i, material.specular);
    }
    if kind != MATERIAL_DIELECTRIC && kind != MATERIAL_THIN_WALLED && kind != MATERIAL_COATED {
        return vec3<f32>(0.0);
    }
    var once = refraction(cos_i, sides.eta).reflectance;
    if paper_refraction == PAPER_EXACT {
        // The paper's glass refracts all light that it can.
        once = floor(once);
    }
    return vec3<f32>(select(once, 2.0 * once / (1.0 + once), kind == MATERIAL_THIN_WALLED));
}

/// A ray that leaves through a specular lobe.
struct SpecularEvent {
    /// Unit direction of flight.
    direction: vec3<f32>,
    /// Whether the ray crossed the surface.
    transmitted: bool,
    /// The shading normal about which it turned, on the side that it came from.
    normal: vec3<f32>,
    /// Factor on flux.
    weight: vec3<f32>,
}

/// Turns direction `d` at microfacet normal `m` of a surface of normal `n`.
fn turn(material: Material, d: vec3<f32>, n: vec3<f32>, m: vec3<f32>, sides: Interface, u: f32) -> SpecularEvent {
    let kind = material.kind & MATERIAL_KIND_BITS;
    let cos_i = -dot(d, m);
    if paper_refraction == PAPER_PRINTED && kind == MATERIAL_DIELECTRIC {
        return SpecularEvent(refract_by_equation_3(d, m, cos_i, sides.eta), true, n, material.tint);
    }
    let reflectance = specular_reflectance(material, cos_i, sides);
    let splits = transmits(kind);
    if !splits || u < reflectance.x {
        return SpecularEvent(normalize(d + 2.0 * cos_i * m), false, n, select(reflectance, vec3<f32>(1.0), splits));
    }
    if kind == MATERIAL_THIN_WALLED {
        // Straight on where it is smooth, else what is reflected, seen in the surface as in a mirror.
        let reflected = d + 2.0 * cos_i * m;
        let passed = select(d, reflected - 2.0 * dot(reflected, n) * n, has_gloss && material.gloss > 0.0);
        return SpecularEvent(normalize(passed), true, n, material.tint);
    }
    let cos_t = refraction(cos_i, sides.eta).cos_t;
    return SpecularEvent(normalize(sides.eta * d + (sides.eta * cos_i - cos_t) * m), true, n, material.tint);
}

/// Turns direction `d` at the shading normal, or at the geometric one where a smooth surface would send it to the wrong side. `u` chooses
/// between reflection and transmission, `v` the microfacet.
fn scatter_specular(
    material: Material, d: vec3<f32>, n_g: vec3<f32>, n_s: vec3<f32>, sides: Interface, u: f32, v: vec2<f32>,
) -> SpecularEvent {
    let alpha = material.gloss;
    var event: SpecularEvent;
    var n = n_s;
    var m = n_s;
    if has_gloss && alpha > 0.0 {
        m = visible_normal(-d, n_s, alpha, v);
    }
    // A loop rather than two calls: the second turn is rare, and calls are inlined.
    for (var attempt = 0u; attempt < 2u; attempt++) {
        event = turn(material, d, n, m, sides, u);
        let side = dot(event.direction, n_g);
        if alpha > 0.0 || select(side > 0.0, side < 0.0, event.transmitted) {
            break;
        }
        n = n_g;
        m = n_g;
    }
    if has_gloss && alpha > 0.0 {
        let sides_kept = vec2<f32>(dot(event.direction, n_g), dot(event.direction, n_s)) * select(1.0, -1.0, event.transmitted);
        let masking = masking_weight(-dot(d, n_s), abs(dot(event.direction, n_s)), alpha);
        event.weight *= select(0.0, masking, all(sides_kept > vec2<f32>(0.0)));
    }
    return event;
}

/// The most by which interpolated normals raise a photon's flux at one surface.
const ADJOINT_LIMIT: f32 = 4.0;

/// The factor by which interpolated normals change a photon's flux (Veach 1997, §5.3.2).
fn adjoint_factor(d: vec3<f32>, n_g: vec3<f32>, event: SpecularEvent) -> f32 {
    let wi_s = abs(dot(d, event.normal));
    let wo_g = abs(dot(event.direction, n_g));
    let wi_g = abs(dot(d, n_g));
    let wo_s = abs(dot(event.direction, event.normal));
    return min((wi_s * wo_g) / (wi_g * wo_s), ADJOINT_LIMIT);
}

/// The factor by which the flux of a photon along `d` counts as irradiance on a surface of normal `n`.
fn landing_factor(d: vec3<f32>, n_g: vec3<f32>, n: vec3<f32>) -> f32 {
    return min(max(-dot(d, n), 0.0) / abs(dot(d, n_g)), ADJOINT_LIMIT);
}

/// A lobe's value for two directions.
struct LobeValue {
    /// BSDF times |cos θi|, for radiance, 1/sr.
    value: vec3<f32>,
    /// Density with which `scatter_specular` draws wi, 1/sr.
    pdf: f32,
}

/// The specular lobe of a rough surface from `wo` to `wi`, both pointing away from it; `n` is on the side of `wo`. 0 for a smooth surface.
fn evaluate_specular(material: Material, wo: vec3<f32>, wi: vec3<f32>, n: vec3<f32>, sides: Interface) -> LobeValue {
    if !has_gloss {
        return LobeValue(vec3<f32>(0.0), 0.0);
    }
    let alpha = material.gloss;
    let kind = material.kind & MATERIAL_KIND_BITS;
    let cos_o = dot(wo, n);
    let passed_wall = kind == MATERIAL_THIN_WALLED && dot(wi, n) < 0.0;
    // Light that passes a thin wall is turned as what is reflected, on the other side.
    let turned = select(wi, wi - 2.0 * dot(wi, n) * n, passed_wall);
    let cos_i = dot(turned, n);
    let transmitted = cos_i < 0.0;
    let between = select(wo + turned, sides.eta * wo + turned, transmitted);
    if alpha <= 0.0 || cos_o <= 0.0 || dot(between, between) < 1e-12 || (transmitted && kind != MATERIAL_DIELECTRIC) {
        return LobeValue(vec3<f32>(0.0), 0.0);
    }
    let half_way = normalize(between);
    let m = select(half_way, -half_way, dot(half_way, n) < 0.0);
    let wo_m = dot(wo, m);
    let wi_m = dot(turned, m);
    if wo_m <= 0.0 || (wi_m < 0.0) != transmitted {
        return LobeValue(vec3<f32>(0.0), 0.0);
    }
    let density = ggx_density(dot(m, n), alpha) / cos_o;
    let lambda_o = smith_lambda(cos_o, alpha);
    let g_1 = 1.0 / (1.0 + lambda_o);
    let g_2 = 1.0 / (1.0 + lambda_o + smith_lambda(cos_i, alpha));
    let reflectance = specular_reflectance(material, wo_m, sides);
    if !transmitted {
        let chance = select(1.0, select(reflectance.x, 1.0 - reflectance.x, passed_wall), transmits(kind));
        let share = select(reflectance, (1.0 - reflectance) * material.tint, passed_wall);
        return LobeValue(share * (0.25 * density * g_2), 0.25 * density * g_1 * chance);
    }
    let stretch = sides.eta * wo_m + wi_m;
    let passed = (1.0 - reflectance.x) * density * wo_m * abs(wi_m) / (stretch * stretch);
    return LobeValue(material.tint * (sides.eta * sides.eta * passed * g_2), passed * g_1);
}
