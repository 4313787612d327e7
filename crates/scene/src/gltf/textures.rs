//! Pictures, and how they lie on surfaces.

use std::{collections::HashMap, sync::Arc};

use glam::{Affine2, DAffine2, DVec2};
use gltf_json::{
    Root,
    extensions::texture::TextureTransform,
    texture::{Info, MagFilter, Sampler, WrappingMode},
    validation::Checked,
};

use super::{
    buffers::{Buffers, read_uri},
    fault::{Fault, Result, entry, place},
};
use crate::{ColorSpace, Picture, Texture, TextureFilter, Wrap, folder::Folder, texture_image::decode_texture};

/// The most texels of a file's pictures, in all.
const MOST_TEXELS: u64 = 1 << 28;
/// The most bytes of a picture's file.
const MOST_BYTES: u64 = 1 << 30;

/// A material's use of a texture.
#[derive(Clone)]
pub(super) struct Use {
    texture: usize,
    /// The set of texture coordinates.
    pub(super) uv_set: u32,
    /// Picture from texture coordinates, both with (0, 0) in the upper left corner.
    transform: DAffine2,
}

impl Use {
    pub(super) fn of(info: &Info) -> Self {
        let transform = info.extensions.as_ref().and_then(|extensions| extensions.texture_transform.clone());
        Self::new(info.index.value(), info.tex_coord, transform)
    }

    pub(super) fn new(texture: usize, uv_set: u32, transform: Option<TextureTransform>) -> Self {
        let transform = transform.unwrap_or_default();
        let vector = |numbers: [f32; 2]| DVec2::from(numbers.map(f64::from));
        // Counter-clockwise as one sees it, where v points down.
        let angle = -f64::from(transform.rotation.0);
        let (scale, offset) = (vector(transform.scale.0), vector(transform.offset.0));
        Self {
            texture,
            uv_set: transform.tex_coord.unwrap_or(uv_set),
            transform: DAffine2::from_scale_angle_translation(DVec2::ONE, angle, offset) * DAffine2::from_scale(scale),
        }
    }

    /// Picture from texture coordinates, both with (0, 0) in the lower left corner.
    fn picture_from_uv(&self) -> Affine2 {
        let flip = DAffine2::from_cols_array(&[1.0, 0.0, 0.0, -1.0, 0.0, 1.0]);
        (flip * self.transform * flip).as_affine2()
    }
}

/// Reads textures; holds the pictures that they share.
pub(super) struct TextureReader<'a, 'b> {
    root: &'a Root,
    buffers: &'a Buffers<'b>,
    folder: &'a Folder,
    pictures: HashMap<(usize, ColorSpace), Picture>,
    texels_left: u64,
}

impl<'a, 'b> TextureReader<'a, 'b> {
    pub(super) fn new(root: &'a Root, buffers: &'a Buffers<'b>, folder: &'a Folder) -> Self {
        Self { root, buffers, folder, pictures: HashMap::new(), texels_left: MOST_TEXELS }
    }

    /// The texture of a use, of the picture's first channel; `user` names what asks for it.
    pub(super) fn read(&mut self, used: &Use, color_space: ColorSpace, user: &str) -> Result<(Picture, Texture)> {
        let source = entry(&self.root.textures, "textures", used.texture, user)?;
        let place = place("textures", used.texture, source.name.as_deref());
        if source.source.value() == u32::MAX as usize {
            let names = source.extensions.iter().flat_map(|extensions| extensions.others.keys());
            let names: Vec<_> = names.map(String::as_str).collect();
            return Err(Fault::new(
                place,
                format!("has no source in PNG or JPEG (its extensions: {}); give it one", names.join(", ")),
            ));
        }
        let picture = self.picture(source.source.value(), color_space, &place)?;
        let sampler = source.sampler.map(|sampler| entry(&self.root.samplers, "samplers", sampler.value(), &place));
        let sampler = sampler.transpose()?;
        let texture = Texture {
            wrap: sampler.map_or(Ok([Wrap::Repeat; 2]), |sampler| read_wrap(sampler, &place))?,
            filter: sampler.map_or(TextureFilter::Linear, read_filter),
            picture_from_uv: used.picture_from_uv(),
            ..Texture::new(Arc::clone(&picture.image))
        };
        if !texture.picture_from_uv.is_finite() {
            return Err(Fault::new(user, "has a KHR_texture_transform that is not finite"));
        }
        Ok((picture, texture))
    }

    fn picture(&mut self, index: usize, color_space: ColorSpace, user: &str) -> Result<Picture> {
        if let Some(picture) = self.pictures.get(&(index, color_space)) {
            return Ok(picture.clone());
        }
        let image = entry(&self.root.images, "images", index, user)?;
        let place = place("images", index, image.name.as_deref());
        let read;
        let bytes = match (&image.uri, image.buffer_view) {
            (Some(uri), _) => {
                read = read_uri(uri, self.folder, MOST_BYTES).map_err(|problem| Fault::new(&place, problem))?;
                &read
            }
            (None, Some(view)) => self.buffers.view(view.value(), &place)?.bytes,
            (None, None) => return Err(Fault::new(place, "has neither uri nor bufferView; it must have one")),
        };
        let picture = decode_texture(bytes, color_space, self.texels_left);
        let picture = picture.map_err(|problem| Fault::new(place, format!("the picture {problem}")))?;
        self.texels_left -= u64::from(picture.image.width()) * u64::from(picture.image.height());
        self.pictures.insert((index, color_space), picture.clone());
        Ok(picture)
    }
}

fn read_wrap(sampler: &Sampler, user: &str) -> Result<[Wrap; 2]> {
    let wrap = |mode| match mode {
        Checked::Valid(WrappingMode::Repeat) => Ok(Wrap::Repeat),
        Checked::Valid(WrappingMode::MirroredRepeat) => Ok(Wrap::Mirror),
        Checked::Valid(WrappingMode::ClampToEdge) => Ok(Wrap::Clamp),
        Checked::Invalid => Err(Fault::new(user, "has a sampler of an unknown wrap; it must be 33071, 33648 or 10497")),
    };
    // v is turned over twice, so that what lies beyond the upper edge still does.
    Ok([wrap(sampler.wrap_s)?, wrap(sampler.wrap_t)?])
}

/// That of magnification: pictures are not made smaller.
fn read_filter(sampler: &Sampler) -> TextureFilter {
    match sampler.mag_filter {
        Some(Checked::Valid(MagFilter::Nearest)) => TextureFilter::Nearest,
        _ => TextureFilter::Linear,
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec2;
    use gltf_json::extensions::texture::{TextureTransformOffset, TextureTransformRotation, TextureTransformScale};

    use super::*;

    #[test]
    fn transforms_keep_their_sense_when_v_points_up() {
        let transform = TextureTransform {
            offset: TextureTransformOffset([0.25, 0.5]),
            rotation: TextureTransformRotation(std::f32::consts::FRAC_PI_2),
            scale: TextureTransformScale([2.0, 3.0]),
            ..TextureTransform::default()
        };
        let map = Use::new(0, 0, Some(transform)).picture_from_uv();
        // u = 0.1, v = 0.2 from above: scaled to (0.2, 0.6), turned to (0.6, −0.2), moved to (0.85, 0.3).
        let place = map.transform_point2(Vec2::new(0.1, 1.0 - 0.2));
        assert!(place.abs_diff_eq(Vec2::new(0.85, 1.0 - 0.3), 1e-6), "{place}");
        assert_eq!(Use::new(0, 1, None).picture_from_uv(), Affine2::IDENTITY);
    }
}
