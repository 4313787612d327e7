//! Charts of some shapes: how many, how well they fill their map, how long they take; with a folder, pictures of the maps.
//!
//! ```text
//! cargo run --release -p diacaustic-surface --example charting -- SHAPE MAP_SIZE [FOLDER]
//! ```
//!
//! SHAPE is `sphere`, `knot`, `room`, `teapot`, `scanned`, `rough`, `fan`, `screw`, or a number of triangles of a scanned sphere.

#[path = "../tests/shapes/mod.rs"]
mod shapes;

use std::time::Instant;

use diacaustic_scene::Mesh;
use diacaustic_surface::MapLayout;
use glam::{DVec2, Vec3};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [shape, map_size, folder @ ..] = &arguments[..] else { return Err("charting SHAPE MAP_SIZE [FOLDER]".into()) };
    let mesh = match shape.as_str() {
        "sphere" => Mesh::sphere(Vec3::ZERO, 1.0, 6),
        "knot" => shapes::torus_knot(600, 32),
        "fan" => shapes::fan(1_000_000, 1),
        "screw" => shapes::screw(20_000),
        "room" => shapes::l_room(),
        "teapot" => shapes::teapot(),
        "scanned" => shapes::scanned(180, 0.5),
        "rough" => shapes::scanned(180, 3.0),
        triangles => shapes::scanned((triangles.parse::<f64>()? / 4.0).sqrt().round() as u32, 0.5),
    };
    let triangles = mesh.triangles.len();
    let object = shapes::object(mesh);
    let before = memory("VmRSS");
    let (start, cpu_before) = (Instant::now(), cpu_seconds());
    let layout = MapLayout::new(&object, map_size.parse()?);
    let (time, cpu_time) = (start.elapsed(), cpu_seconds() - cpu_before);
    let texels = f64::from(layout.width) * f64::from(layout.height);
    let surface: f64 = (0..triangles).map(|t| 0.5 * f64::from(object.mesh.double_area_normal(t).length())).sum();
    println!(
        "{triangles} triangles: {} charts in {} × {} texels of {:.3e} m, {:.2} texels for each of area; {:.3} s, \
         {cpu_time:.2} s of processor time, {} MiB more at most",
        layout.chart_count,
        layout.width,
        layout.height,
        layout.metres_per_texel,
        texels / (surface / f64::from(layout.metres_per_texel).powi(2)),
        time.as_secs_f64(),
        memory("VmHWM").saturating_sub(before) / 1024,
    );
    if let [folder] = folder {
        picture(&layout).save(format!("{folder}/{shape}-{map_size}.png"))?;
    }
    Ok(())
}

/// An entry of /proc/self/status, KiB; 0 where there is none.
fn memory(key: &str) -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix(key)?.strip_prefix(':'));
    line.and_then(|line| line.split_whitespace().next()?.parse().ok()).unwrap_or(0)
}

/// Processor time of this process so far, s; 0 where /proc does not say.
fn cpu_seconds() -> f64 {
    let stat = std::fs::read_to_string("/proc/self/stat").unwrap_or_default();
    // User and system time are the 12th and 13th field after the name, in hundredths of a second.
    let fields: Vec<&str> = stat.rsplit(')').next().unwrap_or("").split_whitespace().collect();
    [11, 12].iter().filter_map(|&k| fields.get(k)?.parse::<f64>().ok()).sum::<f64>() / 100.0
}

/// The map's texels, several pixels wide where it is small, in a color for each chart; red where two triangles lie.
fn picture(layout: &MapLayout) -> image::RgbImage {
    let zoom = (1024 / layout.width.max(layout.height)).clamp(1, 16);
    let mut picture = image::RgbImage::new(layout.width * zoom, layout.height * zoom);
    for (corners, &chart) in layout.corners.iter().zip(&layout.charts) {
        let [a, b, c] = corners.map(|p| (p.as_dvec2() + 0.5) * f64::from(zoom));
        let (low, high) = (a.min(b).min(c).floor(), a.max(b).max(c).ceil());
        let turn = (b - a).perp_dot(c - a).signum();
        for y in low.y as u32..(high.y as u32).min(picture.height()) {
            for x in low.x as u32..(high.x as u32).min(picture.width()) {
                let p = DVec2::new(f64::from(x) + 0.5013, f64::from(y) + 0.4987);
                if [(a, b), (b, c), (c, a)].iter().all(|(s, e)| (*e - *s).perp_dot(p - *s) * turn > 0.0) {
                    let pixel = picture.get_pixel_mut(x, y);
                    let color = |k: u32| 70 + (shapes::hashed(3 * chart + k) * 180.0) as u8;
                    pixel.0 = if pixel.0 == [0; 3] { [color(0) / 2, color(1), color(2)] } else { [255, 0, 0] };
                }
            }
        }
    }
    picture
}
