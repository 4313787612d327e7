//! Russian roulette for paths that could go on for good.

use glam::DVec3;

use crate::generator::Generator;

/// Surfaces met before it begins.
const FROM: u32 = 16;
/// Surfaces after which a path is dropped: lossless light that is caught for good would never end otherwise.
const LONGEST_PATH: u32 = 10_000;

/// Whether a path goes on after its `surfaces`-th surface; what does carries the share of what does not. `kept` is what
/// is left of the path's weight, 1 at its start. That of one wavelength may have a negative channel.
pub(crate) fn survives(kept: &mut DVec3, surfaces: u32, generator: &mut Generator) -> bool {
    if *kept == DVec3::ZERO || surfaces >= LONGEST_PATH {
        return false;
    }
    if surfaces < FROM {
        return true;
    }
    let chance = kept.abs().max_element().min(1.0);
    if generator.unit() >= chance {
        return false;
    }
    *kept /= chance;
    true
}
