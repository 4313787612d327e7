//! A floor under a ball, and what paths from the eye find there.

use diacaustic_reference::camera::{Estimate, irradiance_at};
use diacaustic_reference::geometry::{Sphere, World};
use diacaustic_reference::light_tracing::Region;
use diacaustic_scene::{Light, MaterialKind, Mesh, Scene};
use glam::{DVec3, Vec3};

use crate::shapes::{ball, diffuse, floor, scene};

/// Where the ball is, metres.
pub const BALL: DVec3 = DVec3::new(0.0, 0.6, 0.0);
/// The ball's radius, metres.
pub const RADIUS: f64 = 0.4;

/// A floor of half width 0.3 m under a ball.
pub fn under_a_ball(mesh: Mesh, kind: MaterialKind, light: Light) -> Scene {
    scene(vec![(floor(0.3), diffuse(0.5), Vec3::ZERO), (mesh, kind, BALL.as_vec3())], vec![light])
}

/// A ball with smooth normals.
pub fn fine_ball() -> Mesh {
    ball(RADIUS as f32, 5)
}

/// The ball as the lights aim at it.
pub fn around_the_ball() -> Sphere {
    Sphere { center: BALL, radius: RADIUS }
}

/// The whole floor, in this number of bins each way.
pub fn floor_region(bins: usize) -> Region {
    let (edge_u, edge_v) = (0.6 * DVec3::X, -0.6 * DVec3::Z);
    Region { center: DVec3::ZERO, edge_u, edge_v, columns: bins, rows: bins }
}

/// The mean over a bin of what paths find, from a grid of points.
pub fn via_casters_on_bin(world: &World, region: &Region, bin: usize, samples: u32) -> Estimate {
    let grid = 8;
    let share = |k: i32| (f64::from(k) + 0.5) / f64::from(grid) - 0.5;
    let mut sum = Estimate { mean: DVec3::ZERO, variance: DVec3::ZERO };
    for (i, j) in (0..grid).flat_map(|i| (0..grid).map(move |j| (i, j))) {
        let across = share(i) * region.edge_u / region.columns as f64 + share(j) * region.edge_v / region.rows as f64;
        let one = irradiance_at(world, region.bin_center(bin) + across, DVec3::Y, samples, 2).via_casters;
        sum.mean += one.mean / f64::from(grid * grid);
        sum.variance += one.variance / f64::from(grid * grid).powi(2);
    }
    sum
}
