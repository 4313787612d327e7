//! glTF files: what of them becomes a scene.

mod gltf_file;

use std::{f32::consts::PI, fs, path::Path, sync::Arc};

use diacaustic_scene::{
    Dispersion, GltfFile, GltfOptions, LightKind, MaterialKind, PLASTIC_REFLECTANCE, TextureFilter, Warning, Wrap,
    load_scene, parse_gltf,
};
use glam::{Vec2, Vec3};
use gltf_file::{Builder, TETRAHEDRON, png};
use serde_json::{Value, json};

fn parse(builder: &Builder) -> Result<GltfFile, String> {
    parse_gltf(&builder.glb(), Path::new("a.glb"), &GltfOptions::default()).map_err(|error| error.to_string())
}

/// A file of one triangle with texture coordinates, and of one material.
fn with_material(material: Value) -> Builder {
    let mut builder = Builder::default();
    let positions = builder.floats("VEC3", &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0]);
    let uvs = builder.floats("VEC2", &[0.0, 0.0, 0.25, 0.0, 0.0, 1.0]);
    builder.json["meshes"] = json!([{ "primitives": [
        { "attributes": { "POSITION": positions, "TEXCOORD_0": uvs }, "material": 0 }
    ] }]);
    builder.json["materials"] = json!([material]);
    builder.json["nodes"] = json!([{ "mesh": 0 }]);
    builder
}

/// A file of a closed tetrahedron of one material.
fn closed_with_material(material: Value) -> Builder {
    let mut builder = Builder::tetrahedron();
    builder.json["materials"] = json!([material]);
    builder.json["meshes"][0]["primitives"][0]["material"] = json!(0);
    builder
}

fn material_kind(builder: &Builder) -> MaterialKind {
    parse(builder).unwrap().materials[0].kind.clone()
}

fn said(warnings: &[Warning]) -> String {
    warnings.iter().map(|warning| format!("{warning}\n")).collect()
}

#[test]
fn json_and_glb_give_the_same() {
    let builder = Builder::tetrahedron();
    let glb = parse(&builder).unwrap();
    let text = parse_gltf(&builder.gltf(), Path::new("a.gltf"), &GltfOptions::default()).unwrap();
    assert_eq!(glb, text);
    let [object] = glb.objects.as_slice() else { panic!("{:?}", glb.objects) };
    assert_eq!((object.mesh.triangles.len(), object.mesh.open_edges()), (4, 0));
    assert!(object.mesh.signed_volume() > 0.0 && object.mesh.normals.is_empty() && object.mesh.uvs.is_empty());
    assert_eq!(object.mesh.material_slots, ["default"]);
    assert_eq!(said(&glb.warnings), "");
}

#[test]
fn every_component_type_strides_and_sparse_values_are_read() {
    let mut builder = Builder::default();
    // Positions of 16 bits, every 8 bytes; the third is replaced by a sparse value.
    let shorts: Vec<u8> =
        [[0i16, 0, 0, 99], [2, 0, 0, 99], [7, 7, 7, 99]].concat().iter().flat_map(|n| n.to_le_bytes()).collect();
    let view = builder.view(&shorts, Some(8));
    let indices = builder.view(&[2u8], None);
    let values = builder.view(&[0i16, 3, 0].iter().flat_map(|n| n.to_le_bytes()).collect::<Vec<_>>(), None);
    let sparse = json!({ "count": 1, "indices": { "bufferView": indices, "componentType": 5121 }, "values": { "bufferView": values } });
    let positions = builder
        .accessor(json!({ "bufferView": view, "componentType": 5122, "count": 3, "type": "VEC3", "sparse": sparse }));
    let normals = builder.view(&[0u8, 0, 127, 0, 0, 127, 0, 0, 127], None);
    let normals = builder.accessor(
        json!({ "bufferView": normals, "componentType": 5120, "normalized": true, "count": 3, "type": "VEC3" }),
    );
    let uvs = builder.view(&[0u8, 255, 51, 0, 255, 255], None);
    let uvs = builder
        .accessor(json!({ "bufferView": uvs, "componentType": 5121, "normalized": true, "count": 3, "type": "VEC2" }));
    for (component, bytes) in
        [(5121, vec![0u8, 1, 2]), (5123, vec![0, 0, 1, 0, 2, 0]), (5125, vec![0, 0, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0])]
    {
        let mut builder = builder.clone();
        let indices = builder.view(&bytes, None);
        let indices = builder
            .accessor(json!({ "bufferView": indices, "componentType": component, "count": 3, "type": "SCALAR" }));
        let attributes = json!({ "POSITION": positions, "NORMAL": normals, "TEXCOORD_0": uvs });
        builder.json["meshes"] = json!([{ "primitives": [{ "attributes": attributes, "indices": indices }] }]);
        builder.json["nodes"] = json!([{ "mesh": 0 }]);
        builder.json["extensionsUsed"] = json!(["KHR_mesh_quantization"]);
        builder.json["extensionsRequired"] = json!(["KHR_mesh_quantization"]);
        let mesh = &parse(&builder).unwrap().objects[0].mesh;
        assert_eq!(mesh.positions, [Vec3::ZERO, 2.0 * Vec3::X, 3.0 * Vec3::Y]);
        assert_eq!(mesh.normals, [Vec3::Z; 3]);
        // The file's v points down.
        assert_eq!(mesh.uvs, [Vec2::new(0.0, 0.0), Vec2::new(0.2, 1.0), Vec2::new(1.0, 0.0)]);
        assert_eq!(mesh.triangles, [[0, 1, 2]]);
    }
}

#[test]
fn strips_fans_and_several_primitives_become_one_mesh() {
    let mut builder = Builder::default();
    let positions = builder.floats("VEC3", &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0]);
    let primitive = |mode: u32, material: u32| json!({ "attributes": { "POSITION": positions }, "mode": mode, "material": material });
    builder.json["materials"] = json!([{ "name": "a" }, { "name": "a" }]);
    builder.json["meshes"] = json!([{ "primitives": [primitive(5, 0), primitive(6, 1), primitive(0, 0)] }]);
    builder.json["nodes"] = json!([{ "mesh": 0, "name": "a/b" }]);
    let file = parse(&builder).unwrap();
    let object = &file.objects[0];
    assert_eq!(object.mesh.triangles, [[0, 1, 2], [1, 3, 2], [5, 6, 4], [6, 7, 4]]);
    assert_eq!((object.mesh.triangle_slots.as_slice(), object.name.as_str()), ([0, 0, 1, 1].as_slice(), "a_b"));
    assert_eq!(object.mesh.material_slots, ["a", "a 2"]);
    assert!(said(&file.warnings).contains("points or lines"));
}

#[test]
fn missing_normals_are_those_of_the_facets() {
    let mut builder = Builder::default();
    let positions = builder.floats("VEC3", &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0]);
    let normals = builder.floats("VEC3", &[1.0, 0.0, 0.0, f32::NAN, 0.0, 0.0, 0.0, 0.0, 0.0]);
    builder.json["meshes"] = json!([{ "primitives": [
        { "attributes": { "POSITION": positions, "NORMAL": normals } }, { "attributes": { "POSITION": positions } }
    ] }]);
    builder.json["nodes"] = json!([{ "mesh": 0 }]);
    let file = parse(&builder).unwrap();
    let mesh = &file.objects[0].mesh;
    assert_eq!(mesh.normals, [Vec3::X, Vec3::Z, Vec3::Z, Vec3::Z, Vec3::Z, Vec3::Z]);
    assert!(said(&file.warnings).contains("2 corners without a usable normal"), "{}", said(&file.warnings));
}

#[test]
fn nodes_place_and_share_meshes() {
    let mut builder = Builder::tetrahedron();
    builder.json["nodes"] = json!([
        { "translation": [1, 0, 0], "scale": [2, 2, 2], "children": [1, 2] },
        { "mesh": 0, "name": "left", "rotation": [0, 0, 0.7, 0.7] },
        { "mesh": 0, "name": "right", "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 3, 0, 1] },
        { "mesh": 0, "name": "elsewhere" }
    ]);
    builder.json["scenes"] = json!([{ "nodes": [3] }, { "nodes": [0] }]);
    builder.json["scene"] = json!(1);
    let file = parse(&builder).unwrap();
    let [left, right] = file.objects.as_slice() else { panic!("{:?}", file.objects) };
    assert!(Arc::ptr_eq(&left.mesh, &right.mesh));
    assert!(left.world_from_object.transform_point3(Vec3::X).abs_diff_eq(Vec3::new(1.0, 2.0, 0.0), 1e-6));
    assert!(right.world_from_object.transform_point3(Vec3::X).abs_diff_eq(Vec3::new(3.0, 6.0, 0.0), 1e-6));
}

#[test]
fn instances_of_a_node_share_its_mesh() {
    let mut builder = Builder::tetrahedron();
    let translations = builder.floats("VEC3", &[0.0, 0.0, 0.0, 5.0, 0.0, 0.0]);
    let extension = json!({ "EXT_mesh_gpu_instancing": { "attributes": { "TRANSLATION": translations } } });
    builder.json["nodes"] = json!([{ "mesh": 0, "translation": [0, 1, 0], "extensions": extension }]);
    builder.json["extensionsRequired"] = json!(["EXT_mesh_gpu_instancing"]);
    let file = parse(&builder).unwrap();
    assert_eq!(file.objects.len(), 2);
    assert!(Arc::ptr_eq(&file.objects[0].mesh, &file.objects[1].mesh));
    assert_eq!(file.objects[1].world_from_object.transform_point3(Vec3::ZERO), Vec3::new(5.0, 1.0, 0.0));
}

#[test]
fn opaque_materials_have_their_numbers_and_pictures() {
    let mut builder = with_material(json!({
        "name": "tile",
        "pbrMetallicRoughness": {
            "baseColorFactor": [0.5, 0.25, 1, 0.5], "metallicFactor": 0.5, "roughnessFactor": 0.75,
            "baseColorTexture": { "index": 0, "extensions": { "KHR_texture_transform": { "scale": [4, 1] } } },
            "metallicRoughnessTexture": { "index": 0 }
        },
        "normalTexture": { "index": 0, "scale": 0.5 },
        "emissiveFactor": [1, 0, 0.5], "emissiveTexture": { "index": 0 },
        "extensions": { "KHR_materials_emissive_strength": { "emissiveStrength": 10 } },
        "alphaMode": "MASK", "alphaCutoff": 0.25
    }));
    builder.add_picture(&png(2, 2, [255, 128, 51, 128]));
    builder.json["samplers"] = json!([{ "wrapS": 33071, "wrapT": 33648, "magFilter": 9728 }]);
    builder.json["textures"] = json!([{ "source": 0, "sampler": 0 }]);
    let file = parse(&builder).unwrap();
    let material = &file.materials[0];
    let kind = MaterialKind::MetallicRoughness {
        base_color: Vec3::new(0.5, 0.25, 1.0),
        reflectance: PLASTIC_REFLECTANCE,
        metallic: 0.5,
        roughness: 0.75,
    };
    assert_eq!((material.name.as_str(), &material.kind), ("tile", &kind));
    assert_eq!(material.emission, Vec3::new(10.0, 0.0, 5.0));
    assert_eq!((material.opacity, material.opacity_cutoff), (0.5, Some(0.25)));
    let textures = &material.textures;
    let color = textures.color.as_ref().unwrap();
    assert_eq!((color.wrap, color.filter), ([Wrap::Clamp, Wrap::Mirror], TextureFilter::Nearest));
    assert!(color.picture_from_uv.transform_point2(Vec2::new(0.5, 0.25)).abs_diff_eq(Vec2::new(2.0, 0.25), 1e-6));
    let shown = color.at(Vec2::splat(0.5));
    assert!(shown.truncate().abs_diff_eq(Vec3::new(1.0, 0.2158, 0.0331), 1e-3), "{shown}");
    let number = |texture: &Option<diacaustic_scene::Texture>| texture.as_ref().unwrap().number_at(Vec2::ZERO);
    assert!((number(&textures.roughness) - 128.0 / 255.0).abs() < 1e-3);
    assert!((number(&textures.metallic) - 0.2).abs() < 1e-3);
    assert!((number(&textures.opacity) - 128.0 / 255.0).abs() < 1e-3);
    assert_eq!(textures.normal.as_ref().unwrap().strength, 0.5);
    assert!(textures.emission.is_some());
    assert_eq!(said(&file.warnings), "");
}

#[test]
fn surfaces_are_seen_from_both_sides_whatever_the_file_says() {
    let read = |sides: Value| parse(&with_material(json!({ "doubleSided": sides }))).unwrap();
    assert_eq!(read(json!(true)), read(json!(false)));
    assert_eq!(said(&read(json!(false)).warnings), "");
}

#[test]
fn pictures_need_texture_coordinates() {
    let texture = json!({ "index": 0 });
    let mut builder = with_material(json!({ "pbrMetallicRoughness": { "baseColorTexture": texture } }));
    builder.add_picture(&png(1, 1, [255; 4]));
    builder.json["meshes"][0]["primitives"][0]["attributes"].as_object_mut().unwrap().remove("TEXCOORD_0");
    let file = parse(&builder).unwrap();
    assert_eq!(file.objects[0].mesh.uvs, [Vec2::Y; 3]);
    assert!(said(&file.warnings).contains("has no TEXCOORD_0"), "{}", said(&file.warnings));
    // The second set, where all pictures take it.
    let texture = json!({ "index": 0, "texCoord": 1 });
    builder.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = texture;
    let uvs = builder.floats("VEC2", &[0.5; 6]);
    builder.json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_1"] = json!(uvs);
    assert_eq!(parse(&builder).unwrap().objects[0].mesh.uvs, [Vec2::splat(0.5); 3]);
    builder.json["materials"][0]["emissiveTexture"] = json!({ "index": 0 });
    let warnings = said(&parse(&builder).unwrap().warnings);
    assert!(warnings.contains("emissiveTexture is not shown"), "{warnings}");
}

#[test]
fn closed_meshes_of_glass_are_volumes() {
    let glass = |volume: Value| {
        closed_with_material(json!({
            "pbrMetallicRoughness": { "baseColorFactor": [1, 0.5, 1, 1], "metallicFactor": 0, "roughnessFactor": 0.25 },
            "extensions": {
                "KHR_materials_transmission": { "transmissionFactor": 1 }, "KHR_materials_ior": { "ior": 1.4 },
                "KHR_materials_volume": volume, "KHR_materials_dispersion": { "dispersion": 0.4 }
            },
            "extras": { "priority": 3 }
        }))
    };
    let thick = glass(json!({ "thicknessFactor": 1, "attenuationColor": [1, 0.5, 0.25], "attenuationDistance": 2 }));
    let MaterialKind::Dielectric { ior, dispersion, tint, absorption, roughness, priority } = material_kind(&thick)
    else {
        panic!("{:?}", material_kind(&thick))
    };
    assert_eq!((ior, tint, roughness, priority), (1.4, Vec3::new(1.0, 0.5, 1.0), 0.25, 3));
    assert_eq!(dispersion, Dispersion::Abbe(50.0));
    let ln2 = std::f32::consts::LN_2;
    assert!(absorption.abs_diff_eq(Vec3::new(0.0, 0.5 * ln2, ln2), 1e-6), "{absorption}");
    let thin = MaterialKind::ThinWalled { ior: 1.4, tint: Vec3::new(1.0, 0.5, 1.0), roughness: 0.25 };
    assert_eq!(material_kind(&glass(json!({ "thicknessFactor": 0 }))), thin);
    let mut open = thick.clone();
    open.json["accessors"][1]["count"] = json!(9);
    let file = parse(&open).unwrap();
    assert_eq!(file.materials[0].kind, thin);
    assert!(said(&file.warnings).contains("not closed"), "{}", said(&file.warnings));
}

#[test]
fn unsupported_extensions_are_named() {
    let not_shown =
        ["anisotropy", "diffuse_transmission", "iridescence", "sheen"].map(|name| format!("KHR_materials_{name}"));
    let of_material: serde_json::Map<_, _> = not_shown.iter().map(|name| (name.clone(), json!({}))).collect();
    let mut builder = with_material(json!({ "name": "car", "extensions": of_material }));
    builder.json["extensionsUsed"] = json!([&not_shown[..], &["EXT_other".to_owned()]].concat());
    let warnings = said(&parse(&builder).unwrap().warnings);
    for name in &not_shown {
        let text = format!("{name} of the material \"car\" is not supported; it shows without it");
        assert!(warnings.contains(&text), "{warnings}");
    }
    assert!(warnings.contains("uses EXT_other, which is not supported; the file shows without it"), "{warnings}");
    let others = ["KHR_draco_mesh_compression", "KHR_texture_basisu", "EXT_texture_webp"].map(str::to_owned);
    for name in not_shown.iter().chain(&others) {
        builder.json["extensionsRequired"] = json!([name]);
        let error = parse(&builder).unwrap_err();
        assert!(
            error.contains(&format!("extensionsRequired: names {name}, which is not supported; export it")),
            "{error}"
        );
    }
}

#[test]
fn vertices_have_colors_unless_all_are_white() {
    let with_colors = |colors: usize, builder: &Builder| {
        let mut builder = builder.clone();
        builder.json["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] = json!(colors);
        parse(&builder).unwrap()
    };
    let mut builder = with_material(json!({ "alphaMode": "BLEND" }));
    let white = builder.floats("VEC3", &[1.0; 9]);
    assert!(with_colors(white, &builder).objects[0].mesh.colors.is_empty());
    let colors = builder.floats("VEC3", &[1.0, 0.5, 0.0, 0.25, 1.0, 1.0, 7.0, -1.0, 0.5]);
    let file = with_colors(colors, &builder);
    let expected = [Vec3::new(1.0, 0.5, 0.0), Vec3::new(0.25, 1.0, 1.0), Vec3::new(1.0, 0.0, 0.5)];
    assert_eq!((file.objects[0].mesh.colors.as_slice(), said(&file.warnings).as_str()), (&expected[..], ""));
    let bytes = builder.view(&[255, 51, 0, 128, 255, 51, 0, 255, 255, 51, 0, 255], None);
    let bytes = json!({ "bufferView": bytes, "componentType": 5121, "normalized": true, "count": 3, "type": "VEC4" });
    let bytes = builder.accessor(bytes);
    let file = with_colors(bytes, &builder);
    assert_eq!(file.objects[0].mesh.colors, [Vec3::new(1.0, 0.2, 0.0); 3]);
    assert_eq!(said(&file.warnings), "");
}

#[test]
fn reflectance_coats_and_unlit_colors_are_those_of_the_extensions() {
    let kind = |metallic: f32, extensions: Value| {
        let material = json!({
            "pbrMetallicRoughness": { "baseColorFactor": [0.5, 0.25, 1, 1], "metallicFactor": metallic },
            "extensions": extensions
        });
        let file = parse(&with_material(material)).unwrap();
        (file.materials[0].clone(), said(&file.warnings))
    };
    let base_color = Vec3::new(0.5, 0.25, 1.0);
    let reflectance = |extensions| match kind(0.5, extensions).0.kind {
        MaterialKind::MetallicRoughness { reflectance, .. } => reflectance,
        other => panic!("{other:?}"),
    };
    let water = reflectance(json!({ "KHR_materials_ior": { "ior": 1.333 } }));
    assert!((water.x - 0.020373).abs() < 1e-6, "{water}");
    let specular = json!({ "specularFactor": 0.5, "specularColorFactor": [1, 0, 2] });
    assert!(reflectance(json!({ "KHR_materials_specular": specular })).abs_diff_eq(Vec3::new(0.02, 0.0, 0.04), 1e-7));
    let matt = kind(0.0, json!({ "KHR_materials_specular": { "specularFactor": 0 } }));
    assert_eq!((matt.0.kind, matt.1.as_str()), (MaterialKind::Diffuse { albedo: base_color }, ""));

    let coat = json!({ "KHR_materials_clearcoat": { "clearcoatFactor": 1, "clearcoatRoughnessFactor": 0.125 } });
    let (varnish, warnings) = kind(0.0, coat.clone());
    let expected = MaterialKind::Coated { albedo: base_color, ior: 1.5, roughness: 0.125 };
    assert_eq!((varnish.kind, warnings.as_str()), (expected, ""));
    let (metal, warnings) = kind(1.0, coat);
    assert!(matches!(metal.kind, MaterialKind::MetallicRoughness { .. }));
    assert!(warnings.contains("KHR_materials_clearcoat over metal"), "{warnings}");
    let (thin, warnings) = kind(0.0, json!({ "KHR_materials_clearcoat": { "clearcoatFactor": 0.25 } }));
    let blend = thin.blend.expect("a coat in part");
    assert!(
        matches!(thin.kind, MaterialKind::Coated { .. })
            && matches!(blend.rest.kind, MaterialKind::MetallicRoughness { .. })
    );
    assert_eq!((blend.share, warnings.as_str()), (0.25, ""));

    let (unlit, _) = kind(1.0, json!({ "KHR_materials_unlit": {} }));
    assert_eq!((unlit.kind, unlit.emission), (MaterialKind::Diffuse { albedo: Vec3::ZERO }, base_color));
}

#[test]
fn punctual_lights_keep_their_intensity() {
    let mut builder = Builder::tetrahedron();
    let spot = json!({ "innerConeAngle": 0.2, "outerConeAngle": 0.5 });
    builder.json["extensions"] = json!({ "KHR_lights_punctual": { "lights": [
        { "type": "directional", "intensity": 683, "color": [1, 0.5, 0] },
        { "type": "point", "intensity": 683, "name": "bulb" },
        { "type": "spot", "intensity": 1366, "spot": spot }
    ] } });
    let node = |light: u32| {
        json!({ "translation": [0, 2, 0], "rotation": [-0.7, 0, 0, 0.7],
        "extensions": { "KHR_lights_punctual": { "light": light } } })
    };
    builder.json["nodes"] = json!([{ "mesh": 0 }, node(0), node(1), node(2), node(2)]);
    let file = parse(&builder).unwrap();
    let names: Vec<_> = file.lights.iter().map(|light| light.name.as_str()).collect();
    assert_eq!(names, ["light", "bulb", "light 2", "light 3"]);
    let LightKind::Distant { direction, irradiance, .. } = file.lights[0].kind else { panic!("{:?}", file.lights[0]) };
    assert!(direction.abs_diff_eq(Vec3::NEG_Y, 1e-6) && irradiance.abs_diff_eq(Vec3::new(1.0, 0.5, 0.0), 1e-6));
    assert!(file.lights[1].kind.strength().abs_diff_eq(Vec3::ONE, 1e-6));
    assert!(file.lights[2].kind.strength().abs_diff_eq(Vec3::splat(2.0), 1e-5));
    let LightKind::Spot { position, outer_angle, .. } = file.lights[2].kind else { panic!("{:?}", file.lights[2]) };
    assert!(position == 2.0 * Vec3::Y && (outer_angle - 0.5f32.to_degrees()).abs() < 1e-4);
}

#[test]
fn cameras_look_along_their_negative_z() {
    let mut builder = Builder::tetrahedron();
    builder.json["cameras"] = json!([
        { "type": "perspective", "perspective": { "yfov": PI / 4.0, "znear": 0.1, "aspectRatio": 1.5 } },
        { "type": "orthographic", "orthographic": { "xmag": 1, "ymag": 1, "zfar": 1, "znear": 0 } }
    ]);
    builder.json["nodes"] = json!([{ "mesh": 0 }, { "camera": 0, "translation": [0, 1, 5] }, { "camera": 1 }]);
    let file = parse(&builder).unwrap();
    let [found] = file.cameras.as_slice() else { panic!("{:?}", file.cameras) };
    assert_eq!((found.camera.position, found.camera.look_at), (Vec3::new(0.0, 1.0, 5.0), Vec3::new(0.0, 1.0, 4.0)));
    assert!((found.camera.vertical_fov - 45.0).abs() < 1e-4 && found.aspect_ratio == Some(1.5));
    assert!(said(&file.warnings).contains("orthographic"));
}

#[test]
fn morph_targets_and_skins_are_at_rest() {
    let mut builder = Builder::tetrahedron();
    let moved = builder.floats("VEC3", &[0.0, 0.0, 2.0].repeat(TETRAHEDRON.len() / 3));
    builder.json["meshes"][0]["primitives"][0]["targets"] = json!([{ "POSITION": moved }]);
    builder.json["meshes"][0]["weights"] = json!([0.5]);
    let position = |builder: &Builder| parse(builder).unwrap().objects[0].mesh.positions[0];
    assert_eq!(position(&builder), Vec3::new(0.0, 0.0, 1.0));
    builder.json["nodes"] = json!([{ "mesh": 0, "weights": [0.0] }]);
    assert_eq!(position(&builder), Vec3::ZERO);

    let mut builder = Builder::tetrahedron();
    let count = TETRAHEDRON.len() / 3;
    let joints = builder.view(&[1u8, 0, 0, 0].repeat(count), None);
    let joints =
        builder.accessor(json!({ "bufferView": joints, "componentType": 5121, "count": count, "type": "VEC4" }));
    let weights = builder.floats("VEC4", &[1.0, 0.0, 0.0, 0.0].repeat(count));
    builder.json["meshes"][0]["primitives"][0]["attributes"]["JOINTS_0"] = json!(joints);
    builder.json["meshes"][0]["primitives"][0]["attributes"]["WEIGHTS_0"] = json!(weights);
    builder.json["skins"] = json!([{ "joints": [1, 2] }]);
    builder.json["nodes"] = json!([
        { "mesh": 0, "skin": 0, "translation": [100, 0, 0] }, {}, { "translation": [0, 7, 0] }
    ]);
    let file = parse(&builder).unwrap();
    assert_eq!(file.objects[0].mesh.positions[0], Vec3::new(0.0, 7.0, 0.0));
    assert_eq!(file.objects[0].world_from_object.translation, glam::Vec3A::ZERO);
}

const SCENE: &str = r#"
    camera = { position = [0, 2, 5], look_at = [0, 0, 0], vertical_fov = 40 }
    [materials]
    glass = { type = "dielectric", ior = 1.5 }
    [[lights]]
    type = "point"
    position = [0, 5, 0]
    flux = 100
"#;

#[test]
fn a_scene_file_takes_objects_from_gltf() {
    let folder = tempfile::tempdir().unwrap();
    let mut builder = closed_with_material(json!({ "name": "clay", "pbrMetallicRoughness": { "metallicFactor": 0 } }));
    builder.json["nodes"] = json!([{ "mesh": 0, "name": "a" }, { "mesh": 0, "name": "a", "translation": [1, 0, 0] }]);
    fs::write(folder.path().join("m.glb"), builder.glb()).unwrap();
    let load = |objects: &str| {
        let path = folder.path().join("scene.toml");
        fs::write(&path, format!("{SCENE}\n{objects}")).unwrap();
        load_scene(&path).map(|loaded| loaded.scene).map_err(|error| error.to_string())
    };
    let mesh = "[[objects]]\nmesh = \"m.glb\"\n";
    let scene = load(&format!("{mesh}scale = 2\ntranslate = [0, 1, 0]\nmap_size = 64\n{mesh}name = \"b\"")).unwrap();
    let names: Vec<_> = scene.objects.iter().map(|object| object.name.as_str()).collect();
    assert_eq!(names, ["a", "a 2", "b a", "b a 2"]);
    assert_eq!(scene.objects[1].world_from_object.transform_point3(Vec3::ZERO), Vec3::new(2.0, 1.0, 0.0));
    assert_eq!((scene.objects[0].map_size, scene.objects[2].map_size), (Some(64), None));
    assert_eq!(scene.materials.len(), 2);
    assert_eq!(scene.objects[3].materials, [1]);
    let scene = load(&format!("{mesh}material_slots = {{ clay = \"glass\" }}")).unwrap();
    assert!(scene.objects.iter().all(|object| object.materials == [0]) && scene.materials.len() == 1);
    let error = load(&format!("{mesh}material_slots = {{ cly = \"glass\" }}")).unwrap_err();
    assert!(error.contains("there is no material slot \"cly\"; did you mean \"clay\"?"), "{error}");
    let error = load(&format!("{mesh}\n[[objects]]\nmesh = \"m.glb\"\nscale = 1e12")).unwrap_err();
    assert!(error.contains("scene.toml:13"), "{error}");
    let error = load("[[objects]]\nmesh = \"none.glb\"").unwrap_err();
    assert!(error.contains("mesh: ") && error.contains("none.glb: the file cannot be read"), "{error}");
}
