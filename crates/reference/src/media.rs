//! Which dielectric fills the place that a ray is in.

use diacaustic_scene::{Dispersion, MaterialKind, Scene};
use glam::{DVec3, Vec3};

use crate::spectrum::{self, Spectrum};

/// The most dielectrics that a ray keeps in mind.
const CAPACITY: usize = 4;

/// The dielectrics that a ray is in: those that rank highest, at most four, one more than once where shells overlap.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Media {
    /// Ranks, the highest first; none after the last.
    ranks: [Option<u32>; CAPACITY],
}

impl Media {
    /// Air alone.
    pub const AIR: Self = Self { ranks: [None; CAPACITY] };

    /// The rank of the dielectric that fills the place; none in air.
    pub fn filling(&self) -> Option<u32> {
        self.ranks[0]
    }

    /// The list with one entry more. Of five the lowest is forgotten.
    #[must_use]
    pub fn with(self, rank: u32) -> Self {
        let mut ranks = [Some(rank); CAPACITY + 1];
        ranks[..CAPACITY].copy_from_slice(&self.ranks);
        ranks[CAPACITY] = Some(rank);
        ranks.sort_unstable_by(|a, b| b.cmp(a));
        Self { ranks: std::array::from_fn(|i| ranks[i]) }
    }

    /// The list with one entry of this rank less, if there is one.
    #[must_use]
    pub fn without(self, rank: u32) -> Self {
        let mut ranks = self.ranks;
        if let Some(first) = ranks.iter().position(|r| *r == Some(rank)) {
            ranks.copy_within(first + 1.., first);
            ranks[CAPACITY - 1] = None;
        }
        Self { ranks }
    }
}

#[derive(Clone, Copy, Debug)]
struct Dielectric {
    /// Index of refraction as stated.
    ior: f32,
    dispersion: Dispersion,
    /// 1/m.
    absorption: DVec3,
}

impl Dielectric {
    /// As stated for light of all wavelengths.
    fn ior(&self, spectrum: &Spectrum) -> f64 {
        match spectrum {
            Spectrum::Whole => f64::from(self.ior),
            Spectrum::Line(wavelength) => self.dispersion.index(self.ior, wavelength.nm),
        }
    }
}

/// The dielectrics of a scene.
#[derive(Clone, Debug)]
pub struct Dielectrics {
    by_rank: Vec<Dielectric>,
    /// For each material.
    ranks: Vec<Option<u32>>,
}

impl Dielectrics {
    /// Those of a scene.
    pub fn of(scene: &Scene) -> Self {
        let ranks: Vec<_> = (0..scene.materials.len()).map(|material| scene.dielectric_rank(material)).collect();
        let mut ranked: Vec<_> = scene
            .materials
            .iter()
            .zip(&ranks)
            .filter_map(|(material, rank)| match material.kind {
                MaterialKind::Dielectric { ior, dispersion, absorption, .. } => {
                    Some((*rank, Dielectric { ior, dispersion, absorption: absorption.as_dvec3() }))
                }
                _ => None,
            })
            .collect();
        ranked.sort_by_key(|(rank, _)| *rank);
        Self { by_rank: ranked.into_iter().map(|(_, dielectric)| dielectric).collect(), ranks }
    }

    /// The list of what encloses a point.
    pub fn around(&self, scene: &Scene, point: Vec3) -> Media {
        let ranks = scene.media_at(point).into_iter().filter_map(|material| self.ranks[material]);
        ranks.fold(Media::AIR, Media::with)
    }

    /// The list after a crossing of a material's boundary, inward where the ray comes from the front; the list itself
    /// for a material that is no dielectric.
    pub fn beyond(&self, media: Media, material: usize, front: bool) -> Media {
        match self.ranks[material] {
            Some(rank) if front => media.with(rank),
            Some(rank) => media.without(rank),
            None => media,
        }
    }

    /// Whether a boundary lies between the two lists and the index on one of its sides changes with the wavelength.
    pub fn disperse_between(&self, media: &Media, beyond: &Media) -> bool {
        media.filling() != beyond.filling()
            && [media, beyond].into_iter().filter_map(|m| self.filling(m)).any(|d| !d.dispersion.is_none())
    }

    /// Index of refraction of what fills the place; 1 in air.
    pub fn ior(&self, media: &Media, spectrum: &Spectrum) -> f64 {
        self.filling(media).map_or(1.0, |dielectric| dielectric.ior(spectrum))
    }

    /// Indices of refraction of what fills the place for red, green and blue light as a whole: means over the wavelengths' colours.
    pub fn colored_ior(&self, media: &Media) -> DVec3 {
        let index =
            |dielectric: &Dielectric| spectrum::mean_of_colors(|nm| dielectric.dispersion.index(dielectric.ior, nm));
        self.filling(media).map_or(DVec3::ONE, index)
    }

    /// σ of what fills the place, 1/m.
    pub fn absorption(&self, media: &Media, spectrum: &Spectrum) -> DVec3 {
        self.filling(media).map_or(DVec3::ZERO, |dielectric| spectrum.color(dielectric.absorption))
    }

    /// Beer and Lambert's law over a distance in metres. A flight without end loses nothing: only the hole of an open
    /// mesh lets one happen.
    pub fn transmittance(&self, media: &Media, distance: f64, spectrum: &Spectrum) -> DVec3 {
        if distance.is_finite() { (-self.absorption(media, spectrum) * distance).exp() } else { DVec3::ONE }
    }

    fn filling(&self, media: &Media) -> Option<&Dielectric> {
        media.filling().map(|rank| &self.by_rank[rank as usize])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn highest_rank_fills_the_place() {
        let media = Media::AIR.with(1).with(3).with(2).with(3);
        assert_eq!(media.filling(), Some(3));
        assert_eq!(media.without(3).filling(), Some(3));
        assert_eq!(media.without(3).without(3), Media::AIR.with(2).with(1));
        assert_eq!(Media::AIR.without(3), Media::AIR);
    }

    #[test]
    fn fifth_entry_pushes_the_lowest_out() {
        let media = Media::AIR.with(1).with(0).with(2).with(3).with(4);
        assert_eq!(media, Media::AIR.with(4).with(3).with(2).with(1));
        assert_eq!(media.without(0), media);
    }
}
