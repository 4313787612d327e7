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

/// The point of the unit square that `disc` takes to a point of the unit disc.
fn disc_inverse(p: vec2<f32>) -> vec2<f32> {
    let wide = abs(p.x) > abs(p.y);
    let main = select(p.y, p.x, wide);
    let r = select(-length(p), length(p), main >= 0.0);
    let across = r * (4.0 / PI) * atan(select(p.x, p.y, wide) / select(main, 1.0, main == 0.0));
    return 0.5 + 0.5 * select(vec2<f32>(across, r), vec2<f32>(r, across), wide);
}

/// 1 − cos α of a cone of sine `sin_alpha`, without cancellation.
fn cone_height(sin_alpha: f32) -> f32 {
    let sin2 = sin_alpha * sin_alpha;
    return sin2 / (1.0 + sqrt(max(1.0 - sin2, 0.0)));
}

/// A direction within a cone.
struct ConeSample {
    /// Unit direction.
    direction: vec3<f32>,
    /// Cosine of its angle to the axis.
    cos_theta: f32,
    /// Sine of that angle.
    sin_theta: f32,
}

/// A direction evenly within the cone around unit vector `axis` whose 1 − cos is `height`; with 2, any direction.
fn cone(axis: vec3<f32>, height: f32, u: vec2<f32>) -> ConeSample {
    let z = u.x * height;
    let cos_theta = 1.0 - z;
    let sin_theta = sqrt(z * (2.0 - z));
    let phi = 2.0 * PI * u.y;
    let basis = frame(axis);
    let direction = sin_theta * (cos(phi) * basis.tangent + sin(phi) * basis.bitangent) + cos_theta * axis;
    return ConeSample(direction, cos_theta, sin_theta);
}

/// The point of the unit square that `cone` takes to a direction within it.
fn cone_inverse(axis: vec3<f32>, height: f32, direction: vec3<f32>) -> vec2<f32> {
    let basis = frame(axis);
    // |d − axis|²/2 is 1 − cos of the angle between them, without cancellation.
    let chord = direction - axis;
    let turn = atan2(dot(direction, basis.bitangent), dot(direction, basis.tangent)) / (2.0 * PI);
    return vec2<f32>(0.5 * dot(chord, chord) / height, turn + select(0.0, 1.0, turn < 0.0));
}

/// A direction around unit vector `n`, in proportion to its cosine.
fn cosine_hemisphere(n: vec3<f32>, u: vec2<f32>) -> vec3<f32> {
    let xy = disc(u);
    let basis = frame(n);
    return normalize(xy.x * basis.tangent + xy.y * basis.bitangent + sqrt(max(1.0 - dot(xy, xy), 0.0)) * n);
}
