//! Meshes in EXT_meshopt_compression: streams that meshoptimizer 0.24 wrote (by the crate meshopt 0.6.2), and damaged ones.

mod gltf_file;

use std::path::Path;

use diacaustic_scene::{GltfFile, GltfOptions, parse_gltf};
use glam::{Quat, Vec3, Vec4};
use gltf_file::Builder;
use proptest::prelude::*;
use serde_json::{Value, json};

// A grid of 5 × 4 points, 0.25xz high, and its 24 triangles, in rows and in an order that has little in common with rows.
const POSITIONS: &str = "a000000700ffffffff00ffffffff00ffffffff00ff000000ffffffff051fb7edfb827eff827eff827eff7e000000827e0000053ffc330fff\
    807fff80ffffffff7fff000000ff807fff051fb3c0f3847cfe847c847cfd7e000000847c00000100300003807f0100000c00ff0000000000\
    000000000000000000000000000000000000c00000403f0000c0bf";
const EXPONENTIAL: &str = "a000050f33ccf340407f40407f40407f3c0000004040050812048120000000051685a1685a00000000050f33c0f35f5fa03f3f40409f3c00\
    00006060050120408120000000051997e1fa0403040366000000000100300c03208020010000080001001000020000000000000000000000\
    00000000000000000000e0fff4003000f200d0fff3";
const NORMALS_8: &str = "a00700080c1c146104042a1c750303291b30ff000000070b1b130700141c0c082f1c2a04044d1c2a040461ff000000141c0c080000000000\
    0000000000000000000000000000000000000000000000000019447f00";
const NORMALS_16: &str = "a007007eac35af3b3a529635a039519536f4ff0000007dab36b0060022050042700314140000000700af35ac7ef33596523aeb3596523a3b\
    ff000000af35ac7e060022032400524005280000000000000000000000000000000000000000000000000000000000000099014404ff0700\
    00";
// 20 rotations.
const ROTATIONS: &str = "a007003274a5d1d23f40b71d2eec23bb1884ff0000005251243e0700403a798281535493363e423e341cafff0000001f20a7300700696af5\
    95d7114dc438374f50cd20feff00000012c8d68207005453e015b1ba76b87b7c2c2bc6096fff0000008c9e8a9f070000779e25acab7fde5d\
    dfe02a290056ff00000055e5e92f070000a208a9d8d7ba82c4292a807f00d4ff000000d3c858e0050399c00503049c000000040000000000\
    0000000000000000000000000000000000000000000000000000ff7f";
const TRIANGLES: &str = "e1fe1e001e001e001ede0e061e051e041ede0e041e041e041ef00a007687566778a9866589689801690000";
const SHUFFLED: &str = "e1ff1ffffeff1ffffeff1fff1fff1fff1affffff1ffffeff1aff04080208ff000802f015ff01080208ff000802f015ff00080208ff1d0802\
    08ef010a08bf1d0aaf080a9f1f02af080a08af010abaaf150a007687566778a9866589689801690000";
const SEQUENCE: &str = "d108100402140e1010043e140e0c100402140e1010043e140e10100402140e2a100402140e0c100402140e2a100402140e1010043e140e10\
    100402140e0c10043e140e10100402140e00000000";
// 300 elements of 16 bytes: two blocks, and differences of every width.
const BLOCKS: &str = "a0555555552aaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaa\
    aaaaaaaaaaaaaaaaaaaaaaaaaa000000000000000000000000aaaaaaaa088628a42a46880c628626684a646a608a284a6486088284a824c0\
    c08484c24a8606c626884464c466628882a2a62664a646a24882846c466826a46482c606a2a4664a84682882a4626a806c0866a246a66464\
    a2c46482a46886662a0a266a4882a282a46466c28646a08a2688282a2c266468a60c464a2828864866866662840004100000200000000008\
    000000000000000000ffffffff00444666b0a4d06fecc1c558567ecc813deeb64ba1390f7e5fd73f673bfa5c7e50b3d05229f13b537e085c\
    70a0f4aaa3d690ea9f2190cd64b8ad9a6da3cd85ee5e46280a0f63b11f8e98777b25897d4d391b15f7bc4ac4c8e0ffb90efc0027a9b72c9b\
    1cb0e28fb2a0d66e270ef1893a13d0fe5b9f872f594cf55b395e5ebceae92b0905d9ab8a6d759ae994a8aaf66301e139eb8c7c132988320d\
    48a2d72d45d1094d1133bd9fc46f6d134172ede2a912764816605ffbeb82e5c6123ce3dfb85ad9d4db72e0ef8b52b53d3869f86c316362e8\
    4660f997058a3ed974f5d4ef47bc1d1751464ae753cccb3d335fe0cb408744702491ac2f014e02685948ca6c990000000000000000000000\
    000000000000000000000000000000000015aaaaaaaaaaaaaaaaaaaaaa00018000000000002a486864a0c0c24c2a446a60a4a08884848282\
    c66268260000018000000000003f218019781f959f54a3a289dd87c3d3d4299501f32f7cbb81dca64cba90a158a3a2c926afcf1822c73bc0\
    d04700000000000000000000000000000000000000000000000000000000000000000000003c00000007000000";

const POINTS: usize = 20;

fn bytes(hex: &str) -> Vec<u8> {
    (0..hex.len() / 2).map(|k| u8::from_str_radix(&hex[2 * k..2 * k + 2], 16).unwrap()).collect()
}

/// A compressed view of a file in the making; returns its index.
fn add(builder: &mut Builder, stream: &[u8], stride: usize, count: usize, mode: &str, filter: &str) -> usize {
    let view = builder.view(stream, None);
    let offset = builder.json["bufferViews"][view]["byteOffset"].clone();
    builder.json["bufferViews"][view] = json!({
        // As exporters do, the view itself lies in a buffer that has no bytes.
        "buffer": 0, "byteOffset": 0, "byteLength": stride * count,
        "extensions": { "EXT_meshopt_compression": {
            "buffer": 0, "byteOffset": offset, "byteLength": stream.len(), "byteStride": stride, "count": count,
            "mode": mode, "filter": filter
        } }
    });
    view
}

/// A file of the grid: positions, normals and indices by these streams.
fn grid(positions: (&str, &str), normals: (&str, usize), indices: (&str, &str)) -> Builder {
    let mut builder = Builder::default();
    let view = add(&mut builder, &bytes(positions.0), 12, POINTS, "ATTRIBUTES", positions.1);
    let position =
        builder.accessor(json!({ "bufferView": view, "componentType": 5126, "count": POINTS, "type": "VEC3" }));
    let view = add(&mut builder, &bytes(normals.0), normals.1, POINTS, "ATTRIBUTES", "OCTAHEDRAL");
    let component = if normals.1 == 4 { 5120 } else { 5122 };
    let normal = builder.accessor(json!({
        "bufferView": view, "componentType": component, "normalized": true, "count": POINTS, "type": "VEC3"
    }));
    let view = add(&mut builder, &bytes(indices.0), 2, 72, indices.1, "NONE");
    let index = builder.accessor(json!({ "bufferView": view, "componentType": 5123, "count": 72, "type": "SCALAR" }));
    builder.json["extensionsRequired"] = json!(["EXT_meshopt_compression", "KHR_mesh_quantization"]);
    builder.json["meshes"] = json!([{ "primitives": [
        { "attributes": { "POSITION": position, "NORMAL": normal }, "indices": index }
    ] }]);
    builder.json["nodes"] = json!([{ "mesh": 0 }]);
    builder
}

fn good() -> Builder {
    grid((POSITIONS, "NONE"), (NORMALS_8, 4), (TRIANGLES, "TRIANGLES"))
}

fn parse(builder: &Builder) -> Result<GltfFile, String> {
    parse_gltf(&builder.glb(), Path::new("a.glb"), &GltfOptions::default()).map_err(|error| error.to_string())
}

/// Triangles as sets of places, in order, with corners turned so that the least comes first.
fn places(file: &GltfFile) -> Vec<[[i32; 2]; 3]> {
    let mesh = &file.objects[0].mesh;
    let place =
        |vertex: u32| [mesh.positions[vertex as usize].x, mesh.positions[vertex as usize].z].map(|x| (2.0 * x) as i32);
    let turned = |triangle: &[u32; 3]| {
        let corners = triangle.map(place);
        let least = (0..3).min_by_key(|k| corners[*k]).unwrap();
        [0, 1, 2].map(|k| corners[(least + k) % 3])
    };
    let mut found: Vec<_> = mesh.triangles.iter().map(turned).collect();
    found.sort_unstable();
    found
}

#[test]
fn streams_of_meshoptimizer_are_decoded() {
    let file = parse(&good()).unwrap();
    assert!(file.warnings.is_empty(), "{:?}", file.warnings);
    let expected = {
        let corner = |x: i32, z: i32| [2 * (x - 2), 2 * z - 3];
        let cell = |x, z| {
            [
                [corner(x, z), corner(x, z + 1), corner(x + 1, z)],
                [corner(x, z + 1), corner(x + 1, z + 1), corner(x + 1, z)],
            ]
        };
        let mut all: Vec<_> = (0..4).flat_map(|x| (0..3).flat_map(move |z| cell(x, z))).collect();
        all.sort_unstable();
        all
    };
    assert_eq!(places(&file), expected);
    for (positions, normals, indices) in [
        ((POSITIONS, "NONE"), (NORMALS_16, 8), (SHUFFLED, "TRIANGLES")),
        ((EXPONENTIAL, "EXPONENTIAL"), (NORMALS_8, 4), (SEQUENCE, "INDICES")),
    ] {
        let file = parse(&grid(positions, normals, indices)).unwrap();
        assert_eq!(places(&file), expected);
        let mesh = &file.objects[0].mesh;
        for (position, normal) in mesh.positions.iter().zip(&mesh.normals) {
            let Vec3 { x, y, z } = *position;
            assert!((y - 0.25 * x * z).abs() < 1e-3, "{position}");
            let expected = Vec3::new(-0.25 * z, 1.0, -0.25 * x).normalize();
            assert!(normal.distance(expected) < 0.02, "{normal} at {position}, not {expected}");
        }
    }
}

#[test]
fn rotations_and_several_blocks_are_decoded() {
    // Instances, whose rotations are those of the stream.
    let mut builder = Builder::tetrahedron();
    let view = add(&mut builder, &bytes(ROTATIONS), 8, POINTS, "ATTRIBUTES", "QUATERNION");
    let rotation = builder.accessor(json!({
        "bufferView": view, "componentType": 5122, "normalized": true, "count": POINTS, "type": "VEC4"
    }));
    builder.json["nodes"][0]["extensions"] =
        json!({ "EXT_mesh_gpu_instancing": { "attributes": { "ROTATION": rotation } } });
    let file = parse(&builder).unwrap();
    for (k, object) in file.objects.iter().enumerate() {
        let (sin, cos) = (k as f32 * 0.3).sin_cos();
        let odd = (k % 2) as f32;
        let rotation = Quat::from_vec4(Vec4::new(0.6 * sin, 0.8 * odd * sin, 0.8 * (1.0 - odd) * sin, cos)).normalize();
        let (found, expected) = (object.world_from_object.transform_vector3(Vec3::ONE), rotation * Vec3::ONE);
        assert!(found.distance(expected) < 1e-3, "{k}: {found}, not {expected}");
    }
    // 300 × 4 words as the indices of triangles: their first word is the element's number.
    let mut builder = Builder::tetrahedron();
    let view = add(&mut builder, &bytes(BLOCKS), 16, 300, "ATTRIBUTES", "NONE");
    let mut heights = Vec::new();
    let mut random = 1u32;
    for k in 0..300u32 {
        random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        heights.push([k, 3 * k + (random >> 30), random >> 24, 7].map(f64::from));
    }
    let positions = builder.accessor(json!({
        "bufferView": view, "byteOffset": 0, "componentType": 5123, "count": 300, "type": "VEC3"
    }));
    builder.json["meshes"][0]["primitives"][0] = json!({ "attributes": { "POSITION": positions } });
    let mesh = &parse(&builder).unwrap().objects[0].mesh;
    // Words of 32 bits read as pairs of 16: x is the first word, z the lower half of the second.
    for (position, numbers) in mesh.positions.iter().zip(&heights) {
        assert_eq!([position.x, position.y, position.z].map(f64::from), [numbers[0], 0.0, numbers[1]]);
    }
}

#[test]
fn damaged_streams_are_refused() {
    let fault = |pointer: &str, value: Value| {
        let mut builder = good();
        *builder.json.pointer_mut(&format!("/bufferViews/{pointer}")).unwrap() = value;
        parse(&builder).map_or_else(|error| error, |_| "read".to_owned())
    };
    let extension = |key: &str| format!("0/extensions/EXT_meshopt_compression/{key}");
    for (key, value, text) in [
        ("count", json!(200), "whose stream is damaged"),
        ("count", json!(u64::MAX), "of 18446744073709551615 elements of 12 bytes, more than 139 bytes can stand for"),
        ("count", json!(1_000_000), "of 1000000 elements of 12 bytes, more than 139 bytes can stand for"),
        ("count", json!(-1), "whose count is missing or no whole number"),
        ("byteStride", json!(0), "which is not allowed"),
        ("byteStride", json!(10), "which is not allowed"),
        ("byteStride", json!(300), "which is not allowed"),
        ("byteLength", json!(100), "whose stream is damaged"),
        ("byteLength", json!(u64::MAX), "beyond its buffer"),
        ("byteOffset", json!(1), "whose stream is damaged"),
        ("byteOffset", json!(u64::MAX), "beyond its buffer"),
        ("buffer", json!(3), "names buffers[3]"),
        ("mode", json!("TRIANGLES"), "of the mode \"TRIANGLES\" with 20 elements of 12 bytes"),
        ("mode", json!("SOUP"), "of the mode \"SOUP\""),
        ("mode", json!(1), "whose mode is no text"),
        ("filter", json!("OCTAHEDRAL"), "with the filter \"OCTAHEDRAL\" on elements of 12 bytes"),
    ] {
        let message = fault(&extension(key), value.clone());
        assert!(message.starts_with("a.glb: bufferViews[0]: ") && message.contains(text), "{key} = {value}: {message}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, ..ProptestConfig::default() })]

    /// Whatever bytes change: a file is read or refused.
    #[test]
    fn changed_bytes_do_no_harm(changes in proptest::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..4)) {
        for indices in [(TRIANGLES, "TRIANGLES"), (SHUFFLED, "TRIANGLES"), (SEQUENCE, "INDICES")] {
            let mut builder = grid((EXPONENTIAL, "EXPONENTIAL"), (NORMALS_16, 8), indices);
            for (index, byte) in &changes {
                let at = index.index(builder.bytes.len());
                builder.bytes[at] = *byte;
            }
            let _ = parse(&builder);
        }
    }
}
