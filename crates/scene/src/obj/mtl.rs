//! Reads materials from MTL.
//!
//! Not through tobj, whose 4.0.5 reader panics on a colour of fewer than three numbers and names no line.

use std::{fs, ops::RangeInclusive, path::Path};

use glam::Vec3;

use crate::{Dispersion, Error, Material, MaterialKind, ReadOptions, Warning, folder::Folder};

/// Index of refraction of a dielectric that states none.
const DEFAULT_IOR: f32 = 1.5;

/// Diffuse albedo of a material that states no colour.
const DEFAULT_ALBEDO: Vec3 = Vec3::splat(0.8);

/// The material of each slot, from the libraries beside the OBJ file; the last definition of a name counts.
/// Libraries that cannot be used and textures are noted.
pub(super) fn slot_materials(
    slots: &[String],
    libraries: &[String],
    obj_path: &Path,
    options: ReadOptions,
    warnings: &mut Vec<Warning>,
) -> Vec<Option<Material>> {
    let mut entries = Vec::new();
    let folder = Folder::of(obj_path, options);
    for library in libraries {
        let read = folder.inside(library).and_then(|path| load_mtl(&path).map_err(|error| error.to_string()));
        match read {
            Ok(library) => entries.extend(library),
            Err(problem) => warnings.push(Warning::MaterialLibrary { path: obj_path.to_owned(), problem }),
        }
    }
    let mut materials = Vec::new();
    for slot in slots {
        let entry = entries.iter().rfind(|entry| entry.name == *slot);
        if let Some(entry) = entry.filter(|entry| !entry.textures.is_empty()) {
            warnings.push(Warning::IgnoredTextures { material: slot.clone(), maps: entry.textures.join(", ") });
        }
        materials.push(entry.map(Entry::material));
    }
    materials
}

/// What an MTL file says about one material.
#[derive(Default)]
struct Entry {
    name: String,
    ambient: Option<Vec3>,
    diffuse: Option<Vec3>,
    specular: Option<Vec3>,
    transmission: Option<Vec3>,
    /// Radiance, W/(m² sr).
    emission: Option<Vec3>,
    shininess: Option<f32>,
    ior: Option<f32>,
    /// 1 for an opaque material.
    dissolve: Option<f32>,
    illumination_model: Option<f32>,
    /// The keywords of its textures.
    textures: Vec<String>,
}

impl Entry {
    fn material(&self) -> Material {
        let kind = self.kind();
        let can_emit = !matches!(kind, MaterialKind::Dielectric { .. });
        let emission = self.emission.filter(|_| can_emit).unwrap_or(Vec3::ZERO);
        Material { emission, ..Material::new(self.name.clone(), kind) }
    }

    fn kind(&self) -> MaterialKind {
        let model = self.illumination_model.unwrap_or(0.0);
        let albedo = self.diffuse.unwrap_or(DEFAULT_ALBEDO);
        let specular = self.specular.unwrap_or(Vec3::ZERO);
        let shininess = self.shininess.unwrap_or(0.0);
        if [4.0, 6.0, 7.0, 9.0].contains(&model) || self.dissolve.is_some_and(|dissolve| dissolve < 1.0) {
            let colour = self.diffuse.filter(|diffuse| *diffuse != Vec3::ZERO);
            MaterialKind::Dielectric {
                dispersion: Dispersion::None,
                ior: self.ior.unwrap_or(DEFAULT_IOR),
                tint: self.transmission.or(colour).unwrap_or(Vec3::ONE),
                absorption: Vec3::ZERO,
                roughness: 0.0,
                priority: 0,
            }
        } else if model == 3.0 {
            MaterialKind::Mirror { reflectance: self.specular.unwrap_or(Vec3::ONE) }
        } else if model == 2.0 && specular != Vec3::ZERO && shininess > 0.0 {
            let ambient = self.ambient.unwrap_or(Vec3::ZERO);
            MaterialKind::Phong { ambient, diffuse: albedo, specular, shininess }
        } else {
            MaterialKind::Diffuse { albedo }
        }
    }

    fn read_line(&mut self, keyword: &str, words: &[&str]) -> Result<(), String> {
        match keyword {
            "Ka" => self.ambient = Some(color(keyword, words, 0.0..=1.0)?),
            "Kd" => self.diffuse = Some(color(keyword, words, 0.0..=1.0)?),
            "Ks" => self.specular = Some(color(keyword, words, 0.0..=1.0)?),
            "Tf" => self.transmission = Some(color(keyword, words, 0.0..=1.0)?),
            "Ke" => self.emission = Some(color(keyword, words, 0.0..=f32::MAX)?),
            "Ns" => self.shininess = Some(number(keyword, words, 0.0..=f32::MAX)?),
            "Ni" => self.ior = Some(number(keyword, words, f32::MIN_POSITIVE..=f32::MAX)?),
            "d" => self.dissolve = Some(number(keyword, words.strip_prefix(&["-halo"]).unwrap_or(words), 0.0..=1.0)?),
            "Tr" => self.dissolve = Some(1.0 - number(keyword, words, 0.0..=1.0)?),
            "illum" => self.illumination_model = Some(number(keyword, words, 0.0..=f32::MAX)?),
            _ if keyword.starts_with("map_") || keyword.eq_ignore_ascii_case("bump") => {
                self.textures.push(keyword.to_owned());
            }
            _ => {}
        }
        Ok(())
    }
}

fn load_mtl(path: &Path) -> Result<Vec<Entry>, Error> {
    let bytes = fs::read(path).map_err(|cause| Error::Read { path: path.to_owned(), cause })?;
    parse_mtl(&String::from_utf8_lossy(&bytes), path)
}

fn parse_mtl(text: &str, path: &Path) -> Result<Vec<Entry>, Error> {
    let mut entries: Vec<Entry> = Vec::new();
    for (line, number) in text.lines().zip(1..) {
        let error = |problem| Error::Obj { path: path.to_owned(), line: Some(number), problem };
        let mut words = line.split_whitespace();
        let Some(keyword) = words.next() else { continue };
        if keyword == "newmtl" {
            let name = line.trim_start()["newmtl".len()..].trim();
            if name.is_empty() {
                return Err(error("newmtl without a name".to_owned()));
            }
            entries.push(Entry { name: name.to_owned(), ..Entry::default() });
        } else if let Some(entry) = entries.last_mut() {
            entry.read_line(keyword, &words.collect::<Vec<_>>()).map_err(error)?;
        }
    }
    Ok(entries)
}

/// Three channels, or one number that stands for all three.
fn color(keyword: &str, words: &[&str], allowed: RangeInclusive<f32>) -> Result<Vec3, String> {
    let mut channels = Vec::new();
    for word in words.iter().take(3) {
        channels.push(number(keyword, &[word], allowed.clone())?);
    }
    match channels[..] {
        [gray] => Ok(Vec3::splat(gray)),
        [r, g, b] => Ok(Vec3::new(r, g, b)),
        _ => Err(format!("{keyword} with {} numbers; it takes r g b", channels.len())),
    }
}

fn number(keyword: &str, words: &[&str], allowed: RangeInclusive<f32>) -> Result<f32, String> {
    let Some(word) = words.first() else { return Err(format!("{keyword} without a number")) };
    let number: f32 = word.parse().map_err(|_| format!("{keyword} with {word:?}, which is not a number"))?;
    if allowed.contains(&number) {
        return Ok(number);
    }
    let range = match (*allowed.start(), *allowed.end()) {
        (start, f32::MAX) if start > 0.0 => "greater than 0 and finite".to_owned(),
        (start, f32::MAX) => format!("{start} or greater and finite"),
        (start, end) => format!("from {start} to {end}"),
    };
    Err(format!("{keyword} with {number}; it must be {range}"))
}
