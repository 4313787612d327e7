// Signed 64-bit sums in two words.

/// What the high word gains when `value` is added to a low word that held `low`.
fn carry(low: u32, value: i32) -> u32 {
    let wrapped = select(0u, 1u, low + bitcast<u32>(value) < low);
    return wrapped + select(0u, 0xffffffffu, value < 0);
}

/// The sum of two signed 64-bit integers, low and high word each.
fn wide_sum(a: vec2<u32>, b: vec2<u32>) -> vec2<u32> {
    let low = a.x + b.x;
    return vec2<u32>(low, a.y + b.y + select(0u, 1u, low < a.x));
}

/// A signed 64-bit integer as the nearest f32.
fn wide_to_f32(low: u32, high: u32) -> f32 {
    if high >= 0x80000000u {
        // Negated first: −1 is all ones, whose two words would cancel badly in single precision.
        let negated = ~low + 1u;
        return -(f32(~high + select(0u, 1u, negated == 0u)) * 4294967296.0 + f32(negated));
    }
    return f32(high) * 4294967296.0 + f32(low);
}
