//! Small charts join larger ones beside them.

use std::collections::HashSet;

use glam::Vec3;
use rayon::prelude::*;

use super::{
    check::far_behind,
    facets::{Facets, NONE},
    growing::Charts,
    patches::Patches,
};

/// Texels of area below which charts join those around them that have as many, one after the other.
const SMALL: [f64; 4] = [1.0, 2.0, 4.0, 8.0];
/// Texels of area from which on a chart shows more than a mean, and only joins charts that face about as each of its patches.
const SHOWS_FACES: f64 = 4.0;
/// Cosine of the most that the normal of such a patch may turn from the axis of the chart that takes it: 80°.
const STEEP: f64 = 0.173_648;
/// Patches from the border of the chart that takes a patch to that patch, at most.
const MOST_STEPS: usize = 6;

/// Lets each small chart's patches join the charts around it: all, or none if something would lie far in front of other surface or behind.
///
/// Charts of triangles wider than a texel stay. The others' may then be seen edge-on or from behind and lie on other surface, for no texel
/// tells apart what is in it.
pub(super) fn absorb_small(facets: &Facets<'_>, patches: &Patches, grown: &mut Charts, texel: f64) {
    let mut absorbing = Absorbing { facets, patches, grown, texel };
    for least in SMALL {
        let given = absorbing.give(least);
        absorbing.settle(given);
    }
}

struct Absorbing<'a> {
    facets: &'a Facets<'a>,
    patches: &'a Patches,
    grown: &'a mut Charts,
    texel: f64,
}

/// A patch that goes from one chart to another.
struct Given {
    patch: u32,
    from: u32,
    to: u32,
}

impl Absorbing<'_> {
    /// Finds where the patches of charts of less than so many texels go, step by step from the borders of charts of at least as many.
    fn give(&mut self, least: f64) -> Vec<Given> {
        let whole = self.texel * self.texel;
        let areas: Vec<f64> = self.grown.charts.par_iter().map(|chart| chart.area(self.patches) / whole).collect();
        let small = self.grown.charts.par_iter().zip(&areas).filter(|(_, area)| **area < least);
        let narrow = small.filter(|(chart, _)| chart.patches.iter().all(|&patch| self.is_narrow(patch)));
        let mut free: Vec<u32> = narrow.flat_map_iter(|(chart, _)| chart.patches.iter().copied()).collect();
        let mut given: Vec<Given> = Vec::new();
        for _ in 0..MOST_STEPS {
            let step: Vec<Given> = free.par_iter().filter_map(|&patch| self.taker(patch, &areas, least)).collect();
            if step.is_empty() {
                break;
            }
            step.iter().for_each(|given| self.grown.of[given.patch as usize] = given.to);
            free.retain(|&patch| areas[self.grown.of[patch as usize] as usize] < least);
            given.extend(step);
        }
        let stay: HashSet<u32> = free.iter().map(|&patch| self.grown.of[patch as usize]).collect();
        self.without(given, &stay)
    }

    /// Whether a patch's triangles are smaller than a texel.
    fn is_narrow(&self, patch: u32) -> bool {
        let is_narrow = |&triangle: &u32| self.facets.longest_edge(triangle) < self.texel;
        self.patches.double_areas[patch as usize] != Vec3::ZERO && self.patches.triangles(patch).iter().all(is_narrow)
    }

    /// Where a patch of a small chart goes: of the charts of enough texels that border on it, to the one that faces most as it does.
    fn taker(&self, patch: u32, areas: &[f64], least: f64) -> Option<Given> {
        let from = self.grown.of[patch as usize];
        let steepest = if areas[from as usize] < SHOWS_FACES { -1.0 } else { STEEP };
        let normal = self.patches.double_areas[patch as usize].as_dvec3().normalize();
        let facing = |chart: u32| self.grown.charts[chart as usize].axis.dot(normal);
        let triangles = self.patches.triangles(patch).iter();
        let beyond = triangles.flat_map(|&triangle| self.facets.neighbours[triangle as usize]);
        let to = beyond
            .filter(|&next| next != NONE)
            .map(|next| self.grown.of[self.patches.of[next as usize] as usize])
            .filter(|&chart| chart != NONE && areas[chart as usize] >= least && facing(chart) >= steepest)
            .max_by(|&a, &b| facing(a).total_cmp(&facing(b)).then(b.cmp(&a)))?;
        Some(Given { patch, from, to })
    }

    /// Hands over what is given, but for charts of which a patch would lie far behind others.
    fn settle(&mut self, given: Vec<Given>) {
        for Given { patch, to, .. } in &given {
            self.grown.charts[*to as usize].patches.push(*patch);
            self.grown.is_rough[*patch as usize] = true;
        }
        let takers: HashSet<u32> = given.iter().map(|given| given.to).collect();
        let far_behind = |&chart: &u32| far_behind(self.facets, self.patches, self.grown, chart, self.texel);
        let behind: HashSet<u32> = takers.par_iter().flat_map_iter(far_behind).collect();
        let misplaced = given.iter().filter(|given| behind.contains(&given.patch));
        let stay: HashSet<u32> = misplaced.map(|given| given.from).collect();
        self.without(given, &stay);
        let of = &self.grown.of;
        let charts = self.grown.charts.par_iter_mut().enumerate();
        charts.for_each(|(number, chart)| chart.patches.retain(|&patch| of[patch as usize] == number as u32));
    }

    /// What is given without the patches of charts that stay, which go back to these.
    fn without(&mut self, given: Vec<Given>, stay: &HashSet<u32>) -> Vec<Given> {
        let (back, given): (Vec<Given>, Vec<Given>) = given.into_iter().partition(|given| stay.contains(&given.from));
        back.iter().for_each(|given| self.grown.of[given.patch as usize] = given.from);
        given
    }
}
