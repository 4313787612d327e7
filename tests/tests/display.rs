//! `Renderer::render_to_texture` against what `diacaustic-output` makes of the same film.

use diacaustic::{
    Film, RenderParams, Renderer,
    scene::{Scene, ToneCurve},
    wgpu,
};
use diacaustic_output::{Display, Picture, Tone, write_png};
use diacaustic_tests::{emit, gpu, scene};

/// How the film is shown, for both.
const SHOWN: [(f32, ToneCurve, Tone); 4] = [
    (0.0, ToneCurve::Plain, Tone::Plain),
    (-1.5, ToneCurve::Plain, Tone::Plain),
    (0.0, ToneCurve::Filmic, Tone::Filmic),
    (2.25, ToneCurve::Filmic, Tone::Filmic),
];

/// A picture from black to the lamp itself; its rows are not of a length that copies are aligned to.
fn ball() -> Scene {
    scene(
        "camera = { position = [0, 1.5, 2.5], look_at = [0, 0.6, 0], vertical_fov = 60 }
         render = { width = 70, height = 52, samples = 4, map_size = 64 }
         materials.glass = { type = \"dielectric\", ior = 1.5, tint = [1, 0.9, 0.7] }
         materials.floor = { type = \"diffuse\", albedo = [0.8, 0.6, 0.3] }
         lights = [{ type = \"sphere\", center = [0.5, 1.6, 0.3], radius = 0.1, flux = [20, 18, 12] }]
         objects = [
             { sphere = { center = [0, 0.4, 0], radius = 0.3, subdivisions = 5 }, material = \"glass\" },
             { rectangle = { center = [0, 0, 0], edge_u = [2, 0, 0], edge_v = [0, 0, -2] }, material = \"floor\" },
         ]",
    )
}

fn rendered() -> (Renderer, Film) {
    let mut renderer = emit(&ball(), 50_000);
    renderer.add_samples(4).unwrap();
    let film = renderer.film().unwrap();
    let brightest = film.radiance.iter().flatten().copied().fold(0.0, f32::max);
    let black = film.radiance.iter().filter(|pixel| **pixel == [0.0; 3]).count();
    assert!(brightest > 10.0 && black > 100, "the film tests too little: brightest {brightest}, {black} pixels black");
    (renderer, film)
}

/// A texture of the film's size.
fn texture(film: &Film, format: wgpu::TextureFormat) -> wgpu::Texture {
    gpu().device.create_texture(&wgpu::TextureDescriptor {
        label: Some("shown"),
        size: wgpu::Extent3d { width: film.width, height: film.height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
        view_formats: &[],
    })
}

/// The bytes of a texture, row by row without padding.
fn read_back(texture: &wgpu::Texture) -> Vec<u8> {
    let device = &gpu().device;
    let row = texture.width() * texture.format().block_copy_size(None).unwrap();
    let padded = row.next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
    let buffer = device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("read-back"),
        size: u64::from(padded * texture.height()),
        usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(padded), rows_per_image: None };
    let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    encoder.copy_texture_to_buffer(
        texture.as_image_copy(),
        wgpu::TexelCopyBufferInfo { buffer: &buffer, layout },
        texture.size(),
    );
    gpu().queue.submit([encoder.finish()]);
    buffer.slice(..).map_async(wgpu::MapMode::Read, |result| result.unwrap());
    device.poll(wgpu::PollType::wait_indefinitely()).unwrap();
    let bytes = buffer.slice(..).get_mapped_range().unwrap();
    bytes.chunks_exact(padded as usize).flat_map(|padded| &padded[..row as usize]).copied().collect()
}

/// The film on a texture of a format, by the GPU.
fn shown(renderer: &mut Renderer, film: &Film, format: wgpu::TextureFormat, exposure: f32, tone: ToneCurve) -> Vec<u8> {
    let texture = texture(film, format);
    let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
    renderer.render_to_texture(&view, &RenderParams { exposure, tone }).unwrap();
    read_back(&texture)
}

/// The bytes of the PNG that the same film becomes, three a pixel.
fn png_bytes(film: &Film, display: &Display) -> Vec<u8> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("film.png");
    let picture = Picture { width: film.width, height: film.height, pixels: &film.radiance };
    write_png(&path, &picture, display).unwrap();
    image::open(&path).unwrap().into_rgb8().into_raw()
}

/// The channels red, green and blue of pixels of four.
fn without_alpha<T: Copy>(channels: &[T]) -> Vec<T> {
    channels.chunks_exact(4).flat_map(|pixel| &pixel[..3]).copied().collect()
}

#[test]
fn eight_bit_textures_show_the_bytes_of_the_png() {
    let (mut renderer, film) = rendered();
    for format in [wgpu::TextureFormat::Rgba8Unorm, wgpu::TextureFormat::Rgba8UnormSrgb] {
        for (exposure, curve, tone) in SHOWN {
            let bytes = shown(&mut renderer, &film, format, exposure, curve);
            assert!(bytes.chunks_exact(4).all(|pixel| pixel[3] == 255), "{format:?}: a pixel is not opaque");
            let expected = png_bytes(&film, &Display { exposure, tone });
            let shown = without_alpha(&bytes);
            assert_eq!(shown.len(), expected.len());
            let worst = shown.iter().zip(&expected).map(|(a, b)| a.abs_diff(*b)).max();
            assert!(worst <= Some(1), "{format:?}, {tone:?}, {exposure} stops: a byte differs by {worst:?}");
        }
    }
}

#[test]
fn exposure_and_curve_change_the_bytes() {
    let (mut renderer, film) = rendered();
    let all = SHOWN.map(|(stops, curve, _)| shown(&mut renderer, &film, wgpu::TextureFormat::Rgba8Unorm, stops, curve));
    for (number, bytes) in all.iter().enumerate() {
        let differs = |other: &Vec<u8>| bytes.iter().zip(other).any(|(a, b)| a.abs_diff(*b) > 4);
        assert!(all[..number].iter().all(differs), "the comparison cannot fail");
    }
}

/// IEEE 754 binary16.
fn half_to_f32(bits: u16) -> f32 {
    let sign = if bits >> 15 == 1 { -1.0 } else { 1.0 };
    let (exponent, fraction) = (i32::from(bits >> 10 & 31), f32::from(bits & 1023) / 1024.0);
    sign * match exponent {
        0 => fraction * 2f32.powi(-14),
        31 => f32::INFINITY,
        _ => (1.0 + fraction) * 2f32.powi(exponent - 15),
    }
}

/// Checks channels against exposed, tone-mapped radiance without sRGB's curve.
fn assert_linear(shown: &[f32], film: &Film, exposure: f32, tone: Tone, relative: f32) {
    let shown = without_alpha(shown);
    let radiance = film.radiance.as_flattened();
    assert_eq!(shown.len(), radiance.len());
    for (number, (found, radiance)) in shown.iter().zip(radiance).enumerate() {
        let expected = tone.apply(radiance * exposure.exp2());
        let difference = (found - expected).abs();
        // Halves below 2⁻¹⁴ have fewer digits.
        assert!(
            difference <= relative * expected + relative * 2f32.powi(-14),
            "channel {number}: {found}, not {expected}"
        );
    }
}

#[test]
fn float_textures_show_linear_values() {
    let (mut renderer, film) = rendered();
    for (exposure, curve, tone) in SHOWN {
        let bytes = shown(&mut renderer, &film, wgpu::TextureFormat::Rgba32Float, exposure, curve);
        let floats: Vec<_> = bytes.chunks_exact(4).map(|b| f32::from_le_bytes([b[0], b[1], b[2], b[3]])).collect();
        assert_linear(&floats, &film, exposure, tone, 1e-5);
        let bytes = shown(&mut renderer, &film, wgpu::TextureFormat::Rgba16Float, exposure, curve);
        let halves: Vec<_> = bytes.chunks_exact(2).map(|b| half_to_f32(u16::from_le_bytes([b[0], b[1]]))).collect();
        assert_linear(&halves, &film, exposure, tone, 2f32.powi(-10));
    }
}
