//! Which way light goes on from a surface, by chance.

use glam::DVec3;

use crate::geometry::Facing;
use crate::snell::{reflect, refract};
use crate::warp;

use super::microfacet::Microfacets;
use super::{Specular, Surface};

/// Random numbers in [0, 1) for one caster.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Draw {
    /// Decides between the two ways on.
    pub choice: f64,
    /// Choose the microfacet's normal.
    pub microfacet: [f64; 2],
}

/// A ray after a caster.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scattered {
    /// The new direction of flight, unit length.
    pub direction: DVec3,
    /// Whether it has crossed the surface.
    pub transmitted: bool,
    /// Share of the flux that goes on, per channel, over the probability of this way.
    pub weight: DVec3,
    /// Index on the side that the ray comes from / index on the side where it goes on. Radiance along a path followed
    /// from the eye takes its square.
    pub eta: f64,
    /// |wi·n_s| |wo·n_g| / (|wi·n_g| |wo·n_s|), the factor on light followed from its source (Veach 1997, §5.3.2).
    pub adjoint: f64,
}

/// What becomes of a ray at a surface with a specular lobe.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Outcome {
    /// It goes on.
    Passed(Scattered),
    /// It enters the base with this weight, T(wo) over the probability of this way.
    Base(DVec3),
    /// Its microfacet sends it through the surface to the wrong side.
    Lost,
}

/// Reflection or transmission about one microfacet.
#[derive(Clone, Copy)]
struct Bounce {
    direction: DVec3,
    transmitted: bool,
    /// Light that passes straight is not turned by the normal.
    straight: bool,
    weight: DVec3,
    eta: f64,
}

impl Bounce {
    fn reflected(direction: DVec3, m: DVec3, weight: DVec3) -> Self {
        Self { direction: reflect(direction, m), transmitted: false, straight: false, weight, eta: 1.0 }
    }

    fn is_on_its_side_of(&self, normal: DVec3) -> bool {
        let height = self.direction.dot(normal);
        if self.transmitted { height < 0.0 } else { height > 0.0 }
    }

    fn scattered(self, direction: DVec3, facing: &Facing, normal_shading: DVec3) -> Outcome {
        let Self { direction: outgoing, transmitted, straight, weight, eta } = self;
        let adjoint =
            if straight { 1.0 } else { adjoint(direction, outgoing, normal_shading, facing.normal_geometric) };
        Outcome::Passed(Scattered { direction: outgoing.normalize(), transmitted, weight, eta, adjoint })
    }
}

/// One way on, before it is known whether it ends on the right side.
enum Way {
    Bounce(Bounce),
    Base(DVec3),
}

impl Surface {
    /// What becomes of a ray of this direction of flight. `draw` is not asked at a mirror, and once elsewhere.
    pub fn scatter(&self, facing: &Facing, direction: DVec3, draw: impl FnOnce() -> Draw) -> Outcome {
        let is_mirror = matches!(self.specular, Specular::Mirror { .. });
        let draw = if is_mirror { Draw { choice: 0.0, microfacet: [0.0; 2] } } else { draw() };
        match self.microfacets {
            Some(microfacets) => self.scatter_roughly(&microfacets, facing, direction, &draw),
            None => self.scatter_smoothly(facing, direction, draw.choice),
        }
    }

    fn scatter_smoothly(&self, facing: &Facing, direction: DVec3, choice: f64) -> Outcome {
        let n_g = facing.normal_geometric;
        match self.way(direction, facing.normal_shading, facing.normal_shading, choice) {
            Way::Bounce(bounce) if bounce.is_on_its_side_of(n_g) => {
                bounce.scattered(direction, facing, facing.normal_shading)
            }
            Way::Base(weight) => Outcome::Base(weight),
            Way::Bounce(_) => match self.way(direction, n_g, n_g, choice) {
                Way::Bounce(bounce) => bounce.scattered(direction, facing, n_g),
                Way::Base(weight) => Outcome::Base(weight),
            },
        }
    }

    fn scatter_roughly(&self, microfacets: &Microfacets, facing: &Facing, direction: DVec3, draw: &Draw) -> Outcome {
        let n_s = facing.normal_shading;
        let m = visible_normal(microfacets, n_s, -direction, draw.microfacet);
        match self.way(direction, n_s, m, draw.choice) {
            Way::Base(weight) => Outcome::Base(weight),
            Way::Bounce(bounce) => {
                if !(bounce.is_on_its_side_of(n_s) && bounce.is_on_its_side_of(facing.normal_geometric)) {
                    return Outcome::Lost;
                }
                let weight = bounce.weight * unshadowed(microfacets, n_s, direction, bounce.direction);
                Bounce { weight, ..bounce }.scattered(direction, facing, n_s)
            }
        }
    }

    /// The way on about the microfacet normal m of a surface whose normal is n.
    fn way(&self, direction: DVec3, n: DVec3, m: DVec3, choice: f64) -> Way {
        let fresnel = self.specular.fresnel(-direction.dot(m));
        if self.base.is_some() {
            let at_normal = self.specular.fresnel(-direction.dot(n));
            let chance = at_normal.element_sum() / 3.0;
            return if choice < chance {
                Way::Bounce(Bounce::reflected(direction, m, fresnel / chance))
            } else {
                Way::Base((1.0 - at_normal) / (1.0 - chance))
            };
        }
        Way::Bounce(match self.specular {
            Specular::Dielectric { .. } | Specular::ThinWalled { .. } if choice < fresnel.x => {
                Bounce::reflected(direction, m, DVec3::ONE)
            }
            Specular::Dielectric { eta, tint } => match refract(direction, m, eta) {
                Some(direction) => Bounce { direction, transmitted: true, straight: false, weight: tint, eta },
                None => Bounce::reflected(direction, m, DVec3::ONE),
            },
            Specular::ThinWalled { tint, .. } => {
                Bounce { direction, transmitted: true, straight: true, weight: tint, eta: 1.0 }
            }
            _ => Bounce::reflected(direction, m, fresnel),
        })
    }

    /// The direction and the weight F · G₂/G₁ of light that the gloss of a receiver reflects; none if it is lost.
    pub(crate) fn reflect_off_gloss(&self, facing: &Facing, wo: DVec3, v: [f64; 2]) -> Option<(DVec3, DVec3)> {
        let (microfacets, n_s) = (self.microfacets?, facing.normal_shading);
        let m = visible_normal(&microfacets, n_s, wo, v);
        let bounce = Bounce::reflected(-wo, m, self.specular.fresnel(wo.dot(m)));
        let is_above = bounce.is_on_its_side_of(n_s) && bounce.is_on_its_side_of(facing.normal_geometric);
        let weight = bounce.weight * unshadowed(&microfacets, n_s, -wo, bounce.direction);
        is_above.then(|| (bounce.direction.normalize(), weight))
    }

    /// The mean over the channels of the share that is reflected at cos θo: the probability of the gloss.
    pub(crate) fn chance_of_gloss(&self, cos_o: f64) -> f64 {
        self.specular.fresnel(cos_o).element_sum() / 3.0
    }
}

fn visible_normal(microfacets: &Microfacets, n: DVec3, wo: DVec3, v: [f64; 2]) -> DVec3 {
    let [t1, t2] = warp::frame(n);
    let m = microfacets.visible_normal(DVec3::new(wo.dot(t1), wo.dot(t2), wo.dot(n)), v);
    m.x * t1 + m.y * t2 + m.z * n
}

/// G₂/G₁ of a way from one direction of flight to another.
fn unshadowed(microfacets: &Microfacets, n: DVec3, direction: DVec3, outgoing: DVec3) -> f64 {
    let (cos_o, cos_i) = (-direction.dot(n), outgoing.dot(n).abs());
    microfacets.masking_shadowing(cos_o, cos_i) / microfacets.masking(cos_o)
}

fn adjoint(direction: DVec3, outgoing: DVec3, n_s: DVec3, n_g: DVec3) -> f64 {
    (direction.dot(n_s) * outgoing.dot(n_g) / (direction.dot(n_g) * outgoing.dot(n_s))).abs()
}
