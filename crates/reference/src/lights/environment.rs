//! The picture of what lies beyond every object.

use std::f64::consts::{PI, TAU};
use std::sync::Arc;

use diacaustic_scene::{LightKind, RadianceMap, Scene};
use glam::{DMat3, DVec3};

use crate::generator::Generator;

/// An environment, and a density of directions to draw from.
#[derive(Clone, Debug)]
pub(crate) struct Environment {
    map: Arc<RadianceMap>,
    scale: DVec3,
    world_from_map: DMat3,
    /// Running sums of the texels' shares, row by row. A share is the solid angle times the mean radiance of the texel
    /// and its eight neighbours: positive wherever the bilinear picture is.
    sums: Vec<f64>,
}

impl Environment {
    /// That of a scene, if there is one that is not dark.
    pub(crate) fn of(scene: &Scene) -> Option<Self> {
        let bright = scene.lights.iter().filter(|light| !light.kind.is_dark());
        let mut environments = bright.filter_map(|light| match &light.kind {
            LightKind::Environment { map, rotate, scale } => Some((map, rotate, scale)),
            _ => None,
        });
        let (map, rotate, scale) = environments.next()?;
        let mut environment = Self {
            map: Arc::clone(map),
            scale: scale.as_dvec3(),
            world_from_map: DMat3::from_rotation_y(f64::from(*rotate).to_radians()),
            sums: Vec::new(),
        };
        environment.sums = environment.running_sums();
        Some(environment)
    }

    fn running_sums(&self) -> Vec<f64> {
        let (width, height) = (i64::from(self.map.width), i64::from(self.map.height));
        let mut sum = 0.0;
        (0..width * height)
            .map(|texel| {
                let (column, row) = (texel % width, texel / width);
                let near = (0..9).map(|k| (self.texel(column + k % 3 - 1, row + k / 3 - 1) * self.scale).element_sum());
                sum += near.sum::<f64>() * self.solid_angle(row);
                sum
            })
            .collect()
    }

    /// The radiance of a texel before scaling; columns wrap around, rows end.
    fn texel(&self, column: i64, row: i64) -> DVec3 {
        let (width, height) = (i64::from(self.map.width), i64::from(self.map.height));
        let index = row.clamp(0, height - 1) * width + column.rem_euclid(width);
        self.map.texels[index as usize].as_dvec3()
    }

    /// Solid angle of a texel, sr.
    fn solid_angle(&self, row: i64) -> f64 {
        let cos = |row: i64| (PI * row as f64 / f64::from(self.map.height)).cos();
        TAU / f64::from(self.map.width) * (cos(row) - cos(row + 1))
    }

    /// Radiance in a direction, W/(m² sr): bilinear between the texels' middles.
    pub(crate) fn radiance(&self, direction: DVec3) -> DVec3 {
        let d = self.world_from_map.transpose() * direction;
        let (u, v) = (0.5 + d.x.atan2(-d.z) / TAU, d.y.clamp(-1.0, 1.0).acos() / PI);
        let (x, y) = (u * f64::from(self.map.width) - 0.5, v * f64::from(self.map.height) - 0.5);
        let (column, row) = (x.floor(), y.floor());
        let (f, g) = (x - column, y - row);
        let at = |i: i64, j: i64| self.texel(column as i64 + i, row as i64 + j);
        let upper = (1.0 - f) * at(0, 0) + f * at(1, 0);
        let lower = (1.0 - f) * at(0, 1) + f * at(1, 1);
        self.scale * ((1.0 - g) * upper + g * lower)
    }

    /// A direction in which to look, and its density, 1/sr.
    pub(crate) fn sample(&self, generator: &mut Generator) -> (DVec3, f64) {
        let total = self.sums.last().copied().unwrap_or(0.0);
        let target = generator.unit() * total;
        let texel = self.sums.partition_point(|sum| *sum <= target).min(self.sums.len() - 1);
        let before = if texel == 0 { 0.0 } else { self.sums[texel - 1] };
        let (column, row) = (texel % self.map.width as usize, texel / self.map.width as usize);
        let phi = TAU * ((column as f64 + generator.unit()) / f64::from(self.map.width) - 0.5);
        let cos = |row: usize| (PI * row as f64 / f64::from(self.map.height)).cos();
        let (upper, lower) = (cos(row), cos(row + 1));
        let y = upper + generator.unit() * (lower - upper);
        let sin = (1.0 - y * y).max(0.0).sqrt();
        let direction = DVec3::new(sin * phi.sin(), y, -sin * phi.cos());
        let density = (self.sums[texel] - before) / (total * self.solid_angle(row as i64));
        (self.world_from_map * direction, density)
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;

    fn environment(width: u32, texels: Vec<f32>, rotate: f64) -> Environment {
        let height = texels.len() as u32 / width;
        let map = RadianceMap { width, height, texels: texels.into_iter().map(Vec3::splat).collect() };
        let mut environment = Environment {
            map: Arc::new(map),
            scale: DVec3::splat(2.0),
            world_from_map: DMat3::from_rotation_y(rotate.to_radians()),
            sums: Vec::new(),
        };
        environment.sums = environment.running_sums();
        environment
    }

    #[test]
    fn columns_go_around_the_horizon() {
        // Middles of the columns: between +z and −x, −x and −z, −z and +x, +x and +z.
        let columns = environment(4, vec![1.0, 2.0, 3.0, 4.0], 0.0);
        let seen = |x: f64, z: f64| columns.radiance(DVec3::new(x, 0.0, z).normalize()).x;
        assert!((seen(-1.0, 1.0) - 2.0).abs() < 1e-12 && (seen(-1.0, -1.0) - 4.0).abs() < 1e-12);
        assert!((seen(1.0, -1.0) - 6.0).abs() < 1e-12 && (seen(1.0, 1.0) - 8.0).abs() < 1e-12);
        assert!((seen(0.0, -1.0) - 5.0).abs() < 1e-12 && (seen(0.0, 1.0) - 5.0).abs() < 1e-12);
    }

    #[test]
    fn turning_moves_features_counter_clockwise_from_above() {
        // From −z by a quarter turn about +y to −x.
        let turned = environment(4, vec![0.0, 1.0, 1.0, 0.0], 90.0);
        assert!((turned.radiance(-DVec3::X).x - 2.0).abs() < 1e-12);
        assert!(turned.radiance(DVec3::X).x.abs() < 1e-12);
    }

    #[test]
    fn directions_follow_their_density() {
        let spotted = environment(8, (0..32).map(|i| if i == 13 { 50.0 } else { 0.0 }).collect(), 33.0);
        let mut generator = Generator::new(&[5]);
        let count = 200_000;
        let (mut estimate, mut solid_angle) = (0.0, 0.0);
        for _ in 0..count {
            let (direction, density) = spotted.sample(&mut generator);
            estimate += spotted.radiance(direction).x / density / f64::from(count);
            solid_angle += 1.0 / density / f64::from(count);
        }
        let steps = 800;
        let at = |i: i32| (f64::from(i) + 0.5) / f64::from(steps);
        let mut integral = 0.0;
        for (i, j) in (0..steps).flat_map(|i| (0..steps).map(move |j| (i, j))) {
            let ((sin_phi, cos_phi), y) = ((TAU * at(i)).sin_cos(), 2.0 * at(j) - 1.0);
            let sin = (1.0 - y * y).sqrt();
            integral += spotted.radiance(DVec3::new(sin * sin_phi, y, sin * cos_phi)).x;
        }
        integral *= 2.0 * TAU / f64::from(steps * steps);
        assert!((estimate / integral - 1.0).abs() < 0.01, "{estimate} for {integral}");
        // Nine texels of rows 0 to 2, three wide.
        let covered = 3.0 * (0..3).map(|row| spotted.solid_angle(row)).sum::<f64>();
        assert!((solid_angle / covered - 1.0).abs() < 0.01, "{solid_angle} for {covered}");
    }
}
