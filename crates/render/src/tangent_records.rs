//! Tangents of normal maps as the device knows them; docs/materials.md, "Textures".

use diacaustic_scene::{Object, Scene};
use diacaustic_shaders::tangent::{BITS, LEFT, PRESENT, SCALE};
use diacaustic_surface::WorldTriangle;
use glam::{Mat3, Vec2, Vec3, Vec4, Vec4Swizzles};

/// The tangents of a scene's objects, object by object.
pub(crate) struct Tangents<'s> {
    objects: Vec<(&'s Object, Vec<[Vec4; 3]>)>,
}

impl<'s> Tangents<'s> {
    pub fn of(scene: &'s Scene) -> Self {
        let of_object = |object: &'s Object| (object, object.corner_tangents(&scene.materials));
        Self { objects: scene.objects.iter().map(of_object).collect() }
    }

    /// Those of a triangle in the order of its corners, packed; 0 without.
    pub fn record(&self, triangle: &WorldTriangle) -> [u32; 2] {
        // The surfaces of lights are objects beyond the scene's.
        let Some((object, tangents)) = self.objects.get(triangle.object as usize) else { return [0; 2] };
        let Some(corners) = tangents.get(triangle.triangle as usize) else { return [0; 2] };
        let linear = Mat3::from(object.world_from_object.matrix3);
        let corners = triangle.arrange(*corners).map(|tangent| {
            let along = (linear * tangent.xyz()).normalize_or_zero();
            along.extend(tangent.w * linear.determinant().signum())
        });
        packed(corners)
    }
}

/// Three unit tangents and their side, which they share; 0 if one is 0.
fn packed(tangents: [Vec4; 3]) -> [u32; 2] {
    if tangents.iter().any(|tangent| tangent.xyz() == Vec3::ZERO) {
        return [0; 2];
    }
    let side = if tangents[0].w < 0.0 { LEFT } else { 0 };
    let [a, b, c] = tangents.map(|tangent| octahedral(tangent.xyz()));
    let word = |coordinates: [u32; 3]| coordinates[0] | coordinates[1] << BITS | coordinates[2] << (2 * BITS);
    [PRESENT | side | word([a[0], a[1], b[0]]), word([b[1], c[0], c[1]])]
}

/// Octahedral coordinates of a unit vector (Meyer et al. 2010), in steps.
fn octahedral(v: Vec3) -> [u32; 2] {
    let size = v.abs().element_sum();
    let flat = v.truncate() / size;
    let sign = Vec2::new(1f32.copysign(flat.x), 1f32.copysign(flat.y));
    let at = if v.z < 0.0 { (Vec2::ONE - Vec2::new(flat.y, flat.x).abs()) * sign } else { flat };
    at.to_array().map(|coordinate| ((coordinate + 1.0) * SCALE as f32).round() as u32)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// As `shaders/texture/tangent.wgsl` does.
    fn unpacked(word: u32, place: u32) -> f32 {
        ((word >> (BITS * place)) & ((1 << BITS) - 1)) as f32 / SCALE as f32 - 1.0
    }

    fn from_octahedron(at: Vec2) -> Vec3 {
        let z = 1.0 - at.x.abs() - at.y.abs();
        let fold = (-z).max(0.0);
        (at - fold * Vec2::new(1f32.copysign(at.x), 1f32.copysign(at.y))).extend(z).normalize()
    }

    #[test]
    fn tangents_come_back_within_a_quarter_of_a_degree() {
        for axis in [Vec3::X, Vec3::NEG_X, Vec3::Y, Vec3::NEG_Y, Vec3::Z, Vec3::NEG_Z] {
            let [x, y] = octahedral(axis).map(|step| step as f32 / SCALE as f32 - 1.0);
            assert_eq!(from_octahedron(Vec2::new(x, y)), axis);
        }
        let mut worst = 0.0f32;
        for i in 0..40_000 {
            let (z, turn) = (1.0 - 2.0 * (i as f32 + 0.5) / 40_000.0, 2.399_963 * i as f32);
            let v = Vec3::new((1.0 - z * z).sqrt() * turn.cos(), (1.0 - z * z).sqrt() * turn.sin(), z);
            let [first, second] = packed([v.extend(1.0), Vec4::new(1.0, 0.0, 0.0, 1.0), v.extend(1.0)]);
            let (a, c) = ([unpacked(first, 0), unpacked(first, 1)], [unpacked(second, 1), unpacked(second, 2)]);
            assert_eq!(a, c);
            worst = worst.max(from_octahedron(a.into()).angle_between(v));
        }
        assert!(worst.to_degrees() < 0.25, "{}", worst.to_degrees());
    }

    #[test]
    fn none_and_left_are_marked() {
        let x = Vec4::new(1.0, 0.0, 0.0, 1.0);
        assert_eq!(packed([x, Vec4::ZERO, x]), [0; 2]);
        assert_eq!(packed([x; 3])[0] & (PRESENT | LEFT), PRESENT);
        assert_eq!(packed([x.xyz().extend(-1.0); 3])[0] & (PRESENT | LEFT), PRESENT | LEFT);
    }
}
