//! Light of all wavelengths and of one, as `docs/spectra.md` defines them.

use diacaustic_scene::{WAVELENGTH_STEPS, WavelengthEntry, number_of_wavelength, wavelength_table};
use glam::DVec3;

/// What the three channels of light stand for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Spectrum {
    /// Red, green and blue light of all wavelengths.
    Whole,
    /// The colour of light of one wavelength, on which a factor is the same in all channels.
    Line(Wavelength),
}

/// A wavelength of light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wavelength {
    /// In vacuum, nm.
    pub nm: f64,
    /// The values here of the spectra of red, green and blue.
    pub primaries: DVec3,
}

impl Spectrum {
    /// That of all light of one wavelength, nm, or of all wavelengths.
    pub fn of_render(wavelength: Option<f32>) -> Self {
        wavelength.map_or(Self::Whole, |nm| {
            let nm = f64::from(nm);
            Self::Line(Wavelength { nm, primaries: entry_at(number_of_wavelength(nm)).primaries })
        })
    }

    /// What becomes of light of all wavelengths that takes the one of the number ξ in [0, 1): its spectrum and its colour,
    /// whose mean over ξ is `light`.
    pub fn drawn(number: f64, light: DVec3) -> (Self, DVec3) {
        let WavelengthEntry { nm, weight, primaries } = entry_at(number);
        let spectrum = Self::Line(Wavelength { nm, primaries });
        (spectrum, weight * spectrum.color(light))
    }

    /// What a colour, of a factor or of a light, is per channel.
    pub fn color(&self, color: DVec3) -> DVec3 {
        match self {
            Self::Whole => color,
            Self::Line(wavelength) => DVec3::splat(wavelength.primaries.dot(color)),
        }
    }
}

/// The means over ξ of a function of the wavelength, nm, weighted by the channels of its colours.
pub fn mean_of_colors(value: impl Fn(f64) -> f64) -> DVec3 {
    let table = wavelength_table();
    let weighted = |entry: &WavelengthEntry| entry.weight * value(entry.nm);
    let ends = 0.5 * (weighted(&table[0]) + weighted(&table[WAVELENGTH_STEPS]));
    let inner: DVec3 = table[1..WAVELENGTH_STEPS].iter().map(weighted).sum();
    (inner + ends) / WAVELENGTH_STEPS as f64
}

/// The table of wavelengths between its entries.
fn entry_at(number: f64) -> WavelengthEntry {
    let table = wavelength_table();
    let place = number * WAVELENGTH_STEPS as f64;
    let cell = (place as usize).min(WAVELENGTH_STEPS - 1);
    let (a, b, part) = (&table[cell], &table[cell + 1], place - cell as f64);
    WavelengthEntry {
        nm: a.nm + part * (b.nm - a.nm),
        weight: a.weight.lerp(b.weight, part),
        primaries: a.primaries.lerp(b.primaries, part),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_mean_over_the_wavelengths_is_the_light() {
        let light = DVec3::new(0.7, 0.2, 0.4);
        // A step of the table in 8 intervals: the midpoint rule is as good as exact for what is linear.
        let count = 8 * WAVELENGTH_STEPS as u32;
        let number = |i: u32| (f64::from(i) + 0.5) / f64::from(count);
        let mean = (0..count).map(|i| Spectrum::drawn(number(i), light).1).sum::<DVec3>() / f64::from(count);
        assert!(mean.abs_diff_eq(light, 1e-6), "{mean}");
    }

    #[test]
    fn gray_is_the_same_at_all_wavelengths() {
        for nm in [380.0, 455.5, 587.56, 700.0, 780.0] {
            let gray = Spectrum::of_render(Some(nm)).color(DVec3::splat(0.3));
            assert!(gray.abs_diff_eq(DVec3::splat(0.3), 1e-14));
        }
    }

    #[test]
    fn long_waves_are_red() {
        let share = |color| Spectrum::of_render(Some(650.0)).color(color).x;
        assert!(share(DVec3::X) > 0.9 && share(DVec3::Y) < 0.1 && share(DVec3::Z) < 0.1);
        assert_eq!(Spectrum::of_render(None).color(DVec3::X), DVec3::X);
    }
}
