//! Texture coordinates that serve as a map.

use diacaustic_scene::{Chart, Object, Scene};
use glam::{DVec2, Vec3};
use rayon::prelude::*;

use super::overlap::{FlatTriangles, MANY_BOXES, overlap_depth, shares_of_box};
use crate::Error;

/// Share of the covered plane's longer side by which triangles may lie in each other: what coordinates in single precision cannot say.
const TOLERANCE: f64 = 2e-6;

/// Checks that the texture coordinates of each object that takes them for its map cover no place twice.
///
/// # Errors
/// If triangles overlap, or one with an area has none on the map.
pub fn check_map_uvs(scene: &Scene) -> Result<(), Error> {
    scene.objects.iter().filter(|object| object.mesh.chart == Chart::Uvs).try_for_each(check_object)
}

fn check_object(object: &Object) -> Result<(), Error> {
    let mesh = &object.mesh;
    let places = mesh.map_places();
    let has_area: Vec<u32> = (0..mesh.triangles.len() as u32)
        .filter(|&triangle| mesh.double_area_normal(triangle as usize) != Vec3::ZERO)
        .collect();
    let corners = |triangle: &u32| mesh.triangles[*triangle as usize].map(|v| places[v as usize].as_dvec2());
    let flat: Vec<[DVec2; 3]> = has_area.iter().map(corners).collect();
    let folded = flat.iter().position(|[a, b, c]| (*b - *a).perp_dot(*c - *a) == 0.0);
    if let Some(folded) = folded {
        let place = middle(&flat[folded]);
        return Err(Error::FoldedMapUvs { object: object.name.clone(), triangle: has_area[folded], place });
    }
    let (low, high) =
        flat.iter().flatten().fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(low, high), &p| (low.min(p), high.max(p)));
    let tolerance = TOLERANCE * (high - low).max_element().max(low.abs().max(high.abs()).max_element());
    let is_dense = shares_of_box(&flat).1 > MANY_BOXES;
    let flat = FlatTriangles::new(flat);
    let overlapping = if is_dense { overlap_at_border(&flat, tolerance) } else { first_overlap(&flat, tolerance) };
    match overlapping {
        None => Ok(()),
        Some((k, other)) => Err(Error::OverlappingMapUvs {
            object: object.name.clone(),
            triangles: [has_area[k], has_area[other]],
            place: common_place(&flat.corners[k], &flat.corners[other]),
        }),
    }
}

/// The first triangle that overlaps a later one by more than `tolerance`, and the first of those.
fn first_overlap(flat: &FlatTriangles, tolerance: f64) -> Option<(usize, usize)> {
    (0..flat.corners.len()).into_par_iter().find_map_first(|k| {
        let mut first = usize::MAX;
        flat.any_near(k, |other| {
            let is_earlier = other > k && other < first;
            if is_earlier && overlap_depth(&flat.corners[k], &flat.corners[other]) > tolerance {
                first = other;
            }
            false
        });
        (first != usize::MAX).then_some((k, first))
    })
}

/// Two triangles that overlap by more than `tolerance`, one of them at the border of what is covered: for fans, whose triangles' boxes all lie in
/// each other.
///
/// How many triangles cover a place changes only across edges that are not between two of them. Where it goes from two to less, such an edge is
/// of a triangle that overlaps another there. Triangles too thin to overlap anything so far do not count.
fn overlap_at_border(flat: &FlatTriangles, tolerance: f64) -> Option<(usize, usize)> {
    let is_thick = |k: usize| {
        let [a, b, c] = flat.corners[k];
        let longest = (b - a).length().max((c - b).length()).max((a - c).length());
        (b - a).perp_dot(c - a).abs() > tolerance * longest
    };
    let thick: Vec<bool> = (0..flat.corners.len()).map(is_thick).collect();
    border_edges(flat, &thick).into_par_iter().find_map_first(|(k, [a, b])| {
        let mut found = None;
        flat.any_in((a.min(b), a.max(b)), |other| {
            let overlaps =
                other != k && thick[other] && overlap_depth(&flat.corners[k], &flat.corners[other]) > tolerance;
            if overlaps {
                found = Some((k.min(other), k.max(other)));
            }
            overlaps
        });
        found
    })
}

/// The edges of some triangles, each with its triangle, that are not between one of these and one on its other side.
fn border_edges(flat: &FlatTriangles, counts: &[bool]) -> Vec<(usize, [DVec2; 2])> {
    let mut edges: Vec<([u64; 4], bool, usize)> = Vec::new();
    for k in (0..flat.corners.len()).filter(|&k| counts[k]) {
        let [a, b, c] = flat.corners[k];
        for (start, end, third) in [(a, b, c), (b, c, a), (c, a, b)] {
            // Adding 0 makes −0 the same place as 0.
            let bits = |p: DVec2| (p + 0.0).to_array().map(f64::to_bits);
            let (low, high) = if bits(start) <= bits(end) { (start, end) } else { (end, start) };
            let ([low_x, low_y], [high_x, high_y]) = (bits(low), bits(high));
            edges.push(([low_x, low_y, high_x, high_y], (high - low).perp_dot(third - low) > 0.0, k));
        }
    }
    edges.par_sort_unstable();
    let is_border = |same: &&[([u64; 4], bool, usize)]| !matches!(same, [(_, false, _), (_, true, _)]);
    let border = edges.chunk_by(|a, b| a.0 == b.0).filter(is_border).flatten();
    border
        .map(|&([low_x, low_y, high_x, high_y], _, k)| {
            let place = |x: u64, y: u64| DVec2::new(f64::from_bits(x), f64::from_bits(y));
            (k, [place(low_x, low_y), place(high_x, high_y)])
        })
        .collect()
}

fn middle([a, b, c]: &[DVec2; 3]) -> [f64; 2] {
    ((*a + *b + *c) / 3.0).to_array()
}

/// The middle of what two triangles have in common.
fn common_place(first: &[DVec2; 3], second: &[DVec2; 3]) -> [f64; 2] {
    let turn = (second[1] - second[0]).perp_dot(second[2] - second[0]).signum();
    let mut common = first.to_vec();
    for k in 0..3 {
        let (start, edge) = (second[k], turn * (second[(k + 1) % 3] - second[k]));
        let inside = |p: DVec2| edge.perp_dot(p - start);
        let mut kept = Vec::with_capacity(common.len() + 1);
        for (i, &p) in common.iter().enumerate() {
            let next = common[(i + 1) % common.len()];
            let (from, to) = (inside(p), inside(next));
            if from >= 0.0 {
                kept.push(p);
            }
            if (from >= 0.0) != (to >= 0.0) {
                kept.push(p + (next - p) * (from / (from - to)));
            }
        }
        common = kept;
    }
    let count = common.len().max(1) as f64;
    (common.into_iter().sum::<DVec2>() / count).to_array()
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use diacaustic_scene::Mesh;
    use glam::{Affine3A, Vec2};

    use super::*;

    fn checked(mesh: Mesh) -> Result<(), Error> {
        check_object(&Object {
            name: "wall".to_owned(),
            mesh: Arc::new(mesh),
            world_from_object: Affine3A::IDENTITY,
            materials: vec![0],
            map_size: None,
        })
    }

    /// A square of `side` × `side` squares of two triangles each, with texture coordinates from 0 to 1.
    fn grid(side: u32) -> Mesh {
        let mut mesh = Mesh::default();
        for k in 0..(side + 1) * (side + 1) {
            let uv = Vec2::new((k % (side + 1)) as f32, (k / (side + 1)) as f32) / side as f32;
            mesh.positions.push(uv.extend(0.0));
            mesh.uvs.push(uv);
        }
        for k in (0..side * side).map(|k| k / side * (side + 1) + k % side) {
            mesh.triangles.extend([[k, k + 1, k + side + 2], [k, k + side + 2, k + side + 1]]);
        }
        mesh
    }

    #[test]
    fn what_does_not_overlap_passes() {
        checked(grid(100)).unwrap();
        checked(Mesh::sphere(Vec3::ZERO, 1.0, 6)).unwrap();
        // Mirrored triangles cover no place twice either.
        let mut mirrored = grid(7);
        mirrored.uvs.iter_mut().for_each(|uv| uv.x *= -3.0);
        checked(mirrored).unwrap();
    }

    #[test]
    fn a_small_overlap_is_found_and_named() {
        let mut mesh = grid(100);
        // A vertex moves into the square beside it, by a hundredth of a square.
        let moved = 50 * 101 + 50;
        let first = mesh.positions.len() as u32;
        mesh.positions.push(mesh.positions[moved]);
        mesh.uvs.push(mesh.uvs[moved] + Vec2::new(1e-4, 2e-5));
        // The triangle at whose third corner it is.
        let number = mesh.triangles.iter().position(|t| t[2] == moved as u32).unwrap();
        mesh.triangles[number][2] = first;
        let Err(Error::OverlappingMapUvs { object, triangles, place }) = checked(mesh.clone()) else {
            panic!("passes")
        };
        assert_eq!(object, "wall");
        assert!(triangles.contains(&(number as u32)) && triangles[0] < triangles[1], "{triangles:?}");
        assert!((place[0] - 0.5).abs() < 0.02 && (place[1] - 0.5).abs() < 0.02, "{place:?}");
        let message = checked(mesh).unwrap_err().to_string();
        assert!(message.contains("\"wall\"") && message.contains("both cover the place (0.50"), "{message}");
    }

    #[test]
    fn twice_the_same_place_is_found() {
        let overlap = checked(Mesh::cuboid(Vec3::ZERO, Vec3::ONE));
        assert!(matches!(overlap, Err(Error::OverlappingMapUvs { triangles: [0, 2], .. })), "{overlap:?}");
    }

    /// A disk of slivers around its middle that goes around some times.
    fn fan(slivers: u32, turns: f32) -> Mesh {
        let mut mesh = Mesh { positions: vec![Vec3::ZERO], uvs: vec![Vec2::ZERO], ..Mesh::default() };
        for k in 0..=slivers {
            let closes = turns == 1.0 && k == slivers;
            let angle = if closes { 0.0 } else { std::f32::consts::TAU * turns * k as f32 / slivers as f32 };
            mesh.uvs.push(Vec2::from_angle(angle));
            mesh.positions.push(mesh.uvs[k as usize + 1].extend(angle));
            mesh.triangles.extend((k > 0).then_some([0, k, k + 1]));
        }
        mesh
    }

    #[test]
    fn fans_are_checked_at_their_borders() {
        checked(fan(100_000, 1.0)).unwrap();
        checked(fan(20_000, 0.9)).unwrap();
        for overlapping in [fan(20_000, 1.1), fan(5_000, 2.0)] {
            let found = checked(overlapping);
            assert!(matches!(found, Err(Error::OverlappingMapUvs { .. })), "{found:?}");
        }
        // A triangle in the middle of a fan, which touches no border of that.
        let mut mesh = fan(20_000, 1.0);
        let first = mesh.positions.len() as u32;
        for corner in [[0.3, 0.2], [0.34, 0.2], [0.3, 0.23]] {
            mesh.uvs.push(corner.into());
            mesh.positions.push(Vec2::from(corner).extend(1.0));
        }
        mesh.triangles.push([first, first + 1, first + 2]);
        let found = checked(mesh);
        assert!(matches!(found, Err(Error::OverlappingMapUvs { triangles: [_, 20_000], .. })), "{found:?}");
    }

    #[test]
    fn a_folded_triangle_is_named() {
        let mut mesh = grid(2);
        mesh.uvs[4] = mesh.uvs[0];
        let folded = checked(mesh);
        assert!(matches!(folded, Err(Error::FoldedMapUvs { triangle: 0, .. })), "{folded:?}");
    }
}
