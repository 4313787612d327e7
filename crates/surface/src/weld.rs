//! How the tiles of a map join: texels of several tiles that stand at one place are one, and texels on the border of a coarser tile lie
//! between its texels, so that irradiance has no jumps; charts are stitched where the surface goes on smoothly; and scraps at charts' borders are
//! one with what is beside them.

mod near;
mod nodes;
mod scraps;
mod seams;
mod stitches;

use std::collections::HashMap;

use crate::{MapLayout, MapTile, MapTiles, TexelChart, TexelSurface, WorldTriangle, tile::FINEST_LEVEL};

/// Steps along a square of the finest level: the most cells of a tile that is joined to others, as a power of two.
const STEP_BITS: u32 = 8;

/// How the tiles of a map join.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Welds {
    /// Places at which texels of several tiles or charts meet, and scraps with what they are one with.
    pub welds: Vec<Weld>,
    /// The texels that get their irradiance from welds, in order, each with those that it lies between.
    pub linked: Vec<(u64, Vec<WeldPart>)>,
}

/// Texels that are one: they stand at one place, or some are scraps.
#[derive(Clone, Debug, PartialEq)]
pub struct Weld {
    /// The texel that stands for all: of the coarsest tile at a place.
    pub owner: u64,
    /// The texels whose flux and area it takes, with the part of each.
    pub sources: Vec<WeldPart>,
    /// The area of those parts, m².
    pub area: f64,
}

/// A part of something.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WeldPart {
    /// Its index: of a texel, or of a weld.
    pub index: u64,
    /// Its share.
    pub weight: f64,
}

/// A map whose texels are joined.
struct Map<'t> {
    layout: &'t MapLayout,
    tiles: &'t MapTiles,
    surfaces: &'t [TexelSurface],
    triangles: &'t [WorldTriangle],
}

impl Map<'_> {
    /// The tile of a texel.
    fn tile(&self, texel: u64) -> &MapTile {
        &self.tiles.tiles[self.tiles.tiles.partition_point(|tile| tile.first_texel <= texel) - 1]
    }

    /// The surface that a texel of a tile would have on a chart that is neither tilted nor scaled, m².
    fn metric_area(&self, tile: &MapTile) -> f64 {
        self.tiles.cell_size(tile).element_product() * f64::from(self.layout.metres_per_texel).powi(2)
    }
}

/// A place of a layer's plane, in steps of 2^-`STEP_BITS` of the finest squares.
type Place = [u64; 2];

impl Welds {
    /// The welds of a map's tiles, whose texels have the given surfaces. Texels are joined where they are of one chart. Tiles whose cells are
    /// no power of two along both axes, as of a map of a stated size, are alone in their layer.
    ///
    /// `triangles` are the object's, in any order; those without an area may be missing.
    pub fn new(layout: &MapLayout, tiles: &MapTiles, texels: &[TexelSurface], triangles: &[WorldTriangle]) -> Self {
        let map = Map { layout, tiles, surfaces: texels, triangles };
        scraps::join_scraps(&map, stitches::stitch(&map, Self::of_tiles(tiles, texels)))
    }

    /// Those of texels of several tiles.
    fn of_tiles(tiles: &MapTiles, texels: &[TexelSurface]) -> Self {
        let mut welds = Self::default();
        let is_joined = |[x, y]: [u32; 2]| x == y && x.is_power_of_two() && x <= 1 << STEP_BITS;
        if !tiles.tiles.iter().all(|tile| is_joined(tile.cells)) {
            return welds;
        }
        for layer in tiles.tiles.chunk_by(|a, b| a.square.layer == b.square.layer).filter(|layer| layer.len() > 1) {
            Joints::new(layer, texels).add_to(&mut welds);
        }
        welds
    }

    /// The irradiance of each texel that follows from texels' flux and areas.
    pub fn irradiance<T>(&self, flux: &[T], areas: &[f64]) -> Vec<T>
    where
        T: Copy + Default + std::ops::Add<Output = T> + std::ops::Mul<f64, Output = T>,
    {
        let over = |flux: T, area: f64| if area > 0.0 { flux * area.recip() } else { T::default() };
        let sum = |parts: &[WeldPart], of: &[T]| {
            parts.iter().fold(T::default(), |sum, part| sum + of[part.index as usize] * part.weight)
        };
        let mut irradiance: Vec<T> = flux.iter().zip(areas).map(|(&flux, &area)| over(flux, area)).collect();
        let welded: Vec<T> = self.welds.iter().map(|weld| over(sum(&weld.sources, flux), weld.area)).collect();
        for (texel, parts) in &self.linked {
            irradiance[*texel as usize] = sum(parts, &welded);
        }
        irradiance
    }
}

/// The texels on borders of a layer's tiles.
struct Joints<'t> {
    tiles: &'t [MapTile],
    surfaces: &'t [TexelSurface],
    /// Places, row by row, each with the texels that stand there: the texel, and its tile's number.
    places: Vec<(Place, Vec<(u64, usize)>)>,
    /// For each place the places that it lies between, which lie between none; itself if it is free.
    parts: Vec<Vec<(usize, f64)>>,
}

impl<'t> Joints<'t> {
    fn new(tiles: &'t [MapTile], surfaces: &'t [TexelSurface]) -> Self {
        let mut texels: Vec<_> = tiles.iter().enumerate().flat_map(|(number, tile)| border(number, tile)).collect();
        texels.sort_unstable_by_key(|&([x, y], texel, _)| (y, x, texel));
        let places: Vec<(Place, Vec<(u64, usize)>)> = texels
            .chunk_by(|a, b| a.0 == b.0)
            .map(|at_place| (at_place[0].0, at_place.iter().map(|&(_, texel, tile)| (texel, tile)).collect()))
            .collect();
        let mut joints = Self { tiles, surfaces, parts: vec![Vec::new(); places.len()], places };
        let index: HashMap<Place, usize> =
            joints.places.iter().enumerate().map(|(number, (place, _))| (*place, number)).collect();
        // Coarse tiles first: what a place lies between is on a coarser border, and known by then.
        let mut order: Vec<usize> = (0..joints.places.len()).collect();
        order.sort_by_key(|&number| std::cmp::Reverse(joints.coarsest(number).0));
        for number in order {
            joints.parts[number] = joints.parts_of(number, &index);
        }
        joints
    }

    /// The widest step of the tiles whose texels stand at a place, and the first texel of such a tile.
    fn coarsest(&self, number: usize) -> (u64, u64) {
        let steps = self.places[number].1.iter().map(|&(texel, tile)| (step(&self.tiles[tile]), texel));
        steps.max_by_key(|&(step, texel)| (step, std::cmp::Reverse(texel))).unwrap_or((0, 0))
    }

    /// What a place lies between.
    fn parts_of(&self, number: usize, index: &HashMap<Place, usize>) -> Vec<(usize, f64)> {
        let place = self.places[number].0;
        let hangs_on = |tile: &&MapTile| place.iter().zip(origin(tile)).any(|(at, low)| (at - low) % step(tile) != 0);
        let Some(tile) = self.touching(place).filter(hangs_on).max_by_key(|tile| step(tile)) else {
            return vec![(number, 1.0)];
        };
        let (low, step) = (origin(tile), step(tile));
        let below = [0, 1].map(|axis| low[axis] + (place[axis] - low[axis]) / step * step);
        let above = [0, 1].map(|axis| if below[axis] == place[axis] { below[axis] } else { below[axis] + step });
        let part = (0..2).map(|axis| (place[axis] - below[axis]) as f64 / step as f64).fold(0.0, f64::max);
        let mut parts: Vec<(usize, f64)> = Vec::new();
        for (end, weight) in [(below, 1.0 - part), (above, part)] {
            for &(free, share) in &self.parts[index[&end]] {
                match parts.iter_mut().find(|(known, _)| *known == free) {
                    Some((_, sum)) => *sum += weight * share,
                    None => parts.push((free, weight * share)),
                }
            }
        }
        parts
    }

    /// The tiles that touch a place.
    fn touching(&self, [x, y]: Place) -> impl Iterator<Item = &MapTile> {
        let around = |at: u64| [at.checked_sub(1), Some(at)].into_iter().flatten().map(|at| at >> STEP_BITS);
        let squares = around(y).flat_map(move |y| around(x).map(move |x| [x, y]));
        squares.filter_map(|square| MapTile::at_finest(self.tiles, square))
    }

    /// The chart of the texels at a place, if they are of one.
    fn chart(&self, number: usize) -> Option<u32> {
        match self.surfaces[self.coarsest(number).1 as usize].chart {
            TexelChart::One(chart) => Some(chart),
            _ => None,
        }
    }

    /// Adds what is joined.
    fn add_to(&self, welds: &mut Welds) {
        let first_weld = welds.welds.len();
        let mut weld_of: HashMap<usize, usize> = HashMap::new();
        let is_alone = |number: usize| self.places[number].1.len() == 1 && self.parts[number].len() == 1;
        let hung_on: Vec<bool> = {
            let mut hung_on = vec![false; self.places.len()];
            let hanging = self.parts.iter().enumerate().filter(|(number, parts)| parts[0].0 != *number);
            hanging.flat_map(|(_, parts)| parts).for_each(|&(free, _)| hung_on[free] = true);
            hung_on
        };
        for (number, (_, texels)) in self.places.iter().enumerate() {
            let parts = &self.parts[number];
            let Some(chart) = self.chart(parts[0].0) else { continue };
            if is_alone(number) && !hung_on[number] || parts.iter().any(|&(free, _)| self.chart(free) != Some(chart)) {
                continue;
            }
            let joined =
                texels.iter().filter(|(texel, _)| self.surfaces[*texel as usize].chart == TexelChart::One(chart));
            for &(texel, _) in joined {
                let mut links = Vec::with_capacity(parts.len());
                for &(free, weight) in parts {
                    let weld = *weld_of.entry(free).or_insert_with(|| {
                        welds.welds.push(Weld { owner: self.coarsest(free).1, sources: Vec::new(), area: 0.0 });
                        welds.welds.len() - 1
                    });
                    welds.welds[weld].sources.push(WeldPart { index: texel, weight });
                    welds.welds[weld].area += weight * self.surfaces[texel as usize].area;
                    links.push(WeldPart { index: weld as u64, weight });
                }
                welds.linked.push((texel, links));
            }
        }
        debug_assert!(welds.welds[first_weld..].iter().all(|weld| !weld.sources.is_empty()));
        welds.linked.sort_unstable_by_key(|(texel, _)| *texel);
    }
}

/// Steps along a cell of a tile.
fn step(tile: &MapTile) -> u64 {
    1 << (FINEST_LEVEL - tile.square.level + STEP_BITS - tile.cells[0].trailing_zeros())
}

/// The lower corner of a tile.
fn origin(tile: &MapTile) -> Place {
    [tile.square.x, tile.square.y].map(|at| u64::from(at) << (FINEST_LEVEL - tile.square.level + STEP_BITS))
}

/// The texels on the border of a tile, with their places and the tile's number.
fn border(number: usize, tile: &MapTile) -> impl Iterator<Item = (Place, u64, usize)> {
    let ([columns, rows], [x, y], step) = (tile.cells.map(u64::from), origin(tile), step(tile));
    let first = tile.first_texel;
    let along = (0..=rows).flat_map(move |j| (0..=columns).map(move |i| (i, j)));
    let on_border = along.filter(move |&(i, j)| i == 0 || i == columns || j == 0 || j == rows);
    on_border.map(move |(i, j)| ([x + i * step, y + j * step], first + j * (columns + 1) + i, number))
}

#[cfg(test)]
mod tests {
    use glam::{DVec2, Vec2};
    use proptest::prelude::*;

    use super::*;
    use crate::{MapLayout, MapSquare, WorldTriangle, texel_surfaces};

    const LAYOUT: MapLayout = MapLayout {
        width: 33,
        height: 17,
        layers: 1,
        corners: Vec::new(),
        charts: Vec::new(),
        chart_count: 1,
        cell_count: 0,
        metres_per_texel: 1.0,
    };

    /// Tiles of a quadtree over two squares, whose leaves follow `splits`, and have up to 8 cells along a side.
    fn tree(splits: &[bool]) -> MapTiles {
        let mut open: Vec<_> = (0..2).map(|x| MapSquare { layer: 0, level: 0, x, y: 0 }).collect();
        let (mut leaves, mut splits) = (Vec::new(), splits.iter());
        while let Some(square) = open.pop() {
            if square.level < 4 && splits.next() == Some(&true) {
                open.extend(square.children());
            } else {
                leaves.push((square, [1 << ((square.x + 3 * square.y) % 4); 2]));
            }
        }
        MapTiles::new(&LAYOUT, [2, 1], leaves.into_iter())
    }

    /// Texels of a plane that is all of one chart.
    fn flat(tiles: &MapTiles, chart: impl Fn(DVec2) -> u32) -> Vec<TexelSurface> {
        let mut texels = Vec::new();
        for tile in &tiles.tiles {
            let cell = tiles.cell_size(tile);
            for (j, i) in (0..=tile.cells[1]).flat_map(|j| (0..=tile.cells[0]).map(move |i| (j, i))) {
                let half = |at: u32, last: u32| if at == 0 || at == last { 0.5 } else { 1.0 };
                let area = cell.element_product() * half(i, tile.cells[0]) * half(j, tile.cells[1]);
                let place = tiles.origin(tile) + cell * DVec2::new(i.into(), j.into());
                let covered = (half(i, tile.cells[0]) * half(j, tile.cells[1])) as f32;
                texels.push(TexelSurface { area, covered, chart: TexelChart::One(chart(place)) });
            }
        }
        texels
    }

    /// What a tile shows at a place on it.
    fn shown(tiles: &MapTiles, tile: &MapTile, irradiance: &[f64], place: DVec2) -> f64 {
        let last = DVec2::new(tile.cells[0].into(), tile.cells[1].into()) - 1.0;
        let at = (place - tiles.origin(tile)) / tiles.cell_size(tile);
        let cell = at.floor().clamp(DVec2::ZERO, last);
        let f = at - cell;
        let columns = tile.cells[0] as usize + 1;
        let first = tile.first_texel as usize + cell.y as usize * columns + cell.x as usize;
        let row = |first: usize| irradiance[first] * (1.0 - f.x) + irradiance[first + 1] * f.x;
        row(first) * (1.0 - f.y) + row(first + columns) * f.y
    }

    proptest! {
        /// Whatever flux lies on texels: it is kept, even light stays even, and where two tiles meet both show the same.
        #[test]
        fn tiles_of_any_size_join(splits in prop::collection::vec(prop::bool::ANY, 60), seed in 1u64..1_000_000) {
            let tiles = tree(&splits);
            let texels = flat(&tiles, |_| 0);
            let areas: Vec<f64> = texels.iter().map(|texel| texel.area).collect();
            let welds = Welds::new(&LAYOUT, &tiles, &texels, &[]);
            let even = welds.irradiance(&areas.iter().map(|area| 3.0 * area).collect::<Vec<f64>>(), &areas);
            prop_assert!(even.iter().all(|value| (value - 3.0).abs() < 1e-12));

            let mut state = seed;
            let mut random = || {
                state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
                (state >> 40) as f64 / f64::from(1u32 << 24)
            };
            let flux: Vec<f64> = areas.iter().map(|area| area * random()).collect();
            let irradiance = welds.irradiance(&flux, &areas);
            let kept: f64 = irradiance.iter().zip(&areas).map(|(value, area)| value * area).sum();
            let total: f64 = flux.iter().sum();
            prop_assert!((kept / total - 1.0).abs() < 1e-12, "{kept} of {total}");
            let ends = |tile: &MapTile| (tiles.origin(tile), tiles.origin(tile) + tiles.square_size(tile.square.level));
            for (one, other) in tiles.tiles.iter().flat_map(|a| tiles.tiles.iter().map(move |b| (a, b))) {
                let ((low, high), (other_low, other_high)) = (ends(one), ends(other));
                let (low, high) = (low.max(other_low), high.min(other_high));
                if one.square == other.square || low.cmpgt(high).any() {
                    continue;
                }
                for part in [0.0, 0.13, 0.5, 0.77, 1.0] {
                    let place = low.lerp(high, part);
                    let sides = [one, other].map(|tile| shown(&tiles, tile, &irradiance, place));
                    prop_assert!((sides[0] - sides[1]).abs() < 1e-9, "{place}: {sides:?}");
                }
            }
        }

        /// Texels of several charts keep what is theirs.
        #[test]
        fn charts_are_not_joined(splits in prop::collection::vec(prop::bool::ANY, 60), border in 1.0..31.0) {
            let tiles = tree(&splits);
            let texels = flat(&tiles, |place| u32::from(place.x > border));
            let areas: Vec<f64> = texels.iter().map(|texel| texel.area).collect();
            let flux = texels.iter().map(|texel| if texel.chart == TexelChart::One(0) { texel.area } else { 0.0 });
            let irradiance = Welds::new(&LAYOUT, &tiles, &texels, &[]).irradiance(&flux.collect::<Vec<f64>>(), &areas);
            for (texel, value) in texels.iter().zip(irradiance) {
                let own = if texel.chart == TexelChart::One(0) { 1.0 } else { 0.0 };
                prop_assert!((value - own).abs() < 1e-12, "{texel:?}: {value}");
            }
        }
    }

    #[test]
    fn a_map_of_one_tile_has_nothing_to_join() {
        let tiles = MapTiles::dense(&LAYOUT);
        assert_eq!(Welds::new(&LAYOUT, &tiles, &flat(&tiles, |_| 0), &[]), Welds::default());
    }

    /// Texels of a plane of which what lies below a line is one chart, with the surface behind each.
    fn below_a_line(tiles: &MapTiles, slope: f64, height: f64) -> Vec<TexelSurface> {
        let end = |x: f32| Vec2::new(x, (slope * f64::from(x) + height) as f32);
        let corners = [[Vec2::ZERO, Vec2::new(32.0, 0.0), end(32.0)], [Vec2::ZERO, end(32.0), end(0.0)]];
        let layout = MapLayout { corners: corners.to_vec(), charts: vec![0; 2], ..LAYOUT };
        let triangle = |(triangle, places): (u32, [Vec2; 3])| WorldTriangle {
            corners: places.map(|place| place.extend(0.0)),
            normals: None,
            uvs: None,
            object: 0,
            triangle,
            material: 0,
            exchanged: false,
        };
        texel_surfaces(&layout, tiles, &(0..).zip(corners).map(triangle).collect::<Vec<_>>())
    }

    proptest! {
        /// Whatever the border of a chart cuts off: flux is kept, even light stays even, and each texel takes its irradiance from an area
        /// that is large enough.
        #[test]
        fn scraps_are_one_with_what_is_beside_them(
            splits in prop::collection::vec(prop::bool::ANY, 60), slope in -0.2f64..0.2, height in 6.5f64..9.5,
        ) {
            for tiles in [tree(&splits), MapTiles::dense(&LAYOUT)] {
                let texels = below_a_line(&tiles, slope, height);
                let areas: Vec<f64> = texels.iter().map(|texel| texel.area).collect();
                let welds = Welds::new(&LAYOUT, &tiles, &texels, &[]);
                let even = welds.irradiance(&areas.iter().map(|area| 3.0 * area).collect::<Vec<f64>>(), &areas);
                let is_even = |(value, area): (&f64, &f64)| *area == 0.0 || (value - 3.0).abs() < 1e-9;
                prop_assert!(even.iter().zip(&areas).all(is_even));
                let flux: Vec<f64> = areas.iter().enumerate().map(|(k, area)| area * (k % 7) as f64).collect();
                let irradiance = welds.irradiance(&flux, &areas);
                let kept: f64 = irradiance.iter().zip(&areas).map(|(value, area)| value * area).sum();
                prop_assert!((kept / flux.iter().sum::<f64>() - 1.0).abs() < 1e-9);

                let mut behind: Vec<f64> = areas.clone();
                for (texel, links) in &welds.linked {
                    let least = links.iter().map(|link| welds.welds[link.index as usize].area);
                    behind[*texel as usize] = least.fold(f64::INFINITY, f64::min);
                }
                for tile in &tiles.tiles {
                    let cell = tiles.cell_size(tile).element_product();
                    let own = tile.first_texel as usize..(tile.first_texel + tile.texel_count()) as usize;
                    // A corner of the plane holds a quarter, and the smallest tiles may have one texel or two of the chart.
                    let is_large = |&texel: &usize| behind[texel] == 0.0 || behind[texel] > 0.24 * cell;
                    prop_assert!(tile.cells[0] < 4 || own.into_iter().all(|texel| is_large(&texel)), "{tile:?}");
                }
            }
        }
    }
}
