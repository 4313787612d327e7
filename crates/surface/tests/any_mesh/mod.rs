//! Arbitrary meshes.

use diacaustic_scene::Mesh;
use glam::Vec3;
use proptest::prelude::*;

prop_compose! {
    /// Any mesh at all: triangles over few points, some of which coincide, lie on a line or are far away.
    pub fn any_mesh()(
        points in prop::collection::vec(prop::array::uniform3(-4i8..4), 3..12),
        free in prop::collection::vec(prop::array::uniform3(-1.0f32..1.0), 0..12),
        scale in prop::sample::select(vec![1e-6f32, 1.0, 1e6]),
        picks in prop::collection::vec(prop::array::uniform3(0usize..100), 1..60),
    ) -> Mesh {
        let mut positions: Vec<Vec3> = points.iter().map(|p| scale * Vec3::from(p.map(f32::from))).collect();
        positions.extend(free.iter().map(|p| scale * Vec3::from(*p)));
        let count = positions.len();
        let triangles = picks.iter().map(|triangle| triangle.map(|v| (v % count) as u32)).collect();
        Mesh { positions, triangles, ..Mesh::default() }
    }
}
