//! Bumpy surfaces with all that meshes may have wrong.

use std::f64::consts::TAU;

use diacaustic_scene::Mesh;
use glam::{DVec2, DVec3};

use super::{closed_grid, hashed};

/// Any surface: a bumpy ring or sphere of few or many triangles, some of them slivers, of which parts may be missing, turned over, there twice,
/// cut where their neighbours are not, or have fins.
pub fn random_mesh(seed: u32) -> Mesh {
    let mut numbers = (0..).map(|k| hashed(seed.wrapping_mul(0x9e37_79b1).wrapping_add(k)));
    let mut next = || numbers.next().unwrap_or(0.0);
    let (columns, rows) = ((4.0 * 12f64.powf(next())) as u32, (4.0 * 12f64.powf(next())) as u32);
    let crowding = (next() < 0.5).then(|| 1.0 + 4.0 * next());
    let waves: Vec<(DVec3, f64, f64)> = (0..(6.0 * next()) as u32)
        .map(|_| (DVec3::new(next(), next(), next()) * 16.0 - 8.0, TAU * next(), 0.2 * next().powi(2)))
        .collect();
    let noise = 0.3 * next().powi(4);
    let (thickness, height) = (0.1 + 0.5 * next(), 0.3 + next());
    let mut mesh = closed_grid(columns, rows, |at| {
        let crowded = |x: f64| crowding.map_or(x, |power| x.powf(power));
        let (around, across) = (DVec2::from_angle(TAU * crowded(at.x)), DVec2::from_angle(TAU * crowded(at.y)));
        let p = DVec3::new(
            around.x * (1.0 + thickness * across.x),
            height * thickness * across.y,
            -around.y * (1.0 + thickness * across.x),
        );
        let bump: f64 = waves.iter().map(|(direction, phase, size)| size * (direction.dot(p) + phase).sin()).sum();
        p * (1.0 + bump)
    });
    for p in &mut mesh.positions {
        *p += (DVec3::new(next(), next(), next()) - 0.5).as_vec3() * noise as f32;
    }
    let shares: [f64; 5] = std::array::from_fn(|_| if next() < 0.5 { 0.0 } else { 0.3 * next() });
    for [a, b, c] in std::mem::take(&mut mesh.triangles) {
        if next() < shares[0] {
            continue;
        }
        let triangle = if next() < shares[1] { [a, c, b] } else { [a, b, c] };
        mesh.triangles.push(triangle);
        if next() < shares[2] {
            mesh.triangles.push(if next() < 0.5 { triangle } else { [triangle[1], triangle[0], triangle[2]] });
        }
        if next() < shares[3] {
            let normal = mesh.double_area_normal(mesh.triangles.len() - 1).normalize_or_zero();
            let middle = mesh.positions[a as usize].midpoint(mesh.positions[b as usize]);
            mesh.positions.push(middle + normal * next() as f32 * 0.2);
            mesh.triangles.push([a, b, mesh.positions.len() as u32 - 1]);
        }
        if next() < shares[4] {
            // A sliver along an edge, and a cut that the neighbours do not have.
            let [a, b, c] = triangle;
            mesh.triangles.pop();
            let [p, q, r] = triangle.map(|vertex| mesh.positions[vertex as usize]);
            mesh.positions.push(p.lerp(q, next() as f32).lerp(r, 0.02 * next() as f32));
            let middle = mesh.positions.len() as u32 - 1;
            mesh.triangles.extend([[a, b, middle], [b, c, middle], [c, a, middle]]);
        }
    }
    mesh
}
