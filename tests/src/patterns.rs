//! Pictures made in code.

use std::sync::Arc;

use diacaustic_scene::{NormalMap, Texture, TextureImage};
use half::f16;

/// A texture of `width` × `height` texels, each of what `texel` makes of its column and row (from the top).
///
/// # Panics
/// If a number is not finite in half precision.
pub fn pattern(width: u32, height: u32, texel: impl Fn(u32, u32) -> [f32; 4]) -> Texture {
    let places = (0..height).flat_map(|row| (0..width).map(move |column| (column, row)));
    let texels = places.map(|(column, row)| texel(column, row).map(f16::from_f32)).collect();
    let image = TextureImage::new(width, height, texels).unwrap_or_else(|problem| panic!("the pattern {problem}"));
    Texture::new(Arc::new(image))
}

/// A normal map of the slopes, along s and t, that `slope` makes of a texel's column and row.
///
/// # Panics
/// If a slope is not finite.
pub fn normal_pattern(width: u32, height: u32, slope: impl Fn(u32, u32) -> [f32; 2]) -> Option<NormalMap> {
    let texel = |column, row| {
        let [x, y] = slope(column, row);
        let length = (x * x + y * y + 1.0).sqrt();
        [0.5 + 0.5 * x / length, 0.5 + 0.5 * y / length, 0.5 + 0.5 / length, 1.0]
    };
    Some(NormalMap { texture: pattern(width, height, texel), strength: 1.0 })
}
