//! The validated scene, as the renderer takes it.

use std::sync::Arc;

use glam::{Affine3A, Vec3};

use crate::{Camera, Layer, Light, Material, MaterialKind, Mesh, PaperProfile};

/// Everything that a render depends on. Built by a reader of this crate or in code; [`Scene::validate`] checks it.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    /// The view.
    pub camera: Camera,
    /// Radiance of what lies beyond every object, W/(m² sr): even light from everywhere, on top of the environment if there
    /// is one.
    pub background: Vec3,
    /// Ambient radiance of the `phong` material, W/(m² sr).
    pub ambient: Vec3,
    /// The emitters.
    pub lights: Vec<Light>,
    /// The materials.
    pub materials: Vec<Material>,
    /// The objects.
    pub objects: Vec<Object>,
    /// Size, sampling and limits.
    pub settings: RenderSettings,
    /// How the picture is written.
    pub output: OutputSettings,
}

/// A mesh placed in the world.
#[derive(Clone, Debug, PartialEq)]
pub struct Object {
    /// Its name in statistics, messages and the files of its energy map.
    pub name: String,
    /// Its surface, object frame. Objects may share one.
    pub mesh: Arc<Mesh>,
    /// Placement; invertible.
    pub world_from_object: Affine3A,
    /// For each material slot of the mesh (one if the mesh has none), an index into [`Scene::materials`].
    pub materials: Vec<usize>,
    /// Texels along the longer side of its energy map; the renderer's default if none.
    pub map_size: Option<u32>,
}

impl Scene {
    /// Whether light has wavelengths in it: one is set, or some object's index of refraction changes with the wavelength.
    pub fn has_dispersion(&self) -> bool {
        let mut shown = self.objects.iter().flat_map(|object| &object.materials);
        self.settings.wavelength.is_some() || shown.any(|&index| self.materials[index].dispersion().is_some())
    }

    /// Whether rays may pass some surface as if it were not there.
    pub fn has_holes(&self) -> bool {
        let has_holes =
            |object: &Object| object.materials.iter().any(|&index| object.has_holes(&self.materials, index));
        self.objects.iter().any(has_holes)
    }

    /// Whether some mesh has colours or opacities at its vertices.
    pub fn has_vertex_factors(&self) -> bool {
        let has_factors = |mesh: &Mesh| !mesh.colors.is_empty() || !mesh.opacities.is_empty();
        self.objects.iter().any(|object| has_factors(&object.mesh))
    }
}

impl Object {
    /// Whether rays may pass triangles of a material as if they were not there: by its opacity or by that of the mesh's vertices.
    ///
    /// # Panics
    /// If the material is out of range.
    pub fn has_holes(&self, materials: &[Material], material: usize) -> bool {
        let material = &materials[material];
        let is_solid = matches!(material.kind, MaterialKind::Dielectric { .. });
        material.has_holes() || !self.mesh.opacities.is_empty() && !is_solid
    }

    /// The index into [`Scene::materials`] of a triangle.
    ///
    /// # Panics
    /// If `triangle` is out of range; a validated object's slots are all in range.
    pub fn material_of(&self, triangle: usize) -> usize {
        let slot = self.mesh.triangle_slots.get(triangle).copied().unwrap_or(0);
        self.materials[slot as usize]
    }
}

/// Size, sampling and limits of a render.
#[derive(Clone, Debug, PartialEq)]
pub struct RenderSettings {
    /// Width of the picture, pixels.
    pub width: u32,
    /// Height of the picture, pixels.
    pub height: u32,
    /// Camera samples a pixel; as many as `target_error` asks for if none.
    pub samples: Option<u32>,
    /// Photons in all, over every light; as many as `target_error` asks for if none.
    pub photons: Option<u64>,
    /// The error at which photons and samples are enough: the root of the mean squared error of the radiance of pixels, relative to it.
    pub target_error: f32,
    /// Seed of every random number.
    pub seed: u32,
    /// The most surfaces that a photon or a camera path meets before it is cut off.
    pub max_depth: u32,
    /// The diffuse surfaces that light meets after the first one that the camera sees: 0 for direct light and caustics alone.
    pub max_bounces: u32,
    /// Whether photons are sent where a pilot found that they matter to the picture, and not evenly toward all casters.
    pub guiding: bool,
    /// Whether photons lay their flux over the part of the map that neighbouring photons leave open, and not over four texels.
    pub footprints: bool,
    /// Whether hues of energy maps are mixed where single wavelengths make them.
    pub hue_filter: bool,
    /// Whether the irradiance of energy maps is smoothed where it differs by no more than photons' noise.
    pub map_filter: bool,
    /// Whether light that bounces to receivers is measured by a few camera paths and shared by all others; if none, by renders that choose their
    /// samples, where the scene allows it.
    pub irradiance_cache: Option<bool>,
    /// Texels along the longer side of each energy map; chosen from the camera's pixel footprint if none.
    pub map_size: Option<u32>,
    /// Memory for the sums of energy maps whose size is left open, MiB; the renderer's choice if none.
    pub map_budget: Option<u32>,
    /// The pixel's reconstruction filter.
    pub filter: PixelFilter,
    /// The wavelength, nm, of the only light that there is; all of it if none. Pictures and maps are then gray: how much of this
    /// wavelength there is, against 1 for white of radiance 1.
    pub wavelength: Option<f32>,
    /// The 2016 paper's model of light, in place of the physical one.
    pub paper: Option<PaperProfile>,
}

/// The pixel's reconstruction filter.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PixelFilter {
    /// Even weight over the pixel's square.
    #[default]
    Box,
    /// The four-term Blackman–Harris window, 4 pixels wide (Harris 1978).
    BlackmanHarris,
}

/// How the picture is written.
#[derive(Clone, Debug, PartialEq)]
pub struct OutputSettings {
    /// Stops of exposure applied to PNG: radiance is multiplied by 2^exposure.
    pub exposure: f32,
    /// The tone curve applied to PNG.
    pub tone: ToneCurve,
    /// Files to write when the command line names none, as the scene file states them, resolved against its folder.
    pub files: Vec<std::path::PathBuf>,
    /// The layers that are kept beside the picture.
    pub layers: Vec<Layer>,
}

/// The tone curve applied before sRGB encoding.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ToneCurve {
    /// None: values over 1 are clipped.
    Plain,
    /// A filmic shoulder that keeps bright caustics from clipping.
    #[default]
    Filmic,
}

impl Default for RenderSettings {
    fn default() -> Self {
        Self {
            width: 512,
            height: 512,
            samples: None,
            photons: None,
            target_error: 0.1,
            seed: 0,
            max_depth: 32,
            max_bounces: 8,
            guiding: true,
            footprints: false,
            hue_filter: true,
            map_filter: false,
            irradiance_cache: None,
            map_size: None,
            map_budget: None,
            filter: PixelFilter::default(),
            wavelength: None,
            paper: None,
        }
    }
}

impl Default for OutputSettings {
    fn default() -> Self {
        Self { exposure: 0.0, tone: ToneCurve::default(), files: Vec::new(), layers: Vec::new() }
    }
}
