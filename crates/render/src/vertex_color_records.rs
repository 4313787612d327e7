//! Colours and opacities at vertices as the device knows them; docs/materials.md, "Vertex colours".

use diacaustic_scene::Scene;
use diacaustic_shaders::VertexColors;
use diacaustic_surface::WorldTriangle;
use glam::{Vec3, Vec4};
use half::f16;

/// Whether each of the scene's materials is on a mesh with vertex colours.
pub(crate) fn colored_materials(scene: &Scene) -> Vec<bool> {
    let mut colored = vec![false; scene.materials.len()];
    for object in scene.objects.iter().filter(|object| !object.mesh.colors.is_empty()) {
        object.materials.iter().for_each(|material| colored[*material] = true);
    }
    colored
}

/// For each triangle of the hierarchy; of a scene without factors at vertices a single one, for a texture cannot be empty.
pub(crate) fn vertex_colors(scene: &Scene, triangles: &[WorldTriangle]) -> Vec<VertexColors> {
    if !scene.has_vertex_factors() {
        return vec![VertexColors::default()];
    }
    triangles.iter().map(|triangle| of_triangle(scene, triangle)).collect()
}

fn of_triangle(scene: &Scene, triangle: &WorldTriangle) -> VertexColors {
    // The surfaces of lights are objects beyond the scene's.
    let mesh = scene.objects.get(triangle.object as usize).map(|object| &object.mesh);
    let factors = mesh.map_or([Vec4::ONE; 3], |mesh| {
        let factor = |vertex: u32| {
            let color = mesh.colors.get(vertex as usize).copied().unwrap_or(Vec3::ONE);
            color.extend(mesh.opacities.get(vertex as usize).copied().unwrap_or(1.0))
        };
        triangle.arrange(mesh.triangles[triangle.triangle as usize].map(factor))
    });
    let [color_0, color_1, color_2] = factors.map(packed);
    VertexColors { color_0, color_1, color_2, padding: [0; 2] }
}

/// Red and green, then blue and opacity, in half precision.
fn packed(factor: Vec4) -> [u32; 2] {
    let [r, g, b, opacity] = factor.to_array().map(|channel| u32::from(f16::from_f32(channel).to_bits()));
    [r | g << 16, b | opacity << 16]
}
