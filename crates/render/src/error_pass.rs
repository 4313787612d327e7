//! How exact the picture is: an estimate for each tile, from two halves of its samples.

use diacaustic_shaders::{ERRORS, ErrorParams, TILE_SIZE, TileError};

use crate::{
    Error,
    gpu::{Binding, Gpu, Purpose},
};

/// The bindings of `shaders/layout/error_pass.wgsl`.
const BINDINGS: [Binding; 4] = [Binding::Uniform, Binding::Read, Binding::Read, Binding::ReadWrite];
const TILES: Purpose = Purpose { what: "the errors of the picture's tiles", remedy: "lower width or height" };

/// The pipeline that estimates errors.
#[derive(Debug)]
pub(crate) struct ErrorPass {
    layout: wgpu::BindGroupLayout,
    pipeline: wgpu::ComputePipeline,
    params: wgpu::Buffer,
}

/// The errors of a picture's tiles.
#[derive(Clone, Debug)]
pub(crate) struct TileErrors {
    /// Tiles along x.
    pub columns: usize,
    /// Row by row from the top left.
    pub tiles: Vec<TileError>,
}

impl ErrorPass {
    pub fn new(gpu: &Gpu) -> Self {
        let layout = gpu.layout("errors", wgpu::ShaderStages::COMPUTE, &BINDINGS);
        let pipeline = gpu.compute_pipeline(ERRORS, &[&layout]);
        Self { layout, pipeline, params: gpu.uniform::<ErrorParams>("errors") }
    }

    /// Estimates the errors of a film of `size` pixels. Blocks.
    pub fn run(
        &self,
        gpu: &Gpu,
        film: &wgpu::Buffer,
        halves: &wgpu::Buffer,
        size: [u32; 2],
    ) -> Result<TileErrors, Error> {
        let [columns, rows] = size.map(|pixels| pixels.div_ceil(TILE_SIZE));
        let count = u64::from(columns) * u64::from(rows);
        let output = gpu.zeroed(TILES, count * size_of::<TileError>() as u64)?;
        let group = gpu.bind(&self.layout, &[&self.params, film, halves, &output]);
        let mut errors = TileErrors { columns: columns as usize, tiles: Vec::new() };
        // The first time for the mean radiance, the second for errors relative to it.
        for _ in 0..2 {
            let mean_radiance = errors.mean(|tile| tile.radiance) as f32;
            let params = ErrorParams { width: size[0], height: size[1], mean_radiance, padding: 0 };
            gpu.queue.write_buffer(&self.params, 0, bytemuck::bytes_of(&params));
            gpu.dispatch(&self.pipeline, &[&group], [columns, rows]);
            errors.tiles = gpu.read(&output, 0..count)?;
        }
        Ok(errors)
    }
}

impl TileErrors {
    /// The mean of a value over all pixels; 0 without any.
    pub fn mean(&self, value: impl Fn(&TileError) -> f32) -> f64 {
        let weighted = |tile: &TileError| f64::from(value(tile)) * f64::from(tile.pixels);
        let pixels: f64 = self.tiles.iter().map(|tile| f64::from(tile.pixels)).sum();
        self.tiles.iter().map(weighted).sum::<f64>() / pixels.max(1.0)
    }

    /// Each tile's squared error as its neighbourhood tells it: the larger of its own and the mean over 3 × 3 tiles, for few samples may
    /// have missed what their neighbours found.
    pub fn guarded(&self) -> Vec<f32> {
        let rows = self.tiles.len() / self.columns.max(1);
        let error = |row: usize, column: usize| self.tiles[row * self.columns + column].squared_error;
        let near = |at: usize, count: usize| at.saturating_sub(1)..(at + 2).min(count);
        let guarded = |index: usize| {
            let (row, column) = (index / self.columns, index % self.columns);
            let around = near(row, rows).flat_map(|row| near(column, self.columns).map(move |column| (row, column)));
            let (sum, count) =
                around.fold((0.0, 0.0), |(sum, count), (row, column)| (sum + error(row, column), count + 1.0));
            f32::max(sum / count, error(row, column))
        };
        (0..self.tiles.len()).map(guarded).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_neighbours_error_guards_a_tile() {
        let tile = |squared_error: f32| TileError { squared_error, radiance: 1.0, samples: 4, pixels: 64, rays: 512 };
        let mut tiles = vec![tile(0.0); 12];
        tiles[5] = tile(0.9);
        let errors = TileErrors { columns: 4, tiles };
        let guarded = errors.guarded();
        assert_eq!((guarded[5], guarded[11]), (0.9, 0.0));
        assert!((guarded[0] - 0.9 / 4.0).abs() < 1e-6 && (guarded[6] - 0.1).abs() < 1e-6, "{guarded:?}");
        assert!((errors.mean(|tile| tile.squared_error) - 0.9 / 12.0).abs() < 1e-6);
    }
}
