//! Normals for meshes that have none: smooth, but for creases.

use glam::Vec3;

use crate::Mesh;

impl Mesh {
    /// Gives normals to a mesh without any, where `is_smooth` says so of triangles that share an edge: around a vertex, all corners that
    /// such edges join have one normal, the mean of their facets', weighted by their angles. Vertices are added where one needs several
    /// normals. A mesh on which no edge is smooth keeps flat facets.
    pub(crate) fn smooth(&mut self, is_smooth: impl Fn(usize, usize) -> bool) {
        let mut groups = Groups::new(3 * self.triangles.len());
        if !self.join_corners(&mut groups, is_smooth) {
            return;
        }
        let mut sums = vec![Vec3::ZERO; 3 * self.triangles.len()];
        for triangle in 0..self.triangles.len() {
            let facet = self.double_area_normal(triangle).normalize_or_zero();
            let corners = self.corners(triangle);
            for corner in 0..3 {
                let [a, b, c] = [0, 1, 2].map(|k| corners[(corner + k) % 3]);
                let angle = (b - a).angle_between(c - a);
                let weight = if angle.is_finite() { angle } else { 0.0 };
                sums[groups.root(3 * triangle as u32 + corner as u32) as usize] += weight * facet;
            }
        }
        self.set_normals(&mut groups, &sums);
    }

    /// Smooths edges at which facets meet at less than an angle, degrees.
    pub(crate) fn smooth_below(&mut self, crease_angle: f32) {
        let least_cosine = crease_angle.to_radians().cos();
        if crease_angle <= 0.0 {
            return;
        }
        let facets: Vec<_> =
            (0..self.triangles.len()).map(|triangle| self.double_area_normal(triangle).normalize_or_zero()).collect();
        self.smooth(|a, b| facets[a].dot(facets[b]) > least_cosine);
    }

    /// Joins the corners at both ends of smooth edges; whether there are any.
    fn join_corners(&self, groups: &mut Groups, is_smooth: impl Fn(usize, usize) -> bool) -> bool {
        let welded = self.welded_vertices();
        let mut edges = Vec::with_capacity(3 * self.triangles.len());
        for (triangle, vertices) in self.triangles.iter().enumerate() {
            let vertices = vertices.map(|vertex| welded[vertex as usize]);
            for corner in 0..3 {
                let (from, to) = (vertices[corner], vertices[(corner + 1) % 3]);
                edges.push((from.min(to), from.max(to), 3 * triangle as u32 + corner as u32));
            }
        }
        edges.sort_unstable();
        let vertex_of = |corner: u32| welded[self.triangles[corner as usize / 3][corner as usize % 3] as usize];
        let next = |corner: u32| corner - corner % 3 + (corner + 1) % 3;
        let mut is_any_smooth = false;
        for shared in edges.chunk_by(|a, b| a.0 == b.0 && a.1 == b.1) {
            // Where more than two facets meet there is no telling which go together.
            let [(.., first), (.., second)] = *shared else { continue };
            // Facets that are wound against each other have opposite normals.
            let is_consistent = vertex_of(first) == vertex_of(next(second));
            if is_consistent && is_smooth(first as usize / 3, second as usize / 3) {
                groups.join(first, next(second));
                groups.join(next(first), second);
                is_any_smooth = true;
            }
        }
        is_any_smooth
    }

    /// A vertex for each vertex and group of corners, with the group's normal.
    fn set_normals(&mut self, groups: &mut Groups, sums: &[Vec3]) {
        const FREE: u32 = u32::MAX;
        let vertices = self.positions.len();
        // For each vertex the group that has it; groups beyond the first get vertices of their own.
        let mut holders = vec![FREE; vertices];
        let mut added = std::collections::HashMap::new();
        self.normals = vec![Vec3::Z; vertices];
        for triangle in 0..self.triangles.len() {
            let facet = self.double_area_normal(triangle).normalize_or(Vec3::Z);
            for corner in 0..3 {
                let group = groups.root(3 * triangle as u32 + corner as u32);
                let vertex = self.triangles[triangle][corner];
                let holder = &mut holders[vertex as usize];
                let normal = sums[group as usize].normalize_or(facet);
                if *holder == FREE || *holder == group {
                    *holder = group;
                    self.normals[vertex as usize] = normal;
                    continue;
                }
                self.triangles[triangle][corner] = *added.entry((vertex, group)).or_insert_with(|| {
                    self.positions.push(self.positions[vertex as usize]);
                    self.uvs.extend(self.uvs.get(vertex as usize).copied());
                    self.map_uvs.extend(self.map_uvs.get(vertex as usize).copied());
                    self.colors.extend(self.colors.get(vertex as usize).copied());
                    self.normals.push(normal);
                    self.positions.len() as u32 - 1
                });
            }
        }
    }
}

/// Disjoint sets of corners.
struct Groups {
    parents: Vec<u32>,
}

impl Groups {
    fn new(corners: usize) -> Self {
        Self { parents: (0..corners as u32).collect() }
    }

    /// The corner that stands for a corner's set.
    fn root(&mut self, mut corner: u32) -> u32 {
        while self.parents[corner as usize] != corner {
            let grandparent = self.parents[self.parents[corner as usize] as usize];
            self.parents[corner as usize] = grandparent;
            corner = grandparent;
        }
        corner
    }

    fn join(&mut self, a: u32, b: u32) {
        let (a, b) = (self.root(a), self.root(b));
        self.parents[a.max(b) as usize] = a.min(b);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cubes_stay_flat_and_spheres_become_smooth() {
        let flat = Mesh { normals: Vec::new(), ..Mesh::cuboid(Vec3::ZERO, Vec3::ONE) };
        let mut cube = flat.clone();
        cube.smooth_below(80.0);
        // The two triangles of a side are one facet: their normals are the side's.
        for triangle in 0..cube.triangles.len() {
            let facet = cube.double_area_normal(triangle).normalize();
            assert!(
                cube.triangles[triangle].iter().all(|vertex| cube.normals[*vertex as usize].distance(facet) < 1e-6)
            );
        }
        let round = Mesh::sphere(Vec3::ZERO, 1.0, 4);
        let mut sphere = Mesh { normals: Vec::new(), ..round.clone() };
        sphere.smooth_below(30.0);
        assert_eq!(sphere.positions, round.positions);
        for vertex in sphere.triangles.as_flattened() {
            let (normal, position) = (sphere.normals[*vertex as usize], sphere.positions[*vertex as usize]);
            assert!(normal.distance(position.normalize()) < 0.02, "{normal} at {position}");
        }
        let mut untouched = flat.clone();
        untouched.smooth_below(0.0);
        assert_eq!(untouched, flat);
    }

    #[test]
    fn a_crease_divides_the_corners_of_a_vertex() {
        // A roof of two slopes, each of two triangles, that share the vertices of the ridge.
        let positions = [[0, 0, 0], [2, 0, 0], [0, 1, 1], [2, 1, 1], [0, 0, 2], [2, 0, 2]];
        let positions = positions.map(|p: [i32; 3]| Vec3::from(p.map(|x| x as f32)));
        let triangles = vec![[0, 2, 1], [1, 2, 3], [2, 4, 3], [3, 4, 5]];
        let mut roof = Mesh { positions: positions.to_vec(), triangles, ..Mesh::default() };
        let mut round = roof.clone();
        roof.smooth_below(60.0);
        assert_eq!(roof.positions.len(), 8);
        assert!(roof.normals[0].abs_diff_eq(Vec3::new(0.0, 0.5f32.sqrt(), -0.5f32.sqrt()), 1e-6));
        round.smooth_below(100.0);
        assert_eq!((round.positions.len(), round.normals[2].distance(Vec3::Y) < 0.2), (6, true));
    }
}
