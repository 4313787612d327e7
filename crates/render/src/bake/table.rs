//! Where the surface behind each texel of a lightmap is.

use diacaustic_scene::Scene;
use diacaustic_shaders::BakeTexel;
use diacaustic_surface::{DielectricBoundaries, MapLayout, RAY_OFFSET};
use glam::{Vec2, Vec3};

use super::SurfacePlace;
use crate::lights::keys_of_media;

/// What the bake kernel looks up.
pub(crate) struct Table {
    /// The texels that hold surface, layer by layer and row by row.
    pub texels: Vec<BakeTexel>,
    /// For each cell between four texels, row by row, and then once more: where the triangles that cross it begin; from there on, these
    /// triangles' places on the device.
    pub cells: Vec<u32>,
    /// Texels over the area of their surface, 1/m².
    pub texel_density: f32,
    /// For each texel of one layer, the point of the surface nearest to its middle.
    pub places: Vec<Option<SurfacePlace>>,
}

/// A receiver's triangle on the map.
struct MapTriangle {
    /// Its place on the device.
    index: u32,
    /// Its index in the object's mesh.
    triangle: u32,
    corners: [Vec2; 3],
}

impl Table {
    /// For an object whose map has a layout. `origins` are the object and the triangle of each triangle on the device.
    pub fn new(scene: &Scene, object: usize, layout: &MapLayout, origins: &[(u32, u32)]) -> Self {
        let triangles = map_triangles(scene, object, layout, origins);
        let places = nearest_places(layout, &triangles);
        Self {
            texels: texels(scene, object, layout, &places),
            cells: cells(layout, &triangles),
            texel_density: texel_density(scene, object, &triangles),
            places,
        }
    }
}

/// The texels that hold surface, with what lies in front of them.
fn texels(scene: &Scene, object: usize, layout: &MapLayout, places: &[Option<SurfacePlace>]) -> Vec<BakeTexel> {
    let boundaries = DielectricBoundaries::new(scene);
    let texel = |side: u32, index: usize, place: SurfacePlace| {
        let media = boundaries.media_at(point_before(scene, object, place, side == 0));
        let (column, row) = (index as u32 % layout.width, index as u32 / layout.width);
        BakeTexel { column, row, side, padding: 0, media: keys_of_media(scene, media) }
    };
    let of_side = |side| places.iter().enumerate().filter_map(move |(index, place)| Some((side, index, (*place)?)));
    (0..layout.layers).flat_map(of_side).map(|(side, index, place)| texel(side, index, place)).collect()
}

/// The triangles of an object's receivers that cover some of the map.
fn map_triangles(scene: &Scene, object: usize, layout: &MapLayout, origins: &[(u32, u32)]) -> Vec<MapTriangle> {
    let of_object = &scene.objects[object];
    let mut triangles: Vec<MapTriangle> = Vec::new();
    for (index, &(owner, triangle)) in origins.iter().enumerate() {
        let is_own = owner as usize == object;
        if is_own && scene.materials[of_object.material_of(triangle as usize)].is_receiver() {
            triangles.push(MapTriangle { index: index as u32, triangle, corners: layout.corners[triangle as usize] });
        }
    }
    // Of one that stands in several leaves, the first is enough.
    triangles.sort_by_key(|t| (t.triangle, t.index));
    triangles.dedup_by_key(|t| t.triangle);
    triangles.retain(|t| double_area(&t.corners) != 0.0);
    triangles
}

/// Twice the signed area on the map, texels².
fn double_area([a, b, c]: &[Vec2; 3]) -> f32 {
    (*b - *a).perp_dot(*c - *a)
}

fn world_corners(scene: &Scene, object: usize, triangle: u32) -> [Vec3; 3] {
    let object = &scene.objects[object];
    object.mesh.corners(triangle as usize).map(|corner| object.world_from_object.transform_point3(corner))
}

fn texel_density(scene: &Scene, object: usize, triangles: &[MapTriangle]) -> f32 {
    let (mut texels, mut area) = (0.0, 0.0);
    for t in triangles {
        let [a, b, c] = world_corners(scene, object, t.triangle);
        texels += f64::from(double_area(&t.corners).abs());
        area += f64::from((b - a).cross(c - a).length());
    }
    if area > 0.0 { (texels / area) as f32 } else { 1.0 }
}

/// A point of the surface, moved off it on one side as rays are that leave it.
fn point_before(scene: &Scene, object: usize, place: SurfacePlace, front: bool) -> Vec3 {
    let [a, b, c] = world_corners(scene, object, place.triangle);
    let mirrored = scene.objects[object].world_from_object.matrix3.determinant() < 0.0;
    let outward = (b - a).cross(c - a).normalize_or_zero();
    let reach = [a, b, c].iter().map(|p| p.abs().max_element()).fold(0.0, f32::max);
    let side = if front == mirrored { -1.0 } else { 1.0 };
    place.weights[0] * a + place.weights[1] * b + place.weights[2] * c + side * RAY_OFFSET * reach * outward
}

/// The texels whose weight reaches a triangle: columns, then rows, first and last.
fn reached(layout: &MapLayout, corners: &[Vec2; 3], margin: f32) -> [std::ops::RangeInclusive<u32>; 2] {
    let [a, b, c] = *corners;
    let last = Vec2::new((layout.width - 1) as f32, (layout.height - 1) as f32);
    let low = (a.min(b).min(c) - margin).ceil().clamp(Vec2::ZERO, last);
    let high = (a.max(b).max(c) + margin).floor().clamp(Vec2::ZERO, last);
    [low.x as u32..=high.x as u32, low.y as u32..=high.y as u32]
}

/// For each texel of a layer the nearest point of the surface, if one is less than a texel away along both axes.
fn nearest_places(layout: &MapLayout, triangles: &[MapTriangle]) -> Vec<Option<SurfacePlace>> {
    let count = layout.width as usize * layout.height as usize;
    let mut nearest = vec![(f32::INFINITY, None); count];
    for t in triangles {
        let [columns, rows] = reached(layout, &t.corners, 1.0);
        for row in rows {
            for column in columns.clone() {
                let middle = Vec2::new(column as f32, row as f32);
                let (weights, point) = nearest_point(&t.corners, middle);
                let distance = (point - middle).abs().max_element();
                let entry = &mut nearest[(row * layout.width + column) as usize];
                if distance < 1.0 && distance < entry.0 {
                    *entry = (distance, Some(SurfacePlace { triangle: t.triangle, weights }));
                }
            }
        }
    }
    nearest.into_iter().map(|(_, place)| place).collect()
}

/// The point of a triangle that is nearest to `p`, with its barycentric weights.
fn nearest_point(corners: &[Vec2; 3], p: Vec2) -> ([f32; 3], Vec2) {
    let [a, b, c] = *corners;
    let area = double_area(corners);
    let inside = [(b - p).perp_dot(c - p), (c - p).perp_dot(a - p), (a - p).perp_dot(b - p)].map(|w| w / area);
    if inside.iter().all(|weight| *weight >= 0.0) {
        return (inside, p);
    }
    let on_edge = |from: usize| {
        let to = (from + 1) % 3;
        let edge = corners[to] - corners[from];
        let part = ((p - corners[from]).dot(edge) / edge.length_squared().max(f32::MIN_POSITIVE)).clamp(0.0, 1.0);
        let mut weights = [0.0; 3];
        (weights[from], weights[to]) = (1.0 - part, part);
        (weights, corners[from] + part * edge)
    };
    let edges = [on_edge(0), on_edge(1), on_edge(2)];
    edges.into_iter().min_by(|x, y| x.1.distance_squared(p).total_cmp(&y.1.distance_squared(p))).unwrap_or(edges[0])
}

/// For each cell, and then once more, where the triangles that cross it begin; then these triangles, by their place on the device.
fn cells(layout: &MapLayout, triangles: &[MapTriangle]) -> Vec<u32> {
    let width = layout.width - 1;
    let mut entries = Vec::new();
    for t in triangles {
        let [columns, rows] = reached(layout, &t.corners, 1.0);
        for row in rows.filter(|row| *row < layout.height - 1) {
            for column in columns.clone().filter(|column| *column < width) {
                if crosses_cell(&t.corners, Vec2::new(column as f32, row as f32)) {
                    entries.push((row * width + column, t.index));
                }
            }
        }
    }
    entries.sort_unstable();
    let count = (width * (layout.height - 1)) as usize;
    let mut cells = vec![0; count + 1];
    for (cell, _) in &entries {
        cells[*cell as usize + 1] += 1;
    }
    cells[0] = count as u32 + 1;
    for cell in 0..count {
        cells[cell + 1] += cells[cell];
    }
    cells.extend(entries.into_iter().map(|(_, index)| index));
    cells
}

/// Whether a triangle may have points in the cell with lower corner `low`; no line along one of its edges or the cell's parts them.
fn crosses_cell(corners: &[Vec2; 3], low: Vec2) -> bool {
    let [a, b, c] = *corners;
    let (lowest, highest) = (a.min(b).min(c), a.max(b).max(c));
    let apart = lowest.cmpgt(low + 1.0).any() || highest.cmplt(low).any();
    let orientation = double_area(corners).signum();
    !apart
        && (0..3).all(|k| {
            let edge = (corners[(k + 1) % 3] - corners[k]) * orientation;
            // The cell's corner farthest inside the edge decides.
            let farthest = low + Vec2::new(f32::from(edge.y < 0.0), f32::from(edge.x > 0.0));
            edge.perp_dot(farthest - corners[k]) >= -1e-3 * edge.length()
        })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn layout() -> MapLayout {
        let triangle = [Vec2::new(0.5, 0.25), Vec2::new(6.5, 1.0), Vec2::new(2.0, 4.75)];
        MapLayout { width: 8, height: 6, layers: 1, corners: vec![triangle], ..MapLayout::default() }
    }

    #[test]
    fn every_point_of_a_triangle_is_in_a_cell_that_lists_it() {
        let layout = layout();
        let corners = layout.corners[0];
        for corners in [corners, [corners[0], corners[2], corners[1]]] {
            let cells = cells(&layout, &[MapTriangle { index: 7, triangle: 0, corners }]);
            assert_eq!((cells[0], cells[35] as usize), (36, cells.len()));
            assert!(cells[36..].iter().all(|index| *index == 7) && cells.len() < 36 + 30, "{cells:?}");
            for step in 0..400u32 {
                let [u, v] = [0.618_034, 0.754_878].map(|factor| (f64::from(step) * factor).fract() as f32);
                let (u, v) = if u + v > 1.0 { (1.0 - u, 1.0 - v) } else { (u, v) };
                let point = corners[0] + u * (corners[1] - corners[0]) + v * (corners[2] - corners[0]);
                let cell = (point.y as usize) * 7 + point.x as usize;
                assert!(cells[cell] < cells[cell + 1], "{point}");
            }
        }
    }

    #[test]
    fn texels_near_the_surface_have_a_place_on_it() {
        let layout = layout();
        let corners = layout.corners[0];
        let places = nearest_places(&layout, &[MapTriangle { index: 7, triangle: 0, corners }]);
        let point = |place: SurfacePlace| (0..3).map(|k| place.weights[k] * corners[k]).sum::<Vec2>();
        let inside = places[2 * 8 + 2].unwrap();
        assert!(point(inside).distance(Vec2::new(2.0, 2.0)) < 1e-5);
        let corner = places[0].unwrap();
        assert!(point(corner).distance(corners[0]) < 1e-5, "{corner:?}");
        assert_eq!(places[5 * 8 + 7], None);
    }
}
