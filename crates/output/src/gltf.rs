//! Scenes with their light as binary glTF.

mod buffer;
mod materials;

use std::{io::Write as _, path::Path};

use gltf_json::{
    Asset, Index, Node, Root, Scene,
    accessor::{ComponentType, Type},
    buffer::Target,
    mesh::{Mode, Primitive, Semantic},
    validation::Checked::Valid,
};

use self::buffer::Bytes;
use crate::{Error, replace::replace};

pub use self::materials::{GltfMaterial, GltfSurface, LightmapNote, ShownPicture};

/// A scene in the world frame, metres, as glTF takes it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct GltfScene {
    /// Its meshes; each becomes a node.
    pub meshes: Vec<GltfMesh>,
    /// Its materials.
    pub materials: Vec<GltfMaterial>,
}

/// A named mesh.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct GltfMesh {
    /// Its name.
    pub name: String,
    /// Its parts, one for each material.
    pub parts: Vec<GltfPart>,
}

/// Triangles of one material.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct GltfPart {
    /// Places, metres, world frame.
    pub positions: Vec<[f32; 3]>,
    /// Unit normals, one for each place, or empty.
    pub normals: Vec<[f32; 3]>,
    /// Sets of texture coordinates, each one for each place; (0, 0) is a picture's upper left corner.
    pub uv_sets: Vec<Vec<[f32; 2]>>,
    /// Places of each triangle's corners, counter-clockwise seen from the front.
    pub triangles: Vec<[u32; 3]>,
    /// Index of the material.
    pub material: usize,
}

/// Writes a scene as binary glTF 2.0 (`.glb`), with its pictures in the same file.
///
/// # Errors
/// If a picture's pixels are not as many as its size says, the scene is larger than the format allows (4 GiB), or the file cannot be
/// written.
pub fn write_glb(path: &Path, scene: &GltfScene) -> Result<(), Error> {
    let failed = |source: String| Error::Write { path: path.to_owned(), source: source.into() };
    let mut bytes = Bytes::default();
    let mut root = Root { asset: Asset { generator: Some(generator()), ..Asset::default() }, ..Root::default() };
    for material in &scene.materials {
        materials::push(&mut root, &mut bytes, material, path)?;
    }
    materials::note_extensions(&mut root);
    for mesh in scene.meshes.iter().filter(|mesh| !mesh.parts.is_empty()) {
        push_mesh(&mut root, &mut bytes, mesh);
    }
    let nodes = (0..root.nodes.len() as u32).map(Index::new).collect();
    root.scenes.push(Scene { extensions: None, extras: None, name: None, nodes });
    root.scene = Some(Index::new(0));
    let binary = bytes.finish(&mut root);
    let json = root.to_vec().map_err(|error| failed(error.to_string()))?;
    let container = container(&json, &binary).ok_or_else(|| failed("the scene takes more than 4 GiB".to_owned()))?;
    replace(path, |file| file.write_all(&container))
}

fn generator() -> String {
    concat!("diacaustic ", env!("CARGO_PKG_VERSION")).to_owned()
}

/// A GLB file of a JSON and a binary chunk; none if it is too long for its header.
fn container(json: &[u8], binary: &[u8]) -> Option<Vec<u8>> {
    let padded = |length: usize| length.next_multiple_of(4);
    let total = 12 + 8 + padded(json.len()) + 8 + padded(binary.len());
    let mut file = Vec::with_capacity(total);
    file.extend(b"glTF");
    for word in [2, u32::try_from(total).ok()?] {
        file.extend(word.to_le_bytes());
    }
    for (kind, chunk, filler) in [(b"JSON", json, b' '), (b"BIN\0", binary, 0)] {
        file.extend((padded(chunk.len()) as u32).to_le_bytes());
        file.extend(kind);
        file.extend(chunk);
        file.resize(file.len() + padded(chunk.len()) - chunk.len(), filler);
    }
    Some(file)
}

fn push_mesh(root: &mut Root, bytes: &mut Bytes, mesh: &GltfMesh) {
    let primitives = mesh.parts.iter().map(|part| primitive(root, bytes, part)).collect();
    let name = Some(mesh.name.clone());
    let mesh = gltf_json::Mesh { extensions: None, extras: None, name: name.clone(), primitives, weights: None };
    let mesh = Some(root.push(mesh));
    root.push(Node {
        camera: None,
        children: None,
        extensions: None,
        extras: None,
        matrix: None,
        mesh,
        name,
        rotation: None,
        scale: None,
        translation: None,
        skin: None,
        weights: None,
    });
}

fn primitive(root: &mut Root, bytes: &mut Bytes, part: &GltfPart) -> Primitive {
    let mut attributes = std::collections::BTreeMap::new();
    let float = ComponentType::F32;
    let positions = bytes.push(root, &part.positions, (float, Type::Vec3), Target::ArrayBuffer);
    bounds(&mut root.accessors[positions.value()], &part.positions);
    attributes.insert(Valid(Semantic::Positions), positions);
    if !part.normals.is_empty() {
        let normals = bytes.push(root, &part.normals, (float, Type::Vec3), Target::ArrayBuffer);
        attributes.insert(Valid(Semantic::Normals), normals);
    }
    for (set, uvs) in part.uv_sets.iter().enumerate() {
        let uvs = bytes.push(root, uvs, (float, Type::Vec2), Target::ArrayBuffer);
        attributes.insert(Valid(Semantic::TexCoords(set as u32)), uvs);
    }
    let corners = part.triangles.as_flattened();
    let indices = bytes.push(root, corners, (ComponentType::U32, Type::Scalar), Target::ElementArrayBuffer);
    Primitive {
        attributes,
        extensions: None,
        extras: None,
        indices: Some(indices),
        material: Some(Index::new(part.material as u32)),
        mode: Valid(Mode::Triangles),
        targets: None,
    }
}

/// States the least and the greatest coordinates, as the format asks of positions.
fn bounds(accessor: &mut gltf_json::Accessor, positions: &[[f32; 3]]) {
    let start = ([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]);
    let (low, high) = positions.iter().fold(start, |(low, high), p| {
        (std::array::from_fn(|k| low[k].min(p[k])), std::array::from_fn(|k| high[k].max(p[k])))
    });
    accessor.min = Some(low.to_vec().into());
    accessor.max = Some(high.to_vec().into());
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Display, Tone};

    fn triangle() -> GltfPart {
        GltfPart {
            positions: vec![[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 3.0, 1.0]],
            normals: vec![[0.0, 0.0, 1.0]; 3],
            uv_sets: vec![vec![[0.0, 0.0]; 3], vec![[0.25, 0.5], [0.75, 0.5], [0.25, 1.0]]],
            triangles: vec![[0, 1, 2]],
            material: 0,
        }
    }

    fn shown(pixels: usize) -> GltfMaterial {
        let picture = ShownPicture {
            width: 2,
            height: 1,
            radiance: vec![[0.5, 0.25, 0.0]; pixels],
            opacity: None,
            uv_set: 1,
            display: Display { exposure: 0.0, tone: Tone::Plain },
        };
        let note = LightmapNote { file: "a \"b\".exr".into(), channels: "back.", tex_coord: 1, quantity: "W/m^2" };
        GltfMaterial { name: "floor".into(), surface: GltfSurface::Shown(picture), lightmap: Some(note) }
    }

    #[test]
    fn the_file_is_valid_and_holds_what_it_was_given() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("scene.glb");
        let glass = GltfSurface::Glass { ior: 1.5, tint: [1.0; 3], roughness: 0.0, absorption: Some([0.0, 1.0, 2.0]) };
        let glass = GltfMaterial { name: "glass".into(), surface: glass, lightmap: None };
        let scene = GltfScene {
            meshes: vec![GltfMesh { name: "card".into(), parts: vec![triangle()] }],
            materials: vec![shown(2), glass],
        };
        write_glb(&path, &scene).unwrap();
        let bytes = std::fs::read(&path).unwrap();
        let word = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap()) as usize;
        assert_eq!((&bytes[..4], word(8), &bytes[16..20]), (&b"glTF"[..], bytes.len(), &b"JSON"[..]));
        let root = Root::from_slice(&bytes[20..20 + word(12)]).unwrap();
        let mut faults = Vec::new();
        gltf_json::validation::Validate::validate(&root, &root, gltf_json::Path::new, &mut |path, error| {
            faults.push(format!("{} {error:?}", path()));
        });
        assert_eq!(faults, [""; 0]);
        assert_eq!(root.extensions_used.len(), 4, "{:?}", root.extensions_used);
        let binary = &bytes[28 + word(12)..];
        let view = &root.buffer_views[root.accessors[0].buffer_view.unwrap().value()];
        let first = view.byte_offset.unwrap().0 as usize;
        let number = |k: usize| f32::from_le_bytes(binary[first + 4 * k..first + 4 * k + 4].try_into().unwrap());
        assert_eq!(std::array::from_fn(number), [0.0, 0.0, 0.0, 2.0, 0.0, 0.0, 0.0, 3.0, 1.0]);
        let view = &root.buffer_views[root.images[0].buffer_view.unwrap().value()];
        let png = &binary[view.byte_offset.unwrap().0 as usize..][..view.byte_length.0 as usize];
        // 0.5 is 188 of 255 in sRGB, 0.25 is 137.
        assert_eq!(image::load_from_memory(png).unwrap().to_rgb8().get_pixel(1, 0).0, [188, 137, 0]);
        let note = r#"{"lightmap":{"file":"a \"b\".exr","channels":"back.","texCoord":1,"quantity":"W/m^2"}}"#;
        assert_eq!(root.materials[0].extras.as_ref().unwrap().get(), note);
    }

    #[test]
    fn a_picture_of_another_size_is_refused() {
        let scene = GltfScene { meshes: Vec::new(), materials: vec![shown(3)] };
        let error = write_glb(Path::new("never.glb"), &scene).unwrap_err();
        assert!(matches!(error, Error::Shape { found: 3, .. }), "{error}");
    }
}
