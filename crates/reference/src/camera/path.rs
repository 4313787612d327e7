//! Paths from the eye.

use std::f64::consts::{FRAC_1_PI, TAU};

use diacaustic_scene::MaterialKind;
use glam::DVec3;

use crate::generator::Generator;
use crate::geometry::{Departure, Facing, Hit, Meeting, Ray, World};
use crate::snell::reflect;
use crate::specular::{absorption, scatter};
use crate::warp;

use super::direct;

/// Surfaces met before Russian roulette begins.
const ROULETTE_FROM: u32 = 16;
/// Surfaces after which a path is dropped: lossless light that is caught for good would never end otherwise.
const LONGEST_PATH: u32 = 10_000;

/// A path that grows from the eye.
struct Walk<'a> {
    world: &'a World<'a>,
    ray: Ray,
    departure: Departure,
    /// Radiance at the eye per radiance along the ray, but for the factor η².
    beta: DVec3,
    /// The product of η² over the refractions so far.
    eta_squared: f64,
    /// σ of the medium that the ray is in, 1/m; zero in the open.
    absorption: DVec3,
}

/// What stops a chain of casters.
enum ChainEnd {
    /// No surface: the background.
    Open,
    /// A light, seen from outside.
    Light(usize),
    /// A receiver.
    Receiver(Hit),
    /// Roulette, the longest path, or the dark inside of a light.
    Nothing,
}

/// One sample of the radiance that comes against a ray, W/(m² sr).
pub(super) fn radiance_along(world: &World, ray: Ray, max_bounces: u32, generator: &mut Generator) -> DVec3 {
    let mut walk = Walk::new(world, ray);
    let mut radiance = DVec3::ZERO;
    let mut surfaces = 0;
    // Diffuse vertices so far: the path has one ray more than bounces that it may use, to find caustics.
    let mut diffuse_vertices = 0;
    loop {
        let before = surfaces;
        let end = walk.follow_casters(&mut surfaces, generator);
        let bounces_left = diffuse_vertices <= max_bounces;
        match end {
            ChainEnd::Open if bounces_left => {
                return radiance + walk.throughput() * world.scene().background.as_dvec3();
            }
            // Next-event estimation owns what a diffuse vertex sees without casters between.
            ChainEnd::Light(light) if diffuse_vertices == 0 || surfaces > before => {
                return radiance + walk.throughput() * direct::radiance_of(world, light);
            }
            ChainEnd::Receiver(hit) if bounces_left => {
                surfaces += 1;
                diffuse_vertices += 1;
                radiance += walk.scatter_diffusely(&hit, generator);
                if walk.beta == DVec3::ZERO || !walk.survives(surfaces, generator) {
                    return radiance;
                }
            }
            ChainEnd::Open | ChainEnd::Light(_) | ChainEnd::Receiver(_) | ChainEnd::Nothing => return radiance,
        }
    }
}

/// One sample of the radiance that lights send against a ray through at least one caster, and nothing but casters.
pub(super) fn light_via_casters(world: &World, ray: Ray, generator: &mut Generator) -> DVec3 {
    let mut walk = Walk::new(world, ray);
    let mut casters = 0;
    match walk.follow_casters(&mut casters, generator) {
        ChainEnd::Light(light) if casters > 0 => walk.throughput() * direct::radiance_of(world, light),
        _ => DVec3::ZERO,
    }
}

impl<'a> Walk<'a> {
    fn new(world: &'a World<'a>, ray: Ray) -> Self {
        Self { world, ray, departure: Departure::Open, beta: DVec3::ONE, eta_squared: 1.0, absorption: DVec3::ZERO }
    }

    fn throughput(&self) -> DVec3 {
        self.eta_squared * self.beta
    }

    /// Goes on through casters to what stops them; counts them in `surfaces`.
    fn follow_casters(&mut self, surfaces: &mut u32, generator: &mut Generator) -> ChainEnd {
        loop {
            match self.world.meet(&self.ray, self.departure) {
                None => return ChainEnd::Open,
                Some(Meeting::Light { light, distance, outside }) => {
                    self.fly(distance);
                    return if outside { ChainEnd::Light(light) } else { ChainEnd::Nothing };
                }
                Some(Meeting::Surface(hit)) => {
                    self.fly(hit.distance);
                    if !self.world.material(hit.triangle).is_caster() {
                        return ChainEnd::Receiver(hit);
                    }
                    self.pass_caster(&hit, generator);
                    *surfaces += 1;
                    if !self.survives(*surfaces, generator) {
                        return ChainEnd::Nothing;
                    }
                }
            }
        }
    }

    /// Beer and Lambert's law over a distance in metres.
    fn fly(&mut self, distance: f64) {
        self.beta *= (-self.absorption * distance).exp();
    }

    fn facing(&self, hit: &Hit) -> Facing {
        self.world.triangles()[hit.triangle].facing(hit.barycentric, self.ray.direction)
    }

    fn pass_caster(&mut self, hit: &Hit, generator: &mut Generator) {
        let facing = self.facing(hit);
        let kind = self.world.material(hit.triangle);
        let scattered = scatter(kind, &facing, self.ray.direction, || generator.unit()).expect("every caster scatters");
        self.beta *= scattered.weight;
        self.eta_squared *= scattered.eta * scattered.eta;
        if scattered.refracted {
            self.absorption = if facing.front { absorption(kind) } else { DVec3::ZERO };
        }
        self.ray = Ray { origin: facing.point, direction: scattered.direction };
        self.departure = Departure::Triangle(hit.triangle);
    }

    /// Light that a receiver sends to the eye from the ambient term and the lights in plain sight; goes on to a
    /// direction drawn from the cosine. The cosines are to the shading normal, and both directions must be on one side
    /// of the geometric one.
    fn scatter_diffusely(&mut self, hit: &Hit, generator: &mut Generator) -> DVec3 {
        let facing = self.facing(hit);
        let receiver = Receiver::new(self.world, hit);
        let wo = -self.ray.direction;
        self.departure = Departure::Triangle(hit.triangle);
        let response = |wi: DVec3| {
            let is_above = wi.dot(facing.normal_geometric) > 0.0;
            if is_above { receiver.response(wi, wo, facing.normal_shading) } else { DVec3::ZERO }
        };
        let direct = direct::gather(self.world, facing.point, self.departure, response, generator);
        let sent = self.throughput() * (receiver.ambient + direct);
        let wi = warp::cosine_hemisphere(facing.normal_shading, generator.unit(), generator.unit());
        let is_above = wi.dot(facing.normal_geometric) > 0.0;
        self.beta *= if is_above { receiver.albedo } else { DVec3::ZERO };
        self.ray = Ray { origin: facing.point, direction: wi };
        sent
    }

    /// Russian roulette on what the path can still bring.
    fn survives(&mut self, surfaces: u32, generator: &mut Generator) -> bool {
        if surfaces < ROULETTE_FROM {
            return true;
        }
        let chance = self.beta.max_element().min(1.0);
        if surfaces >= LONGEST_PATH || generator.unit() >= chance {
            return false;
        }
        self.beta /= chance;
        true
    }
}

/// A receiver's local model.
struct Receiver {
    /// Radiance sent without regard to the lights, W/(m² sr).
    ambient: DVec3,
    /// Lambertian share of the incident flux.
    albedo: DVec3,
    specular: DVec3,
    shininess: f64,
}

impl Receiver {
    fn new(world: &World, hit: &Hit) -> Self {
        let lambertian = |albedo| Self { ambient: DVec3::ZERO, albedo, specular: DVec3::ZERO, shininess: 1.0 };
        match *world.material(hit.triangle) {
            MaterialKind::Diffuse { albedo } => lambertian(albedo.as_dvec3()),
            MaterialKind::Phong { ambient, diffuse, specular, shininess } => Self {
                ambient: (ambient * world.scene().ambient).as_dvec3(),
                albedo: diffuse.as_dvec3(),
                specular: specular.as_dvec3(),
                shininess: f64::from(shininess),
            },
            MaterialKind::Mirror { .. } | MaterialKind::Dielectric { .. } => lambertian(DVec3::ZERO),
        }
    }

    /// The BSDF toward light in plain sight times the cosine, 1/sr.
    fn response(&self, wi: DVec3, wo: DVec3, normal: DVec3) -> DVec3 {
        let cosine = wi.dot(normal).max(0.0);
        let lobe = reflect(-wi, normal).dot(wo).max(0.0).powf(self.shininess);
        cosine * (FRAC_1_PI * self.albedo + (self.shininess + 2.0) / TAU * lobe * self.specular)
    }
}
