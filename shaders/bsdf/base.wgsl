// The diffuse base of receivers; docs/materials.md, "Materials".

import package::bsdf::specular::{specular_reflectance, Interface};
import package::layout::features::has_gloss;
import package::layout::scene::{Material, MATERIAL_COATED, MATERIAL_KIND_BITS, MATERIAL_METALLIC_ROUGHNESS, MATERIAL_PHONG};
import package::sampling::warp::PI;

/// Whether the base lies under a specular lobe.
fn is_covered(material: Material) -> bool {
    let kind = material.kind & MATERIAL_KIND_BITS;
    return kind == MATERIAL_COATED || kind == MATERIAL_METALLIC_ROUGHNESS;
}

/// Reflectance of the specular lobe over the base at a direction's cosine with the shading normal: the base gets the rest.
fn gloss_reflectance(material: Material, cosine: f32, sides: Interface) -> vec3<f32> {
    if !has_gloss || !is_covered(material) {
        return vec3<f32>(0.0);
    }
    return specular_reflectance(material, cosine, sides);
}

/// BSDF of the base, 1/sr, without the gloss's transmission toward `wo`, for unit directions pointing away from the surface on the side of unit
/// normal `n`: Lambertian, and for Phong a lobe around the mirror direction normalised by (n + 2)/2π.
fn base_bsdf(material: Material, wi: vec3<f32>, wo: vec3<f32>, n: vec3<f32>, sides: Interface) -> vec3<f32> {
    let diffuse = material.base / PI;
    if (material.kind & MATERIAL_KIND_BITS) != MATERIAL_PHONG {
        return diffuse * (1.0 - gloss_reflectance(material, dot(wi, n), sides));
    }
    let exponent = material.ior;
    let cos_lobe = max(dot(reflect(-wi, n), wo), 0.0);
    return diffuse + material.specular * (0.5 * (exponent + 2.0) / PI * pow(cos_lobe, exponent));
}
