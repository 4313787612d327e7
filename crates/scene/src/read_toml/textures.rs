//! Reads the pictures that a scene file's materials show.

use std::{
    collections::HashMap,
    fs,
    path::{Path, PathBuf},
    sync::Arc,
};

use glam::{DAffine2, Vec2, Vec3};

use super::table::{Entry, Table};
use crate::{
    ColorSpace, Error, NormalMap, Picture, Texture, TextureFilter, Wrap, load_texture,
    texture_image::holds_linear_numbers,
};

/// The keys of every picture's table.
const PICTURE_KEYS: [&str; 6] = ["image", "wrap", "filter", "scale", "rotate", "offset"];

const IMAGE: &str = "the path of a picture (.png, .jpg, .hdr or .exr), relative to the scene file";
const PICTURE: &str = "a picture's table: { image = \"FILE\", ... }";

const WRAPS: [(&str, Wrap); 3] = [("repeat", Wrap::Repeat), ("mirror", Wrap::Mirror), ("clamp", Wrap::Clamp)];
const FILTERS: [(&str, TextureFilter); 2] = [("linear", TextureFilter::Linear), ("nearest", TextureFilter::Nearest)];
const COLOR_SPACES: [(&str, ColorSpace); 2] = [("srgb", ColorSpace::Srgb), ("linear", ColorSpace::Linear)];
const CHANNELS: [(&str, usize); 4] = [("r", 0), ("g", 1), ("b", 2), ("a", ALPHA)];
const ALPHA: usize = 3;

/// Which channel stands for a number where the file does not say.
#[derive(Clone, Copy)]
pub(super) enum DefaultChannel {
    /// This one of red, green and blue, or gray where there are no colours.
    Color(usize),
    /// Coverage, or else red.
    Alpha,
}

impl DefaultChannel {
    fn of(self, picture: &Picture) -> usize {
        match self {
            Self::Color(channel) if picture.has_color => channel,
            Self::Alpha if picture.has_alpha => ALPHA,
            _ => 0,
        }
    }
}

/// A number, its picture, and from where on it counts as 1.
pub(super) struct Opacity {
    pub(super) factor: f32,
    pub(super) texture: Option<Texture>,
    pub(super) cutoff: Option<f32>,
}

/// Reads textures; holds the pictures that they share.
pub(super) struct TextureReader<'a> {
    base_dir: &'a Path,
    pictures: HashMap<(PathBuf, ColorSpace), Picture>,
}

impl<'a> TextureReader<'a> {
    pub(super) fn new(base_dir: &'a Path) -> Self {
        Self { base_dir, pictures: HashMap::new() }
    }

    /// A colour, or a picture of one and its factor.
    pub(super) fn color(&mut self, entry: &Entry<'_>) -> Result<(Vec3, Option<Texture>), Error> {
        if !entry.is_table() {
            return Ok((entry.color_without_picture()?, None));
        }
        let table = picture_table(entry, &["factor", "color_space"])?;
        let factor = table.get("factor").map_or(Ok(Vec3::ONE), |factor| factor.color())?;
        let (_, texture) = self.texture(&table, ColorSpace::Srgb)?;
        Ok((factor, Some(texture)))
    }

    /// A number, or a picture of one and its factor.
    pub(super) fn number(
        &mut self,
        entry: &Entry<'_>,
        default: DefaultChannel,
    ) -> Result<(f32, Option<Texture>), Error> {
        if !entry.is_table() {
            return Ok((entry.number_without_picture()?, None));
        }
        let table = picture_table(entry, &["factor", "color_space", "channel"])?;
        let (factor, texture) = self.number_texture(&table, default)?;
        Ok((factor, Some(texture)))
    }

    /// An opacity: a number, or a picture of one with its factor and cutoff.
    pub(super) fn opacity(&mut self, entry: &Entry<'_>) -> Result<Opacity, Error> {
        if !entry.is_table() {
            return Ok(Opacity { factor: entry.number_without_picture()?, texture: None, cutoff: None });
        }
        let table = picture_table(entry, &["factor", "color_space", "channel", "cutoff"])?;
        let cutoff = table.get("cutoff").map(|cutoff| cutoff.number()).transpose()?;
        let (factor, texture) = self.number_texture(&table, DefaultChannel::Alpha)?;
        Ok(Opacity { factor, texture: Some(texture), cutoff })
    }

    /// A normal map.
    pub(super) fn normal(&mut self, entry: &Entry<'_>) -> Result<NormalMap, Error> {
        let table = picture_table(entry, &["strength"])?;
        let strength = table.get("strength").map_or(Ok(1.0), |strength| strength.number())?;
        let (_, texture) = self.texture(&table, ColorSpace::Linear)?;
        Ok(NormalMap { texture, strength })
    }

    fn number_texture(&mut self, table: &Table<'_>, default: DefaultChannel) -> Result<(f32, Texture), Error> {
        let factor = table.get("factor").map_or(Ok(1.0), |factor| factor.number())?;
        let (picture, texture) = self.texture(table, ColorSpace::Linear)?;
        let mut channel = default.of(&picture);
        if let Some(entry) = table.get("channel") {
            channel = entry.choice("channel", &CHANNELS)?;
            if channel == ALPHA && !picture.has_alpha {
                return Err(entry.error("is \"a\", which the picture does not have; take \"r\", \"g\" or \"b\""));
            }
        }
        Ok((factor, Texture { channel, ..texture }))
    }

    /// The picture that a table names, and as what it lies on a surface. `usual` is the colour space of whole numbers in a table that
    /// states none.
    fn texture(&mut self, table: &Table<'_>, usual: ColorSpace) -> Result<(Picture, Texture), Error> {
        let picture = self.picture(table, usual)?;
        let texture = Texture {
            wrap: read_wrap(table)?,
            filter: table
                .get("filter")
                .map_or(Ok(TextureFilter::default()), |entry| entry.choice("filter", &FILTERS))?,
            picture_from_uv: read_picture_from_uv(table)?,
            ..Texture::new(Arc::clone(&picture.image))
        };
        Ok((picture, texture))
    }

    fn picture(&mut self, table: &Table<'_>, usual: ColorSpace) -> Result<Picture, Error> {
        let entry = table.require("image", IMAGE)?;
        let path = self.base_dir.join(entry.string(IMAGE)?);
        let color_space = match table.get("color_space") {
            Some(chosen) => chosen.choice("colour space", &COLOR_SPACES)?,
            None if holds_linear_numbers(&path) => ColorSpace::Linear,
            None => usual,
        };
        // Two ways to write a file's path name one picture.
        let key = (fs::canonicalize(&path).unwrap_or_else(|_| path.clone()), color_space);
        if let Some(picture) = self.pictures.get(&key) {
            return Ok(picture.clone());
        }
        let picture = load_texture(&path, color_space).map_err(|cause| Error::File {
            at: entry.location(),
            place: entry.place(),
            cause: Box::new(cause),
        })?;
        self.pictures.insert(key, picture.clone());
        Ok(picture)
    }
}

/// The table of a picture, with these keys besides those of every picture.
fn picture_table<'d>(entry: &Entry<'d>, others: &[&str]) -> Result<Table<'d>, Error> {
    let table = entry.table(entry.place(), PICTURE)?;
    table.allow_only(&[&PICTURE_KEYS, others].concat())?;
    Ok(table)
}

/// How the picture goes on along u and v: one word for both, or one for each.
fn read_wrap(table: &Table<'_>) -> Result<[Wrap; 2], Error> {
    let Some(entry) = table.get("wrap") else { return Ok([Wrap::default(); 2]) };
    if !entry.is_array() {
        return Ok([entry.choice("wrap", &WRAPS)?; 2]);
    }
    match entry.elements("an array of two wraps, [u, v]")?.as_slice() {
        [along_u, along_v] => Ok([along_u.choice("wrap", &WRAPS)?, along_v.choice("wrap", &WRAPS)?]),
        others => Err(entry.error(format!("has {} elements; it must have 2, [u, v], or be one name", others.len()))),
    }
}

/// From texture coordinates to the picture: scaled first, then turned counter-clockwise, then moved.
fn read_picture_from_uv(table: &Table<'_>) -> Result<glam::Affine2, Error> {
    let mut scale = Vec2::ONE;
    if let Some(entry) = table.get("scale") {
        scale = entry.one_or_pair()?;
        if scale.cmpeq(Vec2::ZERO).any() {
            return Err(entry.error("is zero along an axis; a scale must not be 0"));
        }
    }
    let degrees = table.get("rotate").map_or(Ok(0.0), |entry| entry.number())?;
    let offset = table.get("offset").map_or(Ok(Vec2::ZERO), |entry| entry.pair())?;
    let angle = f64::from(degrees).to_radians();
    Ok(DAffine2::from_scale_angle_translation(scale.as_dvec2(), angle, offset.as_dvec2()).as_affine2())
}
