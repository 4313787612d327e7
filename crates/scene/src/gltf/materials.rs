//! Materials: metallic-roughness, and glass, coats and more by its extensions.

mod layers;
mod numbers;
mod parts;
mod pictures;

use std::collections::{BTreeMap, BTreeSet, HashMap, HashSet};

use glam::Vec3;
use gltf_json::{Root, material::AlphaMode, validation::Checked};

pub(super) use self::parts::is_whole_on;
use self::{
    layers::Layers,
    numbers::{Glass, Numbers, absorption, priority, share},
    parts::Parts,
    pictures::{ALPHA, METALLIC, Pictures, ROUGHNESS, Uses},
};
use super::{
    container::SUPPORTED,
    fault::{Fault, Result, entry, place, shortened},
    primitives::Needs,
    textures::{TextureReader, Use},
};
use crate::{Blend, ColorSpace, Dispersion, Material, MaterialKind, NormalMap, PLASTIC_REFLECTANCE, Texture, Textures};

/// Index of refraction of a material that states none.
const DEFAULT_IOR: f32 = 1.5;

const DISPERSION: &str = "KHR_materials_dispersion";

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
    pub(super) unsupported: BTreeMap<String, BTreeSet<String>>,
    pub(super) warnings: Vec<Fault>,
}

/// What a file says of a material.
#[derive(Clone, Copy)]
struct Described<'a> {
    name: &'a str,
    numbers: &'a Numbers,
    layers: &'a Layers,
    pictures: &'a Pictures,
    /// Where in the file, for messages.
    place: &'a str,
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

    /// What a material asks of the corners of its triangles.
    pub(super) fn needs(&self, material: Option<usize>, user: &str) -> Result<Needs> {
        let Some(index) = material else { return Ok(Needs::default()) };
        let material = entry(&self.root.materials, "materials", index, user)?;
        let uses = Uses::of(material, &self.place(index))?;
        let uv_set = uses.all().next().map(|used| used.uv_set);
        Ok(Needs {
            uv_set,
            has_normal_map: uses.normal.is_some_and(|normal| Some(normal.uv_set) == uv_set),
            has_coverage: material.alpha_mode != Checked::Valid(AlphaMode::Opaque),
        })
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
        let others = source.extensions.as_ref().map(|extensions| &extensions.others);
        let ior = source.extensions.as_ref().and_then(|extensions| extensions.ior.as_ref()).map(|ior| ior.ior.0);
        let is_unlit = source.extensions.as_ref().is_some_and(|extensions| extensions.unlit.is_some());
        let layers = Layers { is_unlit, ..Layers::of(others, ior, &place)? };
        self.warn_of_layers(&layers, glass.is_some(), &place);
        let described =
            Described { name: &name, numbers: &numbers, layers: &layers, pictures: &pictures, place: &place };
        let Some((glass, parts)) = glass else { return Ok(self.opaque(described)) };
        let blend = self.rest_of_glass(&parts, described);
        let mut material = if is_volume {
            let extras = source.extras.as_ref().map(|extras| extras.get());
            self.volume(name, extras, glass, &numbers, pictures, &place)?
        } else if self.is_volume(Some(index)) {
            self.warn(&place, "is on a surface that is not closed; there its glass has no thickness (thin_walled)");
            self.sheet(format!("{name} (thin-walled)"), glass, &numbers, pictures, &place)
        } else {
            self.sheet(name, glass, &numbers, pictures, &place)
        };
        material.blend = blend;
        Ok(material)
    }

    fn note_unsupported(&mut self, index: usize) {
        let extensions = self.root.materials[index].extensions.iter();
        for name in extensions
            .flat_map(|extensions| extensions.others.keys())
            .filter(|name| !SUPPORTED.contains(&name.as_str()))
        {
            let users = self.unsupported.entry(name.clone()).or_default();
            let name = self.names[index].clone();
            users.insert(name);
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
            coat: read(&uses.coat, "clearcoatTexture", ColorSpace::Linear)?.map(|(_, texture)| texture),
            coat_roughness: read(&uses.coat_roughness, "clearcoatRoughnessTexture", ColorSpace::Linear)?
                .map(|(_, texture)| texture),
            transmission: read(&uses.transmission, "transmissionTexture", ColorSpace::Linear)?
                .map(|(_, texture)| texture),
            normal: read(&uses.normal, "normalTexture", ColorSpace::Linear)?
                .map(|(_, texture)| NormalMap { texture, strength: uses.normal_scale }),
        })
    }

    /// What a material is as glass, if light passes through it.
    fn glass(
        &mut self,
        index: usize,
        numbers: &Numbers,
        pictures: &Pictures,
        place: &str,
    ) -> Result<Option<(Glass, Parts)>> {
        let Some(extensions) = &self.root.materials[index].extensions else { return Ok(None) };
        let ior = extensions.ior.as_ref().map_or(DEFAULT_IOR, |ior| ior.ior.0);
        let Some(transmission) = &extensions.transmission else { return Ok(None) };
        let factor = share(transmission.transmission_factor.0, "transmissionFactor", place)?;
        let parts = Parts::of(factor, numbers.metallic, pictures);
        if parts.most_glass() <= 0.0 {
            return Ok(None);
        }
        if parts.is_mean {
            self.warn(place, "has pictures of metal and of transmission that lie in different ways; the mean share of metal stands in");
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
        let glass = Glass {
            ior,
            dispersion: if dispersion == 0.0 { Dispersion::None } else { Dispersion::Abbe(20.0 / dispersion) },
            absorption: extensions.volume.as_ref().map_or(Ok(Vec3::ZERO), |volume| absorption(volume, place))?,
        };
        Ok(Some((glass, parts)))
    }

    /// What a material is where it is no glass, if there is such a place.
    fn rest_of_glass(&mut self, parts: &Parts, described: Described) -> Option<Box<Blend>> {
        if parts.is_whole() {
            return None;
        }
        let (share, texture) = parts.glass.clone();
        let (metallic, metal) = parts.metal.clone();
        let numbers = Numbers { metallic, ..described.numbers.without_shine() };
        let layers = Layers { coat: None, is_unlit: false, ..*described.layers };
        let mut rest = self.opaque(Described { numbers: &numbers, layers: &layers, ..described });
        if let MaterialKind::MetallicRoughness { .. } = rest.kind {
            rest.textures.metallic = metal;
        }
        Some(Box::new(Blend { share, texture, rest }))
    }

    fn warn_of_layers(&mut self, layers: &Layers, is_glass: bool, place: &str) {
        if is_glass && (layers.has_specular || layers.has_specular_pictures) {
            self.warn(place, "is glass and has KHR_materials_specular; glass reflects by its ior alone");
        } else if layers.has_specular_pictures {
            self.warn(place, "has pictures in KHR_materials_specular, which are not read; its factors alone are used");
        }
        if is_glass && layers.coat.is_some() {
            self.warn(place, "is glass and has KHR_materials_clearcoat; it shows without the coat");
        }
        if is_glass && layers.is_unlit {
            self.warn(place, "is glass and has KHR_materials_unlit; it shows as glass");
        }
    }

    /// A material through which no light passes.
    fn opaque(&mut self, described: Described) -> Material {
        let Described { name, numbers, layers, pictures, place } = described;
        let Numbers { base_color, metallic, roughness, mut emission, .. } = *numbers;
        let mut emission_picture = pictures.emission.clone().filter(|_| emission != Vec3::ZERO);
        let coat = self.coat(numbers, layers, pictures, place);
        let mut textures = pictures.textures();
        let mut blend = None;
        let has_no_metal = metallic == 0.0;
        let kind = if layers.is_unlit {
            emission = base_color;
            emission_picture = textures.color.take();
            textures = Textures::default();
            MaterialKind::Diffuse { albedo: Vec3::ZERO }
        } else if let Some([strength, roughness]) = coat {
            textures.roughness =
                pictures.coat_roughness.clone().map(|texture| Texture { channel: ROUGHNESS, ..texture });
            blend = self.rest_of_coat(strength, described);
            MaterialKind::Coated { albedo: base_color, ior: DEFAULT_IOR, roughness }
        } else if has_no_metal && layers.reflectance == Vec3::ZERO {
            textures.roughness = None;
            MaterialKind::Diffuse { albedo: base_color }
        } else {
            textures.metallic = pictures.channel(METALLIC);
            MaterialKind::MetallicRoughness { base_color, reflectance: layers.reflectance, metallic, roughness }
        };
        textures.emission = emission_picture;
        let mut material = Material { emission, textures, blend, ..Material::new(name, kind) };
        set_opacity(&mut material, numbers, pictures);
        material
    }

    /// What a material is where it has no coat, if it has one in part.
    fn rest_of_coat(&mut self, strength: f32, described: Described) -> Option<Box<Blend>> {
        let texture = described.pictures.coat.clone();
        if strength == 1.0 && texture.as_ref().is_none_or(|texture| texture.image.least().x >= 1.0) {
            return None;
        }
        let (numbers, layers) = (described.numbers.without_shine(), Layers { coat: None, ..*described.layers });
        let rest = self.opaque(Described { numbers: &numbers, layers: &layers, ..described });
        Some(Box::new(Blend { share: strength, texture, rest }))
    }

    /// Strength and roughness of a clear coat over what is no metal, if there is one.
    fn coat(&mut self, numbers: &Numbers, layers: &Layers, pictures: &Pictures, place: &str) -> Option<[f32; 2]> {
        let coat = layers.coat?;
        if numbers.metallic > 0.0 && pictures.metal.as_ref().is_none_or(|texture| texture.image.most()[METALLIC] > 0.0)
        {
            self.warn(
                place,
                "has KHR_materials_clearcoat over metal, which is not supported; it shows without the coat",
            );
            return None;
        }
        Some(coat)
    }

    fn sheet(&mut self, name: String, glass: Glass, numbers: &Numbers, pictures: Pictures, place: &str) -> Material {
        self.warn_of_emission(numbers, place);
        let Numbers { base_color: tint, roughness, .. } = *numbers;
        let kind = MaterialKind::ThinWalled { ior: glass.ior, tint, roughness };
        let mut material = Material { textures: pictures.textures(), ..Material::new(name, kind) };
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
    MaterialKind::MetallicRoughness {
        base_color: Vec3::ONE,
        reflectance: PLASTIC_REFLECTANCE,
        metallic: 1.0,
        roughness: 1.0,
    }
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
