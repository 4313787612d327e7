//! Which way light goes on from a surface, by chance.

use glam::DVec3;

use crate::geometry::Facing;
use crate::snell::{reflect, refract};
use crate::warp;

use super::microfacet::Microfacets;
use super::{Specular, Surface};

/// The most by which shading normals raise flux at one surface.
pub(crate) const SHADING_NORMAL_LIMIT: f64 = 4.0;

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
        let cos = -direction.dot(m);
        if self.base.is_some() {
            let cos_o = -direction.dot(n);
            let chance = self.chance_of_gloss(cos_o);
            return if choice < chance {
                Way::Bounce(Bounce::reflected(direction, m, self.reflectance(cos) / chance))
            } else {
                Way::Base(self.passed_to_base(cos_o) / (1.0 - chance))
            };
        }
        Way::Bounce(match self.specular {
            Specular::Dielectric { .. } | Specular::ThinWalled { .. } if choice < self.reflectance(cos).x => {
                Bounce::reflected(direction, m, DVec3::ONE)
            }
            Specular::Dielectric { eta, tint } => match refract(direction, m, eta) {
                Some(direction) => Bounce { direction, transmitted: true, straight: false, weight: tint, eta },
                None => Bounce::reflected(direction, m, DVec3::ONE),
            },
            // A rough wall turns what passes as what it reflects, seen in it as in a mirror.
            Specular::ThinWalled { tint, .. } if self.microfacets.is_some() => {
                let direction = reflect(reflect(direction, m), n);
                Bounce { direction, transmitted: true, straight: false, weight: tint, eta: 1.0 }
            }
            Specular::ThinWalled { tint, .. } => {
                Bounce { direction, transmitted: true, straight: true, weight: tint, eta: 1.0 }
            }
            _ => Bounce::reflected(direction, m, self.reflectance(cos)),
        })
    }

    /// The direction and the weight F · G₂/G₁ of light that the gloss of a receiver reflects; none if it is lost.
    pub(crate) fn reflect_off_gloss(&self, facing: &Facing, wo: DVec3, v: [f64; 2]) -> Option<(DVec3, DVec3)> {
        let (microfacets, n_s) = (self.microfacets?, facing.normal_shading);
        let m = visible_normal(&microfacets, n_s, wo, v);
        let bounce = Bounce::reflected(-wo, m, self.reflectance(wo.dot(m)));
        let is_above = bounce.is_on_its_side_of(n_s) && bounce.is_on_its_side_of(facing.normal_geometric);
        let weight = bounce.weight * unshadowed(&microfacets, n_s, -wo, bounce.direction);
        is_above.then(|| (bounce.direction.normalize(), weight))
    }

    /// The mean of the shares of red, green and blue light that are reflected at cos θo: the probability of the gloss.
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
    let factor = direction.dot(n_s) * outgoing.dot(n_g) / (direction.dot(n_g) * outgoing.dot(n_s));
    factor.abs().min(SHADING_NORMAL_LIMIT)
}

#[cfg(test)]
mod tests {
    use diacaustic_scene::{Dispersion, Material, MaterialKind};
    use glam::Vec3;

    use super::*;

    fn facing(normal_shading: DVec3) -> Facing {
        Facing { point: DVec3::ZERO, front: true, normal_geometric: DVec3::Z, normal_shading }
    }

    /// What becomes of a ray in air at a dielectric of the other index beyond, or at another material.
    fn scatter(kind: &MaterialKind, ior: [f64; 2], normal_shading: DVec3, direction: DVec3, choice: f64) -> Scattered {
        let surface = Surface::new(&Material::new("", kind.clone()), DVec3::ZERO, ior[0], ior[1]);
        let draw = || Draw { choice, microfacet: [0.5; 2] };
        match surface.scatter(&facing(normal_shading), direction, draw) {
            Outcome::Passed(scattered) => scattered,
            other => panic!("{other:?}"),
        }
    }

    fn glass() -> MaterialKind {
        let (tint, absorption) = (Vec3::splat(0.5), Vec3::ZERO);
        MaterialKind::Dielectric {
            ior: 1.5,
            dispersion: Dispersion::None,
            tint,
            absorption,
            roughness: 0.0,
            priority: 0,
        }
    }

    #[test]
    fn fresnel_decides_between_reflection_and_refraction() {
        let d = -DVec3::Z;
        let reflected = scatter(&glass(), [1.0, 1.5], DVec3::Z, d, 0.0399);
        assert_eq!((reflected.direction, reflected.transmitted, reflected.weight), (DVec3::Z, false, DVec3::ONE));
        let refracted = scatter(&glass(), [1.0, 1.5], DVec3::Z, d, 0.0401);
        assert_eq!((refracted.direction, refracted.transmitted), (d, true));
        assert_eq!((refracted.weight, refracted.eta, refracted.adjoint), (DVec3::splat(0.5), 1.0 / 1.5, 1.0));
    }

    #[test]
    fn total_reflection_draws_its_choice_all_the_same() {
        let d = DVec3::new(0.9, 0.0, -0.19f64.sqrt());
        let mut draws = 0;
        let draw = || {
            draws += 1;
            Draw { choice: 0.999, microfacet: [0.5; 2] }
        };
        let glass = Material::new("", glass());
        let outcome = Surface::new(&glass, DVec3::ZERO, 1.5, 1.0).scatter(&facing(DVec3::Z), d, draw);
        assert!(matches!(outcome, Outcome::Passed(scattered) if !scattered.transmitted));
        assert_eq!(draws, 1);
    }

    #[test]
    fn mirrors_draw_nothing() {
        let mirror = Material::new("", MaterialKind::Mirror { reflectance: Vec3::ONE });
        Surface::new(&mirror, DVec3::ZERO, 1.0, 1.0)
            .scatter(&facing(DVec3::Z), -DVec3::Z, || panic!("a mirror draws no choice"));
    }

    #[test]
    fn reflection_into_the_surface_falls_back_to_the_flat_normal() {
        let mirror = MaterialKind::Mirror { reflectance: Vec3::ONE };
        let leaning = DVec3::new(-0.6, 0.0, 0.8);
        let d = DVec3::new(-1.0, 0.0, -1.0).normalize();
        assert!(reflect(d, leaning).z < 0.0);
        let scattered = scatter(&mirror, [1.0; 2], leaning, d, 0.0);
        assert!(scattered.direction.distance(reflect(d, DVec3::Z)) < 1e-15);
        assert_eq!(scattered.adjoint, 1.0);
    }

    #[test]
    fn adjoint_factor_of_a_leaning_mirror() {
        let mirror = MaterialKind::Mirror { reflectance: Vec3::ONE };
        let scattered = scatter(&mirror, [1.0; 2], DVec3::new(0.6, 0.0, 0.8), -DVec3::Z, 0.0);
        // wi·n_s = wo·n_s, wi·n_g = 1, and wo = (0.96, 0, 0.28).
        assert!((scattered.adjoint - 0.28).abs() < 1e-15);
    }

    #[test]
    fn thin_wall_reflects_with_all_inner_reflections_and_passes_straight() {
        let wall = MaterialKind::ThinWalled { ior: 1.5, tint: Vec3::ONE, roughness: 0.0 };
        let (leaning, d) = (DVec3::new(0.1, 0.0, 1.0).normalize(), DVec3::new(0.6, 0.0, -0.8));
        let f = crate::fresnel::reflectance(-d.dot(leaning), 1.0 / 1.5);
        let share = 2.0 * f / (1.0 + f);
        assert!(!scatter(&wall, [1.0; 2], leaning, d, share - 1e-9).transmitted);
        let passed = scatter(&wall, [1.0; 2], leaning, d, share + 1e-9);
        assert!(passed.transmitted && passed.direction.distance(d) < 1e-15);
        assert_eq!((passed.weight, passed.eta, passed.adjoint), (DVec3::ONE, 1.0, 1.0));
    }

    #[test]
    fn conductor_is_relative_to_the_medium() {
        let gold = MaterialKind::Conductor { eta: Vec3::splat(0.2), k: Vec3::splat(3.0), roughness: 0.0 };
        let weight = scatter(&gold, [1.33; 2], DVec3::Z, -DVec3::Z, 0.0).weight.x;
        let expected = crate::fresnel::conductor(1.0, f64::from(0.2f32) / 1.33, 3.0 / 1.33);
        assert!((weight - expected).abs() < 1e-14);
    }
}
