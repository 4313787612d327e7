//! Wavelengths and indices of refraction as the device knows them; docs/spectra.md.

use diacaustic_scene::{Dispersion, Scene, number_of_wavelength, wavelength_table};
use diacaustic_shaders::WAVELENGTH_STEPS;
use glam::{DVec3, Vec3};

/// The greatest factor by which one wavelength changes a channel of light.
pub(crate) fn greatest_weight(scene: &Scene) -> f32 {
    if !scene.has_dispersion() || scene.settings.wavelength.is_some() {
        return 1.0;
    }
    let weights = wavelength_table().iter().map(|entry| entry.weight.abs().max_element());
    weights.fold(1.0, f64::max) as f32
}

/// The row of a material's indices of refraction among the spectra; none without dispersion.
pub(crate) fn row_of(scene: &Scene, material: usize) -> Option<usize> {
    dispersions(scene).position(|(index, _)| index == material)
}

/// A dielectric's indices of refraction for red, green and blue light as a whole: means over the wavelengths' colours.
pub(crate) fn colored_index(ior: f32, dispersion: Dispersion) -> Vec3 {
    if dispersion.is_none() {
        return Vec3::splat(ior);
    }
    let table = wavelength_table();
    let index = |step: usize| table[step].weight * dispersion.index(ior, table[step].nm);
    let last = table.len() - 1;
    let sum = (1..last).map(index).sum::<DVec3>() + 0.5 * (index(0) + index(last));
    (sum / last as f64).as_vec3()
}

/// The record `spectra` of `shaders/layout/scene.wgsl`.
pub(crate) fn spectra_record(scene: &Scene) -> Vec<[f32; 4]> {
    let fixed = scene.settings.wavelength.map_or(-1.0, |nm| number_of_wavelength(f64::from(nm)) as f32);
    let mut record = vec![[fixed, 0.0, 0.0, 0.0]];
    if !scene.has_dispersion() {
        return record;
    }
    let table = wavelength_table();
    for entry in table {
        record.extend([entry.weight, entry.primaries].map(|color| color.as_vec3().extend(0.0).to_array()));
    }
    for (_, (ior, dispersion)) in dispersions(scene) {
        let index = |step: usize| dispersion.index(ior, table[step].nm) as f32;
        record.extend((0..WAVELENGTH_STEPS as usize).map(|step| [index(step), index(step + 1), 0.0, 0.0]));
    }
    record
}

/// The materials with dispersion, and what they do.
fn dispersions(scene: &Scene) -> impl Iterator<Item = (usize, (f32, Dispersion))> {
    let materials = scene.materials.iter().enumerate();
    materials.filter_map(|(index, material)| Some((index, material.dispersion()?)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blue_light_is_bent_most() {
        let index = colored_index(1.5168, Dispersion::Abbe(64.17));
        assert!(index.x < index.y && index.y < index.z, "{index}");
        assert!((index.y - 1.518).abs() < 1e-3 && (0.009..0.013).contains(&(index.z - index.x)), "{index}");
    }

    #[test]
    fn tables_have_the_steps_that_kernels_know() {
        assert_eq!(diacaustic_scene::WAVELENGTH_STEPS, WAVELENGTH_STEPS as usize);
    }
}
