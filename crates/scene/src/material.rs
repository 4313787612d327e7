//! What surfaces do to light.

use glam::{Vec2, Vec3};

use crate::{Dispersion, NormalMap, Texture, Textures};

/// A named material.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// The name under which objects refer to it.
    pub name: String,
    /// What it does to light.
    pub kind: MaterialKind,
    /// Radiance that the surface's front sends in each direction (Lambertian), W/(m² sr) per channel, ≥ 0. Dielectrics and
    /// thin-walled glass have none.
    pub emission: Vec3,
    /// The group of lights in whose layers its emission is kept; that of all lights that name none, if none.
    pub group: Option<String>,
    /// Share of the light that meets the surface at all, 0 to 1; the rest passes as if it were not there. 1 for dielectrics.
    pub opacity: f32,
    /// Where set, opacity is 1 where it is at least this great, else 0.
    pub opacity_cutoff: Option<f32>,
    /// Pictures that modulate it.
    pub textures: Textures,
    /// What else the surface is in part.
    pub blend: Option<Box<Blend>>,
}

/// What a surface is where it is not its material: every ray takes the one or the other by chance, and so what surfaces do to light is the mean of both.
#[derive(Clone, Debug, PartialEq)]
pub struct Blend {
    /// Share of the light that meets the material itself, 0 to 1.
    pub share: f32,
    /// A picture that the share is multiplied by.
    pub texture: Option<Texture>,
    /// What the rest of the light meets. It is no dielectric and has no blend; emission and opacity are those of the material that it is blended with.
    pub rest: Material,
}

impl Blend {
    /// The share at texture coordinates `uv`.
    pub fn share_at(&self, uv: Vec2) -> f32 {
        self.share * self.texture.as_ref().map_or(1.0, |texture| texture.number_at(uv))
    }
}

/// The scattering models, as `docs/materials.md` defines them. Colours are linear Rec. 709, per channel. `roughness` is that of
/// glTF, from 0 to 1: the GGX width α is its square, and below [`SMOOTH`] the surface is perfectly smooth.
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
    /// A metal, on both sides.
    Conductor {
        /// Real part of its index of refraction, > 0.
        eta: Vec3,
        /// Imaginary part (extinction coefficient), ≥ 0.
        k: Vec3,
        /// Roughness.
        roughness: f32,
    },
    /// A dielectric: the object's closed surface bounds a volume of this index.
    Dielectric {
        /// Index of refraction at [`STATED_WAVELENGTH`](crate::STATED_WAVELENGTH), > 0; that of air is 1.
        ior: f32,
        /// How the index changes with the wavelength.
        dispersion: Dispersion,
        /// Factor on light at each crossing of the boundary, 0 to 1.
        tint: Vec3,
        /// Absorption coefficient σ of the interior, 1/m, ≥ 0 (Beer–Lambert).
        absorption: Vec3,
        /// Roughness.
        roughness: f32,
        /// Where volumes overlap, the one of the highest priority fills the place; among equals, that of the material listed first.
        priority: i32,
    },
    /// A sheet of glass without thickness, on both sides: light passes straight or is reflected, after all inner reflections.
    ThinWalled {
        /// Index of refraction, > 0.
        ior: f32,
        /// Factor on light that passes, 0 to 1.
        tint: Vec3,
        /// Roughness, by which what passes spreads as widely as what is reflected.
        roughness: f32,
    },
    /// A Lambertian base under a clear coat (plastic, varnish), on both sides.
    Coated {
        /// Albedo of the base, 0 to 1.
        albedo: Vec3,
        /// Index of refraction of the coat, ≥ 1.
        ior: f32,
        /// Roughness of the coat.
        roughness: f32,
    },
    /// glTF's metallic-roughness model, on both sides.
    MetallicRoughness {
        /// Base colour, 0 to 1.
        base_color: Vec3,
        /// Reflectance along the normal of what is no metal, 0 to 0.9; [`PLASTIC_REFLECTANCE`] unless stated.
        reflectance: Vec3,
        /// Share of metal, 0 to 1.
        metallic: f32,
        /// Roughness.
        roughness: f32,
    },
}

/// Reflectance along the normal of glTF's model where there is no metal and nothing else is stated: that of the index 1.5.
pub const PLASTIC_REFLECTANCE: Vec3 = Vec3::splat(0.04);

/// Roughness under which a surface is perfectly smooth.
pub const SMOOTH: f32 = 0.03;

/// Roughness from which the gloss of a material that is also diffuse belongs to the receiver: next-event estimation resolves it.
/// Below, it is mirror-like and casts light on.
pub const GLOSSY: f32 = 0.3;

impl Material {
    /// A material that neither shines nor shows pictures.
    pub fn new(name: impl Into<String>, kind: MaterialKind) -> Self {
        let textures = Textures::default();
        Self {
            name: name.into(),
            kind,
            emission: Vec3::ZERO,
            group: None,
            opacity: 1.0,
            opacity_cutoff: None,
            textures,
            blend: None,
        }
    }

    /// Whether the material passes light on along one direction or a narrow lobe: a *caster*, whose light the energy maps own.
    ///
    /// This and [`is_receiver`](Self::is_receiver) are the one place where this is decided, for both passes. A material can be both.
    /// Where a picture makes the roughness or the share of metal, its extreme decides for the whole material.
    pub fn is_caster(&self) -> bool {
        self.is_caster_alone() || self.rest().is_some_and(Self::is_caster_alone)
    }

    /// The same of the material without what it is blended with.
    pub fn is_caster_alone(&self) -> bool {
        match self.kind {
            MaterialKind::Mirror { .. }
            | MaterialKind::Dielectric { .. }
            | MaterialKind::ThinWalled { .. }
            | MaterialKind::Conductor { .. } => true,
            MaterialKind::Coated { roughness, .. } => self.least_roughness(roughness) < GLOSSY,
            MaterialKind::MetallicRoughness { metallic, roughness, .. } => {
                self.least_metallic(metallic) == 1.0 || self.least_roughness(roughness) < GLOSSY
            }
            MaterialKind::Diffuse { .. } | MaterialKind::Phong { .. } => false,
        }
    }

    /// Whether the material has a diffuse lobe: a *receiver*, whose object has an energy map.
    pub fn is_receiver(&self) -> bool {
        self.is_receiver_alone() || self.rest().is_some_and(Self::is_receiver_alone)
    }

    /// The same of the material without what it is blended with.
    pub fn is_receiver_alone(&self) -> bool {
        match self.kind {
            MaterialKind::Diffuse { .. } | MaterialKind::Phong { .. } | MaterialKind::Coated { .. } => true,
            MaterialKind::MetallicRoughness { metallic, .. } => self.least_metallic(metallic) < 1.0,
            MaterialKind::Mirror { .. }
            | MaterialKind::Dielectric { .. }
            | MaterialKind::ThinWalled { .. }
            | MaterialKind::Conductor { .. } => false,
        }
    }

    /// What it is blended with.
    pub fn rest(&self) -> Option<&Self> {
        self.blend.as_ref().map(|blend| &blend.rest)
    }

    /// Its pictures, with those of what it is blended with.
    pub fn all_textures(&self) -> impl Iterator<Item = &Texture> {
        let of_blend = self.blend.iter().flat_map(|blend| blend.texture.iter().chain(blend.rest.textures.iter()));
        self.textures.iter().chain(of_blend)
    }

    /// Its normal map, or that of what it is blended with; both lie in the same way.
    pub fn normal_map(&self) -> Option<&NormalMap> {
        self.textures.normal.as_ref().or_else(|| self.rest()?.textures.normal.as_ref())
    }

    /// A dielectric's index of refraction at [`STATED_WAVELENGTH`](crate::STATED_WAVELENGTH) and how it changes; none if it does not.
    pub fn dispersion(&self) -> Option<(f32, Dispersion)> {
        match self.kind {
            MaterialKind::Dielectric { ior, dispersion, .. } if !dispersion.is_none() => Some((ior, dispersion)),
            _ => None,
        }
    }

    /// Whether rays may pass as if the surface were not there.
    pub fn has_holes(&self) -> bool {
        let least = least(&self.textures.opacity, self.opacity);
        self.opacity_cutoff.map_or(least < 1.0, |cutoff| least < cutoff)
    }

    /// Share of the light that meets the surface at texture coordinates `uv`, where the mesh's vertices have the opacity `of_vertices`, 1 without.
    pub fn opacity_at(&self, uv: Vec2, of_vertices: f32) -> f32 {
        let opacity =
            of_vertices * self.opacity * self.textures.opacity.as_ref().map_or(1.0, |texture| texture.number_at(uv));
        match self.opacity_cutoff {
            Some(cutoff) => f32::from(u8::from(opacity >= cutoff)),
            None => opacity,
        }
    }

    /// Whether some point of the surface shines: emission, its picture and opacity are above 0 somewhere.
    pub fn is_emissive(&self) -> bool {
        let brightest = self.textures.emission.as_ref().map_or(Vec3::ONE, |texture| texture.image.most().truncate());
        self.emission * brightest != Vec3::ZERO && most(&self.textures.opacity, self.opacity) > 0.0
    }

    fn least_roughness(&self, factor: f32) -> f32 {
        least(&self.textures.roughness, factor)
    }

    fn least_metallic(&self, factor: f32) -> f32 {
        least(&self.textures.metallic, factor)
    }
}

/// The greatest value that a number has on a surface.
fn most(texture: &Option<Texture>, factor: f32) -> f32 {
    factor * texture.as_ref().map_or(1.0, |texture| texture.image.most()[texture.channel])
}

/// The least value that a number has on a surface.
fn least(texture: &Option<Texture>, factor: f32) -> f32 {
    factor * texture.as_ref().map_or(1.0, |texture| texture.image.least()[texture.channel])
}
