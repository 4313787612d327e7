//! Media whose index changes with the wavelength: the colours of light stay what they are in the mean, and each
//! wavelength goes its own way.

mod shapes;
mod under_a_ball;

use diacaustic_reference::camera::{Estimate, radiance};
use diacaustic_reference::fresnel;
use diacaustic_reference::geometry::{Sphere, World};
use diacaustic_reference::light_tracing::irradiance_on;
use diacaustic_reference::photons::{AimDisc, Emission, Event, Ledger, PhotonJob, trace, trace_one};
use diacaustic_reference::random::PhotonNumbers;
use diacaustic_reference::spectrum::Spectrum;
use diacaustic_scene::{
    Dispersion, Light, LightKind, MaterialKind, Mesh, PLASTIC_REFLECTANCE, Scene, WAVELENGTH_STEPS, substance,
    wavelength_table,
};
use glam::{DVec3, Vec3};

use shapes::{ball, block, flat, floor, glass, named, scene};
use under_a_ball::{around_the_ball, fine_ball, floor_region, under_a_ball, via_casters_on_bin};

/// Glass that disperses more than any there is.
fn strong(tint: Vec3, absorption: Vec3) -> MaterialKind {
    let dispersion = Dispersion::Abbe(12.0);
    MaterialKind::Dielectric { ior: 1.4, dispersion, tint, absorption, roughness: 0.0, priority: 1 }
}

fn clear() -> MaterialKind {
    strong(Vec3::ONE, Vec3::ZERO)
}

/// No wider than `loosest` of what is expected, and 4.5 standard deviations and a share `systematic` of it near it, in each
/// channel.
fn assert_agree(found: &Estimate, expected: &Estimate, loosest: f64, systematic: f64, name: &str) {
    let deviation = (found.variance + expected.variance).map(f64::sqrt);
    let scale = expected.mean.abs().max_element();
    assert!(deviation.max_element() < loosest * scale, "{name}: ± {deviation} of {} is too loose", expected.mean);
    let allowed = 4.5 * deviation + systematic * scale;
    let difference = (found.mean - expected.mean).abs();
    assert!(difference.cmplt(allowed).all(), "{name}: {} for {} ± {allowed}", found.mean, expected.mean);
}

fn exactly(mean: DVec3) -> Estimate {
    Estimate { mean, variance: DVec3::ZERO }
}

/// Dispersive balls and a slab, one within another, without loss.
fn furnace(light: Vec3) -> Scene {
    let parts = vec![
        (flat(ball(0.8, 3)), clear(), Vec3::ZERO),
        (flat(ball(0.5, 2)), glass(1.7), Vec3::new(0.5, 0.1, 0.2)),
        (block(Vec3::new(-2.0, -2.0, 1.0), Vec3::new(2.0, 2.0, 1.2)), clear(), Vec3::ZERO),
    ];
    Scene { background: light, ..scene(parts, Vec::new()) }
}

fn assert_all_is_of_the_light(scene: &Scene, pixels: &[(u32, u32)], name: &str) {
    let world = World::new(scene);
    for &(x, y) in pixels {
        let seen = radiance(&world, x, y, 100_000, 0, 7);
        let name = format!("{name}, pixel ({x}, {y})");
        assert_agree(&seen, &exactly(scene.background.as_dvec3()), 0.01, 0.0, &name);
        assert!(seen.variance.min_element() > 0.0, "{name}: no wavelengths");
    }
}

#[test]
fn white_stays_white_and_primaries_keep_their_colour() {
    for light in [Vec3::ONE, Vec3::X, Vec3::Y, Vec3::Z] {
        assert_all_is_of_the_light(&furnace(light), &[(16, 16), (12, 14), (20, 19)], &format!("{light}"));
    }
}

#[test]
fn camera_in_dispersive_glass_divides_by_the_index_of_the_wavelength() {
    let mut scene = Scene { background: Vec3::ONE, ..scene(vec![(ball(1.0, 5), clear(), Vec3::ZERO)], Vec::new()) };
    scene.camera.position = Vec3::ZERO;
    scene.camera.look_at = Vec3::new(0.3, 0.2, 1.0);
    assert_all_is_of_the_light(&scene, &[(16, 16), (3, 28)], "inside");
}

/// A prism of 60° whose edge is along z, its apex up and its base from x = −1 to 1.
fn prism() -> Mesh {
    let at = |x: f32, y: f32, z: f32| Vec3::new(x, y * 3f32.sqrt(), z);
    let front = [at(-1.0, 0.0, 2.0), at(1.0, 0.0, 2.0), at(0.0, 1.0, 2.0)];
    let back = front.map(|p| p - 4.0 * Vec3::Z);
    Mesh {
        positions: front.into_iter().chain(back).collect(),
        triangles: vec![[0, 1, 2], [3, 5, 4], [0, 3, 4], [0, 4, 1], [1, 4, 5], [1, 5, 2], [2, 5, 3], [2, 3, 0]],
        ..Mesh::default()
    }
}

/// Angle of incidence on the prism, radians, about that of least deviation.
const INCIDENCE: f64 = 0.86;

/// A beam of white light that falls on the left face of a prism of N-BK7.
fn beam_on_prism(wavelength: Option<f32>) -> Scene {
    let bk7 = substance("bk7").expect("a substance of this name");
    let kind = MaterialKind::Dielectric {
        ior: bk7.ior,
        dispersion: bk7.dispersion,
        tint: Vec3::ONE,
        absorption: Vec3::ZERO,
        roughness: 0.0,
        priority: 0,
    };
    // The face's normal is 30° above −x.
    let rise = INCIDENCE - 30f64.to_radians();
    let direction = DVec3::new(rise.cos(), rise.sin(), 0.0).as_vec3();
    let beam = LightKind::Distant { direction, angular_radius: 0.0, irradiance: Vec3::ONE };
    let mut scene = scene(vec![(prism(), kind, Vec3::ZERO)], vec![named(beam)]);
    scene.settings.wavelength = wavelength;
    scene
}

/// The angle by which the prism turns light of a wavelength, nm: Snell's law at both faces, with Sellmeier's formula of Schott's
/// data sheet of N-BK7.
fn deviation_at(nm: f64) -> f64 {
    let pairs = [(1.039_612_12, 0.006_000_698_67), (0.231_792_344, 0.020_017_914_4), (1.010_469_45, 103.560_653)];
    let square = 1e-6 * nm * nm;
    let n_squared = 1.0 + pairs.iter().map(|(b, c)| b * square / (square - c)).sum::<f64>();
    let (apex, sin) = (60f64.to_radians(), INCIDENCE.sin());
    INCIDENCE - apex + (apex.sin() * (n_squared - sin * sin).sqrt() - apex.cos() * sin).asin()
}

/// For photons that pass both faces: their wavelength, nm, and by how much they have been turned, radians.
fn deviations(scene: &Scene, photons: u32) -> Vec<(f64, f64)> {
    let world = World::new(scene);
    let middle_of_face = Sphere { center: DVec3::new(-0.5, 0.5 * 3f64.sqrt(), 0.0), radius: 0.1 };
    let emission = Emission::Toward(std::slice::from_ref(&middle_of_face));
    let job = PhotonJob { world: &world, maps: &[None], light: 0, emission, guide: None, seed: 1, photons: 0..photons };
    // White light that the first face reflects keeps its colours.
    let chance = fresnel::reflectance(INCIDENCE.cos(), 1.0 / f64::from(substance("bk7").expect("a substance").ior));
    (0..photons)
        .filter_map(|photon| {
            let path = trace_one(&job, photon);
            let number = PhotonNumbers::new(1, 0, photon).wavelength();
            let Spectrum::Line(wavelength) = path.spectrum else {
                assert!(number < chance, "photon {photon} was refracted and has no wavelength");
                return None;
            };
            if scene.settings.wavelength.is_none() {
                let (expected, _) = Spectrum::drawn((number - chance) / (1.0 - chance), DVec3::ONE);
                let Spectrum::Line(expected) = expected else { panic!("a drawn wavelength is one") };
                assert!((wavelength.nm - expected.nm).abs() < 1e-3, "photon {photon}: {} nm", wavelength.nm);
            }
            let passed = path.vertices.iter().map(|v| v.event).eq([Event::Refracted, Event::Refracted]);
            passed.then(|| (wavelength.nm, path.direction.angle_between(path.start.direction)))
        })
        .collect()
}

#[test]
fn prism_turns_the_lines_of_fraunhofer_as_schott_says() {
    let mut turned = Vec::new();
    for nm in [486.1327, 587.5618, 656.2725] {
        let found = deviations(&beam_on_prism(Some(nm)), 100);
        assert!(found.len() > 70, "{}", found.len());
        for (_, deviation) in &found {
            let expected = deviation_at(f64::from(nm));
            assert!((deviation - expected).abs() < 2e-6, "{nm} nm: {deviation} for {expected}");
        }
        turned.push(found[0].1.to_degrees());
    }
    // About the least deviations 39.14°, 38.65° and 38.43°.
    assert!((turned[0] - 39.14).abs() < 0.02 && (turned[2] - 38.43).abs() < 0.02, "{turned:?}");
}

#[test]
fn prism_spreads_white_light() {
    let found = deviations(&beam_on_prism(None), 1000);
    for (nm, deviation) in &found {
        assert!((deviation - deviation_at(*nm)).abs() < 2e-6, "{nm} nm: {deviation}");
    }
    let [shorter, longer] = [450.0, 620.0].map(|limit| found.iter().filter(|(nm, _)| *nm < limit).count());
    assert!(shorter > 50 && found.len() - longer > 50, "{shorter} under 450 nm, {longer} under 620 nm");
}

/// A light with a colour.
fn lamp() -> Light {
    named(LightKind::Sphere { center: Vec3::new(0.3, 2.2, 0.2), radius: 0.4, flux: Vec3::new(10.0, 5.0, 2.0) })
}

fn coloured_glass() -> MaterialKind {
    strong(Vec3::new(1.0, 0.8, 0.5), Vec3::new(0.2, 0.0, 0.7))
}

#[test]
fn ledger_closes_with_dispersion_which_is_zero_in_the_mean() {
    let mirror = MaterialKind::Mirror { reflectance: Vec3::new(0.9, 0.5, 0.1) };
    let mut scene = under_a_ball(fine_ball(), coloured_glass(), lamp());
    let extra = shapes::scene(vec![(ball(0.2, 2), mirror, Vec3::ZERO)], Vec::new());
    scene.materials.extend(extra.materials);
    scene.objects.extend(extra.objects);
    scene.objects[2].materials = vec![2];
    scene.settings.max_depth = 4;
    let world = World::new(&scene);
    let count = 1 << 15;
    let maps = [None, None, None];
    let lamp = world.light_sphere(0).expect("a sphere");
    let discs = [AimDisc::around(&lamp, &around_the_ball()).expect("the ball is far from the light")];
    let job = PhotonJob {
        world: &world,
        maps: &maps,
        light: 0,
        emission: Emission::Aimed(&discs),
        guide: None,
        seed: 1,
        photons: 0..count,
    };
    let ledger = trace(&job).ledger;
    let error = (ledger.accounted() - ledger.emitted).abs() / ledger.emitted;
    assert!(error.max_element() < 1e-12, "the ledger misses {error} of what was emitted");

    let (mut sum, mut squares, mut met) = (DVec3::ZERO, DVec3::ZERO, 0.0);
    for path in (0..count).map(|photon| trace_one(&job, photon)) {
        let Ledger { dispersion, .. } = path.ledger;
        assert!(path.spectrum == Spectrum::Whole || dispersion != DVec3::ZERO);
        met += f64::from(u8::from(path.spectrum != Spectrum::Whole));
        sum += dispersion;
        squares += dispersion * dispersion;
    }
    assert!((sum - ledger.dispersion).abs().max_element() < 1e-9 * ledger.emitted.x);
    let deviation = squares.map(f64::sqrt);
    assert!(sum.abs().cmplt(4.5 * deviation).all(), "{sum} ± {deviation}");
    let is_sure = deviation.max_element() < 0.02 * ledger.emitted.x && met > 0.5 * f64::from(count);
    assert!(is_sure, "{sum} ± {deviation} of {} from {met} photons", ledger.emitted);
}

#[test]
fn light_and_eye_find_the_same_behind_a_dispersive_ball() {
    let scene = under_a_ball(fine_ball(), coloured_glass(), lamp());
    let world = World::new(&scene);
    let region = floor_region(2);
    let traced = irradiance_on(&world, &region, Some(&around_the_ball()), 1_000_000, 3).via_casters;
    for (bin, traced) in traced.iter().enumerate() {
        let found = via_casters_on_bin(&world, &region, bin, 6000);
        // The second bin is nearly dark.
        assert_agree(&found, traced, 0.05, 0.005, &format!("bin {bin}"));
    }
}

#[test]
fn photons_bring_what_light_tracing_finds_behind_a_dispersive_ball() {
    let (position, flux) = (Vec3::new(0.3, 2.2, 0.2), Vec3::new(10.0, 5.0, 2.0));
    let scene = under_a_ball(fine_ball(), coloured_glass(), named(LightKind::Point { position, flux }));
    let world = World::new(&scene);
    let traced = irradiance_on(&world, &floor_region(1), Some(&around_the_ball()), 1_000_000, 3).via_casters[0];
    let (casters, photons) = ([around_the_ball()], 1 << 18);
    let emission = Emission::Toward(&casters);
    let job =
        PhotonJob { world: &world, maps: &[None, None], light: 0, emission, guide: None, seed: 1, photons: 0..photons };
    let deposited = trace(&job).ledger.deposited / (f64::from(photons) * 0.36);
    assert_agree(&traced, &exactly(deposited), 0.02, 0.003, "traced from the light");
}

/// A dispersive ball before surfaces of all colours, and lights of two.
fn colourful() -> Scene {
    let gold = MaterialKind::Conductor { eta: Vec3::new(0.2, 0.4, 1.4), k: Vec3::new(3.1, 2.4, 1.9), roughness: 0.4 };
    let metal = MaterialKind::MetallicRoughness {
        base_color: Vec3::new(0.2, 0.5, 0.9),
        reflectance: PLASTIC_REFLECTANCE,
        metallic: 0.4,
        roughness: 0.4,
    };
    let green = MaterialKind::Diffuse { albedo: Vec3::new(0.2, 0.7, 0.3) };
    let tinted = MaterialKind::ThinWalled { ior: 1.5, tint: Vec3::new(0.9, 0.9, 0.4), roughness: 0.0 };
    let cube = |half: f32| block(Vec3::splat(-half), Vec3::splat(half));
    let parts = vec![
        (floor(3.0), green, -0.4 * Vec3::Y),
        (flat(ball(0.4, 3)), coloured_glass(), Vec3::ZERO),
        (cube(0.3), gold, Vec3::new(-0.7, 0.0, -1.0)),
        (cube(0.3), metal, Vec3::new(0.6, 0.0, -1.0)),
        (cube(0.3), tinted, Vec3::new(0.0, 0.7, -1.2)),
    ];
    let blue = LightKind::Point { position: Vec3::new(1.5, 2.0, 1.0), flux: Vec3::new(5.0, 10.0, 40.0) };
    let mut scene = scene(parts, vec![lamp(), named(blue)]);
    scene.background = Vec3::new(0.3, 0.2, 0.1);
    scene.camera.vertical_fov = 4.0;
    (scene.settings.width, scene.settings.height) = (1, 1);
    scene
}

/// The mean of what single wavelengths show, each with its colour: `measure` gives gray results for a number of samples.
fn mean_of_wavelengths(scene: &Scene, measure: impl Fn(&World, u64) -> Estimate) -> Estimate {
    let count = 64;
    let mut sum = exactly(DVec3::ZERO);
    for index in 0..count {
        let place = (f64::from(index) + 0.5) / f64::from(count) * WAVELENGTH_STEPS as f64;
        let entry = &wavelength_table()[place.round() as usize];
        let mut alone = scene.clone();
        alone.settings.wavelength = Some(entry.nm as f32);
        let gray = measure(&World::new(&alone), 100 + index as u64);
        let apart = gray.mean.max_element() - gray.mean.min_element();
        assert!(apart <= 1e-12 * gray.mean.x && gray.mean.x > 0.0, "{} nm: {}", entry.nm, gray.mean);
        sum.mean += entry.weight * gray.mean / f64::from(count);
        sum.variance += entry.weight * entry.weight * gray.variance / f64::from(count * count);
    }
    sum
}

#[test]
fn picture_is_the_mean_of_those_of_its_wavelengths() {
    let scene = colourful();
    let seen = radiance(&World::new(&scene), 0, 0, 300_000, 2, 7);
    let mean = mean_of_wavelengths(&scene, |world, seed| radiance(world, 0, 0, 5000, 2, seed));
    assert_agree(&mean, &seen, 0.02, 0.002, "camera");
}

#[test]
fn caustic_is_the_mean_of_those_of_its_wavelengths() {
    let scene = under_a_ball(fine_ball(), coloured_glass(), lamp());
    let measure = |world: &World, photons, seed| {
        irradiance_on(world, &floor_region(1), Some(&around_the_ball()), photons, seed).via_casters[0]
    };
    let found = measure(&World::new(&scene), 500_000, 3);
    let mean = mean_of_wavelengths(&scene, |world, seed| measure(world, 8000, seed));
    assert_agree(&mean, &found, 0.02, 0.002, "light tracing");
}

#[test]
fn scenes_without_dispersion_have_no_wavelengths() {
    let scene = under_a_ball(fine_ball(), glass(1.4), lamp());
    let world = World::new(&scene);
    assert!(!world.has_dispersion() && world.spectrum() == Spectrum::Whole);
    let emission = Emission::Aimed(&[AimDisc::EVERYWHERE]);
    let job =
        PhotonJob { world: &world, maps: &[None, None], light: 0, emission, guide: None, seed: 1, photons: 0..10_000 };
    assert!((0..10_000).all(|photon| trace_one(&job, photon).spectrum == Spectrum::Whole));
    assert_eq!(trace(&job).ledger.dispersion, DVec3::ZERO);
}
