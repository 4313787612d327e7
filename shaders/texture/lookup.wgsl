// A picture's value at a place; docs/materials.md, "Textures".

import package::layout::records::{load_texture_coordinates, load_texture_texel};
import package::layout::scene::{SurfaceTexture, TextureCoordinates, TEXTURE_CHANNEL_SHIFT, TEXTURE_NEAREST, WRAP_CLAMP, WRAP_MIRROR};

/// Texture coordinates at barycentric weights of a triangle's second and third corner.
fn interpolate_uv(coordinates: TextureCoordinates, barycentric: vec2<f32>) -> vec2<f32> {
    let first = 1.0 - barycentric.x - barycentric.y;
    return first * coordinates.uv_01.xy + barycentric.x * coordinates.uv_01.zw + barycentric.y * coordinates.uv_2;
}

/// Texture coordinates at a point of a triangle.
fn uv_at(triangle: u32, barycentric: vec2<f32>) -> vec2<f32> {
    return interpolate_uv(load_texture_coordinates(triangle), barycentric);
}

/// The place on its picture of texture coordinates, from (0, 0) at the lower left to (1, 1).
fn picture_place(texture: SurfaceTexture, uv: vec2<f32>) -> vec2<f32> {
    let place = vec3<f32>(uv, 1.0);
    return vec2<f32>(dot(texture.s_from_uv, place), dot(texture.t_from_uv, place));
}

/// The texel among `count` that stands at an index.
fn wrap(index: i32, count: u32, mode: u32) -> u32 {
    let n = i32(count);
    if mode == WRAP_CLAMP {
        return u32(clamp(index, 0, n - 1));
    }
    let period = select(n, 2 * n, mode == WRAP_MIRROR);
    let inside = ((index % period) + period) % period;
    return u32(min(inside, 2 * n - 1 - inside));
}

fn texel(texture: SurfaceTexture, column: i32, row: i32) -> vec4<f32> {
    let x = wrap(column, texture.width, texture.flags & 3u);
    let y = wrap(row, texture.height, (texture.flags >> 2u) & 3u);
    return load_texture_texel(texture.first_texel + y * texture.width + x);
}

/// The four channels of a picture at texture coordinates.
fn sample_texture(texture: SurfaceTexture, uv: vec2<f32>) -> vec4<f32> {
    let place = picture_place(texture, uv);
    let at = vec2<f32>(place.x, 1.0 - place.y) * vec2<f32>(f32(texture.width), f32(texture.height));
    let is_nearest = (texture.flags & TEXTURE_NEAREST) != 0u;
    let corner = at - select(0.5, 0.0, is_nearest);
    let low = floor(corner);
    let part = select(corner - low, vec2<f32>(0.0), is_nearest);
    let index = vec2<i32>(low);
    let upper = mix(texel(texture, index.x, index.y), texel(texture, index.x + 1, index.y), part.x);
    let lower = mix(texel(texture, index.x, index.y + 1), texel(texture, index.x + 1, index.y + 1), part.x);
    return mix(upper, lower, part.y);
}

/// The number that a texture's value stands for.
fn channel_of(texture: SurfaceTexture, value: vec4<f32>) -> f32 {
    return value[(texture.flags >> TEXTURE_CHANNEL_SHIFT) & 3u];
}
