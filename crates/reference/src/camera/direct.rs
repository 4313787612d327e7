//! Light in plain sight.

use glam::DVec3;

use crate::generator::Generator;
use crate::geometry::{Departure, Ray, World};
use crate::lights::{self, LightSample, sample_light, sample_surfaces};
use crate::media::Media;
use crate::spectrum::Spectrum;

/// A place that light reaches.
#[derive(Clone, Copy, Debug)]
pub(super) struct Vertex {
    /// Metres.
    pub(super) point: DVec3,
    pub(super) departure: Departure,
    /// Unit normal of the triangle.
    pub(super) normal: DVec3,
    /// What surrounds it on the side of the normal, and on the other.
    pub(super) media: [Media; 2],
    /// That of the light which is looked for.
    pub(super) spectrum: Spectrum,
}

/// One sample of ∫ L f dω over all light in plain sight of a vertex, W/(m² sr) times the unit of `response` · sr, which
/// is the BSDF times the cosine toward a unit vector wi.
pub(super) fn gather(
    world: &World,
    vertex: &Vertex,
    response: impl Fn(DVec3) -> DVec3,
    generator: &mut Generator,
) -> DVec3 {
    let mut gathered = DVec3::ZERO;
    for light in 0..world.scene().lights.len() {
        let sample = sample_light(world, light, vertex.point, generator);
        gathered += sample.map_or(DVec3::ZERO, |sample| arriving(world, vertex, &response, &sample, generator));
    }
    let sample = sample_surfaces(world, vertex.point, generator);
    gathered + sample.map_or(DVec3::ZERO, |sample| arriving(world, vertex, &response, &sample, generator))
}

/// The same for the lights alone that no ray drawn from a BSDF meets.
pub(super) fn gather_delta(
    world: &World,
    vertex: &Vertex,
    response: impl Fn(DVec3) -> DVec3,
    generator: &mut Generator,
) -> DVec3 {
    let lights = world.scene().lights.iter().enumerate();
    let deltas = lights.filter(|(_, light)| lights::is_delta(&light.kind));
    let one = |(light, _)| {
        let sample = sample_light(world, light, vertex.point, generator);
        sample.map_or(DVec3::ZERO, |sample| arriving(world, vertex, &response, &sample, generator))
    };
    deltas.map(one).sum()
}

fn arriving(
    world: &World,
    vertex: &Vertex,
    response: &impl Fn(DVec3) -> DVec3,
    sample: &LightSample,
    generator: &mut Generator,
) -> DVec3 {
    let response = response(sample.wi);
    if response == DVec3::ZERO || sample.value == DVec3::ZERO {
        return DVec3::ZERO;
    }
    let ray = Ray { origin: vertex.point, direction: sample.wi };
    if world.occluded(&ray, sample.distance, vertex.departure, sample.target, generator.next()) {
        return DVec3::ZERO;
    }
    let side = usize::from(sample.wi.dot(vertex.normal) < 0.0);
    let transmittance = world.dielectrics().transmittance(&vertex.media[side], sample.distance, &vertex.spectrum);
    response * vertex.spectrum.color(sample.value) * transmittance
}
