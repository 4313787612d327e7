// How exact the picture is: of each tile, what its first samples differ by from its later ones.

import package::layout::error_pass::{error_params, sampled_halves, sampled_pixels, tile_errors, TileError};

/// Pixels of a tile.
const TILE_PIXELS: u32 = 64u;
/// Share of the picture's mean radiance, squared, that is added to a pixel's own, so that errors in the dark do not count beyond measure.
const DARKNESS: f32 = 0.01;

/// What the pixels of the tile have found.
var<workgroup> squared_errors: array<f32, TILE_PIXELS>;
var<workgroup> radiances: array<f32, TILE_PIXELS>;
var<workgroup> samples: array<u32, TILE_PIXELS>;
var<workgroup> pixels: array<u32, TILE_PIXELS>;
var<workgroup> rays: array<u32, TILE_PIXELS>;

/// The squared error of a pixel's mean relative to its square, of colors as vectors of three channels. Means of n₁ and n₂ independent samples differ by
/// σ²(1/n₁ + 1/n₂) in the mean square, and that of all has the variance σ²/(n₁ + n₂).
fn squared_error(all: vec4<f32>, first: vec3<f32>) -> f32 {
    if all.w < 2.0 {
        return 1.0;
    }
    let early = f32(1u << firstLeadingBit(u32(all.w) - 1u));
    let late = all.w - early;
    let difference = (first / early - (all.xyz - first) / late) * sqrt(early * late) / all.w;
    let mean = all.xyz / all.w;
    let floor = 3.0 * DARKNESS * error_params.mean_radiance * error_params.mean_radiance;
    return min(dot(difference, difference) / max(dot(mean, mean) + floor, 1e-30), 1.0);
}

@compute @workgroup_size(64)
fn estimate_errors(
    @builtin(workgroup_id) group: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>, @builtin(local_invocation_index) local: u32,
) {
    let pixel = 8u * group.xy + vec2<u32>(local & 7u, local >> 3u);
    squared_errors[local] = 0.0;
    radiances[local] = 0.0;
    samples[local] = 0xffffffffu;
    pixels[local] = 0u;
    rays[local] = 0u;
    if pixel.x < error_params.width && pixel.y < error_params.height {
        let index = pixel.y * error_params.width + pixel.x;
        let all = sampled_pixels[1u + index];
        let mean = all.xyz / max(all.w, 1.0);
        let first = sampled_halves[index];
        squared_errors[local] = squared_error(all, first.xyz);
        radiances[local] = (mean.x + mean.y + mean.z) / 3.0;
        samples[local] = u32(all.w);
        pixels[local] = 1u;
        rays[local] = u32(first.w);
    }
    for (var step = TILE_PIXELS / 2u; step > 0u; step /= 2u) {
        workgroupBarrier();
        if local < step {
            squared_errors[local] += squared_errors[local + step];
            radiances[local] += radiances[local + step];
            samples[local] = min(samples[local], samples[local + step]);
            pixels[local] += pixels[local + step];
            rays[local] += rays[local + step];
        }
    }
    if local == 0u {
        let count = f32(max(pixels[0], 1u));
        tile_errors[group.y * groups.x + group.x] =
            TileError(squared_errors[0] / count, radiances[0] / count, samples[0], pixels[0], rays[0]);
    }
}
