//! Checks scenes, whatever they were built from.

mod at;
mod lights;
mod materials;
mod meshes;
mod paper;
mod textures;

use std::{collections::HashMap, ops::Bound};

use glam::Vec3;

use self::{
    at::{At, above, is_in_reach},
    meshes::check_mesh,
};
use crate::{
    Camera, Error, LONGEST_WAVELENGTH, LightKind, Material, Object, OutputSettings, RenderSettings,
    SHORTEST_WAVELENGTH, Scene, Subject, Warning,
};

/// The least sine of the angle between the view and what is up.
const LEAST_UP_SINE: f32 = 1e-4;

/// Endings of the files that can be written.
const OUTPUT_ENDINGS: [&str; 2] = ["png", "exr"];

impl Scene {
    /// Checks that the scene can be rendered: indices in range, lengths that agree, finite numbers in their ranges,
    /// placements that can be inverted, names that differ.
    ///
    /// Returns what can be rendered but is hardly meant.
    ///
    /// # Errors
    /// The first fault, with the part of the scene and the field that it is in.
    pub fn validate(&self) -> Result<Vec<Warning>, Error> {
        let scene = At(Subject::Scene);
        scene.channels("background", self.background, 0.0.., "0 or greater")?;
        scene.channels("ambient", self.ambient, 0.0.., "0 or greater")?;
        check_camera(&self.camera)?;
        check_settings(&self.settings)?;
        self.check_irradiance_cache()?;
        check_output(&self.output)?;
        self.check_materials()?;
        self.check_lights()?;
        self.check_light_groups()?;
        self.check_objects()?;
        self.check_paper()?;
        let mut warnings = self.caustic_warnings();
        for object in &self.objects {
            self.object_warnings(object, &mut warnings);
        }
        warnings.extend(self.camera_in_light_warnings());
        Ok(warnings)
    }

    fn check_objects(&self) -> Result<(), Error> {
        At(Subject::Scene).require(!self.objects.is_empty(), "objects", || {
            "is empty, so there is nothing to render; add an object ([[objects]] in a scene file)".to_owned()
        })?;
        let mut names = HashMap::new();
        for (index, object) in self.objects.iter().enumerate() {
            let at = At(Subject::Object { index, name: object.name.clone() });
            at.unique_name(&mut names, index, &object.name)?;
            at.require(!object.name.contains(|c: char| "/\\".contains(c) || c.is_control()), "name", || {
                "must not contain /, \\ or control characters, for files are named after it".to_owned()
            })?;
            check_mesh(&object.mesh).map_err(|problem| at.error("mesh", problem))?;
            self.check_object_materials(&at, object)?;
            self.check_texture_coordinates(&at, object)?;
            check_placement(&at, object)?;
        }
        Ok(())
    }

    fn check_object_materials(&self, at: &At, object: &Object) -> Result<(), Error> {
        let (count, slots) = (object.materials.len(), object.mesh.material_slots.len().max(1));
        at.require(count == slots, "materials", || {
            format!("has {count} entries; it must have {slots}, one for each material slot of the mesh")
        })?;
        let known = self.materials.len();
        if let Some(index) = object.materials.iter().find(|index| **index >= known) {
            return Err(at.error("materials", format!("names material {index}; the scene has {known}, from 0")));
        }
        let Some(map_size) = object.map_size else { return Ok(()) };
        at.number("map_size", map_size, 2..=8192, "from 2 to 8192")?;
        let is_receiver = |index: &usize| self.materials[*index].is_receiver();
        at.require(object.materials.iter().any(is_receiver), "map_size", || {
            "is set, but the object is of glass, a mirror or metal, and only objects with a diffuse share have an energy \
             map; leave it out"
                .to_owned()
        })
    }

    /// Why no caustic can form, if none can.
    fn caustic_warnings(&self) -> Vec<Warning> {
        let mut materials = self.objects.iter().flat_map(|object| &object.materials).map(|i| &self.materials[*i]);
        let has_caster = materials.clone().any(|material| material.is_caster());
        let has_receiver = materials.clone().any(|material| material.is_receiver());
        let has_light = self.lights.iter().any(|light| !light.kind.is_dark()) || materials.any(Material::is_emissive);
        let is_dark = self.background == Vec3::ZERO && self.ambient == Vec3::ZERO;
        let findings = [
            (!has_caster, Warning::NoCaster),
            (!has_receiver, Warning::NoReceiver),
            (!has_light && is_dark, Warning::Dark),
            (!has_light && !is_dark, Warning::NoLight),
        ];
        findings.into_iter().filter(|(applies, _)| *applies).map(|(_, warning)| warning).collect()
    }

    fn object_warnings(&self, object: &Object, warnings: &mut Vec<Warning>) {
        let name = || object.name.clone();
        let count = object.mesh.degenerate_triangles();
        if count > 0 {
            warnings.push(Warning::DegenerateTriangles { object: name(), count });
        }
        let Some((_, boundary)) = self.dielectric_boundary(object) else { return };
        let open_edges = boundary.open_edges();
        if open_edges > 0 {
            warnings.push(Warning::OpenDielectric { object: name(), open_edges });
            return;
        }
        if boundary.signed_volume() < 0.0 {
            warnings.push(Warning::InsideOutDielectric { object: name() });
        }
    }

    fn camera_in_light_warnings(&self) -> Vec<Warning> {
        let holds_camera = |kind: &LightKind| {
            let LightKind::Sphere { center, radius, .. } = *kind else { return false };
            center.distance(self.camera.position) < radius
        };
        let lights = self.lights.iter().filter(|light| holds_camera(&light.kind));
        lights.map(|light| Warning::CameraInsideLight { light: light.name.clone() }).collect()
    }
}

impl Scene {
    fn check_irradiance_cache(&self) -> Result<(), Error> {
        let asked = self.settings.irradiance_cache == Some(true);
        self.obstacle_to_irradiance_cache().filter(|_| asked).map_or(Ok(()), |obstacle| {
            Err(At(Subject::Render).error("irradiance_cache", format!("is true, but {obstacle}; leave it out")))
        })
    }
}

fn check_camera(camera: &Camera) -> Result<(), Error> {
    let at = At(Subject::Camera);
    at.position("position", camera.position)?;
    at.position("look_at", camera.look_at)?;
    let view = camera.look_at - camera.position;
    at.require(view.length() > 0.0, "look_at", || "is the camera's position; it must be another point".to_owned())?;
    at.direction("up", camera.up)?;
    let sine = view.normalize().cross(camera.up.normalize()).length();
    at.require(sine > LEAST_UP_SINE, "up", || {
        format!("is {}, parallel to the view; it must point elsewhere", camera.up)
    })?;
    let fov_range = (Bound::Excluded(0.0), Bound::Excluded(180.0));
    at.number("vertical_fov", camera.vertical_fov, fov_range, "between 0 and 180 (degrees)")?;
    at.number("aperture_radius", camera.aperture_radius, 0.0.., "0 or greater (metres)")?;
    at.number("focus_distance", camera.focus_distance, above(0.0), "greater than 0 (metres)")
}

fn check_settings(settings: &RenderSettings) -> Result<(), Error> {
    let at = At(Subject::Render);
    at.number("width", settings.width, 1..=16384, "from 1 to 16384 (pixels)")?;
    at.number("height", settings.height, 1..=16384, "from 1 to 16384 (pixels)")?;
    settings.samples.map_or(Ok(()), |samples| at.number("samples", samples, 1.., "1 or greater"))?;
    let photons = settings.photons.unwrap_or(0);
    at.require(u32::try_from(photons).is_ok(), "photons", || format!("is {photons}; it must be at most {}", u32::MAX))?;
    let below_one = (Bound::Excluded(0.0), Bound::Included(1.0));
    at.number("target_error", settings.target_error, below_one, "greater than 0 and at most 1, such as 0.05")?;
    at.number("max_depth", settings.max_depth, 1..=1000, "from 1 to 1000")?;
    at.number("max_bounces", settings.max_bounces, 0..=1000, "from 0 to 1000")?;
    if let Some(wavelength) = settings.wavelength {
        let range = SHORTEST_WAVELENGTH as f32..=LONGEST_WAVELENGTH as f32;
        at.number("wavelength", wavelength, range, "from 380 to 780 (nm)")?;
    }
    settings.map_size.map_or(Ok(()), |map_size| at.number("map_size", map_size, 2..=8192, "from 2 to 8192"))?;
    let budget = |budget| at.number("map_budget", budget, 1..=65536, "from 1 to 65536 (MiB)");
    settings.map_budget.map_or(Ok(()), budget)
}

fn check_output(output: &OutputSettings) -> Result<(), Error> {
    let at = At(Subject::Output);
    at.number("exposure", output.exposure, .., "a number")?;
    let is_known = |ending: &std::ffi::OsStr| OUTPUT_ENDINGS.iter().any(|known| ending.eq_ignore_ascii_case(known));
    for file in &output.files {
        at.require(file.extension().is_some_and(is_known), "files", || {
            format!("{} has an ending that cannot be written; it must end in .png or .exr", file.display())
        })?;
    }
    Ok(())
}

fn check_placement(at: &At, object: &Object) -> Result<(), Error> {
    let placement = object.world_from_object;
    let can_be_inverted = placement.is_finite() && placement.inverse().is_finite();
    at.require(can_be_inverted, "world_from_object", || {
        "cannot be inverted; every number must be finite and the scale neither 0 nor extreme".to_owned()
    })?;
    let is_placed_in_reach = |position: &Vec3| is_in_reach(placement.transform_point3(*position));
    at.require(object.mesh.positions.iter().all(is_placed_in_reach), "world_from_object", || {
        "moves the mesh more than 1e9 metres from the origin; translate or scale it less".to_owned()
    })
}
