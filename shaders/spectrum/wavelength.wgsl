// The wavelength of a photon or path; docs/spectra.md.

import package::layout::features::has_dispersion;
import package::layout::records::{load_color_of_wavelength, load_fixed_wavelength};

/// What is known of a wavelength.
struct Wavelength {
    /// The number ξ that drew it; negative while light is red, green and blue.
    number: f32,
    /// The values there of the primaries' spectra.
    primaries: vec3<f32>,
    /// Whether light is turned as of this wavelength and keeps its colors all the same.
    keeps_colors: bool,
}

/// A wavelength, with the color of white light of this wavelength over the density with which it is drawn.
struct DrawnWavelength {
    wavelength: Wavelength,
    weight: vec3<f32>,
}

/// The wavelength with which all light of the scene begins.
fn first_wavelength() -> Wavelength {
    if !has_dispersion {
        return all_wavelengths();
    }
    let number = load_fixed_wavelength();
    if number < 0.0 {
        return all_wavelengths();
    }
    return draw_wavelength(number).wavelength;
}

/// Light as red, green and blue.
fn all_wavelengths() -> Wavelength {
    return Wavelength(-1.0, vec3<f32>(0.0), true);
}

/// Light of all colors that is turned as that of the wavelength of a number.
fn turned_as(number: f32) -> Wavelength {
    return Wavelength(number, vec3<f32>(0.0), true);
}

fn draw_wavelength(number: f32) -> DrawnWavelength {
    let color = load_color_of_wavelength(number);
    return DrawnWavelength(Wavelength(number, color.primaries, false), color.weight);
}

/// What a color counts for at a wavelength: its spectrum there.
fn at_wavelength(color: vec3<f32>, wavelength: Wavelength) -> vec3<f32> {
    if !has_dispersion {
        return color;
    }
    return select(vec3<f32>(dot(color, wavelength.primaries)), color, wavelength.keeps_colors);
}
