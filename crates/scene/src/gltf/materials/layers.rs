//! What extensions lay on an opaque material: another reflectance, a clear coat, or its colour as light of its own.

use glam::Vec3;
use serde_json::{Map, Value};

use super::{
    super::fault::{Fault, Result},
    numbers::share,
};
use crate::PLASTIC_REFLECTANCE;

pub(super) const CLEARCOAT: &str = "KHR_materials_clearcoat";
const SPECULAR: &str = "KHR_materials_specular";

/// The greatest reflectance along the normal of what is no metal.
const MOST_REFLECTANCE: f32 = 0.9;

/// The numbers of those extensions.
#[derive(Clone, Copy)]
pub(super) struct Layers {
    /// Reflectance along the normal of what is no metal.
    pub(super) reflectance: Vec3,
    /// Whether KHR_materials_specular changes it.
    pub(super) has_specular: bool,
    /// Whether pictures change it, which are not read.
    pub(super) has_specular_pictures: bool,
    /// Strength and roughness of the clear coat.
    pub(super) coat: Option<[f32; 2]>,
    /// Whether the material shows its colour whatever the light.
    pub(super) is_unlit: bool,
}

impl Layers {
    /// Those of a material with these extensions and, of KHR_materials_ior, this index of refraction; KHR_materials_unlit is not among them.
    pub(super) fn of(extensions: Option<&Map<String, Value>>, ior: Option<f32>, place: &str) -> Result<Self> {
        let find = |name: &str| extensions.and_then(|extensions| extensions.get(name));
        let specular = find(SPECULAR);
        let factor = specular.map_or(Ok(1.0), |specular| number(specular, "specularFactor", 1.0, place))?;
        let color = specular.map_or(Ok(Vec3::ONE), |specular| color(specular, "specularColorFactor", place))?;
        share(factor, "specularFactor", place)?;
        let coat = find(CLEARCOAT).map(|coat| {
            let read = |key: &str| share(number(coat, key, 0.0, place)?, key, place);
            Ok([read("clearcoatFactor")?, read("clearcoatRoughnessFactor")?])
        });
        let has = |key: &str| specular.is_some_and(|specular| specular.get(key).is_some());
        if let Some(n) = ior.filter(|n| !(*n >= 0.0 && n.is_finite())) {
            return Err(Fault::new(place, format!("has the ior {n}; it must be finite and 0 or greater")));
        }
        let reflectance = ior.map_or(PLASTIC_REFLECTANCE, |n| Vec3::splat(((n - 1.0) / (n + 1.0)).powi(2)));
        Ok(Self {
            reflectance: (factor * color * reflectance).min(Vec3::splat(MOST_REFLECTANCE)),
            has_specular: factor != 1.0 || color != Vec3::ONE,
            has_specular_pictures: has("specularTexture") || has("specularColorTexture"),
            coat: coat.transpose()?.filter(|[strength, _]| *strength > 0.0),
            is_unlit: false,
        })
    }
}

fn number(extension: &Value, key: &str, default: f32, place: &str) -> Result<f32> {
    let Some(value) = extension.get(key) else { return Ok(default) };
    let number = value.as_f64().map(|number| number as f32);
    number.ok_or_else(|| Fault::new(place, format!("has a {key} that is not a number")))
}

/// Three numbers of 0 or greater; white without any.
fn color(extension: &Value, key: &str, place: &str) -> Result<Vec3> {
    let Some(value) = extension.get(key) else { return Ok(Vec3::ONE) };
    let numbers: Vec<_> = value.as_array().into_iter().flatten().filter_map(|number| number.as_f64()).collect();
    let color = <[f64; 3]>::try_from(numbers).ok().map(|channels| Vec3::from(channels.map(|channel| channel as f32)));
    let is_right = |color: &Vec3| color.is_finite() && color.min_element() >= 0.0;
    color
        .filter(is_right)
        .ok_or_else(|| Fault::new(place, format!("has a {key} that is not 3 numbers of 0 or greater")))
}
