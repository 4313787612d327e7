//! The scene on the device: bind group 0 of both passes.

use bytemuck::Pod;
use diacaustic_scene::{LightKind, Scene};
use diacaustic_shaders as shaders;
use diacaustic_shaders::{material_kind, triangle_flag};
use diacaustic_surface::{MapSquare, MapTiles, WorldTriangle};
use glam::Vec2;
use rayon::prelude::*;

use crate::{
    Error,
    fingerprint::Fingerprint,
    gpu::{Binding, Gpu, Purpose, texture_bytes},
    host_scene::HostScene,
    lights::{Lights, emissive_materials},
    map_plan::MapPlan,
    map_records::map_records,
    map_sums::EnergyMaps,
    material_records::{material, rest, rests},
    spectra_records::spectra_record,
    texture_records::TextureRecords,
    vertex_color_records::{colored_materials, vertex_colors},
};

/// The bindings of `shaders/layout/scene.wgsl`.
pub(crate) const BINDINGS: [Binding; 14] = [Binding::Records; 14];

const TRIANGLES: Purpose = Purpose { what: "the scene's triangles", remedy: "use fewer triangles" };
const CORNERS: Purpose = Purpose { what: "the triangles' corners", remedy: "use fewer triangles" };
const NODES: Purpose = Purpose { what: "the bounding volume hierarchy's nodes", remedy: "use fewer triangles" };
const MAPS: Purpose = Purpose { what: "the energy maps' tiles", remedy: "use fewer objects, or lower map_budget" };
const MATERIALS: Purpose = Purpose { what: "the scene's materials", remedy: "use fewer materials" };
const LIGHTS: Purpose = Purpose { what: "the scene's lights", remedy: "use fewer lights" };
const EMITTING_TRIANGLES: Purpose = Purpose { what: "the triangles that shine", remedy: "use fewer triangles" };
const ENVIRONMENT: Purpose = Purpose { what: "the environment's picture", remedy: "use a smaller picture" };

const COORDINATES: Purpose = Purpose { what: "the triangles' texture coordinates", remedy: "use fewer triangles" };
const COLORS: Purpose = Purpose { what: "the triangles' vertex colours", remedy: "use fewer triangles" };
const TEXTURES: Purpose = Purpose { what: "the list of textures", remedy: "use fewer textures" };
const TEXELS: Purpose = Purpose { what: "the textures' pictures", remedy: "use smaller pictures" };

const SPECTRA: Purpose =
    Purpose { what: "the indices of refraction over the wavelength", remedy: "use fewer materials with dispersion" };

/// The scene's records, and what they weigh.
#[derive(Debug)]
pub(crate) struct SceneBuffers {
    pub bind_group: wgpu::BindGroup,
    pub bytes: u64,
    views: [wgpu::TextureView; BINDINGS.len()],
    /// Of all that is in them.
    pub fingerprint: Fingerprint,
}

/// Sends records to the device, and remembers what was sent.
struct Uploader<'g> {
    gpu: &'g Gpu,
    fingerprint: Fingerprint,
}

impl Uploader<'_> {
    fn records<T: Pod>(&mut self, purpose: Purpose, records: &[T]) -> Result<wgpu::Texture, Error> {
        self.fingerprint.digest(purpose.what, records);
        self.gpu.records(purpose, records)
    }
}

/// Triangles that the device holds: as many as their largest record has room for in one texture.
pub(crate) fn most_triangles(gpu: &Gpu) -> usize {
    gpu.most_record_bytes() as usize / size_of::<shaders::TriangleCorners>()
}

/// The binding of the maps' records.
const MAPS_BINDING: usize = 3;

impl SceneBuffers {
    /// Sends a scene to the device. Its maps have a single cell of nothing until [`Self::place_maps`].
    pub fn new(gpu: &Gpu, layout: &wgpu::BindGroupLayout, scene: &Scene, host: &HostScene) -> Result<Self, Error> {
        let HostScene { bvh, lights, maps, .. } = host;
        let nodes: &[shaders::BvhNode] = bytemuck::cast_slice(&bvh.nodes);
        let triangles: Vec<_> = bvh.triangles.par_iter().map(|t| triangle(scene, t)).collect();
        let corners: Vec<_> = bvh
            .triangles
            .par_iter()
            .map(|t| triangle_corners(t, maps.get(t.object as usize).and_then(Option::as_ref)))
            .collect();
        let blank: Vec<_> = maps.iter().map(|plan| plan.as_ref().map(blank_tiles)).collect();
        let blank = map_records(blank.iter().map(|tiles| tiles.as_ref().map(|tiles| (tiles, 0))));
        let colored = colored_materials(scene);
        let mut materials: Vec<_> =
            colored.iter().enumerate().map(|(index, colored)| material(scene, index, *colored)).collect();
        for (order, (index, _)) in emissive_materials(scene).into_iter().enumerate() {
            materials[index].emission_pdf_area = lights.pdf_area(scene.lights.len() + order);
            materials[index].kind |= (lights.groups.of_materials[index] as u32) << material_kind::GROUP_SHIFT;
        }
        let surfaces = scene.lights.iter().enumerate();
        materials.extend(surfaces.map(|(number, light)| light_surface(lights, number, &light.kind)));
        for (whole, part) in rests(scene) {
            materials.push(rest(&part, &materials[whole], colored[whole]));
        }
        let pictures = TextureRecords::new(scene, &bvh.triangles);
        let mut uploader = Uploader { gpu, fingerprint: Fingerprint::default() };
        let textures = [
            uploader.records(NODES, nodes)?,
            uploader.records(TRIANGLES, &triangles)?,
            uploader.records(CORNERS, &corners)?,
            gpu.records(MAPS, &blank)?,
            uploader.records(MATERIALS, &materials)?,
            uploader.records(LIGHTS, &lights.records)?,
            uploader.records(EMITTING_TRIANGLES, &lights.triangles)?,
            uploader.records(ENVIRONMENT, &lights.environment)?,
            uploader.records(COORDINATES, &pictures.coordinates)?,
            uploader.records(TEXTURES, &pictures.materials)?,
            uploader.records(TEXTURES, &pictures.textures)?,
            uploader.records(TEXELS, &pictures.texels)?,
            uploader.records(SPECTRA, &spectra_record(scene))?,
            uploader.records(COLORS, &vertex_colors(scene, &bvh.triangles))?,
        ];
        let bytes = textures.iter().map(texture_bytes).sum();
        let views = textures.map(|texture| texture.create_view(&wgpu::TextureViewDescriptor::default()));
        let fingerprint = uploader.fingerprint;
        Ok(Self { bind_group: bind_group(gpu, layout, &views), bytes, views, fingerprint })
    }

    /// Tells the kernels where the maps' tiles lie.
    pub fn place_maps(&mut self, gpu: &Gpu, layout: &wgpu::BindGroupLayout, maps: &EnergyMaps) -> Result<(), Error> {
        let placed = maps.placements.iter().map(|map| map.as_ref().map(|map| (&map.tiles, map.first_texel)));
        let records = map_records(placed);
        self.fingerprint.digest(MAPS.what, &records);
        let texture = gpu.records(MAPS, &records)?;
        self.bytes += texture_bytes(&texture);
        self.views[MAPS_BINDING] = texture.create_view(&wgpu::TextureViewDescriptor::default());
        self.bind_group = bind_group(gpu, layout, &self.views);
        Ok(())
    }
}

fn bind_group(gpu: &Gpu, layout: &wgpu::BindGroupLayout, views: &[wgpu::TextureView]) -> wgpu::BindGroup {
    gpu.bind_resources(layout, views.iter().map(wgpu::BindingResource::TextureView).collect())
}

/// One cell for each layer.
fn blank_tiles(plan: &MapPlan) -> MapTiles {
    let square = |layer| MapSquare { layer, level: 0, x: 0, y: 0 };
    MapTiles::new(&plan.layout, [1, 1], (0..plan.layout.layers).map(|layer| (square(layer), [1, 1])))
}

fn triangle(scene: &Scene, t: &WorldTriangle) -> shaders::Triangle {
    // The surfaces of lights are objects and have materials beyond the scene's, and no holes.
    let object = scene.objects.get(t.object as usize);
    let has_holes = object.is_some_and(|object| object.has_holes(&scene.materials, t.material as usize));
    let is_blended = scene.materials.get(t.material as usize).is_some_and(|material| material.blend.is_some());
    let flag = |applies: bool, flag: u32| if applies { flag } else { 0 };
    shaders::Triangle {
        corner: t.corners[0].into(),
        object: t.object,
        edge_1: (t.corners[1] - t.corners[0]).into(),
        material: t.material,
        edge_2: (t.corners[2] - t.corners[0]).into(),
        flags: flag(t.normals.is_some(), triangle_flag::SMOOTH)
            | flag(has_holes, triangle_flag::HAS_HOLES)
            | flag(is_blended, triangle_flag::BLENDED),
    }
}

fn triangle_corners(t: &WorldTriangle, map: Option<&MapPlan>) -> shaders::TriangleCorners {
    let normals = t.normals.unwrap_or_default();
    let places = map.map_or([Vec2::ZERO; 3], |map| t.arrange(map.layout.corners[t.triangle as usize]));
    shaders::TriangleCorners {
        normal_0: normals[0].into(),
        texel_x_2: places[2].x,
        normal_1: normals[1].into(),
        texel_y_2: places[2].y,
        normal_2: normals[2].into(),
        charts: map.map_or(0, |map| map.layout.chart_count),
        texel_01: [places[0].x, places[0].y, places[1].x, places[1].y],
    }
}

/// The surface of a light: black, and it shines.
fn light_surface(lights: &Lights, number: usize, kind: &LightKind) -> shaders::Material {
    let group = (lights.groups.of_lights[number] as u32) << material_kind::GROUP_SHIFT;
    let blank = shaders::Material { tint: [1.0; 3], ior: 1.0, kind: group, ..Default::default() };
    match kind {
        LightKind::Rectangle { .. } | LightKind::Disk { .. } => {
            shaders::Material { emission: kind.strength().into(), emission_pdf_area: lights.pdf_area(number), ..blank }
        }
        _ => blank,
    }
}
