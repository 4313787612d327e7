//! Tangents at the corners of triangles with normal maps: those of the mesh, and else those of MikkTSpace (Mikkelsen 2008), as glTF asks.

use std::collections::HashMap;

use bevy_mikktspace::{Geometry, TangentSpace, generate_tangents};
use glam::{Affine2, Mat2, Vec2, Vec3, Vec4, Vec4Swizzles};

use crate::{Material, Mesh, Object};

/// The most triangles at one vertex for which its tangent is made: making it takes time in proportion to their square, and a stack as deep as they are many.
const MOST_TRIANGLES_AT_VERTEX: u32 = 1024;

impl Object {
    /// For each triangle of the mesh, tangents at its corners along which its normal map's picture lies, object frame: of unit length along
    /// the picture's s, and in w the side (1 or −1) of normal × tangent on which its t grows. 0 for a triangle without normal map, and where
    /// the picture is squeezed to a line. Empty if no material has a normal map.
    ///
    /// # Panics
    /// If the object is not one of a validated scene of these materials.
    pub fn corner_tangents(&self, materials: &[Material]) -> Vec<[Vec4; 3]> {
        let mesh = &*self.mesh;
        let map_of = |triangle| materials[self.material_of(triangle)].normal_map();
        let has_maps = self.materials.iter().any(|index| materials[*index].normal_map().is_some());
        if mesh.uvs.is_empty() || !has_maps {
            return Vec::new();
        }
        let mut tangents = vec![[Vec4::ZERO; 3]; mesh.triangles.len()];
        let mut without = Vec::new();
        for (triangle, made) in tangents.iter_mut().enumerate() {
            let Some(map) = map_of(triangle) else { continue };
            let picture_from_uv = map.texture.picture_from_uv;
            if picture_area(mesh, triangle, picture_from_uv) == 0.0 {
                continue;
            }
            match stated(mesh, triangle, picture_from_uv.matrix2) {
                Some(stated) => *made = stated,
                None => without.push((triangle, picture_from_uv)),
            }
        }
        let mut wanting =
            Wanting { mesh, crowded: crowded(mesh, &without), triangles: without, tangents: &mut tangents };
        let Ok(()) = generate_tangents(&mut wanting) else { return tangents };
        wanting.make_crowded();
        tangents
    }
}

/// Places on a picture of a triangle's corners.
fn places(mesh: &Mesh, triangle: usize, picture_from_uv: Affine2) -> [Vec2; 3] {
    mesh.triangles[triangle].map(|vertex| picture_from_uv.transform_point2(mesh.uvs[vertex as usize]))
}

/// Twice the area of a triangle on a picture, negative where it is mirrored; 0 also where numbers overflow.
fn picture_area(mesh: &Mesh, triangle: usize, picture_from_uv: Affine2) -> f32 {
    let [a, b, c] = places(mesh, triangle, picture_from_uv);
    let area = (b - a).perp_dot(c - a);
    if area.is_finite() { area } else { 0.0 }
}

/// The mesh's own tangents of a triangle, turned from its texture coordinates to the picture's s.
fn stated(mesh: &Mesh, triangle: usize, picture_from_uv: Mat2) -> Option<[Vec4; 3]> {
    if mesh.tangents.is_empty() {
        return None;
    }
    let side = picture_from_uv.determinant().signum();
    // The columns of the inverse, but for its length: how u and v change along s.
    let (u, v) = (side * picture_from_uv.y_axis.y, -side * picture_from_uv.x_axis.y);
    let corners = mesh.triangles[triangle].map(|vertex| {
        let tangent = mesh.tangents[vertex as usize];
        let normal = mesh.normals.get(vertex as usize).copied().unwrap_or(Vec3::ZERO);
        let bitangent = tangent.w * normal.cross(tangent.xyz());
        (u * tangent.xyz() + v * bitangent).normalize_or_zero().extend(side * tangent.w)
    });
    corners.iter().all(|tangent| tangent.xyz() != Vec3::ZERO).then_some(corners)
}

/// Unit normal of a corner, or of the facet on a flat mesh.
fn normal(mesh: &Mesh, triangle: usize, corner: usize) -> Vec3 {
    let vertex = mesh.triangles[triangle][corner] as usize;
    mesh.normals.get(vertex).copied().unwrap_or_else(|| mesh.double_area_normal(triangle).normalize_or(Vec3::Z))
}

/// For each of the triangles, whether so many share a corner of its that no common tangent is made.
fn crowded(mesh: &Mesh, triangles: &[(usize, Affine2)]) -> Vec<bool> {
    let mut counts = HashMap::<[u32; 3], u32>::new();
    let key = |vertex: u32| (mesh.positions[vertex as usize] + Vec3::ZERO).to_array().map(f32::to_bits);
    for (triangle, _) in triangles {
        mesh.triangles[*triangle].iter().for_each(|vertex| *counts.entry(key(*vertex)).or_default() += 1);
    }
    let is_crowded = |vertex: &u32| counts[&key(*vertex)] > MOST_TRIANGLES_AT_VERTEX;
    triangles.iter().map(|(triangle, _)| mesh.triangles[*triangle].iter().any(is_crowded)).collect()
}

/// Triangles whose tangents are to be made, as faces of MikkTSpace.
struct Wanting<'a> {
    mesh: &'a Mesh,
    /// Each with what takes texture coordinates to its picture.
    triangles: Vec<(usize, Affine2)>,
    crowded: Vec<bool>,
    tangents: &'a mut [[Vec4; 3]],
}

impl Wanting<'_> {
    /// Gives the triangles at crowded vertices tangents of their own.
    fn make_crowded(&mut self) {
        for ((triangle, picture_from_uv), _) in
            self.triangles.iter().zip(&self.crowded).filter(|(_, crowded)| **crowded)
        {
            let [a, b, c] = self.mesh.corners(*triangle);
            let [p, q, r] = places(self.mesh, *triangle, *picture_from_uv);
            let side = (q - p).perp_dot(r - p).signum();
            let along_s = side * ((r - p).y * (b - a) - (q - p).y * (c - a));
            self.tangents[*triangle] = [along_s.normalize_or_zero().extend(side); 3];
        }
    }
}

impl Geometry for Wanting<'_> {
    fn num_faces(&self) -> usize {
        self.triangles.len()
    }

    fn num_vertices_of_face(&self, face: usize) -> usize {
        // Faces of no corners are passed over.
        if self.crowded[face] { 0 } else { 3 }
    }

    fn position(&self, face: usize, corner: usize) -> [f32; 3] {
        let vertex = self.mesh.triangles[self.triangles[face].0][corner];
        self.mesh.positions[vertex as usize].to_array()
    }

    fn normal(&self, face: usize, corner: usize) -> [f32; 3] {
        normal(self.mesh, self.triangles[face].0, corner).to_array()
    }

    fn tex_coord(&self, face: usize, corner: usize) -> [f32; 2] {
        let (triangle, picture_from_uv) = self.triangles[face];
        places(self.mesh, triangle, picture_from_uv)[corner].to_array()
    }

    fn set_tangent(&mut self, space: Option<TangentSpace>, face: usize, corner: usize) {
        let Some(space) = space else { return };
        let [x, y, z, side] = space.tangent_encoded();
        let tangent = Vec3::new(x, y, z);
        let is_sound = tangent.is_finite() && tangent != Vec3::ZERO;
        self.tangents[self.triangles[face].0][corner] = if is_sound { tangent.extend(side) } else { Vec4::ZERO };
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use glam::Affine3A;
    use half::f16;
    use proptest::prelude::*;

    use super::*;
    use crate::{MaterialKind, NormalMap, Texture, TextureImage};

    fn material(picture_from_uv: Affine2) -> Material {
        let image = TextureImage::new(1, 1, vec![[f16::ONE; 4]]).unwrap();
        let texture = Texture { picture_from_uv, ..Texture::new(Arc::new(image)) };
        let mut material = Material::new("bumpy", MaterialKind::Diffuse { albedo: Vec3::ONE });
        material.textures.normal = Some(NormalMap { texture, strength: 1.0 });
        material
    }

    fn tangents(mesh: Mesh, picture_from_uv: Affine2) -> Vec<[Vec4; 3]> {
        let object = Object {
            name: "it".to_owned(),
            mesh: Arc::new(mesh),
            world_from_object: Affine3A::IDENTITY,
            materials: vec![0],
            map_size: None,
        };
        object.corner_tangents(&[material(picture_from_uv)])
    }

    /// Two triangles of a square in the plane z = 0, with these texture coordinates.
    fn square(uvs: [Vec2; 4]) -> Mesh {
        let positions = [[0, 0], [1, 0], [1, 1], [0, 1]].map(|[x, y]| Vec3::new(x as f32, y as f32, 0.0));
        Mesh { positions: positions.into(), uvs: uvs.into(), triangles: vec![[0, 1, 2], [0, 2, 3]], ..Mesh::default() }
    }

    const UPRIGHT: [Vec2; 4] = [Vec2::ZERO, Vec2::X, Vec2::ONE, Vec2::Y];

    fn all_near(found: &[[Vec4; 3]], expected: Vec4) {
        for tangent in found.as_flattened() {
            assert!(tangent.abs_diff_eq(expected, 1e-6), "{tangent}, not {expected}");
        }
    }

    #[test]
    fn tangents_follow_the_picture() {
        all_near(&tangents(square(UPRIGHT), Affine2::IDENTITY), Vec4::new(1.0, 0.0, 0.0, 1.0));
        let mirrored = UPRIGHT.map(|uv| Vec2::new(-uv.x, uv.y));
        all_near(&tangents(square(mirrored), Affine2::IDENTITY), Vec4::new(-1.0, 0.0, 0.0, -1.0));
        // s = v, t = −u.
        let turned = Affine2::from_cols(Vec2::NEG_Y, Vec2::X, Vec2::ZERO);
        all_near(&tangents(square(UPRIGHT), turned), Vec4::new(0.0, 1.0, 0.0, 1.0));
    }

    #[test]
    fn stated_tangents_go_first_and_turn_with_the_picture() {
        let stated = Vec4::new(0.6, 0.8, 0.0, -1.0);
        let mesh = Mesh { normals: vec![Vec3::Z; 4], tangents: vec![stated; 4], ..square(UPRIGHT) };
        all_near(&tangents(mesh.clone(), Affine2::IDENTITY), stated);
        // v grows along −Z × T = (0.8, −0.6, 0), and with s = v the picture does.
        let turned = Affine2::from_cols(Vec2::NEG_Y, Vec2::X, Vec2::ZERO);
        all_near(&tangents(mesh.clone(), turned), Vec4::new(0.8, -0.6, 0.0, -1.0));
        let mirrored = Affine2::from_cols(Vec2::NEG_X, Vec2::Y, Vec2::ZERO);
        all_near(&tangents(mesh.clone(), mirrored), Vec4::new(-0.6, -0.8, 0.0, 1.0));
        let without = Mesh { tangents: vec![Vec4::ZERO; 4], ..mesh };
        all_near(&tangents(without, Affine2::IDENTITY), Vec4::new(1.0, 0.0, 0.0, 1.0));
    }

    #[test]
    fn smooth_triangles_share_tangents_weighed_by_their_angles() {
        // A roof: along x on its left half u grows by 1 a metre, on its right half across as well.
        let positions = vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::new(-1.0, 0.0, 0.0)];
        let uvs = vec![Vec2::ZERO, Vec2::X, Vec2::Y, Vec2::new(0.0, -1.0)];
        let triangles = vec![[0, 1, 2], [0, 2, 3]];
        let mesh = Mesh { normals: vec![Vec3::Z; 4], positions, uvs, triangles, ..Mesh::default() };
        let [right, left] = tangents(mesh, Affine2::IDENTITY).try_into().unwrap();
        // The second triangle has no area on the picture, and stays as it is.
        assert_eq!(left, [Vec4::ZERO; 3]);
        assert!(right[1].abs_diff_eq(Vec4::new(1.0, 0.0, 0.0, 1.0), 1e-6));
        let shear = vec![Vec2::ZERO, Vec2::X, Vec2::Y, Vec2::new(-1.0, 1.0)];
        let positions = vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::new(-1.0, 0.0, 0.0)];
        let mesh = Mesh {
            normals: vec![Vec3::Z; 4],
            positions,
            uvs: shear,
            triangles: vec![[0, 1, 2], [0, 2, 3]],
            ..Mesh::default()
        };
        let [right, left] = tangents(mesh, Affine2::IDENTITY).try_into().unwrap();
        // Of the left one ∂P/∂u = (1, 1, 0)/√2; at the corner that both share at right angles, the mean is half way.
        let mean = (Vec3::X + Vec3::new(1.0, 1.0, 0.0).normalize()).normalize();
        assert!(right[0].xyz().abs_diff_eq(mean, 1e-6) && left[0] == right[0], "{right:?} {left:?}");
        assert!(right[1].xyz().abs_diff_eq(Vec3::X, 1e-6));
    }

    #[test]
    fn a_crowd_around_a_vertex_takes_no_time() {
        let count = 200_000;
        let rim = (0..count).map(|k| Vec3::new((k as f32 * 1e-4).cos(), (k as f32 * 1e-4).sin(), 0.0));
        let positions: Vec<_> = std::iter::once(Vec3::ZERO).chain(rim).collect();
        let uvs = positions.iter().map(|position| position.truncate()).collect();
        let triangles = (1..count as u32 - 1).map(|k| [0, k, k + 1]).collect();
        let mesh = Mesh { normals: vec![Vec3::Z; positions.len()], positions, uvs, triangles, ..Mesh::default() };
        for tangent in tangents(mesh, Affine2::IDENTITY).as_flattened() {
            assert!(tangent.abs_diff_eq(Vec4::new(1.0, 0.0, 0.0, 1.0), 1e-2), "{tangent}");
        }
    }

    proptest! {
        /// Few places, so that triangles are often degenerate, doubled or turned.
        #[test]
        fn any_mesh_gets_unit_tangents_or_none(
            corners in prop::collection::vec((0..3i8, 0..3i8, 0..2i8, 0..3i8, 0..3i8), 3..9),
            triangles in prop::collection::vec([0..8usize, 0..8usize, 0..8usize], 1..12),
            scale in prop::sample::select(vec![1.0f32, 1e-20, 1e9]),
        ) {
            let vertex = |index: usize| (index % corners.len()) as u32;
            let mesh = Mesh {
                positions: corners.iter().map(|c| scale * Vec3::new(c.0.into(), c.1.into(), c.2.into())).collect(),
                uvs: corners.iter().map(|c| scale * Vec2::new(c.3.into(), c.4.into())).collect(),
                triangles: triangles.iter().map(|corners| corners.map(vertex)).collect(),
                normals: vec![Vec3::Z; corners.len()],
                ..Mesh::default()
            };
            for tangent in tangents(mesh, Affine2::IDENTITY).as_flattened() {
                let length = tangent.xyz().length();
                prop_assert!(*tangent == Vec4::ZERO || (length - 1.0).abs() < 1e-3 && tangent.w.abs() == 1.0, "{}", tangent);
            }
        }
    }
}
