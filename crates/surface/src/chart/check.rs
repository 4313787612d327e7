//! Checks that a chart does not overlap in its projection.

use glam::{DVec2, DVec3};

use super::{
    facets::Facets,
    growing::Charts,
    overlap::{FlatTriangles, overlap_depth},
    patches::Patches,
};

/// Texels of height between which surfaces of small triangles lie one behind the other, and are not just rough.
const ROUGHNESS: f64 = 4.0;

/// What a check of a chart found.
pub(super) struct Verdict {
    /// Patches that the chart has to give up.
    pub removed: Vec<u32>,
    /// Whether the rest is known not to overlap.
    pub is_settled: bool,
}

/// Checks one chart.
///
/// Triangles that are a patch of their own face along the axis, so that a place is covered as often as the border of their union winds
/// around it: if two overlap, one at the border and some other do. Patches of several triangles may be rough; of them, one triangle
/// each is looked at, and two overlap if one lies several texels behind the other.
pub(super) fn check(facets: &Facets<'_>, patches: &Patches, charts: &Charts, chart: u32, texel: f64) -> Verdict {
    let own = &charts.charts[chart as usize].patches;
    if own.len() < 2 {
        return Verdict { removed: Vec::new(), is_settled: true };
    }
    let flat = FlatChart::new(facets, patches, charts, chart, texel);
    let is_at_border = |k: usize| {
        let beyond = facets.neighbours[flat.triangles[k] as usize];
        beyond.iter().any(|&next| {
            next == super::facets::NONE || {
                let patch = patches.of[next as usize];
                charts.of[patch as usize] != chart || patches.triangles(patch).len() > 1
            }
        })
    };
    let overlaps = (0..flat.triangles.len())
        .filter(|&k| flat.is_looked_at(k) && (!flat.is_single[k] || is_at_border(k)))
        .any(|k| flat.flat.any_near(k, |other| flat.overlap(k, other)));
    if !overlaps {
        return Verdict { removed: Vec::new(), is_settled: true };
    }
    let removed = flat.latecomers(own.len());
    if 2 * removed.len() > own.len() {
        // Too much overlaps, such as the turns of a screw: halves are checked anew.
        return Verdict { removed: own[own.len().div_ceil(2)..].to_vec(), is_settled: false };
    }
    Verdict { removed: removed.into_iter().map(|place| own[place]).collect(), is_settled: true }
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
}

impl FlatChart {
    fn new(facets: &Facets<'_>, patches: &Patches, charts: &Charts, chart: u32, texel: f64) -> Self {
        let chart = &charts.charts[chart as usize];
        let (u, v) = chart.axis.any_orthonormal_pair();
        let turn = |p: DVec3| DVec3::new(p.dot(u), p.dot(v), p.dot(chart.axis));
        let (mut triangles, mut place, mut is_single) = (Vec::new(), Vec::new(), Vec::new());
        for (number, &patch) in chart.patches.iter().enumerate() {
            let members = patches.triangles(patch);
            for &triangle in members.iter().filter(|&&triangle| facets.area(triangle) > 0.0) {
                triangles.push(triangle);
                place.push(number as u32);
                is_single.push(members.len() == 1);
            }
        }
        let corners = |triangle: u32| facets.corners(triangle).map(turn);
        let middle = |&triangle: &u32| corners(triangle).into_iter().sum::<DVec3>() / 3.0;
        let normal = |&triangle: &u32| turn(facets.double_areas[triangle as usize].as_dvec3().normalize_or_zero());
        Self {
            flat: FlatTriangles::new(triangles.iter().map(|&t| corners(t).map(|p| p.truncate())).collect()),
            middles: triangles.iter().map(middle).collect(),
            normals: triangles.iter().map(normal).collect(),
            triangles,
            place,
            is_single,
            tolerance: facets.rounding,
            roughness: ROUGHNESS * texel,
        }
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
