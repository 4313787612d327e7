//! Indexed triangle meshes in object space.

use glam::{Vec2, Vec3};

/// The square of the length below which a normal is taken for a missing one.
const SHORTEST_NORMAL_SQUARED: f32 = 1e-20;

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
    /// The texture coordinates if they do not overlap, else a planar projection.
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
                    self.normals.push(facet);
                } else {
                    self.normals[vertex] = facet;
                }
            }
        }
        replaced
    }

    /// The number of edges that do not join exactly two triangles of opposite direction, after welding vertices
    /// of equal position. 0 for a closed, consistently wound surface.
    pub fn open_edges(&self) -> usize {
        let mut ids = std::collections::HashMap::new();
        let welded: Vec<u32> = self
            .positions
            .iter()
            .map(|p| {
                // Adding 0 turns -0 into +0, so that both weld.
                let key = (*p + Vec3::ZERO).to_array().map(f32::to_bits);
                let next = ids.len() as u32;
                *ids.entry(key).or_insert(next)
            })
            .collect();
        let mut balance = std::collections::HashMap::<(u32, u32), (i32, u32)>::new();
        for corners in &self.triangles {
            let v = corners.map(|vertex| welded[vertex as usize]);
            for (a, b) in [(v[0], v[1]), (v[1], v[2]), (v[2], v[0])] {
                let (key, direction) = if a < b { ((a, b), 1) } else { ((b, a), -1) };
                let entry = balance.entry(key).or_default();
                entry.0 += direction;
                entry.1 += 1;
            }
        }
        balance.values().filter(|&&(sum, uses)| sum != 0 || uses % 2 != 0).count()
    }
}
