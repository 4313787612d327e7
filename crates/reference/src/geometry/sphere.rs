//! Spheres: the lights.

use glam::DVec3;

use super::Ray;

/// A sphere in the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere {
    /// Centre, metres.
    pub center: DVec3,
    /// Radius, metres.
    pub radius: f64,
}

impl Sphere {
    /// The nearest crossing farther than `epsilon` metres: its distance, and whether the ray enters there.
    pub fn meet(&self, ray: &Ray, epsilon: f64) -> Option<(f64, bool)> {
        let to_center = self.center - ray.origin;
        let closest = to_center.dot(ray.direction);
        // From the perpendicular rather than b² − c, which cancels for a small sphere far away.
        let perpendicular = to_center - closest * ray.direction;
        let discriminant = self.radius * self.radius - perpendicular.length_squared();
        if discriminant < 0.0 {
            return None;
        }
        let half_chord = discriminant.sqrt();
        let (near, far) = (closest - half_chord, closest + half_chord);
        if near > epsilon {
            Some((near, true))
        } else if far > epsilon {
            Some((far, false))
        } else {
            None
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn enters_from_outside_and_leaves_from_inside() {
        let sphere = Sphere { center: DVec3::new(0.0, 0.0, 5.0), radius: 2.0 };
        let from = |z| Ray { origin: DVec3::new(0.0, 0.0, z), direction: DVec3::Z };
        assert_eq!(sphere.meet(&from(0.0), 1e-9), Some((3.0, true)));
        assert_eq!(sphere.meet(&from(5.0), 1e-9), Some((2.0, false)));
        assert_eq!(sphere.meet(&from(8.0), 1e-9), None);
    }

    #[test]
    fn grazing_ray_passes_by() {
        let sphere = Sphere { center: DVec3::new(0.0, 2.0 + 1e-9, 5.0), radius: 2.0 };
        assert_eq!(sphere.meet(&Ray { origin: DVec3::ZERO, direction: DVec3::Z }, 1e-9), None);
    }
}
