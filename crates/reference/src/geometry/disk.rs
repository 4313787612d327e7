//! Disks: planar lights.

use glam::DVec3;

use super::Ray;

/// A disk in the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Disk {
    /// Centre, metres.
    pub center: DVec3,
    /// Unit normal of the front.
    pub normal: DVec3,
    /// Radius, metres.
    pub radius: f64,
}

impl Disk {
    /// The crossing farther than `epsilon` metres: its distance, and whether the ray comes from the front.
    pub fn meet(&self, ray: &Ray, epsilon: f64) -> Option<(f64, bool)> {
        let sink = -ray.direction.dot(self.normal);
        let distance = (ray.origin - self.center).dot(self.normal) / sink;
        let is_met = distance.is_finite()
            && distance > epsilon
            && ray.at(distance).distance_squared(self.center) <= self.radius * self.radius;
        is_met.then_some((distance, sink > 0.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn is_met_within_its_rim() {
        let disk = Disk { center: 2.0 * DVec3::Z, normal: -DVec3::Z, radius: 1.0 };
        let from = |x: f64| Ray { origin: DVec3::new(x, 0.0, 0.0), direction: DVec3::Z };
        assert_eq!(disk.meet(&from(0.99), 1e-9), Some((2.0, true)));
        assert_eq!(disk.meet(&from(1.01), 1e-9), None);
    }
}
