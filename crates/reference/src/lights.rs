//! What lights send, and how points see them.

mod emissive;
mod environment;
mod sample;

use std::f64::consts::PI;

use diacaustic_scene::LightKind;
use glam::{DVec3, Vec3};

use crate::geometry::World;

pub(crate) use self::emissive::{EmissiveSurfaces, EmissiveTriangle};
pub(crate) use self::environment::Environment;
pub(crate) use self::sample::{LightSample, sample_light, sample_surfaces};

/// Radiance of a light that has an extent and is no environment, W/(m² sr); zero for the others.
pub(crate) fn radiance_of(kind: &LightKind) -> DVec3 {
    match *kind {
        LightKind::Sphere { radius, flux, .. } => flux.as_dvec3() / (4.0 * PI * PI * f64::from(radius).powi(2)),
        LightKind::Rectangle { edge_u, edge_v, flux, .. } => {
            flux.as_dvec3() / (PI * edge_u.as_dvec3().cross(edge_v.as_dvec3()).length())
        }
        LightKind::Disk { radius, flux, .. } => flux.as_dvec3() / (PI * PI * f64::from(radius).powi(2)),
        LightKind::Distant { angular_radius, irradiance, .. } if angular_radius > 0.0 => {
            irradiance.as_dvec3() / (PI * f64::from(angular_radius).to_radians().sin().powi(2))
        }
        LightKind::Distant { .. }
        | LightKind::Point { .. }
        | LightKind::Spot { .. }
        | LightKind::Environment { .. } => DVec3::ZERO,
    }
}

/// The point of a light at which it is known what encloses it; none for the sky, which lies in air.
pub(crate) fn position_of(kind: &LightKind) -> Option<Vec3> {
    match *kind {
        LightKind::Sphere { center, .. } | LightKind::Rectangle { center, .. } | LightKind::Disk { center, .. } => {
            Some(center)
        }
        LightKind::Point { position, .. } | LightKind::Spot { position, .. } => Some(position),
        LightKind::Distant { .. } | LightKind::Environment { .. } => None,
    }
}

/// Intensity of a point or a spot toward a unit vector, W/sr; zero for the others.
pub(crate) fn intensity_of(kind: &LightKind, toward: DVec3) -> DVec3 {
    match *kind {
        LightKind::Point { flux, .. } => flux.as_dvec3() / (4.0 * PI),
        LightKind::Spot { direction, inner_angle, outer_angle, flux, .. } => {
            let [inner, outer] = [inner_angle, outer_angle].map(|angle| f64::from(angle).to_radians().cos());
            let cos = toward.dot(direction.as_dvec3().normalize());
            let t = ((cos - outer) / (inner - outer)).clamp(0.0, 1.0);
            t * t * (3.0 - 2.0 * t) * flux.as_dvec3() / (2.0 * PI * (1.0 - 0.5 * (inner + outer)))
        }
        _ => DVec3::ZERO,
    }
}

/// 1 − cos α of an angle in degrees, without cancellation for small ones.
pub(crate) fn cap_height(angle: f32) -> f64 {
    2.0 * (0.5 * f64::from(angle).to_radians()).sin().powi(2)
}

/// Whether all of a light's rays through a point have one direction, so that no path from the eye meets it.
pub(crate) fn is_delta(kind: &LightKind) -> bool {
    match *kind {
        LightKind::Point { .. } | LightKind::Spot { .. } => true,
        LightKind::Distant { angular_radius, .. } => angular_radius == 0.0,
        LightKind::Sphere { .. }
        | LightKind::Rectangle { .. }
        | LightKind::Disk { .. }
        | LightKind::Environment { .. } => false,
    }
}

/// What the lights of the sky, distant discs and the environment, send against a direction of flight, W/(m² sr); the
/// constant background is not in it.
pub(crate) fn sky(world: &World, direction: DVec3) -> DVec3 {
    let discs = world.scene().lights.iter().map(|light| match light.kind {
        LightKind::Distant { direction: flight, angular_radius, .. } if angular_radius > 0.0 => {
            let height = 1.0 + direction.dot(flight.as_dvec3().normalize());
            if height <= cap_height(angular_radius) { radiance_of(&light.kind) } else { DVec3::ZERO }
        }
        _ => DVec3::ZERO,
    });
    discs.sum::<DVec3>() + world.environment().map_or(DVec3::ZERO, |environment| environment.radiance(direction))
}
