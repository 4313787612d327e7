// A path of light, followed from where it is seen toward the lights.

import package::film::layers::{add_to_group, add_to_layer};
import package::layout::features::notes_sightings;
import package::layout::path_pass::{path_params, Sighting, LAYER_EMISSION, LAYER_INDIRECT};
import package::layout::scene::NONE;
import package::medium::media::medium_ior;
import package::spectrum::wavelength::{all_wavelengths, at_wavelength, draw_wavelength, turned_as, Wavelength};

/// Slot of the padded number of a tail's wavelength.
const SLOT_TAIL: u32 = 3072u;
/// First slot of the padded numbers for microfacet normals; choices have those below.
const SLOT_MICROFACET: u32 = 4096u;
/// First slot of the padded numbers of vertices that gather light, eight each.
const SLOT_VERTEX: u32 = 8192u;

/// A path from a lens, or from a surface that is looked at, into the scene.
struct Path {
    origin: vec3<f32>,
    direction: vec3<f32>,
    /// How the direction changes to the other half of the sample's part of its pixel, right and up; 0 where a path stands for its own direction alone.
    other_right: vec3<f32>,
    other_up: vec3<f32>,
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
    /// Index of the sample among the pixel's.
    sample: u32,
    /// What it has seen of the energy maps, but for the radiance.
    sighting: Sighting,
    /// Whether its next ray is the first of its tail, which measures light that bounces to its first receiver: irradiance_cache.wgsl.
    tail_begins: bool,
    /// Radiance in the picture for radiance 1 along the tail.
    tail_factor: vec3<f32>,
    /// The share of what comes along the tail that its first receiver lets in.
    tail_beta: vec3<f32>,
    /// Radiance gathered before, W/(m² sr).
    before_tail: vec3<f32>,
}

/// A path that has seen nothing of the maps.
fn no_sighting() -> Sighting {
    return Sighting(NONE, 0.0, 0.0, NONE, 0.0, 0.0, 0.0, 0.0, vec3<f32>(0.0), -1.0);
}

/// Gives a path one wavelength.
fn take_wavelength(path: ptr<function, Path>) {
    // What a matt surface gathers from everywhere shows no single wavelengths: a color would be noise in the cache.
    if notes_sightings && (*path).sighting.inverse_distance >= 0.0 {
        (*path).wavelength = turned_as((*path).fifth_number);
        return;
    }
    let drawn = draw_wavelength((*path).fifth_number);
    (*path).wavelength = drawn.wavelength;
    // The exposure has divided by the square of the stated index where the camera stands.
    let stated = medium_ior(path_params.media, all_wavelengths());
    let index = stated / medium_ior(path_params.media, drawn.wavelength);
    (*path).beta = at_wavelength((*path).beta, drawn.wavelength) * drawn.weight * (index * index);
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

/// Adds radiance that a path meets, of lights of a group.
fn add_light(path: ptr<function, Path>, group: u32, radiance: vec3<f32>) {
    (*path).radiance += radiance;
    add_to_layer((*path).pixel, (*path).layer, radiance);
    add_to_group((*path).pixel, group, radiance);
}
