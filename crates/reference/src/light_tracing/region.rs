//! Where light is counted.

use glam::DVec3;

use crate::geometry::Rectangle;

/// How far from the rectangle's plane a point may lie, against the longer edge: scenes are single precision.
const PLANE_TOLERANCE: f64 = 1e-5;

/// A rectangle in space, in bins. It counts what lands on receivers within it, on its front, the side of `edge_u` ×
/// `edge_v`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Region {
    /// Centre, metres.
    pub center: DVec3,
    /// One whole edge, metres.
    pub edge_u: DVec3,
    /// The other, perpendicular to the first.
    pub edge_v: DVec3,
    /// Bins along `edge_u`.
    pub columns: usize,
    /// Bins along `edge_v`.
    pub rows: usize,
}

impl Region {
    fn rectangle(&self) -> Rectangle {
        Rectangle { center: self.center, edge_u: self.edge_u, edge_v: self.edge_v }
    }

    /// The number of bins.
    pub fn bins(&self) -> usize {
        self.columns * self.rows
    }

    /// Area of a bin, m².
    pub fn bin_area(&self) -> f64 {
        self.rectangle().area() / self.bins() as f64
    }

    /// The middle of a bin, metres.
    pub fn bin_center(&self, bin: usize) -> DVec3 {
        let share = |index: usize, count: usize| (index as f64 + 0.5) / count as f64;
        self.rectangle().at(share(bin % self.columns, self.columns), share(bin / self.columns, self.rows))
    }

    /// The bin in which light of this direction of flight lands at a point.
    pub(super) fn bin_of(&self, point: DVec3, direction: DVec3) -> Option<usize> {
        let rectangle = self.rectangle();
        let normal = rectangle.normal();
        let tolerance = PLANE_TOLERANCE * self.edge_u.length().max(self.edge_v.length());
        if direction.dot(normal) >= 0.0 || (point - self.center).dot(normal).abs() > tolerance {
            return None;
        }
        let [u, v] = rectangle.shares(point);
        let is_within = (0.0..1.0).contains(&u) && (0.0..1.0).contains(&v);
        is_within.then(|| (v * self.rows as f64) as usize * self.columns + (u * self.columns as f64) as usize)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bins_lie_in_rows_on_the_front() {
        let region = Region { center: DVec3::Y, edge_u: 4.0 * DVec3::X, edge_v: -2.0 * DVec3::Z, columns: 4, rows: 2 };
        for bin in 0..8 {
            assert_eq!(region.bin_of(region.bin_center(bin), -DVec3::Y), Some(bin));
        }
        let center = region.bin_center(5);
        assert!(center.distance(DVec3::new(-0.5, 1.0, -0.5)) < 1e-15);
        assert_eq!(region.bin_of(center, DVec3::Y), None);
        assert_eq!(region.bin_of(center + 0.01 * DVec3::Y, -DVec3::Y), None);
        assert_eq!(region.bin_of(center + 3.0 * DVec3::X, -DVec3::Y), None);
        assert_eq!(region.bin_area(), 1.0);
    }
}
