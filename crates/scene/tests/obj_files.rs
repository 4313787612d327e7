//! Meshes and materials from OBJ and MTL text.

use std::{fs, path::Path};

use diacaustic_scene::{
    Chart, Dispersion, Material, MaterialKind, Mesh, MeshOptions, ObjFile, ReadOptions, Warning, load_obj, parse_obj,
};
use glam::{Vec2, Vec3};

const TRIANGLE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

fn parse(text: &str) -> ObjFile {
    parse_obj(text.as_bytes(), Path::new("/nowhere/m.obj"), &MeshOptions::default()).unwrap()
}

fn error(text: &str) -> String {
    parse_obj(text.as_bytes(), Path::new("m.obj"), &MeshOptions::default()).unwrap_err().to_string()
}

/// The materials and warnings of a file whose one face has the MTL material `m`, with these lines.
fn material(lines: &str) -> (Option<Material>, Vec<Warning>) {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("my lib.mtl"), format!("# a library\n\n  newmtl m\n{lines}")).unwrap();
    let path = folder.path().join("m.obj");
    fs::write(&path, format!("mtllib my lib.mtl\n{TRIANGLE}usemtl m\nf 1 2 3\nf 3 2 1\n")).unwrap();
    let file = load_obj(&path, &MeshOptions::default()).unwrap();
    (file.materials[0].clone(), file.warnings)
}

fn kind(lines: &str) -> MaterialKind {
    let (material, warnings) = material(lines);
    assert_eq!(warnings, []);
    material.unwrap().kind
}

fn library_problem(lines: &str) -> String {
    match material(lines) {
        (None, warnings) => warnings[0].to_string(),
        (material, _) => panic!("accepted as {material:?}"),
    }
}

#[test]
fn a_triangle_is_read() {
    let file = parse(&format!("# comment\n{TRIANGLE}f 1 2 3 # one face\n"));
    let expected = Mesh {
        positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y],
        triangles: vec![[0, 1, 2]],
        chart: Chart::Automatic,
        ..Mesh::default()
    };
    assert_eq!(file, ObjFile { mesh: expected, materials: Vec::new(), warnings: Vec::new() });
}

#[test]
fn polygons_become_fans_and_vertices_are_shared() {
    let mesh = parse("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv -1 0.5 0\nf 1 2 3 4 5\nf -5 -4 -3 -2\n").mesh;
    assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 1, 2], [0, 2, 3]]);
    assert_eq!(mesh.positions.len(), 5);
}

#[test]
fn groups_are_one_mesh() {
    let mesh = parse(&format!("o a\ng b\n{TRIANGLE}f 1 2 3\no c\nv 0 0 1\ng\nf 1 2 4\ns off\n")).mesh;
    assert_eq!((mesh.triangles.len(), mesh.positions.len()), (2, 4));
    assert!(mesh.material_slots.is_empty() && mesh.triangle_slots.is_empty());
}

#[test]
fn texture_coordinates_and_normals_split_vertices() {
    let text =
        format!("{TRIANGLE}v 1 1 0\nvt 0 0\nvt 1 0 0\nvt 0.5\nvn 0 0 2\nf 1/1/1 2/2/1 3/3/1\nf 2/1/1 4/2/1 3/3/1\n");
    let ObjFile { mesh, warnings, .. } = parse(&text);
    assert_eq!(warnings, []);
    assert_eq!(mesh.positions.len(), 5);
    assert_eq!(mesh.uvs[1..4], [Vec2::X, Vec2::new(0.5, 0.0), Vec2::ZERO]);
    assert_eq!(mesh.normals, [Vec3::Z; 5]);
}

#[test]
fn slots_follow_usemtl() {
    let text =
        format!("{TRIANGLE}f 1 2 3\nusemtl red wine\nf 1 2 3\nusemtl blue\nusemtl unused\nusemtl red wine\nf 3 2 1\n");
    let ObjFile { mesh, materials, .. } = parse(&text);
    assert_eq!(mesh.material_slots, ["", "red wine"]);
    assert_eq!(mesh.triangle_slots, [0, 1, 1]);
    assert_eq!(materials, [None, None]);
    let single = parse(&format!("{TRIANGLE}usemtl a\nf 1 2 3\n")).mesh;
    assert_eq!((single.material_slots, single.triangle_slots), (vec!["a".to_owned()], vec![]));
}

#[test]
fn unusable_normals_become_the_facets() {
    let text = format!("{TRIANGLE}v 0 0 1\nvn 0 0 0\nvn nan 0 0\nvn 1e30 0 0\nf 1//1 2//2 3//3\nf 1//1 4//3 2\n");
    let ObjFile { mesh, warnings, .. } = parse(&text);
    assert_eq!(warnings, [Warning::ReplacedNormals { path: "/nowhere/m.obj".into(), count: 4 }]);
    let normals = |triangle: usize| mesh.triangles[triangle].map(|vertex| mesh.normals[vertex as usize]);
    assert_eq!(normals(0), [Vec3::Z, Vec3::Z, Vec3::X]);
    assert_eq!(normals(1), [Vec3::Y, Vec3::X, Vec3::Y]);
    assert_eq!(mesh.corners(1), [Vec3::ZERO, Vec3::Z, Vec3::X]);
    assert!(mesh.normals.iter().all(|normal| normal.is_normalized()));
}

#[test]
fn partial_texture_coordinates_are_dropped() {
    let ObjFile { mesh, warnings, .. } = parse(&format!("{TRIANGLE}vt 0 0\nf 1/1 2/1 3\n"));
    assert!(mesh.uvs.is_empty());
    assert_eq!(warnings, [Warning::PartialTexcoords { path: "/nowhere/m.obj".into(), count: 1, corners: 3 }]);
}

#[test]
fn odd_lines_are_read_as_meant() {
    assert_eq!(parse("v 0 0 0 1\nv 2 0 0 2\nv 0 1 0 0.1 0.2 0.3\nf 1 2 3\n").mesh.positions[1], Vec3::X);
    assert_eq!(parse(&format!("{TRIANGLE}f 1 2 \\\n3\n")).mesh.triangles.len(), 1);
    assert_eq!(parse(&format!("{TRIANGLE}\r\nf 1 2 3\r\n")).mesh.triangles.len(), 1);
    assert_eq!(parse(&format!("{TRIANGLE}l 1 2 3\np 1\nf 1 2 3\n")).mesh.triangles.len(), 1, "a polyline is no face");
    let short = parse(&format!("{TRIANGLE}f 1 2\nf 1\nf 1 2 3\n"));
    assert_eq!(short.warnings, [Warning::SkippedFaces { path: "/nowhere/m.obj".into(), count: 2 }]);
}

#[test]
fn faults_are_named_with_their_line() {
    let cases = [
        ("", "m.obj: the file has no faces (f lines with 3 or more corners)"),
        (TRIANGLE, "m.obj: the file has no faces (f lines with 3 or more corners)"),
        ("v 0 0\n", "m.obj:1: v with 2 numbers; a vertex takes x y z"),
        ("\nv 0 x 0\n", "m.obj:2: v with \"x\", which is not a number"),
        ("v 0 nan 0\n", "m.obj:1: v with NaN; it must be finite and less than 3.4e38"),
        ("v 0 1e39 0\n", "m.obj:1: v with inf; it must be finite and less than 3.4e38"),
        ("v 0 1 0 0\n", "m.obj:1: v with the weight 0; it must not be 0"),
        ("vt\n", "m.obj:1: vt without numbers; it takes u and v"),
        ("vn 0 1\n", "m.obj:1: vn with 2 numbers; a normal takes x y z"),
        ("usemtl\n", "m.obj:1: usemtl without the name of a material"),
        ("v 0 0 0\nf 1 1 2\n", "m.obj:2: face index 2 for the vertex (v), of which there are 1 so far"),
        ("v 0 0 0\nf 1 1 -2\n", "m.obj:2: face index -2 for the vertex (v), of which there are 1 so far"),
        ("v 0 0 0\nf 1 1 0\n", "m.obj:2: face index 0 for the vertex (v); indices start at 1"),
        ("v 0 0 0\nf 1/1 1 1\n", "m.obj:2: face index 1 for the texture coordinate (vt), of which there are 0 so far"),
        ("v 0 0 0\nf 1//-1 1 1\n", "m.obj:2: face index -1 for the normal (vn), of which there are 0 so far"),
        ("v 0 0 0\nf 1 1 a\n", "m.obj:2: face index \"a\" is not a whole number"),
        ("v 0 0 0\nf 1 1 /\n", "m.obj:2: face corner \"/\"; it must be v, v/vt, v//vn or v/vt/vn"),
        ("v 0 0 0\nf 1 1 1///1\n", "m.obj:2: face corner \"1///1\"; it must be v, v/vt, v//vn or v/vt/vn"),
        (
            "v 0 0 0\nf 1 1 -9223372036854775808\n",
            "m.obj:2: face index -9223372036854775808 for the vertex (v), of which there are 1 so far",
        ),
    ];
    for (text, message) in cases {
        assert_eq!(error(text), message, "for {text:?}");
    }
    let missing = load_obj(Path::new("/nowhere/m.obj"), &MeshOptions::default()).unwrap_err().to_string();
    assert_eq!(missing, "/nowhere/m.obj: the file cannot be read: No such file or directory (os error 2)");
}

#[test]
fn mtl_materials_become_the_nearest_kind() {
    assert_eq!(kind(""), MaterialKind::Diffuse { albedo: Vec3::splat(0.8) });
    assert_eq!(kind("Kd 0.1 0.2 0.3\nillum 1\n"), MaterialKind::Diffuse { albedo: Vec3::new(0.1, 0.2, 0.3) });
    assert_eq!(kind("Kd 0.5\nKs 1 1 1\nNs 0\nillum 2\n"), MaterialKind::Diffuse { albedo: Vec3::splat(0.5) });
    let (diffuse, specular) = (Vec3::splat(0.5), Vec3::splat(0.25));
    assert_eq!(
        kind("Kd .5 .5 .5\nKs .25 .25 .25\nNs 96\nillum 2\nd 1\n"),
        MaterialKind::Phong { ambient: Vec3::ZERO, diffuse, specular, shininess: 96.0 }
    );
    assert_eq!(kind("Ks 0.9\nillum 3\n"), MaterialKind::Mirror { reflectance: Vec3::splat(0.9) });
    let glass = |ior, tint| MaterialKind::Dielectric {
        ior,
        dispersion: Dispersion::None,
        tint,
        absorption: Vec3::ZERO,
        roughness: 0.0,
        priority: 0,
    };
    for illum in [4, 6, 7, 9] {
        assert_eq!(kind(&format!("illum {illum}\n")), glass(1.5, Vec3::ONE));
    }
    assert_eq!(kind("Kd 0 0 0\nNi 1.33\nd 0.2\n"), glass(1.33, Vec3::ONE));
    assert_eq!(kind("Kd 1 0.5 0.5\nNi 1.33\nTr 0.8\n"), glass(1.33, Vec3::new(1.0, 0.5, 0.5)));
    assert_eq!(kind("Kd 0 0 1\nTf 0 1 0\nd -halo 0.2\n"), glass(1.5, Vec3::Y));
}

#[test]
fn mtl_emission_is_radiance_unless_of_glass() {
    let emission = |lines| material(lines).0.unwrap().emission;
    assert_eq!(emission("Kd 0.5\n"), Vec3::ZERO);
    assert_eq!(emission("Ke 12 3 0.5\n"), Vec3::new(12.0, 3.0, 0.5));
    assert_eq!(emission("Ke 12 3 0.5\nillum 4\n"), Vec3::ZERO);
}

#[test]
fn mtl_faults_are_warnings_with_their_line() {
    let ends_with = |lines, end: &str| {
        let problem = library_problem(lines);
        assert!(problem.ends_with(end), "{problem:?} must end with {end:?}");
    };
    ends_with("Kd 1 0\n", "my lib.mtl:4: Kd with 2 numbers; it takes r g b");
    ends_with("Kd\n", "my lib.mtl:4: Kd with 0 numbers; it takes r g b");
    ends_with("Kd 1 0 2\n", "my lib.mtl:4: Kd with 2; it must be from 0 to 1");
    ends_with("Ke -1 0 0\n", "my lib.mtl:4: Ke with -1; it must be 0 or greater and finite");
    ends_with("Kd spectral a.rfl\n", "my lib.mtl:4: Kd with \"spectral\", which is not a number");
    ends_with("\nNi 0\n", "my lib.mtl:5: Ni with 0; it must be greater than 0 and finite");
    ends_with("Ns nan\n", "my lib.mtl:4: Ns with NaN; it must be 0 or greater and finite");
    ends_with("d\n", "my lib.mtl:4: d without a number");
    ends_with("newmtl\n", "my lib.mtl:4: newmtl without a name");
    let (_, warnings) = material("map_Ns a.png\nbump b.png\n");
    let maps = "map_Ns, bump".to_owned();
    assert_eq!(warnings, [Warning::IgnoredTextures { material: "m".to_owned(), maps }]);
}

#[test]
fn material_libraries_outside_the_folder_are_read_on_demand_alone() {
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir(folder.path().join("inner")).unwrap();
    fs::write(folder.path().join("m.mtl"), "newmtl m\nKd 1 0 0\n").unwrap();
    let path = folder.path().join("inner/m.obj");
    fs::write(&path, "mtllib ../m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\nf 1 2 3\n").unwrap();
    let load = |allow_outside| load_obj(&path, &ReadOptions { allow_outside }.into()).unwrap();
    assert!(load(true).materials[0].is_some() && load(true).warnings.is_empty());
    assert!(load(false).materials[0].is_none());
    let warning = load(false).warnings[0].to_string();
    assert!(warning.contains("names the file \"../m.mtl\", which lies outside the folder"), "{warning}");
}
