//! What surfaces show in the light of their lightmaps.

use std::f32::consts::PI;

use diacaustic::{
    Lightmap, SurfacePlace, base_reflectance,
    glam::{Vec2, Vec3},
    scene::{Material, MaterialKind, Object, Scene},
};
use diacaustic_output::{Display, GltfSurface, ShownPicture};

/// The set of texture coordinates by which lightmaps lie on surfaces.
pub(super) const LIGHTMAP_UV_SET: u32 = 1;

/// A scene's materials, as a glTF file shows them.
pub(super) struct Colors<'s> {
    scene: &'s Scene,
    display: Display,
}

impl<'s> Colors<'s> {
    pub fn new(scene: &'s Scene, display: Display) -> Self {
        Self { scene, display }
    }

    /// What one side of an object shows, for each texel of its lightmap.
    pub fn shown(&self, object: &Object, lightmap: &Lightmap, is_back: bool) -> ShownPicture {
        let texels_in_layer = lightmap.places.len();
        let first = if is_back { texels_in_layer } else { 0 };
        let nearest = nearest_places(lightmap);
        let looks = nearest.iter().enumerate().map(|(texel, place)| match place {
            Some(place) => self.look(object, *place, Vec3::from(lightmap.irradiance(first + texel)), is_back),
            None => (Vec3::ZERO, 1.0),
        });
        let (radiance, opacity): (Vec<_>, Vec<_>) =
            looks.map(|(radiance, opacity)| (radiance.to_array(), opacity)).unzip();
        let has_holes = opacity.iter().any(|share| *share < 1.0);
        ShownPicture {
            width: lightmap.width,
            height: lightmap.height,
            radiance,
            opacity: has_holes.then_some(opacity),
            uv_set: LIGHTMAP_UV_SET,
            display: self.display,
        }
    }

    /// Radiance and opacity of a point under an irradiance.
    fn look(&self, object: &Object, place: SurfacePlace, irradiance: Vec3, is_back: bool) -> (Vec3, f32) {
        let triangle = place.triangle as usize;
        let material = &self.scene.materials[object.material_of(triangle)];
        let uv = uv_at(object, place);
        let mut radiance = base_reflectance(material, uv, vertex_color(object, place)) * irradiance / PI
            + ambient(material, uv) * self.scene.ambient;
        if !is_back {
            let picture = material.textures.emission.as_ref().map_or(Vec3::ONE, |texture| texture.at(uv).truncate());
            radiance += material.emission * picture;
        }
        (radiance, material.opacity_at(uv, vertex_opacity(object, place)))
    }
}

fn uv_at(object: &Object, place: SurfacePlace) -> Vec2 {
    if object.mesh.uvs.is_empty() {
        return Vec2::ZERO;
    }
    let corners = object.mesh.triangles[place.triangle as usize];
    (0..3).map(|corner| place.weights[corner] * object.mesh.uvs[corners[corner] as usize]).sum()
}

/// The colour of the vertices at a place; 1 for a mesh without.
fn vertex_color(object: &Object, place: SurfacePlace) -> Vec3 {
    if object.mesh.colors.is_empty() {
        return Vec3::ONE;
    }
    let corners = object.mesh.triangles[place.triangle as usize];
    (0..3).map(|corner| place.weights[corner] * object.mesh.colors[corners[corner] as usize]).sum()
}

/// The opacity of the vertices at a place; 1 for a mesh without.
fn vertex_opacity(object: &Object, place: SurfacePlace) -> f32 {
    let opacities = &object.mesh.opacities;
    let corners = object.mesh.triangles[place.triangle as usize];
    let of_corner = |corner: usize| opacities.get(corners[corner] as usize).copied().unwrap_or(1.0);
    (0..3).map(|corner| place.weights[corner] * of_corner(corner)).sum()
}

/// The share of ambient light that a material sends on.
fn ambient(material: &Material, uv: Vec2) -> Vec3 {
    let MaterialKind::Phong { ambient, .. } = material.kind else { return Vec3::ZERO };
    ambient * material.textures.color.as_ref().map_or(Vec3::ONE, |texture| texture.at(uv).truncate())
}

/// The place of each texel of a layer, or that of a texel near it: one ring of texels after the other takes its neighbours'.
fn nearest_places(lightmap: &Lightmap) -> Vec<Option<SurfacePlace>> {
    let (width, height) = (lightmap.width as usize, lightmap.height as usize);
    let mut places = lightmap.places.clone();
    let mut front: Vec<usize> = (0..places.len()).filter(|&texel| places[texel].is_some()).collect();
    while !front.is_empty() {
        let mut next = Vec::new();
        for texel in front {
            let (x, y) = (texel % width, texel / width);
            for row in y.saturating_sub(1)..=(y + 1).min(height - 1) {
                for column in x.saturating_sub(1)..=(x + 1).min(width - 1) {
                    let neighbour = row * width + column;
                    if places[neighbour].is_none() {
                        places[neighbour] = places[texel];
                        next.push(neighbour);
                    }
                }
            }
        }
        front = next;
    }
    places
}

/// What a surface that has no lightmap does to light, as far as glTF tells it; pictures on it are left out.
pub(super) fn unlit_by_lightmap(material: &Material, bounds_volume: bool) -> GltfSurface {
    match material.kind {
        MaterialKind::Dielectric { ior, tint, absorption, roughness, .. } => GltfSurface::Glass {
            ior,
            tint: tint.to_array(),
            roughness,
            absorption: bounds_volume.then(|| absorption.to_array()),
        },
        MaterialKind::ThinWalled { ior, tint, roughness } => {
            GltfSurface::Glass { ior, tint: tint.to_array(), roughness, absorption: None }
        }
        MaterialKind::Conductor { eta, k, roughness } => {
            let color = ((eta - 1.0).powf(2.0) + k * k) / ((eta + 1.0).powf(2.0) + k * k);
            GltfSurface::Metal { color: color.to_array(), roughness }
        }
        MaterialKind::Mirror { reflectance } => GltfSurface::Metal { color: reflectance.to_array(), roughness: 0.0 },
        MaterialKind::MetallicRoughness { base_color, roughness, .. } => {
            GltfSurface::Metal { color: base_color.to_array(), roughness }
        }
        MaterialKind::Diffuse { albedo } | MaterialKind::Coated { albedo, .. } => {
            GltfSurface::Metal { color: albedo.to_array(), roughness: 1.0 }
        }
        MaterialKind::Phong { diffuse, .. } => GltfSurface::Metal { color: diffuse.to_array(), roughness: 1.0 },
    }
}
