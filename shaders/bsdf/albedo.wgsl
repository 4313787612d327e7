// The albedo of every material; docs/layers.md.

import package::bsdf::specular::{specular_reflectance, Interface};
import package::layout::scene::{
    Material, MATERIAL_COATED, MATERIAL_DIELECTRIC, MATERIAL_DIFFUSE, MATERIAL_KIND_BITS, MATERIAL_METALLIC_ROUGHNESS, MATERIAL_PHONG,
    MATERIAL_THIN_WALLED,
};

/// The share of the light from everywhere that a surface sends along a direction of this cosine with its normal, by reflection and
/// transmission, without what roughness loses and without Phong's lobe.
fn albedo(material: Material, cosine: f32, sides: Interface) -> vec3<f32> {
    let kind = material.kind & MATERIAL_KIND_BITS;
    if kind == MATERIAL_DIFFUSE || kind == MATERIAL_PHONG {
        return material.base;
    }
    let specular = specular_reflectance(material, cosine, sides);
    if kind == MATERIAL_DIELECTRIC || kind == MATERIAL_THIN_WALLED {
        return specular + (1.0 - specular) * material.tint;
    }
    // What passes the gloss on its way in, on average over directions.
    var entering = vec3<f32>(0.0);
    if kind == MATERIAL_COATED {
        entering = vec3<f32>(material.ior * material.ior * (1.0 - material.extinction.x));
    } else if kind == MATERIAL_METALLIC_ROUGHNESS {
        entering = 1.0 - (material.specular + (1.0 - material.specular) / 21.0);
    }
    return specular + (1.0 - specular) * entering * material.base;
}
