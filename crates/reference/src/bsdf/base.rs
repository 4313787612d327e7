//! What lies under the specular lobe: Lambertian and Phong reflection.

use std::f64::consts::{FRAC_1_PI, TAU};

use diacaustic_scene::MaterialKind;
use glam::{DVec3, Vec3};

use crate::snell::reflect;
use crate::spectrum::Spectrum;

use super::{Factors, PreparedMaterial};

/// The diffuse lobe of a receiver, and Phong's additions to it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Base {
    /// ρ\*: the BSDF is ρ\*/π · T(wo) T(wi).
    pub albedo: DVec3,
    /// Radiance sent without regard to the lights, W/(m² sr).
    pub ambient: DVec3,
    /// Phong's lobe, which sees direct light alone: its share at the peak, and its exponent.
    phong: Option<(DVec3, f64)>,
}

impl Base {
    /// The base of a material at a point, if it has one, for light of a spectrum. `ambient` is the scene's.
    pub(super) fn of(
        prepared: &PreparedMaterial,
        factors: &Factors,
        ambient: DVec3,
        spectrum: &Spectrum,
    ) -> Option<Self> {
        if !prepared.is_receiver {
            return None;
        }
        let (ambient, phong) = match prepared.material.kind {
            MaterialKind::Phong { ambient: factor, specular, shininess, .. } => {
                let ambient = spectrum.color(ambient) * spectrum.color(factor.as_dvec3() * factors.color);
                (ambient, Some((spectrum.color(specular.as_dvec3()), f64::from(shininess))))
            }
            _ => (DVec3::ZERO, None),
        };
        Some(Self { albedo: spectrum.color(resolved_albedo(prepared, factors)), ambient, phong })
    }

    /// Phong's lobe toward light in plain sight, 1/sr; the cosine is not in it.
    pub fn phong(&self, wi: DVec3, wo: DVec3, normal: DVec3) -> DVec3 {
        let Some((specular, shininess)) = self.phong else { return DVec3::ZERO };
        (shininess + 2.0) / TAU * reflect(-wi, normal).dot(wo).max(0.0).powf(shininess) * specular
    }

    /// The Lambertian part, 1/sr.
    pub fn lambertian(&self) -> DVec3 {
        FRAC_1_PI * self.albedo
    }
}

/// Reflectance of glTF's model at normal incidence.
pub(super) fn metallic_f0(base_color: DVec3, metallic: f64, reflectance: Vec3) -> DVec3 {
    (1.0 - metallic) * reflectance.as_dvec3() + metallic * base_color
}

/// ρ\* of a material's base, which makes up for the light that its specular lobe keeps from entering and leaving; zero
/// without a base.
fn resolved_albedo(prepared: &PreparedMaterial, factors: &Factors) -> DVec3 {
    match prepared.material.kind {
        MaterialKind::Diffuse { albedo } | MaterialKind::Phong { diffuse: albedo, .. } => {
            albedo.as_dvec3() * factors.color
        }
        MaterialKind::Coated { albedo, ior, .. } => {
            let (albedo, n) = (albedo.as_dvec3() * factors.color, f64::from(ior));
            let inside = 1.0 - prepared.entering / (n * n);
            albedo / (n * n * (1.0 - albedo * inside))
        }
        MaterialKind::MetallicRoughness { base_color, metallic, reflectance, .. } => {
            let (color, metallic) = (base_color.as_dvec3() * factors.color, f64::from(metallic) * factors.metallic);
            let f0 = metallic_f0(color, metallic, reflectance);
            // The remainder is 0 where nothing enters: f₀ is 1 for white metal alone.
            let entering = 1.0 - (f0 + (1.0 - f0) / 21.0);
            let albedo = (1.0 - metallic) * color;
            albedo / entering.max(DVec3::splat(f64::MIN_POSITIVE))
        }
        MaterialKind::Mirror { .. }
        | MaterialKind::Conductor { .. }
        | MaterialKind::Dielectric { .. }
        | MaterialKind::ThinWalled { .. } => DVec3::ZERO,
    }
}
