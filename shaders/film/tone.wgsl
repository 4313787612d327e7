// From radiance to what a screen shows.

/// A filmic curve: nearly linear up to 0.6, then a shoulder that reaches 1 for no finite value.
fn filmic(color: vec3<f32>) -> vec3<f32> {
    let knee = vec3<f32>(0.6);
    let over = max(color - knee, vec3<f32>(0.0)) / (1.0 - knee);
    return min(color, knee) + (1.0 - knee) * (over / (1.0 + over));
}

/// The sRGB transfer function (IEC 61966-2-1).
fn encode_srgb(linear: vec3<f32>) -> vec3<f32> {
    let c = clamp(linear, vec3<f32>(0.0), vec3<f32>(1.0));
    return select(1.055 * pow(c, vec3<f32>(1.0 / 2.4)) - 0.055, 12.92 * c, c <= vec3<f32>(0.0031308));
}
