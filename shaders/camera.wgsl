// Phase 2: one sample of every pixel. A path follows casters and bounces between receivers; at each receiver it gathers the light it can
// see and the irradiance in the energy map. docs/materials.md defines what surfaces do.

import package::film::layers::add_to_squares;
import package::layout::camera_pass::{camera_params, halves, tiles};
import package::layout::features::{has_halves, has_textures, notes_sightings};
import package::layout::path_pass::{film, path_params, sightings, LAYER_EMISSION};
import package::layout::records::record_texel;
import package::path::advance::follow;
import package::path::irradiance_cache::end_tail;
import package::path::state::{no_sighting, Path};
import package::sampling::hash::combine;
import package::sampling::sobol::sobol_5;
import package::sampling::warp::{disc, PI};
import package::spectrum::wavelength::first_wavelength;

/// Offset from the pixel's centre, drawn with the filter's density. Steps of the table are even in the angle whose cosine is
/// 1 − 2u, which puts most where the filter's tails are.
fn filter_offset(u: f32) -> f32 {
    let at = acos(1.0 - 2.0 * u) * (63.0 / PI);
    let k = min(u32(at), 62u);
    let low = camera_params.filter_inverse_cdf[k >> 2u][k & 3u];
    let high = camera_params.filter_inverse_cdf[(k + 1u) >> 2u][(k + 1u) & 3u];
    return mix(low, high, at - f32(k));
}

/// Samples of a pixel that look at the energy maps in four places each.
const WIDE_SAMPLES: u32 = 8u;

/// A number in the other half of its cell, of so many cells in [0, 1).
fn in_other_half(u: f32, cells: f32) -> f32 {
    let half = 0.5 / cells;
    return select(u - half, u + half, (u32(u / half) & 1u) == 0u);
}

/// Where else a path looks at the energy maps: samples 2ᵏ to 2ᵏ⁺¹ − 1 of a pixel have a cell of it each, and see the four quarters of that.
fn spread_over_cell(path: ptr<function, Path>, u: vec2<f32>, offset: vec2<f32>, length: f32) {
    let splits = firstLeadingBit(max((*path).sample, 1u));
    let cells = vec2<f32>(f32(1u << ((splits + 1u) / 2u)), f32(1u << (splits / 2u)));
    let other = vec2<f32>(filter_offset(in_other_half(u.x, cells.x)), filter_offset(in_other_half(u.y, cells.y))) - offset;
    let scale = 2.0 * other / vec2<f32>(f32(camera_params.width), f32(camera_params.height)) * camera_params.focus_distance / length;
    (*path).other_right = scale.x * camera_params.half_right;
    (*path).other_up = -scale.y * camera_params.half_up;
}

/// The camera ray of this sample of a pixel.
fn start_path(pixel: vec2<u32>) -> Path {
    let index = pixel.y * camera_params.width + pixel.x;
    var seed = combine(path_params.seed, index);
    var sample = u32(film.pixels[index].w);
    if notes_sightings {
        // Neighbours divide what they see among them.
        let block = pixel >> vec2<u32>(2u);
        seed = combine(path_params.seed, block.y * camera_params.width + block.x);
        sample = 16u * sample + interleave(pixel & vec2<u32>(3u));
    }
    let numbers = sobol_5(sample, seed);
    let u = numbers.first;
    let size = vec2<f32>(f32(camera_params.width), f32(camera_params.height));
    let offset = vec2<f32>(filter_offset(u.x), filter_offset(u.y));
    let at = vec2<f32>(pixel) + 0.5 + offset;
    let screen = 2.0 * at / size - 1.0;
    let view = path_params.forward + screen.x * camera_params.half_right - screen.y * camera_params.half_up;
    let lens = camera_params.aperture_radius * disc(u.zw);
    let on_lens = lens.x * camera_params.lens_right + lens.y * camera_params.lens_up;
    var path: Path;
    path.origin = path_params.position + on_lens;
    let toward = camera_params.focus_distance * view - on_lens;
    path.direction = normalize(toward);
    path.beta = vec3<f32>(path_params.exposure);
    path.media = path_params.media;
    path.fifth_number = numbers.fifth;
    path.wavelength = first_wavelength();
    path.goes_on = true;
    path.seed = seed;
    path.sample = sample;
    path.pixel = index;
    path.layer = LAYER_EMISSION;
    path.sighting = no_sighting();
    // Where surfaces show pictures, the product of light and picture is what counts.
    if !notes_sightings && !has_textures && sample < WIDE_SAMPLES {
        spread_over_cell(&path, u.xy, offset, length(toward));
    }
    return path;
}

/// The tile of a workgroup.
fn tile_of(group: vec2<u32>, groups_x: u32) -> vec2<u32> {
    if camera_params.tile_count == 0u {
        return group;
    }
    let place = group.y * groups_x + group.x;
    if place >= camera_params.tile_count {
        return vec2<u32>(camera_params.width, camera_params.height);
    }
    let listed = textureLoad(tiles, record_texel(place >> 2u), 0)[place & 3u];
    return vec2<u32>(listed & 0xffffu, listed >> 16u);
}

/// The place of a point of 4 × 4 along a Z-order curve.
fn interleave(at: vec2<u32>) -> u32 {
    return (at.x & 1u) | ((at.y & 1u) << 1u) | ((at.x & 2u) << 1u) | ((at.y & 2u) << 2u);
}

/// The pixel of an invocation: along a Z-order curve within its tile of 8 × 8, so that neighbouring lanes see alike.
fn pixel_of(tile: vec2<u32>, local: u32) -> vec2<u32> {
    let x = (local & 1u) | ((local >> 1u) & 2u) | ((local >> 2u) & 4u);
    let y = ((local >> 1u) & 1u) | ((local >> 2u) & 2u) | ((local >> 3u) & 4u);
    return 8u * tile + vec2<u32>(x, y);
}

@compute @workgroup_size(64)
fn sample_pixels(
    @builtin(workgroup_id) group: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>, @builtin(local_invocation_index) local: u32,
) {
    let pixel = pixel_of(tile_of(group.xy, groups.x), local);
    if pixel.x >= camera_params.width || pixel.y >= camera_params.height {
        return;
    }
    // One path a lane: starting the next sample as soon as one ends fills the lanes better, but every step then costs a start
    // too, which on software adapters is more.
    var path = start_path(pixel);
    let rays = follow(&path);
    if notes_sightings {
        end_tail(&path);
    }
    let index = path.pixel;
    add_to_squares(index, film.pixels[index], path.radiance);
    if has_halves {
        // Whole powers of two of the sequence's points are spread evenly.
        let is_half = (path.sample & (path.sample - 1u)) == 0u;
        halves[index] = vec4<f32>(select(halves[index].xyz, film.pixels[index].xyz, is_half), halves[index].w + f32(rays));
    }
    film.pixels[index] += vec4<f32>(path.radiance, 1.0);
    if notes_sightings {
        sightings[index] = path.sighting;
    }
}
