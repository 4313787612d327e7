//! The GGX distribution of microfacet normals (Trowbridge and Reitz 1975; Walter et al. 2007). Vectors are in the frame
//! whose z axis is the surface's normal.

use std::f64::consts::{PI, TAU};

use glam::DVec3;

/// Isotropic GGX microfacets of width α.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Microfacets {
    alpha: f64,
}

impl Microfacets {
    /// α is the square of the roughness.
    pub fn of_roughness(roughness: f64) -> Self {
        Self { alpha: roughness * roughness }
    }

    /// D: microfacet area a unit of surface area and solid angle of normals, at cos θ of the normal, 1/sr.
    pub fn distribution(&self, cos: f64) -> f64 {
        let alpha_squared = self.alpha * self.alpha;
        let spread = cos * cos * (alpha_squared - 1.0) + 1.0;
        alpha_squared / (PI * spread * spread)
    }

    /// Smith's Λ of a direction, of either side, at |cos θ|.
    pub fn lambda(&self, cos: f64) -> f64 {
        let tan_squared = (1.0 - cos * cos).max(0.0) / (cos * cos);
        0.5 * ((1.0 + self.alpha * self.alpha * tan_squared).sqrt() - 1.0)
    }

    /// Share of the microfacets turned to a direction that it sees.
    pub fn masking(&self, cos: f64) -> f64 {
        1.0 / (1.0 + self.lambda(cos))
    }

    /// Share that is seen from both directions, which know of each other by the height (Heitz 2014).
    pub fn masking_shadowing(&self, cos_o: f64, cos_i: f64) -> f64 {
        1.0 / (1.0 + self.lambda(cos_o) + self.lambda(cos_i))
    }

    /// A normal of density `masking` · (wo·m) D(m)/cos θo, 1/sr: those visible from wo (Heitz 2018).
    pub fn visible_normal(&self, wo: DVec3, v: [f64; 2]) -> DVec3 {
        let stretch = DVec3::new(self.alpha, self.alpha, 1.0);
        let view = (stretch * wo).normalize();
        let across = view.x.hypot(view.y);
        let t1 = if across > 0.0 { DVec3::new(-view.y, view.x, 0.0) / across } else { DVec3::X };
        let t2 = view.cross(t1);
        let (sin, cos) = (TAU * v[1]).sin_cos();
        let (p, q0) = (v[0].sqrt() * cos, v[0].sqrt() * sin);
        let s = 0.5 * (1.0 + view.z);
        let q = (1.0 - s) * (1.0 - p * p).max(0.0).sqrt() + s * q0;
        let n = p * t1 + q * t2 + (1.0 - p * p - q * q).max(0.0).sqrt() * view;
        DVec3::new(self.alpha * n.x, self.alpha * n.y, n.z.max(0.0)).normalize()
    }

    /// Density of [`visible_normal`](Self::visible_normal), 1/sr.
    pub fn visible_density(&self, wo: DVec3, m: DVec3) -> f64 {
        self.masking(wo.z) * wo.dot(m).max(0.0) * self.distribution(m.z) / wo.z
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::generator::Generator;

    /// Bins in cos θ and φ.
    const BINS: [usize; 2] = [24, 16];

    fn direction(cos: f64, phi: f64) -> DVec3 {
        let sin = (1.0 - cos * cos).sqrt();
        DVec3::new(sin * phi.cos(), sin * phi.sin(), cos)
    }

    /// Integral of the density over a bin, by midpoints.
    fn expected(microfacets: &Microfacets, wo: DVec3, bin: [usize; 2]) -> f64 {
        let steps = 24;
        let sub = |k: usize, step: usize, bins: usize| (k as f64 + (step as f64 + 0.5) / steps as f64) / bins as f64;
        let cell = TAU / (BINS[0] * BINS[1] * steps * steps) as f64;
        (0..steps * steps)
            .map(|i| direction(sub(bin[0], i / steps, BINS[0]), TAU * sub(bin[1], i % steps, BINS[1])))
            .map(|m| microfacets.visible_density(wo, m) * cell)
            .sum()
    }

    #[test]
    fn visible_normals_follow_their_density() {
        for (roughness, cos) in [(0.5, 0.9), (0.7, 0.4), (1.0, 0.1), (0.9, 1.0)] {
            let microfacets = Microfacets::of_roughness(roughness);
            let wo = direction(cos, 0.7);
            let count = 400_000;
            let mut generator = Generator::new(&[31]);
            let mut found = vec![0.0; BINS[0] * BINS[1]];
            for _ in 0..count {
                let m = microfacets.visible_normal(wo, [generator.unit(), generator.unit()]);
                let row = ((m.z * BINS[0] as f64) as usize).min(BINS[0] - 1);
                let turn = (m.y.atan2(m.x) / TAU).rem_euclid(1.0);
                found[row * BINS[1] + ((turn * BINS[1] as f64) as usize).min(BINS[1] - 1)] += 1.0;
            }
            let (mut chi_squared, mut bins, mut total) = (0.0, 0.0, 0.0);
            for (bin, found) in found.iter().enumerate() {
                let share = expected(&microfacets, wo, [bin / BINS[1], bin % BINS[1]]);
                total += share;
                let mean = share * f64::from(count);
                if mean > 20.0 {
                    chi_squared += (found - mean).powi(2) / mean;
                    bins += 1.0;
                }
            }
            assert!((total - 1.0).abs() < 2e-3, "the density integrates to {total}");
            assert!(bins > 40.0 && (chi_squared - bins) / (2.0 * bins).sqrt() < 5.0, "χ² {chi_squared} of {bins} bins");
        }
    }

    #[test]
    fn distribution_is_normalised_to_projected_area() {
        let steps = 20_000;
        for roughness in [0.3, 0.6, 1.0] {
            let microfacets = Microfacets::of_roughness(roughness);
            let at = |i: i32| (f64::from(i) + 0.5) / f64::from(steps);
            let area: f64 = (0..steps).map(|i| TAU * microfacets.distribution(at(i)) * at(i) / f64::from(steps)).sum();
            assert!((area - 1.0).abs() < 1e-4, "{area}");
        }
    }
}
