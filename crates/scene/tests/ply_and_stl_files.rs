//! Meshes from PLY and STL files, and what is said of damaged ones.

use std::{fs, path::Path};

use diacaustic_scene::{Mesh, MeshOptions, load_scene, parse_ply, parse_stl};
use glam::{Vec2, Vec3};
use proptest::prelude::*;

const CUBE: &str =
    "ply\nformat ascii 1.0\ncomment a cube\nelement vertex 8\nproperty float x\nproperty float y\nproperty float z
element face 6\nproperty list uchar int vertex_indices\nend_header
0 0 0\n0 0 1\n0 1 1\n0 1 0\n1 0 0\n1 0 1\n1 1 1\n1 1 0
4 0 1 2 3\n4 7 6 5 4\n4 0 4 5 1\n4 1 5 6 2\n4 2 6 7 3\n4 3 7 4 0\n";

fn ply(bytes: &[u8]) -> Result<Mesh, String> {
    let read = parse_ply(bytes, Path::new("m.ply"), &MeshOptions::default());
    read.map(|file| file.mesh).map_err(|error| error.to_string())
}

fn stl(bytes: &[u8]) -> Result<Mesh, String> {
    let read = parse_stl(bytes.to_vec(), Path::new("m.stl"), &MeshOptions::default());
    read.map(|file| file.mesh).map_err(|error| error.to_string())
}

/// A binary PLY of one triangle with normals, texture coordinates and colours.
fn binary_ply(big_endian: bool) -> Vec<u8> {
    let format = if big_endian { "binary_big_endian" } else { "binary_little_endian" };
    let names = ["x", "y", "z", "nx", "ny", "nz", "s", "t"].map(|name| format!("property double {name}\n")).concat();
    let colors = ["red", "green", "blue"].map(|name| format!("property uchar {name}\n")).concat();
    let mut bytes = format!(
        "ply\nformat {format} 1.0\nelement vertex 3\n{names}{colors}element face 1\nproperty uchar kind\n\
         property list uint ushort vertex_index\nend_header\n"
    )
    .into_bytes();
    let double = |x: f64| if big_endian { x.to_be_bytes() } else { x.to_le_bytes() };
    for corner in [[0.0, 0.0], [2.0, 0.0], [0.0, 3.0]] {
        for number in [corner[0], corner[1], 0.0, 0.0, 0.0, 4.0, corner[0], corner[1]] {
            bytes.extend(double(number));
        }
        bytes.extend([255, 188, 0]);
    }
    bytes.push(7);
    bytes.extend(if big_endian { 3u32.to_be_bytes() } else { 3u32.to_le_bytes() });
    for index in [0u16, 1, 2] {
        bytes.extend(if big_endian { index.to_be_bytes() } else { index.to_le_bytes() });
    }
    bytes
}

/// A binary STL of a tetrahedron.
fn binary_stl(header: &[u8]) -> Vec<u8> {
    let corners = [[0.0f32, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let mut bytes = header.to_vec();
    bytes.resize(80, b' ');
    bytes.extend(4u32.to_le_bytes());
    for triangle in [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]] {
        bytes.extend([0; 12]);
        bytes.extend(triangle.into_iter().flat_map(|corner: usize| corners[corner]).flat_map(f32::to_le_bytes));
        bytes.extend([0; 2]);
    }
    bytes
}

const TEXT_STL: &str =
    "solid a b\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet
endsolid a b\n";

#[test]
fn text_and_binary_are_read() {
    let cube = ply(CUBE.as_bytes()).unwrap();
    assert_eq!((cube.triangles.len(), cube.open_edges()), (12, 0));
    // Its sides meet at right angles: a corner has three normals.
    assert_eq!((cube.positions.len(), cube.normals.len()), (24, 24));
    for big_endian in [false, true] {
        let mesh = ply(&binary_ply(big_endian)).unwrap();
        assert_eq!(mesh.positions, [Vec3::ZERO, 2.0 * Vec3::X, 3.0 * Vec3::Y]);
        assert_eq!((mesh.triangles[0], mesh.normals[2], mesh.uvs[1]), ([0, 1, 2], Vec3::Z, Vec2::new(2.0, 0.0)));
        // 188 of 255 is about half as bright as 255.
        assert!(mesh.colors[0].abs_diff_eq(Vec3::new(1.0, 0.5029, 0.0), 1e-3), "{}", mesh.colors[0]);
    }
    for header in [b"binary".as_slice(), b"solid but binary"] {
        let mesh = stl(&binary_stl(header)).unwrap();
        assert_eq!((mesh.triangles.len(), mesh.positions.len(), mesh.open_edges()), (4, 4, 0));
        assert!(mesh.normals.is_empty(), "its facets meet at sharp edges");
    }
    assert_eq!(stl(TEXT_STL.as_bytes()).unwrap().triangles, [[0, 1, 2]]);
}

#[test]
fn damaged_files_get_a_clear_message() {
    let cube = |from: &str, to: &str| ply(CUBE.replacen(from, to, 1).as_bytes()).unwrap_err();
    let cases = [
        (ply(b"").unwrap_err(), "is not a PLY file"),
        (ply(b"solid").unwrap_err(), "is not a PLY file"),
        (cube("end_header", ""), "is not a PLY file"),
        (cube("ascii 1.0", "braille 1.0"), "is not a PLY file"),
        (cube("vertex 8", "vertex -8"), "is not a PLY file"),
        (cube("vertex 8", "vertex 18446744073709551615"), "more than its"),
        (cube("vertex 8", "vertex 9"), "is cut off: it has 5 of 6 face"),
        (cube("vertex 8", "vertex 7"), "but 7 vertices, from 0"),
        (cube("face 6", "face 7"), "is cut off: it has 6 of 7 face"),
        (cube("face 6", "face 0"), "has no faces"),
        (cube("float x", "float w"), "has vertices without the property \"x\""),
        (cube("vertex_indices", "edges"), "has faces without the list \"vertex_indices\""),
        (cube("4 0 1 2 3", "4 0 1 2 8"), "has the vertex 8 in face 0, but 8 vertices, from 0"),
        (cube("4 0 1 2 3", "4 0 1 2 -1"), "has the vertex 4294967295 in face 0"),
        (cube("4 0 1 2 3", "5 0 1 2 3"), "cannot be read at the face 0"),
        (cube("4 0 1 2 3", "a"), "cannot be read at the face 0"),
        (cube("0 0 1", "0 0 nan"), "cannot be read at the vertex 1"),
        (cube("0 0 1", "0 0 1e39"), "has a number that is not finite at vertex 1"),
        (ply(b"ply\nformat ascii 1.0\nelement face 99\nend_header\n").unwrap_err(), "more than its 0 bytes"),
        (
            ply(b"ply\nformat binary_little_endian 1.0\nelement x 18446744073709551615\nend_header\n").unwrap_err(),
            "has 18446744073709551615 of the element \"x\", which has no properties",
        ),
        (ply(&binary_ply(false)[..binary_ply(false).len() - 1]).unwrap_err(), "cannot be read at the face 0"),
        (stl(b"").unwrap_err(), "is not a whole STL file"),
        (stl(&binary_stl(b"")[..200]).unwrap_err(), "is not a whole STL file"),
        (stl(&[255; 84]).unwrap_err(), "is not a whole STL file"),
        (stl(&[0; 84]).unwrap_err(), "has no triangles"),
        (stl(TEXT_STL.replace("0 1 0", "0 inf 0").as_bytes()).unwrap_err(), "is not a whole STL file"),
        (stl(TEXT_STL.replace("vertex 0 1 0\n", "").as_bytes()).unwrap_err(), "is not a whole STL file"),
        (stl(&TEXT_STL.as_bytes()[..100]).unwrap_err(), "is not a whole STL file"),
    ];
    for (message, text) in cases {
        assert!(message.contains(text) && message.starts_with("m."), "{message:?} must say {text:?}");
        assert!(!message.contains('\n'), "{message:?}");
    }
    let mut bytes = binary_stl(b"");
    bytes[96..100].copy_from_slice(&f32::NAN.to_le_bytes());
    assert!(stl(&bytes).unwrap_err().contains("in triangle 0; all numbers must be finite"));
}

#[test]
fn a_scene_file_takes_meshes_of_both() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("cube.ply"), CUBE).unwrap();
    fs::write(folder.path().join("tip.stl"), binary_stl(b"")).unwrap();
    let load = |objects: &str| {
        let path = folder.path().join("scene.toml");
        let text = format!(
            "camera = {{ position = [0, 2, 5], look_at = [0, 0, 0], vertical_fov = 40 }}
             materials.glass = {{ type = \"dielectric\", ior = 1.5 }}
             [[lights]]\ntype = \"point\"\nposition = [0, 5, 0]\nflux = 100\n{objects}"
        );
        fs::write(&path, text).unwrap();
        load_scene(&path).map(|loaded| loaded.scene).map_err(|error| error.to_string())
    };
    let object = |mesh: &str, keys: &str| format!("[[objects]]\nmesh = \"{mesh}\"\n{keys}\n");
    let glass = "material = \"glass\"";
    let round = format!("{glass}\ncrease_angle = 100");
    let scene =
        load(&[object("cube.ply", glass), object("tip.stl", glass), object("cube.ply", &round)].concat()).unwrap();
    let names: Vec<_> = scene.objects.iter().map(|object| object.name.as_str()).collect();
    assert_eq!(names, ["cube", "tip", "cube 2"]);
    assert_eq!(scene.objects.iter().map(|object| object.mesh.positions.len()).collect::<Vec<_>>(), [24, 4, 8]);
    let error = load(&object("cube.ply", "")).unwrap_err();
    assert!(error.contains("the object has no material; name one of [materials]"), "{error}");
    let error = load(&object("cube.ply", "crease_angle = 200\nmaterial = \"glass\"")).unwrap_err();
    assert!(error.contains("crease_angle is 200; it must be from 0 to 180"), "{error}");
    let error = load(&object("cube.off", glass)).unwrap_err();
    assert!(error.contains("meshes are read from OBJ, PLY, STL and glTF files"), "{error}");
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, ..ProptestConfig::default() })]

    /// Whatever bytes change: a file is read or refused.
    #[test]
    fn changed_bytes_do_no_harm(changes in proptest::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..6)) {
        for mut bytes in [CUBE.as_bytes().to_vec(), binary_ply(false), binary_ply(true), binary_stl(b"a"), TEXT_STL.into()] {
            for (index, byte) in &changes {
                let at = index.index(bytes.len());
                bytes[at] = *byte;
            }
            let _ = ply(&bytes);
            let _ = stl(&bytes);
        }
    }
}
