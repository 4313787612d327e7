//! How the index of refraction changes with the wavelength; `docs/spectra.md`.

/// Fraunhofer's lines F, d and C, nm, by which Abbe's number is defined.
const LINE_F: f64 = 486.1327;
/// The wavelength at which an index of refraction is stated, nm: Fraunhofer's line d.
pub const STATED_WAVELENGTH: f64 = 587.5618;
const LINE_C: f64 = 656.2725;

/// The change of an index of refraction over the wavelength, from its value at [`STATED_WAVELENGTH`].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Dispersion {
    /// None: one index for all light.
    #[default]
    None,
    /// By Abbe's number V = (n_d − 1)/(n_F − n_C), > 0: n changes with 1/λ².
    Abbe(f32),
    /// Cauchy's B (µm²) and C (µm⁴): n changes as B/λ² + C/λ⁴.
    Cauchy([f32; 2]),
    /// Sellmeier's pairs of B and C (µm²): n changes as √(1 + Σ Bλ²/(λ² − C)).
    Sellmeier([[f32; 2]; 4]),
}

impl Dispersion {
    /// The index at a wavelength, nm, of a medium of index `stated` at [`STATED_WAVELENGTH`].
    pub fn index(&self, stated: f32, nm: f64) -> f64 {
        let stated = f64::from(stated);
        match *self {
            Self::None => stated,
            Self::Abbe(number) => {
                let b = (stated - 1.0) / (f64::from(number) * (square_number(LINE_F) - square_number(LINE_C)));
                stated + b * (square_number(nm) - square_number(STATED_WAVELENGTH))
            }
            Self::Cauchy([b, c]) => stated + cauchy([b, c], nm) - cauchy([b, c], STATED_WAVELENGTH),
            Self::Sellmeier(pairs) => stated + sellmeier(pairs, nm) - sellmeier(pairs, STATED_WAVELENGTH),
        }
    }

    /// Whether the index changes at all.
    pub fn is_none(&self) -> bool {
        *self == Self::None
    }
}

/// 1/λ², 1/µm².
fn square_number(nm: f64) -> f64 {
    1e6 / (nm * nm)
}

/// Cauchy's terms at a wavelength, nm, with B (µm²) and C (µm⁴).
pub(crate) fn cauchy([b, c]: [f32; 2], nm: f64) -> f64 {
    f64::from(b) * square_number(nm) + f64::from(c) * square_number(nm).powi(2)
}

/// Sellmeier's formula at a wavelength, nm, with pairs of B and C (µm²).
pub(crate) fn sellmeier(pairs: [[f32; 2]; 4], nm: f64) -> f64 {
    let square = 1e-6 * nm * nm;
    let term = |[b, c]: [f32; 2]| f64::from(b) * square / (square - f64::from(c));
    (1.0 + pairs.into_iter().map(term).sum::<f64>()).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Schott's data sheet of N-BK7.
    const BK7: Dispersion = Dispersion::Sellmeier([
        [1.039_612, 0.006_000_699],
        [0.231_792_34, 0.020_017_914],
        [1.010_469_5, 103.560_65],
        [0.0, 0.0],
    ]);

    #[test]
    fn bk7_has_the_indices_of_its_data_sheet() {
        for (nm, index) in [(486.13, 1.52238), (587.56, 1.51680), (656.27, 1.51432), (435.83, 1.52668)] {
            let found = BK7.index(1.5168, nm);
            assert!((found - index).abs() < 1e-5, "{nm} nm: {found}, data sheet {index}");
        }
    }

    #[test]
    fn abbe_number_is_what_it_is_defined_as() {
        let dispersion = Dispersion::Abbe(64.17);
        let index = |nm| dispersion.index(1.5168, nm);
        assert!((index(STATED_WAVELENGTH) - 1.5168).abs() < 1e-6);
        assert!(((1.5168 - 1.0) / (index(LINE_F) - index(LINE_C)) - 64.17).abs() < 1e-3);
    }

    #[test]
    fn cauchy_adds_its_terms() {
        let (a, b, c) = (1.5046f64, 0.0042f64, 0.0001f64);
        let full = |nm: f64| a + b / (1e-6 * nm * nm) + c / (1e-6 * nm * nm).powi(2);
        let dispersion = Dispersion::Cauchy([b as f32, c as f32]);
        assert!((dispersion.index(full(STATED_WAVELENGTH) as f32, 450.0) - full(450.0)).abs() < 1e-6);
    }
}
