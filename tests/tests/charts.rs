//! Photons on surfaces that are divided into charts.

use std::{f64::consts::PI, sync::Arc};

use diacaustic_scene::{LightKind, Mesh, RadianceMap, Scene};
use diacaustic_tests::{emit, scene};
use glam::{Vec2, Vec3};

/// Radiance from everywhere.
const RADIANCE: f32 = 2.0;

/// An object under even light, which comes through a shell of glass that bends nothing.
fn in_a_shell(object: &str, mesh: Mesh) -> Scene {
    let mut scene = scene(&format!(
        "camera = {{ position = [0, 0, 6], look_at = [0, 0, 0], vertical_fov = 40 }}
         render = {{ width = 16, height = 16, guiding = false }}
         materials.air = {{ type = \"dielectric\", ior = 1 }}
         materials.plaster = {{ type = \"diffuse\", albedo = 0.5 }}
         lights = [{{ type = \"point\", position = [0, 4, 0], flux = 1 }}]
         objects = [
             {{ sphere = {{ center = [0, 0, 0], radius = 1.3, subdivisions = 5 }}, material = \"air\" }},
             {{ {object}, material = \"plaster\" }},
         ]"
    ));
    let map = RadianceMap { width: 4, height: 2, texels: vec![Vec3::splat(RADIANCE); 8] };
    scene.lights[0].kind = LightKind::Environment { map: map.into(), rotate: 0.0, scale: Vec3::ONE };
    scene.objects[1].mesh = Arc::new(mesh);
    scene
}

/// A convex body receives π times the radiance everywhere: at the borders of charts as inside, and as evenly.
#[test]
fn a_convex_body_under_even_light_is_lit_evenly() {
    // Flat facets, so that no flux goes to interpolated normals.
    let mesh = Mesh { normals: Vec::new(), uvs: Vec::new(), ..Mesh::sphere(Vec3::ZERO, 1.0, 5) };
    let object =
        "sphere = { center = [0, 0, 0], radius = 1 }, scale = [1.2, 0.5, 0.8], rotate = [20, 30, 0], map_size = 96";
    let renderer = emit(&in_a_shell(object, mesh), 1_000_000);
    let layout = renderer.map_layout(1).unwrap().unwrap();
    assert!(layout.chart_count > 4 && layout.width.max(layout.height) <= 96, "{} charts", layout.chart_count);
    let ledger = renderer.statistics().unwrap().ledgers[0];
    assert_eq!(ledger.residue(), [0; 3]);
    let map = renderer.energy_map(1).unwrap().unwrap();
    assert_eq!(map.sums.iter().map(|sum| sum[1]).sum::<i64>(), ledger.deposited[1]);

    let whole = f64::from(layout.metres_per_texel).powi(2);
    let expected = PI * f64::from(RADIANCE);
    let border = near_borders(layout);
    let mut unevenness = Vec::new();
    for is_border in [false, true] {
        // Texels that hold enough surface to be looked at.
        let is_looked_at = |t: &usize| border[*t] == is_border && map.areas[*t] > 0.1 * whole;
        let texels: Vec<usize> = (0..map.areas.len()).filter(is_looked_at).collect();
        let (flux, area) =
            texels.iter().fold((0.0, 0.0), |(flux, area), &t| (flux + map.flux(t).y, area + map.areas[t]));
        let irradiance = flux / area;
        println!("{} texels: {irradiance} W/m² of {expected}", texels.len());
        assert!(texels.len() > 300);
        assert!((irradiance / expected - 1.0).abs() < 0.01, "{irradiance} W/m², known {expected}");
        // The squared deviation goes with the inverse area.
        let square = |&t: &usize| (map.irradiance(t).y / expected - 1.0).powi(2) * map.areas[t] / whole;
        unevenness.push(texels.iter().map(square).sum::<f64>() / texels.len() as f64);
    }
    println!("mean squared deviation of a whole texel inside and at borders: {unevenness:?}");
    assert!(unevenness[0] < 0.05 && unevenness[1] < 1.3 * unevenness[0], "{unevenness:?}");
}

/// Whether each texel's surroundings are not all of one chart.
fn near_borders(layout: &diacaustic::MapLayout) -> Vec<bool> {
    let (width, height) = (layout.width as usize, layout.height as usize);
    // Points of a fine grid that are covered, per texel's square.
    let mut covered = vec![0u32; width * height];
    for corners in &layout.corners {
        let [a, b, c] = *corners;
        let (low, high) = (a.min(b).min(c), a.max(b).max(c));
        let turn = (b - a).perp_dot(c - a).signum();
        for y in (4.0 * low.y) as u32..=(4.0 * high.y) as u32 {
            for x in (4.0 * low.x) as u32..=(4.0 * high.x) as u32 {
                let p = (Vec2::new(x as f32, y as f32) + Vec2::new(0.503, 0.497)) / 4.0;
                if [(a, b), (b, c), (c, a)].iter().all(|(s, e)| (*e - *s).perp_dot(p - *s) * turn > 0.0) {
                    covered[(p.y + 0.5) as usize * width + (p.x + 0.5) as usize] += 1;
                }
            }
        }
    }
    let is_whole = |x: usize, y: usize| x < width && y < height && covered[y * width + x] >= 16;
    let around =
        |t: usize| (0..9).all(|k| is_whole((t % width + k % 3).wrapping_sub(1), (t / width + k / 3).wrapping_sub(1)));
    (0..width * height).map(|t| !around(t)).collect()
}
