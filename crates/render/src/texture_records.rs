//! Pictures as the device knows them; docs/materials.md, "Textures".

use std::{collections::HashMap, sync::Arc};

use diacaustic_scene::{Material, Scene, Texture, TextureFilter, TextureImage, Wrap};
use diacaustic_shaders as shaders;
use diacaustic_shaders::{NONE, texture_flag as flags};
use diacaustic_surface::WorldTriangle;
use glam::Vec2;

use crate::{material_records::rests, tangent_records::Tangents};

/// What the kernels read of a scene's pictures. No part is empty, for a texture cannot be.
#[derive(Debug)]
pub(crate) struct TextureRecords {
    /// For each triangle; of a scene without pictures a single one.
    pub coordinates: Vec<shaders::TextureCoordinates>,
    /// For each material, with those of the lights' surfaces, and then of what materials are blended with.
    pub materials: Vec<shaders::MaterialTextures>,
    pub textures: Vec<shaders::SurfaceTexture>,
    /// Two texels in each entry; of a picture with an odd number of them the last stands alone.
    pub texels: Vec<[u32; 4]>,
}

impl TextureRecords {
    /// The records of a scene; `triangles` are those of the hierarchy.
    pub fn new(scene: &Scene, triangles: &[WorldTriangle]) -> Self {
        let mut pictures = Pictures::default();
        let mut materials: Vec<_> = scene.materials.iter().map(|material| pictures.of_material(material)).collect();
        materials.extend(scene.lights.iter().map(|_| WITHOUT_TEXTURES));
        for (whole, rest) in rests(scene) {
            materials[whole].rest = materials.len() as u32;
            materials.push(pictures.of_material(&rest));
        }
        let are_used = scene.materials.iter().any(|material| material.all_textures().next().is_some());
        let shown = if are_used { triangles } else { &[] };
        let tangents = Tangents::of(scene);
        Self {
            coordinates: or_blank(shown.iter().map(|triangle| coordinates(triangle, &tangents)).collect()),
            materials,
            textures: or_blank(pictures.textures),
            texels: or_blank(pictures.texels),
        }
    }
}

/// The pictures of a material without any.
const WITHOUT_TEXTURES: shaders::MaterialTextures = shaders::MaterialTextures {
    color: NONE,
    roughness: NONE,
    metallic: NONE,
    emission: NONE,
    normal: NONE,
    normal_strength: 1.0,
    opacity: NONE,
    opacity_factor: 1.0,
    opacity_cutoff: -1.0,
    rest: NONE,
    share: 1.0,
    share_picture: NONE,
};

fn or_blank<T: Default>(records: Vec<T>) -> Vec<T> {
    if records.is_empty() { vec![T::default()] } else { records }
}

fn coordinates(triangle: &WorldTriangle, tangents: &Tangents<'_>) -> shaders::TextureCoordinates {
    let [a, b, c] = triangle.uvs.unwrap_or([Vec2::ZERO; 3]);
    shaders::TextureCoordinates { uv_01: [a.x, a.y, b.x, b.y], uv_2: c.into(), tangents: tangents.record(triangle) }
}

/// Textures and texels met so far.
#[derive(Default)]
struct Pictures {
    textures: Vec<shaders::SurfaceTexture>,
    texels: Vec<[u32; 4]>,
    /// Where the texels of a picture begin, which several textures may show.
    first_texels: HashMap<*const TextureImage, u32>,
}

impl Pictures {
    fn of_material(&mut self, material: &Material) -> shaders::MaterialTextures {
        let textures = &material.textures;
        let share = material.blend.as_ref().and_then(|blend| blend.texture.as_ref());
        let mut index = |texture: &Option<Texture>| texture.as_ref().map_or(NONE, |texture| self.texture(texture));
        shaders::MaterialTextures {
            color: index(&textures.color),
            roughness: index(&textures.roughness),
            metallic: index(&textures.metallic),
            emission: index(&textures.emission),
            normal: textures.normal.as_ref().map_or(NONE, |map| self.texture(&map.texture)),
            normal_strength: textures.normal.as_ref().map_or(1.0, |map| map.strength),
            opacity: textures.opacity.as_ref().map_or(NONE, |texture| self.texture(texture)),
            opacity_factor: material.opacity,
            opacity_cutoff: material.opacity_cutoff.unwrap_or(-1.0),
            rest: NONE,
            share: material.blend.as_ref().map_or(1.0, |blend| blend.share),
            share_picture: share.map_or(NONE, |texture| self.texture(texture)),
        }
    }

    fn texture(&mut self, texture: &Texture) -> u32 {
        let first_texel = self.first_texel(&texture.image);
        let place = texture.picture_from_uv;
        self.textures.push(shaders::SurfaceTexture {
            first_texel,
            width: texture.image.width(),
            height: texture.image.height(),
            flags: texture_flags(texture),
            s_from_uv: [place.matrix2.x_axis.x, place.matrix2.y_axis.x, place.translation.x],
            t_from_uv: [place.matrix2.x_axis.y, place.matrix2.y_axis.y, place.translation.y],
            ..Default::default()
        });
        self.textures.len() as u32 - 1
    }

    /// Where the texels of a picture begin; adds them if it is new.
    fn first_texel(&mut self, image: &Arc<TextureImage>) -> u32 {
        let texels = &mut self.texels;
        *self.first_texels.entry(Arc::as_ptr(image)).or_insert_with(|| {
            let first = 2 * texels.len() as u32;
            texels.extend(image.texels().chunks(2).map(|pair| {
                let mut words = [0; 4];
                for (word, numbers) in words.iter_mut().zip(pair.iter().flat_map(|texel| texel.chunks(2))) {
                    *word = u32::from(numbers[0].to_bits()) | u32::from(numbers[1].to_bits()) << 16;
                }
                words
            }));
            first
        })
    }
}

fn texture_flags(texture: &Texture) -> u32 {
    let wrap = |wrap: Wrap| match wrap {
        Wrap::Repeat => flags::WRAP_REPEAT,
        Wrap::Mirror => flags::WRAP_MIRROR,
        Wrap::Clamp => flags::WRAP_CLAMP,
    };
    let nearest = if texture.filter == TextureFilter::Nearest { flags::NEAREST } else { 0 };
    wrap(texture.wrap[0]) | wrap(texture.wrap[1]) << 2 | nearest | (texture.channel as u32) << flags::CHANNEL_SHIFT
}
