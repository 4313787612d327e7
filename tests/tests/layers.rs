//! The layers of the picture: each against what it must hold, and their sum against the picture.

use diacaustic::{FARTHEST_DEPTH, Film, LayerImage, LayerValues};
use diacaustic_scene::{Layer, LightKind, Scene};
use diacaustic_tests::{emit, photons_of, render, samples_of, scene};
use glam::{DVec3, Vec3};

/// A picture with its layers.
struct Rendered {
    film: Film,
    layers: Vec<LayerImage>,
}

impl Rendered {
    fn of(scene: &Scene) -> Self {
        let mut renderer = emit(scene, photons_of(scene));
        renderer.add_samples(samples_of(scene)).unwrap();
        Self { film: renderer.film().unwrap(), layers: renderer.layers().unwrap() }
    }

    fn layer(&self, name: &str) -> &LayerImage {
        self.layers.iter().find(|layer| layer.name == name).unwrap_or_else(|| panic!("there is no layer {name}"))
    }

    /// A layer of three channels.
    fn vectors(&self, name: &str) -> Vec<Vec3> {
        let channels: Vec<&[f32]> = self.layer(name).channels.iter().map(|channel| floats(&channel.values)).collect();
        let [x, y, z] = channels[..] else { panic!("{name} has {} channels", channels.len()) };
        (0..x.len()).map(|pixel| Vec3::new(x[pixel], y[pixel], z[pixel])).collect()
    }

    /// A layer of whole numbers.
    fn numbers(&self, name: &str) -> &[u32] {
        match &self.layer(name).channels[0].values {
            LayerValues::Uint(values) => values,
            LayerValues::Float(_) => panic!("{name} holds no whole numbers"),
        }
    }
}

fn floats(values: &LayerValues) -> &[f32] {
    match values {
        LayerValues::Float(values) => values,
        LayerValues::Uint(_) => panic!("these are whole numbers"),
    }
}

fn picture(film: &Film) -> Vec<Vec3> {
    film.radiance.iter().copied().map(Vec3::from).collect()
}

fn with_all_layers(mut scene: Scene) -> Scene {
    scene.output.layers = Layer::ALL.to_vec();
    scene
}

/// A scene in which a lamp, a panel and a sign have groups of their own, and the sun has none.
fn grouped(mut scene: Scene) -> Scene {
    for (light, group) in scene.lights.iter_mut().zip([Some("key"), Some("fill"), None]) {
        light.group = group.map(str::to_owned);
    }
    let sign = scene.materials.iter_mut().find(|material| material.name == "sign").unwrap();
    sign.group = Some("sign".to_owned());
    scene
}

/// Each kind of light, surface and path: glass that disperses, frosted glass, varnish, wide gloss, ambient light, background.
fn variety(settings: &str) -> Scene {
    scene(&format!(
        "background = [0.1, 0.2, 0.3]
         ambient = 0.2
         camera = {{ position = [0.4, 1.6, 2.4], look_at = [0, 0.3, 0], vertical_fov = 50 }}
         render = {{ width = 32, height = 24, samples = 8, photons = 20_000, map_size = 65, {settings} }}
         materials.floor = {{ type = \"coated\", albedo = [0.8, 0.7, 0.6] }}
         materials.satin = {{ type = \"coated\", albedo = [0.2, 0.7, 0.6], roughness = 0.2 }}
         materials.paint = {{ type = \"metallic_roughness\", base_color = [0.9, 0.3, 0.1], metallic = 0.5, roughness = 0.5 }}
         materials.chalk = {{ type = \"phong\", ambient = 0.5, diffuse = 0.5, specular = 0.2, shininess = 10 }}
         materials.glass = {{ type = \"dielectric\", ior = 1.5, abbe = 20 }}
         materials.frosted = {{ type = \"dielectric\", ior = 1.5, roughness = 0.3 }}
         materials.sign = {{ type = \"diffuse\", albedo = 0.5, emission = 3 }}
         lights = [
             {{ type = \"sphere\", center = [0.4, 1.2, -0.4], radius = 0.1, flux = [4, 3, 2] }},
             {{ type = \"rectangle\", center = [-0.6, 1.3, 0], edge_u = [0.4, 0, 0], edge_v = [0, 0, 0.4], flux = 3 }},
             {{ type = \"sun\", direction = [-0.3, -1, -0.2], irradiance = 1, angular_radius = 3 }},
         ]
         objects = [
             {{ box = {{ min = [-0.25, 0.1, -0.25], max = [0.25, 0.5, 0.25] }}, material = \"glass\", rotate = [0, 30, 0] }},
             {{ box = {{ min = [-0.9, 0.1, -0.3], max = [-0.5, 0.5, 0.2] }}, material = \"frosted\" }},
             {{ box = {{ min = [0.6, 0.1, -0.3], max = [0.9, 0.5, 0.2] }}, material = \"satin\" }},
             {{ box = {{ min = [0.1, 0.1, 0.4], max = [0.3, 0.2, 0.6] }}, material = \"paint\" }},
             {{ box = {{ min = [-0.3, 0.1, 0.4], max = [-0.1, 0.2, 0.6] }}, material = \"chalk\" }},
             {{ rectangle = {{ center = [0, 0.8, -0.9], edge_u = [0.5, 0, 0], edge_v = [0, 0.3, 0] }}, material = \"sign\" }},
             {{ rectangle = {{ center = [0, 0, 0], edge_u = [3, 0, 0], edge_v = [0, 0, -3] }}, material = \"floor\" }},
         ]"
    ))
}

/// A rectangle of 1 m × 1 m before the camera, 2 m away and turned about the vertical, lit from behind the camera; a mirror is a caster far off.
fn card(settings: &str) -> Scene {
    scene(&format!(
        "camera = {{ position = [0, 0, 2], look_at = [0, 0, 0], vertical_fov = 40 }}
         render = {{ width = 24, height = 16, {settings} }}
         materials.card = {{ type = \"diffuse\", albedo = [0.8, 0.6, 0.4] }}
         materials.mirror = {{ type = \"mirror\", reflectance = 1 }}
         lights = [{{ type = \"sphere\", center = [1, 1, 2.5], radius = 0.3, flux = 20 }}]
         objects = [
             {{ rectangle = {{ center = [0, -9, 0], edge_u = [1, 0, 0], edge_v = [0, 0, 1] }}, material = \"mirror\" }},
             {{ rectangle = {{ center = [0, 0, 0], edge_u = [0.8, 0, -0.6], edge_v = [0, 1, 0] }}, material = \"card\" }},
         ]"
    ))
}

fn assert_close(found: &[Vec3], expected: &[Vec3], relative: f32, what: &str) {
    assert_eq!(found.len(), expected.len(), "{what}");
    for (pixel, (found, expected)) in found.iter().zip(expected).enumerate() {
        let allowed = relative * (found.abs().max_element() + expected.abs().max_element()) + 1e-6;
        assert!(found.abs_diff_eq(*expected, allowed), "{what}, pixel {pixel}: {found} against {expected}");
    }
}

fn sum_of(rendered: &Rendered, names: &[&str]) -> Vec<Vec3> {
    let layers: Vec<_> = names.iter().map(|name| rendered.vectors(name)).collect();
    (0..layers[0].len()).map(|pixel| layers.iter().map(|layer| layer[pixel]).sum()).collect()
}

#[test]
fn layers_of_light_sum_to_the_picture_and_change_none_of_its_bits() {
    let plain = variety("max_bounces = 3");
    let rendered = Rendered::of(&with_all_layers(plain.clone()));
    assert_eq!(rendered.film, render(&plain));
    let sum = sum_of(&rendered, &["emission", "direct", "caustic", "indirect"]);
    assert_close(&sum, &picture(&rendered.film), 1e-5, "the sum of the layers");
    for name in ["emission", "direct", "caustic", "indirect"] {
        let lit = rendered.vectors(name).iter().filter(|value| value.max_element() > 0.0).count();
        assert!(lit > 20, "{name}: {lit} pixels");
    }
}

#[test]
fn only_what_is_asked_for_is_there_in_the_order_of_files() {
    let mut scene = card("samples = 2, photons = 0");
    assert_eq!(Rendered::of(&scene).layers, []);
    scene.output.layers = vec![Layer::Samples, Layer::Depth, Layer::Direct];
    let rendered = Rendered::of(&scene);
    let names: Vec<_> = rendered.layers.iter().map(|layer| layer.name.as_str()).collect();
    assert_eq!(names, ["direct", "depth", "samples"]);
    assert!(rendered.numbers("samples").iter().all(|&count| count == 2));
    let all = Rendered::of(&with_all_layers(scene));
    for name in names {
        assert_eq!(rendered.layer(name), all.layer(name));
    }
}

#[test]
fn direct_light_is_the_picture_without_photons_and_bounces() {
    let all = Rendered::of(&with_all_layers(variety("max_bounces = 0, seed = 3")));
    // Phong's ambient light counts as indirect.
    let mut alone = variety("max_bounces = 0, seed = 3");
    alone.ambient = Vec3::ZERO;
    alone.settings.photons = Some(0);
    let expected = picture(&render(&alone));
    assert_close(&sum_of(&all, &["emission", "direct"]), &expected, 1e-5, "emission and direct light");
}

#[test]
fn emission_is_the_picture_of_black_receivers() {
    let shining = Rendered::of(&with_all_layers(card("samples = 4, photons = 0")));
    let mut scene = card("samples = 4, photons = 10_000");
    scene.background = Vec3::new(0.1, 0.2, 0.3);
    scene.materials[0].emission = Vec3::new(3.0, 2.0, 1.0);
    let all = Rendered::of(&with_all_layers(scene.clone()));
    scene.materials[0].kind = diacaustic_scene::MaterialKind::Diffuse { albedo: Vec3::ZERO };
    assert_close(&all.vectors("emission"), &picture(&render(&scene)), 1e-5, "emission");
    assert!(shining.vectors("emission").iter().all(|&value| value == Vec3::ZERO));
}

#[test]
fn without_bounces_the_rest_is_the_caustic() {
    let mut scene = with_all_layers(variety("max_bounces = 0"));
    scene.ambient = Vec3::ZERO;
    let rendered = Rendered::of(&scene);
    let indirect = rendered.vectors("indirect");
    assert!(indirect.iter().all(|&value| value == Vec3::ZERO), "without bounces and ambient light");
    scene.settings.photons = Some(2 * photons_of(&scene));
    let more = Rendered::of(&scene);
    assert_eq!(more.layer("emission"), rendered.layer("emission"));
    assert_eq!(more.layer("direct"), rendered.layer("direct"));
    assert_ne!(more.layer("caustic"), rendered.layer("caustic"));
}

/// Where the ray of a pixel's centre meets the card: place, and whether it does.
fn on_card(x: f32, y: f32) -> (Vec3, bool) {
    let half_height = 20f32.to_radians().tan();
    let screen = [2.0 * (x + 0.5) / 24.0 - 1.0, 1.0 - 2.0 * (y + 0.5) / 16.0];
    let direction = Vec3::new(screen[0] * 1.5 * half_height, screen[1] * half_height, -1.0);
    let normal = Vec3::new(0.6, 0.0, 0.8);
    let place = Vec3::Z * 2.0 + direction * (-2.0 * normal.z / direction.dot(normal));
    (place, place.y.abs() <= 0.5 && place.dot(Vec3::new(0.8, 0.0, -0.6)).abs() <= 0.5)
}

#[test]
fn the_first_surface_is_a_known_card() {
    let rendered = Rendered::of(&with_all_layers(card("samples = 64, photons = 0")));
    let [albedo, normal, position] = ["albedo", "normal", "position"].map(|name| rendered.vectors(name));
    let depth = floats(&rendered.layer("depth").channels[0].values);
    let (objects, materials) = (rendered.numbers("object_id"), rendered.numbers("material_id"));
    let mut checked = [0, 0];
    for (x, y) in (0..16u32).flat_map(|y| (0..24u32).map(move |x| (x, y))) {
        let pixel = (24 * y + x) as usize;
        let near = |at: u32| [at as f32 - 1.0, at as f32, at as f32 + 1.0];
        let around: Vec<bool> = near(x).into_iter().flat_map(|x| near(y).map(|y| on_card(x, y).1)).collect();
        let (place, _) = on_card(x as f32, y as f32);
        if around.iter().all(|is_on| *is_on) {
            assert!(albedo[pixel].abs_diff_eq(Vec3::new(0.8, 0.6, 0.4), 1e-5), "{}", albedo[pixel]);
            assert!(normal[pixel].abs_diff_eq(Vec3::new(0.6, 0.0, 0.8), 1e-5), "{}", normal[pixel]);
            // A pixel is 0.09 m wide, its samples fill it evenly.
            assert!(position[pixel].abs_diff_eq(place, 0.01), "{} against {place}", position[pixel]);
            assert!((depth[pixel] - (2.0 - position[pixel].z)).abs() < 1e-4, "{}", depth[pixel]);
            assert_eq!((objects[pixel], materials[pixel]), (2, 1));
            checked[0] += 1;
        } else if around.iter().all(|is_on| !is_on) {
            assert_eq!((albedo[pixel], normal[pixel], position[pixel]), (Vec3::ZERO, Vec3::ZERO, Vec3::ZERO));
            assert_eq!((depth[pixel], objects[pixel], materials[pixel]), (FARTHEST_DEPTH, 0, 0));
            checked[1] += 1;
        }
    }
    assert!(checked[0] > 50 && checked[1] > 100, "{checked:?}");
}

#[test]
fn surfaces_that_lose_nothing_have_albedo_1() {
    let kinds = [
        "type = \"diffuse\", albedo = 1",
        "type = \"coated\", albedo = 1",
        "type = \"mirror\", reflectance = 1",
        "type = \"dielectric\", ior = 1.5",
        "type = \"thin_walled\"",
        "type = \"metallic_roughness\", metallic = 1, roughness = 0",
    ];
    for kind in kinds {
        let scene = scene(&format!(
            "camera = {{ position = [0, 0, 0.01], look_at = [0, 0, 0], vertical_fov = 40 }}
             render = {{ width = 2, height = 2, samples = 2, photons = 0 }}
             materials.m = {{ {kind} }}
             objects = [{{ box = {{ min = [-1, -1, -1], max = [1, 1, 0] }}, material = \"m\" }}]"
        ));
        // A coat lets pass a little less along the normal than on average.
        let albedo = Rendered::of(&with_all_layers(scene)).vectors("albedo");
        let allowed = if kind.contains("coated") { 0.06 } else { 1e-5 };
        assert!(albedo.iter().all(|value| value.abs_diff_eq(Vec3::ONE, allowed)), "{kind}: {albedo:?}");
    }
}

#[test]
fn lights_have_places_but_no_numbers() {
    let mut scene = card("samples = 4, photons = 0");
    scene.camera.look_at = Vec3::new(1.0, 1.0, 2.5);
    let rendered = Rendered::of(&with_all_layers(scene));
    let middle = 24 * 8 + 12;
    let to_light = Vec3::new(1.0, 1.0, 0.5);
    let depth = floats(&rendered.layer("depth").channels[0].values)[middle];
    assert!((depth - (to_light.length() - 0.3)).abs() < 0.02, "{depth}");
    assert!(rendered.vectors("normal")[middle].dot(-to_light.normalize()) > 0.97);
    assert!(rendered.numbers("object_id").iter().all(|&object| object == 0));
}

/// Bounced light in a box.
fn bouncing() -> Scene {
    with_all_layers(scene(
        "camera = { position = [0, 1, 2.9], look_at = [0, 1, 0], vertical_fov = 40 }
         render = { width = 12, height = 8, samples = 16, photons = 0, max_bounces = 4 }
         materials.wall = { type = \"diffuse\", albedo = 0.7 }
         lights = [{ type = \"sphere\", center = [0.5, 0.4, 0], radius = 0.05, flux = 20 }]
         objects = [{ box = { min = [-2, 0, -2], max = [2, 2, 3] }, material = \"wall\" }]",
    ))
}

/// The variance of a picture's pixels as docs/layers.md defines it, of the sums of their first, second … samples.
fn expected_variance(sums: &[Vec<DVec3>], width: usize) -> Vec<DVec3> {
    let n = sums.len();
    let first = 1 << (n - 1).ilog2();
    let variance = |pixel: usize| {
        let mean = sums[n - 1][pixel] / n as f64;
        let samples = (0..n).map(|k| sums[k][pixel] - if k > 0 { sums[k - 1][pixel] } else { DVec3::ZERO });
        let of_samples = samples.map(|sample| (sample - mean).powf(2.0)).sum::<DVec3>() / (n * (n - 1)) as f64;
        let late = (sums[n - 1][pixel] - sums[first - 1][pixel]) / (n - first) as f64;
        let difference = sums[first - 1][pixel] / first as f64 - late;
        (of_samples, difference.powf(2.0) * (first * (n - first)) as f64 / (n * n) as f64)
    };
    let both: Vec<_> = (0..sums[0].len()).map(variance).collect();
    let far = |a: usize, b: usize| (a % width).abs_diff(b % width).max((a / width).abs_diff(b / width));
    let scaled = |pixel: usize| {
        let around = (0..both.len()).filter(|&other| far(pixel, other) <= 4).map(|other| both[other]);
        let (samples, halves) = around.fold((0.0, 0.0), |(s, h), (a, b)| (s + a.element_sum(), h + b.element_sum()));
        both[pixel].0 * (halves / samples)
    };
    (0..both.len()).map(scaled).collect()
}

#[test]
fn variance_is_that_of_the_samples_scaled_by_their_halves() {
    let scene = bouncing();
    let mut renderer = emit(&scene, 0);
    let mut sums = Vec::new();
    for count in 1..=16 {
        renderer.add_samples(1).unwrap();
        let film = renderer.film().unwrap();
        sums.push(picture(&film).into_iter().map(|mean| mean.as_dvec3() * f64::from(count)).collect());
        if [2, 7, 8, 9, 16].contains(&count) {
            let rendered = Rendered { film, layers: renderer.layers().unwrap() };
            let expected: Vec<_> = expected_variance(&sums, 12).into_iter().map(DVec3::as_vec3).collect();
            assert_close(&rendered.vectors("variance"), &expected, 1e-3, &format!("variance of {count} samples"));
        }
    }
}

#[test]
fn seeds_spread_by_the_variance() {
    const SEEDS: u32 = 24;
    let (mut sum, mut squares, mut stated) = (vec![DVec3::ZERO; 96], vec![DVec3::ZERO; 96], 0.0);
    for seed in 0..SEEDS {
        let mut scene = bouncing();
        scene.settings.seed = seed;
        let rendered = Rendered::of(&scene);
        stated += rendered.vectors("variance").iter().map(|variance| f64::from(variance.y)).sum::<f64>();
        for (pixel, value) in picture(&rendered.film).into_iter().enumerate() {
            sum[pixel] += value.as_dvec3();
            squares[pixel] += value.as_dvec3().powf(2.0);
        }
    }
    let n = f64::from(SEEDS);
    let spread: f64 = sum.iter().zip(&squares).map(|(s, q)| (q.y - s.y * s.y / n) / (n - 1.0)).sum();
    let ratio = spread / (stated / n);
    assert!((0.4..1.2).contains(&ratio), "spread between seeds over the variance stated: {ratio}");
}

#[test]
fn a_single_sample_knows_no_variance() {
    let rendered = Rendered::of(&with_all_layers(card("samples = 1, photons = 0")));
    assert!(rendered.vectors("variance").iter().all(|&variance| variance == Vec3::ZERO));
}

#[test]
fn restarting_forgets_the_layers() {
    let scene = with_all_layers(variety("max_bounces = 1"));
    let mut renderer = emit(&scene, photons_of(&scene));
    let mut layers = Vec::new();
    for _ in 0..2 {
        renderer.add_samples(2).unwrap();
        layers.push(renderer.layers().unwrap());
        renderer.restart().unwrap();
        renderer.emit_photons(0..photons_of(&scene)).unwrap();
    }
    assert_eq!(layers[0], layers[1]);
}

#[test]
fn light_groups_sum_to_the_picture_and_change_none_of_its_bits() {
    let plain = variety("max_bounces = 3");
    let rendered = Rendered::of(&with_all_layers(grouped(plain.clone())));
    assert_eq!(rendered.film, render(&plain));
    let lights = ["light_key", "light_fill", "light_default", "light_sign", "light_background"];
    assert_close(&sum_of(&rendered, &lights), &picture(&rendered.film), 1e-5, "the sum of the groups");
    let caustics = ["caustic_key", "caustic_fill", "caustic_default", "caustic_sign"];
    assert_close(&sum_of(&rendered, &caustics), &rendered.vectors("caustic"), 1e-5, "the sum of the groups' caustics");
    for name in lights.into_iter().chain(caustics) {
        let lit = rendered.vectors(name).iter().filter(|value| value.max_element() > 1e-4).count();
        assert!(lit > 10, "{name}: {lit} pixels");
    }
    let group_layers =
        rendered.layers.iter().filter(|layer| layer.name.contains("light_") || layer.name.contains("caustic_"));
    assert_eq!(group_layers.count(), 9);
}

#[test]
fn energy_maps_hold_all_groups_to_the_bit() {
    let plain = variety("guiding = false");
    let (together, apart) = (emit(&plain, 20_000), emit(&with_all_layers(grouped(plain.clone())), 20_000));
    let floor = plain.objects.len() - 1;
    let map = together.energy_map(floor).unwrap().unwrap();
    assert!(map.sums.iter().flatten().any(|sum| *sum > 0));
    assert_eq!(map, apart.energy_map(floor).unwrap().unwrap());
}

#[test]
fn one_group_has_no_layers_of_its_own() {
    let rendered = Rendered::of(&with_all_layers(card("samples = 1, photons = 0")));
    assert_eq!(rendered.layers.len(), Layer::ALL.len() - 1);
}

/// Pixels' means over renders with several seeds from `first` on, and the variances of these means, of what `value` makes of each render.
fn over_seeds(scene: &Scene, first: u32, value: impl Fn(&Rendered) -> Vec<Vec3>) -> Vec<(DVec3, DVec3)> {
    const SEEDS: u32 = 16;
    let mut sums = vec![(DVec3::ZERO, DVec3::ZERO); (scene.settings.width * scene.settings.height) as usize];
    for seed in first..first + SEEDS {
        let mut scene = scene.clone();
        scene.settings.seed = seed;
        for ((sum, squares), value) in sums.iter_mut().zip(value(&Rendered::of(&scene))) {
            *sum += value.as_dvec3();
            *squares += value.as_dvec3().powf(2.0);
        }
    }
    let n = f64::from(SEEDS);
    sums.into_iter().map(|(sum, squares)| (sum / n, (squares - sum * sum / n) / (n * (n - 1.0)))).collect()
}

#[test]
fn a_group_taken_away_is_a_light_turned_off() {
    let mut scene = grouped(variety("max_bounces = 2"));
    scene.settings.width = 16;
    scene.settings.height = 12;
    scene.output.layers = vec![Layer::LightGroups];
    let taken_away = over_seeds(&scene, 0, |rendered| {
        let own = rendered.vectors("light_key");
        picture(&rendered.film).into_iter().zip(own).map(|(all, own)| all - own).collect()
    });
    scene.output.layers = Vec::new();
    let LightKind::Sphere { flux, .. } = &mut scene.lights[0].kind else { panic!("the key light is a sphere") };
    // Not 0, for a dark sphere would block no light.
    *flux *= 1e-6;
    let turned_off = over_seeds(&scene, 1000, |rendered| picture(&rendered.film));
    let z: Vec<f64> = taken_away
        .iter()
        .zip(&turned_off)
        .flat_map(|((a, var_a), (b, var_b))| ((a - b) / (var_a + var_b).max(DVec3::splat(1e-12)).powf(0.5)).to_array())
        .collect();
    let mean_square = z.iter().map(|z| z * z).sum::<f64>() / z.len() as f64;
    let mean = z.iter().sum::<f64>() / z.len() as f64;
    assert!((0.5..1.5).contains(&mean_square), "mean of z²: {mean_square}");
    assert!(mean.abs() < 0.25, "mean of z: {mean}");
    assert!(
        z.iter().all(|z| z.abs() < 6.0),
        "largest z: {:?}",
        z.iter().copied().fold(0.0, |a: f64, b| a.max(b.abs()))
    );
}
