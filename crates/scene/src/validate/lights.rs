//! Checks lights.

use std::{collections::HashMap, ops::Bound};

use glam::Vec3;

use super::at::{At, above};
use crate::{
    BACKGROUND_GROUP, Error, Layer, Light, LightKind, MOST_LIGHT_GROUPS, RadianceMap, Scene, Subject,
    primitives::are_perpendicular,
};

impl Scene {
    pub(super) fn check_lights(&self) -> Result<(), Error> {
        let mut names = HashMap::new();
        let mut environment: Option<&Light> = None;
        for (index, light) in self.lights.iter().enumerate() {
            let at = At(Subject::Light { index, name: light.name.clone() });
            at.unique_name(&mut names, index, &light.name)?;
            at.number("photon_share", light.photon_share, 1..=1000, "from 1 to 1000")?;
            check_kind(&at, &light.kind)?;
            let LightKind::Environment { .. } = light.kind else { continue };
            if let Some(first) = environment.replace(light) {
                let problem = format!("is environment, as that of {:?} is; a scene has one at most", first.name);
                return Err(at.error("type", problem));
            }
        }
        Ok(())
    }

    pub(super) fn check_light_groups(&self) -> Result<(), Error> {
        for (index, light) in self.lights.iter().enumerate() {
            check_group(&At(Subject::Light { index, name: light.name.clone() }), light.group.as_deref())?;
        }
        for (index, material) in self.materials.iter().enumerate() {
            check_group(&At(Subject::Material { index, name: material.name.clone() }), material.group.as_deref())?;
        }
        let count = self.light_groups().names.len();
        let is_kept = self.output.layers.contains(&Layer::LightGroups);
        At(Subject::Output).require(!is_kept || count <= MOST_LIGHT_GROUPS, "layers", || {
            format!(
                "asks for those of {count} light groups; there can be {MOST_LIGHT_GROUPS} at most: give lights the same group, \
                 or name layers without \"light_groups\""
            )
        })
    }
}

/// Refuses names of groups that layers cannot be named after.
fn check_group(at: &At, group: Option<&str>) -> Result<(), Error> {
    let Some(name) = group else { return Ok(()) };
    let is_plain = !name.is_empty() && name.chars().all(|c| c.is_ascii_alphanumeric() || "_-".contains(c));
    at.require(is_plain, "group", || {
        format!(
            "is {name:?}; it must be of the letters a to z and A to Z, digits, _ and -, for layers are named after it"
        )
    })?;
    at.require(name != BACKGROUND_GROUP, "group", || {
        format!("is {name:?}, which is the name of what no light sends; it must be another")
    })
}

fn check_kind(at: &At, kind: &LightKind) -> Result<(), Error> {
    let check_radius = |radius| at.number("radius", radius, above(0.0), "greater than 0 (metres)");
    let check_flux = |flux| at.channels("flux", flux, 0.0.., "0 or greater (watts)");
    match *kind {
        LightKind::Sphere { center, radius, flux } => {
            at.position("center", center)?;
            check_radius(radius)?;
            check_flux(flux)?;
            check_strength(at, kind, "radius")
        }
        LightKind::Rectangle { center, edge_u, edge_v, flux } => {
            at.position("center", center)?;
            check_edges(at, edge_u, edge_v)?;
            check_flux(flux)?;
            check_strength(at, kind, "edge_u")
        }
        LightKind::Disk { center, normal, radius, flux } => {
            at.position("center", center)?;
            at.direction("normal", normal)?;
            check_radius(radius)?;
            check_flux(flux)?;
            check_strength(at, kind, "radius")
        }
        LightKind::Point { position, flux } => {
            at.position("position", position)?;
            check_flux(flux)
        }
        LightKind::Spot { position, direction, inner_angle, outer_angle, flux } => {
            at.position("position", position)?;
            at.direction("direction", direction)?;
            check_cone(at, inner_angle, outer_angle)?;
            check_flux(flux)?;
            check_strength(at, kind, "outer_angle")
        }
        LightKind::Distant { direction, angular_radius, irradiance } => {
            at.direction("direction", direction)?;
            at.number("angular_radius", angular_radius, 0.0..90.0, "from 0 to less than 90 (degrees)")?;
            at.channels("irradiance", irradiance, 0.0.., "0 or greater (W/m²)")?;
            check_strength(at, kind, "angular_radius")
        }
        LightKind::Environment { ref map, rotate, scale } => {
            at.number("rotate", rotate, .., "a finite number of degrees")?;
            at.channels("scale", scale, 0.0.., "0 or greater")?;
            check_map(at, map, scale)
        }
    }
}

fn check_strength(at: &At, kind: &LightKind, key: &'static str) -> Result<(), Error> {
    let size = match *kind {
        LightKind::Rectangle { edge_u, .. } => edge_u.length(),
        LightKind::Sphere { radius, .. } | LightKind::Disk { radius, .. } => radius,
        LightKind::Spot { outer_angle, .. } => outer_angle,
        LightKind::Distant { angular_radius, .. } => angular_radius,
        LightKind::Point { .. } | LightKind::Environment { .. } => return Ok(()),
    };
    at.require(kind.strength().is_finite(), key, || {
        format!("is {size:e}; so small a light of this flux has no finite radiance; it must be larger")
    })
}

fn check_edges(at: &At, edge_u: Vec3, edge_v: Vec3) -> Result<(), Error> {
    for (key, edge) in [("edge_u", edge_u), ("edge_v", edge_v)] {
        at.position(key, edge)?;
        at.require(edge.length() > 0.0, key, || format!("is {edge}; its length must be greater than 0 (metres)"))?;
    }
    at.require(are_perpendicular(edge_u, edge_v), "edge_v", || {
        format!("is {edge_v}; it must be perpendicular to edge_u, {edge_u}")
    })
}

fn check_cone(at: &At, inner_angle: f32, outer_angle: f32) -> Result<(), Error> {
    let to_straight = (Bound::Excluded(0.0), Bound::Included(180.0));
    at.number("outer_angle", outer_angle, to_straight, "greater than 0 and at most 180 (degrees)")?;
    let right = format!("from 0 to less than outer_angle, {outer_angle} (degrees)");
    at.number("inner_angle", inner_angle, 0.0..outer_angle, &right)
}

fn check_map(at: &At, map: &RadianceMap, scale: Vec3) -> Result<(), Error> {
    map.check().map_err(|problem| at.error("image", problem))?;
    let brightest = map.texels.iter().copied().fold(Vec3::ZERO, Vec3::max);
    at.require((brightest * scale).is_finite(), "scale", || {
        let (scale, brightest) = (scale.to_array(), brightest.to_array());
        format!("is {scale:?}; times the image's brightest channels, {brightest:?}, it must be finite")
    })
}
