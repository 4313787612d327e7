//! Builds a scene without any file, renders it and writes `pyramid.png`.
//!
//!     cargo run --release -p diacaustic --example build_scene_in_code

use std::{error::Error, path::Path, sync::Arc};

use diacaustic::{
    Renderer, RendererOptions,
    glam::{Affine3A, Vec3, vec3},
    scene::{
        Camera, Dispersion, Light, LightKind, Material, MaterialKind, Mesh, Object, OutputSettings, RenderSettings,
        Scene, substance,
    },
};
use diacaustic_headless::{OpenOptions, open};
use diacaustic_output::{Display, Picture, Tone, write_png};

/// A pyramid of glass; its triangles are counter-clockwise seen from outside.
fn pyramid() -> Mesh {
    let corners = [vec3(-0.3, 0.0, 0.3), vec3(0.3, 0.0, 0.3), vec3(0.3, 0.0, -0.3), vec3(-0.3, 0.0, -0.3)];
    Mesh {
        positions: corners.into_iter().chain([vec3(0.0, 0.45, 0.0)]).collect(),
        triangles: vec![[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4], [2, 1, 0], [3, 2, 0]],
        ..Mesh::default()
    }
}

fn scene() -> Scene {
    let glass = MaterialKind::Dielectric {
        ior: substance("flint_glass").map_or(1.62, |flint| flint.ior),
        dispersion: Dispersion::default(),
        tint: Vec3::ONE,
        absorption: Vec3::ZERO,
        roughness: 0.0,
        priority: 0,
    };
    let object = |name: &str, mesh: Mesh, world_from_object: Affine3A, material: usize| Object {
        name: name.to_owned(),
        mesh: Arc::new(mesh),
        world_from_object,
        materials: vec![material],
        map_size: None,
    };
    let turned = Affine3A::from_rotation_y(0.5) * Affine3A::from_translation(vec3(0.0, 0.01, 0.0));
    Scene {
        camera: Camera {
            position: vec3(0.4, 1.2, 1.9),
            look_at: vec3(0.1, 0.1, 0.1),
            up: Vec3::Y,
            vertical_fov: 36.0,
            aperture_radius: 0.0,
            focus_distance: 2.0,
        },
        background: Vec3::splat(0.01),
        ambient: Vec3::ZERO,
        lights: vec![Light {
            name: "lamp".into(),
            kind: LightKind::Sphere { center: vec3(-1.2, 1.8, -0.8), radius: 0.03, flux: Vec3::splat(40.0) },
            photon_share: 1,
            group: None,
        }],
        materials: vec![
            Material::new("glass", glass),
            Material::new("floor", MaterialKind::Diffuse { albedo: Vec3::splat(0.7) }),
        ],
        objects: vec![
            object("pyramid", pyramid(), turned, 0),
            object("floor", Mesh::rectangle(Vec3::ZERO, 4.0 * Vec3::X, -4.0 * Vec3::Z), Affine3A::IDENTITY, 1),
        ],
        settings: RenderSettings { width: 320, height: 240, ..RenderSettings::default() },
        output: OutputSettings::default(),
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let scene = scene();
    for warning in scene.validate()? {
        eprintln!("warning: {warning}");
    }
    let gpu = open(&OpenOptions::default())?;
    let mut renderer = Renderer::new(&gpu.device, &gpu.queue, &RendererOptions::default())?;
    renderer.set_scene(&scene)?;
    renderer.emit_photons(0..500_000)?;
    renderer.add_samples(16)?;
    let film = renderer.film()?;
    let picture = Picture { width: film.width, height: film.height, pixels: &film.radiance };
    write_png(Path::new("pyramid.png"), &picture, &Display { exposure: 2.5, tone: Tone::Filmic })?;
    Ok(())
}
