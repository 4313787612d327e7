//! Texels that hold but a scrap of their chart, at its border: a photon there would make a speck. They become one with texels beside them.

use std::collections::HashMap;

use glam::DVec3;

use super::{
    Map, Weld, WeldPart, Welds,
    nodes::{Nodes, Scrap},
    seams::{Beside, FACING, Seam, seams},
};

/// Nodes of a group from which on what lies beside it on other charts is joined first: where a chart is thinner than texels for long.
const MANY_NODES: usize = 16;
/// Nodes of a group from which on it joins others only if it must, and no more of its own chart.
const MOST_NODES: usize = 64;
/// Nodes of a group that is given up if it has not enough surface by then.
const MOST_JOINED: usize = 256;

/// Joins scraps to what is beside them in the same chart, the smallest first, until together they are large enough; where the chart has no more,
/// to what is beside them on others.
pub(super) fn join_scraps(map: &Map<'_>, welds: Welds) -> Welds {
    let nodes = Nodes::new(map, &welds);
    let count = map.surfaces.len() + welds.welds.len();
    let mut scraps = Scraps { nodes, parents: vec![NONE; count], group_of: vec![NONE; count], groups: Vec::new() };
    for chart in scraps.nodes.small_charts() {
        scraps.join_all(chart);
    }
    for scrap in scraps.nodes.scraps() {
        scraps.grow(scrap.nodes[0], scrap.least);
    }
    scraps.join_charts();
    if scraps.groups.is_empty() { welds } else { scraps.joined() }
}

/// A map's nodes, and which of them become one.
struct Scraps<'t> {
    nodes: Nodes<'t>,
    /// For each node the next towards the root of its group, or [`NONE`] of a root.
    parents: Vec<u32>,
    /// The number of the group of each root, or [`NONE`] of a node alone.
    group_of: Vec<u32>,
    groups: Vec<Group>,
}

/// No node or group.
const NONE: u32 = u32::MAX;

/// Nodes that become one.
#[derive(Default)]
struct Group {
    /// Their surface, m².
    area: f64,
    nodes: Vec<u64>,
    /// Nodes beside them in their charts, in any order.
    beside: Vec<u64>,
    /// The area that they should have, but do not find in their chart, m²; 0 of others.
    lacks: f64,
    /// The sum of the surfaces' normals, and nodes of other charts beside them with theirs; of groups that were stuck.
    normal: DVec3,
    across: Vec<(u64, DVec3)>,
}

impl Group {
    fn absorb(&mut self, other: Self) {
        self.area += other.area;
        self.nodes.extend(other.nodes);
        self.beside.extend(other.beside);
        self.normal += other.normal;
        self.across.extend(other.across);
        self.lacks = 0.0;
    }
}

impl Scraps<'_> {
    /// Makes a group of all nodes of a small chart.
    fn join_all(&mut self, chart: Scrap) {
        let Scrap { nodes, least } = chart;
        let root = nodes[0];
        nodes[1..].iter().for_each(|&node| self.parents[node as usize] = root as u32);
        let area = nodes.iter().map(|&node| self.nodes.area(node)).sum();
        self.put_group(root, Group { area, nodes, lacks: least, ..Group::default() });
    }

    /// Joins the group of a scrap to what is beside it in its chart, until it covers enough or is stuck.
    fn grow(&mut self, scrap: u64, least: f64) {
        loop {
            let root = self.root(scrap);
            if self.area(root) >= least || self.group(root).is_some_and(|group| group.lacks >= least) {
                return;
            }
            let mut own = self.take_group(root);
            let beside = if own.nodes.len() < MANY_NODES { self.roots_beside(root, &own) } else { Vec::new() };
            let Some(other) = self.fitting(&own, least, beside) else {
                own.lacks = least;
                self.put_group(root, own);
                return;
            };
            self.join(root, own, other);
        }
    }

    /// Joins groups that are stuck to what is beside them on other charts.
    fn join_charts(&mut self) {
        let stuck = self.groups.iter().filter(|group| group.lacks > 0.0 && !group.nodes.is_empty());
        let mut stuck: Vec<(f64, u64, f64)> =
            stuck.map(|group| (group.area, self.root(group.nodes[0]), group.lacks)).collect();
        stuck.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let nodes = stuck.iter().flat_map(|(_, root, _)| {
            self.group(*root).into_iter().flat_map(|group| &group.nodes).map(move |&node| (node, *root))
        });
        let mut texels: Vec<(u64, u64)> = nodes
            .flat_map(|(node, root)| self.nodes.sources(node).into_iter().map(move |part| (part.index, root)))
            .collect();
        texels.sort_unstable();
        texels.dedup();
        let wanted: Vec<u64> = texels.iter().map(|&(texel, _)| texel).collect();
        for Seam { texel, normal, beside } in
            if wanted.is_empty() { Vec::new() } else { seams(self.nodes.map, &wanted) }
        {
            let first = texels.partition_point(|&(other, _)| other < texel);
            let across = beside.into_iter().flat_map(|Beside { texel, normal, .. }| {
                self.nodes.of_texel(texel).into_iter().map(move |node| (node, normal))
            });
            let across: Vec<(u64, DVec3)> = across.collect();
            for (_, root) in texels[first..].iter().take_while(|(other, _)| *other == texel) {
                if let Some(group) = self.groups.get_mut(self.group_of[*root as usize] as usize) {
                    group.normal += normal;
                    group.across.extend(&across);
                }
            }
        }
        for (_, node, least) in stuck {
            self.grow_across(node, least);
        }
    }

    /// Joins the group of a node to what is beside it on other charts, or in its own.
    fn grow_across(&mut self, node: u64, least: f64) {
        loop {
            let root = self.root(node);
            if self.area(root) >= least {
                return;
            }
            let own = self.take_group(root);
            let across = self.fitting(&own, least, self.roots_across(root, &own));
            let is_given_up = own.nodes.len() >= if across.is_some() { MOST_JOINED } else { MOST_NODES };
            let other =
                across.or_else(|| self.fitting(&own, least, self.roots_beside(root, &own))).filter(|_| !is_given_up);
            match other {
                Some(other) => self.join(root, own, other),
                None => {
                    self.put_group(root, own);
                    return;
                }
            }
        }
    }

    /// The groups beside one in its chart, by their roots.
    fn roots_beside(&self, root: u64, own: &Group) -> Vec<u64> {
        own.beside.iter().map(|&node| self.root(node)).filter(|&other| other != root).collect()
    }

    /// The groups beside one on other charts that face about as it does.
    fn roots_across(&self, root: u64, own: &Group) -> Vec<u64> {
        let is_alike = |&(other, normal): &(u64, DVec3)| {
            let known = self.group(other).map_or(DVec3::ZERO, |group| group.normal);
            let normal = if known == DVec3::ZERO { normal } else { known };
            other != root && normal.dot(own.normal) >= FACING * normal.length() * own.normal.length()
        };
        let across = own.across.iter().map(|&(node, normal)| (self.root(node), normal));
        across.filter(is_alike).map(|(other, _)| other).collect()
    }

    /// Of groups the one that a group best joins: the smallest that suffices, or else the largest; those that both would be many nodes with last.
    fn fitting(&self, own: &Group, least: f64, mut others: Vec<u64>) -> Option<u64> {
        others.sort_unstable();
        others.dedup();
        let fit = |other: u64| {
            let area = self.area(other);
            let suffices = own.area + area >= least;
            let is_few = own.nodes.len() + self.group(other).map_or(1, |group| group.nodes.len()) <= MOST_NODES;
            ((is_few, suffices), if suffices { -area } else { area }, other)
        };
        let best = others.into_iter().map(fit).max_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
        best.map(|(_, _, other)| other)
    }

    /// Joins a group, taken out of the list, to another.
    fn join(&mut self, root: u64, own: Group, other: u64) {
        let theirs = self.take_group(other);
        let (root, mut group, joining, joined) =
            if theirs.area >= own.area { (other, theirs, root, own) } else { (root, own, other, theirs) };
        group.absorb(joined);
        self.parents[joining as usize] = root as u32;
        self.put_group(root, group);
    }

    fn root(&self, mut node: u64) -> u64 {
        while self.parents[node as usize] != NONE {
            node = u64::from(self.parents[node as usize]);
        }
        node
    }

    /// The group of a root, if it is of several nodes or stuck.
    fn group(&self, root: u64) -> Option<&Group> {
        self.groups.get(self.group_of[root as usize] as usize)
    }

    /// The surface behind the group of a root, m².
    fn area(&self, root: u64) -> f64 {
        self.group(root).map_or_else(|| self.nodes.area(root), |group| group.area)
    }

    /// The group of a root, out of the list.
    fn take_group(&mut self, root: u64) -> Group {
        match self.groups.get_mut(self.group_of[root as usize] as usize) {
            Some(group) => std::mem::take(group),
            None => Group {
                area: self.nodes.area(root),
                nodes: vec![root],
                beside: self.nodes.beside(root),
                ..Group::default()
            },
        }
    }

    /// Puts the group of a root into the list.
    fn put_group(&mut self, root: u64, group: Group) {
        let number = &mut self.group_of[root as usize];
        if *number == NONE {
            *number = self.groups.len() as u32;
            self.groups.push(group);
        } else {
            self.groups[*number as usize] = group;
        }
    }

    /// The map's welds, with one for each group in place of those in it.
    fn joined(&self) -> Welds {
        let texels = self.nodes.texels();
        let several = self.groups.iter().filter(|group| group.nodes.len() > 1);
        let mut nodes: Vec<u64> =
            several.flat_map(|group| &group.nodes).copied().filter(|&node| node < texels).collect();
        nodes.sort_unstable();
        let alone = nodes.len();
        nodes.extend((texels..).take(self.nodes.welds.welds.len()));

        let mut joined = Welds::default();
        let mut weld_of: HashMap<u64, u64> = HashMap::new();
        for &node in &nodes {
            let root = self.root(node);
            let weld = *weld_of.entry(root).or_insert_with(|| {
                let owner = root.checked_sub(texels).map_or(root, |weld| self.nodes.welds.welds[weld as usize].owner);
                joined.welds.push(Weld { owner, sources: Vec::new(), area: 0.0 });
                joined.welds.len() as u64 - 1
            });
            for part in self.nodes.sources(node) {
                joined.welds[weld as usize].area += part.weight * self.nodes.map.surfaces[part.index as usize].area;
                add_part(&mut joined.welds[weld as usize].sources, part);
            }
        }
        let new_weld = |node: u64| weld_of[&self.root(node)];
        let of_texels =
            nodes[..alone].iter().map(|&texel| (texel, vec![WeldPart { index: new_weld(texel), weight: 1.0 }]));
        joined.linked = of_texels.collect();
        for (texel, links) in &self.nodes.welds.linked {
            let mut parts = Vec::with_capacity(links.len());
            links
                .iter()
                .for_each(|&link| add_part(&mut parts, WeldPart { index: new_weld(texels + link.index), ..link }));
            joined.linked.push((*texel, parts));
        }
        joined.linked.sort_unstable_by_key(|(texel, _)| *texel);
        joined
    }
}

/// Adds a part to those of something, of which each index has one.
fn add_part(parts: &mut Vec<WeldPart>, part: WeldPart) {
    match parts.iter_mut().find(|known| known.index == part.index) {
        Some(known) => known.weight += part.weight,
        None => parts.push(part),
    }
}
