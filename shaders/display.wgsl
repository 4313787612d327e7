// Shows the film on a texture.

import package::film::tone::{encode_srgb, filmic};
import package::layout::display_pass::{display_params, film_words};

/// A triangle that covers the target.
@vertex
fn cover_target(@builtin(vertex_index) vertex: u32) -> @builtin(position) vec4<f32> {
    let corner = vec2<f32>(f32((vertex << 1u) & 2u), f32(vertex & 2u));
    return vec4<f32>(2.0 * corner - 1.0, 0.0, 1.0);
}

@fragment
fn show_pixel(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    let pixel = min(vec2<u32>(position.xy), vec2<u32>(display_params.width - 1u, display_params.height - 1u));
    let sum = film_words[1u + pixel.y * display_params.width + pixel.x];
    var color = max(sum.xyz / max(sum.w, 1.0), vec3<f32>(0.0)) * display_params.exposure;
    if display_params.filmic != 0u {
        color = filmic(color);
    }
    if display_params.encode_srgb != 0u {
        color = encode_srgb(color);
    }
    return vec4<f32>(color, 1.0);
}
