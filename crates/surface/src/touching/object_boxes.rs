//! Boxes around objects, which tell at once that most things touch nothing.

use std::time::Duration;

use glam::Vec3A;
use obvhs::{
    BvhBuildParams,
    aabb::Aabb,
    bvh2::{Bvh2, builder::build_bvh2},
};
use rayon::prelude::*;

use crate::WorldTriangle;

/// An object and the box around it.
#[derive(Clone, Copy, Debug)]
pub(super) struct ObjectBox {
    pub object: u32,
    pub around: Aabb,
}

/// The box around each object that has triangles.
pub(super) struct ObjectBoxes {
    pub boxes: Vec<ObjectBox>,
    bvh: Bvh2,
}

impl ObjectBoxes {
    /// Boxes that reach beyond the objects by a distance, metres. The triangles are object by object.
    pub fn new(triangles: &[WorldTriangle], reach: f32) -> Self {
        let boxes: Vec<_> = triangles
            .chunk_by(|a, b| a.object == b.object)
            .map(|own| ObjectBox { object: own[0].object, around: grown(around(own.par_iter()), reach) })
            .collect();
        let arounds: Vec<_> = boxes.iter().map(|object| object.around).collect();
        let bvh = build_bvh2(&arounds, BvhBuildParams::very_fast_build(), &mut Duration::default());
        Self { boxes, bvh }
    }

    /// Whether the box of an object of which `counts` is true meets a given one.
    pub fn any_meets(&self, given: Aabb, counts: impl Fn(u32) -> bool) -> bool {
        let mut is_met = false;
        self.bvh.aabb_traverse(given, |bvh, node| {
            let node = &bvh.nodes[node as usize];
            let slots = node.first_index as usize..(node.first_index + node.prim_count) as usize;
            is_met = bvh.primitive_indices[slots].iter().any(|&index| {
                let other = &self.boxes[index as usize];
                counts(other.object) && other.around.intersect_aabb(&given)
            });
            !is_met
        });
        is_met
    }
}

/// The box around triangles.
pub(super) fn around<'t>(triangles: impl ParallelIterator<Item = &'t WorldTriangle>) -> Aabb {
    triangles.map(box_of).reduce(|| Aabb::INVALID, |a, b| a.union(&b))
}

/// The box around a triangle.
pub(super) fn box_of(triangle: &WorldTriangle) -> Aabb {
    Aabb::from_points(&triangle.corners.map(Vec3A::from))
}

/// A box moved outwards by a distance, metres.
pub(super) fn grown(around: Aabb, reach: f32) -> Aabb {
    Aabb::new(around.min - reach, around.max + reach)
}
