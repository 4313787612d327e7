//! A brute-force path tracer: an unbiased estimate of all the light that reaches the camera or a point.
//!
//! Paths run from the eye. At every diffuse vertex the lights in plain sight are sampled (next-event estimation, which
//! casters block), and one more ray goes on, drawn from the cosine; what that ray finds is counted but for a light met
//! at once, which next-event estimation owns. A light met through casters counts: that is how caustics are found, by
//! chance. Radiance takes the factor η² at each refraction.
//!
//! The camera and the points stand in the open, outside every dielectric.
//!
//! On flat meshes photons and paths estimate the same light exactly. Interpolated normals are not reciprocal where they
//! give way to the flat ones (silhouettes), and can catch light inside for good; both go away with finer meshes.

mod direct;
mod estimate;
mod irradiance;
mod lens;
mod path;

use crate::geometry::World;

pub use self::estimate::Estimate;
pub use self::irradiance::{Irradiance, irradiance_at};

/// Radiance of the pixel in column x and row y from the top left, W/(m² sr), the mean over the pixel's square (box
/// filter) and the lens, from this number of independent samples.
///
/// `max_bounces` is the number of diffuse vertices that light may meet after the first one (seen from the eye): at 0
/// there is emission, direct light and caustics on what is seen, but no light from one diffuse surface to another, nor
/// from the background to one. [`u32::MAX`] is no limit.
///
/// # Panics
/// If there are fewer than 2 samples.
pub fn radiance(world: &World, x: u32, y: u32, samples: u32, max_bounces: u32, seed: u64) -> Estimate {
    let view = lens::View::new(world.scene());
    let words = [seed, u64::from(x), u64::from(y)];
    let [estimate] = estimate::mean(samples, &words, |generator| {
        let ray = view.ray(x, y, generator);
        [path::radiance_along(world, ray, max_bounces, generator)]
    });
    estimate
}
