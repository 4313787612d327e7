//! Which tiles a map has whose size the scene leaves open: as fine as the camera sees a place, where light falls, within a budget;
//! docs/energy-maps.md, "Tiles".

use std::{cmp::Ordering, collections::BinaryHeap, ops::Range};

use diacaustic_shaders::Sighting;
use diacaustic_surface::{FINEST_LEVEL, MapLayout, MapSquare, MapTiles};
use glam::DVec2;

use crate::map_plan::MapPlan;

/// Texels for each pixel: those of half a pixel's width.
const TEXELS_PER_PIXEL: f64 = 4.0;
/// How much coarser texels are where no photon of the pilot fell.
const UNLIT_COARSENESS: f64 = 4.0;
/// How far light makes its surroundings count as lit, in the width of the square that is looked at. What lies so near a quarter of a square
/// lies so near the square too.
const LIT_MARGIN: f64 = 0.5;
/// Photons that would be expected on a square without any, if light were even over the larger one around it, for which chance may explain that
/// there are none: it counts as lit.
const CHANCE_LANDINGS: Range<f64> = 0.25..3.0;
/// Pixels that a sighting after diffuse surfaces counts, against one that the picture shows.
const BOUNCED_PIXELS: f64 = 1.0 / 64.0;
/// Importance of what is unlit against what is lit, where not all can be had.
const UNLIT_IMPORTANCE: f64 = 1.0 / 16.0;
/// Cells along a tile that is not divided further, as a power of two; as many as that where sightings are too few to tell its parts apart.
const TILE_CELLS: u32 = 5;
const MOST_TILE_CELLS: u32 = 8;
/// Sightings that tell the parts of a square apart.
const LEAST_SIGHTINGS: usize = 8;
/// Cells along a tile that light falls on, but that the camera does not see, as a power of two.
const UNSEEN_CELLS: u32 = 2;

/// What is known of one layer of a map.
#[derive(Clone, Debug, Default)]
struct Evidence {
    /// Places that the camera sees, in squares of level 0, and the pixels that each stands for.
    seen: Vec<(DVec2, f64)>,
    /// Places where the pilot's photons fell.
    lit: Vec<DVec2>,
}

/// A square of the tree that would be had without a budget.
#[derive(Debug)]
struct Node {
    square: MapSquare,
    /// Pixels that show it.
    pixels: f64,
    /// Importance where not all can be had.
    importance: f64,
    /// Cells along the side of a leaf, as a power of two.
    wanted: u32,
    /// Its quarters; none of a leaf.
    children: Option<[usize; 4]>,
}

/// A tile of the tree so far: a node with so many cells along its side, as a power of two.
#[derive(Clone, Copy, Debug)]
struct Front {
    urgency: f64,
    node: usize,
    cells: u32,
}

/// The width of a map's texels where the camera sees it, on average over pixels; over tiles where it sees nothing. Units of the plane.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct TexelWidth {
    pub wanted: f64,
    pub given: f64,
    /// The smallest given.
    pub finest: f64,
}

/// Tiles for the maps of all objects, and the width of their texels.
#[derive(Debug, Default)]
pub(crate) struct TileChoice {
    pub tiles: Vec<Option<MapTiles>>,
    pub widths: Vec<TexelWidth>,
}

/// Chooses the tiles of all maps. Those whose size the scene leaves open have `budget` texels together, if that is enough for one cell a layer.
///
/// A sighting stands for `pixels` of the picture; `landings` are the places, with the records of their layers, where light falls.
pub(crate) fn choose_tiles(
    plans: &[Option<MapPlan>],
    sightings: &[Sighting],
    pixels: f64,
    landings: impl Iterator<Item = (u32, DVec2)>,
    budget: u64,
) -> TileChoice {
    let evidence = gather(plans, sightings, pixels, landings);
    let mut nodes = Vec::new();
    let mut fronts = Vec::new();
    let mut first_nodes = Vec::with_capacity(plans.len() + 1);
    for (map, plan) in plans.iter().enumerate() {
        first_nodes.push(nodes.len());
        let Some(plan) = plan.as_ref().filter(|plan| !plan.is_stated) else { continue };
        let [columns, rows] = MapTiles::roots(&plan.layout);
        for (layer, known) in (0..plan.layout.layers).zip(&evidence[2 * map..]) {
            for (y, x) in (0..rows).flat_map(|y| (0..columns).map(move |x| (y, x))) {
                let square = MapSquare { layer, level: 0, x, y };
                fronts.push(grow(&mut nodes, plan, square, &known.within(square, LIT_MARGIN), 0.0));
            }
        }
    }
    first_nodes.push(nodes.len());
    let leaves = refine(&nodes, &fronts, budget);
    collect(plans, &nodes, &first_nodes, &leaves)
}

/// Sorts what is known by object and layer.
fn gather(
    plans: &[Option<MapPlan>],
    sightings: &[Sighting],
    pixels: f64,
    landings: impl Iterator<Item = (u32, DVec2)>,
) -> Vec<Evidence> {
    let mut evidence = vec![Evidence::default(); 2 * plans.len()];
    // The layer's place in the list, and the place in its squares of level 0.
    let locate = |record: u32, place: DVec2| {
        let map = record as usize / 2;
        let plan = plans.get(map)?.as_ref().filter(|plan| !plan.is_stated)?;
        let [columns, rows] = MapTiles::roots(&plan.layout).map(f64::from);
        let extent = DVec2::new(f64::from(plan.layout.width - 1), f64::from(plan.layout.height - 1));
        Some((2 * map + plan.layer(record) as usize, place * DVec2::new(columns, rows) / extent))
    };
    for seen in sightings {
        let first = (seen.layer, [seen.x, seen.y], pixels);
        let bounced = (seen.bounced_layer, [seen.bounced_x, seen.bounced_y], pixels * BOUNCED_PIXELS);
        for (record, place, pixels) in [first, bounced] {
            if let Some((layer, place)) = locate(record, DVec2::from(place.map(f64::from))) {
                evidence[layer].seen.push((place, pixels));
            }
        }
    }
    for (layer, place) in landings.filter_map(|(record, place)| locate(record, place)) {
        evidence[layer].lit.push(place);
    }
    evidence
}

impl Evidence {
    /// What lies on a square; of light also what lies beside it, as far as `margin` of its width.
    fn within(&self, square: MapSquare, margin: f64) -> Self {
        let width = 1.0 / f64::from(1u32 << square.level);
        let low = DVec2::new(square.x.into(), square.y.into()) * width;
        let holds = |place: DVec2, margin: f64| {
            place.cmpge(low - margin * width).all() && place.cmplt(low + (1.0 + margin) * width).all()
        };
        Self {
            seen: self.seen.iter().filter(|(place, _)| holds(*place, 0.0)).copied().collect(),
            lit: self.lit.iter().filter(|place| holds(**place, margin)).copied().collect(),
        }
    }

    fn pixels(&self) -> f64 {
        self.seen.iter().map(|(_, pixels)| pixels).sum()
    }
}

/// Adds a square and those in it; returns its index. As many photons as `expected` would have landed here if light were even over the square
/// around it.
fn grow(nodes: &mut Vec<Node>, plan: &MapPlan, square: MapSquare, known: &Evidence, expected: f64) -> usize {
    let quarters = square.children().map(|child| known.within(child, LIT_MARGIN));
    let pixels = known.pixels();
    let landings = if known.lit.is_empty() { expected } else { known.lit.len() as f64 };
    let is_lit = !known.lit.is_empty() || CHANCE_LANDINGS.contains(&expected);
    // A square may be seen in part, so its finest quarter decides.
    let densest = 4.0 * quarters.iter().map(Evidence::pixels).fold(0.0, f64::max);
    let coarseness = if is_lit { 1.0 } else { UNLIT_COARSENESS };
    // Charts are apart by more than a unit, so that light does not leak from one to another through cells of a unit.
    let keeps_apart = is_lit && plan.layout.chart_count > 1;
    let units = if keeps_apart { width_in_units(&plan.layout, square.level) } else { 0.0 };
    let seen_cells = (TEXELS_PER_PIXEL * densest).sqrt() / coarseness;
    let node = nodes.len();
    let importance = if is_lit { pixels } else { UNLIT_IMPORTANCE * pixels };
    // The power of two that is nearest in ratio.
    let cells = (seen_cells.max(1.0).log2().round() as u32).max(units.max(1.0).log2().ceil() as u32);
    let wanted = cells.clamp(if is_lit { UNSEEN_CELLS } else { 0 }, MOST_TILE_CELLS);
    nodes.push(Node { square, pixels, importance, wanted, children: None });
    let can_tell_parts = known.seen.len() >= LEAST_SIGHTINGS || units > f64::from(1 << TILE_CELLS);
    if cells > TILE_CELLS && can_tell_parts && square.level < FINEST_LEVEL {
        let pairs: [_; 4] = std::array::from_fn(|quarter| (square.children()[quarter], &quarters[quarter]));
        nodes[node].children = Some(pairs.map(|(child, quarter)| grow(nodes, plan, child, quarter, 0.25 * landings)));
    }
    node
}

/// The width of a square of a level, in units of the plane.
fn width_in_units(layout: &MapLayout, level: u32) -> f64 {
    let [columns, rows] = MapTiles::roots(layout).map(f64::from);
    let (width, height) = (f64::from(layout.width - 1) / columns, f64::from(layout.height - 1) / rows);
    width.max(height) / f64::from(1u32 << level)
}

impl Node {
    /// Cells along its side up to which it is one tile, as a power of two.
    fn most_cells(&self) -> u32 {
        if self.children.is_some() { TILE_CELLS } else { self.wanted }
    }

    /// It as one tile.
    fn front(&self, node: usize, cells: u32) -> Front {
        Front { urgency: self.importance / texels(cells) as f64, node, cells }
    }
}

/// Texels of a tile with 2^`cells` cells along its side.
fn texels(cells: u32) -> i64 {
    ((1 << cells) + 1i64).pow(2)
}

impl PartialEq for Front {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Front {}

impl PartialOrd for Front {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Front {
    /// First what has the most pixels that matter for each texel, among equals the first node.
    fn cmp(&self, other: &Self) -> Ordering {
        self.urgency.total_cmp(&other.urgency).then(other.node.cmp(&self.node)).then(other.cells.cmp(&self.cells))
    }
}

/// Makes the tree finer from its roots on, where most pixels share a texel first, as long as `budget` texels suffice; returns its leaves.
fn refine(nodes: &[Node], roots: &[usize], budget: u64) -> Vec<Front> {
    let budget = i64::try_from(budget).unwrap_or(i64::MAX);
    let mut open: BinaryHeap<Front> = roots.iter().map(|&root| nodes[root].front(root, 0)).collect();
    let mut total = open.len() as i64 * texels(0);
    let mut leaves = Vec::new();
    while let Some(front) = open.pop() {
        let node = &nodes[front.node];
        let finer: Vec<Front> = if front.cells < node.most_cells() {
            vec![node.front(front.node, front.cells + 1)]
        } else if let Some(children) = node.children {
            let cells = |child: usize| nodes[child].most_cells().min(front.cells.saturating_sub(1));
            children.map(|child| nodes[child].front(child, cells(child))).into()
        } else {
            Vec::new()
        };
        let cost = finer.iter().map(|front| texels(front.cells)).sum::<i64>() - texels(front.cells);
        if finer.is_empty() || total + cost > budget {
            leaves.push(front);
        } else {
            total += cost;
            open.extend(finer);
        }
    }
    leaves
}

/// The tiles of the chosen leaves, map by map in the order of the tree, and those of maps with a stated size. The nodes of a map stand from
/// its first node on to that of the next.
fn collect(plans: &[Option<MapPlan>], nodes: &[Node], first_nodes: &[usize], leaves: &[Front]) -> TileChoice {
    let mut chosen = vec![None; nodes.len()];
    for leaf in leaves {
        chosen[leaf.node] = Some(leaf.cells);
    }
    let mut choice = TileChoice::default();
    for (map, plan) in plans.iter().enumerate() {
        let own = first_nodes[map]..first_nodes[map + 1];
        let squares = nodes[own.clone()].iter().zip(&chosen[own.clone()]);
        let squares = squares.filter_map(|(node, cells)| Some((node.square, [1 << (*cells)?; 2])));
        choice.tiles.push(plan.as_ref().map(|plan| match plan.is_stated {
            true => MapTiles::dense(&plan.layout),
            false => MapTiles::new(&plan.layout, MapTiles::roots(&plan.layout), squares),
        }));
        let width = |tiles: &MapTiles| texel_width(tiles, nodes, own, &chosen);
        choice.widths.push(choice.tiles[map].as_ref().map_or_else(TexelWidth::default, width));
    }
    choice
}

/// Pixels that a tile which nobody sees counts when widths are averaged.
const UNSEEN_PIXELS: f64 = 1e-6;

/// The mean width of the texels of a map with its own nodes: of those that were wanted, and of those that there are.
fn texel_width(tiles: &MapTiles, nodes: &[Node], own: Range<usize>, chosen: &[Option<u32>]) -> TexelWidth {
    let finest = tiles.tiles.iter().map(|tile| tiles.cell_size(tile).max_element()).fold(f64::INFINITY, f64::min);
    let mut sums = [0.0; 3];
    let roots = own.filter(|&node| nodes[node].square.level == 0);
    let mut stack: Vec<(usize, Option<f64>)> = roots.map(|root| (root, None)).collect();
    while let Some((index, given)) = stack.pop() {
        let node = &nodes[index];
        let width = |cells: u32| tiles.square_size(node.square.level).max_element() / f64::from(1u32 << cells);
        let given = given.or(chosen[index].map(width));
        match (node.children, given) {
            (Some(children), _) => stack.extend(children.map(|child| (child, given))),
            (None, Some(given)) => {
                let pixels = node.pixels.max(UNSEEN_PIXELS);
                sums = [sums[0] + pixels, sums[1] + pixels * width(node.wanted), sums[2] + pixels * given];
            }
            (None, None) => {}
        }
    }
    match sums[0] > 0.0 {
        true => TexelWidth { wanted: sums[1] / sums[0], given: sums[2] / sums[0], finest },
        // A stated size is what it is.
        false => TexelWidth { wanted: finest, given: finest, finest },
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use diacaustic_shaders::NONE;

    const SIDE: u32 = 128;

    /// A floor of 1000 units, of which the camera sees a corner 10 wide, with 4 pixels a sighting, and light falls on half of that.
    fn choice(budget: u64) -> TileChoice {
        choice_of(1, budget)
    }

    /// The same of a surface of several charts.
    fn choice_of(chart_count: u32, budget: u64) -> TileChoice {
        let layout = MapLayout { width: 1001, height: 1001, layers: 2, chart_count, ..Default::default() };
        let plan = MapPlan { layout, is_stated: false, receivers: Vec::new(), paper_size: None };
        let at = |k: u32| (f64::from(k) + 0.5) * 10.0 / f64::from(SIDE);
        let places = || (0..SIDE).flat_map(|y| (0..SIDE).map(move |x| DVec2::new(at(x), at(y))));
        let seen = |place: DVec2| Sighting {
            layer: 2,
            x: place.x as f32,
            y: place.y as f32,
            bounced_layer: NONE,
            ..Sighting::default()
        };
        let sightings: Vec<_> = places().map(seen).collect();
        let landings = places().filter(|place| place.x < 5.0).map(|place| (2, place));
        choose_tiles(&[None, Some(plan)], &sightings, 4.0, landings, budget)
    }

    #[test]
    fn texels_are_fine_where_the_camera_sees_light() {
        let choice = choice(u64::MAX);
        let tiles = choice.tiles[1].as_ref().unwrap();
        let width_at = |x: f64, y: f64, layer| {
            let holds = |tile: &&diacaustic_surface::MapTile| {
                let inside = DVec2::new(x, y) - tiles.origin(tile);
                tile.square.layer == layer
                    && inside.cmpge(DVec2::ZERO).all()
                    && inside.cmplt(tiles.square_size(tile.square.level)).all()
            };
            let found: Vec<_> = tiles.tiles.iter().filter(holds).collect();
            assert_eq!(found.len(), 1, "({x}, {y}) is covered {} times", found.len());
            tiles.cell_size(found[0]).x
        };
        // 256 pixels over 10 units: half a pixel is 0.0195 units.
        let ratio = |width: f64, wanted: f64| (width / wanted).log2().abs();
        assert!(ratio(width_at(2.0, 5.0, 0), 0.0195) <= 0.6, "lit: {}", width_at(2.0, 5.0, 0));
        assert!(ratio(width_at(8.5, 5.0, 0), 0.078) <= 0.6, "seen in the dark: {}", width_at(8.5, 5.0, 0));
        assert!(width_at(500.0, 500.0, 0) > 50.0, "unseen");
        assert!(width_at(2.0, 5.0, 1) > 500.0, "the back");
        assert!(tiles.texel_count() < 400_000, "{} texels", tiles.texel_count());
        let widths = choice.widths[1];
        assert_eq!(widths.wanted, widths.given);
        assert!(ratio(widths.finest, 0.0195) <= 0.6, "{widths:?}");
    }

    #[test]
    fn charts_are_kept_apart_where_light_falls() {
        let choice = choice_of(7, u64::MAX);
        let tiles = choice.tiles[1].as_ref().unwrap();
        let lit = tiles
            .tiles
            .iter()
            .filter(|tile| tile.square.layer == 0 && tiles.origin(tile).cmplt(DVec2::new(5.0, 10.0)).all());
        for tile in lit {
            assert!(tiles.cell_size(tile).max_element() <= 1.0, "{tile:?}");
        }
        assert!(
            tiles.tiles.iter().any(|tile| tiles.cell_size(tile).max_element() > 50.0),
            "nothing is coarse in the dark"
        );
    }

    #[test]
    fn a_budget_is_kept_and_what_it_takes_is_told() {
        let full = choice(u64::MAX);
        let wanted = full.tiles[1].as_ref().unwrap().texel_count();
        let mut before = full.widths[1].given;
        for budget in [wanted / 2, wanted / 8, wanted / 64, 100] {
            let choice = choice(budget);
            let (tiles, widths) = (choice.tiles[1].as_ref().unwrap(), choice.widths[1]);
            assert!(tiles.texel_count() <= budget, "{} of {budget} texels", tiles.texel_count());
            assert!(tiles.texel_count() > budget / 5, "{} of {budget} texels", tiles.texel_count());
            assert_eq!(widths.wanted, full.widths[1].wanted);
            assert!(widths.given > before, "budget {budget}: {widths:?}");
            before = widths.given;
        }
        let least = choice(0);
        assert_eq!(least.tiles[1].as_ref().unwrap().texel_count(), 8, "a cell for each layer");
    }
}
