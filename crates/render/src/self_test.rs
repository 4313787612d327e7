//! What the adapter does with long loops.

use diacaustic_scene::RenderSettings;
use diacaustic_shaders::LOOP_CHECK;

use crate::{
    Error,
    gpu::{Binding, Gpu, Purpose},
};

/// Iterations that the self-test asks for.
const ASKED: u32 = 200_000;
/// Iterations that one invocation of the kernels may need: a photon's whole path through a large scene.
const NEEDED: u32 = 16_384;
/// Photons that an invocation takes one after the other on an adapter without a limit.
const PHOTONS_PER_INVOCATION: u32 = 16;
/// Iterations to allow for each ray on an adapter with a limit: nodes and triangles met, with room for lanes that wait.
const ITERATIONS_PER_RAY: u32 = 128;

/// Iterations over the texels of the largest footprint, twice.
const ITERATIONS_PER_FOOTPRINT: u32 = 2 * 25 * 25;

const COUNTS: Purpose = Purpose { what: "the self-test's counters", remedy: "use another adapter" };

/// How long loops may be on a device.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LoopLimit {
    /// Iterations after which the adapter ends a loop without an error; none if it does not.
    pub iterations: Option<u32>,
}

impl LoopLimit {
    /// No limit, for a device that runs nothing.
    pub(crate) const NONE: Self = Self { iterations: None };

    /// Runs a long loop and counts. Blocks.
    pub(crate) fn measure(gpu: &Gpu) -> Result<Self, Error> {
        let buffer = gpu.filled(COUNTS, &[ASKED, 0])?;
        let layout = gpu.layout("loop check", wgpu::ShaderStages::COMPUTE, &[Binding::ReadWrite]);
        let pipeline = gpu.compute_pipeline(LOOP_CHECK, &[&layout]);
        gpu.dispatch(&pipeline, &[&gpu.bind(&layout, &[&buffer])], [1, 1]);
        let ran = gpu.read::<u32>(&buffer, 1..2)?[0];
        if ran < NEEDED {
            return Err(Error::LoopsTooShort { limit: ran, needed: NEEDED });
        }
        Ok(Self { iterations: (ran < ASKED).then_some(ran) })
    }

    /// Photons that an invocation may take one after the other.
    pub(crate) fn photons_per_invocation(self, settings: &RenderSettings) -> u32 {
        let of_footprint = if settings.footprints { ITERATIONS_PER_FOOTPRINT } else { 0 };
        let of_photon = ITERATIONS_PER_RAY.saturating_mul(settings.max_depth).saturating_add(of_footprint);
        self.iterations.map_or(PHOTONS_PER_INVOCATION, |limit| (limit / of_photon).clamp(1, PHOTONS_PER_INVOCATION))
    }
}
