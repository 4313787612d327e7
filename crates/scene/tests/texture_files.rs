//! Picture files: what they hold, and what is said of those that cannot be read.

mod picture_folder;

use std::fs;

use diacaustic_scene::{ColorSpace, load_texture};
use glam::{Vec3, Vec4};
use picture_folder::Folder;

fn assert_near(found: &[Vec4], expected: &[[f32; 4]]) {
    assert_eq!(found.len(), expected.len());
    for (found, expected) in found.iter().zip(expected) {
        // Half precision keeps 11 bits.
        let tolerance = 6e-4 * Vec4::from(*expected).abs() + 1e-7;
        assert!((*found - Vec4::from(*expected)).abs().cmple(tolerance).all(), "{found} against {expected:?}");
    }
}

#[test]
fn whole_numbers_are_decoded() {
    let folder = Folder::new();
    // 128/255 and 51/255 are above the curve's straight part, 10/255 is below, 11/255 just above.
    let colors = [[1.0, 0.215_860_5, 0.0], [0.003_035_27, 0.003_346_54, 0.033_104_767]];
    let with = |alpha: [f32; 2]| [0, 1].map(|k| [colors[k][0], colors[k][1], colors[k][2], alpha[k]]);
    let (srgb, linear) = (ColorSpace::Srgb, ColorSpace::Linear);
    assert_near(&folder.texels("rgb.png", srgb), &with([1.0; 2]));
    assert_near(&folder.texels("rgba.png", srgb), &with([0.2, 1.0]));
    let plain = [[1.0, 128.0 / 255.0, 0.0, 0.2], [10.0 / 255.0, 11.0 / 255.0, 0.2, 1.0]];
    assert_near(&folder.texels("rgba.png", linear), &plain);
    assert_near(&folder.texels("gray.png", linear), &[[0.2, 0.2, 0.2, 1.0], [0.8, 0.8, 0.8, 1.0]]);
    let dark = 0.033_104_767;
    assert_near(&folder.texels("gray-alpha.png", srgb), &[[dark, dark, dark, 128.0 / 255.0]; 2]);
    assert_near(&folder.texels("deep.png", linear), &[[1.0, 0.5, 0.0, 1.0], [1.0, 0.5, 1000.0 / 65535.0, 1.0]]);
    assert_near(&folder.texels("deep.png", srgb), &[[1.0, 0.214, 0.0, 1.0], [1.0, 0.214, 0.001_181, 1.0]]);
    assert_near(&folder.texels("deep-gray.png", linear), &[[0.5, 0.5, 0.5, 1.0]; 2]);
    assert_near(&folder.texels("deep-alpha.png", srgb), &[[1.0, 0.0, 0.0, 0.5]; 2]);
}

#[test]
fn jpeg_files_are_decoded() {
    let folder = Folder::new();
    folder.write_jpeg("color.jpg", false);
    folder.write_jpeg("gray.JPEG", true);
    let close = |found: Vec4, bytes: [f32; 3]| {
        let expected = Vec3::from(bytes) / 255.0;
        assert!(found.truncate().abs_diff_eq(expected, 3.0 / 255.0), "{found} against {expected}");
        assert_eq!(found.w, 1.0);
    };
    close(folder.texels("color.jpg", ColorSpace::Linear)[99], [200.0, 100.0, 50.0]);
    close(folder.texels("gray.JPEG", ColorSpace::Linear)[99], [188.0; 3]);
    let has_color = |name: &str| load_texture(&folder.path(name), ColorSpace::Srgb).unwrap().has_color;
    assert_eq!((has_color("color.jpg"), has_color("gray.JPEG")), (true, false));
}

#[test]
fn light_is_decoded() {
    let folder = Folder::new();
    let expected = [[4.0, 1.0, 0.5, 1.0], [0.0, 0.25, 2.0, 1.0]];
    for name in ["light.hdr", "light.exr"] {
        assert_eq!(folder.texels(name, ColorSpace::Linear), expected.map(Vec4::from));
    }
    folder.write_exr("covered.exr", &[[1.0, 2.0, 3.0, 0.25]]);
    let picture = load_texture(&folder.path("covered.exr"), ColorSpace::Linear).unwrap();
    assert!(picture.has_alpha && picture.has_color);
    assert_eq!(folder.texels("covered.exr", ColorSpace::Linear), [Vec4::new(1.0, 2.0, 3.0, 0.25)]);
    let header = b"#?RADIANCE\nEXPOSURE=4\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n";
    folder.write("exposed.hdr", &[header.as_slice(), &[128, 64, 32, 129]].concat());
    assert_eq!(folder.texels("exposed.hdr", ColorSpace::Linear), [Vec4::new(0.25, 0.125, 0.0625, 1.0)]);
}

#[test]
fn faults_of_files_are_named() {
    let folder = Folder::new();
    let starts = |name: &str, message: &str| {
        let found = folder.file_error(name);
        assert!(found.starts_with(&format!("{name}: the image {message}")), "{found}");
    };
    folder.write_jpeg("sound.jpg", false);
    for name in ["rgb.png", "light.hdr", "light.exr", "sound.jpg"] {
        let bytes = fs::read(folder.path(name)).unwrap();
        let (stem, ending) = name.split_once('.').unwrap();
        let short = format!("short-{stem}.{ending}");
        folder.write(&short, &bytes[..bytes.len() - if ending == "png" { 24 } else { 2 }]);
        starts(&short, "cannot be decoded: ");
        let text = format!("text.{ending}");
        folder.write(&text, b"no image at all");
        starts(&text, "cannot be decoded: ");
        let empty = format!("empty.{ending}");
        folder.write(&empty, b"");
        starts(&empty, "cannot be decoded: ");
    }
    fs::copy(folder.path("rgb.png"), folder.path("mislabelled.jpg")).unwrap();
    starts("mislabelled.jpg", "is a PNG file by its content and a JPEG file by its name; rename or convert it");
    fs::copy(folder.path("light.exr"), folder.path("mislabelled.hdr")).unwrap();
    starts("mislabelled.hdr", "is an OpenEXR file by its content and a Radiance HDR file by its name");
    folder.write("picture.png", b"GIF89a\x01\x00\x01\x00");
    starts("picture.png", "is a Gif file by its content and a PNG file by its name");
    starts("picture.gif", "is of a kind that is not read; pictures end in .png, .jpg, .jpeg, .hdr or .exr");
    folder.write("huge.hdr", b"#?RADIANCE\n\n-Y 16385 +X 16384\n");
    starts("huge.hdr", "has 16384 × 16385 texels; it must have from 1 × 1 to 16384 × 16384");
    folder.write_exr("bright.exr", &[[1.0, 1e6, 1.0]]);
    starts(
        "bright.exr",
        "holds [1.0, inf, 1.0, 1.0] at column 0, row 0 (from 0); each number must be finite and at most 65504",
    );
    folder.write_exr("wrong.exr", &[[1.0, f32::NAN, 1.0]]);
    starts("wrong.exr", "holds [1.0, NaN, 1.0, 1.0] at column 0, row 0 (from 0)");
}

/// OpenEXR files are broken in `lights.rs`.
#[test]
fn no_file_makes_the_reader_panic() {
    let folder = Folder::new();
    folder.write_jpeg("sound.jpg", false);
    for name in ["rgba.png", "deep.png", "light.hdr", "sound.jpg"] {
        let sound = fs::read(folder.path(name)).unwrap();
        let path = folder.path(&format!("broken-{name}"));
        for place in (0..sound.len()).step_by(sound.len().div_ceil(200)) {
            fs::write(&path, &sound[..place]).unwrap();
            let _ = load_texture(&path, ColorSpace::Linear);
            for flipped in [0x01, 0xff] {
                let mut broken = sound.clone();
                broken[place] ^= flipped;
                fs::write(&path, &broken).unwrap();
                let _ = load_texture(&path, ColorSpace::Linear);
            }
        }
    }
}
