//! What lies beside texels on other charts: found by place and facing, so that it does not matter how the mesh is joined.

use std::collections::HashSet;

use glam::{DVec2, DVec3};
use rayon::prelude::*;

use super::{
    Map, WeldPart,
    near::{Box3, bounds, box_tree, each_near, nearest},
    nodes::place,
};
use crate::{MapTile, TexelChart, WorldTriangle, box_tree::BoxTree};

/// How far from the surface of a texel that of another chart counts as beside it, in the texel's width on a chart that is not tilted.
const REACH: f64 = 1.0;
/// Cosine of the most that surfaces beside one another may turn from each other: 100°, so that the sides of a box count, and the front and back
/// of a plate do not.
pub(super) const FACING: f64 = -0.173_648;

/// A texel's surface and what lies beside it.
pub(super) struct Seam {
    /// The texel.
    pub texel: u64,
    /// The unit normal of its surface, on the side of its layer.
    pub normal: DVec3,
    /// What is there of other charts.
    pub beside: Vec<Beside>,
}

/// What is beside a texel on another chart.
pub(super) struct Beside {
    /// The texel nearest to the place on the plane that is nearest in space.
    pub texel: u64,
    /// The texels of the chart around that place, by the weights with which they are read there.
    pub around: Vec<WeldPart>,
    /// The unit normal of the surface, on the side of the layer.
    pub normal: DVec3,
    /// Metres.
    pub distance: f64,
}

/// What stands for a texel's surface: the point of it nearest to the texel on the plane.
struct Stand {
    texel: u64,
    layer: u32,
    chart: TexelChart,
    at: DVec3,
    normal: DVec3,
    /// Metres.
    reach: f64,
}

/// The triangles of a map that are near something, found by their boxes.
struct NearTriangles {
    /// Their places in the map's list.
    numbers: Vec<u32>,
    tree: BoxTree<DVec3>,
}

impl NearTriangles {
    /// The triangles whose corners, if they have any here, are near one of some boxes.
    fn new(map: &Map<'_>, boxes: &[Box3], corners: impl Fn(&WorldTriangle) -> Option<[DVec3; 3]> + Sync) -> Self {
        let wanted = box_tree(boxes);
        let own = |(number, triangle): (usize, &WorldTriangle)| {
            let own = bounds(corners(triangle)?);
            wanted.any_near(own, |_| true).then_some((number as u32, own))
        };
        let (numbers, boxes): (Vec<u32>, Vec<Box3>) = map.triangles.par_iter().enumerate().filter_map(own).unzip();
        Self { numbers, tree: box_tree(&boxes) }
    }

    /// Calls `found` with each that may be near a box, and its place in the map's list.
    fn each<'m>(&self, map: &Map<'m>, near: Box3, mut found: impl FnMut(usize, &'m WorldTriangle)) {
        each_near(&self.tree, near, |k| found(self.numbers[k] as usize, &map.triangles[self.numbers[k] as usize]));
    }
}

/// A point of a triangle that is nearest to something.
#[derive(Clone, Copy)]
struct Nearest {
    distance: f64,
    /// Its place in the map's list.
    triangle: usize,
    /// Barycentric coordinates.
    at: DVec3,
}

impl Nearest {
    fn is_before(&self, other: &Self) -> bool {
        (self.distance, self.triangle) < (other.distance, other.triangle)
    }
}

/// The cube around a point.
fn cube((at, reach): (DVec3, f64)) -> Box3 {
    (at - reach, at + reach)
}

/// What lies beside texels, in the order of these; of each texel that has a surface.
pub(super) fn seams(map: &Map<'_>, texels: &[u64]) -> Vec<Seam> {
    let stands = stands(map, texels);
    let boxes: Vec<Box3> = stands.iter().map(|stand| cube((stand.at, stand.reach))).collect();
    let triangles = NearTriangles::new(map, &boxes, |triangle| Some(triangle.corners.map(|p| p.as_dvec3())));
    stands.par_iter().map(|stand| seam(map, stand, &triangles)).collect()
}

/// What lies beside one: the nearest texel of each chart within reach that faces about as it does.
fn seam(map: &Map<'_>, stand: &Stand, triangles: &NearTriangles) -> Seam {
    let mut charts: Vec<(TexelChart, Nearest)> = Vec::new();
    triangles.each(map, cube((stand.at, stand.reach)), |number, triangle| {
        let chart = map.layout.chart_of(triangle.triangle);
        if chart == stand.chart || facing_layer(map, stand, unit_normal(triangle)).is_none() {
            return;
        }
        let (at, distance) = nearest(triangle.corners.map(|p| p.as_dvec3()), stand.at);
        let new = Nearest { distance, triangle: number, at };
        match charts.iter_mut().find(|(known, _)| *known == chart) {
            _ if distance > stand.reach => {}
            Some((_, kept)) if new.is_before(kept) => *kept = new,
            Some(_) => {}
            None => charts.push((chart, new)),
        }
    });
    charts.sort_unstable_by_key(|(_, nearest)| nearest.triangle);
    let beside = |(chart, Nearest { triangle, at, distance }): (TexelChart, Nearest)| {
        let triangle = &map.triangles[triangle];
        let (layer, normal) = facing_layer(map, stand, unit_normal(triangle))?;
        let place = plane_point(map, triangle, at);
        let around = texels_around(map, layer, place, chart);
        Some(Beside { texel: texel_at(map, layer, place, chart)?, around, normal, distance })
    };
    Seam { texel: stand.texel, normal: stand.normal, beside: charts.into_iter().filter_map(beside).collect() }
}

/// The layer on which a triangle is seen as a texel's surface is, and its normal there.
fn facing_layer(map: &Map<'_>, stand: &Stand, normal: DVec3) -> Option<(u32, DVec3)> {
    let own = if stand.layer == 0 { normal } else { -normal };
    let sides = [(stand.layer, own), (1 - stand.layer.min(1), -own)];
    sides.into_iter().find(|&(layer, normal)| layer < map.layout.layers && normal.dot(stand.normal) >= FACING)
}

/// What stands for texels.
fn stands(map: &Map<'_>, texels: &[u64]) -> Vec<Stand> {
    let spots: Vec<(&MapTile, DVec3, f64)> = texels
        .iter()
        .map(|&texel| {
            let tile = map.tile(texel);
            let cell = map.tiles.cell_size(tile);
            let at = map.tiles.origin(tile) + cell * DVec2::from(place(tile, texel).map(|at| at as f64));
            (tile, at.extend(0.0), cell.max_element())
        })
        .collect();
    let chart = |texel: u64| map.surfaces[texel as usize].chart;
    let wanted: HashSet<TexelChart> = texels.iter().map(|&texel| chart(texel)).collect();
    let boxes: Vec<Box3> = spots.iter().map(|&(_, at, cell)| cube((at, cell))).collect();
    let flat = |triangle: &WorldTriangle| places(map, triangle).map(|place| place.extend(0.0));
    let of_charts =
        |triangle: &WorldTriangle| wanted.contains(&map.layout.chart_of(triangle.triangle)).then(|| flat(triangle));
    let triangles = NearTriangles::new(map, &boxes, of_charts);
    let stand = |spot: usize| {
        let (tile, place, cell) = spots[spot];
        let mut best: Option<Nearest> = None;
        triangles.each(map, cube((place, cell)), |number, triangle| {
            if map.layout.chart_of(triangle.triangle) == chart(texels[spot]) {
                let (at, distance) = nearest(flat(triangle), place);
                let new = Nearest { distance, triangle: number, at };
                best = best.filter(|best| !new.is_before(best)).or(Some(new));
            }
        });
        let Nearest { triangle, at, .. } = best?;
        let triangle = &map.triangles[triangle];
        let layer = tile.square.layer;
        let normal = unit_normal(triangle);
        let [a, b, c] = triangle.corners.map(|p| p.as_dvec3());
        Some(Stand {
            texel: texels[spot],
            layer,
            chart: chart(texels[spot]),
            at: a * at.x + b * at.y + c * at.z,
            normal: if layer == 0 { normal } else { -normal },
            reach: REACH * cell * f64::from(map.layout.metres_per_texel),
        })
    };
    (0..texels.len()).into_par_iter().filter_map(stand).collect()
}

fn unit_normal(triangle: &WorldTriangle) -> DVec3 {
    let [a, b, c] = triangle.corners.map(|p| p.as_dvec3());
    (b - a).cross(c - a).normalize_or_zero()
}

/// The places of a triangle's corners on the plane.
fn places(map: &Map<'_>, triangle: &WorldTriangle) -> [DVec2; 3] {
    triangle.arrange(map.layout.corners[triangle.triangle as usize]).map(|p| p.as_dvec2())
}

/// The place on the plane of a point of a triangle.
fn plane_point(map: &Map<'_>, triangle: &WorldTriangle, at: DVec3) -> DVec2 {
    let [a, b, c] = places(map, triangle);
    a * at.x + b * at.y + c * at.z
}

/// The texel nearest to a place, if it is of a chart.
fn texel_at(map: &Map<'_>, layer: u32, at: DVec2, chart: TexelChart) -> Option<u64> {
    let tile = map.tiles.at(layer, at)?;
    let last = DVec2::new(tile.cells[0].into(), tile.cells[1].into());
    let here = ((at - map.tiles.origin(tile)) / map.tiles.cell_size(tile)).round().clamp(DVec2::ZERO, last);
    let texel = tile.first_texel + here.y as u64 * (u64::from(tile.cells[0]) + 1) + here.x as u64;
    (map.surfaces[texel as usize].chart == chart).then_some(texel)
}

/// The texels of a chart between which a place lies, with the weights with which they are read there.
fn texels_around(map: &Map<'_>, layer: u32, at: DVec2, chart: TexelChart) -> Vec<WeldPart> {
    let Some(tile) = map.tiles.at(layer, at) else { return Vec::new() };
    let last = DVec2::new(tile.cells[0].into(), tile.cells[1].into()) - 1.0;
    let at = (at - map.tiles.origin(tile)) / map.tiles.cell_size(tile);
    let cell = at.floor().clamp(DVec2::ZERO, last);
    let f = (at - cell).clamp(DVec2::ZERO, DVec2::ONE);
    let first = tile.first_texel + cell.y as u64 * (u64::from(tile.cells[0]) + 1) + cell.x as u64;
    let above = first + u64::from(tile.cells[0]) + 1;
    let corners = [
        (first, (1.0 - f.x) * (1.0 - f.y)),
        (first + 1, f.x * (1.0 - f.y)),
        (above, (1.0 - f.x) * f.y),
        (above + 1, f.x * f.y),
    ];
    let is_own = |&(texel, weight): &(u64, f64)| weight > 0.0 && map.surfaces[texel as usize].chart == chart;
    let own: Vec<(u64, f64)> = corners.into_iter().filter(is_own).collect();
    let whole: f64 = own.iter().map(|(_, weight)| weight).sum();
    own.into_iter().map(|(index, weight)| WeldPart { index, weight: weight / whole }).collect()
}
