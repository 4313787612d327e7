//! Where photons are sent: what each light aims at, and the order of a block's photons.

use std::f32::consts::{PI, TAU};

use diacaustic_shaders::{AimTarget, MAX_AIM_TARGETS, light_kind};
use diacaustic_surface::{BoundingSphere, merge_spheres};
use glam::Vec3;

use crate::lights::Emitter;

/// How a light emits its photons; docs/photon-paths.md, "Emission". At most [`MAX_AIM_TARGETS`] targets.
#[derive(Clone, Debug, PartialEq)]
pub enum Emission {
    /// A sphere, toward discs that every ray from it to a caster crosses, and where casters are too near for discs to pay, in every
    /// direction: a target of radius 0.
    Aimed(Vec<AimTarget>),
    /// The light of the profile `paper`, from its position in every direction, by equation 1.
    Paper {
        /// Energy of each ray.
        energy: Vec3,
    },
    /// Any other light, toward or across bounding spheres of casters.
    Toward(Vec<AimTarget>),
}

/// The nearest that a caster's bounding sphere may come, in sums of radii, for a sphere to aim at it.
const NEAREST_AIM: f32 = 1.05;

impl Emission {
    /// How a light emits in the presence of `casters`; none if there are none.
    pub(crate) fn toward(emitter: &Emitter, casters: &[BoundingSphere]) -> Option<Self> {
        let spheres = merge_spheres(casters.to_vec(), MAX_AIM_TARGETS as usize);
        if spheres.is_empty() {
            return None;
        }
        let Some(light) = emitter.bounds.filter(|_| emitter.kind() == light_kind::SPHERE) else {
            let target = |sphere: &BoundingSphere| AimTarget {
                center: sphere.center.into(),
                radius: sphere.radius,
                ..AimTarget::default()
            };
            return Some(Self::Toward(spheres.iter().map(target).collect()));
        };
        let near = |s: &BoundingSphere| s.center.distance(light.center) < NEAREST_AIM * (s.radius + light.radius);
        let mut targets: Vec<AimTarget> =
            spheres.iter().filter(|sphere| !near(sphere)).map(|sphere| aim_disc(&light, sphere)).collect();
        if targets.len() < spheres.len() {
            targets.push(AimTarget { center: light.center.into(), axis: Vec3::Z.into(), ..AimTarget::default() });
        }
        Some(Self::Aimed(targets))
    }

    /// What the light aims at.
    pub fn targets(&self) -> &[AimTarget] {
        match self {
            Self::Aimed(targets) | Self::Toward(targets) => targets,
            Self::Paper { .. } => &[],
        }
    }

    /// The most flux that one photon carries, W, for a share 1 of all photons.
    pub(crate) fn largest_photon(&self, emitter: &Emitter) -> f32 {
        self.photon_toward(emitter, self.targets())
    }

    /// The least of the targets' largest photons over the greatest.
    pub(crate) fn photon_range(&self, emitter: &Emitter) -> f32 {
        let each = self.targets().iter().map(|target| self.photon_toward(emitter, std::slice::from_ref(target)));
        each.fold(f32::INFINITY, f32::min).min(f32::MAX) / self.largest_photon(emitter).max(f32::MIN_POSITIVE)
    }

    /// The most flux of a photon toward some of the targets.
    fn photon_toward(&self, emitter: &Emitter, some: &[AimTarget]) -> f32 {
        let count = self.targets().len() as f32;
        let widest = |one: &dyn Fn(&AimTarget) -> f32| some.iter().map(one).fold(0.0, f32::max);
        match (self, emitter.bounds) {
            (Self::Paper { energy }, _) => energy.max_element(),
            (Self::Aimed(_), Some(light)) => {
                let one = |disc: &AimTarget| {
                    if disc.radius <= 0.0 {
                        return 4.0 * (PI * light.radius).powi(2);
                    }
                    let distance = Vec3::from(disc.center).distance(light.center);
                    PI * disc.radius * disc.radius * TAU * cone_height(light.radius / distance)
                };
                emitter.peak * widest(&one) * count
            }
            (Self::Toward(_), Some(light)) => {
                let one = |sphere: &AimTarget| {
                    let distance = Vec3::from(sphere.center).distance(light.center) - light.radius;
                    TAU * if distance <= sphere.radius { 2.0 } else { cone_height(sphere.radius / distance) }
                };
                emitter.peak * widest(&one) * count
            }
            (Self::Aimed(_) | Self::Toward(_), None) => {
                emitter.peak * widest(&|sphere: &AimTarget| PI * sphere.radius * sphere.radius) * count
            }
        }
    }
}

/// 1 − cos of the cone of this sine, without cancellation.
fn cone_height(sine: f32) -> f32 {
    let sin2 = sine * sine;
    sin2 / (1.0 + (1.0 - sin2).max(0.0).sqrt())
}

/// The disc through a sphere's centre that covers the inner tangents of light and sphere.
fn aim_disc(light: &BoundingSphere, sphere: &BoundingSphere) -> AimTarget {
    let toward = sphere.center - light.center;
    let distance = toward.length();
    let sin = (light.radius + sphere.radius) / distance;
    AimTarget {
        center: sphere.center.into(),
        // The factor covers the rounding of centre and radius.
        radius: sphere.radius / (1.0 - sin * sin).sqrt() * 1.00001,
        axis: (toward / distance).into(),
        padding: 0,
    }
}

/// The longest block of photons, as a power of two.
pub(crate) const LONGEST_BLOCK: u32 = 18;
/// The shortest block whose photons are put in order, as a power of two.
const SHORTEST_ORDERED_BLOCK: u32 = 8;

/// A run of one light's photons that one dispatch takes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Block {
    pub first: u32,
    pub count: u32,
    /// Columns of the matrix from places to photons, if they are put in order.
    pub order: Option<[u32; 32]>,
}

/// Cuts photons `first..end` into blocks: aligned powers of two, but for short rests.
pub(crate) fn blocks(first: u32, end: u32) -> Vec<Block> {
    let mut list = Vec::new();
    let mut at = u64::from(first);
    let end = u64::from(end);
    while at < end {
        let aligned = if at == 0 { LONGEST_BLOCK } else { at.trailing_zeros().min(LONGEST_BLOCK) };
        let fitting = (end - at).ilog2();
        let bits = aligned.min(fitting);
        if bits >= SHORTEST_ORDERED_BLOCK {
            list.push(Block { first: at as u32, count: 1 << bits, order: Some(photon_order(bits)) });
            at += 1 << bits;
        } else {
            // Up to the next start of a block worth ordering.
            let next = (at + 1).next_multiple_of(1 << SHORTEST_ORDERED_BLOCK).min(end);
            list.push(Block { first: at as u32, count: (next - at) as u32, order: None });
            at = next;
        }
    }
    list
}

/// The matrix over GF(2) that takes a place in a block of 2^`bits` photons to a photon, so that the places follow a Z-order
/// curve over the square of the first two emission numbers. Column b belongs to bit b of the place.
///
/// The upper halves of a net's two coordinates are a one-to-one linear function of the index (Niederreiter 1992), which Owen
/// scrambling permutes within its dyadic squares; this is its inverse.
fn photon_order(bits: u32) -> [u32; 32] {
    // Row r: which index bits make the r-th digit of the Z-order curve, most significant first; beside it, the identity.
    let mut rows: Vec<(u64, u64)> = (0..bits)
        .map(|digit| {
            let row = (0..bits).fold(0u64, |row, bit| {
                let numbers = [1u32 << (31 - bit), pascal_column(bit)];
                let set = numbers[digit as usize % 2] >> (31 - digit / 2) & 1;
                row | u64::from(set) << bit
            });
            (row, 1u64 << (bits - 1 - digit))
        })
        .collect();
    for column in 0..bits as usize {
        let pivot = (column..bits as usize)
            .find(|&row| rows[row].0 >> column & 1 == 1)
            .expect("the first two Sobol' dimensions are a (0, 2)-sequence");
        rows.swap(column, pivot);
        let source = rows[column];
        for (row, entry) in rows.iter_mut().enumerate() {
            if row != column && entry.0 >> column & 1 == 1 {
                *entry = (entry.0 ^ source.0, entry.1 ^ source.1);
            }
        }
    }
    // Row i now says which place bits make index bit i.
    std::array::from_fn(|place| {
        rows.iter().enumerate().fold(0, |column, (index, row)| column | ((row.1 >> place & 1) as u32) << index)
    })
}

/// Direction number `bit` of the second Sobol' dimension.
fn pascal_column(bit: u32) -> u32 {
    (0..bit).fold(1 << 31, |v: u32, _| v ^ v >> 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_cover_every_photon_once() {
        for (first, end) in [(0, 1_000_000), (3, 700_001), (5, 6), (0, 256), (1 << 20, u32::MAX), (7, 7)] {
            let mut at = first;
            for block in blocks(first, end) {
                assert_eq!(block.first, at);
                assert!(block.count > 0 && block.count <= 1 << LONGEST_BLOCK);
                at += block.count;
            }
            assert_eq!(at, end);
        }
    }

    #[test]
    fn order_is_a_permutation_along_the_first_coordinate() {
        for bits in [8, 9, 13] {
            let order = photon_order(bits);
            let photons: Vec<u32> = (0..1u32 << bits)
                .map(|place| {
                    (0..bits).fold(0, |index, bit| index ^ if place >> bit & 1 == 1 { order[bit as usize] } else { 0 })
                })
                .collect();
            let mut sorted = photons.clone();
            sorted.sort_unstable();
            assert!(sorted.iter().copied().eq(0..1 << bits));
            // The first half of the places has the first coordinate below one half, the next digit halves the second.
            assert!(photons[..photons.len() / 2].iter().all(|index| index.reverse_bits() < 1 << 31));
            let second =
                |index: u32| (0..32).fold(0, |y, bit| y ^ if index >> bit & 1 == 1 { pascal_column(bit) } else { 0 });
            assert!(photons[..photons.len() / 4].iter().all(|&index| second(index) < 1 << 31));
        }
    }
}
