//! Everything that shines, as the device knows it: the scene's lights and the materials with emission.

use std::f32::consts::PI;

use diacaustic_scene::{Light, LightGroups, LightKind, Material, MaterialKind, RadianceMap, Scene};
use diacaustic_shaders as shaders;
use diacaustic_shaders::light_kind;
use diacaustic_surface::{BoundingSphere, WorldTriangle};
use glam::{DVec3, Vec2, Vec3};

use crate::{environment::EnvironmentRecord, layers::kept_groups};

/// The share of next-event estimation that goes to the lights in proportion to the irradiance that they may give what the camera looks at;
/// the rest goes to all evenly, so that a lamp that is weak there is not forgotten where it is strong.
const BY_IRRADIANCE: f32 = 0.75;

/// One emitter.
#[derive(Clone, Debug)]
pub(crate) struct Emitter {
    /// Its place among all emitters, ℓ in docs/photon-paths.md.
    pub number: usize,
    /// Its place on the device.
    pub index: usize,
    /// Its light group.
    pub group: usize,
    /// Turns in which it sends photons.
    pub photon_share: u32,
    /// Radiant flux, W; of light from infinitely far, what enters the sphere around the scene.
    pub flux: Vec3,
    /// A sphere around it; none if it is infinitely far.
    pub bounds: Option<BoundingSphere>,
    /// The most that one photon carries for a density of 1: intensity W/sr, radiance times area, or irradiance W/m².
    pub peak: f32,
    /// The media that it stands in, as keys.
    pub media: [u32; 4],
    record: shaders::Light,
}

impl Emitter {
    /// One of [`light_kind`].
    pub fn kind(&self) -> u32 {
        self.record.kind
    }

    /// An estimate of the irradiance at a point, whatever faces or blocks it, summed over the channels, W/m². An environment counts from
    /// all directions, four times what a surface takes of it: it is noisier than light from one direction.
    fn irradiance_at(&self, point: Vec3, around: &BoundingSphere) -> f32 {
        let area = match self.bounds {
            Some(bounds) => 4.0 * PI * bounds.center.distance_squared(point).max(bounds.radius * bounds.radius),
            None => PI * around.radius * around.radius,
        };
        self.flux.element_sum() / area.max(f32::MIN_POSITIVE)
    }
}

/// All emitters, in the order of the device: spheres first, light from infinitely far last.
#[derive(Clone, Debug)]
pub(crate) struct Lights {
    pub emitters: Vec<Emitter>,
    pub records: Vec<shaders::Light>,
    /// For each emitting triangle: its index, and as bits the share of its light's area up to and including it.
    pub triangles: Vec<[u32; 4]>,
    /// The environment's record; one black texel without environment.
    pub environment: Vec<[f32; 4]>,
    /// Spheres among them.
    pub sphere_count: usize,
    /// The first that is infinitely far.
    pub first_sky: usize,
    /// Lights of the scene and emissive materials.
    pub account_count: usize,
    /// The groups that are kept apart; a single one of all lights where none are.
    pub groups: LightGroups,
}

/// An emitter before it has a place on the device.
struct Candidate {
    emitter: Emitter,
    /// The material whose triangles shine.
    material: Option<usize>,
}

impl Lights {
    /// Collects what shines in a scene; `triangles` are those of the hierarchy, with the lights' surfaces.
    pub fn new(scene: &Scene, triangles: &[WorldTriangle], around: &BoundingSphere) -> Self {
        let mut lights = Self {
            emitters: Vec::new(),
            records: Vec::new(),
            triangles: Vec::new(),
            environment: vec![[0.0; 4]],
            sphere_count: 0,
            first_sky: 0,
            account_count: 0,
            groups: kept_groups(scene),
        };
        let shining = scene.lights.iter().enumerate().filter(|(_, light)| !light.kind.is_dark());
        let mut candidates: Vec<Candidate> =
            shining.map(|(number, light)| lights.candidate(scene, number, light, around)).collect();
        lights.account_count = scene.lights.len();
        for (material, _) in emissive_materials(scene) {
            let number = lights.account_count;
            lights.account_count += 1;
            let strength = scene.materials[material].emission;
            let group = lights.groups.of_materials[material];
            candidates.push(Candidate { emitter: emissive_surface(number, group, strength), material: Some(material) });
        }
        for candidate in candidates.iter_mut().filter(|candidate| candidate.material.is_some()) {
            lights.gather_surface(scene, candidate, triangles);
        }
        candidates.retain(|candidate| candidate.emitter.flux != Vec3::ZERO);
        lights.arrange(candidates, scene.camera.look_at, around);
        lights
    }

    /// A light of the scene, measured but for its triangles.
    fn candidate(&mut self, scene: &Scene, number: usize, light: &Light, around: &BoundingSphere) -> Candidate {
        let emitter = Emitter {
            number,
            index: 0,
            group: self.groups.of_lights[number],
            photon_share: light.photon_share,
            flux: Vec3::ZERO,
            bounds: None,
            peak: 0.0,
            media: place(&light.kind).map_or([0; 4], |point| media_keys(scene, point)),
            record: record(&light.kind),
        };
        let mut candidate = Candidate { emitter, material: None };
        match &light.kind {
            LightKind::Environment { map, scale, .. } => self.set_environment(&mut candidate, map, *scale, around),
            LightKind::Rectangle { .. } | LightKind::Disk { .. } => {
                candidate.material = Some(scene.materials.len() + number);
            }
            kind => measure(&mut candidate.emitter, kind, around),
        }
        candidate
    }

    fn set_environment(&mut self, candidate: &mut Candidate, map: &RadianceMap, scale: Vec3, around: &BoundingSphere) {
        let record = EnvironmentRecord::new(map);
        self.environment = record.texels;
        let cross_section = PI * around.radius * around.radius;
        candidate.emitter.flux = 4.0 * PI * cross_section * record.mean_radiance * scale;
        candidate.emitter.peak = record.largest_ratio * scale.max_element();
    }

    /// Lists the triangles of a surface that shines.
    fn gather_surface(&mut self, scene: &Scene, candidate: &mut Candidate, triangles: &[WorldTriangle]) {
        let material = candidate.material.map_or(u32::MAX, |material| material as u32);
        let first = self.triangles.len();
        // A triangle that straddles a split of the hierarchy is there twice, and shines once.
        let mut seen = std::collections::HashSet::new();
        let own: Vec<_> = triangles
            .iter()
            .enumerate()
            .filter(|(_, t)| t.material == material && seen.insert((t.object, t.triangle)))
            .collect();
        let areas: Vec<f64> = own.iter().map(|(_, t)| 0.5 * f64::from(t.double_area_normal().length())).collect();
        let total: f64 = areas.iter().sum();
        let mut before = 0.0;
        for ((index, _), area) in own.iter().zip(&areas) {
            before += area;
            self.triangles.push([*index as u32, ((before / total) as f32).to_bits(), 0, 0]);
        }
        let Some(last) = self.triangles[first..].last_mut() else { return };
        last[1] = 1f32.to_bits();
        let emitter = &mut candidate.emitter;
        emitter.record.first = first as u32;
        emitter.record.count = own.len() as u32;
        emitter.record.extent = total as f32;
        let strength = Vec3::from(emitter.record.strength);
        let (mean, most) = match scene.materials.get(material as usize) {
            Some(material) if material.textures.any() || material.has_holes() => {
                emission_factors(material, &own, &areas)
            }
            _ => (Vec3::ONE, Vec3::ONE),
        };
        emitter.flux = strength * mean * (PI * total as f32);
        emitter.peak = (strength * most).max_element() * total as f32;
        emitter.bounds = Some(BoundingSphere::around(own.iter().flat_map(|(_, t)| t.corners)));
        emitter.media = media_keys(scene, own[0].1.corners[0]);
    }

    /// Gives every emitter its place and its probability.
    fn arrange(&mut self, candidates: Vec<Candidate>, seen: Vec3, around: &BoundingSphere) {
        self.emitters = candidates.into_iter().map(|candidate| candidate.emitter).collect();
        self.emitters.sort_by_key(|emitter| match emitter.kind() {
            light_kind::SPHERE => 0,
            light_kind::DISTANT | light_kind::ENVIRONMENT => 2,
            _ => 1,
        });
        self.sphere_count = self.emitters.iter().filter(|e| e.kind() == light_kind::SPHERE).count();
        self.first_sky = self.emitters.iter().filter(|e| e.bounds.is_some()).count();
        let total: f32 = self.emitters.iter().map(|emitter| emitter.irradiance_at(seen, around)).sum();
        let even = 1.0 / self.emitters.len().max(1) as f32;
        let mut before = 0.0;
        let last = self.emitters.len();
        for (index, emitter) in self.emitters.iter_mut().enumerate() {
            emitter.index = index;
            before += BY_IRRADIANCE * emitter.irradiance_at(seen, around) / total + (1.0 - BY_IRRADIANCE) * even;
            emitter.record.cumulative_probability = if index + 1 == last { 1.0 } else { before };
            let kind = emitter.kind() | (emitter.group as u32) << light_kind::GROUP_SHIFT;
            self.records.push(shaders::Light { kind, ..emitter.record });
        }
        // By account, so that photons take turns in the order of docs/photon-paths.md.
        self.emitters.sort_by_key(|emitter| emitter.number);
    }

    /// The density with which next-event estimation chooses a point of a material's surface, 1/m².
    pub fn pdf_area(&self, number: usize) -> f32 {
        let Some(emitter) = self.emitters.iter().find(|emitter| emitter.number == number) else { return 0.0 };
        let cumulative = |index: usize| self.records[index].cumulative_probability;
        let before = if emitter.index > 0 { cumulative(emitter.index - 1) } else { 0.0 };
        (cumulative(emitter.index) - before) / emitter.record.extent
    }
}

/// Points at which a picture's emission is looked up for its mean, over all triangles.
const EMISSION_POINTS: f64 = 262_144.0;
/// The share of its greatest value that a picture's mean emission is at least taken for: points may miss what is small and bright.
const LEAST_MEAN_EMISSION: f32 = 1e-4;

/// What pictures and holes make of a surface's emission: the mean over its area, by points of Roberts' R₂ sequence, and the most there can be.
fn emission_factors(material: &Material, triangles: &[(usize, &WorldTriangle)], areas: &[f64]) -> (Vec3, Vec3) {
    let total: f64 = areas.iter().sum();
    let mut sum = DVec3::ZERO;
    for ((_, triangle), area) in triangles.iter().zip(areas) {
        let uvs = triangle.uvs.unwrap_or_default();
        let points = (EMISSION_POINTS * area / total).ceil() as u32;
        let of_triangle: DVec3 = (0..points).map(|i| emission_factor(material, uv_of_point(uvs, i)).as_dvec3()).sum();
        sum += of_triangle * (area / f64::from(points));
    }
    let most = material.textures.emission.as_ref().map_or(Vec3::ONE, |texture| texture.image.most().truncate());
    ((sum / total).as_vec3().max(LEAST_MEAN_EMISSION * most), most)
}

/// Point `i` of a sequence that fills a triangle evenly.
fn uv_of_point([a, b, c]: [Vec2; 3], i: u32) -> Vec2 {
    let u =
        [0.754_877_666_246_692_8, 0.569_840_290_998_053_3].map(|step: f64| (0.5 + step * f64::from(i)).fract() as f32);
    let folded = if u[0] + u[1] > 1.0 { [1.0 - u[0], 1.0 - u[1]] } else { u };
    a + folded[0] * (b - a) + folded[1] * (c - a)
}

/// The factor on a surface's emission at texture coordinates.
fn emission_factor(material: &Material, uv: Vec2) -> Vec3 {
    let picture = material.textures.emission.as_ref().map_or(Vec3::ONE, |texture| texture.at(uv).truncate());
    picture * material.opacity_at(uv)
}

/// The materials that shine and that an object shows, with the names of their emitters.
pub(crate) fn emissive_materials(scene: &Scene) -> Vec<(usize, String)> {
    let materials = scene.materials.iter().enumerate();
    materials
        .filter(|(index, material)| material.is_emissive() && scene.shows(*index))
        .map(|(index, material)| (index, format!("material {}", material.name)))
        .collect()
}

/// The kinds of light that a scene may have, each once: [`light_kind`].
pub(crate) fn kinds_of_light(scene: &Scene) -> Vec<u32> {
    let shining = scene.lights.iter().filter(|light| !light.kind.is_dark());
    let mut kinds: Vec<u32> = shining.map(|light| kind_of(&light.kind)).collect();
    kinds.extend(emissive_materials(scene).iter().map(|_| light_kind::SURFACE));
    kinds.sort_unstable();
    kinds.dedup();
    kinds
}

fn emissive_surface(number: usize, group: usize, strength: Vec3) -> Emitter {
    Emitter {
        number,
        index: 0,
        group,
        photon_share: 1,
        flux: Vec3::ZERO,
        bounds: None,
        peak: 0.0,
        media: [0; 4],
        record: shaders::Light { kind: light_kind::SURFACE, strength: strength.into(), ..Default::default() },
    }
}

/// The point whose surroundings a light stands in; none for light from infinitely far.
fn place(kind: &LightKind) -> Option<Vec3> {
    match *kind {
        LightKind::Sphere { center, .. } | LightKind::Rectangle { center, .. } | LightKind::Disk { center, .. } => {
            Some(center)
        }
        LightKind::Point { position, .. } | LightKind::Spot { position, .. } => Some(position),
        LightKind::Distant { .. } | LightKind::Environment { .. } => None,
    }
}

/// Flux, bounds and peak of a light without triangles.
fn measure(emitter: &mut Emitter, kind: &LightKind, around: &BoundingSphere) {
    let strength = kind.strength();
    match *kind {
        LightKind::Sphere { center, radius, flux } => {
            emitter.flux = flux;
            emitter.bounds = Some(BoundingSphere { center, radius });
            emitter.peak = strength.max_element();
        }
        LightKind::Point { position, flux } | LightKind::Spot { position, flux, .. } => {
            emitter.flux = flux;
            emitter.bounds = Some(BoundingSphere { center: position, radius: 0.0 });
            emitter.peak = strength.max_element();
        }
        LightKind::Distant { irradiance, .. } => {
            emitter.flux = PI * around.radius * around.radius * irradiance;
            // The disc in the sky has a little less irradiance in the measure of directions: L·2π(1 − cos α) < L·π sin²α · 2.
            emitter.peak = 2.0 * irradiance.max_element();
        }
        LightKind::Rectangle { .. } | LightKind::Disk { .. } | LightKind::Environment { .. } => {}
    }
}

/// One of [`light_kind`].
fn kind_of(kind: &LightKind) -> u32 {
    match kind {
        LightKind::Sphere { .. } => light_kind::SPHERE,
        LightKind::Rectangle { .. } | LightKind::Disk { .. } => light_kind::SURFACE,
        LightKind::Point { .. } => light_kind::POINT,
        LightKind::Spot { .. } => light_kind::SPOT,
        LightKind::Distant { .. } => light_kind::DISTANT,
        LightKind::Environment { .. } => light_kind::ENVIRONMENT,
    }
}

fn record(kind: &LightKind) -> shaders::Light {
    let blank = shaders::Light { kind: kind_of(kind), strength: kind.strength().into(), ..Default::default() };
    match *kind {
        LightKind::Sphere { center, radius, .. } => shaders::Light { position: center.into(), extent: radius, ..blank },
        LightKind::Rectangle { .. } | LightKind::Disk { .. } => blank,
        LightKind::Point { position, .. } => shaders::Light { position: position.into(), ..blank },
        LightKind::Spot { position, direction, inner_angle, outer_angle, .. } => shaders::Light {
            position: position.into(),
            axis: direction.normalize().into(),
            cos_inner: inner_angle.to_radians().cos(),
            cos_outer: outer_angle.to_radians().cos(),
            ..blank
        },
        LightKind::Distant { direction, angular_radius, .. } => shaders::Light {
            position: (-direction.normalize()).into(),
            extent: 2.0 * (0.5 * angular_radius.to_radians()).sin().powi(2),
            ..blank
        },
        LightKind::Environment { ref map, rotate, .. } => {
            let (sin, cos) = rotate.to_radians().sin_cos();
            shaders::Light { axis: [cos, sin, 0.0], first: map.width, count: map.height, ..blank }
        }
    }
}

/// The key of a dielectric in lists of media; 0 for another material.
pub(crate) fn medium_key(scene: &Scene, material: usize) -> u32 {
    scene.dielectric_rank(material).map_or(0, |rank| (rank + 1) << 16 | material as u32)
}

/// Index of refraction of the medium of a key.
pub(crate) fn medium_index(scene: &Scene, key: u32) -> f32 {
    match scene.materials.get((key & 0xffff) as usize).map(|material| &material.kind) {
        Some(&MaterialKind::Dielectric { ior, .. }) if key != 0 => ior,
        _ => 1.0,
    }
}

/// The keys of the four highest dielectrics around a point, the highest first.
pub(crate) fn media_keys(scene: &Scene, point: Vec3) -> [u32; 4] {
    keys_of_media(scene, scene.media_at(point))
}

/// The keys of the four highest of some dielectrics, the highest first.
pub(crate) fn keys_of_media(scene: &Scene, media: Vec<usize>) -> [u32; 4] {
    let mut keys: Vec<u32> = media.into_iter().map(|material| medium_key(scene, material)).collect();
    keys.sort_unstable_by(|a, b| b.cmp(a));
    keys.resize(4, 0);
    [keys[0], keys[1], keys[2], keys[3]]
}
