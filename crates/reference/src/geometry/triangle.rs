//! World-space triangles and how they face a ray.

use std::ops::{Add, Mul};

use diacaustic_scene::{Object, Scene};
use glam::{DMat3, DVec2, DVec3, Vec4Swizzles};

use super::{Hit, Ray};

/// How far outside a triangle its barycentric coordinates may lie: closes the seams between neighbours.
const SEAM: f64 = 1e-12;

/// A triangle of an object, in the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Triangle {
    /// Index of the object in the scene.
    pub object: usize,
    /// Index of the triangle in the object's mesh.
    pub index: usize,
    /// Corners in the mesh's order, metres.
    pub corners: [DVec3; 3],
    /// Unit normal on the side that the winding shows as outside in the object's frame; a mirroring placement keeps
    /// the side.
    pub normal_geometric: DVec3,
    /// Unit normals of the corners, or none on a flat mesh.
    pub normals: Option<[DVec3; 3]>,
    /// Texture coordinates of the corners, or none on a mesh without.
    pub uvs: Option<[DVec2; 3]>,
    /// Factors on the material's colour at the corners, or none on a mesh without vertex colours.
    pub colors: Option<[DVec3; 3]>,
    /// Factors on the material's opacity at the corners, or none on a mesh without.
    pub opacities: Option<[f64; 3]>,
    /// Of a triangle with a normal map, unit tangents at the corners along its picture's s, and their side.
    pub tangents: Option<([DVec3; 3], f64)>,
}

/// A surface point as a ray sees it: every normal is on the side that the ray comes from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Facing {
    /// The point, metres.
    pub point: DVec3,
    /// Whether the ray comes from the side of the triangle's own normal.
    pub front: bool,
    /// Unit normal of the triangle.
    pub normal_geometric: DVec3,
    /// Unit normal of the normal map; the one interpolated from the corners where there is none or it looks away from
    /// the ray; the geometric one on flat meshes and where that looks away as well.
    pub normal_shading: DVec3,
}

impl Triangle {
    /// Where a ray with this direction meets the triangle at `barycentric`. `mapped` is the normal map's normal, on the
    /// triangle's front.
    pub(super) fn facing(&self, barycentric: DVec3, direction: DVec3, mapped: Option<DVec3>) -> Facing {
        let front = direction.dot(self.normal_geometric) < 0.0;
        let side = if front { 1.0 } else { -1.0 };
        let normal_geometric = side * self.normal_geometric;
        let mut candidates = [mapped, self.interpolated_normal(barycentric)].into_iter().flatten().map(|n| side * n);
        let normal_shading = candidates.find(|n| -direction.dot(*n) > 0.0).unwrap_or(normal_geometric);
        Facing { point: weighted(self.corners, barycentric), front, normal_geometric, normal_shading }
    }

    /// The corners' normals between them, on the triangle's front, unit length; none on a flat mesh.
    pub(super) fn interpolated_normal(&self, barycentric: DVec3) -> Option<DVec3> {
        self.normals.and_then(|normals| weighted(normals, barycentric).try_normalize())
    }
}

/// A triangle as the intersection test wants it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Facet {
    pub(super) triangle: usize,
    corner: DVec3,
    edges: [DVec3; 2],
}

impl Facet {
    pub(super) fn new(triangle: usize, [a, b, c]: [DVec3; 3]) -> Self {
        Self { triangle, corner: a, edges: [b - a, c - a] }
    }

    /// Möller and Trumbore 1997, from both sides.
    pub(super) fn meet(&self, ray: &Ray) -> Option<Hit> {
        let [edge_1, edge_2] = self.edges;
        let p = ray.direction.cross(edge_2);
        let determinant = edge_1.dot(p);
        if determinant == 0.0 {
            return None;
        }
        let s = ray.origin - self.corner;
        let u = s.dot(p) / determinant;
        if !(-SEAM..=1.0 + SEAM).contains(&u) {
            return None;
        }
        let q = s.cross(edge_1);
        let v = ray.direction.dot(q) / determinant;
        if v < -SEAM || u + v > 1.0 + SEAM {
            return None;
        }
        let barycentric = DVec3::new(1.0 - u - v, u, v);
        let distance = edge_2.dot(q) / determinant;
        Some(Hit { triangle: self.triangle, distance, barycentric, takes_rest: false })
    }
}

/// Every triangle of the scene, in the order of the objects and of their meshes.
pub(super) fn flatten(scene: &Scene) -> Vec<Triangle> {
    scene.objects.iter().enumerate().flat_map(|(object, placed)| flatten_object(scene, object, placed)).collect()
}

fn flatten_object(scene: &Scene, object: usize, placed: &Object) -> Vec<Triangle> {
    let mesh = &placed.mesh;
    let world_from_object = placed.world_from_object.as_daffine3();
    let outward = world_from_object.matrix3.determinant().signum();
    let normal_from_object: DMat3 = world_from_object.matrix3.inverse().transpose();
    let tangents = placed.corner_tangents(&scene.materials);
    let place = |index: usize| {
        let corners = mesh.corners(index).map(|p| world_from_object.transform_point3(p.as_dvec3()));
        let [a, b, c] = corners;
        let normal_geometric = outward * (b - a).cross(c - a).normalize_or_zero();
        let normals = (!mesh.normals.is_empty()).then(|| {
            mesh.triangles[index]
                .map(|v| (normal_from_object * mesh.normals[v as usize].as_dvec3()).normalize_or_zero())
        });
        let uvs = (!mesh.uvs.is_empty()).then(|| mesh.triangles[index].map(|v| mesh.uvs[v as usize].as_dvec2()));
        let colors = mesh.colors.first().map(|_| mesh.triangles[index].map(|v| mesh.colors[v as usize].as_dvec3()));
        let opacities =
            mesh.opacities.first().map(|_| mesh.triangles[index].map(|v| f64::from(mesh.opacities[v as usize])));
        let tangents = tangents.get(index).and_then(|corners| {
            let along =
                corners.map(|tangent| (world_from_object.matrix3 * tangent.xyz().as_dvec3()).normalize_or_zero());
            let is_there = along.iter().all(|tangent| *tangent != DVec3::ZERO);
            is_there.then_some((along, outward * f64::from(corners[0].w)))
        });
        Triangle { object, index, corners, normal_geometric, normals, uvs, colors, opacities, tangents }
    };
    (0..mesh.triangles.len()).map(place).collect()
}

/// What three values at the corners are at a point.
pub(super) fn weighted<T: Add<Output = T>>(values: [T; 3], weights: DVec3) -> T
where
    f64: Mul<T, Output = T>,
{
    let [a, b, c] = values;
    weights.x * a + weights.y * b + weights.z * c
}

#[cfg(test)]
mod tests {
    use super::*;

    fn triangle(normals: Option<[DVec3; 3]>) -> Triangle {
        let corners = [DVec3::ZERO, DVec3::X, DVec3::Y];
        let (uvs, colors, opacities, tangents) = (None, None, None, None);
        Triangle { object: 0, index: 0, corners, normal_geometric: DVec3::Z, normals, uvs, colors, opacities, tangents }
    }

    #[test]
    fn meets_at_the_barycentric_point() {
        let ray = Ray { origin: DVec3::new(0.25, 0.5, 2.0), direction: -DVec3::Z };
        let hit = Facet::new(7, triangle(None).corners).meet(&ray).expect("the ray points into the triangle");
        assert_eq!((hit.triangle, hit.distance), (7, 2.0));
        assert_eq!(hit.barycentric, DVec3::new(0.25, 0.25, 0.5));
    }

    #[test]
    fn edge_belongs_to_both_neighbours() {
        let corners = [DVec3::ZERO, DVec3::X, DVec3::Y];
        let neighbour = [DVec3::X, DVec3::new(1.0, 1.0, 0.0), DVec3::Y];
        let ray = Ray { origin: DVec3::new(0.3, 0.7, 1.0), direction: -DVec3::Z };
        assert!(Facet::new(0, corners).meet(&ray).is_some() && Facet::new(1, neighbour).meet(&ray).is_some());
    }

    #[test]
    fn normals_turn_to_the_ray() {
        let leaning = DVec3::new(0.6, 0.0, 0.8);
        let smooth = triangle(Some([leaning; 3]));
        let third = DVec3::splat(1.0 / 3.0);
        let below = smooth.facing(third, DVec3::Z, None);
        assert!(!below.front);
        assert_eq!(below.normal_geometric, -DVec3::Z);
        assert!(below.normal_shading.distance(-leaning) < 1e-15);
    }

    #[test]
    fn shading_normal_that_looks_away_gives_way() {
        let leaning = DVec3::new(0.6, 0.0, 0.8);
        let grazing = DVec3::new(1.0, 0.0, -0.5).normalize();
        let third = DVec3::splat(1.0 / 3.0);
        let facing = triangle(Some([leaning; 3])).facing(third, grazing, None);
        assert!(facing.front);
        assert_eq!(facing.normal_shading, DVec3::Z);
        // A normal map's comes first, then the interpolated one.
        let (d, upright) = (DVec3::new(0.0, 0.6, -0.8), DVec3::new(0.0, 0.8, 0.6));
        let mapped = |n| triangle(Some([leaning; 3])).facing(third, d, Some(n)).normal_shading;
        assert_eq!(mapped(-DVec3::Y), -DVec3::Y);
        assert!(mapped(upright).distance(leaning) < 1e-15);
    }
}
