//! Bounding spheres of casters: where lights aim.

use diacaustic_scene::{LightKind, Scene};
use glam::{UVec3, Vec3};

use crate::WorldTriangle;

/// A sphere around some of the scene's triangles, world frame, metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoundingSphere {
    /// Its centre.
    pub center: Vec3,
    /// Its radius.
    pub radius: f32,
}

impl BoundingSphere {
    /// The sphere around the centre of the points' box that holds all of them.
    pub fn around(points: impl Iterator<Item = Vec3> + Clone) -> Self {
        let (low, high) = points
            .clone()
            .fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(low, high), point| (low.min(point), high.max(point)));
        let center = 0.5 * (low + high);
        let radius = points.map(|point| point.distance(center)).fold(0.0, f32::max);
        // The factor covers the rounding of the distances.
        Self { center, radius: radius * 1.000_001 }
    }

    /// The smallest sphere around two.
    fn union(self, other: Self) -> Self {
        let between = other.center - self.center;
        let distance = between.length();
        if distance + other.radius <= self.radius {
            return self;
        }
        if distance + self.radius <= other.radius {
            return other;
        }
        let radius = 0.5 * (distance + self.radius + other.radius);
        Self { center: self.center + between * ((radius - self.radius) / distance), radius: radius * 1.000_001 }
    }
}

/// A sphere around everything that has a place: triangles and lights.
pub fn scene_bounds(scene: &Scene, triangles: &[WorldTriangle]) -> BoundingSphere {
    let lights = scene.lights.iter().flat_map(|light| match light.kind {
        LightKind::Sphere { center, radius, .. } => vec![center - Vec3::splat(radius), center + Vec3::splat(radius)],
        LightKind::Point { position, .. } | LightKind::Spot { position, .. } => vec![position],
        // Surfaces are among the triangles.
        LightKind::Rectangle { .. }
        | LightKind::Disk { .. }
        | LightKind::Distant { .. }
        | LightKind::Environment { .. } => Vec::new(),
    });
    BoundingSphere::around(triangles.iter().flat_map(|t| t.corners).chain(lights))
}

/// The bounding spheres of each object's casting triangles.
pub fn caster_bounds(scene: &Scene, triangles: &[WorldTriangle]) -> Vec<BoundingSphere> {
    let casts: Vec<bool> = scene.materials.iter().map(|material| material.is_caster()).collect();
    triangles
        .chunk_by(|a, b| a.object == b.object)
        .filter_map(|object| {
            let corners = object.iter().filter(|t| casts[t.material as usize]).flat_map(|t| t.corners);
            corners.clone().next().map(|_| BoundingSphere::around(corners))
        })
        .collect()
}

/// Spheres among which every pair is looked at; more are first merged with their neighbours along a Z-order curve.
const MOST_PAIRED: usize = 128;

/// Merges spheres until at most `limit` remain: of 128 and fewer the two whose union has the least radius, one after the other.
pub fn merge_spheres(mut spheres: Vec<BoundingSphere>, limit: usize) -> Vec<BoundingSphere> {
    if spheres.len() > MOST_PAIRED.max(limit) {
        spheres = merge_neighbours(spheres, MOST_PAIRED.max(limit));
    }
    while spheres.len() > limit.max(1) {
        let mut best = (f32::INFINITY, 0, 1);
        for i in 0..spheres.len() {
            for j in i + 1..spheres.len() {
                let radius = spheres[i].union(spheres[j]).radius;
                if radius < best.0 {
                    best = (radius, i, j);
                }
            }
        }
        let merged = spheres[best.1].union(spheres[best.2]);
        spheres.swap_remove(best.2);
        spheres[best.1] = merged;
    }
    spheres
}

/// Merges spheres in runs along a Z-order curve through their centres into `count`.
fn merge_neighbours(mut spheres: Vec<BoundingSphere>, count: usize) -> Vec<BoundingSphere> {
    let around = BoundingSphere::around(spheres.iter().map(|sphere| sphere.center));
    let low = around.center - around.radius;
    let scale = 1023.0 / (2.0 * around.radius).max(f32::MIN_POSITIVE);
    spheres.sort_by_cached_key(|sphere| z_order(((sphere.center - low) * scale).as_uvec3()));
    let run = spheres.len().div_ceil(count);
    let merged = |run: &[BoundingSphere]| run[1..].iter().fold(run[0], |sphere, other| sphere.union(*other));
    spheres.chunks(run).map(merged).collect()
}

/// The place of a cell of a grid of 1024³ along a Z-order curve.
fn z_order(cell: UVec3) -> u32 {
    let bit = |axis: usize, level: u32| (cell[axis] >> level & 1) << (3 * level + axis as u32);
    (0..10).flat_map(|level| [bit(0, level), bit(1, level), bit(2, level)]).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_hundred_thousand_spheres_merge_at_once() {
        let place = |i: u32| Vec3::new((i % 47) as f32, (i / 47 % 47) as f32, (i / 2209) as f32);
        let spheres: Vec<_> = (0..100_000).map(|i| BoundingSphere { center: place(i), radius: 0.3 }).collect();
        let merged = merge_spheres(spheres.clone(), 16);
        assert!(merged.len() <= 16);
        for sphere in spheres.iter().step_by(97) {
            assert!(merged.iter().any(|m| m.center.distance(sphere.center) + sphere.radius <= m.radius * 1.0001));
        }
    }

    #[test]
    fn merged_spheres_hold_the_originals() {
        let spheres: Vec<_> = (0..40)
            .map(|i| BoundingSphere {
                center: Vec3::new((i * 7 % 11) as f32, (i * 5 % 13) as f32, i as f32),
                radius: 0.1 * (1 + i % 4) as f32,
            })
            .collect();
        let merged = merge_spheres(spheres.clone(), 5);
        assert_eq!(merged.len(), 5);
        for sphere in spheres {
            assert!(merged.iter().any(|m| m.center.distance(sphere.center) + sphere.radius <= m.radius * 1.0001));
        }
    }
}
