//! The way from a light to the first receiver.

use glam::DVec3;

use crate::bsdf::{Crossing, Draw, Outcome};
use crate::generator::Generator;
use crate::geometry::{Departure, Meeting, Ray, World};
use crate::roulette;
use crate::spectrum::Spectrum;

use super::emission::Start;

/// Where light has met a receiver.
#[derive(Clone, Copy, Debug)]
pub(super) struct Landing {
    pub(super) point: DVec3,
    /// Direction of flight.
    pub(super) direction: DVec3,
    /// W, as counts for the irradiance on a surface of the shading normal.
    pub(super) flux: DVec3,
    pub(super) has_met_caster: bool,
}

/// Where light lands, if it does.
pub(super) fn fly(world: &World, start: Start, generator: &mut Generator) -> Option<Landing> {
    let Start { mut ray, mut departure, mut media, flux } = start;
    let mut spectrum = world.spectrum();
    let mut flux = spectrum.color(flux);
    // Share of that flux.
    let mut kept = DVec3::ONE;
    let mut casters = 0;
    loop {
        let Some(Meeting::Surface(hit)) = world.meet(&ray, departure) else { return None };
        let hit = world.taken(&hit, || generator.unit());
        kept *= world.dielectrics().transmittance(&media, hit.distance, &spectrum);
        let facing = world.facing(&hit, ray.direction);
        if spectrum == Spectrum::Whole && Crossing::disperses(world, &hit, &facing, media) {
            (spectrum, flux) = Spectrum::drawn(generator.unit(), flux * kept);
            kept = DVec3::ONE;
        }
        let land = |kept: DVec3, weight: DVec3| {
            let (point, direction) = (facing.point, ray.direction);
            let flux = world.landing_factor(&hit, &facing, direction) * flux * kept * weight;
            Some(Landing { point, direction, flux, has_met_caster: casters > 0 })
        };
        let mut direction = ray.direction;
        match Crossing::of(world, &hit, &facing, media, spectrum) {
            Crossing::Nothing(beyond) => media = beyond,
            Crossing::Surface(surface, _) if !surface.is_caster() => {
                return land(kept, surface.passed_to_base(-ray.direction.dot(facing.normal_shading)));
            }
            Crossing::Surface(surface, beyond) => {
                let draw = || Draw { choice: generator.unit(), microfacet: [generator.unit(), generator.unit()] };
                match surface.scatter(&facing, ray.direction, draw) {
                    Outcome::Base(weight) => return land(kept, weight),
                    Outcome::Lost => return None,
                    Outcome::Passed(scattered) => {
                        kept *= scattered.weight * scattered.adjoint;
                        direction = scattered.direction;
                        if scattered.transmitted {
                            media = beyond;
                        }
                    }
                }
            }
        }
        casters += 1;
        if !roulette::survives(&mut kept, casters, generator) {
            return None;
        }
        ray = Ray { origin: facing.point, direction };
        departure = Departure::Triangle(hit.triangle);
    }
}
