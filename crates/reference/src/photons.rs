//! Photons, as `docs/photon-paths.md` defines them, and the maps and ledger that they fill.

mod deposit;
mod emission;
mod flight;
mod guide;
mod ledger;

use std::ops::Range;

use glam::DVec3;
use rayon::prelude::*;

use crate::geometry::World;

pub use self::deposit::{Landing, MapLayout};
pub use self::emission::{AimDisc, Emission};
pub use self::flight::{End, Event, PhotonPath, Vertex};
pub use self::guide::{Guide, GuideTable};
pub use self::ledger::Ledger;

use self::emission::Emitter;

/// Photons whose landings are summed together, in order.
const CHUNK: usize = 4096;
/// Chunks traced before their landings are laid into the maps; bounds the memory that waits.
const CHUNKS_PER_WAVE: usize = 64;

/// A range of photons of one light.
#[derive(Clone, Debug)]
pub struct PhotonJob<'a> {
    /// Where they fly.
    pub world: &'a World<'a>,
    /// For each object, its energy map, or none if it keeps none.
    pub maps: &'a [Option<MapLayout>],
    /// Index of the light in the scene.
    pub light: usize,
    /// How they leave the light.
    pub emission: Emission<'a>,
    /// How their emission numbers are moved, if at all.
    pub guide: Option<&'a Guide>,
    /// Seed of their random numbers.
    pub seed: u32,
    /// Their indices.
    pub photons: Range<u32>,
}

/// What the photons of a job have left behind.
#[derive(Clone, Debug, PartialEq)]
pub struct PhotonResult {
    /// For each object, the flux laid on its texels, W times the number of photons: at [`MapLayout::texel_index`]; empty
    /// without a map.
    pub maps: Vec<Vec<DVec3>>,
    /// Where the flux went, W times the number of photons.
    pub ledger: Ledger,
}

/// Traces every photon of the job. The result does not depend on the number of threads.
///
/// # Panics
/// If the light is a surface (a rectangle, a disk, an emissive material) or an environment, or its emission is meant for
/// another kind of light; if a map or a texel coordinate that the job should have is missing.
pub fn trace(job: &PhotonJob) -> PhotonResult {
    let empty = |layout: &Option<MapLayout>| vec![DVec3::ZERO; layout.as_ref().map_or(0, MapLayout::texels)];
    let mut result = PhotonResult { maps: job.maps.iter().map(empty).collect(), ledger: Ledger::default() };
    let emitter = Emitter::new(job);
    for wave in Chunks::new(job.photons.clone(), CHUNK * CHUNKS_PER_WAVE) {
        let chunks: Vec<Range<u32>> = Chunks::new(wave, CHUNK).collect();
        let traced: Vec<(Ledger, Vec<Landing>)> =
            chunks.into_par_iter().map(|chunk| trace_chunk(job, &emitter, chunk)).collect();
        for (ledger, landings) in traced {
            result.ledger += ledger;
            for landing in landings {
                lay(job, &landing, &mut result.maps);
            }
        }
    }
    result
}

/// The path of one photon of the job's light, which need not be in the job's range.
///
/// # Panics
/// If the light is not one that [`trace`] takes.
pub fn trace_one(job: &PhotonJob, photon: u32) -> PhotonPath {
    flight::fly(job, &Emitter::new(job), photon)
}

fn trace_chunk(job: &PhotonJob, emitter: &Emitter, photons: Range<u32>) -> (Ledger, Vec<Landing>) {
    let mut ledger = Ledger::default();
    let mut landings = Vec::new();
    for photon in photons {
        let path = flight::fly(job, emitter, photon);
        ledger += path.ledger;
        if let End::Deposited(landing) = path.end {
            landings.push(landing);
        }
    }
    (ledger, landings)
}

fn lay(job: &PhotonJob, landing: &Landing, maps: &mut [Vec<DVec3>]) {
    let triangle = &job.world.triangles()[landing.triangle];
    let Some(layout) = &job.maps[triangle.object] else { return };
    for (texel, weight) in layout.footprint(triangle.index, landing) {
        maps[triangle.object][texel] += weight * landing.flux;
    }
}

/// A range in pieces of one size, but for the last.
struct Chunks {
    rest: Range<u32>,
    size: usize,
}

impl Chunks {
    fn new(range: Range<u32>, size: usize) -> Self {
        Self { rest: range, size }
    }
}

impl Iterator for Chunks {
    type Item = Range<u32>;

    fn next(&mut self) -> Option<Range<u32>> {
        if self.rest.is_empty() {
            return None;
        }
        let piece = self.rest.start..self.rest.end.min(self.rest.start.saturating_add(self.size as u32));
        self.rest.start = piece.end;
        Some(piece)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn chunks_cover_the_range_up_to_the_last_index() {
        let end = u32::MAX;
        let pieces: Vec<_> = Chunks::new(end - 10..end, 4).collect();
        assert_eq!(pieces, [end - 10..end - 6, end - 6..end - 2, end - 2..end]);
        assert_eq!(Chunks::new(3..3, 4).count(), 0);
    }
}
