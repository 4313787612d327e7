//! Checks materials.

use glam::Vec3;

use super::{
    at::{At, above},
    textures::{check_number, check_textures},
};
use crate::{
    Blend, Dispersion, Error, LONGEST_WAVELENGTH, Material, MaterialKind, SHORTEST_WAVELENGTH, Scene, Subject,
};

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
    check_one(&at, material)?;
    material.blend.as_ref().map_or(Ok(()), |blend| check_blend(&at, material, blend))
}

fn check_one(at: &At, material: &Material) -> Result<(), Error> {
    check_kind(at, &material.kind)?;
    at.channels("emission", material.emission, 0.0.., "0 or greater (W/(m² sr))")?;
    let is_glass = matches!(material.kind, MaterialKind::Dielectric { .. } | MaterialKind::ThinWalled { .. });
    at.require(!is_glass || material.emission == Vec3::ZERO, "emission", || {
        format!("is {}, but glass takes no emission; it must be 0", material.emission)
    })?;
    check_textures(at, material)
}

/// Refuses what cannot be the other part of a material.
fn check_blend(at: &At, material: &Material, blend: &Blend) -> Result<(), Error> {
    at.number("share", blend.share, 0.0..=1.0, "from 0 to 1")?;
    check_number(at, "share", blend.share, &blend.texture)?;
    let rest = &blend.rest;
    let refuse = |is_wrong: bool, what: &str| {
        at.require(!is_wrong, "rest", || format!("is the material {:?}, which {what}; name another", rest.name))
    };
    refuse(
        matches!(rest.kind, MaterialKind::Dielectric { .. }),
        "is a dielectric, and the rest of a surface bounds no volume",
    )?;
    refuse(rest.blend.is_some(), "has a rest of its own")?;
    refuse(
        rest.emission != Vec3::ZERO,
        "has an emission, but the whole surface has that of the material with the rest",
    )?;
    let is_whole = rest.opacity == 1.0 && rest.opacity_cutoff.is_none() && rest.textures.opacity.is_none();
    refuse(!is_whole, "has an opacity, but the whole surface has that of the material with the rest")?;
    let place = |material: &Material| material.textures.normal.as_ref().map(|map| map.texture.picture_from_uv);
    let differ = place(material).zip(place(rest)).is_some_and(|(own, other)| own != other);
    refuse(differ, "has a normal map that lies in another way on the surface")?;
    check_one(at, rest)
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
        MaterialKind::ThinWalled { ior, tint, roughness } => {
            check_ior(ior)?;
            check_share("tint", tint)?;
            check_roughness(roughness)
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
