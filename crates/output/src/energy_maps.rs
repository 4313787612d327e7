//! Energy maps as OpenEXR.

use std::path::{Path, PathBuf};

use crate::{Error, Picture, false_color::write_false_colors, object_folder::ObjectFolder, open_exr::write_layers};

/// The irradiance that an object's energy map holds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Irradiance<'m> {
    /// Texels along x.
    pub width: u32,
    /// Texels along y.
    pub height: u32,
    /// Irradiance, W/m², linear Rec. 709, row by row from row 0: what fell on the front, then, if the map has a second layer,
    /// what fell on the back.
    pub texels: &'m [[f32; 3]],
    /// The ends of the lines that bound its charts, in texels from the middle of the first one.
    pub chart_borders: &'m [[[f32; 2]; 2]],
}

/// A folder of energy maps: two files an object, `NAME.exr` and the same in false colours, `NAME.png`.
///
/// The channels R, G, B hold the irradiance of the front, W/m², 32-bit float, and `back.R`, `back.G`, `back.B` that of the
/// back, for maps that have one. Line j of the file is row j of the map. The PNG
/// shows the mean of the channels, with a scale. Characters of an object's name that some file systems
/// refuse are written as `_`; a name that is taken then gets a number.
#[derive(Debug)]
pub struct EnergyMapFolder(ObjectFolder);

impl EnergyMapFolder {
    /// Opens a folder, creates it where it is missing, and checks that it takes files. Files in it stay until they are
    /// replaced.
    ///
    /// # Errors
    /// If the folder cannot be created or written to.
    pub fn open(path: &Path) -> Result<Self, Error> {
        ObjectFolder::open(path).map(Self)
    }

    /// Writes one object's map; returns its OpenEXR file.
    ///
    /// # Errors
    /// If the texels are not as many as one or two layers of the map have, or the file cannot be written.
    pub fn write(&mut self, object: &str, map: &Irradiance<'_>) -> Result<PathBuf, Error> {
        let stem = self.0.stem(object);
        let path = self.0.path_of(&format!("{stem}.exr"));
        let layer = |pixels| Picture { width: map.width, height: map.height, pixels };
        let texels_in_layer = map.width as usize * map.height as usize;
        let (front, back) = map.texels.split_at(texels_in_layer.min(map.texels.len()));
        let mut layers = vec![("", layer(front))];
        if !back.is_empty() {
            layers.push(("back.", layer(back)));
        }
        write_layers(&path, "irradiance, W/m^2", &layers)?;
        write_false_colors(&self.0.path_of(&format!("{stem}.png")), map)?;
        Ok(path)
    }
}

#[cfg(test)]
mod tests {
    use exr::prelude::read_all_flat_layers_from_file;

    use super::*;

    #[test]
    fn both_sides_go_into_one_file() {
        let folder = tempfile::tempdir().unwrap();
        let mut maps = EnergyMapFolder::open(&folder.path().join("new/maps")).unwrap();
        let texels: Vec<[f32; 3]> = (0..12u8).map(|i| [f32::from(i), 0.0, 0.5]).collect();
        let both =
            maps.write("floor", &Irradiance { width: 3, height: 2, texels: &texels, chart_borders: &[] }).unwrap();
        let front =
            maps.write("Floor", &Irradiance { width: 3, height: 4, texels: &texels, chart_borders: &[] }).unwrap();
        assert!(both.ends_with("new/maps/floor.exr") && front.ends_with("new/maps/Floor 2.exr"));
        let file = read_all_flat_layers_from_file(&both).unwrap();
        let channels = &file.layer_data[0].channel_data.list;
        let names: Vec<_> = channels.iter().map(|channel| channel.name.to_string()).collect();
        assert_eq!(names, ["B", "G", "R", "back.B", "back.G", "back.R"]);
        let values = |at: usize| channels[at].sample_data.values_as_f32().collect::<Vec<_>>();
        assert_eq!((values(2), values(5)), ((0..6u8).map(f32::from).collect(), (6..12u8).map(f32::from).collect()));
        let picture = image::open(folder.path().join("new/maps/floor.png")).unwrap().to_rgb8();
        // Both layers, enlarged to 513 pixels and beside their scale.
        assert!(picture.width() > 513 && picture.height() > 2 * 342, "{:?}", picture.dimensions());
        // The first texel has (0 + 0 + 0.5)/3 W/m², the last of the back (11 + 0 + 0.5)/3 of 5.
        let [first, last] = [(30, 90), (500, picture.height() - 30)].map(|(x, y)| picture.get_pixel(x, y).0);
        assert_eq!([first, last], [[70, 13, 96], [101, 203, 93]]);
        assert!(
            maps.write("short", &Irradiance { width: 3, height: 2, texels: &texels[..5], chart_borders: &[] }).is_err()
        );
        assert!(
            maps.write("long", &Irradiance { width: 3, height: 2, texels: &texels[..9], chart_borders: &[] }).is_err()
        );
    }

    #[test]
    fn a_file_in_the_place_of_the_folder_is_named() {
        let file = tempfile::NamedTempFile::new().unwrap();
        let message = EnergyMapFolder::open(file.path()).unwrap_err().to_string();
        assert!(message.starts_with(&file.path().display().to_string()), "{message}");
    }
}
