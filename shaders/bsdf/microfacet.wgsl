// GGX microfacets (Trowbridge and Reitz 1975; Walter et al. 2007); docs/materials.md, "Microfacets".

import package::sampling::warp::{frame, PI};

/// Density of microfacet normals, per solid angle and projected area; `cos_m` is the cosine between `m` and the normal.
fn ggx_density(cos_m: f32, alpha: f32) -> f32 {
    let a2 = alpha * alpha;
    let d = cos_m * cos_m * (a2 - 1.0) + 1.0;
    return a2 / (PI * d * d);
}

/// Smith's Λ: the hidden over the visible microfacet area from a direction of this cosine.
fn smith_lambda(cosine: f32, alpha: f32) -> f32 {
    let cos2 = max(cosine * cosine, 1e-12);
    return 0.5 * (sqrt(1.0 + alpha * alpha * (1.0 - cos2) / cos2) - 1.0);
}

/// A microfacet normal among those visible from `wo`, on the side of `n` (Heitz 2018).
fn visible_normal(wo: vec3<f32>, n: vec3<f32>, alpha: f32, u: vec2<f32>) -> vec3<f32> {
    let basis = frame(n);
    let v = normalize(vec3<f32>(alpha * dot(wo, basis.tangent), alpha * dot(wo, basis.bitangent), dot(wo, n)));
    let across = dot(v.xy, v.xy);
    let t_1 = select(vec3<f32>(1.0, 0.0, 0.0), vec3<f32>(-v.y, v.x, 0.0) * inverseSqrt(max(across, 1e-30)), across > 0.0);
    let t_2 = cross(v, t_1);
    let radius = sqrt(u.x);
    let phi = 2.0 * PI * u.y;
    let p = radius * cos(phi);
    let s = 0.5 * (1.0 + v.z);
    let q = (1.0 - s) * sqrt(max(1.0 - p * p, 0.0)) + s * radius * sin(phi);
    let h = p * t_1 + q * t_2 + sqrt(max(1.0 - p * p - q * q, 0.0)) * v;
    let m = normalize(vec3<f32>(alpha * h.xy, max(h.z, 0.0)));
    return normalize(m.x * basis.tangent + m.y * basis.bitangent + m.z * n);
}

/// G₂/G₁(wo): the weight of a direction drawn through a visible normal.
fn masking_weight(cos_o: f32, cos_i: f32, alpha: f32) -> f32 {
    let visible = 1.0 + smith_lambda(cos_o, alpha);
    return visible / (visible + smith_lambda(cos_i, alpha));
}
