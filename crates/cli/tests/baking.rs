//! `diacaustic bake`, run as the real binary, and its glTF file rendered again.

use std::{path::Path, process::Command};

use diacaustic::{
    Film,
    glam::Vec3,
    scene::{GltfOptions, Material, MaterialKind, Scene, ToneCurve, load_gltf, parse_scene},
};
use diacaustic_tests::{mean, render};

/// What a picture of the room and a bake of it have in common; the walls are kept as bright in the picture's 8 bits as they are.
const ROOM: &str = r#"
    background = 0.05
    render = { width = 64, height = 48, samples = 64, photons = 200_000, map_size = 96 }
    output = { exposure = 0, tone = "plain" }

    [materials]
    glass = { type = "dielectric", ior = 1.5 }
    plaster = { type = "diffuse", albedo = 0.8 }
    brick = { type = "diffuse", albedo = [0.7, 0.2, 0.1] }

    [[lights]]
    type = "sphere"
    center = [-0.8, 2.4, 0.6]
    radius = 0.2
    flux = 25

    [[objects]]
    name = "ball"
    sphere = { center = [0.3, 0.45, 0.1], radius = 0.35, subdivisions = 4 }
    material = "glass"

    [[objects]]
    name = "floor"
    rectangle = { center = [0, 0, 0], edge_u = [3, 0, 0], edge_v = [0, 0, -3] }
    material = "plaster"

    [[objects]]
    name = "wall"
    rectangle = { center = [1.5, 1, 0], edge_u = [0, 0, 3], edge_v = [0, 2, 0] }
    material = "brick"

    [[objects]]
    name = "block"
    box = { min = [-1.1, 0, -1.1], max = [-0.5, 0.7, -0.5] }
    material = "plaster"
"#;
const CAMERA: &str = "camera = { position = [-0.9, 2, 3.6], look_at = [0.2, 0.3, 0], vertical_fov = 40 }";

fn bake(folder: &Path, flags: &[&str]) -> (Option<i32>, String) {
    let mut command = Command::new(env!("CARGO_BIN_EXE_diacaustic"));
    let output = command.current_dir(folder).args(["bake", "room.toml"]).args(flags).output().unwrap();
    (output.status.code(), String::from_utf8(output.stderr).unwrap())
}

fn room() -> Scene {
    parse_scene(&format!("{CAMERA}\n{ROOM}"), Path::new(""), "the room").unwrap().scene
}

/// A baked scene in which surfaces shine what their lightmaps show, and nothing else does.
fn baked_scene(path: &Path, original: &Scene) -> Scene {
    let file = load_gltf(path, &GltfOptions::default()).unwrap();
    let mut scene = Scene { materials: file.materials, lights: Vec::new(), ..original.clone() };
    scene.objects.clear();
    for part in file.objects {
        scene.objects.push(diacaustic::scene::Object {
            name: part.name.clone(),
            mesh: part.mesh,
            world_from_object: part.world_from_object,
            materials: part.materials,
            map_size: None,
        });
    }
    for material in &mut scene.materials {
        if let Some(picture) = material.textures.color.take() {
            let kind = MaterialKind::Diffuse { albedo: Vec3::ZERO };
            *material = Material { emission: Vec3::ONE, ..Material::new(material.name.clone(), kind) };
            material.textures.emission = Some(picture);
        }
    }
    scene
}

/// Writes two pictures beside each other, to be looked at.
fn write_side_by_side(left: &Film, right: &Film) {
    let mut canvas = image::RgbImage::new(2 * left.width, left.height);
    for (film, first) in [(left, 0), (right, left.width)] {
        for (pixel, radiance) in film.radiance.iter().enumerate() {
            let byte = |channel: f32| (255.0 * channel.clamp(0.0, 1.0).powf(1.0 / 2.2)).round() as u8;
            let (x, y) = (pixel as u32 % film.width, pixel as u32 / film.width);
            canvas.put_pixel(first + x, y, image::Rgb(radiance.map(byte)));
        }
    }
    canvas.save(Path::new(env!("CARGO_TARGET_TMPDIR")).join("baked-room.png")).unwrap();
}

#[test]
fn a_baked_scene_looks_like_the_picture_of_the_scene() {
    let folder = tempfile::tempdir().unwrap();
    // Without a camera, for none is looked through.
    std::fs::write(folder.path().join("room.toml"), ROOM).unwrap();
    let (status, messages) = bake(folder.path(), &["--size", "96", "--samples", "48", "--quiet"]);
    assert_eq!((status, messages.as_str()), (Some(0), ""));
    let original = room();
    assert_eq!(original.output.tone, ToneCurve::Plain);
    let (picture, baked) =
        (render(&original), render(&baked_scene(&folder.path().join("room.baked/scene.glb"), &original)));
    write_side_by_side(&picture, &baked);
    // The ball, the background, and what shines so brightly that 8 bits clip it, are not compared.
    let is_ball = |pixel: usize| {
        let (x, y) = ((pixel % 64) as f64, (pixel / 64) as f64);
        (x - 36.0).hypot(y - 23.0) < 11.0
    };
    let is_background = |pixel: usize| picture.radiance[pixel].iter().all(|channel| (channel - 0.05).abs() < 1e-6);
    let compared: Vec<usize> = (0..64 * 48)
        .filter(|&pixel| {
            !is_ball(pixel)
                && !is_background(pixel)
                && picture.radiance[pixel].iter().all(|channel| (0.02..0.9).contains(channel))
        })
        .collect();
    let ratio = |pixel: &usize, k: usize| f64::from(baked.radiance[*pixel][k] / picture.radiance[*pixel][k]);
    let mut off: Vec<f64> = compared.iter().flat_map(|p| (0..3).map(move |k| (ratio(p, k) - 1.0).abs())).collect();
    off.sort_by(f64::total_cmp);
    let (median, most) = (off[off.len() / 2], off[off.len() * 9 / 10]);
    let total = mean(compared.iter().flat_map(|p| (0..3).map(move |k| ratio(p, k))));
    eprintln!("{} pixels, median {median:.4}, 90 % below {most:.4}, mean ratio {total:.4}", compared.len());
    assert!(compared.len() > 1000, "{} pixels are compared", compared.len());
    assert!(median < 0.03 && most < 0.15, "half of the pixels differ by {median}, a tenth by more than {most}");
    assert!((total - 1.0).abs() < 0.02, "on average, the baked scene is {total} times as bright");
}

#[test]
fn options_are_checked_and_obeyed() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("room.toml"), ROOM.replace("map_size = 96", "map_size = 24")).unwrap();
    for wrong in [&["--size", "1"][..], &["--size", "8", "--texels-per-metre", "9"], &["--set", "camera=3"]] {
        assert_eq!(bake(folder.path(), wrong).0, Some(2), "{wrong:?}");
    }
    let flags = ["--texels-per-metre", "10", "--samples", "1", "--photons", "1000", "--png", "--output", "maps"];
    let (status, messages) = bake(folder.path(), &flags);
    assert_eq!(status, Some(0), "{messages}");
    assert!(messages.contains("wrote 3 lightmaps and scene.glb into maps"), "{messages}");
    let size = |name: &str| image::image_dimensions(folder.path().join("maps").join(name)).unwrap();
    assert_eq!((size("floor.caustic.png"), size("wall.back.direct.png")), ((31, 31), (31, 21)));
    assert!(folder.path().join("maps/block.exr").is_file());
    assert!(!folder.path().join("maps/block.back.png").exists() && !folder.path().join("maps/ball.exr").exists());
}
