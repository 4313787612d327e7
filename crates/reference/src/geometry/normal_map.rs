//! Tangent-space normal maps, as `docs/materials.md`, "Textures", defines them.

use diacaustic_scene::NormalMap;
use glam::{DVec2, DVec3};

use crate::texture::texture_at;

use super::triangle::{Triangle, weighted};

/// n' from the interpolated normal n, both unit length on the triangle's front.
pub(super) fn mapped_normal(map: &NormalMap, triangle: &Triangle, barycentric: DVec3, n: DVec3) -> DVec3 {
    let Some(uvs) = triangle.uvs else { return n };
    let picture_from_uv = map.texture.picture_from_uv.as_daffine2();
    let places = uvs.map(|uv| picture_from_uv.transform_point2(uv));
    let Some([t, b]) = tangents(triangle.corners, places, n) else { return n };
    let [x, y, z] = (2.0 * texture_at(&map.texture, weighted(uvs, barycentric)).truncate() - 1.0).to_array();
    let strength = f64::from(map.strength);
    (strength * (x * t + y * b) + z * n).try_normalize().unwrap_or(n)
}

/// Unit vectors T and B across n along which the picture's s and t grow; none where the picture is squeezed to a line.
fn tangents([a, b, c]: [DVec3; 3], places: [DVec2; 3], n: DVec3) -> Option<[DVec3; 2]> {
    let (e1, e2) = (b - a, c - a);
    let (d1, d2) = (places[1] - places[0], places[2] - places[0]);
    let determinant = d1.perp_dot(d2);
    if determinant == 0.0 {
        return None;
    }
    let along_s = determinant.signum() * (d2.y * e1 - d1.y * e2);
    let along_t = determinant.signum() * (d1.x * e2 - d2.x * e1);
    let tangent = along_s.reject_from_normalized(n).try_normalize()?;
    let bitangent = n.cross(tangent);
    Some([tangent, bitangent.dot(along_t).signum() * bitangent])
}

#[cfg(test)]
mod tests {
    use super::*;

    const CORNERS: [DVec3; 3] = [DVec3::ZERO, DVec3::X, DVec3::Y];

    #[test]
    fn tangents_follow_the_picture() {
        let upright = [DVec2::ZERO, DVec2::new(3.0, 0.0), DVec2::new(0.0, 0.5)];
        assert_eq!(tangents(CORNERS, upright, DVec3::Z), Some([DVec3::X, DVec3::Y]));
        let turned = [DVec2::ZERO, DVec2::Y, -DVec2::X];
        assert_eq!(tangents(CORNERS, turned, DVec3::Z), Some([-DVec3::Y, DVec3::X]));
        let mirrored = [DVec2::ZERO, -DVec2::X, DVec2::Y];
        assert_eq!(tangents(CORNERS, mirrored, DVec3::Z), Some([-DVec3::X, DVec3::Y]));
        let line = [DVec2::ZERO, DVec2::ONE, 2.0 * DVec2::ONE];
        assert_eq!(tangents(CORNERS, line, DVec3::Z), None);
    }

    #[test]
    fn order_of_the_corners_does_not_matter() {
        let places = [DVec2::new(0.1, 0.2), DVec2::new(0.9, -0.3), DVec2::new(0.4, 1.1)];
        let n = DVec3::new(0.2, -0.3, 1.0).normalize();
        let order = |values: [usize; 3]| tangents(values.map(|k| CORNERS[k]), values.map(|k| places[k]), n);
        let expected = order([0, 1, 2]).expect("the picture covers the triangle");
        for values in [[1, 2, 0], [2, 0, 1], [0, 2, 1], [1, 0, 2], [2, 1, 0]] {
            let found = order(values).expect("the picture covers the triangle");
            assert!(found[0].distance(expected[0]) < 1e-14 && found[1].distance(expected[1]) < 1e-14);
        }
    }
}
