//! Pictures on surfaces.

use std::sync::Arc;

use glam::{Affine2, Vec2, Vec4};
use half::f16;

/// A picture's texels, shared by the textures that show it.
#[derive(Clone, PartialEq)]
pub struct TextureImage {
    width: u32,
    height: u32,
    texels: Vec<[f16; 4]>,
    least: Vec4,
    most: Vec4,
    mean: Vec4,
}

impl TextureImage {
    /// The most texels along a side.
    pub const MAX_SIZE: u32 = 16384;

    /// A picture of `width` × `height` texels, row by row from the top: red, green, blue (linear Rec. 709) and coverage (1 where
    /// there is none), or whatever numbers the four channels stand for.
    ///
    /// # Errors
    /// What is wrong, if a side is 0 or longer than [`Self::MAX_SIZE`], the number of texels is another or a number is not finite.
    pub fn new(width: u32, height: u32, texels: Vec<[f16; 4]>) -> Result<Self, String> {
        check_size(width, height)?;
        let (count, expected) = (texels.len(), width as usize * height as usize);
        if count != expected {
            return Err(format!("has {count} texels; {width} × {height} must have {expected}"));
        }
        if let Some(index) = texels.iter().position(|texel| texel.iter().any(|number| !number.is_finite())) {
            let (column, row) = (index % width as usize, index / width as usize);
            return Err(format!(
                "holds {:?} at column {column}, row {row} (from 0); each number must be finite and at most {}",
                texels[index],
                f16::MAX
            ));
        }
        let start = (Vec4::INFINITY, Vec4::NEG_INFINITY, [0.0f64; 4]);
        let (least, most, sum) = texels.iter().fold(start, |(least, most, sum), texel| {
            let value = to_vec4(texel);
            (least.min(value), most.max(value), std::array::from_fn(|k| sum[k] + f64::from(value[k])))
        });
        let mean = Vec4::from(sum.map(|channel| (channel / count as f64) as f32));
        Ok(Self { width, height, texels, least, most, mean })
    }

    /// Texels along the upper side.
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Texels along the left side.
    pub fn height(&self) -> u32 {
        self.height
    }

    /// The texels, row by row from the top.
    pub fn texels(&self) -> &[[f16; 4]] {
        &self.texels
    }

    /// The least number of each channel.
    pub fn least(&self) -> Vec4 {
        self.least
    }

    /// The greatest number of each channel.
    pub fn most(&self) -> Vec4 {
        self.most
    }

    /// The mean of each channel.
    pub fn mean(&self) -> Vec4 {
        self.mean
    }
}

impl std::fmt::Debug for TextureImage {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "TextureImage({} × {})", self.width, self.height)
    }
}

/// What is wrong with the size of a picture.
pub(crate) fn check_size(width: u32, height: u32) -> Result<(), String> {
    let most = TextureImage::MAX_SIZE;
    if (1..=most).contains(&width) && (1..=most).contains(&height) {
        return Ok(());
    }
    Err(format!("has {width} × {height} texels; it must have from 1 × 1 to {most} × {most}"))
}

fn to_vec4(texel: &[f16; 4]) -> Vec4 {
    Vec4::from(texel.map(f16::to_f32))
}

/// A picture as it lies on a surface; `docs/materials.md`, "Textures".
#[derive(Clone, Debug, PartialEq)]
pub struct Texture {
    /// The picture.
    pub image: Arc<TextureImage>,
    /// Which of its channels (0 to 3) is read where a texture stands for one number; 0 where it stands for a colour.
    pub channel: usize,
    /// How it goes on beyond its left and right, and its lower and upper edge.
    pub wrap: [Wrap; 2],
    /// What lies between texels.
    pub filter: TextureFilter,
    /// From a mesh's texture coordinates to the picture, whose lower left corner is (0, 0) and whose upper right one (1, 1).
    pub picture_from_uv: Affine2,
}

impl Texture {
    /// The whole picture over texture coordinates from 0 to 1, repeated, bilinear, of the first channel.
    pub fn new(image: Arc<TextureImage>) -> Self {
        Self {
            image,
            channel: 0,
            wrap: [Wrap::default(); 2],
            filter: TextureFilter::default(),
            picture_from_uv: Affine2::IDENTITY,
        }
    }

    /// Its four channels at texture coordinates `uv`.
    pub fn at(&self, uv: Vec2) -> Vec4 {
        let place = self.picture_from_uv.transform_point2(uv);
        let size = Vec2::new(self.image.width as f32, self.image.height as f32);
        let at = Vec2::new(place.x, 1.0 - place.y) * size;
        if self.filter == TextureFilter::Nearest {
            return self.texel(at.floor());
        }
        let low = (at - 0.5).floor();
        let part = at - 0.5 - low;
        let row = |y: f32| self.texel(low + Vec2::new(0.0, y)).lerp(self.texel(low + Vec2::new(1.0, y)), part.x);
        row(0.0).lerp(row(1.0), part.y)
    }

    /// The number that it stands for at texture coordinates `uv`.
    pub fn number_at(&self, uv: Vec2) -> f32 {
        self.at(uv)[self.channel]
    }

    fn texel(&self, place: Vec2) -> Vec4 {
        let column = self.wrap[0].index(place.x as i64, self.image.width);
        let row = self.wrap[1].index(place.y as i64, self.image.height);
        to_vec4(&self.image.texels[row as usize * self.image.width as usize + column as usize])
    }
}

/// How a picture goes on beyond its edge.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Wrap {
    /// It begins again.
    #[default]
    Repeat,
    /// It goes back, and then begins again.
    Mirror,
    /// Its last texel goes on.
    Clamp,
}

impl Wrap {
    /// The texel among `count` that stands at `index`.
    fn index(self, index: i64, count: u32) -> u32 {
        let count = i64::from(count);
        let inside = match self {
            Self::Repeat => index.rem_euclid(count),
            Self::Mirror => {
                let twice = index.rem_euclid(2 * count);
                twice.min(2 * count - 1 - twice)
            }
            Self::Clamp => index.clamp(0, count - 1),
        };
        inside as u32
    }
}

/// What lies between texels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum TextureFilter {
    /// A bilinear mean of the four texels around.
    #[default]
    Linear,
    /// The texel that the place is in.
    Nearest,
}

/// The pictures of a material. Each is multiplied by the number or colour that it belongs to.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Textures {
    /// The material's colour: `albedo`, `diffuse`, `reflectance`, `tint` or `base_color`. Conductors have none.
    pub color: Option<Texture>,
    /// `roughness`, of materials that have one.
    pub roughness: Option<Texture>,
    /// `metallic`, of [`MaterialKind::MetallicRoughness`](crate::MaterialKind::MetallicRoughness).
    pub metallic: Option<Texture>,
    /// The shading normal.
    pub normal: Option<NormalMap>,
    /// `opacity`.
    pub opacity: Option<Texture>,
    /// `emission`.
    pub emission: Option<Texture>,
}

impl Textures {
    /// All of them.
    pub fn iter(&self) -> impl Iterator<Item = &Texture> {
        let normal = self.normal.as_ref().map(|map| &map.texture);
        let others = [&self.color, &self.roughness, &self.metallic, &self.opacity, &self.emission];
        others.into_iter().filter_map(Option::as_ref).chain(normal)
    }

    /// Whether there is any.
    pub fn any(&self) -> bool {
        self.iter().next().is_some()
    }
}

/// A tangent-space normal map: red is along the texture's u, green along its v, blue along the normal, each from −1 (0) to 1 (1).
#[derive(Clone, Debug, PartialEq)]
pub struct NormalMap {
    /// The picture.
    pub texture: Texture,
    /// Factor on red and green, after they are brought to −1 … 1.
    pub strength: f32,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn indices_beyond_the_edge() {
        let around = |wrap: Wrap| (-4..7).map(|index| wrap.index(index, 3)).collect::<Vec<_>>();
        assert_eq!(around(Wrap::Repeat), [2, 0, 1, 2, 0, 1, 2, 0, 1, 2, 0]);
        assert_eq!(around(Wrap::Mirror), [2, 2, 1, 0, 0, 1, 2, 2, 1, 0, 0]);
        assert_eq!(around(Wrap::Clamp), [0, 0, 0, 0, 0, 1, 2, 2, 2, 2, 2]);
    }

    #[test]
    fn texels_stand_in_the_middle_of_their_squares_and_rows_begin_at_the_top() {
        let texel = |x: f32| [f16::from_f32(x), f16::ZERO, f16::ZERO, f16::ONE];
        let image = TextureImage::new(2, 2, [1.0, 2.0, 3.0, 4.0].map(texel).to_vec()).unwrap();
        let texture = Texture { wrap: [Wrap::Clamp; 2], ..Texture::new(Arc::new(image)) };
        let at = |u, v| texture.number_at(Vec2::new(u, v));
        assert_eq!([at(0.25, 0.75), at(0.75, 0.75), at(0.25, 0.25), at(0.75, 0.25)], [1.0, 2.0, 3.0, 4.0]);
        assert_eq!([at(0.5, 0.5), at(0.0, 1.0), at(2.0, -1.0)], [2.5, 1.0, 4.0]);
        let nearest = Texture { filter: TextureFilter::Nearest, ..texture.clone() };
        assert_eq!(nearest.number_at(Vec2::new(0.49, 0.51)), 1.0);
        assert_eq!((texture.image.least().x, texture.image.most().x, texture.image.mean().x), (1.0, 4.0, 2.5));
    }
}
