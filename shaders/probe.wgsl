// What camera paths would see of the energy maps by now: the maps' irradiance at the places where they met them.

import package::film::texels::{tile_at, texels_around};
import package::layout::probe_pass::{map_sightings, probe_params, probed_irradiance, sighted};
import package::layout::records::record_texel;
import package::layout::scene::NONE;

/// Irradiance at a place of a layer's plane, W/m².
fn irradiance_at(layer: u32, place: vec2<f32>) -> vec3<f32> {
    let around = texels_around(tile_at(layer, place));
    var sum = vec3<f32>(0.0);
    for (var corner = 0u; corner < 4u; corner++) {
        let texel = record_texel(probe_params.entries * around.texels[corner]);
        sum += around.weights[corner] * textureLoad(probed_irradiance, texel, 0).xyz;
    }
    return sum;
}

@compute @workgroup_size(64)
fn look_up_sightings(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) local: u32) {
    let index = group.x * 64u + local;
    if index >= probe_params.count {
        return;
    }
    let sighting = sighted[index];
    var sum = vec3<f32>(0.0);
    if sighting.layer != NONE {
        // A texel is half as wide as a pixel, so that these are spread over one.
        let place = vec2<f32>(sighting.x, sighting.y);
        for (var quarter = 0u; quarter < 4u; quarter++) {
            let offset = vec2<f32>(f32(quarter & 1u), f32(quarter >> 1u)) - 0.5;
            sum += 0.25 * irradiance_at(sighting.layer, place + offset);
        }
    }
    map_sightings[index] = vec4<f32>(sum, 0.0);
}
