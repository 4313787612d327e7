//! Lays charts flat, each in the tightest rectangle around it.

use glam::{DVec2, DVec3};

/// Texels between a chart and the middle of the outermost texels that it has to itself: what single precision may move a place on a
/// map of 10⁵ texels along a side.
pub(super) const MARGIN: f64 = 1.0 / 16.0;

/// How a chart's plane lies in the surface's space.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Frame {
    /// Unit direction along the rectangle's longer side.
    pub u: DVec3,
    /// Unit direction along its shorter side.
    pub v: DVec3,
    /// The rectangle's lower corner, units.
    pub low: DVec2,
    /// The rectangle's sides, units.
    pub size: DVec2,
    /// By how much the chart is made smaller than it is: 1 for all but charts that share a cell.
    pub shrink: f64,
}

impl Frame {
    /// The tightest rectangle around points of a chart, seen along its axis.
    pub(super) fn tight(axis: DVec3, points: impl Iterator<Item = DVec3>) -> Self {
        let (u, v) = axis.any_orthonormal_pair();
        let flat: Vec<DVec2> = points.map(|p| DVec2::new(p.dot(u), p.dot(v))).collect();
        let outline = hull(outermost(flat));
        let mut best = Self::along(&outline, DVec2::X);
        for direction in edge_directions(&outline) {
            let other = Self::along(&outline, direction);
            // Of like rectangles the first stays, however the last bits fall.
            if other.size.element_product() < best.size.element_product() * (1.0 - 1e-9) {
                best = other;
            }
        }
        // From the chart's plane to space.
        let lift = |direction: DVec3| u * direction.x + v * direction.y;
        Self { u: lift(best.u), v: lift(best.v), ..best }
    }

    /// The rectangle around points of a plane with sides along a unit direction and across it.
    fn along(outline: &[DVec2], direction: DVec2) -> Self {
        let turned = |axis: DVec2| {
            outline
                .iter()
                .map(|p| p.dot(axis))
                .fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(x), h.max(x)))
        };
        let mut axes = [direction, direction.perp()];
        let mut ranges = axes.map(turned);
        if ranges[1].1 - ranges[1].0 > ranges[0].1 - ranges[0].0 {
            axes = [direction.perp(), -direction];
            ranges = axes.map(turned);
        }
        let low = DVec2::new(ranges[0].0, ranges[1].0);
        let size = DVec2::new(ranges[0].1 - ranges[0].0, ranges[1].1 - ranges[1].0);
        Self { u: axes[0].extend(0.0), v: axes[1].extend(0.0), low, size, shrink: 1.0 }
    }

    /// A rectangle along two axes, made so small that no side is longer than `longest`.
    pub(super) fn shrunk(u: DVec3, v: DVec3, points: impl Iterator<Item = DVec3>, longest: f64) -> Self {
        let flat: Vec<DVec2> = points.map(|p| DVec2::new(p.dot(u), p.dot(v))).collect();
        let low = flat.iter().fold(DVec2::INFINITY, |low, &p| low.min(p));
        let size = flat.iter().fold(DVec2::NEG_INFINITY, |high, &p| high.max(p)) - low;
        let shrink = (longest / size.max_element().max(f64::MIN_POSITIVE)).min(1.0);
        Self { u, v, low, size: size * shrink, shrink }
    }

    /// The texels of a width that the rectangle takes along its sides.
    pub(super) fn texels(&self, texel: f64) -> DVec2 {
        (self.size / texel + 2.0 * MARGIN).ceil() + 1.0
    }

    /// The place of a point in the rectangle, units from its lower corner.
    pub(super) fn place(&self, p: DVec3) -> DVec2 {
        ((DVec2::new(p.dot(self.u), p.dot(self.v)) - self.low) * self.shrink).clamp(DVec2::ZERO, self.size)
    }
}

/// Directions in which the outermost of many points are sought.
const DIRECTIONS: usize = 16;

/// The points but for those that are inside the polygon of the outermost ones in some directions (Akl and Toussaint 1978).
fn outermost(points: Vec<DVec2>) -> Vec<DVec2> {
    if points.len() < 4 * DIRECTIONS {
        return points;
    }
    let directions = std::array::from_fn::<_, DIRECTIONS, _>(|k| {
        DVec2::from_angle(k as f64 * std::f64::consts::TAU / DIRECTIONS as f64)
    });
    let mut farthest = [points[0]; DIRECTIONS];
    for p in &points {
        for (far, direction) in farthest.iter_mut().zip(directions) {
            if p.dot(direction) > far.dot(direction) {
                *far = *p;
            }
        }
    }
    let is_inside = |p: DVec2| {
        (0..DIRECTIONS).all(|k| {
            let (start, end) = (farthest[k], farthest[(k + 1) % DIRECTIONS]);
            start == end || (end - start).perp_dot(p - start) > 0.0
        })
    };
    points.into_iter().filter(|&p| !is_inside(p)).collect()
}

/// The convex hull, counter-clockwise (Andrew 1979).
fn hull(mut points: Vec<DVec2>) -> Vec<DVec2> {
    points.sort_unstable_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    points.dedup();
    let half = |points: &mut dyn Iterator<Item = DVec2>| {
        let mut chain: Vec<DVec2> = Vec::new();
        for p in points {
            while let [.., a, b] = chain[..] {
                if (b - a).perp_dot(p - a) > 0.0 {
                    break;
                }
                chain.pop();
            }
            chain.push(p);
        }
        chain
    };
    let mut outline = half(&mut points.iter().copied());
    let upper = half(&mut points.iter().rev().copied());
    outline.pop();
    outline.extend(&upper[..upper.len().saturating_sub(1)]);
    if outline.is_empty() { points } else { outline }
}

/// Edges of an outline along which a rectangle is tried.
const MOST_EDGES: usize = 128;

fn edge_directions(outline: &[DVec2]) -> impl Iterator<Item = DVec2> + '_ {
    let step = outline.len().div_ceil(MOST_EDGES).max(1);
    let edge = |k: usize| (outline[(k + 1) % outline.len()] - outline[k]).normalize_or_zero();
    (0..outline.len()).step_by(step).map(edge).filter(|direction| *direction != DVec2::ZERO)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_turned_rectangle_is_found() {
        let direction = DVec2::from_angle(0.3);
        let points = [(0.0, 0.0), (3.0, 0.0), (3.0, 1.0), (0.0, 1.0), (1.0, 0.5)]
            .map(|(x, y)| (direction * x + direction.perp() * y).extend(7.0));
        let frame = Frame::tight(DVec3::Z, points.into_iter());
        assert!((frame.size - DVec2::new(3.0, 1.0)).length() < 1e-9, "{}", frame.size);
        assert!((frame.u.cross(frame.v) - DVec3::Z).length() < 1e-9);
        for p in points {
            let place = frame.place(p);
            assert!(place.cmpge(DVec2::ZERO).all() && place.cmple(frame.size).all());
        }
    }

    #[test]
    fn points_and_lines_have_a_frame() {
        assert_eq!(Frame::tight(DVec3::Y, std::iter::repeat_n(DVec3::ONE, 3)).size, DVec2::ZERO);
        let line = (0..100).map(|i| DVec3::new(f64::from(i), 0.0, f64::from(i)));
        let size = Frame::tight(DVec3::Y, line).size;
        assert!((size.x - 99.0 * 2f64.sqrt()).abs() < 1e-9 && size.y.abs() < 1e-9);
    }
}
