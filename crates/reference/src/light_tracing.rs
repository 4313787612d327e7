//! Brute-force tracing from the lights: unbiased irradiance, lights without extent included, on a rectangle.
//!
//! It is independent of photon numbers, aim discs and energy maps: light leaves evenly over the whole light, or over
//! what leads through one sphere, passes casters by chance, and is counted where it first meets a receiver. This is the
//! truth for caustics of points, spots and parallel light, which no path from the eye can meet.

mod emission;
mod flight;
mod region;

use diacaustic_scene::Light;
use glam::DVec3;
use rayon::prelude::*;

use crate::estimate::Estimate;
use crate::generator::Generator;
use crate::geometry::{Sphere, World};

pub use self::region::Region;

use self::emission::Source;
use self::flight::Landing;

/// Photons that share one stream of random numbers.
const CHUNK: u32 = 16_384;

/// Irradiance on the bins of a region, W/m²: row by row, the columns along `edge_u`.
///
/// It is that on a surface of the receiver's shading normal; with a gloss, what enters the base.
#[derive(Clone, Debug, PartialEq)]
pub struct Lighting {
    /// Straight from the lights.
    pub direct: Vec<Estimate>,
    /// Through or off casters.
    pub via_casters: Vec<Estimate>,
}

/// What all lights of the scene send to the receivers in a region, without light that another receiver has scattered
/// and without the constant background. Objects that shine are one more light, after those of the scene.
///
/// With `through`, the light alone that leaves toward a sphere counts: on a line that meets it. The result does not
/// depend on the number of threads.
///
/// # Panics
/// If there are fewer than 2 photons a light.
pub fn irradiance_on(
    world: &World,
    region: &Region,
    through: Option<&Sphere>,
    photons_per_light: u32,
    seed: u64,
) -> Lighting {
    assert!(photons_per_light >= 2, "a variance takes at least 2 photons, not {photons_per_light}");
    let lit = |(_, light): &(usize, &Light)| !light.kind.is_dark();
    let lights = world.scene().lights.iter().enumerate().filter(lit).map(|(light, _)| Source::Light(light));
    let sources = lights.chain((!world.emissive().is_empty()).then_some(Source::Surfaces));
    let mut bins = vec![[Estimate { mean: DVec3::ZERO, variance: DVec3::ZERO }; 2]; region.bins()];
    for (index, source) in sources.enumerate() {
        let sums = trace(world, region, source, through, photons_per_light, [seed, index as u64]);
        for (bin, sums) in bins.iter_mut().zip(&sums) {
            for (estimate, sum) in bin.iter_mut().zip(sums) {
                let one = sum.estimate(photons_per_light, region.bin_area());
                estimate.mean += one.mean;
                estimate.variance += one.variance;
            }
        }
    }
    Lighting { direct: bins.iter().map(|b| b[0]).collect(), via_casters: bins.iter().map(|b| b[1]).collect() }
}

/// Flux that fell on a bin, W times the number of photons, and its squares.
#[derive(Clone, Copy, Default)]
struct Sum {
    flux: DVec3,
    squares: DVec3,
}

impl Sum {
    fn estimate(&self, photons: u32, area: f64) -> Estimate {
        let count = f64::from(photons);
        let mean = self.flux / count;
        let variance = (self.squares / count - mean * mean).max(DVec3::ZERO) / (count - 1.0);
        Estimate { mean: mean / area, variance: variance / (area * area) }
    }
}

/// For each bin, what came straight and what came by casters.
fn trace(
    world: &World,
    region: &Region,
    source: Source,
    through: Option<&Sphere>,
    photons: u32,
    [seed, index]: [u64; 2],
) -> Vec<[Sum; 2]> {
    let trace_chunk = |chunk: u32| -> Vec<(usize, Landing)> {
        let mut generator = Generator::new(&[seed, index, u64::from(chunk)]);
        (0..CHUNK.min(photons - chunk * CHUNK))
            .filter_map(|_| {
                let start = emission::emit(world, source, through, &mut generator)?;
                let landing = flight::fly(world, start, &mut generator)?;
                Some((region.bin_of(landing.point, landing.direction)?, landing))
            })
            .collect()
    };
    let landed: Vec<_> = (0..photons.div_ceil(CHUNK)).into_par_iter().map(trace_chunk).collect();
    let mut sums = vec![[Sum::default(); 2]; region.bins()];
    for (bin, landing) in landed.into_iter().flatten() {
        let sum = &mut sums[bin][usize::from(landing.has_met_caster)];
        sum.flux += landing.flux;
        sum.squares += landing.flux * landing.flux;
    }
    sums
}
