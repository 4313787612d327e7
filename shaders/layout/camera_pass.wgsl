// Binding 1 of group 1 in the camera pass; the others are in path_pass.wgsl.

/// The lens and the picture.
struct CameraParams {
    /// From the centre of the picture to its right edge, at distance 1.
    half_right: vec3<f32>,
    /// Radius of the lens, metres.
    aperture_radius: f32,
    /// From the centre of the picture to its upper edge, at distance 1.
    half_up: vec3<f32>,
    /// Distance at which the picture is sharp, metres.
    focus_distance: f32,
    /// The lens axis that is to the right in the picture, unit length, world frame.
    lens_right: vec3<f32>,
    /// Width of the picture, pixels.
    width: u32,
    /// The lens axis that is up in the picture, unit length, world frame.
    lens_up: vec3<f32>,
    /// Height of the picture, pixels.
    height: u32,
    /// The inverse cumulative distribution of the pixel filter at (1 − cos(πk/63))/2 for k = 0 … 63, pixels from the centre.
    filter_inverse_cdf: array<vec4<f32>, 16>,
}

@group(1) @binding(1) var<uniform> camera_params: CameraParams;
