//! Lights of KHR_lights_punctual and cameras.

use std::f32::consts::PI;

use glam::{DAffine3, DVec3, Vec3};
use gltf_json::{
    Root,
    extensions::scene::khr_lights_punctual::{Light as GltfLight, Type},
    validation::Checked,
};

use super::{
    fault::{Fault, Result, entry, place},
    nodes::node_place,
};
use crate::{Camera, LightKind};

/// Lumens that stand for a watt: the photometric numbers of a file become radiometric ones by it, as in Blender's exporter.
pub(super) const LUMENS_PER_WATT: f32 = 683.0;

/// A camera, and the shape of its picture.
#[derive(Clone, Debug, PartialEq)]
pub struct GltfCamera {
    /// The view.
    pub camera: Camera,
    /// Width of the picture over its height, if the file states it.
    pub aspect_ratio: Option<f32>,
}

/// The light of a node, if it has one, with its name.
pub(super) fn read_light(root: &Root, node: usize, world: &DAffine3) -> Result<Option<(Option<String>, LightKind)>> {
    let extensions = root.nodes[node].extensions.as_ref();
    let Some(named) = extensions.and_then(|extensions| extensions.khr_lights_punctual.as_ref()) else {
        return Ok(None);
    };
    let lights: &[GltfLight] = root.as_ref();
    let light = entry(lights, "lights", named.light.value(), &node_place(root, node))?;
    let place = place("lights", named.light.value(), light.name.as_deref());
    Ok(Some((light.name.clone(), light_kind(light, world, &place)?)))
}

fn light_kind(light: &GltfLight, world: &DAffine3, place: &str) -> Result<LightKind> {
    let strength = Vec3::from(light.color) * light.intensity / LUMENS_PER_WATT;
    if !strength.is_finite() || strength.cmplt(Vec3::ZERO).any() {
        return Err(Fault::new(place, "has a color times intensity that is negative or not finite"));
    }
    let (position, direction) = (world.translation.as_vec3(), forward(world, place)?);
    match (&light.type_, &light.spot) {
        (Checked::Valid(Type::Directional), _) => {
            Ok(LightKind::Distant { direction, angular_radius: 0.0, irradiance: strength })
        }
        (Checked::Valid(Type::Point), _) => Ok(LightKind::Point { position, flux: 4.0 * PI * strength }),
        (Checked::Valid(Type::Spot), spot) => {
            let spot = spot.clone().unwrap_or_default();
            let (inner, outer) =
                (spot.inner_cone_angle, if spot.outer_cone_angle == 0.0 { PI / 4.0 } else { spot.outer_cone_angle });
            if !(inner >= 0.0 && inner < outer && outer <= PI / 2.0 + 1e-4) {
                let problem = format!("has cone angles of {inner} and {outer} radians; they must rise from 0 to π/2");
                return Err(Fault::new(place, problem));
            }
            let unit = LightKind::Spot {
                position,
                direction,
                inner_angle: inner.to_degrees(),
                outer_angle: outer.to_degrees(),
                flux: Vec3::ONE,
            };
            // The flux that makes the intensity on the axis what the file states.
            let flux = strength / unit.strength();
            Ok(match unit {
                LightKind::Spot { position, direction, inner_angle, outer_angle, .. } => {
                    LightKind::Spot { position, direction, inner_angle, outer_angle, flux }
                }
                other => other,
            })
        }
        (Checked::Invalid, _) => Err(Fault::new(place, "has an unknown type; it must be directional, point or spot")),
    }
}

/// The direction in which a node's light and camera look: its −z.
fn forward(world: &DAffine3, place: &str) -> Result<Vec3> {
    let direction = world.transform_vector3(DVec3::NEG_Z).try_normalize();
    Ok(direction.ok_or_else(|| Fault::new(place, "stands at a node whose scale is 0"))?.as_vec3())
}

/// The camera of a node, if it has one that a thin lens can stand for; what is wrong with another is a warning.
pub(super) fn read_camera(
    root: &Root,
    node: usize,
    world: &DAffine3,
    warnings: &mut Vec<Fault>,
) -> Result<Option<GltfCamera>> {
    let Some(index) = root.nodes[node].camera else { return Ok(None) };
    let source = entry(&root.cameras, "cameras", index.value(), &node_place(root, node))?;
    let place = place("cameras", index.value(), source.name.as_deref());
    let Some(perspective) = &source.perspective else {
        warnings.push(Fault::new(place, "is orthographic, which is not supported; it is passed over"));
        return Ok(None);
    };
    let vertical_fov = perspective.yfov.to_degrees();
    if !(vertical_fov > 0.0 && vertical_fov < 180.0) {
        return Err(Fault::new(place, format!("has a yfov of {}; it must be between 0 and π", perspective.yfov)));
    }
    let aspect_ratio = perspective.aspect_ratio;
    if aspect_ratio.is_some_and(|ratio| !(ratio > 0.0 && ratio.is_finite())) {
        return Err(Fault::new(place, "has an aspectRatio that is not a number greater than 0"));
    }
    let position = world.translation.as_vec3();
    let up = world.transform_vector3(DVec3::Y).normalize_or(DVec3::Y).as_vec3();
    let camera = Camera {
        position,
        look_at: position + forward(world, &place)?,
        up,
        vertical_fov,
        aperture_radius: 0.0,
        focus_distance: 1.0,
    };
    Ok(Some(GltfCamera { camera, aspect_ratio }))
}
