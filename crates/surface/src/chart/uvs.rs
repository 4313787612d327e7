//! Texture coordinates that serve as a map.

use diacaustic_scene::{Chart, Object, Scene};
use glam::{DVec2, Vec3};
use rayon::prelude::*;

use super::overlap::{FlatTriangles, overlap_depth};
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
    let flat = FlatTriangles::new(flat);
    let overlap = |k: usize, other: usize| overlap_depth(&flat.corners[k], &flat.corners[other]) > tolerance;
    // The first triangle that overlaps a later one, and the first of those.
    let overlapping = (0..has_area.len()).into_par_iter().find_map_first(|k| {
        let mut first = usize::MAX;
        flat.any_near(k, |other| {
            if other > k && other < first && overlap(k, other) {
                first = other;
            }
            false
        });
        (first != usize::MAX).then_some((k, first))
    });
    match overlapping {
        None => Ok(()),
        Some((k, other)) => Err(Error::OverlappingMapUvs {
            object: object.name.clone(),
            triangles: [has_area[k], has_area[other]],
            place: common_place(&flat.corners[k], &flat.corners[other]),
        }),
    }
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

    #[test]
    fn a_folded_triangle_is_named() {
        let mut mesh = grid(2);
        mesh.uvs[4] = mesh.uvs[0];
        let folded = checked(mesh);
        assert!(matches!(folded, Err(Error::FoldedMapUvs { triangle: 0, .. })), "{folded:?}");
    }
}
