//! The nodes of a map: what is one already, a texel without links, by its index, or a weld, whose numbers follow those of the texels.

use super::{Map, WeldPart, Welds};
use crate::{MapTile, TexelChart};

/// Share of a whole texel below which a texel at a border is a scrap. What is shown inside a chart is a mean over about four texels, for photons
/// are laid and read bilinearly; with less than this, borders are grainier.
const SCRAP: f64 = 1.1;
/// Share of what a texel can hold on its tile from which on it is whole.
const WHOLE: f64 = 0.99;
/// Texels of area that light inside a chart is a mean over.
const SMALL_CHART: f64 = 4.0;
/// Texels of a small chart at most; what is longer has parts too far from each other.
const SMALL_CHART_TEXELS: usize = 16;
/// How much more surface texels of a map may have, on average, than those around a scrap, for that to be asked for.
const MOST_DENSE: f64 = 4.0;

/// A map's nodes.
pub(super) struct Nodes<'t> {
    pub map: &'t Map<'t>,
    pub welds: &'t Welds,
    /// The charts of each layer.
    charts: Vec<ChartMeasure>,
    /// Surface for each unit of the plane that charts cover but cells, on average over the map; in units of the plane.
    density: f64,
}

/// What a chart's texels hold.
#[derive(Clone, Copy, Default)]
struct ChartMeasure {
    /// Their area, in whole texels on a chart that is neither tilted nor scaled.
    area: f64,
    texels: u32,
}

/// A node with too little surface, or several, that become one with others.
pub(super) struct Scrap {
    pub nodes: Vec<u64>,
    /// The area that what it becomes should have, m².
    pub least: f64,
}

impl<'t> Nodes<'t> {
    pub(super) fn new(map: &'t Map<'t>, welds: &'t Welds) -> Self {
        let charts = vec![ChartMeasure::default(); (map.layout.chart_count * map.layout.layers) as usize];
        let mut nodes = Self { map, welds, charts, density: 1.0 };
        let (mut area, mut covered) = (0.0, 0.0);
        for tile in &map.tiles.tiles {
            let (whole, cell) = (map.metric_area(tile), map.tiles.cell_size(tile).element_product());
            for texel in tile.first_texel..tile.first_texel + tile.texel_count() {
                let surface = &map.surfaces[texel as usize];
                if let Some(chart) = nodes.chart(tile, texel) {
                    nodes.charts[chart].area += surface.area / whole;
                    nodes.charts[chart].texels += 1;
                }
                if let TexelChart::One(_) = surface.chart {
                    area += cell * surface.area / whole;
                    covered += cell * f64::from(surface.covered).min(most_covered(tile, place(tile, texel)));
                }
            }
        }
        nodes.density = if covered > 0.0 { (area / covered).max(1.0) } else { 1.0 };
        nodes
    }

    /// The number of a texel's chart among those of all layers.
    fn chart(&self, tile: &MapTile, texel: u64) -> Option<usize> {
        match self.map.surfaces[texel as usize].chart {
            TexelChart::One(chart) | TexelChart::Cell(chart) => {
                let number = (tile.square.layer * self.map.layout.chart_count + chart) as usize;
                (number < self.charts.len()).then_some(number)
            }
            TexelChart::None | TexelChart::Several => None,
        }
    }

    /// The texels of the map, after whose numbers those of welds follow.
    pub(super) fn texels(&self) -> u64 {
        self.map.surfaces.len() as u64
    }

    /// The area of a texel's chart, in whole texels, and its number, if it is neither small nor a cell.
    pub(super) fn large_chart(&self, tile: &MapTile, texel: u64) -> Option<(f64, usize)> {
        let TexelChart::One(_) = self.map.surfaces[texel as usize].chart else { return None };
        let chart = self.chart(tile, texel)?;
        let area = self.charts[chart].area;
        (area >= SMALL_CHART * self.density).then_some((area, chart))
    }

    /// The nodes that a texel takes its irradiance from: itself, or welds.
    pub(super) fn of_texel(&self, texel: u64) -> Vec<u64> {
        match self.welds.linked.binary_search_by_key(&texel, |(texel, _)| *texel) {
            Err(_) => vec![texel],
            Ok(link) => self.welds.linked[link].1.iter().map(|weld| self.texels() + weld.index).collect(),
        }
    }

    /// The texels that a node takes flux and area from.
    pub(super) fn sources(&self, node: u64) -> Vec<WeldPart> {
        match node.checked_sub(self.texels()) {
            Some(weld) => self.welds.welds[weld as usize].sources.clone(),
            None => vec![WeldPart { index: node, weight: 1.0 }],
        }
    }

    /// The surface behind a node, m².
    pub(super) fn area(&self, node: u64) -> f64 {
        match node.checked_sub(self.texels()) {
            Some(weld) => self.welds.welds[weld as usize].area,
            None => self.map.surfaces[node as usize].area,
        }
    }

    /// The nodes of the same chart that stand around a node on the tiles that it is on, in any order, and itself.
    pub(super) fn beside(&self, node: u64) -> Vec<u64> {
        let mut beside = Vec::with_capacity(9);
        for part in self.sources(node) {
            for texel in self.around(self.map.tile(part.index), part.index) {
                if self.welds.linked.is_empty() { beside.push(texel) } else { beside.extend(self.of_texel(texel)) }
            }
        }
        beside
    }

    /// The texels of the same chart around a texel on its tile, and itself.
    fn around<'a>(&'a self, tile: &'a MapTile, texel: u64) -> impl Iterator<Item = u64> + 'a {
        let [x, y] = place(tile, texel);
        let near = |at: u64, axis: usize| at.saturating_sub(1)..=(at + 1).min(tile.cells[axis].into());
        let columns = near(x, 0);
        let all = near(y, 1).flat_map(move |y| columns.clone().map(move |x| (y, x)));
        let all = all.map(|(y, x)| tile.first_texel + y * (u64::from(tile.cells[0]) + 1) + x);
        let chart = self.map.surfaces[texel as usize].chart;
        all.filter(move |&other| self.map.surfaces[other as usize].chart == chart)
    }

    /// The surface that a whole texel of a tile has around a texel, m²: as much as those beside it have, or the map has on average.
    fn whole(&self, tile: &MapTile, texel: u64) -> f64 {
        let metric = self.map.metric_area(tile);
        if let TexelChart::Cell(_) = self.map.surfaces[texel as usize].chart {
            return metric;
        }
        let (mut area, mut covered) = (0.0, 0.0);
        for other in self.around(tile, texel) {
            let surface = &self.map.surfaces[other as usize];
            area += surface.area;
            covered += f64::from(surface.covered).min(most_covered(tile, place(tile, other)));
        }
        let around = area / covered;
        (self.density * metric).clamp(around, MOST_DENSE * around)
    }

    /// The scraps, from the smallest share of a texel on.
    pub(super) fn scraps(&self) -> Vec<Scrap> {
        let mut found: Vec<(f64, u64, f64)> = Vec::new();
        for tile in &self.map.tiles.tiles {
            for texel in tile.first_texel..tile.first_texel + tile.texel_count() {
                let surface = &self.map.surfaces[texel as usize];
                let may_be = match surface.chart {
                    TexelChart::One(_) => f64::from(surface.covered) < WHOLE * most_covered(tile, place(tile, texel)),
                    TexelChart::Cell(_) => true,
                    TexelChart::None | TexelChart::Several => false,
                };
                if may_be && self.of_texel(texel) == [texel] {
                    let whole = self.whole(tile, texel);
                    found.extend((surface.area < SCRAP * whole).then_some((
                        surface.area / whole,
                        texel,
                        SCRAP * whole,
                    )));
                }
            }
        }
        found.extend((self.texels()..).take(self.welds.welds.len()).filter_map(|node| self.scrap_of_weld(node)));
        found.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        found.into_iter().map(|(_, node, least)| Scrap { nodes: vec![node], least }).collect()
    }

    /// The share of a whole texel that a weld has, if that is too little, the node, and the area that it should have.
    fn scrap_of_weld(&self, node: u64) -> Option<(f64, u64, f64)> {
        let (mut most, mut covered, mut whole): (f64, f64, f64) = (0.0, 0.0, 0.0);
        for part in self.sources(node) {
            let tile = self.map.tile(part.index);
            let cell = part.weight * self.map.tiles.cell_size(tile).element_product();
            most += cell * most_covered(tile, place(tile, part.index));
            covered += cell * f64::from(self.map.surfaces[part.index as usize].covered);
            whole = whole.max(self.whole(tile, part.index));
        }
        let area = self.area(node);
        (covered < WHOLE * most && area < SCRAP * whole).then_some((area / whole, node, SCRAP * whole))
    }

    /// Charts that have less surface than light inside a chart is a mean over, from the smallest on, each as one.
    pub(super) fn small_charts(&self) -> Vec<Scrap> {
        let mut members: Vec<(usize, u64, f64)> = Vec::new();
        let is_small = |chart: &ChartMeasure| {
            chart.area < SMALL_CHART * self.density && chart.texels as usize <= SMALL_CHART_TEXELS
        };
        for tile in self.map.tiles.tiles.iter().filter(|_| self.charts.iter().any(is_small)) {
            let whole = self.map.metric_area(tile);
            for texel in tile.first_texel..tile.first_texel + tile.texel_count() {
                let chart = self.chart(tile, texel).filter(|chart| is_small(&self.charts[*chart]));
                members.extend(chart.map(|chart| (chart, texel, whole)));
            }
        }
        members.sort_unstable_by_key(|&(chart, texel, _)| (chart, texel));
        let mut scraps: Vec<(f64, Scrap)> = Vec::new();
        for chart in members.chunk_by(|a, b| a.0 == b.0) {
            let mut nodes: Vec<u64> = chart.iter().flat_map(|&(_, texel, _)| self.of_texel(texel)).collect();
            nodes.sort_unstable();
            nodes.dedup();
            let least = SMALL_CHART * self.density * chart.iter().map(|&(_, _, whole)| whole).fold(0.0, f64::max);
            scraps.push((self.charts[chart[0].0].area, Scrap { nodes, least }));
        }
        scraps.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.nodes.cmp(&b.1.nodes)));
        scraps.into_iter().map(|(_, scrap)| scrap).collect()
    }
}

/// Where on its tile a texel stands.
pub(super) fn place(tile: &MapTile, texel: u64) -> [u64; 2] {
    let (within, columns) = (texel - tile.first_texel, u64::from(tile.cells[0]) + 1);
    [within % columns, within / columns]
}

/// The most that a texel can cover, in cells of its tile.
fn most_covered(tile: &MapTile, at: [u64; 2]) -> f64 {
    let along = |axis: usize| if at[axis] == 0 || at[axis] == u64::from(tile.cells[axis]) { 0.5 } else { 1.0 };
    along(0) * along(1)
}

/// Whether a texel of a chart covers less than it can.
pub(super) fn is_at_border(map: &Map<'_>, tile: &MapTile, texel: u64) -> bool {
    f64::from(map.surfaces[texel as usize].covered) < WHOLE * most_covered(tile, place(tile, texel))
}
