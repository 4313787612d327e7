// Emitting triangles: rectangles, disks and objects that shine.

import package::layout::records::{load_emitting_triangle, load_triangle};
import package::layout::scene::{Light, Triangle};

/// A point of an emitting surface.
struct SurfaceSample {
    /// Its triangle.
    triangle: Triangle,
    /// Position, metres, world frame.
    position: vec3<f32>,
    /// Unit normal of the front.
    normal: vec3<f32>,
}

/// A point of a light's surface, evenly by area.
fn sample_surface(light: Light, u: vec2<f32>) -> SurfaceSample {
    // The first entry whose cumulative share exceeds u.x.
    var low = 0u;
    var high = light.count - 1u;
    while low < high {
        let middle = (low + high) >> 1u;
        let share = bitcast<f32>(load_emitting_triangle(light.first + middle).y);
        low = select(low, middle + 1u, u.x >= share);
        high = select(middle, high, u.x >= share);
    }
    let entry = load_emitting_triangle(light.first + low);
    let before = select(0.0, bitcast<f32>(load_emitting_triangle(light.first + max(low, 1u) - 1u).y), low > 0u);
    let share = bitcast<f32>(entry.y) - before;
    let s = sqrt(clamp((u.x - before) / max(share, 1e-12), 0.0, 1.0));
    let triangle = load_triangle(entry.x);
    let position = triangle.corner + (s * (1.0 - u.y)) * triangle.edge_1 + (s * u.y) * triangle.edge_2;
    return SurfaceSample(triangle, position, normalize(cross(triangle.edge_1, triangle.edge_2)));
}
