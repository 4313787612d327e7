//! How an object's surface lies on the plane of its energy map.

mod absorbing;
mod atlas;
mod cells;
mod check;
mod facets;
mod flattening;
mod growing;
mod overlap;
mod packing;
mod patches;
mod uvs;

use diacaustic_scene::{Chart, Mesh, Object};
use glam::{Mat3, Vec2};

use self::{
    atlas::{Atlas, Placed},
    facets::Facets,
};

pub use self::uvs::check_map_uvs;
use crate::texel_area::TexelChart;

/// The layout of one object's energy map. Texel (i, j) stands at the point (i, j) of the map's plane.
///
/// On a surface divided into charts, the bilinear footprints of two charts never share a texel: places of different charts are more
/// than a texel apart along x or y. Where texels are made 2ⁿ times as wide after the layout, that distance is 2⁻ⁿ of theirs, and charts
/// may share texels along their borders; where they are made narrower, it holds all the more.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MapLayout {
    /// Texels along x, at least 2.
    pub width: u32,
    /// Texels along y, at least 2.
    pub height: u32,
    /// 1 for a closed surface, 2 where front and back can both be seen and are kept apart.
    pub layers: u32,
    /// For each triangle of the object's mesh, the places of its corners in [0, width − 1] × [0, height − 1].
    pub corners: Vec<[Vec2; 3]>,
    /// For each triangle of the object's mesh, the number of its chart.
    pub charts: Vec<u32>,
    /// Charts.
    pub chart_count: u32,
    /// The last so many charts are cells, in which pieces too small for a chart of their own lie on one another.
    pub cell_count: u32,
    /// Width of a texel on the surface in the world, metres; the mean over the surface where charts are not metric.
    pub metres_per_texel: f32,
}

impl MapLayout {
    /// Lays out an object's mesh with `map_size` texels (at least 2) along the longer side. A map too small to hold each of the
    /// surface's charts becomes larger than that.
    pub fn new(object: &Object, map_size: u32) -> Self {
        let map_size = map_size.max(2);
        match given_places(&object.mesh) {
            Some(places) => Self::of_places(object, places, |extent| extent.max_element() / (map_size - 1) as f32),
            None => charts_within(object, map_size),
        }
    }

    /// Lays out an object's mesh with texels that are `metres` wide on the surface in the world; charts with wider ones where the map would
    /// have more than about 10⁵ along a side, which is what single precision tells apart.
    pub fn with_texel_width(object: &Object, metres: f32) -> Self {
        let metres = metres.max(f32::MIN_POSITIVE);
        match given_places(&object.mesh) {
            Some(places) => {
                let unit = metres_per_unit(object, |vertex| places[vertex as usize]);
                Self::of_places(object, places, |_| (f64::from(metres) / unit) as f32)
            }
            None => {
                let facets = Facets::new(object);
                let side = (facets.total_area() / FILL).sqrt().max(LONGEST);
                let texel = (f64::from(metres) / facets.metres).max(side / LARGEST_SIDE);
                let atlas = Atlas::new(&facets, texel);
                Self::of_charts(&facets, &atlas, atlas.place(&facets, texel))
            }
        }
    }

    /// A map on which the vertices of a mesh have given places, with a texel for each `spacing` of the places' extent.
    fn of_places(object: &Object, places: &[Vec2], spacing: impl Fn(Vec2) -> f32) -> Self {
        let mesh = &object.mesh;
        let (low, high) = match mesh.chart {
            Chart::Uvs => unit_square_or_more(bounds(places)),
            _ => bounds(places),
        };
        let extent = (high - low).max(Vec2::splat(f32::MIN_POSITIVE));
        let spacing = spacing(extent).max(f32::MIN_POSITIVE);
        let width = ((extent.x / spacing).round() as u32).saturating_add(1).max(2);
        let height = ((extent.y / spacing).round() as u32).saturating_add(1).max(2);
        let last = Vec2::new((width - 1) as f32, (height - 1) as f32);
        let place = |v: u32| ((places[v as usize] - low) / extent * last).clamp(Vec2::ZERO, last);
        let corners = mesh.triangles.iter().map(|vertices| vertices.map(place)).collect();
        let (charts, chart_count) = islands(mesh);
        Self {
            width,
            height,
            layers: if mesh.open_edges() == 0 { 1 } else { 2 },
            corners,
            charts,
            chart_count,
            cell_count: 0,
            metres_per_texel: metres_per_unit(object, place) as f32,
        }
    }

    fn of_charts(facets: &Facets<'_>, atlas: &Atlas, placed: Placed) -> Self {
        Self {
            width: placed.size.x,
            height: placed.size.y,
            layers: if facets.is_closed { 1 } else { 2 },
            corners: placed.corners,
            charts: atlas.chart_of.clone(),
            chart_count: atlas.frames.len() as u32,
            cell_count: atlas.cells as u32,
            metres_per_texel: (placed.texel * facets.metres) as f32,
        }
    }

    /// The chart of a triangle of the object's mesh.
    pub(crate) fn chart_of(&self, triangle: u32) -> TexelChart {
        match self.charts.get(triangle as usize).copied().unwrap_or(0) {
            cell if cell + self.cell_count >= self.chart_count && self.cell_count > 0 => TexelChart::Cell(cell),
            chart => TexelChart::One(chart),
        }
    }

    /// Texels in all layers.
    pub fn texel_count(&self) -> u64 {
        u64::from(self.width) * u64::from(self.height) * u64::from(self.layers)
    }
}

/// The places of a mesh's vertices, where the mesh says them.
fn given_places(mesh: &Mesh) -> Option<&[Vec2]> {
    match &mesh.chart {
        Chart::Natural(places) => Some(places),
        Chart::Uvs => Some(mesh.map_places()),
        Chart::Automatic => None,
    }
}

/// For each triangle the number of the set of triangles with vertices in common that it belongs to, and how many there are.
fn islands(mesh: &Mesh) -> (Vec<u32>, u32) {
    fn root(parents: &mut [u32], mut vertex: u32) -> u32 {
        while parents[vertex as usize] != vertex {
            parents[vertex as usize] = parents[parents[vertex as usize] as usize];
            vertex = parents[vertex as usize];
        }
        vertex
    }
    let mut parents: Vec<u32> = (0..mesh.positions.len() as u32).collect();
    for [a, b, c] in &mesh.triangles {
        for (one, other) in [(a, b), (b, c)] {
            let (one, other) = (root(&mut parents, *one), root(&mut parents, *other));
            parents[one.max(other) as usize] = one.min(other);
        }
    }
    let mut numbers = vec![u32::MAX; mesh.positions.len()];
    let mut count = 0;
    let mut number = |[vertex, ..]: &[u32; 3]| {
        let number = &mut numbers[root(&mut parents, *vertex) as usize];
        if *number == u32::MAX {
            *number = count;
            count += 1;
        }
        *number
    };
    let charts = mesh.triangles.iter().map(&mut number).collect();
    (charts, count)
}

fn bounds(places: &[Vec2]) -> (Vec2, Vec2) {
    places.iter().fold((Vec2::INFINITY, Vec2::NEG_INFINITY), |(low, high), &p| (low.min(p), high.max(p)))
}

/// The unit square if it holds what lies between two corners, for a lightmap fills it; else the two corners.
fn unit_square_or_more((low, high): (Vec2, Vec2)) -> (Vec2, Vec2) {
    let is_within = low.cmpge(Vec2::ZERO).all() && high.cmple(Vec2::ONE).all();
    if is_within { (Vec2::ZERO, Vec2::ONE) } else { (low, high) }
}

/// The width in the world of a unit of a plane, metres, by the areas of all triangles.
fn metres_per_unit(object: &Object, place: impl Fn(u32) -> Vec2) -> f64 {
    let linear = Mat3::from(object.world_from_object.matrix3);
    let (mut surface, mut plane) = (0.0, 0.0);
    for (number, vertices) in object.mesh.triangles.iter().enumerate() {
        let [a, b, c] = object.mesh.corners(number).map(|p| (linear * p).as_dvec3());
        surface += (b - a).cross(c - a).length();
        let [a, b, c] = vertices.map(|v| place(v).as_dvec2());
        plane += (b - a).perp_dot(c - a).abs();
    }
    (surface / plane.max(f64::MIN_POSITIVE)).sqrt()
}

/// The longest that a chart can be, units: the diagonal of the cube from −1 to 1.
const LONGEST: f64 = 3.47;
/// Texels along the side of a map.
const LARGEST_SIDE: f64 = 1e5;
/// Share of a map's texels that charts fill, at a guess.
const FILL: f64 = 0.5;
/// How much wider than guessed texels may become before charts are made anew for the wider ones.
const RESCALE: f64 = 1.5;
/// How often charts are made anew.
const MOST_RESCALES: usize = 8;

/// Charts of a mesh in a map of at most `map_size` texels along a side.
fn charts_within(object: &Object, map_size: u32) -> MapLayout {
    let facets = Facets::new(object);
    let mut texel = (facets.total_area() / (FILL * f64::from(map_size).powi(2))).sqrt().max(1e-9);
    for _ in 0..MOST_RESCALES {
        let atlas = Atlas::new(&facets, texel);
        if let Some(placed) = atlas.fit(&facets, map_size, texel, RESCALE * texel) {
            return MapLayout::of_charts(&facets, &atlas, placed);
        }
        texel *= RESCALE;
    }
    let atlas = Atlas::new(&facets, texel);
    MapLayout::of_charts(&facets, &atlas, atlas.place(&facets, texel))
}
