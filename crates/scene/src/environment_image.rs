//! Reads pictures of what surrounds a scene from Radiance HDR and OpenEXR.

use std::{
    fs::File,
    io::{BufRead, BufReader, Seek},
    path::Path,
};

use glam::Vec3;
use image::{
    ImageDecoder,
    codecs::{
        hdr::{HdrDecoder, HdrMetadata},
        openexr::OpenExrDecoder,
    },
};

use crate::{Error, RadianceMap, radiance_map::check_size};

/// Reads an equirectangular picture from a file whose name ends in `.hdr` (Radiance) or `.exr` (OpenEXR).
///
/// Its channels are taken for linear Rec. 709 and its numbers for radiance, W/(m² sr). Those of a Radiance file are divided by the
/// exposure and the colour correction that its header states, as the format asks. Transparency is not used.
///
/// # Errors
/// If the file cannot be read or is no such picture, is larger than [`RadianceMap::MAX_WIDTH`] × [`RadianceMap::MAX_HEIGHT`],
/// or has a texel that is negative or not finite. The size is checked before memory is taken for the texels.
pub fn load_environment(path: &Path) -> Result<RadianceMap, Error> {
    let error = |problem| Error::Image { path: path.to_owned(), problem };
    let format = Format::of(path).map_err(error)?;
    let file = File::open(path).map_err(|cause| Error::Read { path: path.to_owned(), cause })?;
    let map = decode(BufReader::new(file), format).map_err(error)?;
    map.check().map_err(error)?;
    Ok(map)
}

#[derive(Clone, Copy)]
enum Format {
    Radiance,
    OpenExr,
}

impl Format {
    fn of(path: &Path) -> Result<Self, String> {
        let ends_in = |ending| path.extension().is_some_and(|found| found.eq_ignore_ascii_case(ending));
        match (ends_in("hdr"), ends_in("exr")) {
            (true, _) => Ok(Self::Radiance),
            (_, true) => Ok(Self::OpenExr),
            _ => Err("is of a kind that is not read; environment images end in .hdr or .exr".to_owned()),
        }
    }
}

fn decode(reader: impl BufRead + Seek, format: Format) -> Result<RadianceMap, String> {
    let problem = |error: image::ImageError| format!("cannot be decoded: {error}");
    match format {
        Format::Radiance => {
            let decoder = HdrDecoder::new(reader).map_err(problem)?;
            let divisor = radiance_divisor(&decoder.metadata())?;
            let mut map = read_texels(decoder)?;
            map.texels.iter_mut().for_each(|texel| *texel /= divisor);
            Ok(map)
        }
        Format::OpenExr => {
            let without_alpha = Some(false);
            read_texels(OpenExrDecoder::with_alpha_preference(reader, without_alpha).map_err(problem)?)
        }
    }
}

/// What the numbers of a Radiance file are divided by to be radiance.
pub(crate) fn radiance_divisor(header: &HdrMetadata) -> Result<Vec3, String> {
    let correction = header.color_correction.map_or(Vec3::ONE, Vec3::from);
    let divisor = correction * header.exposure.unwrap_or(1.0);
    if divisor.is_finite() && divisor.cmpgt(Vec3::ZERO).all() {
        return Ok(divisor);
    }
    Err(format!("states an exposure times colour correction of {divisor}; it must be finite and greater than 0"))
}

/// The texels of a decoder of three 32-bit channels.
fn read_texels(decoder: impl ImageDecoder) -> Result<RadianceMap, String> {
    let (width, height) = decoder.dimensions();
    check_size(width, height)?;
    let count = width as usize * height as usize;
    let mut texels = Vec::new();
    texels.try_reserve_exact(count).map_err(|_| format!("has {width} × {height} texels, more than memory holds"))?;
    texels.resize(count, Vec3::ZERO);
    decoder.read_image(bytemuck::cast_slice_mut(&mut texels)).map_err(|error| format!("cannot be decoded: {error}"))?;
    Ok(RadianceMap { width, height, texels })
}
