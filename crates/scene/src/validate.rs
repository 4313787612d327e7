//! Checks scenes, whatever they were built from.

use std::{
    collections::HashMap,
    fmt::Display,
    ops::{Bound, RangeBounds},
};

use glam::Vec3;

use crate::{
    Camera, Chart, Error, LightKind, Material, MaterialKind, Mesh, Object, OutputSettings, RenderSettings, Scene,
    Subject, Warning,
};

/// How far the square of a unit normal's length may be from 1.
const UNIT_TOLERANCE: f32 = 1e-3;

/// The least sine of the angle between the view and what is up.
const LEAST_UP_SINE: f32 = 1e-4;

/// The greatest coordinate, metres: areas of triangles within it, and their squares, are finite in single precision.
const GREATEST_COORDINATE: f32 = 1e9;

/// What is right of a position.
const REACH: &str = "each number must be finite and at most 1e9 in size";

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
        check_output(&self.output)?;
        for (index, material) in self.materials.iter().enumerate() {
            check_material(index, material)?;
        }
        self.check_lights()?;
        self.check_objects()?;
        let mut warnings = self.caustic_warnings();
        for object in &self.objects {
            self.object_warnings(object, &mut warnings);
        }
        warnings.extend(self.camera_in_light_warnings());
        Ok(warnings)
    }

    fn check_lights(&self) -> Result<(), Error> {
        let mut names = HashMap::new();
        for (index, light) in self.lights.iter().enumerate() {
            let at = At(Subject::Light { index, name: light.name.clone() });
            at.unique_name(&mut names, index, &light.name)?;
            let LightKind::Sphere { center, radius, flux } = light.kind else { continue };
            at.position("center", center)?;
            at.number("radius", radius, above(0.0), "greater than 0 (metres)")?;
            at.channels("flux", flux, 0.0.., "0 or greater (watts)")?;
            at.require(light.kind.strength().is_finite(), "radius", || {
                format!("is {radius:e}; so small a light of this flux has no finite radiance; it must be larger")
            })?;
        }
        Ok(())
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
        at.require(object.materials.iter().any(|index| !self.materials[*index].kind.is_caster()), "map_size", || {
            "is set, but the object is a caster (dielectric or mirror) and only receivers have an energy map; leave it out"
                .to_owned()
        })
    }

    /// Why no caustic can form, if none can.
    fn caustic_warnings(&self) -> Vec<Warning> {
        let mut kinds = self.objects.iter().flat_map(|object| &object.materials).map(|i| &self.materials[*i].kind);
        let has_caster = kinds.clone().any(MaterialKind::is_caster);
        let has_receiver = kinds.any(|kind| !kind.is_caster());
        let has_light = self.lights.iter().any(|light| !light.kind.is_dark());
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
        let Some(boundary) = self.dielectric_boundary(object) else { return };
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

fn check_camera(camera: &Camera) -> Result<(), Error> {
    let at = At(Subject::Camera);
    at.position("position", camera.position)?;
    at.position("look_at", camera.look_at)?;
    let view = camera.look_at - camera.position;
    at.require(view.length() > 0.0, "look_at", || "is the camera's position; it must be another point".to_owned())?;
    at.require(camera.up.length() > 0.0 && camera.up.length().is_finite(), "up", || {
        format!("is {}, which has no direction; it must be a vector such as [0, 1, 0]", camera.up)
    })?;
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
    at.number("samples", settings.samples, 1.., "1 or greater")?;
    at.require(u32::try_from(settings.photons).is_ok(), "photons", || {
        format!("is {}; it must be at most {}", settings.photons, u32::MAX)
    })?;
    at.number("max_depth", settings.max_depth, 1..=1000, "from 1 to 1000")?;
    settings.map_size.map_or(Ok(()), |map_size| at.number("map_size", map_size, 2..=8192, "from 2 to 8192"))
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

fn check_material(index: usize, material: &Material) -> Result<(), Error> {
    let at = At(Subject::Material { index, name: material.name.clone() });
    let share = |key, color| at.channels(key, color, 0.0..=1.0, "from 0 to 1");
    match material.kind {
        MaterialKind::Diffuse { albedo } => share("albedo", albedo),
        MaterialKind::Mirror { reflectance } => share("reflectance", reflectance),
        MaterialKind::Phong { ambient, diffuse, specular, shininess } => {
            share("ambient", ambient)?;
            share("diffuse", diffuse)?;
            share("specular", specular)?;
            at.number("shininess", shininess, above(0.0), "finite and greater than 0")
        }
        MaterialKind::Dielectric { ior, tint, absorption, .. } => {
            at.number("ior", ior, above(0.0), "finite and greater than 0")?;
            share("tint", tint)?;
            at.channels("absorption", absorption, 0.0.., "0 or greater (1/m)")
        }
        MaterialKind::Conductor { .. }
        | MaterialKind::ThinWalled { .. }
        | MaterialKind::Coated { .. }
        | MaterialKind::MetallicRoughness { .. } => Ok(()),
    }
}

/// What is wrong with a mesh.
fn check_mesh(mesh: &Mesh) -> Result<(), String> {
    let (vertices, triangles) = (mesh.positions.len(), mesh.triangles.len());
    let ensure = |ok: bool, problem: &dyn Fn() -> String| if ok { Ok(()) } else { Err(problem()) };
    ensure(triangles > 0, &|| "has no triangles".to_owned())?;
    ensure(u32::try_from(vertices).is_ok(), &|| format!("has {vertices} vertices; it must have fewer than 2^32"))?;
    if let Some(triangle) = mesh.triangles.iter().position(|corners| corners.iter().any(|v| *v as usize >= vertices)) {
        let corners = mesh.triangles[triangle];
        return Err(format!("has the triangle {triangle} of vertices {corners:?}, but {vertices} vertices, from 0"));
    }
    if let Some(position) = mesh.positions.iter().find(|position| !is_in_reach(**position)) {
        return Err(format!("has the position {:?}; {REACH}", position.to_array()));
    }
    for (what, count) in [("normals", mesh.normals.len()), ("texture coordinates", mesh.uvs.len())] {
        ensure(count == 0 || count == vertices, &|| format!("has {count} {what}; it must have {vertices} or none"))?;
    }
    let is_unit = |normal: &Vec3| (normal.length_squared() - 1.0).abs() <= UNIT_TOLERANCE;
    ensure(mesh.normals.iter().all(is_unit), &|| "has a normal whose length is not 1".to_owned())?;
    let has_finite_uvs = mesh.uvs.iter().all(|uv| uv.is_finite());
    ensure(has_finite_uvs, &|| "has a texture coordinate that is not finite".to_owned())?;
    ensure(mesh.chart != Chart::Natural || !mesh.uvs.is_empty(), &|| {
        "has a natural chart but no texture coordinates; give it some or make the chart automatic".to_owned()
    })?;
    check_triangle_slots(mesh)?;
    ensure(mesh.degenerate_triangles() < triangles, &|| format!("has {triangles} triangles, all of zero area"))
}

/// What is wrong with the material slots of a mesh.
fn check_triangle_slots(mesh: &Mesh) -> Result<(), String> {
    let (count, triangles, slots) = (mesh.triangle_slots.len(), mesh.triangles.len(), mesh.material_slots.len());
    if count != triangles && (slots > 1 || count > 0) {
        return Err(format!("has {count} triangle slots; it must have {triangles}, one for each triangle"));
    }
    match mesh.triangle_slots.iter().find(|slot| **slot as usize >= slots.max(1)) {
        Some(slot) => Err(format!("has a triangle of material slot {slot}, but {} slots, from 0", slots.max(1))),
        None => Ok(()),
    }
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

fn is_in_reach(position: Vec3) -> bool {
    position.abs().cmple(Vec3::splat(GREATEST_COORDINATE)).all()
}

/// The numbers greater than a bound.
fn above(bound: f32) -> (Bound<f32>, Bound<f32>) {
    (Bound::Excluded(bound), Bound::Unbounded)
}

/// The part of the scene under check.
struct At(Subject);

impl At {
    fn error(&self, key: &'static str, problem: String) -> Error {
        Error::Invalid { at: None, subject: self.0.clone(), key, problem }
    }

    fn require(&self, ok: bool, key: &'static str, problem: impl FnOnce() -> String) -> Result<(), Error> {
        if ok { Ok(()) } else { Err(self.error(key, problem())) }
    }

    /// Refuses numbers out of range, and infinity and NaN in any range.
    fn number<T>(&self, key: &'static str, number: T, allowed: impl RangeBounds<T>, right: &str) -> Result<(), Error>
    where
        T: PartialOrd + Copy + Display + Into<f64>,
    {
        let is_right = number.into().is_finite() && allowed.contains(&number);
        self.require(is_right, key, || format!("is {number}; it must be {right}"))
    }

    /// Refuses colours with a channel out of range, infinite or NaN.
    fn channels(
        &self,
        key: &'static str,
        color: Vec3,
        allowed: impl RangeBounds<f32>,
        right: &str,
    ) -> Result<(), Error> {
        let is_right = color.is_finite() && color.to_array().iter().all(|channel| allowed.contains(channel));
        self.require(is_right, key, || format!("is {color}; each channel must be {right}"))
    }

    fn position(&self, key: &'static str, position: Vec3) -> Result<(), Error> {
        self.require(is_in_reach(position), key, || format!("is {:?}; {REACH}", position.to_array()))
    }

    /// Refuses an empty name and one that an earlier entry of the list has.
    fn unique_name<'n>(&self, names: &mut HashMap<&'n str, usize>, index: usize, name: &'n str) -> Result<(), Error> {
        self.require(!name.is_empty(), "name", || "is empty; it must have a letter at least".to_owned())?;
        match names.insert(name, index) {
            Some(earlier) => {
                let (first, second) = (earlier + 1, index + 1);
                Err(self.error("name", format!("is given to numbers {first} and {second}; names must differ")))
            }
            None => Ok(()),
        }
    }
}
