//! The pictures of materials.

use gltf_json::{extensions::texture::TextureTransform, texture::Info};

use super::{
    super::{
        fault::{Fault, Result},
        textures::Use,
    },
    layers::CLEARCOAT,
};
use crate::{NormalMap, Texture, Textures};

/// The channels in which pictures hold the roughness, the share of metal and coverage.
pub(super) const ROUGHNESS: usize = 1;
pub(super) const METALLIC: usize = 2;
pub(super) const ALPHA: usize = 3;

/// The pictures that a material names.
pub(super) struct Uses {
    pub(super) color: Option<Use>,
    pub(super) metal: Option<Use>,
    pub(super) normal: Option<Use>,
    pub(super) normal_scale: f32,
    pub(super) emission: Option<Use>,
    pub(super) transmission: Option<Use>,
    /// Factor on the strength of a clear coat.
    pub(super) coat: Option<Use>,
    pub(super) coat_roughness: Option<Use>,
}

impl Uses {
    pub(super) fn of(source: &gltf_json::Material, place: &str) -> Result<Self> {
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
        let others = source.extensions.as_ref().map(|extensions| &extensions.others);
        let coat = others.and_then(|others| others.get(CLEARCOAT));
        let coat_picture = |key: &str| {
            let info =
                coat.and_then(|coat| coat.get(key)).map(|value| gltf_json::deserialize::from_value(value.clone()));
            let info: Option<Info> = info
                .transpose()
                .map_err(|error| Fault::new(place, format!("has a {CLEARCOAT} with a damaged {key}: {error}")))?;
            Ok(info.as_ref().map(Use::of))
        };
        let transmission = source.extensions.as_ref().and_then(|extensions| extensions.transmission.as_ref());
        Ok(Self {
            color: info(&model.base_color_texture),
            metal: info(&model.metallic_roughness_texture),
            normal: normal.transpose()?,
            normal_scale,
            emission: info(&source.emissive_texture),
            coat: coat_picture("clearcoatTexture")?,
            coat_roughness: coat_picture("clearcoatRoughnessTexture")?,
            transmission: transmission.and_then(|transmission| info(&transmission.transmission_texture)),
        })
    }

    pub(super) fn all(&self) -> impl Iterator<Item = &Use> {
        let Self { color, metal, normal, normal_scale: _, emission, transmission, coat, coat_roughness } = self;
        [color, metal, normal, emission, transmission, coat, coat_roughness].into_iter().flatten()
    }

    pub(super) fn by_key(&mut self) -> [(&'static str, &mut Option<Use>); 7] {
        [
            ("baseColorTexture", &mut self.color),
            ("metallicRoughnessTexture", &mut self.metal),
            ("normalTexture", &mut self.normal),
            ("emissiveTexture", &mut self.emission),
            ("transmissionTexture", &mut self.transmission),
            ("clearcoatTexture", &mut self.coat),
            ("clearcoatRoughnessTexture", &mut self.coat_roughness),
        ]
    }
}

/// The pictures of a material.
#[derive(Clone)]
pub(super) struct Pictures {
    pub(super) color: Option<Texture>,
    /// The coverage in `color`, if there is any.
    pub(super) alpha: Option<Texture>,
    pub(super) metal: Option<Texture>,
    pub(super) normal: Option<NormalMap>,
    pub(super) emission: Option<Texture>,
    pub(super) transmission: Option<Texture>,
    pub(super) coat: Option<Texture>,
    pub(super) coat_roughness: Option<Texture>,
}

impl Pictures {
    pub(super) fn channel(&self, channel: usize) -> Option<Texture> {
        self.metal.as_ref().map(|texture| Texture { channel, ..texture.clone() })
    }

    /// Those that glass and opaque materials have.
    pub(super) fn textures(&self) -> Textures {
        Textures {
            color: self.color.clone(),
            roughness: self.channel(ROUGHNESS),
            normal: self.normal.clone(),
            ..Textures::default()
        }
    }
}
