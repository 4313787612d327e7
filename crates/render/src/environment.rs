//! The environment's record: its picture and the probabilities by which it is sampled.

use diacaustic_scene::RadianceMap;
use glam::Vec3;

/// An environment as the kernels read it (`environment` in `shaders/layout/scene.wgsl`).
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct EnvironmentRecord {
    /// A texel for each row, then the picture.
    pub texels: Vec<[f32; 4]>,
    /// Radiance averaged over all directions, W/(m² sr), without the light's scale.
    pub mean_radiance: Vec3,
    /// The greatest ratio of a channel's radiance to the density of its direction, W/m².
    pub largest_ratio: f32,
}

impl EnvironmentRecord {
    pub fn new(map: &RadianceMap) -> Self {
        let (width, height) = (map.width as usize, map.height as usize);
        let weights = texel_weights(map);
        let row_sums: Vec<f64> = weights.chunks_exact(width).map(|row| row.iter().sum()).collect();
        let total: f64 = row_sums.iter().sum();
        let rows = cumulative(&row_sums);
        let mut texels: Vec<[f32; 4]> = rows.iter().map(|&share| [share, 0.0, 0.0, 0.0]).collect();
        for (row, weights) in weights.chunks_exact(width).enumerate() {
            let columns = cumulative(weights);
            let radiance = &map.texels[row * width..][..width];
            texels.extend(
                radiance.iter().zip(columns).map(|(radiance, share)| [radiance.x, radiance.y, radiance.z, share]),
            );
        }
        let solid_angle = |row: usize| row_solid_angle(row, width, height);
        let mean_radiance = (0..height)
            .map(|row| {
                let sum: Vec3 = map.texels[row * width..][..width].iter().sum();
                sum * (solid_angle(row) / (4.0 * std::f64::consts::PI)) as f32
            })
            .sum();
        let ratio = |row: usize, column: usize| {
            let pdf = weights[row * width + column] / (total * solid_angle(row));
            if pdf > 0.0 { f64::from(largest_nearby(map, row, column)) / pdf } else { 0.0 }
        };
        let largest_ratio = (0..height * width).map(|texel| ratio(texel / width, texel % width)).fold(0.0, f64::max);
        Self { texels, mean_radiance, largest_ratio: largest_ratio as f32 }
    }
}

/// Solid angle of a texel of a row, sr.
fn row_solid_angle(row: usize, width: usize, height: usize) -> f64 {
    let edge = |row: usize| (std::f64::consts::PI * row as f64 / height as f64).cos();
    std::f64::consts::TAU / width as f64 * (edge(row) - edge(row + 1))
}

/// The nine texels around one: wrapping columns, ending rows.
fn nearby(map: &RadianceMap, row: usize, column: usize) -> impl Iterator<Item = (f64, Vec3)> + '_ {
    let (width, height) = (map.width as usize, map.height as usize);
    let shares = [0.125, 0.75, 0.125];
    (0..9).map(move |k| {
        let near_row = (row + k / 3).saturating_sub(1).min(height - 1);
        let near_column = (column + k % 3 + width - 1) % width;
        (shares[k / 3] * shares[k % 3], map.texels[near_row * width + near_column])
    })
}

fn largest_nearby(map: &RadianceMap, row: usize, column: usize) -> f32 {
    nearby(map, row, column).map(|(_, radiance)| radiance.max_element()).fold(0.0, f32::max)
}

/// Each texel's weight: the mean over its area of the bilinear radiance, and over the channels, times its solid angle.
fn texel_weights(map: &RadianceMap) -> Vec<f64> {
    let (width, height) = (map.width as usize, map.height as usize);
    (0..width * height)
        .map(|texel| {
            let (row, column) = (texel / width, texel % width);
            let mean: f64 =
                nearby(map, row, column).map(|(share, radiance)| share * f64::from(radiance.element_sum())).sum();
            mean * row_solid_angle(row, width, height)
        })
        .collect()
}

/// Shares of the sum up to and including each weight; the last weight that counts, and those after it, have 1.
fn cumulative(weights: &[f64]) -> Vec<f32> {
    let total: f64 = weights.iter().sum();
    let last = weights.iter().rposition(|weight| *weight > 0.0).unwrap_or(0);
    let mut before = 0.0;
    weights
        .iter()
        .enumerate()
        .map(|(index, weight)| {
            before += weight;
            if index >= last || total <= 0.0 { 1.0 } else { (before / total) as f32 }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bright_texel_takes_its_share() {
        let mut texels = vec![Vec3::ONE; 32];
        texels[8 + 3] = Vec3::splat(100.0);
        let map = RadianceMap { width: 8, height: 4, texels };
        let record = EnvironmentRecord::new(&map);
        assert_eq!(record.texels.len(), 4 + 32);
        let share = |at: usize, component: usize, first: bool| {
            record.texels[at][component] - if first { 0.0 } else { record.texels[at - 1][component] }
        };
        let bright = share(1, 0, false) * share(4 + 8 + 3, 3, false);
        // Bilinear: (3/4)² of what the texel adds stays in it.
        let (high, low) = (row_solid_angle(1, 8, 4), row_solid_angle(0, 8, 4));
        let added = |solid_angle: f64, part: f64| 99.0 * part * solid_angle;
        let total = 4.0 * std::f64::consts::PI + added(high, 0.75) + added(high, 0.125) + added(low, 0.125);
        assert!((f64::from(bright) - (high + added(high, 0.5625)) / total).abs() < 1e-6);
        assert!((record.mean_radiance.x - (1.0 + 99.0 * (high / (4.0 * std::f64::consts::PI)) as f32)).abs() < 1e-5);
    }

    #[test]
    fn even_light_has_one_density() {
        let map = RadianceMap { width: 16, height: 8, texels: vec![Vec3::new(1.0, 2.0, 4.0); 128] };
        let record = EnvironmentRecord::new(&map);
        assert!((record.largest_ratio / (4.0 * 4.0 * std::f32::consts::PI) - 1.0).abs() < 1e-5);
    }
}
