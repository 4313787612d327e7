//! Energy maps: where on its map a photon lands.

use glam::{DVec2, DVec3};

/// How an object's triangles lie on its energy map. Texel (i, j) stands at the point (i, j) of the map.
#[derive(Clone, Debug, PartialEq)]
pub struct MapLayout {
    /// Texels in a row, ≥ 2.
    pub width: u32,
    /// Rows, ≥ 2.
    pub height: u32,
    /// 1, or 2 if the back has a layer of its own.
    pub layers: u32,
    /// For each triangle of the object's mesh, its corners on the map, texels.
    pub corners: Vec<[DVec2; 3]>,
}

/// A photon's end on a receiver.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Landing {
    /// Index in [`World::triangles`](crate::geometry::World::triangles).
    pub triangle: usize,
    /// Weights of the triangle's three corners.
    pub barycentric: DVec3,
    /// Whether it comes from the triangle's front.
    pub front: bool,
    /// What it carries, W.
    pub flux: DVec3,
}

impl MapLayout {
    /// The number of texels in all layers.
    pub fn texels(&self) -> usize {
        self.layers as usize * self.height as usize * self.width as usize
    }

    /// The place of a texel in a map's data: layer by layer, row by row.
    pub fn texel_index(&self, layer: u32, row: u32, column: u32) -> usize {
        (layer as usize * self.height as usize + row as usize) * self.width as usize + column as usize
    }

    /// The four texels that a landing on a triangle of the mesh touches, and their bilinear weights, which sum to 1.
    /// A map of one layer takes what comes from either side.
    ///
    /// # Panics
    /// If the map has no such triangle.
    pub fn footprint(&self, triangle: usize, landing: &Landing) -> [(usize, f64); 4] {
        let corners = self.corners[triangle];
        let weights = landing.barycentric;
        let point = weights.x * corners[0] + weights.y * corners[1] + weights.z * corners[2];
        let (column, f) = cell(point.x, self.width);
        let (row, g) = cell(point.y, self.height);
        let layer = if landing.front { 0 } else { self.layers - 1 };
        let at = |di, dj| self.texel_index(layer, row + dj, column + di);
        [(at(0, 0), (1.0 - f) * (1.0 - g)), (at(1, 0), f * (1.0 - g)), (at(0, 1), (1.0 - f) * g), (at(1, 1), f * g)]
    }
}

/// The cell that a coordinate falls in and its place there.
fn cell(coordinate: f64, texels: u32) -> (u32, f64) {
    let first = coordinate.floor().clamp(0.0, f64::from(texels - 2));
    (first as u32, coordinate - first)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn layout(layers: u32) -> MapLayout {
        let corners = vec![[DVec2::ZERO, DVec2::new(4.0, 0.0), DVec2::new(0.0, 2.0)]];
        MapLayout { width: 5, height: 3, layers, corners }
    }

    fn landing(barycentric: DVec3, front: bool) -> Landing {
        Landing { triangle: 0, barycentric, front, flux: DVec3::ONE }
    }

    #[test]
    fn footprint_is_centred_on_the_point() {
        let layout = layout(2);
        let weights = DVec3::new(0.3, 0.4, 0.3);
        for front in [true, false] {
            let footprint = layout.footprint(0, &landing(weights, front));
            let offset = if front { 0 } else { 15 };
            let mean = footprint.iter().fold(DVec2::ZERO, |sum, &(texel, weight)| {
                let texel = texel - offset;
                sum + weight * DVec2::new((texel % 5) as f64, (texel / 5) as f64)
            });
            assert!(mean.distance(DVec2::new(1.6, 0.6)) < 1e-14);
            assert!((footprint.iter().map(|t| t.1).sum::<f64>() - 1.0).abs() < 1e-15);
        }
    }

    #[test]
    fn last_texel_takes_the_far_corner() {
        let footprint = layout(1).footprint(0, &landing(DVec3::Y, false));
        let full: Vec<_> = footprint.iter().filter(|t| t.1 > 0.0).collect();
        assert_eq!(full, [&(4, 1.0)]);
    }
}
