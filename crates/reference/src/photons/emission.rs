//! How photons leave a spherical light.

use std::f64::consts::{PI, TAU};

use diacaustic_scene::LightKind;
use glam::DVec3;

use crate::geometry::{Ray, Sphere};
use crate::random::PhotonNumbers;
use crate::warp;

use super::PhotonJob;

/// A caster nearer than this many sums of its radius and the light's cannot be aimed at.
const NEAREST_AIM: f64 = 1.05;

/// A disc that rays from a light to a caster cross.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AimDisc {
    /// Centre, metres.
    pub center: DVec3,
    /// Unit normal, away from the light.
    pub axis: DVec3,
    /// Radius, metres.
    pub radius: f64,
}

impl AimDisc {
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
    /// Over the rays through these discs, of which there is at least one.
    Aimed(&'a [AimDisc]),
    /// Over all of them.
    Unaimed,
}

/// A photon as it leaves its light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Start {
    pub(super) ray: Ray,
    pub(super) flux: DVec3,
}

/// A light that sends out photons.
pub(super) struct Emitter<'a> {
    sphere: Sphere,
    flux: DVec3,
    emission: Emission<'a>,
}

impl<'a> Emitter<'a> {
    pub(super) fn new(job: &PhotonJob<'a>) -> Self {
        let LightKind::Sphere { flux, .. } = job.world.scene().lights[job.light].kind;
        Self { sphere: job.world.lights()[job.light], flux: flux.as_dvec3(), emission: job.emission }
    }

    pub(super) fn emit(&self, numbers: &PhotonNumbers) -> Start {
        match self.emission {
            Emission::Aimed(discs) => self.emit_aimed(discs, numbers),
            Emission::Unaimed => self.emit_unaimed(numbers),
        }
    }

    fn emit_aimed(&self, discs: &[AimDisc], numbers: &PhotonNumbers) -> Start {
        let count = discs.len();
        let scaled = numbers.emission(0) * count as f64;
        let chosen = (scaled as usize).min(count - 1);
        let AimDisc { center, axis, radius } = discs[chosen];
        let on_disc = warp::disc(scaled - chosen as f64, numbers.emission(1));
        let [t1, t2] = warp::frame(axis);
        let target = center + radius * (on_disc.x * t1 + on_disc.y * t2);

        let to_light = self.sphere.center - target;
        let distance = to_light.length();
        let height = self.cone_height(target);
        let toward_light = warp::cone(to_light / distance, height, numbers.emission(2), numbers.emission(3));
        let origin = target + self.distance_to_surface(to_light, toward_light) * toward_light;

        let direction = -toward_light;
        let density: f64 = discs
            .iter()
            .enumerate()
            .filter_map(|(k, disc)| {
                let crossing = if k == chosen { Some(target) } else { disc.crossing(target, direction) };
                crossing.map(|point| self.density(disc, point, direction) / count as f64)
            })
            .sum();
        let radiance = self.flux / (4.0 * PI * PI * self.sphere.radius * self.sphere.radius);
        Start { ray: Ray { origin, direction }, flux: radiance / density }
    }

    /// Probability density of a ray by one disc, in the measure of flux: cos θ dA dω on the disc, 1/(m² sr).
    fn density(&self, disc: &AimDisc, point: DVec3, direction: DVec3) -> f64 {
        let area = PI * disc.radius * disc.radius;
        let solid_angle = TAU * self.cone_height(point);
        1.0 / (area * disc.axis.dot(direction) * solid_angle)
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

    fn emit_unaimed(&self, numbers: &PhotonNumbers) -> Start {
        let n = warp::cone(DVec3::Z, 2.0, numbers.emission(2), numbers.emission(3));
        let direction = warp::cosine_hemisphere(n, numbers.emission(0), numbers.emission(1));
        let origin = self.sphere.center + self.sphere.radius * n;
        Start { ray: Ray { origin, direction }, flux: self.flux }
    }
}
