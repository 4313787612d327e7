// Surfaces of two materials; docs/materials.md, "Blends".

import package::geometry::traverse::Hit;
import package::layout::features::has_blends;
import package::layout::records::{load_material_textures, load_surface_texture};
import package::layout::scene::{Triangle, NONE, TRIANGLE_BLENDED};
import package::sampling::hash::{combine, unit};
import package::texture::lookup::{channel_of, sample_texture, uv_at};
import package::texture::opacity::ray_seed;

/// What sets the choice apart from that of holes.
const BLEND: u32 = 0x9e3779b9u;

/// Index of the material that a ray takes at a hit: of two the one or the other by chance, anew for every ray and triangle.
fn material_taken(hit: Hit, triangle: Triangle, origin: vec3<f32>, direction: vec3<f32>) -> u32 {
    if !has_blends || (triangle.flags & TRIANGLE_BLENDED) == 0u {
        return triangle.material;
    }
    let textures = load_material_textures(triangle.material);
    var share = textures.share;
    if textures.share_picture != NONE {
        let texture = load_surface_texture(textures.share_picture);
        share *= channel_of(texture, sample_texture(texture, uv_at(hit.triangle, hit.barycentric)));
    }
    let u = unit(combine(combine(ray_seed(origin, direction), hit.triangle), BLEND));
    return select(textures.rest, triangle.material, u < share);
}
