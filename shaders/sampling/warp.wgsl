// Maps from the unit square and frames around a direction; docs/photon-paths.md, "Emission".

const PI: f32 = 3.14159265358979;

/// Two unit vectors that make a right-handed frame with a unit vector `n`.
struct Frame {
    tangent: vec3<f32>,
    bitangent: vec3<f32>,
}

/// A frame around `n` (Duff et al. 2017).
fn frame(n: vec3<f32>) -> Frame {
    let s = select(-1.0, 1.0, n.z >= 0.0);
    let a = -1.0 / (s + n.z);
    let b = n.x * n.y * a;
    return Frame(
        vec3<f32>(1.0 + s * n.x * n.x * a, s * b, -s * n.x),
        vec3<f32>(b, s + n.y * n.y * a, -n.y),
    );
}

/// The concentric map of the unit square to the unit disc (Shirley and Chiu 1997).
fn disc(u: vec2<f32>) -> vec2<f32> {
    let a = 2.0 * u.x - 1.0;
    let b = 2.0 * u.y - 1.0;
    if a == 0.0 && b == 0.0 {
        return vec2<f32>(0.0);
    }
    let wide = abs(a) > abs(b);
    let r = select(b, a, wide);
    let phi = select(0.5 * PI - 0.25 * PI * (a / b), 0.25 * PI * (b / a), wide);
    return r * vec2<f32>(cos(phi), sin(phi));
}
