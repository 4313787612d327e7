//! What the profile `paper` sets up in place of the physical model; docs/paper.md.

use diacaustic_scene::{PaperProfile, PaperSampling, RenderSettings};
use diacaustic_shaders as shaders;
use diacaustic_surface::BoundingSphere;
use glam::Vec3;

use crate::{Emission, lights::Lights};

/// How the light emits; none if there is nothing that casts light on.
pub(crate) fn emission(profile: &PaperProfile, casters: &[BoundingSphere]) -> Option<Emission> {
    (!casters.is_empty()).then_some(Emission::Paper { energy: profile.energy })
}

/// Steps of each angle of equation 1; 0 for random ones.
pub(crate) fn grid_side(profile: &PaperProfile, settings: &RenderSettings) -> u32 {
    match profile.sampling {
        // The scene is valid: it has at most 2³² − 1 photons.
        PaperSampling::Grid => settings.photons.unwrap_or(0).isqrt() as u32,
        PaperSampling::Random => 0,
    }
}

/// Gives the light's record the axis of equation 1's sphere.
pub(crate) fn set_pole(profile: &PaperProfile, lights: &mut Lights) {
    for record in &mut lights.records {
        record.axis = profile.pole.normalize_or(Vec3::Z).into();
    }
}

/// Gives a dielectric's record the paper's transparency, and as emission the part of its own colour that the camera sees.
pub(crate) fn color_dielectric(profile: &PaperProfile, ambient: Vec3, record: &mut shaders::Material) {
    let tint = Vec3::from(record.tint);
    record.tint = (profile.transparency * tint).into();
    record.emission = ((1.0 - profile.transparency) * tint * ambient).into();
}
