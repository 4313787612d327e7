//! Boxes of a plane or of space, found by others that meet them.

use glam::{DVec2, DVec3};
use rayon::prelude::*;

/// Nodes of a level, or boxes, in a node of the next.
const CHILDREN: usize = 8;

/// A point of a plane or of space.
pub(crate) trait Point: Copy + Send + Sync {
    /// The lower and upper corner of a box around nothing.
    const NOTHING: (Self, Self);
    fn lower(self, other: Self) -> Self;
    fn upper(self, other: Self) -> Self;
    /// Whether it lies beyond another along some axis.
    fn is_beyond(self, other: Self) -> bool;
}

macro_rules! point {
    ($vector:ident) => {
        impl Point for $vector {
            const NOTHING: (Self, Self) = ($vector::INFINITY, $vector::NEG_INFINITY);

            fn lower(self, other: Self) -> Self {
                self.min(other)
            }

            fn upper(self, other: Self) -> Self {
                self.max(other)
            }

            fn is_beyond(self, other: Self) -> bool {
                self.cmpgt(other).any()
            }
        }
    };
}

point!(DVec2);
point!(DVec3);

/// A tree of boxes, lower and upper corners, along a curve, which takes the same time to build for slivers, fans and heaps as for others.
pub(crate) struct BoxTree<P> {
    /// The boxes' numbers along the curve.
    order: Vec<u32>,
    /// The boxes along the curve, then those around each [`CHILDREN`] of these, and so on; the last has one.
    levels: Vec<Vec<(P, P)>>,
}

impl<P: Point> BoxTree<P> {
    /// The tree of so many boxes, given each one's place along the curve.
    pub(crate) fn new(places: &[u64], bounds: impl Fn(usize) -> (P, P)) -> Self {
        let mut keyed: Vec<(u64, u32)> = places.iter().copied().zip(0..places.len() as u32).collect();
        keyed.par_sort_unstable();
        let order: Vec<u32> = keyed.into_iter().map(|(_, number)| number).collect();
        let mut level: Vec<(P, P)> = order.iter().map(|&number| bounds(number as usize)).collect();
        let mut levels = Vec::new();
        while level.len() > 1 {
            let above = level.chunks(CHILDREN).map(|boxes| around(boxes.iter().copied())).collect();
            levels.push(std::mem::replace(&mut level, above));
        }
        levels.push(level);
        Self { order, levels }
    }

    /// Whether `found` holds for some box that meets a given one.
    pub(crate) fn any_near(&self, (low, high): (P, P), mut found: impl FnMut(usize) -> bool) -> bool {
        let top = self.levels.len() - 1;
        let mut open: Vec<(usize, usize)> = (0..self.levels[top].len()).map(|node| (top, node)).collect();
        while let Some((level, node)) = open.pop() {
            let (own_low, own_high) = self.levels[level][node];
            if own_low.is_beyond(high) || low.is_beyond(own_high) {
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
}

/// The box around boxes.
pub(crate) fn around<P: Point>(boxes: impl IntoIterator<Item = (P, P)>) -> (P, P) {
    boxes.into_iter().fold(P::NOTHING, |(low, high), own| (low.lower(own.0), high.upper(own.1)))
}
