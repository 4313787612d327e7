//! What the reader says about scene files with one fault each.

use std::path::Path;

use diacaustic_scene::parse_scene;

/// A scene without fault; each case below changes one line of it.
const GOOD: &str = r#"background = [0, 0, 0]
ambient = 0.1
[camera]
position = [0, 2.2, 3.2]
look_at = [0, 0.2, 0]
up = [0, 1, 0]
vertical_fov = 40
aperture_radius = 0.01
focus_distance = 3.7
[render]
width = 512
height = 256
samples = 16
photons = 1000000
seed = 7
max_depth = 32
map_size = 1024
filter = "box"
[output]
files = ["a.png", "b.exr"]
exposure = 0.5
tone = "plain"
[materials.glass]
type = "dielectric"
ior = 1.5
tint = [1, 1, 0.9]
absorption = 0.2
[materials.floor]
type = "diffuse"
albedo = 0.8
[materials.gloss]
type = "phong"
ambient = 0
diffuse = 0.5
specular = 0.2
shininess = 20
[materials.silver]
type = "mirror"
reflectance = 0.9
[[lights]]
type = "sphere"
name = "lamp"
center = [1, 2.5, 0.6]
radius = 0.05
flux = [35, 35, 35]
[[objects]]
name = "ball"
sphere = { center = [0, 0.4, 0], radius = 0.3, subdivisions = 4 }
material = "glass"
translate = [0, 0.1, 0]
rotate = [0, 45, 0]
scale = 1.5
[[objects]]
name = "ground"
rectangle = { center = [0, 0, 0], edge_u = [4, 0, 0], edge_v = [0, 0, -4] }
material = "floor"
map_size = 512
[[objects]]
box = { min = [1, 0, 0], max = [2, 1, 1] }
material = "gloss"
"#;

fn error_of(text: &str) -> String {
    match parse_scene(text, Path::new("/nowhere"), "x.toml") {
        Ok(_) => panic!("accepted:\n{text}"),
        Err(error) => error.to_string(),
    }
}

#[test]
fn the_scene_without_fault_is_accepted() {
    let loaded = parse_scene(GOOD, Path::new("/nowhere"), "x.toml").unwrap();
    assert_eq!(loaded.warnings, []);
}

#[test]
fn each_fault_is_named() {
    for (line, replacement, message) in CASES {
        assert_eq!(GOOD.matches(line).count(), 1, "{line:?} must stand once in the scene");
        assert_eq!(error_of(&GOOD.replace(line, replacement)), *message, "for {replacement:?}");
    }
    assert!(CASES.len() >= 40);
}

#[test]
fn missing_parts_are_named() {
    assert_eq!(error_of(""), "x.toml:1:1: the scene file: the key \"camera\" is missing; it takes a table: [camera]");
    let without_objects = GOOD.split("[[objects]]").next().unwrap();
    assert_eq!(
        error_of(without_objects),
        "x.toml:1:1: scene: objects is empty, so there is nothing to render; add an object ([[objects]] in a scene file)"
    );
}

#[test]
fn no_text_makes_the_reader_panic() {
    for cut in 0..GOOD.len() {
        let _ = parse_scene(&GOOD[..cut], Path::new("/nowhere"), "x.toml");
    }
    for (from, to) in [("0", "9e99"), ("1", "-0x1"), ("[", "[["), ("\"", "'"), ("=", ".a="), ("e", "é")] {
        let _ = parse_scene(&GOOD.replace(from, to), Path::new("/nowhere"), "x.toml");
    }
}

/// A line of [`GOOD`], what replaces it, and the message.
const CASES: &[(&str, &str, &str)] = &[
    ("ambient = 0.1", "ambient = = 0.1", "x.toml:2:11: not valid TOML: extra `=`, expected nothing"),
    ("ambient = 0.1", "ambient = 0.1\nambient = 0.2", "x.toml:3:1: not valid TOML: duplicate key"),
    ("seed = 7", "seed = 7\n[camera]", "x.toml:16:2: not valid TOML: duplicate key"),
    (
        "ambient = 0.1",
        "ambiance = 0.1",
        r#"x.toml:2:1: the scene file: unknown key "ambiance"; did you mean "ambient"? Known keys: background, ambient, animation, camera, render, output, paper, materials, lights, objects"#,
    ),
    (
        "[render]",
        "[rendering]",
        r#"x.toml:10:2: the scene file: unknown key "rendering"; did you mean "render"? Known keys: background, ambient, animation, camera, render, output, paper, materials, lights, objects"#,
    ),
    (
        "ambient = 0.1",
        "materials = 3",
        "x.toml:23:2: not valid TOML: cannot extend value of type integer with a dotted key",
    ),
    (
        "[[lights]]",
        "[lights]",
        "x.toml:40:1: the scene file: lights: expected an array of tables: [[lights]], found a table",
    ),
    ("[output]", "[[output]]", "x.toml:19:1: the scene file: output: expected a table: [output], found an array of 1"),
    (
        "background = [0, 0, 0]",
        "background = [0, 0]",
        "x.toml:1:14: the scene file: background: expected a colour: 3 numbers [r, g, b] or one number for gray, found an array of 2",
    ),
    (
        "background = [0, 0, 0]",
        "background = [0, nan, 0]",
        "x.toml:1:18: the scene file: background[1] is nan; it must be finite and less than 3.4e38",
    ),
    (
        "background = [0, 0, 0]",
        "background = [0, -1, 0]",
        "x.toml:1:1: scene: background is [0, -1, 0]; each channel must be 0 or greater",
    ),
    (
        "ambient = 0.1",
        r#"ambient = "dim""#,
        r#"x.toml:2:11: the scene file: ambient: expected a colour: 3 numbers [r, g, b] or one number for gray, found the string "dim""#,
    ),
    (
        "vertical_fov = 40",
        "fov = 40",
        r#"x.toml:7:1: [camera]: unknown key "fov"; did you mean "vertical_fov"? Known keys: position, look_at, up, vertical_fov, aperture_radius, focus_distance"#,
    ),
    (
        "vertical_fov = 40",
        "",
        r#"x.toml:3:1: [camera]: the key "vertical_fov" is missing; it takes a number of degrees"#,
    ),
    (
        "vertical_fov = 40",
        "vertical_fov = 180",
        "x.toml:7:1: camera: vertical_fov is 180; it must be between 0 and 180 (degrees)",
    ),
    (
        "vertical_fov = 40",
        "vertical_fov = inf",
        "x.toml:7:16: [camera]: vertical_fov is inf; it must be finite and less than 3.4e38",
    ),
    (
        "look_at = [0, 0.2, 0]",
        "look_at = [0, 2.2, 3.2]",
        "x.toml:5:1: camera: look_at is the camera's position; it must be another point",
    ),
    (
        "look_at = [0, 0.2, 0]",
        "look_at = [0, 0.2, 0, 1]",
        "x.toml:5:11: [camera]: look_at: expected 3 numbers [x, y, z], found an array of 4",
    ),
    (
        "look_at = [0, 0.2, 0]",
        "look_at = [0, true, 0]",
        "x.toml:5:15: [camera]: look_at[1]: expected a number, found true",
    ),
    (
        "position = [0, 2.2, 3.2]",
        "position = 3",
        "x.toml:4:12: [camera]: position: expected 3 numbers [x, y, z], found the whole number 3",
    ),
    (
        "up = [0, 1, 0]",
        "up = [0, 2, 3.2]",
        "x.toml:6:1: camera: up is [0, 2, 3.2], parallel to the view; it must point elsewhere",
    ),
    (
        "up = [0, 1, 0]",
        "up = [0, 0, 0]",
        "x.toml:6:1: camera: up is [0, 0, 0], which has no direction; it must be a vector such as [0, 1, 0]",
    ),
    (
        "aperture_radius = 0.01",
        "aperture_radius = -0.01",
        "x.toml:8:1: camera: aperture_radius is -0.01; it must be 0 or greater (metres)",
    ),
    (
        "focus_distance = 3.7",
        "focus_distance = 0",
        "x.toml:9:1: camera: focus_distance is 0; it must be greater than 0 (metres)",
    ),
    (
        "focus_distance = 3.7",
        "focus_distance = 1e39",
        "x.toml:9:18: [camera]: focus_distance is 1e39; it must be finite and less than 3.4e38",
    ),
    ("width = 512", "width = 0", "x.toml:11:1: render: width is 0; it must be from 1 to 16384 (pixels)"),
    (
        "width = 512",
        "width = 512.0",
        "x.toml:11:9: [render]: width: expected a whole number, 0 or greater, found the number 512.0",
    ),
    ("height = 256", "height = 20000", "x.toml:12:1: render: height is 20000; it must be from 1 to 16384 (pixels)"),
    ("samples = 16", "samples = 0", "x.toml:13:1: render: samples is 0; it must be 1 or greater"),
    (
        "photons = 1000000",
        "photons = 4294967296",
        "x.toml:14:1: render: photons is 4294967296; it must be at most 4294967295",
    ),
    (
        "photons = 1000000",
        "photons = 1e6",
        "x.toml:14:11: [render]: photons: expected a whole number, 0 or greater, found the number 1e6",
    ),
    (
        "seed = 7",
        "seed = -1",
        "x.toml:15:8: [render]: seed: expected a whole number, 0 or greater, found the whole number -1",
    ),
    ("seed = 7", "seed = 0x100000000", "x.toml:15:8: [render]: seed is 4294967296; it must be at most 4294967295"),
    ("max_depth = 32", "max_bounces = 1001", "x.toml:16:1: render: max_bounces is 1001; it must be from 0 to 1000"),
    ("max_depth = 32", "max_depth = 1001", "x.toml:16:1: render: max_depth is 1001; it must be from 1 to 1000"),
    (
        "max_depth = 32",
        "guiding = 1",
        "x.toml:16:11: [render]: guiding: expected true or false, found the whole number 1",
    ),
    ("map_size = 1024", "map_size = 1", "x.toml:17:1: render: map_size is 1; it must be from 2 to 8192"),
    ("map_size = 1024", "map_budget = 0", "x.toml:17:1: render: map_budget is 0; it must be from 1 to 65536 (MiB)"),
    (
        r#"filter = "box""#,
        r#"filter = "blackman_haris""#,
        r#"x.toml:18:10: [render]: filter: there is no filter "blackman_haris"; did you mean "blackman-harris"? Known names: box, blackman-harris"#,
    ),
    (
        "exposure = 0.5",
        r#"exposure = "bright""#,
        r#"x.toml:21:12: [output]: exposure: expected a number, found the string "bright""#,
    ),
    (
        r#"tone = "plain""#,
        r#"tone = "aces""#,
        r#"x.toml:22:8: [output]: tone: there is no tone curve "aces"; known names: plain, filmic"#,
    ),
    (
        "exposure = 0.5",
        r#"layers = ["albedo", "difuse"]"#,
        r#"x.toml:21:21: [output]: layers[1]: there is no layer "difuse"; known names: emission, direct, caustic, indirect, light_groups, albedo, normal, depth, position, object_id, material_id, samples, variance"#,
    ),
    (
        "exposure = 0.5",
        r#"layers = "all""#,
        r#"x.toml:21:10: [output]: layers: expected true, false or an array of layers' names, found the string "all""#,
    ),
    (
        r#"files = ["a.png", "b.exr"]"#,
        r#"files = ["a.png", "b.jpg"]"#,
        "x.toml:20:1: output: files /nowhere/b.jpg has an ending that cannot be written; it must end in .png or .exr",
    ),
    (
        r#"files = ["a.png", "b.exr"]"#,
        r#"files = "a.png""#,
        r#"x.toml:20:9: [output]: files: expected an array of file names, found the string "a.png""#,
    ),
    (
        r#"files = ["a.png", "b.exr"]"#,
        "files = [1]",
        "x.toml:20:10: [output]: files[0]: expected a file name, found the whole number 1",
    ),
    (
        "ior = 1.5",
        "iro = 1.5",
        r#"x.toml:25:1: [materials.glass]: unknown key "iro"; did you mean "ior"? Known keys: type, tint, roughness, normal, ior, substance, cauchy, sellmeier, abbe, dispersion, absorption, priority, share, rest"#,
    ),
    (
        "ior = 1.5",
        "",
        r#"x.toml:23:1: [materials.glass]: the key "ior" is missing; it takes a number, the index of refraction, or "substance", a name such as "water""#,
    ),
    ("ior = 1.5", "ior = 0", r#"x.toml:25:1: material "glass": ior is 0; it must be finite and greater than 0"#),
    (
        r#"type = "dielectric""#,
        r#"type = "dielectrc""#,
        r#"x.toml:24:8: [materials.glass]: type: there is no material type "dielectrc"; did you mean "dielectric"? Known names: diffuse, phong, mirror, conductor, dielectric, thin_walled, coated, metallic_roughness"#,
    ),
    (
        r#"type = "dielectric""#,
        r#"type = "metal""#,
        r#"x.toml:24:8: [materials.glass]: type: there is no material type "metal"; known names: diffuse, phong, mirror, conductor, dielectric, thin_walled, coated, metallic_roughness"#,
    ),
    (
        r#"type = "dielectric""#,
        "",
        r#"x.toml:23:1: [materials.glass]: the key "type" is missing; it takes the name of a material type, such as "diffuse" or "dielectric""#,
    ),
    (
        r#"type = "dielectric""#,
        "type = 4",
        "x.toml:24:8: [materials.glass]: type: expected a string, found the whole number 4",
    ),
    (
        "tint = [1, 1, 0.9]",
        "tint = [1, 1, 1.1]",
        r#"x.toml:26:1: material "glass": tint is [1, 1, 1.1]; each channel must be from 0 to 1"#,
    ),
    (
        "absorption = 0.2",
        "absorption = -0.2",
        r#"x.toml:27:1: material "glass": absorption is [-0.2, -0.2, -0.2]; each channel must be 0 or greater (1/m)"#,
    ),
    (
        "albedo = 0.8",
        "albedo = 1.5",
        r#"x.toml:30:1: material "floor": albedo is [1.5, 1.5, 1.5]; each channel must be from 0 to 1"#,
    ),
    (
        "albedo = 0.8",
        "albedo = 0.8\nior = 1.5",
        r#"x.toml:31:1: [materials.floor]: unknown key "ior"; known keys: type, albedo, emission, normal, opacity, group, share, rest"#,
    ),
    (
        "albedo = 0.8",
        "",
        r#"x.toml:28:1: [materials.floor]: the key "albedo" is missing; it takes a colour: 3 numbers [r, g, b] or one number for gray"#,
    ),
    (
        "shininess = 20",
        "shininess = 0",
        r#"x.toml:36:1: material "gloss": shininess is 0; it must be finite and greater than 0"#,
    ),
    (
        "reflectance = 0.9",
        "reflectance = 2",
        r#"x.toml:39:1: material "silver": reflectance is [2, 2, 2]; each channel must be from 0 to 1"#,
    ),
    (
        r#"type = "sphere""#,
        r#"type = "spher""#,
        r#"x.toml:41:8: [[lights]] #1: type: there is no light type "spher"; did you mean "sphere"? Known names: sphere, rectangle, disk, point, spot, directional, sun, environment"#,
    ),
    ("radius = 0.05", "radius = 0", r#"x.toml:44:1: light "lamp": radius is 0; it must be greater than 0 (metres)"#),
    (
        "radius = 0.05",
        "radius = 1e-30",
        r#"x.toml:44:1: light "lamp": radius is 1e-30; so small a light of this flux has no finite radiance; it must be larger"#,
    ),
    (
        "flux = [35, 35, 35]",
        "flux = [35, -1, 35]",
        r#"x.toml:45:1: light "lamp": flux is [35, -1, 35]; each channel must be 0 or greater (watts)"#,
    ),
    (
        "flux = [35, 35, 35]",
        "power = 35",
        r#"x.toml:45:1: [[lights]] #1: unknown key "power"; known keys: type, name, photon_share, group, center, radius, flux"#,
    ),
    (
        "center = [1, 2.5, 0.6]",
        "",
        r#"x.toml:40:1: [[lights]] #1: the key "center" is missing; it takes 3 numbers [x, y, z], metres"#,
    ),
    (r#"name = "lamp""#, r#"name = """#, r#"x.toml:42:1: light "": name is empty; it must have a letter at least"#),
    (
        "sphere = { center = [0, 0.4, 0], radius = 0.3, subdivisions = 4 }",
        "",
        r#"x.toml:46:1: [[objects]] #1 "ball": an object takes exactly one of mesh, sphere, rectangle, box; it has none"#,
    ),
    (
        "sphere = { center = [0, 0.4, 0], radius = 0.3, subdivisions = 4 }",
        "sphere = { center = [0, 0.4, 0], radius = 0.3 }\nmesh = \"a.obj\"",
        r#"x.toml:46:1: [[objects]] #1 "ball": an object takes exactly one of mesh, sphere, rectangle, box; it has mesh and sphere"#,
    ),
    (
        "sphere = { center = [0, 0.4, 0], radius = 0.3, subdivisions = 4 }",
        "sphere = { center = [0, 0.4, 0], radius = -0.3 }",
        r#"x.toml:48:43: [[objects]] #1 "ball": sphere: radius is -0.3; it must be greater than 0 (metres)"#,
    ),
    (
        "sphere = { center = [0, 0.4, 0], radius = 0.3, subdivisions = 4 }",
        "sphere = { center = [0, 0.4, 0], radius = 0.3, subdivisions = 99 }",
        r#"x.toml:48:63: [[objects]] #1 "ball": sphere: subdivisions is 99; it must be from 1 to 10"#,
    ),
    (
        "sphere = { center = [0, 0.4, 0], radius = 0.3, subdivisions = 4 }",
        "sphere = { center = [0, 0.4, 0], radios = 0.3 }",
        r#"x.toml:48:34: [[objects]] #1 "ball": sphere: unknown key "radios"; did you mean "radius"? Known keys: center, radius, subdivisions"#,
    ),
    (
        "sphere = { center = [0, 0.4, 0], radius = 0.3, subdivisions = 4 }",
        "sphere = 3",
        r#"x.toml:48:10: [[objects]] #1 "ball": sphere: expected a table: { key = value, ... }, found the whole number 3"#,
    ),
    (
        "sphere = { center = [0, 0.4, 0], radius = 0.3, subdivisions = 4 }",
        r#"mesh = "a.obj""#,
        r#"x.toml:48:8: [[objects]] #1 "ball": mesh: /nowhere/a.obj: the file cannot be read: No such file or directory (os error 2)"#,
    ),
    (
        "sphere = { center = [0, 0.4, 0], radius = 0.3, subdivisions = 4 }",
        r#"mesh = "a.off""#,
        r#"x.toml:48:8: [[objects]] #1 "ball": mesh is /nowhere/a.off; meshes are read from OBJ, PLY, STL and glTF files, whose names end in .obj, .ply, .stl, .gltf or .glb"#,
    ),
    (
        "rectangle = { center = [0, 0, 0], edge_u = [4, 0, 0], edge_v = [0, 0, -4] }",
        "rectangle = { center = [0, 0, 0], edge_u = [4, 0, 0], edge_v = [1, 0, -4] }",
        r#"x.toml:55:13: [[objects]] #2 "ground": rectangle: edge_u and edge_v must be perpendicular; for another shape, use an OBJ mesh"#,
    ),
    (
        "rectangle = { center = [0, 0, 0], edge_u = [4, 0, 0], edge_v = [0, 0, -4] }",
        "rectangle = { center = [0, 0, 0], edge_u = [4, 0, 0], edge_v = 0 }",
        r#"x.toml:55:64: [[objects]] #2 "ground": rectangle: edge_v: expected 3 numbers [x, y, z], found the whole number 0"#,
    ),
    (
        "rectangle = { center = [0, 0, 0], edge_u = [4, 0, 0], edge_v = [0, 0, -4] }",
        "rectangle = { center = [0, 0, 0], edge_u = [4, 0, 0], edge_v = [0, 0, 0] }",
        r#"x.toml:55:13: [[objects]] #2 "ground": rectangle: edge_u and edge_v must not have length 0"#,
    ),
    (
        "box = { min = [1, 0, 0], max = [2, 1, 1] }",
        "box = { min = [1, 0, 0], max = [2, 0, 1] }",
        "x.toml:59:7: [[objects]] #3: box: min [1, 0, 0] must be less than max [2, 0, 1] along each axis",
    ),
    (
        r#"name = "ground""#,
        r#"name = "ball""#,
        r#"x.toml:54:1: object "ball": name is given to numbers 1 and 2; names must differ"#,
    ),
    (
        r#"name = "ground""#,
        r#"name = "../ground""#,
        r#"x.toml:54:1: object "../ground": name must not contain /, \ or control characters, for files are named after it"#,
    ),
    (
        r#"name = "ground""#,
        r#"nam = "ground""#,
        r#"x.toml:54:1: [[objects]] #2: unknown key "nam"; did you mean "name"? Known keys: name, mesh, sphere, rectangle, box, material, material_slots, translate, rotate, scale, map_size, time, animation, variant, crease_angle, map_uvs"#,
    ),
    (
        r#"material = "floor""#,
        r#"material = "flor""#,
        r#"x.toml:56:12: [[objects]] #2 "ground": material: there is no material "flor"; did you mean "floor"? Known materials: floor, glass, gloss, silver"#,
    ),
    (
        r#"material = "floor""#,
        r#"material = "marble""#,
        r#"x.toml:56:12: [[objects]] #2 "ground": material: there is no material "marble"; known materials: floor, glass, gloss, silver"#,
    ),
    (
        r#"material = "floor""#,
        "",
        r#"x.toml:53:1: [[objects]] #2 "ground": the object has no material; name one of [materials] with the key "material""#,
    ),
    (
        r#"material = "floor""#,
        r#"material_slots = { top = "floor" }"#,
        r#"x.toml:56:18: [[objects]] #2 "ground": material_slots: there is no material slot "top"; there are no slots of the mesh"#,
    ),
    (
        "map_size = 512",
        "map_size = 8193",
        r#"x.toml:57:1: object "ground": map_size is 8193; it must be from 2 to 8192"#,
    ),
    (
        "translate = [0, 0.1, 0]",
        "map_size = 512",
        r#"x.toml:50:1: object "ball": map_size is set, but the object is of glass, a mirror or metal, and only objects with a diffuse share have an energy map; leave it out"#,
    ),
    (
        "translate = [0, 0.1, 0]",
        "translate = [0, 1e39, 0]",
        r#"x.toml:50:17: [[objects]] #1 "ball": translate[1] is 1e39; it must be finite and less than 3.4e38"#,
    ),
    (
        "translate = [0, 0.1, 0]",
        "translate = [0, 0.1]",
        r#"x.toml:50:13: [[objects]] #1 "ball": translate: expected 3 numbers [x, y, z], found an array of 2"#,
    ),
    (
        "rotate = [0, 45, 0]",
        "rotation = [0, 45, 0]",
        r#"x.toml:51:1: [[objects]] #1 "ball": unknown key "rotation"; did you mean "rotate"? Known keys: name, mesh, sphere, rectangle, box, material, material_slots, translate, rotate, scale, map_size, time, animation, variant, crease_angle, map_uvs"#,
    ),
    (
        "scale = 1.5",
        "scale = 0",
        r#"x.toml:52:9: [[objects]] #1 "ball": scale is zero along an axis; a scale must not be 0"#,
    ),
    (
        "scale = 1.5",
        "scale = [1, 0, 1]",
        r#"x.toml:52:9: [[objects]] #1 "ball": scale is zero along an axis; a scale must not be 0"#,
    ),
    (
        "scale = 1.5",
        "scale = 1e-30",
        r#"x.toml:46:1: object "ball": world_from_object cannot be inverted; every number must be finite and the scale neither 0 nor extreme"#,
    ),
    (
        "scale = 1.5",
        "scale = 1e38",
        r#"x.toml:46:1: object "ball": world_from_object cannot be inverted; every number must be finite and the scale neither 0 nor extreme"#,
    ),
];
