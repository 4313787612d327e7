//! Sets dielectrics that touch another surface a little into it, so that touching surfaces have an order.
//!
//! A ray leaves a surface from a point just off it and cannot meet a second surface in the same place. What touches is made to overlap
//! instead, and media decide what fills the overlap (docs/materials.md, "Media").

mod object_boxes;

use std::{
    collections::{HashMap, HashSet},
    time::Duration,
};

use diacaustic_scene::{MaterialKind, Scene};
use glam::Vec3;
use obvhs::{
    BvhBuildParams,
    aabb::Aabb,
    bvh2::{Bvh2, builder::build_bvh2_from_tris},
};

use rayon::prelude::*;

use self::object_boxes::{ObjectBoxes, around, box_of, grown};
use crate::{WorldTriangle, bvh::for_obvhs};

/// Share of a triangle's greatest coordinate or edge by which a ray's origin is moved off it: 2⁻¹⁹, `OFFSET_PER_METRE` of
/// shaders/geometry/surface.wgsl.
pub const RAY_OFFSET: f32 = 1.907_348_6e-6;
/// In ray offsets: what counts as touching.
const TOUCHING: f32 = 2.0;
/// In ray offsets: how far the first dielectric is set into what it touches.
const DEPTH: f32 = 6.0;
/// In ray offsets: what each further dielectric adds, so that those whose surfaces are flush part.
const DEPTH_STEP: f32 = 4.0;
/// Dielectrics after which the depths begin again.
const DEPTHS: usize = 8;
/// The least cosine between the direction of a vertex's shift and the normal of what it is set into.
const LEAST_COSINE: f32 = 0.3;

/// Moves the vertices of dielectric objects that touch another object's surface outwards, by some 10⁻⁵ of the coordinates there.
///
/// Vertices of one object in the same place stay together. Faces that touch where neither has a vertex on the other are not found.
pub fn separate_touching(scene: &Scene, triangles: &mut [WorldTriangle]) {
    let depths = depths(scene);
    let objects = triangles.chunk_by(|a, b| a.object == b.object).count();
    if depths.is_empty() || objects < 2 {
        return;
    }
    // No triangle counts as touched from farther.
    let reach = TOUCHING * RAY_OFFSET * triangles.par_iter().map(extent).reduce(|| 0.0, f32::max);
    let (vertices, others) = what_may_touch(triangles, &depths, reach);
    if vertices.is_empty() || others.is_empty() {
        return;
    }
    let bvh = build_bvh2_from_tris(&for_obvhs(&others), BvhBuildParams::very_fast_build(), &mut Duration::default());
    let shift = |(vertex, normal): (Vertex, Vec3)| {
        let (object, place) = vertex;
        let point = bits_to_point(place);
        let distance = depth_of_touch(&bvh, &others, object, (point, normal), reach, depths[&object])?;
        Some((vertex, normal * distance))
    };
    let shifts: HashMap<_, _> = vertices.into_par_iter().filter_map(shift).collect();
    if shifts.is_empty() {
        return;
    }
    triangles.par_iter_mut().filter(|t| depths.contains_key(&t.object)).for_each(|triangle| {
        for corner in &mut triangle.corners {
            *corner +=
                shifts.get(&(triangle.object, corner.to_array().map(f32::to_bits))).copied().unwrap_or(Vec3::ZERO);
        }
    });
}

/// The vertices of dielectric objects near the box of another object, with their unit normals outwards, and the triangles that they may
/// touch.
fn what_may_touch<'t>(
    triangles: &'t [WorldTriangle],
    depths: &HashMap<u32, f32>,
    reach: f32,
) -> (HashMap<Vertex, Vec3>, Vec<&'t WorldTriangle>) {
    // Twice the reach, so that rounding leaves nothing out.
    let objects = ObjectBoxes::new(triangles, 2.0 * reach);
    let that_meet = |counts: &(dyn Fn(u32) -> bool + Sync)| -> HashSet<u32> {
        let meets = |own: &&object_boxes::ObjectBox| {
            objects.any_meets(own.around, |other| other != own.object && counts(other))
        };
        objects.boxes.iter().filter(meets).map(|own| own.object).collect()
    };
    let (movable, touchable) = (that_meet(&|_| true), that_meet(&|other| depths.contains_key(&other)));
    let is_near = |t: &WorldTriangle| {
        let meets = |corner: Vec3| objects.any_meets(Aabb::from_point(corner.into()), |other| other != t.object);
        t.corners.into_iter().any(meets)
    };
    let may_move = |t: &&WorldTriangle| depths.contains_key(&t.object) && movable.contains(&t.object) && is_near(t);
    let near: Vec<_> = triangles.par_iter().filter(may_move).collect();
    let place = grown(around(near.par_iter().copied()), 2.0 * reach);
    let may_be_touched = |t: &&WorldTriangle| touchable.contains(&t.object) && place.intersect_aabb(&box_of(t));
    let others = triangles.par_iter().filter(may_be_touched).collect();
    (vertices(&near), others)
}

/// A place of an object's surface, by the bits of its coordinates.
type Vertex = (u32, [u32; 3]);

fn bits_to_point(bits: [u32; 3]) -> Vec3 {
    Vec3::from(bits.map(f32::from_bits))
}

/// For each object of dielectric, how deep it is set into what it touches, in ray offsets.
fn depths(scene: &Scene) -> HashMap<u32, f32> {
    let is_dielectric = |material: &usize| matches!(scene.materials[*material].kind, MaterialKind::Dielectric { .. });
    let objects = scene.objects.iter().enumerate().filter(|(_, object)| object.materials.iter().any(is_dielectric));
    objects
        .enumerate()
        .map(|(order, (object, _))| (object as u32, DEPTH + DEPTH_STEP * (order % DEPTHS) as f32))
        .collect()
}

/// The vertices of triangles and their unit normals, outwards.
fn vertices(triangles: &[&WorldTriangle]) -> HashMap<Vertex, Vec3> {
    let mut normals: HashMap<Vertex, Vec3> = HashMap::new();
    for triangle in triangles {
        let [a, b, c] = triangle.corners;
        let normal = triangle.double_area_normal().normalize_or_zero();
        // By angle, so that the normal does not depend on how faces are cut into triangles.
        for (at, before, after) in [(a, c, b), (b, a, c), (c, b, a)] {
            let angle = (before - at).angle_between(after - at);
            let vertex = (triangle.object, at.to_array().map(f32::to_bits));
            *normals.entry(vertex).or_default() += angle * normal;
        }
    }
    normals.values_mut().for_each(|normal| *normal = normal.normalize_or_zero());
    normals
}

/// How far a vertex moves along its normal, metres; none if it touches no other object.
fn depth_of_touch(
    bvh: &Bvh2,
    triangles: &[&WorldTriangle],
    object: u32,
    (point, normal): (Vec3, Vec3),
    reach: f32,
    depth: f32,
) -> Option<f32> {
    let mut distance: Option<f32> = None;
    let around = Aabb::new((point - reach).into(), (point + reach).into());
    bvh.aabb_traverse(around, |bvh, node| {
        let node = &bvh.nodes[node as usize];
        for slot in node.first_index..node.first_index + node.prim_count {
            let other = triangles[bvh.primitive_indices[slot as usize] as usize];
            if other.object == object {
                continue;
            }
            let offset = RAY_OFFSET * extent(other).max(point.abs().max_element());
            if touches(other, point, TOUCHING * offset) {
                let cosine = normal.dot(other.double_area_normal().normalize_or_zero()).abs().max(LEAST_COSINE);
                distance = Some(distance.unwrap_or(0.0).max(depth * offset / cosine));
            }
        }
        true
    });
    distance
}

/// The largest absolute coordinate of a triangle's first corner and of its two edges from there: what a ray's offset scales with.
fn extent(triangle: &WorldTriangle) -> f32 {
    let [a, b, c] = triangle.corners;
    [a, b - a, c - a].into_iter().map(|v| v.abs().max_element()).fold(0.0, f32::max)
}

/// Whether a point lies within a distance of a triangle, metres.
fn touches(triangle: &WorldTriangle, point: Vec3, distance: f32) -> bool {
    let [a, b, c] = triangle.corners;
    let normal = triangle.double_area_normal().normalize_or_zero();
    let inside = |from: Vec3, to: Vec3| normal.cross(to - from).normalize_or_zero().dot(point - from) >= -distance;
    normal.dot(point - a).abs() <= distance && inside(a, b) && inside(b, c) && inside(c, a)
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use diacaustic_scene::parse_scene;

    use super::*;
    use crate::world_triangles;

    fn separated(objects: &str) -> (Vec<WorldTriangle>, Vec<WorldTriangle>) {
        let text = format!(
            "camera = {{ position = [0, 2, 3], look_at = [0, 0, 0], vertical_fov = 40 }}
             materials.glass = {{ type = \"dielectric\", ior = 1.5 }}
             materials.floor = {{ type = \"diffuse\", albedo = 0.5 }}
             objects = [{objects}]"
        );
        let scene = parse_scene(&text, Path::new("."), "test").unwrap_or_else(|error| panic!("{error}")).scene;
        let before = world_triangles(&scene);
        let mut after = before.clone();
        separate_touching(&scene, &mut after);
        (before, after)
    }

    fn lowest(triangles: &[WorldTriangle], object: u32) -> f32 {
        let own = triangles.iter().filter(|t| t.object == object);
        own.flat_map(|t| t.corners).map(|corner| corner.y).fold(f32::INFINITY, f32::min)
    }

    const FLOOR: &str =
        "{ rectangle = { center = [0, 0, 0], edge_u = [4, 0, 0], edge_v = [0, 0, -4] }, material = \"floor\" }";

    #[test]
    fn box_on_the_floor_sinks_in() {
        let (_, after) =
            separated(&format!("{FLOOR}, {{ box = {{ min = [-1, 0, -1], max = [1, 1, 1] }}, material = \"glass\" }}"));
        assert_eq!(lowest(&after, 0), 0.0);
        let depth = -lowest(&after, 1);
        assert!(depth > 4.0 * RAY_OFFSET * 4.0 && depth < 1e-3, "{depth}");
    }

    #[test]
    fn what_does_not_touch_stays() {
        let (before, after) = separated(&format!(
            "{FLOOR}, {{ box = {{ min = [-1, 0.001, -1], max = [1, 1, 1] }}, material = \"glass\" }}"
        ));
        assert_eq!(before, after);
    }

    #[test]
    fn ball_on_the_floor_sinks_in_where_it_touches_alone() {
        let (before, after) = separated(&format!(
            "{FLOOR}, {{ sphere = {{ center = [0, 0.5, 0], radius = 0.5 }}, material = \"glass\" }}"
        ));
        assert!(lowest(&before, 1).abs() < 1e-7 && lowest(&after, 1) < -2.0 * RAY_OFFSET, "{}", lowest(&after, 1));
        let corners = |triangles: &[WorldTriangle]| {
            let ball = triangles.iter().filter(|t| t.object == 1);
            ball.flat_map(|t| t.corners).collect::<Vec<_>>()
        };
        for (was, is) in corners(&before).into_iter().zip(corners(&after)) {
            assert_eq!(was != is, was.y.abs() < 1e-7, "{was} {is}");
        }
    }

    #[test]
    fn flush_dielectrics_part() {
        let block = |from: i32, to: i32| {
            format!("{{ box = {{ min = [{from}, 0, 0], max = [{to}, 1, 1] }}, material = \"glass\" }}")
        };
        let (_, after) = separated(&format!("{}, {}", block(-1, 0), block(0, 1)));
        let side = |object: u32, pick: fn(f32, f32) -> f32, start: f32| {
            after.iter().filter(|t| t.object == object).flat_map(|t| t.corners).map(|c| c.x).fold(start, pick)
        };
        let (right_of_first, left_of_second) = (side(0, f32::max, -9.0), side(1, f32::min, 9.0));
        assert!(right_of_first > left_of_second + 8.0 * RAY_OFFSET, "they do not overlap");
        assert!((lowest(&after, 0) - lowest(&after, 1)).abs() > RAY_OFFSET, "their undersides are still flush");
    }
}
