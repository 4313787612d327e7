// Between the phases: fixed-point sums of flux become irradiance. First that of welds, then that of texels, some of which lie between welds.

import package::film::fixed_point::{wide_sum, wide_to_f32};
import package::film::welds::{between_welds, entry_count, load_map_texel};
import package::layout::map_passes::{texel_irradiance, weld_parts, welded, welds, MapTexel, MapWeld, MapWeldPart};
import package::layout::records::record_texel;
import package::layout::resolve_pass::{energy_high_words, energy_low_words, resolve_params};

/// Photons add the square of a sixteenth of their units to the fourth sum.
const SQUARE_UNITS: f32 = 256.0;

/// A sum, low and high word.
fn energy_sum(group: u32, texel: u32, channel: u32) -> vec2<u32> {
    let word = resolve_params.sums * (group * resolve_params.group_texels + texel) + channel;
    return vec2<u32>(energy_low_words[word], energy_high_words[word]);
}

/// Flux on a texel, W, and its variance, W²: of all light, entry 0, or of a light group, its index plus 1.
fn texel_flux(texel: u32, entry: u32) -> vec4<f32> {
    let groups = resolve_params.light_groups;
    let first = select(entry - 1u, 0u, entry == 0u);
    let end = select(entry, groups, entry == 0u);
    var total = array<vec2<u32>, 4>();
    for (var group = first; group < end; group++) {
        for (var channel = 0u; channel < resolve_params.sums; channel++) {
            total[channel] = wide_sum(total[channel], energy_sum(group, texel, channel));
        }
    }
    let watts = resolve_params.watts_per_unit;
    return vec4<f32>(
        wide_to_f32(total[0].x, total[0].y) * watts, wide_to_f32(total[1].x, total[1].y) * watts,
        wide_to_f32(total[2].x, total[2].y) * watts, wide_to_f32(total[3].x, total[3].y) * watts * SQUARE_UNITS * watts,
    );
}

/// What flux over an area is.
fn over_area(flux: vec4<f32>, area: f32) -> vec4<f32> {
    if area > 0.0 {
        return vec4<f32>(flux.xyz / area, flux.w / area / area);
    }
    return vec4<f32>(0.0);
}

@compute @workgroup_size(64)
fn resolve_irradiance(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) local: u32) {
    let index = (group.y * resolve_params.groups_x + group.x) * 64u + local;
    if index >= resolve_params.count {
        return;
    }
    let is_weld = resolve_params.of_welds != 0u;
    let entries = entry_count(resolve_params.light_groups);
    var texel: MapTexel;
    var weld = MapWeld(0u, 0u, 1u, 0.0);
    if is_weld {
        weld = welds[index];
    } else {
        texel = load_map_texel(index);
        weld.area = texel.area;
    }
    for (var entry = 0u; entry < entries; entry++) {
        var flux = vec4<f32>(0.0);
        for (var k = 0u; k < weld.part_count; k++) {
            var part = MapWeldPart(index, 1.0);
            if is_weld {
                part = weld_parts[weld.first_part + k];
            }
            flux += vec4<f32>(vec3<f32>(part.weight), part.weight * part.weight) * texel_flux(part.index, entry);
        }
        let value = over_area(flux, weld.area);
        if is_weld {
            welded[entries * index + entry] = value;
        } else {
            textureStore(texel_irradiance, record_texel(entries * index + entry), between_welds(texel.link, entry, entries, value));
        }
    }
}
