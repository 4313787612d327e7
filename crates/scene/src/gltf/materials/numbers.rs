//! The numbers of materials.

use glam::Vec3;
use gltf_json::{extensions::material::Volume, material::AlphaMode, validation::Checked};

use super::super::fault::{Fault, Result};
use crate::Dispersion;

/// What remains of a colour that absorbs everything, so that its absorption is finite.
const LEAST_ATTENUATION: f32 = 1e-6;

/// The numbers of the metallic-roughness model.
#[derive(Clone, Copy)]
pub(super) struct Numbers {
    pub(super) base_color: Vec3,
    pub(super) metallic: f32,
    pub(super) roughness: f32,
    pub(super) emission: Vec3,
    pub(super) alpha: f32,
    pub(super) alpha_mode: AlphaMode,
    pub(super) alpha_cutoff: f32,
}

impl Numbers {
    /// Those of a part of a surface, which neither shines nor has holes by itself.
    pub(super) fn without_shine(self) -> Self {
        Self { emission: Vec3::ZERO, alpha_mode: AlphaMode::Opaque, ..self }
    }

    pub(super) fn of(source: &gltf_json::Material, place: &str) -> Result<Self> {
        let model = &source.pbr_metallic_roughness;
        let [r, g, b, alpha] = model.base_color_factor.0;
        for channel in [r, g, b, alpha] {
            share(channel, "baseColorFactor", place)?;
        }
        let strength = source.extensions.as_ref().and_then(|extensions| extensions.emissive_strength.as_ref());
        let strength = strength.map_or(1.0, |strength| strength.emissive_strength.0);
        let emission = Vec3::from(source.emissive_factor.0) * strength;
        if !emission.is_finite() || emission.cmplt(Vec3::ZERO).any() {
            return Err(Fault::new(place, format!("has the emission {emission}; it must be finite and 0 or greater")));
        }
        let Checked::Valid(alpha_mode) = source.alpha_mode else {
            return Err(Fault::new(place, "has an unknown alphaMode; it must be OPAQUE, MASK or BLEND"));
        };
        let cutoff = source.alpha_cutoff.map_or(0.5, |cutoff| cutoff.0);
        if !(cutoff >= 0.0 && cutoff.is_finite()) {
            return Err(Fault::new(place, format!("has the alphaCutoff {cutoff}; it must be 0 or greater")));
        }
        Ok(Self {
            base_color: Vec3::new(r, g, b),
            metallic: share(model.metallic_factor.0, "metallicFactor", place)?,
            roughness: share(model.roughness_factor.0, "roughnessFactor", place)?,
            emission,
            // Above a cutoff of 1 nothing shows.
            alpha: if cutoff > 1.0 && alpha_mode == AlphaMode::Mask { 0.0 } else { alpha },
            alpha_mode,
            alpha_cutoff: cutoff.min(1.0),
        })
    }
}

/// A number from 0 to 1.
pub(super) fn share(number: f32, key: &str, place: &str) -> Result<f32> {
    if (0.0..=1.0).contains(&number) {
        return Ok(number);
    }
    Err(Fault::new(place, format!("has {number} as its {key}; it must be from 0 to 1")))
}

/// What glass does to light, besides its colour and roughness.
pub(super) struct Glass {
    pub(super) ior: f32,
    pub(super) dispersion: Dispersion,
    /// Absorption coefficient, 1/m.
    pub(super) absorption: Vec3,
}

/// The absorption coefficient, 1/m, that leaves the attenuation colour after the attenuation distance.
pub(super) fn absorption(volume: &Volume, place: &str) -> Result<Vec3> {
    let (color, distance) = (volume.attenuation_color.0, volume.attenuation_distance.0);
    for channel in color {
        share(channel, "attenuationColor", place)?;
    }
    if distance.is_nan() || distance <= 0.0 {
        return Err(Fault::new(place, format!("has an attenuationDistance of {distance}; it must be greater than 0")));
    }
    let coefficients = color.map(|channel| -channel.max(LEAST_ATTENUATION).ln() / distance);
    // −ln 1 is −0.
    Ok(Vec3::from(coefficients).max(Vec3::ZERO).min(Vec3::splat(f32::MAX)))
}

/// The rank of a volume, from a material's `extras`: `{ "priority": 2 }`.
pub(super) fn priority(extras: Option<&str>, place: &str) -> Result<i32> {
    let extras: serde_json::Value = extras.and_then(|text| serde_json::from_str(text).ok()).unwrap_or_default();
    let Some(priority) = extras.get("priority") else { return Ok(0) };
    let whole = priority.as_i64().and_then(|number| i32::try_from(number).ok());
    whole.ok_or_else(|| Fault::new(place, "has extras.priority, which must be a whole number of 32 bits"))
}
