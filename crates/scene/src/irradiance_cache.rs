//! Whether a scene has an irradiance cache.

use crate::{Layer, Scene};

impl Scene {
    /// Whether light that bounces to receivers is measured by a few camera paths and shared by all others: as the scene says, else where it
    /// leaves its samples open and nothing stands against it.
    pub fn keeps_irradiance_cache(&self) -> bool {
        let settings = &self.settings;
        let chosen = || settings.samples.is_none() && self.obstacle_to_irradiance_cache().is_none();
        settings.max_bounces > 0 && settings.irradiance_cache.unwrap_or_else(chosen)
    }

    /// What in the scene cannot be together with an irradiance cache, and the remedy.
    pub(crate) fn obstacle_to_irradiance_cache(&self) -> Option<&'static str> {
        let keeps_groups = self.output.layers.contains(&Layer::LightGroups) && self.light_groups().names.len() > 1;
        let obstacles = [
            (self.settings.paper.is_some(), "the profile \"paper\" has no light between diffuse surfaces"),
            (
                self.settings.wavelength.is_some(),
                "the cache holds red, green and blue light, not that of the one wavelength",
            ),
            (keeps_groups, "the cache does not keep light groups apart, as output.layers asks for"),
        ];
        obstacles.into_iter().find(|(stands, _)| *stands).map(|(_, obstacle)| obstacle)
    }
}
