//! Indices of refraction of transparent substances.

use glam::Vec3;

use crate::Dispersion;

/// A transparent substance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Substance {
    /// The name under which scene files refer to it.
    pub name: &'static str,
    /// Index of refraction against air for yellow light: 587.6 nm (d) or 589.3 nm (D), which differ by less than 0.0002.
    pub ior: f32,
    /// How the index changes with the wavelength, where that is known.
    pub dispersion: Dispersion,
    /// Absorption coefficient, 1/m per channel.
    pub absorption: Vec3,
    /// Where the index comes from.
    pub source: &'static str,
}

/// The substance of a name.
pub fn substance(name: &str) -> Option<Substance> {
    SUBSTANCES.iter().find(|substance| substance.name == name).copied()
}

/// Every substance that has a name.
pub const SUBSTANCES: [Substance; 19] = [
    clear("air", 1.0, Dispersion::None, "by convention; 1.00027 against vacuum"),
    clear(
        "water",
        1.333,
        Dispersion::Sellmeier([
            [0.568_402_76, 0.005_101_83],
            [0.172_617_74, 0.018_211_54],
            [0.020_861_896, 0.026_207_223],
            [0.113_074_87, 10.697_927],
        ]),
        "20 °C; Daimon and Masumura 2007, Appl. Opt. 46, 3811 (1.3334 against vacuum)",
    ),
    clear("ice", 1.3097, Dispersion::Abbe(54.6), "−7 °C; Warren and Brandt 2008, J. Geophys. Res. 113, D14220"),
    clear(
        "ethanol",
        1.3617,
        Dispersion::Cauchy([0.003_06, 0.000_02]),
        "20 °C; Rheims et al. 1997, Meas. Sci. Technol. 8, 601",
    ),
    clear("olive_oil", 1.467, Dispersion::None, "25 °C; the middle of the Merck Index's 1.466 to 1.468"),
    clear(
        "glycerol",
        1.4723,
        Dispersion::Cauchy([0.005_98, -0.000_36]),
        "25 °C; Rheims et al. 1997, Meas. Sci. Technol. 8, 601",
    ),
    clear(
        "acrylic",
        1.4906,
        Dispersion::Sellmeier([[1.1819, 0.011_313], NO, NO, NO]),
        "PMMA, 20 °C; Sultanova et al. 2009, Acta Phys. Pol. A 116, 585",
    ),
    clear(
        "polycarbonate",
        1.5848,
        Dispersion::Sellmeier([[1.4182, 0.021_304], NO, NO, NO]),
        "20 °C; Sultanova et al. 2009, Acta Phys. Pol. A 116, 585",
    ),
    clear(
        "fused_quartz",
        1.4585,
        Dispersion::Sellmeier([[0.696_166_3, 0.004_679_148], [0.407_942_6, 0.013_512_06], [0.897_479_4, 97.934_0], NO]),
        "20 °C; Malitson 1965, J. Opt. Soc. Am. 55, 1205",
    ),
    clear(
        "quartz",
        1.5443,
        Dispersion::Sellmeier([[0.286_041_4, 0.0], [1.070_440_8, 0.010_058_6], [1.102_022_4, 100.0], NO]),
        "crystal, ordinary ray; Ghosh 1999, Opt. Commun. 163, 95",
    ),
    clear("crown_glass", 1.52, Dispersion::Abbe(59.0), "a typical value; physics tables have 1.50 to 1.54"),
    clear("flint_glass", 1.62, Dispersion::Abbe(36.4), "a typical value; Schott's F2 has 1.62004"),
    clear(
        "bk7",
        1.5168,
        Dispersion::Sellmeier([
            [1.039_612, 0.006_000_699],
            [0.231_792_34, 0.020_017_914],
            [1.010_469_5, 103.560_65],
            NO,
        ]),
        "N-BK7; Schott data sheet",
    ),
    clear(
        "f2",
        1.62004,
        Dispersion::Sellmeier([
            [1.345_333_6, 0.009_977_439],
            [0.209_073_18, 0.047_045_08],
            [0.937_357_2, 111.886_76],
            NO,
        ]),
        "Schott data sheet",
    ),
    clear(
        "sf10",
        1.72825,
        Dispersion::Sellmeier([
            [1.616_259_8, 0.012_753_456],
            [0.259_229_33, 0.058_198_395],
            [1.077_623_2, 116.607_68],
            NO,
        ]),
        "Schott data sheet",
    ),
    clear(
        "sf11",
        1.78472,
        Dispersion::Sellmeier([
            [1.738_484, 0.013_606_861],
            [0.311_168_97, 0.061_596_046],
            [1.174_908_7, 121.922_71],
            NO,
        ]),
        "Schott data sheet",
    ),
    clear(
        "sapphire",
        1.7681,
        Dispersion::Sellmeier([
            [1.431_349_3, 0.005_279_926],
            [0.650_547_1, 0.014_238_265],
            [5.341_402, 325.017_83],
            NO,
        ]),
        "ordinary ray, 20 °C; Malitson and Dodge 1972, J. Opt. Soc. Am. 62, 1405",
    ),
    clear(
        "diamond",
        2.4175,
        Dispersion::Sellmeier([[0.3306, 0.030_625], [4.3356, 0.011_236], NO, NO]),
        "Peter 1923, Z. Phys. 15, 358",
    ),
    Substance {
        name: "amber",
        ior: 1.54,
        dispersion: Dispersion::None,
        // Honey-coloured: a centimetre passes 0.90, 0.61 and 0.15. Amber varies from near colourless to brown.
        absorption: Vec3::new(10.0, 50.0, 190.0),
        source: "gemmological tables have 1.539 to 1.545; the absorption is chosen by eye",
    },
];

/// No pair of Sellmeier's.
const NO: [f32; 2] = [0.0; 2];

const fn clear(name: &'static str, ior: f32, dispersion: Dispersion, source: &'static str) -> Substance {
    Substance { name, ior, dispersion, absorption: Vec3::ZERO, source }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{STATED_WAVELENGTH, dispersion::sellmeier};

    #[test]
    fn formulas_agree_with_the_stated_indices() {
        for substance in SUBSTANCES {
            if let Dispersion::Sellmeier(pairs) = substance.dispersion {
                let found = sellmeier(pairs, STATED_WAVELENGTH);
                assert!((found - f64::from(substance.ior)).abs() < 5e-4, "{}: {found}", substance.name);
            }
        }
    }

    #[test]
    fn abbe_numbers_are_the_known_ones() {
        for (name, abbe) in [
            ("bk7", 64.17),
            ("f2", 36.37),
            ("sf10", 28.41),
            ("sf11", 25.76),
            ("diamond", 55.3),
            ("water", 55.7),
            ("fused_quartz", 67.8),
            ("sapphire", 72.2),
        ] {
            let substance = substance(name).unwrap();
            let index = |nm| substance.dispersion.index(substance.ior, nm);
            let found = (index(587.56) - 1.0) / (index(486.13) - index(656.27));
            assert!((found / abbe - 1.0).abs() < 0.02, "{name}: {found}, known {abbe}");
        }
    }
}
