//! Meshes of simple shapes.

use std::f64::consts::{PI, TAU};

use glam::{DVec3, Vec2, Vec3};

use crate::{Chart, Mesh};

/// Width of the gap between the faces of a box on its energy map, in longest edges of the box.
const ATLAS_GAP: f32 = 0.02;

/// The largest cosine between the edges of a rectangle.
const PERPENDICULAR: f32 = 1e-3;

/// Whether two vectors may be the edges of a rectangle.
pub(crate) fn are_perpendicular(edge_u: Vec3, edge_v: Vec3) -> bool {
    edge_u.dot(edge_v).abs() <= PERPENDICULAR * edge_u.length() * edge_v.length()
}

impl Mesh {
    /// The most subdivisions that [`Mesh::sphere`] takes: 4 million triangles.
    pub const MAX_SPHERE_SUBDIVISIONS: u32 = 10;

    /// A sphere of inscribed triangles between 2ⁿ bands of latitude and 2ⁿ⁺¹ of longitude (n = `subdivisions`), with
    /// the exact sphere's normals: 4·2ⁿ(2ⁿ − 1) triangles, 16128 for n = 6, an octahedron for n = 1 and none for n = 0.
    ///
    /// Closed. Its texture coordinates are longitude and latitude in \[0, 1\]², which do not overlap; the seam and the
    /// poles stand in the vertex list once for each of their texture coordinates. Centre and radius in metres.
    ///
    /// # Panics
    /// If `subdivisions` is greater than [`Mesh::MAX_SPHERE_SUBDIVISIONS`].
    pub fn sphere(center: Vec3, radius: f32, subdivisions: u32) -> Self {
        assert!(subdivisions <= Self::MAX_SPHERE_SUBDIVISIONS, "a sphere of {subdivisions} subdivisions is too large");
        let (bands, sectors) = (1u32 << subdivisions, 2u32 << subdivisions);
        let mut mesh = Self { chart: Chart::Automatic, ..Self::default() };
        for band in 0..=bands {
            let is_pole = band == 0 || band == bands;
            for sector in 0..=sectors {
                let normal = sphere_normal(band, bands, sector % sectors, sectors).as_vec3();
                mesh.positions.push(center + radius * normal);
                mesh.normals.push(normal);
                let u = (sector as f32 + if is_pole { 0.5 } else { 0.0 }) / sectors as f32;
                mesh.uvs.push(Vec2::new(u.min(1.0), 1.0 - band as f32 / bands as f32));
            }
        }
        for band in 0..bands {
            for sector in 0..sectors {
                let upper = band * (sectors + 1) + sector;
                let lower = upper + sectors + 1;
                if band > 0 {
                    mesh.triangles.push([upper, lower, upper + 1]);
                }
                if band + 1 < bands {
                    let top = if band > 0 { upper + 1 } else { upper };
                    mesh.triangles.push([top, lower, lower + 1]);
                }
            }
        }
        mesh
    }

    /// A rectangle of two triangles about `center` (metres), with its edges as full, perpendicular vectors (metres).
    ///
    /// Its normal is along `edge_u` × `edge_v`, its texture coordinates go from 0 to 1 along the two edges.
    pub fn rectangle(center: Vec3, edge_u: Vec3, edge_v: Vec3) -> Self {
        let mut mesh = Self::default();
        let place = mesh.push_rectangle(center - 0.5 * (edge_u + edge_v), edge_u, edge_v, Vec2::ZERO);
        mesh.chart = Chart::Natural(place.to_vec());
        mesh
    }

    /// A box of 12 triangles between two corners (metres), `min` less than `max` along each axis.
    ///
    /// Closed, with flat faces. On each face texture coordinates go from 0 to 1, upright on the four sides; on the energy map the
    /// faces lie apart.
    pub fn cuboid(min: Vec3, max: Vec3) -> Self {
        let [x, y, z] = (max - min).to_array();
        let (along_x, along_y, along_z) = (Vec3::X * x, Vec3::Y * y, Vec3::Z * z);
        let gap = ATLAS_GAP * x.max(y).max(z);
        let second_row = y + gap;
        let faces = [
            (min + along_z, along_x, along_y, Vec2::ZERO),
            (min + along_x + along_z, -along_z, along_y, Vec2::new(x + gap, 0.0)),
            (min + along_x, -along_x, along_y, Vec2::new(x + z + 2.0 * gap, 0.0)),
            (min, along_z, along_y, Vec2::new(2.0 * x + z + 3.0 * gap, 0.0)),
            (min + along_y + along_z, along_x, -along_z, Vec2::new(0.0, second_row)),
            (min, along_x, along_z, Vec2::new(x + gap, second_row)),
        ];
        let mut mesh = Self::default();
        let places = faces.map(|(corner, edge_u, edge_v, place)| mesh.push_rectangle(corner, edge_u, edge_v, place));
        mesh.chart = Chart::Natural(places.concat());
        mesh.weld_to_corners(min, max);
        mesh
    }

    /// Adds a rectangle; returns the places of its corners on a map where its first corner is at `place`.
    fn push_rectangle(&mut self, corner: Vec3, edge_u: Vec3, edge_v: Vec3, place: Vec2) -> [Vec2; 4] {
        let first = self.positions.len() as u32;
        let size = Vec2::new(edge_u.length(), edge_v.length());
        let normal = edge_u.cross(edge_v).normalize_or_zero();
        self.positions.extend([corner, corner + edge_u, corner + edge_u + edge_v, corner + edge_v]);
        self.normals.extend([normal; 4]);
        self.triangles.extend([[first, first + 1, first + 2], [first, first + 2, first + 3]]);
        let square = [Vec2::ZERO, Vec2::X, Vec2::ONE, Vec2::Y];
        self.uvs.extend(square);
        square.map(|corner| place + corner * size)
    }

    /// Replaces rounded sums by the exact corners, so that the faces of a box weld.
    fn weld_to_corners(&mut self, min: Vec3, max: Vec3) {
        for position in &mut self.positions {
            *position = Vec3::select(position.cmplt(0.5 * min + 0.5 * max), min, max);
        }
    }
}

/// The outward normal at a vertex of the latitude-longitude grid; exactly ±Y at the poles.
fn sphere_normal(band: u32, bands: u32, sector: u32, sectors: u32) -> DVec3 {
    if band == 0 || band == bands {
        return if band == 0 { DVec3::Y } else { DVec3::NEG_Y };
    }
    let (sin_theta, cos_theta) = (PI * f64::from(band) / f64::from(bands)).sin_cos();
    let (sin_phi, cos_phi) = (TAU * f64::from(sector) / f64::from(sectors)).sin_cos();
    DVec3::new(sin_theta * sin_phi, cos_theta, sin_theta * cos_phi)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn area(mesh: &Mesh) -> f32 {
        (0..mesh.triangles.len()).map(|t| 0.5 * mesh.double_area_normal(t).length()).sum()
    }

    /// The corners of a triangle on the map.
    fn map_corners(mesh: &Mesh, triangle: usize) -> [Vec2; 3] {
        let places = if let Chart::Natural(places) = &mesh.chart { places } else { &mesh.uvs };
        mesh.triangles[triangle].map(|v| places[v as usize])
    }

    /// Twice the signed area of a triangle on the map.
    fn double_map_area(mesh: &Mesh, triangle: usize) -> f32 {
        let [a, b, c] = map_corners(mesh, triangle);
        (b - a).perp_dot(c - a)
    }

    /// Whether two triangles on the map share more than borders: no edge of either separates them.
    fn overlap(a: [Vec2; 3], b: [Vec2; 3]) -> bool {
        let separates = |a: [Vec2; 3], b: [Vec2; 3]| {
            (0..3).any(|i| {
                let (from, along) = (a[i], a[(i + 1) % 3] - a[i]);
                b.iter().all(|p| along.perp_dot(*p - from) <= 1e-6)
            })
        };
        !separates(a, b) && !separates(b, a)
    }

    fn assert_chart_is_one_to_one(mesh: &Mesh) {
        for first in 0..mesh.triangles.len() {
            assert!(double_map_area(mesh, first) > 0.0, "triangle {first} is mirrored or empty on the map");
            for second in 0..first {
                assert!(!overlap(map_corners(mesh, first), map_corners(mesh, second)), "{first} and {second} overlap");
            }
        }
    }

    fn assert_normals_face_out(mesh: &Mesh) {
        for (t, triangle) in mesh.triangles.iter().enumerate() {
            let facet = mesh.double_area_normal(t).normalize();
            for vertex in triangle {
                let normal = mesh.normals[*vertex as usize];
                assert!((normal.length() - 1.0).abs() < 1e-6);
                assert!(normal.dot(facet) > 0.5, "triangle {t}: {normal} against {facet}");
            }
        }
    }

    #[test]
    fn sphere_is_closed_and_round() {
        let center = Vec3::new(0.3, -1.7, 2.9);
        let mesh = Mesh::sphere(center, 0.7, 6);
        assert_eq!(mesh.triangles.len(), 16128);
        assert_eq!(mesh.open_edges(), 0);
        assert_normals_face_out(&mesh);
        for (position, normal) in mesh.positions.iter().zip(&mesh.normals) {
            assert!((*position - (center + 0.7 * *normal)).length() < 1e-6);
        }
        let exact = 4.0 * std::f32::consts::PI * 0.7 * 0.7;
        assert!((area(&mesh) / exact - 1.0).abs() < 1e-3);
        assert!(mesh.uvs.iter().all(|uv| uv.cmpge(Vec2::ZERO).all() && uv.cmple(Vec2::ONE).all()));
        assert_eq!((Mesh::sphere(center, 0.7, 1).triangles.len(), Mesh::sphere(center, 0.7, 1).open_edges()), (8, 0));
        assert!(Mesh::sphere(center, 0.7, 0).triangles.is_empty());
    }

    #[test]
    fn sphere_chart_is_one_to_one() {
        for subdivisions in 1..=4 {
            assert_chart_is_one_to_one(&Mesh::sphere(Vec3::ZERO, 1.0, subdivisions));
        }
    }

    #[test]
    fn rectangle_is_metric() {
        let mesh = Mesh::rectangle(Vec3::new(0.0, 1.0, 0.0), Vec3::new(3.0, 0.0, 0.0), Vec3::new(0.0, 0.0, -2.0));
        assert_eq!(mesh.normals, [Vec3::Y; 4]);
        assert_eq!(mesh.uvs[2], Vec2::ONE);
        assert_eq!(map_corners(&mesh, 0)[2], Vec2::new(3.0, 2.0));
        assert_eq!(mesh.positions[0], Vec3::new(-1.5, 1.0, 1.0));
        assert_eq!(area(&mesh), 6.0);
        assert_eq!(mesh.open_edges(), 4);
        assert_chart_is_one_to_one(&mesh);
    }

    #[test]
    fn cuboid_is_closed_and_metric() {
        let mesh = Mesh::cuboid(Vec3::new(-0.1, 0.2, 0.7), Vec3::new(1.3, 0.9, 3.1));
        assert_eq!((mesh.triangles.len(), mesh.open_edges()), (12, 0));
        assert_normals_face_out(&mesh);
        assert!((area(&mesh) - 2.0 * (1.4 * 0.7 + 1.4 * 2.4 + 0.7 * 2.4)).abs() < 1e-5);
        for triangle in 0..12 {
            let on_surface = mesh.double_area_normal(triangle).length();
            assert!((double_map_area(&mesh, triangle) - on_surface).abs() < 1e-5);
        }
        assert_chart_is_one_to_one(&mesh);
    }
}
