//! `Renderer::intersect` against every triangle in double precision.
//!
//! Single precision decides wrongly within its rounding of an edge, and so may the boxes around it. The tolerance is that
//! rounding, bounded for each ray and triangle ([`ROUNDING`]): a hit must be one within the tolerance, and no triangle may be
//! nearer that is hit by more than the tolerance. Rays where the tolerance decides are counted, and few.

use diacaustic::{Error, Ray, RayHit, Renderer, RendererOptions, glam::DVec3};
use diacaustic_reference::random::{hash, unit};
use diacaustic_scene::{Mesh, Scene};
use diacaustic_tests::{gpu, renderer, scene};
use glam::Vec3;

/// Bound on the rounding of single precision in a product of three lengths, as a share of it: the unit roundoff 2⁻²⁴ times the
/// operations of the intersection, with room to spare.
const ROUNDING: f64 = 24.0 * (1.0 / 16_777_216.0);
/// Rays of each kind.
const RAYS: u32 = 400;

/// A triangle as the double-precision intersection needs it.
struct Triangle {
    object: usize,
    number: usize,
    corner: DVec3,
    edges: [DVec3; 2],
}

/// Every triangle of a scene whose objects stand where their meshes are.
struct Reference {
    triangles: Vec<Triangle>,
    /// The length of the scene's box's diagonal, metres.
    extent: f64,
}

/// Where a ray meets a triangle's plane, with the tolerance.
struct Meeting {
    t: f64,
    t_tolerance: f64,
    /// The least of the three barycentric weights, over the tolerance on them: over 1 surely inside, under −1 surely outside.
    inside: f64,
}

impl Meeting {
    fn is_possible(&self, t_max: f64) -> bool {
        self.inside >= -1.0 && self.t > -self.t_tolerance && self.t < t_max + self.t_tolerance
    }

    fn is_sure(&self, t_max: f64) -> bool {
        self.inside > 1.0 && self.t > self.t_tolerance && self.t < t_max - self.t_tolerance
    }
}

/// Whether an answer agrees with the reference.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Verdict {
    Right,
    /// The tolerance decides.
    NearAnEdge,
    Wrong,
}

impl Reference {
    fn new(scene: &Scene) -> Self {
        let mut triangles = Vec::new();
        let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        for (object, placed) in scene.objects.iter().enumerate() {
            for number in 0..placed.mesh.triangles.len() {
                let [a, b, c] = placed.mesh.corners(number).map(|corner| corner.as_dvec3());
                low = low.min(a).min(b).min(c);
                high = high.max(a).max(b).max(c);
                triangles.push(Triangle { object, number, corner: a, edges: [b - a, c - a] });
            }
        }
        Self { triangles, extent: (high - low).length() }
    }

    /// Möller and Trumbore 1997; none if the ray is parallel to the plane.
    fn meet(&self, triangle: &Triangle, ray: &Ray) -> Option<Meeting> {
        let (origin, direction) = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
        let [edge_1, edge_2] = triangle.edges;
        let p = direction.cross(edge_2);
        let determinant = edge_1.dot(p);
        if determinant == 0.0 {
            return None;
        }
        let s = origin - triangle.corner;
        let q = s.cross(edge_1);
        let (u, v) = (s.dot(p) / determinant, direction.dot(q) / determinant);
        let (length_1, length_2) = (edge_1.length(), edge_2.length());
        // Boxes round in proportion to the scene, triangles to their distance.
        let reach = s.length() + self.extent;
        let relative = ROUNDING / determinant.abs();
        let weight_tolerance = relative * (reach * length_1.max(length_2) + length_1 * length_2);
        Some(Meeting {
            t: edge_2.dot(q) / determinant,
            t_tolerance: relative * reach * length_1 * length_2,
            inside: u.min(v).min(1.0 - u - v) / weight_tolerance,
        })
    }

    /// The nearest hit in double precision, without tolerance.
    fn nearest(&self, ray: &Ray) -> Option<f64> {
        let meetings = self.triangles.iter().filter_map(|triangle| self.meet(triangle, ray));
        let hits = meetings.filter(|m| m.inside >= 0.0 && m.t > 0.0 && m.t < f64::from(ray.t_max));
        hits.map(|m| m.t).min_by(f64::total_cmp)
    }

    fn judge(&self, ray: &Ray, answer: Option<RayHit>, any_hit: bool) -> Verdict {
        let t_max = f64::from(ray.t_max);
        let mut nearest = t_max;
        let mut verdict = Verdict::Right;
        if let Some(hit) = answer {
            let triangle = self.triangles.iter().find(|t| (t.object, t.number) == (hit.object, hit.triangle)).unwrap();
            match self.meet(triangle, ray) {
                Some(m) if m.is_possible(t_max) && (m.t - f64::from(hit.t)).abs() <= m.t_tolerance => {
                    if !m.is_sure(t_max) {
                        verdict = Verdict::NearAnEdge;
                    }
                    nearest = f64::from(hit.t) - m.t_tolerance;
                }
                _ => return Verdict::Wrong,
            }
            if any_hit {
                return verdict;
            }
        }
        for meeting in self.triangles.iter().filter_map(|triangle| self.meet(triangle, ray)) {
            if meeting.t + meeting.t_tolerance < nearest && meeting.is_possible(t_max) {
                if meeting.is_sure(t_max) {
                    return Verdict::Wrong;
                }
                verdict = Verdict::NearAnEdge;
            }
        }
        verdict
    }
}

/// Numbers in [0, 1) that are the same in every run.
struct Random(u32);

impl Random {
    fn next(&mut self) -> f32 {
        self.0 += 1;
        unit(hash(self.0)) as f32
    }

    fn index(&mut self, count: usize) -> usize {
        (self.next() * count as f32) as usize % count
    }

    /// A point of the box between −1 and 1.
    fn cube(&mut self) -> Vec3 {
        2.0 * Vec3::new(self.next(), self.next(), self.next()) - 1.0
    }
}

/// The box around a scene's meshes: centre and half extent.
fn bounds(scene: &Scene) -> (Vec3, Vec3) {
    let points = scene.objects.iter().flat_map(|object| &object.mesh.positions);
    let (low, high) = points.fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(l, h), &p| (l.min(p), h.max(p)));
    (0.5 * (low + high), 0.5 * (high - low))
}

fn endless(origin: Vec3, direction: Vec3) -> Ray {
    Ray { origin, direction, t_max: 1e30 }
}

/// From a point of the cube of `distance` half extents to a point of the scene's box.
fn across(scene: &Scene, distance: f32) -> Vec<Ray> {
    let ((center, half), mut random) = (bounds(scene), Random(1));
    let ray = |_| {
        let (origin, target) = (center + distance * half * random.cube(), center + half * random.cube());
        endless(origin, (target - origin).normalize())
    };
    (0..RAYS).map(ray).collect()
}

/// Directions with one zero, of either sign.
fn in_coordinate_planes(scene: &Scene) -> Vec<Ray> {
    let mut rays = across(scene, 2.0);
    for (number, ray) in rays.iter_mut().enumerate() {
        ray.direction[number % 3] = 0.0;
        ray.direction = ray.direction.normalize();
        ray.direction[number % 3] = if number % 2 == 0 { 0.0 } else { -0.0 };
    }
    rays
}

/// Directions along an axis, with zeros of either sign, through what `at` gives.
fn along_axes(scene: &Scene, mut at: impl FnMut(&mut Random) -> Vec3) -> Vec<Ray> {
    let ((center, half), mut random) = (bounds(scene), Random(2));
    let ray = |number: u32| {
        let axis = number as usize % 3;
        let sign = if number.is_multiple_of(2) { 1.0 } else { -1.0 };
        let mut direction = Vec3::splat(if number % 4 < 2 { 0.0 } else { -0.0 });
        direction[axis] = sign;
        let mut origin = at(&mut random);
        origin[axis] = center[axis] - 2.0 * sign * half[axis];
        endless(origin, direction)
    };
    (0..RAYS).map(ray).collect()
}

/// Through vertices, where boxes of the hierarchy begin and end.
fn along_box_planes(scene: &Scene) -> Vec<Ray> {
    let points: Vec<Vec3> = scene.objects.iter().flat_map(|object| object.mesh.positions.iter().copied()).collect();
    along_axes(scene, |random| points[random.index(points.len())])
}

fn along_axes_anywhere(scene: &Scene) -> Vec<Ray> {
    let (center, half) = bounds(scene);
    along_axes(scene, |random| center + half * random.cube())
}

/// From beside a surface point, outward or inward: the nearest hit of a ray across, and from there anywhere.
fn from_surfaces(scene: &Scene, reference: &Reference) -> Vec<Ray> {
    let mut random = Random(3);
    let rays = across(scene, 2.0);
    let leave = |ray: &Ray| {
        let t = reference.nearest(ray)? as f32;
        Some(endless(ray.origin + 0.999 * t * ray.direction, random.cube().normalize_or(Vec3::X)))
    };
    rays.iter().filter_map(leave).collect()
}

/// Kinds of rays, and the share of each that may come down to the tolerance.
fn kinds(scene: &Scene, reference: &Reference, edge_share: f64) -> Vec<(&'static str, Vec<Ray>, f64)> {
    vec![
        ("across", across(scene, 2.0), edge_share),
        ("in coordinate planes", in_coordinate_planes(scene), edge_share),
        ("along axes", along_axes_anywhere(scene), edge_share),
        ("from surfaces", from_surfaces(scene, reference), edge_share),
        // A thousand times as far, single precision is a thousand times as coarse: as coarse as the teapot's triangles.
        ("from far away", across(scene, 1000.0), 0.75),
        // Every such ray meets a vertex, at which the tolerance decides.
        ("along box planes", along_box_planes(scene), 1.0),
    ]
}

/// Checks nearest and any hit of one kind of rays.
fn assert_right(renderer: &Renderer, reference: &Reference, (kind, rays, edge_share): (&str, Vec<Ray>, f64)) {
    let nearest = renderer.intersect(&rays, false).unwrap();
    let any = renderer.intersect(&rays, true).unwrap();
    let mut near_edges = 0;
    for (number, ray) in rays.iter().enumerate() {
        let (nearest, any) = (nearest[number], any[number]);
        let verdict = reference.judge(ray, nearest, false);
        assert_ne!(verdict, Verdict::Wrong, "{kind} {number}: {ray:?} has the nearest hit {nearest:?}");
        assert_ne!(reference.judge(ray, any, true), Verdict::Wrong, "{kind} {number}: {ray:?} has a hit {any:?}");
        assert_eq!(nearest.is_some(), any.is_some(), "{kind} {number}: {ray:?} hits {nearest:?} and {any:?}");
        near_edges += u32::from(verdict == Verdict::NearAnEdge);
    }
    let hits = nearest.iter().flatten().count();
    println!("{kind}: {hits} of {} rays hit, {near_edges} come down to the tolerance", rays.len());
    assert!(hits * 20 > rays.len(), "{kind}: only {hits} rays hit something, which tests little");
    let share = f64::from(near_edges) / rays.len() as f64;
    assert!(share <= edge_share, "{kind}: {near_edges} of {} rays come down to the tolerance", rays.len());
}

fn assert_scene(scene: &Scene, edge_share: f64) {
    let (renderer, reference) = (renderer(scene), Reference::new(scene));
    for kind in kinds(scene, &reference, edge_share) {
        assert_right(&renderer, &reference, kind);
    }
}

/// A scene of one glass object.
fn alone(shape: &str) -> Scene {
    scene(&format!(
        "camera = {{ position = [0, 1, 3], look_at = [0, 0, 0], vertical_fov = 40 }}
         render = {{ width = 8, height = 8 }}
         materials.glass = {{ type = \"dielectric\", ior = 1.5 }}
         objects = [{{ {shape}, material = \"glass\" }}]"
    ))
}

/// Triangles anywhere between −5 and 5: of sizes from a millimetre to metres, and slivers a ten-thousandth as wide as long.
fn soup() -> Scene {
    let mut random = Random(4);
    let mut mesh = Mesh::default();
    for number in 0..3000 {
        let size = 10.0f32.powf(-3.0 + 3.5 * random.next());
        let place = 5.0 * random.cube();
        let (along, aside) = (size * random.cube(), size * random.cube());
        let aside = if number % 4 == 0 { along + 1e-4 * aside } else { aside };
        let first = mesh.positions.len() as u32;
        mesh.positions.extend([place, place + along, place + aside]);
        mesh.triangles.push([first, first + 1, first + 2]);
    }
    let mut scene = alone("box = { min = [0, 0, 0], max = [1, 1, 1] }");
    scene.objects[0].mesh = mesh.into();
    scene
}

#[test]
fn teapot() {
    assert_scene(&alone("mesh = \"assets/meshes/teapot.obj\""), 0.02);
}

#[test]
fn crystal() {
    assert_scene(&alone("mesh = \"assets/meshes/crystal.obj\""), 0.02);
}

#[test]
fn axis_parallel_box() {
    assert_scene(&alone("box = { min = [-0.3, 0.1, 0.2], max = [1.7, 0.5, 0.9] }"), 0.02);
}

#[test]
fn triangle_soup() {
    assert_scene(&soup(), 0.02);
}

#[test]
fn a_ray_ends_at_its_length() {
    let scene = alone("mesh = \"assets/meshes/crystal.obj\"");
    let (renderer, reference) = (renderer(&scene), Reference::new(&scene));
    let whole = across(&scene, 2.0);
    let found: Vec<_> = whole.iter().filter_map(|ray| Some((*ray, reference.nearest(ray)? as f32))).collect();
    assert!(found.len() > 50);
    for any_hit in [false, true] {
        let cut = |share: f32| -> Vec<Ray> { found.iter().map(|(ray, t)| Ray { t_max: share * t, ..*ray }).collect() };
        let before = renderer.intersect(&cut(0.999), any_hit).unwrap();
        assert!(before.iter().all(Option::is_none), "a ray met what lies beyond its end");
        let after = renderer.intersect(&cut(1.001), any_hit).unwrap();
        assert!(after.iter().all(Option::is_some), "a ray missed what lies before its end");
    }
}

#[test]
fn no_rays_have_no_hits_and_no_scene_is_an_error() {
    let with_scene = renderer(&alone("mesh = \"assets/meshes/crystal.obj\""));
    assert_eq!(with_scene.intersect(&[], false).unwrap(), []);
    let too_many = vec![endless(Vec3::ZERO, Vec3::X); 65_535 * 64 + 1];
    let error = with_scene.intersect(&too_many, false).unwrap_err();
    assert!(matches!(error, Error::BufferTooLarge { .. }), "{error}");
    let without = Renderer::new(&gpu().device, &gpu().queue, &RendererOptions::default()).unwrap();
    let error = without.intersect(&[endless(Vec3::ZERO, Vec3::X)], false).unwrap_err();
    assert!(matches!(error, Error::NoScene), "{error}");
}

/// For each hit, the next one along the ray.
fn hits_behind(renderer: &Renderer, rays: &[Ray], hits: &[Option<RayHit>]) -> Vec<Option<RayHit>> {
    let past = |hit: RayHit| hit.t + 1e-3;
    let onward = |(ray, hit): (&Ray, &Option<RayHit>)| {
        hit.map_or(*ray, |hit| endless(ray.origin + past(hit) * ray.direction, ray.direction))
    };
    let next = renderer.intersect(&rays.iter().zip(hits).map(onward).collect::<Vec<_>>(), false).unwrap();
    hits.iter().zip(next).map(|(hit, next)| Some(RayHit { t: past((*hit)?) + next?.t, ..next? })).collect()
}

#[test]
fn the_comparison_can_fail() {
    let scene = alone("mesh = \"assets/meshes/teapot.obj\"");
    let (renderer, reference) = (renderer(&scene), Reference::new(&scene));
    let rays = across(&scene, 2.0);
    let hits = renderer.intersect(&rays, false).unwrap();
    let told = |answers: &[Option<RayHit>]| {
        let judged = rays.iter().zip(answers).map(|(ray, answer)| reference.judge(ray, *answer, false));
        judged.filter(|verdict| *verdict == Verdict::Wrong).count()
    };
    let changed = |change: fn(RayHit) -> RayHit| hits.iter().map(|hit| hit.map(change)).collect::<Vec<_>>();
    let count = hits.iter().flatten().count();
    assert!(count > 100 && told(&hits) == 0);
    assert_eq!(told(&changed(|hit| RayHit { t: hit.t + 1e-3, ..hit })), count);
    assert_eq!(told(&changed(|hit| RayHit { triangle: hit.triangle ^ 1024, ..hit })), count);
    // Hits within the tolerance of an edge may as well be misses.
    assert!(told(&vec![None; hits.len()]) * 50 > count * 49);
    let behind = hits_behind(&renderer, &rays, &hits);
    assert!(told(&behind) * 50 > behind.iter().flatten().count() * 49);
}
