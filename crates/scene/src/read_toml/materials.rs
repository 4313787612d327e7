//! Reads the materials of a scene file.

use glam::Vec3;

use super::table::{Entry, Table};
use crate::{Error, METALS, Material, MaterialKind, Metal, SUBSTANCES, Substance, metal, substance};

/// Index of refraction of a coat or a thin wall that states none.
const DEFAULT_IOR: f32 = 1.5;

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

    fn keys(self) -> &'static [&'static str] {
        match self {
            Self::Diffuse => &["type", "albedo", "emission"],
            Self::Phong => &["type", "ambient", "diffuse", "specular", "shininess", "emission"],
            Self::Mirror => &["type", "reflectance", "emission"],
            Self::Conductor => &["type", "metal", "eta", "k", "roughness", "emission"],
            Self::Dielectric => &["type", "ior", "substance", "tint", "absorption", "roughness", "priority"],
            Self::ThinWalled => &["type", "ior", "substance", "tint"],
            Self::Coated => &["type", "albedo", "ior", "roughness", "emission"],
            Self::MetallicRoughness => &["type", "base_color", "metallic", "roughness", "emission"],
        }
    }
}

pub(super) fn read_material(name: &str, table: &Table<'_>) -> Result<Material, Error> {
    let expected = "the name of a material type, such as \"diffuse\" or \"dielectric\"";
    let material_type = table.require("type", expected)?.choice("material type", &MaterialType::NAMES)?;
    let emission = table.get("emission");
    if let (Some(entry), MaterialType::Dielectric | MaterialType::ThinWalled) = (&emission, material_type) {
        return Err(entry.error("is set, but glass takes no emission; leave it out, or use another material type"));
    }
    table.allow_only(material_type.keys())?;
    Ok(Material {
        emission: emission.map_or(Ok(Vec3::ZERO), |entry| entry.color())?,
        ..Material::new(name, read_kind(material_type, table)?)
    })
}

fn read_kind(material_type: MaterialType, table: &Table<'_>) -> Result<MaterialKind, Error> {
    let color = |key| table.require(key, "a colour: 3 numbers [r, g, b] or one number for gray")?.color();
    let number_or = |key, default| table.get(key).map_or(Ok(default), |entry| entry.number());
    Ok(match material_type {
        MaterialType::Diffuse => MaterialKind::Diffuse { albedo: color("albedo")? },
        MaterialType::Phong => MaterialKind::Phong {
            ambient: color("ambient")?,
            diffuse: color("diffuse")?,
            specular: color("specular")?,
            shininess: table.require("shininess", "a number, the exponent of the lobe")?.number()?,
        },
        MaterialType::Mirror => MaterialKind::Mirror { reflectance: color("reflectance")? },
        MaterialType::Conductor => {
            let (eta, k) = read_metal(table)?;
            MaterialKind::Conductor { eta, k, roughness: number_or("roughness", 0.0)? }
        }
        MaterialType::Dielectric => read_dielectric(table)?,
        MaterialType::ThinWalled => MaterialKind::ThinWalled {
            ior: match table.either_if_any("ior", "substance")? {
                Some(entry) => read_substance(&entry)?.0,
                None => DEFAULT_IOR,
            },
            tint: color_or(table, "tint", Vec3::ONE)?,
        },
        MaterialType::Coated => MaterialKind::Coated {
            albedo: color("albedo")?,
            ior: number_or("ior", DEFAULT_IOR)?,
            roughness: number_or("roughness", 0.0)?,
        },
        MaterialType::MetallicRoughness => MaterialKind::MetallicRoughness {
            base_color: color_or(table, "base_color", Vec3::ONE)?,
            metallic: number_or("metallic", 1.0)?,
            roughness: number_or("roughness", 1.0)?,
        },
    })
}

fn color_or(table: &Table<'_>, key: &str, default: Vec3) -> Result<Vec3, Error> {
    table.get(key).map_or(Ok(default), |entry| entry.color())
}

fn read_dielectric(table: &Table<'_>) -> Result<MaterialKind, Error> {
    let expected = "a number, the index of refraction, or \"substance\", a name such as \"water\"";
    let (ior, absorption) = read_substance(&table.either("ior", "substance", expected)?)?;
    Ok(MaterialKind::Dielectric {
        ior,
        tint: color_or(table, "tint", Vec3::ONE)?,
        absorption: color_or(table, "absorption", absorption)?,
        roughness: table.get("roughness").map_or(Ok(0.0), |entry| entry.number())?,
        priority: table.get("priority").map_or(Ok(0), |entry| entry.integer32())?,
    })
}

/// The index of refraction and the absorption of the substance that the entry `substance` names; of the entry `ior`, which states
/// the index alone, no absorption.
fn read_substance(entry: &Entry<'_>) -> Result<(f32, Vec3), Error> {
    if entry.key() == "ior" {
        return Ok((entry.number()?, Vec3::ZERO));
    }
    let name = entry.string("the name of a substance")?;
    let known = SUBSTANCES.map(|substance| substance.name);
    let Substance { ior, absorption, .. } =
        substance(name).ok_or_else(|| entry.unknown_name("substance", name, &known, "substances"))?;
    Ok((ior, absorption))
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
