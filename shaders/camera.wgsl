// Phase 2: one sample of every pixel. A path follows casters and bounces between receivers; at each receiver it gathers the light it can
// see and the irradiance in the energy map. docs/materials.md defines what surfaces do.

import package::film::layers::add_to_squares;
import package::layout::camera_pass::camera_params;
import package::layout::features::notes_sightings;
import package::layout::path_pass::{film, path_params, sightings, Sighting, LAYER_EMISSION};
import package::layout::scene::NONE;
import package::path::advance::follow;
import package::path::state::Path;
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

/// The camera ray of this sample of a pixel.
fn start_path(pixel: vec2<u32>) -> Path {
    let index = pixel.y * camera_params.width + pixel.x;
    let seed = combine(path_params.seed, index);
    let numbers = sobol_5(path_params.sample_index, seed);
    let u = numbers.first;
    let size = vec2<f32>(f32(camera_params.width), f32(camera_params.height));
    let at = vec2<f32>(pixel) + 0.5 + vec2<f32>(filter_offset(u.x), filter_offset(u.y));
    let screen = 2.0 * at / size - 1.0;
    let view = path_params.forward + screen.x * camera_params.half_right - screen.y * camera_params.half_up;
    let lens = camera_params.aperture_radius * disc(u.zw);
    let on_lens = lens.x * camera_params.lens_right + lens.y * camera_params.lens_up;
    var path: Path;
    path.origin = path_params.position + on_lens;
    path.direction = normalize(camera_params.focus_distance * view - on_lens);
    path.beta = vec3<f32>(path_params.exposure);
    path.media = path_params.media;
    path.fifth_number = numbers.fifth;
    path.wavelength = first_wavelength();
    path.goes_on = true;
    path.seed = seed;
    path.pixel = index;
    path.layer = LAYER_EMISSION;
    path.sighting = Sighting(NONE, 0.0, 0.0, NONE, 0.0, 0.0, 0.0, 0.0);
    return path;
}

/// The pixel of an invocation: along a Z-order curve within its 8 × 8 tile, so that neighbouring lanes see alike.
fn pixel_of(group: vec2<u32>, local: u32) -> vec2<u32> {
    let x = (local & 1u) | ((local >> 1u) & 2u) | ((local >> 2u) & 4u);
    let y = ((local >> 1u) & 1u) | ((local >> 2u) & 2u) | ((local >> 3u) & 4u);
    return 8u * group + vec2<u32>(x, y);
}

@compute @workgroup_size(64)
fn sample_pixels(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) local: u32) {
    let pixel = pixel_of(group.xy, local);
    if pixel.x >= camera_params.width || pixel.y >= camera_params.height {
        return;
    }
    // One path a lane: starting the next sample as soon as one ends fills the lanes better, but every step then costs a start
    // too, which on software adapters is more.
    var path = start_path(pixel);
    follow(&path);
    let index = path.pixel;
    add_to_squares(index, film.pixels[index], path.radiance);
    film.pixels[index] += vec4<f32>(path.radiance, 1.0);
    if notes_sightings {
        path.sighting.radiance = dot(path.radiance, vec3<f32>(1.0 / 3.0));
        sightings[index] = path.sighting;
    }
}
