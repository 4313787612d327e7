//! Checks materials.

use glam::Vec3;

use super::{
    at::{At, above},
    textures::check_textures,
};
use crate::{Dispersion, Error, LONGEST_WAVELENGTH, Material, MaterialKind, SHORTEST_WAVELENGTH, Scene, Subject};

/// The most materials of a scene: kernels pack a material's index in 16 bits.
const MOST_MATERIALS: usize = 65_535;

impl Scene {
    pub(super) fn check_materials(&self) -> Result<(), Error> {
        let count = self.materials.len();
        At(Subject::Scene).require(count <= MOST_MATERIALS, "materials", || {
            format!("has {count} entries; it must have at most {MOST_MATERIALS}")
        })?;
        self.materials.iter().enumerate().try_for_each(|(index, material)| check_material(index, material))
    }
}

fn check_material(index: usize, material: &Material) -> Result<(), Error> {
    let at = At(Subject::Material { index, name: material.name.clone() });
    check_kind(&at, &material.kind)?;
    at.channels("emission", material.emission, 0.0.., "0 or greater (W/(m² sr))")?;
    let is_glass = matches!(material.kind, MaterialKind::Dielectric { .. } | MaterialKind::ThinWalled { .. });
    at.require(!is_glass || material.emission == Vec3::ZERO, "emission", || {
        format!("is {}, but glass takes no emission; it must be 0", material.emission)
    })?;
    check_textures(&at, material)
}

fn check_kind(at: &At, kind: &MaterialKind) -> Result<(), Error> {
    let check_share = |key, color| at.channels(key, color, 0.0..=1.0, "from 0 to 1");
    let check_ior = |ior| at.number("ior", ior, above(0.0), "finite and greater than 0");
    let check_roughness = |roughness| at.number("roughness", roughness, 0.0..=1.0, "from 0 to 1");
    match *kind {
        MaterialKind::Diffuse { albedo } => check_share("albedo", albedo),
        MaterialKind::Mirror { reflectance } => check_share("reflectance", reflectance),
        MaterialKind::Phong { ambient, diffuse, specular, shininess } => {
            check_share("ambient", ambient)?;
            check_share("diffuse", diffuse)?;
            check_share("specular", specular)?;
            at.number("shininess", shininess, above(0.0), "finite and greater than 0")
        }
        MaterialKind::Conductor { eta, k, roughness } => {
            at.channels("eta", eta, above(0.0), "finite and greater than 0")?;
            at.channels("k", k, 0.0.., "finite and 0 or greater")?;
            check_roughness(roughness)
        }
        MaterialKind::Dielectric { ior, dispersion, tint, absorption, roughness, priority: _ } => {
            check_ior(ior)?;
            check_dispersion(at, ior, dispersion)?;
            check_share("tint", tint)?;
            at.channels("absorption", absorption, 0.0.., "0 or greater (1/m)")?;
            check_roughness(roughness)
        }
        MaterialKind::ThinWalled { ior, tint } => {
            check_ior(ior)?;
            check_share("tint", tint)
        }
        MaterialKind::Coated { albedo, ior, roughness } => {
            check_share("albedo", albedo)?;
            at.number("ior", ior, 1.0.., "1 or greater and finite")?;
            check_roughness(roughness)
        }
        MaterialKind::MetallicRoughness { base_color, reflectance, metallic, roughness } => {
            check_share("base_color", base_color)?;
            at.channels("reflectance", reflectance, 0.0..=0.9, "from 0 to 0.9")?;
            at.number("metallic", metallic, 0.0..=1.0, "from 0 to 1")?;
            check_roughness(roughness)
        }
    }
}

/// Steps, nm, at which the index of refraction is looked at.
const INDEX_STEP: usize = 5;

fn check_dispersion(at: &At, ior: f32, dispersion: Dispersion) -> Result<(), Error> {
    if let Dispersion::Abbe(number) = dispersion {
        at.number("abbe", number, above(0.0), "finite and greater than 0")?;
    }
    for nm in (SHORTEST_WAVELENGTH as usize..=LONGEST_WAVELENGTH as usize).step_by(INDEX_STEP) {
        let index = dispersion.index(ior, nm as f64);
        at.require(index.is_finite() && index > 0.0, "dispersion", || {
            format!("makes the index of refraction {index} at {nm} nm; it must be finite and greater than 0")
        })?;
    }
    Ok(())
}
