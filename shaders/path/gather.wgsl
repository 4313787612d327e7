// The light that a surface sends along a path: its own, and one light's by next-event estimation.

import package::bsdf::base::base_bsdf;
import package::bsdf::specular::evaluate_specular;
import package::emitter::illumination::{choose_light, illuminate, FAR};
import package::geometry::surface::leave;
import package::layout::features::{has_light_layers, light_group_count};
import package::layout::path_pass::{path_params, LAYER_DIRECT, LAYER_EMISSION};
import package::layout::records::load_light_group;
import package::layout::scene::MATERIAL_GROUP_SHIFT;
import package::medium::media::transmittance;
import package::path::state::{add_light, layer_at_receiver, Path, SLOT_VERTEX};
import package::path::vertex::Vertex;
import package::sampling::sobol::{padded_1, padded_2};
import package::spectrum::wavelength::at_wavelength;

/// The share of the distance to a light that a shadow ray covers.
const SHADOW_RAY_LENGTH: f32 = 0.9999;

/// Adds what the surface itself shines, but for what next-event estimation has counted.
fn add_emission(path: ptr<function, Path>, vertex: Vertex, t: f32) {
    let emission = at_wavelength(vertex.material.emission, (*path).wavelength);
    let cos_light = -dot((*path).direction, vertex.point.n_g);
    let light_pdf = vertex.material.emission_pdf_area * t * t / max(cos_light, 1e-6);
    let pdf = (*path).lobe_pdf;
    let weight = select(1.0, pdf / (pdf + light_pdf), pdf > 0.0);
    let counts = vertex.point.front && !(*path).lights_counted;
    let group = vertex.material.kind >> MATERIAL_GROUP_SHIFT;
    add_light(path, group, select(vec3<f32>(0.0), (*path).beta * emission * weight, counts));
}

/// Turns one light's point into a shadow ray, with what it brings by the base and by a rough specular lobe.
fn gather_light(path: ptr<function, Path>, vertex: Vertex) {
    let slot = SLOT_VERTEX + 8u * (*path).gathered;
    (*path).gathered += 1u;
    let point = vertex.point;
    let u_light = padded_1(path_params.sample_index, (*path).seed, slot);
    let u = padded_2(path_params.sample_index, (*path).seed, slot + 1u);
    let index = choose_light(path_params.light_count, u_light);
    let light = illuminate(index, point.position, u);
    let wi = light.direction;
    let wo = -(*path).direction;
    let cos_light = dot(wi, point.n_s);
    let side = dot(wi, point.n_g);
    let transmitted = side < 0.0;
    var reflected = vec3<f32>(0.0);
    if vertex.is_receiver && cos_light > 0.0 && side > 0.0 {
        reflected = base_bsdf(vertex.material, wi, wo, point.n_s, vertex.sides) * (1.0 - vertex.gloss) * cos_light;
    }
    // Light that casters send on after a receiver belongs to that receiver's map.
    let lobe_counts = !(vertex.is_caster && (*path).lights_counted) && (cos_light < 0.0) == transmitted;
    let lobe = evaluate_specular(vertex.material, wo, wi, point.n_s, vertex.sides);
    let lobe_pdf = lobe.pdf * vertex.specular_chance;
    // A path that ends here leaves all of the light to this ray.
    let goes_on = vertex.is_caster || (*path).bounces < path_params.max_bounces;
    let weight = select(1.0, light.pdf / (light.pdf + lobe_pdf), light.pdf > 0.0 && goes_on);
    let by_lobe = select(vec3<f32>(0.0), lobe.value * weight, lobe_counts);
    reflected += by_lobe;
    var media = (*path).media;
    if transmitted {
        media = vertex.beyond;
    }
    let wavelength = (*path).wavelength;
    let arriving = at_wavelength(light.arriving, wavelength) * transmittance(media, light.distance, wavelength);
    let brought = (*path).beta * at_wavelength(reflected, wavelength) * arriving;
    if any(brought != vec3<f32>(0.0)) {
        (*path).shadow_pending = true;
        (*path).shadow_origin = leave(point, wi);
        (*path).shadow_direction = wi;
        // The ray leaves the surface some way off the point that the distance is from.
        let length = SHADOW_RAY_LENGTH * light.distance - distance((*path).shadow_origin, point.position);
        (*path).shadow_length = select(length, FAR, light.distance >= FAR);
        (*path).unblocked = brought;
        if has_light_layers {
            // The gloss of a receiver that is no caster counts with its base.
            let is_emission = vertex.is_caster && (*path).layer == LAYER_EMISSION;
            let emission = (*path).beta * at_wavelength(by_lobe, wavelength) * arriving;
            (*path).unblocked_emission = select(vec3<f32>(0.0), emission, is_emission);
            (*path).shadow_layer = layer_at_receiver(path, LAYER_DIRECT);
        }
        if light_group_count > 0u {
            (*path).shadow_group = load_light_group(index);
        }
    }
}
