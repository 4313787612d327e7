//! A mesh from an OBJ file's statements.

use std::path::Path;

use glam::{Vec2, Vec3};

use super::statements::{Corner, NONE, Statements};
use crate::{Mesh, Warning};

/// The mesh, with normals for faces that have none where edges are no creases: by smoothing groups if the file has some, else by the
/// angle, degrees.
pub(super) fn build(mut statements: Statements, path: &Path, crease_angle: f32, warnings: &mut Vec<Warning>) -> Mesh {
    note(&statements, path, warnings);
    let smoothing = std::mem::take(&mut statements.smoothing);
    let has_normals = statements.corners.as_flattened().iter().any(|corner| corner[2] != NONE);
    let mut mesh = merge_corners(statements, has_normals);
    if has_normals {
        let replaced = mesh.replace_unusable_normals();
        if replaced > 0 {
            warnings.push(Warning::ReplacedNormals { path: path.to_owned(), count: replaced });
        }
    } else if smoothing.is_empty() {
        mesh.smooth_below(crease_angle);
    } else if crease_angle > 0.0 {
        mesh.smooth(|a, b| smoothing[a] != 0 && smoothing[a] == smoothing[b]);
    }
    mesh
}

fn note(statements: &Statements, path: &Path, warnings: &mut Vec<Warning>) {
    let Statements { without_texcoord, face_corners, skipped_faces, .. } = *statements;
    if without_texcoord > 0 && without_texcoord < face_corners {
        let (count, corners) = (without_texcoord, face_corners);
        warnings.push(Warning::PartialTexcoords { path: path.to_owned(), count, corners });
    }
    if skipped_faces > 0 {
        warnings.push(Warning::SkippedFaces { path: path.to_owned(), count: skipped_faces });
    }
}

/// One vertex for all corners of the same indices.
fn merge_corners(statements: Statements, has_normals: bool) -> Mesh {
    let Statements { positions, texcoords, normals, corners, slots, slot_names, without_texcoord, .. } = statements;
    let has_uvs = without_texcoord == 0;
    let mut vertices = Vertices { first: vec![NONE; positions.len()], next: Vec::new(), of: Vec::new() };
    let kept = |[position, uv, normal]: Corner| {
        [position, if has_uvs { uv } else { NONE }, if has_normals { normal } else { NONE }]
    };
    let triangles = corners.iter().map(|triangle| triangle.map(|corner| vertices.number(kept(corner)))).collect();
    drop(corners);
    let Vertices { of, .. } = vertices;
    let normal = |index: u32| normals.get(index as usize).copied().unwrap_or(Vec3::ZERO);
    let uv = |index: u32| texcoords.get(index as usize).copied().unwrap_or(Vec2::ZERO);
    let material_slots = if slot_names.iter().any(|name| !name.is_empty()) { slot_names } else { Vec::new() };
    Mesh {
        positions: of.iter().map(|[position, ..]| positions[*position as usize]).collect(),
        normals: if has_normals { of.iter().map(|[.., index]| normal(*index)).collect() } else { Vec::new() },
        uvs: if has_uvs { of.iter().map(|[_, index, _]| uv(*index)).collect() } else { Vec::new() },
        triangles,
        triangle_slots: if material_slots.len() > 1 { slots } else { Vec::new() },
        material_slots,
        ..Mesh::default()
    }
}

/// Vertices so far; those of a position form a list.
struct Vertices {
    /// The last vertex of each position.
    first: Vec<u32>,
    /// The vertex before each one of the same position.
    next: Vec<u32>,
    /// The indices of each vertex.
    of: Vec<Corner>,
}

impl Vertices {
    fn number(&mut self, corner: Corner) -> u32 {
        let head = self.first[corner[0] as usize];
        let mut vertex = head;
        // A position with very many vertices is no mesh's; its later ones may stand twice.
        for _ in 0..64 {
            if vertex == NONE {
                break;
            }
            if self.of[vertex as usize] == corner {
                return vertex;
            }
            vertex = self.next[vertex as usize];
        }
        let number = self.of.len() as u32;
        self.of.push(corner);
        self.next.push(head);
        self.first[corner[0] as usize] = number;
        number
    }
}
