//! Guides: how emission numbers are moved to where photons matter; docs/photon-paths.md, "Guide".

use diacaustic_shaders::light_kind;

use crate::{aim::Emission, lights::Emitter};

/// Parts into which a table's bounds divide [0, 1): as fine as emission numbers are.
const QUANTA: f64 = 16_777_216.0;

/// The least number of a pilot's photons for each cell of its guide.
const PHOTONS_IN_CELL: u32 = 2;

/// A light's guide: one table for its emission numbers u₀ and u₁, and one for u₂ and u₃.
#[derive(Clone, Debug, PartialEq)]
pub struct Guide {
    /// Moves u₀ and u₁: where the light aims.
    pub aim: GuideTable,
    /// Moves u₂ and u₃: where on the light a photon starts, or from which part of the sky.
    pub place: GuideTable,
}

/// A piecewise constant density over the unit square, in cells of equal size, and the map of the square to itself that yields it: first
/// along x by the columns' marginal distribution, then along y by the distribution within the column.
#[derive(Clone, Debug, PartialEq)]
pub struct GuideTable {
    /// Cells along x.
    pub columns: usize,
    /// Cells along y.
    pub rows: usize,
    /// Bounds 0 = b₀ < b₁ < … < 1: column k takes what lies in [b_k, b_(k+1)). Multiples of 2⁻²⁴.
    pub column_bounds: Vec<f32>,
    /// For each column, `rows` + 1 bounds of the same kind.
    pub row_bounds: Vec<f32>,
}

impl Guide {
    /// The guide that moves nothing, with the cells in which a pilot of so many photons of this light counts.
    pub(crate) fn even(emitter: &Emitter, emission: &Emission, pilot: u32) -> Self {
        // Each target has a part of the columns of its own.
        let (targets, side) = match emission.targets().len() {
            0 => (1, 1),
            targets => (targets, cells_along_target(targets, pilot)),
        };
        // Where a photon starts on a light that aims, or in a sun's disc, says little of where it goes.
        let place_side = match emitter.kind() {
            light_kind::SURFACE | light_kind::ENVIRONMENT => 16,
            _ => 1,
        };
        Self { aim: GuideTable::even(targets * side, side), place: GuideTable::even(place_side, place_side) }
    }

    /// The least density of any photon; 1 on average.
    pub fn least_density(&self) -> f64 {
        self.aim.least_density() * self.place.least_density()
    }

    /// The entries of both tables as the kernel reads them.
    pub(crate) fn records(&self) -> Vec<[u32; 4]> {
        self.aim.records().into_iter().chain(self.place.records()).collect()
    }
}

/// Cells along a side of each target's square: as many, as a power of two, as leave at least [`PHOTONS_IN_CELL`] of the pilot's photons to a cell.
fn cells_along_target(targets: usize, pilot: u32) -> usize {
    let cells = (pilot / PHOTONS_IN_CELL) as usize / targets;
    1 << (cells.max(1).ilog2() / 2)
}

impl GuideTable {
    /// The table that moves nothing.
    pub(crate) fn even(columns: usize, rows: usize) -> Self {
        Self::from_weights(columns, rows, &vec![1.0; columns * rows])
    }

    /// The table whose density is in proportion to the weights of the cells, column by column, all greater than 0.
    pub(crate) fn from_weights(columns: usize, rows: usize, weights: &[f64]) -> Self {
        let of_columns: Vec<f64> = weights.chunks_exact(rows).map(|column| column.iter().sum()).collect();
        Self {
            columns,
            rows,
            column_bounds: bounds(&of_columns),
            row_bounds: weights.chunks_exact(rows).flat_map(bounds).collect(),
        }
    }

    /// Density in a cell, column by column; 1 on average.
    ///
    /// # Panics
    /// If there is no such cell.
    pub fn density(&self, cell: usize) -> f64 {
        let (column, row) = (cell / self.rows, cell % self.rows);
        let first = column * (self.rows + 1) + row;
        let width = |bounds: &[f32], at: usize| f64::from(bounds[at + 1]) - f64::from(bounds[at]);
        width(&self.column_bounds, column) * width(&self.row_bounds, first) * (self.columns * self.rows) as f64
    }

    /// The number of cells.
    pub fn cells(&self) -> usize {
        self.columns * self.rows
    }

    fn least_density(&self) -> f64 {
        (0..self.cells()).map(|cell| self.density(cell)).fold(f64::INFINITY, f64::min)
    }

    /// The entries of the columns, then of the rows of every column.
    fn records(&self) -> Vec<[u32; 4]> {
        let rows = self.row_bounds.chunks_exact(self.rows + 1).flat_map(entries);
        entries(&self.column_bounds).into_iter().chain(rows).collect()
    }
}

/// For each of n intervals its bounds, as bits, and for interval k the one that k/n lies in, where the search for numbers from there on begins.
fn entries(bounds: &[f32]) -> Vec<[u32; 4]> {
    let count = bounds.len() - 1;
    let mut begin = 0;
    let entry = |k: usize| {
        // A little less than k, for the kernel rounds when it finds the k of a number.
        while f64::from(bounds[begin + 1]) * count as f64 <= k as f64 - 0.001 {
            begin += 1;
        }
        [bounds[k].to_bits(), bounds[k + 1].to_bits(), begin as u32, 0]
    };
    (0..count).map(entry).collect()
}

/// Bounds of intervals in proportion to weights, of one quantum at least.
fn bounds(weights: &[f64]) -> Vec<f32> {
    let total: f64 = weights.iter().sum();
    let last = weights.len();
    let (mut sum, mut before) = (0.0, 0.0f64);
    let mut list = vec![0.0];
    for (index, weight) in weights.iter().enumerate() {
        sum += weight;
        // Each interval after this one needs a quantum too.
        let room = QUANTA - (last - 1 - index) as f64;
        before = (sum / total * QUANTA).round().max(before + 1.0).min(room);
        list.push((before / QUANTA) as f32);
    }
    // Rounding must not leave a gap at the end.
    list[last] = 1.0;
    list
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bounds_rise_from_0_to_1_whatever_the_weights() {
        for weights in [vec![1.0; 3], vec![1e-30, 1.0, 1e-30, 1e-30], vec![1.0, 1e-30], vec![5.0]] {
            let bounds = bounds(&weights);
            assert_eq!((bounds[0], bounds[weights.len()]), (0.0, 1.0), "{weights:?}");
            assert!(bounds.windows(2).all(|pair| pair[0] < pair[1]), "{weights:?}: {bounds:?}");
            assert!(bounds.iter().all(|&bound| f64::from(bound) * QUANTA % 1.0 == 0.0));
        }
    }

    #[test]
    fn densities_follow_the_weights_and_average_to_1() {
        let weights = [1.0, 2.0, 3.0, 4.0, 0.5, 1.5];
        let table = GuideTable::from_weights(2, 3, &weights);
        for (cell, weight) in weights.iter().enumerate() {
            assert!((table.density(cell) - weight * 6.0 / 12.0).abs() < 1e-6);
        }
        assert!((0..6).map(|cell| table.density(cell)).sum::<f64>() / 6.0 - 1.0 < 1e-12);
        assert!((table.least_density() - 0.25).abs() < 1e-6);
        assert_eq!(table.records().len(), 2 + 6);
        // Bounds 0, ½, 1 and, of the first column, 0, 1/6, ½, 1: ½ begins the second column, but for rounding; a third lies in the second
        // row, two thirds in the third.
        let begin: Vec<u32> = table.records().iter().map(|entry| entry[2]).collect();
        assert_eq!(begin[..5], [0, 0, 0, 1, 2]);
    }

    #[test]
    fn cells_are_as_fine_as_the_pilot_fills() {
        let sides =
            [(1, 1 << 15), (2, 1 << 15), (4, 1 << 15), (5, 1 << 15), (16, 1 << 15), (1, 1 << 11), (16, 1 << 11)];
        assert_eq!(sides.map(|(targets, pilot)| cells_along_target(targets, pilot)), [128, 64, 64, 32, 32, 32, 8]);
    }

    #[test]
    fn an_even_table_moves_nothing() {
        let table = GuideTable::even(64, 32);
        assert_eq!(table.least_density(), 1.0);
        assert_eq!(table.column_bounds[17], 17.0 / 64.0);
    }
}
