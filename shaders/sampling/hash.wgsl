// Integer hashes; docs/photon-paths.md, "Random numbers".

/// A bijective 32-bit hash of low bias (Wellons 2018).
fn hash(value: u32) -> u32 {
    var x = value;
    x ^= x >> 16u;
    x *= 0x21f0aaadu;
    x ^= x >> 15u;
    x *= 0xd35a2d97u;
    return x ^ (x >> 15u);
}

/// A seed from two others.
fn combine(a: u32, b: u32) -> u32 {
    return hash(a ^ hash(b + 0x9e3779b9u));
}

/// The upper 24 bits as a number in [0, 1).
fn unit(bits: u32) -> f32 {
    return f32(bits >> 8u) * 5.9604644775390625e-8;
}
