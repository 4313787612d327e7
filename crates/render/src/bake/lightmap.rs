//! Lightmaps, as the application reads them.

use diacaustic_surface::MapLayout;

/// The irradiance of one object's surface, W/m², linear Rec. 709: a texel for each of its energy map, layer by layer and row by row.
///
/// A texel holds the mean over the surface by its bilinear weight, as an energy map's does. It tells what meets the surface, whatever its
/// material: a white matt surface sends E/π of radiance in every direction. Texels without surface hold what those beside them do, so that
/// bilinear lookups near a border show no seam.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Lightmap {
    /// Texels along x.
    pub width: u32,
    /// Texels along y.
    pub height: u32,
    /// 1, or 2: what falls on the front, then what falls on the back.
    pub layers: u32,
    /// Light that comes straight from lights.
    pub direct: Vec<[f32; 3]>,
    /// Light that comes through casters, from the energy map.
    pub caustic: Vec<[f32; 3]>,
    /// Light that other receivers send on, and the background's.
    pub indirect: Vec<[f32; 3]>,
    /// For each texel of one layer the point of the surface that lies nearest to its middle on the map; none where no surface is within a
    /// texel.
    pub places: Vec<Option<SurfacePlace>>,
}

/// A point of a mesh's surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfacePlace {
    /// Index of the triangle in the object's mesh.
    pub triangle: u32,
    /// Barycentric weights of its three corners.
    pub weights: [f32; 3],
}

impl Lightmap {
    /// A dark map without surface.
    pub(crate) fn new(layout: &MapLayout, places: Vec<Option<SurfacePlace>>) -> Self {
        let dark = vec![[0.0; 3]; layout.texel_count() as usize];
        Self {
            width: layout.width,
            height: layout.height,
            layers: layout.layers,
            direct: dark.clone(),
            caustic: dark.clone(),
            indirect: dark,
            places,
        }
    }

    /// All light that meets a texel's surface, W/m².
    ///
    /// # Panics
    /// If `texel` is out of range.
    pub fn irradiance(&self, texel: usize) -> [f32; 3] {
        let parts = [self.direct[texel], self.caustic[texel], self.indirect[texel]];
        std::array::from_fn(|channel| parts.iter().map(|part| part[channel]).sum())
    }
}

/// Gives the texels of one layer that hold nothing the mean of their neighbours, from those beside texels that do outwards.
pub(crate) fn spread_outwards(texels: &mut [[f32; 3]], width: usize, holds: &[bool]) {
    let height = texels.len() / width.max(1);
    let mut is_set = holds.to_vec();
    let around = move |texel: usize| {
        let (x, y) = (texel % width, texel / width);
        let columns = x.saturating_sub(1)..=(x + 1).min(width - 1);
        (y.saturating_sub(1)..=(y + 1).min(height - 1)).flat_map(move |y| columns.clone().map(move |x| y * width + x))
    };
    let mut front: Vec<usize> = (0..texels.len()).filter(|&texel| is_set[texel]).collect();
    while !front.is_empty() {
        let mut next: Vec<usize> = front.iter().flat_map(|&texel| around(texel)).filter(|&t| !is_set[t]).collect();
        next.sort_unstable();
        next.dedup();
        let values: Vec<[f32; 3]> =
            next.iter().map(|&texel| mean(texels, around(texel).filter(|&t| is_set[t]))).collect();
        for (&texel, value) in next.iter().zip(values) {
            texels[texel] = value;
            is_set[texel] = true;
        }
        front = next;
    }
}

fn mean(texels: &[[f32; 3]], of: impl Iterator<Item = usize>) -> [f32; 3] {
    let (mut sum, mut count) = ([0.0; 3], 0.0f32);
    for texel in of {
        sum = std::array::from_fn(|channel| sum[channel] + texels[texel][channel]);
        count += 1.0;
    }
    sum.map(|channel| channel / count.max(1.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn light_spreads_ring_by_ring() {
        let mut texels = vec![[0.0; 3]; 5 * 4];
        let mut holds = vec![false; texels.len()];
        for (texel, value) in [(5, 2.0), (6, 4.0)] {
            texels[texel] = [value; 3];
            holds[texel] = true;
        }
        spread_outwards(&mut texels, 5, &holds);
        let red: Vec<f32> = texels.iter().map(|texel| texel[0]).collect();
        // Beside both: their mean; beside one alone: its value; farther out: the mean of the ring before.
        assert_eq!(red[..5], [3.0, 3.0, 4.0, 4.0, 4.0]);
        assert_eq!((red[5], red[6], red[7]), (2.0, 4.0, 4.0));
        assert_eq!(red[15], 3.0);
        let mut dark = vec![[0.0; 3]; 4];
        spread_outwards(&mut dark, 2, &[false; 4]);
        assert_eq!(dark, [[0.0; 3]; 4]);
    }
}
