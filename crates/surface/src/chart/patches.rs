//! Patches: what a texel cannot tell apart, and of which charts are made.

use glam::{DVec3, Vec3};

use super::facets::{Facets, NONE};

/// Every triangle in a patch: one with an edge longer than a texel alone, smaller ones with their neighbours within half a texel.
pub(super) struct Patches {
    /// The patch of each triangle.
    pub of: Vec<u32>,
    /// The triangles, patch by patch.
    members: Vec<u32>,
    /// Where each patch begins in `members`, and the end.
    starts: Vec<u32>,
    /// The sum of twice the triangles' areas times their unit normals, units².
    pub double_areas: Vec<Vec3>,
}

impl Patches {
    /// Makes patches of a surface whose texels are `texel` units wide.
    pub(super) fn new(facets: &Facets<'_>, texel: f64) -> Self {
        let count = facets.mesh.triangles.len();
        let mut patches = Self {
            of: vec![NONE; count],
            members: Vec::with_capacity(count),
            starts: vec![0],
            double_areas: Vec::with_capacity(count.min(1 << 20)),
        };
        for seed in 0..count as u32 {
            if patches.of[seed as usize] == NONE {
                patches.grow(facets, seed, texel);
            }
        }
        patches
    }

    pub(super) fn count(&self) -> usize {
        self.double_areas.len()
    }

    /// The triangles of a patch.
    pub(super) fn triangles(&self, patch: u32) -> &[u32] {
        &self.members[self.starts[patch as usize] as usize..self.starts[patch as usize + 1] as usize]
    }

    fn grow(&mut self, facets: &Facets<'_>, seed: u32, texel: f64) {
        let number = self.double_areas.len() as u32;
        let mut head = self.members.len();
        let mut sum = facets.double_areas[seed as usize];
        self.of[seed as usize] = number;
        self.members.push(seed);
        if facets.longest_edge(seed) < texel && sum != Vec3::ZERO {
            let center = centroid(facets.corners(seed));
            while head < self.members.len() {
                for next in facets.neighbours[self.members[head] as usize] {
                    if next != NONE && self.of[next as usize] == NONE {
                        let double_area = facets.double_areas[next as usize];
                        let corners = facets.corners(next);
                        // Front and back of what is thinner than a texel stay apart.
                        if double_area.dot(sum) >= 0.0
                            && corners.iter().all(|corner| corner.distance(center) <= 0.5 * texel)
                        {
                            self.of[next as usize] = number;
                            self.members.push(next);
                            sum += double_area;
                        }
                    }
                }
                head += 1;
            }
        }
        self.starts.push(self.members.len() as u32);
        self.double_areas.push(sum);
    }
}

fn centroid([a, b, c]: [DVec3; 3]) -> DVec3 {
    (a + b + c) / 3.0
}
