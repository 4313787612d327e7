//! Pictures as PNG.

use std::{io::Write as _, path::Path};

use image::{ExtendedColorType, ImageEncoder as _, codecs::png::PngEncoder};

use crate::{Error, Picture, Tone, replace::replace, tone::encode_srgb};

/// How radiance becomes the 8 bits of a PNG.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Display {
    /// Stops of exposure: radiance is multiplied by 2^exposure.
    pub exposure: f32,
    /// The tone curve.
    pub tone: Tone,
}

impl Display {
    /// A channel's byte: exposed, tone-mapped, encoded as sRGB and rounded. Negative and undefined radiance is black.
    fn byte(&self, radiance: f32) -> u8 {
        let exposed = radiance.max(0.0) * self.exposure.exp2();
        // The conversion turns a product 0 · ∞ into 0.
        (encode_srgb(self.tone.apply(exposed)) * 255.0).round() as u8
    }
}

impl Display {
    /// A picture's pixels as 8-bit sRGB, three bytes each, row by row.
    pub fn encode(&self, picture: &Picture<'_>) -> Vec<u8> {
        picture.pixels.as_flattened().iter().map(|&channel| self.byte(channel)).collect()
    }
}

/// Writes a picture as PNG: 8 bits a channel, sRGB.
///
/// # Errors
/// If the pixels are not as many as the size says, or the file cannot be written.
pub fn write_png(path: &Path, picture: &Picture<'_>, display: &Display) -> Result<(), Error> {
    let bytes = encode_png(path, picture, None, display)?;
    replace(path, |file| file.write_all(&bytes))
}

/// Writes bytes of sRGB, three for each pixel, row by row from the top left, as PNG.
///
/// # Errors
/// If the pixels are not as many as the size says, or the file cannot be written.
pub fn write_rgb8(path: &Path, width: u32, height: u32, bytes: &[u8]) -> Result<(), Error> {
    if bytes.len() as u64 != 3 * u64::from(width) * u64::from(height) {
        return Err(Error::Shape { path: path.to_owned(), width, height, found: bytes.len() / 3 });
    }
    replace(path, |file| PngEncoder::new(file).write_image(bytes, width, height, ExtendedColorType::Rgb8))
}

/// The bytes of a PNG file: 8 bits a channel, sRGB, with an opacity from 0 to 1 for each pixel if it has holes. `path` is for messages.
pub(crate) fn encode_png(
    path: &Path,
    picture: &Picture<'_>,
    opacity: Option<&[f32]>,
    display: &Display,
) -> Result<Vec<u8>, Error> {
    picture.check_shape(path)?;
    let colors = picture.pixels.iter().map(|pixel| pixel.map(|channel| display.byte(channel)));
    let (bytes, kind): (Vec<u8>, _) = match opacity {
        None => (colors.flatten().collect(), ExtendedColorType::Rgb8),
        Some(opacity) => {
            picture.check_count(path, opacity.len())?;
            let share = |share: f32| (share.clamp(0.0, 1.0) * 255.0).round() as u8;
            let pixels = colors.zip(opacity).map(|([r, g, b], &a)| [r, g, b, share(a)]);
            (pixels.flatten().collect(), ExtendedColorType::Rgba8)
        }
    };
    let mut file = Vec::new();
    PngEncoder::new(&mut file)
        .write_image(&bytes, picture.width, picture.height, kind)
        .map_err(|error| Error::Write { path: path.to_owned(), source: error.into() })?;
    Ok(file)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_are_exposed_mapped_and_encoded() {
        let plain = Display { exposure: 0.0, tone: Tone::Plain };
        assert_eq!([0.0, 1.0, 5.0, -1.0, f32::NAN, f32::INFINITY].map(|c| plain.byte(c)), [0, 255, 255, 0, 0, 255]);
        // Linear 0.214 is half of the sRGB scale.
        assert_eq!(plain.byte(0.214_041_14), 128);
        let brighter = Display { exposure: 2.0, tone: Tone::Plain };
        assert_eq!(brighter.byte(0.25 * 0.214_041_14), 128);
        let filmic = Display { exposure: 0.0, tone: Tone::Filmic };
        // 1 becomes 0.8, which is 0.9063 in sRGB.
        assert_eq!(filmic.byte(1.0), 231);
    }

    #[test]
    fn the_file_holds_the_bytes() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("picture.png");
        let pixels = [[0.0, 0.214_041_14, 1.0], [1.0, 0.0, 0.0], [0.0; 3], [0.0, 9.0, 0.0]];
        let picture = Picture { width: 2, height: 2, pixels: &pixels };
        write_png(&path, &picture, &Display { exposure: 0.0, tone: Tone::Plain }).unwrap();
        let read = image::open(&path).unwrap();
        assert_eq!((read.width(), read.height(), read.color()), (2, 2, image::ColorType::Rgb8));
        assert_eq!(read.as_bytes(), [0, 128, 255, 255, 0, 0, 0, 0, 0, 0, 255, 0]);
        let short = Picture { pixels: &pixels[..3], ..picture };
        assert!(matches!(write_png(&path, &short, &Display::default()), Err(Error::Shape { found: 3, .. })));
    }
}
