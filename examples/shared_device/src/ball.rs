//! A glass ball on a floor, built without a file.

use std::sync::Arc;

use diacaustic::{
    glam::{Affine3A, Vec3, vec3},
    scene::{
        Camera, Dispersion, Light, LightKind, Material, MaterialKind, Mesh, Object, OutputSettings, RenderSettings,
        Scene,
    },
};

/// Width and height of the picture, pixels.
pub const SIZE: u32 = 256;

/// What the sliders set.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Controls {
    /// Index of refraction of the ball.
    pub index: f32,
    /// Radiant flux of the light, W.
    pub flux: f32,
    /// Height of the light over the floor, m.
    pub height: f32,
    /// Texels along the floor's energy map.
    pub map_size: u32,
}

impl Default for Controls {
    fn default() -> Self {
        Self { index: 1.5, flux: 30.0, height: 2.5, map_size: 384 }
    }
}

/// The scene that the sliders describe.
pub fn ball(controls: &Controls) -> Scene {
    let glass = MaterialKind::Dielectric {
        ior: controls.index,
        dispersion: Dispersion::default(),
        tint: Vec3::ONE,
        absorption: vec3(1.0, 0.2, 0.4),
        roughness: 0.0,
        priority: 0,
    };
    let lamp = LightKind::Sphere {
        center: vec3(-0.9, controls.height, -0.6),
        radius: 0.04,
        flux: controls.flux * vec3(1.0, 0.92, 0.8),
    };
    Scene {
        camera: Camera {
            position: vec3(0.5, 1.1, 1.8),
            look_at: vec3(0.15, 0.2, 0.1),
            up: Vec3::Y,
            vertical_fov: 38.0,
            aperture_radius: 0.0,
            focus_distance: 2.0,
        },
        background: vec3(0.006, 0.008, 0.012),
        ambient: Vec3::ZERO,
        lights: vec![Light { name: "lamp".into(), kind: lamp, photon_share: 1, group: None }],
        materials: vec![
            Material::new("glass", glass),
            Material::new("floor", MaterialKind::Diffuse { albedo: Vec3::splat(0.7) }),
        ],
        objects: vec![
            object("ball", Mesh::sphere(vec3(0.0, 0.3, 0.0), 0.28, 6), 0, None),
            object("floor", Mesh::rectangle(Vec3::ZERO, 4.0 * Vec3::X, -4.0 * Vec3::Z), 1, Some(controls.map_size)),
        ],
        // Sliders want an answer at once, and the pilot that guides photons takes a moment.
        settings: RenderSettings { width: SIZE, height: SIZE, guiding: false, ..RenderSettings::default() },
        output: OutputSettings::default(),
    }
}

fn object(name: &str, mesh: Mesh, material: usize, map_size: Option<u32>) -> Object {
    Object {
        name: name.to_owned(),
        mesh: Arc::new(mesh),
        world_from_object: Affine3A::IDENTITY,
        materials: vec![material],
        map_size,
    }
}
