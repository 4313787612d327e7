//! Directions after reflection and refraction.

use glam::DVec3;

/// The direction of flight after reflection of the direction of flight d at a surface of unit normal n.
pub fn reflect(d: DVec3, n: DVec3) -> DVec3 {
    d - 2.0 * d.dot(n) * n
}

/// The direction of flight after refraction of d at a surface whose unit normal n looks to the side that d comes from;
/// none on total internal reflection. `eta` = index on that side / index on the other: sin θt = η sin θi.
pub fn refract(d: DVec3, n: DVec3, eta: f64) -> Option<DVec3> {
    let cos_i = -d.dot(n);
    let cos_t = cos_transmitted(cos_i, eta)?;
    Some(eta * d + (eta * cos_i - cos_t) * n)
}

/// cos θt from cos θi and η as in [`refract`]; none on total internal reflection.
pub fn cos_transmitted(cos_i: f64, eta: f64) -> Option<f64> {
    let sin_squared = eta * eta * (1.0 - cos_i * cos_i).max(0.0);
    (sin_squared < 1.0).then(|| (1.0 - sin_squared).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn incident(degrees: f64) -> DVec3 {
        let (sin, cos) = degrees.to_radians().sin_cos();
        DVec3::new(sin, 0.0, -cos)
    }

    #[test]
    fn reflection_keeps_the_angle() {
        assert!(reflect(incident(30.0), DVec3::Z).distance(DVec3::new(0.5, 0.0, 0.75f64.sqrt())) < 1e-15);
    }

    #[test]
    fn sines_are_in_the_ratio_of_the_indices() {
        for degrees in [0.0, 10.0, 45.0, 80.0, 89.9] {
            let t = refract(incident(degrees), DVec3::Z, 1.0 / 1.5).expect("light always enters the denser side");
            assert!((t.x * 1.5 - degrees.to_radians().sin()).abs() < 1e-15);
            assert!((t.length() - 1.0).abs() < 1e-15 && t.z < 0.0);
            let back = refract(t, DVec3::Z, 1.5).expect("the way back is open");
            assert!(back.distance(incident(degrees)) < 1e-12);
        }
    }

    #[test]
    fn slab_shifts_a_ray_as_tabulated() {
        for (degrees, shift) in [(30.0, 0.1938), (45.0, 0.3291), (60.0, 0.5125)] {
            let d = incident(degrees);
            let t = refract(d, DVec3::Z, 1.0 / 1.5).expect("light always enters the denser side");
            let through = t / -t.z;
            assert!((through.cross(d).length() - shift).abs() < 6e-5);
        }
    }

    #[test]
    fn minimum_deviation_of_a_bk7_prism() {
        // The apex is up, and light inside runs along +x. Normals of the faces look back at the light.
        let (sin, cos) = 30f64.to_radians().sin_cos();
        let (entrance, exit) = (DVec3::new(-cos, 0.0, sin), DVec3::new(-cos, 0.0, -sin));
        for (index, degrees) in [(1.516_800, 38.647), (1.522_376, 39.138), (1.514_322, 38.429f64)] {
            let (rise, run) = (0.5 * degrees.to_radians()).sin_cos();
            let d = DVec3::new(run, 0.0, rise);
            let inside = refract(d, entrance, 1.0 / index).expect("light always enters the denser side");
            let out = refract(inside, exit, index).expect("minimum deviation is under the critical angle");
            assert!((d.angle_between(out).to_degrees() - degrees).abs() < 1e-3);
        }
    }

    #[test]
    fn critical_angle() {
        for (index, degrees) in [(1.5, 41.81), (1.333, 48.61)] {
            assert!(refract(incident(degrees - 0.01), DVec3::Z, index).is_some());
            assert_eq!(refract(incident(degrees + 0.01), DVec3::Z, index), None);
        }
    }
}
