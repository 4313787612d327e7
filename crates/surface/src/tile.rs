//! How the plane of an energy map is divided into tiles of texels.

use glam::{DVec2, UVec2};

use crate::MapLayout;

/// The finest level of squares: their places fit into 32 bits, and a texel of theirs is finer than places are known.
pub const FINEST_LEVEL: u32 = 16;

/// A square of a quadtree over a map's plane: at level l it is 2⁻ˡ as wide as those of level 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct MapSquare {
    /// Layer of the map.
    pub layer: u32,
    /// Level, 0 to [`FINEST_LEVEL`].
    pub level: u32,
    /// Column among the squares of its level.
    pub x: u32,
    /// Row among them.
    pub y: u32,
}

/// A square of a map's plane that is filled with an even grid of cells. Texels stand at the cells' corners; those on the border are the
/// tile's own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MapTile {
    /// Its square.
    pub square: MapSquare,
    /// Cells along x and y, at least 1: one less than texels.
    pub cells: [u32; 2],
    /// Its first texel among the map's, which stand row by row.
    pub first_texel: u64,
}

/// The tiles of a map: leaves of a quadtree, which cover each layer's plane once.
#[derive(Clone, Debug, PartialEq)]
pub struct MapTiles {
    /// Squares of level 0 along x and y.
    pub roots: [u32; 2],
    /// Width and height of the plane, in the layout's texels.
    pub extent: DVec2,
    /// The tiles, in the order of their texels: layer by layer along a Z-order curve through the squares of each level 0, row by row.
    pub tiles: Vec<MapTile>,
}

impl MapSquare {
    /// The four squares of the next level in it.
    #[must_use]
    pub fn children(self) -> [Self; 4] {
        [[0, 0], [1, 0], [0, 1], [1, 1]].map(|[x, y]| Self {
            level: self.level + 1,
            x: 2 * self.x + x,
            y: 2 * self.y + y,
            ..self
        })
    }

    /// Its place in the order of tiles, that of its first part of the finest level: layer, row and column at level 0, place on a Z-order curve.
    fn order(self) -> (u32, u32, u32, u64) {
        let (root_x, root_y) = (self.x >> self.level, self.y >> self.level);
        let within = |at: u32, root: u32| u64::from((at - (root << self.level)) << (FINEST_LEVEL - self.level));
        let spread = |at: u64| (0..FINEST_LEVEL).fold(0, |sum, bit| sum | (at >> bit & 1) << (2 * bit));
        (self.layer, root_y, root_x, spread(within(self.x, root_x)) | spread(within(self.y, root_y)) << 1)
    }
}

impl MapTile {
    /// Texels of the tile.
    pub fn texel_count(&self) -> u64 {
        u64::from(self.cells[0] + 1) * u64::from(self.cells[1] + 1)
    }

    /// The one of a layer's tiles, in their order, that covers a square of the finest level; none beside the plane.
    pub(crate) fn at_finest(tiles: &[Self], [x, y]: [u64; 2]) -> Option<&Self> {
        let layer = tiles.first()?.square.layer;
        let [x, y] = [u32::try_from(x).ok()?, u32::try_from(y).ok()?];
        let wanted = MapSquare { layer, level: FINEST_LEVEL, x, y }.order();
        let after = tiles.partition_point(|tile| tile.square.order() <= wanted);
        tiles[..after].last().filter(|tile| {
            let shift = FINEST_LEVEL - tile.square.level;
            [x >> shift, y >> shift] == [tile.square.x, tile.square.y]
        })
    }
}

impl MapTiles {
    /// One tile for each layer, with the texels of the layout: layer by layer, row by row.
    pub fn dense(layout: &MapLayout) -> Self {
        let cells = [layout.width - 1, layout.height - 1];
        let square = |layer| MapSquare { layer, level: 0, x: 0, y: 0 };
        Self::new(layout, [1, 1], (0..layout.layers).map(|layer| (square(layer), cells)))
    }

    /// Tiles of the given squares and cells, in any order, which must cover each layer of the layout's plane once.
    pub fn new(layout: &MapLayout, roots: [u32; 2], squares: impl Iterator<Item = (MapSquare, [u32; 2])>) -> Self {
        let mut first_texel = 0;
        let mut squares: Vec<_> = squares.collect();
        squares.sort_by_key(|(square, _)| square.order());
        let tiles = squares.into_iter().map(|(square, cells)| {
            let tile = MapTile { square, cells, first_texel };
            first_texel += tile.texel_count();
            tile
        });
        Self { roots, extent: extent(layout), tiles: tiles.collect() }
    }

    /// The squares of level 0 into which a layout's plane is best divided: as nearly square as can be, 256 at most.
    pub fn roots(layout: &MapLayout) -> [u32; 2] {
        let DVec2 { x, y } = extent(layout);
        let along = |long: f64, short: f64| (long / short).round().clamp(1.0, 256.0) as u32;
        [along(x, y), along(y, x)]
    }

    /// Texels of all tiles.
    pub fn texel_count(&self) -> u64 {
        self.tiles.last().map_or(0, |tile| tile.first_texel + tile.texel_count())
    }

    /// Width and height of a square of a level, in the layout's texels.
    pub fn square_size(&self, level: u32) -> DVec2 {
        self.extent / (UVec2::from(self.roots) << level).as_dvec2()
    }

    /// Width and height of a tile's cells, in the layout's texels.
    pub fn cell_size(&self, tile: &MapTile) -> DVec2 {
        self.square_size(tile.square.level) / UVec2::from(tile.cells).as_dvec2()
    }

    /// The tile under a place of a layer's plane, in the layout's texels; none if there is no such layer.
    pub fn at(&self, layer: u32, place: DVec2) -> Option<&MapTile> {
        let count = (UVec2::from(self.roots) << FINEST_LEVEL).as_dvec2();
        let at = (place / self.extent * count).floor().clamp(DVec2::ZERO, count - 1.0).as_uvec2();
        let wanted = MapSquare { layer, level: FINEST_LEVEL, x: at.x, y: at.y }.order();
        let after = self.tiles.partition_point(|tile| tile.square.order() <= wanted);
        self.tiles[..after].last().filter(|tile| tile.square.layer == layer)
    }

    /// Whether a tile lies under a place of its layer's plane.
    pub fn covers(&self, tile: &MapTile, place: DVec2) -> bool {
        let at = (place - self.origin(tile)) / self.square_size(tile.square.level);
        at.cmpge(DVec2::ZERO).all() && at.cmplt(DVec2::ONE).all()
    }

    /// The lower corner of a tile, in the layout's texels.
    pub fn origin(&self, tile: &MapTile) -> DVec2 {
        UVec2::new(tile.square.x, tile.square.y).as_dvec2() * self.square_size(tile.square.level)
    }
}

fn extent(layout: &MapLayout) -> DVec2 {
    DVec2::new(f64::from(layout.width - 1), f64::from(layout.height - 1))
}
