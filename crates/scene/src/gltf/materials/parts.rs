//! A surface that is glass in part: how much of it, and how much of the rest is metal.

use std::sync::Arc;

use glam::Vec2;
use half::f16;

use super::pictures::{METALLIC, Pictures};
use crate::{Texture, TextureFilter, TextureImage};

/// Shares of a surface: glTF mixes metal with what is none, and of that glass with what is opaque.
#[derive(Clone)]
pub(super) struct Parts {
    /// Share of glass, and its picture.
    pub(super) glass: (f32, Option<Texture>),
    /// Share of metal in the rest, and its picture.
    pub(super) metal: (f32, Option<Texture>),
    /// Whether the picture of metal lies in another way than that of transmission, and its mean stands in.
    pub(super) is_mean: bool,
}

impl Parts {
    /// Those of a material of this transmission and metal before their pictures.
    pub(super) fn of(transmission: f32, metallic: f32, pictures: &Pictures) -> Self {
        let clear = pictures.transmission.clone();
        let metal = pictures.channel(METALLIC).filter(|_| metallic > 0.0);
        let uniform = |metallic: f32, is_mean| {
            let share = transmission * (1.0 - metallic);
            Self { glass: (share, clear.clone()), metal: (metal_of_rest(metallic, share), None), is_mean }
        };
        let lie_alike = |other: &Texture, metal: &Texture| {
            other.picture_from_uv == metal.picture_from_uv && other.wrap == metal.wrap && other.filter == metal.filter
        };
        let larger = match (&clear, &metal) {
            // Without metal, or without pictures, the shares are those of the numbers.
            (None, None) => return uniform(metallic, false),
            _ if metallic == 0.0 => return uniform(0.0, false),
            (None, Some(metal)) => metal,
            (Some(clear), None) => clear,
            (Some(clear), Some(metal)) if lie_alike(clear, metal) => {
                if clear.image.width() > metal.image.width() {
                    clear
                } else {
                    metal
                }
            }
            (Some(_), Some(metal)) => return uniform(metallic * metal.image.mean()[METALLIC], true),
        };
        let number_at = |texture: &Option<Texture>, uv| texture.as_ref().map_or(1.0, |texture| texture.number_at(uv));
        let at = |uv: Vec2| {
            let m = (metallic * number_at(&metal, uv)).clamp(0.0, 1.0);
            let glass = (transmission * number_at(&clear, uv)).clamp(0.0, 1.0) * (1.0 - m);
            (glass, metal_of_rest(m, glass))
        };
        Self {
            glass: (1.0, Some(picture_of(larger, |uv| at(uv).0))),
            metal: (1.0, Some(picture_of(larger, |uv| at(uv).1))),
            is_mean: false,
        }
    }

    /// The greatest share of glass.
    pub(super) fn most_glass(&self) -> f32 {
        self.glass.0 * self.glass.1.as_ref().map_or(1.0, |texture| texture.image.most()[texture.channel])
    }

    /// Whether all of the surface is glass.
    pub(super) fn is_whole(&self) -> bool {
        self.glass.0 * self.glass.1.as_ref().map_or(1.0, |texture| texture.image.least()[texture.channel]) >= 1.0
    }
}

/// The share of metal in what is not glass, of the shares of both.
fn metal_of_rest(metal: f32, glass: f32) -> f32 {
    if glass < 1.0 { (metal / (1.0 - glass)).min(1.0) } else { 0.0 }
}

/// A picture as large as another, which lies as that does, of a number at texture coordinates.
fn picture_of(like: &Texture, number_at: impl Fn(Vec2) -> f32) -> Texture {
    let (width, height) = (like.image.width(), like.image.height());
    let uv_from_picture = like.picture_from_uv.inverse();
    let size = Vec2::new(width as f32, height as f32);
    let texel = |row: u32, column: u32| {
        let place = (Vec2::new(column as f32, row as f32) + 0.5) / size;
        let number = number_at(uv_from_picture.transform_point2(Vec2::new(place.x, 1.0 - place.y)));
        [f16::from_f32(if number.is_finite() { number } else { 0.0 }); 4]
    };
    let texels = (0..height).flat_map(|row| (0..width).map(move |column| (row, column)));
    let texels = texels.map(|(row, column)| texel(row, column)).collect();
    let image =
        TextureImage::new(width, height, texels).unwrap_or_else(|_| unreachable!("as large as a picture, and finite"));
    Texture { image: Arc::new(image), channel: 0, wrap: like.wrap, filter: TextureFilter::Linear, ..like.clone() }
}
