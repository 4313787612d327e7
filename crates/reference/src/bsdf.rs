//! What a surface does to light, as `docs/materials.md` defines it. Directions `wo` and `wi` point away from the surface;
//! wo is on the side of the normals of the [`Facing`].

mod base;
mod gloss;
pub mod microfacet;
mod prepared;
mod scatter;

use diacaustic_scene::{Material, MaterialKind, SMOOTH};
use glam::{DVec3, Vec3};

use crate::fresnel;
use crate::geometry::{Facing, Hit, World};
use crate::media::Media;
use crate::spectrum::Spectrum;

pub use self::base::Base;
pub(crate) use self::prepared::{Factors, PreparedMaterial};
pub(crate) use self::scatter::SHADING_NORMAL_LIMIT;
pub use self::scatter::{Draw, Outcome, Scattered};

use self::microfacet::Microfacets;

/// What a ray meets at a triangle.
#[derive(Clone, Copy, Debug)]
#[expect(clippy::large_enum_variant, reason = "one lives at a time")]
pub enum Crossing {
    /// A boundary that does not exist: the ray goes straight on with this list.
    Nothing(Media),
    /// A surface, with the list of a ray that is transmitted.
    Surface(Surface, Media),
}

impl Crossing {
    /// Whether light without a wavelength takes one at what a ray within `media` meets, before it is asked [what that
    /// is](Self::of).
    pub fn disperses(world: &World, hit: &Hit, facing: &Facing, media: Media) -> bool {
        let beyond = Self::beyond(world, hit, facing, media);
        world.dielectrics().disperse_between(&media, &beyond)
    }

    /// What a ray within `media` meets.
    pub fn of(world: &World, hit: &Hit, facing: &Facing, media: Media, spectrum: Spectrum) -> Self {
        let beyond = Self::beyond(world, hit, facing, media);
        let prepared = world.prepared_at(hit);
        let is_dielectric = matches!(prepared.material.kind, MaterialKind::Dielectric { .. });
        if is_dielectric && beyond.filling() == media.filling() {
            return Self::Nothing(beyond);
        }
        let ior = [&media, &beyond].map(|media| world.dielectrics().ior(media, &spectrum));
        let ambient = world.scene().ambient.as_dvec3();
        Self::Surface(Surface::at_point(prepared, &world.factors(hit), ambient, ior, spectrum), beyond)
    }

    /// The list of a ray that crosses the triangle. What a dielectric is blended with bounds nothing.
    fn beyond(world: &World, hit: &Hit, facing: &Facing, media: Media) -> Media {
        match hit.takes_rest {
            true => media,
            false => world.dielectrics().beyond(media, world.material_index(hit.triangle), facing.front),
        }
    }
}

/// A surface's lobes, between the media on its two sides.
#[derive(Clone, Copy, Debug)]
pub struct Surface {
    /// The light that it is for.
    spectrum: Spectrum,
    specular: Specular,
    microfacets: Option<Microfacets>,
    base: Option<Base>,
    is_caster: bool,
}

/// The specular lobe. `eta` is the index of refraction on the side of wo over that of the other; n + ik are relative to
/// the medium. Reflectances stay red, green and blue for light of one wavelength, as choices take the mean of these; a
/// tint is that for the light.
#[derive(Clone, Copy, Debug)]
enum Specular {
    None,
    Mirror { reflectance: DVec3 },
    Conductor { n: DVec3, k: DVec3 },
    Dielectric { eta: f64, tint: DVec3 },
    ThinWalled { eta: f64, tint: DVec3 },
    Coat { eta: f64 },
    Schlick { f0: DVec3 },
}

impl Specular {
    /// The lobe of a material at a point between two indices of refraction, and the material's roughness.
    fn of(
        prepared: &PreparedMaterial,
        factors: &Factors,
        [ior, ior_beyond]: [f64; 2],
        spectrum: &Spectrum,
    ) -> (Self, f32) {
        let colored = |color: Vec3| color.as_dvec3() * factors.color;
        let tinted = |tint: Vec3| spectrum.color(colored(tint));
        match prepared.material.kind {
            MaterialKind::Diffuse { .. } | MaterialKind::Phong { .. } => (Self::None, 0.0),
            MaterialKind::Mirror { reflectance } => (Self::Mirror { reflectance: colored(reflectance) }, 0.0),
            MaterialKind::Conductor { eta, k, roughness } => {
                (Self::Conductor { n: eta.as_dvec3() / ior, k: k.as_dvec3() / ior }, roughness)
            }
            MaterialKind::Dielectric { tint, roughness, .. } => {
                (Self::Dielectric { eta: ior / ior_beyond, tint: tinted(tint) }, roughness)
            }
            MaterialKind::ThinWalled { ior: own, tint, roughness } => {
                (Self::ThinWalled { eta: ior / f64::from(own), tint: tinted(tint) }, roughness)
            }
            MaterialKind::Coated { ior: own, roughness, .. } => (Self::Coat { eta: ior / f64::from(own) }, roughness),
            MaterialKind::MetallicRoughness { base_color, reflectance, metallic, roughness } => {
                let f0 = base::metallic_f0(colored(base_color), f64::from(metallic) * factors.metallic, reflectance);
                (Self::Schlick { f0 }, roughness)
            }
        }
    }

    /// Share of red, green and blue light that is reflected at cos θ to the microfacet's normal.
    fn fresnel(&self, cos: f64) -> DVec3 {
        match *self {
            Self::None => DVec3::ZERO,
            Self::Mirror { reflectance } => reflectance,
            Self::Conductor { n, k } => {
                DVec3::from_array(std::array::from_fn(|channel| fresnel::conductor(cos, n[channel], k[channel])))
            }
            Self::Dielectric { eta, .. } | Self::Coat { eta } => DVec3::splat(fresnel::reflectance(cos, eta)),
            Self::ThinWalled { eta, .. } => {
                let f = fresnel::reflectance(cos, eta);
                DVec3::splat(2.0 * f / (1.0 + f))
            }
            Self::Schlick { f0 } => fresnel::schlick(cos, f0),
        }
    }
}

impl Surface {
    /// The surface of a material, but for its pictures, between two indices of refraction: on the side of wo and beyond.
    /// Materials other than dielectrics have the same on both sides. `ambient` is the scene's radiance of that name,
    /// W/(m² sr). It is for light of all wavelengths.
    pub fn new(material: &Material, ambient: DVec3, ior: f64, ior_beyond: f64) -> Self {
        let prepared = PreparedMaterial::new(material);
        Self::at_point(&prepared, &Factors::ONE, ambient, [ior, ior_beyond], Spectrum::Whole)
    }

    /// The surface at a point where the pictures have these factors.
    fn at_point(
        prepared: &PreparedMaterial,
        factors: &Factors,
        ambient: DVec3,
        [ior, ior_beyond]: [f64; 2],
        spectrum: Spectrum,
    ) -> Self {
        let (specular, roughness) = Specular::of(prepared, factors, [ior, ior_beyond], &spectrum);
        let roughness = f64::from(roughness) * factors.roughness;
        Self {
            spectrum,
            specular,
            microfacets: (roughness >= f64::from(SMOOTH)).then(|| Microfacets::of_roughness(roughness)),
            base: Base::of(prepared, factors, ambient, &spectrum),
            is_caster: prepared.is_caster,
        }
    }

    /// Whether its specular lobe sends light on as a caster does.
    pub fn is_caster(&self) -> bool {
        self.is_caster
    }

    /// What is left under the specular lobe.
    pub fn base(&self) -> Option<&Base> {
        self.base.as_ref()
    }

    /// Whether the specular lobe is spread out, so that light from a single direction shows.
    pub fn is_rough(&self) -> bool {
        self.microfacets.is_some()
    }

    /// Whether it has a spread specular lobe that belongs to the receiver.
    pub fn has_receiver_gloss(&self) -> bool {
        !self.is_caster && self.is_rough()
    }

    /// T(w), the share of light along w that passes between the base and the open, at w·n_s.
    pub fn passed_to_base(&self, cos: f64) -> DVec3 {
        1.0 - self.reflectance(cos)
    }

    /// Share of the light that is reflected at cos θ to the microfacet's normal.
    fn reflectance(&self, cos: f64) -> DVec3 {
        self.spectrum.color(self.specular.fresnel(cos))
    }
}
