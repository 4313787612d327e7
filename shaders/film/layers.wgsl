// The layers of the picture; docs/layers.md.

import package::layout::path_pass::{data_layers, group_layers, light_layers, LIGHT_LAYERS};
import package::layout::features::{has_data_layers, has_light_layers, light_group_count};

/// Adds radiance, W/(m² sr), to one of a pixel's LAYER_ sums.
fn add_to_layer(pixel: u32, layer: u32, radiance: vec3<f32>) {
    if has_light_layers {
        light_layers[LIGHT_LAYERS * pixel + layer] += vec4<f32>(radiance, 0.0);
    }
}

/// Adds radiance to one of a pixel's sums of light groups.
fn add_to_group_layer(pixel: u32, place: u32, radiance: vec3<f32>) {
    if light_group_count > 0u {
        group_layers[(2u * light_group_count + 1u) * pixel + place] += vec4<f32>(radiance, 0.0);
    }
}

/// Adds radiance to a light group of a pixel.
fn add_to_group(pixel: u32, group: u32, radiance: vec3<f32>) {
    add_to_group_layer(pixel, group, radiance);
}

/// Adds radiance to the caustic of a light group of a pixel.
fn add_to_caustic_of_group(pixel: u32, group: u32, radiance: vec3<f32>) {
    add_to_group_layer(pixel, light_group_count + group, radiance);
}

/// Adds radiance that no light sent to a pixel.
fn add_to_no_group(pixel: u32, radiance: vec3<f32>) {
    add_to_group_layer(pixel, 2u * light_group_count, radiance);
}

/// Adds the first surface of a sample to a pixel's sums.
fn add_to_data_layers(pixel: u32, position: vec3<f32>, depth: f32, normal: vec3<f32>, albedo: vec3<f32>) {
    if has_data_layers {
        data_layers[pixel].surfaces += 1.0;
        data_layers[pixel].position += position;
        data_layers[pixel].depth += depth;
        data_layers[pixel].normal += normal;
        data_layers[pixel].albedo += albedo;
    }
}

/// Adds a sample to the sum of squared deviations from the mean (Welford 1962), in which no digits are lost as in a sum of squares.
/// `before` holds the sum of the pixel's samples so far and their number.
fn add_to_squares(pixel: u32, before: vec4<f32>, radiance: vec3<f32>) {
    if has_data_layers {
        let mean_before = before.xyz / max(before.w, 1.0);
        let mean = (before.xyz + radiance) / (before.w + 1.0);
        data_layers[pixel].squares += (radiance - mean_before) * (radiance - mean);
    }
}
