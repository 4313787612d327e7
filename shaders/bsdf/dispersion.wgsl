// Light of all colors at the first boundary that disperses it; docs/spectra.md, "One wavelength".

import package::bsdf::fresnel::refraction;
import package::medium::media::{medium_colored_ior, medium_ior};
import package::spectrum::wavelength::{all_wavelengths, draw_wavelength};

/// The greatest number below 1.
const BELOW_1: f32 = 0.99999994;

/// What becomes of light of all colors at a boundary.
struct ColorSplit {
    /// The number that makes the choice between reflection and refraction.
    u: f32,
    /// The number of the wavelength: that which is taken, or what is left for another boundary.
    xi: f32,
    /// Factor on what is reflected or refracted, for reflectances other than the one that made the choice.
    factor: vec3<f32>,
    /// Whether the light takes one wavelength.
    takes_wavelength: bool,
}

fn reflectance(cos_i: f32, eta: f32) -> f32 {
    return refraction(cos_i, eta).reflectance;
}

/// Chooses, where `media` ends at a boundary to `beyond`, between reflection, which keeps all colors, and refraction, which takes a
/// wavelength, both by the number `xi`, so that the wavelengths of what is refracted stay evenly spread. Of a rough surface and of a way out into a
/// thinner medium the wavelength comes first, and `u` chooses.
fn split_colors(media: vec4<u32>, beyond: vec4<u32>, cos_i: f32, is_smooth: bool, u: f32, xi: f32) -> ColorSplit {
    let colored = all_wavelengths();
    let stated = medium_ior(media, colored) / medium_ior(beyond, colored);
    if !is_smooth || stated >= 1.0 {
        return ColorSplit(u, xi, vec3<f32>(1.0), true);
    }
    let chance = reflectance(cos_i, stated);
    if xi < chance {
        let eta = medium_colored_ior(media) / medium_colored_ior(beyond);
        let reflected = vec3<f32>(reflectance(cos_i, eta.x), reflectance(cos_i, eta.y), reflectance(cos_i, eta.z));
        return ColorSplit(0.0, xi / chance, reflected / chance, false);
    }
    let rest = min((xi - chance) / (1.0 - chance), BELOW_1);
    let wavelength = draw_wavelength(rest).wavelength;
    let eta = medium_ior(media, wavelength) / medium_ior(beyond, wavelength);
    return ColorSplit(BELOW_1, rest, vec3<f32>((1.0 - reflectance(cos_i, eta)) / (1.0 - chance)), true);
}
