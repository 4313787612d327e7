//! Texels that hold but a scrap of their chart, at its border: a photon there would make a speck. They become one with texels beside them.

use std::collections::{BTreeMap, HashMap};

use super::{Weld, WeldPart, Welds};
use crate::{MapTile, MapTiles, TexelChart, TexelSurface};

/// Share of a whole texel below which a texel is a scrap. What is shown inside a chart is a mean over about four texels, for photons are laid
/// and read bilinearly; with less than this, borders are grainier.
const SCRAP: f64 = 0.85;
/// Share of what a texel can hold on its tile from which on it is whole.
const WHOLE: f64 = 0.99;

/// Nodes of a group that is given up if it does not cover enough by then: where a chart is thinner than texels for long, there is nothing to join.
const MOST_NODES: usize = 64;

/// Joins scraps to what is beside them in the same chart, the smallest first, until together they are large enough.
pub(super) fn join_scraps(tiles: &MapTiles, surfaces: &[TexelSurface], welds: Welds) -> Welds {
    let mut scraps = Scraps { tiles, surfaces, welds, parents: BTreeMap::new(), groups: HashMap::new() };
    for (node, least) in scraps.find() {
        scraps.grow(node, least);
    }
    if scraps.parents.is_empty() { scraps.welds } else { scraps.joined() }
}

/// A map's nodes, and which of them become one. A node is what is one already: a texel without links, by its index, or a weld, whose numbers
/// follow those of the texels.
struct Scraps<'t> {
    tiles: &'t MapTiles,
    surfaces: &'t [TexelSurface],
    welds: Welds,
    /// The next node towards the root of a node's group, where that is another one.
    parents: BTreeMap<u64, u64>,
    /// Groups of several nodes, by their roots.
    groups: HashMap<u64, Group>,
}

/// Nodes that become one.
struct Group {
    /// The plane that they cover, in the layout's texels squared.
    covered: f64,
    nodes: Vec<u64>,
}

impl Scraps<'_> {
    /// The scraps, from the smallest share of a texel on, each with the plane that its group should cover.
    fn find(&self) -> Vec<(u64, f64)> {
        let mut found: Vec<(f64, u64, f64)> = Vec::new();
        for tile in &self.tiles.tiles {
            let cell = self.tiles.cell_size(tile).element_product();
            for texel in tile.first_texel..tile.first_texel + tile.texel_count() {
                let TexelSurface { covered, chart, .. } = self.surfaces[texel as usize];
                let share = f64::from(covered);
                let is_scrap = share < SCRAP && share < WHOLE * most_covered(tile, place(tile, texel));
                if is_scrap && matches!(chart, TexelChart::One(_)) && self.nodes(texel) == [texel] {
                    found.push((share, texel, SCRAP * cell));
                }
            }
        }
        for (node, weld) in (self.surfaces.len() as u64..).zip(&self.welds.welds) {
            let (mut most, mut cell) = (0.0, 0.0);
            for part in &weld.sources {
                let tile = self.tile(part.index);
                let own = self.tiles.cell_size(tile).element_product();
                most += part.weight * most_covered(tile, place(tile, part.index)) * own;
                cell = own.max(cell);
            }
            let covered = self.node_covers(node);
            if covered < SCRAP * cell && covered < WHOLE * most {
                found.push((covered / cell, node, SCRAP * cell));
            }
        }
        found.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        found.into_iter().map(|(_, node, least)| (node, least)).collect()
    }

    /// Joins the group of a scrap to the largest beside it, until it covers enough or nothing else is there.
    fn grow(&mut self, scrap: u64, least: f64) {
        loop {
            let root = self.root(scrap);
            if self.covered(root) >= least {
                return;
            }
            let own = self.take_group(root);
            if own.nodes.len() >= MOST_NODES {
                self.groups.insert(root, own);
                return;
            }
            let mut beside: Vec<u64> =
                own.nodes.iter().flat_map(|&node| self.beside(node)).map(|node| self.root(node)).collect();
            beside.sort_unstable();
            beside.dedup();
            let others = beside.into_iter().filter(|&other| other != root).map(|other| (self.covered(other), other));
            let Some((_, other)) = others.max_by(|a, b| a.0.total_cmp(&b.0)) else {
                self.groups.insert(root, own);
                return;
            };
            let mut largest = self.take_group(other);
            largest.covered += own.covered;
            largest.nodes.extend(own.nodes);
            self.parents.insert(root, other);
            self.groups.insert(other, largest);
        }
    }

    fn root(&self, mut node: u64) -> u64 {
        while let Some(&parent) = self.parents.get(&node) {
            node = parent;
        }
        node
    }

    /// What the group of a root covers.
    fn covered(&self, root: u64) -> f64 {
        self.groups.get(&root).map_or_else(|| self.node_covers(root), |group| group.covered)
    }

    /// The group of a root, out of the list.
    fn take_group(&mut self, root: u64) -> Group {
        let known = self.groups.remove(&root);
        known.unwrap_or_else(|| Group { covered: self.node_covers(root), nodes: vec![root] })
    }

    fn node_covers(&self, node: u64) -> f64 {
        let covers = |part: &WeldPart| {
            let cell = self.tiles.cell_size(self.tile(part.index)).element_product();
            part.weight * f64::from(self.surfaces[part.index as usize].covered) * cell
        };
        self.sources(node).iter().map(covers).sum()
    }

    /// The texels that a node takes flux and area from.
    fn sources(&self, node: u64) -> Vec<WeldPart> {
        match node.checked_sub(self.surfaces.len() as u64) {
            Some(weld) => self.welds.welds[weld as usize].sources.clone(),
            None => vec![WeldPart { index: node, weight: 1.0 }],
        }
    }

    /// The tile of a texel.
    fn tile(&self, texel: u64) -> &MapTile {
        &self.tiles.tiles[self.tiles.tiles.partition_point(|tile| tile.first_texel <= texel) - 1]
    }

    /// The nodes of the same chart that stand around a node on the tiles that it is on, in any order, and itself.
    fn beside(&self, node: u64) -> Vec<u64> {
        let mut beside = Vec::new();
        for WeldPart { index: texel, .. } in self.sources(node) {
            let tile = self.tile(texel);
            let [x, y] = place(tile, texel);
            let near = |at: u64, axis: usize| at.saturating_sub(1)..=(at + 1).min(tile.cells[axis].into());
            for (y, x) in near(y, 1).flat_map(|y| near(x, 0).map(move |x| (y, x))) {
                let other = tile.first_texel + y * (u64::from(tile.cells[0]) + 1) + x;
                if self.surfaces[other as usize].chart == self.surfaces[texel as usize].chart {
                    beside.extend(self.nodes(other));
                }
            }
        }
        beside
    }

    /// The nodes that a texel takes its irradiance from: itself, or welds.
    fn nodes(&self, texel: u64) -> Vec<u64> {
        match self.welds.linked.binary_search_by_key(&texel, |(texel, _)| *texel) {
            Err(_) => vec![texel],
            Ok(link) => {
                let welds = self.welds.linked[link].1.iter();
                welds.map(|weld| self.surfaces.len() as u64 + weld.index).collect()
            }
        }
    }

    /// The map's welds, with one for each group in place of those in it.
    fn joined(&self) -> Welds {
        let texels = self.surfaces.len() as u64;
        let roots: Vec<u64> = self.parents.keys().map(|&node| self.root(node)).collect();
        let mut nodes: Vec<u64> = self.parents.keys().copied().chain(roots).filter(|&node| node < texels).collect();
        nodes.sort_unstable();
        nodes.dedup();
        let alone = nodes.len();
        nodes.extend((texels..).take(self.welds.welds.len()));

        let mut joined = Welds::default();
        let mut weld_of: BTreeMap<u64, u64> = BTreeMap::new();
        for &node in &nodes {
            let root = self.root(node);
            let weld = *weld_of.entry(root).or_insert_with(|| {
                let owner = root.checked_sub(texels).map_or(root, |weld| self.welds.welds[weld as usize].owner);
                joined.welds.push(Weld { owner, sources: Vec::new(), area: 0.0 });
                joined.welds.len() as u64 - 1
            });
            for part in self.sources(node) {
                joined.welds[weld as usize].area += part.weight * self.surfaces[part.index as usize].area;
                add_part(&mut joined.welds[weld as usize].sources, part);
            }
        }
        let new_weld = |node: u64| weld_of[&self.root(node)];
        let of_texels =
            nodes[..alone].iter().map(|&texel| (texel, vec![WeldPart { index: new_weld(texel), weight: 1.0 }]));
        joined.linked = of_texels.collect();
        for (texel, links) in &self.welds.linked {
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

/// Where on its tile a texel stands.
fn place(tile: &MapTile, texel: u64) -> [u64; 2] {
    let (within, columns) = (texel - tile.first_texel, u64::from(tile.cells[0]) + 1);
    [within % columns, within / columns]
}

/// The most that a texel can cover, in cells of its tile.
fn most_covered(tile: &MapTile, at: [u64; 2]) -> f64 {
    let along = |axis: usize| if at[axis] == 0 || at[axis] == u64::from(tile.cells[axis]) { 0.5 } else { 1.0 };
    along(0) * along(1)
}
