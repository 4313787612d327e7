//! Meshes and scenes for the tests.

#![allow(dead_code, reason = "no file of tests uses all of them")]

use std::collections::HashMap;
use std::sync::Arc;

use diacaustic_scene::{
    Camera, Dispersion, Light, LightKind, Material, MaterialKind, Mesh, Object, OutputSettings, RenderSettings, Scene,
    Texture, TextureImage,
};
use glam::{Affine3A, Vec3};
use half::f16;

/// A square floor of this half width in the plane y = 0, which looks up.
pub fn floor(half: f32) -> Mesh {
    let at = |x: f32, z: f32| Vec3::new(x * half, 0.0, z * half);
    Mesh {
        positions: vec![at(-1.0, -1.0), at(-1.0, 1.0), at(1.0, 1.0), at(1.0, -1.0)],
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        ..Mesh::default()
    }
}

/// A box between two corners, flat, which looks outward.
pub fn block(min: Vec3, max: Vec3) -> Mesh {
    let corner = |i: u32| {
        let pick = |bit: u32, low: f32, high: f32| if i >> bit & 1 == 1 { high } else { low };
        Vec3::new(pick(0, min.x, max.x), pick(1, min.y, max.y), pick(2, min.z, max.z))
    };
    let quads = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    Mesh {
        positions: (0..8).map(corner).collect(),
        triangles: quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect(),
        ..Mesh::default()
    }
}

/// A ball about the origin: an octahedron whose triangles are split in four `levels` times; smooth normals.
pub fn ball(radius: f32, levels: u32) -> Mesh {
    let mut directions = vec![Vec3::X, Vec3::NEG_X, Vec3::Y, Vec3::NEG_Y, Vec3::Z, Vec3::NEG_Z];
    let mut triangles = vec![[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]];
    for _ in 0..levels {
        let mut halves = HashMap::new();
        let mut half = |a: u32, b: u32| {
            *halves.entry((a.min(b), a.max(b))).or_insert_with(|| {
                directions.push((directions[a as usize] + directions[b as usize]).normalize());
                directions.len() as u32 - 1
            })
        };
        triangles = triangles
            .iter()
            .flat_map(|&[a, b, c]| {
                let (ab, bc, ca) = (half(a, b), half(b, c), half(c, a));
                [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
            })
            .collect();
    }
    Mesh {
        positions: directions.iter().map(|&n| radius * n).collect(),
        normals: directions,
        triangles,
        ..Mesh::default()
    }
}

/// Clear glass.
pub fn glass(ior: f32) -> MaterialKind {
    absorbing_glass(ior, 0.0)
}

/// Glass of one σ in every channel, 1/m.
pub fn absorbing_glass(ior: f32, absorption: f32) -> MaterialKind {
    tinted_glass(ior, Vec3::ONE, Vec3::splat(absorption))
}

/// Smooth glass of priority 0.
pub fn tinted_glass(ior: f32, tint: Vec3, absorption: Vec3) -> MaterialKind {
    MaterialKind::Dielectric { ior, dispersion: Dispersion::None, tint, absorption, roughness: 0.0, priority: 0 }
}

/// Clear rough glass.
pub fn frosted(ior: f32, roughness: f32) -> MaterialKind {
    MaterialKind::Dielectric {
        ior,
        dispersion: Dispersion::None,
        tint: Vec3::ONE,
        absorption: Vec3::ZERO,
        roughness,
        priority: 0,
    }
}

/// The same mesh in flat facets: interpolated normals do not keep phase space, and nested ones can catch light for good.
pub fn flat(mesh: Mesh) -> Mesh {
    Mesh { normals: Vec::new(), ..mesh }
}

/// A grey Lambertian surface.
pub fn diffuse(albedo: f32) -> MaterialKind {
    MaterialKind::Diffuse { albedo: Vec3::splat(albedo) }
}

/// A spherical light of one flux in every channel.
pub fn light(center: Vec3, radius: f32, flux: f32) -> Light {
    named(LightKind::Sphere { center, radius, flux: Vec3::splat(flux) })
}

/// A light of a kind.
pub fn named(kind: LightKind) -> Light {
    Light { name: "light".into(), kind, photon_share: 1, group: None }
}

/// A scene of meshes, each with its material and its place, in front of a black background.
pub fn scene(parts: Vec<(Mesh, MaterialKind, Vec3)>, lights: Vec<Light>) -> Scene {
    let camera = Camera {
        position: Vec3::new(0.0, 1.0, 5.0),
        look_at: Vec3::ZERO,
        up: Vec3::Y,
        vertical_fov: 30.0,
        aperture_radius: 0.0,
        focus_distance: 1.0,
    };
    let mut scene = Scene {
        camera,
        background: Vec3::ZERO,
        ambient: Vec3::ZERO,
        lights,
        materials: Vec::new(),
        objects: Vec::new(),
        settings: RenderSettings { width: 32, height: 32, ..RenderSettings::default() },
        output: OutputSettings::default(),
    };
    for (index, (mesh, kind, place)) in parts.into_iter().enumerate() {
        scene.materials.push(Material::new(format!("material {index}"), kind));
        scene.objects.push(Object {
            name: format!("object {index}"),
            mesh: Arc::new(mesh),
            world_from_object: Affine3A::from_translation(place),
            materials: vec![index],
            map_size: None,
        });
    }
    scene
}

/// A picture of the numbers that `texel` gives for each column and row, the first row at the top.
pub fn picture(width: u32, height: u32, texel: impl Fn(u32, u32) -> [f32; 4]) -> Texture {
    let places = (0..width * height).map(|i| (i % width, i / width));
    let texels = places.map(|(column, row)| texel(column, row).map(f16::from_f32)).collect();
    Texture::new(Arc::new(TextureImage::new(width, height, texels).expect("each place has its texel")))
}

/// A number that looks random, from 0 to 1, one of 1/64ths, which half precision holds.
pub fn speckle(column: u32, row: u32) -> f32 {
    let mixed = column.wrapping_mul(0x9e37_79b1) ^ row.wrapping_mul(0x85eb_ca77);
    (mixed ^ mixed >> 15).wrapping_mul(0x2c1b_3c6d).wrapping_shr(20) as f32 % 65.0 / 64.0
}

/// A horizontal rectangle that looks up, centred above the origin, whose picture is upright seen from above with −z up.
pub fn plate(height: f32, size: f32) -> Mesh {
    Mesh::rectangle(height * Vec3::Y, size * Vec3::X, -size * Vec3::Z)
}

/// Parallel light of irradiance 3 W/m² across it.
pub fn parallel(direction: Vec3) -> Light {
    named(LightKind::Distant { direction, angular_radius: 0.0, irradiance: Vec3::splat(3.0) })
}

/// A clear sheet of glass.
pub fn pane() -> MaterialKind {
    MaterialKind::ThinWalled { ior: 1.5, tint: Vec3::ONE, roughness: 0.0 }
}
