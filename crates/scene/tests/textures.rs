//! Pictures on surfaces: what scene files say of them.

mod picture_folder;

use std::{f32::consts::FRAC_PI_6, fs, path::Path, sync::Arc};

use diacaustic_scene::{
    ColorSpace, Material, MaterialKind, Mesh, NormalMap, Texture, TextureFilter, Warning, Wrap, load_scene,
    load_texture,
};
use glam::{Affine2, Vec2, Vec3};
use image::{GrayImage, Luma};
use picture_folder::Folder;

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
