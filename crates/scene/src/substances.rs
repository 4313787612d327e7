//! Indices of refraction of transparent substances.

use glam::Vec3;

/// A transparent substance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Substance {
    /// The name under which scene files refer to it.
    pub name: &'static str,
    /// Index of refraction against air for yellow light: 587.6 nm (d) or 589.3 nm (D), which differ by less than 0.0002.
    pub ior: f32,
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
    clear("air", 1.0, "by convention; 1.00027 against vacuum"),
    clear("water", 1.333, "20 °C; Daimon and Masumura 2007, Appl. Opt. 46, 3811 (1.3334 against vacuum)"),
    clear("ice", 1.3097, "−7 °C; Warren and Brandt 2008, J. Geophys. Res. 113, D14220"),
    clear("ethanol", 1.3617, "20 °C; Rheims et al. 1997, Meas. Sci. Technol. 8, 601"),
    clear("olive_oil", 1.467, "25 °C; the middle of the Merck Index's 1.466 to 1.468"),
    clear("glycerol", 1.4723, "25 °C; Rheims et al. 1997, Meas. Sci. Technol. 8, 601"),
    clear("acrylic", 1.4906, "PMMA, 20 °C; Sultanova et al. 2009, Acta Phys. Pol. A 116, 585"),
    clear("polycarbonate", 1.5848, "20 °C; Sultanova et al. 2009, Acta Phys. Pol. A 116, 585"),
    clear("fused_quartz", 1.4585, "20 °C; Malitson 1965, J. Opt. Soc. Am. 55, 1205"),
    clear("quartz", 1.5443, "crystal, ordinary ray; Ghosh 1999, Opt. Commun. 163, 95"),
    clear("crown_glass", 1.52, "a typical value; physics tables have 1.50 to 1.54"),
    clear("flint_glass", 1.62, "a typical value; Schott's F2 has 1.62004"),
    clear("bk7", 1.5168, "N-BK7; Schott data sheet"),
    clear("f2", 1.62004, "Schott data sheet"),
    clear("sf10", 1.72825, "Schott data sheet"),
    clear("sf11", 1.78472, "Schott data sheet"),
    clear("sapphire", 1.7681, "ordinary ray, 20 °C; Malitson and Dodge 1972, J. Opt. Soc. Am. 62, 1405"),
    clear("diamond", 2.4175, "Peter 1923, Z. Phys. 15, 358"),
    Substance {
        name: "amber",
        ior: 1.54,
        // Honey-coloured: a centimetre passes 0.90, 0.61 and 0.15. Amber varies from near colourless to brown.
        absorption: Vec3::new(10.0, 50.0, 190.0),
        source: "gemmological tables have 1.539 to 1.545; the absorption is chosen by eye",
    },
];

const fn clear(name: &'static str, ior: f32, source: &'static str) -> Substance {
    Substance { name, ior, absorption: Vec3::ZERO, source }
}
