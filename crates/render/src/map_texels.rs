//! The texels of all maps and how their tiles join, as the kernels read it.

use diacaustic_shaders::{MapTexel, MapTileRecord, MapWeld, MapWeldPart, NONE};
use diacaustic_surface::{TexelChart, Weld, WeldPart};

use crate::{
    Error,
    gpu::{Gpu, Purpose, texture_bytes},
    map_placement::MapPlacement,
};

const TEXELS: Purpose = Purpose { what: "the list of the maps' texels", remedy: "lower map_size" };
const TILES: Purpose = Purpose { what: "the list of the maps' tiles", remedy: "lower map_budget" };
const WELDS: Purpose = Purpose { what: "the list of places where tiles meet", remedy: "lower map_budget" };

/// A weight of 1, but for rounding.
const WHOLE: f64 = 0.999;

/// What the passes from sums to irradiance read.
#[derive(Debug)]
pub(crate) struct MapTexels {
    /// A MapTexel for each texel.
    pub records: wgpu::TextureView,
    pub tiles: wgpu::Buffer,
    pub welds: wgpu::Buffer,
    pub parts: wgpu::Buffer,
    pub weld_count: u64,
    pub bytes: u64,
}

/// The same on the host.
#[derive(Default)]
struct Lists {
    texels: Vec<MapTexel>,
    tiles: Vec<MapTileRecord>,
    welds: Vec<MapWeld>,
    parts: Vec<MapWeldPart>,
}

impl MapTexels {
    pub fn new(gpu: &Gpu, placements: &[Option<MapPlacement>]) -> Result<Self, Error> {
        let mut lists = Lists::default();
        for (object, map) in placements.iter().enumerate().filter_map(|(object, map)| Some((object, map.as_ref()?))) {
            lists.add_texels(object, map);
            lists.add_welds(map);
        }
        let (records, tiles) = (gpu.records(TEXELS, &lists.texels)?, gpu.filled(TILES, &lists.tiles)?);
        let (welds, parts) = (gpu.filled(WELDS, &lists.welds)?, gpu.filled(WELDS, &lists.parts)?);
        Ok(Self {
            bytes: texture_bytes(&records) + tiles.size() + welds.size() + parts.size(),
            records: records.create_view(&wgpu::TextureViewDescriptor::default()),
            tiles,
            weld_count: lists.welds.len() as u64,
            welds,
            parts,
        })
    }
}

impl Lists {
    fn add_texels(&mut self, object: usize, map: &MapPlacement) {
        let charts = map.surfaces.iter().map(|texel| match texel.chart {
            TexelChart::None => 0,
            TexelChart::One(chart) => chart + 1,
            TexelChart::Cell(_) | TexelChart::Several => NONE,
        });
        let mut texels = map.divisors().zip(charts);
        for tile in &map.tiles.tiles {
            let own = texels.by_ref().take(tile.texel_count() as usize);
            let number = self.tiles.len() as u32;
            self.texels.extend(own.map(|(area, chart)| MapTexel { area, chart, tile: number, link: 0 }));
            let (origin, cell) = (map.tiles.origin(tile), map.tiles.cell_size(tile));
            self.tiles.push(MapTileRecord {
                first_texel: (map.first_texel + tile.first_texel) as u32,
                columns: tile.cells[0],
                rows: tile.cells[1],
                layer: 2 * object as u32 + tile.square.layer,
                origin_x: origin.x as f32,
                origin_y: origin.y as f32,
                cell_x: cell.x as f32,
                cell_y: cell.y as f32,
            });
        }
    }

    fn add_welds(&mut self, map: &MapPlacement) {
        let (first_texel, first_weld) = (map.first_texel, self.welds.len() as u64);
        for weld in &map.welds.welds {
            let (first_part, part_count) = (self.parts.len() as u32, weld.sources.len() as u32);
            self.welds.push(MapWeld {
                owner: (first_texel + weld.owner) as u32,
                first_part,
                part_count,
                area: weld.area as f32,
            });
            self.parts.extend(weld.sources.iter().map(|source| part(source, first_texel)));
        }
        for (texel, links) in &map.welds.linked {
            let record = &mut self.texels[(first_texel + texel) as usize];
            record.link = self.parts.len() as u32 + 1;
            if let [weld] = links.as_slice()
                && joins_charts(map, &map.welds.welds[weld.index as usize])
            {
                record.chart = NONE;
            }
            record.area = match links.as_slice() {
                [weld] => map.welds.welds[weld.index as usize].area as f32,
                // On a border it stands for half a cell, as its like on the other side would.
                _ => 2.0 * record.area,
            };
            self.parts.push(MapWeldPart { index: links.len() as u32, weight: 0.0 });
            self.parts.extend(links.iter().map(|link| part(link, first_weld)));
        }
    }
}

/// Whether texels of several charts are wholly one in a weld: what goes into it by a part is stitched, and goes on smoothly.
fn joins_charts(map: &MapPlacement, weld: &Weld) -> bool {
    let chart = |texel: u64| map.surfaces[texel as usize].chart;
    let is_whole = |source: &&WeldPart| source.weight >= WHOLE;
    weld.sources.iter().filter(is_whole).any(|source| chart(source.index) != chart(weld.owner))
}

fn part(part: &WeldPart, first: u64) -> MapWeldPart {
    MapWeldPart { index: (first + part.index) as u32, weight: part.weight as f32 }
}
