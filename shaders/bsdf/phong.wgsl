// Receivers: what they reflect of direct light and of the irradiance in their map.

import package::layout::scene::{Material, MATERIAL_PHONG};
import package::sampling::warp::PI;

/// BSDF of a receiver, 1/sr, for unit directions `wi` and `wo` pointing away from the surface on the side of unit normal `n`:
/// Lambertian, and for Phong a lobe around the mirror direction normalised by (n + 2)/2π.
fn receiver_bsdf(material: Material, wi: vec3<f32>, wo: vec3<f32>, n: vec3<f32>) -> vec3<f32> {
    let diffuse = material.reflectance / PI;
    if material.kind != MATERIAL_PHONG {
        return diffuse;
    }
    let exponent = material.shininess;
    let cos_lobe = max(dot(reflect(-wi, n), wo), 0.0);
    return diffuse + material.specular * (0.5 * (exponent + 2.0) / PI * pow(cos_lobe, exponent));
}
