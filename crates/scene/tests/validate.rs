//! What `Scene::validate` says about scenes built in code.

use std::sync::Arc;

use diacaustic_scene::{
    Camera, Chart, Error, Light, LightKind, Material, MaterialKind, Mesh, Object, OutputSettings, RenderSettings,
    Scene, Subject, Warning,
};
use glam::{Affine3A, Mat3A, Vec2, Vec3, Vec3A};

fn object(name: &str, mesh: Mesh, material: usize) -> Object {
    let materials = vec![material; mesh.material_slots.len().max(1)];
    Object {
        name: name.to_owned(),
        mesh: Arc::new(mesh),
        world_from_object: Affine3A::IDENTITY,
        materials,
        map_size: None,
    }
}

fn scene() -> Scene {
    let glass = MaterialKind::Dielectric { ior: 1.5, tint: Vec3::ONE, absorption: Vec3::ZERO };
    let plaster = MaterialKind::Diffuse { albedo: Vec3::splat(0.8) };
    let material = |name: &str, kind| Material { name: name.to_owned(), kind };
    Scene {
        camera: Camera {
            position: Vec3::new(0.0, 2.0, 3.0),
            look_at: Vec3::ZERO,
            up: Vec3::Y,
            vertical_fov: 40.0,
            aperture_radius: 0.0,
            focus_distance: 3.6,
        },
        background: Vec3::ZERO,
        ambient: Vec3::ZERO,
        lights: vec![Light {
            name: "lamp".to_owned(),
            kind: LightKind::Sphere { center: Vec3::new(1.0, 2.5, 0.6), radius: 0.05, flux: Vec3::splat(35.0) },
        }],
        materials: vec![material("glass", glass), material("plaster", plaster)],
        objects: vec![
            object("ball", Mesh::sphere(Vec3::new(0.0, 0.4, 0.0), 0.3, 4), 0),
            object("floor", Mesh::rectangle(Vec3::ZERO, 4.0 * Vec3::X, -4.0 * Vec3::Z), 1),
        ],
        settings: RenderSettings::default(),
        output: OutputSettings::default(),
    }
}

/// The message about the scene after a change.
fn error(change: impl FnOnce(&mut Scene)) -> String {
    let mut scene = scene();
    change(&mut scene);
    scene.validate().unwrap_err().to_string()
}

/// The message about the ball after a change of its mesh.
fn mesh_error(change: impl FnOnce(&mut Mesh)) -> String {
    error(|scene| change(Arc::make_mut(&mut scene.objects[0].mesh)))
}

fn warnings(change: impl FnOnce(&mut Scene)) -> Vec<Warning> {
    let mut scene = scene();
    change(&mut scene);
    scene.validate().unwrap()
}

#[test]
fn a_sound_scene_has_no_warning() {
    assert_eq!(warnings(|_| ()), []);
}

#[test]
fn errors_name_the_part_and_the_field() {
    let mut scene = scene();
    scene.lights[0].kind =
        LightKind::Sphere { center: Vec3::ZERO, radius: 1.0, flux: Vec3::new(0.0, f32::INFINITY, 0.0) };
    match scene.validate().unwrap_err() {
        Error::Invalid { at: None, subject: Subject::Light { index: 0, name }, key: "flux", .. } => {
            assert_eq!(name, "lamp");
        }
        other => panic!("{other}"),
    }
}

#[test]
fn numbers_that_are_not_finite_are_refused() {
    let nan = Vec3::new(0.0, f32::NAN, 0.0);
    let reach = "each number must be finite and at most 1e9 in size";
    assert_eq!(error(|s| s.ambient = nan), "scene: ambient is [0, NaN, 0]; each channel must be 0 or greater");
    assert_eq!(error(|s| s.camera.position = nan), format!("camera: position is [0.0, NaN, 0.0]; {reach}"));
    assert_eq!(error(|s| s.camera.look_at.x = 2e9), format!("camera: look_at is [2000000000.0, 0.0, 0.0]; {reach}"));
    assert!(error(|s| s.camera.up = nan).starts_with("camera: up is [0, NaN, 0], which has no direction"));
    assert_eq!(error(|s| s.output.exposure = f32::NAN), "output: exposure is NaN; it must be a number");
    let inf = f32::INFINITY;
    assert_eq!(
        error(|s| s.camera.focus_distance = inf),
        "camera: focus_distance is inf; it must be greater than 0 (metres)"
    );
    let dielectric = MaterialKind::Dielectric { ior: inf, tint: Vec3::ONE, absorption: Vec3::ZERO };
    assert_eq!(
        error(|s| s.materials[0].kind = dielectric),
        "material \"glass\": ior is inf; it must be finite and greater than 0"
    );
}

#[test]
fn references_out_of_range_are_refused() {
    assert_eq!(
        error(|s| s.objects[1].materials = vec![2]),
        "object \"floor\": materials names material 2; the scene has 2, from 0"
    );
    assert_eq!(
        error(|s| s.objects[1].materials.clear()),
        "object \"floor\": materials has 0 entries; it must have 1, one for each material slot of the mesh"
    );
    assert_eq!(
        mesh_error(|mesh| mesh.triangles[3][1] = 9999),
        "object \"ball\": mesh has the triangle 3 of vertices [3, 9999, 37], but 561 vertices, from 0"
    );
}

#[test]
fn broken_meshes_are_refused() {
    let ends_with = |message: String, end: &str| assert!(message.ends_with(end), "{message:?} must end with {end:?}");
    ends_with(mesh_error(|mesh| *mesh = Mesh::default()), "mesh has no triangles");
    ends_with(mesh_error(|mesh| mesh.positions[7].z = f32::NAN), "each number must be finite and at most 1e9 in size");
    ends_with(mesh_error(|mesh| mesh.normals.truncate(3)), "mesh has 3 normals; it must have 561 or none");
    ends_with(mesh_error(|mesh| mesh.uvs.truncate(3)), "mesh has 3 texture coordinates; it must have 561 or none");
    ends_with(mesh_error(|mesh| mesh.normals[5] *= 1.1), "mesh has a normal whose length is not 1");
    ends_with(mesh_error(|mesh| mesh.normals[5].x = f32::NAN), "mesh has a normal whose length is not 1");
    let not_finite = "mesh has a texture coordinate that is not finite";
    ends_with(mesh_error(|mesh| mesh.uvs[5] = Vec2::INFINITY), not_finite);
    ends_with(mesh_error(|mesh| mesh.triangle_slots = vec![0]), "it must have 960, one for each triangle");
    ends_with(mesh_error(|mesh| mesh.triangle_slots = vec![1; 960]), "of material slot 1, but 1 slots, from 0");
    ends_with(
        mesh_error(|mesh| mesh.material_slots = vec!["a".to_owned(), "b".to_owned()]),
        "mesh has 0 triangle slots; it must have 960, one for each triangle",
    );
    let flatten = |mesh: &mut Mesh| mesh.positions.iter_mut().for_each(|position| *position *= Vec3::X);
    ends_with(mesh_error(flatten), "mesh has 960 triangles, all of zero area");
    let strip = |mesh: &mut Mesh| {
        mesh.chart = Chart::Natural;
        mesh.uvs.clear();
    };
    ends_with(mesh_error(strip), "no texture coordinates; give it some or make the chart automatic");
}

#[test]
fn placements_must_be_invertible() {
    let place = |placement| error(|s| s.objects[0].world_from_object = placement);
    let singular = "object \"ball\": world_from_object cannot be inverted; every number must be finite and the scale \
                    neither 0 nor extreme";
    assert_eq!(place(Affine3A::from_mat3(glam::Mat3::from_diagonal(Vec3::new(1.0, 0.0, 1.0)))), singular);
    assert_eq!(place(Affine3A { matrix3: Mat3A::IDENTITY, translation: Vec3A::splat(f32::NAN) }), singular);
    assert_eq!(
        place(Affine3A::from_translation(Vec3::splat(2e9))),
        "object \"ball\": world_from_object moves the mesh more than 1e9 metres from the origin; translate or scale it less"
    );
}

#[test]
fn a_placed_dielectric_is_tested_where_it_stands() {
    let to_lamp = Vec3::new(1.0, 2.1, 0.6);
    let found = warnings(|s| s.objects[0].world_from_object = Affine3A::from_translation(to_lamp));
    let expected = Warning::LightInsideDielectric { light: "lamp".to_owned(), object: "ball".to_owned() };
    assert_eq!(found, std::slice::from_ref(&expected));
    let mirrored = Affine3A::from_translation(to_lamp) * Affine3A::from_scale(Vec3::new(-1.0, 1.0, 1.0));
    assert_eq!(warnings(|s| s.objects[0].world_from_object = mirrored), [expected]);
}

#[test]
fn holes_in_a_sphere_are_counted() {
    let found = warnings(|s| Arc::make_mut(&mut s.objects[0].mesh).triangles.truncate(959));
    assert_eq!(found, [Warning::OpenDielectric { object: "ball".to_owned(), open_edges: 3 }]);
}

#[test]
fn a_dielectric_may_share_its_surface_with_other_materials() {
    let label = |s: &mut Scene| {
        let mesh = Arc::make_mut(&mut s.objects[0].mesh);
        mesh.material_slots = vec!["glass".to_owned(), "label".to_owned()];
        mesh.triangle_slots = (0..mesh.triangles.len() as u32).map(|triangle| u32::from(triangle < 50)).collect();
        s.objects[0].materials = vec![0, 1];
    };
    assert_eq!(warnings(label), []);
    let separate_sheet = |s: &mut Scene| {
        label(s);
        let mesh = Arc::make_mut(&mut s.objects[0].mesh);
        mesh.triangle_slots.fill(0);
        let corners = [Vec3::ZERO, Vec3::X, Vec3::Z].map(|corner| 9.0 * Vec3::Y + corner);
        let first = mesh.positions.len() as u32;
        mesh.positions.extend(corners);
        mesh.normals.extend([Vec3::NEG_Y; 3]);
        mesh.uvs.extend([Vec2::ZERO; 3]);
        mesh.triangles.push([first, first + 1, first + 2]);
        mesh.triangle_slots.push(1);
    };
    assert_eq!(warnings(separate_sheet), []);
}

#[test]
fn triangles_without_area_are_counted() {
    let found = warnings(|s| Arc::make_mut(&mut s.objects[1].mesh).triangles.push([0, 0, 1]));
    assert_eq!(found, [Warning::DegenerateTriangles { object: "floor".to_owned(), count: 1 }]);
}
