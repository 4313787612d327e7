//! What casters do to a ray: mirrors and smooth dielectrics, on surfaces with interpolated normals.

use diacaustic_scene::MaterialKind;
use glam::DVec3;

use crate::fresnel::reflectance;
use crate::geometry::Facing;
use crate::snell::{reflect, refract};

/// A ray after a caster.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scattered {
    /// The new direction of flight, unit length.
    pub direction: DVec3,
    /// Whether it has crossed the boundary.
    pub refracted: bool,
    /// Share of the flux that goes on, per channel: a mirror's reflectance, or the tint of a boundary crossed.
    pub weight: DVec3,
    /// Index on the side that the ray comes from / index on the side where it goes on. Radiance along a path followed
    /// from the eye takes its square.
    pub eta: f64,
    /// |wi·n_s| |wo·n_g| / (|wi·n_g| |wo·n_s|), the factor on light followed from its source (Veach 1997, §5.3.2).
    pub adjoint: f64,
}

/// A ray of this direction of flight after the caster that it meets; none at a receiver. `choice` draws the number that
/// decides between reflection and refraction, once for every dielectric met.
pub fn scatter(
    kind: &MaterialKind,
    facing: &Facing,
    direction: DVec3,
    choice: impl FnOnce() -> f64,
) -> Option<Scattered> {
    let bounce: &dyn Fn(DVec3) -> Bounce = match *kind {
        MaterialKind::Mirror { reflectance } => &move |n| Bounce {
            direction: reflect(direction, n),
            refracted: false,
            weight: reflectance.as_dvec3(),
            eta: 1.0,
        },
        MaterialKind::Dielectric { ior, tint, .. } => {
            let eta = if facing.front { 1.0 / f64::from(ior) } else { f64::from(ior) };
            let u = choice();
            &move |n| meet_boundary(direction, n, eta, tint.as_dvec3(), u)
        }
        MaterialKind::Diffuse { .. } | MaterialKind::Phong { .. } => return None,
    };
    let n_g = facing.normal_geometric;
    let smooth = bounce(facing.normal_shading);
    if smooth.is_on_its_side(n_g) {
        return Some(smooth.scattered(adjoint(direction, smooth.direction, facing.normal_shading, n_g)));
    }
    // With the geometric normal the direction is on its side, and the adjoint factor 1.
    Some(bounce(n_g).scattered(1.0))
}

/// σ of the volume that a material bounds, 1/m.
pub fn absorption(kind: &MaterialKind) -> DVec3 {
    match kind {
        MaterialKind::Dielectric { absorption, .. } => absorption.as_dvec3(),
        MaterialKind::Mirror { .. } | MaterialKind::Diffuse { .. } | MaterialKind::Phong { .. } => DVec3::ZERO,
    }
}

/// Reflection or refraction about one normal.
#[derive(Clone, Copy)]
struct Bounce {
    direction: DVec3,
    refracted: bool,
    weight: DVec3,
    eta: f64,
}

impl Bounce {
    fn is_on_its_side(&self, normal_geometric: DVec3) -> bool {
        let height = self.direction.dot(normal_geometric);
        if self.refracted { height < 0.0 } else { height > 0.0 }
    }

    fn scattered(self, adjoint: f64) -> Scattered {
        let Self { direction, refracted, weight, eta } = self;
        Scattered { direction: direction.normalize(), refracted, weight, eta, adjoint }
    }
}

fn meet_boundary(direction: DVec3, n: DVec3, eta: f64, tint: DVec3, u: f64) -> Bounce {
    let reflected = Bounce { direction: reflect(direction, n), refracted: false, weight: DVec3::ONE, eta: 1.0 };
    if u < reflectance(-direction.dot(n), eta) {
        return reflected;
    }
    refract(direction, n, eta).map_or(reflected, |direction| Bounce { direction, refracted: true, weight: tint, eta })
}

fn adjoint(direction: DVec3, outgoing: DVec3, n_s: DVec3, n_g: DVec3) -> f64 {
    (direction.dot(n_s) * outgoing.dot(n_g) / (direction.dot(n_g) * outgoing.dot(n_s))).abs()
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;

    const GLASS: MaterialKind = MaterialKind::Dielectric { ior: 1.5, tint: Vec3::splat(0.5), absorption: Vec3::ZERO };

    fn facing(front: bool, normal_shading: DVec3) -> Facing {
        Facing { point: DVec3::ZERO, front, normal_geometric: DVec3::Z, normal_shading }
    }

    fn unmet() -> f64 {
        panic!("a mirror draws no choice")
    }

    #[test]
    fn fresnel_decides_between_reflection_and_refraction() {
        let d = -DVec3::Z;
        let reflected = scatter(&GLASS, &facing(true, DVec3::Z), d, || 0.0399).expect("glass is a caster");
        assert_eq!((reflected.direction, reflected.refracted, reflected.weight), (DVec3::Z, false, DVec3::ONE));
        let refracted = scatter(&GLASS, &facing(true, DVec3::Z), d, || 0.0401).expect("glass is a caster");
        assert_eq!((refracted.direction, refracted.refracted), (d, true));
        assert_eq!((refracted.weight, refracted.eta, refracted.adjoint), (DVec3::splat(0.5), 1.0 / 1.5, 1.0));
    }

    #[test]
    fn total_reflection_draws_its_choice_all_the_same() {
        let d = DVec3::new(0.9, 0.0, -0.19f64.sqrt());
        let mut draws = 0;
        let scattered = scatter(&GLASS, &facing(false, DVec3::Z), d, || {
            draws += 1;
            0.999
        });
        assert!(!scattered.expect("glass is a caster").refracted);
        assert_eq!(draws, 1);
    }

    #[test]
    fn reflection_into_the_surface_falls_back_to_the_flat_normal() {
        let mirror = MaterialKind::Mirror { reflectance: Vec3::ONE };
        let leaning = DVec3::new(-0.6, 0.0, 0.8);
        let d = DVec3::new(-1.0, 0.0, -1.0).normalize();
        assert!(reflect(d, leaning).z < 0.0);
        let scattered = scatter(&mirror, &facing(true, leaning), d, unmet).expect("a mirror is a caster");
        assert!(scattered.direction.distance(reflect(d, DVec3::Z)) < 1e-15);
        assert_eq!(scattered.adjoint, 1.0);
    }

    #[test]
    fn adjoint_factor_of_a_leaning_mirror() {
        let leaning = DVec3::new(0.6, 0.0, 0.8);
        let mirror = MaterialKind::Mirror { reflectance: Vec3::ONE };
        let scattered = scatter(&mirror, &facing(true, leaning), -DVec3::Z, unmet).expect("a mirror is a caster");
        // wi·n_s = wo·n_s, wi·n_g = 1, and wo = (0.96, 0, 0.28).
        assert!((scattered.adjoint - 0.28).abs() < 1e-15);
    }

    #[test]
    fn receivers_do_not_scatter_here() {
        let kind = MaterialKind::Diffuse { albedo: Vec3::ONE };
        assert_eq!(scatter(&kind, &facing(true, DVec3::Z), -DVec3::Z, unmet), None);
    }
}
