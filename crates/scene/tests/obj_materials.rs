//! Pictures and materials of MTL files, and the surfaces of OBJ files as they are found.

use std::{fs, path::Path};

use diacaustic_scene::{
    Material, MaterialKind, MeshOptions, ObjFile, ReadOptions, Warning, Wrap, load_obj, load_scene, parse_obj,
};
use glam::{Vec2, Vec3};
use image::{ExtendedColorType, ImageEncoder, codecs::png::PngEncoder};

const TRIANGLE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\n";

fn png(texel: [u8; 4]) -> Vec<u8> {
    let mut bytes = Vec::new();
    PngEncoder::new(&mut bytes).write_image(&texel.repeat(4), 2, 2, ExtendedColorType::Rgba8).unwrap();
    bytes
}

/// A folder of an OBJ file whose face has the material `m` with these lines, and of the picture `a b.png`.
fn folder(lines: &str) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir(folder.path().join("maps")).unwrap();
    fs::write(folder.path().join("maps/a b.png"), png([255, 188, 0, 128])).unwrap();
    fs::write(folder.path().join("m.mtl"), format!("newmtl m\r\n{lines}")).unwrap();
    let obj = format!("mtllib m.mtl\r\n{TRIANGLE}usemtl m\r\nf 1/1 2/2 3/3\r\n");
    fs::write(folder.path().join("m.obj"), obj).unwrap();
    folder
}

fn material(lines: &str) -> (Material, String) {
    let folder = folder(lines);
    let file = load_obj(&folder.path().join("m.obj"), &MeshOptions::default()).unwrap();
    let said = file.warnings.iter().map(|warning| format!("{warning}\n")).collect();
    (file.materials[0].clone().expect("the library defines m"), said)
}

#[test]
fn pictures_lie_as_their_options_say() {
    let (found, said) =
        material("Kd 0.5 1 1\nmap_Kd -s 2 3 -o 0.25 0.5 0 -clamp on maps\\a b.png\nmap_Ka maps/a b.png\n");
    assert_eq!((said.as_str(), found.kind), ("", MaterialKind::Diffuse { albedo: Vec3::new(0.5, 1.0, 1.0) }));
    let texture = found.textures.color.unwrap();
    assert_eq!(texture.wrap, [Wrap::Clamp; 2]);
    assert_eq!(texture.picture_from_uv.transform_point2(Vec2::new(0.5, 0.5)), Vec2::new(1.25, 2.0));
    assert!(texture.at(Vec2::ZERO).truncate().abs_diff_eq(Vec3::new(1.0, 0.5029, 0.0), 1e-3));
    // Without Kd the picture is the colour.
    assert_eq!(material("map_Kd maps/a b.png\n").0.kind, MaterialKind::Diffuse { albedo: Vec3::ONE });
}

#[test]
fn pbr_keys_make_pbr_materials() {
    let (found, said) = material(
        "Kd 1 1 1\nPr 0.5\nPm 1\nmap_Pr -imfchan g maps/a b.png\nmap_Pm maps/a b.png\nnorm -bm 0.5 maps/a b.png\n\
         map_d maps/a b.png\nmap_Ke maps/a b.png\n",
    );
    let MaterialKind::MetallicRoughness { metallic, roughness, .. } = found.kind else { panic!("{:?}", found.kind) };
    assert_eq!((metallic, roughness, said.as_str()), (1.0, 0.5, ""));
    let textures = found.textures;
    assert_eq!((textures.roughness.unwrap().channel, textures.metallic.unwrap().channel), (1, 0));
    assert_eq!((textures.opacity.unwrap().channel, textures.normal.unwrap().strength), (3, 0.5));
    assert!(textures.emission.is_some() && found.emission == Vec3::ONE);
    let coated = MaterialKind::Coated { albedo: Vec3::splat(0.5), ior: 1.5, roughness: 0.1 };
    assert_eq!(material("Kd 0.5\nPc 1\nPcr 0.1\n").0.kind, coated);
    assert!(matches!(material("illum 5\nKs 0.5\n").0.kind, MaterialKind::Mirror { .. }));
}

#[test]
fn glass_is_thin_where_the_mesh_is_open_and_opacity_is_what_d_says() {
    let (sheet, said) = material("d 0.1\nNi 1.4\nKd 1 0.5 1\n");
    assert_eq!(sheet.kind, MaterialKind::ThinWalled { ior: 1.4, tint: Vec3::new(1.0, 0.5, 1.0), roughness: 0.0 });
    assert!(said.contains("is glass on a surface that is not closed"), "{said}");
    // Some exporters write Tr the other way round, beside a right d.
    assert!(matches!(material("d 1\nTr 1\n").0.kind, MaterialKind::Diffuse { .. }));
    let tetrahedron =
        "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nusemtl m\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
    let folder = folder("illum 7\nPr 0.2\n");
    fs::write(folder.path().join("m.obj"), tetrahedron).unwrap();
    let file = load_obj(&folder.path().join("m.obj"), &MeshOptions::default()).unwrap();
    let kind = &file.materials[0].as_ref().unwrap().kind;
    assert!(matches!(kind, MaterialKind::Dielectric { roughness: 0.2, .. }), "{kind:?}");
}

#[test]
fn pictures_that_cannot_be_read_are_named() {
    let told = |lines: &str, text: &str| {
        let (found, said) = material(lines);
        assert!(said.contains(text) && said.contains("\"m\""), "{said} must say {text}");
        assert!(!found.textures.any());
    };
    told("map_Kd none.png\n", "names the file");
    told("map_Kd ../none.png\n", "lies outside the folder");
    told("map_Kd /etc/passwd\n", "lies outside the folder");
    told("map_Kd C:\\maps\\none.png\n", "lies outside the folder");
    told("map_Kd http://example.org/a.png\n", "names the file");
    told("map_Kd m.obj\n", "is neither PNG nor JPEG by its content");
    told("map_Bump maps/a b.png\nmap_Ns a.png\n", "its pictures (map_Bump, map_Ns) are of kinds that are not read");
    // A path of the author's machine, of a file that lies beside the library.
    let folder = folder("map_Kd D:\\work\\c.png\n");
    fs::write(folder.path().join("c.png"), png([255; 4])).unwrap();
    let file = load_obj(&folder.path().join("m.obj"), &MeshOptions::default()).unwrap();
    assert!(file.materials[0].as_ref().unwrap().textures.color.is_some() && file.warnings.is_empty());
    // A mesh without texture coordinates.
    fs::write(folder.path().join("m.obj"), "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\nf 1 2 3\n").unwrap();
    let file = load_obj(&folder.path().join("m.obj"), &MeshOptions::default()).unwrap();
    assert!(
        matches!(&file.warnings[..], [Warning::UnreadPicture { problem, .. }] if problem.contains("no texture coordinates"))
    );
}

#[test]
fn several_libraries_stand_in_one_line() {
    let folder = folder("Kd 1\n");
    let path = folder.path().join("m.obj");
    fs::write(folder.path().join("n.mtl"), "newmtl n\nKd 0\n").unwrap();
    fs::write(&path, format!("mtllib m.mtl n.mtl\n{TRIANGLE}usemtl m\nf 1 2 3\nusemtl n\nf 1 2 3\n")).unwrap();
    let file = load_obj(&path, &MeshOptions::default()).unwrap();
    assert!(file.materials.iter().all(Option::is_some), "{:?}", file.warnings);
}

#[test]
fn a_scene_takes_a_meshs_own_materials_and_tells_what_they_lack() {
    let folder = folder("Kd 0.5\nmap_Kd none.png\n");
    let load = |object: &str| {
        let path = folder.path().join("scene.toml");
        let text = format!(
            "camera = {{ position = [0, 2, 5], look_at = [0, 0, 0], vertical_fov = 40 }}
             materials.glass = {{ type = \"mirror\", reflectance = 1 }}
             [[lights]]\ntype = \"point\"\nposition = [0, 5, 0]\nflux = 100
             [[objects]]\nmesh = \"m.obj\"\n{object}"
        );
        fs::write(&path, text).unwrap();
        load_scene(&path).unwrap()
    };
    let own = load("");
    assert_eq!(own.scene.materials[own.scene.objects[0].materials[0]].name, "m");
    assert!(own.warnings.iter().any(|warning| matches!(warning, Warning::UnreadPicture { .. })));
    let other = load("material = \"glass\"");
    assert!(!other.warnings.iter().any(|warning| matches!(warning, Warning::UnreadPicture { .. })));
}

fn mesh(text: &str) -> ObjFile {
    parse_obj(text.as_bytes(), Path::new("m.obj"), &MeshOptions::default()).unwrap()
}

#[test]
fn smoothing_groups_come_before_the_crease_angle() {
    // A roof of two slopes that meet at right angles.
    let roof = "v 0 0 0\nv 2 0 0\nv 0 1 1\nv 2 1 1\nv 0 0 2\nv 2 0 2\n";
    let faces = "f 1 3 4 2\nf 3 5 6 4\n";
    let vertices = |text: String| mesh(&text).mesh.positions.len();
    assert_eq!(vertices(format!("{roof}{faces}")), 8, "a crease");
    assert_eq!(vertices(format!("{roof}s 1\n{faces}")), 6, "one group");
    assert_eq!(vertices(format!("{roof}s 1\nf 1 3 4 2\ns 2\nf 3 5 6 4\n")), 8, "two groups");
    assert!(mesh(&format!("{roof}s off\n{faces}")).mesh.normals.is_empty(), "flat facets");
    let flat = parse_obj(
        format!("{roof}{faces}").as_bytes(),
        Path::new("m.obj"),
        &MeshOptions { read: ReadOptions::default(), crease_angle: 0.0 },
    );
    assert!(flat.unwrap().mesh.normals.is_empty());
}

#[test]
fn concave_faces_are_covered_once() {
    let arrow = mesh("v 0 0 0\nv 2 2 0\nv 0 1 0\nv -2 2 0\nf 1 2 3 4\n").mesh;
    assert_eq!(arrow.triangles.len(), 2);
    assert!((0..2).all(|triangle| arrow.double_area_normal(triangle).z > 0.0), "{:?}", arrow.triangles);
}

#[test]
fn faults_of_odd_files_are_named() {
    let error = |text: &[u8]| {
        parse_obj(text, Path::new("m.obj"), &MeshOptions::default())
            .map_or_else(|error| error.to_string(), |_| "read".into())
    };
    let corners = " 1".repeat(5000);
    for (text, problem) in [
        (format!("v 0 0 0\nf{corners}\n").into_bytes(), "m.obj:2: f with 5000 corners; a face has at most 4096"),
        (b"s x\n".to_vec(), "m.obj:1: s with \"x\"; it takes a whole number or off"),
        (vec![b'v'; 1 << 25], "m.obj:1: a line of more than 16777216 bytes"),
        (vec![0; 1000], "m.obj: the file has no faces"),
        (vec![255; 1000], "m.obj: the file has no faces"),
        (b"\\\n\\\n\\".to_vec(), "m.obj: the file has no faces"),
        (b"v 0 0 0\nf 99999999999999999999 1 1\n".to_vec(), "is not a whole number"),
        (b"v 0 0 0\nf 4294967297 1 1\n".to_vec(), "of which there are 1 so far"),
    ] {
        let message = error(&text);
        assert!(message.starts_with("m.obj") && message.contains(problem), "{message}");
    }
    let empty: String = (0..1_000_000).map(|number| format!("o part{number}\ng g{number}\n")).collect();
    let sound = format!("v 0 0 0\nv 1 0 0\nv 0 1 0\n{empty}f 1 2 3\n");
    let read = parse_obj(sound.as_bytes(), Path::new("m.obj"), &MeshOptions::default()).unwrap();
    assert_eq!((read.mesh.triangles.len(), read.mesh.material_slots.len()), (1, 0));
    assert!(error(empty.as_bytes()).contains("m.obj: the file has no faces"));
    let many: String = (0..20_000).map(|number| format!("usemtl m{number}\nf 1 1 1\n")).collect();
    let message = error(format!("v 0 0 0\n{many}").as_bytes());
    assert!(message.contains("f with one more than 16384 materials"), "{message}");
}
