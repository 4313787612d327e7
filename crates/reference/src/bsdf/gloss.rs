//! The specular lobe of rough surfaces toward a given direction.

use glam::DVec3;

use crate::geometry::Facing;
use crate::snell::reflect;

use super::microfacet::Microfacets;
use super::{Specular, Surface};

impl Surface {
    /// The BSDF of the specular lobe for radiance times |cos θi|, 1/sr; zero on smooth surfaces, whose lobe has no
    /// width.
    pub fn gloss(&self, facing: &Facing, wo: DVec3, wi: DVec3) -> DVec3 {
        let Some(microfacets) = self.microfacets else { return DVec3::ZERO };
        let (side_s, side_g) = (wi.dot(facing.normal_shading), wi.dot(facing.normal_geometric));
        match self.specular {
            _ if side_s > 0.0 && side_g > 0.0 => self.glossy_reflection(&microfacets, facing.normal_shading, wo, wi),
            Specular::Dielectric { eta, tint } if side_s < 0.0 && side_g < 0.0 => {
                tint * self.glossy_transmission(&microfacets, facing.normal_shading, wo, wi, eta)
            }
            // As much spread as what is reflected, on the other side.
            Specular::ThinWalled { tint, .. } if side_s < 0.0 && side_g < 0.0 => {
                let n = facing.normal_shading;
                let mirrored = reflect(wi, n);
                let m = (wo + mirrored).normalize();
                let passed = 1.0 - self.reflectance(wo.dot(m));
                tint * passed * facets(&microfacets, n, wo, mirrored)
            }
            _ => DVec3::ZERO,
        }
    }

    fn glossy_reflection(&self, microfacets: &Microfacets, n: DVec3, wo: DVec3, wi: DVec3) -> DVec3 {
        let m = (wo + wi).normalize();
        facets(microfacets, n, wo, wi) * self.reflectance(wo.dot(m))
    }

    /// Walter et al. 2007, equation 21, with η² for radiance.
    fn glossy_transmission(&self, microfacets: &Microfacets, n: DVec3, wo: DVec3, wi: DVec3, eta: f64) -> DVec3 {
        let toward = eta * wo + wi;
        let m = toward.dot(n).signum() * toward.normalize_or_zero();
        let (o, i) = (wo.dot(m), wi.dot(m));
        if o <= 0.0 || i >= 0.0 {
            return DVec3::ZERO;
        }
        let (cos_o, cos_i) = (wo.dot(n), -wi.dot(n));
        let facets = microfacets.distribution(m.dot(n)) * microfacets.masking_shadowing(cos_o, cos_i);
        let jacobian = o * -i / (cos_o * (eta * o + i).powi(2));
        eta * eta * facets * jacobian * (1.0 - self.reflectance(o))
    }
}

/// Reflection by microfacets that reflect everything, times |cos θi|, 1/sr.
fn facets(microfacets: &Microfacets, n: DVec3, wo: DVec3, wi: DVec3) -> f64 {
    let (m, cos_o, cos_i) = ((wo + wi).normalize(), wo.dot(n), wi.dot(n));
    microfacets.distribution(m.dot(n)) * microfacets.masking_shadowing(cos_o, cos_i) / (4.0 * cos_o)
}
