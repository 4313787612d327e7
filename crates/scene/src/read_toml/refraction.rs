//! Reads indices of refraction and how they change with the wavelength.

use glam::Vec3;

use super::table::{Entry, Table};
use crate::{
    Dispersion, Error, STATED_WAVELENGTH, SUBSTANCES, Substance,
    dispersion::{cauchy, sellmeier},
    substance,
};

/// The keys of [`read_refraction`].
pub(super) const KEYS: [&str; 6] = ["ior", "substance", "cauchy", "sellmeier", "abbe", "dispersion"];

/// What a dielectric does to light within it.
pub(super) struct Refraction {
    pub(super) ior: f32,
    pub(super) dispersion: Dispersion,
    /// Absorption coefficient, 1/m.
    pub(super) absorption: Vec3,
}

/// The index of refraction that a dielectric's table states in one of several ways.
pub(super) fn read_refraction(table: &Table<'_>) -> Result<Refraction, Error> {
    let sources = ["ior", "substance", "cauchy", "sellmeier"];
    for (number, first) in sources.iter().enumerate() {
        for second in &sources[number + 1..] {
            table.either_if_any(first, second)?;
        }
    }
    let Some(entry) = sources.iter().find_map(|key| table.get(key)) else {
        let expected = "a number, the index of refraction, or \"substance\", a name such as \"water\"";
        return Err(table.require("ior", expected).err().unwrap_or_else(|| table.error("has no index of refraction")));
    };
    let mut refraction = read_source(&entry)?;
    if let Some(abbe) = table.get("abbe") {
        if entry.key() != "ior" {
            return Err(
                abbe.error(format!("is set, and so is {}, which has its dispersion; leave one out", entry.key()))
            );
        }
        refraction.dispersion = Dispersion::Abbe(abbe.number()?);
    }
    if let Some(switch) = table.get("dispersion")
        && !switch.boolean()?
    {
        refraction.dispersion = Dispersion::None;
    }
    Ok(refraction)
}

fn read_source(entry: &Entry<'_>) -> Result<Refraction, Error> {
    let clear = |ior: f64, dispersion| Refraction { ior: ior as f32, dispersion, absorption: Vec3::ZERO };
    Ok(match entry.key() {
        "ior" => clear(f64::from(entry.number()?), Dispersion::None),
        "cauchy" => {
            let numbers = read_numbers(entry, 2..=3, "[A, B] or [A, B, C], in µm² and µm⁴")?;
            let terms = [numbers[1], numbers.get(2).copied().unwrap_or(0.0)];
            clear(f64::from(numbers[0]) + cauchy(terms, STATED_WAVELENGTH), Dispersion::Cauchy(terms))
        }
        "sellmeier" => {
            let pairs = read_sellmeier(entry)?;
            clear(sellmeier(pairs, STATED_WAVELENGTH), Dispersion::Sellmeier(pairs))
        }
        _ => {
            let Substance { ior, dispersion, absorption, .. } = read_substance(entry)?;
            Refraction { ior, dispersion, absorption }
        }
    })
}

/// The substance that an entry names.
pub(super) fn read_substance(entry: &Entry<'_>) -> Result<Substance, Error> {
    let name = entry.string("the name of a substance")?;
    let known = SUBSTANCES.map(|substance| substance.name);
    substance(name).ok_or_else(|| entry.unknown_name("substance", name, &known, "substances"))
}

fn read_sellmeier(entry: &Entry<'_>) -> Result<[[f32; 2]; 4], Error> {
    let expected = "one to four pairs [B, C], C in µm²";
    let read: Vec<Entry<'_>> = entry.elements(expected)?;
    let mut pairs = [[0.0; 2]; 4];
    if read.is_empty() || read.len() > pairs.len() {
        return Err(entry.error(format!("has {} pairs; it must be {expected}", read.len())));
    }
    for (pair, element) in pairs.iter_mut().zip(&read) {
        pair.copy_from_slice(&read_numbers(element, 2..=2, "a pair [B, C], C in µm²")?);
    }
    Ok(pairs)
}

fn read_numbers(
    entry: &Entry<'_>,
    count: std::ops::RangeInclusive<usize>,
    expected: &'static str,
) -> Result<Vec<f32>, Error> {
    let elements = entry.elements(expected)?;
    if !count.contains(&elements.len()) {
        return Err(entry.error(format!("has {} numbers; it must be {expected}", elements.len())));
    }
    elements.iter().map(Entry::number).collect()
}
