//! Surfaces of glTF files: tangents, coverage at vertices, and materials that are glass in part.

mod gltf_file;

use std::path::Path;

use diacaustic_scene::{Blend, GltfFile, GltfOptions, Material, MaterialKind, parse_gltf};
use glam::{Vec2, Vec3, Vec4};
use gltf_file::{Builder, png_of};
use serde_json::{Value, json};

fn parse(builder: &Builder) -> GltfFile {
    let file = parse_gltf(&builder.glb(), Path::new("a.glb"), &GltfOptions::default());
    file.unwrap_or_else(|error| panic!("{error}"))
}

fn said(file: &GltfFile) -> String {
    file.warnings.iter().map(|warning| format!("{warning}\n")).collect()
}

/// A file of one triangle in the plane z = 0 with normals and texture coordinates, and of one material.
fn triangle(material: Value) -> Builder {
    let mut builder = Builder::default();
    let positions = builder.floats("VEC3", &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0]);
    let normals = builder.floats("VEC3", &[0.0, 0.0, 1.0].repeat(3));
    // u along +x, and v down, so that the picture's upper edge is at y = 1.
    let uvs = builder.floats("VEC2", &[0.0, 1.0, 1.0, 1.0, 0.0, 0.0]);
    let attributes = json!({ "POSITION": positions, "NORMAL": normals, "TEXCOORD_0": uvs });
    builder.json["meshes"] = json!([{ "primitives": [{ "attributes": attributes, "material": 0 }] }]);
    builder.json["materials"] = json!([material]);
    builder.json["nodes"] = json!([{ "mesh": 0 }]);
    builder
}

fn add_attribute(builder: &mut Builder, name: &str, accessor: usize) {
    builder.json["meshes"][0]["primitives"][0]["attributes"][name] = json!(accessor);
}

/// The triangle with a normal map, whose picture lies as `info` says.
fn bumpy(info: &Value) -> Builder {
    let mut builder = triangle(json!({ "normalTexture": info }));
    builder.add_picture(&png_of(1, &[[128, 128, 255, 255]]));
    builder
}

fn tangents(file: &GltfFile) -> Vec<Vec4> {
    let object = &file.objects[0];
    let placed = diacaustic_scene::Object {
        name: String::new(),
        mesh: object.mesh.clone(),
        world_from_object: object.world_from_object,
        materials: object.materials.clone(),
        map_size: None,
    };
    placed.corner_tangents(&file.materials).into_flattened()
}

#[test]
fn tangents_are_those_of_the_file_or_else_mikktspaces() {
    let made = parse(&bumpy(&json!({ "index": 0 })));
    assert!(made.objects[0].mesh.tangents.is_empty());
    // The picture's right is +x, and its up, along which green grows, +y = z × x.
    assert_eq!(tangents(&made), [Vec4::new(1.0, 0.0, 0.0, 1.0); 3]);
    let mut builder = bumpy(&json!({ "index": 0 }));
    let stated = [0.6, 0.8, 0.0, -1.0];
    let accessor = builder.floats("VEC4", &stated.repeat(3));
    add_attribute(&mut builder, "TANGENT", accessor);
    let file = parse(&builder);
    assert_eq!((tangents(&file), said(&file).as_str()), (vec![Vec4::from(stated); 3], ""));
    // Unusable ones are made anew, and a surface without normals has none of its own.
    let accessor = builder.floats("VEC4", &[f32::NAN, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 0.0]);
    add_attribute(&mut builder, "TANGENT", accessor);
    assert_eq!(tangents(&parse(&builder)), [Vec4::new(1.0, 0.0, 0.0, 1.0); 3]);
    let accessor = builder.floats("VEC4", &stated.repeat(3));
    add_attribute(&mut builder, "TANGENT", accessor);
    builder.json["meshes"][0]["primitives"][0]["attributes"].as_object_mut().unwrap().remove("NORMAL");
    assert_eq!(tangents(&parse(&builder)), [Vec4::new(1.0, 0.0, 0.0, 1.0); 3]);
    // No normal map, no memory for tangents.
    builder.json["materials"][0] = json!({});
    assert!(parse(&builder).objects[0].mesh.tangents.is_empty());
}

#[test]
fn tangents_turn_with_the_picture_and_with_the_pose() {
    let turned =
        json!({ "index": 0, "extensions": { "KHR_texture_transform": { "rotation": std::f32::consts::FRAC_PI_2 } } });
    let mut builder = bumpy(&turned);
    let made = tangents(&parse(&builder));
    let accessor = builder.floats("VEC4", &[1.0, 0.0, 0.0, 1.0].repeat(3));
    add_attribute(&mut builder, "TANGENT", accessor);
    for (stated, made) in tangents(&parse(&builder)).iter().zip(made) {
        // Turned counter-clockwise, the picture has its right where the texture coordinates go up or down: never along x.
        assert!(stated.abs_diff_eq(made, 1e-6) && made.x.abs() < 1e-6, "{stated}, {made}");
    }
    let mut builder = bumpy(&json!({ "index": 0 }));
    let accessor = builder.floats("VEC4", &[1.0, 0.0, 0.0, 1.0].repeat(3));
    add_attribute(&mut builder, "TANGENT", accessor);
    let bent = builder.floats("VEC3", &[-1.0, 1.0, 0.0].repeat(3));
    builder.json["meshes"][0]["primitives"][0]["targets"] = json!([{ "TANGENT": bent }]);
    builder.json["meshes"][0]["weights"] = json!([1]);
    let expected = Vec4::new(0.0, 1.0, 0.0, 1.0);
    assert!(tangents(&parse(&builder)).iter().all(|tangent| tangent.abs_diff_eq(expected, 1e-6)));
    // A joint that turns by 90° about z.
    builder.json["meshes"][0]["weights"] = json!([0]);
    let joints = builder.view(&[0u8; 12], None);
    let joints = builder.accessor(json!({ "bufferView": joints, "componentType": 5121, "count": 3, "type": "VEC4" }));
    let weights = builder.floats("VEC4", &[1.0, 0.0, 0.0, 0.0].repeat(3));
    add_attribute(&mut builder, "JOINTS_0", joints);
    add_attribute(&mut builder, "WEIGHTS_0", weights);
    builder.json["skins"] = json!([{ "joints": [1] }]);
    let half = 0.5f32.sqrt();
    builder.json["nodes"] = json!([{ "mesh": 0, "skin": 0 }, { "rotation": [0, 0, half, half] }]);
    let found = tangents(&parse(&builder));
    assert!(found.iter().all(|tangent| tangent.abs_diff_eq(expected, 1e-6)), "{found:?}");
}

#[test]
fn coverage_of_vertices_counts_by_alpha_mode() {
    let colors = [1.0, 1.0, 1.0, 0.25, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 2.0];
    let read = |material: Value| {
        let mut builder = triangle(material);
        let accessor = builder.floats("VEC4", &colors);
        add_attribute(&mut builder, "COLOR_0", accessor);
        parse(&builder)
    };
    let shown = |mode: &str| read(json!({ "alphaMode": mode }));
    assert!(shown("OPAQUE").objects[0].mesh.opacities.is_empty());
    for mode in ["BLEND", "MASK"] {
        let file = shown(mode);
        assert_eq!((file.objects[0].mesh.opacities.as_slice(), said(&file).as_str()), (&[0.25, 1.0, 1.0][..], ""));
        let cutoff = (mode == "MASK").then_some(0.5);
        assert_eq!(file.materials[0].opacity_cutoff, cutoff);
        assert_eq!(file.materials[0].opacity_at(Vec2::ZERO, 0.5), if mode == "MASK" { 1.0 } else { 0.5 });
    }
}

fn transmissive(factor: f32, metallic: f32, texture: bool) -> Value {
    let picture = if texture { json!({ "index": 0 }) } else { Value::Null };
    let mut transmission = json!({ "transmissionFactor": factor });
    let mut model = json!({ "metallicFactor": metallic, "roughnessFactor": 0.5, "baseColorFactor": [0.5, 1, 1, 1] });
    if texture {
        transmission["transmissionTexture"] = picture.clone();
        model["metallicRoughnessTexture"] = picture;
    }
    json!({ "pbrMetallicRoughness": model, "extensions": { "KHR_materials_transmission": transmission } })
}

/// The glass and the rest of a material.
fn parts(material: &Material) -> (f32, &Blend) {
    assert!(matches!(material.kind, MaterialKind::ThinWalled { .. }), "{:?}", material.kind);
    let blend = material.blend.as_ref().expect("a blend");
    (blend.share, blend)
}

fn metallic_of(material: &Material) -> f32 {
    let MaterialKind::MetallicRoughness { metallic, base_color, roughness, .. } = material.kind else {
        panic!("{:?}", material.kind)
    };
    assert_eq!((base_color, roughness), (Vec3::new(0.5, 1.0, 1.0), 0.5));
    metallic
}

#[test]
fn glass_in_part_is_a_blend_with_what_is_left() {
    let read = |factor, metallic| parse(&triangle(transmissive(factor, metallic, false))).materials[0].clone();
    let whole = read(1.0, 0.0);
    assert_eq!(whole.kind, MaterialKind::ThinWalled { ior: 1.5, tint: Vec3::new(0.5, 1.0, 1.0), roughness: 0.5 });
    assert_eq!((whole.blend, read(0.0, 0.5).blend, metallic_of(&read(1.0, 1.0))), (None, None, 1.0));
    let half = read(0.25, 0.0);
    let (share, blend) = parts(&half);
    assert_eq!((share, metallic_of(&blend.rest)), (0.25, 0.0));
    assert!(half.is_caster() && half.is_receiver() && !half.is_receiver_alone());
    // glTF: metal · m + (1 − m)(t glass + (1 − t) paint), so a quarter of 0.5 is glass, and of the rest metal has 0.5/0.875.
    let alloy = read(0.25, 0.5);
    let (share, blend) = parts(&alloy);
    assert_eq!((share, metallic_of(&blend.rest)), (0.125, 0.5 / 0.875));
}

#[test]
fn pictures_of_glass_and_metal_are_mixed_texel_by_texel() {
    let mut builder = triangle(transmissive(1.0, 1.0, true));
    // Transmission in red, metal in blue: clear glass, metal whatever its transmission, half glass half metal, paint.
    builder
        .add_picture(&png_of(4, &[[255, 255, 0, 255], [255, 255, 255, 255], [255, 255, 51, 255], [51, 255, 0, 255]]));
    let file = parse(&builder);
    let (_, blend) = parts(&file.materials[0]);
    let (share, metal) = (blend.texture.as_ref().unwrap(), blend.rest.textures.metallic.as_ref().unwrap());
    let at = |column: f32| {
        let uv = Vec2::new((column + 0.5) / 4.0, 0.5);
        [blend.share * share.number_at(uv), metal.number_at(uv)]
    };
    for (column, expected) in [[1.0, 0.0], [0.0, 1.0], [0.8, 1.0], [0.2, 0.0]].into_iter().enumerate() {
        let found = at(column as f32);
        assert!(Vec2::from(found).abs_diff_eq(expected.into(), 2e-3), "texel {column}: {found:?}, not {expected:?}");
    }
    assert_eq!((metallic_of(&blend.rest), said(&file).as_str()), (1.0, ""));
    // Pictures that lie in different ways cannot be mixed.
    let transform = json!({ "KHR_texture_transform": { "scale": [2, 2] } });
    builder.json["materials"][0]["pbrMetallicRoughness"]["metallicRoughnessTexture"]["extensions"] = transform;
    assert!(said(&parse(&builder)).contains("lie in different ways"), "{}", said(&parse(&builder)));
}

#[test]
fn a_rest_that_no_surface_shows_is_left_out() {
    let material = transmissive(1.0, 0.0, false);
    let texels =
        [[255, 0, 0, 255], [255, 0, 0, 255], [255, 0, 0, 255], [255, 0, 0, 255], [0, 0, 0, 255], [0, 0, 0, 255]];
    for (columns, is_blended) in [(2.0, false), (5.0, true)] {
        let mut material = material.clone();
        material["extensions"]["KHR_materials_transmission"]["transmissionTexture"] = json!({ "index": 0 });
        let mut builder = triangle(material);
        builder.add_picture(&png_of(6, &texels));
        let uvs = builder.floats("VEC2", &[0.0, 0.0, columns / 6.0, 0.0, 0.0, 1.0]);
        add_attribute(&mut builder, "TEXCOORD_0", uvs);
        assert_eq!(parse(&builder).materials[0].blend.is_some(), is_blended, "{columns}");
    }
}

#[test]
fn volumes_of_glass_in_part_have_a_rest_as_well() {
    let mut material = transmissive(0.5, 0.0, false);
    material["extensions"]["KHR_materials_volume"] = json!({ "thicknessFactor": 1 });
    let mut builder = Builder::tetrahedron();
    builder.json["materials"] = json!([material]);
    builder.json["meshes"][0]["primitives"][0]["material"] = json!(0);
    let file = parse(&builder);
    assert!(matches!(file.materials[0].kind, MaterialKind::Dielectric { .. }));
    assert_eq!(file.materials[0].blend.as_ref().map(|blend| blend.share), Some(0.5));
}
