// How much the samples of a pixel vary; docs/layers.md, "Variance".

import package::layout::camera_pass::{sample_batches, BATCH_SAMPLES};
import package::layout::features::has_variance;
import package::layout::path_pass::data_layers;

/// What a value adds to the sum of squared deviations from the mean (Welford 1962), in which no digits are lost as in a sum of squares.
fn squared_deviation(value: vec3<f32>, mean_before: vec3<f32>, mean: vec3<f32>) -> vec3<f32> {
    return (value - mean_before) * (value - mean);
}

/// Adds a sample to the squared deviations of a pixel's samples, and the batch that it completes to those of its batches. `before` holds the
/// sum of the pixel's samples so far and their number.
fn add_to_squares(pixel: u32, before: vec4<f32>, radiance: vec3<f32>) {
    if has_variance {
        let sum = before.xyz + radiance;
        let count = before.w + 1.0;
        let mean = sum / count;
        data_layers[pixel].squares += squared_deviation(radiance, before.xyz / max(before.w, 1.0), mean);
        if u32(count) % BATCH_SAMPLES == 0u {
            let batched = sample_batches[pixel].sum;
            let size = f32(BATCH_SAMPLES);
            let batch = (sum - batched) / size;
            sample_batches[pixel].squares += squared_deviation(batch, batched / max(count - size, 1.0), mean);
            sample_batches[pixel].sum = sum;
        }
    }
}
