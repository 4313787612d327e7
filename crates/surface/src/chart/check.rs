//! Checks that a chart does not overlap in its projection.

use glam::{DVec2, DVec3};
use rayon::prelude::*;

use super::{
    facets::{Facets, NONE},
    growing::Charts,
    overlap::{FlatTriangles, MANY_BOXES, overlap_depth, shares_of_box},
    patches::Patches,
};

/// Texels of height between which surfaces of small triangles lie one behind the other, and are not just rough.
const ROUGHNESS: f64 = 4.0;

/// How much more area than its box a chart may have before it is halved unseen.
const MOST_COVER: f64 = 1.5;
/// What a check of a chart found.
pub(super) enum Verdict {
    /// No overlap.
    Flat,
    /// Patches without which there is none.
    Without(Vec<u32>),
    /// So much overlap, such as in the turns of a screw, that its halves are checked anew.
    Halves,
}

/// Checks one chart.
///
/// Triangles that are a patch of their own face along the axis, so that a place is covered as often as the border of their union winds
/// around it: if two overlap, one at the border and some other do. Patches of several triangles may be rough; of them, one triangle
/// each is looked at, and two overlap if one lies several texels behind the other.
pub(super) fn check(facets: &Facets<'_>, patches: &Patches, charts: &Charts, chart: u32, texel: f64) -> Verdict {
    let own = &charts.charts[chart as usize].patches;
    if own.len() < 2 {
        return Verdict::Flat;
    }
    let flat = FlatChart::new(facets, patches, charts, chart, texel);
    if flat.cover > MOST_COVER {
        return Verdict::Halves;
    }
    let is_at_border = |triangle: u32, edge: usize| {
        let beyond = facets.neighbours[triangle as usize][edge];
        beyond == NONE || {
            let patch = patches.of[beyond as usize];
            charts.of[patch as usize] != chart || charts.is_rough[patch as usize]
        }
    };
    if !flat.overlaps_at_border(is_at_border) && !flat.has_layers() {
        return Verdict::Flat;
    }
    if flat.boxes > MANY_BOXES {
        return Verdict::Halves;
    }
    let removed = flat.latecomers(own.len());
    if 2 * removed.len() > own.len() {
        return Verdict::Halves;
    }
    Verdict::Without(removed.into_iter().map(|place| own[place]).collect())
}

/// The patches of a chart, all of whose overlaps are with rough ones, that lie far behind or in front of earlier ones.
pub(super) fn far_behind(facets: &Facets<'_>, patches: &Patches, charts: &Charts, chart: u32, texel: f64) -> Vec<u32> {
    let own = &charts.charts[chart as usize].patches;
    let flat = FlatChart::new(facets, patches, charts, chart, texel);
    if flat.boxes > MANY_BOXES {
        return own.iter().copied().filter(|&patch| charts.is_rough[patch as usize]).collect();
    }
    let removed = if flat.has_layers() { flat.latecomers(own.len()) } else { Vec::new() };
    removed.into_iter().map(|place| own[place]).collect()
}

/// A chart's triangles with an area, laid flat.
struct FlatChart {
    /// Their numbers.
    triangles: Vec<u32>,
    flat: FlatTriangles,
    /// For each, the place of its patch in the chart.
    place: Vec<u32>,
    /// Whether it is a patch of its own.
    is_single: Vec<bool>,
    /// Its middle; z along the axis.
    middles: Vec<DVec3>,
    /// Its unit normal.
    normals: Vec<DVec3>,
    tolerance: f64,
    roughness: f64,
    /// The triangles' area in that of the box around all of them.
    cover: f64,
    /// The area of the boxes around each.
    boxes: f64,
}

impl FlatChart {
    fn new(facets: &Facets<'_>, patches: &Patches, charts: &Charts, chart: u32, texel: f64) -> Self {
        let is_rough = &charts.is_rough;
        let chart = &charts.charts[chart as usize];
        let (u, v) = chart.axis.any_orthonormal_pair();
        let turn = |p: DVec3| DVec3::new(p.dot(u), p.dot(v), p.dot(chart.axis));
        let (mut triangles, mut place, mut is_single) = (Vec::new(), Vec::new(), Vec::new());
        for (number, &patch) in chart.patches.iter().enumerate() {
            let members = patches.triangles(patch);
            for &triangle in members.iter().filter(|&&triangle| facets.area(triangle) > 0.0) {
                triangles.push(triangle);
                place.push(number as u32);
                is_single.push(!is_rough[patch as usize]);
            }
        }
        let corners = |triangle: u32| facets.corners(triangle).map(turn);
        let middle = |&triangle: &u32| corners(triangle).into_iter().sum::<DVec3>() / 3.0;
        let normal = |&triangle: &u32| turn(facets.double_areas[triangle as usize].as_dvec3().normalize_or_zero());
        let flat: Vec<[DVec2; 3]> = triangles.iter().map(|&t| corners(t).map(|p| p.truncate())).collect();
        let (cover, boxes) = shares_of_box(&flat);
        Self {
            flat: FlatTriangles::new(flat),
            cover,
            boxes,
            middles: triangles.iter().map(middle).collect(),
            normals: triangles.iter().map(normal).collect(),
            triangles,
            place,
            is_single,
            tolerance: facets.rounding,
            roughness: ROUGHNESS * texel,
        }
    }

    /// Whether triangles that are patches of their own overlap, one of them at the border.
    ///
    /// How often places beside an edge of the border are covered changes only where the border touches that edge.
    fn overlaps_at_border(&self, is_at_border: impl Fn(u32, usize) -> bool) -> bool {
        let edges =
            (0..self.triangles.len()).filter(|&k| self.is_single[k]).flat_map(|k| [0, 1, 2].map(|edge| (k, edge)));
        let border: Vec<(usize, usize)> = edges.filter(|&(k, edge)| is_at_border(self.triangles[k], edge)).collect();
        let ends = |(k, edge): (usize, usize)| [self.flat.corners[k][edge], self.flat.corners[k][(edge + 1) % 3]];
        let outline = FlatTriangles::new(border.iter().map(|&at| ends(at)).map(|[a, b]| [a, b, b]).collect());
        border.par_iter().enumerate().any(|(number, &at)| {
            let (k, [a, b]) = (at.0, ends(at));
            let touches = |other: usize| touch([a, b], ends(border[other]), self.tolerance);
            let beside = 0.5 * (a + b) + (b - a).perp().normalize_or_zero() * 4.0 * self.tolerance;
            let covers = |other: usize| other != k && reaches(&self.flat.corners[other], beside, self.tolerance);
            let may_overlap = outline.any_near(number, touches) || self.flat.any_in((beside, beside), covers);
            may_overlap && (self.boxes > MANY_BOXES || self.flat.any_near(k, |other| self.overlap(k, other)))
        })
    }

    /// Whether something lies far behind one of the rough patches.
    fn has_layers(&self) -> bool {
        let rough = |k: &usize| self.is_looked_at(*k) && !self.is_single[*k];
        (0..self.triangles.len())
            .into_par_iter()
            .filter(rough)
            .any(|k| self.flat.any_near(k, |other| self.overlap(k, other)))
    }

    /// Whether a triangle is the first of its patch.
    fn is_looked_at(&self, k: usize) -> bool {
        k == 0 || self.place[k - 1] != self.place[k]
    }

    fn overlap(&self, k: usize, other: usize) -> bool {
        if self.place[k] == self.place[other] {
            return false;
        }
        let depth = overlap_depth(&self.flat.corners[k], &self.flat.corners[other]);
        if self.is_single[k] && self.is_single[other] {
            return depth > self.tolerance;
        }
        let (rough, second) = if self.is_single[k] { (other, k) } else { (k, other) };
        let at = self.middles[rough];
        depth > 0.0 && (at.z - self.height(second, at.truncate())).abs() > self.roughness
    }

    /// The height of a triangle's plane at a place, of a triangle of a rough patch that of its middle.
    fn height(&self, k: usize, at: DVec2) -> f64 {
        let (middle, normal) = (self.middles[k], self.normals[k]);
        let slope = if self.is_single[k] { normal.truncate() / normal.z } else { DVec2::ZERO };
        middle.z - slope.dot(at - middle.truncate())
    }

    /// The places of the patches that overlap an earlier one that stays.
    fn latecomers(&self, patches: usize) -> Vec<usize> {
        let mut stays = vec![false; patches];
        let mut removed = Vec::new();
        for k in (0..self.triangles.len()).filter(|&k| self.is_looked_at(k)) {
            let place = self.place[k] as usize;
            if self.flat.any_near(k, |other| stays[self.place[other] as usize] && self.overlap(k, other)) {
                removed.push(place);
            } else {
                stays[place] = true;
            }
        }
        removed
    }
}

/// Whether two edges come within a distance of each other, other than at an end that they have in common.
fn touch(one: [DVec2; 2], other: [DVec2; 2], distance: f64) -> bool {
    let near = |p: DVec2, [a, b]: [DVec2; 2]| {
        let along = b - a;
        let t = ((p - a).dot(along) / along.length_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
        p.distance(a + along * t) <= distance
    };
    let is_shared = |p: DVec2, edge: [DVec2; 2]| edge.contains(&p);
    let ends_touch =
        |edge: [DVec2; 2], beside: [DVec2; 2]| edge.into_iter().any(|p| !is_shared(p, beside) && near(p, beside));
    let side = |[a, b]: [DVec2; 2], p: DVec2| (b - a).perp_dot(p - a);
    let parts = |edge: [DVec2; 2], [a, b]: [DVec2; 2]| side(edge, a) * side(edge, b) < 0.0;
    one == other
        || one == [other[1], other[0]]
        || ends_touch(one, other)
        || ends_touch(other, one)
        || (parts(one, other) && parts(other, one))
}

/// Whether a place is in a triangle or within a distance of the lines along its edges.
fn reaches(triangle: &[DVec2; 3], place: DVec2, distance: f64) -> bool {
    let turn = (triangle[1] - triangle[0]).perp_dot(triangle[2] - triangle[0]).signum();
    (0..3).all(|k| {
        let along = (triangle[(k + 1) % 3] - triangle[k]).normalize_or_zero();
        turn * along.perp_dot(place - triangle[k]) >= -distance
    })
}

#[cfg(test)]
mod tests {
    use diacaustic_scene::{Mesh, Object};
    use glam::Vec3;

    use super::*;
    use crate::chart::growing::Chart;

    /// Of a chart of two rough triangles, one `height` texels above the other, the patches that are too far behind.
    fn behind(height: f32) -> Vec<u32> {
        let triangle = [Vec3::ZERO, Vec3::X, Vec3::Y];
        let positions = triangle.into_iter().chain(triangle.map(|p| 0.5 * p + Vec3::Z * height)).collect();
        let mesh = Mesh { positions, triangles: vec![[0, 1, 2], [3, 4, 5]], ..Mesh::default() };
        let object = Object {
            name: String::new(),
            mesh: mesh.into(),
            world_from_object: glam::Affine3A::IDENTITY,
            materials: vec![0],
            map_size: None,
        };
        let facets = Facets::new(&object);
        let texel = facets.metres.recip();
        let patches = Patches::new(&facets, 0.0);
        let chart = Chart { axis: DVec3::Z, patches: vec![0, 1] };
        let charts = Charts { charts: vec![chart], of: vec![0, 0], is_rough: vec![false, true] };
        far_behind(&facets, &patches, &charts, 0, texel)
    }

    #[test]
    fn what_is_several_texels_behind_is_found() {
        assert!(behind(3.9).is_empty());
        assert_eq!(behind(4.1), [1]);
        assert_eq!(behind(-4.1), [1]);
    }
}
