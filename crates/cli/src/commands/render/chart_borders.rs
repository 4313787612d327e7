//! Where the charts of an energy map end.

use std::collections::HashMap;

use diacaustic::MapLayout;

/// A line on a map, texels.
type Line = [[f32; 2]; 2];

/// The sides that only one triangle has.
pub(super) fn chart_borders(layout: &MapLayout) -> Vec<Line> {
    let mut sides: HashMap<[[u32; 2]; 2], (Line, usize)> = HashMap::new();
    for corners in &layout.corners {
        for side in 0..3 {
            let line = [corners[side].to_array(), corners[(side + 1) % 3].to_array()];
            let mut ends = line.map(|end| end.map(f32::to_bits));
            ends.sort_unstable();
            sides.entry(ends).or_insert((line, 0)).1 += 1;
        }
    }
    let mut borders: Vec<Line> = sides.into_values().filter(|(_, count)| *count == 1).map(|(line, _)| line).collect();
    borders.sort_by(|a, b| a.as_flattened().partial_cmp(b.as_flattened()).unwrap_or(std::cmp::Ordering::Equal));
    borders
}

#[cfg(test)]
mod tests {
    use diacaustic::glam::Vec2;

    use super::*;

    #[test]
    fn a_square_of_two_triangles_has_four_borders() {
        let [a, b, c, d] = [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]].map(Vec2::from);
        let layout =
            MapLayout { width: 5, height: 5, layers: 1, corners: vec![[a, b, c], [a, c, d]], ..MapLayout::default() };
        let borders = chart_borders(&layout);
        assert_eq!(borders.len(), 4);
        assert!(!borders.iter().any(|[from, to]| from[0] != to[0] && from[1] != to[1]), "{borders:?}");
    }
}
