//! The scene as rays meet it: world-space triangles under a BVH, and the lights' surfaces.

mod bvh;
mod disk;
mod light_shape;
mod normal_map;
mod rectangle;
mod sphere;
mod surface_point;
mod triangle;

use diacaustic_scene::{Light, Material, Scene};
use glam::{DVec3, Vec3};

use crate::bsdf::PreparedMaterial;
use crate::lights::{self, EmissiveSurfaces, Environment};
use crate::media::{Dielectrics, Media};
use crate::spectrum::Spectrum;

pub use self::disk::Disk;
pub use self::light_shape::LightShape;
pub use self::rectangle::Rectangle;
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

/// What a ray starts on. Flat triangles and lights left on the side that shines cannot be met again by a ray that leaves them.
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
    /// Whether the ray takes what the material is blended with; see [`World::taken`].
    pub takes_rest: bool,
}

/// The first thing along a ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Meeting {
    /// A triangle.
    Surface(Hit),
    /// A light's surface.
    Light {
        /// Index of the light in the scene.
        light: usize,
        /// Distance along the ray, metres.
        distance: f64,
        /// Whether the ray comes from the side that shines.
        front: bool,
    },
}

/// What a shadow ray is meant to reach.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Target {
    /// The surface of the light of this index in the scene.
    Light(usize),
    /// A place: a point, a triangle, or infinitely far.
    Place,
}

/// A scene made ready for rays. Building it takes some time (a BVH), so build it once.
#[derive(Debug)]
pub struct World<'a> {
    scene: &'a Scene,
    triangles: Vec<Triangle>,
    light_shapes: Vec<Option<LightShape>>,
    light_media: Vec<Media>,
    bvh: Bvh,
    epsilon: f64,
    bounds: Sphere,
    dielectrics: Dielectrics,
    spectrum: Spectrum,
    materials: Vec<PreparedMaterial<'a>>,
    /// What each material is blended with.
    rests: Vec<Option<PreparedMaterial<'a>>>,
    /// Whether rays may pass any of the materials.
    has_holes: bool,
    environment: Option<Environment>,
    emissive: EmissiveSurfaces,
}

impl<'a> World<'a> {
    /// Places every triangle of the scene in the world and sorts them into a BVH.
    pub fn new(scene: &'a Scene) -> Self {
        let triangles = triangle::flatten(scene);
        let bvh = Bvh::build(&triangles);
        let light_shapes: Vec<_> = scene.lights.iter().map(|light| LightShape::of(&light.kind)).collect();
        let dielectrics = Dielectrics::of(scene);
        let position = |light: &Light| lights::position_of(&light.kind);
        let around = |point| dielectrics.around(scene, point);
        Self {
            scene,
            light_media: scene.lights.iter().map(|l| position(l).map_or(Media::AIR, around)).collect(),
            epsilon: RELATIVE_EPSILON * bvh.extent(),
            bounds: bounding_sphere(&triangles, &light_shapes),
            spectrum: Spectrum::of_render(scene.settings.wavelength),
            materials: scene.materials.iter().map(PreparedMaterial::new).collect(),
            rests: scene.materials.iter().map(|material| material.rest().map(PreparedMaterial::new)).collect(),
            has_holes: scene.has_holes(),
            environment: Environment::of(scene),
            emissive: EmissiveSurfaces::of(scene, &triangles, &dielectrics),
            triangles,
            light_shapes,
            bvh,
            dielectrics,
        }
    }

    /// The scene that it was built from.
    pub fn scene(&self) -> &'a Scene {
        self.scene
    }

    /// Every object's triangles, in the order of the objects and of their meshes.
    pub fn triangles(&self) -> &[Triangle] {
        &self.triangles
    }

    /// For each of the scene's lights, its surface, if rays can meet it.
    pub fn light_shapes(&self) -> &[Option<LightShape>] {
        &self.light_shapes
    }

    /// The sphere of a spherical light; none if the light is of another kind.
    ///
    /// # Panics
    /// If the scene has no such light.
    pub fn light_sphere(&self, light: usize) -> Option<Sphere> {
        self.light_shapes[light].as_ref()?.as_sphere()
    }

    /// What encloses a light of the scene.
    ///
    /// # Panics
    /// If the scene has no such light.
    pub fn light_media(&self, light: usize) -> Media {
        self.light_media[light]
    }

    /// The length under which a distance counts as none, metres.
    pub fn epsilon(&self) -> f64 {
        self.epsilon
    }

    /// A sphere around all triangles and lights that rays can meet.
    pub fn bounds(&self) -> Sphere {
        self.bounds
    }

    /// The scene's dielectrics.
    pub fn dielectrics(&self) -> &Dielectrics {
        &self.dielectrics
    }

    /// The spectrum with which all light starts.
    pub fn spectrum(&self) -> Spectrum {
        self.spectrum
    }

    /// Whether some light has one wavelength.
    pub fn has_dispersion(&self) -> bool {
        self.scene.has_dispersion()
    }

    /// The list of the dielectrics that enclose a point.
    pub fn media_around(&self, point: Vec3) -> Media {
        self.dielectrics.around(self.scene, point)
    }

    /// Index in the scene of the material that a ray meets at a triangle.
    pub fn material_index(&self, triangle: usize) -> usize {
        let Triangle { object, index, .. } = self.triangles[triangle];
        self.scene.objects[object].material_of(index)
    }

    /// The material that a ray meets at a triangle.
    pub fn material(&self, triangle: usize) -> &'a Material {
        self.prepared(triangle).material
    }

    pub(crate) fn prepared(&self, triangle: usize) -> &PreparedMaterial<'a> {
        &self.materials[self.material_index(triangle)]
    }

    /// The material that a ray takes where it meets a triangle.
    pub(crate) fn prepared_at(&self, hit: &Hit) -> &PreparedMaterial<'a> {
        let rest = self.rests[self.material_index(hit.triangle)].as_ref().filter(|_| hit.takes_rest);
        rest.unwrap_or_else(|| self.prepared(hit.triangle))
    }

    pub(crate) fn environment(&self) -> Option<&Environment> {
        self.environment.as_ref()
    }

    pub(crate) fn emissive(&self) -> &EmissiveSurfaces {
        &self.emissive
    }

    /// The nearest triangle or light along a ray, or none.
    pub fn meet(&self, ray: &Ray, from: Departure) -> Option<Meeting> {
        let stands = |hit: &Hit| from != Departure::Triangle(hit.triangle) && self.stands(ray, hit, 0);
        let hit = self.bvh.nearest(ray, self.epsilon..f64::INFINITY, stands);
        let mut limit = hit.map_or(f64::INFINITY, |hit| hit.distance);
        let mut nearest = hit.map(Meeting::Surface);
        for (light, shape) in self.shapes() {
            if from == Departure::Light(light) {
                continue;
            }
            if let Some((distance, front)) = shape.meet(ray, self.epsilon)
                && distance < limit
            {
                limit = distance;
                nearest = Some(Meeting::Light { light, distance, front });
            }
        }
        nearest
    }

    /// Whether anything but the target stands within `distance` metres along a ray. `key` decides together with the ray
    /// which triangles of an opacity below 1 do: many rays from one point to a light without extent are the same.
    pub fn occluded(&self, ray: &Ray, distance: f64, from: Departure, toward: Target, key: u64) -> bool {
        let stands = |hit: &Hit| from != Departure::Triangle(hit.triangle) && self.stands(ray, hit, key);
        self.shapes().any(|(light, shape)| {
            toward != Target::Light(light) && shape.meet(ray, self.epsilon).is_some_and(|(met, _)| met < distance)
        }) || self.bvh.any(ray, self.epsilon..distance, stands)
    }

    fn shapes(&self) -> impl Iterator<Item = (usize, &LightShape)> {
        self.light_shapes.iter().enumerate().filter_map(|(light, shape)| Some((light, shape.as_ref()?)))
    }
}

/// About the middle of the corners' box.
fn bounding_sphere(triangles: &[Triangle], lights: &[Option<LightShape>]) -> Sphere {
    let spheres: Vec<Sphere> = lights.iter().flatten().map(LightShape::bounding_sphere).collect();
    let points = || triangles.iter().flat_map(|triangle| triangle.corners);
    let grown = |(min, max): (DVec3, DVec3), p: DVec3, r: f64| (min.min(p - r), max.max(p + r));
    let empty = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    let boxed = points().fold(empty, |bounds, p| grown(bounds, p, 0.0));
    let (min, max) = spheres.iter().fold(boxed, |bounds, sphere| grown(bounds, sphere.center, sphere.radius));
    if min.x > max.x {
        return Sphere { center: DVec3::ZERO, radius: 0.0 };
    }
    let center = 0.5 * (min + max);
    let reaches = points()
        .map(|p| p.distance(center))
        .chain(spheres.iter().map(|sphere| sphere.center.distance(center) + sphere.radius));
    Sphere { center, radius: reaches.fold(0.0, f64::max) }
}
