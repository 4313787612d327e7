//! The profile `paper`: each of the 2016 paper's equations against its closed form, through the kernels.

use std::f64::consts::PI;

use diacaustic::EnergyMap;
use diacaustic_scene::Scene;
use diacaustic_tests::{emit, mean, photons_of, render, scene};

/// What a map's texel (i, j) has.
fn texel(map: &EnergyMap, i: u32, j: u32) -> f64 {
    map.irradiance((j * map.width + i) as usize)[1]
}

/// A wall of 1 m × 1 m at x = 0 with 11 × 11 texels, and the one ray of a grid of one angle each: along −x from (2, `y`, `z`), through a
/// block of index 1, so that it lands straight across.
fn one_ray(y: f64, z: f64) -> Scene {
    scene(&format!(
        "camera = {{ position = [3, 0, 0], look_at = [0, 0, 0], vertical_fov = 40 }}
         render = {{ width = 8, height = 8, profile = \"paper\", photons = 1 }}
         paper = {{ energy = 35, map_size = 11, map_size_in = \"texels\", transparency = 1 }}
         materials.wall = {{ type = \"diffuse\", albedo = 1 }}
         materials.nothing = {{ type = \"dielectric\", ior = 1 }}
         lights = [{{ type = \"point\", position = [2, {y}, {z}], flux = 1 }}]
         objects = [
             {{ rectangle = {{ center = [0, 0, 0], edge_u = [0, 1, 0], edge_v = [0, 0, 1] }}, material = \"wall\" }},
             {{ box = {{ min = [0.5, -1, -1], max = [1, 1, 1] }}, material = \"nothing\" }},
         ]"
    ))
}

#[test]
fn equation_2_gives_each_texel_its_weight() {
    // Where the ray lands between texels (5, 5), (6, 5), (5, 6) and (6, 6), a tenth of a metre apart.
    for (f, g) in [(0.01, 0.01), (0.5, 0.5), (0.5, 0.01), (0.25, 0.75), (0.9, 0.2)] {
        let renderer = emit(&one_ray(0.1 * f, 0.1 * g), 1);
        let map = renderer.energy_map(0).unwrap().expect("the wall has a map");
        let corners = [(5, 5, f, g), (6, 5, 1.0 - f, g), (5, 6, f, 1.0 - g), (6, 6, 1.0 - f, 1.0 - g)];
        let distances = corners.map(|(_, _, x, y): (u32, u32, f64, f64)| x.hypot(y));
        let sum: f64 = distances.iter().sum();
        for ((i, j, _, _), distance) in corners.into_iter().zip(distances) {
            // Divided by the map's size of 11.
            let expected = 35.0 / 11.0 * (sum - distance) / (3.0 * sum);
            let found = texel(&map, i, j);
            assert!((found - expected).abs() < 2e-4, "({f}, {g}): texel ({i}, {j}) has {found}, not {expected}");
        }
        let total: f64 = (0..map.sums.len()).map(|texel| map.irradiance(texel)[1]).sum();
        assert!((total - 35.0 / 11.0).abs() < 1e-6, "({f}, {g}): the weights sum to {}", total * 11.0 / 35.0);
    }
}

/// Rays in every direction from the origin, the pole along +z, out of a block of index 1; a wall before the pole at z = 1.
const POLE: &str = "camera = { position = [0, 3, 0.1], look_at = [0, 0, 0], vertical_fov = 40 }
    render = { width = 8, height = 8, profile = \"paper\", photons = 524_288 }
    paper = { energy = 1, sampling = \"random\", map_size = 256, map_size_in = \"texels\", transparency = 1 }
    materials.wall = { type = \"diffuse\", albedo = 1 }
    materials.nothing = { type = \"dielectric\", ior = 1 }
    lights = [{ type = \"point\", position = [0, 0, 0], flux = 1 }]
    objects = [
        { rectangle = { center = [0, 0, 1], edge_u = [4, 0, 0], edge_v = [0, -4, 0] }, material = \"wall\" },
        { box = { min = [-0.2, -0.2, -0.2], max = [0.2, 0.2, 0.2] }, material = \"nothing\" },
    ]";

/// Texels along a block, in which rays are counted; blocks along the map.
const BLOCK: usize = 16;
const BLOCKS: usize = 16;

/// Sum of (found − expected)²/expected over blocks away from the map's edge, by their number; `density` per m² of the wall at x, y.
fn chi_square_per_block(counts: &[f64], rays: f64, density: impl Fn(f64, f64) -> f64) -> f64 {
    let spacing = 4.0 / 255.0;
    let steps = 300;
    let step = BLOCK as f64 * spacing / f64::from(steps);
    let mut sum = 0.0;
    for row in 1..BLOCKS - 1 {
        for column in 1..BLOCKS - 1 {
            let low = [column, row].map(|block| (block * BLOCK) as f64 * spacing - 0.5 * spacing - 2.0);
            let points = (0..steps * steps).map(|k| [k % steps, k / steps].map(|k| (f64::from(k) + 0.5) * step));
            let share: f64 = points.map(|[x, y]| density(low[0] + x, low[1] + y) * step * step).sum();
            let expected = rays * share;
            sum += (counts[row * BLOCKS + column] - expected).powi(2) / expected;
        }
    }
    sum / ((BLOCKS - 2) * (BLOCKS - 2)) as f64
}

#[test]
fn equation_1_draws_its_density_of_directions() {
    let scene = scene(POLE);
    let renderer = emit(&scene, photons_of(&scene));
    let map = renderer.energy_map(0).unwrap().expect("the wall has a map");
    let mut counts = vec![0.0; BLOCKS * BLOCKS];
    for j in 0..map.height {
        for i in 0..map.width {
            // Undo the division by the size: rays, and parts of them.
            counts[j as usize / BLOCK * BLOCKS + i as usize / BLOCK] += 256.0 * texel(&map, i, j);
        }
    }
    let rays = photons_of(&scene) as f64;
    // 1/(2π² cos φ) sr⁻¹, and the solid angle of an area at (x, y, 1): cos φ = ρ/r, dω = dA/r³.
    let printed =
        chi_square_per_block(&counts, rays, |x, y| 1.0 / (2.0 * PI * PI * x.hypot(y) * (1.0 + x * x + y * y)));
    // 196 blocks: the deviation of the mean is √(2/196) = 0.1. Rays that four texels share between blocks spread it less.
    assert!((0.55..1.35).contains(&printed), "χ² is {printed} a block");
    let even = chi_square_per_block(&counts, rays, |x, y| 1.0 / (4.0 * PI * (1.0 + x * x + y * y).powf(1.5)));
    assert!(even > 10.0, "χ² against even directions is only {even} a block");
}

/// A slab of glass of index 1.5 and 0.3 m thickness, `degrees` off the one ray along −x; a wall 4 m behind with a strip of texels 1 mm apart.
fn slab(refraction: &str, degrees: f64) -> Scene {
    scene(&format!(
        "camera = {{ position = [9, 0, 0], look_at = [0, 0, 0], vertical_fov = 40 }}
         render = {{ width = 8, height = 8, profile = \"paper\", photons = 1 }}
         paper = {{ refraction = \"{refraction}\", map_size = 2001, map_size_in = \"texels\" }}
         materials.wall = {{ type = \"diffuse\", albedo = 1 }}
         materials.glass = {{ type = \"dielectric\", ior = 1.5 }}
         lights = [{{ type = \"point\", position = [6, 0, 0], flux = 1 }}]
         objects = [
             {{ rectangle = {{ center = [-4, 0, 0], edge_u = [0, 2, 0], edge_v = [0, 0, 0.01] }}, material = \"wall\" }},
             {{ box = {{ min = [-0.15, -2, -1], max = [0.15, 2, 1] }}, material = \"glass\", rotate = [0, 0, {degrees}],
                translate = [1, 0, 0] }},
         ]"
    ))
}

/// By how much a ray is displaced that leaves a slab in its old direction, for an angle of refraction.
fn displacement(theta_i: f64, theta_t: f64) -> f64 {
    0.3 * (theta_i - theta_t).sin() / theta_t.cos()
}

#[test]
fn equation_3_refracts_by_tangents_and_exact_refraction_by_sines() {
    for degrees in [5.0, 20.0, 40.0, 60.0, 70.0] {
        let theta = f64::to_radians(degrees);
        let by_tangents = displacement(theta, (theta.tan() / 1.5).atan());
        let by_sines = displacement(theta, (theta.sin() / 1.5).asin());
        for (refraction, expected) in [("printed", by_tangents), ("exact", by_sines)] {
            let map = emit(&slab(refraction, degrees), 1).energy_map(0).unwrap().expect("the wall has a map");
            let all = (0..map.sums.len()).map(|k| (map.irradiance(k)[1], (k % map.width as usize) as f64));
            let (sum, moment) = all.fold((0.0, 0.0), |(sum, moment), (energy, i)| (sum + energy, moment + energy * i));
            // The ray leans toward −y. Equation 2's weights are flat: their centre is half a texel off at most.
            let found = 1.0 - 0.001 * moment / sum;
            assert!((found - expected).abs() < 6e-4, "{refraction}, {degrees}°: {found} m aside, not {expected}");
        }
    }
}

#[test]
fn the_camera_refracts_by_the_same_equation() {
    // Seen through the slab at 60°, the wall's lower half glows up to where one of the two refractions looks.
    let theta = 60f64.to_radians();
    let by_tangents = displacement(theta, (theta.tan() / 1.5).atan());
    let by_sines = displacement(theta, (theta.sin() / 1.5).asin());
    let border = -0.5 * (by_tangents + by_sines);
    let seen = |refraction: &str| {
        let film = render(&scene(&format!(
            "ambient = 1
             camera = {{ position = [6, 0, 0], look_at = [0, 0, 0], vertical_fov = 0.02 }}
             render = {{ width = 8, height = 8, samples = 4, profile = \"paper\", photons = 0 }}
             paper = {{ refraction = \"{refraction}\", transparency = 0.5, map_size = 100 }}
             materials.glow = {{ type = \"phong\", ambient = 1, diffuse = 0, specular = 0, shininess = 1 }}
             materials.glass = {{ type = \"dielectric\", ior = 1.5, tint = 0.8 }}
             lights = [{{ type = \"point\", position = [6, 5, 0], flux = 1 }}]
             objects = [
                 {{ rectangle = {{ center = [-4, {}, 0], edge_u = [0, 2, 0], edge_v = [0, 0, 2] }}, material = \"glow\" }},
                 {{ box = {{ min = [-0.15, -2, -1], max = [0.15, 2, 1] }}, material = \"glass\", rotate = [0, 0, 60],
                    translate = [1, 0, 0] }},
             ]",
            border - 1.0
        )));
        mean(film.radiance.iter().map(|pixel| f64::from(pixel[1])))
    };
    // The object's own colour, (1 − 0.5) · 0.8 of the ambient light; behind it the wall by 0.5 · 0.8 at each of two crossings.
    let (own, behind) = (0.4, 0.16);
    let (printed, exact) = (seen("printed"), seen("exact"));
    assert!((printed - own).abs() < 1e-4, "equation 3 looks past the wall: {printed}");
    assert!((exact - own - behind).abs() < 1e-4, "exact refraction looks at the wall: {exact}");
}

#[test]
fn more_rays_and_more_energy_are_brighter() {
    let ball = |keys: &str, photons: u64| {
        let scene = scene(&format!(
            "camera = {{ position = [0, 1.4, 2.2], look_at = [0, 0.2, 0], vertical_fov = 40 }}
             render = {{ width = 16, height = 16, samples = 8, profile = \"paper\", photons = {photons} }}
             paper = {{ map_size = 20, {keys} }}
             materials.floor = {{ type = \"diffuse\", albedo = 0.5 }}
             materials.glass = {{ type = \"dielectric\", ior = 1.5 }}
             lights = [{{ type = \"sphere\", center = [0.3, 1.2, 0.2], radius = 0.05, flux = 1 }}]
             objects = [
                 {{ rectangle = {{ center = [0, 0, 0], edge_u = [2, 0, 0], edge_v = [0, 0, -2] }}, material = \"floor\" }},
                 {{ sphere = {{ center = [0, 0.4, 0], radius = 0.3 }}, material = \"glass\" }},
             ]"
        ));
        let renderer = emit(&scene, photons);
        let map = renderer.energy_map(0).unwrap().expect("the floor has a map");
        let ledger = renderer.statistics().unwrap().ledgers[0];
        assert_eq!(ledger.residue(), [0; 3]);
        assert_eq!(
            ledger.emitted[0],
            (photons as f64 * 35.0 * ledger.units_per_watt) as i64 * i64::from(keys.is_empty())
                + (photons as f64 * 5.0 * ledger.units_per_watt) as i64 * i64::from(keys == "energy = 5")
        );
        (0..map.sums.len()).map(|texel| map.irradiance(texel)[1]).sum::<f64>()
    };
    let (few, many, weak) = (ball("", 40_000), ball("", 160_000), ball("energy = 5", 40_000));
    assert!((many / few - 4.0).abs() < 0.1, "four times the rays bring {} times the energy", many / few);
    assert!((few / weak - 7.0).abs() < 1e-3, "seven times the energy brings {} times as much", few / weak);
}
