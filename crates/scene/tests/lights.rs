//! Lights read from TOML, and the images of environments.

use std::{fs, fs::File, io::BufWriter, path::Path, sync::Arc};

use diacaustic_scene::{Light, LightKind, LoadedScene, load_environment, load_scene, parse_scene};
use glam::Vec3;
use image::{
    ExtendedColorType, ImageEncoder, Rgb,
    codecs::{hdr::HdrEncoder, openexr::OpenExrEncoder},
};

/// A scene without lights.
const DARK: &str = r#"[camera]
position = [0, 2, 3]
look_at = [0, 0, 0]
vertical_fov = 40
[materials]
glass = { type = "dielectric", ior = 1.5 }
floor = { type = "diffuse", albedo = 0.8 }
[[objects]]
sphere = { center = [0, 0.4, 0], radius = 0.3, subdivisions = 4 }
material = "glass"
[[objects]]
rectangle = { center = [0, 0, 0], edge_u = [4, 0, 0], edge_v = [0, 0, -4] }
material = "floor"
"#;

/// The line of the first light's table.
const LIGHT_LINE: usize = 14;

fn with_light(keys: &str) -> String {
    format!("{DARK}[[lights]]\n{keys}\n")
}

fn light(keys: &str) -> Light {
    let LoadedScene { scene, warnings } = parse_scene(&with_light(keys), Path::new("."), "x.toml").unwrap();
    assert_eq!(warnings, []);
    scene.lights[0].clone()
}

/// The message about a light, without its place; it must be within the light's table.
fn error(keys: &str) -> String {
    let message = parse_scene(&with_light(keys), Path::new("/nowhere"), "x.toml").unwrap_err().to_string();
    let (place, message) = message.split_once(": ").unwrap();
    let line: usize = place.split(':').nth(1).unwrap().parse().unwrap();
    assert!(line >= LIGHT_LINE, "{place}: {message}");
    message.to_owned()
}

#[test]
fn every_type_is_read_with_all_keys() {
    let v = Vec3::new;
    let (center, flux) = (v(1.0, 2.0, 3.0), v(4.0, 5.0, 6.0));
    let cases = [
        ("type = 'sphere'\ncenter = [1, 2, 3]\nradius = 0.5", LightKind::Sphere { center, radius: 0.5, flux }),
        (
            "type = 'rectangle'\ncenter = [1, 2, 3]\nedge_u = [1, 0, 0]\nedge_v = [0, 0, 2]",
            LightKind::Rectangle { center, edge_u: Vec3::X, edge_v: 2.0 * Vec3::Z, flux },
        ),
        (
            "type = 'disk'\ncenter = [1, 2, 3]\nnormal = [0, -2, 0]\nradius = 2",
            LightKind::Disk { center, normal: -2.0 * Vec3::Y, radius: 2.0, flux },
        ),
        ("type = 'point'\nposition = [1, 2, 3]", LightKind::Point { position: center, flux }),
        (
            "type = 'spot'\nposition = [1, 2, 3]\ndirection = [0, -2, 0]\ninner_angle = 0\nouter_angle = 180",
            LightKind::Spot { position: center, direction: -2.0 * Vec3::Y, inner_angle: 0.0, outer_angle: 180.0, flux },
        ),
        (
            "type = 'spot'\nposition = [1, 2, 3]\nlook_at = [1, 0, 3]\nouter_angle = 20",
            LightKind::Spot { position: center, direction: -2.0 * Vec3::Y, inner_angle: 16.0, outer_angle: 20.0, flux },
        ),
    ];
    for (keys, kind) in cases {
        let read = light(&format!("{keys}\nflux = [4, 5, 6]\nname = 'lamp'\nphoton_share = 7\ngroup = 'key'"));
        assert_eq!(read, Light { name: "lamp".to_owned(), kind, photon_share: 7, group: Some("key".to_owned()) });
    }
}

#[test]
fn light_from_afar_is_read() {
    let distant = |angular_radius| LightKind::Distant {
        direction: Vec3::new(1.0, -2.0, 0.0),
        angular_radius,
        irradiance: Vec3::new(3.0, 2.0, 1.0),
    };
    let keys = "direction = [1, -2, 0]\nirradiance = [3, 2, 1]";
    let parallel = light(&format!("type = 'directional'\n{keys}"));
    assert_eq!(parallel, Light { name: "light 1".to_owned(), kind: distant(0.0), photon_share: 1, group: None });
    assert_eq!(light(&format!("type = 'sun'\n{keys}")).kind, distant(0.2666));
    assert_eq!(light(&format!("type = 'sun'\n{keys}\nangular_radius = 5")).kind, distant(5.0));
}

#[test]
fn faults_are_named() {
    let sphere = "type = 'sphere'\ncenter = [0, 2, 0]\nradius = 0.1\nflux = 1";
    let spot = "type = 'spot'\nposition = [0, 2, 0]\nflux = 1";
    let cases = [
        (
            "flux = 1".to_owned(),
            r#"[[lights]] #1: the key "type" is missing; it takes the name of a light type, such as "sphere""#,
        ),
        (
            "type = 'point_light'".to_owned(),
            "[[lights]] #1: type: there is no light type \"point_light\"; known names: sphere, rectangle, disk, point, spot, \
             directional, sun, environment",
        ),
        (
            format!("{sphere}\nirradiance = 1"),
            "[[lights]] #1: unknown key \"irradiance\"; known keys: type, name, photon_share, group, center, radius, flux",
        ),
        (
            format!("{sphere}\nphoton_share = 1001"),
            r#"light "light 1": photon_share is 1001; it must be from 1 to 1000"#,
        ),
        (
            format!("{sphere}\ngroup = 'key.1'"),
            r#"light "light 1": group is "key.1"; it must be of the letters a to z and A to Z, digits, _ and -, for layers are named after it"#,
        ),
        (
            format!("{sphere}\ngroup = 'background'"),
            r#"light "light 1": group is "background", which is the name of what no light sends; it must be another"#,
        ),
        (
            format!("{sphere}\nphoton_share = 0.5"),
            "[[lights]] #1: photon_share: expected a whole number, 0 or greater, found the number 0.5",
        ),
        (
            format!("{spot}\nouter_angle = 30"),
            "[[lights]] #1: the key \"direction\" is missing; it takes a direction [x, y, z], or \"look_at\", a point \
             [x, y, z], metres",
        ),
        (
            format!("{spot}\ndirection = [0, -1, 0]\nlook_at = [0, 0, 0]\nouter_angle = 30"),
            "[[lights]] #1: look_at is set, and so is direction; leave one of them out",
        ),
        (
            format!("{spot}\nlook_at = [0, 2, 0]\nouter_angle = 30"),
            "[[lights]] #1: look_at is the light's position; it must be another point",
        ),
        (
            format!("{spot}\nlook_at = [0, 0, 0]"),
            r#"[[lights]] #1: the key "outer_angle" is missing; it takes a number of degrees off the axis"#,
        ),
        (
            format!("{spot}\nlook_at = [0, 0, 0]\nouter_angle = 30\ninner_angle = 31"),
            r#"light "light 1": inner_angle is 31; it must be from 0 to less than outer_angle, 30 (degrees)"#,
        ),
        (
            "type = 'sun'\ndirection = [0, -1, 0]".to_owned(),
            "[[lights]] #1: the key \"irradiance\" is missing; it takes W/m² for each channel: [r, g, b] or one number for \
             all three",
        ),
        (
            "type = 'directional'\ndirection = [0, -1, 0]\nirradiance = 1\nangular_radius = 1".to_owned(),
            "[[lights]] #1: unknown key \"angular_radius\"; known keys: type, name, photon_share, group, direction, irradiance",
        ),
        (
            "type = 'environment'".to_owned(),
            "[[lights]] #1: the key \"image\" is missing; it takes the path of an .hdr or .exr file, relative to the scene \
             file",
        ),
        (
            "type = 'environment'\nimage = 'sky.hdr'".to_owned(),
            "[[lights]] #1: image: /nowhere/sky.hdr: the file cannot be read: No such file or directory (os error 2)",
        ),
        (
            "type = 'environment'\nimage = 'sky.png'".to_owned(),
            "[[lights]] #1: image: /nowhere/sky.png: the image is of a kind that is not read; environment images end in \
             .hdr or .exr",
        ),
    ];
    for (keys, message) in cases {
        assert_eq!(error(&keys), message);
    }
}

/// Four columns and two rows of radiance that RGBE holds exactly.
const TEXELS: [[f32; 3]; 8] = [
    [1.0, 0.5, 0.25],
    [0.0, 0.0, 0.0],
    [2.0, 2.0, 2.0],
    [1024.0, 512.0, 8.0],
    [0.125, 0.125, 0.125],
    [1.0, 1.0, 1.0],
    [3.0, 2.0, 1.0],
    [0.5, 0.5, 0.5],
];

fn write_hdr(path: &Path, texels: &[[f32; 3]], width: usize) {
    let texels: Vec<_> = texels.iter().copied().map(Rgb).collect();
    let writer = BufWriter::new(File::create(path).unwrap());
    HdrEncoder::new(writer).encode(&texels, width, texels.len() / width).unwrap();
}

fn write_exr(path: &Path, texels: &[[f32; 3]], width: u32) {
    let bytes: Vec<u8> = texels.iter().flatten().flat_map(|channel| channel.to_ne_bytes()).collect();
    let writer = BufWriter::new(File::create(path).unwrap());
    let height = texels.len() as u32 / width;
    OpenExrEncoder::new(writer).write_image(&bytes, width, height, ExtendedColorType::Rgb32F).unwrap();
}

#[test]
fn images_are_decoded() {
    let folder = tempfile::tempdir().unwrap();
    let (hdr, exr) = (folder.path().join("sky.hdr"), folder.path().join("sky.EXR"));
    write_hdr(&hdr, &TEXELS, 4);
    write_exr(&exr, &TEXELS, 4);
    for path in [&hdr, &exr] {
        let map = load_environment(path).unwrap();
        assert_eq!((map.width, map.height), (4, 2));
        assert_eq!(map.texels, TEXELS.map(Vec3::from_array));
    }
}

#[test]
fn a_radiance_file_is_divided_by_its_exposure() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("sky.hdr");
    let write = |exposure: &str| {
        let header = format!("#?RADIANCE\nEXPOSURE={exposure}\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n");
        fs::write(&path, [header.as_bytes(), &[128, 64, 32, 129, 128, 128, 128, 129]].concat()).unwrap();
    };
    write("4");
    assert_eq!(load_environment(&path).unwrap().texels, [Vec3::new(0.25, 0.125, 0.0625), Vec3::splat(0.25)]);
    write("0");
    assert!(load_environment(&path).unwrap_err().to_string().ends_with(
        "sky.hdr: the image states an exposure times colour correction of [0, 0, 0]; it must be finite and greater than 0"
    ));
}

#[test]
fn faults_of_images_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let error = |name: &str| {
        let message = load_environment(&folder.path().join(name)).unwrap_err().to_string();
        message.replace(&format!("{}/", folder.path().display()), "")
    };
    let write = |name: &str, bytes: &[u8]| fs::write(folder.path().join(name), bytes).unwrap();
    write("text.hdr", b"no image at all");
    assert!(error("text.hdr").starts_with("text.hdr: the image cannot be decoded: "), "{}", error("text.hdr"));
    write("text.exr", b"no image at all");
    assert!(error("text.exr").starts_with("text.exr: the image cannot be decoded: "), "{}", error("text.exr"));
    write("short.hdr", b"#?RADIANCE\n\n-Y 2 +X 2\n\x80\x80\x80\x80");
    assert!(error("short.hdr").starts_with("short.hdr: the image cannot be decoded: "), "{}", error("short.hdr"));
    write("huge.hdr", b"#?RADIANCE\n\n-Y 8193 +X 16384\n");
    assert_eq!(
        error("huge.hdr"),
        "huge.hdr: the image has 16384 × 8193 texels; it must have from 2 × 1 to 16384 × 8192"
    );
    write("empty.hdr", b"#?RADIANCE\n\n-Y 0 +X 0\n");
    assert_eq!(error("empty.hdr"), "empty.hdr: the image has 0 × 0 texels; it must have from 2 × 1 to 16384 × 8192");
    let mut texels = TEXELS;
    texels[6][1] = -0.5;
    write_exr(&folder.path().join("negative.exr"), &texels, 4);
    assert_eq!(
        error("negative.exr"),
        "negative.exr: the image has the radiance [3, -0.5, 1] at column 2, row 1 (from 0); each channel must be finite and \
         0 or greater"
    );
    texels[6][1] = f32::INFINITY;
    write_exr(&folder.path().join("infinite.exr"), &texels, 4);
    assert!(error("infinite.exr").contains("has the radiance [3, inf, 1] at column 2, row 1"));
}

#[test]
fn no_image_makes_the_reader_panic() {
    let folder = tempfile::tempdir().unwrap();
    let (hdr, exr) = (folder.path().join("sky.hdr"), folder.path().join("sky.exr"));
    write_hdr(&hdr, &TEXELS, 4);
    write_exr(&exr, &TEXELS, 4);
    for path in [hdr, exr] {
        let sound = fs::read(&path).unwrap();
        for place in 0..sound.len() {
            fs::write(&path, &sound[..place]).unwrap();
            let _ = load_environment(&path);
            for flipped in [0x01, 0xff] {
                let mut broken = sound.clone();
                broken[place] ^= flipped;
                fs::write(&path, &broken).unwrap();
                let _ = load_environment(&path);
            }
        }
    }
}

#[test]
fn an_environment_is_read_beside_the_scene() {
    let folder = tempfile::tempdir().unwrap();
    write_hdr(&folder.path().join("sky.hdr"), &TEXELS, 4);
    let path = folder.path().join("x.toml");
    let load = |keys: &str| {
        fs::write(&path, with_light(&format!("type = 'environment'\nimage = 'sky.hdr'\n{keys}"))).unwrap();
        load_scene(&path)
    };
    let kind = |keys: &str| load(keys).unwrap().scene.lights[0].kind.clone();
    let map = Arc::new(load_environment(&folder.path().join("sky.hdr")).unwrap());
    let plain = LightKind::Environment { map: Arc::clone(&map), rotate: 0.0, scale: Vec3::ONE };
    assert_eq!(kind(""), plain);
    let turned = LightKind::Environment { map, rotate: -90.0, scale: Vec3::new(1.0, 2.0, 3.0) };
    assert_eq!(kind("rotate = -90\nscale = [1, 2, 3]"), turned);
    let twice = load("name = 'sky'\n[[lights]]\ntype = 'environment'\nimage = 'sky.hdr'\nname = 'clouds'").unwrap_err();
    let message = "x.toml:19:1: light \"clouds\": type is environment, as that of \"sky\" is; a scene has one at most";
    assert!(twice.to_string().ends_with(message), "{twice}");
}
