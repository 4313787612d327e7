//! What a pilot learns: where the camera sees energy maps, where photons land on them, and so which emission numbers matter to the picture;
//! docs/photon-paths.md, "Guide".

use diacaustic_shaders::{Landing, NONE, Sighting};

use crate::{
    energy_map::MapPlacement,
    guide::{Guide, GuideTable},
};

/// Regions along the longer side of a map.
const REGIONS_ALONG_MAP: u32 = 64;
/// What a sighting after diffuse surfaces counts, against one that the picture shows.
const BOUNCED_SIGHTING: f64 = 0.1;
/// Irradiance that is added to a region's own before errors are taken relative to it, as a share of the mean that the camera sees.
const IRRADIANCE_FLOOR: f64 = 0.1;
/// Hits of a further photon that each cell is supposed to have had: what the pilot missed in a cell that meets a caster may still be there.
const PRIOR_CHANCE: f64 = 0.25;
/// Hits of the usual error that each cell is supposed to have had beside its own.
const PRIOR_HITS: f64 = 0.05;
/// The share of photons that goes evenly to cells that lead to a caster and their neighbours.
const DEFENSIVE_SHARE: f64 = 0.15;
/// How fast hits dispel doubt: with h hits a cell at least 1/(1 + 6h) of the photons are spread evenly over these cells.
const TRUST_IN_HITS: f64 = 6.0;
/// The share of photons that goes evenly everywhere, with one table.
const EVEN_SHARE: f64 = 1.0 / 64.0;
/// The same of each table where there are two: both together keep the least density of one.
const EVEN_SHARE_OF_TWO: f64 = 1.0 / 8.0;

/// A round of one light's pilot.
#[derive(Clone, Debug)]
pub(crate) struct PilotRound {
    /// The guide by which it flew.
    pub guide: Guide,
    /// An entry for each photon.
    pub landings: Vec<Landing>,
}

/// What the pilots of all lights have found.
#[derive(Debug)]
pub(crate) struct Pilot {
    maps: Vec<MapRegions>,
    /// Flux that lands in each region, W.
    flux: Vec<f64>,
    /// Surface of each region, m².
    area: Vec<f64>,
    /// How often the camera sees it.
    seen: Vec<f64>,
    /// Sums over sightings: radiance that they gathered, W/(m² sr), and radiance that they would show for 1 W/m², 1/sr.
    radiance: Vec<f64>,
    weight: Vec<f64>,
}

/// One map's texels in square blocks.
#[derive(Debug)]
struct MapRegions {
    first_texel: u64,
    texels: u64,
    width: u32,
    height: u32,
    /// Texels along a block's side.
    block: u32,
    columns: usize,
    rows: usize,
    layers: usize,
    first_region: usize,
}

impl MapRegions {
    fn new(map: &MapPlacement, first_region: usize) -> Self {
        let (width, height) = (map.layout.width, map.layout.height);
        let block = width.max(height).div_ceil(REGIONS_ALONG_MAP);
        Self {
            first_texel: map.first_texel,
            texels: map.layout.texel_count(),
            width,
            height,
            block,
            columns: width.div_ceil(block) as usize,
            rows: height.div_ceil(block) as usize,
            layers: map.layout.layers as usize,
            first_region,
        }
    }

    fn regions(&self) -> std::ops::Range<usize> {
        self.first_region..self.first_region + self.layers * self.rows * self.columns
    }

    /// The region of a texel, which is counted from the map's first.
    fn region_of(&self, texel: u64) -> usize {
        let (width, height) = (u64::from(self.width), u64::from(self.height));
        let (column, row, layer) = (texel % width, texel / width % height, texel / (width * height));
        let block = u64::from(self.block);
        self.first_region
            + (layer as usize * self.rows + (row / block) as usize) * self.columns
            + (column / block) as usize
    }
}

impl Pilot {
    pub fn new(placements: &[Option<MapPlacement>], sightings: &[Sighting]) -> Self {
        let mut maps: Vec<MapRegions> = Vec::new();
        for map in placements.iter().flatten() {
            let first_region = maps.last().map_or(0, |map| map.regions().end);
            maps.push(MapRegions::new(map, first_region));
        }
        let count = maps.last().map_or(0, |map| map.regions().end);
        let mut pilot = Self {
            flux: vec![0.0; count],
            area: vec![0.0; count],
            seen: vec![0.0; count],
            radiance: vec![0.0; count],
            weight: vec![0.0; count],
            maps,
        };
        pilot.measure_areas(placements);
        pilot.note_sightings(sightings);
        pilot
    }

    fn measure_areas(&mut self, placements: &[Option<MapPlacement>]) {
        for (map, placement) in self.maps.iter().zip(placements.iter().flatten()) {
            for texel in 0..map.texels {
                self.area[map.region_of(texel)] += placement.areas[texel as usize % placement.areas.len()];
            }
        }
        self.area = self.smoothed(&self.area);
    }

    fn note_sightings(&mut self, sightings: &[Sighting]) {
        for sighting in sightings {
            if let Some(region) = self.region_of(sighting.texel) {
                self.seen[region] += 1.0;
                self.radiance[region] += f64::from(sighting.radiance);
                self.weight[region] += f64::from(sighting.weight);
            }
            if let Some(region) = self.region_of(sighting.bounced_texel) {
                self.seen[region] += BOUNCED_SIGHTING;
            }
        }
        for sums in [&mut self.seen, &mut self.radiance, &mut self.weight] {
            *sums = smooth(&self.maps, sums);
        }
    }

    fn region_of(&self, texel: u32) -> Option<usize> {
        let texel = u64::from(texel);
        let map = self.maps.iter().find(|map| (map.first_texel..map.first_texel + map.texels).contains(&texel))?;
        Some(map.region_of(texel - map.first_texel))
    }

    /// Estimates the flux in each region from all rounds of every light's pilot.
    pub fn measure_flux(&mut self, flights: &[Vec<PilotRound>]) {
        self.flux.fill(0.0);
        for rounds in flights {
            let photons: usize = rounds.iter().map(|round| round.landings.len()).sum();
            for landing in rounds.iter().flat_map(|round| &round.landings) {
                if let Some(region) = self.region_of(landing.texel) {
                    self.flux[region] += f64::from(landing.flux) / photons as f64;
                }
            }
        }
        self.flux = self.smoothed(&self.flux);
    }

    /// For each region, the error in the picture for the square of a photon's flux, in arbitrary units.
    pub fn error_weights(&self) -> Vec<f64> {
        let flux = &self.flux;
        let per_area = |sum: f64, region: usize| if self.area[region] > 0.0 { sum / self.area[region] } else { 0.0 };
        // What makes the picture's radiance: light that the camera pass brings, and the map's.
        let irradiance = |region: usize| {
            let weight = self.weight[region];
            let direct = if weight > 0.0 { self.radiance[region] / weight } else { 0.0 };
            direct + per_area(flux[region], region)
        };
        let seen: f64 = self.seen.iter().sum();
        let mean = (0..flux.len()).map(|region| self.seen[region] * irradiance(region)).sum::<f64>() / seen.max(1e-30);
        let floor = (IRRADIANCE_FLOOR * mean).max(1e-30);
        (0..flux.len())
            .map(|region| (per_area(self.seen[region], region) / (irradiance(region) + floor)).powi(2))
            .collect()
    }

    /// The guide that follows from the landings of one light's photons, which flew with the given guides.
    pub fn learn(&self, rounds: &[PilotRound], error_weights: &[f64]) -> Guide {
        let even = &rounds[0].guide;
        let (mut aim, mut place) = (CellSums::new(&even.aim), CellSums::new(&even.place));
        for PilotRound { guide, landings } in rounds {
            for landing in landings {
                let (aim_cell, place_cell) = (landing.aim_cell as usize, landing.place_cell as usize);
                let (aim_density, place_density) = (guide.aim.density(aim_cell), guide.place.density(place_cell));
                let region = self.region_of(landing.texel);
                // What the photon would have carried without a guide.
                let flux = f64::from(landing.flux) * aim_density * place_density;
                let error = region.map(|region| flux * flux * error_weights[region]);
                let met_caster = landing.texel != NONE;
                // Each table takes the mean over the other's square.
                aim.add(aim_cell, met_caster, error.map(|error| error / place_density));
                place.add(place_cell, met_caster, error.map(|error| error / aim_density));
            }
        }
        let even_share = if even.place.cells() > 1 { EVEN_SHARE_OF_TWO } else { EVEN_SHARE };
        Guide { aim: aim.table(even_share), place: place.table(even_share) }
    }

    fn smoothed(&self, sums: &[f64]) -> Vec<f64> {
        smooth(&self.maps, sums)
    }
}

/// Each map's sums after a binomial filter over 3 × 3 regions.
fn smooth(maps: &[MapRegions], sums: &[f64]) -> Vec<f64> {
    let mut result = Vec::with_capacity(sums.len());
    for map in maps {
        for layer in sums[map.regions()].chunks_exact(map.rows * map.columns) {
            result.extend(binomial(layer, map.rows, map.columns));
        }
    }
    result
}

/// A grid, `inner` values for each of `outer`, after a binomial filter over 3 × 3, which keeps the sum.
fn binomial(grid: &[f64], outer: usize, inner: usize) -> Vec<f64> {
    let near = |at: usize, step: usize, count: usize| (at + step).saturating_sub(1).min(count - 1);
    let mut result = vec![0.0; grid.len()];
    for (index, value) in grid.iter().enumerate() {
        let (i, j) = (index / inner, index % inner);
        for (di, share_i) in [0.25, 0.5, 0.25].into_iter().enumerate() {
            for (dj, share_j) in [0.25, 0.5, 0.25].into_iter().enumerate() {
                result[near(i, di, outer) * inner + near(j, dj, inner)] += share_i * share_j * value;
            }
        }
    }
    result
}

/// What a pilot has found of the cells of a table.
struct CellSums {
    columns: usize,
    rows: usize,
    photons: Vec<f64>,
    /// Those that met a caster.
    met: Vec<f64>,
    /// Those that reached a receiver through a caster.
    hits: Vec<f64>,
    /// Squares of flux, weighted by the error that they make.
    error: Vec<f64>,
    /// Sum of the square roots of what was added to `error`.
    root_error: f64,
}

impl CellSums {
    fn new(table: &GuideTable) -> Self {
        let zeros = || vec![0.0; table.cells()];
        Self {
            columns: table.columns,
            rows: table.rows,
            photons: zeros(),
            met: zeros(),
            hits: zeros(),
            error: zeros(),
            root_error: 0.0,
        }
    }

    /// Adds a photon; `error` is none if it reached no receiver through a caster.
    fn add(&mut self, cell: usize, met_caster: bool, error: Option<f64>) {
        self.photons[cell] += 1.0;
        self.met[cell] += f64::from(u8::from(met_caster));
        if let Some(error) = error {
            self.hits[cell] += 1.0;
            self.error[cell] += error;
            self.root_error += error.sqrt();
        }
    }

    /// The density that makes the error least, with shares that keep every cell alive.
    fn table(&self, even_share: f64) -> GuideTable {
        let cells = self.photons.len();
        let [met, hits, error] =
            [&self.met, &self.hits, &self.error].map(|sums| binomial(sums, self.columns, self.rows));
        let all_hits: f64 = self.hits.iter().sum();
        let usual_error = if all_hits > 0.0 { (self.root_error / all_hits).powi(2) } else { 0.0 };
        let importance: Vec<f64> = (0..cells)
            .map(|cell| {
                // The chance of a hit is the cell's own, for silhouettes are sharp; the error of a hit is its neighbourhood's.
                let chance = (self.hits[cell] + PRIOR_CHANCE) / (self.photons[cell] + 1.0);
                let error = (error[cell] + PRIOR_HITS * usual_error) / (hits[cell] + PRIOR_HITS);
                if met[cell] > 0.0 { (chance * error).sqrt() } else { 0.0 }
            })
            .collect();
        let (important, defended) = (importance.iter().sum::<f64>(), met.iter().filter(|&&met| met > 0.0).count());
        let doubt = 1.0 / (1.0 + TRUST_IN_HITS * all_hits / defended.max(1) as f64);
        let by_importance =
            if important > 0.0 { (1.0 - doubt.max(DEFENSIVE_SHARE) - even_share).max(0.0) } else { 0.0 };
        let by_defence = if defended > 0 { 1.0 - even_share - by_importance } else { 0.0 };
        let weights: Vec<f64> = (0..cells)
            .map(|cell| {
                let by_importance = if important > 0.0 { by_importance * importance[cell] / important } else { 0.0 };
                let by_defence = if met[cell] > 0.0 { by_defence / defended as f64 } else { 0.0 };
                even_share / cells as f64 + by_importance + by_defence
            })
            .collect();
        GuideTable::from_weights(self.columns, self.rows, &weights)
    }
}
