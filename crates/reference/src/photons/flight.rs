//! A photon's way from the light to its end.

use glam::DVec3;

use crate::geometry::{Departure, Hit, Meeting, Ray};
use crate::random::PhotonNumbers;
use crate::specular::{absorption, scatter};

use super::emission::{Emitter, Start};
use super::{Landing, Ledger, PhotonJob};

/// What happened to a photon at a surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Event {
    /// It was reflected.
    Reflected,
    /// It crossed the boundary.
    Refracted,
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
    /// Flux after it, W; on a receiver, the flux that arrives.
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
    /// σ of the medium that it is in, 1/m; zero in the open.
    absorption: DVec3,
    vertices: Vec<Vertex>,
    ledger: Ledger,
}

pub(super) fn fly(job: &PhotonJob, emitter: &Emitter, photon: u32) -> PhotonPath {
    let numbers = PhotonNumbers::new(job.seed, job.light as u32, photon);
    let Start { ray, flux } = emitter.emit(&numbers);
    let mut flight = Flight {
        job,
        numbers,
        ray,
        departure: Departure::Light(job.light),
        flux,
        absorption: DVec3::ZERO,
        vertices: Vec::new(),
        ledger: Ledger { emitted: flux, ..Ledger::default() },
    };
    let end = flight.follow();
    let Flight { ray: last, vertices, ledger, .. } = flight;
    PhotonPath { start: ray, flux, vertices, end, direction: last.direction, ledger }
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
                    self.ledger.absorbed += self.flux;
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
        self.attenuate((-self.absorption * hit.distance).exp());
        let world = self.job.world;
        let kind = world.material(hit.triangle);
        let facing = world.triangles()[hit.triangle].facing(hit.barycentric, self.ray.direction);
        if !kind.is_caster() {
            return Some(self.land(hit, facing.point, facing.front));
        }
        let scattered =
            scatter(kind, &facing, self.ray.direction, || self.numbers.next_choice()).expect("every caster scatters");
        self.attenuate(scattered.weight);
        let corrected = self.flux * scattered.adjoint;
        self.ledger.shading_normals += self.flux - corrected;
        self.flux = corrected;
        if scattered.refracted {
            self.absorption = if facing.front { absorption(kind) } else { DVec3::ZERO };
        }
        let event = if scattered.refracted { Event::Refracted } else { Event::Reflected };
        self.record(hit, facing.point, event);
        self.ray = Ray { origin: facing.point, direction: scattered.direction };
        self.departure = Departure::Triangle(hit.triangle);
        None
    }

    fn land(&mut self, hit: &Hit, point: DVec3, front: bool) -> End {
        let has_met_caster = !self.vertices.is_empty();
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

    fn attenuate(&mut self, share: DVec3) {
        let kept = self.flux * share;
        self.ledger.absorbed += self.flux - kept;
        self.flux = kept;
    }

    fn record(&mut self, hit: &Hit, position: DVec3, event: Event) {
        self.vertices.push(Vertex { position, triangle: hit.triangle, event, flux: self.flux });
    }
}
