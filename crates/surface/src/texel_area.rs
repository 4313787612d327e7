//! Areas of texels.

use std::collections::HashMap;

use glam::{DVec2, DVec3, Vec3};

use crate::{MapLayout, MapSquare, MapTile, MapTiles, WorldTriangle, tile::FINEST_LEVEL};

/// The surface behind a texel.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TexelSurface {
    /// The integral of the texel's bilinear weight over the object's surface in the world that lies on its tile, m².
    pub area: f64,
    /// The same integral over the part of the plane that the surface covers, in cells of the tile: 1 of a texel with surface all around it, a
    /// half on a tile's border.
    pub covered: f32,
    /// The chart that all of it belongs to.
    pub chart: TexelChart,
}

/// The chart of what lies behind a texel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum TexelChart {
    /// There is no surface.
    #[default]
    None,
    /// All is of this one.
    One(u32),
    /// This one, a cell, in which pieces of surface lie on one another.
    Cell(u32),
    /// Several charts share the texel.
    Several,
}

impl TexelChart {
    /// What both are together.
    fn and(self, other: Self) -> Self {
        match (self, other) {
            (Self::None, one) | (one, Self::None) => one,
            (one, other) if one == other => one,
            _ => Self::Several,
        }
    }
}

/// The area of each texel, m²: that of its surface, so that the areas of each layer sum to the surface's area.
///
/// `triangles` are the object's, in any order; those without an area may be missing.
pub fn texel_areas(layout: &MapLayout, tiles: &MapTiles, triangles: &[WorldTriangle]) -> Vec<f64> {
    texel_surfaces(layout, tiles, triangles).into_iter().map(|texel| texel.area).collect()
}

/// The surface behind each texel.
///
/// `triangles` are the object's, in any order; those without an area may be missing.
pub fn texel_surfaces(layout: &MapLayout, tiles: &MapTiles, triangles: &[WorldTriangle]) -> Vec<TexelSurface> {
    let mut texels = vec![TexelSurface::default(); tiles.texel_count() as usize];
    for layer in 0..layout.layers {
        if layer > 0 && copy_of_first_layer(tiles, layer, &mut texels) {
            continue;
        }
        let index = tiles.tiles.iter().filter(|tile| tile.square.layer == layer).map(|tile| (tile.square, *tile));
        let index: HashMap<MapSquare, MapTile> = index.collect();
        for triangle in triangles {
            let places = triangle.arrange(layout.corners[triangle.triangle as usize]).map(|p| p.as_dvec2());
            let area = 0.5 * world_double_area(triangle.corners);
            let chart = layout.chart_of(triangle.triangle);
            let chart_area = 0.5 * (places[1] - places[0]).perp_dot(places[2] - places[0]).abs();
            // A long triangle as thin as rounding is a line, too.
            let is_folded = chart_area <= 1e-9 * tiles.cell_area_bound().max(10.0 * longest_squared(places));
            let spread = if !is_folded {
                Spread::Over(places, area / chart_area)
            } else {
                Spread::Folded(folded_points(places, area))
            };
            for (y, x) in (0..tiles.roots[1]).flat_map(|y| (0..tiles.roots[0]).map(move |x| (y, x))) {
                add(tiles, &index, MapSquare { layer, level: 0, x, y }, (&spread, chart), &mut texels);
            }
        }
    }
    texels
}

/// Copies the texels of a layer that has the same tiles as the first; returns whether it has.
fn copy_of_first_layer(tiles: &MapTiles, layer: u32, texels: &mut [TexelSurface]) -> bool {
    let of_layer = |wanted: u32| tiles.tiles.iter().filter(move |tile| tile.square.layer == wanted);
    let alike = |(a, b): (&MapTile, &MapTile)| MapSquare { layer, ..a.square } == b.square && a.cells == b.cells;
    let same = of_layer(0).count() == of_layer(layer).count() && of_layer(0).zip(of_layer(layer)).all(alike);
    for (from, to) in of_layer(0).zip(of_layer(layer)).filter(|_| same) {
        let first = from.first_texel as usize..(from.first_texel + from.texel_count()) as usize;
        texels.copy_within(first, to.first_texel as usize);
    }
    same
}

/// How a triangle's area lies on the plane.
enum Spread {
    /// Evenly over a triangle of the plane, so many m² on each unit.
    Over([DVec2; 3], f64),
    /// As if in points, each with its m², for the chart folds the triangle to a line or a point.
    Folded(Vec<(DVec2, f64)>),
}

/// Adds what lies on a square to the tiles in it.
fn add(
    tiles: &MapTiles,
    index: &HashMap<MapSquare, MapTile>,
    square: MapSquare,
    (spread, chart): (&Spread, TexelChart),
    texels: &mut [TexelSurface],
) {
    let size = tiles.square_size(square.level);
    let origin = DVec2::new(square.x.into(), square.y.into()) * size;
    let is_met = match spread {
        Spread::Over(places, _) => meets(places, origin, origin + size),
        Spread::Folded(points) => points.iter().any(|(place, _)| tiles.holds(square, *place)),
    };
    if !is_met {
        return;
    }
    let Some(tile) = index.get(&square) else {
        if square.level < FINEST_LEVEL {
            square.children().into_iter().for_each(|child| add(tiles, index, child, (spread, chart), texels));
        }
        return;
    };
    let cells = DVec2::new(tile.cells[0].into(), tile.cells[1].into());
    let scale = cells / size;
    let mut grid = Grid {
        width: tile.cells[0] as usize + 1,
        last_cell: cells - 1.0,
        chart,
        texels: &mut texels[tile.first_texel as usize..(tile.first_texel + tile.texel_count()) as usize],
    };
    match spread {
        Spread::Over(places, density) => {
            grid.add_triangle(places.map(|place| (place - origin) * scale), density / (scale.x * scale.y));
        }
        Spread::Folded(points) => {
            let own = points.iter().filter(|(place, _)| tiles.holds(square, *place));
            own.for_each(|(place, area)| grid.add_point((*place - origin) * scale, *area));
        }
    }
}

/// Whether a triangle may meet a rectangle: it does not lie outside one of the rectangle's sides, nor the rectangle outside one of its.
fn meets(places: &[DVec2; 3], low: DVec2, high: DVec2) -> bool {
    let [a, b, c] = places;
    let (least, most) = (a.min(*b).min(*c), a.max(*b).max(*c));
    if least.cmpgt(high).any() || most.cmplt(low).any() {
        return false;
    }
    let orientation = (*b - *a).perp_dot(*c - *a).signum();
    [(a, b), (b, c), (c, a)].iter().all(|(start, end)| {
        let edge = (**end - **start) * orientation;
        // The rectangle's corner farthest inside this edge decides.
        let farthest = DVec2::new(if edge.y > 0.0 { low.x } else { high.x }, if edge.x > 0.0 { high.y } else { low.y });
        edge.perp_dot(farthest - **start) >= 0.0
    })
}

impl MapTiles {
    /// Whether a place of the plane lies on a square, whose upper border belongs to the next.
    fn holds(&self, square: MapSquare, place: DVec2) -> bool {
        let count = glam::UVec2::from(self.roots) << square.level;
        let own = (place / self.square_size(square.level)).floor().clamp(DVec2::ZERO, count.as_dvec2() - 1.0);
        own == DVec2::new(square.x.into(), square.y.into())
    }

    /// The area of the layout's texel on the plane, at most 1: a measure for what counts as folded.
    fn cell_area_bound(&self) -> f64 {
        self.tiles.iter().map(|tile| self.cell_size(tile).element_product()).fold(1.0, f64::min)
    }
}

fn world_double_area(corners: [Vec3; 3]) -> f64 {
    let [a, b, c] = corners.map(|p| DVec3::new(p.x.into(), p.y.into(), p.z.into()));
    (b - a).cross(c - a).length()
}

fn longest_squared([a, b, c]: [DVec2; 3]) -> f64 {
    (b - a).length_squared().max((c - b).length_squared()).max((a - c).length_squared())
}

/// Points in place of a triangle that is folded, with their shares of its area: it is cut into congruent pieces, upright and inverted.
fn folded_points([a, b, c]: [DVec2; 3], area: f64) -> Vec<(DVec2, f64)> {
    let longest = longest_squared([a, b, c]).sqrt();
    let pieces = (4.0 * longest).ceil().clamp(1.0, 256.0) as usize;
    let share = area / (pieces * pieces) as f64;
    let center = |i: usize, j: usize, within: f64| {
        a + ((b - a) * (i as f64 + within) + (c - a) * (j as f64 + within)) / pieces as f64
    };
    let mut points = Vec::with_capacity(pieces * pieces);
    for (i, j) in (0..pieces).flat_map(|i| (0..pieces - i).map(move |j| (i, j))) {
        points.push((center(i, j, 1.0 / 3.0), share));
        if i + j + 1 < pieces {
            points.push((center(i, j, 2.0 / 3.0), share));
        }
    }
    points
}

/// Cells that a point of a folded triangle counts as covering.
const POINT_COVER: f64 = 4.0;

/// The texels of a tile, as a piece of surface is added to them.
struct Grid<'a> {
    width: usize,
    /// The last cell's lower corner.
    last_cell: DVec2,
    /// That of the piece.
    chart: TexelChart,
    texels: &'a mut [TexelSurface],
}

impl Grid<'_> {
    /// Adds a triangle of the plane, each unit of which stands for `density` m², as far as it lies on the grid.
    fn add_triangle(&mut self, places: [DVec2; 3], density: f64) {
        let low = places[0].min(places[1]).min(places[2]).floor().clamp(DVec2::ZERO, self.last_cell);
        let high = places[0].max(places[1]).max(places[2]).ceil();
        for y in low.y as usize..=((high.y - 1.0).clamp(low.y, self.last_cell.y) as usize) {
            let above = clip(&places, |p| p.y - y as f64);
            let strip = clip(&above, |p| (y + 1) as f64 - p.y);
            let Some((left, right)) = x_range(&strip) else { continue };
            let first = left.floor().clamp(0.0, self.last_cell.x) as usize;
            let last = (right.ceil() - 1.0).clamp(first as f64, self.last_cell.x) as usize;
            for x in first..=last {
                let corner = DVec2::new(x as f64, y as f64);
                if cell_is_inside(corner, &places) {
                    self.add_moments(x, y, [density, 1.0], [1.0, 0.5, 0.5, 0.25]);
                } else {
                    let right_of = clip(&strip, |p| p.x - x as f64);
                    let cell = clip(&right_of, |p| (x + 1) as f64 - p.x);
                    self.add_moments(x, y, [density, 1.0], moments(&cell, corner));
                }
            }
        }
    }

    /// Adds an area at one point, around which the plane counts as covered.
    fn add_point(&mut self, place: DVec2, area: f64) {
        let cell = place.floor().clamp(DVec2::ZERO, self.last_cell);
        let f = (place - cell).clamp(DVec2::ZERO, DVec2::ONE);
        self.add_moments(cell.x as usize, cell.y as usize, [area, POINT_COVER], [1.0, f.x, f.y, f.x * f.y]);
    }

    /// Adds the moments (1, s, t, st) of a part of a cell, in its own coordinates, to the cell's four texels: each unit stands for so many m²
    /// and so many covered units.
    fn add_moments(&mut self, x: usize, y: usize, densities: [f64; 2], [one, s, t, st]: [f64; 4]) {
        let first = y * self.width + x;
        self.add_part(first, densities, one - s - t + st);
        self.add_part(first + 1, densities, s - st);
        self.add_part(first + self.width, densities, t - st);
        self.add_part(first + self.width + 1, densities, st);
    }

    fn add_part(&mut self, texel: usize, [area, covered]: [f64; 2], part: f64) {
        let texel = &mut self.texels[texel];
        texel.area += area * part;
        texel.covered += (covered * part) as f32;
        if area * part > 0.0 {
            texel.chart = texel.chart.and(self.chart);
        }
    }
}

fn cell_is_inside(corner: DVec2, [a, b, c]: &[DVec2; 3]) -> bool {
    let orientation = (*b - *a).perp_dot(*c - *a);
    [(a, b), (b, c), (c, a)].iter().all(|(start, end)| {
        let edge = (**end - **start) * orientation.signum();
        // The cell's corner farthest outside this edge decides.
        let farthest = corner + DVec2::new(f64::from(edge.y > 0.0), f64::from(edge.x < 0.0));
        edge.perp_dot(farthest - **start) >= 0.0
    })
}

/// The part of a convex polygon where `inside` is not negative (Sutherland and Hodgman 1974).
fn clip(polygon: &[DVec2], inside: impl Fn(DVec2) -> f64) -> Vec<DVec2> {
    let mut kept = Vec::with_capacity(polygon.len() + 1);
    for (k, &start) in polygon.iter().enumerate() {
        let end = polygon[(k + 1) % polygon.len()];
        let (from, to) = (inside(start), inside(end));
        if from >= 0.0 {
            kept.push(start);
        }
        if (from >= 0.0) != (to >= 0.0) {
            kept.push(start + (end - start) * (from / (from - to)));
        }
    }
    kept
}

fn x_range(polygon: &[DVec2]) -> Option<(f64, f64)> {
    let range = polygon.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), p| (l.min(p.x), h.max(p.x)));
    (range.0 <= range.1).then_some(range)
}

/// The integrals of 1, s, t and st over a convex polygon in a cell with lower corner `corner`. The rule at the middles of a
/// triangle's sides is exact for quadratics.
fn moments(polygon: &[DVec2], corner: DVec2) -> [f64; 4] {
    let mut sums = [0.0; 4];
    for k in 1..polygon.len().saturating_sub(1) {
        let [a, b, c] = [polygon[0], polygon[k], polygon[k + 1]].map(|p| p - corner);
        let area = 0.5 * (b - a).perp_dot(c - a).abs();
        for middle in [0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a)] {
            sums[0] += area / 3.0;
            sums[1] += area / 3.0 * middle.x;
            sums[2] += area / 3.0 * middle.y;
            sums[3] += area / 3.0 * middle.x * middle.y;
        }
    }
    sums
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec2;
    use proptest::prelude::*;

    fn triangle(corners: [Vec3; 3]) -> WorldTriangle {
        WorldTriangle { corners, normals: None, uvs: None, object: 0, triangle: 0, material: 0, exchanged: false }
    }

    #[test]
    fn a_unit_square_has_whole_halved_and_quartered_texels() {
        let p = [Vec2::new(0.0, 0.0), Vec2::new(4.0, 0.0), Vec2::new(4.0, 3.0), Vec2::new(0.0, 3.0)];
        let layout = MapLayout {
            width: 5,
            height: 4,
            layers: 1,
            corners: vec![[p[0], p[1], p[2]], [p[0], p[2], p[3]]],
            ..Default::default()
        };
        let world = layout.corners.iter().enumerate().map(|(i, places)| WorldTriangle {
            triangle: i as u32,
            ..triangle(places.map(|place| Vec3::new(place.x, 0.0, place.y)))
        });
        let areas = texel_areas(&layout, &MapTiles::dense(&layout), &world.collect::<Vec<_>>());
        for y in 0..4 {
            for x in 0..5 {
                let share = |at: usize, last: usize| if at == 0 || at == last { 0.5 } else { 1.0 };
                assert!((areas[y * 5 + x] - share(x, 4) * share(y, 3)).abs() < 1e-12, "texel ({x}, {y})");
            }
        }
    }

    /// Σ over random points of their bilinear weights, against the exact integral.
    #[test]
    fn areas_are_the_integral_of_the_weights() {
        let places = [Vec2::new(0.3, 0.2), Vec2::new(5.7, 1.1), Vec2::new(2.2, 6.4)];
        let layout = MapLayout { width: 7, height: 8, layers: 1, corners: vec![places], ..Default::default() };
        let areas = texel_areas(&layout, &MapTiles::dense(&layout), &[triangle([Vec3::ZERO, Vec3::X, Vec3::Y])]);
        let steps = 1500;
        let mut expected = vec![0.0; areas.len()];
        for (i, j) in (0..steps).flat_map(|i| (0..steps - i).map(move |j| (i, j))) {
            for within in if i + j + 1 < steps { &[1.0 / 3.0, 2.0 / 3.0][..] } else { &[1.0 / 3.0][..] } {
                let (u, v) = ((f64::from(i) + within) / f64::from(steps), (f64::from(j) + within) / f64::from(steps));
                let p = places.map(|p| p.as_dvec2());
                let at = p[0] + (p[1] - p[0]) * u + (p[2] - p[0]) * v;
                let (cell, f) = (at.floor(), at - at.floor());
                let first = cell.y as usize * 7 + cell.x as usize;
                for (k, weight) in
                    [(0, (1.0 - f.x) * (1.0 - f.y)), (1, f.x * (1.0 - f.y)), (7, (1.0 - f.x) * f.y), (8, f.x * f.y)]
                {
                    expected[first + k] += weight * 0.5 / f64::from(steps * steps);
                }
            }
        }
        for (texel, (found, expected)) in areas.iter().zip(&expected).enumerate() {
            assert!((found - expected).abs() < 1e-5, "texel {texel}: {found} against {expected}");
        }
    }

    proptest! {
        #[test]
        fn areas_sum_to_the_surface(
            places in prop::array::uniform3((0.0f32..30.0, 0.0f32..20.0)),
            corners in prop::array::uniform3(prop::array::uniform3(-5.0f32..5.0)),
            fold in prop::bool::ANY,
        ) {
            let mut places = places.map(|(x, y)| Vec2::new(x, y));
            if fold {
                places[2] = places[0].lerp(places[1], 0.3);
            }
            let layout = MapLayout { width: 31, height: 21, layers: 1, corners: vec![places], ..Default::default() };
            let world = triangle(corners.map(Vec3::from));
            let areas = texel_areas(&layout, &MapTiles::dense(&layout), &[world]);
            let surface = 0.5 * world_double_area(world.corners);
            prop_assert!(areas.iter().all(|&area| area >= -1e-9 * surface));
            prop_assert!((areas.iter().sum::<f64>() - surface).abs() <= 1e-6 * surface + 1e-12);
        }

        /// A quadtree's leaf of 4 cells holds the sum of the dense map's areas in the same place, whatever tiles lie around it.
        #[test]
        fn tiles_of_any_size_share_the_surface(
            places in prop::array::uniform3((0.0f32..32.0, 0.0f32..16.0)),
            splits in prop::collection::vec(prop::bool::ANY, 64),
            fold in prop::bool::ANY,
        ) {
            let mut places = places.map(|(x, y)| Vec2::new(x, y));
            if fold {
                places[2] = places[0].lerp(places[1], 0.3);
            }
            let layout = MapLayout { width: 33, height: 17, layers: 2, corners: vec![places], ..Default::default() };
            let roots = MapTiles::roots(&layout);
            prop_assert_eq!(roots, [2, 1]);
            let mut open: Vec<MapSquare> =
                (0..2).flat_map(|layer| (0..2).map(move |x| MapSquare { layer, level: 0, x, y: 0 })).collect();
            let (mut leaves, mut splits) = (Vec::new(), splits.into_iter());
            while let Some(square) = open.pop() {
                if square.level < 3 && splits.next() == Some(true) {
                    open.extend(square.children());
                } else {
                    leaves.push((square, [1 << (square.x % 4), 3]));
                }
            }
            let tiles = MapTiles::new(&layout, roots, leaves.into_iter());
            let world = triangle([Vec3::ZERO, Vec3::X, Vec3::Y]);
            let areas = texel_areas(&layout, &tiles, &[world]);
            let fine = MapLayout { width: 513, height: 257, ..layout.clone() };
            let fine = MapLayout { corners: vec![places.map(|place| place * 16.0)], ..fine };
            // Cells of a fine map, each wholly on one tile: their corners' weights of 1 in all sum to the area on the cell.
            let cells = MapTiles::new(&fine, roots, (0..4).flat_map(|i| (0..64u32).map(move |place| {
                (MapSquare { layer: i / 2, level: 3, x: 8 * (i % 2) + place % 8, y: place / 8 }, [1, 1])
            })));
            let fine_areas = texel_areas(&fine, &cells, &[world]);
            for tile in &tiles.tiles {
                let own: f64 = areas[tile.first_texel as usize..][..tile.texel_count() as usize].iter().sum();
                let shift = 3 - tile.square.level;
                let inside = cells.tiles.iter().filter(|cell| {
                    (cell.square.layer, cell.square.x >> shift, cell.square.y >> shift)
                        == (tile.square.layer, tile.square.x, tile.square.y)
                });
                let expected: f64 =
                    inside.map(|cell| fine_areas[cell.first_texel as usize..][..4].iter().sum::<f64>()).sum();
                // Points that stand for a folded triangle are few, and lie elsewhere in the fine map.
                prop_assert!(fold || (own - expected).abs() <= 1e-6, "{tile:?}: {own} against {expected}");
            }
            prop_assert!((areas.iter().sum::<f64>() - 1.0).abs() < 1e-6);
        }
    }
}
