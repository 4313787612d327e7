//! The lobes of surfaces: what is drawn against what is evaluated, and what is lost.

mod shapes;

use std::f64::consts::TAU;

use diacaustic_reference::bsdf::{Draw, Outcome, Surface};
use diacaustic_reference::geometry::Facing;
use diacaustic_reference::warp;
use diacaustic_scene::{Material, MaterialKind};
use glam::{DVec3, Vec3};

use shapes::frosted;

const FACING: Facing = Facing { point: DVec3::ZERO, front: true, normal_geometric: DVec3::Z, normal_shading: DVec3::Z };

fn surface(kind: &MaterialKind, ior: f64, beyond: f64) -> Surface {
    Surface::new(&Material::new("", kind.clone()), DVec3::ZERO, ior, beyond)
}

/// Points that fill the unit cube evenly (Roberts 2018: powers of the inverse of the root of x⁴ = x + 1).
fn points(count: u32) -> impl Iterator<Item = [f64; 3]> {
    let root = 1.220_744_084_605_759_5f64;
    (0..count).map(move |i| std::array::from_fn(|k| (0.5 + f64::from(i) * root.powi(-1 - k as i32)).fract()))
}

fn from_angle(cos: f64) -> DVec3 {
    DVec3::new((1.0 - cos * cos).sqrt(), 0.0, cos)
}

/// Mean shares of the flux that are reflected and transmitted from wo, as they are drawn. The first channel.
fn drawn(surface: &Surface, wo: DVec3, count: u32) -> [f64; 2] {
    let mut shares = [0.0; 2];
    for [choice, v0, v1] in points(count) {
        let draw = || Draw { choice, microfacet: [v0, v1] };
        if let Outcome::Passed(scattered) = surface.scatter(&FACING, -wo, draw) {
            shares[usize::from(scattered.transmitted)] += scattered.weight.x / f64::from(count);
        }
    }
    shares
}

/// The same shares as integrals of the BSDF, uniform over each hemisphere.
fn evaluated(surface: &Surface, wo: DVec3, eta: f64, count: u32) -> [f64; 2] {
    let mut shares = [0.0; 2];
    for [u, v, _] in points(count) {
        let wi = warp::cone(DVec3::Z, 1.0, u, v);
        for (share, wi, squared) in [(0, wi, 1.0), (1, DVec3::new(wi.x, wi.y, -wi.z), eta * eta)] {
            shares[share] += TAU / f64::from(count) * surface.gloss(&FACING, wo, wi).x / squared;
        }
    }
    shares
}

#[test]
fn lobes_are_drawn_as_they_are_evaluated() {
    let metal = MaterialKind::Conductor { eta: Vec3::splat(0.2), k: Vec3::splat(3.0), roughness: 0.6 };
    let cases = [(frosted(1.5, 0.6), [1.0, 1.5]), (frosted(1.5, 0.5), [1.5, 1.0]), (metal, [1.0, 1.0])];
    for (kind, [ior, beyond]) in cases {
        let surface = surface(&kind, ior, beyond);
        for cos in [1.0, 0.8, 0.4, 0.15] {
            let wo = from_angle(cos);
            let drawn = drawn(&surface, wo, 400_000);
            let evaluated = evaluated(&surface, wo, ior / beyond, 4_000_000);
            let difference = (drawn[0] - evaluated[0]).abs().max((drawn[1] - evaluated[1]).abs());
            assert!(difference < 2e-3, "{kind:?} at {cos}: {drawn:?} drawn, {evaluated:?} evaluated");
        }
    }
}

#[test]
fn lobes_are_reciprocal() {
    let entering = surface(&frosted(1.5, 0.5), 1.0, 1.5);
    let leaving = surface(&frosted(1.5, 0.5), 1.5, 1.0);
    // The facing's front is the side of wo.
    let flipped = |w: DVec3| DVec3::new(w.x, w.y, -w.z);
    for (cos_o, cos_i) in [(0.9, 0.7), (0.5, 0.9), (0.3, 0.6)] {
        let (wo, above) = (from_angle(cos_o), DVec3::new(0.0, (1.0f64 - cos_i * cos_i).sqrt(), cos_i));
        let there = entering.gloss(&FACING, wo, above).x / cos_i;
        let back = entering.gloss(&FACING, above, wo).x / cos_o;
        assert!((there / back - 1.0).abs() < 1e-12);
        let below = DVec3::new(-above.y, 0.1, -1.0).normalize();
        let there = entering.gloss(&FACING, wo, below).x / -below.z;
        let back = leaving.gloss(&FACING, flipped(below), flipped(wo)).x / cos_o;
        // f/n² of the side that it leads to is the same both ways (Veach 1997, §5.2).
        assert!(there > 0.0 && (there / (back / 2.25) - 1.0).abs() < 1e-9);
    }
}

/// Share of the flux that microfacets lose, met at cos θo.
fn loss(surface: &Surface, cos: f64, count: u32) -> f64 {
    let [reflected, transmitted] = drawn(surface, from_angle(cos), count);
    1.0 - reflected - transmitted
}

/// The same for even light from the whole hemisphere.
fn mean_loss(surface: &Surface, count: u32) -> f64 {
    let steps = 64;
    // cos² θ is uniform under the cosine.
    let at = |step: i32| loss(surface, ((f64::from(step) + 0.5) / f64::from(steps)).sqrt(), count);
    (0..steps).map(at).sum::<f64>() / f64::from(steps)
}

#[test]
fn rough_glass_loses_little() {
    let lost = |roughness, ior, beyond| mean_loss(&surface(&frosted(1.5, roughness), ior, beyond), 4000);
    let entering: Vec<f64> = [0.2, 0.5, 0.8].map(|roughness| lost(roughness, 1.0, 1.5)).to_vec();
    assert!(entering.is_sorted() && entering[0] > 0.0 && entering[1] < 0.05, "{entering:?}");
    assert!(lost(0.0, 1.0, 1.5).abs() < 1e-12 && lost(0.0, 1.5, 1.0).abs() < 1e-12);
    assert!(lost(0.5, 1.5, 1.0) > entering[1]);
}

#[test]
#[ignore = "prints the table of docs/materials.md"]
fn table_of_losses() {
    let perfect = |roughness| MaterialKind::Conductor { eta: Vec3::splat(1e-6), k: Vec3::splat(1e6), roughness };
    println!("loss in percent: mean over the hemisphere (at normal incidence)");
    println!("roughness   into 1.5          out of 1.5        perfect metal");
    for tenth in 1..=10 {
        let roughness = 0.1 * tenth as f32;
        let entries =
            [(frosted(1.5, roughness), 1.0, 1.5), (frosted(1.5, roughness), 1.5, 1.0), (perfect(roughness), 1.0, 1.0)]
                .map(|(kind, ior, beyond)| surface(&kind, ior, beyond))
                .map(|surface| [100.0 * mean_loss(&surface, 100_000), 100.0 * loss(&surface, 1.0, 1_000_000)]);
        let cell = |[mean, normal]: [f64; 2]| format!("{mean:6.2} ({normal:6.2})");
        println!("{roughness:9.1}   {}", entries.map(cell).join("   "));
    }
}
