//! Light groups: lights whose share of the picture is kept apart.

use crate::{Light, Material, Scene};

/// The most light groups that a picture can keep apart.
pub const MOST_LIGHT_GROUPS: usize = 8;

/// The group of lights that name none.
pub const DEFAULT_LIGHT_GROUP: &str = "default";

/// The name under which layers keep what no light sends: the constant background and Phong's ambient light.
pub const BACKGROUND_GROUP: &str = "background";

/// The light groups of a scene.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct LightGroups {
    /// Their names, in the order of the scene: first those of its lights, then those of materials that shine and that objects show.
    pub names: Vec<String>,
    /// For each of [`Scene::lights`], the index of its group.
    pub of_lights: Vec<usize>,
    /// For each of [`Scene::materials`], the index of its group; 0 for one that does not shine.
    pub of_materials: Vec<usize>,
}

impl LightGroups {
    /// A single group of all that shines.
    pub fn single(scene: &Scene) -> Self {
        Self {
            names: vec![DEFAULT_LIGHT_GROUP.to_owned()],
            of_lights: vec![0; scene.lights.len()],
            of_materials: vec![0; scene.materials.len()],
        }
    }

    fn of(scene: &Scene) -> Self {
        let mut names: Vec<String> = Vec::new();
        let mut index_of = |group: &Option<String>| {
            let name = group.as_deref().unwrap_or(DEFAULT_LIGHT_GROUP);
            names.iter().position(|known| known == name).unwrap_or_else(|| {
                names.push(name.to_owned());
                names.len() - 1
            })
        };
        let of_lights = scene.lights.iter().map(|light: &Light| index_of(&light.group)).collect();
        let of_materials = (0..scene.materials.len()).map(|index| {
            let material: &Material = &scene.materials[index];
            if material.is_emissive() && scene.shows(index) { index_of(&material.group) } else { 0 }
        });
        let of_materials = of_materials.collect();
        Self { names, of_lights, of_materials }
    }
}

impl Scene {
    /// The groups of all that shines.
    pub fn light_groups(&self) -> LightGroups {
        LightGroups::of(self)
    }

    /// Whether an object shows a material.
    pub fn shows(&self, material: usize) -> bool {
        self.objects.iter().any(|object| object.materials.contains(&material))
    }
}
