//! Checks what materials show of pictures.

use std::ops::{Bound, RangeBounds};

use glam::Vec3;

use super::at::At;
use crate::{Error, Material, MaterialKind, Mesh, Object, Scene, Texture};

const SHARE: &str = "from 0 to 1";

impl Scene {
    /// Refuses pictures on a mesh that has no texture coordinates.
    pub(super) fn check_texture_coordinates(&self, at: &At, object: &Object) -> Result<(), Error> {
        let Mesh { uvs, .. } = &*object.mesh;
        let mut materials = object.materials.iter().map(|index| &self.materials[*index]);
        let Some(material) = materials.find(|material| uvs.is_empty() && material.all_textures().next().is_some())
        else {
            return Ok(());
        };
        Err(at.error(
            "mesh",
            format!(
                "has no texture coordinates, which the pictures of the material {:?} need; give it some (vt in an OBJ file), \
                 or choose a material without pictures",
                material.name
            ),
        ))
    }
}

/// Refuses pictures that the material's kind has no use for, and values out of range that they lead to.
pub(super) fn check_textures(at: &At, material: &Material) -> Result<(), Error> {
    let (kind, textures) = (&material.kind, &material.textures);
    let is_glass = matches!(kind, MaterialKind::Dielectric { .. } | MaterialKind::ThinWalled { .. });
    let (colors, roughness, metallic) = (colors(kind), roughness(kind), metallic(kind));
    check_use(at, "textures.color", &textures.color, !colors.is_empty(), "colour")?;
    check_use(at, "textures.roughness", &textures.roughness, roughness.is_some(), "roughness")?;
    check_use(at, "textures.metallic", &textures.metallic, metallic.is_some(), "share of metal")?;
    check_use(at, "textures.emission", &textures.emission, !is_glass, "emission")?;
    for (key, factor) in colors {
        check_color(at, key, factor, &textures.color, 0.0..=1.0, SHARE)?;
    }
    check_number(at, "roughness", roughness.unwrap_or(0.0), &textures.roughness)?;
    check_number(at, "metallic", metallic.unwrap_or(0.0), &textures.metallic)?;
    let no_bound = (Bound::Included(0.0), Bound::Unbounded);
    check_color(
        at,
        "emission",
        material.emission,
        &textures.emission,
        no_bound,
        "finite and 0 or greater (W/(m² sr))",
    )?;
    check_opacity(at, material)?;
    let Some(normal) = &textures.normal else { return Ok(()) };
    check_texture(at, "normal", &normal.texture)?;
    at.require(normal.strength.is_finite(), "normal", || {
        format!("has the strength {}; it must be a finite number", normal.strength)
    })
}

fn check_opacity(at: &At, material: &Material) -> Result<(), Error> {
    let (opacity, texture) = (material.opacity, &material.textures.opacity);
    at.number("opacity", opacity, 0.0..=1.0, SHARE)?;
    if let Some(cutoff) = material.opacity_cutoff {
        at.require((0.0..=1.0).contains(&cutoff), "opacity", || {
            format!("has the cutoff {cutoff}; it must be {SHARE}")
        })?;
    }
    if let MaterialKind::Dielectric { .. } = material.kind {
        let is_plain = opacity == 1.0 && texture.is_none() && material.opacity_cutoff.is_none();
        at.require(is_plain, "opacity", || {
            "is set, but a dielectric bounds a volume, which has no holes; it must be 1 without picture and cutoff (a sheet of \
             glass is thin-walled)"
                .to_owned()
        })?;
    }
    check_number(at, "opacity", opacity, texture)
}

/// The colours that a picture multiplies, with their keys.
fn colors(kind: &MaterialKind) -> Vec<(&'static str, Vec3)> {
    match *kind {
        MaterialKind::Diffuse { albedo } | MaterialKind::Coated { albedo, .. } => vec![("albedo", albedo)],
        MaterialKind::Phong { ambient, diffuse, .. } => vec![("diffuse", diffuse), ("ambient", ambient)],
        MaterialKind::Mirror { reflectance } => vec![("reflectance", reflectance)],
        MaterialKind::Dielectric { tint, .. } | MaterialKind::ThinWalled { tint, .. } => vec![("tint", tint)],
        MaterialKind::MetallicRoughness { base_color, .. } => vec![("base_color", base_color)],
        MaterialKind::Conductor { .. } => Vec::new(),
    }
}

fn roughness(kind: &MaterialKind) -> Option<f32> {
    match *kind {
        MaterialKind::Conductor { roughness, .. }
        | MaterialKind::Dielectric { roughness, .. }
        | MaterialKind::Coated { roughness, .. }
        | MaterialKind::ThinWalled { roughness, .. }
        | MaterialKind::MetallicRoughness { roughness, .. } => Some(roughness),
        MaterialKind::Diffuse { .. } | MaterialKind::Phong { .. } | MaterialKind::Mirror { .. } => None,
    }
}

fn metallic(kind: &MaterialKind) -> Option<f32> {
    if let MaterialKind::MetallicRoughness { metallic, .. } = *kind { Some(metallic) } else { None }
}

fn check_use(at: &At, key: &'static str, texture: &Option<Texture>, is_used: bool, what: &str) -> Result<(), Error> {
    at.require(texture.is_none() || is_used, key, || {
        format!("is set, but a material of this kind has no {what}; it must be none")
    })
}

/// Refuses a picture of colours whose extremes, times the factor, are not all allowed.
fn check_color(
    at: &At,
    key: &'static str,
    factor: Vec3,
    texture: &Option<Texture>,
    allowed: impl RangeBounds<f32>,
    right: &str,
) -> Result<(), Error> {
    let Some(texture) = texture else { return Ok(()) };
    check_texture(at, key, texture)?;
    for (which, extreme) in [("least", texture.image.least()), ("greatest", texture.image.most())] {
        let color = factor * extreme.truncate();
        let is_right = color.is_finite() && color.to_array().iter().all(|channel| allowed.contains(channel));
        at.require(is_right, key, || {
            format!("is {color} at the {which} numbers of its picture, times the factor; each channel must be {right}")
        })?;
    }
    Ok(())
}

/// Refuses a picture of a share whose extremes, times the factor, are not both from 0 to 1.
pub(super) fn check_number(at: &At, key: &'static str, factor: f32, texture: &Option<Texture>) -> Result<(), Error> {
    let Some(texture) = texture else { return Ok(()) };
    check_texture(at, key, texture)?;
    for (which, extreme) in [("least", texture.image.least()), ("greatest", texture.image.most())] {
        let number = factor * extreme[texture.channel];
        at.require((0.0..=1.0).contains(&number), key, || {
            format!("is {number} at the {which} number of its picture, times the factor; it must be {SHARE}")
        })?;
    }
    Ok(())
}

fn check_texture(at: &At, key: &'static str, texture: &Texture) -> Result<(), Error> {
    at.require(texture.channel < 4, key, || {
        format!("is of the channel {} of its picture; it must be from 0 to 3", texture.channel)
    })?;
    at.require(texture.picture_from_uv.is_finite(), key, || {
        format!("has the picture_from_uv {}; each number must be finite", texture.picture_from_uv)
    })
}
