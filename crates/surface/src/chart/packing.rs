//! Packs rectangles of whole texels into a plane of given width.
//!
//! Best fit (Burke, Kendall and Whitwell 2004): the widest rectangle that fits goes into the lowest gap of the skyline. n rectangles
//! take O(n log n) steps.

use std::{cmp::Reverse, collections::BinaryHeap};

use glam::UVec2;

/// Where rectangles lie in a plane.
pub(super) struct Packing {
    /// The lower corner of each.
    pub places: Vec<UVec2>,
    /// Texels along y that they take.
    pub height: u32,
}

/// Packs rectangles; none if one is wider than the plane.
pub(super) fn pack(sizes: &[UVec2], width: u32) -> Option<Packing> {
    if sizes.iter().any(|size| size.x > width) {
        return None;
    }
    let mut skyline = Skyline::new(width);
    let mut waiting = Waiting::new(sizes);
    let mut packing = Packing { places: vec![UVec2::ZERO; sizes.len()], height: 0 };
    for _ in 0..sizes.len() {
        let (gap, rectangle) = loop {
            let gap = skyline.lowest();
            match waiting.take_widest(skyline.segments[gap].width) {
                Some(rectangle) => break (gap, rectangle),
                None => skyline.raise(gap),
            }
        };
        packing.places[rectangle] = skyline.put(gap, sizes[rectangle]);
        packing.height = packing.height.max(packing.places[rectangle].y + sizes[rectangle].y);
    }
    Some(packing)
}

/// Rectangles not yet placed, by width.
struct Waiting {
    /// Their numbers by width, then height.
    order: Vec<usize>,
    /// For each width, where its remaining rectangles lie in `order`.
    of_width: Vec<std::ops::Range<usize>>,
    /// For each width, one from which on down to look for the widest remaining.
    narrower: Vec<usize>,
}

impl Waiting {
    fn new(sizes: &[UVec2]) -> Self {
        let mut order: Vec<usize> = (0..sizes.len()).collect();
        order.sort_by_key(|&rectangle| (sizes[rectangle].x, sizes[rectangle].y));
        let widest = sizes.iter().map(|size| size.x as usize).max().unwrap_or(0);
        let mut of_width = vec![0..0; widest + 1];
        let mut first = 0;
        for same in order.chunk_by(|a, b| sizes[*a].x == sizes[*b].x) {
            of_width[sizes[same[0]].x as usize] = first..first + same.len();
            first += same.len();
        }
        Self { order, of_width, narrower: (0..=widest).collect() }
    }

    /// The widest remaining rectangle of at most a width; of equal ones the highest.
    fn take_widest(&mut self, width: u32) -> Option<usize> {
        let asked = (width as usize).min(self.narrower.len() - 1);
        let mut found = asked;
        while found > 0 && (self.narrower[found] != found || self.of_width[found].is_empty()) {
            found = if self.narrower[found] != found { self.narrower[found] } else { found - 1 };
        }
        // Later searches take the same way in one step.
        let mut passed = asked;
        while passed > found {
            let next = if self.narrower[passed] != passed { self.narrower[passed] } else { passed - 1 };
            self.narrower[passed] = found;
            passed = next;
        }
        self.of_width[found].next_back().map(|place| self.order[place])
    }
}

/// A level stretch of the skyline.
struct Segment {
    x: u32,
    width: u32,
    y: u32,
    left: Option<usize>,
    right: Option<usize>,
    exists: bool,
}

/// The upper contour of what is packed, and its segments from the lowest on.
struct Skyline {
    segments: Vec<Segment>,
    /// Height, left end and number of each segment; entries that no longer hold are skipped.
    lowest_first: BinaryHeap<Reverse<(u32, u32, usize)>>,
}

impl Skyline {
    fn new(width: u32) -> Self {
        let ground = Segment { x: 0, width, y: 0, left: None, right: None, exists: true };
        Self { segments: vec![ground], lowest_first: BinaryHeap::from([Reverse((0, 0, 0))]) }
    }

    /// The lowest segment, of equally low ones the leftmost.
    fn lowest(&mut self) -> usize {
        loop {
            // There is always one: each change of a segment enters it anew.
            let Some(Reverse((y, x, number))) = self.lowest_first.pop() else { return 0 };
            let segment = &self.segments[number];
            if segment.exists && (segment.y, segment.x) == (y, x) {
                return number;
            }
        }
    }

    /// Lifts a segment to the lower of its neighbours.
    fn raise(&mut self, number: usize) {
        let height = |side: Option<usize>| side.map(|number| self.segments[number].y);
        let sides = [height(self.segments[number].left), height(self.segments[number].right)];
        if let Some(lower) = sides.into_iter().flatten().min() {
            self.segments[number].y = lower;
        }
        self.settle(number);
    }

    /// Puts a rectangle at the left end of a segment; returns its lower corner.
    fn put(&mut self, number: usize, size: UVec2) -> UVec2 {
        let Segment { x, width, y, right, .. } = self.segments[number];
        if size.x < width {
            let rest = self.segments.len();
            self.segments.push(Segment {
                x: x + size.x,
                width: width - size.x,
                y,
                left: Some(number),
                right,
                exists: true,
            });
            if let Some(right) = right {
                self.segments[right].left = Some(rest);
            }
            self.segments[number].right = Some(rest);
            self.lowest_first.push(Reverse((y, x + size.x, rest)));
        }
        self.segments[number].width = size.x;
        self.segments[number].y = y + size.y;
        self.settle(number);
        UVec2::new(x, y)
    }

    /// Joins a segment with neighbours of its height and enters what there is then.
    fn settle(&mut self, number: usize) {
        if let Some(right) = self.segments[number].right.filter(|&n| self.segments[n].y == self.segments[number].y) {
            self.join(number, right);
        }
        let mut kept = number;
        if let Some(left) = self.segments[number].left.filter(|&n| self.segments[n].y == self.segments[number].y) {
            self.join(left, number);
            kept = left;
        }
        self.lowest_first.push(Reverse((self.segments[kept].y, self.segments[kept].x, kept)));
    }

    /// Lets a segment take in its right neighbour.
    fn join(&mut self, left: usize, right: usize) {
        let Segment { width, right: beyond, .. } = self.segments[right];
        self.segments[right].exists = false;
        self.segments[left].width += width;
        self.segments[left].right = beyond;
        if let Some(beyond) = beyond {
            self.segments[beyond].left = Some(left);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn rectangles_do_not_meet(sizes in prop::collection::vec((1u32..20, 1u32..20), 1..80), more in 0u32..60) {
            let sizes: Vec<_> = sizes.into_iter().map(UVec2::from).collect();
            let width = sizes.iter().map(|size| size.x).max().unwrap() + more;
            let packing = pack(&sizes, width).unwrap();
            let mut taken = vec![false; (width * packing.height) as usize];
            for (place, size) in packing.places.iter().zip(&sizes) {
                prop_assert!(place.x + size.x <= width && place.y + size.y <= packing.height);
                for cell in (0..size.x * size.y).map(|i| *place + UVec2::new(i % size.x, i / size.x)) {
                    prop_assert!(!std::mem::replace(&mut taken[(cell.y * width + cell.x) as usize], true));
                }
            }
        }
    }

    #[test]
    fn many_rectangles_leave_little_room() {
        let number = |i: u32| (i.wrapping_mul(2_654_435_761) >> 16) % 30 + 2;
        let sizes: Vec<_> = (0..100_000).map(|i| UVec2::new(number(i).max(number(i + 7)), number(i + 7))).collect();
        let area: u64 = sizes.iter().map(|size| u64::from(size.x * size.y)).sum();
        let width = (area as f64).sqrt() as u32;
        let packing = pack(&sizes, width).unwrap();
        assert!(area as f64 > 0.95 * f64::from(width) * f64::from(packing.height), "{}", packing.height);
    }

    #[test]
    fn too_wide_is_refused() {
        assert!(pack(&[UVec2::new(5, 1)], 4).is_none());
    }
}
