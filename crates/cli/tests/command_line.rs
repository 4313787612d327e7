//! Runs the real binary: what it writes, what it says, and the exit status it leaves.

use std::{
    fs,
    path::PathBuf,
    process::{Command, Stdio},
};

use diacaustic_tests::{Layers, read_exr};
use serde_json::Value;
use tempfile::TempDir;

/// A glass ball over a floor, small enough to render at once.
const BALL: &str = r#"
    camera = { position = [0, 1.5, 2.5], look_at = [0, 0.3, 0], vertical_fov = 40 }
    render = { width = 64, height = 64, samples = 2, photons = 20_000, map_size = 32 }

    [materials]
    glass = { type = "dielectric", ior = 1.5 }
    plaster = { type = "diffuse", albedo = 0.8 }

    [[lights]]
    name = "lamp"
    type = "sphere"
    center = [0.5, 2.5, 0.3]
    radius = 0.05
    flux = 35

    [[objects]]
    name = "ball"
    sphere = { center = [0, 0.4, 0], radius = 0.3, subdivisions = 5 }
    material = "glass"

    [[objects]]
    name = "floor"
    rectangle = { center = [0, 0, 0], edge_u = [4, 0, 0], edge_v = [0, 0, -4] }
    material = "plaster"
"#;

/// The glass in [`BALL`].
const BALL_SHAPE: &str = "sphere = { center = [0, 0.4, 0], radius = 0.3, subdivisions = 5 }";
/// The receiver in [`BALL`].
const FLOOR_SHAPE: &str = "rectangle = { center = [0, 0, 0], edge_u = [4, 0, 0], edge_v = [0, 0, -4] }";

/// A folder of one test, with the scene file `scene.toml`, in which the command runs.
struct Workplace(TempDir);

/// What a run of the command left.
#[derive(Debug)]
struct Outcome {
    status: Option<i32>,
    stdout: String,
    stderr: String,
}

impl Workplace {
    fn new(scene: &str) -> Self {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("scene.toml"), scene).unwrap();
        Self(folder)
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_diacaustic"));
        command.current_dir(self.0.path()).args(arguments);
        command
    }

    fn run(&self, arguments: &[&str]) -> Outcome {
        outcome(&mut self.command(arguments))
    }

    /// Runs the command where there is no adapter.
    fn run_without_adapter(&self, arguments: &[&str]) -> Outcome {
        let mut command = self.command(arguments);
        command.env("WGPU_BACKEND", "vulkan");
        for variable in ["VK_DRIVER_FILES", "VK_ICD_FILENAMES"] {
            command.env(variable, "/nonexistent");
        }
        outcome(&mut command)
    }

    /// Renders `scene.toml` with further arguments, which must succeed.
    fn render(&self, arguments: &[&str]) -> Outcome {
        let outcome = self.run(&[&["scene.toml"], arguments].concat());
        assert_eq!(outcome.status, Some(0), "{arguments:?}: {}", outcome.stderr);
        assert_eq!(outcome.stdout, "", "{arguments:?}: the standard output is the user's");
        outcome
    }

    fn exr(&self, name: &str) -> Layers {
        read_exr(&self.path(name))
    }

    fn json(&self, name: &str) -> Value {
        serde_json::from_slice(&fs::read(self.path(name)).unwrap()).unwrap()
    }

    /// The names of the files in the folder, sorted.
    fn files(&self) -> Vec<String> {
        let entries = fs::read_dir(self.0.path()).unwrap();
        let mut names: Vec<_> = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }
}

impl Outcome {
    /// Checks the exit status, that each text stands in what was said, and that nobody need read a panic.
    #[track_caller]
    fn assert_refused(&self, status: i32, texts: &[&str]) {
        assert_eq!(self.status, Some(status), "{}", self.stderr);
        for text in texts {
            assert!(self.stderr.contains(text), "{text:?} is missing in: {}", self.stderr);
        }
        assert!(!self.stderr.contains("panicked"), "{}", self.stderr);
    }

    fn warnings(&self) -> Vec<&str> {
        self.stderr.lines().filter_map(|line| line.strip_prefix("diacaustic: warning: ")).collect()
    }
}

fn outcome(command: &mut Command) -> Outcome {
    let output = command.output().unwrap();
    Outcome {
        status: output.status.code(),
        stdout: String::from_utf8(output.stdout).unwrap(),
        stderr: String::from_utf8(output.stderr).unwrap(),
    }
}

/// Checks that the channels are those named, and all values finite, non-negative and not all black.
#[track_caller]
fn assert_lit(layers: &Layers, names: &[&str]) {
    assert!(layers.channels.keys().eq(names), "{:?}", layers.channels.keys());
    assert!(layers.channels.values().flatten().all(|value| value.is_finite() && *value >= 0.0));
    assert!(layers.channels.values().flatten().any(|value| *value > 0.01), "everything is black");
}

#[test]
fn writes_pictures_in_both_formats() {
    let workplace = Workplace::new(BALL);
    let outcome = workplace.render(&["--output", "a.exr", "-o", "a.PNG"]);
    let exr = workplace.exr("a.exr");
    assert_eq!((exr.width, exr.height), (64, 64));
    assert_lit(&exr, &["B", "G", "R"]);
    let png =
        image::ImageReader::open(workplace.path("a.PNG")).unwrap().with_guessed_format().unwrap().decode().unwrap();
    assert_eq!((png.width(), png.height(), png.color()), (64, 64, image::ColorType::Rgb8));
    let brightest = png.as_bytes().iter().max().unwrap();
    assert!(*brightest > 100, "the brightest byte is {brightest}");
    assert_eq!(workplace.files(), ["a.PNG", "a.exr", "scene.toml"]);
    assert_eq!(outcome.warnings(), [""; 0]);
    let last = outcome.stderr.lines().last().unwrap();
    assert!(last.starts_with("wrote a.exr, a.PNG in "), "{last}");
}

#[test]
fn without_output_the_scene_chooses_the_files() {
    let workplace = Workplace::new(BALL);
    workplace.render(&[]);
    assert_eq!(workplace.files(), ["scene.png", "scene.toml"]);
    fs::write(workplace.path("named.toml"), format!("output = {{ files = [\"b.exr\", \"b.png\"] }}\n{BALL}")).unwrap();
    assert_eq!(workplace.run(&["named.toml"]).status, Some(0));
    assert_eq!(workplace.files(), ["b.exr", "b.png", "named.toml", "scene.png", "scene.toml"]);
}

#[test]
fn layers_stand_beside_the_picture_in_exr() {
    let workplace = Workplace::new(&format!("output.layers = [\"depth\", \"direct\", \"object_id\"]\n{BALL}"));
    workplace.render(&["-o", "layers.exr", "-o", "layers.png"]);
    let names = ["B", "G", "R", "depth.Z", "direct.B", "direct.G", "direct.R", "object_id"];
    assert_lit(&workplace.exr("layers.exr"), &names);
    fs::write(workplace.path("plain.toml"), BALL).unwrap();
    assert_eq!(workplace.run(&["plain.toml", "-o", "plain.png"]).status, Some(0));
    let png = |name: &str| fs::read(workplace.path(name)).unwrap();
    assert!(png("layers.png") == png("plain.png"), "layers change the PNG");
    let without_exr = workplace.render(&["-o", "layers.png"]);
    let expected = "no layers are written: output.layers asks for them, but no picture's name ends in .exr";
    assert_eq!(without_exr.warnings(), [expected]);
}

#[test]
fn paths_start_at_the_scene_files_folder() {
    let workplace = Workplace::new("");
    fs::create_dir(workplace.path("scenes")).unwrap();
    let tetrahedron = "v 0 0.7 0\nv -0.3 0.2 0.3\nv 0.3 0.2 0.3\nv 0 0.2 -0.3\nf 1 2 3\nf 1 3 4\nf 1 4 2\nf 2 4 3\n";
    fs::write(workplace.path("scenes/solid.obj"), tetrahedron).unwrap();
    let scene = BALL.replace(BALL_SHAPE, "mesh = \"solid.obj\"");
    fs::write(workplace.path("scenes/a.toml"), format!("output = {{ files = [\"a.exr\"] }}\n{scene}")).unwrap();
    let outcome = workplace.run(&["scenes/a.toml"]);
    assert_eq!((outcome.status, outcome.warnings().len()), (Some(0), 0), "{}", outcome.stderr);
    assert_lit(&workplace.exr("scenes/a.exr"), &["B", "G", "R"]);
}

#[test]
fn statistics_hold_the_counts_and_a_closed_ledger() {
    let workplace = Workplace::new(BALL);
    workplace.render(&["--stats", "stats.json", "--photons", "30_000", "--samples", "3", "--seed", "9"]);
    let stats = workplace.json("stats.json");
    assert_eq!((&stats["photons"]["emitted"], &stats["camera"]["samples"]), (&30_000.into(), &3.into()));
    assert_eq!((&stats["seed"], &stats["time_limit_reached"]), (&9.into(), &false.into()));
    assert_eq!((&stats["size"]["width"], &stats["size"]["height"]), (&64.into(), &64.into()));
    let deposits = stats["photons"]["deposits"].as_u64().unwrap();
    assert!((1..=30_000).contains(&deposits), "{deposits} deposits");
    assert!(stats["photons"]["rays"].as_u64() > Some(30_000) && stats["camera"]["rays"].as_u64() > Some(3 * 64 * 64));
    assert_eq!(stats["maps"][0]["object"], "floor");
    let lamp = &stats["lights"][0];
    assert_eq!((&lamp["name"], &lamp["residue"]), (&"lamp".into(), &serde_json::json!([0, 0, 0])));
    let watts = |account: &str| lamp[account][1].as_f64().unwrap();
    let spent = ["deposited", "direct", "absorbed", "escaped", "cut_off", "shading_normals", "dispersion"].map(watts);
    assert!(watts("deposited") > 0.0 && watts("emitted") < 35.0, "{lamp}");
    assert!((spent.iter().sum::<f64>() / watts("emitted") - 1.0).abs() < 1e-9, "{lamp}");
    for stage in ["load", "device", "kernels", "bvh", "maps", "upload", "photons", "samples", "write"] {
        let seconds = stats["seconds"][stage].as_f64().unwrap();
        assert!(seconds >= 0.0 && seconds <= stats["seconds"]["total"].as_f64().unwrap(), "{stage}: {seconds} s");
    }
    assert!(!stats["adapter"]["name"].as_str().unwrap().is_empty());
}

#[test]
fn energy_maps_are_finite_irradiance_of_each_receiver() {
    let workplace = Workplace::new(BALL);
    workplace.render(&["--energy-maps", "new/maps"]);
    let files = fs::read_dir(workplace.path("new/maps")).unwrap();
    let mut names: Vec<_> = files.map(|file| file.unwrap().file_name()).collect();
    names.sort();
    assert_eq!(names, ["floor.exr", "floor.png"]);
    let picture = image::open(workplace.path("new/maps/floor.png")).unwrap();
    assert!(picture.width() > 512 && picture.height() > 2 * 512, "both sides stand in the picture, enlarged");
    let map = workplace.exr("new/maps/floor.exr");
    assert_eq!((map.width, map.height), (32, 32));
    assert_lit(&map, &["B", "G", "R", "back.B", "back.G", "back.R"]);
    assert!(map.channels["back.G"].iter().all(|value| *value == 0.0), "light reached the floor from below");
}

#[test]
fn equal_runs_are_equal_to_the_byte_and_other_seeds_are_not() {
    let workplace = Workplace::new(BALL);
    let bytes = |name: &str, seed: &str| {
        let (picture, maps) = (format!("{name}.exr"), format!("{name} maps"));
        workplace.render(&["--output", &picture, "--energy-maps", &maps, "--seed", seed]);
        [picture, format!("{maps}/floor.exr")].map(|file| fs::read(workplace.path(&file)).unwrap())
    };
    let first = bytes("first", "1");
    assert!(first == bytes("second", "1"), "two runs with seed 1 differ");
    let [picture, map] = bytes("third", "2");
    assert!(picture != first[0] && map != first[1], "seeds 1 and 2 give the same bytes");
}

#[test]
fn overrides_change_the_scene_as_its_file_would() {
    let render = |scene: &str, flags: &[&str]| {
        let workplace = Workplace::new(scene);
        workplace.render(&[&["--output", "a.exr"], flags].concat());
        fs::read(workplace.path("a.exr")).unwrap()
    };
    let changed = BALL.replace("ior = 1.5", "ior = 1.8").replace("samples = 2", "samples = 3");
    assert!(render(BALL, &["--set", "materials.glass.ior=1.8", "--set", "render.samples=3"]) == render(&changed, &[]));
    assert!(render(BALL, &[]) != render(&changed, &[]), "the comparison cannot fail");
}

#[test]
fn inspect_tells_what_a_scene_holds_without_a_device() {
    let workplace = Workplace::new(BALL);
    let outcome = workplace.run_without_adapter(&["inspect", "scene.toml", "--set", "render.width=99"]);
    assert_eq!(outcome.status, Some(0), "{}", outcome.stderr);
    for text in [
        "picture: 99 × 64, 2 samples, 20000 photons, target error 0.1, seed 0",
        "objects: 2, with 3970 triangles",
        "ball: 3968 triangles, closed, 0.6000 × 0.6000 × 0.6000 m around [0.0000, 0.4000, 0.0000]; glass",
        "floor: 2 triangles, 4 open edges, 4.0000 × 0.0000 × 4.0000 m",
        "glass: dielectric, index 1.5; casts light on",
        "plaster: diffuse; receives light",
        "lamp: sphere of radius 0.05 m, [35, 35, 35] W",
        "floor: 32 × 32 texels, both sides",
        "adapters: 0",
    ] {
        assert!(outcome.stdout.contains(text), "{text:?} is missing in: {}", outcome.stdout);
    }
    let bytes =
        |outcome: &Outcome| outcome.stdout.split("on a device: ").nth(1).unwrap().split(',').next().unwrap().to_owned();
    let set = workplace.render(&["--set", "render.width=99"]);
    assert!(set.stderr.contains(&format!("; {} on the device", bytes(&outcome))), "{}", set.stderr);
    let listed = workplace.run(&["inspect", "scene.toml"]);
    assert!(!listed.stdout.contains("adapters: 0") && listed.stdout.contains("\n  0: "), "{}", listed.stdout);
}

#[test]
fn frames_are_numbered_and_the_same_alone_or_in_a_run() {
    let track = "[[animation.tracks]]\nkey = \"objects.ball.sphere.center\"\nframes = [1, 3]\nvalues = [[0, 0.4, 0], [0.4, 0.5, 0]]";
    let workplace = Workplace::new(&format!("{BALL}\n{track}"));
    workplace.render(&["--frames", "1..3", "-o", "a.exr", "--stats", "a.json", "--energy-maps", "maps"]);
    let run =
        ["a.0001.exr", "a.0001.json", "a.0002.exr", "a.0002.json", "a.0003.exr", "a.0003.json", "maps", "scene.toml"];
    assert_eq!(workplace.files(), run);
    workplace.render(&["--frames", "2..2", "-o", "b.exr", "--energy-maps", "alone"]);
    let bytes = |name: &str| fs::read(workplace.path(name)).unwrap();
    assert!(bytes("a.0002.exr") == bytes("b.0002.exr"), "the picture of a frame depends on those before");
    assert!(bytes("maps/floor.0002.exr") == bytes("alone/floor.0002.exr"), "its maps do");
    assert!(bytes("a.0001.exr") != bytes("a.0002.exr") && bytes("a.0002.exr") != bytes("a.0003.exr"), "nothing moves");

    fs::write(workplace.path("still.toml"), BALL).unwrap();
    workplace.run(&["still.toml", "--frames", "1..2"]).assert_refused(2, &["still.toml", "has no [animation]"]);
    workplace.run(&["a.glb", "--frames", "1..2"]).assert_refused(2, &["a.glb: --frames goes with a scene file"]);
    workplace.run(&["scene.toml", "--frames", "2"]).assert_refused(2, &["--frames", "such as 1..48"]);
}

#[test]
fn adapters_and_memory_are_chosen() {
    let workplace = Workplace::new(BALL);
    workplace.run(&["scene.toml", "--adapter", "99"]).assert_refused(1, &["there is no GPU adapter 99; there are: 0 "]);
    workplace.run(&["scene.toml", "--adapter", "abacus"]).assert_refused(1, &["contains \"abacus\"; there are: 0 "]);
    workplace.render(&["--adapter", "0", "--device-memory", "1GiB"]);
    workplace.run(&["scene.toml", "--device-memory", "100kB"]).assert_refused(
        1,
        &[
            "the bounding volume hierarchy's nodes need ",
            "of the 100000 that may be taken on the device",
            "use fewer triangles",
        ],
    );
    workplace.run(&["scene.toml", "--device-memory", "some"]).assert_refused(2, &["--device-memory", "512MiB"]);
    // Maps whose size the scene leaves open shrink to a quarter of the limit.
    let free = ["--set", "render={ width = 256, height = 256, samples = 1, photons = 1000 }", "--stats", "stats.json"];
    let texels = |flags: &[&str]| {
        workplace.render(&[&free[..], flags].concat());
        workplace.json("stats.json")["maps"][0]["texels"].as_u64().unwrap()
    };
    let (many, few) = (texels(&[]), texels(&["--device-memory", "20MB"]));
    assert!(few < many && few * 24 <= 5_000_000, "{few} and {many} texels");
}

#[test]
fn shells_and_manuals_know_every_flag() {
    let workplace = Workplace::new(BALL);
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        let outcome = workplace.run(&["completions", shell]);
        assert_eq!(outcome.status, Some(0), "{}", outcome.stderr);
        assert!(outcome.stdout.contains("inspect") && outcome.stdout.contains("time-limit"), "{shell}");
    }
    workplace.run(&["completions", "cmd"]).assert_refused(2, &["bash", "fish"]);
    assert_eq!(workplace.run(&["man", "new/pages"]).status, Some(0));
    let page = |name: &str| fs::read_to_string(workplace.path(&format!("new/pages/{name}"))).unwrap();
    assert!(page("diacaustic.1").contains("Renders glass and the caustics"));
    assert!(page("diacaustic-render.1").contains("energy\\-maps"));
    workplace.run(&["man", "scene.toml"]).assert_refused(1, &["scene.toml: the manual cannot be written"]);
}

#[test]
#[cfg(target_os = "linux")]
fn what_the_standard_output_does_not_take_exits_with_1() {
    let workplace = Workplace::new(BALL);
    for arguments in [&["inspect", "scene.toml"][..], &["completions", "bash"], &["--help"]] {
        let full = fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
        let output =
            workplace.command(arguments).stdout(full).stderr(Stdio::piped()).spawn().unwrap().wait_with_output();
        let output = output.unwrap();
        let stderr = String::from_utf8(output.stderr).unwrap();
        Outcome { status: output.status.code(), stdout: String::new(), stderr }
            .assert_refused(1, &["the standard output cannot be written: No space left"]);
    }
}

#[test]
fn quiet_prints_nothing_but_errors() {
    let workplace = Workplace::new(&BALL.replace("dielectric\", ior = 1.5", "diffuse\", albedo = 0.5"));
    assert_eq!(workplace.render(&["--quiet"]).stderr, "");
    assert!(!workplace.render(&[]).warnings().is_empty(), "the scene has nothing to be quiet about");
    let refused = workplace.run(&["missing.toml", "--quiet"]);
    assert_eq!(refused.stderr.lines().count(), 1, "{}", refused.stderr);
}

#[test]
fn wrong_scenes_exit_with_2_and_name_file_and_key() {
    let cases: [(&str, &str, &[&str]); 6] = [
        ("ior = 1.5", "ior = = 1.5", &["scene.toml:6:", "not valid TOML"]),
        ("ior", "iro", &["scene.toml:6:", "[materials.glass]", "unknown key \"iro\"", "did you mean \"ior\"?"]),
        ("flux = 35", "flux = nan", &["scene.toml:14:", "[[lights]] #1", "flux is nan"]),
        ("map_size = 32", "map_size = 1", &["scene.toml:3:", "map_size is 1", "from 2 to 8192"]),
        ("\"plaster\"", "\"plastre\"", &["scene.toml:24:", "\"plastre\"", "did you mean \"plaster\"?"]),
        (
            BALL_SHAPE,
            "mesh = \"meshes/teapott.obj\"",
            &["scene.toml:18:", "[[objects]] #1 \"ball\"", "meshes/teapott.obj", "cannot be read"],
        ),
    ];
    for (right, wrong, texts) in cases {
        assert!(BALL.contains(right), "{right:?}");
        let workplace = Workplace::new(&BALL.replace(right, wrong));
        workplace.run(&["scene.toml"]).assert_refused(2, texts);
        assert_eq!(workplace.files(), ["scene.toml"], "{wrong:?} left a file");
    }
    let not_text = Workplace::new(BALL);
    fs::write(not_text.path("scene.toml"), [0xff, 0xfe, 0x00]).unwrap();
    not_text.run(&["scene.toml"]).assert_refused(2, &["scene.toml", "cannot be read", "no UTF-8 text"]);
}

#[test]
fn wrong_arguments_exit_with_2_and_name_what_is_wrong() {
    let workplace = Workplace::new(BALL);
    let cases: [(&[&str], &[&str]); 15] = [
        (&[], &["<SCENE>"]),
        (&["render"], &["<SCENE>"]),
        (&["inspect", "missing.toml"], &["missing.toml", "cannot be read"]),
        (&["scene.toml", "--set", "render.samples"], &["--set", "expected KEY=VALUE"]),
        (&["scene.toml", "--set", "materials.glas.ior=2"], &["materials has no \"glas\"", "did you mean \"glass\"?"]),
        (&["a.glb", "--set", "render.samples=2"], &["--set render.samples goes with a scene file", "mesh = \"a.glb\""]),
        (&["missing.toml"], &["missing.toml", "cannot be read"]),
        (&["scene.toml", "--photon", "9"], &["--photon", "--photons"]),
        (&["scene.toml", "--samples", "0"], &["--samples", "from 1 to"]),
        (&["scene.toml", "--time-limit", "soon"], &["--time-limit", "number of seconds"]),
        (&["scene.toml", "--time-limit", "-1"], &["--time-limit", "number of seconds"]),
        (&["scene.toml", "--seed", "-1"], &["--seed", "whole number from 0"]),
        (&["bake", "scene.toml", "--size", "-1"], &["--size", "whole number from 2"]),
        (&["scene.toml", "--output", "a.jpg"], &["a.jpg", ".exr or .png"]),
        (&["scene.toml", "--output", "a.exr", "--stats", "a.exr"], &["a.exr", "named twice"]),
    ];
    for (arguments, texts) in cases {
        workplace.run(arguments).assert_refused(2, texts);
    }
    assert_eq!(workplace.files(), ["scene.toml"]);
}

#[test]
fn unwritable_places_exit_with_1_before_rendering() {
    let workplace = Workplace::new(BALL);
    workplace
        .run_without_adapter(&["scene.toml", "--output", "missing/a.png"])
        .assert_refused(1, &["missing/a.png", "there is no folder missing"]);
    workplace
        .run_without_adapter(&["scene.toml", "--energy-maps", "scene.toml"])
        .assert_refused(1, &["scene.toml: the folder"]);
    if cfg!(target_os = "linux") {
        // Not even root creates files there.
        workplace
            .run_without_adapter(&["scene.toml", "--output", "/proc/a.png"])
            .assert_refused(1, &["/proc/a.png: the file cannot be written", "caused by"]);
    }
    assert_eq!(workplace.files(), ["scene.toml"]);
}

#[test]
fn no_adapter_exits_with_1_and_names_the_packages() {
    let workplace = Workplace::new(BALL);
    let outcome = workplace.run_without_adapter(&["scene.toml"]);
    outcome.assert_refused(1, &["no GPU adapter", "apt-get install libvulkan1 mesa-vulkan-drivers"]);
    assert_eq!(workplace.files(), ["scene.toml"]);
}

/// Two receivers with the largest maps there are, 6.4 GB together, of which hardly a texel holds a surface.
fn too_large_for_any_device() -> Workplace {
    let workplace = Workplace::new(&BALL.replace("map_size = 32", "map_size = 8192").replace(
        FLOOR_SHAPE,
        "mesh = \"specks.obj\"\nmaterial = \"plaster\"\n[[objects]]\nname = \"more\"\nmesh = \"specks.obj\"",
    ));
    let specks = "v 0 0 0\nv 0 0 0.01\nv 0.01 0 0\nv 4 0 4\nv 4 0 3.99\nv 3.99 0 4\nf 1 2 3\nf 4 5 6\n";
    fs::write(workplace.path("specks.obj"), specks).unwrap();
    workplace
}

#[test]
fn a_map_beyond_the_device_exits_with_1_and_names_both_sizes() {
    let workplace = too_large_for_any_device();
    let outcome = workplace.run(&["scene.toml"]);
    outcome.assert_refused(1, &["the energy maps of each light group take ", "the device allows ", "lower map_size"]);
    let bytes_after = |text: &str| {
        let rest = outcome.stderr.split(text).nth(1).unwrap();
        rest.split(|c: char| !c.is_ascii_digit()).next().unwrap().parse::<u64>().unwrap()
    };
    let (asked, available) = (bytes_after("light group take "), bytes_after("the device allows "));
    assert!(available >= 128 << 20 && available < asked, "{asked} bytes are said to be asked, {available} allowed");
}

#[test]
fn a_failing_run_leaves_the_files_of_the_last_one() {
    let workplace = too_large_for_any_device();
    for file in ["scene.png", "stats.json"] {
        fs::write(workplace.path(file), "before").unwrap();
    }
    workplace.run(&["scene.toml", "--stats", "stats.json"]).assert_refused(1, &["the energy maps"]);
    for file in ["scene.png", "stats.json"] {
        assert_eq!(fs::read_to_string(workplace.path(file)).unwrap(), "before", "{file}");
    }
    assert_eq!(workplace.files(), ["scene.png", "scene.toml", "specks.obj", "stats.json"]);
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_exits_with_1_and_leaves_the_files_after_it() {
    let workplace = Workplace::new(BALL);
    std::os::unix::fs::symlink("/dev/full", workplace.path("full.png")).unwrap();
    fs::write(workplace.path("kept.json"), "before").unwrap();
    let outcome = workplace.run(&["scene.toml", "--output", "full.png", "--stats", "kept.json"]);
    outcome.assert_refused(1, &["full.png: the file cannot be written", "caused by", "No space left"]);
    assert_eq!(fs::read_to_string(workplace.path("kept.json")).unwrap(), "before");
    assert_eq!(workplace.files(), ["full.png", "kept.json", "scene.toml"]);
}

#[test]
fn a_time_limit_still_gives_a_picture() {
    let workplace =
        Workplace::new(&BALL.replace("samples = 2, photons = 20_000", "samples = 4000, photons = 4_000_000_000"));
    workplace.render(&["--output", "a.exr", "--stats", "stats.json", "--time-limit", "0.01"]);
    assert_lit(&workplace.exr("a.exr"), &["B", "G", "R"]);
    let stats = workplace.json("stats.json");
    assert_eq!(stats["time_limit_reached"], true);
    assert!(
        stats["photons"]["emitted"].as_u64() > Some(0) && stats["photons"]["emitted"].as_u64() < Some(4_000_000_000)
    );
    assert_eq!(stats["camera"]["samples"], 1);
}

/// Renders the scene and checks that there is exactly one warning, with these texts.
#[track_caller]
fn assert_warns(workplace: &Workplace, texts: &[&str]) {
    let outcome = workplace.render(&[]);
    let [warning] = outcome.warnings().try_into().unwrap_or_else(|found| panic!("not one warning: {found:?}"));
    for text in texts {
        assert!(warning.contains(text), "{text:?} is missing in: {warning}");
    }
}

#[test]
fn photons_that_nobody_sends_are_told() {
    let none = Workplace::new(&BALL.replace("photons = 20_000", "photons = 0"));
    assert_warns(&none, &["no caustic can form: no photons were asked for", "--photons"]);
}

#[test]
fn no_caster_is_told() {
    let workplace = Workplace::new(&BALL.replace("material = \"glass\"", "material = \"plaster\""));
    assert_warns(&workplace, &["no caustic can form", "no object has glass, a mirror, metal or a clear coat"]);
}

#[test]
fn a_light_inside_glass_is_no_cause_for_a_warning() {
    let workplace = Workplace::new(&BALL.replace("center = [0.5, 2.5, 0.3]", "center = [0, 0.4, 0]"));
    let outcome = workplace.render(&["--output", "a.exr"]);
    assert!(outcome.warnings().is_empty(), "{:?}", outcome.warnings());
    assert_lit(&workplace.exr("a.exr"), &["B", "G", "R"]);
}

#[test]
fn photons_that_all_miss_are_told_with_their_fate() {
    // So small and far away that no photon of these finds it.
    let speck = "rectangle = { center = [0, 90, -90], edge_u = [0.01, 0, 0], edge_v = [0, 0, -0.01] }";
    let workplace = Workplace::new(&BALL.replace(FLOOR_SHAPE, speck));
    assert_warns(&workplace, &["no caustic formed: none of 20000 photons", "left the scene"]);
}

#[test]
fn an_open_mesh_of_glass_is_told_with_its_open_edges() {
    let workplace = Workplace::new(&BALL.replace(BALL_SHAPE, "mesh = \"open.obj\""));
    // A tetrahedron without one of its faces.
    let open = "v 0 0.7 0\nv -0.3 0.2 0.3\nv 0.3 0.2 0.3\nv 0 0.2 -0.3\nf 1 2 3\nf 1 3 4\nf 1 4 2\n";
    fs::write(workplace.path("open.obj"), open).unwrap();
    assert_warns(&workplace, &["object \"ball\"", "not closed (3 open edges)", "close the mesh"]);
}

/// A glTF file of one triangle in text, which is not metal.
const TRIANGLE: &str = r#"{
    "asset": { "version": "2.0" },
    "buffers": [{ "byteLength": 36, "uri": "data:;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA" }],
    "bufferViews": [{ "buffer": 0, "byteLength": 36 }],
    "accessors": [{ "bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3" }],
    "materials": [{ "pbrMetallicRoughness": { "metallicFactor": 0 } }],
    "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0 }, "material": 0 }] }],
    "nodes": [{ "mesh": 0, "name": "leaf" }]
}"#;

#[test]
fn gltf_files_render_by_themselves() {
    let place = Workplace::new(BALL);
    fs::write(place.path("a.gltf"), TRIANGLE).unwrap();
    let arguments = ["a.gltf", "--floor", "--samples", "1", "--photons", "1000", "--energy-maps", "maps"];
    let outcome = place.run(&arguments);
    assert_eq!(outcome.status, Some(0), "{}", outcome.stderr);
    assert!(place.path("maps/leaf.exr").is_file() && place.path("maps/floor.exr").is_file());
    let picture = image::open(place.path("a.render.png")).unwrap().into_rgb8();
    let middle = picture.get_pixel(picture.width() / 2, picture.height() / 2);
    assert!(middle.0.iter().all(|channel| *channel > 40), "{middle:?}");
}

#[test]
fn bad_gltf_files_are_refused() {
    let place = Workplace::new(BALL);
    fs::write(place.path("a.gltf"), TRIANGLE.replace("\"count\": 3", "\"count\": 4")).unwrap();
    place.run(&["a.gltf"]).assert_refused(2, &["a.gltf: accessors[0]: has 4 elements of 12 bytes"]);
    fs::write(place.path("b.gltf"), TRIANGLE.replace("data:;base64,", "../")).unwrap();
    place.run(&["b.gltf"]).assert_refused(2, &["b.gltf: buffers[0]: names the file", "give --allow-outside"]);
    place
        .run(&["b.gltf", "--allow-outside"])
        .assert_refused(2, &["b.gltf: buffers[0]: names the file", "cannot be read"]);
    fs::write(place.path("c.glb"), "glTF").unwrap();
    place.run(&["c.glb"]).assert_refused(2, &["c.glb: the file is cut off"]);
    place.run(&["scene.toml", "--floor"]).assert_refused(2, &["--floor goes with a glTF file"]);
}
