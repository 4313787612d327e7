//! Indexed triangle meshes in object space.

use std::cmp::Ordering;

use glam::{Vec2, Vec3, Vec4};

/// The square of the length below which a normal is taken for a missing one.
const SHORTEST_NORMAL_SQUARED: f32 = 1e-20;

/// From how many triangles on edges are counted in passes, and in how many.
const LARGE: usize = 1 << 17;
const PASSES: u32 = 8;

/// An indexed triangle mesh in its object's frame, in metres.
///
/// Triangles are counter-clockwise seen from outside. A vertex is a (position, normal, uv) triple: a position that
/// carries two normals stands in the list twice.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// Vertex positions, metres, object frame.
    pub positions: Vec<Vec3>,
    /// Unit vertex normals, one for each position, or empty for flat facets.
    pub normals: Vec<Vec3>,
    /// Texture coordinates, one for each position, or empty. (0, 0) is a picture's lower left corner, (1, 1) its upper right one.
    pub uvs: Vec<Vec2>,
    /// A second set of texture coordinates, one for each position, for the energy map alone; or empty.
    pub map_uvs: Vec<Vec2>,
    /// Factors on the material's colour, linear Rec. 709, 0 to 1 in each channel, one for each position, or empty.
    pub colors: Vec<Vec3>,
    /// Factors on the material's opacity, 0 to 1, one for each position, or empty. Dielectrics take none of it.
    pub opacities: Vec<f32>,
    /// Unit tangents for normal maps, one for each position, or empty: xyz along u of `uvs`, and w, the side (1 or −1) of normal × tangent on
    /// which v grows. Where one is 0, or there is none, they are [made](crate::Object::corner_tangents) of normals and texture coordinates.
    pub tangents: Vec<Vec4>,
    /// Vertex indices of each triangle.
    pub triangles: Vec<[u32; 3]>,
    /// For each triangle, its index into [`Mesh::material_slots`]; empty when there is one slot or none.
    pub triangle_slots: Vec<u32>,
    /// Names under which the file tells its materials apart (MTL names); empty when the file names none.
    pub material_slots: Vec<String>,
    /// How the mesh is laid out on its energy map.
    pub chart: Chart,
}

/// How a mesh's surface is mapped to the plane of its energy map.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Chart {
    /// A place for each position, which are known not to overlap and are in metres along the surface (the natural map of a
    /// rectangle or a box).
    Natural(Vec<Vec2>),
    /// The mesh's own texture coordinates, which must not overlap: `map_uvs`, or else `uvs`.
    Uvs,
    /// Charts that are grown on the surface.
    #[default]
    Automatic,
}

impl Mesh {
    /// The three corners of a triangle, object frame.
    ///
    /// # Panics
    /// If `triangle` or one of its indices is out of range; a validated mesh has none that is.
    pub fn corners(&self, triangle: usize) -> [Vec3; 3] {
        self.triangles[triangle].map(|vertex| self.positions[vertex as usize])
    }

    /// Twice the area of a triangle times its unit normal, m².
    pub fn double_area_normal(&self, triangle: usize) -> Vec3 {
        let [a, b, c] = self.corners(triangle);
        (b - a).cross(c - a)
    }

    /// Normalises the normals; corners without a usable one get a vertex of their own with the facet's normal.
    /// Returns the number of those corners.
    pub(crate) fn replace_unusable_normals(&mut self) -> usize {
        let usable: Vec<_> =
            self.normals.iter().map(|normal| normal.length_squared() > SHORTEST_NORMAL_SQUARED).collect();
        let mut is_taken = usable.clone();
        for normal in &mut self.normals {
            *normal = normal.normalize_or(Vec3::Z);
        }
        let mut replaced = 0;
        for triangle in 0..self.triangles.len() {
            let facet = self.double_area_normal(triangle).normalize_or(Vec3::Z);
            for corner in 0..3 {
                let vertex = self.triangles[triangle][corner] as usize;
                if usable.get(vertex).copied().unwrap_or(true) {
                    continue;
                }
                replaced += 1;
                if std::mem::replace(&mut is_taken[vertex], true) {
                    self.triangles[triangle][corner] = self.positions.len() as u32;
                    self.positions.push(self.positions[vertex]);
                    self.uvs.extend(self.uvs.get(vertex).copied());
                    self.map_uvs.extend(self.map_uvs.get(vertex).copied());
                    self.colors.extend(self.colors.get(vertex).copied());
                    self.opacities.extend(self.opacities.get(vertex).copied());
                    self.tangents.extend(self.tangents.get(vertex).map(|_| Vec4::ZERO));
                    self.normals.push(facet);
                } else {
                    self.normals[vertex] = facet;
                    if let Some(tangent) = self.tangents.get_mut(vertex) {
                        *tangent = Vec4::ZERO;
                    }
                }
            }
        }
        replaced
    }

    /// The number of edges that are not passed equally often in both directions, after welding vertices of equal position. 0 for a
    /// closed, consistently wound surface, also with triangles that welding makes a line or a point of.
    pub fn open_edges(&self) -> usize {
        let welded = self.welded_vertices();
        let passes = if self.triangles.len() < LARGE { 1 } else { PASSES };
        (0..passes).map(|pass| self.open_edges_of_pass(&welded, pass, passes)).sum()
    }

    /// Those of a part of the edges: a list of all of a large mesh would take as much memory as the mesh.
    fn open_edges_of_pass(&self, welded: &[u32], pass: u32, passes: u32) -> usize {
        let (mut upwards, mut downwards) = (Vec::new(), Vec::new());
        for corners in &self.triangles {
            let [a, b, c] = corners.map(|vertex| welded[vertex as usize]);
            for (from, to) in [(a, b), (b, c), (c, a)] {
                let (low, high) = (from.min(to), from.max(to));
                let edge = u64::from(low) << 32 | u64::from(high);
                match from.cmp(&to) {
                    _ if low % passes != pass => {}
                    Ordering::Less => upwards.push(edge),
                    Ordering::Greater => downwards.push(edge),
                    Ordering::Equal => {}
                }
            }
        }
        upwards.sort_unstable();
        downwards.sort_unstable();
        unequal_counts(&upwards, &downwards)
    }

    /// For each slot, whether its triangles by themselves are a closed surface, as [`open_edges`](Self::open_edges) tells.
    pub(crate) fn closed_slots(&self) -> Vec<bool> {
        if self.material_slots.len() < 2 {
            return vec![self.open_edges() == 0; self.material_slots.len()];
        }
        let welded = self.welded_vertices();
        let mut edges = Vec::with_capacity(3 * self.triangles.len());
        for (corners, slot) in self.triangles.iter().zip(&self.triangle_slots) {
            let [a, b, c] = corners.map(|vertex| welded[vertex as usize]);
            let sides = [(a, b), (b, c), (c, a)].into_iter().filter(|(from, to)| from != to);
            edges.extend(sides.map(|(from, to)| (*slot, from.min(to), from.max(to), from < to)));
        }
        edges.sort_unstable();
        let mut is_closed = vec![true; self.material_slots.len()];
        for passes in edges.chunk_by(|a, b| (a.0, a.1, a.2) == (b.0, b.1, b.2)) {
            is_closed[passes[0].0 as usize] &= 2 * passes.iter().filter(|pass| pass.3).count() == passes.len();
        }
        is_closed
    }

    /// The texture coordinates that [`Chart::Uvs`] takes.
    pub fn map_places(&self) -> &[Vec2] {
        if self.map_uvs.is_empty() { &self.uvs } else { &self.map_uvs }
    }

    /// For each vertex, the first in order of those that have its position.
    pub fn welded_vertices(&self) -> Vec<u32> {
        // Adding 0 turns -0 into +0, so that both weld.
        let key = |vertex: u32| (self.positions[vertex as usize] + Vec3::ZERO).to_array().map(f32::to_bits);
        let mut order: Vec<u32> = (0..self.positions.len() as u32).collect();
        order.sort_unstable_by_key(|vertex| (key(*vertex), *vertex));
        let mut welded = vec![0; order.len()];
        for same in order.chunk_by(|a, b| key(*a) == key(*b)) {
            same.iter().for_each(|vertex| welded[*vertex as usize] = same[0]);
        }
        welded
    }
}

/// How many of the values in two sorted lists are not equally often in both.
fn unequal_counts(first: &[u64], second: &[u64]) -> usize {
    let (mut runs, mut others) = (first.chunk_by(u64::eq).peekable(), second.chunk_by(u64::eq).peekable());
    let mut count = 0;
    loop {
        let order = match (runs.peek(), others.peek()) {
            (Some(run), Some(other)) => run[0].cmp(&other[0]),
            (Some(_), None) => Ordering::Less,
            (None, Some(_)) => Ordering::Greater,
            (None, None) => return count,
        };
        let run = if order.is_le() { runs.next() } else { None };
        let other = if order.is_ge() { others.next() } else { None };
        count += usize::from(run.map(<[u64]>::len) != other.map(<[u64]>::len));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slots_are_closed_by_themselves() {
        let cube = Mesh::cuboid(Vec3::ZERO, Vec3::ONE);
        let mut mesh = cube.clone();
        mesh.triangles.extend(&cube.triangles);
        mesh.triangle_slots = [vec![0; 12], vec![1; 12]].concat();
        mesh.material_slots = vec!["a".to_owned(), "b".to_owned()];
        assert_eq!(mesh.closed_slots(), [true, true]);
        mesh.triangle_slots[13] = 0;
        assert_eq!((mesh.closed_slots(), mesh.open_edges()), (vec![false, false], 0));
        mesh.triangle_slots[13] = 1;
        mesh.triangles[13] = [0, 0, 0];
        assert_eq!(mesh.closed_slots(), [true, false]);
    }

    #[test]
    fn open_edges_are_counted() {
        let mut mesh = Mesh::cuboid(Vec3::ZERO, Vec3::ONE);
        assert_eq!(mesh.open_edges(), 0);
        let removed = mesh.triangles.pop().unwrap();
        assert_eq!(mesh.open_edges(), 3);
        // Triangles without area close nothing and open nothing.
        mesh.triangles.extend([[0, 0, 1], [2, 2, 2]]);
        assert_eq!(mesh.open_edges(), 3);
        mesh.triangles.push([removed[1], removed[0], removed[2]]);
        assert_eq!(mesh.open_edges(), 3);
    }
}
