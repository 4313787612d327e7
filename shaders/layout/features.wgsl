// What the scene makes use of, set when a pipeline is made: code without use is not compiled, for software adapters pay for every branch that a
// kernel has, taken or not.

/// Whether a surface is rough, coated or metallic-rough.
override has_gloss: bool = true;
/// Whether there are metals.
override has_conductors: bool = true;
/// Whether there are points or spots.
override has_point_lights: bool = true;
/// Whether triangles shine.
override has_surface_lights: bool = true;
/// Whether there is light from infinitely far.
override has_distant_lights: bool = true;
/// Whether there is an environment.
override has_environment: bool = true;
/// Whether surfaces show pictures.
override has_textures: bool = true;
/// Whether meshes have colours or opacities at their vertices.
override has_vertex_colors: bool = true;
/// Whether rays may pass surfaces as if they were not there.
override has_holes: bool = true;
/// Whether a surface is of two materials.
override has_blends: bool = true;
/// Whether light has wavelengths.
override has_dispersion: bool = true;
/// The kind of light whose photons the kernel emits: one of the LIGHT_ constants.
override photon_light_kind: u32 = 0u;
/// Whether photons lay their flux over the footprint of the part of the emission that they stand for.
override has_footprints: bool = true;
/// Whether the squares of what photons bring are summed.
override has_squares: bool = true;
/// Whether the filter of maps mixes hues alone.
override mixes_hues: bool = false;
/// Whether a guide moves photons.
override has_guide: bool = true;
/// Whether light follows the 2016 paper's model, and how it turns at glass: one of the PAPER_ constants.
override paper_refraction: u32 = 1u;
/// Whether camera paths note which texels they see.
override notes_sightings: bool = false;
/// Whether paths end at receivers whose bounced light the irradiance cache knows.
override has_irradiance_cache: bool = false;
/// Whether light is kept apart by how it came.
override has_light_layers: bool = false;
/// Whether it is kept what pixels show, and how much their samples vary.
override has_data_layers: bool = false;
/// Light groups that are kept apart; 0 where none are.
override light_group_count: u32 = 0u;
/// Whether the sum of the first half of the samples is kept, for an estimate of the error.
override has_halves: bool = false;

/// Light is physical.
const PAPER_NONE: u32 = 0u;
/// The paper's model, refraction by its equation 3 as printed.
const PAPER_PRINTED: u32 = 1u;
/// The paper's model, refraction by Snell's law.
const PAPER_EXACT: u32 = 2u;
