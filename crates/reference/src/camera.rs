//! A brute-force path tracer: an unbiased estimate of the light that reaches the camera or a point.
//!
//! Paths run from the eye. At every diffuse vertex all lights in plain sight are sampled (next-event estimation, which
//! casters block), the gloss of a receiver included, and one more ray goes on, drawn from a lobe; what that ray finds is
//! counted but for a light met at once, which next-event estimation owns. A light met through casters counts: that is
//! how caustics are found, by chance. Radiance takes the factor η² at each refraction.
//!
//! *Delta lights* (points, spots, parallel light) cannot be met. Besides receivers, rough casters sample them; their
//! light through smooth casters alone is missing here, and [`light_tracing`](crate::light_tracing) has it.
//!
//! The camera and points may stand within dielectrics ([`Scene::media_at`](diacaustic_scene::Scene::media_at)).
//!
//! A path takes a wavelength at the first dispersive boundary (`docs/spectra.md`). In a dispersive medium around the
//! camera, the index that divides its radiance is then that at this wavelength.
//!
//! On flat meshes photons and paths estimate the same light exactly. Interpolated normals are not reciprocal where they
//! give way to the flat ones (silhouettes), and can catch light inside for good; both go away with finer meshes.

mod direct;
mod irradiance;
mod lens;
mod path;
mod receiver;

use crate::estimate;
use crate::geometry::World;

pub use self::irradiance::{Irradiance, irradiance_at};
pub use crate::estimate::Estimate;

/// What the pixel in column x and row y from the top left shows: radiance over the square of the index of refraction
/// around the camera, W/(m² sr), the mean over the pixel's square (box filter) and the lens, from this number of
/// independent samples.
///
/// `max_bounces` is the number of diffuse vertices that light may meet after the first one (seen from the eye): at 0
/// there is emission, direct light and caustics on what is seen, but no light from one diffuse surface to another, nor
/// from the background to one. [`u32::MAX`] is no limit.
///
/// # Panics
/// If there are fewer than 2 samples.
pub fn radiance(world: &World, x: u32, y: u32, samples: u32, max_bounces: u32, seed: u64) -> Estimate {
    let view = lens::View::new(world.scene());
    let media = world.media_around(world.scene().camera.position);
    let shown = world.dielectrics().ior(&media, &world.spectrum()).powi(-2);
    let words = [seed, u64::from(x), u64::from(y)];
    let [estimate] = estimate::mean(samples, &words, |generator| {
        let ray = view.ray(x, y, generator);
        [shown * path::radiance_along(world, ray, media, max_bounces, generator)]
    });
    estimate
}
