// Emitting triangles: rectangles, disks and objects that shine.

import package::layout::features::{has_holes, has_textures};
import package::layout::records::{load_emitting_triangle, load_material_textures, load_surface_texture, load_triangle};
import package::layout::scene::{Light, Triangle, NONE};
import package::texture::lookup::{sample_texture, uv_at};
import package::texture::opacity::opacity_at;

/// A point of an emitting surface.
struct SurfaceSample {
    /// Its triangle.
    triangle: Triangle,
    /// Position, metres, world frame.
    position: vec3<f32>,
    /// Unit normal of the front.
    normal: vec3<f32>,
    /// Radiance there, W/(m² sr).
    radiance: vec3<f32>,
}

/// What pictures make of a surface's radiance at a point, and the share of it that holes leave.
fn emission_factor(triangle: u32, material: u32, barycentric: vec2<f32>) -> vec3<f32> {
    let textures = load_material_textures(material);
    var factor = vec3<f32>(opacity_at(textures, triangle, barycentric));
    if textures.emission != NONE {
        factor *= sample_texture(load_surface_texture(textures.emission), uv_at(triangle, barycentric)).xyz;
    }
    return factor;
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
    let barycentric = s * vec2<f32>(1.0 - u.y, u.y);
    let position = triangle.corner + barycentric.x * triangle.edge_1 + barycentric.y * triangle.edge_2;
    var radiance = light.strength;
    if has_textures || has_holes {
        radiance *= emission_factor(entry.x, triangle.material, barycentric);
    }
    return SurfaceSample(triangle, position, normalize(cross(triangle.edge_1, triangle.edge_2)), radiance);
}
