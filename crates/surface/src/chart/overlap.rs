//! Overlap of triangles in a plane.

use std::time::Duration;

use glam::DVec2;
use obvhs::{
    BvhBuildParams,
    aabb::Aabb,
    bvh2::{Bvh2, builder::build_bvh2_from_tris},
    triangle::Triangle,
};

/// Triangles of a plane, found by place.
pub(super) struct FlatTriangles {
    pub corners: Vec<[DVec2; 3]>,
    bvh: Bvh2,
}

impl FlatTriangles {
    pub(super) fn new(corners: Vec<[DVec2; 3]>) -> Self {
        let flat = |[a, b, c]: &[DVec2; 3]| Triangle {
            v0: a.as_vec2().extend(0.0).into(),
            v1: b.as_vec2().extend(0.0).into(),
            v2: c.as_vec2().extend(0.0).into(),
        };
        let triangles: Vec<_> = corners.iter().map(flat).collect();
        let bvh = if triangles.is_empty() {
            Bvh2::default()
        } else {
            build_bvh2_from_tris(&triangles, BvhBuildParams::very_fast_build(), &mut Duration::default())
        };
        Self { corners, bvh }
    }

    /// Whether `found` holds for some triangle whose box meets that of a given one, other than itself.
    pub(super) fn any_near(&self, triangle: usize, mut found: impl FnMut(usize) -> bool) -> bool {
        let [a, b, c] = self.corners[triangle];
        self.any_in(a.min(b).min(c), a.max(b).max(c), |other| other != triangle && found(other))
    }

    /// Whether `found` holds for some triangle whose box meets a given one.
    pub(super) fn any_in(&self, low: DVec2, high: DVec2, mut found: impl FnMut(usize) -> bool) -> bool {
        let corner = |p: DVec2| p.as_vec2().extend(0.0).into();
        let mut any = false;
        self.bvh.aabb_traverse(Aabb::new(corner(low), corner(high)), |bvh, node| {
            let node = &bvh.nodes[node as usize];
            let slots = node.first_index..node.first_index + node.prim_count;
            any = slots.map(|slot| bvh.primitive_indices[slot as usize] as usize).any(&mut found);
            !any
        });
        any
    }
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
