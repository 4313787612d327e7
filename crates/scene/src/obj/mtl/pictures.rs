//! The pictures of MTL's materials.

use std::{
    collections::{HashMap, HashSet},
    sync::Arc,
};

use glam::{Affine2, Vec3};

use super::{
    entry::{Entry, Maps},
    maps::Map,
};
use crate::{
    ColorSpace, Material, MaterialKind, NormalMap, Picture, Texture, Textures, Warning, Wrap, folder::Folder,
    texture_image::decode_texture,
};

/// The most texels of a mesh's pictures, in all, and bytes of a picture's file.
const MOST_TEXELS: u64 = 1 << 28;
const MOST_BYTES: u64 = 1 << 30;

/// The channel of coverage.
const ALPHA: usize = 3;

/// Reads pictures; holds those that materials share.
pub(super) struct PictureReader {
    pictures: HashMap<(String, ColorSpace), Result<Picture, String>>,
    texels_left: u64,
    /// Materials and pictures of which it is noted that they cannot be read.
    told: HashSet<(String, String)>,
}

impl Default for PictureReader {
    fn default() -> Self {
        Self { pictures: HashMap::new(), texels_left: MOST_TEXELS, told: HashSet::new() }
    }
}

impl PictureReader {
    /// A PNG or JPEG picture in a folder. One named by a path of another machine may lie in the folder itself.
    fn picture(&mut self, file: &str, color_space: ColorSpace, folder: &Folder) -> Result<Picture, String> {
        let key = (file.to_owned(), color_space);
        if let Some(read) = self.pictures.get(&key) {
            return read.clone();
        }
        let bytes = folder.read(file, MOST_BYTES).or_else(|problem| {
            let stem = file.rsplit('/').next().unwrap_or_default();
            let beside = if stem == file { None } else { folder.read(stem, MOST_BYTES).ok() };
            beside.ok_or(problem)
        });
        let read = bytes.and_then(|bytes| {
            let decoded = decode_texture(&bytes, color_space, self.texels_left);
            decoded.map_err(|problem| format!("names the picture {file:?}, which {problem}"))
        });
        if let Ok(picture) = &read {
            self.texels_left -= u64::from(picture.image.width()) * u64::from(picture.image.height());
        }
        self.pictures.insert(key, read.clone());
        read
    }
}

impl Entry {
    /// The material, with those of its pictures that can be read; the others are noted.
    pub(super) fn material(
        &self,
        reader: &mut PictureReader,
        folder: &Folder,
        has_uvs: bool,
        warnings: &mut Vec<Warning>,
    ) -> Material {
        let kind = self.kind();
        let can_emit = !matches!(kind, MaterialKind::Dielectric { .. });
        let default = if self.maps.emission.is_some() { Vec3::ONE } else { Vec3::ZERO };
        let emission = self.emission.unwrap_or(default);
        let mut material = Material::new(self.name.clone(), kind);
        material.emission = if can_emit { emission } else { Vec3::ZERO };
        self.note_ignored(has_uvs, warnings);
        if has_uvs {
            let mut shown = Shown { entry: self, reader, folder, warnings };
            shown.add_to(&mut material);
        }
        material
    }

    fn note_ignored(&self, has_uvs: bool, warnings: &mut Vec<Warning>) {
        let Maps { diffuse, emission, dissolve, roughness, metallic, normal, ignored } = &self.maps;
        // A picture of the ambient colour is that of the diffuse one as a rule, which stands for both.
        let is_lost = |keyword: &&String| !(diffuse.is_some() && keyword.eq_ignore_ascii_case("map_Ka"));
        let lost: Vec<_> = ignored.iter().filter(is_lost).map(String::as_str).collect();
        if !lost.is_empty() {
            warnings.push(Warning::IgnoredTextures { material: self.name.clone(), maps: lost.join(", ") });
        }
        let has_maps = [diffuse, emission, dissolve, roughness, metallic, normal].into_iter().any(Option::is_some);
        if has_maps && !has_uvs {
            let problem = "has pictures, but the mesh has no texture coordinates (vt) for them".to_owned();
            warnings.push(Warning::UnreadPicture { material: self.name.clone(), problem });
        }
    }
}

/// The pictures of an entry on their way to its material.
struct Shown<'a> {
    entry: &'a Entry,
    reader: &'a mut PictureReader,
    folder: &'a Folder,
    warnings: &'a mut Vec<Warning>,
}

impl Shown<'_> {
    fn add_to(&mut self, material: &mut Material) {
        let maps = &self.entry.maps;
        let has_roughness = matches!(
            material.kind,
            MaterialKind::MetallicRoughness { .. } | MaterialKind::Coated { .. } | MaterialKind::Dielectric { .. }
        );
        let is_metal = matches!(material.kind, MaterialKind::MetallicRoughness { .. });
        let is_mirror = matches!(material.kind, MaterialKind::Mirror { .. });
        let is_glass = matches!(material.kind, MaterialKind::Dielectric { .. });
        let diffuse = maps.diffuse.as_ref().filter(|_| !is_mirror);
        let number = |map: &Option<Map>, has_use: bool| map.clone().filter(|_| has_use);
        material.textures = Textures {
            color: diffuse.and_then(|map| self.texture(map, ColorSpace::Srgb)),
            emission: number(&maps.emission, !is_glass).and_then(|map| self.texture(&map, ColorSpace::Srgb)),
            roughness: number(&maps.roughness, has_roughness).and_then(|map| self.texture(&map, ColorSpace::Linear)),
            metallic: number(&maps.metallic, is_metal).and_then(|map| self.texture(&map, ColorSpace::Linear)),
            opacity: maps.dissolve.as_ref().and_then(|map| self.opacity(map)),
            normal: maps.normal.as_ref().and_then(|map| {
                Some(NormalMap { texture: self.texture(map, ColorSpace::Linear)?, strength: map.strength })
            }),
        };
    }

    /// Coverage where the picture has it, else its gray.
    fn opacity(&mut self, map: &Map) -> Option<Texture> {
        let mut texture = self.texture(map, ColorSpace::Linear)?;
        let has_alpha = self.picture(map, ColorSpace::Linear).is_some_and(|picture| picture.has_alpha);
        if map.channel.is_none() && has_alpha {
            texture.channel = ALPHA;
        }
        Some(texture)
    }

    fn texture(&mut self, map: &Map, color_space: ColorSpace) -> Option<Texture> {
        let picture = self.picture(map, color_space)?;
        Some(Texture {
            channel: map.channel.unwrap_or(0),
            wrap: [if map.is_clamped { Wrap::Clamp } else { Wrap::Repeat }; 2],
            picture_from_uv: Affine2::from_translation(map.offset) * Affine2::from_scale(map.scale),
            ..Texture::new(Arc::clone(&picture.image))
        })
    }

    fn picture(&mut self, map: &Map, color_space: ColorSpace) -> Option<Picture> {
        match self.reader.picture(&map.file, color_space, self.folder) {
            Ok(picture) => Some(picture),
            Err(problem) => {
                if self.reader.told.insert((self.entry.name.clone(), map.file.clone())) {
                    self.warnings.push(Warning::UnreadPicture { material: self.entry.name.clone(), problem });
                }
                None
            }
        }
    }
}
