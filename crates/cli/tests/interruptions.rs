//! Runs that end before they are done, and go on: to the same bytes.

#![cfg(unix)]

use std::{
    fs,
    path::{Path, PathBuf},
    process::{Child, Command, Stdio},
    thread::sleep,
    time::{Duration, Instant},
};

/// A glass ball over a floor, with layers, rendered for about a second.
const BALL: &str = r#"
    camera = { position = [0, 1.5, 2.5], look_at = [0, 0.3, 0], vertical_fov = 40 }
    render = { width = 64, height = 64, samples = 120, photons = 600_000, map_size = 128, seed = 5 }
    output.layers = ["caustic", "variance", "light_groups"]
    materials.glass = { type = "dielectric", ior = 1.5 }
    materials.plaster = { type = "diffuse", albedo = 0.8 }
    lights = [
        { name = "lamp", type = "sphere", center = [0.5, 2.5, 0.3], radius = 0.05, flux = 35 },
        { type = "point", position = [-0.5, 2.5, 0.3], flux = 5, group = "other" },
    ]
    objects = [
        { name = "ball", sphere = { center = [0, 0.4, 0], radius = 0.3, subdivisions = 4 }, material = "glass" },
        { name = "floor", rectangle = { center = [0, 0, 0], edge_u = [4, 0, 0], edge_v = [0, 0, -4] }, material = "plaster" },
    ]
"#;

struct Workplace(tempfile::TempDir);

impl Workplace {
    fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("scene.toml"), BALL).unwrap();
        Self(folder)
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn command(&self, flags: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_diacaustic"));
        command.current_dir(self.0.path()).arg("scene.toml").args(flags);
        command
    }

    /// Runs to the end; returns the exit status and what was said.
    fn run(&self, flags: &[&str]) -> (Option<i32>, String) {
        let output = self.command(flags).output().unwrap();
        (output.status.code(), String::from_utf8(output.stderr).unwrap())
    }

    fn start(&self, flags: &[&str]) -> Child {
        self.command(flags).stderr(Stdio::null()).spawn().unwrap()
    }

    /// The bytes of a picture and of a floor's map.
    fn results(&self, picture: &str, maps: &str) -> [Vec<u8>; 2] {
        [picture.into(), Path::new(maps).join("floor.exr")].map(|name| fs::read(self.0.path().join(name)).unwrap())
    }
}

/// The same numbers from 0 to 1 in every run.
fn random_numbers() -> impl Iterator<Item = f64> {
    let mut state = 0x853c_49e6_748f_ea9bu64;
    std::iter::repeat_with(move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1u64 << 53) as f64
    })
}

#[test]
fn killed_ten_times_and_resumed_gives_the_same_bytes() {
    let workplace = Workplace::new();
    let start = Instant::now();
    assert_eq!(workplace.run(&["-o", "whole.exr", "--energy-maps", "whole"]).0, Some(0));
    let whole_run = start.elapsed();
    let keep = ["-o", "a.exr", "--energy-maps", "maps", "--checkpoint", "a.state", "--every", "1ms"];
    let resume = [&keep[..], &["--resume", "a.state"]].concat();
    let flags = || if workplace.path("a.state").exists() { &resume[..] } else { &keep[..] };
    let mut ended = 0;
    for number in random_numbers().take(10) {
        let mut child = workplace.start(flags());
        sleep(whole_run.mul_f64(0.9 * number));
        child.kill().unwrap();
        ended += usize::from(child.wait().unwrap().code().is_some());
    }
    assert!(ended < 5, "{ended} of 10 runs had ended before they were killed");
    assert!(workplace.path("a.state").exists(), "no run came as far as a checkpoint");
    let (status, said) = workplace.run(flags());
    assert_eq!(status, Some(0), "{said}");
    assert!(said.contains("resumed a.state: "), "{said}");
    assert!(workplace.results("a.exr", "maps") == workplace.results("whole.exr", "whole"), "the bytes differ");
    let (status, _) = workplace.run(&["-o", "b.exr", "--energy-maps", "b", "--seed", "6"]);
    assert_eq!(status, Some(0));
    assert!(workplace.results("b.exr", "b") != workplace.results("whole.exr", "whole"), "the comparison cannot fail");
}

#[test]
fn checkpoints_of_other_renders_are_refused_by_name() {
    let workplace = Workplace::new();
    let few = ["--photons", "10_000", "--samples", "2"];
    assert_eq!(workplace.run(&[&few[..], &["-o", "a.exr", "--checkpoint", "a.state"]].concat()).0, Some(0));
    let refused = |flags: &[&str], texts: &[&str]| {
        let (status, said) = workplace.run(&[&["--resume", "a.state", "-o", "x.exr"], flags].concat());
        assert_eq!(status, Some(2), "{flags:?}: {said}");
        for text in texts {
            assert!(said.contains(text), "{text:?} is missing in: {said}");
        }
    };
    let checkpoint = "a.state: cannot go on from this checkpoint of scene.toml: ";
    refused(&["--seed", "6"], &[checkpoint, "its seed is 5, and here it is 6"]);
    refused(&["--set", "materials.glass.ior=1.6"], &[checkpoint, "the scene's materials are not the same"]);
    refused(&["--set", "objects.ball.sphere.radius=0.2"], &[checkpoint, "are not the same"]);
    refused(&["--set", "lights.lamp.flux=1"], &[checkpoint, "the scene's lights are not the same"]);
    refused(&["--set", "camera.position.0=1"], &[checkpoint]);
    refused(&["--set", "output.layers=false"], &[checkpoint, "its list of layers is [Caustic"]);
    refused(&["--photons", "20_000", "--samples", "2"], &["its samples are lit by 10000 photons", "--photons 10000"]);
    refused(&["--photons", "5000", "--samples", "2"], &["it holds 10000 photons, and 5000 are asked for"]);
    refused(&["--photons", "10_000", "--samples", "1"], &["it holds 2 samples, and 1 are asked for"]);
    assert!(!workplace.path("x.exr").exists());

    let mut bytes = fs::read(workplace.path("a.state")).unwrap();
    *bytes.last_mut().unwrap() ^= 1;
    fs::write(workplace.path("a.state"), bytes).unwrap();
    refused(&few, &["a.state: cannot go on from this checkpoint: ", "it is damaged"]);
    fs::write(workplace.path("a.state"), "PNG").unwrap();
    refused(&few, &["a.state"]);
}

#[test]
fn more_samples_go_on_from_a_whole_render() {
    let workplace = Workplace::new();
    let photons = ["--photons", "10_000"];
    assert_eq!(
        workplace.run(&[&photons[..], &["--samples", "2", "-o", "a.exr", "--checkpoint", "a.state"]].concat()).0,
        Some(0)
    );
    let more = [&photons[..], &["--samples", "5"]].concat();
    assert_eq!(workplace.run(&[&more[..], &["--resume", "a.state", "-o", "a.exr"]].concat()).0, Some(0));
    assert_eq!(workplace.run(&[&more[..], &["-o", "b.exr"]].concat()).0, Some(0));
    assert!(fs::read(workplace.path("a.exr")).unwrap() == fs::read(workplace.path("b.exr")).unwrap());
}

/// Sends a signal by its name.
fn signal(child: &Child, name: &str) {
    assert!(Command::new("kill").args([&format!("-{name}"), &child.id().to_string()]).status().unwrap().success());
}

/// Waits until a file is there.
fn wait_for(path: &Path) {
    let start = Instant::now();
    while !path.exists() {
        assert!(start.elapsed() < Duration::from_secs(60), "{} never came", path.display());
        sleep(Duration::from_millis(5));
    }
}

#[test]
fn ctrl_c_writes_what_there_is_and_exits_with_130() {
    let endless =
        ["--photons", "4_000_000_000", "-o", "a.exr", "--stats", "a.json", "--checkpoint", "a.state", "--every", "1ms"];
    for (name, status) in [("INT", 130), ("TERM", 143)] {
        let workplace = Workplace::new();
        let mut child = workplace.start(&endless);
        wait_for(&workplace.path("a.state"));
        signal(&child, name);
        assert_eq!(child.wait().unwrap().code(), Some(status));
        let stats: serde_json::Value = serde_json::from_slice(&fs::read(workplace.path("a.json")).unwrap()).unwrap();
        assert_eq!((&stats["interrupted"], &stats["time_limit_reached"]), (&true.into(), &false.into()));
        assert_eq!(stats["camera"]["samples"], 1);
        let photons = stats["photons"]["emitted"].as_u64().unwrap();
        assert!(photons > 0 && photons < 4_000_000_000);
        let picture = diacaustic_tests::read_exr(&workplace.path("a.exr"));
        assert!(picture.channels["G"].iter().any(|value| *value > 0.0), "the picture is black");
    }
}

#[test]
fn a_signal_that_comes_twice_at_once_is_one_request() {
    let workplace = Workplace::new();
    let mut child =
        workplace.start(&["--photons", "4_000_000_000", "-o", "a.exr", "--checkpoint", "a.state", "--every", "1ms"]);
    wait_for(&workplace.path("a.state"));
    // As `timeout` sends it.
    let id = child.id();
    assert!(Command::new("sh").args(["-c", &format!("kill -TERM {id}; kill -TERM {id}")]).status().unwrap().success());
    assert_eq!(child.wait().unwrap().code(), Some(143));
    assert!(workplace.path("a.exr").exists(), "nothing is written");
}

#[test]
fn the_picture_comes_while_it_is_rendered_and_stays_the_same() {
    let workplace = Workplace::new();
    let mut child = workplace.start(&["--photons", "4_000_000_000", "-o", "a.png"]);
    wait_for(&workplace.path("a.png"));
    let preview = image::open(workplace.path("a.png")).unwrap().into_rgb8();
    assert!(child.try_wait().unwrap().is_none(), "the run has ended");
    child.kill().unwrap();
    child.wait().unwrap();
    assert!(preview.pixels().any(|pixel| pixel.0[1] > 50), "the preview is black");
}
