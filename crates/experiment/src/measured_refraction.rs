//! Equation 3 as the kernels carry it out: single rays of the profile `paper` through a tilted slab of glass onto a wall.

use std::path::Path;

use diacaustic::{EnergyMap, Renderer, scene::parse_scene};

use crate::{Error, closed_forms::INDICES};

/// Angles of incidence, degrees.
const ANGLES: [f64; 8] = [10.0, 20.0, 30.0, 40.0, 50.0, 60.0, 70.0, 80.0];
/// Texels along the wall, which is 2 m wide.
const TEXELS: u32 = 2001;

/// What the kernels make of the two refractions of the profile `paper`.
#[derive(Clone, Debug, PartialEq)]
pub struct MeasuredRefraction {
    /// Index of the glass.
    pub ior: f64,
    /// Angles of incidence and of refraction by equation 3, degrees.
    pub printed: Vec<[f64; 2]>,
    /// The same by Snell's law.
    pub exact: Vec<[f64; 2]>,
}

/// Sends rays into glass of each index of the plot, at angles up to 80°. Blocks.
pub(crate) fn measure_refractions(renderer: &mut Renderer) -> Result<Vec<MeasuredRefraction>, Error> {
    let measured = |ior: f64| {
        let mut by = |law: &str| -> Result<Vec<_>, Error> {
            ANGLES.iter().map(|&angle| refract(renderer, ior, law, angle)).collect()
        };
        Ok(MeasuredRefraction { ior, printed: by("printed")?, exact: by("exact")? })
    };
    INDICES.into_iter().map(measured).collect()
}

/// The angles of incidence and of refraction of one ray, degrees.
fn refract(renderer: &mut Renderer, ior: f64, law: &str, degrees: f64) -> Result<[f64; 2], Error> {
    let cell = || format!("the measurement of {law} refraction into {ior} at {degrees}°");
    let of_scene = |cause| Error::Scene { cell: cell(), cause: Box::new(cause) };
    let of_render = |cause| Error::Render { cell: cell(), cause: Box::new(cause) };
    let scene = parse_scene(&slab(ior, law, degrees), Path::new("."), "the slab").map_err(of_scene)?.scene;
    renderer.set_scene(&scene).map_err(of_render)?;
    renderer.emit_photons(0..1).map_err(of_render)?;
    let map = renderer.energy_map(0).map_err(of_render)?;
    let aside = map.as_ref().map_or(f64::NAN, place_of_ray);
    // Out of a slab of 1 m the ray goes on in its old direction, sin(θi − θt)/cos θt metres aside.
    let theta = degrees.to_radians();
    Ok([degrees, ((theta.sin() - aside) / theta.cos()).atan().to_degrees()])
}

/// A slab of 1 m thickness, `degrees` off the one ray of a grid, which flies along −x; behind it a wall with a strip of texels 1 mm apart.
fn slab(ior: f64, law: &str, degrees: f64) -> String {
    format!(
        "camera = {{ position = [25, 0, 0], look_at = [0, 0, 0], vertical_fov = 40 }}
         render = {{ width = 8, height = 8, profile = \"paper\", photons = 1 }}
         paper = {{ refraction = \"{law}\", map_size = {TEXELS}, map_size_in = \"texels\" }}
         materials.wall = {{ type = \"diffuse\", albedo = 1 }}
         materials.glass = {{ type = \"dielectric\", ior = {ior} }}
         lights = [{{ type = \"point\", position = [20, 0, 0], flux = 1 }}]
         objects = [
             {{ rectangle = {{ center = [-20, 0, 0], edge_u = [0, 2, 0], edge_v = [0, 0, 0.01] }}, material = \"wall\" }},
             {{ box = {{ min = [-0.5, -8, -1], max = [0.5, 8, 1] }}, material = \"glass\", rotate = [0, 0, {degrees}] }},
         ]"
    )
}

/// How far from the middle of the wall the ray has fallen, toward −y, metres.
fn place_of_ray(map: &EnergyMap) -> f64 {
    let (mut sum, mut moment) = (0.0, 0.0);
    for texel in 0..map.sums.len() {
        let energy = map.flux(texel).y;
        sum += energy;
        moment += energy * (texel % map.width as usize) as f64;
    }
    1.0 - 2.0 * moment / (sum * f64::from(TEXELS - 1))
}
