//! A mesh as charts are grown on it: placed, scaled to the unit cube, welded by position.

use diacaustic_scene::{Mesh, Object};
use glam::{DVec3, Mat3, Vec3};
use rayon::prelude::*;

/// No triangle, patch or chart.
pub(super) const NONE: u32 = u32::MAX;

/// The triangles of an object and which of them share an edge.
pub(super) struct Facets<'a> {
    pub mesh: &'a Mesh,
    /// The mesh's positions as placed, from −1 to 1 along the longest side of their box. Equal positions stay equal.
    pub points: Vec<Vec3>,
    /// Metres in a unit of `points`.
    pub metres: f64,
    /// How far single precision may have moved a corner, units.
    pub rounding: f64,
    /// Twice each triangle's area times its unit normal, units².
    pub double_areas: Vec<Vec3>,
    /// For each triangle the one beyond each edge, of which edge k leads from corner k to corner k + 1; [`NONE`] where an edge is not
    /// passed exactly once in each direction.
    pub neighbours: Vec<[u32; 3]>,
    /// Whether every edge is passed equally often in both directions.
    pub is_closed: bool,
}

impl<'a> Facets<'a> {
    pub(super) fn new(object: &'a Object) -> Self {
        let mesh = &*object.mesh;
        let linear = Mat3::from(object.world_from_object.matrix3);
        let placed: Vec<Vec3> = mesh.positions.par_iter().map(|&p| linear * p).collect();
        let (low, high) =
            placed.iter().fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(low, high), &p| (low.min(p), high.max(p)));
        let (low, high) = (low.as_dvec3(), high.as_dvec3());
        let metres = (0.5 * (high - low).max_element()).max(f64::MIN_POSITIVE);
        let metres = if metres.is_finite() { metres } else { 1.0 };
        let farthest = low.abs().max(high.abs()).max_element();
        let rounding = 4.0 * f64::from(f32::EPSILON) * (1.0 + farthest / metres);
        let center = 0.5 * (low + high);
        let points: Vec<Vec3> = placed
            .par_iter()
            .map(|p| ((p.as_dvec3() - center) / metres).as_vec3())
            .map(|p| if p.is_finite() { p } else { Vec3::ZERO })
            .collect();
        let double_area = |corners: &[u32; 3]| {
            let [a, b, c] = corners.map(|vertex| points[vertex as usize].as_dvec3());
            (b - a).cross(c - a).as_vec3()
        };
        let double_areas = mesh.triangles.par_iter().map(double_area).collect();
        let (neighbours, is_closed) = join_edges(mesh, &mesh.welded_vertices());
        Self { mesh, points, metres, rounding, double_areas, neighbours, is_closed }
    }

    /// The corners of a triangle, units.
    pub(super) fn corners(&self, triangle: u32) -> [DVec3; 3] {
        self.mesh.triangles[triangle as usize].map(|vertex| self.points[vertex as usize].as_dvec3())
    }

    /// The corners of those of some triangles that have an area, units.
    pub(super) fn corners_with_area(&self, triangles: &[u32]) -> impl Iterator<Item = DVec3> {
        triangles.iter().filter(|&&triangle| self.area(triangle) > 0.0).flat_map(|&triangle| self.corners(triangle))
    }

    /// A triangle's area, units².
    pub(super) fn area(&self, triangle: u32) -> f64 {
        0.5 * self.double_areas[triangle as usize].as_dvec3().length()
    }

    /// The length of a triangle's longest edge, units.
    pub(super) fn longest_edge(&self, triangle: u32) -> f64 {
        let [a, b, c] = self.corners(triangle);
        (b - a).length().max((c - b).length()).max((a - c).length())
    }

    /// The surface's area, units².
    pub(super) fn total_area(&self) -> f64 {
        (0..self.mesh.triangles.len() as u32).map(|triangle| self.area(triangle)).sum()
    }
}

/// One passage of an edge, kept with the lower of its two vertices.
#[derive(Clone, Copy, Default)]
struct Passage {
    /// The higher vertex.
    to: u32,
    /// Three times the triangle plus the edge's number.
    slot: u32,
    /// Whether it leads from the lower vertex to the higher.
    upwards: bool,
}

/// The neighbours across each triangle's edges, and whether the surface is closed.
fn join_edges(mesh: &Mesh, welded: &[u32]) -> (Vec<[u32; 3]>, bool) {
    let passages = |triangle: usize| {
        let [a, b, c] = mesh.triangles[triangle].map(|vertex| welded[vertex as usize]);
        [(a, b), (b, c), (c, a)].into_iter().enumerate().filter(|(_, (from, to))| from != to)
    };
    let mut ends = vec![0u32; welded.len() + 1];
    for triangle in 0..mesh.triangles.len() {
        passages(triangle).for_each(|(_, (from, to))| ends[from.min(to) as usize] += 1);
    }
    let mut total = 0;
    for end in &mut ends {
        total += std::mem::replace(end, total);
    }
    let mut sorted = vec![Passage::default(); total as usize];
    for triangle in 0..mesh.triangles.len() {
        for (edge, (from, to)) in passages(triangle) {
            let end = &mut ends[from.min(to) as usize];
            sorted[*end as usize] =
                Passage { to: from.max(to), slot: 3 * triangle as u32 + edge as u32, upwards: from < to };
            *end += 1;
        }
    }
    let mut neighbours = vec![[NONE; 3]; mesh.triangles.len()];
    let mut is_closed = true;
    let mut first = 0;
    for &end in &ends[..welded.len()] {
        let of_vertex = &mut sorted[first..end as usize];
        first = end as usize;
        of_vertex.sort_unstable_by_key(|passage| (passage.to, passage.slot));
        for of_edge in of_vertex.chunk_by(|a, b| a.to == b.to) {
            is_closed &= 2 * of_edge.iter().filter(|passage| passage.upwards).count() == of_edge.len();
            if let [one, other] = of_edge
                && one.upwards != other.upwards
            {
                neighbours[one.slot as usize / 3][one.slot as usize % 3] = other.slot / 3;
                neighbours[other.slot as usize / 3][other.slot as usize % 3] = one.slot / 3;
            }
        }
    }
    (neighbours, is_closed)
}
