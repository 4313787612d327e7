//! How photons leave spherical, point, spot and distant lights.

use std::f64::consts::{PI, TAU};

use diacaustic_scene::LightKind;
use glam::{DVec2, DVec3};

use crate::geometry::{Ray, Sphere};
use crate::lights::{cap_height, intensity_of};
use crate::media::Media;
use crate::warp;

use super::{GuideTable, PhotonJob};

/// A caster nearer than this many sums of its radius and the light's cannot be aimed at.
const NEAREST_AIM: f64 = 1.05;

/// A disc that rays from a light to a caster cross.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AimDisc {
    /// Centre, metres.
    pub center: DVec3,
    /// Unit normal, away from the light.
    pub axis: DVec3,
    /// Radius, metres; 0 for every direction instead of a disc.
    pub radius: f64,
}

impl AimDisc {
    /// No disc, but every ray from the light.
    pub const EVERYWHERE: Self = Self { center: DVec3::ZERO, axis: DVec3::Z, radius: 0.0 };

    /// The disc about a caster's bounding sphere which covers the inner tangents of the two spheres; none if the caster
    /// comes too near the light.
    pub fn around(light: &Sphere, caster: &Sphere) -> Option<Self> {
        let to_caster = caster.center - light.center;
        let (distance, reach) = (to_caster.length(), caster.radius + light.radius);
        (distance >= NEAREST_AIM * reach).then(|| {
            let sin = reach / distance;
            Self { center: caster.center, axis: to_caster / distance, radius: caster.radius / (1.0 - sin * sin).sqrt() }
        })
    }

    /// The point where the line through `point` along `direction` crosses the disc in the sense of its axis.
    fn crossing(&self, point: DVec3, direction: DVec3) -> Option<DVec3> {
        let cos = self.axis.dot(direction);
        if cos <= 0.0 {
            return None;
        }
        let crossing = point + self.axis.dot(self.center - point) / cos * direction;
        (crossing.distance(self.center) <= self.radius).then_some(crossing)
    }
}

/// How photons are spread over the rays that leave a light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Emission<'a> {
    /// From a spherical light over the rays through these discs, of which there is at least one.
    Aimed(&'a [AimDisc]),
    /// From a point, a spot or a distant light toward these bounding spheres of casters, of which there is at least one.
    Toward(&'a [Sphere]),
}

/// A photon as it leaves its light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Start {
    pub(super) ray: Ray,
    pub(super) flux: DVec3,
}

/// A light that sends out photons.
pub(super) struct Emitter<'a> {
    source: Source<'a>,
    media: Media,
}

enum Source<'a> {
    Aimed(SphereLight, &'a [AimDisc]),
    Point(PointLight<'a>, &'a [Sphere]),
    Distant(DistantLight, &'a [Sphere]),
}

impl<'a> Emitter<'a> {
    pub(super) fn new(job: &PhotonJob<'a>) -> Self {
        let scene = job.world.scene();
        let Some(light) = scene.lights.get(job.light) else {
            panic!("photons of emissive surfaces (light {}) are not followed here", job.light)
        };
        let source = match (&light.kind, job.emission) {
            (LightKind::Sphere { .. }, Emission::Aimed(discs)) => Source::Aimed(SphereLight::new(&light.kind), discs),
            (LightKind::Point { position, .. } | LightKind::Spot { position, .. }, Emission::Toward(casters)) => {
                let point = PointLight { position: position.as_dvec3(), kind: &light.kind };
                Source::Point(point, casters)
            }
            (LightKind::Distant { .. }, Emission::Toward(casters)) => {
                Source::Distant(DistantLight::new(&light.kind, job.world.bounds()), casters)
            }
            (kind, emission) => panic!("photons of {kind:?} are not followed here with {emission:?}"),
        };
        Self { source, media: job.world.light_media(job.light) }
    }

    /// What encloses the light.
    pub(super) fn media(&self) -> Media {
        self.media
    }

    /// The photon of four emission numbers, the first two of which were moved by a table.
    pub(super) fn emit(&self, numbers: [f64; 4], aim: Option<&GuideTable>) -> Start {
        match &self.source {
            Source::Aimed(sphere, discs) => sphere.emit_aimed(discs, numbers, aim),
            Source::Point(point, casters) => point.emit(casters, numbers, aim),
            Source::Distant(distant, casters) => distant.emit(casters, numbers, aim),
        }
    }
}

/// Sum over targets of the density of a ray by one of them, given those that could have sent it with their own two numbers.
fn mixture(count: usize, aim: Option<&GuideTable>, targets: impl Iterator<Item = (usize, f64, [f64; 2])>) -> f64 {
    let one = |(k, density, [u, v]): (usize, f64, [f64; 2])| {
        density * aim.map_or(1.0, |table| table.density_at([(k as f64 + u) / count as f64, v]))
    };
    targets.map(one).sum::<f64>() / count as f64
}

/// One of `count` by a number in [0, 1), which is stretched to [0, 1) again.
fn choose(u: f64, count: usize) -> (usize, f64) {
    let scaled = u * count as f64;
    let chosen = (scaled as usize).min(count - 1);
    (chosen, scaled - chosen as f64)
}

struct SphereLight {
    sphere: Sphere,
    flux: DVec3,
}

impl SphereLight {
    fn new(kind: &LightKind) -> Self {
        let LightKind::Sphere { center, radius, flux } = *kind else { unreachable!("the caller matched a sphere") };
        let sphere = Sphere { center: center.as_dvec3(), radius: f64::from(radius) };
        Self { sphere, flux: flux.as_dvec3() }
    }

    fn emit_aimed(&self, discs: &[AimDisc], numbers: [f64; 4], aim: Option<&GuideTable>) -> Start {
        let (chosen, u) = choose(numbers[0], discs.len());
        let own = [u, numbers[1]];
        let (ray, target) = match &discs[chosen] {
            disc if disc.radius > 0.0 => self.through(disc, own, [numbers[2], numbers[3]]),
            _ => self.anywhere(own, [numbers[2], numbers[3]]),
        };
        let sent = discs.iter().enumerate().filter_map(|(k, disc)| {
            let (density, other) = self.density(disc, target, ray.direction, k == chosen)?;
            Some((k, density, if k == chosen { own } else { other }))
        });
        let density = mixture(discs.len(), aim, sent);
        let radiance = self.flux / (4.0 * PI * PI * self.sphere.radius * self.sphere.radius);
        Start { ray, flux: radiance / density }
    }

    /// The ray through a point of a disc from a point of the light, and the point of the disc.
    fn through(&self, disc: &AimDisc, [u, v]: [f64; 2], [w, z]: [f64; 2]) -> (Ray, DVec3) {
        let on_disc = warp::disc(u, v);
        let [t1, t2] = warp::frame(disc.axis);
        let target = disc.center + disc.radius * (on_disc.x * t1 + on_disc.y * t2);
        let to_light = self.sphere.center - target;
        let toward_light = warp::cone(to_light.normalize(), self.cone_height(target), w, z);
        let origin = target + self.distance_to_surface(to_light, toward_light) * toward_light;
        (Ray { origin, direction: -toward_light }, target)
    }

    /// The ray along a direction from a point of the disc that the light shows it, and where it starts.
    fn anywhere(&self, [u, v]: [f64; 2], [w, z]: [f64; 2]) -> (Ray, DVec3) {
        let direction = warp::cone(DVec3::Z, 2.0, u, v);
        let origin = self.sphere.center + self.sphere.radius * warp::cosine_hemisphere(direction, w, z);
        (Ray { origin, direction }, origin)
    }

    /// Probability density of the ray through a point by one disc, in the measure of flux: cos θ dA dω on the disc, 1/(m² sr); and
    /// the numbers that would have led the disc to it. None if the ray misses it. `hits` says that it does not.
    fn density(&self, disc: &AimDisc, on_ray: DVec3, direction: DVec3, hits: bool) -> Option<(f64, [f64; 2])> {
        if disc.radius <= 0.0 {
            let area = PI * self.sphere.radius * self.sphere.radius;
            return Some((1.0 / (4.0 * PI * area), warp::cone_inverse(DVec3::Z, 2.0, direction)));
        }
        let point = if hits { on_ray } else { disc.crossing(on_ray, direction)? };
        let area = PI * disc.radius * disc.radius;
        let solid_angle = TAU * self.cone_height(point);
        let [t1, t2] = warp::frame(disc.axis);
        let from_center = (point - disc.center) / disc.radius;
        let numbers = warp::disc_inverse(DVec2::new(from_center.dot(t1), from_center.dot(t2)));
        Some((1.0 / (area * disc.axis.dot(direction) * solid_angle), numbers))
    }

    fn cone_height(&self, point: DVec3) -> f64 {
        warp::cone_height(self.sphere.radius / point.distance(self.sphere.center))
    }

    /// How far the light's surface is along a unit vector that points at it.
    fn distance_to_surface(&self, to_center: DVec3, toward: DVec3) -> f64 {
        let along = to_center.dot(toward);
        let off_axis = to_center - along * toward;
        along - (self.sphere.radius * self.sphere.radius - off_axis.length_squared()).max(0.0).sqrt()
    }
}

/// A point or a spot.
struct PointLight<'a> {
    position: DVec3,
    kind: &'a LightKind,
}

impl PointLight<'_> {
    fn emit(&self, casters: &[Sphere], numbers: [f64; 4], aim: Option<&GuideTable>) -> Start {
        let (chosen, u) = choose(numbers[0], casters.len());
        let cones: Vec<_> = casters.iter().map(|caster| self.cone_toward(caster)).collect();
        let (axis, height) = cones[chosen];
        let direction = warp::cone(axis, height, u, numbers[1]).normalize();
        let hit = cones.iter().enumerate().filter(|(k, (axis, h))| *k == chosen || direction.dot(*axis) >= 1.0 - h);
        let sent = hit.map(|(k, &(axis, h))| {
            let other = || warp::cone_inverse(axis, h, direction);
            (k, 1.0 / (TAU * h), if k == chosen { [u, numbers[1]] } else { other() })
        });
        let density = mixture(casters.len(), aim, sent);
        let ray = Ray { origin: self.position, direction };
        Start { ray, flux: intensity_of(self.kind, direction) / density }
    }

    /// Axis and height of the cone in which a caster lies; all directions from within it.
    fn cone_toward(&self, caster: &Sphere) -> (DVec3, f64) {
        let to_caster = caster.center - self.position;
        let distance = to_caster.length();
        let height = if distance > caster.radius { warp::cone_height(caster.radius / distance) } else { 2.0 };
        (to_caster.try_normalize().unwrap_or(DVec3::Z), height)
    }
}

/// Parallel light, or a disc in the sky.
struct DistantLight {
    /// Unit direction of flight of the disc's middle.
    direction: DVec3,
    /// 1 − cos α of the disc.
    height: f64,
    /// On a surface that faces the middle, W/m².
    irradiance: DVec3,
    /// Photons start outside of it.
    bounds: Sphere,
}

impl DistantLight {
    fn new(kind: &LightKind, bounds: Sphere) -> Self {
        let LightKind::Distant { direction, angular_radius, irradiance } = *kind else {
            unreachable!("the caller matched a distant light")
        };
        Self {
            direction: direction.as_dvec3().normalize(),
            height: cap_height(angular_radius),
            irradiance: irradiance.as_dvec3(),
            bounds,
        }
    }

    fn emit(&self, casters: &[Sphere], numbers: [f64; 4], aim: Option<&GuideTable>) -> Start {
        let direction = if self.height > 0.0 {
            warp::cone(self.direction, self.height, numbers[2], numbers[3]).normalize()
        } else {
            self.direction
        };
        let (chosen, u) = choose(numbers[0], casters.len());
        let Sphere { center, radius } = casters[chosen];
        let ([t1, t2], p) = (warp::frame(direction), warp::disc(u, numbers[1]));
        let target = center + radius * (p.x * t1 + p.y * t2);
        let sent = casters.iter().enumerate().filter_map(|(k, caster)| {
            let from_center = (target - caster.center) / caster.radius;
            let across = DVec2::new(from_center.dot(t1), from_center.dot(t2));
            let numbers = if k == chosen { [u, numbers[1]] } else { warp::disc_inverse(across) };
            (k == chosen || across.length() <= 1.0).then(|| (k, 1.0 / (PI * caster.radius * caster.radius), numbers))
        });
        let density = mixture(casters.len(), aim, sent);
        let back = 2.0 * self.bounds.radius + target.distance(self.bounds.center);
        let ray = Ray { origin: target - back * direction, direction };
        // The disc's irradiance on a surface across each of its own directions: L Ω, with E = π L sin² α.
        Start { ray, flux: self.irradiance * (2.0 / (2.0 - self.height)) / density }
    }
}
