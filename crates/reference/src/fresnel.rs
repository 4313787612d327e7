//! Reflectance of a smooth boundary between dielectrics.

use crate::snell::cos_transmitted;

/// The share of unpolarised light that is reflected, (r_s² + r_p²)/2 by Fresnel's equations, at cos θi on the side that
/// the light comes from. `eta` = index on that side / index on the other. 1 on total internal reflection.
pub fn reflectance(cos_i: f64, eta: f64) -> f64 {
    let Some(cos_t) = cos_transmitted(cos_i, eta) else { return 1.0 };
    let r_s = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
    let r_p = (cos_i - eta * cos_t) / (cos_i + eta * cos_t);
    0.5 * (r_s * r_s + r_p * r_p)
}

#[cfg(test)]
mod tests {
    use super::*;

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
