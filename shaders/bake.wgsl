// Lightmaps: one sample of every texel. A path begins at a point of the surface behind the texel, as if that were white and matt, and
// goes on as a camera path does; what it gathers is irradiance. docs/baking.md.

import package::bsdf::specular::outer_interface;
import package::geometry::traverse::Hit;
import package::layout::bake_pass::{bake_params, bake_texels, cells, BakeTexel};
import package::layout::path_pass::{film, path_params, LAYER_EMISSION};
import package::layout::records::{load_corners, load_triangle};
import package::layout::scene::{Material, Triangle, MATERIAL_DIFFUSE, MATERIAL_RECEIVER, NONE};
import package::medium::media::medium_ior;
import package::path::advance::{follow, interact};
import package::path::state::{no_sighting, Path};
import package::path::vertex::Vertex;
import package::sampling::hash::combine;
import package::sampling::sobol::{padded_2, sobol_5};
import package::spectrum::wavelength::first_wavelength;
import package::texture::surface::surface_at;

/// Slot of the padded numbers of a texel's further places.
const SLOT_PLACE: u32 = 2048u;
/// Places around a texel that are tried before the sample is given up: texels at a border hold little surface.
const PLACES: u32 = 16u;
/// How far outside a triangle, in its barycentric coordinates, a place counts as within it.
const SLACK: f32 = 1e-5;

/// A number from −1 to 1 whose density falls evenly from its middle, as a texel's weight does.
fn tent(u: f32) -> f32 {
    let v = 2.0 * u;
    return select(1.0 - sqrt(2.0 - v), sqrt(v) - 1.0, v < 1.0);
}

/// A point of the surface.
struct Place {
    hit: Hit,
    /// Texels over the area that they show, 1/m².
    texel_density: f32,
}

/// The point of the surface that lies at a place of the map; no triangle where there is none.
fn surface_at_place(at: vec2<f32>) -> Place {
    let last = vec2<f32>(f32(bake_params.width - 2u), f32(bake_params.height - 2u));
    let cell_at = vec2<u32>(clamp(floor(at), vec2<f32>(0.0), last));
    let cell = cell_at.y * (bake_params.width - 1u) + cell_at.x;
    let end = cells[cell + 1u];
    for (var entry = cells[cell]; entry < end; entry++) {
        let index = cells[entry];
        let c = load_corners(index);
        let along_1 = c.texel_01.zw - c.texel_01.xy;
        let along_2 = vec2<f32>(c.texel_x_2, c.texel_y_2) - c.texel_01.xy;
        let d = at - c.texel_01.xy;
        let area = along_1.x * along_2.y - along_1.y * along_2.x;
        let b = vec2<f32>(d.x * along_2.y - d.y * along_2.x, along_1.x * d.y - along_1.y * d.x) / area;
        if min(b.x, b.y) >= -SLACK && b.x + b.y <= 1.0 + SLACK {
            let triangle = load_triangle(index);
            let inside = clamp(b, vec2<f32>(0.0), vec2<f32>(1.0));
            let density = abs(area) / length(cross(triangle.edge_1, triangle.edge_2));
            return Place(Hit(index, 0.0, inside / max(inside.x + inside.y, 1.0)), density);
        }
    }
    return Place(Hit(NONE, 0.0, vec2<f32>(0.0)), 0.0);
}

/// A point of the surface behind a texel, drawn with the texel's weight, and what it counts for: where texels lie less densely, more of
/// the surface is behind them. No triangle where none was found.
fn draw_place(texel: BakeTexel, first: vec2<f32>, seed: u32) -> Place {
    let middle = vec2<f32>(f32(texel.column), f32(texel.row));
    let last = vec2<f32>(f32(bake_params.width - 1u), f32(bake_params.height - 1u));
    var u = first;
    var place = Place(Hit(NONE, 0.0, vec2<f32>(0.0)), 0.0);
    for (var attempt = 0u; attempt < PLACES; attempt++) {
        let at = middle + vec2<f32>(tent(u.x), tent(u.y));
        if all(at >= vec2<f32>(0.0)) && all(at <= last) {
            place = surface_at_place(at);
            if place.hit.triangle != NONE {
                break;
            }
        }
        u = padded_2(path_params.sample_index, seed, SLOT_PLACE + attempt);
    }
    return place;
}

/// The surface at `hit` seen from in front of the texel's side, white and matt.
fn white_vertex(hit: Hit, side: u32, media: vec4<u32>, ior: f32) -> Vertex {
    let triangle = load_triangle(hit.triangle);
    let outward = normalize(cross(triangle.edge_1, triangle.edge_2));
    let met = surface_at(hit, triangle, triangle.corner, select(outward, -outward, side == 0u));
    var white: Material;
    white.base = vec3<f32>(1.0);
    white.kind = MATERIAL_DIFFUSE | MATERIAL_RECEIVER;
    white.ior = 1.0;
    white.tint = vec3<f32>(1.0);
    return Vertex(
        met.point, white, MATERIAL_DIFFUSE, false, true, outer_interface(white, ior), media, vec3<f32>(0.0), 0.0, 0u, 0.0,
    );
}

@compute @workgroup_size(64)
fn sample_texels(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) local: u32) {
    let index = 64u * (group.y * bake_params.groups_x + group.x) + local;
    if index >= bake_params.texel_count {
        return;
    }
    let texel = bake_texels[index];
    let seed = combine(path_params.seed, bake_params.first_texel + index);
    let numbers = sobol_5(path_params.sample_index, seed);
    let place = draw_place(texel, numbers.first.xy, seed);
    if place.hit.triangle == NONE {
        return;
    }
    let weight = bake_params.texel_density / place.texel_density;
    var path: Path;
    path.media = texel.media;
    path.wavelength = first_wavelength();
    path.fifth_number = numbers.fifth;
    path.seed = seed;
    path.sample = path_params.sample_index;
    path.pixel = index;
    path.layer = LAYER_EMISSION;
    path.sighting = no_sighting();
    let vertex = white_vertex(place.hit, texel.side, path.media, medium_ior(path.media, path.wavelength));
    path.direction = -vertex.point.n_g;
    // What reflects all light sends 1/π of its irradiance along each direction.
    path.beta = vec3<f32>(path_params.exposure * weight);
    interact(&path, vertex, place.hit, load_triangle(place.hit.triangle));
    follow(&path);
    film.pixels[index] += vec4<f32>(path.radiance, weight);
}
