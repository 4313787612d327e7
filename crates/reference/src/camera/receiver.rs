//! The lobes of a receiver, as a path from the eye meets it.

use glam::DVec3;

use crate::bsdf::{Base, Surface};
use crate::generator::Generator;
use crate::geometry::Facing;
use crate::warp;

/// A diffuse vertex of a path.
#[derive(Clone, Copy, Debug)]
pub(super) struct Receiver {
    surface: Surface,
    base: Base,
    facing: Facing,
    wo: DVec3,
    /// Share of the base's light that comes out toward wo; 1 where the path has entered the base already.
    out_of_base: DVec3,
    /// Whether the gloss is a lobe of this vertex.
    has_gloss: bool,
}

impl Receiver {
    /// None if the surface has no base. `whole`: the path has not chosen between gloss and base.
    pub(super) fn of(surface: Surface, facing: Facing, wo: DVec3, whole: bool) -> Option<Self> {
        let base = *surface.base()?;
        let out_of_base = if whole { surface.passed_to_base(wo.dot(facing.normal_shading)) } else { DVec3::ONE };
        let has_gloss = whole && surface.has_receiver_gloss();
        Some(Self { surface, base, facing, wo, out_of_base, has_gloss })
    }

    pub(super) fn facing(&self) -> &Facing {
        &self.facing
    }

    /// Radiance sent without regard to the lights, W/(m² sr).
    pub(super) fn ambient(&self) -> DVec3 {
        self.base.ambient
    }

    /// The BSDF toward light in plain sight times the cosine to the shading normal, 1/sr; zero from below the
    /// geometric one.
    pub(super) fn response(&self, wi: DVec3) -> DVec3 {
        let normal = self.facing.normal_shading;
        let cosine = wi.dot(normal);
        if cosine <= 0.0 || wi.dot(self.facing.normal_geometric) <= 0.0 {
            return DVec3::ZERO;
        }
        let base = self.out_of_base * self.surface.passed_to_base(cosine) * self.base.lambertian()
            + self.base.phong(wi, self.wo, normal);
        let gloss = if self.has_gloss { self.surface.gloss(&self.facing, self.wo, wi) } else { DVec3::ZERO };
        cosine * base + gloss
    }

    /// A direction in which the path goes on, and the BSDF times the cosine over its density: off the gloss with the
    /// probability of its reflectance, else drawn from the cosine. Phong's lobe sees direct light alone.
    pub(super) fn sample(&self, generator: &mut Generator) -> (DVec3, DVec3) {
        let normal = self.facing.normal_shading;
        let chance = if self.has_gloss { self.surface.chance_of_gloss(self.wo.dot(normal)) } else { 0.0 };
        if generator.unit() < chance {
            let reflected = self.surface.reflect_off_gloss(&self.facing, self.wo, [generator.unit(), generator.unit()]);
            return reflected.map_or((normal, DVec3::ZERO), |(wi, weight)| (wi, weight / chance));
        }
        let wi = warp::cosine_hemisphere(normal, generator.unit(), generator.unit());
        let is_above = wi.dot(self.facing.normal_geometric) > 0.0;
        let share = self.out_of_base * self.surface.passed_to_base(wi.dot(normal)) * self.base.albedo;
        (wi, if is_above { share / (1.0 - chance) } else { DVec3::ZERO })
    }
}
