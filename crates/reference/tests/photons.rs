//! Photons against known answers of geometrical optics.

mod shapes;

use diacaustic_reference::geometry::{Sphere, World};
use diacaustic_reference::photons::{
    AimDisc, Emission, End, Event, Ledger, MapLayout, PhotonJob, PhotonPath, PhotonResult, trace, trace_one,
};
use diacaustic_scene::{MaterialKind, Scene};
use glam::{Affine3A, DVec2, DVec3, Vec3};

use shapes::{absorbing_glass, ball, block, diffuse, floor, glass, light, scene, tinted_glass};

const DOWN: DVec3 = DVec3::NEG_Y;

fn job<'a>(world: &'a World<'a>, emission: Emission<'a>, count: u32) -> PhotonJob<'a> {
    PhotonJob { world, maps: &[], light: 0, emission, guide: None, seed: 1, photons: 0..count }
}

fn trace_without_maps(world: &World, emission: Emission, count: u32) -> Ledger {
    let maps = vec![None; world.scene().objects.len()];
    trace(&PhotonJob { maps: &maps, ..job(world, emission, count) }).ledger
}

fn assert_closes(ledger: &Ledger) {
    let error = (ledger.accounted() - ledger.emitted).abs() / ledger.emitted;
    assert!(error.max_element() < 1e-12, "the ledger misses {error} of what was emitted");
}

/// A light as good as at infinity over a slab 0.2 m thick and a floor.
fn slab(kind: MaterialKind) -> Scene {
    let plate = block(Vec3::new(-5.0, 1.0, -5.0), Vec3::new(5.0, 1.2, 5.0));
    let parts = vec![(floor(20.0), diffuse(0.5), Vec3::ZERO), (plate, kind, Vec3::ZERO)];
    scene(parts, vec![light(Vec3::new(0.0, 1000.0, 0.0), 0.5, 10.0)])
}

fn slab_transmittance(scene: &Scene) -> f64 {
    let world = World::new(scene);
    let discs = [AimDisc { center: DVec3::new(0.3, 1.1, 0.2), axis: DOWN, radius: 0.5 }];
    let ledger = trace_without_maps(&world, Emission::Aimed(&discs), 1 << 15);
    assert_closes(&ledger);
    ledger.deposited.x / ledger.emitted.x
}

#[test]
fn slab_passes_light_with_all_inner_reflections() {
    let transmittance = slab_transmittance(&slab(glass(1.5)));
    assert!((transmittance - 3.0 / 3.25).abs() < 2e-4, "{transmittance}");
}

#[test]
fn absorbing_slab() {
    let (f, kept) = (0.04f64, (-2.0f64 * 0.2).exp());
    let expected = (1.0 - f).powi(2) * kept / (1.0 - f * f * kept * kept);
    let mut scene = slab(absorbing_glass(1.5, 2.0));
    let transmittance = slab_transmittance(&scene);
    assert!((transmittance - expected).abs() < 2e-4, "{transmittance} for {expected}");
    // In a mirror, outside stays outside.
    scene.objects[1].world_from_object = Affine3A::from_scale(Vec3::new(-1.0, 1.0, 1.0));
    let mirrored = slab_transmittance(&scene);
    assert!((mirrored - expected).abs() < 2e-4, "{mirrored} for {expected}");
}

#[test]
fn tint_counts_at_each_crossing() {
    let tinted = tinted_glass(1.0, Vec3::new(0.5, 0.8, 1.0), Vec3::ZERO);
    let scene = slab(tinted);
    let world = World::new(&scene);
    let discs = [AimDisc { center: DVec3::Y, axis: DOWN, radius: 0.5 }];
    let ledger = trace_without_maps(&world, Emission::Aimed(&discs), 1000);
    let share = ledger.deposited / ledger.emitted;
    assert!(share.abs_diff_eq(DVec3::new(0.25, 0.64, 1.0), 1e-6), "{share}");
}

/// The paths of a beam as wide as a ball of radius 1, straight down from far away onto it.
fn beam_on_ball(ior: f32, mut visit: impl FnMut(&PhotonPath)) {
    let scene = scene(vec![(ball(1.0, 6), glass(ior), Vec3::ZERO)], vec![light(1e4 * Vec3::Y, 0.1, 1.0)]);
    let world = World::new(&scene);
    let discs = [AimDisc { center: DVec3::ZERO, axis: DOWN, radius: 1.0 }];
    let job = job(&world, Emission::Aimed(&discs), 1 << 15);
    (0..1 << 15).map(|photon| trace_one(&job, photon)).for_each(|path| visit(&path));
}

fn passes_once(path: &PhotonPath) -> bool {
    path.vertices.iter().map(|v| v.event).eq([Event::Refracted, Event::Refracted])
}

#[test]
fn ball_passes_its_share_at_first_pass() {
    for (ior, expected) in [(1.5, 0.8355), (1.333, 0.8814)] {
        let (mut met, mut passed) = (0.0, 0.0);
        beam_on_ball(ior, |path| {
            met += if path.vertices.is_empty() { 0.0 } else { path.flux.x };
            passed += if passes_once(path) { path.vertices[1].flux.x } else { 0.0 };
        });
        assert!((passed / met - expected).abs() < 1e-3, "index {ior}: {}", passed / met);
    }
}

#[test]
fn ball_lens_focuses_as_tabulated() {
    let heights = [(0.01, 1.5000), (0.25, 1.4737), (0.5, 1.3916), (0.75, 1.2410), (0.9, 1.1044)];
    let mut seen = [0; 5];
    beam_on_ball(1.5, |path| {
        let height = path.vertices.first().map_or(0.0, |v| DVec2::new(v.position.x, v.position.z).length());
        let near = heights.iter().position(|(h, _)| (h - height).abs() < 0.01 * h);
        let Some(row) = near.filter(|_| passes_once(path)) else { return };
        let (d, p) = (path.direction, path.vertices[1].position);
        // Where the ray comes nearest to the axis of the beam.
        let across = DVec2::new(d.x, d.z);
        let t = -DVec2::new(p.x, p.z).dot(across) / across.length_squared();
        assert!((-(p + t * d).y - heights[row].1).abs() < 0.02, "{height}: {}", -(p + t * d).y);
        seen[row] += 1;
    });
    assert!(seen[1..].iter().all(|&count| count > 50), "{seen:?}");
}

#[test]
fn ledger_closes_with_everything_in_it() {
    let tinted = tinted_glass(1.5, Vec3::new(0.9, 0.8, 1.0), Vec3::splat(0.7));
    let mirror = MaterialKind::Mirror { reflectance: Vec3::new(0.9, 0.5, 0.1) };
    let parts = vec![
        (floor(2.0), diffuse(0.5), Vec3::ZERO),
        (ball(0.3, 3), tinted, Vec3::new(0.0, 0.5, 0.0)),
        (ball(0.3, 2), mirror, Vec3::new(0.8, 0.4, 0.3)),
    ];
    let lights = vec![light(Vec3::new(0.4, 1.5, 0.1), 0.2, 5.0), light(Vec3::new(-0.5, 1.0, 0.4), 0.2, 5.0)];
    let mut scene = scene(parts, lights);
    scene.settings.max_depth = 3;
    let world = World::new(&scene);
    let ledger = trace_without_maps(&world, Emission::Aimed(&[AimDisc::EVERYWHERE]), 50_000);
    assert_closes(&ledger);
    assert!((ledger.emitted / 50_000.0).abs_diff_eq(DVec3::splat(5.0), 1e-12));
    let Ledger { deposited, direct, absorbed, escaped, cut_off, shading_normals, .. } = ledger;
    for fate in [deposited, direct, absorbed, escaped, cut_off, shading_normals.abs()] {
        assert!(fate.min_element() > 0.0, "{ledger:?}");
    }
}

/// A ball over a floor, with the light that shines on both, and the ball's disc.
fn ball_over_floor(kind: MaterialKind, extra: Vec<(diacaustic_scene::Mesh, MaterialKind, Vec3)>) -> Scene {
    let mut parts = vec![(floor(2.0), diffuse(0.5), Vec3::ZERO), (ball(0.3, 4), kind, Vec3::new(0.0, 0.5, 0.0))];
    parts.extend(extra);
    scene(parts, vec![light(Vec3::new(1.0, 2.5, 0.6), 0.05, 35.0)])
}

fn ball_disc(world: &World, center: DVec3) -> AimDisc {
    AimDisc::around(&world.light_sphere(0).expect("a sphere"), &Sphere { center, radius: 0.3 })
        .expect("the ball is far from the light")
}

#[test]
fn index_one_bends_nothing() {
    let scene = ball_over_floor(glass(1.0), Vec::new());
    let world = World::new(&scene);
    let discs = [ball_disc(&world, DVec3::new(0.0, 0.5, 0.0))];
    let job = job(&world, Emission::Aimed(&discs), 0);
    let mut deposited = 0;
    for photon in 0..2000 {
        let path = trace_one(&job, photon);
        assert!(path.direction.distance(path.start.direction) < 1e-12);
        let (End::Deposited(landing), Some(last)) = (path.end, path.vertices.last()) else { continue };
        deposited += 1;
        let along = path.start.at(-path.start.origin.y / path.start.direction.y);
        assert!(last.position.distance(along) < 1e-11);
        let change = landing.flux / path.flux + path.ledger.shading_normals / path.flux;
        assert!((change - DVec3::ONE).abs().max_element() < 1e-12);
        assert!(path.ledger.shading_normals.length() < 1e-9 * path.flux.length());
    }
    assert!(deposited > 1500, "{deposited}");
}

#[test]
fn aimed_and_unaimed_photons_bring_the_same_light() {
    let other = (ball(0.3, 4), glass(1.5), Vec3::new(0.5, 0.6, 0.3));
    let scene = ball_over_floor(glass(1.5), vec![other]);
    let world = World::new(&scene);
    // The discs overlap as the light sees them.
    let discs = [ball_disc(&world, DVec3::new(0.0, 0.5, 0.0)), ball_disc(&world, DVec3::new(0.5, 0.6, 0.3))];
    let aimed = trace_without_maps(&world, Emission::Aimed(&discs), 1 << 16).deposited.x / f64::from(1 << 16);
    let unaimed =
        trace_without_maps(&world, Emission::Aimed(&[AimDisc::EVERYWHERE]), 1 << 20).deposited.x / f64::from(1 << 20);
    assert!((aimed / unaimed - 1.0).abs() < 0.01, "{aimed} W aimed, {unaimed} W unaimed");
}

#[test]
fn aimed_flux_through_one_disc_is_that_of_the_view_factor() {
    let scene = ball_over_floor(glass(1.5), Vec::new());
    let world = World::new(&scene);
    let radius = 0.4;
    let center = DVec3::new(1.0, 0.5, 0.6);
    let discs = [AimDisc { center, axis: DOWN, radius }];
    let count = 1 << 14;
    let emitted = trace_without_maps(&world, Emission::Aimed(&discs), count).emitted.x / f64::from(count);
    // From a Lambertian sphere to a disc on its axis: the point source's share, exactly.
    let share = 0.5 * (1.0 - 2.0 / (4.0 + radius * radius).sqrt());
    assert!((emitted / (35.0 * share) - 1.0).abs() < 1e-4, "{emitted} W for {} W", 35.0 * share);
}

fn floor_map(size: u32) -> MapLayout {
    let last = f64::from(size - 1);
    let at = |x: f64, y: f64| DVec2::new(x * last, y * last);
    let corners = vec![[at(0.0, 0.0), at(0.0, 1.0), at(1.0, 1.0)], [at(0.0, 0.0), at(1.0, 1.0), at(1.0, 0.0)]];
    MapLayout { width: size, height: size, layers: 2, corners }
}

fn traced_map(world: &World, photons: std::ops::Range<u32>) -> PhotonResult {
    let discs = [ball_disc(world, DVec3::new(0.0, 0.5, 0.0))];
    let maps = [Some(floor_map(33)), None];
    trace(&PhotonJob { maps: &maps, photons, ..job(world, Emission::Aimed(&discs), 0) })
}

#[test]
fn map_holds_what_the_ledger_says() {
    let scene = ball_over_floor(glass(1.5), Vec::new());
    let world = World::new(&scene);
    let PhotonResult { maps, ledger } = traced_map(&world, 0..20_000);
    let (front, back) = maps[0].split_at(33 * 33);
    let sum: DVec3 = front.iter().sum();
    assert!((sum / ledger.deposited - DVec3::ONE).abs().max_element() < 1e-12);
    assert!(back.iter().all(|&texel| texel == DVec3::ZERO) && maps[1].is_empty());
}

#[test]
fn parts_add_up_to_the_whole_on_any_number_of_threads() {
    let scene = ball_over_floor(glass(1.5), Vec::new());
    let world = World::new(&scene);
    let whole = traced_map(&world, 0..10_000);
    let alone = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a pool of one thread");
    assert_eq!(alone.install(|| traced_map(&world, 0..10_000)), whole);
    let [first, second] = [traced_map(&world, 0..3000), traced_map(&world, 3000..10_000)];
    for (texel, total) in whole.maps[0].iter().enumerate() {
        let sum = first.maps[0][texel] + second.maps[0][texel];
        assert!((sum - *total).abs().max_element() <= 1e-12 * total.max_element());
    }
}
