//! Reads pictures of surfaces from PNG, JPEG, Radiance HDR and OpenEXR.

use std::{
    fs::File,
    io::{BufRead, BufReader, Cursor, Read, Seek},
    path::Path,
    sync::Arc,
};

use half::f16;
use image::{
    ColorType, ImageDecoder, ImageError, ImageFormat, Limits,
    codecs::{hdr::HdrDecoder, jpeg::JpegDecoder, openexr::OpenExrDecoder, png::PngDecoder},
};

use crate::{Error, TextureImage, environment_image::radiance_divisor, texture::check_size};

/// What the numbers of a picture's red, green and blue stand for. Coverage (alpha) is linear always.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ColorSpace {
    /// Colours encoded by IEC 61966-2-1 (sRGB).
    Srgb,
    /// The numbers themselves.
    Linear,
}

/// A picture from a file, and what the file holds of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// The texels.
    pub image: Arc<TextureImage>,
    /// Whether the file has red, green and blue; else gray stands for all three.
    pub has_color: bool,
    /// Whether the file has coverage; else it is 1.
    pub has_alpha: bool,
}

/// Reads a picture from a file whose name ends in `.png`, `.jpg`, `.jpeg`, `.hdr` (Radiance) or `.exr` (OpenEXR).
///
/// Numbers of 8 and 16 bits become 0 to 1, by sRGB's curve where `color_space` says so. Those of a Radiance file are divided by the
/// exposure and the colour correction that its header states, as the format asks. Colour profiles are not used, and colours
/// are not multiplied by coverage.
///
/// # Errors
/// If the file cannot be read, is cut off or is no such picture, if it is larger than [`TextureImage::MAX_SIZE`] along a side, holds
/// numbers that are not finite or too great for half precision, or if a Radiance or OpenEXR file is to be sRGB: they hold linear
/// numbers. The size is checked before memory is taken for the texels.
pub fn load_texture(path: &Path, color_space: ColorSpace) -> Result<Picture, Error> {
    let error = |problem| Error::Image { path: path.to_owned(), problem };
    let format = format_of(path).map_err(error)?;
    if holds_linear_numbers(path) && color_space == ColorSpace::Srgb {
        return Err(error(
            "holds linear numbers, as every .hdr and .exr file does; its color_space must be \"linear\"".into(),
        ));
    }
    let file = File::open(path).map_err(|cause| Error::Read { path: path.to_owned(), cause })?;
    let mut reader = BufReader::new(file);
    check_content(&mut reader, format).map_err(error)?;
    decode(reader, format, color_space).map_err(error)
}

/// Reads a PNG or JPEG picture of at most `most_texels` from bytes, in whatever format they begin as.
///
/// # Errors
/// What is wrong with the picture; the size is checked before memory is taken for the texels.
pub(crate) fn decode_texture(bytes: &[u8], color_space: ColorSpace, most_texels: u64) -> Result<Picture, String> {
    let format = match image::guess_format(bytes) {
        Ok(format @ (ImageFormat::Png | ImageFormat::Jpeg)) => format,
        Ok(other) => return Err(format!("is {} file; it must be PNG or JPEG", with_article(other))),
        Err(_) => return Err("is neither PNG nor JPEG by its content".to_owned()),
    };
    let (width, height) = match format {
        ImageFormat::Png => {
            PngDecoder::with_limits(Cursor::new(bytes), Limits::default()).map_err(undecodable)?.dimensions()
        }
        _ => JpegDecoder::new(Cursor::new(bytes)).map_err(undecodable)?.dimensions(),
    };
    check_size(width, height)?;
    if u64::from(width) * u64::from(height) > most_texels {
        return Err(format!(
            "has {width} × {height} texels, but only {most_texels} more are read of one file's pictures"
        ));
    }
    decode(Cursor::new(bytes), format, color_space)
}

/// Whether a file of this name holds linear numbers rather than sRGB's.
pub(crate) fn holds_linear_numbers(path: &Path) -> bool {
    matches!(format_of(path), Ok(ImageFormat::Hdr | ImageFormat::OpenExr))
}

fn format_of(path: &Path) -> Result<ImageFormat, String> {
    let ending = path.extension().and_then(|ending| ending.to_str()).unwrap_or_default().to_lowercase();
    match ending.as_str() {
        "png" => Ok(ImageFormat::Png),
        "jpg" | "jpeg" => Ok(ImageFormat::Jpeg),
        "hdr" => Ok(ImageFormat::Hdr),
        "exr" => Ok(ImageFormat::OpenExr),
        _ => Err("is of a kind that is not read; pictures end in .png, .jpg, .jpeg, .hdr or .exr".to_owned()),
    }
}

/// Refuses a file that begins as one of another format does.
fn check_content(reader: &mut impl BufRead, named: ImageFormat) -> Result<(), String> {
    let start = reader.fill_buf().map_err(|error| format!("cannot be read: {error}"))?;
    match image::guess_format(start) {
        Ok(found) if found != named => Err(format!(
            "is {} file by its content and {} file by its name; rename or convert it",
            with_article(found),
            with_article(named)
        )),
        _ => Ok(()),
    }
}

fn with_article(format: ImageFormat) -> String {
    match format {
        ImageFormat::Png => "a PNG".to_owned(),
        ImageFormat::Jpeg => "a JPEG".to_owned(),
        ImageFormat::Hdr => "a Radiance HDR".to_owned(),
        ImageFormat::OpenExr => "an OpenEXR".to_owned(),
        other => format!("a {other:?}"),
    }
}

fn decode(mut reader: impl BufRead + Seek, format: ImageFormat, color_space: ColorSpace) -> Result<Picture, String> {
    match format {
        ImageFormat::Png => Numbers::read(PngDecoder::with_limits(reader, Limits::default()).map_err(undecodable)?)?
            .picture(color_space),
        ImageFormat::Jpeg => {
            check_jpeg_end(&mut reader)?;
            Numbers::read(JpegDecoder::new(reader).map_err(undecodable)?)?.picture(color_space)
        }
        ImageFormat::Hdr => {
            let decoder = HdrDecoder::new(reader).map_err(undecodable)?;
            let divisor = radiance_divisor(&decoder.metadata())?;
            Numbers { divisor: divisor.to_array(), ..Numbers::read(decoder)? }.picture(color_space)
        }
        _ => Numbers::read(OpenExrDecoder::new(reader).map_err(undecodable)?)?.picture(color_space),
    }
}

fn undecodable(error: ImageError) -> String {
    format!("cannot be decoded: {error}")
}

/// Refuses a JPEG file without the marker that ends it: the decoder makes up what is missing.
fn check_jpeg_end(reader: &mut (impl Read + Seek)) -> Result<(), String> {
    const SCAN: [u8; 2] = [0xff, 0xda];
    const END: [u8; 2] = [0xff, 0xd9];
    let unreadable = |error| format!("cannot be read: {error}");
    let mut bytes = Vec::new();
    reader.read_to_end(&mut bytes).map_err(unreadable)?;
    reader.rewind().map_err(unreadable)?;
    let last = |marker: [u8; 2]| bytes.windows(2).rposition(|pair| pair == marker);
    if last(SCAN).is_some_and(|scan| last(END).is_none_or(|end| end < scan)) {
        return Err("cannot be decoded: the file ends before its picture does".to_owned());
    }
    Ok(())
}

/// What a decoder gives: rows from the top, each number in the machine's byte order.
struct Numbers {
    width: u32,
    height: u32,
    color: ColorType,
    bytes: Vec<u8>,
    /// What red, green and blue are divided by.
    divisor: [f32; 3],
}

impl Numbers {
    fn read(decoder: impl ImageDecoder) -> Result<Self, String> {
        let ((width, height), color) = (decoder.dimensions(), decoder.color_type());
        check_size(width, height)?;
        let count = width as usize * height as usize * usize::from(color.bytes_per_pixel());
        let mut bytes = Vec::new();
        bytes.try_reserve_exact(count).map_err(|_| too_large(width, height))?;
        bytes.resize(count, 0);
        decoder.read_image(&mut bytes).map_err(undecodable)?;
        Ok(Self { width, height, color, bytes, divisor: [1.0; 3] })
    }

    fn picture(self, color_space: ColorSpace) -> Result<Picture, String> {
        let texels = match self.color {
            ColorType::L8 | ColorType::La8 | ColorType::Rgb8 | ColorType::Rgba8 => {
                let [color, alpha] = [color_space, ColorSpace::Linear].map(|space| decoded(u8::MAX.into(), space));
                self.texels(|[byte]| color[usize::from(byte)], |[byte]| alpha[usize::from(byte)])
            }
            ColorType::L16 | ColorType::La16 | ColorType::Rgb16 | ColorType::Rgba16 => {
                let [color, alpha] = [color_space, ColorSpace::Linear].map(|space| decoded(u16::MAX, space));
                let index = |bytes| usize::from(u16::from_ne_bytes(bytes));
                self.texels(|bytes| color[index(bytes)], |bytes| alpha[index(bytes)])
            }
            ColorType::Rgb32F | ColorType::Rgba32F => self.texels(f32::from_ne_bytes, f32::from_ne_bytes),
            other => return Err(format!("has texels of the kind {other:?}, which is not read")),
        }?;
        Ok(Picture {
            image: Arc::new(TextureImage::new(self.width, self.height, texels)?),
            has_color: self.color.has_color(),
            has_alpha: self.color.has_alpha(),
        })
    }

    /// The texels, of numbers of N bytes: gray or colours by the one function, coverage by the other.
    fn texels<const N: usize>(
        &self,
        color: impl Fn([u8; N]) -> f32,
        alpha: impl Fn([u8; N]) -> f32,
    ) -> Result<Vec<[f16; 4]>, String> {
        let channels = usize::from(self.color.channel_count());
        let mut texels = Vec::new();
        texels
            .try_reserve_exact(self.width as usize * self.height as usize)
            .map_err(|_| too_large(self.width, self.height))?;
        let (numbers, _) = self.bytes.as_chunks::<N>();
        for texel in numbers.chunks_exact(channels) {
            let place = |channel| if self.color.has_color() { channel } else { 0 };
            let [r, g, b] = [0, 1, 2].map(|k| color(texel[place(k)]) / self.divisor[k]);
            let a = if self.color.has_alpha() { alpha(texel[channels - 1]) } else { 1.0 };
            texels.push([r, g, b, a].map(f16::from_f32));
        }
        Ok(texels)
    }
}

fn too_large(width: u32, height: u32) -> String {
    format!("has {width} × {height} texels, more than memory holds")
}

/// What each whole number from 0 to `most` stands for.
fn decoded(most: u16, color_space: ColorSpace) -> Vec<f32> {
    let share = |number: u16| f64::from(number) / f64::from(most);
    let decode = match color_space {
        ColorSpace::Srgb => linear_from_srgb,
        ColorSpace::Linear => |share| share,
    };
    (0..=most).map(|number| decode(share(number)) as f32).collect()
}

/// The light that a number of an sRGB picture stands for (IEC 61966-2-1).
pub(crate) fn linear_from_srgb(encoded: f64) -> f64 {
    if encoded <= 0.04045 { encoded / 12.92 } else { ((encoded + 0.055) / 1.055).powf(2.4) }
}
