// Equation 3 of the profile `paper`: where a ray goes on behind a surface; docs/paper.md.

/// The refracted direction of `d` at a surface of normal `m`, cos θi = −d·m > 0, `eta` the index of the incident side over that of the other:
/// n d + (n − 1) cos θi m, of unit length. Its part along the normal is that of `d`, so that tan θt = n tan θi, at any angle.
fn refract_by_equation_3(d: vec3<f32>, m: vec3<f32>, cos_i: f32, eta: f32) -> vec3<f32> {
    return normalize(eta * d + (eta - 1.0) * cos_i * m);
}
