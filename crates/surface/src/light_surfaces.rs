//! Triangles of the lights that have a surface.

use std::f64::consts::{PI, TAU};

use diacaustic_scene::{LightKind, Scene};
use glam::Vec3;

use crate::WorldTriangle;

/// Corners of the polygon that stands for a disk light.
pub const DISK_CORNERS: u32 = 128;

/// The surfaces of the scene's rectangle and disk lights, facing where they shine.
///
/// Their object is the number of the scene's objects plus the light's index, their material the number of the scene's materials plus the
/// light's index. A disk is a regular polygon of [`DISK_CORNERS`] corners of the disk's area.
pub fn light_surfaces(scene: &Scene) -> Vec<WorldTriangle> {
    let mut triangles = Vec::new();
    for (light, kind) in scene.lights.iter().map(|light| &light.kind).enumerate() {
        let outline = outline(kind);
        let fan = outline.windows(2).skip(1).enumerate().map(|(number, pair)| WorldTriangle {
            corners: [outline[0], pair[0], pair[1]],
            normals: None,
            uvs: None,
            object: (scene.objects.len() + light) as u32,
            triangle: number as u32,
            material: (scene.materials.len() + light) as u32,
            exchanged: false,
        });
        triangles.extend(fan);
    }
    triangles
}

/// The corners of a light's surface, counter-clockwise seen from its front; none without surface.
fn outline(kind: &LightKind) -> Vec<Vec3> {
    match *kind {
        LightKind::Rectangle { center, edge_u, edge_v, .. } => {
            [(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)].map(|(u, v)| center + u * edge_u + v * edge_v).to_vec()
        }
        LightKind::Disk { center, normal, radius, .. } => {
            let normal = normal.as_dvec3().normalize();
            // `frame` of docs/photon-paths.md.
            let (tangent, bitangent) = normal.any_orthonormal_pair();
            let step = TAU / f64::from(DISK_CORNERS);
            let reach = f64::from(radius) * (2.0 * PI / (f64::from(DISK_CORNERS) * step.sin())).sqrt();
            (0..DISK_CORNERS)
                .map(|corner| {
                    let (sin, cos) = (f64::from(corner) * step).sin_cos();
                    (center.as_dvec3() + reach * (cos * tangent + sin * bitangent)).as_vec3()
                })
                .collect()
        }
        LightKind::Sphere { .. }
        | LightKind::Point { .. }
        | LightKind::Spot { .. }
        | LightKind::Distant { .. }
        | LightKind::Environment { .. } => Vec::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn area_and_normal(kind: &LightKind) -> (f32, Vec3) {
        let corners = outline(kind);
        let sum: Vec3 =
            corners.windows(2).skip(1).map(|pair| 0.5 * (pair[0] - corners[0]).cross(pair[1] - corners[0])).sum();
        (sum.length(), sum.normalize())
    }

    #[test]
    fn surfaces_have_the_lights_area_and_face() {
        let edges = (Vec3::new(2.0, 0.0, 0.0), Vec3::new(0.0, 0.0, 3.0));
        let rectangle = LightKind::Rectangle { center: Vec3::Y, edge_u: edges.0, edge_v: edges.1, flux: Vec3::ONE };
        assert_eq!(area_and_normal(&rectangle), (6.0, -Vec3::Y));
        let facing = Vec3::new(1.0, -2.0, -0.5);
        let disk = LightKind::Disk { center: Vec3::X, normal: facing, radius: 0.5, flux: Vec3::ONE };
        let (area, normal) = area_and_normal(&disk);
        assert!((area - 0.25 * std::f32::consts::PI).abs() < 1e-5);
        assert!(normal.distance(facing.normalize()) < 1e-5);
    }
}
