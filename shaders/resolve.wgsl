// Between the phases: fixed-point sums of flux become irradiance.

import package::film::fixed_point::{wide_sum, wide_to_f32};
import package::layout::records::record_texel;
import package::layout::resolve_pass::{energy_high_words, energy_low_words, resolve_params, resolved_irradiance, texel_areas};

/// A sum of flux, low and high word.
fn energy_sum(group: u32, texel: u32, channel: u32) -> vec2<u32> {
    let word = 3u * (group * resolve_params.group_texels + texel) + channel;
    return vec2<u32>(energy_low_words[word], energy_high_words[word]);
}

/// Stores the irradiance that follows from sums of flux.
fn store(place: u32, sums: array<vec2<u32>, 3>, area: f32) {
    var value = vec3<f32>(0.0);
    if area > 0.0 {
        let watts = resolve_params.watts_per_unit;
        value = vec3<f32>(
            wide_to_f32(sums[0].x, sums[0].y) * watts, wide_to_f32(sums[1].x, sums[1].y) * watts,
            wide_to_f32(sums[2].x, sums[2].y) * watts,
        ) / area;
    }
    textureStore(resolved_irradiance, record_texel(place), vec4<f32>(value, 0.0));
}

@compute @workgroup_size(64)
fn resolve_irradiance(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) local: u32) {
    let texel = (group.y * resolve_params.groups_x + group.x) * 64u + local;
    if texel >= resolve_params.texel_count {
        return;
    }
    let area = texel_areas[texel];
    let groups = resolve_params.light_groups;
    // A single group is all there is; of several, all light's irradiance stands before theirs.
    let entries = select(1u, 1u + groups, groups > 1u);
    var total = array<vec2<u32>, 3>();
    for (var light_group = 0u; light_group < groups; light_group++) {
        let sums = array<vec2<u32>, 3>(
            energy_sum(light_group, texel, 0u), energy_sum(light_group, texel, 1u), energy_sum(light_group, texel, 2u),
        );
        for (var channel = 0u; channel < 3u; channel++) {
            total[channel] = wide_sum(total[channel], sums[channel]);
        }
        if groups > 1u {
            store(entries * texel + 1u + light_group, sums, area);
        }
    }
    store(entries * texel, total, area);
}
