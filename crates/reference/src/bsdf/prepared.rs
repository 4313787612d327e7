//! What a material is at all of its points, and what changes from one to another.

use diacaustic_scene::{Material, MaterialKind, Textures};
use glam::{DVec2, DVec3};

use crate::fresnel::diffuse_reflectance;
use crate::texture::{color_at, number_at};

/// A material of the scene, with what is the same wherever a ray meets it.
#[derive(Clone, Debug)]
pub(crate) struct PreparedMaterial<'a> {
    pub(crate) material: &'a Material,
    pub(crate) is_caster: bool,
    pub(crate) is_receiver: bool,
    pub(crate) has_holes: bool,
    /// Whether pictures change its colour, its roughness or its share of metal.
    pub(crate) varies: bool,
    /// 1 − F_ex, the share of even light that enters a coat in air; 1 without a coat.
    pub(crate) entering: f64,
}

impl<'a> PreparedMaterial<'a> {
    pub(crate) fn new(material: &'a Material) -> Self {
        let Textures { color, roughness, metallic, .. } = &material.textures;
        Self {
            material,
            is_caster: material.is_caster_alone(),
            is_receiver: material.is_receiver_alone(),
            has_holes: material.has_holes(),
            varies: color.is_some() || roughness.is_some() || metallic.is_some(),
            entering: match material.kind {
                MaterialKind::Coated { ior, .. } => 1.0 - diffuse_reflectance(1.0 / f64::from(ior)),
                _ => 1.0,
            },
        }
    }
}

/// What pictures multiply a material's numbers by at a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Factors {
    pub(crate) color: DVec3,
    pub(crate) roughness: f64,
    pub(crate) metallic: f64,
}

impl Factors {
    /// Those of a material without pictures.
    pub(crate) const ONE: Self = Self { color: DVec3::ONE, roughness: 1.0, metallic: 1.0 };

    /// Those at texture coordinates.
    pub(crate) fn at(textures: &Textures, uv: DVec2) -> Self {
        Self {
            color: color_at(textures.color.as_ref(), uv),
            roughness: number_at(textures.roughness.as_ref(), uv),
            metallic: number_at(textures.metallic.as_ref(), uv),
        }
    }
}
