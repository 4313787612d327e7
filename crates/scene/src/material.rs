//! What surfaces do to light.

use glam::Vec3;

/// A named material.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// The name under which objects refer to it.
    pub name: String,
    /// What it does to light.
    pub kind: MaterialKind,
}

/// The scattering models. Colours are linear Rec. 709, per channel.
#[derive(Clone, Debug, PartialEq)]
pub enum MaterialKind {
    /// A Lambertian surface, on both sides.
    Diffuse {
        /// Reflected share of the incident flux, 0 to 1.
        albedo: Vec3,
    },
    /// The 2016 paper's local model: ambient, diffuse and specular light, on both sides.
    Phong {
        /// Factor on the scene's ambient radiance, 0 to 1.
        ambient: Vec3,
        /// Lambertian share of the incident flux, 0 to 1.
        diffuse: Vec3,
        /// Share of the incident flux in the specular lobe at its peak direction, 0 to 1; the lobe is normalised
        /// by (n + 2)/2π and sees direct light alone, for an energy map keeps no directions.
        specular: Vec3,
        /// The lobe's exponent n, > 0.
        shininess: f32,
    },
    /// A perfect mirror, on both sides.
    Mirror {
        /// Reflected share of the incident flux, 0 to 1.
        reflectance: Vec3,
    },
    /// A smooth dielectric: the object's closed surface bounds a volume of this index.
    Dielectric {
        /// Index of refraction against the surroundings, > 0.
        ior: f32,
        /// Factor on light at each crossing of the boundary, 0 to 1.
        tint: Vec3,
        /// Absorption coefficient σ of the interior, 1/m, ≥ 0 (Beer–Lambert).
        absorption: Vec3,
    },
}

impl MaterialKind {
    /// Whether the material passes light on along one direction: a *caster*, whose light the energy maps own.
    /// Everything else is a *receiver* and has an energy map.
    ///
    /// The one place where this is decided, for both passes.
    pub fn is_caster(&self) -> bool {
        matches!(self, Self::Mirror { .. } | Self::Dielectric { .. })
    }
}
