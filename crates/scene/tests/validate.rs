//! What `Scene::validate` says about scenes built in code.

use std::sync::Arc;

use diacaustic_scene::{
    Camera, Chart, Dispersion, Error, Layer, Light, LightKind, Material, MaterialKind, Mesh, Object, OutputSettings,
    PLASTIC_REFLECTANCE, RadianceMap, RenderSettings, Scene, Subject, Warning,
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

fn dielectric(ior: f32) -> MaterialKind {
    MaterialKind::Dielectric {
        ior,
        dispersion: Dispersion::None,
        tint: Vec3::ONE,
        absorption: Vec3::ZERO,
        roughness: 0.0,
        priority: 0,
    }
}

fn scene() -> Scene {
    let glass = dielectric(1.5);
    let plaster = MaterialKind::Diffuse { albedo: Vec3::splat(0.8) };
    let material = |name: &str, kind| Material::new(name, kind);
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
            photon_share: 1,
            group: None,
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
    assert_eq!(
        error(|s| s.materials[0].kind = dielectric(inf)),
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
        mesh.chart = Chart::Natural(vec![Vec2::ZERO]);
    };
    ends_with(mesh_error(strip), "mesh has a natural chart of 1 places; it must have 561, all of them finite");
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

/// The message about the scene with a light of this kind.
fn light_error(kind: LightKind) -> String {
    let message = error(|s| s.lights[0].kind = kind);
    message.strip_prefix("light \"lamp\": ").unwrap().to_owned()
}

/// The message about the scene with a material of this kind.
fn material_error(kind: MaterialKind) -> String {
    let message = error(|s| s.materials[0].kind = kind);
    message.strip_prefix("material \"glass\": ").unwrap().to_owned()
}

#[test]
fn lights_out_of_range_are_refused() {
    let (o, flux, nan) = (Vec3::ZERO, Vec3::ONE, f32::NAN);
    let (away, speck) = (Vec3::splat(2e9), 2f32.powi(-66));
    let reach = "each number must be finite and at most 1e9 in size";
    let rectangle = |edge_u, edge_v| LightKind::Rectangle { center: o, edge_u, edge_v, flux };
    let disk = |normal, radius| LightKind::Disk { center: o, normal, radius, flux };
    let spot =
        |inner_angle, outer_angle| LightKind::Spot { position: o, direction: Vec3::X, inner_angle, outer_angle, flux };
    let distant = |direction, angular_radius| LightKind::Distant { direction, angular_radius, irradiance: flux };
    let cases = [
        (rectangle(o, Vec3::X), "edge_u is [0, 0, 0]; its length must be greater than 0 (metres)"),
        (rectangle(Vec3::X, Vec3::ONE), "edge_v is [1, 1, 1]; it must be perpendicular to edge_u, [1, 0, 0]"),
        (
            rectangle(speck * Vec3::X, speck * Vec3::Y),
            "edge_u is 1.3552527e-20; so small a light of this flux has no finite radiance; it must be larger",
        ),
        (disk(o, 1.0), "normal is [0, 0, 0], which has no direction; it must be a vector such as [0, 1, 0]"),
        (disk(Vec3::X, 0.0), "radius is 0; it must be greater than 0 (metres)"),
        (
            disk(Vec3::X, 1e-30),
            "radius is 1e-30; so small a light of this flux has no finite radiance; it must be larger",
        ),
        (
            LightKind::Point { position: o, flux: -flux },
            "flux is [-1, -1, -1]; each channel must be 0 or greater (watts)",
        ),
        (spot(10.0, 10.0), "inner_angle is 10; it must be from 0 to less than outer_angle, 10 (degrees)"),
        (spot(-1.0, 10.0), "inner_angle is -1; it must be from 0 to less than outer_angle, 10 (degrees)"),
        (spot(0.0, 181.0), "outer_angle is 181; it must be greater than 0 and at most 180 (degrees)"),
        (spot(0.0, 0.0), "outer_angle is 0; it must be greater than 0 and at most 180 (degrees)"),
        (
            spot(0.0, 1e-30),
            "outer_angle is 1e-30; so small a light of this flux has no finite radiance; it must be larger",
        ),
        (distant(o, 0.0), "direction is [0, 0, 0], which has no direction; it must be a vector such as [0, 1, 0]"),
        (distant(Vec3::X, 90.0), "angular_radius is 90; it must be from 0 to less than 90 (degrees)"),
        (distant(Vec3::X, nan), "angular_radius is NaN; it must be from 0 to less than 90 (degrees)"),
        (
            LightKind::Distant { direction: Vec3::X, angular_radius: 0.0, irradiance: Vec3::splat(nan) },
            "irradiance is [NaN, NaN, NaN]; each channel must be 0 or greater (W/m²)",
        ),
    ];
    for (kind, message) in cases {
        assert_eq!(light_error(kind), message);
    }
    let positions = [
        LightKind::Rectangle { center: away, edge_u: Vec3::X, edge_v: Vec3::Y, flux },
        LightKind::Disk { center: away, normal: Vec3::X, radius: 1.0, flux },
        LightKind::Point { position: away, flux },
        LightKind::Spot { position: away, direction: Vec3::X, inner_angle: 0.0, outer_angle: 9.0, flux },
    ];
    for kind in positions {
        assert!(light_error(kind).ends_with(reach));
    }
    assert_eq!(error(|s| s.lights[0].photon_share = 0), "light \"lamp\": photon_share is 0; it must be from 1 to 1000");
    assert_eq!(
        error(|s| s.lights[0].photon_share = 1001),
        "light \"lamp\": photon_share is 1001; it must be from 1 to 1000"
    );
}

#[test]
fn environments_are_checked() {
    let environment = |map: RadianceMap, rotate, scale| LightKind::Environment { map: Arc::new(map), rotate, scale };
    let map = |width, height, texels: &[Vec3]| RadianceMap { width, height, texels: texels.to_vec() };
    let gray = map(2, 1, &[Vec3::ONE; 2]);
    let dark_below = map(2, 2, &[Vec3::ONE, Vec3::ONE, Vec3::ONE, Vec3::new(0.0, -1.0, 0.0)]);
    let cases = [
        (environment(gray.clone(), f32::INFINITY, Vec3::ONE), "rotate is inf; it must be a finite number of degrees"),
        (environment(gray.clone(), 0.0, -Vec3::ONE), "scale is [-1, -1, -1]; each channel must be 0 or greater"),
        (
            environment(map(2, 1, &[Vec3::splat(1e30); 2]), 0.0, Vec3::splat(1e20)),
            "scale is [1e20, 1e20, 1e20]; times the image's brightest channels, [1e30, 1e30, 1e30], it must be finite",
        ),
        (environment(map(2, 1, &[Vec3::ONE]), 0.0, Vec3::ONE), "image has 1 texels; 2 × 1 must have 2"),
        (
            environment(map(1, 1, &[Vec3::ONE]), 0.0, Vec3::ONE),
            "image has 1 × 1 texels; it must have from 2 × 1 to 16384 × 8192",
        ),
        (
            environment(map(16385, 1, &[]), 0.0, Vec3::ONE),
            "image has 16385 × 1 texels; it must have from 2 × 1 to 16384 × 8192",
        ),
        (
            environment(dark_below, 0.0, Vec3::ONE),
            "image has the radiance [0, -1, 0] at column 1, row 1 (from 0); each channel must be finite and 0 or greater",
        ),
    ];
    for (kind, message) in cases {
        assert_eq!(light_error(kind), message);
    }
    let sky = |name: &str| Light {
        name: name.to_owned(),
        kind: environment(gray.clone(), 0.0, Vec3::ONE),
        photon_share: 1,
        group: None,
    };
    assert_eq!(warnings(|s| s.lights = vec![sky("sky")]), []);
    assert_eq!(
        error(|s| s.lights = vec![sky("sky"), sky("clouds")]),
        "light \"clouds\": type is environment, as that of \"sky\" is; a scene has one at most"
    );
}

#[test]
fn layers_keep_eight_light_groups_at_most() {
    let lamp = scene().lights[0].clone();
    let lights = |count: usize| -> Vec<Light> {
        let names = (1..=count).map(|number| number.to_string());
        names.map(|name| Light { group: Some(name.clone()), name, ..lamp.clone() }).collect()
    };
    assert_eq!(warnings(|s| s.lights = lights(9)), []);
    let with_layers = |s: &mut Scene, count| (s.lights, s.output.layers) = (lights(count), Layer::ALL.to_vec());
    assert_eq!(warnings(|s| with_layers(s, 8)), []);
    assert_eq!(
        error(|s| with_layers(s, 9)),
        "output: layers asks for those of 9 light groups; there can be 8 at most: give lights the same group, or name layers without \
         \"light_groups\""
    );
}

#[test]
fn light_groups_are_in_the_order_of_the_scene() {
    let mut scene = scene();
    let group = |name: &str| Some(name.to_owned());
    scene.lights = vec![scene.lights[0].clone(); 4];
    for (light, name) in scene.lights.iter_mut().zip([group("b"), None, group("a"), group("b")]) {
        light.group = name;
    }
    scene.materials[1].group = group("sign");
    assert_eq!(scene.light_groups().names, ["b", "default", "a"]);
    scene.materials[1].emission = Vec3::ONE;
    let groups = scene.light_groups();
    assert_eq!(groups.names, ["b", "default", "a", "sign"]);
    assert_eq!((groups.of_lights, groups.of_materials), (vec![0, 1, 2, 0], vec![0, 3]));
}

#[test]
fn materials_out_of_range_are_refused() {
    let (half, nan, roughness) = (Vec3::splat(0.5), f32::NAN, 0.0);
    let to_1 = "each channel must be from 0 to 1";
    let cases = [
        (MaterialKind::Mirror { reflectance: -half }, format!("reflectance is [-0.5, -0.5, -0.5]; {to_1}")),
        (
            MaterialKind::Conductor { eta: Vec3::new(0.5, 0.0, 0.5), k: half, roughness },
            "eta is [0.5, 0, 0.5]; each channel must be finite and greater than 0".to_owned(),
        ),
        (
            MaterialKind::Conductor { eta: half, k: -half, roughness },
            "k is [-0.5, -0.5, -0.5]; each channel must be finite and 0 or greater".to_owned(),
        ),
        (
            MaterialKind::Conductor { eta: half, k: half, roughness: 1.5 },
            "roughness is 1.5; it must be from 0 to 1".to_owned(),
        ),
        (
            MaterialKind::Dielectric {
                ior: 1.5,
                dispersion: Dispersion::None,
                tint: half,
                absorption: half,
                roughness: -0.1,
                priority: 0,
            },
            "roughness is -0.1; it must be from 0 to 1".to_owned(),
        ),
        (
            MaterialKind::ThinWalled { ior: 0.0, tint: half, roughness: 0.0 },
            "ior is 0; it must be finite and greater than 0".to_owned(),
        ),
        (
            MaterialKind::ThinWalled { ior: 1.5, tint: 3.0 * half, roughness: 0.0 },
            format!("tint is [1.5, 1.5, 1.5]; {to_1}"),
        ),
        (
            MaterialKind::Coated { albedo: half, ior: 0.9, roughness },
            "ior is 0.9; it must be 1 or greater and finite".to_owned(),
        ),
        (MaterialKind::Coated { albedo: -half, ior: 1.5, roughness }, format!("albedo is [-0.5, -0.5, -0.5]; {to_1}")),
        (
            MaterialKind::Coated { albedo: half, ior: 1.5, roughness: nan },
            "roughness is NaN; it must be from 0 to 1".to_owned(),
        ),
        (
            MaterialKind::MetallicRoughness {
                base_color: -half,
                reflectance: PLASTIC_REFLECTANCE,
                metallic: 1.0,
                roughness,
            },
            format!("base_color is [-0.5, -0.5, -0.5]; {to_1}"),
        ),
        (
            MaterialKind::MetallicRoughness {
                base_color: half,
                reflectance: PLASTIC_REFLECTANCE,
                metallic: 1.1,
                roughness,
            },
            "metallic is 1.1; it must be from 0 to 1".to_owned(),
        ),
        (
            MaterialKind::MetallicRoughness {
                base_color: half,
                reflectance: PLASTIC_REFLECTANCE,
                metallic: 1.0,
                roughness: 2.0,
            },
            "roughness is 2; it must be from 0 to 1".to_owned(),
        ),
    ];
    for (kind, message) in cases {
        assert_eq!(material_error(kind), message);
    }
}

#[test]
fn emission_is_finite_and_not_of_glass() {
    assert_eq!(
        error(|s| s.materials[1].emission.y = f32::INFINITY),
        "material \"plaster\": emission is [0, inf, 0]; each channel must be 0 or greater (W/(m² sr))"
    );
    let of_glass = "material \"glass\": emission is [0, 0, 2], but glass takes no emission; it must be 0";
    assert_eq!(error(|s| s.materials[0].emission.z = 2.0), of_glass);
    let pane = |s: &mut Scene| {
        s.materials[0].kind = MaterialKind::ThinWalled { ior: 1.5, tint: Vec3::ONE, roughness: 0.0 };
        s.materials[0].emission.z = 2.0;
    };
    assert_eq!(error(pane), of_glass);
}

#[test]
fn only_receivers_have_a_map_size() {
    let with_map = |kind: MaterialKind| {
        let mut scene = scene();
        scene.materials[1].kind = kind;
        scene.objects[1].map_size = Some(64);
        scene.validate().map(|_| ()).map_err(|error| error.to_string())
    };
    let varnish = MaterialKind::Coated { albedo: Vec3::ONE, ior: 1.5, roughness: 0.0 };
    assert!(Material::new("varnish", varnish.clone()).is_caster());
    assert_eq!(with_map(varnish), Ok(()));
    let metal = MaterialKind::MetallicRoughness {
        base_color: Vec3::ONE,
        reflectance: PLASTIC_REFLECTANCE,
        metallic: 1.0,
        roughness: 0.5,
    };
    assert!(with_map(metal).unwrap_err().starts_with("object \"floor\": map_size is set, but the object is of glass"));
}

#[test]
fn too_many_materials_are_refused() {
    let add = |count| move |s: &mut Scene| s.materials.resize(count, s.materials[1].clone());
    assert_eq!(warnings(add(65_535)), []);
    assert_eq!(error(add(65_536)), "scene: materials has 65536 entries; it must have at most 65535");
}
