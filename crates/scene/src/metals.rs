//! Complex indices of refraction of metals.

use glam::Vec3;

/// A metal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Metal {
    /// The name under which scene files refer to it.
    pub name: &'static str,
    /// Real part n of its index of refraction at 630, 532 and 465 nm, which stand for red, green and blue.
    pub eta: Vec3,
    /// Imaginary part k (extinction coefficient) at the same wavelengths.
    pub k: Vec3,
    /// Where the numbers come from.
    pub source: &'static str,
}

/// The metal of a name.
pub fn metal(name: &str) -> Option<Metal> {
    METALS.iter().find(|metal| metal.name == name).copied()
}

/// Every metal that has a name. The numbers are interpolated linearly between the nearest two wavelengths of the source's table.
pub const METALS: [Metal; 10] = [
    Metal {
        name: "gold",
        eta: Vec3::new(0.188, 0.544, 1.332),
        k: Vec3::new(3.403, 2.231, 1.869),
        source: NOBLE_METALS,
    },
    Metal {
        name: "silver",
        eta: Vec3::new(0.057, 0.054, 0.047),
        k: Vec3::new(4.254, 3.429, 2.803),
        source: NOBLE_METALS,
    },
    Metal {
        name: "copper",
        eta: Vec3::new(0.275, 1.116, 1.247),
        k: Vec3::new(3.373, 2.596, 2.456),
        source: NOBLE_METALS,
    },
    Metal {
        name: "brass",
        eta: Vec3::new(0.445, 0.568, 0.947),
        k: Vec3::new(3.522, 2.588, 1.920),
        source: "70 % copper, 30 % zinc; Querry 1985, Optical constants, CRDC-CR-85034",
    },
    Metal {
        name: "aluminium",
        eta: Vec3::new(1.430, 0.939, 0.686),
        k: Vec3::new(7.508, 6.420, 5.635),
        source: "Rakić 1995, Appl. Opt. 34, 4755",
    },
    Metal {
        name: "chromium",
        eta: Vec3::new(3.145, 3.034, 2.456),
        k: Vec3::new(3.312, 3.330, 3.210),
        source: TRANSITION_METALS,
    },
    Metal {
        name: "nickel",
        eta: Vec3::new(1.990, 1.877, 1.765),
        k: Vec3::new(4.094, 3.495, 3.048),
        source: TRANSITION_METALS,
    },
    Metal {
        name: "iron",
        eta: Vec3::new(2.892, 2.895, 2.646),
        k: Vec3::new(3.065, 2.918, 2.805),
        source: TRANSITION_METALS,
    },
    Metal {
        name: "titanium",
        eta: Vec3::new(2.698, 2.479, 2.305),
        k: Vec3::new(3.757, 3.351, 3.082),
        source: TRANSITION_METALS,
    },
    Metal {
        name: "platinum",
        eta: Vec3::new(2.310, 2.046, 1.887),
        k: Vec3::new(4.147, 3.602, 3.224),
        source: "Rakić et al. 1998, Appl. Opt. 37, 5271 (Lorentz–Drude fit)",
    },
];

const NOBLE_METALS: &str = "Johnson and Christy 1972, Phys. Rev. B 6, 4370";
const TRANSITION_METALS: &str = "Johnson and Christy 1974, Phys. Rev. B 9, 5056";

#[cfg(test)]
mod tests {
    use super::*;

    /// Reflectance at normal incidence.
    fn reflectance(name: &str) -> Vec3 {
        let Metal { eta, k, .. } = metal(name).unwrap();
        ((eta - 1.0) * (eta - 1.0) + k * k) / ((eta + 1.0) * (eta + 1.0) + k * k)
    }

    #[test]
    fn metals_have_their_colours() {
        let near = |name, expected: [f32; 3]| {
            let found = reflectance(name);
            assert!(found.abs_diff_eq(Vec3::from_array(expected), 0.06), "{name}: {found}");
        };
        // As tables of base colours for metals have them (Unity's and physicallybased.info's agree this well).
        near("gold", [0.96, 0.74, 0.38]);
        near("silver", [0.97, 0.96, 0.94]);
        near("copper", [0.93, 0.62, 0.54]);
        near("brass", [0.90, 0.78, 0.45]);
        near("aluminium", [0.91, 0.92, 0.92]);
        near("chromium", [0.55, 0.55, 0.55]);
        near("nickel", [0.66, 0.61, 0.53]);
        near("iron", [0.56, 0.55, 0.54]);
        near("platinum", [0.67, 0.64, 0.59]);
        let titanium = reflectance("titanium");
        assert!(titanium.cmpgt(Vec3::splat(0.45)).all() && titanium.cmplt(Vec3::splat(0.65)).all(), "{titanium}");
        let copper = reflectance("copper");
        assert!(copper.x > 0.9 && copper.x > copper.y && copper.y > copper.z, "{copper}");
        assert!(METALS.iter().all(|metal| reflectance(metal.name).max_element() < 1.0));
    }
}
