//! From the unit square to discs, directions and frames.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, TAU};

use glam::{DVec2, DVec3};

/// The unit square to the unit disc, keeping areas in proportion (Shirley and Chiu 1997).
pub fn disc(u: f64, v: f64) -> DVec2 {
    let (a, b) = (2.0 * u - 1.0, 2.0 * v - 1.0);
    if a == 0.0 && b == 0.0 {
        return DVec2::ZERO;
    }
    let (r, phi) = if a.abs() > b.abs() { (a, FRAC_PI_4 * (b / a)) } else { (b, FRAC_PI_2 - FRAC_PI_4 * (a / b)) };
    r * DVec2::from_angle(phi)
}

/// The point of the unit square that [`disc`] takes to a point of the unit disc.
pub fn disc_inverse(p: DVec2) -> [f64; 2] {
    let along = |main: f64, across: f64| {
        let r = p.length().copysign(main);
        (r, if main == 0.0 { 0.0 } else { r * (across / main).atan() / FRAC_PI_4 })
    };
    let (a, b) = if p.x.abs() > p.y.abs() {
        along(p.x, p.y)
    } else {
        let (b, a) = along(p.y, p.x);
        (a, b)
    };
    [0.5 * (a + 1.0), 0.5 * (b + 1.0)]
}

/// Two unit vectors that make a right-handed frame with the unit vector n (Duff et al. 2017).
pub fn frame(n: DVec3) -> [DVec3; 2] {
    let s = if n.z >= 0.0 { 1.0 } else { -1.0 };
    let a = -1.0 / (s + n.z);
    let b = n.x * n.y * a;
    [DVec3::new(1.0 + s * n.x * n.x * a, s * b, -s * n.x), DVec3::new(b, s + n.y * n.y * a, -n.y)]
}

/// A direction on the hemisphere about the unit vector n, of density cos θ/π per steradian (Malley's method).
pub fn cosine_hemisphere(n: DVec3, u: f64, v: f64) -> DVec3 {
    let p = disc(u, v);
    let [t1, t2] = frame(n);
    p.x * t1 + p.y * t2 + (1.0 - p.length_squared()).max(0.0).sqrt() * n
}

/// A direction in the cone about the unit vector `axis`, uniform in solid angle. `height` is 1 − cos of the cone's half
/// angle: the cone's solid angle is 2π · height.
pub fn cone(axis: DVec3, height: f64, u: f64, v: f64) -> DVec3 {
    let z = u * height;
    let (sin_phi, cos_phi) = (TAU * v).sin_cos();
    let [t1, t2] = frame(axis);
    (z * (2.0 - z)).sqrt() * (cos_phi * t1 + sin_phi * t2) + (1.0 - z) * axis
}

/// The point of the unit square that [`cone`] takes to a direction within it.
pub fn cone_inverse(axis: DVec3, height: f64, direction: DVec3) -> [f64; 2] {
    let [t1, t2] = frame(axis);
    let turn = direction.dot(t2).atan2(direction.dot(t1)) / TAU;
    [0.5 * (direction - axis).length_squared() / height, turn.rem_euclid(1.0)]
}

/// 1 − cos α of the cone of half angle α under which a sphere is seen, from R/D = sin α; no cancellation for small α.
pub fn cone_height(sin_alpha: f64) -> f64 {
    let sin_squared = sin_alpha * sin_alpha;
    sin_squared / (1.0 + (1.0 - sin_squared).max(0.0).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_are_orthonormal_and_right_handed() {
        for n in [DVec3::Z, -DVec3::Z, DVec3::X, DVec3::new(0.3, -0.8, -0.2).normalize(), DVec3::ONE.normalize()] {
            let [t1, t2] = frame(n);
            assert!(t1.dot(t2).abs() < 1e-15 && t1.dot(n).abs() < 1e-15);
            assert!(t1.cross(t2).distance(n) < 1e-15);
        }
    }

    #[test]
    fn disc_keeps_areas() {
        let steps = 400;
        let mut inside = 0;
        for i in 0..steps {
            for j in 0..steps {
                let p = disc((f64::from(i) + 0.5) / f64::from(steps), (f64::from(j) + 0.5) / f64::from(steps));
                assert!(p.length() <= 1.0);
                inside += i32::from(p.length() < 0.5);
            }
        }
        assert!((f64::from(inside) / f64::from(steps * steps) - 0.25).abs() < 1e-3);
        assert_eq!(disc(0.5, 0.5), DVec2::ZERO);
        assert!(disc(1.0, 0.5).distance(DVec2::X) < 1e-15 && disc(0.5, 1.0).distance(DVec2::Y) < 1e-15);
    }

    #[test]
    fn inverses_lead_back() {
        let axis = DVec3::new(1.0, 2.0, -2.0) / 3.0;
        for i in 0..40 {
            for j in 0..40 {
                let [u, v] = [i, j].map(|k| (f64::from(k) + 0.4) / 40.0);
                for back in [disc_inverse(disc(u, v)), cone_inverse(axis, 0.7, cone(axis, 0.7, u, v))] {
                    assert!((back[0] - u).abs() < 1e-12 && (back[1] - v).abs() < 1e-12, "{u}, {v}: {back:?}");
                }
            }
        }
        assert_eq!(disc_inverse(DVec2::ZERO), [0.5, 0.5]);
    }

    #[test]
    fn cone_fills_its_half_angle() {
        let axis = DVec3::new(1.0, 2.0, -2.0) / 3.0;
        let height = cone_height(0.5);
        assert!((height - (1.0 - 0.75f64.sqrt())).abs() < 1e-15);
        let rim = cone(axis, height, 1.0, 0.3);
        assert!((rim.dot(axis) - 0.75f64.sqrt()).abs() < 1e-15 && (rim.length() - 1.0).abs() < 1e-15);
    }
}
