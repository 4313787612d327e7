// Equation 1 of the profile `paper`: where its light sends a ray; docs/paper.md.

import package::emitter::emission::Emission;
import package::layout::photon_pass::photon_params;
import package::layout::records::load_light;
import package::sampling::hash::{combine, hash, unit};
import package::sampling::warp::{frame, PI};

/// The numbers, in [0, 1), of a ray's two angles: the middles of a grid's cells, row by row, or random.
fn angle_numbers(index: u32) -> vec2<f32> {
    let side = photon_params.grid_side;
    if side > 0u {
        return (vec2<f32>(f32(index % side), f32(index / side)) + 0.5) / f32(side);
    }
    let seed = combine(photon_params.seed, index);
    return vec2<f32>(unit(hash(seed)), unit(hash(seed ^ 0x80000000u)));
}

/// The ray of a number: from the light's position toward the point of its sphere at the angles θ, even over 2π, and φ, even over π.
fn emit_by_equation_1(index: u32) -> Emission {
    let light = load_light(photon_params.light);
    let u = angle_numbers(index);
    let theta = 2.0 * PI * u.x;
    let phi = PI * (u.y - 0.5);
    let basis = frame(light.axis);
    let direction = cos(phi) * (cos(theta) * basis.tangent + sin(theta) * basis.bitangent) + sin(phi) * light.axis;
    return Emission(light.position, normalize(direction), photon_params.ray_energy, 1.0, 2.0 * PI * PI * cos(phi));
}
