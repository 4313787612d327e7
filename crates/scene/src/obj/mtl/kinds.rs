//! The kind of material that MTL's numbers stand for.

use glam::Vec3;

use super::entry::Entry;
use crate::{Dispersion, MaterialKind, PLASTIC_REFLECTANCE};

/// Index of refraction of a dielectric or a coat that states none.
const DEFAULT_IOR: f32 = 1.5;

/// Diffuse albedo of a material that states no colour.
const DEFAULT_ALBEDO: Vec3 = Vec3::splat(0.8);

/// Roughness of a material of the PBR extension that states none.
const DEFAULT_ROUGHNESS: f32 = 0.5;

impl Entry {
    /// The kind. A colour that a picture makes is white where the file states none.
    pub(super) fn kind(&self) -> MaterialKind {
        let model = self.illumination_model.unwrap_or(0.0);
        let default = if self.maps.diffuse.is_some() { Vec3::ONE } else { DEFAULT_ALBEDO };
        let albedo = self.diffuse.unwrap_or(default);
        let specular = self.specular.unwrap_or(Vec3::ZERO);
        let shininess = self.shininess.unwrap_or(0.0);
        let metallic = self.metallic.unwrap_or(0.0);
        if self.is_glass() {
            let color = self.diffuse.filter(|diffuse| *diffuse != Vec3::ZERO);
            MaterialKind::Dielectric {
                dispersion: Dispersion::None,
                ior: self.ior.unwrap_or(DEFAULT_IOR),
                tint: self.transmission.or(color).unwrap_or(Vec3::ONE),
                absorption: Vec3::ZERO,
                roughness: self.roughness.unwrap_or(0.0),
                priority: 0,
            }
        } else if self.coat.is_some_and(|coat| coat >= 0.5) && metallic == 0.0 && self.maps.metallic.is_none() {
            MaterialKind::Coated { albedo, ior: DEFAULT_IOR, roughness: self.coat_roughness.unwrap_or(0.0) }
        } else if self.is_metallic_roughness() {
            MaterialKind::MetallicRoughness {
                base_color: albedo,
                reflectance: PLASTIC_REFLECTANCE,
                metallic: self.metallic.unwrap_or(if self.maps.metallic.is_some() { 1.0 } else { 0.0 }),
                roughness: self.roughness.unwrap_or(if self.maps.roughness.is_some() {
                    1.0
                } else {
                    DEFAULT_ROUGHNESS
                }),
            }
        } else if model == 3.0 || model == 5.0 {
            MaterialKind::Mirror { reflectance: self.specular.unwrap_or(Vec3::ONE) }
        } else if model == 2.0 && specular != Vec3::ZERO && shininess > 0.0 {
            let ambient = self.ambient.unwrap_or(Vec3::ZERO);
            MaterialKind::Phong { ambient, diffuse: albedo, specular, shininess }
        } else {
            MaterialKind::Diffuse { albedo }
        }
    }

    /// Whether light passes: by the illumination model or by its opacity, which `d` states before `Tr`. A picture of the opacity makes
    /// holes, not glass.
    fn is_glass(&self) -> bool {
        let model = self.illumination_model.unwrap_or(0.0);
        let opacity = self.dissolve.or(self.transparency.map(|transparency| 1.0 - transparency)).unwrap_or(1.0);
        self.maps.dissolve.is_none() && ([4.0, 6.0, 7.0, 9.0].contains(&model) || opacity < 1.0)
    }

    fn is_metallic_roughness(&self) -> bool {
        self.roughness.is_some()
            || self.metallic.is_some()
            || self.maps.roughness.is_some()
            || self.maps.metallic.is_some()
    }
}
