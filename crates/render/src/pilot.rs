//! What a pilot learns: where the camera sees energy maps, where photons land on them, and so which emission numbers matter to the picture;
//! docs/photon-paths.md, "Guide".

use diacaustic_shaders::{Landing, NONE, Sighting};
use diacaustic_surface::{MapSquare, MapTiles};

use crate::{
    guide::{Guide, GuideTable},
    map_plan::MapPlan,
};

/// Regions along the longer side of a map.
const REGIONS_ALONG_MAP: u32 = 64;
/// What a sighting after diffuse surfaces counts, against one that the picture shows.
const BOUNCED_SIGHTING: f64 = 0.1;
/// Irradiance that is added to a region's own before errors are taken relative to it, as a share of the mean that the camera sees.
const IRRADIANCE_FLOOR: f64 = 0.1;
/// Photons that each cell is supposed to have had beside its own, with the hits of those around.
const PRIOR_PHOTONS: f64 = 1.0;
/// Hits of a further photon that each neighbourhood is supposed to have had: what the pilot missed in a cell that meets a caster may still be there.
const PRIOR_CHANCE: f64 = 0.25;
/// Hits of the usual error that each cell is supposed to have had beside its own.
const PRIOR_HITS: f64 = 0.05;
/// The share of photons that goes evenly to cells that lead to a caster and their neighbours.
const DEFENSIVE_SHARE: f64 = 0.1;
/// How fast hits dispel doubt: with h hits a cell at least 1/(1 + 6h) of the photons are spread evenly over these cells.
const TRUST_IN_HITS: f64 = 6.0;
/// The share of photons that goes evenly everywhere, with one table.
const EVEN_SHARE: f64 = 1.0 / 64.0;
/// The same of each table where there are two.
const EVEN_SHARE_OF_TWO: f64 = 1.0 / 16.0;
/// The share of the largest photon's units that the guide leaves to what narrow targets get: where targets differ in width, the least density
/// is greater, so that fixed-point sums do not round light away.
const LEAST_UNITS: f64 = 1.0 / 4096.0;
/// The most that this makes of the even share, of both tables together.
const MOST_EVEN_SHARE: f64 = 0.25;

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
    /// An entry for each object.
    maps: Vec<Option<MapRegions>>,
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

/// One map's plane in rectangles, which are nearly square.
#[derive(Debug)]
struct MapRegions {
    columns: usize,
    rows: usize,
    layers: usize,
    /// Regions for each unit of the plane, along x and y, from middle to middle.
    scale: [f64; 2],
    first_region: usize,
}

impl MapRegions {
    fn new(plan: &MapPlan, first_region: usize) -> Self {
        let (width, height) = (plan.layout.width, plan.layout.height);
        // Regions stand around the texels of a coarse map, whose bilinear weights give their areas.
        let block = (width.max(height) - 1).div_ceil(REGIONS_ALONG_MAP - 1);
        let cells = [width, height].map(|texels| (texels - 1).div_ceil(block));
        Self {
            columns: cells[0] as usize + 1,
            rows: cells[1] as usize + 1,
            layers: plan.layout.layers as usize,
            scale: [f64::from(cells[0]) / f64::from(width - 1), f64::from(cells[1]) / f64::from(height - 1)],
            first_region,
        }
    }

    fn regions(&self) -> std::ops::Range<usize> {
        self.first_region..self.first_region + self.layers * self.rows * self.columns
    }

    /// The regions as texels of tiles.
    fn tiles(&self, plan: &MapPlan) -> MapTiles {
        let cells = [self.columns as u32 - 1, self.rows as u32 - 1];
        let squares = (0..plan.layout.layers).map(|layer| (MapSquare { layer, level: 0, x: 0, y: 0 }, cells));
        MapTiles::new(&plan.layout, [1, 1], squares)
    }

    /// The region of a place of the plane; `record` is that of its layer.
    fn region_of(&self, record: u32, place: [f32; 2]) -> usize {
        let along = |axis: usize, count: usize| {
            let at = (f64::from(place[axis]) * self.scale[axis]).round();
            at.clamp(0.0, (count - 1) as f64) as usize
        };
        let layer = (record as usize % 2).min(self.layers - 1);
        self.first_region + (layer * self.rows + along(1, self.rows)) * self.columns + along(0, self.columns)
    }
}

impl Pilot {
    pub fn new(plans: &[Option<MapPlan>], sightings: &[Sighting]) -> Self {
        let mut count = 0;
        let maps: Vec<Option<MapRegions>> = plans
            .iter()
            .map(|plan| {
                let map = MapRegions::new(plan.as_ref()?, count);
                count = map.regions().end;
                Some(map)
            })
            .collect();
        let areas = maps.iter().zip(plans).filter_map(|(map, plan)| Some((map.as_ref()?, plan.as_ref()?)));
        let area: Vec<f64> = areas.flat_map(|(map, plan)| plan.texel_areas(&map.tiles(plan))).collect();
        let mut pilot = Self {
            flux: vec![0.0; count],
            area: smooth(&maps, &area),
            seen: vec![0.0; count],
            radiance: vec![0.0; count],
            weight: vec![0.0; count],
            maps,
        };
        pilot.note_sightings(sightings);
        pilot
    }

    fn note_sightings(&mut self, sightings: &[Sighting]) {
        for sighting in sightings {
            if let Some(region) = self.region_of(sighting.layer, [sighting.x, sighting.y]) {
                self.seen[region] += 1.0;
                self.radiance[region] += f64::from(sighting.radiance);
                self.weight[region] += f64::from(sighting.weight);
            }
            if let Some(region) = self.region_of(sighting.bounced_layer, [sighting.bounced_x, sighting.bounced_y]) {
                self.seen[region] += BOUNCED_SIGHTING;
            }
        }
        for sums in [&mut self.seen, &mut self.radiance, &mut self.weight] {
            *sums = smooth(&self.maps, sums);
        }
    }

    /// The region of a place; `record` is that of its layer, or says that there is none.
    fn region_of(&self, record: u32, place: [f32; 2]) -> Option<usize> {
        let map = self.maps.get(record as usize / 2)?.as_ref()?;
        Some(map.region_of(record, place))
    }

    /// Estimates the flux in each region from all rounds of every light's pilot.
    pub fn measure_flux(&mut self, flights: &[Vec<PilotRound>]) {
        self.flux.fill(0.0);
        for rounds in flights {
            let photons: usize = rounds.iter().map(|round| round.landings.len()).sum();
            for landing in rounds.iter().flat_map(|round| &round.landings) {
                if let Some(region) = self.region_of(landing.layer, [landing.x, landing.y]) {
                    self.flux[region] += f64::from(landing.flux) / photons as f64;
                }
            }
        }
        self.flux = smooth(&self.maps, &self.flux);
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
    /// `photon_range` is the least of its targets' largest photons over the greatest.
    pub fn learn(&self, rounds: &[PilotRound], error_weights: &[f64], photon_range: f64) -> Guide {
        let even = &rounds[0].guide;
        let (mut aim, mut place) = (CellSums::new(&even.aim), CellSums::new(&even.place));
        for PilotRound { guide, landings } in rounds {
            for landing in landings {
                let (aim_cell, place_cell) = (landing.aim_cell as usize, landing.place_cell as usize);
                let (aim_density, place_density) = (guide.aim.density(aim_cell), guide.place.density(place_cell));
                let region = self.region_of(landing.layer, [landing.x, landing.y]);
                // What the photon would have carried without a guide.
                let flux = f64::from(landing.flux) * f64::from(landing.density);
                let error = region.map(|region| flux * flux * error_weights[region]);
                let met_caster = landing.layer != NONE;
                // Each table takes the mean over the other's square.
                aim.add(aim_cell, met_caster, error.map(|error| error / place_density));
                place.add(place_cell, met_caster, error.map(|error| error / aim_density));
            }
        }
        let least = (LEAST_UNITS / photon_range).min(MOST_EVEN_SHARE);
        let even_share =
            if even.place.cells() > 1 { least.sqrt().max(EVEN_SHARE_OF_TWO) } else { least.max(EVEN_SHARE) };
        Guide { aim: aim.table(even_share), place: place.table(even_share) }
    }
}

/// Each map's sums after a binomial filter over 3 × 3 regions.
fn smooth(maps: &[Option<MapRegions>], sums: &[f64]) -> Vec<f64> {
    let mut result = Vec::with_capacity(sums.len());
    for map in maps.iter().flatten() {
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
        let [photons, met, hits, error] =
            [&self.photons, &self.met, &self.hits, &self.error].map(|sums| binomial(sums, self.columns, self.rows));
        let all_hits: f64 = self.hits.iter().sum();
        let usual_error = if all_hits > 0.0 { (self.root_error / all_hits).powi(2) } else { 0.0 };
        let importance: Vec<f64> = (0..cells)
            .map(|cell| {
                // The chance of a hit is the cell's own, for silhouettes are sharp, as far as its photons tell it; the error of a hit is its
                // neighbourhood's.
                let around = (hits[cell] + PRIOR_CHANCE) / (photons[cell] + 1.0);
                let chance = (self.hits[cell] + PRIOR_PHOTONS * around) / (self.photons[cell] + PRIOR_PHOTONS);
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
