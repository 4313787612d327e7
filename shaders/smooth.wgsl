// Irradiance is smoothed where the surroundings of texels differ by no more than the noise of their photons: one step of an edge-avoiding filter
// "with holes" (Dammertz et al. 2010), whose kernel doubles from step to step. Texels exchange flux in pairs. docs/energy-maps.md, "Filter". In scenes
// with dispersion that do not ask for it, only hues are mixed: "Hues" there.

import package::film::texels::tile_at;
import package::film::welds::{between_welds, load_map_texel};
import package::layout::features::{light_group_count, mixes_hues};
import package::layout::map_passes::{texel_irradiance, welded, welds, MapTexel};
import package::layout::records::{load_map_layer, record_texel};
import package::layout::scene::NONE;
import package::layout::smooth_pass::{map_tiles, rough_irradiance, smooth_params};

/// How much the squared difference of two texels' guides may exceed the sum of the texels' variances for 1/e of the exchange. Half of what single
/// photons make of texels goes on the way to the guides.
const TOLERANCE: f32 = 6.0;
/// Luminance of linear Rec. 709.
const LUMINANCE: vec3<f32> = vec3<f32>(0.2126, 0.7152, 0.0722);
/// Weight of a texel itself in its guide.
const OWN_KERNEL: f32 = 0.25;
/// A difference of places, in cells, that is rounding.
const SAME_PLACE: f32 = 0.01;

/// What a texel, or a place near one, holds.
struct Neighbour {
    /// Guide and variance of all light.
    guide: vec4<f32>,
    /// Irradiance and variance of the entry that is smoothed.
    own: vec4<f32>,
    /// Area, m²; 0 if it is not of the texel's chart.
    area: f32,
}

/// What a texel of some area holds. Without guides it is its own: that of all light.
fn held(texel: u32, entry: u32, area: f32) -> Neighbour {
    let first = (1u + light_group_count) * texel;
    let own = textureLoad(rough_irradiance, record_texel(first + entry), 0);
    let has_guides = !mixes_hues && smooth_params.makes_guide == 0u && smooth_params.first_guide > 0u;
    if !has_guides && light_group_count == 0u {
        return Neighbour(own, own, area);
    }
    let guides = select(0u, smooth_params.first_guide, has_guides);
    let guide = textureLoad(rough_irradiance, record_texel(guides + first), 0);
    if light_group_count == 0u {
        return Neighbour(guide, vec4<f32>(own.xyz, guide.w), area);
    }
    if !has_guides {
        return Neighbour(guide, own, area);
    }
    return Neighbour(guide, vec4<f32>(own.xyz, textureLoad(rough_irradiance, record_texel(guides + first + entry), 0).w), area);
}

/// What a neighbour holds.
fn texel_neighbour(texel: u32, chart: u32, entry: u32) -> Neighbour {
    let record = load_map_texel(texel);
    return held(texel, entry, select(0.0, record.area, record.chart == chart));
}

/// What a place of the plane beyond the tile holds: a texel, or what lies between texels.
fn place_neighbour(layer_index: u32, place: vec2<f32>, chart: u32, entry: u32) -> Neighbour {
    var sum = Neighbour(vec4<f32>(0.0), vec4<f32>(0.0), 0.0);
    let layer = load_map_layer(layer_index);
    let at_square = place * vec2<f32>(layer.scale_x, layer.scale_y);
    let squares = vec2<f32>(f32(layer.squares & 0xffffu), f32(layer.squares >> 16u));
    if any(at_square < vec2<f32>(0.0)) || any(at_square > squares) {
        return sum;
    }
    let tile = tile_at(layer_index, place);
    let rounded = round(tile.at);
    let at = select(tile.at, rounded, abs(tile.at - rounded) < vec2<f32>(SAME_PLACE));
    let cell = min(floor(at), vec2<f32>(tile.cells) - 1.0);
    let f = at - cell;
    for (var corner = 0u; corner < 4u; corner++) {
        let offset = vec2<u32>(corner & 1u, corner >> 1u);
        let weights = select(1.0 - f, f, offset == vec2<u32>(1u));
        let weight = weights.x * weights.y;
        if weight > 0.0 {
            let step = vec2<u32>(cell) + offset;
            let one = texel_neighbour(tile.first_texel + step.y * (tile.cells.x + 1u) + step.x, chart, entry);
            if one.area <= 0.0 {
                return Neighbour(vec4<f32>(0.0), vec4<f32>(0.0), 0.0);
            }
            sum.guide += weight * one.guide;
            sum.own += weight * one.own;
            sum.area += weight * one.area;
        }
    }
    return sum;
}

/// What a texel gains from its neighbours, and what is around it.
struct Exchange {
    change: vec3<f32>,
    /// Of what it gains.
    variance: f32,
    /// Share that the texel gives away.
    given: f32,
    /// Sums over the neighbours there are: of kernel weights, and by these of areas, of flux, and of variances for an area of 1 m².
    kernel: f32,
    area: f32,
    flux: vec3<f32>,
    around: f32,
}

/// The kernel's weight at neighbour k of nine: a side or a corner.
fn kernel_at(k: u32) -> f32 {
    return select(0.0625, 0.125, (k & 1u) == 1u);
}

/// Adds the exchange of a texel with neighbour k of nine, row by row: as much flux as the other gives this one, for each weighs by the smaller
/// area of the two.
fn exchange_with(exchange: ptr<function, Exchange>, k: u32, texel: Neighbour, other: Neighbour) {
    let difference = other.guide.xyz - texel.guide.xyz;
    let noise = max(TOLERANCE * (texel.guide.w + other.guide.w), 1e-37);
    let kernel = kernel_at(k);
    let bounded = kernel * min(other.area / texel.area, 1.0);
    let weight = bounded * exp(-dot(difference, difference) / (3.0 * noise));
    (*exchange).change += weight * (other.own.xyz - texel.own.xyz);
    (*exchange).variance += weight * weight * other.own.w;
    (*exchange).given += weight;
    (*exchange).kernel += kernel;
    (*exchange).area += kernel * other.area;
    (*exchange).flux += kernel * other.area * other.own.xyz;
    (*exchange).around += kernel * other.own.w * other.area;
}

/// Adds an exchange of hue: either gives as much as the other takes, by the smaller flux of luminance, and keeps its luminance. Light groups exchange
/// by that of all light, so that they still sum to it.
fn exchange_hue_with(exchange: ptr<function, Exchange>, k: u32, texel: Neighbour, other: Neighbour) {
    let own = dot(texel.guide.xyz, LUMINANCE);
    let others = dot(other.guide.xyz, LUMINANCE);
    if own <= 0.0 || others <= 0.0 {
        return;
    }
    let kernel = kernel_at(k);
    let weight = kernel * min(others * other.area / (own * texel.area), 1.0);
    (*exchange).change += weight * (other.own.xyz * (own / others) - texel.own.xyz);
}

/// Adds what neighbour k changes.
fn meet(exchange: ptr<function, Exchange>, k: u32, texel: Neighbour, other: Neighbour) {
    if mixes_hues {
        exchange_hue_with(exchange, k, texel, other);
    } else {
        exchange_with(exchange, k, texel, other);
    }
}

/// A texel's guide: what is on and around it. Few photons say little of a texel's variance, so that is the mean around it too.
fn guide_of(texel: Neighbour, exchange: Exchange) -> vec4<f32> {
    let own = OWN_KERNEL * texel.area;
    let mean = (own * texel.own.xyz + exchange.flux) / (own + exchange.area);
    return vec4<f32>(mean, (own * texel.own.w + exchange.around) / (OWN_KERNEL + exchange.kernel) / texel.area);
}

/// A texel's irradiance and variance after a step, or its guide for one.
fn smoothed(index: u32, record: MapTexel, entry: u32) -> vec4<f32> {
    let texel = held(index, entry, record.area);
    if record.chart == 0u || record.chart == NONE || record.area <= 0.0 {
        return texel.own;
    }
    let tile = map_tiles[record.tile];
    let columns = tile.columns + 1u;
    let within = index - tile.first_texel;
    let row = within / columns;
    let here = vec2<i32>(vec2<u32>(within - row * columns, row));
    let last = vec2<i32>(vec2<u32>(tile.columns, tile.rows));
    var exchange: Exchange;
    // Neighbours beyond the tile come in a second loop: software adapters pay for both sides of a branch.
    var beyond = 0u;
    for (var k = 0u; k < 9u; k++) {
        let at = here + smooth_params.distance * (vec2<i32>(vec2<u32>(k % 3u, k / 3u)) - 1);
        if any(at < vec2<i32>(0)) || any(at > last) {
            beyond |= 1u << k;
            continue;
        }
        let other = texel_neighbour(tile.first_texel + u32(at.y) * columns + u32(at.x), record.chart, entry);
        if k != 4u && other.area > 0.0 {
            meet(&exchange, k, texel, other);
        }
    }
    while beyond != 0u {
        let k = firstTrailingBit(beyond);
        beyond &= beyond - 1u;
        let at = here + smooth_params.distance * (vec2<i32>(vec2<u32>(k % 3u, k / 3u)) - 1);
        let place = vec2<f32>(tile.origin_x, tile.origin_y) + vec2<f32>(at) * vec2<f32>(tile.cell_x, tile.cell_y);
        let other = place_neighbour(tile.layer, place, record.chart, entry);
        if other.area > 0.0 {
            meet(&exchange, k, texel, other);
        }
    }
    if mixes_hues {
        return vec4<f32>(texel.own.xyz + exchange.change, texel.own.w);
    }
    if smooth_params.makes_guide != 0u {
        return guide_of(texel, exchange);
    }
    let kept = 1.0 - exchange.given;
    let variance = kept * kept * texel.own.w + exchange.variance;
    return vec4<f32>(texel.own.xyz + exchange.change, smooth_params.variance_factor * variance);
}

@compute @workgroup_size(64)
fn smooth_maps(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) local: u32) {
    let index = (group.y * smooth_params.groups_x + group.x) * 64u + local;
    if index >= smooth_params.count {
        return;
    }
    let is_weld = smooth_params.of_welds != 0u;
    var texel = index;
    if is_weld {
        texel = welds[index].owner;
    }
    let record = load_map_texel(texel);
    let entries = 1u + light_group_count;
    for (var entry = 0u; entry < entries; entry++) {
        let value = smoothed(texel, record, entry);
        if is_weld {
            welded[entries * index + entry] = value;
        } else {
            let own = entries * index + entry;
            let shown = between_welds(record.link, entry, entries, value);
            if smooth_params.makes_guide == 0u {
                textureStore(texel_irradiance, record_texel(own), shown);
            } else {
                // The step reads both in one texture.
                textureStore(texel_irradiance, record_texel(own), textureLoad(rough_irradiance, record_texel(own), 0));
                textureStore(texel_irradiance, record_texel(smooth_params.first_guide + own), shown);
            }
        }
    }
}
