// Between the phases: fixed-point sums of flux become irradiance.

import package::film::fixed_point::wide_to_f32;
import package::layout::records::record_texel;
import package::layout::resolve_pass::{energy_sums, resolve_params, resolved_irradiance, texel_areas};

fn watts(texel: u32, channel: u32) -> f32 {
    let word = 6u * texel + 2u * channel;
    return wide_to_f32(energy_sums[word], energy_sums[word + 1u]) * resolve_params.watts_per_unit;
}

@compute @workgroup_size(64)
fn resolve_irradiance(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) local: u32) {
    let texel = (group.y * resolve_params.groups_x + group.x) * 64u + local;
    if texel >= resolve_params.texel_count {
        return;
    }
    let area = texel_areas[texel];
    var value = vec3<f32>(0.0);
    if area > 0.0 {
        value = vec3<f32>(watts(texel, 0u), watts(texel, 1u), watts(texel, 2u)) / area;
    }
    textureStore(resolved_irradiance, record_texel(texel), vec4<f32>(value, 0.0));
}
