//! Which dielectrics fill a point of space.

use glam::Vec3;

use crate::{MaterialKind, Mesh, Object, Scene};

impl Scene {
    /// The dielectrics around a point, as indices into [`Scene::materials`]: one entry for each time that an object's boundary
    /// winds around it, so that overlapping shells of one object count separately.
    ///
    /// # Panics
    /// If an index of the scene is out of range; a validated scene has none that is.
    pub fn media_at(&self, point: Vec3) -> Vec<usize> {
        let mut media = Vec::new();
        for object in &self.objects {
            let place = object.world_from_object.inverse().transform_point3(point);
            // Most points lie outside most objects, which the mesh's bounds tell without its boundary.
            if !is_within_bounds(&object.mesh, place) {
                continue;
            }
            let Some((material, boundary)) = self.dielectric_boundary(object) else { continue };
            let turns = boundary.winding_number(place).abs().round() as usize;
            media.extend(std::iter::repeat_n(material, turns));
        }
        media
    }

    /// Where volumes overlap, the dielectric of the highest rank fills the place. Ranks differ and count from 0, the lowest; a
    /// material that is no dielectric has none.
    pub fn dielectric_rank(&self, material: usize) -> Option<u32> {
        let precedence = |index: usize| match self.materials.get(index)?.kind {
            // Among equals the material listed first is higher.
            MaterialKind::Dielectric { priority, .. } => Some((priority, std::cmp::Reverse(index))),
            _ => None,
        };
        let own = precedence(material)?;
        Some((0..self.materials.len()).filter_map(precedence).filter(|other| *other < own).count() as u32)
    }

    /// An object's dielectric, if it has one, as an index into [`Scene::materials`], and the surface that bounds it, object frame: its
    /// dielectric triangles if they close by themselves or with the rest do not, else all of its triangles.
    ///
    /// # Panics
    /// If an index of the object is out of range; a validated scene has none that is.
    pub fn dielectric_boundary(&self, object: &Object) -> Option<(usize, Mesh)> {
        let material = object.materials.iter().copied().find(|m| self.is_dielectric(*m))?;
        let all = 0..object.mesh.triangles.len();
        let part: Vec<_> =
            all.filter(|t| self.is_dielectric(object.material_of(*t))).map(|t| object.mesh.triangles[t]).collect();
        if part.is_empty() {
            return None;
        }
        let surface = |triangles| Mesh { positions: object.mesh.positions.clone(), triangles, ..Mesh::default() };
        let part = surface(part);
        if part.open_edges() == 0 || object.mesh.open_edges() > 0 {
            return Some((material, part));
        }
        Some((material, surface(object.mesh.triangles.clone())))
    }

    fn is_dielectric(&self, material: usize) -> bool {
        matches!(self.materials[material].kind, MaterialKind::Dielectric { .. })
    }
}

/// Whether a point of the object frame lies in the box around a mesh.
fn is_within_bounds(mesh: &Mesh, point: Vec3) -> bool {
    let lowest = mesh.positions.iter().copied().fold(Vec3::INFINITY, Vec3::min);
    let highest = mesh.positions.iter().copied().fold(Vec3::NEG_INFINITY, Vec3::max);
    point.cmpge(lowest).all() && point.cmple(highest).all()
}
