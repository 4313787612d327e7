//! How light leaves.

use std::f64::consts::{PI, TAU};

use diacaustic_scene::LightKind;
use glam::DVec3;

use crate::generator::Generator;
use crate::geometry::{Departure, Ray, Sphere, World};
use crate::lights::{EmissiveTriangle, cap_height, intensity_of, radiance_of};
use crate::media::Media;
use crate::warp;

/// What sends light.
#[derive(Clone, Copy, Debug)]
pub(super) enum Source {
    /// The light of this index in the scene.
    Light(usize),
    /// All objects that shine.
    Surfaces,
}

/// Light as it leaves.
#[derive(Clone, Copy, Debug)]
pub(super) struct Start {
    pub(super) ray: Ray,
    pub(super) departure: Departure,
    pub(super) media: Media,
    /// W.
    pub(super) flux: DVec3,
}

/// A sample of a source's light, of all of it or of that on lines through a sphere; none where none leaves.
pub(super) fn emit(
    world: &World,
    source: Source,
    through: Option<&Sphere>,
    generator: &mut Generator,
) -> Option<Start> {
    let Source::Light(light) = source else { return emit_from_surfaces(world, through, generator) };
    let kind = &world.scene().lights[light].kind;
    match *kind {
        LightKind::Sphere { .. } | LightKind::Rectangle { .. } | LightKind::Disk { .. } => {
            let shape = world.light_shapes()[light].as_ref()?;
            let (origin, normal) = shape.sample(generator.unit(), generator.unit());
            let strength = shape.area() * radiance_of(kind);
            let (direction, flux) = from_surface(origin, normal, strength, through, generator)?;
            let (departure, media) = (Departure::Light(light), world.light_media(light));
            Some(Start { ray: Ray { origin, direction }, departure, media, flux })
        }
        LightKind::Point { position, .. } => {
            let media = world.light_media(light);
            Some(emit_from_point(kind, position.as_dvec3(), media, (DVec3::Z, 2.0), through, generator))
        }
        LightKind::Spot { position, direction, outer_angle, .. } => {
            let cone = (direction.as_dvec3().normalize(), cap_height(outer_angle));
            let media = world.light_media(light);
            Some(emit_from_point(kind, position.as_dvec3(), media, cone, through, generator))
        }
        LightKind::Distant { direction, angular_radius, irradiance } => {
            let flight = direction.as_dvec3().normalize();
            if angular_radius == 0.0 {
                return Some(emit_from_sky(world, flight, irradiance.as_dvec3(), through, generator));
            }
            let height = cap_height(angular_radius);
            let direction = warp::cone(flight, height, generator.unit(), generator.unit()).normalize();
            Some(emit_from_sky(world, direction, TAU * height * radiance_of(kind), through, generator))
        }
        LightKind::Environment { .. } => {
            let environment = world.environment()?;
            let (wi, density) = environment.sample(generator);
            Some(emit_from_sky(world, -wi, environment.radiance(wi) / density, through, generator))
        }
    }
}

fn emit_from_surfaces(world: &World, through: Option<&Sphere>, generator: &mut Generator) -> Option<Start> {
    let (triangle, density) = world.emissive().choose(generator.unit())?;
    let barycentric = EmissiveTriangle::point(generator.unit(), generator.unit());
    let (origin, strength) = (triangle.at(barycentric), triangle.radiance(world, barycentric) / density);
    let (direction, flux) = from_surface(origin, triangle.normal, strength, through, generator)?;
    let departure = Departure::Triangle(triangle.triangle);
    Some(Start { ray: Ray { origin, direction }, departure, media: triangle.media, flux })
}

/// A direction from a Lambertian surface, and the flux along it: `strength` is radiance over the density of points, W/sr.
fn from_surface(
    origin: DVec3,
    normal: DVec3,
    strength: DVec3,
    through: Option<&Sphere>,
    generator: &mut Generator,
) -> Option<(DVec3, DVec3)> {
    let Some(sphere) = through else {
        let direction = warp::cosine_hemisphere(normal, generator.unit(), generator.unit()).normalize();
        return Some((direction, PI * strength));
    };
    let (axis, height) = cone_toward(sphere, origin);
    let direction = warp::cone(axis, height, generator.unit(), generator.unit()).normalize();
    let cos = direction.dot(normal);
    (cos > 0.0).then(|| (direction, TAU * height * cos * strength))
}

/// Light of a point, within `cone` (axis and height) if it need not pass a sphere.
fn emit_from_point(
    kind: &LightKind,
    origin: DVec3,
    media: Media,
    cone: (DVec3, f64),
    through: Option<&Sphere>,
    generator: &mut Generator,
) -> Start {
    let (axis, height) = through.map_or(cone, |sphere| cone_toward(sphere, origin));
    let direction = warp::cone(axis, height, generator.unit(), generator.unit()).normalize();
    let flux = TAU * height * intensity_of(kind, direction);
    Start { ray: Ray { origin, direction }, departure: Departure::Open, media, flux }
}

/// Light of one direction of flight over the disc across it that covers the sphere, or the scene.
fn emit_from_sky(
    world: &World,
    direction: DVec3,
    irradiance: DVec3,
    through: Option<&Sphere>,
    generator: &mut Generator,
) -> Start {
    let bounds = world.bounds();
    let sphere = through.unwrap_or(&bounds);
    let ([t1, t2], p) = (warp::frame(direction), warp::disc(generator.unit(), generator.unit()));
    let target = sphere.center + sphere.radius * (p.x * t1 + p.y * t2);
    let origin = target - (2.0 * bounds.radius + target.distance(bounds.center)) * direction;
    let flux = PI * sphere.radius * sphere.radius * irradiance;
    Start { ray: Ray { origin, direction }, departure: Departure::Open, media: Media::AIR, flux }
}

/// Axis and height of the cone in which a point sees a sphere; all directions from within it.
fn cone_toward(sphere: &Sphere, point: DVec3) -> (DVec3, f64) {
    let to_center = sphere.center - point;
    let distance = to_center.length();
    if distance <= sphere.radius {
        return (DVec3::Z, 2.0);
    }
    (to_center / distance, warp::cone_height(sphere.radius / distance))
}
