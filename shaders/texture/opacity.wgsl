// Holes in surfaces; docs/materials.md, "Textures".

import package::layout::features::has_vertex_colors;
import package::layout::records::{load_material_textures, load_surface_texture, load_vertex_colors};
import package::layout::scene::{MaterialTextures, NONE};
import package::sampling::hash::{combine, unit};
import package::texture::lookup::{channel_of, sample_texture, uv_at};

/// The factor that a triangle's vertices make at a point of it.
fn vertex_opacity(triangle: u32, barycentric: vec2<f32>) -> f32 {
    let c = load_vertex_colors(triangle);
    let corners = vec3<f32>(unpack2x16float(c.color_0.y).y, unpack2x16float(c.color_1.y).y, unpack2x16float(c.color_2.y).y);
    return dot(corners, vec3<f32>(1.0 - barycentric.x - barycentric.y, barycentric));
}

/// Share of the light that meets a surface at a point of a triangle.
fn opacity_at(textures: MaterialTextures, triangle: u32, barycentric: vec2<f32>) -> f32 {
    var opacity = textures.opacity_factor;
    if textures.opacity != NONE {
        let texture = load_surface_texture(textures.opacity);
        opacity *= channel_of(texture, sample_texture(texture, uv_at(triangle, barycentric)));
    }
    if has_vertex_colors {
        opacity *= vertex_opacity(triangle, barycentric);
    }
    let cut = select(0.0, 1.0, opacity >= textures.opacity_cutoff);
    return select(opacity, cut, textures.opacity_cutoff >= 0.0);
}

/// A number that belongs to a ray.
fn ray_seed(origin: vec3<f32>, direction: vec3<f32>) -> u32 {
    let o = bitcast<vec3<u32>>(origin);
    let d = bitcast<vec3<u32>>(direction);
    return combine(combine(combine(o.x, o.y), combine(o.z, d.x)), combine(d.y, d.z));
}

/// Whether a ray passes a triangle as if it were not there: decided by chance, anew for every ray and triangle.
fn passes(seed: u32, triangle: u32, material: u32, barycentric: vec2<f32>) -> bool {
    let opacity = opacity_at(load_material_textures(material), triangle, barycentric);
    return unit(combine(seed, triangle)) >= opacity;
}
