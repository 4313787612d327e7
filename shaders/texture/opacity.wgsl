// Holes in surfaces; docs/materials.md, "Textures".

import package::layout::records::{load_material_textures, load_surface_texture};
import package::layout::scene::{MaterialTextures, NONE};
import package::sampling::hash::{combine, unit};
import package::texture::lookup::{channel_of, sample_texture, uv_at};

/// Share of the light that meets a surface at texture coordinates.
fn opacity_at(textures: MaterialTextures, uv: vec2<f32>) -> f32 {
    var opacity = textures.opacity_factor;
    if textures.opacity != NONE {
        let texture = load_surface_texture(textures.opacity);
        opacity *= channel_of(texture, sample_texture(texture, uv));
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
    let opacity = opacity_at(load_material_textures(material), uv_at(triangle, barycentric));
    return unit(combine(seed, triangle)) >= opacity;
}
