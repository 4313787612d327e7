//! The scene's triangles in the world frame.

use diacaustic_scene::{Object, Scene};
use glam::{Mat3, Vec2, Vec3};

/// A triangle of the scene, world frame, metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WorldTriangle {
    /// The corners; counter-clockwise from outside, also where the object's placement mirrors it.
    pub corners: [Vec3; 3],
    /// Unit normals at the corners, or none for a flat facet.
    pub normals: Option<[Vec3; 3]>,
    /// Texture coordinates at the corners, if the mesh has any.
    pub uvs: Option<[Vec2; 3]>,
    /// Index of the object.
    pub object: u32,
    /// Index of the triangle in the object's mesh.
    pub triangle: u32,
    /// Index of the material.
    pub material: u32,
    /// Whether the second and third corner are exchanged against the mesh.
    pub exchanged: bool,
}

impl WorldTriangle {
    /// Twice the area times the unit normal, m².
    pub fn double_area_normal(&self) -> Vec3 {
        (self.corners[1] - self.corners[0]).cross(self.corners[2] - self.corners[0])
    }

    /// The triangle's values of something that its mesh's corners carry, in the order of `corners`.
    pub fn arrange<T: Copy>(&self, [a, b, c]: [T; 3]) -> [T; 3] {
        if self.exchanged { [a, c, b] } else { [a, b, c] }
    }
}

/// Every triangle with an area, object by object.
pub fn world_triangles(scene: &Scene) -> Vec<WorldTriangle> {
    let count = scene.objects.iter().map(|object| object.mesh.triangles.len()).sum();
    let mut triangles = Vec::with_capacity(count);
    for (index, object) in scene.objects.iter().enumerate() {
        triangles.extend(object_triangles(index as u32, object).filter(|t| t.double_area_normal() != Vec3::ZERO));
    }
    triangles
}

fn object_triangles(index: u32, object: &Object) -> impl Iterator<Item = WorldTriangle> + '_ {
    let linear = Mat3::from(object.world_from_object.matrix3);
    let mirrored = linear.determinant() < 0.0;
    // Normals transform by the inverse transpose; a mirrored placement turns the triangles, not the normals.
    let normal_matrix = linear.inverse().transpose();
    let mesh = &object.mesh;
    mesh.triangles.iter().enumerate().map(move |(number, vertices)| {
        let mut triangle = WorldTriangle {
            corners: vertices.map(|v| object.world_from_object.transform_point3(mesh.positions[v as usize])),
            normals: (!mesh.normals.is_empty())
                .then(|| vertices.map(|v| (normal_matrix * mesh.normals[v as usize]).normalize_or_zero())),
            uvs: (!mesh.uvs.is_empty()).then(|| vertices.map(|v| mesh.uvs[v as usize])),
            object: index,
            triangle: number as u32,
            material: object.material_of(number) as u32,
            exchanged: mirrored,
        };
        triangle.corners = triangle.arrange(triangle.corners);
        triangle.normals = triangle.normals.map(|normals| triangle.arrange(normals));
        triangle.uvs = triangle.uvs.map(|uvs| triangle.arrange(uvs));
        triangle
    })
}
