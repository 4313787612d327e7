//! Which dielectrics fill many points of space.

use std::time::Duration;

use diacaustic_scene::Scene;
use glam::{DVec3, Vec3};
use obvhs::{
    BvhBuildParams,
    cwbvh::{CwBvh, builder::build_cwbvh_from_tris},
    ray::Ray,
    triangle::Triangle,
};

/// Where rays go that count boundaries: no direction along which meshes are likely to have edges.
const DIRECTION: Vec3 = Vec3::new(0.381_966, 0.790_569, 0.478_714);

/// The boundaries of a scene's dielectrics, in a hierarchy, so that the media around a point are found by one ray.
pub struct DielectricBoundaries {
    /// None without dielectrics.
    bvh: Option<CwBvh>,
    /// In the order of the hierarchy's leaves. One that straddles a split may stand in it more than once.
    triangles: Vec<Boundary>,
    /// The material of each dielectric.
    materials: Vec<usize>,
}

/// A triangle of a boundary, world frame.
#[derive(Clone, Copy)]
struct Boundary {
    corners: [DVec3; 3],
    /// Its number among all boundaries' triangles.
    number: u32,
    /// Index of the dielectric.
    dielectric: u32,
}

impl DielectricBoundaries {
    /// Builds the hierarchy, on every core.
    ///
    /// # Panics
    /// If an index of the scene is out of range; a validated scene has none that is.
    pub fn new(scene: &Scene) -> Self {
        let (mut triangles, mut materials) = (Vec::new(), Vec::new());
        for object in &scene.objects {
            let Some((material, boundary)) = scene.dielectric_boundary(object) else { continue };
            let world = |vertex: u32| object.world_from_object.transform_point3(boundary.positions[vertex as usize]);
            for vertices in &boundary.triangles {
                triangles.push(Boundary {
                    corners: vertices.map(|vertex| world(vertex).as_dvec3()),
                    number: triangles.len() as u32,
                    dielectric: materials.len() as u32,
                });
            }
            materials.push(material);
        }
        if triangles.is_empty() {
            return Self { bvh: None, triangles, materials };
        }
        let corner = |p: DVec3| p.as_vec3().into();
        let convert =
            |t: &Boundary| Triangle { v0: corner(t.corners[0]), v1: corner(t.corners[1]), v2: corner(t.corners[2]) };
        let list: Vec<_> = triangles.iter().map(convert).collect();
        let bvh = build_cwbvh_from_tris(&list, BvhBuildParams::fast_build(), &mut Duration::default());
        let triangles = bvh.primitive_indices.iter().map(|&index| triangles[index as usize]).collect();
        Self { bvh: Some(bvh), triangles, materials }
    }

    /// The dielectrics around a point, world frame, as [`Scene::media_at`] has them, in time that grows with the logarithm of the triangles.
    pub fn media_at(&self, point: Vec3) -> Vec<usize> {
        let Some(bvh) = &self.bvh else { return Vec::new() };
        let mut crossings: Vec<(u32, u32, i32)> = Vec::new();
        bvh.ray_traverse_anyhit(Ray::new_inf(point.into(), DIRECTION.into()), |_, slot| {
            let triangle = &self.triangles[slot];
            let sign = crossing(point.as_dvec3(), DIRECTION.as_dvec3(), &triangle.corners);
            if sign != 0 {
                crossings.push((triangle.dielectric, triangle.number, sign));
            }
        });
        crossings.sort_unstable();
        crossings.dedup();
        let mut media = Vec::new();
        for of_one in crossings.chunk_by(|a, b| a.0 == b.0) {
            let turns = of_one.iter().map(|&(.., sign)| sign).sum::<i32>().unsigned_abs() as usize;
            media.extend(std::iter::repeat_n(self.materials[of_one[0].0 as usize], turns));
        }
        media
    }
}

/// 1 if the ray leaves through a triangle's front, −1 if it enters by it, 0 if it misses.
fn crossing(origin: DVec3, direction: DVec3, corners: &[DVec3; 3]) -> i32 {
    let [a, b, c] = corners.map(|corner| corner - origin);
    // Each edge's number is exactly the negative of its neighbour's, so that no ray slips through between two triangles.
    let side = |p: DVec3, q: DVec3| direction.dot(p.cross(q));
    let sides = [side(b, c), side(c, a), side(a, b)];
    let (all_left, all_right) = (sides.iter().all(|s| *s > 0.0), sides.iter().all(|s| *s < 0.0));
    if !all_left && !all_right {
        return 0;
    }
    let volume = a.dot(b.cross(c));
    let is_ahead = (volume > 0.0) == all_left;
    match (is_ahead, all_left) {
        (false, _) => 0,
        (true, true) => 1,
        (true, false) => -1,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use diacaustic_scene::parse_scene;

    const NESTED: &str = r#"
        [camera]
        position = [0, 0, 5]
        look_at = [0, 0, 0]
        vertical_fov = 40
        [materials.glass]
        type = "dielectric"
        ior = 1.5
        [materials.water]
        type = "dielectric"
        ior = 1.33
        [materials.matt]
        type = "diffuse"
        albedo = 0.5
        [[objects]]
        sphere = { center = [0.1, 0, 0], radius = 1 }
        material = "glass"
        [[objects]]
        box = { min = [-0.5, -0.5, -2], max = [0.5, 0.5, 2] }
        material = "water"
        [[objects]]
        box = { min = [-3, -3, -3], max = [3, -2, 3] }
        material = "matt"
    "#;

    #[test]
    fn media_are_those_of_winding_numbers() {
        let scene = parse_scene(NESTED, std::path::Path::new(""), "nested").unwrap().scene;
        let boundaries = DielectricBoundaries::new(&scene);
        let mut kinds = std::collections::HashSet::new();
        for i in 0..4000u32 {
            let number = |factor: f64| ((f64::from(i) * factor).fract() * 4.4 - 2.2) as f32;
            let point = Vec3::new(number(0.618_034), number(0.754_878), number(0.569_840));
            let found = boundaries.media_at(point);
            assert_eq!(found, scene.media_at(point), "{point}");
            kinds.insert(found);
        }
        assert_eq!(kinds.len(), 4, "{kinds:?}");
    }
}
