//! KHR_materials_variants: other materials of primitives, by the name of a variant.

use gltf_json::{Root, mesh::Primitive};

use super::fault::{Fault, Result, shortened};

const EXTENSION: &str = "KHR_materials_variants";

/// The number of the variant of a name.
pub(super) fn variant(root: &Root, name: Option<&str>) -> Result<Option<u64>> {
    let Some(name) = name else { return Ok(None) };
    let extension = root.extensions.as_ref().and_then(|extensions| extensions.others.get(EXTENSION));
    let variants = extension.and_then(|extension| extension.get("variants")?.as_array());
    let names = variants.into_iter().flatten().map(|variant| variant.get("name").and_then(|name| name.as_str()));
    let names: Vec<_> = names.map(|name| name.unwrap_or_default()).collect();
    if let Some(index) = names.iter().position(|known| *known == name) {
        return Ok(Some(index as u64));
    }
    let listed: Vec<_> = names.iter().take(20).map(|name| format!("{:?}", shortened(name))).collect();
    let known = if listed.is_empty() { "has none".to_owned() } else { format!("has {}", listed.join(", ")) };
    Err(Fault::of_file(format!("the material variant {:?} was asked for, and the file {known}", shortened(name))))
}

/// The material of a primitive in a variant; its own where the variant does not say.
pub(super) fn material(primitive: &Primitive, variant: Option<u64>, place: &str) -> Result<Option<usize>> {
    let own = primitive.material.map(|material| material.value());
    let extension = primitive.extensions.as_ref().and_then(|extensions| extensions.others.get(EXTENSION));
    let (Some(variant), Some(extension)) = (variant, extension) else { return Ok(own) };
    let mappings = extension.get("mappings").and_then(|mappings| mappings.as_array());
    let is_of_variant = |mapping: &&serde_json::Value| {
        let variants = mapping.get("variants").and_then(|variants| variants.as_array());
        variants.is_some_and(|variants| variants.iter().any(|number| number.as_u64() == Some(variant)))
    };
    let Some(mapping) = mappings.into_iter().flatten().find(is_of_variant) else { return Ok(own) };
    let index = mapping.get("material").and_then(|material| material.as_u64());
    let index = index.and_then(|index| usize::try_from(index).ok());
    index.map(Some).ok_or_else(|| Fault::new(place, format!("has a {EXTENSION} without the index of a material")))
}
