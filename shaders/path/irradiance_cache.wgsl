// The irradiance that bounced light brings to receivers: how camera paths measure it, and how others look it up. docs/irradiance-cache.md.

import package::film::texels::{map_layer, map_place};
import package::geometry::traverse::Hit;
import package::layout::features::{has_irradiance_cache, notes_sightings};
import package::layout::path_pass::{irradiance_cache, path_params};
import package::layout::scene::NONE;
import package::path::state::{Path, SLOT_TAIL};
import package::path::vertex::Vertex;
import package::sampling::sobol::padded_1;
import package::spectrum::wavelength::first_wavelength;

/// Bounces of a path beyond which one more changes little, so that a cached value may stand for all that follow any receiver.
const MANY_BOUNCES: u32 = 4u;

/// Irradiance by bounced light, W/m², and 1; or zeros where it is not known.
fn cached_irradiance(path: ptr<function, Path>, vertex: Vertex, hit: Hit, object: u32) -> vec4<f32> {
    let may_end = (*path).bounces < path_params.max_bounces && ((*path).bounces == 0u || path_params.max_bounces >= MANY_BOUNCES);
    if !has_irradiance_cache || !vertex.is_receiver || !may_end {
        return vec4<f32>(0.0);
    }
    let grid = irradiance_cache[map_layer(object, vertex.point.front)];
    let nodes = vec2<u32>(grid.yz);
    if nodes.x == 0u {
        return vec4<f32>(0.0);
    }
    let at = clamp(map_place(hit) * grid.w, vec2<f32>(0.0), vec2<f32>(nodes - 1u));
    let corner = min(vec2<u32>(at), nodes - 2u);
    let f = at - vec2<f32>(corner);
    let first = u32(grid.x) + corner.y * nodes.x + corner.x;
    let low = mix(irradiance_cache[first], irradiance_cache[first + 1u], f.x);
    let high = mix(irradiance_cache[first + nodes.x], irradiance_cache[first + nodes.x + 1u], f.x);
    let found = mix(low, high, f.y);
    return select(vec4<f32>(0.0), found, found.w > 0.999);
}

/// Lets a path that leaves its first receiver by the base measure what comes from there: `by_base` is the radiance in the picture for radiance 1
/// that enters the base, and `toward_wi` the share of what comes along its direction that does.
fn begin_tail(path: ptr<function, Path>, by_base: vec3<f32>, toward_wi: vec3<f32>) {
    if (*path).bounces > 0u || (*path).sighting.layer == NONE {
        return;
    }
    (*path).tail_begins = true;
    (*path).tail_factor = by_base;
    (*path).tail_beta = toward_wi;
    (*path).wavelength = first_wavelength();
    (*path).fifth_number = padded_1((*path).sample, (*path).seed, SLOT_TAIL);
    (*path).goes_on = true;
}

/// Keeps apart what the path has gathered before its tail, whose first ray met something at a distance; 0 for nothing.
fn enter_tail(path: ptr<function, Path>, inverse_distance: f32) {
    if !notes_sightings || !(*path).tail_begins {
        return;
    }
    (*path).tail_begins = false;
    (*path).sighting.inverse_distance = inverse_distance;
    (*path).before_tail = (*path).radiance;
    (*path).radiance = vec3<f32>(0.0);
    (*path).beta = (*path).tail_beta;
}

/// Completes what the path has seen.
fn end_tail(path: ptr<function, Path>) {
    if (*path).sighting.inverse_distance >= 0.0 {
        (*path).sighting.bounced = (*path).radiance;
        (*path).radiance = (*path).before_tail + (*path).tail_factor * (*path).radiance;
    }
    (*path).sighting.radiance = dot((*path).radiance, vec3<f32>(1.0 / 3.0));
}
