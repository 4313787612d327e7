//! How an object's surface lies on the plane of its energy map.

use diacaustic_scene::{Chart, Mesh, Object};
use glam::{DVec2, Mat3, Vec2, Vec3};

/// The layout of one object's energy map. Texel (i, j) stands at the point (i, j) of the map's plane.
#[derive(Clone, Debug, PartialEq)]
pub struct MapLayout {
    /// Texels along x, at least 2.
    pub width: u32,
    /// Texels along y, at least 2.
    pub height: u32,
    /// 1 for a closed surface, 2 where front and back can both be seen and are kept apart.
    pub layers: u32,
    /// For each triangle of the object's mesh, the places of its corners in [0, width − 1] × [0, height − 1].
    pub corners: Vec<[Vec2; 3]>,
}

impl MapLayout {
    /// Lays out an object's mesh with `map_size` texels (at least 2) along the longer side.
    pub fn new(object: &Object, map_size: u32) -> Self {
        let mesh = &object.mesh;
        let places = match &mesh.chart {
            Chart::Natural(places) => places.clone(),
            Chart::Automatic if !mesh.uvs.is_empty() && !uvs_overlap(mesh) => mesh.uvs.clone(),
            Chart::Automatic => planar_projection(mesh, Mat3::from(object.world_from_object.matrix3)),
        };
        let (low, high) = bounds(&places);
        let extent = (high - low).max(Vec2::splat(f32::MIN_POSITIVE));
        let steps = (map_size.max(2) - 1) as f32;
        let spacing = extent.max_element() / steps;
        let width = ((extent.x / spacing).round() as u32 + 1).max(2);
        let height = ((extent.y / spacing).round() as u32 + 1).max(2);
        let last = Vec2::new((width - 1) as f32, (height - 1) as f32);
        let corners = mesh
            .triangles
            .iter()
            .map(|vertices| vertices.map(|v| ((places[v as usize] - low) / extent * last).clamp(Vec2::ZERO, last)))
            .collect();
        Self { width, height, layers: if mesh.open_edges() == 0 { 1 } else { 2 }, corners }
    }

    /// Texels in all layers.
    pub fn texel_count(&self) -> u64 {
        u64::from(self.width) * u64::from(self.height) * u64::from(self.layers)
    }
}

fn bounds(places: &[Vec2]) -> (Vec2, Vec2) {
    places.iter().fold((Vec2::INFINITY, Vec2::NEG_INFINITY), |(low, high), &p| (low.min(p), high.max(p)))
}

/// The vertices seen along the direction in which the mesh, as placed, is thinnest of the three axes.
///
/// Surfaces that lie one behind the other share texels; general charts keep them apart.
fn planar_projection(mesh: &Mesh, linear: Mat3) -> Vec<Vec2> {
    let placed: Vec<Vec3> = mesh.positions.iter().map(|&p| linear * p).collect();
    let (low, high) =
        placed.iter().fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(low, high), &p| (low.min(p), high.max(p)));
    match (high - low).min_position() {
        0 => placed.iter().map(|p| Vec2::new(p.y, p.z)).collect(),
        1 => placed.iter().map(|p| Vec2::new(p.x, p.z)).collect(),
        _ => placed.iter().map(|p| Vec2::new(p.x, p.y)).collect(),
    }
}

/// Points along each side of the grid on which [`uvs_overlap`] looks for overlap.
const OVERLAP_GRID: usize = 512;

/// Whether a mesh's texture coordinates cover some place twice, or fold a triangle with an area to none.
///
/// Looks at a grid of points, so that an overlap smaller than about a thousandth of the covered plane is let pass.
pub fn uvs_overlap(mesh: &Mesh) -> bool {
    let (low, high) = bounds(&mesh.uvs);
    let extent = high - low;
    let covers_plane = extent.min_element() > 0.0;
    if !covers_plane {
        return true;
    }
    let mut covers = vec![0u8; OVERLAP_GRID * OVERLAP_GRID];
    for (number, vertices) in mesh.triangles.iter().enumerate() {
        let corners = vertices.map(|v| ((mesh.uvs[v as usize] - low) / extent).as_dvec2() * OVERLAP_GRID as f64);
        let folded = (corners[1] - corners[0]).perp_dot(corners[2] - corners[0]).abs() < 1e-9;
        if folded && mesh.double_area_normal(number) != Vec3::ZERO {
            return true;
        }
        cover(&mut covers, corners);
    }
    let covered = covers.iter().filter(|&&count| count > 0).count();
    let twice = covers.iter().filter(|&&count| count > 1).count();
    twice * 1000 > covered
}

/// Counts a triangle at the grid points inside it.
fn cover(covers: &mut [u8], [a, b, c]: [DVec2; 3]) {
    // An irrational-looking offset keeps points off edges at round coordinates.
    let offset = DVec2::new(0.381_966, 0.618_034);
    let low = (a.min(b).min(c) - offset).ceil().max(DVec2::ZERO);
    let high = (a.max(b).max(c) - offset).floor().min(DVec2::splat(OVERLAP_GRID as f64 - 1.0));
    let orientation = (b - a).perp_dot(c - a).signum();
    for y in low.y as usize..(high.y + 1.0).max(0.0) as usize {
        for x in low.x as usize..(high.x + 1.0).max(0.0) as usize {
            let p = DVec2::new(x as f64, y as f64) + offset;
            let inside = [(a, b), (b, c), (c, a)].iter().all(|(s, e)| (*e - *s).perp_dot(p - *s) * orientation > 0.0);
            if inside {
                let count = &mut covers[y * OVERLAP_GRID + x];
                *count = count.saturating_add(1);
            }
        }
    }
}
