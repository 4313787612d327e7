//! Which objects have energy maps, and how their surfaces lie on them.

use diacaustic_scene::{Camera, Object, RenderSettings, Scene};
use diacaustic_surface::{MapLayout, MapTiles, TexelSurface, WorldTriangle, texel_areas, texel_surfaces};
use glam::{Mat3, Vec3};

/// Units of the plane of a map whose size nobody chose in the extent of the object: at least, at most. Its tiles may be coarser or finer.
const DEFAULT_SIZES: std::ops::RangeInclusive<f32> = 16.0..=2048.0;

/// An object's energy map before its tiles are known.
#[derive(Debug)]
pub(crate) struct MapPlan {
    pub layout: MapLayout,
    /// Whether the scene states its size: as many texels as the layout has, evenly.
    pub is_stated: bool,
    /// The object's triangles that receive light.
    pub receivers: Vec<WorldTriangle>,
    /// What sums are divided by in place of areas, in the profile `paper`.
    pub paper_size: Option<f64>,
}

impl MapPlan {
    /// A layer of the map that takes what comes from a side, of a record's index for it.
    pub fn layer(&self, record: u32) -> u32 {
        (record % 2).min(self.layout.layers - 1)
    }

    /// Area of each texel of tiles, m².
    pub fn texel_areas(&self, tiles: &MapTiles) -> Vec<f64> {
        texel_areas(&self.layout, tiles, &self.receivers)
    }

    /// The surface behind each texel of tiles.
    pub fn texel_surfaces(&self, tiles: &MapTiles) -> Vec<TexelSurface> {
        texel_surfaces(&self.layout, tiles, &self.receivers)
    }
}

/// The maps of all receivers, object by object.
pub(crate) fn plan_maps(scene: &Scene, triangles: &[WorldTriangle]) -> Vec<Option<MapPlan>> {
    let mut chunks = triangles.chunk_by(|a, b| a.object == b.object).peekable();
    let receives = |triangle: &&WorldTriangle| scene.materials[triangle.material as usize].is_receiver();
    let plan = |(index, object): (usize, &Object)| {
        let own = chunks.next_if(|chunk| chunk[0].object as usize == index).unwrap_or(&[]);
        if !object.materials.iter().any(|&material| scene.materials[material].is_receiver()) {
            return None;
        }
        let of_paper = scene.settings.paper.map(|profile| profile.map_size.texels(object));
        let stated = of_paper.or(object.map_size).or(scene.settings.map_size);
        let layout = match stated {
            Some(size) => MapLayout::new(object, size),
            None => MapLayout::with_texel_width(object, default_texel_width(&scene.camera, &scene.settings, object)),
        };
        let receivers = own.iter().filter(receives).copied().collect();
        let paper_size = scene.settings.paper.map(|profile| profile.map_size.divisor());
        Some(MapPlan { layout, is_stated: stated.is_some(), receivers, paper_size })
    };
    scene.objects.iter().enumerate().map(plan).collect()
}

/// A texel half as wide as the camera's pixels are on the object, on average over directions, where it is nearest to the point looked at;
/// metres.
pub(crate) fn default_texel_width(camera: &Camera, settings: &RenderSettings, object: &Object) -> f32 {
    let (low, high) = object
        .mesh
        .positions
        .iter()
        .map(|&p| object.world_from_object.transform_point3(p))
        .fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(low, high), p| (low.min(p), high.max(p)));
    let seen = camera.look_at.clamp(low, high);
    let view = seen - camera.position;
    let pixel = 2.0 * view.length() * (0.5 * camera.vertical_fov.to_radians()).tan() / settings.height as f32;
    // A surface seen at an angle spreads a pixel over 1/cos of its area.
    let thinnest = Mat3::IDENTITY.col((high - low).min_position());
    let cosine = view.normalize_or_zero().dot(thinnest).abs().max(0.1);
    let extent = (high - low).max_element();
    (0.5 * pixel / cosine.sqrt()).clamp(extent / DEFAULT_SIZES.end(), extent / DEFAULT_SIZES.start())
}
