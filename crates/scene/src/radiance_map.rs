//! Pictures of what surrounds a scene.

use glam::Vec3;

/// Radiance from every direction, as an equirectangular picture.
///
/// Row 0 is at the top, +y. Column 0 begins at +z and the columns go on by −x, −z (the picture's middle) and +x. The texel of column
/// i and row j stands at u = (i + ½)/width, v = (j + ½)/height, where a direction has
/// u = ½ + atan2(x, −z)/2π and v = acos(y)/π. Between texels the radiance is bilinear; columns wrap around, rows end.
#[derive(Clone, Debug, PartialEq)]
pub struct RadianceMap {
    /// Texels along the horizon.
    pub width: u32,
    /// Texels from the zenith to the nadir.
    pub height: u32,
    /// Radiance, W/(m² sr) per channel (linear Rec. 709), ≥ 0, row by row.
    pub texels: Vec<Vec3>,
}

impl RadianceMap {
    /// Whether every texel is black.
    pub fn is_dark(&self) -> bool {
        self.texels.iter().all(|texel| *texel == Vec3::ZERO)
    }

    /// The most texels along the horizon.
    pub const MAX_WIDTH: u32 = 16384;

    /// The most texels from the zenith to the nadir.
    pub const MAX_HEIGHT: u32 = 8192;

    /// What is wrong with the size or the texels.
    pub(crate) fn check(&self) -> Result<(), String> {
        let Self { width, height, texels } = self;
        check_size(*width, *height)?;
        let (count, expected) = (texels.len(), *width as usize * *height as usize);
        if count != expected {
            return Err(format!("has {count} texels; {width} × {height} must have {expected}"));
        }
        let is_wrong = |texel: &Vec3| !texel.is_finite() || texel.cmplt(Vec3::ZERO).any();
        match texels.iter().position(is_wrong) {
            Some(index) => Err(format!(
                "has the radiance {} at column {}, row {} (from 0); each channel must be finite and 0 or greater",
                texels[index],
                index % *width as usize,
                index / *width as usize
            )),
            None => Ok(()),
        }
    }
}

/// What is wrong with the size of a map.
pub(crate) fn check_size(width: u32, height: u32) -> Result<(), String> {
    let (most_wide, most_high) = (RadianceMap::MAX_WIDTH, RadianceMap::MAX_HEIGHT);
    if (2..=most_wide).contains(&width) && (1..=most_high).contains(&height) {
        return Ok(());
    }
    Err(format!("has {width} × {height} texels; it must have from 2 × 1 to {most_wide} × {most_high}"))
}
