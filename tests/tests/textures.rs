//! Pictures on surfaces against known answers.

use std::sync::Arc;

use diacaustic::Film;
use diacaustic_scene::{Material, MaterialKind, Mesh, NormalMap, Scene, Texture, TextureFilter, Wrap};
use diacaustic_tests::{emit, normal_pattern, pattern, render, scene};
use glam::{Affine2, DVec3, Vec2, Vec3, Vec4};

/// A picture of red numbers, with green twice and blue three times as great, and an alpha of one half.
fn picture(width: u32, reds: &[f32]) -> Texture {
    pattern(width, reds.len() as u32 / width, |column, row| {
        let red = reds[(row * width + column) as usize];
        [red, 2.0 * red, 3.0 * red, 0.5]
    })
}

/// A normal map that tilts the normal by the same slope everywhere, along the picture's s.
fn tilt(slope: f32) -> Option<NormalMap> {
    normal_pattern(1, 1, |_, _| [slope, 0.0])
}

/// A floor of 2 m × 1 m, of which each pixel sees a square of 1/16 m, under light from straight above that gives radiance 1 at
/// albedo 1.
fn floor() -> Scene {
    let mut scene = scene(
        "camera = { position = [0, 100, 0], look_at = [0, 0, 0], up = [0, 0, -1], vertical_fov = 0.572957795 }
         render = { width = 32, height = 16, samples = 64, photons = 0, max_bounces = 0 }
         materials.floor = { type = \"diffuse\", albedo = 1 }
         lights = [{ type = \"directional\", direction = [0, -1, 0], irradiance = 3.14159265 }]
         objects = [
             { rectangle = { center = [0, 0, 0], edge_u = [2, 0, 0], edge_v = [0, 0, -1] }, material = \"floor\" },
         ]",
    );
    scene.camera.vertical_fov = 2.0 * 0.5f32.atan2(100.0).to_degrees();
    scene
}

/// The mean of the picture over the pixels of a rectangle.
fn mean(film: &Film, columns: std::ops::Range<usize>, rows: std::ops::Range<usize>) -> DVec3 {
    let pixel = |x: usize, y: usize| DVec3::from(film.radiance[y * film.width as usize + x].map(f64::from));
    let sum: DVec3 = rows.clone().flat_map(|y| columns.clone().map(move |x| pixel(x, y))).sum();
    sum / (rows.len() * columns.len()) as f64
}

/// The picture's red in the quarter of `index`, of four columns.
fn quarter(film: &Film, index: usize) -> f64 {
    mean(film, 8 * index + 2..8 * index + 6, 4..12).x
}

#[test]
fn texels_lie_where_they_should() {
    let mut scene = floor();
    let texture = Texture { filter: TextureFilter::Nearest, ..picture(2, &[0.1, 0.2, 0.3, 0.05]) };
    scene.materials[0].textures.color = Some(texture);
    let film = render(&scene);
    // Up in the picture is −z, which is edge_v: the upper row of texels is far from the viewer.
    for (columns, rows, red) in [(1..15, 1..7, 0.1), (17..31, 1..7, 0.2), (1..15, 9..15, 0.3), (17..31, 9..15, 0.05)] {
        let found = mean(&film, columns, rows);
        assert!((found - red * DVec3::new(1.0, 2.0, 3.0)).abs().max_element() < 1e-3, "{found}, texel {red}");
    }
}

#[test]
fn between_texels_the_picture_is_bilinear() {
    let mut scene = floor();
    scene.materials[0].textures.color = Some(Texture { wrap: [Wrap::Clamp; 2], ..picture(2, &[0.0, 0.25]) });
    let film = render(&scene);
    for column in 0..32 {
        let s = (column as f64 + 0.5) / 32.0;
        let expected = 0.25 * (2.0 * s - 0.5).clamp(0.0, 1.0);
        let found = mean(&film, column..column + 1, 0..16).x;
        assert!((found - expected).abs() < 2e-3, "column {column}: {found}, bilinear {expected}");
    }
}

#[test]
fn vertex_colors_multiply_the_albedo_and_its_picture() {
    let mut scene = floor();
    let mesh = std::sync::Arc::make_mut(&mut scene.objects[0].mesh);
    let share = |x: f32| 0.5 + 0.5 * x;
    mesh.colors = mesh.positions.iter().map(|p| Vec3::new(share(p.x), 1.0 - share(p.x), 0.25)).collect();
    for (texture, factor) in [(None, DVec3::ONE), (Some(picture(1, &[0.25])), DVec3::new(0.25, 0.5, 0.75))] {
        scene.materials[0].textures.color = texture;
        let film = render(&scene);
        for column in 0..32 {
            let s = (column as f64 + 0.5) / 32.0;
            let expected = factor * DVec3::new(s, 1.0 - s, 0.25);
            let found = mean(&film, column..column + 1, 0..16);
            assert!((found - expected).abs().max_element() < 2e-3, "column {column}: {found}, not {expected}");
        }
    }
}

#[test]
fn pictures_wrap_turn_and_move() {
    let two = picture(2, &[0.1, 0.3]);
    let cases = [
        (Wrap::Repeat, Affine2::from_scale(Vec2::new(2.0, 1.0)), [0.1, 0.3, 0.1, 0.3]),
        (Wrap::Mirror, Affine2::from_scale(Vec2::new(2.0, 1.0)), [0.1, 0.3, 0.3, 0.1]),
        (Wrap::Clamp, Affine2::from_scale(Vec2::new(2.0, 1.0)), [0.1, 0.3, 0.3, 0.3]),
        (Wrap::Repeat, Affine2::from_translation(Vec2::new(0.25, 0.0)), [0.1, 0.3, 0.3, 0.1]),
        (Wrap::Repeat, Affine2::from_translation(Vec2::new(-0.75, 0.0)), [0.1, 0.3, 0.3, 0.1]),
        (Wrap::Mirror, Affine2::from_translation(Vec2::new(-1.0, 0.0)), [0.3, 0.3, 0.1, 0.1]),
        (Wrap::Clamp, Affine2::from_angle(std::f32::consts::PI), [0.1, 0.1, 0.1, 0.1]),
        (Wrap::Repeat, Affine2::from_angle(std::f32::consts::PI), [0.3, 0.3, 0.1, 0.1]),
    ];
    for (wrap, picture_from_uv, expected) in cases {
        let mut scene = floor();
        let filter = TextureFilter::Nearest;
        let texture = Texture { wrap: [wrap; 2], filter, picture_from_uv, ..two.clone() };
        scene.materials[0].textures.color = Some(texture);
        let film = render(&scene);
        for (index, red) in expected.into_iter().enumerate() {
            let found = quarter(&film, index);
            assert!((found - red).abs() < 1e-3, "{wrap:?}, {picture_from_uv:?}, quarter {index}: {found}, not {red}");
        }
    }
}

#[test]
fn coats_and_metals_follow_their_pictures() {
    // A picture of one number is that number.
    let kinds = [
        ("{ type = \"coated\", albedo = 1, roughness = 0.5 }", "{ type = \"coated\", albedo = 0.4, roughness = 0.25 }"),
        (
            "{ type = \"metallic_roughness\", base_color = 1, metallic = 1, roughness = 1 }",
            "{ type = \"metallic_roughness\", base_color = 0.4, metallic = 0.5, roughness = 0.5 }",
        ),
        ("{ type = \"mirror\", reflectance = 1 }", "{ type = \"mirror\", reflectance = 0.4 }"),
    ];
    for (before, after) in kinds {
        let render_floor = |material: &str, textured: bool| {
            let mut scene = scene(&format!(
                "background = 0.3
                 camera = {{ position = [0, 2, 2], look_at = [0, 0, 0], vertical_fov = 20 }}
                 render = {{ width = 16, height = 16, samples = 256, photons = 0, max_bounces = 0 }}
                 materials.floor = {material}
                 lights = [{{ type = \"sphere\", center = [0, 2, -2], radius = 0.8, flux = 60 }}]
                 objects = [
                     {{ rectangle = {{ center = [0, 0, 0], edge_u = [8, 0, 0], edge_v = [0, 0, -8] }}, material = \"floor\" }},
                 ]"
            ));
            if textured {
                let half = || pattern(1, 1, |_, _| [0.4, 0.5, 0.5, 1.0]);
                let Material { kind, textures, .. } = &mut scene.materials[0];
                textures.color = Some(pattern(1, 1, |_, _| [0.4; 4]));
                if !matches!(kind, MaterialKind::Mirror { .. }) {
                    textures.roughness = Some(Texture { channel: 1, ..half() });
                }
                if matches!(kind, MaterialKind::MetallicRoughness { .. }) {
                    textures.metallic = Some(Texture { channel: 2, ..half() });
                }
            }
            mean(&render(&scene), 0..16, 0..16)
        };
        let (textured, plain) = (render_floor(before, true), render_floor(after, false));
        assert!((textured / plain - 1.0).abs().max_element() < 2e-3, "{before}: {textured}, as numbers {plain}");
    }
}

#[test]
fn a_normal_map_tilts_the_surface_to_direct_light() {
    for slope in [0.5, -0.5] {
        let mut scene = floor();
        scene.materials[0].textures.normal = tilt(slope);
        // Light that comes down toward −x: a surface that leans to +x faces it.
        scene.lights[0].kind = diacaustic_scene::LightKind::Distant {
            direction: Vec3::new(-0.6, -0.8, 0.0),
            angular_radius: 0.0,
            irradiance: Vec3::splat(std::f32::consts::PI),
        };
        let found = mean(&render(&scene), 0..32, 0..16).x;
        let expected = f64::from((0.8 + 0.6 * slope) / (slope * slope + 1.0).sqrt());
        assert!((found - expected).abs() < 2e-3, "slope {slope}: {found}, known {expected}");
    }
}

#[test]
fn a_normal_map_tilts_the_surface_to_caustics() {
    // Parallel light through a pane arrives as photons: the map must hold the irradiance on the tilted surface.
    for slope in [0.0, 0.5, -0.5] {
        let mut scene = scene(
            "camera = { position = [0, 3, 3], look_at = [0, 0, 0], vertical_fov = 30 }
             render = { map_size = 3 }
             materials.floor = { type = \"diffuse\", albedo = 0.5 }
             materials.pane = { type = \"thin_walled\", ior = 1.0 }
             lights = [{ type = \"directional\", direction = [-0.6, -0.8, 0], irradiance = 1 }]
             objects = [
                 { rectangle = { center = [0, 1, 0], edge_u = [8, 0, 0], edge_v = [0, 0, -8] }, material = \"pane\" },
                 { rectangle = { center = [0, 0, 0], edge_u = [1, 0, 0], edge_v = [0, 0, -1] }, material = \"floor\" },
             ]",
        );
        let floor = scene.objects[1].materials[0];
        scene.materials[floor].textures.normal = tilt(slope);
        let map = emit(&scene, 1 << 18).energy_map(1).unwrap().unwrap();
        let flux: f64 = (0..map.sums.len()).map(|texel| map.flux(texel).y).sum();
        let expected = f64::from((0.8 + 0.6 * slope) / (slope * slope + 1.0).sqrt());
        assert!((flux / expected - 1.0).abs() < 0.01, "slope {slope}: {flux} W on 1 m², known {expected}");
    }
}

/// The floor in two halves, along x and mirrored against it, of which the left is up to the middle of `uvs`.
fn two_halves(uvs: [[f32; 2]; 8], tangents: Vec<Vec4>) -> Scene {
    let mut scene = floor();
    let corner = |x: f32, z: f32| Vec3::new(x, 0.0, z);
    let half = |x: f32| [corner(x, 0.5), corner(x + 1.0, 0.5), corner(x + 1.0, -0.5), corner(x, -0.5)];
    scene.objects[0].mesh = Arc::new(Mesh {
        positions: [half(-1.0), half(0.0)].concat(),
        normals: vec![Vec3::Y; 8],
        uvs: uvs.map(Vec2::from).to_vec(),
        triangles: vec![[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7]],
        tangents,
        ..Mesh::default()
    });
    scene.lights[0].kind = diacaustic_scene::LightKind::Distant {
        direction: Vec3::new(-0.6, -0.8, 0.0),
        angular_radius: 0.0,
        irradiance: Vec3::splat(std::f32::consts::PI),
    };
    scene
}

/// What a surface of unit normal `n` shows of the light of [`two_halves`].
fn lit(n: Vec3) -> f64 {
    f64::from(n.dot(Vec3::new(0.6, 0.8, 0.0)))
}

#[test]
fn bumps_look_alike_where_the_picture_is_mirrored() {
    let (upright, mirrored) =
        ([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]], [[1.0, 0.0], [0.0, 0.0], [0.0, 1.0], [1.0, 1.0]]);
    let uvs = [upright, mirrored].concat().try_into().expect("eight");
    let stated = [vec![Vec4::new(1.0, 0.0, 0.0, 1.0); 4], vec![Vec4::new(-1.0, 0.0, 0.0, -1.0); 4]].concat();
    for tangents in [Vec::new(), stated] {
        let mut scene = two_halves(uvs, tangents);
        // A ridge along the picture's middle: up on its left, down on its right, and steeper on its upper half.
        let slope = |column: u32, row: u32| [if column == 0 { -0.5 } else { 0.5 }, if row == 0 { 0.5 } else { 0.0 }];
        let mut map = normal_pattern(2, 2, slope).expect("a map");
        map.texture.filter = TextureFilter::Nearest;
        scene.materials[0].textures.normal = Some(map);
        let film = render(&scene);
        for (rows, across) in [(1..7, 0.5f32), (9..15, 0.0)] {
            for (quarter, slope) in [-0.5f32, 0.5, -0.5, 0.5].into_iter().enumerate() {
                // The mirrored ridge is a ridge: the picture's right half lies left there, and its slopes with it. Its up is −z.
                let expected = lit(Vec3::new(slope, 1.0, -across).normalize());
                let found = mean(&film, 8 * quarter + 2..8 * quarter + 6, rows.clone()).x;
                assert!((found - expected).abs() < 3e-3, "quarter {quarter}, {across}: {found}, known {expected}");
            }
        }
    }
}

#[test]
fn tangents_are_interpolated_between_the_corners() {
    let uvs = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    let (along, away) = (Vec4::new(1.0, 0.0, 0.0, 1.0), Vec4::new(0.0, 0.0, -1.0, 1.0));
    let tangents = [along, away, away, along].repeat(2);
    let mut scene = two_halves([uvs, uvs].concat().try_into().expect("eight"), tangents);
    scene.materials[0].textures.normal = tilt(0.5);
    let film = render(&scene);
    for column in 0..32 {
        let s = ((column % 16) as f32 + 0.5) / 16.0;
        let tangent = ((1.0 - s) * along.truncate() + s * away.truncate()).normalize();
        let expected = lit((0.5 * tangent + Vec3::Y).normalize());
        let found = mean(&film, column..column + 1, 0..16).x;
        assert!((found - expected).abs() < 3e-3, "column {column}: {found}, known {expected}");
    }
}

#[test]
fn opacity_at_vertices_thins_the_surface() {
    // From 1 on the left to 0 on the right, seen against a background of 1; with a cutoff half of it is there.
    for cutoff in [None, Some(0.5)] {
        let mut scene = floor();
        scene.background = Vec3::ONE;
        scene.lights.clear();
        scene.materials[0].kind = MaterialKind::Diffuse { albedo: Vec3::ZERO };
        scene.materials[0].opacity_cutoff = cutoff;
        let mesh = Arc::make_mut(&mut scene.objects[0].mesh);
        mesh.opacities = mesh.positions.iter().map(|position| 0.5 - 0.5 * position.x).collect();
        scene.settings.samples = Some(1024);
        let film = render(&scene);
        for column in 0..32 {
            let s = (column as f64 + 0.5) / 32.0;
            let found = mean(&film, column..column + 1, 0..16).x;
            let expected = if cutoff.is_some() { f64::from(u8::from(s > 0.5)) } else { s };
            let is_edge = cutoff.is_some() && (15..17).contains(&column);
            assert!(
                is_edge || (found - expected).abs() < 0.02,
                "{cutoff:?}, column {column}: {found}, known {expected}"
            );
        }
    }
}

/// The floor seen past a sheet between camera and light, whose holes `edit` makes.
fn behind_a_sheet(edit: impl Fn(&mut Material)) -> Film {
    let mut scene = scene(
        "camera = { position = [0, 3, 4], look_at = [0, 0, 0], vertical_fov = 4 }
         render = { width = 16, height = 16, samples = 1024, photons = 0, max_bounces = 0 }
         materials.floor = { type = \"diffuse\", albedo = 1 }
         materials.sheet = { type = \"diffuse\", albedo = 0 }
         lights = [{ type = \"directional\", direction = [0, -1, 0], irradiance = 3.14159265 }]
         objects = [
             { rectangle = { center = [0, 1, 0], edge_u = [4, 0, 0], edge_v = [0, 0, -1] }, material = \"sheet\" },
             { rectangle = { center = [0, 0, 0], edge_u = [4, 0, 0], edge_v = [0, 0, -4] }, material = \"floor\" },
         ]",
    );
    let sheet = scene.objects[0].materials[0];
    edit(&mut scene.materials[sheet]);
    render(&scene)
}

#[test]
fn light_passes_what_is_not_opaque() {
    // The camera looks under the sheet, the light comes through it.
    for opacity in [0.25, 1.0, 0.0] {
        let found = mean(&behind_a_sheet(|sheet| sheet.opacity = opacity), 0..16, 0..16).x;
        assert!((found - f64::from(1.0 - opacity)).abs() < 5e-3, "opacity {opacity}: {found}");
    }
    let quarters = picture(2, &[1.0, 0.5]);
    let texture = Texture { filter: TextureFilter::Nearest, ..quarters };
    for (cutoff, left, right) in [(None, 0.0, 0.5), (Some(0.75), 0.0, 1.0), (Some(0.25), 0.0, 0.0)] {
        let film = behind_a_sheet(|sheet| {
            sheet.textures.opacity = Some(texture.clone());
            sheet.opacity_cutoff = cutoff;
        });
        let found = [mean(&film, 0..7, 0..16).x, mean(&film, 9..16, 0..16).x];
        assert!((found[0] - left).abs() < 5e-3 && (found[1] - right).abs() < 8e-3, "cutoff {cutoff:?}: {found:?}");
    }
}

#[test]
fn a_surface_with_a_picture_shines_as_its_mean() {
    // A panel of 0.2 m far above: E = L A/d². One half of the picture is dark, and one half of the light passes.
    let mut scene = scene(
        "camera = { position = [0, 0.02, 0], look_at = [0, 0, 0], up = [0, 0, 1], vertical_fov = 60 }
         render = { width = 8, height = 8, samples = 1024, photons = 0, max_bounces = 0 }
         materials.floor = { type = \"diffuse\", albedo = 1 }
         materials.panel = { type = \"diffuse\", albedo = 0, emission = 1000 }
         objects = [
             { rectangle = { center = [0, 10, 0], edge_u = [0.2, 0, 0], edge_v = [0, 0, 0.2] }, material = \"panel\" },
             { rectangle = { center = [0, 0, 0], edge_u = [4, 0, 0], edge_v = [0, 0, -4] }, material = \"floor\" },
         ]",
    );
    let panel = scene.objects[0].materials[0];
    scene.materials[panel].textures.emission = Some(picture(2, &[0.0, 0.3]));
    scene.materials[panel].textures.opacity = Some(Texture { channel: 3, ..picture(1, &[0.0]) });
    let found = mean(&render(&scene), 0..8, 0..8);
    let irradiance = 0.5 * 0.15 * 1000.0 * 0.04 / 100.0;
    let expected = irradiance / std::f64::consts::PI * DVec3::new(1.0, 2.0, 3.0);
    assert!((found / expected - 1.0).abs().max_element() < 5e-3, "{found}, known {expected}");
    assert_eq!(scene.materials[panel].opacity_at(Vec2::ZERO, 1.0), 0.5);
}
