//! Pictures on surfaces: what they show, normal maps, and textured gloss and emission.

mod shapes;

use std::f64::consts::{FRAC_1_PI, FRAC_PI_2};
use std::sync::Arc;

use diacaustic_reference::camera::{Estimate, irradiance_at, radiance};
use diacaustic_reference::fresnel::reflectance;
use diacaustic_reference::geometry::{Sphere, World};
use diacaustic_reference::light_tracing::{Region, irradiance_on};
use diacaustic_reference::photons::{AimDisc, Emission, Ledger, PhotonJob, trace};
use diacaustic_reference::texture::texture_at;
use diacaustic_scene::{
    LightKind, MaterialKind, Mesh, NormalMap, PLASTIC_REFLECTANCE, Scene, Texture, TextureFilter, Wrap,
};
use glam::{Affine2, Affine3A, DVec2, DVec3, Vec2, Vec3};

use shapes::{ball, diffuse, flat, glass, light, named, pane, parallel, picture, plate, scene, speckle};

/// Has the camera look straight down from 3 m on the square of 2 m about the origin, −z up: it fills the picture.
fn seen_from_above(scene: Scene) -> Scene {
    let mut scene = scene;
    scene.camera.position = 3.0 * Vec3::Y;
    scene.camera.up = -Vec3::Z;
    scene.camera.vertical_fov = 2.0 * (1f32 / 3.0).atan().to_degrees();
    scene
}

/// Such a square of albedo 0.8 times a picture, under parallel light.
fn textured_square(color: Texture) -> Scene {
    let parts = vec![(plate(0.0, 2.0), diffuse(0.8), Vec3::ZERO)];
    let mut scene = seen_from_above(scene(parts, vec![parallel(-Vec3::Y)]));
    scene.materials[0].textures.color = Some(color);
    scene
}

/// What the square's pixels show is the texel that `texel` gives for each.
fn assert_shows(scene: &Scene, texel: impl Fn(u32, u32) -> f32, name: &str) {
    let world = World::new(scene);
    for (x, y) in (0..32).flat_map(|x| (0..32).map(move |y| (x, y))) {
        let expected = f64::from(0.8f32 * texel(x, y)) * 3.0 * FRAC_1_PI;
        let seen = radiance(&world, x, y, 8, 0, 1).mean.x;
        assert!((seen - expected).abs() < 1e-6, "{name}, pixel ({x}, {y}): {seen} for {expected}");
    }
}

#[test]
fn pixels_show_texels() {
    let speckled = picture(32, 32, |column, row| [speckle(column, row); 4]);
    let mut scene = textured_square(Texture { filter: TextureFilter::Nearest, ..speckled });
    assert_shows(&scene, speckle, "upright");
    scene.objects[0].world_from_object = Affine3A::from_scale(Vec3::new(-1.0, 1.0, 1.0));
    assert_shows(&scene, |x, y| speckle(31 - x, y), "mirrored");
}

#[test]
fn pictures_go_on_beyond_their_edges() {
    let small = picture(16, 16, |column, row| [speckle(column, row); 4]);
    // The picture is the lower left quarter of the square; rows are counted from 16 above it.
    let picture_from_uv = Affine2::from_scale(Vec2::splat(2.0));
    let texture = |wrap| Texture { filter: TextureFilter::Nearest, picture_from_uv, wrap, ..small.clone() };
    let column = |wrap, x: u32| match wrap {
        Wrap::Repeat => x % 16,
        Wrap::Clamp => x.min(15),
        Wrap::Mirror => x.min(31 - x),
    };
    let row = |wrap, y: u32| match wrap {
        Wrap::Repeat => y % 16,
        Wrap::Clamp => y.saturating_sub(16),
        Wrap::Mirror => y.max(31 - y) - 16,
    };
    let modes = [Wrap::Repeat, Wrap::Clamp, Wrap::Mirror];
    for [u, v] in modes.into_iter().flat_map(|u| modes.map(|v| [u, v])) {
        let texel = |x, y| speckle(column(u, x), row(v, y));
        assert_shows(&textured_square(texture([u, v])), texel, &format!("{u:?} × {v:?}"));
    }
}

#[test]
fn linear_filter_is_a_ramp_between_texels() {
    let black_to_white = picture(2, 1, |column, _| [column as f32; 4]);
    let scene = textured_square(Texture { wrap: [Wrap::Clamp; 2], ..black_to_white });
    let world = World::new(&scene);
    for x in 0..32 {
        let seen = radiance(&world, x, 9, 4000, 0, 1);
        let share = ((f64::from(x) + 0.5) / 16.0 - 0.5).clamp(0.0, 1.0);
        let expected = f64::from(0.8f32) * share * 3.0 * FRAC_1_PI;
        let tolerance = 4.5 * seen.variance.x.sqrt() + 1e-6;
        assert!((seen.mean.x - expected).abs() < tolerance, "column {x}: {} for {expected}", seen.mean.x);
    }
}

#[test]
fn a_texel_is_worth_the_material_that_it_makes() {
    let texel = [0.5, 0.25, 0.75, 1.0];
    let kinds = |color: Vec3, roughness: f32, metallic: f32| {
        [
            MaterialKind::Phong { ambient: color, diffuse: color, specular: Vec3::splat(0.1), shininess: 8.0 },
            MaterialKind::Coated { albedo: color, ior: 1.5, roughness },
            MaterialKind::MetallicRoughness {
                base_color: color,
                reflectance: PLASTIC_REFLECTANCE,
                metallic,
                roughness,
            },
            MaterialKind::ThinWalled { ior: 1.5, tint: color, roughness: 0.0 },
        ]
    };
    let seen = |kind: MaterialKind, is_textured: bool| {
        let parts = vec![(plate(0.0, 2.0), kind, Vec3::ZERO), (plate(-1.0, 4.0), diffuse(0.5), Vec3::ZERO)];
        let lamp = light(Vec3::new(2.0, 2.0, 0.0), 0.5, 20.0);
        let mut scene = seen_from_above(scene(parts, vec![lamp]));
        scene.ambient = Vec3::ONE;
        if is_textured {
            let whole = || Some(picture(1, 1, |_, _| texel));
            let channel = |channel| Some(Texture { channel, ..whole().expect("a picture") });
            let textures = &mut scene.materials[0].textures;
            (textures.color, textures.roughness, textures.metallic) = (whole(), channel(1), channel(2));
        }
        radiance(&World::new(&scene), 15, 17, 2000, 1, 1).mean
    };
    let plain = kinds(Vec3::new(0.8 * 0.5, 0.8 * 0.25, 0.8 * 0.75), 0.8 * 0.25, 0.75 * 0.75);
    for (textured, plain) in kinds(Vec3::splat(0.8), 0.8, 0.75).into_iter().zip(plain) {
        let (found, expected) = (seen(textured.clone(), true), seen(plain, false));
        assert!((found - expected).abs().max_element() < 1e-6 * expected.x, "{textured:?}: {found} for {expected}");
        assert!((seen(textured, false) - expected).abs().max_element() > 0.05 * expected.x);
    }
}

/// A normal map of one normal everywhere, and that normal as half precision holds it, in the map's frame.
fn leaning(normal: Vec3, strength: f32) -> (NormalMap, DVec3) {
    let [x, y, z] = (0.5 * normal.normalize() + 0.5).to_array();
    let texture = picture(1, 1, |_, _| [x, y, z, 1.0]);
    let held = 2.0 * texture_at(&texture, DVec2::ZERO).truncate() - 1.0;
    let stretch = f64::from(strength);
    (NormalMap { texture, strength }, (held * DVec3::new(stretch, stretch, 1.0)).normalize())
}

/// From the frame of a plate's picture to the world.
fn in_the_world(normal: DVec3) -> DVec3 {
    normal.x * DVec3::X - normal.y * DVec3::Z + normal.z * DVec3::Y
}

#[test]
fn direct_light_falls_on_the_mapped_normal() {
    let d = Vec3::new(0.3, -1.0, 0.2);
    let seen = |scene: &Scene| radiance(&World::new(scene), 20, 11, 4, 0, 1).mean.x;
    let expected = |normal: DVec3| 0.5 * FRAC_1_PI * 3.0 * -d.as_dvec3().normalize().dot(normal);
    for (lean, strength) in [(Vec3::new(0.5, 0.0, 0.9), 1.0), (Vec3::new(0.0, 0.6, 0.8), 1.0), (Vec3::ONE, 0.5)] {
        let (map, n) = leaning(lean, strength);
        let parts = vec![(plate(0.0, 2.0), diffuse(0.5), Vec3::ZERO)];
        let mut scene = seen_from_above(scene(parts, vec![parallel(d)]));
        let flat = seen(&scene);
        scene.materials[0].textures.normal = Some(map);
        let upright = seen(&scene);
        assert!((upright - expected(in_the_world(n))).abs() < 1e-9, "{lean}: {upright}");
        assert!((upright - flat).abs() > 0.01 * flat);
        // Red is along the picture's u, however it lies.
        scene.objects[0].world_from_object = Affine3A::from_scale(Vec3::new(-1.0, 1.0, 1.0));
        let mirrored = seen(&scene);
        assert!((mirrored - expected(in_the_world(n) * DVec3::new(-1.0, 1.0, 1.0))).abs() < 1e-9, "{mirrored}");
        // From below: the plate turned over about x. Its back shows the normal of the front, reversed.
        scene.objects[0].world_from_object = Affine3A::from_rotation_x(std::f32::consts::PI);
        let back = -(in_the_world(n) * DVec3::new(1.0, -1.0, -1.0));
        let from_behind = seen(&scene);
        assert!((from_behind - expected(back)).abs() < 1e-6, "{from_behind}");
    }
}

/// Photons of a light over the balls around casters, which must account for all.
fn ledger_of(scene: &Scene, casters: &[Sphere], count: u32) -> Ledger {
    let world = World::new(scene);
    let maps = vec![None; scene.objects.len()];
    let emission = Emission::Toward(casters);
    let job = PhotonJob { world: &world, maps: &maps, light: 0, emission, guide: None, seed: 1, photons: 0..count };
    let ledger = trace(&job).ledger;
    let error = (ledger.accounted() - ledger.emitted).abs() / ledger.emitted;
    assert!(error.max_element() < 1e-12, "the ledger misses {error} of what was emitted");
    ledger
}

#[test]
fn light_by_way_of_casters_falls_on_the_mapped_normal() {
    let d = Vec3::new(0.3, -1.0, 0.2);
    let (map, n) = leaning(Vec3::new(0.5, 0.2, 0.9), 1.0);
    let floor = || (plate(0.0, 8.0), diffuse(0.5), Vec3::ZERO);
    let wall = Mesh::rectangle(Vec3::new(1.0, 1.0, 0.0), 2.0 * Vec3::Z, 2.0 * Vec3::Y);
    let mirror = MaterialKind::Mirror { reflectance: Vec3::splat(0.7) };
    let f = reflectance(-d.as_dvec3().normalize().y, 1.0 / 1.5);
    let above = Sphere { center: DVec3::Y, radius: 1.5 };
    for (caster, kept, landing) in [
        ((plate(1.0, 8.0), pane(), Vec3::ZERO), (1.0 - f) / (1.0 + f), d),
        ((wall, mirror, Vec3::ZERO), f64::from(0.7f32), d * Vec3::new(-1.0, 1.0, 1.0)),
    ] {
        let mut scene = scene(vec![floor(), caster], vec![parallel(d)]);
        scene.materials[0].textures.normal = Some(map.clone());
        let landing = landing.as_dvec3().normalize();
        let (flat, tilted) = (-landing.y, -landing.dot(in_the_world(n)));
        let ledger = ledger_of(&scene, &[above], 1 << 14);
        let factor = ledger.deposited / (ledger.deposited + ledger.shading_normals);
        assert!(factor.abs_diff_eq(DVec3::splat(tilted / flat), 1e-12), "{factor} for {tilted} over {flat}");
        let (edge_u, edge_v) = (0.5 * DVec3::X, -0.5 * DVec3::Z);
        let region = Region { center: 0.7 * DVec3::X, edge_u, edge_v, columns: 1, rows: 1 };
        let traced = irradiance_on(&World::new(&scene), &region, Some(&above), 2_000_000, 1).via_casters[0];
        assert_agrees(&traced, 3.0 * kept * tilted, 0.0, "traced from the light");
    }
}

#[test]
fn photons_from_below_the_mapped_normal_bring_nothing_and_grazing_ones_at_most_four_times_their_flux() {
    let (map, n) = leaning(Vec3::new(0.8, 0.0, 0.6), 1.0);
    for (d, least) in [(Vec3::new(1.0, -0.5, 0.0), 0.0), (Vec3::new(-1.0, -0.1, 0.0), 4.0)] {
        let parts = vec![(plate(0.0, 8.0), diffuse(0.5), Vec3::ZERO), (plate(0.2, 8.0), pane(), Vec3::ZERO)];
        let mut scene = scene(parts, vec![parallel(d)]);
        scene.materials[0].textures.normal = Some(map.clone());
        let d = d.as_dvec3().normalize();
        let whole = (d.dot(in_the_world(n)) / d.y).max(0.0);
        assert!(whole >= 2.0 * least, "{whole}");
        let above = Sphere { center: 0.2 * DVec3::Y, radius: 0.1 };
        let ledger = ledger_of(&scene, &[above], 1 << 12);
        let factor = ledger.deposited / (ledger.deposited + ledger.shading_normals);
        assert!(factor.abs_diff_eq(DVec3::splat(least), 1e-12), "{factor}");
    }
}

fn assert_agrees(estimate: &Estimate, expected: f64, systematic: f64, name: &str) {
    let Estimate { mean, variance } = estimate;
    let tolerance = 4.5 * variance.x.sqrt() + systematic * expected;
    assert!((mean.x - expected).abs() < tolerance, "{name}: {} for {expected} ± {tolerance}", mean.x);
    assert!(tolerance < 0.04 * expected, "{name}: ± {tolerance} of {expected} is too loose");
}

/// The mean irradiance of light by way of casters on the square of 0.6 m about the origin, whose shading normal is n
/// everywhere: from the lights, as paths find it from a grid of points, and by photons.
fn three_ways(scene: &Scene, n: DVec3, caster: Sphere, samples: u32) -> [Estimate; 3] {
    let world = World::new(scene);
    let (edge_u, edge_v) = (0.6 * DVec3::X, -0.6 * DVec3::Z);
    let region = Region { center: DVec3::ZERO, edge_u, edge_v, columns: 8, rows: 8 };
    let traced = irradiance_on(&world, &Region { columns: 1, rows: 1, ..region }, Some(&caster), 2_000_000, 3);
    let mut found = Estimate { mean: DVec3::ZERO, variance: DVec3::ZERO };
    for bin in 0..64 {
        let one = irradiance_at(&world, region.bin_center(bin), n, samples, 2).via_casters;
        found.mean += one.mean / 64.0;
        found.variance += one.variance / (64.0 * 64.0);
    }
    let lamp = world.light_sphere(0).expect("a sphere");
    let discs = [AimDisc::around(&lamp, &caster).expect("the caster is far from the light")];
    let photons = 1 << 18;
    let maps = vec![None; scene.objects.len()];
    let emission = Emission::Aimed(&discs);
    let job = PhotonJob { world: &world, maps: &maps, light: 0, emission, guide: None, seed: 1, photons: 0..photons };
    let deposited = trace(&job).ledger.deposited / (f64::from(photons) * 0.36);
    [traced.via_casters[0], found, Estimate { mean: deposited, variance: DVec3::ZERO }]
}

fn assert_three_ways(scene: &Scene, n: DVec3, caster: Sphere, samples: u32, name: &str) {
    let [traced, found, deposited] = three_ways(scene, n, caster, samples);
    let photons = deposited.mean.x;
    assert_agrees(&traced, photons, 0.003, &format!("{name}, from the light"));
    assert_agrees(&found, photons, 0.003, &format!("{name}, from the eye"));
}

/// A floor of 0.6 m under a glass ball, lit by a sphere.
fn under_a_ball() -> Scene {
    let lens = flat(ball(0.4, 3));
    let parts = vec![(plate(0.0, 0.6), diffuse(0.5), Vec3::ZERO), (lens, glass(1.4), 0.6 * Vec3::Y)];
    scene(parts, vec![light(Vec3::new(0.3, 2.2, 0.2), 0.4, 10.0)])
}

const AROUND_THE_BALL: Sphere = Sphere { center: DVec3::new(0.0, 0.6, 0.0), radius: 0.4 };

#[test]
fn photons_paths_and_light_tracing_agree_on_shading_normals() {
    // The first sees all light from above; the second does not.
    for lean in [Vec3::new(0.5, 0.1, 0.86), Vec3::new(0.85, 0.1, 0.5)] {
        let mut by_map = under_a_ball();
        let (map, n) = leaning(lean, 1.0);
        by_map.materials[0].textures.normal = Some(map);
        assert_three_ways(&by_map, in_the_world(n), AROUND_THE_BALL, 8000, &format!("normal map, {lean}"));
    }

    let mut interpolated = under_a_ball();
    let n = Vec3::new(-0.2, 1.0, 0.3).normalize();
    let floor = Mesh { normals: vec![n; 4], ..plate(0.0, 0.6) };
    interpolated.objects[0].mesh = Arc::new(floor);
    assert_three_ways(&interpolated, n.as_dvec3(), AROUND_THE_BALL, 4000, "interpolated");
    let [_, unlike, photons] = three_ways(&interpolated, DVec3::Y, AROUND_THE_BALL, 4000);
    assert!(unlike.deviations(photons.mean).abs().max_element() > 6.0, "the comparison cannot fail");
}

#[test]
fn pixel_shows_the_irradiance_of_the_mapped_normal() {
    let (map, n) = leaning(Vec3::new(0.4, 0.1, 0.95), 1.0);
    let parts = vec![(plate(0.0, 2.0), diffuse(0.6), Vec3::ZERO), (plate(1.0, 9.0), pane(), Vec3::ZERO)];
    let lamps = vec![light(Vec3::new(0.5, 3.0, 0.0), 0.8, 12.0), light(Vec3::new(0.4, 0.8, 0.2), 0.1, 1.0)];
    let mut scene = scene(parts, lamps);
    scene.materials[0].textures.normal = Some(map);
    // From below the pane.
    scene.camera.position = Vec3::new(0.0, 0.8, 1.5);
    scene.camera.vertical_fov = 0.1;
    let world = World::new(&scene);
    let irradiance = irradiance_at(&world, DVec3::ZERO, in_the_world(n), 400_000, 3);
    let seen = radiance(&world, 16, 16, 400_000, 0, 5);
    let expected = f64::from(0.6f32) * FRAC_1_PI * (irradiance.direct.mean.x + irradiance.via_casters.mean.x);
    assert_agrees(&seen, expected, 0.005, "pixel");
}

#[test]
fn textured_rough_metal_shines_on_the_floor_alike() {
    let parts = |kind| {
        let wall = Mesh::rectangle(Vec3::new(0.5, 0.4, 0.0), 0.8 * Vec3::Z, 0.8 * Vec3::Y);
        vec![(plate(0.0, 0.6), diffuse(0.5), Vec3::ZERO), (wall, kind, Vec3::ZERO)]
    };
    let metal = MaterialKind::MetallicRoughness {
        base_color: Vec3::ONE,
        reflectance: PLASTIC_REFLECTANCE,
        metallic: 1.0,
        roughness: 0.7,
    };
    let mut scene = scene(parts(metal), vec![light(Vec3::new(-0.8, 1.2, 0.2), 0.5, 10.0)]);
    let around = Sphere { center: DVec3::new(0.5, 0.4, 0.0), radius: 0.4 * 2f64.sqrt() };
    let plain = three_ways(&scene, DVec3::Y, around, 20)[2].mean.x;
    let textures = &mut scene.materials[1].textures;
    textures.color = Some(picture(2, 2, |column, row| [0.1 + 0.5 * (column ^ row) as f32; 4]));
    textures.roughness = Some(picture(1, 4, |_, row| [0.5 + 0.125 * row as f32; 4]));
    assert_three_ways(&scene, DVec3::Y, around, 20_000, "metal");
    let textured = three_ways(&scene, DVec3::Y, around, 20)[2].mean.x;
    assert!((textured / plain - 1.0).abs() > 0.1, "{textured} with and {plain} without pictures");
}

#[test]
fn ledger_closes_with_pictures_everywhere() {
    let varnish = MaterialKind::MetallicRoughness {
        base_color: Vec3::ONE,
        reflectance: PLASTIC_REFLECTANCE,
        metallic: 1.0,
        roughness: 0.5,
    };
    let lens = Mesh::sphere(Vec3::new(0.0, 0.6, 0.0), 0.4, 4);
    let screen = Mesh::sphere(Vec3::new(0.2, 0.6, 0.6), 0.3, 4);
    let parts = vec![
        (plate(0.0, 3.0), diffuse(0.5), Vec3::ZERO),
        (lens, MaterialKind::ThinWalled { ior: 1.5, tint: Vec3::ONE, roughness: 0.0 }, Vec3::ZERO),
        (screen, varnish, Vec3::ZERO),
    ];
    let position = Vec3::new(0.3, 2.2, 0.2);
    let mut scene = scene(parts, vec![named(LightKind::Point { position, flux: Vec3::splat(10.0) })]);
    scene.settings.max_depth = 3;
    let speckled = || Some(picture(8, 8, |i, j| [speckle(i, j), speckle(i + 9, j), speckle(i, j + 9), 1.0]));
    let bumps = picture(8, 8, |i, j| [speckle(i, j), speckle(j, i + 3), 1.0, 1.0]);
    for material in &mut scene.materials {
        let textures = &mut material.textures;
        textures.color = speckled();
        textures.normal = Some(NormalMap { texture: bumps.clone(), strength: 0.8 });
    }
    let textures = &mut scene.materials[2].textures;
    (textures.roughness, textures.metallic, textures.opacity) = (speckled(), speckled(), speckled());
    let around = Sphere { center: DVec3::new(0.1, 0.6, 0.2), radius: 0.9 };
    let Ledger { deposited, direct, absorbed, escaped, cut_off, shading_normals, .. } =
        ledger_of(&scene, &[around], 100_000);
    for fate in [deposited, direct, absorbed, escaped, cut_off, shading_normals.abs()] {
        assert!(fate.min_element() > 0.0);
    }
}

/// Irradiance at the origin, from above, by a lamp that fills `plate(height, size)`, by the midpoint rule.
fn integrated(height: f64, size: f64, radiance: impl Fn(DVec2) -> f64) -> f64 {
    let steps = 400;
    let at = |i: i32| (f64::from(i) + 0.5) / f64::from(steps);
    let mut sum = 0.0;
    for (i, j) in (0..steps).flat_map(|i| (0..steps).map(move |j| (i, j))) {
        let across = size * DVec2::new(at(i) - 0.5, at(j) - 0.5);
        let squared = across.length_squared() + height * height;
        sum += radiance(DVec2::new(at(i), at(j))) * height * height / (squared * squared);
    }
    sum * (size / f64::from(steps)).powi(2)
}

#[test]
fn shining_picture_is_the_sum_of_its_points() {
    // The lamp shines down and its picture's v grows along z.
    let lamp = Mesh::rectangle(0.8 * Vec3::Y, 1.5 * Vec3::X, 1.5 * Vec3::Z);
    let parts = vec![(plate(0.0, 4.0), diffuse(0.5), Vec3::ZERO), (lamp, diffuse(0.0), Vec3::ZERO)];
    let mut scene = scene(parts, Vec::new());
    scene.materials[1].emission = Vec3::splat(2.0);
    let shades = picture(4, 3, |column, row| [8.0 * speckle(column, row); 4]);
    let holes = picture(3, 4, |column, row| [speckle(row, column + 40); 4]);
    let at = |texture: &Texture, uv| texture_at(texture, uv).x;
    let wanted = |with_holes: bool| {
        integrated(0.8, 1.5, |uv| 2.0 * at(&shades, uv) * if with_holes { 0.9 * at(&holes, uv) } else { 1.0 })
    };
    scene.materials[1].textures.emission = Some(shades.clone());
    for has_holes in [false, true] {
        if has_holes {
            scene.materials[1].opacity = 0.9;
            scene.materials[1].textures.opacity = Some(holes.clone());
        }
        let world = World::new(&scene);
        let expected = wanted(has_holes);
        let at_point = irradiance_at(&world, DVec3::ZERO, DVec3::Y, 200_000, 3).direct;
        assert_agrees(&at_point, expected, 1e-4, "at the point");
        let (edge_u, edge_v) = (0.02 * DVec3::X, -0.02 * DVec3::Z);
        let region = Region { center: DVec3::ZERO, edge_u, edge_v, columns: 1, rows: 1 };
        let around = Sphere { center: DVec3::ZERO, radius: 0.015 };
        let traced = irradiance_on(&world, &region, Some(&around), 1_000_000, 3).direct[0];
        assert_agrees(&traced, expected, 1e-3, "from the lamp");
    }
    // As paths meet it: behind a pane that is hardly there.
    let clear = MaterialKind::ThinWalled { ior: 1.0 + 1e-4, tint: Vec3::ONE, roughness: 0.0 };
    let mut object = scene.objects[0].clone();
    (object.mesh, object.materials) = (Arc::new(plate(0.4, 4.0)), vec![2]);
    scene.objects.push(object);
    scene.materials.push(diacaustic_scene::Material::new("pane", clear));
    let through = irradiance_at(&World::new(&scene), DVec3::ZERO, DVec3::Y, 400_000, 3);
    assert_eq!(through.direct.mean, DVec3::ZERO);
    assert_agrees(&through.via_casters, wanted(true), 1e-3, "through the pane");
    // An even picture of the mean is another light.
    assert!((wanted(false) / integrated(0.8, 1.5, |_| 2.0 * f64::from(shades.image.mean().x)) - 1.0).abs() > 0.03);
    assert!(wanted(false) < 16.0 * FRAC_PI_2 * 2.0);
}
