// Owen-scrambled Sobol' numbers; docs/photon-paths.md, "Random numbers".

import package::sampling::hash::{combine, unit};

/// Five coordinates of one point, each in [0, 1).
struct Point5 {
    first: vec4<f32>,
    fifth: f32,
}

/// Nested uniform scramble by hashing (Laine and Karras 2011; constants by Vegdahl 2021).
fn owen(value: u32, seed: u32) -> u32 {
    var x = reverseBits(value);
    x ^= x * 0x3d20adeau;
    x += seed;
    x *= (seed >> 16u) | 1u;
    x ^= x * 0x05526c56u;
    x ^= x * 0x53a22864u;
    return reverseBits(x);
}

/// Five dimensions of the Sobol' sequence (direction numbers of Joe and Kuo 2008), Owen-scrambled.
fn sobol_5(index: u32, seed: u32) -> Point5 {
    var x = vec4<u32>(0u);
    var x_4 = 0u;
    // Direction numbers of bits b, b+1 and b+2 of the recurrences; dimensions 0 and 1 need one, dimension 2 two.
    var v_0 = 0x80000000u;
    var v_1 = 0x80000000u;
    var v_2 = vec2<u32>(0x80000000u, 0xc0000000u);
    var v_3 = vec3<u32>(0x80000000u, 0xc0000000u, 0x20000000u);
    var v_4 = vec3<u32>(0x80000000u, 0x40000000u, 0x20000000u);
    for (var bits = index; bits != 0u; bits >>= 1u) {
        let used = 0u - (bits & 1u);
        x ^= vec4<u32>(v_0, v_1, v_2.x, v_3.x) & vec4<u32>(used);
        x_4 ^= v_4.x & used;
        v_0 >>= 1u;
        v_1 ^= v_1 >> 1u;
        v_2 = vec2<u32>(v_2.y, v_2.y ^ v_2.x ^ (v_2.x >> 2u));
        v_3 = vec3<u32>(v_3.yz, v_3.y ^ v_3.x ^ (v_3.x >> 3u));
        v_4 = vec3<u32>(v_4.yz, v_4.z ^ v_4.x ^ (v_4.x >> 3u));
    }
    return Point5(
        vec4<f32>(
            unit(owen(x.x, combine(seed, 0u))),
            unit(owen(x.y, combine(seed, 1u))),
            unit(owen(x.z, combine(seed, 2u))),
            unit(owen(x.w, combine(seed, 3u))),
        ),
        unit(owen(x_4, combine(seed, 4u))),
    );
}

/// A well-spread number for a later decision `slot` of point `index`: a shuffled, scrambled radical inverse
/// (Burley 2020, padding).
fn padded_1(index: u32, seed: u32, slot: u32) -> f32 {
    let shuffled = owen(index, combine(seed, 16u + 2u * slot));
    return unit(owen(reverseBits(shuffled), combine(seed, 17u + 2u * slot)));
}

/// Dimension 1 of the Sobol' sequence: the bits of `index` times Pascal's triangle modulo 2, reversed.
fn sobol_dimension_1(index: u32) -> u32 {
    var x = reverseBits(index);
    // Pascal's triangle modulo 2 is the Kronecker power of (1 1; 0 1), so each level is one shift.
    x ^= (x & 0x55555555u) << 1u;
    x ^= (x & 0x33333333u) << 2u;
    x ^= (x & 0x0f0f0f0fu) << 4u;
    x ^= (x & 0x00ff00ffu) << 8u;
    x ^= x << 16u;
    return x;
}

/// Two jointly well-spread numbers for a later decision; takes `slot` and `slot + 1`.
fn padded_2(index: u32, seed: u32, slot: u32) -> vec2<f32> {
    let shuffled = owen(index, combine(seed, 16u + 2u * slot));
    return vec2<f32>(
        unit(owen(reverseBits(shuffled), combine(seed, 17u + 2u * slot))),
        unit(owen(sobol_dimension_1(shuffled), combine(seed, 18u + 2u * slot))),
    );
}
