//! Meshes: all primitives of one as one list of triangles, with a slot for each material.

use std::collections::HashMap;

use glam::{Vec2, Vec3, Vec4};
use gltf_json::Root;

use super::{
    buffers::Buffers,
    fault::{Fault, Result, entry, place},
    pose::{Pose, Posed, PrimitivePose},
    primitives::{Corners, Needs},
    variants,
};
use crate::Mesh;

/// The most triangles of a file, over all its meshes.
pub(super) const MOST_TRIANGLES: usize = 1 << 27;

/// Vertex colours from which on are white, and whole.
const WHITE: f32 = 0.999;

/// The corner of a picture that shows where there are no texture coordinates.
const UPPER_LEFT: Vec2 = Vec2::Y;

/// A mesh, and for each of its slots the index of its material (none for the default one).
pub(super) struct SlottedMesh {
    pub(super) mesh: Mesh,
    pub(super) slots: Vec<Option<usize>>,
}

/// Reads meshes; holds what it found of interest.
pub(super) struct MeshReader<'a, 'b> {
    pub(super) root: &'a Root,
    pub(super) buffers: &'a Buffers<'b>,
    /// The variant that chooses materials.
    variant: Option<u64>,
    triangles_left: usize,
    pub(super) warnings: Vec<Fault>,
}

impl<'a, 'b> MeshReader<'a, 'b> {
    pub(super) fn new(root: &'a Root, buffers: &'a Buffers<'b>, variant: Option<u64>) -> Self {
        Self { root, buffers, variant, triangles_left: MOST_TRIANGLES, warnings: Vec::new() }
    }

    /// The mesh of an index, in a pose; none if it has no triangles. `needs_of` tells what a material asks of the corners.
    pub(super) fn read(
        &mut self,
        index: usize,
        pose: &Pose,
        user: &str,
        needs_of: impl Fn(Option<usize>) -> Result<Needs>,
    ) -> Result<Option<SlottedMesh>> {
        let source = entry(&self.root.meshes, "meshes", index, user)?;
        let mesh_place = place("meshes", index, source.name.as_deref());
        let mut builder = Builder::default();
        for (number, primitive) in source.primitives.iter().enumerate() {
            let place = format!("{mesh_place}.primitives[{number}]");
            let material = variants::material(primitive, self.variant, &place)?;
            let corners = Corners::read(self.root, self.buffers, primitive, needs_of(material)?, &place)?;
            let Some(corners) = corners else {
                self.warnings.push(Fault::new(place, "has points or lines, which are not shown"));
                continue;
            };
            self.take(corners.triangles.len(), &place)?;
            self.warn_of(&corners, &place);
            let pose = pose.of_primitive(self.root, self.buffers, primitive, corners.positions.count, &place)?;
            builder.add(corners, &pose, material, &place)?;
        }
        let (built, replaced) = builder.finish();
        if replaced > 0 {
            let problem = format!("has {replaced} corners without a usable normal; the facet's normal stands in");
            self.warnings.push(Fault::new(mesh_place, problem));
        }
        Ok(built)
    }

    fn take(&mut self, triangles: usize, place: &str) -> Result<()> {
        self.triangles_left = self.triangles_left.checked_sub(triangles).ok_or_else(|| {
            Fault::new(
                place,
                format!("brings the file to more than {MOST_TRIANGLES} triangles, the most that are read"),
            )
        })?;
        Ok(())
    }

    /// What of a primitive is not shown as it is meant.
    fn warn_of(&mut self, corners: &Corners<'_>, place: &str) {
        if let Some(set) = corners.needs.uv_set.filter(|_| corners.uvs.is_none()) {
            let problem = format!(
                "has no TEXCOORD_{set}, which the pictures of its material need; their upper left corner shows"
            );
            self.warnings.push(Fault::new(place, problem));
        }
    }
}

/// A mesh in the making. What all primitives so far lack takes no memory.
#[derive(Default)]
struct Builder {
    mesh: Mesh,
    slots: Vec<Option<usize>>,
    slot_numbers: HashMap<Option<usize>, u32>,
    /// Corners of primitives that have no normals at all.
    corners_without: usize,
}

impl Builder {
    fn add(
        &mut self,
        mut corners: Corners<'_>,
        pose: &PrimitivePose<'_>,
        material: Option<usize>,
        place: &str,
    ) -> Result<()> {
        let mut triangles = std::mem::take(&mut corners.triangles);
        if triangles.is_empty() {
            return Ok(());
        }
        let numbering = Numbering::of(&triangles, corners.positions.count);
        let first = self.mesh.positions.len();
        let vertices = first.saturating_add(numbering.used.len());
        if vertices >= u32::MAX as usize {
            return Err(Fault::new(place, "brings its mesh to 2^32 vertices; it must have fewer"));
        }
        self.add_vertices(&corners, pose, &numbering.used, place)?;
        if corners.normals.is_none() {
            self.corners_without += 3 * triangles.len();
        }
        triangles.iter_mut().flatten().for_each(|vertex| *vertex = first as u32 + numbering.number(*vertex));
        self.add_triangles(triangles, material);
        Ok(())
    }

    fn add_vertices(
        &mut self,
        corners: &Corners<'_>,
        pose: &PrimitivePose<'_>,
        used: &[u32],
        place: &str,
    ) -> Result<()> {
        let before = self.mesh.positions.len();
        self.make_room(corners, before + used.len());
        let mesh = &mut self.mesh;
        for (number, &vertex) in (before..).zip(used) {
            let vertex = vertex as usize;
            let normal = corners.normals.as_ref().map_or(Vec3::ZERO, |normals| Vec3::from(normals.numbers(vertex)));
            let tangent = corners.tangents.as_ref().map_or(Vec4::ZERO, |tangents| Vec4::from(tangents.numbers(vertex)));
            let position = Vec3::from(corners.positions.numbers(vertex));
            let posed = pose.apply(vertex, Posed { position, normal, tangent: tangent.truncate() });
            if !posed.position.is_finite() {
                return Err(not_finite("position", posed.position, vertex, place));
            }
            mesh.positions.push(posed.position);
            if let Some(stored) = mesh.normals.get_mut(number).filter(|_| posed.normal.is_finite()) {
                *stored = posed.normal;
            }
            if let Some(stored) = mesh.tangents.get_mut(number) {
                *stored = usable_tangent(posed.tangent, tangent.w);
            }
            add_color(mesh, number, corners, vertex, place)?;
            for (given, stored) in [(&corners.uvs, &mut mesh.uvs), (&corners.map_uvs, &mut mesh.map_uvs)] {
                let Some(given) = given else { continue };
                let [u, v] = given.numbers(vertex);
                // (0, 0) is a picture's upper left corner in glTF, and its lower left one here.
                stored[number] = Vec2::new(u, 1.0 - v);
                if !stored[number].is_finite() {
                    return Err(not_finite("texture coordinates", Vec2::new(u, v), vertex, place));
                }
            }
        }
        Ok(())
    }

    /// Makes room for what the mesh's vertices have, up to a number of them; what they lack has its usual value.
    fn make_room(&mut self, corners: &Corners<'_>, vertices: usize) {
        let Mesh { positions, normals, uvs, map_uvs, colors, opacities, tangents, .. } = &mut self.mesh;
        positions.reserve_exact(vertices - positions.len());
        extend(normals, corners.normals.is_some(), vertices, Vec3::ZERO);
        extend(uvs, corners.uvs.is_some() || corners.needs.uv_set.is_some(), vertices, UPPER_LEFT);
        extend(map_uvs, corners.map_uvs.is_some(), vertices, UPPER_LEFT);
        extend(colors, corners.colors.is_some(), vertices, Vec3::ONE);
        extend(opacities, corners.colors.is_some() && corners.needs.has_coverage, vertices, 1.0);
        extend(tangents, corners.tangents.is_some(), vertices, Vec4::ZERO);
    }

    fn add_triangles(&mut self, triangles: Vec<[u32; 3]>, material: Option<usize>) {
        let before = self.mesh.triangles.len();
        let slot = self.slot(material);
        if slot > 0 || !self.mesh.triangle_slots.is_empty() {
            self.mesh.triangle_slots.resize(before, 0);
            self.mesh.triangle_slots.resize(before + triangles.len(), slot);
        }
        if before == 0 {
            self.mesh.triangles = triangles;
        } else {
            self.mesh.triangles.extend(triangles);
        }
    }

    fn slot(&mut self, material: Option<usize>) -> u32 {
        *self.slot_numbers.entry(material).or_insert_with(|| {
            self.slots.push(material);
            self.slots.len() as u32 - 1
        })
    }

    /// The mesh, if it has triangles, and how many corners have unusable normals.
    fn finish(mut self) -> (Option<SlottedMesh>, usize) {
        let mut replaced = 0;
        if !self.mesh.normals.is_empty() {
            replaced = self.mesh.replace_unusable_normals().saturating_sub(self.corners_without);
        }
        let Self { mut mesh, slots, .. } = self;
        if mesh.colors.iter().all(|color| color.min_element() > WHITE) {
            mesh.colors = Vec::new();
        }
        if mesh.opacities.iter().all(|opacity| *opacity > WHITE) {
            mesh.opacities = Vec::new();
        }
        ((!mesh.triangles.is_empty()).then_some(SlottedMesh { mesh, slots }), replaced)
    }
}

/// Gives a list that some vertices need one entry for each.
fn extend<T: Clone>(list: &mut Vec<T>, is_needed: bool, vertices: usize, usual: T) {
    if is_needed || !list.is_empty() {
        list.resize(vertices, usual);
    }
}

/// Colour and coverage of a vertex, if it has any.
fn add_color(mesh: &mut Mesh, number: usize, corners: &Corners<'_>, vertex: usize, place: &str) -> Result<()> {
    let Some(colors) = &corners.colors else { return Ok(()) };
    let color = colors.at(vertex);
    if !color.is_finite() {
        return Err(not_finite("vertex colour", color, vertex, place));
    }
    mesh.colors[number] = color.truncate();
    if corners.needs.has_coverage {
        mesh.opacities[number] = color.w;
    }
    Ok(())
}

/// A tangent with its side; 0, for one that is made, where it is none.
fn usable_tangent(tangent: Vec3, side: f32) -> Vec4 {
    let is_side = side.is_finite() && side != 0.0;
    let unit = tangent.try_normalize().filter(|_| is_side);
    unit.map_or(Vec4::ZERO, |tangent| tangent.extend(side.signum()))
}

fn not_finite(what: &str, found: impl std::fmt::Display, vertex: usize, place: &str) -> Fault {
    Fault::new(place, format!("has the {what} {found} at vertex {vertex}; all numbers must be finite"))
}

/// The vertices that triangles use, in rising order, and the number of each among them.
struct Numbering {
    used: Vec<u32>,
    numbers: Numbers,
}

enum Numbers {
    /// By vertex.
    All(Vec<u32>),
    /// Of a few of many vertices.
    Few(HashMap<u32, u32>),
}

impl Numbering {
    /// Takes memory in proportion to the triangles, however many vertices there are.
    fn of(triangles: &[[u32; 3]], vertices: usize) -> Self {
        let corners = triangles.as_flattened();
        if vertices > 4 * corners.len() {
            let mut used = corners.to_vec();
            used.sort_unstable();
            used.dedup();
            let numbers = used.iter().copied().zip(0..).collect();
            return Self { used, numbers: Numbers::Few(numbers) };
        }
        let mut numbers = vec![0; vertices];
        corners.iter().for_each(|vertex| numbers[*vertex as usize] = 1);
        let mut used = Vec::new();
        for (vertex, number) in numbers.iter_mut().enumerate().filter(|(_, number)| **number == 1) {
            *number = used.len() as u32;
            used.push(vertex as u32);
        }
        Self { used, numbers: Numbers::All(numbers) }
    }

    fn number(&self, vertex: u32) -> u32 {
        match &self.numbers {
            Numbers::All(numbers) => numbers[vertex as usize],
            Numbers::Few(numbers) => numbers[&vertex],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn unused_vertices_are_left_out() {
        for vertices in [6, 1000] {
            let numbering = Numbering::of(&[[5, 1, 2]], vertices);
            assert_eq!(numbering.used, [1, 2, 5]);
            assert_eq!([5, 1, 2].map(|vertex| numbering.number(vertex)), [2, 0, 1]);
        }
    }
}
