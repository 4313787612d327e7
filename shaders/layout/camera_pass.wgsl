// Bindings 1 and 2 of group 1 and 6 of group 2 in the camera pass; the others are in path_pass.wgsl.

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
    /// Listed tiles that the dispatch takes a sample of; 0 if it takes the whole picture.
    tile_count: u32,
    /// Unused.
    padding_0: u32,
    /// Unused.
    padding_1: u32,
    /// Unused.
    padding_2: u32,
    /// The inverse cumulative distribution of the pixel filter at (1 − cos(πk/63))/2 for k = 0 … 63, pixels from the centre.
    filter_inverse_cdf: array<vec4<f32>, 16>,
}

@group(1) @binding(1) var<uniform> camera_params: CameraParams;
/// Tiles of 8 × 8 pixels to take samples of, four a texel: column in the low 16 bits, row in the high ones.
@group(1) @binding(2) var tiles: texture_2d<u32>;
/// For each pixel the sum of the radiance of its first samples, W/(m² sr), as many as the last power of two before all; and the rays of all its samples.
@group(2) @binding(7) var<storage, read_write> halves: array<vec4<f32>>;
