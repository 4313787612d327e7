//! Where the tiles of energy maps lie, as the kernels read it.

use std::collections::HashMap;

use bytemuck::{Pod, Zeroable as _};
use diacaustic_shaders as shaders;
use diacaustic_shaders::map_tile;
use diacaustic_surface::{MapTile, MapTiles};
use glam::{DVec2, UVec2};

/// A texel of the records.
type Record = [u32; 4];

/// The most squares along a side of a layer's records.
const MOST_SQUARES: u32 = 256;

/// The records of all maps, each with the index of its first texel: two layers for each object, of its front and its back, then the squares and
/// parts of all.
pub(crate) fn map_records<'m>(maps: impl ExactSizeIterator<Item = Option<(&'m MapTiles, u64)>>) -> Vec<Record> {
    let mut records = vec![Record::zeroed(); 2 * maps.len()];
    for (object, map) in maps.enumerate() {
        let Some((tiles, first_texel)) = map else { continue };
        let layers = tiles.tiles.iter().map(|tile| tile.square.layer + 1).max().unwrap_or(0);
        for layer in 0..layers {
            let own: Vec<_> = tiles.tiles.iter().filter(|tile| tile.square.layer == layer).copied().collect();
            let record = add_layer(&mut records, tiles, &own, first_texel);
            // A map of one layer takes both sides.
            let sides = if layers == 1 { 0..2 } else { layer..layer + 1 };
            sides.for_each(|side| records[2 * object + side as usize] = record);
        }
    }
    records
}

/// Appends the squares and parts of a layer's tiles, and returns the layer's record.
fn add_layer(records: &mut Vec<Record>, tiles: &MapTiles, own: &[MapTile], first_texel: u64) -> Record {
    let level = best_level(tiles, own);
    let count = UVec2::from(tiles.roots) << level;
    let depths = depths(own, level);
    let first_square = records.len();
    let mut first_part = first_square + (count.x * count.y) as usize;
    let mut squares = Vec::with_capacity((count.x * count.y) as usize);
    for (y, x) in (0..count.y).flat_map(|y| (0..count.x).map(move |x| (y, x))) {
        let side = 1 << depths.get(&UVec2::new(x, y)).copied().unwrap_or(0);
        squares.push(shaders::MapSquare { first_part: first_part as u32, side, ..Default::default() });
        first_part += (side * side) as usize;
    }
    records.extend(squares.iter().map(as_record));
    records.resize(first_part, Record::zeroed());
    for tile in own {
        let record = as_record(&tile_record(tile, level, first_texel));
        for square in squares_of(tile, level) {
            let square_record = squares[(square.y * count.x + square.x) as usize];
            for part in parts_of(tile, level, square_record.side) {
                records[square_record.first_part as usize + part] = record;
            }
        }
    }
    let scale = count.as_dvec2() / tiles.extent;
    as_record(&shaders::MapLayer {
        first_square: first_square as u32,
        squares: count.x | count.y << 16,
        scale_x: scale.x as f32,
        scale_y: scale.y as f32,
    })
}

/// The level of squares with which a layer has the fewest records.
fn best_level(tiles: &MapTiles, own: &[MapTile]) -> u32 {
    let deepest = own.iter().map(|tile| tile.square.level).max().unwrap_or(0);
    let records = |level: u32| {
        let count = UVec2::from(tiles.roots) << level;
        let deep = depths(own, level);
        let parts: u64 = deep.values().map(|&depth| 1u64 << (2 * depth)).sum();
        2 * u64::from(count.x) * u64::from(count.y) - deep.len() as u64 + parts
    };
    let fits = |level: &u32| (UVec2::from(tiles.roots) << *level).max_element() <= MOST_SQUARES;
    (0..=deepest).filter(fits).min_by_key(|&level| records(level)).unwrap_or(0)
}

/// How many levels below those of the given level the tiles of a square reach, where they do.
fn depths(own: &[MapTile], level: u32) -> HashMap<UVec2, u32> {
    let mut depths = HashMap::new();
    for tile in own.iter().filter(|tile| tile.square.level > level) {
        let depth = tile.square.level - level;
        let deepest = depths.entry(UVec2::new(tile.square.x, tile.square.y) >> depth).or_insert(depth);
        *deepest = depth.max(*deepest);
    }
    depths
}

/// The squares of a level on which a tile lies.
fn squares_of(tile: &MapTile, level: u32) -> impl Iterator<Item = UVec2> {
    let corner = UVec2::new(tile.square.x, tile.square.y);
    let (first, across) = match level.checked_sub(tile.square.level) {
        Some(coarser) => (corner << coarser, 1 << coarser),
        None => (corner >> (tile.square.level - level), 1),
    };
    (0..across).flat_map(move |y| (0..across).map(move |x| first + UVec2::new(x, y)))
}

/// The parts, `side` along each side of a square, on which a tile lies.
fn parts_of(tile: &MapTile, level: u32, side: u32) -> impl Iterator<Item = usize> {
    let finer = tile.square.level.saturating_sub(level);
    let across = side >> finer;
    let within = UVec2::new(tile.square.x, tile.square.y) & UVec2::splat((1 << finer) - 1);
    let first = within * across;
    (0..across).flat_map(move |y| (0..across).map(move |x| ((first.y + y) * side + first.x + x) as usize))
}

fn tile_record(tile: &MapTile, level: u32, first_texel: u64) -> shaders::MapTile {
    let square = tile.square;
    let origin = DVec2::new(square.x.into(), square.y.into()) * (f64::from(level) - f64::from(square.level)).exp2();
    let level = square.level + map_tile::LEVEL_BIAS - level;
    shaders::MapTile {
        first_texel: (first_texel + tile.first_texel) as u32,
        cells: tile.cells[0] | tile.cells[1] << map_tile::ROWS_SHIFT | level << map_tile::LEVEL_SHIFT,
        origin_x: origin.x as f32,
        origin_y: origin.y as f32,
    }
}

fn as_record<T: Pod>(record: &T) -> Record {
    bytemuck::cast(*record)
}

#[cfg(test)]
mod tests {
    use diacaustic_surface::{MapLayout, MapSquare};

    use super::*;

    /// The tile under a place, as the kernel finds it: its first texel and the place in cells.
    fn look_up(records: &[Record], layer: usize, place: DVec2) -> (u32, DVec2) {
        let layer: shaders::MapLayer = bytemuck::cast(records[layer]);
        let (columns, rows) = (layer.squares & 0xffff, layer.squares >> 16);
        let at = place * DVec2::new(layer.scale_x.into(), layer.scale_y.into());
        let corner = at.floor().clamp(DVec2::ZERO, DVec2::new(f64::from(columns - 1), f64::from(rows - 1)));
        let index = layer.first_square + corner.y as u32 * columns + corner.x as u32;
        let square: shaders::MapSquare = bytemuck::cast(records[index as usize]);
        let part = ((at - corner) * f64::from(square.side)).floor();
        let part = part.clamp(DVec2::ZERO, DVec2::splat(f64::from(square.side - 1)));
        let index = square.first_part + part.y as u32 * square.side + part.x as u32;
        let tile: shaders::MapTile = bytemuck::cast(records[index as usize]);
        let mask = (1 << map_tile::ROWS_SHIFT) - 1;
        let cells = UVec2::new(tile.cells & mask, (tile.cells >> map_tile::ROWS_SHIFT) & mask);
        let level = f64::from(tile.cells >> map_tile::LEVEL_SHIFT) - f64::from(map_tile::LEVEL_BIAS);
        let origin = DVec2::new(tile.origin_x.into(), tile.origin_y.into());
        (tile.first_texel, (at - origin) * level.exp2() * cells.as_dvec2())
    }

    #[test]
    fn every_place_is_found_on_its_tile() {
        let layout = MapLayout { width: 3073, height: 1025, layers: 2, ..Default::default() };
        let mut leaves = Vec::new();
        for layer in 0..2 {
            let mut open: Vec<_> = (0..3).map(|x| MapSquare { layer, level: 0, x, y: 0 }).collect();
            while let Some(square) = open.pop() {
                // Deep at one corner of the front, shallow elsewhere.
                if layer == 0 && square.level < 9 && square.y == 0 && square.x == 2 << square.level {
                    open.extend(square.children());
                } else {
                    leaves.push((square, [1 << (square.level % 3), 5]));
                }
            }
        }
        let tiles = MapTiles::new(&layout, MapTiles::roots(&layout), leaves.into_iter());
        let dense = MapTiles::dense(&layout);
        let records = map_records([None, Some((&tiles, 1000)), Some((&dense, 7))].into_iter());
        assert_eq!(records[..2], [[0; 4]; 2]);
        assert!(records.len() < 4000, "{} records", records.len());
        for tile in &tiles.tiles {
            let middle = tiles.origin(tile) + tiles.cell_size(tile) * DVec2::new(0.5, 0.25);
            let (texel, at) = look_up(&records, 2 + tile.square.layer as usize, middle);
            assert_eq!(u64::from(texel), 1000 + tile.first_texel, "{tile:?}");
            assert!((at - DVec2::new(0.5, 0.25)).length() < 1e-3, "{tile:?}: {at}");
        }
        let (texel, at) = look_up(&records, 5, DVec2::new(3072.0, 10.5));
        assert_eq!(u64::from(texel), 7 + 3073 * 1025);
        assert!((at - DVec2::new(3072.0, 10.5)).length() < 1e-3, "{at}");
    }
}
