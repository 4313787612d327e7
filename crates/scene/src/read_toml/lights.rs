//! Reads the lights of a scene file and the image that an environment names.

use std::{
    collections::HashMap,
    path::{Path, PathBuf},
    sync::Arc,
};

use glam::Vec3;

use super::table::{Entry, Table};
use crate::{Error, Light, LightKind, RadianceMap, load_environment};

const FLUX: &str = "watts for each channel: [r, g, b] or one number for all three";
const POINT: &str = "3 numbers [x, y, z], metres";

/// Angular radius of the sun from the earth, degrees: half of 31′59″.
const SUN_ANGULAR_RADIUS: f32 = 0.2666;

/// The inner angle of a spot that states none, as a share of its outer angle.
const SPOT_CORE: f32 = 0.8;

/// What `type` in a light's table stands for.
#[derive(Clone, Copy)]
enum LightType {
    Sphere,
    Rectangle,
    Disk,
    Point,
    Spot,
    Directional,
    Sun,
    Environment,
}

impl LightType {
    const NAMES: [(&str, Self); 8] = [
        ("sphere", Self::Sphere),
        ("rectangle", Self::Rectangle),
        ("disk", Self::Disk),
        ("point", Self::Point),
        ("spot", Self::Spot),
        ("directional", Self::Directional),
        ("sun", Self::Sun),
        ("environment", Self::Environment),
    ];

    /// The keys besides those that every light takes.
    fn keys(self) -> &'static [&'static str] {
        match self {
            Self::Sphere => &["center", "radius", "flux"],
            Self::Rectangle => &["center", "edge_u", "edge_v", "flux"],
            Self::Disk => &["center", "normal", "radius", "flux"],
            Self::Point => &["position", "flux"],
            Self::Spot => &["position", "direction", "look_at", "inner_angle", "outer_angle", "flux"],
            Self::Directional => &["direction", "irradiance"],
            Self::Sun => &["direction", "irradiance", "angular_radius"],
            Self::Environment => &["image", "rotate", "scale"],
        }
    }
}

/// Reads lights; holds the images that they share.
pub(super) struct LightReader<'a> {
    base_dir: &'a Path,
    images: HashMap<PathBuf, Arc<RadianceMap>>,
}

impl<'a> LightReader<'a> {
    pub(super) fn new(base_dir: &'a Path) -> Self {
        Self { base_dir, images: HashMap::new() }
    }

    pub(super) fn read_all(&mut self, tables: &[Table<'_>]) -> Result<Vec<Light>, Error> {
        tables.iter().enumerate().map(|(index, table)| self.read(index, table)).collect()
    }

    fn read(&mut self, index: usize, table: &Table<'_>) -> Result<Light, Error> {
        let expected = "the name of a light type, such as \"sphere\"";
        let light_type = table.require("type", expected)?.choice("light type", &LightType::NAMES)?;
        table.allow_only(&[&["type", "name", "photon_share", "group"], light_type.keys()].concat())?;
        let name = table.get("name").map(|entry| entry.string("a string")).transpose()?;
        Ok(Light {
            name: name.map_or_else(|| format!("light {}", index + 1), str::to_owned),
            kind: self.read_kind(light_type, table)?,
            photon_share: table.get("photon_share").map_or(Ok(1), |entry| entry.whole32())?,
            group: read_group(table)?,
        })
    }

    fn read_kind(&mut self, light_type: LightType, table: &Table<'_>) -> Result<LightKind, Error> {
        let point = |key| table.require(key, POINT)?.vector();
        let direction = |key| table.require(key, "a direction: 3 numbers [x, y, z]")?.vector();
        let radius = || table.require("radius", "a number, metres")?.number();
        let flux = || table.require("flux", FLUX)?.color();
        Ok(match light_type {
            LightType::Sphere => LightKind::Sphere { center: point("center")?, radius: radius()?, flux: flux()? },
            LightType::Rectangle => LightKind::Rectangle {
                center: point("center")?,
                edge_u: point("edge_u")?,
                edge_v: point("edge_v")?,
                flux: flux()?,
            },
            LightType::Disk => LightKind::Disk {
                center: point("center")?,
                normal: direction("normal")?,
                radius: radius()?,
                flux: flux()?,
            },
            LightType::Point => LightKind::Point { position: point("position")?, flux: flux()? },
            LightType::Spot => read_spot(table)?,
            LightType::Directional => read_distant(table, 0.0)?,
            LightType::Sun => {
                let angular_radius = table.get("angular_radius").map(|entry| entry.number()).transpose()?;
                read_distant(table, angular_radius.unwrap_or(SUN_ANGULAR_RADIUS))?
            }
            LightType::Environment => self.read_environment(table)?,
        })
    }

    fn read_environment(&mut self, table: &Table<'_>) -> Result<LightKind, Error> {
        let image = table.require("image", "the path of an .hdr or .exr file, relative to the scene file")?;
        Ok(LightKind::Environment {
            map: self.read_image(&image)?,
            rotate: table.get("rotate").map_or(Ok(0.0), |entry| entry.number())?,
            scale: table.get("scale").map_or(Ok(Vec3::ONE), |entry| entry.color())?,
        })
    }

    fn read_image(&mut self, entry: &Entry<'_>) -> Result<Arc<RadianceMap>, Error> {
        let path = self.base_dir.join(entry.string("the path of an .hdr or .exr file, relative to the scene file")?);
        if let Some(map) = self.images.get(&path) {
            return Ok(Arc::clone(map));
        }
        let map = load_environment(&path).map_err(|cause| Error::File {
            at: entry.location(),
            place: entry.place(),
            cause: Box::new(cause),
        })?;
        let map = Arc::new(map);
        self.images.insert(path, Arc::clone(&map));
        Ok(map)
    }
}

/// The name of a light group, if one is stated.
pub(super) fn read_group(table: &Table<'_>) -> Result<Option<String>, Error> {
    let name = table.get("group").map(|entry| entry.string("the name of a light group")).transpose()?;
    Ok(name.map(str::to_owned))
}

fn read_spot(table: &Table<'_>) -> Result<LightKind, Error> {
    let position = table.require("position", POINT)?.vector()?;
    let aim =
        table.either("direction", "look_at", "a direction [x, y, z], or \"look_at\", a point [x, y, z], metres")?;
    let mut direction = aim.vector()?;
    if aim.key() == "look_at" {
        direction -= position;
        if direction == Vec3::ZERO {
            return Err(aim.error("is the light's position; it must be another point"));
        }
    }
    let outer_angle = table.require("outer_angle", "a number of degrees off the axis")?.number()?;
    let inner_angle = table.get("inner_angle").map_or(Ok(SPOT_CORE * outer_angle), |entry| entry.number())?;
    let flux = table.require("flux", FLUX)?.color()?;
    Ok(LightKind::Spot { position, direction, inner_angle, outer_angle, flux })
}

fn read_distant(table: &Table<'_>, angular_radius: f32) -> Result<LightKind, Error> {
    let expected = "W/m² for each channel: [r, g, b] or one number for all three";
    Ok(LightKind::Distant {
        direction: table
            .require("direction", "the direction in which the light flies: 3 numbers [x, y, z]")?
            .vector()?,
        angular_radius,
        irradiance: table.require("irradiance", expected)?.color()?,
    })
}
