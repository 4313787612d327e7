//! Nested, overlapping and touching dielectrics, and cameras and lights inside them, against known answers.

use std::f64::consts::PI;

use diacaustic::Film;
use diacaustic_tests::{emit, render, scene};

fn worst_pixel(film: &Film) -> f64 {
    film.radiance.iter().flatten().map(|value| (f64::from(*value) - 1.0).abs()).fold(0.0, f64::max)
}

fn mean(film: &Film) -> f64 {
    film.radiance.iter().map(|pixel| f64::from(pixel[1])).sum::<f64>() / film.radiance.len() as f64
}

/// Objects of flat facets in uniform radiance 1, from outside unless the camera is placed.
fn furnace(camera: &str, materials: &str, objects: &str) -> Film {
    render(&scene(&format!(
        "background = 1
         camera = {{ {camera} }}
         render = {{ width = 32, height = 32, samples = 64, photons = 0, max_depth = 1000 }}
         {materials}
         objects = [{objects}]"
    )))
}

const OUTSIDE: &str = "position = [0.3, 0.9, 3], look_at = [0, 0, 0], vertical_fov = 30";

#[test]
fn furnace_of_nested_boxes() {
    let film = furnace(
        OUTSIDE,
        "materials.outer = { type = \"dielectric\", ior = 1.5 }
         materials.inner = { type = \"dielectric\", ior = 1.33, priority = 1 }
         materials.bubble = { type = \"dielectric\", ior = 1, priority = 2 }",
        "{ box = { min = [-0.6, -0.6, -0.6], max = [0.6, 0.6, 0.6] }, material = \"outer\" },
         { box = { min = [-0.3, -0.3, -0.3], max = [0.3, 0.3, 0.3] }, material = \"inner\", rotate = [20, 30, 40] },
         { box = { min = [-0.1, -0.1, -0.1], max = [0.1, 0.1, 0.1] }, material = \"bubble\", rotate = [50, 10, 0] }",
    );
    assert!(worst_pixel(&film) < 2e-3, "a pixel is off by {}", worst_pixel(&film));
}

#[test]
fn furnace_of_overlapping_boxes() {
    // Overlapping volumes of other indices and priorities, and two shells of one material.
    let film = furnace(
        OUTSIDE,
        "materials.glass = { type = \"dielectric\", ior = 1.5, priority = 1 }
         materials.drink = { type = \"dielectric\", ior = 1.33 }",
        "{ box = { min = [-0.6, -0.6, -0.3], max = [0.2, 0.4, 0.3] }, material = \"glass\", rotate = [10, 0, 5] },
         { box = { min = [-0.3, -0.3, -0.5], max = [0.6, 0.6, 0.5] }, material = \"drink\", rotate = [0, 20, 0] },
         { box = { min = [-0.4, -0.2, -0.2], max = [0.5, 0.2, 0.2] }, material = \"glass\", rotate = [0, 5, 30] }",
    );
    assert!(worst_pixel(&film) < 2e-3, "a pixel is off by {}", worst_pixel(&film));
}

#[test]
fn furnace_from_inside() {
    // Near the centre of a ball every ray leaves: none is trapped. Radiance is shown as behind a window of the camera's own.
    let film = furnace(
        "position = [0.02, 0.03, 0.01], look_at = [0, 0, -1], vertical_fov = 90",
        "materials.glass = { type = \"dielectric\", ior = 1.5 }
         materials.water = { type = \"dielectric\", ior = 1.33, priority = 1 }",
        "{ sphere = { center = [0, 0, 0], radius = 1 }, material = \"glass\" },
         { sphere = { center = [0, 0, 0], radius = 0.5 }, material = \"water\" }",
    );
    assert!(worst_pixel(&film) < 2e-3, "a pixel is off by {}", worst_pixel(&film));
}

#[test]
fn furnace_of_smooth_balls_in_each_other() {
    let film = furnace(
        OUTSIDE,
        "materials.glass = { type = \"dielectric\", ior = 1.5 }
         materials.water = { type = \"dielectric\", ior = 1.33, priority = 1 }",
        "{ sphere = { center = [0, 0, 0], radius = 0.6, subdivisions = 8 }, material = \"glass\" },
         { sphere = { center = [0.1, 0, 0], radius = 0.3, subdivisions = 7 }, material = \"water\" }",
    );
    assert!((mean(&film) - 1.0).abs() < 5e-4, "mean {}", mean(&film));
    let off = film.radiance.iter().filter(|pixel| (pixel[1] - 1.0).abs() > 2e-3).count();
    assert!(off <= 8, "{off} of 1024 pixels are not 1");
}

#[test]
fn touching_boxes_leave_no_gap() {
    // Water exactly in a glass trough, ice exactly on its ground, all on a table: the furnace must not show where they touch.
    let film = furnace(
        OUTSIDE,
        "materials.glass = { type = \"dielectric\", ior = 1.5, priority = 2 }
         materials.ice = { type = \"dielectric\", ior = 1.31, priority = 1 }
         materials.water = { type = \"dielectric\", ior = 1.33 }",
        "{ box = { min = [-0.6, -0.6, -0.6], max = [0.6, -0.4, 0.6] }, material = \"glass\" },
         { box = { min = [-0.6, -0.4, -0.6], max = [0.6, 0.2, 0.6] }, material = \"water\" },
         { box = { min = [-0.2, -0.4, -0.2], max = [0.2, 0.2, 0.2] }, material = \"ice\" }",
    );
    assert!(worst_pixel(&film) < 2e-3, "a pixel is off by {}", worst_pixel(&film));
}

/// Share of radiance 1 that comes up through the layers of `objects` over a glow, seen from straight above.
fn seen_through(materials: &str, objects: &str) -> f64 {
    mean(&render(&scene(&format!(
        "ambient = 1
         camera = {{ position = [0, 9, 0], look_at = [0, 0, 0], up = [0, 0, -1], vertical_fov = 0.02 }}
         render = {{ width = 64, height = 64, samples = 64, photons = 0, max_depth = 1000 }}
         materials.glow = {{ type = \"phong\", ambient = 1, diffuse = 0, specular = 0, shininess = 1 }}
         {materials}
         objects = [
             {{ rectangle = {{ center = [0, -1, 0], edge_u = [4, 0, 0], edge_v = [0, 0, -4] }}, material = \"glow\" }},
             {objects}]"
    ))))
}

/// Share that goes through parallel interfaces of these reflectances, with all reflections between them.
fn through(interfaces: &[f64]) -> f64 {
    // Incoherent layers add their (1 − T)/T.
    1.0 / (1.0 + interfaces.iter().map(|f| f / (1.0 - f)).sum::<f64>())
}

fn normal_reflectance(a: f64, b: f64) -> f64 {
    ((a - b) / (a + b)).powi(2)
}

#[test]
fn layers_of_touching_dielectrics() {
    let f = normal_reflectance;
    let expected = through(&[f(1.0, 1.33), f(1.33, 1.7), f(1.7, 1.0)]);
    let materials = "materials.a = { type = \"dielectric\", ior = 1.7, priority = 1 }
         materials.b = { type = \"dielectric\", ior = 1.33 }";
    let lower = "{ box = { min = [-2, -0.5, -2], max = [2, 0, 2] }, material = \"a\" }";
    for (case, upper_from) in [("touching", 0.0), ("overlapping", -0.2)] {
        let upper = format!("{{ box = {{ min = [-2, {upper_from}, -2], max = [2, 0.5, 2] }}, material = \"b\" }}");
        let found = seen_through(materials, &format!("{lower}, {upper}"));
        assert!((found - expected).abs() < 1e-3, "{case}: {found}, known {expected}");
    }
}

#[test]
fn the_higher_priority_fills_the_place() {
    // A slab of 0.6 m, of which a rod of another absorption takes a part: which part, its priority says.
    let seen = |priority: i32| {
        seen_through(
            &format!(
                "materials.slab = {{ type = \"dielectric\", ior = 1.4, absorption = 1, priority = 0 }}
                 materials.rod = {{ type = \"dielectric\", ior = 1.4, absorption = 3, priority = {priority} }}"
            ),
            "{ box = { min = [-2, -0.6, -2], max = [2, 0, 2] }, material = \"slab\" },
             { box = { min = [-1, -0.4, -1], max = [1, -0.2, 1] }, material = \"rod\" }",
        )
    };
    let f = normal_reflectance(1.0, 1.4);
    let slab = |depth: f64| {
        let decay = (-depth).exp();
        (1.0 - f).powi(2) * decay / (1.0 - (f * decay).powi(2))
    };
    // The rod's boundary is there even at equal indices, and reflects nothing.
    for (priority, depth) in [(1, 0.4 + 0.2 * 3.0), (-1, 0.6)] {
        let (found, expected) = (seen(priority), slab(depth));
        assert!((found - expected).abs() < 1e-3, "priority {priority}: {found}, known {expected}");
    }
}

#[test]
fn thin_wall_passes_what_a_sheet_passes() {
    let f = normal_reflectance(1.0, 1.5);
    let found = seen_through(
        "materials.pane = { type = \"thin_walled\", ior = 1.5, tint = 0.9 }",
        "{ rectangle = { center = [0, 0, 0], edge_u = [4, 0, 0], edge_v = [0, 0, -4] }, material = \"pane\" }",
    );
    let expected = 0.9 * (1.0 - f) / (1.0 + f);
    assert!((found - expected).abs() < 1e-3, "{found}, known {expected}");
}

/// A pool of water over a floor at depth 1 m, lit by parallel light, which black walls keep from entering by its sides.
fn pool(camera: &str, direction: &str) -> String {
    format!(
        "camera = {{ {camera} }}
         render = {{ width = 16, height = 16, samples = 16, photons = 1_048_576, map_size = 65, max_bounces = 0 }}
         materials.floor = {{ type = \"diffuse\", albedo = 1 }}
         materials.black = {{ type = \"diffuse\", albedo = 0 }}
         materials.water = {{ type = \"dielectric\", substance = \"water\" }}
         lights = [{{ type = \"directional\", direction = {direction}, irradiance = 10 }}]
         objects = [
             {{ rectangle = {{ center = [0, 0, 0], edge_u = [1, 0, 0], edge_v = [0, 0, -1] }}, material = \"floor\" }},
             {{ rectangle = {{ center = [-0.95, -0.5, 0], edge_u = [0, 2.98, 0], edge_v = [0, 0, 4] }}, material = \"black\" }},
             {{ rectangle = {{ center = [0.95, -0.5, 0], edge_u = [0, 2.98, 0], edge_v = [0, 0, 4] }}, material = \"black\" }},
             {{ box = {{ min = [-1, -0.1, -1], max = [1, 1, 1] }}, material = \"water\" }},
         ]"
    )
}

/// Unpolarised reflectance from outside at an angle of incidence, radians.
fn fresnel(angle: f64, n: f64) -> f64 {
    let cos_i = angle.cos();
    let cos_t = (1.0 - (angle.sin() / n).powi(2)).sqrt();
    let (s, p) = ((cos_i - n * cos_t) / (cos_i + n * cos_t), (n * cos_i - cos_t) / (n * cos_i + cos_t));
    0.5 * (s * s + p * p)
}

#[test]
fn flat_water_lets_light_to_its_floor() {
    // E = E₀ cos θ (1 − F); what the floor sends back is not counted at max_bounces = 0.
    for (direction, angle) in [("[0, -1, 0]", 0.0), ("[0.6, -0.8, 0]", 0.6f64.asin())] {
        let scene =
            scene(&pool("position = [0, 5, 0], look_at = [0, 0, 0], up = [0, 0, -1], vertical_fov = 5", direction));
        let map = emit(&scene, 1 << 20).energy_map(0).unwrap().expect("the floor is a receiver");
        // The middle of the map, off its edges.
        let texels = (16..48).flat_map(|y| (16..48).map(move |x| y * 65 + x));
        let found = texels.map(|texel| map.irradiance(texel).y).sum::<f64>() / 1024.0;
        let expected = 10.0 * angle.cos() * (1.0 - fresnel(angle, 1.333));
        assert!((found / expected - 1.0).abs() < 5e-3, "{direction}: {found} W/m², known {expected}");
    }
}

#[test]
fn camera_under_water_sees_the_floor_as_bright_as_it_is() {
    // Radiance of the floor within the water is E/π, shown divided by n².
    let camera = "position = [0, 0.5, 0], look_at = [0, 0, 0], up = [0, 0, -1], vertical_fov = 20";
    let found = mean(&render(&scene(&pool(camera, "[0, -1, 0]"))));
    let expected = 10.0 * (1.0 - fresnel(0.0, 1.333)) / PI / (1.333 * 1.333);
    assert!((found / expected - 1.0).abs() < 5e-3, "{found}, known {expected}");
}

#[test]
fn light_in_absorbing_water() {
    // A point light under water: the floor below has Φ cos θ/(4πd²) e^(−σd) by next-event estimation within the medium.
    let found = mean(&render(&scene(
        "camera = { position = [0, 0.5, 0], look_at = [0, 0, 0], up = [0, 0, -1], vertical_fov = 0.1 }
         render = { width = 16, height = 16, samples = 64, photons = 0, max_bounces = 0 }
         materials.floor = { type = \"diffuse\", albedo = 1 }
         materials.water = { type = \"dielectric\", ior = 1.333, absorption = 0.7 }
         lights = [{ type = \"point\", position = [0.3, 0.4, 0], flux = 10 }]
         objects = [
             { rectangle = { center = [0, 0, 0], edge_u = [1, 0, 0], edge_v = [0, 0, -1] }, material = \"floor\" },
             { box = { min = [-4, -0.5, -4], max = [4, 1, 4] }, material = \"water\" },
         ]",
    )));
    let seen_from = (-0.7f64 * 0.5).exp() / (1.333 * 1.333);
    let expected = 10.0 / (4.0 * PI * 0.25) * 0.8 * (-0.7f64 * 0.5).exp() / PI * seen_from;
    assert!((found / expected - 1.0).abs() < 5e-3, "{found}, known {expected}");
}

#[test]
fn apparent_depth() {
    // A mark at depth d, seen from nearly straight above, seems to lie at d/n.
    let n = 1.333;
    let shifted = |objects: &str| {
        let mut scene = scene(&format!(
            "ambient = 1
             camera = {{ position = [1, 3, 0], look_at = [1, 0, 0], up = [0, 0, -1], vertical_fov = 0.02 }}
             render = {{ width = 1024, height = 16, samples = 16, photons = 0 }}
             materials.glow = {{ type = \"phong\", ambient = 1, diffuse = 0, specular = 0, shininess = 1 }}
             materials.water = {{ type = \"dielectric\", ior = {n} }}
             objects = [
                 {{ rectangle = {{ center = [6.02, 0, 0], edge_u = [10.0, 0, 0], edge_v = [0, 0, -4] }}, material = \"glow\" }},
                 {objects}]"
        ));
        scene.settings.max_bounces = 0;
        let film = render(&scene);
        film.radiance[..1024].iter().filter(|pixel| pixel[1] < 0.5).count() as f64 - 512.0
    };
    // The edge stands 2 cm off the axis: x/(distance to it), of which 1 m is water.
    let (bare, under) =
        (shifted(""), shifted("{ box = { min = [-4, -0.5, -4], max = [4, 1, 4] }, material = \"water\" }"));
    let ratio = bare / under;
    let expected = (2.0 + 1.0 / n) / 3.0;
    assert!((ratio - expected).abs() < 5e-3, "bare {bare}, under water {under}: {ratio}, known {expected}");
}
