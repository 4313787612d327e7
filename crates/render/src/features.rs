//! What a scene makes use of: kernels are compiled without the rest (`shaders/layout/features.wgsl`).

use std::collections::{HashMap, HashSet};

use diacaustic_scene::{Material, MaterialKind, PaperRefraction, RenderSettings, SMOOTH, Scene};
use diacaustic_shaders::{Kernel, light_kind, paper_refraction};
use rayon::prelude::*;

use crate::{
    Error,
    gpu::Gpu,
    layers::{has_data_layers, has_light_layers, has_variance, kept_group_count, kept_groups},
    lights::kinds_of_light,
};

/// What a kernel must be able to do.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub(crate) struct Features {
    /// Rough, coated and metallic-rough surfaces.
    gloss: bool,
    /// Metals.
    conductors: bool,
    /// Points and spots.
    point_lights: bool,
    /// Triangles that shine.
    surface_lights: bool,
    /// Light from infinitely far.
    distant_lights: bool,
    /// An environment.
    environment: bool,
    /// Pictures or colours that make surfaces differ from point to point.
    textures: bool,
    /// Colours or opacities at vertices.
    vertex_colors: bool,
    /// Surfaces that rays may pass as if they were not there.
    holes: bool,
    /// Surfaces of two materials.
    blends: bool,
    /// Light of single wavelengths.
    dispersion: bool,
    /// The kind of light that emits photons.
    photon_light_kind: u32,
    /// Whether a guide moves photons.
    guide: bool,
    /// Whether photons have footprints.
    footprints: bool,
    /// Whether the squares of what photons bring are summed.
    squares: bool,
    /// Whether the filter of maps mixes hues alone.
    mixes_hues: bool,
    /// The 2016 paper's model of light, and how it refracts.
    paper_refraction: u32,
    /// Whether camera paths note which texels they see.
    sightings: bool,
    /// Whether an irradiance cache is kept.
    irradiance_cache: bool,
    /// Light kept apart by how it came.
    light_layers: bool,
    /// What pixels show, and how much their samples vary.
    data_layers: bool,
    /// Light groups that are kept apart.
    light_groups: u32,
    /// The sum of the first half of the samples kept.
    halves: bool,
}

impl Features {
    pub fn of(scene: &Scene) -> Self {
        let parts = || scene.materials.iter().flat_map(|material| [Some(material), material.rest()]).flatten();
        let kinds = || parts().map(|material| &material.kind);
        let shining = kinds_of_light(scene);
        let shines = |wanted: &[u32]| shining.iter().any(|kind| wanted.contains(kind));
        Self {
            gloss: parts().any(has_gloss),
            conductors: kinds().any(|kind| matches!(kind, MaterialKind::Conductor { .. })),
            point_lights: shines(&[light_kind::POINT, light_kind::SPOT]),
            surface_lights: shines(&[light_kind::SURFACE]),
            distant_lights: shines(&[light_kind::DISTANT, light_kind::ENVIRONMENT]),
            environment: shines(&[light_kind::ENVIRONMENT]),
            textures: scene.has_vertex_factors() || parts().any(|material| material.textures.any()),
            vertex_colors: scene.has_vertex_factors(),
            holes: scene.has_holes(),
            blends: scene.materials.iter().any(|material| material.blend.is_some()),
            dispersion: scene.has_dispersion(),
            photon_light_kind: 0,
            guide: false,
            footprints: false,
            squares: false,
            mixes_hues: false,
            paper_refraction: paper_constant(&scene.settings),
            sightings: false,
            irradiance_cache: scene.keeps_irradiance_cache(),
            light_layers: has_light_layers(&scene.output.layers),
            data_layers: has_data_layers(&scene.output.layers),
            light_groups: kept_group_count(&kept_groups(scene)) as u32,
            halves: scene.settings.samples.is_none() || has_variance(&scene.output.layers),
        }
    }

    /// Whether the sum of the first half of the samples is kept.
    pub fn has_halves(self) -> bool {
        self.halves
    }

    /// Whether an irradiance cache is kept.
    pub fn has_irradiance_cache(self) -> bool {
        self.irradiance_cache
    }

    /// What the photons of one kind of light need: what other lights need does not count.
    pub fn for_photons_of(self, kind: u32, settings: &RenderSettings) -> Self {
        let Self { gloss, conductors, textures, vertex_colors, holes, blends, dispersion, paper_refraction, .. } = self;
        let RenderSettings { guiding: guide, footprints, map_filter: squares, .. } = *settings;
        let photons = Self { photon_light_kind: kind, guide, footprints, squares, ..Self::default() };
        Self { gloss, conductors, textures, vertex_colors, holes, blends, dispersion, paper_refraction, ..photons }
    }

    /// The same for camera paths that note what they see of the energy maps.
    pub fn with_sightings(self) -> Self {
        let sightings = Self { sightings: true, irradiance_cache: false, halves: false, ..self };
        Self { light_layers: false, data_layers: false, light_groups: 0, ..sightings }
    }

    /// What the filter of energy maps needs, which may mix hues alone.
    pub fn for_filter(self, mixes_hues: bool) -> Self {
        Self { light_groups: self.light_groups, mixes_hues, ..Self::default() }
    }

    /// The same for paths that begin at a lightmap's texels.
    pub fn for_baking(self) -> Self {
        Self { sightings: false, irradiance_cache: false, light_layers: true, data_layers: false, ..self }
    }

    /// The values of the kernel's override constants.
    fn constants(self, kernel: Kernel) -> Vec<(&'static str, f64)> {
        let all = [
            ("has_gloss", f64::from(self.gloss)),
            ("has_conductors", f64::from(self.conductors)),
            ("has_point_lights", f64::from(self.point_lights)),
            ("has_surface_lights", f64::from(self.surface_lights)),
            ("has_distant_lights", f64::from(self.distant_lights)),
            ("has_environment", f64::from(self.environment)),
            ("has_textures", f64::from(self.textures)),
            ("has_vertex_colors", f64::from(self.vertex_colors)),
            ("has_holes", f64::from(self.holes)),
            ("has_blends", f64::from(self.blends)),
            ("has_dispersion", f64::from(self.dispersion)),
            ("photon_light_kind", f64::from(self.photon_light_kind)),
            ("has_guide", f64::from(self.guide)),
            ("has_footprints", f64::from(self.footprints)),
            ("has_squares", f64::from(self.squares)),
            ("mixes_hues", f64::from(self.mixes_hues)),
            ("paper_refraction", f64::from(self.paper_refraction)),
            ("notes_sightings", f64::from(self.sightings)),
            ("has_irradiance_cache", f64::from(self.irradiance_cache)),
            ("has_light_layers", f64::from(self.light_layers)),
            ("has_data_layers", f64::from(self.data_layers)),
            ("light_group_count", f64::from(self.light_groups)),
            ("has_halves", f64::from(self.halves)),
        ];
        all.into_iter().filter(|(name, _)| kernel.source.contains(&format!("override {name}"))).collect()
    }
}

fn paper_constant(settings: &RenderSettings) -> u32 {
    match settings.paper.map(|paper| paper.refraction) {
        None => paper_refraction::NONE,
        Some(PaperRefraction::Printed) => paper_refraction::PRINTED,
        Some(PaperRefraction::Exact) => paper_refraction::EXACT,
    }
}

fn has_gloss(material: &Material) -> bool {
    match material.kind {
        MaterialKind::Coated { .. } | MaterialKind::MetallicRoughness { .. } => true,
        MaterialKind::Dielectric { roughness, .. }
        | MaterialKind::ThinWalled { roughness, .. }
        | MaterialKind::Conductor { roughness, .. } => roughness >= SMOOTH,
        MaterialKind::Diffuse { .. } | MaterialKind::Phong { .. } | MaterialKind::Mirror { .. } => false,
    }
}

/// The pipelines of a kernel, one for each set of features that scenes have asked for.
#[derive(Debug)]
pub(crate) struct Pipelines {
    kernel: Kernel,
    layouts: Vec<wgpu::BindGroupLayout>,
    made: HashMap<Features, wgpu::ComputePipeline>,
}

impl Pipelines {
    pub fn new(kernel: Kernel, layouts: &[&wgpu::BindGroupLayout]) -> Self {
        Self { kernel, layouts: layouts.iter().copied().cloned().collect(), made: HashMap::new() }
    }

    /// Compiles the pipelines for some sets of features, several at a time, to be there when they are asked for.
    pub fn prepare(&mut self, gpu: &Gpu, features: &[Features]) -> Result<(), Error> {
        let layouts: Vec<_> = self.layouts.iter().collect();
        let missing: HashSet<_> = features.iter().filter(|features| !self.made.contains_key(features)).collect();
        let make = |features: &Features| {
            let constants = features.constants(self.kernel);
            // The device's error scopes are each thread's own.
            let pipeline = gpu.guarded(|| Ok(gpu.specialised_pipeline(self.kernel, &layouts, &constants)))?;
            Ok((*features, pipeline))
        };
        let made: Vec<_> = missing.into_par_iter().map(make).collect::<Result<_, Error>>()?;
        self.made.extend(made);
        Ok(())
    }

    /// The pipeline for a set of features, compiled if it is the first to ask.
    pub fn get(&mut self, gpu: &Gpu, features: Features) -> wgpu::ComputePipeline {
        let layouts: Vec<_> = self.layouts.iter().collect();
        let make = || gpu.specialised_pipeline(self.kernel, &layouts, &features.constants(self.kernel));
        self.made.entry(features).or_insert_with(make).clone()
    }
}
