//! Reflectance of smooth boundaries.

use glam::DVec3;

use crate::snell::cos_transmitted;

/// Panels of Simpson's rule over the hemisphere.
const PANELS: u32 = 1024;

/// The share of unpolarised light that is reflected, (r_s² + r_p²)/2 by Fresnel's equations, at cos θi on the side that
/// the light comes from. `eta` = index on that side / index on the other. 1 on total internal reflection.
pub fn reflectance(cos_i: f64, eta: f64) -> f64 {
    let Some(cos_t) = cos_transmitted(cos_i, eta) else { return 1.0 };
    let r_s = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
    let r_p = (cos_i - eta * cos_t) / (cos_i + eta * cos_t);
    0.5 * (r_s * r_s + r_p * r_p)
}

/// The share of unpolarised light that a conductor of index n + ik, relative to the medium around it, reflects at cos θ:
/// Fresnel's equations, exact.
pub fn conductor(cos: f64, n: f64, k: f64) -> f64 {
    let (c, s) = (cos * cos, 1.0 - cos * cos);
    let real = n * n - k * k - s;
    let sum = (real * real + 4.0 * n * n * k * k).sqrt();
    let a = (0.5 * (sum + real)).max(0.0).sqrt();
    let r_s = (sum - 2.0 * a * cos + c) / (sum + 2.0 * a * cos + c);
    let r_p = r_s * (c * sum - 2.0 * a * cos * s + s * s) / (c * sum + 2.0 * a * cos * s + s * s);
    0.5 * (r_s + r_p)
}

/// Schlick's approximation from the reflectance f₀ at normal incidence (Schlick 1994).
pub fn schlick(cos: f64, f0: DVec3) -> DVec3 {
    f0 + (1.0 - f0) * (1.0 - cos).powi(5)
}

/// The share of a dielectric's diffuse illumination that it reflects, 2∫F(μ)μ dμ over 0 … 1, `eta` as in
/// [`reflectance`].
pub fn diffuse_reflectance(eta: f64) -> f64 {
    let step = 1.0 / f64::from(PANELS);
    let at = |mu: f64| 2.0 * mu * reflectance(mu, eta);
    let simpson = |panel: u32| {
        let first = f64::from(panel) * step;
        step / 6.0 * (at(first) + 4.0 * at(first + 0.5 * step) + at(first + step))
    };
    (0..PANELS).map(simpson).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn conductor_at_normal_incidence() {
        // Gold at 650 nm and at 450 nm: ((n − 1)² + k²)/((n + 1)² + k²).
        for (n, k) in [(0.156, 3.80), (1.381, 1.916), (2.0, 0.0f64)] {
            let expected = ((n - 1.0f64).powi(2) + k * k) / ((n + 1.0).powi(2) + k * k);
            assert!((conductor(1.0, n, k) - expected).abs() < 1e-14);
        }
        assert!((conductor(0.0, 0.2, 3.0) - 1.0).abs() < 1e-14);
    }

    #[test]
    fn conductor_without_extinction_is_a_dielectric() {
        for cos in [0.05, 0.3, 0.8, 1.0] {
            assert!((conductor(cos, 1.5, 0.0) - reflectance(cos, 1.0 / 1.5)).abs() < 1e-14);
            assert!((conductor(cos, 1.0 / 1.5, 0.0) - reflectance(cos, 1.5)).abs() < 1e-12);
        }
    }

    #[test]
    fn diffuse_light_on_glass() {
        // Duntley 1942, for n = 1.5.
        assert!((diffuse_reflectance(1.0 / 1.5) - 0.0918).abs() < 1e-4);
        // Reciprocity: 1 − F_in = (1 − F_ex)/n².
        let inside = 1.0 - (1.0 - diffuse_reflectance(1.0 / 1.5)) / 2.25;
        assert!((diffuse_reflectance(1.5) - inside).abs() < 1e-4);
    }

    fn at(degrees: f64, eta: f64) -> f64 {
        reflectance(degrees.to_radians().cos(), eta)
    }

    #[test]
    fn table() {
        let expected = [(0.0, 0.0400), (30.0, 0.0415), (45.0, 0.0502), (60.0, 0.0892), (75.0, 0.2531), (85.0, 0.6128)];
        for (degrees, share) in expected {
            assert!((at(degrees, 1.0 / 1.5) - share).abs() < 5.1e-5, "{degrees}°: {}", at(degrees, 1.0 / 1.5));
        }
    }

    #[test]
    fn only_one_polarisation_comes_back_at_brewsters_angle() {
        let brewster = 1.5f64.atan();
        assert!((brewster.to_degrees() - 56.31).abs() < 5e-3);
        // r_p = 0, and r_s = cos² θ_B − sin² θ_B.
        let r_s = (2.0 * brewster).cos();
        assert!((reflectance(brewster.cos(), 1.0 / 1.5) - 0.5 * r_s * r_s).abs() < 1e-15);
    }

    #[test]
    fn total_internal_reflection() {
        assert!(at(41.80, 1.5) < 1.0);
        assert_eq!(at(41.82, 1.5), 1.0);
        assert_eq!(at(89.0, 1.5), 1.0);
    }

    #[test]
    fn same_from_both_sides() {
        for degrees in [0.0, 20.0, 50.0, 80.0] {
            let cos_i = f64::to_radians(degrees).cos();
            let cos_t = cos_transmitted(cos_i, 1.0 / 1.5).expect("light always enters the denser side");
            assert!((reflectance(cos_i, 1.0 / 1.5) - reflectance(cos_t, 1.5)).abs() < 1e-14);
        }
    }

    #[test]
    fn nothing_from_equal_indices() {
        assert!(at(0.0, 1.0) == 0.0 && at(89.0, 1.0) < 1e-25);
    }
}
