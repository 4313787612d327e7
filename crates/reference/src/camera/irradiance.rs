//! Irradiance at a point, split as the renderer splits it.

use std::f64::consts::PI;

use glam::DVec3;

use crate::estimate::{self, Estimate};
use crate::generator::Generator;
use crate::geometry::{Departure, Ray, World};
use crate::warp;

use super::direct::{self, Vertex};
use super::path;

/// How far off its surface a point is moved, in the world's epsilons: points come rounded to single precision.
const LIFT: f64 = 1e4;

/// What the lights send to a surface point, W/m².
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Irradiance {
    /// Straight from the lights: what next-event estimation owns.
    pub direct: Estimate,
    /// Through or off casters alone: what energy maps own. Delta lights (points, spots, parallel light) are in it by way
    /// of rough casters alone; [`light_tracing`](crate::light_tracing) has them by way of all.
    pub via_casters: Estimate,
}

/// Irradiance from the lights, which emissive surfaces and the environment are among, at a point of a receiver, on the
/// side of the unit normal, from this number of independent samples. Light that another receiver has scattered is left
/// out, and so is the constant background.
///
/// # Panics
/// If there are fewer than 2 samples.
pub fn irradiance_at(world: &World, point: DVec3, normal: DVec3, samples: u32, seed: u64) -> Irradiance {
    let origin = point + LIFT * world.epsilon() * normal;
    let media = world.media_around(origin.as_vec3());
    let vertex =
        Vertex { point: origin, departure: Departure::Open, normal, media: [media; 2], spectrum: world.spectrum() };
    let words = [seed, origin.x.to_bits(), origin.y.to_bits(), origin.z.to_bits()];
    let cosine = |wi: DVec3| DVec3::splat(wi.dot(normal).max(0.0));
    let [direct, via_casters] = estimate::mean(samples, &words, |generator: &mut Generator| {
        let direct = direct::gather(world, &vertex, cosine, generator);
        let direction = warp::cosine_hemisphere(normal, generator.unit(), generator.unit());
        [direct, PI * path::light_via_casters(world, Ray { origin, direction }, media, generator)]
    });
    Irradiance { direct, via_casters }
}
