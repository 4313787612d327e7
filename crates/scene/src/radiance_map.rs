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
}
