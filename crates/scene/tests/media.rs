//! Which dielectrics fill a point, and which of them ranks highest.

use std::{path::Path, sync::Arc};

use diacaustic_scene::{Chart, Mesh, Scene, parse_scene};
use glam::Vec3;

/// A ball of water in a ball of glass in a block of ice, placed by a translation and mirrored.
const NESTED: &str = r#"
[camera]
position = [0, 2, 8]
look_at = [0, 0, 0]
vertical_fov = 40
[materials]
glass = { type = "dielectric", ior = 1.5, priority = 1 }
floor = { type = "diffuse", albedo = 0.8 }
water = { type = "dielectric", substance = "water", priority = 1 }
ice = { type = "dielectric", substance = "ice", priority = -3 }
oil = { type = "dielectric", substance = "olive_oil", priority = 2 }
[[objects]]
sphere = { center = [0, 0, 0], radius = 1, subdivisions = 4 }
material = "glass"
translate = [10, 0, 0]
scale = [-1, 1, 1]
[[objects]]
sphere = { center = [0, 0, 0], radius = 0.5, subdivisions = 4 }
material = "water"
translate = [10, 0, 0]
[[objects]]
box = { min = [8, -2, -2], max = [12, 2, 2] }
material = "ice"
[[objects]]
rectangle = { center = [0, -3, 0], edge_u = [40, 0, 0], edge_v = [0, 0, -40] }
material = "floor"
"#;

fn nested() -> Scene {
    parse_scene(NESTED, Path::new("."), "x.toml").unwrap().scene
}

fn names_at(scene: &Scene, point: Vec3) -> Vec<&str> {
    scene.media_at(point).into_iter().map(|index| scene.materials[index].name.as_str()).collect()
}

#[test]
fn nested_volumes_all_count() {
    let scene = nested();
    assert_eq!(names_at(&scene, Vec3::new(10.1, 0.0, 0.1)), ["glass", "water", "ice"]);
    assert_eq!(names_at(&scene, Vec3::new(10.7, 0.0, 0.1)), ["glass", "ice"]);
    assert_eq!(names_at(&scene, Vec3::new(11.5, 0.0, 0.1)), ["ice"]);
    assert_eq!(names_at(&scene, Vec3::new(0.0, 0.0, 0.0)), [""; 0]);
    assert_eq!(names_at(&scene, Vec3::new(0.0, -4.0, 0.0)), [""; 0]);
}

#[test]
fn overlapping_shells_of_one_object_count_separately() {
    let mut scene = nested();
    let mut shells = Mesh { chart: Chart::Automatic, ..Mesh::cuboid(Vec3::splat(-1.0), Vec3::ONE) };
    let inner = Mesh::cuboid(Vec3::ZERO, Vec3::splat(2.0));
    let first = shells.positions.len() as u32;
    shells.positions.extend(inner.positions);
    shells.normals.extend(inner.normals);
    shells.uvs.extend(inner.uvs);
    shells.triangles.extend(inner.triangles.iter().map(|triangle| triangle.map(|vertex| first + vertex)));
    scene.objects.truncate(1);
    scene.objects[0].mesh = Arc::new(shells);
    assert_eq!(names_at(&scene, Vec3::new(9.5, 0.5, 0.5)), ["glass", "glass"]);
    assert_eq!(names_at(&scene, Vec3::new(10.5, -0.5, -0.5)), ["glass"]);
}

#[test]
fn a_hole_that_faces_inwards_is_not_filled() {
    let mut scene = nested();
    scene.objects.truncate(1);
    let mut hollow = Mesh { chart: Chart::Automatic, ..Mesh::cuboid(Vec3::splat(-1.0), Vec3::ONE) };
    let hole = Mesh::cuboid(Vec3::splat(-0.5), Vec3::splat(0.5));
    let first = hollow.positions.len() as u32;
    hollow.positions.extend(hole.positions);
    hollow.normals.extend(hole.normals);
    hollow.uvs.extend(hole.uvs);
    hollow.triangles.extend(hole.triangles.iter().map(|[a, b, c]| [first + a, first + c, first + b]));
    scene.objects[0].mesh = Arc::new(hollow);
    assert_eq!(names_at(&scene, Vec3::new(10.0, 0.0, 0.1)), [""; 0]);
    assert_eq!(names_at(&scene, Vec3::new(10.7, 0.0, 0.1)), ["glass"]);
}

#[test]
fn rank_is_by_priority_and_then_by_order() {
    let scene = nested();
    let rank = |name: &str| {
        let index = scene.materials.iter().position(|material| material.name == name).unwrap();
        scene.dielectric_rank(index)
    };
    assert_eq!(["ice", "water", "glass", "oil"].map(rank), [Some(0), Some(1), Some(2), Some(3)]);
    assert_eq!(rank("floor"), None);
    assert_eq!(scene.dielectric_rank(99), None);
}
