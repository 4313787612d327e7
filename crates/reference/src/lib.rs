//! An independent double-precision tracer that the tests hold the GPU kernels against.
//!
//! [`photons`] does what `docs/photon-paths.md` says, photon by photon, and shares no code with the kernels.
//! [`camera`] is a brute-force path tracer: one estimator of the whole light transport that the renderer splits between
//! energy maps, next-event estimation and camera paths. [`light_tracing`] is its counterpart from the lights, the truth
//! for caustics of lights that no path from the eye can meet. Both have random numbers of their own, so that they agree
//! with the renderer by the physics or not at all. What surfaces and media do (`docs/materials.md`) is in [`bsdf`] and
//! [`media`].
//!
//! Everything is in metres, watts and the world frame, one value a colour channel (linear Rec. 709). Light that has met a
//! dispersive medium has one wavelength (`docs/spectra.md`), whose colours [`spectrum`] has.

pub mod bsdf;
pub mod camera;
mod estimate;
pub mod fresnel;
mod generator;
pub mod geometry;
pub mod light_tracing;
mod lights;
pub mod media;
pub mod photons;
pub mod random;
mod roulette;
pub mod snell;
pub mod spectrum;
pub mod texture;
pub mod warp;
