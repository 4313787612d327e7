//! The scene's geometry with the places of its lightmaps.

use std::collections::HashMap;

use diacaustic::{
    Lightmap, MapLayout,
    glam::{Mat3, Vec2, Vec3},
    scene::{Object, Scene},
};
use diacaustic_output::{GltfMaterial, GltfMesh, GltfPart, GltfScene, GltfSurface, LightmapNote};

use super::colors::{Colors, LIGHTMAP_UV_SET, unlit_by_lightmap};

/// What an object's lightmap is, and where it lies.
#[derive(Clone, Copy)]
pub(super) struct BakedObject<'b> {
    pub lightmap: &'b Lightmap,
    pub layout: &'b MapLayout,
    /// The lightmap's file.
    pub file: &'b str,
}

/// A glTF scene as it grows, object by object.
pub(super) struct Geometry<'s> {
    pub scene: GltfScene,
    source: &'s Scene,
    /// The index of each of the source's materials that has no lightmap, and whether it bounds a volume.
    plain: HashMap<(usize, bool), usize>,
}

impl<'s> Geometry<'s> {
    pub fn new(source: &'s Scene) -> Self {
        Self { scene: GltfScene::default(), source, plain: HashMap::new() }
    }

    /// Adds an object: what receives light shows its lightmap, the rest is glass or metal.
    pub fn add(&mut self, index: usize, baked: Option<BakedObject<'_>>, colors: &Colors<'_>) {
        let object = &self.source.objects[index];
        let mut parts = Vec::new();
        let receives = |triangle: &usize| self.source.materials[object.material_of(*triangle)].is_receiver();
        let (lit, mut rest): (Vec<_>, Vec<_>) = (0..object.mesh.triangles.len()).partition(receives);
        match baked {
            Some(baked) if !lit.is_empty() => self.add_lit(object, &lit, baked, colors, &mut parts),
            _ => rest.extend(lit),
        }
        let bounds_volume = self.source.dielectric_boundary(object).is_some_and(|(_, mesh)| mesh.open_edges() == 0);
        let mut by_material: Vec<(usize, Vec<usize>)> = Vec::new();
        for triangle in rest {
            let material = object.material_of(triangle);
            match by_material.iter_mut().find(|(known, _)| *known == material) {
                Some((_, own)) => own.push(triangle),
                None => by_material.push((material, vec![triangle])),
            }
        }
        for (material, own) in by_material {
            let material = self.plain_material(material, bounds_volume);
            parts.push(part(object, &own, None, false, material));
        }
        self.scene.meshes.push(GltfMesh { name: object.name.clone(), parts });
    }

    /// Adds what receives light: its front, and its back if that is lit at all.
    fn add_lit(
        &mut self,
        object: &Object,
        lit: &[usize],
        baked: BakedObject<'_>,
        colors: &Colors<'_>,
        parts: &mut Vec<GltfPart>,
    ) {
        let texels_in_layer = baked.lightmap.places.len();
        for is_back in [false, true].into_iter().take(baked.lightmap.layers as usize) {
            let shown = colors.shown(object, baked.lightmap, is_back);
            let note = LightmapNote {
                file: baked.file.to_owned(),
                channels: if is_back { "back." } else { "" },
                tex_coord: LIGHTMAP_UV_SET,
                quantity: "irradiance, W/m^2",
            };
            let name = if is_back { format!("{} (back)", object.name) } else { object.name.clone() };
            let of_back = texels_in_layer..2 * texels_in_layer;
            let is_dark = is_back && of_back.into_iter().all(|texel| baked.lightmap.irradiance(texel) == [0.0; 3]);
            if is_dark {
                continue;
            }
            let material = GltfMaterial { name, surface: GltfSurface::Shown(shown), lightmap: Some(note) };
            self.scene.materials.push(material);
            let material = self.scene.materials.len() - 1;
            parts.push(part(object, lit, Some(baked.layout), is_back, material));
        }
    }

    fn plain_material(&mut self, material: usize, bounds_volume: bool) -> usize {
        let source = &self.source.materials[material];
        *self.plain.entry((material, bounds_volume)).or_insert_with(|| {
            let surface = unlit_by_lightmap(source, bounds_volume);
            self.scene.materials.push(GltfMaterial { name: source.name.clone(), surface, lightmap: None });
            self.scene.materials.len() - 1
        })
    }
}

/// In diagonals of the object: how far a back lies behind its front, so that rays and depth buffers tell them apart.
const BACK_BEHIND_FRONT: f32 = 1e-4;

/// For each vertex of a mesh, world frame, by how much a back is moved off its front.
fn steps_back(object: &Object) -> Vec<Vec3> {
    let mesh = &object.mesh;
    let place = |vertex: u32| object.world_from_object.transform_point3(mesh.positions[vertex as usize]);
    let (low, high) = (0..mesh.positions.len() as u32)
        .map(place)
        .fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(low, high), p| (low.min(p), high.max(p)));
    let mirrored = object.world_from_object.matrix3.determinant() < 0.0;
    let mut normals = vec![Vec3::ZERO; mesh.positions.len()];
    for vertices in &mesh.triangles {
        let [a, b, c] = vertices.map(place);
        let facet = (b - a).cross(c - a) * if mirrored { -1.0 } else { 1.0 };
        vertices.iter().for_each(|vertex| normals[*vertex as usize] += facet);
    }
    let step = BACK_BEHIND_FRONT * low.distance(high);
    normals.into_iter().map(|normal| -step * normal.normalize_or_zero()).collect()
}

/// Some of an object's triangles in the world frame, seen from their front or their back, with their places on a map.
fn part(object: &Object, triangles: &[usize], layout: Option<&MapLayout>, is_back: bool, material: usize) -> GltfPart {
    let mesh = &object.mesh;
    let linear = Mat3::from(object.world_from_object.matrix3);
    // A mirrored placement turns the triangles, not the normals.
    let turns = (linear.determinant() < 0.0) != is_back;
    let normal_matrix = linear.inverse().transpose() * if is_back { -1.0 } else { 1.0 };
    let offsets = if is_back { steps_back(object) } else { Vec::new() };
    let mut part = GltfPart { material, ..GltfPart::default() };
    let (mut own_uvs, mut map_uvs) = (Vec::new(), Vec::new());
    let mut known: HashMap<(u32, [u32; 2]), u32> = HashMap::new();
    for &triangle in triangles {
        let mut corners: [u32; 3] = std::array::from_fn(|corner| {
            let vertex = mesh.triangles[triangle][corner];
            let place = layout.map_or(Vec2::ZERO, |layout| uv_on(layout, layout.corners[triangle][corner]));
            *known.entry((vertex, place.to_array().map(f32::to_bits))).or_insert_with(|| {
                let position = object.world_from_object.transform_point3(mesh.positions[vertex as usize]);
                let offset = offsets.get(vertex as usize).copied().unwrap_or(Vec3::ZERO);
                part.positions.push((position + offset).to_array());
                let normal = mesh.normals.get(vertex as usize).map(|n| (normal_matrix * *n).normalize_or(Vec3::Y));
                part.normals.extend(normal.map(|normal| normal.to_array()));
                // A picture's upper left corner is (0, 0) in glTF, its lower left one in meshes here.
                own_uvs.extend(mesh.uvs.get(vertex as usize).map(|uv| [uv.x, 1.0 - uv.y]));
                map_uvs.push(place.to_array());
                part.positions.len() as u32 - 1
            })
        });
        if turns {
            corners.swap(1, 2);
        }
        part.triangles.push(corners);
    }
    // Sets are counted from 0 without gaps: one on which nothing lies repeats the other.
    let first = if own_uvs.is_empty() { map_uvs.clone() } else { own_uvs };
    part.uv_sets = if layout.is_some() { vec![first, map_uvs] } else { vec![first] };
    part
}

/// Texture coordinates of a place on a map, whose texels' middles stand at whole numbers.
fn uv_on(layout: &MapLayout, place: Vec2) -> Vec2 {
    (place + 0.5) / Vec2::new(layout.width as f32, layout.height as f32)
}
