//! A surface that is glass in part: how much of it, and how much of the rest is metal.

use std::sync::Arc;

use glam::Vec2;
use half::f16;

use super::pictures::{METALLIC, Pictures};
use crate::{Blend, Mesh, Texture, TextureFilter, TextureImage};

/// A share that is taken for 1, for pictures are rounded.
const WHOLE: f32 = 0.998;
/// How often each texel of a picture is looked at, on average.
const MOST_LOOKS: usize = 8;

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

/// Whether a blend's picture is 1 wherever a slot of a mesh shows it: pictures often serve several materials, of which each shows a part.
pub(in super::super) fn is_whole_on(blend: &Blend, mesh: &Mesh, slot: usize) -> bool {
    let Some(texture) = &blend.texture else { return blend.share >= 1.0 };
    let (width, height) = (texture.image.width() as usize, texture.image.height() as usize);
    let size = Vec2::new(width as f32, height as f32);
    let is_of_slot = |triangle: usize| mesh.triangle_slots.get(triangle).copied().unwrap_or(0) as usize == slot;
    // Boxes around triangles overlap; a file whose boxes cover its picture many times is not looked at further.
    let mut texels_left = MOST_LOOKS * width * height;
    mesh.triangles.iter().enumerate().filter(|(triangle, _)| is_of_slot(*triangle)).all(|(_, corners)| {
        let places = corners.map(|vertex| {
            let uv = mesh.uvs.get(vertex as usize).copied().unwrap_or_default();
            let place = texture.picture_from_uv.transform_point2(uv);
            Vec2::new(place.x, 1.0 - place.y) * size
        });
        let low = places[0].min(places[1]).min(places[2]) - 1.5;
        let high = places[0].max(places[1]).max(places[2]) + 1.5;
        if !(low.cmpge(Vec2::splat(-1.5)).all() && high.cmple(size + 1.5).all()) {
            return false;
        }
        let range = |low: f32, high: f32, count: usize| low.max(0.0) as usize..(high.ceil() as usize).min(count);
        let (rows, columns) = (range(low.y, high.y, height), range(low.x, high.x, width));
        let Some(left) = texels_left.checked_sub(rows.len() * columns.len()) else { return false };
        texels_left = left;
        rows.into_iter().all(|row| {
            let texels = &texture.image.texels()[row * width..][..width];
            texels[columns.clone()].iter().all(|texel| blend.share * texel[texture.channel].to_f32() >= WHOLE)
        })
    })
}
