//! Makes pictures, and scenes that show them.

#![allow(dead_code, reason = "each test program uses a part")]

use std::{
    fs::{self, File},
    io::BufWriter,
    path::PathBuf,
};

use diacaustic_scene::{ColorSpace, LoadedScene, Material, Scene, load_scene, load_texture};
use glam::Vec4;
use half::f16;
use image::{
    DynamicImage, ExtendedColorType, GrayAlphaImage, GrayImage, ImageBuffer, ImageEncoder, Luma, LumaA, Rgb, RgbImage,
    Rgba, RgbaImage,
    codecs::{hdr::HdrEncoder, jpeg::JpegEncoder, openexr::OpenExrEncoder},
};
use tempfile::TempDir;

/// A folder with a picture of each kind, 2 × 1 texels.
pub struct Folder(TempDir);

impl Folder {
    /// Makes it.
    pub fn new() -> Self {
        let folder = Self(tempfile::tempdir().unwrap());
        let save = |name: &str, image: DynamicImage| image.save(folder.path(name)).unwrap();
        let rgb = RgbImage::from_fn(2, 1, |x, _| if x == 0 { Rgb([255, 128, 0]) } else { Rgb([10, 11, 51]) });
        let rgba = RgbaImage::from_fn(2, 1, |x, _| Rgba(if x == 0 { [255, 128, 0, 51] } else { [10, 11, 51, 255] }));
        let deep = |x: u32| [65535, 32768, 1000 * x as u16];
        save("rgb.png", rgb.into());
        save("rgba.png", rgba.into());
        save("gray.png", GrayImage::from_fn(2, 1, |x, _| Luma([if x == 0 { 51 } else { 204 }])).into());
        save("gray-alpha.png", GrayAlphaImage::from_pixel(2, 1, LumaA([51, 128])).into());
        save("deep.png", ImageBuffer::from_fn(2, 1, |x, _| Rgb(deep(x))).into());
        save("deep-gray.png", ImageBuffer::from_pixel(2, 1, Luma([32768u16])).into());
        save("deep-alpha.png", ImageBuffer::from_pixel(2, 1, Rgba([65535u16, 0, 0, 32768])).into());
        folder.write_hdr("light.hdr", &[[4.0, 1.0, 0.5], [0.0, 0.25, 2.0]]);
        folder.write_exr("light.exr", &[[4.0, 1.0, 0.5], [0.0, 0.25, 2.0]]);
        folder
    }

    /// The path of a file in it.
    pub fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    /// Writes a file.
    pub fn write(&self, name: &str, bytes: &[u8]) {
        fs::write(self.path(name), bytes).unwrap();
    }

    /// Writes a row of texels.
    pub fn write_hdr(&self, name: &str, texels: &[[f32; 3]]) {
        let texels: Vec<_> = texels.iter().copied().map(Rgb).collect();
        HdrEncoder::new(File::create(self.path(name)).unwrap()).encode(&texels, texels.len(), 1).unwrap();
    }

    /// The same.
    pub fn write_exr<const N: usize>(&self, name: &str, texels: &[[f32; N]]) {
        let color = if N == 4 { ExtendedColorType::Rgba32F } else { ExtendedColorType::Rgb32F };
        let bytes: Vec<u8> = texels.iter().flatten().flat_map(|number| number.to_ne_bytes()).collect();
        let writer = BufWriter::new(File::create(self.path(name)).unwrap());
        OpenExrEncoder::new(writer).write_image(&bytes, texels.len() as u32, 1, color).unwrap();
    }

    /// A JPEG file of one colour.
    pub fn write_jpeg(&self, name: &str, gray: bool) {
        let mut bytes = Vec::new();
        let encoder = JpegEncoder::new_with_quality(&mut bytes, 100);
        if gray {
            encoder.write_image(&[188; 256], 16, 16, ExtendedColorType::L8).unwrap();
        } else {
            encoder.write_image(&[200u8, 100, 50].repeat(256), 16, 16, ExtendedColorType::Rgb8).unwrap();
        }
        self.write(name, &bytes);
    }

    /// A scene of a box of one material, and a second one of `others`.
    pub fn load_with(&self, material: &str, others: &str) -> Result<LoadedScene, String> {
        let text = format!(
            "[camera]\nposition = [0, 2, 3]\nlook_at = [0, 0, 0]\nvertical_fov = 40\n\
             [[objects]]\nbox = {{ min = [0, 0, 0], max = [1, 1, 1] }}\nmaterial = 'm'\n\
             [materials.m]\n{material}\n{others}\n"
        );
        self.write("x.toml", text.as_bytes());
        let prefix = format!("{}/", self.0.path().display());
        load_scene(&self.path("x.toml")).map_err(|error| error.to_string().replace(&prefix, ""))
    }

    /// The same without a second one.
    pub fn scene(&self, material: &str) -> Scene {
        self.load_with(material, "").unwrap_or_else(|error| panic!("{material}\n{error}")).scene
    }

    /// A material of these keys.
    pub fn material(&self, keys: &str) -> Material {
        self.scene(keys).materials[0].clone()
    }

    /// The message about a material, without its place, which must be within the material's table.
    pub fn error(&self, keys: &str) -> String {
        let Err(message) = self.load_with(keys, "") else { panic!("accepted:\n{keys}") };
        let (place, message) = message.split_once(": ").unwrap();
        let line: usize = place.split(':').nth(1).unwrap().parse().unwrap();
        assert!(line > 8, "{place}: {message}");
        message.to_owned()
    }

    /// The texels of a file.
    pub fn texels(&self, name: &str, color_space: ColorSpace) -> Vec<Vec4> {
        let picture = load_texture(&self.path(name), color_space).unwrap();
        picture.image.texels().iter().map(|texel| Vec4::from(texel.map(f16::to_f32))).collect()
    }

    /// What is said about a file, without its path.
    pub fn file_error(&self, name: &str) -> String {
        let message = load_texture(&self.path(name), ColorSpace::Linear).unwrap_err().to_string();
        message.replace(&format!("{}/", self.0.path().display()), "")
    }
}
