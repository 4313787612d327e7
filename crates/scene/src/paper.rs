//! The model of light of the 2016 paper, in place of the physical one.

use std::f32::consts::PI;

use glam::{Vec3, Vec3A};

use crate::Object;

/// How light is sent, refracted and kept in the profile `paper`: the model of Liliana, Yoewono and Intan (*Transparency modeling for mesh
/// object using ray tracing*, 2016), as `docs/paper.md` defines it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PaperProfile {
    /// Energy of each ray from the light, per channel, ≥ 0, whatever their number.
    pub energy: Vec3,
    /// How rays turn at glass.
    pub refraction: PaperRefraction,
    /// How the rays' directions are chosen.
    pub sampling: PaperSampling,
    /// The axis of the light's sphere, on which angle φ is ±90°, of any length > 0.
    pub pole: Vec3,
    /// The size of energy maps: of one, and the number that its sums are divided by.
    pub map_size: PaperMapSize,
    /// Share of energy and of colour that passes at each crossing of a dielectric's surface, 0 to 1, beside its tint. The camera sees the rest
    /// of an object's tint under ambient light, added to what lies behind.
    pub transparency: f32,
}

/// How rays turn at glass.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PaperRefraction {
    /// By equation 3 as printed: tan θt = n tan θi, and no total reflection.
    #[default]
    Printed,
    /// By Snell's law, with total reflection.
    Exact,
}

/// How the rays' angles θ and φ of equation 1 are chosen.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PaperSampling {
    /// √N of each, at even steps: the number N of rays must be a square.
    #[default]
    Grid,
    /// At random, evenly and independently.
    Random,
}

/// What the paper's size of a map counts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PaperMapSize {
    /// Texels along the longer side.
    Texels(u32),
    /// The distance between texels, millimetres, > 0.
    Millimetres(f32),
}

impl PaperMapSize {
    /// The number that sums are divided by.
    pub fn divisor(self) -> f64 {
        match self {
            Self::Texels(texels) => f64::from(texels),
            Self::Millimetres(distance) => f64::from(distance),
        }
    }

    /// Texels along the longer side of an object's map: the longest side of the mesh's box, as placed, over their distance.
    pub fn texels(self, object: &Object) -> u32 {
        match self {
            Self::Texels(texels) => texels,
            // A conversion of what is too large gives the greatest number.
            Self::Millimetres(distance) => (longest_side(object) / (0.001 * distance)).round() as u32 + 1,
        }
    }
}

/// The longest side of a mesh's bounding box as placed in the world, metres.
fn longest_side(object: &Object) -> f32 {
    let positions = object.mesh.positions.iter().map(|&position| Vec3A::from(position));
    let (low, high) = positions
        .fold((Vec3A::INFINITY, Vec3A::NEG_INFINITY), |(low, high), position| (low.min(position), high.max(position)));
    let sides = object.world_from_object.matrix3 * glam::Mat3A::from_diagonal((high - low).into());
    [sides.x_axis, sides.y_axis, sides.z_axis].map(Vec3A::length).into_iter().fold(0.0, f32::max)
}

/// Density of the directions that equation 1 draws from even θ and φ, at angle φ (radians) off the equator, 1/sr: 1/(2π² cos φ).
pub fn paper_direction_density(phi: f32) -> f32 {
    1.0 / (2.0 * PI * PI * phi.cos())
}
