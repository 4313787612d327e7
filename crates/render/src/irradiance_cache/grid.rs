//! The grid of one layer of a map: from what paths have found at places to values at nodes.

use diacaustic_shaders::Sighting;
use glam::Vec3;

use crate::map_plan::MapPlan;

/// Where a grid's nodes lie on the plane of a map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Grid {
    /// Index of its first node among those of all grids.
    pub first: usize,
    pub columns: usize,
    pub rows: usize,
    /// Nodes for each unit of the plane.
    pub scale: f64,
    /// From node to node, metres.
    pub cell: f64,
}

impl Grid {
    /// Nodes over the plane of a map, at least 2 and at most `most` along each side, about `cell` metres from each other.
    pub fn new(plan: &MapPlan, first: usize, cell: f64, most: usize) -> Self {
        let metres = f64::from(plan.layout.metres_per_texel);
        let sides = [plan.layout.width, plan.layout.height].map(|side| f64::from(side - 1));
        let longest = sides[0].max(sides[1]);
        let scale = (metres / cell).clamp(1.0 / longest, (most - 1) as f64 / longest);
        let [columns, rows] = sides.map(|side| ((side * scale).ceil() as usize + 1).max(2));
        Self { first, columns, rows, scale, cell: metres / scale }
    }

    pub fn nodes(&self) -> usize {
        self.columns * self.rows
    }

    /// The four nodes around a place of the plane, and their bilinear weights.
    pub fn around(&self, place: [f32; 2]) -> [(usize, f64); 4] {
        let at = |axis: usize, count: usize| (f64::from(place[axis]) * self.scale).clamp(0.0, (count - 1) as f64);
        let (x, y) = (at(0, self.columns), at(1, self.rows));
        let corner = |at: f64, count: usize| (at as usize).min(count - 2);
        let (i, j) = (corner(x, self.columns), corner(y, self.rows));
        let (fx, fy) = (x - i as f64, y - j as f64);
        let node = j * self.columns + i;
        [
            (node, (1.0 - fx) * (1.0 - fy)),
            (node + 1, fx * (1.0 - fy)),
            (node + self.columns, (1.0 - fx) * fy),
            (node + self.columns + 1, fx * fy),
        ]
    }
}

/// What paths have found around a node.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Found {
    /// Paths, by weight.
    pub paths: f64,
    /// Sum of irradiance, W/m².
    pub irradiance: [f64; 3],
    /// Sum of inverse distances, 1/m.
    pub inverse_distance: f64,
}

impl Found {
    pub fn of(sighting: &Sighting) -> Self {
        let irradiance = sighting.bounced.map(|radiance| std::f64::consts::PI * f64::from(radiance));
        Self { paths: 1.0, irradiance, inverse_distance: f64::from(sighting.inverse_distance) }
    }

    pub fn add(&mut self, other: &Self, weight: f64) {
        self.paths += weight * other.paths;
        self.inverse_distance += weight * other.inverse_distance;
        for (sum, value) in self.irradiance.iter_mut().zip(other.irradiance) {
            *sum += weight * value;
        }
    }
}

/// What holds at a node.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Node {
    /// Irradiance, W/m².
    pub irradiance: [f64; 3],
    /// The mean over directions, by cosine, of the inverse distance to what is there, 1/m.
    pub inverse_distance: f64,
    /// How far around it paths have told of it, metres.
    pub reach: f64,
}

impl Node {
    fn blend(values: &[(Self, f64)]) -> Self {
        let mut sum = Self::default();
        for (node, weight) in values {
            sum.inverse_distance += weight * node.inverse_distance;
            sum.reach += weight * node.reach;
            for (sum, value) in sum.irradiance.iter_mut().zip(node.irradiance) {
                *sum += weight * value;
            }
        }
        sum
    }

    /// The irradiance in single precision.
    pub fn irradiance(&self) -> Vec3 {
        Vec3::from(self.irradiance.map(|value| value as f32))
    }
}

/// One level of a pyramid, of which each next has nodes twice as far from each other.
struct Level {
    columns: usize,
    rows: usize,
    found: Vec<Found>,
}

impl Level {
    fn coarser(&self) -> Self {
        let (columns, rows) = (self.columns / 2 + 1, self.rows / 2 + 1);
        let mut found = vec![Found::default(); columns * rows];
        for (index, own) in self.found.iter().enumerate() {
            for (i, share_i) in parents(index % self.columns) {
                for (j, share_j) in parents(index / self.columns) {
                    found[j * columns + i].add(own, share_i * share_j);
                }
            }
        }
        Self { columns, rows, found }
    }
}

/// The nodes of the next level around one along an axis, and their weights.
fn parents(index: usize) -> [(usize, f64); 2] {
    if index.is_multiple_of(2) {
        [(index / 2, 1.0), (index / 2, 0.0)]
    } else {
        [(index / 2, 0.5), (index / 2 + 1, 0.5)]
    }
}

/// The values at a grid's nodes: each by what paths found around it, and as far as these are fewer than `fewest`, by what they found around
/// that. None if there are fewer in all.
pub(crate) fn values(grid: &Grid, found: Vec<Found>, fewest: f64) -> Option<Vec<Node>> {
    let mut levels = vec![Level { columns: grid.columns, rows: grid.rows, found }];
    while let Some(last) = levels.last().filter(|last| last.columns.max(last.rows) > 2) {
        let coarser = last.coarser();
        levels.push(coarser);
    }
    let all = levels.last()?.found.iter().fold(Found::default(), |mut sum, own| {
        sum.add(own, 1.0);
        sum
    });
    if all.paths < fewest {
        return None;
    }
    let mut cell = grid.cell * f64::from(1u32 << levels.len());
    let everywhere = Node { reach: cell, ..mean(&all) };
    let mut above = (1, vec![everywhere]);
    for level in levels.iter().rev() {
        cell *= 0.5;
        let node = |index: usize| {
            let mut around = Vec::with_capacity(4);
            for (j, share_j) in parents(index / level.columns) {
                for (i, share_i) in parents(index % level.columns) {
                    around.push((above.1[(j * above.0 + i).min(above.1.len() - 1)], share_i * share_j));
                }
            }
            let own = &level.found[index];
            let by_own = (own.paths / fewest).min(1.0);
            let of_own = if own.paths > 0.0 { mean(own) } else { Node::default() };
            Node::blend(&[(Node { reach: cell, ..of_own }, by_own), (Node::blend(&around), 1.0 - by_own)])
        };
        above = (level.columns, (0..level.found.len()).map(node).collect());
    }
    Some(above.1)
}

fn mean(found: &Found) -> Node {
    Node {
        irradiance: found.irradiance.map(|sum| sum / found.paths),
        inverse_distance: found.inverse_distance / found.paths,
        reach: 0.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const GRID: Grid = Grid { first: 0, columns: 17, rows: 9, scale: 0.1, cell: 0.5 };

    fn found(paths: f64, irradiance: f64) -> Found {
        Found { paths, irradiance: [paths * irradiance; 3], inverse_distance: 2.0 * paths }
    }

    #[test]
    fn even_light_is_even_whatever_the_paths() {
        let seen = (0..GRID.nodes()).map(|node| found((node % 5) as f64, 3.0)).collect();
        for node in values(&GRID, seen, 6.0).unwrap() {
            assert!(
                (node.irradiance[0] - 3.0).abs() < 1e-12 && (node.inverse_distance - 2.0).abs() < 1e-12,
                "{node:?}"
            );
        }
    }

    #[test]
    fn many_paths_keep_to_their_node_and_few_ask_around() {
        let brighter = |node: usize| if node % 17 < 8 { 1.0 } else { 5.0 };
        let of_each = |paths: f64| (0..GRID.nodes()).map(|node| found(paths, brighter(node))).collect();
        let own = values(&GRID, of_each(10.0), 10.0).unwrap();
        assert!(own.iter().enumerate().all(|(node, value)| value.irradiance[1] == brighter(node)));
        assert!(own.iter().all(|value| value.reach == 0.5));
        let shared = values(&GRID, of_each(1.0), 10.0).unwrap();
        assert!((1.5..4.5).contains(&shared[8].irradiance[1]), "{:?}", shared[8]);
        assert!(shared.iter().all(|value| value.reach > 1.0), "{:?}", shared[0]);
        // Far from the step it is not seen.
        assert!(shared[0].irradiance[1] < 1.5 && shared[16].irradiance[1] > 4.5, "{shared:?}");
    }

    #[test]
    fn too_few_paths_in_all_tell_nothing() {
        let mut seen = vec![Found::default(); GRID.nodes()];
        seen[3] = found(5.0, 1.0);
        assert_eq!(values(&GRID, seen.clone(), 6.0), None);
        let alone = values(&GRID, seen, 5.0).unwrap();
        assert!(alone[3].reach < alone[GRID.nodes() - 1].reach);
    }

    #[test]
    fn places_lie_between_their_nodes() {
        for place in [[0.0, 0.0], [12.5, 31.0], [160.0, 80.0], [-1.0, 500.0]] {
            let around = GRID.around(place);
            assert!((around.iter().map(|(_, weight)| weight).sum::<f64>() - 1.0).abs() < 1e-12);
            let at = around.map(|(node, weight)| weight * (node % 17) as f64).iter().sum::<f64>();
            assert!((at - f64::from(place[0]).clamp(0.0, 160.0) * 0.1).abs() < 1e-12, "{place:?}");
        }
    }
}
