//! Charts: what they promise, on many shapes.

mod any_mesh;
mod even_light;
mod shapes;

use std::collections::BTreeMap;

use diacaustic_scene::{Chart, Mesh, Object};
use diacaustic_surface::{MapLayout, MapTiles, WorldTriangle, texel_areas};
use even_light::{Surface, UNITS, area, check_deposits, world_triangles};
use glam::{DVec2, DVec3, Vec2, Vec3};
use proptest::prelude::*;

/// The area of each texel of one layer, m².
fn layer_areas(layout: &MapLayout, triangles: &[WorldTriangle]) -> Vec<f64> {
    let mut areas = texel_areas(layout, &MapTiles::dense(layout), triangles);
    areas.truncate(areas.len() / layout.layers as usize);
    areas
}

fn places(layout: &MapLayout, triangle: usize) -> [DVec2; 3] {
    layout.corners[triangle].map(Vec2::as_dvec2)
}

/// Whether convex polygons meet, more than `depth` deep.
fn meet(first: &[DVec2], second: &[DVec2], depth: f64) -> bool {
    let extent = |polygon: &[DVec2], axis: DVec2| {
        polygon.iter().map(|p| p.dot(axis)).fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(x), h.max(x)))
    };
    [first, second].iter().all(|polygon| {
        (0..polygon.len()).all(|k| {
            let axis = (polygon[(k + 1) % polygon.len()] - polygon[k]).perp().normalize_or_zero();
            let (low, high) = extent(first, axis);
            let (other_low, other_high) = extent(second, axis);
            axis == DVec2::ZERO || high.min(other_high) - low.max(other_low) > depth
        })
    })
}

/// The cells of the plane that a triangle lies in.
fn cells(layout: &MapLayout, corners: [DVec2; 3]) -> impl Iterator<Item = (u32, u32)> {
    let last = DVec2::new(f64::from(layout.width - 2), f64::from(layout.height - 2));
    let low = corners[0].min(corners[1]).min(corners[2]).floor().clamp(DVec2::ZERO, last);
    let high = corners[0].max(corners[1]).max(corners[2]).floor().clamp(DVec2::ZERO, last);
    let all = (low.y as u32..=high.y as u32).flat_map(move |y| (low.x as u32..=high.x as u32).map(move |x| (x, y)));
    all.filter(move |&(x, y)| {
        let p = DVec2::new(f64::from(x), f64::from(y));
        meet(&corners, &[p, p + DVec2::X, p + DVec2::ONE, p + DVec2::Y], 0.0) || corners[0].floor() == p
    })
}

/// Checks that places are inside, texels belong to one chart each, areas sum to the surface and charts keep their measure.
fn check_layout(object: &Object, layout: &MapLayout) {
    let triangles = world_triangles(object);
    let last = Vec2::new((layout.width - 1) as f32, (layout.height - 1) as f32);
    assert_eq!((layout.corners.len(), layout.charts.len()), (object.mesh.triangles.len(), object.mesh.triangles.len()));
    for place in layout.corners.iter().flatten() {
        assert!(place.cmpge(Vec2::ZERO).all() && place.cmple(last).all(), "{place} is outside {last}");
    }
    let mut owners = vec![u32::MAX; layout.width as usize * layout.height as usize];
    for triangle in &triangles {
        let chart = layout.charts[triangle.triangle as usize];
        assert!(chart < layout.chart_count);
        for (x, y) in cells(layout, places(layout, triangle.triangle as usize)) {
            for texel in [(x, y), (x + 1, y), (x, y + 1), (x + 1, y + 1)] {
                let owner = &mut owners[texel.1 as usize * layout.width as usize + texel.0 as usize];
                assert!([u32::MAX, chart].contains(owner), "texel {texel:?} is of the charts {chart} and {owner}");
                *owner = chart;
            }
        }
    }
    let surface: f64 = triangles.iter().map(area).sum();
    let texels: f64 = layer_areas(layout, &triangles).iter().sum();
    assert!((texels - surface).abs() <= 1e-9 * surface, "{texels} m² of {surface} m²");
}

/// Checks that no two triangles overlap, but for those in cells, and that a texel's width is the same everywhere.
fn check_plane(object: &Object, layout: &MapLayout) {
    let mut near: BTreeMap<(u32, u32), Vec<usize>> = BTreeMap::new();
    let cell_from = layout.chart_count - layout.cell_count;
    let (mut stretched, mut whole) = (0.0, 0.0);
    for triangle in world_triangles(object) {
        let number = triangle.triangle as usize;
        whole += area(&triangle);
        if layout.charts[number] >= cell_from {
            continue;
        }
        let [a, b, c] = places(layout, number);
        let flat = 0.5 * (b - a).perp_dot(c - a).abs() * f64::from(layout.metres_per_texel).powi(2);
        stretched += area(&triangle);
        // Along the axis a triangle only becomes smaller, by the cone's cosine of 0.34 at most.
        let rounding = 1e-3 * whole;
        assert!(flat <= area(&triangle) * 1.001 + rounding && flat >= 0.33 * area(&triangle) - rounding, "{number}");
        for cell in cells(layout, [a, b, c]) {
            near.entry(cell).or_default().push(number);
        }
    }
    assert!(stretched > 0.98 * whole, "more than 2 % of the surface is in cells");
    for numbers in near.values() {
        for (k, &one) in numbers.iter().enumerate() {
            for &other in &numbers[k + 1..] {
                let overlap = meet(&places(layout, one), &places(layout, other), 2e-3);
                assert!(!overlap, "triangles {one} and {other} overlap");
            }
        }
    }
}

#[test]
fn what_lies_on_one_another_is_near() {
    for (name, mesh, map_size) in [("smooth", shapes::scanned(180, 0.5), 160), ("rough", shapes::scanned(90, 3.0), 160)]
    {
        let object = shapes::object(mesh);
        let layout = MapLayout::new(&object, map_size);
        let texel = f64::from(layout.metres_per_texel);
        let cell_from = layout.chart_count - layout.cell_count;
        let mut near: BTreeMap<(u32, u32), Vec<DVec3>> = BTreeMap::new();
        for triangle in world_triangles(&object) {
            let [a, b, c] = triangle.corners.map(Vec3::as_dvec3);
            let longest = a.distance(b).max(b.distance(c)).max(c.distance(a));
            if layout.charts[triangle.triangle as usize] < cell_from && longest < texel {
                for cell in cells(&layout, places(&layout, triangle.triangle as usize)) {
                    near.entry(cell).or_default().push((a + b + c) / 3.0);
                }
            }
        }
        let mut farthest: f64 = 0.0;
        for middles in near.values() {
            for (k, one) in middles.iter().enumerate() {
                farthest = middles[k + 1..].iter().fold(farthest, |far, other| far.max(one.distance(*other) / texel));
            }
        }
        println!("{name}: {farthest:.2} texels, {} charts, {} cells", layout.chart_count, layout.cell_count);
        // Four texels, with the height of what is in a cell's width of a steep slope.
        assert!(farthest < 7.0, "{name}: {farthest} texels apart, and in one cell");
    }
}

#[test]
fn nothing_overlaps() {
    let shapes = [
        ("sphere", Mesh::sphere(Vec3::ZERO, 1.0, 5), 300),
        ("torus knot", shapes::torus_knot(300, 16), 700),
        ("room", shapes::l_room(), 200),
        ("teapot", shapes::teapot(), 1500),
        ("screw", shapes::screw(40), 400),
        ("fan", shapes::fan(1500, 1), 200),
        ("fan that goes around twice", shapes::fan(300, 2), 200),
    ];
    for (name, mesh, map_size) in shapes {
        let object = shapes::object(mesh);
        let layout = MapLayout::new(&object, map_size);
        println!("{name}: {} charts, {} cells", layout.chart_count, layout.cell_count);
        check_layout(&object, &layout);
        check_plane(&object, &layout);
    }
}

#[test]
fn front_and_back_of_a_thin_plate_stay_apart() {
    // A closed plate 1 m wide and 0.1 mm thick, on texels of a centimetre.
    let mut mesh = Mesh::cuboid(Vec3::ZERO, Vec3::new(1.0, 1e-4, 1.0));
    mesh.chart = Chart::Automatic;
    let object = shapes::object(mesh);
    let layout = MapLayout::with_texel_width(&object, 0.01);
    check_layout(&object, &layout);
    assert_eq!(layout.layers, 1);
    let facing = |up: f32| {
        let object = &object;
        let charts = &layout.charts;
        (0..12).filter(move |&t| object.mesh.double_area_normal(t).y * up > 0.1).map(move |t| charts[t])
    };
    assert!(facing(1.0).all(|chart| facing(-1.0).all(|other| other != chart)));
    // Its edges take next to nothing.
    assert!(layout.texel_count() < 3 * 2 * 100 * 100, "{}", layout.texel_count());
}

#[test]
fn open_surfaces_have_two_layers() {
    assert_eq!(MapLayout::new(&shapes::object(shapes::screw(1)), 64).layers, 2);
    assert_eq!(MapLayout::new(&shapes::object(shapes::l_room()), 64).layers, 1);
}

#[test]
fn texels_are_few_however_small_the_triangles() {
    let surfaces = [
        ("smooth", shapes::scanned(180, 0.1)),
        ("rough", shapes::scanned(180, 3.0)),
        ("grains", grains(20_000)),
        ("facets apart", apart(shapes::scanned(60, 0.5))),
    ];
    for (name, mesh) in surfaces {
        let object = shapes::object(mesh);
        let surface: f64 = world_triangles(&object).iter().map(area).sum();
        for asked in [1000.0, 10_000.0] {
            let layout = MapLayout::with_texel_width(&object, (surface / asked).sqrt() as f32);
            check_layout(&object, &layout);
            let texels = f64::from(layout.width) * f64::from(layout.height);
            println!("{name}: {texels} texels for {asked}, {} charts, {} cells", layout.chart_count, layout.cell_count);
            assert!(texels < 5.0 * asked + 100.0, "{name}: {texels} texels where the area asks for {asked}");
        }
        let layout = MapLayout::with_texel_width(&object, (surface / 4000.0).sqrt() as f32);
        check_deposits(name, &Surface::new(&object, layout), 200_000);
    }
}

/// Small tetrahedra, scattered.
fn grains(count: u32) -> Mesh {
    let mut mesh = Mesh::default();
    for grain in 0..count {
        let at = DVec3::from([0, 1, 2].map(|k| 100.0 * shapes::hashed(3 * grain + k)));
        let first = mesh.positions.len() as u32;
        mesh.positions.extend([DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z].map(|p| (at + 0.1 * p).as_vec3()));
        mesh.triangles.extend([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]].map(|t: [u32; 3]| t.map(|v| first + v)));
    }
    mesh
}

/// Every triangle moved a little along its normal, so that none borders on another.
fn apart(mesh: Mesh) -> Mesh {
    let mut result = Mesh::default();
    for triangle in 0..mesh.triangles.len() {
        let first = result.positions.len() as u32;
        let shift = mesh.double_area_normal(triangle).normalize_or_zero() * 1e-3 * (triangle % 7) as f32;
        result.positions.extend(mesh.corners(triangle).map(|p| p + shift));
        result.triangles.push([first, first + 1, first + 2]);
    }
    result
}

#[test]
fn texels_are_no_finer_than_places_can_say() {
    let object = shapes::object(shapes::torus_knot(60, 8));
    let layout = MapLayout::with_texel_width(&object, 1e-9);
    assert!((50_000..200_000).contains(&layout.width.max(layout.height)), "{} × {}", layout.width, layout.height);
    assert!(layout.metres_per_texel > 1e-6);
    let last = Vec2::new((layout.width - 1) as f32, (layout.height - 1) as f32);
    assert!(layout.corners.iter().flatten().all(|p| p.cmpge(Vec2::ZERO).all() && p.cmple(last).all()));
}

#[test]
fn threads_do_not_matter() {
    let object = shapes::object(shapes::scanned(100, 1.0));
    let on = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| [200, 900].map(|map_size| MapLayout::new(&object, map_size)))
    };
    let alone = on(1);
    assert!((2..5).all(|threads| on(threads) == alone));
}

#[test]
fn placement_counts() {
    let mut object = shapes::object(shapes::torus_knot(60, 8));
    object.world_from_object = glam::Affine3A::from_scale(Vec3::new(-3.0, 1.0, 0.2));
    let layout = MapLayout::new(&object, 300);
    check_layout(&object, &layout);
    check_plane(&object, &layout);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn any_mesh_has_charts(mesh in any_mesh::any_mesh(), map_size in 2u32..200) {
        let object = shapes::object(mesh);
        let layout = MapLayout::new(&object, map_size);
        let triangles = world_triangles(&object);
        check_layout(&object, &layout);
        if !triangles.is_empty() {
            let surface = Surface::new(&object, layout);
            let deposited: i64 = surface.lit_evenly(100).iter().map(|texel| texel.sum).sum();
            prop_assert_eq!(deposited, 100 * UNITS);
            // Even light is even, however small the parts of charts that texels hold.
            let areas = surface.areas();
            let shown = surface.welds().irradiance(&areas, &areas);
            let is_even = |(value, area): (&f64, &f64)| *area <= 0.0 || (value - 1.0).abs() < 1e-6;
            prop_assert!(shown.iter().zip(&areas).all(is_even));
        }
    }

    #[test]
    fn charts_of_any_mesh_do_not_overlap(mesh in any_mesh::any_mesh()) {
        let object = shapes::object(mesh);
        let layout = MapLayout::new(&object, 400);
        if layout.cell_count == 0 && layout.width.max(layout.height) <= 400 {
            check_plane_overlap(&object, &layout);
        }
    }
}

/// Checks that no two triangles overlap on the plane, however few or large.
fn check_plane_overlap(object: &Object, layout: &MapLayout) {
    let triangles: Vec<usize> =
        world_triangles(object).iter().filter(|t| !is_line(object, t)).map(|t| t.triangle as usize).collect();
    for (k, &one) in triangles.iter().enumerate() {
        for &other in &triangles[k + 1..] {
            assert!(!meet(&places(layout, one), &places(layout, other), 2e-2), "triangles {one} and {other} overlap");
        }
    }
}

/// Whether a triangle is so flat that single precision may take its corners for points of a line. Such a one has no place of its own.
fn is_line(object: &Object, triangle: &WorldTriangle) -> bool {
    let [a, b, c] = triangle.corners.map(Vec3::as_dvec3);
    let longest = (b - a).length().max((c - b).length()).max((a - c).length());
    let farthest = object.mesh.positions.iter().map(|p| p.abs().max_element()).fold(0.0, f32::max);
    2.0 * area(triangle) <= 1e-6 * f64::from(farthest) * longest
}

#[test]
fn a_line_by_rounding_breaks_nothing() {
    // The corners of the first triangle are in line, but for the rounding of their difference.
    let positions = [
        [3e-6, 2e-6, 3e-6],
        [3e-6, -4e-6, -3e-6],
        [3e-6, 0.0, 1e-6],
        [0.0, 0.0, 1e-6],
        [3e-6, 0.0, 0.0],
        [0.0, -6.690_009e-7, 0.0],
    ];
    let positions = positions.map(Vec3::from).to_vec();
    let object = shapes::object(Mesh { positions, triangles: vec![[0, 1, 2], [3, 4, 5]], ..Mesh::default() });
    assert_ne!(object.mesh.double_area_normal(0), Vec3::ZERO);
    let layout = MapLayout::new(&object, 400);
    check_layout(&object, &layout);
    check_plane_overlap(&object, &layout);
}
