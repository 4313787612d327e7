// Homogeneous absorption.

import package::layout::records::load_absorption;
import package::layout::scene::NONE;

/// Transmittance over a distance in a medium, named by its material; 1 where there is none (Beer–Lambert).
fn transmittance(medium: u32, distance: f32) -> vec3<f32> {
    if medium == NONE {
        return vec3<f32>(1.0);
    }
    return exp(-load_absorption(medium) * distance);
}
