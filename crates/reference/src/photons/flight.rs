//! A photon's way from the light to its end.

use glam::DVec3;

use crate::bsdf::{Crossing, Draw, Outcome, SHADING_NORMAL_LIMIT, Surface};
use crate::fresnel;
use crate::geometry::{Departure, Facing, Hit, Meeting, Ray};
use crate::media::Media;
use crate::random::PhotonNumbers;
use crate::spectrum::Spectrum;

use super::emission::{Emitter, Start};
use super::{Landing, Ledger, PhotonJob};

/// What happened to a photon at a surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Event {
    /// It was reflected.
    Reflected,
    /// It crossed the boundary between two media.
    Refracted,
    /// It went straight on: through a thin wall, or a boundary that does not exist.
    Passed,
    /// It was reflected or refracted to the wrong side of a rough surface, and lost.
    Shadowed,
    /// It ended on a receiver.
    Received,
}

/// A surface point on a photon's path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vertex {
    /// The point, metres.
    pub position: DVec3,
    /// Index of the triangle in [`World::triangles`](crate::geometry::World::triangles).
    pub triangle: usize,
    /// What happened there.
    pub event: Event,
    /// Flux after it, W; on a receiver, the flux that its base takes or that is deposited.
    pub flux: DVec3,
}

/// How a path ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum End {
    /// On a receiver, after a caster.
    Deposited(Landing),
    /// On a receiver, straight from the light.
    Direct(Landing),
    /// On the light of this index.
    Absorbed(usize),
    /// On a rough surface, whose microfacet sent it to the wrong side.
    Shadowed,
    /// Out of the scene.
    Escaped,
    /// After the greatest number of surfaces that a path may meet.
    CutOff,
}

/// All that happened to a photon.
#[derive(Clone, Debug, PartialEq)]
pub struct PhotonPath {
    /// Where on the light it started, and which way.
    pub start: Ray,
    /// Flux at the start, W.
    pub flux: DVec3,
    /// The surfaces that it met, in order.
    pub vertices: Vec<Vertex>,
    /// How it ended.
    pub end: End,
    /// Direction of its last flight, unit length.
    pub direction: DVec3,
    /// What its flux stands for at the end.
    pub spectrum: Spectrum,
    /// Where its flux went, W.
    pub ledger: Ledger,
}

/// A photon on its way.
struct Flight<'a> {
    job: &'a PhotonJob<'a>,
    numbers: PhotonNumbers,
    ray: Ray,
    departure: Departure,
    flux: DVec3,
    spectrum: Spectrum,
    /// v, the number of its wavelength.
    wavelength_number: f64,
    /// What it is in.
    media: Media,
    vertices: Vec<Vertex>,
    ledger: Ledger,
}

pub(super) fn fly(job: &PhotonJob, emitter: &Emitter, photon: u32) -> PhotonPath {
    let numbers = PhotonNumbers::new(job.seed, job.light as u32, photon);
    let numbers = if job.world.has_dispersion() { numbers.with_wavelength() } else { numbers };
    let drawn = [0, 1, 2, 3].map(|dimension| numbers.emission(dimension));
    let (moved, density) = job.guide.map_or((drawn, 1.0), |guide| guide.move_numbers(drawn));
    let Start { ray, flux } = emitter.emit(moved, job.guide.map(|guide| &guide.aim));
    let wavelength_number = numbers.wavelength();
    let spectrum = job.world.spectrum();
    let flux = spectrum.color(flux / density);
    let mut flight = Flight {
        job,
        numbers,
        ray,
        departure: Departure::Light(job.light),
        flux,
        spectrum,
        wavelength_number,
        media: emitter.media(),
        vertices: Vec::new(),
        ledger: Ledger { emitted: flux, ..Ledger::default() },
    };
    let end = flight.follow();
    let Flight { ray: Ray { direction, .. }, vertices, spectrum, ledger, .. } = flight;
    PhotonPath { start: ray, flux, vertices, end, direction, spectrum, ledger }
}

impl Flight<'_> {
    fn follow(&mut self) -> End {
        for _ in 0..self.job.world.scene().settings.max_depth {
            match self.job.world.meet(&self.ray, self.departure) {
                None => {
                    self.ledger.escaped += self.flux;
                    return End::Escaped;
                }
                Some(Meeting::Light { light, .. }) => {
                    self.attenuate(DVec3::ZERO);
                    return End::Absorbed(light);
                }
                Some(Meeting::Surface(hit)) => {
                    if let Some(end) = self.meet_surface(&hit) {
                        return end;
                    }
                }
            }
        }
        self.ledger.cut_off += self.flux;
        End::CutOff
    }

    /// Goes on from a caster; ends on a receiver.
    fn meet_surface(&mut self, hit: &Hit) -> Option<End> {
        let world = self.job.world;
        let hit = &world.taken_by(&self.ray, hit);
        self.attenuate(world.dielectrics().transmittance(&self.media, hit.distance, &self.spectrum));
        let facing = world.facing(hit, self.ray.direction);
        let is_first = self.spectrum == Spectrum::Whole && Crossing::disperses(world, hit, &facing, self.media);
        let choice = if is_first { self.split_colors(hit, &facing) } else { None };
        match Crossing::of(world, hit, &facing, self.media, self.spectrum) {
            Crossing::Nothing(media) => {
                self.media = media;
                self.record(hit, facing.point, Event::Passed);
                self.leave(hit, &facing, self.ray.direction);
                None
            }
            Crossing::Surface(surface, _) if !surface.is_caster() => {
                let weight = surface.passed_to_base(-self.ray.direction.dot(facing.normal_shading));
                Some(self.land(hit, &facing, weight))
            }
            Crossing::Surface(surface, beyond) => self.meet_caster(hit, &facing, &surface, beyond, choice),
        }
    }

    /// `choice` stands in for the number of the choice if that is made already.
    fn meet_caster(
        &mut self,
        hit: &Hit,
        facing: &Facing,
        surface: &Surface,
        beyond: Media,
        choice: Option<f64>,
    ) -> Option<End> {
        // What the base takes of light that met no caster is the camera's: the rest goes on, not by chance.
        let (choice, certain) = match surface.base() {
            Some(_) if self.vertices.is_empty() => (Some(0.0), self.leave_base(facing, surface)),
            _ => (choice, 1.0),
        };
        let numbers = &mut self.numbers;
        let draw = || {
            let next = numbers.next_caster();
            Draw { choice: choice.unwrap_or(next.choice), ..next }
        };
        match surface.scatter(facing, self.ray.direction, draw) {
            Outcome::Base(weight) => Some(self.land(hit, facing, weight)),
            Outcome::Lost => {
                self.attenuate(DVec3::ZERO);
                self.record(hit, facing.point, Event::Shadowed);
                Some(End::Shadowed)
            }
            Outcome::Passed(scattered) => {
                self.attenuate(scattered.weight * certain);
                self.correct(scattered.adjoint);
                let event = match scattered.transmitted {
                    false => Event::Reflected,
                    true if beyond == self.media => Event::Passed,
                    true => Event::Refracted,
                };
                if scattered.transmitted {
                    self.media = beyond;
                }
                self.record(hit, facing.point, event);
                self.leave(hit, facing, scattered.direction);
                None
            }
        }
    }

    /// Leaves to the camera what a base takes straight from a light. Returns the probability of the gloss, by which the weight
    /// of what is now certain was divided.
    fn leave_base(&mut self, facing: &Facing, surface: &Surface) -> f64 {
        let cos = -self.ray.direction.dot(facing.normal_shading);
        let taken = self.flux * surface.passed_to_base(cos);
        self.ledger.direct += taken;
        // All that does not go on will count as absorbed.
        self.ledger.absorbed -= taken;
        surface.chance_of_gloss(cos)
    }

    fn leave(&mut self, hit: &Hit, facing: &Facing, direction: DVec3) {
        self.ray = Ray { origin: facing.point, direction };
        self.departure = Departure::Triangle(hit.triangle);
    }

    fn land(&mut self, hit: &Hit, facing: &Facing, weight: DVec3) -> End {
        let has_met_caster = !self.vertices.is_empty();
        self.attenuate(weight);
        if has_met_caster {
            // The limit keeps grazing photons from making bright dots. Light tracing and camera paths, which are the
            // truth, have none: they find more light where it grazes the triangle, but not its shading normal.
            let factor = self.job.world.landing_factor(hit, facing, self.ray.direction);
            self.correct(factor.min(SHADING_NORMAL_LIMIT));
        }
        let Facing { point, front, .. } = *facing;
        let landing = Landing { triangle: hit.triangle, barycentric: hit.barycentric, front, flux: self.flux };
        self.record(hit, point, Event::Received);
        if has_met_caster {
            self.ledger.deposited += self.flux;
            End::Deposited(landing)
        } else {
            self.ledger.direct += self.flux;
            End::Direct(landing)
        }
    }

    /// What is not kept counts as absorbed; a weight over 1, that of an unlikely way, counts against it.
    fn attenuate(&mut self, share: DVec3) {
        let kept = self.flux * share;
        self.ledger.absorbed += self.flux - kept;
        self.flux = kept;
    }

    /// A factor of shading normals, up or down.
    fn correct(&mut self, factor: f64) {
        let corrected = self.flux * factor;
        self.ledger.shading_normals += self.flux - corrected;
        self.flux = corrected;
    }

    /// The first boundary that disperses: reflects all colours, or takes a wavelength. Returns the number of the choice between
    /// reflection and refraction if that is made.
    fn split_colors(&mut self, hit: &Hit, facing: &Facing) -> Option<f64> {
        let world = self.job.world;
        let Crossing::Surface(surface, beyond) = Crossing::of(world, hit, facing, self.media, Spectrum::Whole) else {
            return None;
        };
        let dielectrics = world.dielectrics();
        let eta = |spectrum| dielectrics.ior(&self.media, spectrum) / dielectrics.ior(&beyond, spectrum);
        let stated = eta(&Spectrum::Whole);
        if surface.is_rough() || stated >= 1.0 {
            self.disperse();
            return None;
        }
        let cos = -self.ray.direction.dot(facing.normal_shading);
        let chance = fresnel::reflectance(cos, stated);
        if self.wavelength_number < chance {
            let colored = dielectrics.colored_ior(&self.media) / dielectrics.colored_ior(&beyond);
            self.wavelength_number /= chance;
            self.recolor(DVec3::from(colored.to_array().map(|eta| fresnel::reflectance(cos, eta))) / chance);
            return Some(0.0);
        }
        self.wavelength_number = (self.wavelength_number - chance) / (1.0 - chance);
        self.disperse();
        let eta = dielectrics.ior(&self.media, &self.spectrum) / dielectrics.ior(&beyond, &self.spectrum);
        self.recolor(DVec3::splat((1.0 - fresnel::reflectance(cos, eta)) / (1.0 - chance)));
        Some(1.0)
    }

    /// Takes the wavelength of the photon's number.
    fn disperse(&mut self) {
        let before = self.flux;
        (self.spectrum, self.flux) = Spectrum::drawn(self.wavelength_number, before);
        self.ledger.dispersion += before - self.flux;
    }

    /// A factor of colours.
    fn recolor(&mut self, factor: DVec3) {
        let before = self.flux;
        self.flux = before * factor;
        self.ledger.dispersion += before - self.flux;
    }

    fn record(&mut self, hit: &Hit, position: DVec3, event: Event) {
        self.vertices.push(Vertex { position, triangle: hit.triangle, event, flux: self.flux });
    }
}
