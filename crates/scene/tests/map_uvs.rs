//! Texture coordinates as energy maps.

mod gltf_file;

use std::{fs, path::Path};

use diacaustic_scene::{Chart, Scene, parse_scene};
use glam::Vec2;
use gltf_file::Builder;
use serde_json::json;

/// A scene whose objects are as stated, in a folder with the meshes `with.obj`, `without.obj` and `second.glb`.
fn scene(objects: &str) -> Result<Scene, String> {
    let folder = tempfile::tempdir().unwrap();
    let positions = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    fs::write(folder.path().join("with.obj"), format!("{positions}vt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n")).unwrap();
    fs::write(folder.path().join("without.obj"), format!("{positions}f 1 2 3\n")).unwrap();
    fs::write(folder.path().join("second.glb"), second_set().glb()).unwrap();
    let text = format!(
        "camera = {{ position = [0, 2, 3], look_at = [0, 0, 0], vertical_fov = 40 }}
         materials.glass = {{ type = \"dielectric\", ior = 1.5 }}
         materials.wall = {{ type = \"diffuse\", albedo = 0.5 }}
         objects = [{objects}]"
    );
    parse(&text, folder.path())
}

fn parse(text: &str, folder: &Path) -> Result<Scene, String> {
    parse_scene(text, folder, "test").map(|loaded| loaded.scene).map_err(|error| error.to_string())
}

/// A triangle with two sets of texture coordinates.
fn second_set() -> Builder {
    let mut builder = Builder::default();
    let positions = builder.floats("VEC3", &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0]);
    let first = builder.floats("VEC2", &[0.0; 6]);
    let second = builder.floats("VEC2", &[0.0, 0.0, 0.25, 0.0, 0.0, 1.0]);
    let attributes = json!({ "POSITION": positions, "TEXCOORD_0": first, "TEXCOORD_1": second });
    builder.json["meshes"] = json!([{ "primitives": [{ "attributes": attributes }] }]);
    builder.json["nodes"] = json!([{ "mesh": 0 }]);
    builder
}

#[test]
fn an_objects_map_is_its_texture_coordinates_where_it_says_so() {
    let with = |more: &str| format!("{{ mesh = \"with.obj\", material = \"wall\"{more} }}");
    let objects = [with(", map_uvs = true"), with(", map_uvs = false"), with("")].join(", ");
    let scene = scene(&objects).unwrap();
    let charts = [0, 1, 2].map(|object| scene.objects[object].mesh.chart.clone());
    assert_eq!(charts, [Chart::Uvs, Chart::Automatic, Chart::Automatic]);
    assert_eq!(scene.objects[0].mesh.map_places(), [Vec2::ZERO, Vec2::X, Vec2::Y]);
}

#[test]
fn the_second_set_of_gltf_goes_first() {
    let scene = scene("{ mesh = \"second.glb\", material = \"wall\", map_uvs = true }").unwrap();
    let mesh = &scene.objects[0].mesh;
    assert_eq!((&mesh.chart, &mesh.uvs[..]), (&Chart::Uvs, &[Vec2::Y; 3][..]));
    assert_eq!(mesh.map_places(), [Vec2::Y, Vec2::new(0.25, 1.0), Vec2::ZERO]);
}

#[test]
fn what_cannot_be_a_map_is_refused() {
    let problem = |object: &str| scene(object).unwrap_err();
    let without = problem("{ name = \"bare\", mesh = \"without.obj\", material = \"wall\", map_uvs = true }");
    assert!(without.contains("map_uvs") && without.contains("\"bare\" has no texture coordinates"), "{without}");
    let glass = problem("{ mesh = \"with.obj\", material = \"glass\", map_uvs = true }");
    assert!(glass.contains("map_uvs") && glass.contains("diffuse share"), "{glass}");
    let number = problem("{ mesh = \"with.obj\", material = \"wall\", map_uvs = 1 }");
    assert!(number.contains("map_uvs") && number.contains("true or false"), "{number}");
}
