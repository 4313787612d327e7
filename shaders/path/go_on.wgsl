// How a path goes on from a surface.

import package::bsdf::base::gloss_reflectance;
import package::bsdf::specular::{evaluate_specular, scatter_specular};
import package::film::layers::add_to_layer;
import package::geometry::surface::leave;
import package::layout::features::{has_irradiance_cache, notes_sightings, paper_refraction, PAPER_NONE};
import package::layout::path_pass::{path_params, LAYER_DIRECT, LAYER_INDIRECT};
import package::layout::scene::{MATERIAL_DIELECTRIC, MATERIAL_MIRROR};
import package::path::irradiance_cache::begin_tail;
import package::path::state::{layer_at_receiver, pass_caster, Path, SLOT_MICROFACET, SLOT_VERTEX};
import package::path::vertex::Vertex;
import package::sampling::sobol::{padded_1, padded_2};
import package::sampling::warp::{cosine_hemisphere, PI};
import package::spectrum::wavelength::at_wavelength;

/// Receivers that a path meets before roulette may end it.
const BOUNCES_BEFORE_ROULETTE: u32 = 3u;

/// Sends the path on through the specular lobe.
fn go_on_specular(path: ptr<function, Path>, vertex: Vertex, u: f32, choice: u32) {
    let d = (*path).direction;
    let point = vertex.point;
    let v = padded_2((*path).sample, (*path).seed, SLOT_MICROFACET + 2u * choice);
    let event = scatter_specular(vertex.material, d, point.n_g, point.n_s, vertex.sides, u, v);
    (*path).beta *= at_wavelength(event.weight, (*path).wavelength) / vertex.specular_chance;
    if event.transmitted {
        if vertex.kind == MATERIAL_DIELECTRIC && paper_refraction == PAPER_NONE {
            // Radiance is squeezed into a narrower cone in a denser medium: L/n² is what stays.
            (*path).beta *= vertex.sides.eta * vertex.sides.eta;
        }
        (*path).media = vertex.beyond;
    }
    (*path).lobe_pdf = evaluate_specular(vertex.material, -d, event.direction, point.n_s, vertex.sides).pdf * vertex.specular_chance;
    // A receiver's own gloss takes what it meets; only a caster's belongs to the map of a receiver before it.
    (*path).lights_counted = (*path).lights_counted && vertex.is_caster;
    (*path).origin = leave(point, event.direction);
    (*path).direction = event.direction;
    (*path).goes_on = any((*path).beta != vec3<f32>(0.0));
}

/// Sends the path on from the base, in proportion to the cosine, or ends it where what bounced light brings is known.
fn go_on_diffuse(path: ptr<function, Path>, vertex: Vertex, cached: vec4<f32>) {
    let by_base = (*path).beta * at_wavelength(vertex.material.base * (1.0 - vertex.gloss), (*path).wavelength) / (1.0 - vertex.specular_chance);
    if has_irradiance_cache && cached.w > 0.0 {
        let brought = by_base / PI * at_wavelength(cached.xyz, (*path).wavelength);
        (*path).radiance += brought;
        add_to_layer((*path).pixel, LAYER_INDIRECT, brought);
        return;
    }
    let slot = SLOT_VERTEX + 8u * ((*path).gathered - 1u);
    let point = vertex.point;
    let u = padded_2((*path).sample, (*path).seed, slot + 3u);
    let wi = cosine_hemisphere(point.n_s, u);
    let toward_wi = 1.0 - gloss_reflectance(vertex.material, dot(wi, point.n_s), vertex.sides);
    let reflected = vertex.material.base * (1.0 - vertex.gloss) * toward_wi;
    (*path).beta *= at_wavelength(reflected, (*path).wavelength) / (1.0 - vertex.specular_chance);
    (*path).lobe_pdf = 0.0;
    (*path).lights_counted = true;
    (*path).origin = leave(point, wi);
    (*path).direction = wi;
    (*path).goes_on = any((*path).beta != vec3<f32>(0.0));
    if notes_sightings {
        begin_tail(path, by_base, toward_wi);
    }
    (*path).goes_on = (*path).goes_on && dot(wi, point.n_g) > 0.0;
}

/// Ends the path by chance in proportion to what it can still bring.
fn play_roulette(path: ptr<function, Path>) {
    let beta = abs((*path).beta);
    let chance = min(max(beta.x, max(beta.y, beta.z)) / path_params.exposure, 1.0);
    let slot = SLOT_VERTEX + 8u * ((*path).gathered - 1u);
    if padded_1((*path).sample, (*path).seed, slot + 5u) < chance {
        (*path).beta /= chance;
    } else {
        (*path).goes_on = false;
    }
}

/// Sends a path on from a vertex through one of its lobes, or lets it end; `cached` is the irradiance there by bounced light, if it is known.
fn go_on(path: ptr<function, Path>, vertex: Vertex, cached: vec4<f32>) {
    (*path).goes_on = false;
    if !vertex.is_caster && !vertex.is_receiver {
        return;
    }
    var u = vertex.u;
    (*path).choices += select(0u, 1u, vertex.kind != MATERIAL_MIRROR);
    let takes_specular = u < vertex.specular_chance;
    if takes_specular && vertex.is_receiver {
        // What chose the lobe chooses nothing more.
        u = 0.0;
    }
    if takes_specular {
        go_on_specular(path, vertex, u, vertex.choice);
    } else {
        go_on_diffuse(path, vertex, cached);
    }
    if takes_specular && vertex.is_caster {
        pass_caster(path);
        (*path).goes_on = (*path).goes_on && (*path).depth < path_params.max_depth;
    } else {
        // Lights in the gloss of the first receiver are the part of its direct light that next-event estimation leaves.
        (*path).layer = select(LAYER_INDIRECT, layer_at_receiver(path, LAYER_DIRECT), takes_specular);
        (*path).bounces += 1u;
        (*path).goes_on = (*path).goes_on && (*path).bounces <= path_params.max_bounces;
        if (*path).bounces > BOUNCES_BEFORE_ROULETTE {
            play_roulette(path);
        }
    }
}
