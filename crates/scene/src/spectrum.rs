//! Wavelengths and colours; `docs/spectra.md`.

mod tables;

use std::sync::OnceLock;

use glam::{DMat3, DVec3};

use self::tables::{OBSERVER_AND_DAYLIGHT, RED_AND_GREEN};

/// The shortest wavelength, nm.
pub const SHORTEST_WAVELENGTH: f64 = 380.0;
/// The longest wavelength, nm.
pub const LONGEST_WAVELENGTH: f64 = 780.0;
/// Distance between the tables' wavelengths, nm.
const STEP: f64 = 5.0;

/// Linear Rec. 709 from CIE XYZ, by rows.
const RGB_FROM_XYZ: [[f64; 3]; 3] = [
    [3.240_454_2, -1.537_138_5, -0.498_531_4],
    [-0.969_266_0, 1.876_010_8, 0.041_556_0],
    [0.055_643_4, -0.204_025_9, 1.057_225_2],
];

/// Luminance of linear Rec. 709.
const LUMINANCE: DVec3 = DVec3::new(0.212_6, 0.715_2, 0.072_2);
/// What a squared difference of a colour's channels from its luminance counts beside the luminance's square.
const CHROMA_SHARE: f64 = 0.25;

/// What one wavelength stands for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WavelengthEntry {
    /// The wavelength in vacuum, nm.
    pub nm: f64,
    /// The colour of white light of this wavelength alone, over the density with which it is drawn: linear Rec. 709, with a mean
    /// of 1 in every channel.
    pub weight: DVec3,
    /// The values here of the spectra of the three primaries, which sum to 1.
    pub primaries: DVec3,
}

/// Steps of [`wavelength_table`].
pub const WAVELENGTH_STEPS: usize = 512;

/// The wavelengths that numbers ξ = 0, 1/512 … 1 draw: they are dense where the eye sees much.
///
/// Between entries everything is linear in ξ.
pub fn wavelength_table() -> &'static [WavelengthEntry; WAVELENGTH_STEPS + 1] {
    static TABLE: OnceLock<[WavelengthEntry; WAVELENGTH_STEPS + 1]> = OnceLock::new();
    TABLE.get_or_init(make_table)
}

/// The number ξ that draws a wavelength, nm, in the range of wavelengths.
pub fn number_of_wavelength(nm: f64) -> f64 {
    let table = wavelength_table();
    let after = table.partition_point(|entry| entry.nm < nm).clamp(1, WAVELENGTH_STEPS);
    let (low, high) = (table[after - 1].nm, table[after].nm);
    (after as f64 - 1.0 + ((nm - low) / (high - low)).clamp(0.0, 1.0)) / WAVELENGTH_STEPS as f64
}

fn make_table() -> [WavelengthEntry; WAVELENGTH_STEPS + 1] {
    let colors = daylight_colors();
    let density: Vec<f64> = colors.iter().map(|color| visibility(*color)).collect();
    let cumulative = cumulative(&density);
    let mut table = std::array::from_fn(|index| {
        let place = place_of(&density, &cumulative, index as f64 / WAVELENGTH_STEPS as f64);
        let total = cumulative.last().copied().unwrap_or_default();
        let density_here = at_place(&density, place, |a, b, part| a + part * (b - a)) / total;
        let color = at_place(&colors, place, |a, b, part| a.lerp(b, part));
        WavelengthEntry {
            nm: SHORTEST_WAVELENGTH + STEP * place,
            weight: color / density_here,
            primaries: at_place(&primaries(), place, |a, b, part| a.lerp(b, part)),
        }
    });
    // What the steps in ξ miss is made good, so that every primary, and with them white, has its colour exactly.
    let correction = colors_of_primaries(&table).inverse();
    table.iter_mut().for_each(|entry: &mut WavelengthEntry| entry.weight = correction * entry.weight);
    // The inverse of the cumulative density ends beside it by some last digits.
    table[WAVELENGTH_STEPS].nm = LONGEST_WAVELENGTH;
    table
}

/// How much the noise of light of a colour is seen: its brightness, and half of how far its channels are from that, so that neither light that is
/// bright nor light that is colourful falls in rare and heavy samples.
fn visibility(color: DVec3) -> f64 {
    let luminance = LUMINANCE.dot(color);
    (luminance.powi(2) + CHROMA_SHARE * (color - luminance).length_squared() / 3.0).sqrt()
}

/// The colours of the three primaries, as columns: means over ξ of what is linear between the entries, by Simpson's rule, which is exact for
/// products of two such.
fn colors_of_primaries(table: &[WavelengthEntry]) -> DMat3 {
    let product = |weight: DVec3, primaries: DVec3| {
        DMat3::from_cols(weight * primaries.x, weight * primaries.y, weight * primaries.z)
    };
    let cell = |pair: &[WavelengthEntry]| {
        let (a, b) = (&pair[0], &pair[1]);
        let middle = product(0.5 * (a.weight + b.weight), 0.5 * (a.primaries + b.primaries));
        (product(a.weight, a.primaries) + 4.0 * middle + product(b.weight, b.primaries)) * (1.0 / 6.0)
    };
    table.windows(2).map(cell).fold(DMat3::ZERO, |sum, of_cell| sum + of_cell) * (1.0 / (table.len() - 1) as f64)
}

/// The colour of daylight at each of the tables' wavelengths, per nm, which integrates to white.
fn daylight_colors() -> Vec<DVec3> {
    let rgb_from_xyz = DMat3::from_cols_array_2d(&RGB_FROM_XYZ).transpose();
    let color = |[x, y, z, power]: [f64; 4]| rgb_from_xyz * DVec3::new(x, y, z) * power;
    let colors: Vec<DVec3> = OBSERVER_AND_DAYLIGHT.into_iter().map(color).collect();
    let ends = 0.5 * (colors[0] + colors[colors.len() - 1]);
    let total = STEP * (colors.iter().sum::<DVec3>() - ends);
    colors.into_iter().map(|color| color / total).collect()
}

/// The primaries' spectra at each of the tables' wavelengths.
fn primaries() -> Vec<DVec3> {
    RED_AND_GREEN.iter().map(|&[red, green]| DVec3::new(red, green, 1.0 - red - green)).collect()
}

/// The integral of a density that is linear between the tables' wavelengths, up to each of them.
fn cumulative(density: &[f64]) -> Vec<f64> {
    let steps = density.windows(2).scan(0.0, |sum, pair| {
        *sum += 0.5 * STEP * (pair[0] + pair[1]);
        Some(*sum)
    });
    std::iter::once(0.0).chain(steps).collect()
}

/// The place in the tables, in steps, up to which the density has a share of its integral.
fn place_of(density: &[f64], cumulative: &[f64], share: f64) -> f64 {
    let last = density.len() - 1;
    let wanted = share * cumulative[last];
    let cell = cumulative.partition_point(|sum| *sum <= wanted).clamp(1, last) - 1;
    let (low, high) = (density[cell], density[cell + 1]);
    // Solves STEP (low t + (high − low) t²/2) = rest by the form that is stable when low and high are close.
    let rest = (wanted - cumulative[cell]) / STEP;
    let root = (low * low + 2.0 * (high - low) * rest).max(0.0).sqrt();
    let t = if low + root > 0.0 { 2.0 * rest / (low + root) } else { 0.0 };
    cell as f64 + t.clamp(0.0, 1.0)
}

fn at_place<T: Copy>(table: &[T], place: f64, mix: impl Fn(T, T, f64) -> T) -> T {
    let cell = (place as usize).min(table.len() - 2);
    mix(table[cell], table[cell + 1], place - cell as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn white_is_white_and_primaries_keep_their_colour() {
        let table = wavelength_table();
        let ends = 0.5 * (table[0].weight + table[WAVELENGTH_STEPS].weight);
        let sum = table[1..WAVELENGTH_STEPS].iter().map(|entry| entry.weight).sum::<DVec3>() + ends;
        assert!((sum / WAVELENGTH_STEPS as f64 - 1.0).abs().max_element() < 1e-12);
        assert!(colors_of_primaries(table).abs_diff_eq(DMat3::IDENTITY, 1e-12));
    }

    #[test]
    fn weights_are_the_colours_of_the_spectrum() {
        // Yellow has red and green, and cyan less than no red.
        let at = |nm: f64| {
            let place = number_of_wavelength(nm) * WAVELENGTH_STEPS as f64;
            wavelength_table()[place.round() as usize].weight
        };
        let (red, green, blue, yellow, cyan) = (at(640.0), at(535.0), at(450.0), at(575.0), at(495.0));
        assert!(red.x > 3.0 && red.y.abs() < 0.5 && green.y > 2.0 && green.x < 0.0 && blue.z > 3.0);
        assert!(yellow.x > 1.0 && yellow.y > 1.0 && yellow.z < 0.0 && cyan.x < -1.0);
    }

    #[test]
    fn primaries_are_reflectances_that_sum_to_one() {
        for entry in wavelength_table() {
            assert!((entry.primaries.element_sum() - 1.0).abs() < 1e-12);
            assert!(entry.primaries.min_element() >= 0.0 && entry.primaries.max_element() <= 1.0);
        }
    }

    #[test]
    fn wavelengths_rise_and_numbers_find_them() {
        let table = wavelength_table();
        assert!(table.is_sorted_by(|a, b| a.nm < b.nm));
        assert_eq!((table[0].nm, table[WAVELENGTH_STEPS].nm), (SHORTEST_WAVELENGTH, LONGEST_WAVELENGTH));
        for nm in [380.0, 486.13, 587.56, 656.27, 780.0] {
            let place = number_of_wavelength(nm) * WAVELENGTH_STEPS as f64;
            let cell = (place as usize).min(WAVELENGTH_STEPS - 1);
            let part = place - cell as f64;
            let found = table[cell].nm + part * (table[cell + 1].nm - table[cell].nm);
            assert!((found - nm).abs() < 1e-9, "{nm} nm: {found}");
        }
    }

    #[test]
    fn weights_are_bounded() {
        let most = wavelength_table().iter().map(|entry| entry.weight.abs().max_element()).fold(0.0, f64::max);
        assert!(most < 5.5, "{most}");
    }
}
