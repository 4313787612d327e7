//! Shapes on which photons fall evenly: how uneven their maps show it, and a picture.
//!
//! ```text
//! cargo run --release -p diacaustic-surface --example even_light -- SHAPE MAP_SIZE [PHOTONS A TEXEL] [PICTURE.png]
//! ```
#[path = "../tests/even_light/mod.rs"]
mod even_light;
#[path = "../tests/shapes/mod.rs"]
mod shapes;

use std::time::Instant;

use diacaustic_scene::Mesh;
use diacaustic_surface::{MapLayout, Welds};
use even_light::{Surface, read};
use glam::{DVec3, Mat3, Vec3};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [shape, map_size, rest @ ..] = &arguments[..] else {
        return Err("even_light SHAPE MAP_SIZE [PHOTONS] [PICTURE]".into());
    };
    let mesh = mesh(shape)?;
    println!("{shape}, {} triangles", mesh.triangles.len());
    let object = shapes::object(mesh);
    let surface = Surface::new(&object, MapLayout::new(&object, map_size.parse()?));
    let per_texel: f64 = rest.first().map_or(Ok(16.0), |text| text.parse())?;
    let photons = (per_texel * surface.whole_texels()) as u32;
    let start = Instant::now();
    let welds = surface.welds();
    println!(
        "{} × {} × {}: {} charts, {} cells; {:.0} texels of area, {} welds in {:.3} s",
        surface.layout.width,
        surface.layout.height,
        surface.layout.layers,
        surface.layout.chart_count,
        surface.layout.cell_count,
        surface.whole_texels(),
        welds.welds.len(),
        start.elapsed().as_secs_f64()
    );
    sizes(&welds);
    let lit = surface.lit_evenly(photons);
    for (name, welds) in [("as it is", &Welds::default()), ("welded", &welds)] {
        let shown = surface.shown(&lit, welds);
        for (unit, by_density) in [("flat", false), ("as dense", true)] {
            let [inside, border, cells] = surface.unevenness(photons, &shown, POINTS, by_density);
            println!(
                "{name}, over {unit} texels: {:.3} inside, {:.3} ({:.0} %) at borders, {:.3} ({:.1} %) in cells; most {:.1}, {:.1}, {:.1}",
                inside.mean(),
                border.mean(),
                border.places / (POINTS as f64 / 100.0),
                cells.mean(),
                cells.places / (POINTS as f64 / 100.0),
                inside.most,
                border.most,
                cells.most
            );
        }
        if let (Some(path), true) = (rest.get(1), name == "welded") {
            picture(&surface, &shown).save(path)?;
        }
    }
    Ok(())
}

/// How many texels welds have.
fn sizes(welds: &Welds) {
    let mut sizes: Vec<usize> = welds.welds.iter().map(|weld| weld.sources.len()).collect();
    sizes.sort_unstable();
    let at = |share: f64| sizes.get((share * sizes.len() as f64) as usize).copied().unwrap_or(0);
    let mean = sizes.iter().sum::<usize>() as f64 / sizes.len() as f64;
    println!(
        "texels a weld: mean {mean:.2}, median {}, 90 % {}, 99 % {}, most {:?}",
        at(0.5),
        at(0.9),
        at(0.99),
        sizes.last()
    );
}

fn mesh(shape: &str) -> Result<Mesh, Box<dyn std::error::Error>> {
    if let Some(path) = shape.strip_prefix("obj:") {
        let mut mesh = diacaustic_scene::load_obj(path.as_ref(), &diacaustic_scene::MeshOptions::default())?.mesh;
        mesh.chart = diacaustic_scene::Chart::Automatic;
        return Ok(mesh);
    }
    if let Some(text) = shape.strip_prefix("random:") {
        return Ok(shapes::random_mesh(text.parse()?));
    }
    Ok(match shape {
        "sphere" => Mesh::sphere(Vec3::ZERO, 1.0, 5),
        "knot" => shapes::torus_knot(300, 16),
        "room" => shapes::l_room(),
        "teapot" => shapes::teapot(),
        "scanned" => shapes::scanned(180, 0.5),
        "rough" => shapes::scanned(180, 3.0),
        "bumpy" => shapes::scanned(45, 0.5),
        "fan" => shapes::fan(1500, 1),
        "screw" => shapes::screw(40),
        triangles => shapes::scanned((triangles.parse::<f64>()? / 4.0).sqrt().round() as u32, 0.5),
    })
}

/// Places at which a map is read.
const POINTS: u32 = 1_000_000;
/// Pixels along a side of the picture.
const SIDE: usize = 900;
/// Relative deviation that is black or white.
const CONTRAST: f64 = 0.5;

/// The surface from above and aside, seen from infinitely far.
fn picture(surface: &Surface, shown: &[f64]) -> image::RgbImage {
    let turn = Mat3::from_rotation_x(0.5) * Mat3::from_rotation_y(0.6);
    let corners = |k: usize| surface.triangles[k].corners.map(|p| (turn * p).as_dvec3());
    let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    for p in (0..surface.triangles.len()).flat_map(corners) {
        (low, high) = (low.min(p), high.max(p));
    }
    let scale = (SIDE as f64 - 20.0) / (high - low).truncate().max_element();
    let mut nearest = vec![(f64::NEG_INFINITY, 0.0); SIDE * SIDE];
    for k in 0..surface.triangles.len() {
        let [a, b, c] = corners(k).map(|p| (p - 0.5 * (low + high)) * scale + DVec3::new(0.5, 0.5, 0.0) * SIDE as f64);
        let whole = (b - a).truncate().perp_dot((c - a).truncate());
        let layer = u32::from(whole < 0.0).min(surface.layout.layers - 1);
        let (first, last) = (a.min(b).min(c).floor(), a.max(b).max(c).ceil());
        for y in first.y as usize..(last.y as usize).min(SIDE) {
            for x in first.x as usize..(last.x as usize).min(SIDE) {
                let p = DVec3::new(x as f64 + 0.5, y as f64 + 0.5, 0.0) - a;
                let v = (b - a).truncate().perp_dot(p.truncate()) / whole;
                let u = p.truncate().perp_dot((c - a).truncate()) / whole;
                let depth = a.z + u * (b - a).z + v * (c - a).z;
                if u >= 0.0 && v >= 0.0 && u + v <= 1.0 && depth > nearest[y * SIDE + x].0 {
                    nearest[y * SIDE + x] = (depth, read(&surface.deposit(k, layer, [u as f32, v as f32]), shown));
                }
            }
        }
    }
    image::RgbImage::from_fn(SIDE as u32, SIDE as u32, |x, y| {
        let (depth, value) = nearest[(SIDE - 1 - y as usize) * SIDE + x as usize];
        let gray = (127.5 + 127.5 * (value - 1.0) / CONTRAST).clamp(0.0, 255.0) as u8;
        image::Rgb(if depth.is_finite() { [gray; 3] } else { [40, 60, 90] })
    })
}
