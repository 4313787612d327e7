//! The profile `paper`: what its keys mean, and what it refuses.

use std::path::Path;

use diacaustic_scene::{PaperMapSize, PaperProfile, PaperRefraction, PaperSampling, Scene, parse_scene};
use glam::Vec3;

const GOOD: &str = r#"ambient = 0.1
[camera]
position = [0, 2, 3]
look_at = [0, 0, 0]
vertical_fov = 40
[render]
profile = "paper"
photons = 90000
[paper]
map_size = 10
[materials.glass]
type = "dielectric"
ior = 1.5
[materials.floor]
type = "phong"
ambient = 0.3
diffuse = 0.5
specular = 0.1
shininess = 20
[[lights]]
type = "sphere"
center = [1, 2.5, 0.6]
radius = 0.05
flux = 35
[[objects]]
sphere = { center = [0, 0.4, 0], radius = 0.3 }
material = "glass"
[[objects]]
name = "ground"
rectangle = { center = [0, 0, 0], edge_u = [4, 0, 0], edge_v = [0, 0, -2] }
material = "floor"
"#;

fn read(text: &str) -> Result<Scene, String> {
    parse_scene(text, Path::new("/nowhere"), "x.toml").map(|loaded| loaded.scene).map_err(|error| error.to_string())
}

#[test]
fn unset_keys_have_the_papers_values() {
    let scene = read(&GOOD.replace("[paper]\nmap_size = 10\n", "")).unwrap();
    let expected = PaperProfile {
        energy: Vec3::splat(35.0),
        refraction: PaperRefraction::Printed,
        sampling: PaperSampling::Grid,
        pole: Vec3::Z,
        map_size: PaperMapSize::Millimetres(10.0),
        transparency: 0.9,
    };
    assert_eq!(scene.settings.paper, Some(expected));
    assert_eq!((scene.settings.guiding, scene.settings.max_bounces), (false, 0));
    assert_eq!(expected.map_size.texels(&scene.objects[1]), 401, "4 m at 10 mm");
    let physical = read(&GOOD.replace("profile = \"paper\"", "").replace("[paper]\nmap_size = 10\n", "")).unwrap();
    assert_eq!((physical.settings.paper, physical.settings.guiding), (None, true));
}

#[test]
fn every_key_is_read() {
    let keys = "energy = [5, 6, 7]\nrefraction = \"exact\"\nsampling = \"random\"\npole = [0, 2, 0]\nmap_size = 50\n\
                map_size_in = \"texels\"\ntransparency = 0.5\n";
    let scene = read(&GOOD.replace("map_size = 10\n", keys).replace("90000", "90001")).unwrap();
    let expected = PaperProfile {
        energy: Vec3::new(5.0, 6.0, 7.0),
        refraction: PaperRefraction::Exact,
        sampling: PaperSampling::Random,
        pole: Vec3::new(0.0, 2.0, 0.0),
        map_size: PaperMapSize::Texels(50),
        transparency: 0.5,
    };
    assert_eq!(scene.settings.paper, Some(expected));
    assert_eq!(expected.map_size.texels(&scene.objects[1]), 50);
}

#[test]
fn what_the_paper_has_not_is_refused_by_name() {
    let second_light = "type = \"point\"\nposition = [0, 1, 0]\nflux = 1\n[[lights]]\ntype = \"sphere\"";
    let cases = [
        ("profile = \"paper\"", "profile = \"papr\"", "there is no profile \"papr\"; did you mean \"paper\"?"),
        ("profile = \"paper\"\n", "", "counts only with profile = \"paper\" in [render]"),
        ("profile = \"paper\"", "profile = \"paper\"\nguiding = true", "x.toml:8:1: render: guiding is true"),
        ("profile = \"paper\"", "profile = \"paper\"\nfootprints = true", "footprints is true"),
        ("profile = \"paper\"", "profile = \"paper\"\nmap_filter = true", "map_filter is true"),
        ("profile = \"paper\"", "profile = \"paper\"\nmax_bounces = 2", "max_bounces is 2"),
        ("profile = \"paper\"", "profile = \"paper\"\nwavelength = 550", "wavelength is set"),
        ("profile = \"paper\"", "profile = \"paper\"\nmap_size = 5", "render: map_size is set"),
        ("90000", "100000", "photons is 100000; a grid of angles needs a square, such as 99856 or 100489"),
        ("[paper]", "[output]\nlayers = [\"light_groups\"]\n[paper]", "layers asks for light groups"),
        ("type = \"sphere\"", second_light, "lights has 2 lights; the profile \"paper\" has exactly one"),
        (
            "type = \"sphere\"\ncenter = [1, 2.5, 0.6]\nradius = 0.05\nflux = 35",
            "type = \"directional\"\ndirection = [0, -1, 0]\nirradiance = 3",
            "type is none that the profile \"paper\" has",
        ),
        ("flux = 35", "flux = 0", "flux is 0"),
        ("ior = 1.5", "substance = \"bk7\"", "material \"glass\": dispersion is there"),
        ("ior = 1.5", "ior = 1.5\nroughness = 0.2", "roughness makes the glass rough"),
        ("\"dielectric\"", "\"thin_walled\"", "type is \"thin_walled\""),
        ("shininess = 20", "shininess = 20\nemission = 1", "material \"floor\": emission is set"),
        ("name = \"ground\"", "name = \"ground\"\nmap_size = 5", "object \"ground\": map_size is set"),
        ("map_size = 10", "map_size = 0.2", "map_size gives object \"ground\" a map of 20001 texels"),
        ("map_size = 10", "map_size = 0", "map_size is 0; it must be greater than 0 (mm)"),
        ("map_size = 10", "map_size = 1\nmap_size_in = \"texels\"", "map_size is 1; it must be from 2 to 8192"),
        ("map_size = 10", "energy = 0", "energy is 0"),
        ("map_size = 10", "transparency = 1.5", "transparency is 1.5; it must be from 0 to 1"),
        ("map_size = 10", "pole = [0, 0, 0]", "pole is"),
        ("map_size = 10", "mapsize = 10", "unknown key \"mapsize\""),
    ];
    read(GOOD).unwrap();
    for (line, changed, expected) in cases {
        assert!(GOOD.contains(line), "{line}");
        let error = read(&GOOD.replacen(line, changed, 1)).expect_err(expected);
        assert!(error.contains(expected), "expected {expected:?}, found {error:?}");
    }
}
