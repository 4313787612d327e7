// Phase 2: one sample of every pixel. A path follows casters and bounces between receivers; at each receiver it gathers the light it can
// see and the irradiance in the energy map. docs/materials.md defines what surfaces do.

import package::bsdf::albedo::albedo;
import package::bsdf::base::{base_bsdf, gloss_reflectance};
import package::bsdf::dispersion::split_colors;
import package::bsdf::specular::{evaluate_specular, outer_interface, scatter_specular, Interface};
import package::emitter::illumination::{choose_light, illuminate, FAR};
import package::emitter::sky::{light_probability, sky_light_radiance, sky_radiance};
import package::emitter::sphere::{nearest_sphere, SphereHit};
import package::film::layers::{
    add_to_caustic_of_group, add_to_data_layers, add_to_group, add_to_layer, add_to_no_group, add_to_squares,
};
import package::film::texels::{footprint, map_layer, map_place, Footprint};
import package::geometry::surface::{leave, SurfacePoint};
import package::geometry::traverse::{trace, Hit};
import package::layout::camera_pass::{
    camera_params, data_layers, film, irradiance, sightings, Sighting, LAYER_CAUSTIC, LAYER_DIRECT, LAYER_EMISSION, LAYER_INDIRECT,
};
import package::layout::features::{
    has_data_layers, has_dispersion, has_distant_lights, has_light_layers, light_group_count, notes_sightings,
};
import package::layout::records::{load_light, load_light_group, load_triangle, record_texel};
import package::layout::scene::{
    Material, Triangle, MATERIAL_CASTER, MATERIAL_DIELECTRIC, MATERIAL_GROUP_SHIFT, MATERIAL_KIND_BITS, MATERIAL_MIRROR, MATERIAL_PHONG,
    MATERIAL_RECEIVER, NONE,
};
import package::medium::media::{is_dispersive, media_beyond, medium_ior, transmittance};
import package::sampling::hash::combine;
import package::sampling::sobol::{padded_1, padded_2, sobol_5};
import package::sampling::warp::{cone_height, cosine_hemisphere, disc, PI};
import package::spectrum::wavelength::{at_wavelength, draw_wavelength, first_wavelength, Wavelength};
import package::texture::surface::surface_at;

/// First slot of the padded numbers for microfacet normals; choices have those below.
const SLOT_MICROFACET: u32 = 4096u;
/// First slot of the padded numbers of vertices that gather light, eight each.
const SLOT_VERTEX: u32 = 8192u;
/// The least probability with which a path takes the gloss over a base.
const LEAST_GLOSS_CHANCE: f32 = 0.25;
/// Receivers that a path meets before roulette may end it.
const BOUNCES_BEFORE_ROULETTE: u32 = 3u;
/// The share of the distance to a light that a shadow ray covers.
const SHADOW_RAY_LENGTH: f32 = 0.9999;

/// A path from the lens into the scene.
struct Path {
    origin: vec3<f32>,
    direction: vec3<f32>,
    /// Radiance that arrives in the picture for radiance 1 along the ray.
    beta: vec3<f32>,
    /// Radiance gathered, W/(m² sr).
    radiance: vec3<f32>,
    /// The media that the ray is in.
    media: vec4<u32>,
    /// Casters met.
    depth: u32,
    /// Receivers met.
    bounces: u32,
    /// Vertices that have gathered light.
    gathered: u32,
    /// Choices between lobes made.
    choices: u32,
    /// The number of the first choice, in scenes with dispersion that of the wavelength.
    fifth_number: f32,
    wavelength: Wavelength,
    /// Density with which the last surface drew the direction, 1/sr, where next-event estimation could have found the same light; 0 where not.
    lobe_pdf: f32,
    /// Whether what lights send along the ray, straight or through casters, is already counted: by next-event estimation or the map of
    /// the last receiver.
    lights_counted: bool,
    /// Whether the path goes on along its ray.
    goes_on: bool,
    /// A light's visibility to ask for before: unit direction, distance, and what it brings if nothing blocks it.
    shadow_pending: bool,
    shadow_origin: vec3<f32>,
    shadow_direction: vec3<f32>,
    shadow_length: f32,
    unblocked: vec3<f32>,
    /// Of this, what the first casters on the path send to the camera; the layer of the rest.
    unblocked_emission: vec3<f32>,
    shadow_layer: u32,
    /// The light's group.
    shadow_group: u32,
    /// The pixel, row by row from the top left.
    pixel: u32,
    /// The layer of light that the path meets.
    layer: u32,
    /// Whether the path has met a surface that is kept in the layers.
    has_first_surface: bool,
    /// Seed of the pixel's random numbers.
    seed: u32,
    /// What it has seen of the energy maps, but for the radiance.
    sighting: Sighting,
}

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
    let seed = combine(camera_params.seed, index);
    let numbers = sobol_5(camera_params.sample_index, seed);
    let u = numbers.first;
    let size = vec2<f32>(f32(camera_params.width), f32(camera_params.height));
    let at = vec2<f32>(pixel) + 0.5 + vec2<f32>(filter_offset(u.x), filter_offset(u.y));
    let screen = 2.0 * at / size - 1.0;
    let view = camera_params.forward + screen.x * camera_params.half_right - screen.y * camera_params.half_up;
    let lens = camera_params.aperture_radius * disc(u.zw);
    let on_lens = lens.x * camera_params.lens_right + lens.y * camera_params.lens_up;
    var path: Path;
    path.origin = camera_params.position + on_lens;
    path.direction = normalize(camera_params.focus_distance * view - on_lens);
    path.beta = vec3<f32>(camera_params.exposure);
    path.media = camera_params.media;
    path.fifth_number = numbers.fifth;
    path.wavelength = first_wavelength();
    path.goes_on = true;
    path.seed = seed;
    path.pixel = index;
    path.layer = LAYER_EMISSION;
    path.sighting = Sighting(NONE, 0.0, 0.0, NONE, 0.0, 0.0, 0.0, 0.0);
    return path;
}

/// Gives a path one wavelength.
fn take_wavelength(path: ptr<function, Path>) {
    let drawn = draw_wavelength((*path).fifth_number);
    (*path).wavelength = drawn.wavelength;
    // The exposure has divided by the square of the stated index where the camera stands.
    let stated = medium_ior(camera_params.media, Wavelength(-1.0, vec3<f32>(0.0)));
    let index = stated / medium_ior(camera_params.media, drawn.wavelength);
    (*path).beta = at_wavelength((*path).beta, drawn.wavelength) * drawn.weight * (index * index);
}

/// A surface that a path has met.
struct Vertex {
    point: SurfacePoint,
    material: Material,
    kind: u32,
    is_caster: bool,
    is_receiver: bool,
    /// The indices on the two sides.
    sides: Interface,
    /// The media beyond, for light that is transmitted.
    beyond: vec4<u32>,
    /// Reflectance of the gloss over a receiver's base, seen along the path; 0 without either.
    gloss: vec3<f32>,
    /// The number of the choice between lobes, and its place among the path's choices.
    u: f32,
    choice: u32,
    /// Probability with which the path takes the specular lobe.
    specular_chance: f32,
}

/// The surface at `hit`. Its media say whether a boundary exists at all: where `beyond` begins with the same medium, it does not.
fn vertex_at(path: ptr<function, Path>, hit: Hit, triangle: Triangle) -> Vertex {
    let met = surface_at(hit, triangle, (*path).direction);
    let material = met.material;
    let point = met.point;
    let media = (*path).media;
    let kind = material.kind & MATERIAL_KIND_BITS;
    var beyond = media;
    let choice = (*path).choices;
    var u = padded_1(camera_params.sample_index, (*path).seed, choice);
    u = select(u, (*path).fifth_number, choice == 0u && !has_dispersion);
    if kind == MATERIAL_DIELECTRIC {
        beyond = media_beyond(media, material.medium, point.front);
        let exists = beyond.x != media.x;
        if exists && (*path).wavelength.number < 0.0 && (is_dispersive(media) || is_dispersive(beyond)) {
            let cos_i = -dot((*path).direction, point.n_s);
            let split = split_colors(media, beyond, cos_i, material.gloss <= 0.0, u, (*path).fifth_number);
            (*path).fifth_number = split.xi;
            if split.takes_wavelength {
                take_wavelength(path);
            }
            u = split.u;
            (*path).beta *= at_wavelength(split.factor, (*path).wavelength);
        }
    }
    let ior = medium_ior(media, (*path).wavelength);
    var vertex = Vertex(
        point, material, kind, (material.kind & MATERIAL_CASTER) != 0u, (material.kind & MATERIAL_RECEIVER) != 0u,
        outer_interface(material, ior), beyond, vec3<f32>(0.0), u, choice, 1.0,
    );
    if kind == MATERIAL_DIELECTRIC {
        vertex.sides = Interface(ior, ior / medium_ior(beyond, (*path).wavelength));
    }
    if vertex.is_receiver {
        vertex.gloss = gloss_reflectance(material, -dot((*path).direction, point.n_s), vertex.sides);
        let mean = (vertex.gloss.x + vertex.gloss.y + vertex.gloss.z) / 3.0;
        // A weak gloss may reflect what is bright, so it is looked at more often than its share. A black base is not worth a choice.
        let chance = select(0.0, max(mean, LEAST_GLOSS_CHANCE), mean > 0.0);
        vertex.specular_chance = select(1.0, chance, any(material.base > vec3<f32>(0.0)));
    }
    return vertex;
}

/// Adds radiance that a path meets, of lights of a group.
fn add_light(path: ptr<function, Path>, group: u32, radiance: vec3<f32>) {
    (*path).radiance += radiance;
    add_to_layer((*path).pixel, (*path).layer, radiance);
    add_to_group((*path).pixel, group, radiance);
}

/// The layer of what the path gathers at a receiver: `first` at the first one.
fn layer_at_receiver(path: ptr<function, Path>, first: u32) -> u32 {
    return select(LAYER_INDIRECT, first, (*path).layer == LAYER_EMISSION);
}

/// Lets a path pass a caster: what it meets beyond is seen through casters, or came by more than a receiver.
fn pass_caster(path: ptr<function, Path>) {
    (*path).layer = layer_at_receiver(path, LAYER_EMISSION);
    (*path).depth += 1u;
}

/// Keeps the first surface that a path meets.
fn keep_first_surface(path: ptr<function, Path>, position: vec3<f32>, normal: vec3<f32>, albedo: vec3<f32>) {
    let depth = dot(position - camera_params.position, camera_params.forward);
    add_to_data_layers((*path).pixel, position, depth, normal, albedo);
    (*path).has_first_surface = true;
}

/// Keeps a vertex, if it is the path's first, and of the pixel's first sample what it is of.
fn keep_first_vertex(path: ptr<function, Path>, vertex: Vertex, triangle: Triangle) {
    if (*path).has_first_surface {
        return;
    }
    let cosine = -dot((*path).direction, vertex.point.n_s);
    keep_first_surface(path, vertex.point.position, vertex.point.n_s, albedo(vertex.material, cosine, vertex.sides));
    if camera_params.sample_index == 0u {
        data_layers[(*path).pixel].object = triangle.object + 1u;
        data_layers[(*path).pixel].material = triangle.material + 1u;
    }
}

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

/// Adds ambient light and what the receiver's energy map holds.
fn add_map(path: ptr<function, Path>, vertex: Vertex, hit: Hit, object: u32) {
    let place = footprint(hit, object, vertex.point.front);
    let caustic = map_irradiance(place, 0u);
    let reflected = at_wavelength(vertex.material.base / PI * (1.0 - vertex.gloss), (*path).wavelength);
    var sent = reflected * at_wavelength(caustic, (*path).wavelength);
    add_maps_of_groups(path, place, reflected);
    add_to_layer((*path).pixel, layer_at_receiver(path, LAYER_CAUSTIC), (*path).beta * sent);
    if vertex.kind == MATERIAL_PHONG {
        let ambient = at_wavelength(vertex.material.tint, (*path).wavelength) * at_wavelength(camera_params.ambient, (*path).wavelength);
        add_to_layer((*path).pixel, LAYER_INDIRECT, (*path).beta * ambient);
        add_to_no_group((*path).pixel, (*path).beta * ambient);
        sent += ambient;
    }
    (*path).radiance += (*path).beta * sent;
    if notes_sightings {
        note_sighting(path, vertex, map_layer(object, vertex.point.front), map_place(hit));
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

/// Turns one light's point into a shadow ray, with what it brings by the base and by a rough specular lobe.
fn gather_light(path: ptr<function, Path>, vertex: Vertex) {
    let slot = SLOT_VERTEX + 8u * (*path).gathered;
    (*path).gathered += 1u;
    let point = vertex.point;
    let u_light = padded_1(camera_params.sample_index, (*path).seed, slot);
    let u = padded_2(camera_params.sample_index, (*path).seed, slot + 1u);
    let index = choose_light(camera_params.light_count, u_light);
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
    let goes_on = vertex.is_caster || (*path).bounces < camera_params.max_bounces;
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

/// Sends the path on through the specular lobe.
fn go_on_specular(path: ptr<function, Path>, vertex: Vertex, u: f32, choice: u32) {
    let d = (*path).direction;
    let point = vertex.point;
    let v = padded_2(camera_params.sample_index, (*path).seed, SLOT_MICROFACET + 2u * choice);
    let event = scatter_specular(vertex.material, d, point.n_g, point.n_s, vertex.sides, u, v);
    (*path).beta *= at_wavelength(event.weight, (*path).wavelength) / vertex.specular_chance;
    if event.transmitted {
        if vertex.kind == MATERIAL_DIELECTRIC {
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

/// Sends the path on from the base, in proportion to the cosine.
fn go_on_diffuse(path: ptr<function, Path>, vertex: Vertex) {
    let slot = SLOT_VERTEX + 8u * ((*path).gathered - 1u);
    let point = vertex.point;
    let u = padded_2(camera_params.sample_index, (*path).seed, slot + 3u);
    let wi = cosine_hemisphere(point.n_s, u);
    let toward_wi = 1.0 - gloss_reflectance(vertex.material, dot(wi, point.n_s), vertex.sides);
    let reflected = vertex.material.base * (1.0 - vertex.gloss) * toward_wi;
    (*path).beta *= at_wavelength(reflected, (*path).wavelength) / (1.0 - vertex.specular_chance);
    (*path).lobe_pdf = 0.0;
    (*path).lights_counted = true;
    (*path).origin = leave(point, wi);
    (*path).direction = wi;
    (*path).goes_on = dot(wi, point.n_g) > 0.0 && any((*path).beta != vec3<f32>(0.0));
}

/// Ends the path by chance in proportion to what it can still bring.
fn play_roulette(path: ptr<function, Path>) {
    let beta = abs((*path).beta);
    let chance = min(max(beta.x, max(beta.y, beta.z)) / camera_params.exposure, 1.0);
    let slot = SLOT_VERTEX + 8u * ((*path).gathered - 1u);
    if padded_1(camera_params.sample_index, (*path).seed, slot + 5u) < chance {
        (*path).beta /= chance;
    } else {
        (*path).goes_on = false;
    }
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
        (*path).goes_on = (*path).depth < camera_params.max_depth;
        return;
    }
    if has_data_layers {
        keep_first_vertex(path, vertex, triangle);
    }
    add_emission(path, vertex, hit.t);
    if vertex.is_receiver {
        add_map(path, vertex, hit, triangle.object);
    }
    let gathers = vertex.is_receiver || vertex.material.gloss > 0.0;
    if gathers && camera_params.light_count > 0u {
        gather_light(path, vertex);
    } else if gathers {
        (*path).gathered += 1u;
    }
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
        go_on_diffuse(path, vertex);
    }
    if takes_specular && vertex.is_caster {
        pass_caster(path);
        (*path).goes_on = (*path).goes_on && (*path).depth < camera_params.max_depth;
    } else {
        // Lights in the gloss of the first receiver are the part of its direct light that next-event estimation leaves.
        (*path).layer = select(LAYER_INDIRECT, layer_at_receiver(path, LAYER_DIRECT), takes_specular);
        (*path).bounces += 1u;
        (*path).goes_on = (*path).goes_on && (*path).bounces <= camera_params.max_bounces;
        if (*path).bounces > BOUNCES_BEFORE_ROULETTE {
            play_roulette(path);
        }
    }
}

/// Lets a path end on a sphere that shines.
fn meet_sphere(path: ptr<function, Path>, sphere: SphereHit) {
    (*path).goes_on = false;
    let light = load_light(sphere.light);
    let solid_angle = 2.0 * PI * cone_height(light.extent / distance((*path).origin, light.position));
    let pdf = (*path).lobe_pdf;
    let weight = select(1.0, pdf / (pdf + light_probability(sphere.light) / solid_angle), pdf > 0.0);
    let strength = at_wavelength(light.strength, (*path).wavelength);
    let seen = (*path).beta * transmittance((*path).media, sphere.t, (*path).wavelength) * strength * weight;
    add_light(path, load_light_group(sphere.light), select(seen, vec3<f32>(0.0), (*path).lights_counted));
    if has_data_layers && !(*path).has_first_surface {
        let position = (*path).origin + sphere.t * (*path).direction;
        keep_first_surface(path, position, normalize(position - light.position), vec3<f32>(0.0));
    }
}

/// Adds what lights that are infinitely far send to their groups.
fn add_sky_of_groups(path: ptr<function, Path>) {
    let end = select(0u, camera_params.light_count, light_group_count > 0u && has_distant_lights);
    for (var i = camera_params.first_sky_light; i < end; i++) {
        let radiance = sky_light_radiance(i, (*path).direction, (*path).lobe_pdf);
        add_to_group((*path).pixel, load_light_group(i), (*path).beta * at_wavelength(radiance, (*path).wavelength));
    }
}

/// Lets a path leave the scene.
fn meet_sky(path: ptr<function, Path>) {
    (*path).goes_on = false;
    var beyond = camera_params.background;
    var sky = vec3<f32>(0.0);
    if !(*path).lights_counted {
        sky = sky_radiance(camera_params.first_sky_light, camera_params.light_count, (*path).direction, (*path).lobe_pdf);
        beyond += sky;
        add_sky_of_groups(path);
    }
    (*path).radiance += (*path).beta * at_wavelength(beyond, (*path).wavelength);
    add_to_no_group((*path).pixel, (*path).beta * at_wavelength(camera_params.background, (*path).wavelength));
    if has_light_layers {
        // Next-event estimation knows nothing of the background, which lights receivers as what bounces does.
        let of_background = layer_at_receiver(path, LAYER_EMISSION);
        add_to_layer((*path).pixel, of_background, (*path).beta * at_wavelength(camera_params.background, (*path).wavelength));
        add_to_layer((*path).pixel, (*path).layer, (*path).beta * at_wavelength(sky, (*path).wavelength));
    }
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
        sphere = nearest_sphere(camera_params.sphere_count, origin, direction, length);
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
    if hit.triangle != NONE {
        (*path).beta *= transmittance((*path).media, hit.t, (*path).wavelength);
        meet_surface(path, hit);
    } else if sphere.t < FAR {
        meet_sphere(path, sphere);
    } else {
        meet_sky(path);
    }
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
    var rays = 0u;
    var finished = false;
    loop {
        if !path.shadow_pending && !path.goes_on {
            finished = true;
            break;
        }
        advance(&path, &rays);
    }
    if !finished {
        atomicAdd(&film.unfinished, 1u);
    }
    if atomicAdd(&film.rays_low, rays) > 0xffffffffu - rays {
        atomicAdd(&film.rays_high, 1u);
    }
    let index = path.pixel;
    add_to_squares(index, film.pixels[index], path.radiance);
    film.pixels[index] += vec4<f32>(path.radiance, 1.0);
    if notes_sightings {
        path.sighting.radiance = dot(path.radiance, vec3<f32>(1.0 / 3.0));
        sightings[index] = path.sighting;
    }
}
