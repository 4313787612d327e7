//! What colour a receiver has in a lightmap's light.

use diacaustic_scene::{Material, MaterialKind};
use glam::{Vec2, Vec3};

use crate::material_records::{mean_reflectance, reflectance, under_coat};

/// The share of light from everywhere that a material's base sends out along its normal, at texture coordinates `uv` and where the mesh's vertices
/// have the colour `vertex_color`, 1 without: a receiver whose
/// lightmap holds E shows about this share of E/π. It is exact for matt surfaces; a gloss over the base takes a share that depends on
/// directions, which a lightmap does not know, and shows nothing of its own. 0 for what is no receiver.
pub fn base_reflectance(material: &Material, uv: Vec2, vertex_color: Vec3) -> Vec3 {
    let own = base_reflectance_alone(material, uv, vertex_color);
    let Some(blend) = &material.blend else { return own };
    base_reflectance_alone(&blend.rest, uv, vertex_color).lerp(own, blend.share_at(uv))
}

/// The same without what the material is blended with.
fn base_reflectance_alone(material: &Material, uv: Vec2, vertex_color: Vec3) -> Vec3 {
    let textures = &material.textures;
    let picture = vertex_color * textures.color.as_ref().map_or(Vec3::ONE, |texture| texture.at(uv).truncate());
    match material.kind {
        MaterialKind::Diffuse { albedo } => albedo * picture,
        MaterialKind::Phong { diffuse, .. } => diffuse * picture,
        MaterialKind::Coated { albedo, ior, .. } => {
            let n = f64::from(ior);
            // ρ* holds the 1/n² by which radiance spreads on its way out; what goes in is 1 − F on average.
            let passes = (1.0 - reflectance(1.0, n)) * (1.0 - mean_reflectance(n));
            passes as f32 * under_coat(albedo * picture, ior)
        }
        MaterialKind::MetallicRoughness { base_color, reflectance: normal, metallic, .. } => {
            let metallic = metallic * textures.metallic.as_ref().map_or(1.0, |texture| texture.number_at(uv));
            let color = base_color * picture;
            (1.0 - metallic) * color * (Vec3::ONE - normal.lerp(color, metallic))
        }
        MaterialKind::Mirror { .. }
        | MaterialKind::Conductor { .. }
        | MaterialKind::Dielectric { .. }
        | MaterialKind::ThinWalled { .. } => Vec3::ZERO,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_coat_takes_its_share_twice() {
        let color = |kind| base_reflectance(&Material::new("it", kind), Vec2::ZERO, Vec3::ONE);
        let albedo = Vec3::new(0.0, 0.8, 1.0);
        assert_eq!(color(MaterialKind::Diffuse { albedo }), albedo);
        let painted = Material::new("it", MaterialKind::Diffuse { albedo });
        assert_eq!(base_reflectance(&painted, Vec2::ZERO, Vec3::new(1.0, 0.5, 0.0)), Vec3::new(0.0, 0.4, 0.0));
        let coated = color(MaterialKind::Coated { albedo, ior: 1.5, roughness: 0.0 });
        // 1 − 0.0918 goes in (Walsh 1926), 0.96 of what meets the coat along the normal comes out, spread by 1.5².
        let (inside, passes) = (1.0 - (1.0 - 0.0918) / 2.25, 0.96 * (1.0 - 0.0918) / 2.25);
        let expected = |rho: f64| (passes * rho / (1.0 - rho * inside)) as f32;
        assert!(coated.abs_diff_eq(albedo.map(|rho| expected(f64::from(rho))), 1e-3), "{coated}");
        assert_eq!(color(MaterialKind::Mirror { reflectance: Vec3::ONE }), Vec3::ZERO);
    }
}
