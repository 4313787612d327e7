// Reflection and refraction at a smooth interface.

/// What an interface does to a ray.
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
