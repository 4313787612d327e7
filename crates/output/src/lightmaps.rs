//! Lightmaps as OpenEXR and PNG.

use std::{
    f32::consts::PI,
    path::{Path, PathBuf},
};

use crate::{Display, Error, Picture, open_exr::write_layers, write_png};

/// The irradiance of an object's surface, W/m², linear Rec. 709, row by row from row 0: what meets the front, then, if the map has a
/// second layer, what meets the back.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightmapTexels<'m> {
    /// Texels along x.
    pub width: u32,
    /// Texels along y.
    pub height: u32,
    /// All light.
    pub all: &'m [[f32; 3]],
    /// Its parts, by name: together they are all.
    pub parts: &'m [(&'m str, &'m [[f32; 3]])],
}

impl LightmapTexels<'_> {
    /// Its kinds of light and sides: what their channels' names begin with, and their texels.
    fn layers(&self) -> Vec<(String, Picture<'_>)> {
        let texels_in_layer = self.width as usize * self.height as usize;
        let kinds = [("", self.all)].into_iter().chain(self.parts.iter().copied());
        let mut layers = Vec::new();
        for (name, texels) in kinds {
            let (front, back) = texels.split_at(texels_in_layer.min(texels.len()));
            let sides = [("", front), ("back.", back)]
                .into_iter()
                .filter(|(side, texels)| side.is_empty() || !texels.is_empty());
            for (side, pixels) in sides {
                let prefix = if name.is_empty() { side.to_owned() } else { format!("{side}{name}.") };
                layers.push((prefix, Picture { width: self.width, height: self.height, pixels }));
            }
        }
        layers
    }

    /// Writes OpenEXR: 32-bit float irradiance. The channels R, G, B hold all light on the front, `direct.R` and so on its parts, and
    /// `back.R` and `back.direct.R` what meets the back.
    ///
    /// # Errors
    /// If texels are not as many as one or two layers have, or the file cannot be written.
    pub fn write_exr(&self, path: &Path) -> Result<(), Error> {
        let layers = self.layers();
        let borrowed: Vec<_> = layers.iter().map(|(prefix, picture)| (prefix.as_str(), *picture)).collect();
        write_layers(path, "irradiance, W/m^2", &borrowed)
    }

    /// Writes a PNG for each kind of light and side, `STEM.png`, `STEM.direct.png`, `STEM.back.png` and so on in a folder: a white matt surface
    /// in this light, exposed and tone-mapped. Returns the files.
    ///
    /// # Errors
    /// If texels are not as many as one or two layers have, or a file cannot be written.
    pub fn write_pngs(&self, folder: &Path, stem: &str, display: &Display) -> Result<Vec<PathBuf>, Error> {
        let mut paths = Vec::new();
        for (prefix, picture) in self.layers() {
            let path = folder.join(format!("{stem}.{prefix}png"));
            let radiance: Vec<_> = picture.pixels.iter().map(|texel| texel.map(|channel| channel / PI)).collect();
            write_png(&path, &Picture { pixels: &radiance, ..picture }, display)?;
            paths.push(path);
        }
        Ok(paths)
    }
}

#[cfg(test)]
mod tests {
    use exr::prelude::read_first_flat_layer_from_file;

    use super::*;
    use crate::Tone;

    #[test]
    fn every_kind_of_light_has_channels_and_pictures_on_both_sides() {
        let folder = tempfile::tempdir().unwrap();
        let all: Vec<[f32; 3]> = (0..12u8).map(|i| [f32::from(i), 2.0, 0.5]).collect();
        let direct: Vec<[f32; 3]> = (0..12u8).map(|i| [0.5 * f32::from(i), 1.0, 0.25]).collect();
        let map = LightmapTexels { width: 3, height: 2, all: &all, parts: &[("direct", &direct)] };
        let path = folder.path().join("floor.exr");
        map.write_exr(&path).unwrap();
        let file = read_first_flat_layer_from_file(&path).unwrap();
        let names: Vec<_> = file.layer_data.channel_data.list.iter().map(|channel| channel.name.to_string()).collect();
        let sides = ["B", "G", "R", "back.B", "back.G", "back.R", "back.direct.B", "back.direct.G", "back.direct.R"];
        assert_eq!(names[..9], sides);
        assert_eq!(names[9..], ["direct.B", "direct.G", "direct.R"]);
        let back: Vec<f32> = file.layer_data.channel_data.list[8].sample_data.values_as_f32().collect();
        assert_eq!(back, [3.0, 3.5, 4.0, 4.5, 5.0, 5.5]);

        let display = Display { exposure: 0.0, tone: Tone::Plain };
        let files = map.write_pngs(folder.path(), "floor", &display).unwrap();
        let names: Vec<_> = files.iter().map(|file| file.file_name().unwrap().to_str().unwrap()).collect();
        assert_eq!(names, ["floor.png", "floor.back.png", "floor.direct.png", "floor.back.direct.png"]);
        // 2 W/m² of light make 2/π W/(m² sr), which is 0.82 in sRGB.
        let green = image::open(&files[0]).unwrap().to_rgb8().get_pixel(1, 1)[1];
        assert_eq!(green, 209);
    }
}
