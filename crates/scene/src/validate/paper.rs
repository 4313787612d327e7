//! Checks the profile `paper`, which refuses what the 2016 paper has nothing of.

use glam::Vec3;

use super::at::{At, above};
use crate::{
    Error, Layer, LightKind, Material, MaterialKind, Object, PaperMapSize, PaperProfile, PaperSampling, SMOOTH, Scene,
    Subject,
};

/// The sizes of maps, texels along the longer side.
const MAP_SIZES: std::ops::RangeInclusive<u32> = 2..=8192;

impl Scene {
    pub(super) fn check_paper(&self) -> Result<(), Error> {
        let Some(profile) = &self.settings.paper else { return Ok(()) };
        check_profile(profile)?;
        self.check_settings_for_paper(profile)?;
        self.check_light_for_paper()?;
        for (index, material) in self.materials.iter().enumerate().filter(|(index, _)| self.shows(*index)) {
            check_material(&At(Subject::Material { index, name: material.name.clone() }), material)?;
        }
        self.check_maps_for_paper(profile)
    }

    fn check_settings_for_paper(&self, profile: &PaperProfile) -> Result<(), Error> {
        let at = At(Subject::Render);
        let settings = &self.settings;
        at.require(!settings.guiding, "guiding", || {
            "is true, but in the profile \"paper\" rays go where equation 1 sends them; set guiding = false".to_owned()
        })?;
        at.require(!settings.footprints, "footprints", || {
            "is true, but the profile \"paper\" lays each ray on four texels; set footprints = false".to_owned()
        })?;
        at.require(!settings.map_filter, "map_filter", || {
            "is true, but the profile \"paper\" shows energy maps as they are; set map_filter = false".to_owned()
        })?;
        at.require(settings.max_bounces == 0, "max_bounces", || {
            format!(
                "is {}, but the profile \"paper\" has no light between diffuse surfaces; set max_bounces = 0",
                settings.max_bounces
            )
        })?;
        at.require(settings.wavelength.is_none(), "wavelength", || {
            "is set, but the profile \"paper\" has no dispersion; leave it out".to_owned()
        })?;
        at.require(settings.map_size.is_none(), "map_size", || {
            "is set, but in the profile \"paper\" the size of maps is map_size in [paper]; set that instead".to_owned()
        })?;
        at.require(settings.map_budget.is_none(), "map_budget", || {
            "is set, but in the profile \"paper\" the size of maps is map_size in [paper]; leave it out".to_owned()
        })?;
        let photons = settings.photons.ok_or_else(|| {
            let problem = "is left open, but in the profile \"paper\" more rays are brighter; state their number";
            at.error("photons", problem.to_owned())
        })?;
        let is_square = photons.isqrt().pow(2) == photons;
        at.require(profile.sampling != PaperSampling::Grid || is_square, "photons", || {
            let root = photons.isqrt();
            format!(
                "is {photons}; a grid of angles needs a square, such as {} or {}; or set sampling = \"random\" in [paper]",
                root * root,
                (root + 1) * (root + 1)
            )
        })?;
        At(Subject::Output).require(!self.output.layers.contains(&Layer::LightGroups), "layers", || {
            "asks for light groups, but the profile \"paper\" has one light; name layers without \"light_groups\""
                .to_owned()
        })
    }

    fn check_light_for_paper(&self) -> Result<(), Error> {
        At(Subject::Scene).require(self.lights.len() == 1, "lights", || {
            format!("has {} lights; the profile \"paper\" has exactly one", self.lights.len())
        })?;
        let light = &self.lights[0];
        let at = At(Subject::Light { index: 0, name: light.name.clone() });
        let is_a_position = matches!(light.kind, LightKind::Sphere { .. } | LightKind::Point { .. });
        at.require(is_a_position, "type", || {
            "is none that the profile \"paper\" has; it must be \"sphere\" or \"point\"".to_owned()
        })?;
        at.require(!light.kind.is_dark(), "flux", || {
            "is 0, and a light that is off sends no rays; it must be greater than 0 in some channel".to_owned()
        })
    }

    fn check_maps_for_paper(&self, profile: &PaperProfile) -> Result<(), Error> {
        let at = At(Subject::Paper);
        for (index, object) in self.objects.iter().enumerate() {
            let is_receiver = object.materials.iter().any(|&material| self.materials[material].is_receiver());
            check_object(index, object)?;
            let texels = profile.map_size.texels(object);
            at.require(!is_receiver || MAP_SIZES.contains(&texels), "map_size", || {
                format!(
                    "gives object {:?} a map of {texels} texels along its longer side; there must be from 2 to 8192",
                    object.name
                )
            })?;
        }
        Ok(())
    }
}

fn check_object(index: usize, object: &Object) -> Result<(), Error> {
    At(Subject::Object { index, name: object.name.clone() }).require(object.map_size.is_none(), "map_size", || {
        "is set, but in the profile \"paper\" the size of maps is map_size in [paper]; leave it out".to_owned()
    })
}

fn check_profile(profile: &PaperProfile) -> Result<(), Error> {
    let at = At(Subject::Paper);
    at.channels("energy", profile.energy, 0.0.., "0 or greater")?;
    at.require(profile.energy != Vec3::ZERO, "energy", || {
        "is 0; some channel must be greater than 0, or rays bring nothing".to_owned()
    })?;
    at.direction("pole", profile.pole)?;
    at.number("transparency", profile.transparency, 0.0..=1.0, "from 0 to 1")?;
    match profile.map_size {
        PaperMapSize::Texels(texels) => at.number("map_size", texels, MAP_SIZES, "from 2 to 8192 (texels)"),
        PaperMapSize::Millimetres(distance) => at.number("map_size", distance, above(0.0), "greater than 0 (mm)"),
    }
}

fn check_material(at: &At, material: &Material) -> Result<(), Error> {
    let kind = match material.kind {
        MaterialKind::Diffuse { .. } | MaterialKind::Phong { .. } | MaterialKind::Mirror { .. } => None,
        MaterialKind::Dielectric { .. } => None,
        MaterialKind::Conductor { .. } => Some("\"conductor\""),
        MaterialKind::ThinWalled { .. } => Some("\"thin_walled\""),
        MaterialKind::Coated { .. } => Some("\"coated\""),
        MaterialKind::MetallicRoughness { .. } => Some("\"metallic_roughness\""),
    };
    at.require(kind.is_none(), "type", || {
        format!(
            "is {}, which the profile \"paper\" has not; it must be \"phong\", \"diffuse\", \"mirror\" or \"dielectric\"",
            kind.unwrap_or_default()
        )
    })?;
    at.require(material.blend.is_none(), "rest", || {
        "is set, but in the profile \"paper\" a surface is of one material; leave out share and rest".to_owned()
    })?;
    at.require(!material.is_emissive(), "emission", || {
        "is set, but the profile \"paper\" has one light, which is no surface; leave it out".to_owned()
    })?;
    at.require(material.dispersion().is_none(), "dispersion", || {
        "is there, but the profile \"paper\" has none; set dispersion = false, or an ior without abbe".to_owned()
    })?;
    let MaterialKind::Dielectric { roughness, .. } = material.kind else { return Ok(()) };
    at.require(material.textures.color.is_none(), "tint", || {
        "is a picture, but in the profile \"paper\" an object has one colour; give it as numbers".to_owned()
    })?;
    at.require(roughness < SMOOTH && material.textures.roughness.is_none(), "roughness", || {
        "makes the glass rough, which the profile \"paper\" has not; set roughness = 0".to_owned()
    })
}
