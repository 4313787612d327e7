// What a path reads in the energy maps.

import package::film::layers::{add_to_caustic_of_group, add_to_group, add_to_layer, add_to_no_group};
import package::film::texels::{map_layer, map_place, texels_around, tile_at};
import package::geometry::differential::plane_change;
import package::geometry::traverse::Hit;
import package::layout::features::{light_group_count, notes_sightings};
import package::layout::path_pass::{irradiance, path_params, LAYER_CAUSTIC, LAYER_EMISSION, LAYER_INDIRECT};
import package::layout::records::{load_corners, record_texel};
import package::layout::scene::{MATERIAL_PHONG, NONE, Triangle, TriangleCorners};
import package::path::state::{layer_at_receiver, Path};
import package::path::vertex::Vertex;
import package::sampling::warp::PI;
import package::spectrum::wavelength::at_wavelength;

/// Where a path looks at a map's layer.
struct MapView {
    layer: u32,
    /// A place on the plane.
    place: vec2<f32>,
    /// From there to the other places: by either, and by both.
    right: vec2<f32>,
    up: vec2<f32>,
    /// Places: 1 or 4.
    count: u32,
}

/// The least cosine, beside that of the path, at which what lies beside it is seen; nearer to the horizon it is too far off.
const LEAST_COSINE: f32 = 0.5;

/// How far the place moves that a path sees of a plane, if its direction changes.
fn change_of_place(path: ptr<function, Path>, vertex: Vertex, triangle: Triangle, corners: TriangleCorners, change: vec3<f32>) -> vec2<f32> {
    let n = vertex.point.n_g;
    let cosine = dot((*path).direction, n);
    let direction = (*path).direction + change;
    let moved_cosine = min(dot(direction, n), LEAST_COSINE * cosine);
    let way = vertex.point.position - (*path).origin;
    return plane_change(triangle, corners, direction * (dot(way, n) / moved_cosine) - way);
}

/// Where a path looks from a vertex: the lens sees all of its sample's part of the pixel, as far as it shows the same plane.
fn map_view(path: ptr<function, Path>, vertex: Vertex, hit: Hit, triangle: Triangle) -> MapView {
    let layer = map_layer(triangle.object, vertex.point.front);
    let none = vec2<f32>(0.0);
    let is_first = (*path).depth == 0u && (*path).bounces == 0u && any((*path).other_up != vec3<f32>(0.0));
    let corners = load_corners(hit.triangle);
    if !is_first || corners.charts > 1u {
        return MapView(layer, map_place(hit), none, none, 1u);
    }
    let right = change_of_place(path, vertex, triangle, corners, (*path).other_right);
    let up = change_of_place(path, vertex, triangle, corners, (*path).other_up);
    return MapView(layer, map_place(hit), right, up, 4u);
}

/// Irradiance in the energy maps, W/m²: of all light's maps, entry 0, or of a light group's, its index plus 1.
fn map_irradiance(view: MapView, entry: u32) -> vec3<f32> {
    var sum = vec3<f32>(0.0);
    for (var k = 0u; k < view.count; k++) {
        let place = view.place + f32(k & 1u) * view.right + f32(k >> 1u) * view.up;
        let around = texels_around(tile_at(view.layer, place));
        let at = (1u + light_group_count) * around.texels + entry;
        let w = around.weights;
        sum += w.x * textureLoad(irradiance, record_texel(at.x), 0).xyz + w.y * textureLoad(irradiance, record_texel(at.y), 0).xyz
            + w.z * textureLoad(irradiance, record_texel(at.z), 0).xyz + w.w * textureLoad(irradiance, record_texel(at.w), 0).xyz;
    }
    return sum / f32(view.count);
}

/// Adds what the maps of each light group hold, by the share that the receiver sends on, 1/sr.
fn add_maps_of_groups(path: ptr<function, Path>, view: MapView, reflected: vec3<f32>) {
    for (var group = 0u; group < light_group_count; group++) {
        let radiance = (*path).beta * reflected * at_wavelength(map_irradiance(view, 1u + group), (*path).wavelength);
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
fn add_map(path: ptr<function, Path>, vertex: Vertex, hit: Hit, triangle: Triangle) {
    let view = map_view(path, vertex, hit, triangle);
    let caustic = map_irradiance(view, 0u);
    let reflected = at_wavelength(vertex.material.base / PI * (1.0 - vertex.gloss), (*path).wavelength);
    var sent = reflected * at_wavelength(caustic, (*path).wavelength);
    add_maps_of_groups(path, view, reflected);
    add_to_layer((*path).pixel, layer_at_receiver(path, LAYER_CAUSTIC), (*path).beta * sent);
    if vertex.kind == MATERIAL_PHONG {
        let ambient = at_wavelength(vertex.material.tint, (*path).wavelength) * at_wavelength(path_params.ambient, (*path).wavelength);
        add_to_layer((*path).pixel, LAYER_INDIRECT, (*path).beta * ambient);
        add_to_no_group((*path).pixel, (*path).beta * ambient);
        sent += ambient;
    }
    (*path).radiance += (*path).beta * sent;
    if notes_sightings {
        note_sighting(path, vertex, view.layer, view.place);
    }
}
