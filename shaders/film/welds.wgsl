// Texels of the maps, and the welds that some of them lie between; docs/energy-maps.md, "Welds".

import package::layout::map_passes::{map_texels, weld_parts, welded, MapTexel};
import package::layout::records::record_texel;

fn load_map_texel(index: u32) -> MapTexel {
    let texel = textureLoad(map_texels, record_texel(index), 0);
    return MapTexel(bitcast<f32>(texel.x), texel.y, texel.z, texel.w);
}

/// Entries of irradiance of a texel. A single light group is all there is; of several, all light's irradiance stands before theirs.
fn entry_count(light_groups: u32) -> u32 {
    return select(1u, 1u + light_groups, light_groups > 1u);
}

/// Irradiance of a texel and its variance: between welds, by its link, or where it has none what it is by itself.
fn between_welds(link: u32, entry: u32, entries: u32, itself: vec4<f32>) -> vec4<f32> {
    if link == 0u {
        return itself;
    }
    let count = weld_parts[link - 1u].index;
    var value = vec4<f32>(0.0);
    for (var k = 0u; k < count; k++) {
        let part = weld_parts[link + k];
        value += part.weight * welded[entries * part.index + entry];
    }
    return value;
}
