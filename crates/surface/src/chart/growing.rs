//! Grows charts: patches that lie side by side and face about the same way.

use glam::DVec3;
use rayon::prelude::*;

use super::{
    absorbing::absorb_small,
    check::{Verdict, check},
    facets::{Facets, NONE},
    patches::Patches,
};

/// Cosine of the most that a patch's normal may turn from its chart's axis: 55°, so that a texel stands for at most 1/0.57 times its
/// own area.
const CONE: f64 = 0.573_576;
/// The same for a chart of less than [`SMALL`] texels that joins a neighbour: 70°.
const WIDE_CONE: f64 = 0.342_02;
/// Texels of area below which a chart rather joins a neighbour.
const SMALL: f64 = 16.0;
/// Rounds of growing and checking after which what still overlaps is not grown any more.
const MOST_ROUNDS: usize = 64;

/// A set of patches that is laid flat along one axis.
#[derive(Clone, Debug, Default)]
pub(super) struct Chart {
    /// Unit normal of the chart's plane.
    pub axis: DVec3,
    /// In the order in which they joined.
    pub patches: Vec<u32>,
}

/// Charts, and the one of each patch.
pub(super) struct Charts {
    pub charts: Vec<Chart>,
    /// [`NONE`] for patches without area that border on nothing.
    pub of: Vec<u32>,
    /// Whether a patch may face any way and lie on others, for no texel tells apart what is in it.
    pub is_rough: Vec<bool>,
}

/// Divides a surface into charts, none of which overlaps in its projection.
pub(super) fn grow_charts(facets: &Facets<'_>, patches: &Patches, texel: f64) -> Charts {
    let is_rough = (0..patches.count() as u32).map(|patch| patches.triangles(patch).len() > 1).collect();
    let mut grown = Charts { charts: Vec::new(), of: vec![NONE; patches.count()], is_rough };
    let mut waiting: Vec<u32> = (0..patches.count() as u32).collect();
    let mut unchecked: Vec<u32> = Vec::new();
    for round in 0.. {
        if waiting.is_empty() && unchecked.is_empty() {
            break;
        }
        let most = if round < MOST_ROUNDS { usize::MAX } else { 1 };
        let first = grown.charts.len() as u32;
        for seed in std::mem::take(&mut waiting) {
            let has_area = patches.double_areas[seed as usize] != glam::Vec3::ZERO;
            if has_area && grown.of[seed as usize] == NONE {
                waiting.extend(grown.grow(facets, patches, seed, most));
            }
        }
        if round == 0 {
            grown.join_small(facets, patches, texel);
        }
        unchecked.extend(first..grown.charts.len() as u32);
        let verdicts: Vec<_> =
            unchecked.par_iter().map(|&chart| check(facets, patches, &grown, chart, texel)).collect();
        let checked = std::mem::take(&mut unchecked);
        for (chart, verdict) in checked.into_iter().zip(verdicts) {
            match verdict {
                Verdict::Flat => {}
                Verdict::Without(removed) => {
                    grown.remove(chart, &removed);
                    waiting.extend(removed);
                }
                Verdict::Halves => unchecked.extend([chart, grown.halve(chart)]),
            }
        }
    }
    absorb_small(facets, patches, &mut grown, texel);
    grown
}

impl Chart {
    /// Its area, units².
    pub(super) fn area(&self, patches: &Patches) -> f64 {
        0.5 * self.patches.iter().map(|&patch| patches.double_areas[patch as usize].as_dvec3().length()).sum::<f64>()
    }
}

impl Charts {
    /// Grows a chart from a patch over those that no chart has; returns patches that it took up and gave back.
    fn grow(&mut self, facets: &Facets<'_>, patches: &Patches, seed: u32, most: usize) -> Vec<u32> {
        let number = self.charts.len() as u32;
        let mut chart = vec![seed];
        let mut sum = patches.double_areas[seed as usize].as_dvec3();
        let mut axis = sum.normalize();
        self.of[seed as usize] = number;
        let mut head = 0;
        while head < chart.len() && chart.len() < most {
            for &triangle in patches.triangles(chart[head]) {
                for next in facets.neighbours[triangle as usize].into_iter().filter(|&next| next != NONE) {
                    let patch = patches.of[next as usize];
                    let double_area = patches.double_areas[patch as usize].as_dvec3();
                    if self.of[patch as usize] == NONE && is_in_cone(axis, double_area, CONE) {
                        self.of[patch as usize] = number;
                        chart.push(patch);
                        sum += double_area;
                        axis = sum.normalize();
                    }
                }
            }
            head += 1;
        }
        // The axis has turned since the first patches joined.
        let is_kept = |patch: &u32| is_in_cone(axis, patches.double_areas[*patch as usize].as_dvec3(), CONE);
        let mut given_back: Vec<u32> = chart.iter().copied().filter(|patch| !is_kept(patch)).collect();
        chart.retain(is_kept);
        if chart.iter().all(|&patch| patches.double_areas[patch as usize] == glam::Vec3::ZERO) {
            given_back.extend(std::mem::replace(&mut chart, vec![seed]));
            given_back.retain(|&patch| patch != seed);
            axis = patches.double_areas[seed as usize].as_dvec3().normalize();
        }
        given_back.iter().for_each(|&patch| self.of[patch as usize] = NONE);
        self.charts.push(Chart { axis, patches: chart });
        given_back
    }

    /// Lets each chart of few texels join the neighbour with the longest common border that faces about the same way.
    fn join_small(&mut self, facets: &Facets<'_>, patches: &Patches, texel: f64) {
        let mut areas: Vec<f64> = self.charts.iter().map(|chart| chart.area(patches)).collect();
        for small in 0..self.charts.len() {
            if areas[small] >= SMALL * texel * texel {
                continue;
            }
            let Some(larger) = self.best_neighbour(facets, patches, small, &areas) else { continue };
            let moved = std::mem::take(&mut self.charts[small].patches);
            moved.iter().for_each(|&patch| self.of[patch as usize] = larger);
            self.charts[larger as usize].patches.extend(moved);
            areas[larger as usize] += std::mem::take(&mut areas[small]);
        }
    }

    fn best_neighbour(&self, facets: &Facets<'_>, patches: &Patches, chart: usize, areas: &[f64]) -> Option<u32> {
        let own = &self.charts[chart].patches;
        let beyond = own
            .iter()
            .flat_map(|&patch| patches.triangles(patch))
            .flat_map(|&triangle| facets.neighbours[triangle as usize])
            .filter(|&next| next != NONE)
            .map(|next| self.of[patches.of[next as usize] as usize]);
        let is_larger = |other: u32| (areas[other as usize], chart) > (areas[chart], other as usize);
        let mut bordering: Vec<u32> =
            beyond.filter(|&other| other != NONE && other as usize != chart && is_larger(other)).collect();
        bordering.sort_unstable();
        let mut longest_first: Vec<(usize, u32)> =
            bordering.chunk_by(|a, b| a == b).map(|edges| (edges.len(), edges[0])).collect();
        longest_first.sort_by_key(|&(edges, other)| (std::cmp::Reverse(edges), other));
        let faces_alike = |other: u32| {
            let axis = self.charts[other as usize].axis;
            own.iter().all(|&patch| is_in_cone(axis, patches.double_areas[patch as usize].as_dvec3(), WIDE_CONE))
        };
        longest_first.into_iter().map(|(_, other)| other).find(|&other| faces_alike(other))
    }

    /// Makes a chart of the later half of another's patches; returns its number.
    fn halve(&mut self, chart: u32) -> u32 {
        let number = self.charts.len() as u32;
        let Chart { axis, patches } = &mut self.charts[chart as usize];
        let half = Chart { axis: *axis, patches: patches.split_off(patches.len().div_ceil(2)) };
        half.patches.iter().for_each(|&patch| self.of[patch as usize] = number);
        self.charts.push(half);
        number
    }

    /// Takes patches out of a chart.
    fn remove(&mut self, chart: u32, removed: &[u32]) {
        removed.iter().for_each(|&patch| self.of[patch as usize] = NONE);
        let of = &self.of;
        self.charts[chart as usize].patches.retain(|&patch| of[patch as usize] == chart);
    }
}

/// Whether a normal of any length is within an angle of an axis; none at all is.
fn is_in_cone(axis: DVec3, normal: DVec3, cosine: f64) -> bool {
    axis.dot(normal) >= cosine * normal.length()
}
