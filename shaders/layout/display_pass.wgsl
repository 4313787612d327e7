// The bindings of the pass that shows the film on a texture.

/// How the film is shown.
struct DisplayParams {
    /// Factor on radiance.
    exposure: f32,
    /// 1 for the filmic curve, 0 for none.
    filmic: u32,
    /// 1 if the shader encodes sRGB, 0 if the target does.
    encode_srgb: u32,
    /// Width of the film, pixels.
    width: u32,
    /// Height of the film, pixels.
    height: u32,
    /// Unused.
    padding_0: u32,
    /// Unused.
    padding_1: u32,
    /// Unused.
    padding_2: u32,
}

@group(0) @binding(0) var<uniform> display_params: DisplayParams;
/// The camera pass's film: four words of counters, then the pixels.
@group(0) @binding(1) var<storage, read> film_words: array<vec4<f32>>;
