//! A binary bounding-volume hierarchy over triangles, split by the binned surface-area heuristic (Wald 2007).

use std::ops::Range;

use glam::DVec3;

use super::triangle::{Facet, Triangle};
use super::{Hit, Ray};

const BINS: usize = 16;
const LEAF_SIZE: usize = 4;
/// Cost of entering a node, in triangle tests.
const NODE_COST: f64 = 1.0;
/// Widens the far end of the slab test over its rounding (Ize 2013).
const SLAB_MARGIN: f64 = 1.0 + 8.0 * f64::EPSILON;

#[derive(Debug)]
pub(super) struct Bvh {
    nodes: Vec<Node>,
    facets: Vec<Facet>,
}

/// A leaf holds `count` facets from `first`; an inner node (`count` = 0) has the children `first` and `first` + 1.
#[derive(Clone, Copy, Debug)]
struct Node {
    bounds: Bounds,
    first: usize,
    count: usize,
}

#[derive(Clone, Copy, Debug)]
struct Bounds {
    min: DVec3,
    max: DVec3,
}

impl Bounds {
    const EMPTY: Self = Self { min: DVec3::INFINITY, max: DVec3::NEG_INFINITY };

    fn union(self, other: Self) -> Self {
        Self { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    fn of(points: impl IntoIterator<Item = DVec3>) -> Self {
        points.into_iter().fold(Self::EMPTY, |bounds, p| bounds.union(Self { min: p, max: p }))
    }

    fn size(&self) -> DVec3 {
        (self.max - self.min).max(DVec3::ZERO)
    }

    fn half_area(&self) -> f64 {
        let d = self.size();
        d.x * d.y + d.y * d.z + d.z * d.x
    }

    /// The distance at which a ray enters the box, if it does before `limit`.
    fn enter(&self, origin: DVec3, inverse: DVec3, limit: f64) -> Option<f64> {
        let (a, b) = ((self.min - origin) * inverse, (self.max - origin) * inverse);
        let near = a.min(b).max_element().max(0.0);
        let far = a.max(b).min_element() * SLAB_MARGIN;
        (near <= far && near <= limit).then_some(near)
    }
}

/// A triangle on its way into the tree.
#[derive(Clone, Copy)]
struct Item {
    triangle: usize,
    bounds: Bounds,
    centroid: DVec3,
}

impl Bvh {
    pub(super) fn build(triangles: &[Triangle]) -> Self {
        let mut items: Vec<Item> = triangles
            .iter()
            .enumerate()
            .map(|(triangle, t)| {
                let bounds = Bounds::of(t.corners);
                Item { triangle, bounds, centroid: 0.5 * (bounds.min + bounds.max) }
            })
            .collect();
        let mut nodes = vec![leaf(&items, 0, items.len())];
        let mut pending = vec![0];
        while let Some(parent) = pending.pop() {
            let Node { first, count, .. } = nodes[parent];
            let Some(left) = split(&mut items[first..first + count]) else { continue };
            let children = nodes.len();
            nodes.push(leaf(&items, first, left));
            nodes.push(leaf(&items, first + left, count - left));
            nodes[parent] = Node { first: children, count: 0, ..nodes[parent] };
            pending.extend([children, children + 1]);
        }
        let facets = items.iter().map(|item| Facet::new(item.triangle, triangles[item.triangle].corners)).collect();
        Self { nodes, facets }
    }

    /// The longest side of the box around everything, metres; 0 for an empty scene.
    pub(super) fn extent(&self) -> f64 {
        self.nodes[0].bounds.size().max_element()
    }

    /// The nearest triangle that `stands` between two distances along a ray.
    pub(super) fn nearest(&self, ray: &Ray, range: Range<f64>, stands: impl Fn(&Hit) -> bool) -> Option<Hit> {
        let mut nearest: Option<Hit> = None;
        self.visit(ray, range, stands, |hit| {
            nearest = Some(hit);
            Some(hit.distance)
        });
        nearest
    }

    /// Whether a triangle `stands` between two distances along a ray.
    pub(super) fn any(&self, ray: &Ray, range: Range<f64>, stands: impl Fn(&Hit) -> bool) -> bool {
        let mut found = false;
        self.visit(ray, range, stands, |_| {
            found = true;
            None
        });
        found
    }

    /// Calls `report` with each hit found within the range that `stands`; it gives the new limit, or none to stop.
    fn visit(
        &self,
        ray: &Ray,
        Range { start, end: mut limit }: Range<f64>,
        stands: impl Fn(&Hit) -> bool,
        mut report: impl FnMut(Hit) -> Option<f64>,
    ) {
        if self.facets.is_empty() {
            return;
        }
        let inverse = inverse_direction(ray.direction);
        let enter = |node: usize, limit| self.nodes[node].bounds.enter(ray.origin, inverse, limit);
        let mut stack: Vec<(usize, f64)> = Vec::with_capacity(64);
        stack.extend(enter(0, limit).map(|distance| (0, distance)));
        while let Some((index, distance)) = stack.pop() {
            if distance > limit {
                continue;
            }
            let Node { first, count, .. } = self.nodes[index];
            for facet in &self.facets[first..first + count] {
                let Some(hit) = facet.meet(ray) else { continue };
                if hit.distance <= start || hit.distance >= limit || !stands(&hit) {
                    continue;
                }
                let Some(new_limit) = report(hit) else { return };
                limit = new_limit;
            }
            if count == 0 {
                let mut children = [(first, enter(first, limit)), (first + 1, enter(first + 1, limit))];
                // The nearer child is pushed last and so visited first.
                if children[0].1 < children[1].1 {
                    children.swap(0, 1);
                }
                stack.extend(children.iter().filter_map(|&(child, entry)| entry.map(|distance| (child, distance))));
            }
        }
    }
}

/// 1/d per axis; a component of 0 is taken as tiny, so that 0 · ∞ does not turn up in the slab test.
fn inverse_direction(direction: DVec3) -> DVec3 {
    direction.map(|d| if d == 0.0 { 1e300 } else { d.recip() })
}

fn leaf(items: &[Item], first: usize, count: usize) -> Node {
    let bounds = items[first..first + count].iter().fold(Bounds::EMPTY, |all, item| all.union(item.bounds));
    Node { bounds, first, count }
}

/// Sorts the items into two halves and returns the size of the first, or none if they should stay one leaf.
fn split(items: &mut [Item]) -> Option<usize> {
    if items.len() <= LEAF_SIZE {
        return None;
    }
    let centroids = Bounds::of(items.iter().map(|item| item.centroid));
    let size = centroids.size();
    let axis = (0..3).max_by(|&a, &b| size[a].total_cmp(&size[b]))?;
    if size[axis] == 0.0 {
        return None;
    }
    let scale = BINS as f64 / size[axis];
    let bin_of = |item: &Item| (((item.centroid[axis] - centroids.min[axis]) * scale) as usize).min(BINS - 1);
    let boundary = cheapest_boundary(items, bin_of);
    items.sort_by_key(|item| bin_of(item) >= boundary);
    Some(items.partition_point(|item| bin_of(item) < boundary))
}

/// The bin before which to cut, 1 to BINS − 1. The first and the last bin are never empty, so each half has items.
fn cheapest_boundary(items: &[Item], bin_of: impl Fn(&Item) -> usize) -> usize {
    let mut bins = [(Bounds::EMPTY, 0usize); BINS];
    for item in items {
        let (bounds, count) = &mut bins[bin_of(item)];
        *bounds = bounds.union(item.bounds);
        *count += 1;
    }
    let cost = |range: &[(Bounds, usize)]| {
        let bounds = range.iter().fold(Bounds::EMPTY, |all, bin| all.union(bin.0));
        bounds.half_area() * (NODE_COST + range.iter().map(|bin| bin.1).sum::<usize>() as f64)
    };
    (1..BINS)
        .min_by(|&a, &b| {
            let at = |cut: usize| cost(&bins[..cut]) + cost(&bins[cut..]);
            at(a).total_cmp(&at(b))
        })
        .expect("there is more than one bin")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::generator::Generator;

    fn random_triangles(count: usize, generator: &mut Generator) -> Vec<Triangle> {
        let mut point = |scale: f64| scale * DVec3::from_array(std::array::from_fn(|_| generator.unit() - 0.5));
        (0..count)
            .map(|index| {
                let middle = point(2.0);
                let corners = [middle + point(0.4), middle + point(0.4), middle + point(0.4)];
                Triangle {
                    object: 0,
                    index,
                    corners,
                    normal_geometric: DVec3::Z,
                    normals: None,
                    uvs: None,
                    colors: None,
                    opacities: None,
                    tangents: None,
                }
            })
            .collect()
    }

    fn random_ray(generator: &mut Generator) -> Ray {
        let mut vector = || DVec3::from_array(std::array::from_fn(|_| generator.unit() - 0.5));
        Ray { origin: 3.0 * vector(), direction: vector().normalize() }
    }

    #[test]
    fn agrees_with_testing_every_triangle() {
        let mut generator = Generator::new(&[1]);
        let triangles = random_triangles(700, &mut generator);
        let bvh = Bvh::build(&triangles);
        let facets: Vec<Facet> = triangles.iter().map(|t| Facet::new(t.index, t.corners)).collect();
        let mut met = 0;
        for _ in 0..4000 {
            let ray = random_ray(&mut generator);
            let expected = facets
                .iter()
                .filter_map(|facet| facet.meet(&ray))
                .filter(|hit| hit.distance > 0.0)
                .min_by(|a, b| a.distance.total_cmp(&b.distance));
            assert_eq!(bvh.nearest(&ray, 0.0..f64::INFINITY, |_| true), expected);
            let Some(hit) = expected else { continue };
            met += 1;
            assert!(bvh.any(&ray, 0.0..hit.distance + 1e-9, |_| true));
            assert!(!bvh.any(&ray, 0.0..hit.distance, |_| true));
            let behind = bvh.nearest(&ray, 0.0..f64::INFINITY, |other| other.triangle != hit.triangle);
            assert!(behind.is_none_or(|next| next.triangle != hit.triangle && next.distance >= hit.distance));
        }
        assert!(met > 1000, "only {met} rays met anything");
    }

    #[test]
    fn flat_boxes_and_axis_parallel_rays() {
        let corners = [DVec3::ZERO, DVec3::X, DVec3::Y];
        let triangles: Vec<Triangle> = (0..20)
            .map(|index| {
                let offset = index as f64 * DVec3::Z;
                let corners = corners.map(|p| p + offset);
                Triangle {
                    object: 0,
                    index,
                    corners,
                    normal_geometric: DVec3::Z,
                    normals: None,
                    uvs: None,
                    colors: None,
                    opacities: None,
                    tangents: None,
                }
            })
            .collect();
        let bvh = Bvh::build(&triangles);
        let ray = Ray { origin: DVec3::new(0.0, 0.5, -1.0), direction: DVec3::Z };
        let hit = bvh.nearest(&ray, 3.5..f64::INFINITY, |_| true).expect("the ray runs through the stack's edge");
        assert_eq!((hit.triangle, hit.distance), (3, 4.0));
    }

    #[test]
    fn no_triangles_no_hit() {
        let ray = Ray { origin: DVec3::ZERO, direction: DVec3::Z };
        let bvh = Bvh::build(&[]);
        assert_eq!(bvh.nearest(&ray, 0.0..f64::INFINITY, |_| true), None);
        assert_eq!(bvh.extent(), 0.0);
    }
}
