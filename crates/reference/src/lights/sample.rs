//! A light as a point sees it.

use std::f64::consts::TAU;

use diacaustic_scene::LightKind;
use glam::DVec3;

use crate::generator::Generator;
use crate::geometry::{LightShape, Ray, Sphere, Target, World};
use crate::warp;

use super::{EmissiveTriangle, cap_height, intensity_of, radiance_of};

/// One direction in which a point gets light, if nothing stands between.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LightSample {
    /// Unit vector toward the light.
    pub(crate) wi: DVec3,
    /// Metres; infinite for the sky.
    pub(crate) distance: f64,
    /// Radiance over the density of wi, or the irradiance on a surface that faces a delta light, W/m².
    pub(crate) value: DVec3,
    pub(crate) target: Target,
}

/// A sample of a light of the scene from a point; none where it is certain that nothing comes.
pub(crate) fn sample_light(
    world: &World,
    light: usize,
    point: DVec3,
    generator: &mut Generator,
) -> Option<LightSample> {
    let kind = &world.scene().lights[light].kind;
    let from_sky = |wi: DVec3, value: DVec3| LightSample { wi, distance: f64::INFINITY, value, target: Target::Place };
    Some(match *kind {
        LightKind::Sphere { .. } | LightKind::Rectangle { .. } | LightKind::Disk { .. } => {
            let radiance = radiance_of(kind);
            let shape = world.light_shapes()[light].as_ref()?;
            return match shape {
                LightShape::Sphere(sphere) => sample_sphere(sphere, radiance, point, light, generator),
                LightShape::Rectangle(_) | LightShape::Disk(_) => {
                    let (on_light, normal) = shape.sample(generator.unit(), generator.unit());
                    from_area(point, on_light, normal, shape.area() * radiance, Target::Light(light))
                }
            };
        }
        LightKind::Point { position, .. } | LightKind::Spot { position, .. } => {
            let to_light = position.as_dvec3() - point;
            let distance = to_light.length();
            let wi = to_light / distance;
            let value = intensity_of(kind, -wi) / (distance * distance);
            LightSample { wi, distance, value, target: Target::Place }
        }
        LightKind::Distant { direction, angular_radius, irradiance } => {
            let axis = -direction.as_dvec3().normalize();
            if angular_radius > 0.0 {
                let height = cap_height(angular_radius);
                let wi = warp::cone(axis, height, generator.unit(), generator.unit());
                from_sky(wi, TAU * height * radiance_of(kind))
            } else {
                from_sky(axis, irradiance.as_dvec3())
            }
        }
        LightKind::Environment { .. } => {
            let environment = world.environment()?;
            let (wi, density) = environment.sample(generator);
            from_sky(wi, environment.radiance(wi) / density)
        }
    })
}

/// A sample of all objects that shine.
pub(crate) fn sample_surfaces(world: &World, point: DVec3, generator: &mut Generator) -> Option<LightSample> {
    let (triangle, density) = world.emissive().choose(generator.unit())?;
    let barycentric = EmissiveTriangle::point(generator.unit(), generator.unit());
    let (on_light, strength) = (triangle.at(barycentric), triangle.radiance(world, barycentric) / density);
    let sample = from_area(point, on_light, triangle.normal, strength, Target::Place)?;
    // The triangle itself, and a neighbour that shares the point, do not stand in the way.
    let tolerance = world.epsilon() / -triangle.normal.dot(sample.wi).min(-1e-6);
    Some(LightSample { distance: sample.distance - tolerance, ..sample })
}

/// Uniform in the cone under which a sphere is seen. Within the sphere there is no light: it shines outward.
fn sample_sphere(
    sphere: &Sphere,
    radiance: DVec3,
    point: DVec3,
    light: usize,
    generator: &mut Generator,
) -> Option<LightSample> {
    let to_light = sphere.center - point;
    let distance = to_light.length();
    if distance <= sphere.radius {
        return None;
    }
    let height = warp::cone_height(sphere.radius / distance);
    let wi = warp::cone(to_light / distance, height, generator.unit(), generator.unit());
    // At the cone's very rim, rounding may pass the sphere by: the tangent's length serves there.
    let reach = sphere.meet(&Ray { origin: point, direction: wi }, 0.0);
    let distance = reach.map_or_else(|| to_light.dot(wi), |(reach, _)| reach);
    Some(LightSample { wi, distance, value: TAU * height * radiance, target: Target::Light(light) })
}

/// A point of a surface of `strength` radiance over density, W/sr.
fn from_area(point: DVec3, on_light: DVec3, normal: DVec3, strength: DVec3, target: Target) -> Option<LightSample> {
    let to_light = on_light - point;
    let distance = to_light.length();
    let wi = to_light / distance;
    let cos = -wi.dot(normal);
    (cos > 0.0).then(|| LightSample { wi, distance, value: cos / (distance * distance) * strength, target })
}
