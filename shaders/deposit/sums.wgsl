// Flux into the texels of energy maps, as integers.

import package::film::fixed_point::carry;
import package::film::texels::{texels_around, TilePlace};
import package::layout::features::{has_squares, paper_refraction, PAPER_NONE};
import package::layout::photon_pass::{energy_high, energy_low};
import package::paper::deposit::weights_by_equation_2;

/// Adds to the high word of a sum.
fn add_to_high(word: u32, gained: u32) {
    if gained != 0u {
        atomicAdd(&energy_high[word], gained);
    }
}

/// Adds units of flux to a texel, and their square.
fn add_to_texel(texel: u32, units: vec3<i32>) {
    let first = select(3u, 4u, has_squares) * texel;
    for (var channel = 0u; channel < 3u; channel++) {
        let share = units[channel];
        if share != 0 {
            add_to_high(first + channel, carry(atomicAdd(&energy_low[first + channel], bitcast<u32>(share)), share));
        }
    }
    if has_squares {
        // In sixteenths, so that the squares of many large photons fit into 64 bits.
        let sixteenths = vec3<f32>(units) / 16.0;
        let square = round(dot(sixteenths, sixteenths) / 3.0);
        let high = floor(square / 4294967296.0);
        let low = u32(square - high * 4294967296.0);
        let before = atomicAdd(&energy_low[first + 3u], low);
        add_to_high(first + 3u, u32(high) + select(0u, 1u, before + low < before));
    }
}

/// Adds units of flux to the four texels around a place; what they get sums to the units exactly.
fn add_around(place: TilePlace, units: vec3<i32>) {
    let around = texels_around(place);
    var weights = around.weights;
    if paper_refraction != PAPER_NONE {
        weights = weights_by_equation_2(around.weights);
    }
    var rest = units;
    for (var k = 0u; k < 4u; k++) {
        var share = rest;
        if k < 3u {
            share = vec3<i32>(round(vec3<f32>(units) * weights[k]));
        }
        rest -= share;
        add_to_texel(around.texels[k], share);
    }
}
