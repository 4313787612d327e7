//! Pictures at a point, as `docs/materials.md`, "Textures", defines them.

use diacaustic_scene::{Texture, TextureFilter, TextureImage, Wrap};
use glam::{DVec2, DVec3, DVec4, I64Vec2};

/// The four channels of a texture at texture coordinates.
pub fn texture_at(texture: &Texture, uv: DVec2) -> DVec4 {
    let place = texture.picture_from_uv.as_daffine2().transform_point2(uv);
    let size = DVec2::new(f64::from(texture.image.width()), f64::from(texture.image.height()));
    let point = DVec2::new(place.x, 1.0 - place.y) * size;
    match texture.filter {
        TextureFilter::Nearest => texel(texture, point.floor().as_i64vec2()),
        TextureFilter::Linear => {
            let corner = (point - 0.5).floor();
            let [f, g] = (point - 0.5 - corner).to_array();
            let at = |i: i64, j: i64| texel(texture, corner.as_i64vec2() + I64Vec2::new(i, j));
            (1.0 - g) * ((1.0 - f) * at(0, 0) + f * at(1, 0)) + g * ((1.0 - f) * at(0, 1) + f * at(1, 1))
        }
    }
}

/// The number that a texture stands for at texture coordinates; 1 without a texture.
pub fn number_at(texture: Option<&Texture>, uv: DVec2) -> f64 {
    texture.map_or(1.0, |texture| texture_at(texture, uv)[texture.channel])
}

/// The colour that a texture stands for at texture coordinates; white without a texture.
pub fn color_at(texture: Option<&Texture>, uv: DVec2) -> DVec3 {
    texture.map_or(DVec3::ONE, |texture| texture_at(texture, uv).truncate())
}

/// The texel of a column and a row, which may lie beyond the picture's edges.
fn texel(texture: &Texture, place: I64Vec2) -> DVec4 {
    let image: &TextureImage = &texture.image;
    let column = wrapped(texture.wrap[0], place.x, image.width());
    let row = wrapped(texture.wrap[1], place.y, image.height());
    DVec4::from(image.texels()[row * image.width() as usize + column].map(|number| number.to_f64()))
}

/// The index among `count` texels that stands for one beyond the edge.
fn wrapped(wrap: Wrap, index: i64, count: u32) -> usize {
    let count = i64::from(count);
    let inside = match wrap {
        Wrap::Repeat => index.rem_euclid(count),
        Wrap::Clamp => index.clamp(0, count - 1),
        Wrap::Mirror => {
            let k = index.rem_euclid(2 * count);
            k.min(2 * count - 1 - k)
        }
    };
    inside as usize
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use glam::{Affine2, Vec2};
    use half::f16;

    use super::*;
    use crate::generator::Generator;

    fn picture(width: u32, height: u32, generator: &mut Generator) -> Arc<TextureImage> {
        let mut texel = || std::array::from_fn(|_| f16::from_f64(generator.unit()));
        let texels = (0..width * height).map(|_| texel()).collect();
        Arc::new(TextureImage::new(width, height, texels).expect("the picture has its texels"))
    }

    #[test]
    fn agrees_with_the_host_in_every_mode() {
        let mut generator = Generator::new(&[17]);
        let wraps = [Wrap::Repeat, Wrap::Mirror, Wrap::Clamp];
        let modes = (0..9).map(|i| [wraps[i % 3], wraps[i / 3]]);
        for (wrap, filter) in modes.flat_map(|wrap| [(wrap, TextureFilter::Linear), (wrap, TextureFilter::Nearest)]) {
            let picture_from_uv = Affine2::from_scale_angle_translation(Vec2::new(1.5, -0.5), 0.4, Vec2::new(0.1, 0.7));
            let image = picture(5, 3, &mut generator);
            let texture = Texture { wrap, filter, picture_from_uv, ..Texture::new(image) };
            let mut differing = 0;
            for _ in 0..1000 {
                let uv = Vec2::new(generator.unit() as f32, generator.unit() as f32) * 8.0 - 4.0;
                let difference = texture_at(&texture, uv.as_dvec2()) - texture.at(uv).as_dvec4();
                differing += i32::from(difference.abs().max_element() > 1e-4);
            }
            // Single precision sees the edge between two texels elsewhere now and then.
            assert!(differing <= 2, "{wrap:?}, {filter:?}: {differing} of 1000 differ");
        }
    }

    #[test]
    fn rows_are_counted_from_the_top() {
        let texel = |x: f64| [f16::from_f64(x), f16::from_f64(10.0 * x), f16::ZERO, f16::ONE];
        let image = TextureImage::new(2, 2, [1.0, 2.0, 3.0, 4.0].map(texel).to_vec()).expect("four texels");
        let texture = Texture { wrap: [Wrap::Clamp, Wrap::Repeat], ..Texture::new(Arc::new(image)) };
        let at = |u, v| texture_at(&texture, DVec2::new(u, v)).x;
        assert_eq!([at(0.25, 0.75), at(0.75, 0.75), at(0.25, 0.25), at(0.75, 0.25)], [1.0, 2.0, 3.0, 4.0]);
        // The left edge goes on; above the upper edge the lower one begins.
        assert_eq!([at(0.0, 0.75), at(-7.0, 0.75), at(0.25, 1.0), at(0.25, 0.0)], [1.0, 1.0, 2.0, 2.0]);
        let second = Texture { channel: 1, ..texture.clone() };
        assert_eq!(number_at(Some(&second), DVec2::new(0.75, 0.75)), 20.0);
        assert_eq!((number_at(None, DVec2::ZERO), color_at(None, DVec2::ZERO)), (1.0, DVec3::ONE));
    }
}
