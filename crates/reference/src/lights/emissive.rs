//! Objects that shine.

use diacaustic_scene::Scene;
use glam::DVec3;

use crate::geometry::{Triangle, World};
use crate::media::{Dielectrics, Media};

/// A triangle that shines from its front.
#[derive(Clone, Copy, Debug)]
pub(crate) struct EmissiveTriangle {
    /// Index in the world.
    pub(crate) triangle: usize,
    pub(crate) corners: [DVec3; 3],
    /// Unit normal of the front.
    pub(crate) normal: DVec3,
    /// The material's emission, but for its picture, as a mean over the channels, W/(m² sr).
    strength: f64,
    /// What encloses its first corner.
    pub(crate) media: Media,
}

impl EmissiveTriangle {
    /// The barycentric coordinates of a point, even in area.
    pub(crate) fn point(u: f64, v: f64) -> DVec3 {
        let s = u.sqrt();
        DVec3::new(1.0 - s, s * (1.0 - v), s * v)
    }

    /// A point, metres.
    pub(crate) fn at(&self, barycentric: DVec3) -> DVec3 {
        let [a, b, c] = self.corners;
        a + barycentric.y * (b - a) + barycentric.z * (c - a)
    }

    /// The mean radiance of a point, which is there with the probability of its opacity, W/(m² sr).
    pub(crate) fn radiance(&self, world: &World, barycentric: DVec3) -> DVec3 {
        world.opacity(self.triangle, barycentric) * world.emission(self.triangle, barycentric)
    }

    fn area(&self) -> f64 {
        let [a, b, c] = self.corners;
        0.5 * (b - a).cross(c - a).length()
    }
}

/// All of them, to be drawn in proportion to area and emission; pictures do not count, so that points are even on each.
#[derive(Clone, Debug)]
pub(crate) struct EmissiveSurfaces {
    triangles: Vec<EmissiveTriangle>,
    /// Running sums of area times strength.
    sums: Vec<f64>,
}

impl EmissiveSurfaces {
    pub(crate) fn of(scene: &Scene, triangles: &[Triangle], dielectrics: &Dielectrics) -> Self {
        let emissive: Vec<_> = triangles
            .iter()
            .enumerate()
            .filter_map(|(triangle, t)| {
                let material = scene.objects[t.object].material_of(t.index);
                let radiance = scene.materials[material].emission.as_dvec3();
                let media = || dielectrics.around(scene, t.corners[0].as_vec3());
                (radiance != DVec3::ZERO).then(|| EmissiveTriangle {
                    triangle,
                    corners: t.corners,
                    normal: t.normal_geometric,
                    strength: radiance.element_sum() / 3.0,
                    media: media(),
                })
            })
            .collect();
        let mut sum = 0.0;
        let sums = emissive
            .iter()
            .map(|t| {
                sum += t.area() * t.strength;
                sum
            })
            .collect();
        Self { triangles: emissive, sums }
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.triangles.is_empty()
    }

    /// A triangle chosen by a number in [0, 1), and the density of its points, 1/m².
    pub(crate) fn choose(&self, u: f64) -> Option<(&EmissiveTriangle, f64)> {
        let total = *self.sums.last()?;
        let chosen = self.sums.partition_point(|sum| *sum <= u * total).min(self.triangles.len() - 1);
        let triangle = &self.triangles[chosen];
        Some((triangle, triangle.strength / total))
    }
}
