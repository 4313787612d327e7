//! Paths from the eye.

use glam::DVec3;

use crate::bsdf::{Crossing, Draw, Outcome, Surface};
use crate::generator::Generator;
use crate::geometry::{Departure, Facing, Hit, Meeting, Ray, World};
use crate::lights;
use crate::media::Media;
use crate::roulette;
use crate::spectrum::Spectrum;

use super::direct::{self, Vertex};
use super::receiver::Receiver;

/// A path that grows from the eye.
struct Walk<'a> {
    world: &'a World<'a>,
    ray: Ray,
    departure: Departure,
    /// What the ray is in.
    media: Media,
    /// What `beta` and the light that is found stand for.
    spectrum: Spectrum,
    /// What the eye is in, if its index squared divides the radiance; else air.
    around_eye: Media,
    /// Radiance at the eye per radiance along the ray, but for the factor η².
    beta: DVec3,
    /// The product of η² over the refractions so far.
    eta_squared: f64,
    /// Surfaces met.
    surfaces: u32,
    /// Whether light that the ray meets counts: not where next-event estimation at a receiver owns it.
    counts_light: bool,
    /// What has been found, W/(m² sr).
    radiance: DVec3,
}

/// What stops a chain of casters.
#[expect(clippy::large_enum_variant, reason = "one lives at a time")]
enum ChainEnd {
    /// No surface: the sky.
    Open,
    /// A receiver, or the base of a caster.
    Receiver(Receiver),
    /// A light, roulette, or the longest path.
    Nothing,
}

/// One sample of the radiance that comes against a ray that starts in `media`, W/(m² sr).
pub(super) fn radiance_along(
    world: &World,
    ray: Ray,
    media: Media,
    max_bounces: u32,
    generator: &mut Generator,
) -> DVec3 {
    let mut walk = Walk { around_eye: media, ..Walk::new(world, ray, media, true) };
    // Diffuse vertices so far: the path has one ray more than bounces that it may use, to find caustics.
    let mut diffuse_vertices = 0;
    loop {
        let end = walk.follow_casters(generator);
        let bounces_left = diffuse_vertices <= max_bounces;
        match end {
            ChainEnd::Open if bounces_left => {
                walk.find_light(world.scene().background.as_dvec3());
                return walk.radiance;
            }
            ChainEnd::Receiver(receiver) if bounces_left => {
                diffuse_vertices += 1;
                walk.scatter_at(&receiver, generator);
                if !walk.survives(generator) {
                    return walk.radiance;
                }
            }
            ChainEnd::Open | ChainEnd::Receiver(_) | ChainEnd::Nothing => return walk.radiance,
        }
    }
}

/// One sample of the radiance that lights send against a ray through at least one caster, and nothing but casters.
pub(super) fn light_via_casters(world: &World, ray: Ray, media: Media, generator: &mut Generator) -> DVec3 {
    let mut walk = Walk::new(world, ray, media, false);
    walk.follow_casters(generator);
    walk.radiance
}

impl<'a> Walk<'a> {
    fn new(world: &'a World<'a>, ray: Ray, media: Media, counts_light: bool) -> Self {
        Self {
            world,
            ray,
            departure: Departure::Open,
            media,
            spectrum: world.spectrum(),
            around_eye: Media::AIR,
            beta: DVec3::ONE,
            eta_squared: 1.0,
            surfaces: 0,
            counts_light,
            radiance: DVec3::ZERO,
        }
    }

    /// Counts a light's radiance, of a colour, that comes against the ray.
    fn find_light(&mut self, radiance: DVec3) {
        self.find(self.spectrum.color(radiance));
    }

    /// Counts radiance of the path's spectrum that comes against the ray.
    fn find(&mut self, radiance: DVec3) {
        self.radiance += self.eta_squared * self.beta * radiance;
    }

    /// Goes on through casters to what stops them, and counts the lights on the way.
    fn follow_casters(&mut self, generator: &mut Generator) -> ChainEnd {
        loop {
            match self.world.meet(&self.ray, self.departure) {
                None => {
                    if self.counts_light {
                        self.find_light(lights::sky(self.world, self.ray.direction));
                    }
                    return ChainEnd::Open;
                }
                Some(Meeting::Light { light, distance, front }) => {
                    self.fly(distance);
                    if self.counts_light && front {
                        self.find_light(lights::radiance_of(&self.world.scene().lights[light].kind));
                    }
                    return ChainEnd::Nothing;
                }
                Some(Meeting::Surface(hit)) => {
                    self.fly(hit.distance);
                    if let Some(receiver) = self.meet_surface(&hit, generator) {
                        return ChainEnd::Receiver(receiver);
                    }
                    if !self.survives(generator) {
                        return ChainEnd::Nothing;
                    }
                }
            }
        }
    }

    fn fly(&mut self, distance: f64) {
        self.beta *= self.world.dielectrics().transmittance(&self.media, distance, &self.spectrum);
    }

    /// Passes a caster, or says what receives.
    fn meet_surface(&mut self, hit: &Hit, generator: &mut Generator) -> Option<Receiver> {
        let hit = &self.world.taken(hit, || generator.unit());
        let facing = self.world.facing(hit, self.ray.direction);
        self.surfaces += 1;
        self.departure = Departure::Triangle(hit.triangle);
        self.ray.origin = facing.point;
        if self.counts_light && facing.front {
            self.find_light(self.world.emission(hit.triangle, hit.barycentric));
        }
        if self.spectrum == Spectrum::Whole && Crossing::disperses(self.world, hit, &facing, self.media) {
            self.disperse(generator.unit());
        }
        match Crossing::of(self.world, hit, &facing, self.media, self.spectrum) {
            Crossing::Nothing(media) => {
                self.media = media;
                self.counts_light = true;
                None
            }
            Crossing::Surface(surface, _) if !surface.is_caster() => {
                Receiver::of(surface, facing, -self.ray.direction, true)
            }
            Crossing::Surface(surface, beyond) => self.pass_caster(&surface, &facing, beyond, generator),
        }
    }

    /// Takes the wavelength of a number. The eye's radiance is divided by the square of the index for all light, which the
    /// one at the wavelength replaces.
    fn disperse(&mut self, number: f64) {
        let before = self.ior_around_eye();
        (self.spectrum, self.beta) = Spectrum::drawn(number, self.beta);
        self.eta_squared *= (before / self.ior_around_eye()).powi(2);
    }

    fn ior_around_eye(&self) -> f64 {
        self.world.dielectrics().ior(&self.around_eye, &self.spectrum)
    }

    fn pass_caster(
        &mut self,
        surface: &Surface,
        facing: &Facing,
        beyond: Media,
        generator: &mut Generator,
    ) -> Option<Receiver> {
        let wo = -self.ray.direction;
        if surface.is_rough() {
            let vertex = self.vertex(facing, beyond);
            let found = direct::gather_delta(self.world, &vertex, |wi| surface.gloss(facing, wo, wi), generator);
            self.find(found);
        }
        let draw = || Draw { choice: generator.unit(), microfacet: [generator.unit(), generator.unit()] };
        match surface.scatter(facing, self.ray.direction, draw) {
            Outcome::Passed(scattered) => {
                self.beta *= scattered.weight;
                self.eta_squared *= scattered.eta * scattered.eta;
                self.ray.direction = scattered.direction;
                self.counts_light = true;
                if scattered.transmitted {
                    self.media = beyond;
                }
                None
            }
            Outcome::Base(weight) => {
                self.beta *= weight;
                Receiver::of(*surface, *facing, wo, false)
            }
            Outcome::Lost => {
                self.beta = DVec3::ZERO;
                None
            }
        }
    }

    /// Counts what the ambient term and all light in plain sight send to the eye, and goes on along one of the
    /// receiver's lobes.
    fn scatter_at(&mut self, receiver: &Receiver, generator: &mut Generator) {
        let vertex = self.vertex(receiver.facing(), self.media);
        let direct = direct::gather(self.world, &vertex, |wi| receiver.response(wi), generator);
        self.find(receiver.ambient() + direct);
        let (direction, weight) = receiver.sample(generator);
        self.beta *= weight;
        self.ray.direction = direction;
        self.counts_light = false;
    }

    fn vertex(&self, facing: &Facing, beyond: Media) -> Vertex {
        Vertex {
            point: facing.point,
            departure: self.departure,
            normal: facing.normal_geometric,
            media: [self.media, beyond],
            spectrum: self.spectrum,
        }
    }

    fn survives(&mut self, generator: &mut Generator) -> bool {
        roulette::survives(&mut self.beta, self.surfaces, generator)
    }
}
