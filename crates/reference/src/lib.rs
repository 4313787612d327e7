//! An independent double-precision tracer that the tests hold the GPU kernels against.
//!
//! [`photons`] does what `docs/photon-paths.md` says, photon by photon, and shares no code with the kernels.
//! [`camera`] is a brute-force path tracer: one estimator of the whole light transport that the renderer splits between
//! energy maps, next-event estimation and camera paths. It has random numbers of its own, so that it agrees with the
//! renderer by the physics or not at all.
//!
//! Everything is in metres, watts and the world frame, one value a colour channel (linear Rec. 709).

pub mod camera;
pub mod fresnel;
mod generator;
pub mod geometry;
pub mod photons;
pub mod random;
pub mod snell;
pub mod specular;
pub mod warp;
