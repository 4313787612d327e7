//! Tangent-space normal maps, as `docs/materials.md`, "Textures", defines them.

use diacaustic_scene::NormalMap;
use glam::DVec3;

use crate::texture::texture_at;

use super::triangle::{Triangle, weighted};

/// n' from the interpolated normal n, both unit length on the triangle's front.
pub(super) fn mapped_normal(map: &NormalMap, triangle: &Triangle, barycentric: DVec3, n: DVec3) -> DVec3 {
    let Some((uvs, (tangents, side))) = triangle.uvs.zip(triangle.tangents) else { return n };
    let across = weighted(tangents, barycentric).reject_from_normalized(n);
    let Some(t) = across.try_normalize() else { return n };
    let b = side * n.cross(t);
    let [x, y, z] = (2.0 * texture_at(&map.texture, weighted(uvs, barycentric)).truncate() - 1.0).to_array();
    let strength = f64::from(map.strength);
    (strength * (x * t + y * b) + z * n).try_normalize().unwrap_or(n)
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use diacaustic_scene::{Texture, TextureImage};
    use glam::DVec2;
    use half::f16;

    use super::*;

    #[test]
    fn tangents_between_the_corners_turn_the_picture() {
        // (0.5, 0, √¾) everywhere.
        let texel = [0.75, 0.5, 0.5 * (1.0 + 0.75f64.sqrt()), 1.0].map(f16::from_f64);
        let image = TextureImage::new(1, 1, vec![texel]).expect("one texel");
        let map = NormalMap { texture: Texture::new(Arc::new(image)), strength: 1.0 };
        let corners = [DVec3::ZERO, DVec3::X, DVec3::Y];
        let bumpy = |tangents| Triangle {
            object: 0,
            index: 0,
            corners,
            normal_geometric: DVec3::Z,
            normals: None,
            uvs: Some([DVec2::ZERO; 3]),
            colors: None,
            opacities: None,
            tangents,
        };
        let middle = DVec3::new(0.0, 0.5, 0.5);
        let n = mapped_normal(&map, &bumpy(Some(([DVec3::X, DVec3::X, DVec3::Y], 1.0))), middle, DVec3::Z);
        let expected = DVec3::new(0.5f64.sqrt() / 2.0, 0.5f64.sqrt() / 2.0, 0.75f64.sqrt());
        assert!(n.distance(expected) < 1e-3, "{n}");
        assert_eq!(mapped_normal(&map, &bumpy(None), middle, DVec3::Z), DVec3::Z);
    }

    #[test]
    fn the_side_turns_what_is_up_in_the_picture() {
        let texel = [0.5, 0.75, 0.5 * (1.0 + 0.75f64.sqrt()), 1.0].map(f16::from_f64);
        let image = TextureImage::new(1, 1, vec![texel]).expect("one texel");
        let map = NormalMap { texture: Texture::new(Arc::new(image)), strength: 1.0 };
        for side in [1.0, -1.0] {
            let triangle = Triangle {
                object: 0,
                index: 0,
                corners: [DVec3::ZERO, DVec3::X, DVec3::Y],
                normal_geometric: DVec3::Z,
                normals: None,
                uvs: Some([DVec2::ZERO; 3]),
                colors: None,
                opacities: None,
                tangents: Some(([DVec3::X; 3], side)),
            };
            let n = mapped_normal(&map, &triangle, DVec3::splat(1.0 / 3.0), DVec3::Z);
            assert!(n.distance(DVec3::new(0.0, 0.5 * side, 0.75f64.sqrt())) < 1e-3, "{n}");
        }
    }
}
