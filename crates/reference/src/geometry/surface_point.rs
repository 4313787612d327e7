//! What a material and its pictures are at a point of a triangle.

use diacaustic_scene::MaterialKind;
use glam::{DVec2, DVec3};

use crate::bsdf::{Factors, PreparedMaterial};
use crate::generator::Generator;
use crate::texture::{color_at, number_at};

use super::normal_map::mapped_normal;
use super::triangle::weighted;
use super::{Facing, Hit, Ray, World};

impl World<'_> {
    /// The surface that a ray of this direction meets.
    pub fn facing(&self, hit: &Hit, direction: DVec3) -> Facing {
        let triangle = &self.triangles[hit.triangle];
        let mapped = self.prepared_at(hit).material.textures.normal.is_some();
        let normal = mapped.then(|| self.shading_normal(hit));
        triangle.facing(hit.barycentric, direction, normal)
    }

    /// The shading normal on the triangle's front, whoever looks: that of the normal map, else the interpolated one, else
    /// the geometric one. Unit length.
    pub fn shading_normal(&self, hit: &Hit) -> DVec3 {
        let triangle = &self.triangles[hit.triangle];
        let n = triangle.interpolated_normal(hit.barycentric).unwrap_or(triangle.normal_geometric);
        let map = self.prepared_at(hit).material.textures.normal.as_ref();
        map.map_or(n, |map| mapped_normal(map, triangle, hit.barycentric, n))
    }

    /// The irradiance on a surface of the shading normal over that on the triangle, for light of a direction of flight.
    /// Nothing comes from below the shading normal, as the eye sees it: it is for directions of the eye that it gives way.
    pub(crate) fn landing_factor(&self, hit: &Hit, facing: &Facing, direction: DVec3) -> f64 {
        let side = if facing.front { 1.0 } else { -1.0 };
        let cos = -direction.dot(side * self.shading_normal(hit));
        cos.max(0.0) / -direction.dot(facing.normal_geometric)
    }

    /// What the material's pictures and the mesh's vertex colours multiply the material's numbers by.
    pub(crate) fn factors(&self, hit: &Hit) -> Factors {
        let prepared = self.prepared_at(hit);
        let pictures = match prepared.varies {
            true => Factors::at(&prepared.material.textures, self.uv(hit.triangle, hit.barycentric)),
            false => Factors::ONE,
        };
        let colors = self.triangles[hit.triangle].colors;
        let tint = colors.map_or(DVec3::ONE, |colors| weighted(colors, hit.barycentric));
        Factors { color: pictures.color * tint, ..pictures }
    }

    /// Radiance that a point of a triangle's front sends in each direction, W/(m² sr), given that the point stands.
    pub fn emission(&self, triangle: usize, barycentric: DVec3) -> DVec3 {
        let material = self.material(triangle);
        let picture = material.textures.emission.as_ref();
        material.emission.as_dvec3() * color_at(picture, self.uv(triangle, barycentric))
    }

    /// The probability that a ray meets a triangle at a point.
    pub fn opacity(&self, triangle: usize, barycentric: DVec3) -> f64 {
        let PreparedMaterial { material, has_holes, .. } = self.prepared(triangle);
        let of_vertices = self.triangles[triangle].opacities;
        let is_solid = matches!(material.kind, MaterialKind::Dielectric { .. });
        if is_solid || !has_holes && of_vertices.is_none() {
            return 1.0;
        }
        let picture = material.textures.opacity.as_ref();
        let opacity = f64::from(material.opacity)
            * number_at(picture, self.uv(triangle, barycentric))
            * of_vertices.map_or(1.0, |opacities| weighted(opacities, barycentric));
        match material.opacity_cutoff {
            Some(cutoff) if opacity >= f64::from(cutoff) => 1.0,
            Some(_) => 0.0,
            None => opacity,
        }
    }

    /// What a ray meets at a hit: of two materials the one or the other, as a number in [0, 1) decides that is drawn if there are two.
    pub fn taken(&self, hit: &Hit, draw: impl FnOnce() -> f64) -> Hit {
        let Some(blend) = &self.material(hit.triangle).blend else { return *hit };
        let picture = blend.texture.as_ref();
        let share = f64::from(blend.share) * number_at(picture, self.uv(hit.triangle, hit.barycentric));
        Hit { takes_rest: draw() >= share, ..*hit }
    }

    /// The same for a ray, whose own number decides.
    pub(crate) fn taken_by(&self, ray: &Ray, hit: &Hit) -> Hit {
        self.taken(hit, || number_of(ray, hit, BLENDS))
    }

    /// Whether a ray meets the triangle that it hits, by a chance that belongs to the ray, the triangle and `key`.
    pub(super) fn stands(&self, ray: &Ray, hit: &Hit, key: u64) -> bool {
        if !self.has_holes {
            return true;
        }
        let opacity = self.opacity(hit.triangle, hit.barycentric);
        if opacity <= 0.0 || opacity >= 1.0 {
            return opacity > 0.0;
        }
        number_of(ray, hit, key) < opacity
    }

    /// Texture coordinates of a point; (0, 0) where the mesh has none.
    fn uv(&self, triangle: usize, barycentric: DVec3) -> DVec2 {
        self.triangles[triangle].uvs.map_or(DVec2::ZERO, |uvs| weighted(uvs, barycentric))
    }
}

/// Sets the numbers that choose between two materials apart from those of holes.
const BLENDS: u64 = 0x0b1e_4d5e;

/// A number in [0, 1) that belongs to a ray, a triangle and `key`.
fn number_of(ray: &Ray, hit: &Hit, key: u64) -> f64 {
    let [origin, direction] = [ray.origin, ray.direction].map(|v| v.to_array().map(f64::to_bits));
    let [a, b, c] = origin;
    let [d, e, f] = direction;
    Generator::new(&[key, hit.triangle as u64, a, b, c, d, e, f]).unit()
}
