//! How emission numbers are moved to where photons matter.

/// A light's guide, as a renderer publishes it.
#[derive(Clone, Debug, PartialEq)]
pub struct Guide {
    /// Moves the first two emission numbers.
    pub aim: GuideTable,
    /// Moves the next two.
    pub place: GuideTable,
}

/// The cells of the unit square, and which part of it moves into each.
#[derive(Clone, Debug, PartialEq)]
pub struct GuideTable {
    /// The ends of the intervals that move into the columns, from 0 to 1.
    pub columns: Vec<f64>,
    /// For each column, the ends of the intervals that move into its cells.
    pub rows: Vec<Vec<f64>>,
}

impl Guide {
    /// The four numbers after the move, and the density of the last two.
    pub(super) fn move_numbers(&self, [u0, u1, u2, u3]: [f64; 4]) -> ([f64; 4], f64) {
        let ([x, y], _) = self.aim.move_point([u0, u1]);
        let ([z, w], place) = self.place.move_point([u2, u3]);
        ([x, y, z, w], place)
    }
}

impl GuideTable {
    /// The density at a point after the move.
    pub(super) fn density_at(&self, [x, y]: [f64; 2]) -> f64 {
        let share = |ends: &[f64], u: f64| {
            let cells = ends.len() - 1;
            let cell = ((u * cells as f64) as usize).min(cells - 1);
            (cell, (ends[cell + 1] - ends[cell]) * cells as f64)
        };
        let (column, across) = share(&self.columns, x);
        across * share(&self.rows[column], y).1
    }

    fn move_point(&self, [x, y]: [f64; 2]) -> ([f64; 2], f64) {
        let column = cell_of(&self.columns, x);
        let (x, across) = stretch(&self.columns, column, x);
        let rows = &self.rows[column];
        let (y, along) = stretch(rows, cell_of(rows, y), y);
        ([x, y], across * along)
    }
}

/// The interval that a number in [0, 1) falls in.
fn cell_of(ends: &[f64], u: f64) -> usize {
    ends.iter().skip(1).take(ends.len() - 2).filter(|end| **end <= u).count()
}

/// A number of an interval, moved into the cell of that index, and the density there.
fn stretch(ends: &[f64], cell: usize, u: f64) -> (f64, f64) {
    let cells = (ends.len() - 1) as f64;
    let part = ends[cell + 1] - ends[cell];
    ((cell as f64 + (u - ends[cell]) / part) / cells, part * cells)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_draws_with_its_density() {
        let table = GuideTable { columns: vec![0.0, 0.25, 1.0], rows: vec![vec![0.0, 0.9, 1.0], vec![0.0, 0.5, 1.0]] };
        let (point, density) = table.move_point([0.125, 0.45]);
        assert_eq!(point, [0.25, 0.25]);
        assert!((density - 0.25 * 0.9 * 4.0).abs() < 1e-15);
        assert_eq!(table.density_at(point), density);
        assert!((table.density_at([0.7, 0.6]) - 0.75 * 0.5 * 4.0).abs() < 1e-15);
        let steps = 200;
        let grid = (0..steps * steps).map(|k| [k / steps, k % steps].map(|i| (f64::from(i) + 0.5) / f64::from(steps)));
        // The mean of 1/density over what is drawn is the area, and of x/density the mean of x.
        let (area, mean) = grid.fold((0.0, 0.0), |(area, mean), u| {
            let ([x, _], density) = table.move_point(u);
            (area + 1.0 / density, mean + x / density)
        });
        let count = f64::from(steps * steps);
        assert!((area / count - 1.0).abs() < 1e-12 && (mean / count - 0.5).abs() < 1e-12);
    }
}
