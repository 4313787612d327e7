//! The photon kernel against the double-precision reference: the same photons must fill the same texels.

use diacaustic::{Emission, glam::DVec3};
use diacaustic_reference::{
    geometry::World,
    photons::{AimDisc, Emission as ReferenceEmission, MapLayout, PhotonJob, trace},
};
use diacaustic_scene::Scene;
use diacaustic_tests::{emit, scene};

const PHOTONS: u32 = 1 << 16;

fn over_a_floor(object: &str, light: &str) -> Scene {
    scene(&format!(
        "camera = {{ position = [0, 2.2, 3.2], look_at = [0, 0.2, 0], vertical_fov = 40 }}
         render = {{ map_size = 33, max_depth = 32, seed = 11 }}
         materials.glass = {{ type = \"dielectric\", ior = 1.5, tint = [1, 0.9, 0.8], absorption = [0.5, 0, 1] }}
         materials.floor = {{ type = \"diffuse\", albedo = 0.8 }}
         lights = [{light}]
         objects = [
             {{ {object}, material = \"glass\", translate = [0, 0.2, 0] }},
             {{ rectangle = {{ center = [0, 0, 0], edge_u = [2, 0, 0], edge_v = [0, 0, -2] }}, material = \"floor\" }},
         ]"
    ))
}

/// What both implementations say of the scene's first light.
struct Both {
    /// Texel sums of the floor's map, W times the photons.
    gpu: Vec<DVec3>,
    reference: Vec<DVec3>,
    /// Emitted, deposited, direct, absorbed, escaped, shading normals.
    gpu_ledger: [DVec3; 6],
    reference_ledger: [DVec3; 6],
}

fn both(scene: &Scene) -> Both {
    let renderer = emit(scene, u64::from(PHOTONS));
    let map = renderer.energy_map(1).unwrap().unwrap();
    let photons = f64::from(PHOTONS);
    let gpu = (0..map.sums.len()).map(|texel| map.flux(texel) * photons).collect();
    let ledger = renderer.statistics().unwrap().ledgers[0];
    let watts = |account| ledger.watts(account, u64::from(PHOTONS)) * photons;

    let layouts: Vec<_> = (0..scene.objects.len())
        .map(|object| {
            let layout = renderer.map_layout(object).unwrap()?;
            let corners = layout.corners.iter().map(|corners| corners.map(|p| p.as_dvec2())).collect();
            Some(MapLayout { width: layout.width, height: layout.height, layers: layout.layers, corners })
        })
        .collect();
    let discs: Vec<AimDisc>;
    let emission = match renderer.emission(0).unwrap().expect("the light emits") {
        Emission::Aimed(list) => {
            let vector = |v: [f32; 3]| DVec3::from(v.map(f64::from));
            discs = list
                .iter()
                .map(|d| AimDisc { center: vector(d.center), axis: vector(d.axis), radius: f64::from(d.radius) })
                .collect();
            ReferenceEmission::Aimed(&discs)
        }
        Emission::Unaimed => ReferenceEmission::Unaimed,
    };
    let world = World::new(scene);
    let job =
        PhotonJob { world: &world, maps: &layouts, light: 0, emission, seed: scene.settings.seed, photons: 0..PHOTONS };
    let mut result = trace(&job);
    let l = result.ledger;
    Both {
        gpu,
        reference: result.maps.swap_remove(1),
        gpu_ledger: [
            ledger.emitted,
            ledger.deposited,
            ledger.direct,
            ledger.absorbed,
            ledger.escaped,
            ledger.shading_normals,
        ]
        .map(watts),
        reference_ledger: [l.emitted, l.deposited, l.direct, l.absorbed, l.escaped, l.shading_normals],
    }
}

/// Σ |difference| over Σ reference, over all texels and channels.
fn relative_difference(a: &[DVec3], b: &[DVec3]) -> f64 {
    assert_eq!(a.len(), b.len());
    let difference: f64 = a.iter().zip(b).map(|(a, b)| (*a - *b).abs().element_sum()).sum();
    difference / b.iter().map(|b| b.element_sum()).sum::<f64>()
}

/// Single precision moves a photon by micrometres, which shifts bilinear weights in the fourth digit; now and then one falls on
/// the other side of an edge, a total reflection or a Fresnel choice and takes another path altogether.
fn assert_alike(scene: &Scene, rounding: f64) {
    let both = both(scene);
    let difference = relative_difference(&both.gpu, &both.reference);
    assert!(difference < rounding, "texels differ by {difference} of their sum, stated rounding {rounding}");
    let emitted = both.reference_ledger[0].y;
    for (account, (gpu, reference)) in both.gpu_ledger.iter().zip(&both.reference_ledger).enumerate() {
        let difference = (*gpu - *reference).abs().max_element() / emitted;
        assert!(difference < 0.1 * rounding, "ledger account {account}: GPU {gpu}, reference {reference}");
    }
    // Other photons fall elsewhere: a comparison that any photons pass would be worthless.
    let mut other = scene.clone();
    other.settings.seed += 1;
    let renderer = emit(&other, u64::from(PHOTONS));
    let map = renderer.energy_map(1).unwrap().unwrap();
    let elsewhere: Vec<_> = (0..map.sums.len()).map(|texel| map.flux(texel) * f64::from(PHOTONS)).collect();
    assert!(relative_difference(&elsewhere, &both.reference) > 3.0 * rounding, "the comparison cannot fail");
}

const LAMP: &str = "{ type = \"sphere\", center = [1.0, 2.5, 0.6], radius = 0.05, flux = 35 }";

#[test]
fn ball() {
    assert_alike(&over_a_floor("mesh = \"assets/meshes/ball.obj\"", LAMP), 2e-3);
}

#[test]
fn teapot() {
    assert_alike(&over_a_floor("mesh = \"assets/meshes/teapot.obj\"", LAMP), 5e-3);
}

#[test]
fn crystal() {
    assert_alike(&over_a_floor("mesh = \"assets/meshes/crystal.obj\"", LAMP), 5e-3);
}

#[test]
fn light_that_is_too_near_to_aim() {
    let near = "{ type = \"sphere\", center = [0, 1.05, 0], radius = 0.2, flux = 35 }";
    assert_alike(&over_a_floor("mesh = \"assets/meshes/ball.obj\"", near), 5e-3);
}

#[test]
fn several_casters_share_a_light() {
    let three = "sphere = { center = [0, 0.3, 0], radius = 0.2 }, name = \"first\"";
    let mut scene = over_a_floor(three, LAMP);
    for (index, x) in [-0.5f32, 0.45].into_iter().enumerate() {
        let mut ball = scene.objects[0].clone();
        ball.name = format!("ball {index}");
        ball.world_from_object.translation += diacaustic::glam::Vec3A::new(x, 0.2, 0.1);
        scene.objects.push(ball);
    }
    assert_alike(&scene, 5e-3);
}
