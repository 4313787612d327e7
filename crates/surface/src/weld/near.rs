//! What is near in space.

use glam::DVec3;

use crate::box_tree::{BoxTree, around};

/// Lower and upper corner.
pub(super) type Box3 = (DVec3, DVec3);

/// The tree of boxes of space, along a Z-order curve.
pub(super) fn box_tree(boxes: &[Box3]) -> BoxTree<DVec3> {
    let (low, high) = around(boxes.iter().copied());
    let scale = f64::from((1 << 21) - 1) / (high - low).max_element().max(f64::MIN_POSITIVE);
    let place = |(own_low, own_high): &Box3| z_order((0.5 * (*own_low + *own_high) - low) * scale);
    let places: Vec<u64> = boxes.iter().map(place).collect();
    BoxTree::new(&places, |number| boxes[number])
}

/// Calls `found` with each box of a tree that meets a given one.
pub(super) fn each_near(tree: &BoxTree<DVec3>, near: Box3, mut found: impl FnMut(usize)) {
    tree.any_near(near, |number| {
        found(number);
        false
    });
}

/// The box around a triangle.
pub(super) fn bounds([a, b, c]: [DVec3; 3]) -> Box3 {
    (a.min(b).min(c), a.max(b).max(c))
}

/// The place along a Z-order curve of a point with coordinates from 0 to 2²¹.
fn z_order(point: DVec3) -> u64 {
    let spread = |x: u64| (0..21).map(|bit| (x >> bit & 1) << (3 * bit)).sum::<u64>();
    let [x, y, z] = point.to_array().map(|x| spread(x as u64));
    x | y << 1 | z << 2
}

/// The point of a triangle that is nearest to another, by its barycentric coordinates, and how far it is.
pub(super) fn nearest([a, b, c]: [DVec3; 3], p: DVec3) -> (DVec3, f64) {
    let normal = (b - a).cross(c - a);
    let whole = normal.length_squared();
    let of = |s: DVec3, e: DVec3| (e - s).cross(p - s).dot(normal) / whole;
    let inside = DVec3::new(of(b, c), of(c, a), of(a, b));
    if whole > 0.0 && inside.cmpge(DVec3::ZERO).all() {
        return (inside, ((p - a).dot(normal) / whole.sqrt()).abs());
    }
    let [x, y, z] = [DVec3::X, DVec3::Y, DVec3::Z];
    let on_edge = |(s, e, from, to): (DVec3, DVec3, DVec3, DVec3)| {
        let along = e - s;
        let t = ((p - s).dot(along) / along.length_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
        (from.lerp(to, t), p.distance(s + along * t))
    };
    let edges = [(a, b, x, y), (b, c, y, z), (c, a, z, x)].map(on_edge);
    edges.into_iter().fold((x, f64::INFINITY), |best, edge| if edge.1 < best.1 { edge } else { best })
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    prop_compose! {
        fn point()(p in prop::array::uniform3(-2.0f64..2.0)) -> DVec3 {
            DVec3::from(p)
        }
    }

    proptest! {
        /// No point of a fine grid over the triangle is nearer, and one is about as near.
        #[test]
        fn the_nearest_point_is_nearest(corners in [point(), point(), point()], p in point(), fold in 0u32..3) {
            let corners = match fold {
                0 => corners,
                1 => [corners[0], corners[1], corners[0].midpoint(corners[1])],
                _ => [corners[0]; 3],
            };
            let at = |b: DVec3| corners[0] * b.x + corners[1] * b.y + corners[2] * b.z;
            let (found, distance) = nearest(corners, p);
            prop_assert!(found.min_element() >= -1e-9 && (found.element_sum() - 1.0).abs() < 1e-9);
            prop_assert!((at(found).distance(p) - distance).abs() < 1e-6);
            let grid = (0..=60).flat_map(|i| (0..=60 - i).map(move |j| [i, j].map(|k| f64::from(k) / 60.0)));
            let least = grid.map(|[u, v]| at(DVec3::new(1.0 - u - v, u, v)).distance(p)).fold(f64::INFINITY, f64::min);
            prop_assert!(distance <= least + 1e-9 && least < distance + 0.2, "{distance}, {least}");
        }

        /// Exactly the boxes that meet a given one are found.
        #[test]
        fn boxes_are_found(points in prop::collection::vec((point(), 0.0f64..0.5), 0..100), one in point(), other in point()) {
            let boxes: Vec<Box3> = points.iter().map(|&(at, reach)| (at - reach, at + 2.0 * reach)).collect();
            let given = (one.min(other), one.max(other));
            let mut found = Vec::new();
            each_near(&box_tree(&boxes), given, |number| found.push(number));
            found.sort_unstable();
            let meets = |&number: &usize| {
                let (low, high) = boxes[number];
                high.cmpge(given.0).all() && low.cmple(given.1).all()
            };
            prop_assert_eq!(found, (0..points.len()).filter(meets).collect::<Vec<_>>());
        }
    }
}
