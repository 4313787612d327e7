//! Polygons cut into triangles.

use earcut::Earcut;
use glam::{Vec2, Vec3};

/// Cuts polygons; holds memory that it uses again.
#[derive(Default)]
pub(crate) struct PolygonCutter {
    earcut: Earcut<f32>,
    plane: Vec<[f32; 2]>,
    cut: Vec<u32>,
}

impl PolygonCutter {
    /// The triangles of a polygon of three corners or more, as indices of its corners, wound as it is. Convex ones are fans about the
    /// first corner; every corner is in a triangle.
    pub(crate) fn cut(&mut self, corners: &[Vec3]) -> Vec<[u32; 3]> {
        let count = corners.len() as u32;
        let fan = || (2..count).map(|last| [0, last - 1, last]).collect();
        let normal = doubled_area(corners);
        // Coordinates near the end of single precision have no area that it could tell.
        if count == 3 || normal == Vec3::ZERO || !normal.is_finite() || is_convex(corners, normal) {
            return fan();
        }
        let (u, v) = normal.normalize_or(Vec3::Z).any_orthonormal_pair();
        self.plane.clear();
        self.plane.extend(corners.iter().map(|corner| [(*corner - corners[0]).dot(u), (*corner - corners[0]).dot(v)]));
        self.earcut.earcut_slice(&self.plane, &[], &mut self.cut);
        let mut triangles: Vec<[u32; 3]> = self.cut.as_chunks().0.to_vec();
        if triangles.is_empty() {
            return fan();
        }
        for triangle in &mut triangles {
            let [a, b, c] = triangle.map(|corner| Vec2::from(self.plane[corner as usize]));
            if (b - a).perp_dot(c - a) < 0.0 {
                triangle.swap(1, 2);
            }
        }
        insert_left_out(&mut triangles, count);
        triangles
    }
}

/// Twice the area of a polygon times its unit normal (Newell).
fn doubled_area(corners: &[Vec3]) -> Vec3 {
    let from_first = |corner: &Vec3| *corner - corners[0];
    corners.windows(2).map(|pair| from_first(&pair[0]).cross(from_first(&pair[1]))).sum()
}

/// Whether a polygon turns one way at every corner, and once around.
fn is_convex(corners: &[Vec3], normal: Vec3) -> bool {
    let count = corners.len();
    let edge = |k: usize| corners[(k + 1) % count] - corners[k % count];
    let turns_left = (0..count).all(|k| edge(k).cross(edge(k + 1)).dot(normal) >= 0.0);
    // One that goes around several times turns left everywhere too; its fan turns over somewhere.
    let is_fan = |k: usize| (corners[k] - corners[0]).cross(corners[k + 1] - corners[0]).dot(normal) >= 0.0;
    turns_left && (1..count - 1).all(is_fan)
}

/// Puts corners that lie on a line between others, and have no triangle, into the edge that passes them: the neighbour's triangles have
/// them too, and the surface stays closed.
fn insert_left_out(triangles: &mut Vec<[u32; 3]>, count: u32) {
    let mut has_triangle = vec![false; count as usize];
    triangles.as_flattened().iter().for_each(|corner| has_triangle[*corner as usize] = true);
    let Some(start) = has_triangle.iter().position(|has| *has) else { return };
    let mut before = start as u32;
    let mut run = Vec::new();
    for step in 1..=count {
        let corner = (start as u32 + step) % count;
        if !has_triangle[corner as usize] {
            run.push(corner);
            continue;
        }
        if !run.is_empty() {
            insert_run(triangles, before, &std::mem::take(&mut run), corner);
        }
        before = corner;
    }
}

/// Divides the triangle at the edge from `before` to `after` by the corners between them.
fn insert_run(triangles: &mut Vec<[u32; 3]>, before: u32, run: &[u32], after: u32) {
    let has_edge = |triangle: &[u32; 3]| (0..3).find(|k| triangle[*k] == before && triangle[(k + 1) % 3] == after);
    let found = triangles.iter().enumerate().find_map(|(index, triangle)| Some((index, has_edge(triangle)?)));
    let apex = found.map_or(after, |(index, k)| {
        let triangle = triangles.swap_remove(index);
        triangle[(k + 2) % 3]
    });
    let line: Vec<_> = [&[before], run, &[after]].concat();
    triangles.extend(line.windows(2).map(|pair| [pair[0], pair[1], apex]).filter(|[_, b, c]| b != c));
}

#[cfg(test)]
mod tests {
    use super::*;

    fn area(corners: &[Vec3], triangles: &[[u32; 3]]) -> Vec3 {
        let at = |corner: u32| corners[corner as usize];
        triangles.iter().map(|[a, b, c]| (at(*b) - at(*a)).cross(at(*c) - at(*a))).sum()
    }

    fn polygon(points: &[[f32; 2]]) -> Vec<Vec3> {
        points.iter().map(|[x, y]| Vec3::new(*x, 0.5 * y, -*y)).collect()
    }

    #[test]
    fn concave_polygons_are_covered_once() {
        let arrow = polygon(&[[0.0, 0.0], [2.0, 2.0], [0.0, 1.0], [-2.0, 2.0]]);
        let comb = polygon(&[
            [0.0, 0.0],
            [7.0, 0.0],
            [7.0, 3.0],
            [6.0, 3.0],
            [6.0, 1.0],
            [4.0, 1.0],
            [4.0, 3.0],
            [3.0, 3.0],
            [3.0, 1.0],
            [1.0, 1.0],
            [1.0, 3.0],
            [0.0, 3.0],
        ]);
        let mut cutter = PolygonCutter::default();
        for corners in [arrow, comb] {
            for turned in 0..corners.len() {
                let mut corners = corners.clone();
                corners.rotate_left(turned);
                let triangles = cutter.cut(&corners);
                assert_eq!(triangles.len(), corners.len() - 2);
                let whole = doubled_area(&corners);
                assert!(area(&corners, &triangles).distance(whole) < 1e-4);
                // None is turned over: the parts' areas add up.
                let parts: f32 = triangles.iter().map(|triangle| area(&corners, &[*triangle]).length()).sum();
                assert!((parts - whole.length()).abs() < 1e-4, "turned {turned}: {parts}, whole {whole}");
            }
        }
    }

    #[test]
    fn corners_on_a_line_are_kept() {
        let points = [
            [0.0, 0.0],
            [1.0, 0.0],
            [2.0, 0.0],
            [4.0, 0.0],
            [4.0, 2.0],
            [3.0, 1.0],
            [2.0, 1.0],
            [1.0, 1.0],
            [0.0, 2.0],
        ];
        let mut cutter = PolygonCutter::default();
        for turned in 0..points.len() {
            let mut corners = polygon(&points);
            corners.rotate_left(turned);
            let triangles = cutter.cut(&corners);
            let used: std::collections::HashSet<_> = triangles.as_flattened().iter().collect();
            assert_eq!((used.len(), triangles.len()), (points.len(), points.len() - 2), "turned {turned}");
            assert!(area(&corners, &triangles).distance(doubled_area(&corners)) < 1e-4);
        }
    }

    #[test]
    fn convex_polygons_are_fans_and_degenerate_ones_do_no_harm() {
        let mut cutter = PolygonCutter::default();
        let square = polygon(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]);
        assert_eq!(cutter.cut(&square), [[0, 1, 2], [0, 2, 3]]);
        let huge = vec![[0.0, 0.0], [3e38, 3e38], [0.0, 1e38], [-3e38, 3e38]];
        for points in [vec![[0.0, 0.0]; 5], vec![[0.0, 0.0], [1.0, 1.0], [2.0, 2.0], [0.5, 0.5]], huge] {
            assert!(!cutter.cut(&polygon(&points)).is_empty());
        }
        let star = [[0.0, 1.0], [-0.6, -0.8], [0.95, 0.3], [-0.95, 0.3], [0.6, -0.8]];
        assert!(!cutter.cut(&polygon(&star)).is_empty());
    }
}
