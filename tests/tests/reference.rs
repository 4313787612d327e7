//! The photon kernel against the double-precision reference: the same photons must fill the same texels.

use diacaustic::{
    Emission, Guide, GuideTable,
    glam::{DVec3, Vec3},
};
use diacaustic_reference::{
    geometry::{Sphere, World},
    photons::{self, AimDisc, Emission as ReferenceEmission, MapLayout, PhotonJob, trace},
};
use diacaustic_scene::{MaterialKind, Mesh, Scene, Texture};
use diacaustic_tests::{emit, normal_pattern, pattern, scene};

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
    /// Emitted, deposited, direct, absorbed, escaped, shading normals, dispersion.
    gpu_ledger: [DVec3; 7],
    reference_ledger: [DVec3; 7],
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
    let spheres: Vec<Sphere>;
    let vector = |v: [f32; 3]| DVec3::from(v.map(f64::from));
    let emission = match renderer.emission(0).unwrap().expect("the light emits") {
        Emission::Aimed(list) => {
            discs = list
                .iter()
                .map(|d| AimDisc { center: vector(d.center), axis: vector(d.axis), radius: f64::from(d.radius) })
                .collect();
            ReferenceEmission::Aimed(&discs)
        }
        Emission::Paper { .. } => panic!("the reference follows the physical model"),
        Emission::Toward(list) => {
            spheres = list
                .iter()
                .map(|target| Sphere { center: vector(target.center), radius: f64::from(target.radius) })
                .collect();
            ReferenceEmission::Toward(&spheres)
        }
    };
    let guide = renderer.guide(0).unwrap().map(published);
    let world = World::new(scene);
    let job = PhotonJob {
        world: &world,
        maps: &layouts,
        light: 0,
        emission,
        guide: guide.as_ref(),
        seed: scene.settings.seed,
        photons: 0..PHOTONS,
    };
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
            ledger.dispersion,
        ]
        .map(watts),
        reference_ledger: [l.emitted, l.deposited, l.direct, l.absorbed, l.escaped, l.shading_normals, l.dispersion],
    }
}

/// The renderer's guide for the reference.
fn published(guide: &Guide) -> photons::Guide {
    let wide = |bounds: &[f32]| bounds.iter().copied().map(f64::from).collect::<Vec<_>>();
    let table = |table: &GuideTable| photons::GuideTable {
        columns: wide(&table.column_bounds),
        rows: table.row_bounds.chunks_exact(table.rows + 1).map(wide).collect(),
    };
    photons::Guide { aim: table(&guide.aim), place: table(&guide.place) }
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
fn a_ball_of_colored_vertices() {
    let mut scene = over_a_floor("sphere = { center = [0, 0.3, 0], radius = 0.2 }", LAMP);
    let mesh = std::sync::Arc::make_mut(&mut scene.objects[0].mesh);
    mesh.colors = mesh
        .positions
        .iter()
        .map(|p| (0.5 + 2.0 * (*p - Vec3::new(0.0, 0.3, 0.0))).clamp(Vec3::ZERO, Vec3::ONE))
        .collect();
    // The floor's colours have no part in what its map holds.
    assert_alike(&scene, 5e-3);
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

const BALL: &str = "mesh = \"assets/meshes/ball.obj\"";

#[test]
fn points_spots_and_distant_light() {
    for light in [
        "{ type = \"point\", position = [1, 2.5, 0.6], flux = [35, 20, 10] }",
        "{ type = \"spot\", position = [1, 2.5, 0.6], look_at = [0.1, 0.3, 0], inner_angle = 3, outer_angle = 9, flux = 5 }",
        "{ type = \"directional\", direction = [-0.4, -1, -0.2], irradiance = [3, 2, 1] }",
        "{ type = \"sun\", direction = [-0.4, -1, -0.2], angular_radius = 2, irradiance = 3 }",
    ] {
        assert_alike(&over_a_floor(BALL, light), 3e-3);
    }
}

#[test]
fn point_within_the_bounds_of_a_caster() {
    // Every direction is drawn from within a bounding sphere; the crystal leaves room in its own.
    let near = "{ type = \"point\", position = [0.28, 0.22, 0], flux = 35 }";
    assert_alike(&over_a_floor("mesh = \"assets/meshes/crystal.obj\"", near), 5e-3);
}

/// The scene of the ball with another material of glass, and perhaps of the floor, and further objects.
fn of(glass: &str, floor: &str, more: &str) -> Scene {
    scene(&format!(
        "camera = {{ position = [0, 2.2, 3.2], look_at = [0, 0.2, 0], vertical_fov = 40 }}
         render = {{ map_size = 33, max_depth = 32, seed = 11 }}
         materials.glass = {glass}
         materials.floor = {floor}
         materials.water = {{ type = \"dielectric\", substance = \"water\", absorption = [0.5, 0.1, 0] }}
         materials.pane = {{ type = \"thin_walled\", tint = [0.9, 1, 0.8] }}
         lights = [{LAMP}]
         objects = [
             {{ {BALL}, material = \"glass\", translate = [0, 0.2, 0] }},
             {{ rectangle = {{ center = [0, 0, 0], edge_u = [2, 0, 0], edge_v = [0, 0, -2] }}, material = \"floor\" }},
             {more}
         ]"
    ))
}

const PLASTER: &str = "{ type = \"diffuse\", albedo = 0.8 }";

#[test]
fn rough_glass_and_metal() {
    for glass in [
        "{ type = \"dielectric\", ior = 1.5, roughness = 0.2, tint = [1, 0.9, 0.8] }",
        "{ type = \"conductor\", metal = \"copper\" }",
        "{ type = \"conductor\", metal = \"gold\", roughness = 0.4 }",
        "{ type = \"thin_walled\", tint = [1, 0.9, 0.8], roughness = 0.3 }",
    ] {
        assert_alike(&of(glass, PLASTER, ""), 5e-3);
    }
}

#[test]
fn coats_and_gloss() {
    let glass = "{ type = \"dielectric\", ior = 1.5 }";
    for floor in [
        "{ type = \"coated\", albedo = [0.8, 0.4, 0.2] }",
        "{ type = \"coated\", albedo = 0.5, roughness = 0.5 }",
        "{ type = \"metallic_roughness\", base_color = [0.9, 0.5, 0.3], metallic = 0.4, roughness = 0.2 }",
    ] {
        assert_alike(&of(glass, floor, ""), 5e-3);
    }
}

/// A second ball before the first as each light sees it, and a varnished table, in whose bounds a near lamp stands: most rays could
/// have been sent by several targets.
#[test]
fn guides_of_targets_that_overlap() {
    let more = "{ sphere = { center = [0.15, 0.75, 0.1], radius = 0.15 }, material = \"glass\" }";
    let mut scene = of("{ type = \"dielectric\", ior = 1.5 }", "{ type = \"coated\", albedo = 0.5 }", more);
    for light in [
        LAMP,
        "{ type = \"sphere\", center = [0.6, 0.9, 0.3], radius = 0.05, flux = 35 }",
        "{ type = \"point\", position = [0.6, 1.9, 0.3], flux = 35 }",
        "{ type = \"sun\", direction = [-0.2, -1, -0.1], angular_radius = 2, irradiance = 3 }",
    ] {
        scene.lights = over_a_floor(BALL, light).lights;
        assert_alike(&scene, 5e-3);
    }
}

#[test]
fn nested_media_and_a_pane() {
    let more = "{ box = { min = [-0.25, 0.1, -0.25], max = [0.3, 0.45, 0.25] }, material = \"water\" },
         { rectangle = { center = [0.2, 1.2, 0], edge_u = [1, 0, 0], edge_v = [0, 0.2, -1] }, material = \"pane\" }";
    assert_alike(&of("{ type = \"dielectric\", ior = 1.5, priority = 1 }", PLASTER, more), 5e-3);
}

#[test]
fn pictures_on_glass_metal_and_floor() {
    let tiles =
        || pattern(4, 4, |x, y| [0.5 + 0.1 * x as f32, 0.6 + 0.1 * y as f32, 0.9, 0.4 + 0.1 * ((x + y) % 4) as f32]);
    let waves = || normal_pattern(8, 8, |x, y| [0.05 * (x as f32 - 3.5), 0.1 * ((y % 3) as f32 - 1.0)]);
    let alpha = || Some(Texture { channel: 3, ..tiles() });
    for (glass, floor) in [
        ("{ type = \"dielectric\", ior = 1.5 }", PLASTER),
        ("{ type = \"dielectric\", ior = 1.5, roughness = 0.5 }", PLASTER),
        ("{ type = \"conductor\", metal = \"gold\", roughness = 0.5 }", "{ type = \"coated\", albedo = 0.9 }"),
    ] {
        let mut scene = of(glass, floor, "");
        // The normal map has edges at which single photons part from their twins; a rare one that the guide makes heavy would show.
        scene.settings.guiding = false;
        scene.objects[0].mesh = Mesh::sphere(Vec3::new(0.0, 0.3, 0.0), 0.3, 6).into();
        for material in
            scene.materials.iter_mut().filter(|material| ["glass", "floor"].contains(&material.name.as_str()))
        {
            material.textures.normal = waves();
            match material.kind {
                MaterialKind::Dielectric { roughness, .. } => {
                    material.textures.color = Some(tiles());
                    material.textures.roughness = alpha().filter(|_| roughness > 0.0);
                }
                MaterialKind::Conductor { .. } => material.textures.roughness = alpha(),
                _ => material.textures.color = Some(tiles()),
            }
        }
        assert_alike(&scene, 5e-3);
    }
}

#[test]
fn a_mask_passes_light_where_it_has_holes() {
    let more =
        "{ rectangle = { center = [0.2, 1.2, 0], edge_u = [1, 0, 0], edge_v = [0, 0.2, -1] }, material = \"pane\" }";
    let mut scene = of("{ type = \"dielectric\", ior = 1.5 }", PLASTER, more);
    let pane = scene.materials.iter_mut().find(|material| material.name == "pane").expect("the pane's material");
    pane.textures.opacity = Some(pattern(8, 8, |x, y| [((x + y) % 2) as f32; 4]));
    pane.opacity_cutoff = Some(0.5);
    assert_alike(&scene, 5e-3);
    // The same holes by the opacity of vertices: half of the pane.
    let index = scene.materials.iter().position(|material| material.name == "pane").expect("the pane's material");
    scene.materials[index].textures.opacity = None;
    let pane = scene.objects.iter_mut().find(|object| object.name == "rectangle 2").expect("the pane");
    std::sync::Arc::make_mut(&mut pane.mesh).opacities = vec![1.0, 0.0, 0.0, 1.0];
    assert_alike(&scene, 5e-3);
}

#[test]
fn dispersing_glass() {
    for glass in [
        "{ type = \"dielectric\", ior = 1.6, abbe = 25, tint = [1, 0.8, 0.6], absorption = [0.1, 0.5, 1] }",
        "{ type = \"dielectric\", substance = \"sf11\", roughness = 0.1 }",
    ] {
        assert_alike(&of(glass, PLASTER, ""), 1e-2);
    }
    let mut line = of("{ type = \"dielectric\", substance = \"diamond\", tint = [1, 0.8, 0.6] }", PLASTER, "");
    line.settings.wavelength = Some(486.13);
    assert_alike(&line, 5e-3);
}
