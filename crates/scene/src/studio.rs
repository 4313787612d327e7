//! A glTF file as a scene of its own: with a camera, lights and a floor where it has none.

use std::{f32::consts::PI, path::Path, sync::Arc};

use glam::{Affine3A, Vec3};

use crate::{
    Camera, Error, GltfCamera, GltfFile, GltfOptions, Light, LightKind, LoadedScene, Material, MaterialKind, Mesh,
    Object, OutputSettings, RenderSettings, Scene, load_gltf,
};

/// Vertical field of view of a camera that frames the scene, degrees.
const FOV: f32 = 35.0;
/// The direction from the scene's middle to that camera: glTF's models face +z.
const TOWARDS_CAMERA: Vec3 = Vec3::new(0.35, 0.4, 1.0);
/// How much wider than the scene the picture is, and with a floor that is to show caustics.
const MARGIN: f32 = 1.1;
const MARGIN_WITH_FLOOR: f32 = 1.5;
/// Pixels of a picture, in each direction if it is square.
const SIZE: f32 = 512.0;

/// Radiance of the studio's surroundings, W/(m² sr).
const SURROUNDINGS: f32 = 0.25;
/// Irradiance that the studio's lamp gives the scene's middle, W/m².
const LAMP_IRRADIANCE: f32 = 3.0;
/// The direction from the scene's middle to the lamp, along the picture's right, up and towards the camera.
const TOWARDS_LAMP: Vec3 = Vec3::new(-0.55, 1.0, 0.25);
/// The lamp's distance and radius, in radii of the scene.
const LAMP_DISTANCE: f32 = 3.0;
const LAMP_RADIUS: f32 = 0.06;

/// Half the edge of the floor, in radii of the scene.
const FLOOR_REACH: f32 = 12.0;
const FLOOR_ALBEDO: f32 = 0.7;

/// Radiance that a white surface under the file's lights is brought to in a PNG.
const BRIGHTNESS: f32 = 0.6;

/// What a glTF file's scene is completed by.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StudioOptions {
    /// Whether a matt floor lies under everything.
    pub floor: bool,
    /// What of the file is read.
    pub file: GltfOptions,
}

/// Reads a glTF file as a scene: through its first camera, or else one that frames it; by its lights, or else a lamp and even light
/// from all around. Under lights of the file the exposure is chosen such that a white surface in the middle is bright.
///
/// # Errors
/// As [`load_gltf`], and if the scene has no triangles or [`Scene::validate`] refuses it.
pub fn load_gltf_scene(path: &Path, options: &StudioOptions) -> Result<LoadedScene, Error> {
    let mut file = load_gltf(path, &options.file)?;
    let mut warnings = std::mem::take(&mut file.warnings);
    let fault = |problem: String| Error::Gltf { path: path.to_owned(), place: None, problem };
    if file.objects.is_empty() {
        return Err(fault("its scene has no triangles, so there is nothing to render".to_owned()));
    }
    let scene = compose(file, options);
    warnings.extend(scene.validate().map_err(|error| match error {
        Error::Invalid { subject, key, problem, .. } => {
            Error::Gltf { path: path.to_owned(), place: Some(subject.to_string()), problem: format!("{key} {problem}") }
        }
        other => other,
    })?);
    Ok(LoadedScene { scene, warnings })
}

fn compose(file: GltfFile, options: &StudioOptions) -> Scene {
    let positions: Vec<Vec3> =
        file.objects.iter().flat_map(|object| world_positions(&object.mesh, object.world_from_object)).collect();
    let bounds = Bounds::of(&positions);
    let GltfCamera { camera, aspect_ratio } = match file.cameras.first() {
        Some(found) => GltfCamera { camera: focused(&found.camera, &bounds), aspect_ratio: found.aspect_ratio },
        None => bounds.framing_camera(&positions, if options.floor { MARGIN_WITH_FLOOR } else { MARGIN }),
    };
    let has_lights = file.lights.iter().any(|light| !light.kind.is_dark());
    let mut scene = Scene {
        background: if has_lights { Vec3::ZERO } else { Vec3::splat(SURROUNDINGS) },
        ambient: Vec3::ZERO,
        settings: settings(aspect_ratio.unwrap_or(1.0)),
        output: OutputSettings { exposure: exposure(&file.lights, bounds.middle()), ..OutputSettings::default() },
        lights: if has_lights { file.lights } else { vec![bounds.lamp(&camera)] },
        camera,
        materials: file.materials,
        objects: Vec::new(),
    };
    let mut names = Names::default();
    for part in file.objects {
        scene.objects.push(Object {
            name: names.unused(&part.name),
            mesh: part.mesh,
            world_from_object: part.world_from_object,
            materials: part.materials,
            map_size: None,
        });
    }
    if options.floor {
        let albedo = Vec3::splat(FLOOR_ALBEDO);
        scene.materials.push(Material::new("floor", MaterialKind::Diffuse { albedo }));
        scene.objects.push(Object {
            name: names.unused("floor"),
            mesh: Arc::new(bounds.floor()),
            world_from_object: Affine3A::IDENTITY,
            materials: vec![scene.materials.len() - 1],
            map_size: None,
        });
    }
    scene
}

/// A picture of about as many pixels as a square one, of a width over height between 1/4 and 4.
fn settings(aspect_ratio: f32) -> RenderSettings {
    let root = aspect_ratio.clamp(0.25, 4.0).sqrt();
    RenderSettings {
        width: (SIZE * root).round() as u32,
        height: (SIZE / root).round() as u32,
        ..RenderSettings::default()
    }
}

/// A camera of a file, sharp in the scene's middle.
fn focused(camera: &Camera, bounds: &Bounds) -> Camera {
    let [.., forward] = camera.axes();
    let distance = (bounds.middle() - camera.position).dot(forward);
    Camera { focus_distance: if distance > 0.0 { distance } else { camera.focus_distance }, ..camera.clone() }
}

/// Stops by which a white surface at a point under the file's lights is brought to the brightness of the picture; 0 without lights.
fn exposure(lights: &[Light], point: Vec3) -> f32 {
    let irradiance = |light: &Light| {
        let strength = light.kind.strength().element_sum() / 3.0;
        match light.kind {
            LightKind::Point { position, .. } | LightKind::Spot { position, .. } => {
                strength / position.distance_squared(point)
            }
            _ => strength,
        }
    };
    let radiance: f32 = lights.iter().map(irradiance).sum::<f32>() / PI;
    if radiance > 0.0 && radiance.is_finite() { (BRIGHTNESS / radiance).log2().clamp(-20.0, 20.0) } else { 0.0 }
}

/// Names that differ.
#[derive(Default)]
struct Names {
    taken: std::collections::HashSet<String>,
    numbers: std::collections::HashMap<String, usize>,
}

impl Names {
    /// The name, or with the first number from 2 that makes it differ from those before.
    fn unused(&mut self, name: &str) -> String {
        let mut candidate = name.to_owned();
        let number = self.numbers.entry(name.to_owned()).or_insert(1);
        while !self.taken.insert(candidate.clone()) {
            *number += 1;
            candidate = format!("{name} {number}");
        }
        candidate
    }
}

/// A camera that sees every object; around the origin without any.
pub(crate) fn framing_camera(objects: &[Object]) -> Camera {
    let mut positions: Vec<Vec3> =
        objects.iter().flat_map(|object| world_positions(&object.mesh, object.world_from_object)).collect();
    if positions.is_empty() {
        positions = vec![Vec3::NEG_ONE, Vec3::ONE];
    }
    Bounds::of(&positions).framing_camera(&positions, MARGIN).camera
}

/// Every vertex of a mesh, world frame.
fn world_positions(mesh: &Mesh, world_from_object: Affine3A) -> impl Iterator<Item = Vec3> + '_ {
    mesh.positions.iter().map(move |position| world_from_object.transform_point3(*position))
}

/// The box around everything, world frame, metres.
struct Bounds {
    lowest: Vec3,
    highest: Vec3,
}

impl Bounds {
    fn of(positions: &[Vec3]) -> Self {
        let mut bounds = Self { lowest: Vec3::INFINITY, highest: Vec3::NEG_INFINITY };
        for position in positions {
            bounds.lowest = bounds.lowest.min(*position);
            bounds.highest = bounds.highest.max(*position);
        }
        bounds
    }

    fn middle(&self) -> Vec3 {
        0.5 * (self.lowest + self.highest)
    }

    /// Half the diagonal.
    fn radius(&self) -> f32 {
        0.5 * self.lowest.distance(self.highest)
    }

    /// A camera that sees everything, in a picture that is `margin` times as wide as that needs.
    fn framing_camera(&self, positions: &[Vec3], margin: f32) -> GltfCamera {
        let towards = TOWARDS_CAMERA.normalize();
        let camera = |look_at: Vec3, distance: f32| Camera {
            position: look_at + distance * towards,
            look_at,
            up: Vec3::Y,
            vertical_fov: FOV,
            aperture_radius: 0.0,
            focus_distance: distance,
        };
        let [right, up, forward] = camera(self.middle(), self.radius()).axes();
        let in_view = |position: Vec3| {
            let offset = position - self.middle();
            Vec3::new(offset.dot(right), offset.dot(up), offset.dot(forward))
        };
        let places = || positions.iter().map(|position| in_view(*position));
        let start = (Vec3::INFINITY, Vec3::NEG_INFINITY);
        let (low, high) = places().fold(start, |(low, high), place| (low.min(place), high.max(place)));
        let (centre, extent) = (0.5 * (low + high), high - low);
        let aspect_ratio = (extent.x / extent.y).clamp(0.6, 1.8);
        let slope = (0.5 * FOV).to_radians().tan() / margin;
        let needed = |place: Vec3| {
            let across = (place - centre).abs();
            across.y.max(across.x / aspect_ratio) / slope - place.z
        };
        let distance = places().map(needed).fold(self.radius(), f32::max);
        let look_at = self.middle() + centre.x * right + centre.y * up;
        GltfCamera { camera: camera(look_at, distance), aspect_ratio: Some(aspect_ratio) }
    }

    /// A small sphere above and to the left of what the camera sees.
    fn lamp(&self, camera: &Camera) -> Light {
        let [right, .., forward] = camera.axes();
        let across = right.with_y(0.0).normalize_or(Vec3::X);
        let towards_camera = (-forward).with_y(0.0).normalize_or(Vec3::Z);
        let direction = Vec3::Y * TOWARDS_LAMP.y + across * TOWARDS_LAMP.x + towards_camera * TOWARDS_LAMP.z;
        let distance = LAMP_DISTANCE * self.radius();
        Light {
            name: "lamp".to_owned(),
            kind: LightKind::Sphere {
                center: self.middle() + distance * direction.normalize(),
                radius: LAMP_RADIUS * self.radius(),
                flux: Vec3::splat(4.0 * PI * distance * distance * LAMP_IRRADIANCE),
            },
            photon_share: 1,
            group: None,
        }
    }

    /// A square under everything.
    fn floor(&self) -> Mesh {
        let edge = 2.0 * FLOOR_REACH * self.radius();
        Mesh::rectangle(self.middle().with_y(self.lowest.y), edge * Vec3::X, edge * Vec3::NEG_Z)
    }
}
