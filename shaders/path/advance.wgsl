// A path's way through the scene, step by step.

import package::emitter::illumination::FAR;
import package::emitter::sphere::{nearest_sphere, SphereHit};
import package::film::layers::{add_to_group, add_to_layer};
import package::geometry::surface::leave;
import package::geometry::traverse::{trace, Hit};
import package::layout::features::{has_data_layers, has_light_layers, light_group_count};
import package::layout::path_pass::{film, path_params, LAYER_EMISSION};
import package::layout::records::load_triangle;
import package::layout::scene::{MATERIAL_DIELECTRIC, NONE, Triangle};
import package::medium::media::transmittance;
import package::path::end::{meet_sky, meet_sphere};
import package::path::energy_map::add_map;
import package::path::first_surface::keep_first_vertex;
import package::path::gather::{add_emission, gather_light};
import package::path::go_on::go_on;
import package::path::irradiance_cache::{cached_irradiance, enter_tail};
import package::path::state::{pass_caster, Path};
import package::path::vertex::{vertex_at, Vertex};

/// Lets a path gather the light of a vertex at `hit`, and go on from it.
fn interact(path: ptr<function, Path>, vertex: Vertex, hit: Hit, triangle: Triangle) {
    add_emission(path, vertex, hit.t);
    if vertex.is_receiver {
        add_map(path, vertex, hit, triangle);
    }
    let gathers = vertex.is_receiver || vertex.material.gloss > 0.0;
    if gathers && path_params.light_count > 0u {
        gather_light(path, vertex);
    } else if gathers {
        (*path).gathered += 1u;
    }
    go_on(path, vertex, cached_irradiance(path, vertex, hit, triangle.object));
}

/// Lets a path meet the triangle at `hit`.
fn meet_surface(path: ptr<function, Path>, hit: Hit) {
    let triangle = load_triangle(hit.triangle);
    let vertex = vertex_at(path, hit, triangle);
    if vertex.kind == MATERIAL_DIELECTRIC && vertex.beyond.x == (*path).media.x {
        // A boundary within something of higher rank does not exist, but it blocks shadow rays.
        (*path).media = vertex.beyond;
        (*path).origin = leave(vertex.point, (*path).direction);
        (*path).lobe_pdf = 0.0;
        pass_caster(path);
        (*path).goes_on = (*path).depth < path_params.max_depth;
        return;
    }
    if has_data_layers {
        keep_first_vertex(path, vertex, triangle);
    }
    interact(path, vertex, hit, triangle);
}

/// Traces the path's shadow ray, then the ray along which it goes on, and lets it meet what is there.
fn advance(path: ptr<function, Path>, rays: ptr<function, u32>) {
    var hit = Hit(NONE, FAR, vec2<f32>(0.0));
    var sphere = SphereHit(0u, FAR);
    // Both legs by one call, for calls are inlined; a path without shadow ray takes its only leg beside the first of others.
    var leg = select(1u, 0u, (*path).shadow_pending);
    let legs = select(1u, 2u, (*path).goes_on);
    for (; leg < legs; leg++) {
        let is_shadow_ray = leg == 0u;
        let origin = select((*path).origin, (*path).shadow_origin, is_shadow_ray);
        let direction = select((*path).direction, (*path).shadow_direction, is_shadow_ray);
        let length = select(FAR, (*path).shadow_length, is_shadow_ray);
        sphere = nearest_sphere(path_params.sphere_count, origin, direction, length);
        hit = trace(origin, direction, sphere.t, is_shadow_ray);
        *rays += 1u;
        let visible = is_shadow_ray && hit.triangle == NONE && sphere.t >= length;
        (*path).radiance += select(vec3<f32>(0.0), (*path).unblocked, visible);
        if has_light_layers && visible {
            add_to_layer((*path).pixel, LAYER_EMISSION, (*path).unblocked_emission);
            add_to_layer((*path).pixel, (*path).shadow_layer, (*path).unblocked - (*path).unblocked_emission);
        }
        if light_group_count > 0u && visible {
            add_to_group((*path).pixel, (*path).shadow_group, (*path).unblocked);
        }
    }
    (*path).shadow_pending = false;
    if !(*path).goes_on {
        return;
    }
    let distance = min(hit.t, sphere.t);
    enter_tail(path, select(0.0, 1.0 / max(distance, 1e-6), distance < FAR));
    if hit.triangle != NONE {
        (*path).beta *= transmittance((*path).media, hit.t, (*path).wavelength);
        meet_surface(path, hit);
    } else if sphere.t < FAR {
        meet_sphere(path, sphere);
    } else {
        meet_sky(path);
    }
}

/// Follows a path to its end, counts its rays and returns their number.
fn follow(path: ptr<function, Path>) -> u32 {
    var rays = 0u;
    var finished = false;
    loop {
        if !(*path).shadow_pending && !(*path).goes_on {
            finished = true;
            break;
        }
        advance(path, &rays);
    }
    if !finished {
        atomicAdd(&film.unfinished, 1u);
    }
    if atomicAdd(&film.rays_low, rays) > 0xffffffffu - rays {
        atomicAdd(&film.rays_high, 1u);
    }
    return rays;
}
