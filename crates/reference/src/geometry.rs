//! The scene as rays meet it: world-space triangles under a BVH, and the lights' spheres.

mod bvh;
mod sphere;
mod triangle;

use diacaustic_scene::{LightKind, MaterialKind, Scene};
use glam::DVec3;

pub use self::sphere::Sphere;
pub use self::triangle::{Facing, Triangle};

use self::bvh::Bvh;

/// Distances under this share of the scene's extent count as no distance: a thousand times the rounding of a point.
const RELATIVE_EPSILON: f64 = 1e-10;

/// A half-line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// Where it starts, metres.
    pub origin: DVec3,
    /// Where it goes, unit length.
    pub direction: DVec3,
}

impl Ray {
    /// The point at a distance along the ray, metres.
    pub fn at(&self, distance: f64) -> DVec3 {
        self.origin + distance * self.direction
    }
}

/// What a ray starts on. Flat triangles and spheres seen from outside cannot be met again by a ray that leaves them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Departure {
    /// Nothing.
    Open,
    /// The triangle of this index in [`World::triangles`].
    Triangle(usize),
    /// The light of this index in the scene.
    Light(usize),
}

/// A point of a triangle that a ray meets.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Index in [`World::triangles`].
    pub triangle: usize,
    /// Distance along the ray, metres.
    pub distance: f64,
    /// Weights of the triangle's three corners, which sum to 1.
    pub barycentric: DVec3,
}

/// The first thing along a ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Meeting {
    /// A triangle.
    Surface(Hit),
    /// A light's sphere.
    Light {
        /// Index of the light in the scene.
        light: usize,
        /// Distance along the ray, metres.
        distance: f64,
        /// Whether the ray comes from outside the sphere.
        outside: bool,
    },
}

/// A scene made ready for rays. Building it takes some time (a BVH), so build it once.
#[derive(Debug)]
pub struct World<'a> {
    scene: &'a Scene,
    triangles: Vec<Triangle>,
    lights: Vec<Sphere>,
    bvh: Bvh,
    epsilon: f64,
}

impl<'a> World<'a> {
    /// Places every triangle of the scene in the world and sorts them into a BVH.
    pub fn new(scene: &'a Scene) -> Self {
        let triangles = triangle::flatten(scene);
        let bvh = Bvh::build(&triangles);
        let epsilon = RELATIVE_EPSILON * bvh.extent();
        let lights = scene
            .lights
            .iter()
            .map(|light| {
                let LightKind::Sphere { center, radius, .. } = light.kind;
                Sphere { center: center.as_dvec3(), radius: f64::from(radius) }
            })
            .collect();
        Self { scene, triangles, lights, bvh, epsilon }
    }

    /// The scene that it was built from.
    pub fn scene(&self) -> &'a Scene {
        self.scene
    }

    /// Every object's triangles, in the order of the objects and of their meshes.
    pub fn triangles(&self) -> &[Triangle] {
        &self.triangles
    }

    /// The spheres of the scene's lights.
    pub fn lights(&self) -> &[Sphere] {
        &self.lights
    }

    /// The length under which a distance counts as none, metres.
    pub fn epsilon(&self) -> f64 {
        self.epsilon
    }

    /// The material that a ray meets at a triangle.
    pub fn material(&self, triangle: usize) -> &'a MaterialKind {
        let Triangle { object, index, .. } = self.triangles[triangle];
        &self.scene.materials[self.scene.objects[object].material_of(index)].kind
    }

    /// The nearest triangle or light sphere along a ray, or none.
    pub fn meet(&self, ray: &Ray, from: Departure) -> Option<Meeting> {
        let hit = self.bvh.nearest(ray, self.epsilon, f64::INFINITY, skipped_triangle(from));
        let mut limit = hit.map_or(f64::INFINITY, |hit| hit.distance);
        let mut nearest = hit.map(Meeting::Surface);
        for (light, sphere) in self.lights.iter().enumerate() {
            if from == Departure::Light(light) {
                continue;
            }
            if let Some((distance, outside)) = sphere.meet(ray, self.epsilon)
                && distance < limit
            {
                limit = distance;
                nearest = Some(Meeting::Light { light, distance, outside });
            }
        }
        nearest
    }

    /// Whether anything but the light `toward` stands within `distance` metres along a ray.
    pub fn occluded(&self, ray: &Ray, distance: f64, from: Departure, toward: usize) -> bool {
        self.lights.iter().enumerate().any(|(light, sphere)| {
            light != toward && sphere.meet(ray, self.epsilon).is_some_and(|(met, _)| met < distance)
        }) || self.bvh.any(ray, self.epsilon, distance, skipped_triangle(from))
    }
}

fn skipped_triangle(from: Departure) -> Option<usize> {
    match from {
        Departure::Triangle(triangle) => Some(triangle),
        Departure::Open | Departure::Light(_) => None,
    }
}
