// The dielectrics that a ray is in; docs/materials.md, "Media".
//
// A list holds the keys of up to four media, the highest first; a key orders by rank, and 0 is air.

import package::layout::features::has_dispersion;
import package::layout::records::{load_absorption, load_colored_index, load_index, load_index_at};
import package::spectrum::wavelength::{at_wavelength, Wavelength};

/// Index of a key's material.
const MEDIUM_MATERIAL_BITS: u32 = 0xffffu;

/// The list with one more medium; the lowest of five is forgotten.
fn with_medium(media: vec4<u32>, key: u32) -> vec4<u32> {
    let x = max(media.x, key);
    var rest = min(media.x, key);
    let y = max(media.y, rest);
    rest = min(media.y, rest);
    let z = max(media.z, rest);
    rest = min(media.z, rest);
    return vec4<u32>(x, y, z, max(media.w, rest));
}

/// The list with one entry of a medium less, if it has one.
fn without_medium(media: vec4<u32>, key: u32) -> vec4<u32> {
    let from_x = media.x == key;
    let from_y = from_x || media.y == key;
    let from_z = from_y || media.z == key;
    let from_w = from_z || media.w == key;
    let shifted = vec4<u32>(media.yzw, 0u);
    return select(media, shifted, vec4<bool>(from_x, from_y, from_z, from_w));
}

/// The list beyond a dielectric's boundary that is met from its front or its back.
fn media_beyond(media: vec4<u32>, key: u32, front: bool) -> vec4<u32> {
    return select(without_medium(media, key), with_medium(media, key), front);
}

/// Whether the index of what fills the place changes with the wavelength.
fn is_dispersive(media: vec4<u32>) -> bool {
    return has_dispersion && media.x != 0u && load_index(media.x & MEDIUM_MATERIAL_BITS).row >= 0.0;
}

/// Index of refraction of what fills the place.
fn medium_ior(media: vec4<u32>, wavelength: Wavelength) -> f32 {
    if media.x == 0u {
        return 1.0;
    }
    let stated = load_index(media.x & MEDIUM_MATERIAL_BITS);
    if has_dispersion && stated.row >= 0.0 && wavelength.number >= 0.0 {
        return load_index_at(u32(stated.row), wavelength.number);
    }
    return stated.ior;
}

/// Indices of refraction of what fills the place, for red, green and blue light as a whole.
fn medium_colored_ior(media: vec4<u32>) -> vec3<f32> {
    if media.x == 0u {
        return vec3<f32>(1.0);
    }
    return load_colored_index(media.x & MEDIUM_MATERIAL_BITS);
}

/// Transmittance over a distance, metres (Beer–Lambert).
fn transmittance(media: vec4<u32>, distance: f32, wavelength: Wavelength) -> vec3<f32> {
    if media.x == 0u {
        return vec3<f32>(1.0);
    }
    return exp(-at_wavelength(load_absorption(media.x & MEDIUM_MATERIAL_BITS), wavelength) * distance);
}
