//! Reads scenes from TOML.

mod animation;
mod lights;
mod materials;
mod objects;
mod overrides;
mod paper;
mod refraction;
mod shapes;
mod table;
mod textures;

use std::{fs, io, path::Path};

use glam::Vec3;

pub use self::overrides::Override;
use self::{
    lights::LightReader,
    materials::MaterialReader,
    objects::ObjectReader,
    paper::{is_paper, read_paper},
    table::{Document, Table},
};
use crate::{
    Camera, Error, Layer, Location, OutputSettings, PixelFilter, ReadOptions, RenderSettings, Scene, Subject,
    ToneCurve, Warning, studio::framing_camera,
};

/// A scene from a file, valid, with what is odd about it.
#[derive(Clone, Debug, PartialEq)]
pub struct LoadedScene {
    /// The scene.
    pub scene: Scene,
    /// What [`Scene::validate`] and the mesh readers noted.
    pub warnings: Vec<Warning>,
}

/// How a scene file is read.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct SceneOptions {
    /// Values in place of the file's, in order.
    pub overrides: Vec<Override>,
    /// The frame of the file's `[animation]` whose values count; if none, those outside of it.
    pub frame: Option<u32>,
    /// What may be read. It concerns what glTF and OBJ files name; the scene file itself may name files anywhere.
    pub read: ReadOptions,
    /// Whether the file may leave its camera out: one that sees every object then stands for it.
    pub may_lack_camera: bool,
}

/// Reads a scene from a TOML file; the paths in it are relative to its folder.
///
/// # Errors
/// If the file or a mesh or image that it names cannot be read or makes no sense, or if [`Scene::validate`] refuses the scene.
pub fn load_scene(path: &Path) -> Result<LoadedScene, Error> {
    load_scene_with(path, &SceneOptions::default())
}

/// Reads a scene as [`load_scene`] does, with options.
///
/// # Errors
/// As [`load_scene`], and if an override leads to no place in the file.
pub fn load_scene_with(path: &Path, options: &SceneOptions) -> Result<LoadedScene, Error> {
    let not_text = |_| io::Error::new(io::ErrorKind::InvalidData, "it is no UTF-8 text, as scene files (.toml) are");
    let text = fs::read(path).and_then(|bytes| String::from_utf8(bytes).map_err(not_text));
    let text = text.map_err(|cause| Error::Read { path: path.to_owned(), cause })?;
    parse_scene_with(&text, path.parent().unwrap_or(Path::new("")), &path.display().to_string(), options)
}

/// Reads a scene from TOML text. Relative paths in it start at `base_dir`; messages call the text `file_name`.
///
/// # Errors
/// If the text or a mesh or image that it names cannot be read or makes no sense, or if [`Scene::validate`] refuses the scene.
pub fn parse_scene(text: &str, base_dir: &Path, file_name: &str) -> Result<LoadedScene, Error> {
    parse_scene_with(text, base_dir, file_name, &SceneOptions::default())
}

/// Reads a scene as [`parse_scene`] does, with options.
///
/// # Errors
/// As [`parse_scene`], if an override leads to no place in the text, and if a frame is asked for and the text has no `[animation]`.
pub fn parse_scene_with(
    text: &str,
    base_dir: &Path,
    file_name: &str,
    options: &SceneOptions,
) -> Result<LoadedScene, Error> {
    let still = Document::parse(text, file_name, &options.overrides)?;
    let mut overrides = options.overrides.clone();
    let mut seed_offset = 0;
    match (still.root().get("animation"), options.frame) {
        (Some(entry), frame) => {
            let table = entry.table("[animation]".to_owned(), "a table: [animation]")?;
            let at_frame = animation::at_frame(&table, frame.unwrap_or(0))?;
            if frame.is_some() {
                overrides.extend(at_frame.overrides);
                seed_offset = at_frame.seed_offset;
            }
        }
        (None, Some(_)) => return Err(still.root().error("has no [animation], so it has no frames")),
        (None, None) => {}
    }
    let document = Document::parse(text, file_name, &overrides)?;
    let sections = Sections::split(document.root(), options.may_lack_camera)?;
    let ReadScene { mut scene, mut warnings, tables_of_objects } = sections.read(base_dir, options.read)?;
    scene.settings.seed = scene.settings.seed.wrapping_add(seed_offset);
    warnings.extend(scene.validate().map_err(|error| sections.locate(error, &tables_of_objects))?);
    Ok(LoadedScene { scene, warnings })
}

/// A scene that is yet to be validated.
struct ReadScene {
    scene: Scene,
    warnings: Vec<Warning>,
    /// For each object, the number of its table.
    tables_of_objects: Vec<usize>,
}

/// Rays of the profile `paper` where a scene does not say.
const PAPER_RAYS: u64 = 1_000_000;

/// The tables of a scene file.
struct Sections<'d> {
    root: Table<'d>,
    /// None only if the scene may do without.
    camera: Option<Table<'d>>,
    render: Option<Table<'d>>,
    output: Option<Table<'d>>,
    paper: Option<Table<'d>>,
    materials: Vec<(String, Table<'d>)>,
    lights: Vec<Table<'d>>,
    objects: Vec<Table<'d>>,
}

impl<'d> Sections<'d> {
    fn split(root: Table<'d>, may_lack_camera: bool) -> Result<Self, Error> {
        root.allow_only(&[
            "background",
            "ambient",
            "animation",
            "camera",
            "render",
            "output",
            "paper",
            "materials",
            "lights",
            "objects",
        ])?;
        let optional =
            |key: &str, expected| root.get(key).map(|entry| entry.table(format!("[{key}]"), expected)).transpose();
        if !may_lack_camera {
            root.require("camera", "a table: [camera]")?;
        }
        Ok(Self {
            camera: optional("camera", "a table: [camera]")?,
            render: optional("render", "a table: [render]")?,
            output: optional("output", "a table: [output]")?,
            paper: optional("paper", "a table: [paper]")?,
            materials: named_tables(&root, "materials", "tables: [materials.a_name]")?,
            lights: listed_tables(&root, "lights", "an array of tables: [[lights]]")?,
            objects: listed_tables(&root, "objects", "an array of tables: [[objects]]")?,
            root,
        })
    }

    fn read(&self, base_dir: &Path, options: ReadOptions) -> Result<ReadScene, Error> {
        let color = |key| self.root.get(key).map_or(Ok(Vec3::ZERO), |entry| entry.color());
        let materials = MaterialReader::new(base_dir).read_all(&self.materials)?;
        let (background, ambient) = (color("background")?, color("ambient")?);
        let camera = self.camera.as_ref().map(read_camera).transpose()?;
        let settings = self.read_settings()?;
        let output = self.output.as_ref().map(|table| read_output(table, base_dir)).transpose()?.unwrap_or_default();
        let lights = LightReader::new(base_dir).read_all(&self.lights)?;
        let mut reader = ObjectReader::new(base_dir, options, materials);
        let (tables_of_objects, objects): (_, Vec<_>) = reader.read_all(&self.objects)?.into_iter().unzip();
        let camera = camera.unwrap_or_else(|| framing_camera(&objects));
        let materials = reader.materials;
        let scene = Scene { background, ambient, camera, settings, output, lights, materials, objects };
        Ok(ReadScene { scene, warnings: reader.warnings, tables_of_objects })
    }

    fn read_settings(&self) -> Result<RenderSettings, Error> {
        let is_paper = self.render.as_ref().map_or(Ok(false), is_paper)?;
        let default = match is_paper {
            // What the paper has not: unset, it is off. More rays are brighter there, so that there is always a number.
            true => RenderSettings {
                guiding: false,
                max_bounces: 0,
                photons: Some(PAPER_RAYS),
                ..RenderSettings::default()
            },
            false => RenderSettings::default(),
        };
        let settings = self.render.as_ref().map_or(Ok(default.clone()), |table| read_settings(table, default))?;
        match &self.paper {
            Some(table) if !is_paper => {
                Err(table.error("counts only with profile = \"paper\" in [render]; set it, or leave [paper] out"))
            }
            table => {
                Ok(RenderSettings { paper: is_paper.then(|| read_paper(table.as_ref())).transpose()?, ..settings })
            }
        }
    }

    /// Adds to an error of [`Scene::validate`] where the file sets what is at fault.
    fn locate(&self, mut error: Error, tables_of_objects: &[usize]) -> Error {
        if let Error::Invalid { at, subject, key, .. } = &mut error {
            *at = Some(self.location_of(subject, key, tables_of_objects));
        }
        error
    }

    fn location_of(&self, subject: &Subject, key: &str, tables_of_objects: &[usize]) -> Location {
        let table = match subject {
            Subject::Camera => self.camera.as_ref(),
            Subject::Render => self.render.as_ref(),
            Subject::Output => self.output.as_ref(),
            Subject::Paper => self.paper.as_ref(),
            Subject::Material { index, .. } => self.materials.get(*index).map(|(_, table)| table),
            Subject::Light { index, .. } => self.lights.get(*index),
            Subject::Object { index, .. } => tables_of_objects.get(*index).and_then(|table| self.objects.get(*table)),
            Subject::Scene => None,
        };
        table.unwrap_or(&self.root).location_of(key)
    }
}

fn named_tables<'d>(
    root: &Table<'d>,
    key: &'static str,
    expected: &'static str,
) -> Result<Vec<(String, Table<'d>)>, Error> {
    let Some(entry) = root.get(key) else { return Ok(Vec::new()) };
    let all = entry.table(format!("[{key}]"), expected)?;
    let named = |entry: table::Entry<'d>| {
        Ok((entry.key().to_owned(), entry.table(format!("[{key}.{}]", entry.key()), expected)?))
    };
    all.entries().into_iter().map(named).collect()
}

fn listed_tables<'d>(root: &Table<'d>, key: &'static str, expected: &'static str) -> Result<Vec<Table<'d>>, Error> {
    let Some(entry) = root.get(key) else { return Ok(Vec::new()) };
    let elements = entry.elements(expected)?.into_iter().enumerate();
    elements.map(|(index, element)| element.table(format!("[[{key}]] #{}", index + 1), expected)).collect()
}

fn read_camera(table: &Table<'_>) -> Result<Camera, Error> {
    table.allow_only(&["position", "look_at", "up", "vertical_fov", "aperture_radius", "focus_distance"])?;
    let position = table.require("position", "3 numbers [x, y, z], metres")?.vector()?;
    let look_at = table.require("look_at", "3 numbers [x, y, z], metres")?.vector()?;
    Ok(Camera {
        position,
        look_at,
        up: table.get("up").map_or(Ok(Vec3::Y), |entry| entry.vector())?,
        vertical_fov: table.require("vertical_fov", "a number of degrees")?.number()?,
        aperture_radius: table.get("aperture_radius").map_or(Ok(0.0), |entry| entry.number())?,
        focus_distance: table.get("focus_distance").map_or(Ok(position.distance(look_at)), |entry| entry.number())?,
    })
}

fn read_settings(table: &Table<'_>, default: RenderSettings) -> Result<RenderSettings, Error> {
    table.allow_only(&[
        "width",
        "height",
        "samples",
        "photons",
        "target_error",
        "seed",
        "max_depth",
        "max_bounces",
        "guiding",
        "footprints",
        "hue_filter",
        "map_filter",
        "irradiance_cache",
        "map_size",
        "map_budget",
        "filter",
        "wavelength",
        "profile",
    ])?;
    let whole = |key: &str, default| table.get(key).map_or(Ok(default), |entry| entry.whole32());
    let filters = [("box", PixelFilter::Box), ("blackman-harris", PixelFilter::BlackmanHarris)];
    Ok(RenderSettings {
        width: whole("width", default.width)?,
        height: whole("height", default.height)?,
        samples: table.get("samples").map(|entry| entry.whole32()).transpose()?,
        photons: table.get("photons").map(|entry| entry.whole()).transpose()?,
        target_error: table.get("target_error").map_or(Ok(default.target_error), |entry| entry.number())?,
        seed: whole("seed", default.seed)?,
        max_depth: whole("max_depth", default.max_depth)?,
        max_bounces: whole("max_bounces", default.max_bounces)?,
        guiding: table.get("guiding").map_or(Ok(default.guiding), |entry| entry.boolean())?,
        footprints: table.get("footprints").map_or(Ok(default.footprints), |entry| entry.boolean())?,
        hue_filter: table.get("hue_filter").map_or(Ok(default.hue_filter), |entry| entry.boolean())?,
        map_filter: table.get("map_filter").map_or(Ok(default.map_filter), |entry| entry.boolean())?,
        irradiance_cache: table.get("irradiance_cache").map(|entry| entry.boolean()).transpose()?,
        map_size: table.get("map_size").map(|entry| entry.whole32()).transpose()?,
        map_budget: table.get("map_budget").map(|entry| entry.whole32()).transpose()?,
        filter: table.get("filter").map_or(Ok(default.filter), |entry| entry.choice("filter", &filters))?,
        wavelength: table.get("wavelength").map(|entry| entry.number()).transpose()?,
        paper: None,
    })
}

fn read_output(table: &Table<'_>, base_dir: &Path) -> Result<OutputSettings, Error> {
    table.allow_only(&["files", "exposure", "tone", "layers"])?;
    let default = OutputSettings::default();
    let tones = [("plain", ToneCurve::Plain), ("filmic", ToneCurve::Filmic)];
    let mut files = Vec::new();
    if let Some(entry) = table.get("files") {
        for element in entry.elements("an array of file names")? {
            files.push(base_dir.join(element.string("a file name")?));
        }
    }
    Ok(OutputSettings {
        exposure: table.get("exposure").map_or(Ok(default.exposure), |entry| entry.number())?,
        tone: table.get("tone").map_or(Ok(default.tone), |entry| entry.choice("tone curve", &tones))?,
        files,
        layers: table.get("layers").map_or(Ok(Vec::new()), |entry| read_layers(&entry))?,
    })
}

/// All layers, none, or those of the names listed.
fn read_layers(entry: &table::Entry<'_>) -> Result<Vec<Layer>, Error> {
    if !entry.is_array() {
        let all = entry.boolean_or("true, false or an array of layers' names")?;
        return Ok(if all { Layer::ALL.to_vec() } else { Vec::new() });
    }
    let names = Layer::ALL.map(|layer| (layer.name(), layer));
    let elements = entry.elements("an array of layers' names")?;
    elements.iter().map(|element| element.choice("layer", &names)).collect()
}
