//! Materials of a glTF file.

use std::path::Path;

use gltf_json::{
    Image, Material, Root, Texture,
    extensions::material::{
        AttenuationColor, AttenuationDistance, IndexOfRefraction, Ior, Material as Extensions, ThicknessFactor,
        Transmission, TransmissionFactor, Unlit, Volume,
    },
    image::MimeType,
    material::{AlphaMode, PbrBaseColorFactor, PbrMetallicRoughness, StrengthFactor},
    texture::{Info, MagFilter, MinFilter, Sampler, WrappingMode},
    validation::Checked::Valid,
};

use super::buffer::Bytes;
use crate::{Display, Error, Picture, png::encode_png};

/// A named material.
#[derive(Clone, Debug, PartialEq)]
pub struct GltfMaterial {
    /// Its name.
    pub name: String,
    /// What it does to light.
    pub surface: GltfSurface,
    /// The lightmap whose light it shows, for applications that shade by the irradiance itself (`extras`).
    pub lightmap: Option<LightmapNote>,
}

/// Where the irradiance of a surface stands.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
#[serde(rename_all = "camelCase")]
pub struct LightmapNote {
    /// Its file.
    pub file: String,
    /// What the names of its channels begin with: nothing on the front, `back.` on the back.
    pub channels: &'static str,
    /// The set of texture coordinates by which it lies on the surface.
    pub tex_coord: u32,
    /// What it holds.
    pub quantity: &'static str,
}

/// What a surface does to light.
#[derive(Clone, Debug, PartialEq)]
pub enum GltfSurface {
    /// It shows a picture, whatever light there is (`KHR_materials_unlit`), on its front.
    Shown(ShownPicture),
    /// Glass, on both sides (`KHR_materials_transmission`).
    Glass {
        /// Index of refraction.
        ior: f32,
        /// Factor on light that passes, 0 to 1.
        tint: [f32; 3],
        /// Roughness, 0 to 1.
        roughness: f32,
        /// Absorption coefficient of the volume that the surface bounds, 1/m; none where it bounds none.
        absorption: Option<[f32; 3]>,
    },
    /// Metal, on both sides.
    Metal {
        /// Reflectance along the normal, 0 to 1.
        color: [f32; 3],
        /// Roughness, 0 to 1.
        roughness: f32,
    },
}

/// A picture on a surface.
#[derive(Clone, Debug, PartialEq)]
pub struct ShownPicture {
    /// Pixels along x.
    pub width: u32,
    /// Pixels along y.
    pub height: u32,
    /// Radiance, W/(m² sr), linear Rec. 709, row by row from the top left.
    pub radiance: Vec<[f32; 3]>,
    /// Opacity of each pixel, 0 to 1; all are opaque if none.
    pub opacity: Option<Vec<f32>>,
    /// The set of texture coordinates by which it lies on the surface.
    pub uv_set: u32,
    /// How radiance becomes the picture's bytes.
    pub display: Display,
}

/// What an application finds beside a material.
#[derive(serde::Serialize)]
struct Extras<'n> {
    lightmap: &'n LightmapNote,
}

/// Adds a material; `path` is for messages.
pub(super) fn push(root: &mut Root, bytes: &mut Bytes, material: &GltfMaterial, path: &Path) -> Result<(), Error> {
    let mut written = match &material.surface {
        GltfSurface::Shown(picture) => shown(root, bytes, picture, path)?,
        GltfSurface::Glass { ior, tint, roughness, absorption } => glass(*ior, *tint, *roughness, *absorption),
        GltfSurface::Metal { color, roughness } => Material {
            pbr_metallic_roughness: factors(*color, 1.0, *roughness),
            double_sided: true,
            ..Material::default()
        },
    };
    written.name = Some(material.name.clone());
    let note = material.lightmap.as_ref().map(|note| serde_json::value::to_raw_value(&Extras { lightmap: note }));
    written.extras = note.transpose().map_err(|error| Error::Write { path: path.to_owned(), source: error.into() })?;
    root.push(written);
    Ok(())
}

/// Lists the extensions that the materials make use of.
pub(super) fn note_extensions(root: &mut Root) {
    let used = |of: &dyn Fn(&Extensions) -> bool| root.materials.iter().flat_map(|m| &m.extensions).any(of);
    let names = [
        ("KHR_materials_unlit", used(&|e| e.unlit.is_some())),
        ("KHR_materials_transmission", used(&|e| e.transmission.is_some())),
        ("KHR_materials_ior", used(&|e| e.ior.is_some())),
        ("KHR_materials_volume", used(&|e| e.volume.is_some())),
    ];
    root.extensions_used = names.into_iter().filter(|(_, used)| *used).map(|(name, _)| name.to_owned()).collect();
}

fn factors([r, g, b]: [f32; 3], metallic: f32, roughness: f32) -> PbrMetallicRoughness {
    PbrMetallicRoughness {
        base_color_factor: PbrBaseColorFactor([r, g, b, 1.0]),
        metallic_factor: StrengthFactor(metallic),
        roughness_factor: StrengthFactor(roughness),
        ..PbrMetallicRoughness::default()
    }
}

fn shown(root: &mut Root, bytes: &mut Bytes, picture: &ShownPicture, path: &Path) -> Result<Material, Error> {
    let pixels = Picture { width: picture.width, height: picture.height, pixels: &picture.radiance };
    let png = encode_png(path, &pixels, picture.opacity.as_deref(), &picture.display)?;
    let view = bytes.push_view(root, &png, None);
    let image = root.push(Image {
        buffer_view: Some(view),
        mime_type: Some(MimeType("image/png".to_owned())),
        name: None,
        uri: None,
        extensions: None,
        extras: None,
    });
    let sampler = root.push(Sampler {
        mag_filter: Some(Valid(MagFilter::Linear)),
        min_filter: Some(Valid(MinFilter::Linear)),
        wrap_s: Valid(WrappingMode::ClampToEdge),
        wrap_t: Valid(WrappingMode::ClampToEdge),
        ..Sampler::default()
    });
    let texture =
        root.push(Texture { name: None, sampler: Some(sampler), source: image, extensions: None, extras: None });
    let info = Info { index: texture, tex_coord: picture.uv_set, extensions: None, extras: None };
    let mut pbr = factors([1.0; 3], 0.0, 1.0);
    pbr.base_color_texture = Some(info);
    let alpha_mode = match &picture.opacity {
        None => AlphaMode::Opaque,
        Some(opacity) if opacity.iter().all(|share| [0.0, 1.0].contains(share)) => AlphaMode::Mask,
        Some(_) => AlphaMode::Blend,
    };
    Ok(Material {
        alpha_mode: Valid(alpha_mode),
        pbr_metallic_roughness: pbr,
        extensions: Some(Extensions { unlit: Some(Unlit {}), ..Extensions::default() }),
        ..Material::default()
    })
}

fn glass(ior: f32, tint: [f32; 3], roughness: f32, absorption: Option<[f32; 3]>) -> Material {
    let volume = absorption.map(|absorption| {
        // The distance over which the channel that is absorbed most falls to 1/e, so that no colour is 0.
        let greatest = absorption.iter().fold(0.0f32, |greatest, sigma| greatest.max(*sigma));
        let distance = if greatest > 0.0 { 1.0 / greatest } else { 1.0 };
        Volume {
            thickness_factor: ThicknessFactor(1.0),
            attenuation_distance: AttenuationDistance(distance),
            attenuation_color: AttenuationColor(absorption.map(|sigma| (-sigma * distance).exp())),
            ..Volume::default()
        }
    });
    let transmission = Transmission { transmission_factor: TransmissionFactor(1.0), ..Transmission::default() };
    let ior = Ior { ior: IndexOfRefraction(ior), ..Ior::default() };
    Material {
        double_sided: absorption.is_none(),
        pbr_metallic_roughness: factors(tint, 0.0, roughness),
        extensions: Some(Extensions {
            transmission: Some(transmission),
            ior: Some(ior),
            volume,
            ..Extensions::default()
        }),
        ..Material::default()
    }
}
