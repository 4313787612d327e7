//! Reads the materials of a scene file.

use std::path::Path;

use glam::Vec3;

use super::{
    lights::read_group,
    refraction::{self, Refraction, read_refraction, read_substance},
    table::Table,
    textures::{DefaultChannel, Opacity, TextureReader},
};
use crate::{Blend, Error, METALS, Material, MaterialKind, Metal, PLASTIC_REFLECTANCE, Textures, metal};

/// Index of refraction of a coat or a thin wall that states none.
const DEFAULT_IOR: f32 = 1.5;

const COLOR: &str = "a colour: 3 numbers [r, g, b] or one number for gray";

/// The channels, from 0, in which glTF's pictures of metal hold the roughness and the share of metal.
const GLTF_ROUGHNESS: usize = 1;
const GLTF_METALLIC: usize = 2;

/// Keys of dielectrics that take no picture.
const DIELECTRIC_KEYS: [&str; 8] = {
    let [ior, substance, cauchy, sellmeier, abbe, dispersion] = refraction::KEYS;
    [ior, substance, cauchy, sellmeier, abbe, dispersion, "absorption", "priority"]
};

/// What `type` in a material's table stands for.
#[derive(Clone, Copy, PartialEq)]
enum MaterialType {
    Diffuse,
    Phong,
    Mirror,
    Conductor,
    Dielectric,
    ThinWalled,
    Coated,
    MetallicRoughness,
}

impl MaterialType {
    const NAMES: [(&str, Self); 8] = [
        ("diffuse", Self::Diffuse),
        ("phong", Self::Phong),
        ("mirror", Self::Mirror),
        ("conductor", Self::Conductor),
        ("dielectric", Self::Dielectric),
        ("thin_walled", Self::ThinWalled),
        ("coated", Self::Coated),
        ("metallic_roughness", Self::MetallicRoughness),
    ];

    /// Its keys: those that take a picture besides a colour or a number, and the others.
    fn keys(self) -> (&'static [&'static str], &'static [&'static str]) {
        match self {
            Self::Diffuse => (&["albedo", "emission", "normal", "opacity"], &[]),
            Self::Phong => (&["diffuse", "emission", "normal", "opacity"], &["ambient", "specular", "shininess"]),
            Self::Mirror => (&["reflectance", "emission", "normal", "opacity"], &[]),
            Self::Conductor => (&["roughness", "emission", "normal", "opacity"], &["metal", "eta", "k"]),
            Self::Dielectric => (&["tint", "roughness", "normal"], &DIELECTRIC_KEYS),
            Self::ThinWalled => (&["tint", "roughness", "normal", "opacity"], &["ior", "substance"]),
            Self::Coated => (&["albedo", "roughness", "emission", "normal", "opacity"], &["ior"]),
            Self::MetallicRoughness => {
                (&["base_color", "metallic", "roughness", "emission", "normal", "opacity"], &["reflectance"])
            }
        }
    }

    /// Refuses keys that it does not have, and pictures where it takes none.
    fn check_keys(self, table: &Table<'_>) -> Result<(), Error> {
        let is_glass = matches!(self, Self::Dielectric | Self::ThinWalled);
        if let Some(entry) = table.get("emission").filter(|_| is_glass) {
            return Err(entry.error("is set, but glass takes no emission; leave it out, or use another material type"));
        }
        if let Some(entry) = table.get("opacity").filter(|_| self == Self::Dielectric) {
            return Err(entry.error(
                "is set, but a dielectric bounds a volume, which has no holes; leave it out, or use the material type \
                 \"thin_walled\"",
            ));
        }
        let (with_picture, without) = self.keys();
        let group: &[&str] = if is_glass { &[] } else { &["group"] };
        table.allow_only(&[&["type"], with_picture, without, group, &["share", "rest"]].concat())?;
        for entry in without.iter().filter_map(|key| table.get(key)) {
            if entry.is_table_with("image") {
                let others = with_picture.join(", ");
                return Err(entry.error(format!("takes no picture; these keys do: {others}")));
            }
        }
        Ok(())
    }
}

/// Reads materials; holds the pictures that they share.
pub(super) struct MaterialReader<'a> {
    textures: TextureReader<'a>,
}

impl<'a> MaterialReader<'a> {
    pub(super) fn new(base_dir: &'a Path) -> Self {
        Self { textures: TextureReader::new(base_dir) }
    }

    pub(super) fn read_all(&mut self, tables: &[(String, Table<'_>)]) -> Result<Vec<Material>, Error> {
        let mut materials: Vec<_> =
            tables.iter().map(|(name, table)| self.read(name, table)).collect::<Result<_, _>>()?;
        let blends: Vec<_> =
            tables.iter().map(|(_, table)| self.read_blend(table, &materials)).collect::<Result<_, _>>()?;
        for (material, blend) in materials.iter_mut().zip(blends) {
            material.blend = blend;
        }
        Ok(materials)
    }

    /// What a material is in part, by the name of another; `materials` are all of them, still without.
    fn read_blend(&mut self, table: &Table<'_>, materials: &[Material]) -> Result<Option<Box<Blend>>, Error> {
        const SHARE: &str = "the share of the light, from 0 to 1, that meets this material and not the one of rest";
        const REST: &str = "the name of the material that the rest of the light meets";
        if table.get("share").is_none() && table.get("rest").is_none() {
            return Ok(None);
        }
        let (share, rest) = (table.require("share", SHARE)?, table.require("rest", REST)?);
        let name = rest.string(REST)?;
        let names: Vec<_> = materials.iter().map(|material| material.name.as_str()).collect();
        let Some(found) = materials.iter().find(|material| material.name == name) else {
            return Err(rest.unknown_name("material", name, &names, "materials"));
        };
        let (share, texture) = self.textures.number(&share, DefaultChannel::Color(0))?;
        Ok(Some(Box::new(Blend { share, texture, rest: found.clone() })))
    }

    fn read(&mut self, name: &str, table: &Table<'_>) -> Result<Material, Error> {
        let expected = "the name of a material type, such as \"diffuse\" or \"dielectric\"";
        let material_type = table.require("type", expected)?.choice("material type", &MaterialType::NAMES)?;
        material_type.check_keys(table)?;
        let mut keys = MaterialKeys { table, reader: &mut self.textures, textures: Textures::default() };
        let kind = keys.kind(material_type)?;
        let emission = keys.emission()?;
        let (opacity, opacity_cutoff) = keys.opacity()?;
        keys.textures.normal = table.get("normal").map(|entry| keys.reader.normal(&entry)).transpose()?;
        let group = read_group(table)?;
        Ok(Material { emission, group, opacity, opacity_cutoff, textures: keys.textures, ..Material::new(name, kind) })
    }
}

/// The table of a material, and the pictures met in it so far.
struct MaterialKeys<'m, 'a, 'd> {
    table: &'m Table<'d>,
    reader: &'m mut TextureReader<'a>,
    textures: Textures,
}

impl MaterialKeys<'_, '_, '_> {
    fn kind(&mut self, material_type: MaterialType) -> Result<MaterialKind, Error> {
        let table = self.table;
        Ok(match material_type {
            MaterialType::Diffuse => MaterialKind::Diffuse { albedo: self.color("albedo")? },
            MaterialType::Phong => MaterialKind::Phong {
                ambient: table.require("ambient", COLOR)?.color()?,
                diffuse: self.color("diffuse")?,
                specular: table.require("specular", COLOR)?.color()?,
                shininess: table.require("shininess", "a number, the exponent of the lobe")?.number()?,
            },
            MaterialType::Mirror => MaterialKind::Mirror { reflectance: self.color("reflectance")? },
            MaterialType::Conductor => {
                let (eta, k) = read_metal(table)?;
                MaterialKind::Conductor { eta, k, roughness: self.roughness_or(0.0)? }
            }
            MaterialType::Dielectric => self.dielectric()?,
            MaterialType::ThinWalled => MaterialKind::ThinWalled {
                ior: match table.either_if_any("ior", "substance")? {
                    Some(entry) if entry.key() == "ior" => entry.number()?,
                    Some(entry) => read_substance(&entry)?.ior,
                    None => DEFAULT_IOR,
                },
                tint: self.color_or("tint", Vec3::ONE)?,
                roughness: self.roughness_or(0.0)?,
            },
            MaterialType::Coated => MaterialKind::Coated {
                albedo: self.color("albedo")?,
                ior: table.get("ior").map_or(Ok(DEFAULT_IOR), |entry| entry.number())?,
                roughness: self.roughness_or(0.0)?,
            },
            MaterialType::MetallicRoughness => MaterialKind::MetallicRoughness {
                base_color: self.color_or("base_color", Vec3::ONE)?,
                reflectance: table.get("reflectance").map_or(Ok(PLASTIC_REFLECTANCE), |entry| entry.color())?,
                metallic: self.metallic_or(1.0)?,
                roughness: self.roughness_or(1.0)?,
            },
        })
    }

    fn dielectric(&mut self) -> Result<MaterialKind, Error> {
        let Refraction { ior, dispersion, absorption } = read_refraction(self.table)?;
        Ok(MaterialKind::Dielectric {
            ior,
            dispersion,
            tint: self.color_or("tint", Vec3::ONE)?,
            absorption: self.table.get("absorption").map_or(Ok(absorption), |entry| entry.color())?,
            roughness: self.roughness_or(0.0)?,
            priority: self.table.get("priority").map_or(Ok(0), |entry| entry.integer32())?,
        })
    }

    /// The material's colour, under the name that its type gives it.
    fn color(&mut self, key: &'static str) -> Result<Vec3, Error> {
        let entry = self.table.require(key, COLOR)?;
        let (color, texture) = self.reader.color(&entry)?;
        self.textures.color = texture;
        Ok(color)
    }

    fn color_or(&mut self, key: &'static str, default: Vec3) -> Result<Vec3, Error> {
        if self.table.get(key).is_some() { self.color(key) } else { Ok(default) }
    }

    fn roughness_or(&mut self, default: f32) -> Result<f32, Error> {
        let Some(entry) = self.table.get("roughness") else { return Ok(default) };
        let (roughness, texture) = self.reader.number(&entry, DefaultChannel::Color(GLTF_ROUGHNESS))?;
        self.textures.roughness = texture;
        Ok(roughness)
    }

    fn metallic_or(&mut self, default: f32) -> Result<f32, Error> {
        let Some(entry) = self.table.get("metallic") else { return Ok(default) };
        let (metallic, texture) = self.reader.number(&entry, DefaultChannel::Color(GLTF_METALLIC))?;
        self.textures.metallic = texture;
        Ok(metallic)
    }

    fn emission(&mut self) -> Result<Vec3, Error> {
        let Some(entry) = self.table.get("emission") else { return Ok(Vec3::ZERO) };
        let (emission, texture) = self.reader.color(&entry)?;
        self.textures.emission = texture;
        Ok(emission)
    }

    /// The opacity and its cutoff.
    fn opacity(&mut self) -> Result<(f32, Option<f32>), Error> {
        let Some(entry) = self.table.get("opacity") else { return Ok((1.0, None)) };
        let Opacity { factor, texture, cutoff } = self.reader.opacity(&entry)?;
        self.textures.opacity = texture;
        Ok((factor, cutoff))
    }
}

/// The index of refraction η + ik of a conductor, from `metal` or from `eta` and `k`.
fn read_metal(table: &Table<'_>) -> Result<(Vec3, Vec3), Error> {
    let Some(entry) = table.get("metal") else {
        let eta =
            table.require("eta", "a colour, the real part of the index, or \"metal\", a name such as \"gold\"")?;
        let k = table.require("k", "a colour, the imaginary part of the index of refraction")?;
        return Ok((eta.color()?, k.color()?));
    };
    for key in ["eta", "k"] {
        table.either_if_any("metal", key)?;
    }
    let name = entry.string("the name of a metal")?;
    let known = METALS.map(|metal| metal.name);
    let Metal { eta, k, .. } = metal(name).ok_or_else(|| entry.unknown_name("metal", name, &known, "metals"))?;
    Ok((eta, k))
}
