//! Pictures on surfaces: what scene files say of them, what their files hold, and what is refused.

use std::{
    f32::consts::FRAC_PI_6,
    fs::{self, File},
    io::BufWriter,
    path::{Path, PathBuf},
    sync::Arc,
};

use diacaustic_scene::{
    ColorSpace, Dispersion, LoadedScene, Material, MaterialKind, Mesh, NormalMap, Scene, Texture, TextureFilter,
    TextureImage, Warning, Wrap, load_scene, load_texture,
};
use glam::{Affine2, Vec2, Vec3, Vec4};
use half::f16;
use image::{
    DynamicImage, ExtendedColorType, GrayAlphaImage, GrayImage, ImageBuffer, ImageEncoder, Luma, LumaA, Rgb, RgbImage,
    Rgba, RgbaImage,
    codecs::{hdr::HdrEncoder, jpeg::JpegEncoder, openexr::OpenExrEncoder},
};
use tempfile::TempDir;

/// A folder with a picture of each kind, 2 × 1 texels.
struct Folder(TempDir);

impl Folder {
    fn new() -> Self {
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

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn write(&self, name: &str, bytes: &[u8]) {
        fs::write(self.path(name), bytes).unwrap();
    }

    fn write_hdr(&self, name: &str, texels: &[[f32; 3]]) {
        let texels: Vec<_> = texels.iter().copied().map(Rgb).collect();
        HdrEncoder::new(File::create(self.path(name)).unwrap()).encode(&texels, texels.len(), 1).unwrap();
    }

    fn write_exr<const N: usize>(&self, name: &str, texels: &[[f32; N]]) {
        let color = if N == 4 { ExtendedColorType::Rgba32F } else { ExtendedColorType::Rgb32F };
        let bytes: Vec<u8> = texels.iter().flatten().flat_map(|number| number.to_ne_bytes()).collect();
        let writer = BufWriter::new(File::create(self.path(name)).unwrap());
        OpenExrEncoder::new(writer).write_image(&bytes, texels.len() as u32, 1, color).unwrap();
    }

    /// A JPEG file of one colour.
    fn write_jpeg(&self, name: &str, gray: bool) {
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
    fn load_with(&self, material: &str, others: &str) -> Result<LoadedScene, String> {
        let text = format!(
            "[camera]\nposition = [0, 2, 3]\nlook_at = [0, 0, 0]\nvertical_fov = 40\n\
             [[objects]]\nbox = {{ min = [0, 0, 0], max = [1, 1, 1] }}\nmaterial = 'm'\n\
             [materials.m]\n{material}\n{others}\n"
        );
        self.write("x.toml", text.as_bytes());
        let prefix = format!("{}/", self.0.path().display());
        load_scene(&self.path("x.toml")).map_err(|error| error.to_string().replace(&prefix, ""))
    }

    fn scene(&self, material: &str) -> Scene {
        self.load_with(material, "").unwrap_or_else(|error| panic!("{material}\n{error}")).scene
    }

    fn material(&self, keys: &str) -> Material {
        self.scene(keys).materials[0].clone()
    }

    /// The message about a material, without its place, which must be within the material's table.
    fn error(&self, keys: &str) -> String {
        let Err(message) = self.load_with(keys, "") else { panic!("accepted:\n{keys}") };
        let (place, message) = message.split_once(": ").unwrap();
        let line: usize = place.split(':').nth(1).unwrap().parse().unwrap();
        assert!(line > 8, "{place}: {message}");
        message.to_owned()
    }

    fn texels(&self, name: &str, color_space: ColorSpace) -> Vec<Vec4> {
        let picture = load_texture(&self.path(name), color_space).unwrap();
        picture.image.texels().iter().map(|texel| Vec4::from(texel.map(f16::to_f32))).collect()
    }

    /// What is said about a file, without its path.
    fn file_error(&self, name: &str) -> String {
        let message = load_texture(&self.path(name), ColorSpace::Linear).unwrap_err().to_string();
        message.replace(&format!("{}/", self.0.path().display()), "")
    }
}

fn assert_near(found: &[Vec4], expected: &[[f32; 4]]) {
    assert_eq!(found.len(), expected.len());
    for (found, expected) in found.iter().zip(expected) {
        // Half precision keeps 11 bits.
        let tolerance = 6e-4 * Vec4::from(*expected).abs() + 1e-7;
        assert!((*found - Vec4::from(*expected)).abs().cmple(tolerance).all(), "{found} against {expected:?}");
    }
}

#[test]
fn whole_numbers_are_decoded() {
    let folder = Folder::new();
    // 128/255 and 51/255 are above the curve's straight part, 10/255 is below, 11/255 just above.
    let colors = [[1.0, 0.215_860_5, 0.0], [0.003_035_27, 0.003_346_54, 0.033_104_767]];
    let with = |alpha: [f32; 2]| [0, 1].map(|k| [colors[k][0], colors[k][1], colors[k][2], alpha[k]]);
    let (srgb, linear) = (ColorSpace::Srgb, ColorSpace::Linear);
    assert_near(&folder.texels("rgb.png", srgb), &with([1.0; 2]));
    assert_near(&folder.texels("rgba.png", srgb), &with([0.2, 1.0]));
    let plain = [[1.0, 128.0 / 255.0, 0.0, 0.2], [10.0 / 255.0, 11.0 / 255.0, 0.2, 1.0]];
    assert_near(&folder.texels("rgba.png", linear), &plain);
    assert_near(&folder.texels("gray.png", linear), &[[0.2, 0.2, 0.2, 1.0], [0.8, 0.8, 0.8, 1.0]]);
    let dark = 0.033_104_767;
    assert_near(&folder.texels("gray-alpha.png", srgb), &[[dark, dark, dark, 128.0 / 255.0]; 2]);
    assert_near(&folder.texels("deep.png", linear), &[[1.0, 0.5, 0.0, 1.0], [1.0, 0.5, 1000.0 / 65535.0, 1.0]]);
    assert_near(&folder.texels("deep.png", srgb), &[[1.0, 0.214, 0.0, 1.0], [1.0, 0.214, 0.001_181, 1.0]]);
    assert_near(&folder.texels("deep-gray.png", linear), &[[0.5, 0.5, 0.5, 1.0]; 2]);
    assert_near(&folder.texels("deep-alpha.png", srgb), &[[1.0, 0.0, 0.0, 0.5]; 2]);
}

#[test]
fn jpeg_files_are_decoded() {
    let folder = Folder::new();
    folder.write_jpeg("color.jpg", false);
    folder.write_jpeg("gray.JPEG", true);
    let close = |found: Vec4, bytes: [f32; 3]| {
        let expected = Vec3::from(bytes) / 255.0;
        assert!(found.truncate().abs_diff_eq(expected, 3.0 / 255.0), "{found} against {expected}");
        assert_eq!(found.w, 1.0);
    };
    close(folder.texels("color.jpg", ColorSpace::Linear)[99], [200.0, 100.0, 50.0]);
    close(folder.texels("gray.JPEG", ColorSpace::Linear)[99], [188.0; 3]);
    let has_color = |name: &str| load_texture(&folder.path(name), ColorSpace::Srgb).unwrap().has_color;
    assert_eq!((has_color("color.jpg"), has_color("gray.JPEG")), (true, false));
}

#[test]
fn light_is_decoded() {
    let folder = Folder::new();
    let expected = [[4.0, 1.0, 0.5, 1.0], [0.0, 0.25, 2.0, 1.0]];
    for name in ["light.hdr", "light.exr"] {
        assert_eq!(folder.texels(name, ColorSpace::Linear), expected.map(Vec4::from));
    }
    folder.write_exr("covered.exr", &[[1.0, 2.0, 3.0, 0.25]]);
    let picture = load_texture(&folder.path("covered.exr"), ColorSpace::Linear).unwrap();
    assert!(picture.has_alpha && picture.has_color);
    assert_eq!(folder.texels("covered.exr", ColorSpace::Linear), [Vec4::new(1.0, 2.0, 3.0, 0.25)]);
    let header = b"#?RADIANCE\nEXPOSURE=4\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n";
    folder.write("exposed.hdr", &[header.as_slice(), &[128, 64, 32, 129]].concat());
    assert_eq!(folder.texels("exposed.hdr", ColorSpace::Linear), [Vec4::new(0.25, 0.125, 0.0625, 1.0)]);
}

#[test]
fn every_key_that_takes_a_picture_fills_its_place() {
    let folder = Folder::new();
    let color = |material: &Material| {
        let kind = material.kind.clone();
        let factor = match kind {
            MaterialKind::Diffuse { albedo } | MaterialKind::Coated { albedo, .. } => albedo,
            MaterialKind::Phong { diffuse, .. } => diffuse,
            MaterialKind::Mirror { reflectance } => reflectance,
            MaterialKind::Dielectric { tint, .. } | MaterialKind::ThinWalled { tint, .. } => tint,
            MaterialKind::MetallicRoughness { base_color, .. } => base_color,
            MaterialKind::Conductor { .. } => panic!("a conductor has no colour"),
        };
        (factor, material.textures.color.clone())
    };
    let cases = [
        ("type = 'diffuse'", "albedo"),
        ("type = 'phong'\nambient = 0.5\nspecular = 0\nshininess = 5", "diffuse"),
        ("type = 'mirror'", "reflectance"),
        ("type = 'dielectric'\nior = 1.5", "tint"),
        ("type = 'thin_walled'", "tint"),
        ("type = 'coated'", "albedo"),
        ("type = 'metallic_roughness'", "base_color"),
    ];
    let image = load_texture(&folder.path("rgb.png"), ColorSpace::Srgb).unwrap().image;
    for (keys, key) in cases {
        let (factor, texture) = color(&folder.material(&format!("{keys}\n{key} = {{ image = 'rgb.png' }}")));
        assert_eq!((factor, texture.unwrap()), (Vec3::ONE, Texture::new(Arc::clone(&image))), "{keys}");
        let with_factor = format!("{keys}\n{key} = {{ image = 'rgb.png', factor = [0.5, 0.25, 1] }}");
        assert_eq!(color(&folder.material(&with_factor)).0, Vec3::new(0.5, 0.25, 1.0), "{keys}");
        assert!(color(&folder.material(&format!("{keys}\n{key} = 0.5"))).1.is_none(), "{keys}");
    }
}

#[test]
fn numbers_take_pictures() {
    let folder = Folder::new();
    let image = load_texture(&folder.path("rgb.png"), ColorSpace::Linear).unwrap().image;
    let expected = |channel| Some(Texture { channel, ..Texture::new(Arc::clone(&image)) });
    for keys in [
        "type = 'conductor'\nmetal = 'gold'",
        "type = 'dielectric'\nior = 1.5",
        "type = 'coated'\nalbedo = 0.5",
        "type = 'metallic_roughness'",
    ] {
        let material = folder.material(&format!("{keys}\nroughness = {{ image = 'rgb.png', factor = 0.75 }}"));
        assert_eq!(material.textures.roughness, expected(1), "{keys}");
        assert!(format!("{:?}", material.kind).contains("roughness: 0.75"), "{:?}", material.kind);
    }
    let metal = folder.material("type = 'metallic_roughness'\nmetallic = { image = 'rgb.png', factor = 0.5 }");
    assert_eq!(metal.textures.metallic, expected(2));
    assert!(matches!(metal.kind, MaterialKind::MetallicRoughness { metallic: 0.5, roughness: 1.0, .. }));
}

#[test]
fn channels_have_defaults_and_names() {
    let folder = Folder::new();
    let channel = |key: &str, table: &str| {
        let material = folder.material(&format!("type = 'metallic_roughness'\n{key} = {{ image = {table} }}"));
        material.textures.iter().next().unwrap().channel
    };
    assert_eq!([channel("roughness", "'rgb.png'"), channel("roughness", "'gray.png'")], [1, 0]);
    assert_eq!([channel("metallic", "'rgba.png'"), channel("metallic", "'gray-alpha.png'")], [2, 0]);
    assert_eq!([channel("opacity", "'rgba.png'"), channel("opacity", "'gray-alpha.png'")], [3, 3]);
    assert_eq!([channel("opacity", "'rgb.png'"), channel("opacity", "'gray.png'")], [0, 0]);
    for (index, name) in ["r", "g", "b", "a"].into_iter().enumerate() {
        assert_eq!(channel("roughness", &format!("'rgba.png', channel = '{name}'")), index);
    }
}

#[test]
fn every_type_but_glass_takes_an_emission_picture() {
    let folder = Folder::new();
    let image = load_texture(&folder.path("light.hdr"), ColorSpace::Linear).unwrap().image;
    for keys in [
        "type = 'diffuse'\nalbedo = 0",
        "type = 'phong'\nambient = 0\ndiffuse = 0\nspecular = 0\nshininess = 5",
        "type = 'mirror'\nreflectance = 0",
        "type = 'conductor'\nmetal = 'gold'",
        "type = 'coated'\nalbedo = 0",
        "type = 'metallic_roughness'",
    ] {
        let material = folder.material(&format!("{keys}\nemission = {{ image = 'light.hdr' }}"));
        assert_eq!(material.emission, Vec3::ONE);
        assert_eq!(material.textures.emission, Some(Texture::new(Arc::clone(&image))));
        let brighter = folder.material(&format!("{keys}\nemission = {{ image = 'light.hdr', factor = [9, 8, 7] }}"));
        assert_eq!(brighter.emission, Vec3::new(9.0, 8.0, 7.0));
    }
}

#[test]
fn every_type_takes_a_normal_map_and_all_but_dielectrics_opacity() {
    let folder = Folder::new();
    let image = load_texture(&folder.path("rgb.png"), ColorSpace::Linear).unwrap().image;
    let texture = Texture::new(Arc::clone(&image));
    for keys in [
        "type = 'diffuse'\nalbedo = 0",
        "type = 'phong'\nambient = 0\ndiffuse = 0\nspecular = 0\nshininess = 5",
        "type = 'mirror'\nreflectance = 0",
        "type = 'conductor'\nmetal = 'gold'",
        "type = 'dielectric'\nior = 1.5",
        "type = 'thin_walled'",
        "type = 'coated'\nalbedo = 0",
        "type = 'metallic_roughness'",
    ] {
        let normal = folder.material(&format!("{keys}\nnormal = {{ image = 'rgb.png' }}")).textures.normal;
        assert_eq!(normal, Some(NormalMap { texture: texture.clone(), strength: 1.0 }), "{keys}");
        let strong = folder.material(&format!("{keys}\nnormal = {{ image = 'rgb.png', strength = -2.5 }}"));
        assert_eq!(strong.textures.normal.unwrap().strength, -2.5);
        if keys.contains("dielectric") {
            continue;
        }
        let even = folder.material(&format!("{keys}\nopacity = 0.25"));
        assert_eq!((even.opacity, even.opacity_cutoff, even.textures.opacity), (0.25, None, None));
        let leaf = folder
            .material(&format!("{keys}\nopacity = {{ image = 'rgb.png', factor = 0.5, channel = 'g', cutoff = 0.4 }}"));
        assert_eq!((leaf.opacity, leaf.opacity_cutoff), (0.5, Some(0.4)));
        assert_eq!(leaf.textures.opacity, Some(Texture { channel: 1, ..texture.clone() }));
    }
}

#[test]
fn a_sub_table_says_the_same_as_an_inline_table() {
    let folder = Folder::new();
    let inline = folder.material("type = 'diffuse'\nalbedo = { image = 'rgb.png', factor = 0.5 }");
    let sub = folder.material("type = 'diffuse'\n[materials.m.albedo]\nimage = 'rgb.png'\nfactor = 0.5");
    assert_eq!(inline, sub);
}

#[test]
fn placement_is_read() {
    let folder = Folder::new();
    let texture = |keys: &str| {
        let material = folder.material(&format!("type = 'diffuse'\nalbedo = {{ image = 'rgb.png'{keys} }}"));
        material.textures.color.unwrap()
    };
    let plain = texture("");
    assert_eq!((plain.wrap, plain.filter), ([Wrap::Repeat; 2], TextureFilter::Linear));
    assert_eq!(plain.picture_from_uv, Affine2::IDENTITY);
    let wrap = |text: &str| texture(&format!(", wrap = {text}")).wrap;
    assert_eq!([wrap("'clamp'"), wrap("'repeat'")], [[Wrap::Clamp; 2], [Wrap::Repeat; 2]]);
    assert_eq!(wrap("['mirror', 'clamp']"), [Wrap::Mirror, Wrap::Clamp]);
    let filter = |text: &str| texture(&format!(", filter = '{text}'")).filter;
    assert_eq!([filter("nearest"), filter("linear")], [TextureFilter::Nearest, TextureFilter::Linear]);
    let place = |keys: &str, u, v| texture(keys).picture_from_uv.transform_point2(Vec2::new(u, v));
    assert_eq!(place(", scale = 4", 0.5, 1.0), Vec2::new(2.0, 4.0));
    assert_eq!(place(", scale = [-1, 3]", 0.5, 1.0), Vec2::new(-0.5, 3.0));
    assert_eq!(place(", offset = [0.5, -1]", 0.25, 0.0), Vec2::new(0.75, -1.0));
    assert!(place(", rotate = 90", 1.0, 0.0).abs_diff_eq(Vec2::Y, 1e-7), "turned counter-clockwise");
    // (1, 0) is scaled to (2, 0), turned to (√3, 1), moved.
    let all = place(", scale = [2, 7], rotate = 30, offset = [0.5, 0.25]", 1.0, 0.0);
    assert!(all.abs_diff_eq(Vec2::new(2.0 * FRAC_PI_6.cos() + 0.5, 1.25), 1e-6), "{all}");
}

#[test]
fn color_spaces_have_defaults_and_names() {
    let folder = Folder::new();
    let green = |texture: Option<Texture>| texture.unwrap().image.most().y;
    let near = |found: f32, expected: f32| assert!((found - expected).abs() < 1e-3, "{found} against {expected}");
    let color =
        |keys: &str| green(folder.material(&format!("type = 'diffuse'\nalbedo = {{ image = {keys} }}")).textures.color);
    near(color("'rgb.png'"), 0.216);
    near(color("'rgb.png', color_space = 'srgb'"), 0.216);
    near(color("'rgb.png', color_space = 'linear'"), 0.502);
    near(color("'light.exr', factor = 0.25"), 1.0);
    let number = |keys: &str| {
        let keys = format!("type = 'coated'\nalbedo = 0\nroughness = {{ image = {keys} }}");
        green(folder.material(&keys).textures.roughness)
    };
    near(number("'rgb.png'"), 0.502);
    near(number("'rgb.png', color_space = 'srgb'"), 0.216);
    let map = folder.material("type = 'diffuse'\nalbedo = 0\nnormal = { image = 'rgb.png' }").textures.normal;
    near(green(map.map(|map| map.texture)), 0.502);
}

#[test]
fn one_file_is_stored_once_for_the_whole_scene() {
    let folder = Folder::new();
    fs::create_dir(folder.path("folder")).unwrap();
    let first = "type = 'metallic_roughness'\nbase_color = { image = 'rgb.png' }\nroughness = { image = 'rgb.png' }\n\
                 metallic = { image = 'folder/../rgb.png', wrap = 'clamp' }";
    let second =
        "[materials.n]\ntype = 'mirror'\nreflectance = { image = './rgb.png' }\nnormal = { image = 'rgb.png' }";
    let scene = folder.load_with(first, second).unwrap().scene;
    let [m, n] = [0, 1].map(|index| scene.materials[index].textures.clone());
    let image = |texture: Option<Texture>| texture.unwrap().image;
    let (color, roughness) = (image(m.color), image(m.roughness));
    assert!(Arc::ptr_eq(&color, &image(n.color)));
    assert!(Arc::ptr_eq(&roughness, &image(m.metallic)));
    assert!(Arc::ptr_eq(&roughness, &image(n.normal.map(|map| map.texture))));
    assert!(!Arc::ptr_eq(&color, &roughness), "sRGB and linear numbers differ");
}

#[test]
fn faults_in_scene_files_are_named() {
    let folder = Folder::new();
    let diffuse = |keys: &str| format!("type = 'diffuse'\nalbedo = {keys}");
    let rough = |keys: &str| format!("type = 'coated'\nalbedo = 0\nroughness = {keys}");
    let matt = |keys: &str| format!("type = 'diffuse'\nalbedo = 0\n{keys}");
    let takes = "takes no picture; these keys do";
    let cases = [
        (
            diffuse("{ factor = 1 }"),
            "[materials.m]: albedo: the key \"image\" is missing; it takes the path of a picture (.png, .jpg, .hdr or .exr), relative \
             to the scene file"
                .to_owned(),
        ),
        (
            diffuse("'rgb.png'"),
            "[materials.m]: albedo: expected a colour: 3 numbers [r, g, b], one number for gray or a picture { image = \"FILE\" }, found \
             the string \"rgb.png\""
                .to_owned(),
        ),
        (
            rough("'rgb.png'"),
            "[materials.m]: roughness: expected a number or a picture { image = \"FILE\" }, found the string \"rgb.png\"".to_owned(),
        ),
        (
            diffuse("{ image = 'rgb.png', channel = 'r' }"),
            "[materials.m]: albedo: unknown key \"channel\"; known keys: image, wrap, filter, scale, rotate, offset, factor, color_space"
                .to_owned(),
        ),
        (
            rough("{ image = 'rgb.png', chanel = 'r' }"),
            "[materials.m]: roughness: unknown key \"chanel\"; did you mean \"channel\"? Known keys: image, wrap".to_owned(),
        ),
        (
            matt("normal = { image = 'rgb.png', color_space = 'linear' }"),
            "[materials.m]: normal: unknown key \"color_space\"; known keys: image, wrap, filter, scale, rotate, offset, strength"
                .to_owned(),
        ),
        (
            matt("normal = 1"),
            "[materials.m]: normal: expected a picture's table: { image = \"FILE\", ... }, found the whole number 1".to_owned(),
        ),
        (
            diffuse("{ image = 'none.png' }"),
            "[materials.m]: albedo: image: none.png: the file cannot be read: No such file or directory (os error 2)".to_owned(),
        ),
        (
            diffuse("{ image = 'x.toml' }"),
            "[materials.m]: albedo: image: x.toml: the image is of a kind that is not read; pictures end in .png, .jpg, .jpeg, .hdr or \
             .exr"
                .to_owned(),
        ),
        (
            diffuse("{ image = 'light.hdr', color_space = 'srgb' }"),
            "[materials.m]: albedo: image: light.hdr: the image holds linear numbers, as every .hdr and .exr file does; its color_space \
             must be \"linear\""
                .to_owned(),
        ),
        (
            diffuse("{ image = 'rgb.png', color_space = 'sRGB' }"),
            "[materials.m]: albedo: color_space: there is no colour space \"sRGB\"; did you mean \"srgb\"? Known names: srgb, linear"
                .to_owned(),
        ),
        (
            diffuse("{ image = 'rgb.png', wrap = 'tile' }"),
            "[materials.m]: albedo: wrap: there is no wrap \"tile\"; known names: repeat, mirror, clamp".to_owned(),
        ),
        (
            diffuse("{ image = 'rgb.png', wrap = ['clamp', 'mirrored'] }"),
            "[materials.m]: albedo: wrap[1]: there is no wrap \"mirrored\"; did you mean \"mirror\"?".to_owned(),
        ),
        (
            diffuse("{ image = 'rgb.png', wrap = ['clamp'] }"),
            "[materials.m]: albedo: wrap has 1 elements; it must have 2, [u, v], or be one name".to_owned(),
        ),
        (
            diffuse("{ image = 'rgb.png', filter = 'cubic' }"),
            "[materials.m]: albedo: filter: there is no filter \"cubic\"; known names: linear, nearest".to_owned(),
        ),
        (
            diffuse("{ image = 'rgb.png', scale = [1, 0] }"),
            "[materials.m]: albedo: scale is zero along an axis; a scale must not be 0".to_owned(),
        ),
        (
            diffuse("{ image = 'rgb.png', scale = [1, 2, 3] }"),
            "[materials.m]: albedo: scale: expected one number or 2 numbers [u, v], found an array of 3".to_owned(),
        ),
        (
            diffuse("{ image = 'rgb.png', offset = 1 }"),
            "[materials.m]: albedo: offset: expected 2 numbers [u, v], found the whole number 1".to_owned(),
        ),
        (
            rough("{ image = 'rgb.png', channel = 'red' }"),
            "[materials.m]: roughness: channel: there is no channel \"red\"; known names: r, g, b, a".to_owned(),
        ),
        (
            rough("{ image = 'rgb.png', channel = 'a' }"),
            "[materials.m]: roughness: channel is \"a\", which the picture does not have; take \"r\", \"g\" or \"b\"".to_owned(),
        ),
        (
            "type = 'dielectric'\nior = 1.5\nopacity = 0.5".to_owned(),
            "[materials.m]: opacity is set, but a dielectric bounds a volume, which has no holes; leave it out, or use the material \
             type \"thin_walled\""
                .to_owned(),
        ),
        (
            "type = 'thin_walled'\nemission = { image = 'rgb.png' }".to_owned(),
            "[materials.m]: emission is set, but glass takes no emission".to_owned(),
        ),
        (
            "type = 'thin_walled'\nior = { image = 'rgb.png' }".to_owned(),
            format!("[materials.m]: ior {takes}: tint, normal, opacity"),
        ),
        (
            "type = 'conductor'\nk = 1\neta = { image = 'rgb.png' }".to_owned(),
            format!("[materials.m]: eta {takes}: roughness, emission, normal, opacity"),
        ),
        (
            "type = 'conductor'\neta = 1\nk = { image = 'rgb.png' }".to_owned(),
            format!("[materials.m]: k {takes}: roughness, emission, normal, opacity"),
        ),
        (
            "type = 'dielectric'\nior = 1\nabsorption = { image = 'rgb.png' }".to_owned(),
            format!("[materials.m]: absorption {takes}: tint, roughness, normal"),
        ),
        (
            "type = 'phong'\nambient = { image = 'rgb.png' }".to_owned(),
            format!("[materials.m]: ambient {takes}: diffuse, emission, normal, opacity"),
        ),
        ("type = 'phong'\nspecular = { image = 'rgb.png' }".to_owned(), format!("[materials.m]: specular {takes}")),
        ("type = 'phong'\nshininess = { image = 'rgb.png' }".to_owned(), format!("[materials.m]: shininess {takes}")),
        (
            diffuse("{ image = 'rgb.png', factor = 2 }"),
            "material \"m\": albedo is [2, 2, 2]; each channel must be from 0 to 1".to_owned(),
        ),
        (
            diffuse("{ image = 'light.exr' }"),
            "material \"m\": albedo is [4, 1, 2] at the greatest numbers of its picture, times the factor; each channel must be from \
             0 to 1"
                .to_owned(),
        ),
        (
            "type = 'phong'\nspecular = 0\nshininess = 1\nambient = 0.5\ndiffuse = { image = 'light.exr', factor = 0.25 }".to_owned(),
            "material \"m\": ambient is [2, 0.5, 1] at the greatest numbers of its picture".to_owned(),
        ),
        (
            rough("{ image = 'light.exr', channel = 'r' }"),
            "material \"m\": roughness is 4 at the greatest number of its picture, times the factor; it must be from 0 to 1".to_owned(),
        ),
        (
            "type = 'metallic_roughness'\nmetallic = { image = 'light.exr' }".to_owned(),
            "material \"m\": metallic is 2 at the greatest number of its picture".to_owned(),
        ),
        (
            matt("opacity = { image = 'light.exr' }"),
            "material \"m\": opacity is 4 at the greatest number of its picture".to_owned(),
        ),
        (matt("opacity = 1.5"), "material \"m\": opacity is 1.5; it must be from 0 to 1".to_owned()),
        (
            matt("opacity = { image = 'rgb.png', cutoff = 2 }"),
            "material \"m\": opacity has the cutoff 2; it must be from 0 to 1".to_owned(),
        ),
        (
            matt("emission = { image = 'rgb.png', factor = -1 }"),
            "material \"m\": emission is [-1, -1, -1]; each channel must be 0 or greater (W/(m² sr))".to_owned(),
        ),
        (
            matt("emission = { image = 'light.exr', factor = 1e38 }"),
            "material \"m\": emission is [inf, ".to_owned(),
        ),
    ];
    for (keys, message) in cases {
        let found = folder.error(&keys);
        assert!(found.starts_with(&message), "{found}\nmust start with\n{message}");
    }
}

#[test]
fn negative_pictures_are_refused() {
    let folder = Folder::new();
    folder.write_exr("negative.exr", &[[0.5, -0.25, 0.5]]);
    let message = folder.error("type = 'diffuse'\nalbedo = { image = 'negative.exr', factor = 0.5 }");
    assert!(message.starts_with("material \"m\": albedo is [0.25, -0.125, 0.25] at the least numbers of its picture"));
    let message = folder.error("type = 'diffuse'\nalbedo = 0\nemission = { image = 'negative.exr' }");
    assert!(message.starts_with("material \"m\": emission is [0.5, -0.25, 0.5] at the least numbers of its picture"));
    let normal = "type = 'diffuse'\nalbedo = 0\nnormal = { image = 'negative.exr' }";
    assert!(folder.material(normal).textures.normal.is_some(), "a normal map's numbers may be any");
}

#[test]
fn faults_of_files_are_named() {
    let folder = Folder::new();
    let starts = |name: &str, message: &str| {
        let found = folder.file_error(name);
        assert!(found.starts_with(&format!("{name}: the image {message}")), "{found}");
    };
    folder.write_jpeg("sound.jpg", false);
    for name in ["rgb.png", "light.hdr", "light.exr", "sound.jpg"] {
        let bytes = fs::read(folder.path(name)).unwrap();
        let (stem, ending) = name.split_once('.').unwrap();
        let short = format!("short-{stem}.{ending}");
        folder.write(&short, &bytes[..bytes.len() - if ending == "png" { 24 } else { 2 }]);
        starts(&short, "cannot be decoded: ");
        let text = format!("text.{ending}");
        folder.write(&text, b"no image at all");
        starts(&text, "cannot be decoded: ");
        let empty = format!("empty.{ending}");
        folder.write(&empty, b"");
        starts(&empty, "cannot be decoded: ");
    }
    fs::copy(folder.path("rgb.png"), folder.path("mislabelled.jpg")).unwrap();
    starts("mislabelled.jpg", "is a PNG file by its content and a JPEG file by its name; rename or convert it");
    fs::copy(folder.path("light.exr"), folder.path("mislabelled.hdr")).unwrap();
    starts("mislabelled.hdr", "is an OpenEXR file by its content and a Radiance HDR file by its name");
    folder.write("picture.png", b"GIF89a\x01\x00\x01\x00");
    starts("picture.png", "is a Gif file by its content and a PNG file by its name");
    starts("picture.gif", "is of a kind that is not read; pictures end in .png, .jpg, .jpeg, .hdr or .exr");
    folder.write("huge.hdr", b"#?RADIANCE\n\n-Y 16385 +X 16384\n");
    starts("huge.hdr", "has 16384 × 16385 texels; it must have from 1 × 1 to 16384 × 16384");
    folder.write_exr("bright.exr", &[[1.0, 1e6, 1.0]]);
    starts(
        "bright.exr",
        "holds [1.0, inf, 1.0, 1.0] at column 0, row 0 (from 0); each number must be finite and at most 65504",
    );
    folder.write_exr("wrong.exr", &[[1.0, f32::NAN, 1.0]]);
    starts("wrong.exr", "holds [1.0, NaN, 1.0, 1.0] at column 0, row 0 (from 0)");
}

/// OpenEXR files are broken in `lights.rs`.
#[test]
fn no_file_makes_the_reader_panic() {
    let folder = Folder::new();
    folder.write_jpeg("sound.jpg", false);
    for name in ["rgba.png", "deep.png", "light.hdr", "sound.jpg"] {
        let sound = fs::read(folder.path(name)).unwrap();
        let path = folder.path(&format!("broken-{name}"));
        for place in (0..sound.len()).step_by(sound.len().div_ceil(200)) {
            fs::write(&path, &sound[..place]).unwrap();
            let _ = load_texture(&path, ColorSpace::Linear);
            for flipped in [0x01, 0xff] {
                let mut broken = sound.clone();
                broken[place] ^= flipped;
                fs::write(&path, &broken).unwrap();
                let _ = load_texture(&path, ColorSpace::Linear);
            }
        }
    }
}

/// A picture of one texel.
fn picture(texel: [f32; 4]) -> Texture {
    Texture::new(Arc::new(TextureImage::new(1, 1, vec![texel.map(f16::from_f32)]).unwrap()))
}

/// The message about a box's material that was built in code.
fn code_error(kind: MaterialKind, change: impl FnOnce(&mut Material)) -> String {
    let folder = Folder::new();
    let mut scene = folder.scene("type = 'diffuse'\nalbedo = 0.5");
    scene.materials[0].kind = kind;
    change(&mut scene.materials[0]);
    scene.validate().unwrap_err().to_string()
}

#[test]
fn pictures_that_a_kind_does_not_have_are_refused() {
    let diffuse = || MaterialKind::Diffuse { albedo: Vec3::ONE };
    let conductor = || MaterialKind::Conductor { eta: Vec3::ONE, k: Vec3::ONE, roughness: 0.5 };
    let glass = || MaterialKind::ThinWalled { ior: 1.5, tint: Vec3::ONE, roughness: 0.0 };
    let mirror = || MaterialKind::Mirror { reflectance: Vec3::ONE };
    let dielectric = || MaterialKind::Dielectric {
        ior: 1.5,
        dispersion: Dispersion::None,
        tint: Vec3::ONE,
        absorption: Vec3::ZERO,
        roughness: 0.0,
        priority: 0,
    };
    let one = || Some(picture([1.0; 4]));
    let refused = |key: &str, what: &str| {
        format!("material \"m\": textures.{key} is set, but a material of this kind has no {what}; it must be none")
    };
    assert_eq!(code_error(conductor(), |m| m.textures.color = one()), refused("color", "colour"));
    assert_eq!(code_error(mirror(), |m| m.textures.roughness = one()), refused("roughness", "roughness"));
    assert_eq!(code_error(glass(), |m| m.textures.roughness = one()), refused("roughness", "roughness"));
    assert_eq!(code_error(diffuse(), |m| m.textures.metallic = one()), refused("metallic", "share of metal"));
    assert_eq!(code_error(glass(), |m| m.textures.emission = one()), refused("emission", "emission"));
    let closed = "material \"m\": opacity is set, but a dielectric bounds a volume, which has no holes; it must be 1 without picture \
                  and cutoff (a sheet of glass is thin-walled)";
    assert_eq!(code_error(dielectric(), |m| m.opacity = 0.5), closed);
    assert_eq!(code_error(dielectric(), |m| m.opacity_cutoff = Some(0.5)), closed);
    assert_eq!(code_error(dielectric(), |m| m.textures.opacity = one()), closed);
}

#[test]
fn numbers_of_textures_out_of_range_are_refused() {
    let error = |change: fn(&mut Material)| code_error(MaterialKind::Diffuse { albedo: Vec3::ONE }, change);
    assert_eq!(
        error(|m| m.textures.normal = Some(NormalMap { texture: picture([0.5; 4]), strength: f32::NAN })),
        "material \"m\": normal has the strength NaN; it must be a finite number"
    );
    let turned = Affine2::from_scale(Vec2::new(f32::INFINITY, 1.0));
    let message = code_error(MaterialKind::Diffuse { albedo: Vec3::ONE }, |m| {
        m.textures.color = Some(Texture { picture_from_uv: turned, ..picture([1.0; 4]) });
    });
    assert!(message.starts_with("material \"m\": albedo has the picture_from_uv "), "{message}");
    assert!(message.ends_with("; each number must be finite"), "{message}");
    assert_eq!(
        error(|m| m.textures.opacity = Some(Texture { channel: 4, ..picture([1.0; 4]) })),
        "material \"m\": opacity is of the channel 4 of its picture; it must be from 0 to 3"
    );
    assert_eq!(error(|m| m.opacity = f32::NAN), "material \"m\": opacity is NaN; it must be from 0 to 1");
    assert_eq!(
        error(|m| m.opacity_cutoff = Some(f32::NAN)),
        "material \"m\": opacity has the cutoff NaN; it must be from 0 to 1"
    );
}

#[test]
fn a_mesh_without_texture_coordinates_shows_no_picture() {
    let folder = Folder::new();
    folder.write("plain.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    let other = "[[objects]]\nname = 'sail'\nmesh = 'plain.obj'\nmaterial = 'n'\n[materials.n]\ntype = 'diffuse'\n";
    let with = |keys: &str| folder.load_with("type = 'mirror'\nreflectance = 1", &format!("{other}{keys}"));
    assert!(with("albedo = 0.5").is_ok());
    let expected = "x.toml:13:1: object \"sail\": mesh has no texture coordinates, which the pictures of the material \"n\" need; give \
                    it some (vt in an OBJ file), or choose a material without pictures";
    assert_eq!(with("albedo = { image = 'rgb.png' }").unwrap_err(), expected);
    assert_eq!(with("albedo = 0.5\nnormal = { image = 'rgb.png' }").unwrap_err(), expected);
    folder.write("plain.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n");
    assert!(with("albedo = { image = 'rgb.png' }").is_ok());
}

#[test]
fn shapes_have_the_documented_texture_coordinates() {
    let at = |mesh: &Mesh, position: Vec3, normal: Vec3| {
        let index = (0..mesh.positions.len())
            .find(|index| mesh.positions[*index].abs_diff_eq(position, 1e-6) && mesh.normals[*index].dot(normal) > 0.9);
        mesh.uvs[index.unwrap()]
    };
    let floor = Mesh::rectangle(Vec3::ZERO, 2.0 * Vec3::X, -2.0 * Vec3::Z);
    assert_eq!(at(&floor, Vec3::new(-1.0, 0.0, 1.0), Vec3::Y), Vec2::ZERO);
    assert_eq!(at(&floor, Vec3::new(1.0, 0.0, 1.0), Vec3::Y), Vec2::X);
    let cube = Mesh::cuboid(Vec3::ZERO, Vec3::ONE);
    // Seen from outside, u goes to the right and v up; on the top as seen from +z, on the bottom too.
    assert_eq!(at(&cube, Vec3::Z, Vec3::Z), Vec2::ZERO);
    assert_eq!(at(&cube, Vec3::X, Vec3::NEG_Z), Vec2::ZERO);
    assert_eq!(at(&cube, Vec3::new(1.0, 0.0, 1.0), Vec3::X), Vec2::ZERO);
    assert_eq!(at(&cube, Vec3::ZERO, Vec3::NEG_X), Vec2::ZERO);
    assert_eq!(at(&cube, Vec3::new(0.0, 1.0, 1.0), Vec3::Y), Vec2::ZERO);
    assert_eq!(at(&cube, Vec3::ZERO, Vec3::NEG_Y), Vec2::ZERO);
    let ball = Mesh::sphere(Vec3::ZERO, 1.0, 4);
    assert_eq!(at(&ball, Vec3::X, Vec3::X), Vec2::new(0.25, 0.5));
    assert_eq!(at(&ball, Vec3::NEG_Z, Vec3::NEG_Z), Vec2::new(0.5, 0.5));
    assert_eq!(at(&ball, Vec3::Z, Vec3::Z).x, 0.0);
    assert_eq!(at(&ball, Vec3::NEG_Y, Vec3::NEG_Y).y, 0.0);
}

#[test]
fn a_black_picture_gives_no_light() {
    let folder = Folder::new();
    GrayImage::from_pixel(1, 1, Luma([0])).save(folder.path("black.png")).unwrap();
    let is_dark = |keys: &str| {
        let loaded = folder.load_with(&format!("type = 'diffuse'\nalbedo = 0.5\n{keys}"), "").unwrap();
        loaded.warnings.contains(&Warning::Dark)
    };
    assert!(is_dark("") && is_dark("emission = { image = 'black.png' }"));
    assert!(is_dark("emission = { image = 'rgb.png', factor = 0 }"));
    assert!(is_dark("emission = 1\nopacity = { image = 'black.png' }"));
    assert!(!is_dark("emission = { image = 'rgb.png' }"));
}

#[test]
fn the_scene_of_the_assets_is_sound_and_shows_every_picture() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/scenes/textured.toml");
    let loaded = load_scene(&path).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(loaded.warnings, []);
    let textures = || loaded.scene.materials.iter().map(|material| &material.textures);
    assert!(textures().any(|textures| textures.color.is_some()));
    assert!(textures().any(|textures| textures.roughness.is_some()));
    assert!(textures().any(|textures| textures.metallic.is_some()));
    assert!(textures().any(|textures| textures.normal.is_some()));
    assert!(textures().any(|textures| textures.opacity.is_some()));
    assert!(textures().any(|textures| textures.emission.is_some()));
}
