//! Meshes for charts to be grown on.
#![allow(dead_code, unused_imports, reason = "each user takes some of them")]

mod random_mesh;

use std::{f64::consts::TAU, path::Path, sync::Arc};

use diacaustic_scene::{Mesh, MeshOptions, Object, load_obj};
use glam::{Affine3A, DVec2, DVec3, Vec3};

pub use self::random_mesh::random_mesh;

/// An object of a mesh, where the mesh is.
pub fn object(mesh: Mesh) -> Object {
    Object {
        name: "receiver".to_owned(),
        materials: vec![0; mesh.material_slots.len().max(1)],
        mesh: Arc::new(mesh),
        world_from_object: Affine3A::IDENTITY,
        map_size: None,
    }
}

/// A surface over a grid of `columns` × `rows` cells of the unit square that closes on itself along both sides.
pub fn closed_grid(columns: u32, rows: u32, point: impl Fn(DVec2) -> DVec3) -> Mesh {
    let mut mesh = Mesh::default();
    for row in 0..rows {
        for column in 0..columns {
            let at = DVec2::new(f64::from(column) / f64::from(columns), f64::from(row) / f64::from(rows));
            mesh.positions.push(point(at).as_vec3());
        }
    }
    let vertex = |column: u32, row: u32| row % rows * columns + column % columns;
    for row in 0..rows {
        for column in 0..columns {
            let [a, b] = [vertex(column, row), vertex(column + 1, row)];
            let [c, d] = [vertex(column + 1, row + 1), vertex(column, row + 1)];
            mesh.triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    mesh
}

/// A tube around the knot that winds twice around the axis while it winds three times around the ring, 3 m wide.
pub fn torus_knot(columns: u32, rows: u32) -> Mesh {
    let center = |t: f64| {
        let ring = 1.0 + 0.4 * (3.0 * t).cos();
        DVec3::new(ring * (2.0 * t).cos(), 0.4 * (3.0 * t).sin(), ring * (2.0 * t).sin())
    };
    closed_grid(columns, rows, |at| {
        let t = TAU * at.x;
        let along = (center(t + 1e-4) - center(t - 1e-4)).normalize();
        let side = along.cross(DVec3::Y).normalize();
        let around = DVec2::from_angle(TAU * at.y);
        center(t) + 0.15 * (side * around.x + side.cross(along) * around.y)
    })
}

/// The walls, floor and ceiling of a room with an L for its plan, 4 m × 4 m × 2.5 m: seen from inside.
pub fn l_room() -> Mesh {
    let plan = [(0.0, 0.0), (4.0, 0.0), (4.0, 2.0), (2.0, 2.0), (2.0, 4.0), (0.0, 4.0)];
    let mut mesh = Mesh::default();
    for y in [0.0, 2.5] {
        mesh.positions.extend(plan.map(|(x, z)| Vec3::new(x, y, z)));
    }
    for k in 0..6 {
        let next = (k + 1) % 6;
        mesh.triangles.extend([[k, next, next + 6], [k, next + 6, k + 6]]);
    }
    for [a, b, c] in [[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 5]] {
        mesh.triangles.extend([[a, c, b], [a + 6, b + 6, c + 6]]);
    }
    mesh
}

/// The project's teapot.
pub fn teapot() -> Mesh {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().find(|folder| folder.join("assets/meshes").exists());
    let path = path.expect("the repository").join("assets/meshes/teapot.obj");
    load_obj(&path, &MeshOptions::default()).unwrap_or_else(|error| panic!("{error}")).mesh
}

/// A sphere of radius 1 m as a scanner might see it: waves of all lengths and noise of a share of the triangles' width.
pub fn scanned(bands: u32, noise: f64) -> Mesh {
    let mut mesh = Mesh::default();
    let sectors = 2 * bands;
    let width = std::f64::consts::PI / f64::from(bands);
    let point = |band: u32, sector: u32| {
        let (theta, phi) = (width * f64::from(band), width * f64::from(sector % sectors));
        let normal = DVec3::new(theta.sin() * phi.cos(), theta.cos(), theta.sin() * phi.sin());
        let waves = (0..7).map(|octave| {
            let frequency = f64::from(1 << octave);
            (normal * 3.0 * frequency + f64::from(octave)).to_array().iter().map(|x| x.sin()).product::<f64>() * 0.06
                / frequency
        });
        let number = if band == 0 || band == bands { band } else { band * sectors + sector % sectors };
        (normal * (1.0 + waves.sum::<f64>() + noise * width * (hashed(number) - 0.5))).as_vec3()
    };
    for band in 0..=bands {
        mesh.positions.extend((0..sectors).map(|sector| point(band, sector)));
    }
    let vertex = |band: u32, sector: u32| band * sectors + sector % sectors;
    for band in 0..bands {
        for sector in 0..sectors {
            let [a, b] = [vertex(band, sector), vertex(band, sector + 1)];
            let [c, d] = [vertex(band + 1, sector), vertex(band + 1, sector + 1)];
            mesh.triangles.extend((band > 0).then_some([a, b, c]));
            mesh.triangles.extend((band + 1 < bands).then_some([b, d, c]));
        }
    }
    mesh
}

/// A disk of slivers around its middle that goes around some times, slowly rising.
pub fn fan(slivers: u32, turns: u32) -> Mesh {
    let mut mesh = Mesh { positions: vec![Vec3::ZERO], ..Mesh::default() };
    for k in 0..slivers {
        let angle = TAU * f64::from(k * turns) / f64::from(slivers);
        mesh.positions.push(DVec3::new(angle.cos(), 1e-2 * angle, -angle.sin()).as_vec3());
        let next = if k + 1 < slivers { k + 2 } else { 1 };
        mesh.triangles.extend((turns == 1 || k + 1 < slivers).then_some([0, k + 1, next]));
    }
    mesh
}

/// A helical ramp, whose turns lie one above the other and face the same way.
pub fn screw(turns: u32) -> Mesh {
    let mut mesh = Mesh::default();
    for step in 0..=16 * turns {
        let angle = f64::from(step) * TAU / 16.0;
        for radius in [0.5, 1.0] {
            mesh.positions.push(DVec3::new(radius * angle.cos(), 0.02 * angle, -radius * angle.sin()).as_vec3());
        }
    }
    for k in (0..2 * 16 * turns).step_by(2) {
        mesh.triangles.extend([[k, k + 1, k + 3], [k, k + 3, k + 2]]);
    }
    mesh
}

/// A number in [0, 1) that looks random (Wellons 2018).
pub fn hashed(number: u32) -> f64 {
    let mut x = number.wrapping_add(0x9e37_79b9);
    x = (x ^ x >> 16).wrapping_mul(0x21f0_aaad);
    x = (x ^ x >> 15).wrapping_mul(0x735a_2d97);
    f64::from(x ^ x >> 15) / 4_294_967_296.0
}
