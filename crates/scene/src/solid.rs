//! The volume that a closed mesh encloses.

use glam::{DVec3, Vec3};

use crate::Mesh;

/// A triangle counts as having no area when its height is less than this share of its longest edge: below it, single
/// precision cannot tell it from a line.
const DEGENERATE_HEIGHT: f64 = 1e-7;

impl Mesh {
    /// The number of triangles whose area is zero to single precision.
    ///
    /// # Panics
    /// If a vertex index is out of range; a validated mesh has none that is.
    pub fn degenerate_triangles(&self) -> usize {
        (0..self.triangles.len()).filter(|&triangle| is_degenerate(self.corners(triangle))).count()
    }

    /// The volume enclosed by a closed mesh, m³; negative if its triangles face inwards.
    ///
    /// # Panics
    /// If a vertex index is out of range; a validated mesh has none that is.
    pub fn signed_volume(&self) -> f64 {
        let origin = self.positions.first().copied().unwrap_or_default().as_dvec3();
        self.triangles_from(origin).map(|[a, b, c]| a.dot(b.cross(c)) / 6.0).sum()
    }

    /// How often the surface winds around a point of the object frame: 1 inside a closed mesh, 0 outside, between them
    /// for a mesh with holes (the generalised winding number of Jacobson et al. 2013; solid angles after Van Oosterom
    /// and Strackee 1983, equation 8).
    ///
    /// # Panics
    /// If a vertex index is out of range; a validated mesh has none that is.
    pub fn winding_number(&self, point: Vec3) -> f64 {
        let solid_angle: f64 = self
            .triangles_from(point.as_dvec3())
            .map(|[a, b, c]| {
                let (la, lb, lc) = (a.length(), b.length(), c.length());
                let denominator = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
                2.0 * a.dot(b.cross(c)).atan2(denominator)
            })
            .sum();
        solid_angle / (4.0 * std::f64::consts::PI)
    }

    /// The corners of each triangle, relative to an origin, in double precision.
    fn triangles_from(&self, origin: DVec3) -> impl Iterator<Item = [DVec3; 3]> + '_ {
        (0..self.triangles.len()).map(move |triangle| self.corners(triangle).map(|p| p.as_dvec3() - origin))
    }
}

fn is_degenerate(corners: [Vec3; 3]) -> bool {
    let [a, b, c] = corners.map(Vec3::as_dvec3);
    let longest_squared = (b - a).length_squared().max((c - b).length_squared()).max((a - c).length_squared());
    (b - a).cross(c - a).length() <= DEGENERATE_HEIGHT * longest_squared
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn winding_tells_inside_from_outside() {
        let mesh = Mesh::cuboid(Vec3::splat(-1.0), Vec3::ONE);
        assert!((mesh.winding_number(Vec3::new(0.9, -0.9, 0.3)) - 1.0).abs() < 1e-9);
        assert!(mesh.winding_number(Vec3::new(1.1, 0.0, 0.0)).abs() < 1e-9);
        assert!((mesh.signed_volume() - 8.0).abs() < 1e-9);
    }

    #[test]
    fn degenerate_triangles_are_counted() {
        let mesh = Mesh {
            positions: vec![Vec3::ZERO, Vec3::X, Vec3::new(0.3, 0.0, 0.0), Vec3::new(0.5, 1e-5, 0.0)],
            triangles: vec![[0, 1, 2], [0, 0, 1], [0, 1, 3]],
            ..Mesh::default()
        };
        assert_eq!(mesh.degenerate_triangles(), 2);
    }
}
