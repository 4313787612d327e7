//! The irradiance cache: light that bounces to receivers, measured by a few camera paths and shared by all others.
//!
//! `docs/irradiance-cache.md` says how.

mod grid;

use diacaustic_scene::Scene;
use diacaustic_shaders::Sighting;

use self::grid::{Found, Grid, Node, values};
use crate::{
    Error,
    features::Features,
    gpu::{Gpu, Purpose},
    map_plan::{MapPlan, default_texel_width},
    refine::DARKNESS,
};

const CACHE: Purpose = Purpose { what: "the irradiance cache", remedy: "set irradiance_cache = false" };
/// From node to node, in texels of half a pixel, at [`USUAL_TARGET`].
const CELL_TEXELS: f64 = 16.0;
/// The target error for which constants are stated.
const USUAL_TARGET: f64 = 0.1;
/// The most nodes along a side of a grid.
const MOST_NODES: usize = 512;
/// Paths of each round that a value stands on at least, at [`USUAL_TARGET`]: those of a square of 16 pixels.
const PATHS_OF_ROUND: f64 = 16.0;
/// How far a value may reach, in mean distances to what lights the place (Ward, Rubinstein and Clear 1988).
const REACH: f64 = 0.35;
/// The same in cells of the grid.
const REACH_CELLS: f64 = 8.0;
/// Paths for each four pixels squared, at first and at most.
const ROUNDS: std::ops::RangeInclusive<u32> = 8..=128;
/// The part of the squared target error that the cache may make up.
const ERROR_SHARE: f64 = 0.05;
/// The part of a place's light that must be in the cache for the place to tell how exact it is.
const LEAST_LIGHT: f64 = 0.05;

/// The grids of a scene's maps and, once paths have filled it, their values.
#[derive(Debug)]
pub(crate) struct IrradianceCache {
    /// One for each layer of a map, two for each object.
    grids: Vec<Option<Grid>>,
    nodes: usize,
    target: f64,
    /// What kernels read: a record for each layer, then the nodes.
    pub buffer: wgpu::Buffer,
}

impl IrradianceCache {
    /// Grids over the maps that lie on one chart, without values.
    pub fn new(gpu: &Gpu, scene: &Scene, maps: &[Option<MapPlan>], features: Features) -> Result<Self, Error> {
        if !features.has_irradiance_cache() {
            return Self::none(gpu);
        }
        let target = f64::from(scene.settings.target_error);
        let mut cache = Self { grids: Vec::new(), nodes: 0, target, buffer: gpu.zeroed(CACHE, 0)? };
        let finer = cache.finer();
        for (plan, object) in maps.iter().zip(&scene.objects) {
            let texel = f64::from(default_texel_width(&scene.camera, &scene.settings, object));
            let plan = plan.as_ref().filter(|plan| plan.layout.chart_count == 1);
            for side in 0..2 {
                let grid = plan.map(|plan| Grid::new(plan, cache.nodes, finer * CELL_TEXELS * texel, MOST_NODES));
                // A map of one layer takes both sides.
                let is_shared = side == 1 && plan.is_some_and(|plan| plan.layout.layers == 1);
                let grid = if is_shared { cache.grids.last().copied().flatten() } else { grid };
                cache.nodes += grid.filter(|_| !is_shared).map_or(0, |grid| grid.nodes());
                cache.grids.push(grid);
            }
        }
        cache.buffer = gpu.filled(CACHE, &cache.blank_records())?;
        Ok(cache)
    }

    /// One that knows nothing.
    pub fn none(gpu: &Gpu) -> Result<Self, Error> {
        Ok(Self { grids: Vec::new(), nodes: 0, target: USUAL_TARGET, buffer: gpu.zeroed(CACHE, 0)? })
    }

    /// The size of cells over that at [`USUAL_TARGET`]: where light changes evenly, the error by their size goes with its fourth power.
    fn finer(&self) -> f64 {
        (self.target / USUAL_TARGET).sqrt().min(1.0)
    }

    /// Whether there is a grid at all.
    pub fn has_grids(&self) -> bool {
        self.nodes > 0
    }

    /// Lets kernels know of no values.
    pub fn forget(&self, gpu: &Gpu) {
        gpu.queue.write_buffer(&self.buffer, 0, bytemuck::cast_slice(&self.blank_records()));
    }

    /// Measures bounced light by the paths of `follow`, as many as its error asks for, and lets kernels read it. Returns its error: the mean over the
    /// picture of its squared deviation, relative to the brightness.
    pub fn fill(&self, gpu: &Gpu, mut follow: impl FnMut() -> Result<Vec<Sighting>, Error>) -> Result<f64, Error> {
        // Whole powers of two of the paths' low-discrepancy points are spread evenly, each half by itself too.
        let mut all = vec![Found::default(); self.nodes];
        let mut rounds = 0;
        loop {
            let first = all.clone();
            let (mut later, mut seen) = (vec![Found::default(); self.nodes], Vec::new());
            for _ in 0..rounds.max(1) {
                seen = follow()?;
                self.note(&mut later, &seen);
            }
            all.iter_mut().zip(&later).for_each(|(sum, later)| sum.add(later, 1.0));
            rounds += rounds.max(1);
            if rounds < *ROUNDS.start() {
                continue;
            }
            let fewest = PATHS_OF_ROUND * self.finer().powi(2) * f64::from(rounds);
            let halves = [&first, &later].map(|half| self.values(half, 0.5 * fewest));
            let error = self.error(&seen, halves.each_ref().map(|half| &half[..]));
            if error <= ERROR_SHARE * self.target.powi(2) || rounds >= *ROUNDS.end() {
                let nodes = self.texels(&self.values(&all, fewest));
                gpu.queue.write_buffer(&self.buffer, 0, bytemuck::cast_slice(&self.records(&nodes)));
                return Ok(error);
            }
        }
    }

    /// The records without values.
    fn blank_records(&self) -> Vec<[f32; 4]> {
        self.records(&vec![[0.0; 4]; self.nodes])
    }

    /// The layer's record for each layer, then the nodes.
    fn records(&self, nodes: &[[f32; 4]]) -> Vec<[f32; 4]> {
        let record = |grid: &Option<Grid>| match grid {
            Some(grid) => {
                [(self.grids.len() + grid.first) as f32, grid.columns as f32, grid.rows as f32, grid.scale as f32]
            }
            None => [0.0; 4],
        };
        self.grids.iter().map(record).chain(nodes.iter().copied()).collect()
    }

    /// The grid and the nodes around a path's first place, if it went on from there.
    fn nodes_at(&self, sighting: &Sighting) -> Option<[(usize, f64); 4]> {
        let grid = self.grids.get(sighting.layer as usize)?.as_ref()?;
        let around = grid.around([sighting.x, sighting.y]);
        (sighting.inverse_distance >= 0.0).then(|| around.map(|(node, weight)| (grid.first + node, weight)))
    }

    fn note(&self, found: &mut [Found], seen: &[Sighting]) {
        for sighting in seen {
            for (node, weight) in self.nodes_at(sighting).into_iter().flatten() {
                found[node].add(&Found::of(sighting), weight);
            }
        }
    }

    /// The values of all grids' nodes; those of grids that too few paths have seen reach endlessly.
    fn values(&self, found: &[Found], fewest: f64) -> Vec<Node> {
        let unknown = Node { reach: f64::INFINITY, ..Node::default() };
        let mut nodes = vec![unknown; self.nodes];
        for grid in self.grids.iter().flatten() {
            let own = grid.first..grid.first + grid.nodes();
            if let Some(values) = values(grid, found[own.clone()].to_vec(), fewest) {
                nodes[own].copy_from_slice(&values);
            }
        }
        nodes
    }

    /// The nodes as kernels read them: known where what lights a place is far beside how far its value reaches.
    fn texels(&self, nodes: &[Node]) -> Vec<[f32; 4]> {
        let mut texels = vec![[0.0; 4]; nodes.len()];
        for grid in self.grids.iter().flatten() {
            for (texel, node) in texels[grid.first..].iter_mut().zip(&nodes[grid.first..grid.first + grid.nodes()]) {
                let is_known = node.reach * node.inverse_distance <= REACH && node.reach <= REACH_CELLS * grid.cell;
                if is_known {
                    *texel = node.irradiance().extend(1.0).to_array();
                }
            }
        }
        texels
    }

    /// The mean over what paths saw last of the squared deviation of radiance, by what two halves of all paths differ in, relative to brightness.
    fn error(&self, seen: &[Sighting], [first, second]: [&[Node]; 2]) -> f64 {
        let mean = seen.iter().map(|sighting| f64::from(sighting.radiance)).sum::<f64>() / seen.len().max(1) as f64;
        let floor = (f64::from(DARKNESS) * mean * mean).max(f64::MIN_POSITIVE);
        let (mut sum, mut count) = (0.0, 0u32);
        for sighting in seen {
            let Some(around) = self.nodes_at(sighting) else { continue };
            let at = |nodes: &[Node]| {
                let brightness = |node: &Node| node.irradiance.iter().sum::<f64>() / 3.0;
                around.iter().map(|&(node, weight)| weight * brightness(&nodes[node])).sum::<f64>()
            };
            let weight = f64::from(sighting.weight);
            let [one, other] = [at(first), at(second)].map(|irradiance| weight * irradiance);
            let radiance = f64::from(sighting.radiance).max(0.5 * (one + other));
            if 0.5 * (one + other) > LEAST_LIGHT * radiance {
                sum += ((0.5 * (one - other)).powi(2) / (radiance.powi(2) + floor)).min(1.0);
                count += 1;
            }
        }
        sum / f64::from(count.max(1))
    }
}
