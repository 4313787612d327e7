//! Light in plain sight.

use std::f64::consts::{PI, TAU};

use diacaustic_scene::LightKind;
use glam::DVec3;

use crate::generator::Generator;
use crate::geometry::{Departure, Ray, World};
use crate::warp;

/// Radiance of a light's surface, W/(m² sr): Φ/(4π²R²) for a Lambertian sphere.
pub(super) fn radiance_of(world: &World, light: usize) -> DVec3 {
    let LightKind::Sphere { radius, flux, .. } = world.scene().lights[light].kind;
    flux.as_dvec3() / (4.0 * PI * PI * f64::from(radius) * f64::from(radius))
}

/// One sample of ∫ L f dω over the light in plain sight of a point, W/(m² sr) times the unit of `response` · sr, which
/// is the BSDF times the cosine toward a unit vector wi. A light that the point lies in gives none: it shines outward.
pub(super) fn gather(
    world: &World,
    point: DVec3,
    from: Departure,
    response: impl Fn(DVec3) -> DVec3,
    generator: &mut Generator,
) -> DVec3 {
    let mut gathered = DVec3::ZERO;
    for (light, sphere) in world.lights().iter().enumerate() {
        let to_light = sphere.center - point;
        let distance = to_light.length();
        if distance <= sphere.radius {
            continue;
        }
        let height = warp::cone_height(sphere.radius / distance);
        let wi = warp::cone(to_light / distance, height, generator.unit(), generator.unit());
        let response = response(wi);
        if response == DVec3::ZERO {
            continue;
        }
        let ray = Ray { origin: point, direction: wi };
        // At the cone's very rim, rounding may pass the sphere by: the tangent's length serves there.
        let reach = sphere.meet(&ray, 0.0).map_or_else(|| to_light.dot(wi), |(reach, _)| reach);
        if !world.occluded(&ray, reach, from, light) {
            gathered += TAU * height * radiance_of(world, light) * response;
        }
    }
    gathered
}
