//! What is measured of a cell.

use std::fmt;

use diacaustic::EnergyMap;
use serde::Deserialize;

use crate::{Measure, Side};

/// How far a texel's neighbourhood reaches along each axis, texels.
const NEIGHBOURHOOD: i64 = 2;

/// A figure of a cell; `docs/experiments.md` defines them.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum Figure {
    /// Mean irradiance of the caustic.
    Mean,
    /// Irradiance of the brightest texel.
    Peak,
    /// Area of the caustic, m².
    Area,
    /// Coefficient of variation of the caustic at the scale of a texel.
    Spottedness,
    /// What the whole side has collected: W, or energy in the profile `paper`.
    Energy,
    /// How far apart the channels of the caustic are, 0 to 1.
    Colour,
    /// Relative squared error of the picture against the table's reference.
    Error,
    /// Time that the photons took, s.
    PhotonSeconds,
    /// Time that photons and samples took, s.
    Seconds,
}

impl Figure {
    /// All of them.
    pub const ALL: [Self; 9] = [
        Self::Mean,
        Self::Peak,
        Self::Area,
        Self::Spottedness,
        Self::Energy,
        Self::Colour,
        Self::Error,
        Self::PhotonSeconds,
        Self::Seconds,
    ];

    /// Its name on the page.
    pub fn name(self) -> &'static str {
        match self {
            Self::Mean => "mean irradiance",
            Self::Peak => "peak irradiance",
            Self::Area => "caustic area",
            Self::Spottedness => "spottedness",
            Self::Energy => "energy",
            Self::Colour => "colour spread",
            Self::Error => "error",
            Self::PhotonSeconds => "photon time",
            Self::Seconds => "time",
        }
    }

    /// What follows its number on the page, `irradiance` being the unit of that; empty for numbers without a unit.
    pub(crate) fn suffix(self, irradiance: &str) -> String {
        match self {
            Self::Mean | Self::Peak => format!(" {irradiance}"),
            Self::Area => " m²".to_owned(),
            Self::PhotonSeconds | Self::Seconds => " s".to_owned(),
            Self::Spottedness | Self::Energy | Self::Colour | Self::Error => String::new(),
        }
    }

    /// Its name in CSV.
    pub fn key(self) -> &'static str {
        match self {
            Self::Mean => "mean",
            Self::Peak => "peak",
            Self::Area => "area",
            Self::Spottedness => "spottedness",
            Self::Energy => "energy",
            Self::Colour => "colour",
            Self::Error => "error",
            Self::PhotonSeconds => "photon_seconds",
            Self::Seconds => "seconds",
        }
    }
}

impl fmt::Display for Figure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// All figures of a cell.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Figures {
    /// See [`Figure::Mean`]; 0 without a caustic.
    pub mean: f64,
    /// See [`Figure::Peak`].
    pub peak: f64,
    /// See [`Figure::Area`].
    pub area: f64,
    /// See [`Figure::Spottedness`]; 0 without a caustic.
    pub spottedness: f64,
    /// See [`Figure::Energy`].
    pub energy: f64,
    /// See [`Figure::Colour`]; 0 without a caustic.
    pub colour: f64,
    /// See [`Figure::Error`]; none without a reference.
    pub error: Option<f64>,
    /// See [`Figure::PhotonSeconds`].
    pub photon_seconds: f64,
    /// See [`Figure::Seconds`].
    pub seconds: f64,
}

impl Figures {
    /// One of them; none if it was not measured.
    pub fn get(&self, figure: Figure) -> Option<f64> {
        match figure {
            Figure::Mean => Some(self.mean),
            Figure::Peak => Some(self.peak),
            Figure::Area => Some(self.area),
            Figure::Spottedness => Some(self.spottedness),
            Figure::Energy => Some(self.energy),
            Figure::Colour => Some(self.colour),
            Figure::Error => self.error,
            Figure::PhotonSeconds => Some(self.photon_seconds),
            Figure::Seconds => Some(self.seconds),
        }
    }

    /// Measures one side of an energy map; times and error stay unset.
    pub(crate) fn of_map(map: &EnergyMap, measure: &Measure) -> Self {
        // A map of a stated size has its layers one after the other, row by row.
        let texels = map.areas.len() / map.layers as usize;
        let layer = if measure.side == Side::Back { map.layers as usize - 1 } else { 0 };
        let areas = &map.areas[layer * texels..][..texels];
        let colors: Vec<_> = (0..texels).map(|texel| map.irradiance(layer * texels + texel)).collect();
        let field = Field {
            width: i64::from(map.width),
            height: i64::from(map.height),
            irradiance: colors.iter().map(|color| color.element_sum() / 3.0).collect(),
            areas,
        };
        let mut figures = field.measure(measure.threshold);
        let fluxes = (0..texels).map(|texel| map.flux(layer * texels + texel).element_sum() / 3.0);
        figures.energy = fluxes.sum();
        let (mut spread, mut most) = (0.0, 0.0);
        for ((color, area), _) in
            colors.iter().zip(areas).zip(0..).filter(|(_, at)| field.is_caustic(*at, measure.threshold))
        {
            spread += area * (color.max_element() - color.min_element());
            most += area * color.max_element();
        }
        figures.colour = if most > 0.0 { spread / most } else { 0.0 };
        figures
    }
}

/// One side of an energy map.
struct Field<'m> {
    width: i64,
    height: i64,
    /// Mean of the channels.
    irradiance: Vec<f64>,
    /// 0 where there is no surface.
    areas: &'m [f64],
}

impl Field<'_> {
    /// Mean irradiance of the surface within two texels of a texel.
    fn neighbourhood(&self, at: usize) -> f64 {
        let (x, y) = (at as i64 % self.width, at as i64 / self.width);
        let (mut flux, mut area) = (0.0, 0.0);
        for row in (y - NEIGHBOURHOOD).max(0)..=(y + NEIGHBOURHOOD).min(self.height - 1) {
            for column in (x - NEIGHBOURHOOD).max(0)..=(x + NEIGHBOURHOOD).min(self.width - 1) {
                let texel = (row * self.width + column) as usize;
                flux += self.irradiance[texel] * self.areas[texel];
                area += self.areas[texel];
            }
        }
        if area > 0.0 { flux / area } else { 0.0 }
    }

    /// Whether a texel's neighbourhood is as bright as the threshold.
    fn is_caustic(&self, at: usize, threshold: f64) -> bool {
        self.areas[at] > 0.0 && self.neighbourhood(at) >= threshold
    }

    /// What alternates from texel to texel, by Immerkær's operator (1996), which stops planes and straight edges along the axes: of independent noise, its
    /// deviation. Beyond the map, and where there is no surface, the texel itself stands in.
    fn alternation(&self, at: usize) -> f64 {
        let (x, y) = (at as i64 % self.width, at as i64 / self.width);
        let mut sum = 0.0;
        for (row, of_row) in (y - 1..).zip([1.0, -2.0, 1.0]) {
            for (column, of_column) in (x - 1..).zip([1.0, -2.0, 1.0]) {
                let is_inside = (0..self.width).contains(&column) && (0..self.height).contains(&row);
                let texel = if is_inside { (row * self.width + column) as usize } else { at };
                sum += of_row * of_column * self.irradiance[if self.areas[texel] > 0.0 { texel } else { at }];
            }
        }
        // The root of the sum of the weights' squares.
        sum / 6.0
    }

    fn measure(&self, threshold: f64) -> Figures {
        let (mut area, mut flux, mut squares) = (0.0, 0.0, 0.0);
        for (at, (&irradiance, &of_texel)) in self.irradiance.iter().zip(self.areas).enumerate() {
            if self.is_caustic(at, threshold) {
                area += of_texel;
                flux += of_texel * irradiance;
                squares += of_texel * self.alternation(at).powi(2);
            }
        }
        let mean = if area > 0.0 { flux / area } else { 0.0 };
        let spottedness = if mean > 0.0 { (squares / area).sqrt() / mean } else { 0.0 };
        let peak = self.irradiance.iter().copied().fold(0.0, f64::max);
        Figures { mean, peak, area, spottedness, ..Figures::default() }
    }
}

/// Mean over pixels and channels of min(1, (p − r)²/(r² + 0.01 r̄²)), r̄ the mean of the reference.
pub(crate) fn relative_error(picture: &[[f32; 3]], reference: &[[f32; 3]]) -> f64 {
    let pairs = || picture.as_flattened().iter().zip(reference.as_flattened());
    let count = picture.len().max(1) as f64 * 3.0;
    let mean = pairs().map(|(_, &r)| f64::from(r)).sum::<f64>() / count;
    let floor = (0.01 * mean * mean).max(f64::MIN_POSITIVE);
    let error = |(&p, &r): (&f32, &f32)| (f64::from(p - r).powi(2) / (f64::from(r).powi(2) + floor)).min(1.0);
    pairs().map(error).sum::<f64>() / count
}

#[cfg(test)]
mod tests {
    use super::*;

    fn field<'m>(irradiance: impl Fn(i64, i64) -> f64, areas: &'m [f64]) -> Field<'m> {
        let places = (0..20).flat_map(|y| (0..20).map(move |x| (x, y)));
        Field { width: 20, height: 20, irradiance: places.map(|(x, y)| irradiance(x, y)).collect(), areas }
    }

    #[test]
    fn an_even_patch_has_its_area_and_no_spots() {
        let areas = [0.01; 400];
        let even = field(|_, _| 3.0, &areas).measure(1.0);
        assert!((even.mean - 3.0).abs() < 1e-12 && (even.area - 4.0).abs() < 1e-12);
        assert_eq!((even.peak, even.spottedness.abs() < 1e-9), (3.0, true));
        assert_eq!(field(|_, _| 3.0, &areas).measure(4.0), Figures { peak: 3.0, ..Figures::default() });
    }

    #[test]
    fn a_checkered_patch_is_spotted_and_a_slope_is_not() {
        let areas = [1.0; 400];
        let checkered = field(|x, y| if (x + y) % 2 == 0 { 2.0 } else { 0.0 }, &areas).measure(0.5);
        assert!((checkered.mean - 1.0).abs() < 0.05 && checkered.spottedness > 2.0, "{checkered:?}");
        // Independent numbers of mean 2 and deviation ½.
        let noise = |x: i64, y: i64| {
            let mixed = (x * 374_761_393 + y * 668_265_263) & 0xffff_ffff;
            2.0 + if ((mixed ^ mixed >> 13) * 1_274_126_177) >> 16 & 1 == 0 { 0.5 } else { -0.5 }
        };
        let noisy = field(noise, &areas).measure(0.5);
        assert!((noisy.spottedness - 0.25).abs() < 0.06, "{noisy:?}");
        let slope = field(|x, _| 1.0 + x as f64, &areas).measure(0.5);
        assert!(slope.spottedness < 0.05, "{slope:?}");
    }

    #[test]
    fn equal_pictures_have_no_error() {
        let reference = [[1.0, 2.0, 3.0], [0.0, 0.0, 0.0]];
        assert_eq!(relative_error(&reference, &reference), 0.0);
        let error = relative_error(&[[1.1, 2.2, 3.3], [0.0; 3]], &reference);
        // Three of six channels are a tenth off, of r² and 1 % of the mean's square.
        assert!((error - 0.005).abs() < 2e-4, "{error}");
    }
}
