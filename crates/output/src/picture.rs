//! Pictures and their formats.

use std::path::Path;

use crate::{Display, Error, write_exr, write_png};

/// A picture in memory.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Picture<'p> {
    /// Pixels along x.
    pub width: u32,
    /// Pixels along y.
    pub height: u32,
    /// Radiance, W/(m² sr), linear Rec. 709, row by row from the top left; width · height of them.
    pub pixels: &'p [[f32; 3]],
}

impl Picture<'_> {
    /// Refuses a picture whose pixels are not as many as its size says.
    pub(crate) fn check_shape(&self, path: &Path) -> Result<(), Error> {
        self.check_count(path, self.pixels.len())
    }

    /// Refuses values that are not as many as the picture's size says.
    pub(crate) fn check_count(&self, path: &Path, found: usize) -> Result<(), Error> {
        if found as u64 == u64::from(self.width) * u64::from(self.height) {
            return Ok(());
        }
        Err(Error::Shape { path: path.to_owned(), width: self.width, height: self.height, found })
    }
}

/// The formats that pictures are written in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// OpenEXR: 32-bit float radiance, linear.
    Exr,
    /// PNG: 8 bits a channel, exposed, tone-mapped, sRGB.
    Png,
}

impl Format {
    /// The format that the ending of a file's name stands for, in any case.
    ///
    /// # Errors
    /// If it stands for none.
    pub fn of(path: &Path) -> Result<Self, Error> {
        let ending = path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
        match ending.as_str() {
            "exr" => Ok(Self::Exr),
            "png" => Ok(Self::Png),
            _ => Err(Error::UnknownEnding(path.to_owned())),
        }
    }
}

/// Writes a picture in the format that the file's ending stands for; `display` counts for PNG alone.
///
/// # Errors
/// If the ending stands for no format, or the file cannot be written.
pub fn write_picture(path: &Path, picture: &Picture<'_>, display: &Display) -> Result<(), Error> {
    match Format::of(path)? {
        Format::Exr => write_exr(path, picture),
        Format::Png => write_png(path, picture, display),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ending_chooses_the_format() {
        assert_eq!(Format::of(Path::new("a/b.exr")).unwrap(), Format::Exr);
        assert_eq!(Format::of(Path::new("b.PNG")).unwrap(), Format::Png);
        for name in ["b", "b.jpg", ".png", "png"] {
            let message = Format::of(Path::new(name)).unwrap_err().to_string();
            assert!(message.starts_with(name) && message.contains(".exr or .png"), "{message}");
        }
    }
}
