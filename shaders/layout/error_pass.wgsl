// The bindings of the pass that estimates the picture's error.

/// One dispatch of the pass that estimates errors.
struct ErrorParams {
    /// Width of the picture, pixels.
    width: u32,
    /// Height of the picture, pixels.
    height: u32,
    /// Mean radiance of the picture, W/(m² sr).
    mean_radiance: f32,
    /// Unused.
    padding: u32,
}

/// What the samples of a tile of 8 × 8 pixels come to.
struct TileError {
    /// Mean over pixels of the squared error of the radiance, mean of the channels, relative to the pixel's brightness; at most 1 each.
    squared_error: f32,
    /// Mean radiance, W/(m² sr), of pixels and channels.
    radiance: f32,
    /// Samples of a pixel, the least of all.
    samples: u32,
    /// Pixels within the picture.
    pixels: u32,
    /// Rays of all samples of all its pixels.
    rays: u32,
}

@group(0) @binding(0) var<uniform> error_params: ErrorParams;
/// The camera pass's film: four words of counters, then the pixels.
@group(0) @binding(1) var<storage, read> sampled_pixels: array<vec4<f32>>;
/// For each pixel the sum of the radiance of its first samples, W/(m² sr), as many as the last power of two before all; and the rays of all its samples.
@group(0) @binding(2) var<storage, read> sampled_halves: array<vec4<f32>>;
/// Row by row from the top left.
@group(0) @binding(3) var<storage, read_write> tile_errors: array<TileError>;
