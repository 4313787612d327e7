//! The bounding volume hierarchy, built by obvhs.

use std::{borrow::Borrow, time::Duration};

use obvhs::{BvhBuildParams, cwbvh::builder::build_cwbvh_from_tris, triangle::Triangle};
use rayon::prelude::*;

use crate::{Error, WorldTriangle};

pub use obvhs::cwbvh::node::CwBvhNode as BvhNode;

/// Levels that the kernels' stack holds.
pub const MAX_DEPTH: usize = 24;

/// An eight-wide compressed bounding volume hierarchy over the scene's triangles.
#[derive(Clone, Debug)]
pub struct Bvh {
    /// Its nodes; the first is the root.
    pub nodes: Vec<BvhNode>,
    /// The triangles in the order of the leaves. One that straddles a split may stand in it more than once.
    pub triangles: Vec<WorldTriangle>,
}

impl Bvh {
    /// Builds the hierarchy, on every core.
    ///
    /// # Errors
    /// If there is no triangle, or the hierarchy is deeper than [`MAX_DEPTH`].
    pub fn build(triangles: &[WorldTriangle]) -> Result<Self, Error> {
        if triangles.is_empty() {
            return Err(Error::NoTriangles);
        }
        let bvh =
            build_cwbvh_from_tris(&for_obvhs(triangles), BvhBuildParams::medium_build(), &mut Duration::default());
        let depth = depth(&bvh.nodes);
        if depth > MAX_DEPTH {
            return Err(Error::TooDeep { depth, limit: MAX_DEPTH });
        }
        let triangles = bvh.primitive_indices.par_iter().map(|&index| triangles[index as usize]).collect();
        Ok(Self { nodes: bvh.nodes, triangles })
    }
}

/// The triangles as obvhs takes them.
pub(crate) fn for_obvhs(triangles: &[impl Borrow<WorldTriangle> + Sync]) -> Vec<Triangle> {
    let convert =
        |t: &WorldTriangle| Triangle { v0: t.corners[0].into(), v1: t.corners[1].into(), v2: t.corners[2].into() };
    triangles.par_iter().map(|t| convert(t.borrow())).collect()
}

/// Levels of nodes from the root down.
fn depth(nodes: &[BvhNode]) -> usize {
    let mut deepest = 0;
    let mut open = vec![(0u32, 1usize)];
    while let Some((index, level)) = open.pop() {
        deepest = deepest.max(level);
        let node = &nodes[index as usize];
        open.extend((0..node.imask.count_ones()).map(|child| (node.child_base_idx + child, level + 1)));
    }
    deepest
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;

    fn grid(side: u32) -> Vec<WorldTriangle> {
        let corner = |x: u32, z: u32| Vec3::new(x as f32, (x * z % 3) as f32, z as f32);
        (0..side * side)
            .map(|i| (i % side, i / side))
            .map(|(x, z)| WorldTriangle {
                corners: [corner(x, z), corner(x, z + 1), corner(x + 1, z)],
                normals: None,
                uvs: None,
                object: 0,
                triangle: z * side + x,
                material: 0,
                exchanged: false,
            })
            .collect()
    }

    #[test]
    fn every_triangle_is_in_a_leaf() {
        let triangles = grid(40);
        let bvh = Bvh::build(&triangles).unwrap();
        let mut found: Vec<u32> = bvh.triangles.iter().map(|t| t.triangle).collect();
        found.sort_unstable();
        found.dedup();
        assert_eq!(found.len(), triangles.len());
        assert!(depth(&bvh.nodes) > 2);
    }

    #[test]
    fn nothing_is_refused() {
        assert!(matches!(Bvh::build(&[]), Err(Error::NoTriangles)));
    }
}
