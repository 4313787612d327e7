//! Rectangles: planar lights.

use glam::DVec3;

use super::Ray;

/// A rectangle in the world, whose front is the side of `edge_u` × `edge_v`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rectangle {
    /// Centre, metres.
    pub center: DVec3,
    /// One whole edge, metres.
    pub edge_u: DVec3,
    /// The other, perpendicular to the first.
    pub edge_v: DVec3,
}

impl Rectangle {
    /// Unit normal of the front.
    pub fn normal(&self) -> DVec3 {
        self.edge_u.cross(self.edge_v).normalize()
    }

    /// m².
    pub fn area(&self) -> f64 {
        self.edge_u.cross(self.edge_v).length()
    }

    /// The point at shares (0 to 1) of the two edges.
    pub fn at(&self, u: f64, v: f64) -> DVec3 {
        self.center + (u - 0.5) * self.edge_u + (v - 0.5) * self.edge_v
    }

    /// The shares of the two edges at the foot of a point, within 0 to 1 over the rectangle.
    pub fn shares(&self, point: DVec3) -> [f64; 2] {
        let offset = point - self.center;
        [self.edge_u, self.edge_v].map(|edge| 0.5 + offset.dot(edge) / edge.length_squared())
    }

    /// The crossing farther than `epsilon` metres: its distance, and whether the ray comes from the front.
    pub fn meet(&self, ray: &Ray, epsilon: f64) -> Option<(f64, bool)> {
        let normal = self.normal();
        let sink = -ray.direction.dot(normal);
        let distance = (ray.origin - self.center).dot(normal) / sink;
        if !distance.is_finite() || distance <= epsilon {
            return None;
        }
        let shares = self.shares(ray.at(distance));
        shares.iter().all(|share| (0.0..=1.0).contains(share)).then_some((distance, sink > 0.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn is_met_within_its_edges_from_both_sides() {
        let rectangle = Rectangle { center: 2.0 * DVec3::Z, edge_u: 4.0 * DVec3::X, edge_v: 2.0 * DVec3::Y };
        let from = |x: f64, z: f64, dz: f64| Ray { origin: DVec3::new(x, 0.5, z), direction: dz * DVec3::Z };
        assert_eq!(rectangle.meet(&from(1.9, 0.0, 1.0), 1e-9), Some((2.0, false)));
        assert_eq!(rectangle.meet(&from(-1.9, 5.0, -1.0), 1e-9), Some((3.0, true)));
        assert_eq!(rectangle.meet(&from(2.1, 0.0, 1.0), 1e-9), None);
        assert_eq!(rectangle.meet(&from(0.0, 0.0, -1.0), 1e-9), None);
    }
}
