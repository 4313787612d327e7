// Reflectance of interfaces; docs/materials.md, "Fresnel".

/// What an interface between dielectrics does to a ray.
struct Refraction {
    /// Unpolarised Fresnel reflectance; 1 at total internal reflection.
    reflectance: f32,
    /// Cosine of the angle of refraction; 0 at total internal reflection.
    cos_t: f32,
}

/// Exact Fresnel equations. `eta` is the index of the incident side over that of the other, `cos_i` > 0.
fn refraction(cos_i: f32, eta: f32) -> Refraction {
    let sin2_t = eta * eta * (1.0 - cos_i * cos_i);
    if sin2_t >= 1.0 {
        return Refraction(1.0, 0.0);
    }
    let cos_t = sqrt(1.0 - sin2_t);
    let r_s = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
    let r_p = (cos_i - eta * cos_t) / (cos_i + eta * cos_t);
    return Refraction(0.5 * (r_s * r_s + r_p * r_p), cos_t);
}

/// Unpolarised reflectance of a conductor of complex index n + ik against the medium outside, per channel.
fn conductor_reflectance(cos_i: f32, n: vec3<f32>, k: vec3<f32>) -> vec3<f32> {
    let c = cos_i * cos_i;
    let s = 1.0 - c;
    let difference = n * n - k * k - s;
    let sum = sqrt(difference * difference + 4.0 * n * n * k * k);
    let a = sqrt(max(0.5 * (sum + difference), vec3<f32>(0.0)));
    let edge = 2.0 * cos_i * a;
    let r_s = (sum - edge + c) / (sum + edge + c);
    let r_p = r_s * (c * sum - edge * s + s * s) / (c * sum + edge * s + s * s);
    return 0.5 * (r_s + r_p);
}

/// Schlick's approximation, per channel.
fn schlick(cos_i: f32, f_0: vec3<f32>) -> vec3<f32> {
    let x = 1.0 - clamp(cos_i, 0.0, 1.0);
    let x2 = x * x;
    return f_0 + (1.0 - f_0) * (x2 * x2 * x);
}
