//! Emitters.

use std::{f32::consts::PI, sync::Arc};

use glam::Vec3;

use crate::RadianceMap;

/// A named emitter. Surfaces of objects shine as well: [`Material::emission`](crate::Material::emission).
#[derive(Clone, Debug, PartialEq)]
pub struct Light {
    /// Its name in statistics and messages.
    pub name: String,
    /// Its shape and power.
    pub kind: LightKind,
    /// Its share of all photons, against the sum of the shares of all lights; 1 to 1000. It changes noise, not brightness.
    pub photon_share: u32,
    /// The group of lights in whose layers its light is kept; that of all lights that name none, if none.
    pub group: Option<String>,
}

/// The shapes of emitters. Angles are degrees; `flux` is radiant flux Φ, W per channel, ≥ 0.
#[derive(Clone, Debug, PartialEq)]
pub enum LightKind {
    /// A sphere that radiates evenly from each point in each direction (Lambertian); its own surface reflects nothing.
    Sphere {
        /// Centre, metres, world frame.
        center: Vec3,
        /// Radius, metres, > 0.
        radius: f32,
        /// Radiant flux.
        flux: Vec3,
    },
    /// A Lambertian rectangle that shines from its front, the side of `edge_u` × `edge_v`; black on both sides.
    Rectangle {
        /// Centre, metres, world frame.
        center: Vec3,
        /// One whole edge, metres.
        edge_u: Vec3,
        /// The other, perpendicular to the first.
        edge_v: Vec3,
        /// Radiant flux.
        flux: Vec3,
    },
    /// A Lambertian disk that shines from its front, the side of `normal`; black on both sides.
    Disk {
        /// Centre, metres, world frame.
        center: Vec3,
        /// The direction that it faces, of any length > 0.
        normal: Vec3,
        /// Radius, metres, > 0.
        radius: f32,
        /// Radiant flux.
        flux: Vec3,
    },
    /// A point that shines evenly in each direction; the camera cannot see it.
    Point {
        /// Position, metres, world frame.
        position: Vec3,
        /// Radiant flux.
        flux: Vec3,
    },
    /// A point that shines into a cone; the camera cannot see it. The intensity falls from the inner to the outer angle as
    /// 3t² − 2t³, t = (cos θ − cos outer)/(cos inner − cos outer).
    Spot {
        /// Position, metres, world frame.
        position: Vec3,
        /// The cone's axis, of any length > 0.
        direction: Vec3,
        /// Angle off the axis up to which the intensity is full, from 0 to `outer_angle`.
        inner_angle: f32,
        /// Angle off the axis beyond which there is no light, greater than `inner_angle`, at most 180.
        outer_angle: f32,
        /// Radiant flux, within the whole cone.
        flux: Vec3,
    },
    /// Light from infinitely far: parallel, or from a disc of even radiance in the sky such as the sun's.
    Distant {
        /// The direction in which the light flies, of any length > 0.
        direction: Vec3,
        /// Radius of the disc in the sky, from 0 (parallel light, which the camera cannot see) to less than 90.
        angular_radius: f32,
        /// Irradiance on a surface that faces the light, W/m² per channel, ≥ 0.
        irradiance: Vec3,
    },
    /// Light from everywhere: a picture of what lies beyond every object. A scene has at most one.
    Environment {
        /// The radiance.
        map: Arc<RadianceMap>,
        /// Angle by which the picture is turned about +y.
        rotate: f32,
        /// Factor on its radiance, per channel, ≥ 0.
        scale: Vec3,
    },
}

impl LightKind {
    /// Whether the light sends nothing.
    pub fn is_dark(&self) -> bool {
        match self {
            Self::Sphere { flux, .. }
            | Self::Rectangle { flux, .. }
            | Self::Disk { flux, .. }
            | Self::Point { flux, .. }
            | Self::Spot { flux, .. } => *flux == Vec3::ZERO,
            Self::Distant { irradiance, .. } => *irradiance == Vec3::ZERO,
            Self::Environment { map, scale, .. } => map.is_dark() || *scale == Vec3::ZERO,
        }
    }

    /// The radiometric quantity that describes the light where it shines fullest, per channel: radiance, W/(m² sr), of a sphere
    /// Φ/(4π²R²), of a rectangle or disk Φ/(πA), of a distant disc E/(π sin²α), of an environment the factor `scale`; intensity,
    /// W/sr, of a point Φ/4π and of a spot Φ/(2π(1 − (cos inner + cos outer)/2)); irradiance, W/m², of parallel light.
    pub fn strength(&self) -> Vec3 {
        match *self {
            Self::Sphere { radius, flux, .. } => flux / (4.0 * PI * PI * radius * radius),
            Self::Rectangle { edge_u, edge_v, flux, .. } => flux / (PI * edge_u.cross(edge_v).length()),
            Self::Disk { radius, flux, .. } => flux / (PI * PI * radius * radius),
            Self::Point { flux, .. } => flux / (4.0 * PI),
            Self::Spot { inner_angle, outer_angle, flux, .. } => {
                // 1 − (a + b)/2 as a sum of squares, without cancellation for narrow cones.
                let half_sine2 = |angle: f32| (0.5 * angle.to_radians()).sin().powi(2);
                flux / (2.0 * PI * (half_sine2(inner_angle) + half_sine2(outer_angle)))
            }
            Self::Distant { angular_radius, irradiance, .. } if angular_radius > 0.0 => {
                irradiance / (PI * angular_radius.to_radians().sin().powi(2))
            }
            Self::Distant { irradiance, .. } => irradiance,
            Self::Environment { scale, .. } => scale,
        }
    }
}
