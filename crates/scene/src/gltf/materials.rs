//! Materials: metallic-roughness, and glass by its extensions.

use std::collections::{BTreeMap, HashMap, HashSet};

use glam::Vec3;
use gltf_json::{
    Root,
    extensions::{material::Volume, texture::TextureTransform},
    material::AlphaMode,
    texture::Info,
    validation::Checked,
};

use super::{
    fault::{Fault, Result, entry, place, shortened},
    textures::{TextureReader, Use},
};
use crate::{ColorSpace, Dispersion, Material, MaterialKind, NormalMap, Texture, Textures};

/// Index of refraction of a material that states none.
const DEFAULT_IOR: f32 = 1.5;
/// Reflectance along the normal that the metallic-roughness model has where there is no metal.
const DEFAULT_REFLECTANCE: f32 = 0.04;
/// How far another reflectance may be from it without a word.
const REFLECTANCE_TOLERANCE: f32 = 0.02;
/// What remains of a colour that absorbs everything, so that its absorption is finite.
const LEAST_ATTENUATION: f32 = 1e-6;

const DISPERSION: &str = "KHR_materials_dispersion";

/// The channels in which pictures hold the roughness, the share of metal and coverage.
const ROUGHNESS: usize = 1;
const METALLIC: usize = 2;
const ALPHA: usize = 3;

/// Reads materials; holds those read and what it found of interest.
pub(super) struct MaterialReader<'a, 'b> {
    root: &'a Root,
    textures: TextureReader<'a, 'b>,
    /// The name of each material of the file, which differ.
    names: Vec<String>,
    /// Those that are used, as they are in a scene.
    pub(super) materials: Vec<Material>,
    indices: HashMap<(Option<usize>, bool), usize>,
    /// Unsupported extensions, each with the materials that have it.
    pub(super) unsupported: BTreeMap<String, Vec<String>>,
    pub(super) warnings: Vec<Fault>,
}

impl<'a, 'b> MaterialReader<'a, 'b> {
    pub(super) fn new(root: &'a Root, textures: TextureReader<'a, 'b>) -> Self {
        Self {
            root,
            textures,
            names: unique_names(root),
            materials: Vec::new(),
            indices: HashMap::new(),
            unsupported: BTreeMap::new(),
            warnings: Vec::new(),
        }
    }

    /// The name of a material, or of the default one.
    pub(super) fn name(&self, material: Option<usize>) -> String {
        material.and_then(|index| self.names.get(index)).map_or_else(|| "default".to_owned(), String::clone)
    }

    /// The set of texture coordinates that a material takes, if it has pictures.
    pub(super) fn uv_set(&self, material: Option<usize>, user: &str) -> Result<Option<u32>> {
        let Some(index) = material else { return Ok(None) };
        let material = entry(&self.root.materials, "materials", index, user)?;
        Ok(Uses::of(material, &self.place(index))?.all().next().map(|used| used.uv_set))
    }

    /// Whether a material bounds a volume, where its mesh is closed.
    pub(super) fn is_volume(&self, material: Option<usize>) -> bool {
        let material = material.and_then(|index| self.root.materials.get(index));
        let extensions = material.and_then(|material| material.extensions.as_ref());
        extensions.is_some_and(|extensions| {
            extensions.transmission.as_ref().is_some_and(|transmission| transmission.transmission_factor.0 > 0.0)
                && extensions.volume.as_ref().is_some_and(|volume| volume.thickness_factor.0 > 0.0)
        })
    }

    /// The index in `materials` of a material of the file; `is_closed` says whether the surface that it is on encloses a volume.
    pub(super) fn index(&mut self, material: Option<usize>, is_closed: bool) -> Result<usize> {
        let key = (material, is_closed && self.is_volume(material));
        if let Some(index) = self.indices.get(&key) {
            return Ok(*index);
        }
        let read = match material {
            Some(index) => self.read(index, is_closed)?,
            None => Material::new("default", default_kind()),
        };
        self.materials.push(read);
        self.indices.insert(key, self.materials.len() - 1);
        Ok(self.materials.len() - 1)
    }

    fn place(&self, index: usize) -> String {
        place("materials", index, self.root.materials.get(index).and_then(|material| material.name.as_deref()))
    }

    fn warn(&mut self, place: &str, problem: impl Into<String>) {
        self.warnings.push(Fault::new(place, problem));
    }

    fn read(&mut self, index: usize, is_closed: bool) -> Result<Material> {
        let source = &self.root.materials[index];
        let place = self.place(index);
        self.note_unsupported(index);
        let pictures = self.pictures(source, &place)?;
        let numbers = Numbers::of(source, &place)?;
        let glass = self.glass(index, &numbers, &pictures, &place)?;
        let name = self.names[index].clone();
        let is_volume = is_closed && self.is_volume(Some(index));
        let Some(glass) = glass else { return Ok(opaque(name, &numbers, pictures)) };
        if !is_volume && self.is_volume(Some(index)) {
            self.warn(&place, "is on a surface that is not closed; there its glass has no thickness (thin_walled)");
            return Ok(self.sheet(format!("{name} (thin-walled)"), glass, &numbers, pictures, &place));
        }
        match is_volume {
            true => {
                self.volume(name, source.extras.as_ref().map(|extras| extras.get()), glass, &numbers, pictures, &place)
            }
            false => Ok(self.sheet(name, glass, &numbers, pictures, &place)),
        }
    }

    fn note_unsupported(&mut self, index: usize) {
        let extensions = self.root.materials[index].extensions.iter();
        for name in extensions.flat_map(|extensions| extensions.others.keys()).filter(|name| *name != DISPERSION) {
            let users = self.unsupported.entry(name.clone()).or_default();
            let name = self.names[index].clone();
            if !users.contains(&name) {
                users.push(name);
            }
        }
    }

    /// The pictures of a material that share the first one's texture coordinates.
    fn pictures(&mut self, source: &gltf_json::Material, place: &str) -> Result<Pictures> {
        let mut uses = Uses::of(source, place)?;
        let uv_set = uses.all().next().map(|used| used.uv_set);
        for (key, used) in uses.by_key() {
            if used.as_ref().is_some_and(|used| Some(used.uv_set) != uv_set) {
                *used = None;
                self.warn(
                    place,
                    format!(
                        "has other texture coordinates for {key} than for its other pictures, so {key} is not shown"
                    ),
                );
            }
        }
        let mut read = |used: &Option<Use>, key: &str, color_space| {
            let user = format!("{place}.{key}");
            used.as_ref().map(|used| self.textures.read(used, color_space, &user)).transpose()
        };
        let color = read(&uses.color, "baseColorTexture", ColorSpace::Srgb)?;
        let alpha = color.as_ref().filter(|(picture, _)| picture.has_alpha);
        Ok(Pictures {
            alpha: alpha.map(|(_, texture)| Texture { channel: ALPHA, ..texture.clone() }),
            color: color.map(|(_, texture)| texture),
            metal: read(&uses.metal, "metallicRoughnessTexture", ColorSpace::Linear)?.map(|(_, texture)| texture),
            emission: read(&uses.emission, "emissiveTexture", ColorSpace::Srgb)?.map(|(_, texture)| texture),
            transmission: read(&uses.transmission, "transmissionTexture", ColorSpace::Linear)?
                .map(|(_, texture)| texture),
            normal: read(&uses.normal, "normalTexture", ColorSpace::Linear)?
                .map(|(_, texture)| NormalMap { texture, strength: uses.normal_scale }),
        })
    }

    /// What a material is as glass, if light passes through it.
    fn glass(&mut self, index: usize, numbers: &Numbers, pictures: &Pictures, place: &str) -> Result<Option<Glass>> {
        let Some(extensions) = &self.root.materials[index].extensions else { return Ok(None) };
        let ior = extensions.ior.as_ref().map_or(DEFAULT_IOR, |ior| ior.ior.0);
        let Some(transmission) = &extensions.transmission else {
            self.warn_of_reflectance(ior, place);
            return Ok(None);
        };
        let factor = share(transmission.transmission_factor.0, "transmissionFactor", place)?;
        let mean = |texture: &Option<Texture>, channel| texture.as_ref().map_or(1.0, |t| t.image.mean()[channel]);
        // Metal is opaque, whatever its transmission.
        if factor == 0.0 || numbers.metallic * mean(&pictures.metal, METALLIC) > 0.5 {
            return Ok(None);
        }
        let passes = factor * mean(&pictures.transmission, 0);
        if passes < 0.999 {
            let fate = if passes < 0.5 { "none" } else { "all" };
            self.warn(place, format!("transmits {passes:.2} of its light (in the mean), which is not supported in part; {fate} of it passes"));
        }
        if passes < 0.5 {
            return Ok(None);
        }
        if ior <= 0.0 || !ior.is_finite() {
            return Err(Fault::new(
                place,
                format!("has the ior {ior}; that of glass must be finite and greater than 0"),
            ));
        }
        let dispersion = extensions.others.get(DISPERSION).and_then(|value| value.get("dispersion"));
        let dispersion = dispersion.map_or(Some(0.0), |value| value.as_f64()).unwrap_or(f64::NAN) as f32;
        if !(dispersion >= 0.0 && dispersion.is_finite()) {
            return Err(Fault::new(
                place,
                format!("has a {DISPERSION} whose dispersion is not a number of 0 or greater"),
            ));
        }
        Ok(Some(Glass {
            ior,
            dispersion: if dispersion == 0.0 { Dispersion::None } else { Dispersion::Abbe(20.0 / dispersion) },
            absorption: extensions.volume.as_ref().map_or(Ok(Vec3::ZERO), |volume| absorption(volume, place))?,
        }))
    }

    fn warn_of_reflectance(&mut self, ior: f32, place: &str) {
        let reflectance = ((ior - 1.0) / (ior + 1.0)).powi(2);
        if ((reflectance - DEFAULT_REFLECTANCE).abs() > REFLECTANCE_TOLERANCE) && ior > 0.0 {
            self.warn(
                place,
                format!("has the ior {ior}, which opaque materials do not support; it reflects as with 1.5"),
            );
        }
    }

    fn sheet(&mut self, name: String, glass: Glass, numbers: &Numbers, pictures: Pictures, place: &str) -> Material {
        self.warn_of_emission(numbers, place);
        let roughness =
            numbers.roughness * pictures.metal.as_ref().map_or(1.0, |texture| texture.image.mean()[ROUGHNESS]);
        if roughness >= crate::SMOOTH {
            self.warn(
                place,
                format!("is a sheet of glass of roughness {roughness:.2} (in the mean), which is shown without"),
            );
        }
        let mut material = Material::new(name, MaterialKind::ThinWalled { ior: glass.ior, tint: numbers.base_color });
        material.textures = Textures { roughness: None, ..pictures.textures() };
        set_opacity(&mut material, numbers, &pictures);
        material
    }

    fn volume(
        &mut self,
        name: String,
        extras: Option<&str>,
        glass: Glass,
        numbers: &Numbers,
        pictures: Pictures,
        place: &str,
    ) -> Result<Material> {
        self.warn_of_emission(numbers, place);
        if numbers.alpha_mode != AlphaMode::Opaque && (numbers.alpha < 1.0 || pictures.alpha.is_some()) {
            self.warn(place, "has an alphaMode, but bounds a volume, which has no holes; its alpha is not shown");
        }
        let kind = MaterialKind::Dielectric {
            ior: glass.ior,
            dispersion: glass.dispersion,
            tint: numbers.base_color,
            absorption: glass.absorption,
            roughness: numbers.roughness,
            priority: priority(extras, place)?,
        };
        Ok(Material { textures: pictures.textures(), ..Material::new(name, kind) })
    }

    fn warn_of_emission(&mut self, numbers: &Numbers, place: &str) {
        if numbers.emission != Vec3::ZERO {
            self.warn(place, "is glass and has an emissiveFactor; glass shines not, so it is left out");
        }
    }
}

/// A material through which no light passes.
fn opaque(name: String, numbers: &Numbers, pictures: Pictures) -> Material {
    let Numbers { base_color, metallic, roughness, emission, .. } = *numbers;
    let emission_picture = pictures.emission.clone().filter(|_| emission != Vec3::ZERO);
    let mut material = Material {
        emission,
        ..Material::new(name, MaterialKind::MetallicRoughness { base_color, metallic, roughness })
    };
    material.textures =
        Textures { emission: emission_picture, metallic: pictures.channel(METALLIC), ..pictures.textures() };
    set_opacity(&mut material, numbers, &pictures);
    material
}

/// Sets what an alpha mode other than OPAQUE makes of the coverage.
fn set_opacity(material: &mut Material, numbers: &Numbers, pictures: &Pictures) {
    if numbers.alpha_mode == AlphaMode::Opaque {
        return;
    }
    material.opacity = numbers.alpha;
    material.textures.opacity = pictures.alpha.clone();
    material.opacity_cutoff = (numbers.alpha_mode == AlphaMode::Mask).then_some(numbers.alpha_cutoff);
}

/// What a surface without a material is.
fn default_kind() -> MaterialKind {
    MaterialKind::MetallicRoughness { base_color: Vec3::ONE, metallic: 1.0, roughness: 1.0 }
}

/// A name for each material, made to differ by numbers.
fn unique_names(root: &Root) -> Vec<String> {
    let mut taken = HashSet::new();
    let mut numbers = HashMap::<String, usize>::new();
    let mut names = Vec::new();
    for (index, material) in root.materials.iter().enumerate() {
        let stated = material.name.as_deref().filter(|name| !name.is_empty()).map(shortened);
        let base = stated.unwrap_or_else(|| format!("material {index}"));
        let mut name = base.clone();
        while !taken.insert(name.clone()) {
            let number = numbers.entry(base.clone()).or_insert(1);
            *number += 1;
            name = format!("{base} {number}");
        }
        names.push(name);
    }
    names
}

/// The numbers of the metallic-roughness model.
struct Numbers {
    base_color: Vec3,
    metallic: f32,
    roughness: f32,
    emission: Vec3,
    alpha: f32,
    alpha_mode: AlphaMode,
    alpha_cutoff: f32,
}

impl Numbers {
    fn of(source: &gltf_json::Material, place: &str) -> Result<Self> {
        let model = &source.pbr_metallic_roughness;
        let [r, g, b, alpha] = model.base_color_factor.0;
        for channel in [r, g, b, alpha] {
            share(channel, "baseColorFactor", place)?;
        }
        let strength = source.extensions.as_ref().and_then(|extensions| extensions.emissive_strength.as_ref());
        let strength = strength.map_or(1.0, |strength| strength.emissive_strength.0);
        let emission = Vec3::from(source.emissive_factor.0) * strength;
        if !emission.is_finite() || emission.cmplt(Vec3::ZERO).any() {
            return Err(Fault::new(place, format!("has the emission {emission}; it must be finite and 0 or greater")));
        }
        let Checked::Valid(alpha_mode) = source.alpha_mode else {
            return Err(Fault::new(place, "has an unknown alphaMode; it must be OPAQUE, MASK or BLEND"));
        };
        let cutoff = source.alpha_cutoff.map_or(0.5, |cutoff| cutoff.0);
        if !(cutoff >= 0.0 && cutoff.is_finite()) {
            return Err(Fault::new(place, format!("has the alphaCutoff {cutoff}; it must be 0 or greater")));
        }
        Ok(Self {
            base_color: Vec3::new(r, g, b),
            metallic: share(model.metallic_factor.0, "metallicFactor", place)?,
            roughness: share(model.roughness_factor.0, "roughnessFactor", place)?,
            emission,
            // Above a cutoff of 1 nothing shows.
            alpha: if cutoff > 1.0 && alpha_mode == AlphaMode::Mask { 0.0 } else { alpha },
            alpha_mode,
            alpha_cutoff: cutoff.min(1.0),
        })
    }
}

/// A number from 0 to 1.
fn share(number: f32, key: &str, place: &str) -> Result<f32> {
    if (0.0..=1.0).contains(&number) {
        return Ok(number);
    }
    Err(Fault::new(place, format!("has {number} as its {key}; it must be from 0 to 1")))
}

/// What glass does to light, besides its colour and roughness.
struct Glass {
    ior: f32,
    dispersion: Dispersion,
    /// Absorption coefficient, 1/m.
    absorption: Vec3,
}

/// The absorption coefficient, 1/m, that leaves the attenuation colour after the attenuation distance.
fn absorption(volume: &Volume, place: &str) -> Result<Vec3> {
    let (color, distance) = (volume.attenuation_color.0, volume.attenuation_distance.0);
    for channel in color {
        share(channel, "attenuationColor", place)?;
    }
    if distance.is_nan() || distance <= 0.0 {
        return Err(Fault::new(place, format!("has an attenuationDistance of {distance}; it must be greater than 0")));
    }
    let coefficients = color.map(|channel| -channel.max(LEAST_ATTENUATION).ln() / distance);
    // −ln 1 is −0.
    Ok(Vec3::from(coefficients).max(Vec3::ZERO).min(Vec3::splat(f32::MAX)))
}

/// The rank of a volume, from a material's `extras`: `{ "priority": 2 }`.
fn priority(extras: Option<&str>, place: &str) -> Result<i32> {
    let extras: serde_json::Value = extras.and_then(|text| serde_json::from_str(text).ok()).unwrap_or_default();
    let Some(priority) = extras.get("priority") else { return Ok(0) };
    let whole = priority.as_i64().and_then(|number| i32::try_from(number).ok());
    whole.ok_or_else(|| Fault::new(place, "has extras.priority, which must be a whole number of 32 bits"))
}

/// The pictures that a material names.
struct Uses {
    color: Option<Use>,
    metal: Option<Use>,
    normal: Option<Use>,
    normal_scale: f32,
    emission: Option<Use>,
    transmission: Option<Use>,
}

impl Uses {
    fn of(source: &gltf_json::Material, place: &str) -> Result<Self> {
        let model = &source.pbr_metallic_roughness;
        let info = |info: &Option<Info>| info.as_ref().map(Use::of);
        let normal = source.normal_texture.as_ref();
        let normal_scale = normal.map_or(1.0, |normal| normal.scale);
        if !normal_scale.is_finite() {
            return Err(Fault::new(place, "has a normalTexture whose scale is not finite"));
        }
        let normal = normal.map(|normal| {
            let others =
                normal.extensions.as_ref().and_then(|extensions| extensions.others.get("KHR_texture_transform"));
            let transform = others.map(|value| gltf_json::deserialize::from_value::<TextureTransform>(value.clone()));
            let transform = transform.transpose().map_err(|error| {
                Fault::new(place, format!("has a normalTexture with a damaged KHR_texture_transform: {error}"))
            })?;
            Ok(Use::new(normal.index.value(), normal.tex_coord, transform))
        });
        let transmission = source.extensions.as_ref().and_then(|extensions| extensions.transmission.as_ref());
        Ok(Self {
            color: info(&model.base_color_texture),
            metal: info(&model.metallic_roughness_texture),
            normal: normal.transpose()?,
            normal_scale,
            emission: info(&source.emissive_texture),
            transmission: transmission.and_then(|transmission| info(&transmission.transmission_texture)),
        })
    }

    fn all(&self) -> impl Iterator<Item = &Use> {
        [&self.color, &self.metal, &self.normal, &self.emission].into_iter().flatten()
    }

    fn by_key(&mut self) -> [(&'static str, &mut Option<Use>); 4] {
        [
            ("baseColorTexture", &mut self.color),
            ("metallicRoughnessTexture", &mut self.metal),
            ("normalTexture", &mut self.normal),
            ("emissiveTexture", &mut self.emission),
        ]
    }
}

/// The pictures of a material.
struct Pictures {
    color: Option<Texture>,
    /// The coverage in `color`, if there is any.
    alpha: Option<Texture>,
    metal: Option<Texture>,
    normal: Option<NormalMap>,
    emission: Option<Texture>,
    transmission: Option<Texture>,
}

impl Pictures {
    fn channel(&self, channel: usize) -> Option<Texture> {
        self.metal.as_ref().map(|texture| Texture { channel, ..texture.clone() })
    }

    /// Those that glass and opaque materials have.
    fn textures(&self) -> Textures {
        Textures {
            color: self.color.clone(),
            roughness: self.channel(ROUGHNESS),
            normal: self.normal.clone(),
            ..Textures::default()
        }
    }
}
