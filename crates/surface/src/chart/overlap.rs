//! Overlap of triangles in a plane.

use glam::DVec2;
use rayon::prelude::*;

use crate::box_tree::{BoxTree, around};

/// Boxes of triangles over a place, in the mean, from which on it takes too long to compare triangles with all that are near: in fans of
/// slivers.
pub(super) const MANY_BOXES: f64 = 64.0;

/// Triangles of a plane, found by place.
pub(super) struct FlatTriangles {
    pub corners: Vec<[DVec2; 3]>,
    /// The boxes around them.
    tree: BoxTree<DVec2>,
}

/// Lower and upper corner.
type Box2 = (DVec2, DVec2);

impl FlatTriangles {
    pub(super) fn new(corners: Vec<[DVec2; 3]>) -> Self {
        let (low, high) = around(corners.iter().map(bounds));
        let scale = f64::from(u32::MAX) / (high - low).max_element().max(f64::MIN_POSITIVE);
        let place = |[a, b, c]: &[DVec2; 3]| z_order(((*a + *b + *c) / 3.0 - low) * scale);
        let places: Vec<u64> = corners.par_iter().map(place).collect();
        let tree = BoxTree::new(&places, |number| bounds(&corners[number]));
        Self { corners, tree }
    }

    /// Whether `found` holds for some triangle whose box meets that of a given one, other than itself.
    pub(super) fn any_near(&self, triangle: usize, mut found: impl FnMut(usize) -> bool) -> bool {
        self.any_in(bounds(&self.corners[triangle]), |other| other != triangle && found(other))
    }

    /// Whether `found` holds for some triangle whose box meets a given one.
    pub(super) fn any_in(&self, near: Box2, found: impl FnMut(usize) -> bool) -> bool {
        self.tree.any_near(near, found)
    }
}

/// The area of triangles, and that of the boxes around each, in shares of the box around all.
pub(super) fn shares_of_box(triangles: &[[DVec2; 3]]) -> (f64, f64) {
    let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
    let (mut area, mut boxes) = (0.0, 0.0);
    for [a, b, c] in triangles {
        let (own_low, own_high) = (a.min(*b).min(*c), a.max(*b).max(*c));
        (low, high) = (low.min(own_low), high.max(own_high));
        area += 0.5 * (*b - *a).perp_dot(*c - *a).abs();
        boxes += (own_high - own_low).element_product();
    }
    let whole = (high - low).element_product().max(f64::MIN_POSITIVE);
    (area / whole, boxes / whole)
}

fn bounds([a, b, c]: &[DVec2; 3]) -> Box2 {
    (a.min(*b).min(*c), a.max(*b).max(*c))
}

/// The place along a Z-order curve of a point with coordinates from 0 to 2³².
fn z_order(point: DVec2) -> u64 {
    let spread = |x: u32| {
        let mut x = u64::from(x);
        for (shift, mask) in [
            (16, 0x0000_ffff_0000_ffff),
            (8, 0x00ff_00ff_00ff_00ff),
            (4, 0x0f0f_0f0f_0f0f_0f0f),
            (2, 0x3333_3333_3333_3333),
            (1, 0x5555_5555_5555_5555),
        ] {
            x = (x | x << shift) & mask;
        }
        x
    };
    spread(point.x as u32) | spread(point.y as u32) << 1
}

/// How deep two triangles lie in each other: the least shift that parts them; 0 or less where they do not overlap.
pub(super) fn overlap_depth(first: &[DVec2; 3], second: &[DVec2; 3]) -> f64 {
    let mut depth = f64::INFINITY;
    for triangle in [first, second] {
        for k in 0..3 {
            let axis = (triangle[(k + 1) % 3] - triangle[k]).perp().normalize_or_zero();
            if axis != DVec2::ZERO {
                let (low, high) = extent(first, axis);
                let (other_low, other_high) = extent(second, axis);
                depth = depth.min(high.min(other_high) - low.max(other_low));
                if depth <= 0.0 {
                    return depth;
                }
            }
        }
    }
    if depth.is_finite() { depth } else { 0.0 }
}

fn extent(triangle: &[DVec2; 3], axis: DVec2) -> (f64, f64) {
    let [a, b, c] = triangle.map(|p| p.dot(axis));
    (a.min(b).min(c), a.max(b).max(c))
}

#[cfg(test)]
mod tests {
    use super::*;

    const LOWER: [DVec2; 3] = [DVec2::ZERO, DVec2::X, DVec2::ONE];

    #[test]
    fn neighbours_do_not_overlap() {
        assert!(overlap_depth(&LOWER, &[DVec2::ZERO, DVec2::ONE, DVec2::Y]) <= 1e-15);
        // Nor does a triangle without area, wherever it lies.
        assert!(overlap_depth(&LOWER, &[DVec2::new(0.4, 0.1), DVec2::new(0.8, 0.1), DVec2::new(0.6, 0.1)]) <= 0.0);
    }

    #[test]
    fn depth_is_the_least_shift() {
        let shifted = LOWER.map(|p| p + DVec2::new(0.9, 0.0));
        assert!((overlap_depth(&LOWER, &shifted) - 0.1 / 2f64.sqrt()).abs() < 1e-12);
        assert!(overlap_depth(&LOWER, &LOWER) > 0.2);
    }
}
