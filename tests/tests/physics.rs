//! Known answers of geometrical optics, through both passes on the GPU.

use std::f64::consts::PI;

use diacaustic::{EnergyMap, Film, glam::DVec3};
use diacaustic_scene::Scene;
use diacaustic_tests::{emit, mean, render, scene};

/// Fresnel reflectance of unpolarised light, in double precision.
fn fresnel(n: f64, degrees: f64) -> f64 {
    let cos_i = degrees.to_radians().cos();
    let cos_t = (1.0 - (1.0 - cos_i * cos_i) / (n * n)).sqrt();
    let r_s = (cos_i - n * cos_t) / (cos_i + n * cos_t);
    let r_p = (n * cos_i - cos_t) / (n * cos_i + cos_t);
    0.5 * (r_s * r_s + r_p * r_p)
}

fn picture_mean(film: &Film) -> f64 {
    mean(film.radiance.iter().map(|pixel| f64::from(pixel[1])))
}

/// A camera that looks at the middle of a block's top from `degrees` off its normal, through a picture so narrow that all its
/// rays have one direction.
fn camera_at(degrees: f64) -> String {
    let (sin, cos) = degrees.to_radians().sin_cos();
    format!(
        "camera = {{ position = [{}, {}, 0], look_at = [0, 0, 0], up = [0, 0, 1], vertical_fov = 0.02 }}
         render = {{ width = 32, height = 32, samples = 64, photons = 0, max_depth = 64 }}",
        10.0 * sin,
        10.0 * cos
    )
}

#[test]
fn fresnel_table() {
    let table = [(0.0, 0.0400), (30.0, 0.0415), (45.0, 0.0502), (60.0, 0.0892), (75.0, 0.2531), (85.0, 0.6128)];
    for (degrees, expected) in table {
        // What enters the block is absorbed at once, so the picture is the reflectance.
        let film = render(&scene(&format!(
            "background = 1\n{}
             materials.glass = {{ type = \"dielectric\", ior = 1.5, absorption = 1e6 }}
             objects = [{{ box = {{ min = [-4, -1, -4], max = [4, 0, 4] }}, material = \"glass\" }}]",
            camera_at(degrees)
        )));
        let found = picture_mean(&film);
        assert!((fresnel(1.5, degrees) - expected).abs() < 5e-5);
        assert!((found - expected).abs() < 6e-4, "{degrees}°: reflectance {found}, known {expected}");
    }
}

/// The share of radiance that comes through a slab 0.5 m thick, with all inner reflections, seen at normal incidence.
fn slab_seen(ior: f64, absorption: f64) -> f64 {
    let film = render(&scene(&format!(
        "ambient = 1\n{}
         materials.glass = {{ type = \"dielectric\", ior = {ior}, absorption = {absorption} }}
         materials.glow = {{ type = \"phong\", ambient = 1, diffuse = 0, specular = 0, shininess = 1 }}
         objects = [
             {{ box = {{ min = [-4, -0.5, -4], max = [4, 0, 4] }}, material = \"glass\" }},
             {{ rectangle = {{ center = [0, -1, 0], edge_u = [4, 0, 0], edge_v = [0, 0, -4] }}, material = \"glow\" }},
         ]",
        camera_at(0.0)
    )));
    picture_mean(&film)
}

#[test]
fn slab_seen_through_with_all_inner_reflections() {
    let found = slab_seen(1.5, 0.0);
    assert!((found - 0.92308).abs() < 6e-4, "transmittance {found}, known 2n/(n² + 1) = 0.92308");
}

#[test]
fn absorbing_slab() {
    for sigma in [0.3, 2.0] {
        let (f, decay) = (fresnel(1.5, 0.0), f64::exp(-sigma * 0.5));
        let expected = (1.0 - f).powi(2) * decay / (1.0 - (f * decay).powi(2));
        let found = slab_seen(1.5, sigma);
        assert!((found - expected).abs() < 6e-4, "σ = {sigma}/m: transmittance {found}, known {expected}");
    }
}

/// A small lamp 50 m above the middle of a floor 1 m wide, and what stands between them. Returns the floor's mean irradiance
/// over what it would be without obstacle.
fn lit_through(between: &str, lamp_height: f64) -> f64 {
    let scene = scene(&format!(
        "camera = {{ position = [0, 1, 9], look_at = [0, 0, 0], vertical_fov = 40 }}
         render = {{ map_size = 16, max_depth = 64 }}
         lights = [{{ type = \"sphere\", center = [0, 50, 0], radius = 0.01, flux = 1000 }}]
         materials.floor = {{ type = \"diffuse\", albedo = 0.5 }}
         objects = [
             {{ rectangle = {{ center = [0, 0, 0], edge_u = [1, 0, 0], edge_v = [0, 0, -1] }}, material = \"floor\" }},
             {between}"
    ));
    let photons = 1 << 19;
    let map = emit(&scene, photons).energy_map(0).unwrap().expect("the floor is a receiver");
    let flux: f64 = (0..map.sums.len()).map(|texel| map.flux(texel).y).sum();
    // The solid angle of a square of side 1 from height h above its middle is 4 atan(1/(4h √(1/2 + h²))) … for a unit half side.
    let (a, h) = (0.5f64, lamp_height);
    let solid_angle = 4.0 * (a * a / (h * (2.0 * a * a + h * h).sqrt())).atan();
    flux / (1000.0 / (4.0 * PI) * solid_angle)
}

const GLASS_SLAB: &str = "{ box = { min = [-0.6, 1, -0.6], max = [0.6, 1.1, 0.6] }, material = \"glass\" }]
    materials.glass = { type = \"dielectric\", ior = 1.5 }";

#[test]
fn slab_lit_through_with_all_inner_reflections() {
    // To a slab of thickness t and index n the lamp seems nearer by t(1 − 1/n).
    let found = lit_through(GLASS_SLAB, 50.0 - 0.1 / 3.0);
    assert!((found / 0.92308 - 1.0).abs() < 1.5e-3, "transmittance {found}, known 2n/(n² + 1) = 0.92308");
}

#[test]
fn tinted_slab_tints_at_each_boundary() {
    let tinted = GLASS_SLAB.replace("ior = 1.5", "ior = 1.0, tint = 0.5");
    let found = lit_through(&tinted, 50.0);
    assert!((found / 0.25 - 1.0).abs() < 1e-3, "transmittance {found}, known tint² = 0.25");
}

/// What a camera sees of a glow above a block when it looks in through the block's front, so that its rays meet the top from
/// inside at `degrees` off the top's normal.
fn top_seen_through_front(ior: f64, degrees: f64) -> f64 {
    // At the front the ray is 90° − `degrees` off that face's normal.
    let outside_sin = ior * degrees.to_radians().cos();
    let outside_cos = (1.0 - outside_sin * outside_sin).sqrt();
    picture_mean(&render(&scene(&format!(
        "ambient = 1
         camera = {{ position = [{}, {}, 0], look_at = [1, 0.5, 0], up = [0, 0, 1], vertical_fov = 0.02 }}
         render = {{ width = 8, height = 8, samples = 256, photons = 0, max_depth = 1000 }}
         materials.glass = {{ type = \"dielectric\", ior = {ior} }}
         materials.glow = {{ type = \"phong\", ambient = 1, diffuse = 0, specular = 0, shininess = 1 }}
         objects = [
             {{ box = {{ min = [-9, 0, -5], max = [1, 1, 5] }}, material = \"glass\" }},
             {{ rectangle = {{ center = [-3.5, 1.5, 0], edge_u = [8, 0, 0], edge_v = [0, 0, -8] }}, material = \"glow\" }},
         ]",
        1.0 + 5.0 * outside_cos,
        0.5 - 5.0 * outside_sin,
    ))))
}

#[test]
fn total_internal_reflection() {
    let beyond = top_seen_through_front(1.5, 50.0);
    assert_eq!(beyond, 0.0, "50° is beyond the critical angle of 41.81°: nothing comes through the top");
    let within = top_seen_through_front(1.2, 50.0);
    assert!(within > 0.8, "50° is within the critical angle of 56.44°, yet only {within} comes through the top");
}

#[test]
fn index_one_without_tint_is_nothing() {
    let text = |object: &str| {
        format!(
            "camera = {{ position = [0, 1.5, 3], look_at = [0, 0.3, 0], vertical_fov = 40 }}
             render = {{ width = 64, height = 64, samples = 64, photons = 2_097_152, map_size = 128 }}
             lights = [{{ type = \"sphere\", center = [1, 3, 0.5], radius = 0.05, flux = 100 }}]
             materials.floor = {{ type = \"diffuse\", albedo = 0.8 }}
             materials.glass = {{ type = \"dielectric\", ior = 1 }}
             objects = [
                 {{ rectangle = {{ center = [0, 0, 0], edge_u = [4, 0, 0], edge_v = [0, 0, -4] }}, material = \"floor\" }},
                 {object}
             ]"
        )
    };
    let with = render(&scene(&text("{ sphere = { center = [0, 0.5, 0], radius = 0.4 }, material = \"glass\" }")));
    let without = render(&scene(&text("")));
    let ratio = picture_mean(&with) / picture_mean(&without);
    assert!((ratio - 1.0).abs() < 1e-3, "mean {ratio} of the empty scene's");
    // The map's texels blur the edge of the ball's shadow, so blocks of pixels are compared.
    for (block, (a, b)) in block_means(&with).iter().zip(&block_means(&without)).enumerate() {
        assert!((a - b).abs() <= 0.02 * b, "block {block} is {a}, in the empty scene {b}");
    }
}

/// Means of a 64 × 64 picture's blocks of 8 × 8 pixels.
fn block_means(film: &Film) -> Vec<f64> {
    let mut means = vec![0.0; 64];
    for (number, pixel) in film.radiance.iter().enumerate() {
        means[number / 64 / 8 * 8 + number % 64 / 8] += f64::from(pixel[1]) / 64.0;
    }
    means
}

fn in_a_furnace(object: &str) -> Film {
    render(&scene(&format!(
        "background = 1
         camera = {{ position = [0.3, 0.4, 3], look_at = [0, 0, 0], vertical_fov = 25 }}
         render = {{ width = 48, height = 48, samples = 16, photons = 0, max_depth = 1000 }}
         materials.glass = {{ type = \"dielectric\", ior = 1.5 }}
         objects = [{object}]"
    )))
}

#[test]
fn furnace_of_flat_facets() {
    let crystal = "{ mesh = \"assets/meshes/crystal.obj\", material = \"glass\", translate = [0, -0.2, 0], scale = 2 }";
    for (number, pixel) in in_a_furnace(crystal).radiance.iter().enumerate() {
        assert!((pixel[1] - 1.0).abs() < 2e-3, "pixel {number} is {pixel:?} in a furnace of radiance 1");
    }
}

#[test]
fn furnace_of_interpolated_normals() {
    // Near the rim, normals that are not the facets' can turn a ray so that total reflection holds it for good.
    let film = in_a_furnace("{ sphere = { center = [0, 0, 0], radius = 0.5 }, material = \"glass\" }");
    let found = picture_mean(&film);
    assert!((found - 1.0).abs() < 5e-4, "mean {found} in a furnace of radiance 1");
    let off = film.radiance.iter().filter(|pixel| (pixel[1] - 1.0).abs() > 2e-3).count();
    assert!(off <= 4, "{off} pixels are not 1 in a furnace of radiance 1");
}

/// A ball of radius 1 before a screen, lit by a lamp so far and small that its rays are parallel.
fn ball_lens(distance: f64) -> Scene {
    scene(&format!(
        "camera = {{ position = [0, 0, 9], look_at = [0, 0, 0], vertical_fov = 40 }}
         render = {{ map_size = 301, max_depth = 3 }}
         lights = [{{ type = \"sphere\", center = [0, 2000, 0], radius = 0.05, flux = 1e8 }}]
         materials.screen = {{ type = \"diffuse\", albedo = 0.5 }}
         materials.glass = {{ type = \"dielectric\", ior = 1.5 }}
         objects = [
             {{ rectangle = {{ center = [0, {}, 0], edge_u = [3, 0, 0], edge_v = [0, 0, -3] }}, material = \"screen\" }},
             {{ sphere = {{ center = [0, 0, 0], radius = 1, subdivisions = 8 }}, material = \"glass\" }},
         ]",
        -distance
    ))
}

/// Flux within rings of equal width up to 1.5 m on the screen, for irradiance 1, from the closed form: the ray at height h
/// passes with (1 − F)² to r = |h − z sin δ|/cos δ, and is reflected with F to r = h + (z + cos θ) tan(π − 2θ) if that is
/// toward the screen.
fn ball_lens_rings(n: f64, z: f64, rings: usize) -> Vec<f64> {
    let steps = 400_000;
    let mut flux = vec![0.0; rings];
    let mut add = |r: f64, share: f64, h: f64| {
        let ring = (r / 1.5 * rings as f64) as usize;
        if ring < rings {
            flux[ring] += share * 2.0 * PI * h / f64::from(steps);
        }
    };
    let mut first_pass = 0.0;
    for i in 0..steps {
        let h = (f64::from(i) + 0.5) / f64::from(steps);
        let theta_i = h.asin();
        let delta = 2.0 * (theta_i - (h / n).asin());
        let reflected = fresnel(n, theta_i.to_degrees());
        let passed = (1.0 - reflected).powi(2);
        first_pass += passed * 2.0 * h / f64::from(steps);
        add((h - z * delta.sin()).abs() / delta.cos(), passed, h);
        let turned = PI - 2.0 * theta_i;
        if turned < 0.5 * PI {
            add(h + (z + theta_i.cos()) * turned.tan(), reflected, h);
        }
    }
    assert!((first_pass - 0.8355).abs() < 1e-4, "flux through the ball {first_pass}, known 0.8355");
    flux
}

/// Flux of a map's texels within rings around its middle, each texel's share by the area of its cell in each ring.
fn map_rings(map: &EnergyMap, side: f64, rings: usize) -> Vec<f64> {
    let (width, fine) = (map.width as usize, 8);
    let spacing = side / (width - 1) as f64;
    let mut flux = vec![0.0; rings];
    // Irradiance is bilinear between texels: sample it finely.
    for y in 0..(width - 1) * fine {
        for x in 0..(width - 1) * fine {
            let place = |k: usize| (k as f64 + 0.5) / fine as f64;
            let (px, py) = (place(x), place(y));
            let (i, j) = (px as usize, py as usize);
            let (f, g) = (px.fract(), py.fract());
            let e = |i: usize, j: usize| map.irradiance(j * width + i).y;
            let here = (1.0 - f) * (1.0 - g) * e(i, j)
                + f * (1.0 - g) * e(i + 1, j)
                + (1.0 - f) * g * e(i, j + 1)
                + f * g * e(i + 1, j + 1);
            let r = ((px * spacing - 0.5 * side).powi(2) + (py * spacing - 0.5 * side).powi(2)).sqrt();
            let ring = (r / 1.5 * rings as f64) as usize;
            if ring < rings {
                flux[ring] += here * (spacing / fine as f64).powi(2);
            }
        }
    }
    flux
}

#[test]
fn ball_lens_profile() {
    let z = 1.6;
    let scene = ball_lens(z);
    let map = emit(&scene, 4_000_000).energy_map(0).unwrap().expect("the screen is a receiver");
    let irradiance = 1e8 / (4.0 * PI * 2000.0 * 2000.0);
    // Without the ball the middle of the screen would stay dark: only light through the ball is in the map.
    let rings = 30;
    let found: Vec<f64> = map_rings(&map, 3.0, rings).iter().map(|flux| flux / irradiance).collect();
    let expected = ball_lens_rings(1.5, z, rings);
    let difference: f64 = found.iter().zip(&expected).map(|(a, b)| (a - b).abs()).sum();
    let error = difference / expected.iter().sum::<f64>();
    assert!(error < 0.02, "L1 error {error}:\nfound    {found:.4?}\nexpected {expected:.4?}");
}

#[test]
fn ledger_closes_exactly() {
    let scene = scene(
        "camera = { position = [0, 1.5, 3], look_at = [0, 0.3, 0], vertical_fov = 40 }
         render = { max_depth = 4, map_size = 64, seed = 7 }
         materials.floor = { type = \"diffuse\", albedo = 0.8 }
         materials.glass = { type = \"dielectric\", ior = 1.5, tint = [0.9, 0.8, 1], absorption = [0, 1, 2] }
         materials.mirror = { type = \"mirror\", reflectance = [0.9, 0.5, 0.1] }
         lights = [
             { type = \"sphere\", center = [1, 3, 0.5], radius = 0.05, flux = [10, 20, 0.001] },
             { type = \"sphere\", center = [0.3, 0.95, 0.1], radius = 0.2, flux = 5 },
         ]
         objects = [
             { rectangle = { center = [0, 0, 0], edge_u = [1, 0, 0], edge_v = [0, 0, -1] }, material = \"floor\" },
             { mesh = \"assets/meshes/teapot.obj\", material = \"glass\", translate = [0, 0.1, 0] },
             { sphere = { center = [-0.6, 0.5, 0.2], radius = 0.3 }, material = \"mirror\" },
         ]",
    );
    let photons = 300_001;
    let renderer = emit(&scene, photons);
    let statistics = renderer.statistics().unwrap();
    assert_eq!(statistics.ledgers.len(), 2);
    for ledger in &statistics.ledgers {
        assert_eq!(ledger.residue(), [0, 0, 0]);
        for account in
            [ledger.emitted, ledger.deposited, ledger.direct, ledger.absorbed, ledger.escaped, ledger.cut_off]
        {
            assert!(account[1] > 0, "an account is empty, so that nothing is tested: {ledger:?}");
        }
    }
    // The maps hold what the ledgers say, to the last unit.
    let deposited: i64 = statistics.ledgers.iter().map(|ledger| ledger.deposited[1]).sum();
    let held: i64 = renderer.energy_map(0).unwrap().unwrap().sums.iter().map(|sum| sum[1]).sum();
    assert_eq!(held, deposited);
    // Aimed light never exceeds what the light has; unaimed light is all of it.
    let second = &statistics.ledgers[1];
    let emitted: DVec3 = second.watts(second.emitted, photons);
    // Guided photons of different flux estimate it.
    assert!((emitted.y - 5.0).abs() < 0.1, "the second light's photons carry {} of its 5 W", emitted.y);
}

#[test]
fn plane_mirror_makes_a_virtual_lamp() {
    // The mirror stands at x = 2, so a lamp at (−30, 40, 0) shines as if from (34, 40, 0).
    let scene = scene(
        "camera = { position = [0, 1, 9], look_at = [0, 0, 0], vertical_fov = 40 }
         render = { map_size = 16 }
         lights = [{ type = \"sphere\", center = [-30, 40, 0], radius = 0.05, flux = 100_000 }]
         materials.floor = { type = \"diffuse\", albedo = 0.5 }
         materials.mirror = { type = \"mirror\", reflectance = [0.9, 0.5, 0] }
         objects = [
             { rectangle = { center = [0, 0, 0], edge_u = [1, 0, 0], edge_v = [0, 0, -1] }, material = \"floor\" },
             { rectangle = { center = [2, 2.4, 0], edge_u = [0, 2.2, 0], edge_v = [0, 0, 1.6] }, material = \"mirror\" },
         ]",
    );
    let map = emit(&scene, 1 << 20).energy_map(0).unwrap().expect("the floor is a receiver");
    let found: DVec3 = (0..map.sums.len()).map(|texel| map.flux(texel)).sum();
    let distance2 = 34.0f64 * 34.0 + 40.0 * 40.0;
    let unmirrored = 100_000.0 / (4.0 * PI) * 40.0 / distance2.powf(1.5);
    for (found, reflectance) in [(found.x, 0.9), (found.y, 0.5)] {
        let ratio = found / unmirrored;
        assert!((ratio / reflectance - 1.0).abs() < 5e-3, "reflected share {ratio}, known {reflectance}");
    }
    assert_eq!(found.z, 0.0);
}

#[test]
fn thin_lens_blurs_to_its_circle_of_confusion() {
    // A lamp of radius r at distance d, focus at f, lens of radius a: in the lamp's plane each of its points is a disc of
    // radius a |f − d|/f. A disc's mean square radius is half its radius squared, and convolution adds the two.
    let (r, d, f, a) = (0.01, 2.0, 4.0, 0.05);
    let film = render(&scene(&format!(
        "camera = {{ position = [0, 0, {d}], look_at = [0, 0, 0], vertical_fov = 4, aperture_radius = {a}, focus_distance = {f} }}
         render = {{ width = 128, height = 128, samples = 256, photons = 0 }}
         lights = [{{ type = \"sphere\", center = [0, 0, 0], radius = {r}, flux = 1 }}]
         materials.floor = {{ type = \"diffuse\", albedo = 0 }}
         objects = [{{ rectangle = {{ center = [0, -9, 0], edge_u = [1, 0, 0], edge_v = [0, 0, -1] }}, material = \"floor\" }}]"
    )));
    let pixel = 2.0 * d * f64::tan(2.0f64.to_radians()) / 128.0;
    let (mut energy, mut second_moment) = (0.0, 0.0);
    for (number, value) in film.radiance.iter().enumerate() {
        let (x, y) = ((number % 128) as f64 - 63.5, (number / 128) as f64 - 63.5);
        energy += f64::from(value[1]);
        second_moment += f64::from(value[1]) * (x * x + y * y) * pixel * pixel;
    }
    let confusion = a * (f - d) / f;
    let expected = 0.5 * (confusion * confusion + r * r);
    let found = second_moment / energy;
    assert!((found / expected - 1.0).abs() < 0.01, "mean square radius {found} m², known {expected} m²");
    let radiance = 1.0 / (4.0 * PI * PI * r * r);
    let brought = energy * pixel * pixel / (radiance * PI * r * r);
    assert!((brought - 1.0).abs() < 0.01, "the lens brings {brought} of the lamp's light");
}

#[test]
fn mirrors_that_face_each_other_are_followed_to_the_end() {
    // Adapters that end long loops must not end these paths early: each photon bounces up to a thousand times.
    let scene = scene(
        "camera = { position = [0, 1, 9], look_at = [0, 0, 0], vertical_fov = 40 }
         render = { map_size = 16, max_depth = 1000 }
         lights = [{ type = \"sphere\", center = [0, 0.5, 0], radius = 0.1, flux = 1 }]
         materials.mirror = { type = \"mirror\", reflectance = 1 }
         materials.floor = { type = \"diffuse\", albedo = 0.5 }
         objects = [
             { rectangle = { center = [0, -1, 0], edge_u = [8, 0, 0], edge_v = [0, 0, -8] }, material = \"mirror\" },
             { rectangle = { center = [0, 1, 0], edge_u = [8, 0, 0], edge_v = [0, 0, 8] }, material = \"mirror\" },
             { rectangle = { center = [9, 0, 0], edge_u = [0, 8, 0], edge_v = [0, 0, 8] }, material = \"floor\" },
         ]",
    );
    let photons = 1 << 16;
    let renderer = emit(&scene, photons);
    let statistics = renderer.statistics().expect("no invocation is cut short");
    let ledger = statistics.ledgers[0];
    assert_eq!(ledger.residue(), [0, 0, 0]);
    // A photon leaves by the sides after |tan θ| · 4 m or so; only the steepest are left after a thousand mirrors 2 m apart.
    let cut_off = ledger.watts(ledger.cut_off, photons).y;
    assert!(cut_off < 1e-3, "{cut_off} W of 1 W are cut off");
    assert!(statistics.photon_rays > 3 * photons, "the photons hardly bounce, so nothing is tested");
}
