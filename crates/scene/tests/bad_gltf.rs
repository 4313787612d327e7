//! glTF files that are damaged or made to do harm: each is refused by one clear message.

mod gltf_file;

use std::{fs, path::Path};

use diacaustic_scene::{GltfOptions, ReadOptions, StudioOptions, load_gltf, load_gltf_scene, parse_gltf};
use gltf_file::{Builder, glb, png};
use proptest::prelude::*;
use serde_json::{Value, json};

fn message(bytes: &[u8]) -> String {
    let read = parse_gltf(bytes, Path::new("bad.glb"), &GltfOptions::default());
    read.map_or_else(|error| error.to_string(), |_| "it was read".to_owned())
}

/// A file with a bit of everything.
fn good() -> Builder {
    let mut builder = Builder::tetrahedron();
    builder.add_picture(&png(2, 2, [255, 128, 51, 128]));
    let values = builder.view(&[0; 12], None);
    let indices = builder.view(&[1], None);
    builder.json["accessors"][0]["sparse"] = json!({
        "count": 1, "indices": { "bufferView": indices, "componentType": 5121 }, "values": { "bufferView": values }
    });
    let uvs = builder.floats("VEC2", &[0.0; 8]);
    let moved = builder.floats("VEC3", &[0.0; 12]);
    let joints = builder.view(&[0; 16], None);
    let joints = builder.accessor(json!({ "bufferView": joints, "componentType": 5121, "count": 4, "type": "VEC4" }));
    let weights = builder.floats("VEC4", &[1.0, 0.0, 0.0, 0.0].repeat(4));
    let places = builder.floats("VEC3", &[0.0; 6]);
    let normals = builder.floats("VEC3", &[0.0, 0.0, 1.0].repeat(4));
    let tangents = builder.floats("VEC4", &[1.0, 0.0, 0.0, 1.0].repeat(4));
    let colors = builder.floats("VEC4", &[0.5; 16]);
    let json = &mut builder.json;
    json["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] = json!(normals);
    json["meshes"][0]["primitives"][0]["attributes"]["TANGENT"] = json!(tangents);
    json["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] = json!(colors);
    json["meshes"][0]["primitives"][0]["material"] = json!(0);
    json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] = json!(uvs);
    json["meshes"][0]["primitives"][0]["attributes"]["JOINTS_0"] = json!(joints);
    json["meshes"][0]["primitives"][0]["attributes"]["WEIGHTS_0"] = json!(weights);
    json["meshes"][0]["primitives"][0]["targets"] = json!([{ "POSITION": moved }]);
    json["samplers"] = json!([{ "wrapS": 33071 }]);
    json["textures"][0]["sampler"] = json!(0);
    json["materials"] = json!([{
        "pbrMetallicRoughness": { "baseColorTexture": { "index": 0 }, "metallicFactor": 0 },
        "normalTexture": { "index": 0, "extensions": { "KHR_texture_transform": { "offset": [0, 1] } } },
        "extensions": {
            "KHR_materials_transmission": { "transmissionFactor": 1 }, "KHR_materials_ior": { "ior": 1.4 },
            "KHR_materials_volume": { "thicknessFactor": 1, "attenuationDistance": 1, "attenuationColor": [1, 0.5, 0] },
            "KHR_materials_dispersion": { "dispersion": 0.4 },
            "KHR_materials_clearcoat": { "clearcoatFactor": 0, "clearcoatRoughnessTexture": { "index": 0 } },
            "KHR_materials_specular": { "specularFactor": 1, "specularColorFactor": [1, 1, 1] }
        }
    }]);
    json["cameras"] = json!([{ "type": "perspective", "perspective": { "yfov": 1, "znear": 1, "aspectRatio": 1 } }]);
    json["extensions"] =
        json!({ "KHR_lights_punctual": { "lights": [{ "type": "spot", "spot": { "outerConeAngle": 1 } }] } });
    json["skins"] = json!([{ "joints": [1] }]);
    json["scenes"] = json!([{ "nodes": [0, 3, 4] }]);
    json["scene"] = json!(0);
    json["nodes"] = json!([
        { "mesh": 0, "children": [1], "weights": [0.5] }, { "mesh": 0, "skin": 0, "children": [2] },
        { "camera": 0, "extensions": { "KHR_lights_punctual": { "light": 0 } } },
        { "mesh": 0, "rotation": [0, 0, 0, 1], "scale": [1, 2, 1], "translation": [0, 0, 1] },
        { "mesh": 0, "extensions": { "EXT_mesh_gpu_instancing": { "attributes": { "TRANSLATION": places } } } }
    ]);
    builder
}

#[test]
fn the_good_file_is_good() {
    let file = parse_gltf(&good().glb(), Path::new("good.glb"), &GltfOptions::default()).unwrap();
    assert_eq!((file.objects.len(), file.lights.len(), file.cameras.len()), (5, 1, 1));
}

/// A change of the JSON of the good file, and what the message says then.
fn faults() -> Vec<(&'static str, Value, &'static str)> {
    vec![
        ("/asset/version", json!("1.0"), "asset: is of glTF version 1.0"),
        ("/asset/version", json!(2), "is not valid glTF: invalid type: integer `2`"),
        (
            "/accessors/0/count",
            json!(5),
            "accessors[0]: has 5 elements of 12 bytes, one every 12 bytes, more than the 48",
        ),
        ("/accessors/0/count", json!(u64::MAX), "accessors[0]: has 18446744073709551615 elements"),
        ("/accessors/0/count", json!(-1), "is not valid glTF"),
        (
            "/accessors/0/count",
            json!(2),
            "accessors[1]: has the index 2 at 1, but meshes[0].primitives[0] has 2 vertices",
        ),
        ("/accessors/0/byteOffset", json!(u64::MAX), "more than the 0 bytes"),
        ("/accessors/0/byteOffset", json!(4), "accessors[0]: has 4 elements"),
        ("/accessors/0/componentType", json!(5124), "accessors[0]: has an unknown componentType"),
        ("/accessors/0/type", json!("VEC2"), "accessors[0]: is of type Vec2, but"),
        ("/accessors/0/type", json!("VEC9"), "accessors[0]: has an unknown type"),
        ("/accessors/0/bufferView", json!(99), "accessors[0]: names bufferViews[99], but the file has"),
        ("/accessors/0/sparse/count", json!(1000), "accessors[0].sparse: has 1000 elements"),
        ("/accessors/0/sparse/indices/componentType", json!(5126), "accessors[0].sparse: has an unknown componentType"),
        ("/accessors/0/sparse/indices/bufferView", json!(2), "accessors[0].sparse: has indices that do not rise"),
        ("/accessors/1/componentType", json!(5126), "accessors[1]: has 12 elements of 4 bytes"),
        ("/accessors/1/componentType", json!(5120), "accessors[1]: is used as indices"),
        ("/accessors/1/count", json!(11), "has 11 corners of triangles; they must be a multiple of 3"),
        ("/bufferViews/0/byteLength", json!(u64::MAX), "bufferViews[0]: takes 18446744073709551615 bytes"),
        ("/bufferViews/0/byteOffset", json!(u64::MAX), "bufferViews[0]: takes 48 bytes from 18446744073709551615"),
        ("/bufferViews/0/buffer", json!(1), "bufferViews[0]: names buffers[1], but the file has 1 buffers"),
        ("/bufferViews/0/byteStride", json!(4), "accessors[0]: has elements of 12 bytes, but its byteStride is 4"),
        ("/bufferViews/0/byteStride", json!(0), "its byteStride is 0"),
        ("/bufferViews/0/byteStride", json!(usize::MAX), "accessors[0]: has 4 elements of 12 bytes"),
        ("/meshes/0/primitives/0/indices", json!(99), "names accessors[99]"),
        (
            "/meshes/0/primitives/0/attributes/TANGENT",
            json!(1),
            "accessors[1]: is of type Scalar, but meshes[0].primitives[0].TANGENT needs Vec4",
        ),
        ("/meshes/0/primitives/0/attributes/COLOR_0", json!(99), "COLOR_0: names accessors[99]"),
        (
            "/meshes/0/primitives/0/targets/0/TANGENT",
            json!(99),
            "meshes[0].primitives[0].targets[0]: names accessors[99]",
        ),
        (
            "/materials/0/extensions/KHR_materials_transmission/transmissionTexture",
            json!({ "index": 9 }),
            "transmissionTexture: names textures[9]",
        ),
        (
            "/materials/0/extensions/KHR_materials_clearcoat/clearcoatFactor",
            json!(2),
            "materials[0]: has 2 as its clearcoatFactor; it must be from 0 to 1",
        ),
        ("/meshes/0/primitives/0/mode", json!(7), "meshes[0].primitives[0]: has an unknown mode"),
        ("/meshes/0/primitives/0/material", json!(3), "names materials[3], but the file has 1 materials"),
        ("/meshes/0/primitives/0/attributes", json!({}), "meshes[0].primitives[0]: has no POSITION"),
        ("/meshes/0/primitives/0/attributes/TEXCOORD_0", json!(0), "is of type Vec3, but"),
        ("/nodes/0/mesh", json!(5), "nodes[0]: names meshes[5], but the file has 1 meshes"),
        ("/nodes/0/children", json!([9]), "nodes[0]: names nodes[9], but the file has 5 nodes"),
        ("/nodes/2/children", json!([0]), "is its own ancestor"),
        ("/nodes/2/children", json!([2]), "nodes[2]: is a child of nodes[1] and of nodes[2]"),
        ("/nodes/0/children", json!([1, 1]), "nodes[1]: is a child of nodes[0] and of nodes[0]"),
        ("/nodes/0/weights", json!([1e300]), "nodes[0]: has a weight of a morph target that is not finite"),
        ("/nodes/3/translation", json!([1e300, 0, 0]), "nodes[3]: has a transform that is not finite"),
        ("/nodes/3/rotation", json!([0, 0, 0, 0]), "nodes[3]: has a rotation whose length is not 1"),
        ("/nodes/1/skin", json!(1), "nodes[1]: names skins[1]"),
        ("/nodes/2/camera", json!(1), "nodes[2]: names cameras[1]"),
        ("/nodes/2/extensions/KHR_lights_punctual/light", json!(1), "nodes[2]: names lights[1]"),
        ("/nodes/4/extensions/EXT_mesh_gpu_instancing/attributes/TRANSLATION", json!("x"), "names accessors["),
        ("/skins/0/joints", json!([77]), "skins[0]: names nodes[77]"),
        ("/skins/0/joints", json!([]), "skins[0]: has no joints"),
        ("/scene", json!(1), "scene: names scenes[1], but the file has 1 scenes"),
        ("/scenes/0/nodes", json!([0, 0]), "scenes[0]: has nodes[0] twice"),
        ("/scenes/0/nodes", json!([50]), "scenes[0]: names nodes[50]"),
        ("/cameras/0/perspective/yfov", json!(0), "cameras[0]: has a yfov of 0"),
        ("/cameras/0/perspective/aspectRatio", json!(-1), "cameras[0]: has an aspectRatio"),
        ("/extensions/KHR_lights_punctual/lights/0/type", json!("area"), "lights[0]: has an unknown type"),
        ("/extensions/KHR_lights_punctual/lights/0/intensity", json!(-1), "lights[0]: has a color times intensity"),
        ("/extensions/KHR_lights_punctual/lights/0/spot/outerConeAngle", json!(9), "lights[0]: has cone angles"),
        (
            "/materials/0/pbrMetallicRoughness/metallicFactor",
            json!(2),
            "materials[0]: has 2 as its metallicFactor; it must be from 0 to 1",
        ),
        (
            "/materials/0/pbrMetallicRoughness/baseColorFactor",
            json!([1, 1, 1, -1]),
            "materials[0]: has -1 as its baseColorFactor",
        ),
        ("/materials/0/pbrMetallicRoughness/baseColorTexture/index", json!(4), "names textures[4]"),
        ("/materials/0/emissiveFactor", json!([-1, 0, 0]), "materials[0]: has the emission"),
        ("/materials/0/alphaMode", json!("SOME"), "materials[0]: has an unknown alphaMode"),
        ("/materials/0/extensions/KHR_materials_ior/ior", json!(0), "materials[0]: has the ior 0"),
        (
            "/materials/0/extensions/KHR_materials_dispersion/dispersion",
            json!("a"),
            "materials[0]: has a KHR_materials_dispersion",
        ),
        (
            "/materials/0/extensions/KHR_materials_volume/attenuationDistance",
            json!(0),
            "materials[0]: has an attenuationDistance of 0",
        ),
        (
            "/materials/0/extensions/KHR_materials_volume/attenuationColor",
            json!([9, 0, 0]),
            "materials[0]: has 9 as its attenuationColor",
        ),
        (
            "/materials/0/normalTexture/extensions/KHR_texture_transform",
            json!(4),
            "materials[0]: has a normalTexture with a damaged",
        ),
        (
            "/materials/0/extensions/KHR_materials_clearcoat/clearcoatFactor",
            json!(2),
            "materials[0]: has 2 as its clearcoatFactor",
        ),
        (
            "/materials/0/extensions/KHR_materials_clearcoat/clearcoatRoughnessTexture",
            json!(2),
            "materials[0]: has a KHR_materials_clearcoat with a damaged clearcoatRoughnessTexture",
        ),
        (
            "/materials/0/extensions/KHR_materials_specular/specularFactor",
            json!("a"),
            "materials[0]: has a specularFactor that is not a number",
        ),
        (
            "/materials/0/extensions/KHR_materials_specular/specularColorFactor",
            json!([1, 2]),
            "materials[0]: has a specularColorFactor that is not 3 numbers",
        ),
        ("/meshes/0/primitives/0/attributes/COLOR_0", json!(99), "names accessors[99]"),
        ("/meshes/0/primitives/0/attributes/COLOR_0", json!(2), "is of type Vec2, but"),
        ("/textures/0/source", json!(6), "textures[0]: names images[6]"),
        ("/textures/0/sampler", json!(6), "textures[0]: names samplers[6]"),
        ("/samplers/0/wrapS", json!(6), "textures[0]: has a sampler of an unknown wrap"),
        ("/images/0/bufferView", json!(0), "images[0]: the picture is neither PNG nor JPEG by its content"),
        (
            "/images/0",
            json!({ "uri": "http://example.org/a.png" }),
            "images[0]: names \"http://example.org/a.png\"; only files beside",
        ),
        (
            "/images/0",
            json!({ "uri": "../a.png" }),
            "images[0]: names the file \"../a.png\", which lies outside the folder",
        ),
        ("/images/0", json!({ "uri": "/etc/passwd" }), "images[0]: names the file \"/etc/passwd\", which lies outside"),
        ("/images/0", json!({ "uri": "%2e%2e/a.png" }), "images[0]: names the file \"../a.png\", which lies outside"),
        ("/images/0", json!({ "uri": "none.png" }), "images[0]: names the file"),
        ("/images/0", json!({ "uri": "data:image/png;base64,?" }), "images[0]: has a data URI that is no valid base64"),
        ("/images/0", json!({ "uri": "data:image/png,abc" }), "images[0]: has a data URI of another kind"),
        ("/images/0", json!({}), "images[0]: has neither uri nor bufferView"),
    ]
}

#[test]
fn each_fault_is_named() {
    let mut wrong = Vec::new();
    for (pointer, value, text) in faults() {
        let mut builder = good();
        let (parent, key) = pointer.rsplit_once('/').unwrap();
        let parent = builder.json.pointer_mut(parent).unwrap();
        match parent {
            Value::Array(list) => list[key.parse::<usize>().unwrap()] = value.clone(),
            object => object[key] = value.clone(),
        }
        let message = message(&builder.glb());
        if !message.contains(text) || !message.starts_with("bad.glb: ") {
            wrong.push(format!("{pointer} = {value}: {message}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn files_cut_off_anywhere_are_refused() {
    let whole = good().glb();
    for length in 0..whole.len() {
        assert_ne!(message(&whole[..length]), "it was read", "{length} bytes");
    }
    let bytes = good().bytes;
    let mut text = good();
    text.bytes.truncate(bytes.len() - 1);
    let mut json: Value = serde_json::from_slice(&text.gltf()).unwrap();
    json["buffers"][0]["byteLength"] = json!(bytes.len());
    let message = message(json.to_string().as_bytes());
    assert!(message.contains("buffers[0]: states") && message.contains("cut off"), "{message}");
}

#[test]
fn numbers_that_are_none_are_refused() {
    for bad in [f32::NAN, f32::INFINITY] {
        let mut builder = Builder::tetrahedron();
        builder.bytes[..4].copy_from_slice(&bad.to_le_bytes());
        let message = message(&builder.glb());
        assert!(
            message.contains("meshes[0].primitives[0]: has the position") && message.contains("at vertex 0"),
            "{message}"
        );
    }
    let mut builder = Builder::tetrahedron();
    let last = builder.bytes.len() - 1;
    builder.bytes[last] = 200;
    let message = message(&builder.glb());
    assert!(message.contains("accessors[1]: has the index 200 at 11, but"), "{message}");
}

#[test]
fn memory_is_checked_before_it_is_taken() {
    let mut builder = Builder::tetrahedron();
    builder.json["accessors"][0] = json!({ "componentType": 5126, "count": 1u64 << 40, "type": "VEC3" });
    assert!(message(&builder.glb()).contains("has 1099511627776 elements and no bufferView"));

    // One list of 2^20 triangles, used by 200 primitives.
    let mut builder = Builder::default();
    let positions = builder.floats("VEC3", &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0]);
    let indices = builder.view(&[0u8, 1, 2].repeat(1 << 20), None);
    let indices =
        builder.accessor(json!({ "bufferView": indices, "componentType": 5121, "count": 3 << 20, "type": "SCALAR" }));
    let primitive = json!({ "attributes": { "POSITION": positions }, "indices": indices });
    builder.json["meshes"] = json!([{ "primitives": [primitive] }]);
    let nodes: Vec<_> = (0..200).map(|_| json!({ "mesh": 0 })).collect();
    builder.json["nodes"] = json!(nodes);
    let message = message(&builder.glb());
    assert!(message.contains("nodes[128]: brings the scene to more than 134217728 triangles"), "{message}");
}

#[test]
fn pictures_that_unpack_to_too_much_are_refused() {
    // The header of a picture of 16384 × 16384 texels; the second one is one too many.
    let mut picture = png(1, 1, [0; 4]);
    picture[16..24].copy_from_slice(&[0, 0, 0x40, 1, 0, 0, 0x40, 0]);
    let checksum = crc(&picture[12..29]);
    picture[29..33].copy_from_slice(&checksum.to_be_bytes());
    let mut builder = good();
    builder.add_picture(&picture);
    let message = message(&builder.glb());
    assert!(message.contains("images[0]: the picture has 16385 × 16384 texels; it must have from"), "{message}");
}

fn crc(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(!0u32, |sum, byte| {
        (0..8).fold(sum ^ u32::from(*byte), |sum, _| if sum & 1 == 1 { sum >> 1 ^ 0xedb8_8320 } else { sum >> 1 })
    })
}

#[test]
fn deep_trees_and_many_nodes_are_no_trouble() {
    let mut builder = Builder::tetrahedron();
    let count = 200_000;
    let nodes: Vec<_> = (0..count)
        .map(|node| if node + 1 < count { json!({ "children": [node + 1] }) } else { json!({ "mesh": 0 }) })
        .collect();
    builder.json["nodes"] = json!(nodes);
    assert_eq!(parse_gltf(&builder.glb(), Path::new("a.glb"), &GltfOptions::default()).unwrap().objects.len(), 1);
    let deep = format!(
        "{{\"asset\":{{\"version\":\"2.0\"}},\"extensions\":{{\"X\":{}1{}}}}}",
        "[".repeat(100_000),
        "]".repeat(100_000)
    );
    assert!(message(deep.as_bytes()).contains("recursion limit"));
    let wide = format!("{{\"asset\":{{\"version\":\"2.0\"}},\"nodes\":[{}{{}}]}}", "{},".repeat(4_000_000));
    assert!(message(wide.as_bytes()).contains("JSON objects; at most 4000000 are read"));
}

#[test]
fn files_outside_the_folder_are_read_on_demand_alone() {
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir(folder.path().join("inner")).unwrap();
    let builder = Builder::tetrahedron();
    fs::write(folder.path().join("a b.bin"), &builder.bytes).unwrap();
    let path = folder.path().join("inner/a.gltf");
    let load = |uri: &str, allow_outside| {
        fs::write(&path, builder.gltf_with_uri(uri)).unwrap();
        load_gltf(&path, &ReadOptions { allow_outside }.into()).map_err(|error| error.to_string())
    };
    assert!(load("../a%20b.bin", true).is_ok());
    let refused = load("../a%20b.bin", false).unwrap_err();
    assert!(
        refused.contains("buffers[0]: names the file \"../a b.bin\"") && refused.contains("--allow-outside"),
        "{refused}"
    );
    assert!(load("..", true).unwrap_err().contains("is no ordinary file"));
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink(folder.path().join("a b.bin"), folder.path().join("inner/link.bin")).unwrap();
        assert!(load("link.bin", false).unwrap_err().contains("outside the folder") && load("link.bin", true).is_ok());
    }
    fs::copy(folder.path().join("a b.bin"), folder.path().join("inner/a.bin")).unwrap();
    assert!(load("./a.bin", false).is_ok());
}

#[test]
fn a_scene_by_itself_names_the_file() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.glb");
    let load = |builder: &Builder| {
        fs::write(&path, builder.glb()).unwrap();
        load_gltf_scene(&path, &StudioOptions::default()).map_err(|error| error.to_string())
    };
    let mut builder = Builder::tetrahedron();
    builder.json["nodes"][0]["scale"] = json!([1e12, 1e12, 1e12]);
    let message = load(&builder).unwrap_err();
    assert!(message.starts_with(&path.display().to_string()) && message.contains("1e9"), "{message}");
    builder.json["nodes"] = json!([]);
    assert!(load(&builder).unwrap_err().contains("its scene has no triangles"));
    fs::write(&path, glb(b"{}", b"")).unwrap();
    let message = load_gltf_scene(&path, &StudioOptions::default()).unwrap_err().to_string();
    assert!(message.contains("missing field `asset`"), "{message}");
}

/// Every number of a JSON value, and every list that could be shorter.
fn places(value: &Value, at: String, found: &mut Vec<String>) {
    match value {
        Value::Object(entries) => entries.iter().for_each(|(key, value)| places(value, format!("{at}/{key}"), found)),
        Value::Array(list) => {
            list.iter().enumerate().for_each(|(index, value)| places(value, format!("{at}/{index}"), found))
        }
        _ => found.push(at),
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, ..ProptestConfig::default() })]

    /// Whatever bytes change: a file is read or refused, and a scene that comes of it is valid or refused.
    #[test]
    fn changed_bytes_do_no_harm(changes in proptest::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..6)) {
        let mut bytes = good().glb();
        for (index, byte) in changes {
            let at = index.index(bytes.len());
            bytes[at] = byte;
        }
        let _ = parse_gltf(&bytes, Path::new("changed.glb"), &GltfOptions::default());
    }

    /// Whatever numbers of the JSON change.
    #[test]
    fn changed_numbers_do_no_harm(
        place in any::<prop::sample::Index>(),
        value in prop_oneof![
            (0u64..20).prop_map(|number| json!(number)), any::<i64>().prop_map(|number| json!(number)),
            any::<f32>().prop_map(|number| json!(number)), Just(json!(1e300)), Just(json!(null)), Just(json!([])), Just(json!("")),
            Just(json!({})), Just(json!(true)),
        ],
    ) {
        let mut builder = good();
        let mut found = Vec::new();
        places(&builder.json, String::new(), &mut found);
        *builder.json.pointer_mut(&found[place.index(found.len())]).unwrap() = value;
        let _ = parse_gltf(&builder.glb(), Path::new("changed.glb"), &GltfOptions::default());
    }
}
