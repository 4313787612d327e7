// What a path reads in the energy maps.

import package::film::layers::{add_to_caustic_of_group, add_to_group, add_to_layer, add_to_no_group};
import package::film::texels::{footprint, map_layer, map_place, Footprint};
import package::geometry::traverse::Hit;
import package::layout::features::{light_group_count, notes_sightings};
import package::layout::path_pass::{irradiance, path_params, LAYER_CAUSTIC, LAYER_EMISSION, LAYER_INDIRECT};
import package::layout::records::record_texel;
import package::layout::scene::{MATERIAL_PHONG, NONE};
import package::path::state::{layer_at_receiver, Path};
import package::path::vertex::Vertex;
import package::sampling::warp::PI;
import package::spectrum::wavelength::at_wavelength;

/// Irradiance around a place in the energy maps, W/m²: of all light's maps, entry 0, or of a light group's, its index plus 1.
fn map_irradiance(place: Footprint, entry: u32) -> vec3<f32> {
    let at = (1u + light_group_count) * place.texels + entry;
    let w = place.weights;
    return w.x * textureLoad(irradiance, record_texel(at.x), 0).xyz + w.y * textureLoad(irradiance, record_texel(at.y), 0).xyz
        + w.z * textureLoad(irradiance, record_texel(at.z), 0).xyz + w.w * textureLoad(irradiance, record_texel(at.w), 0).xyz;
}

/// Adds what the maps of each light group hold, by the share that the receiver sends on, 1/sr.
fn add_maps_of_groups(path: ptr<function, Path>, place: Footprint, reflected: vec3<f32>) {
    for (var group = 0u; group < light_group_count; group++) {
        let radiance = (*path).beta * reflected * at_wavelength(map_irradiance(place, 1u + group), (*path).wavelength);
        add_to_group((*path).pixel, group, radiance);
        if (*path).layer == LAYER_EMISSION {
            add_to_caustic_of_group((*path).pixel, group, radiance);
        }
    }
}

/// Notes where a vertex lies on the maps: the path's first, or its last.
fn note_sighting(path: ptr<function, Path>, vertex: Vertex, layer: u32, place: vec2<f32>) {
    if (*path).sighting.layer == NONE {
        (*path).sighting.layer = layer;
        (*path).sighting.x = place.x;
        (*path).sighting.y = place.y;
        (*path).sighting.weight = dot((*path).beta * vertex.material.base * (1.0 - vertex.gloss), vec3<f32>(1.0 / (3.0 * PI)));
    } else {
        (*path).sighting.bounced_layer = layer;
        (*path).sighting.bounced_x = place.x;
        (*path).sighting.bounced_y = place.y;
    }
}

/// Adds ambient light and what the receiver's energy map holds.
fn add_map(path: ptr<function, Path>, vertex: Vertex, hit: Hit, object: u32) {
    let place = footprint(hit, object, vertex.point.front);
    let caustic = map_irradiance(place, 0u);
    let reflected = at_wavelength(vertex.material.base / PI * (1.0 - vertex.gloss), (*path).wavelength);
    var sent = reflected * at_wavelength(caustic, (*path).wavelength);
    add_maps_of_groups(path, place, reflected);
    add_to_layer((*path).pixel, layer_at_receiver(path, LAYER_CAUSTIC), (*path).beta * sent);
    if vertex.kind == MATERIAL_PHONG {
        let ambient = at_wavelength(vertex.material.tint, (*path).wavelength) * at_wavelength(path_params.ambient, (*path).wavelength);
        add_to_layer((*path).pixel, LAYER_INDIRECT, (*path).beta * ambient);
        add_to_no_group((*path).pixel, (*path).beta * ambient);
        sent += ambient;
    }
    (*path).radiance += (*path).beta * sent;
    if notes_sightings {
        note_sighting(path, vertex, map_layer(object, vertex.point.front), map_place(hit));
    }
}
