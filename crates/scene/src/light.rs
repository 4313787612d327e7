//! Emitters.

use glam::Vec3;

/// A named emitter.
#[derive(Clone, Debug, PartialEq)]
pub struct Light {
    /// Its name in statistics and messages.
    pub name: String,
    /// Its shape and power.
    pub kind: LightKind,
}

/// The shapes of emitters.
#[derive(Clone, Debug, PartialEq)]
pub enum LightKind {
    /// A sphere that radiates evenly from each point in each direction (Lambertian); its own surface reflects nothing.
    Sphere {
        /// Centre, metres, world frame.
        center: Vec3,
        /// Radius, metres, > 0.
        radius: f32,
        /// Radiant flux Φ, W per channel, ≥ 0.
        flux: Vec3,
    },
}

impl LightKind {
    /// Radiant flux Φ, W per channel.
    pub fn flux(&self) -> Vec3 {
        match *self {
            Self::Sphere { flux, .. } => flux,
        }
    }

    /// Radiance of the surface, W/(m² sr) per channel: Φ/(4π²R²) for a sphere.
    pub fn radiance(&self) -> Vec3 {
        match *self {
            Self::Sphere { radius, flux, .. } => {
                flux / (4.0 * std::f32::consts::PI * std::f32::consts::PI * radius * radius)
            }
        }
    }
}
