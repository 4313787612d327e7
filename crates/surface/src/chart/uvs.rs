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
