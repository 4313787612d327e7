//! What is near in space.

use glam::DVec3;

/// Nodes of a level, or boxes, in a node of the next.
const CHILDREN: usize = 8;

/// Boxes, found by others that meet them: a tree over the boxes along a Z-order curve.
pub(super) struct BoxTree {
    /// The boxes' numbers along the curve.
    order: Vec<u32>,
    /// The boxes along the curve, then those around each [`CHILDREN`] of these, and so on; the last has one.
    levels: Vec<Vec<Box3>>,
}

/// Lower and upper corner.
pub(super) type Box3 = (DVec3, DVec3);

impl BoxTree {
    pub(super) fn new(boxes: &[Box3]) -> Self {
        let (low, high) = around(boxes);
        let scale = f64::from((1 << 21) - 1) / (high - low).max_element().max(f64::MIN_POSITIVE);
        let place = |number: u32| {
            let (own_low, own_high) = boxes[number as usize];
            z_order((0.5 * (own_low + own_high) - low) * scale)
        };
        let mut keyed: Vec<(u64, u32)> = (0..boxes.len() as u32).map(|number| (place(number), number)).collect();
        keyed.sort_unstable();
        let order: Vec<u32> = keyed.into_iter().map(|(_, number)| number).collect();
        let mut level: Vec<Box3> = order.iter().map(|&number| boxes[number as usize]).collect();
        let mut levels = Vec::new();
        while level.len() > 1 {
            let above = level.chunks(CHILDREN).map(around).collect();
            levels.push(std::mem::replace(&mut level, above));
        }
        levels.push(level);
        Self { order, levels }
    }

    /// Whether `found` holds for some box that meets a given one.
    pub(super) fn any_near(&self, (low, high): Box3, mut found: impl FnMut(usize) -> bool) -> bool {
        let top = self.levels.len() - 1;
        let mut open: Vec<(usize, usize)> = (0..self.levels[top].len()).map(|node| (top, node)).collect();
        while let Some((level, node)) = open.pop() {
            let (own_low, own_high) = self.levels[level][node];
            if own_low.cmpgt(high).any() || own_high.cmplt(low).any() {
                continue;
            }
            if level > 0 {
                let children = CHILDREN * node..(CHILDREN * (node + 1)).min(self.levels[level - 1].len());
                open.extend(children.map(|child| (level - 1, child)));
            } else if found(self.order[node] as usize) {
                return true;
            }
        }
        false
    }

    /// Calls `found` with each box that meets a given one.
    pub(super) fn each_near(&self, near: Box3, mut found: impl FnMut(usize)) {
        self.any_near(near, |number| {
            found(number);
            false
        });
    }
}

fn around(boxes: &[Box3]) -> Box3 {
    let add = |(low, high): Box3, own: &Box3| (low.min(own.0), high.max(own.1));
    boxes.iter().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), add)
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
            BoxTree::new(&boxes).each_near(given, |number| found.push(number));
            found.sort_unstable();
            let meets = |&number: &usize| {
                let (low, high) = boxes[number];
                high.cmpge(given.0).all() && low.cmple(given.1).all()
            };
            prop_assert_eq!(found, (0..points.len()).filter(meets).collect::<Vec<_>>());
        }
    }
}
